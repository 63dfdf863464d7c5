//! What is measured of a section to find its place.

use glam::DVec3;

use crate::curve::Curve;

/// A section, measured.
#[derive(Clone, Copy, Debug)]
pub(super) struct Station {
    /// Mean over its length, metres: it does not depend on how densely a part was drawn.
    pub(super) centre: DVec3,
    /// Unit vector about which it runs counter-clockwise; zero where it encloses next to nothing.
    pub(super) normal: DVec3,
    /// Mean distance from the centre over its length, metres.
    pub(super) radius: f64,
    /// Diagonal of its box, metres.
    pub(super) size: f64,
}

impl Station {
    pub(super) fn of(curve: &Curve) -> Self {
        let segments = || (0..curve.segment_count()).map(|k| curve.segment(k));
        let length: f64 = segments().map(|(a, b)| a.distance(b)).sum();
        let mean = |of: &dyn Fn(DVec3, DVec3) -> DVec3| -> DVec3 {
            segments().map(|(a, b)| of(a, b) * (a.distance(b) / length)).sum()
        };
        let centre = mean(&|a, b| 0.5 * (a + b));
        let radius = mean(&|a, b| DVec3::X * (0.5 * (a + b)).distance(centre)).x;
        let (low, high) = curve.bounds();
        let size = (high - low).length();
        let area = curve.area_vector();
        let normal = if area.length() > 1e-9 * size * size { area.normalize_or_zero() } else { DVec3::ZERO };
        Self { centre, normal, radius, size }
    }

    /// How far it is to another section: the way between the middles, up to twice as long where it lies in their
    /// planes, and the difference of the radii.
    pub(super) fn distance(&self, other: &Self) -> f64 {
        let way = other.centre - self.centre;
        let squared = way.length_squared();
        let along = |normal: DVec3| if normal == DVec3::ZERO { squared } else { way.dot(normal).powi(2) };
        let across = (squared - along(self.normal).min(along(other.normal))).max(0.0);
        (squared + 3.0 * across + (other.radius - self.radius).powi(2)).sqrt()
    }
}
