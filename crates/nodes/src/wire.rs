//! The types that travel along wires.

mod analytic;
mod border;
mod handles;
mod selection;
mod shape;

pub use analytic::{CrossSections, EllipticSections, NamedSection, SectionFit, Surface};
pub use border::Borders;
pub use handles::{Bound, Handle, Handles, Held, HeldSelection};
pub use selection::Selection;
pub use shape::Shape;

use std::sync::Arc;

use glam::DVec3;
use maquette_geometry::{curve, mesh, scene, sections};
use maquette_graph::{ContentHash, ContentHasher, Wire};

/// One curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve(pub curve::Curve);

/// A list of curves in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curves(pub Vec<curve::Curve>);

/// A stack of cross-sections with corresponding points.
#[derive(Clone, Debug, PartialEq)]
pub struct Sections(pub sections::Sections);

/// A polygon mesh. Shared, because meshes are large and are handed on unchanged.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh(pub Arc<mesh::Mesh>);

impl Mesh {
    /// Wraps a mesh.
    pub fn new(mesh: mesh::Mesh) -> Self {
        Self(Arc::new(mesh))
    }
}

/// A mesh with its material, ready to be written.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshResult {
    /// The mesh.
    pub mesh: Arc<mesh::Mesh>,
    /// Hash of the mesh as it arrived, which need not be computed again.
    pub mesh_hash: ContentHash,
    /// How it looks; its name is filled in by who writes the file.
    pub material: scene::Material,
}

/// Curves with their colour, ready to be written.
#[derive(Clone, Debug, PartialEq)]
pub struct CurvesResult {
    /// The curves.
    pub curves: Vec<curve::Curve>,
    /// sRGB with alpha, each 0 to 1.
    pub colour: [f64; 4],
}

fn hash_points(hasher: &mut ContentHasher, points: &[DVec3]) {
    hasher.numbers(bytemuck::cast_slice(points));
}

fn hash_curve(hasher: &mut ContentHasher, curve: &curve::Curve) {
    hasher.text(curve.name());
    hasher.integer(u64::from(curve.is_closed()));
    hash_points(hasher, curve.points());
    match curve.pressure() {
        Some(pressure) => hasher.numbers(pressure),
        None => hasher.integer(u64::MAX),
    }
}

fn curve_bytes(curve: &curve::Curve) -> usize {
    size_of::<curve::Curve>()
        + curve.name().len()
        + size_of_val(curve.points())
        + curve.pressure().map_or(0, size_of_val)
}

fn hash_mesh(hasher: &mut ContentHasher, mesh: &mesh::Mesh) {
    hasher.text(mesh.name());
    hash_points(hasher, mesh.positions());
    hasher.indices(mesh.starts());
    hasher.indices(mesh.corners());
    match mesh.normals() {
        Some(normals) => hash_points(hasher, normals),
        None => hasher.integer(u64::MAX),
    }
    match mesh.uvs() {
        Some(uvs) => hasher.numbers(bytemuck::cast_slice(uvs)),
        None => hasher.integer(u64::MAX),
    }
    // Left out where there are none, so that such meshes keep the hashes they had before meshes had names.
    for (kind, names) in [mesh.groups(), mesh.materials()].into_iter().enumerate() {
        if let Some(names) = names {
            hasher.integer(kind as u64);
            hasher.integer(names.names().len() as u64);
            names.names().iter().for_each(|name| hasher.text(name));
            hasher.indices(names.places());
        }
    }
}

fn mesh_bytes(mesh: &mesh::Mesh) -> usize {
    size_of_val(mesh.positions())
        + size_of_val(mesh.corners())
        + 4 * mesh.polygon_count()
        + mesh.normals().map_or(0, size_of_val)
        + mesh.uvs().map_or(0, size_of_val)
        + [mesh.groups(), mesh.materials()].into_iter().flatten().map(mesh::FaceNames::byte_size).sum::<usize>()
}

fn count(number: usize, one: &str, many: &str) -> String {
    format!("{number} {}", if number == 1 { one } else { many })
}

fn curves_summary(curves: &[curve::Curve]) -> String {
    let points: usize = curves.iter().map(|c| c.points().len()).sum();
    format!("{}, {}", count(curves.len(), "curve", "curves"), count(points, "point", "points"))
}

fn mesh_summary(mesh: &mesh::Mesh) -> String {
    let vertices = count(mesh.positions().len(), "vertex", "vertices");
    format!("{vertices}, {}", count(mesh.polygon_count(), "face", "faces"))
}

impl Wire for Curve {
    const NAME: &'static str = "curve";
    const DESCRIPTION: &'static str = "One curve: a named polyline, open or closed.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        hash_curve(hasher, &self.0);
    }

    fn byte_size(&self) -> usize {
        curve_bytes(&self.0)
    }

    fn summary(&self) -> String {
        format!("\"{}\", {}", self.0.name(), count(self.0.points().len(), "point", "points"))
    }
}

impl Wire for Curves {
    const NAME: &'static str = "curves";
    const DESCRIPTION: &'static str = "A list of curves in order: sketched strokes, rails, contours.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        hasher.integer(self.0.len() as u64);
        self.0.iter().for_each(|curve| hash_curve(hasher, curve));
    }

    fn byte_size(&self) -> usize {
        self.0.iter().map(curve_bytes).sum()
    }

    fn summary(&self) -> String {
        curves_summary(&self.0)
    }
}

impl Wire for Sections {
    const NAME: &'static str = "sections";
    const DESCRIPTION: &'static str =
        "A stack of cross-sections with corresponding points: what a surface is skinned through.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        hasher.integer(self.0.nodes() as u64);
        hasher.integer(u64::from(self.0.is_closed()));
        hasher.integer(self.0.rails().len() as u64);
        self.0.rails().iter().for_each(|rail| hasher.integer(*rail as u64));
        hash_points(hasher, self.0.points());
    }

    fn byte_size(&self) -> usize {
        size_of_val(self.0.points()) + size_of_val(self.0.rails())
    }

    fn summary(&self) -> String {
        format!("{}, {} points each", count(self.0.len(), "section", "sections"), self.0.nodes())
    }
}

impl Wire for Mesh {
    const NAME: &'static str = "mesh";
    const DESCRIPTION: &'static str =
        "A polygon mesh with normals and UVs at its corners, and names of groups and materials at its polygons.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        hash_mesh(hasher, &self.0);
    }

    fn byte_size(&self) -> usize {
        mesh_bytes(&self.0)
    }

    fn summary(&self) -> String {
        mesh_summary(&self.0)
    }
}

impl Wire for MeshResult {
    const NAME: &'static str = "mesh-result";
    const DESCRIPTION: &'static str = "A mesh with its material, ready to be written.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        hasher.hash(self.mesh_hash);
        hasher.text(&self.material.name);
        hasher.numbers(&self.material.colour);
        hasher.numbers(&[self.material.metallic, self.material.roughness]);
        hasher.integer(u64::from(self.material.double_sided));
    }

    fn byte_size(&self) -> usize {
        mesh_bytes(&self.mesh)
    }

    fn summary(&self) -> String {
        mesh_summary(&self.mesh)
    }
}

impl Wire for CurvesResult {
    const NAME: &'static str = "curves-result";
    const DESCRIPTION: &'static str = "Curves with their colour, ready to be written.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        hasher.integer(self.curves.len() as u64);
        self.curves.iter().for_each(|curve| hash_curve(hasher, curve));
        hasher.numbers(&self.colour);
    }

    fn byte_size(&self) -> usize {
        self.curves.iter().map(curve_bytes).sum()
    }

    fn summary(&self) -> String {
        curves_summary(&self.curves)
    }
}
