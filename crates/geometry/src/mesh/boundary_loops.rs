//! The boundary loops of a mesh, found once however many ask.

use std::convert::Infallible;
use std::sync::OnceLock;

use super::Mesh;
use super::topology::{STEP, loops_of};

/// Loops that are found when they are first asked for. They follow from the polygons, so that they do not count where
/// meshes are compared.
#[derive(Clone, Default)]
pub(super) struct KeptLoops(OnceLock<Vec<Vec<u32>>>);

impl PartialEq for KeptLoops {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl std::fmt::Debug for KeptLoops {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("..")
    }
}

impl Mesh {
    /// The boundary loops, as [`Topology::boundary_loops`](super::Topology::boundary_loops) has them. They are kept with
    /// the mesh, so that asking again costs nothing.
    pub fn boundary_loops(&self) -> &[Vec<u32>] {
        match self.boundary_loops_while::<Infallible>(&|| Ok(())) {
            Ok(loops) => loops,
        }
    }

    /// The same, or the error with which `go_on`, asked every 65,536 polygons or vertices, says stop.
    pub(crate) fn boundary_loops_while<Stop>(&self, go_on: &dyn Fn() -> Result<(), Stop>) -> Result<&[Vec<u32>], Stop> {
        if let Some(loops) = self.kept_loops.0.get() {
            return Ok(loops);
        }
        let found = loops_of(boundary_edges(self, go_on)?);
        Ok(self.kept_loops.0.get_or_init(|| found))
    }
}

/// Edges of only one polygon, in the direction in which it runs them, sorted by their lower vertices, then the others.
fn boundary_edges<Stop>(mesh: &Mesh, go_on: &dyn Fn() -> Result<(), Stop>) -> Result<Vec<[u32; 2]>, Stop> {
    let ask = |done: usize| if done.is_multiple_of(STEP) { go_on() } else { Ok(()) };
    let sides = |corners: &[u32], each: &mut dyn FnMut(u32, u32)| {
        let mut from = corners[corners.len() - 1];
        for &to in corners {
            if from != to {
                each(from, to);
            }
            from = to;
        }
    };
    let vertices = mesh.positions().len();
    // Sides are dealt out to their lower vertices: how many each has, then where they begin.
    let mut places = vec![0_u32; vertices + 1];
    for (polygon, corners) in mesh.polygons().enumerate() {
        ask(polygon)?;
        sides(corners, &mut |from, to| places[from.min(to) as usize + 1] += 1);
    }
    for vertex in 0..vertices {
        places[vertex + 1] += places[vertex];
    }
    // The other vertex of each side, and whether the polygon comes from the lower one.
    let mut others = vec![0_u64; places[vertices] as usize];
    let mut next = places.clone();
    for (polygon, corners) in mesh.polygons().enumerate() {
        ask(polygon)?;
        sides(corners, &mut |from, to| {
            let place = &mut next[from.min(to) as usize];
            others[*place as usize] = u64::from(from.max(to)) << 1 | u64::from(from < to);
            *place += 1;
        });
    }
    let mut edges = Vec::new();
    for vertex in 0..vertices {
        ask(vertex)?;
        let own = &mut others[places[vertex] as usize..places[vertex + 1] as usize];
        own.sort_unstable();
        for uses in own.chunk_by(|a, b| a >> 1 == b >> 1) {
            if let [only] = uses {
                let (low, high) = (vertex as u32, (only >> 1) as u32);
                edges.push(if only & 1 == 1 { [low, high] } else { [high, low] });
            }
        }
    }
    Ok(edges)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Topology;
    use glam::DVec3;

    fn mesh(vertices: u32, polygons: &[&[u32]]) -> Mesh {
        Mesh::new((0..vertices).map(|i| DVec3::X * f64::from(i)).collect(), polygons).unwrap()
    }

    #[test]
    fn they_are_those_of_the_topology() {
        let cases: [&[&[u32]]; 6] = [
            &[],
            &[&[0, 1, 2], &[2, 3, 4]],
            &[&[0, 1, 2], &[1, 0, 3], &[0, 1, 4]],
            &[&[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]],
            &[&[0, 1, 1, 2], &[2, 1, 7], &[5, 6, 7]],
            &[&[0, 1, 2], &[1, 2, 3]],
        ];
        for polygons in cases {
            let mesh = mesh(8, polygons);
            assert_eq!(boundary_edges::<Infallible>(&mesh, &|| Ok(())), Ok(Topology::new(&mesh).boundary_edges()));
            assert_eq!(mesh.boundary_loops(), Topology::new(&mesh).boundary_loops());
            assert_eq!(mesh, mesh.clone());
        }
    }

    #[test]
    fn they_are_kept_and_found_only_when_told_to_go_on() {
        let triangle = mesh(3, &[&[0, 1, 2]]);
        assert_eq!(triangle.boundary_loops_while(&|| Err("stop")), Err("stop"));
        assert_eq!(triangle.boundary_loops(), [vec![0, 2, 1]]);
        assert_eq!(triangle.boundary_loops_while(&|| Err("stop")), Ok(&[vec![0, 2, 1]][..]));
        // Other positions have the same ones, and an open mesh that is compared with one not asked yet is equal.
        let moved = triangle.with_positions(vec![DVec3::ZERO, DVec3::X, DVec3::Y], None).unwrap();
        assert_eq!(moved.boundary_loops_while(&|| Err("stop")), Ok(&[vec![0, 2, 1]][..]));
        assert_eq!(triangle, mesh(3, &[&[0, 1, 2]]));
    }
}
