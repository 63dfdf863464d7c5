//! An open beam: ends, pins and forces.

use super::error::BeamError;
use super::quantity::Quantity;
use super::stiffness::Stiffness;
use super::system::{Closure, Drive, System, check_nodes_and_pins, check_values};

/// How an end of an open beam is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EndCondition {
    /// Position and tangent `dP/du` are prescribed.
    Clamped,
    /// The position is prescribed, and the end turns freely: zero moment, `d'' = 0`.
    Natural,
    /// Nothing is prescribed; a load `F` may push the end: `d'' = 0` and `k_b d''' - k_s d' = -F` at the right end,
    /// `+F` at the left one (beam theory; the thesis' `d''' = f/k_b` leaves out the moment and `k_s`).
    Free,
}

/// An open beam of `n` nodes at `u = i/(n - 1)`, held at its ends and at any pins between them (thesis 5.5-5.8,
/// appendices C and D for any pins). Second order in `1/n`.
#[derive(Clone, Debug)]
pub struct OpenBeam {
    system: System,
    ends: [EndCondition; 2],
    pins: Vec<usize>,
}

/// What one solve of an [`OpenBeam`] is given.
#[derive(Clone, Copy, Debug)]
pub struct OpenValues<'a, T> {
    /// Position of the left end; not used where that end is free.
    pub left: T,
    /// Position of the right end; not used where that end is free.
    pub right: T,
    /// `dP/du` at the left end; used only where that end is clamped.
    pub left_tangent: T,
    /// `dP/du` at the right end (pointing on along the curve); used only where that end is clamped.
    pub right_tangent: T,
    /// Point load on the left end; used only where that end is free.
    pub left_load: T,
    /// Point load on the right end; used only where that end is free.
    pub right_load: T,
    /// One value a pin, in the order of the pins.
    pub pins: &'a [T],
    /// Force of the differential equation at each node, or empty for none; not used at held ends and at pins.
    pub forces: &'a [T],
}

impl<T: Quantity> OpenValues<'_, T> {
    /// The values of a beam between two ends at rest: zero tangents, no pins, no forces.
    pub fn ends(left: T, right: T) -> Self {
        let zero = T::default();
        Self {
            left,
            right,
            left_tangent: zero,
            right_tangent: zero,
            left_load: zero,
            right_load: zero,
            pins: &[],
            forces: &[],
        }
    }

    fn check(&self, nodes: usize, pins: usize) -> Result<(), BeamError> {
        let ends = [self.left, self.right, self.left_tangent, self.right_tangent, self.left_load, self.right_load];
        check_values("ends, end tangents and end loads", &ends, ends.len())?;
        check_values("pin values", self.pins, pins)?;
        if self.forces.is_empty() { Ok(()) } else { check_values("forces", self.forces, nodes) }
    }
}

/// What holds an end of an open beam where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EndReaction<T> {
    /// Point load that pushes the end: positive towards positive `d`.
    pub load: T,
    /// Moment that turns the end: positive towards a larger `dP/du`. Zero but at a clamped end.
    pub moment: T,
}

impl OpenBeam {
    /// Sets up a beam of `nodes` nodes pinned at the node indices `pins`, in any order; the ends are not among them.
    ///
    /// # Errors
    /// [`BeamError`] for fewer than 4 or more than [`super::MOST_NODES`] nodes, a pin at an end, out of range or
    /// twice, and where nothing fixes the solution: two free ends without a pin, or, with `k_s = 0`, one held point
    /// about which the beam turns.
    pub fn new(
        nodes: usize,
        pins: &[usize],
        left: EndCondition,
        right: EndCondition,
        stiffness: Stiffness,
    ) -> Result<Self, BeamError> {
        check_nodes_and_pins(nodes, 4, pins, 1..=nodes.saturating_sub(2))?;
        let mut fixed = pins.to_vec();
        fixed.extend([(left, 0), (right, nodes - 1)].iter().filter(|end| end.0 != EndCondition::Free).map(|end| end.1));
        if fixed.is_empty() {
            return Err(BeamError::NotHeld);
        }
        if fixed.len() == 1 && stiffness.ratio() == 0.0 && ![left, right].contains(&EndCondition::Clamped) {
            return Err(BeamError::Turns);
        }
        let system = System::new(nodes, &fixed, Closure::Open(left, right), stiffness)?;
        Ok(Self { system, ends: [left, right], pins: pins.to_vec() })
    }

    /// Number of nodes, ends included.
    pub fn nodes(&self) -> usize {
        self.system.nodes()
    }

    /// Pinned nodes, in the order given.
    pub fn pins(&self) -> &[usize] {
        &self.pins
    }

    /// The curve with these ends, pins, loads and forces: one value a node. Held ends and pins hold their values
    /// exactly.
    ///
    /// # Errors
    /// [`BeamError`] where a list has the wrong length, or a value is not finite.
    pub fn solve<T: Quantity>(&self, values: &OpenValues<'_, T>) -> Result<Vec<T>, BeamError> {
        values.check(self.nodes(), self.pins.len())?;
        let last = self.nodes() - 1;
        // The first guess stays near what is held.
        let [left, right] = match self.ends.map(|end| end == EndCondition::Free) {
            [false, false] => [values.left, values.right],
            [false, true] => [values.left; 2],
            [true, false] => [values.right; 2],
            [true, true] => [values.pins.first().copied().unwrap_or_default(); 2],
        };
        let chord = right - left;
        let mut curve: Vec<T> = (0..=last).map(|i| left + chord * (i as f64 / last as f64)).collect();
        curve[last] = right;
        for (pin, value) in self.pins.iter().zip(values.pins) {
            curve[*pin] = *value;
        }
        let tangents = [values.left_tangent, values.right_tangent];
        let loads = [values.left_load, values.right_load];
        self.system.solve(&mut curve, Drive { tangents, loads, forces: values.forces })?;
        Ok(curve)
    }

    /// The force of the differential equation at each pin that holds `curve` (a solution, one value a node) there;
    /// the pin's point load is `h` times it. Digits are lost with the fourth power of the number of nodes.
    ///
    /// # Errors
    /// [`BeamError`] where the number of values is not that of the nodes, or one is not finite.
    pub fn reactions<T: Quantity>(&self, curve: &[T], tangents: [T; 2]) -> Result<Vec<T>, BeamError> {
        check_values("curve values", curve, self.nodes())?;
        check_values("end tangents", &tangents, 2)?;
        Ok(self.system.force(curve, tangents, &self.pins))
    }

    /// What holds both ends of `curve` (a solution, one value a node) where they are, the left one first. With these,
    /// `h` times the reactions at pins and `h` times the forces at inner nodes, all loads add up to zero; a free end
    /// counts its load and half an interval of the force on it. Digits are lost with the third power of the nodes.
    ///
    /// # Errors
    /// [`BeamError`] where the number of values is not that of the nodes, or one is not finite.
    pub fn end_reactions<T: Quantity>(&self, curve: &[T], tangents: [T; 2]) -> Result<[EndReaction<T>; 2], BeamError> {
        check_values("curve values", curve, self.nodes())?;
        check_values("end tangents", &tangents, 2)?;
        Ok(self.system.end_reactions(curve, tangents).map(|(load, moment)| EndReaction { load, moment }))
    }
}

/// The sculpting forces of a curve (thesis 6.1, 6.2): the force at each inner node that bends a beam with clamped ends
/// of tangents `t0` and `t1` (`dP/du`) into exactly these `nodes`. One entry a node, zero at both ends.
///
/// Solving with them gives the curve back: to 3e-15 at 8 intervals, 2e-11 at 128, 4e-9 at 512.
///
/// # Errors
/// [`BeamError`] for fewer than 4 or more than [`super::MOST_NODES`] nodes, or a value that is not finite.
pub fn sculpting_forces<T: Quantity>(nodes: &[T], t0: T, t1: T, stiffness: Stiffness) -> Result<Vec<T>, BeamError> {
    let beam = OpenBeam::new(nodes.len(), &[], EndCondition::Clamped, EndCondition::Clamped, stiffness)?;
    check_values("curve values", nodes, beam.nodes())?;
    check_values("end tangents", &[t0, t1], 2)?;
    let inner: Vec<usize> = (1..nodes.len() - 1).collect();
    let mut forces = vec![T::default()];
    forces.extend(beam.system.force(nodes, [t0, t1], &inner));
    forces.push(T::default());
    Ok(forces)
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::EndCondition::{Clamped, Natural};
    use super::*;

    fn beam(nodes: usize, pins: &[usize], left: EndCondition, right: EndCondition) -> OpenBeam {
        OpenBeam::new(nodes, pins, left, right, Stiffness::default()).unwrap()
    }

    fn assert_close(found: &[f64], wanted: &[f64]) {
        assert_eq!(found.len(), wanted.len());
        assert!(found.iter().zip(wanted).all(|(f, w)| (f - w).abs() < 1e-12), "{found:?} {wanted:?}");
    }

    #[test]
    fn end_tangents_and_a_pin_reference() {
        let values = OpenValues { left_tangent: 1.5, right_tangent: -0.5, pins: &[0.8], ..OpenValues::ends(0.2, -0.3) };
        let wanted = [
            0.2,
            0.4244581284767,
            0.6490201450216,
            0.7998782258526,
            0.8,
            0.5657583830768,
            0.2233040139998,
            -0.1059467762208,
            -0.3,
        ];
        assert_close(&beam(9, &[4], Clamped, Clamped).solve(&values).unwrap(), &wanted);
    }

    #[test]
    fn contour_edit_references() {
        let values = OpenValues { pins: &[1.0], ..OpenValues::ends(0.0, 0.0) };
        let natural = [
            0.0,
            0.4193848615828,
            0.7749293312649,
            1.0,
            1.02225522995,
            0.8919817751833,
            0.6527932598096,
            0.3435382740387,
            0.0,
        ];
        let clamped = [
            0.0,
            0.2339268617391,
            0.6572999400496,
            1.0,
            0.9883783621053,
            0.7580329044764,
            0.4349923381111,
            0.1412299629997,
            0.0,
        ];
        assert_close(&beam(9, &[3], Natural, Natural).solve(&values).unwrap(), &natural);
        assert_close(&beam(9, &[3], Clamped, Clamped).solve(&values).unwrap(), &clamped);
    }

    #[test]
    fn rulers_tend_to_the_exact_solution_with_second_order() {
        // Exact shapes at u = 1/4, 1/2, 3/4: a supported ruler pressed in its middle, a cantilever held at its tip.
        let supported = [0.6827328411913, 1.0, 0.6827328411913];
        let cantilever = [0.09501396845195, 0.3299333554485, 0.6462717329031];
        let error = |intervals: usize, cantilevered: bool| {
            let (curve, exact) = if cantilevered {
                let beam = beam(intervals + 1, &[], Clamped, Natural);
                (beam.solve(&OpenValues::ends(0.0, 1.0)).unwrap(), cantilever)
            } else {
                let beam = beam(intervals + 1, &[intervals / 2], Natural, Natural);
                let values = OpenValues { pins: &[1.0], ..OpenValues::ends(0.0, 0.0) };
                (beam.solve(&values).unwrap(), supported)
            };
            [1, 2, 3].iter().map(|q| (curve[q * intervals / 4] - exact[q - 1]).abs()).fold(0.0, f64::max)
        };
        for cantilevered in [false, true] {
            for intervals in [32, 64, 128, 256] {
                let order = (error(intervals, cantilevered) / error(2 * intervals, cantilevered)).log2();
                assert!((order - 2.0).abs() < 0.05, "{intervals} intervals: order {order}");
            }
        }
    }

    #[test]
    fn forces_give_the_curve_back() {
        for (intervals, tolerance) in [(3_usize, 1e-13), (8, 1e-13), (128, 1e-9), (512, 1e-7)] {
            let u = |i: usize| i as f64 / intervals as f64;
            let nodes: Vec<DVec2> =
                (0..=intervals).map(|i| DVec2::new((3.0 * u(i)).cos(), (2.0 * u(i)).sin() + u(i).powi(3))).collect();
            let (t0, t1) = (DVec2::new(0.3, 2.0), DVec2::new(-1.0, 4.0));
            let forces = sculpting_forces(&nodes, t0, t1, Stiffness::default()).unwrap();
            let values = OpenValues {
                left_tangent: t0,
                right_tangent: t1,
                forces: &forces,
                ..OpenValues::ends(nodes[0], nodes[intervals])
            };
            let curve = beam(intervals + 1, &[], Clamped, Clamped).solve(&values).unwrap();
            let error = curve.iter().zip(&nodes).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
            assert!(error < tolerance, "{intervals} intervals: {error}");
        }
    }

    #[test]
    fn sculpting_forces_reference() {
        let c5 = [(2.0, 0.0), (1.8, 0.5), (1.4, 0.9), (0.9, 1.1), (0.4, 1.1), (0.0, 1.0)].map(DVec2::from);
        let forces =
            sculpting_forces(&c5, DVec2::new(-0.5, 3.0), DVec2::new(-1.5, -0.8), Stiffness::default()).unwrap();
        let wanted = [(0.0, 0.0), (38.25, -59.0), (3.5, 38.25), (0.0, 38.25), (-3.5, -34.0), (0.0, 0.0)];
        for (found, wanted) in forces.iter().zip(wanted) {
            assert!(found.distance(DVec2::from(wanted)) < 1e-10, "{forces:?}");
        }
    }

    #[test]
    fn reactions_hold_the_pins() {
        let intervals = 64;
        let pinned = beam(intervals + 1, &[intervals / 2], Natural, Natural);
        let curve = pinned.solve(&OpenValues { pins: &[1.0], ..OpenValues::ends(0.0, 0.0) }).unwrap();
        let reaction = pinned.reactions(&curve, [0.0; 2]).unwrap()[0];
        let mut forces = vec![0.0; intervals + 1];
        forces[intervals / 2] = reaction;
        let free = beam(intervals + 1, &[], Natural, Natural);
        let pushed = free.solve(&OpenValues { forces: &forces, ..OpenValues::ends(0.0, 0.0) }).unwrap();
        assert!(reaction > 0.0);
        assert!(curve.iter().zip(&pushed).all(|(a, b)| (a - b).abs() < 1e-9));
    }

    #[test]
    fn small_large_and_crowded() {
        for (nodes, pins) in [(4, vec![]), (4, vec![1, 2]), (4096, vec![1, 2, 3, 4094]), (4096, vec![])] {
            for ratio in [0.0, 2.8, 1e8] {
                for ends in [(Clamped, Clamped), (Natural, Natural), (Clamped, Natural), (Natural, Clamped)] {
                    let beam =
                        OpenBeam::new(nodes, &pins, ends.0, ends.1, Stiffness::new(1.0, ratio).unwrap()).unwrap();
                    // A straight line bends nowhere, whatever holds it.
                    let line = |i: usize| 2.0 - 5.0 * i as f64 / (nodes - 1) as f64;
                    let values: Vec<f64> = pins.iter().map(|p| line(*p)).collect();
                    let solved = beam
                        .solve(&OpenValues {
                            left_tangent: -5.0,
                            right_tangent: -5.0,
                            pins: &values,
                            ..OpenValues::ends(2.0, -3.0)
                        })
                        .unwrap();
                    for (i, d) in solved.iter().enumerate() {
                        assert!((d - line(i)).abs() < 1e-13, "{nodes} nodes, {ends:?}, ratio {ratio}: {d}");
                    }
                }
            }
        }
    }

    #[test]
    fn errors() {
        let new =
            |nodes, pins: &[usize]| OpenBeam::new(nodes, pins, Clamped, Natural, Stiffness::default()).map(|_| ());
        assert_eq!(new(3, &[]), Err(BeamError::TooFewNodes { found: 3, needed: 4 }));
        assert_eq!(new(0, &[]), Err(BeamError::TooFewNodes { found: 0, needed: 4 }));
        assert_eq!(new(8193, &[]), Err(BeamError::TooManyNodes { found: 8193 }));
        for end in [0, 5, 6] {
            assert_eq!(new(6, &[end]), Err(BeamError::PinOutOfRange { pin: 0, node: end, first: 1, last: 4 }));
        }
        assert_eq!(new(6, &[2, 2]), Err(BeamError::PinnedTwice { first: 0, second: 1, node: 2 }));
        let beam = beam(6, &[2], Clamped, Natural);
        let rest = OpenValues::ends(0.0, 1.0);
        assert!(matches!(beam.solve(&rest), Err(BeamError::Count { what: "pin values", found: 0, needed: 1 })));
        let values = OpenValues { pins: &[0.5], forces: &[1.0; 5], ..rest };
        assert!(matches!(beam.solve(&values), Err(BeamError::Count { what: "forces", found: 5, needed: 6 })));
        let values = OpenValues { pins: &[0.5], left_tangent: f64::NAN, ..rest };
        assert!(matches!(beam.solve(&values), Err(BeamError::NotFinite { index: 2, .. })));
        let values = OpenValues { pins: &[f64::MAX], ..OpenValues::ends(-f64::MAX, f64::MAX) };
        assert_eq!(beam.solve(&values), Err(BeamError::NotSolvable));
        assert!(matches!(beam.reactions(&[1.0], [0.0; 2]), Err(BeamError::Count { found: 1, needed: 6, .. })));
        let forces = sculpting_forces(&[0.0; 3], 0.0, 0.0, Stiffness::default());
        assert_eq!(forces, Err(BeamError::TooFewNodes { found: 3, needed: 4 }));
        let forces = sculpting_forces(&[0.0, 1.0, f64::NAN, 0.0], 0.0, 0.0, Stiffness::default());
        assert_eq!(forces, Err(BeamError::NotFinite { what: "curve values", index: 2 }));
    }
}
