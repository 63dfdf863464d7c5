//! **Sort**: puts curves in the order the detail generator needs, and says what it decided.
//! Reference: thesis 6.4, Figure 6.11.

use maquette_geometry::curve::{Decision, SortError, SortOptions, sort_while};
use maquette_graph::{AtPort, Choices, NodeError, NodeKind, Unit};

use crate::wire;

/// Where rail 0, and with it the seam of the surface, lies.
#[derive(Clone, Copy)]
enum Seam {
    Left,
    Back,
    Right,
    Front,
}

impl Choices for Seam {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Left, "left", "rail 0 is the one farthest to +X, the model's left"),
        (Self::Back, "back", "rail 0 is the one farthest to -Z"),
        (Self::Right, "right", "rail 0 is the one farthest to -X"),
        (Self::Front, "front", "rail 0 is the one farthest to +Z"),
    ];
}

/// Which way the faces of the surface look that is made from the curves.
#[derive(Clone, Copy, PartialEq)]
enum Faces {
    Outwards,
    Inwards,
}

impl Choices for Faces {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Outwards, "outwards", "away from the axis: limbs, clothes"),
        (Self::Inwards, "inwards", "towards the axis: what one looks into, such as eye sockets and mouths"),
    ];
}

impl Seam {
    fn direction(self) -> glam::DVec3 {
        match self {
            Self::Left => glam::DVec3::X,
            Self::Back => glam::DVec3::NEG_Z,
            Self::Right => glam::DVec3::NEG_X,
            Self::Front => glam::DVec3::Z,
        }
    }
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "sort",
        1,
        "curve",
        "Orders curves into rails around an axis, all running the same way, and starts closed curves at rail 0.",
    );
    node.reference("thesis 6.4, Figure 6.11; paper 4.2");
    let curves = node.input::<wire::Curves>("curves", "Rails (open) and the closed curves they run between, mixed; closed ones in the order in which rails pass them.");
    let seam = node.choice::<Seam>("seam", "Where rail 0 and the seam lie.");
    let order = node.text(
        "order",
        "",
        "Order pinned by hand: names or numbers of the open curves, separated by commas; empty sorts by angle.",
    );
    let reverse = node.boolean("reverse", false, "Run the rails the other way: start and end change places.");
    let faces = node.choice::<Faces>("faces", "Which way the surface looks that is made from the curves.");
    let rails = node.output::<wire::Curves>("rails", "Open curves in order around, all running the same way.");
    let closed = node.output::<wire::Curves>(
        "closed",
        "Closed curves, counter-clockwise, started at rail 0; with faces inwards they run clockwise.",
    );
    let ordered = node.table(
        "rails",
        &[
            ("rail", Unit::None),
            ("curve", Unit::None),
            ("angle", Unit::Angle),
            ("reversed", Unit::None),
            ("pinned", Unit::None),
        ],
        "The rails in order: their curves, angles from the seam, and whether they run against their drawing.",
    );
    let started = node.table(
        "closed",
        &[("curve", Unit::None), ("reversed", Unit::None), ("start-moved", Unit::Length)],
        "The closed curves: whether they were reversed, and how far along them their start moved to rail 0.",
    );
    let joined = node.figure(
        "apex-moved",
        Unit::Length,
        "How far the farthest rail end was moved to the point in which all rails meet, or two crossing curves were apart.",
    );
    node.evaluate(move |ports| {
        let order = ports.read(order).split(',').map(str::trim).filter(|name| !name.is_empty()).map(str::to_owned);
        let options = SortOptions {
            seam: ports.choice(seam).direction(),
            order: order.collect(),
            reverse_run: ports.value(reverse),
            inwards: ports.choice(faces) == Faces::Inwards,
        };
        let go_on = ports.progress_callback();
        let sorted = match sort_while(&ports.read(curves).0, &options, &|| go_on(0.5)) {
            Err(SortError::Stopped) => return Err(NodeError::Cancelled),
            sorted => sorted.at(curves)?,
        };
        sorted.decisions.iter().for_each(|decision| ports.note(decision));
        let (mut rails_found, mut closed_found) = (Vec::new(), Vec::new());
        for decision in &sorted.decisions {
            match decision {
                Decision::Rail { rail, curve, flipped, angle, pinned } => rails_found.push(vec![
                    (*rail).into(),
                    curve.as_str().into(),
                    angle.to_degrees().into(),
                    (*flipped).into(),
                    (*pinned).into(),
                ]),
                Decision::Closed { curve, reversed, moved } => {
                    closed_found.push(vec![curve.as_str().into(), (*reversed).into(), (*moved).into()]);
                }
                Decision::Apex { moved: apart, .. } | Decision::Cut { gap: apart, .. } => ports.figure(joined, *apart),
                _ => {}
            }
        }
        ports.table(ordered, rails_found);
        if !closed_found.is_empty() {
            ports.table(started, closed_found);
        }
        sorted.warnings.iter().for_each(|warning| ports.warn(warning));
        ports.write(rails, wire::Curves(sorted.rails));
        ports.write(closed, wire::Curves(sorted.closed));
        Ok(())
    });
    node
}
