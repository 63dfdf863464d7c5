//! Loops that cross themselves.

use super::plane_frame::PlaneFrame;
use glam::{DVec2, DVec3};

/// Comparisons between two questions whether to go on.
const PACE: usize = 1 << 19;

/// A place at which the loop through points crosses itself, seen along the normal of a frame: the first side that
/// crosses another, and there the end of it that is nearer. A loop that touches itself at a point may count as crossing.
///
/// Every side is compared with every other; `go_on` is asked after some hundred thousand comparisons, and its error ends
/// the search.
pub(super) fn crossing<E>(
    points: &[DVec3],
    frame: &PlaneFrame,
    go_on: &dyn Fn() -> Result<(), E>,
) -> Result<Option<DVec3>, E> {
    let flat: Vec<DVec2> = points.iter().map(|p| frame.flat(*p)).collect();
    let count = flat.len();
    let side = |i: usize| (flat[i], flat[(i + 1) % count]);
    let turn = |(a, b): (DVec2, DVec2), p: DVec2| (b - a).perp_dot(p - a);
    // A point on the line counts as left of it, so that a crossing at a point is seen, and a straight line has none.
    let part = |line, (p, q)| (turn(line, p) >= 0.0) != (turn(line, q) >= 0.0);
    let mut compared = 0;
    for i in 0..count {
        compared += count - i;
        if compared > PACE {
            compared = 0;
            go_on()?;
        }
        let one = side(i);
        let (low, high) = (one.0.min(one.1), one.0.max(one.1));
        for j in i + 2..count {
            let other = side(j);
            if (i, j) == (0, count - 1)
                || other.0.min(other.1).cmpgt(high).any()
                || other.0.max(other.1).cmplt(low).any()
            {
                continue;
            }
            if part(one, other) && part(other, one) {
                let nearer = turn(other, one.0).abs() <= turn(other, one.1).abs();
                return Ok(Some(points[if nearer { i } else { (i + 1) % count }]));
            }
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn loop_of(f: impl Fn(f64) -> (f64, f64)) -> Option<DVec3> {
        let points: Vec<DVec3> =
            (0..101).map(|i| f(TAU * f64::from(i) / 101.0)).map(|(x, y)| DVec3::new(x, 0.0, y)).collect();
        crossing(&points, &PlaneFrame::new(DVec3::ZERO, DVec3::Y), &|| Ok::<_, ()>(())).unwrap()
    }

    #[test]
    fn eights_cross_and_kidneys_do_not() {
        let at = loop_of(|t| (t.sin(), (2.0 * t).sin())).unwrap();
        assert!(at.length() < 0.1, "{at}");
        assert_eq!(loop_of(|t| (2.0 * t.cos(), t.sin() - 1.6 * t.cos().powi(2))), None);
        assert_eq!(loop_of(|t| (t.cos(), 0.0)), None);
    }
}
