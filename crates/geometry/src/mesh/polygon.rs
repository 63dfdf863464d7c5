//! A polygon mesh with attributes at its corners.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::boundary_loops::KeptLoops;
use super::face_names::{FaceNames, NamedBy};

/// Polygons over shared vertices. A *corner* is one vertex of one polygon; UVs and normals live at the corners, so
/// that a seam or a hard edge needs no doubled vertex and the mesh stays closed.
///
/// Invariants, kept by the constructor: every polygon has three or more corners, every index is in range, every
/// coordinate is finite, attributes have one entry a corner, names one a polygon.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    name: String,
    positions: Vec<DVec3>,
    /// Vertex of each corner, polygon after polygon.
    corners: Vec<u32>,
    /// First corner of each polygon, and behind the last one the number of corners.
    starts: Vec<u32>,
    normals: Option<Vec<DVec3>>,
    uvs: Option<Vec<DVec2>>,
    groups: Option<Arc<FaceNames>>,
    materials: Option<Arc<FaceNames>>,
    pub(super) kept_loops: KeptLoops,
}

/// Why data does not make a mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshError {
    /// A polygon with fewer than three corners.
    #[error("polygon {polygon} has {found} corner(s), and needs at least 3")]
    TooFewCorners {
        /// Index of the polygon.
        polygon: usize,
        /// Its corners.
        found: usize,
    },
    /// A corner that names a vertex that is not there.
    #[error("polygon {polygon} uses vertex {vertex}, but there are only {vertices} vertices")]
    IndexOutOfRange {
        /// Index of the polygon.
        polygon: usize,
        /// The vertex it names.
        vertex: u32,
        /// Vertices of the mesh.
        vertices: usize,
    },
    /// A coordinate, normal or UV that is not a number or is infinite.
    #[error("vertex or corner {index} of the {what} is not finite")]
    NotFinite {
        /// Which attribute.
        what: &'static str,
        /// Index of the vertex or corner.
        index: usize,
    },
    /// An attribute with another length than the corners.
    #[error("{found} {what} given for {corners} corners")]
    AttributeCount {
        /// Which attribute.
        what: &'static str,
        /// Entries found.
        found: usize,
        /// Corners of the mesh.
        corners: usize,
    },
    /// Names for another number of polygons.
    #[error("{found} names given for {polygons} polygons")]
    NameCount {
        /// Names found.
        found: usize,
        /// Polygons of the mesh.
        polygons: usize,
    },
    /// Positions for another mesh.
    #[error("{found} positions given for {vertices} vertices")]
    PositionCount {
        /// Positions found.
        found: usize,
        /// Vertices of the mesh.
        vertices: usize,
    },
    /// More vertices or corners than 32-bit indices reach.
    #[error("the mesh has more than 4 294 967 295 vertices or corners")]
    TooLarge,
}

impl Default for Mesh {
    /// A mesh without vertices and polygons.
    fn default() -> Self {
        Self::bare(vec![], vec![], vec![0])
    }
}

impl Mesh {
    fn bare(positions: Vec<DVec3>, corners: Vec<u32>, starts: Vec<u32>) -> Self {
        Self {
            name: String::new(),
            positions,
            corners,
            starts,
            normals: None,
            uvs: None,
            groups: None,
            materials: None,
            kept_loops: KeptLoops::default(),
        }
    }

    /// Makes a mesh from vertices and polygons (each a list of vertex indices, counter-clockwise seen from outside).
    ///
    /// # Errors
    /// [`MeshError`] where a polygon is too small, an index is out of range or a coordinate is not finite.
    pub fn new<P: AsRef<[u32]>>(
        positions: Vec<DVec3>,
        polygons: impl IntoIterator<Item = P>,
    ) -> Result<Self, MeshError> {
        if positions.len() > u32::MAX as usize {
            return Err(MeshError::TooLarge);
        }
        if let Some(index) = positions.iter().position(|p| !p.is_finite()) {
            return Err(MeshError::NotFinite { what: "positions", index });
        }
        let mut corners = Vec::new();
        let mut starts = vec![0];
        for (polygon, indices) in polygons.into_iter().enumerate() {
            let indices = indices.as_ref();
            if indices.len() < 3 {
                return Err(MeshError::TooFewCorners { polygon, found: indices.len() });
            }
            if let Some(&vertex) = indices.iter().find(|v| **v as usize >= positions.len()) {
                return Err(MeshError::IndexOutOfRange { polygon, vertex, vertices: positions.len() });
            }
            corners.extend_from_slice(indices);
            starts.push(u32::try_from(corners.len()).map_err(|_| MeshError::TooLarge)?);
        }
        Ok(Self::bare(positions, corners, starts))
    }

    /// Makes a mesh from vertices, the vertex indices of all polygons one behind the other, and the number of corners of
    /// each polygon: as [`Mesh::new`], without copying large lists.
    ///
    /// # Errors
    /// As [`Mesh::new`], and where the numbers do not add up to that of the indices.
    pub fn from_corners(
        positions: Vec<DVec3>,
        corners: Vec<u32>,
        counts: impl IntoIterator<Item = usize>,
    ) -> Result<Self, MeshError> {
        if positions.len() > u32::MAX as usize || corners.len() > u32::MAX as usize {
            return Err(MeshError::TooLarge);
        }
        if let Some(index) = positions.iter().position(|p| !p.is_finite()) {
            return Err(MeshError::NotFinite { what: "positions", index });
        }
        let mut starts = vec![0];
        let mut end = 0_usize;
        for (polygon, found) in counts.into_iter().enumerate() {
            if found < 3 {
                return Err(MeshError::TooFewCorners { polygon, found });
            }
            end = end.saturating_add(found);
            // Beyond the corners only where the sum is found wrong below.
            starts.push(end.min(corners.len()) as u32);
        }
        if end != corners.len() {
            return Err(MeshError::AttributeCount {
                what: "corners in the polygons' counts",
                found: end,
                corners: corners.len(),
            });
        }
        if let Some(corner) = corners.iter().position(|v| *v as usize >= positions.len()) {
            let polygon = starts.partition_point(|start| *start as usize <= corner) - 1;
            return Err(MeshError::IndexOutOfRange { polygon, vertex: corners[corner], vertices: positions.len() });
        }
        Ok(Self::bare(positions, corners, starts))
    }

    /// The same mesh under a name.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }

    /// The same polygons, names and UVs over other positions, and other normals where some are given; without, there are
    /// none.
    ///
    /// # Errors
    /// [`MeshError`] where there is another number of positions than of vertices, or of normals than of corners, or one
    /// is not finite.
    pub fn with_positions(&self, positions: Vec<DVec3>, normals: Option<Vec<DVec3>>) -> Result<Self, MeshError> {
        if positions.len() != self.positions.len() {
            return Err(MeshError::PositionCount { found: positions.len(), vertices: self.positions.len() });
        }
        if let Some(index) = positions.iter().position(|p| !p.is_finite()) {
            return Err(MeshError::NotFinite { what: "positions", index });
        }
        let mesh = Self {
            name: self.name.clone(),
            positions,
            corners: self.corners.clone(),
            starts: self.starts.clone(),
            normals: None,
            uvs: self.uvs.clone(),
            groups: self.groups.clone(),
            materials: self.materials.clone(),
            kept_loops: self.kept_loops.clone(),
        };
        match normals {
            Some(normals) => mesh.with_normals(normals),
            None => Ok(mesh),
        }
    }

    /// The same mesh with a unit normal at each corner.
    ///
    /// # Errors
    /// [`MeshError`] where their number is not that of the corners, or one is not finite.
    pub fn with_normals(mut self, normals: Vec<DVec3>) -> Result<Self, MeshError> {
        if normals.len() != self.corners.len() {
            return Err(MeshError::AttributeCount {
                what: "normals",
                found: normals.len(),
                corners: self.corners.len(),
            });
        }
        if let Some(index) = normals.iter().position(|n| !n.is_finite()) {
            return Err(MeshError::NotFinite { what: "normals", index });
        }
        self.normals = Some(normals);
        Ok(self)
    }

    /// The same mesh with a UV at each corner (u along the section, v along the stack, origin bottom left).
    ///
    /// # Errors
    /// [`MeshError`] where their number is not that of the corners, or one is not finite.
    pub fn with_uvs(mut self, uvs: Vec<DVec2>) -> Result<Self, MeshError> {
        if uvs.len() != self.corners.len() {
            return Err(MeshError::AttributeCount { what: "UVs", found: uvs.len(), corners: self.corners.len() });
        }
        if let Some(index) = uvs.iter().position(|n| !n.is_finite()) {
            return Err(MeshError::NotFinite { what: "UVs", index });
        }
        self.uvs = Some(uvs);
        Ok(self)
    }

    /// The same mesh with a group or material name at each polygon.
    ///
    /// What moves, turns, mirrors, joins, cuts, parts, welds and caps meshes carries them along, and new polygons have an empty
    /// name; where a border is resampled, and where a mesh is made anew, they are gone.
    ///
    /// # Errors
    /// [`MeshError::NameCount`] where their number is not that of the polygons.
    pub fn with_names(mut self, by: NamedBy, names: FaceNames) -> Result<Self, MeshError> {
        if names.len() != self.polygon_count() {
            return Err(MeshError::NameCount { found: names.len(), polygons: self.polygon_count() });
        }
        let names = Some(Arc::new(names));
        match by {
            NamedBy::Group => self.groups = names,
            NamedBy::Material => self.materials = names,
        }
        Ok(self)
    }

    /// The same mesh with the groups and materials of another one, polygon by polygon; those of `mesh` must be as many.
    pub(crate) fn named_like(mut self, mesh: &Self) -> Self {
        if mesh.polygon_count() == self.polygon_count() {
            self.groups.clone_from(&mesh.groups);
            self.materials.clone_from(&mesh.materials);
        }
        self
    }

    /// Name; may be empty.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Vertices, metres.
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// Number of polygons.
    pub fn polygon_count(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Vertex indices of polygon `index`, counter-clockwise seen from outside.
    pub fn polygon(&self, index: usize) -> &[u32] {
        &self.corners[self.corner_range(index)]
    }

    /// Corner indices of polygon `index`: where its entries stand in [`Mesh::normals`] and [`Mesh::uvs`].
    pub fn corner_range(&self, index: usize) -> std::ops::Range<usize> {
        self.starts[index] as usize..self.starts[index + 1] as usize
    }

    /// The polygons in order, as vertex indices.
    pub fn polygons(&self) -> impl ExactSizeIterator<Item = &[u32]> {
        (0..self.polygon_count()).map(|index| self.polygon(index))
    }

    /// Vertex of each corner, polygon after polygon.
    pub fn corners(&self) -> &[u32] {
        &self.corners
    }

    /// First corner of each polygon, and behind the last one the number of corners.
    pub fn starts(&self) -> &[u32] {
        &self.starts
    }

    /// Unit normal of each corner, where there are normals.
    pub fn normals(&self) -> Option<&[DVec3]> {
        self.normals.as_deref()
    }

    /// The group of each polygon, where there are groups.
    pub fn groups(&self) -> Option<&FaceNames> {
        self.groups.as_deref()
    }

    /// The name of each polygon's material, where there are some.
    pub fn materials(&self) -> Option<&FaceNames> {
        self.materials.as_deref()
    }

    /// UV of each corner, where there are UVs.
    pub fn uvs(&self) -> Option<&[DVec2]> {
        self.uvs.as_deref()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flat_lists_make_the_same_mesh() {
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y, DVec3::Z];
        let polygons: [&[u32]; 2] = [&[0, 1, 2, 3], &[2, 1, 4]];
        let flat = Mesh::from_corners(points.clone(), vec![0, 1, 2, 3, 2, 1, 4], [4, 3]).unwrap();
        assert_eq!(flat, Mesh::new(points, polygons).unwrap());
    }

    #[test]
    fn flat_lists_are_checked() {
        let make = |corners: Vec<u32>, counts: &[usize]| {
            Mesh::from_corners(vec![DVec3::ZERO; 4], corners, counts.iter().copied()).unwrap_err()
        };
        assert_eq!(make(vec![0, 1, 2, 0, 1], &[3, 2]), MeshError::TooFewCorners { polygon: 1, found: 2 });
        assert!(matches!(make(vec![0, 1, 2, 0], &[3]), MeshError::AttributeCount { found: 3, corners: 4, .. }));
        assert!(matches!(make(vec![0, 1, 2], &[3, usize::MAX]), MeshError::AttributeCount { .. }));
        let range = MeshError::IndexOutOfRange { polygon: 1, vertex: 4, vertices: 4 };
        assert_eq!(make(vec![0, 1, 2, 0, 4, 1], &[3, 3]), range);
        let nan = Mesh::from_corners(vec![DVec3::NAN; 3], vec![0, 1, 2], [3]).unwrap_err();
        assert_eq!(nan, MeshError::NotFinite { what: "positions", index: 0 });
    }
}
