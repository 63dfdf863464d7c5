//! Links on the canvas: drawn, selected, cut, dropped on.

use egui::{Pos2, Rect};
use egui_graph::edge::{Edge, EdgeShape};
use maquette_graph::{Edit, NodeId, Source};

use crate::command::{GraphCommand, NewLink};
use crate::panel::PanelContext;

use super::search::Search;
use super::{Canvas, key, ports};

/// How links run.
pub(super) const SHAPE: EdgeShape = EdgeShape::DEFAULT;

/// Where links run, by the input at which each ends.
#[derive(Default)]
pub(super) struct Seen {
    links: Vec<(NodeId, String, Vec<Pos2>)>,
}

/// Whether two pieces of lines cross.
fn cross([a, b]: [Pos2; 2], [c, d]: [Pos2; 2]) -> bool {
    let side = |p: Pos2, q: Pos2, r: Pos2| (q - p).x * (r - p).y - (q - p).y * (r - p).x;
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}

fn windows(line: &[Pos2]) -> impl Iterator<Item = [Pos2; 2]> + '_ {
    line.windows(2).map(|pair| [pair[0], pair[1]])
}

impl Seen {
    /// The links that a line crosses.
    pub(super) fn crossed(&self, line: &[Pos2]) -> Vec<(NodeId, String)> {
        let crossed = self
            .links
            .iter()
            .filter(|(_, _, path)| windows(path).any(|piece| windows(line).any(|other| cross(piece, other))));
        crossed.map(|(to, input, _)| (*to, input.clone())).collect()
    }

    /// The first link that runs through a rectangle.
    pub(super) fn under(&self, rect: Rect) -> Option<(NodeId, String)> {
        let found = self.links.iter().find(|(_, _, path)| path.iter().any(|point| rect.contains(*point)))?;
        Some((found.0, found.1.clone()))
    }
}

impl Canvas {
    pub(super) fn links(
        &mut self,
        edges: &mut egui_graph::EdgesCtx,
        ui: &mut egui::Ui,
        context: &mut PanelContext<'_>,
    ) -> Seen {
        let graph = context.graph();
        let dark = ui.visuals().dark_mode;
        let mut seen = Seen::default();
        let mut removed = Vec::new();
        let mut insert = None;
        for (id, node) in graph.nodes() {
            for (socket, port) in ports::inputs(node).iter().enumerate() {
                let Some(Source::Link(link)) = node.source(&port.name) else { continue };
                let Some(from) = graph.node(link.node) else { continue };
                let outputs = ports::outputs(graph, link.node, from);
                let Some(output) = outputs.iter().position(|output| output.name == link.output) else { continue };
                let end = (id, port.name.clone());
                let mut selected = self.selected_links.contains(&end);
                let colour = ports::wire_colour(outputs[output].wire, dark);
                let width = if from.is_muted() || node.is_muted() { 1.2 } else { 2.0 };
                let edge = Edge::new((key(link.node), output), (key(id), socket), &mut selected)
                    .shape(SHAPE)
                    .stroke(egui::Stroke::new(width, colour.gamma_multiply(0.85)))
                    .hovered_stroke(egui::Stroke::new(3.0, colour))
                    .selected_stroke(egui::Stroke::new(3.0, ui.visuals().selection.stroke.color));
                let mut path = Vec::new();
                let response = edge.show_with(edges, ui, |ui, paint| {
                    path = paint.points.to_vec();
                    ui.painter().add(egui::Shape::line(paint.points.to_vec(), paint.stroke));
                });
                if response.deleted() {
                    removed.push(Edit::Disconnect { to: id, input: port.name.clone() });
                }
                response.context_menu(|ui| {
                    if ui.button("Disconnect").clicked() {
                        removed.push(Edit::Disconnect { to: id, input: port.name.clone() });
                        ui.close();
                    }
                    if ui.button("Add a node behind it…").clicked() {
                        insert = Some(NewLink::From { node: link.node, output: link.output.clone() });
                        ui.close();
                    }
                });
                if selected {
                    self.selected_links.insert(end);
                } else {
                    self.selected_links.remove(&end);
                }
                seen.links.push((id, port.name.clone(), path));
            }
        }
        if !removed.is_empty() {
            context.ask(GraphCommand::Edit { name: "disconnect".to_owned(), edits: removed, gesture: None });
        }
        if let Some(link) = insert
            && let Some(pointer) = ui.input(|i| i.pointer.latest_pos())
        {
            self.search = Some(Search::new(pointer, self.canvas_point(pointer), link));
        }
        seen
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_cuts_what_it_crosses() {
        let catalogue = maquette_nodes::catalogue().unwrap();
        let mut graph = maquette_graph::Graph::new();
        let id = graph.add(&catalogue, "resample", "even").unwrap();
        let path = vec![Pos2::new(0.0, 0.0), Pos2::new(10.0, 0.0), Pos2::new(20.0, 5.0)];
        let seen = Seen { links: vec![(id, "curves".to_owned(), path)] };
        let cut = |a: [f32; 2], b: [f32; 2]| seen.crossed(&[a.into(), b.into()]).len();
        assert_eq!(cut([5.0, -5.0], [5.0, 5.0]), 1);
        assert_eq!(cut([5.0, 1.0], [5.0, 5.0]), 0);
        assert_eq!(cut([15.0, -5.0], [15.0, 5.0]), 1);
        assert!(seen.under(Rect::from_min_max(Pos2::new(8.0, -2.0), Pos2::new(12.0, 2.0))).is_some());
    }
}
