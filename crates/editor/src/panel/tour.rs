//! A tour in three steps on a small graph: a line is drawn, wired, and pulled while the surface follows. Each step goes on when
//! it was done.

use egui::{Rect, RichText};
use maquette_graph::{Graph, Literal, Source};

use crate::document::Document;
use crate::results::Results;
use crate::view_state::Tool;

/// The graph of the tour: half an outline becomes a vase, once a link is made.
pub(crate) const GRAPH: &str = include_str!("tour.ron");
/// The sketch of it, and the node that it is to be linked to.
pub(crate) const LINE: &str = "line";
const MIRROR: &str = "both sides";
const RESULT: &str = "vase";

/// Where the artist is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tour {
    /// A line is to be drawn.
    #[default]
    Draw,
    /// It is to be linked.
    Wire,
    /// It is to be pulled.
    Pull,
    /// All was done.
    Done,
}

/// What the artist asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Asked {
    /// To skip the step.
    Next,
    /// To leave the tour.
    Leave,
}

/// A part of the window that the tour speaks of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    FrontView,
    Perspective,
    Canvas,
}

fn has_strokes(graph: &Graph) -> bool {
    let line = graph.find(LINE).and_then(|id| graph.node(id));
    let strokes = line.and_then(|node| node.source("strokes"));
    matches!(strokes, Some(Source::Literal { literal: Literal::Strokes(strokes), .. }) if !strokes.is_empty())
}

impl Tour {
    /// The step that comes after what the artist did.
    pub(crate) fn after(self, document: &Document, results: &Results) -> Self {
        let graph = document.graph();
        let mirror = graph.find(MIRROR).and_then(|id| graph.node(id));
        match self {
            Self::Draw if has_strokes(graph) => Self::Wire,
            Self::Wire if matches!(mirror.and_then(|node| node.source("curves")), Some(Source::Link(_))) => Self::Pull,
            Self::Pull => {
                let pulled = document.history().undo_name() == Some("pull a point");
                let made = graph.find(RESULT).is_some_and(|id| results.values(id).is_some());
                if pulled && made && results.is_current() { Self::Done } else { self }
            }
            other => other,
        }
    }

    /// The step behind this one.
    pub(crate) fn next(self) -> Self {
        match self {
            Self::Draw => Self::Wire,
            Self::Wire => Self::Pull,
            Self::Pull | Self::Done => Self::Done,
        }
    }

    /// The tool that the step is done with.
    pub(crate) fn tool(self) -> Tool {
        match self {
            Self::Draw => Tool::Sketch,
            Self::Pull => Tool::Pull,
            Self::Wire | Self::Done => Tool::Select,
        }
    }

    /// What it speaks of, the most important first.
    pub(crate) fn places(self) -> &'static [Place] {
        match self {
            Self::Draw => &[Place::FrontView],
            Self::Wire => &[Place::Canvas],
            Self::Pull => &[Place::FrontView, Place::Perspective],
            Self::Done => &[Place::Perspective],
        }
    }

    fn title(self) -> &'static str {
        match self {
            Self::Draw => "1 of 3: draw a line",
            Self::Wire => "2 of 3: wire it",
            Self::Pull => "3 of 3: pull it and see the surface follow",
            Self::Done => "That was all",
        }
    }

    fn text(self) -> &'static str {
        match self {
            Self::Draw => {
                "Draw half the outline of a vase in the front view, from its foot up to its rim, to the right of the green \
                 line. The Sketch tool is taken already."
            }
            Self::Wire => {
                "Drag from the socket at the right of the node \"line\" to the one at the left of \"both sides\". The rest \
                 of the graph is wired: the line is mirrored, and a cylinder takes its outline."
            }
            Self::Pull => {
                "Drag a point of the line in the front view. Its neighbours come along, and the surface follows while you \
                 drag. Ctrl+Z takes anything back."
            }
            Self::Done => {
                "Click a node to see its inputs, press Tab over the graph to add one, and F1 for all keys. The examples \
                 are under Help, Welcome."
            }
        }
    }

    /// Shows the step beside what it speaks of, which it frames.
    pub(crate) fn show(self, context: &egui::Context, rects: &[Rect]) -> Option<Asked> {
        let first = rects.first()?;
        let accent = context.global_style().visuals.selection.stroke.color;
        let painter = context.layer_painter(egui::LayerId::new(egui::Order::Foreground, egui::Id::new("tour frames")));
        for rect in rects {
            painter.rect_stroke(rect.shrink(2.0), 4.0, egui::Stroke::new(3.0, accent), egui::StrokeKind::Inside);
        }
        let mut asked = None;
        let area = egui::Area::new(egui::Id::new("tour")).order(egui::Order::Foreground).constrain(true);
        // Beside it, so that nothing of it is covered.
        let has_room = first.bottom() + 170.0 < context.content_rect().bottom();
        let area = match has_room {
            true => area.pivot(egui::Align2::LEFT_TOP).fixed_pos(first.left_bottom() + egui::vec2(12.0, 8.0)),
            false => area.pivot(egui::Align2::LEFT_BOTTOM).fixed_pos(first.left_top() + egui::vec2(12.0, -8.0)),
        };
        area.show(context, |ui| {
            egui::Frame::popup(ui.style()).inner_margin(12.0).show(ui, |ui| {
                ui.set_width(330.0);
                ui.label(RichText::new(self.title()).strong().size(15.0));
                ui.label(self.text());
                ui.add_space(6.0);
                ui.horizontal(|ui| {
                    if self != Self::Done && ui.button("Skip this step").clicked() {
                        asked = Some(Asked::Next);
                    }
                    let word = if self == Self::Done { "Close the tour" } else { "Leave the tour" };
                    if ui.button(word).clicked() {
                        asked = Some(Asked::Leave);
                    }
                });
            });
        });
        asked
    }
}
