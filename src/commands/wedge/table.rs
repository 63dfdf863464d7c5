//! The table of what came out: as text, CSV or JSON.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::{Value as Json, json};

use super::row::{Row, Size, State};
use crate::commands::report_text::digits;

/// The forms of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    Text,
    Csv,
    Json,
}

impl Form {
    /// The form that a file's extension asks for.
    pub(super) fn of(path: &Path) -> Result<Self, String> {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            Some("txt") => Ok(Self::Text),
            Some("csv") => Ok(Self::Csv),
            Some("json") => Ok(Self::Json),
            _ => Err(format!("error: --table {}: end it in .csv, .json or .txt", path.display())),
        }
    }
}

/// What came out of a wedge.
pub(super) struct Table<'a> {
    pub(super) graph: String,
    pub(super) addresses: Vec<&'a str>,
    pub(super) rows: &'a [Row],
    /// Time of the whole wedge.
    pub(super) seconds: f64,
    /// What is wrong beside the variants.
    pub(super) errors: &'a [String],
}

/// A number in a column: as it is, and whether it counts things.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Number {
    Count(usize),
    Measure(f64),
}

impl Number {
    fn short(self) -> String {
        match self {
            Self::Count(count) => count.to_string(),
            Self::Measure(value) => digits(value),
        }
    }

    fn full(self) -> String {
        match self {
            Self::Count(count) => count.to_string(),
            Self::Measure(value) => value.to_string(),
        }
    }
}

/// Columns of numbers: the name of each, and its number in each row that has it.
struct Columns {
    names: Vec<String>,
    cells: Vec<BTreeMap<usize, Number>>,
}

impl Columns {
    fn of(rows: &[Row]) -> Self {
        let mut columns = Self { names: Vec::new(), cells: vec![BTreeMap::new(); rows.len()] };
        let mut places: BTreeMap<String, usize> = BTreeMap::new();
        for (row, cells) in rows.iter().zip(&mut columns.cells) {
            for (name, number) in numbers(row) {
                let place = *places.entry(name).or_insert_with_key(|name| {
                    columns.names.push(name.clone());
                    columns.names.len() - 1
                });
                cells.insert(place, number);
            }
        }
        columns
    }

    /// The number that all rows that were evaluated have in a column.
    fn constant(&self, column: usize) -> Option<Number> {
        let mut cells = self.cells.iter().filter(|cells| !cells.is_empty()).map(|cells| cells.get(&column));
        let first = *cells.next()??;
        cells.all(|cell| cell == Some(&first)).then_some(first)
    }
}

/// All numbers of a row under their names.
fn numbers(row: &Row) -> Vec<(String, Number)> {
    let mut numbers = Vec::new();
    for result in &row.results {
        let sizes = match result.size {
            Size::Mesh { vertices, faces } => [("vertices", vertices), ("faces", faces)],
            Size::Curves { curves, points } => [("curves", curves), ("points", points)],
        };
        numbers.extend(sizes.map(|(what, count)| (format!("{} {what}", result.name), Number::Count(count))));
    }
    for figure in &row.figures {
        let unit = if figure.unit.is_empty() { String::new() } else { format!(" [{}]", figure.unit) };
        numbers.push((format!("{}.{}{unit}", figure.node, figure.name), Number::Measure(figure.value)));
    }
    numbers
}

impl Table<'_> {
    /// The table in a form, ending in a new line.
    pub(super) fn to_bytes(&self, form: Form) -> Result<Vec<u8>, String> {
        match form {
            Form::Text => Ok(self.to_text().into_bytes()),
            Form::Csv => self.to_csv(),
            Form::Json => Ok(format!("{:#}\n", self.to_json()).into_bytes()),
        }
    }

    /// Aligned columns; what is the same in all variants is said once, below.
    pub(super) fn to_text(&self) -> String {
        let columns = Columns::of(self.rows);
        let evaluated = columns.cells.iter().filter(|cells| !cells.is_empty()).count();
        let same = |column: usize| columns.constant(column).filter(|_| evaluated > 1);
        let varying: Vec<usize> = (0..columns.names.len()).filter(|column| same(*column).is_none()).collect();
        let mut lines: Vec<Vec<String>> = Vec::with_capacity(self.rows.len() + 1);
        let listed = self.rows.iter().all(|row| row.state == State::Listed);
        let mut head = vec!["#".to_owned()];
        head.extend(self.addresses.iter().map(|address| (*address).to_owned()));
        if !listed {
            head.extend(["state", "ms", "ran", "hits"].map(str::to_owned));
        }
        head.extend(varying.iter().map(|column| columns.names[*column].clone()));
        let numbers = head.len();
        let files = self.rows.iter().any(|row| !row.files.is_empty());
        if files {
            head.push("files".to_owned());
        }
        lines.push(head);
        for (row, cells) in self.rows.iter().zip(&columns.cells) {
            let mut line = vec![row.index.to_string()];
            line.extend(row.values.iter().cloned());
            if !listed {
                let milliseconds = format!("{:.2}", row.seconds * 1e3);
                line.extend([row.state.name().to_owned(), milliseconds, row.ran.to_string(), row.hits.to_string()]);
            }
            line.extend(varying.iter().map(|column| cells.get(column).map_or("-".to_owned(), |n| n.short())));
            if files {
                line.push(row.files.iter().map(|file| file.path.as_str()).collect::<Vec<_>>().join(" "));
            }
            lines.push(line);
        }
        let mut out = aligned(&lines, numbers);
        let constants: Vec<String> = (0..columns.names.len())
            .filter_map(|column| Some(format!("{} {}", columns.names[column], same(column)?.short())))
            .collect();
        if !constants.is_empty() {
            out += &format!("the same in all: {}\n", constants.join(", "));
        }
        out
    }

    /// A head, and a line for each variant; numbers with all their digits.
    fn to_csv(&self) -> Result<Vec<u8>, String> {
        let columns = Columns::of(self.rows);
        let mut writer = csv::Writer::from_writer(Vec::new());
        let mut head: Vec<&str> = vec!["index"];
        head.extend(&self.addresses);
        head.extend(["state", "seconds", "ran", "hits"]);
        head.extend(columns.names.iter().map(String::as_str));
        head.extend(["files", "errors"]);
        let fail = |error: csv::Error| format!("the table could not be made: {error}");
        writer.write_record(&head).map_err(fail)?;
        for (row, cells) in self.rows.iter().zip(&columns.cells) {
            let mut line = vec![row.index.to_string()];
            line.extend(row.values.iter().cloned());
            let seconds = row.seconds.to_string();
            line.extend([row.state.name().to_owned(), seconds, row.ran.to_string(), row.hits.to_string()]);
            let number = |column: usize| cells.get(&column).map_or(String::new(), |number| number.full());
            line.extend((0..columns.names.len()).map(number));
            line.push(row.files.iter().map(|file| file.path.as_str()).collect::<Vec<_>>().join(";"));
            line.push(row.errors.join("\n"));
            writer.write_record(&line).map_err(fail)?;
        }
        writer.into_inner().map_err(|error| format!("the table could not be made: {error}"))
    }

    /// Everything, for programs.
    pub(super) fn to_json(&self) -> Json {
        let variants = self.rows.iter().map(|row| {
            let values: serde_json::Map<String, Json> = self
                .addresses
                .iter()
                .zip(&row.values)
                .map(|(a, v)| ((*a).to_owned(), Json::from(v.as_str())))
                .collect();
            let mut json = json!(row);
            json["values"] = Json::Object(values);
            json
        });
        let count = |state| self.rows.iter().filter(|row| row.state == state).count();
        let finished = |row: &Row| matches!(row.state, State::Done | State::Kept | State::Listed);
        json!({
            "graph": self.graph,
            "ok": self.errors.is_empty() && self.rows.iter().all(finished),
            "seconds": self.seconds,
            "addresses": self.addresses,
            "variants": variants.collect::<Vec<_>>(),
            "done": count(State::Done),
            "kept": count(State::Kept),
            "failed": count(State::Failed),
            "exceeded": count(State::Exceeded),
            "not-written": count(State::NotWritten),
            "stopped": count(State::Stopped),
            "ran": self.rows.iter().filter(|row| row.state != State::Kept).map(|row| row.ran).sum::<usize>(),
            "hits": self.rows.iter().filter(|row| row.state != State::Kept).map(|row| row.hits).sum::<usize>(),
            "errors": self.errors,
        })
    }
}

/// Lines of cells below one another, the first `right` columns at their right ends.
fn aligned(lines: &[Vec<String>], right: usize) -> String {
    let columns = lines.first().map_or(0, Vec::len);
    let width = |column: usize| lines.iter().map(|line| line[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut out = String::new();
    for line in lines {
        let cells = line.iter().zip(&widths).enumerate().map(|(column, (cell, width))| {
            if column < right { format!("{cell:>width$}") } else { format!("{cell:width$}") }
        });
        out += cells.collect::<Vec<_>>().join("  ").trim_end();
        out.push('\n');
    }
    out
}

#[cfg(test)]
mod tests {
    use super::super::row::{FigureRow, FileRow, ResultRow};
    use super::*;

    fn rows() -> Vec<Row> {
        let figure = |name: &str, value| FigureRow { node: "body".into(), name: name.into(), value, unit: "m".into() };
        let mut rows: Vec<Row> =
            (1..=3).map(|i| Row::unreached(i, vec![i.to_string(), "a,\"b\"".into()], State::Done)).collect();
        for (i, row) in rows.iter_mut().enumerate().take(2) {
            row.seconds = 0.0015;
            row.ran = 4;
            row.results =
                vec![ResultRow { name: "vest".into(), bounds: None, size: Size::Mesh { vertices: 8 + i, faces: 6 } }];
            row.figures = vec![figure("gap", 0.25), figure("fold", 1.0 / 3.0 + i as f64)];
            row.files = vec![FileRow { path: format!("{i}.glb"), bytes: 1, hash: String::new() }];
        }
        rows[2].state = State::Failed;
        rows[2].errors = vec!["error: no".into()];
        rows
    }

    fn table(rows: &[Row]) -> Table<'_> {
        Table { graph: "g.ron".into(), addresses: vec!["body.k_s", "text.t"], rows, seconds: 1.0, errors: &[] }
    }

    #[test]
    fn text_says_once_what_is_the_same_in_all() {
        let rows = rows();
        let expected = concat!(
            "#  body.k_s  text.t   state    ms  ran  hits  vest vertices  body.fold [m]  files\n",
            "1         1   a,\"b\"    done  1.50    4     0              8         0.3333  0.glb\n",
            "2         2   a,\"b\"    done  1.50    4     0              9          1.333  1.glb\n",
            "3         3   a,\"b\"  failed  0.00    0     0              -              -\n",
            "the same in all: vest faces 6, body.gap [m] 0.2500\n",
        );
        assert_eq!(table(&rows).to_text(), expected);
    }

    #[test]
    fn csv_holds_every_digit_and_quotes_what_needs_it() {
        let rows = rows();
        let text = String::from_utf8(table(&rows).to_bytes(Form::Csv).unwrap()).unwrap();
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let head: Vec<_> = reader.headers().unwrap().iter().map(str::to_owned).collect();
        assert_eq!(head[..4], ["index", "body.k_s", "text.t", "state"]);
        assert_eq!(head[7..], ["vest vertices", "vest faces", "body.gap [m]", "body.fold [m]", "files", "errors"]);
        let lines: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
        assert_eq!((lines.len(), &lines[0][2], &lines[0][10]), (3, "a,\"b\"", "0.3333333333333333"));
        assert_eq!((&lines[2][10], &lines[2][12]), ("", "error: no"));
    }

    #[test]
    fn json_counts_what_came_out() {
        let rows = rows();
        let json = table(&rows).to_json();
        assert_eq!((&json["ok"], &json["done"], &json["failed"]), (&json!(false), &json!(2), &json!(1)));
        assert_eq!(json["variants"][1]["values"]["body.k_s"], "2");
        assert_eq!(json["variants"][1]["figures"][0]["value"], 0.25);
        assert_eq!(json["variants"][1]["results"][0]["vertices"], 9);
    }

    #[test]
    fn the_extension_gives_the_form() {
        assert_eq!(Form::of(Path::new("a.CSV")).unwrap(), Form::Csv);
        assert!(Form::of(Path::new("a.xls")).unwrap_err().contains("end it in .csv, .json or .txt"));
    }
}
