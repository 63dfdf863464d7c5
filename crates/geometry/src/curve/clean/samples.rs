//! Strokes as points evenly spaced, with the direction of the hand rather than of its shaking.

use glam::DVec3;

use super::{CleanError, MAX_SAMPLES};
use crate::curve::{ArcLength, Curve};

/// Samples to the distance within which strokes are the same.
pub(super) const PER_DISTANCE: f64 = 4.0;

/// A stroke at equal steps.
pub(super) struct Samples {
    pub(super) closed: bool,
    /// Metres.
    pub(super) length: f64,
    /// Metres between neighbours along the stroke.
    pub(super) step: f64,
    pub(super) points: Vec<DVec3>,
    /// Unit directions, over the distance before and behind each point; zero where the stroke goes nowhere.
    pub(super) directions: Vec<DVec3>,
}

impl Samples {
    pub(super) fn last(&self) -> usize {
        self.points.len() - 1
    }
}

/// Samples of all strokes, about a quarter of the distance apart.
///
/// # Errors
/// [`CleanError::TooFine`] where there would be too many.
pub(super) fn of(strokes: &[Curve], distance: f64) -> Result<Vec<Samples>, CleanError> {
    let total: f64 = strokes.iter().map(|stroke| ArcLength::of(stroke).length()).sum();
    // Each stroke has a few points however short it is.
    let room = MAX_SAMPLES.saturating_sub(4 * strokes.len()) as f64;
    let needed = total * PER_DISTANCE / distance;
    if needed.is_nan() || needed > room {
        return Err(CleanError::TooFine { length: total, distance, least: total * PER_DISTANCE / room.max(1.0) });
    }
    Ok(strokes.iter().map(|stroke| sampled(stroke, distance)).collect())
}

fn sampled(stroke: &Curve, distance: f64) -> Samples {
    let arc = ArcLength::of(stroke);
    let (length, closed) = (arc.length(), stroke.is_closed());
    // No more than `of` has found room for.
    let steps = ((length * PER_DISTANCE / distance).ceil() as usize).clamp(3, MAX_SAMPLES);
    let step = length / steps as f64;
    let count = if closed { steps } else { steps + 1 };
    let reach = distance.min(length / 4.0);
    let at = |k: usize| step * k as f64;
    let direction = |k: usize| (arc.point_at(at(k) + reach) - arc.point_at(at(k) - reach)).normalize_or_zero();
    Samples {
        closed,
        length,
        step,
        points: (0..count).map(|k| arc.point_at(at(k))).collect(),
        directions: (0..count).map(direction).collect(),
    }
}
