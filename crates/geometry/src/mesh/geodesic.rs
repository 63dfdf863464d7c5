//! Distances along a surface.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;

use super::distance::{MeshDistance, NoPolygons};
use super::{Mesh, triangles};

/// Vertices between two questions whether to go on.
const STEP: usize = 4096;

/// The triangles of a mesh, prepared to measure along them: made once, asked often.
#[derive(Clone, Debug)]
pub struct Geodesics {
    points: Vec<DVec3>,
    /// First triangle of each vertex, and behind the last one the number of all.
    starts: Vec<usize>,
    /// The two other corners of each triangle at a vertex.
    others: Vec<[u32; 2]>,
}

impl Geodesics {
    /// Takes the [`triangles`] of a mesh.
    pub fn new(mesh: &Mesh) -> Self {
        let points = mesh.positions().to_vec();
        let all: Vec<[u32; 3]> = triangles(mesh).map(|t| t.map(|corner| mesh.corners()[corner])).collect();
        let mut starts = vec![0_usize; points.len() + 1];
        all.iter().flatten().for_each(|v| starts[*v as usize + 1] += 1);
        for vertex in 0..points.len() {
            starts[vertex + 1] += starts[vertex];
        }
        let mut next = starts.clone();
        let mut others = vec![[0; 2]; 3 * all.len()];
        for [a, b, c] in all {
            for (own, two) in [(a, [b, c]), (b, [c, a]), (c, [a, b])] {
                others[next[own as usize]] = two;
                next[own as usize] += 1;
            }
        }
        Self { points, starts, others }
    }

    /// Distance of each vertex from the nearest of some vertices, metres, each started with a distance of its own;
    /// infinite beyond `most` metres and where no path leads. Starts at vertices that are not there, or that are
    /// negative or not a number, are left out.
    ///
    /// Distances spread from vertex to vertex, the shortest first; through a triangle they go straight on from where,
    /// unfolded, they came from (Novotni and Klein, Computing Geodesic Distances on Triangular Meshes, 2002). On flat
    /// parts without obtuse triangles they are exact to rounding; otherwise too long by a few per cent at most meshes,
    /// never more than the shortest way along edges. O(n log n).
    pub fn distances(&self, from: &[(u32, f64)], most: f64) -> Vec<f64> {
        self.distances_while(from, most, &|_| true).unwrap_or_default()
    }

    /// The same, calling `progress` with about the fraction done; `None` where it answers `false`.
    pub fn distances_while(&self, from: &[(u32, f64)], most: f64, progress: &dyn Fn(f64) -> bool) -> Option<Vec<f64>> {
        let mut taken = 0_usize;
        let mut distances = vec![f64::INFINITY; self.points.len()];
        let mut open = BinaryHeap::new();
        for &(vertex, start) in from {
            if (vertex as usize) < distances.len() && start >= 0.0 && start < distances[vertex as usize] {
                distances[vertex as usize] = start;
                open.push(Reverse((Ordered(start), vertex)));
            }
        }
        while let Some(Reverse((Ordered(distance), vertex))) = open.pop() {
            if distance > distances[vertex as usize] || distance > most {
                continue;
            }
            if taken.is_multiple_of(STEP) && !progress((taken as f64 / self.points.len() as f64).min(1.0)) {
                return None;
            }
            taken += 1;
            let star = &self.others[self.starts[vertex as usize]..self.starts[vertex as usize + 1]];
            for [left, right] in star {
                for (to, over) in [(*left, *right), (*right, *left)] {
                    let found = self.through(vertex, over, to, &distances);
                    let known = &mut distances[to as usize];
                    // Shorter by more than rounding, so that this comes to an end.
                    if found < *known * (1.0 - 1e-12) {
                        *known = found;
                        open.push(Reverse((Ordered(found), to)));
                    }
                }
            }
        }
        distances.iter_mut().filter(|d| **d > most).for_each(|d| *d = f64::INFINITY);
        Some(distances)
    }

    /// Distance of `to` by way of the edge from `a` to `b`, or along the edge from `a`.
    fn through(&self, a: u32, b: u32, to: u32, distances: &[f64]) -> f64 {
        let (from_a, from_b) = (distances[a as usize], distances[b as usize]);
        let [p, q, r] = [a, b, to].map(|v| self.points[v as usize]);
        let along = from_a + p.distance(r);
        let edge = p.distance(q);
        if !from_b.is_finite() || edge == 0.0 {
            return along;
        }
        // Unfolded, with a at the origin and b on the first axis: the source below, `to` above.
        let x = (from_a * from_a - from_b * from_b + edge * edge) / (2.0 * edge);
        let below = from_a * from_a - x * x;
        if below < 0.0 {
            return along;
        }
        let direction = (q - p) / edge;
        let to_x = (r - p).dot(direction);
        let to_y = ((r - p) - to_x * direction).length();
        let depth = below.sqrt();
        if depth + to_y == 0.0 {
            return along;
        }
        let crossing = x + (to_x - x) * depth / (depth + to_y);
        if (0.0..=edge).contains(&crossing) { (to_x - x).hypot(to_y + depth).min(along) } else { along }
    }
}

/// Starts for [`Geodesics::distances`] at points: the corners of the polygon nearest to each.
///
/// # Errors
/// [`NoPolygons`] where the mesh is empty.
pub fn starts_at(mesh: &Mesh, points: &[DVec3]) -> Result<Vec<(u32, f64)>, NoPolygons> {
    let nearest = MeshDistance::new(mesh)?;
    let corners = |point: &DVec3| {
        let on = nearest.nearest(*point);
        let start = move |v: &u32| (*v, on.point.distance(mesh.positions()[*v as usize]));
        mesh.polygon(on.polygon).iter().map(start)
    };
    Ok(points.iter().filter(|p| p.is_finite()).flat_map(corners).collect())
}

/// A distance, in order; never not a number.
#[derive(Clone, Copy, PartialEq)]
struct Ordered(f64);

impl Eq for Ordered {}

impl PartialOrd for Ordered {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Ordered {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// A net of unit quads, wide along x and z.
    fn net(size: u32) -> Mesh {
        let at = |x: u32, z: u32| z * size + x;
        let points = (0..size).flat_map(|z| (0..size).map(move |x| DVec3::new(x.into(), 0.0, z.into()))).collect();
        let quads = (0..size - 1)
            .flat_map(|z| (0..size - 1).map(move |x| [at(x, z), at(x, z + 1), at(x + 1, z + 1), at(x + 1, z)]));
        Mesh::new(points, quads).unwrap()
    }

    #[test]
    fn on_a_plane_they_are_straight() {
        let mesh = net(20);
        let found = Geodesics::new(&mesh).distances(&[(0, 0.0)], f64::INFINITY);
        for (point, distance) in mesh.positions().iter().zip(&found) {
            assert!((distance - point.length()).abs() < 1e-9, "{point}: {distance}");
        }
    }

    #[test]
    fn on_a_sphere_they_are_arcs() {
        let (around, high) = (48, 24);
        let mut points = vec![DVec3::Y, DVec3::NEG_Y];
        for i in 1..high {
            for j in 0..around {
                let (s, c) = (PI * f64::from(i) / f64::from(high)).sin_cos();
                let (sin, cos) = (2.0 * PI * f64::from(j) / f64::from(around)).sin_cos();
                points.push(DVec3::new(s * cos, c, s * sin));
            }
        }
        let at = |i: u32, j: u32| 2 + (i - 1) * around + j % around;
        let mut polygons: Vec<Vec<u32>> = (1..high - 1)
            .flat_map(|i| (0..around).map(move |j| vec![at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)]))
            .collect();
        polygons.extend((0..around).map(|j| vec![0, at(1, j + 1), at(1, j)]));
        polygons.extend((0..around).map(|j| vec![1, at(high - 1, j), at(high - 1, j + 1)]));
        let mesh = Mesh::new(points, polygons).unwrap();
        let from = DVec3::new(0.6, 0.8, 0.0);
        let starts = starts_at(&mesh, &[from]).unwrap();
        let found = Geodesics::new(&mesh).distances(&starts, f64::INFINITY);
        for (point, distance) in mesh.positions().iter().zip(&found) {
            let arc = point.dot(from).clamp(-1.0, 1.0).acos();
            assert!((distance - arc).abs() < 0.02 + 0.02 * arc, "{point}: {distance} for {arc}");
        }
    }

    #[test]
    fn they_end_at_the_limit_and_at_the_border() {
        let mut points = net(5).positions().to_vec();
        points.push(DVec3::ZERO);
        let mesh = Mesh::new(points, net(5).polygons()).unwrap();
        let found = Geodesics::new(&mesh).distances(&[(0, 0.5), (99, 0.0), (3, f64::NAN)], 2.6);
        assert_eq!((found[0], found[1], found[2]), (0.5, 1.5, 2.5));
        assert!(found[3].is_infinite() && found[25].is_infinite());
        assert!(Geodesics::new(&mesh).distances(&[], 1.0).iter().all(|d| d.is_infinite()));
    }

    #[test]
    fn around_a_corner_they_follow_the_border() {
        // An L: the way from one arm to the other leads by the inner corner.
        let full = net(9);
        let kept: Vec<&[u32]> = full
            .polygons()
            .filter(|q| !q.iter().all(|v| full.positions()[*v as usize].cmpge(DVec3::new(4.0, -1.0, 4.0)).all()))
            .collect();
        let mesh = Mesh::new(full.positions().to_vec(), kept).unwrap();
        let found = Geodesics::new(&mesh).distances(&[(8, 0.0)], f64::INFINITY);
        let wanted = 4.0_f64.hypot(4.0) + 4.0_f64.hypot(4.0);
        // Behind the corner no triangle unfolds to where the way came from.
        assert!((wanted..1.02 * wanted).contains(&found[8 * 9]), "{}", found[8 * 9]);
        assert!((found[4 * 9 + 4] - 0.5 * wanted).abs() < 1e-9);
    }
}
