//! Nodes into a node of their own.

use std::collections::{BTreeMap, BTreeSet};

use crate::body::{Body, BodyError, COUNT, GRAPH, INDEX};
use crate::catalogue::Catalogue;
use crate::edit::compound::promote::free_name;
use crate::edit::compound::{Plan, input_wire, output_wire};
use crate::edit::fresh_name::FreshNames;
use crate::edit::{Edit, EditError, NodeRecord};
use crate::graph::{Graph, GraphError, Link, NodeId, Source, valid_name};
use crate::interface::{GraphOutput, OutputSource};
use crate::parameter::Parameter;

/// Why nodes can't be grouped.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GroupError {
    /// A node is gone, or the name can't be a name.
    #[error(transparent)]
    Graph(#[from] GraphError),
    /// Nothing is left to group.
    #[error("there is nothing to group: select nodes that are no results")]
    Empty,
    /// A way leads out of the group and back.
    #[error(
        "\"{outside}\" depends on the group, and the group on it: select it too, or leave out what lies on one side of it"
    )]
    Around {
        /// The node outside.
        outside: String,
    },
    /// The type of a link is not known.
    #[error("the type of the link from \"{0}\" is not known, because kinds at both its ends are not")]
    UnknownType(String),
    /// The result would not be a body.
    #[error(transparent)]
    Body(#[from] BodyError),
    /// A node does not fit into a graph of its own.
    #[error(transparent)]
    Edit(#[from] Box<EditError>),
}

/// Replaces nodes by one of kind `graph` in whose body they are. What came in by links comes in by parameters of the body,
/// what went out goes out by its outputs; all results stay as they are. Results of the graph (`mesh-out` and the like) stay
/// outside, because within they would be none, and are remarked on.
///
/// # Errors
/// A node is gone; nothing is left to group; a node outside lies between two inside; bodies would be nested too deep.
pub fn group(graph: &Graph, catalogue: &Catalogue, nodes: &[NodeId], name: &str) -> Result<Plan, GroupError> {
    let mut plan = Plan::default();
    let mut inner = BTreeSet::new();
    for id in nodes {
        let node = graph.node(*id).ok_or(GraphError::NoSuchNode)?;
        if node.kind().is_some_and(|kind| kind.gives_result()) {
            plan.remark(node.name(), "", "stays outside, because a result counts only in the graph itself");
        } else {
            inner.insert(*id);
        }
    }
    if inner.is_empty() {
        return Err(GroupError::Empty);
    }
    check_around(graph, &inner)?;
    let mut names = FreshNames::new(graph);
    if !valid_name(name) {
        return Err(GraphError::BadName(name.to_owned()).into());
    }
    let own_name = names.give(name);
    let id = graph.id_after(0);
    let mut moving = Moving { graph, catalogue, inner: &inner, body: Graph::new(), given: BTreeMap::new() };
    let mut record = NodeRecord::new(GRAPH, own_name);
    record.id = Some(id);
    record.position = middle(graph, &inner);
    moving.nodes(&mut record)?;
    let leaving = moving.outputs(id, &mut plan)?;
    record.body = Some(std::sync::Arc::new(Body::embedded(moving.body)?));
    let removed = inner.iter().copied().map(Edit::RemoveNode);
    let added = Edit::AddNode(Box::new(record));
    plan.edits = removed.chain([added]).chain(leaving).collect();
    plan.nodes = vec![id];
    Ok(plan)
}

/// Refuses a group that a node outside lies between.
fn check_around(graph: &Graph, inner: &BTreeSet<NodeId>) -> Result<(), GroupError> {
    // Outside nodes that depend on the group.
    let mut behind = BTreeSet::new();
    let mut stack: Vec<NodeId> = inner.iter().copied().collect();
    while let Some(id) = stack.pop() {
        for to in graph.dependents(id) {
            if !inner.contains(&to) && behind.insert(to) {
                stack.push(to);
            }
        }
    }
    for id in &behind {
        if graph.dependents(*id).any(|to| inner.contains(&to)) {
            let outside = graph.node(*id).map_or("", |node| node.name()).to_owned();
            return Err(GroupError::Around { outside });
        }
    }
    Ok(())
}

fn middle(graph: &Graph, nodes: &BTreeSet<NodeId>) -> Option<[f64; 2]> {
    let places: Vec<[f64; 2]> = nodes.iter().filter_map(|id| graph.node(*id)?.position()).collect();
    #[expect(clippy::cast_precision_loss, reason = "so many nodes do not fit into memory")]
    let share = 1.0 / places.len().max(1) as f64;
    let sum = places.iter().fold([0.0, 0.0], |sum, place| [sum[0] + share * place[0], sum[1] + share * place[1]]);
    (!places.is_empty()).then_some(sum)
}

struct Moving<'a> {
    graph: &'a Graph,
    catalogue: &'a Catalogue,
    inner: &'a BTreeSet<NodeId>,
    body: Graph,
    /// Parameters of the body by what they bring: the output of a node outside, or a parameter of the graph.
    given: BTreeMap<(Option<NodeId>, String), String>,
}

impl Moving<'_> {
    /// Puts the nodes into the body, and into the record what their links and parameters bring.
    fn nodes(&mut self, outer: &mut NodeRecord) -> Result<(), GroupError> {
        let new_ids: BTreeMap<NodeId, NodeId> =
            (0..).zip(self.inner).map(|(i, id)| (*id, self.body.id_after(i))).collect();
        let mut links = Vec::new();
        for old in self.inner {
            let Some(node) = self.graph.node(*old) else { continue };
            let mut record = NodeRecord::of_node(node);
            let id = new_ids.get(old).copied();
            record.id = id;
            for (input, source) in std::mem::take(&mut record.inputs) {
                let source = match source {
                    Source::Link(link) => match new_ids.get(&link.node) {
                        Some(from) => {
                            links.extend(id.map(|id| Edit::connect(*from, link.output, id, input)));
                            continue;
                        }
                        None => Source::Parameter(self.bring_link(outer, *old, &input, &link)?),
                    },
                    Source::Parameter(name) => Source::Parameter(self.bring_parameter(outer, &name)?),
                    other => other,
                };
                record.inputs.insert(input, source);
            }
            self.apply(&Edit::AddNode(Box::new(record)))?;
        }
        links.iter().try_for_each(|link| self.apply(link))
    }

    fn apply(&mut self, edit: &Edit) -> Result<(), GroupError> {
        self.body.apply(self.catalogue, edit).map(drop).map_err(|error| GroupError::Edit(Box::new(error)))
    }

    fn parameter(
        &mut self,
        key: (Option<NodeId>, String),
        wanted: &str,
        node: &str,
        parameter: impl FnOnce(&str) -> Parameter,
    ) -> Result<String, GroupError> {
        // Where the body is repeated later, these two mean something.
        let is_taken = |name: &str| self.body.parameter(name).is_some() || matches!(name, COUNT | INDEX);
        let name = free_name(wanted, is_taken, node);
        let parameter = parameter(&name);
        let index = self.body.parameters().len();
        self.apply(&Edit::AddParameter { index, parameter: Box::new(parameter) })?;
        self.given.insert(key, name.clone());
        Ok(name)
    }

    /// The parameter of the body that brings a link from outside.
    fn bring_link(
        &mut self,
        outer: &mut NodeRecord,
        to: NodeId,
        input: &str,
        link: &Link,
    ) -> Result<String, GroupError> {
        let key = (Some(link.node), link.output.clone());
        if let Some(name) = self.given.get(&key) {
            return Ok(name.clone());
        }
        let from = self.graph.node(link.node).map_or("", |node| node.name());
        let wire = output_wire(self.graph, link).or_else(|| input_wire(self.graph, to, input));
        let wire = wire.ok_or_else(|| GroupError::UnknownType(format!("{from}.{}", link.output)))?;
        let spec = self.graph.node(to).and_then(|node| node.kind()?.find_input(input));
        let text = spec.map(|spec| spec.description.clone()).unwrap_or_default();
        let name = self.parameter(key, input, from, |name| Parameter::required(name, wire).describe(text))?;
        outer.inputs.insert(name.clone(), Source::Link(link.clone()));
        Ok(name)
    }

    /// The parameter of the body that brings a parameter of the graph.
    fn bring_parameter(&mut self, outer: &mut NodeRecord, name: &str) -> Result<String, GroupError> {
        let key = (None, name.to_owned());
        if let Some(name) = self.given.get(&key) {
            return Ok(name.clone());
        }
        let Some(found) = self.graph.parameter(name).cloned() else { return Ok(name.to_owned()) };
        let inner = self.parameter(key, name, "graph", |name| {
            let mut parameter = found;
            name.clone_into(&mut parameter.spec.name);
            // Where the parameter holds nothing, inputs are at their defaults; so it shall be within.
            parameter.spec.optional |= parameter.value().is_none();
            parameter
        })?;
        outer.inputs.insert(inner.clone(), Source::Parameter(name.to_owned()));
        Ok(inner)
    }

    /// Declares what leaves the body, and gives the edits that link it outside.
    fn outputs(&mut self, group: NodeId, plan: &mut Plan) -> Result<Vec<Edit>, GroupError> {
        let mut leaving = Vec::new();
        let mut names: BTreeMap<(NodeId, String), String> = BTreeMap::new();
        let new_ids: BTreeMap<NodeId, NodeId> =
            self.inner.iter().copied().zip(self.body.nodes().map(|(id, _)| id)).collect();
        for old in self.inner {
            let outgoing = NodeRecord::outgoing_of(self.graph, *old);
            for link in outgoing.into_iter().filter(|link| !self.inner.contains(&link.to)) {
                let name = self.output(&new_ids, &mut names, *old, &link.output)?;
                let Some(name) = name else {
                    let to = self.graph.node(link.to).map_or("", |node| node.name());
                    plan.remark(to, &link.input, "its link goes: the kind of the node that it comes from is unknown");
                    continue;
                };
                leaving.push(Edit::connect(group, name, link.to, link.input));
            }
            for (promoted, output) in NodeRecord::promoted_of(self.graph, *old) {
                let name = self.output(&new_ids, &mut names, *old, &output)?;
                let Some((name, found)) = name.zip(self.graph.output(&promoted)) else {
                    plan.remark("", &promoted, "the graph's output comes from nothing then");
                    continue;
                };
                let from = OutputSource::Link(Link { node: group, output: name });
                let output = Box::new(GraphOutput { from, ..found.clone() });
                leaving.push(Edit::ChangeOutput { name: promoted, output });
            }
        }
        Ok(leaving)
    }

    /// The output of the body that brings an output of a node out; `None` where its type is not known.
    fn output(
        &mut self,
        new_ids: &BTreeMap<NodeId, NodeId>,
        names: &mut BTreeMap<(NodeId, String), String>,
        old: NodeId,
        output: &str,
    ) -> Result<Option<String>, GroupError> {
        let key = (old, output.to_owned());
        if let Some(name) = names.get(&key) {
            return Ok(Some(name.clone()));
        }
        let node = self.graph.node(old);
        let spec = node.and_then(|node| node.kind()).and_then(|kind| kind.find_output(output)).map(|(_, spec)| spec);
        let (Some(spec), Some(node), Some(id)) = (spec, node, new_ids.get(&old)) else { return Ok(None) };
        let name = free_name(output, |name| self.body.output(name).is_some(), node.name());
        let declared = GraphOutput::new(&name, *id, output).describe(&spec.description);
        let index = self.body.outputs().len();
        self.apply(&Edit::AddOutput { index, output: Box::new(declared) })?;
        names.insert(key, name.clone());
        Ok(Some(name))
    }
}
