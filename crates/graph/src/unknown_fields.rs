//! What a file holds beyond what this version knows, for those who compare graphs.

use crate::graph::{Graph, Node};

impl Node {
    /// Fields of the file that this version does not know: name and text, in the order of the file.
    pub fn unknown_fields(&self) -> impl ExactSizeIterator<Item = (&str, &str)> {
        self.unknown_fields.iter().map(|(name, text)| (name.as_str(), text.as_str()))
    }
}

impl Graph {
    /// Top-level fields of the file that this version does not know: name and text, in the order of the file.
    pub fn unknown_fields(&self) -> impl ExactSizeIterator<Item = (&str, &str)> {
        self.unknown_fields.iter().map(|(name, text)| (name.as_str(), text.as_str()))
    }
}
