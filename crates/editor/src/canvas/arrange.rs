//! Places nodes by what they depend on, so that links run from left to right.

use std::collections::BTreeMap;

use egui_graph::{LayoutNode, LayoutParams};
use maquette_graph::{Graph, NodeId, Source};

use super::ports;

/// Width of what is in a node, points.
pub(crate) const WIDTH: f32 = 172.0;
/// What its frame adds to the width, points.
const FRAME: f32 = 20.0;
/// Height of a node without ports, points.
const HEAD: f32 = 46.0;
/// Height of a port, points.
const ROW: f32 = 18.0;

/// About how large a node is drawn while its inputs with values are hidden.
pub(crate) fn size(graph: &Graph, id: NodeId) -> egui::Vec2 {
    let rows = graph.node(id).map_or(0, |node| {
        let inputs = ports::inputs(node).iter().filter(|port| ports::is_shown(port, false)).count();
        inputs + ports::outputs(graph, id, node).len()
    });
    #[expect(clippy::cast_precision_loss, reason = "a few ports")]
    egui::vec2(WIDTH + FRAME, HEAD + ROW * rows as f32)
}

fn key(id: NodeId) -> egui_graph::NodeId {
    egui_graph::NodeId::new(id)
}

/// A place for each node. The same graph gives the same places.
pub(crate) fn arrange(graph: &Graph) -> BTreeMap<NodeId, egui::Pos2> {
    let nodes = graph.nodes().map(|(id, node)| {
        let outputs = ports::outputs(graph, id, node).len();
        (key(id), LayoutNode::new(size(graph, id)).inputs(ports::inputs(node).len()).outputs(outputs))
    });
    let links = graph.nodes().flat_map(|(id, node)| {
        let inputs = ports::inputs(node);
        let ends = inputs.iter().enumerate().filter_map(|(socket, port)| match node.source(&port.name)? {
            Source::Link(link) => {
                let from = graph.node(link.node)?;
                let output = ports::outputs(graph, link.node, from).iter().position(|p| p.name == link.output)?;
                Some(((key(link.node), output), (key(id), socket)))
            }
            _ => None,
        });
        ends.collect::<Vec<_>>()
    });
    let params = LayoutParams::new(egui::Direction::LeftToRight).layer_gap(70.0).node_gap(26.0);
    let placed = egui_graph::layout(nodes.collect::<Vec<_>>(), links.collect::<Vec<_>>(), params);
    graph.nodes().filter_map(|(id, _)| Some((id, placed.get(&key(id)).copied()?.round()))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_depends_on_a_node_stands_to_its_right_and_nothing_overlaps() {
        let catalogue = maquette_nodes::catalogue().unwrap();
        let mut graph = Graph::new();
        let sketch = graph.add(&catalogue, "sketch", "sketch").unwrap();
        let ids: Vec<NodeId> =
            (0..3).map(|k| graph.add(&catalogue, "resample", &format!("even {k}")).unwrap()).collect();
        for id in &ids {
            graph.connect(&catalogue, sketch, "curves", *id, "curves").unwrap();
        }
        let places = arrange(&graph);
        assert_eq!(places.len(), 4);
        let rect = |id: NodeId| egui::Rect::from_min_size(places[&id], size(&graph, id));
        for (k, id) in ids.iter().enumerate() {
            assert!(rect(*id).left() > rect(sketch).right());
            assert!(ids[k + 1..].iter().all(|other| !rect(*id).intersects(rect(*other))));
        }
        assert_eq!(arrange(&graph), places);
    }
}
