//! Primitives as stacks of cross-sections: what a character is blocked out with, and what the primitive deformer takes.
//!
//! All stand on a [`PlaneFrame`](crate::trigonometric::PlaneFrame): its origin is the middle, its normal the direction
//! of the stack, its `e1` where sections begin. Sections run counter-clockwise about the normal. Rails are the four
//! nodes at the silhouettes (along `e1`, `e2`, and against them) where the number of nodes is a multiple of four.

mod error;
mod round;
mod stack;
mod superellipsoid;

pub use error::PrimitiveError;
pub use round::RoundPrimitive;
pub use superellipsoid::Superellipsoid;
