//! What can go wrong in a fit.

use super::section::SectionError;
use super::series::SeriesError;
use glam::DVec3;

/// Why a curve cannot be fitted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FitError {
    /// No curve at all.
    #[error("no curve given: give at least one cross-section")]
    NoCurves,
    /// Open and closed curves together.
    #[error("curve \"{curve}\" is {}, and the first one is not: close them all, or none", if *closed { "closed" } else { "open" })]
    Mixed {
        /// Name of the first curve that differs.
        curve: String,
        /// Whether it is closed.
        closed: bool,
    },
    /// A curve so small or so large that its length is not a usable number.
    #[error("curve \"{curve}\" is too small or too large to fit (its box is {size} m across): scale it")]
    Size {
        /// Name of the curve.
        curve: String,
        /// Diagonal of its box, metres.
        size: f64,
    },
    /// A curve so far from the origin that its coordinates hold too few digits of its shape.
    #[error(
        "curve \"{curve}\" is {size} m across and {distance} m from the origin, too far to tell its points apart: move it"
    )]
    FarOut {
        /// Name of the curve.
        curve: String,
        /// Diagonal of its box, metres.
        size: f64,
        /// Largest coordinate, metres.
        distance: f64,
    },
    /// A number of harmonics out of range.
    #[error("{harmonics} harmonics asked for: a series needs 1 to 100")]
    Harmonics {
        /// Harmonics asked for.
        harmonics: usize,
    },
    /// More harmonics than the points can determine.
    #[error(
        "curve \"{curve}\": {harmonics} harmonics have {unknowns} constants, and there are {points} points for them: \
         lower the harmonics to {most}, or sample evenly"
    )]
    TooManyHarmonics {
        /// Name of the curve.
        curve: String,
        /// Harmonics asked for.
        harmonics: usize,
        /// Constants to be found for each coordinate.
        unknowns: usize,
        /// Points there are.
        points: usize,
        /// Most harmonics that can be determined.
        most: usize,
    },
    /// Fewer harmonics than the joints need.
    #[error(
        "segment {segment} has {harmonics} harmonic(s), and the joints at its ends need {needed}: raise the harmonics, \
         or lower the continuity"
    )]
    TooFewHarmonics {
        /// Index of the segment, counted from 0.
        segment: usize,
        /// Its harmonics.
        harmonics: usize,
        /// Harmonics the joints need.
        needed: usize,
    },
    /// A tolerance, distance or corner angle that is not a positive number.
    #[error("{what} of {value} given: it must be a positive number")]
    NotPositive {
        /// What was given.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// Polar angles asked for on an open curve.
    #[error("curve \"{curve}\" is open and has no polar angles: take arc length")]
    PolarOpen {
        /// Name of the curve.
        curve: String,
    },
    /// Polar angles asked for on a curve that is not star-shaped about its centre.
    #[error(
        "curve \"{curve}\" turns back around its centre at {at}, so that two points share a polar angle: take arc length"
    )]
    NotStarShaped {
        /// Name of the curve.
        curve: String,
        /// The point at which the polar angle stops growing, metres.
        at: DVec3,
    },
    /// A joint that is not within the section's range.
    #[error(
        "joint {joint} is at the angle {angle}: an open section is split inside 0 to pi, a closed one at any number"
    )]
    JointOutside {
        /// Index of the joint, counted from 0.
        joint: usize,
        /// Its angle, radians.
        angle: f64,
    },
    /// Two joints at one angle.
    #[error("joints {first} and {second} are both at the angle {angle}: remove one, or move it")]
    JointsCoincide {
        /// Index of the first joint, counted from 0.
        first: usize,
        /// Index of the second.
        second: usize,
        /// Their angle, radians.
        angle: f64,
    },
    /// Too few samples between two joints.
    #[error(
        "curve \"{curve}\" has {points} point(s) between the angles {from} and {to}, and {needed} are needed: move the \
         joints apart, or draw with more points"
    )]
    SegmentTooShort {
        /// Name of the curve.
        curve: String,
        /// First angle, radians.
        from: f64,
        /// Last angle, radians.
        to: f64,
        /// Samples between them.
        points: usize,
        /// Samples needed.
        needed: usize,
    },
    /// Joints that cannot be met together.
    #[error(
        "curve \"{curve}\", segment {segment}: the joints at its ends cannot both be met: move them apart, or raise the harmonics"
    )]
    Contradiction {
        /// Name of the curve.
        curve: String,
        /// Index of the segment, counted from 0.
        segment: usize,
    },
    /// Coefficients that left the range of numbers.
    #[error("curve \"{curve}\" has no finite fit: {source}")]
    NotFinite {
        /// Name of the curve.
        curve: String,
        /// The coefficient at fault.
        source: SeriesError,
    },
    /// Segments that make no section; a mistake of this module if it ever occurs.
    #[error(transparent)]
    Section(#[from] SectionError),
    /// The progress function said to stop.
    #[error("stopped")]
    Stopped,
}

/// What is odd about a curve that was fitted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FitWarning {
    /// A loop that crosses itself.
    #[error(
        "curve \"{curve}\" crosses itself near {at}: the surface will fold there; redraw the loop without crossing"
    )]
    Crossing {
        /// Name of the curve.
        curve: String,
        /// Where it does, metres.
        at: DVec3,
    },
    /// So many harmonics for so few points that the curve may swing between them.
    #[error(
        "curve \"{curve}\": {harmonics} harmonics through {points} points may swing between them: sample evenly, or \
         lower the harmonics to {most}"
    )]
    FewPoints {
        /// Name of the curve.
        curve: String,
        /// Its harmonics.
        harmonics: usize,
        /// Its points.
        points: usize,
        /// Most harmonics for that many points.
        most: usize,
    },
    /// Tolerances that are not met.
    #[error(
        "curve \"{curve}\" is up to {distance} m off at {at} with {harmonics} harmonics: split it into segments, allow \
         more harmonics, or widen the tolerances"
    )]
    NotMet {
        /// Name of the curve.
        curve: String,
        /// Most harmonics of a segment.
        harmonics: usize,
        /// Largest distance, metres.
        distance: f64,
        /// Where, metres.
        at: DVec3,
    },
}
