//! What a seam is like, and normals across it.

use std::collections::BTreeMap;

use glam::DVec3;

use super::boundary::Boundary;
use super::{WeldError, WeldOptions};
use crate::mesh::{Mesh, measure};

/// Where two parts meet: vertices of an open loop of each that became one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seam {
    /// The parts, counted from 0.
    pub parts: [usize; 2],
    /// Vertices that became one.
    pub vertices: usize,
    /// Whether these are all vertices of both loops.
    pub whole: bool,
    /// Largest distance of two that became one, metres.
    pub largest_gap: f64,
    /// Largest angle between the mean normals of the two parts at one of them, before they were averaged, degrees.
    pub largest_angle_degrees: f64,
    /// Where that is, metres.
    pub at: DVec3,
}

/// A normal at a corner, and the part it is of.
struct CornerNormal {
    corner: usize,
    part: usize,
    normal: DVec3,
}

type Found = (Vec<Seam>, Option<Vec<DVec3>>);

/// The seams, and the normals of all corners where there are any.
pub(super) fn seams(
    joined: &Mesh,
    welded: &Mesh,
    boundary: &Boundary,
    pairs: &BTreeMap<[usize; 2], Vec<[u32; 2]>>,
    options: &WeldOptions,
    go_on: &dyn Fn() -> Result<(), WeldError>,
) -> Result<Found, WeldError> {
    // Corners of the joined mesh at the vertices that were welded, by those.
    let mut at_vertex: BTreeMap<u32, Vec<CornerNormal>> =
        pairs.values().flatten().flatten().map(|vertex| (*vertex, Vec::new())).collect();
    let mut on_seam = vec![false; joined.positions().len()];
    at_vertex.keys().for_each(|vertex| on_seam[*vertex as usize] = true);
    for polygon in 0..joined.polygon_count() {
        if polygon.is_multiple_of(1 << 16) {
            go_on()?;
        }
        for corner in joined.corner_range(polygon).filter(|corner| on_seam[joined.corners()[*corner] as usize]) {
            if let Some(corners) = at_vertex.get_mut(&joined.corners()[corner]) {
                let normal = match joined.normals() {
                    Some(normals) => normals[corner],
                    None => measure::polygon_normal(joined, polygon),
                };
                corners.push(CornerNormal { corner, part: boundary.part_of_polygon(polygon), normal });
            }
        }
    }
    let mean = |vertex: &u32| -> DVec3 {
        at_vertex.get(vertex).map_or(DVec3::ZERO, |corners| corners.iter().map(|corner| corner.normal).sum())
    };
    let mut seams = Vec::with_capacity(pairs.len());
    for (loops, pairs) in pairs {
        go_on()?;
        let [one, other] = loops.map(|k| &boundary.loops[k]);
        let whole = pairs.len() == one.vertices.len() && pairs.len() == other.vertices.len();
        let mut seam = Seam {
            parts: [one.part, other.part],
            vertices: pairs.len(),
            whole,
            largest_gap: 0.0,
            largest_angle_degrees: 0.0,
            at: pairs.first().map_or(DVec3::ZERO, |pair| joined.positions()[pair[0] as usize]),
        };
        for [a, b] in pairs {
            let [from, to] = [a, b].map(|vertex| joined.positions()[*vertex as usize]);
            seam.largest_gap = seam.largest_gap.max(from.distance(to));
            let (normal_a, normal_b) = (mean(a), mean(b));
            // Where normals cancel out there is no angle.
            let angle = if normal_a == DVec3::ZERO || normal_b == DVec3::ZERO {
                0.0
            } else {
                normal_a.angle_between(normal_b).to_degrees()
            };
            if angle > seam.largest_angle_degrees {
                (seam.largest_angle_degrees, seam.at) = (angle, from);
            }
        }
        seams.push(seam);
    }
    seams.sort_by_key(|seam| seam.parts);
    let Some(normals) = joined.normals() else { return Ok((seams, None)) };

    let mut clusters: BTreeMap<u32, Vec<CornerNormal>> = BTreeMap::new();
    for corners in at_vertex.into_values() {
        for corner in corners {
            clusters.entry(welded.corners()[corner.corner]).or_default().push(corner);
        }
    }
    let mut averaged = normals.to_vec();
    for corners in clusters.values_mut() {
        corners.sort_by_key(|corner| corner.corner);
        for corner in corners.iter() {
            averaged[corner.corner] = across(corner, corners, options.smooth_degrees.to_radians());
        }
    }
    Ok((seams, Some(averaged)))
}

/// The mean over the parts of the normals that are within an angle of one.
fn across(own: &CornerNormal, all: &[CornerNormal], smooth: f64) -> DVec3 {
    let near = |other: &&CornerNormal| {
        other.corner == own.corner || own.normal.angle_between(other.normal) <= smooth.max(1e-9)
    };
    let mut sums: BTreeMap<usize, DVec3> = BTreeMap::new();
    for other in all.iter().filter(near) {
        *sums.entry(other.part).or_default() += other.normal;
    }
    if sums.len() < 2 {
        return own.normal;
    }
    sums.values().map(|sum| sum.normalize_or_zero()).sum::<DVec3>().try_normalize().unwrap_or(own.normal)
}
