//! `--set NODE.PORT=VALUE`: values from the command line, read by the type of their port.

use maquette_graph::file::parse_literal;
use maquette_graph::{Graph, Literal, LiteralKind};

/// Puts a value given on the command line into the graph, and gives it as it was understood.
///
/// Texts, choices and files are written bare, vectors and colours as numbers separated by commas; anything may also be
/// written as in a graph file. A relative path starts at the current folder.
pub(super) fn apply(graph: &mut Graph, assignment: &str) -> Result<Literal, String> {
    let fail = |reason: String| format!("--set {assignment}: {reason}");
    let (address, value) = assignment.split_once('=').ok_or_else(|| fail("write it as NODE.PORT=VALUE".to_owned()))?;
    let (name, port) = address.rsplit_once('.').ok_or_else(|| fail("write it as NODE.PORT=VALUE".to_owned()))?;
    let node = graph.find(name).ok_or_else(|| {
        let hint = graph.suggest(name).map(|s| format!("; did you mean \"{s}\"?")).unwrap_or_default();
        fail(format!("no node is named \"{name}\"{hint}"))
    })?;
    let kind = graph.node(node).and_then(|n| n.kind().cloned());
    // A script may be as old as a file.
    let spec = kind.as_ref().and_then(|k| k.current_input(port)).ok_or_else(|| {
        let known = kind.iter().flat_map(|k| k.inputs()).map(|i| i.name.as_str()).collect::<Vec<_>>().join(", ");
        fail(format!("node \"{name}\" has no input \"{port}\"; it has {known}"))
    })?;
    let wanted = LiteralKind::of_wire(spec.wire)
        .ok_or_else(|| fail(format!("the input takes {} from a link; a value can't be given", spec.wire)))?;
    let literal = literal(wanted, value).map_err(fail)?;
    graph.set(node, &spec.name, literal.clone()).map_err(|error| fail(error.to_string()))?;
    Ok(literal)
}

fn literal(wanted: LiteralKind, value: &str) -> Result<Literal, String> {
    if let Ok(literal) = parse_literal(value)
        && (literal.kind() == wanted || wanted == LiteralKind::Number)
        && (wanted != LiteralKind::Text || value.starts_with("Text("))
    {
        return Ok(literal);
    }
    match wanted {
        LiteralKind::Number => {
            value.parse().map(Literal::Number).map_err(|_| format!("\"{value}\" is not a number, such as 0.5"))
        }
        LiteralKind::Integer => {
            value.parse().map(Literal::Integer).map_err(|_| format!("\"{value}\" is not a whole number, such as 64"))
        }
        LiteralKind::Boolean => Err(format!("\"{value}\" is neither true nor false")),
        LiteralKind::Text => Ok(Literal::Text(value.to_owned())),
        LiteralKind::Choice => Ok(Literal::Choice(value.to_owned())),
        LiteralKind::Vector => numbers(value)
            .map(Literal::Vector)
            .ok_or_else(|| format!("\"{value}\" is not three numbers separated by commas, such as 0,0.1,0")),
        LiteralKind::Colour => numbers(value)
            .or_else(|| numbers(value).map(|[r, g, b]: [f64; 3]| [r, g, b, 1.0]))
            .map(Literal::Colour)
            .ok_or_else(|| format!("\"{value}\" is not three or four numbers separated by commas, such as 1,0.5,0")),
        LiteralKind::File => {
            let path = std::path::absolute(value).map_err(|error| format!("\"{value}\" is no path: {error}"))?;
            Ok(Literal::File(path.to_string_lossy().into_owned()))
        }
        LiteralKind::Strokes => parse_literal(value).map_err(|error| error.to_string()),
    }
}

fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let parts = text.split(',').map(|part| part.trim().parse().ok()).collect::<Option<Vec<f64>>>()?;
    parts.try_into().ok()
}
