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
    /// Vertices with a pair whose gradients feel held vertices: the only ones to disagree while the free ones rest.
    rim: Vec<u32>,
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
        let coordinate = |vertex: usize| coordinate(patch, &gradients, vertex, &weights[vertex], areas[vertex]);
        let coordinates: Vec<DVec3> = (0..free).into_par_iter().with_min_len(1024).map(coordinate).collect();
        let laplacians = Rows::build(free, Vec::new, |entries, vertex, rows| {
            laplacian_row(patch, &gradients, vertex, &weights[vertex], areas[vertex], coordinates[vertex], entries);
            rows.push(entries.iter().copied());
        });
        go_on(0.1)?;
        let scratch = || (vec![u32::MAX; patch.len()], Vec::new());
        let pairs = Rows::build(patch.len(), scratch, |(seen, near), vertex, rows| {
            near.clear();
            if gradients.wanted[vertex] {
                within_two(patch, vertex as u32, seen, near);
            }
            let counts = near.iter().filter(|other| vertex < free || (**other as usize) < free);
            rows.push(counts.map(|other| (*other, ())));
        });
        let feels = |vertex: usize| {
            !gradients.wanted[vertex] || gradients.rows.columns(vertex).last().is_some_and(|k| *k as usize >= free)
        };
        let feels: Vec<bool> = (0..patch.len()).map(feels).collect();
        let disagrees = |v: &u32| {
            let others = pairs.columns(*v as usize);
            !others.is_empty() && (feels[*v as usize] || others.iter().any(|other| feels[*other as usize]))
        };
        let rim: Vec<u32> = (0..patch.len() as u32).filter(disagrees).collect();
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
        // Gradients of two rings are compared, each of which takes in another ring.
        let factor = Cholesky::factor_along(&matrix, &patch.graph(4))?;
        go_on(1.0)?;
        Ok(Self { gradients, laplacians, coordinates, pairs, rim, factor })
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
    /// The residual of all rows is solved for once more, which takes as long again and makes up for what the square of
    /// the rows' condition loses.
    pub fn solve(
        &self,
        patch: &Patch,
        displacements: &mut Vec<DVec3>,
        prescribed: &(dyn Fn(usize) -> DMat3 + Sync),
    ) -> Result<(), DeformError> {
        self.solve_all(patch, std::slice::from_mut(displacements), &|_, vertex| prescribed(vertex))
    }

    /// The same for several problems at once, which come cheaper together; `prescribed` gets the problem and the vertex.
    pub fn solve_all(
        &self,
        patch: &Patch,
        problems: &mut [Vec<DVec3>],
        prescribed: &(dyn Fn(usize, usize) -> DMat3 + Sync),
    ) -> Result<(), DeformError> {
        let free = patch.free;
        problems.iter_mut().for_each(|displacements| displacements[..free].fill(DVec3::ZERO));
        for at_rest in [true, false] {
            let mut sides = Vec::with_capacity(3 * free * problems.len());
            for (problem, displacements) in problems.iter().enumerate() {
                let points = self.descent(patch, displacements, &|vertex| prescribed(problem, vertex), at_rest);
                (0..3).for_each(|axis| sides.extend(points.iter().map(|p| p[axis])));
            }
            self.factor.solve(&mut sides)?;
            for (displacements, found) in problems.iter_mut().zip(sides.chunks_exact((3 * free).max(1))) {
                for (vertex, displacement) in displacements[..free].iter_mut().enumerate() {
                    *displacement += DVec3::from([0, 1, 2].map(|axis| found[axis * free + vertex]));
                }
            }
        }
        if problems.iter().flatten().all(|u| u.is_finite()) { Ok(()) } else { Err(DeformError::Overflow) }
    }

    /// The deformation gradients less the identity at all vertices that have one.
    pub fn gradients(&self, displacements: &[DVec3], prescribed: &(dyn Fn(usize) -> DMat3 + Sync)) -> Vec<DMat3> {
        let of = |vertex: usize| self.gradient(vertex, displacements, prescribed);
        (0..self.gradients.rows.len()).into_par_iter().with_min_len(1024).map(of).collect()
    }

    fn gradient(&self, vertex: usize, displacements: &[DVec3], prescribed: &(dyn Fn(usize) -> DMat3 + Sync)) -> DMat3 {
        if !self.gradients.wanted[vertex] {
            return prescribed(vertex);
        }
        // Sums over the three columns, written out: many wait for this.
        let (mut x, mut y, mut z) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        for (k, c) in self.gradients.rows.row(vertex) {
            let u = displacements[k];
            x += u * c.x;
            y += u * c.y;
            z += u * c.z;
        }
        DMat3::from_cols(x, y, z)
    }

    /// The positions of the mesh itself where the displacements are those of the displaced one (below 2.9); `prescribed` as
    /// for [`Implicit::gradients`].
    pub fn undisplace(
        &self,
        patch: &Patch,
        displacements: &[DVec3],
        prescribed: &(dyn Fn(usize) -> DMat3 + Sync),
    ) -> Vec<DVec3> {
        let mut points: Vec<DVec3> = patch.points.iter().zip(displacements).map(|(p, u)| *p + *u).collect();
        for (vertex, point) in points.iter_mut().enumerate() {
            let back = patch.points[vertex] - self.gradients.points[vertex];
            if back != DVec3::ZERO {
                *point += self.gradient(vertex, displacements, prescribed) * back;
            }
        }
        points
    }

    /// Minus half the derivative of the sum of squares after the positions of the free vertices; `at_rest` where these are
    /// not displaced.
    fn descent(
        &self,
        patch: &Patch,
        displacements: &[DVec3],
        prescribed: &(dyn Fn(usize) -> DMat3 + Sync),
        at_rest: bool,
    ) -> Vec<DVec3> {
        let gradients = self.gradients(displacements, prescribed);
        let mut sides = vec![DVec3::ZERO; patch.free];
        let disagreement = |vertex: usize| {
            let others = self.pairs.columns(vertex);
            let sum = others.iter().fold(DMat3::ZERO, |sum, other| sum + gradients[*other as usize]);
            gradients[vertex] * others.len() as f64 - sum
        };
        let mut add = |vertex: usize, disagreement: &DMat3| {
            for (k, c) in self.gradients.rows.row(vertex) {
                if k < patch.free {
                    sides[k] -= *disagreement * c;
                }
            }
        };
        if at_rest {
            self.rim.iter().for_each(|vertex| add(*vertex as usize, &disagreement(*vertex as usize)));
        } else {
            let all = (0..self.pairs.len()).into_par_iter().with_min_len(1024).map(disagreement);
            all.collect::<Vec<_>>().iter().enumerate().for_each(|(vertex, d)| add(vertex, d));
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

/// `sqrt(A) delta`, with the weights of the mesh and the positions of the displaced one.
fn coordinate(patch: &Patch, gradients: &Gradients, vertex: usize, weights: &[f64], area: f64) -> DVec3 {
    if area <= 0.0 {
        return DVec3::ZERO;
    }
    let own = gradients.points[vertex];
    let ring = patch.adjacency.ring(vertex as u32);
    let arms = ring.iter().zip(weights).map(|(k, w)| *w * (own - gradients.points[*k as usize]));
    arms.sum::<DVec3>() / area.sqrt()
}

/// The row of (2.6), with the same, put in the place of `entries`.
fn laplacian_row(
    patch: &Patch,
    gradients: &Gradients,
    vertex: usize,
    weights: &[f64],
    area: f64,
    coordinate: DVec3,
    entries: &mut Vec<(u32, f64)>,
) {
    entries.clear();
    if area <= 0.0 {
        return;
    }
    let scale = 1.0 / area.sqrt();
    let ring = patch.adjacency.ring(vertex as u32);
    let total: f64 = weights.iter().sum();
    entries.extend(ring.iter().zip(weights).map(|(k, w)| (*k, -scale * w)));
    entries.push((vertex as u32, scale * total));
    if gradients.wanted[vertex] {
        entries.extend(gradients.rows.row(vertex).map(|(k, c)| (k as u32, -c.dot(coordinate))));
    }
    // Stable, so that equal columns are summed in one order.
    entries.sort_by_key(|(k, _)| *k);
    entries.dedup_by(|from, to| {
        let same = from.0 == to.0;
        if same {
            to.1 += from.1;
        }
        same
    });
}

/// The vertices within two edges, ascending, without the vertex itself; `seen` holds for each vertex the one for which it
/// was last found.
fn within_two(patch: &Patch, vertex: u32, seen: &mut [u32], near: &mut Vec<u32>) {
    seen[vertex as usize] = vertex;
    for &beside in patch.adjacency.ring(vertex) {
        if std::mem::replace(&mut seen[beside as usize], vertex) != vertex {
            near.push(beside);
        }
        for &next in patch.adjacency.ring(beside) {
            if std::mem::replace(&mut seen[next as usize], vertex) != vertex {
                near.push(next);
            }
        }
    }
    near.sort_unstable();
}

/// `sum_j (M_i - M_j)` over the pairs of each vertex, as rows over the free vertices.
fn differences(rows: &Rows<DVec3>, pairs: &Rows<()>, free: usize) -> Rows<DVec3> {
    // A value for each column, the row that last used it, and the columns of this row.
    let scratch = || (vec![DVec3::ZERO; free], vec![u32::MAX; free], Vec::<u32>::new());
    Rows::build(rows.len(), scratch, |(values, used, columns), vertex, made| {
        columns.clear();
        let mut add = |column: usize, value: DVec3| {
            if used[column] == vertex as u32 {
                values[column] += value;
            } else {
                used[column] = vertex as u32;
                values[column] = value;
                columns.push(column as u32);
            }
        };
        let others = pairs.columns(vertex);
        let count = others.len() as f64;
        // Held vertices come behind the free ones.
        let is_free = |(column, _): &(usize, DVec3)| *column < free;
        rows.row(vertex).take_while(is_free).for_each(|(column, value)| add(column, value * count));
        for other in others {
            rows.row(*other as usize).take_while(is_free).for_each(|(column, value)| add(column, -value));
        }
        columns.sort_unstable();
        made.push(columns.iter().map(|column| (*column, values[*column as usize])));
    })
}
