//! **Resample**: points at equal arc length along each curve.
//! Reference: thesis 6.4, paper 4.2.

use maquette_geometry::curve::{Amount, ResampleError, Resampling, resample_while, spread};
use maquette_graph::{AtPort, Choices, NodeError, NodeKind, Unit};

use crate::wire;

#[derive(Clone, Copy)]
enum By {
    Count,
    Spacing,
}

impl Choices for By {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Count, "count", "the same number of points on every curve"),
        (Self::Spacing, "spacing", "points the same distance apart"),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare("resample", 1, "curve", "Places points at equal arc length along each curve.");
    node.reference("thesis 6.4, paper 4.2");
    let curves = node.input::<wire::Curves>("curves", "Curves to resample.");
    let by = node.choice::<By>("by", "Whether to fix the number of points or their distance.");
    let count = node.integer("count", 64, 2..=65_536, "Points on each curve; both ends of an open curve count.");
    node.soft_range(count, 8.0..=256.0);
    let spacing = node.length("spacing", 0.01, 1e-6..=1e3, "Distance between points along the curve.");
    node.soft_range(spacing, 0.002..=0.1);
    let smooth = node.boolean(
        "smooth",
        true,
        "Lay a smooth curve (C2 spline) through the drawn points first; otherwise keep to the straight pieces.",
    );
    let keep_corners = node.boolean("keep-corners", false, "Keep points where the curve turns sharply, exactly.");
    let corner_angle = node.angle("corner-angle", 45.0, 1.0..=179.0, "Turns by more than this are corners.");
    let even = node.output::<wire::Curves>("curves", "The resampled curves, in the same order.");
    let spacings = node.table(
        "curves",
        &[
            ("curve", Unit::None),
            ("points", Unit::None),
            ("shortest-spacing", Unit::Length),
            ("longest-spacing", Unit::Length),
            ("off-drawing", Unit::Length),
        ],
        "Each curve: its points, their distances, and how far a drawn point is off the new one's straight pieces at most.",
    );
    let off = node.figure("off-drawing", Unit::Length, "How far a drawn point is off the new curves at most.");
    node.evaluate(move |ports| {
        let amount = match ports.choice(by) {
            By::Count => Amount::Count(ports.count(count)),
            By::Spacing => Amount::Spacing(ports.value(spacing)),
        };
        let corner_angle = ports.value(keep_corners).then(|| ports.value(corner_angle).to_radians());
        let resampling = Resampling { amount, smooth: ports.value(smooth), corner_angle };
        let drawn = &ports.read(curves).0;
        let go_on = ports.progress_callback();
        let mut resampled = Vec::with_capacity(drawn.len());
        for (index, curve) in drawn.iter().enumerate() {
            #[expect(clippy::cast_precision_loss, reason = "a share of the work, for a progress bar")]
            let share = index as f64 / drawn.len() as f64;
            ports.progress(share)?;
            resampled.push(match resample_while(curve, &resampling, &|| go_on(share)) {
                Err(ResampleError::Stopped) => return Err(NodeError::Cancelled),
                even => even.at(curves)?,
            });
        }
        let mut measured = Vec::with_capacity(drawn.len());
        for (drawn, new) in drawn.iter().zip(&resampled) {
            ports.progress(1.0)?;
            measured.push(spread(drawn, new));
        }
        ports.figure(off, measured.iter().map(|m| m.off_drawing).fold(0.0, f64::max));
        let rows = resampled.iter().zip(&measured).map(|(new, found)| {
            let points = new.points().len().into();
            vec![new.name().into(), points, found.shortest.into(), found.longest.into(), found.off_drawing.into()]
        });
        ports.table(spacings, rows.collect());
        ports.write(even, wire::Curves(resampled));
        Ok(())
    });
    node
}
