//! A first line through a group of strokes: the longest one, prolonged by those that go on beyond its ends.

use std::ops::Range;

use glam::DVec3;

use super::samples::{PER_DISTANCE, Samples};
use super::{CleanError, Line};

/// How far from the end of the line, in distances, a stroke may begin to prolong it.
const GAP: f64 = 2.0;

/// Length below which a line that comes back to its beginning is not closed, in distances.
const SHORTEST_RING: f64 = 8.0;

/// The stroke with which a line begins: the longest closed one, else the longest; the first of equal ones.
pub(super) fn longest(strokes: &[&Samples]) -> usize {
    let key = |k: &usize| (strokes[*k].closed, strokes[*k].length);
    let longer = |a: &usize, b: &usize| {
        let ((closed_a, length_a), (closed_b, length_b)) = (key(a), key(b));
        closed_a.cmp(&closed_b).then(length_a.total_cmp(&length_b)).then(b.cmp(a))
    };
    (0..strokes.len()).max_by(longer).unwrap_or(0)
}

/// The first line of a group. None of it is averaged yet.
pub(super) fn spine(
    strokes: &[&Samples],
    longest: usize,
    distance: f64,
    alike: f64,
    go_on: &dyn Fn(f64) -> Result<(), CleanError>,
) -> Result<Option<Line>, CleanError> {
    let first = strokes[longest];
    let Some(mut line) = Line::new(first.points.clone(), first.closed) else { return Ok(None) };
    if first.closed {
        return Ok(Some(line));
    }
    // Each turn prolongs the line by the part of a stroke that leads farthest beyond an end, and so uses it up.
    for _ in 0..2 * strokes.len() {
        let mut best: Option<(f64, bool, Vec<DVec3>)> = None;
        for stroke in strokes.iter().filter(|stroke| !stroke.closed) {
            for run in off_the_line(&line, stroke, distance, alike, go_on)? {
                for at_end in [true, false] {
                    let Some(tail) = beyond(&line, stroke, &run, at_end, distance, alike) else { continue };
                    let length = stroke.step * tail.len() as f64;
                    if best.as_ref().is_none_or(|best| length > best.0) {
                        best = Some((length, at_end, tail));
                    }
                }
            }
        }
        let Some((_, at_end, tail)) = best else { break };
        let mut points = line.points().to_vec();
        if at_end {
            points.extend(tail);
        } else {
            points.splice(0..0, tail.into_iter().rev());
        }
        match Line::new(points, false) {
            Some(longer) => line = longer,
            None => break,
        }
    }
    Ok(Some(ring(&line, distance, alike).unwrap_or(line)))
}

/// The parts of a stroke that the line does not stand for: nowhere beside it, or beyond its ends. What is on the far
/// side of a ring runs the same way, but far off.
fn off_the_line(
    line: &Line,
    stroke: &Samples,
    distance: f64,
    alike: f64,
    go_on: &dyn Fn(f64) -> Result<(), CleanError>,
) -> Result<Vec<Range<usize>>, CleanError> {
    let length = line.length();
    let mut runs: Vec<Range<usize>> = Vec::new();
    for (k, (point, direction)) in stroke.points.iter().zip(&stroke.directions).enumerate() {
        if k % 64 == 0 {
            go_on(0.0)?;
        }
        let foot = line.foot(*point, *direction, alike, distance);
        if (0.0..=length).contains(&foot.at) && foot.away <= GAP * distance {
            continue;
        }
        match runs.last_mut() {
            Some(run) if run.end == k => run.end += 1,
            _ => runs.push(k..k + 1),
        }
    }
    Ok(runs)
}

/// A part of a stroke that leads beyond an end of the line, from there on; none where it begins too far away, or leads no
/// farther than the distance without coming back to the line.
fn beyond(
    line: &Line,
    stroke: &Samples,
    run: &Range<usize>,
    at_end: bool,
    distance: f64,
    alike: f64,
) -> Option<Vec<DVec3>> {
    let length = line.length();
    let (end, outward) = match at_end {
        true => (line.point(length), line.direction(length, distance)),
        false => (line.point(0.0), -line.direction(0.0, distance)),
    };
    let far = stroke.step * run.len() as f64 > distance * (1.0 + 1.0 / PER_DISTANCE);
    [true, false].into_iter().find_map(|forth| {
        let (begin, sense) = if forth { (run.start, 1.0) } else { (run.end - 1, -1.0) };
        let comes_back = if forth { run.end <= stroke.last() } else { run.start > 0 };
        let near = stroke.points[begin].distance(end) <= GAP * distance;
        let heading = stroke.directions[begin] * sense;
        ((far || comes_back) && near && heading.dot(outward) >= alike).then(|| {
            let part = stroke.points[run.clone()].iter().copied();
            if forth { part.collect() } else { part.rev().collect() }
        })
    })
}

/// The line closed, where its end lies beside its beginning and runs the same way.
fn ring(line: &Line, distance: f64, alike: f64) -> Option<Line> {
    let length = line.length();
    let end = line.point(length);
    let head = Line::new(line.points().iter().copied().take(line.points().len() / 3).collect(), false)?;
    let meeting = |direction: DVec3, of_head: &dyn Fn(f64) -> DVec3| {
        let foot = head.foot(end, direction, alike, distance);
        let same_way = of_head(foot.at).dot(direction) >= alike;
        // The end may stop short of the beginning by no more than the distance.
        let near = foot.away <= distance && foot.at >= -distance && foot.at < head.length();
        (near && same_way && length - foot.at >= SHORTEST_RING * distance).then_some(foot)
    };
    // In a tight bend, what leads to the end and what leads away from the beginning point different ways; they still run
    // the same way where both go on bending as they do.
    let foot = meeting(line.direction(length, distance), &|at| head.direction(at, distance))
        .or_else(|| meeting(line.tangent(length, distance), &|at| head.tangent(at, distance)))?;
    let first = line.points().iter().zip(0..).find(|(p, _)| {
        let own = head.foot(**p, line.direction(0.0, distance), 0.0, distance);
        own.at >= foot.at
    });
    let from = first.map_or(0, |(_, k)| k);
    Line::new(line.points()[from..].to_vec(), true)
}
