//! The palette: all node kinds by category. A click adds one, a drag places it on the canvas.

use egui::{RichText, Ui};

use crate::command::{GraphCommand, NewLink};
use crate::panel::PanelContext;

/// The palette.
#[derive(Default)]
pub(crate) struct Palette {
    text: String,
}

/// What is dragged out of the palette: the name of a kind.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct DraggedKind(pub(crate) String);

impl Palette {
    pub(crate) fn show(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>, middle: [f64; 2]) {
        let field = egui::TextEdit::singleline(&mut self.text).hint_text("filter").desired_width(f32::INFINITY);
        let field = ui.add(field);
        field.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::TextEdit, true, "filter the palette"));
        let wanted = self.text.trim().to_lowercase();
        let mut categories: Vec<&str> = context.catalogue.kinds().map(|kind| kind.category()).collect();
        categories.sort_unstable();
        categories.dedup();
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            for category in categories {
                let fits = |text: &str| text.to_lowercase().contains(&wanted);
                let kinds: Vec<_> = context
                    .catalogue
                    .kinds()
                    .filter(|kind| kind.category() == category)
                    .filter(|kind| fits(kind.name()) || fits(kind.description()) || fits(category))
                    .collect();
                if kinds.is_empty() {
                    continue;
                }
                egui::CollapsingHeader::new(category).default_open(true).show(ui, |ui| {
                    for kind in kinds {
                        let id = ui.id().with(("palette", kind.name()));
                        let dragged = ui.dnd_drag_source(id, DraggedKind(kind.name().to_owned()), |ui| {
                            ui.add(egui::Label::new(RichText::new(kind.name())).selectable(false))
                        });
                        let response = ui.interact(dragged.response.rect, id.with("click"), egui::Sense::click());
                        let label = format!("palette {}", kind.name());
                        response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, &label));
                        if response.on_hover_text(kind.description()).clicked() {
                            let kind = kind.name().to_owned();
                            context.ask(GraphCommand::Add { kind, at: middle, link: NewLink::None });
                        }
                    }
                });
            }
        });
    }
}
