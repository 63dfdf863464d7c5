//! A scene in any format that is written: the door to all writers.

use std::path::{Path, PathBuf};

use super::{FileFormat, WriteError, curves_json, gltf_write, obj, ply};
use crate::curve::Curve;
use crate::scene::Scene;

/// Why a scene can't be written in a format.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EncodeError {
    /// The format is read only.
    #[error("SVG is read, not written")]
    ReadOnly,
    /// The scene does not fit the format.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// The files that a scene makes, and what goes into them: one under `path`, and for OBJ a material library beside it. JSON holds
/// the curves of the scene alone.
///
/// # Errors
/// The scene does not fit the format, or the format is not written at all.
pub fn encode(path: &Path, format: FileFormat, scene: &Scene) -> Result<Vec<(PathBuf, Vec<u8>)>, EncodeError> {
    let one = |bytes| vec![(path.to_owned(), bytes)];
    Ok(match format {
        FileFormat::Glb => one(gltf_write::glb(scene)?),
        FileFormat::Gltf => one(gltf_write::gltf(scene)?),
        FileFormat::Ply => one(ply::write(scene)?),
        FileFormat::Obj => {
            let library = path.with_extension("mtl");
            let library_name = library.file_name().map(|n| n.to_string_lossy().into_owned());
            let model = obj::write(scene, library_name.as_deref())?;
            vec![(path.to_owned(), model), (library, obj::material_library_bytes(scene)?)]
        }
        FileFormat::Json => {
            let curves: Vec<Curve> = scene.curves.iter().flat_map(|item| item.curves.iter().cloned()).collect();
            one(curves_json::write(&curves))
        }
        FileFormat::Svg => return Err(EncodeError::ReadOnly),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_obj_brings_its_materials_along_and_svg_is_refused() {
        let scene = crate::file_format::sample::mixed_scene();
        let files = encode(Path::new("a/b.obj"), FileFormat::Obj, &scene).unwrap();
        let names: Vec<_> = files.iter().map(|(path, _)| path.to_string_lossy().into_owned()).collect();
        assert_eq!(names, ["a/b.obj", "a/b.mtl"]);
        assert!(String::from_utf8_lossy(&files[0].1).contains("mtllib b.mtl"));
        assert_eq!(encode(Path::new("a.svg"), FileFormat::Svg, &scene), Err(EncodeError::ReadOnly));
        assert!(encode(Path::new("a.glb"), FileFormat::Glb, &Scene::default()).is_err());
    }
}
