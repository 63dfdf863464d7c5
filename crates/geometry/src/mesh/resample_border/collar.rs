//! The faces along a border, and the outline of what remains without them.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::rim::Rim;
use crate::curve::closest;
use crate::mesh::topology::EdgeUse;
use crate::mesh::vertex_polygons::VertexPolygons;
use crate::mesh::{Mesh, measure};

/// The uses of all edges of the polygons that are gone, and of some others, sorted by edge, then polygon.
fn uses_near(mesh: &Mesh, around: &VertexPolygons, gone: &[bool]) -> Vec<EdgeUse> {
    let going = (0..gone.len()).filter(|polygon| gone[*polygon]);
    let mut near: Vec<u32> =
        going.flat_map(|polygon| mesh.polygon(polygon)).flat_map(|vertex| around.of(*vertex)).copied().collect();
    near.sort_unstable();
    near.dedup();
    let mut uses = Vec::with_capacity(4 * near.len());
    for polygon in near {
        let corners = mesh.polygon(polygon as usize);
        for (k, &from) in corners.iter().enumerate() {
            let to = corners[(k + 1) % corners.len()];
            if from != to {
                uses.push(EdgeUse { edge: [from.min(to), from.max(to)], polygon, forward: from < to });
            }
        }
    }
    uses.sort_unstable();
    uses
}

/// Faces along a border that go.
pub(super) struct Collar {
    /// Whether each polygon goes.
    pub(super) gone: Vec<bool>,
    /// The vertices of the border of what remains, run like the border.
    pub(super) outline: Vec<u32>,
    /// Mean normal of what remains at each vertex of the outline.
    normals: BTreeMap<u32, DVec3>,
}

impl Collar {
    /// The faces with a vertex within `reach` of the border, over the surface. The error is a place on another border
    /// that they reach.
    pub(super) fn of(mesh: &Mesh, around: &VertexPolygons, rim: &Rim, reach: f64) -> Result<Self, DVec3> {
        let mut gone = vec![false; mesh.polygon_count()];
        // Whether a vertex is within reach, as far as it was looked at.
        let mut taken: Vec<Option<bool>> = vec![None; mesh.positions().len()];
        let mut open = rim.vertices.clone();
        open.iter().for_each(|vertex| taken[*vertex as usize] = Some(true));
        while let Some(vertex) = open.pop() {
            for &polygon in around.of(vertex) {
                if std::mem::replace(&mut gone[polygon as usize], true) {
                    continue;
                }
                for &next in mesh.polygon(polygon as usize) {
                    if taken[next as usize].is_none() {
                        let near = closest(&rim.curve, mesh.positions()[next as usize]).distance <= reach;
                        taken[next as usize] = Some(near);
                        if near {
                            open.push(next);
                        }
                    }
                }
            }
        }
        let own: BTreeSet<u32> = rim.vertices.iter().copied().collect();
        let middle = |[a, b]: [u32; 2]| 0.5 * (mesh.positions()[a as usize] + mesh.positions()[b as usize]);
        loop {
            // Sides between what goes and what remains, run like the border; a vertex with several is pinched.
            let mut next: BTreeMap<u32, u32> = BTreeMap::new();
            let mut pinched: Vec<u32> = Vec::new();
            let uses = uses_near(mesh, around, &gone);
            for uses in uses.chunk_by(|a, b| a.edge == b.edge) {
                let [a, b] = uses[0].directed();
                let going = uses.iter().filter(|side| gone[side.polygon as usize]).count();
                if uses.len() == 1 && going == 1 && !(own.contains(&a) && own.contains(&b)) {
                    return Err(middle([a, b]));
                }
                let Some(stays) = uses.iter().find(|side| !gone[side.polygon as usize]) else { continue };
                if going > 0 {
                    let [to, from] = stays.directed();
                    if next.insert(from, to).is_some() {
                        pinched.push(from);
                    }
                }
            }
            if next.is_empty() {
                return Err(rim.centre());
            }
            if !pinched.is_empty() {
                for vertex in pinched {
                    around.of(vertex).iter().for_each(|polygon| gone[*polygon as usize] = true);
                }
                continue;
            }
            let loops = loops_of(next);
            let length = |rim: &Vec<u32>| -> f64 {
                (0..rim.len())
                    .map(|k| {
                        mesh.positions()[rim[k] as usize].distance(mesh.positions()[rim[(k + 1) % rim.len()] as usize])
                    })
                    .sum()
            };
            let Some(longest) =
                (0..loops.len()).max_by(|a, b| length(&loops[*a]).total_cmp(&length(&loops[*b])).then(b.cmp(a)))
            else {
                return Err(rim.centre());
            };
            if loops.len() == 1 {
                return Ok(Self::finished(mesh, gone, around, loops.into_iter().next().unwrap_or_default()));
            }
            // Islands that hang on nothing but what goes, go too; where two hang together, it is no collar.
            let kept = reached(mesh, around, &gone, &loops[longest]);
            for (_, island) in loops.iter().enumerate().filter(|(k, _)| *k != longest) {
                if island.iter().any(|vertex| around.of(*vertex).iter().any(|polygon| kept[*polygon as usize])) {
                    return Err(mesh.positions()[island[0] as usize]);
                }
                let drowned = reached(mesh, around, &gone, island);
                gone.iter_mut().zip(drowned).for_each(|(gone, drowned)| *gone |= drowned);
            }
        }
    }

    fn finished(mesh: &Mesh, gone: Vec<bool>, around: &VertexPolygons, outline: Vec<u32>) -> Self {
        let mut normals = BTreeMap::new();
        for &vertex in &outline {
            let mut sum = DVec3::ZERO;
            for polygon in around.of(vertex).iter().map(|polygon| *polygon as usize).filter(|polygon| !gone[*polygon]) {
                let corner = mesh.corner_range(polygon).find(|corner| mesh.corners()[*corner] == vertex);
                sum += match (mesh.normals(), corner) {
                    (Some(normals), Some(corner)) => normals[corner],
                    _ => measure::polygon_normal(mesh, polygon),
                };
            }
            normals.insert(vertex, sum.normalize_or_zero());
        }
        Self { gone, outline, normals }
    }

    /// The mean normal of what remains at a vertex of the outline.
    pub(super) fn normal(&self, vertex: u32) -> DVec3 {
        self.normals.get(&vertex).copied().unwrap_or_default()
    }
}

/// The loops that these steps make, in the order of their first vertices.
fn loops_of(mut next: BTreeMap<u32, u32>) -> Vec<Vec<u32>> {
    let mut loops = Vec::new();
    while let Some((first, to)) = next.pop_first() {
        let (mut path, mut at) = (vec![first], to);
        while let Some(then) = next.remove(&at) {
            path.push(at);
            at = then;
        }
        loops.push(path);
    }
    loops
}

/// The polygons that remain and hang together with those at these vertices.
fn reached(mesh: &Mesh, around: &VertexPolygons, gone: &[bool], from: &[u32]) -> Vec<bool> {
    let mut reached = vec![false; gone.len()];
    let mut open = from.to_vec();
    while let Some(vertex) = open.pop() {
        for &polygon in around.of(vertex) {
            let polygon = polygon as usize;
            if !gone[polygon] && !std::mem::replace(&mut reached[polygon], true) {
                open.extend(mesh.polygon(polygon));
            }
        }
    }
    reached
}
