//! What an input holds, whether it is written out or not.

use maquette_graph::{ContentHash, Graph, Link, Literal, Node, Source};

/// What an input holds.
pub(super) enum Held<'a> {
    Nothing,
    /// A value, written or by default, with its hash.
    Literal(&'a Literal, ContentHash),
    Link(&'a Link),
    Parameter(&'a str),
    /// Text that is not understood.
    Unread(&'a str),
}

pub(super) fn held<'a>(node: &'a Node, input: &str) -> Held<'a> {
    match node.source(input) {
        Some(Source::Literal { literal, value }) => Held::Literal(literal, value.hash()),
        Some(Source::Link(link)) => Held::Link(link),
        Some(Source::Parameter(name)) => Held::Parameter(name),
        Some(Source::Unread(text)) => Held::Unread(text),
        None => match node.kind().and_then(|kind| kind.find_input(input)?.default.as_ref()) {
            Some(literal) => Held::Literal(literal, literal.to_value().hash()),
            None => Held::Nothing,
        },
    }
}

/// Hash of what the input holds when nothing is written.
pub(super) fn default_hash(node: &Node, input: &str) -> Option<ContentHash> {
    node.kind()?.find_input(input)?.default.as_ref().map(|default| default.to_value().hash())
}

/// What is held, on one line.
pub(super) fn spelled(graph: &Graph, held: &Held<'_>) -> String {
    match held {
        Held::Nothing => "nothing".to_owned(),
        Held::Unread(text) => text.split_whitespace().collect::<Vec<_>>().join(" "),
        Held::Link(link) => {
            let name = graph.node(link.node).map_or("", Node::name);
            format!("Link({:?})", format!("{name}.{}", link.output))
        }
        Held::Parameter(name) => format!("Parameter({name:?})"),
        Held::Literal(literal, _) => spelled_literal(literal),
    }
}

/// A value as a file spells it, on one line.
pub(in crate::commands) fn spelled_literal(literal: &Literal) -> String {
    match literal {
        Literal::Number(number) => format!("{number:?}"),
        Literal::Integer(integer) => integer.to_string(),
        Literal::Boolean(flag) => flag.to_string(),
        Literal::Text(text) => format!("Text({text:?})"),
        Literal::Choice(option) => format!("Choice({option:?})"),
        Literal::File(path) => format!("File({path:?})"),
        Literal::Vector([x, y, z]) => format!("Vector({x:?}, {y:?}, {z:?})"),
        Literal::Colour([r, g, b, a]) => format!("Colour({r:?}, {g:?}, {b:?}, {a:?})"),
        Literal::Strokes(strokes) => format!("{} strokes", strokes.len()),
    }
}
