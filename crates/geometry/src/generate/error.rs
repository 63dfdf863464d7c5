//! Why rails make no surface.

use crate::beam::BeamError;
use crate::border::BorderError;
use crate::curve::NotSolvable;
use crate::sections::SectionsError;

/// Why rails make no surface.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GenerateError {
    /// Fewer sections than the case needs.
    #[error("{found} section(s) asked for, and this case needs at least {needed}")]
    TooFewSections {
        /// Sections asked for.
        found: usize,
        /// Sections needed.
        needed: usize,
    },
    /// More points than are supported.
    #[error(
        "{sections} sections of {nodes} points asked for: at most {} of each and {} points together are supported",
        crate::beam::MOST_NODES,
        super::GenerateOptions::MOST_POINTS
    )]
    TooLarge {
        /// Sections asked for.
        sections: usize,
        /// Points of each section asked for.
        nodes: usize,
    },
    /// A snap distance that is not a distance.
    #[error("the snap distance is {snap}: it must be a finite number of metres, 0 or above")]
    Snap {
        /// What was given.
        snap: f64,
    },
    /// A curve of a size at which lengths overflow.
    #[error("curve \"{name}\" reaches farther than 1e100 m from the origin: scale it down, the unit is the metre")]
    TooFarOut {
        /// Name of the curve.
        name: String,
    },
    /// A closed curve among the rails.
    #[error("rail {rail} (\"{name}\") is closed: rails are open curves, so cut it or draw it open")]
    RailIsClosed {
        /// Index of the rail, counted from 0.
        rail: usize,
        /// Its name.
        name: String,
    },
    /// An open curve where a closed one is needed.
    #[error("the {which} curve (\"{name}\") is open: close it, so that the rails can stand around it")]
    CurveIsOpen {
        /// `start` or `end`.
        which: &'static str,
        /// Its name.
        name: String,
    },
    /// A closed curve where an open one is needed.
    #[error("the {which} curve (\"{name}\") is closed: a sheet lies between open curves, so cut it or draw it open")]
    CurveIsClosed {
        /// `start`, `inner` or `end`.
        which: &'static str,
        /// Its name.
        name: String,
    },
    /// Fewer curves across the rails than needed.
    #[error("{found} curve(s) across the rails given, and at least {needed} needed: draw another one")]
    TooFewProfiles {
        /// Curves found.
        found: usize,
        /// Curves needed.
        needed: usize,
    },
    /// A rail that does not meet the curves across it in their order.
    #[error(
        "rail {rail} (\"{name}\") does not meet curve {second} across the rails behind curve {first}: list these curves \
         in the order in which the rails run"
    )]
    ProfileOrder {
        /// Index of the rail, counted from 0.
        rail: usize,
        /// Its name.
        name: String,
        /// Index of the one curve, counted from 0; with an apex that counts as the last.
        first: usize,
        /// Index of the next one.
        second: usize,
    },
    /// A rail that ends away from where the rails meet.
    #[error(
        "rail {rail} (\"{name}\") ends {distance:.4} m away from the point where the rails meet, farther than the snap \
         of {snap} m: draw it up to the others' ends, pass the rails through `sort`, or raise the snap"
    )]
    NoApex {
        /// Index of the rail, counted from 0.
        rail: usize,
        /// Its name.
        name: String,
        /// Distance, metres.
        distance: f64,
        /// The snap, metres.
        snap: f64,
    },
    /// Directions that do not suit a border.
    #[error(transparent)]
    Border(#[from] BorderError),
    /// A place at which a neighbour has no direction.
    #[error(
        "the neighbour of border \"{border}\" has no direction at ({:.4}, {:.4}, {:.4}): its curve must lie beside the \
         border, not on it, and directions must not turn back between two points", point.x, point.y, point.z
    )]
    NoDirection {
        /// Name of the border.
        border: String,
        /// The place, metres.
        point: glam::DVec3,
    },
    /// Fewer points a section than the case needs.
    #[error("{found} point(s) a section asked for, and this case needs at least {needed}")]
    TooFewNodes {
        /// Points asked for.
        found: usize,
        /// Points needed.
        needed: usize,
    },
    /// An open contour that leaves a closed one where it comes back.
    #[error(
        "\"{name}\" starts and ends at one point of \"{curve}\", and so does not cut it in two: draw it across the \
         closed curve"
    )]
    BothEndsAtOnePoint {
        /// Name of the open curve.
        name: String,
        /// Name of the closed curve.
        curve: String,
    },
    /// A border that encloses next to nothing.
    #[error("border \"{border}\" encloses next to no area, so that it has no inside: draw it rounder")]
    EnclosesNothing {
        /// Its name.
        border: String,
    },
    /// A strength that is none.
    #[error(
        "the strength at border \"{border}\" is {strength}: it must be above 0, and at most {}",
        super::BlendBorder::LARGEST_STRENGTH
    )]
    Strength {
        /// Name of the border.
        border: String,
        /// What was given.
        strength: f64,
    },
    /// A twist that is no angle.
    #[error("the twist is {twist}: it must be a finite number of radians")]
    Twist {
        /// What was given.
        twist: f64,
    },
    /// A number of borders that no patch has.
    #[error(
        "{found} border curve(s) given, and a patch has 3 or 4: draw a curve across a larger field and fill both parts"
    )]
    BorderCount {
        /// Borders found.
        found: usize,
    },
    /// Borders that do not close a loop.
    #[error(
        "border {border} (\"{name}\") ends {distance:.4} m away from the next one, farther than the snap of {snap} m: \
         draw the borders from corner to corner, or raise the snap"
    )]
    BordersApart {
        /// Index of the border, counted from 0.
        border: usize,
        /// Its name.
        name: String,
        /// Distance, metres.
        distance: f64,
        /// The snap, metres.
        snap: f64,
    },
    /// Curves that are no detail together.
    #[error("{what}")]
    NoMethod {
        /// What is there, and what would be a detail.
        what: String,
    },
    /// Fewer rails than go around.
    #[error("{found} rail(s) given, and at least 2 are needed: draw another one")]
    TooFewRails {
        /// Rails found.
        found: usize,
    },
    /// A rail that ends away from its closed curve.
    #[error(
        "rail {rail} (\"{name}\") {ends} {distance:.4} m away from the {which} curve (\"{curve}\"), farther than the \
         snap of {snap} m: draw it up to the curve, or raise the snap"
    )]
    Gap {
        /// Index of the rail, counted from 0.
        rail: usize,
        /// Its name.
        name: String,
        /// `starts`, `passes` or `ends`.
        ends: &'static str,
        /// Distance, metres.
        distance: f64,
        /// `start` or `end`.
        which: &'static str,
        /// Name of the closed curve.
        curve: String,
        /// The snap, metres.
        snap: f64,
    },
    /// A rail that runs from the end curve to the start curve.
    #[error(
        "rail {rail} (\"{name}\") runs from the end curve to the start curve: reverse it, or put the curves through \
         sort first"
    )]
    RailIsReversed {
        /// Index of the rail, counted from 0.
        rail: usize,
        /// Its name.
        name: String,
    },
    /// Two rails that meet a closed curve at one point.
    #[error("rails {first} and {second} meet the {which} curve (\"{curve}\") at one point: move them apart there")]
    SameFoot {
        /// Index of the one rail, counted from 0.
        first: usize,
        /// Index of the other rail, counted from 0.
        second: usize,
        /// `start` or `end`.
        which: &'static str,
        /// Name of the closed curve.
        curve: String,
    },
    /// Rails whose feet are not in order around a closed curve.
    #[error(
        "rails {first} and {second} cross: along the {which} curve (\"{curve}\") their order is not that of the list; put the curves through sort, or redraw one of them"
    )]
    Crossing {
        /// Index of the one rail, counted from 0.
        first: usize,
        /// Index of the other rail, counted from 0.
        second: usize,
        /// `start` or `end`.
        which: &'static str,
        /// Name of the closed curve.
        curve: String,
    },
    /// A closed curve that runs against the order of the rails.
    #[error(
        "the {which} curve (\"{curve}\") runs against the order of the rails: reverse it, or put the curves through \
         sort first"
    )]
    CurveIsReversed {
        /// `start` or `end`.
        which: &'static str,
        /// Name of the closed curve.
        curve: String,
    },
    /// A contour that runs against the other three.
    #[error("rail {rail} (\"{name}\") runs against the other ones: reverse it, or pass them through `sort`")]
    RailRunsBack {
        /// Index of the rail, counted from 0.
        rail: usize,
        /// Its name.
        name: String,
    },
    /// Contours of two views in another order than around.
    #[error(
        "the rails (\"{}\", \"{}\", \"{}\", \"{}\") do not run around counter-clockwise, the outlines of the two views by \
         turns: pass them through `sort`, with faces outwards",
        names[0], names[1], names[2], names[3]
    )]
    RailsUnsorted {
        /// Names of the rails as they came.
        names: [String; 4],
    },
    /// Depth or detail along the rails cannot be smoothed.
    #[error("the rails cannot be smoothed along their length in double precision: scale them to metres")]
    NotSmoothable,
    /// The caller asked to stop.
    #[error("generating was cancelled")]
    Cancelled,
    /// The generator curve cannot be computed.
    #[error("the generator curve cannot be computed: {0}")]
    Beam(#[from] BeamError),
    /// The result is no stack of sections.
    #[error("the rails do not give sections: {0}")]
    Sections(#[from] SectionsError),
}

impl From<NotSolvable> for GenerateError {
    fn from(_: NotSolvable) -> Self {
        Self::NotSmoothable
    }
}
