//! Where the nodes of a graph stand on the canvas, and what of it is seen.

use std::collections::{BTreeMap, BTreeSet};

use egui::{PointerButton, Pos2, Rect};
use maquette_graph::{Edit, Graph, NodeId};

use crate::command::GraphCommand;
use crate::panel::PanelContext;

use super::card::Cards;
use super::{arrange, frames, key, links};

/// Points of the screen for a point of the canvas, at least and at most.
pub(super) const ZOOM: egui::Rangef = egui::Rangef { min: 0.1, max: 1.5 };

/// Where the nodes of one graph stand, and what of it is seen.
#[derive(Default)]
pub(super) struct Places {
    pub(super) view: egui_graph::View,
    pub(super) cards: Cards,
    /// Where the document says that nodes stand, as it was taken over last.
    known: BTreeMap<NodeId, Option<[f64; 2]>>,
    pub(super) framed: bool,
}

impl Places {
    /// Takes over where the document says that nodes stand; finds a place for those of which it says nothing.
    pub(super) fn take_over(&mut self, graph: &Graph) {
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
    pub(super) fn frame(&mut self, graph: &Graph, rect: Rect) {
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
    pub(super) fn moves(&mut self, nodes: &[NodeId]) -> Vec<Edit> {
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
    pub(super) fn moved(&mut self, graph: &Graph, context: &mut PanelContext<'_>, seen: &links::Seen) {
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

/// Zooms with the wheel and moves with the middle button where a node is under the pointer: beside nodes the widget does.
pub(super) fn navigate(view: &mut egui_graph::View, ui: &egui::Ui, rect: Rect) {
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
