//! What should be looked at in sections, in words an artist understands.

use std::fmt;

use glam::DVec3;

use crate::curve::{metres, place};

/// Something that is probably not meant. Its [`Display`](fmt::Display) says what, where and what to do; sections are
/// counted from 0, lengths are metres.
#[derive(Clone, Debug, PartialEq)]
pub enum SliceWarning {
    /// A plane does not meet the mesh, and there is no section in it.
    Missed {
        /// The section.
        section: usize,
        /// The bone's point in it.
        at: DVec3,
    },
    /// The bone is not inside of any loop; the nearest one was taken.
    Beside {
        /// The section.
        section: usize,
        /// The bone's point in it.
        at: DVec3,
        /// Distance of the loop from it, metres.
        distance: f64,
    },
    /// The loop that was taken lies within an open chain that is around the bone too.
    WithinOpen {
        /// The section.
        section: usize,
        /// The bone's point in it.
        at: DVec3,
    },
    /// Sections cross each other inside the body: each of them crosses another one of them.
    Cross {
        /// First of the sections.
        first: usize,
        /// Last of the sections.
        last: usize,
        /// A point inside of two of them.
        at: DVec3,
    },
}

impl fmt::Display for SliceWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missed { section, at } => write!(
                f,
                "section {section}, at {}, misses the mesh and is left out: keep the sections to the part of the bone \
                 that is in the mesh",
                place(*at)
            ),
            Self::Beside { section, at, distance } => write!(
                f,
                "section {section}: the bone's point {} is in no loop, and the nearest one, {} away, was \
                 taken: move the bone into the body",
                place(*at),
                metres(*distance)
            ),
            Self::WithinOpen { section, at } => write!(
                f,
                "section {section}, around {}: a wider outline is around this one, but does not close, and was not \
                 taken: close the hole in the mesh if the outer surface is meant",
                place(*at)
            ),
            Self::Cross { first, last, at } => write!(
                f,
                "sections {first} to {last} cross each other inside the body, near {}: let the planes turn over a \
                 longer part of the bone, take fewer sections there, or move the bone towards the inside of the bend",
                place(*at)
            ),
        }
    }
}
