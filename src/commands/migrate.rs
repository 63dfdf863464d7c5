//! `maquette migrate`: files of earlier versions, rewritten as the present version writes them.

use std::path::{Path, PathBuf};

use maquette_graph::Catalogue;
use maquette_graph::file;

use super::graph_file::{GraphFile, each};
use super::project::ProjectArguments;
use super::{Ended, console, write};

/// Rewrite graphs of earlier versions: the format, and names and defaults of nodes that were other ones then. They are
/// read without it too; this saves doing so every time.
///
/// Only what is old is changed, comments and order stay. A file is replaced whole or not at all.
#[derive(clap::Args)]
pub struct Arguments {
    /// The graphs, .ron files.
    #[arg(required = true)]
    graphs: Vec<PathBuf>,
    /// Change nothing; say what is old, and exit with 1 where something is.
    #[arg(long)]
    check: bool,
    /// Say nothing but errors.
    #[arg(long, short)]
    quiet: bool,
}

/// Carries out the command.
pub fn migrate(arguments: &Arguments) -> Ended {
    each(&arguments.graphs, |catalogue, path| one(catalogue, arguments, path))
}

fn one(catalogue: &Catalogue, arguments: &Arguments, path: &Path) -> Ended {
    let name = path.display();
    let opened = GraphFile::open(catalogue, path, &ProjectArguments::default());
    let opened = opened.and_then(|file| match file::migrate(catalogue, &file.text) {
        Ok(migrated) => Ok((file, migrated)),
        Err(error) => Err(vec![format!("{name}:{error}")]),
    });
    let (file, migrated) = match opened {
        Ok(opened) => opened,
        Err(messages) => {
            messages.iter().for_each(console::remark);
            return Ended::Wrong;
        }
    };
    if !arguments.quiet {
        migrated.notes.iter().for_each(|note| console::say(file.located(note)));
    }
    if migrated.notes.is_empty() {
        if !arguments.quiet {
            console::say(format!("{name}: of the present version"));
        }
        return Ended::Done;
    }
    if arguments.check {
        console::remark(format!("{name}: error: of an earlier version; maquette migrate rewrites it"));
        return Ended::Failed;
    }
    if let Err(error) = write::replaced(path, migrated.text.as_bytes()) {
        console::error(error);
        return Ended::NotWritten;
    }
    if !arguments.quiet {
        console::say(format!("{name}: rewritten"));
    }
    Ended::Done
}
