//! **Select nearest**: the part of a mesh, or the loop at which it ends, nearest to a point.

use glam::DVec3;
use maquette_geometry::mesh::select::{SelectError, boundary_loop_nearest, component_nearest};
use maquette_graph::{AtPort, Choices, NodeError, NodeKind, Unit};

use crate::selecting::SelectionOutput;
use crate::wire;

#[derive(Clone, Copy)]
enum What {
    Component,
    BoundaryLoop,
}

impl Choices for What {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Component, "component", "the part that hangs together by edges"),
        (Self::BoundaryLoop, "boundary-loop", "the loop of edges at which the surface ends"),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "select-nearest",
        1,
        "select",
        "Selects the part of a mesh that hangs together, or the loop at which it ends, nearest to a point.",
    );
    let mesh = node.input::<wire::Mesh>("mesh", "The mesh.");
    let what = node.choice::<What>("what", "What is selected.");
    let point = node.vector("point", [0.0; 3], Unit::Length, "The point; the vertex nearest to it decides.");
    let output = SelectionOutput::declare(&mut node);
    node.evaluate(move |ports| {
        let body = &ports.read(mesh).0;
        let near = DVec3::from_array(ports.read(point).0);
        let progress = ports.progress_callback();
        let weights = match ports.choice(what) {
            What::Component => component_nearest(body, near, &progress),
            What::BoundaryLoop => boundary_loop_nearest(body, near, &progress),
        };
        let weights = match weights {
            Err(error @ SelectError::NoPolygons) => Err(error).at(mesh),
            Err(error @ SelectError::NoBoundary) => Err(error).at(what),
            weights => weights.at(point),
        }?;
        let Some(weights) = weights else { return Err(NodeError::Cancelled) };
        let mesh_hash = ports.content_hash(mesh);
        let selection = wire::Selection { weights: weights.into(), mesh: body.clone(), mesh_hash };
        output.write(ports, selection, "give another point");
        Ok(())
    });
    node
}
