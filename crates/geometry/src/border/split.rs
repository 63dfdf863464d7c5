//! A closed border taken apart at its corners.

use glam::DVec3;

use super::{Border, BorderError, tangent_at};
use crate::curve::{ArcLength, CubicSpline, Curve, SplineError, SplineLength, chord_parameters, closest, place};

/// Points of the border nearer to the one before than this share of their mean distance carry no spline.
const TOO_NEAR: f64 = 0.25;

/// Points of the border nearer to a corner than this share of their mean distance are left out.
const BESIDE: f64 = 0.75;

/// Points of a side that tell of its corner are at least this many of their mean distances from one another: what is
/// uncertain about the normals of nearer ones would count for too much.
const APART: f64 = 1.5;

/// Why a border is not split.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SplitBorderError {
    /// An open border.
    #[error("border \"{border}\" is open: only a closed one is split")]
    Open {
        /// Its name.
        border: String,
    },
    /// Fewer than two corners.
    #[error("{found} corner(s) given: give two or more, in any order")]
    Corners {
        /// Corners given.
        found: usize,
    },
    /// Corners at one place of the border.
    #[error("two corners are nearest to one point of border \"{border}\", {}: draw them farther apart", place(*at))]
    OnePlace {
        /// Name of the border.
        border: String,
        /// The point.
        at: DVec3,
    },
    /// A side that carries no spline.
    #[error(transparent)]
    Spline(#[from] SplineError),
    /// A side that is no border.
    #[error(transparent)]
    Border(#[from] BorderError),
}

/// The sides of a closed border between `corners`, in its order from the first corner: each `count` (2 or more) points at
/// equal distances on a C2 spline through the border's points, which leaves the corners as the parabolas there do, with directions square to it and to the surface's
/// normals, which another spline goes through.
///
/// A corner is where it is given, brought onto the round surface that the border's points and normals on both sides of it
/// tell of; the border's points next to it, at which a cut takes the corner off, are left out. One that is farther than two
/// sides of the border from it is taken for its nearest place.
///
/// # Errors
/// [`SplitBorderError`] where the border is open, or corners are too few or too near to one another.
pub fn split(border: &Border, corners: &[DVec3], count: usize) -> Result<Vec<Border>, SplitBorderError> {
    use SplitBorderError as E;
    let curve = border.curve();
    if !curve.is_closed() {
        return Err(E::Open { border: curve.name().to_owned() });
    }
    if corners.len() < 2 {
        return Err(E::Corners { found: corners.len() });
    }
    let arc = ArcLength::of(curve);
    let total = curve.points().len();
    let spacing = arc.length() / total as f64;
    let mut cuts: Vec<(f64, DVec3)> = Vec::with_capacity(corners.len());
    for corner in corners {
        let near = closest(curve, *corner);
        cuts.push((near.arc_length, if near.distance <= 2.0 * spacing { *corner } else { near.point }));
    }
    let first = cuts[0].0;
    cuts.sort_by(|a, b| a.0.total_cmp(&b.0));
    let turn = cuts.iter().position(|cut| cut.0 == first).unwrap_or(0);
    cuts.rotate_left(turn);
    // The border's points of each side, spread out and away from the corners.
    let behind = |k: usize, from: f64| (arc.cumulative()[k] - from).rem_euclid(arc.length());
    let mut sides: Vec<Vec<usize>> = Vec::with_capacity(cuts.len());
    for (side, (from, at)) in cuts.iter().enumerate() {
        let length = (cuts[(side + 1) % cuts.len()].0 - from).rem_euclid(arc.length());
        let mut inner: Vec<usize> = (0..total)
            .filter(|k| (BESIDE * spacing..=length - BESIDE * spacing).contains(&behind(*k, *from)))
            .collect();
        inner.sort_by(|a, b| behind(*a, *from).total_cmp(&behind(*b, *from)));
        let mut last = f64::NEG_INFINITY;
        inner.retain(|k| {
            let away = behind(*k, *from) - last >= TOO_NEAR * spacing;
            last = if away { behind(*k, *from) } else { last };
            away
        });
        if inner.len() < 2 {
            return Err(E::OnePlace { border: curve.name().to_owned(), at: *at });
        }
        sides.push(inner);
    }
    let point = |k: usize| curve.points()[k];
    let normal = |k: usize| {
        let away = |other: &usize| point(*other).distance(point(k)) >= TOO_NEAR * spacing;
        let back = (1..total).map(|step| (k + total - step) % total).find(away).unwrap_or(k);
        let ahead = (1..total).map(|step| (k + step) % total).find(away).unwrap_or(k);
        tangent_at([point(back), point(k), point(ahead)]).cross(border.directions()[k]).normalize_or_zero()
    };
    let corners: Vec<(DVec3, DVec3)> = (0..cuts.len())
        .map(|corner| {
            let (before, after) = (&sides[(corner + cuts.len() - 1) % cuts.len()], &sides[corner]);
            let told = |k: &usize| (point(*k), normal(*k));
            let apart = APART * spacing;
            let beside = [
                apart_from_one_another(before.iter().rev().map(told), apart),
                apart_from_one_another(after.iter().map(told), apart),
            ];
            round_corner(cuts[corner].1, &beside)
        })
        .collect();
    let made = sides.iter().enumerate().map(|(side, inner)| {
        let ends = [corners[side], corners[(side + 1) % corners.len()]];
        let inner = inner.iter().map(|k| (point(*k), normal(*k)));
        let all: Vec<(DVec3, DVec3)> = [ends[0]].into_iter().chain(inner).chain([ends[1]]).collect();
        one_side(format!("{} side {}", curve.name(), side + 1), &all, count.max(2))
    });
    made.collect()
}

/// The first three of a side's points with normals that are so far from one another, or two of its first where the side is
/// too short for three.
fn apart_from_one_another(side: impl Iterator<Item = (DVec3, DVec3)>, apart: f64) -> Vec<(DVec3, DVec3)> {
    let mut near: Vec<(DVec3, DVec3)> = Vec::with_capacity(3);
    let mut next = None;
    for (point, normal) in side {
        match near.last() {
            Some((last, _)) if last.distance(point) < apart => next = next.or(Some((point, normal))),
            _ => near.push((point, normal)),
        }
        if near.len() == 3 {
            break;
        }
    }
    if near.len() < 2 {
        near.extend(next);
    }
    near
}

/// A corner and its normal, from points with normals on each side of it, the nearest first. The normal goes on as it
/// changes along both sides, by parabolas where there are three; chords of a round surface are square to the mean of the
/// normals at their ends.
fn round_corner(at: DVec3, beside: &[Vec<(DVec3, DVec3)>; 2]) -> (DVec3, DVec3) {
    let normal = beside.iter().map(|side| extrapolated(at, side)).sum::<DVec3>().normalize_or_zero();
    let below = |side: &[(DVec3, DVec3)]| {
        side.first().map_or(0.0, |(point, other)| (*point - at).dot((normal + *other).normalize_or_zero()))
    };
    (at + normal * (0.5 * (below(&beside[0]) + below(&beside[1]))), normal)
}

/// The normal at a place beyond the first of some points with normals, by the polynomial of the distance along them.
fn extrapolated(at: DVec3, side: &[(DVec3, DVec3)]) -> DVec3 {
    let mut before = at;
    let mut distance = 0.0;
    let places: Vec<f64> = side
        .iter()
        .map(|(point, _)| {
            distance += before.distance(*point);
            before = *point;
            distance.max(f64::MIN_POSITIVE)
        })
        .collect();
    // Lagrange's weights at distance 0.
    let weight = |k: usize| -> f64 {
        (0..places.len()).filter(|other| *other != k).map(|other| places[other] / (places[other] - places[k])).product()
    };
    side.iter().enumerate().map(|(k, (_, normal))| *normal * weight(k)).sum()
}

fn one_side(name: String, all: &[(DVec3, DVec3)], count: usize) -> Result<Border, SplitBorderError> {
    let (points, normals): (Vec<DVec3>, Vec<DVec3>) = all.iter().copied().unzip();
    let parameters = chord_parameters(&points, false);
    let (start, end) = (points[0], points[points.len() - 1]);
    let line = SplineLength::of(CubicSpline::parabolic(parameters.clone(), points)?);
    let normals = CubicSpline::parabolic(parameters, normals)?;
    let stations: Vec<f64> = (0..count).map(|k| line.length() * k as f64 / (count - 1) as f64).collect();
    let mut points: Vec<DVec3> = stations.iter().map(|s| line.point_at(*s)).collect();
    // The sides meet to the bit.
    (points[0], points[count - 1]) = (start, end);
    let leading = stations.iter().map(|s| {
        let t = line.parameter_at(*s);
        normals.position(t).cross(line.spline().derivative(t))
    });
    let leading = leading.collect();
    let none = |_| BorderError::Count { border: name.clone(), points: count, found: 0 };
    let curve = Curve::new(name.clone(), points, false).map_err(none)?;
    Ok(Border::new(curve, leading)?)
}

/// How far the corners are from the border at most, metres.
pub fn farthest_corner(border: &Border, corners: &[DVec3]) -> f64 {
    corners.iter().map(|corner| closest(border.curve(), *corner).distance).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// A square hole of side 2 about the origin in XZ, ten points a side; at corners the directions are diagonal.
    fn square() -> Border {
        let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].map(|(x, z)| DVec3::new(x, 0.0, z));
        let at = |k: usize| corners[k / 10 % 4].lerp(corners[(k / 10 + 1) % 4], (k % 10) as f64 / 10.0);
        let inwards = |k: usize| (at(k + 1) - at((k + 39) % 40)).cross(DVec3::Y);
        Border::new(Curve::new("hole", (0..40).map(at).collect(), true).unwrap(), (0..40).map(inwards).collect())
            .unwrap()
    }

    #[test]
    fn a_square_has_four_sides_from_the_first_corner_on() {
        let corners = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)].map(|(x, z)| DVec3::new(x, 0.1, z));
        let sides = split(&square(), &corners, 33).unwrap();
        assert_eq!(sides.len(), 4);
        // The corner is brought down onto the plane of the square.
        assert!(sides[0].curve().points()[0].distance(DVec3::new(-1.0, 0.0, 1.0)) < 1e-12);
        for (k, side) in sides.iter().enumerate() {
            assert_eq!(side.curve().end(), sides[(k + 1) % 4].curve().start());
            assert!((ArcLength::of(side.curve()).length() - 2.0).abs() < 1e-12 && side.curve().points().len() == 33);
            let along = (side.curve().end() - side.curve().start()) / 2.0;
            assert!(
                side.directions().iter().all(|d| d.distance(along.cross(DVec3::Y)) < 1e-9),
                "{:?}",
                side.directions()
            );
        }
        assert!((farthest_corner(&square(), &corners) - 0.1).abs() < 1e-12);
        // On a sphere as well, where the corners given are on its facets.
        let at = |k: u32| TAU * f64::from(k) / 80.0;
        let place = |t: f64, size: f64| {
            let (x, z) = (0.4 * t.cos().abs().sqrt() * t.cos().signum(), 0.4 * t.sin().abs().sqrt() * t.sin().signum());
            DVec3::new(size * x, 0.0, size * z)
        };
        let on = |p: DVec3| p.with_y((1.0 - p.length_squared()).sqrt());
        let ring: Vec<DVec3> = (0..80).map(at).map(|t| on(place(t, 1.0))).collect();
        let inwards = |k: usize| ring[k].cross(ring[(k + 1) % 80] - ring[(k + 79) % 80]);
        let hole =
            Border::new(Curve::new("hole", ring.clone(), true).unwrap(), (0..80).map(inwards).collect()).unwrap();
        let corners: Vec<DVec3> =
            (0..4).map(|k| on(place(TAU * (0.125 + 0.25 * f64::from(k)), 1.01)) * 0.999).collect();
        for side in split(&hole, &corners, 65).unwrap() {
            for (p, d) in side.curve().points().iter().zip(side.directions()) {
                assert!((p.length() - 1.0).abs() < 1e-4 && p.dot(*d).abs() < 2e-3, "{p} {} {}", p.length(), p.dot(*d));
            }
        }
    }

    #[test]
    fn errors() {
        let corner = DVec3::new(1.0, 0.0, 1.0);
        assert_eq!(split(&square(), &[corner], 9), Err(SplitBorderError::Corners { found: 1 }));
        let one = split(&square(), &[corner, corner * 1.01], 9).unwrap_err();
        assert!(matches!(one, SplitBorderError::OnePlace { .. }), "{one}");
        let open =
            Border::new(Curve::new("c", vec![DVec3::ZERO, DVec3::X], false).unwrap(), vec![DVec3::Y; 2]).unwrap();
        assert_eq!(split(&open, &[corner; 2], 9), Err(SplitBorderError::Open { border: "c".into() }));
    }
}
