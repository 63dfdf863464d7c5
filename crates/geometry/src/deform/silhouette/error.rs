//! Why strokes cannot be the silhouettes of a stack of sections.

use glam::DVec2;

use crate::beam::BeamError;
use crate::curve::Curve;
use crate::sections::SectionsError;

/// Why strokes are not the two sides of a shape.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StrokesError {
    /// No view, or more than two.
    #[error("silhouettes of {found} views given: give those of one view, or of two at right angles")]
    Views {
        /// Views found.
        found: usize,
    },
    /// Two views that are not at right angles.
    #[error(
        "the {one} and the {other} view are {degrees:.1} degrees apart: two silhouettes are only exact at once in views \
         at right angles"
    )]
    NotSquare {
        /// First view.
        one: &'static str,
        /// Second view.
        other: &'static str,
        /// Angle between the directions of sight, degrees, 0 to 90.
        degrees: f64,
    },
    /// Strokes that are no two sides.
    #[error(
        "the {view} view has {found} strokes{strokes}, {closed} of them closed: draw two open strokes, one on each side \
         of the shape, or one around it"
    )]
    Strokes {
        /// The view.
        view: &'static str,
        /// Strokes found.
        found: usize,
        /// Closed ones among them.
        closed: usize,
        /// Their names.
        strokes: String,
    },
    /// Strokes without area between them.
    #[error(
        "the strokes{strokes} enclose no area in the {view} view: draw both sides of the shape there, or choose the view \
         in which they were drawn"
    )]
    NoArea {
        /// The view.
        view: &'static str,
        /// Names of the strokes.
        strokes: String,
    },
    /// The two sides cross.
    #[error(
        "the strokes{strokes} cross at ({:.4}, {:.4}) in the {view} view, so that neither is on one side of the shape \
         throughout: draw them beside each other",
        at.x, at.y
    )]
    Crossing {
        /// The view.
        view: &'static str,
        /// Names of the strokes.
        strokes: String,
        /// Where, in the picture, metres.
        at: DVec2,
    },
    /// Coordinates beyond all use.
    #[error("the strokes{strokes} have coordinates above 1e100 m: scale them down")]
    TooLarge {
        /// Names of the strokes.
        strokes: String,
    },
}

impl StrokesError {
    /// Name of the view at fault, where there is one.
    pub fn view(&self) -> Option<&'static str> {
        match self {
            Self::Strokes { view, .. } | Self::NoArea { view, .. } | Self::Crossing { view, .. } => Some(view),
            Self::NotSquare { other, .. } => Some(other),
            Self::Views { .. } | Self::TooLarge { .. } => None,
        }
    }
}

/// Why strokes cannot be the silhouettes of a stack of sections.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SilhouetteError {
    /// The strokes are no two sides.
    #[error(transparent)]
    Strokes(#[from] StrokesError),
    /// Silhouettes beside the stack.
    #[error(
        "the strokes{strokes} lie {distance:.4} m beside the sections in the {view} view: move the primitive there, or \
         align it to the strokes first"
    )]
    Apart {
        /// The view.
        view: &'static str,
        /// Names of the strokes.
        strokes: String,
        /// Distance of the boxes around both, metres.
        distance: f64,
    },
    /// A stroke that makes no way along the stack.
    #[error(
        "a stroke of{strokes} is as high at its end as at its start in the {view} view, and cannot be matched by height: \
         match by arc length"
    )]
    Level {
        /// The view.
        view: &'static str,
        /// Names of the strokes.
        strokes: String,
    },
    /// A stack that is seen end on.
    #[error(
        "the sections make no way from the first to the last in the {view} view: turn the primitive so that its axis is \
         seen there, or draw one closed outline around it"
    )]
    EndOn {
        /// The view.
        view: &'static str,
    },
    /// A stack that is seen end on, and more than its outline.
    #[error(
        "the {view} view looks along the sections: draw its outline in one closed stroke, in no other view at once"
    )]
    OutlineNeeded {
        /// The view.
        view: &'static str,
    },
    /// An outline that is not star-shaped about its centre.
    #[error(
        "{what} is not star-shaped about the centre of the outline, so that points cannot be matched by height: match by \
         arc length"
    )]
    NotStarShaped {
        /// The outline or a section.
        what: String,
    },
    /// A tolerance out of its range.
    #[error("the tolerance is {value} of the sketch's diagonal: give 0.000001 to 1")]
    Tolerance {
        /// The tolerance.
        value: f64,
    },
    /// Strokes of too much detail.
    #[error(
        "to follow the detail of the strokes takes {at_least} sections or more, above 10 million points: smooth the \
         strokes, or raise the tolerance"
    )]
    TooMuchDetail {
        /// Sections that are needed at least.
        at_least: usize,
    },
    /// Sections that do not close.
    #[error("the sections are open: only closed sections have silhouettes on two sides")]
    SectionsAreOpen,
    /// The sides of the stack cannot be told apart.
    #[error(
        "no four different columns of points stand on the four sides of the sections, which have {nodes} points each: \
         give sections more points, or some width in both views"
    )]
    NoSides {
        /// Points of a section.
        nodes: usize,
    },
    /// The displacement cannot be computed.
    #[error("the displacement cannot be computed: {0}")]
    Beam(#[from] BeamError),
    /// The result is no stack of sections.
    #[error("the deformed points are no sections: {0}")]
    Sections(#[from] SectionsError),
    /// `progress` asked to stop.
    #[error("stopped")]
    Cancelled,
}

/// The names of strokes for a message, with a space before them.
pub(crate) fn names(strokes: &[Curve]) -> String {
    let mut names: Vec<String> = strokes.iter().take(4).map(|stroke| format!("\"{}\"", stroke.name())).collect();
    if strokes.len() > 4 {
        names.push("..".to_owned());
    }
    if names.is_empty() { String::new() } else { format!(" {}", names.join(", ")) }
}
