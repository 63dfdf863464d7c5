//! Where two silhouettes stand in depth: each pair moves to the middle of the other one.

use glam::DVec3;

use crate::beam::BandedFactor;

/// Length, as a share of the rails, below which depth does not follow the other view's outline: a wave of 0.38 of the
/// rails' length is halved, one of twice that keeps 94 %.
const SMOOTHING_LENGTH: f64 = 0.06;

/// Weight of a station that must not move, against 1 of the others.
const HELD: f64 = 1e9;

/// Shifts that bring the middles of both pairs together, station by station, seen along both viewing directions.
///
/// `pins` are the four points of each station, pairs at 0 and 2, 1 and 3; `normals` the viewing direction of each pair,
/// where it may move. A silhouette tells nothing of its own depth, so depth may be as smooth as it likes: the shifts
/// `m` become the `x` that minimises `sum w (x - m)^2 dt + l^4 integral x''^2 dt` with `l` of [`SMOOTHING_LENGTH`].
/// Without this a nose in the side view would push the ears of the front view back and forth. A straight slant is
/// followed exactly. `held` stations keep their own shift.
pub(super) fn centred(pins: &mut [[DVec3; 4]], normals: [Option<DVec3>; 2], stations: &[f64], held: &[bool]) {
    let shifts: Vec<[f64; 2]> = pins.iter().map(|pins| shifts(pins, normals)).collect();
    for (pair, normal) in normals.into_iter().enumerate() {
        let Some(normal) = normal else { continue };
        let wanted: Vec<f64> = shifts.iter().map(|shift| shift[pair]).collect();
        for (pins, shift) in pins.iter_mut().zip(smoothed(wanted, stations, held)) {
            pins[pair] += normal * shift;
            pins[pair + 2] += normal * shift;
        }
    }
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

fn smoothed(mut values: Vec<f64>, stations: &[f64], held: &[bool]) -> Vec<f64> {
    let count = values.len();
    if count < 3 {
        return values;
    }
    let step = |k: usize| stations[k + 1] - stations[k];
    let weight = |k: usize| if held[k] { HELD } else { 1.0 } / count as f64;
    // Second divided difference at each inner station, over it and its two neighbours.
    let bending: Vec<[f64; 3]> = (1..count - 1)
        .map(|k| {
            let (left, right) = (step(k - 1), step(k));
            // The root of its share of the integral, so that squares add up to it.
            let share = SMOOTHING_LENGTH * SMOOTHING_LENGTH * ((left + right) / 2.0).sqrt() * 2.0 / (left + right);
            [share / left, -share / left - share / right, share / right]
        })
        .collect();
    let entry = |row: usize, column: usize| {
        let first = row.max(column).saturating_sub(2);
        let bends = (first..=row.min(column)).filter_map(|k| Some((k, bending.get(k)?)));
        let bend: f64 = bends.map(|(k, b)| b[row - k] * b[column - k]).sum();
        if row == column { bend + weight(row) } else { bend }
    };
    let Some(factor) = BandedFactor::new(count, 2, entry) else { return values };
    values.iter_mut().enumerate().for_each(|(k, value)| *value *= weight(k));
    factor.solve(&mut values);
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    fn even(count: usize) -> Vec<f64> {
        (0..count).map(|k| k as f64 / (count - 1) as f64).collect()
    }

    #[test]
    fn a_slant_stays_and_a_ripple_goes() {
        let stations: Vec<f64> = even(64).into_iter().map(|t| t * (1.5 - 0.5 * t)).collect();
        let slant: Vec<f64> = stations.iter().map(|t| 0.3 - 0.2 * t).collect();
        for (was, is) in slant.iter().zip(smoothed(slant.clone(), &stations, &[false; 64])) {
            assert!((was - is).abs() < 1e-10, "{was} {is}");
        }
        let wave =
            |length: f64| -> Vec<f64> { stations.iter().map(|t| (t * std::f64::consts::TAU / length).sin()).collect() };
        let height = |values: Vec<f64>| {
            smoothed(values, &stations, &[false; 64])[16..48].iter().fold(0.0, |m: f64, v| m.max(v.abs()))
        };
        assert!(height(wave(0.1)) < 0.05, "{}", height(wave(0.1)));
        assert!(height(wave(1.0)) > 0.9, "{}", height(wave(1.0)));
    }

    #[test]
    fn a_held_station_keeps_its_value() {
        let mut held = vec![false; 32];
        held[31] = true;
        let values: Vec<f64> = (0..32).map(|k| if k % 2 == 0 { 1.0 } else { -1.0 }).collect();
        let smooth = smoothed(values, &even(32), &held);
        assert!((smooth[31] + 1.0).abs() < 1e-6);
        assert!(smooth[10].abs() < 0.05);
    }
}
