//! A graph as it lies on disk.

use std::collections::BTreeSet;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use maquette_graph::file::{self, Includes, Loaded, Problem, Project, Severity};
use maquette_graph::{Catalogue, Graph, Literal, NodeId, Source};

use super::project::ProjectArguments;
use super::{Ended, console, overrides};

/// A graph with the file it came from.
pub(super) struct GraphFile {
    pub(super) path: PathBuf,
    /// Where its relative paths start.
    folder: PathBuf,
    /// What stands in the file.
    pub(super) text: String,
    pub(super) loaded: Loaded,
    /// The files that it may read.
    pub(super) project: Project,
}

/// Why a graph could not be opened: what was said about it, for `--json`.
pub(super) type Refused = Vec<String>;

/// Carries out a command for each of several graphs. It ends as the worst of them did: not written is worse than wrong.
pub(super) fn each(paths: &[PathBuf], one: impl Fn(&Catalogue, &Path) -> Ended) -> Ended {
    let catalogue = match maquette_nodes::catalogue() {
        Ok(catalogue) => catalogue,
        Err(error) => {
            console::error(error.to_string());
            return Ended::Wrong;
        }
    };
    paths.iter().map(|path| one(&catalogue, path)).max_by_key(|ended| *ended as u8).unwrap_or(Ended::Done)
}

impl GraphFile {
    /// Reads a graph; what is wrong with it is in its problems.
    pub(super) fn open(catalogue: &Catalogue, path: &Path, project: &ProjectArguments) -> Result<Self, Refused> {
        Self::open_in(catalogue, path, None, project)
    }

    /// As [`GraphFile::open`], with relative paths starting elsewhere than at its own folder.
    pub(super) fn open_in(
        catalogue: &Catalogue,
        path: &Path,
        base: Option<&Path>,
        project: &ProjectArguments,
    ) -> Result<Self, Refused> {
        let name = path.display();
        let bytes = read_graph(path).map_err(|error| {
            let reason = match error.kind() {
                std::io::ErrorKind::NotFound => "there is no such file: check the path".to_owned(),
                _ => format!("it can't be read: {error}"),
            };
            vec![format!("{name}: error: {reason}")]
        })?;
        let project = project.of(base.unwrap_or(folder_of(path)));
        Self::from_bytes(catalogue, path, bytes, base, project)
    }

    /// Reads a graph from the bytes of a file.
    pub(super) fn from_bytes(
        catalogue: &Catalogue,
        path: &Path,
        bytes: Vec<u8>,
        base: Option<&Path>,
        project: Project,
    ) -> Result<Self, Refused> {
        let name = path.display();
        let folder = base.unwrap_or(folder_of(path));
        let read = |file: &Path| read_included(&project, &folder.join(file));
        let own = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let includes = Includes::new(&own, &read);
        let loaded =
            file::from_bytes_with(catalogue, &bytes, &includes).map_err(|error| vec![format!("{name}:{error}")])?;
        let text = String::from_utf8(bytes).map_err(|_| vec![format!("{name}: error: the file is not UTF-8 text")])?;
        Ok(Self { path: path.to_owned(), folder: folder.to_owned(), text, loaded, project })
    }

    /// Reads a graph that is to be evaluated, with its warnings; refuses it where something is wrong.
    pub(super) fn open_sound(
        catalogue: &Catalogue,
        path: &Path,
        project: &ProjectArguments,
    ) -> Result<(Self, Vec<String>), Refused> {
        let file = Self::open(catalogue, path, project)?;
        let (errors, warnings): (Vec<_>, Vec<_>) =
            file.loaded.problems.iter().partition(|p| p.severity == Severity::Error);
        let errors: Vec<String> = errors.iter().map(|p| file.located(p)).collect();
        let warnings = warnings.iter().map(|p| file.located(p)).collect();
        if errors.is_empty() { Ok((file, warnings)) } else { Err(errors) }
    }

    /// Puts a value given by `--set` into the graph. A file that the user names, the user wants to be read.
    pub(super) fn apply(&mut self, assignment: &str) -> Result<(), String> {
        let literal = overrides::apply(&mut self.loaded.graph, assignment)?;
        self.allow(&literal);
        Ok(())
    }

    /// Lets the graph read the file that a value of the user names, if it names one.
    pub(super) fn allow(&mut self, literal: &Literal) {
        if let Literal::File(path) = literal {
            self.project.allow(self.folder.join(path));
        }
    }

    /// The problem with the file's name before it: that of an included file where that has it.
    pub(super) fn located(&self, problem: &Problem) -> String {
        match &problem.file {
            Some(file) => {
                let own = Problem { file: None, ..problem.clone() };
                format!("{}:{own}", self.base().join(file).display())
            }
            None => format!("{}:{problem}", self.path.display()),
        }
    }

    /// The folder at which relative paths of the graph start.
    pub(super) fn base(&self) -> &Path {
        &self.folder
    }

    /// A message about a node, in the form of all others: `file:line:column: severity: node "..", input "..": message`.
    pub(super) fn about(&self, severity: Severity, node: NodeId, input: Option<&str>, message: &str) -> String {
        let name = self.loaded.graph.node(node).map_or("", |n| n.name());
        let place = self.loaded.place(node, input).map(|(line, column)| format!("{line}:{column}:"));
        let input = input.map(|i| format!(", input {i:?}")).unwrap_or_default();
        let (path, place) = (self.path.display(), place.unwrap_or_default());
        format!("{path}:{place} {severity}: node {name:?}{input}: {message}")
    }

    /// What keeps these nodes from being evaluated although the file is sound: inputs that must be linked and are not, and
    /// parameters that hold nothing.
    pub(super) fn missing_links(&self, targets: &[NodeId]) -> Vec<String> {
        self.missing(targets, true)
    }

    /// The same for a graph that is a part of others: these give its parameters what they hold.
    pub(super) fn missing_links_within(&self, targets: &[NodeId]) -> Vec<String> {
        self.missing(targets, false)
    }

    fn missing(&self, targets: &[NodeId], parameters_too: bool) -> Vec<String> {
        let graph = &self.loaded.graph;
        let mut missing = Vec::new();
        for id in graph.upstream(targets) {
            let Some((node, kind)) = graph.node(id).and_then(|n| Some((n, n.acting_kind()?))) else { continue };
            for input in kind.inputs().iter().filter(|input| input.default.is_none() && !input.optional) {
                let message = match node.source(&input.name) {
                    None => format!("nothing is connected; link an output that gives {}", input.wire),
                    Some(Source::Parameter(name)) if parameters_too && self.holds_nothing(name) => {
                        let wire = input.wire;
                        format!(
                            "the parameter \"{name}\" holds nothing here; use this graph in another, or link {wire}"
                        )
                    }
                    Some(_) => continue,
                };
                missing.push(self.about(Severity::Error, id, Some(&input.name), &message));
            }
        }
        missing
    }

    fn holds_nothing(&self, parameter: &str) -> bool {
        self.loaded.graph.parameter(parameter).is_some_and(|parameter| parameter.value().is_none())
    }

    /// Those of the nodes that can be evaluated without the graphs that this one is a part of.
    pub(super) fn given(&self, nodes: &[NodeId]) -> Vec<NodeId> {
        let graph = &self.loaded.graph;
        let lacks = |id: &NodeId| {
            let mut sources = graph.node(*id).into_iter().flat_map(|node| node.sources());
            sources.any(|(_, source)| matches!(source, Source::Parameter(name) if self.holds_nothing(name)))
        };
        if graph.outputs().len() == 0 {
            return nodes.to_vec();
        }
        let lacking: BTreeSet<NodeId> = nodes.iter().copied().filter(lacks).collect();
        nodes.iter().copied().filter(|id| graph.upstream(&[*id]).iter().all(|above| !lacking.contains(above))).collect()
    }

    /// Files that the graph is made of and names: included graphs, and files at inputs and parameters, in bodies too.
    pub(super) fn files(&self) -> Vec<PathBuf> {
        let mut files: Vec<PathBuf> = self.loaded.included.iter().map(|file| self.base().join(file)).collect();
        let mut graphs: Vec<(&Graph, PathBuf)> = vec![(&self.loaded.graph, self.base().to_owned())];
        // Parts are shared, and looked at once from each folder.
        let mut seen = BTreeSet::new();
        while let Some((graph, folder)) = graphs.pop() {
            if !seen.insert((std::ptr::from_ref(graph), folder.clone())) {
                continue;
            }
            let parameters = graph.parameters().filter_map(|parameter| parameter.value());
            let inputs = graph.nodes().flat_map(|(_, node)| node.sources());
            let inputs = inputs.filter_map(|(_, source)| match source {
                Source::Literal { literal, .. } => Some(literal),
                Source::Link(_) | Source::Parameter(_) | Source::Unread(_) => None,
            });
            files.extend(parameters.chain(inputs).filter_map(|literal| match literal {
                Literal::File(path) if !path.is_empty() => Some(folder.join(path)),
                _ => None,
            }));
            let bodies = graph.nodes().filter_map(|(_, node)| node.body());
            graphs.extend(bodies.filter_map(|body| Some((body.graph()?, folder.join(body.folder())))));
        }
        files.sort();
        files.dedup();
        files
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
                    Some(Source::Parameter(name)) => {
                        self.loaded.graph.parameter(name).and_then(|parameter| parameter.value())
                    }
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

/// The folder at which relative paths of a graph's file start.
fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// The bytes of a graph's file; of one that is too long, enough to refuse it.
fn read_graph(path: &Path) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    std::fs::File::open(path)?.take(file::MOST_BYTES as u64 + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The bytes of a graph that another one includes, or in words for artists why there are none.
fn read_included(project: &Project, path: &Path) -> Result<Vec<u8>, String> {
    project.check(path).map_err(|outside| outside.to_string())?;
    // Asked first, because to open a pipe may take forever.
    match std::fs::metadata(path) {
        Ok(data) if !data.is_file() => return Err("it is not a file".to_owned()),
        _ => {}
    }
    read_graph(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => {
            "there is no such file: put it there, or correct the path (it starts at the folder of the file that names it)"
                .to_owned()
        }
        _ => format!("it can't be read: {error}"),
    })
}
