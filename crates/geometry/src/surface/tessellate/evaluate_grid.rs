//! Many points of a surface at once.

use glam::DVec3;
use rayon::prelude::*;

use super::table::Table;
use crate::surface::analytic::AnalyticSurface;

/// Points and normals of a surface at rows of u and columns of v, row after row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceGrid {
    /// The points, metres.
    pub positions: Vec<DVec3>,
    /// Unit normals as those of [`SurfacePoint`](crate::surface::analytic::SurfacePoint): zero where there is none.
    pub normals: Vec<DVec3>,
}

impl AnalyticSurface {
    /// Points and exact normals at every u (clamped to 0..=1) with every v: as [`AnalyticSurface::evaluate`] at each, to
    /// rounding, at a small part of the cost. The basis in v is computed once a column, the coefficients at u once a row.
    ///
    /// Rows are spread over the threads of the pool it is called in; the result is the same for any number.
    pub fn evaluate_grid(&self, us: &[f64], vs: &[f64]) -> SurfaceGrid {
        let mut grid = SurfaceGrid::default();
        self.evaluate_grid_into(us, vs, &mut grid);
        grid
    }

    /// As [`AnalyticSurface::evaluate_grid`], into memory that is there already: for surfaces that change many times a
    /// second.
    pub fn evaluate_grid_into(&self, us: &[f64], vs: &[f64], grid: &mut SurfaceGrid) {
        let count = us.len() * vs.len();
        grid.positions.resize(count, DVec3::ZERO);
        grid.normals.resize(count, DVec3::ZERO);
        if count == 0 {
            return;
        }
        let table = Table::new(self.angles(), vs);
        let rows = grid.positions.par_chunks_exact_mut(vs.len()).zip(grid.normals.par_chunks_exact_mut(vs.len()));
        rows.zip(us).with_min_len(4).for_each(|((positions, normals), u)| {
            let u = if u.is_nan() { 0.0 } else { u.clamp(0.0, 1.0) };
            fill(self, &table, u, vs, positions, normals);
        });
    }
}

/// Points and normals of a row.
pub(super) fn fill(
    surface: &AnalyticSurface,
    table: &Table,
    u: f64,
    vs: &[f64],
    positions: &mut [DVec3],
    normals: &mut [DVec3],
) {
    let lanes = 0..surface.angles().lanes();
    let (row, derivative) = (surface.row_at(u, 0, lanes.clone()), surface.row_at(u, 1, lanes));
    for column in table.points_and_normals(&row, &derivative, positions, normals) {
        normals[column] = surface.evaluate(u, vs[column]).normal;
    }
}
