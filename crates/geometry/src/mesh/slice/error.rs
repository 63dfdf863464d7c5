//! Why a mesh has no sections.

use glam::DVec3;

use crate::curve::{CurveError, ResampleError, metres, place};

/// Why a mesh has no sections. Sections are counted from 0, lengths are metres.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SliceError {
    /// Told to stop.
    #[error("stopped")]
    Stopped,
    /// A mesh without polygons.
    #[error("the mesh has no polygons, and so no sections")]
    NoPolygons,
    /// A bone that is a closed curve.
    #[error("the bone \"{bone}\" is a closed curve: draw it open, from one joint to the next")]
    ClosedBone {
        /// Name of the bone.
        bone: String,
    },
    /// A bone whose length is not a usable number.
    #[error("the bone \"{bone}\" is too small or too large to measure: scale it with its mesh")]
    Unmeasurable {
        /// Name of the bone.
        bone: String,
    },
    /// No section, or more than [`MAX_SECTIONS`](super::MAX_SECTIONS).
    #[error("{found} sections asked for: ask for 1 to 4096")]
    SectionCount {
        /// Sections asked for.
        found: usize,
    },
    /// A stretch of the bone that runs backwards.
    #[error("sections from {from} to {to} of the bone run backwards: give the smaller share first")]
    Extent {
        /// Share of the first section.
        from: f64,
        /// Share of the last one.
        to: f64,
    },
    /// A share of the bone's length that is out of range.
    #[error("a section at {fraction} of the bone: give numbers from -10 to 11, where 0 is its start and 1 its end")]
    OutOfReach {
        /// The share.
        fraction: f64,
    },
    /// Shares that do not grow.
    #[error("section {section}, at {fraction} of the bone, does not lie behind the one before: give growing numbers")]
    NotGrowing {
        /// The section.
        section: usize,
        /// Its share.
        fraction: f64,
    },
    /// A stretch of turning that is out of range.
    #[error("a turning of {turning} is not a share of the bone's length: give a number from 0 to 1")]
    Turning {
        /// The stretch.
        turning: f64,
    },
    /// A number of points that makes no section.
    #[error("{points} points a section asked for: ask for 3 to 65 536")]
    PointCount {
        /// Points asked for.
        points: usize,
    },
    /// A front that is no direction.
    #[error("the front {front} is no direction: give finite numbers that are not all zero")]
    Front {
        /// The front.
        front: DVec3,
    },
    /// The loop around the bone does not close.
    #[error(
        "section {section}: the outline around {} does not close, for the mesh is open there: it ends at {} and at {}, \
         {} apart; close the hole, move the section, or use rays",
        place(*at), place(ends[0]), place(ends[1]), metres(ends[0].distance(ends[1]))
    )]
    NotClosed {
        /// The section.
        section: usize,
        /// The bone's point in it.
        at: DVec3,
        /// The ends that should meet.
        ends: [DVec3; 2],
    },
    /// Some rays hit nothing.
    #[error(
        "section {section}: {} of {rays} rays from {} hit nothing, the first one {:.0} degrees counter-clockwise from \
         the front: close the hole, move the section, or move the bone into the body",
        missed.len(), place(*at), 360.0 * missed.first().map_or(0.0, |k| *k as f64) / *rays as f64
    )]
    RaysMissed {
        /// The section.
        section: usize,
        /// The bone's point in it.
        at: DVec3,
        /// Rays that were cast.
        rays: usize,
        /// Those that hit nothing, counted from 0 at the front.
        missed: Vec<usize>,
    },
    /// Several rays hit one point.
    #[error(
        "section {section}: several rays from {} hit one point: move the bone away from the surface, into the body",
        place(*at)
    )]
    RaysMeet {
        /// The section.
        section: usize,
        /// The bone's point in it.
        at: DVec3,
    },
    /// No plane meets the mesh.
    #[error("none of the {planes} planes meets the mesh: move the bone into the body, and mind the units (metres)")]
    NothingCut {
        /// Planes tried.
        planes: usize,
    },
    /// A loop that makes no curve.
    #[error("section {section}: {source}")]
    Curve {
        /// The section.
        section: usize,
        /// Why.
        source: CurveError,
    },
    /// A loop that can't be given its points.
    #[error("section {section}: {source}")]
    Resample {
        /// The section.
        section: usize,
        /// Why.
        source: ResampleError,
    },
}
