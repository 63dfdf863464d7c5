//! **Mesh out**: a mesh as a result of the graph, under the name of the node.

use maquette_geometry::scene::Material;
use maquette_graph::NodeKind;

use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare("mesh-out", 1, "output", "A mesh as a result of the graph, named like this node.");
    node.is_result();
    let mesh = node.input::<wire::Mesh>("mesh", "The mesh.");
    let clay = Material::default();
    let colour = node.colour("colour", clay.colour, "Base colour; sRGB with alpha.");
    let metallic = node.number("metallic", clay.metallic, 0.0..=1.0, "0 for cloth, skin, plaster; 1 for bare metal.");
    let roughness = node.number("roughness", clay.roughness, 0.0..=1.0, "0 for a mirror, 1 for chalk.");
    let double_sided =
        node.boolean("double-sided", false, "Draw back faces too: wanted where one looks into an open surface.");
    let result = node.output::<wire::MeshResult>("result", "The mesh with its material.");
    node.evaluate(move |ports| {
        let material = Material {
            name: String::new(),
            colour: ports.read(colour).0,
            metallic: ports.value(metallic),
            roughness: ports.value(roughness),
            double_sided: ports.value(double_sided),
        };
        let mesh_hash = ports.content_hash(mesh);
        let mesh = ports.read(mesh).0.clone();
        ports.write(result, wire::MeshResult { mesh, mesh_hash, material });
        Ok(())
    });
    node
}
