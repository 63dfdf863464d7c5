//! **Transform**: moves, turns and scales curves.

use maquette_graph::{AtPort, NodeKind};

use crate::affine::AffineInputs;
use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare("transform", 1, "curve", "Scales, turns and moves curves, in this order.");
    let curves = node.input::<wire::Curves>("curves", "Curves to transform.");
    let affine = AffineInputs::declare(&mut node);
    let transformed = node.output::<wire::Curves>("curves", "The transformed curves, in the same order.");
    node.evaluate(move |ports| {
        let affine = affine.read(ports)?;
        let drawn = &ports.read(curves).0;
        let mut moved = Vec::with_capacity(drawn.len());
        for curve in drawn {
            ports.progress(moved.len() as f64 / drawn.len() as f64)?;
            moved.push(curve.map(|p| affine.transform_point3(p)).at(curves)?);
        }
        ports.write(transformed, wire::Curves(moved));
        Ok(())
    });
    node
}
