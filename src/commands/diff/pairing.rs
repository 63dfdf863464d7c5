//! Which node of one graph is which node of another.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use maquette_graph::{Graph, NodeId};

use super::input::{Held, default_hash, held};
use crate::commands::evaluation_order::linked_from;

/// Nodes of two graphs, side by side.
pub(super) struct Pairing {
    /// Nodes that are in both, in the order of the second graph.
    pub(super) both: Vec<(NodeId, NodeId)>,
    /// Nodes of the first graph alone.
    pub(super) removed: Vec<NodeId>,
    /// Nodes of the second graph alone.
    pub(super) added: Vec<NodeId>,
    /// From the first graph to the second.
    pub(super) second_of: BTreeMap<NodeId, NodeId>,
}

/// Among so many alike nodes, the one whose result is used alike is looked for; beyond, their order decides.
const MOST_COMPARED: usize = 64;

/// Pairs nodes of one name; then, from the sources down, those of one kind whose inputs hold the same.
///
/// Linear in nodes and links, but for nodes that are alike.
pub(super) fn pair(first: &Graph, second: &Graph) -> Pairing {
    let mut second_of: BTreeMap<NodeId, NodeId> = BTreeMap::new();
    for (id, node) in first.nodes() {
        if let Some(other) = second.find(node.name()) {
            second_of.insert(id, other);
        }
    }
    let mut first_of: BTreeMap<NodeId, NodeId> = second_of.iter().map(|(a, b)| (*b, *a)).collect();
    let mut one = Side::new(first, |id| second_of.contains_key(&id));
    let mut two = Side::new(second, |id| first_of.contains_key(&id));
    loop {
        let mut touched = BTreeSet::new();
        one.offer(&mut touched, |id| second_of.get(&id).copied());
        two.offer(&mut touched, Some);
        let mut settled = Vec::new();
        for signature in touched {
            let (Some(left), Some(right)) = (one.alike.get_mut(&signature), two.alike.get_mut(&signature)) else {
                continue;
            };
            while let Some((a, b)) = best(first, second, left, right, &second_of) {
                left.retain(|id| *id != a);
                right.retain(|id| *id != b);
                second_of.insert(a, b);
                first_of.insert(b, a);
                settled.push((a, b));
            }
        }
        if settled.is_empty() {
            break;
        }
        for (a, b) in settled {
            one.settle(a);
            two.settle(b);
        }
    }
    let both = second.nodes().filter_map(|(b, _)| Some((*first_of.get(&b)?, b))).collect();
    let removed = first.nodes().map(|(id, _)| id).filter(|id| !second_of.contains_key(id)).collect();
    let added = second.nodes().map(|(id, _)| id).filter(|id| !first_of.contains_key(id)).collect();
    Pairing { both, removed, added, second_of }
}

/// The pair that is used most alike; the first one of several.
fn best(
    first: &Graph,
    second: &Graph,
    left: &[NodeId],
    right: &[NodeId],
    second_of: &BTreeMap<NodeId, NodeId>,
) -> Option<(NodeId, NodeId)> {
    let plain = (*left.first()?, *right.first()?);
    if left.len() * right.len() == 1 || left.len() * right.len() > MOST_COMPARED {
        return Some(plain);
    }
    let uses = |a: NodeId, b: NodeId| {
        let there: BTreeSet<_> = second.fed_by(b).into_iter().collect();
        let used = first.fed_by(a).into_iter();
        used.filter_map(|(to, input)| Some((*second_of.get(&to)?, input))).filter(|use_| there.contains(use_)).count()
    };
    let mut best = (plain, uses(plain.0, plain.1));
    for a in left {
        for b in right {
            let count = uses(*a, *b);
            if count > best.1 {
                best = ((*a, *b), count);
            }
        }
    }
    Some(best.0)
}

/// The nodes of one graph that have no partner yet.
struct Side<'a> {
    graph: &'a Graph,
    /// For each, how many of the nodes that it takes something from have no partner yet.
    missing: BTreeMap<NodeId, usize>,
    /// Those whose sources all have partners, not yet offered.
    ready: Vec<NodeId>,
    /// Those that were offered, by what they are.
    alike: HashMap<String, Vec<NodeId>>,
}

impl<'a> Side<'a> {
    fn new(graph: &'a Graph, is_paired: impl Fn(NodeId) -> bool) -> Self {
        let alone = graph.nodes().map(|(id, _)| id).filter(|id| !is_paired(*id));
        let missing: BTreeMap<_, _> = alone
            .map(|id| (id, linked_from(graph, id).into_iter().filter(|source| !is_paired(*source)).count()))
            .collect();
        let ready = missing.iter().filter(|(_, count)| **count == 0).map(|(id, _)| *id).collect();
        Self { graph, missing, ready, alike: HashMap::new() }
    }

    /// Sorts the ready nodes by what they are; `name` says by which node of the second graph a source is known.
    fn offer(&mut self, touched: &mut BTreeSet<String>, name: impl Fn(NodeId) -> Option<NodeId>) {
        for id in std::mem::take(&mut self.ready) {
            let signature = signature(self.graph, id, &name);
            touched.insert(signature.clone());
            self.alike.entry(signature).or_default().push(id);
        }
    }

    /// A node has found its partner; what takes something from it may be ready.
    fn settle(&mut self, id: NodeId) {
        self.missing.remove(&id);
        let fed: BTreeSet<NodeId> = self.graph.fed_by(id).into_iter().map(|(to, _)| to).collect();
        for to in fed {
            if let Some(count) = self.missing.get_mut(&to) {
                *count -= 1;
                if *count == 0 {
                    self.ready.push(to);
                }
            }
        }
    }
}

/// Kind and inputs of a node as text: the same for nodes that give the same.
fn signature(graph: &Graph, id: NodeId, name: impl Fn(NodeId) -> Option<NodeId>) -> String {
    let Some(node) = graph.node(id) else { return String::new() };
    let inputs: Vec<String> = node
        .sources()
        .filter_map(|(input, _)| match held(node, input) {
            Held::Link(link) => Some(format!("{input:?} link {:?}.{:?}", name(link.node), link.output)),
            Held::Parameter(name) => Some(format!("{input:?} parameter {name:?}")),
            Held::Unread(text) => Some(format!("{input:?} text {text:?}")),
            // Written out or not, a default is the same.
            Held::Literal(_, hash) => (default_hash(node, input) != Some(hash)).then(|| format!("{input:?} {hash}")),
            Held::Nothing => None,
        })
        .collect();
    let body = node.body().map(|body| body.content().to_string()).unwrap_or_default();
    format!("{:?} {inputs:?} {body} {}", node.kind_name(), node.is_muted())
}
