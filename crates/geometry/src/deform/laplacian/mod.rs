//! Editing a mesh by handles, its detail turned along: Fu's implicit Laplacian deformation (H. Fu, Differential Methods
//! for Intuitive 3D Shape Modeling, chapter 2; "the thesis" here and in the modules below).
//!
//! Each vertex has Laplacian coordinates `delta_i = D(v_i)` and a deformation gradient `M_i`, a linear function of the
//! positions around it (2.5). A first linear system looks for positions whose coordinates are `M_i delta_i` and whose
//! gradients agree within two rings (2.8). A polar decomposition takes the shear out of the gradients, and a second
//! system gives the positions whose coordinates are the turned ones (2.10, 2.11). Both are factored by [`Binding::new`]
//! and solved as often as the handles move.
//!
//! Where this departs from the print:
//!
//! - The rows of (2.6), (2.10) and (2.11) are weighted by the square root of the vertex area. As printed, the result
//!   depends on the unit of length.
//! - (2.10) and (2.11) have rows for the handles' vertices next to the region too, with the prescribed gradient, and are
//!   solved by least squares. With rows for free vertices only, a bent bar comes out straight and sheared.
//! - Pairs of (2.7) are unordered, at a distance of one or two edges, with at least one free end, all of weight 1.
//! - Prescribed positions are eliminated and prescribed gradients put in as constants: neither is only approximated.
//! - Boundary vertices with two neighbours, or with all on a line, take in more rings; no vertex is inserted.
//! - A gradient that mirrors gives the rotation with the direction of the smallest singular value flipped.
//! - Convex quads are split along both diagonals, each half as heavy, so that the result neither turns with the axes nor
//!   loses a symmetry.
//! - Beyond the thesis: handles that wind by more than 180 degrees ([`HandleTransform`]), edges instead of coordinates
//!   in the second system ([`Reconstruction::Edges`]), and repeating it until nothing moves ([`Passes`]).

mod anderson;
mod binding;
mod error;
mod handle;
mod implicit;
mod influence;
mod options;
mod patch;
pub mod polar;
mod reconstruct;
mod repeat;
mod rows;
mod smooth;
mod stencil;
#[cfg(test)]
mod tests;
mod well_posed;
mod winding;

pub use binding::Binding;
pub use error::{BindError, DeformError};
pub use handle::{HandleError, HandleTransform, Holds};
pub use options::{BindOptions, BindReport, DeformOptions, Deformed, Features, Handle, Passes, Reconstruction};
pub use smooth::{MeshSmoothError, SmoothedMesh, smooth_mesh};
