//! Which polygons meet at which edges: boundaries, shells, Euler characteristic.

use std::convert::Infallible;

use super::Mesh;

/// Polygons or vertices between two questions whether to go on: a few milliseconds.
pub(super) const STEP: usize = 1 << 16;

/// The edges of a mesh with the polygons at each, sorted by their vertices, so that the same mesh always gives the same
/// lists.
#[derive(Clone, Debug)]
pub struct Topology {
    /// Uses of all edges, sorted by edge, then polygon.
    uses: Vec<EdgeUse>,
    /// First use of each edge, and behind the last one the number of uses.
    starts: Vec<usize>,
    vertices: usize,
    polygons: usize,
}

/// One side of one polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct EdgeUse {
    /// The edge's vertices, lower index first.
    pub edge: [u32; 2],
    /// The polygon.
    pub polygon: u32,
    /// Whether the polygon runs it from the lower index to the higher.
    pub forward: bool,
}

impl EdgeUse {
    /// The vertices in the order the polygon runs them.
    pub fn directed(&self) -> [u32; 2] {
        if self.forward { self.edge } else { [self.edge[1], self.edge[0]] }
    }
}

impl Topology {
    /// Collects the edges of a mesh. A side whose ends are one vertex is no edge.
    pub fn new(mesh: &Mesh) -> Self {
        match Self::new_while::<Infallible>(mesh, &|| Ok(())) {
            Ok(topology) => topology,
        }
    }

    /// The same, or the error with which `go_on`, asked every 65,536 polygons or vertices, says stop.
    ///
    /// Uses are dealt out to their lower vertices first and sorted there, a few at each: sorting all at once could not
    /// be stopped.
    pub(crate) fn new_while<Stop>(mesh: &Mesh, go_on: &dyn Fn() -> Result<(), Stop>) -> Result<Self, Stop> {
        let ask = |done: usize| if done.is_multiple_of(STEP) { go_on() } else { Ok(()) };
        let sides = |corners: &[u32], k: usize| (corners[k], corners[if k + 1 == corners.len() { 0 } else { k + 1 }]);
        let vertices = mesh.positions().len();
        let mut used = vec![false; vertices];
        // How many uses each vertex has as the lower one, then where they begin.
        let mut places = vec![0_usize; vertices + 1];
        for (polygon, corners) in mesh.polygons().enumerate() {
            ask(polygon)?;
            for k in 0..corners.len() {
                let (from, to) = sides(corners, k);
                used[from as usize] = true;
                if from != to {
                    places[from.min(to) as usize + 1] += 1;
                }
            }
        }
        for vertex in 0..vertices {
            places[vertex + 1] += places[vertex];
        }
        let mut uses = vec![EdgeUse { edge: [0; 2], polygon: 0, forward: false }; places[vertices]];
        let mut next = places.clone();
        for (polygon, corners) in mesh.polygons().enumerate() {
            ask(polygon)?;
            for k in 0..corners.len() {
                let (from, to) = sides(corners, k);
                if from != to {
                    let edge = [from.min(to), from.max(to)];
                    let place = &mut next[edge[0] as usize];
                    // Polygons cannot outnumber the corners, which have 32-bit places.
                    uses[*place] = EdgeUse { edge, polygon: polygon as u32, forward: from < to };
                    *place += 1;
                }
            }
        }
        let mut starts = Vec::with_capacity(uses.len() / 2 + 1);
        for vertex in 0..vertices {
            ask(vertex)?;
            let range = places[vertex]..places[vertex + 1];
            uses[range.clone()].sort_unstable();
            starts.extend(range.clone().filter(|i| *i == range.start || uses[*i].edge != uses[*i - 1].edge));
        }
        starts.push(uses.len());
        let vertices = used.iter().filter(|used| **used).count();
        Ok(Self { uses, starts, vertices, polygons: mesh.polygon_count() })
    }

    /// Number of edges.
    pub fn edge_count(&self) -> usize {
        self.starts.len() - 1
    }

    /// The uses of each edge in order; one for an edge on the boundary, two inside, more where it is not manifold.
    pub fn edges(&self) -> impl ExactSizeIterator<Item = &[EdgeUse]> {
        (0..self.edge_count()).map(|i| &self.uses[self.starts[i]..self.starts[i + 1]])
    }

    /// The uses of the edge between two vertices, in any order; empty where there is none.
    pub fn edge(&self, a: u32, b: u32) -> &[EdgeUse] {
        let edge = [a.min(b), a.max(b)];
        let from = self.uses.partition_point(|u| u.edge < edge);
        let count = self.uses[from..].iter().take_while(|u| u.edge == edge).count();
        &self.uses[from..from + count]
    }

    /// Whether every edge has two polygons or more. True for a mesh without polygons.
    pub fn is_closed(&self) -> bool {
        self.edges().all(|uses| uses.len() > 1)
    }

    /// Edges of only one polygon, in the direction in which the polygon runs them.
    pub fn boundary_edges(&self) -> Vec<[u32; 2]> {
        self.edges().filter(|uses| uses.len() == 1).map(|uses| uses[0].directed()).collect()
    }

    /// Edges of more than two polygons, lower index first.
    pub fn non_manifold_edges(&self) -> Vec<[u32; 2]> {
        self.edges().filter(|uses| uses.len() > 2).map(|uses| uses[0].edge).collect()
    }

    /// Edges that two polygons run in the same direction, so that one of them faces in where the other faces out; lower
    /// index first.
    pub fn inconsistent_edges(&self) -> Vec<[u32; 2]> {
        let inconsistent = |uses: &&[EdgeUse]| uses.len() == 2 && uses[0].forward == uses[1].forward;
        self.edges().filter(inconsistent).map(|uses| uses[0].edge).collect()
    }

    /// The polygon at the boundary edge between two vertices, if there is one.
    pub fn boundary_polygon(&self, a: u32, b: u32) -> Option<usize> {
        match self.edge(a, b) {
            [only] => Some(only.polygon as usize),
            _ => None,
        }
    }

    /// Loops of boundary edges as vertices, each running so that a polygon made of it would close the hole with the
    /// orientation of the mesh around it. No vertex stands twice in a loop: where loops touch, they are parted.
    ///
    /// Next to edges that are not manifold or not consistent a chain of boundary edges may end without coming back;
    /// such a chain is given like a loop.
    pub fn boundary_loops(&self) -> Vec<Vec<u32>> {
        loops_of(self.boundary_edges())
    }

    /// Polygons that hang together by edges: one ascending list a shell, ordered by their first polygon.
    pub fn shells(&self) -> Vec<Vec<usize>> {
        let mut parent: Vec<usize> = (0..self.polygons).collect();
        fn root(parent: &mut [usize], mut i: usize) -> usize {
            while parent[i] != i {
                parent[i] = parent[parent[i]];
                i = parent[i];
            }
            i
        }
        for uses in self.edges() {
            for pair in uses.windows(2) {
                let a = root(&mut parent, pair[0].polygon as usize);
                let b = root(&mut parent, pair[1].polygon as usize);
                // The lower index stays the root, so that roots come first in their shell.
                parent[a.max(b)] = a.min(b);
            }
        }
        let mut shells: Vec<Vec<usize>> = Vec::new();
        let mut number = vec![usize::MAX; self.polygons];
        for polygon in 0..self.polygons {
            let root = root(&mut parent, polygon);
            if number[root] == usize::MAX {
                number[root] = shells.len();
                shells.push(Vec::new());
            }
            shells[number[root]].push(polygon);
        }
        shells
    }

    /// Vertices in use minus edges plus polygons: 2 for each closed shell without handles, 0 for an open tube.
    pub fn euler_characteristic(&self) -> i64 {
        self.vertices as i64 - self.edge_count() as i64 + self.polygons as i64
    }
}

/// The loops of boundary edges, as [`Topology::boundary_loops`] gives them.
pub(super) fn loops_of(boundary: Vec<[u32; 2]>) -> Vec<Vec<u32>> {
    let mut edges: Vec<[u32; 2]> = boundary.into_iter().map(|[from, to]| [to, from]).collect();
    edges.sort_unstable();
    let mut taken = vec![false; edges.len()];
    let mut loops = Vec::new();
    let mut place = std::collections::BTreeMap::new();
    for start in 0..edges.len() {
        if taken[start] {
            continue;
        }
        taken[start] = true;
        let mut path = vec![edges[start][0]];
        let mut at = edges[start][1];
        place.clear();
        place.insert(path[0], 0);
        loop {
            if let Some(&from) = place.get(&at) {
                let closed: Vec<u32> = path.drain(from..).collect();
                for vertex in &closed {
                    place.remove(vertex);
                }
                loops.push(closed);
            }
            let outgoing = edges.partition_point(|e| e[0] < at);
            let next = (outgoing..edges.len()).take_while(|i| edges[*i][0] == at).find(|i| !taken[*i]);
            let Some(next) = next else {
                if !path.is_empty() {
                    path.push(at);
                    loops.push(path);
                }
                break;
            };
            place.insert(at, path.len());
            path.push(at);
            taken[next] = true;
            at = edges[next][1];
        }
    }
    loops
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn mesh(vertices: usize, polygons: &[&[u32]]) -> Mesh {
        Mesh::new((0..vertices).map(|i| DVec3::new(i as f64, 0.0, 0.0)).collect(), polygons).unwrap()
    }

    const CUBE: [&[u32]; 6] =
        [&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]];

    #[test]
    fn a_cube_is_closed() {
        let cube = Topology::new(&mesh(8, &CUBE));
        assert_eq!(cube.edge_count(), 12);
        assert!(cube.is_closed());
        assert_eq!(cube.euler_characteristic(), 2);
        assert_eq!(cube.shells(), [vec![0, 1, 2, 3, 4, 5]]);
        assert!(cube.boundary_edges().is_empty() && cube.boundary_loops().is_empty());
        assert!(cube.non_manifold_edges().is_empty() && cube.inconsistent_edges().is_empty());
        assert_eq!(cube.edge(5, 1).iter().map(|u| u.polygon).collect::<Vec<_>>(), [2, 3]);
        assert!(cube.edge(0, 6).is_empty());
    }

    #[test]
    fn a_missing_side_leaves_a_loop_that_closes_it() {
        let open = Topology::new(&mesh(8, &CUBE[1..]));
        assert!(!open.is_closed());
        assert_eq!(open.boundary_edges().len(), 4);
        // The missing polygon ran 0, 3, 2, 1.
        assert_eq!(open.boundary_loops(), [vec![0, 3, 2, 1]]);
        assert_eq!(open.boundary_polygon(0, 3), Some(4));
        assert_eq!(open.boundary_polygon(4, 5), None);
    }

    #[test]
    fn a_turned_polygon_is_found() {
        let mut polygons = CUBE;
        polygons[2] = &[4, 5, 1, 0];
        let turned = Topology::new(&mesh(8, &polygons));
        assert_eq!(turned.inconsistent_edges(), [[0, 1], [0, 4], [1, 5], [4, 5]]);
        assert!(turned.is_closed());
    }

    #[test]
    fn three_polygons_at_an_edge_are_found() {
        let fin = Topology::new(&mesh(5, &[&[0, 1, 2], &[1, 0, 3], &[0, 1, 4]]));
        assert_eq!(fin.non_manifold_edges(), [[0, 1]]);
        assert_eq!(fin.boundary_edges().len(), 6);
        let vertices: usize = fin.boundary_loops().iter().map(Vec::len).sum();
        assert!(vertices >= 6);
    }

    #[test]
    fn shells_hang_together_by_edges_not_vertices() {
        let two = Topology::new(&mesh(7, &[&[0, 1, 2], &[4, 5, 6], &[1, 3, 2], &[2, 5, 4]]));
        assert_eq!(two.shells(), [vec![0, 2], vec![1, 3]]);
        assert_eq!(two.euler_characteristic(), 7 - 10 + 4);
    }

    #[test]
    fn loops_that_touch_are_parted() {
        // Two triangles that share vertex 2.
        let touching = Topology::new(&mesh(5, &[&[0, 1, 2], &[2, 3, 4]]));
        let mut loops = touching.boundary_loops();
        for path in &mut loops {
            path.sort_unstable();
        }
        loops.sort_unstable();
        assert_eq!(loops, [vec![0, 1, 2], vec![2, 3, 4]]);
    }

    #[test]
    fn unused_vertices_and_repeated_corners_do_not_count() {
        let odd = Topology::new(&mesh(9, &[&[0, 1, 1, 2]]));
        assert_eq!((odd.edge_count(), odd.euler_characteristic()), (3, 1));
        let none = Topology::new(&Mesh::default());
        assert!(none.is_closed() && none.shells().is_empty());
        assert_eq!(none.euler_characteristic(), 0);
    }
}
