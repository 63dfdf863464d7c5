//! How large a graph's file may be: reading one takes less than 100 MB of memory, whatever its bytes are.
//!
//! A few bytes can ask for much: `1:(),` is a node. What a file asks for is added up while it is taken apart, before
//! anything is built, with what each piece costs at worst.

use std::cell::Cell;

/// Bytes of the largest file that is read, 16 MiB.
pub const MOST_BYTES: usize = 16 << 20;

/// What the parts of a file may ask for together, in bytes. The rest of 100 MB is for its text and for what is said about
/// it.
const BUDGET: usize = 80_000_000;

/// Most problems that are listed one by one, and the most bytes they may take together.
pub(super) const MOST_PROBLEMS: usize = 10_000;
pub(super) const MOST_PROBLEM_BYTES: usize = 12_000_000;

/// Longest piece of a file that a message repeats, in characters.
const LONGEST_QUOTE: usize = 200;

/// What is said of a graph that asks for more.
pub(super) const TOO_LARGE: &str = "its nodes, values and points take more than 100 MB to read";

/// What pieces cost at worst, in bytes: in the tree, in the graph, and in the places that are remembered.
pub(super) const NODE: usize = 700;
pub(super) const FIRST_INPUT: usize = 1_300;
pub(super) const UNKNOWN_FIELD: usize = 300;
/// A body has a graph and a kind of its own.
pub(super) const BODY: usize = 3_000;
/// A parameter or output; all of them are asked for each one's name.
pub(super) const INTERFACE: usize = 10_000;
/// Each port of a kind that follows from a body.
pub(super) const BODY_PORT: usize = 1_000;
const PIECE: usize = 90;
/// A point of a stroke begins with a bracket; it is there as a literal and as a value, while lists grow.
const BRACKET: usize = 112;
/// A text in quotes may be one of a list.
const QUOTE: usize = 40;
/// A text is there as a literal and as a value, or as it was.
const BYTE: usize = 3;

/// Adds up what a file asks for.
#[derive(Debug)]
pub(super) struct Meter {
    left: Cell<usize>,
    is_exceeded: Cell<bool>,
}

impl Default for Meter {
    fn default() -> Self {
        Self { left: Cell::new(BUDGET), is_exceeded: Cell::new(false) }
    }
}

impl Meter {
    /// Takes what a piece costs; `false` where that is no longer there.
    pub(super) fn take(&self, cost: usize) -> bool {
        match self.left.get().checked_sub(cost) {
            Some(left) => self.left.set(left),
            None => self.is_exceeded.set(true),
        }
        !self.is_exceeded.get()
    }

    /// As [`Meter::take`] for a piece of text that may become anything.
    pub(super) fn take_text(&self, text: &str) -> bool {
        let count = |mark: u8| text.bytes().filter(|byte| *byte == mark).count();
        self.take(PIECE + BYTE * text.len() + BRACKET * count(b'(') + QUOTE * count(b'"'))
    }

    /// Whether more was asked for than there is.
    pub(super) fn is_exceeded(&self) -> bool {
        self.is_exceeded.get()
    }
}

/// What a file calls something, as a message repeats it: not more of it than can be read.
pub(super) fn quoted_in_message(name: &str) -> String {
    match name.char_indices().nth(LONGEST_QUOTE) {
        None => name.to_owned(),
        Some((end, _)) => format!("{}...", name.get(..end).unwrap_or_default()),
    }
}
