//! The slopes with which the columns of a skin leave a pole.

use glam::DVec3;

/// What a skin looks like where its first or last section is a pole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PoleShape {
    /// All columns leave the pole in one tangent plane: the tip of a head, a finger, a nose.
    #[default]
    Round,
    /// The columns end without curvature: a spike, a horn.
    Pointed,
}

/// The tangent plane of a round pole, and the slope of each column in it.
#[derive(Clone, Debug)]
pub(crate) struct RoundPole {
    /// Unit normal such that a fan from the pole to a counter-clockwise ring is counter-clockwise about it.
    pub axis: DVec3,
    /// Derivative by the parameter on the way from the pole to the ring.
    pub slopes: Vec<DVec3>,
}

/// Finds the tangent plane of a pole from the ring next to it, or `None` where the fan between them has no area.
///
/// The normal of the plane is the vector area of the fan. Each column leaves in the direction of its chord's
/// projection, as fast as the arc of a circle that is tangent to the plane and ends at the ring: `psi / sin(psi)` times
/// the chord, `psi` the angle between plane and chord. It is at most twice the projection, or the surface would bulge
/// beyond a ring that is far away and small. `interval` is the parameter distance between pole and ring.
pub(crate) fn round(pole: DVec3, ring: &[DVec3], closed: bool, interval: f64) -> Option<RoundPole> {
    let arms = if closed { ring.len() } else { ring.len() - 1 };
    let arm = |j: usize| ring[j % ring.len()] - pole;
    let area: DVec3 = (0..arms).map(|j| 0.5 * arm(j).cross(arm(j + 1))).sum();
    let size: f64 = ring.iter().map(|p| p.distance_squared(pole)).sum::<f64>() / ring.len() as f64;
    if area.length() <= 1e-9 * size {
        return None;
    }
    let axis = area.normalize();
    let slope = |p: &DVec3| {
        let chord = *p - pole;
        let height = chord.dot(axis);
        let flat = chord - height * axis;
        let reach = flat.length();
        if reach <= 1e-12 * chord.length() {
            return DVec3::ZERO;
        }
        let angle = height.abs().atan2(reach);
        let stretch = if angle < 1e-6 { 1.0 } else { angle / angle.sin() };
        let speed = (chord.length() * stretch).min(2.0 * reach);
        flat * (speed / (reach * interval))
    };
    Some(RoundPole { axis, slopes: ring.iter().map(slope).collect() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(radius: f64, height: f64) -> Vec<DVec3> {
        // Counter-clockwise about +Y.
        (0..12)
            .map(|j| (j as f64 * std::f64::consts::TAU / 12.0).sin_cos())
            .map(|(s, c)| DVec3::new(radius * s, height, radius * c))
            .collect()
    }

    #[test]
    fn columns_leave_a_sphere_in_its_tangent_plane() {
        let (s, c) = 0.4_f64.sin_cos();
        let pole = round(DVec3::Y, &ring(s, c), true, 0.5).unwrap();
        assert!((pole.axis - DVec3::Y).length() < 1e-12);
        for (slope, point) in pole.slopes.iter().zip(ring(s, c)) {
            assert!(slope.dot(pole.axis).abs() < 1e-12);
            // The arc from pole to ring is 0.4 long.
            assert!((slope.length() - 0.4 / 0.5).abs() < 1e-12);
            assert!(slope.dot(point) > 0.0);
        }
    }

    #[test]
    fn a_far_small_ring_does_not_bulge() {
        let pole = round(DVec3::Y, &ring(0.1, -4.0), true, 1.0).unwrap();
        assert!(pole.slopes.iter().all(|s| (s.length() - 0.2).abs() < 1e-12));
    }

    #[test]
    fn a_fan_without_area_has_no_plane() {
        let line: Vec<DVec3> = (0..5).map(|j| DVec3::new(j as f64, 0.0, 0.0)).collect();
        assert!(round(DVec3::ZERO, &line, false, 1.0).is_none());
    }
}
