//! **Order sections**: cross-sections in any order, put in order along the limb.

use glam::DVec3;
use maquette_geometry::sections::order::{OrderError, OrderOptions, OrderWarning, SectionStart, order_while};
use maquette_graph::{AtPort, Choices, NodeError, NodeKind, Unit};

use crate::wire;

#[derive(Clone, Copy)]
struct StartChoice(SectionStart);

impl Choices for StartChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(SectionStart::Front), "front", "at the front, which is carried along the stack without turning about it"),
        (
            Self(SectionStart::Nearest),
            "nearest",
            "the first at the front, each next nearest to the start of the one before",
        ),
        (Self(SectionStart::Kept), "kept", "where they were drawn"),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "order-sections",
        1,
        "section",
        "Puts closed curves in the order in which they stand along a limb, all running the same way from the same side.",
    );
    let curves = node.input::<wire::Curves>("curves", "The sections in any order, run either way.");
    let axis = node.optional::<wire::Curve>("axis", "Open curve along which they stand; none finds the shortest way.");
    let towards = node.vector(
        "towards",
        [0.0, 1.0, 0.0],
        Unit::None,
        "The stack ends farther in this direction than it begins; an axis gives its own.",
    );
    let start = node.choice::<StartChoice>("start", "Where sections begin.");
    let front = node.vector("front", [0.0, 0.0, 1.0], Unit::None, "Where the front is.");
    let double = node.number(
        "double",
        0.001,
        0.0..=0.5,
        "Sections nearer to one another than this share of their size count as one, and the second is dropped.",
    );
    node.soft_range(double, 0.0..=0.05);
    let shared = node.boolean(
        "shared",
        false,
        "The curves come from parts that share sections: one that comes twice is meant, and dropped without a warning.",
    );
    let ordered = node
        .output::<wire::Curves>("curves", "The sections in order, counter-clockwise about the direction of the stack.");
    let reversed = node.figure("reversed", Unit::None, "Sections that were run the other way.");
    let dropped = node.figure("dropped", Unit::None, "Sections that repeated another one.");
    let table = node.table(
        "sections",
        &[("curve", Unit::None), ("name", Unit::None), ("reversed", Unit::None), ("start-moved", Unit::Length)],
        "The sections in order: which curve each was, counted from 0, and what was done with it.",
    );
    node.evaluate(move |ports| {
        let options = OrderOptions {
            towards: DVec3::from_array(ports.read(towards).0),
            front: DVec3::from_array(ports.read(front).0),
            start: ports.choice(start).0,
            double: ports.value(double),
            axis: ports.read_optional(axis).map(|axis| axis.0.clone()),
        };
        let found = match order_while(&ports.read(curves).0, &options, &ports.progress_callback()) {
            Err(OrderError::Stopped) => return Err(NodeError::Cancelled),
            Err(error @ OrderError::Direction { what: "front", .. }) => return Err(error).at(front),
            Err(error @ OrderError::Direction { .. }) => return Err(error).at(towards),
            Err(error @ OrderError::Double { .. }) => return Err(error).at(double),
            found => found.at(curves)?,
        };
        for warning in &found.warnings {
            if ports.value(shared) && matches!(warning, OrderWarning::Double { .. }) {
                ports.note(warning);
            } else {
                ports.warn(warning);
            }
        }
        let doubles = found.warnings.iter().filter(|warning| matches!(warning, OrderWarning::Double { .. })).count();
        let turned = found.placed.iter().filter(|placed| placed.reversed).count();
        let rows = found.placed.iter().map(|placed| {
            vec![placed.section.into(), placed.name.as_str().into(), placed.reversed.into(), placed.start_moved.into()]
        });
        ports.table(table, rows.collect());
        #[expect(clippy::cast_precision_loss, reason = "at most 2048")]
        {
            ports.figure(reversed, turned as f64);
            ports.figure(dropped, doubles as f64);
        }
        ports.write(ordered, wire::Curves(found.sections));
        Ok(())
    });
    node
}
