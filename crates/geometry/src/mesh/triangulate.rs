//! A mesh as triangles, for file writers, renderers and measures.

use glam::DVec3;

use super::Mesh;
use super::ear_clipping::ear_clip;
use super::measure::{project, vector_area};

/// The triangles of a mesh, polygon after polygon, as corner indices (places in [`Mesh::corners`], [`Mesh::normals`]
/// and [`Mesh::uvs`]), each in the polygon's order of turning.
///
/// A polygon of `k` corners gives `k - 2` triangles. Quads are split along the shorter diagonal, or along the other one
/// where only that lies inside; larger polygons are a fan about their first corner where they are convex, and otherwise
/// cut by ear clipping in the plane of their normal.
pub fn triangles(mesh: &Mesh) -> impl Iterator<Item = [usize; 3]> + '_ {
    Triangles { mesh, polygon: 0, pending: Vec::new() }
}

/// The triangles of one polygon; see [`triangles`]. `polygon` must be less than [`Mesh::polygon_count`].
pub fn polygon_triangles(mesh: &Mesh, polygon: usize) -> Vec<[usize; 3]> {
    let mut pending = Vec::new();
    split(mesh, polygon, &mut pending);
    pending.reverse();
    pending
}

struct Triangles<'a> {
    mesh: &'a Mesh,
    polygon: usize,
    /// Triangles of the last polygon that are still to be given out, last one first.
    pending: Vec<[usize; 3]>,
}

impl Iterator for Triangles<'_> {
    type Item = [usize; 3];

    fn next(&mut self) -> Option<[usize; 3]> {
        if self.pending.is_empty() && self.polygon < self.mesh.polygon_count() {
            split(self.mesh, self.polygon, &mut self.pending);
            self.polygon += 1;
        }
        self.pending.pop()
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let corners = self.mesh.corners().len();
        let given = if self.polygon == self.mesh.polygon_count() {
            corners
        } else {
            self.mesh.corner_range(self.polygon).start
        };
        let left = (corners - given) - 2 * (self.mesh.polygon_count() - self.polygon) + self.pending.len();
        (left, Some(left))
    }
}

/// Puts the triangles of a polygon behind `pending`, last one first.
fn split(mesh: &Mesh, polygon: usize, pending: &mut Vec<[usize; 3]>) {
    let corners = mesh.corner_range(polygon);
    let first = corners.start;
    let point = |k: usize| mesh.positions()[mesh.corners()[first + k] as usize];
    match corners.len() {
        3 => pending.push([first, first + 1, first + 2]),
        4 => {
            let triangles = if splits_from_first([point(0), point(1), point(2), point(3)]) {
                [[first, first + 2, first + 3], [first, first + 1, first + 2]]
            } else {
                [[first + 1, first + 3, first], [first + 1, first + 2, first + 3]]
            };
            pending.extend(triangles);
        }
        count => {
            let normal = vector_area((0..count).map(point)).normalize_or_zero();
            if normal == DVec3::ZERO || is_strictly_convex(count, point, normal) {
                pending.extend((1..count - 1).rev().map(|k| [first, first + k, first + k + 1]));
            } else {
                let flat = project((0..count).map(point), normal);
                pending.extend(ear_clip(&flat).iter().rev().map(|triangle| triangle.map(|k| first + k)));
            }
        }
    }
}

/// Whether a quad is split along the diagonal from its first corner rather than from its second.
fn splits_from_first([a, b, c, d]: [DVec3; 4]) -> bool {
    let agree = |p: DVec3, q: DVec3| p.dot(q) >= 0.0;
    let inside_first = agree((b - a).cross(c - a), (c - a).cross(d - a));
    let inside_second = agree((c - b).cross(d - b), (d - b).cross(a - b));
    if inside_first == inside_second { a.distance_squared(c) <= b.distance_squared(d) } else { inside_first }
}

fn is_strictly_convex(count: usize, point: impl Fn(usize) -> DVec3, normal: DVec3) -> bool {
    let edge = |k: usize| point((k + 1) % count) - point(k % count);
    // All turns to one side, and once around: a pentagram turns to one side too, but twice around.
    let mut around = 0.0;
    for k in 0..count {
        let (before, after) = (edge(k), edge(k + 1));
        let turn = before.cross(after).dot(normal);
        if turn.is_nan() || turn <= 1e-12 * before.length() * after.length() {
            return false;
        }
        around += turn.atan2(before.dot(after));
    }
    around < 1.5 * std::f64::consts::TAU
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(points: &[[f64; 3]], polygons: &[&[u32]]) -> Mesh {
        Mesh::new(points.iter().map(|p| DVec3::from(*p)).collect(), polygons).unwrap()
    }

    fn areas(mesh: &Mesh) -> Vec<DVec3> {
        triangles(mesh).map(|t| vector_area(t.map(|c| mesh.positions()[mesh.corners()[c] as usize]))).collect()
    }

    #[test]
    fn quads_are_split_along_the_shorter_diagonal() {
        let wide = mesh(&[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 1.0, 0.0], [1.0, 1.0, 0.0]], &[&[0, 1, 2, 3]]);
        assert_eq!(triangles(&wide).collect::<Vec<_>>(), [[1, 2, 3], [1, 3, 0]]);
        let turned = mesh(&[[2.0, 0.0, 0.0], [3.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 0.0]], &[&[0, 1, 2, 3]]);
        assert_eq!(triangles(&turned).collect::<Vec<_>>(), [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn a_dart_is_split_at_its_notch() {
        // The diagonal 0-2 is the shorter one, and lies outside.
        let dart = mesh(&[[-1.0, 0.0, 0.0], [0.0, 0.4, 0.0], [1.0, 0.0, 0.0], [0.0, 3.0, 0.0]], &[&[0, 1, 2, 3]]);
        assert_eq!(triangles(&dart).collect::<Vec<_>>(), [[1, 2, 3], [1, 3, 0]]);
        assert!(areas(&dart).iter().all(|a| a.z > 0.0));
    }

    #[test]
    fn convex_polygons_are_fans_and_others_are_clipped() {
        let pentagon: Vec<[f64; 3]> =
            (0..5).map(|i| (i as f64 * 1.2566).sin_cos()).map(|(s, c)| [c, 2.0, -s]).collect();
        let fan = mesh(&pentagon, &[&[0, 1, 2, 3, 4]]);
        assert_eq!(triangles(&fan).collect::<Vec<_>>(), [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
        assert!(areas(&fan).iter().all(|a| a.y > 0.0));

        let notched = mesh(
            &[[0.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 4.0, 3.0], [0.0, 2.0, 0.5], [0.0, 0.0, 3.0]],
            &[&[0, 1, 2, 3, 4]],
        );
        let areas = areas(&notched);
        assert!(areas.iter().all(|a| a.x > 0.0));
        assert!((areas.iter().sum::<DVec3>().x - 7.0).abs() < 1e-12);
    }

    #[test]
    fn corners_count_over_all_polygons() {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [2.0, 0.5, 0.0]];
        let mesh = mesh(&points, &[&[0, 1, 2, 3], &[1, 4, 2], &[0, 1, 4, 2, 3]]);
        let mut all = triangles(&mesh);
        assert_eq!(all.size_hint(), (6, Some(6)));
        assert_eq!(all.next(), Some([0, 1, 2]));
        assert_eq!(all.size_hint(), (5, Some(5)));
        assert_eq!(all.by_ref().count(), 5);
        assert_eq!(all.size_hint(), (0, Some(0)));
        assert_eq!(polygon_triangles(&mesh, 1), [[4, 5, 6]]);
        assert!(triangles(&Mesh::default()).next().is_none());
    }
}
