//! Segments joined with continuity: one formulation for every case of the thesis (3.2).
//!
//! Least squares at the samples of each segment, with the values and derivatives at the joints as linear equality
//! constraints. The eliminations of the thesis (3.16 to 3.32, 3.36 to 3.42) are this problem solved by hand for one
//! joint, for joints at 0 and pi, and for two joints; the general case of two joints, for which the thesis takes a
//! nonlinear optimiser, is linear as well. No angle is singular here.

use super::least_squares::{constrained, design};
use super::options::{Continuity, LocalAngles};
use super::section::{EllipticSection, EllipticSegment};
use super::series::{Series, SeriesError, basis};
use glam::DVec3;
use nalgebra::DMatrix;
use std::f64::consts::{PI, TAU};

/// Condition number above which a segment gets an angle of its own.
const ILL_CONDITIONED: f64 = 1e6;
/// Samples this near to a joint, radians, lie on it.
pub(super) const ON_JOINT: f64 = 1e-9;

/// The angle ranges of a section's segments, and how they meet.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    pub(super) closed: bool,
    /// One more than segments.
    pub(super) ends: Vec<f64>,
    /// How each segment meets the one before it; the first none where it meets nothing (open sections, and closed ones
    /// of a single series, which is periodic by itself).
    pub(super) joins: Vec<Option<Continuity>>,
}

impl Layout {
    pub(super) fn single(closed: bool) -> Self {
        Self { closed, ends: vec![0.0, if closed { TAU } else { PI }], joins: vec![None] }
    }

    /// From joints in ascending order, those of a closed section within one turn.
    pub(super) fn split(closed: bool, joints: &[(f64, Continuity)]) -> Self {
        let Some((first, last)) = joints.first().zip(joints.last()) else { return Self::single(closed) };
        let angles = joints.iter().map(|(angle, _)| *angle);
        let joins = joints.iter().map(|(_, continuity)| Some(*continuity));
        debug_assert!(!closed || last.0 < first.0 + TAU);
        if closed {
            Self { closed, ends: angles.chain([first.0 + TAU]).collect(), joins: joins.collect() }
        } else {
            Self {
                closed,
                ends: [0.0].into_iter().chain(angles).chain([PI]).collect(),
                joins: [None].into_iter().chain(joins).collect(),
            }
        }
    }

    pub(super) fn count(&self) -> usize {
        self.joins.len()
    }

    fn span(&self, segment: usize) -> f64 {
        self.ends[segment + 1] - self.ends[segment]
    }

    /// How the segment meets the next one.
    fn join_behind(&self, segment: usize) -> Option<Continuity> {
        match self.joins.get(segment + 1) {
            Some(join) => *join,
            None if self.closed => self.joins[0],
            None => None,
        }
    }

    /// Fewest harmonics with which both ends of a segment can be tied: as many unknowns as constraints, one at least.
    pub(super) fn fewest_harmonics(&self, segment: usize) -> usize {
        let ties = [self.joins[segment], self.join_behind(segment)];
        let constraints: usize = ties.into_iter().flatten().map(|join| join.order() + 1).sum();
        (constraints / 2).max(1)
    }

    /// Whether the segment counts its own angle, with this many harmonics.
    pub(super) fn local(&self, segment: usize, harmonics: usize, choice: LocalAngles) -> bool {
        if self.closed && self.count() == 1 {
            // A whole turn in the section's angle is periodic and could have no corner.
            return self.joins[0].is_some();
        }
        match choice {
            LocalAngles::Never => false,
            LocalAngles::Always => self.count() > 1,
            LocalAngles::Auto => {
                let span = self.span(segment);
                self.count() > 1 && span < PI && condition(span, harmonics) > ILL_CONDITIONED
            }
        }
    }

    /// Estimated condition number of the basis of a segment in the angle it counts.
    pub(super) fn condition(&self, segment: usize, harmonics: usize, local: bool) -> f64 {
        condition(if local { PI } else { self.span(segment) }, harmonics)
    }

    /// The samples of each segment, as index and angle within its range. Samples on a joint belong to both segments, at
    /// the very angle of the joint: a little off it, one of them would be beyond its range, where it may run far away.
    pub(super) fn assign(&self, angles: &[f64]) -> Vec<Vec<(usize, f64)>> {
        let mut samples = vec![Vec::new(); self.count()];
        let (from, to) = (self.ends[0], self.ends[self.count()]);
        let joined = self.joins[0].is_some();
        for (i, angle) in angles.iter().enumerate() {
            let mut v = if self.closed { from + (angle - from).rem_euclid(TAU) } else { angle.clamp(from, to) };
            if self.closed && v > to - ON_JOINT {
                v = from;
            }
            let segment = self.ends[1..self.count()].partition_point(|end| *end <= v + ON_JOINT);
            let on_first_end = (v - self.ends[segment]).abs() <= ON_JOINT && (segment > 0 || joined);
            if on_first_end {
                v = self.ends[segment];
            }
            samples[segment].push((i, v));
            if on_first_end && segment > 0 {
                samples[segment - 1].push((i, v));
            } else if on_first_end {
                samples[self.count() - 1].push((i, to));
            }
        }
        samples
    }
}

/// The angle of the joint on which an angle lies, else the angle.
pub(super) fn on_joint(angle: f64, section: &EllipticSection) -> f64 {
    let near = |joint: &f64| {
        let gap = angle - joint;
        let gap = if section.is_closed() { gap - TAU * (gap / TAU).round() } else { gap };
        gap.abs() <= ON_JOINT
    };
    let segments = section.segments();
    // One series in the section's own angle is periodic and has no joint, one in its own angle begins and ends at one.
    let closed_up = section.is_closed() && (segments.len() > 1 || segments[0].local);
    segments.iter().skip(usize::from(!closed_up)).map(|segment| segment.from).find(near).unwrap_or(angle)
}

/// Estimate of the condition number of the basis of `harmonics` harmonics over a range of angles, radians:
/// `cot(range/8)^(2J)`, the asymptotic of the discrete prolate spheroidal sequences up to a factor; within a factor of
/// 3 of the true one for J from 3 to 15 and ranges from pi/4 to 2 pi.
pub(super) fn condition(range: f64, harmonics: usize) -> f64 {
    let exponent = i32::try_from(2 * harmonics).unwrap_or(i32::MAX);
    (range / 8.0).tan().recip().max(1.0).powi(exponent)
}

/// A solved section, before it is moved back to its place.
pub(super) struct Solved {
    pub(super) segments: Vec<EllipticSegment>,
    /// Distance of the curve from each sample, in the units of the right side.
    pub(super) distances: Vec<f64>,
}

/// Everything a section is solved from.
pub(super) struct Problem<'a> {
    pub(super) layout: &'a Layout,
    /// Samples of each segment, from [`Layout::assign`].
    pub(super) samples: &'a [Vec<(usize, f64)>],
    /// A row of x, y, z for each sample.
    pub(super) right: &'a DMatrix<f64>,
}

impl Problem<'_> {
    fn blank(&self, segment: usize, local: bool) -> EllipticSegment {
        let (from, to) = (self.layout.ends[segment], self.layout.ends[segment + 1]);
        EllipticSegment { from, to, local, series: Series::point(DVec3::ZERO) }
    }

    /// All segments at once. None where the numbers leave their range.
    pub(super) fn together(&self, harmonics: &[usize], local: &[bool]) -> Result<Solved, SeriesError> {
        let count = self.layout.count();
        let widths: Vec<usize> = harmonics.iter().map(|j| 2 * j + 1).collect();
        let offsets: Vec<usize> = widths
            .iter()
            .scan(0, |sum, width| {
                *sum += width;
                Some(*sum - width)
            })
            .collect();
        let unknowns: usize = widths.iter().sum();
        let blanks: Vec<EllipticSegment> = (0..count).map(|s| self.blank(s, local[s])).collect();

        let rows: usize = self.samples.iter().map(Vec::len).sum();
        let (mut a, mut f) = (DMatrix::zeros(rows, unknowns), DMatrix::zeros(rows, 3));
        let mut row = 0;
        for segment in 0..count {
            let block = self.rows(&blanks[segment], segment, harmonics[segment]);
            a.view_mut((row, offsets[segment]), block.shape()).copy_from(&block);
            for (i, _) in &self.samples[segment] {
                f.set_row(row, &self.right.row(*i));
                row += 1;
            }
        }

        let mut ties: Vec<Vec<f64>> = Vec::new();
        for segment in 0..count {
            let Some(join) = self.layout.joins[segment] else { continue };
            let before = (segment + count - 1) % count;
            for order in 0..=join.order() {
                let mut tie = vec![0.0; unknowns];
                let mut add = |s: usize, angle: f64, sign: f64| {
                    let end = end_row(&blanks[s], angle, order, harmonics[s]);
                    for (sum, value) in tie[offsets[s]..].iter_mut().zip(end) {
                        *sum += sign * value;
                    }
                };
                add(segment, self.layout.ends[segment], 1.0);
                add(before, self.layout.ends[before + 1], -1.0);
                ties.push(tie);
            }
        }
        let b = DMatrix::from_fn(ties.len(), unknowns, |i, j| ties[i][j]);
        let d = DMatrix::zeros(ties.len(), 3);
        // Ties to nothing but one another never contradict: zero meets them.
        let solution = constrained(&a, &f, b, d).unwrap_or_else(|| DMatrix::zeros(unknowns, 3));
        let segments = blanks
            .into_iter()
            .enumerate()
            .map(|(s, blank)| {
                let rows = solution.rows(offsets[s], widths[s]);
                Ok(EllipticSegment { series: series(&rows.into_owned())?, ..blank })
            })
            .collect::<Result<Vec<_>, SeriesError>>()?;
        Ok(self.measured(segments))
    }

    /// One segment tied to those already solved: at its beginning to the end of `before`, at its end to the beginning
    /// of `behind`. Samples at tied ends do not count. `Ok(None)` where the ties contradict one another.
    pub(super) fn tied(
        &self,
        segment: usize,
        harmonics: usize,
        local: bool,
        before: Option<&EllipticSegment>,
        behind: Option<&EllipticSegment>,
    ) -> Result<Option<(EllipticSegment, Vec<f64>)>, SeriesError> {
        let blank = self.blank(segment, local);
        let (from, to) = (blank.from, blank.to);
        let mut ties: Vec<(Vec<f64>, DVec3)> = Vec::new();
        let ends = [
            (before.map(|s| (s, s.to)), from, self.layout.joins[segment]),
            (behind.map(|s| (s, s.from)), to, self.layout.join_behind(segment)),
        ];
        for (other, angle, join) in ends {
            let (Some((other, there)), Some(join)) = (other, join) else { continue };
            let values = other.derivatives::<3>(there);
            for (order, value) in values.into_iter().enumerate().take(join.order() + 1) {
                ties.push((end_row(&blank, angle, order, harmonics), value));
            }
        }
        let free: Vec<(usize, f64)> = self.samples[segment]
            .iter()
            .filter(|(_, v)| !(before.is_some() && (v - from).abs() <= ON_JOINT))
            .filter(|(_, v)| !(behind.is_some() && (v - to).abs() <= ON_JOINT))
            .copied()
            .collect();
        let angles: Vec<f64> = free.iter().map(|(_, v)| blank.series_angle(*v)).collect();
        let a = design(&angles, harmonics);
        let f = DMatrix::from_fn(free.len(), 3, |i, c| self.right[(free[i].0, c)]);
        let b = DMatrix::from_fn(ties.len(), 2 * harmonics + 1, |i, j| ties[i].0[j]);
        let d = DMatrix::from_fn(ties.len(), 3, |i, c| ties[i].1[c]);
        let Some(solution) = constrained(&a, &f, b, d) else { return Ok(None) };
        let solved = EllipticSegment { series: series(&solution)?, ..blank };
        let distances =
            self.samples[segment].iter().map(|(i, v)| self.distance(*i, solved.derivatives::<1>(*v)[0])).collect();
        Ok(Some((solved, distances)))
    }

    pub(super) fn measured(&self, segments: Vec<EllipticSegment>) -> Solved {
        let mut distances = vec![0.0_f64; self.right.nrows()];
        for (segment, samples) in segments.iter().zip(self.samples) {
            for (i, v) in samples {
                distances[*i] = distances[*i].max(self.distance(*i, segment.derivatives::<1>(*v)[0]));
            }
        }
        Solved { segments, distances }
    }

    fn distance(&self, sample: usize, point: DVec3) -> f64 {
        let row = self.right.row(sample);
        DVec3::new(row[0], row[1], row[2]).distance(point)
    }

    fn rows(&self, blank: &EllipticSegment, segment: usize, harmonics: usize) -> DMatrix<f64> {
        let angles: Vec<f64> = self.samples[segment].iter().map(|(_, v)| blank.series_angle(*v)).collect();
        design(&angles, harmonics)
    }
}

/// The derivative of the given order with respect to the section's angle, as a row over the coefficients.
fn end_row(blank: &EllipticSegment, angle: f64, order: usize, harmonics: usize) -> Vec<f64> {
    let mut row = vec![0.0; 2 * harmonics + 1];
    basis(blank.series_angle(angle), order, &mut row);
    let scale = blank.rate().powi(i32::try_from(order).unwrap_or(i32::MAX));
    row.iter_mut().for_each(|value| *value *= scale);
    row
}

pub(super) fn series(solution: &DMatrix<f64>) -> Result<Series, SeriesError> {
    Series::new(solution.row_iter().map(|row| DVec3::new(row[0], row[1], row[2])).collect())
}
