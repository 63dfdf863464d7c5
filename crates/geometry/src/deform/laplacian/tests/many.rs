//! Meshes with many handles of the topological kind, vertices on each other, and regions in meshes much larger.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use super::super::*;
use super::{apart, bar, bind, both, deform, edge_error, select, sheet};
use crate::mesh::{ManifoldReport, Mesh, Topology, figures};

/// A plate of 11 x 3 cubes of side 1, three small quads wide each, five of them punched out: a surface of genus 5.
fn pierced() -> Mesh {
    let fine = 3;
    let solid = |x: i64, y: i64, z: i64| {
        let (x, y, z) = (x.div_euclid(fine), y.div_euclid(fine), z.div_euclid(fine));
        (0..11).contains(&x) && y == 0 && (0..3).contains(&z) && !(z == 1 && x % 2 == 1)
    };
    let mut numbers = BTreeMap::new();
    let mut points = Vec::new();
    let mut quads = Vec::new();
    // Sides of a cube as offsets of its corners, counter-clockwise seen from outside.
    let sides: [([i64; 3], [[i64; 3]; 4]); 6] = [
        ([-1, 0, 0], [[0, 0, 0], [0, 0, 1], [0, 1, 1], [0, 1, 0]]),
        ([1, 0, 0], [[1, 0, 0], [1, 1, 0], [1, 1, 1], [1, 0, 1]]),
        ([0, -1, 0], [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]]),
        ([0, 1, 0], [[0, 1, 0], [0, 1, 1], [1, 1, 1], [1, 1, 0]]),
        ([0, 0, -1], [[0, 0, 0], [0, 1, 0], [1, 1, 0], [1, 0, 0]]),
        ([0, 0, 1], [[0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]),
    ];
    for (x, y, z) in (0..11 * fine).flat_map(|x| (0..fine).flat_map(move |y| (0..3 * fine).map(move |z| (x, y, z)))) {
        for (outside, corners) in sides {
            if solid(x, y, z) && !solid(x + outside[0], y + outside[1], z + outside[2]) {
                let mut number = |[i, j, k]: [i64; 3]| {
                    *numbers.entry([x + i, y + j, z + k]).or_insert_with(|| {
                        points.push(DVec3::new((x + i) as f64, (y + j) as f64, (z + k) as f64) / fine as f64);
                        points.len() as u32 - 1
                    })
                };
                quads.push(corners.map(&mut number));
            }
        }
    }
    Mesh::new(points, quads).unwrap()
}

#[test]
fn a_surface_of_genus_five_bends() {
    let plate = pierced();
    let found = figures(&plate, &|_| true).unwrap();
    assert_eq!((found.genus, found.components, found.boundary_loops), (Some(5), 1, 0));
    assert!((found.volume - 28.0).abs() < 1e-9, "{}", found.volume);
    let (left, right) = (select(&plate, |p| p.x < 0.9), select(&plate, |p| p.x > 10.1));
    for reconstruction in [Reconstruction::Coordinates, Reconstruction::Edges] {
        let bound = bind(&plate, &both([&left, &right]), reconstruction).unwrap();
        let turn = HandleTransform::rotation(DVec3::new(5.5, 0.0, 0.0), DVec3::Z, 1.0);
        let made = deform(&bound, &[HandleTransform::default(), turn], Passes::Once).mesh;
        let after = figures(&made, &|_| true).unwrap();
        assert!(ManifoldReport::of(&made).is_manifold() && after.genus == Some(5));
        let (ratio, error) = (after.volume / found.volume, edge_error(&plate, &made));
        assert!(ratio > 0.86 && error < 0.1, "{reconstruction:?}: {ratio:.3}, {error:.3}");
        let rigid = deform(&bound, &[turn; 2], Passes::Once).mesh;
        let wanted = plate.with_positions(plate.positions().iter().map(|p| turn.apply(*p)).collect(), None).unwrap();
        assert!(apart(&wanted, rigid.positions()) < 1e-9);
    }
}

#[test]
fn vertices_doubled_along_a_seam_part_there_and_say_where_nothing_holds() {
    // The upper half has vertices of its own along the seam: two sheets that only look like one.
    let whole = bar(4, 16, false);
    let mut points = whole.positions().to_vec();
    let mut doubled = BTreeMap::new();
    let polygons: Vec<Vec<u32>> = whole
        .polygons()
        .map(|quad| {
            let middle = quad.iter().map(|v| whole.positions()[*v as usize].y).sum::<f64>() / 4.0;
            let own = |v: &u32| {
                let at = whole.positions()[*v as usize];
                if middle < 2.0 || (at.y - 2.0).abs() > 1e-9 {
                    return *v;
                }
                *doubled.entry(*v).or_insert_with(|| {
                    points.push(at);
                    points.len() as u32 - 1
                })
            };
            quad.iter().map(own).collect()
        })
        .collect();
    let parted = Mesh::new(points, polygons).unwrap();
    assert_eq!((doubled.len(), Topology::new(&parted).boundary_loops().len()), (16, 2));
    let low = select(&parted, |p| p.y < 0.6);
    let refused = bind(&parted, &both([&low]), Reconstruction::Coordinates).unwrap_err();
    let BindError::Underdetermined { at, free, .. } = &refused else { panic!("{refused}") };
    assert!(at.y > 1.9 && *free > 100 && refused.to_string().contains("is held by nothing"), "{refused}");
    // Held by itself, the half goes its own way, and no number comes out wrong.
    let high = select(&parted, |p| p.y > 3.4);
    let bound = bind(&parted, &both([&low, &high]), Reconstruction::Coordinates).unwrap();
    let lift = [HandleTransform::default(), HandleTransform::translation(DVec3::Y)];
    let made = deform(&bound, &lift, Passes::Once).mesh;
    for (below, above) in &doubled {
        let gap = made.positions()[*above as usize] - made.positions()[*below as usize];
        assert!(gap.distance(DVec3::Y) < 1e-6, "{gap}");
    }
}

#[test]
fn a_small_region_of_a_large_mesh_is_bound_alone() {
    let large = sheet(300, 300);
    let region = select(&large, |p| p.distance(DVec3::new(0.5, 0.0, 0.5)) < 0.05);
    let handle = select(&large, |p| p.distance(DVec3::new(0.5, 0.0, 0.5)) < 0.01);
    let options = BindOptions::default();
    let bound = Binding::new(Arc::new(large.clone()), Some(&region), &both([&handle]), &options, &|_| true).unwrap();
    let free = region.vertices().len() - handle.vertices().len();
    assert_eq!(bound.report().free, free);
    assert!(free < 800 && bound.report().factor_bytes < 4_000_000, "{:?}", bound.report());
    let made = deform(&bound, &[HandleTransform::translation(0.02 * DVec3::Y)], Passes::Once).mesh;
    let moved = made.positions().iter().zip(large.positions()).filter(|(p, q)| p != q).count();
    assert!(moved <= free + handle.vertices().len() && moved > free / 2, "{moved} of {free}");
}
