//! **Import mesh**: a mesh from glTF or OBJ.

use glam::DAffine3;
use maquette_geometry::file_format::{FileFormat, ReadError, gltf_read, obj};
use maquette_geometry::mesh::{Mesh, join_while, measure, transform_while};
use maquette_graph::{AtPort, NodeError, NodeKind, Unit};

use crate::mesh::stoppable;
use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare("import-mesh", 1, "input", "A mesh from a glTF or OBJ file; quads stay quads.");
    let file = node.file("file", &["glb", "gltf", "obj"], "The file: .glb, .gltf with embedded data, or .obj.");
    let part = node.text("part", "", "Name of the one mesh to take; empty joins all meshes of the file.");
    let scale = node.length("scale", 1.0, 1e-9..=1e9, "Length of one unit of the file; glTF's is a metre.");
    node.soft_range(scale, 0.001..=1.0);
    let mesh = node.output::<wire::Mesh>("mesh", "The mesh.");
    let size = node.figure("size", Unit::Length, "Diagonal of the box around the mesh: whether the scale is right.");
    let parts = node.table(
        "meshes",
        &[("mesh", Unit::None), ("vertices", Unit::None), ("faces", Unit::None), ("taken", Unit::None)],
        "The meshes of the file.",
    );
    node.reads_file(file);
    node.evaluate(move |ports| {
        let path = ports.path(file)?;
        let bytes = ports.file(file)?;
        let progress = ports.progress_callback();
        let reading = |done: f64| progress(0.8 * done);
        let placing = |done: f64| progress(0.9 + 0.1 * done);
        let meshes = match FileFormat::from_path(&path.to_string_lossy()).at(file)? {
            FileFormat::Glb | FileFormat::Gltf => gltf_read::read_while(&bytes, &reading),
            FileFormat::Obj => obj::read_while(&bytes, &reading),
            other => {
                let message = format!("meshes come from .glb, .gltf or .obj files, not from .{}", other.extension());
                return Err(message).at(file);
            }
        };
        let meshes = match meshes {
            Err(ReadError::Stopped) => return Err(NodeError::Cancelled),
            meshes => meshes.at(file)?,
        };
        let wanted = ports.read(part);
        let taken: Vec<_> = meshes.iter().filter(|m| wanted.is_empty() || m.name() == wanted).collect();
        if taken.is_empty() {
            let known: Vec<_> = meshes.iter().map(|m| format!("\"{}\"", m.name())).collect();
            return Err(format!("the file has no mesh \"{wanted}\"; it has {}", known.join(", "))).at(part);
        }
        let row = |m: &Mesh| {
            let is_taken = wanted.is_empty() || m.name() == wanted;
            vec![m.name().into(), m.positions().len().into(), m.polygon_count().into(), is_taken.into()]
        };
        ports.table(parts, meshes.iter().map(row).collect());
        let name = taken[0].name().to_owned();
        let joined = stoppable(join_while(taken, &|done| progress(0.8 + 0.1 * done)))?.at(file)?;
        let sizing = DAffine3::from_scale(glam::DVec3::splat(ports.value(scale)));
        let scaled = stoppable(transform_while(&joined, &sizing, &placing))?.at(scale)?;
        ports.figure(size, measure::diagonal(&scaled));
        ports.write(mesh, wire::Mesh::new(scaled.named(name)));
        Ok(())
    });
    node
}
