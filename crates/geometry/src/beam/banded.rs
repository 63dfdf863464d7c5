//! Symmetric banded systems, factored once.

use super::quantity::Quantity;

/// `L D L'` of a symmetric positive definite matrix whose entries vanish farther than `width` from the diagonal.
/// Factoring takes O(n width^2), solving O(n width).
#[derive(Clone, Debug)]
pub(crate) struct BandedFactor {
    width: usize,
    /// Row `i` holds `L[i][i - k]` for `k = 1..=width`, zero where there is no such column.
    lower: Vec<f64>,
    diagonal: Vec<f64>,
}

impl BandedFactor {
    /// Factors the `size` by `size` matrix `entry(row, column)`, asked for with `column <= row <= column + width`.
    /// `None` where it is not positive definite to working precision.
    pub(crate) fn new(size: usize, width: usize, entry: impl Fn(usize, usize) -> f64) -> Option<Self> {
        let mut factor = Self { width, lower: vec![0.0; size * width], diagonal: vec![0.0; size] };
        for row in 0..size {
            let first = row.saturating_sub(width);
            for column in first..=row {
                let mut sum = entry(row, column);
                for k in first.max(column.saturating_sub(width))..column {
                    sum -= factor.lower_at(row, k) * factor.diagonal[k] * factor.lower_at(column, k);
                }
                if column < row {
                    factor.lower[row * width + (row - column - 1)] = sum / factor.diagonal[column];
                } else if sum > 0.0 && sum.is_finite() {
                    factor.diagonal[row] = sum;
                } else {
                    return None;
                }
            }
        }
        Some(factor)
    }

    fn lower_at(&self, row: usize, column: usize) -> f64 {
        self.lower[row * self.width + (row - column - 1)]
    }

    /// Replaces the right side by the solution. `right` has one entry a row.
    pub(crate) fn solve<T: Quantity>(&self, right: &mut [T]) {
        let size = self.diagonal.len();
        for row in 0..size {
            for column in row.saturating_sub(self.width)..row {
                right[row] = right[row] - right[column] * self.lower_at(row, column);
            }
        }
        for (value, pivot) in right.iter_mut().zip(&self.diagonal) {
            *value = *value * pivot.recip();
        }
        for row in (0..size).rev() {
            for column in row.saturating_sub(self.width)..row {
                right[column] = right[column] - right[row] * self.lower_at(row, column);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_a_band_of_width_two() {
        let entry = |row: usize, column: usize| [6.0, -4.0, 1.0][row - column];
        let factor = BandedFactor::new(7, 2, entry).unwrap();
        let wanted = [1.0, -2.0, 0.5, 3.0, 0.0, 4.0, -1.0];
        let mut right: Vec<f64> = (0..7_usize)
            .map(|i| (0..7_usize).filter(|j| i.abs_diff(*j) <= 2).map(|j| entry(i.max(j), i.min(j)) * wanted[j]).sum())
            .collect();
        factor.solve(&mut right);
        for (found, wanted) in right.iter().zip(wanted) {
            assert!((found - wanted).abs() < 1e-12, "{found} {wanted}");
        }
    }

    #[test]
    fn refuses_what_is_not_positive_definite() {
        assert!(BandedFactor::new(2, 1, |row, column| if row == column { 1.0 } else { 2.0 }).is_none());
        assert!(BandedFactor::new(1, 1, |_, _| f64::NAN).is_none());
        assert!(BandedFactor::new(0, 2, |_, _| 0.0).is_some());
    }
}
