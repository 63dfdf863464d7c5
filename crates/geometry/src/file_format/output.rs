//! What the writers share: checks of the scene, polygons without repeated vertices, corners welded into `f32` vertices,
//! and colours.

use std::collections::HashMap;

use glam::{DVec2, DVec3};

use super::WriteError;
use crate::mesh::Mesh;
use crate::mesh::measure::polygon_normal;
use crate::scene::{MeshItem, Scene};

/// Refuses scenes without content and outputs without geometry.
pub(super) fn check(scene: &Scene) -> Result<(), WriteError> {
    if scene.meshes.is_empty() && scene.curves.is_empty() {
        return Err(WriteError::NothingToWrite);
    }
    for item in &scene.meshes {
        if (0..item.mesh.polygon_count()).all(|polygon| distinct_corners(&item.mesh, polygon).is_none()) {
            return Err(WriteError::EmptyMesh { name: mesh_name(item).to_owned() });
        }
    }
    match scene.curves.iter().find(|item| item.curves.is_empty()) {
        Some(item) => Err(WriteError::NoCurves { name: item.name.clone() }),
        None => Ok(()),
    }
}

/// The output's name, or the mesh's own where the output has none.
pub(super) fn mesh_name(item: &MeshItem) -> &str {
    if item.name.is_empty() { item.mesh.name() } else { &item.name }
}

/// Corner indices of a polygon without those that repeat the vertex of the corner before, as they stand at poles; `None`
/// where fewer than three are left.
pub(super) fn distinct_corners(mesh: &Mesh, polygon: usize) -> Option<Vec<usize>> {
    let range = mesh.corner_range(polygon);
    let corners = mesh.corners();
    let before = |corner: usize| if corner == range.start { range.end - 1 } else { corner - 1 };
    let kept: Vec<usize> = range.clone().filter(|&c| corners[c] != corners[before(c)]).collect();
    (kept.len() >= 3).then_some(kept)
}

/// Welds the corners of a mesh that agree in vertex, normal and UV, all as the `f32` they are written as. Vertices are
/// numbered in the order in which their first corner is asked for, so that the result is the same on every run.
pub(super) struct CornerWeld<'a> {
    item: &'a MeshItem,
    /// Whether normals are written: those of the mesh, or the polygons' own where it has none.
    with_normals: bool,
    flip_v: bool,
    /// The polygon of each corner.
    polygons: Vec<u32>,
    known: HashMap<(u32, [u32; 3], [u32; 2]), u32>,
    pub(super) positions: Vec<[f32; 3]>,
    pub(super) normals: Vec<[f32; 3]>,
    pub(super) uvs: Vec<[f32; 2]>,
}

impl<'a> CornerWeld<'a> {
    /// Welds with normals where `with_normals` (polygons lend theirs to a mesh that has none); `flip_v` makes v run
    /// downward.
    pub(super) fn new(item: &'a MeshItem, with_normals: bool, flip_v: bool) -> Self {
        let mut polygons = Vec::with_capacity(item.mesh.corners().len());
        for polygon in 0..item.mesh.polygon_count() {
            polygons.resize(item.mesh.corner_range(polygon).end, polygon as u32);
        }
        Self {
            item,
            with_normals,
            flip_v,
            polygons,
            known: HashMap::new(),
            positions: Vec::new(),
            normals: Vec::new(),
            uvs: Vec::new(),
        }
    }

    /// The vertex of a corner of the mesh.
    pub(super) fn vertex(&mut self, corner: usize) -> Result<u32, WriteError> {
        let mesh = &self.item.mesh;
        let source = mesh.corners()[corner];
        let out_of_range = |what, index| WriteError::OutOfRange { name: mesh_name(self.item).to_owned(), what, index };
        let normal = if self.with_normals { self.normal(corner) } else { [0.0; 3] };
        let uv = match mesh.uvs() {
            Some(uvs) => {
                let DVec2 { x: u, y: v } = uvs[corner];
                single([u, if self.flip_v { 1.0 - v } else { v }])
                    .ok_or_else(|| out_of_range("UV of corner", corner))?
            }
            None => [0.0; 2],
        };
        let key = (source, normal.map(f32::to_bits), uv.map(f32::to_bits));
        if let Some(&vertex) = self.known.get(&key) {
            return Ok(vertex);
        }
        let position = single(mesh.positions()[source as usize].to_array())
            .ok_or_else(|| out_of_range("vertex", source as usize))?;
        // No more vertices than corners, and those are counted in 32 bits.
        let vertex = self.positions.len() as u32;
        self.known.insert(key, vertex);
        self.positions.push(position);
        if self.with_normals {
            self.normals.push(normal);
        }
        if mesh.uvs().is_some() {
            self.uvs.push(uv);
        }
        Ok(vertex)
    }

    fn normal(&self, corner: usize) -> [f32; 3] {
        let mesh = &self.item.mesh;
        let given = mesh.normals().map_or(DVec3::ZERO, |normals| normals[corner]);
        let unit = given
            .try_normalize()
            .or_else(|| polygon_normal(mesh, self.polygons[corner] as usize).try_normalize())
            .unwrap_or(DVec3::Y);
        // Rounding to f32 shortens or lengthens by up to 1e-7; a second pass in f32 leaves the last bit alone.
        let rounded = unit.as_vec3().normalize_or(glam::Vec3::Y);
        (rounded + glam::Vec3::ZERO).to_array()
    }
}

/// The numbers as `f32`, or `None` where one does not fit. Negative zero becomes zero, so that both weld.
pub(super) fn single<const N: usize>(numbers: [f64; N]) -> Option<[f32; N]> {
    let rounded = numbers.map(|x| x as f32 + 0.0);
    rounded.iter().all(|x| x.is_finite()).then_some(rounded)
}

/// Linear light from an sRGB channel (IEC 61966-2-1); what lies outside 0 to 1 is brought back first.
pub(super) fn linear_from_srgb(encoded: f64) -> f64 {
    let encoded = encoded.clamp(0.0, 1.0);
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// The colour with each channel in 0 to 1.
pub(super) fn checked_colour(name: &str, colour: [f64; 4]) -> Result<[f64; 4], WriteError> {
    if colour.iter().any(|c| !c.is_finite()) {
        return Err(WriteError::Material { name: name.to_owned(), what: "colour" });
    }
    Ok(colour.map(|c| c.clamp(0.0, 1.0)))
}

/// The number in 0 to 1.
pub(super) fn checked_factor(name: &str, what: &'static str, factor: f64) -> Result<f64, WriteError> {
    if factor.is_finite() {
        Ok(factor.clamp(0.0, 1.0))
    } else {
        Err(WriteError::Material { name: name.to_owned(), what })
    }
}

/// Names that differ: the second `clay` becomes `clay-2`, in the order they come.
pub(super) fn unique_names<'a>(names: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    let mut taken = std::collections::HashSet::new();
    let mut unique = Vec::new();
    let mut next = HashMap::new();
    for name in names {
        let mut candidate = name.to_owned();
        while !taken.insert(candidate.clone()) {
            let number = next.entry(name).or_insert(1_usize);
            *number += 1;
            candidate = format!("{name}-{number}");
        }
        unique.push(candidate);
    }
    unique
}
