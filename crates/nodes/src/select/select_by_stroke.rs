//! **Select by stroke**: the vertices inside of a lasso drawn in a view.

use maquette_geometry::mesh::select::{SelectError, by_lasso};
use maquette_graph::{AtPort, NodeError, NodeKind};

use crate::selecting::SelectionOutput;
use crate::view_plane::ViewPlane;
use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "select-by-stroke",
        1,
        "select",
        "Selects the vertices of a mesh inside of strokes drawn around them in a view.",
    );
    let mesh = node.input::<wire::Mesh>("mesh", "The mesh.");
    let strokes = node.input::<wire::Curves>("strokes", "Strokes around what is selected; open ones are closed.");
    let view = node.choice::<ViewPlane>("view", "The view in which they are drawn.");
    let through =
        node.boolean("through", false, "Select all that lies behind one another; otherwise only what is seen.");
    let output = SelectionOutput::declare(&mut node);
    node.evaluate(move |ports| {
        let progress = ports.progress_callback();
        let (body, direction) = (&ports.read(mesh).0, ports.choice(view).looks_along());
        let weights = match by_lasso(body, &ports.read(strokes).0, direction, ports.value(through), &progress) {
            Err(error @ SelectError::NoPolygons) => Err(error).at(mesh),
            weights => weights.at(strokes),
        }?;
        let Some(weights) = weights else { return Err(NodeError::Cancelled) };
        let mesh_hash = ports.content_hash(mesh);
        let selection = wire::Selection { weights: weights.into(), mesh: body.clone(), mesh_hash };
        output.write(ports, selection, "draw around vertices of it, choose the other view, or select `through`");
        Ok(())
    });
    node
}
