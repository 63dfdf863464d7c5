//! What is measured on a node's values only when somebody asks: too costly for every evaluation.

use std::fmt::Display;

use crate::node_kind::{NodeKind, Output};
use crate::ports::NodeError;
use crate::report::{Cell, FigureHandle, Report, ReportBuilder, TableHandle};
use crate::value::{Value, Wire};

/// What the function of [`NodeKind::examine`] sees: the node's outputs, and a report to add to.
pub struct Examination<'a> {
    kind: &'a NodeKind,
    values: &'a [Value],
    report: ReportBuilder<'a>,
    progress: &'a (dyn Fn(f64) -> bool + Sync),
}

impl<'a> Examination<'a> {
    pub(crate) fn new(kind: &'a NodeKind, values: &'a [Value], progress: &'a (dyn Fn(f64) -> bool + Sync)) -> Self {
        Self { kind, values, report: ReportBuilder::new(kind), progress }
    }

    /// The value that the node gave at an output.
    ///
    /// # Panics
    /// Only where the handle belongs to another node kind: a mistake in the node's declaration. The engine reports
    /// it as that node's failure.
    #[expect(clippy::panic, reason = "a foreign handle is a bug in the node's declaration, reported as its failure")]
    pub fn read<T: Wire>(&self, output: Output<T>) -> &'a T {
        match self.values.get(output.index).and_then(Value::get) {
            Some(value) => value,
            None => panic!("output handle {} does not belong to kind \"{}\"", output.index, self.kind.name()),
        }
    }

    /// Says what was found, in plain words.
    pub fn note(&mut self, note: impl Display) {
        self.report.note(note);
    }

    /// Says what will probably disappoint the artist, and what to do about it.
    pub fn warn(&mut self, warning: impl Display) {
        self.report.warn(warning);
    }

    /// Reports a number that [`NodeKind::figure`] declares.
    pub fn figure(&mut self, figure: FigureHandle, value: f64) {
        self.report.figure(figure, value);
    }

    /// Reports a table that [`NodeKind::table`] declares.
    pub fn table(&mut self, table: TableHandle, rows: Vec<Vec<Cell>>) {
        self.report.table(table, rows);
    }

    /// Tells how much is done, 0 to 1, for mathematics that knows nothing of nodes: `false` says stop.
    pub fn progress_callback(&self) -> impl Fn(f64) -> bool + use<'a> {
        let progress = self.progress;
        move |fraction| progress(fraction)
    }

    pub(crate) fn finish(self) -> Result<Report, NodeError> {
        let name = self.kind.name();
        self.report
            .finish()
            .map_err(|what| NodeError::new(format!("the node kind \"{name}\" {what}; this is a mistake in the kind")))
    }
}
