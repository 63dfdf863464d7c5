//! **Draw on surface**: strokes of a view laid onto a mesh.
//! Reference: paper 5.2.4.

use maquette_geometry::mesh::stroke::{StrokeError, draw_on};
use maquette_graph::{AtPort, NodeKind};

use crate::view_plane::{Facing, ViewPlane};
use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "draw-on-surface",
        1,
        "curve",
        "Lays strokes drawn in a view onto a mesh, straight along the view.",
    );
    node.reference("paper 5.2.4");
    let mesh = node.input::<wire::Mesh>("mesh", "The mesh to draw on; `tessellate` makes one of a surface.");
    let strokes = node.input::<wire::Curves>("strokes", "Strokes, in the plane of the view or anywhere.");
    let view = node.choice::<ViewPlane>("view", "The view along which they are laid.");
    let facing = node.choice::<Facing>("facing", "Which side they come to lie on.");
    let spacing = node.length("spacing", 0.005, 0.0..=1e3, "Largest distance of points; 0 keeps those drawn.");
    node.soft_range(spacing, 0.0..=0.05);
    let drawn = node.output::<wire::Curves>("curves", "The strokes on the mesh, in order.");
    node.evaluate(move |ports| {
        let body = &ports.read(mesh).0;
        let direction = ports.choice(view).looks_along();
        let all = &ports.read(strokes).0;
        let mut laid = Vec::with_capacity(all.len());
        for (index, stroke) in all.iter().enumerate() {
            #[expect(clippy::cast_precision_loss, reason = "small")]
            ports.progress(index as f64 / all.len() as f64)?;
            let one = draw_on(body, stroke, direction, ports.choice(facing).0, ports.value(spacing));
            laid.push(match one {
                Err(error @ StrokeError::Empty(_)) => Err(error).at(mesh),
                one => one.at(strokes),
            }?);
        }
        ports.write(drawn, wire::Curves(laid));
        Ok(())
    });
    node
}
