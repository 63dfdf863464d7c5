//! Copies of nodes within their graph.

use std::collections::BTreeMap;

use crate::edit::compound::Plan;
use crate::edit::fresh_name::FreshNames;
use crate::edit::{Edit, NodeRecord};
use crate::graph::{Graph, GraphError, Link, NodeId, Source};

/// What becomes of links from nodes that are not copied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Incoming {
    /// The copies have them too.
    Keep,
    /// The inputs of the copies are at their defaults.
    Drop,
}

/// Copies nodes under fresh names ("rail" becomes "rail 2"), with the links among them, moved by `offset`. A node that
/// is named twice is copied once.
///
/// # Errors
/// A node is gone.
pub fn duplicate(graph: &Graph, nodes: &[NodeId], incoming: Incoming, offset: [f64; 2]) -> Result<Plan, GraphError> {
    let mut copies = Vec::new();
    let mut selected = nodes.to_vec();
    selected.sort_unstable();
    selected.dedup();
    for id in &selected {
        copies.push(NodeRecord::of_node(graph.node(*id).ok_or(GraphError::NoSuchNode)?));
    }
    let new_ids: BTreeMap<NodeId, NodeId> = (0..).zip(&selected).map(|(i, id)| (*id, graph.id_after(i))).collect();
    Ok(add_all(graph, copies, offset, |link| match new_ids.get(&link.node) {
        Some(id) => Some(Link { node: *id, output: link.output.clone() }),
        None => (incoming == Incoming::Keep).then(|| link.clone()),
    }))
}

/// Adds nodes under the next identities and fresh names, all before the links among them, because any of them may come
/// first. `relink` says where a link comes from in this graph.
pub(super) fn add_all(
    graph: &Graph,
    records: Vec<NodeRecord>,
    offset: [f64; 2],
    relink: impl Fn(&Link) -> Option<Link>,
) -> Plan {
    let mut plan = Plan::default();
    let mut names = FreshNames::new(graph);
    let mut links = Vec::new();
    for (i, mut record) in (0..).zip(records) {
        let id = graph.id_after(i);
        record.id = Some(id);
        record.name = names.give(&record.name);
        record.shift(offset);
        for (input, source) in std::mem::take(&mut record.inputs) {
            if let Source::Link(link) = source {
                links.extend(relink(&link).map(|link| Edit::connect(link.node, link.output, id, input)));
            } else {
                record.inputs.insert(input, source);
            }
        }
        plan.nodes.push(id);
        plan.edits.push(Edit::AddNode(Box::new(record)));
    }
    plan.edits.extend(links);
    plan
}
