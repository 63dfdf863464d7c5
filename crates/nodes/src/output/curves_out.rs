//! **Curves out**: curves as a result of the graph, under the name of the node.

use maquette_graph::NodeKind;

use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node =
        NodeKind::declare("curves-out", 1, "output", "Curves as a result of the graph, named like this node.");
    node.is_result();
    let curves = node.input::<wire::Curves>("curves", "The curves.");
    let colour = node.colour("colour", [0.85, 0.25, 0.2, 1.0], "Colour of the lines; sRGB with alpha.");
    let result = node.output::<wire::CurvesResult>("result", "The curves with their colour.");
    node.evaluate(move |ports| {
        let curves = ports.read(curves).0.clone();
        ports.write(result, wire::CurvesResult { curves, colour: ports.read(colour).0 });
        Ok(())
    });
    node
}
