//! The canvas: the graph as nodes and links. The widget keeps places and the view; nodes, links and names are those of the
//! document in every frame.

pub(crate) mod arrange;
pub(crate) mod card;
pub(crate) mod face;
pub(crate) mod frames;
mod link_drag;
mod links;
pub(crate) mod ports;
pub(crate) mod search;
pub(crate) mod swap;

use std::collections::{BTreeMap, BTreeSet, HashSet};

use egui::{PointerButton, Pos2, Rect, Sense};
use egui_graph::node::EdgeEvent;
use maquette_graph::{Edit, Graph, Node, NodeId};

use crate::command::{GraphCommand, NewLink, ViewCommand};
use crate::panel::PanelContext;

use self::card::{Card, Cards};
use self::face::Face;
use self::link_drag::LinkDrag;
use self::search::Search;

/// Where the nodes of one graph stand, and what of it is seen.
#[derive(Default)]
struct Places {
    view: egui_graph::View,
    cards: Cards,
    /// Where the document says that nodes stand, as it was taken over last.
    known: BTreeMap<NodeId, Option<[f64; 2]>>,
    framed: bool,
}

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

/// Points of the screen for a point of the canvas, at least and at most.
const ZOOM: egui::Rangef = egui::Rangef { min: 0.1, max: 1.5 };
/// So many nodes are widgets at any zoom.
const FEW: usize = 120;
/// How far from a node the pointer may be to do something with it, points of the canvas.
const REACH: f32 = 34.0;
/// Points of the canvas between two dots of its background, and of the screen at least.
const DOTS: f32 = 20.0;
const DOTS_ON_SCREEN: f32 = 18.0;

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
        let widget = egui_graph::Graph::from_id(graph_id).zoom_range(ZOOM).dot_grid(false).selected_nodes(selected);
        let corners =
            cards.all.iter().map(|card| places.view.layout.get(&card.key).map_or(Pos2::ZERO, |at| at.round()));
        let corners = corners.collect();
        let mut is_over_node = false;
        let mut with_frame = frames::Moved::default();
        let shown = widget.show(&mut places.view, ui, |ui, show| {
            let mut stage = self.stage(ui, cards, corners);
            let mut painted = Vec::new();
            let mut seen = links::Seen::default();
            dots(ui, &stage);
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
            navigate(&mut places.view, ui, rect);
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

    /// Shows the nodes with which something can be done in this frame, and gives those that only need to be painted. A large
    /// graph stays quick because of that.
    fn nodes(
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
    fn paint(&self, ui: &egui::Ui, context: &PanelContext<'_>, stage: &Stage<'_>, painted: &[usize]) {
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

/// Zooms with the wheel and moves with the middle button where a node is under the pointer: beside nodes the widget does.
fn navigate(view: &mut egui_graph::View, ui: &egui::Ui, rect: Rect) {
    let (zoom, moved, pointer) = ui.input(|i| {
        let is_moving = i.pointer.middle_down() && !i.pointer.button_pressed(PointerButton::Middle);
        let moved = if is_moving { i.pointer.delta() } else { egui::Vec2::ZERO };
        (i.zoom_delta(), moved + i.smooth_scroll_delta(), i.pointer.latest_pos())
    });
    let Some(pointer) = pointer.filter(|_| zoom != 1.0 || moved != egui::Vec2::ZERO) else { return };
    let seen = view.scene_rect;
    let scale = rect.width() / seen.width().max(1e-3);
    let wanted = (scale * zoom).clamp(ZOOM.min, ZOOM.max);
    // What is under the pointer stays there.
    let under = seen.min + (pointer - rect.min) / scale;
    let corner = under - (pointer - rect.min) / wanted - moved / wanted;
    view.scene_rect = Rect::from_min_size(corner, rect.size() / wanted);
}

/// What a node is called for those who do not see it.
fn named(node: &Node, selected: bool) -> egui::WidgetInfo {
    egui::WidgetInfo::selected(egui::WidgetType::Button, true, selected, format!("node {}", node.name()))
}

/// Dots in the background, so that one sees how the canvas moves; fewer where it is seen from afar.
fn dots(ui: &egui::Ui, stage: &Stage<'_>) {
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

impl Places {
    /// Takes over where the document says that nodes stand; finds a place for those of which it says nothing.
    fn take_over(&mut self, graph: &Graph) {
        let mut homeless = BTreeSet::new();
        for (id, node) in graph.nodes() {
            let now = node.position();
            let is_known = self.known.get(&id) == Some(&now) && self.view.layout.contains_key(&key(id));
            if is_known {
                continue;
            }
            match now {
                #[expect(clippy::cast_possible_truncation, reason = "points of a canvas")]
                Some([x, y]) => {
                    self.view.layout.insert(key(id), Pos2::new(x as f32, y as f32));
                }
                None => {
                    homeless.insert(id);
                }
            }
            self.known.insert(id, now);
        }
        self.known.retain(|id, _| graph.node(*id).is_some());
        if !homeless.is_empty() {
            let stand = self.cards.all.iter().filter(|card| !homeless.contains(&card.id));
            let stand = stand.filter_map(|card| Some(card.rect(*self.view.layout.get(&card.key)?)));
            // Below those that have a place.
            let corner =
                stand.reduce(|a, b| a.union(b)).map_or(Pos2::ZERO, |all| all.left_bottom() + egui::vec2(0.0, 60.0));
            for (id, place) in arrange::arrange_at(&self.cards, |id| homeless.contains(&id), corner) {
                self.view.layout.insert(key(id), place);
            }
        }
    }

    /// Brings all nodes into view.
    fn frame(&mut self, graph: &Graph, rect: Rect) {
        let rects = self.cards.all.iter().filter_map(|card| Some(card.rect(*self.view.layout.get(&card.key)?)));
        let all = rects
            .chain(graph.frames().iter().map(frames::rect_of))
            .reduce(|a, b| a.union(b))
            .unwrap_or(Rect::from_min_size(Pos2::ZERO, rect.size()));
        let all = all.expand(40.0);
        // Not nearer than one to one, so that a few nodes do not fill the window.
        let size = all.size().max(rect.size());
        let size = if size.x / size.y > rect.width() / rect.height() {
            egui::vec2(size.x, size.x * rect.height() / rect.width())
        } else {
            egui::vec2(size.y * rect.width() / rect.height(), size.y)
        };
        self.view.scene_rect = Rect::from_center_size(all.center(), size);
        self.framed = true;
    }

    /// The edits that put nodes where they are on the canvas.
    fn moves(&mut self, nodes: &[NodeId]) -> Vec<Edit> {
        let mut edits = Vec::new();
        for node in nodes {
            if let Some(place) = self.view.layout.get(&key(*node)).map(|place| place.round()) {
                let position = Some([f64::from(place.x), f64::from(place.y)]);
                self.known.insert(*node, position);
                edits.push(Edit::Move { node: *node, position });
            }
        }
        edits
    }

    /// Tells the document where the selected nodes were put, and whether one was dropped on a link.
    fn moved(&mut self, graph: &Graph, context: &mut PanelContext<'_>, seen: &links::Seen) {
        let selection = &context.view.selection;
        let selected: Vec<NodeId> = selection.iter().copied().collect();
        let edits = self.moves(&selected);
        let alone = selection.first().copied().filter(|_| selection.len() == 1);
        let dropped = alone.and_then(|id| {
            let card = self.cards.of(id)?;
            let place = *self.view.layout.get(&card.key)?;
            let free = !card.inputs.iter().any(|port| port.linked) && graph.fed_by(id).is_empty();
            let (to, input) = seen.under(card.rect(place).shrink(6.0)).filter(|_| free)?;
            Some(GraphCommand::DropOnLink { node: id, to, input, at: [f64::from(place.x), f64::from(place.y)] })
        });
        match dropped {
            Some(dropped) => context.ask(dropped),
            None => context.ask(GraphCommand::Edit { name: "move nodes".to_owned(), edits, gesture: None }),
        }
    }
}
