//! How far a tessellation is from the surface.

use glam::DVec3;
use rayon::prelude::*;

use super::lattice::Lattice;
use super::table::Table;
use crate::mesh::distance::nearest_on_triangle;
use crate::surface::analytic::AnalyticSurface;

/// The largest distance found from a surface to its tessellation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deviation {
    /// The distance, metres.
    pub largest: f64,
    /// Which surface, counted from 0 (with a rounded cap at the start counted as the first).
    pub surface: usize,
    /// u of the place on it.
    pub u: f64,
    /// v of the place, radians.
    pub v: f64,
}

/// Steps of a quad in each direction between the points that are measured.
const STEPS: usize = 4;

/// Measures the distance from points of the exact surface to the quad they belong to: every quad has a net of 5 by 5,
/// its corners among them. It is an upper bound of their distance to the mesh. Each point counts with the worse of both
/// ways to split the quad into triangles, since programs differ in that. The first of equally far places is given.
pub(super) fn measure(patches: &[AnalyticSurface], lattice: &Lattice) -> Deviation {
    let columns = refined(&lattice.columns, lattice.closed.then_some(lattice.end));
    let tables: Vec<Table> = patches.iter().map(|patch| Table::new(patch.angles(), &columns)).collect();
    let strips: Vec<(usize, f64, f64)> = lattice
        .rows
        .iter()
        .enumerate()
        .flat_map(|(patch, rows)| rows.windows(2).map(move |pair| (patch, pair[0], pair[1])))
        .collect();
    let of_strip = |(patch, from, to): &(usize, f64, f64)| {
        strip(&patches[*patch], &tables[*patch], *patch, [*from, *to], &columns)
    };
    let worst = |a: Deviation, b: Deviation| if b.largest > a.largest { b } else { a };
    let found: Vec<Deviation> = strips.par_iter().map(of_strip).collect();
    found.into_iter().fold(Deviation::default(), worst)
}

/// Places between neighbours, from the first to the last, or around to `end`.
fn refined(places: &[f64], end: Option<f64>) -> Vec<f64> {
    let all: Vec<f64> = places.iter().copied().chain(end).collect();
    let between = |pair: &[f64]| {
        let (a, b) = (pair[0], pair[1]);
        (0..STEPS).map(move |k| a + (b - a) * k as f64 / STEPS as f64).collect::<Vec<_>>()
    };
    let mut refined: Vec<f64> = all.windows(2).flat_map(between).collect();
    refined.extend(all.last());
    refined
}

fn strip(patch: &AnalyticSurface, table: &Table, surface: usize, ends: [f64; 2], columns: &[f64]) -> Deviation {
    let count = table.columns();
    let us = refined(&ends, None);
    let mut points = vec![DVec3::ZERO; us.len() * count];
    for (u, row) in us.iter().zip(points.chunks_exact_mut(count)) {
        table.points(&patch.row_at(*u, 0, 0..patch.angles().lanes()), row);
    }
    let mut found = Deviation { surface, ..Deviation::default() };
    for cell in (0..count - 1).step_by(STEPS) {
        let [a, b] = [cell, cell + STEPS].map(|k| points[k]);
        let [d, c] = [cell, cell + STEPS].map(|k| points[STEPS * count + k]);
        for (i, u) in us.iter().enumerate() {
            for k in 0..=STEPS {
                let point = points[i * count + cell + k];
                let to = |corners: [DVec3; 3]| nearest_on_triangle(point, corners).distance_squared(point);
                let split = to([a, b, c]).min(to([a, c, d]));
                let other = to([a, b, d]).min(to([b, c, d]));
                let largest = split.max(other);
                if largest > found.largest {
                    (found.largest, found.u, found.v) = (largest, *u, columns[cell + k]);
                }
            }
        }
    }
    found.largest = found.largest.sqrt();
    found
}
