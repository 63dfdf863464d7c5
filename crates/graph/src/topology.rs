//! Which node feeds which: the acyclic skeleton of a graph, carried by petgraph, and an order of its nodes in which every
//! link goes forwards.
//!
//! The order is kept up to date link by link (D. J. Pearce, P. H. J. Kelly, *A dynamic topological sort algorithm for
//! directed acyclic graphs*, ACM JEA 11, 2007): most links agree with it, and then nothing is searched; one that does not
//! only touches the nodes that lie between its ends.

use std::collections::HashMap;

use petgraph::Direction;
use petgraph::stable_graph::{NodeIndex, StableDiGraph};
use petgraph::visit::EdgeRef;

use crate::graph::{ConnectError, Graph, Link, NodeId, Source};
use crate::value::KeyHasherBuilder;

/// Links between nodes, one edge per link, labelled with the input it enters. Always acyclic.
#[derive(Clone, Debug, Default)]
pub(crate) struct Topology {
    links: StableDiGraph<NodeId, String>,
    places: HashMap<NodeId, NodeIndex, KeyHasherBuilder>,
    /// By index of the node: its rank in the order. Ranks of nodes that are there are all different.
    ranks: Vec<usize>,
    next_rank: usize,
}

/// Whether a link would close a cycle.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Closes {
    Nothing,
    /// The nodes from the link's end to its beginning, both included.
    Cycle(Vec<NodeId>),
    /// The search took too long.
    Unknown,
}

impl Topology {
    pub(crate) fn add(&mut self, node: NodeId) {
        let place = self.links.add_node(node);
        self.places.insert(node, place);
        if self.ranks.len() <= place.index() {
            self.ranks.resize(place.index() + 1, 0);
        }
        // Nodes that went leave gaps, which searches must step over.
        if self.next_rank > 4 * self.links.node_count() + 1_000 {
            self.close_gaps();
        }
        self.ranks[place.index()] = self.next_rank;
        self.next_rank += 1;
    }

    /// Numbers the ranks anew, in the same order.
    fn close_gaps(&mut self) {
        let mut places: Vec<NodeIndex> = self.links.node_indices().collect();
        places.sort_unstable_by_key(|place| self.rank(*place));
        for (rank, place) in places.iter().enumerate() {
            self.ranks[place.index()] = rank;
        }
        self.next_rank = places.len();
    }

    pub(crate) fn remove(&mut self, node: NodeId) {
        if let Some(place) = self.places.remove(&node) {
            self.links.remove_node(place);
        }
    }

    fn rank(&self, place: NodeIndex) -> usize {
        self.ranks[place.index()]
    }

    /// Whether a link `from -> to` would close a cycle. Every link that is looked at takes one from `patience`.
    pub(crate) fn closed_by(&self, from: NodeId, to: NodeId, patience: &mut usize) -> Closes {
        let (Some(&from), Some(&to)) = (self.places.get(&from), self.places.get(&to)) else { return Closes::Nothing };
        if from == to {
            return Closes::Cycle(vec![self.links[to]]);
        }
        if self.rank(from) < self.rank(to) {
            return Closes::Nothing;
        }
        match self.between(to, from, Direction::Outgoing, patience) {
            None => Closes::Unknown,
            Some(reached) if !reached.contains(&from) => Closes::Nothing,
            Some(_) => {
                // Whether there is a path is found much faster than the shortest one, and mostly there is none.
                let path = petgraph::algo::astar(&self.links, to, |n| n == from, |_| 1, |_| 0);
                let path: Vec<_> = path.map(|(_, path)| path).unwrap_or_default();
                *patience = patience.saturating_sub(self.links.edge_count());
                Closes::Cycle(path.into_iter().map(|place| self.links[place]).collect())
            }
        }
    }

    /// The nodes that are reached from `start` without passing beyond the rank of `limit`, in no order; `None` where
    /// more links than `patience` had to be looked at.
    fn between(
        &self,
        start: NodeIndex,
        limit: NodeIndex,
        direction: Direction,
        patience: &mut usize,
    ) -> Option<Vec<NodeIndex>> {
        let [first, last] = [self.rank(start), self.rank(limit)];
        // Ranks are all different, so that a bit for each tells whether its node was reached.
        let mut seen = vec![0_u64; first.abs_diff(last) / 64 + 1];
        let mut is_new = |place| {
            let rank: usize = self.rank(place);
            let within = match direction {
                Direction::Outgoing => rank <= last,
                Direction::Incoming => rank >= last,
            };
            let bit = rank.abs_diff(first);
            // What lies beyond the limit is not asked for.
            within
                && seen.get_mut(bit / 64).is_some_and(|bits| {
                    let before = *bits;
                    *bits |= 1 << (bit % 64);
                    *bits != before
                })
        };
        let mut reached = vec![start];
        let mut next = 0;
        while let Some(place) = reached.get(next).copied() {
            next += 1;
            for neighbour in self.links.neighbors_directed(place, direction) {
                *patience = patience.checked_sub(1)?;
                if is_new(neighbour) {
                    reached.push(neighbour);
                }
            }
        }
        Some(reached)
    }

    /// For each of these links, whether it can't be part of a cycle if all of them are added. In time proportional to
    /// the number of links, where asking link by link would search the graph for each.
    pub(crate) fn harmless(&self, links: impl Iterator<Item = (NodeId, NodeId)> + Clone) -> Vec<bool> {
        let mut together = self.links.map(|_, _| (), |_, _| ());
        let place = |id: NodeId| self.places.get(&id).copied();
        for (from, to) in links.clone() {
            if let (Some(from), Some(to)) = (place(from), place(to)) {
                together.add_edge(from, to, ());
            }
        }
        // Every cycle lies within one strongly connected component.
        let components = petgraph::algo::kosaraju_scc(&together);
        let members = components.iter().enumerate().flat_map(|(c, nodes)| nodes.iter().map(move |node| (*node, c)));
        let component: HashMap<NodeIndex, usize, KeyHasherBuilder> = members.collect();
        let component = |id: NodeId| place(id).and_then(|place| component.get(&place).copied());
        links.map(|(from, to)| from != to && component(from) != component(to)).collect()
    }

    /// Adds a link; the caller has made sure that it closes no cycle.
    pub(crate) fn link(&mut self, from: NodeId, to: NodeId, input: &str) {
        let (Some(&from), Some(&to)) = (self.places.get(&from), self.places.get(&to)) else { return };
        if self.rank(from) > self.rank(to) {
            self.bring_before(from, to);
        }
        self.links.add_edge(from, to, input.to_owned());
    }

    /// Adds links that close no cycle all together, in time proportional to their number.
    pub(crate) fn link_all<'a>(&mut self, links: impl Iterator<Item = (NodeId, NodeId, &'a str)>) {
        for (from, to, input) in links {
            if let (Some(from), Some(to)) = (self.places.get(&from), self.places.get(&to)) {
                self.links.add_edge(*from, *to, input.to_owned());
            }
        }
        // The caller has made sure that there is an order.
        for (rank, place) in petgraph::algo::toposort(&self.links, None).unwrap_or_default().into_iter().enumerate() {
            self.ranks[place.index()] = rank;
        }
        self.next_rank = self.links.node_count();
    }

    /// Changes the order so that `from` and what leads to it comes before `to` and what comes of it. No path leads from
    /// `to` to `from`.
    fn bring_before(&mut self, from: NodeIndex, to: NodeIndex) {
        let mut patience = usize::MAX;
        let mut ahead = self.between(from, to, Direction::Incoming, &mut patience).unwrap_or_default();
        let mut behind = self.between(to, from, Direction::Outgoing, &mut patience).unwrap_or_default();
        ahead.sort_unstable_by_key(|place| self.rank(*place));
        behind.sort_unstable_by_key(|place| self.rank(*place));
        // The ranks that both have together, shared out anew.
        ahead.append(&mut behind);
        let mut ranks: Vec<usize> = ahead.iter().map(|place| self.rank(*place)).collect();
        ranks.sort_unstable();
        for (place, rank) in ahead.into_iter().zip(ranks) {
            self.ranks[place.index()] = rank;
        }
    }

    pub(crate) fn unlink(&mut self, to: NodeId, input: &str) {
        let Some(place) = self.places.get(&to) else { return };
        let edge = self.links.edges_directed(*place, Direction::Incoming).find(|e| e.weight() == input).map(|e| e.id());
        if let Some(edge) = edge {
            self.links.remove_edge(edge);
        }
    }

    /// The inputs that a node feeds, in the order of their nodes.
    pub(crate) fn fed_by(&self, node: NodeId) -> Vec<(NodeId, String)> {
        let Some(place) = self.places.get(&node) else { return Vec::new() };
        let mut fed: Vec<_> = self
            .links
            .edges_directed(*place, Direction::Outgoing)
            .map(|edge| (self.links[edge.target()], edge.weight().clone()))
            .collect();
        fed.sort();
        fed
    }

    /// The nodes that a node feeds, unordered, one entry per link.
    pub(crate) fn dependents(&self, node: NodeId) -> impl Iterator<Item = NodeId> + '_ {
        let place = self.places.get(&node).copied();
        place.into_iter().flat_map(|p| self.links.neighbors_directed(p, Direction::Outgoing)).map(|n| self.links[n])
    }
}

impl Graph {
    /// Whether a link would close a cycle.
    pub(crate) fn check_acyclic(&self, from: NodeId, to: NodeId) -> Result<(), ConnectError> {
        match self.cycle_closed_by(from, to, &mut usize::MAX.clone()) {
            None | Some(Ok(())) => Ok(()),
            Some(Err(cycle)) => Err(cycle),
        }
    }

    /// As [`Graph::check_acyclic`]; `None` where more links would have to be looked at than `patience` allows.
    pub(crate) fn cycle_closed_by(
        &self,
        from: NodeId,
        to: NodeId,
        patience: &mut usize,
    ) -> Option<Result<(), ConnectError>> {
        match self.topology.closed_by(from, to, patience) {
            Closes::Nothing => Some(Ok(())),
            Closes::Unknown => None,
            Closes::Cycle(path) => {
                let names = path.iter().chain(path.first()).filter_map(|id| self.nodes.get(id));
                Some(Err(ConnectError::Cycle(names.map(|n| n.name.clone()).collect())))
            }
        }
    }

    /// Puts links that were checked to fit and to close no cycle all together: to the node, its input, from where.
    pub(crate) fn put_links(&mut self, links: Vec<(NodeId, String, Link)>) {
        for (to, input, _) in &links {
            self.topology.unlink(*to, input);
        }
        self.topology.link_all(links.iter().map(|(to, input, link)| (link.node, *to, input.as_str())));
        for (to, input, link) in links {
            if let Some(node) = self.nodes.get_mut(&to) {
                node.inputs.insert(input, Source::Link(link));
            }
            self.touch(to);
        }
    }

    /// For each of these links, whether it can't be part of a cycle if all of them are added.
    pub(crate) fn harmless(&self, links: impl Iterator<Item = (NodeId, NodeId)> + Clone) -> Vec<bool> {
        self.topology.harmless(links)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use petgraph::visit::IntoEdgeReferences as _;

    use super::*;

    /// Every link goes forwards, and no two nodes share a rank.
    fn assert_ordered(topology: &Topology) {
        for edge in topology.links.edge_references() {
            assert!(topology.rank(edge.source()) < topology.rank(edge.target()));
        }
        let ranks: HashSet<usize> = topology.links.node_indices().map(|place| topology.rank(place)).collect();
        assert_eq!(ranks.len(), topology.links.node_count());
    }

    #[test]
    fn the_order_holds_and_cycles_are_those_that_a_plain_search_finds() {
        let mut state = 1_u64;
        let mut below = |bound: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            u32::try_from((state >> 33) % bound).unwrap()
        };
        for _ in 0..40 {
            let mut topology = Topology::default();
            let mut nodes: Vec<NodeId> = (0..12).map(NodeId).collect();
            nodes.iter().for_each(|node| topology.add(*node));
            let mut refused = 0;
            for step in 0..200 {
                let [from, to] = [(); 2].map(|()| nodes[below(nodes.len() as u64) as usize]);
                match below(8) {
                    0 => {
                        topology.remove(from);
                        nodes.retain(|node| *node != from);
                        let new = NodeId(100 + step);
                        topology.add(new);
                        nodes.push(new);
                    }
                    1 => topology.unlink(to, "a"),
                    _ => {
                        let places = [from, to].map(|node| topology.places[&node]);
                        let cycle = petgraph::algo::has_path_connecting(&topology.links, places[1], places[0], None);
                        match topology.closed_by(from, to, &mut usize::MAX.clone()) {
                            Closes::Nothing => {
                                assert!(!cycle);
                                topology.link(from, to, "a");
                            }
                            Closes::Cycle(path) => {
                                assert!(cycle && path.first() == Some(&to) && path.last() == Some(&from));
                                refused += 1;
                            }
                            Closes::Unknown => panic!("there was no limit"),
                        }
                    }
                }
                assert_ordered(&topology);
            }
            assert!(refused > 10);
        }
    }

    #[test]
    fn ranks_stay_few_while_nodes_come_and_go() {
        let mut topology = Topology::default();
        for round in 0..10_000 {
            topology.add(NodeId(round));
            if round >= 10 {
                topology.link(NodeId(round), NodeId(round - 5), "a");
                topology.remove(NodeId(round - 10));
            }
            assert!(topology.next_rank <= 2_000);
        }
        assert_ordered(&topology);
    }

    #[test]
    fn links_added_together_are_ordered_too_and_patience_ends() {
        let mut topology = Topology::default();
        (0..100).map(NodeId).for_each(|node| topology.add(node));
        let links: Vec<_> = (1..100).map(|i| (NodeId(i), NodeId(i - 1), "a")).collect();
        topology.link_all(links.into_iter());
        assert_ordered(&topology);
        assert_eq!(topology.closed_by(NodeId(0), NodeId(99), &mut 50), Closes::Unknown);
        let Closes::Cycle(path) = topology.closed_by(NodeId(0), NodeId(99), &mut 1_000) else { panic!("a cycle") };
        assert_eq!(path.len(), 100);
    }
}
