//! Why there is no primitive.

use crate::sections::SectionsError;

/// Why numbers make no primitive. Lengths are metres.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PrimitiveError {
    /// A length that is no size.
    #[error("the {what} is {found} m: give a length between 1e-9 and 1e9 m")]
    Size {
        /// Which length.
        what: &'static str,
        /// Its value.
        found: f64,
    },
    /// Both ends of a cone are points.
    #[error("both radii of the cone are 0, which makes a line: give one of them a length")]
    Line,
    /// A capsule lower than its two half spheres.
    #[error("a capsule {height} m high has no room for half spheres of radius {radius} m: make it at least {} m high", 2.0 * radius)]
    CapsuleTooLow {
        /// Height from pole to pole.
        height: f64,
        /// Radius of the half spheres.
        radius: f64,
    },
    /// An exponent that is out of range.
    #[error("the exponent {what} is {found}: give a number from 0 (a box) over 1 (round) to 4 (pinched)")]
    Exponent {
        /// Which exponent.
        what: &'static str,
        /// Its value.
        found: f64,
    },
    /// Too few or too many sections or nodes.
    #[error("{found} {what} asked for: ask for {least} to {most}")]
    Count {
        /// What is counted.
        what: &'static str,
        /// How many were asked for.
        found: usize,
        /// The fewest allowed.
        least: usize,
        /// The most allowed.
        most: usize,
    },
    /// More points than a stack may have.
    #[error("{sections} sections of {nodes} nodes are more than 16 777 216 points: ask for fewer")]
    TooManyPoints {
        /// Sections asked for.
        sections: usize,
        /// Nodes of each.
        nodes: usize,
    },
    /// Points that make no sections.
    #[error(transparent)]
    Sections(#[from] SectionsError),
}

/// Lengths within which products of several stay well inside the numbers.
pub(super) fn size(what: &'static str, found: f64) -> Result<f64, PrimitiveError> {
    if (1e-9..=1e9).contains(&found) { Ok(found) } else { Err(PrimitiveError::Size { what, found }) }
}
