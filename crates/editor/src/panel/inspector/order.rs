//! The order that a node found, as a list to drag: what is dragged pins the order by hand. For any kind with a text input
//! `order` that reports a table of what it ordered, with a column that says whether it is pinned.

use egui::{RichText, Ui};
use maquette_graph::{Cell, Edit, InputSpec, Literal, NodeId, Report, Source, Table};

use crate::command::GraphCommand;
use crate::panel::PanelContext;
use crate::signs;

/// The input that pins an order, and the column that names what is ordered.
const INPUT: &str = "order";
const NAMED: &str = "curve";
const PINNED: &str = "pinned";

/// A row that is dragged.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Dragged(usize);

/// Whether an input pins an order.
pub(super) fn is_order(input: &InputSpec) -> bool {
    input.name == INPUT && input.wire.name() == "text"
}

fn ordered(report: &Report) -> Option<(&Table, usize)> {
    report.tables.iter().find_map(|table| {
        let column = |name: &str| table.columns.iter().position(|column| column.name == name);
        column(PINNED)?;
        Some((table, column(NAMED)?))
    })
}

/// By what a curve is pinned that a report calls so: the name between the quotes, or the number of one without a name.
fn pinned_by(called: &str) -> String {
    match (called.find('"'), called.rfind('"')) {
        (Some(from), Some(to)) if from < to => called[from + 1..to].to_owned(),
        _ => called.rsplit(' ').next().unwrap_or(called).to_owned(),
    }
}

/// The names in their order; an error says why they can't be pinned.
fn names(table: &Table, column: usize) -> (Vec<String>, Option<String>) {
    let names: Vec<String> = table
        .rows
        .iter()
        .map(|row| row.get(column).map(|cell| pinned_by(&cell.to_string())).unwrap_or_default())
        .collect();
    let twice = names.iter().enumerate().find(|(index, name)| names[..*index].contains(name)).map(|(_, name)| name);
    let unusable = |name: &&String| name.is_empty() || name.contains(',') || name.trim() != name.as_str();
    let why = match (twice, names.iter().find(unusable)) {
        (Some(name), _) => Some(format!("several are called \"{name}\": rename them to order them by hand")),
        (None, Some(name)) => Some(format!("\"{name}\" can't be named in a list: rename it, without commas")),
        (None, None) => None,
    };
    (names, why)
}

/// The names with one of them moved before another; `to` counts as before it was taken out.
fn moved(names: &[String], from: usize, to: usize) -> Vec<String> {
    let mut names = names.to_vec();
    if from >= names.len() {
        return names;
    }
    let taken = names.remove(from);
    let to = if to > from { to - 1 } else { to };
    names.insert(to.min(names.len()), taken);
    names
}

pub(super) fn show(
    ui: &mut Ui,
    context: &mut PanelContext<'_>,
    id: NodeId,
    input: &InputSpec,
    source: Option<&Source>,
) {
    let report = context.report(id);
    let Some((table, column)) = report.and_then(ordered) else { return };
    let (names, why) = names(table, column);
    let free = matches!(source, None | Some(Source::Literal { .. }));
    ui.horizontal(|ui| {
        let pinned = source.is_some();
        if free && pinned && ui.button("As found").on_hover_text("Order as the node finds it").clicked() {
            context.ask(GraphCommand::edit(Edit::Reset { node: id, input: input.name.clone() }));
        }
        if let Some(why) = &why {
            ui.label(RichText::new(why).weak().size(11.0));
        }
    });
    let mut wanted: Option<Vec<String>> = None;
    let mut places = Vec::new();
    for (index, row) in table.rows.iter().enumerate() {
        let rest: Vec<String> = table
            .columns
            .iter()
            .zip(row)
            .enumerate()
            .filter(|(at, (described, cell))| *at > column && described.name != PINNED && !is_false(cell))
            .map(|(_, (described, cell))| said(&described.name, cell))
            .collect();
        let line = |ui: &mut Ui| {
            ui.label(RichText::new(format!("{index}")).monospace().weak());
            ui.label(&names[index]);
            ui.label(RichText::new(rest.join(", ")).weak().size(11.0));
        };
        let response = ui.horizontal(|ui| {
            if free && why.is_none() {
                for (sign, to, word) in
                    [(signs::UP, index.checked_sub(1), "up"), (signs::DOWN, Some(index + 2), "down")]
                {
                    let last = word == "down" && index + 1 == names.len();
                    let to = to.filter(|_| !last);
                    let button = ui.add_enabled(to.is_some(), egui::Button::new(sign).small().frame(false));
                    let label = format!("move {} {word}", names[index]);
                    button.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, to.is_some(), &label));
                    if let Some(to) = to.filter(|_| button.clicked()) {
                        wanted = Some(moved(&names, index, to));
                    }
                }
                let drag = ui.dnd_drag_source(ui.id().with(("order", id, index)), Dragged(index), |ui| {
                    ui.style_mut().interaction.selectable_labels = false;
                    ui.horizontal(line);
                });
                drag.response.on_hover_text("Drag to pin the order by hand");
            } else {
                line(ui);
            }
        });
        places.push(response.response.rect);
    }
    if let Some((from, to)) = dropped(ui, &places) {
        wanted = Some(moved(&names, from, to));
    }
    if let Some(wanted) = wanted.filter(|wanted| *wanted != names) {
        let edit = Edit::set(id, input.name.clone(), Literal::Text(wanted.join(", ")));
        context.ask(GraphCommand::Edit { name: "order by hand".to_owned(), edits: vec![edit], gesture: None });
    }
}

fn is_false(cell: &Cell) -> bool {
    cell.to_string() == "no"
}

/// A cell in words; of what is true, its name says it.
fn said(name: &str, cell: &Cell) -> String {
    match cell {
        Cell::Number(number) => format!("{name} {number:.1}"),
        Cell::Text(text) if text == "yes" => name.to_owned(),
        Cell::Text(text) => format!("{name} {text}"),
    }
}

/// Shows where a dragged row would go, and says which one was dropped and before which.
fn dropped(ui: &Ui, places: &[egui::Rect]) -> Option<(usize, usize)> {
    let dragged = *egui::DragAndDrop::payload::<Dragged>(ui.ctx())?;
    let pointer = ui.input(|i| i.pointer.latest_pos())?;
    let all = places.iter().copied().reduce(|a, b| a.union(b))?;
    if !all.expand2(egui::vec2(40.0, 14.0)).contains(pointer) {
        return None;
    }
    let to = places.iter().filter(|rect| rect.center().y < pointer.y).count();
    let y = places.get(to).map_or(all.bottom(), |rect| rect.top()) - 1.0;
    let stroke = egui::Stroke::new(2.0, ui.visuals().selection.stroke.color);
    ui.painter().hline(all.x_range(), y, stroke);
    let released = ui.input(|i| i.pointer.any_released());
    released.then_some((dragged.0, to))
}

#[cfg(test)]
mod tests {
    use super::*;
    use maquette_graph::{Column, Unit};

    fn table(names: &[&str]) -> Table {
        let column = |name: &str| Column { name: name.to_owned(), unit: Unit::None };
        Table {
            name: "rails".to_owned(),
            columns: ["rail", "curve", "pinned"].map(column).to_vec(),
            rows: names.iter().map(|name| vec![0.0.into(), (*name).into(), false.into()]).collect(),
        }
    }

    #[test]
    fn an_entry_moves_before_another() {
        let names = ["a", "b", "c"].map(str::to_owned);
        assert_eq!(moved(&names, 0, 2), ["b", "a", "c"]);
        assert_eq!(moved(&names, 0, 3), ["b", "c", "a"]);
        assert_eq!(moved(&names, 2, 0), ["c", "a", "b"]);
        assert_eq!(moved(&names, 1, 1), ["a", "b", "c"]);
        assert_eq!(moved(&names, 7, 0), ["a", "b", "c"]);
    }

    #[test]
    fn what_is_not_so_is_not_said() {
        assert!(is_false(&Cell::from(false)) && !is_false(&Cell::from(true)));
        assert_eq!(said("reversed", &Cell::from(true)), "reversed");
        assert_eq!(said("angle", &Cell::from(35.64)), "angle 35.6");
    }

    #[test]
    fn names_that_can_not_be_pinned_are_said() {
        let (known, why) = names(&table(&["curve \"left side\"", "open curve 2"]), 1);
        assert_eq!((known, why), (vec!["left side".to_owned(), "2".to_owned()], None));
        assert!(names(&table(&["a", "a"]), 1).1.unwrap().contains("several are called \"a\""));
        assert!(names(&table(&["a,b"]), 1).1.unwrap().contains("without commas"));
    }
}
