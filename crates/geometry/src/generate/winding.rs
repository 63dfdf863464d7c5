//! The angle at which a closed curve is seen from its centre.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use crate::curve::{ArcLength, Curve};

/// Least enclosed area of a usable curve, in the square of its length (a circle encloses 0.08, a slit 1 to 100 0.003).
const LEAST_AREA: f64 = 1e-3;

/// Largest turn back, in radians, that still counts as going once around: what an unsteady hand draws.
const TURN_BACK: f64 = 0.05;

/// Why a closed curve has no usable winding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum NoWinding {
    /// It encloses next to no area, and so has neither a normal nor an inside.
    Flat,
    /// Seen from its centre it turns back, or does not go around once: it is not star-shaped.
    Folded,
}

/// The angle of a closed curve's points about its own normal (that of its area vector), seen from the centroid of the
/// area it encloses: it grows by one turn along the curve.
#[derive(Clone, Debug)]
pub(super) struct Winding<'a> {
    arc: ArcLength<'a>,
    /// Unit normal about which the curve runs counter-clockwise.
    pub(super) normal: DVec3,
    /// Square root of the area enclosed, metres.
    pub(super) size: f64,
    /// The points as seen from the centre, in the plane across the normal, metres.
    seen: Vec<DVec2>,
    /// Angle of each point behind the first one, radians.
    angles: Vec<f64>,
}

impl<'a> Winding<'a> {
    pub(super) fn of(curve: &'a Curve) -> Result<Self, NoWinding> {
        let arc = ArcLength::of(curve);
        let area = curve.area_vector();
        let normal = area.normalize_or_zero();
        let fullness = area.length() / (arc.length() * arc.length());
        if normal == DVec3::ZERO || fullness.is_nan() || fullness < LEAST_AREA {
            return Err(NoWinding::Flat);
        }
        let (right, up) = normal.any_orthonormal_pair();
        let origin = curve.start();
        let mut seen: Vec<DVec2> =
            curve.points().iter().map(|p| DVec2::new((*p - origin).dot(right), (*p - origin).dot(up))).collect();
        let pairs = || (0..seen.len()).map(|k| (seen[k], seen[(k + 1) % seen.len()]));
        let twice_area: f64 = pairs().map(|(p, q)| p.perp_dot(q)).sum();
        let centre = pairs().map(|(p, q)| (p + q) * (p.perp_dot(q) / twice_area)).sum::<DVec2>() / 3.0;
        seen.iter_mut().for_each(|p| *p -= centre);

        let mut angles = vec![0.0];
        let (mut angle, mut furthest) = (0.0, 0.0_f64);
        for (k, from) in seen.iter().enumerate() {
            angle += turn(*from, seen[(k + 1) % seen.len()]);
            furthest = furthest.max(angle);
            if furthest - angle > TURN_BACK {
                return Err(NoWinding::Folded);
            }
            angles.push(angle);
        }
        let once = (angle - TAU).abs() < 1e-6;
        if once { Ok(Self { arc, normal, size: area.length().sqrt(), seen, angles }) } else { Err(NoWinding::Folded) }
    }

    /// Angle, in radians, of the point `s` metres behind the first one; `s` from zero to twice the curve's length, a
    /// turn more behind the first length.
    pub(super) fn angle_at(&self, s: f64) -> f64 {
        let length = self.arc.length();
        let (turns, s) = if s >= length { (TAU, s - length) } else { (0.0, s) };
        let (segment, share) = self.arc.locate(s);
        let (from, to) = (self.seen[segment], self.seen[(segment + 1) % self.seen.len()]);
        turns + self.angles[segment] + turn(from, from.lerp(to, share))
    }
}

/// Angle from one direction to another, counter-clockwise, at most half a turn.
fn turn(from: DVec2, to: DVec2) -> f64 {
    from.perp_dot(to).atan2(from.dot(to))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn closed(points: &[(f64, f64)]) -> Curve {
        // Away from the origin and tilted, so that neither can matter.
        let turn = glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.3, -0.8, 1.1);
        let place = |(x, y): &(f64, f64)| turn * DVec3::new(*x, *y, 0.0) + DVec3::new(3.0, -2.0, 1.0);
        Curve::new("c", points.iter().map(place).collect(), true).unwrap()
    }

    #[test]
    fn a_square_is_seen_by_quarters() {
        let square = closed(&[(1.0, 0.0), (1.0, 2.0), (-1.0, 2.0), (-1.0, 0.0)]);
        let winding = Winding::of(&square).unwrap();
        for (s, degrees) in [(0.0, 0.0), (1.0, 45.0), (2.0, 90.0), (7.0, 315.0), (8.0, 360.0), (9.0, 405.0)] {
            assert!((winding.angle_at(s).to_degrees() - degrees).abs() < 1e-12, "{s}");
        }
        let quarter = winding.angle_at(0.5).to_degrees();
        assert!((quarter - (45.0 - 0.5_f64.atan().to_degrees())).abs() < 1e-12, "{quarter}");
        assert!((winding.size - 2.0).abs() < 1e-12);
        assert!(winding.normal.distance(square.area_vector().normalize()) < 1e-15);
    }

    #[test]
    fn the_centre_does_not_depend_on_how_densely_points_lie() {
        let mut points = vec![(1.0, 0.0), (1.0, 2.0), (-1.0, 2.0), (-1.0, 0.0)];
        points.extend((1..1000).map(|k| (f64::from(k) / 1000.0 - 1.0, 0.0)));
        let uneven = closed(&points);
        assert!((Winding::of(&uneven).unwrap().angle_at(1.0).to_degrees() - 45.0).abs() < 1e-9);
    }

    #[test]
    fn a_folded_a_twofold_and_a_flat_curve_have_none() {
        // A horseshoe, its centre in the gap.
        let arm = |radius: f64, k: i32| {
            let a = f64::from(k) / 20.0 * 5.0;
            (radius * a.cos(), radius * a.sin())
        };
        let horseshoe: Vec<_> = (0..=20).map(|k| arm(1.0, k)).chain((0..=20).rev().map(|k| arm(0.8, k))).collect();
        assert_eq!(Winding::of(&closed(&horseshoe)).err(), Some(NoWinding::Folded));
        let twofold: Vec<_> = (0..40).map(|k| (1.0 + 0.01 * f64::from(k), f64::from(k) * TAU / 20.0)).collect();
        let twofold: Vec<_> = twofold.iter().map(|(r, a)| (r * a.cos(), r * a.sin())).collect();
        assert_eq!(Winding::of(&closed(&twofold)).err(), Some(NoWinding::Folded));
        let slit = closed(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (1.0, 0.001)]);
        assert_eq!(Winding::of(&slit).err(), Some(NoWinding::Flat));
        let huge = slit.map(|p| p * 1e99).unwrap();
        assert_eq!(Winding::of(&huge).err(), Some(NoWinding::Flat));
    }

    #[test]
    fn an_unsteady_hand_still_goes_around_once() {
        // Two points 0.01 rad back.
        let at = |a: f64| (a.cos(), a.sin());
        let points: Vec<_> = (0..60).map(|k| at(f64::from(k) * TAU / 60.0)).collect();
        let mut unsteady = points.clone();
        unsteady.insert(21, at(20.0 * TAU / 60.0 - 0.01));
        assert!(Winding::of(&closed(&unsteady)).is_ok());
        unsteady.insert(22, at(20.0 * TAU / 60.0 - 0.1));
        assert_eq!(Winding::of(&closed(&unsteady)).err(), Some(NoWinding::Folded));
    }
}
