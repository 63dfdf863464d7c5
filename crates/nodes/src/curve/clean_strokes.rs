//! **Clean strokes**: several rough strokes over one another become one.

use maquette_geometry::curve::{CleanError, Cleaned, Cleaning, clean_while};
use maquette_graph::{AtPort, NodeError, NodeKind, Unit};

use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "clean-strokes",
        2,
        "curve",
        "Makes one curve of strokes that were drawn over one another, or go on where another ends: the line in their \
         middle, smoothed. Strokes that cross or part stay apart. Pen pressure is not kept.",
    );
    node.reference("thesis 5.1");
    let strokes = node.input::<wire::Curves>("curves", "Rough strokes, in any order and direction.");
    let distance = node.length(
        "distance",
        0.02,
        1e-6..=1e3,
        "Strokes that run beside each other within this distance are the same line; gaps of this length are bridged.",
    );
    node.soft_range(distance, 0.002..=0.1);
    let angle =
        node.angle("angle", 35.0, 0.0..=90.0, "Where strokes run at a larger angle to each other, they only cross.");
    let smooth = node.length(
        "smooth",
        0.04,
        0.0..=1e3,
        "Bends of this length are halved; of the distance, where that is longer.",
    );
    node.soft_range(smooth, 0.0..=0.2);
    let cleaned = node.output::<wire::Curves>(
        "curves",
        "One curve for each group of strokes, in the order of their first strokes; it has the name and the direction of \
         the longest one.",
    );
    let spread = node.figure("largest-spread", Unit::Length, "How far a stroke is off its line at most.");
    let lines = node.table(
        "curves",
        &[
            ("curve", Unit::None),
            ("closed", Unit::None),
            ("strokes", Unit::None),
            ("spread", Unit::Length),
            ("largest-spread", Unit::Length),
        ],
        "Each curve: how many strokes it stands for, and how far they are off it (root of the mean square, most).",
    );
    node.evaluate(move |ports| {
        let cleaning = Cleaning {
            distance: ports.value(distance),
            angle: ports.value(angle).to_radians(),
            wave: ports.value(smooth),
        };
        let found = match clean_while(&ports.read(strokes).0, &cleaning, &ports.progress_callback()) {
            Err(CleanError::Stopped) => return Err(NodeError::Cancelled),
            Err(error @ CleanError::Angle { .. }) => Err(error).at(angle)?,
            Err(error @ CleanError::Wave { .. }) => Err(error).at(smooth)?,
            found => found.at(distance)?,
        };
        let row = |line: &Cleaned| {
            vec![
                line.curve.name().into(),
                line.curve.is_closed().into(),
                line.strokes.len().into(),
                line.spread.into(),
                line.largest.into(),
            ]
        };
        ports.table(lines, found.iter().map(row).collect());
        ports.figure(spread, found.iter().map(|line| line.largest).fold(0.0, f64::max));
        ports.write(cleaned, wire::Curves(found.into_iter().map(|line| line.curve).collect()));
        Ok(())
    });
    node
}
