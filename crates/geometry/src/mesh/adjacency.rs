//! Which vertices are joined by edges: rings, distances in edges, components.

use super::{Mesh, triangles};

/// The neighbours of each vertex, in ascending order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Adjacency {
    /// First neighbour of each vertex, and behind the last one the number of all.
    starts: Vec<usize>,
    neighbours: Vec<u32>,
}

impl Adjacency {
    /// Neighbours along the sides of the polygons.
    pub fn along_sides(mesh: &Mesh) -> Self {
        let sides = mesh.polygons().flat_map(|corners| {
            corners.iter().copied().zip(corners.iter().copied().cycle().skip(1)).map(<[u32; 2]>::from)
        });
        Self::new(mesh.positions().len(), sides)
    }

    /// Neighbours along the sides and along the diagonals by which [`triangles`] splits the polygons.
    pub fn along_triangles(mesh: &Mesh) -> Self {
        let vertex = |corner: usize| mesh.corners()[corner];
        let sides = triangles(mesh).flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]].map(|side| side.map(vertex)));
        Self::new(mesh.positions().len(), sides)
    }

    /// Neighbours along the given edges of `vertices` vertices. An edge may be given more than once and either way; one
    /// that leads back to its own vertex is none, nor is one to a vertex that is not there.
    pub fn new(vertices: usize, edges: impl IntoIterator<Item = [u32; 2]>) -> Self {
        let fits = |[a, b]: &[u32; 2]| a != b && (*a.max(b) as usize) < vertices;
        let edges: Vec<[u32; 2]> = edges.into_iter().filter(fits).collect();
        let mut places = vec![0_usize; vertices + 1];
        for [a, b] in &edges {
            places[*a as usize + 1] += 1;
            places[*b as usize + 1] += 1;
        }
        for vertex in 0..vertices {
            places[vertex + 1] += places[vertex];
        }
        let mut all = vec![0; places[vertices]];
        let mut next = places.clone();
        for [a, b] in edges {
            for (from, to) in [(a, b), (b, a)] {
                all[next[from as usize]] = to;
                next[from as usize] += 1;
            }
        }
        let mut starts = Vec::with_capacity(vertices + 1);
        let mut neighbours = Vec::with_capacity(all.len() / 2);
        for vertex in 0..vertices {
            starts.push(neighbours.len());
            let ring = &mut all[places[vertex]..places[vertex + 1]];
            ring.sort_unstable();
            for (i, neighbour) in ring.iter().enumerate() {
                if i == 0 || ring[i - 1] != *neighbour {
                    neighbours.push(*neighbour);
                }
            }
        }
        starts.push(neighbours.len());
        Self { starts, neighbours }
    }

    /// Number of vertices.
    pub fn vertices(&self) -> usize {
        self.starts.len() - 1
    }

    /// The neighbours of a vertex, ascending: its 1-ring without itself. `vertex` must be less than
    /// [`Adjacency::vertices`].
    pub fn ring(&self, vertex: u32) -> &[u32] {
        &self.neighbours[self.starts[vertex as usize]..self.starts[vertex as usize + 1]]
    }

    /// All vertices within `edges` edges of one, ascending, without itself.
    pub fn within(&self, vertex: u32, edges: usize) -> Vec<u32> {
        let mut found = vec![vertex];
        let mut edge = 0;
        for _ in 0..edges {
            let end = found.len();
            for i in edge..end {
                found.extend_from_slice(self.ring(found[i]));
            }
            // The vertices before `end` are in order of distance; of the new ones only those not yet there stay.
            let mut new = found.split_off(end);
            new.sort_unstable();
            new.dedup();
            let mut known = found.clone();
            known.sort_unstable();
            new.retain(|v| known.binary_search(v).is_err());
            edge = end;
            found.append(&mut new);
        }
        found.swap_remove(0);
        found.sort_unstable();
        found
    }

    /// Number of edges from the nearest of some vertices to each vertex, `u32::MAX` where no path leads. Vertices that
    /// are not there are left out.
    pub fn edge_distances(&self, from: &[u32]) -> Vec<u32> {
        let mut distances = vec![u32::MAX; self.vertices()];
        let mut queue = std::collections::VecDeque::new();
        for &vertex in from {
            if let Some(distance) = distances.get_mut(vertex as usize)
                && *distance != 0
            {
                *distance = 0;
                queue.push_back(vertex);
            }
        }
        while let Some(vertex) = queue.pop_front() {
            let next = distances[vertex as usize] + 1;
            for &neighbour in self.ring(vertex) {
                if distances[neighbour as usize] > next {
                    distances[neighbour as usize] = next;
                    queue.push_back(neighbour);
                }
            }
        }
        distances
    }

    /// The component of each vertex, counted from 0 in the order of their first vertices, and their number. A vertex
    /// without edges is one by itself.
    pub fn components(&self) -> (Vec<u32>, usize) {
        let mut component = vec![u32::MAX; self.vertices()];
        let mut count = 0;
        let mut open = Vec::new();
        for first in 0..self.vertices() {
            if component[first] != u32::MAX {
                continue;
            }
            component[first] = count;
            open.push(first as u32);
            while let Some(vertex) = open.pop() {
                for &neighbour in self.ring(vertex) {
                    if component[neighbour as usize] == u32::MAX {
                        component[neighbour as usize] = count;
                        open.push(neighbour);
                    }
                }
            }
            count += 1;
        }
        (component, count as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    /// A ladder of three quads, vertices 2i and 2i + 1 a rung, and a loose vertex.
    fn ladder() -> Mesh {
        let mut points: Vec<DVec3> = (0..4).flat_map(|i| [0.0, 1.0].map(|z| DVec3::new(i.into(), 0.0, z))).collect();
        points.push(DVec3::splat(9.0));
        Mesh::new(points, (0..3_u32).map(|i| [2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2])).unwrap()
    }

    #[test]
    fn sides_join_and_diagonals_only_in_triangles() {
        let sides = Adjacency::along_sides(&ladder());
        assert_eq!(sides.ring(2), [0, 3, 4]);
        assert_eq!(sides.ring(8), [] as [u32; 0]);
        let split = Adjacency::along_triangles(&ladder());
        let diagonals: usize = (0..9).map(|v| split.ring(v).len() - sides.ring(v).len()).sum();
        assert_eq!(diagonals, 6);
    }

    #[test]
    fn rings_are_sorted_and_without_the_vertex() {
        let sides = Adjacency::along_sides(&ladder());
        assert_eq!(sides.within(0, 0), [] as [u32; 0]);
        assert_eq!(sides.within(0, 1), [1, 2]);
        assert_eq!(sides.within(0, 2), [1, 2, 3, 4]);
        assert_eq!(sides.within(4, 9), [0, 1, 2, 3, 5, 6, 7]);
    }

    #[test]
    fn distances_count_edges() {
        let sides = Adjacency::along_sides(&ladder());
        let far = u32::MAX;
        assert_eq!(sides.edge_distances(&[0]), [0, 1, 1, 2, 2, 3, 3, 4, far]);
        assert_eq!(sides.edge_distances(&[0, 7, 99]), [0, 1, 1, 2, 2, 1, 1, 0, far]);
        assert_eq!(sides.edge_distances(&[]), [far; 9]);
    }

    #[test]
    fn components_are_in_the_order_of_their_first_vertices() {
        let sides = Adjacency::along_sides(&ladder());
        assert_eq!(sides.components(), (vec![0, 0, 0, 0, 0, 0, 0, 0, 1], 2));
        let odd = Adjacency::new(4, [[1, 3], [3, 1], [2, 2], [0, 7]]);
        assert_eq!(odd.components(), (vec![0, 1, 2, 1], 3));
    }
}
