//! What a picture shows: the scene's triangles with normals, and their size.

use std::borrow::Cow;

use glam::{DVec3, Vec3};
use maquette_geometry::mesh::crease::{CREASE_DEGREES, creased_normals};
use maquette_geometry::mesh::{Mesh, triangles};
use maquette_geometry::scene::{MeshItem, Scene};

use super::camera::Bounds;
use super::shading::Surface;

/// Opacity from which on a surface casts a shadow.
const SHADOW_OPACITY: f64 = 0.75;

/// The scene, made ready. *Subject units* are centred on the bounds, with their radius as 1.
pub(super) struct Subject<'a> {
    /// Bounds of all that is drawn.
    pub bounds: Bounds,
    /// One for each mesh of the scene.
    pub models: Vec<Model<'a>>,
    /// All vertices, in subject units.
    pub places: Vec<Vec3>,
    /// Lowest and highest coordinates of `places`.
    pub extents: [Vec3; 2],
    /// All triangles that cast a shadow, over `places`.
    pub triangles: Vec<[u32; 3]>,
}

/// A mesh, made ready.
pub(super) struct Model<'a> {
    /// The mesh.
    pub mesh: &'a Mesh,
    /// Its triangles, as corners.
    pub triangles: Vec<[usize; 3]>,
    /// A normal at each corner.
    pub normals: Cow<'a, [DVec3]>,
    /// How it looks.
    pub surface: Surface,
    /// Opacity, 0 to 1.
    pub opacity: f64,
}

impl<'a> Subject<'a> {
    /// Reads a scene; `None` where there is nothing in it to draw. Curves count for the bounds only where they are
    /// drawn.
    #[cfg(test)]
    pub fn new(scene: &'a Scene, curves: bool) -> Option<Self> {
        Bounds::of(points(scene, curves)).map(|bounds| Self::within(scene, bounds))
    }

    /// Reads a scene that lies within `bounds`.
    pub fn within(scene: &'a Scene, bounds: Bounds) -> Self {
        let models: Vec<Model> = scene.meshes.iter().map(Model::new).collect();
        let mut places = Vec::new();
        let mut shadows = Vec::new();
        for model in &models {
            // More vertices than 32-bit indices reach would not fit into memory.
            let first = places.len() as u32;
            places.extend(model.mesh.positions().iter().map(|p| ((p - bounds.centre) / bounds.radius).as_vec3()));
            if model.opacity >= SHADOW_OPACITY {
                let vertex = |corner: usize| first.wrapping_add(model.mesh.corners()[corner]);
                shadows.extend(model.triangles.iter().map(|t| t.map(vertex)));
            }
        }
        // A vertex that no polygon uses lies anywhere, and counts here alone.
        let low = places.iter().copied().reduce(Vec3::min).unwrap_or_default();
        let high = places.iter().copied().reduce(Vec3::max).unwrap_or_default();
        Self { bounds, models, places, extents: [low, high], triangles: shadows }
    }

    /// A point of the world in subject units.
    pub fn place(&self, point: DVec3) -> Vec3 {
        ((point - self.bounds.centre) / self.bounds.radius).as_vec3()
    }
}

/// All points that are drawn.
pub(super) fn points(scene: &Scene, curves: bool) -> impl Iterator<Item = DVec3> + Clone {
    let of_meshes = scene.meshes.iter().flat_map(|item| {
        let mesh = &item.mesh;
        mesh.corners().iter().map(|v| mesh.positions()[*v as usize])
    });
    let drawn = if curves { scene.curves.as_slice() } else { &[] };
    of_meshes.chain(drawn.iter().flat_map(|item| &item.curves).flat_map(|curve| curve.points()).copied())
}

impl<'a> Model<'a> {
    fn new(item: &'a MeshItem) -> Self {
        let mesh = &item.mesh;
        let normals = mesh.normals().map_or_else(|| Cow::Owned(creased_normals(mesh, CREASE_DEGREES)), Cow::Borrowed);
        let opacity = item.material.colour[3];
        Self {
            mesh,
            triangles: triangles(mesh).collect(),
            normals,
            surface: Surface::new(&item.material),
            opacity: if opacity.is_finite() { opacity.clamp(0.0, 1.0) } else { 1.0 },
        }
    }
}
