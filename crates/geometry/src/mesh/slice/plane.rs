//! A plane in space.

use glam::{DVec2, DVec3};

/// A plane through a point, with the unit normal about which loops in it run counter-clockwise.
///
/// Invariants, kept by the constructor: both are finite, the normal has length 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    origin: DVec3,
    normal: DVec3,
}

/// Numbers that make no plane.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("no plane has the origin {origin} and the normal {normal}: give finite numbers, and a normal that is not zero")]
pub struct NoPlane {
    /// The origin as it was given.
    pub origin: DVec3,
    /// The normal as it was given.
    pub normal: DVec3,
}

impl Plane {
    /// The plane through `origin` (metres) across `normal`, which may have any length.
    ///
    /// # Errors
    /// [`NoPlane`] where a number is not finite or the normal is zero.
    pub fn new(origin: DVec3, normal: DVec3) -> Result<Self, NoPlane> {
        // Brought to size first: the squares of very long and very short normals are beyond the numbers.
        let unit = (normal / normal.abs().max_element()).normalize_or_zero();
        if origin.is_finite() && normal.is_finite() && unit != DVec3::ZERO {
            Ok(Self { origin, normal: unit })
        } else {
            Err(NoPlane { origin, normal })
        }
    }

    /// The point it was made through, metres.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Its unit normal.
    pub fn normal(&self) -> DVec3 {
        self.normal
    }

    /// Signed distance of a point, metres: positive on the side the normal points to.
    pub fn height(&self, point: DVec3) -> f64 {
        (point - self.origin).dot(self.normal)
    }
}

/// A plane with two axes in it, so that what lies in it has two coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame {
    pub(crate) plane: Plane,
    /// Unit vector in the plane: where sections begin.
    pub(crate) front: DVec3,
    /// The other axis, a quarter turn counter-clockwise from the front.
    pub(crate) side: DVec3,
}

impl Frame {
    /// The frame whose first axis is `hint` as far as it lies in the plane; any direction where it does not.
    pub(crate) fn new(plane: Plane, hint: DVec3) -> Self {
        let front = (hint - plane.normal * hint.dot(plane.normal)).normalize_or(plane.normal.any_orthonormal_vector());
        Self { plane, front, side: plane.normal.cross(front) }
    }

    /// Coordinates in the plane of the foot of a point, seen from the plane's origin.
    pub(crate) fn flat(&self, point: DVec3) -> DVec2 {
        let arm = point - self.plane.origin();
        DVec2::new(arm.dot(self.front), arm.dot(self.side))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_of_any_length_are_made_unit() {
        for length in [1e-200, 1.0, 1e200] {
            let plane = Plane::new(DVec3::ONE, DVec3::new(3.0, 0.0, 4.0) * length).unwrap();
            assert!(plane.normal().distance(DVec3::new(0.6, 0.0, 0.8)) < 1e-15);
            assert!((plane.height(DVec3::new(1.0, 5.0, 2.0)) - 0.8).abs() < 1e-15);
        }
    }

    #[test]
    fn what_makes_no_plane_is_refused() {
        assert!(Plane::new(DVec3::ZERO, DVec3::ZERO).is_err());
        assert!(Plane::new(DVec3::ZERO, DVec3::NAN).is_err());
        assert!(Plane::new(DVec3::ZERO, DVec3::new(f64::INFINITY, 0.0, 0.0)).is_err());
        let message = Plane::new(DVec3::NAN, DVec3::X).unwrap_err().to_string();
        assert!(message.ends_with("give finite numbers, and a normal that is not zero"), "{message}");
    }

    #[test]
    fn frames_are_right_handed_and_survive_a_hint_along_the_normal() {
        let plane = Plane::new(DVec3::new(1.0, 2.0, 3.0), DVec3::new(1.0, -2.0, 0.5)).unwrap();
        for hint in [DVec3::Z, DVec3::new(-1.0, 0.3, 9.0), plane.normal(), DVec3::ZERO] {
            let frame = Frame::new(plane, hint);
            assert!((frame.front.length() - 1.0).abs() < 1e-12 && frame.front.dot(plane.normal()).abs() < 1e-12);
            assert!(frame.front.cross(frame.side).distance(plane.normal()) < 1e-12);
            let point = plane.origin() + frame.front * 0.3 - frame.side * 0.7 + plane.normal() * 5.0;
            assert!(frame.flat(point).distance(DVec2::new(0.3, -0.7)) < 1e-12);
        }
    }
}
