//! Meshes to deform, and how far a deformation is off.

use glam::DVec3;

use super::{
    BindError, BindOptions, Binding, DeformOptions, Deformed, Handle, HandleTransform, Holds, Passes, Reconstruction,
};
use crate::mesh::select::Selection;
use crate::mesh::{Mesh, Topology, measure};
use std::sync::Arc;

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
    let topology = Topology::new(before);
    let length = |mesh: &Mesh, [a, b]: [u32; 2]| mesh.positions()[a as usize].distance(mesh.positions()[b as usize]);
    let change = |edge| (length(after, edge) / length(before, edge) - 1.0).powi(2);
    let sum: f64 = topology.edges().map(|uses| change(uses[0].edge)).sum();
    (sum / topology.edge_count() as f64).sqrt()
}

/// Handles that hold positions and gradients.
pub(super) fn both<const N: usize>(selections: [&Selection; N]) -> [Handle<'_>; N] {
    selections.map(|selection| Handle { selection, holds: Holds::Both })
}

pub(super) fn bind(mesh: &Mesh, handles: &[Handle<'_>], reconstruction: Reconstruction) -> Result<Binding, BindError> {
    Binding::new(Arc::new(mesh.clone()), None, handles, &BindOptions { reconstruction }, &|_| true)
}

pub(super) fn deform(bound: &Binding, transforms: &[HandleTransform], passes: Passes) -> Deformed {
    bound.deform(transforms, &DeformOptions { passes, ..DeformOptions::default() }, &|_| true).unwrap()
}

/// Largest distance between vertices, as a fraction of the diagonal of the first mesh.
pub(super) fn apart(wanted: &Mesh, found: &[DVec3]) -> f64 {
    let pairs = wanted.positions().iter().zip(found);
    pairs.map(|(p, q)| p.distance(*q)).fold(0.0, f64::max) / measure::diagonal(wanted)
}

/// A ring with waves, which no straight line and no plane has much of; in triangles or quads.
pub(super) fn ring(around: u32, across: u32, triangles: bool) -> Mesh {
    let turn = |i: u32, count: u32| std::f64::consts::TAU * f64::from(i) / f64::from(count);
    let points = (0..around).flat_map(|i| {
        (0..across).map(move |j| {
            let (u, v) = (turn(i, around), turn(j, across));
            let thick = 0.4 + 0.05 * (3.0 * u).sin() * (2.0 * v).cos();
            let from_axis = 1.0 + thick * v.cos();
            DVec3::new(from_axis * u.cos(), thick * v.sin(), -from_axis * u.sin())
        })
    });
    let at = |i: u32, j: u32| (i % around) * across + j % across;
    let quads =
        (0..around).flat_map(|i| (0..across).map(move |j| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]));
    let points: Vec<DVec3> = points.collect();
    if triangles {
        return Mesh::new(points, quads.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]])).unwrap();
    }
    Mesh::new(points, quads).unwrap()
}

/// A flat net of `wide` x `deep` quads of side 1 / `wide` in the plane y = 0.
pub(super) fn sheet(wide: u32, deep: u32) -> Mesh {
    let step = 1.0 / f64::from(wide);
    let at = |x: u32, z: u32| z * (wide + 1) + x;
    let points = (0..=deep).flat_map(|z| (0..=wide).map(move |x| step * DVec3::new(x.into(), 0.0, z.into())));
    let quads =
        (0..deep).flat_map(|z| (0..wide).map(move |x| [at(x, z), at(x, z + 1), at(x + 1, z + 1), at(x + 1, z)]));
    Mesh::new(points.collect(), quads).unwrap()
}

mod bars;
mod formulas;
mod held;
mod invariances;
mod many;
mod shapes;
