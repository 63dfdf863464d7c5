//! The two silhouettes of a view, made to run side by side.

use glam::DVec2;

use super::error::{StrokesError, names};
use crate::curve::Curve;
use crate::view::View;

/// Strokes drawn in one view: the outline of a shape as it is seen there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Silhouette<'a> {
    /// The view they were drawn in; their depth does not matter.
    pub view: View,
    /// Two open strokes, one on each side of the shape, in any order and running either way; or one stroke around it,
    /// closed or open, which is parted where it reaches farthest along the stack.
    pub strokes: &'a [Curve],
}

/// Two silhouettes of one view, running alongside.
#[derive(Clone, Debug)]
pub(crate) struct Pair {
    /// As seen: the stroke on the left and the one on the right of who walks along with them.
    pub(crate) sides: [Vec<DVec2>; 2],
    /// Mean depth of the strokes, metres.
    pub(crate) depth: f64,
    /// Diagonal of the box around both, as seen, metres.
    pub(crate) diagonal: f64,
}

impl Pair {
    /// The pair of a silhouette that runs from `from` towards `to`, two points in space.
    pub(crate) fn new(silhouette: &Silhouette<'_>, from: glam::DVec3, to: glam::DVec3) -> Result<Self, StrokesError> {
        let view = silhouette.view;
        let name = || names(silhouette.strokes);
        let flat = |curve: &Curve| -> Vec<DVec2> { curve.points().iter().map(|p| view.flat(*p)).collect() };
        let (from, to) = (view.flat(from), view.flat(to));
        if silhouette.strokes.iter().any(|s| s.points().iter().any(|p| p.abs().max_element() > 1e100)) {
            return Err(StrokesError::TooLarge { strokes: name() });
        }
        let mut sides = match silhouette.strokes {
            [one, other] if !one.is_closed() && !other.is_closed() => [flat(one), flat(other)],
            [around] => parted(&flat(around), around.is_closed(), to - from),
            strokes => {
                let closed = strokes.iter().filter(|stroke| stroke.is_closed()).count();
                let (view, found) = (view.name(), strokes.len());
                return Err(StrokesError::Strokes { view, found, closed, strokes: name() });
            }
        };
        let ends = |side: &[DVec2]| (side[0], side[side.len() - 1]);
        for side in &mut sides {
            let (start, end) = ends(side);
            if start.distance(to) + end.distance(from) < start.distance(from) + end.distance(to) {
                side.reverse();
            }
        }
        let (low, high) = sides
            .iter()
            .flatten()
            .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)));
        let diagonal = (high - low).length();
        // Twice the area of the loop up the first and down the second stroke.
        let around: Vec<DVec2> = sides[0].iter().chain(sides[1].iter().rev()).copied().collect();
        let next = around.iter().cycle().skip(1);
        let area: f64 = around.iter().zip(next).map(|(p, q)| (*p - low).perp_dot(*q - low)).sum();
        if area.is_nan() || area.abs() <= 1e-6 * diagonal * diagonal {
            return Err(StrokesError::NoArea { view: view.name(), strokes: name() });
        }
        if area > 0.0 {
            sides.swap(0, 1);
        }
        if let Some(at) = crossing(&sides[0], &sides[1]) {
            return Err(StrokesError::Crossing { view: view.name(), strokes: name(), at });
        }
        let depths = silhouette.strokes.iter().flat_map(Curve::points).map(|p| p.dot(view.depth()));
        let count: usize = silhouette.strokes.iter().map(|stroke| stroke.points().len()).sum();
        Ok(Self { sides, depth: depths.sum::<f64>() / count as f64, diagonal })
    }
}

/// An outline in one stroke as two that run along `axis`.
fn parted(points: &[DVec2], closed: bool, axis: DVec2) -> [Vec<DVec2>; 2] {
    let height = |k: usize| points[k].dot(axis);
    // The first of several that reach equally far.
    let farthest =
        |sign: f64| (1..points.len()).fold(0, |best, k| if sign * height(k) > sign * height(best) { k } else { best });
    if closed {
        let (low, high) = (farthest(-1.0), farthest(1.0));
        let run = |from: usize, to: usize| -> Vec<DVec2> {
            let count = (to + points.len() - from) % points.len();
            (0..=count).map(|k| points[(from + k) % points.len()]).collect()
        };
        return [run(low, high), run(high, low)];
    }
    let ends = (height(0) + height(points.len() - 1)) / 2.0;
    let reach = |k: usize| (height(k) - ends).abs();
    let tip = (1..points.len()).fold(0, |best, k| if reach(k) > reach(best) { k } else { best });
    [points[..=tip].to_vec(), points[tip..].to_vec()]
}

/// Most pairs of segments that are tested for crossing.
const MOST_TESTS: usize = 1 << 22;

/// Where two lines cross, other than by touching. Beyond [`MOST_TESTS`] pairs of segments only every so many points are
/// joined.
fn crossing(one: &[DVec2], other: &[DVec2]) -> Option<DVec2> {
    let mut step = 1;
    while (one.len() / step) * (other.len() / step) > MOST_TESTS {
        step *= 2;
    }
    let thinned = |line: &[DVec2]| -> Vec<DVec2> {
        line.iter().step_by(step).chain((step > 1).then_some(&line[line.len() - 1])).copied().collect()
    };
    let (one, other) = (thinned(one), thinned(other));
    for a in one.windows(2) {
        let (low, high) = (a[0].min(a[1]), a[0].max(a[1]));
        for b in other.windows(2) {
            if b[0].max(b[1]).cmplt(low).any() || b[0].min(b[1]).cmpgt(high).any() {
                continue;
            }
            let side = |p: DVec2, q: DVec2, r: DVec2| {
                robust::orient2d(
                    robust::Coord { x: p.x, y: p.y },
                    robust::Coord { x: q.x, y: q.y },
                    robust::Coord { x: r.x, y: r.y },
                )
            };
            let (s0, s1) = (side(a[0], a[1], b[0]), side(a[0], a[1], b[1]));
            let (t0, t1) = (side(b[0], b[1], a[0]), side(b[0], b[1], a[1]));
            if s0 * s1 < 0.0 && t0 * t1 < 0.0 {
                return Some(a[0].lerp(a[1], t0 / (t0 - t1)));
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn stroke(name: &str, points: &[(f64, f64)], closed: bool) -> Curve {
        Curve::new(name, points.iter().map(|(x, y)| DVec3::new(*x, *y, 0.3)).collect(), closed).unwrap()
    }

    fn pair(strokes: &[Curve]) -> Result<Pair, StrokesError> {
        Pair::new(&Silhouette { view: View::FRONT, strokes }, DVec3::ZERO, DVec3::Y)
    }

    #[test]
    fn order_and_direction_do_not_matter() {
        let left = stroke("left", &[(1.0, 0.0), (1.2, 0.5), (1.0, 1.0)], false);
        let right = stroke("right", &[(-1.0, 0.0), (-1.0, 1.0)], false);
        let wanted = pair(&[left.clone(), right.clone()]).unwrap();
        // Who walks up has -x on the left hand.
        assert_eq!(wanted.sides[0], [DVec2::new(-1.0, 0.0), DVec2::new(-1.0, 1.0)]);
        assert!((wanted.depth - 0.3).abs() < 1e-15);
        for strokes in [[right.clone().reversed(), left.clone()], [left.reversed(), right.reversed()]] {
            assert_eq!(pair(&strokes).unwrap().sides, wanted.sides);
        }
    }

    #[test]
    fn an_outline_is_parted_at_its_ends() {
        let diamond = [(1.0, 0.5), (0.0, 1.0), (-1.0, 0.5), (0.0, 0.0)];
        let found = pair(&[stroke("diamond", &diamond, true)]).unwrap();
        let points = |p: &[(f64, f64)]| p.iter().map(|p| DVec2::from(*p)).collect::<Vec<_>>();
        assert_eq!(found.sides[0], points(&[(0.0, 0.0), (-1.0, 0.5), (0.0, 1.0)]));
        assert_eq!(found.sides[1], points(&[(0.0, 0.0), (1.0, 0.5), (0.0, 1.0)]));
        let arch = [(1.0, 0.0), (1.0, 0.5), (0.0, 1.0), (-1.0, 0.5), (-1.0, 0.0)];
        let found = pair(&[stroke("arch", &arch, false)]).unwrap();
        assert_eq!(found.sides[1], points(&[(1.0, 0.0), (1.0, 0.5), (0.0, 1.0)]));
    }

    #[test]
    fn what_is_no_pair_is_refused() {
        let left = stroke("left", &[(1.0, 0.0), (1.0, 1.0)], false);
        let across = stroke("across", &[(2.0, 0.0), (0.9, 1.0)], false);
        let error = pair(&[left.clone(), across]).unwrap_err();
        let StrokesError::Crossing { at, .. } = error else { panic!("{error}") };
        assert!(at.distance(DVec2::new(1.0, 1.0 / 1.1)) < 1e-12, "{at}");
        let on = [left.clone(), left.clone().renamed("again")];
        assert!(matches!(pair(&on), Err(StrokesError::NoArea { .. })));
        let three = [left.clone(), left.clone(), left];
        assert!(matches!(pair(&three), Err(StrokesError::Strokes { found: 3, closed: 0, .. })));
        assert!(matches!(pair(&[]), Err(StrokesError::Strokes { found: 0, .. })));
    }
}
