//! A mesh under construction, corner by corner.

use glam::{DVec2, DVec3};

use crate::mesh::{Mesh, MeshError, measure};

/// Vertices and polygons with a normal and a UV at each corner.
#[derive(Clone, Debug, Default)]
pub(crate) struct MeshParts {
    pub positions: Vec<DVec3>,
    pub corners: Vec<u32>,
    pub counts: Vec<u8>,
    pub normals: Vec<DVec3>,
    pub uvs: Vec<DVec2>,
}

/// Vertex, normal and UV of a corner. A zero normal stands for that of the polygon.
pub(crate) type Corner = (u32, DVec3, DVec2);

impl MeshParts {
    /// Makes room for about as many polygons of four corners.
    pub fn reserve(&mut self, polygons: usize) {
        self.corners.reserve(4 * polygons);
        self.normals.reserve(4 * polygons);
        self.uvs.reserve(4 * polygons);
        self.counts.reserve(polygons);
    }

    /// Adds a polygon of three or four corners, counter-clockwise seen from outside.
    pub fn polygon<const N: usize>(&mut self, corners: [Corner; N]) {
        const { assert!(N == 3 || N == 4) };
        self.corners.extend(corners.map(|corner| corner.0));
        self.uvs.extend(corners.map(|corner| corner.2));
        if corners.iter().any(|corner| corner.1 == DVec3::ZERO) {
            let own = measure::vector_area(corners.map(|corner| self.positions[corner.0 as usize]));
            let own = own.try_normalize().unwrap_or(DVec3::Y);
            self.normals.extend(corners.map(|corner| if corner.1 == DVec3::ZERO { own } else { corner.1 }));
        } else {
            self.normals.extend(corners.map(|corner| corner.1));
        }
        self.counts.push(N as u8);
    }

    /// The finished mesh.
    pub fn finish(self) -> Result<Mesh, MeshError> {
        let counts = self.counts.iter().map(|count| usize::from(*count));
        Mesh::from_corners(self.positions, self.corners, counts)?.with_normals(self.normals)?.with_uvs(self.uvs)
    }
}
