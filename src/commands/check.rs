//! `maquette check`: everything that is wrong with graphs, in one go.

use std::path::{Path, PathBuf};

use maquette_graph::file::Severity;
use maquette_graph::{Catalogue, Evaluator, OutcomeState, Request};

use super::graph_file::GraphFile;
use super::{Ended, console};

/// Load graphs and say everything that is wrong with them, each with place and remedy.
#[derive(clap::Args)]
pub struct Arguments {
    /// Evaluate every node as well, and say which ones fail; without it nothing is evaluated.
    #[arg(long)]
    evaluate: bool,
    /// The graphs, .ron files.
    #[arg(required = true)]
    graphs: Vec<PathBuf>,
}

/// Carries out the command.
pub fn check(arguments: &Arguments) -> Ended {
    let catalogue = match maquette_nodes::catalogue() {
        Ok(catalogue) => catalogue,
        Err(error) => {
            console::error(error.to_string());
            return Ended::Wrong;
        }
    };
    let mut ended = Ended::Done;
    for path in &arguments.graphs {
        if !check_one(&catalogue, path, arguments.evaluate) {
            ended = Ended::Wrong;
        }
    }
    ended
}

/// Whether the graph is sound.
fn check_one(catalogue: &Catalogue, path: &Path, evaluate: bool) -> bool {
    let file = match GraphFile::open(catalogue, path) {
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
        }
    }
    let all: Vec<_> = graph.nodes().map(|(id, _)| id).collect();
    let said: Vec<String> = file.missing_links(&all).into_iter().chain(file.missing_content()).collect();
    said.iter().for_each(console::remark);
    errors += said.len();
    if evaluate {
        let request = Request::nodes(&all).base(file.base()).examine();
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
    let used = graph.upstream(&results);
    if results.is_empty() {
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
