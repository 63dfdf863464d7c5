//! **Select by shape**: the vertices inside of a box, a ball, a half-space or a tube around a curve.

use glam::{DQuat, DVec3, EulerRot};
use maquette_geometry::mesh::select::{SelectError, Shape, by_shape};
use maquette_graph::{AtPort, Choices, Input, NodeError, NodeKind, Unit, Vector};

use crate::selecting::SelectionOutput;
use crate::wire;

#[derive(Clone, Copy)]
enum ShapeChoice {
    Box,
    Sphere,
    HalfSpace,
    Capsule,
}

impl Choices for ShapeChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Box, "box", "a box around `centre`: `size`, `rotate`"),
        (Self::Sphere, "sphere", "a ball around `centre`: `radius`"),
        (Self::HalfSpace, "half-space", "all beyond `centre` in the direction `normal`"),
        (Self::Capsule, "capsule", "all within `radius` of `curve`"),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "select-by-shape",
        1,
        "select",
        "Selects the vertices of a mesh inside of a box, a ball, a half-space or a tube around a curve.",
    );
    let mesh = node.input::<wire::Mesh>("mesh", "The mesh.");
    let shape = node.choice::<ShapeChoice>("shape", "The shape.");
    let centre = node.vector("centre", [0.0; 3], Unit::Length, "Its middle; a point of the plane for a half-space.");
    let size = node.vector("size", [1.0; 3], Unit::Length, "Lengths of the box along its own axes.");
    let rotate = node.vector(
        "rotate",
        [0.0; 3],
        Unit::Angle,
        "Turns the box about X, then Y, then Z; counter-clockwise seen from the axis's tip.",
    );
    let normal = node.vector("normal", [0.0, 1.0, 0.0], Unit::None, "Which side of its plane a half-space is.");
    let radius = node.length("radius", 0.5, 0.0..=1e6, "Radius of the ball, or of the tube around the curve.");
    node.soft_range(radius, 0.0..=2.0);
    let curve = node.optional::<wire::Curve>("curve", "The middle of the tube, where the shape is capsule.");
    let falloff = node.length(
        "falloff",
        0.0,
        0.0..=1e6,
        "Outside of the shape weights fall to 0 over this distance; 0 ends it sharply.",
    );
    node.soft_range(falloff, 0.0..=0.5);
    let output = SelectionOutput::declare(&mut node);
    node.evaluate(move |ports| {
        let vector = |input: Input<Vector>| DVec3::from_array(ports.read(input).0);
        let around = vector(centre);
        let made = match ports.choice(shape) {
            ShapeChoice::Box => {
                let half = 0.5 * vector(size);
                if half.min_element() < 0.0 {
                    return Err("a length of the box is below 0: give lengths of 0 or more").at(size);
                }
                let [x, y, z] = vector(rotate).to_array().map(f64::to_radians);
                let rotation = DQuat::from_euler(EulerRot::ZYX, z, y, x);
                Shape::Cuboid { centre: around, half, rotation }
            }
            ShapeChoice::Sphere => Shape::Sphere { centre: around, radius: ports.value(radius) },
            ShapeChoice::HalfSpace => Shape::HalfSpace { point: around, normal: vector(normal) },
            ShapeChoice::Capsule => match ports.read_optional(curve) {
                Some(middle) => Shape::Capsule { curve: &middle.0, radius: ports.value(radius) },
                None => return Err("a tube needs a curve in its middle: link one").at(curve),
            },
        };
        let weights = match by_shape(&ports.read(mesh).0, &made, ports.value(falloff), &ports.progress_callback()) {
            Err(error @ SelectError::NoDirection) => Err(error).at(normal),
            weights => weights.at(shape),
        }?;
        let Some(weights) = weights else { return Err(NodeError::Cancelled) };
        let selection = wire::Selection {
            weights: weights.into(),
            mesh: ports.read(mesh).0.clone(),
            mesh_hash: ports.content_hash(mesh),
        };
        output.write(ports, selection, "move the shape, or make it larger");
        Ok(())
    });
    node
}
