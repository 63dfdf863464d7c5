//! Places nodes: all by what they depend on, so that links run from left to right, or chosen ones in a line. Nodes that are
//! arranged never overlap.

use std::collections::{BTreeMap, BTreeSet};

use egui::{Pos2, Rect, pos2};
use egui_graph::{LayoutNode, LayoutParams};
use maquette_graph::{Graph, NodeId};

use super::card::{Card, Cards};

/// Between two columns of nodes, and between two nodes of a column, points.
const BETWEEN_COLUMNS: f32 = 70.0;
const BETWEEN_NODES: f32 = 26.0;

/// How selected nodes are lined up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Alignment {
    /// Their left edges, with the leftmost one.
    Left,
    /// Their right edges, with the rightmost one.
    Right,
    /// Their upper edges, with the highest one.
    Top,
    /// Their lower edges, with the lowest one.
    Bottom,
    /// Equal gaps from left to right; the first and the last one stay.
    Across,
    /// Equal gaps from top to bottom; the first and the last one stay.
    Down,
}

impl Alignment {
    /// All of them, in the order of the menu.
    pub const ALL: [Self; 6] = [Self::Left, Self::Right, Self::Top, Self::Bottom, Self::Across, Self::Down];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Left => "Align left",
            Self::Right => "Align right",
            Self::Top => "Align top",
            Self::Bottom => "Align bottom",
            Self::Across => "Distribute across",
            Self::Down => "Distribute down",
        }
    }

    /// Where nodes that cover these rectangles come to stand, in their order. Nodes that would overlap are moved on by as
    /// little as helps: down where their edges are at the side, to the right where they are above or below.
    pub(crate) fn places(self, rects: &[Rect]) -> Vec<Pos2> {
        let Some(all) = rects.iter().copied().reduce(|a, b| a.union(b)) else { return Vec::new() };
        let aligned = |rect: &Rect| match self {
            Self::Left => pos2(all.left(), rect.top()),
            Self::Right => pos2(all.right() - rect.width(), rect.top()),
            Self::Top => pos2(rect.left(), all.top()),
            Self::Bottom => pos2(rect.left(), all.bottom() - rect.height()),
            Self::Across | Self::Down => rect.min,
        };
        let mut moved: Vec<Rect> = rects.iter().map(|rect| Rect::from_min_size(aligned(rect), rect.size())).collect();
        match self {
            Self::Left | Self::Right => separate(&mut moved, 1),
            Self::Top | Self::Bottom => separate(&mut moved, 0),
            Self::Across => distribute(&mut moved, 0),
            Self::Down => distribute(&mut moved, 1),
        }
        moved.iter().map(|rect| rect.min.round()).collect()
    }
}

/// The same gap between all, along an axis. Where there is no room for a gap, those after the first are moved on.
fn distribute(rects: &mut [Rect], axis: usize) {
    let mut order: Vec<usize> = (0..rects.len()).collect();
    order.sort_by(|a, b| rects[*a].min[axis].total_cmp(&rects[*b].min[axis]).then(a.cmp(b)));
    let (Some(first), Some(last)) = (order.first(), order.last()) else { return };
    let whole = rects[*last].max[axis] - rects[*first].min[axis];
    let filled: f32 = rects.iter().map(|rect| rect.size()[axis]).sum();
    #[expect(clippy::cast_precision_loss, reason = "nodes of a selection")]
    let gap = ((whole - filled) / (rects.len().max(2) - 1) as f32).max(0.0);
    let mut from = rects[*first].min[axis];
    for index in order {
        let size = rects[index].size();
        rects[index].min[axis] = from;
        rects[index].max = rects[index].min + size;
        from += size[axis] + gap;
    }
}

/// Moves rectangles on along an axis, one after the other, until none covers another.
fn separate(rects: &mut [Rect], axis: usize) {
    let mut order: Vec<usize> = (0..rects.len()).collect();
    order.sort_by(|a, b| rects[*a].min[axis].total_cmp(&rects[*b].min[axis]).then(a.cmp(b)));
    let mut placed: Vec<Rect> = Vec::new();
    for index in order {
        let size = rects[index].size();
        // Each turn moves it beyond one of those that stand: there are not more turns than those.
        while let Some(before) = placed.iter().find(|before| covers(before, &rects[index])) {
            rects[index].min[axis] = before.max[axis] + BETWEEN_NODES;
            rects[index].max = rects[index].min + size;
        }
        placed.push(rects[index]);
    }
}

/// Whether two rectangles have more than an edge in common.
fn covers(a: &Rect, b: &Rect) -> bool {
    a.left() < b.right() && b.left() < a.right() && a.top() < b.bottom() && b.top() < a.bottom()
}

/// A place for each of these nodes, or for all. The same graph gives the same places.
fn arrange_cards(cards: &Cards, wanted: impl Fn(NodeId) -> bool) -> BTreeMap<NodeId, Pos2> {
    let offsets = |card: &Card| {
        let inputs = (0..card.inputs.len()).map(|index| card.input(index).map_or(0.5 * card.size.y, |place| place.y));
        let outputs = (0..card.outputs.len()).filter_map(|index| Some(card.output(index)?.y));
        let node = LayoutNode::new(card.size);
        (card.key, node.input_offsets(inputs.collect()).output_offsets(outputs.collect()))
    };
    let chosen: Vec<&Card> = cards.all.iter().filter(|card| wanted(card.id)).collect();
    let links = cards.links.iter().filter_map(|link| {
        let (from, to) = (&cards.all[link.from], &cards.all[link.to]);
        (wanted(from.id) && wanted(to.id)).then_some(((from.key, link.output), (to.key, link.input)))
    });
    let params = LayoutParams::new(egui::Direction::LeftToRight).layer_gap(BETWEEN_COLUMNS).node_gap(BETWEEN_NODES);
    let nodes: Vec<_> = chosen.iter().map(|card| offsets(card)).collect();
    let placed = egui_graph::layout(nodes, links.collect::<Vec<_>>(), params);
    let place = |card: &&Card| card.rect(placed.get(&card.key).copied().unwrap_or_default().round());
    let mut rects: Vec<Rect> = chosen.iter().map(place).collect();
    // The layout promises nothing about nodes of different columns.
    separate(&mut rects, 1);
    chosen.iter().zip(rects).map(|(card, rect)| (card.id, rect.min.round())).collect()
}

/// A place for each node of a graph, of which some show all their inputs.
pub(crate) fn arrange(graph: &Graph, expanded: &BTreeSet<NodeId>) -> BTreeMap<NodeId, Pos2> {
    arrange_cards(&Cards::new(graph, expanded), |_| true)
}

/// A place for each selected node; together they begin at `corner`.
pub(crate) fn arrange_selected(
    graph: &Graph,
    expanded: &BTreeSet<NodeId>,
    selected: &BTreeSet<NodeId>,
    corner: Pos2,
) -> BTreeMap<NodeId, Pos2> {
    arrange_at(&Cards::new(graph, expanded), |id| selected.contains(&id), corner)
}

/// A place for each of these nodes; together they begin at `corner`.
pub(super) fn arrange_at(cards: &Cards, wanted: impl Fn(NodeId) -> bool, corner: Pos2) -> BTreeMap<NodeId, Pos2> {
    let mut places = arrange_cards(cards, wanted);
    let begin = places.values().copied().reduce(|a, b| a.min(b)).unwrap_or_default();
    places.values_mut().for_each(|place| *place = (*place + (corner - begin)).round());
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Document, ProjectChoice};
    use std::path::Path;

    fn rects(graph: &Graph, places: &BTreeMap<NodeId, Pos2>) -> Vec<Rect> {
        let none = BTreeSet::new();
        Cards::new(graph, &none).all.iter().filter_map(|card| Some(card.rect(*places.get(&card.id)?))).collect()
    }

    fn overlaps(rects: &[Rect]) -> usize {
        let pairs = rects.iter().enumerate().flat_map(|(k, a)| rects[k + 1..].iter().map(move |b| (a, b)));
        pairs.filter(|(a, b)| covers(a, b)).count()
    }

    #[test]
    fn what_depends_on_a_node_stands_to_its_right() {
        let catalogue = maquette_nodes::catalogue().unwrap();
        let mut graph = Graph::new();
        let sketch = graph.add(&catalogue, "sketch", "sketch").unwrap();
        let ids: Vec<NodeId> =
            (0..3).map(|k| graph.add(&catalogue, "resample", &format!("even {k}")).unwrap()).collect();
        for id in &ids {
            graph.connect(&catalogue, sketch, "curves", *id, "curves").unwrap();
        }
        let places = arrange(&graph, &BTreeSet::new());
        let rects = rects(&graph, &places);
        assert!(rects[1..].iter().all(|rect| rect.left() > rects[0].right()));
        assert_eq!(overlaps(&rects), 0);
        assert_eq!(arrange(&graph, &BTreeSet::new()), places);
    }

    /// The graphs of the repository, and those within their nodes.
    fn saved() -> Vec<(String, Graph)> {
        let catalogue = maquette_nodes::catalogue().unwrap();
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../graphs");
        let mut found = Vec::new();
        for entry in std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()) {
            if entry.extension().is_some_and(|extension| extension == "ron") {
                let name = entry.file_name().unwrap().to_string_lossy().into_owned();
                let document = Document::open(&catalogue, &entry, ProjectChoice::default()).unwrap();
                let mut graphs = vec![(name, document.graph().clone())];
                while let Some((name, graph)) = graphs.pop() {
                    for (_, node) in graph.nodes() {
                        let within = node.body().and_then(|body| body.graph());
                        graphs.extend(within.map(|within| (format!("{name}/{}", node.name()), within.clone())));
                    }
                    found.push((name, graph));
                }
            }
        }
        assert!(found.len() > 25, "{}", found.len());
        found
    }

    #[test]
    fn no_node_of_any_saved_graph_covers_another_one_after_arranging() {
        for (name, graph) in saved() {
            let all: BTreeSet<NodeId> = graph.nodes().map(|(id, _)| id).collect();
            let places = arrange(&graph, &BTreeSet::new());
            assert_eq!(places.len(), all.len(), "{name}");
            assert_eq!(overlaps(&rects(&graph, &places)), 0, "{name}");
            let expanded = Cards::new(&graph, &all);
            let places = arrange(&graph, &all);
            let rects: Vec<Rect> = expanded.all.iter().map(|card| card.rect(places[&card.id])).collect();
            assert_eq!(overlaps(&rects), 0, "{name}, with all inputs shown");
            let some: BTreeSet<NodeId> = all.iter().copied().step_by(2).collect();
            let places = arrange_selected(&graph, &BTreeSet::new(), &some, pos2(-300.0, 40.0));
            let rects = self::rects(&graph, &places);
            assert_eq!((rects.len(), overlaps(&rects)), (some.len(), 0), "{name}, some of it");
            let corner = places.values().copied().reduce(|a, b| a.min(b));
            assert_eq!(corner, Some(pos2(-300.0, 40.0)), "{name}");
        }
    }

    #[test]
    fn nodes_are_lined_up_and_spread_without_covering_each_other() {
        let rect = |x: f32, y: f32, h: f32| Rect::from_min_size(pos2(x, y), egui::vec2(100.0, h));
        let given = [rect(0.0, 0.0, 50.0), rect(40.0, 20.0, 30.0), rect(300.0, 200.0, 80.0)];
        for alignment in Alignment::ALL {
            let places = alignment.places(&given);
            let moved: Vec<Rect> =
                places.iter().zip(&given).map(|(place, rect)| Rect::from_min_size(*place, rect.size())).collect();
            if !matches!(alignment, Alignment::Across | Alignment::Down) {
                assert_eq!(overlaps(&moved), 0, "{alignment:?}");
            }
            let same = |edge: fn(&Rect) -> f32| moved.iter().all(|rect| edge(rect) == edge(&moved[0]));
            match alignment {
                Alignment::Left => assert!(same(Rect::left) && moved[0].left() == 0.0),
                Alignment::Right => assert!(same(Rect::right) && moved[0].right() == 400.0),
                Alignment::Top => assert!(same(Rect::top) && moved[0].top() == 0.0),
                Alignment::Bottom => assert!(same(Rect::bottom) && moved[0].bottom() == 280.0),
                Alignment::Across => assert_eq!([0.0, 150.0, 300.0], [0, 1, 2].map(|k: usize| moved[k].left())),
                Alignment::Down => assert_eq!([0.0, 110.0, 200.0], [0, 1, 2].map(|k: usize| moved[k].top())),
            }
        }
    }
}
