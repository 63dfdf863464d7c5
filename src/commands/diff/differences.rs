//! What differs between two graphs, whatever the order in which their files say it.

use std::collections::{BTreeMap, BTreeSet};

use maquette_graph::{Graph, Literal, Node, NodeId};
use serde::Serialize;

use super::input::{Held, held, spelled};
use super::interface;
use super::pairing::Pairing;
use super::strokes::{self, StrokeDifference};

/// One difference. Nodes that are in both graphs go by the name that they have in the second.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "what", rename_all = "kebab-case")]
pub(super) enum Difference {
    NodeRemoved {
        node: String,
        kind: String,
    },
    NodeAdded {
        node: String,
        kind: String,
    },
    /// The same kind with the same inputs has another name.
    NodeRenamed {
        from: String,
        to: String,
        kind: String,
    },
    Kind {
        node: String,
        from: String,
        to: String,
    },
    /// A value or a link.
    Input {
        node: String,
        input: String,
        from: String,
        to: String,
    },
    Strokes {
        node: String,
        input: String,
        strokes: Vec<StrokeDifference>,
    },
    /// The remark on a node, or on the whole graph.
    Note {
        node: Option<String>,
        from: String,
        to: String,
    },
    /// A field that this version does not know.
    Field {
        node: Option<String>,
        field: String,
        from: Option<String>,
        to: Option<String>,
    },
    /// A parameter of the graph, as a file spells it.
    Parameter {
        parameter: String,
        from: Option<String>,
        to: Option<String>,
    },
    /// An output of the graph, as a file spells it.
    Output {
        output: String,
        from: Option<String>,
        to: Option<String>,
    },
    Muted {
        node: String,
        muted: bool,
    },
    /// Where the graph within a node stands, and how often it is evaluated.
    Body {
        node: String,
        from: String,
        to: String,
    },
    /// In the graph that is embedded in a node.
    Within {
        node: String,
        difference: Box<Difference>,
    },
    /// Where the editor draws a node.
    Layout {
        node: String,
        from: Option<[f64; 2]>,
        to: Option<[f64; 2]>,
    },
}

/// All differences between two graphs: nodes first, then what is within them, in the order of the second graph.
pub(super) fn differences(first: &Graph, second: &Graph, pairing: &Pairing, layout: bool) -> Vec<Difference> {
    let mut found = Vec::new();
    let name = |graph: &Graph, id: NodeId| graph.node(id).map_or("", Node::name).to_owned();
    let kind = |graph: &Graph, id: NodeId| graph.node(id).map_or("", Node::kind_name).to_owned();
    for id in &pairing.removed {
        found.push(Difference::NodeRemoved { node: name(first, *id), kind: kind(first, *id) });
    }
    for id in &pairing.added {
        found.push(Difference::NodeAdded { node: name(second, *id), kind: kind(second, *id) });
    }
    for (a, b) in &pairing.both {
        let (from, to) = (name(first, *a), name(second, *b));
        if from != to {
            found.push(Difference::NodeRenamed { from, to, kind: kind(second, *b) });
        }
    }
    if first.notes != second.notes {
        found.push(Difference::Note { node: None, from: first.notes.clone(), to: second.notes.clone() });
    }
    interface::declarations(&mut found, first, second);
    fields(&mut found, None, first.unknown_fields(), second.unknown_fields());
    for (a, b) in &pairing.both {
        if let (Some(a), Some(b)) = (first.node(*a), second.node(*b)) {
            within(&mut found, [first, second], pairing, a, b);
            interface::within(&mut found, a, b, layout);
            if layout && a.position() != b.position() {
                found.push(Difference::Layout { node: b.name().to_owned(), from: a.position(), to: b.position() });
            }
        }
    }
    found
}

fn within(found: &mut Vec<Difference>, graphs: [&Graph; 2], pairing: &Pairing, a: &Node, b: &Node) {
    let node = b.name().to_owned();
    if a.kind_name() != b.kind_name() {
        let (from, to) = (a.kind_name().to_owned(), b.kind_name().to_owned());
        found.push(Difference::Kind { node: node.clone(), from, to });
    }
    if a.note() != b.note() {
        let (from, to) = (a.note().to_owned(), b.note().to_owned());
        found.push(Difference::Note { node: Some(node.clone()), from, to });
    }
    for input in inputs(a, b) {
        let (before, after) = (held(a, &input), held(b, &input));
        let same = match (&before, &after) {
            (Held::Nothing, Held::Nothing) => true,
            (Held::Literal(_, before), Held::Literal(_, after)) => before == after,
            (Held::Link(before), Held::Link(after)) => {
                before.output == after.output && pairing.second_of.get(&before.node) == Some(&after.node)
            }
            (Held::Parameter(before), Held::Parameter(after)) => before == after,
            (Held::Unread(before), Held::Unread(after)) => before == after,
            _ => false,
        };
        if same {
            continue;
        }
        let node = node.clone();
        found.push(match (&before, &after) {
            (Held::Literal(Literal::Strokes(before), _), Held::Literal(Literal::Strokes(after), _)) => {
                Difference::Strokes { node, input, strokes: strokes::compare(before, after) }
            }
            _ => Difference::Input { node, input, from: spelled(graphs[0], &before), to: spelled(graphs[1], &after) },
        });
    }
    fields(found, Some(&node), a.unknown_fields(), b.unknown_fields());
}

/// Inputs that one of the two declares or holds, those that the second declares first and in its order.
fn inputs(a: &Node, b: &Node) -> Vec<String> {
    let mut names = Vec::new();
    let mut seen = BTreeSet::new();
    // A default that only one kind has is no difference of its own.
    let declared = |node: &Node| node.kind().into_iter().flat_map(|k| k.inputs()).map(|i| i.name.clone()).collect();
    let both: Vec<String> = if a.kind_name() == b.kind_name() { declared(b) } else { Vec::new() };
    let held = b.sources().chain(a.sources()).map(|(name, _)| name.to_owned());
    for name in both.into_iter().chain(held) {
        if seen.insert(name.clone()) {
            names.push(name);
        }
    }
    names
}

fn fields<'a>(
    found: &mut Vec<Difference>,
    node: Option<&str>,
    from: impl Iterator<Item = (&'a str, &'a str)>,
    to: impl Iterator<Item = (&'a str, &'a str)>,
) {
    let (from, to): (BTreeMap<_, _>, BTreeMap<_, _>) = (from.collect(), to.collect());
    for field in from.keys().chain(to.keys()).collect::<BTreeSet<_>>() {
        let (before, after) = (from.get(field), to.get(field));
        if before != after {
            found.push(Difference::Field {
                node: node.map(str::to_owned),
                field: (*field).to_owned(),
                from: before.map(|text| (*text).to_owned()),
                to: after.map(|text| (*text).to_owned()),
            });
        }
    }
}
