//! Which point of a contour each point of a section goes to.

use glam::{DVec2, DVec3};

use crate::curve::{ArcLength, Curve, closest};

/// How the points of a section find theirs on the contour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Matching {
    /// By angle where the contour and the section are star-shaped about the contour's centre, else by arc length.
    #[default]
    Auto,
    /// To where the ray from the contour's centre through the point meets the contour: points move radially, and rails
    /// do not swirl.
    Angle,
    /// At the same share of the arc length, from where the ray through the section's first point meets the contour last.
    ArcLength,
}

/// A closed curve seen in a plane of its own.
pub(super) struct Ring<'a> {
    curve: &'a Curve,
    centre: DVec3,
    axes: [DVec3; 2],
}

impl<'a> Ring<'a> {
    /// The contour, run counter-clockwise about `normal`, a unit vector.
    pub(super) fn new(curve: &'a Curve, normal: DVec3) -> Self {
        let first = normal.any_orthonormal_vector();
        Self { curve, centre: centroid(curve.points()), axes: [first, normal.cross(first)] }
    }

    fn flat(&self, offset: DVec3) -> DVec2 {
        DVec2::new(offset.dot(self.axes[0]), offset.dot(self.axes[1]))
    }

    /// Points of this curve matched to the points of `section` by angle, or which of both is not star-shaped.
    pub(super) fn by_angle(&self, section: &[DVec3]) -> Result<Vec<DVec3>, Culprit> {
        let angles = |points: &[DVec3]| -> Option<Vec<f64>> {
            rising_angles(points.iter().map(|p| self.flat(*p - self.centre)))
        };
        let own = angles(self.curve.points()).ok_or(Culprit::Contour)?;
        angles(section).ok_or(Culprit::Section)?;
        Ok(section.iter().map(|point| self.meet(&own, self.flat(*point - self.centre))).collect())
    }

    /// Where the ray from the centre in the direction `ray` meets a star-shaped curve whose points stand at the rising
    /// angles `own`.
    fn meet(&self, own: &[f64], ray: DVec2) -> DVec3 {
        use std::f64::consts::TAU;
        let turn = own[0] + (ray.to_angle() - own[0]).rem_euclid(TAU);
        let segment = own.partition_point(|angle| *angle <= turn).saturating_sub(1);
        let (from, to) = self.curve.segment(segment);
        from.lerp(to, crossing(self.flat(from - self.centre), self.flat(to - self.centre), ray))
    }

    /// Points of this curve matched to the points of `section` by arc length.
    pub(super) fn by_arc_length(&self, section: &[DVec3]) -> Vec<DVec3> {
        let own = ArcLength::of(self.curve);
        let around = section.iter().zip(section.iter().cycle().skip(1));
        let length: f64 = around.clone().map(|(from, to)| from.distance(*to)).sum();
        let seam = self.seam(&own, self.flat(section[0] - centroid(section)));
        let mut passed = 0.0;
        around
            .map(|(from, to)| {
                let target = own.point_at(seam + passed / length * own.length());
                passed += from.distance(*to);
                target
            })
            .collect()
    }

    /// Arc length at which the ray from the centre leaves the curve for the last time.
    fn seam(&self, own: &ArcLength<'_>, ray: DVec2) -> f64 {
        let mut outermost: Option<(f64, f64)> = None;
        for segment in 0..self.curve.segment_count() {
            let (from, to) = self.curve.segment(segment);
            let (p, q) = (self.flat(from - self.centre), self.flat(to - self.centre));
            if (ray.perp_dot(p) > 0.0) == (ray.perp_dot(q) > 0.0) {
                continue;
            }
            let share = crossing(p, q, ray);
            let reach = p.lerp(q, share).dot(ray);
            if reach > 0.0 && outermost.is_none_or(|(farthest, _)| reach > farthest) {
                let (start, end) = (own.cumulative()[segment], own.cumulative()[segment + 1]);
                outermost = Some((reach, start + (end - start) * share));
            }
        }
        match outermost {
            Some((_, arc)) => arc,
            // The centre lies outside of a strongly bent contour, and the ray passes it by.
            None => {
                let far = ray.normalize_or_zero() * own.length();
                closest(self.curve, self.centre + self.axes[0] * far.x + self.axes[1] * far.y).arc_length
            }
        }
    }
}

/// Which curve is not star-shaped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Culprit {
    Contour,
    Section,
}

/// Share of the way from `p` to `q` at which the line along `ray` is crossed.
fn crossing(p: DVec2, q: DVec2, ray: DVec2) -> f64 {
    let (before, after) = (p.perp_dot(ray), q.perp_dot(ray));
    let share = before / (before - after);
    if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) }
}

/// The angles of points about the origin, unwrapped, where they rise strictly and go around once.
fn rising_angles(points: impl Iterator<Item = DVec2>) -> Option<Vec<f64>> {
    use std::f64::consts::{PI, TAU};
    let raw: Vec<f64> = points.map(DVec2::to_angle).collect();
    let mut angles = vec![*raw.first()?];
    let mut turned = 0.0;
    for (k, angle) in raw.iter().enumerate() {
        let next = raw[(k + 1) % raw.len()];
        let step = (next - angle).rem_euclid(TAU);
        if !(step > 0.0 && step < PI) {
            return None;
        }
        turned += step;
        angles.push(raw[0] + turned);
    }
    angles.pop();
    (turned < 1.5 * TAU).then_some(angles)
}

/// Centre of mass of the closed line through the points.
pub(super) fn centroid(points: &[DVec3]) -> DVec3 {
    let (mut sum, mut length) = (DVec3::ZERO, 0.0);
    for (from, to) in points.iter().zip(points.iter().cycle().skip(1)) {
        let step = from.distance(*to);
        sum += (from.midpoint(*to) - points[0]) * step;
        length += step;
    }
    if length > 0.0 { points[0] + sum / length } else { points[0] }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[(f64, f64)]) -> Curve {
        Curve::new("ring", points.iter().map(|(x, y)| DVec3::new(*x, *y, 0.5)).collect(), true).unwrap()
    }

    fn square() -> Curve {
        ring(&[(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)])
    }

    #[test]
    fn rays_meet_a_square() {
        let (square, section) = (square(), [(2.0, 0.5), (0.3, 0.6), (-0.1, -0.1), (0.5, -0.5)]);
        let section: Vec<DVec3> = section.iter().map(|(x, y)| DVec3::new(*x, *y, 3.0)).collect();
        let found = Ring::new(&square, DVec3::Z).by_angle(&section).unwrap();
        for (found, wanted) in found.iter().zip([(1.0, 0.25), (0.5, 1.0), (-1.0, -1.0), (1.0, -1.0)]) {
            assert!(found.distance(DVec3::new(wanted.0, wanted.1, 0.5)) < 1e-14, "{found}");
        }
    }

    #[test]
    fn stars_are_told_from_others() {
        let square = square();
        let about = Ring::new(&square, DVec3::Z);
        let backwards: Vec<DVec3> = square.points().iter().rev().copied().collect();
        assert_eq!(about.by_angle(&backwards), Err(Culprit::Section));
        let twice = [square.points(), square.points()].concat();
        assert_eq!(about.by_angle(&twice), Err(Culprit::Section));
        let bent =
            ring(&[(2.0, 0.0), (2.0, 3.0), (-2.0, 3.0), (-2.0, 0.0), (-1.8, 0.0), (-1.8, 2.8), (1.8, 2.8), (1.8, 0.0)]);
        assert_eq!(Ring::new(&bent, DVec3::Z).by_angle(square.points()), Err(Culprit::Contour));
    }

    #[test]
    fn arc_length_starts_at_the_outermost_crossing() {
        let (square, section) = (square(), ring(&[(3.0, 0.0), (0.0, 3.0), (-3.0, 0.0), (0.0, -3.0)]));
        let found = Ring::new(&square, DVec3::Z).by_arc_length(section.points());
        for (found, wanted) in found.iter().zip([(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]) {
            assert!(found.distance(DVec3::new(wanted.0, wanted.1, 0.5)) < 1e-12, "{found}");
        }
    }

    #[test]
    fn a_ray_that_passes_the_contour_by_still_has_a_seam() {
        // A thin C open to the right, its centre in the gap.
        let c: Vec<(f64, f64)> = (0..=40)
            .map(|k| (1.0, 0.3 + f64::from(k) * 0.14))
            .chain((0..=40).rev().map(|k| (0.9, 0.3 + f64::from(k) * 0.14)))
            .map(|(r, a)| (r * a.cos(), r * a.sin()))
            .collect();
        let (c, section) = (ring(&c), ring(&[(1.0, 0.1), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]));
        let found = Ring::new(&c, DVec3::Z).by_arc_length(section.points());
        assert!(found.iter().all(|p| closest(&c, *p).distance < 1e-12));
        assert!(found[0].x > 0.8, "{}", found[0]);
    }

    #[test]
    fn the_centroid_does_not_depend_on_the_sampling() {
        let uneven = ring(&[(1.0, 1.0), (0.9, 1.0), (0.8, 1.0), (0.1, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)]);
        assert!(centroid(uneven.points()).distance(DVec3::new(0.0, 0.0, 0.5)) < 1e-15);
    }
}
