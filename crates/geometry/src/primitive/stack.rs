//! Rows along a frame's normal, all of one outline at different scales.

use glam::{DVec2, DVec3};

use super::PrimitiveError;
use crate::sections::Sections;
use crate::trigonometric::PlaneFrame;

const MOST_SECTIONS: usize = 4096;
const MOST_NODES: usize = 65_536;
const MOST_POINTS: usize = 1 << 24;

/// One section of a primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Row {
    /// Height above the frame's origin along its normal, metres.
    pub(super) height: f64,
    /// Factor of the outline; 0 makes a point.
    pub(super) scale: f64,
}

/// Whether there may be so many sections and nodes.
pub(super) fn check(sections: usize, least: usize, nodes: usize) -> Result<(), PrimitiveError> {
    if !(least..=MOST_SECTIONS).contains(&sections) {
        return Err(PrimitiveError::Count { what: "sections", found: sections, least, most: MOST_SECTIONS });
    }
    if !(3..=MOST_NODES).contains(&nodes) {
        return Err(PrimitiveError::Count { what: "nodes", found: nodes, least: 3, most: MOST_NODES });
    }
    if sections * nodes > MOST_POINTS {
        return Err(PrimitiveError::TooManyPoints { sections, nodes });
    }
    Ok(())
}

/// Sections of the outline (metres along `e1` and `e2`), one a row.
pub(super) fn stack(frame: &PlaneFrame, rows: &[Row], outline: &[DVec2]) -> Result<Sections, PrimitiveError> {
    let nodes = outline.len();
    let place = |row: &Row| -> Vec<DVec3> {
        let centre = frame.origin + frame.normal * row.height;
        outline.iter().map(|p| centre + frame.e1 * (p.x * row.scale) + frame.e2 * (p.y * row.scale)).collect()
    };
    let rails = if nodes.is_multiple_of(4) { vec![0, nodes / 4, nodes / 2, 3 * nodes / 4] } else { Vec::new() };
    Ok(Sections::new(rows.iter().map(place).collect(), true, rails)?)
}

/// Unit vectors at equal angles, of which those on the axes are exact.
pub(super) fn directions(nodes: usize) -> impl Iterator<Item = DVec2> {
    (0..nodes).map(move |node| {
        // Counted from the last axis: a quarter turn is no rational number.
        let (quarter, rest) = (4 * node / nodes, 4 * node % nodes);
        let (sin, cos) = (std::f64::consts::FRAC_PI_2 * rest as f64 / nodes as f64).sin_cos();
        match quarter {
            0 => DVec2::new(cos, sin),
            1 => DVec2::new(-sin, cos),
            2 => DVec2::new(-cos, -sin),
            _ => DVec2::new(sin, -cos),
        }
    })
}
