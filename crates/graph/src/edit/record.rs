//! A node outside a graph: everything needed to add it, or to bring it back as it was.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::body::Body;
use crate::graph::{Graph, Link, Node, NodeId, Outgoing, Source, Taken};
use crate::literal::Literal;

/// A node as [`crate::Edit::AddNode`] adds it.
///
/// ```
/// use maquette_graph::{Literal, NodeRecord};
/// let record = NodeRecord::new("resample", "even rails").literal("count", Literal::Integer(64)).at([120.0, 40.0]);
/// assert_eq!((record.kind(), record.name()), ("resample", "even rails"));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct NodeRecord {
    /// `None` for a new identity.
    pub(super) id: Option<NodeId>,
    pub(super) name: String,
    pub(super) kind: String,
    /// Whether it stands for a kind that the catalogue does not know.
    pub(super) placeholder: bool,
    pub(super) inputs: BTreeMap<String, Source>,
    pub(super) position: Option<[f64; 2]>,
    pub(super) note: String,
    pub(super) muted: bool,
    pub(super) collapsed: bool,
    /// The graph within; `None` for an empty one where the kind has a body.
    pub(super) body: Option<Arc<Body>>,
    pub(super) unknown_fields: Vec<(String, String)>,
    /// Outputs of the graph that come from it: their names, and the output of the node. They come from nothing when it
    /// is added.
    pub(super) promoted: Vec<(String, String)>,
    /// Links from it; the inputs at which they end hold nothing when it is added.
    pub(super) outgoing: Vec<Outgoing>,
}

impl NodeRecord {
    /// A node of that kind and name with every input at its default.
    pub fn new(kind: impl Into<String>, name: impl Into<String>) -> Self {
        Self {
            id: None,
            name: name.into(),
            kind: kind.into(),
            placeholder: false,
            inputs: BTreeMap::new(),
            position: None,
            note: String::new(),
            muted: false,
            collapsed: false,
            body: None,
            unknown_fields: Vec::new(),
            promoted: Vec::new(),
            outgoing: Vec::new(),
        }
    }

    /// With a literal at an input.
    #[must_use]
    pub fn literal(mut self, input: impl Into<String>, literal: Literal) -> Self {
        self.inputs.insert(input.into(), Source::literal(literal));
        self
    }

    /// With a link to an input.
    #[must_use]
    pub fn link(mut self, input: impl Into<String>, from: NodeId, output: impl Into<String>) -> Self {
        self.inputs.insert(input.into(), Source::Link(Link { node: from, output: output.into() }));
        self
    }

    /// With an input that holds a parameter of the graph.
    #[must_use]
    pub fn parameter(mut self, input: impl Into<String>, parameter: impl Into<String>) -> Self {
        self.inputs.insert(input.into(), Source::Parameter(parameter.into()));
        self
    }

    /// With a graph within; for the kinds `graph` and `repeat`.
    #[must_use]
    pub fn body(mut self, body: Body) -> Self {
        self.body = Some(Arc::new(body));
        self
    }

    /// Passing its inputs on in place of doing its work.
    #[must_use]
    pub fn muted(mut self) -> Self {
        self.muted = true;
        self
    }

    /// Drawn with its title and sockets only.
    #[must_use]
    pub fn collapsed(mut self) -> Self {
        self.collapsed = true;
        self
    }

    /// At a place of the canvas.
    #[must_use]
    pub fn at(mut self, position: [f64; 2]) -> Self {
        self.position = Some(position);
        self
    }

    /// With a remark.
    #[must_use]
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.note = note.into();
        self
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Name of its kind.
    pub fn kind(&self) -> &str {
        &self.kind
    }

    /// The identity that it had or is to get; `None` for the next free one.
    pub fn id(&self) -> Option<NodeId> {
        self.id
    }

    /// A node that was taken out of a graph.
    pub(super) fn of_taken(id: NodeId, taken: Taken) -> Self {
        let Taken { node, outgoing, promoted } = taken;
        Self {
            id: Some(id),
            name: node.name,
            placeholder: node.kind.is_none(),
            kind: node.kind_name,
            inputs: node.inputs,
            position: node.position,
            note: node.note,
            muted: node.muted,
            collapsed: node.collapsed,
            body: node.body,
            unknown_fields: node.unknown_fields,
            promoted,
            outgoing,
        }
    }

    /// A copy of a node of a graph, with links to it and without links from it.
    pub(super) fn of_node(node: &Node) -> Self {
        Self {
            id: None,
            name: node.name.clone(),
            placeholder: node.kind.is_none(),
            kind: node.kind_name.clone(),
            inputs: node.inputs.clone(),
            position: node.position,
            note: node.note.clone(),
            muted: node.muted,
            collapsed: node.collapsed,
            body: node.body.clone(),
            unknown_fields: node.unknown_fields.clone(),
            promoted: Vec::new(),
            outgoing: Vec::new(),
        }
    }

    /// Moves it by an offset, where it is placed.
    pub(super) fn shift(&mut self, offset: [f64; 2]) {
        self.position = self.position.map(|p| [p[0] + offset[0], p[1] + offset[1]]);
    }

    /// The outputs of the graph that come from a node: their names, and the output of the node.
    pub(super) fn promoted_of(graph: &Graph, id: NodeId) -> Vec<(String, String)> {
        let links = graph.outputs().filter_map(|output| Some((output.name(), output.link()?)));
        links.filter(|(_, link)| link.node == id).map(|(name, link)| (name.to_owned(), link.output.clone())).collect()
    }

    /// All links that leave a node.
    pub(super) fn outgoing_of(graph: &Graph, id: NodeId) -> Vec<Outgoing> {
        let links = graph.fed_by(id).into_iter().filter_map(|(to, input)| match graph.node(to)?.source(&input)? {
            Source::Link(link) => Some(Outgoing { output: link.output.clone(), to, input }),
            _ => None,
        });
        links.collect()
    }
}
