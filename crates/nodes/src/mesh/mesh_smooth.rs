//! **Mesh smooth**: takes short waves off a surface without shrinking it.

use maquette_geometry::deform::laplacian::{MeshSmoothError, smooth_mesh};
use maquette_graph::{AtPort, NodeError, NodeKind, Unit};

use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "mesh-smooth",
        1,
        "mesh",
        "Takes waves shorter than a wavelength off a surface, all over or where it is selected; longer ones stay.",
    );
    node.reference("Desbrun, Meyer, Schröder and Barr 1999, Implicit Fairing of Irregular Meshes");
    let mesh = node.input::<wire::Mesh>("mesh", "The mesh.");
    let selection = node.optional::<wire::Selection>(
        "selection",
        "Where it is smoothed; a weight below 1 goes that share of the way. Without, all over.",
    );
    let wave = node.length(
        "wave",
        0.05,
        1e-6..=1e3,
        "Waves of this length are halved; of twice this length they keep 94 %, of half this length 6 %.",
    );
    node.soft_range(wave, 0.005..=0.5);
    let hold = node.boolean("hold-borders", true, "Leave the vertices of open borders where they are.");
    let smooth = node.output::<wire::Mesh>("mesh", "The smoothed mesh, without normals at its corners.");
    let farthest = node.figure("largest-move", Unit::Length, "How far the vertex moves that moves farthest.");
    node.evaluate(move |ports| {
        let progress = ports.progress_callback();
        let chosen = ports.read_optional(selection).map(|selection| &*selection.weights);
        let made = match smooth_mesh(&ports.read(mesh).0, chosen, ports.value(wave), ports.value(hold), &progress) {
            Err(MeshSmoothError::Stopped) => return Err(NodeError::Cancelled),
            Err(error @ MeshSmoothError::WrongSelection { .. }) => Err(error).at(selection),
            Err(error @ MeshSmoothError::Wave { .. }) => Err(error).at(wave),
            made => made.at(mesh),
        }?;
        ports.figure(farthest, made.largest_move);
        ports.write(smooth, wire::Mesh::new(made.mesh));
        Ok(())
    });
    node
}
