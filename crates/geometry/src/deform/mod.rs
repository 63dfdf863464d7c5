//! Deforming what generators and primitives made, curves as beams, and any mesh by handles.

mod align;
mod bend;
#[cfg(test)]
mod bend_tests;
mod contour_matching;
mod cross_section;
mod cross_section_error;
#[cfg(test)]
mod cross_section_tests;
mod free_form;
#[cfg(test)]
mod free_form_tests;
pub mod laplacian;
mod silhouette;

pub use align::{AlignError, AlignOptions, Aligned, AxisShape, align_primitive};
pub use bend::{BeamPin, BeamUnits, BendError, Bending, Bent, EndHold, PinGoal, PointLoad, Support, bend};
pub use contour_matching::Matching;
pub use cross_section::{
    Continuity, CrossSectionOptions, Deformed, DeformedByAll, RangeBy, Replaced, deform_by_cross_section,
    deform_by_cross_sections,
};
pub use cross_section_error::CrossSectionError;
pub use free_form::{CurvesError, FollowedCurve, FreeFormDeformed, FreeFormOptions, deform_to_curves};
pub use silhouette::{
    Contact, SectionSpacing, Silhouette, SilhouetteDeformed, SilhouetteDeformer, SilhouetteError, SilhouetteOptions,
    StrokeMatching, StrokesError, ViewFit, deform_to_silhouette,
};
