//! Smoothing along a curve: bends shorter than a wavelength go, longer ones stay.

use super::{ArcLength, Curve, CurveError};
use crate::beam::{BandedFactor, Quantity};

/// Weight of a station that must not move, against 1 of the others.
const HELD: f64 = 1e9;

/// The `x` that minimises `sum w (x - m)^2 dt + l^4 integral x''^2 dt` for the values `m` at the stations.
///
/// `wave` is the wavelength that is halved, in units of the stations' parameter: `l = wave / (2 pi)`; twice that length
/// keeps 94 %, half of it 6 %. Straight lines are kept exactly, the stations may be uneven, and `held` ones keep their
/// value. Fewer than three stations have no waves and stay.
pub(crate) fn smoothed<T: Quantity>(mut values: Vec<T>, stations: &[f64], held: &[bool], wave: f64) -> Vec<T> {
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

/// Why a curve cannot be smoothed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SmoothError {
    /// A wavelength that is no length.
    #[error("the wavelength {wave} m is not a length: give a number of metres above 0")]
    Wave {
        /// The wavelength given.
        wave: f64,
    },
    /// Nothing is left of it.
    #[error("smoothing leaves nothing of the curve: give a shorter wavelength ({0})")]
    Vanishes(#[from] CurveError),
}

/// Takes bends shorter than `wave` metres off a curve: a bend of that wavelength is halved, one of twice that length
/// keeps 94 %, one of half that length 6 %.
///
/// Each coordinate is smoothed over arc length (see the penalised least squares of `smoothed`); the number of points,
/// pressure, and both ends of an open curve stay. A closed curve is continued three wavelengths beyond its start and
/// end, at most three times around, which leaves an error below 1e-5 of what is taken off.
///
/// # Errors
/// [`SmoothError`] where `wave` is not a positive number, or the curve shrinks to a point.
pub fn smooth(curve: &Curve, wave: f64) -> Result<Curve, SmoothError> {
    if !(wave.is_finite() && wave > 0.0) {
        return Err(SmoothError::Wave { wave });
    }
    let arc = ArcLength::of(curve);
    let length = arc.length();
    let share = wave / length;
    let drawn = curve.points();
    let count = drawn.len();
    let along = |k: usize| arc.cumulative()[k] / length;
    let points = if curve.is_closed() {
        let laps = (3.0 * share).ceil().clamp(1.0, 3.0) as usize;
        let total = count * (2 * laps + 1);
        let values = (0..total).map(|k| drawn[k % count]).collect();
        let stations: Vec<f64> = (0..total).map(|k| (k / count) as f64 + along(k % count)).collect();
        // The weights of `smoothed` add up to 1; over several laps each lap must weigh that much.
        let scale = (2 * laps + 1) as f64;
        let scaled = share * scale.powf(-0.25);
        smoothed(values, &stations, &vec![false; total], scaled)[laps * count..(laps + 1) * count].to_vec()
    } else {
        let stations: Vec<f64> = (0..count).map(along).collect();
        let held: Vec<bool> = (0..count).map(|k| k == 0 || k == count - 1).collect();
        let mut points = smoothed(drawn.to_vec(), &stations, &held, share);
        // Held by a large weight only; the ends are to stay to the bit.
        points[0] = drawn[0];
        points[count - 1] = drawn[count - 1];
        points
    };
    Ok(Curve::with_pressure(curve.name(), points, curve.is_closed(), curve.pressure().map(<[f64]>::to_vec))?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

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

    fn wavy_circle(points: u32, start: f64) -> Curve {
        let point = |k: u32| {
            let angle = start + std::f64::consts::TAU * f64::from(k) / f64::from(points);
            let radius = 1.0 + 0.05 * (30.0 * angle).sin();
            DVec3::new(radius * angle.cos(), radius * angle.sin(), 0.3)
        };
        Curve::new("wavy", (0..points).map(point).collect(), true).unwrap()
    }

    #[test]
    fn a_closed_curve_loses_its_waves_wherever_it_starts() {
        for start in [0.0, 1.0] {
            let smooth = smooth(&wavy_circle(400, start), 0.8).unwrap();
            let radii: Vec<f64> = smooth.points().iter().map(|p| p.truncate().length()).collect();
            let (low, high) = radii.iter().fold((f64::MAX, 0.0_f64), |(l, h), r| (l.min(*r), h.max(*r)));
            assert!(high - low < 0.004, "waves of 0.1 are gone: {low} {high}");
            // A circle is a wave as long as itself: (0.8 / 2 pi)^4 = 0.0003 of its radius go.
            assert!((low + high - 2.0).abs() < 0.01, "{low} {high}");
        }
    }

    #[test]
    fn an_open_curve_keeps_its_ends_and_a_straight_one_stays() {
        let at = |k: u32| DVec3::new(f64::from(k) * 0.01, if k.is_multiple_of(2) { 0.002 } else { -0.002 }, 1.0);
        let shaky = Curve::new("shaky", (0..=100).map(at).collect(), false).unwrap();
        let calm = smooth(&shaky, 0.1).unwrap();
        assert_eq!((calm.start(), calm.end(), calm.points().len()), (shaky.start(), shaky.end(), 101));
        assert!(calm.points()[20..80].iter().all(|p| p.y.abs() < 1e-4));
        let line = Curve::new("line", (0..9).map(|k| DVec3::X * f64::from(k * k)).collect(), false).unwrap();
        for (was, is) in line.points().iter().zip(smooth(&line, 10.0).unwrap().points()) {
            assert!(was.distance(*is) < 1e-6);
        }
    }

    #[test]
    fn a_wavelength_must_be_a_length() {
        for wave in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(smooth(&wavy_circle(9, 0.0), wave), Err(SmoothError::Wave { .. })));
        }
    }
}
