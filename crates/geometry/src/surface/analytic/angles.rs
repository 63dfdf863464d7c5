//! The angle v of a surface: the pieces over which all sections have one series each, brought to common joints.

use glam::DVec3;
use std::f64::consts::{PI, TAU};

use super::error::SurfaceError;
use crate::trigonometric::{EllipticSegment, Series, basis};

/// Joints closer than this are one, radians.
const SAME_ANGLE: f64 = 1e-9;

/// A stretch of v over which every section is one series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Piece {
    pub from: f64,
    pub to: f64,
    /// As [`EllipticSegment::local`].
    pub local: bool,
    /// Place of the piece's first coefficient in a row of coefficients.
    pub lane: usize,
    pub harmonics: usize,
}

impl Piece {
    pub fn lanes(&self) -> std::ops::Range<usize> {
        self.lane..self.lane + 2 * self.harmonics + 1
    }

    /// Fills `row` with the derivatives by v of the basis functions at `v`.
    pub fn basis(&self, v: f64, order: usize, row: &mut [f64]) {
        if !self.local {
            return basis(v, order, row);
        }
        let rate = PI / (self.to - self.from);
        basis((v - self.from) * rate, order, row);
        let scale = rate.powi(i32::try_from(order).unwrap_or(i32::MAX));
        row.iter_mut().for_each(|value| *value *= scale);
    }
}

/// All pieces in order of v.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Angles {
    pub pieces: Vec<Piece>,
    pub closed: bool,
}

impl Angles {
    /// Number of coefficients of a row.
    pub fn lanes(&self) -> usize {
        self.pieces.last().map_or(0, |piece| piece.lanes().end)
    }

    /// First and last angle.
    pub fn range(&self) -> (f64, f64) {
        (self.pieces[0].from, self.pieces[self.pieces.len() - 1].to)
    }

    /// Angles at which pieces meet; without those at which an open surface ends, and none where one series runs all
    /// the way round.
    pub fn joints(&self) -> Vec<f64> {
        let skipped = usize::from(!self.closed || (self.pieces.len() == 1 && !self.pieces[0].local));
        self.pieces.iter().skip(skipped).map(|piece| piece.from).collect()
    }

    /// The piece at `v`, and `v` wrapped around a closed surface or clamped to an open one.
    pub fn locate(&self, v: f64) -> (&Piece, f64) {
        let (from, to) = self.range();
        let v = match self.closed {
            _ if v.is_nan() => from,
            false => v.clamp(from, to),
            true if (from..to).contains(&v) => v,
            true if v.is_finite() => from + (v - from).rem_euclid(TAU),
            true => from,
        };
        let index = self.pieces.partition_point(|piece| piece.from <= v).max(1) - 1;
        (&self.pieces[index], v)
    }

    /// Common pieces of curves that are each a chain of segments, and the coefficients of each curve, one row a curve,
    /// padded to the most harmonics that any of them has in the piece.
    ///
    /// A series of v itself may be cut anywhere, so the joints are those of all curves together. A series of its own
    /// local angle can't: segments with local angles must have the same joints in all curves, but for curves that are a
    /// point, which have any joints. The error names the curve by its index.
    pub fn common(curves: &[&[EllipticSegment]], closed: bool) -> Result<(Self, Vec<DVec3>), SurfaceError> {
        let (from, to) = curves
            .iter()
            .find_map(|curve| Some((curve.first()?.from, curve.last()?.to)))
            .unwrap_or(if closed { (0.0, TAU) } else { (0.0, PI) });
        let breaks = breaks(curves, closed, from, to);
        let mut angles = Self { pieces: Vec::with_capacity(breaks.len() - 1), closed };
        for pair in breaks.windows(2) {
            let lane = angles.lanes();
            let (middle, mut local) = (0.5 * (pair[0] + pair[1]), None);
            let mut harmonics = 0;
            for (section, curve) in curves.iter().enumerate() {
                let segment = at(curve, middle, closed);
                if is_point(segment) {
                    continue;
                }
                harmonics = harmonics.max(segment.series.harmonics());
                let whole = (segment.to - segment.from - (pair[1] - pair[0])).abs() <= 2.0 * SAME_ANGLE;
                if *local.get_or_insert(segment.local) != segment.local || (segment.local && !whole) {
                    return Err(SurfaceError::LocalAngles { section, from: pair[0], to: pair[1] });
                }
            }
            let local = local.unwrap_or(false);
            angles.pieces.push(Piece { from: pair[0], to: pair[1], local, lane, harmonics });
        }
        let mut rows = Vec::with_capacity(curves.len() * angles.lanes());
        for curve in curves {
            for piece in &angles.pieces {
                let coefficients = at(curve, 0.5 * (piece.from + piece.to), closed).series.coefficients();
                let count = 2 * piece.harmonics + 1;
                // A point of many zero coefficients did not count above.
                rows.extend(coefficients.iter().take(count));
                rows.extend(std::iter::repeat_n(DVec3::ZERO, count.saturating_sub(coefficients.len())));
            }
        }
        Ok((angles, rows))
    }

    /// A row of coefficients as a chain of segments. `None` where a coefficient is not finite.
    pub fn segments(&self, row: &[DVec3]) -> Option<Vec<EllipticSegment>> {
        let segment = |piece: &Piece| {
            let series = Series::new(row[piece.lanes()].to_vec()).ok()?;
            Some(EllipticSegment { from: piece.from, to: piece.to, local: piece.local, series })
        };
        self.pieces.iter().map(segment).collect()
    }

    /// `count` places in the middle of equal steps in each piece, with the weight of their step in the whole.
    pub fn probes(&self, count: usize) -> Vec<(Piece, f64, f64)> {
        let (from, to) = self.range();
        let mut probes = Vec::with_capacity(count * self.pieces.len());
        for piece in &self.pieces {
            let step = (piece.to - piece.from) / count as f64;
            probes.extend((0..count).map(|i| (*piece, piece.from + (i as f64 + 0.5) * step, step / (to - from))));
        }
        probes
    }

    /// Root mean square over v of the length of the vectors that a row of coefficients gives: exact for one series all
    /// the way round, by the midpoint rule with `4 (J+1)` steps a piece otherwise.
    pub fn root_mean_square(&self, row: &[DVec3]) -> f64 {
        let most = self.pieces.iter().map(|piece| piece.harmonics).max().unwrap_or(0);
        let mut weights = vec![0.0; 2 * most + 1];
        let square = |(piece, v, share): (Piece, f64, f64)| {
            let lanes = piece.lanes();
            piece.basis(v, 0, &mut weights[..lanes.len()]);
            share * combined(&row[lanes], &weights).length_squared()
        };
        self.probes(4 * (most + 1)).into_iter().map(square).sum::<f64>().sqrt()
    }
}

/// Sum of coefficients times weights.
pub(crate) fn combined(coefficients: &[DVec3], weights: &[f64]) -> DVec3 {
    coefficients.iter().zip(weights).map(|(c, w)| *c * *w).sum()
}

/// Whether a segment is a single point.
pub(crate) fn is_point(segment: &EllipticSegment) -> bool {
    segment.series.coefficients()[1..].iter().all(|c| *c == DVec3::ZERO)
}

/// The angles at which pieces begin and end, ascending, from the first to the last.
fn breaks(curves: &[&[EllipticSegment]], closed: bool, from: f64, to: f64) -> Vec<f64> {
    let mut joints = Vec::new();
    for curve in curves {
        let endless = closed && curve.len() == 1 && !curve[0].local;
        if endless || curve.iter().all(is_point) {
            continue;
        }
        let wrapped = |v: f64| if closed { from + (v - from).rem_euclid(TAU) } else { v };
        joints.extend(curve.iter().skip(usize::from(!closed)).map(|segment| wrapped(segment.from)));
    }
    // The seam of a closed surface lies at a joint where there is one; at the first section's own if it is one.
    joints.retain(|v| *v - from > SAME_ANGLE && to - *v > SAME_ANGLE || closed);
    joints.sort_by(f64::total_cmp);
    joints.dedup_by(|b, a| *b - *a <= SAME_ANGLE);
    if !closed || joints.is_empty() {
        return std::iter::once(from).chain(joints).chain([to]).collect();
    }
    let first = joints[0];
    if joints.len() > 1 && first + TAU - joints[joints.len() - 1] <= SAME_ANGLE {
        joints.pop();
    }
    joints.push(first + TAU);
    joints
}

/// The segment of a curve at an angle.
fn at(curve: &[EllipticSegment], v: f64, closed: bool) -> &EllipticSegment {
    let from = curve[0].from;
    let v = if closed { from + (v - from).rem_euclid(TAU) } else { v };
    &curve[curve.partition_point(|segment| segment.from <= v).max(1) - 1]
}
