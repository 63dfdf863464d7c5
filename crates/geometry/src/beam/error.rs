//! Why a beam cannot be set up or solved.

/// Why a beam cannot be set up or solved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BeamError {
    /// Fewer nodes than the difference scheme reaches over.
    #[error("{found} node(s) given, and the difference scheme needs at least {needed}: ask for more points")]
    TooFewNodes {
        /// Nodes asked for.
        found: usize,
        /// Nodes needed.
        needed: usize,
    },
    /// More nodes than can be solved accurately.
    #[error("{found} nodes given, and at most {} are supported: ask for fewer points", super::MOST_NODES)]
    TooManyNodes {
        /// Nodes asked for.
        found: usize,
    },
    /// A closed beam without a pin could lie anywhere.
    #[error("a closed beam needs at least one pin: without one its position is not determined")]
    NoPin,
    /// An open beam with two free ends and no pin could lie anywhere.
    #[error("both ends are free and no node is pinned, so that the beam could lie anywhere: pin a node or hold an end")]
    NotHeld,
    /// An open beam that turns about the only point that holds it.
    #[error(
        "without stretching stiffness the beam turns freely about the one node that holds it: pin another node, clamp \
         an end, or give a k_s above 0"
    )]
    Turns,
    /// Parameters that do not increase.
    #[error("parameter {index} does not come behind the one before it, or lies outside 0 to 1: sort them")]
    Unordered {
        /// Index of the parameter in the list.
        index: usize,
    },
    /// A pin outside the nodes that can be pinned.
    #[error("pin {pin} is at node {node}, and pins may stand at nodes {first} to {last}: move it there")]
    PinOutOfRange {
        /// Index of the pin in the list.
        pin: usize,
        /// Node it names.
        node: usize,
        /// First node that can be pinned.
        first: usize,
        /// Last node that can be pinned.
        last: usize,
    },
    /// A node pinned twice.
    #[error("pins {first} and {second} are both at node {node}: remove one of them")]
    PinnedTwice {
        /// Index of the earlier pin in the list.
        first: usize,
        /// Index of the later pin in the list.
        second: usize,
        /// The node.
        node: usize,
    },
    /// A list of values that does not match what it belongs to.
    #[error("{found} {what} given, and {needed} needed")]
    Count {
        /// Which list.
        what: &'static str,
        /// Entries found.
        found: usize,
        /// Entries needed.
        needed: usize,
    },
    /// A value that is not a number or is infinite.
    #[error("{what} {index} is not a finite number")]
    NotFinite {
        /// Which list.
        what: &'static str,
        /// Index in the list.
        index: usize,
    },
    /// A system that has no unique solution in the numbers at hand, or values beyond the range of a double.
    #[error("the beam equations cannot be solved in double precision: use smaller values or fewer nodes")]
    NotSolvable,
}
