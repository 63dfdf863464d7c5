//! Vertices within open edges of another part: the surface looks closed there, and is not.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::WeldError;
use super::boundary::Boundary;
use crate::mesh::Mesh;
use crate::mesh::topology::Topology;

/// A vertex that lies within an open edge of another part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TJunction {
    /// The part of the vertex, counted from 0.
    pub part: usize,
    /// The part of the edge.
    pub of: usize,
    /// The vertex, metres.
    pub at: DVec3,
    /// Its distance from the edge, metres.
    pub gap: f64,
}

/// The T-junctions, in the order of their edges.
pub(super) fn t_junctions(
    mesh: &Mesh,
    topology: &Topology,
    boundary: &Boundary,
    new: &[u32],
    tolerance: f64,
    go_on: &dyn Fn() -> Result<(), WeldError>,
) -> Result<Vec<TJunction>, WeldError> {
    let edges = topology.boundary_edges();
    let at = |vertex: u32| mesh.positions()[vertex as usize];
    let mut open: Vec<u32> = edges.iter().flatten().copied().collect();
    open.sort_unstable();
    open.dedup();
    // The parts of which a vertex was made.
    let mut parts: BTreeMap<u32, BTreeSet<usize>> = open.iter().map(|vertex| (*vertex, BTreeSet::new())).collect();
    for (old, vertex) in new.iter().enumerate() {
        if let Some(parts) = parts.get_mut(vertex) {
            parts.insert(boundary.part_of_vertex(old as u32));
        }
    }
    open.sort_by(|a, b| at(*a).x.total_cmp(&at(*b).x).then(a.cmp(b)));
    let mut found = Vec::new();
    for [a, b] in edges {
        go_on()?;
        let Some(polygon) = topology.boundary_polygon(a, b) else { continue };
        let of = boundary.part_of_polygon(polygon);
        let (from, to) = (at(a), at(b));
        let low = from.x.min(to.x) - tolerance;
        let first = open.partition_point(|vertex| at(*vertex).x < low);
        let near = open[first..].iter().take_while(|vertex| at(**vertex).x <= from.x.max(to.x) + tolerance);
        for &vertex in near {
            let Some(own) = parts.get(&vertex) else { continue };
            if own.contains(&of) {
                continue;
            }
            let (point, side) = (at(vertex), to - from);
            let share = ((point - from).dot(side) / side.length_squared()).clamp(0.0, 1.0);
            let gap = point.distance(from + side * share);
            // At the ends of the edge it is a vertex that was not welded, because another one was nearer.
            let inside = point.distance(from) > tolerance && point.distance(to) > tolerance;
            if gap <= tolerance && inside {
                found.push(TJunction { part: own.first().copied().unwrap_or(0), of, at: point, gap });
            }
        }
    }
    Ok(found)
}
