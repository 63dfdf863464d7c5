//! Cross-sections as trigonometric series (thesis chapter 3).

mod least_squares;
mod order_search;
mod plane_frame;
mod series;

pub use order_search::{Errors, Found, Tolerances, smallest_harmonics};
pub use plane_frame::PlaneFrame;
pub use series::{Series, SeriesError, basis, harmonics};
