//! `--set NODE.PORT=VALUE`, `--set PARAMETER=VALUE`: values from the command line, read by the type of their port.

use maquette_graph::file::parse_literal;
use maquette_graph::{Graph, InputSpec, Literal, LiteralKind, NodeId};

/// Where a value that is given on the command line goes.
#[derive(Clone, Debug)]
pub(super) struct Place {
    target: Target,
    /// What kind of value it takes.
    pub(super) wanted: LiteralKind,
    /// The options of a choice.
    pub(super) options: Vec<String>,
}

#[derive(Clone, Debug)]
enum Target {
    Input(NodeId, String),
    /// A parameter of the graph, and the nodes that use it.
    Parameter(String, Vec<NodeId>),
}

/// Puts a value given on the command line into the graph, and gives it as it was understood.
///
/// Texts, choices and files are written bare, vectors and colours as numbers separated by commas; anything may also be
/// written as in a graph file. A relative path starts at the current folder.
pub(super) fn apply(graph: &mut Graph, assignment: &str) -> Result<Literal, String> {
    let fail = |reason: String| format!("--set {assignment}: {reason}");
    let how = || "write it as NODE.PORT=VALUE, or PARAMETER=VALUE".to_owned();
    let (address, value) = assignment.split_once('=').ok_or_else(|| fail(how()))?;
    let place = Place::find(graph, address).map_err(fail)?;
    let literal = place.read(value).map_err(fail)?;
    place.set(graph, literal.clone()).map_err(fail)?;
    Ok(literal)
}

impl Place {
    /// The place of an address, `NODE.PORT` or the name of a parameter; why there is none is an error.
    pub(super) fn find(graph: &Graph, address: &str) -> Result<Self, String> {
        let Some((name, port)) = address.rsplit_once('.') else { return Self::parameter(graph, address) };
        let node = graph.find(name).ok_or_else(|| {
            let hint = graph.suggest(name).map(|s| format!("; did you mean \"{s}\"?")).unwrap_or_default();
            format!("no node is named \"{name}\"{hint}")
        })?;
        let kind = graph.node(node).and_then(|n| n.kind().cloned());
        // A script may be as old as a file.
        let spec = kind.as_ref().and_then(|k| k.current_input(port)).ok_or_else(|| {
            let known = kind.iter().flat_map(|k| k.inputs()).map(|i| i.name.as_str()).collect::<Vec<_>>().join(", ");
            format!("node \"{name}\" has no input \"{port}\"; it has {known}")
        })?;
        Self::of(Target::Input(node, spec.name.clone()), spec)
            .ok_or_else(|| format!("the input takes {} from a link; a value can't be given", spec.wire))
    }

    fn parameter(graph: &Graph, name: &str) -> Result<Self, String> {
        let Some(found) = graph.parameter(name) else {
            let known: Vec<_> = graph.parameters().map(|parameter| parameter.name()).collect();
            return Err(match graph.suggest_parameter(name) {
                Some(suggestion) => format!("the graph has no parameter \"{name}\"; did you mean \"{suggestion}\"?"),
                None if known.is_empty() => {
                    format!("the graph has no parameters; give NODE.PORT=VALUE in place of {name}")
                }
                None => format!("the graph has no parameter \"{name}\"; it has {}", known.join(", ")),
            });
        };
        let mut users: Vec<NodeId> = graph.uses(name).into_iter().map(|(node, _)| node).collect();
        users.dedup();
        Self::of(Target::Parameter(name.to_owned(), users), found.spec())
            .ok_or_else(|| format!("the parameter takes {} from outside; a value can't be given", found.wire()))
    }

    fn of(target: Target, spec: &InputSpec) -> Option<Self> {
        let options = spec.options.iter().map(|option| option.name.clone()).collect();
        Some(Self { target, wanted: LiteralKind::of_wire(spec.wire)?, options })
    }

    /// The nodes that take this value as it is.
    pub(super) fn nodes(&self) -> Vec<NodeId> {
        match &self.target {
            Target::Input(node, _) => vec![*node],
            Target::Parameter(_, users) => users.clone(),
        }
    }

    /// A value as it is written on the command line.
    pub(super) fn read(&self, value: &str) -> Result<Literal, String> {
        literal(self.wanted, value)
    }

    /// Puts a value there.
    pub(super) fn set(&self, graph: &mut Graph, literal: Literal) -> Result<(), String> {
        match &self.target {
            Target::Input(node, port) => graph.set(*node, port, literal).map_err(|error| error.to_string()),
            Target::Parameter(name, _) => graph.set_parameter(name, literal).map_err(|error| error.to_string()),
        }
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
