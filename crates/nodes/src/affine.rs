//! Scale, turn and move, as every node that transforms declares them.

use glam::{DAffine3, DQuat, DVec3, EulerRot};
use maquette_graph::{AtPort, Input, NodeError, NodeKind, Ports, Unit, Vector};

/// Handles of a transform's inputs.
#[derive(Clone, Copy)]
pub(crate) struct AffineInputs {
    translate: Input<Vector>,
    rotate: Input<Vector>,
    scale: Input<Vector>,
    pivot: Input<Vector>,
}

impl AffineInputs {
    pub(crate) fn declare(node: &mut NodeKind) -> Self {
        Self {
            translate: node.vector("translate", [0.0; 3], Unit::Length, "How far to move along X, Y and Z."),
            rotate: node.vector(
                "rotate",
                [0.0; 3],
                Unit::Angle,
                "Turns about X, then Y, then Z; counter-clockwise seen from the axis's tip.",
            ),
            scale: node.vector("scale", [1.0; 3], Unit::None, "Factors along X, Y and Z; not zero."),
            pivot: node.vector("pivot", [0.0; 3], Unit::Length, "The point that scaling and turning leave in place."),
        }
    }

    pub(crate) fn read(self, ports: &Ports<'_>) -> Result<DAffine3, NodeError> {
        let vector = |input: Input<Vector>| DVec3::from_array(ports.read(input).0);
        let (scale, angles, pivot) = (vector(self.scale), vector(self.rotate), vector(self.pivot));
        if scale.to_array().contains(&0.0) {
            return Err("a factor of zero flattens everything: give a number other than zero").at(self.scale);
        }
        let [x, y, z] = angles.to_array().map(f64::to_radians);
        // Extrinsic: about the fixed axes, X first.
        let turn = DQuat::from_euler(EulerRot::ZYX, z, y, x);
        let turn_and_scale = DAffine3::from_scale_rotation_translation(scale, turn, DVec3::ZERO);
        Ok(DAffine3::from_translation(pivot + vector(self.translate))
            * turn_and_scale
            * DAffine3::from_translation(-pivot))
    }
}
