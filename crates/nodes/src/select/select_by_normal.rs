//! **Select by normal**: the vertices whose surface faces a direction.

use glam::DVec3;
use maquette_geometry::mesh::select::{SelectError, by_normal};
use maquette_graph::{AtPort, NodeError, NodeKind, Unit};

use crate::selecting::SelectionOutput;
use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "select-by-normal",
        1,
        "select",
        "Selects the vertices of a mesh whose surface faces a direction.",
    );
    let mesh = node.input::<wire::Mesh>("mesh", "The mesh.");
    let direction = node.vector("direction", [0.0, 1.0, 0.0], Unit::None, "The direction.");
    let angle = node.angle("angle", 45.0, 0.0..=180.0, "Largest angle between normal and direction with weight 1.");
    let falloff = node.angle("falloff", 0.0, 0.0..=180.0, "Beyond, weights fall to 0 over this angle; 0 ends sharply.");
    let output = SelectionOutput::declare(&mut node);
    node.evaluate(move |ports| {
        let body = &ports.read(mesh).0;
        let towards = DVec3::from_array(ports.read(direction).0);
        let (within, over) = (ports.value(angle).to_radians(), ports.value(falloff).to_radians());
        let weights = match by_normal(body, towards, within, over, &ports.progress_callback()) {
            Err(error @ SelectError::Negative { .. }) => Err(error).at(angle),
            weights => weights.at(direction),
        }?;
        let Some(weights) = weights else { return Err(NodeError::Cancelled) };
        let mesh_hash = ports.content_hash(mesh);
        let selection = wire::Selection { weights: weights.into(), mesh: body.clone(), mesh_hash };
        output.write(ports, selection, "raise the angle, or turn the direction round");
        Ok(())
    });
    node
}
