//! Plans of more than one edit: insert, replace, dissolve, duplicate, copy and paste, group and ungroup, promote.
//!
//! Each function looks at a graph without changing it and gives a [`Plan`]: edits to be made one step with
//! [`crate::History::step`] (or [`Graph::apply_all`]), the nodes that come of it, and what can't be kept, to be told to
//! the artist. A plan holds for the graph as it is; where the graph changed since, applying it may fail, and then
//! changes nothing.

mod dissolve;
mod duplicate;
mod group;
mod insert;
mod promote;
mod replace;
mod snippet;
mod ungroup;

pub use dissolve::dissolve;
pub use duplicate::{Incoming, duplicate};
pub use group::{GroupError, group};
pub use insert::{InsertError, insert_into_link};
pub use promote::{PromoteError, promote};
pub use replace::replace_kind;
pub use snippet::{PasteError, copy, paste, paste_with};
pub use ungroup::{UngroupError, ungroup};

use std::fmt;

use crate::catalogue::Catalogue;
use crate::edit::Edit;
use crate::graph::{Graph, Link, NodeId};
use crate::value::WireType;

/// What is to be done, and what will be lost by it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plan {
    /// The edits, in their order.
    pub edits: Vec<Edit>,
    /// The nodes that are added or replaced, to be selected afterwards.
    pub nodes: Vec<NodeId>,
    /// What can't be kept as it was.
    pub remarks: Vec<Remark>,
}

/// Something that a plan does not keep as it was.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Remark {
    /// The node.
    pub node: String,
    /// Its input.
    pub input: String,
    /// What happens to what is there, and why.
    pub message: String,
}

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "node \"{}\", input \"{}\": {}", self.node, self.input, self.message)
    }
}

impl Plan {
    fn remark(&mut self, node: &str, input: &str, message: impl Into<String>) {
        self.remarks.push(Remark { node: node.to_owned(), input: input.to_owned(), message: message.into() });
    }
}

/// Type of an output; `None` for an output of a placeholder, or one that does not exist.
fn output_wire(graph: &Graph, link: &Link) -> Option<WireType> {
    Some(graph.node(link.node)?.kind()?.find_output(&link.output)?.1.wire)
}

/// Type of an input; `None` for an input of a placeholder, or one that does not exist.
fn input_wire(graph: &Graph, node: NodeId, input: &str) -> Option<WireType> {
    Some(graph.node(node)?.kind()?.find_input(input)?.wire)
}

/// How well a wire fits, the lower the better; `None` where it does not. What is not known may fit.
fn fit(catalogue: &Catalogue, from: Option<WireType>, to: Option<WireType>) -> Option<u8> {
    match (from, to) {
        (Some(from), Some(to)) if from == to => Some(0),
        (Some(from), Some(to)) => catalogue.fits(from, to).then_some(1),
        _ => Some(2),
    }
}

/// An output as messages write it.
fn address(graph: &Graph, link: &Link) -> String {
    format!("{}.{}", graph.node(link.node).map_or("", |node| node.name()), link.output)
}
