//! **Cut with plane**: the parts of a mesh on both sides of a plane.
//! Reference: paper 5.2.5 (boundaries from a plane cut).

use glam::DVec3;
use maquette_geometry::border::{Border, boundaries};
use maquette_geometry::mesh::cut::cut_with_plane;
use maquette_geometry::mesh::slice::Plane;
use maquette_graph::{AtPort, NodeKind, Unit};

use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "cut-with-plane",
        2,
        "mesh",
        "Cuts a mesh in two along a plane. The parts are open there; `caps` closes them, `blend` joins them to others.",
    );
    node.reference("paper 5.2.5");
    let mesh = node.input::<wire::Mesh>("mesh", "The mesh to cut.");
    let origin = node.vector("origin", [0.0; 3], Unit::Length, "A point of the plane.");
    let normal = node.vector("normal", [0.0, 1.0, 0.0], Unit::None, "Across the plane; any length but zero.");
    let front = node.output::<wire::Mesh>("front", "The part to which the normal points.");
    let back = node.output::<wire::Mesh>("back", "The other part.");
    let front_borders =
        node.output::<wire::Borders>("front-borders", "Where the front part was cut, ready for `blend`.");
    let back_borders = node.output::<wire::Borders>("back-borders", "Where the other part was cut.");
    node.evaluate(move |ports| {
        let body = &ports.read(mesh).0;
        let vector = |input: maquette_graph::Input<maquette_graph::Vector>| DVec3::from_array(ports.read(input).0);
        let plane = Plane::new(vector(origin), vector(normal)).at(normal)?;
        let turned = Plane::new(plane.origin(), -plane.normal()).at(normal)?;
        let size = maquette_geometry::mesh::measure::diagonal(body);
        let in_plane = |border: &Border| border.curve().points().iter().all(|p| plane.height(*p).abs() <= 1e-6 * size);
        let mut parts = Vec::with_capacity(2);
        for side in [plane, turned] {
            let part = cut_with_plane(body, &side).at(mesh)?;
            let borders: Vec<Border> = boundaries(&part).at(mesh)?.into_iter().filter(in_plane).collect();
            parts.push((part, borders));
        }
        if parts.iter().all(|(_, borders)| borders.is_empty()) {
            ports.warn("the plane does not cut the mesh: move its origin");
        }
        for ((part, borders), (mesh, of_part)) in parts.into_iter().zip([(front, front_borders), (back, back_borders)])
        {
            ports.write(mesh, wire::Mesh::new(part));
            ports.write(of_part, wire::Borders(borders));
        }
        Ok(())
    });
    node
}
