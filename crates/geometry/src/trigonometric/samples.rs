//! The points that are fitted, and their angles.

use super::error::FitError;
use super::options::{Sampling, Start};
use super::plane_frame::{PlaneFrame, mean, normal};
use crate::curve::{ArcLength, Curve, chord_parameters};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Longest spacing of even samples over the shortest.
const EVEN: f64 = 1.25;
/// Fewest even points that are taken as they are.
const ENOUGH: usize = 48;
/// Fewest new samples, for a whole series and for a split one.
const FEWEST: [usize; 2] = [64, 128];
/// Most samples.
const MOST: usize = 512;
/// Slowest growth of the polar angle, as a share of its mean pace, at which a curve is clearly star-shaped.
const PACE: f64 = 0.25;

/// Size of a curve as a share of its coordinates, below which they hold too few digits of it.
const FAR_OUT: f64 = 1e-9;

/// A curve as it is fitted.
pub(super) struct Samples {
    pub(super) name: String,
    pub(super) points: Vec<DVec3>,
    pub(super) closed: bool,
    pub(super) frame: PlaneFrame,
    /// D of the thesis, metres.
    pub(super) diagonal: f64,
    /// Length from the first sample to each, and once more back at the first for a closed curve.
    lengths: Vec<f64>,
    /// Whether the curve was reversed to run counter-clockwise.
    pub(super) reversed: bool,
}

/// Polar angles of a closed curve.
pub(super) struct Polar {
    pub(super) angles: Vec<f64>,
    /// The sample behind which the angle stops growing, where it does.
    pub(super) back: Option<usize>,
    /// Whether the curve is clearly star-shaped.
    pub(super) clear: bool,
}

/// What decides how many samples are taken.
#[derive(Clone, Copy)]
pub(super) struct Wanted {
    pub(super) sampling: Sampling,
    pub(super) split: bool,
    /// Harmonics, where they are fixed.
    pub(super) fixed: Option<usize>,
}

impl Samples {
    /// Samples a curve; the frame is its own.
    pub(super) fn of(curve: &Curve, wanted: Wanted) -> Result<Self, FitError> {
        let closed = curve.is_closed();
        let points = sampled(curve, wanted);
        let lengths = chord_parameters(&points, closed);
        let origin = mean(&points);
        let frame = PlaneFrame::new(origin, normal(curve, origin));
        let diagonal = frame.diagonal(&points);
        let name = curve.name().to_owned();
        let length = lengths[lengths.len() - 1];
        if !(diagonal * diagonal).is_normal() || !length.is_normal() || !origin.is_finite() {
            return Err(FitError::Size { curve: name, size: diagonal });
        }
        let distance = points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
        if diagonal < FAR_OUT * distance {
            return Err(FitError::FarOut { curve: name, size: diagonal, distance });
        }
        Ok(Self { name, points, closed, frame, diagonal, lengths, reversed: false })
    }

    /// Runs a closed curve the other way; it keeps its first point.
    pub(super) fn reverse(&mut self) {
        self.points[1..].reverse();
        self.lengths = chord_parameters(&self.points, self.closed);
        self.frame = PlaneFrame::new(self.frame.origin, -self.frame.normal);
        self.reversed = !self.reversed;
    }

    /// Takes the frame's directions from the section before.
    pub(super) fn carry(&mut self, before: &PlaneFrame) {
        self.frame = before.carried(self.frame.origin, self.frame.normal);
        self.diagonal = self.frame.diagonal(&self.points);
    }

    /// Polar angles about the origin of the frame, unwrapped.
    pub(super) fn polar(&self) -> Polar {
        let count = self.points.len();
        let raw: Vec<f64> = self.points.iter().map(|p| self.frame.angle(*p)).collect();
        let step = |i: usize| {
            let turn = raw[(i + 1) % count] - raw[i];
            turn - TAU * (turn / TAU).round()
        };
        let mut angles = Vec::with_capacity(count);
        let mut angle = raw[0];
        let mut slowest = (f64::INFINITY, 0);
        let mean_pace = TAU / self.length();
        for i in 0..count {
            angles.push(angle);
            let turn = step(i);
            angle += turn;
            let pace = turn / (self.lengths[i + 1] - self.lengths[i]) / mean_pace;
            // Samples that coincide say nothing of the pace.
            if pace < slowest.0 {
                slowest = (pace, i);
            }
        }
        let once = (angle - raw[0] - TAU).abs() < 1e-6;
        let back = if slowest.0 > 0.0 && once { None } else { Some(slowest.1) };
        Polar { angles, back, clear: back.is_none() && slowest.0 >= PACE }
    }

    /// Angles in proportion to arc length: 0 to pi on an open curve; on a closed one a turn, from where `start` says.
    pub(super) fn by_arc_length(&self, start: Start, first_angle: f64) -> Vec<f64> {
        let length = self.length();
        if !self.closed {
            return self.lengths.iter().map(|s| PI * s / length).collect();
        }
        let first = match start {
            Start::FirstPoint => first_angle,
            Start::Ray => -TAU * self.ray_crossing() / length,
        };
        self.lengths[..self.points.len()].iter().map(|s| first + TAU * s / length).collect()
    }

    /// Arc length at the outermost crossing with the ray along `e1`; at the point farthest along `e1` where the ray
    /// meets nothing.
    fn ray_crossing(&self) -> f64 {
        let flat: Vec<_> = self.points.iter().map(|p| self.frame.flat(*p)).collect();
        let count = flat.len();
        let mut best = (0.0, None);
        let mut farthest = 0;
        for i in 0..count {
            let (a, b) = (flat[i], flat[(i + 1) % count]);
            if a.x > flat[farthest].x {
                farthest = i;
            }
            if (a.y <= 0.0) == (b.y <= 0.0) {
                continue;
            }
            let share = a.y / (a.y - b.y);
            let x = a.x + (b.x - a.x) * share;
            if x > best.0 {
                best = (x, Some(self.lengths[i] + (self.lengths[i + 1] - self.lengths[i]) * share));
            }
        }
        best.1.unwrap_or(self.lengths[farthest])
    }

    pub(super) fn length(&self) -> f64 {
        self.lengths[self.lengths.len() - 1]
    }

    /// Turn of the curve at each sample, radians, between the chords over two mean spacings before and behind it; 0
    /// nearer than that to an end.
    pub(super) fn turns(&self) -> Vec<f64> {
        let count = self.points.len();
        let reach = 2.0 * self.length() / (self.lengths.len() - 1) as f64;
        let turn = |i: usize| {
            let s = self.lengths[i];
            if !self.closed && (s < 0.999 * reach || s > self.length() - 0.999 * reach) {
                return 0.0;
            }
            let into = self.points[i] - self.at(s - reach);
            let out_of = self.at(s + reach) - self.points[i];
            let angle = into.angle_between(out_of);
            if angle.is_nan() { 0.0 } else { angle }
        };
        (0..count).map(turn).collect()
    }

    /// Samples at which the curve turns by more than `angle`, the sharpest of each few.
    pub(super) fn corners(&self, turns: &[f64], angle: f64) -> Vec<usize> {
        let count = self.points.len();
        let near = |i: usize| {
            (1..=4_usize).flat_map(move |d| {
                let (before, after) = ((i + count - d % count) % count, (i + d) % count);
                let wraps = self.closed || i >= d;
                let on = self.closed || i + d < count;
                [wraps.then_some(before), on.then_some(after)].into_iter().flatten()
            })
        };
        (0..count)
            .filter(|i| turns[*i] > angle)
            .filter(|i| near(*i).all(|j| turns[j] < turns[*i] || (turns[j] == turns[*i] && *i <= j)))
            .collect()
    }

    fn at(&self, s: f64) -> DVec3 {
        let length = self.length();
        let s = if self.closed { s.rem_euclid(length) } else { s.clamp(0.0, length) };
        let i = self.lengths.partition_point(|l| *l <= s).saturating_sub(1).min(self.lengths.len() - 2);
        let step = self.lengths[i + 1] - self.lengths[i];
        let share = if step > 0.0 { (s - self.lengths[i]) / step } else { 0.0 };
        self.points[i].lerp(self.points[(i + 1) % self.points.len()], share)
    }
}

fn sampled(curve: &Curve, wanted: Wanted) -> Vec<DVec3> {
    let given = curve.points();
    if wanted.sampling == Sampling::AsGiven {
        return given.to_vec();
    }
    let for_fixed = wanted.fixed.map_or(0, |j| 4 * j + 1) * if wanted.split { 2 } else { 1 };
    let arc = ArcLength::of(curve);
    let steps = arc.cumulative().windows(2).map(|pair| pair[1] - pair[0]);
    let (least, most) = steps.fold((f64::INFINITY, 0.0), |(l, m): (f64, f64), step| (l.min(step), m.max(step)));
    let enough = if wanted.split { FEWEST[1] } else { ENOUGH }.max(for_fixed);
    if most <= EVEN * least && (enough..=MOST).contains(&given.len()) {
        return given.to_vec();
    }
    let count = given.len().max(FEWEST[usize::from(wanted.split)]).max(for_fixed).min(MOST.max(for_fixed));
    let intervals = if curve.is_closed() { count } else { count - 1 } as f64;
    (0..count).map(|i| arc.point_at(arc.length() * i as f64 / intervals)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(points: &[(f64, f64)], closed: bool, sampling: Sampling) -> Samples {
        let points = points.iter().map(|p| DVec3::new(p.0, p.1, 0.0)).collect();
        let curve = Curve::new("c", points, closed).unwrap();
        Samples::of(&curve, Wanted { sampling, split: false, fixed: None }).unwrap()
    }

    /// Reference value V05.
    #[test]
    fn arc_length_angles_of_the_reference() {
        let triangle = samples(&[(0.0, 0.0), (4.0, 0.0), (0.0, 3.0)], true, Sampling::AsGiven);
        let angles = triangle.by_arc_length(Start::FirstPoint, triangle.polar().angles[0]);
        for (angle, wanted) in angles.iter().zip([-2.498091544797, -0.4036964424033, 2.214297435588]) {
            assert!((angle - wanted).abs() < 1e-12);
        }
    }

    /// The angles of reference values V02 and V03.
    #[test]
    fn polar_angles_of_the_references() {
        let octagon =
            [(2.0, 0.0), (1.5, 1.0), (0.0, 1.5), (-1.5, 1.0), (-2.0, 0.0), (-1.5, -1.0), (0.0, -1.5), (1.5, -1.0)];
        let polar = samples(&octagon, true, Sampling::AsGiven).polar();
        let wanted =
            [0.0, 0.5880026035476, PI / 2.0, 2.553590050042, PI, 3.729595257137, 4.712388980385, 5.695182703632];
        assert!(polar.clear && polar.angles.iter().zip(wanted).all(|(a, w)| (a - w).abs() < 1e-12));
        let clockwise: Vec<_> = octagon.iter().rev().copied().collect();
        assert!(samples(&clockwise, true, Sampling::AsGiven).polar().clear, "it runs about its own normal");
    }

    #[test]
    fn uneven_points_are_replaced_and_even_ones_kept() {
        let circle = |count: u32, power: f64| -> Vec<(f64, f64)> {
            (0..count)
                .map(|i| TAU * (f64::from(i) / f64::from(count)).powf(power))
                .map(|v| (v.cos(), v.sin()))
                .collect()
        };
        assert_eq!(samples(&circle(60, 1.0), true, Sampling::Even).points.len(), 60);
        assert_eq!(samples(&circle(20, 1.0), true, Sampling::Even).points.len(), 64);
        assert_eq!(samples(&circle(2000, 1.0), true, Sampling::Even).points.len(), 512);
        let uneven = samples(&circle(100, 1.5), true, Sampling::Even);
        assert_eq!(uneven.points.len(), 100);
        assert!(uneven.frame.origin.length() < 2e-3, "the centre is that of the curve");
        let given = samples(&circle(100, 1.5), true, Sampling::AsGiven);
        assert!(given.frame.origin.length() > 0.05);
    }

    #[test]
    fn kidneys_are_not_star_shaped() {
        let kidney: Vec<_> = (0..80)
            .map(|i| TAU * f64::from(i) / 80.0)
            .map(|t| (1.3 * t.cos(), 2.0 + 0.6 * t.sin()))
            .map(|(angle, radius)| (radius * angle.sin(), radius * angle.cos()))
            .collect();
        let kidney = samples(&kidney, true, Sampling::Even);
        assert!(kidney.polar().back.is_some());
        let angles = kidney.by_arc_length(Start::Ray, 0.0);
        assert!(angles.windows(2).all(|pair| pair[0] < pair[1]));
    }

    #[test]
    fn the_start_does_not_depend_on_the_first_point() {
        let shape: Vec<_> = (0..64)
            .map(|i| TAU * f64::from(i) / 64.0)
            .map(|t| (2.0 * t.cos() + 0.3, t.sin() + 0.1 * t.cos()))
            .collect();
        let mut turned = shape.clone();
        turned.rotate_left(23);
        let [one, other] = [shape, turned]
            .map(|s| samples(&s, true, Sampling::AsGiven))
            .map(|s| (s.by_arc_length(Start::Ray, 0.0), s));
        for i in 0..64 {
            let gap = other.0[i] - one.0[(i + 23) % 64];
            assert!((gap - TAU * (gap / TAU).round()).abs() < 1e-12);
        }
        let crossing = one.1.at(one.1.ray_crossing());
        assert!(one.1.frame.flat(crossing).y.abs() < 1e-12 && one.1.frame.flat(crossing).x > 1.0);
    }

    #[test]
    fn corners_are_found_once_each() {
        let square = samples(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)], true, Sampling::Even);
        let turns = square.turns();
        assert_eq!(square.corners(&turns, 1.0), vec![0, 16, 32, 48]);
        assert_eq!(square.corners(&turns, 1.6), Vec::<usize>::new());
        let open = samples(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)], false, Sampling::Even);
        assert_eq!(open.corners(&open.turns(), 1.0).len(), 1);
    }

    #[test]
    fn sizes_beyond_the_numbers_are_refused() {
        for size in [1e200, 1e-200] {
            let points = vec![DVec3::ZERO, DVec3::X * size, DVec3::Y * size];
            let curve = Curve::new("c", points, true).unwrap();
            let wanted = Wanted { sampling: Sampling::Even, split: false, fixed: None };
            assert!(matches!(Samples::of(&curve, wanted), Err(FitError::Size { .. })), "{size}");
        }
    }
}
