//! **Mirror mesh**: the mirror image of a mesh, with or without the original.

use glam::{DAffine3, DVec3};
use maquette_geometry::mesh::{join_while, transform_while};
use maquette_graph::{AtPort, NodeKind};

use crate::mesh::stoppable;
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
        let progress = ports.progress_callback();
        let image = stoppable(transform_while(original, &reflection, &|done| progress(0.5 * done)))?.at(mesh)?;
        let joining = |done: f64| progress(0.5 + 0.5 * done);
        let result = match ports.value(keep) {
            true => stoppable(join_while([&**original, &image], &joining))?.at(mesh)?,
            false => image,
        };
        ports.write(mirrored, wire::Mesh::new(result.named(original.name())));
        Ok(())
    });
    node
}
