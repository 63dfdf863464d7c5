//! Deforming what generators made, and curves as beams.

mod bend;
#[cfg(test)]
mod bend_tests;
mod contour_matching;
mod cross_section;
mod cross_section_error;
#[cfg(test)]
mod cross_section_tests;

pub use bend::{BeamPin, BeamUnits, BendError, Bending, Bent, EndHold, PinGoal, PointLoad, Support, bend};
pub use contour_matching::Matching;
pub use cross_section::{Continuity, CrossSectionOptions, Deformed, deform_by_cross_section};
pub use cross_section_error::CrossSectionError;
