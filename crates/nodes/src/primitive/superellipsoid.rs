//! **Superellipsoid**: between box, ellipsoid and diamond, as a stack of sections.

use glam::DVec3;
use maquette_geometry::primitive::{PrimitiveError, Superellipsoid};
use maquette_graph::{AtPort, NodeKind, Unit};

use super::laid;
use crate::placement::PlacementInputs;
use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "superellipsoid",
        1,
        "primitive",
        "A body between box, ellipsoid and diamond as a stack of sections: to block out a character, and to deform.",
    );
    node.reference("Barr 1981, by height: s(z) = (1 - |z/a3|^(2/e1))^(e1/2)");
    let radii = node.vector(
        "radii",
        [0.1, 0.1, 0.2],
        Unit::Length,
        "Half its size: first and second across the axis (a and b), third along it.",
    );
    let e1 = node.number(
        "e1",
        1.0,
        0.0..=4.0,
        "Exponent of the profile: 0 an open cylinder, below 1 boxy, 1 an ellipse, 2 a diamond, more is pinched.",
    );
    node.soft_range(e1, 0.0..=2.0);
    let e2 = node.number("e2", 1.0, 0.0..=4.0, "Exponent of the sections: 0 a box, 1 an ellipse, 2 a diamond.");
    node.soft_range(e2, 0.0..=2.0);
    let placement = PlacementInputs::declare(&mut node, "The direction in which the sections are stacked.");
    let count = node.integer("sections", 16, 2..=4096, "Sections, evenly along the profile, poles included.");
    node.soft_range(count, 3.0..=64.0);
    let nodes = node.integer(
        "nodes",
        32,
        3..=65_536,
        "Points of each section, at equal angles; a multiple of 4 meets the silhouettes.",
    );
    node.soft_range(nodes, 8.0..=128.0);
    let sections = node.output::<wire::Sections>(
        "sections",
        "The stack, counter-clockwise about the axis; rails at the four silhouettes. Poles are points.",
    );
    node.evaluate(move |ports| {
        let frame = placement.read(ports)?;
        ports.progress(0.0)?;
        let body = match Superellipsoid::new(DVec3::from_array(ports.read(radii).0), ports.value(e1), ports.value(e2)) {
            Err(error @ PrimitiveError::Exponent { what: "e1", .. }) => return Err(error).at(e1),
            Err(error @ PrimitiveError::Exponent { .. }) => return Err(error).at(e2),
            body => body.at(radii)?,
        };
        let made = laid(body.sections(&frame, ports.count(count), ports.count(nodes)), count, nodes, radii)?;
        ports.write(sections, wire::Sections(made));
        Ok(())
    });
    node
}
