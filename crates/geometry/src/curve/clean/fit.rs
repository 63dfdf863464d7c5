//! The principal curve of a group of strokes.

use glam::DVec3;

use super::samples::{PER_DISTANCE, Samples};
use super::{CleanError, Line};
use crate::curve::{Ends, smoothed};

/// Most turns of projecting and averaging.
const TURNS: usize = 8;

/// Move of the line, in distances, below which it is found.
const SETTLED: f64 = 1e-3;

/// Largest share of a line's length that is smoothed away.
const LONGEST_WAVE: f64 = 0.25;

/// A line and how its strokes lie around it.
pub(super) struct Fit {
    pub(super) line: Line,
    pub(super) spread: f64,
    pub(super) largest: f64,
}

/// The line in the middle of the strokes; none where numbers are beyond the range of a double.
pub(super) fn fit(
    strokes: &[&Samples],
    first: Option<Line>,
    distance: f64,
    alike: f64,
    wave: f64,
    go_on: &dyn Fn(f64) -> Result<(), CleanError>,
) -> Result<Option<Fit>, CleanError> {
    let Some(mut line) = first else { return Ok(None) };
    for turn in 0..TURNS {
        let projected = project(strokes, &line, distance, alike, &|share| go_on((turn as f64 + share) / TURNS as f64))?;
        let wave = wave.min(LONGEST_WAVE * line.length());
        let Some(next) = averaged(strokes, &line, &projected, distance, wave) else { return Ok(None) };
        let moved = next.points().iter().map(|p| line.foot(*p, DVec3::ZERO, 0.0, distance).away).fold(0.0, f64::max);
        line = next;
        if moved < SETTLED * distance {
            break;
        }
    }
    let projected = project(strokes, &line, distance, alike, &|_| go_on(1.0))?;
    let (mut sum, mut count, mut largest) = (0.0, 0, 0.0_f64);
    for foot in projected.iter().flatten() {
        sum += foot.away * foot.away;
        count += 1;
        largest = largest.max(foot.away);
    }
    Ok(Some(Fit { line, spread: (sum / f64::from(count.max(1))).sqrt(), largest }))
}

/// A sample's place on the line, its distance, and where it is.
struct Projected {
    at: f64,
    away: f64,
    point: DVec3,
}

/// Each stroke's samples on the line.
fn project(
    strokes: &[&Samples],
    line: &Line,
    distance: f64,
    alike: f64,
    go_on: &dyn Fn(f64) -> Result<(), CleanError>,
) -> Result<Vec<Vec<Projected>>, CleanError> {
    let mut all = Vec::with_capacity(strokes.len());
    for (done, stroke) in strokes.iter().enumerate() {
        let mut feet = Vec::with_capacity(stroke.points.len());
        for (k, (point, direction)) in stroke.points.iter().zip(&stroke.directions).enumerate() {
            if k % 64 == 0 {
                go_on(done as f64 / strokes.len() as f64)?;
            }
            let foot = line.foot(*point, *direction, alike, distance);
            feet.push(Projected { at: foot.at, away: foot.away, point: *point });
        }
        all.push(feet);
    }
    Ok(all)
}

/// The strokes averaged in cells along the line, smoothed, and at even steps.
fn averaged(strokes: &[&Samples], line: &Line, projected: &[Vec<Projected>], distance: f64, wave: f64) -> Option<Line> {
    let closed = line.is_closed();
    let all = || projected.iter().flatten();
    let (low, high) = match closed {
        true => (0.0, line.length()),
        false => {
            all().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), foot| (low.min(foot.at), high.max(foot.at)))
        }
    };
    let span = high - low;
    if !(span.is_finite() && span > 0.0) {
        return None;
    }
    let cells = ((span * PER_DISTANCE / distance).round() as usize).clamp(4, super::MAX_SAMPLES);
    let mut sums = vec![(0.0, DVec3::ZERO, 0.0); cells];
    for (stroke, feet) in strokes.iter().zip(projected) {
        for foot in feet {
            let cell = (((foot.at - low) / span * cells as f64) as usize).min(cells - 1);
            let sum = &mut sums[cell];
            *sum = (sum.0 + stroke.step * (foot.at - low), sum.1 + foot.point * stroke.step, sum.2 + stroke.step);
        }
    }
    let filled = || sums.iter().filter(|sum| sum.2 > 0.0);
    let stations: Vec<f64> = filled().map(|sum| sum.0 / sum.2).collect();
    let means: Vec<DVec3> = filled().map(|sum| sum.1 / sum.2).collect();
    let ends = if closed { Ends::Closed { period: span } } else { Ends::Open { held: [false; 2] } };
    let calm = smoothed(&means, &stations, ends, wave).ok()?;
    if closed {
        let rough = Line::new(calm, true)?;
        return even(&rough, 0.0, rough.length(), distance);
    }
    let rough = Line::new(calm, false)?;
    // Ends lie at the mean of the strokes' ends around them, told by the first and the last sample on the line.
    let mut tips = [Vec::new(), Vec::new()];
    for feet in projected {
        let ends =
            feet.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), foot| (l.min(foot.at), h.max(foot.at)));
        tips[0].push(ends.0 - low);
        tips[1].push(ends.1 - low);
    }
    let mean = |tips: &[f64], near: &dyn Fn(f64) -> bool| {
        let near: Vec<f64> = tips.iter().copied().filter(|tip| near(*tip)).collect();
        near.iter().sum::<f64>() / near.len() as f64
    };
    let begin = mean(&tips[0], &|tip| tip <= distance);
    let end = mean(&tips[1], &|tip| tip >= span - distance);
    // From the parameter of the old line to the running length of the new one, which differ by what was smoothed.
    let (first, last) = (stations.first()?, stations.last()?);
    let stretch = rough.length() / (last - first);
    if !(begin < end && stretch.is_finite()) {
        return None;
    }
    even(&rough, (begin - first) * stretch, (end - first) * stretch, distance)
}

/// A line at even steps between two running lengths of another.
fn even(line: &Line, from: f64, to: f64, distance: f64) -> Option<Line> {
    let closed = line.is_closed();
    let steps = (((to - from) * PER_DISTANCE / distance).round() as usize).clamp(4, super::MAX_SAMPLES);
    let count = if closed { steps } else { steps + 1 };
    let at = |k: usize| from + (to - from) * k as f64 / steps as f64;
    Line::new((0..count).map(|k| line.point(at(k))).collect(), closed)
}
