//! Surfaces through stacks of cross-sections.

pub mod analytic;
mod beside;
mod cap;
pub mod continuity;
pub mod fairness;
mod grid;
mod knots;
pub mod level_of_detail;
mod parts;
mod pole;
pub mod skin;
mod spline;
pub mod tessellate;
#[cfg(test)]
mod tests;

pub use beside::Beside;
pub(crate) use cap::{Lid, NoArea, flat as flat_cap};
pub use fairness::{Ripple, ripple};
pub use knots::UParameter;
pub(crate) use parts::MeshParts;
pub use pole::PoleShape;
pub use skin::{Cap, SkinError, SkinOptions, skin, skin_beside};
