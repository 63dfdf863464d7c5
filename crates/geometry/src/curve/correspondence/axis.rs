//! The axis along which rails run, and directions around it.

use super::Rail;
use crate::curve::{ArcLength, Curve};
use glam::{DQuat, DVec2, DVec3};

/// Share of the rails' mean chord below which the mean of their chords gives no axis.
const FLAT: f64 = 0.05;
/// Sine of the angle to the axis below which a seam direction gives no angle.
const ALONG: f64 = 1e-3;

/// What an axis was taken from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisSource {
    /// The mean of end minus start over the rails.
    Rails,
    /// The normal of the first closed curve.
    ClosedCurve,
    /// The normal of the plane through the rails' starts (or ends).
    Plane,
}

/// An axis with a direction from which angles count.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    pub(super) direction: DVec3,
    pub(super) source: AxisSource,
    /// Unit vector square to the axis.
    pub(super) seam: DVec3,
    /// Whether the seam asked for lies along the axis.
    pub(super) seam_replaced: bool,
}

impl Axis {
    /// None where the rails lie along one line and give no axis.
    pub(super) fn of(rails: &[Rail], first_ring: Option<&Curve>, seam: DVec3) -> Option<Self> {
        let (direction, source) = direction(rails, first_ring)?;
        let across = |seam: DVec3| {
            let seam = seam.normalize_or_zero();
            let across = seam - direction * seam.dot(direction);
            (across.length() > ALONG).then(|| across.normalize_or_zero())
        };
        let asked = across(seam);
        let seam = asked.or_else(|| across(DVec3::Z)).or_else(|| across(DVec3::X))?;
        Some(Self { direction, source, seam, seam_replaced: asked.is_none() })
    }
}

fn direction(rails: &[Rail], first_ring: Option<&Curve>) -> Option<(DVec3, AxisSource)> {
    let count = rails.len() as f64;
    let chords = rails.iter().map(|rail| rail.curve.end() - rail.curve.start());
    let mean = chords.clone().sum::<DVec3>() / count;
    let chord = chords.map(DVec3::length).sum::<f64>() / count;
    if mean.length() > FLAT * chord {
        return Some((mean.normalize_or_zero(), AxisSource::Rails));
    }
    // A normal has two sides: that of the rails, or where they lie flat that of its largest coordinate.
    let side = |normal: DVec3| {
        let along = mean.dot(normal);
        let positive = if along.abs() > 1e-6 * chord {
            along > 0.0
        } else {
            let size = normal.abs();
            let largest = if size.z >= size.x && size.z >= size.y {
                normal.z
            } else if size.y >= size.x {
                normal.y
            } else {
                normal.x
            };
            largest > 0.0
        };
        if positive { normal } else { -normal }
    };
    let ring = first_ring.map_or(DVec3::ZERO, |ring| ring.area_vector().normalize_or_zero());
    if ring != DVec3::ZERO {
        return Some((side(ring), AxisSource::ClosedCurve));
    }
    let starts: Vec<DVec3> = rails.iter().map(|rail| rail.curve.start()).collect();
    let ends: Vec<DVec3> = rails.iter().map(|rail| rail.curve.end()).collect();
    let normal = plane_normal(&starts).or_else(|| plane_normal(&ends))?;
    Some((side(normal), AxisSource::Plane))
}

/// The direction of the largest product of two points' offsets from their mean; none where they lie on one line.
fn plane_normal(points: &[DVec3]) -> Option<DVec3> {
    let mean = points.iter().sum::<DVec3>() / points.len() as f64;
    let farthest =
        points.iter().map(|p| *p - mean).fold(DVec3::ZERO, |a, b| if b.length() > a.length() { b } else { a });
    let normal = points
        .iter()
        .map(|p| farthest.cross(*p - mean))
        .fold(DVec3::ZERO, |a, b| if b.length() > a.length() { b } else { a });
    (normal.length() > 1e-9 * farthest.length_squared()).then(|| normal.normalize_or_zero())
}

/// A place along the rails with its own direction of run and its own centre. The seam is carried to it from the axis
/// by the smallest rotation, so that angles at several stations of a bent limb compare.
#[derive(Clone, Debug)]
pub(super) struct Station {
    pub(super) centre: DVec3,
    pub(super) direction: DVec3,
    seam: DVec3,
}

impl Station {
    pub(super) fn new(points: &[DVec3], direction: DVec3, axis: &Axis) -> Self {
        let seam = DQuat::from_rotation_arc(axis.direction, direction) * axis.seam;
        let mut station = Self { centre: DVec3::ZERO, direction, seam };
        station.centre = station.hull_centroid(points);
        station
    }

    /// Where the rails begin. Its direction is the mean of theirs over the first tenth of their lengths.
    pub(super) fn at_starts(rails: &[Rail], axis: &Axis) -> Self {
        let points: Vec<DVec3> = rails.iter().map(|rail| rail.curve.start()).collect();
        Self::new(&points, local_direction(rails, 0.0, 0.1, axis), axis)
    }

    /// Where the rails end.
    pub(super) fn at_ends(rails: &[Rail], axis: &Axis) -> Self {
        let points: Vec<DVec3> = rails.iter().map(|rail| rail.curve.end()).collect();
        Self::new(&points, local_direction(rails, 0.9, 1.0, axis), axis)
    }

    /// Takes centre and direction from the closed curve that lies here.
    pub(super) fn turn_to(&mut self, ring: &Curve, axis: &Axis) {
        let normal = ring.area_vector().normalize_or_zero();
        if normal != DVec3::ZERO {
            *self = Self::new(ring.points(), normal, axis);
        }
    }

    /// Angle of a point about the centre, counter-clockwise from the seam, -pi to pi.
    pub(super) fn angle(&self, point: DVec3) -> f64 {
        let flat = self.flat(point - self.centre);
        flat.y.atan2(flat.x)
    }

    fn flat(&self, offset: DVec3) -> DVec2 {
        DVec2::new(offset.dot(self.seam), offset.dot(self.direction.cross(self.seam)))
    }

    /// Centroid of the convex hull of points seen along the direction, at their mean height.
    fn hull_centroid(&self, points: &[DVec3]) -> DVec3 {
        let mean = points.iter().sum::<DVec3>() / points.len() as f64;
        let mut flat: Vec<DVec2> = points.iter().map(|p| self.flat(*p - mean)).collect();
        flat.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        let centroid = hull_centroid(&flat);
        mean + self.seam * centroid.x + self.direction.cross(self.seam) * centroid.y
    }
}

/// Mean direction of the rails between two shares of their lengths; the axis where they point apart.
fn local_direction(rails: &[Rail], from: f64, to: f64, axis: &Axis) -> DVec3 {
    let mean = rails
        .iter()
        .map(|rail| {
            let arc = ArcLength::of(&rail.curve);
            (arc.point_at_fraction(to) - arc.point_at_fraction(from)).normalize_or_zero()
        })
        .sum::<DVec3>()
        / rails.len() as f64;
    if mean.length() < 0.2 { axis.direction } else { mean.normalize_or_zero() }
}

/// Centroid of the convex hull of points sorted by x, then y (Andrew's monotone chain); the middle of the two farthest
/// in that order where they lie on one line.
fn hull_centroid(sorted: &[DVec2]) -> DVec2 {
    let (Some(first), Some(last)) = (sorted.first(), sorted.last()) else { return DVec2::ZERO };
    let mut hull: Vec<DVec2> = Vec::new();
    let forth: Vec<DVec2> = sorted.to_vec();
    let back: Vec<DVec2> = sorted.iter().rev().copied().collect();
    for side in [forth, back] {
        let fixed = hull.len();
        for point in side {
            while let [.., a, b] = hull[fixed.min(hull.len())..]
                && (b - a).perp_dot(point - a) <= 0.0
            {
                hull.pop();
            }
            hull.push(point);
        }
        hull.pop();
    }
    let (mut area, mut moment) = (0.0, DVec2::ZERO);
    for (i, a) in hull.iter().enumerate() {
        let (a, b) = (*a - *first, hull[(i + 1) % hull.len()] - *first);
        let double = a.perp_dot(b);
        area += double;
        moment += (a + b) * double / 3.0;
    }
    if area > 1e-9 * first.distance_squared(*last) { *first + moment / area } else { 0.5 * (*first + *last) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn centroid(points: &[(f64, f64)]) -> DVec2 {
        let mut points: Vec<DVec2> = points.iter().map(|p| DVec2::new(p.0, p.1)).collect();
        points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        hull_centroid(&points)
    }

    #[test]
    fn hull_centroid_does_not_mind_crowds() {
        let square = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
        assert!(centroid(&square).distance(DVec2::ONE) < 1e-12);
        let crowded: Vec<(f64, f64)> = square.into_iter().chain((0..50).map(|i| (2.0, 0.04 * f64::from(i)))).collect();
        assert!(centroid(&crowded).distance(DVec2::ONE) < 1e-12);
        assert_eq!(centroid(&[(0.0, 0.0), (1.0, 1.0), (4.0, 4.0)]), DVec2::splat(2.0));
        assert_eq!(centroid(&[(3.0, 1.0)]), DVec2::new(3.0, 1.0));
        assert_eq!(centroid(&[]), DVec2::ZERO);
    }

    #[test]
    fn plane_normal_is_square_to_the_points() {
        let points = [DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y].map(|p| p + DVec3::Z * 5.0);
        assert_eq!(plane_normal(&points).unwrap().abs(), DVec3::Z);
        assert_eq!(plane_normal(&[DVec3::X, DVec3::ZERO, DVec3::X * -3.0]), None);
        assert_eq!(plane_normal(&[DVec3::X; 3]), None);
    }
}
