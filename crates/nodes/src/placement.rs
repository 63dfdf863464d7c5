//! Where an ellipse or a primitive stands, as every node that makes one declares it.

use glam::{DQuat, DVec3, EulerRot};
use maquette_geometry::trigonometric::PlaneFrame;
use maquette_graph::{AtPort, ChoiceInput, Choices, Input, NodeError, NodeKind, Ports, Unit, Vector};

#[derive(Clone, Copy)]
enum Axis {
    Y,
    X,
    Z,
    Direction,
}

impl Choices for Axis {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Y, "y", "upright; radius a lies along X, b along Z"),
        (Self::X, "x", "sideways; radius a lies along Y, b along Z"),
        (Self::Z, "z", "to the front; radius a lies along X, b along Y"),
        (Self::Direction, "direction", "as `direction` says; radius a lies along X, or along Y where that is across"),
    ];
}

/// Handles of a placement's inputs.
#[derive(Clone, Copy)]
pub(crate) struct PlacementInputs {
    centre: Input<Vector>,
    axis: ChoiceInput<Axis>,
    direction: Input<Vector>,
    tilt: Input<Vector>,
}

impl PlacementInputs {
    /// `axis` says what the axis is.
    pub(crate) fn declare(node: &mut NodeKind, axis: &str) -> Self {
        Self {
            centre: node.vector("centre", [0.0; 3], Unit::Length, "Where the middle is."),
            axis: node.choice("axis", axis),
            direction: node.vector("direction", [0.0, 1.0, 0.0], Unit::None, "The axis, where that is `direction`."),
            tilt: node.vector(
                "tilt",
                [0.0; 3],
                Unit::Angle,
                "Turns about X, then Y, then Z around the middle; counter-clockwise seen from the axis's tip.",
            ),
        }
    }

    /// The frame: the middle, the axis as its normal, radius a along `e1`.
    pub(crate) fn read(self, ports: &Ports<'_>) -> Result<PlaneFrame, NodeError> {
        let vector = |input: Input<Vector>| DVec3::from_array(ports.read(input).0);
        let axis = match ports.choice(self.axis) {
            Axis::Y => DVec3::Y,
            Axis::X => DVec3::X,
            Axis::Z => DVec3::Z,
            Axis::Direction => {
                let direction = vector(self.direction);
                let unit = (direction / direction.abs().max_element()).normalize_or_zero();
                if unit == DVec3::ZERO {
                    return Err("the direction is zero: give numbers that are not all zero").at(self.direction);
                }
                unit
            }
        };
        let [x, y, z] = vector(self.tilt).to_array().map(f64::to_radians);
        let turn = DQuat::from_euler(EulerRot::ZYX, z, y, x);
        let PlaneFrame { origin, e1, e2, normal } = PlaneFrame::new(vector(self.centre), axis);
        Ok(PlaneFrame { origin, e1: turn * e1, e2: turn * e2, normal: turn * normal })
    }
}
