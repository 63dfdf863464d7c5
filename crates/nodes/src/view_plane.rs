//! The planes in which an artist draws.

use glam::{DVec2, DVec3};
use maquette_geometry::mesh::stroke;
use maquette_geometry::view::View;
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
    /// All of them.
    pub(crate) const ALL: [Self; 3] = [Self::Front, Self::Side, Self::Top];

    /// The view in which the plane is seen as drawn; its depth is the axis of the offset.
    pub(crate) fn view(self) -> View {
        match self {
            Self::Front => View::FRONT,
            Self::Side => View::SIDE,
            Self::Top => View::TOP,
        }
    }

    /// The direction in which it looks.
    pub(crate) fn looks_along(self) -> DVec3 {
        // A difference, for negation would make the other coordinates -0.0, which what is computed from them shows.
        DVec3::ZERO - self.view().depth()
    }

    /// The point in space of a point drawn in the plane: that of the view, with the signs of zeros kept, which the
    /// view's sums lose and content hashes see.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_is_that_of_its_view_and_keeps_the_signs_of_zeros() {
        let bits = |v: DVec3| v.to_array().map(f64::to_bits);
        for (plane, (listed, name, _)) in ViewPlane::ALL.into_iter().zip(ViewPlane::OPTIONS) {
            assert_eq!((plane, plane.view().name()), (*listed, *name));
            let drawn = DVec2::new(0.3, -1.2);
            assert_eq!(plane.place(drawn, 0.7), plane.view().place(drawn, 0.7));
            let zeros = plane.place(DVec2::new(-0.0, 0.0), -0.0);
            assert_eq!(plane.view().flat(zeros), DVec2::ZERO);
            assert_eq!(zeros.to_array().iter().filter(|c| c.is_sign_negative()).count(), 2);
        }
        let looks = ViewPlane::ALL.map(|plane| bits(plane.looks_along()));
        assert_eq!(looks, [DVec3::NEG_Z, DVec3::NEG_X, DVec3::NEG_Y].map(bits));
    }
}
