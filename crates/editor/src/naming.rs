//! Names for new nodes.

use maquette_graph::Graph;

/// The name itself where no node has it, or else with the first number from 2 that is free.
pub(crate) fn free_name(graph: &Graph, wanted: &str) -> String {
    if graph.find(wanted).is_none() {
        return wanted.to_owned();
    }
    let numbered = (2..=graph.nodes().len() + 2).map(|number| format!("{wanted} {number}"));
    // Among more names than there are nodes one is free.
    numbered.into_iter().find(|name| graph.find(name).is_none()).unwrap_or_else(|| wanted.to_owned())
}
