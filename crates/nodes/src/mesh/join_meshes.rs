//! **Join meshes**: several meshes become one.

use maquette_geometry::mesh::join_while;
use maquette_graph::{NodeError, NodeKind, OptionalInput};

use crate::mesh::stoppable;
use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node =
        NodeKind::declare("join-meshes", 1, "mesh", "Joins several meshes into one, without welding their vertices.");
    let meshes: Vec<OptionalInput<wire::Mesh>> = ["a", "b", "c", "d", "e", "f", "g", "h"]
        .iter()
        .map(|name| node.optional(name, "A mesh; may be left unconnected."))
        .collect();
    let joined = node.output::<wire::Mesh>("mesh", "All meshes as one: that of a, then that of b, and so on.");
    node.evaluate(move |ports| {
        let connected: Vec<_> = meshes.iter().filter_map(|mesh| ports.read_optional(*mesh)).map(|m| &*m.0).collect();
        if connected.is_empty() {
            return Err(NodeError::new("nothing is connected: link at least one mesh"));
        }
        let made = stoppable(join_while(connected, &ports.progress_callback()))??;
        ports.write(joined, wire::Mesh::new(made));
        Ok(())
    });
    node
}
