//! Orthographic views: the planes in which silhouettes are drawn and seen.

use glam::{DVec2, DVec3};

/// An orthographic view: two axes of the picture and the direction of sight, each a unit vector across the others.
///
/// A drawn point is `(p . right, p . up)`; the side view shows z to the right and y up, as the sketch planes do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    right: DVec3,
    up: DVec3,
    depth: DVec3,
}

impl View {
    /// The XY plane; depth is z.
    pub const FRONT: Self = Self { right: DVec3::X, up: DVec3::Y, depth: DVec3::Z };
    /// The ZY plane: z to the right, y up; depth is x.
    pub const SIDE: Self = Self { right: DVec3::Z, up: DVec3::Y, depth: DVec3::X };
    /// The XZ plane: x to the right, z up; depth is y.
    pub const TOP: Self = Self { right: DVec3::X, up: DVec3::Z, depth: DVec3::Y };

    /// The view along `direction`, with +Y up in the picture, or +Z up where the direction is within 1 % of Y. None for
    /// a direction that has no length or is not finite.
    pub fn along(direction: DVec3) -> Option<Self> {
        let depth = direction.try_normalize()?;
        let hint = if depth.y.abs() > 0.99 { DVec3::Z } else { DVec3::Y };
        let right = hint.cross(depth).try_normalize()?;
        Some(Self { right, up: depth.cross(right), depth })
    }

    /// Axis of the picture that points right.
    pub fn right(self) -> DVec3 {
        self.right
    }

    /// Axis of the picture that points up.
    pub fn up(self) -> DVec3 {
        self.up
    }

    /// Direction of sight, of either sign.
    pub fn depth(self) -> DVec3 {
        self.depth
    }

    /// Where a point is seen.
    pub fn flat(self, point: DVec3) -> DVec2 {
        DVec2::new(point.dot(self.right), point.dot(self.up))
    }

    /// A direction of the picture in space.
    pub fn lift(self, drawn: DVec2) -> DVec3 {
        self.right * drawn.x + self.up * drawn.y
    }

    /// The point in space that is seen at `drawn`, at `depth` metres along the direction of sight from the origin.
    pub fn place(self, drawn: DVec2, depth: f64) -> DVec3 {
        self.lift(drawn) + self.depth * depth
    }

    /// What an artist calls it: "front", "side", "top", or "oblique".
    pub fn name(self) -> &'static str {
        match self.depth.abs() {
            DVec3::Z => "front",
            DVec3::X => "side",
            DVec3::Y => "top",
            _ => "oblique",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_placed_is_seen_where_it_was_drawn() {
        let drawn = DVec2::new(0.3, -1.2);
        let oblique = View::along(DVec3::new(1.0, 2.0, -0.5)).unwrap();
        for view in [View::FRONT, View::SIDE, View::TOP, oblique] {
            let placed = view.place(drawn, 0.7);
            assert!(view.flat(placed).distance(drawn) < 1e-15);
            assert!((placed.dot(view.depth()) - 0.7).abs() < 1e-15);
        }
        assert_eq!(View::SIDE.place(drawn, 0.7), DVec3::new(0.7, -1.2, 0.3));
        assert_eq!(View::along(DVec3::Z * 3.0), Some(View::FRONT));
        assert_eq!(View::along(DVec3::ZERO), None);
        assert!(View::along(DVec3::Y).is_some_and(|view| view.up().z.abs() > 0.9));
    }
}
