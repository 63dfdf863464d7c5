//! A mesh cut by a plane: the sides that cross it, and the segments between them.

use glam::DVec3;

use super::Plane;
use super::chain::{Loop, chained};
use crate::mesh::Mesh;
use crate::mesh::measure::bounds;
use crate::mesh::triangulate::polygon_triangles;

/// A point in which a side of a polygon crosses the plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    /// The side's vertices: the one below the plane, then the one above or on it.
    pub(super) edge: [u32; 2],
    pub(super) point: DVec3,
}

/// What a polygon has in the plane, run so that the polygon's outside is to its right, seen against the normal.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    pub(super) ends: [Crossing; 2],
}

/// Rounding of a height in units of the model's size.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// Where a plane cuts a mesh: closed loops, and open chains where the mesh has holes.
///
/// Vertices in the plane (to within rounding, 32 units in the last place of the largest coordinate) count as above it,
/// so that the result is that of a plane moved against its normal by less than any number: a face in the plane gives
/// its outline where the body lies below it, and nothing where it lies above; what only touches the plane, in points or
/// along a line, gives nothing. Every point lies on a side of a polygon. A polygon that the plane crosses once gives one
/// straight segment; one that it crosses several times is split into triangles first.
///
/// Segments are chained by the vertices of the sides they end on, so no tolerance is involved; where chains would end
/// open, by the positions of these vertices, so that seams of doubled vertices are closed. Where more than two polygons
/// meet at a side, neighbours with matter between them go on into each other: bodies that touch stay apart.
///
/// Around matter of a mesh that faces outwards loops run counter-clockwise seen against the normal, clockwise around
/// holes. Loops and chains are in the order of their first polygon. O(vertices + corners).
pub fn plane(mesh: &Mesh, plane: &Plane) -> Vec<Loop> {
    let Some((low, high)) = bounds(mesh) else { return Vec::new() };
    let size = low.abs().max(high.abs()).max(plane.origin().abs()).max_element();
    let tolerance = ROUNDING * size;
    let heights: Vec<f64> = mesh
        .positions()
        .iter()
        .map(|p| {
            let height = plane.height(*p);
            if height.abs() <= tolerance { 0.0 } else { height }
        })
        .collect();
    // Nearly all polygons are on one side, which one byte a vertex tells fastest.
    let above: Vec<bool> = heights.iter().map(|height| *height >= 0.0).collect();
    let mut segments = Vec::new();
    for (polygon, corners) in mesh.polygons().enumerate() {
        match sides_across(corners, &above) {
            Across::None => {}
            Across::Once { down, up } => push(mesh, &heights, down, up, &mut segments),
            Across::Often => {
                for triangle in polygon_triangles(mesh, polygon) {
                    let corners = triangle.map(|corner| mesh.corners()[corner]);
                    if let Across::Once { down, up } = sides_across(&corners, &above) {
                        push(mesh, &heights, down, up, &mut segments);
                    }
                }
            }
        }
    }
    chained(&segments, plane)
}

/// How the sides of a polygon cross the plane. Sides are given as the vertex below, then the one above.
enum Across {
    None,
    Once { down: [u32; 2], up: [u32; 2] },
    Often,
}

fn sides_across(corners: &[u32], above: &[bool]) -> Across {
    let above = |vertex: u32| above[vertex as usize];
    let Some(&last) = corners.last() else { return Across::None };
    if corners.iter().all(|vertex| above(*vertex) == above(last)) {
        return Across::None;
    }
    let (mut from, mut was_above) = (last, above(last));
    let (mut down, mut up) = (None, None);
    for &to in corners {
        let is_above = above(to);
        let crossed = match (was_above, is_above) {
            (true, false) => down.replace([to, from]),
            (false, true) => up.replace([from, to]),
            _ => None,
        };
        if crossed.is_some() {
            return Across::Often;
        }
        (from, was_above) = (to, is_above);
    }
    match (down, up) {
        (Some(down), Some(up)) => Across::Once { down, up },
        _ => Across::None,
    }
}

fn push(mesh: &Mesh, heights: &[f64], down: [u32; 2], up: [u32; 2], segments: &mut Vec<Segment>) {
    // A polygon that runs a side there and back has nothing between.
    if down != up {
        segments.push(Segment { ends: [down, up].map(|edge| crossing(mesh, heights, edge)) });
    }
}

/// Always reckoned from the lower to the upper vertex, so that all polygons at a side get the very same point.
fn crossing(mesh: &Mesh, heights: &[f64], edge: [u32; 2]) -> Crossing {
    let [below, above] = edge.map(|vertex| heights[vertex as usize]);
    let share = below / (below - above);
    let share = if share.is_finite() { share } else { 0.5 };
    let [from, to] = edge.map(|vertex| mesh.positions()[vertex as usize]);
    Crossing { edge, point: from * (1.0 - share) + to * share }
}
