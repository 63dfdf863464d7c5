//! What a handle holds, and how it is moved.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::polar::nearest_rotation;

/// What a handle prescribes at its vertices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Holds {
    /// Position and deformation gradient: what is beside the handle turns and scales with it.
    #[default]
    Both,
    /// Position only: the surface turns as it likes.
    Position,
    /// Deformation gradient only: the surface turns with the handle, and may be anywhere.
    Gradient,
}

/// Why a matrix does not move a handle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum HandleError {
    /// An entry that is not a number or is infinite.
    #[error("the transform has an entry that is not a finite number")]
    NotFinite,
    /// A linear part that mirrors or flattens.
    #[error("the transform mirrors or flattens: give every axis a scale above 0")]
    NotOriented,
}

/// How a handle is moved: `p` goes to `pivot + translation + rotation * stretch * (p - pivot)`.
///
/// The rotation has an axis and an angle that may go beyond 180 degrees: a handle turned by 400 degrees is not one turned
/// by 40, and the surface between two handles winds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HandleTransform {
    pivot: DVec3,
    translation: DVec3,
    /// Along the axis, its length the angle in radians.
    rotation: DVec3,
    stretch: DMat3,
}

impl Default for HandleTransform {
    /// A handle that stays where it is.
    fn default() -> Self {
        Self { pivot: DVec3::ZERO, translation: DVec3::ZERO, rotation: DVec3::ZERO, stretch: DMat3::IDENTITY }
    }
}

impl HandleTransform {
    /// A handle that is shifted, metres.
    pub fn translation(by: DVec3) -> Self {
        Self { translation: by, ..Self::default() }
    }

    /// A handle that is turned about an axis through `pivot`, counter-clockwise seen from the axis' tip, by an angle in
    /// radians of any size. An axis of length 0 turns nothing.
    pub fn rotation(pivot: DVec3, axis: DVec3, angle: f64) -> Self {
        Self { pivot, rotation: axis.normalize_or_zero() * angle, ..Self::default() }
    }

    /// A handle that is scaled about `pivot`.
    pub fn scale(pivot: DVec3, factor: f64) -> Self {
        Self { pivot, stretch: DMat3::IDENTITY * factor, ..Self::default() }
    }

    /// From its four parts: `p` goes to `pivot + translation + rotation * stretch * (p - pivot)`, where `rotation` lies
    /// along the axis and is as long as the angle in radians, of any size.
    ///
    /// # Errors
    /// [`HandleError`] where a number is not finite or the stretch mirrors or flattens.
    pub fn from_parts(pivot: DVec3, translation: DVec3, rotation: DVec3, stretch: DMat3) -> Result<Self, HandleError> {
        let moved = Self { pivot, translation, rotation, stretch };
        moved.check()?;
        Ok(moved)
    }

    /// The affine map of a matrix; its rotation is the one of at most 180 degrees.
    ///
    /// # Errors
    /// [`HandleError`] where the matrix is not finite, mirrors or flattens.
    pub fn affine(matrix: &DAffine3) -> Result<Self, HandleError> {
        let rotation = nearest_rotation(matrix.matrix3);
        let moved = Self {
            pivot: DVec3::ZERO,
            translation: matrix.translation,
            rotation: DQuat::from_mat3(&rotation).to_scaled_axis(),
            stretch: matrix.matrix3,
        };
        // What is not a rotation exactly, goes into the stretch, so that the map is the one given.
        let turned = moved.turned();
        let moved = Self { stretch: turned.transpose() * matrix.matrix3, ..moved };
        moved.check()?;
        Ok(moved)
    }

    /// A handle that brings the point `from` to `to`, its surroundings mapped by `linear`: for a handle of one vertex whose
    /// position and gradient are known, as along a seam.
    ///
    /// # Errors
    /// As [`HandleTransform::affine`].
    pub fn carrying(from: DVec3, to: DVec3, linear: DMat3) -> Result<Self, HandleError> {
        let moved = Self::affine(&DAffine3::from_mat3_translation(linear, DVec3::ZERO))?;
        let moved = Self { pivot: from, translation: to - from, ..moved };
        moved.check()?;
        Ok(moved)
    }

    /// The same, turned further by whole turns about its axis; about `axis` where it has none.
    #[must_use]
    pub fn wound(mut self, axis: DVec3, turns: i32) -> Self {
        let own = self.rotation.normalize_or(axis.normalize_or_zero());
        let sign = if own.dot(axis) < 0.0 { -1.0 } else { 1.0 };
        self.rotation += own * (sign * f64::from(turns) * std::f64::consts::TAU);
        self
    }

    /// The same, with a shift in metres behind it.
    #[must_use]
    pub fn shifted(mut self, by: DVec3) -> Self {
        self.translation += by;
        self
    }

    /// The same, scaled uniformly about its pivot before it is turned.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        self.stretch *= factor;
        self
    }

    /// Where it brings a point.
    pub fn apply(&self, point: DVec3) -> DVec3 {
        self.pivot + self.translation + self.linear() * (point - self.pivot)
    }

    /// Its linear part: the deformation gradient at its vertices.
    pub fn linear(&self) -> DMat3 {
        self.turned() * self.stretch
    }

    /// Along the axis, its length the angle in radians, which may exceed pi.
    pub fn rotation_vector(&self) -> DVec3 {
        self.rotation
    }

    /// The point that turning and stretching leave in place.
    pub fn pivot(&self) -> DVec3 {
        self.pivot
    }

    /// The shift behind it, metres.
    pub fn translation_vector(&self) -> DVec3 {
        self.translation
    }

    /// What it does before it turns.
    pub fn stretch(&self) -> DMat3 {
        self.stretch
    }

    /// Whether it leaves sizes as they are, within 1e-9.
    pub(super) fn is_rigid(&self) -> bool {
        (self.stretch - DMat3::IDENTITY).abs_diff_eq(DMat3::ZERO, 1e-9)
    }

    /// Whether it is finite and neither mirrors nor flattens.
    pub(super) fn check(&self) -> Result<(), HandleError> {
        let finite = self.pivot.is_finite() && self.translation.is_finite() && self.rotation.is_finite();
        if !(finite && self.stretch.is_finite()) {
            return Err(HandleError::NotFinite);
        }
        let lengths = self.stretch.x_axis.length() * self.stretch.y_axis.length() * self.stretch.z_axis.length();
        if self.stretch.determinant() > 1e-12 * lengths { Ok(()) } else { Err(HandleError::NotOriented) }
    }

    fn turned(&self) -> DMat3 {
        if self.rotation == DVec3::ZERO {
            return DMat3::IDENTITY;
        }
        DMat3::from_quat(DQuat::from_scaled_axis(self.rotation))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn a_turn_about_a_pivot_leaves_it_in_place() {
        let turned = HandleTransform::rotation(DVec3::X, DVec3::Z * 7.0, 0.5 * PI);
        assert!(turned.apply(DVec3::X).distance(DVec3::X) < 1e-15);
        assert!(turned.apply(2.0 * DVec3::X).distance(DVec3::X + DVec3::Y) < 1e-15);
        assert!(turned.is_rigid());
        let lifted = turned.scaled(2.0).shifted(DVec3::Y);
        assert!(lifted.apply(2.0 * DVec3::X).distance(DVec3::X + 3.0 * DVec3::Y) < 1e-15);
        assert!(!lifted.is_rigid());
    }

    #[test]
    fn a_matrix_comes_back_with_the_rotation_in_it() {
        let matrix = DAffine3::from_scale_rotation_translation(
            DVec3::new(1.0, 2.0, 0.5),
            DQuat::from_axis_angle(DVec3::Y, 2.0),
            DVec3::new(1.0, -2.0, 3.0),
        );
        let moved = HandleTransform::affine(&matrix).unwrap();
        assert!(moved.linear().abs_diff_eq(matrix.matrix3, 1e-14));
        assert!(moved.apply(DVec3::ONE).distance(matrix.transform_point3(DVec3::ONE)) < 1e-14);
        assert!(moved.rotation_vector().distance(2.0 * DVec3::Y) < 1e-14);
        assert!(moved.check().is_ok());
        assert_eq!(HandleTransform::affine(&DAffine3::IDENTITY).unwrap(), HandleTransform::default());
    }

    #[test]
    fn a_point_is_carried_with_its_surroundings() {
        let linear = DMat3::from_quat(DQuat::from_axis_angle(DVec3::X, 1.0)) * 2.0;
        let moved = HandleTransform::carrying(DVec3::ONE, DVec3::NEG_Y, linear).unwrap();
        assert_eq!(moved.apply(DVec3::ONE), DVec3::NEG_Y);
        assert!(moved.linear().abs_diff_eq(linear, 1e-14));
        let lost = HandleTransform::carrying(DVec3::ONE, DVec3::NAN, linear);
        assert_eq!(lost, Err(HandleError::NotFinite));
    }

    #[test]
    fn whole_turns_count_and_change_no_point() {
        let turned = HandleTransform::rotation(DVec3::X, DVec3::Z, 0.7);
        let wound = turned.wound(DVec3::NEG_Z, -1);
        assert!((wound.rotation_vector().z - 0.7 - 2.0 * PI).abs() < 1e-14);
        assert!(wound.apply(DVec3::ONE).distance(turned.apply(DVec3::ONE)) < 1e-14);
        let still = HandleTransform::default().wound(DVec3::Y, 2);
        assert!((still.rotation_vector().y - 4.0 * PI).abs() < 1e-14);
    }

    #[test]
    fn its_parts_make_it_again() {
        let turned = HandleTransform::rotation(DVec3::X, DVec3::Z, 7.0).scaled(2.0).shifted(DVec3::Y);
        let parts = (turned.pivot(), turned.translation_vector(), turned.rotation_vector(), turned.stretch());
        assert_eq!(HandleTransform::from_parts(parts.0, parts.1, parts.2, parts.3), Ok(turned));
        let flat = HandleTransform::from_parts(DVec3::ZERO, DVec3::ZERO, DVec3::ZERO, DMat3::ZERO);
        assert_eq!(flat, Err(HandleError::NotOriented));
    }

    #[test]
    fn mirrors_flat_and_infinite_maps_are_refused() {
        let affine = |scale: DVec3| HandleTransform::affine(&DAffine3::from_scale(scale));
        assert_eq!(affine(DVec3::new(1.0, -1.0, 1.0)), Err(HandleError::NotOriented));
        assert_eq!(affine(DVec3::new(1.0, 0.0, 1.0)), Err(HandleError::NotOriented));
        assert_eq!(affine(DVec3::new(1.0, f64::NAN, 1.0)), Err(HandleError::NotFinite));
        assert_eq!(HandleTransform::translation(DVec3::INFINITY).check(), Err(HandleError::NotFinite));
        assert!(affine(DVec3::splat(1e-6)).is_ok());
    }
}
