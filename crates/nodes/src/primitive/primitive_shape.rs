//! **Primitive shape**: sphere, cylinder, cone and capsule as stacks of sections.

use maquette_geometry::primitive::{PrimitiveError, RoundPrimitive};
use maquette_graph::{AtPort, Choices, NodeKind, Unit};

use super::laid;
use crate::placement::PlacementInputs;
use crate::wire::{self, EllipticSections, NamedSection};

#[derive(Clone, Copy)]
enum Shape {
    Capsule,
    Sphere,
    Cylinder,
    Cone,
}

impl Choices for Shape {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Capsule, "capsule", "a cylinder between half spheres; `height` is from pole to pole"),
        (Self::Sphere, "sphere", "by `radius` alone"),
        (Self::Cylinder, "cylinder", "open at both ends"),
        (Self::Cone, "cone", "from `radius` to `top-radius`; a point where that is 0"),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "primitive-shape",
        1,
        "primitive",
        "A capsule, sphere, cylinder or cone as a stack of circles: to block out a character, and to deform.",
    );
    let shape = node.choice::<Shape>("shape", "Which one.");
    let radius = node.length("radius", 0.1, 1e-6..=1e4, "Radius; of a cone that of its first section.");
    node.soft_range(radius, 0.01..=1.0);
    let top = node.length("top-radius", 0.0, 0.0..=1e4, "Radius of a cone's last section.");
    node.soft_range(top, 0.0..=1.0);
    let height = node.length("height", 0.5, 1e-6..=1e4, "From end to end along the axis.");
    node.soft_range(height, 0.01..=2.0);
    let placement = PlacementInputs::declare(&mut node, "The direction in which the sections are stacked.");
    let count = node.integer("sections", 16, 2..=4096, "Sections, evenly along the profile, ends and poles included.");
    node.soft_range(count, 3.0..=64.0);
    let nodes = node.integer("nodes", 32, 3..=65_536, "Points of each section; a multiple of 4 meets the silhouettes.");
    node.soft_range(nodes, 8.0..=128.0);
    let sections = node.output::<wire::Sections>(
        "sections",
        "The stack, counter-clockwise about the axis; rails at the four silhouettes. Poles are points.",
    );
    let series = node.output::<EllipticSections>("series", "The same circles, exact with one harmonic each.");
    let perimeter = node.figure("largest-perimeter", Unit::Length, "Length around where it is widest.");
    node.evaluate(move |ports| {
        let frame = placement.read(ports)?;
        let (radius_of, height_of) = (ports.value(radius), ports.value(height));
        let primitive = match ports.choice(shape) {
            Shape::Capsule => RoundPrimitive::Capsule { radius: radius_of, height: height_of },
            Shape::Sphere => RoundPrimitive::Sphere { radius: radius_of },
            Shape::Cylinder => RoundPrimitive::Cylinder { radius: radius_of, height: height_of },
            Shape::Cone => RoundPrimitive::Cone { radius: radius_of, top: ports.value(top), height: height_of },
        };
        ports.progress(0.0)?;
        let made = match primitive.sections(&frame, ports.count(count), ports.count(nodes)) {
            Err(error @ PrimitiveError::CapsuleTooLow { .. }) => return Err(error).at(height),
            made => laid(made, count, nodes, radius)?,
        };
        ports.progress(0.7)?;
        let circles = laid(primitive.series(&frame, ports.count(count)), count, nodes, radius)?;
        ports.figure(perimeter, circles.iter().map(|circle| circle.length()).fold(0.0, f64::max));
        let named = circles.into_iter().enumerate();
        let named = named.map(|(k, section)| NamedSection { name: format!("section {k}"), section, fit: None });
        ports.write(series, EllipticSections::new(named.collect()));
        ports.write(sections, wire::Sections(made));
        Ok(())
    });
    node
}
