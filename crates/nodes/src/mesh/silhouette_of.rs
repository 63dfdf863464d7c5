//! **Silhouette of**: the outline of a mesh in a view.

use glam::DVec3;
use maquette_geometry::mesh::{MeshSilhouetteError, silhouette_of};
use maquette_geometry::view::View;
use maquette_graph::{AtPort, Choices, NodeError, NodeKind, Unit};

use crate::view_plane::ViewPlane;
use crate::wire;

#[derive(Clone, Copy)]
enum ViewChoice {
    Plane(ViewPlane),
    Direction,
}

impl Choices for ViewChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Plane(ViewPlane::Front), "front", "XY plane, seen from the front"),
        (Self::Plane(ViewPlane::Side), "side", "ZY plane, seen from the side"),
        (Self::Plane(ViewPlane::Top), "top", "XZ plane, seen from above"),
        (Self::Direction, "direction", "across the direction given"),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "silhouette-of",
        1,
        "mesh",
        "The outline of a mesh in an orthographic view: closed curves around its shadow.",
    );
    let mesh = node.input::<wire::Mesh>("mesh", "The mesh.");
    let view = node.choice::<ViewChoice>("view", "From where it is seen.");
    let direction =
        node.vector("direction", [1.0, 0.0, 1.0], Unit::None, "Direction of sight, where the view is direction.");
    let offset = node.length("offset", 0.0, -1e4..=1e4, "Where the curves lie along the direction of sight.");
    node.soft_range(offset, -1.0..=1.0);
    let holes = node.boolean("holes", true, "Give the outlines of holes as well, run the other way.");
    let outline =
        node.output::<wire::Curves>("curves", "Outer outlines, the one around the largest area first; then the holes.");
    let area = node.figure("area", Unit::None, "Area of the shadow, square metres, without its holes.");
    let outer = node.figure("outlines", Unit::None, "How many outer outlines there are: parts seen apart.");
    let found = node.figure("holes", Unit::None, "How many holes are seen.");
    node.evaluate(move |ports| {
        let seen = match ports.choice(view) {
            ViewChoice::Plane(plane) => plane.view(),
            ViewChoice::Direction => View::along(DVec3::from_array(ports.read(direction).0))
                .ok_or("the direction has no length: give one other than zero")
                .at(direction)?,
        };
        let progress = ports.progress_callback();
        let made = match silhouette_of(&ports.read(mesh).0, seen, ports.value(offset), &progress) {
            Err(MeshSilhouetteError::Cancelled) => Err(NodeError::Cancelled),
            Err(error @ MeshSilhouetteError::Depth { .. }) => Err(error).at(offset),
            made => made.at(mesh),
        }?;
        let mut curves = made.curves;
        ports.figure(area, made.area);
        #[expect(clippy::cast_precision_loss, reason = "counts of curves")]
        {
            ports.figure(outer, made.outer as f64);
            ports.figure(found, (curves.len() - made.outer) as f64);
        }
        if !ports.value(holes) {
            curves.truncate(made.outer);
        }
        ports.write(outline, wire::Curves(curves));
        Ok(())
    });
    node
}
