//! **Handle**: vertices of a mesh that move together, and how.
//! Reference: Fu's thesis 2.2, 2.5.

use glam::{DMat3, DVec3};
use maquette_geometry::deform::laplacian::{HandleTransform, Holds};
use maquette_graph::{AtPort, Choices, Input, NodeKind, Unit, Vector};

use crate::wire;

#[derive(Clone, Copy)]
struct HoldsChoice(Holds);

impl Choices for HoldsChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(Holds::Both), "both", "position and direction: what is beside the handle turns and scales with it"),
        (Self(Holds::Position), "position", "position only: the surface turns as it likes"),
        (Self(Holds::Gradient), "gradient", "direction only: the surface turns with the handle, and may be anywhere"),
    ];
}

#[derive(Clone, Copy)]
enum About {
    Centroid,
    Point,
}

impl Choices for About {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] =
        &[(Self::Centroid, "centroid", "the mean of the selected vertices"), (Self::Point, "point", "`pivot`")];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "handle",
        1,
        "deform",
        "Makes selected vertices a handle that is scaled, turned and moved, in this order; chained, several handles.",
    );
    node.reference("Fu 2.2, 2.5");
    let selection = node.input::<wire::Selection>("selection", "The handle's vertices: those with a weight from 0.5.");
    let others = node.optional::<wire::Handles>(
        "others",
        "Handles before this one. Where handles overlap, the last one has the vertices.",
    );
    let holds = node.choice::<HoldsChoice>("holds", "What the handle prescribes.");
    let translate = node.vector("translate", [0.0; 3], Unit::Length, "How far to move along X, Y and Z.");
    let axis = node.vector("axis", [0.0, 1.0, 0.0], Unit::None, "The axis to turn about, of any length but 0.");
    let angle = node.angle(
        "angle",
        0.0,
        -36_000.0..=36_000.0,
        "How far to turn, counter-clockwise seen from the axis's tip. 400 degrees are not 40: the surface winds.",
    );
    node.soft_range(angle, -360.0..=360.0);
    let scale = node.vector("scale", [1.0; 3], Unit::None, "Factors along X, Y and Z before turning; above 0.");
    let about = node.choice::<About>("about", "The point that scaling and turning leave in place.");
    let pivot = node.vector("pivot", [0.0; 3], Unit::Length, "That point, where it is given.");
    let handles = node.output::<wire::Handles>("handles", "The handles before this one, and this one.");
    let selected = node.figure("selected", Unit::None, "Vertices of this handle.");
    let farthest = node.figure("largest-move", Unit::Length, "How far the vertex moves that moves farthest.");
    let table = node.table(
        "pivot",
        &[("x", Unit::Length), ("y", Unit::Length), ("z", Unit::Length)],
        "The point that scaling and turning leave in place.",
    );
    node.evaluate(move |ports| {
        let vector = |input: Input<Vector>| DVec3::from_array(ports.read(input).0);
        let chosen = ports.read(selection);
        let points: Vec<DVec3> = {
            let all = chosen.mesh.positions();
            chosen.weights.vertices().iter().filter_map(|v| all.get(*v as usize)).copied().collect()
        };
        let Some(first) = points.first().copied() else {
            return Err("the handle has no vertex: select at least one with a weight of 0.5 or more").at(selection);
        };
        let centre = match ports.choice(about) {
            // About the first, so that far from the origin no digits are lost.
            #[expect(clippy::cast_precision_loss, reason = "counts below 2^32")]
            About::Centroid => first + points.iter().map(|p| *p - first).sum::<DVec3>() / points.len() as f64,
            About::Point => vector(pivot),
        };
        let degrees = ports.value(angle);
        let along = vector(axis);
        let along = (along / along.abs().max_element()).normalize_or_zero();
        if along == DVec3::ZERO && degrees != 0.0 {
            return Err("the axis has no direction: give numbers that are not all zero").at(axis);
        }
        let factors = vector(scale);
        if factors.min_element() <= 0.0 {
            return Err("a factor is 0 or below, which flattens or mirrors: give factors above 0").at(scale);
        }
        let (rotation, stretch) = (along * degrees.to_radians(), DMat3::from_diagonal(factors));
        let transform = HandleTransform::from_parts(centre, vector(translate), rotation, stretch).at(scale)?;
        let moves = points.iter().map(|p| p.distance(transform.apply(*p))).fold(0.0, f64::max);
        ports.table(table, vec![vec![centre.x.into(), centre.y.into(), centre.z.into()]]);
        #[expect(clippy::cast_precision_loss, reason = "counts below 2^32")]
        ports.figure(selected, points.len() as f64);
        ports.figure(farthest, moves);
        let mut all = ports.read_optional(others).cloned().unwrap_or_default();
        let held = wire::HeldSelection { selection: chosen.clone(), holds: ports.choice(holds).0 };
        all.0.push(wire::Handle { held, transform });
        ports.write(handles, all);
        Ok(())
    });
    node
}
