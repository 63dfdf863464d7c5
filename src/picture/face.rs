//! Triangles as they lie on the picture: projected, and clipped at the near plane.

use glam::{DVec2, DVec3, Vec3};
use rayon::prelude::*;

use super::camera::{Camera, Projected};
use super::subject::{Model, Subject};

/// Pixels are divided this finely, so that the half-plane tests of [`super::rasterizer`] are exact in `f64`: products of
/// two such coordinates up to 16 384 take fewer than 53 bits.
const SUBPIXELS: f64 = 1024.0;

/// A triangle on the picture, its corners in the order that makes its area positive with y downwards.
#[derive(Clone, Debug)]
pub(super) struct Face {
    /// Corners in pixels, multiples of 1/1024.
    pub pixel: [DVec2; 3],
    /// Depth at the corners; see [`Projected::depth`].
    pub depth: [f64; 3],
    /// Depth at any pixel is the scalar product of this with (x, y, 1).
    pub plane: DVec3,
    /// Twice the area in square pixels.
    pub area: f64,
    /// Corners in subject units.
    pub place: [Vec3; 3],
    /// Unit normals at the corners, on the polygon's outside.
    pub normal: [Vec3; 3],
    /// Index of the model.
    pub model: u32,
    /// Whether it is seen from inside.
    pub back: bool,
}

/// A corner in the camera's frame.
#[derive(Clone, Copy)]
struct Corner {
    view: DVec3,
    place: Vec3,
    normal: Vec3,
}

/// All triangles of the subject that come onto the picture, in the subject's order.
pub(super) fn faces(subject: &Subject, camera: &Camera) -> Vec<Face> {
    let mut faces = Vec::new();
    for (index, model) in subject.models.iter().enumerate() {
        let found: Vec<Vec<Face>> = model
            .triangles
            .par_chunks(4096)
            .map(|chunk| {
                let mut found = Vec::with_capacity(chunk.len());
                for triangle in chunk {
                    add(&mut found, index as u32, corners(subject, camera, model, *triangle), camera);
                }
                found
            })
            .collect();
        faces.extend(found.into_iter().flatten());
    }
    faces
}

fn corners(subject: &Subject, camera: &Camera, model: &Model, triangle: [usize; 3]) -> [Corner; 3] {
    let points = triangle.map(|corner| model.mesh.positions()[model.mesh.corners()[corner] as usize]);
    let flat = (points[1] - points[0]).cross(points[2] - points[0]).normalize_or(camera.back);
    [0, 1, 2].map(|k| Corner {
        view: camera.to_view(points[k]),
        place: subject.place(points[k]),
        normal: model.normals[triangle[k]].normalize_or(flat).as_vec3(),
    })
}

fn add(faces: &mut Vec<Face>, model: u32, corners: [Corner; 3], camera: &Camera) {
    let clearance = corners.map(|c| camera.clearance(c.view));
    if clearance.iter().all(|c| *c >= 0.0) {
        faces.extend(face(model, corners, camera));
        return;
    }
    // What is left of a triangle on one side of a plane has at most four corners.
    let mut kept: Vec<Corner> = Vec::with_capacity(4);
    for k in 0..3 {
        let next = (k + 1) % 3;
        if clearance[k] >= 0.0 {
            kept.push(corners[k]);
        }
        if (clearance[k] >= 0.0) != (clearance[next] >= 0.0) {
            kept.push(between(&corners[k], &corners[next], clearance[k] / (clearance[k] - clearance[next])));
        }
    }
    for k in 2..kept.len() {
        faces.extend(face(model, [kept[0], kept[k - 1], kept[k]], camera));
    }
}

fn between(a: &Corner, b: &Corner, t: f64) -> Corner {
    Corner {
        view: a.view.lerp(b.view, t),
        place: a.place.lerp(b.place, t as f32),
        normal: a.normal.lerp(b.normal, t as f32),
    }
}

fn face(model: u32, mut corners: [Corner; 3], camera: &Camera) -> Option<Face> {
    let mut projected: [Projected; 3] = corners.map(|c| camera.project(c.view));
    for point in &mut projected {
        point.pixel = (point.pixel * SUBPIXELS).round() / SUBPIXELS;
    }
    let area_of = |p: &[Projected; 3]| (p[1].pixel - p[0].pixel).perp_dot(p[2].pixel - p[0].pixel);
    // Counter-clockwise in space is clockwise where y runs downwards.
    let back = area_of(&projected) > 0.0;
    if !back {
        corners.swap(1, 2);
        projected.swap(1, 2);
    }
    let area = area_of(&projected);
    if area.is_nan() || area <= 0.0 {
        return None;
    }
    let pixel = projected.map(|p| p.pixel);
    let depth = projected.map(|p| p.depth);
    let (ab, ac) = (pixel[1] - pixel[0], pixel[2] - pixel[0]);
    let (db, dc) = (depth[1] - depth[0], depth[2] - depth[0]);
    let across = (db * ac.y - dc * ab.y) / area;
    let down = (dc * ab.x - db * ac.x) / area;
    let plane = DVec3::new(across, down, depth[0] - across * pixel[0].x - down * pixel[0].y);
    Some(Face {
        pixel,
        depth,
        plane,
        area,
        place: corners.map(|c| c.place),
        normal: corners.map(|c| c.normal),
        model,
        back,
    })
}

impl Face {
    /// Weights of the corners at a pixel; they sum to one.
    pub fn weights(&self, at: DVec2) -> [f64; 3] {
        let [a, b, c] = self.pixel;
        let of_a = (c - b).perp_dot(at - b) / self.area;
        let of_b = (a - c).perp_dot(at - c) / self.area;
        [of_a, of_b, 1.0 - of_a - of_b]
    }

    /// Depth of the triangle's plane at a pixel.
    pub fn depth_at(&self, at: DVec2) -> f64 {
        self.plane.x * at.x + self.plane.y * at.y + self.plane.z
    }

    /// Lowest and highest pixel coordinates.
    pub fn bounds(&self) -> [DVec2; 2] {
        let [a, b, c] = self.pixel;
        [a.min(b).min(c), a.max(b).max(c)]
    }
}

/// Weighted sum of a value at the corners.
pub(super) fn blend(values: &[Vec3; 3], weights: [f64; 3]) -> Vec3 {
    values[0] * weights[0] as f32 + values[1] * weights[1] as f32 + values[2] * weights[2] as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::camera::View;
    use crate::picture::subject::points;
    use maquette_geometry::mesh::Mesh;
    use maquette_geometry::scene::{Material, MeshItem, Scene};

    const SIZE: DVec2 = DVec2::new(200.0, 150.0);

    /// A square floor, 2 m wide.
    fn floor() -> Scene {
        let corners = [[-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0], [-1.0, 0.0, -1.0]];
        let mesh = Mesh::new(corners.map(DVec3::from).to_vec(), [[0u32, 1, 2, 3]]).unwrap();
        Scene { meshes: vec![MeshItem { name: "floor".into(), mesh, material: Material::default() }], curves: vec![] }
    }

    fn camera(subject: &Subject, scene: &Scene) -> Camera {
        Camera::framing(View::ThreeQuarter, points(scene, true), &subject.bounds, SIZE)
    }

    /// Where the sight line through a pixel meets y = 0.
    fn on_floor(camera: &Camera, at: DVec2) -> DVec3 {
        let (start, direction) = camera.ray(at);
        start - direction * (start.y / direction.y)
    }

    #[test]
    fn interpolation_is_correct_in_perspective() {
        let scene = floor();
        let subject = Subject::new(&scene, true).unwrap();
        let camera = camera(&subject, &scene);
        let faces = faces(&subject, &camera);
        assert_eq!(faces.len(), 2);
        for face in &faces {
            assert!(!face.back);
            let at = (face.pixel[0] + face.pixel[1] * 2.0 + face.pixel[2] * 3.0) / 6.0;
            let place = blend(&face.place, camera.in_space(face.weights(at), face.depth));
            let expected = subject.place(on_floor(&camera, at));
            assert!(place.distance(expected) < 1e-3, "{place} {expected}");
            // The mean without perspective is far off: the test would see the difference.
            assert!(blend(&face.place, face.weights(at)).distance(expected) > 5e-3);
            let view = camera.to_view(on_floor(&camera, at));
            assert!((face.depth_at(at) / camera.project(view).depth - 1.0).abs() < 1e-4);
        }
    }

    #[test]
    fn what_lies_behind_the_near_plane_is_cut_off() {
        let scene = floor();
        let subject = Subject::new(&scene, true).unwrap();
        let camera = camera(&subject, &scene);
        let down = DVec3::NEG_Y * (camera.ray(SIZE * 0.5).0.y - 0.1);
        let ahead =
            camera.back.reject_from(DVec3::Y).normalize() * -(camera.ray(SIZE * 0.5).0.reject_from(DVec3::Y).length());
        let inside = camera.moved(down + ahead);
        let faces = faces(&subject, &inside);
        assert!(!faces.is_empty());
        for face in &faces {
            assert!(face.area > 0.0 && !face.back);
            let reach = subject.bounds.radius;
            for k in 0..3 {
                assert!(face.depth[k] > 0.0 && face.depth[k] <= 1.001 / (reach * 1e-3));
                // Still on the floor, and within it.
                let world = face.place[k].as_dvec3() * reach + subject.bounds.centre;
                assert!(world.y.abs() < 1e-6 && world.abs().max_element() < 1.0 + 1e-6, "{world}");
            }
        }
        // Sample a pixel below the horizon: what is seen there is the floor just ahead.
        let at = SIZE * DVec2::new(0.5, 0.9);
        let seen = faces.iter().find(|f| f.weights(at).iter().all(|w| *w >= 0.0)).unwrap();
        let place = blend(&seen.place, inside.in_space(seen.weights(at), seen.depth));
        assert!(place.distance(subject.place(on_floor(&inside, at))) < 1e-3);
    }

    #[test]
    fn seen_from_below_it_is_a_back_face() {
        let scene = floor();
        let subject = Subject::new(&scene, true).unwrap();
        let camera = camera(&subject, &scene);
        let below = camera.clone().moved(DVec3::NEG_Y * 2.0 * camera.ray(SIZE * 0.5).0.y);
        assert!(faces(&subject, &below).iter().all(|face| face.back && face.area > 0.0));
    }
}
