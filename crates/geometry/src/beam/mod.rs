//! The beam under tension: `k_b d'''' - k_s d'' = f` (thesis 5.5) along a curve, by finite differences.
//!
//! `d` is a position or a displacement, component by component; `u` runs over [0, 1] along the whole curve, so that
//! tangents are `dP/du` and not unit vectors. A closed curve of `n` nodes has `h = 1/n`, an open one `h = 1/(n - 1)`.
//! `f` is the force of the differential equation: positive `f` pushes towards positive `d`. Every solver factors
//! once, for its nodes, pins and stiffness, and then solves for any values in O(n). The scheme (thesis 5.8, with the
//! right side `h^4 f`) is of second order in `h`; its linear system is solved to round-off for any permitted size.
//!
//! [`ClosedBeam`] and [`OpenBeam`] stand on one system of equations: pins, and ends that are clamped, natural or free.
//! [`OpenCardinals`] are the functions of which all their curves are sums; [`TensionSpline`] is the exact solution.
//! [`theory`] says how real beams bend, to measure the equation against.

mod banded;
mod cardinals;
mod closed;
pub mod closed_form;
#[cfg(test)]
mod difference_tests;
mod error;
mod open;
mod quantity;
mod stiffness;
mod system;
mod tension_spline;
pub mod theory;

pub(crate) use banded::BandedFactor;
pub use cardinals::OpenCardinals;
pub use closed::ClosedBeam;
pub use error::BeamError;
pub use open::{EndCondition, EndReaction, OpenBeam, OpenValues, sculpting_forces};
pub use quantity::Quantity;
pub use stiffness::{Stiffness, StiffnessError};
pub use tension_spline::{SplineEnd, TensionSpline};

/// Most nodes of a beam: beyond it the difference equations lose their digits faster than refinement restores them.
pub const MOST_NODES: usize = 8192;
