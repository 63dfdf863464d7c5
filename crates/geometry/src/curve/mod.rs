//! Curves as polylines, and what is done to them: arc length, resampling, simplification, cleaning, ordering into rails.

mod arc_length;
mod clean;
mod closest;
mod correspondence;
mod deviation;
mod polyline;
mod resample;
mod simplify;
mod smoothing;
mod spline;
mod spline_length;
mod spread;

pub use arc_length::ArcLength;
pub use clean::{CleanError, Cleaned, Cleaning, clean, clean_while};
pub use closest::{Closest, closest, farthest};
pub use correspondence::{AxisSource, Decision, SortError, SortOptions, Sorted, sort, sort_while};
pub(crate) use correspondence::{Started, metres, place, start_nearest};
pub use deviation::{Deviation, DeviationError, Gap, deviation};
pub use polyline::{Curve, CurveError};
pub use resample::{Amount, MAX_POINTS, ResampleError, Resampling, resample, resample_while};
pub(crate) use simplify::simplified;
pub use simplify::{SimplifyError, simplify, simplify_while};
pub(crate) use smoothing::{Ends, NotSolvable, smoothed};
pub use smoothing::{SmoothError, smooth};
pub use spline::{CubicSpline, SplineError, chord_parameters, uniform_parameters};
pub use spline_length::SplineLength;
pub use spread::{Spread, spread};
