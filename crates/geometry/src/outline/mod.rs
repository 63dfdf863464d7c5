//! Outlines of a shape in a picture: traced between the pixels, calmed without losing corners, reduced to few points.
//!
//! Coordinates are pixels, +x to the right and +y *up*, from the lower left corner of the picture; a pixel's centre lies
//! half a pixel inside its square.

mod calm;
mod corner;
mod error;
mod mask;
mod trace;

pub use calm::{Calming, calmed};
pub use corner::corners;
pub use error::OutlineError;
pub use mask::{Mask, MaskError};
pub use trace::{Keep, Outline, Tracing, trace, trace_while};
