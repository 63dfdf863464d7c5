//! **Join borders**: several lists of borders become one.

use maquette_graph::{NodeError, NodeKind, OptionalInput};

use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "join-borders",
        1,
        "curve",
        "Joins several lists of borders into one, in order: what a surface between several others continues.",
    );
    node.reference("paper 5.2.4");
    let lists: Vec<OptionalInput<wire::Borders>> = ["a", "b", "c", "d", "e", "f", "g", "h"]
        .iter()
        .map(|name| node.optional(name, "A list of borders; may be left unconnected."))
        .collect();
    let joined = node.output::<wire::Borders>("borders", "All borders: those of a, then those of b, and so on.");
    node.evaluate(move |ports| {
        let connected: Vec<_> = lists.iter().filter_map(|list| ports.read_optional(*list)).collect();
        if connected.is_empty() {
            return Err(NodeError::new("nothing is connected: link at least one list of borders"));
        }
        ports.write(joined, wire::Borders(connected.iter().flat_map(|list| list.0.iter().cloned()).collect()));
        Ok(())
    });
    node
}
