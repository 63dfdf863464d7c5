//! Where rails pass curves, and where they meet each other.

use std::f64::consts::TAU;

use glam::DVec3;

use super::GenerateError;
use super::neighbour::end_slopes;
use crate::curve::{ArcLength, Curve, closest};

/// Rounds in which the nearest points of two curves are found from each other.
const ROUNDS: usize = 64;

/// Places along a rail from which its nearest point to a curve is sought.
const PROBES: usize = 64;

/// Where an open rail comes nearest to a curve: its arc length and its point there. From the nearest of [`PROBES`] places
/// at equal arc length, by closest points in turn.
pub(super) fn nearest(rail: &Curve, curve: &Curve) -> (f64, DVec3) {
    let arc = ArcLength::of(rail);
    let mut best = (f64::INFINITY, 0.0);
    for probe in 0..=PROBES {
        let s = probe as f64 / PROBES as f64 * arc.length();
        let distance = closest(curve, arc.point_at(s)).distance;
        if distance < best.0 {
            best = (distance, s);
        }
    }
    let mut s = best.1;
    for _ in 0..ROUNDS {
        let next = closest(rail, closest(curve, arc.point_at(s)).point).arc_length;
        let moved = (next - s).abs();
        s = next;
        if moved <= 1e-14 * arc.length() {
            break;
        }
    }
    (s, arc.point_at(s))
}

/// Arc lengths at which each rail meets the profiles: its start, the inner ones, its end.
pub(super) fn crossings(rails: &[Curve], profiles: &[&Curve], apex: bool) -> Result<Vec<Vec<f64>>, GenerateError> {
    let inner = if apex { &profiles[1..] } else { &profiles[1..profiles.len() - 1] };
    let of = |(rail, curve): (usize, &Curve)| {
        let length = ArcLength::of(curve).length();
        let mut at = vec![0.0];
        at.extend(inner.iter().map(|profile| nearest(curve, profile).0));
        at.push(length);
        match at.windows(2).position(|pair| pair[1] - pair[0] <= 1e-9 * length) {
            Some(first) => {
                Err(GenerateError::ProfileOrder { rail, name: curve.name().to_owned(), first, second: first + 1 })
            }
            None => Ok(at),
        }
    };
    rails.iter().enumerate().map(of).collect()
}

/// The point at which all rails end.
#[derive(Clone, Debug)]
pub(super) struct Tip {
    pub(super) point: DVec3,
    /// Distance of each rail's end from it, metres.
    pub(super) gaps: Vec<f64>,
}

/// The apex of rails whose ends lie within the snap of their mean.
pub(super) fn apex(rails: &[Curve], snap: f64) -> Result<Tip, GenerateError> {
    let ends = || rails.iter().map(Curve::end);
    let point = if ends().all(|end| end == rails[0].end()) {
        rails[0].end()
    } else {
        ends().sum::<DVec3>() / rails.len() as f64
    };
    let mut gaps = Vec::with_capacity(rails.len());
    for (rail, end) in ends().enumerate() {
        let distance = end.distance(point);
        if distance.is_nan() || distance > snap {
            return Err(GenerateError::NoApex { rail, name: rails[rail].name().to_owned(), distance, snap });
        }
        gaps.push(distance);
    }
    Ok(Tip { point, gaps })
}

impl Tip {
    /// The normal about which the rails leave the apex in order, and the angle of each behind the first one about it, at
    /// last a whole turn; none where they do not go once around it.
    pub(super) fn fan(&self, sampled: &[Vec<DVec3>]) -> Option<(DVec3, Vec<f64>)> {
        let spokes: Vec<DVec3> = sampled.iter().map(|rail| (-end_slopes(rail)[1]).normalize_or_zero()).collect();
        let pairs = || (0..spokes.len()).map(|k| (spokes[k], spokes[(k + 1) % spokes.len()]));
        let area: DVec3 = pairs().map(|(a, b)| a.cross(b)).sum();
        let normal = area.normalize_or_zero();
        // Two rails, or a needle, have no plane.
        if area.length() < 0.1 {
            return None;
        }
        let flat = |spoke: DVec3| spoke - normal * normal.dot(spoke);
        let mut angles = vec![0.0];
        let mut angle = 0.0;
        for (a, b) in pairs() {
            let (a, b) = (flat(a), flat(b));
            let turn = a.cross(b).dot(normal).atan2(a.dot(b));
            if turn <= 1e-6 {
                return None;
            }
            angle += turn;
            angles.push(angle);
        }
        let last = angles.len() - 1;
        angles[last] = TAU;
        ((angle - TAU).abs() < 1e-6).then_some((normal, angles))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(from: DVec3, to: DVec3) -> Curve {
        Curve::new("line", vec![from, to], false).unwrap()
    }

    #[test]
    fn the_nearest_point_is_found_to_round_off() {
        let rail = line(DVec3::new(0.3, -1.0, 0.0), DVec3::new(0.5, 2.0, 0.0));
        let profile = Curve::new("arc", (0..=7).map(|i| DVec3::new(f64::from(i) - 3.0, 0.1, 0.05)).collect(), false);
        let (s, point) = nearest(&rail, &profile.unwrap());
        assert!((point.y - 0.1).abs() < 1e-12 && point.z == 0.0, "{point}");
        assert!((s - rail.start().distance(point)).abs() < 1e-12);
    }

    #[test]
    fn profiles_out_of_order_are_told() {
        let rails = [line(DVec3::ZERO, DVec3::Y * 3.0)];
        let across = |y: f64| line(DVec3::new(-1.0, y, 0.0), DVec3::new(1.0, y, 0.0));
        let curves = [across(0.0), across(1.0), across(2.0), across(3.0)];
        let ordered: Vec<&Curve> = curves.iter().collect();
        let found = crossings(&rails, &ordered, false).unwrap();
        assert!(found[0].iter().zip([0.0, 1.0, 2.0, 3.0]).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
        let mixed = [0, 2, 1, 3].map(|k| &curves[k]);
        let refused = crossings(&rails, &mixed, false);
        assert!(matches!(refused, Err(GenerateError::ProfileOrder { rail: 0, first: 1, second: 2, .. })));
    }

    #[test]
    fn spokes_tell_angles_where_they_go_around() {
        let spoke = |degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            (0..5).map(|i| DVec3::new(cos, sin, 0.0) * (1.0 - f64::from(i) / 4.0)).collect::<Vec<DVec3>>()
        };
        let tip = Tip { point: DVec3::ZERO, gaps: vec![] };
        let (normal, angles) = tip.fan(&[0.0, 60.0, 200.0, 300.0].map(spoke)).unwrap();
        assert!(normal.distance(DVec3::Z) < 1e-12);
        assert!(angles.iter().zip([0.0, 60.0, 200.0, 300.0, 360.0]).all(|(a, b)| (a.to_degrees() - b).abs() < 1e-9));
        let clockwise = tip.fan(&[0.0, 300.0, 200.0, 60.0].map(spoke)).unwrap();
        assert!(clockwise.0.distance(-DVec3::Z) < 1e-12);
        assert!(tip.fan(&[0.0, 180.0].map(spoke)).is_none());
        assert!(tip.fan(&[0.0, 120.0, 60.0, 180.0].map(spoke)).is_none());
    }
}
