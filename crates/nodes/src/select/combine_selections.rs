//! **Combine selections**: what both select, what either selects, or what one selects and the other does not.

use maquette_graph::{AtPort, Choices, NodeKind};

use crate::selecting::SelectionOutput;
use crate::wire;

#[derive(Clone, Copy)]
enum By {
    Or,
    And,
    Minus,
}

impl Choices for By {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Or, "or", "what one of both selects: the larger weight"),
        (Self::And, "and", "what both select: the smaller weight"),
        (Self::Minus, "minus", "what the first selects and the second does not"),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node =
        NodeKind::declare("combine-selections", 1, "select", "Combines two selections of a mesh: or, and, minus.");
    let first = node.input::<wire::Selection>("first", "The first selection; the result is shown on its mesh.");
    let second = node.input::<wire::Selection>("second", "The second selection, of a mesh with as many vertices.");
    let by = node.choice::<By>("by", "How they are combined.");
    let output = SelectionOutput::declare(&mut node);
    node.evaluate(move |ports| {
        let (a, b) = (ports.read(first), &ports.read(second).weights);
        let weights = match ports.choice(by) {
            By::Or => a.weights.or(b),
            By::And => a.weights.and(b),
            By::Minus => a.weights.minus(b),
        };
        let combined = a.with_weights(weights.at(second)?);
        output.write(ports, combined, "combine selections that overlap as `by` wants it");
        Ok(())
    });
    node
}
