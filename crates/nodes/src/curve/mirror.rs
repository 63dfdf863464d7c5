//! **Mirror**: the mirror image of curves, with or without the originals.

use maquette_graph::{AtPort, NodeKind};

use crate::view_plane::MirrorPlane;
use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare("mirror", 1, "curve", "Mirrors curves across a plane.");
    let curves = node.input::<wire::Curves>("curves", "Curves to mirror.");
    let axis = node.choice::<MirrorPlane>("axis", "The axis that is turned around.");
    let offset = node.length("offset", 0.0, -1e4..=1e4, "Place of the mirror along that axis.");
    node.soft_range(offset, -1.0..=1.0);
    let keep = node.boolean("keep", false, "Put the originals first, and the mirrored curves behind them.");
    let mirrored = node.output::<wire::Curves>(
        "curves",
        "The mirrored curves, run as before. With `keep` they are named after their originals: \"left mirrored\".",
    );
    node.evaluate(move |ports| {
        let (axis, offset, keep) = (ports.choice(axis), ports.value(offset), ports.value(keep));
        let originals = &ports.read(curves).0;
        let mut result = if keep { originals.clone() } else { Vec::new() };
        for (done, original) in originals.iter().enumerate() {
            ports.progress(done as f64 / originals.len() as f64)?;
            let image = original.map(|p| axis.reflect(p, offset)).at(curves)?;
            let name = if keep { format!("{} mirrored", image.name()) } else { image.name().to_owned() };
            result.push(image.renamed(name));
        }
        ports.write(mirrored, wire::Curves(result));
        Ok(())
    });
    node
}
