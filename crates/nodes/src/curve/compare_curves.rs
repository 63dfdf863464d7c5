//! **Compare curves**: how far two curves are apart.

use maquette_geometry::curve::{Curve, DeviationError, Gap, deviation};
use maquette_graph::{AtPort, Cell, Choices, NodeError, NodeKind, Unit};

use crate::wire;

#[derive(Clone, Copy)]
enum PercentOf {
    Diagonal,
    Size,
}

impl Choices for PercentOf {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Diagonal, "diagonal", "the diagonal of the box around the second curve"),
        (Self::Size, "size", "the size given"),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "compare-curves",
        1,
        "curve",
        "How far two curves are apart, at most and in the mean: to look at or to gate a build.",
    );
    node.reference("Hausdorff distance, at points and samples; distances at equal arc length");
    let first = node.input::<wire::Curve>("first", "The curve that is measured.");
    let second = node.input::<wire::Curve>("second", "What it is measured against.");
    let samples = node.integer(
        "samples",
        512,
        8..=65_536,
        "Places of equal arc length that are measured on each curve, besides all their points.",
    );
    node.soft_range(samples, 64.0..=4096.0);
    let percent_of = node.choice::<PercentOf>("percent-of", "What 100 % are.");
    let size = node.length("size", 1.0, 1e-9..=1e6, "The size that is 100 %, where it is given.");
    let passed = node.output::<wire::Curve>("curve", "The first curve, unchanged.");
    let largest =
        node.figure("largest-distance", Unit::Length, "Largest distance to the nearest place of the other curve.");
    let mean = node.figure("mean-distance", Unit::Length, "The mean of these distances, of both ways.");
    let largest_percent = node.figure("largest-percent", Unit::None, "The largest distance in percent.");
    let mean_percent = node.figure("mean-percent", Unit::None, "The mean distance in percent.");
    let along = node.figure("largest-at-arc-length", Unit::Length, "Largest distance of places at equal arc length.");
    let points = node.figure(
        "largest-by-point",
        Unit::Length,
        "Largest distance of points of equal number, where both curves have as many.",
    );
    let table = node.table(
        "distances",
        &[
            ("of", Unit::None),
            ("largest", Unit::Length),
            ("mean", Unit::Length),
            ("largest-percent", Unit::None),
            ("mean-percent", Unit::None),
            ("share", Unit::None),
            ("x", Unit::Length),
            ("y", Unit::Length),
            ("z", Unit::Length),
        ],
        "Each way of measuring, and where on the first curve the distance is largest.",
    );
    node.evaluate(move |ports| {
        let (measured, against) = (&ports.read(first).0, &ports.read(second).0);
        let found = match deviation(measured, against, ports.count(samples), &ports.progress_callback()) {
            Err(DeviationError::Stopped) => return Err(NodeError::Cancelled),
            found => found.at(first)?,
        };
        let whole = match ports.choice(percent_of) {
            PercentOf::Diagonal => diagonal(against),
            PercentOf::Size => ports.value(size),
        };
        let percent = |distance: f64| 100.0 * distance / whole;
        ports.figure(largest, found.nearest.largest);
        ports.figure(mean, found.nearest.mean);
        ports.figure(largest_percent, percent(found.nearest.largest));
        ports.figure(mean_percent, percent(found.nearest.mean));
        ports.figure(along, found.arc_length.largest);
        if let Some(gap) = found.points {
            ports.figure(points, gap.largest);
        }
        if found.reversed {
            ports.note("at equal arc length the second curve is run the other way, where it is nearer");
        }
        let row = |name: &str, gap: &Gap| -> Vec<Cell> {
            let measured = [gap.largest, gap.mean, percent(gap.largest), percent(gap.mean), gap.share];
            std::iter::once(name.into())
                .chain(measured.map(Cell::from))
                .chain(gap.at.to_array().map(Cell::from))
                .collect()
        };
        let mut rows = vec![row("nearest", &found.nearest), row("arc-length", &found.arc_length)];
        rows.extend(found.points.iter().map(|gap| row("points", gap)));
        ports.table(table, rows);
        ports.write(passed, wire::Curve(measured.clone()));
        Ok(())
    });
    node
}

/// Diagonal of the box around a curve, metres; above 0, because a curve has a length.
fn diagonal(curve: &Curve) -> f64 {
    let (low, high) = curve.bounds();
    (high - low).length()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use maquette_graph::Literal;
    use maquette_graph::harness::Harness;

    fn line(height: f64, points: u32) -> wire::Curve {
        let at = |k: u32| DVec3::new(3.0 * f64::from(k) / f64::from(points - 1), height, 0.0);
        wire::Curve(Curve::new("line", (0..points).map(at).collect(), false).unwrap())
    }

    #[test]
    fn distances_in_metres_and_percent() {
        let kind = kind();
        let run = |points: u32| Harness::new(&kind).give("first", line(0.0, 4)).give("second", line(0.03, points));
        let trial = run(7).run().unwrap();
        let figure = |name: &str| trial.report.figure(name).map(|figure| figure.value);
        assert!((figure("largest-distance").unwrap() - 0.03).abs() < 1e-15);
        assert!((figure("mean-percent").unwrap() - 1.0).abs() < 1e-10);
        assert_eq!((figure("largest-by-point"), trial.report.table("distances").unwrap().rows.len()), (None, 2));
        assert_eq!(trial.value::<wire::Curve>("curve"), Some(&line(0.0, 4)));
        let size = Literal::Choice("size".to_owned());
        let given = run(4).set("percent-of", size).set("size", Literal::Number(0.06)).run().unwrap();
        assert!((given.report.figure("largest-percent").unwrap().value - 50.0).abs() < 1e-10);
        assert!((given.report.figure("largest-by-point").unwrap().value - 0.03).abs() < 1e-15);
    }
}
