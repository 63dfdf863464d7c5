//! Results as files: whole or not at all.

use std::path::{Path, PathBuf};

use maquette_geometry::file_format::{EncodeError, FileFormat, encode};
use maquette_geometry::scene::Scene;
use maquette_graph::{WireType, file};
use maquette_nodes::wire;

/// The format that a file's extension asks for.
pub(super) fn format(path: &Path) -> Result<FileFormat, String> {
    match FileFormat::from_path(&path.to_string_lossy()) {
        Ok(FileFormat::Svg) => {
            Err(format!("{}: SVG is read, not written: choose .glb, .gltf, .obj, .ply or .json", path.display()))
        }
        Ok(format) => Ok(format),
        Err(_) => Err(format!("{}: write .glb, .gltf, .obj, .ply or .json", path.display())),
    }
}

/// Says why results of these types can't be written to these files.
pub(super) fn suits(files: &[(&Path, FileFormat)], types: &[WireType]) -> Result<(), Vec<String>> {
    let meshes = types.contains(&WireType::of::<wire::MeshResult>());
    let curves = types.contains(&WireType::of::<wire::CurvesResult>());
    let wrong: Vec<String> = files
        .iter()
        .filter_map(|(path, format)| match format {
            FileFormat::Ply if !meshes => Some((path, "a .ply file holds a mesh", "mesh-out")),
            FileFormat::Json if !curves => Some((path, "a .json file holds curves", "curves-out")),
            _ => None,
        })
        .map(|(path, what, node)| {
            format!("error: {}: {what}, and no result asked for is one: add a {node} node", path.display())
        })
        .collect();
    if wrong.is_empty() { Ok(()) } else { Err(wrong) }
}

/// Writes a scene in the format of the file's extension; returns the files written, with their bytes.
pub(super) fn scene(path: &Path, format: FileFormat, scene: &Scene) -> Result<Vec<(PathBuf, usize)>, String> {
    // Everything is made before anything is written.
    let files = encoded(path, format, scene)?.into_iter();
    files.map(|(path, bytes)| whole(&path, &bytes).map(|()| (path, bytes.len()))).collect()
}

/// Makes the folder that a file goes into, where it is not there.
pub(super) fn make_folder_of(path: &Path) -> Result<(), String> {
    let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) else { return Ok(()) };
    std::fs::create_dir_all(folder).map_err(|error| format!("{}: the folder can't be made: {error}", folder.display()))
}

/// The files that a scene makes, and what goes into them.
pub(super) fn encoded(path: &Path, format: FileFormat, scene: &Scene) -> Result<Vec<(PathBuf, Vec<u8>)>, String> {
    let fail = |error: EncodeError| format!("{}: {error}", path.display());
    encode(path, format, scene).map_err(fail)
}

/// Replaces a file that is there. One that is protected against writing is left as it is.
pub(super) fn replaced(path: &Path, bytes: &[u8]) -> Result<(), String> {
    let there = std::fs::metadata(path).map_err(|error| format!("{}: it can't be written: {error}", path.display()))?;
    if there.permissions().readonly() {
        return Err(file::SaveError::Protected(path.to_owned()).to_string());
    }
    whole(path, bytes)
}

/// Writes a file: whole, or not at all.
pub(super) fn whole(path: &Path, bytes: &[u8]) -> Result<(), String> {
    file::write_whole(path, bytes).map_err(|error| error.to_string())
}
