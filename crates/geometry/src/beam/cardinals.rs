//! The cardinal functions of an open beam: what one solve needs once the beam is known.

use super::error::BeamError;
use super::open::{EndCondition, OpenBeam, OpenValues};
use super::quantity::Quantity;
use super::stiffness::Stiffness;
use super::system::check_values;
use super::tension_spline::{SplineEnd, TensionSpline};

/// Functions of which every beam curve between clamped ends with given pins is the weighted sum: computed once, a curve
/// costs one product a function and node. Without pins they are the Hermite basis of the beam, `d = P0 H00 + T0 H10 +
/// P1 H01 + T1 H11` for end positions `P` and end tangents `T = dP/du`, which for `k_s = 0` is the cubic one.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenCardinals {
    /// Positions of the left end, of each pin in the order given, and of the right end; one value a node each.
    positions: Vec<Vec<f64>>,
    /// Tangents `dP/du` of the left and the right end; one value a node each.
    tangents: [Vec<f64>; 2],
    /// Nodes at which positions are given.
    held: Vec<usize>,
}

impl OpenCardinals {
    /// Those of the difference scheme: the curves of [`OpenBeam`] with clamped ends.
    ///
    /// # Errors
    /// As [`OpenBeam::new`].
    pub fn differences(nodes: usize, pins: &[usize], stiffness: Stiffness) -> Result<Self, BeamError> {
        let beam = OpenBeam::new(nodes, pins, EndCondition::Clamped, EndCondition::Clamped, stiffness)?;
        Self::collect(nodes, pins, |positions, tangents| {
            let inner = &positions[1..positions.len() - 1];
            beam.solve(&OpenValues {
                left_tangent: tangents[0],
                right_tangent: tangents[1],
                pins: inner,
                ..OpenValues::ends(positions[0], positions[positions.len() - 1])
            })
        })
    }

    /// Those of the differential equation itself, by [`TensionSpline`]: with them a surface leaves its border in the
    /// direction asked for at any number of nodes, and not only in the limit. Pins in ascending order.
    ///
    /// # Errors
    /// As [`OpenBeam::new`], and for pins that do not ascend.
    pub fn exact(nodes: usize, pins: &[usize], stiffness: Stiffness) -> Result<Self, BeamError> {
        OpenBeam::new(nodes, pins, EndCondition::Clamped, EndCondition::Clamped, stiffness)?;
        let last = (nodes - 1) as f64;
        let parameters: Vec<f64> =
            [0].iter().chain(pins).chain([&(nodes - 1)]).map(|node| *node as f64 / last).collect();
        Self::collect(nodes, pins, |positions, tangents| {
            let spline = TensionSpline::open(&parameters, positions, tangents.map(SplineEnd::Clamped), stiffness)?;
            Ok((0..nodes).map(|i| spline.value(i as f64 / last)).collect())
        })
    }

    fn collect(
        nodes: usize,
        pins: &[usize],
        solve: impl Fn(&[f64], [f64; 2]) -> Result<Vec<f64>, BeamError>,
    ) -> Result<Self, BeamError> {
        let held: Vec<usize> = [0].into_iter().chain(pins.iter().copied()).chain([nodes - 1]).collect();
        let none = vec![0.0; held.len()];
        let positions = (0..held.len())
            .map(|k| {
                let mut unit = none.clone();
                unit[k] = 1.0;
                solve(&unit, [0.0; 2])
            })
            .collect::<Result<_, _>>()?;
        Ok(Self { positions, tangents: [solve(&none, [1.0, 0.0])?, solve(&none, [0.0, 1.0])?], held })
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.tangents[0].len()
    }

    /// Functions of the positions: left end, pins in the order given, right end. They add up to 1 at every node.
    pub fn positions(&self) -> &[Vec<f64>] {
        &self.positions
    }

    /// Nodes at which positions are given: 0, the pins in the order given, the last.
    pub fn held(&self) -> &[usize] {
        &self.held
    }

    /// Functions of the tangents at the left and the right end.
    pub fn tangents(&self) -> &[Vec<f64>; 2] {
        &self.tangents
    }

    /// The curve through `positions` (left end, pins, right end) with the end tangents `dP/du`: one value a node. The
    /// positions are held exactly, and where all are equal and the tangents zero, it is that point.
    ///
    /// # Errors
    /// [`BeamError`] where the number of positions is wrong, or a value is not finite.
    pub fn curve<T: Quantity>(&self, positions: &[T], tangents: [T; 2]) -> Result<Vec<T>, BeamError> {
        check_values("positions", positions, self.held.len())?;
        check_values("end tangents", &tangents, 2)?;
        let mut curve = vec![positions[0]; self.nodes()];
        let offsets = positions.iter().map(|position| *position - positions[0]);
        for (function, value) in self.positions.iter().zip(offsets).skip(1).chain(self.tangents.iter().zip(tangents)) {
            for (point, weight) in curve.iter_mut().zip(function) {
                *point = *point + value * *weight;
            }
        }
        for (node, position) in self.held.iter().zip(positions) {
            curve[*node] = *position;
        }
        if curve.iter().all(|point| point.finite()) { Ok(curve) } else { Err(BeamError::NotSolvable) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::beam::closed_form::ExactHermite;
    use glam::DVec2;

    #[test]
    fn one_open_and_one_closed_reference() {
        // The parabola through three points has these tangents at its ends.
        let p = [DVec2::ZERO, DVec2::new(0.5, 1.2), DVec2::new(1.0, 0.1)];
        let tangents = [p[0] * -3.0 + p[1] * 4.0 - p[2], p[0] - p[1] * 4.0 + p[2] * 3.0];
        let curve = OpenCardinals::differences(9, &[4], Stiffness::default()).unwrap().curve(&p, tangents).unwrap();
        let wanted = [
            0.0,
            0.511770155363,
            0.8813455657492,
            1.111770155363,
            1.2,
            1.136770155363,
            0.9313455657492,
            0.586770155363,
            0.1,
        ];
        for (i, (found, y)) in curve.iter().zip(wanted).enumerate() {
            assert!(found.distance(DVec2::new(i as f64 / 8.0, y)) < 1e-12, "{curve:?}");
        }
    }

    #[test]
    fn both_ways_are_the_beam_and_its_limit() {
        for ratio in [0.0, 2.8, 1e4] {
            let stiffness = Stiffness::new(1.0, ratio).unwrap();
            let beam = OpenBeam::new(65, &[16, 40], EndCondition::Clamped, EndCondition::Clamped, stiffness).unwrap();
            let (p, t) = ([0.3, 1.0, -0.5, 2.0], [1.5, -4.0]);
            let values =
                OpenValues { left_tangent: t[0], right_tangent: t[1], pins: &p[1..3], ..OpenValues::ends(p[0], p[3]) };
            let (solved, cardinals) =
                (beam.solve(&values), OpenCardinals::differences(65, &[16, 40], stiffness).unwrap());
            let combined = cardinals.curve(&p, t).unwrap();
            assert!(solved.unwrap().iter().zip(&combined).all(|(a, b)| (a - b).abs() < 1e-13));
            let error = |nodes: usize| {
                let pins = [(nodes - 1) / 4, (nodes - 1) / 8 * 5];
                let differences = OpenCardinals::differences(nodes, &pins, stiffness).unwrap().curve(&p, t).unwrap();
                let exact = OpenCardinals::exact(nodes, &pins, stiffness).unwrap().curve(&p, t).unwrap();
                differences.iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
            };
            let order = (error(1025) / error(2049)).log2();
            assert!((order - 2.0).abs() < 0.05, "ratio {ratio}: order {order}");
        }
    }

    /// Both kinds without pins: H00, H10, H01, H11.
    fn hermite(cardinals: &OpenCardinals) -> [&[f64]; 4] {
        let (p, t) = (cardinals.positions(), cardinals.tangents());
        [&p[0], &t[0], &p[1], &t[1]]
    }

    #[test]
    fn without_pins_they_are_the_hermite_basis() {
        let error = |cardinals: &OpenCardinals, stiffness: Stiffness| {
            let exact = ExactHermite::new(stiffness);
            let nodes = cardinals.nodes();
            (0..nodes)
                .flat_map(|i| {
                    let wanted = exact.values(i as f64 / (nodes - 1) as f64);
                    [0, 1, 2, 3].map(|k| (hermite(cardinals)[k][i] - wanted[k]).abs())
                })
                .fold(0.0, f64::max)
        };
        for ratio in [0.0, 2.8, 100.0] {
            let stiffness = Stiffness::new(1.0, ratio).unwrap();
            assert!(error(&OpenCardinals::exact(65, &[], stiffness).unwrap(), stiffness) < 1e-12);
            for nodes in [65, 129, 257, 2049] {
                let off = |nodes| error(&OpenCardinals::differences(nodes, &[], stiffness).unwrap(), stiffness);
                let order = (off(nodes) / off(2 * nodes - 1)).log2();
                assert!((order - 2.0).abs() < 0.05, "ratio {ratio}, {nodes} nodes: order {order}");
            }
        }
    }

    #[test]
    fn ends_are_exact_and_values_stay_bounded_however_taut() {
        for ratio in [0.0, 2.8, 1e8, 1e12] {
            let stiffness = Stiffness::new(1.0, ratio).unwrap();
            for nodes in [4, 5, 64, 4096] {
                for cardinals in [
                    OpenCardinals::differences(nodes, &[], stiffness).unwrap(),
                    OpenCardinals::exact(nodes, &[], stiffness).unwrap(),
                ] {
                    let [h00, h10, h01, h11] = hermite(&cardinals);
                    let last = nodes - 1;
                    let near = |found: [f64; 4], wanted: [f64; 4]| {
                        found.iter().zip(wanted).all(|(f, w)| (f - w).abs() < 1e-15)
                    };
                    assert!(near([h00[0], h01[0], h10[0], h11[0]], [1.0, 0.0, 0.0, 0.0]));
                    assert!(near([h00[last], h01[last], h10[last], h11[last]], [0.0, 1.0, 0.0, 0.0]));
                    assert!(h01.windows(2).all(|w| w[1] >= w[0] - 1e-14), "ratio {ratio}, {nodes} nodes");
                    assert!(h11.iter().all(|h| (-0.15..=1e-14).contains(h)), "ratio {ratio}, {nodes} nodes");
                }
            }
        }
    }

    #[test]
    fn positions_add_up_to_one_and_a_point_stays_a_point() {
        for cardinals in [
            OpenCardinals::differences(33, &[7, 8], Stiffness::default()).unwrap(),
            OpenCardinals::exact(33, &[7, 8], Stiffness::default()).unwrap(),
        ] {
            for i in 0..33 {
                assert!((cardinals.positions().iter().map(|f| f[i]).sum::<f64>() - 1.0).abs() < 1e-13);
            }
            let apex = DVec2::new(0.1, 1.66);
            assert!(cardinals.curve(&[apex; 4], [DVec2::ZERO; 2]).unwrap().iter().all(|p| *p == apex));
        }
        let unsorted = OpenCardinals::exact(33, &[8, 7], Stiffness::default());
        assert_eq!(unsorted, Err(BeamError::Unordered { index: 2 }));
        let short = OpenCardinals::exact(33, &[8], Stiffness::default()).unwrap().curve(&[0.0; 2], [0.0; 2]);
        assert!(matches!(short, Err(BeamError::Count { found: 2, needed: 3, .. })));
    }
}
