//! The nodes within a node back into its graph.

use std::collections::BTreeMap;

use crate::body::{BodySource, Repeat};
use crate::catalogue::Catalogue;
use crate::edit::compound::{Plan, input_wire, output_wire};
use crate::edit::fresh_name::FreshNames;
use crate::edit::{Edit, NodeRecord};
use crate::graph::{Graph, GraphError, Link, NodeId, Source};
use crate::interface::{GraphOutput, OutputSource};
use crate::node_kind::NodeKind;
use crate::value::WireType;

/// Why a node can't be ungrouped.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum UngroupError {
    /// The node is gone.
    #[error(transparent)]
    Graph(#[from] GraphError),
    /// It has no body that could be used.
    #[error("node \"{0}\" has no graph within that could be taken out")]
    NoBody(String),
    /// The body is a file, which others may include too.
    #[error("the body of \"{node}\" is the file {file}, which stays as it is: only an embedded body can be ungrouped")]
    File {
        /// The node.
        node: String,
        /// The file.
        file: String,
    },
    /// The body is evaluated many times.
    #[error("\"{0}\" repeats its body, which nodes outside can't do: make it a node of kind graph first")]
    Repeated(String),
    /// The node passes its inputs on, which the nodes within would not do.
    #[error("\"{0}\" is muted: unmute it first")]
    Muted(String),
}

/// Replaces a node of kind `graph` with an embedded body by the nodes within, under fresh names where theirs are taken.
/// Where they held a parameter, they hold what the node held at that input. What can't be kept is remarked on.
///
/// # Errors
/// No such node, or none whose body could be taken out.
pub fn ungroup(graph: &Graph, catalogue: &Catalogue, id: NodeId) -> Result<Plan, UngroupError> {
    let node = graph.node(id).ok_or(GraphError::NoSuchNode)?;
    let name = || node.name().to_owned();
    let (Some(body), Some(kind)) = (node.body(), node.kind()) else { return Err(UngroupError::NoBody(name())) };
    if let BodySource::File(file) = body.source() {
        return Err(UngroupError::File { node: name(), file: file.clone() });
    }
    if *body.repeat() != Repeat::Once {
        return Err(UngroupError::Repeated(name()));
    }
    if node.is_muted() {
        return Err(UngroupError::Muted(name()));
    }
    let inner = body.graph().ok_or_else(|| UngroupError::NoBody(name()))?;
    let new_ids: BTreeMap<NodeId, NodeId> =
        (0..).zip(inner.nodes()).map(|(i, (old, _))| (old, graph.id_after(i))).collect();
    let mut plan = Plan { edits: vec![Edit::RemoveNode(id)], ..Plan::default() };
    let mut links = Vec::new();
    let mut names = FreshNames::new(graph);
    let offset = offset(node.position(), inner);
    for (old, within) in inner.nodes() {
        let Some(new) = new_ids.get(&old).copied() else { continue };
        let mut record = NodeRecord::of_node(within);
        record.id = Some(new);
        record.name = names.give(within.name());
        record.shift(offset);
        for (input, source) in std::mem::take(&mut record.inputs) {
            let wanted = within.kind().and_then(|kind| Some(kind.find_input(&input)?.wire));
            let kept = match source {
                Source::Link(link) => {
                    let from = new_ids.get(&link.node).copied();
                    links.extend(from.map(|from| Edit::connect(from, link.output, new, input)));
                    continue;
                }
                Source::Parameter(parameter) => held(graph, catalogue, id, kind, &parameter, wanted),
                other => Ok(Some(other)),
            };
            match kept {
                Ok(Some(Source::Link(link))) => links.push(Edit::connect(link.node, link.output, new, input)),
                Ok(Some(source)) => match fits(within.kind(), &input, source) {
                    Ok(source) => drop(record.inputs.insert(input, source)),
                    Err(reason) => plan.remark(&record.name, &input, format!("what it held is dropped: {reason}")),
                },
                Ok(None) => {}
                Err(reason) => plan.remark(&record.name, &input, format!("what it held is dropped: {reason}")),
            }
        }
        plan.nodes.push(new);
        plan.edits.push(Edit::AddNode(Box::new(record)));
    }
    plan.edits.append(&mut links);
    let from = |output: &str| {
        let link = inner.output(output)?.link()?;
        Some(Link { node: *new_ids.get(&link.node)?, output: link.output.clone() })
    };
    for outgoing in NodeRecord::outgoing_of(graph, id) {
        match from(&outgoing.output) {
            Some(link) => plan.edits.push(Edit::connect(link.node, link.output, outgoing.to, outgoing.input)),
            None => {
                let to = graph.node(outgoing.to).map_or("", |node| node.name());
                plan.remark(to, &outgoing.input, "its link goes: what it came from is not there");
            }
        }
    }
    for (promoted, output) in NodeRecord::promoted_of(graph, id) {
        if let Some((link, found)) = from(&output).zip(graph.output(&promoted)) {
            let output = Box::new(GraphOutput { from: OutputSource::Link(link), ..found.clone() });
            plan.edits.push(Edit::ChangeOutput { name: promoted, output });
        }
    }
    Ok(plan)
}

/// Moves the nodes to where the node is that they come out of.
fn offset(at: Option<[f64; 2]>, inner: &Graph) -> [f64; 2] {
    let places: Vec<[f64; 2]> = inner.nodes().filter_map(|(_, node)| node.position()).collect();
    let least = |axis: usize| places.iter().map(|place| place[axis]).fold(f64::INFINITY, f64::min);
    match at {
        Some([x, y]) if !places.is_empty() => [x - least(0), y - least(1)],
        _ => [0.0, 0.0],
    }
}

/// What the node holds at the input that is this parameter; `None` for nothing.
fn held(
    graph: &Graph,
    catalogue: &Catalogue,
    id: NodeId,
    kind: &NodeKind,
    parameter: &str,
    wanted: Option<WireType>,
) -> Result<Option<Source>, String> {
    let converts = |given: Option<WireType>| match given.zip(wanted) {
        Some((given, wanted)) if !catalogue.fits(given, wanted) => Err(format!("it takes {wanted}, not {given}")),
        _ => Ok(()),
    };
    match graph.node(id).and_then(|node| node.source(parameter)) {
        Some(Source::Link(link)) => {
            converts(output_wire(graph, link).or_else(|| input_wire(graph, id, parameter)))?;
            Ok(Some(Source::Link(link.clone())))
        }
        Some(Source::Parameter(outer)) => {
            converts(graph.parameter(outer).map(|parameter| parameter.wire()))?;
            Ok(Some(Source::Parameter(outer.clone())))
        }
        Some(Source::Literal { literal, .. }) => Ok(Some(Source::literal(literal.clone()))),
        Some(Source::Unread(text)) => Err(format!("{text} is not understood")),
        None => Ok(kind.find_input(parameter).and_then(|spec| spec.default.clone()).map(Source::literal)),
    }
}

/// A literal that the input takes.
fn fits(kind: Option<&std::sync::Arc<NodeKind>>, input: &str, source: Source) -> Result<Source, String> {
    match (&source, kind.and_then(|kind| kind.find_input(input))) {
        (Source::Literal { literal, .. }, Some(spec)) => match spec.refuses(literal) {
            Some(reason) => Err(reason),
            None => Ok(Source::literal(spec.normal(literal.clone()))),
        },
        _ => Ok(source),
    }
}
