//! A point that runs along a trigonometric series.

use glam::{DAffine3, DMat3, DVec3};
use std::f64::consts::PI;

/// A generalized ellipse (thesis 3.3) in world coordinates:
/// `S(v) = c[0] + sum over j = 1..J of c[2j-1] cos jv + c[2j] sin jv`, metres; `v` in radians.
///
/// x, y and z share one basis in one order, where the thesis swaps sine and cosine in y and has z constant: a planar
/// section is the case in which all coefficients but the first lie in one plane, and the first is the centre plus the
/// constant term.
///
/// Invariants, kept by the constructors: an odd number of coefficients, all finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    coefficients: Vec<DVec3>,
}

/// Why coefficients do not make a series.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SeriesError {
    /// A number of coefficients that is not odd.
    #[error("{found} coefficients given, and a series of J harmonics has 2J+1: one constant, a cosine and a sine each")]
    CoefficientCount {
        /// Coefficients found.
        found: usize,
    },
    /// A coefficient that is not a number or is infinite.
    #[error("coefficient {index} is not a finite number")]
    NotFinite {
        /// Index of the coefficient, counted from 0.
        index: usize,
    },
}

impl Series {
    /// Makes a series from its coefficients: constant, cos v, sin v, cos 2v, sin 2v, ..
    ///
    /// # Errors
    /// [`SeriesError`] where their number is even or one is not finite.
    pub fn new(coefficients: Vec<DVec3>) -> Result<Self, SeriesError> {
        if coefficients.len().is_multiple_of(2) {
            return Err(SeriesError::CoefficientCount { found: coefficients.len() });
        }
        if let Some(index) = coefficients.iter().position(|c| !c.is_finite()) {
            return Err(SeriesError::NotFinite { index });
        }
        Ok(Self { coefficients })
    }

    /// A single point: a series without harmonics.
    pub(super) fn point(point: DVec3) -> Self {
        Self { coefficients: vec![point] }
    }

    /// The coefficients: constant, cos v, sin v, cos 2v, sin 2v, ..
    pub fn coefficients(&self) -> &[DVec3] {
        &self.coefficients
    }

    /// Number of harmonics J; 0 for a single point.
    pub fn harmonics(&self) -> usize {
        self.coefficients.len() / 2
    }

    /// The point at angle `v`, by the recurrence of [`harmonics`]: exact to about `J` roundings.
    pub fn value(&self, v: f64) -> DVec3 {
        self.derivatives::<1>(v)[0]
    }

    /// The derivative of the given order with respect to `v` at `v`; order 0 is the value.
    pub fn derivative(&self, v: f64, order: usize) -> DVec3 {
        let mut sum = if order == 0 { self.coefficients[0] } else { DVec3::ZERO };
        for (j, turn, pair) in self.terms(v) {
            let scale = f64::from(j).powi(i32::try_from(order).unwrap_or(i32::MAX));
            sum += scale * differentiated(turn, order, pair);
        }
        sum
    }

    /// The value and the first `N - 1` derivatives with respect to `v`, in one pass.
    pub fn derivatives<const N: usize>(&self, v: f64) -> [DVec3; N] {
        let mut sums = [DVec3::ZERO; N];
        if let Some(value) = sums.first_mut() {
            *value = self.coefficients[0];
        }
        for (j, turn, pair) in self.terms(v) {
            let mut scale = 1.0;
            for (order, sum) in sums.iter_mut().enumerate() {
                *sum += scale * differentiated(turn, order, pair);
                scale *= f64::from(j);
            }
        }
        sums
    }

    /// j, (cos jv, sin jv), and the coefficients of both.
    fn terms(&self, v: f64) -> impl Iterator<Item = (u32, (f64, f64), (DVec3, DVec3))> {
        let pairs = self.coefficients[1..].chunks_exact(2).map(|pair| (pair[0], pair[1]));
        (1..).zip(harmonics(v)).zip(pairs).map(|((j, turn), pair)| (j, turn, pair))
    }

    /// The same curve as a series of at least `harmonics` harmonics, the new ones zero; unchanged where it has more.
    #[must_use]
    pub fn padded(mut self, harmonics: usize) -> Self {
        let count = self.coefficients.len().max(2 * harmonics + 1);
        self.coefficients.resize(count, DVec3::ZERO);
        self
    }

    /// The series of the points mapped by an affine map: as exact as mapping the points.
    ///
    /// # Errors
    /// [`SeriesError::NotFinite`] where the map takes a coefficient out of the numbers.
    pub fn transformed(&self, map: &DAffine3) -> Result<Self, SeriesError> {
        let linear: DMat3 = map.matrix3;
        let coefficients = self
            .coefficients
            .iter()
            .enumerate()
            .map(|(i, c)| if i == 0 { linear * *c + map.translation } else { linear * *c })
            .collect();
        Self::new(coefficients)
    }

    /// The same curve with the angle counted from `start`: the point at `w` of the result is the one at `w + start`.
    #[must_use]
    pub fn started_at(&self, start: f64) -> Self {
        let mut coefficients = self.coefficients.clone();
        for ((cos, sin), pair) in harmonics(start).zip(coefficients[1..].chunks_exact_mut(2)) {
            let (a, b) = (pair[0], pair[1]);
            pair[0] = a * cos + b * sin;
            pair[1] = b * cos - a * sin;
        }
        Self { coefficients }
    }

    /// The same curve run the other way: the point at `w` of the result is the one at `-w`.
    #[must_use]
    pub fn reversed(mut self) -> Self {
        for pair in self.coefficients[1..].chunks_exact_mut(2) {
            pair[1] = -pair[1];
        }
        self
    }

    /// Area vector of one whole turn, square metres: its direction is the normal about which the curve runs
    /// counter-clockwise, its length the enclosed area where the curve is planar and simple. Exact:
    /// `pi sum of j (c[2j-1] x c[2j])`.
    pub fn area_vector(&self) -> DVec3 {
        (1..).zip(self.coefficients[1..].chunks_exact(2)).map(|(j, p)| PI * f64::from(j) * p[0].cross(p[1])).sum()
    }

    /// Bound on the length of the derivative of the given order over all angles: sum of `j^order (|c[2j-1]| +
    /// |c[2j]|)`.
    pub fn derivative_bound(&self, order: i32) -> f64 {
        (1..)
            .zip(self.coefficients[1..].chunks_exact(2))
            .map(|(j, pair)| f64::from(j).powi(order) * (pair[0].length() + pair[1].length()))
            .sum()
    }
}

/// (cos jv, sin jv) for j = 1, 2, ..: each from the one before by a rotation, whose rounding errors add up (about one
/// rounding a step) but are never magnified, as they are near v = 0 in the recurrence with three terms.
pub fn harmonics(v: f64) -> impl Iterator<Item = (f64, f64)> {
    let (sin, cos) = v.sin_cos();
    std::iter::successors(Some((cos, sin)), move |(c, s)| Some((c * cos - s * sin, s * cos + c * sin)))
}

/// The basis 1, cos v, sin v, cos 2v, .. and its derivatives: fills `row` (2J+1 entries) with the derivatives of the
/// given order with respect to `v`.
pub fn basis(v: f64, order: usize, row: &mut [f64]) {
    if let Some(constant) = row.first_mut() {
        *constant = if order == 0 { 1.0 } else { 0.0 };
    }
    let pairs = row.get_mut(1..).unwrap_or_default().chunks_exact_mut(2);
    for ((j, (cos, sin)), pair) in (1..).map(f64::from).zip(harmonics(v)).zip(pairs) {
        let scale = j.powi(i32::try_from(order).unwrap_or(i32::MAX));
        let (of_cos, of_sin) = match order % 4 {
            0 => (cos, sin),
            1 => (-sin, cos),
            2 => (-cos, -sin),
            _ => (sin, -cos),
        };
        (pair[0], pair[1]) = (scale * of_cos, scale * of_sin);
    }
}

/// The derivative of `a cos x + b sin x` of the given order with respect to x, where `turn` is (cos x, sin x).
fn differentiated(turn: (f64, f64), order: usize, (a, b): (DVec3, DVec3)) -> DVec3 {
    let (cos, sin) = turn;
    match order % 4 {
        0 => a * cos + b * sin,
        1 => b * cos - a * sin,
        2 => -(a * cos + b * sin),
        _ => a * sin - b * cos,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    fn wavy() -> Series {
        let c = |i: f64| DVec3::new((3.0 * i).cos(), (5.0 * i + 1.0).sin(), 0.3 * i) / (1.0 + i);
        Series::new((0..13).map(|i| c(f64::from(i))).collect()).unwrap()
    }

    /// Reference value V01: the series of the thesis with centre (1, -2), y in the order sine, cosine.
    #[test]
    fn value_and_derivative_of_the_reference() {
        let (a, b) = ([0.5, 2.0, 0.25, -0.1, 0.3], [-0.25, 1.5, 0.1, 0.2, -0.05]);
        let y = [b[0] - 2.0, b[2], b[1], b[4], b[3]];
        let x = [a[0] + 1.0, a[1], a[2], a[3], a[4]];
        let series = Series::new(x.iter().zip(y).map(|(x, y)| DVec3::new(*x, y, 0.0)).collect()).unwrap();
        let [point, speed] = series.derivatives::<2>(0.7);
        assert!(point.distance(DVec3::new(3.469377001085, -1.018597661562, 0.0)) < 1e-12);
        assert!(speed.distance(DVec3::new(-0.7981545959164, 1.249373342362, 0.0)) < 1e-12);
        assert_eq!((series.value(0.7), series.derivative(0.7, 1)), (point, speed));
    }

    #[test]
    fn derivatives_of_every_order_are_those_of_the_one_before() {
        let series = wavy();
        let h = 1e-5;
        for order in 0..6 {
            let slope = (series.derivative(1.1 + h, order) - series.derivative(1.1 - h, order)) / (2.0 * h);
            let exact = series.derivative(1.1, order + 1);
            assert!(slope.distance(exact) < 1e-7 * exact.length(), "order {order}: {slope} {exact}");
        }
        let all = series.derivatives::<5>(1.1);
        for (order, one) in all.into_iter().enumerate() {
            assert_eq!(one, series.derivative(1.1, order));
            let mut row = [0.0; 13];
            basis(1.1, order, &mut row);
            let sum: DVec3 = series.coefficients().iter().zip(row).map(|(c, b)| *c * b).sum();
            assert!(sum.distance(one) < 1e-12 * one.length());
        }
    }

    #[test]
    fn the_recurrence_holds_for_many_harmonics_and_near_zero() {
        for v in [1e-9, 1e-4, 0.3, PI - 1e-7, 6.2] {
            for ((cos, sin), j) in harmonics(v).zip(1..=2000) {
                let exact = (f64::from(j) * v).sin_cos();
                assert!((sin - exact.0).abs() + (cos - exact.1).abs() < 1e-15 * f64::from(j + 10), "{v} {j}");
            }
        }
    }

    #[test]
    fn padding_turning_and_reversing_keep_the_curve() {
        let series = wavy();
        let (padded, turned, reversed) = (series.clone().padded(9), series.started_at(0.8), series.clone().reversed());
        assert_eq!((padded.harmonics(), series.clone().padded(2)), (9, series.clone()));
        for v in [0.0, 0.4, 2.0, 5.0] {
            assert_eq!(padded.value(v), series.value(v));
            assert!(turned.value(v).distance(series.value(v + 0.8)) < 1e-14);
            assert!(reversed.value(v).distance(series.value(-v)) < 1e-14);
        }
    }

    #[test]
    fn affine_maps_move_the_coefficients() {
        let map = DAffine3::from_scale_rotation_translation(
            DVec3::new(2.0, 0.5, -1.0),
            DQuat::from_rotation_x(0.4),
            DVec3::new(1.0, 2.0, 3.0),
        );
        let (series, moved) = (wavy(), wavy().transformed(&map).unwrap());
        assert!(moved.value(2.3).distance(map.transform_point3(series.value(2.3))) < 1e-14);
        let huge = DAffine3::from_scale(DVec3::splat(1e308) * 10.0);
        assert!(matches!(series.transformed(&huge), Err(SeriesError::NotFinite { .. })));
    }

    #[test]
    fn area_of_an_ellipse_and_of_a_rose() {
        let ellipse = Series::new(vec![DVec3::splat(5.0), DVec3::X * 2.0, DVec3::Y * 3.0]).unwrap();
        assert!(ellipse.area_vector().distance(DVec3::Z * 6.0 * PI) < 1e-14);
        let series = wavy();
        let steps = 4096;
        let sum: DVec3 = (0..steps)
            .map(|i| series.derivatives::<2>(2.0 * PI * f64::from(i) / f64::from(steps)))
            .map(|[point, speed]| point.cross(speed) * PI / f64::from(steps))
            .sum();
        assert!(series.area_vector().distance(sum) < 1e-12);
    }

    #[test]
    fn malformed_coefficients_are_refused() {
        assert_eq!(Series::new(vec![]), Err(SeriesError::CoefficientCount { found: 0 }));
        assert_eq!(Series::new(vec![DVec3::X; 2]), Err(SeriesError::CoefficientCount { found: 2 }));
        assert_eq!(Series::new(vec![DVec3::X, DVec3::NAN, DVec3::X]), Err(SeriesError::NotFinite { index: 1 }));
        let point = Series::new(vec![DVec3::X]).unwrap();
        assert_eq!((point.value(1.0), point.derivative(1.0, 1), point.harmonics()), (DVec3::X, DVec3::ZERO, 0));
    }
}
