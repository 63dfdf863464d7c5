//! Smoothing of what varies along the rails, station by station.

use crate::beam::{BandedFactor, Quantity};

/// Weight of a station that must not move, against 1 of the others.
const HELD: f64 = 1e9;

/// The `x` that minimises `sum w (x - m)^2 dt + l^4 integral x''^2 dt` for the values `m` at the stations.
///
/// `wave` is the wavelength that is halved, in units of the stations' parameter: `l = wave / (2 pi)`; twice that length
/// keeps 94 %, half of it 6 %. Straight lines are kept exactly, the stations may be uneven, and `held` ones keep their
/// value. Fewer than three stations have no waves and stay.
pub(super) fn smoothed<T: Quantity>(mut values: Vec<T>, stations: &[f64], held: &[bool], wave: f64) -> Vec<T> {
    let count = values.len();
    if count < 3 {
        return values;
    }
    let length = wave / std::f64::consts::TAU;
    let step = |k: usize| stations[k + 1] - stations[k];
    let weight = |k: usize| if held[k] { HELD } else { 1.0 } / count as f64;
    // Second divided difference at each inner station, over it and its two neighbours.
    let bending: Vec<[f64; 3]> = (1..count - 1)
        .map(|k| {
            let (left, right) = (step(k - 1), step(k));
            // The root of its share of the integral, so that squares add up to it.
            let share = length * length * ((left + right) / 2.0).sqrt() * 2.0 / (left + right);
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
    values.iter_mut().enumerate().for_each(|(k, value)| *value = *value * weight(k));
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
        for (was, is) in slant.iter().zip(smoothed(slant.clone(), &stations, &[false; 64], 0.4)) {
            assert!((was - is).abs() < 1e-10, "{was} {is}");
        }
        let wave =
            |length: f64| -> Vec<f64> { stations.iter().map(|t| (t * std::f64::consts::TAU / length).sin()).collect() };
        let height = |values: Vec<f64>| {
            smoothed(values, &stations, &[false; 64], 0.4)[16..48].iter().fold(0.0, |m: f64, v| m.max(v.abs()))
        };
        assert!(height(wave(0.1)) < 0.05, "{}", height(wave(0.1)));
        assert!(height(wave(1.0)) > 0.9, "{}", height(wave(1.0)));
    }

    #[test]
    fn a_held_station_keeps_its_value() {
        let mut held = vec![false; 32];
        held[31] = true;
        let values: Vec<f64> = (0..32).map(|k| if k % 2 == 0 { 1.0 } else { -1.0 }).collect();
        let smooth = smoothed(values, &even(32), &held, 0.4);
        assert!((smooth[31] + 1.0).abs() < 1e-6);
        assert!(smooth[10].abs() < 0.05);
    }
}
