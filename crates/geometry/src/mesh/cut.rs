//! Cutting a mesh open: what remains where a height above a cut is not negative.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::curved_side::{CurvedSide, vertex_normals};
use super::face_names::carried;
use super::slice::Plane;
use super::triangulate::polygon_triangles;
use super::{Mesh, MeshError, measure};

/// Share of the mesh's size below which a vertex lies in a cut.
const IN_THE_CUT: f64 = 1e-9;

/// The part of a mesh on the side of a plane to which its normal points; open where the plane cuts it.
///
/// Vertices within 1e-9 of the mesh's size of the plane are taken as in it. Polygons stay polygons; normals and UVs are
/// carried along, linear on each side that is cut. A side is cut where the surface is that its normals tell of, so that
/// the border lies on the round shape and not on its facets; where it has a hard edge or no normals, it is straight.
///
/// # Errors
/// [`MeshError`] where the result has too many corners.
pub fn cut_with_plane(mesh: &Mesh, plane: &Plane) -> Result<Mesh, MeshError> {
    let heights: Vec<f64> = mesh.positions().iter().map(|p| plane.height(*p)).collect();
    cut(mesh, &heights, Line::Within(&|p| plane.height(p) > 0.0))
}

/// Where a side of a polygon is cut whose ends are on both sides.
#[derive(Clone, Copy)]
pub(crate) enum Line<'a> {
    /// Where this changes on the way along the side, bent as the normals tell.
    Within(&'a dyn Fn(DVec3) -> bool),
    /// Where the height, linear along the straight side, is 0.
    Level,
}

/// The part of a mesh at whose vertices `heights` are not negative, and its border along the line.
pub(crate) fn cut(mesh: &Mesh, heights: &[f64], line: Line<'_>) -> Result<Mesh, MeshError> {
    let most = IN_THE_CUT * measure::diagonal(mesh);
    let heights: Vec<f64> = heights.iter().map(|h| if h.abs() <= most { 0.0 } else { *h }).collect();
    let mut cutter = Cutter {
        mesh,
        heights: &heights,
        line,
        vertex_normals: vertex_normals(mesh),
        renumbered: vec![None; mesh.positions().len()],
        crossings: BTreeMap::new(),
        places: Vec::new(),
        positions: Vec::new(),
        corners: Vec::new(),
        counts: Vec::new(),
        normals: Vec::new(),
        uvs: Vec::new(),
        sources: Vec::new(),
    };
    let mut whole: Vec<usize> = Vec::new();
    for polygon in 0..mesh.polygon_count() {
        let range = mesh.corner_range(polygon);
        let within = |corner: usize| heights[mesh.corners()[corner] as usize] >= 0.0;
        let mut before = within(range.end - 1);
        let first = before;
        let changes = range
            .clone()
            .filter(|corner| {
                let now = within(*corner);
                std::mem::replace(&mut before, now) != now
            })
            .count();
        match changes {
            0 if !first => {}
            0 | 2 => {
                whole.clear();
                whole.extend(range);
                cutter.polygon(polygon, &whole);
            }
            _ => {
                for triangle in polygon_triangles(mesh, polygon) {
                    cutter.polygon(polygon, &triangle);
                }
            }
        }
    }
    cutter.finish()
}

/// A corner of a new polygon: one of the mesh, or a place between two.
#[derive(Clone, Copy)]
enum Place {
    Corner(usize),
    Between { from: usize, to: usize, share: f64, vertex: u32, along: DVec3 },
}

struct Cutter<'a> {
    mesh: &'a Mesh,
    heights: &'a [f64],
    line: Line<'a>,
    vertex_normals: Vec<DVec3>,
    renumbered: Vec<Option<u32>>,
    /// New vertices by the side they cut, with the share of the way along it, the lower index first, and its direction.
    crossings: BTreeMap<[u32; 2], (u32, f64, DVec3)>,
    /// Corners of the polygon at hand.
    places: Vec<(u32, Place)>,
    positions: Vec<DVec3>,
    corners: Vec<u32>,
    counts: Vec<usize>,
    normals: Vec<DVec3>,
    uvs: Vec<DVec2>,
    /// The polygon that each new one comes from.
    sources: Vec<Option<usize>>,
}

impl Cutter<'_> {
    fn vertex(&self, corner: usize) -> u32 {
        self.mesh.corners()[corner]
    }

    fn height(&self, corner: usize) -> f64 {
        self.heights[self.vertex(corner) as usize]
    }

    /// Adds what remains of a polygon, or of a part of it, with these corners.
    fn polygon(&mut self, source: usize, corners: &[usize]) {
        // Taken for the time being, so that each polygon does not ask for memory of its own.
        let mut places = std::mem::take(&mut self.places);
        places.clear();
        for (i, corner) in corners.iter().enumerate() {
            let next = corners[(i + 1) % corners.len()];
            if self.height(*corner) >= 0.0 {
                places.push((self.kept(self.vertex(*corner)), Place::Corner(*corner)));
            }
            let (here, there) = (self.height(*corner), self.height(next));
            // A vertex in the cut is the crossing itself.
            if (here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0) {
                let place = self.crossing(*corner, next);
                if let Place::Between { vertex, .. } = place {
                    places.push((vertex, place));
                }
            }
        }
        places.dedup_by_key(|(vertex, _)| *vertex);
        if places.len() > 1 && places[0].0 == places[places.len() - 1].0 {
            places.pop();
        }
        if places.len() < 3
            || places.iter().all(|(_, place)| matches!(place, Place::Corner(c) if self.height(*c) == 0.0))
                && corners.iter().any(|c| self.height(*c) < 0.0)
        {
            self.places = places;
            return;
        }
        for (vertex, place) in &places {
            self.corners.push(*vertex);
            if let Some(normals) = self.mesh.normals() {
                self.normals.push(match place {
                    Place::Corner(corner) => normals[*corner],
                    Place::Between { from, to, share, along, .. } => {
                        let between = normals[*from].lerp(normals[*to], *share);
                        // Square to the bent side: where its curvature changes, the mean of both ends is not.
                        (between - *along * along.dot(between)).try_normalize().unwrap_or(normals[*from])
                    }
                });
            }
            if let Some(uvs) = self.mesh.uvs() {
                self.uvs.push(match place {
                    Place::Corner(corner) => uvs[*corner],
                    Place::Between { from, to, share, .. } => uvs[*from].lerp(uvs[*to], *share),
                });
            }
        }
        self.counts.push(places.len());
        self.sources.push(Some(source));
        self.places = places;
    }

    fn kept(&mut self, vertex: u32) -> u32 {
        let next = self.positions.len() as u32;
        let number = *self.renumbered[vertex as usize].get_or_insert(next);
        if number == next {
            self.positions.push(self.mesh.positions()[vertex as usize]);
        }
        number
    }

    fn crossing(&mut self, from: usize, to: usize) -> Place {
        let (a, b) = (self.vertex(from), self.vertex(to));
        let edge = [a.min(b), a.max(b)];
        let (vertex, share, along) = match self.crossings.get(&edge) {
            Some(found) => *found,
            None => {
                let [low, high] = edge.map(|v| v as usize);
                let ends = [low, high].map(|v| self.mesh.positions()[v]);
                let (side, share) = match self.line {
                    Line::Within(inside) => {
                        let side = CurvedSide::new(ends, [low, high].map(|v| self.vertex_normals[v]));
                        (side, side.crossing(self.heights[low] > 0.0, inside))
                    }
                    Line::Level => {
                        let heights = [low, high].map(|v| self.heights[v]);
                        (CurvedSide::new(ends, [DVec3::ZERO; 2]), heights[0] / (heights[0] - heights[1]))
                    }
                };
                let vertex = self.positions.len() as u32;
                self.positions.push(side.at(share));
                let found = (vertex, share, side.bent_along(share));
                self.crossings.insert(edge, found);
                found
            }
        };
        Place::Between { from, to, share: if a == edge[0] { share } else { 1.0 - share }, vertex, along }
    }

    fn finish(self) -> Result<Mesh, MeshError> {
        let mut mesh = Mesh::from_corners(self.positions, self.corners, self.counts)?;
        if self.mesh.normals().is_some() {
            mesh = mesh.with_normals(self.normals)?;
        }
        if self.mesh.uvs().is_some() {
            mesh = mesh.with_uvs(self.uvs)?;
        }
        carried(mesh.named(self.mesh.name()), self.mesh, &self.sources)
    }
}
