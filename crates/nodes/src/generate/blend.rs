//! **Blend**: a smooth transition between the borders of two surfaces.
//! Reference: paper 5.2.5.

use maquette_geometry::border::Border;
use maquette_geometry::generate::{BlendBorder, GenerateError, GenerateOptions, Neighbour, blend};
use maquette_graph::{AtPort, Input, NodeError, NodeKind, Ports};

use crate::stiffness::StiffnessInputs;
use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "blend",
        2,
        "generate",
        "A tube from the border of one surface to that of another that continues both smoothly: a limb into a body.",
    );
    node.reference("paper 5.2.5; beam curves with given tangents, thesis 5.5");
    let start = node.input::<wire::Borders>("start", "One closed border, of `boundary-of` or a cut.");
    let end = node.input::<wire::Borders>("end", "The other closed border.");
    let sections = node.integer("sections", 16, 4..=4096, "Sections from one border to the other.");
    node.soft_range(sections, 8.0..=64.0);
    let nodes = node.integer(
        "nodes",
        64,
        8..=4096,
        "Points of each section. A border of as many points keeps them, and can be welded to the blend.",
    );
    node.soft_range(nodes, 16.0..=256.0);
    let mut strength = |name: &str, of: &str| {
        let description =
            format!("How far it keeps the direction of the {of}: 1 as an arc of a circle, more is fuller.");
        let input = node.number(name, 1.0, 0.01..=BlendBorder::LARGEST_STRENGTH, &description);
        node.soft_range(input, 0.1..=3.0);
        input
    };
    let start_strength = strength("start-strength", "first surface");
    let end_strength = strength("end-strength", "other surface");
    let twist = node.angle(
        "twist",
        0.0,
        -36_000.0..=36_000.0,
        "Turns the end against the start, besides what fits best; by whole points where both borders keep theirs.",
    );
    node.soft_range(twist, -180.0..=180.0);
    let stiffness = StiffnessInputs::declare(&mut node);
    let blended =
        node.output::<wire::Sections>("sections", "Sections from the first border to the other, both included.");
    node.evaluate(move |ports| {
        let options = GenerateOptions {
            stiffness: stiffness.read(ports)?,
            sections: ports.count(sections),
            nodes: ports.count(nodes),
            ..GenerateOptions::default()
        };
        let [one, other] = [only(ports, start)?, only(ports, end)?];
        let ends = [(one, start_strength), (other, end_strength)].map(|(border, strength)| BlendBorder {
            curve: border.curve(),
            neighbour: Neighbour::Directions(border.directions()),
            strength: ports.value(strength),
        });
        let turned = ports.value(twist).to_radians();
        use GenerateError as E;
        let made = match blend(&ends[0], &ends[1], turned, &options, &ports.progress_callback()) {
            Err(E::Cancelled) => Err(NodeError::Cancelled),
            Err(error @ (E::TooFewSections { .. } | E::TooLarge { .. })) => Err(error).at(sections),
            Err(error @ E::TooFewNodes { .. }) => Err(error).at(nodes),
            Err(error @ E::CurveIsOpen { which: "end", .. }) => Err(error).at(end),
            made => made.at(start),
        }?;
        made.notes.iter().for_each(|note| ports.note(note));
        made.warnings.iter().for_each(|warning| ports.warn(warning));
        ports.write(blended, wire::Sections(made.sections));
        Ok(())
    });
    node
}

/// The one border that arrives.
fn only<'a>(ports: &Ports<'a>, input: Input<wire::Borders>) -> Result<&'a Border, NodeError> {
    match ports.read(input).0.as_slice() {
        [border] => Ok(border),
        several => Err(format!(
            "{} borders arrive where one is wanted: choose it with the `which` of a boundary-of node",
            several.len()
        ))
        .at(input),
    }
}
