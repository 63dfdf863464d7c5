//! The reference pictures of the graph: where each stands, how strongly it is seen, whether it can be moved.

use egui::{RichText, Ui};
use maquette_graph::ReferencePicture;

use crate::command::GraphCommand;
use crate::panel::PanelContext;
use crate::reference_pictures::PictureState;
use crate::signs;

/// What a row asks for.
#[derive(Default)]
struct Asked {
    /// What the step is called, and the picture as it is to be; `None` where it goes.
    change: Option<(&'static str, Option<ReferencePicture>)>,
    /// Whether more of the same gesture follows.
    dragging: bool,
    released: bool,
}

pub(super) fn show(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let pictures = context.document.graph().references();
    if pictures.is_empty() {
        return;
    }
    ui.separator();
    ui.label(RichText::new("Reference pictures").strong());
    for (index, picture) in pictures.iter().enumerate() {
        let asked = ui.push_id(("picture", index), |ui| row(ui, context, index, picture)).inner;
        if let Some((name, change)) = asked.change {
            let mut changed = pictures.to_vec();
            match change {
                Some(picture) => changed[index] = picture,
                None => drop(changed.remove(index)),
            }
            let gesture = asked.dragging.then(|| format!("{name} {index}"));
            context.ask(GraphCommand::References { name: name.to_owned(), pictures: changed, gesture });
        }
        if asked.released {
            context.ask(GraphCommand::EndGesture);
        }
    }
}

fn row(ui: &mut Ui, context: &PanelContext<'_>, index: usize, picture: &ReferencePicture) -> Asked {
    let mut asked = Asked::default();
    ui.horizontal(|ui| {
        ui.label(RichText::new(&picture.view).weak());
        ui.add(egui::Label::new(&picture.file).truncate()).on_hover_text(&picture.file);
    });
    if let Some(PictureState::Failed(problem)) = context.pictures.state(context.document, &picture.file) {
        ui.label(RichText::new(problem).color(ui.visuals().error_fg_color).size(11.5));
    }
    let mut held = picture.clone();
    let mut number = |ui: &mut Ui, what: &'static str, field: egui::DragValue<'_>, hint: &str| {
        let response = ui.add(field.update_while_editing(false));
        let label = format!("{what} of picture {index}");
        response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::DragValue, true, &label));
        asked.dragging |= response.dragged();
        asked.released |= response.drag_stopped();
        response.on_hover_text(hint);
    };
    ui.horizontal(|ui| {
        let metres = |value| egui::DragValue::new(value).speed(0.002).max_decimals(5).suffix(" m");
        let [x, y] = &mut held.centre;
        number(ui, "first coordinate", metres(x), "Middle, rightwards");
        number(ui, "second coordinate", metres(y), "Middle, along the other axis of the view");
        number(ui, "width", metres(&mut held.width).range(1e-5..=1e4), "Width");
    });
    ui.horizontal(|ui| {
        let opacity = egui::DragValue::new(&mut held.opacity).speed(0.005).range(0.0..=1.0).max_decimals(2);
        number(ui, "opacity", opacity.prefix("opacity "), "From 0, not seen, to 1, covering");
        let flag = |ui: &mut Ui, on: &mut bool, what: &str, hint: &str| {
            let response = ui.add(egui::Button::selectable(*on, what).small());
            let label = format!("{what} picture {index}");
            response.widget_info(|| egui::WidgetInfo::selected(egui::WidgetType::Checkbox, true, *on, &label));
            if response.on_hover_text(hint).clicked() {
                *on = !*on;
            }
        };
        flag(ui, &mut held.locked, "lock", "The pointer does not move it");
        flag(ui, &mut held.hidden, "hide", "It is not drawn");
        let remove = ui.add(egui::Button::new(signs::REMOVE).small());
        let label = format!("remove picture {index}");
        remove.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, &label));
        if remove.on_hover_text("Remove it from the graph; its file stays").clicked() {
            asked.change = Some(("remove a reference picture", None));
        }
    });
    if held != *picture && asked.change.is_none() {
        asked.change = Some(("change a reference picture", Some(held)));
    }
    asked
}
