//! What resampling made of a curve.

use super::{ArcLength, Curve};
use glam::DVec3;

/// How the points of a resampled curve lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Shortest distance between neighbouring points, metres.
    pub shortest: f64,
    /// Longest distance between neighbouring points, metres.
    pub longest: f64,
    /// How far a point of the drawn curve is off the new curve's straight pieces at most, metres. Looked for near the
    /// same share of the length, so that where a curve comes back to itself it is an upper bound.
    pub off_drawing: f64,
}

/// Pieces on either side of the one at the same share of the length among which the nearest is looked for.
const NEIGHBOURS: usize = 2;

/// Measures a resampled curve against the one it was made from. Takes time in proportion to the points of both.
pub fn spread(drawn: &Curve, resampled: &Curve) -> Spread {
    let new = ArcLength::of(resampled);
    let steps = || (0..resampled.segment_count()).map(|segment| resampled.segment(segment)).map(|(p, q)| p.distance(q));
    let shares = ArcLength::of(drawn);
    let off = |(point, passed): (&DVec3, &f64)| {
        let (at, _) = new.locate(passed / shares.length() * new.length());
        let count = resampled.segment_count();
        let first =
            if resampled.is_closed() { at + count - NEIGHBOURS.min(count) } else { at.saturating_sub(NEIGHBOURS) };
        let last = if resampled.is_closed() { at + count + NEIGHBOURS } else { (at + NEIGHBOURS).min(count - 1) };
        let distance = |segment: usize| to_segment(*point, resampled.segment(segment % count));
        (first..=last).map(distance).fold(f64::INFINITY, f64::min)
    };
    Spread {
        shortest: steps().fold(f64::INFINITY, f64::min),
        longest: steps().fold(0.0, f64::max),
        off_drawing: drawn.points().iter().zip(shares.cumulative()).map(off).fold(0.0, f64::max),
    }
}

fn to_segment(point: DVec3, (from, to): (DVec3, DVec3)) -> f64 {
    let along = to - from;
    let share = ((point - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    from.lerp(to, if share.is_nan() { 0.0 } else { share }).distance(point)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::{Resampling, farthest, resample};

    fn arc(points: u32, closed: bool) -> Curve {
        let turn = if closed { std::f64::consts::TAU } else { 2.0 };
        let at = |k: u32| turn * f64::from(k) / f64::from(points);
        Curve::new("arc", (0..points).map(|k| DVec3::new(at(k).cos(), at(k).sin(), 0.1 * at(k))).collect(), closed)
            .unwrap()
    }

    #[test]
    fn distances_are_those_of_all_pieces() {
        for closed in [false, true] {
            let drawn = arc(200, closed);
            for count in [3, 4, 7, 40, 200] {
                let new = resample(&drawn, &Resampling::count(count)).unwrap();
                let found = spread(&drawn, &new);
                let whole = farthest(drawn.points(), &new);
                assert!((found.off_drawing - whole).abs() < 1e-12, "{closed} {count}: {} {whole}", found.off_drawing);
                assert!(found.shortest > 0.0 && found.shortest <= found.longest);
            }
        }
    }

    #[test]
    fn a_chord_is_off_its_arc_by_its_height() {
        let semicircle = (0..=100).map(|k| std::f64::consts::PI * f64::from(k) / 100.0);
        let drawn = Curve::new("half", semicircle.map(|a| DVec3::new(a.cos(), a.sin(), 0.0)).collect(), false).unwrap();
        let found = spread(&drawn, &resample(&drawn, &Resampling::count(2)).unwrap());
        assert!((found.off_drawing - 1.0).abs() < 1e-12 && (found.longest - 2.0).abs() < 1e-12, "{found:?}");
        assert_eq!(found.shortest, found.longest);
    }
}
