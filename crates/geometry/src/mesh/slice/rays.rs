//! Sections by rays cast from the bone.

use std::f64::consts::TAU;

use glam::DVec3;

use super::plane::Frame;
use super::section::Hit;
use crate::mesh::MeshRays;

/// Where rays at equal angles from the front hit the mesh, one entry a ray.
pub(super) fn cast(rays: &MeshRays, frame: &Frame, count: usize, hit: Hit) -> Vec<Option<DVec3>> {
    (0..count)
        .map(|k| {
            let (sin, cos) = (TAU * k as f64 / count as f64).sin_cos();
            let direction = frame.front * cos + frame.side * sin;
            let found = match hit {
                Hit::First => rays.first(frame.plane.origin(), direction),
                Hit::Last => rays.last(frame.plane.origin(), direction),
            };
            found.map(|hit| hit.point)
        })
        .collect()
}
