//! One node with its inputs and outputs.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use serde::Deserialize;

use super::compare::{Difference, Tolerance, compare};
use super::frozen::{Freezer, Frozen, ThawError};
use super::text;
use crate::catalogue::Catalogue;
use crate::evaluate::{Evaluator, EvaluatorOptions, Failure, OutcomeState, Request};
use crate::file::{Project, number, quoted};
use crate::graph::{Graph, NodeId};
use crate::harness::{Harness, Trial, TrialError};
use crate::node_kind::NodeKind;
use crate::value::{Value, WireType};

/// Version of the golden files that this library writes.
const FORMAT: u32 = 1;

/// What a node made of its inputs: everything needed to run it again and compare.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Golden {
    frozen: u32,
    /// Name of the kind.
    pub kind: String,
    /// Version of the kind.
    pub version: u32,
    /// Where it was taken from, in words; may be empty.
    #[serde(default)]
    pub from: String,
    /// How far outputs may be from those frozen.
    pub tolerance: Tolerance,
    inputs: Vec<(String, Frozen)>,
    /// Content of the files that the node reads, by input.
    #[serde(default)]
    files: Vec<(String, Frozen)>,
    outputs: Vec<(String, Frozen)>,
}

/// Why a node can't be frozen, or a golden file not be run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FreezeError {
    /// The graph has no such node, or its kind is unknown.
    #[error("the node is not in the graph, or its kind is not known: check the graph first")]
    NoNode,
    /// The node or one before it failed.
    #[error("the node has no result: {0}")]
    NoResult(String),
    /// A wire type that golden files can't hold.
    #[error("{port} carries {wire}, which can't be frozen: implement `Freeze` for it and register it with `freezable`")]
    NotFreezable {
        /// The input or output.
        port: String,
        /// Its type.
        wire: WireType,
    },
    /// The kind does nothing without the graph within.
    #[error("a node of kind {0} does nothing by itself: open the graph within, and freeze a node there")]
    HasBody(String),
    /// The node does not do its work.
    #[error("the node is muted: unmute it first")]
    Muted,
    /// The text is no golden file.
    #[error("{line}:{column}: this is no golden file: {message}; freeze the node again")]
    Syntax {
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What is wrong.
        message: String,
    },
    /// Written by a later version.
    #[error("the golden file has version {0}, and this program reads up to {FORMAT}: update it")]
    TooNew(u32),
    /// The kind is not registered.
    #[error("no node kind is named \"{0}\": remove the golden file, or bring the kind back")]
    UnknownKind(String),
    /// The kind has another version.
    #[error(
        "it was frozen at version {frozen} of \"{kind}\", which is at {now}: look at what changed, and freeze it again"
    )]
    OtherVersion {
        /// Name of the kind.
        kind: String,
        /// Version frozen.
        frozen: u32,
        /// Version of the kind now.
        now: u32,
    },
    /// A port that the kind does not have.
    #[error("\"{kind}\" has no {what} \"{port}\": freeze the node again")]
    NoPort {
        /// Name of the kind.
        kind: String,
        /// Input or output.
        what: &'static str,
        /// The name.
        port: String,
    },
    /// Data that makes no value.
    #[error("{port}: {source}: freeze the node again")]
    Thaw {
        /// The input or output.
        port: String,
        /// What is wrong with it.
        source: ThawError,
    },
    /// The node failed on its frozen inputs.
    #[error("the node failed on the inputs on which it was frozen: {0}")]
    Failed(TrialError),
}

/// What a running node took and gave.
#[derive(Default)]
struct Seen {
    inputs: Vec<Option<Value>>,
    files: Vec<(usize, Arc<[u8]>)>,
    outputs: Vec<Option<Value>>,
}

impl Golden {
    /// Evaluates a node of a graph and keeps its inputs, as they arrive after conversion, and its outputs. Relative
    /// paths start at `base`.
    ///
    /// # Errors
    /// [`FreezeError`] where the node has no result or carries a type that can't be frozen.
    pub fn of(
        catalogue: &Catalogue,
        graph: &Graph,
        node: NodeId,
        base: &Path,
        tolerance: Tolerance,
    ) -> Result<Self, FreezeError> {
        Self::of_project(catalogue, graph, node, base, &Project::within(base), tolerance)
    }

    /// As [`Golden::of`], where the graph may read the files of a project.
    ///
    /// # Errors
    /// As [`Golden::of`].
    pub fn of_project(
        catalogue: &Catalogue,
        graph: &Graph,
        node: NodeId,
        base: &Path,
        project: &Project,
        tolerance: Tolerance,
    ) -> Result<Self, FreezeError> {
        let found = graph.node(node).ok_or(FreezeError::NoNode)?;
        let kind = found.kind().cloned().ok_or(FreezeError::NoNode)?;
        if kind.has_body() {
            return Err(FreezeError::HasBody(kind.name().to_owned()));
        }
        if found.is_muted() {
            return Err(FreezeError::Muted);
        }
        let Seen { inputs, files, outputs } = watched(catalogue, graph, &kind, node, base, project)?;
        let frozen = |name: &str, wire: WireType, value: &Value| {
            let port = || format!("\"{name}\"");
            let freezer = catalogue.freezer(wire).ok_or_else(|| FreezeError::NotFreezable { port: port(), wire })?;
            let frozen = (freezer.freeze)(value).ok_or_else(|| FreezeError::NotFreezable { port: port(), wire })?;
            Ok((name.to_owned(), frozen))
        };
        let inputs = kind.inputs().iter().zip(&inputs);
        let outputs = kind.outputs().iter().zip(&outputs);
        Ok(Self {
            frozen: FORMAT,
            kind: kind.name().to_owned(),
            version: kind.version(),
            from: String::new(),
            tolerance,
            inputs: inputs
                .filter_map(|(spec, value)| value.as_ref().map(|v| frozen(&spec.name, spec.wire, v)))
                .collect::<Result<_, FreezeError>>()?,
            files: files.iter().map(|(index, bytes)| (kind.inputs()[*index].name.clone(), content(bytes))).collect(),
            outputs: outputs
                .filter_map(|(spec, value)| value.as_ref().map(|v| frozen(&spec.name, spec.wire, v)))
                .collect::<Result<_, FreezeError>>()?,
        })
    }

    /// Reads a golden file.
    ///
    /// # Errors
    /// [`FreezeError::Syntax`], [`FreezeError::TooNew`].
    pub fn from_text(text: &str) -> Result<Self, FreezeError> {
        let golden: Self = ron::from_str(text).map_err(|error| FreezeError::Syntax {
            line: error.span.start.line,
            column: error.span.start.col,
            message: error.code.to_string(),
        })?;
        if golden.frozen > FORMAT { Err(FreezeError::TooNew(golden.frozen)) } else { Ok(golden) }
    }

    /// The golden file. The same value gives the same text.
    pub fn to_text(&self) -> String {
        let mut text = format!(
            "(\n    frozen: {},\n    kind: {},\n    version: {},\n    from: {},\n",
            self.frozen,
            quoted(&self.kind),
            self.version,
            quoted(&self.from)
        );
        let Tolerance { absolute, relative } = self.tolerance;
        let _ = writeln!(text, "    tolerance: (absolute: {}, relative: {}),", number(absolute), number(relative));
        for (name, ports) in [("inputs", &self.inputs), ("files", &self.files), ("outputs", &self.outputs)] {
            if ports.is_empty() && name == "files" {
                continue;
            }
            let _ = writeln!(text, "    {name}: [");
            for (port, frozen) in ports {
                let _ = write!(text, "        ({}, ", quoted(port));
                text::write(&mut text, frozen, 2);
                text.push_str("),\n");
            }
            text.push_str("    ],\n");
        }
        text.push_str(")\n");
        text
    }

    /// Runs the node alone on its frozen inputs.
    ///
    /// # Errors
    /// [`FreezeError`] where the kind or a port is gone, or the node fails.
    pub fn run(&self, catalogue: &Catalogue) -> Result<Trial, FreezeError> {
        let kind = catalogue.kind(&self.kind).ok_or_else(|| FreezeError::UnknownKind(self.kind.clone()))?;
        let mut harness = Harness::new(kind);
        for (name, frozen) in &self.inputs {
            let spec = kind.find_input(name).ok_or_else(|| self.no_port("input", name))?;
            harness = harness.give_value(name, thawed(catalogue, name, spec.wire, frozen)?);
        }
        for (name, frozen) in &self.files {
            let path = match self.inputs.iter().find(|(input, _)| input == name) {
                Some((_, Frozen::Text(path))) => path.as_str(),
                _ => return Err(self.no_port("input", name)),
            };
            harness = harness.file(name, path, bytes(name, frozen)?);
        }
        harness.run().map_err(FreezeError::Failed)
    }

    /// Runs the node and says where its outputs are not what they were, one entry for each list of numbers or points:
    /// the farthest. Empty where all is well.
    ///
    /// # Errors
    /// [`FreezeError`] where the node can't be run or its kind has another version.
    pub fn differences(&self, catalogue: &Catalogue) -> Result<Vec<Difference>, FreezeError> {
        let kind = catalogue.kind(&self.kind).ok_or_else(|| FreezeError::UnknownKind(self.kind.clone()))?;
        if kind.version() != self.version {
            let (frozen, now) = (self.version, kind.version());
            return Err(FreezeError::OtherVersion { kind: self.kind.clone(), frozen, now });
        }
        let trial = self.run(catalogue)?;
        let mut found = Vec::new();
        for (name, was) in &self.outputs {
            let (place, spec) = kind.find_output(name).ok_or_else(|| self.no_port("output", name))?;
            let freezer = freezer(catalogue, name, spec.wire)?;
            let is = trial.values.get(place).and_then(freezer.freeze).ok_or_else(|| self.no_port("output", name))?;
            compare(name, was, &is, self.tolerance, &mut found);
        }
        for spec in kind.outputs().iter().filter(|spec| self.outputs.iter().all(|(name, _)| *name != spec.name)) {
            found.push(Difference { place: spec.name.clone(), what: "this output was not there".to_owned() });
        }
        Ok(found)
    }

    /// The same inputs with what the node makes of them today.
    ///
    /// # Errors
    /// [`FreezeError`] where the node can't be run.
    pub fn updated(&self, catalogue: &Catalogue) -> Result<Self, FreezeError> {
        let kind = catalogue.kind(&self.kind).ok_or_else(|| FreezeError::UnknownKind(self.kind.clone()))?;
        let trial = self.run(catalogue)?;
        let output = |(spec, value): (&crate::OutputSpec, &Value)| {
            let frozen = (freezer(catalogue, &spec.name, spec.wire)?.freeze)(value);
            Ok((spec.name.clone(), frozen.ok_or_else(|| self.no_port("output", &spec.name))?))
        };
        let outputs = kind.outputs().iter().zip(&trial.values).map(output).collect::<Result<_, FreezeError>>()?;
        Ok(Self { outputs, version: kind.version(), frozen: FORMAT, ..self.clone() })
    }

    fn no_port(&self, what: &'static str, port: &str) -> FreezeError {
        FreezeError::NoPort { kind: self.kind.clone(), what, port: port.to_owned() }
    }
}

/// Evaluates the node in its graph, and looks on while it runs: what arrives is what the engine makes of links,
/// literals and conversions.
fn watched(
    catalogue: &Catalogue,
    graph: &Graph,
    kind: &NodeKind,
    node: NodeId,
    base: &Path,
    project: &Project,
) -> Result<Seen, FreezeError> {
    let seen = Arc::new(Mutex::new(Seen::default()));
    let sink = seen.clone();
    let watching = kind.doing(move |kind, ports| {
        if let Some(run) = kind.evaluate_fn() {
            run(ports)?;
        }
        let mut seen = sink.lock().unwrap_or_else(PoisonError::into_inner);
        *seen =
            Seen { inputs: ports.inputs().to_vec(), files: ports.files().to_vec(), outputs: ports.outputs().to_vec() };
        Ok(())
    });
    let mut graph = graph.clone();
    if let Some(node) = graph.nodes.get_mut(&node) {
        node.kind = Some(Arc::new(watching));
    }
    let mut evaluator = Evaluator::new(&EvaluatorOptions { threads: 1, ..Default::default() });
    let evaluation = evaluator.evaluate(catalogue, &graph, &Request::nodes(&[node]).base(base).project(project));
    match evaluation.outcome(node).map(|outcome| &outcome.state) {
        Some(OutcomeState::Done { .. }) => {
            Ok(std::mem::take(&mut *seen.lock().unwrap_or_else(PoisonError::into_inner)))
        }
        Some(OutcomeState::Failed(failure)) => Err(FreezeError::NoResult(failure.to_string())),
        _ => {
            let failed =
                |(outcome, failure): (&crate::Outcome, &Failure)| format!("node {:?}: {failure}", outcome.name);
            let why: Vec<String> = evaluation.failures().map(failed).collect();
            Err(FreezeError::NoResult(why.join("; ")))
        }
    }
}

fn freezer(catalogue: &Catalogue, port: &str, wire: WireType) -> Result<Freezer, FreezeError> {
    catalogue.freezer(wire).ok_or_else(|| FreezeError::NotFreezable { port: format!("\"{port}\""), wire })
}

fn thawed(catalogue: &Catalogue, port: &str, wire: WireType, frozen: &Frozen) -> Result<Value, FreezeError> {
    (freezer(catalogue, port, wire)?.thaw)(frozen)
        .map_err(|source| FreezeError::Thaw { port: format!("\"{port}\""), source })
}

/// The content of a file: text where it is, so that it can be read and compared.
fn content(bytes: &[u8]) -> Frozen {
    match std::str::from_utf8(bytes) {
        Ok(text) => Frozen::text(text),
        Err(_) => Frozen::Bytes(BASE64.encode(bytes)),
    }
}

fn bytes(port: &str, frozen: &Frozen) -> Result<Vec<u8>, FreezeError> {
    let source = match frozen {
        Frozen::Text(text) => return Ok(text.as_bytes().to_vec()),
        Frozen::Bytes(text) => match BASE64.decode(text) {
            Ok(bytes) => return Ok(bytes),
            Err(error) => ThawError(format!("the content of the file is no base64: {error}")),
        },
        other => ThawError(format!("it holds {} in place of the content of a file", other.noun())),
    };
    Err(FreezeError::Thaw { port: format!("\"{port}\""), source })
}
