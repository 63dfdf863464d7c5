//! The second system (thesis 2.10, 2.11): positions whose Laplacian coordinates are the turned ones.

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::error::{BindError, DeformError};
use super::options::Reconstruction;
use super::patch::Patch;
use super::polar::nearest_rotation;
use super::rows::{Rows, lower_triangle};
use crate::linear_solver::Cholesky;

/// The second system, factored. Unknown are the displacements of the free vertices against the mesh.
#[derive(Debug)]
pub(super) struct Reconstruct {
    kind: Reconstruction,
    /// `A_i D(v_i)` of each vertex that has an equation: the cotangent weights, in ascending order of the vertices.
    laplacians: Rows<f64>,
    /// Mixed areas, square metres.
    areas: Vec<f64>,
    factor: Cholesky,
}

impl Reconstruct {
    /// `weights` and `areas` are those of [`Patch::weights`].
    pub fn new(
        patch: &Patch,
        kind: Reconstruction,
        weights: &[Vec<f64>],
        areas: &[f64],
        progress: &dyn Fn(f64) -> bool,
    ) -> Result<Self, BindError> {
        let go_on = |done: f64| if progress(done) { Ok(()) } else { Err(BindError::Stopped) };
        go_on(0.0)?;
        let mut laplacians = Rows::new();
        for (vertex, weights) in weights.iter().enumerate() {
            // Without the rows of the handles' rims nothing says that the surface leaves a handle in its direction.
            laplacians.push(if patch.ring[vertex] <= 1 { row(patch, vertex, weights) } else { Vec::new() });
        }
        let free = patch.free;
        let columns = laplacians.transposed(free);
        let areas = areas.to_vec();
        let scaled = {
            let scale = |v: usize| if areas[v] > 0.0 { 1.0 / areas[v] } else { 0.0 };
            let scaled = |v: usize| laplacians.row(v).map(move |(k, w)| (k as u32, w * scale(v))).collect();
            Rows::collect((0..patch.len()).map(scaled).collect())
        };
        let matrix = lower_triangle(
            free,
            |vertex, column| match kind {
                Reconstruction::Coordinates => column.add_product(&columns, &scaled, |a, b| a * b),
                Reconstruction::Edges => column.add_entries(laplacians.row(vertex).filter(|(k, _)| *k < free)),
            },
            &|| go_on(0.3),
        )?;
        drop((columns, scaled));
        go_on(0.5)?;
        let reach = if kind == Reconstruction::Edges { 1 } else { 2 };
        let factor = Cholesky::factor_along(&matrix, &patch.graph(reach))?;
        go_on(1.0)?;
        Ok(Self { kind, laplacians, areas, factor })
    }

    /// Cotangent weights with a minus, and their sums at the vertices themselves, of the free vertices and their
    /// neighbours.
    pub fn weights(&self) -> &Rows<f64> {
        &self.laplacians
    }

    /// Whether a pass of rotations and positions lowers [`Reconstruct::energy`].
    pub fn lowers_energy(&self) -> bool {
        self.kind == Reconstruction::Edges
    }

    /// The sum over the vertices and the edges to their neighbours, one end free, of the edge's weight times the square of
    /// what its turn leaves.
    pub fn energy(&self, patch: &Patch, turned: &[DMat3], displacements: &[DVec3]) -> f64 {
        let of = |vertex: usize| {
            let mut sum = 0.0;
            for (k, w) in self.laplacians.row(vertex).filter(|(k, _)| *k != vertex) {
                if vertex < patch.free || k < patch.free {
                    let before = patch.points[vertex] - patch.points[k];
                    let after = before + displacements[vertex] - displacements[k];
                    sum -= w * (after - turned[vertex] * before).length_squared();
                }
            }
            sum
        };
        // Summed in one order, whatever the number of threads.
        let parts: Vec<f64> = (0..self.laplacians.len()).into_par_iter().with_min_len(1024).map(of).collect();
        parts.iter().sum()
    }

    /// Bytes of the factor.
    pub fn bytes(&self) -> usize {
        self.factor.bytes()
    }

    /// Solves for the displacements of the free vertices, those of the held ones given. `turned` are the deformation
    /// gradients without shear, or with it where a handle prescribes it.
    pub fn solve(&self, patch: &Patch, turned: &[DMat3], displacements: &mut [DVec3]) -> Result<(), DeformError> {
        // The systems with areas are squared, and what rounding loses there comes back from the rows.
        let passes = if self.kind == Reconstruction::Coordinates { 2 } else { 1 };
        for _ in 0..passes {
            let mut sides = match self.kind {
                Reconstruction::Coordinates => self.by_coordinates(patch, turned, displacements),
                Reconstruction::Edges => self.by_edges(patch, turned, displacements),
            };
            self.factor.solve_points(&mut sides)?;
            for (displacement, more) in displacements.iter_mut().zip(sides) {
                *displacement += more;
            }
        }
        if displacements.iter().all(|u| u.is_finite()) { Ok(()) } else { Err(DeformError::Overflow) }
    }

    /// The rotation by which the edges at each vertex, weighted, come nearest to those of the displaced mesh; `prescribed`
    /// where a gradient is held (Sorkine and Alexa, As-Rigid-As-Possible Surface Modeling, 2007).
    pub fn rotations(
        &self,
        patch: &Patch,
        displacements: &[DVec3],
        prescribed: &(dyn Fn(usize) -> DMat3 + Sync),
    ) -> Vec<DMat3> {
        let of = |vertex: usize| {
            if patch.gradient[vertex].is_some() || self.laplacians.columns(vertex).is_empty() {
                return prescribed(vertex);
            }
            let mut covariance = DMat3::ZERO;
            for (k, w) in self.laplacians.row(vertex).filter(|(k, _)| *k != vertex) {
                let before = -w * (patch.points[k] - patch.points[vertex]);
                let after = patch.points[k] - patch.points[vertex] + displacements[k] - displacements[vertex];
                covariance += DMat3::from_cols(after * before.x, after * before.y, after * before.z);
            }
            nearest_rotation(covariance)
        };
        (0..self.laplacians.len()).into_par_iter().with_min_len(256).map(of).collect()
    }

    fn by_coordinates(&self, patch: &Patch, turned: &[DMat3], displacements: &[DVec3]) -> Vec<DVec3> {
        let residuals: Vec<DVec3> = (0..self.laplacians.len())
            .into_par_iter()
            .with_min_len(1024)
            .map(|vertex| {
                if self.areas[vertex] <= 0.0 {
                    return DVec3::ZERO;
                }
                let own = patch.points[vertex];
                let (mut coordinate, mut laplacian) = (DVec3::ZERO, DVec3::ZERO);
                for (k, w) in self.laplacians.row(vertex) {
                    coordinate += w * (patch.points[k] - own);
                    laplacian += w * (displacements[k] - displacements[vertex]);
                }
                (laplacian - (turned[vertex] * coordinate - coordinate)) / self.areas[vertex]
            })
            .collect();
        let mut sides = vec![DVec3::ZERO; patch.free];
        for (vertex, residual) in residuals.iter().enumerate() {
            for (k, w) in self.laplacians.row(vertex) {
                if k < patch.free {
                    sides[k] -= w * *residual;
                }
            }
        }
        sides
    }

    fn by_edges(&self, patch: &Patch, turned: &[DMat3], displacements: &[DVec3]) -> Vec<DVec3> {
        (0..patch.free)
            .into_par_iter()
            .with_min_len(1024)
            .map(|vertex| {
                let mut side = DVec3::ZERO;
                for (k, w) in self.laplacians.row(vertex).filter(|(k, _)| *k != vertex) {
                    let edge = patch.points[vertex] - patch.points[k];
                    let wanted = 0.5 * (turned[vertex] * edge + turned[k] * edge) - edge;
                    // The weight stands in the row with a minus.
                    side -= w * (wanted - (displacements[vertex] - displacements[k]));
                }
                side
            })
            .collect()
    }
}

/// `sum_j w_ij (v_i - v_j)` as a row.
fn row(patch: &Patch, vertex: usize, weights: &[f64]) -> Vec<(u32, f64)> {
    let ring = patch.adjacency.ring(vertex as u32);
    let mut entries: Vec<(u32, f64)> = ring.iter().zip(weights).map(|(k, w)| (*k, -w)).collect();
    let place = entries.partition_point(|(k, _)| (*k as usize) < vertex);
    entries.insert(place, (vertex as u32, weights.iter().sum()));
    entries
}
