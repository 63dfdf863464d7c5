//! What the active node gave: its values in few words, the figures and tables it reported. Tables can be sorted and written as
//! CSV.

use egui::{RichText, Ui};
use egui_extras::{Column, TableBuilder};
use maquette_graph::{Cell, Table, Unit};

use crate::command::{FileCommand, ViewCommand};
use crate::panel::PanelContext;
use crate::signs;
use crate::view_state::PickedRow;

/// The data panel.
#[derive(Default)]
pub(crate) struct Data {
    /// The column by which a table is sorted, and whether the largest comes first.
    sorted: Option<(String, usize, bool)>,
    /// The table that is shown.
    shown: usize,
}

fn unit(unit: Unit) -> String {
    if unit == Unit::None { String::new() } else { format!(" ({unit})") }
}

/// A table as CSV, with names and units in the first line.
///
/// # Errors
/// The text can't be written, which does not happen in memory.
pub(crate) fn csv_of(table: &Table) -> Result<String, String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let heads = table.columns.iter().map(|column| format!("{}{}", column.name, unit(column.unit)));
    writer.write_record(heads).map_err(|error| error.to_string())?;
    for row in &table.rows {
        writer.write_record(row.iter().map(Cell::to_string)).map_err(|error| error.to_string())?;
    }
    let bytes = writer.into_inner().map_err(|error| error.to_string())?;
    String::from_utf8(bytes).map_err(|error| error.to_string())
}

/// The rows of a table in the order of a column.
fn order(table: &Table, sorted: Option<(usize, bool)>) -> Vec<usize> {
    let mut order: Vec<usize> = (0..table.rows.len()).collect();
    if let Some((column, largest_first)) = sorted {
        order.sort_by(|a, b| {
            let cell = |row: &usize| table.rows[*row].get(column);
            let compared = match (cell(a), cell(b)) {
                (Some(Cell::Number(a)), Some(Cell::Number(b))) => a.total_cmp(b),
                (a, b) => a.map(Cell::to_string).cmp(&b.map(Cell::to_string)),
            };
            if largest_first { compared.reverse() } else { compared }
        });
    }
    order
}

impl Data {
    pub(crate) fn show(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        let Some((id, node)) = context.active() else {
            ui.label(RichText::new("Select a node to see what it gives.").weak());
            return;
        };
        let kind = node.kind();
        for (index, value) in context.values(id).unwrap_or_default().iter().enumerate() {
            let name = kind.and_then(|kind| kind.outputs().get(index)).map_or("", |output| output.name.as_str());
            ui.label(format!("{name}: {} ({})", value.summary(), value.wire()));
        }
        let Some(report) = context.report(id) else {
            ui.label(RichText::new("It has no result.").weak());
            return;
        };
        ui.horizontal_wrapped(|ui| {
            for figure in &report.figures {
                ui.label(
                    RichText::new(format!("{} {:.6} {}", figure.name, figure.value, figure.unit))
                        .monospace()
                        .size(11.5),
                );
            }
        });
        if report.tables.is_empty() {
            return;
        }
        self.shown = self.shown.min(report.tables.len() - 1);
        ui.horizontal(|ui| {
            for (index, table) in report.tables.iter().enumerate() {
                if ui.selectable_label(index == self.shown, &table.name).clicked() {
                    self.shown = index;
                }
            }
            if ui.button("Export CSV…").clicked() {
                let name = format!("{} {}.csv", node.name(), report.tables[self.shown].name);
                let path = context.document.folder().join(name);
                match csv_of(&report.tables[self.shown]) {
                    Ok(text) => context.ask(FileCommand::Export { path, text }),
                    Err(error) => context.ask(crate::command::Command::Say(crate::command::Message::error(error))),
                }
            }
        });
        let table = &report.tables[self.shown];
        let picked = context.view.picked_row.as_ref().filter(|picked| picked.table == table.name);
        if let Some(clicked) = self.table(ui, table, picked.map(|picked| picked.row)) {
            let row = PickedRow { node: id, table: table.name.clone(), row: clicked };
            // A second click lets go of it.
            let row = Some(row).filter(|row| context.view.picked_row.as_ref() != Some(row));
            context.ask(ViewCommand::PickRow(row));
        }
    }

    /// Shows a table; says which row was clicked.
    fn table(&mut self, ui: &mut Ui, table: &Table, picked: Option<usize>) -> Option<usize> {
        let sorted =
            self.sorted.as_ref().filter(|(name, ..)| *name == table.name).map(|(_, column, down)| (*column, *down));
        let order = order(table, sorted);
        let mut asked = None;
        let mut clicked = None;
        // A picked row would have another one, which can't be read on its background.
        let colour = ui.visuals().text_color();
        let mut builder = TableBuilder::new(ui).striped(true).auto_shrink(false).sense(egui::Sense::click());
        for _ in &table.columns {
            builder = builder.column(Column::auto().at_least(60.0).resizable(true));
        }
        builder
            .header(20.0, |mut header| {
                for (index, column) in table.columns.iter().enumerate() {
                    header.col(|ui| {
                        let sign = match sorted {
                            Some((by, true)) if by == index => signs::DOWN,
                            Some((by, false)) if by == index => signs::UP,
                            _ => "",
                        };
                        let text = format!("{}{} {sign}", column.name, unit(column.unit));
                        if ui.add(egui::Button::new(RichText::new(text).strong()).frame(false)).clicked() {
                            asked = Some(index);
                        }
                    });
                }
            })
            .body(|body| {
                body.rows(16.0, order.len(), |mut row| {
                    let index = order[row.index()];
                    row.set_selected(picked == Some(index));
                    let cells = &table.rows[index];
                    for cell in cells {
                        row.col(|ui| {
                            let text = match cell {
                                Cell::Number(number) if number.fract() == 0.0 => format!("{number}"),
                                Cell::Number(number) => format!("{number:.6}"),
                                Cell::Text(text) => text.clone(),
                            };
                            ui.add(
                                egui::Label::new(RichText::new(text).size(11.5).color(colour))
                                    .selectable(false)
                                    .extend(),
                            );
                        });
                    }
                    let response = row.response();
                    response.widget_info(|| {
                        let label = format!("row {index} of {}", table.name);
                        egui::WidgetInfo::selected(egui::WidgetType::Button, true, picked == Some(index), label)
                    });
                    if response.on_hover_text("Show it in the views").clicked() {
                        clicked = Some(index);
                    }
                });
            });
        if let Some(column) = asked {
            let down = sorted.is_some_and(|(by, down)| by == column && !down);
            self.sorted = Some((table.name.clone(), column, down));
        }
        clicked
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use maquette_graph::Column;

    fn table() -> Table {
        let column = |name: &str, unit| Column { name: name.to_owned(), unit };
        Table {
            name: "rails".to_owned(),
            columns: vec![column("rail", Unit::None), column("gap", Unit::Length)],
            rows: vec![vec!["left, \"a\"".into(), 0.25.into()], vec!["right".into(), (-1.5).into()]],
        }
    }

    #[test]
    fn a_table_is_written_with_units_and_quotes() {
        assert_eq!(csv_of(&table()).unwrap(), "rail,gap (m)\n\"left, \"\"a\"\"\",0.25\nright,-1.5\n");
    }

    #[test]
    fn rows_are_sorted_by_any_column_both_ways() {
        assert_eq!(order(&table(), None), [0, 1]);
        assert_eq!(order(&table(), Some((1, false))), [1, 0]);
        assert_eq!(order(&table(), Some((0, true))), [1, 0]);
    }
}
