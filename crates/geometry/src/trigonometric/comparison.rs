//! Sections against the curves they stand for.

use super::order_search::Errors;
use super::report::WorstPoint;
use super::section::EllipticSection;
use crate::curve::{ArcLength, Curve, closest};

/// Points of the curve, and of the section, from which distances are measured.
const POINTS: usize = 256;

/// How far a section is from a curve, by nearest points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// Mean distance from the curve to the section, and the largest of both ways, as shares of the diagonal.
    pub errors: Errors,
    /// Diagonal of the box around the curve's points in the section's frame, metres.
    pub diagonal: f64,
    /// Largest distance from a point of the curve to the section, metres.
    pub from_curve: f64,
    /// Largest distance from a point of the section to the curve, metres: what the section has that the curve has not.
    pub from_section: f64,
    /// The place of the larger of both.
    pub worst: WorstPoint,
}

impl EllipticSection {
    /// The distances between the section and a curve, both ways, from 256 points even in arc length of the curve and 256
    /// at equal steps of the section's angle. Unlike the errors of a fit these are not between points of equal angle,
    /// but between nearest points, and never larger.
    pub fn compare(&self, curve: &Curve) -> Comparison {
        let arc = ArcLength::of(curve);
        let steps = if curve.is_closed() { POINTS } else { POINTS - 1 } as f64;
        let (mut sum, mut from_curve, mut from_section) = (0.0, 0.0_f64, 0.0_f64);
        let mut worst = WorstPoint { point: curve.points()[0], angle: self.range().0, distance: 0.0 };
        for k in 0..POINTS {
            let point = arc.point_at(arc.length() * k as f64 / steps);
            let nearest = self.nearest(point);
            sum += nearest.distance;
            from_curve = from_curve.max(nearest.distance);
            if nearest.distance > worst.distance {
                worst = WorstPoint { point, angle: nearest.angle, distance: nearest.distance };
            }
        }
        let (from, to) = self.range();
        let steps = if self.is_closed() { POINTS } else { POINTS - 1 } as f64;
        for k in 0..POINTS {
            let angle = from + (to - from) * k as f64 / steps;
            let nearest = closest(curve, self.point(angle));
            from_section = from_section.max(nearest.distance);
            if nearest.distance > worst.distance {
                worst = WorstPoint { point: nearest.point, angle, distance: nearest.distance };
            }
        }
        let diagonal = self.frame().diagonal(curve.points());
        let share = |distance: f64| if diagonal > 0.0 { distance / diagonal } else { 0.0 };
        let errors = Errors { mean: share(sum / POINTS as f64), maximum: share(worst.distance) };
        Comparison { errors, diagonal, from_curve, from_section, worst }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{EllipticSegment, PlaneFrame, Series};
    use super::*;
    use glam::DVec3;
    use std::f64::consts::{PI, TAU};

    #[test]
    fn both_ways_are_measured() {
        let series = Series::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y]).unwrap();
        let segment = EllipticSegment { from: 0.0, to: TAU, local: false, series };
        let circle = EllipticSection::new(PlaneFrame::new(DVec3::ZERO, DVec3::Z), true, vec![segment]).unwrap();
        let at = |radius: f64, angle: f64| DVec3::new(radius * angle.cos(), radius * angle.sin(), 0.0);
        let around = (0..720).map(|k| at(1.1, f64::from(k) * TAU / 720.0)).collect();
        let found = circle.compare(&Curve::new("wider", around, true).unwrap());
        assert!((found.from_curve - 0.1).abs() < 1e-4 && (found.from_section - 0.1).abs() < 1e-4, "{found:?}");
        assert!((found.errors.mean - 0.1 / found.diagonal).abs() < 1e-4);
        assert!((found.diagonal - 2.2 * 2.0_f64.sqrt()).abs() < 1e-3);
        // Half of the circle: the curve is met exactly, and the section has another half.
        let half = (0..=360).map(|k| at(1.0, f64::from(k) * PI / 360.0)).collect();
        let found = circle.compare(&Curve::new("half", half, false).unwrap());
        assert!(found.from_curve < 1e-4 && (found.from_section - 2.0_f64.sqrt()).abs() < 1e-4, "{found:?}");
        assert!((found.worst.angle - 1.5 * PI).abs() < 0.05 && found.errors.mean < 1e-4);
    }
}
