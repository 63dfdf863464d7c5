//! A node into a link.

use crate::catalogue::Catalogue;
use crate::edit::compound::{Plan, address, fit, input_wire, output_wire};
use crate::edit::fresh_name::FreshNames;
use crate::edit::{Edit, NodeRecord};
use crate::graph::{Graph, GraphError, NodeId, Source};

/// Why a node can't be inserted.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum InsertError {
    /// The node is gone, or the kind is unknown.
    #[error(transparent)]
    Graph(#[from] GraphError),
    /// There is no link.
    #[error("node \"{node}\", input \"{input}\": no link is there to insert a node into")]
    NotLinked {
        /// The node.
        node: String,
        /// Its input.
        input: String,
    },
    /// Nothing of the kind takes what the link brings.
    #[error("no input of {kind} takes what \"{from}\" gives")]
    NoInput {
        /// The kind.
        kind: String,
        /// Where the link comes from.
        from: String,
    },
    /// Nothing of the kind gives what the link must bring.
    #[error("no output of {kind} fits input \"{input}\" of node \"{node}\"")]
    NoOutput {
        /// The kind.
        kind: String,
        /// The node.
        node: String,
        /// Its input.
        input: String,
    },
}

/// Inserts a new node of that kind into the link that enters `input` of `to`. It takes the first input and the first
/// output of the very type, or else the first that a conversion leads to or from; it is named after its kind and
/// stands between the two.
///
/// # Errors
/// No such node, kind or link; nothing of the kind fits.
pub fn insert_into_link(
    graph: &Graph,
    catalogue: &Catalogue,
    to: NodeId,
    input: &str,
    kind: &str,
) -> Result<Plan, InsertError> {
    let target = graph.node(to).ok_or(GraphError::NoSuchNode)?;
    let Some(Source::Link(link)) = target.source(input) else {
        return Err(InsertError::NotLinked { node: target.name().to_owned(), input: input.to_owned() });
    };
    let known = Graph::known_kind(catalogue, kind)?;
    let given = output_wire(graph, link);
    let taken = known.inputs().iter().filter_map(|spec| Some((fit(catalogue, given, Some(spec.wire))?, &spec.name)));
    // The first of the best: `min_by_key` gives the first of equals.
    let (_, entry) = taken
        .min_by_key(|(fit, _)| *fit)
        .ok_or_else(|| InsertError::NoInput { kind: kind.to_owned(), from: address(graph, link) })?;
    let wanted = input_wire(graph, to, input);
    let outputs =
        known.outputs().iter().filter_map(|spec| Some((fit(catalogue, Some(spec.wire), wanted)?, &spec.name)));
    let (_, exit) = outputs.min_by_key(|(fit, _)| *fit).ok_or_else(|| InsertError::NoOutput {
        kind: kind.to_owned(),
        node: target.name().to_owned(),
        input: input.to_owned(),
    })?;
    let id = graph.id_after(0);
    let mut record = NodeRecord::new(kind, FreshNames::new(graph).give(kind)).link(entry, link.node, &link.output);
    record.id = Some(id);
    let ends = (graph.node(link.node).and_then(|node| node.position()), target.position());
    if let (Some(from), Some(to)) = ends {
        record.position = Some([f64::midpoint(from[0], to[0]), f64::midpoint(from[1], to[1])]);
    }
    let edits = vec![Edit::AddNode(Box::new(record)), Edit::connect(id, exit, to, input)];
    Ok(Plan { edits, nodes: vec![id], remarks: Vec::new() })
}
