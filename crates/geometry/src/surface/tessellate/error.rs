//! Why surfaces make no mesh.

use crate::mesh::MeshError;
use crate::surface::analytic::{Side, SurfaceError};
use crate::surface::skin::MOST_VERTICES;

/// Why surfaces do not make a mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TessellationError {
    /// An empty list of surfaces.
    #[error("no surface given")]
    NoSurfaces,
    /// Two surfaces of a chain that do not meet.
    #[error(
        "surface {} does not begin where surface {first} ends: they are up to {distance:.2e} m apart at the same angle; \
         make both with the same section", first + 1
    )]
    Apart {
        /// Index of the first, counted from 0.
        first: usize,
        /// Largest distance at equal angles, metres; infinite where one is open and the other closed.
        distance: f64,
    },
    /// No rows, no columns or no quads.
    #[error("a tessellation needs at least 1 row and 1 column of quads")]
    NoQuads,
    /// A wanted deviation that none can have.
    #[error("a deviation of {wanted} m asked for: give a length greater than 0")]
    NoDeviation {
        /// The length given, metres.
        wanted: f64,
    },
    /// A wanted deviation that rounding hides.
    #[error("a deviation of {wanted:e} m is not reached: it is close to the rounding of coordinates; allow more")]
    NotReached {
        /// The length given, metres.
        wanted: f64,
    },
    /// More vertices than [`MOST_VERTICES`].
    #[error(
        "the mesh would have {vertices} vertices, more than {MOST_VERTICES}: ask for fewer quads or more deviation"
    )]
    TooManyVertices {
        /// Vertices it would have.
        vertices: usize,
    },
    /// A cap asked for where the surface does not close around.
    #[error("the {side} of an open surface has no inside to cap: close the sections, or leave it open")]
    CapOnOpenSurface {
        /// Which end.
        side: Side,
    },
    /// A cap asked for on a section that encloses nothing.
    #[error(
        "the section at the {side} encloses no area and can't be capped: widen it, make it a point, or leave it open"
    )]
    CapWithoutArea {
        /// Which end.
        side: Side,
    },
    /// The progress function said to stop.
    #[error("cancelled")]
    Cancelled,
    /// A rounded cap that is no surface.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// The vertices and polygons made no mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}
