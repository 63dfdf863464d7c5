//! What is under the pointer: lines first, because one has to aim at them, then the nearest surface.

use glam::{DVec3, Vec3};
use maquette_graph::NodeId;

use crate::drawable::{Shown, Surface};

use super::camera::{Camera, ViewSize};

/// Distance from a line within which a click means it, points.
pub(crate) const LINE_REACH: f32 = 6.0;

/// How far behind a surface a line still counts as lying on it, as a share of its distance from the eye.
const BEHIND: f64 = 0.01;

/// The node that made what is seen at a point of the view.
pub(crate) fn pick(shown: &[Shown], camera: &Camera, size: ViewSize, at: egui::Vec2) -> Option<NodeId> {
    line(shown, camera, size, at).or_else(|| surface(shown, camera.ray(size, at)).map(|(_, node)| node))
}

/// What surfaces leave to be seen at a point of the view.
pub(crate) struct Visible {
    origin: DVec3,
    along: DVec3,
    /// As far as one sees, metres along the ray, with what counts as lying on a surface.
    until: f64,
}

impl Visible {
    pub(crate) fn new(shown: &[Shown], camera: &Camera, size: ViewSize, at: egui::Vec2) -> Self {
        let (origin, along) = camera.ray(size, at);
        let until = surface(shown, (origin, along)).map_or(f64::INFINITY, |(distance, _)| distance);
        Self { origin, along, until: until + BEHIND * camera.distance }
    }

    /// Whether no surface hides a point near the ray.
    pub(crate) fn shows(&self, place: DVec3) -> bool {
        (place - self.origin).dot(self.along) <= self.until
    }
}

/// Distance of a point of the view from a line in space, points, and where on the line that is; `None` where the line is not
/// seen.
pub(crate) fn near_line(
    points: impl Iterator<Item = DVec3>,
    camera: &Camera,
    size: ViewSize,
    at: egui::Vec2,
) -> Option<(f32, DVec3)> {
    let mut least: Option<(f32, DVec3)> = None;
    let mut before: Option<(egui::Vec2, DVec3)> = None;
    for point in points {
        let seen = camera.project(size, point).map(|seen| (seen, point));
        if let Some((seen, point)) = seen {
            let (from, start) = before.unwrap_or((seen, point));
            let (distance, share) = near_segment(at, from, seen);
            if least.is_none_or(|(least, _)| distance < least) {
                least = Some((distance, start.lerp(point, f64::from(share))));
            }
        }
        before = seen;
    }
    least
}

/// Distance of a point of the screen from a segment, points, and how far along the segment that is, from 0 to 1.
pub(crate) fn near_segment(at: egui::Vec2, from: egui::Vec2, to: egui::Vec2) -> (f32, f32) {
    let along = to - from;
    let length = along.length_sq();
    let share = if length > 0.0 { ((at - from).dot(along) / length).clamp(0.0, 1.0) } else { 0.0 };
    ((from + along * share - at).length(), share)
}

fn line(shown: &[Shown], camera: &Camera, size: ViewSize, at: egui::Vec2) -> Option<NodeId> {
    let visible = Visible::new(shown, camera, size, at);
    let mut best: Option<(f32, NodeId)> = None;
    for item in shown {
        for line in item.drawables.iter().flat_map(|drawable| &drawable.lines) {
            let joint = line.points.first().filter(|_| line.closed);
            let points = line.points.iter().chain(joint).map(|p| p.as_dvec3());
            if let Some((distance, place)) = near_line(points, camera, size, at)
                && distance <= LINE_REACH
                && visible.shows(place)
                && best.is_none_or(|(least, _)| distance < least)
            {
                best = Some((distance, item.node));
            }
        }
    }
    best.map(|(_, node)| node)
}

/// The first surface that a ray meets: how far away, and the node that made it.
fn surface(shown: &[Shown], (origin, along): (DVec3, DVec3)) -> Option<(f64, NodeId)> {
    let mut best: Option<(f64, NodeId)> = None;
    for item in shown {
        for surface in item.drawables.iter().filter_map(|drawable| drawable.surface.as_ref()) {
            if let Some(distance) = first_hit(surface, origin, along)
                && best.is_none_or(|(least, _)| distance < least)
            {
                best = Some((distance, item.node));
            }
        }
    }
    best
}

/// Distance along a ray to the first triangle it meets (T. Moeller, B. Trumbore 1997, "Fast, minimum storage ray/triangle
/// intersection"), metres.
fn first_hit(surface: &Surface, origin: DVec3, along: DVec3) -> Option<f64> {
    let at = |index: u32| Vec3::from_array(surface.vertices[index as usize].position).as_dvec3();
    let hits = surface.triangles.iter().filter_map(|triangle| {
        let [a, b, c] = triangle.map(at);
        let (ab, ac) = (b - a, c - a);
        let across = along.cross(ac);
        let volume = ab.dot(across);
        if volume == 0.0 {
            return None;
        }
        let from = origin - a;
        let u = from.dot(across) / volume;
        let q = from.cross(ab);
        let v = along.dot(q) / volume;
        let distance = ac.dot(q) / volume;
        (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0).then_some(distance)
    });
    hits.reduce(f64::min)
}
