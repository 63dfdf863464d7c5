//! A field for a value, by the kind of the value.

use egui::{RichText, Ui};
use maquette_graph::{InputSpec, Literal, LiteralKind, Range, Unit};

use crate::panel::PanelContext;
use crate::signs;

/// What became of a field in this frame.
#[derive(Debug, Default)]
pub(super) struct Changed {
    pub(super) value: Option<Literal>,
    /// Whether it changes by a drag that goes on.
    pub(super) dragging: bool,
    /// Whether such a drag ended.
    pub(super) released: bool,
    /// Whether a file is to be chosen.
    pub(super) browse: bool,
}

impl Changed {
    fn of(response: &egui::Response, value: Literal) -> Self {
        Self {
            value: response.changed().then_some(value),
            dragging: response.dragged() || response.drag_stopped(),
            released: response.drag_stopped(),
            browse: false,
        }
    }

    fn or(self, other: Self) -> Self {
        Self {
            value: other.value.or(self.value),
            dragging: self.dragging || other.dragging,
            released: self.released || other.released,
            browse: self.browse || other.browse,
        }
    }
}

fn name(response: &egui::Response, kind: egui::WidgetType, label: &str) {
    response.widget_info(|| egui::WidgetInfo::labeled(kind, true, label));
}

/// How far a number goes with a point of dragging.
fn speed(value: f64, range: Option<Range>) -> f64 {
    match range {
        Some(range) => (range.max - range.min) / 400.0,
        None => (value.abs() * 0.01).max(0.001),
    }
}

fn suffix(unit: Unit) -> &'static str {
    match unit {
        Unit::None => "",
        Unit::Length => " m",
        Unit::Angle => "°",
    }
}

/// Shows a field for a value and says what became of it.
pub(super) fn edit_literal(
    ui: &mut Ui,
    context: &PanelContext<'_>,
    label: &str,
    spec: &InputSpec,
    literal: &Literal,
) -> Changed {
    match literal {
        Literal::Number(number) if LiteralKind::of_wire(spec.wire) == Some(LiteralKind::Number) => {
            number_field(ui, label, spec, *number)
        }
        Literal::Integer(integer) => integer_field(ui, label, spec, *integer),
        Literal::Boolean(flag) => {
            let mut flag = *flag;
            let word = if flag { "yes" } else { "no" };
            let response = ui.checkbox(&mut flag, word);
            response.widget_info(|| egui::WidgetInfo::selected(egui::WidgetType::Checkbox, true, flag, label));
            Changed::of(&response, Literal::Boolean(flag))
        }
        Literal::Choice(option) => choice_field(ui, label, spec, option),
        Literal::Vector(vector) => vector_field(ui, label, spec, *vector),
        Literal::Colour(colour) => colour_field(ui, label, *colour),
        Literal::Text(text) => {
            let made = text_field(ui, label, text);
            Changed { value: made.map(Literal::Text), ..Changed::default() }
        }
        Literal::File(path) => file_field(ui, context, label, path),
        Literal::Number(_) | Literal::Strokes(_) => {
            ui.label(RichText::new(literal.to_value().summary()).weak());
            Changed::default()
        }
    }
}

fn number_field(ui: &mut Ui, label: &str, spec: &InputSpec, number: f64) -> Changed {
    let hard = spec.range.unwrap_or(Range { min: f64::MIN, max: f64::MAX });
    // The range of a slider: what is usual, or all where that is not much.
    let usual = spec.soft_range.or(spec.range.filter(|range| range.max - range.min <= 1000.0));
    let mut value = number;
    ui.horizontal(|ui| {
        let mut changed = Changed::default();
        if let Some(usual) = usual {
            let mut at = value.clamp(usual.min, usual.max);
            ui.spacing_mut().slider_width = (ui.available_width() - 92.0).max(40.0);
            let slider = ui.add(egui::Slider::new(&mut at, usual.min..=usual.max).show_value(false));
            name(&slider, egui::WidgetType::Slider, &format!("{label} slider"));
            if slider.changed() {
                value = round(at, usual);
            }
            changed = Changed::of(&slider, Literal::Number(value));
        }
        let field = egui::DragValue::new(&mut value)
            .speed(speed(number, usual))
            .range(hard.min..=hard.max)
            .max_decimals(6)
            .update_while_editing(false)
            .suffix(suffix(spec.unit));
        let field = ui.add(field);
        name(&field, egui::WidgetType::DragValue, label);
        changed.or(Changed::of(&field, Literal::Number(value)))
    })
    .inner
}

/// To a thousandth of a slider's range: what the hand can't tell apart should not fill a file with digits.
fn round(value: f64, range: Range) -> f64 {
    let step = 10_f64.powf(((range.max - range.min) / 1000.0).log10().floor());
    // By the reciprocal, so that 0.1 becomes 0.1.
    let per = (1.0 / step).round();
    if step < 1.0 { (value * per).round() / per } else { (value / step).round() * step }
}

fn integer_field(ui: &mut Ui, label: &str, spec: &InputSpec, integer: i64) -> Changed {
    let usual = spec.soft_range.or(spec.range.filter(|range| range.max - range.min <= 1000.0));
    #[expect(clippy::cast_possible_truncation, reason = "ranges of whole numbers end far below 2^53")]
    let whole = |range: Range| [range.min.ceil() as i64, range.max.floor() as i64];
    let mut value = integer;
    ui.horizontal(|ui| {
        let mut changed = Changed::default();
        if let Some([min, max]) = usual.map(whole) {
            let mut at = value.clamp(min, max);
            ui.spacing_mut().slider_width = (ui.available_width() - 92.0).max(40.0);
            let slider = ui.add(egui::Slider::new(&mut at, min..=max).show_value(false));
            name(&slider, egui::WidgetType::Slider, &format!("{label} slider"));
            if slider.changed() {
                value = at;
            }
            changed = Changed::of(&slider, Literal::Integer(value));
        }
        let [min, max] = spec.range.map_or([i64::MIN, i64::MAX], whole);
        let field = ui.add(
            egui::DragValue::new(&mut value)
                .speed(0.2)
                .range(min..=max)
                .update_while_editing(false)
                .suffix(suffix(spec.unit)),
        );
        name(&field, egui::WidgetType::DragValue, label);
        changed.or(Changed::of(&field, Literal::Integer(value)))
    })
    .inner
}

fn choice_field(ui: &mut Ui, label: &str, spec: &InputSpec, option: &str) -> Changed {
    let mut taken = None;
    let described = spec.options.iter().find(|known| known.name == option);
    let combo = egui::ComboBox::from_id_salt(("choice", label)).selected_text(option).width(ui.available_width() - 8.0);
    let shown = combo.show_ui(ui, |ui| {
        for known in &spec.options {
            let row = ui.selectable_label(known.name == option, &known.name).on_hover_text(&known.description);
            if row.clicked() && known.name != option {
                taken = Some(Literal::Choice(known.name.clone()));
            }
        }
    });
    name(&shown.response, egui::WidgetType::ComboBox, label);
    if let Some(described) = described {
        shown.response.on_hover_text(&described.description);
    }
    Changed { value: taken, ..Changed::default() }
}

fn vector_field(ui: &mut Ui, label: &str, spec: &InputSpec, vector: [f64; 3]) -> Changed {
    ui.horizontal(|ui| {
        let mut value = vector;
        let mut all = Changed::default();
        let width = ((ui.available_width() - 16.0) / 3.0).max(36.0);
        for (axis, axis_name) in ["x", "y", "z"].into_iter().enumerate() {
            let field = egui::DragValue::new(&mut value[axis])
                .speed(match spec.unit {
                    Unit::Angle => 0.5,
                    _ => speed(vector[axis], None),
                })
                .prefix(format!("{axis_name} "))
                .suffix(suffix(spec.unit))
                .update_while_editing(false)
                .max_decimals(6);
            let field = ui.add_sized([width, ui.spacing().interact_size.y], field);
            name(&field, egui::WidgetType::DragValue, &format!("{label} {axis_name}"));
            let changed = Changed::of(&field, Literal::Vector(value));
            all = all.or(changed);
        }
        all
    })
    .inner
}

fn colour_field(ui: &mut Ui, label: &str, colour: [f64; 4]) -> Changed {
    #[expect(clippy::cast_possible_truncation, reason = "components from 0 to 1")]
    let single = colour.map(|component| component as f32);
    let [r, g, b, a] = single;
    let mut shown = egui::ecolor::Hsva::from_srgba_unmultiplied([r, g, b, a].map(byte));
    ui.horizontal(|ui| {
        let response = egui::color_picker::color_edit_button_hsva(ui, &mut shown, egui::color_picker::Alpha::OnlyBlend);
        name(&response, egui::WidgetType::ColorButton, label);
        ui.label(RichText::new(format!("{r:.2} {g:.2} {b:.2} {a:.2}")).weak());
        let components = shown.to_srgba_unmultiplied().map(|byte| (f64::from(byte) / 255.0 * 1000.0).round() / 1000.0);
        let mut changed = Changed::of(&response, Literal::Colour(components));
        // The picker is a popup: its drags are not those of the button.
        changed.dragging = changed.value.is_some();
        changed.released = changed.value.is_some() && ui.input(|i| i.pointer.any_released());
        changed
    })
    .inner
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
fn byte(component: f32) -> u8 {
    (component.clamp(0.0, 1.0) * 255.0).round() as u8
}

/// A line of text; what was typed counts when the field is left.
fn text_field(ui: &mut Ui, label: &str, text: &str) -> Option<String> {
    let id = ui.id().with(("text", label));
    let mut typed = ui.data(|data| data.get_temp::<String>(id)).unwrap_or_else(|| text.to_owned());
    let field = ui.add(egui::TextEdit::singleline(&mut typed).desired_width(f32::INFINITY));
    name(&field, egui::WidgetType::TextEdit, label);
    if field.lost_focus() {
        ui.data_mut(|data| data.remove::<String>(id));
        return (typed != text).then_some(typed);
    }
    if field.has_focus() {
        ui.data_mut(|data| data.insert_temp(id, typed));
    }
    None
}

fn file_field(ui: &mut Ui, context: &PanelContext<'_>, label: &str, path: &str) -> Changed {
    let mut changed = Changed::default();
    ui.horizontal(|ui| {
        let browse = ui.button(signs::BROWSE).on_hover_text("Choose a file");
        name(&browse, egui::WidgetType::Button, &format!("browse {label}"));
        changed.browse = browse.clicked();
        changed.value = text_field(ui, label, path).map(Literal::File);
    });
    let missing = !path.is_empty() && !context.document.folder().join(path).is_file();
    if missing {
        ui.label(RichText::new("there is no such file").color(ui.visuals().error_fg_color).size(11.0));
    }
    changed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sliders_give_round_numbers() {
        assert_eq!(round(0.123_456_7, Range { min: 0.0, max: 1.0 }), 0.123);
        assert_eq!(round(123.456, Range { min: 0.0, max: 200.0 }), 123.5);
        assert_eq!(round(12_345.6, Range { min: 0.0, max: 100_000.0 }), 12_300.0);
    }
}
