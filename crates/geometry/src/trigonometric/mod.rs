//! Cross-sections as trigonometric series (thesis chapter 3).

mod series;

pub use series::{Series, SeriesError, basis, harmonics};
