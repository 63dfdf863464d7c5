//! Drawn shapes, and what is measured on the surfaces made from them.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DQuat, DVec3};

use crate::curve::Curve;
use crate::sections::Sections;

pub(super) fn open(name: &str, count: usize, at: impl Fn(f64) -> DVec3) -> Curve {
    Curve::new(name, (0..=count).map(|i| at(i as f64 / count as f64)).collect(), false).unwrap()
}

/// `at` takes an angle, radians.
pub(super) fn closed(name: &str, count: usize, at: impl Fn(f64) -> DVec3) -> Curve {
    Curve::new(name, (0..count).map(|i| at(TAU * i as f64 / count as f64)).collect(), true).unwrap()
}

/// Lips that face +Z: their outline, the parting line from corner to corner, and the profile.
pub(super) fn mouth(points: usize) -> [Curve; 3] {
    let (wide, high) = (0.05, 0.026);
    let depth = |x: f64| -0.3 * x * x / wide;
    let lips = closed("lips", 4 * points, |a| {
        let x = wide * a.cos();
        DVec3::new(x, high * a.sin() * (1.0 + 0.08 * (4.0 * a).cos()), depth(x))
    });
    let parting = open("parting", 2 * points, |t| {
        let x = wide * (1.0 - 2.0 * t);
        DVec3::new(x, 0.0015 * ((PI * t).sin() + (3.0 * PI * t).sin()), depth(x) + 0.010 * (PI * t).sin().powi(2))
    });
    let profile = open("profile", 2 * points, |t| {
        let a = PI * (t - 0.5);
        let y = high * 1.08 * a.sin();
        let swell =
            0.015 * a.cos().powi(2) + 0.006 * (TAU * (t - 0.5)).sin().powi(2) * a.cos() - 0.005 * a.cos().powi(8);
        DVec3::new(0.0, y, swell)
    });
    [lips, parting, profile]
}

/// `count` meridians of a half sphere about +Y, from its rim to its top.
pub(super) fn dome(count: usize) -> (Vec<Curve>, Curve) {
    let at = |longitude: f64, t: f64| {
        let latitude = FRAC_PI_2 * t;
        DVec3::new(longitude.cos() * latitude.cos(), latitude.sin(), -longitude.sin() * latitude.cos()) * 0.1
    };
    let rail = |k: usize| open(&format!("meridian {k}"), 400, |t| at(TAU * k as f64 / count as f64, t));
    ((0..count).map(rail).collect(), closed("rim", 7200, |a| at(a, 0.0)))
}

/// A cuff on a forearm along +Y: three rails over 140 degrees, and arcs at wrist, middle and elbow. The arm swells.
pub(super) fn cuff(points: usize) -> (Vec<Curve>, Vec<Curve>) {
    let radius = |y: f64| 0.03 + 0.05 * y + 0.012 * (PI * y / 0.2).sin().powi(2);
    let at = |a: f64, y: f64| DVec3::new(radius(y) * a.sin(), y, radius(y) * a.cos());
    let angles = [-70.0_f64, 0.0, 70.0].map(f64::to_radians);
    let rails = angles.map(|a| open("rail", points, |t| at(a, 0.2 * t))).to_vec();
    let arcs = [("wrist", 0.0), ("middle", 0.1), ("elbow", 0.2)]
        .map(|(name, y)| open(name, points, |t| at(angles[0] + (angles[2] - angles[0]) * t, y)));
    (rails, arcs.to_vec())
}

/// A patch of a sphere of radius 0.1 about the origin, seen from +Z, with 4 or 3 sides that bulge outwards.
pub(super) fn sphere_patch(sides: usize, points: usize) -> Vec<Curve> {
    let corner = |k: usize| {
        let a = TAU * k as f64 / sides as f64 + 0.3;
        DVec3::new(0.6 * a.cos(), 0.5 * a.sin(), 1.0).normalize()
    };
    let side = |k: usize| {
        let (from, to) = (corner(k), corner((k + 1) % sides));
        let out = (from + to - 2.0 * DVec3::Z).normalize() * 0.03;
        open(&format!("side {k}"), points, |t| (from.lerp(to, t) + out * (PI * t).sin()).normalize() * 0.1)
    };
    (0..sides).map(side).collect()
}

/// Directions tangent to a sphere about the origin, across a border and away from `side`.
pub(super) fn across_sphere(border: &Curve, into: DVec3) -> Vec<DVec3> {
    let p = border.points();
    let last = p.len() - 1;
    (0..p.len())
        .map(|k| {
            let along = p[(k + 1).min(last)] - p[k.saturating_sub(1)];
            let across = p[k].cross(along).normalize();
            across * across.dot(into - p[k]).signum()
        })
        .collect()
}

/// Everything turned, scaled and shifted.
pub(super) fn placed(curve: &Curve) -> Curve {
    curve.map(place).unwrap()
}

pub(super) fn place(p: DVec3) -> DVec3 {
    DQuat::from_euler(glam::EulerRot::XYZ, 0.7, -1.9, 2.6) * p * 3.0 + DVec3::new(1.0, -3.0, 2.0)
}

/// Largest distance between corresponding points of two stacks, the first one put through `map`.
pub(super) fn apart(one: &Sections, other: &Sections, map: impl Fn(DVec3) -> DVec3) -> f64 {
    assert_eq!((one.len(), one.nodes()), (other.len(), other.nodes()));
    one.points().iter().zip(other.points()).map(|(p, q)| map(*p).distance(*q)).fold(0.0, f64::max)
}

/// Largest angle, degrees, between the tangent planes at both sides of a column, by one-sided differences of third order.
pub(super) fn crease(sections: &Sections, column: usize) -> f64 {
    let n = sections.nodes() as isize;
    let at = |row: usize, step: isize| sections.section(row)[(column as isize + step).rem_euclid(n) as usize];
    (1..sections.len() - 1)
        .map(|row| {
            let side = |d: isize| at(row, 0) * -11.0 + at(row, d) * 18.0 - at(row, 2 * d) * 9.0 + at(row, 3 * d) * 2.0;
            let up = at(row + 1, 0) - at(row - 1, 0);
            side(1).cross(up).angle_between(up.cross(side(-1))).to_degrees()
        })
        .fold(0.0, f64::max)
}

/// Derivative across a row at its end, by one-sided differences of third order, of any length.
pub(super) fn leaving(at: impl Fn(usize) -> DVec3) -> DVec3 {
    at(0) * -11.0 + at(1) * 18.0 - at(2) * 9.0 + at(3) * 2.0
}

/// Angle, degrees, of a direction out of the plane with this normal.
pub(super) fn out_of_plane(direction: DVec3, normal: DVec3) -> f64 {
    direction.normalize().dot(normal.normalize()).asin().abs().to_degrees()
}
