//! The exact beam curve through given points: the tension spline.

use super::banded::BandedFactor;
use super::error::BeamError;
use super::quantity::Quantity;
use super::stiffness::Stiffness;
use super::system::check_values;

/// How an end of a [`TensionSpline`] is held; its position is that of its knot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SplineEnd<T> {
    /// With the tangent `dP/du`.
    Clamped(T),
    /// Turning freely: `d'' = 0`.
    Natural,
}

/// The exact solution of `k_b d'''' - k_s d'' = 0` that passes through values at given `u` and is pushed by no force
/// between them: what the difference schemes tend to. A cubic spline for `k_s = 0`.
///
/// On an interval of length `l` from `y0` to `y1` with second derivatives `M0`, `M1`, `t` in [0, 1] and
/// `x = l sqrt(k_s/k_b)`: `d = (1-t) y0 + t y1 + l^2 (M0 S(1-t) + M1 S(t))`, `S(t) = (sinh(x t)/sinh x - t)/x^2`. The
/// second derivatives follow from the slopes' continuity, a tridiagonal system. Power series up to `x = 2`, where these
/// formulas cancel, and exponentials that cannot overflow beyond: accurate to 1e-12 of the values.
#[derive(Clone, Debug, PartialEq)]
pub struct TensionSpline<T> {
    lambda: f64,
    /// Knots; for a periodic curve at last the first one a period later.
    parameters: Vec<f64>,
    values: Vec<T>,
    moments: Vec<T>,
    periodic: bool,
}

impl<T: Quantity> TensionSpline<T> {
    /// The open curve through `values` at `parameters` (increasing, in [0, 1], two at least), from the first to the last
    /// of them.
    ///
    /// # Errors
    /// [`BeamError`] where the lists do not fit together, parameters do not increase, or a value is not finite.
    pub fn open(
        parameters: &[f64],
        values: &[T],
        ends: [SplineEnd<T>; 2],
        stiffness: Stiffness,
    ) -> Result<Self, BeamError> {
        check_parameters(parameters, 2)?;
        check_values("values", values, parameters.len())?;
        for end in &ends {
            if let SplineEnd::Clamped(tangent) = end {
                check_values("end tangents", &[*tangent], 1)?;
            }
        }
        let lambda = stiffness.ratio().sqrt();
        let spans = spans(parameters, lambda);
        let moments = open_moments(&spans, values, ends)?;
        finite(Self { lambda, parameters: parameters.to_vec(), values: values.to_vec(), moments, periodic: false })
    }

    /// The closed curve through `values` at `parameters` (increasing, in [0, 1), one at least); its period is 1.
    ///
    /// # Errors
    /// [`BeamError`] where the lists do not fit together, parameters do not increase, or a value is not finite.
    pub fn periodic(parameters: &[f64], values: &[T], stiffness: Stiffness) -> Result<Self, BeamError> {
        check_parameters(parameters, 1)?;
        let last = parameters.len() - 1;
        if parameters[last] - parameters[0] >= 1.0 {
            return Err(BeamError::Unordered { index: last });
        }
        check_values("values", values, parameters.len())?;
        let (mut parameters, mut values) = (parameters.to_vec(), values.to_vec());
        parameters.push(parameters[0] + 1.0);
        values.push(values[0]);
        let lambda = stiffness.ratio().sqrt();
        let moments = periodic_moments(&spans(&parameters, lambda), &values)?;
        finite(Self { lambda, parameters, values, moments, periodic: true })
    }

    /// The curve at `u`; of an open one the nearest end's value beyond its knots.
    pub fn value(&self, u: f64) -> T {
        let (k, t, length) = self.locate(u);
        let (s0, s1) = (bow(self.lambda * length, 1.0 - t), bow(self.lambda * length, t));
        self.values[k] * (1.0 - t)
            + self.values[k + 1] * t
            + (self.moments[k] * s0.value + self.moments[k + 1] * s1.value) * (length * length)
    }

    /// The derivative by `u`.
    pub fn derivative(&self, u: f64) -> T {
        let (k, t, length) = self.locate(u);
        let (s0, s1) = (bow(self.lambda * length, 1.0 - t), bow(self.lambda * length, t));
        (self.values[k + 1] - self.values[k]) * length.recip()
            + (self.moments[k + 1] * s1.slope - self.moments[k] * s0.slope) * length
    }

    /// Second derivative at each knot; for a periodic curve once more at the first.
    pub fn moments(&self) -> &[T] {
        &self.moments
    }

    /// Interval, share of it and its length.
    fn locate(&self, u: f64) -> (usize, f64, f64) {
        let (first, last) = (self.parameters[0], self.parameters[self.parameters.len() - 1]);
        let u = if u.is_nan() { first } else { u };
        let u = if self.periodic && u.is_finite() { first + (u - first).rem_euclid(1.0) } else { u };
        let u = u.clamp(first, last);
        let k = self.parameters.partition_point(|p| *p <= u).clamp(1, self.parameters.len() - 1) - 1;
        let length = self.parameters[k + 1] - self.parameters[k];
        (k, ((u - self.parameters[k]) / length).clamp(0.0, 1.0), length)
    }
}

fn finite<T: Quantity>(spline: TensionSpline<T>) -> Result<TensionSpline<T>, BeamError> {
    if spline.moments.iter().all(|moment| moment.finite()) { Ok(spline) } else { Err(BeamError::NotSolvable) }
}

fn check_parameters(parameters: &[f64], needed: usize) -> Result<(), BeamError> {
    if parameters.len() < needed {
        return Err(BeamError::TooFewNodes { found: parameters.len(), needed });
    }
    let wrong = |i: usize| {
        !(0.0..=1.0).contains(&parameters[i])
            || i > 0 && parameters[i].partial_cmp(&parameters[i - 1]).is_none_or(|o| o.is_le())
    };
    match (0..parameters.len()).find(|i| wrong(*i)) {
        Some(index) => Err(BeamError::Unordered { index }),
        None => Ok(()),
    }
}

/// One interval: its length, and what the second derivatives at its ends take from the slope at the near one:
/// `slope = (y1 - y0)/length - near M0 - far M1`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub(super) length: f64,
    pub(super) near: f64,
    pub(super) far: f64,
}

fn spans(parameters: &[f64], lambda: f64) -> Vec<Span> {
    let span = |pair: &[f64]| {
        let length = pair[1] - pair[0];
        // S'(0) and S'(1), the latter without its sign.
        let (start, end) = (bow(lambda * length, 0.0).slope, bow(lambda * length, 1.0).slope);
        Span { length, near: length * end, far: -length * start }
    };
    parameters.windows(2).map(span).collect()
}

/// Second derivatives at the knots of an open curve.
pub(super) fn open_moments<T: Quantity>(
    spans: &[Span],
    values: &[T],
    ends: [SplineEnd<T>; 2],
) -> Result<Vec<T>, BeamError> {
    let last = spans.len();
    let chord = |k: usize| (values[k + 1] - values[k]) * spans[k].length.recip();
    let mut moments: Vec<T> = (0..=last)
        .map(|k| match (k, ends) {
            (0, [SplineEnd::Clamped(tangent), _]) => chord(0) - tangent,
            (k, [_, SplineEnd::Clamped(tangent)]) if k == last => tangent - chord(last - 1),
            (k, _) if k == 0 || k == last => T::default(),
            (k, _) => chord(k) - chord(k - 1),
        })
        .collect();
    let natural = ends.map(|end| end == SplineEnd::Natural);
    let entry = |row: usize, column: usize| {
        let held = |k: usize| k == 0 && natural[0] || k == last && natural[1];
        match row - column {
            0 if held(row) => 1.0,
            0 if row == 0 => spans[0].near,
            0 if row == last => spans[last - 1].near,
            0 => spans[row - 1].near + spans[row].near,
            _ if held(row) || held(column) => 0.0,
            _ => spans[column].far,
        }
    };
    let factor = BandedFactor::new(last + 1, 1, entry).ok_or(BeamError::NotSolvable)?;
    factor.solve(&mut moments);
    Ok(moments)
}

/// Second derivatives at the knots of a closed curve, whose last knot repeats the first.
pub(super) fn periodic_moments<T: Quantity>(spans: &[Span], values: &[T]) -> Result<Vec<T>, BeamError> {
    let count = spans.len();
    let chord = |k: usize| (values[k + 1] - values[k]) * spans[k].length.recip();
    let before = |k: usize| if k == 0 { count - 1 } else { k - 1 };
    // Folded as in the difference scheme: a plain band instead of far corners.
    let order: Vec<usize> = (0..count).map(|k| if k % 2 == 0 { k / 2 } else { count - 1 - k / 2 }).collect();
    let entry = |row: usize, column: usize| {
        let (a, b) = (order[row], order[column]);
        let mut sum = 0.0;
        // With one or two knots an interval has the same knots at both ends of the row.
        if a == b {
            sum += spans[before(a)].near + spans[a].near;
        }
        if before(a) == b {
            sum += spans[b].far;
        }
        if before(b) == a {
            sum += spans[a].far;
        }
        sum
    };
    let factor = BandedFactor::new(count, 2, entry).ok_or(BeamError::NotSolvable)?;
    let mut right: Vec<T> = order.iter().map(|k| chord(*k) - chord(before(*k))).collect();
    factor.solve(&mut right);
    let mut moments = vec![T::default(); count + 1];
    for (k, moment) in order.iter().zip(right) {
        moments[*k] = moment;
    }
    moments[count] = moments[0];
    Ok(moments)
}

/// `S(t)` and its derivative by `t`.
#[derive(Clone, Copy, Debug)]
struct Bow {
    value: f64,
    slope: f64,
}

/// Up to this `x` the power series is used; its term `x^28/29!` is below 1e-22.
const SERIES_UP_TO: f64 = 2.0;

fn bow(x: f64, t: f64) -> Bow {
    let square = x * x;
    if x > SERIES_UP_TO {
        // sinh(x t)/sinh x and cosh(x t)/sinh x without overflow.
        let whole = -(-2.0 * x).exp_m1();
        let decay = (x * (t - 1.0)).exp();
        let sinh = decay * -(-2.0 * x * t).exp_m1() / whole;
        let cosh = decay * (1.0 + (-2.0 * x * t).exp()) / whole;
        return Bow { value: (sinh - t) / square, slope: (x * cosh - 1.0) / square };
    }
    let (mut value, mut slope, mut denominator) = (0.0, 0.0, 1.0);
    let (mut power, mut factorial, mut t_power) = (1.0, 1.0, 1.0);
    for k in 1..=14_u32 {
        // Term 2k+1 of sinh: x^(2k) / (2k+1)!, with t^(2k).
        let (even, odd) = (f64::from(2 * k), f64::from(2 * k + 1));
        let before = factorial * even;
        factorial = before * odd;
        t_power *= t * t;
        value += power * (t_power * t - t) / factorial;
        slope += power * (t_power / before - 1.0 / factorial);
        power *= square;
        denominator += power / factorial;
    }
    Bow { value: value / denominator, slope: slope / denominator }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::beam::closed_form::ExactHermite;
    use glam::DVec2;

    fn stiffness(ratio: f64) -> Stiffness {
        Stiffness::new(1.0, ratio).unwrap()
    }

    #[test]
    fn closed_references() {
        let two = TensionSpline::periodic(&[0.0, 0.5], &[1.0, -1.0], stiffness(2.8)).unwrap();
        let wanted = [0.9435493250698, 0.7909329752074, 0.2952007941788, -0.2952007941788, -0.9435493250698];
        for (u, d) in [0.05, 0.1, 0.2, 0.3, 0.45].into_iter().zip(wanted) {
            assert!((two.value(u) - d).abs() < 1e-12, "{u}");
        }
        let cubic = TensionSpline::periodic(&[0.0, 0.5], &[1.0, -1.0], stiffness(0.0)).unwrap();
        for (u, d) in [(0.05, 0.944), (0.1, 0.792), (0.2, 0.296), (0.3, -0.296), (0.45, -0.944)] {
            assert!((cubic.value(u) - d).abs() < 1e-14);
        }
        let three = TensionSpline::periodic(&[0.0, 0.2, 0.7], &[1.0, 0.3, -0.5], stiffness(2.8)).unwrap();
        let wanted = [0.7932014465486, -0.5681670915681, -0.7880316915054, 0.4002628573627];
        for (u, d) in [0.1, 0.4, 0.5, 0.85].into_iter().zip(wanted) {
            assert!((three.value(u) - d).abs() < 1e-12 && (three.value(u + 3.0) - d).abs() < 1e-12, "{u}");
        }
        let one = TensionSpline::periodic(&[0.4], &[DVec2::new(2.0, 3.0)], stiffness(1.0)).unwrap();
        assert!(one.value(0.9).distance(DVec2::new(2.0, 3.0)) < 1e-15);
    }

    #[test]
    fn rulers() {
        let free = [SplineEnd::Natural, SplineEnd::Natural];
        let supported = TensionSpline::open(&[0.0, 0.5, 1.0], &[0.0, 1.0, 0.0], free, stiffness(2.8)).unwrap();
        for (u, d) in [(0.25, 0.6827328411913), (0.5, 1.0), (0.75, 0.6827328411913)] {
            assert!((supported.value(u) - d).abs() < 1e-12);
        }
        let cantilever = TensionSpline::open(
            &[0.0, 1.0],
            &[0.0, 1.0],
            [SplineEnd::Clamped(0.0), SplineEnd::Natural],
            stiffness(2.8),
        );
        let cantilever = cantilever.unwrap();
        for (u, d) in [(0.25, 0.09501396845195), (0.5, 0.3299333554485), (0.75, 0.6462717329031)] {
            assert!((cantilever.value(u) - d).abs() < 1e-12);
        }
        // How far tension takes both from a plain beam.
        let off = |spline: &TensionSpline<f64>, beam: &dyn Fn(f64) -> f64| {
            (0..=10_000).map(|i| f64::from(i) / 1e4).map(|u| (spline.value(u) - beam(u)).abs()).fold(0.0, f64::max)
        };
        assert!((off(&cantilever, &|x| x * x * (3.0 - x) / 2.0) - 0.01768743924924).abs() < 1e-9);
        let half = |x: f64| 3.0 * x - 4.0 * x.powi(3);
        assert!((off(&supported, &|x| half(x.min(1.0 - x))) - 0.004847397734722).abs() < 1e-9);
    }

    #[test]
    fn between_two_ends_it_is_the_hermite_basis() {
        for ratio in [0.0, 1e-6, 2.8, 3.9, 4.1, 900.0, 1e8, 1e12] {
            let exact = ExactHermite::new(stiffness(ratio));
            let ends = [SplineEnd::Clamped(0.7), SplineEnd::Clamped(-1.3)];
            let spline = TensionSpline::open(&[0.0, 1.0], &[0.4, -0.2], ends, stiffness(ratio)).unwrap();
            for u in [0.0, 0.01, 0.3, 0.5, 0.99, 1.0] {
                let sum = |h: [f64; 4]| 0.4 * h[0] + 0.7 * h[1] - 0.2 * h[2] - 1.3 * h[3];
                let (value, slope) = (sum(exact.values(u)), sum(exact.derivatives(u)));
                assert!((spline.value(u) - value).abs() < 1e-12, "{ratio} {u}: {} {value}", spline.value(u));
                assert!((spline.derivative(u) - slope).abs() < 1e-9, "{ratio} {u}: {} {slope}", spline.derivative(u));
            }
        }
    }

    #[test]
    fn joins_are_smooth_and_knots_exact_however_taut() {
        let at = [0.0, 0.1, 0.15, 0.6, 1.0];
        let values = [0.0, 1.0, -1.0, 2.0, 0.5];
        for ratio in [0.0, 2.8, 1e4, 1e8] {
            let ends = [SplineEnd::Natural, SplineEnd::Clamped(1.0)];
            let open = TensionSpline::open(&at, &values, ends, stiffness(ratio)).unwrap();
            let closed = TensionSpline::periodic(&at[..4], &values[..4], stiffness(ratio)).unwrap();
            for (spline, count) in [(&open, 5), (&closed, 4)] {
                for k in 0..count {
                    assert!((spline.value(at[k]) - values[k]).abs() < 1e-14);
                }
                for u in &at[1..4] {
                    let e = 1e-9;
                    let (left, right) = (spline.derivative(u - e), spline.derivative(u + e));
                    assert!((left - right).abs() < 1e-2 * (1.0 + left.abs()), "{ratio} {u}: {left} {right}");
                }
            }
            assert!(open.moments()[0] == 0.0 && open.value(7.0) == 0.5 && open.value(f64::NAN) == 0.0);
        }
    }

    #[test]
    fn errors() {
        let natural = [SplineEnd::Natural; 2];
        let open = |at: &[f64], values: &[f64]| TensionSpline::open(at, values, natural, stiffness(1.0)).map(|_| ());
        assert_eq!(open(&[0.0], &[1.0]), Err(BeamError::TooFewNodes { found: 1, needed: 2 }));
        for at in [[0.0, 0.5, 0.5], [0.0, 0.5, 1.5], [0.0, 0.5, f64::NAN]] {
            assert_eq!(open(&at, &[0.0; 3]), Err(BeamError::Unordered { index: 2 }));
        }
        assert!(matches!(open(&[0.0, 1.0], &[1.0]), Err(BeamError::Count { .. })));
        assert!(matches!(open(&[0.0, 1.0], &[1.0, f64::NAN]), Err(BeamError::NotFinite { index: 1, .. })));
        assert_eq!(open(&[0.0, 1e-300, 1.0], &[-1e200, 1e200, 0.0]), Err(BeamError::NotSolvable));
        let clamped = [SplineEnd::Clamped(f64::NAN), SplineEnd::Natural];
        assert!(TensionSpline::open(&[0.0, 1.0], &[0.0; 2], clamped, stiffness(1.0)).is_err());
        let closed = TensionSpline::periodic(&[0.0, 1.0], &[0.0; 2], stiffness(1.0));
        assert_eq!(closed.err(), Some(BeamError::Unordered { index: 1 }));
        assert!(TensionSpline::<f64>::periodic(&[], &[], stiffness(1.0)).is_err());
    }
}
