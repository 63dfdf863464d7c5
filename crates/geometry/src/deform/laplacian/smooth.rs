//! Taking short waves off a surface.

use std::sync::Arc;

use glam::DVec3;

use super::error::BindError;
use super::patch::Patch;
use super::rows::{Rows, lower_triangle};
use crate::linear_solver::{Cholesky, LinearSolverError};
use crate::mesh::select::Selection;
use crate::mesh::{Mesh, Topology};

/// Why a mesh is not smoothed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshSmoothError {
    /// A wavelength that is none.
    #[error("the wave is {wave} m: give a length above 0")]
    Wave {
        /// What was given.
        wave: f64,
    },
    /// A selection of another mesh.
    #[error("the selection has {found} weights, and the mesh {vertices} vertices: select on the mesh that is smoothed")]
    WrongSelection {
        /// Weights found.
        found: usize,
        /// Vertices of the mesh.
        vertices: usize,
    },
    /// A surface that cannot be smoothed.
    #[error(transparent)]
    Surface(#[from] BindError),
    /// The system has no factor.
    #[error("the smooth surface cannot be computed: {0}")]
    Solver(#[from] LinearSolverError),
    /// Numbers beyond what can be computed with.
    #[error("the smooth mesh has a vertex that is not finite: bring the mesh nearer to the origin")]
    Overflow,
    /// `progress` asked to stop.
    #[error("stopped")]
    Stopped,
}

/// A smoothed mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct SmoothedMesh {
    /// The mesh with its polygons, name and UVs as they were, without normals.
    pub mesh: Mesh,
    /// How far the vertex moves that moves farthest, metres.
    pub largest_move: f64,
}

/// Takes waves shorter than `wave` metres off a mesh, without shrinking it: a wave of this length is halved, one of twice
/// this length keeps 94 %, one of half this length 6 %.
///
/// One implicit step of the bilaplacian flow (Desbrun, Meyer, Schröder and Barr, Implicit Fairing of Irregular Meshes
/// using Diffusion and Curvature Flow, 1999) with cotangent weights `L` and vertex areas `A`:
/// `(A + t^2 L A^-1 L) x' = A x`, `t = (wave / 2 pi)^2`, solved for the displacements. Where `selection` has a weight
/// below 1, only that share of the way is gone; weight 0 stays, and the surface goes on smoothly from there.
/// `hold_borders` keeps vertices of boundary edges in place.
///
/// # Errors
/// [`MeshSmoothError`] for a wave that is not above 0 and finite, a selection of another mesh, and a surface that is
/// not a 2-manifold where it is smoothed.
pub fn smooth_mesh(
    mesh: &Arc<Mesh>,
    selection: Option<&Selection>,
    wave: f64,
    hold_borders: bool,
    progress: &dyn Fn(f64) -> bool,
) -> Result<SmoothedMesh, MeshSmoothError> {
    let go_on = |done: f64| if progress(done) { Ok(()) } else { Err(MeshSmoothError::Stopped) };
    go_on(0.0)?;
    if !(wave.is_finite() && wave > 0.0) {
        return Err(MeshSmoothError::Wave { wave });
    }
    let vertices = mesh.positions().len();
    if let Some(selection) = selection.filter(|s| s.weights().len() != vertices) {
        return Err(MeshSmoothError::WrongSelection { found: selection.weights().len(), vertices });
    }
    let mut share: Vec<f64> = match selection {
        Some(selection) => selection.weights().to_vec(),
        None => vec![1.0; vertices],
    };
    if hold_borders {
        Topology::new(mesh).boundary_edges().iter().flatten().for_each(|v| share[*v as usize] = 0.0);
    }
    go_on(0.1)?;
    let patch = Patch::new(mesh, &|vertex| share[vertex] > 0.0, &[])?;
    let (weights, areas) = patch.weights();
    go_on(0.3)?;
    // `t L A^-1` of rows within one ring of the free vertices: what their displacements reach.
    let t = (wave / std::f64::consts::TAU).powi(2);
    let mut laplacians = Rows::new();
    for (vertex, weights) in weights.iter().enumerate() {
        laplacians.push(if patch.ring[vertex] <= 1 { row(&patch, vertex, weights) } else { Vec::new() });
    }
    let inverse = |v: usize| if areas[v] > 0.0 { t / areas[v] } else { 0.0 };
    let scaled: Vec<Vec<(u32, f64)>> =
        (0..patch.len()).map(|v| laplacians.row(v).map(|(k, w)| (k as u32, w * t * inverse(v))).collect()).collect();
    let scaled = Rows::collect(scaled);
    let columns = laplacians.transposed(patch.free);
    let matrix = lower_triangle(
        patch.free,
        |vertex, column| {
            column.add_product(&columns, &scaled, |a: f64, b: f64| a * b);
            column.add_entries(std::iter::once((vertex, areas[vertex])));
        },
        &|| go_on(0.4),
    )?;
    go_on(0.6)?;
    let factor = Cholesky::factor_along(&matrix, &patch.graph(2))?;
    go_on(0.9)?;
    // -t^2 L A^-1 L x, by the rows.
    let mut sides = vec![DVec3::ZERO; patch.free];
    for vertex in 0..patch.len() {
        let own = patch.points[vertex];
        let curvature: DVec3 = laplacians.row(vertex).map(|(k, w)| w * (patch.points[k] - own)).sum();
        let curvature = curvature * t * inverse(vertex);
        for (k, w) in laplacians.row(vertex).filter(|(k, _)| *k < patch.free) {
            sides[k] -= w * curvature;
        }
    }
    factor.solve_points(&mut sides)?;
    let mut positions = mesh.positions().to_vec();
    let mut largest_move: f64 = 0.0;
    for (vertex, displacement) in patch.vertices.iter().zip(&sides) {
        let by = share[*vertex as usize] * *displacement;
        positions[*vertex as usize] += by;
        largest_move = largest_move.max(by.length());
    }
    let smooth = mesh.with_positions(positions, None).map_err(|_| MeshSmoothError::Overflow)?;
    Ok(SmoothedMesh { mesh: smooth, largest_move })
}

/// `sum_j w_ij (v_i - v_j)`, the half of the cotangents, as a row.
fn row(patch: &Patch, vertex: usize, weights: &[f64]) -> Vec<(u32, f64)> {
    let ring = patch.adjacency.ring(vertex as u32);
    let mut entries: Vec<(u32, f64)> = ring.iter().zip(weights).map(|(k, w)| (*k, -0.5 * w)).collect();
    let place = entries.partition_point(|(k, _)| (*k as usize) < vertex);
    entries.insert(place, (vertex as u32, 0.5 * weights.iter().sum::<f64>()));
    entries
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deform::laplacian::tests::{bar, ring, sheet};
    use crate::mesh::measure;

    /// A strip of 1 m with so many waves along it, a hundredth of their length high.
    fn wavy(waves: f64) -> (Arc<Mesh>, f64) {
        let strip = sheet(256, 8);
        let height = 0.01 / waves;
        let lift = |p: &DVec3| p.with_y(height * (std::f64::consts::TAU * p.x * waves).cos());
        let mesh = strip.with_positions(strip.positions().iter().map(lift).collect(), None).unwrap();
        (Arc::new(mesh), height)
    }

    #[test]
    fn waves_lose_what_is_said() {
        for (waves, kept) in [(8.0, 16.0 / 17.0), (16.0, 0.5), (32.0, 1.0 / 17.0)] {
            let (mesh, height) = wavy(waves);
            let made = smooth_mesh(&mesh, None, 1.0 / 16.0, false, &|_| true).unwrap();
            // Far from the ends, which are free to bend.
            let heights = made.mesh.positions().iter().filter(|p| (p.x - 0.5).abs() < 0.13).map(|p| p.y);
            let (low, high) = heights.fold((f64::MAX, f64::MIN), |(low, high), y| (low.min(y), high.max(y)));
            let found = 0.5 * (high - low) / height;
            // The shortest wave has eight edges only.
            assert!((found - kept).abs() < 0.02, "{waves}: {found:.3}, wanted {kept:.3}");
        }
    }

    #[test]
    fn a_body_keeps_its_volume_and_loses_its_noise() {
        let torus = ring(120, 48, true);
        let noise = |v: usize| 0.01 * (((v * 7919) % 101) as f64 / 50.0 - 1.0);
        let rough: Vec<DVec3> =
            torus.positions().iter().enumerate().map(|(v, p)| *p + noise(v) * p.normalize()).collect();
        let rough = Arc::new(torus.with_positions(rough, None).unwrap());
        let made = smooth_mesh(&rough, None, 0.3, true, &|_| true).unwrap().mesh;
        let off = |mesh: &Mesh| {
            let to = crate::mesh::MeshDistance::new(&torus).unwrap();
            let squares = mesh.positions().iter().map(|p| to.nearest(*p).distance.powi(2));
            (squares.sum::<f64>() / mesh.positions().len() as f64).sqrt()
        };
        assert!(off(&made) < 0.5 * off(&rough), "{} of {}", off(&made), off(&rough));
        let ratio = measure::signed_volume(&made) / measure::signed_volume(&rough);
        assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
    }

    #[test]
    fn what_is_not_selected_stays_and_borders_where_wanted() {
        let mesh = Arc::new(bar(4, 16, false));
        let upper = Selection::weighted(mesh.positions().len(), |v| mesh.positions()[v].y - 2.0);
        let made = smooth_mesh(&mesh, Some(&upper), 1.0, false, &|_| true).unwrap();
        let moved = |v: usize| made.mesh.positions()[v] != mesh.positions()[v];
        for v in 0..mesh.positions().len() {
            assert!(mesh.positions()[v].y > 2.0 || !moved(v));
        }
        assert!(made.largest_move > 0.05);
        let (waves, _) = wavy(4.0);
        let held = smooth_mesh(&waves, None, 0.0625, true, &|_| true).unwrap().mesh;
        let border = |p: &DVec3| p.x < 1e-9 || p.x > 1.0 - 1e-9;
        assert!(waves.positions().iter().zip(held.positions()).filter(|(p, _)| border(p)).all(|(p, q)| p == q));
    }

    #[test]
    fn what_makes_no_sense_is_refused() {
        let mesh = Arc::new(bar(2, 4, true));
        let run = |selection: Option<&Selection>, wave: f64| smooth_mesh(&mesh, selection, wave, true, &|_| true);
        assert_eq!(run(None, 0.0).unwrap_err(), MeshSmoothError::Wave { wave: 0.0 });
        assert!(matches!(run(None, f64::NAN).unwrap_err(), MeshSmoothError::Wave { .. }));
        let other = Selection::by(3, |_| true);
        let vertices = mesh.positions().len();
        assert_eq!(run(Some(&other), 1.0).unwrap_err(), MeshSmoothError::WrongSelection { found: 3, vertices });
        assert_eq!(smooth_mesh(&mesh, None, 1.0, true, &|done| done < 0.5), Err(MeshSmoothError::Stopped));
        let nothing = Selection::by(vertices, |_| false);
        assert_eq!(run(Some(&nothing), 1.0).unwrap().mesh.positions(), mesh.positions());
    }
}
