//! Cross-sections as trigonometric series (thesis chapter 3).

mod least_squares;
mod measure;
mod order_search;
mod plane_frame;
mod section;
mod series;

pub use measure::NearestPoint;
pub use order_search::{Errors, Found, Tolerances, smallest_harmonics};
pub use plane_frame::PlaneFrame;
pub use section::{EllipticSection, EllipticSegment, SectionError};
pub use series::{Series, SeriesError, basis, harmonics};
