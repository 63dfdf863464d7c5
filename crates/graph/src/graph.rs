//! A graph: nodes by name, what their inputs hold, and where the editor draws them.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::body::Body;
use crate::catalogue::{Catalogue, closest};
use crate::interface::{GraphOutput, OutputSource};
use crate::literal::Literal;
use crate::node_kind::NodeKind;
use crate::parameter::Parameter;
use crate::presentation::{Frame, ReferencePicture};
use crate::topology::Topology;
use crate::value::Value;

/// Identity of a node within its graph: never reused, kept when the node is renamed, not saved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct NodeId(pub(crate) u32);

impl NodeId {
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }
}

/// Where a link comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Link {
    /// The node.
    pub node: NodeId,
    /// Its output.
    pub output: String,
}

/// A link that leaves a node.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Outgoing {
    pub(crate) output: String,
    pub(crate) to: NodeId,
    pub(crate) input: String,
}

/// What an input holds.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// A value written out.
    Literal {
        /// The value as a file spells it.
        literal: Literal,
        /// The same, hashed once.
        value: Value,
    },
    /// The output of another node.
    Link(Link),
    /// A parameter of the graph, by name.
    Parameter(String),
    /// Text of a file that could not be understood, kept so that saving loses nothing.
    Unread(String),
}

impl Source {
    pub(crate) fn literal(literal: Literal) -> Self {
        Self::Literal { value: literal.to_value(), literal }
    }
}

/// A node of a graph.
#[derive(Clone, Debug)]
pub struct Node {
    pub(crate) name: String,
    pub(crate) kind_name: String,
    pub(crate) kind: Option<Arc<NodeKind>>,
    /// The graph within, where the kind is `graph` or `repeat`.
    pub(crate) body: Option<Arc<Body>>,
    pub(crate) muted: bool,
    /// Whether the editor draws only its title and sockets.
    pub(crate) collapsed: bool,
    /// What it does while it is muted.
    pub(crate) bypass: Option<Arc<NodeKind>>,
    pub(crate) inputs: BTreeMap<String, Source>,
    pub(crate) position: Option<[f64; 2]>,
    pub(crate) note: String,
    /// Fields of the file that this version does not know: name and text, kept as they were.
    pub(crate) unknown_fields: Vec<(String, String)>,
    pub(crate) changed_at: u64,
}

impl Node {
    /// Readable name, unique in its graph.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Name of its kind.
    pub fn kind_name(&self) -> &str {
        &self.kind_name
    }

    /// Its kind; `None` for a placeholder of a kind that the catalogue does not know.
    pub fn kind(&self) -> Option<&Arc<NodeKind>> {
        self.kind.as_ref()
    }

    /// The graph within, where its kind is `graph` or `repeat`.
    pub fn body(&self) -> Option<&Arc<Body>> {
        self.body.as_ref()
    }

    /// Whether it passes its inputs on in place of doing its work.
    pub fn is_muted(&self) -> bool {
        self.muted
    }

    /// Whether the editor draws only its title and sockets.
    pub fn is_collapsed(&self) -> bool {
        self.collapsed
    }

    /// What it does: that of its kind, or, while it is muted, passing on.
    pub fn acting_kind(&self) -> Option<&Arc<NodeKind>> {
        if self.muted { self.bypass.as_ref() } else { self.kind.as_ref() }
    }

    pub(crate) fn set_kind(&mut self, kind: Option<Arc<NodeKind>>) {
        self.bypass = kind.as_ref().filter(|_| self.muted).map(|kind| Arc::new(NodeKind::bypass(kind)));
        self.kind = kind;
    }

    pub(crate) fn set_muted(&mut self, muted: bool) -> bool {
        let was = std::mem::replace(&mut self.muted, muted);
        self.set_kind(self.kind.clone());
        was
    }

    /// What the input holds; `None` where it holds its default or nothing.
    pub fn source(&self, input: &str) -> Option<&Source> {
        self.inputs.get(input)
    }

    /// All inputs that hold something of their own, by name.
    pub fn sources(&self) -> impl ExactSizeIterator<Item = (&str, &Source)> {
        self.inputs.iter().map(|(name, source)| (name.as_str(), source))
    }

    /// Where the editor draws it.
    pub fn position(&self) -> Option<[f64; 2]> {
        self.position
    }

    /// The artist's remark on it; may be empty.
    pub fn note(&self) -> &str {
        &self.note
    }
}

/// Why a graph could not be changed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GraphError {
    /// The catalogue has no such kind.
    #[error("no node kind is named \"{kind}\"{}", did_you_mean(.suggestion.as_deref()))]
    UnknownKind {
        /// The name.
        kind: String,
        /// A kind of a similar name.
        suggestion: Option<String>,
    },
    /// The name is taken.
    #[error("a node named \"{0}\" is already there: choose another name")]
    DuplicateName(String),
    /// The name can't be written in a file.
    #[error("\"{0}\" can't name a node: use letters, digits, spaces, '-' and '_', at most 200 characters")]
    BadName(String),
    /// The node is gone.
    #[error("the node is no longer in the graph")]
    NoSuchNode,
    /// The kind has no such input.
    #[error("node \"{node}\" (kind {kind}) has no input \"{port}\"; it has {}", list(.known))]
    NoSuchInput {
        /// The node.
        node: String,
        /// Its kind.
        kind: String,
        /// The name asked for.
        port: String,
        /// Inputs that exist.
        known: Vec<String>,
    },
    /// The literal does not fit.
    #[error("node \"{node}\", input \"{port}\": {reason}")]
    BadLiteral {
        /// The node.
        node: String,
        /// The input.
        port: String,
        /// Why.
        reason: String,
    },
}

/// Why a link was refused. The graph is as it was.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ConnectError {
    /// A node is gone.
    #[error("the node is no longer in the graph")]
    NoSuchNode,
    /// The kind has no such output.
    #[error("node \"{node}\" (kind {kind}) has no output \"{port}\"; it has {}", list(.known))]
    NoSuchOutput {
        /// The node.
        node: String,
        /// Its kind.
        kind: String,
        /// The name asked for.
        port: String,
        /// Outputs that exist.
        known: Vec<String>,
    },
    /// The kind has no such input.
    #[error("node \"{node}\" (kind {kind}) has no input \"{port}\"; it has {}", list(.known))]
    NoSuchInput {
        /// The node.
        node: String,
        /// Its kind.
        kind: String,
        /// The name asked for.
        port: String,
        /// Inputs that exist.
        known: Vec<String>,
    },
    /// The types differ and no conversion is lossless.
    #[error("\"{from}\" gives {found}, but \"{to}\" takes {wanted}: no conversion between them keeps everything")]
    WrongType {
        /// Node and output.
        from: String,
        /// Type of the output.
        found: &'static str,
        /// Node and input.
        to: String,
        /// Type of the input.
        wanted: &'static str,
    },
    /// The link would close a cycle.
    #[error("the link would close the cycle {}: a node can't depend on its own result", around(.0))]
    Cycle(
        /// Names of the nodes around the cycle; the first is repeated at the end.
        Vec<String>,
    ),
}

pub(crate) fn did_you_mean(suggestion: Option<&str>) -> String {
    suggestion.map(|s| format!("; did you mean \"{s}\"?")).unwrap_or_default()
}

fn list(names: &[String]) -> String {
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

/// Most nodes of a cycle that a message names.
const MOST_NAMED: usize = 12;

/// The nodes around a cycle; of a long one the beginning and the end.
fn around(names: &[String]) -> String {
    if names.len() <= MOST_NAMED {
        return names.join(" -> ");
    }
    let half = MOST_NAMED / 2;
    let (first, last) = (names[..half].join(" -> "), names[names.len() - half..].join(" -> "));
    format!("{first} -> ({} more) -> {last}", names.len() - 2 * half)
}

/// Whether a node, parameter or output may be named so.
pub(crate) fn valid_name(name: &str) -> bool {
    let allowed = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | ' ');
    name.trim() == name && !name.is_empty() && name.chars().count() <= 200 && name.chars().all(allowed)
}

/// A node that was taken out of its graph, with the links that left it.
pub(crate) struct Taken {
    pub(crate) node: Node,
    pub(crate) outgoing: Vec<Outgoing>,
    /// Outputs of the graph that came from it: their names, and the output of the node.
    pub(crate) promoted: Vec<(String, String)>,
}

static NEXT_IDENTITY: AtomicU64 = AtomicU64::new(0);

/// Nodes, links and literals, always acyclic and well typed.
#[derive(Debug)]
pub struct Graph {
    pub(crate) nodes: BTreeMap<NodeId, Node>,
    pub(crate) parameters: Vec<Parameter>,
    pub(crate) outputs: Vec<GraphOutput>,
    names: HashMap<String, NodeId>,
    pub(crate) topology: Topology,
    next: u32,
    revision: u64,
    identity: u64,
    /// The artist's remark on the whole.
    pub notes: String,
    pub(crate) frames: Vec<Frame>,
    pub(crate) references: Vec<ReferencePicture>,
    /// Top-level fields of the file that this version does not know: name and text, kept as they were.
    pub(crate) unknown_fields: Vec<(String, String)>,
    /// Layout entries of the file that belong to no node.
    pub(crate) unknown_layout: Vec<(String, String)>,
    /// With which versions of kinds that the catalogue does not know the file was written.
    pub(crate) unknown_kinds: BTreeMap<String, u32>,
    /// Parameters and outputs of the file that could not be understood: names and texts, kept as they were.
    pub(crate) unread_parameters: Vec<(String, String)>,
    pub(crate) unread_outputs: Vec<(String, String)>,
}

impl Default for Graph {
    fn default() -> Self {
        Self::new()
    }
}

impl Clone for Graph {
    fn clone(&self) -> Self {
        Self {
            nodes: self.nodes.clone(),
            parameters: self.parameters.clone(),
            outputs: self.outputs.clone(),
            names: self.names.clone(),
            topology: self.topology.clone(),
            next: self.next,
            revision: self.revision,
            // A copy goes its own way, so an evaluator must not take one for the other.
            identity: NEXT_IDENTITY.fetch_add(1, Ordering::Relaxed),
            notes: self.notes.clone(),
            frames: self.frames.clone(),
            references: self.references.clone(),
            unknown_fields: self.unknown_fields.clone(),
            unknown_layout: self.unknown_layout.clone(),
            unknown_kinds: self.unknown_kinds.clone(),
            unread_parameters: self.unread_parameters.clone(),
            unread_outputs: self.unread_outputs.clone(),
        }
    }
}

impl Graph {
    /// An empty graph.
    pub fn new() -> Self {
        Self {
            nodes: BTreeMap::new(),
            parameters: Vec::new(),
            outputs: Vec::new(),
            names: HashMap::new(),
            topology: Topology::default(),
            next: 0,
            revision: 0,
            identity: NEXT_IDENTITY.fetch_add(1, Ordering::Relaxed),
            notes: String::new(),
            frames: Vec::new(),
            references: Vec::new(),
            unknown_fields: Vec::new(),
            unknown_layout: Vec::new(),
            unknown_kinds: BTreeMap::new(),
            unread_parameters: Vec::new(),
            unread_outputs: Vec::new(),
        }
    }

    /// The nodes in the order in which they were added.
    pub fn nodes(&self) -> impl ExactSizeIterator<Item = (NodeId, &Node)> {
        self.nodes.iter().map(|(id, node)| (*id, node))
    }

    /// A node.
    pub fn node(&self, id: NodeId) -> Option<&Node> {
        self.nodes.get(&id)
    }

    /// The node of that name.
    pub fn find(&self, name: &str) -> Option<NodeId> {
        self.names.get(name).copied()
    }

    /// The name that is most like a misspelt one.
    pub fn suggest(&self, name: &str) -> Option<&str> {
        closest(name, self.nodes.values().map(Node::name))
    }

    /// The nodes that are results of the graph: what is evaluated when nothing else is asked for. A muted node is none.
    pub fn results(&self) -> Vec<NodeId> {
        let is_result = |n: &Node| n.acting_kind().is_some_and(|k| k.gives_result());
        self.nodes().filter(|(_, n)| is_result(n)).map(|(id, _)| id).collect()
    }

    /// The inputs that a node feeds: node and name of the input, ordered.
    pub fn fed_by(&self, node: NodeId) -> Vec<(NodeId, String)> {
        self.topology.fed_by(node)
    }

    /// The nodes that these depend on, themselves included, in the order of the graph. A muted node depends only on what
    /// it passes on.
    pub fn upstream(&self, nodes: &[NodeId]) -> Vec<NodeId> {
        let mut reached = BTreeSet::new();
        let mut stack = nodes.to_vec();
        while let Some(id) = stack.pop() {
            if let Some(node) = self.nodes.get(&id)
                && reached.insert(id)
            {
                let links = node.active_sources().filter_map(|source| match source {
                    Source::Link(link) => Some(link.node),
                    _ => None,
                });
                stack.extend(links);
            }
        }
        reached.into_iter().collect()
    }

    pub(crate) fn dependents(&self, node: NodeId) -> impl Iterator<Item = NodeId> + '_ {
        self.topology.dependents(node)
    }

    pub(crate) fn identity(&self) -> u64 {
        self.identity
    }

    pub(crate) fn revision(&self) -> u64 {
        self.revision
    }

    pub(crate) fn id_bound(&self) -> usize {
        self.next as usize
    }

    /// Marks the graph as changed, and no node.
    pub(crate) fn touch_all(&mut self) {
        self.revision += 1;
    }

    pub(crate) fn touch(&mut self, id: NodeId) {
        self.revision += 1;
        if let Some(node) = self.nodes.get_mut(&id) {
            node.changed_at = self.revision;
        }
    }

    fn check_name(&self, name: &str) -> Result<(), GraphError> {
        if !valid_name(name) {
            return Err(GraphError::BadName(name.to_owned()));
        }
        if self.names.contains_key(name) {
            return Err(GraphError::DuplicateName(name.to_owned()));
        }
        Ok(())
    }

    /// The identity that the node after the next `count` ones would get.
    pub(crate) fn id_after(&self, count: u32) -> NodeId {
        NodeId(self.next.saturating_add(count))
    }

    /// Adds a node without inputs, under an identity that no node has.
    pub(crate) fn insert(
        &mut self,
        id: NodeId,
        name: &str,
        kind_name: &str,
        kind: Option<Arc<NodeKind>>,
    ) -> Result<(), GraphError> {
        self.check_name(name)?;
        self.next = self.next.max(id.0.saturating_add(1));
        self.nodes.insert(
            id,
            Node {
                name: name.to_owned(),
                kind_name: kind_name.to_owned(),
                kind,
                body: None,
                muted: false,
                collapsed: false,
                bypass: None,
                inputs: BTreeMap::new(),
                position: None,
                note: String::new(),
                unknown_fields: Vec::new(),
                changed_at: 0,
            },
        );
        self.names.insert(name.to_owned(), id);
        self.topology.add(id);
        self.touch(id);
        Ok(())
    }

    /// Adds a node with every input at its default.
    ///
    /// # Errors
    /// Unknown kind, or a name that is taken or can't be written.
    pub fn add(&mut self, catalogue: &Catalogue, kind: &str, name: &str) -> Result<NodeId, GraphError> {
        let (id, known) = (self.id_after(0), Self::known_kind(catalogue, kind)?);
        self.insert(id, name, kind, Some(known))?;
        if let Some(node) = self.nodes.get_mut(&id) {
            node.body = Body::empty(kind);
        }
        Ok(id)
    }

    /// The kind of that name, or an error that suggests another.
    pub(crate) fn known_kind(catalogue: &Catalogue, kind: &str) -> Result<Arc<NodeKind>, GraphError> {
        catalogue.kind(kind).cloned().ok_or_else(|| GraphError::UnknownKind {
            kind: kind.to_owned(),
            suggestion: catalogue.suggest(kind).map(str::to_owned),
        })
    }

    /// Adds a placeholder for a node whose kind is unknown.
    pub(crate) fn add_placeholder(&mut self, kind: &str, name: &str) -> Result<NodeId, GraphError> {
        let id = self.id_after(0);
        self.insert(id, name, kind, None).map(|()| id)
    }

    /// Removes a node and every link from and to it.
    ///
    /// # Errors
    /// The node is gone already.
    pub fn remove(&mut self, id: NodeId) -> Result<(), GraphError> {
        self.take(id).map(drop)
    }

    /// Removes a node and gives it back with the links that left it.
    pub(crate) fn take(&mut self, id: NodeId) -> Result<Taken, GraphError> {
        let fed = self.topology.fed_by(id);
        let node = self.nodes.remove(&id).ok_or(GraphError::NoSuchNode)?;
        let mut outgoing = Vec::with_capacity(fed.len());
        for (to, input) in fed {
            if let Some(dependent) = self.nodes.get_mut(&to)
                && let Some(Source::Link(link)) = dependent.inputs.remove(&input)
            {
                outgoing.push(Outgoing { output: link.output, to, input });
            }
            self.touch(to);
        }
        let mut promoted = Vec::new();
        for output in &mut self.outputs {
            if let OutputSource::Link(link) = &output.from
                && link.node == id
            {
                promoted.push((output.name.clone(), link.output.clone()));
                output.from = OutputSource::Nothing;
            }
        }
        self.names.remove(&node.name);
        self.topology.remove(id);
        self.revision += 1;
        Ok(Taken { node, outgoing, promoted })
    }

    /// Forgets that identities from this one on were given: for what was added and taken back at once.
    pub(crate) fn give_back_ids(&mut self, first: NodeId) {
        if self.nodes.range(first..).next().is_none() {
            self.next = self.next.min(first.0);
        }
    }

    /// Gives a node another name. Links follow; nothing is evaluated again.
    ///
    /// # Errors
    /// A name that is taken or can't be written.
    pub fn rename(&mut self, id: NodeId, name: &str) -> Result<(), GraphError> {
        self.replace_name(id, name).map(drop)
    }

    /// As [`Graph::rename`]; gives the name that was there.
    pub(crate) fn replace_name(&mut self, id: NodeId, name: &str) -> Result<String, GraphError> {
        let old = self.nodes.get(&id).ok_or(GraphError::NoSuchNode)?.name.clone();
        if old == name {
            return Ok(old);
        }
        self.check_name(name)?;
        self.names.remove(&old);
        self.names.insert(name.to_owned(), id);
        if let Some(node) = self.nodes.get_mut(&id) {
            name.clone_into(&mut node.name);
        }
        Ok(old)
    }

    /// Puts a literal at an input, in place of whatever was there.
    ///
    /// # Errors
    /// No such input, or a literal that does not fit: wrong type, out of range, not finite.
    pub fn set(&mut self, id: NodeId, input: &str, literal: Literal) -> Result<(), GraphError> {
        self.replace_by_literal(id, input, literal).map(drop)
    }

    /// As [`Graph::set`]; gives what was there.
    pub(crate) fn replace_by_literal(
        &mut self,
        id: NodeId,
        input: &str,
        literal: Literal,
    ) -> Result<Option<Source>, GraphError> {
        let node = self.nodes.get(&id).ok_or(GraphError::NoSuchNode)?;
        if let Some(kind) = &node.kind {
            let spec = kind.find_input(input).ok_or_else(|| self.no_such_input(node, kind, input))?;
            if let Some(reason) = spec.refuses(&literal) {
                return Err(GraphError::BadLiteral { node: node.name.clone(), port: input.to_owned(), reason });
            }
            let literal = spec.normal(literal);
            Ok(self.put(id, input, Some(Source::literal(literal))))
        } else {
            if let Some(reason) = literal.not_finite() {
                return Err(GraphError::BadLiteral { node: node.name.clone(), port: input.to_owned(), reason });
            }
            Ok(self.put(id, input, Some(Source::literal(literal))))
        }
    }

    pub(crate) fn no_such_input(&self, node: &Node, kind: &NodeKind, input: &str) -> GraphError {
        GraphError::NoSuchInput {
            node: node.name.clone(),
            kind: node.kind_name.clone(),
            port: input.to_owned(),
            known: kind.inputs().iter().map(|i| i.name.clone()).collect(),
        }
    }

    /// Puts an input back to its default, unlinked.
    ///
    /// # Errors
    /// The node is gone.
    pub fn reset(&mut self, id: NodeId, input: &str) -> Result<(), GraphError> {
        self.replace_by_default(id, input).map(drop)
    }

    /// As [`Graph::reset`]; gives what was there.
    pub(crate) fn replace_by_default(&mut self, id: NodeId, input: &str) -> Result<Option<Source>, GraphError> {
        if !self.nodes.contains_key(&id) {
            return Err(GraphError::NoSuchNode);
        }
        Ok(self.put(id, input, None))
    }

    /// Puts something at an input that was checked to fit, and gives what was there.
    pub(crate) fn put(&mut self, id: NodeId, input: &str, source: Option<Source>) -> Option<Source> {
        self.topology.unlink(id, input);
        if let Some(Source::Link(link)) = &source {
            self.topology.link(link.node, id, input);
        }
        let old = self.nodes.get_mut(&id).and_then(|node| match source {
            Some(source) => node.inputs.insert(input.to_owned(), source),
            None => node.inputs.remove(input),
        });
        self.touch(id);
        old
    }

    /// Says why a link would be refused.
    ///
    /// # Errors
    /// Unknown ports, types that don't fit, a cycle.
    pub fn check_link(
        &self,
        catalogue: &Catalogue,
        from: NodeId,
        output: &str,
        to: NodeId,
        input: &str,
    ) -> Result<(), ConnectError> {
        self.check_ports(catalogue, from, output, to, input)?;
        self.check_acyclic(from, to)
    }

    /// Whether the ports of a link exist and their types fit.
    pub(crate) fn check_ports(
        &self,
        catalogue: &Catalogue,
        from: NodeId,
        output: &str,
        to: NodeId,
        input: &str,
    ) -> Result<(), ConnectError> {
        let source = self.nodes.get(&from).ok_or(ConnectError::NoSuchNode)?;
        let target = self.nodes.get(&to).ok_or(ConnectError::NoSuchNode)?;
        let given = match &source.kind {
            None => None,
            Some(kind) => Some(
                kind.find_output(output)
                    .ok_or_else(|| ConnectError::NoSuchOutput {
                        node: source.name.clone(),
                        kind: source.kind_name.clone(),
                        port: output.to_owned(),
                        known: kind.outputs().iter().map(|o| o.name.clone()).collect(),
                    })?
                    .1
                    .wire,
            ),
        };
        let wanted = match &target.kind {
            None => None,
            Some(kind) => Some(
                kind.find_input(input)
                    .ok_or_else(|| ConnectError::NoSuchInput {
                        node: target.name.clone(),
                        kind: target.kind_name.clone(),
                        port: input.to_owned(),
                        known: kind.inputs().iter().map(|i| i.name.clone()).collect(),
                    })?
                    .wire,
            ),
        };
        if let (Some(given), Some(wanted)) = (given, wanted)
            && !catalogue.fits(given, wanted)
        {
            return Err(ConnectError::WrongType {
                from: format!("{}.{output}", source.name),
                found: given.name(),
                to: format!("{}.{input}", target.name),
                wanted: wanted.name(),
            });
        }
        Ok(())
    }

    /// Links an output to an input, in place of whatever was there.
    ///
    /// # Errors
    /// As [`Graph::check_link`]; the graph is then as it was.
    pub fn connect(
        &mut self,
        catalogue: &Catalogue,
        from: NodeId,
        output: &str,
        to: NodeId,
        input: &str,
    ) -> Result<(), ConnectError> {
        self.replace_by_link(catalogue, from, output, to, input).map(drop)
    }

    /// As [`Graph::connect`]; gives what was there.
    pub(crate) fn replace_by_link(
        &mut self,
        catalogue: &Catalogue,
        from: NodeId,
        output: &str,
        to: NodeId,
        input: &str,
    ) -> Result<Option<Source>, ConnectError> {
        self.check_link(catalogue, from, output, to, input)?;
        Ok(self.put(to, input, Some(Source::Link(Link { node: from, output: output.to_owned() }))))
    }

    /// Places a node on the editor's canvas. Nothing is evaluated again.
    ///
    /// # Errors
    /// The node is gone.
    pub fn set_position(&mut self, id: NodeId, position: Option<[f64; 2]>) -> Result<(), GraphError> {
        self.replace_position(id, position).map(drop)
    }

    /// As [`Graph::set_position`]; gives where it was.
    pub(crate) fn replace_position(
        &mut self,
        id: NodeId,
        position: Option<[f64; 2]>,
    ) -> Result<Option<[f64; 2]>, GraphError> {
        let position = position.filter(|p| p.iter().all(|c| c.is_finite()));
        let node = self.nodes.get_mut(&id).ok_or(GraphError::NoSuchNode)?;
        Ok(std::mem::replace(&mut node.position, position))
    }

    /// Remarks on a node. Nothing is evaluated again.
    ///
    /// # Errors
    /// The node is gone.
    pub fn set_note(&mut self, id: NodeId, note: impl Into<String>) -> Result<(), GraphError> {
        self.replace_note(id, note.into()).map(drop)
    }

    /// As [`Graph::set_note`]; gives the note that was there.
    pub(crate) fn replace_note(&mut self, id: NodeId, note: String) -> Result<String, GraphError> {
        let node = self.nodes.get_mut(&id).ok_or(GraphError::NoSuchNode)?;
        Ok(std::mem::replace(&mut node.note, note))
    }
}
