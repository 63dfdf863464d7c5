//! Which polygons are at each vertex.

use super::Mesh;

/// The polygons at each vertex of a mesh, ascending.
pub(crate) struct VertexPolygons {
    /// Where those of each vertex begin, and behind the last one the number of all.
    starts: Vec<u32>,
    polygons: Vec<u32>,
}

impl VertexPolygons {
    pub(crate) fn new(mesh: &Mesh) -> Self {
        // Corners have 32-bit places, see `Mesh`.
        let mut starts = vec![0_u32; mesh.positions().len() + 1];
        for vertex in mesh.corners() {
            starts[*vertex as usize + 1] += 1;
        }
        for vertex in 1..starts.len() {
            starts[vertex] += starts[vertex - 1];
        }
        let mut next = starts.clone();
        let mut polygons = vec![0; mesh.corners().len()];
        for (polygon, corners) in mesh.polygons().enumerate() {
            for vertex in corners {
                let place = &mut next[*vertex as usize];
                polygons[*place as usize] = polygon as u32;
                *place += 1;
            }
        }
        Self { starts, polygons }
    }

    pub(crate) fn of(&self, vertex: u32) -> &[u32] {
        let [from, to] = [vertex as usize, vertex as usize + 1].map(|at| self.starts[at] as usize);
        &self.polygons[from..to]
    }
}
