//! Which points of two closed borders correspond.
//!
//! A border with as many points as are asked for keeps them, so that what is made can be welded to it.

use std::f64::consts::TAU;

use glam::DVec3;

use super::GenerateError;
use super::blend::BlendBorder;
use crate::curve::{ArcLength, Curve};

/// Points of each border that are compared.
const SAMPLES: usize = 256;

/// Least share of a full area that a border encloses, in the square of its length (a circle encloses 0.08).
const LEAST_AREA: f64 = 1e-4;

/// Least cosine with which directions or the way between the borders tell on which side of a border the blend lies.
const LEAST_COSINE: f64 = 0.2;

/// Two borders with a common start and sense.
#[derive(Clone, Debug)]
pub(super) struct Alignment<'a> {
    borders: [Border<'a>; 2],
    /// Shares of the start's length at which corresponding points lie.
    shares: Vec<f64>,
    /// Of both borders that keep their points, which point of the end is the first.
    pointwise: Option<usize>,
}

/// One border, its sense and its start.
#[derive(Clone, Debug)]
struct Border<'a> {
    given: &'a BlendBorder<'a>,
    arc: ArcLength<'a>,
    centre: DVec3,
    /// Unit normal on the side to which the blend goes from `start`, and from which it comes to `end`.
    axis: DVec3,
    /// 1, or -1 for a border walked backwards.
    sense: f64,
    /// Share of the length at which it starts.
    origin: f64,
}

impl<'a> Alignment<'a> {
    pub(super) fn of(given: [&'a BlendBorder<'a>; 2], nodes: usize, twist: f64) -> Result<Self, GenerateError> {
        let [mut start, mut end] = [Border::new(given[0])?, Border::new(given[1])?];
        let way = (end.centre - start.centre).normalize_or_zero();
        start.face(start.leading()?, way, None);
        end.face(-end.leading()?, way, Some(start.axis));
        let turn = transport(end.centre - start.centre, start.axis, end.axis);
        let offsets = |border: &Border<'_>, count: usize, at: &dyn Fn(usize) -> DVec3| -> Vec<DVec3> {
            (0..count).map(|k| at(k) - border.centre).collect()
        };
        let kept = [&start, &end].map(|border| border.given.curve.points().len() == nodes);
        if kept == [true, true] {
            let from: Vec<DVec3> = offsets(&start, nodes, &|k| start.own_point(k)).into_iter().map(&turn).collect();
            let to = offsets(&end, nodes, &|k| end.own_point(k));
            let shares = start_share(&from, &to) + twist / TAU;
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to the number of points")]
            let first = (shares * nodes as f64).round().rem_euclid(nodes as f64) as usize;
            return Ok(Self { borders: [start, end], shares: vec![0.0; nodes], pointwise: Some(first) });
        }
        let even = |k: usize| k as f64 / SAMPLES as f64;
        let from: Vec<DVec3> = offsets(&start, SAMPLES, &|k| start.point(even(k))).into_iter().map(&turn).collect();
        let to = offsets(&end, SAMPLES, &|k| end.point(even(k)));
        end.origin = start_share(&from, &to) + twist / TAU;
        let shares = match kept {
            [true, _] => (0..nodes).map(|k| start.own_share(k)).collect(),
            [_, true] => {
                let mut shares: Vec<f64> =
                    (0..nodes).map(|k| (end.own_share(k) - end.origin).rem_euclid(1.0)).collect();
                shares.sort_by(f64::total_cmp);
                shares
            }
            _ => (0..nodes).map(|k| k as f64 / nodes as f64).collect(),
        };
        Ok(Self { borders: [start, end], shares, pointwise: None })
    }

    /// The corresponding points number `node` of both, each with the direction from its surface into the blend.
    pub(super) fn places(&self, node: usize) -> Result<[(DVec3, DVec3); 2], GenerateError> {
        let [start, end] = &self.borders;
        match self.pointwise {
            Some(first) => Ok([start.own_place(node)?, end.own_place(node + first)?]),
            None => Ok([start.place(self.shares[node])?, end.place(self.shares[node])?]),
        }
    }
}

impl<'a> Border<'a> {
    fn new(given: &'a BlendBorder<'a>) -> Result<Self, GenerateError> {
        let arc = ArcLength::of(given.curve);
        let area = given.curve.area_vector();
        let axis = area.normalize_or_zero();
        if axis == DVec3::ZERO || area.length() < LEAST_AREA * arc.length() * arc.length() {
            return Err(GenerateError::EnclosesNothing { border: given.curve.name().to_owned() });
        }
        Ok(Self { given, centre: centre(given.curve, &arc), arc, axis, sense: 1.0, origin: 0.0 })
    }

    /// Mean direction into the blend, in units of one.
    fn leading(&self) -> Result<DVec3, GenerateError> {
        const DIRECTIONS: usize = 32;
        let mut sum = DVec3::ZERO;
        for k in 0..DIRECTIONS {
            sum += self.place(k as f64 / DIRECTIONS as f64)?.1;
        }
        Ok(sum / DIRECTIONS as f64)
    }

    /// Turns the axis along the directions `leading` on, or else along the way from border to border, or else to the
    /// side of the other axis; a border that runs clockwise about it is walked backwards.
    fn face(&mut self, leading: DVec3, way: DVec3, other: Option<DVec3>) {
        let tells = [leading, way].map(|direction| direction.dot(self.axis));
        let side = tells.into_iter().find(|cosine| cosine.abs() > LEAST_COSINE);
        if side.or(other.map(|other| other.dot(self.axis))).is_some_and(|cosine| cosine < 0.0) {
            (self.axis, self.sense) = (-self.axis, -1.0);
        }
    }

    /// The point at the share `t` behind the start, in the border's sense.
    fn point(&self, t: f64) -> DVec3 {
        self.arc.point_at(self.arc_length(t))
    }

    /// The border's own point `node` behind its first, in the border's sense.
    fn own_index(&self, node: usize) -> usize {
        let count = self.given.curve.points().len();
        if self.sense > 0.0 { node % count } else { (count - node % count) % count }
    }

    fn own_point(&self, node: usize) -> DVec3 {
        self.given.curve.points()[self.own_index(node)]
    }

    /// The share of the length at which that point lies, in the border's sense, with the start at its first point.
    fn own_share(&self, node: usize) -> f64 {
        let share = self.arc.cumulative()[self.own_index(node)] / self.arc.length();
        (self.sense * share).rem_euclid(1.0)
    }

    fn own_place(&self, node: usize) -> Result<(DVec3, DVec3), GenerateError> {
        let (index, point) = (self.own_index(node), self.own_point(node));
        let s = self.arc.cumulative()[index];
        Ok((point, self.given.neighbour.direction(self.given.curve, &self.arc, s, point)?))
    }

    fn place(&self, t: f64) -> Result<(DVec3, DVec3), GenerateError> {
        let (s, point) = (self.arc_length(t), self.point(t));
        Ok((point, self.given.neighbour.direction(self.given.curve, &self.arc, s, point)?))
    }

    fn arc_length(&self, t: f64) -> f64 {
        (self.sense * (t + self.origin)).rem_euclid(1.0) * self.arc.length()
    }
}

/// Mean of a closed curve over its length: other than that of its points it does not depend on where these lie.
fn centre(curve: &Curve, arc: &ArcLength<'_>) -> DVec3 {
    let origin = curve.start();
    let sum: DVec3 = (0..curve.segment_count())
        .map(|k| {
            let (from, to) = curve.segment(k);
            ((from - origin) + (to - origin)) * (0.5 * (arc.cumulative()[k + 1] - arc.cumulative()[k]))
        })
        .sum();
    origin + sum / arc.length()
}

/// Carries offsets from a frame about one axis to that about another along the way between them without twist: two
/// reflections (Wang, Juttler, Zheng and Liu 2008), which is the least turn where the way is straight.
fn transport(way: DVec3, from: DVec3, to: DVec3) -> impl Fn(DVec3) -> DVec3 {
    let reflection = |normal: DVec3| {
        let normal = normal.normalize_or_zero();
        move |v: DVec3| v - normal * (2.0 * v.dot(normal))
    };
    // With no way between the centres (rings in one plane), or one across the first axis alone, the plane between the
    // axes takes its place.
    let first = if way.length() > 0.0 { way } else { from };
    let one = reflection(first);
    let other = reflection(to - one(from));
    move |v| other(one(v))
}

/// The share of a turn by which `to` is walked ahead so that its points lie in the directions of those of `from`: the
/// largest sum of products, refined between samples by the cosine through three of them, exact for round borders.
fn start_share(from: &[DVec3], to: &[DVec3]) -> f64 {
    let count = from.len();
    let product = |shift: usize| -> f64 { (0..count).map(|i| from[i].dot(to[(i + shift) % count])).sum() };
    let products: Vec<f64> = (0..count).map(product).collect();
    let best = (0..count).fold(0, |best, k| if products[k] > products[best] { k } else { best });
    let (before, at, after) = (products[(best + count - 1) % count], products[best], products[(best + 1) % count]);
    let bend = 2.0 * at - before - after;
    let step = TAU / count as f64;
    let peak = if bend > 0.0 { ((after - before) / bend * (0.5 * step).tan()).atan() / step } else { 0.0 };
    let peak = peak.clamp(-0.5, 0.5);
    (best as f64 + peak) / count as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transport_turns_and_never_twists() {
        let straight = transport(DVec3::Y * 2.0, DVec3::Y, DVec3::Y);
        for v in [DVec3::X, DVec3::Z] {
            assert!(straight(v).distance(v) < 1e-15);
        }
        // An elbow: the inner side stays the inner one.
        let elbow = transport(DVec3::new(1.0, 1.0, 0.0), DVec3::Y, DVec3::X);
        assert!(elbow(DVec3::X).distance(-DVec3::Y) < 1e-15 && elbow(DVec3::Z).distance(DVec3::Z) < 1e-15);
        // A U: what faces the other leg still does.
        let u = transport(DVec3::X, DVec3::Y, -DVec3::Y);
        assert!(u(DVec3::X).distance(-DVec3::X) < 1e-15 && u(DVec3::Z).distance(DVec3::Z) < 1e-15);
        // Rings in one plane.
        let flat = transport(DVec3::ZERO, DVec3::Y, DVec3::Y);
        assert!(flat(DVec3::X).distance(DVec3::X) < 1e-15);
    }

    #[test]
    fn the_start_is_found_between_samples() {
        let ring = |start: f64| -> Vec<DVec3> {
            (0..SAMPLES)
                .map(|k| TAU * (k as f64 / SAMPLES as f64 + start))
                .map(|a| DVec3::new(2.0 * a.cos(), a.sin(), 0.0))
                .collect()
        };
        for ahead in [0.0, 0.25, 0.1234, 0.9] {
            let found = start_share(&ring(ahead), &ring(0.0));
            assert!((found - ahead).abs().min((found - ahead - 1.0).abs()) < 1e-7, "{ahead} {found}");
        }
    }
}
