//! The stretches of a curve between points that stay, measured along its segments or along a spline.

use super::{GoOn, ResampleError, Resampling};
use crate::curve::{ArcLength, CubicSpline, Curve, SplineLength, chord_parameters};
use glam::DVec3;

/// Share of the curve's length below which two points count as one.
const MERGE: f64 = 1e-12;

/// A point, and the pen's pressure there (0 where none was recorded).
type Knot = (DVec3, f64);

/// A curve cut at the points that stay, in order from its first point.
pub(super) struct Stretches {
    paths: Vec<Path>,
    stretches: Vec<Stretch>,
}

/// A part of a path from a point that stays to the next one.
struct Stretch {
    path: usize,
    first: Knot,
    /// Arc lengths along the path, metres.
    from: f64,
    to: f64,
}

/// The way from one corner or end to the next, or once round a closed curve.
struct Path {
    knots: Vec<Knot>,
    /// Arc length at each knot, metres.
    lengths: Vec<f64>,
    spline: Option<SplineLength>,
}

impl Stretches {
    /// Cuts and measures a curve. None where it is too small or too large for that, an error where `go_on` says stop.
    pub(super) fn of(curve: &Curve, resampling: &Resampling, go_on: &GoOn<'_>) -> Result<Option<Self>, ResampleError> {
        let Some(knots) = distinct_knots(curve) else { return Ok(None) };
        let count = knots.len();
        let mut corners = resampling.corner_angle.map_or(vec![], |angle| corners(&knots, curve.is_closed(), angle));
        // Paths as runs of knot indices; behind the last knot of a closed curve they go on from its first.
        let runs: Vec<(usize, usize)> = if !curve.is_closed() {
            corners.insert(0, 0);
            corners.push(count - 1);
            corners.windows(2).map(|pair| (pair[0], pair[1])).collect()
        } else if let Some(first) = corners.first().copied() {
            corners.push(first + count);
            corners.windows(2).map(|pair| (pair[0], pair[1])).collect()
        } else {
            vec![(0, count)]
        };
        let periodic = curve.is_closed() && corners.is_empty();
        let mut paths = Vec::with_capacity(runs.len());
        let mut stretches = Vec::with_capacity(runs.len() + 1);
        let mut before_first = None;
        for (path, (from, to)) in runs.into_iter().enumerate() {
            let own = (from..=to).map(|i| knots[i % count]).collect();
            let Some(measured) = Path::through(own, resampling.smooth, periodic, go_on)? else { return Ok(None) };
            let length = measured.lengths[to - from];
            let mut first = (knots[from % count], 0.0);
            // The first point of a closed curve stays even where the path between two corners runs through it.
            if from < count && count < to {
                let split = measured.lengths[count - from];
                before_first = Some(Stretch { path, first: first.0, from: 0.0, to: split });
                first = (knots[0], split);
            }
            stretches.push(Stretch { path, first: first.0, from: first.1, to: length });
            paths.push(measured);
        }
        if let Some(last) = before_first {
            stretches.rotate_right(1);
            stretches.push(last);
        }
        Ok(Some(Self { paths, stretches }))
    }

    /// Length of each stretch, metres.
    pub(super) fn lengths(&self) -> Vec<f64> {
        self.stretches.iter().map(|stretch| stretch.to - stretch.from).collect()
    }

    /// Point and pressure at a share (0 to less than 1) of a stretch's length; exactly the point that stays at 0.
    pub(super) fn at(&self, stretch: usize, share: f64) -> Knot {
        let stretch = &self.stretches[stretch];
        if share == 0.0 {
            return stretch.first;
        }
        self.paths[stretch.path].at(stretch.from + (stretch.to - stretch.from) * share)
    }
}

impl Path {
    fn through(
        knots: Vec<Knot>,
        smooth: bool,
        periodic: bool,
        go_on: &GoOn<'_>,
    ) -> Result<Option<Self>, ResampleError> {
        let mut points: Vec<DVec3> = knots.iter().map(|knot| knot.0).collect();
        let parameters = chord_parameters(&points, false);
        let spline = if !smooth {
            None
        } else {
            let through = if periodic {
                points.pop();
                CubicSpline::periodic(parameters.clone(), points)
            } else {
                CubicSpline::natural(parameters.clone(), points)
            };
            let Ok(through) = through else { return Ok(None) };
            Some(SplineLength::of_while(through, go_on)?)
        };
        let lengths = match &spline {
            None => parameters,
            Some(spline) => (0..knots.len()).map(|knot| spline.length_at_point(knot)).collect(),
        };
        let length = lengths[lengths.len() - 1];
        Ok((length.is_finite() && length > 0.0).then_some(Self { knots, lengths, spline }))
    }

    fn at(&self, s: f64) -> Knot {
        let interpolate = |span: usize, share: f64| {
            let ((from, pressure), (to, next)) = (self.knots[span], self.knots[span + 1]);
            (from.lerp(to, share), pressure + (next - pressure) * share)
        };
        match &self.spline {
            None => {
                let span = self.lengths.partition_point(|length| *length <= s).saturating_sub(1);
                let span = span.min(self.knots.len() - 2);
                let share = (s - self.lengths[span]) / (self.lengths[span + 1] - self.lengths[span]);
                interpolate(span, share.clamp(0.0, 1.0))
            }
            Some(spline) => {
                let (span, t) = spline.locate(s);
                let (from, to) = (spline.spline().parameters()[span], spline.spline().parameters()[span + 1]);
                (spline.spline().position_in(span, t), interpolate(span, (t - from) / (to - from)).1)
            }
        }
    }
}

/// The points of a curve without those that all but repeat their predecessor; the first, and the last of an open
/// curve, stay. None where the curve cannot be measured or nothing is left.
fn distinct_knots(curve: &Curve) -> Option<Vec<Knot>> {
    let length = ArcLength::of(curve).length();
    if !length.is_finite() || length <= 0.0 {
        return None;
    }
    let near = |a: &Knot, b: &Knot| a.0.distance(b.0) <= MERGE * length;
    let mut knots: Vec<Knot> = Vec::with_capacity(curve.points().len());
    for (i, point) in curve.points().iter().enumerate() {
        let knot = (*point, curve.pressure().map_or(0.0, |p| p[i]));
        if knots.last().is_none_or(|last| !near(last, &knot)) {
            knots.push(knot);
        } else if !curve.is_closed() && i + 1 == curve.points().len() {
            if knots.len() > 1 {
                knots.pop();
            }
            knots.push(knot);
        }
    }
    if curve.is_closed() && knots.len() > 1 && near(&knots[0], &knots[knots.len() - 1]) {
        knots.pop();
    }
    (knots.len() >= if curve.is_closed() { 3 } else { 2 }).then_some(knots)
}

/// Indices of the knots at which the curve turns by more than `angle` radians; never the ends of an open curve.
fn corners(knots: &[Knot], closed: bool, angle: f64) -> Vec<usize> {
    let count = knots.len();
    let turns = |i: &usize| {
        let before = knots[*i].0 - knots[(*i + count - 1) % count].0;
        let after = knots[(*i + 1) % count].0 - knots[*i].0;
        before.cross(after).length().atan2(before.dot(after)) > angle
    };
    let range = if closed { 0..count } else { 1..count - 1 };
    range.filter(turns).collect()
}
