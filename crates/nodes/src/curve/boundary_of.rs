//! **Boundary of**: the borders of a mesh or surface, with the directions in which it would go on.
//! Reference: paper 5.2.4 (virtual borders), 5.2.5.

use glam::DVec3;
use maquette_geometry::border::{Border, boundaries, of_sections, of_surface};
use maquette_geometry::curve::closest;
use maquette_geometry::surface::analytic::Side;
use maquette_graph::{AtPort, Choices, NodeKind, Unit};

use crate::wire;

#[derive(Clone, Copy, PartialEq)]
enum Which {
    All,
    First,
    Last,
    Nearest,
    Longest,
}

impl Choices for Which {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::All, "all", "every border, in order"),
        (Self::First, "first", "the first section's; of a mesh the loop found first"),
        (Self::Last, "last", "the last section's; of a mesh the loop found last"),
        (Self::Nearest, "nearest", "the one nearest to the point"),
        (Self::Longest, "longest", "the one with the longest curve"),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "boundary-of",
        1,
        "curve",
        "The borders of a mesh, of a surface or of sections: curves, with the directions in which the surface would go on, \
         so that a detail generator or a blend can continue it smoothly.",
    );
    node.reference("paper 5.2.4 (virtual borders) and 5.2.5");
    let of = node.input::<wire::Shape>(
        "of",
        "A mesh with holes or open ends, a surface (its directions are exact), or sections as a generator gives them.",
    );
    let which = node.choice::<Which>("which", "Which borders.");
    let near = node.vector("near", [0.0; 3], Unit::Length, "The point, where the nearest border is wanted.");
    let points = node.integer("points", 128, 8..=65_536, "Points on each border of a surface.");
    node.soft_range(points, 32.0..=256.0);
    let borders = node.output::<wire::Borders>("borders", "The borders; they can be linked to wherever curves can.");
    let found = node.figure("borders", Unit::None, "How many borders there are.");
    node.evaluate(move |ports| {
        let all = match ports.read(of) {
            wire::Shape::Mesh(mesh) => boundaries(&mesh.0).at(of),
            wire::Shape::Surface(surface) => of_any_surface(surface, ports.count(points)).at(of),
            wire::Shape::Sections(sections) => of_both_ends(&sections.0).at(of),
        }?;
        if all.is_empty() {
            let message = "there is no border: it is closed. Cut it with cut-with-plane or cut-with-curve";
            return Err(message).at(of);
        }
        #[expect(clippy::cast_precision_loss, reason = "small")]
        ports.figure(found, all.len() as f64);
        let point = DVec3::from_array(ports.read(near).0);
        let length = |border: &Border| maquette_geometry::curve::ArcLength::of(border.curve()).length();
        let away = |border: &Border| closest(border.curve(), point).distance;
        let chosen = match ports.choice(which) {
            Which::All => all,
            Which::First => all.into_iter().take(1).collect(),
            Which::Last => all.into_iter().next_back().into_iter().collect(),
            Which::Nearest => all.into_iter().min_by(|a, b| away(a).total_cmp(&away(b))).into_iter().collect(),
            Which::Longest => all.into_iter().max_by(|a, b| length(a).total_cmp(&length(b))).into_iter().collect(),
        };
        ports.write(borders, wire::Borders(chosen));
        Ok(())
    });
    node
}

/// The borders at the ends of a chain that are not points.
fn of_any_surface(surface: &wire::Surface, points: usize) -> Result<Vec<Border>, String> {
    let parts = match surface {
        wire::Surface::Points(sections) => return of_both_ends(sections),
        wire::Surface::Series(parts) => parts,
    };
    let (Some(first), Some(last)) = (parts.first(), parts.last()) else { return Ok(Vec::new()) };
    let mut found = Vec::new();
    for (part, side, name) in [(first, Side::Start, "first section"), (last, Side::End, "last section")] {
        let index = if side == Side::Start { 0 } else { part.section_parameters().len() - 1 };
        if !part.is_pole(index) {
            found.push(of_surface(part, side, name, points).map_err(|error| error.to_string())?);
        }
    }
    Ok(found)
}

fn of_both_ends(sections: &maquette_geometry::sections::Sections) -> Result<Vec<Border>, String> {
    let mut found = Vec::new();
    for (index, side, name) in [(0, Side::Start, "first section"), (sections.len() - 1, Side::End, "last section")] {
        if !sections.is_pole(index) {
            found.push(of_sections(sections, side, name).map_err(|error| error.to_string())?);
        }
    }
    Ok(found)
}
