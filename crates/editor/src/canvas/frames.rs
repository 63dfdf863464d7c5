//! Frames behind the nodes: titled, coloured rectangles. A frame is moved by its title, and the nodes in it go along; its corner
//! changes its size. While that is done nothing but the canvas knows of it: the document gets one step at the end.

use egui::{Align2, Color32, FontId, Pos2, Rect, Sense, Stroke, Vec2, pos2, vec2};
use maquette_graph::{Edit, Frame, NodeId};

use crate::command::{GraphCommand, ViewCommand};
use crate::panel::PanelContext;

use super::{Stage, face};

/// Colours that are offered, sRGB, with their names.
pub(crate) const COLOURS: [([f64; 3], &str); 8] = [
    ([0.35, 0.45, 0.60], "slate"),
    ([0.22, 0.50, 0.80], "blue"),
    ([0.16, 0.58, 0.56], "teal"),
    ([0.32, 0.58, 0.28], "green"),
    ([0.76, 0.60, 0.14], "yellow"),
    ([0.82, 0.44, 0.16], "orange"),
    ([0.78, 0.28, 0.30], "red"),
    ([0.56, 0.36, 0.72], "purple"),
];
/// How far a new frame reaches beyond its nodes, points; above, there is room for the title.
const AROUND: Vec2 = vec2(24.0, 24.0);
/// Height of the part with the title, points.
pub(crate) const TITLE: f32 = 28.0;
/// Side of the corner that changes the size, points.
const CORNER: f32 = 18.0;
/// Least width and height, points.
const LEAST: Vec2 = vec2(80.0, 60.0);

/// A frame around nodes that cover these rectangles; `None` for none.
pub(crate) fn around(rects: impl IntoIterator<Item = Rect>) -> Option<Frame> {
    let all = rects.into_iter().reduce(|a, b| a.union(b))?.expand2(AROUND);
    let (at, size) = (all.min - vec2(0.0, TITLE), all.size() + vec2(0.0, TITLE));
    let numbers = |a: f32, b: f32| [f64::from(a.round()), f64::from(b.round())];
    Some(Frame {
        title: "frame".to_owned(),
        colour: COLOURS[0].0,
        at: numbers(at.x, at.y),
        size: numbers(size.x, size.y),
    })
}

/// What a frame covers.
#[expect(clippy::cast_possible_truncation, reason = "points of a canvas")]
pub(crate) fn rect_of(frame: &Frame) -> Rect {
    let [x, y] = frame.at.map(|number| number as f32);
    let [width, height] = frame.size.map(|number| number as f32);
    Rect::from_min_size(pos2(x, y), vec2(width, height))
}

fn colour_of(frame: &Frame) -> Color32 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    let [red, green, blue] = frame.colour.map(|part| (part.clamp(0.0, 1.0) * 255.0).round() as u8);
    Color32::from_rgb(red, green, blue)
}

/// What is behind the nodes in a frame, over the canvas.
pub(crate) fn fill_of(frame: &Frame) -> Color32 {
    colour_of(frame).gamma_multiply(0.22)
}

/// What of a frame is dragged.
#[derive(Clone, Debug, PartialEq)]
enum Grip {
    /// The title, and with it the nodes that are in the frame, from where they stood.
    Title(Vec<(NodeId, Pos2)>),
    Corner,
}

/// The frames of the canvas while something is done with them.
#[derive(Default)]
pub(super) struct Frames {
    /// The frame that is dragged, by what, and how far.
    drag: Option<(usize, Grip, Vec2)>,
    /// The frame whose title is typed, and the title; whether the field is new.
    typed: Option<(usize, String, bool)>,
}

/// What became of the frames in this frame of the window.
#[derive(Default)]
pub(super) struct Moved {
    /// Nodes that go along, and where they are now.
    pub(super) nodes: Vec<(NodeId, Pos2)>,
    /// Whether they were let go: the document is to know.
    pub(super) ended: bool,
    /// All frames as they are then.
    pub(super) frames: Vec<Frame>,
}

impl Frames {
    /// Draws the frames and answers to what is done with them.
    pub(super) fn show(&mut self, ui: &mut egui::Ui, context: &mut PanelContext<'_>, stage: &Stage<'_>) -> Moved {
        let mut moved = Moved::default();
        let frames = context.graph().frames();
        self.drag = self.drag.take().filter(|(index, ..)| *index < frames.len());
        for (index, frame) in frames.iter().enumerate() {
            let rect = self.now(index, frame);
            if !stage.visible.intersects(rect.expand(4.0)) && self.drag.is_none() {
                continue;
            }
            let colour = colour_of(frame);
            ui.painter().rect_filled(rect, 6.0, fill_of(frame));
            let border = colour.gamma_multiply(if stage.dark { 0.8 } else { 0.9 });
            ui.painter().rect_stroke(rect, 6.0, Stroke::new(1.5, border), egui::StrokeKind::Inside);
            self.corner(ui, rect, index, frame, &mut moved);
            self.title(ui, context, stage, rect, index, frame, &mut moved);
        }
        if moved.ended {
            moved.frames = self.dragged(frames).unwrap_or_default();
            self.drag = None;
        }
        moved
    }

    /// Where a frame is now, perhaps while it is dragged.
    fn now(&self, index: usize, frame: &Frame) -> Rect {
        let rect = rect_of(frame);
        match &self.drag {
            Some((dragged, Grip::Title(_), by)) if *dragged == index => rect.translate(by.round()),
            Some((dragged, Grip::Corner, by)) if *dragged == index => {
                Rect::from_min_size(rect.min, (rect.size() + *by).max(LEAST))
            }
            _ => rect,
        }
    }

    fn corner(&mut self, ui: &egui::Ui, rect: Rect, index: usize, frame: &Frame, moved: &mut Moved) {
        let corner = Rect::from_min_max(rect.max - Vec2::splat(CORNER), rect.max);
        let response = ui.interact(corner, ui.id().with(("frame corner", index)), Sense::drag());
        name(&response, || format!("resize frame {}", frame.title));
        let strong = if response.hovered() || response.dragged() { 1.0 } else { 0.6 };
        let stroke = Stroke::new(2.0, colour_of(frame).gamma_multiply(strong));
        for inset in [5.0, 10.0] {
            let ends = [
                pos2(rect.right() - 3.0 - inset, rect.bottom() - 3.0),
                pos2(rect.right() - 3.0, rect.bottom() - 3.0 - inset),
            ];
            ui.painter().line_segment(ends, stroke);
        }
        if response.hovered() {
            ui.ctx().set_cursor_icon(egui::CursorIcon::ResizeNwSe);
        }
        self.follow(&response, index, moved, || Grip::Corner);
    }

    #[expect(clippy::too_many_arguments, reason = "a part of `show`")]
    fn title(
        &mut self,
        ui: &mut egui::Ui,
        context: &mut PanelContext<'_>,
        stage: &Stage<'_>,
        rect: Rect,
        index: usize,
        frame: &Frame,
        moved: &mut Moved,
    ) {
        let bar = Rect::from_min_size(rect.min, vec2(rect.width(), TITLE));
        if self.typed.as_ref().is_some_and(|(typed, ..)| *typed == index) {
            self.type_title(ui, context, bar, index);
            return;
        }
        let response = ui.interact(bar, ui.id().with(("frame", index)), Sense::click_and_drag());
        name(&response, || format!("frame {}", frame.title));
        let within = || -> Vec<(NodeId, Pos2)> {
            let at = |(card, corner): (&super::Card, &Pos2)| {
                rect.contains(card.rect(*corner).center()).then_some((card.id, *corner))
            };
            stage.cards.all.iter().zip(&stage.corners).filter_map(at).collect()
        };
        if response.hovered() || response.dragged() {
            ui.painter().rect_filled(bar, 6.0, colour_of(frame).gamma_multiply(0.3));
            ui.ctx().set_cursor_icon(egui::CursorIcon::Grab);
        }
        let size =
            face::title_size(stage.zoom).clamp(15.0, 40.0).min(if face::is_afar(stage.zoom) { 40.0 } else { 15.0 });
        let text = ui.visuals().strong_text_color();
        let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
        painter.text(
            bar.left_top() + vec2(10.0, 5.0),
            Align2::LEFT_TOP,
            &frame.title,
            FontId::proportional(size),
            text,
        );
        if response.double_clicked() {
            self.typed = Some((index, frame.title.clone(), true));
        } else if response.clicked() {
            context.ask(ViewCommand::Select(within().into_iter().map(|(id, _)| id).collect()));
        }
        response.context_menu(|ui| {
            if ui.button("Rename").clicked() {
                self.typed = Some((index, frame.title.clone(), true));
                ui.close();
            }
            ui.menu_button("Colour", |ui| colours(ui, context, index, frame));
            if ui.button("Select its nodes").clicked() {
                context.ask(ViewCommand::Select(within().into_iter().map(|(id, _)| id).collect()));
                ui.close();
            }
            if ui.button("Delete the frame").clicked() {
                change(context, "delete a frame", |frames| {
                    frames.remove(index);
                });
                ui.close();
            }
        });
        self.follow(&response, index, moved, || Grip::Title(within()));
    }

    /// Follows a drag of a frame.
    fn follow(&mut self, response: &egui::Response, index: usize, moved: &mut Moved, grip: impl FnOnce() -> Grip) {
        if response.drag_started_by(egui::PointerButton::Primary) {
            self.drag = Some((index, grip(), Vec2::ZERO));
        }
        let Some((dragged, grip, by)) = &mut self.drag else { return };
        if *dragged != index || !(response.dragged() || response.drag_stopped()) {
            return;
        }
        *by += response.drag_delta();
        if let Grip::Title(nodes) = grip {
            // By whole points, as nodes stand.
            moved.nodes = nodes.iter().map(|(id, from)| (*id, (*from + *by).round())).collect();
        }
        moved.ended |= response.drag_stopped();
    }

    fn type_title(&mut self, ui: &mut egui::Ui, context: &mut PanelContext<'_>, bar: Rect, index: usize) {
        let Some((_, title, fresh)) = &mut self.typed else { return };
        let place = Rect::from_min_size(bar.min + vec2(6.0, 3.0), vec2((bar.width() - 12.0).min(260.0), 22.0));
        let field = ui.put(place, egui::TextEdit::singleline(title));
        field.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::TextEdit, true, "title of the frame"));
        if std::mem::take(fresh) {
            field.request_focus();
        } else if field.lost_focus() {
            let (title, escaped) = (title.clone(), ui.input(|i| i.key_pressed(egui::Key::Escape)));
            self.typed = None;
            if !escaped && context.graph().frames().get(index).is_some_and(|frame| frame.title != title) {
                change(context, "rename a frame", |frames| frames[index].title = title);
            }
        }
    }

    /// All frames as they are now, with the one that is dragged where it is.
    fn dragged(&self, frames: &[Frame]) -> Option<Vec<Frame>> {
        let (index, ..) = self.drag.as_ref()?;
        let mut now = frames.to_vec();
        let rect = self.now(*index, now.get(*index)?);
        let frame = now.get_mut(*index)?;
        frame.at = [rect.min.x, rect.min.y].map(|number| f64::from(number.round()));
        frame.size = [rect.width(), rect.height()].map(|number| f64::from(number.round()));
        Some(now)
    }
}

/// Changes frames of the graph on the canvas, as a step.
fn change(context: &mut PanelContext<'_>, step: &str, how: impl FnOnce(&mut Vec<Frame>)) {
    let mut frames = context.graph().frames().to_vec();
    how(&mut frames);
    context.ask(GraphCommand::Edit { name: step.to_owned(), edits: vec![Edit::Frames(frames)], gesture: None });
}

fn colours(ui: &mut egui::Ui, context: &mut PanelContext<'_>, index: usize, frame: &Frame) {
    for (colour, word) in COLOURS {
        ui.horizontal(|ui| {
            let (rect, _) = ui.allocate_exact_size(vec2(14.0, 14.0), Sense::hover());
            ui.painter().rect_filled(rect, 3.0, colour_of(&Frame { colour, ..frame.clone() }));
            if ui.selectable_label(frame.colour == colour, word).clicked() {
                change(context, "colour a frame", |frames| frames[index].colour = colour);
                ui.close();
            }
        });
    }
}

fn name(response: &egui::Response, label: impl Fn() -> String) {
    response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, label()));
}
