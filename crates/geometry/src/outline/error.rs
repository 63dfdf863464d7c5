//! Why a picture has no outline.

use crate::curve::{CurveError, SimplifyError, SmoothError};

/// Why outlines cannot be traced.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OutlineError {
    /// It was told to stop.
    #[error("stopped")]
    Stopped,
    /// A threshold that is no share.
    #[error("the threshold {threshold} is not between 0 and 1: 0.5 is half way between outside and inside")]
    Threshold {
        /// The threshold given.
        threshold: f64,
    },
    /// A number that is no area or no length.
    #[error("the {what} {value} is not a number of pixels of at least 0")]
    Amount {
        /// Which number.
        what: &'static str,
        /// The number given.
        value: f64,
    },
    /// Nothing is inside.
    #[error(
        "the picture has no outline: no pixel is inside, the values run from {low:.2} to {high:.2} and the threshold is \
         {threshold}: choose a threshold between them, or another channel"
    )]
    Nothing {
        /// The threshold given.
        threshold: f64,
        /// Smallest value, 0 to 1.
        low: f64,
        /// Largest value, 0 to 1.
        high: f64,
    },
    /// Everything is inside.
    #[error(
        "the picture has no outline: every pixel is inside, the values run from {low:.2} to {high:.2} and the threshold \
         is {threshold}: choose a threshold between them, or another channel"
    )]
    Everything {
        /// The threshold given.
        threshold: f64,
        /// Smallest value, 0 to 1.
        low: f64,
        /// Largest value, 0 to 1.
        high: f64,
    },
    /// Only specks.
    #[error(
        "no outline is as large as the least area: the largest has {largest:.1} square pixels, and {wanted:.1} are asked \
         for: lower the least area, or change the threshold"
    )]
    TooSmall {
        /// Area of the largest one, square pixels.
        largest: f64,
        /// Area asked for, square pixels.
        wanted: f64,
    },
    /// A texture rather than a silhouette.
    #[error(
        "the outlines of the picture would have {points} points, and at most {most} are traced: it is a texture rather \
         than a silhouette; change the threshold, blur the picture or make it smaller"
    )]
    TooRough {
        /// Points there would be.
        points: usize,
        /// Points that are traced.
        most: usize,
    },
    /// A curve that is no outline.
    #[error("curve \"{name}\" is open, and an outline is closed: close it, or use `smooth` and `simplify`")]
    Open {
        /// Name of the curve.
        name: String,
    },
    /// The tracing library refused the grid.
    #[error("the picture cannot be traced: {0}")]
    Library(String),
    /// A calmed outline is no curve.
    #[error(transparent)]
    Smooth(#[from] SmoothError),
    /// A simplified outline is no curve.
    #[error(transparent)]
    Simplify(#[from] SimplifyError),
    /// The points make no curve.
    #[error(transparent)]
    Curve(#[from] CurveError),
}
