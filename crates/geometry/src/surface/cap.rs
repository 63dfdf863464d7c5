//! A flat lid on a loop of vertices.

use glam::{DVec2, DVec3};

use super::parts::MeshParts;
use crate::mesh::ear_clipping::ear_clip;
use crate::mesh::measure::{project, vector_area};

/// The loop encloses no area.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NoArea;

/// Closes a loop of vertices that runs counter-clockwise seen from outside.
///
/// A loop that is star-shaped about its centroid gets rings of quads that shrink towards it and a fan in the middle;
/// any other loop is cut into triangles without new vertices. All corners have the normal of the loop and their place
/// in its plane as UV, the longer side of the outline scaled to 0..1.
pub(crate) fn flat(parts: &mut MeshParts, rim: &[u32]) -> Result<(), NoArea> {
    let points: Vec<DVec3> = rim.iter().map(|v| parts.positions[*v as usize]).collect();
    let count = points.len();
    let Lid { normal, flat, rim_uv, centre } = Lid::of(&points)?;
    let Some((centroid, centre_uv)) = centre else {
        for triangle in ear_clip(&flat) {
            parts.polygon(triangle.map(|k| (rim[k], normal, rim_uv[k])));
        }
        return Ok(());
    };

    // About as many rings as keep the quads from growing long.
    let rings = (count / 12).clamp(1, 8);
    let mut outer: Vec<(u32, DVec2)> = rim.iter().copied().zip(rim_uv.iter().copied()).collect();
    for ring in 1..=rings {
        let share = ring as f64 / (rings + 1) as f64;
        let first = parts.positions.len() as u32;
        parts.positions.extend(points.iter().map(|p| p.lerp(centroid, share)));
        let inner: Vec<(u32, DVec2)> =
            (0..count).map(|i| (first + i as u32, rim_uv[i].lerp(centre_uv, share))).collect();
        for i in 0..count {
            let next = (i + 1) % count;
            parts.polygon([outer[i], outer[next], inner[next], inner[i]].map(|(v, uv)| (v, normal, uv)));
        }
        outer = inner;
    }
    let centre = parts.positions.len() as u32;
    parts.positions.push(centroid);
    for i in 0..count {
        parts.polygon([outer[i], outer[(i + 1) % count], (centre, centre_uv)].map(|(v, uv)| (v, normal, uv)));
    }
    Ok(())
}

/// What is measured of a loop to close it.
pub(crate) struct Lid {
    /// Unit normal about which it runs counter-clockwise.
    pub(crate) normal: DVec3,
    /// Its points in the plane across the normal, the first one the origin.
    pub(crate) flat: Vec<DVec2>,
    /// The same, the box around them moved to 0 and its longer side scaled to 1.
    pub(crate) rim_uv: Vec<DVec2>,
    /// The centroid of the area and its UV; none where the loop is not star-shaped about it.
    pub(crate) centre: Option<(DVec3, DVec2)>,
}

impl Lid {
    pub(crate) fn of(points: &[DVec3]) -> Result<Self, NoArea> {
        let count = points.len();
        let area = vector_area(points.iter().copied());
        let perimeter: f64 = (0..count).map(|i| points[i].distance(points[(i + 1) % count])).sum();
        let normal = area.normalize_or_zero();
        if area.length() <= 1e-12 * perimeter * perimeter || normal == DVec3::ZERO {
            return Err(NoArea);
        }
        let flat = project(points.iter().copied(), normal);
        let (low, high) = flat.iter().fold((flat[0], flat[0]), |(low, high), p| (low.min(*p), high.max(*p)));
        let scale = 1.0 / (high - low).max_element();
        let uv = |p: DVec2| (p - low) * scale;
        let centre = fan_weights(&flat).map(|weights| {
            let mean = points.iter().copied().sum::<DVec3>() / count as f64;
            let centroid: DVec3 =
                (0..count).map(|i| weights[i] * (mean + points[i] + points[(i + 1) % count]) / 3.0).sum();
            // In the projection's own terms, for which the first point is the origin.
            (centroid, uv(project([points[0], centroid], normal)[1]))
        });
        let rim_uv = flat.iter().map(|p| uv(*p)).collect();
        Ok(Self { normal, flat, rim_uv, centre })
    }
}

/// Shares of the area of the fan about the mean point, one a side; `None` where the loop is not star-shaped about its
/// centroid.
fn fan_weights(flat: &[DVec2]) -> Option<Vec<f64>> {
    let count = flat.len();
    let fan = |centre: DVec2| -> Vec<f64> {
        (0..count).map(|i| (flat[i] - centre).perp_dot(flat[(i + 1) % count] - centre)).collect()
    };
    let mean = flat.iter().copied().sum::<DVec2>() / count as f64;
    let mut weights = fan(mean);
    let total: f64 = weights.iter().sum();
    for weight in &mut weights {
        *weight /= total;
    }
    let centroid: DVec2 = (0..count).map(|i| weights[i] * (mean + flat[i] + flat[(i + 1) % count]) / 3.0).sum();
    let around = fan(centroid);
    // All sides seen from one side is not enough: a loop may run around its centre twice.
    let turns: f64 = (0..count).map(|i| (flat[i] - centroid).angle_to(flat[(i + 1) % count] - centroid)).sum();
    let star = around.iter().all(|area| *area > 1e-9 * total / count as f64) && turns < 1.5 * std::f64::consts::TAU;
    star.then_some(weights)
}
