//! The steps that led here. A click goes back to one, or forward again.

use egui::{RichText, Ui};

use crate::command::GraphCommand;
use crate::panel::PanelContext;

pub(crate) fn show(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let history = context.document.history();
    let position = history.position();
    let mut asked = None;
    egui::ScrollArea::vertical().auto_shrink(false).stick_to_bottom(true).show(ui, |ui| {
        let names = std::iter::once("as it was opened").chain(history.names());
        for (index, name) in names.enumerate() {
            let text = RichText::new(format!("{index}  {name}"));
            let text = if index > position { text.weak().italics() } else { text };
            let response = ui.selectable_label(index == position, text);
            response.widget_info(|| {
                egui::WidgetInfo::labeled(egui::WidgetType::Button, true, format!("step {index}: {name}"))
            });
            if response.clicked() {
                asked = Some(index);
            }
        }
    });
    if let Some(index) = asked {
        context.ask(GraphCommand::JumpTo(index));
    }
}
