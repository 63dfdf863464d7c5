//! A node out of its links.

use crate::catalogue::Catalogue;
use crate::edit::Edit;
use crate::edit::NodeRecord;
use crate::edit::compound::{Plan, address, fit, input_wire, output_wire};
use crate::graph::{Graph, GraphError, Link, NodeId, Source};
use crate::interface::{GraphOutput, OutputSource};

/// Removes a node and closes its links again: what it fed is linked to what fed it, to the first of its inputs (in the
/// order of its kind) whose source has the very type, or else one that can be converted. Links that can't be closed
/// are remarked on.
///
/// # Errors
/// The node is gone.
pub fn dissolve(graph: &Graph, catalogue: &Catalogue, id: NodeId) -> Result<Plan, GraphError> {
    let node = graph.node(id).ok_or(GraphError::NoSuchNode)?;
    let declared = node.kind().map(|kind| kind.inputs()).unwrap_or_default();
    let place = |name: &str| declared.iter().position(|spec| spec.name == name).unwrap_or(usize::MAX);
    let mut sources: Vec<(&str, &Link)> = node
        .sources()
        .filter_map(|(input, source)| if let Source::Link(link) = source { Some((input, link)) } else { None })
        .collect();
    sources.sort_by_key(|(input, _)| place(input));
    let mut plan = Plan { edits: vec![Edit::RemoveNode(id)], ..Plan::default() };
    for outgoing in NodeRecord::outgoing_of(graph, id) {
        let wanted = input_wire(graph, outgoing.to, &outgoing.input);
        let fitting =
            sources.iter().filter_map(|(_, link)| Some((fit(catalogue, output_wire(graph, link), wanted)?, *link)));
        match fitting.min_by_key(|(fit, _)| *fit) {
            Some((_, link)) => {
                plan.edits.push(Edit::connect(link.node, &link.output, outgoing.to, &outgoing.input));
            }
            None => {
                let from = address(graph, &Link { node: id, output: outgoing.output });
                let to = graph.node(outgoing.to).map_or("", |node| node.name());
                let reason = format!("the link from \"{from}\" goes: nothing that fed \"{}\" fits here", node.name());
                plan.remark(to, &outgoing.input, reason);
            }
        }
    }
    for (name, output) in NodeRecord::promoted_of(graph, id) {
        let wanted = output_wire(graph, &Link { node: id, output });
        let same =
            sources.iter().map(|(_, link)| *link).find(|link| wanted.is_some() && output_wire(graph, link) == wanted);
        match (same, graph.output(&name)) {
            (Some(link), Some(output)) => {
                let output = Box::new(GraphOutput { from: OutputSource::Link(link.clone()), ..output.clone() });
                plan.edits.push(Edit::ChangeOutput { name, output });
            }
            _ => plan.remark(node.name(), &name, format!("the graph's output \"{name}\" comes from nothing then")),
        }
    }
    Ok(plan)
}
