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
