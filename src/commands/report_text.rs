//! What nodes noted and measured, as text and as data.

use maquette_graph::{Cell, Report, Table, Unit};
use serde_json::{Value as Json, json};

/// Rows of a table that are shown whole; a longer one is cut, and `--json` has it all.
const ROWS: usize = 24;

/// Four digits are enough to read; `--json` has them all.
pub(super) fn digits(value: f64) -> String {
    if value.abs() < 1e-12 {
        return "0".to_owned();
    }
    if (1e-3..1e6).contains(&value.abs()) {
        if value.fract() == 0.0 {
            return format!("{value:.0}");
        }
        let decimals = (3.0 - value.abs().log10().floor()).max(0.0) as usize;
        return format!("{value:.decimals$}");
    }
    format!("{value:.3e}")
}

fn with_unit(text: &str, unit: Unit) -> String {
    if unit == Unit::None { text.to_owned() } else { format!("{text} {unit}") }
}

/// Notes, figures and tables; one line each, but for the rows of tables. Warnings are said where they arise.
pub(super) fn lines(report: &Report) -> Vec<String> {
    let mut lines: Vec<String> = report.notes.clone();
    lines.extend(report.figures.iter().map(|f| format!("{}: {}", f.name, with_unit(&digits(f.value), f.unit))));
    report.tables.iter().for_each(|table| lines.extend(table_lines(table)));
    lines
}

/// A table with its columns below each other: numbers to the right, words to the left.
fn table_lines(table: &Table) -> Vec<String> {
    let shown = if table.rows.len() > ROWS { ROWS - 4 } else { table.rows.len() };
    let heading = table.columns.iter().map(|c| match c.unit {
        Unit::None => c.name.clone(),
        unit => format!("{} ({unit})", c.name),
    });
    let cell = |cell: &Cell| match cell {
        Cell::Number(number) => digits(*number),
        Cell::Text(text) => text.clone(),
    };
    let mut rows: Vec<Vec<String>> = vec![heading.collect()];
    rows.extend(table.rows[..shown].iter().map(|row| row.iter().map(cell).collect()));
    let numbers = |column: usize| table.rows.iter().any(|row| matches!(row.get(column), Some(Cell::Number(_))));
    let layout: Vec<(usize, bool)> = (0..table.columns.len())
        .map(|column| {
            let width = rows.iter().filter_map(|row| row.get(column)).map(|text| text.chars().count()).max();
            (width.unwrap_or(0), numbers(column))
        })
        .collect();
    let mut lines = vec![format!("{}:", table.name)];
    for row in rows {
        let padded = row.iter().zip(&layout).map(|(text, (width, right))| match right {
            true => format!("{text:>width$}"),
            false => format!("{text:width$}"),
        });
        lines.push(format!("  {}", padded.collect::<Vec<_>>().join("  ")).trim_end().to_owned());
    }
    if shown < table.rows.len() {
        lines.push(format!("  {} more rows; --json has all {}", table.rows.len() - shown, table.rows.len()));
    }
    lines
}

/// The whole report.
pub(super) fn as_json(report: &Report) -> Json {
    let figures: Vec<Json> = report
        .figures
        .iter()
        .map(|f| json!({ "name": f.name, "value": f.value, "unit": f.unit.to_string() }))
        .collect();
    let cell = |cell: &Cell| match cell {
        Cell::Number(number) => json!(number),
        Cell::Text(text) => json!(text),
    };
    let table = |table: &Table| {
        let columns: Vec<Json> =
            table.columns.iter().map(|c| json!({ "name": c.name, "unit": c.unit.to_string() })).collect();
        let rows: Vec<Vec<Json>> = table.rows.iter().map(|row| row.iter().map(cell).collect()).collect();
        json!({ "name": table.name, "columns": columns, "rows": rows })
    };
    json!({
        "notes": report.notes,
        "warnings": report.warnings,
        "figures": figures,
        "tables": report.tables.iter().map(table).collect::<Vec<_>>(),
    })
}

#[cfg(test)]
mod tests {
    use maquette_graph::{Column, Figure};

    use super::*;

    fn report(rows: usize) -> Report {
        let column = |name: &str, unit| Column { name: name.to_owned(), unit };
        let row = |k: usize| vec![Cell::from(format!("rail {k}")), Cell::Number(0.5 * k as f64)];
        Report {
            notes: vec!["all is well".to_owned()],
            warnings: vec![],
            figures: vec![
                Figure { name: "gap".to_owned(), value: 0.012_345_6, unit: Unit::Length },
                Figure { name: "faces".to_owned(), value: 3760.0, unit: Unit::None },
            ],
            tables: vec![Table {
                name: "rails".to_owned(),
                columns: vec![column("rail", Unit::None), column("angle", Unit::Angle)],
                rows: (9..9 + rows).map(row).collect(),
            }],
        }
    }

    #[test]
    fn columns_stand_below_each_other() {
        let wanted = [
            "all is well",
            "gap: 0.01235 m",
            "faces: 3760",
            "rails:",
            "  rail     angle (degrees)",
            "  rail 9             4.500",
            "  rail 10                5",
        ];
        assert_eq!(lines(&report(2)), wanted);
    }

    #[test]
    fn a_long_table_is_cut_in_text_and_whole_in_json() {
        let lines = lines(&report(500));
        assert_eq!(lines.len(), 5 + 20 + 1);
        assert_eq!(lines[25], "  480 more rows; --json has all 500");
        assert_eq!(as_json(&report(500))["tables"][0]["rows"].as_array().map(Vec::len), Some(500));
        assert_eq!(as_json(&report(1))["tables"][0]["columns"][1]["unit"], "degrees");
    }
}
