//! What is said about an order: decisions, warnings, and why there is none.

use std::fmt;

use glam::DVec3;

use crate::curve::{metres, place};

/// What was done with a section.
#[derive(Clone, Debug, PartialEq)]
pub struct Placed {
    /// Its place in the list as it was given, counted from 0.
    pub section: usize,
    /// Its name.
    pub name: String,
    /// Whether it was run the other way.
    pub reversed: bool,
    /// How far its start moved along it, the shorter way, metres.
    pub start_moved: f64,
}

/// Something about the sections that should be looked at.
#[derive(Clone, Debug, PartialEq)]
pub enum OrderWarning {
    /// A section that repeats another one, and was dropped.
    Double {
        /// Its place in the list as it was given.
        section: usize,
        /// The place of the one it repeats.
        of: usize,
        /// Its name.
        name: String,
        /// The name of the one it repeats.
        name_of: String,
        /// Its middle.
        at: DVec3,
    },
    /// A step that is much longer than the others.
    Jump {
        /// Place in the order of the section before it.
        before: usize,
        /// Its length, metres.
        gap: f64,
        /// The length in the middle of all steps, metres.
        usual: f64,
        /// Its middle.
        at: DVec3,
    },
}

impl fmt::Display for OrderWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Double { section, of, name, name_of, at } => write!(
                f,
                "{} repeats {} at {}, and was dropped: delete one of them",
                called(*section, name),
                called(*of, name_of),
                place(*at)
            ),
            Self::Jump { before, gap, usual, at } => write!(
                f,
                "from section {before} to section {} of the order it is {}, at {}, where {} is usual: draw what is \
                 missing, or keep the sections of another limb out",
                before + 1,
                metres(*gap),
                place(*at),
                metres(*usual)
            ),
        }
    }
}

fn called(section: usize, name: &str) -> String {
    if name.is_empty() { format!("curve {section}") } else { format!("curve {section} (\"{name}\")") }
}

/// Why sections are not put in order.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum OrderError {
    /// Told to stop.
    #[error("stopped")]
    Stopped,
    /// No section, or more than [`MAX_SECTIONS`](super::MAX_SECTIONS).
    #[error("{found} curves arrive: give 1 to 2048 sections")]
    SectionCount {
        /// Curves given.
        found: usize,
    },
    /// An open curve.
    #[error("{} is open, and a section is closed: close it, or keep it out with `pick`", called(*section, name))]
    Open {
        /// Its place in the list.
        section: usize,
        /// Its name.
        name: String,
    },
    /// A direction that is none.
    #[error("the {what} {found} is no direction: give finite numbers that are not all zero")]
    Direction {
        /// Which one.
        what: &'static str,
        /// The direction.
        found: DVec3,
    },
    /// A tolerance that is out of range.
    #[error("sections within {found} of their size count as one: give a share from 0 to 0.5")]
    Double {
        /// The share.
        found: f64,
    },
    /// Sections too small or too large.
    #[error("curves between {least} m and {most} m large can't be measured: scale them")]
    Size {
        /// The smallest.
        least: f64,
        /// The largest.
        most: f64,
    },
}
