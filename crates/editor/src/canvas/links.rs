//! Links on the canvas: drawn, selected, cut, dropped on. Only those that are seen are looked at, and only those under the
//! pointer become something to click on.

use egui::{Pos2, Rect, Sense, Shape, Stroke, Vec2};
use egui_graph::edge::EdgeShape;
use maquette_graph::{Edit, NodeId};

use crate::command::{GraphCommand, NewLink};
use crate::panel::PanelContext;

use super::card::{Cards, LinkCard};
use super::search::Search;
use super::{Canvas, Stage};

/// How links run.
pub(super) const SHAPE: EdgeShape = EdgeShape::DEFAULT;
/// How far a link may be from the rectangle around its ends, points: the longest handle of its curve.
const BULGE: f32 = EdgeShape::DEFAULT_MAX_HANDLE;

/// Where links run, by the input at which each ends. Filled while something is dragged.
#[derive(Default)]
pub(super) struct Seen {
    links: Vec<(NodeId, String, Vec<Pos2>)>,
}

/// Whether two pieces of lines cross.
fn cross([a, b]: [Pos2; 2], [c, d]: [Pos2; 2]) -> bool {
    let side = |p: Pos2, q: Pos2, r: Pos2| (q - p).x * (r - p).y - (q - p).y * (r - p).x;
    // A point on the other line counts to one side of it, so that a cut through a point of a link is none too few.
    let parted = |one: f32, other: f32| (one >= 0.0) != (other >= 0.0);
    parted(side(a, b, c), side(a, b, d)) && parted(side(c, d, a), side(c, d, b))
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

/// The point of a line that is nearest to another point.
fn nearest(line: &[Pos2], to: Pos2) -> Option<Pos2> {
    let on = |[a, b]: [Pos2; 2]| {
        let along = b - a;
        let share = ((to - a).dot(along) / along.length_sq().max(1e-9)).clamp(0.0, 1.0);
        a + share * along
    };
    windows(line).map(on).min_by(|a, b| a.distance_sq(to).total_cmp(&b.distance_sq(to)))
}

/// The way of a link, as fine as can be seen.
fn way(a: Pos2, b: Pos2, zoom: f32) -> Vec<Pos2> {
    let path = SHAPE.path((a, Vec2::RIGHT), &[], (b, Vec2::LEFT));
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 4 to 48")]
    let count = ((a - b).length() * zoom / 9.0).clamp(4.0, 48.0) as u32;
    #[expect(clippy::cast_precision_loss, reason = "from 4 to 48")]
    let share = |step: u32| step as f32 / count as f32;
    path.segments().iter().flat_map(|cubic| (0..=count).map(move |step| cubic.sample(share(step)))).collect()
}

/// What links answer to in this frame.
struct Answers {
    /// Where the pointer is on the canvas, where no node is.
    pointer: Option<Pos2>,
    /// Whether the pointer may choose links: none is being dragged.
    free: bool,
    deletes: bool,
    /// Whether a click elsewhere takes the selection away.
    deselects: bool,
    /// The rectangle that selects links, and whether it is let go now.
    band: Option<(Rect, bool)>,
    adds: bool,
}

impl Answers {
    fn of(edges: &egui_graph::EdgesCtx, ui: &egui::Ui, stage: &Stage<'_>) -> Self {
        let free = edges.in_progress(ui).is_none();
        let typing = ui.ctx().egui_wants_keyboard_input();
        let pointer = stage.pointer.filter(|_| !stage.is_over_node);
        ui.input(|i| Self {
            pointer,
            free,
            // Delete is a command of its own.
            deletes: !typing && i.key_pressed(egui::Key::Backspace),
            deselects: i.pointer.primary_pressed() && !i.modifiers.command,
            band: stage.band.filter(|_| i.modifiers.shift).map(|band| (band, i.pointer.primary_released())),
            adds: i.modifiers.command,
        })
    }
}

impl Canvas {
    pub(super) fn links(
        &mut self,
        edges: &egui_graph::EdgesCtx,
        ui: &mut egui::Ui,
        context: &mut PanelContext<'_>,
        stage: &Stage<'_>,
    ) -> Seen {
        let answers = Answers::of(edges, ui, stage);
        let cards = stage.cards;
        let wanted = ui.input(|i| i.pointer.any_down() || i.pointer.any_released());
        let accent = ui.visuals().selection.stroke.color;
        let mut seen = Seen::default();
        let mut shapes = Vec::new();
        let mut removed = Vec::new();
        let mut insert = None;
        for link in &cards.links {
            let (from, to) = (&cards.all[link.from], &cards.all[link.to]);
            let (Some(begin), Some(end)) = (from.output(link.output), to.input(link.input)) else { continue };
            let ends = [stage.corners[link.from] + begin, stage.corners[link.to] + end];
            let bounds = Rect::from_two_pos(ends[0], ends[1]).expand(BULGE);
            let port = &to.inputs[link.input].name;
            let mut selected = !self.selected_links.is_empty()
                && self.selected_links.iter().any(|(node, input)| *node == to.id && input == port);
            let was_selected = selected;
            if selected && answers.deletes {
                removed.push(Edit::Disconnect { to: to.id, input: port.clone() });
            }
            let mut hovered = false;
            if stage.visible.intersects(bounds) {
                let line = way(ends[0], ends[1], stage.zoom);
                let response = self.respond(ui, cards, link, &line, bounds, &answers);
                if let Some(response) = &response {
                    hovered = answers.free && response.hovered();
                    response.context_menu(|ui| {
                        if ui.button("Disconnect").clicked() {
                            removed.push(Edit::Disconnect { to: to.id, input: port.clone() });
                            ui.close();
                        }
                        if ui.button("Add a node behind it…").clicked() {
                            let output = from.outputs[link.output].name.clone();
                            insert = Some(NewLink::From { node: from.id, output });
                            ui.close();
                        }
                    });
                }
                let clicked = answers.free && response.is_some_and(|response| response.clicked());
                let banded = answers.band.filter(|(band, _)| line.iter().any(|point| band.contains(*point)));
                hovered |= banded.is_some();
                if clicked {
                    selected = !(selected && answers.adds);
                } else if banded.is_some_and(|(_, done)| done) {
                    selected = true;
                } else if answers.deselects || !answers.free {
                    selected = false;
                }
                let colour = from.outputs[link.output].colour(stage.dark);
                let stroke = match (selected, hovered) {
                    (true, _) => Stroke::new(3.0, accent),
                    (_, true) => Stroke::new(3.0, colour),
                    _ => Stroke::new(if link.is_muted { 1.2 } else { 2.0 }, colour.gamma_multiply(0.85)),
                };
                if wanted {
                    seen.links.push((to.id, port.clone(), line.clone()));
                }
                shapes.push(Shape::line(line, stroke));
            } else if answers.deselects {
                selected = false;
            }
            if selected && !was_selected {
                self.selected_links.insert((to.id, port.clone()));
            } else if was_selected && !selected {
                self.selected_links.remove(&(to.id, port.clone()));
            }
        }
        ui.painter().extend(shapes);
        if !removed.is_empty() {
            self.selected_links.clear();
            context.ask(GraphCommand::Edit { name: "disconnect".to_owned(), edits: removed, gesture: None });
        }
        if let Some(link) = insert
            && let Some(pointer) = ui.input(|i| i.pointer.latest_pos())
        {
            self.search = Some(Search::new(pointer, self.canvas_point(pointer), link));
        }
        seen
    }

    /// What a link under the pointer answers, or one whose menu is open.
    fn respond(
        &self,
        ui: &egui::Ui,
        cards: &Cards,
        link: &LinkCard,
        line: &[Pos2],
        bounds: Rect,
        answers: &Answers,
    ) -> Option<egui::Response> {
        let (from, to) = (&cards.all[link.from], &cards.all[link.to]);
        let id = ui.id().with(("link", to.id, link.input));
        let reach = ui.style().interaction.interact_radius;
        let near = answers.pointer.filter(|pointer| bounds.expand(reach).contains(*pointer));
        let place = near.and_then(|pointer| nearest(line, pointer).filter(|p| p.distance(pointer) < 4.0 * reach));
        let rect = match place {
            Some(place) => Rect::from_center_size(place, Vec2::splat(2.0 * reach)),
            // Its menu goes on.
            None if egui::Popup::is_id_open(ui.ctx(), id.with("popup")) => Rect::NOTHING,
            None => return None,
        };
        let response = ui.interact(rect, id, Sense::click());
        response.widget_info(|| {
            let output = &from.outputs[link.output].name;
            let label = format!("link from {output} to {}", to.inputs[link.input].name);
            egui::WidgetInfo::labeled(egui::WidgetType::Button, true, label)
        });
        Some(response)
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
        assert_eq!(cut([10.0, -5.0], [10.0, 5.0]), 1, "through a point of the link");
        assert_eq!(cut([15.0, -5.0], [15.0, 5.0]), 1);
        assert!(seen.under(Rect::from_min_max(Pos2::new(8.0, -2.0), Pos2::new(12.0, 2.0))).is_some());
    }
}
