//! **Ellipse**: a section that is one, exactly.
//! Reference: thesis 3.1.

use maquette_geometry::curve::Curve;
use maquette_geometry::trigonometric::EllipticSection;
use maquette_graph::{AtPort, NodeKind, Unit};

use crate::placement::PlacementInputs;
use crate::wire::{self, EllipticSections, NamedSection};

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "ellipse",
        1,
        "section",
        "A circle or an ellipse as a section: exact with one harmonic, nine constants.",
    );
    node.reference("thesis 3.1");
    let before =
        node.optional::<EllipticSections>("before", "Sections behind which this one is put; none begins a stack.");
    let name = node.text("name", "ellipse", "What the section is called.");
    let a = node.length("radius-a", 0.1, 1e-6..=1e4, "Half its first axis.");
    node.soft_range(a, 0.01..=1.0);
    let b = node.length("radius-b", 0.1, 1e-6..=1e4, "Half its second axis.");
    node.soft_range(b, 0.01..=1.0);
    let placement =
        PlacementInputs::declare(&mut node, "The axis it stands across; it runs counter-clockwise about it.");
    let points = node.integer("points", 64, 3..=65_536, "Points of the curve.");
    node.soft_range(points, 16.0..=256.0);
    let sections = node.output::<EllipticSections>("sections", "The sections before, and the ellipse behind them.");
    let curve = node.output::<wire::Curve>("curve", "The ellipse as a closed curve, begun at the end of radius a.");
    let perimeter = node.figure("perimeter", Unit::Length, "Length around.");
    let area = node.figure("area", Unit::None, "Area enclosed, square metres.");
    node.evaluate(move |ports| {
        let frame = placement.read(ports)?;
        ports.progress(0.0)?;
        let ellipse = EllipticSection::ellipse(frame, [ports.value(a), ports.value(b)]).at(a)?;
        let name = ports.read(name).clone();
        // Where the centre is too far away, its points are one.
        let drawn = Curve::new(name.clone(), ellipse.sampled(ports.count(points)), true).at(a)?;
        ports.figure(perimeter, ellipse.length());
        ports.figure(area, std::f64::consts::PI * ports.value(a) * ports.value(b));
        let mut stack = ports.read_optional(before).map_or_else(Vec::new, |before| before.0.to_vec());
        stack.push(NamedSection { name, section: ellipse, fit: None });
        ports.write(curve, wire::Curve(drawn));
        ports.write(sections, EllipticSections::new(stack));
        Ok(())
    });
    node
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use maquette_graph::Literal;
    use maquette_graph::harness::Harness;

    #[test]
    fn it_stands_across_its_axis_and_behind_what_came_before() {
        let kind = kind();
        let first = Harness::new(&kind).run().unwrap();
        let before = first.value::<EllipticSections>("sections").unwrap().clone();
        let trial = Harness::new(&kind)
            .give("before", before)
            .set("radius-a", Literal::Number(0.3))
            .set("radius-b", Literal::Number(0.2))
            .set("axis", Literal::Choice("x".to_owned()))
            .set("centre", Literal::Vector([1.0, 2.0, 3.0]))
            .set("points", Literal::Integer(4))
            .run()
            .unwrap();
        let stack = trial.value::<EllipticSections>("sections").unwrap();
        assert_eq!((stack.0.len(), stack.constants()), (2, 18));
        let points = trial.value::<wire::Curve>("curve").unwrap().0.points().to_vec();
        let expected = [[1.0, 2.3, 3.0], [1.0, 2.0, 3.2], [1.0, 1.7, 3.0], [1.0, 2.0, 2.8]].map(DVec3::from);
        assert!(points.iter().zip(expected).all(|(p, q)| p.distance(q) < 1e-15), "{points:?}");
    }

    #[test]
    fn tilting_turns_it_about_its_middle() {
        let kind = kind();
        let tilt = Literal::Vector([0.0, 0.0, 90.0]);
        let trial = Harness::new(&kind).set("tilt", tilt).set("points", Literal::Integer(4)).run().unwrap();
        let points = trial.value::<wire::Curve>("curve").unwrap().0.points().to_vec();
        assert!(points[0].distance(DVec3::Y * 0.1) < 1e-15 && points[1].distance(DVec3::NEG_Z * 0.1) < 1e-15);
    }
}
