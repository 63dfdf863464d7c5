//! The part of a mesh that a deformation touches: its free vertices and three rings around them.

use glam::DVec3;

use super::error::BindError;
use super::handle::Holds;
use crate::linear_solver::nested_dissection::Graph;
use crate::mesh::adjacency::Adjacency;
use crate::mesh::manifold::ManifoldReport;
use crate::mesh::triangulate::polygon_triangles;
use crate::mesh::vertex_polygons::VertexPolygons;
use crate::mesh::weights::{cotangents, mixed_areas};
use crate::mesh::{Mesh, measure};

/// Rings of held vertices around the free ones: two with which gradients are compared, and one that makes theirs.
const HALO: u8 = 3;

/// Who holds a vertex, where one does: nobody moved it, or a handle by its index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Holder {
    Still,
    Handle(usize),
}

/// The free vertices and three rings around them, counted anew: the free ones first, then the others, both in the order
/// of the mesh. What lies farther away costs nothing after the patch is made.
#[derive(Debug)]
pub(super) struct Patch {
    /// The vertex of the mesh that each is.
    pub vertices: Vec<u32>,
    /// How many of them are free to move.
    pub free: usize,
    /// Edges to the nearest free vertex, 4 and more as 4.
    pub ring: Vec<u8>,
    /// Who prescribes the position, for all but the free ones.
    pub position: Vec<Option<Holder>>,
    /// Who prescribes the deformation gradient.
    pub gradient: Vec<Option<Holder>>,
    /// Where they are.
    pub points: Vec<DVec3>,
    /// Normals, of length 1 or 0, weighted by areas.
    pub normals: Vec<DVec3>,
    /// Triangles with their weight: a convex quad is split along both diagonals, each half as heavy, so that no choice
    /// of diagonal turns with the axes or spoils a symmetry.
    pub triangles: Vec<([u32; 3], f64)>,
    /// Joined by an edge of a triangle.
    pub adjacency: Adjacency,
}

impl Patch {
    /// `handles` are lists of vertices with what is held there; `in_region` says which other vertices are free.
    pub fn new(
        mesh: &Mesh,
        in_region: &dyn Fn(usize) -> bool,
        handles: &[(Vec<u32>, Holds)],
    ) -> Result<Self, BindError> {
        let count = mesh.positions().len();
        let mut position = vec![None; count];
        let mut gradient = vec![None; count];
        for (index, (vertices, holds)) in handles.iter().enumerate() {
            let by = Some(Holder::Handle(index));
            for &vertex in vertices {
                position[vertex as usize] = if *holds == Holds::Gradient { None } else { by };
                gradient[vertex as usize] = if *holds == Holds::Position { None } else { by };
            }
        }
        let stars = VertexPolygons::new(mesh);
        for vertex in 0..count {
            let held = position[vertex].is_some() || gradient[vertex].is_some();
            if (!held && !in_region(vertex)) || stars.of(vertex as u32).is_empty() {
                let by = position[vertex].or(Some(Holder::Still));
                (position[vertex], gradient[vertex]) = (by, gradient[vertex].or(by));
            }
        }
        let (vertices, free) = reach(mesh, &stars, &position);
        let mut local = vec![u32::MAX; count];
        for (index, vertex) in vertices.iter().enumerate() {
            local[*vertex as usize] = index as u32;
        }
        let mut polygons: Vec<u32> = vertices.iter().flat_map(|v| stars.of(*v)).copied().collect();
        polygons.sort_unstable();
        polygons.dedup();
        polygons.retain(|p| mesh.polygon(*p as usize).iter().all(|v| local[*v as usize] != u32::MAX));
        let triangles = split(mesh, &polygons, &local);
        let sides = triangles.iter().flat_map(|([a, b, c], _)| [[*a, *b], [*b, *c], [*c, *a]]);
        let adjacency = Adjacency::new(vertices.len(), sides);
        let all_free: Vec<u32> = (0..free as u32).collect();
        let ring: Vec<u8> = adjacency.edge_distances(&all_free).iter().map(|d| (*d).min(4) as u8).collect();

        // Vertices of the outer rings have polygons that are not here.
        let near = |v: u32| local[v as usize] != u32::MAX && ring[local[v as usize] as usize] < HALO;
        let report = ManifoldReport::of_polygons(mesh, polygons.iter().map(|p| *p as usize), near);
        if !report.is_manifold() {
            return Err(BindError::not_manifold(&report, mesh));
        }
        let points: Vec<DVec3> = vertices.iter().map(|v| mesh.positions()[*v as usize]).collect();
        let mut normals = vec![DVec3::ZERO; vertices.len()];
        for (corners, weight) in &triangles {
            let area = measure::vector_area(corners.map(|v| points[v as usize]));
            for vertex in corners {
                normals[*vertex as usize] += *weight * area;
            }
        }
        normals.iter_mut().for_each(|n| *n = n.normalize_or_zero());
        let pick = |of: &[Option<Holder>]| vertices.iter().map(|v| of[*v as usize]).collect();
        let (position, gradient) = (pick(&position), pick(&gradient));
        Ok(Self { vertices, free, ring, position, gradient, points, normals, triangles, adjacency })
    }

    /// Number of vertices.
    pub fn len(&self) -> usize {
        self.vertices.len()
    }

    /// The free vertices as unknowns of a matrix that couples them over `reach` edges, those of held vertices among them.
    pub fn graph(&self, reach: u32) -> Graph {
        let is_free = |vertex: u32| (vertex as usize) < self.free;
        let mut lists = Vec::with_capacity(self.free);
        for vertex in 0..self.free as u32 {
            let mut list: Vec<u32> = Vec::new();
            let mut passed: Vec<u32> = Vec::new();
            let (mut from, mut steps) = (0, 1);
            let mut look = |passed: &mut Vec<u32>, at: u32| {
                for &next in self.adjacency.ring(at) {
                    if is_free(next) {
                        list.push(next);
                    } else if !passed.contains(&next) {
                        passed.push(next);
                    }
                }
            };
            look(&mut passed, vertex);
            // On through what is held: across a narrow handle.
            while steps < reach && from < passed.len() {
                let end = passed.len();
                for at in from..end {
                    let held = passed[at];
                    look(&mut passed, held);
                }
                (from, steps) = (end, steps + 1);
            }
            if !passed.is_empty() {
                list.sort_unstable();
                list.dedup();
                list.retain(|other| *other != vertex);
            }
            lists.push(list);
        }
        Graph::new(&self.points[..self.free], lists.iter().map(Vec::as_slice), reach)
    }

    /// Weights of the edges at each vertex, by its neighbours in ascending order: the cotangents of both angles across,
    /// without the half (3. of the thesis' 2.3); and the mixed area of each vertex.
    ///
    /// Whole only for vertices within two rings of the free ones.
    pub fn weights(&self) -> (Vec<Vec<f64>>, Vec<f64>) {
        let mut weights: Vec<Vec<f64>> =
            (0..self.len()).map(|v| vec![0.0; self.adjacency.ring(v as u32).len()]).collect();
        let mut areas = vec![0.0; self.len()];
        let mut add = |from: u32, to: u32, weight: f64| {
            if let Ok(place) = self.adjacency.ring(from).binary_search(&to) {
                weights[from as usize][place] += weight;
            }
        };
        for ([a, b, c], weight) in &self.triangles {
            let corners = [*a, *b, *c].map(|v| self.points[v as usize]);
            let (cotangents, _) = cotangents(corners);
            for (cotangent, [from, to]) in cotangents.iter().zip([[*b, *c], [*c, *a], [*a, *b]]) {
                add(from, to, weight * cotangent);
                add(to, from, weight * cotangent);
            }
            for (vertex, area) in [*a, *b, *c].iter().zip(mixed_areas(corners)) {
                areas[*vertex as usize] += weight * area;
            }
        }
        (weights, areas)
    }
}

/// The free vertices, then those within three polygons of them; both ascending. And the number of the free ones.
fn reach(mesh: &Mesh, stars: &VertexPolygons, position: &[Option<Holder>]) -> (Vec<u32>, usize) {
    let mut vertices: Vec<u32> = (0..position.len() as u32).filter(|v| position[*v as usize].is_none()).collect();
    let free = vertices.len();
    let mut reached: Vec<bool> = position.iter().map(Option::is_none).collect();
    let mut edge = 0;
    for _ in 0..HALO {
        let end = vertices.len();
        for i in edge..end {
            for polygon in stars.of(vertices[i]) {
                for &vertex in mesh.polygon(*polygon as usize) {
                    if !reached[vertex as usize] {
                        reached[vertex as usize] = true;
                        vertices.push(vertex);
                    }
                }
            }
        }
        edge = end;
    }
    vertices[free..].sort_unstable();
    (vertices, free)
}

fn split(mesh: &Mesh, polygons: &[u32], local: &[u32]) -> Vec<([u32; 3], f64)> {
    let mut triangles = Vec::new();
    for &polygon in polygons {
        let corners = mesh.polygon(polygon as usize);
        if let [a, b, c, d] = *corners
            && is_convex([a, b, c, d].map(|v| mesh.positions()[v as usize]))
        {
            triangles.extend([[a, b, c], [c, d, a], [b, c, d], [d, a, b]].map(|triangle| (triangle, 0.5)));
        } else {
            let whole = polygon_triangles(mesh, polygon as usize);
            triangles.extend(whole.into_iter().map(|triangle| (triangle.map(|corner| mesh.corners()[corner]), 1.0)));
        }
    }
    triangles.retain(|([a, b, c], _)| a != b && b != c && c != a);
    for (triangle, _) in &mut triangles {
        *triangle = triangle.map(|vertex| local[vertex as usize]);
    }
    triangles
}

/// Whether both diagonals of a quad part it into halves that face the same way.
fn is_convex([a, b, c, d]: [DVec3; 4]) -> bool {
    let agree = |p: DVec3, q: DVec3| p.dot(q) > 0.0;
    agree((b - a).cross(c - a), (c - a).cross(d - a)) && agree((c - b).cross(d - b), (d - b).cross(a - b))
}
