//! Where two silhouettes stand in depth: each pair moves to the middle of the other one.

use glam::DVec3;

use super::GenerateError;
use crate::curve::{Ends, smoothed};

/// Share of the rails' length below which depth does not follow the other view's outline.
///
/// Our own choice; the thesis says nothing of depth. It is to be longer than the features of a face (a nose is about a
/// seventh of a head's height, and keeps 2 % at 0.38), and shorter than the bends of a limb (two in its length at most,
/// which keep nine tenths and more). It is not critical: 0.28 and 0.48 move no point of the silhouettes of a head, a neck
/// and a leg by more than 1.7 mm.
const WAVE: f64 = 0.38;

/// Shifts that bring the middles of both pairs together, station by station, seen along both viewing directions.
///
/// `pins` are the four points of each station, pairs at 0 and 2, 1 and 3; `normals` the viewing direction of each pair,
/// where it may move. A silhouette tells nothing of its own depth, so depth may be smooth: the shifts are smoothed over
/// [`WAVE`]. Without this a nose in the side view would push the ears of the front view back and forth. A straight
/// slant is followed exactly. `held` says whether the first and the last station keep their own shift.
pub(super) fn centred(
    pins: &mut [[DVec3; 4]],
    normals: [Option<DVec3>; 2],
    stations: &[f64],
    held: [bool; 2],
) -> Result<(), GenerateError> {
    let shifts: Vec<[f64; 2]> = pins.iter().map(|pins| shifts(pins, normals)).collect();
    for (pair, normal) in normals.into_iter().enumerate() {
        let Some(normal) = normal else { continue };
        let wanted: Vec<f64> = shifts.iter().map(|shift| shift[pair]).collect();
        for (pins, shift) in pins.iter_mut().zip(smoothed(&wanted, stations, Ends::Open { held }, WAVE)?) {
            pins[pair] += normal * shift;
            pins[pair + 2] += normal * shift;
        }
    }
    Ok(())
}

/// How far each pair has to go along its normal, so that the middles of both agree in these directions.
fn shifts(pins: &[DVec3; 4], normals: [Option<DVec3>; 2]) -> [f64; 2] {
    let between = ((pins[1] + pins[3]) - (pins[0] + pins[2])) * 0.5;
    match normals {
        [Some(a), Some(b)] => {
            let cosine = a.dot(b);
            let (along_a, along_b) = (a.dot(between), b.dot(between));
            let share = 1.0 / (1.0 - cosine * cosine);
            [(along_a - cosine * along_b) * share, (cosine * along_a - along_b) * share]
        }
        [Some(a), None] => [a.dot(between), 0.0],
        [None, Some(b)] => [0.0, -b.dot(between)],
        [None, None] => [0.0; 2],
    }
}
