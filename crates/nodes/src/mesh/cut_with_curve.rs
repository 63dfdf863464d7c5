//! **Cut with curve**: a hole, or a piece, along a closed stroke drawn over a mesh.
//! Reference: paper 5.2.5 (a hole to blend a limb into).

use std::collections::BTreeSet;

use glam::DVec3;
use maquette_geometry::border::{Border, boundaries};
use maquette_geometry::mesh::stroke::{self, Keep, StrokeError, cut_along};
use maquette_graph::{AtPort, Choices, NodeKind};

use crate::view_plane::{Facing, ViewPlane};
use crate::wire;

#[derive(Clone, Copy)]
struct KeepChoice(Keep);

impl Choices for KeepChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(Keep::Outside), "outside", "a hole is cut"),
        (Self(Keep::Inside), "inside", "the piece inside of the stroke remains"),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "cut-with-curve",
        2,
        "mesh",
        "Cuts a mesh along a closed stroke drawn in a view: a hole for a blend, or a piece to keep.",
    );
    node.reference("paper 5.2.5");
    let mesh = node.input::<wire::Mesh>("mesh", "The mesh to cut. A finer one follows the stroke more closely.");
    let stroke = node.input::<wire::Curve>("stroke", "A closed stroke.");
    let view = node.choice::<ViewPlane>("view", "The view in which it is drawn.");
    let facing = node.choice::<Facing>("facing", "Which side is cut.");
    let keep = node.choice::<KeepChoice>("keep", "What remains.");
    let through =
        node.boolean("through", false, "Cut all that lies behind, too; otherwise only the side that it faces.");
    let cut = node.output::<wire::Mesh>("mesh", "What remains.");
    let borders = node.output::<wire::Borders>("borders", "The new borders, ready for `blend`.");
    node.evaluate(move |ports| {
        let body = &ports.read(mesh).0;
        let line = &ports.read(stroke).0;
        let ahead = ports.choice(view).looks_along();
        // The back is what is seen from behind.
        let direction = match ports.choice(facing).0 {
            stroke::Facing::Seen => ahead,
            stroke::Facing::Back => -ahead,
        };
        let made = cut_along(body, line, direction, ports.choice(keep).0, ports.value(through));
        let made = match made {
            Err(error @ (StrokeError::Empty(_) | StrokeError::Mesh(_))) => Err(error).at(mesh),
            made => made.at(stroke),
        }?;
        // A cut elsewhere numbers vertices anew, so that an old border may start at another of its points.
        let bits = |p: &DVec3| p.to_array().map(f64::to_bits);
        let before: BTreeSet<_> =
            boundaries(body).at(mesh)?.iter().flat_map(|old| old.curve().points().iter().map(bits)).collect();
        let fresh = |border: &Border| border.curve().points().iter().any(|p| !before.contains(&bits(p)));
        let new = boundaries(&made).at(mesh)?.into_iter().filter(fresh).collect();
        ports.write(cut, wire::Mesh::new(made));
        ports.write(borders, wire::Borders(new));
        Ok(())
    });
    node
}
