//! The smoothing spline: penalised least squares in one variable.

use super::cells::Cells;
use crate::beam::{BandedFactor, Quantity};

/// Cells to a wavelength, or to the span where that is shorter. It keeps the condition of the system below 1e8 and
/// takes 0.04 % off a bend of the wavelength.
const FINENESS: f64 = 64.0;

/// Largest stiffness of a closed curve, in its length to the fourth: a bend as long as the curve keeps 6e-8 at it, and
/// above it the mean value is lost to rounding.
const STIFFEST_CLOSED: f64 = 1e4;

/// What lies beyond the first and the last station.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Ends {
    /// Nothing. `held` says whether the first and the last value stay, to the bit.
    Open {
        /// The first, the last.
        held: [bool; 2],
    },
    /// The first station again, at its parameter plus the period.
    Closed {
        /// In units of the stations' parameter.
        period: f64,
    },
}

/// The stations do not rise, or numbers are beyond the range of a double.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NotSolvable;

/// The function `x` that minimises `integral (x - m)^2 dt + l^4 integral x''^2 dt` for the values `m` at the stations,
/// at the stations: the cubic smoothing spline (E. T. Whittaker 1923, "On a new method of graduation", Proc. Edinburgh
/// Math. Soc. 41; C. H. Reinsch 1967, "Smoothing by spline functions", Numer. Math. 10).
///
/// `wave` is the wavelength that is halved, in units of the stations' parameter: `l = wave / (2 pi)`; twice that length
/// keeps 94 %, half of it 6 %. The first integral is the trapezoid rule's, so that the stations may be uneven. Fewer than
/// three stations have no waves and stay.
///
/// Method: Reinsch's banded system for the second derivatives, after the chord is taken off, so that straight lines are
/// kept to rounding however large `wave` is. Stations denser than 1/64 of `wave` or of the span, whichever is less, are
/// averaged first, and read off the C2 spline through the averages, which alters what is kept of a bend of the
/// wavelength by 0.0004 of it, and of shorter ones by less of their height. Rounding adds at most about 1e-8 of the
/// largest distance from the chord.
///
/// # Errors
/// [`NotSolvable`], see there.
pub(crate) fn smoothed<T: Quantity>(
    values: &[T],
    stations: &[f64],
    ends: Ends,
    wave: f64,
) -> Result<Vec<T>, NotSolvable> {
    let count = values.len();
    if count < 3 || stations.len() != count {
        return if stations.len() == count { Ok(values.to_vec()) } else { Err(NotSolvable) };
    }
    let span = match ends {
        Ends::Open { .. } => stations[count - 1] - stations[0],
        Ends::Closed { period } => period,
    };
    let times: Vec<f64> = stations.iter().map(|t| (t - stations[0]) / span).collect();
    let rises = times.windows(2).all(|pair| pair[0] <= pair[1]) && times.iter().all(|t| (0.0..=1.0).contains(t));
    let wave = wave / span;
    if !(rises && wave > 0.0) {
        return Err(NotSolvable);
    }
    let trend = |t: f64| match ends {
        Ends::Open { .. } => values[0] * (1.0 - t) + values[count - 1] * t,
        Ends::Closed { .. } => values[0],
    };

    let cells = Cells::gather(&times, ends, wave.min(1.0) / FINENESS);
    let mut means = vec![T::default(); cells.times.len()];
    for ((value, time), (cell, _, share)) in values.iter().zip(&times).zip(&cells.members) {
        means[*cell] = means[*cell] + (*value - trend(*time)) * *share;
    }
    let stiffness = (wave / std::f64::consts::TAU).powi(4);
    let spline = Spline::fit(&cells, means, ends, stiffness)?;
    let smooth = |k: usize| {
        let (cell, time, share) = cells.members[k];
        // A station held, or alone in its cell, is a knot of the spline.
        let bend = if share == 1.0 { spline.values[cell] } else { spline.at(cell, time) };
        bend + trend(times[k])
    };
    let result: Vec<T> = (0..count).map(smooth).collect();
    if result.iter().all(|value| value.finite()) { Ok(result) } else { Err(NotSolvable) }
}

/// A cubic spline by its values and second derivatives at the knots: natural, or periodic.
struct Spline<T> {
    times: Vec<f64>,
    steps: Vec<f64>,
    values: Vec<T>,
    moments: Vec<T>,
}

impl<T: Quantity> Spline<T> {
    /// Fits the means of the cells.
    fn fit(cells: &Cells, means: Vec<T>, ends: Ends, stiffness: f64) -> Result<Self, NotSolvable> {
        let closed = matches!(ends, Ends::Closed { .. });
        // The cyclic system needs five knots; fewer ones go around several times, with the same result.
        let laps = if closed { 5_usize.div_ceil(means.len()) } else { 1 };
        let times: Vec<f64> = (0..laps).flat_map(|lap| cells.times.iter().map(move |t| t + lap as f64)).collect();
        let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        if closed {
            steps.push(times[0] + laps as f64 - times[times.len() - 1]);
        }
        let compliances: Vec<f64> = cells.weights.iter().map(|weight| weight.map_or(0.0, f64::recip)).collect();
        let stiffness = if closed { stiffness.min(STIFFEST_CLOSED) } else { stiffness };
        let system = Reinsch::new(&steps, compliances.repeat(laps), closed, stiffness);
        let (values, moments) = system.solve(means.repeat(laps)).ok_or(NotSolvable)?;
        Ok(Self { times, steps, values, moments })
    }

    /// The value at `time`, which lies in the cell of knot `knot`. Beyond the ends the spline goes on straight.
    fn at(&self, knot: usize, time: f64) -> T {
        let (count, closed) = (self.values.len(), self.steps.len() == self.values.len());
        let offset = time - self.times[knot];
        let (left, from_left) = match offset >= 0.0 {
            true if closed || knot + 1 < count => (knot, offset),
            false if closed || knot > 0 => {
                let left = (knot + count - 1) % count;
                (left, self.steps[left] + offset)
            }
            _ => return self.values[knot] + self.slope_at_end(knot) * offset,
        };
        let (right, step) = ((left + 1) % count, self.steps[left]);
        let b = from_left / step;
        let a = 1.0 - b;
        let bulge = self.moments[left] * (a * a * a - a) + self.moments[right] * (b * b * b - b);
        self.values[left] * a + self.values[right] * b + bulge * (step * step / 6.0)
    }

    /// First derivative at the first or last knot of an open spline, where the second one is zero.
    fn slope_at_end(&self, knot: usize) -> T {
        let (left, inner, sign) = if knot == 0 { (0, 1, -1.0) } else { (knot - 1, knot - 1, 1.0) };
        match self.steps.get(left) {
            Some(step) => {
                (self.values[left + 1] - self.values[left]) * step.recip() + self.moments[inner] * (sign * step / 6.0)
            }
            None => T::default(),
        }
    }
}

/// Reinsch's system `(R + stiffness Q' D Q) g = Q' m` for the second derivatives `g`, where `Q'` takes second divided
/// differences, `R` is the Gram matrix of hat functions and `D` holds one over the weights (0 where held). It is banded,
/// and cyclic for closed curves.
struct Reinsch {
    /// Share of `R` and of `Q' D Q`, divided by the larger of 1 and the stiffness: no stiffness overflows.
    shares: (f64, f64),
    steps: Vec<f64>,
    /// Second divided difference at each knot, over it and its neighbours.
    bends: Vec<[f64; 3]>,
    compliances: Vec<f64>,
    closed: bool,
}

impl Reinsch {
    fn new(steps: &[f64], compliances: Vec<f64>, closed: bool, stiffness: f64) -> Self {
        let count = compliances.len();
        let bends = (0..count)
            .map(|k| {
                if !closed && (k == 0 || k + 1 == count) {
                    return [0.0; 3];
                }
                let (left, right) = (steps[(k + count - 1) % count].recip(), steps[k].recip());
                [left, -left - right, right]
            })
            .collect();
        let shares = if stiffness > 1.0 { (stiffness.recip(), 1.0) } else { (1.0, stiffness) };
        Self { shares, steps: steps.to_vec(), bends, compliances, closed }
    }

    /// The entry for a knot and the one `away` (0 to 2) behind it.
    fn coupling(&self, knot: usize, away: usize) -> f64 {
        let count = self.compliances.len();
        let at = |ahead: usize| (knot + ahead) % count;
        let (one, other) = (self.bends[knot], self.bends[at(away)]);
        let bend: f64 =
            (away..3).map(|k| one[k] * other[k - away] * self.compliances[(knot + count + k - 1) % count]).sum();
        let gram = match away {
            0 => (self.steps[(knot + count - 1) % count] + self.steps[knot]) / 3.0,
            1 => self.steps[knot] / 6.0,
            _ => 0.0,
        };
        self.shares.0 * gram + self.shares.1 * bend
    }

    /// The entry for two knots of a cyclic system.
    fn cyclic(&self, row: usize, column: usize) -> f64 {
        let count = self.compliances.len();
        match ((row + count - column) % count, (column + count - row) % count) {
            (ahead @ 0..=2, _) => self.coupling(column, ahead),
            (_, behind @ 1..=2) => self.coupling(row, behind),
            _ => 0.0,
        }
    }

    /// Values and second derivatives at the knots; none where the system is not positive definite in a double.
    fn solve<T: Quantity>(&self, mut values: Vec<T>) -> Option<(Vec<T>, Vec<T>)> {
        let count = values.len();
        let neighbours = |k: usize| [(k + count - 1) % count, k, (k + 1) % count];
        let mut bends: Vec<T> = (0..count)
            .map(|k| {
                let terms = neighbours(k).into_iter().zip(self.bends[k]).map(|(at, share)| values[at] * share);
                terms.fold(T::default(), |sum, term| sum + term)
            })
            .collect();
        if self.closed {
            self.solve_cyclic(&mut bends)?;
        } else if count > 2 {
            let inner = &mut bends[1..count - 1];
            let factor = BandedFactor::new(inner.len(), 2, |row, column| self.coupling(column + 1, row - column))?;
            factor.solve(inner);
        }
        for (k, bend) in bends.iter().enumerate() {
            for (at, share) in neighbours(k).into_iter().zip(self.bends[k]) {
                values[at] = values[at] - *bend * (self.shares.1 * share * self.compliances[at]);
            }
        }
        bends.iter_mut().for_each(|bend| *bend = *bend * self.shares.0);
        Some((values, bends))
    }

    /// Solves the cyclic system: the band without the last two knots, and a two by two system for these.
    fn solve_cyclic<T: Quantity>(&self, right: &mut [T]) -> Option<()> {
        let inner = right.len() - 2;
        let factor = BandedFactor::new(inner, 2, |row, column| self.coupling(column, row - column))?;
        let border = [inner, inner + 1].map(|knot| (0..inner).map(|row| self.cyclic(row, knot)).collect::<Vec<f64>>());
        let (band, last) = right.split_at_mut(inner);
        factor.solve(band);
        let mut responses = border.clone();
        responses.iter_mut().for_each(|response| factor.solve(response));
        let left = |k: usize, l: usize| {
            let given: f64 = border[k].iter().zip(&responses[l]).map(|(a, b)| a * b).sum();
            self.cyclic(inner + k, inner + l) - given
        };
        let (first, both, second) = (left(0, 0), left(0, 1), left(1, 1));
        let determinant = first * second - both * both;
        if !(determinant > 0.0 && determinant.is_finite()) {
            return None;
        }
        let rest = |k: usize| {
            let given =
                border[k].iter().zip(band.iter()).fold(T::default(), |sum, (share, value)| sum + *value * *share);
            last[k] - given
        };
        let (one, other) = (rest(0), rest(1));
        last[0] = (one * second - other * both) * determinant.recip();
        last[1] = (other * first - one * both) * determinant.recip();
        for (k, value) in band.iter_mut().enumerate() {
            *value = *value - last[0] * responses[0][k] - last[1] * responses[1][k];
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    const FREE: Ends = Ends::Open { held: [false; 2] };

    /// Stations on a line of length 1, ten times as dense in the first half as in the second.
    fn uneven(dense: usize) -> Vec<f64> {
        let step = 0.5 / dense as f64;
        (0..dense).map(|k| k as f64 * step).chain((0..=dense / 10).map(|k| 0.5 + 10.0 * step * k as f64)).collect()
    }

    /// What is kept of a sine of wavelength `length` within `part`, by least squares.
    fn kept(stations: &[f64], ends: Ends, wave: f64, length: f64, part: std::ops::Range<f64>) -> f64 {
        let sine: Vec<f64> = stations.iter().map(|t| (TAU * t / length).sin()).collect();
        let smooth = smoothed(&sine, stations, ends, wave).unwrap();
        let inside = |(k, _): &(usize, &f64)| part.contains(&stations[*k]);
        let product = |a: &[f64], b: &[f64]| a.iter().enumerate().filter(inside).map(|(k, v)| v * b[k]).sum::<f64>();
        product(&smooth, &sine) / product(&sine, &sine)
    }

    #[test]
    fn the_wave_is_halved_in_dense_and_sparse_parts_alike() {
        let wave = 0.1;
        // Few stations, such that none are averaged, and many, such that most are.
        for dense in [500, 20_000] {
            let stations = uneven(dense);
            for part in [0.15..0.35, 0.65..0.85] {
                for (length, wanted) in [(wave / 2.0, 1.0 / 17.0), (wave, 0.5), (2.0 * wave, 16.0 / 17.0)] {
                    let found = kept(&stations, FREE, wave, length, part.clone());
                    assert!((found - wanted).abs() < 0.01, "{dense}, {part:?}, {length}: {found} {wanted}");
                }
            }
        }
    }

    #[test]
    fn a_closed_curve_halves_the_wave_wherever_it_is_dense() {
        let stations: Vec<f64> = uneven(1000).into_iter().filter(|t| *t < 1.0).collect();
        for (length, wanted) in [(0.05, 1.0 / 17.0), (0.1, 0.5), (0.2, 16.0 / 17.0), (1.0, 1.0 / 1.0001)] {
            let found = kept(&stations, Ends::Closed { period: 1.0 }, 0.1, length, 0.0..1.0);
            assert!((found - wanted).abs() < 0.01, "{length}: {found} {wanted}");
        }
    }

    #[test]
    fn straight_lines_stay_however_many_points_and_however_long_the_wave() {
        for count in [3, 50, 20_000, 60_000] {
            let stations: Vec<f64> =
                (0..count).map(|k| k as f64 / (count - 1) as f64).map(|t| 2.0 * t * t * (1.5 - 0.5 * t)).collect();
            let line: Vec<f64> = stations.iter().map(|t| 0.3 - 1.2 * t).collect();
            for held in [[false; 2], [true; 2], [false, true]] {
                for wave in [1e-300, 1e-6, 0.01, 0.5, 2.0, 1e3, 1e80, f64::MAX] {
                    let smooth = smoothed(&line, &stations, Ends::Open { held }, wave).unwrap();
                    let off = line.iter().zip(&smooth).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                    assert!(off < 1e-12, "{count} {held:?} {wave}: {off}");
                }
            }
        }
    }

    #[test]
    fn long_waves_leave_the_regression_line_or_the_chord() {
        // The least-squares line of t^2 over 0..1 is t - 1/6.
        let stations: Vec<f64> = (0..=20_000).map(|k| f64::from(k) / 20_000.0).collect();
        let bent: Vec<f64> = stations.iter().map(|t| t * t).collect();
        for wave in [1e3, 1e30, f64::MAX] {
            for (held, wanted) in [([false; 2], -1.0 / 6.0), ([true; 2], 0.0)] {
                let smooth = smoothed(&bent, &stations, Ends::Open { held }, wave).unwrap();
                let off = stations.iter().zip(&smooth).map(|(t, x)| (x - t - wanted).abs()).fold(0.0, f64::max);
                assert!(off < 1e-4, "{wave} {held:?}: {off}");
                assert_eq!(held[1], smooth[20_000] == 1.0);
            }
        }
    }

    #[test]
    fn held_ends_stay_and_the_rest_calms_down() {
        let stations: Vec<f64> = (0..32).map(|k| f64::from(k) / 31.0).collect();
        let values: Vec<f64> = (0..32).map(|k| if k % 2 == 0 { 1.0 } else { -1.0 }).collect();
        let smooth = smoothed(&values, &stations, Ends::Open { held: [false, true] }, 0.4).unwrap();
        assert!(smooth[31] == -1.0 && smooth[0] != 1.0 && smooth[10].abs() < 0.05, "{smooth:?}");
    }

    #[test]
    fn the_minimum_is_met() {
        // Any other natural spline through changed values costs more: compare with the system written out densely.
        let stations = [0.0, 0.1, 0.15, 0.4, 0.7, 0.75, 1.0];
        let values = [0.0, 1.0, -0.5, 0.3, 0.8, -1.0, 0.2];
        let wave = 0.9;
        let stiffness = (wave / TAU).powi(4);
        let smooth = smoothed(&values, &stations, FREE, wave).unwrap();
        // Integral of the squared second derivative of the natural spline, by its own moments.
        let cost = |x: &[f64]| {
            let points = x.iter().map(|y| glam::DVec3::X * *y).collect();
            let spline = crate::curve::CubicSpline::natural(stations.to_vec(), points).unwrap();
            let m: Vec<f64> = stations.iter().map(|t| spline.second_derivative(*t).x).collect();
            let h: Vec<f64> = stations.windows(2).map(|w| w[1] - w[0]).collect();
            let bend: f64 = (0..6).map(|k| h[k] / 3.0 * (m[k] * m[k] + m[k] * m[k + 1] + m[k + 1] * m[k + 1])).sum();
            let weight = |k: usize| 0.5 * (stations[(k + 1).min(6)] - stations[k.saturating_sub(1)]);
            let off: f64 = (0..7).map(|k| weight(k) * (x[k] - values[k]).powi(2)).sum();
            off + stiffness * bend
        };
        let least = cost(&smooth);
        for k in 0..7 {
            for change in [-1e-3, 1e-3] {
                let mut other = smooth.clone();
                other[k] += change;
                // To second order in the change only: the slope at the minimum is zero.
                assert!(cost(&other) > least && cost(&other) - least < 1e-4, "{k} {change}");
            }
        }
    }

    #[test]
    fn few_and_uneven_points_of_a_closed_curve_are_solved() {
        for stations in
            [vec![0.0, 0.3, 0.7], vec![0.0, 1e-9, 0.5], vec![0.0, 0.2, 0.4, 1.0 - 1e-15], vec![0.0, 0.5, 0.5]]
        {
            for wave in [1e-9, 0.1, 1.0, 1e3, 1e200] {
                let values: Vec<f64> = (0..stations.len()).map(|k| if k % 2 == 0 { 1.0 } else { -0.5 }).collect();
                let smooth = smoothed(&values, &stations, Ends::Closed { period: 1.0 }, wave).unwrap();
                assert!(smooth.iter().all(|v| (-1.5..1.5).contains(v)), "{stations:?} {wave}: {smooth:?}");
            }
        }
    }

    #[test]
    fn what_cannot_be_solved_is_refused() {
        let run = |values: &[f64], stations: &[f64], wave| smoothed(values, stations, FREE, wave);
        assert_eq!(run(&[0.0, 1.0, 0.0], &[0.0, 2.0, 1.0], 0.1), Err(NotSolvable));
        assert_eq!(run(&[0.0, 1.0, 0.0], &[0.0, 0.0, 0.0], 0.1), Err(NotSolvable));
        assert_eq!(run(&[0.0, f64::NAN, 0.0], &[0.0, 1.0, 2.0], 0.1), Err(NotSolvable));
        assert_eq!(run(&[0.0, 1.0, 0.0], &[0.0, 1.0, f64::INFINITY], 0.1), Err(NotSolvable));
        assert_eq!(run(&[0.0, 1.0, 0.0], &[0.0, 1.0, 2.0], f64::NAN), Err(NotSolvable));
        assert_eq!(run(&[0.0, 1.0], &[0.0], 0.1), Err(NotSolvable));
        assert_eq!(run(&[0.0, 1.0], &[0.0, 0.0], 0.1), Ok(vec![0.0, 1.0]));
    }
}
