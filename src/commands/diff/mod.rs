//! `maquette diff`: what differs between two graphs, and how far their results are apart.

mod differences;
mod geometry;
mod input;
mod interface;
mod pairing;
mod strokes;
mod text;

use std::path::{Path, PathBuf};

use maquette_graph::file::{Project, Severity};
use maquette_graph::{Catalogue, Evaluation, Evaluator, NodeId, OutcomeState, Request};
use serde_json::json;

use self::differences::{Difference, differences};
use self::geometry::OutputDifference;
pub(super) use self::input::spelled_literal;
use self::pairing::{Pairing, pair};
use super::graph_file::GraphFile;
use super::project::ProjectArguments;
use super::{Ended, console};

/// Say what differs between two graphs: nodes added, removed and renamed, links, values and strokes. The order within
/// the files, comments, and values written out that are the default make no difference.
///
/// Exit codes: 0 equal, 1 different, 2 a graph or the arguments are wrong.
#[derive(clap::Args)]
pub struct Arguments {
    /// The two graphs, .ron files.
    #[arg(required = true, num_args = 2, value_names = ["A", "B"], conflicts_with = "git")]
    graphs: Vec<PathBuf>,
    /// Evaluate both graphs and say how far their results are apart: largest and mean distance of the vertices (or the
    /// points of curves) of A from B's result, and back.
    #[arg(long)]
    geometry: bool,
    /// Compare where the editor draws the nodes too.
    #[arg(long)]
    layout: bool,
    /// Say it as JSON on stdout.
    #[arg(long)]
    json: bool,
    /// Relative paths within both graphs start at this folder, not at their own; for a copy that lies elsewhere.
    #[arg(long, value_name = "FOLDER")]
    base: Option<PathBuf>,
    #[command(flatten)]
    project: ProjectArguments,
    /// For git's diff.NAME.command: the arguments that git gives, PATH OLD-FILE OLD-HEX OLD-MODE NEW-FILE NEW-HEX
    /// NEW-MODE. Always exits with 0, because git takes all else for a breakdown.
    #[arg(long, num_args = 1..=9, value_name = "ARGUMENTS", allow_hyphen_values = true)]
    git: Option<Vec<String>>,
}

/// Carries out the command.
pub fn diff(arguments: &Arguments) -> Ended {
    let catalogue = match maquette_nodes::catalogue() {
        Ok(catalogue) => catalogue,
        Err(error) => {
            console::error(error.to_string());
            return Ended::Wrong;
        }
    };
    if let Some(given) = &arguments.git {
        return for_git(&catalogue, arguments, given);
    }
    let [first, second] = arguments.graphs.as_slice() else {
        console::error("two graphs are compared: maquette diff A.ron B.ron");
        return Ended::Wrong;
    };
    match compare(&catalogue, arguments, first, second, arguments.base.as_deref()) {
        Ok(comparison) => {
            let names = [first, second].map(|path| path.display().to_string());
            comparison.say(arguments, &names);
            if comparison.is_equal() { Ended::Done } else { Ended::Failed }
        }
        Err(messages) => {
            if arguments.json {
                console::say(json!({ "equal": null, "errors": messages }).to_string());
            }
            messages.iter().for_each(console::remark);
            Ended::Wrong
        }
    }
}

/// Compares what git gives: the file's path in the repository, and the two states in temporary files.
fn for_git(catalogue: &Catalogue, arguments: &Arguments, given: &[String]) -> Ended {
    let path = given.first().map_or("", String::as_str);
    let (Some(old), Some(new)) = (given.get(1), given.get(4)) else {
        console::say(format!("{path}: not merged yet"));
        return Ended::Done;
    };
    // Behind the new mode there may be the new path of a file that was moved, and more.
    let new_path = given.get(7).map_or(path, String::as_str);
    let base = arguments.base.clone().or_else(|| Path::new(new_path).parent().map(Path::to_owned));
    let names = [path, new_path].map(str::to_owned);
    match compare(catalogue, arguments, Path::new(old), Path::new(new), base.as_deref()) {
        Ok(comparison) => comparison.say(arguments, &names),
        Err(messages) => {
            messages.iter().for_each(|message| console::say(format!("{path}: not to be compared: {message}")))
        }
    }
    Ended::Done
}

/// What was found.
struct Comparison {
    differences: Vec<Difference>,
    outputs: Vec<OutputDifference>,
}

impl Comparison {
    fn is_equal(&self) -> bool {
        self.differences.is_empty() && self.outputs.iter().all(|output| output.identical)
    }

    fn say(&self, arguments: &Arguments, [first, second]: &[String; 2]) {
        if arguments.json {
            let mut said = json!({
                "from": first,
                "to": second,
                "equal": self.is_equal(),
                "differences": self.differences,
            });
            if let (true, Some(said)) = (arguments.geometry, said.as_object_mut()) {
                said.insert("outputs".to_owned(), json!(self.outputs));
            }
            console::say(said.to_string());
            return;
        }
        if !self.is_equal() {
            console::say(format!("--- {first}\n+++ {second}"));
        }
        self.differences.iter().flat_map(text::lines).for_each(console::say);
        self.outputs.iter().map(text::output_line).for_each(console::say);
    }
}

fn compare(
    catalogue: &Catalogue,
    arguments: &Arguments,
    first: &Path,
    second: &Path,
    base: Option<&Path>,
) -> Result<Comparison, Vec<String>> {
    // Reading is most of the work where graphs are large.
    let read = |path: &Path| open(catalogue, path, base, &arguments.project);
    let (a, b) = match rayon::join(|| read(first), || read(second)) {
        (Ok(a), Ok(b)) => (a, b),
        (a, b) => return Err([a.err(), b.err()].into_iter().flatten().flatten().collect()),
    };
    let pairing = pair(&a.loaded.graph, &b.loaded.graph);
    let differences = differences(&a.loaded.graph, &b.loaded.graph, &pairing, arguments.layout);
    let outputs = if arguments.geometry { compare_results(catalogue, [&a, &b], &pairing)? } else { Vec::new() };
    Ok(Comparison { differences, outputs })
}

/// Reads a graph. What does not exist yet or any more, which git spells /dev/null, is an empty one.
fn open(
    catalogue: &Catalogue,
    path: &Path,
    base: Option<&Path>,
    project: &ProjectArguments,
) -> Result<GraphFile, Vec<String>> {
    if path == Path::new("/dev/null") || path == Path::new("nul") {
        return GraphFile::from_bytes(catalogue, path, b"(version: 1, nodes: {})".to_vec(), base, Project::default());
    }
    GraphFile::open_in(catalogue, path, base, project)
}

fn compare_results(
    catalogue: &Catalogue,
    [a, b]: [&GraphFile; 2],
    pairing: &Pairing,
) -> Result<Vec<OutputDifference>, Vec<String>> {
    // What both graphs have in common is computed once.
    let mut evaluator = Evaluator::default();
    let from = evaluate(catalogue, &mut evaluator, a)?;
    let to = evaluate(catalogue, &mut evaluator, b)?;
    let name = |file: &GraphFile, id: NodeId| file.loaded.graph.node(id).map_or("", |n| n.name()).to_owned();
    let value = |evaluation: &Evaluation, id: NodeId| evaluation.values(id).and_then(|v| v.first().cloned());
    let [first, second] = [a, b].map(|file| file.loaded.graph.results());
    let mut found = Vec::new();
    for id in &first {
        match pairing.second_of.get(id).filter(|other| second.contains(other)) {
            Some(other) => {
                found.push(geometry::compare(
                    &name(b, *other),
                    value(&from, *id).as_ref(),
                    value(&to, *other).as_ref(),
                ));
            }
            None => found.push(geometry::compare(&name(a, *id), value(&from, *id).as_ref(), None)),
        }
    }
    for id in second {
        if !first.iter().any(|other| pairing.second_of.get(other) == Some(&id)) {
            found.push(geometry::compare(&name(b, id), None, value(&to, id).as_ref()));
        }
    }
    Ok(found)
}

/// Evaluates all results; where one can't be made there is nothing to measure, and the reason is the error.
fn evaluate(catalogue: &Catalogue, evaluator: &mut Evaluator, file: &GraphFile) -> Result<Evaluation, Vec<String>> {
    let wrong: Vec<String> = file
        .loaded
        .problems
        .iter()
        .filter(|problem| problem.severity == Severity::Error)
        .map(|problem| file.located(problem))
        .collect();
    let results = file.loaded.graph.results();
    let missing = file.missing_links(&results);
    if !wrong.is_empty() || !missing.is_empty() {
        return Err(wrong.into_iter().chain(missing).collect());
    }
    let request = Request::nodes(&results).base(file.base()).project(&file.project);
    let evaluation = evaluator.evaluate(catalogue, &file.loaded.graph, &request);
    let failures: Vec<String> = evaluation
        .outcomes()
        .filter_map(|(id, outcome)| match &outcome.state {
            OutcomeState::Failed(failure) => {
                Some(file.about(Severity::Error, id, failure.port.as_deref(), &failure.message))
            }
            _ => None,
        })
        .collect();
    if failures.is_empty() { Ok(evaluation) } else { Err(failures) }
}
