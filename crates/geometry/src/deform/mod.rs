//! Deforming what generators made, and any mesh by handles.

mod contour_matching;
mod cross_section;
mod cross_section_error;
#[cfg(test)]
mod cross_section_tests;
pub mod laplacian;

pub use contour_matching::Matching;
pub use cross_section::{Continuity, CrossSectionOptions, Deformed, deform_by_cross_section};
pub use cross_section_error::CrossSectionError;
