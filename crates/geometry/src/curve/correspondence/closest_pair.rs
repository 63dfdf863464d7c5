//! Where two chains of segments come closest.

use super::{GoOn, SortError};
use glam::DVec3;

/// Segments that share one bounding box.
const BLOCK: usize = 16;

/// A straight piece of a curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    pub(super) from: DVec3,
    pub(super) to: DVec3,
    /// Arc length of the curve at `from`, metres.
    pub(super) start: f64,
}

/// A point on each of two chains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pair {
    pub(super) points: [DVec3; 2],
    /// Arc lengths of the points along their curves, metres.
    pub(super) arc_lengths: [f64; 2],
    pub(super) distance: f64,
}

/// The pair of points at which two chains are closest; the first one found where several are. None for an empty chain.
pub(super) fn closest_pair(first: &[Segment], second: &[Segment], go_on: &GoOn<'_>) -> Result<Option<Pair>, SortError> {
    let mut best: Option<Pair> = None;
    visit(first, second, f64::INFINITY, go_on, |pair, limit| {
        if best.is_none() || pair.distance < *limit {
            *limit = pair.distance;
            best = Some(pair);
        }
    })?;
    Ok(best)
}

/// Calls `f` with the closest points of every two segments that may be within `limit` metres, which `f` may lower.
/// Boxes around blocks of segments keep this from looking at every two.
pub(super) fn visit(
    first: &[Segment],
    second: &[Segment],
    limit: f64,
    go_on: &GoOn<'_>,
    mut f: impl FnMut(Pair, &mut f64),
) -> Result<(), SortError> {
    let mut limit = limit;
    let boxes: Vec<(DVec3, DVec3)> = second.chunks(BLOCK).map(bounds).collect();
    for block in first.chunks(BLOCK) {
        go_on()?;
        let around = bounds(block);
        for (other, other_around) in second.chunks(BLOCK).zip(&boxes) {
            let apart = (around.0 - other_around.1).max(other_around.0 - around.1).max(DVec3::ZERO);
            if apart.length() > limit {
                continue;
            }
            for a in block {
                for b in other {
                    f(between(a, b), &mut limit);
                }
            }
        }
    }
    Ok(())
}

fn bounds(segments: &[Segment]) -> (DVec3, DVec3) {
    segments.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), s| {
        (low.min(s.from).min(s.to), high.max(s.from).max(s.to))
    })
}

/// Closest points of two segments (Ericson, Real-Time Collision Detection, 5.1.9), exact but for rounding.
fn between(a: &Segment, b: &Segment) -> Pair {
    let (u, v, w) = (a.to - a.from, b.to - b.from, a.from - b.from);
    let (uu, vv, uv) = (u.length_squared(), v.length_squared(), u.dot(v));
    let (uw, vw) = (u.dot(w), v.dot(w));
    let ratio = |n: f64, d: f64| if d > 0.0 { (n / d).clamp(0.0, 1.0) } else { 0.0 };
    let denominator = uu * vv - uv * uv;
    // Below this the segments are parallel to rounding, and any point of the first will do to begin with.
    let mut s = if denominator > 1e-14 * uu * vv { ratio(uv * vw - uw * vv, denominator) } else { 0.0 };
    let t = ratio(uv * s + vw, vv);
    s = ratio(uv * t - uw, uu);
    let points = [a.from + u * s, b.from + v * t];
    let arc_lengths = [a.start + s * uu.sqrt(), b.start + t * vv.sqrt()];
    Pair { points, arc_lengths, distance: points[0].distance(points[1]) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn segment(from: [f64; 3], to: [f64; 3]) -> Segment {
        Segment { from: from.into(), to: to.into(), start: 0.0 }
    }

    #[test]
    fn segments_are_closest_inside_at_ends_and_where_parallel() {
        let a = segment([-1.0, 0.0, 0.0], [3.0, 0.0, 0.0]);
        let cross = between(&a, &segment([1.0, -2.0, 0.5], [1.0, 2.0, 0.5]));
        assert_eq!((cross.points, cross.distance), ([DVec3::X, DVec3::new(1.0, 0.0, 0.5)], 0.5));
        assert_eq!(cross.arc_lengths, [2.0, 2.0]);
        let beyond = between(&a, &segment([5.0, 1.0, 0.0], [6.0, 9.0, 0.0]));
        assert_eq!(beyond.points, [DVec3::X * 3.0, DVec3::new(5.0, 1.0, 0.0)]);
        let parallel = between(&a, &segment([2.0, 1.0, 0.0], [9.0, 1.0, 0.0]));
        assert_eq!(parallel.distance, 1.0);
        let point = segment([7.0, 3.0, 0.0], [7.0, 3.0, 0.0]);
        assert_eq!(between(&a, &point).distance, 5.0);
        assert_eq!(between(&point, &a).distance, 5.0);
    }

    #[test]
    fn boxes_do_not_hide_the_closest_pair() {
        let chain = |f: fn(f64) -> DVec3| -> Vec<Segment> {
            (0..200).map(|i| f64::from(i) / 20.0).map(|t| Segment { from: f(t), to: f(t + 0.05), start: t }).collect()
        };
        let first = chain(|t| DVec3::new(t, (2.0 * t).sin(), 0.1 * t * t));
        let second = chain(|t| DVec3::new(t.cos() * 3.0, t - 5.0, 4.0 + t.sin()));
        let found = closest_pair(&first, &second, &|| Ok(())).unwrap().unwrap();
        let brute = first.iter().flat_map(|a| second.iter().map(|b| between(a, b).distance)).fold(f64::MAX, f64::min);
        assert_eq!(found.distance, brute);
        assert_eq!(closest_pair(&first, &[], &|| Ok(())), Ok(None));
        assert_eq!(closest_pair(&first, &second, &|| Err(SortError::Stopped)), Err(SortError::Stopped));
    }
}
