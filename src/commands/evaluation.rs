//! Opens a graph and evaluates its results: what `run` and `render` share.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use maquette_graph::file::Severity;
use maquette_graph::{
    CancelToken, Catalogue, Evaluation, Evaluator, EvaluatorOptions, NodeId, OutcomeState, Request, WireType,
};

use super::console;
use super::graph_file::GraphFile;
use super::progress_bar::Progress;
use super::project::ProjectArguments;

/// What is evaluated, and how.
#[derive(clap::Args)]
pub struct EvaluationArguments {
    /// The graph, a .ron file.
    pub(super) graph: PathBuf,
    /// Evaluate only this result (the name of a mesh-out or curves-out node); may be given several times.
    #[arg(long = "output", value_name = "NAME")]
    pub(super) outputs: Vec<String>,
    /// Put a value at an input, such as --set legs.count=32, or at a parameter of the graph, such as --set
    /// stiffness=0.8, for this evaluation; may be given several times. maquette check --parameters lists parameters.
    #[arg(long = "set", value_name = "ADDRESS=VALUE")]
    pub(super) set: Vec<String>,
    #[command(flatten)]
    pub(super) project: ProjectArguments,
    /// Threads, at most 256; 0 takes one per core. The number changes no result.
    #[arg(long, default_value_t = 0, value_name = "N", value_parser = clap::value_parser!(u16).range(0..=256))]
    pub(super) threads: u16,
    /// Write what succeeded although a node failed. The exit code is 1 all the same.
    #[arg(long)]
    pub(super) keep_going: bool,
    /// Say nothing but errors.
    #[arg(long, short)]
    pub(super) quiet: bool,
}

/// A graph and what its evaluation gave.
pub(super) struct Evaluated {
    pub(super) file: GraphFile,
    pub(super) targets: Vec<NodeId>,
    pub(super) evaluation: Evaluation,
    /// One message per node that failed.
    pub(super) failures: Vec<String>,
    /// What deserves a look, in the file or in a node's result.
    pub(super) warnings: Vec<String>,
    /// Those of them that are about the file.
    pub(super) file_warnings: Vec<String>,
}

/// A graph that is ready to be evaluated.
pub(super) struct Opened {
    pub(super) file: GraphFile,
    /// Its results that were asked for.
    pub(super) targets: Vec<NodeId>,
    /// What deserves a look in the file.
    pub(super) warnings: Vec<String>,
    /// Whether to measure as well what is measured on request only.
    pub(super) examine: bool,
}

/// Of which nodes the values are kept for a closer look.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Keep {
    Results,
    Everything,
}

/// An evaluator with the threads asked for.
pub(super) fn evaluator(arguments: &EvaluationArguments) -> Evaluator {
    Evaluator::new(&EvaluatorOptions { threads: usize::from(arguments.threads), ..Default::default() })
}

/// Reads the graph and puts the values given by `--set`; what is wrong with graph or arguments is an error.
///
/// `suits` is asked whether the types of the results serve the purpose.
pub(super) fn open(
    catalogue: &Catalogue,
    arguments: &EvaluationArguments,
    suits: impl Fn(&[WireType]) -> Result<(), Vec<String>>,
) -> Result<Opened, Vec<String>> {
    let (mut file, warnings) = GraphFile::open_sound(catalogue, &arguments.graph, &arguments.project)?;
    let wrong: Vec<String> = arguments.set.iter().filter_map(|set| file.apply(set).err()).collect();
    if !wrong.is_empty() {
        let path = file.path.display();
        return Err(wrong.into_iter().map(|message| format!("{path}: error: {message}")).collect());
    }
    let targets = targets(&file, &arguments.outputs)?;
    let missing = file.missing_links(&targets);
    if !missing.is_empty() {
        return Err(missing);
    }
    let outputs = |id: &NodeId| file.loaded.graph.node(*id).and_then(|n| n.kind().cloned());
    let types: Vec<WireType> = targets
        .iter()
        .filter_map(outputs)
        .flat_map(|k| k.outputs().iter().map(|o| o.wire).collect::<Vec<_>>())
        .collect();
    suits(&types)?;
    Ok(Opened { file, targets, warnings, examine: false })
}

/// Evaluates; what fails in a node is in [`Evaluated::failures`], what is wrong with graph or arguments is an error.
///
/// `suits` is asked before anything runs whether the types of the results serve the purpose.
pub(super) fn evaluate(
    catalogue: &Catalogue,
    arguments: &EvaluationArguments,
    suits: impl Fn(&[WireType]) -> Result<(), Vec<String>>,
) -> Result<Evaluated, Vec<String>> {
    let opened = open(catalogue, arguments, suits)?;
    let mut evaluator = evaluator(arguments);
    Ok(opened.evaluate(catalogue, &mut evaluator, arguments.quiet, Keep::Results, &CancelToken::new()))
}

impl Opened {
    /// Evaluates with what the evaluator remembers from earlier times.
    pub(super) fn evaluate(
        self,
        catalogue: &Catalogue,
        evaluator: &mut Evaluator,
        quiet: bool,
        keep: Keep,
        cancel: &CancelToken,
    ) -> Evaluated {
        let Self { file, targets, mut warnings, examine } = self;
        let file_warnings = warnings.clone();
        let graph = &file.loaded.graph;
        let progress = Progress::new(!quiet);
        let asked = if keep == Keep::Everything { graph.upstream(&targets) } else { targets.clone() };
        let request = Request::nodes(&asked).events(&progress).base(file.base()).project(&file.project).cancel(cancel);
        let request = if examine { request.examine() } else { request };
        let evaluation = evaluator.evaluate(catalogue, graph, &request);
        progress.finish();
        let (failures, of_nodes) = messages(&file, &targets, &evaluation);
        warnings.extend(of_nodes);
        if !quiet {
            warnings.iter().for_each(console::remark);
        }
        Evaluated { file, targets, evaluation, failures, warnings, file_warnings }
    }
}

/// What an evaluation failed at, and what deserves a look in its results: one message each.
pub(super) fn messages(file: &GraphFile, targets: &[NodeId], evaluation: &Evaluation) -> (Vec<String>, Vec<String>) {
    let (mut failures, mut warnings) = (Vec::new(), Vec::new());
    for (id, outcome) in evaluation.outcomes() {
        match &outcome.state {
            OutcomeState::Failed(failure) => {
                failures.push(file.about(Severity::Error, id, failure.port.as_deref(), &failure.message));
            }
            OutcomeState::Waiting(on) if targets.contains(&id) => {
                failures.push(file.about(
                    Severity::Error,
                    id,
                    None,
                    &format!("not made, because \"{}\" failed", on.join("\", \"")),
                ));
            }
            OutcomeState::Done { report, .. } => {
                warnings.extend(report.warnings.iter().map(|w| file.about(Severity::Warning, id, None, w)));
            }
            _ => {}
        }
    }
    (failures, warnings)
}

fn targets(file: &GraphFile, wanted: &[String]) -> Result<Vec<NodeId>, Vec<String>> {
    let graph = &file.loaded.graph;
    let results = graph.results();
    let path = file.path.display();
    if results.is_empty() {
        return Err(vec![format!("{path}: error: the graph has no result: add a mesh-out or curves-out node")]);
    }
    if wanted.is_empty() {
        return Ok(results);
    }
    let name = |id: &NodeId| graph.node(*id).map_or("", |n| n.name());
    let find = |wanted: &String| {
        results.iter().copied().find(|id| name(id) == wanted).ok_or_else(|| {
            let known: Vec<_> = results.iter().map(name).collect();
            let file = super::write::format(Path::new(wanted)).is_ok();
            let hint = if file { format!("; to write a file say -o {wanted}") } else { String::new() };
            format!("{path}: error: --output {wanted}: no result has that name; there is {}{hint}", known.join(", "))
        })
    };
    let (found, unknown): (Vec<_>, Vec<_>) = wanted.iter().map(find).partition(Result::is_ok);
    let unknown: Vec<_> = unknown.into_iter().filter_map(Result::err).collect();
    if !unknown.is_empty() {
        return Err(unknown);
    }
    // Each result once, in the order of the graph, however often and in whatever order it was asked for.
    let found: BTreeSet<NodeId> = found.into_iter().flatten().collect();
    Ok(found.into_iter().collect())
}
