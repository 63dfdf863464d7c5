//! A displacement around a section, given where strokes pin it.

use crate::beam::closed_form::ExactHermite;
use crate::beam::{BeamError, ClosedBeam, Stiffness};

use super::error::SilhouetteError;

/// How a section touches a stroke at its pin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Contact {
    /// The section runs straight along the direction of sight there, so that its silhouette touches the stroke at the pin
    /// and nowhere stands out beside it, even where sections are tilted. The beam is clamped there.
    #[default]
    Tangent,
    /// The pin alone is given, as printed in the thesis. Where tilted sections follow a slanting stroke their silhouette
    /// stands out beside the pins.
    Point,
}

/// Cardinal functions of one component of the displacement: one product a pin and node gives it.
#[derive(Clone, Debug)]
pub(super) enum Ring {
    /// Held at points, free to turn.
    Pinned(ClosedBeam),
    /// Clamped at points.
    Clamped(Clamped),
}

/// A closed beam that is clamped at some nodes: between them each span is a beam of its own.
#[derive(Clone, Debug)]
pub(super) struct Clamped {
    nodes: usize,
    /// Nodes at which it is clamped, in the order given.
    pins: Vec<usize>,
    spans: Vec<Span>,
}

/// The nodes between two pins.
#[derive(Clone, Debug)]
struct Span {
    /// Places of both pins in the order given.
    ends: [usize; 2],
    first: usize,
    /// For each inner node the weights of the value and of the slope per node at the start, then at the end.
    weights: Vec<[f64; 4]>,
}

impl Ring {
    pub(super) fn new(
        nodes: usize,
        pins: &[usize],
        contact: Contact,
        stiffness: Stiffness,
    ) -> Result<Self, SilhouetteError> {
        // It checks the pins for both.
        let pinned = ClosedBeam::new(nodes, pins, stiffness)?;
        if contact == Contact::Point {
            return Ok(Self::Pinned(pinned));
        }
        let mut order: Vec<usize> = (0..pins.len()).collect();
        order.sort_unstable_by_key(|place| pins[*place]);
        let spans = (0..order.len())
            .map(|k| {
                let ends = [order[k], order[(k + 1) % order.len()]];
                let length = match (pins[ends[1]] + nodes - pins[ends[0]]) % nodes {
                    0 => nodes,
                    length => length,
                };
                // u runs over 1 around the whole section, so that a short span feels less of the tension.
                let share = length as f64 / nodes as f64;
                let local = Stiffness::new(stiffness.bending(), stiffness.stretching() * share * share)
                    .map_err(|_| BeamError::NotSolvable)?;
                let hermite = ExactHermite::new(local);
                let weights = (1..length)
                    .map(|i| {
                        let [start, start_slope, end, end_slope] = hermite.values(i as f64 / length as f64);
                        [start, start_slope * length as f64, end, end_slope * length as f64]
                    })
                    .collect();
                Ok(Span { ends, first: pins[ends[0]], weights })
            })
            .collect::<Result<_, BeamError>>()?;
        Ok(Self::Clamped(Clamped { nodes, pins: pins.to_vec(), spans }))
    }

    /// The displacement of each node where the pins move by `values`; where the beam is clamped, by `slopes` more from one
    /// node to the next there.
    pub(super) fn solve(&self, values: &[f64], slopes: &[f64]) -> Result<Vec<f64>, BeamError> {
        let ring = match self {
            Self::Pinned(beam) => return beam.solve(values),
            Self::Clamped(ring) => ring,
        };
        let mut moved = vec![0.0; ring.nodes];
        for (pin, value) in ring.pins.iter().zip(values) {
            moved[*pin] = *value;
        }
        for Span { ends: [start, end], first, weights } in &ring.spans {
            // Relative to the start, so that a section that moves as a whole keeps its shape exactly.
            let (origin, rise) = (values[*start], values[*end] - values[*start]);
            for (i, [_, start_slope, end_value, end_slope]) in weights.iter().enumerate() {
                moved[(first + 1 + i) % ring.nodes] =
                    origin + rise * end_value + slopes[*start] * start_slope + slopes[*end] * end_slope;
            }
        }
        if moved.iter().all(|value| value.is_finite()) { Ok(moved) } else { Err(BeamError::NotSolvable) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clamping_at_the_slopes_of_a_pinned_beam_gives_that_beam() {
        // With many nodes both are the exact tension spline.
        let (nodes, pins) = (2000, [1500, 100, 900]);
        for ratio in [0.0, 2.8, 400.0] {
            let stiffness = Stiffness::new(1.0, ratio).unwrap();
            let values = [0.3, -0.2, 1.0];
            let pinned = Ring::new(nodes, &pins, Contact::Point, stiffness).unwrap();
            let wanted = pinned.solve(&values, &[]).unwrap();
            let slopes = pins.map(|pin| (wanted[pin + 1] - wanted[pin - 1]) / 2.0);
            let clamped = Ring::new(nodes, &pins, Contact::Tangent, stiffness).unwrap();
            let found = clamped.solve(&values, &slopes).unwrap();
            let off = found.iter().zip(&wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off < 1e-5, "ratio {ratio}: {off}");
            assert!(pins.iter().zip(values).all(|(pin, value)| found[*pin] == value));
        }
    }

    #[test]
    fn one_pin_and_neighbouring_pins_are_no_exception() {
        let stiffness = Stiffness::default();
        let one = Ring::new(12, &[5], Contact::Tangent, stiffness).unwrap();
        assert!(one.solve(&[0.7], &[0.0]).unwrap().iter().all(|value| *value == 0.7));
        let crowded = Ring::new(6, &[0, 1, 3], Contact::Tangent, stiffness).unwrap();
        let moved = crowded.solve(&[1.0, 2.0, 3.0], &[0.0; 3]).unwrap();
        assert_eq!([moved[0], moved[1], moved[3]], [1.0, 2.0, 3.0]);
        assert!((moved[2] - 2.5).abs() < 1e-12, "{moved:?}");
    }
}
