//! Bodies: the graph within a node of kind `graph` or `repeat`.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::catalogue::Catalogue;
use crate::file;
use crate::graph::{Graph, Node, Source};
use crate::literal::{Literal, LiteralKind};
use crate::node_kind::NodeKind;
use crate::port::{InputSpec, OutputSpec, Range, Unit};
use crate::report::{FigureSpec, TableSpec, inside};
use crate::value::{ContentHash, ContentHasher, WireType};

/// Name of the kind that evaluates a graph.
pub(crate) const GRAPH: &str = "graph";
/// Name of the kind that evaluates a graph many times.
pub(crate) const REPEAT: &str = "repeat";
/// Bodies within bodies, at most. What is embedded so deep can still be read: RON stops where brackets are nested deeper.
pub(crate) const DEEPEST: usize = 16;
/// The input of a `repeat` that says how often.
pub(crate) const COUNT: &str = "count";
/// The parameter of a repeated body that counts from 0.
pub(crate) const INDEX: &str = "index";
/// A repeat runs at most so often.
pub(crate) const MOST_REPEATS: i64 = 10_000;

/// Where a body stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum BodySource {
    /// In the node itself.
    Embedded,
    /// In a file of its own; the path starts at the folder of the file that names it.
    File(String),
}

/// How often a body is evaluated.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Repeat {
    /// Once: a node of kind `graph`.
    #[default]
    Once,
    /// `count` times, independently; outputs are collected.
    Times,
    /// Once for each item of a list that arrives at this parameter, independently; outputs are collected.
    Each(
        /// The parameter that gets one item at a time.
        String,
    ),
    /// `count` times, one after the other: each parameter gets what the output beside it gave the time before. The
    /// outputs are those of the last time.
    FeedBack(
        /// Outputs by the parameters that they are fed to.
        BTreeMap<String, String>,
    ),
}

/// The graph within a node. Its parameters are the node's inputs, its outputs the node's outputs.
#[derive(Clone, Debug)]
pub struct Body {
    source: BodySource,
    /// `None` where its file could not be read.
    graph: Option<Arc<Graph>>,
    repeat: Repeat,
    content: ContentHash,
    depth: usize,
}

/// Why a graph can't be the body of a node.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BodyError {
    /// The file could not be read.
    #[error("its body, the file {0}, could not be read: see to the file and open the graph again")]
    NotLoaded(String),
    /// The file can't be changed from here.
    #[error("the body of \"{node}\" is the file {file}: open that graph to change it")]
    NotEmbedded {
        /// The node.
        node: String,
        /// The file.
        file: String,
    },
    /// The node has no body.
    #[error("node \"{0}\" has no body: only the kinds graph and repeat have one")]
    NoBody(String),
    /// Bodies within bodies within bodies.
    #[error("bodies are nested more than {DEEPEST} deep: use fewer levels")]
    TooDeep,
    /// A node of kind `graph` is evaluated once.
    #[error("a node of kind graph has no \"each\" and no \"feed_back\": use the kind repeat")]
    NotRepeated,
    /// `each` or `feed_back` names a parameter that is not there.
    #[error("\"{field}\" names the parameter \"{name}\", which the body does not have; it has {}", list(.known))]
    NoSuchParameter {
        /// `each` or `feed_back`.
        field: &'static str,
        /// The parameter.
        name: String,
        /// Parameters that exist.
        known: Vec<String>,
    },
    /// `feed_back` names an output that is not there.
    #[error("\"feed_back\" names the output \"{name}\", which the body does not have; it has {}", list(.known))]
    NoSuchOutput {
        /// The output.
        name: String,
        /// Outputs that exist.
        known: Vec<String>,
    },
    /// There is no list type.
    #[error(
        "\"each\" takes lists apart, and there is no list of {wire}: let the parameter \"{parameter}\" be a curve, say"
    )]
    NoList {
        /// The parameter.
        parameter: String,
        /// Its type.
        wire: &'static str,
    },
    /// There is no way to collect.
    #[error(
        "the output \"{output}\" gives {wire} each time, which can't be collected: leave it out of the body's outputs, \
         or feed it back"
    )]
    NotCollected {
        /// The output.
        output: String,
        /// Its type.
        wire: &'static str,
    },
    /// What is fed back does not fit.
    #[error("\"feed_back\": the output \"{output}\" gives {found}, and the parameter \"{parameter}\" takes {wanted}")]
    WrongFeedBack {
        /// The output.
        output: String,
        /// Its type.
        found: &'static str,
        /// The parameter.
        parameter: String,
        /// Its type.
        wanted: &'static str,
    },
    /// A parameter has the name of an input that a repeat has of its own.
    #[error("the body has a parameter \"{COUNT}\", and so has the repeat itself: rename the parameter")]
    CountTaken,
}

fn list(names: &[String]) -> String {
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

/// The path with the folder before it, unless it starts elsewhere. Both start at one and the same folder then.
pub(crate) fn within(folder: &str, path: &str) -> String {
    let elsewhere = std::path::Path::new(path);
    if folder.is_empty() || path.is_empty() || elsewhere.has_root() || elsewhere.is_absolute() {
        path.to_owned()
    } else {
        format!("{folder}/{path}")
    }
}

/// The folder of a file as a graph spells it; empty for the graph's own.
pub(crate) fn folder_of(path: &str) -> &str {
    path.rfind(['/', '\\']).map_or("", |at| if at == 0 { &path[..1] } else { &path[..at] })
}

/// The kinds that have a body, as they are before they have one.
pub(crate) fn built_in() -> [NodeKind; 2] {
    let describe = [
        (
            GRAPH,
            "Evaluates a graph of its own, embedded or another file: its parameters are inputs, its outputs outputs.",
        ),
        (
            REPEAT,
            "Evaluates a graph of its own many times: for each item of a list (each), count times with its result fed \
             back (feed_back), or count times on its own.",
        ),
    ];
    describe.map(|(name, text)| {
        let mut kind = NodeKind::declare(name, 1, "graph", text);
        let body = Body::empty(name);
        if name == REPEAT {
            kind.inputs.push(count_input());
        }
        kind.content = body.map(|body| body.content);
        kind
    })
}

fn count_input() -> InputSpec {
    let default = Literal::Integer(1);
    InputSpec {
        name: COUNT.to_owned(),
        description: "How often the body is evaluated.".to_owned(),
        wire: WireType::of::<i64>(),
        default_value: Some(default.to_value()),
        default: Some(default),
        optional: false,
        unit: Unit::None,
        range: Some(Range { min: 0.0, max: MOST_REPEATS as f64 }),
        soft_range: Some(Range { min: 0.0, max: 16.0 }),
        options: Vec::new(),
        extensions: Vec::new(),
    }
}

impl Body {
    /// A graph embedded in its node.
    ///
    /// # Errors
    /// It is nested too deep.
    pub fn embedded(graph: Graph) -> Result<Self, BodyError> {
        Self::new(BodySource::Embedded, Some(Arc::new(graph)), Repeat::Once)
    }

    /// A graph that was read from a file. The path starts at the folder of the file that names it.
    ///
    /// # Errors
    /// It is nested too deep.
    pub fn of_file(path: impl Into<String>, graph: Arc<Graph>) -> Result<Self, BodyError> {
        Self::new(BodySource::File(path.into()), Some(graph), Repeat::Once)
    }

    /// Evaluated in another way.
    #[must_use]
    pub fn repeated(self, repeat: Repeat) -> Self {
        let content = content(&self.source, self.graph.as_deref(), &repeat);
        Self { repeat, content, ..self }
    }

    pub(crate) fn new(source: BodySource, graph: Option<Arc<Graph>>, repeat: Repeat) -> Result<Self, BodyError> {
        let bodies = graph.iter().flat_map(|graph| graph.nodes().filter_map(|(_, node)| node.body()));
        let depth = 1 + bodies.map(|body| body.depth).max().unwrap_or(0);
        if depth > DEEPEST {
            return Err(BodyError::TooDeep);
        }
        let content = content(&source, graph.as_deref(), &repeat);
        Ok(Self { source, graph, repeat, content, depth })
    }

    /// The body of a new node; `None` for kinds that have none.
    pub(crate) fn empty(kind: &str) -> Option<Arc<Self>> {
        let repeat = match kind {
            GRAPH => Repeat::Once,
            REPEAT => Repeat::Times,
            _ => return None,
        };
        Self::new(BodySource::Embedded, Some(Arc::default()), repeat).ok().map(Arc::new)
    }

    /// The same with another graph within.
    pub(crate) fn with_graph(&self, graph: Graph) -> Result<Self, BodyError> {
        Self::new(self.source.clone(), Some(Arc::new(graph)), self.repeat.clone())
    }

    /// Where it stands.
    pub fn source(&self) -> &BodySource {
        &self.source
    }

    /// The graph; `None` where its file could not be read.
    pub fn graph(&self) -> Option<&Graph> {
        self.graph.as_deref()
    }

    pub(crate) fn shared_graph(&self) -> Option<&Arc<Graph>> {
        self.graph.as_ref()
    }

    /// How often it is evaluated.
    pub fn repeat(&self) -> &Repeat {
        &self.repeat
    }

    /// Hash of all that its results depend on apart from its inputs and files: nodes that its outputs depend on, their
    /// kinds and what their inputs hold. Layout and notes make no difference.
    pub fn content(&self) -> ContentHash {
        self.content
    }

    /// Folder at which paths within start, seen from the file that holds the node; empty for the same.
    pub fn folder(&self) -> &str {
        match &self.source {
            BodySource::Embedded => "",
            BodySource::File(path) => folder_of(path),
        }
    }

    /// What a node with this body takes and gives.
    ///
    /// # Errors
    /// The file could not be read; `each` or `feed_back` does not fit the graph; an output can't be collected.
    pub fn kind(&self, catalogue: &Catalogue, name: &str) -> Result<Arc<NodeKind>, BodyError> {
        let Some(graph) = self.graph() else {
            return Err(match &self.source {
                BodySource::File(path) => BodyError::NotLoaded(path.clone()),
                BodySource::Embedded => BodyError::NotLoaded("(embedded)".to_owned()),
            });
        };
        if (name == GRAPH) != (self.repeat == Repeat::Once) {
            return Err(BodyError::NotRepeated);
        }
        let template = catalogue.kind(name);
        let text = if graph.notes.is_empty() { template.map_or("", |kind| kind.description()) } else { &graph.notes };
        let mut kind = NodeKind::declare(name, template.map_or(1, |kind| kind.version()), GRAPH, text);
        kind.inputs = self.inputs(catalogue, graph)?;
        kind.outputs = self.outputs(catalogue, graph)?;
        kind.content = Some(self.content);
        declare_measures(&mut kind, graph);
        Ok(Arc::new(kind))
    }

    fn inputs(&self, catalogue: &Catalogue, graph: &Graph) -> Result<Vec<InputSpec>, BodyError> {
        let mut inputs = Vec::new();
        let known = || graph.parameters().map(|p| p.name().to_owned()).collect();
        let missing = |field, name: &String| BodyError::NoSuchParameter { field, name: name.clone(), known: known() };
        let each = if let Repeat::Each(name) = &self.repeat {
            Some(graph.parameter(name).ok_or_else(|| missing("each", name))?.name())
        } else {
            None
        };
        if let Repeat::FeedBack(pairs) = &self.repeat {
            for (parameter, output) in pairs {
                let wanted = graph.parameter(parameter).ok_or_else(|| missing("feed_back", parameter))?.wire();
                let found = graph.output(output).and_then(|output| graph.output_wire(output)).ok_or_else(|| {
                    let known = graph.outputs().map(|o| o.name().to_owned()).collect();
                    BodyError::NoSuchOutput { name: output.clone(), known }
                })?;
                if !catalogue.fits(found, wanted) {
                    let (output, parameter) = (output.clone(), parameter.clone());
                    let (found, wanted) = (found.name(), wanted.name());
                    return Err(BodyError::WrongFeedBack { output, found, parameter, wanted });
                }
            }
        }
        if matches!(self.repeat, Repeat::Times | Repeat::FeedBack(_)) {
            if graph.parameter(COUNT).is_some() {
                return Err(BodyError::CountTaken);
            }
            inputs.push(count_input());
        }
        for parameter in graph.parameters() {
            let spec = parameter.spec();
            if self.repeat != Repeat::Once && is_index(spec) {
                continue;
            }
            if each == Some(parameter.name()) {
                let list = catalogue.list_of(spec.wire).ok_or_else(|| BodyError::NoList {
                    parameter: parameter.name().to_owned(),
                    wire: spec.wire.name(),
                })?;
                let description = spec.description.clone();
                let item = crate::Parameter::required(parameter.name(), list.list).describe(description);
                inputs.push(item.spec);
            } else {
                inputs.push(self.seen_from_outside(spec));
            }
        }
        Ok(inputs)
    }

    /// A path that the file of the body names starts at the folder of that file, and not of the one that holds the node.
    fn seen_from_outside(&self, spec: &InputSpec) -> InputSpec {
        let mut spec = spec.clone();
        if let Some(Literal::File(path)) = &spec.default {
            let default = Literal::File(within(self.folder(), path));
            spec.default_value = Some(default.to_value());
            spec.default = Some(default);
        }
        spec
    }

    fn outputs(&self, catalogue: &Catalogue, graph: &Graph) -> Result<Vec<OutputSpec>, BodyError> {
        let mut outputs = Vec::new();
        for output in graph.outputs() {
            let Some(mut wire) = graph.output_wire(output) else { continue };
            if matches!(self.repeat, Repeat::Times | Repeat::Each(_)) {
                let collection = catalogue
                    .collection_of(wire)
                    .ok_or_else(|| BodyError::NotCollected { output: output.name().to_owned(), wire: wire.name() })?;
                wire = collection.collected;
            }
            let (name, description) = (output.name().to_owned(), output.description().to_owned());
            outputs.push(OutputSpec { name, description, wire });
        }
        Ok(outputs)
    }
}

/// What the nodes measure that the outputs depend on, the node measures.
fn declare_measures(kind: &mut NodeKind, graph: &Graph) {
    let targets: Vec<_> = graph.outputs().filter_map(|output| Some(output.link()?.node)).collect();
    for node in graph.upstream(&targets).into_iter().filter_map(|id| graph.node(id)) {
        let Some(measuring) = node.acting_kind() else { continue };
        if kind.figures.len().max(kind.tables.len()) > MOST_MEASURES {
            return;
        }
        let figures = measuring.figures().iter();
        kind.figures.extend(figures.map(|spec| FigureSpec { name: inside(node.name(), &spec.name), ..spec.clone() }));
        let tables = measuring.tables().iter();
        kind.tables.extend(tables.map(|spec| TableSpec { name: inside(node.name(), &spec.name), ..spec.clone() }));
    }
}

/// A kind declares at most about so many figures of the nodes within: parts of parts of parts could have billions.
const MOST_MEASURES: usize = 2_000;

/// Whether a parameter of a repeated body counts the times.
pub(crate) fn is_index(spec: &InputSpec) -> bool {
    spec.name == INDEX && LiteralKind::of_wire(spec.wire) == Some(LiteralKind::Integer)
}

impl PartialEq for Body {
    fn eq(&self, other: &Self) -> bool {
        let same_graph = match (&self.graph, &other.graph) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b) || file::to_text(a) == file::to_text(b),
            (None, None) => true,
            _ => false,
        };
        self.source == other.source && self.repeat == other.repeat && same_graph
    }
}

fn content(source: &BodySource, graph: Option<&Graph>, repeat: &Repeat) -> ContentHash {
    let mut hasher = ContentHasher::new("body");
    match repeat {
        Repeat::Once => hasher.integer(0),
        Repeat::Times => hasher.integer(1),
        Repeat::Each(parameter) => {
            hasher.integer(2);
            hasher.text(parameter);
        }
        Repeat::FeedBack(pairs) => {
            hasher.integer(3);
            hasher.integer(pairs.len() as u64);
            for (parameter, output) in pairs {
                hasher.text(parameter);
                hasher.text(output);
            }
        }
    }
    // Paths within mean other files in another folder.
    hasher.text(if let BodySource::File(path) = source { folder_of(path) } else { "" });
    let Some(graph) = graph else { return hasher.finish() };
    hasher.integer(graph.parameters().len() as u64);
    for parameter in graph.parameters() {
        hasher.text(parameter.name());
        hasher.text(parameter.wire().name());
        // The only one that is given from within.
        hasher.integer(u64::from(is_index(parameter.spec())));
    }
    let links: Vec<_> = graph.outputs().filter_map(|output| Some((output.name(), output.link()?))).collect();
    hasher.integer(links.len() as u64);
    for (name, link) in &links {
        hasher.text(name);
        hasher.text(graph.node(link.node).map_or("", Node::name));
        hasher.text(&link.output);
    }
    let targets: Vec<_> = links.iter().map(|(_, link)| link.node).collect();
    for id in graph.upstream(&targets) {
        if let Some(node) = graph.node(id) {
            hash_node(&mut hasher, graph, node);
        }
    }
    hasher.finish()
}

fn hash_node(hasher: &mut ContentHasher, graph: &Graph, node: &Node) {
    hasher.text(node.name());
    hasher.text(node.kind_name());
    hasher.integer(u64::from(node.is_muted()));
    let Some(kind) = node.kind() else { return hasher.integer(0) };
    hasher.integer(1 + u64::from(kind.version()));
    hasher.hash(kind.content.unwrap_or(ContentHash(0)));
    for spec in kind.inputs() {
        match node.source(&spec.name) {
            None => hasher.hash(spec.default_value.as_ref().map_or(ContentHash(0), crate::Value::hash)),
            Some(Source::Literal { value, .. }) => {
                hasher.integer(1);
                hasher.hash(value.hash());
            }
            Some(Source::Link(link)) => {
                hasher.integer(2);
                hasher.text(graph.node(link.node).map_or("", Node::name));
                hasher.text(&link.output);
            }
            Some(Source::Parameter(name)) => {
                hasher.integer(3);
                hasher.text(name);
            }
            Some(Source::Unread(text)) => {
                hasher.integer(4);
                hasher.text(text);
            }
        }
    }
}
