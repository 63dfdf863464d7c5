//! `maquette fmt`: graphs in the stable form, so that a change of one number is a change of one line.

use std::path::{Path, PathBuf};

use maquette_graph::Catalogue;
use maquette_graph::file::{self, Problem, Severity};

use super::comments::comments;
use super::graph_file::{GraphFile, each};
use super::project::ProjectArguments;
use super::{Ended, console, write};

/// Rewrite graphs in the stable form: the order and layout in which the editor saves them.
///
/// A file is replaced whole or not at all. One that can't be read, or would lose something, is left as it is; comments
/// are dropped only with --drop-comments.
#[derive(clap::Args)]
pub struct Arguments {
    /// The graphs, .ron files.
    #[arg(required = true)]
    graphs: Vec<PathBuf>,
    /// Change nothing; name the graphs that are not in the stable form, and exit with 2 where there are any.
    #[arg(long)]
    check: bool,
    /// Write the stable form to stdout and change nothing; for git's textconv.
    #[arg(long, conflicts_with = "check")]
    print: bool,
    /// Drop comments, which the stable form can't keep (notes and note can).
    #[arg(long)]
    drop_comments: bool,
    #[command(flatten)]
    project: ProjectArguments,
    /// Say nothing but errors.
    #[arg(long, short)]
    quiet: bool,
}

/// Carries out the command.
pub fn fmt(arguments: &Arguments) -> Ended {
    each(&arguments.graphs, |catalogue, path| one(catalogue, arguments, path))
}

fn one(catalogue: &Catalogue, arguments: &Arguments, path: &Path) -> Ended {
    let name = path.display();
    let file = match GraphFile::open(catalogue, path, &arguments.project) {
        Ok(file) => file,
        Err(messages) => {
            messages.iter().for_each(console::remark);
            return Ended::Wrong;
        }
    };
    let stable = file::to_text(&file.loaded.graph);
    if arguments.print {
        console::say(stable.trim_end());
        return Ended::Done;
    }
    if stable == file.text {
        if !arguments.quiet {
            console::say(format!("{name}: stable"));
        }
        return Ended::Done;
    }
    if arguments.check {
        console::remark(format!("{name}: error: not in the stable form; maquette fmt rewrites it"));
        return Ended::Wrong;
    }
    let lost = lost(catalogue, &file, &stable);
    if !lost.is_empty() {
        lost.iter().for_each(|problem| console::remark(file.located(problem)));
        console::remark(format!("{name}: error: left as it is, because this would be lost; mend it first"));
        return Ended::Wrong;
    }
    let had = comments(&file.text);
    // Those within fields that this version does not know are kept with them.
    let dropped = had.len().saturating_sub(comments(&stable).len());
    if let Some((line, column)) = had.first().filter(|_| dropped > 0 && !arguments.drop_comments) {
        let count = if dropped == 1 { "1 comment".to_owned() } else { format!("{dropped} comments") };
        console::remark(format!(
            "{name}:{line}:{column}: error: left as it is, because {count} would be dropped; move what matters into \
             notes or note, then use --drop-comments"
        ));
        return Ended::Wrong;
    }
    if let Err(error) = write::replaced(path, stable.as_bytes()) {
        console::error(error);
        return Ended::NotWritten;
    }
    if !arguments.quiet {
        let without = if dropped > 0 { ", comments dropped" } else { "" };
        console::say(format!("{name}: rewritten{without}"));
    }
    Ended::Done
}

/// Problems that the stable form would no longer have, because what they are about is not written: an input that occurs
/// twice, a name that can't be one.
fn lost<'a>(catalogue: &Catalogue, file: &'a GraphFile, stable: &str) -> Vec<&'a Problem> {
    let Ok(again) = GraphFile::from_bytes(
        catalogue,
        &file.path,
        stable.as_bytes().to_vec(),
        Some(file.base()),
        file.project.clone(),
    ) else {
        // The stable form of what was read can always be read.
        return file.loaded.problems.iter().collect();
    };
    let key = |p: &Problem| (p.node.clone(), p.port.clone(), p.message.clone());
    let mut left: Vec<_> = again.loaded.problems.iter().map(key).collect();
    let gone = |problem: &&Problem| match left.iter().position(|k| *k == key(problem)) {
        Some(at) => {
            left.swap_remove(at);
            false
        }
        None => true,
    };
    // What is said of an old file is over when it is one of today.
    file.loaded.problems.iter().filter(|p| p.severity != Severity::Note).filter(gone).collect()
}
