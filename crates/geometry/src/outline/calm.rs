//! Calming: the steps of the pixels go, corners stay.

use glam::DVec3;

use super::OutlineError;
use super::corner::{corners, sharpened};
use crate::curve::{Curve, simplified, smooth};

/// Shortest arm by which corners are told, pixels: below it the steps of pixels are corners.
const SHORTEST_ARM: f64 = 6.0;

/// Largest share of a piece's length that is smoothed away, so that small holes keep their size.
const LONGEST_WAVE: f64 = 0.25;

/// How an outline is calmed. Lengths are those of its points: pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Calming {
    /// Bends of this length are halved ([`smooth`]); 0 smooths nothing. No more than a quarter of the length between
    /// two corners is.
    pub wave: f64,
    /// Where the outline turns by more, it has a corner, radians; see [`corners`], with arms of the wavelength and of 6
    /// pixels at least.
    pub corner_angle: f64,
    /// Largest distance of the smoothed points from the simplified outline; 0 keeps all.
    pub tolerance: f64,
}

/// A closed outline without the steps of its pixels: corners are put where their sides meet and stay, what lies between them is
/// smoothed, and points that are not needed for the tolerance go, corners never. The first point stays the first where
/// it is kept.
///
/// # Errors
/// [`OutlineError::Open`] for an open curve, [`OutlineError::Amount`] for lengths that are none; [`OutlineError::Smooth`] and [`OutlineError::Simplify`] where
/// coordinates are beyond the range of a double.
pub fn calmed(curve: &Curve, calming: &Calming) -> Result<Curve, OutlineError> {
    let Calming { wave, corner_angle, tolerance } = *calming;
    for (what, value) in [("smoothing", wave), ("tolerance", tolerance)] {
        if !(value.is_finite() && value >= 0.0) {
            return Err(OutlineError::Amount { what, value });
        }
    }
    if !curve.is_closed() {
        return Err(OutlineError::Open { name: curve.name().to_owned() });
    }
    let arm = wave.max(SHORTEST_ARM);
    let found = corners(curve, arm, corner_angle);
    let (calm, kept) = match found.first() {
        None => (smoothed(curve, wave)?, Vec::new()),
        Some(first) => between(curve, &found, *first, arm, wave)?,
    };
    if tolerance == 0.0 {
        return Ok(calm);
    }
    Ok(simplified(&calm, tolerance, &kept, &|_| true)?)
}

/// Smooths a curve that has no corner.
fn smoothed(curve: &Curve, wave: f64) -> Result<Curve, OutlineError> {
    let wave = wave.min(LONGEST_WAVE * crate::curve::ArcLength::of(curve).length());
    Ok(if wave > 0.0 { smooth(curve, wave)? } else { curve.clone() })
}

/// Smooths the pieces between corners, and says where these are then. Both as the curve runs, from its first point.
fn between(
    curve: &Curve,
    corners: &[usize],
    first: usize,
    arm: f64,
    wave: f64,
) -> Result<(Curve, Vec<usize>), OutlineError> {
    let count = curve.points().len();
    let places: Vec<DVec3> = corners.iter().map(|corner| sharpened(curve, *corner, arm)).collect();
    let mut points: Vec<DVec3> = Vec::with_capacity(count);
    let mut kept = Vec::with_capacity(corners.len());
    // The first corner begins the curve; where the first point is now is remembered.
    let mut beginning = 0;
    for (number, corner) in corners.iter().enumerate() {
        let next = (number + 1) % corners.len();
        let end = if next == 0 { first + count } else { corners[next] };
        kept.push(points.len());
        let (from, to) = (places[number], places[next]);
        // Beside a corner that was put farther out, points lie on what was cut off.
        let moved = [from.distance(curve.points()[*corner]), to.distance(curve.points()[end % count])];
        let inner: Vec<(usize, DVec3)> = (corner + 1..end).map(|k| (k, curve.points()[k % count])).collect();
        let clear = |(_, p): &(usize, DVec3)| p.distance(from) > 2.0 * moved[0] && p.distance(to) > 2.0 * moved[1];
        let inner: Vec<(usize, DVec3)> = inner.into_iter().filter(clear).collect();
        if let Some(at) = inner.iter().position(|(k, _)| *k >= count) {
            beginning = points.len() + 1 + at;
        } else if end >= count {
            beginning = points.len() + 1 + inner.len();
        }
        let piece = std::iter::once(from).chain(inner.iter().map(|(_, p)| *p)).chain([to]).collect();
        let calm = match Curve::new(curve.name(), piece, false) {
            Ok(piece) => smoothed(&piece, wave)?.points().to_vec(),
            // Two corners at one place.
            Err(_) => vec![from, to],
        };
        points.extend_from_slice(&calm[..calm.len() - 1]);
    }
    let total = points.len();
    let beginning = beginning % total;
    points.rotate_left(beginning);
    let mut kept: Vec<usize> = kept.into_iter().map(|k| (k + total - beginning) % total).collect();
    kept.sort_unstable();
    let calm = Curve::new(curve.name(), points, true)?;
    // Points that fell together are gone, and with them the count.
    let kept = if calm.points().len() == total { kept } else { Vec::new() };
    Ok((calm, kept))
}

#[cfg(test)]
mod tests;
