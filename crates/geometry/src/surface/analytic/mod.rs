//! Surfaces through sections that are trigonometric series (thesis chapter 4): exact at every point, stored in a few
//! hundred numbers.

mod angles;
mod blend;
mod chain;
mod crossing;
mod differential;
mod ends;
mod error;
mod fewer;
mod numbers;
mod options;
mod solve;
mod surface;
#[cfg(test)]
mod tests;

pub(crate) use angles::{Angles, Piece};
pub(crate) use ends::{EndCurves, largest_distance, size};
pub(crate) use surface::mean;

pub use blend::{Blend, MOST_FOR_POLYNOMIAL, MOST_OF_POLYNOMIAL};
pub use chain::{ChainOrderError, chain, chain_order};
pub use differential::SurfacePoint;
pub use error::{Side, SurfaceError, SurfaceWarning};
pub use numbers::NoSurface;
pub use options::{Continuity, EndCondition, SurfaceOptions};
pub use surface::AnalyticSurface;
