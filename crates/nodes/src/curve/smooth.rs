//! **Smooth**: takes short bends off curves; a shaky hand, a lip line too sharp to model.

use maquette_geometry::curve::smooth;
use maquette_graph::{AtPort, NodeKind};

use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "smooth",
        1,
        "curve",
        "Takes bends shorter than a wavelength off curves; longer ones, and the ends of open curves, stay.",
    );
    let curves = node.input::<wire::Curves>("curves", "Curves to smooth.");
    let wave = node.length(
        "wave",
        0.02,
        1e-6..=1e3,
        "Bends of this length are halved; of twice this length they keep 94 %, of half this length 6 %.",
    );
    node.soft_range(wave, 0.002..=0.2);
    let smoothed = node.output::<wire::Curves>("curves", "The smoothed curves, with as many points as before.");
    node.evaluate(move |ports| {
        let wave = ports.value(wave);
        let calm = ports.read(curves).0.iter().map(|curve| smooth(curve, wave)).collect::<Result<_, _>>();
        ports.write(smoothed, wire::Curves(calm.at(curves)?));
        Ok(())
    });
    node
}
