//! **Mesh out**: a mesh as a result of the graph, under the name of the node.

use maquette_geometry::mesh::{MeshCheck, check_while};
use maquette_geometry::scene::Material;
use maquette_graph::{FigureHandle, NodeError, NodeKind, Unit};

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
    declare_check(&mut node, result);
    node
}

type Measured = (FigureHandle, fn(&MeshCheck) -> f64);

/// What is wrong with the mesh. Looking costs about as much as making it, so that it is done on request only.
fn declare_check(node: &mut NodeKind, result: maquette_graph::Output<wire::MeshResult>) {
    let mut count = |name: &str, description: &str| node.figure(name, Unit::None, description);
    #[expect(clippy::cast_precision_loss, reason = "counts below 2^32")]
    let counts: [Measured; 10] = [
        (count("vertices", "Vertices of the mesh."), |m| m.vertices as f64),
        (count("faces", "Faces of the mesh."), |m| m.polygons as f64),
        (count("shells", "Parts that do not hang together by edges."), |m| m.shells as f64),
        (count("holes", "Loops of edges with one face: 0 where the mesh is closed."), |m| m.boundary_loops as f64),
        (count("non-manifold-edges", "Edges of more than two faces."), |m| m.non_manifold_edges.len() as f64),
        (count("inverted-edges", "Edges at which one face looks in and the other out."), |m| {
            m.inconsistent_edges.len() as f64
        }),
        (count("degenerate-faces", "Faces that repeat a vertex or have no area."), |m| {
            m.degenerate_polygons.len() as f64
        }),
        (count("folded-faces", "Faces that cross themselves or are turned over."), |m| m.folded_polygons.len() as f64),
        (count("inward-shells", "Parts that are turned inside out."), |m| m.inward_shells.len() as f64),
        (count("unused-vertices", "Vertices of no face."), |m| m.unused_vertices.len() as f64),
    ];
    let faults = count(
        "faults",
        "All that keeps the mesh from being sound: the faults above, a body inside out, normals against their faces.",
    );
    let fold = node.figure("largest-fold", Unit::Angle, "Largest angle between the normals of two faces at an edge.");
    node.examine(move |seen| {
        let Some(found) = check_while(&seen.read(result).mesh, &seen.progress_callback()) else {
            return Err(NodeError::Cancelled);
        };
        seen.note(&found);
        for (figure, measure) in counts {
            seen.figure(figure, measure(&found));
        }
        #[expect(clippy::cast_precision_loss, reason = "counts below 2^32")]
        seen.figure(faults, found.fault_count() as f64);
        seen.figure(fold, found.largest_fold_degrees);
        if !found.is_sound() {
            seen.warn(format!("the mesh is not sound: {found}. Look at what makes it with render --wireframe"));
        }
        Ok(())
    });
}
