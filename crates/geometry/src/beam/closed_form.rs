//! The exact solution of the beam equation between two ends, for any stiffness.

use super::stiffness::Stiffness;

/// The Hermite basis of `k_b d'''' - k_s d'' = 0` on [0, 1]. With `lambda^2 = k_s/k_b`, `c = cosh lambda`,
/// `s = sinh lambda` and `D = lambda s - 2 (c - 1)`:
/// `H01 D = cosh(lambda (1-u)) - c - cosh(lambda u) + 1 + s lambda u`,
/// `H11 lambda D = s - sinh(lambda (1-u)) - sinh(lambda u) + lambda (cosh(lambda u) - 1) - (c - 1) lambda u`,
/// `H00 = 1 - H01`, `H10(u) = -H11(1 - u)`; the cubic Hermite polynomials for `k_s = 0`.
///
/// Accurate to 1e-12: a power series in `lambda` up to 2, where the formulas cancel, and exponentials that cannot
/// overflow beyond.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExactHermite {
    lambda: f64,
}

impl ExactHermite {
    /// The basis for a stiffness.
    pub fn new(stiffness: Stiffness) -> Self {
        Self { lambda: stiffness.ratio().sqrt() }
    }

    /// `[H00, H10, H01, H11]` at `u`, clamped to [0, 1]: start position, start tangent, end position, end tangent.
    pub fn values(&self, u: f64) -> [f64; 4] {
        let u = u.clamp(0.0, 1.0);
        let (position, tangent) = self.end_values(u);
        [1.0 - position, -self.end_values(1.0 - u).1, position, tangent]
    }

    /// Derivatives of [`ExactHermite::values`] by `u`.
    pub fn derivatives(&self, u: f64) -> [f64; 4] {
        let u = u.clamp(0.0, 1.0);
        let (position, tangent) = self.end_derivatives(u);
        [-position, self.end_derivatives(1.0 - u).1, position, tangent]
    }

    /// `H01` and `H11`.
    fn end_values(&self, u: f64) -> (f64, f64) {
        if self.lambda <= SERIES_UP_TO {
            let w = 1.0 - u;
            return self.series(|n, f| {
                let odd = n as i32 + 1;
                (
                    (w.powi(n as i32) - 1.0 - u.powi(n as i32)) * f.even + u * f.before,
                    (1.0 - w.powi(odd) - u.powi(odd)) * f.odd + (u.powi(n as i32) - u) * f.even,
                )
            });
        }
        let l = self.lambda;
        let e = Scaled::new(l);
        (
            (e.cosh(1.0 - u) - e.cosh(1.0) - e.cosh(u) + e.one() + e.sinh(1.0) * l * u) / e.denominator(),
            (e.sinh(1.0) - e.sinh(1.0 - u) - e.sinh(u) + l * (e.cosh(u) - e.one()) - (e.cosh(1.0) - e.one()) * l * u)
                / (l * e.denominator()),
        )
    }

    /// `dH01/du` and `dH11/du`.
    fn end_derivatives(&self, u: f64) -> (f64, f64) {
        if self.lambda <= SERIES_UP_TO {
            let w = 1.0 - u;
            return self.series(|n, f| {
                let below = n as i32 - 1;
                (
                    (1.0 - w.powi(below) - u.powi(below)) * f.before,
                    (w.powi(n as i32) - u.powi(n as i32) - 1.0) * f.even + u.powi(below) * f.before,
                )
            });
        }
        let l = self.lambda;
        let e = Scaled::new(l);
        (
            l * (e.sinh(1.0) - e.sinh(1.0 - u) - e.sinh(u)) / e.denominator(),
            (e.cosh(1.0 - u) - e.cosh(u) + l * e.sinh(u) - (e.cosh(1.0) - e.one())) / e.denominator(),
        )
    }

    /// Sums `term(n)` times `lambda^(n - 4)` over even `n >= 4`, over the like sum of `D`.
    fn series(&self, term: impl Fn(u32, Factorials) -> (f64, f64)) -> (f64, f64) {
        let square = self.lambda * self.lambda;
        let mut power = 1.0;
        let mut factorial = 6.0; // (n - 1)!
        let (mut position, mut tangent, mut denominator) = (0.0, 0.0, 0.0);
        for n in (4..=30).step_by(2) {
            let even = factorial * f64::from(n);
            let odd = even * f64::from(n + 1);
            let f = Factorials { before: 1.0 / factorial, even: 1.0 / even, odd: 1.0 / odd };
            let (p, t) = term(n, f);
            position += power * p;
            tangent += power * t;
            denominator += power * (f.before - 2.0 * f.even);
            power *= square;
            factorial = odd;
        }
        (position / denominator, tangent / denominator)
    }
}

/// Up to this `lambda` the power series is used; its term `n = 30` is below `2^26 / 29!`.
const SERIES_UP_TO: f64 = 2.0;

/// `1/(n-1)!`, `1/n!` and `1/(n+1)!`.
#[derive(Clone, Copy)]
struct Factorials {
    before: f64,
    even: f64,
    odd: f64,
}

/// Hyperbolic functions of `lambda x`, all times `2 exp(-lambda)`, for `x` in [0, 1].
struct Scaled {
    lambda: f64,
}

impl Scaled {
    fn new(lambda: f64) -> Self {
        Self { lambda }
    }

    fn cosh(&self, x: f64) -> f64 {
        (-self.lambda * (1.0 - x)).exp() + (-self.lambda * (1.0 + x)).exp()
    }

    fn sinh(&self, x: f64) -> f64 {
        (-self.lambda * (1.0 - x)).exp() - (-self.lambda * (1.0 + x)).exp()
    }

    fn one(&self) -> f64 {
        2.0 * (-self.lambda).exp()
    }

    fn denominator(&self) -> f64 {
        self.lambda * self.sinh(1.0) - 2.0 * (self.cosh(1.0) - self.one())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn basis(ratio: f64) -> ExactHermite {
        ExactHermite::new(Stiffness::new(1.0, ratio).unwrap())
    }

    fn assert_close(found: [f64; 4], wanted: [f64; 4], tolerance: f64) {
        for (f, w) in found.iter().zip(wanted) {
            assert!((f - w).abs() < tolerance, "{found:?} {wanted:?}");
        }
    }

    #[test]
    fn reference_values() {
        assert_close(
            basis(2.8).values(0.3),
            [0.7816115685588, 0.1409795071327, 0.2183884314412, -0.05936793857391],
            1e-12,
        );
        assert_close(
            basis(2.8).derivatives(0.3),
            [-1.257093783219, 0.05324369766344, 1.257093783219, -0.3103374808822],
            1e-12,
        );
        assert_close(basis(0.0).values(0.3), [0.784, 0.147, 0.216, -0.063], 1e-15);
        assert_close(basis(0.0).derivatives(0.3), [-1.26, 0.07, 1.26, -0.33], 1e-15);
    }

    #[test]
    fn series_and_exponentials_agree_where_they_meet() {
        let (below, above) = (basis(4.0 - 1e-12), basis(4.0 + 1e-12));
        for u in [0.0, 0.1, 0.5, 0.8, 1.0] {
            assert_close(below.values(u), above.values(u), 1e-12);
            assert_close(below.derivatives(u), above.derivatives(u), 1e-12);
        }
    }

    #[test]
    fn ends_hold_for_any_stiffness() {
        for ratio in [0.0, 1e-9, 1.0, 3.9, 4.1, 2.8e3, 1e8, 1e12] {
            assert_close(basis(ratio).values(0.0), [1.0, 0.0, 0.0, 0.0], 1e-12);
            assert_close(basis(ratio).values(1.0), [0.0, 0.0, 1.0, 0.0], 1e-12);
            assert_close(basis(ratio).derivatives(0.0), [0.0, 1.0, 0.0, 0.0], 1e-9);
            assert_close(basis(ratio).derivatives(1.0), [0.0, 0.0, 0.0, 1.0], 1e-9);
        }
    }

    #[test]
    fn derivatives_are_those_of_the_values() {
        for ratio in [0.5, 30.0, 1e4] {
            let h = 1e-6;
            for u in [0.2, 0.5, 0.9] {
                let (before, after) = (basis(ratio).values(u - h), basis(ratio).values(u + h));
                let slope = std::array::from_fn(|k| (after[k] - before[k]) / (2.0 * h));
                assert_close(basis(ratio).derivatives(u), slope, 1e-6);
            }
        }
    }
}
