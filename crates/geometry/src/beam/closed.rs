//! A closed beam held by pins.

use super::error::BeamError;
use super::quantity::Quantity;
use super::stiffness::Stiffness;
use super::system::{Closure, Drive, System, check_nodes_and_pins, check_values};

/// With more pins than this, one banded solve is cheaper than the product with the cardinal functions.
const MOST_CARDINALS: usize = 16;

/// A closed beam of `n` nodes at `u = i/n`, held at some nodes and free of forces elsewhere (thesis 5.5-5.8,
/// appendices A and B for any pins). Second order in `1/n`.
#[derive(Clone, Debug)]
pub struct ClosedBeam {
    system: System,
    pins: Vec<usize>,
    /// One function a pin; empty above [`MOST_CARDINALS`].
    cardinals: Vec<Vec<f64>>,
}

impl ClosedBeam {
    /// Sets up a beam of `nodes` nodes pinned at the node indices `pins`, in any order.
    ///
    /// # Errors
    /// [`BeamError`] for fewer than 5 or more than [`super::MOST_NODES`] nodes, no pin, a pin out of range or twice.
    pub fn new(nodes: usize, pins: &[usize], stiffness: Stiffness) -> Result<Self, BeamError> {
        check_nodes_and_pins(nodes, 5, pins, 0..=nodes.saturating_sub(1))?;
        if pins.is_empty() {
            return Err(BeamError::NoPin);
        }
        let system = System::new(nodes, pins, Closure::Cyclic, stiffness)?;
        let mut beam = Self { system, pins: pins.to_vec(), cardinals: Vec::new() };
        if pins.len() <= MOST_CARDINALS {
            beam.cardinals = beam.cardinals()?;
        }
        Ok(beam)
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.system.nodes()
    }

    /// Pinned nodes, in the order given.
    pub fn pins(&self) -> &[usize] {
        &self.pins
    }

    /// The cardinal functions: `[k][i]` is the value at node `i` when pin `k` is at 1 and all others at 0. They add
    /// up to 1 at every node, and any solution is their sum weighted with the pins' values.
    ///
    /// # Errors
    /// [`BeamError::NotSolvable`] where round-off leaves no solution.
    pub fn cardinals(&self) -> Result<Vec<Vec<f64>>, BeamError> {
        if !self.cardinals.is_empty() {
            return Ok(self.cardinals.clone());
        }
        (0..self.pins.len())
            .map(|pin| {
                let mut unit = vec![0.0; self.pins.len()];
                unit[pin] = 1.0;
                self.solve_banded(&unit, &[])
            })
            .collect()
    }

    /// The curve through `values`, one a pin in the order of the pins: one value a node. The pinned nodes hold their
    /// values exactly.
    ///
    /// # Errors
    /// [`BeamError`] where the number of values is not that of the pins, or one is not finite.
    pub fn solve<T: Quantity>(&self, values: &[T]) -> Result<Vec<T>, BeamError> {
        check_values("pin values", values, self.pins.len())?;
        if self.cardinals.is_empty() {
            return self.solve_banded(values, &[]);
        }
        // Relative to the first pin, so that a beam whose pins coincide stays a point exactly.
        let origin = values[0];
        let mut curve = vec![origin; self.nodes()];
        for (cardinal, value) in self.cardinals.iter().zip(values).skip(1) {
            let offset = *value - origin;
            for (point, weight) in curve.iter_mut().zip(cardinal) {
                *point = *point + offset * *weight;
            }
        }
        for (pin, value) in self.pins.iter().zip(values) {
            curve[*pin] = *value;
        }
        if curve.iter().all(|point| point.finite()) { Ok(curve) } else { Err(BeamError::NotSolvable) }
    }

    /// The curve through `values`, one a pin, pushed by `forces` of the differential equation, one a node; those at pins
    /// are not used.
    ///
    /// # Errors
    /// [`BeamError`] where a list has the wrong length, or a value is not finite.
    pub fn solve_with_forces<T: Quantity>(&self, values: &[T], forces: &[T]) -> Result<Vec<T>, BeamError> {
        check_values("pin values", values, self.pins.len())?;
        check_values("forces", forces, self.nodes())?;
        self.solve_banded(values, forces)
    }

    /// The force of the differential equation at each pin that holds `curve` (a solution, one value a node) there;
    /// the pin's point load is `h` times it. All of them add up to zero. Digits are lost with the fourth power of
    /// the number of nodes: about 1e-11 of the largest at 100 nodes, 1e-8 at 500.
    ///
    /// # Errors
    /// [`BeamError`] where the number of values is not that of the nodes, or one is not finite.
    pub fn reactions<T: Quantity>(&self, curve: &[T]) -> Result<Vec<T>, BeamError> {
        check_values("curve values", curve, self.nodes())?;
        Ok(self.system.force(curve, [T::default(); 2], &self.pins))
    }

    fn solve_banded<T: Quantity>(&self, values: &[T], forces: &[T]) -> Result<Vec<T>, BeamError> {
        let mut curve = vec![values[0]; self.nodes()];
        for (pin, value) in self.pins.iter().zip(values) {
            curve[*pin] = *value;
        }
        let none = [T::default(); 2];
        self.system.solve(&mut curve, Drive { tangents: none, loads: none, forces })?;
        Ok(curve)
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec2, DVec3};

    use super::*;

    fn beam(nodes: usize, pins: &[usize]) -> ClosedBeam {
        ClosedBeam::new(nodes, pins, Stiffness::default()).unwrap()
    }

    #[test]
    fn two_pins_reference() {
        let beam = beam(12, &[0, 6]);
        let curve = beam.solve(&[1.0, -1.0]).unwrap();
        let half = [1.0, 0.8406111870906, 0.4720862115326, 0.0, -0.4720862115326, -0.8406111870906];
        for (i, wanted) in half.iter().enumerate() {
            assert!((curve[i] - wanted).abs() < 1e-12 && (curve[i + 6] + wanted).abs() < 1e-12, "{curve:?}");
        }
        let forces = beam.reactions(&curve).unwrap();
        assert!((forces[0] - 2337.790949659).abs() < 1e-8 && (forces[0] + forces[1]).abs() < 1e-8, "{forces:?}");
    }

    #[test]
    fn four_pins_reference() {
        let pins = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y];
        let beam = beam(16, &[0, 4, 8, 12]);
        let curve = beam.solve(&pins).unwrap();
        let quarter = [(1.0, 0.0), (0.9081488708558, 0.3624730956791), (0.6802508012701, 0.6802508012701)];
        for (i, (x, y)) in quarter.into_iter().enumerate() {
            assert!((curve[i] - DVec2::new(x, y)).length() < 1e-12);
            assert!((curve[i + 4] - DVec2::new(-y, x)).length() < 1e-12);
            assert!((curve[i + 12] - DVec2::new(y, -x)).length() < 1e-12);
        }
        for (force, pin) in beam.reactions(&curve).unwrap().iter().zip(pins) {
            assert!((*force - pin * 3188.977799799).length() < 1e-8, "{force}");
        }
    }

    #[test]
    fn tends_to_the_exact_curve_with_second_order() {
        // Exact values of the tension spline, with their u in twentieths.
        let two = [(1, 0.9435493250698), (2, 0.7909329752074), (4, 0.2952007941788), (9, -0.9435493250698)];
        let three = [(2, 0.7932014465486), (8, -0.5681670915681), (10, -0.7880316915054), (17, 0.4002628573627)];
        let two: (&[usize], &[f64], _) = (&[0, 10], &[1.0, -1.0], two);
        let three: (&[usize], &[f64], _) = (&[0, 4, 14], &[1.0, 0.3, -0.5], three);
        for (pins, values, exact) in [two, three] {
            let error = |nodes: usize| {
                let pins: Vec<usize> = pins.iter().map(|pin| pin * nodes / 20).collect();
                let curve = beam(nodes, &pins).solve(values).unwrap();
                exact.iter().map(|(u, d)| (curve[u * nodes / 20] - d).abs()).fold(0.0, f64::max)
            };
            for nodes in [40, 80, 160, 320] {
                let order = (error(nodes) / error(2 * nodes)).log2();
                assert!((order - 2.0).abs() < 0.05, "{nodes} nodes: order {order}");
            }
        }
    }

    #[test]
    fn round_off_does_not_grow_with_the_nodes() {
        // For k_s = 0 the difference equations between two opposite pins are solved by an odd cubic whose central
        // difference vanishes at the pins.
        for nodes in [8, 128, 4096, 8192] {
            let curve = ClosedBeam::new(nodes, &[0, nodes / 2], Stiffness::new(1.0, 0.0).unwrap())
                .unwrap()
                .solve(&[1.0, -1.0])
                .unwrap();
            let linear = 3.0 / 16.0 + (nodes as f64).powi(-2);
            let cubic = |y: f64| y * y * y - linear * y;
            for (i, d) in curve.iter().take(nodes / 2).enumerate() {
                let wanted = cubic(i as f64 / nodes as f64 - 0.25) / cubic(-0.25);
                assert!((d - wanted).abs() < 2e-14, "{nodes} nodes, node {i}: {d} {wanted}");
            }
        }
    }

    #[test]
    fn pins_are_held_and_cardinals_add_up_to_one() {
        for (nodes, pins) in [
            (5, vec![0]),
            (5, vec![0, 1, 2, 3, 4]),
            (7, vec![6, 0]),
            (64, vec![0, 16, 32, 48]),
            (100, vec![3, 4, 5, 99]),
            (4096, vec![17]),
            (4096, (0..40).map(|k| 100 * k).collect()),
        ] {
            for ratio in [0.0, 2.8, 1e8] {
                let beam = ClosedBeam::new(nodes, &pins, Stiffness::new(1.0, ratio).unwrap()).unwrap();
                let values: Vec<DVec3> = pins.iter().map(|p| DVec3::new(*p as f64, (*p as f64).sin(), 1.0)).collect();
                let curve = beam.solve(&values).unwrap();
                assert_eq!(curve.len(), nodes);
                assert!(pins.iter().zip(&values).all(|(pin, value)| curve[*pin] == *value));
                assert!(curve.iter().all(|p| (p.z - 1.0).abs() < 1e-13), "{nodes} nodes, ratio {ratio}");
                let cardinals = beam.cardinals().unwrap();
                assert_eq!(cardinals.len(), pins.len());
                for i in 0..nodes {
                    let sum: f64 = cardinals.iter().map(|c| c[i]).sum();
                    assert!((sum - 1.0).abs() < 1e-13, "node {i} of {nodes}, ratio {ratio}: {sum}");
                }
            }
        }
    }

    #[test]
    fn many_pins_agree_with_their_cardinals() {
        let pins: Vec<usize> = (0..20).map(|k| 5 * k + k % 3).collect();
        let beam = beam(100, &pins);
        assert!(beam.cardinals.is_empty());
        let values: Vec<f64> = pins.iter().map(|p| (*p as f64 * 0.7).cos()).collect();
        let curve = beam.solve(&values).unwrap();
        let cardinals = beam.cardinals().unwrap();
        for i in 0..100 {
            let sum: f64 = cardinals.iter().zip(&values).map(|(c, v)| c[i] * v).sum();
            assert!((sum - curve[i]).abs() < 1e-13);
        }
    }

    #[test]
    fn a_point_stays_a_point_exactly() {
        let apex = DVec3::new(0.1, 1.66, -0.03);
        assert!(beam(64, &[0, 16, 32, 48]).solve(&[apex; 4]).unwrap().iter().all(|p| *p == apex));
    }

    #[test]
    fn forces_balance_on_any_closed_curve() {
        let beam = beam(100, &[0, 13, 55, 56]);
        let forces = beam.reactions(&beam.solve(&[1.0, 0.2, -0.7, -0.6]).unwrap()).unwrap();
        let largest = forces.iter().fold(0.0_f64, |m, f| m.max(f.abs()));
        assert!(forces.iter().sum::<f64>().abs() < 1e-8 * largest, "{forces:?}");
    }

    #[test]
    fn errors() {
        let new = |nodes, pins: &[usize]| ClosedBeam::new(nodes, pins, Stiffness::default()).map(|_| ());
        assert_eq!(new(4, &[0]), Err(BeamError::TooFewNodes { found: 4, needed: 5 }));
        assert_eq!(new(0, &[]), Err(BeamError::TooFewNodes { found: 0, needed: 5 }));
        assert_eq!(new(8193, &[0]), Err(BeamError::TooManyNodes { found: 8193 }));
        assert_eq!(new(5, &[]), Err(BeamError::NoPin));
        assert_eq!(new(5, &[1, 5]), Err(BeamError::PinOutOfRange { pin: 1, node: 5, first: 0, last: 4 }));
        assert_eq!(new(5, &[1, 2, 1]), Err(BeamError::PinnedTwice { first: 0, second: 2, node: 1 }));
        let beam = beam(12, &[0, 6]);
        assert_eq!(beam.solve(&[1.0]), Err(BeamError::Count { what: "pin values", found: 1, needed: 2 }));
        assert_eq!(beam.solve(&[1.0, f64::NAN]), Err(BeamError::NotFinite { what: "pin values", index: 1 }));
        assert_eq!(beam.solve(&[-1.7e308, 1.7e308]), Err(BeamError::NotSolvable));
        assert!(matches!(beam.reactions(&[1.0]), Err(BeamError::Count { found: 1, needed: 12, .. })));
        assert!(matches!(beam.reactions(&[f64::INFINITY; 12]), Err(BeamError::NotFinite { index: 0, .. })));
    }

    proptest::proptest! {
        #[test]
        fn turning_and_mirroring_the_pins_turns_and_mirrors_the_curve(
            nodes in 5_usize..200,
            at in proptest::collection::vec((0_usize..200, -10.0..10.0_f64), 1..24),
            turn in 0_usize..200,
            ratio in 0.0..1e4_f64,
        ) {
            let mut pins: Vec<(usize, f64)> = at.iter().map(|(pin, value)| (pin % nodes, *value)).collect();
            pins.sort_by_key(|pin| pin.0);
            pins.dedup_by_key(|pin| pin.0);
            let solve = |map: &dyn Fn(usize) -> usize| {
                let at: Vec<usize> = pins.iter().map(|pin| map(pin.0)).collect();
                let values: Vec<f64> = pins.iter().map(|pin| pin.1).collect();
                let stiffness = Stiffness::new(1.0, ratio).unwrap();
                ClosedBeam::new(nodes, &at, stiffness).unwrap().solve(&values).unwrap()
            };
            let curve = solve(&|pin| pin);
            let turned = solve(&|pin| (pin + turn) % nodes);
            let mirrored = solve(&|pin| (nodes - pin) % nodes);
            let largest = curve.iter().fold(10.0_f64, |m, d| m.max(d.abs()));
            for i in 0..nodes {
                proptest::prop_assert!((curve[i] - turned[(i + turn) % nodes]).abs() < 1e-12 * largest);
                proptest::prop_assert!((curve[i] - mirrored[(nodes - i) % nodes]).abs() < 1e-12 * largest);
            }
        }
    }
}
