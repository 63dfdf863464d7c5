//! `maquette check`: everything that is wrong with graphs, in one go.

use std::path::{Path, PathBuf};

use maquette_graph::file::Severity;
use maquette_graph::{Catalogue, Evaluator, OutcomeState, Parameter, Request, Unit};

use super::diff::spelled_literal;
use super::graph_file::{GraphFile, each};
use super::project::ProjectArguments;
use super::{Ended, console};

/// Load graphs and say everything that is wrong with them, each with place and remedy.
#[derive(clap::Args)]
pub struct Arguments {
    /// Evaluate every node as well, and say which ones fail; without it nothing is evaluated.
    #[arg(long)]
    evaluate: bool,
    #[command(flatten)]
    project: ProjectArguments,
    /// List the parameters of each graph: what they hold, their ranges, what they are for.
    #[arg(long)]
    parameters: bool,
    /// The graphs, .ron files.
    #[arg(required = true)]
    graphs: Vec<PathBuf>,
}

/// Carries out the command.
pub fn check(arguments: &Arguments) -> Ended {
    each(
        &arguments.graphs,
        |catalogue, path| {
            if check_one(catalogue, path, arguments) { Ended::Done } else { Ended::Wrong }
        },
    )
}

/// Whether the graph is sound.
fn check_one(catalogue: &Catalogue, path: &Path, arguments: &Arguments) -> bool {
    let file = match GraphFile::open(catalogue, path, &arguments.project) {
        Ok(file) => file,
        Err(messages) => {
            messages.iter().for_each(console::remark);
            return false;
        }
    };
    let graph = &file.loaded.graph;
    let mut errors = 0;
    let mut warnings = 0;
    for problem in &file.loaded.problems {
        console::remark(file.located(problem));
        match problem.severity {
            Severity::Error => errors += 1,
            Severity::Warning => warnings += 1,
            Severity::Note => {}
        }
    }
    let all: Vec<_> = graph.nodes().map(|(id, _)| id).collect();
    // A graph with outputs is a part of others, which give it what it takes.
    let is_part = graph.outputs().len() > 0;
    let missing = if is_part { file.missing_links_within(&all) } else { file.missing_links(&all) };
    let said: Vec<String> = missing.into_iter().chain(file.missing_content()).collect();
    said.iter().for_each(console::remark);
    errors += said.len();
    if arguments.evaluate {
        let request = Request::nodes(&file.given(&all)).base(file.base()).project(&file.project).examine();
        let evaluation = Evaluator::default().evaluate(catalogue, graph, &request);
        for (id, outcome) in evaluation.outcomes() {
            match &outcome.state {
                OutcomeState::Failed(failure) => {
                    let message = file.about(Severity::Error, id, failure.port.as_deref(), &failure.message);
                    // What was found without evaluating is said already, in other words.
                    if !said.iter().any(|s| s.split(": ").take(2).eq(message.split(": ").take(2))) {
                        console::remark(message);
                        errors += 1;
                    }
                }
                OutcomeState::Done { report, .. } => {
                    for warning in &report.warnings {
                        console::remark(file.about(Severity::Warning, id, None, warning));
                        warnings += 1;
                    }
                }
                OutcomeState::Waiting(_) | OutcomeState::Cancelled => {}
            }
        }
    }
    let results = graph.results();
    let promoted = graph.outputs().filter_map(|output| Some(output.link()?.node));
    let used = graph.upstream(&results.iter().copied().chain(promoted).collect::<Vec<_>>());
    if results.is_empty() && !is_part {
        let path = path.display();
        console::remark(format!("{path}: warning: the graph has no result: add a mesh-out or curves-out node"));
        warnings += 1;
    } else if errors == 0 {
        // A link that could not be read makes healthy nodes look useless.
        for id in all.iter().filter(|id| !used.contains(id)) {
            console::remark(file.about(
                Severity::Warning,
                *id,
                None,
                "no result depends on it; link it to one, or remove it",
            ));
            warnings += 1;
        }
    }
    if arguments.parameters {
        graph.parameters().for_each(|parameter| console::say(parameter_line(parameter)));
    }
    let verdict = if errors == 0 { "sound" } else { "not sound" };
    let count = |number: usize, what: &str| format!("{number} {what}{}", if number == 1 { "" } else { "s" });
    console::say(format!(
        "{}: {verdict}; {}, {}, {}, {}",
        path.display(),
        count(all.len(), "node"),
        count(results.len(), "result"),
        count(errors, "error"),
        count(warnings, "warning")
    ));
    errors == 0
}

/// A parameter on one line.
fn parameter_line(parameter: &Parameter) -> String {
    let spec = parameter.spec();
    let unit = if spec.unit == Unit::None { String::new() } else { format!(" {}", spec.unit) };
    let value = match parameter.value() {
        Some(value) => format!(" = {}{unit}", spelled_literal(value)),
        None if spec.optional => ", optional".to_owned(),
        None => ", given from outside".to_owned(),
    };
    let range = spec.range.map(|range| format!(", {range}{unit}")).unwrap_or_default();
    let soft = spec.soft_range.map(|range| format!(" (usually {range})")).unwrap_or_default();
    let options: Vec<_> = spec.options.iter().map(|option| option.name.as_str()).collect();
    let options = if options.is_empty() { String::new() } else { format!(", one of {}", options.join(", ")) };
    let text = if spec.description.is_empty() { String::new() } else { format!(": {}", spec.description) };
    format!("  {}{value} ({}{range}{soft}{options}){text}", parameter.name(), parameter.wire())
}
