//! The search for a node to add: by name and description, filtered to what fits a link that was dragged into the void.

use egui::{Key, RichText, Ui};
use maquette_graph::{Catalogue, NodeKind, WireType};

use crate::command::{GraphCommand, NewLink};
use crate::panel::PanelContext;

/// Most kinds that are listed at once.
const MOST_LISTED: usize = 14;

/// An open search.
#[derive(Clone, Debug)]
pub(crate) struct Search {
    pub(crate) text: String,
    /// Which entry Enter takes.
    chosen: usize,
    /// Where the popup stands, on the screen.
    pub(crate) place: egui::Pos2,
    /// Where the node will stand, on the canvas.
    pub(crate) at: [f64; 2],
    pub(crate) link: NewLink,
    fresh: bool,
}

/// How well a kind fits what was typed, the lower the better; `None` where it does not.
fn rank(kind: &NodeKind, text: &str) -> Option<usize> {
    let text = text.trim().to_lowercase();
    let name = kind.name().to_lowercase();
    if name.starts_with(&text) {
        Some(0)
    } else if name.split('-').any(|word| word.starts_with(&text)) {
        Some(1)
    } else if name.contains(&text) {
        Some(2)
    } else {
        let words = format!("{} {}", kind.category(), kind.description()).to_lowercase();
        text.split_whitespace().all(|word| words.contains(word) || name.contains(word)).then_some(3)
    }
}

/// Whether a new node of that kind can be linked so.
fn fits(catalogue: &Catalogue, kind: &NodeKind, wire: Option<WireType>, link: &NewLink) -> bool {
    let Some(wire) = wire else { return true };
    match link {
        NewLink::None => true,
        NewLink::From { .. } => kind.inputs().iter().any(|input| catalogue.fits(wire, input.wire)),
        NewLink::To { .. } => kind.outputs().iter().any(|output| catalogue.fits(output.wire, wire)),
    }
}

impl Search {
    pub(crate) fn new(place: egui::Pos2, at: [f64; 2], link: NewLink) -> Self {
        Self { text: String::new(), chosen: 0, place, at, link, fresh: true }
    }

    /// The kinds it lists, the best first.
    pub(crate) fn found<'a>(&self, context: &PanelContext<'a>) -> Vec<&'a NodeKind> {
        let wire = wire_of(context, &self.link);
        let catalogue = context.catalogue;
        let mut ranked: Vec<(usize, &NodeKind)> = catalogue
            .kinds()
            .filter(|kind| fits(catalogue, kind, wire, &self.link))
            .filter_map(|kind| Some((rank(kind, &self.text)?, &**kind)))
            .collect();
        ranked.sort_by_key(|(rank, _)| *rank);
        ranked.into_iter().map(|(_, kind)| kind).collect()
    }

    /// Shows it; says whether it stays open.
    pub(crate) fn show(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) -> bool {
        let found = self.found(context);
        let [up, down, enter, escape] = ui.input_mut(|i| {
            [Key::ArrowUp, Key::ArrowDown, Key::Enter, Key::Escape].map(|key| i.consume_key(egui::Modifiers::NONE, key))
        });
        let last = found.len().min(MOST_LISTED).saturating_sub(1);
        self.chosen = match (up, down) {
            (true, _) => self.chosen.saturating_sub(1),
            (_, true) => (self.chosen + 1).min(last),
            _ => self.chosen.min(last),
        };
        let mut taken = enter.then(|| found.get(self.chosen).map(|kind| kind.name().to_owned())).flatten();
        let mut open = !escape;
        let fresh = std::mem::take(&mut self.fresh);
        let area = egui::Area::new(ui.id().with("search")).fixed_pos(self.place).order(egui::Order::Foreground);
        let response = area.constrain(true).show(ui.ctx(), |ui| {
            egui::Frame::popup(ui.style()).show(ui, |ui| {
                ui.set_width(300.0);
                let field = egui::TextEdit::singleline(&mut self.text)
                    .hint_text("search for a node to add")
                    .desired_width(f32::INFINITY);
                let field = ui.add(field);
                field.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::TextEdit, true, "search nodes"));
                if fresh {
                    field.request_focus();
                }
                if field.changed() {
                    self.chosen = 0;
                }
                if found.is_empty() {
                    ui.label(RichText::new("nothing fits").weak());
                }
                for (index, kind) in found.iter().take(MOST_LISTED).enumerate() {
                    let row = ui.add(
                        egui::Button::selectable(
                            index == self.chosen,
                            (
                                RichText::new(kind.name()),
                                egui::Atom::grow(),
                                RichText::new(kind.category()).weak().size(11.0),
                            ),
                        )
                        .min_size(egui::vec2(ui.available_width(), 0.0)),
                    );
                    let label = format!("add {}", kind.name());
                    row.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, &label));
                    if row.on_hover_text(kind.description()).clicked() {
                        taken = Some(kind.name().to_owned());
                    }
                }
                if found.len() > MOST_LISTED {
                    ui.label(RichText::new(format!("and {} more", found.len() - MOST_LISTED)).weak().size(11.0));
                }
            });
        });
        if !fresh && response.response.clicked_elsewhere() {
            open = false;
        }
        if let Some(kind) = taken {
            context.ask(GraphCommand::Add { kind, at: self.at, link: self.link.clone() });
            open = false;
        }
        open
    }
}

/// The type at the loose end of a link.
fn wire_of(context: &PanelContext<'_>, link: &NewLink) -> Option<WireType> {
    match link {
        NewLink::None => None,
        NewLink::From { node, output } => Some(context.graph().node(*node)?.kind()?.find_output(output)?.1.wire),
        NewLink::To { node, input } => Some(context.graph().node(*node)?.kind()?.find_input(input)?.wire),
    }
}
