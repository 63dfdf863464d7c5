//! A polyline onto which strokes are projected.

use glam::DVec3;

use crate::curve::chord_parameters;

/// A line with its running length and its directions.
#[derive(Clone)]
pub(super) struct Line {
    points: Vec<DVec3>,
    closed: bool,
    /// Running length at each point, and once more at the first one of a closed line.
    stations: Vec<f64>,
}

/// Where a point comes to lie on a line.
#[derive(Clone, Copy)]
pub(super) struct Foot {
    /// Length from the first point, metres; below 0 or above the length where the point lies beyond an end.
    pub(super) at: f64,
    /// Distance from the line, which goes on straight beyond its ends; metres.
    pub(super) away: f64,
}

impl Line {
    /// A line through points of which no two neighbours are equal; none where fewer than two (closed: three) are left.
    pub(super) fn new(mut points: Vec<DVec3>, closed: bool) -> Option<Self> {
        points.dedup();
        if closed && points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        if points.len() < 2 + usize::from(closed) {
            return None;
        }
        let stations = chord_parameters(&points, closed);
        stations.last().is_some_and(|length| length.is_finite()).then_some(Self { points, closed, stations })
    }

    pub(super) fn points(&self) -> &[DVec3] {
        &self.points
    }

    pub(super) fn is_closed(&self) -> bool {
        self.closed
    }

    pub(super) fn length(&self) -> f64 {
        self.stations[self.stations.len() - 1]
    }

    /// The point at a running length; straight on beyond the ends, around a closed line.
    pub(super) fn point(&self, at: f64) -> DVec3 {
        let count = self.points.len();
        let at = if self.closed { at.rem_euclid(self.length()) } else { at };
        let segment = self.stations.partition_point(|s| *s <= at).clamp(1, self.stations.len() - 1) - 1;
        let (from, to) = (self.stations[segment], self.stations[segment + 1]);
        self.points[segment].lerp(self.points[(segment + 1) % count], (at - from) / (to - from))
    }

    /// Unit direction over `reach` before and behind a running length.
    pub(super) fn direction(&self, at: f64, reach: f64) -> DVec3 {
        let (mut before, mut behind) = (at - reach, at + reach);
        if !self.closed {
            (before, behind) = (before.max(0.0), behind.min(self.length()));
        }
        (self.point(behind) - self.point(before)).normalize_or_zero()
    }

    /// Unit direction at a running length (at the end that is nearer, beyond one) of an open line: [`Self::direction`]
    /// where there is `reach` on both sides; within `reach` of an end, where that is the direction of a place further in,
    /// turned on as the line turns from the `reach` before.
    pub(super) fn tangent(&self, at: f64, reach: f64) -> DVec3 {
        let length = self.length();
        let at = at.clamp(0.0, length);
        // What the direction stands for lies halfway between the points that it is taken from.
        let middle = |at: f64| 0.5 * ((at - reach).max(0.0) + (at + reach).min(length));
        let inner = if at < 0.5 * length { at + reach } else { at - reach }.clamp(0.0, length);
        let (here, there) = (self.direction(at, reach), self.direction(inner, reach));
        let apart = middle(at) - middle(inner);
        if apart == 0.0 {
            return here;
        }
        (here + (here - there) * ((at - middle(at)) / apart)).normalize_or_zero()
    }

    /// The nearest place whose direction is within the angle of `direction` (whose cosine is `alike`), whichever way it
    /// runs; the nearest of all where none is. Beyond the ends of an open line, it goes on straight, in its direction
    /// over `reach`.
    pub(super) fn foot(&self, point: DVec3, direction: DVec3, alike: f64, reach: f64) -> Foot {
        let count = self.points.len();
        let (mut best, mut any) = ((f64::INFINITY, 0.0), (f64::INFINITY, 0.0));
        for segment in 0..self.stations.len() - 1 {
            let (from, to) = (self.points[segment], self.points[(segment + 1) % count]);
            let along = to - from;
            let share = ((point - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
            let away = point.distance_squared(from + along * share);
            let at = self.stations[segment] + share * (self.stations[segment + 1] - self.stations[segment]);
            if away < any.0 {
                any = (away, at);
            }
            if away < best.0 && along.dot(direction).abs() >= alike * along.length() {
                best = (away, at);
            }
        }
        let (square, at) = if best.0.is_finite() { best } else { any };
        let foot = Foot { at, away: square.sqrt() };
        let length = self.length();
        if self.closed || (at > 0.0 && at < length) {
            return foot;
        }
        // Beyond an end.
        let (end, outward) = match at <= 0.0 {
            true => (self.points[0], -self.direction(0.0, reach)),
            false => (self.points[count - 1], self.direction(length, reach)),
        };
        let beyond = (point - end).dot(outward);
        if beyond <= 0.0 {
            return foot;
        }
        let away = (point - end - outward * beyond).length();
        Foot { at: if at <= 0.0 { -beyond } else { length + beyond }, away }
    }
}
