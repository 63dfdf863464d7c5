//! The difference equations of a beam with some nodes fixed, closed or open, factored once.

use super::banded::BandedFactor;
use super::error::BeamError;
use super::quantity::Quantity;
use super::stiffness::Stiffness;
use super::{EndCondition, MOST_NODES};

/// Which nodes follow which at the two ends of the list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Closure {
    /// The last node joins the first.
    Cyclic,
    /// The list ends; beyond each end stands one ghost node.
    Open(EndCondition, EndCondition),
}

/// The equations `(d_{i-2} - 4 d_{i-1} + 6 d_i - 4 d_{i+1} + d_{i+2}) - (k_s/k_b) h^2 (d_{i-1} - 2 d_i + d_{i+1}) =
/// h^4 f_i / k_b` (thesis 5.8 with its right side corrected) at every node that is not fixed.
#[derive(Clone, Debug)]
pub(super) struct System {
    stiffness: Stiffness,
    closure: Closure,
    step: f64,
    /// Nodes that are not fixed, in the order of elimination; free ends among them.
    free: Vec<usize>,
    factor: BandedFactor,
    nodes: usize,
}

/// Share of the values by which the last correction may still change them.
const UNSETTLED: f64 = 1e-6;

/// What holds and drives the beam in one solve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drive<'a, T> {
    /// `dP/du` at the left and right end, used where that end is clamped.
    pub(super) tangents: [T; 2],
    /// Load on the left and right end, used where that end is free.
    pub(super) loads: [T; 2],
    /// Force at each node, or empty for none.
    pub(super) forces: &'a [T],
}

impl System {
    /// Assembles and factors. `fixed` are distinct nodes in range; the ends of an open beam are among them unless free.
    pub(super) fn new(
        nodes: usize,
        fixed: &[usize],
        closure: Closure,
        stiffness: Stiffness,
    ) -> Result<Self, BeamError> {
        let intervals = if closure == Closure::Cyclic { nodes } else { nodes - 1 };
        let step = 1.0 / intervals as f64;
        let tension = stiffness.ratio() * step * step;
        let mut is_fixed = vec![false; nodes];
        for node in fixed {
            is_fixed[*node] = true;
        }
        // Folding the loop (0, n-1, 1, n-2, ..) puts neighbours of neighbours at most four places apart: a plain
        // band, where the natural order would leave entries in the far corners.
        let (order, width): (Vec<usize>, usize) = match closure {
            Closure::Cyclic => ((0..nodes).map(|k| if k % 2 == 0 { k / 2 } else { nodes - 1 - k / 2 }).collect(), 4),
            Closure::Open(..) => ((0..nodes).collect(), 2),
        };
        let free: Vec<usize> = order.into_iter().filter(|node| !is_fixed[*node]).collect();
        let entry = |row: usize, column: usize| {
            let (a, b) = (free[row], free[column]);
            let apart = a.abs_diff(b);
            let apart = if closure == Closure::Cyclic { apart.min(nodes - apart) } else { apart };
            // An end that is not fixed is free: its equation is that of the forces on the last half interval.
            let at_end = matches!(closure, Closure::Open(..)) && [a, b].iter().any(|k| *k == 0 || *k + 1 == nodes);
            match apart {
                0 if at_end => 1.0 + tension,
                0 => 6.0 + 2.0 * tension + ghost_share(closure, nodes, a),
                1 if at_end => -2.0 - tension,
                1 => -4.0 - tension,
                2 => 1.0,
                _ => 0.0,
            }
        };
        let factor = BandedFactor::new(free.len(), width, entry).ok_or(BeamError::NotSolvable)?;
        Ok(Self { stiffness, closure, step, free, factor, nodes })
    }

    pub(super) fn nodes(&self) -> usize {
        self.nodes
    }

    /// Fills in the nodes that are not fixed; the fixed ones already hold their values.
    ///
    /// Solves for corrections until they vanish. The residual is taken from differences of differences, which are
    /// nearly free of round-off, so that the error stays near 1e-15 instead of growing with the fourth power of the
    /// number of nodes.
    pub(super) fn solve<T: Quantity>(&self, values: &mut [T], drive: Drive<'_, T>) -> Result<(), BeamError> {
        let scale = self.step.powi(4) / self.stiffness.bending();
        let mut bends = Vec::with_capacity(self.nodes);
        let mut correction = Vec::with_capacity(self.free.len());
        let (mut settled, mut size, mut change) = (false, 0.0_f64, 0.0_f64);
        for _ in 0..8 {
            self.bends(values, drive.tangents, &mut bends);
            correction.clear();
            for node in &self.free {
                let force = drive.forces.get(*node).map_or_else(T::default, |force| *force * scale);
                correction.push(match self.end_at(*node) {
                    None => force - self.stencil(&bends, *node),
                    // A free end carries its load and half an interval's share of the force.
                    Some(end) => {
                        force * 0.5 + drive.loads[end] * (scale / self.step) - self.end_stencil(&bends, values, end)
                    }
                });
            }
            self.factor.solve(&mut correction);
            change = 0.0;
            for (node, correction) in self.free.iter().zip(&correction) {
                values[*node] = values[*node] + *correction;
                change = change.max(correction.largest());
            }
            size = values.iter().fold(0.0_f64, |size, value| size.max(value.largest()));
            if change <= 2.0 * f64::EPSILON * size {
                settled = true;
                break;
            }
        }
        // Corrections that do not shrink tell of a beam that next to nothing holds.
        settled |= change <= UNSETTLED * size;
        if settled && values.iter().all(|value| value.finite()) { Ok(()) } else { Err(BeamError::NotSolvable) }
    }

    /// Which end a node is, 0 or 1, where the beam is open.
    fn end_at(&self, node: usize) -> Option<usize> {
        match self.closure {
            Closure::Cyclic => None,
            Closure::Open(..) if node == 0 => Some(0),
            Closure::Open(..) => (node + 1 == self.nodes).then_some(1),
        }
    }

    /// What holds the ends of an open beam where they are: the point load and the moment at each.
    pub(super) fn end_reactions<T: Quantity>(&self, values: &[T], tangents: [T; 2]) -> [(T, T); 2] {
        let mut bends = Vec::with_capacity(self.nodes);
        self.bends(values, tangents, &mut bends);
        let k_b = self.stiffness.bending();
        [(0, 0, -1.0), (1, self.nodes - 1, 1.0)].map(|(end, node, sign)| {
            let load = self.end_stencil(&bends, values, end) * (k_b / self.step.powi(3));
            (load, bends[node] * (sign * k_b / (self.step * self.step)))
        })
    }

    /// Left side of the equation of forces on the last half interval at an end, for `k_b = 1` and times `h^3`.
    fn end_stencil<T: Quantity>(&self, bends: &[T], values: &[T], end: usize) -> T {
        let (here, inner) = if end == 0 { (0, 1) } else { (self.nodes - 1, self.nodes - 2) };
        let tension = self.stiffness.ratio() * self.step * self.step;
        (bends[inner] - bends[here]) + (values[here] - values[inner]) * tension
    }

    /// Force of the differential equation that holds `node` where it is: the left side of thesis 5.5 in differences.
    pub(super) fn force<T: Quantity>(&self, values: &[T], tangents: [T; 2], at: &[usize]) -> Vec<T> {
        let mut bends = Vec::with_capacity(self.nodes);
        self.bends(values, tangents, &mut bends);
        let scale = self.stiffness.bending() / self.step.powi(4);
        at.iter().map(|node| self.stencil(&bends, *node) * scale).collect()
    }

    /// Second differences at every node, ghosts included.
    fn bends<T: Quantity>(&self, values: &[T], tangents: [T; 2], bends: &mut Vec<T>) {
        let last = self.nodes - 1;
        let bend = |before: T, here: T, after: T| (after - here) - (here - before);
        // d_{-1} = d_1 - 2 h T at a clamped end, and zero moment at a natural or free one.
        let end = |condition, here: T, inner: T, outward: T| match condition {
            EndCondition::Clamped => ((inner - here) + outward * self.step) * 2.0,
            EndCondition::Natural | EndCondition::Free => T::default(),
        };
        let (first_bend, last_bend) = match self.closure {
            Closure::Cyclic => {
                (bend(values[last], values[0], values[1]), bend(values[last - 1], values[last], values[0]))
            }
            Closure::Open(left, right) => (
                end(left, values[0], values[1], tangents[0] * -1.0),
                end(right, values[last], values[last - 1], tangents[1]),
            ),
        };
        bends.clear();
        bends.push(first_bend);
        bends.extend(values.windows(3).map(|w| bend(w[0], w[1], w[2])));
        bends.push(last_bend);
    }

    /// Left side of the difference equation at `node`, for `k_b = 1` and times `h^4`. On an open beam `node` is not
    /// an end.
    fn stencil<T: Quantity>(&self, bends: &[T], node: usize) -> T {
        let before = bends[if node == 0 { self.nodes - 1 } else { node - 1 }];
        let after = bends[if node + 1 == self.nodes { 0 } else { node + 1 }];
        let here = bends[node];
        ((after - here) - (here - before)) - here * (self.stiffness.ratio() * self.step * self.step)
    }
}

/// What a ghost node adds to the diagonal at the node beside an end.
fn ghost_share(closure: Closure, nodes: usize, node: usize) -> f64 {
    let share = |condition| match condition {
        EndCondition::Clamped => 1.0,
        EndCondition::Natural | EndCondition::Free => -1.0,
    };
    match closure {
        Closure::Cyclic => 0.0,
        Closure::Open(left, right) => {
            (if node == 1 { share(left) } else { 0.0 }) + (if node + 2 == nodes { share(right) } else { 0.0 })
        }
    }
}

/// Checks the number of nodes, and that pins are distinct and within `range`.
pub(super) fn check_nodes_and_pins(
    nodes: usize,
    needed: usize,
    pins: &[usize],
    range: std::ops::RangeInclusive<usize>,
) -> Result<(), BeamError> {
    if nodes < needed {
        return Err(BeamError::TooFewNodes { found: nodes, needed });
    }
    if nodes > MOST_NODES {
        return Err(BeamError::TooManyNodes { found: nodes });
    }
    let mut pin_at = vec![None; nodes];
    for (pin, node) in pins.iter().copied().enumerate() {
        if !range.contains(&node) {
            return Err(BeamError::PinOutOfRange { pin, node, first: *range.start(), last: *range.end() });
        }
        if let Some(first) = pin_at[node] {
            return Err(BeamError::PinnedTwice { first, second: pin, node });
        }
        pin_at[node] = Some(pin);
    }
    Ok(())
}

/// Checks that a list has as many entries as needed, all finite.
pub(super) fn check_values<T: Quantity>(what: &'static str, values: &[T], needed: usize) -> Result<(), BeamError> {
    if values.len() != needed {
        return Err(BeamError::Count { what, found: values.len(), needed });
    }
    match values.iter().position(|value| !value.finite()) {
        Some(index) => Err(BeamError::NotFinite { what, index }),
        None => Ok(()),
    }
}
