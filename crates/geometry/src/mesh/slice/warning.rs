//! What should be looked at in sections, in words an artist understands.

use std::fmt;
use std::mem::discriminant;

use glam::DVec3;

use crate::curve::{metres, place};

/// Something about a run of sections that is probably not meant. Its [`Display`](fmt::Display) says what, where and what
/// to do; sections are counted from 0, lengths are metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliceWarning {
    /// First of the sections.
    pub first: usize,
    /// Last of the sections.
    pub last: usize,
    /// Where it is worst, on the bone; where sections cross, a point inside of two of them.
    pub at: DVec3,
    /// What is the matter.
    pub what: Concern,
}

/// What is the matter with sections.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Concern {
    /// Their planes do not meet the mesh, and there is no section in them.
    Missed,
    /// The bone is in no loop; the nearest one was taken.
    Beside {
        /// Largest distance of the loop from the bone, metres.
        distance: f64,
    },
    /// The bone runs far from the middle: by more than 0.7 of the radius of a circle of the same area.
    OffCentre {
        /// Largest distance of a section's centroid from the bone, metres.
        offset: f64,
    },
    /// The loop that was taken lies within an open chain that is around the bone too.
    WithinOpen,
    /// Each of them crosses another one of them inside the body.
    Cross,
}

impl Concern {
    /// By how much it is the matter.
    fn extent(self) -> f64 {
        match self {
            Self::Beside { distance: extent } | Self::OffCentre { offset: extent } => extent,
            Self::Missed | Self::WithinOpen | Self::Cross => 0.0,
        }
    }
}

/// Adds a warning about one section, to the run that ends just before it where there is one.
pub(super) fn warn(warnings: &mut Vec<SliceWarning>, section: usize, at: DVec3, what: Concern) {
    let continues = |run: &&mut SliceWarning| run.last + 1 == section && discriminant(&run.what) == discriminant(&what);
    match warnings.iter_mut().find(continues) {
        Some(run) => {
            run.last = section;
            if what.extent() > run.what.extent() {
                (run.at, run.what) = (at, what);
            }
        }
        None => warnings.push(SliceWarning { first: section, last: section, at, what }),
    }
}

impl fmt::Display for SliceWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { first, last, at, what } = self;
        let at = place(*at);
        if first == last {
            write!(f, "section {first}: ")?;
        } else {
            write!(f, "sections {first} to {last}: ")?;
        }
        match what {
            Concern::Missed => write!(
                f,
                "the plane at {at} misses the mesh, and there is no section in it: keep the sections to the part of the \
                 bone that is in the mesh"
            ),
            Concern::Beside { distance } => write!(
                f,
                "the bone's point {at} is in no loop, and the nearest one, {} away, was taken: move the bone into the \
                 body",
                metres(*distance)
            ),
            Concern::OffCentre { offset } => write!(
                f,
                "the middle is {} from the bone at {at}, so that another part of the body is probably cut too: keep the \
                 sections clear of it, or move the bone to the middle",
                metres(*offset)
            ),
            Concern::WithinOpen => write!(
                f,
                "a wider outline around {at} does not close, and the one within was taken: close the hole in the mesh \
                 if the outer surface is meant"
            ),
            Concern::Cross => write!(
                f,
                "they cross each other inside the body, near {at}: let the planes turn over a longer part of the bone, \
                 take fewer sections there, or move the bone towards the inside of the bend"
            ),
        }
    }
}
