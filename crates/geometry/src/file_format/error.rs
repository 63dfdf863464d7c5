//! What can go wrong between bytes and geometry.

use crate::curve::CurveError;
use crate::mesh::MeshError;

/// Why a scene cannot be written.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WriteError {
    /// A scene without any output.
    #[error("there is nothing to write: the scene has no mesh and no curve; connect an output")]
    NothingToWrite,
    /// A format of meshes, and a scene without one.
    #[error("{format} holds meshes only, and the scene has none: write the curves as .json, .glb or .obj")]
    NoMesh {
        /// The format.
        format: &'static str,
    },
    /// A mesh in which no polygon has three different vertices.
    #[error("mesh \"{name}\" has no polygon with three different vertices: check what makes it, or leave it out")]
    EmptyMesh {
        /// Name of the output.
        name: String,
    },
    /// An output of curves without a curve.
    #[error("curves \"{name}\" hold no curve: check what makes them, or leave them out")]
    NoCurves {
        /// Name of the output.
        name: String,
    },
    /// A number beyond what 32-bit floats reach.
    #[error("\"{name}\", {what} {index}: a coordinate is beyond 3.4e38 and does not fit the file: scale it down")]
    OutOfRange {
        /// Name of the output.
        name: String,
        /// What has the number.
        what: &'static str,
        /// Index of the vertex, corner or point.
        index: usize,
    },
    /// A material with a number that is not finite.
    #[error("the material of \"{name}\" has a {what} that is not a finite number: give it one from 0 to 1")]
    Material {
        /// Name of the output.
        name: String,
        /// Which property.
        what: &'static str,
    },
    /// A name that would break the lines of a text format.
    #[error("the material library's name {name:?} is empty or has a line break: give it a plain file name")]
    LibraryName {
        /// The name.
        name: String,
    },
    /// More data than the format can hold.
    #[error("the scene is too large for {format} ({limit}): write fewer outputs to a file, or lower the resolution")]
    TooLarge {
        /// The format.
        format: &'static str,
        /// What the format holds at most.
        limit: &'static str,
    },
}

/// Why bytes cannot be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ReadError {
    /// `progress` asked to stop.
    #[error("stopped")]
    Stopped,
    /// No bytes at all.
    #[error("the {format} file is empty: export it again")]
    Empty {
        /// The format.
        format: &'static str,
    },
    /// Bytes that break the rules of the format.
    #[error("not a valid {format} file: {place}: {problem}")]
    Malformed {
        /// The format.
        format: &'static str,
        /// Where in the file: a line, an accessor, a contour.
        place: String,
        /// What is wrong, and what is expected.
        problem: String,
    },
    /// Data that lies in another file.
    #[error("buffer {buffer} of the glTF lies in another file, \"{uri}\": export as .glb, which holds everything")]
    ExternalBuffer {
        /// Index of the buffer.
        buffer: usize,
        /// Where the file says it lies.
        uri: String,
    },
    /// Something the format allows and this reader does not understand.
    #[error("the {format} file uses {what}, which is not supported: {remedy}")]
    Unsupported {
        /// The format.
        format: &'static str,
        /// The feature.
        what: String,
        /// What to do about it.
        remedy: &'static str,
    },
    /// A coordinate that is not a number or is infinite.
    #[error("{format}: \"{name}\", {what} {index}: a coordinate is not a finite number")]
    NotFinite {
        /// The format.
        format: &'static str,
        /// Mesh or curve.
        name: String,
        /// What has the coordinate.
        what: &'static str,
        /// Its index, counted from 0.
        index: usize,
    },
    /// A sound file in which there is nothing of the sort that is read.
    #[error("the {format} file holds no {what}: {remedy}")]
    Nothing {
        /// The format.
        format: &'static str,
        /// What was looked for.
        what: &'static str,
        /// What to do about it.
        remedy: &'static str,
    },
    /// A flattening tolerance that cannot be met.
    #[error("a tolerance of {tolerance} px does not work: {problem}")]
    Tolerance {
        /// The tolerance, pixels.
        tolerance: f64,
        /// Why, and what to give instead.
        problem: &'static str,
    },
    /// Points that do not make a curve.
    #[error("{place}: {source}")]
    Curve {
        /// Where in the file.
        place: String,
        /// What is wrong with the points.
        source: CurveError,
    },
    /// Data that does not make a mesh.
    #[error("mesh \"{name}\": {source}")]
    Mesh {
        /// Name of the mesh.
        name: String,
        /// What is wrong with the data.
        source: MeshError,
    },
}
