//! Rotations beyond 180 degrees: interpolated between the handles instead of found by the first system.

use glam::{DMat3, DQuat, DVec3};

use super::error::DeformError;
use super::patch::Patch;
use super::rows::{Column, Rows, lower_triangle};
use crate::linear_solver::{Cholesky, LinearSolverError};

/// Least weight of an edge: harmonic values between two bounds stay there only where no weight is negative.
const LEAST_WEIGHT: f64 = 1e-3;

/// Rotation vectors and logarithms of scales, harmonic between the vertices whose gradient is held, factored.
///
/// The implicit system knows matrices alone, and takes the shorter way round; a rotation vector knows how often it went
/// round. Explicit methods of this kind carry any angle (thesis 2.5).
#[derive(Debug)]
pub(super) struct Winding {
    /// The place among the unknowns of each vertex that is one.
    unknown: Vec<Option<u32>>,
    /// Weights of the edges between an unknown and a held vertex: by unknown, the vertices of the patch.
    edges: Rows<f64>,
    factor: Cholesky,
}

impl Winding {
    pub fn new(patch: &Patch, weights: &Rows<f64>) -> Result<Self, LinearSolverError> {
        let mut count = 0;
        let mut unknown = vec![None; patch.len()];
        for (vertex, place) in unknown.iter_mut().enumerate() {
            if patch.gradient[vertex].is_none() && patch.ring[vertex] <= 1 {
                *place = Some(count);
                count += 1;
            }
        }
        let place = |vertex: usize| unknown[vertex].map(|place| place as usize);
        let vertices: Vec<usize> = (0..patch.len()).filter(|v| unknown[*v].is_some()).collect();
        // The entries of the rows are the weights with a minus, but for the vertex itself.
        let weights_of = |vertex: usize| {
            weights.row(vertex).filter(move |(k, _)| *k != vertex).map(|(k, w)| (k, (-w).max(LEAST_WEIGHT)))
        };
        let is_held = |vertex: usize| patch.gradient[vertex].is_some();
        let rim = |v: &usize| weights_of(*v).filter(|(k, _)| is_held(*k)).map(|(k, w)| (k as u32, w)).collect();
        let edges = Rows::collect(vertices.iter().map(rim).collect());
        let fill = |index: usize, column: &mut Column| {
            let vertex = vertices[index];
            let joined = |k: usize| place(k).is_some() || is_held(k);
            let total: f64 = weights_of(vertex).filter(|(k, _)| joined(*k)).map(|(_, w)| w).sum();
            // A part without any held gradient has no winding: the small addition makes it 0.
            column.add_entries(std::iter::once((index, total + 1e-9 * (total + LEAST_WEIGHT))));
            column.add_entries(weights_of(vertex).filter_map(|(k, w)| place(k).map(|k| (k, -w))));
        };
        let Ok(matrix) = lower_triangle::<std::convert::Infallible>(vertices.len(), fill, &|| Ok(()));
        Ok(Self { unknown, edges, factor: Cholesky::factor(&matrix)? })
    }

    /// The gradient at each vertex of the patch: a rotation times a scale, held where it is `held`.
    pub fn gradients(
        &self,
        patch: &Patch,
        held: &dyn Fn(usize) -> (DVec3, f64),
        prescribed: &dyn Fn(usize) -> DMat3,
    ) -> Result<Vec<DMat3>, DeformError> {
        let count = self.edges.len();
        let mut sides = vec![0.0; 4 * count];
        for index in 0..count {
            for (k, w) in self.edges.row(index) {
                let (rotation, scale) = held(k);
                for (axis, value) in [rotation.x, rotation.y, rotation.z, scale.ln()].into_iter().enumerate() {
                    sides[axis * count + index] += w * value;
                }
            }
        }
        self.factor.solve(&mut sides)?;
        Ok((0..patch.len())
            .map(|vertex| match self.unknown[vertex] {
                Some(index) => {
                    let value = |axis: usize| sides[axis * count + index as usize];
                    let rotation = DQuat::from_scaled_axis(DVec3::new(value(0), value(1), value(2)));
                    DMat3::from_quat(rotation) * value(3).exp()
                }
                None => prescribed(vertex),
            })
            .collect())
    }
}
