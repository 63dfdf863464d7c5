//! **Select by name**: the vertices of the faces of a group or material.

use maquette_geometry::mesh::face_names::names_of;
use maquette_geometry::mesh::select::{Selection, by_name};
use maquette_geometry::mesh::{FaceNames, NamedBy};
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
    let name = node.text(
        "name",
        "",
        "The name, as the file has it; without one, nothing is selected, and a warning lists those there are.",
    );
    let output = SelectionOutput::declare(&mut node);
    node.evaluate(move |ports| {
        let body = &ports.read(mesh).0;
        let by = match ports.choice(by) {
            By::Group => NamedBy::Group,
            By::Material => NamedBy::Material,
        };
        let wanted = ports.read(name);
        if wanted.is_empty() {
            // Before a name is given, nothing is selected, and those there are can be read in the warning.
            let known: Vec<String> = names_of(body, by).into_iter().flat_map(FaceNames::names).cloned().collect();
            let known: Vec<_> =
                known.iter().filter(|name| !name.is_empty()).map(|name| format!("\"{name}\"")).collect();
            let weights = Selection::new(vec![0.0; body.positions().len()]).at(mesh)?;
            let remedy = match known.as_slice() {
                [] => "the mesh has no such names: they come with imported meshes".to_owned(),
                known => format!("give one of the names of this mesh: {}", known.join(", ")),
            };
            let mesh_hash = ports.content_hash(mesh);
            let selection = wire::Selection { weights: weights.into(), mesh: body.clone(), mesh_hash };
            output.write(ports, selection, &remedy);
            return Ok(());
        }
        let found = by_name(body, by, wanted, &ports.progress_callback()).at(name)?;
        let Some(weights) = found else { return Err(NodeError::Cancelled) };
        let mesh_hash = ports.content_hash(mesh);
        let selection = wire::Selection { weights: weights.into(), mesh: body.clone(), mesh_hash };
        output.write(ports, selection, "take a name whose faces this mesh still has");
        Ok(())
    });
    node
}
