//! What a picture shows: the scene's triangles with normals, and their size.

use std::borrow::Cow;

use glam::{DVec3, Vec3};
use maquette_geometry::mesh::measure::vector_area;
use maquette_geometry::mesh::{Mesh, triangles};
use maquette_geometry::scene::{MeshItem, Scene};

use super::camera::Bounds;
use super::shading::Surface;

/// Polygons that meet at more than this angle keep a hard edge where a mesh brings no normals, degrees.
const CREASE_DEGREES: f64 = 45.0;

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
        let normals = mesh.normals().map_or_else(|| Cow::Owned(creased_normals(mesh)), Cow::Borrowed);
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

/// Normals at the corners: the mean, weighted by angle, of the polygons around the vertex that meet the corner's own
/// polygon at less than [`CREASE_DEGREES`].
fn creased_normals(mesh: &Mesh) -> Vec<DVec3> {
    let points: Vec<DVec3> = mesh.corners().iter().map(|v| mesh.positions()[*v as usize]).collect();
    let mut owner = vec![DVec3::ZERO; points.len()];
    let mut weighted = vec![DVec3::ZERO; points.len()];
    for polygon in 0..mesh.polygon_count() {
        let range = mesh.corner_range(polygon);
        let normal = vector_area(points[range.clone()].iter().copied()).normalize_or_zero();
        for corner in range.clone() {
            let next = if corner + 1 == range.end { range.start } else { corner + 1 };
            let previous = if corner == range.start { range.end - 1 } else { corner - 1 };
            let (a, b) = (points[next] - points[corner], points[previous] - points[corner]);
            owner[corner] = normal;
            weighted[corner] = normal * a.cross(b).length().atan2(a.dot(b));
        }
    }
    // Corners sorted by vertex: those of one vertex stand together.
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by_key(|corner| mesh.corners()[*corner]);
    let least = CREASE_DEGREES.to_radians().cos();
    let mut normals = owner.clone();
    for around in order.chunk_by(|a, b| mesh.corners()[*a] == mesh.corners()[*b]) {
        // At the centre of a great fan every pair would be compared; its normals are as good from all of them at once.
        let all: Option<DVec3> = (around.len() > 256).then(|| around.iter().map(|c| weighted[*c]).sum());
        for &corner in around {
            let sum = all.unwrap_or_else(|| {
                around.iter().filter(|c| owner[**c].dot(owner[corner]) >= least).map(|c| weighted[*c]).sum()
            });
            normals[corner] = sum.normalize_or(owner[corner]);
        }
    }
    normals
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cube_keeps_its_edges_and_a_gentle_fold_is_smooth() {
        let corner = |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2));
        let cube = Mesh::new(
            (0..8).map(corner).collect(),
            [[0u32, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]],
        )
        .unwrap();
        for (normal, expected) in creased_normals(&cube).chunks(4).zip([
            DVec3::NEG_Z,
            DVec3::Z,
            DVec3::NEG_Y,
            DVec3::Y,
            DVec3::NEG_X,
            DVec3::X,
        ]) {
            assert!(normal.iter().all(|n| n.distance(expected) < 1e-12), "{normal:?}");
        }

        let fold = Mesh::new(
            vec![
                DVec3::new(-1.0, -0.2, 0.0),
                DVec3::new(0.0, 0.0, 0.0),
                DVec3::new(0.0, 0.0, -1.0),
                DVec3::new(-1.0, -0.2, -1.0),
                DVec3::new(1.0, -0.2, 0.0),
                DVec3::new(1.0, -0.2, -1.0),
            ],
            [[0u32, 1, 2, 3], [1, 4, 5, 2]],
        )
        .unwrap();
        let normals = creased_normals(&fold);
        assert!(normals[1].distance(DVec3::Y) < 1e-12 && normals[4].distance(DVec3::Y) < 1e-12, "{normals:?}");
        assert!(normals[0].x < -0.1);
    }
}
