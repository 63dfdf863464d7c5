//! Interpolating C2 cubic splines over given parameters.

use glam::DVec3;
use std::ops::{Mul, Sub};

/// A cubic spline through points at given parameters, twice continuously differentiable.
///
/// The second derivatives at the points solve a tridiagonal system (cyclic where periodic) by Thomas's algorithm,
/// which is exact but for rounding: the system is diagonally dominant for any increasing parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct CubicSpline {
    parameters: Vec<f64>,
    points: Vec<DVec3>,
    /// Second derivative at each point.
    moments: Vec<DVec3>,
    periodic: bool,
}

/// Why parameters and points do not make a spline.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SplineError {
    /// Fewer points than the spline needs.
    #[error("{found} point(s) given, and this spline needs at least {needed}")]
    TooFewPoints {
        /// Points found.
        found: usize,
        /// Points needed.
        needed: usize,
    },
    /// A number of parameters that does not fit the points.
    #[error("{found} parameters given for {points} points, and there should be {needed}")]
    ParameterCount {
        /// Parameters found.
        found: usize,
        /// Points given.
        points: usize,
        /// Parameters needed.
        needed: usize,
    },
    /// A parameter that is not greater than the one before it.
    #[error("parameter {index} is not greater than the one before it: parameters must increase")]
    NotIncreasing {
        /// Index of the parameter, counted from 0.
        index: usize,
    },
    /// A point, parameter or end slope that is not a number or is infinite.
    #[error("{what} {index} is not finite")]
    NotFinite {
        /// Which of the inputs.
        what: &'static str,
        /// Index in it, counted from 0.
        index: usize,
    },
}

impl CubicSpline {
    /// The spline with zero second derivative at both ends. One parameter a point; at least two points.
    ///
    /// # Errors
    /// [`SplineError`] where the inputs do not fit, are not finite, or the parameters do not increase.
    pub fn natural(parameters: Vec<f64>, points: Vec<DVec3>) -> Result<Self, SplineError> {
        check(&parameters, &points, 2, points.len())?;
        let mut moments = vec![DVec3::ZERO; points.len()];
        let inner = points.len() - 2;
        if inner > 0 {
            let (steps, slopes) = steps_and_slopes(&parameters, &points, false);
            let right = (1..=inner).map(|i| 6.0 * (slopes[i] - slopes[i - 1])).collect();
            let diagonal = (1..=inner).map(|i| 2.0 * (steps[i - 1] + steps[i])).collect();
            moments[1..=inner].copy_from_slice(&thomas(diagonal, &steps[1..inner], right));
        }
        Ok(Self { parameters, points, moments, periodic: false })
    }

    /// The spline with the given first derivatives (per unit of the parameter) at both ends. One parameter a point;
    /// at least two points.
    ///
    /// # Errors
    /// [`SplineError`] where the inputs do not fit, are not finite, or the parameters do not increase.
    pub fn clamped(
        parameters: Vec<f64>,
        points: Vec<DVec3>,
        start_slope: DVec3,
        end_slope: DVec3,
    ) -> Result<Self, SplineError> {
        check(&parameters, &points, 2, points.len())?;
        if let Some(index) = [start_slope, end_slope].iter().position(|slope| !slope.is_finite()) {
            return Err(SplineError::NotFinite { what: "end slope", index });
        }
        let (steps, mut slopes) = steps_and_slopes(&parameters, &points, false);
        slopes.insert(0, start_slope);
        slopes.push(end_slope);
        let right = slopes.windows(2).map(|pair| 6.0 * (pair[1] - pair[0])).collect();
        let diagonal = (0..points.len())
            .map(|i| 2.0 * (i.checked_sub(1).map_or(0.0, |before| steps[before]) + steps.get(i).unwrap_or(&0.0)))
            .collect();
        let moments = thomas(diagonal, &steps, right);
        Ok(Self { parameters, points, moments, periodic: false })
    }

    /// The spline that leaves its ends as the parabolas through the first and the last three points do: where a curve bends
    /// at its ends, a natural spline, straight there, swings beside them. One parameter a point; at least three points.
    ///
    /// # Errors
    /// [`SplineError`] where the inputs do not fit, are not finite, or the parameters do not increase.
    pub fn parabolic(parameters: Vec<f64>, points: Vec<DVec3>) -> Result<Self, SplineError> {
        check(&parameters, &points, 3, points.len())?;
        let (steps, slopes) = steps_and_slopes(&parameters, &points, false);
        let last = slopes.len() - 1;
        let at_end = |end: usize, next: usize| {
            slopes[end] + (slopes[end] - slopes[next]) * (steps[end] / (steps[end] + steps[next]))
        };
        let (start, end) = (at_end(0, 1), at_end(last, last - 1));
        Self::clamped(parameters, points, start, end)
    }

    /// The closed spline that comes back to its first point at the last parameter: one parameter more than points;
    /// at least three points.
    ///
    /// # Errors
    /// [`SplineError`] where the inputs do not fit, are not finite, or the parameters do not increase.
    pub fn periodic(parameters: Vec<f64>, mut points: Vec<DVec3>) -> Result<Self, SplineError> {
        check(&parameters, &points, 3, points.len() + 1)?;
        let count = points.len();
        let (steps, slopes) = steps_and_slopes(&parameters, &points, true);
        let before = |i: usize| (i + count - 1) % count;
        let right = (0..count).map(|i| 6.0 * (slopes[i] - slopes[before(i)])).collect();
        let diagonal = (0..count).map(|i| 2.0 * (steps[before(i)] + steps[i])).collect();
        let mut moments = cyclic_thomas(diagonal, &steps, right);
        moments.push(moments[0]);
        points.push(points[0]);
        Ok(Self { parameters, points, moments, periodic: true })
    }

    /// First and last parameter.
    pub fn domain(&self) -> (f64, f64) {
        (self.parameters[0], self.parameters[self.parameters.len() - 1])
    }

    /// The parameters of the points; where periodic the last one is that of the first point, met again.
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// Whether the spline is closed.
    pub fn is_periodic(&self) -> bool {
        self.periodic
    }

    /// The point at parameter `t`. A `t` outside the domain is clamped to it, or wrapped where periodic; the value at
    /// NaN is that of the start.
    pub fn position(&self, t: f64) -> DVec3 {
        let (span, t) = self.locate(t);
        self.position_in(span, t)
    }

    /// The first derivative by the parameter at `t`, which is treated as in [`CubicSpline::position`].
    pub fn derivative(&self, t: f64) -> DVec3 {
        let (span, t) = self.locate(t);
        self.derivative_in(span, t)
    }

    /// The second derivative by the parameter at `t`, which is treated as in [`CubicSpline::position`].
    pub fn second_derivative(&self, t: f64) -> DVec3 {
        let (span, t) = self.locate(t);
        let (a, b, _) = self.weights(span, t);
        a * self.moments[span] + b * self.moments[span + 1]
    }

    /// Number of cubic pieces.
    pub(super) fn spans(&self) -> usize {
        self.parameters.len() - 1
    }

    /// [`CubicSpline::position`] in a piece known beforehand.
    pub(super) fn position_in(&self, span: usize, t: f64) -> DVec3 {
        let (a, b, h) = self.weights(span, t);
        a * self.points[span]
            + b * self.points[span + 1]
            + ((a * a * a - a) * self.moments[span] + (b * b * b - b) * self.moments[span + 1]) * (h * h / 6.0)
    }

    /// [`CubicSpline::derivative`] in a piece known beforehand.
    pub(super) fn derivative_in(&self, span: usize, t: f64) -> DVec3 {
        let (a, b, h) = self.weights(span, t);
        (self.points[span + 1] - self.points[span]) / h
            + ((1.0 - 3.0 * a * a) * self.moments[span] + (3.0 * b * b - 1.0) * self.moments[span + 1]) * (h / 6.0)
    }

    fn weights(&self, span: usize, t: f64) -> (f64, f64, f64) {
        let h = self.parameters[span + 1] - self.parameters[span];
        ((self.parameters[span + 1] - t) / h, (t - self.parameters[span]) / h, h)
    }

    fn locate(&self, t: f64) -> (usize, f64) {
        let (low, high) = self.domain();
        let t = match t {
            t if t.is_nan() => low,
            t if self.periodic && t.is_finite() && !(low..=high).contains(&t) => low + (t - low).rem_euclid(high - low),
            t => t.clamp(low, high),
        };
        let span = self.parameters.partition_point(|p| *p <= t).saturating_sub(1);
        (span.min(self.spans() - 1), t)
    }
}

/// `count` parameters from 0 to 1 in equal steps (none for 0, only 0 for 1).
pub fn uniform_parameters(count: usize) -> Vec<f64> {
    (0..count).map(|i| i as f64 / (count.max(2) - 1) as f64).collect()
}

/// Parameters at the running length of the chords between points, metres, from 0; where `closed`, one more for the
/// way back to the first point.
pub fn chord_parameters(points: &[DVec3], closed: bool) -> Vec<f64> {
    let back = if closed { points.first() } else { None };
    let mut before = points.first();
    let mut length = 0.0;
    points
        .iter()
        .chain(back)
        .map(|point| {
            length += before.map_or(0.0, |b| b.distance(*point));
            before = Some(point);
            length
        })
        .collect()
}

fn check(parameters: &[f64], points: &[DVec3], needed: usize, parameters_needed: usize) -> Result<(), SplineError> {
    if points.len() < needed {
        return Err(SplineError::TooFewPoints { found: points.len(), needed });
    }
    if parameters.len() != parameters_needed {
        let (found, points) = (parameters.len(), points.len());
        return Err(SplineError::ParameterCount { found, points, needed: parameters_needed });
    }
    if let Some(index) = points.iter().position(|p| !p.is_finite()) {
        return Err(SplineError::NotFinite { what: "point", index });
    }
    if let Some(index) = parameters.iter().position(|p| !p.is_finite()) {
        return Err(SplineError::NotFinite { what: "parameter", index });
    }
    match parameters.windows(2).position(|pair| pair[1] <= pair[0]) {
        Some(index) => Err(SplineError::NotIncreasing { index: index + 1 }),
        None => Ok(()),
    }
}

/// Steps between the parameters, and the slope of each chord.
fn steps_and_slopes(parameters: &[f64], points: &[DVec3], closed: bool) -> (Vec<f64>, Vec<DVec3>) {
    let steps: Vec<f64> = parameters.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let ends = points.iter().skip(1).chain(if closed { points.first() } else { None });
    let slopes = points.iter().zip(ends).zip(&steps).map(|((from, to), step)| (*to - *from) / *step).collect();
    (steps, slopes)
}

/// Solves a symmetric tridiagonal system: `beside[i]` couples the unknowns `i` and `i + 1`.
fn thomas<T>(mut diagonal: Vec<f64>, beside: &[f64], mut right: Vec<T>) -> Vec<T>
where
    T: Copy + Mul<f64, Output = T> + Sub<Output = T>,
{
    let count = right.len();
    for i in 1..count {
        let factor = beside[i - 1] / diagonal[i - 1];
        diagonal[i] -= factor * beside[i - 1];
        right[i] = right[i] - right[i - 1] * factor;
    }
    for i in (0..count).rev() {
        if i + 1 < count {
            right[i] = right[i] - right[i + 1] * beside[i];
        }
        right[i] = right[i] * (1.0 / diagonal[i]);
    }
    right
}

/// Like [`thomas`], where the last entry of `beside` couples the last unknown with the first: the corner entries are a
/// rank-one change of a tridiagonal matrix (Sherman and Morrison).
fn cyclic_thomas(mut diagonal: Vec<f64>, beside: &[f64], right: Vec<DVec3>) -> Vec<DVec3> {
    let last = diagonal.len() - 1;
    let corner = beside[last];
    let gamma = -diagonal[0];
    diagonal[0] -= gamma;
    diagonal[last] -= corner * corner / gamma;
    let mut unit = vec![0.0; last + 1];
    unit[0] = gamma;
    unit[last] = corner;
    let z = thomas(diagonal.clone(), &beside[..last], unit);
    let mut x = thomas(diagonal, &beside[..last], right);
    let factor = (x[0] + x[last] * (corner / gamma)) / (1.0 + z[0] + z[last] * corner / gamma);
    for (x, z) in x.iter_mut().zip(z) {
        *x -= factor * z;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn scalars(values: &[f64]) -> Vec<DVec3> {
        values.iter().map(|v| DVec3::new(0.0, *v, -2.0 * v)).collect()
    }

    fn assert_values(spline: &CubicSpline, at: &[f64], expected: &[f64]) {
        for (t, expected) in at.iter().zip(expected) {
            let found = spline.position(*t);
            assert!((found - DVec3::new(0.0, *expected, -2.0 * expected)).length() < 1e-12, "{t}: {found}");
        }
    }

    #[test]
    fn parabolic_ends_follow_what_bends_there() {
        // Points of a circle at uneven angles: the slope at the ends, and how far it is off between points.
        let angles = [0.0, 0.07, 0.2, 0.26, 0.4, 0.5_f64];
        let points: Vec<DVec3> = angles.iter().map(|a| DVec3::new(a.cos(), a.sin(), 0.0)).collect();
        let off = |spline: &CubicSpline| {
            let places = (0..=200).map(|k| spline.position(0.5 * f64::from(k) / 200.0));
            places.map(|p| (p.length() - 1.0).abs()).fold(0.0, f64::max)
        };
        let round = CubicSpline::parabolic(angles.to_vec(), points.clone()).unwrap();
        let natural = CubicSpline::natural(angles.to_vec(), points.clone()).unwrap();
        assert!(round.derivative(0.0).distance(DVec3::Y) < 0.01 && natural.derivative(0.0).distance(DVec3::Y) > 0.02);
        assert!(off(&round) < 0.2 * off(&natural), "{} {}", off(&round), off(&natural));
        let few = CubicSpline::parabolic(vec![0.0, 1.0], points[..2].to_vec()).unwrap_err();
        assert!(matches!(few, SplineError::TooFewPoints { found: 2, needed: 3 }), "{few}");
        let parabola = |t: f64| DVec3::new(t, t * t, 1.0 - t * t);
        let exact = CubicSpline::parabolic(vec![-1.0, 0.5, 2.0], [-1.0, 0.5, 2.0].map(parabola).to_vec()).unwrap();
        assert!(exact.position(1.3).distance(parabola(1.3)) < 1e-14);
    }

    #[test]
    fn natural_and_clamped_reproduce_the_reference_values() {
        let points = scalars(&[0.0, 1.0, 0.5, 2.0]);
        let natural = CubicSpline::natural(uniform_parameters(4), points.clone()).unwrap();
        assert_values(&natural, &[0.2, 0.5, 0.9], &[0.8048, 0.7125, 1.3771]);
        let slopes = scalars(&[1.0, -1.0]);
        let clamped = CubicSpline::clamped(uniform_parameters(4), points, slopes[0], slopes[1]).unwrap();
        assert_values(&clamped, &[0.2, 0.5, 0.9], &[0.6672, 0.659_722_222_222_222_2, 1.7761]);
        assert!((clamped.derivative(0.0) - slopes[0]).length() < 1e-12);
        assert!((clamped.derivative(1.0) - slopes[1]).length() < 1e-12);
    }

    #[test]
    fn clamped_spline_reproduces_a_cubic_at_uneven_parameters() {
        let cubic = |t: f64| DVec3::new(t * t * t - t, 2.0 * t * t, 1.0 - t * t * t);
        let slope = |t: f64| DVec3::new(3.0 * t * t - 1.0, 4.0 * t, -3.0 * t * t);
        for parameters in [vec![-1.0, 2.0], vec![-1.0, -0.9, 0.3, 1.5, 2.0]] {
            let points = parameters.iter().map(|t| cubic(*t)).collect();
            let spline = CubicSpline::clamped(parameters, points, slope(-1.0), slope(2.0)).unwrap();
            for i in 0..=30 {
                let t = -1.0 + 0.1 * f64::from(i);
                assert!((spline.position(t) - cubic(t)).length() < 1e-12);
                assert!((spline.derivative(t) - slope(t)).length() < 1e-12);
                assert!((spline.second_derivative(t) - DVec3::new(6.0 * t, 4.0, -6.0 * t)).length() < 1e-11);
            }
        }
    }

    #[test]
    fn pieces_join_with_equal_derivatives_for_every_kind() {
        let points: Vec<DVec3> =
            (0..7).map(f64::from).map(|i| DVec3::new((i * 1.3).sin(), (i * 0.7).cos(), i * i % 3.0)).collect();
        let open = chord_parameters(&points, false);
        let kinds = [
            CubicSpline::natural(open.clone(), points.clone()).unwrap(),
            CubicSpline::clamped(open, points.clone(), DVec3::X, DVec3::Y).unwrap(),
            CubicSpline::periodic(chord_parameters(&points, true), points.clone()).unwrap(),
        ];
        for spline in &kinds {
            for (i, point) in points.iter().enumerate() {
                assert!((spline.position(spline.parameters()[i]) - *point).length() < 1e-12);
            }
            for span in 1..spline.spans() {
                let t = spline.parameters()[span];
                let jump = spline.derivative_in(span, t) - spline.derivative_in(span - 1, t);
                assert!(jump.length() < 1e-11, "{jump}");
            }
        }
        let (low, high) = kinds[2].domain();
        let jump = kinds[2].derivative_in(0, low) - kinds[2].derivative_in(kinds[2].spans() - 1, high);
        assert!(jump.length() < 1e-11, "{jump}");
        assert!((kinds[2].second_derivative(low) - kinds[2].second_derivative(high)).length() < 1e-11);
        let (low, high) = kinds[0].domain();
        assert!(kinds[0].second_derivative(low).length() + kinds[0].second_derivative(high).length() < 1e-11);
    }

    #[test]
    fn periodic_spline_of_a_circle_converges_with_fourth_order() {
        let error = |count: usize| {
            let points = (0..count).map(|i| DVec3::from_angle(TAU * i as f64 / count as f64)).collect();
            let spline = CubicSpline::periodic(uniform_parameters(count + 1), points).unwrap();
            (0..1000)
                .map(|i| {
                    spline.position(f64::from(i) / 1000.0).distance(DVec3::from_angle(TAU * f64::from(i) / 1000.0))
                })
                .fold(0.0, f64::max)
        };
        let ratio = error(8) / error(16);
        assert!((12.0..20.0).contains(&ratio), "{ratio}");
    }

    trait FromAngle {
        fn from_angle(angle: f64) -> DVec3;
    }

    impl FromAngle for DVec3 {
        fn from_angle(angle: f64) -> DVec3 {
            DVec3::new(angle.cos(), angle.sin(), 0.0)
        }
    }

    #[test]
    fn parameters_outside_the_domain_are_clamped_or_wrapped() {
        let points = scalars(&[0.0, 1.0, 3.0]);
        let natural = CubicSpline::natural(vec![1.0, 2.0, 4.0], points.clone()).unwrap();
        assert_eq!(natural.position(-5.0), points[0]);
        assert_eq!(natural.position(f64::INFINITY), points[2]);
        assert_eq!(natural.position(f64::NAN), points[0]);
        let periodic = CubicSpline::periodic(vec![1.0, 2.0, 4.0, 5.0], points).unwrap();
        assert!((periodic.position(2.3) - periodic.position(2.3 - 8.0)).length() < 1e-12);
        assert!(periodic.position(f64::INFINITY).is_finite());
    }

    #[test]
    fn unfit_inputs_are_refused() {
        let points = scalars(&[0.0, 1.0]);
        let natural = |parameters: &[f64], points: &[DVec3]| {
            CubicSpline::natural(parameters.to_vec(), points.to_vec()).unwrap_err()
        };
        assert_eq!(natural(&[0.0], &points[..1]), SplineError::TooFewPoints { found: 1, needed: 2 });
        assert_eq!(natural(&[0.0], &points), SplineError::ParameterCount { found: 1, points: 2, needed: 2 });
        assert_eq!(natural(&[0.0, 0.0], &points), SplineError::NotIncreasing { index: 1 });
        assert_eq!(natural(&[0.0, f64::NAN], &points), SplineError::NotFinite { what: "parameter", index: 1 });
        assert_eq!(
            natural(&[0.0, 1.0], &[DVec3::ZERO, DVec3::INFINITY]),
            SplineError::NotFinite { what: "point", index: 1 }
        );
        assert_eq!(
            CubicSpline::clamped(vec![0.0, 1.0], points.clone(), DVec3::X, DVec3::NAN).unwrap_err(),
            SplineError::NotFinite { what: "end slope", index: 1 }
        );
        assert_eq!(
            CubicSpline::periodic(vec![0.0, 1.0, 2.0], points).unwrap_err(),
            SplineError::TooFewPoints { found: 2, needed: 3 }
        );
    }
}
