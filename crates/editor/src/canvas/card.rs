//! What the canvas shows of a graph, made anew only where the document changed: the ports of each node, which of them have a
//! row, how large it is, and where its sockets are. How it stands with a node changes none of that.

use std::collections::{BTreeMap, BTreeSet};

use egui::{Pos2, Rect, Vec2, vec2};
use maquette_graph::{Graph, Node, NodeId, Source};

use super::key;
use super::ports::{self, Port};

/// Width of what is in a node, points.
pub(crate) const WIDTH: f32 = 172.0;
/// Heights of the lines of a node and of what is between them, points.
pub(super) const TITLE: f32 = 18.0;
pub(super) const KIND: f32 = 16.0;
pub(super) const ROW: f32 = 16.0;
pub(super) const GAP: f32 = 2.0;
/// What is between a node's edge and its content, points; the line around it, one point wide, comes to that.
pub(super) const MARGIN: egui::Margin = egui::Margin::symmetric(9, 6);
const EDGE: Vec2 = vec2(10.0, 7.0);

/// A node.
#[derive(Clone, Debug)]
pub(crate) struct Card {
    pub(crate) id: NodeId,
    /// What the widget calls it.
    pub(super) key: egui_graph::NodeId,
    pub(super) inputs: Vec<Port>,
    pub(super) outputs: Vec<Port>,
    /// The inputs that have a row, in its order.
    pub(super) rows: Vec<usize>,
    /// Whether there are inputs whose rows may be hidden.
    pub(super) has_values: bool,
    /// Whether only the title is shown; the sockets stand at both ends of it.
    pub(super) is_collapsed: bool,
    pub(crate) size: Vec2,
}

impl Card {
    pub(super) fn new(graph: &Graph, id: NodeId, node: &Node, expanded: bool) -> Self {
        let inputs = ports::inputs(node);
        let outputs = ports::outputs(graph, id, node);
        let rows: Vec<usize> = (0..inputs.len()).filter(|index| ports::is_shown(&inputs[*index], expanded)).collect();
        let has_values = inputs.iter().any(|port| port.typed && !port.linked);
        #[expect(clippy::cast_precision_loss, reason = "a few ports")]
        let count = (rows.len() + outputs.len()) as f32;
        let is_collapsed = node.is_collapsed();
        let height = if is_collapsed { TITLE } else { TITLE + GAP + KIND + count * (GAP + ROW) };
        let size = vec2(WIDTH, height) + 2.0 * EDGE;
        Self { id, key: key(id), inputs, outputs, rows, has_values, is_collapsed, size }
    }

    /// What it covers where its corner is there.
    pub(super) fn rect(&self, place: Pos2) -> Rect {
        Rect::from_min_size(place, self.size)
    }

    /// The socket of an input, seen from the node's corner; `None` where its row is hidden.
    pub(super) fn input(&self, index: usize) -> Option<Vec2> {
        let row = self.rows.iter().position(|shown| *shown == index)?;
        Some(vec2(0.0, self.row(row, row, self.rows.len())))
    }

    /// The socket of an output, seen from the node's corner.
    pub(super) fn output(&self, index: usize) -> Option<Vec2> {
        let count = self.outputs.len();
        (index < count).then(|| vec2(self.size.x, self.row(self.rows.len() + index, index, count)))
    }

    /// How far below the corner a socket is, of a row, or, on a collapsed node, of the sockets at one end.
    #[expect(clippy::cast_precision_loss, reason = "a few ports")]
    fn row(&self, row: usize, at_end: usize, of: usize) -> f32 {
        if self.is_collapsed {
            return self.size.y * (at_end as f32 + 0.5) / of.max(1) as f32;
        }
        EDGE.y + TITLE + GAP + KIND + GAP + row as f32 * (ROW + GAP) + 0.5 * ROW
    }
}

/// A link.
#[derive(Clone, Debug)]
pub(super) struct LinkCard {
    /// The place of the node it comes from in [`Cards::all`].
    pub(super) from: usize,
    /// The output it takes.
    pub(super) output: usize,
    /// The place of the node it ends at.
    pub(super) to: usize,
    /// The input at which it ends.
    pub(super) input: usize,
    /// Whether one of its nodes is muted.
    pub(super) is_muted: bool,
}

/// The nodes and links of a graph.
#[derive(Clone, Debug, Default)]
pub(super) struct Cards {
    made_of: Option<(u64, BTreeSet<NodeId>)>,
    pub(super) all: Vec<Card>,
    pub(super) links: Vec<LinkCard>,
    places: BTreeMap<NodeId, usize>,
}

impl Cards {
    /// Those of a graph.
    pub(super) fn new(graph: &Graph, expanded: &BTreeSet<NodeId>) -> Self {
        let mut cards = Self::default();
        cards.refresh(0, graph, expanded);
        cards
    }

    /// Makes them anew where the document, by its revision, or what is expanded changed; says whether it did.
    pub(super) fn refresh(&mut self, revision: u64, graph: &Graph, expanded: &BTreeSet<NodeId>) -> bool {
        if self.made_of.as_ref().is_some_and(|(of, with)| *of == revision && with == expanded) {
            return false;
        }
        self.made_of = Some((revision, expanded.clone()));
        self.all = graph.nodes().map(|(id, node)| Card::new(graph, id, node, expanded.contains(&id))).collect();
        self.places = self.all.iter().enumerate().map(|(place, card)| (card.id, place)).collect();
        self.links.clear();
        for (to, card) in self.all.iter().enumerate() {
            let Some(node) = graph.node(card.id) else { continue };
            for (input, port) in card.inputs.iter().enumerate().filter(|(_, port)| port.linked) {
                let Some(Source::Link(link)) = node.source(&port.name) else { continue };
                let Some(&from) = self.places.get(&link.node) else { continue };
                let outputs = &self.all[from].outputs;
                let Some(output) = outputs.iter().position(|output| output.name == link.output) else { continue };
                let is_muted = node.is_muted() || graph.node(link.node).is_some_and(Node::is_muted);
                self.links.push(LinkCard { from, output, to, input, is_muted });
            }
        }
        true
    }

    /// That of a node.
    pub(super) fn of(&self, id: NodeId) -> Option<&Card> {
        self.all.get(*self.places.get(&id)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_are_known_by_the_sockets_of_their_nodes_and_only_made_anew_after_a_change() {
        let catalogue = maquette_nodes::catalogue().unwrap();
        let mut graph = Graph::new();
        let sketch = graph.add(&catalogue, "sketch", "sketch").unwrap();
        let even = graph.add(&catalogue, "resample", "even").unwrap();
        let mut cards = Cards::default();
        cards.refresh(0, &graph, &BTreeSet::new());
        assert!(cards.links.is_empty());
        graph.connect(&catalogue, sketch, "curves", even, "curves").unwrap();
        cards.refresh(0, &graph, &BTreeSet::new());
        assert!(cards.links.is_empty(), "the revision says that nothing changed");
        cards.refresh(1, &graph, &BTreeSet::new());
        let [link] = &cards.links[..] else { panic!("{:?}", cards.links) };
        let (from, to) = (&cards.all[link.from], &cards.all[link.to]);
        assert_eq!((from.id, to.id), (sketch, even));
        assert_eq!(from.output(link.output).unwrap().x, from.size.x);
        let row = to.input(link.input).unwrap().y;
        let before = to.size.y;
        cards.refresh(1, &graph, &BTreeSet::from([even]));
        let expanded = cards.of(even).unwrap();
        assert!(expanded.size.y > before && expanded.input(0).unwrap().y == row);
    }
}
