//! **Smooth**: takes short bends off curves; a shaky hand, a lip line too sharp to model.

use maquette_geometry::curve::{Curve, SmoothError, smooth};
use maquette_graph::{AtPort, NodeKind, Unit};

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
    let farthest = node.figure("largest-move", Unit::Length, "How far the point moves that moves farthest.");
    let moves =
        node.table("curves", &[("curve", Unit::None), ("largest-move", Unit::Length)], "The same for each curve.");
    node.evaluate(move |ports| {
        let length = ports.value(wave);
        let drawn = &ports.read(curves).0;
        let mut calm: Vec<Curve> = Vec::with_capacity(drawn.len());
        for (done, curve) in drawn.iter().enumerate() {
            ports.progress(done as f64 / drawn.len() as f64)?;
            calm.push(match smooth(curve, length) {
                Err(error @ SmoothError::Wave { .. }) => Err(error).at(wave)?,
                smoothed => smoothed.at(curves)?,
            });
        }
        ports.progress(1.0)?;
        let moved = |(was, is): (&Curve, &Curve)| {
            was.points().iter().zip(is.points()).map(|(p, q)| p.distance_squared(*q)).fold(0.0, f64::max).sqrt()
        };
        let moved: Vec<f64> = drawn.iter().zip(&calm).map(moved).collect();
        ports.figure(farthest, moved.iter().copied().fold(0.0, f64::max));
        ports.table(moves, drawn.iter().zip(&moved).map(|(c, far)| vec![c.name().into(), (*far).into()]).collect());
        ports.write(smoothed, wire::Curves(calm));
        Ok(())
    });
    node
}
