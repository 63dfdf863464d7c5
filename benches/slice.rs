//! Sections along a bone of a mesh the size of a low-poly body. Run with `cargo bench --bench slice`.
#![allow(missing_docs, clippy::expect_used, reason = "a benchmark has no users, and stops where it is wrong")]

use std::f64::consts::TAU;
use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use glam::DVec3;
use maquette_geometry::curve::Curve;
use maquette_geometry::mesh::slice::{AlongOptions, Hit, Method, Plane, Positions, along, plane};
use maquette_geometry::mesh::{Mesh, MeshRays};

/// A bumpy tube about a bent bone: 27,120 triangles, closed.
fn limb() -> (Mesh, Curve) {
    let (sides, rows) = (120_u32, 113_u32);
    let at = |row: u32, k: u32| row * sides + k % sides;
    let centre = |y: f64| DVec3::new(0.1 * y * y, y, 0.05 * (3.0 * y).sin());
    let mut points: Vec<DVec3> = Vec::new();
    for row in 0..rows {
        let y = f64::from(row) / f64::from(rows - 1);
        points.extend((0..sides).map(|k| f64::from(k) / f64::from(sides) * TAU).map(|a| {
            let radius = 0.1 + 0.01 * (3.0 * a).cos() + 0.02 * (7.0 * y).sin();
            centre(y) + DVec3::new(a.sin(), 0.0, a.cos()) * radius
        }));
    }
    let ends = [points.len() as u32, points.len() as u32 + 1];
    points.extend([centre(0.0), centre(1.0)]);
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for row in 0..rows - 1 {
        for k in 0..sides {
            triangles.push([at(row, k), at(row, k + 1), at(row + 1, k + 1)]);
            triangles.push([at(row, k), at(row + 1, k + 1), at(row + 1, k)]);
        }
    }
    triangles.extend((0..sides).map(|k| [at(0, k + 1), at(0, k), ends[0]]));
    triangles.extend((0..sides).map(|k| [at(rows - 1, k), at(rows - 1, k + 1), ends[1]]));
    let mesh = Mesh::new(points, triangles).expect("the limb is sound");
    let joints = [0.02, 0.35, 0.7, 0.98].map(centre).to_vec();
    (mesh, Curve::new("bone", joints, false).expect("the bone is sound"))
}

fn slices(c: &mut Criterion) {
    let (mesh, bone) = limb();
    c.bench_function("one plane, 27,000 triangles", |b| {
        let middle = Plane::new(DVec3::Y * 0.513, DVec3::new(0.1, 1.0, 0.05)).expect("a plane");
        b.iter(|| black_box(plane(&mesh, &middle)));
    });
    let mut options = AlongOptions { positions: Positions::count(20), ..AlongOptions::default() };
    c.bench_function("20 sections of 64 points by loops", |b| {
        b.iter(|| black_box(along(&mesh, &bone, &options)).expect("sections"));
    });
    options.section.method = Method::Rays(Hit::First);
    c.bench_function("20 sections of 64 points by rays", |b| {
        b.iter(|| black_box(along(&mesh, &bone, &options)).expect("sections"));
    });
    c.bench_function("boxes for rays", |b| b.iter(|| black_box(MeshRays::new(&mesh)).expect("not empty")));
}

criterion_group!(benches, slices);
criterion_main!(benches);
