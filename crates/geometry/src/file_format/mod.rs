//! Files as bytes: glTF, OBJ, PLY, SVG and curves as JSON, written from a [`Scene`](crate::scene::Scene) and read into
//! meshes and curves; PNG and JPEG pictures, read into masks whose outlines are traced. Nothing here opens a file.
//!
//! Coordinates are `f64` in memory and `f32` in glTF and PLY; OBJ and JSON keep every digit.

pub mod curves_json;
mod encode;
mod error;
pub mod gltf_read;
pub mod gltf_write;
pub mod obj;
mod output;
mod pace;
pub mod picture;
pub mod ply;
pub mod svg;

#[cfg(test)]
mod sample;

pub use encode::{EncodeError, encode};
pub use error::{ReadError, WriteError};

/// A file format, told by the ending of a file's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FileFormat {
    /// Binary glTF 2.0: [`gltf_write::glb`], [`gltf_read::read`].
    Glb,
    /// glTF 2.0 as JSON with embedded data: [`gltf_write::gltf`], [`gltf_read::read`].
    Gltf,
    /// Wavefront OBJ: [`obj::write`], [`obj::read`].
    Obj,
    /// Binary PLY: [`ply::write`].
    Ply,
    /// Curves as JSON: [`curves_json::write`], [`curves_json::read`].
    Json,
    /// Scalable Vector Graphics: [`svg::read`].
    Svg,
}

/// A file name whose ending is not known.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("\"{path}\" does not end in a known file format: use one of {}", FileFormat::known())]
pub struct UnknownFormat {
    /// The file name or ending as it was given.
    pub path: String,
}

impl FileFormat {
    /// Every format, in the order messages list them.
    pub const ALL: [Self; 6] = [Self::Glb, Self::Gltf, Self::Obj, Self::Ply, Self::Json, Self::Svg];

    /// The format of a file, from the ending of its path; capitals do not matter.
    ///
    /// # Errors
    /// [`UnknownFormat`], listing the known endings, where the name has another ending or none.
    pub fn from_path(path: &str) -> Result<Self, UnknownFormat> {
        let name = path.rsplit(['/', '\\']).next().unwrap_or(path);
        let extension = name.rsplit_once('.').map_or("", |(_, extension)| extension);
        Self::from_extension(extension).map_err(|_| UnknownFormat { path: path.to_owned() })
    }

    /// The format of an ending such as `glb` or `.GLB`.
    ///
    /// # Errors
    /// [`UnknownFormat`], listing the known endings.
    pub fn from_extension(extension: &str) -> Result<Self, UnknownFormat> {
        let wanted = extension.strip_prefix('.').unwrap_or(extension);
        Self::ALL
            .into_iter()
            .find(|format| format.extension().eq_ignore_ascii_case(wanted))
            .ok_or_else(|| UnknownFormat { path: extension.to_owned() })
    }

    /// The ending, in small letters and without a dot.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Glb => "glb",
            Self::Gltf => "gltf",
            Self::Obj => "obj",
            Self::Ply => "ply",
            Self::Json => "json",
            Self::Svg => "svg",
        }
    }

    fn known() -> String {
        Self::ALL.map(|format| format!(".{}", format.extension())).join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_told_by_the_ending_whatever_its_capitals() {
        assert_eq!(FileFormat::from_path("out/hero.GLB"), Ok(FileFormat::Glb));
        assert_eq!(FileFormat::from_path("C:\\work\\a.b\\hero.obj"), Ok(FileFormat::Obj));
        assert_eq!(FileFormat::from_extension(".svg"), Ok(FileFormat::Svg));
        for format in FileFormat::ALL {
            assert_eq!(FileFormat::from_path(&format!("x.{}", format.extension())), Ok(format));
        }
    }

    #[test]
    fn an_unknown_ending_lists_the_known_ones() {
        for path in ["hero.fbx", "hero", "", "dir.obj/hero"] {
            let message = FileFormat::from_path(path).unwrap_err().to_string();
            assert_eq!(
                message,
                format!(
                    "\"{path}\" does not end in a known file format: use one of .glb, .gltf, .obj, .ply, .json, .svg"
                )
            );
        }
    }
}
