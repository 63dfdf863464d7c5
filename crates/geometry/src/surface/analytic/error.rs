//! Why sections make no analytic surface, and what is doubtful about those that do.

use std::fmt;

use glam::DVec3;

use super::blend::MOST_OF_POLYNOMIAL;

/// Why sections do not make an analytic surface.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    /// Fewer than two sections.
    #[error("{found} section(s) given, and a surface needs at least 2")]
    TooFewSections {
        /// Sections found.
        found: usize,
    },
    /// Open and closed sections in one surface.
    #[error("section {section} is {}, and section 0 is not: close all sections or none", if *.closed { "closed" } else { "open" })]
    MixedClosure {
        /// Index of the section, counted from 0.
        section: usize,
        /// Whether this one is closed.
        closed: bool,
    },
    /// Coordinates beyond all use, at which the arithmetic would overflow.
    #[error("a coefficient of section {section} is {coordinate:e} m, more than 1e100 m: scale the sections down")]
    TooLarge {
        /// Index of the section, counted from 0.
        section: usize,
        /// The largest coordinate, metres.
        coordinate: f64,
    },
    /// Segments with angles of their own that are not those of the other sections.
    #[error(
        "section {section} has other joints than the rest between the angles {from:.4} and {to:.4}, and its segments \
         count angles of their own: fit all sections with the same joints, or without local angles"
    )]
    LocalAngles {
        /// Index of the section, counted from 0.
        section: usize,
        /// Where the piece begins that fits no segment, radians.
        from: f64,
        /// Where it ends.
        to: f64,
    },
    /// Two neighbouring sections that are one.
    #[error("sections {first} and {second} are identical, and no surface lies between them: move or remove one")]
    IdenticalSections {
        /// Index of the first section, counted from 0.
        first: usize,
        /// Index of the second.
        second: usize,
    },
    /// Two neighbouring sections that are both poles.
    #[error("sections {first} and {second} are each a single point, and no surface lies between them: remove one")]
    NeighbouringPoles {
        /// Index of the first section, counted from 0.
        first: usize,
        /// Index of the second.
        second: usize,
    },
    /// More sections than a polynomial can blend.
    #[error(
        "a polynomial through {sections} sections would swing between them (from about 8 on; at most \
         {MOST_OF_POLYNOMIAL} are taken): use the spline"
    )]
    TooManyForPolynomial {
        /// Sections given.
        sections: usize,
    },
    /// A neighbour that does not end in the section at which it is to be joined.
    #[error(
        "the {side} of the surface is up to {distance:.2e} m away from the neighbour it is to continue, at the same \
         angle: give both the same section, fitted with the same options"
    )]
    NotShared {
        /// Which end of the surface.
        side: Side,
        /// Largest distance at equal angles, metres.
        distance: f64,
    },
    /// A neighbour of another kind.
    #[error(
        "the {side} of the surface can't continue its neighbour: one of both is closed and the other open, or their \
             joints differ: fit both with the same options"
    )]
    OtherNeighbour {
        /// Which end of the surface.
        side: Side,
    },
    /// Two parts of a chain that do not share a section.
    #[error(
        "part {part} of the chain ends up to {distance:.2e} m away from where part {} begins, at the same angle: let \
         the last section of one be the first of the next, fitted with the same options", part + 1
    )]
    BrokenChain {
        /// Index of the part that ends there, counted from 0.
        part: usize,
        /// Largest distance at equal angles, metres.
        distance: f64,
    },
    /// What is wrong with one part of a chain.
    #[error("part {part} of the chain: {error}")]
    Part {
        /// Index of the part, counted from 0.
        part: usize,
        /// What is wrong with it.
        error: Box<SurfaceError>,
    },
    /// Sections whose distances differ beyond what numbers can tell apart.
    #[error("the sections have no surface in finite numbers: their distances differ too much, remove the closest ones")]
    Unsolvable,
    /// A number of sections or harmonics that can't be left.
    #[error("{asked} {what} asked for, and there can be {least} to {most}")]
    OutOfRange {
        /// "sections" or "harmonics".
        what: &'static str,
        /// The number asked for.
        asked: usize,
        /// Least that is possible.
        least: usize,
        /// Most.
        most: usize,
    },
    /// Fewer harmonics asked for of a surface whose pieces would come apart.
    #[error(
        "harmonics can't be dropped from a surface that is open or of several segments, whose joints would come apart: \
         fit its sections with fewer harmonics"
    )]
    SeveralPieces,
}

/// An end of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// u = 0, the first section.
    Start,
    /// u = 1, the last section.
    End,
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Start => "start",
            Self::End => "end",
        })
    }
}

/// What is doubtful about a surface.
#[derive(Clone, Debug, PartialEq)]
pub enum SurfaceWarning {
    /// Two sections that cross each other inside both: the surface runs through itself there.
    CrossingSections {
        /// Index of the first section, counted from 0.
        first: usize,
        /// Index of the second.
        second: usize,
        /// The middle of the stretch in which they cross, metres.
        at: DVec3,
        /// Length of the stretch, metres.
        length: f64,
    },
}

impl fmt::Display for SurfaceWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::CrossingSections { first, second, at, length } => write!(
                f,
                "sections {first} and {second} cross each other over {length:.4} m around ({:.4}, {:.4}, {:.4}), and \
                 the surface runs through itself there: turn one of them, or remove it",
                at.x, at.y, at.z
            ),
        }
    }
}
