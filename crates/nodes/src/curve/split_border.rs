//! **Split border**: the sides of a closed border between its corners.
//! Reference: paper 5.2.4.

use glam::DVec3;
use maquette_geometry::border::{SplitBorderError, farthest_corner, split};
use maquette_graph::{AtPort, NodeKind, Unit};

use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "split-border",
        2,
        "curve",
        "Takes a closed border apart at corners: three or four sides are the borders of a patch that closes a hole.",
    );
    node.reference("paper 5.2.4");
    let border = node.input::<wire::Borders>("border", "One closed border: that of a hole.");
    let corners = node.input::<wire::Curves>(
        "corners",
        "Curves whose points are the corners, in any order; the point of the border nearest to each counts. Lay them onto the \
         mesh with draw-on-surface, its `spacing` 0.",
    );
    let points = node.integer("points", 128, 8..=65_536, "Points of each side, at equal distances on a smooth curve.");
    node.soft_range(points, 32.0..=512.0);
    let sides = node.output::<wire::Borders>("sides", "The sides in order around, from the first corner.");
    let off = node.figure("largest-distance", Unit::Length, "How far a corner is from the border at most.");
    node.evaluate(move |ports| {
        let whole = match ports.read(border).0.as_slice() {
            [whole] => whole,
            several => {
                let message = "borders arrive where one is wanted: choose it with the `which` of a boundary-of node";
                return Err(format!("{} {message}", several.len())).at(border);
            }
        };
        let places: Vec<DVec3> =
            ports.read(corners).0.iter().flat_map(|curve| curve.points().iter().copied()).collect();
        let made = match split(whole, &places, ports.count(points)) {
            Err(error @ (SplitBorderError::Corners { .. } | SplitBorderError::OnePlace { .. })) => {
                Err(error).at(corners)
            }
            made => made.at(border),
        }?;
        ports.figure(off, farthest_corner(whole, &places));
        ports.write(sides, wire::Borders(made));
        Ok(())
    });
    node
}
