//! Whether a mesh is a 2-manifold, and where it is not.

use super::Mesh;

/// What keeps polygons from being a 2-manifold, with or without boundary.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ManifoldReport {
    /// Edges of more than two polygons, lower vertex first, ascending.
    pub edges: Vec<[u32; 2]>,
    /// Vertices at which several fans of polygons meet only in this point, ascending. The ends of the edges above are
    /// not listed again.
    pub vertices: Vec<u32>,
}

impl ManifoldReport {
    /// Examines a whole mesh. O(n log n).
    pub fn of(mesh: &Mesh) -> Self {
        Self::of_polygons(mesh, 0..mesh.polygon_count(), |_| true)
    }

    /// Examines some polygons of a mesh, and of the vertices those for which `whole` says that all their polygons are
    /// among them. Polygons must be less than [`Mesh::polygon_count`].
    pub fn of_polygons(mesh: &Mesh, polygons: impl IntoIterator<Item = usize>, whole: impl Fn(u32) -> bool) -> Self {
        // Of each corner its vertex and those before and behind it.
        let mut corners: Vec<[u32; 3]> = Vec::new();
        let mut sides: Vec<[u32; 2]> = Vec::new();
        for polygon in polygons {
            let vertices = mesh.polygon(polygon);
            let mut previous = vertices.iter().copied().cycle().skip(vertices.len() - 1);
            let mut next = vertices.iter().copied().cycle().skip(1);
            for &vertex in vertices {
                if let (Some(before), Some(behind)) = (previous.next(), next.next()) {
                    corners.push([vertex, before, behind]);
                    if vertex != behind {
                        sides.push([vertex.min(behind), vertex.max(behind)]);
                    }
                }
            }
        }
        sides.sort_unstable();
        let mut edges: Vec<[u32; 2]> = sides.windows(3).filter(|s| s[0] == s[2]).map(|s| s[0]).collect();
        edges.dedup();
        let mut ends: Vec<u32> = edges.iter().flatten().copied().collect();
        ends.sort_unstable();
        corners.sort_unstable();
        let split = |fan: &&[[u32; 3]]| whole(fan[0][0]) && fans(fan) > 1 && ends.binary_search(&fan[0][0]).is_err();
        let vertices = corners.chunk_by(|a, b| a[0] == b[0]).filter(split).map(|fan| fan[0][0]).collect();
        Self { edges, vertices }
    }

    /// Whether nothing was found.
    pub fn is_manifold(&self) -> bool {
        self.edges.is_empty() && self.vertices.is_empty()
    }
}

/// Number of fans into which the corners at a vertex fall: corners with a common neighbour belong together.
fn fans(corners: &[[u32; 3]]) -> usize {
    let mut number: Vec<usize> = (0..corners.len()).collect();
    let mut count = corners.len();
    // Few corners meet at a vertex, so that going over all pairs is the shortest way.
    for i in 0..corners.len() {
        for j in 0..i {
            let joined = corners[i][1..].iter().any(|v| corners[j][1..].contains(v));
            if joined && number[i] != number[j] {
                let (from, to) = (number[i], number[j]);
                number.iter_mut().filter(|n| **n == from).for_each(|n| *n = to);
                count -= 1;
            }
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn mesh(vertices: usize, polygons: &[&[u32]]) -> Mesh {
        Mesh::new((0..vertices).map(|i| DVec3::new(i as f64, 0.0, 0.0)).collect(), polygons).unwrap()
    }

    #[test]
    fn closed_and_open_surfaces_are_manifolds() {
        let tetrahedron = mesh(4, &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]]);
        assert!(ManifoldReport::of(&tetrahedron).is_manifold());
        let strip = mesh(6, &[&[0, 1, 3, 2], &[2, 3, 5, 4]]);
        assert!(ManifoldReport::of(&strip).is_manifold());
        assert!(ManifoldReport::of(&Mesh::default()).is_manifold());
        // A polygon turned over is no hindrance.
        assert!(ManifoldReport::of(&mesh(4, &[&[0, 1, 2], &[1, 2, 3]])).is_manifold());
    }

    #[test]
    fn a_fin_is_named_by_its_edge() {
        let fin = mesh(5, &[&[0, 1, 2], &[1, 0, 3], &[0, 1, 4]]);
        let found = ManifoldReport::of(&fin);
        assert_eq!(found, ManifoldReport { edges: vec![[0, 1]], vertices: vec![] });
        assert!(!found.is_manifold());
        // Nor is it found among the polygons asked for alone.
        assert!(ManifoldReport::of_polygons(&fin, [0, 2], |_| true).is_manifold());
    }

    #[test]
    fn fans_that_touch_in_a_point_are_named_by_it() {
        let bow = mesh(7, &[&[0, 1, 2], &[2, 3, 4], &[2, 4, 5]]);
        assert_eq!(ManifoldReport::of(&bow), ManifoldReport { edges: vec![], vertices: vec![2] });
        assert!(ManifoldReport::of_polygons(&bow, 0..3, |v| v != 2).is_manifold());
    }
}
