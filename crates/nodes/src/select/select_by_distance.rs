//! **Select by distance**: the vertices within a distance along the surface.

use glam::DVec3;
use maquette_geometry::mesh::select::{SelectError, geodesic};
use maquette_graph::{AtPort, NodeError, NodeKind, Unit};

use crate::selecting::SelectionOutput;
use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "select-by-distance",
        1,
        "select",
        "Selects the vertices of a mesh within a distance of a point or a curve, measured along the surface.",
    );
    node.reference("Novotni and Klein 2002, Computing Geodesic Distances on Triangular Meshes");
    let mesh = node.input::<wire::Mesh>("mesh", "The mesh.");
    let point =
        node.vector("point", [0.0; 3], Unit::Length, "The place of the surface nearest to it is measured from.");
    let curve = node.optional::<wire::Curves>("curves", "Curves whose points are measured from instead of `point`.");
    let distance = node.length("distance", 0.1, 0.0..=1e6, "Weight 1 within this distance.");
    node.soft_range(distance, 0.0..=1.0);
    let falloff =
        node.length("falloff", 0.0, 0.0..=1e6, "Beyond, weights fall to 0 over this distance; 0 ends sharply.");
    node.soft_range(falloff, 0.0..=0.5);
    let output = SelectionOutput::declare(&mut node);
    node.evaluate(move |ports| {
        let body = &ports.read(mesh).0;
        let from: Vec<DVec3> = match ports.read_optional(curve) {
            Some(curves) => curves.0.iter().flat_map(|curve| curve.points()).copied().collect(),
            None => vec![DVec3::from_array(ports.read(point).0)],
        };
        let weights =
            match geodesic(body, &from, ports.value(distance), ports.value(falloff), &ports.progress_callback()) {
                Err(error @ SelectError::NoPolygons) => Err(error).at(mesh),
                Err(error @ SelectError::NoPoint) => Err(error).at(curve),
                weights => weights.at(distance),
            }?;
        let Some(weights) = weights else { return Err(NodeError::Cancelled) };
        let mesh_hash = ports.content_hash(mesh);
        let selection = wire::Selection { weights: weights.into(), mesh: body.clone(), mesh_hash };
        output.write(ports, selection, "raise the distance");
        Ok(())
    });
    node
}
