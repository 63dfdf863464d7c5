//! `maquette freeze`: what a node makes of its inputs, as a golden test.

use std::path::{Path, PathBuf};

use maquette_graph::Catalogue;
use maquette_graph::file::Severity;
use maquette_graph::freeze::{FreezeError, Golden, Tolerance};

use super::graph_file::GraphFile;
use super::project::ProjectArguments;
use super::{Ended, console, write};

/// Write a node's inputs and outputs as a golden file, which cargo test compares with what the node gives
/// (crates/nodes/tests/frozen). Freezing to the same file again replaces it.
#[derive(clap::Args)]
pub struct Arguments {
    /// The graph, a .ron file.
    #[arg(required_unless_present = "update")]
    graph: Option<PathBuf>,
    /// The node.
    #[arg(required_unless_present = "update")]
    node: Option<String>,
    /// Write the golden file here (.ron); without it, to stdout.
    #[arg(short = 'o', long = "write", value_name = "FILE")]
    file: Option<PathBuf>,
    /// Put a value at an input first, such as --set even.count=8, or at a parameter of the graph; may be given several
    /// times.
    #[arg(long = "set", value_name = "ADDRESS=VALUE")]
    set: Vec<String>,
    #[command(flatten)]
    project: ProjectArguments,
    /// How far numbers may be off, in their unit; metres for points.
    #[arg(long, value_name = "LENGTH", default_value_t = Tolerance::default().absolute)]
    absolute: f64,
    /// How far numbers may be off as a share of their size; the larger of both counts.
    #[arg(long, value_name = "SHARE", default_value_t = Tolerance::default().relative)]
    relative: f64,
    /// Run these golden files on their own inputs, and freeze what their nodes give today.
    #[arg(long, value_name = "FILE", num_args = 1.., conflicts_with_all = ["graph", "node", "file", "set", "absolute", "relative"])]
    update: Vec<PathBuf>,
}

/// Carries out the command.
pub fn freeze(arguments: &Arguments) -> Ended {
    let attempt = match (&arguments.graph, &arguments.node) {
        (Some(graph), Some(node)) => freeze_node(arguments, graph, node),
        _ => update(&arguments.update),
    };
    match attempt {
        Ok(()) => Ended::Done,
        Err((ended, messages)) => {
            messages.iter().for_each(console::remark);
            ended
        }
    }
}

type Attempt = Result<(), (Ended, Vec<String>)>;

fn wrong(message: String) -> (Ended, Vec<String>) {
    (Ended::Wrong, vec![message])
}

fn catalogue() -> Result<Catalogue, (Ended, Vec<String>)> {
    maquette_nodes::catalogue().map_err(|error| wrong(format!("error: {error}")))
}

fn freeze_node(arguments: &Arguments, graph: &Path, name: &str) -> Attempt {
    for (option, share) in [("absolute", arguments.absolute), ("relative", arguments.relative)] {
        if !(share.is_finite() && share >= 0.0) {
            return Err(wrong(format!("error: --{option} {share}: give a number that is not negative")));
        }
    }
    let catalogue = catalogue()?;
    let (mut file, warnings) =
        GraphFile::open_sound(&catalogue, graph, &arguments.project).map_err(|messages| (Ended::Wrong, messages))?;
    warnings.iter().for_each(console::remark);
    for set in &arguments.set {
        file.apply(set).map_err(|message| wrong(format!("{}: error: {message}", graph.display())))?;
    }
    let node = file.loaded.graph.find(name).ok_or_else(|| {
        let hint = file.loaded.graph.suggest(name).map(|s| format!("; did you mean \"{s}\"?")).unwrap_or_default();
        wrong(format!("{}: error: no node is named \"{name}\"{hint}", graph.display()))
    })?;
    let missing = file.missing_links(&[node]);
    if !missing.is_empty() {
        return Err((Ended::Wrong, missing));
    }
    let tolerance = Tolerance { absolute: arguments.absolute, relative: arguments.relative };
    let golden = Golden::of_project(&catalogue, &file.loaded.graph, node, file.base(), &file.project, tolerance);
    let mut golden = golden.map_err(|error| {
        let ended = if matches!(error, FreezeError::NoResult(_)) { Ended::Failed } else { Ended::Wrong };
        (ended, vec![file.about(Severity::Error, node, None, &error.to_string())])
    })?;
    // The folder says nothing on another machine.
    let graph_name = graph.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    let changes: String = arguments.set.iter().map(|set| format!(", {set}")).collect();
    golden.from = format!("node {name:?} of {graph_name}{changes}");
    let text = golden.to_text();
    match &arguments.file {
        Some(path) => save(path, &text),
        None => {
            console::say(text.trim_end());
            Ok(())
        }
    }
}

fn save(path: &Path, text: &str) -> Attempt {
    write::whole(path, text.as_bytes()).map_err(|error| (Ended::NotWritten, vec![format!("error: {error}")]))?;
    console::say(format!("wrote {} ({} bytes)", path.display(), text.len()));
    Ok(())
}

fn update(files: &[PathBuf]) -> Attempt {
    let catalogue = catalogue()?;
    let mut updated = Vec::with_capacity(files.len());
    // All are run before any is written.
    for path in files {
        let said = |error: &dyn std::fmt::Display| wrong(format!("{}:{error}", path.display()));
        let text =
            std::fs::read_to_string(path).map_err(|error| said(&format!(" error: it can't be read: {error}")))?;
        let golden = Golden::from_text(&text).map_err(|error| said(&error))?;
        let now = golden.updated(&catalogue).map_err(|error| said(&format!(" error: {error}")))?;
        updated.push((path, text, now.to_text()));
    }
    for (path, before, now) in updated {
        if before == now {
            console::say(format!("{}: unchanged", path.display()));
        } else {
            save(path, &now)?;
        }
    }
    Ok(())
}
