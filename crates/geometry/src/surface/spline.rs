//! Slopes of C2 cubic splines for many columns of points over the same knots.
//!
//! A skin solves the same small system for each column along the stack and each section across it, so that the
//! factors are computed once, and the slopes are written into one array in place. That is why the splines of single
//! curves are not used here.

use glam::DVec3;

/// How a spline ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ends {
    /// The last knot is followed by the first: one interval a knot.
    Periodic,
    /// Two ends.
    Open { start: End, end: End },
}

/// What is known at an end of a spline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// The second derivative is 0.
    Natural,
    /// The slope is given.
    Slope,
    /// Slope and second derivative are given: the interval at this end is of degree 4 instead of 3 (of degree 5 where
    /// it is the only one and both ends are so).
    SlopeAndSecond,
}

/// The factored system for the slopes at the knots of a C2 cubic spline.
///
/// With intervals `h` and chord slopes `d`, each inner knot demands
/// `h_i m_(i-1) + 2 (h_(i-1) + h_i) m_i + h_(i-1) m_(i+1) = 3 (h_i d_(i-1) + h_(i-1) d_i)`; a natural end
/// `2 m_0 + m_1 = 3 d_0`. Behind an end interval `h_0` with a given second derivative `c` the demand is
/// `3 h_1 m_0 + (2 h_0 + 3 h_1) m_1 + h_0 m_2 = 6 h_1 d_0 + 3 h_0 d_1 - h_0 h_1 c/2`, and mirrored at the other end with
/// `+ c`. Solved by elimination without pivots (the matrix is diagonally dominant), the periodic one
/// with a Sherman-Morrison correction.
#[derive(Clone, Debug)]
pub(crate) struct SlopeSystem {
    intervals: Vec<f64>,
    ends: Ends,
    lower: Vec<f64>,
    inverse_pivot: Vec<f64>,
    upper: Vec<f64>,
    /// Correction a unit of the periodic residual, and the weight of the last slope in that residual.
    wrap: Option<(Vec<f64>, f64)>,
}

impl SlopeSystem {
    /// Factors the system. Intervals must be positive and finite; at least one, or three where periodic.
    pub fn new(intervals: Vec<f64>, ends: Ends) -> Self {
        let periodic = ends == Ends::Periodic;
        let count = if periodic { intervals.len() } else { intervals.len() + 1 };
        let h = |i: usize| intervals[i % intervals.len()];
        let mut lower = vec![0.0; count];
        let mut diagonal = vec![1.0; count];
        let mut upper = vec![0.0; count];
        for i in 0..count {
            let inner = periodic || (i > 0 && i + 1 < count);
            if inner {
                let before = h(i + intervals.len() - 1);
                lower[i] = h(i);
                diagonal[i] = 2.0 * (before + h(i));
                upper[i] = before;
            }
        }
        if let Ends::Open { start, end } = ends {
            if start == End::Natural {
                (diagonal[0], upper[0]) = (2.0, 1.0);
            }
            if end == End::Natural {
                (diagonal[count - 1], lower[count - 1]) = (2.0, 1.0);
            }
            if start == End::SlopeAndSecond && count > 2 {
                diagonal[1] += lower[1];
                lower[1] *= 3.0;
            }
            if end == End::SlopeAndSecond && count > 2 {
                diagonal[count - 2] += upper[count - 2];
                upper[count - 2] *= 3.0;
            }
        }
        let corners = periodic.then(|| {
            // The two entries in the corners of the matrix are moved into an update of rank one.
            let gamma = -diagonal[0];
            let last_weight = lower[0] / gamma;
            diagonal[0] -= gamma;
            diagonal[count - 1] -= upper[count - 1] * last_weight;
            (gamma, std::mem::take(&mut upper[count - 1]), last_weight)
        });
        let mut inverse_pivot = vec![0.0; count];
        for i in 0..count {
            let fill = if i == 0 { 0.0 } else { lower[i] * upper[i - 1] };
            inverse_pivot[i] = 1.0 / (diagonal[i] - fill);
            upper[i] *= inverse_pivot[i];
        }
        let wrap = corners.map(|(gamma, last, last_weight)| {
            let mut z = vec![0.0; count];
            z[0] = gamma;
            z[count - 1] = last;
            z[0] *= inverse_pivot[0];
            for i in 1..count {
                z[i] = (z[i] - lower[i] * z[i - 1]) * inverse_pivot[i];
            }
            for i in (0..count - 1).rev() {
                z[i] -= upper[i] * z[i + 1];
            }
            let scale = 1.0 / (1.0 + z[0] + last_weight * z[count - 1]);
            for value in &mut z {
                *value *= scale;
            }
            (z, last_weight)
        });
        Self { intervals, ends, lower, inverse_pivot, upper, wrap }
    }

    /// Parameter length of each interval.
    pub fn intervals(&self) -> &[f64] {
        &self.intervals
    }

    /// Number of knots.
    pub fn knots(&self) -> usize {
        self.inverse_pivot.len()
    }

    /// Writes the slope at each knot of as many columns as there are `lanes`. Both arrays hold the first knot of all
    /// columns, then the second, and so on. Slopes that are given must stand in `slopes` before.
    pub fn solve(&self, values: &[DVec3], slopes: &mut [DVec3], lanes: usize) {
        self.solve_with(values, slopes, lanes, [&[], &[]]);
    }

    /// As [`SlopeSystem::solve`], with the second derivatives at the ends where they are given, one a column.
    pub fn solve_with(&self, values: &[DVec3], slopes: &mut [DVec3], lanes: usize, seconds: [&[DVec3]; 2]) {
        let count = self.knots();
        let periodic = self.ends == Ends::Periodic;
        let row = |knot: usize| &values[knot * lanes..(knot + 1) * lanes];
        for i in 0..count {
            let (done, open) = slopes.split_at_mut(i * lanes);
            let own = &mut open[..lanes];
            let previous = if i == 0 { count - 1 } else { i - 1 };
            let next = if i + 1 == count { 0 } else { i + 1 };
            let (before, at, after) = (row(previous), row(i), row(next));
            if periodic || (i > 0 && i + 1 < count) {
                let (h_before, h_after) = (self.intervals[previous], self.intervals[i]);
                let (to_before, to_after) = (3.0 * h_after / h_before, 3.0 * h_before / h_after);
                for (k, own) in own.iter_mut().enumerate() {
                    *own = to_before * (at[k] - before[k]) + to_after * (after[k] - at[k]);
                }
                if let Ends::Open { start, end } = self.ends {
                    let half = 0.5 * h_before * h_after;
                    if start == End::SlopeAndSecond && i == 1 {
                        for (k, (own, second)) in own.iter_mut().zip(seconds[0]).enumerate() {
                            *own += to_before * (at[k] - before[k]) - half * *second;
                        }
                    }
                    if end == End::SlopeAndSecond && i + 2 == count {
                        for (k, (own, second)) in own.iter_mut().zip(seconds[1]).enumerate() {
                            *own += to_after * (after[k] - at[k]) + half * *second;
                        }
                    }
                }
            } else if let Ends::Open { start, end } = self.ends {
                let given = if i == 0 { start } else { end } != End::Natural;
                let (from, to, h) =
                    if i == 0 { (at, after, self.intervals[0]) } else { (before, at, self.intervals[previous]) };
                if !given {
                    for (k, own) in own.iter_mut().enumerate() {
                        *own = 3.0 / h * (to[k] - from[k]);
                    }
                }
            }
            let pivot = self.inverse_pivot[i];
            if i == 0 {
                own.iter_mut().for_each(|own| *own *= pivot);
            } else {
                let lower = self.lower[i];
                for (own, carried) in own.iter_mut().zip(&done[previous * lanes..]) {
                    *own = (*own - lower * *carried) * pivot;
                }
            }
        }
        for i in (0..count - 1).rev() {
            let (own, behind) = slopes.split_at_mut((i + 1) * lanes);
            for (own, next) in own[i * lanes..].iter_mut().zip(behind) {
                *own -= self.upper[i] * *next;
            }
        }
        if let Some((z, last_weight)) = &self.wrap {
            for lane in 0..lanes {
                let residual = slopes[lane] + *last_weight * slopes[(count - 1) * lanes + lane];
                for (i, z) in z.iter().enumerate() {
                    slopes[i * lanes + lane] -= *z * residual;
                }
            }
        }
    }
}

/// Weights of the cubic Hermite form at a place in an interval: of value and slope at its start, then at its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hermite {
    pub value: [f64; 4],
    /// The same for the derivative by the parameter.
    pub derivative: [f64; 4],
}

impl Hermite {
    /// Weights at the fraction `t` in 0..=1 of an interval of length `h`.
    pub fn new(t: f64, h: f64) -> Self {
        let s = 1.0 - t;
        Self {
            value: [(1.0 + 2.0 * t) * s * s, h * t * s * s, t * t * (3.0 - 2.0 * t), -h * t * t * s],
            derivative: [-6.0 * t * s / h, s * (1.0 - 3.0 * t), 6.0 * t * s / h, t * (3.0 * t - 2.0)],
        }
    }

    /// A weighted sum of value and slope at the start, and value and slope at the end.
    pub fn sum(weights: &[f64; 4], a: DVec3, slope_a: DVec3, b: DVec3, slope_b: DVec3) -> DVec3 {
        weights[0] * a + weights[1] * slope_a + weights[2] * b + weights[3] * slope_b
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slopes(values: &[DVec3], intervals: &[f64], ends: Ends, given: [DVec3; 2]) -> Vec<DVec3> {
        let mut slopes = vec![DVec3::ZERO; values.len()];
        slopes[0] = given[0];
        slopes[values.len() - 1] = given[1];
        SlopeSystem::new(intervals.to_vec(), ends).solve(values, &mut slopes, 1);
        slopes
    }

    fn scalar_at(values: &[f64], ends: Ends, given: [f64; 2], u: f64) -> f64 {
        let spans = values.len() - 1;
        let points: Vec<DVec3> = values.iter().map(|v| DVec3::new(*v, 0.0, 0.0)).collect();
        let intervals = vec![1.0 / spans as f64; spans];
        let slopes = slopes(&points, &intervals, ends, given.map(|s| DVec3::new(s, 0.0, 0.0)));
        let i = ((u * spans as f64) as usize).min(spans - 1);
        let weights = Hermite::new(u * spans as f64 - i as f64, intervals[i]).value;
        Hermite::sum(&weights, points[i], slopes[i], points[i + 1], slopes[i + 1]).x
    }

    #[test]
    fn agrees_with_reference_values() {
        let values = [0.0, 1.0, 0.5, 2.0];
        let natural = Ends::Open { start: End::Natural, end: End::Natural };
        let clamped = Ends::Open { start: End::Slope, end: End::Slope };
        for (u, of_natural, of_clamped) in
            [(0.2, 0.8048, 0.6672), (0.5, 0.7125, 0.6597222222222), (0.9, 1.3771, 1.7761)]
        {
            assert!((scalar_at(&values, natural, [0.0; 2], u) - of_natural).abs() < 1e-12);
            assert!((scalar_at(&values, clamped, [1.0, -1.0], u) - of_clamped).abs() < 1e-12);
        }
    }

    /// Second derivative by central weights of the Hermite form at either end of an interval.
    fn second(h: f64, a: DVec3, ma: DVec3, b: DVec3, mb: DVec3, at_end: bool) -> DVec3 {
        let chord = (b - a) / h;
        if at_end { (2.0 * ma + 4.0 * mb - 6.0 * chord) / h } else { (6.0 * chord - 4.0 * ma - 2.0 * mb) / h }
    }

    #[test]
    fn periodic_splines_have_no_jump_of_curvature_anywhere() {
        for count in [3_usize, 4, 7, 20] {
            let values: Vec<DVec3> = (0..count)
                .map(|i| DVec3::new((i as f64).sin(), (1.7 * i as f64).cos(), (0.3 * (i * i) as f64).sin()))
                .collect();
            let intervals: Vec<f64> = (0..count).map(|i| 0.2 + (i * 7 % 5) as f64).collect();
            let m = slopes(&values, &intervals, Ends::Periodic, [DVec3::ZERO; 2]);
            for i in 0..count {
                let (p, n) = ((i + count - 1) % count, (i + 1) % count);
                let left = second(intervals[p], values[p], m[p], values[i], m[i], true);
                let right = second(intervals[i], values[i], m[i], values[n], m[n], false);
                assert!((left - right).length() < 1e-10, "{count} knots, knot {i}: {left} {right}");
            }
        }
    }

    #[test]
    fn cubics_are_reproduced_with_their_end_slopes() {
        let f = |u: f64| DVec3::new(u * u * u, 1.0 - 2.0 * u * u, u);
        let df = |u: f64| DVec3::new(3.0 * u * u, -4.0 * u, 1.0);
        let knots = [0.0, 0.1, 0.7, 1.0, 1.9];
        let values = knots.map(f);
        let intervals: Vec<f64> = knots.windows(2).map(|k| k[1] - k[0]).collect();
        let ends = Ends::Open { start: End::Slope, end: End::Slope };
        for (u, m) in knots.iter().zip(slopes(&values, &intervals, ends, [df(0.0), df(1.9)])) {
            assert!((m - df(*u)).length() < 1e-12, "{m} at {u}");
        }
    }

    #[test]
    fn columns_are_solved_side_by_side_as_one_by_one() {
        let value = |i: usize, lane: usize| DVec3::new((i * 3 + lane) as f64, (i * lane) as f64, 0.3).map(f64::sin);
        let intervals = vec![0.5, 1.0, 0.2, 0.7, 2.0];
        for ends in [Ends::Periodic, Ends::Open { start: End::Slope, end: End::Natural }] {
            let system = SlopeSystem::new(intervals.clone(), ends);
            let count = system.knots();
            let values: Vec<DVec3> = (0..count).flat_map(|i| (0..3).map(move |lane| value(i, lane))).collect();
            let mut together = vec![DVec3::ONE; values.len()];
            system.solve(&values, &mut together, 3);
            for lane in 0..3 {
                let mut alone = vec![DVec3::ONE; count];
                system.solve(&(0..count).map(|i| value(i, lane)).collect::<Vec<_>>(), &mut alone, 1);
                assert!((0..count).all(|i| alone[i] == together[3 * i + lane]));
            }
        }
    }

    #[test]
    fn two_knots_are_a_straight_line() {
        let natural = Ends::Open { start: End::Natural, end: End::Natural };
        let m = slopes(&[DVec3::ZERO, DVec3::X], &[0.5], natural, [DVec3::ZERO; 2]);
        assert!(m.iter().all(|m| (*m - 2.0 * DVec3::X).length() < 1e-15));
    }
}
