//! The first two inputs of a node change places.

use maquette_graph::{Catalogue, ConnectError, Edit, Graph, GraphError, InputSpec, NodeId, Source, WireType};

/// Why they do not.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub(crate) enum SwapError {
    /// The node is gone, or its kind is not known.
    #[error("there is no node to swap inputs of: select one whose kind is known")]
    NoNode,
    /// It has fewer than two inputs.
    #[error("\"{0}\" has no two inputs to swap")]
    TooFew(String),
    /// What one holds does not fit the other.
    #[error("the inputs of \"{node}\" are not swapped: \"{input}\" takes {takes}, and \"{other}\" holds {holds}")]
    DoesNotFit {
        /// The node.
        node: String,
        /// The input that would get it.
        input: String,
        /// Its type.
        takes: &'static str,
        /// The input that holds it.
        other: String,
        /// Its type.
        holds: &'static str,
    },
    /// Both hold nothing, or the same.
    #[error("\"{0}\" and \"{1}\" of \"{2}\" hold nothing to swap: link something first")]
    Nothing(String, String, String),
    /// A value is out of the other input's range, or not among its options.
    #[error(transparent)]
    Value(#[from] GraphError),
    /// A link would not do.
    #[error(transparent)]
    Link(#[from] ConnectError),
}

/// The edits that let what the first two inputs of a node hold change places.
///
/// Inputs that are linked come first, as they do on the canvas: of a node with two links those are swapped, even where an input
/// with a value stands between them.
///
/// # Errors
/// What one holds does not fit the other; see [`SwapError`].
pub(crate) fn swap(graph: &Graph, catalogue: &Catalogue, id: NodeId) -> Result<Vec<Edit>, SwapError> {
    let node = graph.node(id).ok_or(SwapError::NoNode)?;
    let kind = node.kind().ok_or(SwapError::NoNode)?;
    let name = || node.name().to_owned();
    // Those that take links; a node of plain values swaps those.
    let wired: Vec<&InputSpec> =
        kind.inputs().iter().filter(|input| maquette_graph::LiteralKind::of_wire(input.wire).is_none()).collect();
    let all: Vec<&InputSpec> = if wired.len() > 1 { wired } else { kind.inputs().iter().collect() };
    let [first, second, ..] = all[..] else { return Err(SwapError::TooFew(name())) };
    let held = |input: &InputSpec| node.source(&input.name).cloned();
    let sources = [held(first), held(second)];
    if sources[0] == sources[1] {
        return Err(SwapError::Nothing(first.name.clone(), second.name.clone(), name()));
    }
    let type_of = |source: &Option<Source>, input: &InputSpec| -> WireType {
        let linked = match source {
            Some(Source::Link(link)) => {
                graph.node(link.node).and_then(|from| Some(from.kind()?.find_output(&link.output)?.1.wire))
            }
            _ => None,
        };
        linked.unwrap_or(input.wire)
    };
    let fits = |source: &Option<Source>, from: &InputSpec, to: &InputSpec| {
        let holds = type_of(source, from);
        let missing = source.is_none() && !to.optional && to.default.is_none();
        if catalogue.fits(holds, to.wire) && !missing {
            return Ok(());
        }
        Err(SwapError::DoesNotFit {
            node: name(),
            input: to.name.clone(),
            takes: to.wire.name(),
            other: from.name.clone(),
            holds: if missing { "nothing" } else { holds.name() },
        })
    };
    fits(&sources[0], first, second)?;
    fits(&sources[1], second, first)?;
    let [one, other] = sources;
    Ok(vec![put(id, second, one), put(id, first, other)])
}

/// What puts a source at an input.
fn put(node: NodeId, input: &InputSpec, source: Option<Source>) -> Edit {
    let input = input.name.clone();
    match source {
        Some(Source::Link(link)) => Edit::connect(link.node, link.output, node, input),
        Some(Source::Literal { literal, .. }) => Edit::set(node, input, literal),
        Some(Source::Parameter(parameter)) => Edit::UseParameter { node, input, parameter },
        Some(Source::Unread(_)) | None => Edit::Reset { node, input },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn catalogue() -> Catalogue {
        maquette_nodes::catalogue().unwrap()
    }

    #[test]
    fn two_links_change_places_and_back() {
        let catalogue = catalogue();
        let mut graph = Graph::new();
        let [a, b] = ["a", "b"].map(|name| graph.add(&catalogue, "sketch", name).unwrap());
        let merged = graph.add(&catalogue, "join", "merged").unwrap();
        let inputs: Vec<String> =
            graph.node(merged).unwrap().kind().unwrap().inputs().iter().map(|input| input.name.clone()).collect();
        graph.connect(&catalogue, a, "curves", merged, &inputs[0]).unwrap();
        graph.connect(&catalogue, b, "curves", merged, &inputs[1]).unwrap();
        let from = |graph: &Graph, input: &str| match graph.node(merged).unwrap().source(input) {
            Some(Source::Link(link)) => link.node,
            other => panic!("{other:?}"),
        };
        for expected in [[b, a], [a, b]] {
            for edit in swap(&graph, &catalogue, merged).unwrap() {
                graph.apply(&catalogue, &edit).unwrap();
            }
            assert_eq!([from(&graph, &inputs[0]), from(&graph, &inputs[1])], expected);
        }
    }

    #[test]
    fn what_does_not_fit_says_why() {
        let catalogue = catalogue();
        let mut graph = Graph::new();
        let mesh = graph.add(&catalogue, "mesh-out", "ball").unwrap();
        assert!(swap(&graph, &catalogue, mesh).is_err());
        let messages: Vec<String> = catalogue
            .kinds()
            .enumerate()
            .filter_map(|(index, kind)| {
                let id = graph.add(&catalogue, kind.name(), &format!("node {index}")).unwrap();
                swap(&graph, &catalogue, id).err().map(|error| error.to_string())
            })
            .collect();
        assert!(messages.iter().any(|text| text.contains("has no two inputs")), "{messages:?}");
        assert!(messages.iter().any(|text| text.contains("hold nothing to swap")), "{messages:?}");
    }
}
