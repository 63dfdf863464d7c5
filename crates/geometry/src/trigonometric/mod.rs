//! Cross-sections as trigonometric series (thesis chapter 3): generalized ellipses, and composite generalized elliptic
//! segments.
//!
//! ```
//! use glam::DVec3;
//! use maquette_geometry::curve::Curve;
//! use maquette_geometry::trigonometric::{FitOptions, fit};
//!
//! let angles = (0..80).map(|i| std::f64::consts::TAU * f64::from(i) / 80.0);
//! let egg = angles.map(|t| DVec3::new((2.0 + 0.4 * t.sin()) * t.cos(), 0.0, t.sin())).collect();
//! let fitted = fit(&Curve::new("egg", egg, true)?, &FitOptions::default())?;
//! assert!(fitted.report.met && fitted.section.harmonics() <= 5);
//! println!("{} m around", fitted.section.length());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod comparison;
mod composite;
mod crossing;
mod error;
mod fit;
mod handles;
mod joints;
mod least_squares;
mod measure;
mod options;
mod order_search;
mod plane_frame;
mod refit;
mod report;
mod samples;
mod section;
mod series;
mod solve;
#[cfg(test)]
mod tests;

pub use comparison::Comparison;
pub use error::{FitError, FitWarning};
pub use fit::{fit, fit_sections, fit_sections_while};
pub use handles::{HandlesError, MOST_HANDLES};
pub use measure::NearestPoint;
pub use options::{Angles, Continuity, FitOptions, Harmonics, Joint, LocalAngles, Sampling, Solution, Split, Start};
pub use order_search::{Errors, Found, Tolerances, smallest_harmonics};
pub use plane_frame::PlaneFrame;
pub use refit::{RefitOptions, refit};
pub use report::{FitReport, Fitted, FittedStack, WorstPoint};
pub use section::{EllipticSection, EllipticSegment, SectionError};
pub use series::{Series, SeriesError, basis, harmonics};
