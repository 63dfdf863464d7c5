//! The polygons' edges as thin lines.

use glam::{DVec2, Vec3};
use maquette_geometry::mesh::Topology;

use super::camera::Camera;
use super::stroke::{Stroke, Strokes};
use super::subject::{Model, Subject};

/// Pixels.
const WIDTH: f64 = 1.0;
/// Opacity where polygons are large on the picture.
const OPACITY: f32 = 0.75;
/// Pixels across a polygon below which its edges fade, so that dense meshes do not turn black.
const DENSE: f64 = 7.0;
/// Share of the subject's radius that edges may lie behind a surface.
const BIAS: f64 = 0.0012;

/// Adds the edges of all models.
pub(super) fn add_edges(strokes: &mut Strokes, subject: &Subject, camera: &Camera) {
    for model in subject.models.iter().filter(|model| model.opacity > 0.0) {
        let colour = ink_for(model.surface.colour());
        strokes.begin(Stroke { colour, width: WIDTH, bias: subject.bounds.radius * BIAS, slack: 0.0, hidden: 0.0 });
        let areas = projected_areas(model, camera);
        for uses in Topology::new(model.mesh).edges() {
            let Some(first) = uses.first() else { continue };
            let ends = first.edge.map(|v| model.mesh.positions()[v as usize]);
            let [a, b] = ends.map(|p| camera.project(camera.to_view(p)).pixel);
            let area = uses.iter().filter_map(|u| areas[u.polygon as usize]).fold(0.0, f64::max);
            let across = if area > 0.0 { area / a.distance(b).max(1e-9) } else { DENSE };
            strokes.add(camera, ends, 0.0, OPACITY * (across / DENSE).clamp(0.12, 1.0) as f32);
        }
    }
}

/// Dark lines on light surfaces, light ones on dark surfaces.
fn ink_for(surface: Vec3) -> Vec3 {
    let luminance = surface.dot(Vec3::new(0.2126, 0.7152, 0.0722));
    if luminance > 0.06 { surface * 0.06 } else { Vec3::splat(0.75) }
}

/// Square pixels of each polygon; `None` where a corner cannot be projected.
fn projected_areas(model: &Model, camera: &Camera) -> Vec<Option<f64>> {
    let pixels: Vec<Option<DVec2>> = model
        .mesh
        .positions()
        .iter()
        .map(|p| {
            let view = camera.to_view(*p);
            (camera.clearance(view) >= 0.0).then(|| camera.project(view).pixel)
        })
        .collect();
    let area = |polygon: &[u32]| {
        let corner = |k: usize| pixels[polygon[k % polygon.len()] as usize];
        let origin = corner(0)?;
        let mut sum = 0.0;
        for k in 1..polygon.len() {
            sum += (corner(k)? - origin).perp_dot(corner(k + 1)? - origin);
        }
        Some(0.5 * sum.abs())
    };
    model.mesh.polygons().map(area).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ink_contrasts_with_the_surface() {
        assert!(ink_for(Vec3::splat(0.6)).max_element() < 0.1);
        assert!(ink_for(Vec3::splat(0.01)).min_element() > 0.5);
    }
}
