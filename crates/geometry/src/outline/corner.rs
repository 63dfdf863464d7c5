//! Corners of an outline that is noisy at the scale of a pixel.

use glam::DVec3;

use crate::curve::{ArcLength, Curve};

/// How far a corner may be moved when it is put where its two sides meet, in arms.
const FARTHEST_MOVE: f64 = 0.35;

/// How far points may lie off a side that counts as straight, in arms.
const STRAIGHT: f64 = 0.1;

/// Indices of the points at which a curve turns by more than `angle` radians between the `arm` before and the `arm`
/// behind them (both along the curve), in rising order: of those less than an arm apart, the one that turns most. The
/// ends of an open curve are none. Method: A. Rosenfeld and E. Johnston 1973, "Angle detection on digital curves", IEEE
/// Trans. Computers 22, with arms of fixed length.
///
/// Bends of a radius below `arm / angle` are corners as well.
pub fn corners(curve: &Curve, arm: f64, angle: f64) -> Vec<usize> {
    let arc = ArcLength::of(curve);
    let length = arc.length();
    if !(arm > 0.0 && 2.0 * arm < length) {
        return Vec::new();
    }
    let stations = &arc.cumulative()[..curve.points().len()];
    let mut found: Vec<(f64, usize)> = Vec::new();
    for (index, (point, station)) in curve.points().iter().zip(stations).enumerate() {
        if !curve.is_closed() && (*station < arm || length - station < arm) {
            continue;
        }
        let (before, after) = (*point - arc.point_at(station - arm), arc.point_at(station + arm) - *point);
        let turn = before.angle_between(after);
        if turn > angle {
            found.push((turn, index));
        }
    }
    found.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut kept = std::collections::BTreeSet::new();
    for (_, index) in found {
        let away = |other: &usize| {
            let direct = (stations[index] - stations[*other]).abs();
            if curve.is_closed() { direct.min(length - direct) } else { direct }
        };
        let neighbours =
            [kept.range(..index).next_back(), kept.range(index..).next(), kept.iter().next(), kept.iter().next_back()];
        if neighbours.into_iter().flatten().all(|other| away(other) >= arm) {
            kept.insert(index);
        }
    }
    kept.into_iter().collect()
}

/// Where the two sides of a corner meet, which tracing cuts off: each side a line fitted to the points between a sixth
/// of an arm and an arm away from it. The corner's own place where a side is not straight, or the lines meet far off.
/// For curves in a plane of constant z.
pub(super) fn sharpened(curve: &Curve, corner: usize, arm: f64) -> DVec3 {
    let arc = ArcLength::of(curve);
    let (place, station) = (curve.points()[corner], arc.cumulative()[corner]);
    let side = |towards: f64| {
        let points: Vec<DVec3> =
            (2..=12).map(|k| arc.point_at(station + towards * arm * f64::from(k) / 12.0)).collect();
        Line::through(&points).filter(|line| points.iter().all(|p| line.distance(*p) < STRAIGHT * arm))
    };
    let met = side(-1.0).zip(side(1.0)).and_then(|(one, other)| one.meets(&other));
    met.filter(|met| met.distance(place) < FARTHEST_MOVE * arm).unwrap_or(place)
}

/// A line in a plane of constant z.
struct Line {
    point: DVec3,
    direction: DVec3,
}

impl Line {
    /// The line of least squared distances.
    fn through(points: &[DVec3]) -> Option<Self> {
        let middle = points.iter().sum::<DVec3>() / points.len() as f64;
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        for offset in points.iter().map(|p| *p - middle) {
            xx += offset.x * offset.x;
            xy += offset.x * offset.y;
            yy += offset.y * offset.y;
        }
        let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
        let direction = DVec3::new(angle.cos(), angle.sin(), 0.0);
        (xx + yy > 0.0 && direction.is_finite()).then_some(Self { point: middle, direction })
    }

    fn distance(&self, point: DVec3) -> f64 {
        (point - self.point).cross(self.direction).length()
    }

    fn meets(&self, other: &Self) -> Option<DVec3> {
        let across = self.direction.cross(other.direction).z;
        let along = (other.point - self.point).cross(other.direction).z / across;
        let met = self.point + self.direction * along;
        (across.abs() > 0.05 && met.is_finite()).then_some(met)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of edge 40 with a point a unit, its corners cut off as tracing does it.
    fn square() -> Curve {
        let side = |k: i32| f64::from(k) - 19.5;
        let points = (0..40)
            .map(|k| DVec3::new(side(k), -20.0, 0.0))
            .chain((0..40).map(|k| DVec3::new(20.0, side(k), 0.0)))
            .chain((0..40).map(|k| DVec3::new(-side(k), 20.0, 0.0)))
            .chain((0..40).map(|k| DVec3::new(-20.0, -side(k), 0.0)));
        Curve::new("square", points.collect(), true).unwrap()
    }

    #[test]
    fn a_square_has_four_corners_which_are_put_where_its_sides_meet() {
        let square = square();
        let found = corners(&square, 6.0, 0.7);
        assert_eq!(found.len(), 4, "{found:?}");
        for index in found {
            let was = square.points()[index];
            let is = sharpened(&square, index, 6.0);
            assert!((was.abs() - DVec3::new(20.0, 20.0, 0.0)).length() > 0.4, "{was}");
            assert!((is.abs() - DVec3::new(20.0, 20.0, 0.0)).length() < 1e-9, "{is}");
        }
    }

    #[test]
    fn a_circle_has_none_and_the_ends_of_an_open_curve_are_none() {
        let ring = (0..300).map(|k| std::f64::consts::TAU * f64::from(k) / 300.0);
        let ring = Curve::new("ring", ring.map(|a| DVec3::new(a.cos(), a.sin(), 0.0) * 50.0).collect(), true).unwrap();
        assert_eq!(corners(&ring, 6.0, 0.7), Vec::<usize>::new());
        // A radius below arm / angle is a corner as well.
        assert!(!corners(&ring.map(|p| p * 0.12).unwrap(), 6.0, 0.7).is_empty());
        let corner = [DVec3::Y, DVec3::Y * 0.5, DVec3::ZERO, DVec3::X * 0.5, DVec3::X];
        let open = Curve::new("open", corner.to_vec(), false).unwrap();
        assert_eq!(corners(&open, 0.5, 0.7), [2]);
        assert_eq!(corners(&open, 2.0, 0.7), Vec::<usize>::new());
    }
}
