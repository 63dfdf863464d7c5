//! The superellipsoid, as a stack of sections by height.

use glam::{DVec2, DVec3};

use super::PrimitiveError;
use super::error::size;
use super::stack::{Row, check, directions, stack};
use crate::curve::{ArcLength, Curve};
use crate::sections::Sections;
use crate::trigonometric::PlaneFrame;

/// Samples of a quarter of the profile, by which lengths along it are measured.
const SAMPLES: usize = 1024;

/// The surface `((|x|/a1)^(2/e2) + (|y|/a2)^(2/e2))^(e2/e1) + (|z|/a3)^(2/e1) = 1` in a frame of its own (Barr 1981).
///
/// The thesis names superellipsoids without their equation. In the usual one, by two angles, an upright wall gets no
/// samples as `e1` goes to 0; sections here stand by height instead: at height z all points are those of the equator
/// times `s(z) = (1 - |z/a3|^(2/e1))^(e1/2)`. At `e1 = 0` that is 1, an open cylinder; otherwise the ends are points.
///
/// Invariants, kept by the constructor: radii of 1e-9 to 1e9 m, exponents of 0 to 4.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Superellipsoid {
    radii: DVec3,
    e1: f64,
    e2: f64,
}

impl Superellipsoid {
    /// A superellipsoid by its three radii (metres, the third along the stack) and exponents: `e1` shapes the profile,
    /// `e2` the sections. 0 is a box, 1 an ellipse, 2 a diamond, more is pinched.
    ///
    /// # Errors
    /// [`PrimitiveError`] where a number is out of range.
    pub fn new(radii: DVec3, e1: f64, e2: f64) -> Result<Self, PrimitiveError> {
        for (what, found) in [("first radius", radii.x), ("second radius", radii.y), ("third radius", radii.z)] {
            size(what, found)?;
        }
        for (what, found) in [("e1", e1), ("e2", e2)] {
            if !(0.0..=4.0).contains(&found) {
                return Err(PrimitiveError::Exponent { what, found });
            }
        }
        Ok(Self { radii, e1, e2 })
    }

    /// Factor of the section at height `z` (metres from the middle) against that at the equator: 1 to 0; 0 beyond the
    /// poles.
    pub fn scale(&self, z: f64) -> f64 {
        let height = (z / self.radii.z).abs();
        if height > 1.0 { 0.0 } else { partner(height, self.e1) }
    }

    /// Distance from the axis at the equator in the direction of a unit vector, metres.
    pub fn radius(&self, direction: DVec2) -> f64 {
        let [p, q] = [direction.x.abs() / self.radii.x, direction.y.abs() / self.radii.y];
        let larger = p.max(q);
        // Taken out of the powers, which over- and underflow for small exponents, and at 0 have this limit.
        if self.e2 == 0.0 || larger == 0.0 {
            return 1.0 / larger;
        }
        let power = 2.0 / self.e2;
        ((p / larger).powf(power) + (q / larger).powf(power)).powf(-0.5 * self.e2) / larger
    }

    /// The point at height `z` and polar angle `angle` (radians) in the superellipsoid's own frame, metres.
    pub fn point(&self, z: f64, angle: f64) -> DVec3 {
        let direction = DVec2::from_angle(angle);
        (direction * (self.scale(z) * self.radius(direction))).extend(z)
    }

    /// The superellipsoid as `sections` sections of `nodes` points at equal polar angles, along the frame's normal.
    /// Sections stand at equal lengths along the profile over the mean of the first two radii, so that steep and flat
    /// stretches are sampled alike.
    ///
    /// # Errors
    /// [`PrimitiveError`] where a number is out of range (2 to 4096 sections, 3 where the ends are points; 3 to 65,536
    /// nodes).
    pub fn sections(&self, frame: &PlaneFrame, sections: usize, nodes: usize) -> Result<Sections, PrimitiveError> {
        check(sections, if self.e1 == 0.0 { 2 } else { 3 }, nodes)?;
        let outline: Vec<DVec2> = directions(nodes).map(|direction| direction * self.radius(direction)).collect();
        stack(frame, &self.rows(sections), &outline)
    }

    fn rows(&self, sections: usize) -> Vec<Row> {
        let last = (sections - 1) as f64;
        // Both halves from the middle outwards, so that they are mirror images to the last bit.
        let from_middle = |k: usize| (2.0 * k as f64 / last - 1.0).abs();
        let sign = |k: usize| if 2 * k + 1 < sections { -1.0 } else { 1.0 };
        if self.e1 == 0.0 {
            return (0..sections)
                .map(|k| Row { height: sign(k) * from_middle(k) * self.radii.z, scale: 1.0 })
                .collect();
        }
        let width = 0.5 * (self.radii.x + self.radii.y);
        let points = quarter(self.e1).iter().map(|(z, s)| DVec3::new(s * width, z * self.radii.z, 0.0)).collect();
        // The quarter has two different ends, so that it is a curve.
        let Ok(profile) = Curve::new("profile", points, false) else { return Vec::new() };
        let arc = ArcLength::of(&profile);
        let row = |k: usize| {
            let share = from_middle(k);
            let found = arc.point_at_fraction(share);
            // The chords of the samples only say where; the height or the scale is then exact for the other.
            let (z, s) = (found.y / self.radii.z, found.x / width);
            let (z, s) = match share {
                1.0 => (1.0, 0.0),
                _ if z <= s => (z, partner(z, self.e1)),
                _ => (partner(s, self.e1), s),
            };
            Row { height: sign(k) * z * self.radii.z, scale: s }
        };
        (0..sections).map(row).collect()
    }
}

/// The other coordinate of a point of `z^(2/e) + s^(2/e) = 1`, both 0 to 1.
fn partner(one: f64, e: f64) -> f64 {
    if e == 0.0 || one == 0.0 {
        return 1.0;
    }
    // 1 - one^(2/e) without cancellation near 1.
    let rest = -f64::exp_m1(2.0 / e * one.ln());
    rest.max(0.0).powf(0.5 * e)
}

/// A quarter of the profile from the equator (0, 1) to the pole (1, 0) as (height, scale), each half by the coordinate
/// on which the other depends gently.
fn quarter(e: f64) -> Vec<(f64, f64)> {
    let middle = 0.5_f64.powf(0.5 * e);
    let share = |k: usize| k as f64 / SAMPLES as f64;
    let half = |k: usize| match e <= 2.0 {
        true => (middle * share(k), partner(middle * share(k), e)),
        false => {
            let s = 1.0 - (1.0 - middle) * share(k);
            (partner(s, e), s)
        }
    };
    let there = (0..=SAMPLES).map(half);
    let back = (0..SAMPLES).rev().map(half).map(|(z, s)| (s, z));
    there.chain(back).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    fn frame() -> PlaneFrame {
        PlaneFrame::new(DVec3::ZERO, DVec3::Z)
    }

    /// Reference value V27.
    #[test]
    fn a_section_of_the_reference() {
        let body = Superellipsoid::new(DVec3::new(1.0, 2.0, 3.0), 0.5, 0.8).unwrap();
        let expected = [
            (0.0, [0.9935376260315, 0.0]),
            (0.4, [0.9854875495592, 0.4166574531045]),
            (1.2, [0.6511575688389, 1.674875996949]),
            (2.5, [-0.9615466808923, 0.7182968104624]),
        ];
        for (angle, [x, y]) in expected {
            let point = body.point(1.2, angle);
            assert!(point.distance(DVec3::new(x, y, 1.2)) < 1e-12, "{angle}: {point}");
        }
    }

    #[test]
    fn every_point_satisfies_the_equation() {
        for (e1, e2) in [(1.0, 1.0), (0.05, 0.3), (2.0, 2.0), (0.7, 3.5), (3.0, 0.5)] {
            let radii = DVec3::new(0.3, 0.5, 0.9);
            let sections = Superellipsoid::new(radii, e1, e2).unwrap().sections(&frame(), 33, 40).unwrap();
            for point in sections.points() {
                let p = (*point / radii).abs();
                // In powers that neither round away what is small nor what is near 1.
                let around = (p.x.powf(2.0 / e2) + p.y.powf(2.0 / e2)).powf(0.5 * e2);
                let whole = (around.powf(2.0 / e1) + p.z.powf(2.0 / e1)).powf(0.5 * e1);
                assert!((whole - 1.0).abs() < 1e-9, "{e1} {e2}: {point} {whole}");
            }
            assert!(sections.is_pole(0) && sections.is_pole(32));
            assert_eq!(sections.centre(16).z, 0.0);
        }
    }

    #[test]
    fn the_round_one_is_an_ellipsoid_with_even_steps() {
        let sphere = Superellipsoid::new(DVec3::splat(2.0), 1.0, 1.0).unwrap().sections(&frame(), 25, 16).unwrap();
        for (k, section) in sphere.iter().enumerate() {
            let height = -2.0 * (PI * k as f64 / 24.0).cos();
            assert!((section[0].z - height).abs() < 1e-5, "{k}: {}", section[0].z);
        }
    }

    #[test]
    fn walls_and_lids_of_a_box_get_their_share_of_sections() {
        let body = Superellipsoid::new(DVec3::ONE, 0.02, 1.0).unwrap().sections(&frame(), 41, 16).unwrap();
        let profile: Vec<(f64, f64)> = body.iter().map(|section| (section[0].z, section[0].x)).collect();
        // Over 4 m of profile the sections stand 0.1 m apart, a quarter of them on each lid.
        for pair in profile.windows(2) {
            let step = f64::hypot(pair[1].0 - pair[0].0, pair[1].1 - pair[0].1);
            assert!((0.06..=0.1001).contains(&step), "{pair:?}");
        }
        assert_eq!(profile.iter().filter(|(z, _)| z.abs() < 0.95).count(), 19);
    }

    #[test]
    fn without_an_exponent_it_is_an_open_cylinder_and_a_box() {
        let tube = Superellipsoid::new(DVec3::new(1.0, 2.0, 3.0), 0.0, 0.0).unwrap();
        let sections = tube.sections(&frame(), 2, 8).unwrap();
        assert_eq!(
            (sections.section(0)[0], sections.section(1)[0]),
            (DVec3::new(1.0, 0.0, -3.0), DVec3::new(1.0, 0.0, 3.0))
        );
        assert!(sections.section(0)[1].distance(DVec3::new(1.0, 1.0, -3.0)) < 1e-15, "the side, at 45 degrees");
        assert_eq!(tube.scale(3.1), 0.0);
        let near = Superellipsoid::new(DVec3::new(1.0, 2.0, 3.0), 1e-9, 1e-9).unwrap();
        assert!(near.point(1.0, 0.3).distance(tube.point(1.0, 0.3)) < 1e-8);
    }

    #[test]
    fn two_is_a_diamond() {
        let body = Superellipsoid::new(DVec3::ONE, 2.0, 2.0).unwrap();
        for angle in (0..16).map(|k| TAU * f64::from(k) / 16.0) {
            let point = body.point(0.25, angle);
            assert!((point.abs().element_sum() - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn malformed_numbers_are_refused() {
        let refusal = |radii: DVec3, e1, e2| Superellipsoid::new(radii, e1, e2).unwrap_err().to_string();
        assert_eq!(
            refusal(DVec3::new(1.0, 0.0, 1.0), 1.0, 1.0),
            "the second radius is 0 m: give a length between 1e-9 and 1e9 m"
        );
        assert!(refusal(DVec3::ONE, -0.1, 1.0).starts_with("the exponent e1 is -0.1: give a number from 0 (a box)"));
        assert!(refusal(DVec3::ONE, 1.0, f64::NAN).starts_with("the exponent e2 is NaN"));
        let body = Superellipsoid::new(DVec3::ONE, 1.0, 1.0).unwrap();
        assert!(body.sections(&frame(), 2, 8).is_err() && body.sections(&frame(), 3, 2).is_err());
    }
}
