//! The canvas: the graph as nodes and links. The widget keeps places and the view; nodes, links and names are those of the
//! document in every frame.

pub(crate) mod arrange;
pub(crate) mod card;
pub(crate) mod face;
pub(crate) mod frames;
mod link_drag;
mod links;
mod nodes;
mod places;
pub(crate) mod ports;
pub(crate) mod search;
pub(crate) mod swap;

use std::collections::{BTreeMap, BTreeSet, HashSet};

use egui::{PointerButton, Pos2, Rect};
use maquette_graph::{Edit, NodeId};

use crate::command::{GraphCommand, NewLink, ViewCommand};
use crate::panel::PanelContext;

use self::card::{Card, Cards};
use self::link_drag::LinkDrag;
use self::places::Places;
use self::search::Search;

/// What all parts of the canvas need to know in a frame.
struct Stage<'a> {
    cards: &'a Cards,
    /// Where the nodes stand, in the order of the cards.
    corners: Vec<Pos2>,
    /// What of the canvas is seen.
    visible: Rect,
    /// Points of the screen for a point of the canvas.
    zoom: f32,
    dark: bool,
    /// Where the pointer is on the canvas.
    pointer: Option<Pos2>,
    /// Whether the pointer is on a node.
    is_over_node: bool,
    /// The rectangle from where the button was pressed to the pointer, while it is.
    band: Option<Rect>,
}

/// The canvas.
#[derive(Default)]
pub(crate) struct Canvas {
    places: BTreeMap<Vec<NodeId>, Places>,
    search: Option<Search>,
    drag: LinkDrag,
    frames: frames::Frames,
    /// The line along which links are cut, on the canvas.
    cut: Vec<Pos2>,
    /// Selected links, by the input at which they end.
    selected_links: BTreeSet<(NodeId, String)>,
    /// Where the button was pressed that is down.
    pressed: Option<Pos2>,
    /// The node whose menu is open.
    menu: Option<NodeId>,
    /// From the screen to the canvas, as of the last frame.
    to_canvas: egui::emath::TSTransform,
    /// What of the screen it covered in the last frame.
    pub(crate) rect: Option<Rect>,
    /// Whether all nodes are to be brought into view.
    pub(crate) frame_all: bool,
}

/// What the widget calls a node.
fn key(id: NodeId) -> egui_graph::NodeId {
    egui_graph::NodeId::new(id)
}

impl Canvas {
    /// Forgets the places of another document.
    pub(crate) fn clear(&mut self) {
        *self = Self::default();
    }

    /// The point of the canvas under a point of the screen.
    pub(crate) fn canvas_point(&self, screen: Pos2) -> [f64; 2] {
        let point = self.to_canvas.mul_pos(screen).round();
        [f64::from(point.x), f64::from(point.y)]
    }

    /// What a node covers on the screen.
    pub(crate) fn node_on_screen(&self, path: &[NodeId], node: NodeId) -> Option<Rect> {
        let places = self.places.get(path)?;
        let card = places.cards.of(node)?;
        Some(self.to_canvas.inverse() * card.rect(*places.view.layout.get(&card.key)?))
    }

    /// What these nodes cover on the canvas.
    pub(crate) fn rects(&self, path: &[NodeId], nodes: &BTreeSet<NodeId>) -> Vec<(NodeId, Rect)> {
        let Some(places) = self.places.get(path) else { return Vec::new() };
        let rect = |id: &NodeId| {
            let card = places.cards.of(*id)?;
            Some((*id, card.rect(*places.view.layout.get(&card.key)?)))
        };
        nodes.iter().filter_map(rect).collect()
    }

    /// Where a socket is on the screen.
    pub(crate) fn socket_on_screen(&self, path: &[NodeId], (node, port, output): (NodeId, &str, bool)) -> Option<Pos2> {
        let places = self.places.get(path)?;
        let card = places.cards.of(node)?;
        let ports = if output { &card.outputs } else { &card.inputs };
        let index = ports.iter().position(|known| known.name == port)?;
        let place = if output { card.output(index) } else { card.input(index) };
        Some(self.to_canvas.inverse() * (*places.view.layout.get(&card.key)? + place?))
    }

    /// The links that are selected, by the input at which each ends; none is afterwards.
    pub(crate) fn take_selected_links(&mut self) -> BTreeSet<(NodeId, String)> {
        std::mem::take(&mut self.selected_links)
    }

    /// Whether a node to add is searched.
    pub(crate) fn is_searching(&self) -> bool {
        self.search.is_some()
    }

    /// Opens the search at a point of the screen, or closes it.
    pub(crate) fn toggle_search(&mut self, screen: Pos2) {
        self.search = match self.search {
            Some(_) => None,
            None => Some(Search::new(screen, self.canvas_point(screen), NewLink::None)),
        };
    }

    pub(crate) fn show(&mut self, ui: &mut egui::Ui, context: &mut PanelContext<'_>) {
        self.breadcrumbs(ui, context);
        let rect = ui.available_rect_before_wrap();
        self.rect = Some(rect);
        let graph = context.graph();
        let mut places = self.places.remove(&context.view.path).unwrap_or_default();
        if places.cards.refresh(context.document.revision(), graph, &context.view.expanded) {
            places.take_over(graph);
        }
        if (!places.framed || self.frame_all) && rect.area() > 1.0 {
            places.frame(graph, rect);
            self.frame_all = false;
        }
        let graph_id = egui_graph::id(("canvas", context.view.path.as_slice()));
        let selection = &context.view.selection;
        let cards = &places.cards;
        // In every frame: what is not seen, the widget forgets.
        let selected: HashSet<_> = selection.iter().filter_map(|id| Some(cards.of(*id)?.key)).collect();
        let widget =
            egui_graph::Graph::from_id(graph_id).zoom_range(places::ZOOM).dot_grid(false).selected_nodes(selected);
        let corners =
            cards.all.iter().map(|card| places.view.layout.get(&card.key).map_or(Pos2::ZERO, |at| at.round()));
        let corners = corners.collect();
        let mut is_over_node = false;
        let mut with_frame = frames::Moved::default();
        let shown = widget.show(&mut places.view, ui, |ui, show| {
            let mut stage = self.stage(ui, cards, corners);
            let mut painted = Vec::new();
            let mut seen = links::Seen::default();
            nodes::dots(ui, &stage);
            with_frame = self.frames.show(ui, context, &stage);
            show.nodes(ui, |nodes, ui| painted = self.nodes(nodes, ui, context, &mut stage)).edges(ui, |edges, ui| {
                seen = self.links(edges, ui, context, &stage);
                self.paint(ui, context, &stage, &painted);
                self.drag.show_line(edges, ui, context, graph_id);
                self.show_cut(ui);
            });
            is_over_node = stage.is_over_node;
            seen
        });
        let seen = shown.inner;
        if is_over_node && ui.rect_contains_pointer(rect) {
            places::navigate(&mut places.view, ui, rect);
        }
        if let Some(selected) = shown.selection_changed {
            let now: BTreeSet<NodeId> =
                cards.all.iter().filter(|card| selected.contains(&card.key)).map(|card| card.id).collect();
            // The last one that came is the one to look at.
            let fresh = now.iter().copied().find(|id| !selection.contains(id));
            let active = fresh.or(context.view.active.filter(|id| now.contains(id)));
            let rest = now.iter().copied().filter(|id| Some(*id) != active);
            context.ask(ViewCommand::Select(rest.chain(active).collect()));
        }
        for (id, place) in &with_frame.nodes {
            places.view.layout.insert(key(*id), *place);
        }
        if with_frame.ended {
            let nodes: Vec<NodeId> = with_frame.nodes.iter().map(|(id, _)| *id).collect();
            let nodes = places.moves(&nodes);
            let edits = std::iter::once(Edit::Frames(with_frame.frames)).chain(nodes).collect();
            let name = if with_frame.nodes.is_empty() { "change a frame" } else { "move a frame" };
            context.ask(GraphCommand::Edit { name: name.to_owned(), edits, gesture: None });
        }
        if shown.nodes_moved {
            places.moved(graph, context, &seen);
        }
        self.background(&shown.response, ui, context, &seen);
        self.places.insert(context.view.path.clone(), places);
        if let Some(mut search) = self.search.take()
            && search.show(ui, context)
        {
            self.search = Some(search);
        }
        self.drag.show_refusal(ui);
        if graph.nodes().len() == 0 {
            let text = "empty: press Tab to add a node, or draw in a view with the Sketch tool";
            let font = egui::FontId::proportional(14.0);
            // The widget's own layer lies over that of the panel.
            let layer = egui::LayerId::new(egui::Order::Middle, ui.id().with("empty"));
            let painter = ui.ctx().layer_painter(layer).with_clip_rect(rect);
            painter.text(rect.center(), egui::Align2::CENTER_CENTER, text, font, ui.visuals().weak_text_color());
        }
    }

    /// Where one is: the graphs that were entered, each to go back to.
    fn breadcrumbs(&self, ui: &mut egui::Ui, context: &mut PanelContext<'_>) {
        if context.is_outermost() {
            return;
        }
        let height = ui.spacing().interact_size.y + 6.0;
        let bar = Rect::from_min_size(ui.available_rect_before_wrap().min, egui::vec2(ui.available_width(), height));
        ui.painter().rect_filled(bar, 0.0, ui.visuals().panel_fill);
        let layout = egui::Layout::left_to_right(egui::Align::Center);
        ui.allocate_ui_with_layout(bar.size(), layout, |ui| {
            ui.add_space(6.0);
            let mut asked = None;
            if ui.button(context.document.name()).on_hover_text("Back to the whole graph").clicked() {
                asked = Some(0);
            }
            let mut graph = context.document.graph();
            for (depth, id) in context.view.path.iter().enumerate() {
                let Some(node) = graph.node(*id) else { break };
                ui.label("›");
                let last = depth + 1 == context.view.path.len();
                if ui.add(egui::Button::selectable(last, node.name())).clicked() && !last {
                    asked = Some(depth + 1);
                }
                let Some(within) = node.body().and_then(|body| body.graph()) else { break };
                graph = within;
            }
            if let Some(depth) = asked {
                context.ask(ViewCommand::LeaveTo(depth));
            }
        });
    }

    /// What is known when a frame begins.
    fn stage<'a>(&mut self, ui: &egui::Ui, cards: &'a Cards, corners: Vec<Pos2>) -> Stage<'a> {
        self.to_canvas = ui.ctx().layer_transform_from_global(ui.layer_id()).unwrap_or_default();
        let (pointer, pressed, goes_on) = ui.input(|i| {
            let pointer = &i.pointer;
            (pointer.latest_pos(), pointer.primary_pressed(), pointer.primary_down() || pointer.primary_released())
        });
        let pointer = pointer.map(|pointer| self.to_canvas.mul_pos(pointer));
        if pressed {
            self.pressed = pointer;
        }
        self.pressed = self.pressed.filter(|_| goes_on);
        Stage {
            cards,
            corners,
            visible: ui.clip_rect(),
            zoom: 1.0 / self.to_canvas.scaling.max(1e-3),
            dark: ui.visuals().dark_mode,
            pointer,
            is_over_node: false,
            band: self.pressed.zip(pointer).map(|(from, to)| Rect::from_two_pos(from, to)),
        }
    }

    /// What the canvas itself answers to: menu, cutting of links.
    fn background(
        &mut self,
        response: &egui::Response,
        ui: &egui::Ui,
        context: &mut PanelContext<'_>,
        seen: &links::Seen,
    ) {
        response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Other, true, "canvas"));
        if response.dragged_by(PointerButton::Secondary)
            && let Some(pointer) = ui.input(|i| i.pointer.latest_pos())
        {
            if self.cut.is_empty() {
                // It is a drag only after a few points: the cut begins where the button was pressed.
                self.cut.extend(ui.input(|i| i.pointer.press_origin()).map(|origin| self.to_canvas.mul_pos(origin)));
            }
            self.cut.push(self.to_canvas.mul_pos(pointer));
        } else if !self.cut.is_empty() {
            let line = std::mem::take(&mut self.cut);
            let edits: Vec<Edit> =
                seen.crossed(&line).into_iter().map(|(to, input)| Edit::Disconnect { to, input }).collect();
            if !edits.is_empty() {
                context.ask(GraphCommand::Edit { name: "cut links".to_owned(), edits, gesture: None });
            }
        }
        let pointer = ui.input(|i| i.pointer.latest_pos()).unwrap_or(response.rect.center());
        response.context_menu(|ui| {
            let item = |ui: &mut egui::Ui, text: &str, keys: &str| {
                let clicked = ui.add(egui::Button::new(text).shortcut_text(keys)).clicked();
                if clicked {
                    ui.close();
                }
                clicked
            };
            if item(ui, "Add node…", "Tab") {
                self.search = Some(Search::new(pointer, self.canvas_point(pointer), NewLink::None));
            }
            if item(ui, "Select all", "Ctrl+A") {
                context.ask(ViewCommand::SelectAll);
            }
            if item(ui, "Frame the selected nodes", "Ctrl+J") {
                context.ask(GraphCommand::Frame);
            }
            if item(ui, "Arrange all", "L") {
                context.ask(GraphCommand::Arrange);
            }
            if item(ui, "Arrange selected", "Shift+L") {
                context.ask(GraphCommand::ArrangeSelected);
            }
            if item(ui, "Frame all", "Home") {
                self.frame_all = true;
            }
        });
    }

    fn show_cut(&self, ui: &egui::Ui) {
        if self.cut.len() > 1 {
            let stroke = egui::Stroke::new(1.5, ui.visuals().error_fg_color);
            ui.painter().add(egui::Shape::dashed_line(&self.cut, stroke, 6.0, 4.0));
        }
    }
}
