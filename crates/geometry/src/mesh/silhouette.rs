//! The outline of a mesh in an orthographic view.

use glam::DVec2;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::float::simplify::SimplifyShape;

use super::{Mesh, triangles};
use crate::curve::{Curve, CurveError};
use crate::polygon::signed_area;
use crate::view::View;

/// Triangles between two questions whether to go on.
const PACE: usize = 1 << 14;

/// The outline of a mesh in a view: what its shadow would be.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshSilhouette {
    /// The outer boundaries, counter-clockwise as seen, the one around the largest area first; then the holes, clockwise.
    pub curves: Vec<Curve>,
    /// How many of them are outer boundaries.
    pub outer: usize,
    /// The area of the shadow, square metres.
    pub area: f64,
}

/// Why a mesh has no outline.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshSilhouetteError {
    /// Nothing is seen of the mesh.
    #[error("nothing of the mesh is seen in the {view} view: all of its faces are edge on, or it has none")]
    Nothing {
        /// The view.
        view: &'static str,
    },
    /// Coordinates beyond all use.
    #[error("a coordinate of the mesh is beyond 1e100 m: scale it down")]
    TooLarge,
    /// A depth that is no distance.
    #[error("the depth is {depth}: it must be a finite number of metres")]
    Depth {
        /// What was given.
        depth: f64,
    },
    /// The outline's points make no curve.
    #[error("the outline is no curve: {0}")]
    Curve(#[from] CurveError),
    /// `progress` asked to stop.
    #[error("stopped")]
    Cancelled,
}

/// The outline of `mesh` as seen in `view`, as closed curves that lie `depth` metres along the direction of sight.
///
/// The contour edges, those between faces of which only one looks towards the eye and those at open borders, are found
/// with exact predicates and projected; the outline is the boundary of the area around which they wind, by sweep line
/// (`i_overlay`, 64 bit integers: coordinates are those of the mesh, and crossings are exact, to 1e-15 of the mesh's
/// size). Neither open meshes nor inconsistent orientation, self-intersections or faces seen edge on matter. Polygons
/// count as their [`triangles`].
///
/// # Errors
/// [`MeshSilhouetteError`] where nothing is seen, and where `progress`, called with the fraction done, asked to stop.
pub fn silhouette_of(
    mesh: &Mesh,
    view: View,
    depth: f64,
    progress: &dyn Fn(f64) -> bool,
) -> Result<MeshSilhouette, MeshSilhouetteError> {
    let go_on = |done: f64| if progress(done) { Ok(()) } else { Err(MeshSilhouetteError::Cancelled) };
    go_on(0.0)?;
    if !depth.is_finite() {
        return Err(MeshSilhouetteError::Depth { depth });
    }
    if mesh.positions().iter().any(|p| p.abs().max_element() > 1e100) {
        return Err(MeshSilhouetteError::TooLarge);
    }
    let seen: Vec<DVec2> = mesh.positions().iter().map(|p| view.flat(*p)).collect();
    // Triangles that run counter-clockwise as seen, and those that are turned round to.
    let mut edges: [Vec<Edge>; 2] = [Vec::new(), Vec::new()];
    for (done, corners) in triangles(mesh).enumerate() {
        if done % PACE == 0 {
            go_on(0.5 * done as f64 / mesh.corners().len().max(1) as f64)?;
        }
        let [a, b, c] = corners.map(|corner| mesh.corners()[corner]);
        let [p, q, r] = [a, b, c].map(|v| robust::Coord { x: seen[v as usize].x, y: seen[v as usize].y });
        let turn = robust::orient2d(p, q, r);
        let (side, around) = match turn {
            t if t > 0.0 => (0, [(a, b), (b, c), (c, a)]),
            t if t < 0.0 => (1, [(b, a), (c, b), (a, c)]),
            _ => continue,
        };
        edges[side].extend(around.map(|(from, to)| Edge::new(from, to)));
    }
    let [towards, away] = edges.map(net);
    go_on(0.6)?;
    // Both sides of a closed mesh have the same contour.
    let mut loops = loops(&towards);
    if away != towards {
        loops.extend(self::loops(&away));
    }
    let contours: Vec<Vec<[f64; 2]>> =
        loops.iter().map(|around| around.iter().map(|v| seen[*v as usize].to_array()).collect()).collect();
    let shapes = contours.simplify_shape_as::<i64>(FillRule::NonZero);
    go_on(0.9)?;
    let (mut outer, mut holes) = (Vec::new(), Vec::new());
    let mut area = 0.0;
    for shape in shapes {
        for (which, around) in shape.into_iter().enumerate() {
            let mut points: Vec<DVec2> = around.into_iter().map(DVec2::from_array).collect();
            let size = signed_area(&points);
            if size == 0.0 || points.len() < 3 {
                continue;
            }
            if (size > 0.0) != (which == 0) {
                points.reverse();
            }
            area += if which == 0 { size.abs() } else { -size.abs() };
            if which == 0 { &mut outer } else { &mut holes }.push((size.abs(), points));
        }
    }
    if outer.is_empty() {
        return Err(MeshSilhouetteError::Nothing { view: view.name() });
    }
    // By area, and by place where areas are equal.
    let by_area = |a: &(f64, Vec<DVec2>), b: &(f64, Vec<DVec2>)| {
        let place = |p: &[DVec2]| p.iter().fold(DVec2::INFINITY, |low, p| low.min(*p)).to_array();
        let (pa, pb) = (place(&a.1), place(&b.1));
        b.0.total_cmp(&a.0).then(pa[0].total_cmp(&pb[0])).then(pa[1].total_cmp(&pb[1]))
    };
    outer.sort_by(by_area);
    holes.sort_by(by_area);
    let count = outer.len();
    let mut curves = Vec::with_capacity(count + holes.len());
    for (kind, list) in [("outline", outer), ("hole", holes)] {
        for (k, (_, points)) in list.into_iter().enumerate() {
            let name = if k == 0 { kind.to_owned() } else { format!("{kind} {}", k + 1) };
            curves.push(Curve::new(name, points.into_iter().map(|p| view.place(p, depth)).collect(), true)?);
        }
    }
    go_on(1.0)?;
    Ok(MeshSilhouette { curves, outer: count, area })
}

/// An edge between two vertices, `low < high`, and how often it is run up or down (negative).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Edge {
    low: u32,
    high: u32,
    runs: i32,
}

impl Edge {
    fn new(from: u32, to: u32) -> Self {
        if from < to { Self { low: from, high: to, runs: 1 } } else { Self { low: to, high: from, runs: -1 } }
    }
}

/// The edges that remain when those run both ways cancel.
fn net(mut edges: Vec<Edge>) -> Vec<Edge> {
    edges.sort_unstable();
    let same = edges.chunk_by(|a, b| (a.low, a.high) == (b.low, b.high));
    let sums = same.map(|run| Edge { runs: run.iter().map(|edge| edge.runs).sum(), ..run[0] });
    sums.filter(|edge| edge.runs != 0).collect()
}

/// The edges as closed loops of vertices. At each vertex as many begin as end, being what remains of triangles.
fn loops(edges: &[Edge]) -> Vec<Vec<u32>> {
    let mut ways: Vec<(u32, u32)> = Vec::new();
    for edge in edges {
        let way = if edge.runs > 0 { (edge.low, edge.high) } else { (edge.high, edge.low) };
        ways.extend(std::iter::repeat_n(way, edge.runs.unsigned_abs() as usize));
    }
    ways.sort_unstable();
    // The next way from each vertex that has not been gone; ways of one vertex stand together.
    let mut gone = vec![false; ways.len()];
    let mut loops = Vec::new();
    for first in 0..ways.len() {
        if gone[first] {
            continue;
        }
        let (start, mut here) = ways[first];
        gone[first] = true;
        let mut around = vec![start];
        while here != start {
            around.push(here);
            let begin = ways.partition_point(|way| way.0 < here);
            let Some(next) = (begin..ways.len()).take_while(|k| ways[*k].0 == here).find(|k| !gone[*k]) else { break };
            gone[next] = true;
            here = ways[next].1;
        }
        loops.push(around);
    }
    loops
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use glam::{DQuat, DVec3};

    use super::*;

    fn go(mesh: &Mesh, view: View) -> Result<MeshSilhouette, MeshSilhouetteError> {
        silhouette_of(mesh, view, 0.5, &|_| true)
    }

    /// A box between two corners.
    fn cuboid(low: DVec3, high: DVec3) -> (Vec<DVec3>, Vec<Vec<u32>>) {
        let at = |k: u32| {
            let pick = |bit: u32, l: f64, h: f64| if k >> bit & 1 == 0 { l } else { h };
            DVec3::new(pick(0, low.x, high.x), pick(1, low.y, high.y), pick(2, low.z, high.z))
        };
        let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        ((0..8).map(at).collect(), faces.map(|f| f.to_vec()).to_vec())
    }

    #[test]
    fn a_box_is_a_rectangle_from_each_side_and_a_hexagon_from_its_corner() {
        let (points, faces) = cuboid(DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0));
        let mesh = Mesh::new(points, &faces).unwrap();
        for (view, area) in [(View::FRONT, 2.0), (View::SIDE, 6.0), (View::TOP, 3.0)] {
            let found = go(&mesh, view).unwrap();
            assert_eq!((found.curves.len(), found.outer, found.curves[0].points().len()), (1, 1, 4));
            assert!((found.area - area).abs() < 1e-12);
            assert!(found.curves[0].points().iter().all(|p| (p.dot(view.depth()) - 0.5).abs() < 1e-15));
        }
        let direction = DVec3::ONE.normalize();
        let found = go(&mesh, View::along(direction).unwrap()).unwrap();
        assert_eq!(found.curves[0].points().len(), 6);
        assert!((found.area - (2.0 + 6.0 + 3.0) / 3.0_f64.sqrt()).abs() < 1e-12);
    }

    /// A torus about the axis z with `major` and `minor` radii.
    fn torus(major: f64, minor: f64, around: u32, tube: u32) -> Mesh {
        let points = (0..around * tube).map(|k| {
            let (u, v) = (TAU * f64::from(k / tube) / f64::from(around), TAU * f64::from(k % tube) / f64::from(tube));
            let r = major + minor * v.cos();
            DVec3::new(r * u.cos(), r * u.sin(), minor * v.sin())
        });
        let faces: Vec<[u32; 4]> = (0..around * tube)
            .map(|k| {
                let (i, j) = (k / tube, k % tube);
                let at = |i: u32, j: u32| (i % around) * tube + j % tube;
                [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]
            })
            .collect();
        Mesh::new(points.collect(), &faces).unwrap()
    }

    #[test]
    fn a_ring_has_a_hole_and_its_area() {
        let found = go(&torus(2.0, 0.5, 256, 64), View::FRONT).unwrap();
        assert_eq!((found.curves.len(), found.outer), (2, 1));
        let polygon = 0.5 * 256.0 * (TAU / 256.0).sin();
        assert!((found.area - polygon * (2.5_f64.powi(2) - 1.5_f64.powi(2))).abs() < 1e-9, "{}", found.area);
        assert!(found.curves[0].area_vector().z > 0.0 && found.curves[1].area_vector().z < 0.0);
        // Edge on it has none; parts of it are hidden by others.
        let side = go(&torus(2.0, 0.5, 256, 64), View::SIDE).unwrap();
        assert_eq!(side.curves.len(), 1);
        assert!((side.area - (4.0 + PI * 0.25)).abs() < 2e-3, "{}", side.area);
    }

    #[test]
    fn parts_that_overlap_have_one_outline_and_open_ones_are_seen_from_both_sides() {
        let (mut points, mut faces) = cuboid(DVec3::ZERO, DVec3::ONE);
        let (more, others) = cuboid(DVec3::new(0.5, 0.5, 3.0), DVec3::new(1.5, 1.5, 4.0));
        faces.extend(others.iter().map(|face| face.iter().map(|v| v + 8).collect()));
        points.extend(more);
        let found = go(&Mesh::new(points.clone(), &faces).unwrap(), View::FRONT).unwrap();
        assert!((found.area - 1.75).abs() < 1e-12);
        assert_eq!((found.curves.len(), found.curves[0].points().len()), (1, 8));
        // Without the face in front, and with another one turned round.
        faces.remove(5);
        faces[0].reverse();
        let open = go(&Mesh::new(points, &faces).unwrap(), View::FRONT).unwrap();
        assert!((open.area - 1.75).abs() < 1e-12);
    }

    #[test]
    fn turning_the_mesh_and_the_view_together_changes_nothing() {
        let mesh = torus(1.0, 0.4, 40, 20);
        let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.7, -1.1, 0.4);
        let turned = super::super::transform(&mesh, &glam::DAffine3::from_quat(turn)).unwrap();
        let direction = DVec3::new(0.3, 0.8, 0.6);
        let one = go(&mesh, View::along(direction).unwrap()).unwrap();
        let other = go(&turned, View::along(turn * direction).unwrap()).unwrap();
        assert!((one.area - other.area).abs() < 1e-12, "{} {}", one.area, other.area);
    }

    #[test]
    fn what_cannot_be_seen_is_refused() {
        let flat = Mesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], [[0, 1, 2]]).unwrap();
        assert!((go(&flat, View::FRONT).unwrap().area - 0.5).abs() < 1e-15);
        assert_eq!(go(&flat, View::SIDE), Err(MeshSilhouetteError::Nothing { view: "side" }));
        let far = Mesh::new(vec![DVec3::ZERO, DVec3::X * 1e200, DVec3::Y], [[0, 1, 2]]).unwrap();
        assert_eq!(go(&far, View::FRONT), Err(MeshSilhouetteError::TooLarge));
        let stopped = silhouette_of(&flat, View::FRONT, 0.0, &|_| false);
        assert_eq!(stopped, Err(MeshSilhouetteError::Cancelled));
        assert!(matches!(
            silhouette_of(&flat, View::FRONT, f64::NAN, &|_| true),
            Err(MeshSilhouetteError::Depth { .. })
        ));
    }
}
