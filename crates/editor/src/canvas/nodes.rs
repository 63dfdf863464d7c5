//! The nodes of the canvas: widgets where something can be done with them, and otherwise only painted.

use egui::{Pos2, Sense};
use egui_graph::node::EdgeEvent;
use maquette_graph::Node;

use crate::command::ViewCommand;
use crate::panel::PanelContext;

use super::card::{self, Card};
use super::face::{self, Face};
use super::search::Search;
use super::{Canvas, Stage};

/// So many nodes are widgets at any zoom.
const FEW: usize = 120;
/// How far from a node the pointer may be to do something with it, points of the canvas.
const REACH: f32 = 34.0;

/// Points of the canvas between two dots of its background, and of the screen at least.
const DOTS: f32 = 20.0;
const DOTS_ON_SCREEN: f32 = 18.0;

impl Canvas {
    /// Shows the nodes with which something can be done in this frame, and gives those that only need to be painted. A large
    /// graph stays quick because of that.
    pub(super) fn nodes(
        &mut self,
        nodes: &mut egui_graph::NodesCtx<'_>,
        ui: &mut egui::Ui,
        context: &mut PanelContext<'_>,
        stage: &mut Stage<'_>,
    ) -> Vec<usize> {
        let graph = context.graph();
        let prefix = context.path_of("");
        let results = context.results;
        let cards = stage.cards;
        // What is only painted takes a hover to become what can be dragged, which a pen does not do: only many are.
        let is_afar = face::is_afar(stage.zoom) && cards.all.len() > FEW;
        let mut painted = Vec::new();
        for (index, card) in cards.all.iter().enumerate() {
            let Some(node) = graph.node(card.id) else { continue };
            let rect = card.rect(stage.corners[index]);
            let is_seen = stage.visible.intersects(rect.expand(12.0));
            let is_held = self.drag.is_from(card.id)
                || self.menu == Some(card.id)
                || stage.band.is_some_and(|band| {
                    band.expand(REACH).intersects(rect) || context.view.selection.contains(&card.id)
                });
            let is_near = stage.pointer.is_some_and(|pointer| rect.expand(REACH).contains(pointer));
            stage.is_over_node |= is_near && stage.pointer.is_some_and(|pointer| rect.contains(pointer));
            if !(is_held || is_seen && (is_near || !is_afar)) {
                if is_seen {
                    painted.push(index);
                    let response = ui.interact(rect, ui.id().with(("painted", card.id)), Sense::click());
                    response.widget_info(|| named(node, context.view.selection.contains(&card.id)));
                    if response.clicked() {
                        context.ask(ViewCommand::Select(vec![card.id]));
                    }
                }
                continue;
            }
            let status = match prefix.as_str() {
                "" => results.status(node.name()),
                prefix => results.status(&format!("{prefix}{}", node.name())),
            };
            let face = Face { card, node, status, zoom: stage.zoom };
            stage.corners[index] = self.node(nodes, ui, context, face, stage.dark);
        }
        painted
    }

    /// A node as a widget; gives where it stands.
    fn node(
        &mut self,
        nodes: &mut egui_graph::NodesCtx<'_>,
        ui: &mut egui::Ui,
        context: &mut PanelContext<'_>,
        face: Face<'_>,
        dark: bool,
    ) -> Pos2 {
        let Face { card, node, .. } = face;
        let id = card.id;
        let response = egui_graph::node::Node::from_id(card.key)
            .inputs(card.rows.len())
            .outputs(card.outputs.len())
            .collapsed(true)
            .max_width(card::WIDTH)
            .animation_time(0.0)
            .socket_radius(4.0)
            .socket_color(card.outputs.first().map_or(egui::Color32::GRAY, |port| port.colour(dark)))
            .show_or_cull(nodes, ui, |node_context| {
                let style = node_context.style();
                let mut frame = egui_graph::node::default_frame(style, node_context.interaction());
                frame.inner_margin = card::MARGIN;
                frame.fill = face::fill(node, &style.visuals);
                if face::is_afar(face.zoom) {
                    frame.shadow = egui::Shadow::NONE;
                }
                node_context.framed_with(frame, |ui, sockets| face::show(ui, sockets, context, face))
            });
        self.paint_sockets(ui, &response, card, dark);
        match response.edge_event() {
            Some(EdgeEvent::Started { kind, index }) => self.drag.begin(context, id, kind, index),
            Some(EdgeEvent::Ended { kind, index }) => self.drag.end(context, id, kind, index),
            Some(EdgeEvent::Cancelled) => {
                if let Some(link) = self.drag.cancelled(ui, context)
                    && let Some(pointer) = ui.input(|i| i.pointer.latest_pos())
                {
                    self.search = Some(Search::new(pointer, self.canvas_point(pointer), link));
                }
            }
            None => {}
        }
        let selected = context.view.selection.contains(&id);
        response.widget_info(|| named(node, selected));
        // By the keyboard: of a click by the pointer the widget knows.
        if response.clicked() && ui.input(|i| !i.pointer.any_released()) {
            context.ask(ViewCommand::Select(vec![id]));
        }
        if response.double_clicked() && node.body().is_some_and(|body| body.graph().is_some()) {
            context.ask(ViewCommand::Enter(id));
        }
        if response.secondary_clicked() && !context.view.selection.contains(&id) {
            context.ask(ViewCommand::Select(vec![id]));
        }
        let menu = response.context_menu(|ui| face::menu(ui, context, id, node));
        if menu.is_some() {
            self.menu = Some(id);
        } else if self.menu == Some(id) {
            self.menu = None;
        }
        response.rect.min
    }

    /// Paints the nodes that are no widgets, with their sockets.
    pub(super) fn paint(&self, ui: &egui::Ui, context: &PanelContext<'_>, stage: &Stage<'_>, painted: &[usize]) {
        let graph = context.graph();
        let prefix = context.path_of("");
        let painter = ui.painter();
        for index in painted {
            let card = &stage.cards.all[*index];
            let Some(node) = graph.node(card.id) else { continue };
            let status = match prefix.as_str() {
                "" => context.results.status(node.name()),
                prefix => context.results.status(&format!("{prefix}{}", node.name())),
            };
            let selected = context.view.selection.contains(&card.id);
            let face = Face { card, node, status, zoom: stage.zoom };
            let corner = stage.corners[*index];
            face::paint(painter, corner, face, selected, ui.visuals());
            let inputs = card.rows.iter().filter_map(|row| Some((&card.inputs[*row], card.input(*row)?)));
            let outputs = card.outputs.iter().enumerate().filter_map(|(at, port)| Some((port, card.output(at)?)));
            for (port, place) in inputs.chain(outputs) {
                painter.circle_filled(corner + place, 4.0, port.colour(stage.dark));
            }
        }
    }

    /// Colours each socket by its type, and names it for those who do not see it.
    fn paint_sockets<T>(&self, ui: &egui::Ui, response: &egui_graph::node::NodeResponse<T>, card: &Card, dark: bool) {
        let sockets = response.sockets();
        let named = sockets
            .inputs()
            .map(|(index, socket)| ("input", card.inputs.get(index), socket))
            .chain(sockets.outputs().map(|(index, socket)| ("output", card.outputs.get(index), socket)));
        for (what, port, socket) in named {
            let Some(port) = port else { continue };
            ui.painter().circle_filled(socket.rect.center(), 4.0, port.colour(dark));
            socket.widget_info(|| {
                egui::WidgetInfo::labeled(egui::WidgetType::Other, true, format!("{what} {}", port.name))
            });
        }
    }
}

/// What a node is called for those who do not see it.
fn named(node: &Node, selected: bool) -> egui::WidgetInfo {
    egui::WidgetInfo::selected(egui::WidgetType::Button, true, selected, format!("node {}", node.name()))
}

/// Dots in the background, so that one sees how the canvas moves; fewer where it is seen from afar.
pub(super) fn dots(ui: &egui::Ui, stage: &Stage<'_>) {
    let doublings = (DOTS_ON_SCREEN / (DOTS * stage.zoom).max(1e-3)).log2().ceil().clamp(0.0, 8.0);
    let step = DOTS * doublings.exp2();
    let colour = ui.visuals().widgets.noninteractive.bg_stroke.color;
    let radius = 0.7 / stage.zoom.max(1e-3);
    let visible = stage.visible;
    #[expect(clippy::cast_possible_truncation, reason = "a few hundred steps")]
    let steps = |from: f32, to: f32| (from / step).ceil() as i32..=(to / step).floor() as i32;
    let mut shapes = Vec::new();
    #[expect(clippy::cast_precision_loss, reason = "a few hundred steps")]
    for column in steps(visible.left(), visible.right()) {
        for row in steps(visible.top(), visible.bottom()) {
            let middle = Pos2::new(column as f32 * step, row as f32 * step);
            shapes.push(egui::Shape::circle_filled(middle, radius, colour));
        }
    }
    ui.painter().extend(shapes);
}
