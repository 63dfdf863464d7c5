//! Where rays hit a mesh.

use glam::DVec3;

use super::Mesh;
use super::distance::NoPolygons;
use super::triangle_tree::{Content, Node, TriangleTree};

/// Where a ray hits a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// The point on the surface, metres.
    pub point: DVec3,
    /// Its place along the ray in lengths of the direction: metres where that is a unit vector.
    pub along: f64,
    /// The polygon hit.
    pub polygon: usize,
}

/// The triangles of a mesh in a hierarchy of boxes, to cast rays at: made once in O(n log n), asked often.
///
/// Triangles are tested as by Woop, Benthin and Wald (Watertight Ray/Triangle Intersection, JCGT 2013): a ray does not
/// slip through between two triangles with a common side. Both sides of a triangle are hit; one seen
/// edge-on may be hit in any of its points on the ray, or not at all.
#[derive(Clone, Debug)]
pub struct MeshRays {
    tree: TriangleTree,
}

/// Which of all hits is wanted.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Wanted {
    First,
    Last,
}

impl MeshRays {
    /// Sorts the [`triangles`](super::triangles) of a mesh, its quads split along the shorter diagonal.
    ///
    /// # Errors
    /// [`NoPolygons`] where the mesh is empty.
    pub fn new(mesh: &Mesh) -> Result<Self, NoPolygons> {
        Ok(Self { tree: TriangleTree::new(mesh).ok_or(NoPolygons)? })
    }

    /// The same for those of its triangles that are `wanted`, such as those that lie on the way of all rays; `None` where
    /// there are none.
    pub(crate) fn among(mesh: &Mesh, wanted: impl Fn([DVec3; 3]) -> bool) -> Option<Self> {
        TriangleTree::among(mesh, &|triangle| wanted(triangle.points)).map(|tree| Self { tree })
    }

    /// The hit nearest to the `origin` of a ray, or `None` where the ray misses, its direction is zero or a number is
    /// not finite. A hit at the origin itself counts.
    pub fn first(&self, origin: DVec3, direction: DVec3) -> Option<RayHit> {
        self.hit(origin, direction, Wanted::First)
    }

    /// The hit farthest from the `origin` of a ray; otherwise as [`MeshRays::first`].
    pub fn last(&self, origin: DVec3, direction: DVec3) -> Option<RayHit> {
        self.hit(origin, direction, Wanted::Last)
    }

    /// Whether a ray hits anything on its way up to `limit` (in lengths of the direction, that included): the first hit is no
    /// farther, which need not be found.
    pub(crate) fn any_within(&self, origin: DVec3, direction: DVec3, limit: f64) -> bool {
        if !origin.is_finite() || !direction.is_finite() || direction == DVec3::ZERO {
            return false;
        }
        let ray = Ray::new(origin, direction);
        let mut open = vec![0];
        while let Some(node) = open.pop() {
            let Some((enters, _)) = ray.passes(&self.tree.nodes[node]) else { continue };
            if enters > limit {
                continue;
            }
            match self.tree.nodes[node].content {
                Content::Leaf { from, to } => {
                    let within = |along: f64| along <= limit;
                    if self.tree.triangles[from..to].iter().any(|t| ray.meets(t.points).is_some_and(within)) {
                        return true;
                    }
                }
                Content::Inner { right } => open.extend([right, node + 1]),
            }
        }
        false
    }

    fn hit(&self, origin: DVec3, direction: DVec3, wanted: Wanted) -> Option<RayHit> {
        if !origin.is_finite() || !direction.is_finite() || direction == DVec3::ZERO {
            return None;
        }
        let ray = Ray::new(origin, direction);
        let mut best: Option<RayHit> = None;
        let mut open = vec![0];
        while let Some(node) = open.pop() {
            let Some((enters, leaves)) = ray.passes(&self.tree.nodes[node]) else { continue };
            let hopeless = best.is_some_and(|best| match wanted {
                Wanted::First => enters > best.along,
                Wanted::Last => leaves < best.along,
            });
            if hopeless {
                continue;
            }
            match self.tree.nodes[node].content {
                Content::Leaf { from, to } => {
                    for triangle in &self.tree.triangles[from..to] {
                        let Some(along) = ray.meets(triangle.points) else { continue };
                        let better = best.is_none_or(|best| match wanted {
                            Wanted::First => along < best.along,
                            Wanted::Last => along > best.along,
                        });
                        if better {
                            best = Some(RayHit { point: origin + direction * along, along, polygon: triangle.polygon });
                        }
                    }
                }
                Content::Inner { right } => open.extend([right, node + 1]),
            }
        }
        best
    }
}

struct Ray {
    origin: DVec3,
    inverse: DVec3,
    /// Axis along which the ray runs fastest, last; the others in an order that keeps the turning.
    axes: [usize; 3],
    /// Shears and scale that turn the ray into the unit vector along its last axis.
    shear: [f64; 3],
}

impl Ray {
    fn new(origin: DVec3, direction: DVec3) -> Self {
        let z = direction.abs().max_position();
        let (mut x, mut y) = ((z + 1) % 3, (z + 2) % 3);
        if direction[z] < 0.0 {
            std::mem::swap(&mut x, &mut y);
        }
        let shear = [direction[x] / direction[z], direction[y] / direction[z], 1.0 / direction[z]];
        Self { origin, inverse: direction.recip(), axes: [x, y, z], shear }
    }

    /// Where the ray enters and leaves a box, or `None` where it passes by. Never misses a box by rounding.
    fn passes(&self, node: &Node) -> Option<(f64, f64)> {
        let (low, high) = ((node.low - self.origin) * self.inverse, (node.high - self.origin) * self.inverse);
        let (mut enters, mut leaves) = (0.0_f64, f64::INFINITY);
        for axis in 0..3 {
            // NaN comes of a ray within the plane of a side, which says nothing: `min` and `max` leave it out.
            let (near, far) = if self.inverse[axis] < 0.0 { (high[axis], low[axis]) } else { (low[axis], high[axis]) };
            enters = enters.max(near);
            leaves = leaves.min(far * (1.0 + 8.0 * f64::EPSILON));
        }
        (enters <= leaves).then_some((enters, leaves))
    }

    /// How far along the ray a triangle is hit.
    fn meets(&self, corners: [DVec3; 3]) -> Option<f64> {
        let [kx, ky, kz] = self.axes;
        let [sx, sy, sz] = self.shear;
        let [a, b, c] = corners.map(|corner| {
            let p = corner - self.origin;
            DVec3::new(p[kx] - sx * p[kz], p[ky] - sy * p[kz], sz * p[kz])
        });
        let sides = DVec3::new(c.x * b.y - c.y * b.x, a.x * c.y - a.y * c.x, b.x * a.y - b.y * a.x);
        let outside = sides.min_element() < 0.0 && sides.max_element() > 0.0;
        let whole = sides.element_sum();
        // Seen edge-on, a triangle has no sides but rounding, which may say that it is hit wherever it lies.
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let beside = low.x > 0.0 || low.y > 0.0 || high.x < 0.0 || high.y < 0.0;
        let along = sides.dot(DVec3::new(a.z, b.z, c.z)) / whole;
        (!outside && !beside && along.is_finite() && along >= 0.0).then_some(along)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::measure::corner_points;
    use crate::mesh::triangles;

    fn ball(sides: u32) -> Mesh {
        let turn = std::f64::consts::TAU / f64::from(sides);
        let rows = sides / 2;
        let at = |row: u32, k: u32| {
            let (v, u) = (turn * f64::from(row), turn * f64::from(k));
            // The sine of pi is not quite 0, and would leave a hole at the pole.
            let radius = if row == rows { 0.0 } else { v.sin() };
            DVec3::new(radius * u.cos(), radius * u.sin(), -v.cos())
        };
        let points = (0..=rows).flat_map(|row| (0..sides).map(move |k| at(row, k))).collect();
        let index = |row: u32, k: u32| row * sides + k % sides;
        let quads = (0..rows).flat_map(|r| {
            (0..sides).map(move |k| [index(r, k), index(r, k + 1), index(r + 1, k + 1), index(r + 1, k)])
        });
        Mesh::new(points, quads).unwrap()
    }

    /// Directions of a low-discrepancy sequence, and those through vertices and along axes, where triangles meet.
    fn directions(mesh: &Mesh) -> Vec<DVec3> {
        let spread = (1..200).map(|i| {
            let along = |a: f64| (f64::from(i) * a).fract() - 0.5;
            DVec3::new(along(0.8191725), along(0.6710436), along(0.5497004))
        });
        spread.chain(mesh.positions().iter().copied()).chain(DVec3::AXES).collect()
    }

    #[test]
    fn agrees_with_asking_every_triangle() {
        let mesh = ball(16);
        let rays = MeshRays::new(&mesh).unwrap();
        for origin in [DVec3::ZERO, DVec3::new(0.3, -0.2, 0.1), DVec3::new(-2.0, 0.1, 0.2)] {
            for direction in directions(&mesh) {
                let ray = Ray::new(origin, direction);
                let all: Vec<f64> = triangles(&mesh).filter_map(|t| ray.meets(corner_points(&mesh, t))).collect();
                let first = all.iter().copied().reduce(f64::min);
                let last = all.iter().copied().reduce(f64::max);
                assert_eq!(rays.first(origin, direction).map(|hit| hit.along), first, "{origin} {direction}");
                assert_eq!(rays.last(origin, direction).map(|hit| hit.along), last, "{origin} {direction}");
            }
        }
    }

    #[test]
    fn no_ray_from_inside_slips_out() {
        let mesh = ball(20);
        let rays = MeshRays::new(&mesh).unwrap();
        for origin in [DVec3::ZERO, DVec3::new(0.3, -0.2, 0.1)] {
            for target in directions(&mesh) {
                let hit = rays.first(origin, target - origin).unwrap();
                assert!((0.97..1.0 + 1e-12).contains(&hit.point.length()), "{target}: {hit:?}");
                let last = rays.last(origin, target - origin).unwrap();
                assert!(last.point.distance(hit.point) < 1e-12, "a ball is convex: {hit:?}, {last:?}");
            }
        }
    }

    #[test]
    fn a_ray_through_from_outside_hits_twice() {
        let rays = MeshRays::new(&ball(32)).unwrap();
        let (origin, direction) = (DVec3::new(-3.0, 0.01, 0.02), DVec3::X * 2.0);
        let (first, last) = (rays.first(origin, direction).unwrap(), rays.last(origin, direction).unwrap());
        assert!((first.point.x + 1.0).abs() < 0.02 && (last.point.x - 1.0).abs() < 0.02);
        assert!((first.along - 1.0).abs() < 0.01 && (last.along - 2.0).abs() < 0.01);
        assert_eq!(rays.first(origin, -direction), None);
        assert_eq!(rays.first(origin + DVec3::Y * 1.1, direction), None);
        // Something is met up to the first hit, and nothing before it.
        for (limit, met) in
            [(first.along, true), (last.along, true), (first.along * (1.0 - 1e-12), false), (0.0, false)]
        {
            assert_eq!(rays.any_within(origin, direction, limit), met, "{limit}");
        }
        assert!(!rays.any_within(origin, -direction, 9.0) && !rays.any_within(DVec3::NAN, direction, 9.0));
    }

    #[test]
    fn odd_rays_hit_nothing() {
        assert_eq!(MeshRays::new(&Mesh::default()).err(), Some(NoPolygons));
        let rays = MeshRays::new(&ball(8)).unwrap();
        for (origin, direction) in
            [(DVec3::NAN, DVec3::X), (DVec3::ZERO, DVec3::ZERO), (DVec3::ZERO, DVec3::new(f64::INFINITY, 0.0, 0.0))]
        {
            assert_eq!(rays.first(origin, direction), None);
        }
        let flat = Mesh::new(vec![DVec3::X, DVec3::X + DVec3::Y, DVec3::X * 2.0], [[0, 1, 2]]).unwrap();
        assert_eq!(MeshRays::new(&flat).unwrap().first(DVec3::ZERO, DVec3::X), None, "edge-on");
    }
}
