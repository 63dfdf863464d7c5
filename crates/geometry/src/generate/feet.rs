//! Where rails stand on a closed curve.

use glam::DVec3;

use super::{GenerateError, GenerateOptions};
use crate::curve::{ArcLength, Curve, closest};

/// Which of the two closed curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Start,
    End,
}

impl Side {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::End => "end",
        }
    }

    /// The end of a rail that belongs to this curve.
    fn of(self, rail: &Curve) -> DVec3 {
        match self {
            Self::Start => rail.start(),
            Self::End => rail.end(),
        }
    }
}

/// The feet of all rails on one closed curve, in cyclic order.
#[derive(Clone, Debug)]
pub(super) struct Feet {
    /// The point of the curve closest to each rail's end.
    pub(super) points: Vec<DVec3>,
    /// Arc length of each foot behind the first one, increasing; at last the length of the curve. Metres.
    pub(super) offsets: Vec<f64>,
    /// Arc length of the first foot.
    pub(super) origin: f64,
    /// Distance of each rail's end from the curve, metres.
    pub(super) gaps: Vec<f64>,
}

impl Feet {
    /// Finds the feet of the rails' ends on `curve`, the closed curve at `side`; `other` is the one at the other side.
    pub(super) fn find(
        rails: &[Curve],
        curve: &Curve,
        other: &Curve,
        side: Side,
        options: &GenerateOptions,
    ) -> Result<Self, GenerateError> {
        let mut points = Vec::with_capacity(rails.len());
        let mut arcs = Vec::with_capacity(rails.len());
        let mut gaps = Vec::with_capacity(rails.len());
        for (index, rail) in rails.iter().enumerate() {
            let foot = closest(curve, side.of(rail));
            if foot.distance.is_nan() || foot.distance > options.snap {
                return Err(too_far(index, rail, curve, other, side, foot.distance, options.snap));
            }
            gaps.push(foot.distance);
            points.push(foot.point);
            arcs.push(foot.arc_length);
        }
        let length = ArcLength::of(curve).length();
        let origin = arcs.first().copied().unwrap_or(0.0);
        let mut offsets: Vec<f64> = arcs.iter().map(|arc| (arc - origin).rem_euclid(length)).collect();
        check_order(&offsets, length, side, curve)?;
        offsets.push(length);
        Ok(Self { points, offsets, origin, gaps })
    }
}

fn too_far(
    rail: usize,
    curve_of_rail: &Curve,
    curve: &Curve,
    other: &Curve,
    side: Side,
    distance: f64,
    snap: f64,
) -> GenerateError {
    let name = curve_of_rail.name().to_owned();
    let (here, there) = (
        side.of(curve_of_rail),
        match side {
            Side::Start => Side::End.of(curve_of_rail),
            Side::End => Side::Start.of(curve_of_rail),
        },
    );
    if closest(curve, there).distance <= snap && closest(other, here).distance <= snap {
        return GenerateError::RailIsReversed { rail, name };
    }
    let ends = if side == Side::Start { "starts" } else { "ends" };
    GenerateError::Gap { rail, name, ends, distance, which: side.name(), curve: curve.name().to_owned(), snap }
}

/// Checks that the feet, as arc lengths behind the first one, follow each other once around.
fn check_order(offsets: &[f64], length: f64, side: Side, curve: &Curve) -> Result<(), GenerateError> {
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
