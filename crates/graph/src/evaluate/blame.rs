//! Which nodes are to blame where one has to wait.

use std::collections::HashSet;

use crate::graph::NodeId;
use crate::value::KeyHasherBuilder;

/// The failed nodes behind missing inputs, each once, in the order of the inputs.
#[derive(Default)]
pub(crate) struct Blame {
    nodes: Vec<NodeId>,
    seen: HashSet<NodeId, KeyHasherBuilder>,
}

impl Blame {
    pub(crate) fn add(&mut self, nodes: &[NodeId]) {
        self.nodes.extend(nodes.iter().filter(|node| self.seen.insert(**node)));
    }

    /// The nodes; `None` where nobody is to blame.
    pub(crate) fn into_nodes(self) -> Option<Vec<NodeId>> {
        (!self.nodes.is_empty()).then_some(self.nodes)
    }
}
