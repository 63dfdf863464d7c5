//! `--project` and `--allow-outside`: which files a graph may read.

use std::path::{Path, PathBuf};

use maquette_graph::file::Project;

/// What the commands that read a graph's files have in common.
#[derive(Clone, Debug, Default, clap::Args)]
pub struct ProjectArguments {
    /// The project's folder: the graph may read files that lie below it. By default it is the graph's own folder; files
    /// named with --set are always allowed.
    #[arg(long, value_name = "FOLDER", conflicts_with = "allow_outside")]
    project: Option<PathBuf>,
    /// Let the graph read any file; for graphs that you trust.
    #[arg(long)]
    allow_outside: bool,
}

impl ProjectArguments {
    /// What a graph may read whose relative paths start at this folder.
    pub(super) fn of(&self, base: &Path) -> Project {
        match &self.project {
            _ if self.allow_outside => Project::anywhere(),
            Some(root) => Project::within(root),
            None => Project::within(base),
        }
    }
}
