//! Results as files: whole or not at all.

use std::io::Write as _;
use std::path::Path;

use maquette_geometry::curve::Curve;
use maquette_geometry::file_format::{FileFormat, curves_json, gltf_write, obj, ply};
use maquette_geometry::scene::Scene;

/// The format that a file's extension asks for.
pub(super) fn format(path: &Path) -> Result<FileFormat, String> {
    match FileFormat::from_path(&path.to_string_lossy()) {
        Ok(FileFormat::Svg) => {
            Err(format!("{}: SVG is read, not written: choose .glb, .gltf, .obj, .ply or .json", path.display()))
        }
        Ok(format) => Ok(format),
        Err(error) => Err(error.to_string()),
    }
}

/// Writes a scene in the format of the file's extension; returns the bytes written.
pub(super) fn scene(path: &Path, format: FileFormat, scene: &Scene) -> Result<usize, String> {
    let fail = |error: String| format!("{}: {error}", path.display());
    let bytes = match format {
        FileFormat::Glb => gltf_write::glb(scene).map_err(|e| fail(e.to_string()))?,
        FileFormat::Gltf => gltf_write::gltf(scene).map_err(|e| fail(e.to_string()))?,
        FileFormat::Ply => ply::write(scene).map_err(|e| fail(e.to_string()))?,
        FileFormat::Obj => {
            let library = path.with_extension("mtl");
            let library_name = library.file_name().map(|n| n.to_string_lossy().into_owned());
            let materials = obj::material_library_bytes(scene).map_err(|e| fail(e.to_string()))?;
            whole(&library, &materials)?;
            obj::write(scene, library_name.as_deref()).map_err(|e| fail(e.to_string()))?
        }
        FileFormat::Json => {
            let curves: Vec<Curve> = scene.curves.iter().flat_map(|item| item.curves.iter().cloned()).collect();
            if curves.is_empty() {
                return Err(fail("there are no curves for a .json file: add a curves-out node".to_owned()));
            }
            curves_json::write(&curves)
        }
        FileFormat::Svg => return Err(fail("SVG is read, not written".to_owned())),
    };
    whole(path, &bytes).map(|()| bytes.len())
}

/// Replaces a file that is there: what a link leads to, with the permissions it has. A file that is protected against
/// writing is left as it is.
pub(super) fn replaced(path: &Path, bytes: &[u8]) -> Result<(), String> {
    let fail = |error: std::io::Error| format!("{}: it can't be written: {error}", path.display());
    let real = path.canonicalize().map_err(fail)?;
    let permissions = std::fs::metadata(&real).map_err(fail)?.permissions();
    if permissions.readonly() {
        return Err(format!("{}: it can't be written: it is protected against writing", path.display()));
    }
    put(&real, bytes, Some(permissions))
}

/// Writes a file beside, then puts it in place, so that nobody ever sees half of it.
pub(super) fn whole(path: &Path, bytes: &[u8]) -> Result<(), String> {
    put(path, bytes, None)
}

fn put(path: &Path, bytes: &[u8], permissions: Option<std::fs::Permissions>) -> Result<(), String> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let attempt = move || -> std::io::Result<()> {
        let mut file = tempfile::Builder::new().prefix(".maquette-").tempfile_in(folder)?;
        file.write_all(bytes)?;
        file.as_file().sync_all()?;
        match permissions {
            Some(permissions) => file.as_file().set_permissions(permissions)?,
            None => readable_by_all(file.as_file())?,
        }
        file.persist(path)?;
        Ok(())
    };
    attempt().map_err(|error| {
        let hint = if folder.is_dir() { "" } else { "; the folder does not exist: create it first" };
        format!("{}: it can't be written: {error}{hint}", path.display())
    })
}

/// A temporary file is private; a result is an ordinary file.
#[cfg(unix)]
fn readable_by_all(file: &std::fs::File) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt as _;
    file.set_permissions(std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn readable_by_all(_: &std::fs::File) -> std::io::Result<()> {
    Ok(())
}
