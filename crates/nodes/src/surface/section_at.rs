//! **Section at**: the section of a surface at any place along it.
//! Reference: thesis 4.1.

use maquette_graph::{AtPort, NodeKind};

use crate::fitting::as_curve;
use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "section-at",
        1,
        "surface",
        "The section of a surface through series, at any place along it.",
    );
    node.reference("thesis 4.1");
    let surface = node.input::<wire::Surface>("surface", "A surface through series, one part or several end to end.");
    let part = node.integer("part", 0, 0..=4096, "Which part, counted from 0.");
    node.soft_range(part, 0.0..=8.0);
    let u = node.number("u", 0.5, 0.0..=1.0, "Where along the part: 0 at its first section, 1 at its last.");
    let count = node.integer("count", 128, 3..=65_536, "Points of the curve, at equal steps of the angle.");
    node.soft_range(count, 8.0..=256.0);
    let section = node.output::<wire::EllipticSections>("section", "The section, exact.");
    let curve = node.output::<wire::Curve>("curve", "The section as a curve.");
    node.evaluate(move |ports| {
        let parts = ports.read(surface).series().at(surface)?;
        let index = ports.count(part);
        let found = match parts.get(index) {
            Some(found) => found,
            None if parts.is_empty() => return Err("the surface has no part").at(surface),
            None => {
                let last = parts.len() - 1;
                return Err(format!("there is no part {index}: the last one is {last}")).at(part);
            }
        };
        let place = ports.value(u);
        let lost = || "the surface swings beyond all numbers there: take the spline, or remove close sections";
        let exact = found.section_at(place).ok_or_else(lost).at(surface)?;
        let name = format!("section at {place}");
        let drawn = as_curve(&name, &exact, ports.count(count)).at(u)?;
        ports.write(curve, wire::Curve(drawn));
        ports.write(section, wire::EllipticSections::new(vec![wire::NamedSection { name, section: exact, fit: None }]));
        Ok(())
    });
    node
}
