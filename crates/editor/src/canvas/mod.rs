//! The canvas: the graph as nodes and links. The widget keeps places and the view; nodes, links and names are those of the
//! document in every frame.

pub(crate) mod arrange;
pub(crate) mod face;
mod link_drag;
mod links;
pub(crate) mod ports;
pub(crate) mod search;

use std::collections::{BTreeMap, BTreeSet, HashSet};

use egui::{PointerButton, Pos2, Rect};
use egui_graph::node::EdgeEvent;
use maquette_graph::{Edit, Graph, NodeId};

use crate::command::{GraphCommand, NewLink, ViewCommand};
use crate::panel::PanelContext;

use self::link_drag::LinkDrag;
use self::search::Search;

/// Where the nodes of one graph stand, and what of it is seen.
#[derive(Default)]
struct Places {
    view: egui_graph::View,
    /// Where the document says that nodes stand, as it was taken over last.
    known: BTreeMap<NodeId, Option<[f64; 2]>>,
    /// The selection as the widget was told last.
    selection: BTreeSet<NodeId>,
    framed: bool,
}

/// The canvas.
#[derive(Default)]
pub(crate) struct Canvas {
    places: BTreeMap<Vec<NodeId>, Places>,
    search: Option<Search>,
    drag: LinkDrag,
    /// The line along which links are cut, on the canvas.
    cut: Vec<Pos2>,
    /// Selected links, by the input at which they end.
    selected_links: BTreeSet<(NodeId, String)>,
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
    pub(crate) fn node_on_screen(&self, graph: &Graph, path: &[NodeId], node: NodeId) -> Option<Rect> {
        let place = *self.places.get(path)?.view.layout.get(&key(node))?;
        graph.node(node)?;
        Some(self.to_canvas.inverse() * Rect::from_min_size(place, arrange::size(graph, node)))
    }

    /// Where a socket is on the screen.
    pub(crate) fn socket_on_screen(
        &self,
        context: &egui::Context,
        graph: &Graph,
        path: &[NodeId],
        (node, port, output): (NodeId, &str, bool),
    ) -> Option<Pos2> {
        let held = graph.node(node)?;
        let index = |ports: Vec<ports::Port>| ports.iter().position(|known| known.name == port);
        let index = index(if output { ports::outputs(graph, node, held) } else { ports::inputs(held) })?;
        let place = egui_graph::with_graph_memory(context, egui_graph::id(("canvas", path)), |memory| {
            let sockets = memory.node_sockets().get(&key(node))?;
            let place = if output { sockets.output(index) } else { sockets.input(index) };
            place.map(|(place, _)| place)
        })?;
        Some(self.to_canvas.inverse() * place)
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
        places.take_over(graph);
        if (!places.framed || self.frame_all) && rect.area() > 1.0 {
            places.frame(graph, rect);
            self.frame_all = false;
        }
        let mut widget = egui_graph::Graph::from_id(egui_graph::id(("canvas", context.view.path.as_slice())))
            .zoom_range(0.1..=1.5)
            .dot_grid_step(20.0);
        if places.selection != context.view.selection {
            places.selection.clone_from(&context.view.selection);
            widget = widget.selected_nodes(places.selection.iter().map(|id| key(*id)).collect::<HashSet<_>>());
        }
        let graph_id = egui_graph::id(("canvas", context.view.path.as_slice()));
        let shown = widget.show(&mut places.view, ui, |ui, show| {
            self.to_canvas = ui.ctx().layer_transform_from_global(ui.layer_id()).unwrap_or_default();
            let mut seen = links::Seen::default();
            show.nodes(ui, |nodes, ui| self.nodes(nodes, ui, context)).edges(ui, |edges, ui| {
                seen = self.links(edges, ui, context);
                self.drag.show_line(edges, ui, context, graph_id);
                self.show_cut(ui);
            });
            seen
        });
        let seen = shown.inner;
        if let Some(selected) = shown.selection_changed {
            let now: BTreeSet<NodeId> =
                graph.nodes().map(|(id, _)| id).filter(|id| selected.contains(&key(*id))).collect();
            // The last one that came is the one to look at.
            let fresh = now.iter().copied().find(|id| !places.selection.contains(id));
            let active = fresh.or(context.view.active.filter(|id| now.contains(id)));
            let rest = now.iter().copied().filter(|id| Some(*id) != active);
            context.ask(ViewCommand::Select(rest.chain(active).collect()));
            places.selection = now;
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
            ui.painter().text(rect.center(), egui::Align2::CENTER_CENTER, text, font, ui.visuals().weak_text_color());
        }
    }

    /// Where one is: the graphs that were entered, each to go back to.
    fn breadcrumbs(&self, ui: &mut egui::Ui, context: &mut PanelContext<'_>) {
        if context.is_outermost() {
            return;
        }
        ui.horizontal(|ui| {
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

    fn nodes(&mut self, nodes: &mut egui_graph::NodesCtx<'_>, ui: &mut egui::Ui, context: &mut PanelContext<'_>) {
        let graph = context.graph();
        let dark = ui.visuals().dark_mode;
        let zoom = 1.0 / self.to_canvas.scaling.max(1e-3);
        for (id, node) in graph.nodes() {
            let inputs = ports::inputs(node);
            let outputs = ports::outputs(graph, id, node);
            let expanded = context.view.expanded.contains(&id);
            let rows = inputs.iter().filter(|port| ports::is_shown(port, expanded)).count();
            let colour = ports::wire_colour(outputs.first().and_then(|port| port.wire), dark);
            let response = egui_graph::node::Node::from_id(key(id))
                .inputs(rows)
                .outputs(outputs.len())
                .collapsed(true)
                .max_width(arrange::WIDTH)
                .animation_time(0.0)
                .socket_radius(4.0)
                .socket_color(colour)
                .show_or_cull(nodes, ui, |node_context| {
                    let mut frame = egui_graph::node::default_frame(node_context.style(), node_context.interaction());
                    frame.inner_margin = egui::Margin::symmetric(9, 6);
                    if node.is_muted() {
                        frame.fill = frame.fill.gamma_multiply(0.7);
                    }
                    node_context.framed_with(frame, |ui, sockets| face::show(ui, sockets, context, id, node, zoom))
                });
            self.paint_sockets(ui, &response, &inputs, &outputs, dark);
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
            if response.double_clicked() && node.body().is_some_and(|body| body.graph().is_some()) {
                context.ask(ViewCommand::Enter(id));
            }
            if response.secondary_clicked() && !context.view.selection.contains(&id) {
                context.ask(ViewCommand::Select(vec![id]));
            }
            response.context_menu(|ui| face::menu(ui, context, id, node));
        }
    }

    /// Colours each socket by its type, and names it for those who do not see it.
    fn paint_sockets<T>(
        &self,
        ui: &egui::Ui,
        response: &egui_graph::node::NodeResponse<T>,
        inputs: &[ports::Port],
        outputs: &[ports::Port],
        dark: bool,
    ) {
        let sockets = response.sockets();
        let named = sockets
            .inputs()
            .map(|(index, socket)| ("input", inputs.get(index), socket))
            .chain(sockets.outputs().map(|(index, socket)| ("output", outputs.get(index), socket)));
        for (what, port, socket) in named {
            let Some(port) = port else { continue };
            ui.painter().circle_filled(socket.rect.center(), 4.0, ports::wire_colour(port.wire, dark));
            let label = format!("{what} {}", port.name);
            socket.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Other, true, &label));
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
            if item(ui, "Arrange all", "L") {
                context.ask(GraphCommand::Arrange);
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

impl Places {
    /// Takes over where the document says that nodes stand; finds a place for those of which it says nothing.
    fn take_over(&mut self, graph: &Graph) {
        let mut homeless = Vec::new();
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
                None => homeless.push(id),
            }
            self.known.insert(id, now);
        }
        self.known.retain(|id, _| graph.node(*id).is_some());
        if !homeless.is_empty() {
            let arranged = arrange::arrange(graph);
            for id in homeless {
                if let Some(place) = arranged.get(&id) {
                    self.view.layout.insert(key(id), *place);
                }
            }
        }
    }

    /// Brings all nodes into view.
    fn frame(&mut self, graph: &Graph, rect: Rect) {
        let rects = graph.nodes().filter_map(|(id, _)| {
            let place = self.view.layout.get(&key(id))?;
            Some(Rect::from_min_size(*place, arrange::size(graph, id)))
        });
        let all = rects.reduce(|a, b| a.union(b)).unwrap_or(Rect::from_min_size(Pos2::ZERO, rect.size()));
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

    /// Tells the document where the selected nodes were put, and whether one was dropped on a link.
    fn moved(&mut self, graph: &Graph, context: &mut PanelContext<'_>, seen: &links::Seen) {
        let mut edits = Vec::new();
        for id in &self.selection {
            if let Some(place) = self.view.layout.get(&key(*id)) {
                let position = Some([f64::from(place.x), f64::from(place.y)]);
                self.known.insert(*id, position);
                edits.push(Edit::Move { node: *id, position });
            }
        }
        let alone = self.selection.first().copied().filter(|_| self.selection.len() == 1);
        let dropped = alone.and_then(|id| {
            let place = self.view.layout.get(&key(id))?;
            let node = graph.node(id)?;
            let free = !ports::inputs(node).iter().any(|port| port.linked) && graph.fed_by(id).is_empty();
            let rect = Rect::from_min_size(*place, arrange::size(graph, id)).shrink(6.0);
            let (to, input) = seen.under(rect).filter(|_| free)?;
            Some(GraphCommand::DropOnLink { node: id, to, input, at: [f64::from(place.x), f64::from(place.y)] })
        });
        match dropped {
            Some(dropped) => context.ask(dropped),
            None => context.ask(GraphCommand::Edit { name: "move nodes".to_owned(), edits, gesture: None }),
        }
    }
}
