//! The Hermite basis of the difference scheme.

use super::error::BeamError;
use super::open::{EndCondition, OpenBeam, OpenValues};
use super::stiffness::Stiffness;

/// The four solutions of the difference equations without forces from which every other one is combined:
/// `d = P0 H00 + T0 H10 + P1 H01 + T1 H11` for end positions `P` and end tangents `T = dP/du`. For `k_s = 0` they tend
/// to the cubic Hermite polynomials; [`super::closed_form`] has their limits for any stiffness.
#[derive(Clone, Debug, PartialEq)]
pub struct HermiteBasis {
    /// Position at the start: 1 at the first node, 0 at the last, flat at both; one value a node.
    pub h00: Vec<f64>,
    /// Tangent at the start; one value a node.
    pub h10: Vec<f64>,
    /// Position at the end: `1 - h00`; one value a node.
    pub h01: Vec<f64>,
    /// Tangent at the end; one value a node.
    pub h11: Vec<f64>,
}

impl HermiteBasis {
    /// The basis at `nodes` nodes, `u = i/(nodes - 1)`.
    ///
    /// # Errors
    /// [`BeamError`] for fewer than 4 or more than [`super::MOST_NODES`] nodes.
    pub fn new(nodes: usize, stiffness: Stiffness) -> Result<Self, BeamError> {
        let beam = OpenBeam::new(nodes, &[], EndCondition::Clamped, EndCondition::Clamped, stiffness)?;
        let h01 = beam.solve(&OpenValues::ends(0.0, 1.0))?;
        let h11 = beam.solve(&OpenValues { right_tangent: 1.0, ..OpenValues::ends(0.0, 0.0) })?;
        let h00 = h01.iter().map(|h| 1.0 - h).collect();
        let h10 = h11.iter().rev().map(|h| 0.0 - h).collect();
        Ok(Self { h00, h10, h01, h11 })
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.h00.len()
    }
}

#[cfg(test)]
mod tests {
    use super::super::closed_form::ExactHermite;
    use super::*;

    fn error(nodes: usize, stiffness: Stiffness) -> f64 {
        let basis = HermiteBasis::new(nodes, stiffness).unwrap();
        let exact = ExactHermite::new(stiffness);
        (0..nodes)
            .flat_map(|i| {
                let wanted = exact.values(i as f64 / (nodes - 1) as f64);
                let found = [basis.h00[i], basis.h10[i], basis.h01[i], basis.h11[i]];
                [0, 1, 2, 3].map(|k| (found[k] - wanted[k]).abs())
            })
            .fold(0.0, f64::max)
    }

    #[test]
    fn tends_to_the_closed_form_with_second_order() {
        for ratio in [0.0, 2.8, 100.0] {
            let stiffness = Stiffness::new(1.0, ratio).unwrap();
            for nodes in [65, 129, 257, 2049] {
                let order = (error(nodes, stiffness) / error(2 * nodes - 1, stiffness)).log2();
                assert!((order - 2.0).abs() < 0.05, "ratio {ratio}, {nodes} nodes: order {order}");
            }
        }
    }

    #[test]
    fn ends_are_exact_and_values_stay_bounded_however_taut() {
        for ratio in [0.0, 2.8, 1e8, 1e12] {
            for nodes in [4, 5, 64, 4096] {
                let basis = HermiteBasis::new(nodes, Stiffness::new(1.0, ratio).unwrap()).unwrap();
                let last = nodes - 1;
                assert_eq!(basis.nodes(), nodes);
                assert_eq!([basis.h00[0], basis.h01[0], basis.h10[0], basis.h11[0]], [1.0, 0.0, 0.0, 0.0]);
                assert_eq!([basis.h00[last], basis.h01[last], basis.h10[last], basis.h11[last]], [0.0, 1.0, 0.0, 0.0]);
                assert!(basis.h01.windows(2).all(|w| w[1] >= w[0] - 1e-14), "ratio {ratio}, {nodes} nodes");
                assert!(basis.h11.iter().all(|h| (-0.15..=1e-14).contains(h)), "ratio {ratio}, {nodes} nodes");
            }
        }
    }
}
