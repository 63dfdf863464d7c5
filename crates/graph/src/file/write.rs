//! From a graph to text: stable order, one value a line.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use crate::file::FORMAT_VERSION;
use crate::file::tree::FileTree;
use crate::graph::{Graph, Node, NodeId, Source};
use crate::literal::{Literal, Stroke, StrokePoint};

/// The graph as the text of a file. Reading it back gives an equal graph, and writing that the same text.
pub fn to_text(graph: &Graph) -> String {
    let mut out = String::from("(\n");
    // A version that could not be read stays, or the file would claim to be what it is not.
    let version = graph.unknown_fields.iter().find(|(name, _)| name == "version");
    let version = version.map_or_else(|| FORMAT_VERSION.to_string(), |(_, raw)| raw.clone());
    line(&mut out, 1, &format!("version: {version},"));
    if !graph.notes.is_empty() {
        line(&mut out, 1, &format!("notes: {},", quoted(&graph.notes)));
    }
    line(&mut out, 1, "nodes: {");
    for (_, node) in graph.nodes() {
        write_node(&mut out, graph, node);
    }
    line(&mut out, 1, "},");
    let placed: Vec<_> = graph.nodes().filter_map(|(_, n)| Some((n.name(), n.position()?))).collect();
    if !placed.is_empty() || !graph.unknown_layout.is_empty() {
        line(&mut out, 1, "layout: {");
        for (name, [x, y]) in placed {
            line(&mut out, 2, &format!("{}: ({}, {}),", quoted(name), number(x), number(y)));
        }
        let replaced = |name: &str| graph.find(name).and_then(|id| graph.node(id)?.position()).is_some();
        for (name, raw) in graph.unknown_layout.iter().filter(|(name, _)| !replaced(name)) {
            line(&mut out, 2, &format!("{}: {raw},", quoted(name)));
        }
        line(&mut out, 1, "},");
    }
    for (name, raw) in &graph.unknown_fields {
        let replaced = name == "version" || (name == "notes" && !graph.notes.is_empty());
        if !replaced {
            line(&mut out, 1, &format!("{}: {raw},", identifier(name)));
        }
    }
    out.push_str(")\n");
    out
}

/// Some nodes as the text of a graph. Links from nodes that are not among them stay in the text, by name.
pub(crate) fn selection_to_text(graph: &Graph, nodes: &BTreeSet<NodeId>) -> String {
    let nodes: Vec<_> = nodes.iter().filter_map(|id| graph.node(*id)).collect();
    let mut out = String::from("(\n");
    line(&mut out, 1, &format!("version: {FORMAT_VERSION},"));
    line(&mut out, 1, "nodes: {");
    for node in &nodes {
        write_node(&mut out, graph, node);
    }
    line(&mut out, 1, "},");
    if nodes.iter().any(|node| node.position().is_some()) {
        line(&mut out, 1, "layout: {");
        for (name, [x, y]) in nodes.iter().filter_map(|node| Some((node.name(), node.position()?))) {
            line(&mut out, 2, &format!("{}: ({}, {}),", quoted(name), number(x), number(y)));
        }
        line(&mut out, 1, "},");
    }
    out.push_str(")\n");
    out
}

fn write_node(out: &mut String, graph: &Graph, node: &Node) {
    line(out, 2, &format!("{}: (", quoted(node.name())));
    // Without a kind it was missing in the file, or is among the unknown fields because it was no text.
    if !node.kind_name().is_empty() {
        line(out, 3, &format!("kind: {},", quoted(node.kind_name())));
    }
    if !node.note().is_empty() {
        line(out, 3, &format!("note: {},", quoted(node.note())));
    }
    let declared = node.kind().map(|kind| kind.inputs()).unwrap_or_default();
    let place = |name: &str| declared.iter().position(|spec| spec.name == name).unwrap_or(usize::MAX);
    let mut sources: Vec<_> = node.sources().collect();
    // Stable, so that inputs which the kind does not declare stay in the order of their names, behind the others.
    sources.sort_by_key(|(name, _)| place(name));
    if !sources.is_empty() {
        line(out, 3, "inputs: {");
        for (name, source) in sources {
            write_input(out, graph, name, source);
        }
        line(out, 3, "},");
    }
    for (name, raw) in &node.unknown_fields {
        let replaced = name == "note" && !node.note().is_empty();
        if !replaced {
            line(out, 3, &format!("{}: {raw},", identifier(name)));
        }
    }
    line(out, 2, "),");
}

fn write_input(out: &mut String, graph: &Graph, name: &str, source: &Source) {
    let value = match source {
        Source::Unread(raw) => raw.clone(),
        Source::Link(link) => {
            let from = graph.node(link.node).map_or("", Node::name);
            format!("Link({})", quoted(&format!("{from}.{}", link.output)))
        }
        Source::Literal { literal: Literal::Strokes(strokes), .. } => return write_strokes(out, name, strokes),
        Source::Literal { literal, .. } => match literal {
            Literal::Number(value) => number(*value),
            Literal::Integer(value) => value.to_string(),
            Literal::Boolean(value) => value.to_string(),
            Literal::Text(text) => format!("Text({})", quoted(text)),
            Literal::Choice(option) => format!("Choice({})", quoted(option)),
            Literal::File(path) => format!("File({})", quoted(path)),
            Literal::Vector(vector) => format!("Vector({})", numbers(vector)),
            Literal::Colour(colour) => format!("Colour({})", numbers(colour)),
            Literal::Strokes(_) => return,
        },
    };
    line(out, 4, &format!("{}: {value},", quoted(name)));
}

fn write_strokes(out: &mut String, name: &str, strokes: &[Stroke]) {
    line(out, 4, &format!("{}: Strokes([", quoted(name)));
    for stroke in strokes {
        line(out, 5, "(");
        line(out, 6, &format!("name: {},", quoted(&stroke.name)));
        line(out, 6, &format!("closed: {},", stroke.closed));
        line(out, 6, "points: [");
        for StrokePoint { x, y, pressure } in &stroke.points {
            let numbers = match pressure {
                Some(pressure) => numbers(&[*x, *y, *pressure]),
                None => numbers(&[*x, *y]),
            };
            line(out, 7, &format!("({numbers}),"));
        }
        line(out, 6, "],");
        line(out, 5, "),");
    }
    line(out, 4, "]),");
}

fn line(out: &mut String, depth: usize, text: &str) {
    for _ in 0..depth {
        out.push_str("    ");
    }
    out.push_str(text);
    out.push('\n');
}

pub(crate) fn quoted(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 2);
    out.push('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => {
                out.push('\\');
                out.push(c);
            }
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            '\r' => out.push_str("\\r"),
            c if c.is_control() => {
                let _ = write!(out, "\\u{{{:x}}}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// A field's name; one that is no plain identifier is written raw.
fn identifier(name: &str) -> String {
    let ascii = name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    // Which other characters may stand plainly is for RON to say.
    let reads_back =
        || ron::from_str::<FileTree<'_>>(&format!("({name}: 0)")).is_ok_and(|t| t.unknown.iter().any(|f| f.0 == name));
    if ascii || reads_back() { name.to_owned() } else { format!("r#{name}") }
}

/// The shortest text that reads back as the same number.
pub(crate) fn number(value: f64) -> String {
    format!("{value:?}")
}

fn numbers(values: &[f64]) -> String {
    values.iter().map(|v| number(*v)).collect::<Vec<_>>().join(", ")
}
