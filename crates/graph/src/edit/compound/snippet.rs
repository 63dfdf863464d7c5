//! Copy and paste: nodes as the text of a graph.

use std::collections::{BTreeMap, BTreeSet};

use crate::catalogue::Catalogue;
use crate::edit::NodeRecord;
use crate::edit::compound::{Plan, Remark, duplicate::add_all};
use crate::file::{self, FileError, Includes, Spelled};
use crate::graph::{Graph, GraphError, Link, Node, NodeId, Source};

/// Why a text can't be pasted.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PasteError {
    /// It is no graph.
    #[error("the clipboard holds no nodes: {0}")]
    File(#[from] FileError),
    /// It has no nodes.
    #[error("the clipboard holds a graph without nodes: copy some nodes first")]
    Empty,
}

/// Nodes as `.ron` text: a graph of its own in which links to nodes that are not copied stay by name, with the parameters
/// that the nodes use. For the clipboard, a mail, or a file.
///
/// # Errors
/// A node is gone.
pub fn copy(graph: &Graph, nodes: &[NodeId]) -> Result<String, GraphError> {
    if nodes.iter().any(|id| graph.node(*id).is_none()) {
        return Err(GraphError::NoSuchNode);
    }
    Ok(file::selection_to_text(graph, &nodes.iter().copied().collect::<BTreeSet<_>>()))
}

/// Adds the nodes of a text under fresh names, moved by `offset`. Links among them follow; a link to a node outside is
/// kept if this graph has a node of that name that fits, or else dropped with a remark. Unknown kinds come as
/// placeholders, and what could not be read stays as it is. An input that holds a parameter keeps it if this graph has one
/// of that name that fits, or else gets the parameter's value.
///
/// # Errors
/// The text is no graph, or has no nodes.
pub fn paste(graph: &Graph, catalogue: &Catalogue, text: &str, offset: [f64; 2]) -> Result<Plan, PasteError> {
    paste_with(graph, catalogue, text, offset, &Includes::none())
}

/// As [`paste`], for nodes whose bodies may be files; paths start at the folder of this graph. With [`paste`] such nodes
/// come as placeholders that keep the name of the file.
///
/// # Errors
/// As [`paste`].
pub fn paste_with(
    graph: &Graph,
    catalogue: &Catalogue,
    text: &str,
    offset: [f64; 2],
    includes: &Includes<'_>,
) -> Result<Plan, PasteError> {
    let source = file::from_text_with(catalogue, text, includes)?.graph;
    if source.nodes().len() == 0 {
        return Err(PasteError::Empty);
    }
    // Links to nodes outside could not be resolved by the reader, and are still text. As links, they come from nodes
    // of this graph; identities of both graphs overlap, so those are kept apart.
    let mut records = Vec::new();
    let mut outside = Vec::new();
    let mut remarks = Vec::new();
    for (index, (_, node)) in source.nodes().enumerate() {
        let mut record = NodeRecord::of_node(node);
        record.inputs.retain(|input, held| {
            let remark = |message| Remark { node: node.name().to_owned(), input: input.clone(), message };
            let spelled = match held {
                Source::Unread(text) => file::parse(text).ok(),
                Source::Parameter(name) => Some(Spelled::Parameter(name.clone())),
                Source::Literal { .. } | Source::Link(_) => None,
            };
            let address = match spelled {
                Some(Spelled::Link(address)) => address,
                Some(Spelled::Parameter(name)) => {
                    return match parameter(graph, catalogue, &source, node, input, &name) {
                        Ok(found) => {
                            *held = found;
                            true
                        }
                        Err(reason) => {
                            remarks.push(remark(format!("the parameter \"{name}\" goes: {reason}")));
                            false
                        }
                    };
                }
                Some(Spelled::Literal(_)) | None => return true,
            };
            match resolve(
                graph,
                catalogue,
                &source,
                node.kind().and_then(|k| Some(k.find_input(input)?.wire)),
                &address,
            ) {
                Ok(link) if node.kind().is_none_or(|kind| kind.find_input(input).is_some()) => {
                    outside.push((index, input.clone(), link));
                }
                Ok(_) => remarks.push(remark(format!(
                    "the link from \"{address}\" is dropped: {} has no such input",
                    node.kind_name()
                ))),
                Err(reason) => remarks.push(remark(format!("the link from \"{address}\" is dropped: {reason}"))),
            }
            false
        });
        records.push(record);
    }
    let new_ids: BTreeMap<NodeId, NodeId> =
        (0..).zip(source.nodes()).map(|(i, (id, _))| (id, graph.id_after(i))).collect();
    let mut plan = add_all(graph, records, offset, |link| {
        Some(Link { node: *new_ids.get(&link.node)?, output: link.output.clone() })
    });
    for (index, input, link) in outside {
        if let Some(to) = plan.nodes.get(index) {
            plan.edits.push(crate::Edit::connect(link.node, link.output, *to, input));
        }
    }
    plan.remarks = remarks;
    Ok(plan)
}

/// What an input of a snippet that holds a parameter is to hold here, or why nothing.
fn parameter(
    graph: &Graph,
    catalogue: &Catalogue,
    snippet: &Graph,
    node: &Node,
    input: &str,
    name: &str,
) -> Result<Source, String> {
    let spec = match node.kind() {
        Some(kind) => Some(kind.find_input(input).ok_or_else(|| format!("{} has no such input", kind.name()))?),
        None => None,
    };
    let fits = |wire| spec.is_none_or(|spec| catalogue.fits(wire, spec.wire));
    if graph.parameter(name).is_some_and(|parameter| fits(parameter.wire())) {
        return Ok(Source::Parameter(name.to_owned()));
    }
    let value = snippet.parameter(name).and_then(|parameter| parameter.value());
    let value = value.ok_or("this graph has none of that name that fits, and it holds no value")?;
    match spec.map(|spec| (spec.refuses(value), spec.normal(value.clone()))) {
        Some((Some(reason), _)) => Err(reason),
        Some((None, value)) => Ok(Source::literal(value)),
        None => Ok(Source::literal(value.clone())),
    }
}

/// The output of this graph that an address of a snippet means, or why there is none.
fn resolve(
    graph: &Graph,
    catalogue: &Catalogue,
    snippet: &Graph,
    wanted: Option<crate::WireType>,
    address: &str,
) -> Result<Link, String> {
    let (name, output) = address.split_once('.').ok_or("it is not an address")?;
    if snippet.find(name).is_some() {
        return Err("it does not fit".to_owned());
    }
    let id = graph.find(name).ok_or_else(|| format!("no node is named \"{name}\" here"))?;
    let link = Link { node: id, output: output.to_owned() };
    let Some(kind) = graph.node(id).and_then(|node| node.kind()) else { return Ok(link) };
    let (_, spec) = kind.find_output(output).ok_or_else(|| format!("{} has no such output here", kind.name()))?;
    match wanted {
        Some(wanted) if !catalogue.fits(spec.wire, wanted) => {
            Err(format!("it gives {} here, and {wanted} is needed", spec.wire))
        }
        _ => Ok(link),
    }
}
