//! A node of another kind in place of one.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::body::{Body, GRAPH, Repeat};
use crate::catalogue::Catalogue;
use crate::edit::compound::{Plan, fit, input_wire, output_wire};
use crate::edit::{Edit, NodeRecord};
use crate::file::{Spelled, parse};
use crate::graph::{Graph, GraphError, Link, NodeId, Source};
use crate::node_kind::NodeKind;
use crate::port::InputSpec;

/// Replaces a node by one of another kind, which keeps its identity, name, place and note, and what fits: literals and
/// links at inputs of the same name; a link whose input is not there any more goes to the first free input of the very
/// type, and likewise for outputs. What moves and what is dropped is remarked on. Text of a placeholder that was not
/// understood is read again, as the new kind understands it.
///
/// # Errors
/// The node is gone; the kind is unknown.
pub fn replace_kind(graph: &Graph, catalogue: &Catalogue, id: NodeId, kind: &str) -> Result<Plan, GraphError> {
    let node = graph.node(id).ok_or(GraphError::NoSuchNode)?;
    let mut known = Graph::known_kind(catalogue, kind)?;
    let mut plan = Plan { nodes: vec![id], ..Plan::default() };
    let mut record = NodeRecord::of_node(node);
    if let Some(body) = record.body.take() {
        match body_for(&body, catalogue, &known) {
            Ok((body, its_kind)) => (record.body, known) = (Some(body), its_kind),
            Err(reason) => plan.remark(node.name(), "body", format!("the graph within is dropped: {reason}")),
        }
    }
    record.id = Some(id);
    kind.clone_into(&mut record.kind);
    record.placeholder = false;
    // A kind that could not be read is not what it is any more.
    record.unknown_fields.retain(|(field, _)| field != "kind" && (field != "body" || !known.has_body()));
    let mut homeless = Vec::new();
    let mut kept = BTreeMap::new();
    for (input, source) in std::mem::take(&mut record.inputs) {
        match (refit(graph, catalogue, &known, &input, source), known.find_input(&input)) {
            (Refit::Keeps(source), _) => drop(kept.insert(input, source)),
            (Refit::Fails(link, _), None) if link.is_some() => homeless.extend(link.map(|link| (input, link))),
            (Refit::Fails(_, reason), _) => plan.remark(node.name(), &input, reason),
        }
    }
    for (input, link) in homeless {
        let wire = output_wire(graph, &link);
        let free = known.inputs().iter().find(|spec| Some(spec.wire) == wire && !kept.contains_key(&spec.name));
        match free {
            Some(spec) => {
                plan.remark(node.name(), &input, format!("its link moves to the input \"{}\"", spec.name));
                kept.insert(spec.name.clone(), Source::Link(link));
            }
            None => plan.remark(node.name(), &input, no_input(&known)),
        }
    }
    record.inputs = kept;
    for mut outgoing in NodeRecord::outgoing_of(graph, id) {
        let wanted = input_wire(graph, outgoing.to, &outgoing.input);
        let to = graph.node(outgoing.to).map_or("", |node| node.name());
        let same = known.find_output(&outgoing.output).map(|(_, spec)| spec);
        if same.is_none_or(|spec| fit(catalogue, Some(spec.wire), wanted).is_none()) {
            let Some(other) = known.outputs().iter().find(|spec| Some(spec.wire) == wanted) else {
                let message = format!(
                    "the link from \"{}.{}\" is dropped: {kind} has none that fits",
                    node.name(),
                    outgoing.output
                );
                plan.remark(to, &outgoing.input, message);
                continue;
            };
            let message = format!("its link comes from \"{}.{}\" now", node.name(), other.name);
            plan.remark(to, &outgoing.input, message);
            outgoing.output.clone_from(&other.name);
        }
        record.outgoing.push(outgoing);
    }
    for (name, output) in NodeRecord::promoted_of(graph, id) {
        let wire = output_wire(graph, &Link { node: id, output: output.clone() });
        let same = known.find_output(&output).map(|(_, spec)| spec);
        match same.or_else(|| known.outputs().iter().find(|spec| Some(spec.wire) == wire)) {
            Some(spec) => record.promoted.push((name, spec.name.clone())),
            None => plan.remark(node.name(), &name, format!("the graph's output \"{name}\" comes from nothing then")),
        }
    }
    plan.edits = vec![Edit::RemoveNode(id), Edit::AddNode(Box::new(record))];
    Ok(plan)
}

/// The body as a node of another kind has it, and what that makes of the kind.
fn body_for(body: &Body, catalogue: &Catalogue, kind: &NodeKind) -> Result<(Arc<Body>, Arc<NodeKind>), String> {
    if !kind.has_body() {
        return Err(format!("{} has none", kind.name()));
    }
    let repeat = match (kind.name(), body.repeat()) {
        (GRAPH, _) => Repeat::Once,
        (_, Repeat::Once) => Repeat::Times,
        (_, other) => other.clone(),
    };
    let body = body.clone().repeated(repeat);
    let kind = body.kind(catalogue, kind.name()).map_err(|error| error.to_string())?;
    Ok((Arc::new(body), kind))
}

enum Refit {
    Keeps(Source),
    /// The link, where it was one, and why it can't stay.
    Fails(Option<Link>, String),
}

fn no_input(kind: &NodeKind) -> String {
    format!("what it holds is dropped: {} has no such input", kind.name())
}

/// What becomes of what an input holds if its node is of another kind.
fn refit(graph: &Graph, catalogue: &Catalogue, kind: &NodeKind, input: &str, source: Source) -> Refit {
    let spec = kind.find_input(input);
    match source {
        Source::Link(link) => match spec {
            Some(spec) if fit(catalogue, output_wire(graph, &link), Some(spec.wire)).is_some() => {
                Refit::Keeps(Source::Link(link))
            }
            Some(spec) => {
                let message = format!("its link is dropped: {} takes {} here", kind.name(), spec.wire);
                Refit::Fails(Some(link), message)
            }
            None => Refit::Fails(Some(link), no_input(kind)),
        },
        Source::Parameter(name) => {
            let wire = graph.parameter(&name).map(|parameter| parameter.wire());
            match spec {
                Some(spec) if fit(catalogue, wire, Some(spec.wire)).is_some() => Refit::Keeps(Source::Parameter(name)),
                Some(spec) => {
                    let message = format!("the parameter \"{name}\" no longer drives it: it takes {} here", spec.wire);
                    Refit::Fails(None, message)
                }
                None => Refit::Fails(None, no_input(kind)),
            }
        }
        Source::Literal { literal, .. } => match spec {
            Some(spec) => literal_fits(spec, Source::literal(literal)),
            None => Refit::Fails(None, no_input(kind)),
        },
        Source::Unread(text) => match (spec, parse(&text)) {
            (Some(spec), Ok(Spelled::Literal(literal))) => literal_fits(spec, Source::literal(literal)),
            (Some(_), _) => Refit::Fails(None, format!("{text} is dropped: it can't be read")),
            (None, _) => Refit::Fails(None, no_input(kind)),
        },
    }
}

fn literal_fits(spec: &InputSpec, source: Source) -> Refit {
    match &source {
        Source::Literal { literal, .. } => match spec.refuses(literal) {
            Some(reason) => Refit::Fails(None, format!("what it holds is dropped: {reason}")),
            None => Refit::Keeps(source),
        },
        _ => Refit::Keeps(source),
    }
}
