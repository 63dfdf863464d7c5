//! `--set NODE.PORT=VALUE`: values from the command line, read by the type of their port.

use maquette_graph::file::parse_literal;
use maquette_graph::{Graph, Literal, LiteralKind, NodeId};

/// Where a value that is given on the command line goes.
#[derive(Clone, Debug)]
pub(super) struct Place {
    node: NodeId,
    port: String,
    /// What kind of value it takes.
    pub(super) wanted: LiteralKind,
    /// The options of a choice.
    pub(super) options: Vec<String>,
}

/// Puts a value given on the command line into the graph.
///
/// Texts, choices and files are written bare, vectors and colours as numbers separated by commas; anything may also be
/// written as in a graph file. A relative path starts at the current folder.
pub(super) fn apply(graph: &mut Graph, assignment: &str) -> Result<(), String> {
    let fail = |reason: String| format!("--set {assignment}: {reason}");
    let (address, value) = assignment.split_once('=').ok_or_else(|| fail("write it as NODE.PORT=VALUE".to_owned()))?;
    let place = Place::find(graph, address).map_err(fail)?;
    let literal = place.read(value).map_err(fail)?;
    place.set(graph, literal).map_err(fail)
}

impl Place {
    /// The place of an address, `NODE.PORT`; why there is none is an error.
    pub(super) fn find(graph: &Graph, address: &str) -> Result<Self, String> {
        let (name, port) = address.rsplit_once('.').ok_or_else(|| "write it as NODE.PORT=VALUE".to_owned())?;
        let node = graph.find(name).ok_or_else(|| {
            let hint = graph.suggest(name).map(|s| format!("; did you mean \"{s}\"?")).unwrap_or_default();
            format!("no node is named \"{name}\"{hint}")
        })?;
        let kind = graph.node(node).and_then(|n| n.kind().cloned());
        let spec = kind.as_ref().and_then(|k| k.find_input(port)).ok_or_else(|| {
            let known = kind.iter().flat_map(|k| k.inputs()).map(|i| i.name.as_str()).collect::<Vec<_>>().join(", ");
            format!("node \"{name}\" has no input \"{port}\"; it has {known}")
        })?;
        let wanted = LiteralKind::of_wire(spec.wire)
            .ok_or_else(|| format!("the input takes {} from a link; a value can't be given", spec.wire))?;
        let options = spec.options.iter().map(|option| option.name.clone()).collect();
        Ok(Self { node, port: port.to_owned(), wanted, options })
    }

    /// The nodes that take this value as it is.
    pub(super) fn nodes(&self) -> Vec<NodeId> {
        vec![self.node]
    }

    /// A value as it is written on the command line.
    pub(super) fn read(&self, value: &str) -> Result<Literal, String> {
        literal(self.wanted, value)
    }

    /// Puts a value there.
    pub(super) fn set(&self, graph: &mut Graph, literal: Literal) -> Result<(), String> {
        graph.set(self.node, &self.port, literal).map_err(|error| error.to_string())
    }
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
