//! **Select by mesh**: the vertices that lie on another mesh: a part, a group or a material that is known by itself.

use maquette_geometry::mesh::select::{SelectError, near_mesh};
use maquette_graph::{AtPort, NodeError, NodeKind};

use crate::selecting::SelectionOutput;
use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "select-by-mesh",
        1,
        "select",
        "Selects the vertices of a mesh that lie on another one: a part of it that `import-mesh` takes by name, or what \
         touches it.",
    );
    let mesh = node.input::<wire::Mesh>("mesh", "The mesh.");
    let other = node.input::<wire::Mesh>("other", "The other mesh.");
    let distance = node.length("distance", 1e-5, 0.0..=1e6, "Weight 1 within this distance of its surface.");
    node.soft_range(distance, 0.0..=0.1);
    let falloff =
        node.length("falloff", 0.0, 0.0..=1e6, "Beyond, weights fall to 0 over this distance; 0 ends sharply.");
    node.soft_range(falloff, 0.0..=0.5);
    let output = SelectionOutput::declare(&mut node);
    node.evaluate(move |ports| {
        let (body, part) = (&ports.read(mesh).0, &ports.read(other).0);
        let progress = ports.progress_callback();
        let weights = match near_mesh(body, part, ports.value(distance), ports.value(falloff), &progress) {
            Err(error @ SelectError::NoOther) => Err(error).at(other),
            weights => weights.at(distance),
        }?;
        let Some(weights) = weights else { return Err(NodeError::Cancelled) };
        let mesh_hash = ports.content_hash(mesh);
        let selection = wire::Selection { weights: weights.into(), mesh: body.clone(), mesh_hash };
        output.write(ports, selection, "raise the distance, or bring the other mesh where this one is");
        Ok(())
    });
    node
}
