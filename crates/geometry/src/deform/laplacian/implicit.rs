//! The first system (thesis 2.8): positions whose gradients agree with each other and with the handles.

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::error::{BindError, DeformError};
use super::patch::Patch;
use super::rows::{Rows, lower_triangle};
use super::stencil::Gradients;
use crate::linear_solver::Cholesky;

/// The system (2.8), factored. Unknown are the displacements of the free vertices against the mesh whose degenerate
/// vertices are displaced: in these, a mesh that nobody moves has no right-hand side at all.
#[derive(Debug)]
pub(super) struct Implicit {
    gradients: Gradients,
    /// Of each free vertex the row `sqrt(A_i) (D(v_i) - M_i delta_i)` of (2.6), `M_i delta_i` only where `M_i` is not
    /// prescribed. With `sqrt(A_i)` it has no unit, as the rows of (2.7) have none.
    laplacians: Rows<f64>,
    /// Of each free vertex `sqrt(A_i) delta_i`, for prescribed gradients.
    coordinates: Vec<DVec3>,
    /// Pairs of (2.7) at each vertex with a row: all vertices within two edges, one of both free.
    pairs: Rows<()>,
    factor: Cholesky,
}

impl Implicit {
    /// `weights` and `areas` are those of [`Patch::weights`].
    pub fn new(
        patch: &Patch,
        gradients: Gradients,
        weights: &[Vec<f64>],
        areas: &[f64],
        progress: &dyn Fn(f64) -> bool,
    ) -> Result<Self, BindError> {
        let go_on = |done: f64| if progress(done) { Ok(()) } else { Err(BindError::Stopped) };
        go_on(0.0)?;
        let free = patch.free;
        let made: Vec<(Vec<(u32, f64)>, DVec3)> = (0..free)
            .into_par_iter()
            .map(|vertex| laplacian_row(patch, &gradients, vertex, &weights[vertex], areas[vertex]))
            .collect();
        let (rows, coordinates): (Vec<_>, Vec<_>) = made.into_iter().unzip();
        let laplacians = Rows::collect(rows);
        go_on(0.1)?;
        let pairs: Vec<Vec<(u32, ())>> = (0..patch.len())
            .into_par_iter()
            .map(|vertex| {
                if !gradients.wanted[vertex] {
                    return Vec::new();
                }
                let others = patch.adjacency.within(vertex as u32, 2).into_iter();
                others.filter(|other| vertex < free || (*other as usize) < free).map(|other| (other, ())).collect()
            })
            .collect();
        let pairs = Rows::collect(pairs);
        go_on(0.2)?;
        let differences = differences(&gradients.rows, &pairs, free);
        go_on(0.3)?;
        let gradient_columns = gradients.rows.transposed(free);
        let laplacian_columns = laplacians.transposed(free);
        let matrix = lower_triangle(
            free,
            |_, column| {
                column.add_product(&gradient_columns, &differences, |a: DVec3, b: DVec3| a.dot(b));
                column.add_product(&laplacian_columns, &laplacians, |a, b| a * b);
            },
            &|| go_on(0.4),
        )?;
        drop((differences, gradient_columns, laplacian_columns));
        go_on(0.6)?;
        let factor = Cholesky::factor(&matrix)?;
        go_on(1.0)?;
        Ok(Self { gradients, laplacians, coordinates, pairs, factor })
    }

    /// Degenerate vertices displaced, and vertices whose gradient takes in more than one ring.
    pub fn degenerate(&self) -> (usize, usize) {
        (self.gradients.displaced, self.gradients.widened)
    }

    /// Bytes of the factor.
    pub fn bytes(&self) -> usize {
        self.factor.bytes()
    }

    /// Solves for where the handles are. `displacements` of the held vertices are given, those of the free ones are found;
    /// `prescribed` are the gradients less the identity, used where one is held.
    ///
    /// With `refine` the residual of all rows is solved for once more, which takes as long again and makes up for what
    /// the square of the rows' condition loses.
    pub fn solve(
        &self,
        patch: &Patch,
        displacements: &mut [DVec3],
        prescribed: &(dyn Fn(usize) -> DMat3 + Sync),
        refine: bool,
    ) -> Result<(), DeformError> {
        displacements[..patch.free].fill(DVec3::ZERO);
        for _ in 0..1 + usize::from(refine) {
            let mut sides = self.descent(patch, displacements, prescribed);
            self.factor.solve_points(&mut sides)?;
            for (displacement, more) in displacements.iter_mut().zip(sides) {
                *displacement += more;
            }
        }
        if displacements.iter().all(|u| u.is_finite()) { Ok(()) } else { Err(DeformError::Overflow) }
    }

    /// The deformation gradients less the identity at all vertices that have one.
    pub fn gradients(&self, displacements: &[DVec3], prescribed: &(dyn Fn(usize) -> DMat3 + Sync)) -> Vec<DMat3> {
        let rows = &self.gradients.rows;
        let of = |vertex: usize| {
            if !self.gradients.wanted[vertex] {
                return prescribed(vertex);
            }
            // Sums over the three columns, written out: this is what dragging waits for.
            let (mut x, mut y, mut z) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
            for (k, c) in rows.row(vertex) {
                let u = displacements[k];
                x += u * c.x;
                y += u * c.y;
                z += u * c.z;
            }
            DMat3::from_cols(x, y, z)
        };
        (0..rows.len()).into_par_iter().with_min_len(1024).map(of).collect()
    }

    /// The positions of the mesh itself where the displacements are those of the displaced one (below 2.9).
    pub fn undisplace(&self, patch: &Patch, gradients: &[DMat3], displacements: &[DVec3]) -> Vec<DVec3> {
        let shifted = &self.gradients.points;
        (0..patch.len())
            .map(|v| patch.points[v] + displacements[v] + gradients[v] * (patch.points[v] - shifted[v]))
            .collect()
    }

    /// Minus half the derivative of the sum of squares after the positions of the free vertices.
    fn descent(
        &self,
        patch: &Patch,
        displacements: &[DVec3],
        prescribed: &(dyn Fn(usize) -> DMat3 + Sync),
    ) -> Vec<DVec3> {
        let gradients = self.gradients(displacements, prescribed);
        let mut sides = vec![DVec3::ZERO; patch.free];
        let disagreements: Vec<DMat3> = (0..self.pairs.len())
            .into_par_iter()
            .with_min_len(1024)
            .map(|vertex| {
                let others = self.pairs.columns(vertex);
                let sum = others.iter().fold(DMat3::ZERO, |sum, other| sum + gradients[*other as usize]);
                gradients[vertex] * others.len() as f64 - sum
            })
            .collect();
        for (vertex, disagreement) in disagreements.iter().enumerate() {
            for (k, c) in self.gradients.rows.row(vertex) {
                if k < patch.free {
                    sides[k] -= *disagreement * c;
                }
            }
        }
        for (vertex, (gradient, coordinate)) in gradients.iter().zip(&self.coordinates).enumerate() {
            let mut residual: DVec3 = self.laplacians.row(vertex).map(|(k, r)| displacements[k] * r).sum();
            if !self.gradients.wanted[vertex] {
                residual -= *gradient * *coordinate;
            }
            for (k, r) in self.laplacians.row(vertex) {
                if k < patch.free {
                    sides[k] -= residual * r;
                }
            }
        }
        sides
    }
}

/// The row of (2.6) and `sqrt(A) delta`, with the weights of the mesh and the positions of the displaced one.
fn laplacian_row(
    patch: &Patch,
    gradients: &Gradients,
    vertex: usize,
    weights: &[f64],
    area: f64,
) -> (Vec<(u32, f64)>, DVec3) {
    let ring = patch.adjacency.ring(vertex as u32);
    if area <= 0.0 {
        return (Vec::new(), DVec3::ZERO);
    }
    let scale = 1.0 / area.sqrt();
    let own = gradients.points[vertex];
    let arms = ring.iter().zip(weights).map(|(k, w)| *w * (own - gradients.points[*k as usize]));
    let coordinate = scale * arms.sum::<DVec3>();
    let total: f64 = weights.iter().sum();
    let mut entries: Vec<(u32, f64)> = ring.iter().zip(weights).map(|(k, w)| (*k, -scale * w)).collect();
    entries.push((vertex as u32, scale * total));
    if gradients.wanted[vertex] {
        entries.extend(gradients.rows.row(vertex).map(|(k, c)| (k as u32, -c.dot(coordinate))));
    }
    entries.sort_unstable_by_key(|(k, _)| *k);
    entries.dedup_by(|from, to| {
        let same = from.0 == to.0;
        if same {
            to.1 += from.1;
        }
        same
    });
    (entries, coordinate)
}

/// `sum_j (M_i - M_j)` over the pairs of each vertex, as rows over the free vertices.
fn differences(rows: &Rows<DVec3>, pairs: &Rows<()>, free: usize) -> Rows<DVec3> {
    let made: Vec<Vec<(u32, DVec3)>> = (0..rows.len())
        .into_par_iter()
        .with_min_len(256)
        .map(|vertex| {
            let others = pairs.columns(vertex);
            let count = others.len() as f64;
            let own = rows.row(vertex).map(|(k, c)| (k as u32, c * count));
            let theirs = others.iter().flat_map(|other| rows.row(*other as usize).map(|(k, c)| (k as u32, -c)));
            let mut entries: Vec<(u32, DVec3)> = own.chain(theirs).filter(|(k, _)| (*k as usize) < free).collect();
            // Stable, so that equal columns are summed in one order.
            entries.sort_by_key(|(k, _)| *k);
            entries.dedup_by(|from, to| {
                let same = from.0 == to.0;
                if same {
                    to.1 += from.1;
                }
                same
            });
            entries
        })
        .collect();
    Rows::collect(made)
}
