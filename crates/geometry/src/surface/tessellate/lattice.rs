//! The places of u and v at which patches are sampled.

use glam::DVec3;

use super::evaluate_grid::fill;
use super::table::Table;
use crate::surface::analytic::{AnalyticSurface, SurfacePoint};
use crate::surface::grid::{Crease, Grid, shares_across, shares_along};
use rayon::prelude::*;

/// Rows of the surface, for each patch in order, from u = 0 to 1, and columns that all of them share.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Lattice {
    pub rows: Vec<Vec<f64>>,
    /// Ascending from the first angle; of an open surface to the last one, of a closed one without it.
    pub columns: Vec<f64>,
    pub closed: bool,
    /// Where the columns end.
    pub end: f64,
}

/// Rows or columns by whose lengths UVs are shared out; more would not change them visibly.
const MEASURED: usize = 32;

impl Lattice {
    /// Quads (and triangles at poles) of a row.
    pub fn cells(&self) -> usize {
        if self.closed { self.columns.len() } else { self.columns.len() - 1 }
    }

    /// Rows of quads of all patches.
    pub fn strips(&self) -> usize {
        self.rows.iter().map(|rows| rows.len() - 1).sum()
    }

    /// The patch of each row of vertices and its u; where two patches meet, the first one has the row.
    pub fn stations(&self) -> Vec<(usize, f64)> {
        let rows = |(patch, rows): (usize, &Vec<f64>)| {
            rows.iter().skip(usize::from(patch > 0)).map(move |u| (patch, *u)).collect::<Vec<_>>()
        };
        self.rows.iter().enumerate().flat_map(rows).collect()
    }

    /// Samples the patches.
    pub fn sample(&self, patches: &[AnalyticSurface]) -> Grid {
        let tables: Vec<Table> = patches.iter().map(|patch| Table::new(patch.angles(), &self.columns)).collect();
        let stations = self.stations();
        let columns = self.columns.len();
        let mut starts = Vec::with_capacity(stations.len() + 1);
        let mut vertices = 0;
        for (patch, u) in &stations {
            starts.push(vertices);
            let pole = patches[*patch].section_index(*u).is_some_and(|k| patches[*patch].is_pole(k));
            vertices += if pole { 1 } else { columns };
        }
        starts.push(vertices);
        let mut positions = vec![DVec3::ZERO; vertices];
        let mut normals = vec![DVec3::ZERO; vertices];
        let mut rows = Vec::with_capacity(stations.len());
        let (mut points, mut directions) = (positions.as_mut_slice(), normals.as_mut_slice());
        for ((patch, u), span) in stations.iter().zip(starts.windows(2)) {
            let (own, rest) = points.split_at_mut(span[1] - span[0]);
            let (own_normals, rest_normals) = directions.split_at_mut(span[1] - span[0]);
            (points, directions) = (rest, rest_normals);
            rows.push((&patches[*patch], &tables[*patch], *u, own, own_normals));
        }
        rows.into_par_iter().with_min_len(4).for_each(|(patch, table, u, points, normals)| {
            if points.len() == 1 && columns > 1 {
                (points[0], normals[0]) = tip(patch, u);
                return;
            }
            fill(patch, table, u, &self.columns, points, normals);
        });
        let cells = self.cells();
        let full: Vec<usize> = (0..stations.len()).filter(|row| starts[row + 1] - starts[*row] == columns).collect();
        let step = full.len().div_ceil(MEASURED).max(1);
        let measured: Vec<DVec3> = full
            .iter()
            .step_by(step)
            .flat_map(|row| positions[starts[*row]..starts[row + 1]].iter().copied())
            .collect();
        let across = shares_across(&measured, columns, cells);
        let creases = self.creases(patches, &stations, &normals, &starts);
        let mut grid = Grid { positions, normals, starts, columns, cells, across, along: Vec::new(), creases };
        grid.along = shares_along(&grid, columns.div_ceil(MEASURED).max(1));
        grid
    }

    /// The columns at joints where sections have a corner somewhere, with the normals of the segment that ends there.
    fn creases(
        &self,
        patches: &[AnalyticSurface],
        stations: &[(usize, f64)],
        normals: &[DVec3],
        starts: &[usize],
    ) -> Vec<Crease> {
        let mut creases = Vec::new();
        for (column, v) in self.columns.iter().enumerate() {
            // The piece of each patch that ends in this column, and the angle at which it does.
            let ending = |patch: &AnalyticSurface| {
                let pieces = &patch.angles().pieces;
                let wrapped = if self.closed && column == 0 { self.end } else { *v };
                let found = pieces.iter().find(|piece| (piece.to - wrapped).abs() <= SAME_ANGLE)?;
                (pieces.len() > 1).then_some((*found, found.to))
            };
            let endings: Vec<_> = patches.iter().map(ending).collect();
            if endings.iter().all(Option::is_none) || (!self.closed && column == 0) {
                continue;
            }
            let mut creased = false;
            let before = stations.iter().zip(starts.windows(2)).map(|((patch, u), span)| {
                let own = normals[span[0] + if span[1] - span[0] == 1 { 0 } else { column }];
                let Some((piece, angle)) = &endings[*patch] else { return own };
                let found = SurfacePoint::new(*u, patches[*patch].derivatives(*u, piece, *angle)).normal;
                if found == DVec3::ZERO || span[1] - span[0] == 1 || found.distance(own) < SMOOTH {
                    return own;
                }
                creased = true;
                found
            });
            let before: Vec<DVec3> = before.collect();
            if creased {
                creases.push(Crease { column, normals: before });
            }
        }
        creases
    }
}

/// How far apart angles may be that are one, radians.
const SAME_ANGLE: f64 = 1e-9;

/// Normals that differ by less are those of a smooth joint.
const SMOOTH: f64 = 1e-4;

/// Point and normal of a pole: the normal that all columns share, or zero where it is pointed.
fn tip(patch: &AnalyticSurface, u: f64) -> (DVec3, DVec3) {
    let (from, to) = patch.angle_range();
    let at = |share: f64| patch.evaluate(u, from + share * (to - from));
    let first = at(0.0);
    let agree = [0.2, 0.45, 0.7].iter().all(|share| at(*share).normal.distance(first.normal) < 1e-6);
    // Between two patches that touch in a point, and inside one, there is no outside.
    let outer = u == 0.0 || u == 1.0;
    (first.position, if agree && outer { first.normal } else { DVec3::ZERO })
}
