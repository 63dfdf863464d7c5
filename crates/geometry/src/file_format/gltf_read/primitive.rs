//! Primitives of triangles, joined and welded.

use std::collections::HashMap;

use glam::{DMat3, DMat4, DVec2, DVec3};
use gltf_json::accessor::{ComponentType, Type};
use gltf_json::mesh::{Primitive, Semantic};
use gltf_json::validation::Checked;
use gltf_json::{Accessor, Index, Root};

use super::container::{Container, Items};
use super::{FORMAT, Layout, malformed};
use crate::file_format::ReadError;
use crate::file_format::pace::Pace;
use crate::mesh::{FaceNames, Mesh, NamedBy};

/// Where a primitive of triangles keeps its data.
pub(super) struct Attributes {
    layout: Layout,
    indices: Option<Index<Accessor>>,
    positions: Index<Accessor>,
    normals: Option<Index<Accessor>>,
    uvs: Option<Index<Accessor>>,
    /// Name of the material; empty where there is none.
    material: String,
}

impl Attributes {
    /// The attributes of a primitive, or `None` where it is made of points or lines.
    pub(super) fn of(root: &Root, primitive: &Primitive, place: &str) -> Result<Option<Self>, ReadError> {
        let Checked::Valid(mode) = primitive.mode else {
            return Err(malformed(place, "its mode is none that glTF knows"));
        };
        let Some(layout) = Layout::of(mode) else { return Ok(None) };
        let attribute = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
        let positions =
            attribute(Semantic::Positions).ok_or_else(|| malformed(place, "it has no POSITION attribute"))?;
        let material = primitive.material.map_or_else(String::new, |index| {
            let name = root.materials.get(index.value()).and_then(|material| material.name.clone());
            name.filter(|name| !name.is_empty()).unwrap_or_else(|| format!("material {}", index.value()))
        });
        Ok(Some(Self {
            layout,
            indices: primitive.indices,
            positions,
            normals: attribute(Semantic::Normals),
            uvs: attribute(Semantic::TexCoords(0)),
            material,
        }))
    }

    fn indices<'c>(&self, container: &'c Container, place: &str) -> Result<Option<Items<'c>>, ReadError> {
        const KINDS: [ComponentType; 3] = [ComponentType::U8, ComponentType::U16, ComponentType::U32];
        self.indices.map(|index| container.items(index, Type::Scalar, &KINDS, place)).transpose()
    }

    fn positions<'c>(&self, container: &'c Container, place: &str) -> Result<Items<'c>, ReadError> {
        container.items(self.positions, Type::Vec3, &[ComponentType::F32], place)
    }

    fn triangle_count(&self, indices: usize, place: &str) -> Result<usize, ReadError> {
        self.layout
            .triangle_count(indices)
            .ok_or_else(|| malformed(place, format!("{indices} indices do not make whole triangles")))
    }

    /// Indices and positions of the primitive.
    pub(super) fn entry_count(&self, container: &Container, place: &str) -> Result<usize, ReadError> {
        let positions = self.positions(container, place)?.count;
        let indices = self.indices(container, place)?.map_or(positions, |indices| indices.count);
        Ok(self.triangle_count(indices, place)?.saturating_mul(3).saturating_add(positions))
    }
}

/// Triangles of one node, in the world.
pub(super) struct TriangleSoup {
    world: DMat4,
    /// Takes normals along; of any length.
    cofactor: DMat3,
    mirrored: bool,
    known: HashMap<[u32; 3], u32>,
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// One entry a corner; `None` once a primitive has none.
    normals: Option<Vec<DVec3>>,
    uvs: Option<Vec<DVec2>>,
    /// The name of each primitive's material, and behind which triangle it ends.
    materials: Vec<(String, usize)>,
}

impl TriangleSoup {
    pub(super) fn new(world: DMat4) -> Self {
        let linear = DMat3::from_mat4(world);
        // The cofactor matrix is the inverse transposed, times the determinant, and also there where a node flattens.
        let cofactor = DMat3::from_cols(
            linear.y_axis.cross(linear.z_axis),
            linear.z_axis.cross(linear.x_axis),
            linear.x_axis.cross(linear.y_axis),
        );
        let mirrored = linear.determinant() < 0.0;
        Self {
            world,
            cofactor: if mirrored { cofactor * -1.0 } else { cofactor },
            mirrored,
            known: HashMap::new(),
            positions: Vec::new(),
            triangles: Vec::new(),
            normals: Some(Vec::new()),
            uvs: Some(Vec::new()),
            materials: Vec::new(),
        }
    }

    /// Adds the triangles of a primitive to those read before, and gives the number of all. `name` is the mesh's and
    /// `place` the primitive's, for messages.
    pub(super) fn add(
        &mut self,
        container: &Container,
        attributes: &Attributes,
        (name, place): (&str, &str),
        before: usize,
        pace: &mut Pace<'_>,
    ) -> Result<usize, ReadError> {
        let positions = attributes.positions(container, place)?;
        let indices = attributes.indices(container, place)?;
        let count = attributes.triangle_count(indices.as_ref().map_or(positions.count, |i| i.count), place)?;
        let normals = match attributes.normals {
            Some(index) if self.normals.is_some() => {
                Some(container.items(index, Type::Vec3, &[ComponentType::F32], place)?)
            }
            _ => None,
        };
        let uvs = match attributes.uvs {
            Some(index) if self.uvs.is_some() => {
                let kinds = [ComponentType::F32, ComponentType::U8, ComponentType::U16];
                Some(container.items(index, Type::Vec2, &kinds, place)?)
            }
            _ => None,
        };
        for (what, other) in [("NORMAL", &normals), ("TEXCOORD_0", &uvs)] {
            if let Some(other) = other
                && other.count < positions.count
            {
                let problem = format!("{} entries of {what} for {} positions", other.count, positions.count);
                return Err(malformed(place, problem));
            }
        }
        if normals.is_none() {
            self.normals = None;
        }
        if uvs.is_none() {
            self.uvs = None;
        }

        for t in 0..count {
            pace.at(before + t)?;
            let mut corners = attributes.layout.triangle(t).map(|at| match &indices {
                Some(indices) => indices.index(at) as usize,
                None => at,
            });
            if let Some(index) = corners.iter().find(|index| **index >= positions.count) {
                let problem = format!("triangle {t} uses vertex {index}, but there are only {}", positions.count);
                return Err(malformed(place, problem));
            }
            if self.mirrored {
                corners.swap(1, 2);
            }
            let mut points = [[0.0; 3]; 3];
            for (point, corner) in points.iter_mut().zip(corners) {
                // Adding zero makes the negative zero positive, so that both weld.
                *point = positions.numbers::<3>(corner).map(|x| x + 0.0);
                if point.iter().any(|x| !x.is_finite()) {
                    return Err(not_finite(name, "vertex", corner));
                }
            }
            if points[0] == points[1] || points[1] == points[2] || points[2] == points[0] {
                continue;
            }
            let [a, b, c] = points.map(|point| self.vertex(point));
            self.triangles.push([a, b, c]);
            if let (Some(sum), Some(normals)) = (&mut self.normals, &normals) {
                let edge = |to: u32| self.positions[to as usize] - self.positions[a as usize];
                let own = edge(b).cross(edge(c));
                for corner in corners {
                    let given = self.cofactor * DVec3::from(normals.numbers::<3>(corner).map(f64::from));
                    sum.push(given.try_normalize().or_else(|| own.try_normalize()).unwrap_or(DVec3::Y));
                }
            }
            if let (Some(sum), Some(uvs)) = (&mut self.uvs, &uvs) {
                for corner in corners {
                    let [u, v] = uvs.numbers::<2>(corner).map(f64::from);
                    if !(u.is_finite() && v.is_finite()) {
                        return Err(not_finite(name, "UV", corner));
                    }
                    sum.push(DVec2::new(u, 1.0 - v));
                }
            }
        }
        self.materials.push((attributes.material.clone(), self.triangles.len()));
        Ok(before + count)
    }

    /// The shared vertex at a position.
    fn vertex(&mut self, position: [f32; 3]) -> u32 {
        // No more vertices than corners, and those are limited.
        let next = self.positions.len() as u32;
        *self.known.entry(position.map(f32::to_bits)).or_insert_with(|| {
            self.positions.push(self.world.transform_point3(DVec3::from(position.map(f64::from))));
            next
        })
    }

    /// The mesh, or `None` where no triangle is left.
    pub(super) fn into_mesh(self, name: &str) -> Result<Option<Mesh>, ReadError> {
        if self.triangles.is_empty() {
            return Ok(None);
        }
        let failed = |source| ReadError::Mesh { name: name.to_owned(), source };
        let mut mesh = Mesh::new(self.positions, self.triangles).map_err(failed)?.named(name);
        if let Some(normals) = self.normals {
            mesh = mesh.with_normals(normals).map_err(failed)?;
        }
        if let Some(uvs) = self.uvs {
            mesh = mesh.with_uvs(uvs).map_err(failed)?;
        }
        if self.materials.iter().any(|(name, _)| !name.is_empty()) {
            let starts = std::iter::once(0).chain(self.materials.iter().map(|(_, end)| *end));
            let names = starts.zip(&self.materials).flat_map(|(start, (name, end))| (start..*end).map(move |_| name));
            mesh = mesh.with_names(NamedBy::Material, FaceNames::new(names)).map_err(failed)?;
        }
        Ok(Some(mesh))
    }
}

fn not_finite(name: &str, what: &'static str, index: usize) -> ReadError {
    ReadError::NotFinite { format: FORMAT, name: name.to_owned(), what, index }
}
