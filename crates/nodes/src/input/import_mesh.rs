//! **Import mesh**: a mesh from glTF or OBJ.

use glam::DAffine3;
use maquette_geometry::file_format::{FileFormat, ReadError, gltf_read, obj};
use maquette_geometry::mesh::face_names::polygons_where;
use maquette_geometry::mesh::{FaceNames, Mesh, MeshError, NamedBy, join_while, measure, transform_while};
use maquette_graph::{AtPort, NodeError, NodeKind, Unit};

use crate::mesh::stoppable;
use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "import-mesh",
        2,
        "input",
        "A mesh from a glTF or OBJ file; quads stay quads, and faces keep the names of their groups and materials.",
    );
    let file = node.file("file", &["glb", "gltf", "obj"], "The file: .glb, .gltf with embedded data, or .obj.");
    let part =
        node.text("part", "", "Name of the one mesh to take, or of a group; empty joins all meshes of the file.");
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
        let of_group = if meshes.iter().any(|m| wanted.is_empty() || m.name() == wanted) {
            Vec::new()
        } else {
            group(&meshes, wanted).at(file)?
        };
        let mut taken: Vec<_> = meshes.iter().filter(|m| wanted.is_empty() || m.name() == wanted).collect();
        taken.extend(&of_group);
        if taken.is_empty() {
            return Err(unknown(&meshes, wanted)).at(part);
        }
        let row = |m: &Mesh| {
            let is_taken = wanted.is_empty() || m.name() == wanted;
            vec![m.name().into(), m.positions().len().into(), m.polygon_count().into(), is_taken.into()]
        };
        ports.table(parts, meshes.iter().map(row).collect());
        let name = taken[0].name().to_owned();
        // The parts of what is joined can be told apart: where none has groups, each is one.
        let grouped = taken.iter().any(|m| m.groups().is_some());
        let parted: Vec<Mesh> = if taken.len() > 1 && !grouped {
            taken.iter().map(|m| as_group(m)).collect::<Result<_, _>>().at(file)?
        } else {
            Vec::new()
        };
        let taken = if parted.is_empty() { taken } else { parted.iter().collect() };
        let joined = stoppable(join_while(taken, &|done| progress(0.8 + 0.1 * done)))?.at(file)?;
        let sizing = DAffine3::from_scale(glam::DVec3::splat(ports.value(scale)));
        let scaled = stoppable(transform_while(&joined, &sizing, &placing))?.at(scale)?;
        ports.figure(size, measure::diagonal(&scaled));
        ports.write(mesh, wire::Mesh::new(scaled.named(name)));
        Ok(())
    });
    node
}

/// What each mesh has of a group, where it has some.
fn group(meshes: &[Mesh], wanted: &str) -> Result<Vec<Mesh>, MeshError> {
    let has = |m: &&Mesh| m.groups().is_some_and(|groups| groups.names().iter().any(|name| name == wanted));
    let part = |m: &Mesh| {
        let is_wanted = |polygon: usize| m.groups().is_some_and(|groups| groups.name(polygon) == wanted);
        polygons_where(m, is_wanted).map(|part| part.named(wanted))
    };
    meshes.iter().filter(has).map(part).collect()
}

fn as_group(mesh: &Mesh) -> Result<Mesh, MeshError> {
    let names = FaceNames::new(std::iter::repeat_n(mesh.name(), mesh.polygon_count()));
    mesh.clone().with_names(NamedBy::Group, names)
}

fn unknown(meshes: &[Mesh], wanted: &str) -> String {
    let quoted = |names: Vec<&str>| names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
    let known = quoted(meshes.iter().map(Mesh::name).collect());
    let mut groups: Vec<&str> =
        meshes.iter().filter_map(Mesh::groups).flat_map(FaceNames::names).map(String::as_str).collect();
    groups.retain(|name| !name.is_empty());
    groups.sort_unstable();
    groups.dedup();
    let groups = if groups.is_empty() { String::new() } else { format!(" and the groups {}", quoted(groups)) };
    format!("the file has no mesh \"{wanted}\"; it has {known}{groups}")
}
