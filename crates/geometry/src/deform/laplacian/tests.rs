//! The deformation as a whole.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::DVec3;

use super::*;
use crate::mesh::select::Selection;
use crate::mesh::{Mesh, measure};

/// A bar of square section along y: `across` quads on each side, `along` quads high, cubes, caps included; triangles
/// where asked for.
pub(super) fn bar(across: u32, along: u32, triangles: bool) -> Mesh {
    let step = 1.0 / f64::from(across);
    let mut points = Vec::new();
    let mut number = std::collections::BTreeMap::new();
    for y in 0..=along {
        for z in 0..=across {
            for x in 0..=across {
                if [x, z].iter().any(|c| *c == 0 || *c == across) || y == 0 || y == along {
                    number.insert([x, y, z], points.len() as u32);
                    points.push(step * DVec3::new(x.into(), y.into(), z.into()) - DVec3::new(0.5, 0.0, 0.5));
                }
            }
        }
    }
    let mut quads: Vec<[u32; 4]> = Vec::new();
    let mut quad = |corners: [[u32; 3]; 4]| quads.push(corners.map(|c| number[&c]));
    for i in 0..across {
        for y in 0..along {
            quad([[i, y, 0], [i, y + 1, 0], [i + 1, y + 1, 0], [i + 1, y, 0]]);
            quad([[i, y, across], [i + 1, y, across], [i + 1, y + 1, across], [i, y + 1, across]]);
            quad([[0, y, i], [0, y, i + 1], [0, y + 1, i + 1], [0, y + 1, i]]);
            quad([[across, y, i], [across, y + 1, i], [across, y + 1, i + 1], [across, y, i + 1]]);
        }
        for x in 0..across {
            quad([[x, 0, i], [x + 1, 0, i], [x + 1, 0, i + 1], [x, 0, i + 1]]);
            quad([[x, along, i], [x, along, i + 1], [x + 1, along, i + 1], [x + 1, along, i]]);
        }
    }
    if !triangles {
        return Mesh::new(points, quads).unwrap();
    }
    // Diagonals alternate, so that the split has no direction.
    let split = |(i, [a, b, c, d]): (usize, [u32; 4])| {
        if i.is_multiple_of(2) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    };
    Mesh::new(points, quads.into_iter().enumerate().flat_map(split)).unwrap()
}

pub(super) fn select(mesh: &Mesh, is_in: impl Fn(DVec3) -> bool) -> Selection {
    Selection::by(mesh.positions().len(), |v| is_in(mesh.positions()[v]))
}

/// Root mean square of the relative changes of the edges' lengths.
pub(super) fn edge_error(before: &Mesh, after: &Mesh) -> f64 {
    let topology = crate::mesh::Topology::new(before);
    let length = |mesh: &Mesh, [a, b]: [u32; 2]| mesh.positions()[a as usize].distance(mesh.positions()[b as usize]);
    let change = |edge| (length(after, edge) / length(before, edge) - 1.0).powi(2);
    let sum: f64 = topology.edges().map(|uses| change(uses[0].edge)).sum();
    (sum / topology.edge_count() as f64).sqrt()
}

#[test]
fn explore() {
    for (across, along) in [(6, 36), (10, 60)] {
        for tri in [true, false] {
            let mesh = Arc::new(bar(across, along, tri));
            let height = f64::from(along) / f64::from(across);
            let (bottom, top) = (select(&mesh, |p| p.y < 0.5), select(&mesh, |p| p.y > height - 0.5));
            let handles = [&bottom, &top].map(|selection| Handle { selection, holds: Holds::Both });
            for reconstruction in [Reconstruction::Coordinates, Reconstruction::Edges] {
                let bound =
                    Binding::new(mesh.clone(), None, &handles, &BindOptions { reconstruction }, &|_| true).unwrap();
                println!("bar {across} x {along} tri {tri} {reconstruction:?} {:?}", bound.report());
                for degrees in [120.0_f64, 170.0] {
                    // As an arc would have it: the axis through which the bar bends by this angle keeps its length.
                    let free = height - 1.0;
                    let angle = degrees.to_radians();
                    let radius = free / angle;
                    for (name, turn) in [
                        ("in place", HandleTransform::rotation(DVec3::Y * (height - 0.5), DVec3::Z, angle)),
                        ("mid", HandleTransform::rotation(DVec3::Y * (height * 0.5), DVec3::Z, angle)),
                        ("arc", HandleTransform::rotation(DVec3::new(-radius, 0.5, 0.0), DVec3::Z, angle)
                            .shifted(DVec3::ZERO)),
                    ] {
                        let turn = if name == "arc" {
                            // The top goes down to 0.5 first, then around.
                            let down = DVec3::Y * -free;
                            let lin = turn.linear();
                            turn.shifted(lin * down)
                        } else {
                            turn
                        };
                        for passes in [Passes::Once, Passes::Converged { tolerance: 1e-6, most: 2000 }] {
                            let made = bound
                                .deform(
                                    &[HandleTransform::default(), turn],
                                    &DeformOptions { passes, ..Default::default() },
                                    &|_| true,
                                )
                                .unwrap();
                            let volume = measure::signed_volume(&made.mesh) / measure::signed_volume(&mesh);
                            println!(
                                "   {degrees} {name}: volume {volume:.3} edges {:.4} passes {} move {:.1e} wound {}",
                                edge_error(&mesh, &made.mesh),
                                made.passes,
                                made.last_move,
                                made.wound
                            );
                        }
                    }
                }
            }
        }
    }
    assert!(PI > 0.0);
}
