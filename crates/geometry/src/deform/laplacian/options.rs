//! What is bound, how it is deformed, and what comes of it.

use super::handle::Holds;
use crate::mesh::Mesh;
use crate::mesh::select::Selection;

/// Vertices that move together.
#[derive(Clone, Copy, Debug)]
pub struct Handle<'a> {
    /// Its vertices: those with a weight of 0.5 or more.
    pub selection: &'a Selection,
    /// What is prescribed there.
    pub holds: Holds,
}

/// What the second system keeps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reconstruction {
    /// Laplacian coordinates (2.10, 2.11), by least squares: round bends.
    #[default]
    Coordinates,
    /// Edges, each turned by the mean rotation of its ends (Sorkine and Alexa 2007): lengths are kept better, bends are
    /// pointier, and repeating it lowers one energy.
    Edges,
}

/// How a mesh is bound.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BindOptions {
    /// What the second system keeps.
    pub reconstruction: Reconstruction,
}

/// What binding found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BindReport {
    /// Free vertices.
    pub free: usize,
    /// Vertices that more than one handle selects; the last one has them.
    pub contested: usize,
    /// Degenerate vertices, displaced while gradients are looked for (2.9).
    pub degenerate: usize,
    /// Vertices whose gradient takes in more than one ring.
    pub widened: usize,
    /// Bytes of both factors.
    pub factor_bytes: usize,
    /// Bytes of what is kept of each handle's influence from when one first moves; 0 with more than 16 handles, where each
    /// drag solves anew.
    pub influence_bytes: usize,
}

/// Whether detail keeps its size.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Features {
    /// Kept where all handles are rigid, scaled where one scales.
    #[default]
    Automatic,
    /// Kept (2.10).
    Keep,
    /// Scaled as the first system scales it (2.11).
    Scale,
}

/// How often the second system is solved, each time with the rotations found in the last result.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Passes {
    /// Once, as in the thesis; four times where handles wind, as interpolated rotations know nothing of where they went.
    #[default]
    Once,
    /// Until no vertex moves by more than `tolerance` times the diagonal of the region, or `most` times. Coordinates
    /// ([`Reconstruction::Coordinates`]) between handles that wind are repeated four times at most.
    Converged {
        /// Largest move, as a fraction of the diagonal.
        tolerance: f64,
        /// Largest number of passes.
        most: usize,
    },
}

/// How a bound mesh is deformed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DeformOptions {
    /// Whether detail keeps its size.
    pub features: Features,
    /// How often the second system is solved.
    pub passes: Passes,
}

/// A deformed mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Deformed {
    /// The mesh with its polygons, name, UVs and order of vertices as they were, normals turned along.
    pub mesh: Mesh,
    /// How often the second system was solved.
    pub passes: usize,
    /// Largest move of a vertex in the last pass, as a fraction of the region's diagonal.
    pub last_move: f64,
    /// Whether rotations were interpolated, as handles turn by about 180 degrees or more against each other.
    pub wound: bool,
}
