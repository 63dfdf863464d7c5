//! What a node sees while it runs: its inputs, its outputs, a report, progress, cancellation.

use std::fmt::Display;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::literal::{Choice, FilePath};
use crate::node_kind::{ChoiceInput, Choices, Input, NodeKind, OptionalInput, Output};
use crate::report::{Cell, FigureHandle, Report, ReportBuilder, TableHandle};
use crate::value::{ContentHash, Value, Wire};

/// Why a node did not give a result. Any error converts into it with `?`.
#[derive(Debug)]
pub enum NodeError {
    /// The evaluation was cancelled; never remembered as a failure.
    Cancelled,
    /// It failed.
    Failed {
        /// Index of the input at fault, where one is.
        input: Option<usize>,
        /// What is wrong and what to do.
        message: String,
    },
}

impl NodeError {
    /// A failure in plain words: what is wrong and what to do.
    pub fn new(message: impl Into<String>) -> Self {
        Self::Failed { input: None, message: message.into() }
    }
}

impl<E: std::error::Error> From<E> for NodeError {
    fn from(error: E) -> Self {
        Self::new(error.to_string())
    }
}

/// Handles of inputs, for naming the port at fault.
pub trait InputHandle {
    /// Place among the inputs.
    fn index(&self) -> usize;
}

impl<T> InputHandle for Input<T> {
    fn index(&self) -> usize {
        self.index
    }
}

impl<T> InputHandle for OptionalInput<T> {
    fn index(&self) -> usize {
        self.index
    }
}

impl<T> InputHandle for ChoiceInput<T> {
    fn index(&self) -> usize {
        self.index
    }
}

/// Names the input at fault: `resample(curve, n).at(curves)?`.
pub trait AtPort<T> {
    /// The same result, its error laid at that input.
    ///
    /// # Errors
    /// The error it had.
    fn at(self, input: impl InputHandle) -> Result<T, NodeError>;
}

impl<T, E: Display> AtPort<T> for Result<T, E> {
    fn at(self, input: impl InputHandle) -> Result<T, NodeError> {
        self.map_err(|error| NodeError::Failed { input: Some(input.index()), message: error.to_string() })
    }
}

/// What is wrong with an empty path.
pub(crate) const NO_FILE_NAMED: &str = "no file is named: give a path, relative to the folder of the graph";

/// A running node's view of the world.
pub struct Ports<'a> {
    kind: &'a NodeKind,
    inputs: &'a [Option<Value>],
    /// The content of the files that the kind reads, with the indices of their inputs.
    files: &'a [(usize, Arc<[u8]>)],
    outputs: Vec<Option<Value>>,
    report: ReportBuilder<'a>,
    base: &'a Path,
    /// Reports progress; `false` says stop.
    progress: &'a (dyn Fn(f64) -> bool + Sync),
}

impl<'a> Ports<'a> {
    pub(crate) fn new(
        kind: &'a NodeKind,
        inputs: &'a [Option<Value>],
        files: &'a [(usize, Arc<[u8]>)],
        base: &'a Path,
        progress: &'a (dyn Fn(f64) -> bool + Sync),
    ) -> Self {
        let outputs = vec![None; kind.outputs().len()];
        Self { kind, inputs, files, outputs, report: ReportBuilder::new(kind), base, progress }
    }

    fn get<T: Wire>(&self, index: usize) -> Option<&'a T> {
        self.inputs.get(index)?.as_ref()?.get()
    }

    /// The value at an input.
    ///
    /// # Panics
    /// Only where the handle belongs to another node kind: a mistake in the node's declaration. The engine reports
    /// it as that node's failure.
    #[expect(clippy::panic, reason = "a foreign handle is a bug in the node's declaration, reported as its failure")]
    pub fn read<T: Wire>(&self, input: Input<T>) -> &'a T {
        match self.get(input.index) {
            Some(value) => value,
            None => panic!("input handle {} does not belong to kind \"{}\"", input.index, self.kind.name()),
        }
    }

    /// Hash of the value at an input: for a result that contains it unchanged.
    ///
    /// # Panics
    /// As [`Ports::read`].
    #[expect(clippy::panic, reason = "a foreign handle is a bug in the node's declaration, reported as its failure")]
    pub fn content_hash<T: Wire>(&self, input: Input<T>) -> ContentHash {
        match self.inputs.get(input.index).and_then(Option::as_ref) {
            Some(value) => value.hash(),
            None => panic!("input handle {} does not belong to kind \"{}\"", input.index, self.kind.name()),
        }
    }

    /// The number, integer or flag at an input.
    pub fn value<T: Wire + Copy>(&self, input: Input<T>) -> T {
        *self.read(input)
    }

    /// The whole number at an input, as a count. Declare it with a range that begins at 0 or above.
    pub fn count(&self, input: Input<i64>) -> usize {
        usize::try_from(self.value(input)).unwrap_or(0)
    }

    /// The value at an optional input, where it is connected.
    pub fn read_optional<T: Wire>(&self, input: OptionalInput<T>) -> Option<&'a T> {
        self.get(input.index)
    }

    /// The option chosen.
    ///
    /// # Panics
    /// As [`Ports::read`].
    #[expect(clippy::panic, reason = "options are checked before the node runs; a foreign handle is a declaration bug")]
    pub fn choice<E: Choices>(&self, input: ChoiceInput<E>) -> E {
        let chosen = self.get::<Choice>(input.index);
        match chosen.and_then(|c| E::OPTIONS.iter().find(|(_, name, _)| *name == c.0)) {
            Some((option, _, _)) => *option,
            None => panic!("choice handle {} does not belong to kind \"{}\"", input.index, self.kind.name()),
        }
    }

    /// The path at an input, for its extension and for messages: relative paths start at the folder of the graph's file.
    ///
    /// # Errors
    /// No file is named.
    pub fn path(&self, input: Input<FilePath>) -> Result<PathBuf, NodeError> {
        let FilePath(path) = self.read(input);
        if path.is_empty() {
            return Err(NO_FILE_NAMED).at(input);
        }
        Ok(self.base.join(path))
    }

    /// The content of the file at an input that [`NodeKind::reads_file`] declares. It was read before the node
    /// started, once for all nodes that read it, and the result is remembered for these very bytes.
    ///
    /// # Errors
    /// The kind does not declare that it reads this file.
    pub fn file(&self, input: Input<FilePath>) -> Result<Arc<[u8]>, NodeError> {
        match self.files.iter().find(|(index, _)| *index == input.index) {
            Some((_, bytes)) => Ok(bytes.clone()),
            None => Err(format!(
                "the node kind \"{}\" reads this file without declaring it with `reads_file`; this is a mistake in \
                 the kind",
                self.kind.name()
            ))
            .at(input),
        }
    }

    /// Sets an output.
    pub fn write<T: Wire>(&mut self, output: Output<T>, value: T) {
        self.write_value(output, Value::new(value));
    }

    /// Hands a value on without hashing it again.
    pub fn write_value<T: Wire>(&mut self, output: Output<T>, value: Value) {
        if let Some(slot) = self.outputs.get_mut(output.index) {
            *slot = Some(value);
        }
    }

    /// Hands the value of an input on at an output.
    pub(crate) fn pass(&mut self, input: usize, output: usize) {
        let value = self.inputs.get(input).cloned().flatten();
        if let Some(slot) = self.outputs.get_mut(output) {
            *slot = value;
        }
    }

    /// Says what the node decided, in plain words.
    pub fn note(&mut self, note: impl Display) {
        self.report.note(note);
    }

    /// Says what will probably disappoint the artist, and what to do about it.
    pub fn warn(&mut self, warning: impl Display) {
        self.report.warn(warning);
    }

    /// Reports a number that [`NodeKind::figure`] declares, in the unit declared.
    pub fn figure(&mut self, figure: FigureHandle, value: f64) {
        self.report.figure(figure, value);
    }

    /// Reports a table that [`NodeKind::table`] declares: rows with a cell a column.
    pub fn table(&mut self, table: TableHandle, rows: Vec<Vec<Cell>>) {
        self.report.table(table, rows);
    }

    /// Tells how much is done, 0 to 1, and asks whether to go on.
    ///
    /// # Errors
    /// [`NodeError::Cancelled`]: pass it on with `?`.
    pub fn progress(&self, fraction: f64) -> Result<(), NodeError> {
        if (self.progress)(fraction) { Ok(()) } else { Err(NodeError::Cancelled) }
    }

    /// The same as a callback for mathematics that knows nothing of nodes: `false` says stop. What the node gives
    /// after that is not remembered, so that it may stop halfway.
    pub fn progress_callback(&self) -> impl Fn(f64) -> bool + use<'a> {
        let progress = self.progress;
        move |fraction| progress(fraction)
    }

    pub(crate) fn inputs(&self) -> &'a [Option<Value>] {
        self.inputs
    }

    pub(crate) fn files(&self) -> &'a [(usize, Arc<[u8]>)] {
        self.files
    }

    pub(crate) fn outputs(&self) -> &[Option<Value>] {
        &self.outputs
    }

    pub(crate) fn finish(self) -> Result<(Vec<Value>, Report), NodeError> {
        let kind = self.kind;
        let mistake = |what: String| {
            Err(NodeError::new(format!("the node kind \"{}\" {what}; this is a mistake in the kind", kind.name())))
        };
        let mut values = Vec::with_capacity(self.outputs.len());
        let mut missing = Vec::new();
        for (spec, output) in kind.outputs().iter().zip(self.outputs) {
            match output {
                None => missing.push(spec.name.as_str()),
                Some(value) if value.wire() != spec.wire => {
                    let (wrote, declared) = (value.wire(), spec.wire);
                    return mistake(format!(
                        "wrote {wrote} to its output \"{}\", which is declared as {declared}",
                        spec.name
                    ));
                }
                Some(value) => values.push(value),
            }
        }
        if !missing.is_empty() {
            return mistake(format!("did not write its output {}", missing.join(", ")));
        }
        match self.report.finish() {
            Ok(report) => Ok((values, report)),
            Err(what) => mistake(what),
        }
    }
}
