//! From a graph to text: stable order, one value a line.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use crate::body::{Body, BodySource, Repeat};
use crate::file::FORMAT_VERSION;
use crate::file::limit::Meter;
use crate::file::tree::take_apart;
use crate::graph::{Graph, Node, NodeId, Source};
use crate::interface::OutputSource;
use crate::literal::{Literal, Stroke, StrokePoint};
use crate::parameter::Parameter;
use crate::port::Unit;

/// The graph as the text of a file. Reading it back gives an equal graph, and writing that the same text.
pub fn to_text(graph: &Graph) -> String {
    let mut out = String::from("(\n");
    // A version that could not be read stays, or the file would claim to be what it is not.
    let version = graph.unknown_fields.iter().find(|(name, _)| name == "version");
    let version = version.map_or_else(|| FORMAT_VERSION.to_string(), |(_, raw)| raw.clone());
    line(&mut out, 1, &format!("version: {version},"));
    write_kind_versions(&mut out, graph);
    write_graph(&mut out, 1, graph, false);
    out.push_str(")\n");
    out
}

/// The versions of kinds whose defaults were other ones before: without them, the file would mean something else when
/// defaults change again.
fn write_kind_versions(out: &mut String, graph: &Graph) {
    let versions = graph.kind_versions();
    if !versions.is_empty() {
        line(out, 1, "kinds: {");
        for (kind, version) in versions {
            line(out, 2, &format!("{}: {version},", quoted(&kind)));
        }
        line(out, 1, "},");
    }
}

/// The fields of a graph, but for the version of its file.
fn write_graph(out: &mut String, depth: usize, graph: &Graph, embedded: bool) {
    if !graph.notes.is_empty() {
        line(out, depth, &format!("notes: {},", quoted(&graph.notes)));
    }
    write_parameters(out, depth, graph.parameters(), &graph.unread_parameters);
    line(out, depth, "nodes: {");
    for (_, node) in graph.nodes() {
        write_node(out, depth + 1, graph, node);
    }
    line(out, depth, "},");
    write_outputs(out, depth, graph);
    let placed: Vec<_> = graph.nodes().filter_map(|(_, n)| Some((n.name(), n.position()?))).collect();
    if !placed.is_empty() || !graph.unknown_layout.is_empty() {
        line(out, depth, "layout: {");
        for (name, [x, y]) in placed {
            line(out, depth + 1, &format!("{}: ({}, {}),", quoted(name), number(x), number(y)));
        }
        let replaced = |name: &str| graph.find(name).and_then(|id| graph.node(id)?.position()).is_some();
        for (name, raw) in graph.unknown_layout.iter().filter(|(name, _)| !replaced(name)) {
            line(out, depth + 1, &format!("{}: {raw},", quoted(name)));
        }
        line(out, depth, "},");
    }
    write_presentation(out, depth, graph);
    for (name, raw) in &graph.unknown_fields {
        let replaced = match name.as_str() {
            "version" => !embedded,
            "notes" => !graph.notes.is_empty(),
            "frames" => !graph.frames().is_empty(),
            "references" => !graph.references().is_empty(),
            _ => false,
        };
        if !replaced {
            line(out, depth, &format!("{}: {raw},", identifier(name)));
        }
    }
}

/// What only those who look at the graph ask for.
fn write_presentation(out: &mut String, depth: usize, graph: &Graph) {
    if !graph.frames().is_empty() {
        line(out, depth, "frames: [");
        for frame in graph.frames() {
            let [colour, at, size] = [&frame.colour[..], &frame.at, &frame.size].map(numbers);
            let title = quoted(&frame.title);
            line(out, depth + 1, &format!("(title: {title}, colour: ({colour}), at: ({at}), size: ({size})),"));
        }
        line(out, depth, "],");
    }
    if !graph.references().is_empty() {
        line(out, depth, "references: [");
        for picture in graph.references() {
            let flag = |name: &str, on: bool| if on { format!(", {name}: true") } else { String::new() };
            let text = format!(
                "(view: {}, file: {}, centre: ({}), width: {}, opacity: {}{}{}),",
                quoted(&picture.view),
                quoted(&picture.file),
                numbers(&picture.centre),
                number(picture.width),
                number(picture.opacity),
                flag("locked", picture.locked),
                flag("hidden", picture.hidden),
            );
            line(out, depth + 1, &text);
        }
        line(out, depth, "],");
    }
}

/// Some nodes as the text of a graph, with the parameters that they use. Links from nodes that are not among them stay in
/// the text, by name.
pub(crate) fn selection_to_text(graph: &Graph, nodes: &BTreeSet<NodeId>) -> String {
    let nodes: Vec<_> = nodes.iter().filter_map(|id| graph.node(*id)).collect();
    let mut out = String::from("(\n");
    line(&mut out, 1, &format!("version: {FORMAT_VERSION},"));
    write_kind_versions(&mut out, graph);
    let is_used = |name: &str| {
        let mut sources = nodes.iter().flat_map(|node| node.sources());
        sources.any(|(_, source)| matches!(source, Source::Parameter(used) if used == name))
    };
    write_parameters(&mut out, 1, graph.parameters().filter(|parameter| is_used(parameter.name())), &[]);
    line(&mut out, 1, "nodes: {");
    for node in &nodes {
        write_node(&mut out, 2, graph, node);
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

fn write_parameters<'a>(
    out: &mut String,
    depth: usize,
    parameters: impl Iterator<Item = &'a Parameter>,
    unread: &[(String, String)],
) {
    let mut parameters = parameters.peekable();
    if parameters.peek().is_none() && unread.is_empty() {
        return;
    }
    line(out, depth, "parameters: {");
    for parameter in parameters {
        write_parameter(out, depth + 1, parameter);
    }
    for (name, raw) in unread {
        line(out, depth + 1, &format!("{}: {raw},", quoted(name)));
    }
    line(out, depth, "},");
}

fn write_parameter(out: &mut String, depth: usize, parameter: &Parameter) {
    let spec = parameter.spec();
    line(out, depth, &format!("{}: (", quoted(parameter.name())));
    let field = |out: &mut String, name: &str, text: String| line(out, depth + 1, &format!("{name}: {text},"));
    match parameter.value() {
        // The value says its type.
        Some(value) => write_literal(out, depth + 1, "value", value),
        None => field(out, "type", quoted(spec.wire.name())),
    }
    for (name, range) in [("range", spec.range), ("soft_range", spec.soft_range)] {
        if let Some(range) = range {
            field(out, name, format!("({}, {})", number(range.min), number(range.max)));
        }
    }
    if spec.unit != Unit::None {
        field(out, "unit", quoted(&spec.unit.to_string()));
    }
    if spec.optional {
        field(out, "optional", "true".to_owned());
    }
    if !spec.options.is_empty() {
        line(out, depth + 1, "options: [");
        for option in &spec.options {
            line(out, depth + 2, &format!("({}, {}),", quoted(&option.name), quoted(&option.description)));
        }
        line(out, depth + 1, "],");
    }
    if !spec.extensions.is_empty() {
        let names: Vec<_> = spec.extensions.iter().map(|extension| quoted(extension)).collect();
        field(out, "extensions", format!("[{}]", names.join(", ")));
    }
    if !spec.description.is_empty() {
        field(out, "description", quoted(&spec.description));
    }
    for (name, raw) in &parameter.unknown_fields {
        field(out, &identifier(name), raw.clone());
    }
    line(out, depth, "),");
}

fn write_outputs(out: &mut String, depth: usize, graph: &Graph) {
    if graph.outputs().len() == 0 && graph.unread_outputs.is_empty() {
        return;
    }
    line(out, depth, "outputs: {");
    for output in graph.outputs() {
        line(out, depth + 1, &format!("{}: (", quoted(output.name())));
        match output.source() {
            OutputSource::Link(link) => {
                let from = graph.node(link.node).map_or("", Node::name);
                line(out, depth + 2, &format!("from: {},", quoted(&format!("{from}.{}", link.output))));
            }
            OutputSource::Unread(raw) => line(out, depth + 2, &format!("from: {raw},")),
            OutputSource::Nothing => {}
        }
        if !output.description().is_empty() {
            line(out, depth + 2, &format!("description: {},", quoted(output.description())));
        }
        for (name, raw) in &output.unknown_fields {
            line(out, depth + 2, &format!("{}: {raw},", identifier(name)));
        }
        line(out, depth + 1, "),");
    }
    for (name, raw) in &graph.unread_outputs {
        line(out, depth + 1, &format!("{}: {raw},", quoted(name)));
    }
    line(out, depth, "},");
}

fn write_node(out: &mut String, depth: usize, graph: &Graph, node: &Node) {
    line(out, depth, &format!("{}: (", quoted(node.name())));
    // Without a kind it was missing in the file, or is among the unknown fields because it was no text.
    if !node.kind_name().is_empty() {
        line(out, depth + 1, &format!("kind: {},", quoted(node.kind_name())));
    }
    if !node.note().is_empty() {
        line(out, depth + 1, &format!("note: {},", quoted(node.note())));
    }
    if node.is_muted() {
        line(out, depth + 1, "muted: true,");
    }
    if node.is_collapsed() {
        line(out, depth + 1, "collapsed: true,");
    }
    let declared = node.kind().map(|kind| kind.inputs()).unwrap_or_default();
    let place = |name: &str| declared.iter().position(|spec| spec.name == name).unwrap_or(usize::MAX);
    let mut sources: Vec<_> = node.sources().collect();
    // Stable, so that inputs which the kind does not declare stay in the order of their names, behind the others.
    sources.sort_by_key(|(name, _)| place(name));
    if !sources.is_empty() {
        line(out, depth + 1, "inputs: {");
        for (name, source) in sources {
            write_input(out, depth + 2, graph, name, source);
        }
        line(out, depth + 1, "},");
    }
    if let Some(body) = node.body() {
        write_body(out, depth + 1, body);
    }
    for (name, raw) in &node.unknown_fields {
        let replaced = (name == "note" && !node.note().is_empty())
            || (name == "muted" && node.is_muted())
            || (name == "collapsed" && node.is_collapsed())
            || is_of_body(node, name);
        if !replaced {
            line(out, depth + 1, &format!("{}: {raw},", identifier(name)));
        }
    }
    line(out, depth, "),");
}

/// Whether a field that could not be read was replaced by what the node's body says.
fn is_of_body(node: &Node, field: &str) -> bool {
    node.body().is_some_and(|body| match body.repeat() {
        Repeat::Each(_) => matches!(field, "body" | "each"),
        Repeat::FeedBack(_) => matches!(field, "body" | "feed_back"),
        Repeat::Once | Repeat::Times => field == "body",
    })
}

fn write_body(out: &mut String, depth: usize, body: &Body) {
    match body.repeat() {
        Repeat::Once | Repeat::Times => {}
        Repeat::Each(parameter) => line(out, depth, &format!("each: {},", quoted(parameter))),
        Repeat::FeedBack(pairs) => {
            line(out, depth, "feed_back: {");
            for (parameter, output) in pairs {
                line(out, depth + 1, &format!("{}: {},", quoted(parameter), quoted(output)));
            }
            line(out, depth, "},");
        }
    }
    match (body.source(), body.graph()) {
        (BodySource::File(path), _) => line(out, depth, &format!("body: File({}),", quoted(path))),
        (BodySource::Embedded, Some(graph)) => {
            line(out, depth, "body: (");
            write_graph(out, depth + 1, graph, true);
            line(out, depth, "),");
        }
        (BodySource::Embedded, None) => {}
    }
}

fn write_input(out: &mut String, depth: usize, graph: &Graph, name: &str, source: &Source) {
    let value = match source {
        Source::Unread(raw) => raw.clone(),
        Source::Link(link) => {
            let from = graph.node(link.node).map_or("", Node::name);
            format!("Link({})", quoted(&format!("{from}.{}", link.output)))
        }
        Source::Parameter(parameter) => format!("Parameter({})", quoted(parameter)),
        Source::Literal { literal, .. } => return write_literal(out, depth, &quoted(name), literal),
    };
    line(out, depth, &format!("{}: {value},", quoted(name)));
}

/// A literal in one piece, strokes on one line.
pub(super) fn spelled_literal(literal: &Literal) -> String {
    let mut out = String::new();
    write_literal(&mut out, 0, "", literal);
    let lines: Vec<_> = out.lines().map(str::trim).collect();
    lines.concat().trim_start_matches(": ").trim_end_matches(',').to_owned()
}

fn write_literal(out: &mut String, depth: usize, name: &str, literal: &Literal) {
    let value = match literal {
        Literal::Number(value) => number(*value),
        Literal::Integer(value) => value.to_string(),
        Literal::Boolean(value) => value.to_string(),
        Literal::Text(text) => format!("Text({})", quoted(text)),
        Literal::Choice(option) => format!("Choice({})", quoted(option)),
        Literal::File(path) => format!("File({})", quoted(path)),
        Literal::Vector(vector) => format!("Vector({})", numbers(vector)),
        Literal::Colour(colour) => format!("Colour({})", numbers(colour)),
        Literal::Strokes(strokes) => return write_strokes(out, depth, name, strokes),
    };
    line(out, depth, &format!("{name}: {value},"));
}

fn write_strokes(out: &mut String, depth: usize, name: &str, strokes: &[Stroke]) {
    line(out, depth, &format!("{name}: Strokes(["));
    for stroke in strokes {
        line(out, depth + 1, "(");
        line(out, depth + 2, &format!("name: {},", quoted(&stroke.name)));
        line(out, depth + 2, &format!("closed: {},", stroke.closed));
        line(out, depth + 2, "points: [");
        for StrokePoint { x, y, pressure } in &stroke.points {
            let numbers = match pressure {
                Some(pressure) => numbers(&[*x, *y, *pressure]),
                None => numbers(&[*x, *y]),
            };
            line(out, depth + 3, &format!("({numbers}),"));
        }
        line(out, depth + 2, "],");
        line(out, depth + 1, "),");
    }
    line(out, depth, "]),");
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
        || take_apart(&format!("({name}: 0)"), &Meter::default()).is_ok_and(|t| t.unknown.iter().any(|f| f.0 == name));
    if ascii || reads_back() { name.to_owned() } else { format!("r#{name}") }
}

/// The shortest text that reads back as the same number.
pub(crate) fn number(value: f64) -> String {
    format!("{value:?}")
}

fn numbers(values: &[f64]) -> String {
    values.iter().map(|v| number(*v)).collect::<Vec<_>>().join(", ")
}
