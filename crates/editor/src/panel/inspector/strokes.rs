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
    let mut drag: Option<String> = None;
    let mut released = false;
    for (index, stroke) in strokes.iter().enumerate() {
        let shown = ui.horizontal(|ui| {
            let with = |changed: Stroke| {
                let mut strokes = strokes.to_vec();
                strokes[index] = changed;
                strokes
            };
            let name_id = ui.id().with(("stroke name", id, index));
            let mut name = ui.data(|data| data.get_temp::<String>(name_id)).unwrap_or_else(|| stroke.name.clone());
            let field =
                ui.add(egui::TextEdit::singleline(&mut name).desired_width((ui.available_width() - 178.0).max(60.0)));
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
            let open_id = ui.id().with(("points of stroke", id, index));
            let open = ui.data(|data| data.get_temp::<bool>(open_id)).unwrap_or_default();
            let mut small = |sign: &str, what: &str, on: bool| {
                let response = ui.add(egui::Button::selectable(on, RichText::new(sign).size(12.0)).small());
                let label = format!("{what} stroke {index}");
                response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, &label));
                response.on_hover_text(&label).clicked()
            };
            let toggled = small(signs::EXPAND, "show the points of", open);
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
            if toggled {
                ui.data_mut(|data| data.insert_temp(open_id, !open));
            }
            open
        });
        if shown.inner {
            let moved = points(ui, index, stroke);
            released |= moved.released;
            if let Some(changed) = moved.stroke {
                let mut strokes = strokes.to_vec();
                strokes[index] = changed;
                made = Some(("move a point", strokes));
                drag = moved.dragging.then(|| format!("point of {id:?} {index}"));
            }
        }
    }
    if let Some((name, strokes)) = made {
        let edits = vec![Edit::set(id, input.name.clone(), Literal::Strokes(strokes))];
        context.ask(GraphCommand::Edit { name: name.to_owned(), edits, gesture: drag });
    }
    if released {
        context.ask(GraphCommand::EndGesture);
    }
}

/// What was done with the points of a stroke.
#[derive(Default)]
struct Moved {
    stroke: Option<Stroke>,
    dragging: bool,
    released: bool,
}

/// Height of a row of points.
const ROW: f32 = 20.0;

/// The points of a stroke by their numbers, each to be typed or dragged.
fn points(ui: &mut Ui, stroke_index: usize, stroke: &Stroke) -> Moved {
    let mut moved = Moved::default();
    let area = egui::ScrollArea::vertical().id_salt(("points", stroke_index)).max_height(160.0);
    area.show_rows(ui, ROW, stroke.points.len(), |ui, rows| {
        for index in rows {
            let mut point = stroke.points[index];
            ui.horizontal(|ui| {
                ui.label(RichText::new(format!("{index}")).weak().monospace().size(11.0));
                let mut field =
                    |ui: &mut Ui, value: &mut f64, what: &str, range: std::ops::RangeInclusive<f64>, unit: &str| {
                        let field = egui::DragValue::new(value).speed(0.001).max_decimals(5).suffix(unit).range(range);
                        let response = ui.add(field.update_while_editing(false));
                        let label = format!("{what} of point {index} of stroke {stroke_index}");
                        response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::DragValue, true, &label));
                        moved.dragging |= response.dragged();
                        moved.released |= response.drag_stopped();
                    };
                field(ui, &mut point.x, "first coordinate", -1e6..=1e6, " m");
                field(ui, &mut point.y, "second coordinate", -1e6..=1e6, " m");
                if let Some(mut pressure) = point.pressure {
                    field(ui, &mut pressure, "pressure", 0.0..=1.0, "");
                    point.pressure = Some(pressure);
                }
            });
            if point != stroke.points[index] {
                let mut points = stroke.points.clone();
                points[index] = point;
                moved.stroke = Some(Stroke { points, ..stroke.clone() });
            }
        }
    });
    moved
}
