//! The planes in which an artist draws.

use glam::{DVec2, DVec3};
use maquette_geometry::mesh::stroke;
use maquette_graph::Choices;

/// A view, and with it a plane: front XY, side ZY, top XZ. +X is the model's left, +Y up, +Z its front; metres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ViewPlane {
    Front,
    Side,
    Top,
}

impl Choices for ViewPlane {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Front, "front", "XY plane, seen from the front; the offset is z"),
        (Self::Side, "side", "ZY plane, seen from the side; the offset is x"),
        (Self::Top, "top", "XZ plane, seen from above; the offset is y"),
    ];
}

impl ViewPlane {
    /// The direction in which it looks.
    pub(crate) fn looks_along(self) -> DVec3 {
        match self {
            Self::Front => DVec3::NEG_Z,
            Self::Side => DVec3::NEG_X,
            Self::Top => DVec3::NEG_Y,
        }
    }

    /// The point in space of a point drawn in the plane.
    pub(crate) fn place(self, drawn: DVec2, offset: f64) -> DVec3 {
        match self {
            Self::Front => DVec3::new(drawn.x, drawn.y, offset),
            Self::Side => DVec3::new(offset, drawn.y, drawn.x),
            Self::Top => DVec3::new(drawn.x, offset, drawn.y),
        }
    }
}

/// A plane through the origin, across one axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MirrorPlane {
    X,
    Y,
    Z,
}

impl Choices for MirrorPlane {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::X, "x", "left and right change places"),
        (Self::Y, "y", "top and bottom change places"),
        (Self::Z, "z", "front and back change places"),
    ];
}

impl MirrorPlane {
    /// Factors of the coordinates.
    pub(crate) fn signs(self) -> DVec3 {
        match self {
            Self::X => DVec3::new(-1.0, 1.0, 1.0),
            Self::Y => DVec3::new(1.0, -1.0, 1.0),
            Self::Z => DVec3::new(1.0, 1.0, -1.0),
        }
    }

    /// The mirror image of a point, in the plane at `offset` from the origin.
    pub(crate) fn reflect(self, point: DVec3, offset: f64) -> DVec3 {
        let signs = self.signs();
        point * signs + (DVec3::ONE - signs) * offset
    }
}

/// Which side of a body is meant in a view.
#[derive(Clone, Copy)]
pub(crate) struct Facing(pub(crate) stroke::Facing);

impl Choices for Facing {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(stroke::Facing::Seen), "seen", "the side that is seen"),
        (Self(stroke::Facing::Back), "back", "the side that is farthest behind it"),
    ];
}
