//! **Select by name**: the vertices of the faces of a group or material.

use maquette_geometry::mesh::NamedBy;
use maquette_geometry::mesh::select::by_name;
use maquette_graph::{AtPort, Choices, NodeError, NodeKind};

use crate::selecting::SelectionOutput;
use crate::wire;

#[derive(Clone, Copy, PartialEq, Eq)]
enum By {
    Group,
    Material,
}

impl Choices for By {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Group, "group", "Groups: those of an OBJ; objects and nodes that `import-mesh` joins."),
        (Self::Material, "material", "Materials, as glTF and OBJ name them."),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "select-by-name",
        1,
        "select",
        "Selects the vertices of the faces that an imported file has under one name: a group or a material.",
    );
    let mesh = node.input::<wire::Mesh>("mesh", "The mesh.");
    let by = node.choice::<By>("by", "What faces are named by.");
    let name = node.text("name", "", "The name, as the file has it.");
    let output = SelectionOutput::declare(&mut node);
    node.evaluate(move |ports| {
        let body = &ports.read(mesh).0;
        let by = match ports.choice(by) {
            By::Group => NamedBy::Group,
            By::Material => NamedBy::Material,
        };
        let wanted = ports.read(name);
        let found = by_name(body, by, wanted, &ports.progress_callback()).at(name)?;
        let Some(weights) = found else { return Err(NodeError::Cancelled) };
        let mesh_hash = ports.content_hash(mesh);
        let selection = wire::Selection { weights: weights.into(), mesh: body.clone(), mesh_hash };
        output.write(ports, selection, "take a name whose faces this mesh still has");
        Ok(())
    });
    node
}
