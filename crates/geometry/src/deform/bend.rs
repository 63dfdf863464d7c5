//! Bending a curve as a beam: its points are displaced by the solution of `k_b d'''' - k_s d'' = f` (thesis 5.5, 6.5).

use glam::DVec3;

use crate::beam::{BeamError, ClosedBeam, EndCondition, OpenBeam, OpenValues, Stiffness, StiffnessError};
use crate::curve::{ArcLength, Curve, CurveError, ResampleError, Resampling, resample};

/// What stiffness and forces are counted in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BeamUnits {
    /// As in the thesis: `u` runs over 0 to 1 along the whole curve whatever its length, stiffness has no unit, a point
    /// load is `k_b` times the jump of `d'''`, and a spread load is the `f` of the equation.
    Share(Stiffness),
    /// Over arc length in metres: `EI` in N m^2, tension and point loads in N, a spread load in N/m.
    Metres {
        /// `EI`, N m^2, above 0.
        bending: f64,
        /// Tension along the beam, N, 0 or above.
        tension: f64,
    },
}

/// How an end of an open curve is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EndHold {
    /// Place and direction stay.
    Clamped,
    /// The place stays, and the end turns.
    Pinned,
    /// Nothing stays. With a pin at it, it is a pinned end.
    Free,
}

/// A point of the curve that is put somewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamPin {
    /// Share of the length, 0 to 1; the nearest node is pinned.
    pub share: f64,
    /// Where it goes.
    pub goal: PinGoal,
}

/// Where a pinned point goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PinGoal {
    /// Away from its place at rest by this, metres.
    By(DVec3),
    /// To this place, metres.
    To(DVec3),
}

/// A load on one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLoad {
    /// Share of the length, 0 to 1; between two nodes both carry their share of it.
    pub share: f64,
    /// The force, in the units of the beam.
    pub force: DVec3,
}

/// How a curve is bent.
#[derive(Clone, Debug, PartialEq)]
pub struct Bending {
    /// Equal intervals along the curve: 4 to [`crate::beam::MOST_NODES`] - 1, on a closed curve 5 at least.
    pub intervals: usize,
    /// Stiffness, and the units of all forces.
    pub units: BeamUnits,
    /// The ends of an open curve: first and last point.
    pub ends: [EndHold; 2],
    /// Points that are put somewhere. On an open curve one at share 0 or 1 displaces that end.
    pub pins: Vec<BeamPin>,
    /// Loads on points.
    pub loads: Vec<PointLoad>,
    /// A load spread evenly over the whole length, per length.
    pub spread: DVec3,
}

/// What holds a bent curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Support {
    /// The pin of that index; none for an end that is held without one.
    pub pin: Option<usize>,
    /// The node.
    pub node: usize,
    /// Its share of the length.
    pub share: f64,
    /// Force with which it pushes the curve, in the units of the beam. With the loads they add up to zero.
    pub force: DVec3,
    /// Moment with which it turns the direction of the curve, component by component; zero but at a clamped end.
    pub moment: DVec3,
}

/// A bent curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Bent {
    /// The curve at rest, its points at the nodes of the beam: equal arc length.
    pub rest: Curve,
    /// The same points, displaced.
    pub curve: Curve,
    /// What holds it, along the curve.
    pub supports: Vec<Support>,
    /// Largest displacement of a point, metres.
    pub largest_displacement: f64,
    /// The point displaced most.
    pub displaced_most: usize,
}

/// Why a curve cannot be bent.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BendError {
    /// A share of the length that is none.
    #[error("{what} {index} stands at {share} of the length: give a share from 0 to 1")]
    Share {
        /// `pin` or `load`.
        what: &'static str,
        /// Its place in the list.
        index: usize,
        /// What was given.
        share: f64,
    },
    /// Two pins on one node.
    #[error(
        "pins {first} and {second} both fall on node {node}: take one away, move them apart or raise the intervals"
    )]
    SamePlace {
        /// Place of the earlier one in the list.
        first: usize,
        /// Place of the later one.
        second: usize,
        /// The node.
        node: usize,
    },
    /// A displacement or force that is not a number.
    #[error("{what} is not finite, or beyond what can be computed: give smaller numbers")]
    NotFinite {
        /// Which one.
        what: &'static str,
    },
    /// A stiffness that is none.
    #[error(transparent)]
    Stiffness(#[from] StiffnessError),
    /// A curve that cannot be divided.
    #[error(transparent)]
    Resample(#[from] ResampleError),
    /// A beam that is held too little or cannot be solved.
    #[error(transparent)]
    Beam(#[from] BeamError),
    /// Displacements that leave no curve.
    #[error("bent like this it is no curve any more: {0}")]
    Curve(#[from] CurveError),
}

/// Bends a curve: a straight or curved one, open or closed, at rest without any stress.
///
/// The displacement is solved in each coordinate as if the curve were straight at rest, which a ring is not: what it
/// passes through is exact, what it does between is the thesis' equation and not a curved beam's. Finite differences, of
/// second order in the intervals; every point of the result is a node.
///
/// # Errors
/// [`BendError`].
pub fn bend(rest: &Curve, bending: &Bending) -> Result<Bent, BendError> {
    let closed = rest.is_closed();
    let intervals = bending.intervals;
    let nodes = if closed { intervals } else { intervals.saturating_add(1) };
    if nodes > crate::beam::MOST_NODES {
        return Err(BeamError::TooManyNodes { found: nodes }.into());
    }
    let needed = if closed { 5 } else { 4 };
    if nodes < needed {
        return Err(BeamError::TooFewNodes { found: nodes, needed }.into());
    }
    let length = ArcLength::of(rest).length();
    let rest = resample(rest, &Resampling::count(nodes))?;
    // Over the share u = s/L of the length, EI becomes k_b, a tension k_s / L^2, and a force F the load F L^3.
    let (stiffness, load_scale, spread_scale) = match bending.units {
        BeamUnits::Share(stiffness) => (stiffness, 1.0, 1.0),
        BeamUnits::Metres { bending, tension } => {
            (Stiffness::new(bending, tension * length * length)?, length.powi(3), length.powi(4))
        }
    };
    let moment_scale = if matches!(bending.units, BeamUnits::Metres { .. }) { length * length } else { 1.0 };
    let pins = placed(&rest, bending)?;
    let loads = nodal_loads(bending, closed, nodes, load_scale, spread_scale)?;
    let held = if closed {
        closed_beam(nodes, &pins, &loads, stiffness)?
    } else {
        open_beam(nodes, &pins, &loads, stiffness, bending.ends)?
    };
    let share = |node: usize| node as f64 / intervals as f64;
    let supports = held.supports.into_iter().map(|support| Support {
        share: share(support.node),
        force: (support.force - loads[support.node]) / load_scale,
        moment: support.moment / moment_scale,
        ..support
    });
    let supports: Vec<Support> = supports.collect();
    if !supports.iter().all(|support| support.force.is_finite() && support.moment.is_finite()) {
        return Err(BendError::NotFinite { what: "a force that holds the curve" });
    }
    let points: Vec<DVec3> = rest.points().iter().zip(&held.displacements).map(|(p, d)| *p + *d).collect();
    let far = |node: &usize| held.displacements[*node].length();
    let displaced_most = (0..nodes).rev().max_by(|a, b| far(a).total_cmp(&far(b))).unwrap_or_default();
    let largest_displacement = far(&displaced_most);
    let curve = Curve::new(rest.name(), points, closed)?;
    if curve.points().len() != nodes {
        // Points that fall together are dropped; what follows would no longer be node by node.
        let left = curve.points().len();
        return Err(CurveError::TooFewPoints { name: rest.name().to_owned(), found: left, needed: nodes }.into());
    }
    Ok(Bent { rest, curve, supports, largest_displacement, displaced_most })
}

/// A pin at its node, with its displacement.
struct Placed {
    node: usize,
    displacement: DVec3,
}

fn placed(rest: &Curve, bending: &Bending) -> Result<Vec<Placed>, BendError> {
    let count = rest.points().len();
    let mut pin_at = vec![None; count];
    let mut placed = Vec::with_capacity(bending.pins.len());
    for (index, pin) in bending.pins.iter().enumerate() {
        if !(0.0..=1.0).contains(&pin.share) {
            return Err(BendError::Share { what: "pin", index, share: pin.share });
        }
        let node =
            (pin.share * bending.intervals as f64).round() as usize % if rest.is_closed() { count } else { usize::MAX };
        let displacement = match pin.goal {
            PinGoal::By(displacement) => displacement,
            PinGoal::To(place) => place - rest.points()[node],
        };
        if !displacement.is_finite() {
            return Err(BendError::NotFinite { what: "the displacement of a pin" });
        }
        if let Some(first) = pin_at[node].replace(index) {
            return Err(BendError::SamePlace { first, second: index, node });
        }
        placed.push(Placed { node, displacement });
    }
    Ok(placed)
}

/// The load on each node, over `u`: its share of the spread load and of the point loads beside it.
fn nodal_loads(
    bending: &Bending,
    closed: bool,
    nodes: usize,
    load_scale: f64,
    spread_scale: f64,
) -> Result<Vec<DVec3>, BendError> {
    let step = 1.0 / bending.intervals as f64;
    let spread = bending.spread * (spread_scale * step);
    let mut loads = vec![spread; nodes];
    if !closed {
        loads[0] = spread / 2.0;
        loads[nodes - 1] = spread / 2.0;
    }
    for (index, load) in bending.loads.iter().enumerate() {
        if !(0.0..=1.0).contains(&load.share) {
            return Err(BendError::Share { what: "load", index, share: load.share });
        }
        let place = load.share * bending.intervals as f64;
        let before = (place.floor() as usize).min(bending.intervals - 1);
        let part = place - before as f64;
        let force = load.force * load_scale;
        loads[before] += force * (1.0 - part);
        let after = if closed { (before + 1) % nodes } else { before + 1 };
        loads[after] += force * part;
    }
    if loads.iter().all(|load| load.is_finite()) { Ok(loads) } else { Err(BendError::NotFinite { what: "a load" }) }
}

/// Displacements, and what holds them: forces over `u`, the loads on these nodes still among them.
struct Held {
    displacements: Vec<DVec3>,
    supports: Vec<Support>,
}

fn support(pin: Option<usize>, node: usize, force: DVec3, moment: DVec3) -> Support {
    Support { pin, node, share: 0.0, force, moment }
}

fn closed_beam(nodes: usize, pins: &[Placed], loads: &[DVec3], stiffness: Stiffness) -> Result<Held, BendError> {
    let at: Vec<usize> = pins.iter().map(|pin| pin.node).collect();
    let values: Vec<DVec3> = pins.iter().map(|pin| pin.displacement).collect();
    let beam = ClosedBeam::new(nodes, &at, stiffness)?;
    let per_step = nodes as f64;
    let forces: Vec<DVec3> = loads.iter().map(|load| *load * per_step).collect();
    let displacements = beam.solve_with_forces(&values, &forces)?;
    let reactions = beam.reactions(&displacements)?;
    let supports = at.iter().zip(reactions).enumerate();
    let mut supports: Vec<Support> =
        supports.map(|(pin, (node, force))| support(Some(pin), *node, force / per_step, DVec3::ZERO)).collect();
    supports.sort_by_key(|support| support.node);
    Ok(Held { displacements, supports })
}

fn open_beam(
    nodes: usize,
    pins: &[Placed],
    loads: &[DVec3],
    stiffness: Stiffness,
    ends: [EndHold; 2],
) -> Result<Held, BendError> {
    let last = nodes - 1;
    let pin_on = |node: usize| pins.iter().position(|pin| pin.node == node);
    let end_pins = [pin_on(0), pin_on(last)];
    let condition = |end: usize| match ends[end] {
        EndHold::Clamped => EndCondition::Clamped,
        EndHold::Pinned => EndCondition::Natural,
        EndHold::Free if end_pins[end].is_some() => EndCondition::Natural,
        EndHold::Free => EndCondition::Free,
    };
    let conditions = [condition(0), condition(1)];
    let inner: Vec<usize> = (0..pins.len()).filter(|pin| ![0, last].contains(&pins[*pin].node)).collect();
    let at: Vec<usize> = inner.iter().map(|pin| pins[*pin].node).collect();
    let goals: Vec<DVec3> = inner.iter().map(|pin| pins[*pin].displacement).collect();
    let beam = OpenBeam::new(nodes, &at, conditions[0], conditions[1], stiffness)?;
    let per_step = last as f64;
    let mut forces: Vec<DVec3> = loads.iter().map(|load| *load * per_step).collect();
    // What loads an end is given as the load on it; at a held end its support takes it.
    (forces[0], forces[last]) = (DVec3::ZERO, DVec3::ZERO);
    let displaced = |end: usize| end_pins[end].map_or(DVec3::ZERO, |pin| pins[pin].displacement);
    let values = OpenValues {
        left_load: loads[0],
        right_load: loads[last],
        pins: &goals,
        forces: &forces,
        ..OpenValues::ends(displaced(0), displaced(1))
    };
    let displacements = beam.solve(&values)?;
    let still = [DVec3::ZERO; 2];
    let reactions = beam.reactions(&displacements, still)?;
    let end_reactions = beam.end_reactions(&displacements, still)?;
    let mut supports: Vec<Support> = inner
        .iter()
        .zip(reactions)
        .map(|(pin, force)| support(Some(*pin), pins[*pin].node, force / per_step, DVec3::ZERO))
        .collect();
    for (end, node) in [(0, 0), (1, last)] {
        if conditions[end] != EndCondition::Free {
            supports.push(support(end_pins[end], node, end_reactions[end].load, end_reactions[end].moment));
        }
    }
    supports.sort_by_key(|support| support.node);
    Ok(Held { displacements, supports })
}
