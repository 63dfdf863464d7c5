//! Curves as polylines, and what is done to them: arc length, resampling, ordering into rails.

mod polyline;

pub use polyline::{Curve, CurveError};
