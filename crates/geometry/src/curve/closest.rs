//! The point of a curve closest to a given one.

use super::{ArcLength, Curve};
use glam::DVec3;

/// Where a curve comes closest to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// The point of the curve.
    pub point: DVec3,
    /// Its distance from the given point, metres.
    pub distance: f64,
    /// Its arc length from the first point of the curve, metres.
    pub arc_length: f64,
    /// That arc length as a share of the whole, 0 to 1.
    pub fraction: f64,
    /// The segment it lies on, counted from 0; segment `i` begins at point `i`.
    pub segment: usize,
}

/// The closest point of a curve to `point`, by projection onto every segment; exact but for rounding. The first one
/// along the curve where several are equally close.
pub fn closest(curve: &Curve, point: DVec3) -> Closest {
    let arc = ArcLength::of(curve);
    let mut best = (f64::INFINITY, 0, 0.0);
    for segment in 0..curve.segment_count() {
        let (from, to) = curve.segment(segment);
        let along = to - from;
        let share = ((point - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        let share = if share.is_nan() { 0.0 } else { share };
        let distance = from.lerp(to, share).distance_squared(point);
        if distance < best.0 {
            best = (distance, segment, share);
        }
    }
    let (_, segment, share) = best;
    let (from, to) = curve.segment(segment);
    let found = from.lerp(to, share);
    let (start, end) = (arc.cumulative()[segment], arc.cumulative()[segment + 1]);
    let arc_length = start + (end - start) * share;
    let fraction = if arc.length() > 0.0 { (arc_length / arc.length()).clamp(0.0, 1.0) } else { 0.0 };
    Closest { point: found, distance: found.distance(point), arc_length, fraction, segment }
}

/// The largest distance of points from a curve in metres, zero where there are none: the Hausdorff distance, one way.
/// [`super::deviation`] compares two curves both ways.
pub fn farthest(points: &[DVec3], curve: &Curve) -> f64 {
    points.iter().map(|point| closest(curve, *point).distance).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Vec<DVec3> {
        vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y]
    }

    #[test]
    fn feet_lie_on_segments_corners_and_ends() {
        let open = Curve::new("u", square(), false).unwrap();
        let foot = closest(&open, DVec3::new(1.5, 0.25, 2.0));
        assert_eq!(foot.point, DVec3::new(1.0, 0.25, 0.0));
        assert_eq!((foot.arc_length, foot.segment), (1.25, 1));
        assert!((foot.distance - 4.25_f64.sqrt()).abs() < 1e-15);
        assert!((foot.fraction - 1.25 / 3.0).abs() < 1e-15);
        assert_eq!(closest(&open, DVec3::new(2.0, -1.0, 0.0)).point, DVec3::X);
        assert_eq!(closest(&open, DVec3::new(-1.0, 1.2, 0.0)).fraction, 1.0);
    }

    #[test]
    fn closed_curve_has_a_segment_back() {
        let closed = Curve::new("square", square(), true).unwrap();
        let foot = closest(&closed, DVec3::new(-1.0, 0.25, 0.0));
        assert_eq!((foot.point, foot.segment, foot.arc_length), (DVec3::new(0.0, 0.25, 0.0), 3, 3.75));
    }

    #[test]
    fn of_equally_close_points_the_first_is_taken() {
        let closed = Curve::new("square", square(), true).unwrap();
        assert_eq!(closest(&closed, DVec3::new(0.5, 0.5, 0.0)).segment, 0);
    }

    #[test]
    fn huge_or_strange_points_do_not_panic() {
        let closed = Curve::new("square", square(), true).unwrap();
        assert_eq!(closest(&closed, DVec3::NAN).segment, 0);
        assert!(closest(&closed, DVec3::splat(1e300)).point.is_finite());
    }

    #[test]
    fn the_farthest_point_counts() {
        let closed = Curve::new("", square(), true).unwrap();
        let points = [DVec3::new(0.5, 0.25, 0.0), DVec3::new(0.5, -0.5, 0.0), DVec3::new(3.0, 4.0, 0.0)];
        assert_eq!([1, 2, 3].map(|count| farthest(&points[..count], &closed)), [0.25, 0.5, 13.0_f64.sqrt()]);
        assert_eq!(farthest(&[], &closed), 0.0);
    }
}
