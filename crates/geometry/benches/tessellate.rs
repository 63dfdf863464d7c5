//! Analytic surfaces: solving, evaluating, and tessellating with exact normals. The leg of the test data, 12 sections.
//! Figures are for as many threads as `RAYON_NUM_THREADS` says. Run with
//! `cargo bench -p maquette-geometry --bench tessellate`.
#![allow(
    missing_docs,
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a benchmark has no users, and stops where it is wrong"
)]

#[path = "../tests/human/mod.rs"]
mod human;

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use maquette_geometry::surface::analytic::{AnalyticSurface, SurfaceOptions};
use maquette_geometry::surface::tessellate::{Density, Spacing, SurfaceGrid, Tessellation};

fn tessellation(c: &mut Criterion) {
    for harmonics in [4, 8] {
        let sections = human::sections("left_leg", harmonics);
        let surface = AnalyticSurface::through(&sections, &SurfaceOptions::default()).unwrap();
        c.bench_function(&format!("solve, 12 sections, J={harmonics}"), |b| {
            b.iter(|| AnalyticSurface::through(black_box(&sections), &SurfaceOptions::default()).unwrap());
        });
        c.bench_function(&format!("evaluate one point, J={harmonics}"), |b| {
            b.iter(|| surface.evaluate(black_box(0.37), black_box(1.2)));
        });
        for (rows, columns) in [(32_u32, 64_u32), (128, 256), (512, 1024)] {
            let places = |count: u32, end: f64| (0..count).map(|k| end * f64::from(k) / f64::from(count)).collect();
            let (us, vs): (Vec<f64>, Vec<f64>) = (places(rows, 1.0), places(columns, std::f64::consts::TAU));
            let mut grid = SurfaceGrid::default();
            c.bench_function(&format!("points and normals, {rows} x {columns}, J={harmonics}"), |b| {
                b.iter(|| surface.evaluate_grid_into(black_box(&us), black_box(&vs), &mut grid));
            });
            let (rows, columns) = (rows as usize, columns as usize);
            for spacing in [Spacing::Even, Spacing::Curvature] {
                let options =
                    Tessellation { density: Density::Grid { rows, columns }, spacing, ..Tessellation::default() };
                c.bench_function(&format!("mesh, {rows} x {columns}, {spacing:?}, J={harmonics}"), |b| {
                    b.iter(|| surface.tessellate(black_box(&options)).unwrap());
                });
            }
        }
        for wanted in [1e-3, 1e-4] {
            let options = Tessellation { density: Density::Deviation(wanted), ..Tessellation::default() };
            c.bench_function(&format!("mesh within {} mm, J={harmonics}", wanted * 1e3), |b| {
                b.iter(|| surface.tessellate(black_box(&options)).unwrap());
            });
        }
    }
}

criterion_group!(benches, tessellation);
criterion_main!(benches);
