//! Rails from a closed curve to a point.

use super::neighbour::Neighbour;
use super::sweep::{Drawing, sweep};
use super::{GenerateError, GenerateOptions, Generated};
use crate::curve::Curve;

/// A cap over a closed curve that follows rails to their common point P: two open contours and one closed one, cut where
/// the two cross (thesis 6.3, Figures 6.6, 6.7), or any other number of rails.
///
/// `rails` are two or more open curves in counter-clockwise order about the direction in which they run, each from
/// `start` to P, the mean of their ends. It is [`between_closed`](super::between_closed()) with a point for the end curve:
/// section 0 lies on `start`, the last one is a pole. With smooth weights the fields between the rails meet without a
/// crease. Frames turn by the angles at which the rails leave P, about the normal of their tangents there, so that the
/// cap is smooth at P where these tangents lie in a plane; where they do not go once around it, by those of `start`.
///
/// With a `neighbour` the surface leaves `start` in its direction; a rail that does not is bent there, with a warning.
///
/// # Errors
/// [`GenerateError`] for fewer than 4 sections, fewer than 2 rails, closed rails or an open curve, an end farther from the
/// curve or from P than the snap, rails that cross or share a foot, a neighbour without directions, and where `progress`
/// asked to stop.
pub fn to_apex(
    rails: &[Curve],
    start: &Curve,
    neighbour: Option<Neighbour<'_>>,
    options: &GenerateOptions,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Generated, GenerateError> {
    let drawing = Drawing {
        rails,
        profiles: vec![start],
        closed: true,
        apex: true,
        neighbours: [neighbour, None],
        sides: [None, None],
    };
    sweep(&drawing, options, progress)
}
