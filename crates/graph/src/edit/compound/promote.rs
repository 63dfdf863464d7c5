//! An input as a parameter of the graph.

use crate::edit::Edit;
use crate::edit::compound::Plan;
use crate::graph::{Graph, GraphError, NodeId, Source};
use crate::parameter::Parameter;

/// Why an input can't be promoted.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PromoteError {
    /// The node is gone, or its kind has no such input.
    #[error(transparent)]
    Graph(#[from] GraphError),
    /// Something else drives it.
    #[error("node \"{node}\", input \"{input}\": {holds} drives it; remove that first")]
    Driven {
        /// The node.
        node: String,
        /// Its input.
        input: String,
        /// A link, another parameter, or text that is not understood.
        holds: &'static str,
    },
    /// The kind of the node is unknown.
    #[error("the kind of \"{0}\" is unknown, so that its inputs can't be promoted")]
    Placeholder(String),
}

/// Declares a parameter that is what the input is, with its value, ranges and description, and lets it drive the input.
/// The parameter is named as the input; where that name is taken, as the node and the input.
///
/// # Errors
/// No such node or input; a link or a parameter drives it already.
pub fn promote(graph: &Graph, id: NodeId, input: &str) -> Result<Plan, PromoteError> {
    let node = graph.node(id).ok_or(GraphError::NoSuchNode)?;
    let kind = node.kind().ok_or_else(|| PromoteError::Placeholder(node.name().to_owned()))?;
    let spec = kind.find_input(input).ok_or_else(|| graph.no_such_input(node, kind, input))?;
    let driven = |holds| PromoteError::Driven { node: node.name().to_owned(), input: input.to_owned(), holds };
    let value = match node.source(input) {
        None => spec.default.clone(),
        Some(Source::Literal { literal, .. }) => Some(literal.clone()),
        Some(Source::Link(_)) => return Err(driven("a link")),
        Some(Source::Parameter(_)) => return Err(driven("a parameter")),
        Some(Source::Unread(_)) => return Err(driven("text that is not understood")),
    };
    let name = free_name(input, |name| graph.parameter(name).is_some(), node.name());
    let parameter = Parameter::of_input(&name, spec).value_of(value);
    let index = graph.parameters().len();
    let edits = vec![
        Edit::AddParameter { index, parameter: Box::new(parameter) },
        Edit::UseParameter { node: id, input: input.to_owned(), parameter: name },
    ];
    Ok(Plan { edits, nodes: vec![id], remarks: Vec::new() })
}

/// The wanted name, or one with the node before it, or one with a number behind.
pub(super) fn free_name(wanted: &str, is_taken: impl Fn(&str) -> bool, node: &str) -> String {
    let short = |text: &str| text.chars().take(90).collect::<String>().trim().to_owned();
    let wanted = if wanted.is_empty() { "port".to_owned() } else { short(wanted) };
    let with_node = format!("{} {wanted}", short(node));
    let numbered = (2_u64..).map(|number| format!("{with_node} {number}"));
    let mut candidates = [wanted, with_node.clone()].into_iter().chain(numbered);
    candidates.find(|name| !is_taken(name)).unwrap_or(with_node)
}
