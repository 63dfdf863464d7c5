//! The order in which a graph evaluates, the same on every machine.

use std::collections::BTreeMap;

use maquette_graph::{Graph, NodeId, Source};

/// The nodes that these links come from, without repetition.
pub(super) fn linked_from(graph: &Graph, node: NodeId) -> Vec<NodeId> {
    let sources = graph.node(node).into_iter().flat_map(|n| n.sources());
    let mut from: Vec<_> =
        sources.filter_map(|(_, s)| if let Source::Link(link) = s { Some(link.node) } else { None }).collect();
    from.sort_unstable();
    from.dedup();
    from
}

/// The targets and all they depend on, each node behind those that it takes something from, otherwise in the order of
/// the graph.
pub(super) fn evaluation_order(graph: &Graph, targets: &[NodeId]) -> Vec<NodeId> {
    let needed = graph.upstream(targets);
    let mut missing: BTreeMap<NodeId, usize> = BTreeMap::new();
    let mut feeds: BTreeMap<NodeId, Vec<NodeId>> = BTreeMap::new();
    for id in &needed {
        let from = linked_from(graph, *id);
        missing.insert(*id, from.len());
        for source in from {
            feeds.entry(source).or_default().push(*id);
        }
    }
    let mut ready: std::collections::BTreeSet<NodeId> = needed.iter().copied().filter(|id| missing[id] == 0).collect();
    let mut order = Vec::with_capacity(needed.len());
    while let Some(id) = ready.pop_first() {
        order.push(id);
        for next in feeds.get(&id).into_iter().flatten() {
            if let Some(count) = missing.get_mut(next) {
                *count -= 1;
                if *count == 0 {
                    ready.insert(*next);
                }
            }
        }
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sources_come_first_whatever_the_order_of_the_file() {
        let catalogue = maquette_nodes::catalogue().unwrap();
        let mut graph = Graph::new();
        let last = graph.add(&catalogue, "curves-out", "last").unwrap();
        let even = graph.add(&catalogue, "resample", "even").unwrap();
        let first = graph.add(&catalogue, "sketch", "first").unwrap();
        let unused = graph.add(&catalogue, "sketch", "unused").unwrap();
        graph.connect(&catalogue, first, "curves", even, "curves").unwrap();
        graph.connect(&catalogue, even, "curves", last, "curves").unwrap();
        assert_eq!(evaluation_order(&graph, &[last]), [first, even, last]);
        assert_eq!(evaluation_order(&graph, &[last, unused]), [first, even, last, unused].map(|id| id));
        assert_eq!(linked_from(&graph, even), [first]);
    }
}
