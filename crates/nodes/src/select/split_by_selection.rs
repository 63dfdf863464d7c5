//! **Split by selection**: the selected part of a mesh and the rest: to look at a selection, or to go on with a part.

use maquette_geometry::mesh::select::split;
use maquette_graph::{AtPort, NodeKind};

use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "split-by-selection",
        1,
        "select",
        "Parts a mesh along the border of a selection, where weights pass 0.5: to see what is selected, or to go on \
         with a part.",
    );
    let selection = node.input::<wire::Selection>("selection", "The selection.");
    let mesh = node.optional::<wire::Mesh>(
        "mesh",
        "A mesh with as many vertices in the same order; without, the one on which the selection was made.",
    );
    let selected = node.output::<wire::Mesh>("selected", "The selected part, open along the border.");
    let rest = node.output::<wire::Mesh>("rest", "The rest.");
    node.evaluate(move |ports| {
        let chosen = ports.read(selection);
        let body = ports.read_optional(mesh).map_or(&chosen.mesh, |mesh| &mesh.0);
        let [inside, outside] = match ports.read_optional(mesh) {
            Some(_) => split(body, &chosen.weights).at(mesh)?,
            None => split(body, &chosen.weights).at(selection)?,
        };
        ports.write(selected, wire::Mesh::new(inside));
        ports.write(rest, wire::Mesh::new(outside));
        Ok(())
    });
    node
}
