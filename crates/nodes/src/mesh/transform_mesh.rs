//! **Transform mesh**: moves, turns and scales a mesh.

use maquette_geometry::mesh::transform_while;
use maquette_graph::{AtPort, NodeKind};

use crate::affine::AffineInputs;
use crate::mesh::stoppable;
use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "transform-mesh",
        1,
        "mesh",
        "Scales, turns and moves a mesh, in this order; normals stay outward, also where a factor is negative.",
    );
    let mesh = node.input::<wire::Mesh>("mesh", "Mesh to transform.");
    let affine = AffineInputs::declare(&mut node);
    let transformed = node.output::<wire::Mesh>("mesh", "The transformed mesh.");
    node.evaluate(move |ports| {
        let progress = ports.progress_callback();
        let moved = stoppable(transform_while(&ports.read(mesh).0, &affine.read(ports)?, &progress))?.at(mesh)?;
        ports.write(transformed, wire::Mesh::new(moved));
        Ok(())
    });
    node
}
