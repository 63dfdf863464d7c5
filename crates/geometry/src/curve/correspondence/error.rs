//! Why curves cannot be put in order.

use super::explain::{listed, metres};
use glam::DVec3;

/// Why curves cannot be put in order.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SortError {
    /// Nothing to order.
    #[error("no curves to sort: draw at least 2 open curves")]
    NoCurves,
    /// Fewer than two open curves.
    #[error("{found} open curve(s) to sort, and rails need at least 2: draw more open curves along the shape")]
    TooFewRails {
        /// Open curves found.
        found: usize,
    },
    /// Two open curves alone that neither cross nor share an end.
    #[error(
        "{first} and {second} stay {} apart (up to {} counts as meeting): draw them so that they cross or share an end, \
         or add a closed curve from which they start",
        metres(*gap),
        metres(*allowed)
    )]
    Apart {
        /// What the first curve is called.
        first: String,
        /// What the second curve is called.
        second: String,
        /// Shortest distance between them, metres.
        gap: f64,
        /// Distance up to which they count as meeting, metres.
        allowed: f64,
    },
    /// Two open curves alone that meet only near the end of one, but share none.
    #[error(
        "{first} and {second} meet only near an end: draw both across the place where they meet, or let both end there"
    )]
    MeetNearEnd {
        /// What the first curve is called.
        first: String,
        /// What the second curve is called.
        second: String,
    },
    /// A pinned order that names a rail that is not there.
    #[error("pinned order, place {place}: there is no rail \"{name}\"; there are {}", listed(rails))]
    UnknownRail {
        /// Place in the order, counted from 0.
        place: usize,
        /// The name or number given.
        name: String,
        /// What the rails are called.
        rails: Vec<String>,
    },
    /// A pinned order that names by a name which several rails bear.
    #[error("pinned order, place {place}: {} are all called \"{name}\": pin them by number, or rename", listed(rails))]
    AmbiguousRail {
        /// Place in the order, counted from 0.
        place: usize,
        /// The name given.
        name: String,
        /// The numbers of the rails it could be.
        rails: Vec<String>,
    },
    /// A pinned order that names a rail twice.
    #[error(
        "pinned order, place {place}: \"{name}\" is rail {first} already: name each rail once; there are {}",
        listed(rails)
    )]
    DuplicateRail {
        /// Place in the order, counted from 0.
        place: usize,
        /// The name or number given.
        name: String,
        /// Place at which the same rail stands already.
        first: usize,
        /// What the rails are called.
        rails: Vec<String>,
    },
    /// A pinned order that leaves rails out.
    #[error("pinned order: {} left out: name every rail once; there are {}", listed(missing), listed(rails))]
    MissingRails {
        /// What the rails left out are called.
        missing: Vec<String>,
        /// What all rails are called.
        rails: Vec<String>,
    },
    /// A seam direction that is none.
    #[error("the seam direction {seam} is not a direction: give a finite vector other than zero")]
    Seam {
        /// The direction given.
        seam: DVec3,
    },
    /// Curves too small or too large to measure with.
    #[error("the curves together are {size:e} m in size, too small or too large to compute with: scale them")]
    Size {
        /// Diagonal of the box around all curves, metres.
        size: f64,
    },
    /// Rails that all lie along one line.
    #[error("the open curves lie along one line, so there is no way around them: draw them side by side")]
    NoAxis,
    /// It was told to stop.
    #[error("stopped")]
    Stopped,
    /// A rail so short that it vanishes when its end is moved to where the rails meet.
    #[error("{curve} vanishes where the rails meet: draw it longer, or delete it")]
    RailVanishes {
        /// What the curve is called.
        curve: String,
    },
}
