//! Arc length along a polyline.

use super::Curve;
use glam::DVec3;

/// The running length of a curve, tabulated once. Exact but for rounding: a curve is a chain of straight segments.
#[derive(Clone, Debug)]
pub struct ArcLength<'a> {
    curve: &'a Curve,
    /// Length from the first point to each point, and for a closed curve once more back at the first.
    cumulative: Vec<f64>,
}

impl<'a> ArcLength<'a> {
    /// Tabulates the arc length of a curve.
    pub fn of(curve: &'a Curve) -> Self {
        Self { curve, cumulative: super::chord_parameters(curve.points(), curve.is_closed()) }
    }

    /// The whole length, metres, with the way back to the first point of a closed curve.
    pub fn length(&self) -> f64 {
        self.cumulative[self.cumulative.len() - 1]
    }

    /// Length from the first point to each point, metres; a closed curve has one entry more, the whole length.
    pub fn cumulative(&self) -> &[f64] {
        &self.cumulative
    }

    /// The point at `s` metres from the first. `s` is clamped to an open curve and wraps around a closed one; NaN
    /// gives the first point.
    pub fn point_at(&self, s: f64) -> DVec3 {
        let (segment, share) = self.locate(s);
        let (from, to) = self.curve.segment(segment);
        from.lerp(to, share)
    }

    /// The point at a fraction of the whole length: 0 is the first point, 1 the last one (or the first one again).
    pub fn point_at_fraction(&self, t: f64) -> DVec3 {
        self.point_at(t * self.length())
    }

    /// Unit direction of the segment at `s` metres from the first point.
    pub fn tangent_at(&self, s: f64) -> DVec3 {
        let (from, to) = self.curve.segment(self.locate(s).0);
        (to - from).normalize_or_zero()
    }

    /// Pen pressure at `s` metres from the first point, linear between points; none where none was recorded.
    pub fn pressure_at(&self, s: f64) -> Option<f64> {
        let pressure = self.curve.pressure()?;
        let (segment, share) = self.locate(s);
        let (from, to) = (pressure[segment], pressure[(segment + 1) % pressure.len()]);
        Some(from + (to - from) * share)
    }

    /// The segment at `s` metres from the first point, counted from 0, and the share of it that is passed (0 to 1).
    pub fn locate(&self, s: f64) -> (usize, f64) {
        let length = self.length();
        let s = match s {
            s if s.is_nan() => 0.0,
            s if self.curve.is_closed() && s.is_finite() && !(0.0..=length).contains(&s) => s.rem_euclid(length),
            s => s.clamp(0.0, length.max(0.0)),
        };
        let last = self.cumulative.len() - 2;
        let segment = self.cumulative.partition_point(|c| *c <= s).saturating_sub(1).min(last);
        let step = self.cumulative[segment + 1] - self.cumulative[segment];
        let share = (s - self.cumulative[segment]) / step;
        (segment, if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(closed: bool) -> Curve {
        let points = vec![DVec3::ZERO, DVec3::new(3.0, 0.0, 0.0), DVec3::new(3.0, 4.0, 0.0)];
        Curve::with_pressure("corner", points, closed, Some(vec![0.0, 0.3, 0.7])).unwrap()
    }

    #[test]
    fn open_curve_is_measured_and_clamped() {
        let curve = corner(false);
        let arc = ArcLength::of(&curve);
        assert_eq!(arc.cumulative(), [0.0, 3.0, 7.0]);
        assert_eq!(arc.length(), 7.0);
        assert_eq!(arc.point_at(1.5), DVec3::new(1.5, 0.0, 0.0));
        assert_eq!(arc.point_at(5.0), DVec3::new(3.0, 2.0, 0.0));
        assert_eq!(arc.point_at_fraction(1.0), DVec3::new(3.0, 4.0, 0.0));
        assert_eq!(arc.point_at(-1.0), DVec3::ZERO);
        assert_eq!(arc.point_at(f64::INFINITY), DVec3::new(3.0, 4.0, 0.0));
        assert_eq!(arc.point_at(f64::NAN), DVec3::ZERO);
        assert_eq!(arc.tangent_at(5.0), DVec3::Y);
        assert!((arc.pressure_at(5.0).unwrap() - 0.5).abs() < 1e-15);
    }

    #[test]
    fn closed_curve_comes_back_and_wraps() {
        let curve = corner(true);
        let arc = ArcLength::of(&curve);
        assert_eq!(arc.cumulative(), [0.0, 3.0, 7.0, 12.0]);
        assert_eq!(arc.point_at(9.5), DVec3::new(1.5, 2.0, 0.0));
        assert_eq!(arc.point_at(12.0), DVec3::ZERO);
        assert_eq!(arc.point_at(13.0), DVec3::new(1.0, 0.0, 0.0));
        assert!(arc.point_at(-2.5).distance(DVec3::new(1.5, 2.0, 0.0)) < 1e-12);
        assert!((arc.pressure_at(9.5).unwrap() - 0.35).abs() < 1e-15);
        assert_eq!(arc.point_at(f64::NEG_INFINITY), DVec3::ZERO);
    }

    #[test]
    fn lengths_beyond_the_numbers_give_points_and_no_panic() {
        for size in [1e200, 1e-200] {
            let curve = Curve::new("", vec![DVec3::ZERO, DVec3::X * size, DVec3::Y * size], true).unwrap();
            let arc = ArcLength::of(&curve);
            for s in [-1.0, 0.0, 1.0, 1e300] {
                assert!(curve.points().contains(&arc.point_at(s)));
            }
        }
    }
}
