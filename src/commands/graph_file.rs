//! A graph as it lies on disk.

use std::io::Read as _;
use std::path::{Path, PathBuf};

use maquette_graph::file::{self, Loaded, Problem, Project, Severity};
use maquette_graph::{Catalogue, Literal, NodeId, Source};

/// A graph with the file it came from.
pub(super) struct GraphFile {
    pub(super) path: PathBuf,
    /// What stands in the file.
    pub(super) text: String,
    pub(super) loaded: Loaded,
    /// The files that it may read.
    pub(super) project: Project,
}

/// Why a graph could not be opened: what was said about it, for `--json`.
pub(super) type Refused = Vec<String>;

impl GraphFile {
    /// Reads a graph; what is wrong with it is in its problems.
    pub(super) fn open(catalogue: &Catalogue, path: &Path) -> Result<Self, Refused> {
        let name = path.display();
        // One byte more than a graph may have is enough to refuse it.
        let read = |mut bytes: Vec<u8>| {
            std::fs::File::open(path)?.take(file::MOST_BYTES as u64 + 1).read_to_end(&mut bytes).map(|_| bytes)
        };
        let bytes = read(Vec::new()).map_err(|error: std::io::Error| {
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
        Ok(Self { path: path.to_owned(), text, loaded, project: Project::of_graph(path) })
    }

    /// Reads a graph that is to be evaluated, with its warnings; refuses it where something is wrong.
    pub(super) fn open_sound(catalogue: &Catalogue, path: &Path) -> Result<(Self, Vec<String>), Refused> {
        let file = Self::open(catalogue, path)?;
        let (errors, warnings): (Vec<_>, Vec<_>) =
            file.loaded.problems.iter().partition(|p| p.severity == Severity::Error);
        let errors: Vec<String> = errors.iter().map(|p| file.located(p)).collect();
        let warnings = warnings.iter().map(|p| file.located(p)).collect();
        if errors.is_empty() { Ok((file, warnings)) } else { Err(errors) }
    }

    /// The problem with the file's name before it.
    pub(super) fn located(&self, problem: &Problem) -> String {
        format!("{}:{problem}", self.path.display())
    }

    /// The folder at which relative paths of the graph start.
    pub(super) fn base(&self) -> &Path {
        self.path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
    }

    /// A message about a node, in the form of all others: `file:line:column: severity: node "..", input "..": message`.
    pub(super) fn about(&self, severity: Severity, node: NodeId, input: Option<&str>, message: &str) -> String {
        let name = self.loaded.graph.node(node).map_or("", |n| n.name());
        let place = self.loaded.place(node, input).map(|(line, column)| format!("{line}:{column}:"));
        let input = input.map(|i| format!(", input {i:?}")).unwrap_or_default();
        let (path, place) = (self.path.display(), place.unwrap_or_default());
        format!("{path}:{place} {severity}: node {name:?}{input}: {message}")
    }

    /// What keeps these nodes from being evaluated although the file is sound: inputs that must be linked and are not.
    pub(super) fn missing_links(&self, targets: &[NodeId]) -> Vec<String> {
        let graph = &self.loaded.graph;
        let mut missing = Vec::new();
        for id in graph.upstream(targets) {
            let Some((node, kind)) = graph.node(id).and_then(|n| Some((n, n.kind()?))) else { continue };
            for input in kind.inputs() {
                if input.default.is_none() && !input.optional && node.source(&input.name).is_none() {
                    let message = format!("nothing is connected; link an output that gives {}", input.wire);
                    missing.push(self.about(Severity::Error, id, Some(&input.name), &message));
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

    /// Files that the graph names and that are not there or must not be read, and files and sketches that it leaves
    /// empty.
    pub(super) fn missing_content(&self) -> Vec<String> {
        let mut missing = Vec::new();
        for (id, node) in self.loaded.graph.nodes() {
            for input in node.kind().map(|kind| kind.inputs()).unwrap_or_default() {
                let literal = match node.source(&input.name) {
                    Some(Source::Literal { literal, .. }) => Some(literal),
                    None => input.default.as_ref(),
                    Some(Source::Link(_) | Source::Unread(_)) => None,
                };
                let message = match literal {
                    Some(Literal::File(path)) if path.is_empty() => "no file is named; give a path".to_owned(),
                    Some(Literal::File(path)) => {
                        let path = self.base().join(path);
                        match self.project.check(&path) {
                            Err(outside) => outside.to_string(),
                            Ok(()) if path.is_file() => continue,
                            Ok(()) => format!("the file {} does not exist", path.display()),
                        }
                    }
                    Some(Literal::Strokes(strokes)) if strokes.is_empty() => {
                        "there are no strokes; draw some, or remove the node".to_owned()
                    }
                    _ => continue,
                };
                missing.push(self.about(Severity::Error, id, Some(&input.name), &message));
            }
        }
        missing
    }
}
