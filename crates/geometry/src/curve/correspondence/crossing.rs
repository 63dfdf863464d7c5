//! Cutting two curves where they meet.

use super::closest_pair::{Segment, closest_pair, visit};
use super::{GoOn, SortError};
use crate::curve::{ArcLength, Curve};
use glam::DVec3;

/// Where two curves meet inside both.
#[derive(Clone, Debug)]
pub(super) struct Crossing {
    /// Middle of the two closest points.
    pub(super) point: DVec3,
    /// Arc length of the closest point along each curve, metres.
    pub(super) arc_lengths: [f64; 2],
    /// Distance between the two points, metres.
    pub(super) gap: f64,
    /// Another place where they come just as close.
    pub(super) elsewhere: Option<DVec3>,
}

/// Where two curves come within `tolerance` metres of one another, farther than twice that from the ends of both. Of
/// several places equally close (to 1e-6 of the tolerance), the one nearest to the middle of both curves.
pub(super) fn crossing(
    first: &Curve,
    second: &Curve,
    tolerance: f64,
    go_on: &GoOn<'_>,
) -> Result<Option<Crossing>, SortError> {
    let margin = 2.0 * tolerance;
    let inner = [inner_segments(first, margin), inner_segments(second, margin)];
    let closest = closest_pair(&inner[0], &inner[1], go_on)?.filter(|pair| pair.distance <= tolerance);
    let Some(closest) = closest else { return Ok(None) };
    let halves = [first, second].map(|curve| 0.5 * ArcLength::of(curve).length());
    let off_middle =
        |arc_lengths: [f64; 2]| -> f64 { arc_lengths.iter().zip(halves).map(|(s, half)| (s / half - 1.0).abs()).sum() };
    let limit = closest.distance + 1e-6 * tolerance;
    let mut best = closest;
    visit(&inner[0], &inner[1], limit, go_on, |pair, _| {
        if pair.distance <= limit && off_middle(pair.arc_lengths) < off_middle(best.arc_lengths) {
            best = pair;
        }
    })?;
    // Places as close beside it (a stretch in common, or equal by symmetry) are averaged, so that the cut depends on
    // the direction of neither curve.
    let mut beside = (0.0, [0.0; 2]);
    let mut elsewhere = None;
    visit(&inner[0], &inner[1], limit, go_on, |pair, _| {
        if pair.distance > limit {
        } else if pair.points[0].distance(best.points[0]) <= 4.0 * tolerance {
            beside.0 += 1.0;
            beside.1 = [0, 1].map(|i| beside.1[i] + pair.arc_lengths[i]);
        } else {
            elsewhere.get_or_insert(0.5 * (pair.points[0] + pair.points[1]));
        }
    })?;
    let arc_lengths = beside.1.map(|sum| sum / beside.0);
    // Closest where the inner part begins: they come closer still towards an end, and do not cross.
    let at_margin = |i: usize| arc_lengths[i].min(2.0 * halves[i] - arc_lengths[i]) <= margin * (1.0 + 1e-9);
    if at_margin(0) || at_margin(1) {
        return Ok(None);
    }
    let feet = [ArcLength::of(first).point_at(arc_lengths[0]), ArcLength::of(second).point_at(arc_lengths[1])];
    Ok(Some(Crossing { point: 0.5 * (feet[0] + feet[1]), arc_lengths, gap: feet[0].distance(feet[1]), elsewhere }))
}

/// Shortest distance between two curves, metres.
pub(super) fn gap(first: &Curve, second: &Curve, go_on: &GoOn<'_>) -> Result<f64, SortError> {
    let closest = closest_pair(&inner_segments(first, 0.0), &inner_segments(second, 0.0), go_on)?;
    Ok(closest.map_or(f64::INFINITY, |pair| pair.distance))
}

/// Cuts an open curve at an arc length into two that both end at `point`, exactly: the part before it, as drawn, and
/// the part behind it, flipped. `None` where a part vanishes.
pub(super) fn cut(curve: &Curve, s: f64, point: DVec3) -> Option<[Curve; 2]> {
    let arc = ArcLength::of(curve);
    let foot = arc.point_at(s);
    let (segment, _) = arc.locate(s);
    let part = |range: std::ops::Range<usize>, at_front: bool| {
        let mut points = curve.points()[range.clone()].to_vec();
        let mut pressure = curve.pressure().map(|p| p[range].to_vec());
        let place = if at_front { 0 } else { points.len() };
        points.insert(place, foot);
        if let (Some(pressure), Some(there)) = (&mut pressure, arc.pressure_at(s)) {
            pressure.insert(place, there);
        }
        let part = Curve::with_pressure(curve.name(), points, false, pressure).ok()?;
        move_end(&if at_front { part.reversed() } else { part }, point)
    };
    Some([part(0..segment + 1, false)?, part(segment + 1..curve.points().len(), true)?])
}

/// Moves the last point of an open curve to `target`, exactly. The shift fades out smoothly over ten times its length
/// of the curve (over the whole curve, if it is shorter), so that it turns no segment by more than about 9 degrees.
/// `None` where the curve vanishes.
pub(super) fn move_end(curve: &Curve, target: DVec3) -> Option<Curve> {
    let shift = target - curve.end();
    let arc = ArcLength::of(curve);
    let length = arc.length();
    let reach = (10.0 * shift.length()).min(length);
    let last = curve.points().len() - 1;
    let points = curve
        .points()
        .iter()
        .zip(arc.cumulative())
        .enumerate()
        .map(|(i, (point, s))| {
            let near = 1.0 - (length - s) / reach;
            if i == last {
                target
            } else if near > 0.0 {
                *point + shift * (near * near * (3.0 - 2.0 * near))
            } else {
                *point
            }
        })
        .collect();
    Curve::with_pressure(curve.name(), points, false, curve.pressure().map(<[f64]>::to_vec)).ok()
}

/// The segments of an open curve that are farther than `margin` metres of arc length from its ends, cut to that.
fn inner_segments(curve: &Curve, margin: f64) -> Vec<Segment> {
    let arc = ArcLength::of(curve);
    let (low, high) = (margin, arc.length() - margin);
    (0..curve.segment_count())
        .filter_map(|i| {
            let (start, end) = (arc.cumulative()[i].max(low), arc.cumulative()[i + 1].min(high));
            let (from, to) = curve.segment(i);
            let at = |s: f64| {
                let (before, behind) = (arc.cumulative()[i], arc.cumulative()[i + 1]);
                if s == before { from } else { from.lerp(to, (s - before) / (behind - before)) }
            };
            (start < end).then(|| Segment { from: at(start), to: at(end), start })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn crossing(first: &Curve, second: &Curve, tolerance: f64) -> Option<Crossing> {
        super::crossing(first, second, tolerance, &|| Ok(())).unwrap()
    }

    fn gap(first: &Curve, second: &Curve) -> f64 {
        super::gap(first, second, &|| Ok(())).unwrap()
    }

    fn arch(along: DVec3, lift: f64) -> Curve {
        let points = (0..=400)
            .map(|i| std::f64::consts::PI * (f64::from(i) / 400.0 - 0.5) * 1.5)
            .map(|a| along * a.sin() + DVec3::Y * (a.cos() + lift));
        let pressure = (0..=400).map(|i| f64::from(i) / 400.0).collect();
        Curve::with_pressure("arch", points.collect(), false, Some(pressure)).unwrap()
    }

    #[test]
    fn arches_that_nearly_touch_are_cut_at_the_middle_of_the_gap() {
        let (front, side) = (arch(DVec3::X, 0.0), arch(DVec3::Z, 0.02));
        let found = crossing(&front, &side, 0.05).unwrap();
        assert!(found.point.distance(DVec3::Y * 1.01) < 1e-12, "{found:?}");
        assert!((found.gap - 0.02).abs() < 1e-12);
        assert_eq!(found.elsewhere, None);
        for (curve, s) in [(&front, found.arc_lengths[0]), (&side, found.arc_lengths[1])] {
            let halves = cut(curve, s, found.point).unwrap();
            assert_eq!([halves[0].start(), halves[1].start()], [curve.start(), curve.end()]);
            let turn = |a: DVec3, b: DVec3, c: DVec3| (b - a).angle_between(c - b);
            for half in &halves {
                assert_eq!(half.end(), found.point);
                assert!((half.pressure().unwrap()[half.points().len() - 1] - 0.5).abs() < 1e-12);
                let turns = half.points().windows(3).map(|p| turn(p[0], p[1], p[2]));
                assert!(turns.fold(0.0, f64::max) < 0.15, "moving the end makes no kink");
            }
            let before = |half: &Curve| half.points()[half.points().len() - 2];
            assert!(turn(before(&halves[0]), found.point, before(&halves[1])) < 0.1, "nor where the halves meet");
        }
        assert!(crossing(&front, &side, 0.01).is_none());
    }

    #[test]
    fn curves_that_share_only_an_end_do_not_cross() {
        let first = Curve::new("a", vec![DVec3::ZERO, DVec3::X], false).unwrap();
        let second = Curve::new("b", vec![DVec3::ZERO, DVec3::Y], false).unwrap();
        assert!(crossing(&first, &second, 0.02).is_none());
        assert_eq!(gap(&first, &second), 0.0);
    }

    #[test]
    fn of_two_crossings_the_one_in_the_middle_is_taken_and_the_other_told() {
        let line = Curve::new("line", vec![DVec3::X * -2.0, DVec3::X * 3.0], false).unwrap();
        let zigzag = [(-1.0, -1.0), (0.0, 1.0), (1.0, 1.0), (2.0, -1.0), (3.0, -1.0)];
        let zigzag = zigzag.map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec();
        let zigzag = Curve::new("zigzag", zigzag, false).unwrap();
        for turned in [zigzag.clone(), zigzag.reversed()] {
            let found = crossing(&line, &turned, 0.01).unwrap();
            assert!(found.point.distance(DVec3::X * 1.5) < 1e-12);
            assert!(found.elsewhere.unwrap().distance(DVec3::X * -0.5) < 1e-12);
        }
    }
}
