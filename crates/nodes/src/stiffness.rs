//! The two stiffnesses of the beam, as every node that solves it declares them.

use maquette_geometry::beam::Stiffness;
use maquette_graph::{Input, NodeError, NodeKind, Ports};

/// Handles of `k_b` and `k_s`.
#[derive(Clone, Copy)]
pub(crate) struct StiffnessInputs {
    k_b: Input<f64>,
    k_s: Input<f64>,
}

impl StiffnessInputs {
    /// Declares both, with the defaults of the thesis (section 6.5).
    pub(crate) fn declare(node: &mut NodeKind) -> Self {
        let k_b = node.number(
            "k_b",
            0.5,
            1e-6..=1e6,
            "Bending stiffness: larger makes curves rounder between the points they must pass. Only k_s / k_b counts.",
        );
        node.soft_range(k_b, 0.01..=10.0);
        let k_s = node.number(
            "k_s",
            1.4,
            0.0..=1e6,
            "Stretching stiffness (tension): larger pulls curves tighter, towards straight lines.",
        );
        node.soft_range(k_s, 0.0..=200.0);
        Self { k_b, k_s }
    }

    /// The stiffness at the inputs.
    pub(crate) fn read(self, ports: &Ports<'_>) -> Result<Stiffness, NodeError> {
        Ok(Stiffness::new(ports.value(self.k_b), ports.value(self.k_s))?)
    }
}
