//! The strokes of a sketch as a list: names, direction, closing, mirroring, removing.

use egui::{RichText, Ui};
use maquette_graph::{Edit, InputSpec, Literal, NodeId, Stroke};

use crate::command::GraphCommand;
use crate::panel::PanelContext;
use crate::signs;
use crate::sketch::correct::{mirrored, reversed};

pub(super) fn show(ui: &mut Ui, context: &mut PanelContext<'_>, id: NodeId, input: &InputSpec, strokes: &[Stroke]) {
    if strokes.is_empty() {
        let text = "no strokes: draw some with the Sketch tool";
        ui.label(RichText::new(text).color(ui.visuals().warn_fg_color));
    }
    let mut made: Option<(&str, Vec<Stroke>)> = None;
    for (index, stroke) in strokes.iter().enumerate() {
        ui.horizontal(|ui| {
            let with = |changed: Stroke| {
                let mut strokes = strokes.to_vec();
                strokes[index] = changed;
                strokes
            };
            let name_id = ui.id().with(("stroke name", id, index));
            let mut name = ui.data(|data| data.get_temp::<String>(name_id)).unwrap_or_else(|| stroke.name.clone());
            let field =
                ui.add(egui::TextEdit::singleline(&mut name).desired_width((ui.available_width() - 150.0).max(60.0)));
            field.widget_info(|| {
                egui::WidgetInfo::labeled(egui::WidgetType::TextEdit, true, format!("name of stroke {index}"))
            });
            if field.lost_focus() {
                ui.data_mut(|data| data.remove::<String>(name_id));
                if name != stroke.name {
                    made = Some(("rename a stroke", with(Stroke { name, ..stroke.clone() })));
                }
            } else if field.has_focus() {
                ui.data_mut(|data| data.insert_temp(name_id, name));
            }
            ui.label(RichText::new(format!("{} pts", stroke.points.len())).weak().size(11.0));
            let mut small = |sign: &str, what: &str, on: bool| {
                let response = ui.add(egui::Button::selectable(on, RichText::new(sign).size(12.0)).small());
                let label = format!("{what} stroke {index}");
                response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, &label));
                response.on_hover_text(&label).clicked()
            };
            if small(signs::CLOSE, "close", stroke.closed) {
                made = Some(("close a stroke", with(Stroke { closed: !stroke.closed, ..stroke.clone() })));
            }
            if small(signs::REVERSE, "reverse", false) {
                made = Some(("reverse a stroke", with(reversed(stroke))));
            }
            if small(signs::MIRROR, "mirror", false) {
                let mut strokes = strokes.to_vec();
                strokes.insert(index + 1, mirrored(stroke));
                made = Some(("mirror a stroke", strokes));
            }
            if small(signs::REMOVE, "remove", false) {
                let mut strokes = strokes.to_vec();
                strokes.remove(index);
                made = Some(("remove a stroke", strokes));
            }
        });
    }
    if let Some((name, strokes)) = made {
        let edits = vec![Edit::set(id, input.name.clone(), Literal::Strokes(strokes))];
        context.ask(GraphCommand::Edit { name: name.to_owned(), edits, gesture: None });
    }
}
