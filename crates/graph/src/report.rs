//! What a node says beside its values: cached with them, shown to the artist, and what gates a build.

use std::fmt;

use crate::node_kind::NodeKind;
use crate::port::Unit;

/// A named number with its unit, such as a largest gap in metres.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Name, `kebab-case`.
    pub name: String,
    /// The number.
    pub value: f64,
    /// What it measures.
    pub unit: Unit,
}

/// What stands in a row of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A number, in the unit of its column.
    Number(f64),
    /// A word, such as the name of a curve.
    Text(String),
}

impl From<f64> for Cell {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<usize> for Cell {
    #[expect(clippy::cast_precision_loss, reason = "counts are far below 2^53")]
    fn from(count: usize) -> Self {
        Self::Number(count as f64)
    }
}

impl From<bool> for Cell {
    fn from(flag: bool) -> Self {
        Self::Text(if flag { "yes" } else { "no" }.to_owned())
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => number.fmt(f),
            Self::Text(text) => f.write_str(text),
        }
    }
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Name, `kebab-case`. That of the first column with its cell labels the row in messages: `section 7`.
    pub name: String,
    /// What its numbers measure.
    pub unit: Unit,
}

/// A named table, such as one row a rail.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Name, `kebab-case`.
    pub name: String,
    /// Its columns; the first one labels the rows.
    pub columns: Vec<Column>,
    /// Its rows, each with a cell a column.
    pub rows: Vec<Vec<Cell>>,
}

impl Table {
    /// What a row is called in messages: the name of the first column and its cell.
    pub fn label(&self, row: usize) -> String {
        match (self.columns.first(), self.rows.get(row).and_then(|cells| cells.first())) {
            (Some(column), Some(Cell::Text(text))) => format!("{} {text:?}", column.name),
            (Some(column), Some(Cell::Number(number))) => format!("{} {number}", column.name),
            _ => format!("row {row}"),
        }
    }
}

/// Notes, warnings, figures and tables of one run of a node.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// What the node decided, in plain words.
    pub notes: Vec<String>,
    /// What will probably disappoint the artist, and what to do about it.
    pub warnings: Vec<String>,
    /// Measured numbers.
    pub figures: Vec<Figure>,
    /// Measured tables.
    pub tables: Vec<Table>,
}

impl Report {
    /// Whether there is nothing to say.
    pub fn is_empty(&self) -> bool {
        self.notes.is_empty() && self.warnings.is_empty() && self.figures.is_empty() && self.tables.is_empty()
    }

    /// The figure of that name.
    pub fn figure(&self, name: &str) -> Option<&Figure> {
        self.figures.iter().find(|figure| figure.name == name)
    }

    /// The table of that name.
    pub fn table(&self, name: &str) -> Option<&Table> {
        self.tables.iter().find(|table| table.name == name)
    }

    /// Bytes held, heap included; what the memo's budget counts beside the values.
    pub fn byte_size(&self) -> usize {
        let texts = |texts: &[String]| texts.iter().map(|text| size_of::<String>() + text.len()).sum::<usize>();
        let figures = self.figures.iter().map(|figure| size_of::<Figure>() + figure.name.len());
        let cells = |cells: &[Cell]| {
            let text = |cell: &Cell| if let Cell::Text(text) = cell { text.len() } else { 0 };
            size_of::<Vec<Cell>>() + size_of_val(cells) + cells.iter().map(text).sum::<usize>()
        };
        let tables = self.tables.iter().map(|table| {
            let columns = table.columns.iter().map(|column| size_of::<Column>() + column.name.len()).sum::<usize>();
            size_of::<Table>() + table.name.len() + columns + table.rows.iter().map(|r| cells(r)).sum::<usize>()
        });
        texts(&self.notes) + texts(&self.warnings) + figures.sum::<usize>() + tables.sum::<usize>()
    }

    /// Adds what another says.
    pub(crate) fn append(&mut self, mut other: Self) {
        self.notes.append(&mut other.notes);
        self.warnings.append(&mut other.warnings);
        self.figures.append(&mut other.figures);
        self.tables.append(&mut other.tables);
    }

    /// Takes over what a node within a body said: notes and warnings behind the way to it, which may say for which time,
    /// and figures and tables under the name that the kind declares them by.
    pub(crate) fn absorb(&mut self, way: &str, node: &str, other: &Self) {
        self.notes.extend(other.notes.iter().map(|note| format!("{way}: {note}")));
        self.warnings.extend(other.warnings.iter().map(|warning| format!("{way}: {warning}")));
        let figures = other.figures.iter().map(|figure| Figure { name: inside(node, &figure.name), ..figure.clone() });
        self.figures.extend(figures);
        let tables = other.tables.iter().map(|table| Table { name: inside(node, &table.name), ..table.clone() });
        self.tables.extend(tables);
    }

    /// Keeps what a body says within bounds: parts of parts of parts could say the same a billion times.
    pub(crate) fn bounded(mut self) -> Self {
        let said = [self.notes.len(), self.warnings.len(), self.figures.len(), self.tables.len()];
        if said.into_iter().any(|count| count > MOST_SAID) {
            self.notes.truncate(MOST_SAID);
            self.warnings.truncate(MOST_SAID);
            self.figures.truncate(MOST_SAID);
            self.tables.truncate(MOST_SAID);
            self.warnings.push(format!("the nodes within say more than {MOST_SAID} things; the others are left out"));
        }
        self
    }

    /// What was said first, and behind it what was said later.
    pub(crate) fn followed_by(&self, later: &Self) -> Self {
        let mut both = self.clone();
        both.notes.extend_from_slice(&later.notes);
        both.warnings.extend_from_slice(&later.warnings);
        both.figures.extend_from_slice(&later.figures);
        both.tables.extend_from_slice(&later.tables);
        both
    }
}

/// Notes that a body passes on at most, and likewise warnings, figures and tables.
const MOST_SAID: usize = 100_000;

/// Name of a figure or table of a node within a body.
pub(crate) fn inside(node: &str, name: &str) -> String {
    format!("{node}/{name}")
}

/// A figure that a node kind declares with [`NodeKind::figure`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FigureSpec {
    /// Name, `kebab-case`, unique among the figures and tables of its kind.
    pub name: String,
    /// What it measures.
    pub unit: Unit,
    /// One line on what it says.
    pub description: String,
}

/// A table that a node kind declares with [`NodeKind::table`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableSpec {
    /// Name, `kebab-case`, unique among the figures and tables of its kind.
    pub name: String,
    /// Its columns; the first one labels the rows.
    pub columns: Vec<Column>,
    /// One line on what its rows are.
    pub description: String,
}

/// Handle of a declared figure.
#[derive(Clone, Copy, Debug)]
pub struct FigureHandle {
    pub(crate) index: usize,
}

/// Handle of a declared table.
#[derive(Clone, Copy, Debug)]
pub struct TableHandle {
    pub(crate) index: usize,
}

/// A report as a running node fills it.
pub(crate) struct ReportBuilder<'a> {
    kind: &'a NodeKind,
    report: Report,
    /// What the kind did wrong, where it did.
    mistake: Option<String>,
}

impl<'a> ReportBuilder<'a> {
    pub(crate) fn new(kind: &'a NodeKind) -> Self {
        Self { kind, report: Report::default(), mistake: None }
    }

    pub(crate) fn note(&mut self, note: impl fmt::Display) {
        self.report.notes.push(note.to_string());
    }

    pub(crate) fn warn(&mut self, warning: impl fmt::Display) {
        self.report.warnings.push(warning.to_string());
    }

    pub(crate) fn figure(&mut self, figure: FigureHandle, value: f64) {
        match self.kind.figures().get(figure.index) {
            Some(spec) => self.report.figures.push(Figure { name: spec.name.clone(), value, unit: spec.unit }),
            None => self.mistake = Some(format!("reports figure {}, which is not its own", figure.index)),
        }
    }

    pub(crate) fn table(&mut self, table: TableHandle, rows: Vec<Vec<Cell>>) {
        let Some(spec) = self.kind.tables().get(table.index) else {
            self.mistake = Some(format!("reports table {}, which is not its own", table.index));
            return;
        };
        let columns = spec.columns.len();
        if let Some((row, cells)) = rows.iter().enumerate().find(|(_, cells)| cells.len() != columns) {
            let (name, found) = (&spec.name, cells.len());
            self.mistake = Some(format!("gave row {row} of its table \"{name}\" {found} cells for {columns} columns"));
            return;
        }
        self.report.tables.push(Table { name: spec.name.clone(), columns: spec.columns.clone(), rows });
    }

    /// The report, or what the kind did wrong.
    pub(crate) fn finish(self) -> Result<Report, String> {
        self.mistake.map_or(Ok(self.report), Err)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_labelled_by_their_first_cell() {
        let column = |name: &str| Column { name: name.to_owned(), unit: Unit::None };
        let rows = vec![vec![7_usize.into(), 0.5.into()], vec!["left".into(), true.into()], vec![]];
        let table = Table { name: "fit".to_owned(), columns: vec![column("section"), column("error")], rows };
        assert_eq!([0, 1, 2].map(|row| table.label(row)), ["section 7", "section \"left\"", "row 2"]);
    }

    #[test]
    fn every_part_of_a_report_costs_bytes() {
        let mut report = Report::default();
        assert_eq!(report.byte_size(), 0);
        let mut before = 0;
        let mut grown = |report: &Report, by: usize| {
            let now = report.byte_size();
            assert!(now >= before + by, "{before} {now}");
            before = now;
        };
        report.notes.push("n".repeat(100));
        grown(&report, 100);
        report.warnings.push("w".repeat(100));
        grown(&report, 100);
        report.figures.push(Figure { name: "gap".to_owned(), value: 1.0, unit: Unit::Length });
        grown(&report, size_of::<Figure>());
        let rows = vec![vec![Cell::Number(0.0), Cell::Text("t".repeat(10))]; 50];
        report.tables.push(Table { name: "fit".to_owned(), columns: vec![], rows });
        grown(&report, 50 * (2 * size_of::<Cell>() + 10));
    }
}
