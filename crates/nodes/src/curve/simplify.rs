//! **Simplify**: leaves out points that a tolerance does not need.

use maquette_geometry::curve::{Curve, SimplifyError, simplify_while};
use maquette_graph::{AtPort, NodeError, NodeKind, Unit};

use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "simplify",
        1,
        "curve",
        "Leaves out points as long as each stays within a tolerance of the straight piece that replaces it \
         (Douglas-Peucker). The ends of open curves stay, and three points of closed ones.",
    );
    let curves = node.input::<wire::Curves>("curves", "Curves to simplify.");
    let tolerance = node.length("tolerance", 0.001, 0.0..=1e3, "Largest distance of a point that goes.");
    node.soft_range(tolerance, 1e-5..=0.01);
    let simple = node.output::<wire::Curves>("curves", "The same curves, with those points that are needed.");
    let kept = node.figure("points", Unit::None, "Points of all curves that are left.");
    let table = node.table(
        "curves",
        &[("curve", Unit::None), ("points", Unit::None), ("points-before", Unit::None)],
        "Each curve: its points, and those it had.",
    );
    node.evaluate(move |ports| {
        let drawn = &ports.read(curves).0;
        let go_on = ports.progress_callback();
        let mut left: Vec<Curve> = Vec::with_capacity(drawn.len());
        for (done, curve) in drawn.iter().enumerate() {
            let share = |own: f64| go_on((done as f64 + own) / drawn.len() as f64);
            ports.progress(done as f64 / drawn.len() as f64)?;
            left.push(match simplify_while(curve, ports.value(tolerance), &share) {
                Err(SimplifyError::Stopped) => return Err(NodeError::Cancelled),
                Err(error @ (SimplifyError::Tolerance { .. } | SimplifyError::Curve(_))) => Err(error).at(tolerance)?,
                Ok(curve) => curve,
            });
        }
        let row =
            |(was, is): (&Curve, &Curve)| vec![is.name().into(), is.points().len().into(), was.points().len().into()];
        ports.table(table, drawn.iter().zip(&left).map(row).collect());
        ports.figure(kept, left.iter().map(|curve| curve.points().len()).sum::<usize>() as f64);
        ports.write(simple, wire::Curves(left));
        ports.progress(1.0)?;
        Ok(())
    });
    node
}
