//! Linear least squares, free and with equality constraints, for several right sides at once.

use super::series::basis;
use nalgebra::{ColPivQR, DMatrix};

/// Diagonal entries of a triangular factor, and singular values, below this share of the largest count as zero.
const RANK: f64 = 1e-12;
/// Largest residual of normalised constraints that still counts as met.
const MET: f64 = 1e-9;

/// The basis functions (columns) at angles (rows).
pub(super) fn design(angles: &[f64], harmonics: usize) -> DMatrix<f64> {
    let mut matrix = DMatrix::zeros(angles.len(), 2 * harmonics + 1);
    let mut row = vec![0.0; 2 * harmonics + 1];
    for (i, angle) in angles.iter().enumerate() {
        basis(*angle, 0, &mut row);
        for (j, value) in row.iter().enumerate() {
            matrix[(i, j)] = *value;
        }
    }
    matrix
}

/// Least squares over the nested spaces of 0, 1, 2, .. harmonics: factored once, solved for each.
///
/// The orthogonal factorization of the matrix of most columns contains those of all leading blocks of columns. Where a
/// block has not full rank, its least-squares solution of least norm comes from singular values truncated at 1e-12.
pub(super) struct Nested {
    design: DMatrix<f64>,
    right: DMatrix<f64>,
    triangle: DMatrix<f64>,
    rotated: DMatrix<f64>,
}

impl Nested {
    /// `right` has a row for each angle.
    pub(super) fn new(angles: &[f64], harmonics: usize, right: DMatrix<f64>) -> Self {
        let design = design(angles, harmonics);
        let factored = design.clone().qr();
        let mut rotated = right.clone();
        factored.q_tr_mul(&mut rotated);
        Self { triangle: factored.unpack_r(), design, right, rotated }
    }

    /// Most harmonics that can be solved for.
    pub(super) fn most(&self) -> usize {
        self.design.ncols() / 2
    }

    /// The coefficients (rows) for each right side (columns).
    pub(super) fn solve(&self, harmonics: usize) -> DMatrix<f64> {
        let count = (2 * harmonics + 1).min(self.design.ncols());
        if count <= self.triangle.nrows() {
            let leading = self.triangle.view((0, 0), (count, count));
            if full_rank(leading.diagonal().iter().copied())
                && let Some(solution) = leading.solve_upper_triangular(&self.rotated.rows(0, count))
            {
                return solution;
            }
        }
        truncated(self.design.columns(0, count).into_owned(), &self.right)
    }

    /// What is left of the right sides.
    pub(super) fn residuals(&self, solution: &DMatrix<f64>) -> DMatrix<f64> {
        &self.right - self.design.columns(0, solution.nrows()) * solution
    }
}

/// Minimises `|a x - f|` for each column of `f`.
fn free(a: DMatrix<f64>, f: &DMatrix<f64>) -> DMatrix<f64> {
    if a.ncols() == 0 || a.nrows() < a.ncols() {
        return truncated(a, f);
    }
    let factored = a.clone().qr();
    let mut rotated = f.clone();
    factored.q_tr_mul(&mut rotated);
    let triangle = factored.unpack_r();
    let count = triangle.nrows();
    match triangle.solve_upper_triangular(&rotated.rows(0, count)) {
        Some(solution) if full_rank(triangle.diagonal().iter().copied()) => solution,
        _ => truncated(a, f),
    }
}

/// Minimises `|a x - f|` subject to `b x = d`, for each column of `f` and `d`, by the null space of `b`: its rows are
/// normalised and an orthogonal factorization with pivots splits the space into what they fix and what is free, which
/// holds for every angle of a joint and for constraints that repeat one another.
///
/// None where the constraints contradict one another, or so nearly repeat one another that they can't be met to 1e-9 of
/// the larger of 1 and `d`.
pub(super) fn constrained(
    a: &DMatrix<f64>,
    f: &DMatrix<f64>,
    mut b: DMatrix<f64>,
    mut d: DMatrix<f64>,
) -> Option<DMatrix<f64>> {
    let unknowns = a.ncols();
    for i in 0..b.nrows() {
        let norm = b.row(i).norm();
        if norm > 0.0 {
            b.row_mut(i).unscale_mut(norm);
            d.row_mut(i).unscale_mut(norm);
        }
    }
    let factored = ColPivQR::new(b.transpose());
    let triangle = factored.r();
    let diagonal: Vec<f64> = triangle.diagonal().iter().map(|r| r.abs()).collect();
    let largest = diagonal.first().copied().unwrap_or(0.0);
    let rank = diagonal.iter().take_while(|r| **r > RANK * largest).count();
    // Rows of Q': the first span what the constraints fix, the others what they leave free.
    let mut rotation = DMatrix::identity(unknowns, unknowns);
    factored.q_tr_mul(&mut rotation);
    let mut pivoted = d.clone();
    factored.p().permute_rows(&mut pivoted);
    let fixed = triangle.view((0, 0), (rank, rank)).tr_solve_upper_triangular(&pivoted.rows(0, rank))?;
    let particular = rotation.rows(0, rank).tr_mul(&fixed);
    if (&b * &particular - &d).amax() > MET * d.amax().max(1.0) {
        return None;
    }
    let null = rotation.rows(rank, unknowns - rank);
    let reduced = a * null.transpose();
    let solved = free(reduced, &(f - a * &particular));
    Some(particular + null.tr_mul(&solved))
}

fn full_rank(diagonal: impl Iterator<Item = f64>) -> bool {
    let (least, most) = diagonal.fold((f64::INFINITY, 0.0), |(l, m): (f64, f64), r| (l.min(r.abs()), m.max(r.abs())));
    least > RANK * most
}

/// The solution of least norm by singular values; zero where the values are beyond all numbers.
fn truncated(a: DMatrix<f64>, f: &DMatrix<f64>) -> DMatrix<f64> {
    let zero = DMatrix::zeros(a.ncols(), f.ncols());
    if a.is_empty() {
        return zero;
    }
    let svd = a.svd(true, true);
    let largest = svd.singular_values.max();
    svd.solve(f, RANK * largest).unwrap_or(zero)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn samples(count: u32, to: f64) -> (Vec<f64>, DMatrix<f64>) {
        let angles: Vec<f64> = (0..count).map(|i| to * f64::from(i) / f64::from(count)).collect();
        let f = |v: f64| (v.sin().exp() - v.cos(), (2.0 * v).cos() * v);
        let right = DMatrix::from_fn(angles.len(), 2, |i, j| if j == 0 { f(angles[i]).0 } else { f(angles[i]).1 });
        (angles, right)
    }

    #[test]
    fn nested_solutions_are_those_of_each_size_alone() {
        let (angles, right) = samples(50, 4.0);
        let nested = Nested::new(&angles, 8, right.clone());
        for harmonics in 0..=8 {
            let direct = truncated(design(&angles, harmonics), &right);
            let solved = nested.solve(harmonics);
            let gap = (nested.residuals(&solved) - nested.residuals(&direct)).amax();
            assert!(gap < 1e-10, "{harmonics}: {gap}");
        }
    }

    #[test]
    fn a_space_of_too_low_rank_gives_the_solution_of_least_norm() {
        // Four angles carry four functions at most.
        let (angles, right) = samples(4, TAU);
        let nested = Nested::new(&angles, 3, right);
        let solved = nested.solve(3);
        assert!(nested.residuals(&solved).amax() < 1e-12);
        assert!(solved.amax() < 10.0);
    }

    #[test]
    fn constraints_are_met_and_the_rest_is_least() {
        let (angles, right) = samples(40, TAU);
        let a = design(&angles, 3);
        let b = design(&[1.0, 2.5], 3);
        let d = DMatrix::from_row_slice(2, 2, &[0.5, 1.0, -0.3, 2.0]);
        let x = constrained(&a, &right, b.clone(), d.clone()).unwrap();
        assert!((&b * &x - &d).amax() < 1e-13);
        // The gradient lies in the span of the constraints: any feasible step makes it worse.
        let best = (&a * &x - &right).norm();
        let null = DMatrix::identity(7, 7) - b.clone().pseudo_inverse(1e-12).unwrap() * &b;
        for k in 0..7 {
            let step = null.column(k) * 1e-3;
            for sign in [1.0, -1.0] {
                let mut moved = x.clone();
                for c in 0..2 {
                    moved.column_mut(c).axpy(sign, &step, 1.0);
                }
                assert!((&a * moved - &right).norm() >= best);
            }
        }
        // Repeated constraints change nothing, contradictory ones are refused.
        let twice = DMatrix::from_fn(3, 7, |i, j| b[(i % 2, j)]);
        let same = constrained(&a, &right, twice.clone(), DMatrix::from_fn(3, 2, |i, j| d[(i % 2, j)])).unwrap();
        assert!((same - x).amax() < 1e-12);
        assert!(constrained(&a, &right, twice, DMatrix::from_fn(3, 2, |i, _| i as f64)).is_none());
    }
}
