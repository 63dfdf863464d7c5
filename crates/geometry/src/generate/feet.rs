//! Where rails stand on a closed curve.

use glam::DVec3;

use super::{GenerateError, GenerateOptions};
use crate::curve::{ArcLength, Curve, closest};

/// Which of the curves that rails meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Which {
    Start,
    Inner,
    End,
}

impl Which {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Inner => "inner",
            Self::End => "end",
        }
    }
}

/// The feet of all rails on one curve, in the order of the rails.
#[derive(Clone, Debug)]
pub(super) struct Feet {
    /// The point of the curve closest to each rail's end.
    pub(super) points: Vec<DVec3>,
    /// Arc length of each foot behind the first one, increasing; of a closed curve at last its length. Metres.
    pub(super) offsets: Vec<f64>,
    /// Arc length of the first foot.
    pub(super) origin: f64,
    /// Distance of each rail's end from the curve, metres.
    pub(super) gaps: Vec<f64>,
}

impl Feet {
    /// Finds the feet of the rails on `curve`, the one at `side`, where they are to meet it: `at`, one point a rail.
    /// `other` is the curve at the other end, if any.
    pub(super) fn find(
        rails: &[Curve],
        at: &[DVec3],
        curve: &Curve,
        other: Option<&Curve>,
        side: Which,
        options: &GenerateOptions,
    ) -> Result<Self, GenerateError> {
        let mut points = Vec::with_capacity(rails.len());
        let mut arcs = Vec::with_capacity(rails.len());
        let mut gaps = Vec::with_capacity(rails.len());
        for (index, (rail, at)) in rails.iter().zip(at).enumerate() {
            let foot = closest(curve, *at);
            if foot.distance.is_nan() || foot.distance > options.snap {
                return Err(too_far(index, rail, curve, other, side, foot.distance, options.snap));
            }
            gaps.push(foot.distance);
            points.push(foot.point);
            arcs.push(foot.arc_length);
        }
        let length = ArcLength::of(curve).length();
        let origin = arcs.first().copied().unwrap_or(0.0);
        let mut offsets: Vec<f64> = arcs.iter().map(|arc| arc - origin).collect();
        if curve.is_closed() {
            offsets.iter_mut().for_each(|offset| *offset = offset.rem_euclid(length));
            check_turn(&offsets, length, side, curve)?;
            offsets.push(length);
        } else {
            check_path(&offsets, length, side, curve)?;
        }
        Ok(Self { points, offsets, origin, gaps })
    }
}

fn too_far(
    rail: usize,
    curve_of_rail: &Curve,
    curve: &Curve,
    other: Option<&Curve>,
    side: Which,
    distance: f64,
    snap: f64,
) -> GenerateError {
    let name = curve_of_rail.name().to_owned();
    let (start, end) = (curve_of_rail.start(), curve_of_rail.end());
    let (here, there, ends) = match side {
        Which::Start => (start, end, "starts"),
        Which::Inner => (start, end, "passes"),
        Which::End => (end, start, "ends"),
    };
    let reversed = side != Which::Inner
        && closest(curve, there).distance <= snap
        && other.is_none_or(|other| closest(other, here).distance <= snap);
    if reversed {
        return GenerateError::RailIsReversed { rail, name };
    }
    GenerateError::Gap { rail, name, ends, distance, which: side.name(), curve: curve.name().to_owned(), snap }
}

/// Checks that the feet, as arc lengths behind the first one, follow each other along an open curve.
fn check_path(offsets: &[f64], length: f64, side: Which, curve: &Curve) -> Result<(), GenerateError> {
    let (which, name) = (side.name(), || curve.name().to_owned());
    let mut order: Vec<usize> = (0..offsets.len()).collect();
    order.sort_by(|a, b| offsets[*a].total_cmp(&offsets[*b]));
    for pair in order.windows(2) {
        if offsets[pair[1]] - offsets[pair[0]] <= 1e-9 * length {
            let (first, second) = (pair[0].min(pair[1]), pair[0].max(pair[1]));
            return Err(GenerateError::SameFoot { first, second, which, curve: name() });
        }
    }
    if offsets.windows(2).all(|pair| pair[1] < pair[0]) {
        return Err(GenerateError::CurveIsReversed { which, curve: name() });
    }
    match offsets.windows(2).position(|pair| pair[1] <= pair[0]) {
        Some(first) => Err(GenerateError::Crossing { first, second: first + 1, which, curve: name() }),
        None => Ok(()),
    }
}

/// Checks that the feet, as arc lengths behind the first one, follow each other once around.
fn check_turn(offsets: &[f64], length: f64, side: Which, curve: &Curve) -> Result<(), GenerateError> {
    let (which, name) = (side.name(), || curve.name().to_owned());
    let mut order: Vec<usize> = (0..offsets.len()).collect();
    order.sort_by(|a, b| offsets[*a].total_cmp(&offsets[*b]));
    for (k, rail) in order.iter().enumerate() {
        let next = order[(k + 1) % order.len()];
        let apart = (offsets[next] - offsets[*rail]).rem_euclid(length);
        if apart.min(length - apart) <= 1e-9 * length {
            let (first, second) = ((*rail).min(next), (*rail).max(next));
            return Err(GenerateError::SameFoot { first, second, which, curve: name() });
        }
    }
    if offsets.len() > 2 && offsets[1..].windows(2).all(|pair| pair[1] < pair[0]) {
        return Err(GenerateError::CurveIsReversed { which, curve: name() });
    }
    match offsets.windows(2).position(|pair| pair[1] <= pair[0]) {
        Some(first) => Err(GenerateError::Crossing { first, second: first + 1, which, curve: name() }),
        None => Ok(()),
    }
}
