//! Surfaces through stacks of cross-sections.

mod cap;
pub mod fairness;
mod grid;
mod knots;
mod parts;
mod pole;
pub mod skin;
mod spline;
#[cfg(test)]
mod tests;

pub use fairness::{Ripple, ripple};
pub use knots::UParameter;
pub use pole::PoleShape;
pub use skin::{Cap, SkinError, SkinOptions, skin};
