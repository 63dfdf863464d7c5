//! Deformation gradients as rows over positions (thesis 2.4.1), degenerate vertices among them (2.4.3).

use glam::{DMat3, DVec3};

use super::error::BindError;
use super::patch::Patch;
use super::rows::Rows;

/// Condition number of `V V^T` above which a vertex is degenerate (thesis 2.4.3).
const LARGEST_CONDITION: f64 = 2e5;

/// How far a degenerate vertex is displaced, in mean lengths of its edges: `s_disp` of (2.9).
const DISPLACEMENT: f64 = 0.2;

/// Rings that a stencil may take in where one is not enough.
const MOST_RINGS: usize = 4;

/// The deformation gradient at each vertex that has none prescribed: `M_i = sum_k x_k c_ik^T` (2.5).
#[derive(Debug)]
pub(super) struct Gradients {
    /// The `c_ik`, 1/m, by vertex; empty where the gradient is prescribed or not wanted.
    pub rows: Rows<DVec3>,
    /// The positions for which they are made: those of the mesh, degenerate vertices displaced.
    pub points: Vec<DVec3>,
    /// Whether a row has entries.
    pub wanted: Vec<bool>,
    /// Degenerate vertices that were displaced.
    pub displaced: usize,
    /// Vertices with more than one ring.
    pub widened: usize,
}

impl Gradients {
    /// Rows for the free vertices and for those within two rings of them, where the gradient is not prescribed.
    ///
    /// Degenerate vertices are displaced one after the other (2.9), so that later ones see earlier displacements. Only
    /// free vertices are: the others have to stay where they are held. What is still degenerate takes in more rings: the
    /// vertices with two neighbours or with all neighbours on a line, for which the thesis inserts vertices, and the held
    /// ones.
    pub fn new(patch: &Patch) -> Result<Self, BindError> {
        let wanted: Vec<bool> = (0..patch.len()).map(|v| patch.gradient[v].is_none() && patch.ring[v] <= 2).collect();
        let mut points = patch.points.clone();
        let mut displaced = 0;
        for vertex in (0..patch.free).filter(|v| wanted[*v]) {
            let ring = patch.adjacency.ring(vertex as u32);
            if condition(moment(&points, vertex, ring)) <= LARGEST_CONDITION {
                continue;
            }
            let before = points[vertex];
            let reach: f64 = ring.iter().map(|k| before.distance(points[*k as usize])).sum();
            points[vertex] += DISPLACEMENT * reach / ring.len().max(1) as f64 * patch.normals[vertex];
            if condition(moment(&points, vertex, ring)) <= LARGEST_CONDITION {
                displaced += 1;
            } else {
                points[vertex] = before;
            }
        }
        let mut rows = Rows::new();
        let mut widened = 0;
        for (vertex, wanted) in wanted.iter().enumerate() {
            if !wanted {
                rows.push([]);
                continue;
            }
            let mut stencil = patch.adjacency.ring(vertex as u32).to_vec();
            let mut rings = 1;
            while condition(moment(&points, vertex, &stencil)) > LARGEST_CONDITION {
                rings += 1;
                if rings > MOST_RINGS {
                    let at = patch.points[vertex];
                    return Err(BindError::NoExtent { vertex: patch.vertices[vertex], at });
                }
                stencil = patch.adjacency.within(vertex as u32, rings);
            }
            widened += usize::from(rings > 1);
            rows.push(row(&points, vertex, &stencil));
        }
        Ok(Self { rows, points, wanted, displaced, widened })
    }
}

/// `V V^T` of a vertex and its neighbours (2.4), without unit: lengths over that of the longest arm.
fn moment(points: &[DVec3], vertex: usize, ring: &[u32]) -> DMat3 {
    let (arms, scale) = arms(points, vertex, ring);
    arms.map(|arm| outer(arm * scale, arm * scale)).fold(DMat3::ZERO, |sum, m| sum + m)
}

/// The columns of `V`, the vertex' own first, and the inverse of the length of the longest one.
fn arms<'a>(points: &'a [DVec3], vertex: usize, ring: &'a [u32]) -> (impl Iterator<Item = DVec3> + Clone + 'a, f64) {
    // Taken about the vertex, so that far from the origin no digits are lost.
    let own = points[vertex];
    let mean = ring.iter().map(|k| points[*k as usize] - own).sum::<DVec3>() / ring.len().max(1) as f64;
    let arms = std::iter::once(-mean).chain(ring.iter().map(move |k| points[*k as usize] - own - mean));
    let longest = arms.clone().map(DVec3::length).fold(0.0, f64::max);
    (arms, if longest > 0.0 { 1.0 / longest } else { 0.0 })
}

fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

/// Ratio of the largest to the smallest eigenvalue of a symmetric, positive semi-definite matrix.
fn condition(moment: DMat3) -> f64 {
    let matrix: nalgebra::Matrix3<f64> = moment.into();
    if !moment.is_finite() {
        return f64::INFINITY;
    }
    // By the adjugate first: the bound det <= smallest * largest^2 settles the good ones without an iteration.
    let trace = matrix.trace();
    let determinant = matrix.determinant();
    if trace > 0.0 && trace.powi(3) <= LARGEST_CONDITION * determinant {
        return trace.powi(3) / determinant;
    }
    let values = matrix.symmetric_eigenvalues();
    let (smallest, largest) = (values.min(), values.max());
    if smallest > 0.0 { largest / smallest } else { f64::INFINITY }
}

/// The `c_ik` of (2.5), the vertex among its neighbours, in ascending order of the vertices.
fn row(points: &[DVec3], vertex: usize, ring: &[u32]) -> Vec<(u32, DVec3)> {
    let (arms, scale) = arms(points, vertex, ring);
    let inverse = moment(points, vertex, ring).inverse();
    let parts: Vec<DVec3> = arms.map(|arm| inverse * (arm * scale) * scale).collect();
    // The mean of the neighbours is taken off every column, and so every neighbour has a share of all.
    let shared = parts.iter().sum::<DVec3>() / ring.len() as f64;
    let mut entries: Vec<(u32, DVec3)> = ring.iter().zip(&parts[1..]).map(|(k, part)| (*k, *part - shared)).collect();
    let place = entries.partition_point(|(k, _)| (*k as usize) < vertex);
    entries.insert(place, (vertex as u32, parts[0]));
    // The inverse loses up to five digits; the gradient that the row finds in the points themselves, which must be the
    // identity, shows what is missing.
    let own = points[vertex];
    let found = entries.iter().fold(DMat3::ZERO, |sum, (k, c)| sum + outer(points[*k as usize] - own, *c));
    let correction = found.inverse().transpose();
    entries.iter_mut().for_each(|(_, c)| *c = correction * *c);
    entries
}
