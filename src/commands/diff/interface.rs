//! What differs in what graphs take and give as a whole, and in the graphs within nodes.

use std::collections::BTreeSet;

use maquette_graph::{BodySource, Graph, GraphOutput, Node, OutputSource, Parameter, Range, Repeat, Unit};

use super::differences::{Difference, differences};
use super::input::spelled_literal;
use super::pairing::pair;

/// Parameters and outputs that differ.
pub(super) fn declarations(found: &mut Vec<Difference>, first: &Graph, second: &Graph) {
    for name in names(second.parameters().map(Parameter::name), first.parameters().map(Parameter::name)) {
        let (from, to) = (first.parameter(name), second.parameter(name));
        let (from, to) = (from.map(declared), to.map(declared));
        if from != to {
            found.push(Difference::Parameter { parameter: name.to_owned(), from, to });
        }
    }
    for name in names(second.outputs().map(GraphOutput::name), first.outputs().map(GraphOutput::name)) {
        let from = first.output(name).map(|output| given(first, output));
        let to = second.output(name).map(|output| given(second, output));
        if from != to {
            found.push(Difference::Output { output: name.to_owned(), from, to });
        }
    }
}

/// Whether it is muted, and what it has within.
pub(super) fn within(found: &mut Vec<Difference>, a: &Node, b: &Node, layout: bool) {
    let node = b.name().to_owned();
    if a.is_muted() != b.is_muted() {
        found.push(Difference::Muted { node: node.clone(), muted: b.is_muted() });
    }
    let (from, to) = (body(a), body(b));
    if from != to {
        found.push(Difference::Body { node: node.clone(), from, to });
    }
    let embedded = |node: &Node| node.body().filter(|body| *body.source() == BodySource::Embedded).cloned();
    let (Some(a), Some(b)) = (embedded(a), embedded(b)) else { return };
    if let (Some(first), Some(second)) = (a.graph(), b.graph()) {
        let inner = differences(first, second, &pair(first, second), layout);
        found.extend(
            inner
                .into_iter()
                .map(|difference| Difference::Within { node: node.clone(), difference: Box::new(difference) }),
        );
    }
}

fn names<'a>(second: impl Iterator<Item = &'a str>, first: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut seen = BTreeSet::new();
    second.chain(first).filter(|name| seen.insert(*name)).collect()
}

/// A parameter as a file spells it, on one line.
pub(super) fn declared(parameter: &Parameter) -> String {
    let spec = parameter.spec();
    let range = |name: &str, range: Option<Range>| range.map(|r| format!("{name}: ({:?}, {:?})", r.min, r.max));
    let options: Vec<_> = spec.options.iter().map(|o| format!("({:?}, {:?})", o.name, o.description)).collect();
    let fields = [
        Some(match parameter.value() {
            Some(value) => format!("value: {}", spelled_literal(value)),
            None => format!("type: {:?}", spec.wire.name()),
        }),
        range("range", spec.range),
        range("soft_range", spec.soft_range),
        (spec.unit != Unit::None).then(|| format!("unit: {:?}", spec.unit.to_string())),
        spec.optional.then(|| "optional: true".to_owned()),
        (!options.is_empty()).then(|| format!("options: [{}]", options.join(", "))),
        (!spec.extensions.is_empty()).then(|| format!("extensions: {:?}", spec.extensions)),
        (!spec.description.is_empty()).then(|| format!("description: {:?}", spec.description)),
    ];
    let unknown = parameter.unknown_fields().map(|(name, text)| format!("{name}: {text}"));
    let fields: Vec<_> = fields.into_iter().flatten().chain(unknown).collect();
    format!("({})", fields.join(", "))
}

/// An output as a file spells it, on one line.
fn given(graph: &Graph, output: &GraphOutput) -> String {
    let from = match output.source() {
        OutputSource::Link(link) => {
            let name = graph.node(link.node).map_or("", Node::name);
            format!("from: {:?}", format!("{name}.{}", link.output))
        }
        OutputSource::Unread(text) => format!("from: {text}"),
        OutputSource::Nothing => "from nothing".to_owned(),
    };
    let text = output.description();
    if text.is_empty() { format!("({from})") } else { format!("({from}, description: {text:?})") }
}

/// Where a body stands and how often it is evaluated; nothing for a node without one.
fn body(node: &Node) -> String {
    let Some(body) = node.body() else { return "nothing".to_owned() };
    let source = match body.source() {
        BodySource::Embedded => "embedded".to_owned(),
        BodySource::File(path) => format!("File({path:?})"),
    };
    match body.repeat() {
        Repeat::Once => source,
        Repeat::Times => format!("{source}, repeated"),
        Repeat::Each(parameter) => format!("{source}, each {parameter:?}"),
        Repeat::FeedBack(pairs) => format!("{source}, feed_back {pairs:?}"),
    }
}
