//! Where a run stands: in the graph that is evaluated, or in a body within it.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::body::{Body, COUNT, INDEX, Repeat, is_index, within};
use crate::evaluate::{Event, EventKind, Events};
use crate::graph::{Graph, Node, NodeId};
use crate::literal::FilePath;
use crate::value::Value;

/// The graph of a run.
#[derive(Clone)]
pub(crate) enum GraphRef<'a> {
    /// The one that is evaluated.
    Root(&'a Graph),
    /// That of a body.
    Body(Arc<Graph>),
}

/// A graph with what it is given, and the way to it.
#[derive(Clone)]
pub(crate) struct Place<'a> {
    pub(crate) graph: GraphRef<'a>,
    /// Names of the nodes that lead to it, each with a slash behind; empty for the graph that is evaluated.
    pub(crate) path: String,
    /// Folder at which paths that are spelled in it start, seen from that of the graph that is evaluated.
    pub(crate) folder: String,
    /// What the parameters hold.
    pub(crate) given: BTreeMap<String, Value>,
    /// The node of the graph that is evaluated in which it is.
    pub(crate) root: Option<NodeId>,
}

impl<'a> Place<'a> {
    pub(crate) fn of_root(graph: &'a Graph) -> Self {
        let given = graph.parameters().filter_map(|p| Some((p.name().to_owned(), p.hashed()?.clone()))).collect();
        Self { graph: GraphRef::Root(graph), path: String::new(), folder: String::new(), given, root: None }
    }

    /// The graph within a node, which is given the values of the node's inputs. `time` is the number of the time, where the
    /// body is repeated; the parameters that count are then added.
    pub(crate) fn of_body(
        &self,
        node: NodeId,
        body: &Body,
        graph: Arc<Graph>,
        time: Option<usize>,
        mut given: BTreeMap<String, Value>,
    ) -> Self {
        let name = self.graph().node(node).map_or("", Node::name);
        let mut path = format!("{}{name}/", self.path);
        if let Some(time) = time {
            path.push_str(&format!("{time}/"));
            if !matches!(body.repeat(), Repeat::Each(_)) {
                given.remove(COUNT);
            }
            if graph.parameter(INDEX).is_some_and(|parameter| is_index(parameter.spec())) {
                given.insert(INDEX.to_owned(), Value::new(i64::try_from(time).unwrap_or(i64::MAX)));
            }
        }
        let folder = if body.folder().is_empty() { self.folder.clone() } else { within(&self.folder, body.folder()) };
        Self { graph: GraphRef::Body(graph), path, folder, given, root: Some(self.root.unwrap_or(node)) }
    }

    pub(crate) fn graph(&self) -> &Graph {
        match &self.graph {
            GraphRef::Root(graph) => graph,
            GraphRef::Body(graph) => graph,
        }
    }

    /// A value that is spelled here. A path then starts at the folder of the graph that is evaluated, like all paths
    /// that travel along wires.
    pub(crate) fn spelled(&self, value: &Value) -> Value {
        match value.get::<FilePath>() {
            Some(FilePath(path)) if !self.folder.is_empty() => Value::new(FilePath(within(&self.folder, path))),
            _ => value.clone(),
        }
    }

    /// The names of these nodes, with the way to them.
    pub(crate) fn names(&self, nodes: &[NodeId]) -> Vec<String> {
        let names = nodes.iter().filter_map(|id| self.graph().node(*id)).map(Node::name);
        names.map(|name| format!("{}{name}", self.path)).collect()
    }

    pub(crate) fn emit(&self, events: &dyn Events, node: NodeId, kind: EventKind<'_>) {
        let name = self.graph().node(node).map_or("", Node::name);
        let node = self.root.unwrap_or(node);
        if self.path.is_empty() {
            events.event(&Event { node, name, kind });
        } else {
            events.event(&Event { node, name: &format!("{}{name}", self.path), kind });
        }
    }
}
