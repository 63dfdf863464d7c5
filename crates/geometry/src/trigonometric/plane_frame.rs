//! The plane of a cross-section, with a direction from which angles count.

use crate::curve::Curve;
use glam::{DQuat, DVec2, DVec3};

/// Cosine to the normal above which a hint gives no direction in the plane.
const ALONG: f64 = 0.9;

/// An origin and three orthonormal directions: `e1`, `e2` in the plane, `normal` = `e1 x e2` square to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneFrame {
    /// A point of the plane, metres.
    pub origin: DVec3,
    /// The direction of angle 0.
    pub e1: DVec3,
    /// The direction of angle pi/2.
    pub e2: DVec3,
    /// Unit normal, about which angles count counter-clockwise.
    pub normal: DVec3,
}

impl PlaneFrame {
    /// The frame of a curve: the mean of its points, the normal about which it runs counter-clockwise (Newell's; for
    /// one that encloses no area, the largest product of two offsets from the mean; for a straight one any square to
    /// it), and as `e1` the world's x-axis laid into the plane, or the y-axis where the normal is within 26 degrees of
    /// x.
    pub fn of(curve: &Curve) -> Self {
        let origin = mean(curve.points());
        Self::new(origin, normal(curve, origin))
    }

    /// The frame with this origin and normal, and `e1` as in [`PlaneFrame::of`]. The normal need not have unit length;
    /// where it has none, +Z is taken.
    pub fn new(origin: DVec3, normal: DVec3) -> Self {
        let normal = normal.try_normalize().unwrap_or(DVec3::Z);
        let hint = if normal.x.abs() > ALONG { DVec3::Y } else { DVec3::X };
        Self::towards(origin, normal, hint)
    }

    /// The frame of a next section of a stack: `e1` carried over by the smallest rotation that takes one normal to the
    /// other (parallel transport), so that angles keep their meaning along a bent limb.
    #[must_use]
    pub fn carried(&self, origin: DVec3, normal: DVec3) -> Self {
        let normal = normal.try_normalize().unwrap_or(self.normal);
        Self::towards(origin, normal, DQuat::from_rotation_arc(self.normal, normal) * self.e1)
    }

    fn towards(origin: DVec3, normal: DVec3, hint: DVec3) -> Self {
        let across = (hint - normal * hint.dot(normal)).try_normalize();
        let e1 = across.unwrap_or_else(|| normal.any_orthonormal_vector());
        Self { origin, e1, e2: normal.cross(e1), normal }
    }

    /// Coordinates of a point in the plane, metres.
    pub fn flat(&self, point: DVec3) -> DVec2 {
        let offset = point - self.origin;
        DVec2::new(offset.dot(self.e1), offset.dot(self.e2))
    }

    /// Polar angle of a point about the origin, -pi to pi.
    pub fn angle(&self, point: DVec3) -> f64 {
        let flat = self.flat(point);
        flat.y.atan2(flat.x)
    }

    /// Largest distance of points from the plane, metres.
    pub fn flatness(&self, points: &[DVec3]) -> f64 {
        points.iter().map(|p| (*p - self.origin).dot(self.normal).abs()).fold(0.0, f64::max)
    }

    /// Diagonal of the box around points, its sides along the directions of the frame, metres: the D of the thesis
    /// (3.10), for curves out of the plane too.
    pub fn diagonal(&self, points: &[DVec3]) -> f64 {
        let local = points.iter().map(|p| {
            let offset = *p - self.origin;
            DVec3::new(offset.dot(self.e1), offset.dot(self.e2), offset.dot(self.normal))
        });
        let (low, high) = local.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
        (high - low).length()
    }
}

/// Mean of points.
pub(super) fn mean(points: &[DVec3]) -> DVec3 {
    points.iter().sum::<DVec3>() / points.len() as f64
}

/// Unit normal of a curve, as in [`PlaneFrame::of`].
pub(super) fn normal(curve: &Curve, mean: DVec3) -> DVec3 {
    let points = curve.points();
    let longer = |a: DVec3, b: DVec3| if b.length_squared() > a.length_squared() { b } else { a };
    let farthest = points.iter().map(|p| *p - mean).fold(DVec3::ZERO, longer);
    let size = farthest.length_squared();
    let area = curve.area_vector();
    if area.length() > 1e-6 * size {
        return area.normalize_or_zero();
    }
    let widest = points.iter().map(|p| farthest.cross(*p - mean)).fold(DVec3::ZERO, longer);
    if widest.length() > 1e-6 * size {
        return widest.normalize_or_zero();
    }
    farthest.try_normalize().map_or(DVec3::Z, |along| {
        // Of a line: the axis most square to it, made square.
        let axis = [DVec3::Z, DVec3::Y, DVec3::X].into_iter().find(|axis| axis.dot(along).abs() < 0.6);
        let axis = axis.unwrap_or_else(|| along.any_orthonormal_vector());
        (axis - along * axis.dot(along)).normalize_or_zero()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_3};

    /// Reference value V06.
    #[test]
    fn the_frame_of_the_reference() {
        let curve = Curve::new("", vec![DVec3::X, DVec3::Y, DVec3::Z], true).unwrap();
        let frame = PlaneFrame::of(&curve);
        assert!(frame.origin.distance(DVec3::splat(1.0 / 3.0)) < 1e-15);
        assert!(frame.e1.distance(DVec3::new(0.8164965809277, -0.4082482904639, -0.4082482904639)) < 1e-12);
        assert!(frame.e2.distance(DVec3::new(0.0, FRAC_1_SQRT_2, -FRAC_1_SQRT_2)) < 1e-12);
        assert!(frame.normal.distance(DVec3::splat(0.5773502691896)) < 1e-12);
        assert!(frame.flatness(curve.points()) < 1e-15);
    }

    #[test]
    fn curves_without_area_have_a_frame() {
        let s = |i: i32| f64::from(i) / 10.0;
        let stroke: Vec<DVec3> = (-10..=10).map(|i| DVec3::new(s(i), 0.0, s(i).powi(3))).collect();
        let frame = PlaneFrame::of(&Curve::new("s", stroke, false).unwrap());
        assert!(frame.normal.y.abs() > 1.0 - 1e-12);
        for along in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE] {
            let frame = PlaneFrame::of(&Curve::new("line", vec![along, along * 3.0], false).unwrap());
            assert!(frame.normal.dot(along).abs() < 1e-12 && (frame.normal.length() - 1.0).abs() < 1e-12);
            assert!(frame.e1.cross(frame.e2).distance(frame.normal) < 1e-12);
        }
    }

    #[test]
    fn carrying_turns_no_more_than_it_must() {
        let first = PlaneFrame::new(DVec3::ZERO, DVec3::Y);
        assert_eq!(first.e1, DVec3::X);
        // Around a quarter bend in the plane of y and z the x-axis stays.
        let mut frame = first;
        for i in 1..=9 {
            let angle = f64::from(i) * FRAC_PI_3 / 6.0;
            frame = frame.carried(DVec3::X, DVec3::new(0.0, angle.cos(), angle.sin()));
            assert!(frame.e1.distance(DVec3::X) < 1e-12);
        }
        // A frame by the hint alone would jump where the normal comes near x.
        let near = first.carried(DVec3::ZERO, DVec3::new(0.95, 0.05, 0.0));
        assert!(near.e1.y < -0.9 && PlaneFrame::new(DVec3::ZERO, near.normal).e1.y > 0.9);
        assert!(first.carried(DVec3::ZERO, -DVec3::Y).e1.is_finite());
    }

    #[test]
    fn the_diagonal_is_that_of_the_box_along_the_frame() {
        let frame = PlaneFrame::new(DVec3::ZERO, DVec3::new(0.0, 1.0, 1.0));
        let points = [DVec3::ZERO, frame.e1 * 3.0, frame.e2 * 4.0, frame.normal * 12.0];
        assert!((frame.diagonal(&points) - 13.0).abs() < 1e-12);
        assert!((frame.angle(frame.e2) - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
    }
}
