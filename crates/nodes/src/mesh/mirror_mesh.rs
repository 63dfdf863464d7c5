//! **Mirror mesh**: the mirror image of a mesh, with or without the original.

use glam::{DAffine3, DVec3};
use maquette_geometry::mesh::{join, transform};
use maquette_graph::{AtPort, NodeKind};

use crate::view_plane::MirrorPlane;
use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare("mirror-mesh", 1, "mesh", "Mirrors a mesh across a plane; normals stay outward.");
    let mesh = node.input::<wire::Mesh>("mesh", "Mesh to mirror.");
    let axis = node.choice::<MirrorPlane>("axis", "The axis that is turned around.");
    let offset = node.length("offset", 0.0, -1e4..=1e4, "Place of the mirror along that axis.");
    node.soft_range(offset, -1.0..=1.0);
    let keep = node.boolean("keep", false, "Keep the original as well; the two are not welded.");
    let mirrored = node.output::<wire::Mesh>("mesh", "The mirrored mesh.");
    node.evaluate(move |ports| {
        let (axis, offset) = (ports.choice(axis), ports.value(offset));
        let original = &ports.read(mesh).0;
        let reflection =
            DAffine3 { translation: axis.reflect(DVec3::ZERO, offset), ..DAffine3::from_scale(axis.signs()) };
        let image = transform(original, &reflection).at(mesh)?;
        let result = if ports.value(keep) { join([original, &image]).at(mesh)? } else { image };
        ports.write(mirrored, wire::Mesh::new(result.named(original.name())));
        Ok(())
    });
    node
}
