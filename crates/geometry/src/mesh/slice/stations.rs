//! Planes along a bone: where they stand, how they turn, and where their front is.

use glam::{DQuat, DVec3};

use super::Plane;
use super::plane::Frame;
use crate::curve::{ArcLength, Curve};

/// Normals closer to the hint than this (26 degrees) do not tell where the front is.
const LEAST_ACROSS: f64 = 0.44;

/// Steps from one plane to the next in which the front is carried on.
const STEPS: usize = 8;

/// The normal of the plane at `s` metres from the start of the bone: the direction from the point `half` metres before
/// to the point `half` metres behind, which is the mean of all directions between them. Beyond its ends the bone goes
/// on straight.
fn normal(arc: &ArcLength, s: f64, half: f64) -> DVec3 {
    let tangent = arc.tangent_at(s);
    if half <= 0.0 {
        return tangent;
    }
    // A bone that comes back to where it was has no mean direction.
    let chord = (beyond(arc, s + half) - beyond(arc, s - half)) / (2.0 * half);
    if chord.length() > 1e-6 { chord.normalize() } else { tangent }
}

/// The point at `s` metres from the start; beyond the ends on the straight line that goes on there.
fn beyond(arc: &ArcLength, s: f64) -> DVec3 {
    let inside = s.clamp(0.0, arc.length());
    arc.point_at(inside) + arc.tangent_at(inside) * (s - inside)
}

/// The planes at shares of the bone's length, with their fronts. `turning` is the stretch over which planes turn, as a
/// share of the length. `None` where the bone is too small or too large to measure.
pub(super) fn along_bone(bone: &Curve, fractions: &[f64], turning: f64, front: DVec3) -> Option<Vec<Frame>> {
    let arc = ArcLength::of(bone);
    let length = arc.length();
    let half = 0.5 * turning * length;
    let plane_at = |fraction: f64| {
        let s = fraction * length;
        Plane::new(beyond(&arc, s), normal(&arc, s, half)).ok()
    };
    let planes = fractions.iter().map(|fraction| plane_at(*fraction)).collect::<Option<Vec<Plane>>>()?;
    let between = |from: usize, to: usize| -> Vec<DVec3> {
        let share = |step: usize| step as f64 / STEPS as f64;
        let at = |step| fractions[from] + (fractions[to] - fractions[from]) * share(step);
        (1..STEPS).filter_map(|step| plane_at(at(step))).map(|plane| plane.normal()).collect()
    };
    Some(with_fronts(&planes, front, between))
}

/// Planes with their fronts: the hint as far as it lies in the plane that is most along it, carried from there to both
/// sides by the smallest turns between the normals (parallel transport), which `between` gives between two planes.
///
/// Where the hint is the normal of that plane to within 26 degrees, the model's top (+Y) takes its place, then its left
/// (+X).
pub(crate) fn with_fronts(planes: &[Plane], hint: DVec3, between: impl Fn(usize, usize) -> Vec<DVec3>) -> Vec<Frame> {
    let hint = (hint / hint.abs().max_element()).normalize_or_zero();
    let across = |plane: &Plane, hint: DVec3| plane.normal().cross(hint).length();
    let best = |hint: DVec3| {
        // The first one where several are as good, to within rounding, so that a straight bone has no whims.
        let most = planes.iter().map(|plane| across(plane, hint)).fold(0.0, f64::max);
        (most, planes.iter().position(|plane| across(plane, hint) >= most - 1e-12).unwrap_or(0))
    };
    let hints = [hint, DVec3::Y, DVec3::X].map(|hint| (hint, best(hint)));
    let Some((hint, (_, anchor))) = hints.into_iter().find(|(_, (most, _))| *most >= LEAST_ACROSS) else {
        return planes.iter().map(|plane| Frame::new(*plane, hint)).collect();
    };
    let Some(first) = planes.get(anchor) else { return Vec::new() };
    let mut frames = vec![Frame::new(*first, hint); planes.len()];
    let mut carry = |from: usize, to: usize| {
        let mut front = frames[from].front;
        let mut normal = planes[from].normal();
        for next in between(from, to).into_iter().chain([planes[to].normal()]) {
            front = DQuat::from_rotation_arc(normal, next) * front;
            normal = next;
        }
        frames[to] = Frame::new(planes[to], front);
    };
    (anchor + 1..planes.len()).for_each(|to| carry(to - 1, to));
    (0..anchor).rev().for_each(|to| carry(to + 1, to));
    frames
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_1_SQRT_2;

    fn elbow() -> Curve {
        Curve::new("elbow", vec![DVec3::ZERO, DVec3::X, DVec3::X + DVec3::NEG_Y], false).unwrap()
    }

    fn even(count: usize) -> Vec<f64> {
        (0..count).map(|k| k as f64 / (count - 1) as f64).collect()
    }

    #[test]
    fn planes_turn_evenly_and_only_around_the_joint() {
        let frames = along_bone(&elbow(), &even(21), 0.4, DVec3::Z).unwrap();
        let degrees = |k: usize| frames[k].plane.normal().angle_between(DVec3::X).to_degrees();
        for k in 0..=6 {
            assert!(degrees(k) < 1e-6 && (degrees(20 - k) - 90.0).abs() < 1e-6, "{k}");
        }
        assert!((degrees(10) - 45.0).abs() < 1e-9);
        for k in 6..14 {
            let turn = degrees(k + 1) - degrees(k);
            assert!((5.0..20.0).contains(&turn), "{k}: {turn}");
        }
        let sharp = along_bone(&elbow(), &even(21), 0.0, DVec3::Z).unwrap();
        assert_eq!((sharp[9].plane.normal(), sharp[11].plane.normal()), (DVec3::X, DVec3::NEG_Y));
    }

    #[test]
    fn beyond_its_ends_a_bone_goes_on_straight() {
        let frames = along_bone(&elbow(), &[-0.25, 1.5], 0.3, DVec3::Z).unwrap();
        assert!(frames[0].plane.origin().distance(DVec3::new(-0.5, 0.0, 0.0)) < 1e-15);
        assert!(frames[1].plane.origin().distance(DVec3::new(1.0, -2.0, 0.0)) < 1e-15);
        assert!(frames[1].plane.normal().distance(DVec3::NEG_Y) < 1e-15);
    }

    #[test]
    fn the_front_is_the_hint_and_does_not_turn_about_the_bone() {
        for frame in along_bone(&elbow(), &even(9), 0.3, DVec3::Z).unwrap() {
            assert!(frame.front.distance(DVec3::Z) < 1e-12);
        }
        // A bone that bends from up to the front, as from shin to foot: there the hint alone would flip.
        let points = (0..=20).map(|k| f64::from(k) * 0.1).map(|a| DVec3::new(0.0, -a.cos(), a.sin())).collect();
        let foot = Curve::new("foot", points, false).unwrap();
        let frames = along_bone(&foot, &even(40), 0.1, DVec3::Z).unwrap();
        for pair in frames.windows(2) {
            assert!(pair[0].front.dot(pair[1].front) > 0.99 && pair[0].side.dot(pair[1].side) > 0.9999);
        }
        assert!(frames[0].side.x.abs() > 0.9999);
    }

    #[test]
    fn a_reversed_bone_has_the_same_fronts() {
        let bent = [DVec3::ZERO, DVec3::new(0.1, -0.9, 0.2), DVec3::new(0.9, -1.4, 0.9), DVec3::new(1.0, -1.5, 2.0)];
        let bone = Curve::new("bent", bent.to_vec(), false).unwrap();
        let forth = along_bone(&bone, &even(12), 0.3, DVec3::Z).unwrap();
        let back = along_bone(&bone.reversed(), &even(12), 0.3, DVec3::Z).unwrap();
        for (a, b) in forth.iter().zip(back.iter().rev()) {
            assert!(a.front.distance(b.front) < 1e-12 && a.side.distance(-b.side) < 1e-12);
        }
    }

    #[test]
    fn a_hint_along_the_bone_is_replaced() {
        let straight = Curve::new("", vec![DVec3::ZERO, DVec3::Z], false).unwrap();
        assert_eq!(along_bone(&straight, &[0.5], 0.0, DVec3::Z).unwrap()[0].front, DVec3::Y);
        let upright = Curve::new("", vec![DVec3::ZERO, DVec3::Y], false).unwrap();
        assert_eq!(along_bone(&upright, &[0.5], 0.0, DVec3::Y).unwrap()[0].front, DVec3::X);
        let front = along_bone(&straight, &[0.5], 0.0, DVec3::new(1.0, 0.0, 1.0)).unwrap()[0].front;
        assert!(front.distance(DVec3::X) < 1e-15 && FRAC_1_SQRT_2 > LEAST_ACROSS);
    }
}
