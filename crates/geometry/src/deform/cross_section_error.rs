//! Why a contour cannot deform a stack of sections.

use crate::beam::BeamError;
use crate::sections::SectionsError;

/// Why a contour cannot deform a stack of sections.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CrossSectionError {
    /// No contour at all.
    #[error("no contour arrives: give at least one closed curve")]
    NoContour,
    /// Two contours for one section.
    #[error(
        "contours \"{one}\" and \"{other}\" are both closest to section {section}, which can take the shape of one only: \
         move them apart, or generate more sections"
    )]
    SameSection {
        /// Name of the first contour.
        one: String,
        /// Name of the second.
        other: String,
        /// The section, counted from 0.
        section: usize,
    },
    /// A contour that does not close.
    #[error("contour \"{contour}\" is open: close it, a cross-section goes all the way around")]
    ContourIsOpen {
        /// Name of the contour.
        contour: String,
    },
    /// Sections that do not close.
    #[error("the sections are open: only closed sections can take the shape of a contour")]
    SectionsAreOpen,
    /// Fewer sections than a range needs.
    #[error(
        "{found} sections given, and at least 5 are needed (both ends of the range, the replaced one and a free one on \
         each side of it): generate more sections"
    )]
    TooFewSections {
        /// Sections found.
        found: usize,
    },
    /// An influence range that is not a distance.
    #[error("the influence range {which} the contour is {reach}: it must be a finite number, 0 or above")]
    Reach {
        /// `before` or `after`.
        which: &'static str,
        /// What was given.
        reach: f64,
    },
    /// A contour without area, or one that crosses itself so that its areas cancel.
    #[error("contour \"{contour}\" encloses no area, so that it has no plane: draw it as a loop")]
    ContourIsFlat {
        /// Name of the contour.
        contour: String,
    },
    /// A section without area.
    #[error("section {section}, the closest to contour \"{contour}\", encloses no area: move the contour off it")]
    SectionIsFlat {
        /// Index of the section, counted from 0.
        section: usize,
        /// Name of the contour.
        contour: String,
    },
    /// A contour beside the stack.
    #[error(
        "contour \"{contour}\" is {distance:.4} m from the closest section that can be replaced ({section}), which is \
         only {size:.4} m large: move the contour onto the surface"
    )]
    TooFar {
        /// Name of the contour.
        contour: String,
        /// Distance of the centres, metres.
        distance: f64,
        /// Index of the closest section, counted from 0.
        section: usize,
        /// Diagonal of that section, metres.
        size: f64,
    },
    /// A contour across the section instead of along it.
    #[error(
        "contour \"{contour}\" is turned by {degrees:.0} degrees against section {section}, more than 60: draw it in \
         the view along the stack"
    )]
    Turned {
        /// Name of the contour.
        contour: String,
        /// Angle between both normals, degrees, 0 to 90.
        degrees: f64,
        /// Index of the section, counted from 0.
        section: usize,
    },
    /// No free section between the replaced one and the end of the range.
    #[error(
        "the influence range {which} section {section}, which the contour replaces, has no free section in it: set it \
         to at least {needed:.4} m, or generate more sections"
    )]
    RangeTooSmall {
        /// `before` or `after`.
        which: &'static str,
        /// Index of the replaced section, counted from 0.
        section: usize,
        /// Least reach, metres.
        needed: f64,
    },
    /// No free section between the replaced one and the end of a range counted in sections.
    #[error(
        "the influence range {which} section {section}, which the contour replaces, is fewer than 2 sections, so that \
         none is free in it: set it to 2 or more"
    )]
    TooFewInRange {
        /// `before` or `after`.
        which: &'static str,
        /// Index of the replaced section, counted from 0.
        section: usize,
    },
    /// A contour right beside the end of the stack.
    #[error(
        "contour \"{contour}\" replaces section {section}, right beside the {border} section, and nothing can give way \
         between them: generate more sections, or move the contour inwards"
    )]
    NoRoom {
        /// Name of the contour.
        contour: String,
        /// Index of the replaced section, counted from 0.
        section: usize,
        /// `first` or `last`.
        border: &'static str,
    },
    /// Matching by angle where an angle meets a curve more than once.
    #[error(
        "{what} is not star-shaped about the centre of the contour, so that points cannot be matched by angle: match \
         by arc length"
    )]
    NotStarShaped {
        /// The contour or the section, with its name or index.
        what: String,
    },
    /// The displacement cannot be computed.
    #[error("the displacement cannot be computed: {0}")]
    Beam(#[from] BeamError),
    /// `progress` asked to stop.
    #[error("stopped")]
    Cancelled,
    /// The result is no stack of sections.
    #[error("the deformed points are no sections: {0}")]
    Sections(#[from] SectionsError),
}
