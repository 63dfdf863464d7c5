//! `maquette verify`: whether results are the same as elsewhere, and the memo is to be trusted.

use std::collections::BTreeMap;
use std::path::PathBuf;

use maquette_graph::file::Severity;
use maquette_graph::{CancelToken, Catalogue};

use super::evaluation::{Evaluated, EvaluationArguments, Keep, evaluator, open};
use super::evaluation_order::evaluation_order;
use super::hashes::{Hashes, NodeHashes};
use super::{Ended, consistency, console};

/// Evaluate a graph and compare every node's result, to the last bit, with hashes from another run, machine or number of
/// threads (maquette run GRAPH --hashes FILE); exits with 1 where they differ and names the first such node.
#[derive(clap::Args)]
#[command(group(clap::ArgGroup::new("what").required(true).multiple(true).args(["against", "consistency"])))]
pub struct Arguments {
    #[command(flatten)]
    evaluation: EvaluationArguments,
    /// The hashes to compare with.
    #[arg(long, value_name = "FILE")]
    against: Option<PathBuf>,
    /// Change each value and put it back, and compare what the memo answers with what a fresh evaluation gives.
    #[arg(long)]
    consistency: bool,
}

/// Carries out the command.
pub fn verify(arguments: &Arguments) -> Ended {
    match attempt(arguments) {
        Ok(ended) => ended,
        Err(messages) => {
            messages.iter().for_each(console::remark);
            Ended::Wrong
        }
    }
}

fn attempt(arguments: &Arguments) -> Result<Ended, Vec<String>> {
    let catalogue = maquette_nodes::catalogue().map_err(|error| vec![format!("error: {error}")])?;
    let there = arguments.against.as_deref().map(Hashes::read).transpose().map_err(|error| vec![error])?;
    let opened = open(&catalogue, &arguments.evaluation, |_| Ok(()))?;
    let mut evaluator = evaluator(&arguments.evaluation);
    let quiet = arguments.evaluation.quiet;
    let evaluated = opened.evaluate(&catalogue, &mut evaluator, quiet, Keep::Everything, &CancelToken::new());
    evaluated.failures.iter().for_each(console::remark);
    let mut ended = if evaluated.failures.is_empty() { Ended::Done } else { Ended::Failed };
    if let Some(there) = &there
        && !agrees(arguments, &evaluated, there)
    {
        ended = Ended::Failed;
    }
    if arguments.consistency && !is_consistent(arguments, &catalogue, evaluated) {
        ended = Ended::Failed;
    }
    Ok(ended)
}

/// Whether all nodes have the hashes that they had there.
fn agrees(arguments: &Arguments, evaluated: &Evaluated, there: &Hashes) -> bool {
    let file = &evaluated.file;
    let graph = &file.loaded.graph;
    let mut left: BTreeMap<&str, &NodeHashes> = there.nodes.iter().map(|node| (node.name.as_str(), node)).collect();
    let mut differences = Vec::new();
    for id in evaluation_order(graph, &evaluated.targets) {
        let before = graph.node(id).and_then(|node| left.remove(node.name()));
        let difference = match (NodeHashes::of(graph, &evaluated.evaluation, id), before) {
            (Some(here), Some(before)) => here.difference(before),
            (Some(_), None) => Some("there was no such node there".to_owned()),
            (None, Some(_)) => Some("it has no result here, and had one there".to_owned()),
            (None, None) => Some("it has no result".to_owned()),
        };
        differences.extend(difference.map(|difference| file.about(Severity::Error, id, None, &difference)));
    }
    // With fewer outputs asked for, fewer nodes are needed. What is gone comes first: others differ because of it.
    if arguments.evaluation.outputs.is_empty() {
        let path = file.path.display();
        let gone = there.nodes.iter().filter(|node| left.contains_key(node.name.as_str()));
        let gone = gone.map(|n| format!("{path}: error: node {:?}: it was there, and is not here", n.name));
        differences = gone.chain(differences).collect();
    }
    let against = arguments.against.as_ref().map(|path| path.display().to_string()).unwrap_or_default();
    if let Some(first) = differences.first() {
        console::remark(first);
        if differences.len() > 1 {
            console::remark(format!("{} more differ from {against}", differences.len() - 1));
        }
    } else if !arguments.evaluation.quiet {
        let count = evaluated.evaluation.outcomes().len();
        console::say(format!("{}: {count} nodes are the same as in {against}", file.path.display()));
    }
    differences.is_empty()
}

/// Whether the memo answers what a fresh evaluation gives.
fn is_consistent(arguments: &Arguments, catalogue: &Catalogue, evaluated: Evaluated) -> bool {
    let Evaluated { file, targets, .. } = evaluated;
    let mut graph = file.loaded.graph.clone();
    let options = consistency::Options {
        base: file.base(),
        project: &file.project,
        threads: usize::from(arguments.evaluation.threads),
    };
    let found = consistency::check(catalogue, &mut graph, &targets, &options);
    let path = file.path.display();
    if let Some(first) = found.differences.first() {
        console::remark(format!("{path}: error: the memo is not to be trusted: {first}"));
        if found.differences.len() > 1 {
            console::remark(format!("{} more answers differ", found.differences.len() - 1));
        }
    } else if !arguments.evaluation.quiet {
        let (values, answers) = (found.perturbed, found.answers);
        console::say(format!("{path}: {values} values changed and put back, {answers} answers of the memo are right"));
    }
    found.differences.is_empty()
}
