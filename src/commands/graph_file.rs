//! A graph as it lies on disk.

use std::path::{Path, PathBuf};

use maquette_graph::file::{self, Loaded, Problem, Severity};
use maquette_graph::{Catalogue, Literal, NodeId, Source};

use super::console;

/// A graph with the file it came from.
pub(super) struct GraphFile {
    pub(super) path: PathBuf,
    /// What stands in the file.
    pub(super) text: String,
    pub(super) loaded: Loaded,
}

/// Why a graph could not be opened: what was said about it, for `--json`.
pub(super) type Refused = Vec<String>;

impl GraphFile {
    /// Reads a graph; what is wrong with it is in its problems.
    pub(super) fn open(catalogue: &Catalogue, path: &Path) -> Result<Self, Refused> {
        let name = path.display();
        let bytes = std::fs::read(path).map_err(|error| {
            let reason = match error.kind() {
                std::io::ErrorKind::NotFound => "there is no such file: check the path".to_owned(),
                _ => format!("it can't be read: {error}"),
            };
            vec![format!("{name}: error: {reason}")]
        })?;
        Self::from_bytes(catalogue, path, bytes)
    }

    /// Reads a graph from the bytes of a file.
    pub(super) fn from_bytes(catalogue: &Catalogue, path: &Path, bytes: Vec<u8>) -> Result<Self, Refused> {
        let name = path.display();
        let loaded = file::from_bytes(catalogue, &bytes).map_err(|error| vec![format!("{name}:{error}")])?;
        let text = String::from_utf8(bytes).map_err(|_| vec![format!("{name}: error: the file is not UTF-8 text")])?;
        Ok(Self { path: path.to_owned(), text, loaded })
    }

    /// Reads a graph that is to be evaluated: says its warnings, and refuses it where something is wrong.
    pub(super) fn open_sound(catalogue: &Catalogue, path: &Path, quiet: bool) -> Result<Self, Refused> {
        let file = Self::open(catalogue, path)?;
        let (errors, warnings): (Vec<_>, Vec<_>) =
            file.loaded.problems.iter().partition(|p| p.severity == Severity::Error);
        if !quiet {
            warnings.iter().for_each(|problem| console::remark(file.located(problem)));
        }
        if errors.is_empty() { Ok(file) } else { Err(errors.iter().map(|p| file.located(p)).collect()) }
    }

    /// The problem with the file's name before it.
    pub(super) fn located(&self, problem: &Problem) -> String {
        format!("{}:{problem}", self.path.display())
    }

    /// The folder at which relative paths of the graph start.
    pub(super) fn base(&self) -> &Path {
        self.path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
    }

    /// A message about a node, with the place of its input in the file.
    pub(super) fn about(&self, node: NodeId, input: Option<&str>, message: &str) -> String {
        let name = self.loaded.graph.node(node).map_or("", |n| n.name());
        let place = self.loaded.place(node, input).map(|(line, column)| format!("{line}:{column}:"));
        let input = input.map(|i| format!(", input \"{i}\"")).unwrap_or_default();
        format!("{}:{} node \"{name}\"{input}: {message}", self.path.display(), place.unwrap_or_default())
    }

    /// What keeps these nodes from being evaluated although the file is sound: inputs that must be linked and are not.
    pub(super) fn missing_links(&self, targets: &[NodeId]) -> Vec<String> {
        let graph = &self.loaded.graph;
        let mut missing = Vec::new();
        for id in graph.upstream(targets) {
            let Some((node, kind)) = graph.node(id).and_then(|n| Some((n, n.kind()?))) else { continue };
            for input in kind.inputs() {
                if input.default.is_none() && !input.optional && node.source(&input.name).is_none() {
                    let message = format!("error: nothing is connected; link an output that gives {}", input.wire);
                    missing.push(self.about(id, Some(&input.name), &message));
                }
            }
        }
        missing
    }

    /// Files that the graph names: the node, its input, the path.
    pub(super) fn files(&self) -> impl Iterator<Item = (NodeId, &str, PathBuf)> {
        self.loaded.graph.nodes().flat_map(move |(id, node)| {
            node.sources().filter_map(move |(input, source)| match source {
                Source::Literal { literal: Literal::File(path), .. } if !path.is_empty() => {
                    Some((id, input, self.base().join(path)))
                }
                _ => None,
            })
        })
    }

    /// Files that the graph names and that are not there.
    pub(super) fn missing_files(&self) -> Vec<String> {
        let missing = self.files().filter(|(_, _, path)| !path.is_file());
        let message = |path: &Path| format!("error: the file {} does not exist", path.display());
        missing.map(|(id, input, path)| self.about(id, Some(input), &message(&path))).collect()
    }
}
