//! Sparse symmetric systems, factored once and solved many times. The only file that names the back end that factors.
//!
//! Matrices are `sprs` ones, columns compressed, of which only the lower triangle is kept. They are factored by `faer`
//! as `L L^T`, after an ordering by approximate minimum degree or, where the unknowns are vertices of a mesh, by nested
//! dissection. One thread does it, so that a result never depends on their number.

pub mod nested_dissection;

use std::mem::size_of;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, LltRegularization};
use faer::perm::PermRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};
use glam::DVec3;
use nested_dissection::Graph;
use sprs::CsMat;

/// Difference, relative to 1, at which a system counts as singular: see [`Cholesky::factor`].
const LARGEST_ERROR: f64 = 1e-3;

/// Why a system has no factor.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LinearSolverError {
    /// A matrix that is not square.
    #[error("the matrix has {rows} rows and {columns} columns: a symmetric one has as many of both")]
    NotSquare {
        /// Its rows.
        rows: usize,
        /// Its columns.
        columns: usize,
    },
    /// A matrix compressed by rows, or with entries above the diagonal.
    #[error("the matrix is not the lower triangle by columns: give only entries with row >= column")]
    NotLower,
    /// An entry that is not a number or is infinite.
    #[error("the matrix has an entry in column {column} that is not finite")]
    NotFinite {
        /// Its column.
        column: usize,
    },
    /// A matrix that is not positive definite, as far as rounding lets tell.
    #[error("the system has no unique solution (found at unknown {unknown}): more must be prescribed")]
    Singular {
        /// An unknown that is not determined.
        unknown: usize,
    },
    /// Not enough memory for the factor.
    #[error("there is not enough memory for the factor of a system with {unknowns} unknowns")]
    OutOfMemory {
        /// Size of the system.
        unknowns: usize,
    },
    /// Right-hand sides of another length than the system.
    #[error("{found} values given as right-hand side, and the system has {unknowns} unknowns")]
    WrongLength {
        /// Values found.
        found: usize,
        /// Size of the system.
        unknowns: usize,
    },
}

/// The factor of a symmetric, positive definite matrix.
#[derive(Debug)]
pub struct Cholesky {
    unknowns: usize,
    /// None for a system without unknowns.
    symbolic: Option<SymbolicCholesky<usize>>,
    values: Vec<f64>,
}

impl Cholesky {
    /// Factors a matrix given as its lower triangle, diagonal included, compressed by columns.
    ///
    /// A known vector is multiplied and solved for again; where it comes back with an error above 1e-3, the matrix is
    /// singular as far as rounding lets tell.
    ///
    /// # Errors
    /// [`LinearSolverError`] where the matrix has not that form, is not positive definite or does not fit into memory.
    pub fn factor(lower: &CsMat<f64>) -> Result<Self, LinearSolverError> {
        Self::factor_in_order(lower, None)
    }

    /// The same for a matrix whose unknowns lie on a surface: the order of elimination comes from there, so that less
    /// fills in.
    ///
    /// # Errors
    /// As [`Cholesky::factor`], and [`LinearSolverError::WrongLength`] where the graph has another number of unknowns.
    pub fn factor_along(lower: &CsMat<f64>, graph: &Graph) -> Result<Self, LinearSolverError> {
        if graph.unknowns() != lower.cols() {
            return Err(LinearSolverError::WrongLength { found: graph.unknowns(), unknowns: lower.cols() });
        }
        Self::factor_in_order(lower, Some(graph))
    }

    fn factor_in_order(lower: &CsMat<f64>, graph: Option<&Graph>) -> Result<Self, LinearSolverError> {
        check(lower)?;
        let unknowns = lower.cols();
        if unknowns == 0 {
            return Ok(Self { unknowns, symbolic: None, values: Vec::new() });
        }
        let indptr = lower.indptr();
        let pattern =
            SymbolicSparseColMatRef::new_checked(unknowns, unknowns, indptr.raw_storage(), None, lower.indices());
        let matrix = SparseColMatRef::new(pattern, lower.data());
        let out_of_memory = |_| LinearSolverError::OutOfMemory { unknowns };
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..CholeskySymbolicParams::default()
        };
        let order = graph.map(Graph::order);
        let places = order.as_ref().map(|order| {
            let mut places = vec![0; unknowns];
            order.iter().enumerate().for_each(|(place, unknown)| places[*unknown] = place);
            places
        });
        let ordering = match (&order, &places) {
            (Some(order), Some(places)) => SymmetricOrdering::Custom(PermRef::new_checked(order, places, unknowns)),
            _ => SymmetricOrdering::Amd,
        };
        let symbolic = factorize_symbolic_cholesky(pattern, Side::Lower, ordering, params).map_err(out_of_memory)?;
        // Whether there is room is asked first, and then zeros are taken as the system has them: written out one by one,
        // they cost as much as a tenth of the factor.
        let room = Vec::<f64>::new().try_reserve_exact(symbolic.len_val());
        room.map_err(|_| LinearSolverError::OutOfMemory { unknowns })?;
        let mut values = vec![0.0; symbolic.len_val()];
        let scratch = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| LinearSolverError::OutOfMemory { unknowns })?;
        symbolic
            .factorize_numeric_llt(
                &mut values,
                matrix,
                Side::Lower,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut memory),
                Default::default(),
            )
            // The index counts in the order of elimination, and blocks count from their own start.
            .map_err(|LltError::NonPositivePivot { index }| LinearSolverError::Singular {
                unknown: index.min(unknowns - 1),
            })?;
        drop(memory);
        let factor = Self { unknowns, symbolic: Some(symbolic), values };
        factor.probe(lower)?;
        Ok(factor)
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.unknowns
    }

    /// Bytes that the values of the factor take.
    pub fn bytes(&self) -> usize {
        self.values.len() * size_of::<f64>()
    }

    /// Solves for any number of right-hand sides, which lie one behind the other, and puts the solutions in their place.
    ///
    /// # Errors
    /// [`LinearSolverError::WrongLength`] where their length is no multiple of the number of unknowns, and
    /// [`LinearSolverError::OutOfMemory`].
    pub fn solve(&self, sides: &mut [f64]) -> Result<(), LinearSolverError> {
        let unknowns = self.unknowns;
        let Some(symbolic) = &self.symbolic else {
            let found = sides.len();
            return if found == 0 { Ok(()) } else { Err(LinearSolverError::WrongLength { found, unknowns }) };
        };
        if !sides.len().is_multiple_of(unknowns) {
            return Err(LinearSolverError::WrongLength { found: sides.len(), unknowns });
        }
        let count = sides.len() / unknowns;
        let scratch = symbolic.solve_in_place_scratch::<f64>(count, Par::Seq);
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| LinearSolverError::OutOfMemory { unknowns })?;
        LltRef::new(symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(sides, unknowns, count),
            Par::Seq,
            MemStack::new(&mut memory),
        );
        Ok(())
    }

    /// Solves for the three coordinates of points at once, in place.
    ///
    /// # Errors
    /// [`LinearSolverError`] as [`Cholesky::solve`].
    pub fn solve_points(&self, points: &mut [DVec3]) -> Result<(), LinearSolverError> {
        if points.len() != self.unknowns {
            return Err(LinearSolverError::WrongLength { found: points.len(), unknowns: self.unknowns });
        }
        let mut sides: Vec<f64> = (0..3).flat_map(|axis| points.iter().map(move |p| p[axis])).collect();
        self.solve(&mut sides)?;
        let (x, yz) = sides.split_at(points.len());
        let (y, z) = yz.split_at(points.len());
        for (point, ((x, y), z)) in points.iter_mut().zip(x.iter().zip(y).zip(z)) {
            *point = DVec3::new(*x, *y, *z);
        }
        Ok(())
    }

    /// Whether a known vector comes back from being multiplied and solved for.
    fn probe(&self, lower: &CsMat<f64>) -> Result<(), LinearSolverError> {
        // Smooth and rough at once: a constant, which most singular systems lose, and signs without a pattern.
        let known = |i: usize| if (i.wrapping_mul(0x9E37_79B9) >> 7) & 1 == 0 { 0.75 } else { 1.25 };
        let mut side = vec![0.0; self.unknowns];
        for (column, entries) in lower.outer_iterator().enumerate() {
            for (row, value) in entries.iter() {
                side[row] += value * known(column);
                if row != column {
                    side[column] += value * known(row);
                }
            }
        }
        self.solve(&mut side)?;
        let error = |(i, x): (usize, &f64)| if x.is_finite() { (x - known(i)).abs() } else { f64::INFINITY };
        let worst = side.iter().enumerate().map(|(i, x)| (error((i, x)), i)).max_by(|a, b| a.0.total_cmp(&b.0));
        match worst {
            Some((error, unknown)) if error > LARGEST_ERROR => Err(LinearSolverError::Singular { unknown }),
            _ => Ok(()),
        }
    }
}

fn check(lower: &CsMat<f64>) -> Result<(), LinearSolverError> {
    let (rows, columns) = (lower.rows(), lower.cols());
    if rows != columns {
        return Err(LinearSolverError::NotSquare { rows, columns });
    }
    if !lower.is_csc() {
        return Err(LinearSolverError::NotLower);
    }
    for (column, entries) in lower.outer_iterator().enumerate() {
        if entries.indices().first().is_some_and(|row| *row < column) {
            return Err(LinearSolverError::NotLower);
        }
        if entries.data().iter().any(|value| !value.is_finite()) {
            return Err(LinearSolverError::NotFinite { column });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprs::TriMat;

    /// A chain of springs, its first end held.
    fn chain(count: usize, held: f64) -> CsMat<f64> {
        let mut entries = TriMat::new((count, count));
        for i in 0..count {
            entries.add_triplet(i, i, if i + 1 == count { 1.0 } else { 2.0 });
            if i > 0 {
                entries.add_triplet(i, i - 1, -1.0);
            }
        }
        entries.add_triplet(0, 0, held - 1.0);
        entries.to_csc()
    }

    #[test]
    fn a_chain_pulled_at_its_end_is_straight() {
        let factor = Cholesky::factor(&chain(1000, 1.0)).unwrap();
        let mut sides = vec![0.0; 2000];
        sides[999] = 1.0;
        sides[1999] = -2.0;
        factor.solve(&mut sides).unwrap();
        for i in 0..1000 {
            let x = (i + 1) as f64;
            assert!((sides[i] - x).abs() < 1e-9 * 1000.0 && (sides[1000 + i] + 2.0 * x).abs() < 1e-9 * 2000.0);
        }
    }

    #[test]
    fn a_chain_in_the_order_of_its_graph_is_solved_alike() {
        let places: Vec<DVec3> = (0..1000).map(|i| DVec3::X * f64::from(i)).collect();
        let lists: Vec<Vec<u32>> =
            (0..1000_u32).map(|i| [i.checked_sub(1), Some(i + 1)].into_iter().flatten().collect()).collect();
        let graph = Graph::new(&places, lists.iter().map(Vec::as_slice), 1);
        let factor = Cholesky::factor_along(&chain(1000, 1.0), &graph).unwrap();
        let mut side = vec![0.0; 1000];
        side[999] = 1.0;
        factor.solve(&mut side).unwrap();
        assert!((0..1000).all(|i| (side[i] - (i + 1) as f64).abs() < 1e-9 * 1000.0));
        let shorter = Cholesky::factor_along(&chain(999, 1.0), &graph).unwrap_err();
        assert_eq!(shorter, LinearSolverError::WrongLength { found: 1000, unknowns: 999 });
    }

    #[test]
    fn points_are_solved_by_coordinate() {
        let factor = Cholesky::factor(&chain(50, 1.0)).unwrap();
        let mut points = vec![DVec3::ZERO; 50];
        points[49] = DVec3::new(1.0, -2.0, 0.5);
        factor.solve_points(&mut points).unwrap();
        assert!(points[9].distance(DVec3::new(10.0, -20.0, 5.0)) < 1e-9);
        assert_eq!(factor.unknowns(), 50);
        assert!(factor.bytes() >= 99 * 8);
    }

    #[test]
    fn what_is_not_determined_is_refused() {
        let free = Cholesky::factor(&chain(1000, 0.0)).unwrap_err();
        assert!(matches!(free, LinearSolverError::Singular { .. }), "{free}");
        let negative = Cholesky::factor(&chain(10, -3.0)).unwrap_err();
        assert!(matches!(negative, LinearSolverError::Singular { .. }), "{negative}");
        let barely = Cholesky::factor(&chain(1000, 1e-18)).unwrap_err();
        assert!(matches!(barely, LinearSolverError::Singular { .. }), "{barely}");
    }

    #[test]
    fn malformed_matrices_are_refused() {
        let upper = chain(4, 1.0).transpose_into().to_csc();
        assert_eq!(Cholesky::factor(&upper).unwrap_err(), LinearSolverError::NotLower);
        assert_eq!(Cholesky::factor(&chain(4, 1.0).to_csr()).unwrap_err(), LinearSolverError::NotLower);
        let wide: CsMat<f64> = CsMat::zero((2, 3)).to_csc();
        assert_eq!(Cholesky::factor(&wide).unwrap_err(), LinearSolverError::NotSquare { rows: 2, columns: 3 });
        let nan = chain(4, f64::NAN);
        assert_eq!(Cholesky::factor(&nan).unwrap_err(), LinearSolverError::NotFinite { column: 0 });
        let empty: CsMat<f64> = CsMat::zero((0, 0)).to_csc();
        let factor = Cholesky::factor(&empty).unwrap();
        factor.solve(&mut []).unwrap();
        assert_eq!(factor.solve(&mut [1.0]), Err(LinearSolverError::WrongLength { found: 1, unknowns: 0 }));
        let chain = Cholesky::factor(&chain(4, 1.0)).unwrap();
        assert_eq!(chain.solve(&mut [1.0; 6]), Err(LinearSolverError::WrongLength { found: 6, unknowns: 4 }));
    }
}
