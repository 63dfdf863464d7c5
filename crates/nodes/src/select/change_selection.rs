//! **Change selection**: inverts, grows, shrinks or smooths a selection.

use maquette_geometry::mesh::Adjacency;
use maquette_graph::{AtPort, Choices, NodeKind};

use crate::selecting::SelectionOutput;
use crate::wire;

#[derive(Clone, Copy)]
enum By {
    Grow,
    Shrink,
    Smooth,
    Invert,
}

impl Choices for By {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Grow, "grow", "by so many edges: each weight the largest around it"),
        (Self::Shrink, "shrink", "by so many edges: each weight the smallest around it"),
        (Self::Smooth, "smooth", "so many times: each weight the mean of itself and its neighbours' mean"),
        (Self::Invert, "invert", "1 less each weight"),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node =
        NodeKind::declare("change-selection", 1, "select", "Grows, shrinks, smooths or inverts a selection.");
    let selection = node.input::<wire::Selection>("selection", "The selection.");
    let by = node.choice::<By>("by", "What is done.");
    let steps = node.integer("steps", 1, 0..=1000, "How often: edges to grow or shrink by, times to smooth.");
    node.soft_range(steps, 0.0..=16.0);
    let output = SelectionOutput::declare(&mut node);
    node.evaluate(move |ports| {
        let given = ports.read(selection);
        let by = ports.choice(by);
        let mut weights = (*given.weights).clone();
        if let By::Invert = by {
            weights = weights.inverted();
        } else {
            let adjacency = Adjacency::along_sides(&given.mesh);
            let count = ports.count(steps);
            for step in 0..count {
                #[expect(clippy::cast_precision_loss, reason = "small")]
                ports.progress(step as f64 / count as f64)?;
                weights = match by {
                    By::Grow => weights.grown(&adjacency, 1),
                    By::Shrink => weights.shrunk(&adjacency, 1),
                    By::Smooth | By::Invert => weights.smoothed(&adjacency, 1),
                }
                .at(selection)?;
            }
        }
        output.write(ports, given.with_weights(weights), "take fewer steps");
        Ok(())
    });
    node
}
