//! Dragging a link: what it may end at is said while it is dragged.

use egui::Pos2;
use egui_graph::SocketKind;
use maquette_graph::{Edit, NodeId, Source};

use crate::command::{Command, GraphCommand, Message, NewLink};
use crate::panel::PanelContext;

use super::{key, links, ports};

/// A link that is being dragged.
#[derive(Default)]
pub(crate) struct LinkDrag {
    /// The socket from which it is dragged.
    from: Option<(NodeId, SocketKind, usize)>,
    /// Why it can't end where the pointer is.
    refusal: Option<String>,
}

/// The name of a port by its socket.
fn port_name(context: &PanelContext<'_>, id: NodeId, kind: SocketKind, index: usize) -> Option<String> {
    let graph = context.graph();
    let node = graph.node(id)?;
    let ports = match kind {
        SocketKind::Input => ports::inputs(node),
        SocketKind::Output => ports::outputs(graph, id, node),
    };
    ports.get(index).map(|port| port.name.clone())
}

impl LinkDrag {
    /// Whether a link is being dragged from this node.
    pub(super) fn is_from(&self, id: NodeId) -> bool {
        self.from.is_some_and(|from| from.0 == id)
    }

    pub(super) fn begin(&mut self, context: &mut PanelContext<'_>, id: NodeId, kind: SocketKind, index: usize) {
        self.from = port_name(context, id, kind, index).map(|_| (id, kind, index));
    }

    /// The two ends as output and input, in whichever direction it was dragged.
    fn ends(
        &self,
        context: &PanelContext<'_>,
        to: (NodeId, SocketKind, usize),
    ) -> Option<((NodeId, String), (NodeId, String))> {
        let from = self.from?;
        let name = |(id, kind, index)| Some((id, port_name(context, id, kind, index)?));
        match (from.1, to.1) {
            (SocketKind::Output, SocketKind::Input) => Some((name(from)?, name(to)?)),
            (SocketKind::Input, SocketKind::Output) => Some((name(to)?, name(from)?)),
            _ => None,
        }
    }

    pub(super) fn end(&mut self, context: &mut PanelContext<'_>, id: NodeId, kind: SocketKind, index: usize) {
        if let Some(((from, output), (to, input))) = self.ends(context, (id, kind, index)) {
            match context.graph().check_link(context.catalogue, from, &output, to, &input) {
                Ok(()) => context.ask(GraphCommand::edit(Edit::connect(from, output, to, input))),
                Err(error) => context.ask(Command::Say(Message::error(error.to_string()))),
            }
        }
        self.from = None;
    }

    /// It ended in the void: a link that was there goes, for any other a new node is searched.
    pub(super) fn cancelled(&mut self, ui: &egui::Ui, context: &mut PanelContext<'_>) -> Option<NewLink> {
        let (node, kind, index) = self.from.take()?;
        self.refusal = None;
        let port = port_name(context, node, kind, index)?;
        // A click on a socket is no drag.
        let moved = ui.input(|i| Some((i.pointer.press_origin()? - i.pointer.latest_pos()?).length()));
        if moved.is_some_and(|moved| moved < 8.0) {
            return None;
        }
        match kind {
            SocketKind::Output => Some(NewLink::From { node, output: port }),
            SocketKind::Input => {
                if matches!(context.graph().node(node)?.source(&port), Some(Source::Link(_))) {
                    context.ask(GraphCommand::edit(Edit::Disconnect { to: node, input: port }));
                    return None;
                }
                Some(NewLink::To { node, input: port })
            }
        }
    }

    /// Draws the link that is being dragged and finds out whether it may end at the socket it is near.
    pub(super) fn show_line(
        &mut self,
        edges: &egui_graph::EdgesCtx,
        ui: &egui::Ui,
        context: &PanelContext<'_>,
        graph_id: egui::Id,
    ) {
        self.refusal = None;
        let Some(dragged) = edges.in_progress(ui) else { return };
        if dragged.end_socket.is_some()
            && let Some(near) = socket_at(ui, context, graph_id, dragged.end_pos, opposite(dragged.start.socket.kind))
            && let Some(((from, output), (to, input))) = self.ends(context, near)
        {
            let checked = context.graph().check_link(context.catalogue, from, &output, to, &input);
            self.refusal = checked.err().map(|error| error.to_string());
        }
        let colour =
            if self.refusal.is_some() { ui.visuals().error_fg_color } else { ui.visuals().strong_text_color() };
        dragged.show_styled(ui, Some(egui::Stroke::new(2.0, colour)), links::SHAPE);
    }

    /// Says at the pointer why the link can't end here.
    pub(super) fn show_refusal(&self, ui: &egui::Ui) {
        if let (Some(refusal), Some(pointer)) = (&self.refusal, ui.input(|i| i.pointer.latest_pos())) {
            let area = egui::Area::new(ui.id().with("refusal")).order(egui::Order::Tooltip).interactable(false);
            area.fixed_pos(pointer + egui::vec2(16.0, 12.0)).show(ui.ctx(), |ui| {
                egui::Frame::popup(ui.style()).show(ui, |ui| {
                    ui.set_max_width(320.0);
                    ui.label(egui::RichText::new(refusal).color(ui.visuals().error_fg_color));
                });
            });
        }
    }
}

fn opposite(kind: SocketKind) -> SocketKind {
    match kind {
        SocketKind::Input => SocketKind::Output,
        SocketKind::Output => SocketKind::Input,
    }
}

/// The socket that stands at a point of the canvas.
fn socket_at(
    ui: &egui::Ui,
    context: &PanelContext<'_>,
    graph_id: egui::Id,
    place: Pos2,
    kind: SocketKind,
) -> Option<(NodeId, SocketKind, usize)> {
    egui_graph::with_graph_memory(ui.ctx(), graph_id, |memory| {
        context.graph().nodes().find_map(|(id, _)| {
            let sockets = memory.node_sockets().get(&key(id))?;
            let at = |(index, position, _): (usize, Pos2, egui::Vec2)| {
                (position.distance_sq(place) < 0.25).then_some((id, kind, index))
            };
            match kind {
                SocketKind::Input => sockets.inputs().find_map(at),
                SocketKind::Output => sockets.outputs().find_map(at),
            }
        })
    })
}
