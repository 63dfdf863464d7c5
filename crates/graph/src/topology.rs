//! Which node feeds which: the acyclic skeleton of a graph, carried by petgraph.

use std::collections::HashMap;

use petgraph::Direction;
use petgraph::stable_graph::{NodeIndex, StableDiGraph};
use petgraph::visit::EdgeRef;

use crate::graph::NodeId;
use crate::value::KeyHasherBuilder;

/// Links between nodes, one edge per link, labelled with the input it enters. Always acyclic.
#[derive(Clone, Debug, Default)]
pub(crate) struct Topology {
    links: StableDiGraph<NodeId, String>,
    places: HashMap<NodeId, NodeIndex, KeyHasherBuilder>,
}

impl Topology {
    pub(crate) fn add(&mut self, node: NodeId) {
        let place = self.links.add_node(node);
        self.places.insert(node, place);
    }

    pub(crate) fn remove(&mut self, node: NodeId) {
        if let Some(place) = self.places.remove(&node) {
            self.links.remove_node(place);
        }
    }

    /// The nodes from `to` to `from`, both included, where a link `from -> to` would close a cycle.
    pub(crate) fn cycle_closed_by(&self, from: NodeId, to: NodeId) -> Option<Vec<NodeId>> {
        let (from, to) = (*self.places.get(&from)?, *self.places.get(&to)?);
        // Most links are drawn from or to a node that is new; then there is nothing to search.
        let is_source = self.links.edges_directed(from, Direction::Incoming).next().is_none();
        if from != to && (is_source || self.links.edges_directed(to, Direction::Outgoing).next().is_none()) {
            return None;
        }
        // Whether there is a path is found much faster than the shortest one, and mostly there is none.
        if !petgraph::algo::has_path_connecting(&self.links, to, from, None) {
            return None;
        }
        let (_, path) = petgraph::algo::astar(&self.links, to, |n| n == from, |_| 1, |_| 0)?;
        Some(path.into_iter().map(|place| self.links[place]).collect())
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
        if let (Some(from), Some(to)) = (self.places.get(&from), self.places.get(&to)) {
            self.links.add_edge(*from, *to, input.to_owned());
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
