//! Runs one node alone, without graph, memo or threads: for its tests.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use crate::evaluate::Failure;
use crate::evaluate::call;
use crate::evaluate::inputs::failure;
use crate::literal::{FilePath, Literal};
use crate::node_kind::NodeKind;
use crate::ports::{NO_FILE_NAMED, NodeError};
use crate::report::Report;
use crate::value::{Value, Wire};

/// One node with its inputs, to be run alone.
///
/// Inputs hold their defaults until [`set`](Self::set) or [`give`](Self::give) puts something else there. Ranges,
/// options and types are checked as in a graph; implicit conversions belong to catalogues and don't happen here.
///
/// ```
/// use maquette_graph::harness::Harness;
/// use maquette_graph::{Literal, NodeKind, Unit};
///
/// let mut node = NodeKind::declare("halve", 1, "numbers", "Halves a number.");
/// let number = node.number("number", 0.0, -1e9..=1e9, "The number.");
/// let half = node.output::<f64>("half", "Half of it.");
/// let rest = node.figure("rest", Unit::None, "What an integer division would leave.");
/// node.evaluate(move |ports| {
///     ports.progress(0.5)?;
///     ports.figure(rest, ports.value(number).rem_euclid(2.0));
///     ports.write(half, ports.value(number) / 2.0);
///     Ok(())
/// });
///
/// let trial = Harness::new(&node).set("number", Literal::Number(5.0)).run()?;
/// assert_eq!(trial.value::<f64>("half"), Some(&2.5));
/// assert_eq!(trial.report.figure("rest").map(|figure| figure.value), Some(1.0));
/// assert_eq!(trial.progress, [0.5]);
///
/// // Out of range, and stopped halfway.
/// assert!(Harness::new(&node).set("number", Literal::Number(1e10)).run().is_err());
/// let stopped = Harness::new(&node).while_progress(|done| done < 0.5).run();
/// assert!(stopped.unwrap_err().is_cancelled());
/// # Ok::<(), maquette_graph::harness::TrialError>(())
/// ```
pub struct Harness<'a> {
    kind: &'a NodeKind,
    inputs: Vec<Option<Value>>,
    files: BTreeMap<String, Arc<[u8]>>,
    go_on: Box<dyn Fn(f64) -> bool + Sync + 'a>,
    examine: bool,
    wrong: Option<Failure>,
}

/// What a node did.
#[derive(Clone, Debug)]
pub struct Trial {
    kind: NodeKind,
    /// Its outputs in order.
    pub values: Vec<Value>,
    /// What it said beside its values.
    pub report: Report,
    /// The fractions it told, in order.
    pub progress: Vec<f64>,
    /// Time it took.
    pub duration: Duration,
    /// The longest time from its beginning, over its calls for progress, to its end in which it did not ask whether to
    /// go on: how long it may take to stop.
    pub longest_silence: Duration,
}

impl Trial {
    /// One output, as `T`.
    pub fn value<T: Wire>(&self, output: &str) -> Option<&T> {
        let (place, _) = self.kind.find_output(output)?;
        self.values.get(place)?.get()
    }
}

/// Why a node gave no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TrialError {
    /// An input is wrong, or the node failed.
    #[error("{0}")]
    Failed(Failure),
    /// It was told to stop, after telling these fractions.
    #[error("it was stopped after {} progress reports", .0.len())]
    Cancelled(Vec<f64>),
}

impl TrialError {
    /// Whether it was told to stop.
    pub fn is_cancelled(&self) -> bool {
        matches!(self, Self::Cancelled(_))
    }
}

impl<'a> Harness<'a> {
    /// A node of this kind, its inputs at their defaults.
    pub fn new(kind: &'a NodeKind) -> Self {
        Self {
            kind,
            inputs: kind.inputs().iter().map(|spec| spec.default_value.clone()).collect(),
            files: BTreeMap::new(),
            go_on: Box::new(|_| true),
            examine: false,
            wrong: None,
        }
    }

    fn refuse(&mut self, input: &str, message: String) {
        self.wrong.get_or_insert(Failure { port: Some(input.to_owned()), message });
    }

    /// Puts a literal at an input, as a graph file does. What does not fit is an error of [`run`](Self::run).
    #[must_use]
    pub fn set(mut self, input: &str, literal: Literal) -> Self {
        match self.kind.find_input(input).map(|spec| spec.refuses(&literal)) {
            Some(Some(reason)) => self.refuse(input, reason),
            Some(None) => {
                let number =
                    matches!(self.kind.find_input(input), Some(spec) if spec.wire == crate::WireType::of::<f64>());
                #[expect(clippy::cast_precision_loss, reason = "what would lose something is refused above")]
                let value = match literal {
                    Literal::Integer(integer) if number => Value::new(integer as f64),
                    other => other.to_value(),
                };
                return self.give_value(input, value);
            }
            None => return self.give_value(input, literal.to_value()),
        }
        self
    }

    /// Puts a value at an input, as a link does.
    #[must_use]
    pub fn give<T: Wire>(self, input: &str, value: T) -> Self {
        self.give_value(input, Value::new(value))
    }

    /// Puts a value of any type at an input.
    #[must_use]
    pub fn give_value(mut self, input: &str, value: Value) -> Self {
        let Some(index) = self.kind.inputs().iter().position(|spec| spec.name == input) else {
            let known: Vec<_> = self.kind.inputs().iter().map(|spec| spec.name.as_str()).collect();
            let message = format!("\"{}\" has no such input; it has {}", self.kind.name(), known.join(", "));
            self.refuse(input, message);
            return self;
        };
        let spec = &self.kind.inputs()[index];
        if spec.wire != value.wire() {
            let message = format!("it takes {}, and {} is given", spec.wire, value.wire());
            self.refuse(input, message);
        } else if let Some(reason) = spec.refuses_value(&value) {
            self.refuse(input, reason);
        } else {
            self.inputs[index] = Some(value);
        }
        self
    }

    /// Names a file at an input and gives its content, in place of the disk.
    #[must_use]
    pub fn file(mut self, input: &str, path: &str, content: impl Into<Arc<[u8]>>) -> Self {
        self.files.insert(input.to_owned(), content.into());
        self.give(input, FilePath(path.to_owned()))
    }

    /// Stops the node where this answers its progress with `false`.
    #[must_use]
    pub fn while_progress(mut self, go_on: impl Fn(f64) -> bool + Sync + 'a) -> Self {
        self.go_on = Box::new(go_on);
        self
    }

    /// Measures as well what the kind measures on request only ([`NodeKind::examine`]); its report comes behind the
    /// node's own.
    #[must_use]
    pub fn examine(mut self) -> Self {
        self.examine = true;
        self
    }

    /// Runs the node.
    ///
    /// # Errors
    /// [`TrialError`]: an input that is missing or does not fit, the failure of the node with the input at fault, or
    /// that it was stopped. A panic in the node is a failure, as in a graph.
    pub fn run(self) -> Result<Trial, TrialError> {
        let Self { kind, inputs, files, go_on, examine, wrong } = self;
        if let Some(wrong) = wrong {
            return Err(TrialError::Failed(wrong));
        }
        let fail = |index: usize, message: String| TrialError::Failed(failure(kind, Some(index), message));
        for (index, (spec, value)) in kind.inputs().iter().zip(&inputs).enumerate() {
            if value.is_none() && !spec.optional {
                return Err(fail(index, format!("nothing is given: give a {}", spec.wire)));
            }
        }
        let mut contents = Vec::new();
        for index in kind.file_inputs() {
            let content = kind.inputs().get(*index).and_then(|spec| files.get(&spec.name));
            contents.push((*index, content.ok_or_else(|| fail(*index, NO_FILE_NAMED.to_owned()))?.clone()));
        }
        let begun = Instant::now();
        let told = Mutex::new(Silence { progress: Vec::new(), last: begun, longest: Duration::ZERO });
        let stopped = AtomicBool::new(false);
        let listen = |fraction: f64| {
            told.lock().unwrap_or_else(PoisonError::into_inner).end(Some(fraction));
            let stop = !go_on(fraction);
            stopped.fetch_or(stop, Ordering::Relaxed);
            !stop
        };
        let result = call::call(kind, &inputs, &contents, Path::new(""), &listen).and_then(|(values, report)| {
            let found = if examine { call::examine(kind, &values, &listen)? } else { Report::default() };
            Ok((values, report.followed_by(&found)))
        });
        let duration = begun.elapsed();
        let mut told = told.into_inner().unwrap_or_else(PoisonError::into_inner);
        told.end(None);
        if stopped.into_inner() {
            return Err(TrialError::Cancelled(told.progress));
        }
        match result {
            Ok((values, report)) => {
                let Silence { progress, longest, .. } = told;
                Ok(Trial { kind: kind.clone(), values, report, progress, duration, longest_silence: longest })
            }
            Err(NodeError::Cancelled) => Err(TrialError::Cancelled(told.progress)),
            Err(NodeError::Failed { input, message }) => Err(TrialError::Failed(failure(kind, input, message))),
        }
    }
}

/// How long a node says nothing.
struct Silence {
    progress: Vec<f64>,
    last: Instant,
    longest: Duration,
}

impl Silence {
    fn end(&mut self, fraction: Option<f64>) {
        self.longest = self.longest.max(self.last.elapsed());
        self.last = Instant::now();
        self.progress.extend(fraction);
    }
}
