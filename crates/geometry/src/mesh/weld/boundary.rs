//! The open loops of all parts, in the numbers of the joined mesh.

use super::WeldError;
use crate::mesh::Mesh;

/// An open loop of a part.
pub(super) struct OpenLoop {
    /// Which part, counted from 0.
    pub(super) part: usize,
    /// Its vertices in the joined mesh, run as a cap would be.
    pub(super) vertices: Vec<u32>,
}

/// The open loops of all parts, and where the parts lie in the joined mesh.
pub(super) struct Boundary {
    pub(super) loops: Vec<OpenLoop>,
    /// First vertex and polygon of each part, and behind the last one their numbers.
    starts: Vec<[usize; 2]>,
}

impl Boundary {
    pub(super) fn of(parts: &[&Mesh], go_on: &dyn Fn() -> Result<(), WeldError>) -> Result<Self, WeldError> {
        let mut loops = Vec::new();
        let mut starts = vec![[0; 2]];
        let mut behind = [0; 2];
        for (part, mesh) in parts.iter().enumerate() {
            // The joined mesh has 32-bit indices.
            let open = mesh.boundary_loops_while(go_on)?.iter();
            let shifted = open.map(|rim| rim.iter().map(|vertex| vertex + behind[0] as u32).collect());
            loops.extend(shifted.map(|vertices| OpenLoop { part, vertices }));
            let sizes = [mesh.positions().len(), mesh.polygon_count()];
            for (place, size) in behind.iter_mut().zip(sizes) {
                *place += size;
            }
            starts.push(behind);
        }
        Ok(Self { loops, starts })
    }

    /// The part of a vertex of the joined mesh.
    pub(super) fn part_of_vertex(&self, vertex: u32) -> usize {
        self.part_of(0, vertex as usize)
    }

    /// The part of a polygon.
    pub(super) fn part_of_polygon(&self, polygon: usize) -> usize {
        self.part_of(1, polygon)
    }

    fn part_of(&self, what: usize, index: usize) -> usize {
        self.starts.partition_point(|start| start[what] <= index).saturating_sub(1)
    }
}
