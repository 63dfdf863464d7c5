//! **Join**: several lists of curves become one.

use maquette_graph::{NodeError, NodeKind, OptionalInput};

use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare("join", 1, "curve", "Joins several lists of curves into one, in order.");
    let lists: Vec<OptionalInput<wire::Curves>> = ["a", "b", "c", "d", "e", "f", "g", "h"]
        .iter()
        .map(|name| node.optional(name, "A list of curves; may be left unconnected."))
        .collect();
    let joined = node.output::<wire::Curves>("curves", "All curves: those of a, then those of b, and so on.");
    node.evaluate(move |ports| {
        let connected: Vec<_> = lists.iter().filter_map(|list| ports.read_optional(*list)).collect();
        if connected.is_empty() {
            return Err(NodeError::new("nothing is connected: link at least one list of curves"));
        }
        let curves = connected.iter().flat_map(|list| list.0.iter().cloned()).collect();
        ports.write(joined, wire::Curves(curves));
        Ok(())
    });
    node
}
