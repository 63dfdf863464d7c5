//! The point of a mesh nearest to a given one.

use glam::DVec3;

use super::Mesh;
use super::triangle_tree::{Content, Node, TriangleTree};

/// A mesh has no polygons to measure a distance to or to hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the mesh has no polygons, and so no distance to it")]
pub struct NoPolygons;

/// The point of a mesh nearest to a given one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The point on the surface, metres.
    pub point: DVec3,
    /// Its distance, metres.
    pub distance: f64,
    /// The polygon it lies on.
    pub polygon: usize,
}

/// The triangles of a mesh in a hierarchy of boxes: made once, asked often.
///
/// A question takes about O(log n). The published crates for this either bring their own algebra (`parry3d-f64`, `bvh`)
/// or work in `f32`.
#[derive(Clone, Debug)]
pub struct MeshDistance {
    tree: TriangleTree,
}

impl MeshDistance {
    /// Sorts the [`triangles`](super::triangles) of a mesh, its quads split along the shorter diagonal.
    ///
    /// # Errors
    /// [`NoPolygons`] where the mesh is empty.
    pub fn new(mesh: &Mesh) -> Result<Self, NoPolygons> {
        Ok(Self { tree: TriangleTree::new(mesh).ok_or(NoPolygons)? })
    }

    /// The same for some of its polygons.
    ///
    /// # Errors
    /// [`NoPolygons`] where none is `wanted`.
    pub(crate) fn among(mesh: &Mesh, wanted: impl Fn(usize) -> bool) -> Result<Self, NoPolygons> {
        Ok(Self { tree: TriangleTree::among(mesh, &|triangle| wanted(triangle.polygon)).ok_or(NoPolygons)? })
    }

    /// The nearest point of the mesh. Where several are equally near it is always the same one.
    ///
    /// For a point that is not finite, neither is the distance.
    pub fn nearest(&self, point: DVec3) -> Nearest {
        let first = &self.tree.triangles[0];
        let mut best = (first.points[0], first.points[0].distance_squared(point), first.polygon);
        let mut open = vec![(0, box_distance_squared(&self.tree.nodes[0], point))];
        while let Some((node, distance)) = open.pop() {
            if distance > best.1 {
                continue;
            }
            match self.tree.nodes[node].content {
                Content::Leaf { from, to } => {
                    for triangle in &self.tree.triangles[from..to] {
                        let on = nearest_on_triangle(point, triangle.points);
                        let distance = on.distance_squared(point);
                        if distance < best.1 {
                            best = (on, distance, triangle.polygon);
                        }
                    }
                }
                Content::Inner { right } => {
                    let left = (node + 1, box_distance_squared(&self.tree.nodes[node + 1], point));
                    let right = (right, box_distance_squared(&self.tree.nodes[right], point));
                    open.extend(if left.1 <= right.1 { [right, left] } else { [left, right] });
                }
            }
        }
        Nearest { point: best.0, distance: best.1.sqrt(), polygon: best.2 }
    }
}

fn box_distance_squared(node: &Node, point: DVec3) -> f64 {
    point.clamp(node.low, node.high).distance_squared(point)
}

/// The point of a triangle nearest to `p`, by the regions of its corners, sides and inside (Ericson, Real-Time
/// Collision Detection, 5.1.5). Holds for triangles without area too.
pub fn nearest_on_triangle(p: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let scale = 1.0 / (va + vb + vc);
    a + ab * (vb * scale) + ac * (vc * scale)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::measure::corner_points;
    use crate::mesh::triangulate::triangles;

    fn bumpy(width: u32) -> Mesh {
        let height = |x: u32, z: u32| (f64::from(x) * 0.7).sin() * (f64::from(z) * 0.4).cos();
        let points =
            (0..width).flat_map(|z| (0..width).map(move |x| DVec3::new(x.into(), height(x, z), z.into()))).collect();
        let at = |x: u32, z: u32| z * width + x;
        let quads = (0..width - 1)
            .flat_map(|z| (0..width - 1).map(move |x| [at(x, z), at(x, z + 1), at(x + 1, z + 1), at(x + 1, z)]));
        Mesh::new(points, quads).unwrap()
    }

    /// Points on a low-discrepancy sequence around a mesh of this width.
    fn probes(width: f64) -> impl Iterator<Item = DVec3> {
        (1..300).map(move |i| {
            let along = |a: f64| (f64::from(i) * a).fract() * (width + 4.0) - 2.0;
            DVec3::new(along(0.8191725), along(0.6710436), along(0.5497004))
        })
    }

    #[test]
    fn agrees_with_asking_every_triangle() {
        let mesh = bumpy(14);
        let hierarchy = MeshDistance::new(&mesh).unwrap();
        for probe in probes(13.0) {
            let found = hierarchy.nearest(probe);
            let expected = triangles(&mesh)
                .map(|t| nearest_on_triangle(probe, corner_points(&mesh, t)).distance(probe))
                .fold(f64::INFINITY, f64::min);
            assert!((found.distance - expected).abs() < 1e-12, "{probe}: {} for {expected}", found.distance);
            assert!((found.point.distance(probe) - expected).abs() < 1e-12);
            let of_polygon = super::super::triangulate::polygon_triangles(&mesh, found.polygon)
                .iter()
                .map(|t| nearest_on_triangle(probe, corner_points(&mesh, *t)).distance(probe))
                .fold(f64::INFINITY, f64::min);
            assert!((of_polygon - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn the_nearest_point_of_a_triangle_beats_all_samples() {
        let corners = [DVec3::new(0.0, 0.0, 0.0), DVec3::new(3.0, 0.5, 0.0), DVec3::new(0.5, 2.0, 1.0)];
        for probe in probes(2.0) {
            let nearest = nearest_on_triangle(probe, corners).distance(probe);
            let mut sampled = f64::INFINITY;
            for i in 0..=60 {
                for j in 0..=60 - i {
                    let (u, v) = (f64::from(i) / 60.0, f64::from(j) / 60.0);
                    let on = corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]);
                    sampled = sampled.min(on.distance(probe));
                }
            }
            assert!(nearest <= sampled + 1e-12 && nearest > sampled - 0.05, "{probe}: {nearest}, {sampled}");
        }
    }

    #[test]
    fn triangles_without_area_have_distances_too() {
        let line = [DVec3::ZERO, DVec3::X, 2.0 * DVec3::X];
        assert!((nearest_on_triangle(DVec3::new(1.5, 1.0, 0.0), line) - DVec3::new(1.5, 0.0, 0.0)).length() < 1e-15);
        assert_eq!(nearest_on_triangle(DVec3::Y, [DVec3::X; 3]), DVec3::X);
    }

    #[test]
    fn a_point_on_the_mesh_has_no_distance() {
        let mesh = bumpy(6);
        let hierarchy = MeshDistance::new(&mesh).unwrap();
        for vertex in mesh.positions() {
            assert_eq!(hierarchy.nearest(*vertex).distance, 0.0);
        }
    }

    #[test]
    fn odd_questions_have_answers() {
        assert_eq!(MeshDistance::new(&Mesh::default()).unwrap_err(), NoPolygons);
        let hierarchy = MeshDistance::new(&bumpy(6)).unwrap();
        assert!(!hierarchy.nearest(DVec3::NAN).distance.is_finite());
        assert!(!hierarchy.nearest(DVec3::INFINITY).distance.is_finite());
        let same = Mesh::new(vec![DVec3::ONE; 3], vec![[0, 1, 2]; 20]).unwrap();
        assert_eq!(MeshDistance::new(&same).unwrap().nearest(DVec3::ZERO).distance, 3.0_f64.sqrt());
    }
}
