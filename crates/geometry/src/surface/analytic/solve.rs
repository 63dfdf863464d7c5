//! From sections and what is given at the ends to the coefficients of the functions of u.

use glam::DVec3;
use nalgebra::DMatrix;

use super::blend::{Along, chebyshev};
use crate::surface::spline::{End, Ends, SlopeSystem};

/// Derivatives by u that are given at an end of a surface, a row of coefficients each. The second is given only with
/// the first.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct EndRows {
    pub slope: Option<Vec<DVec3>>,
    pub second: Option<Vec<DVec3>>,
    /// Whether a spline without a given slope ends without second derivative.
    pub natural: bool,
}

impl EndRows {
    /// Number of rows given.
    pub fn count(&self) -> usize {
        usize::from(self.slope.is_some()) + usize::from(self.second.is_some())
    }
}

/// The polynomial through sections at `knots` (thesis 4.3, 4.7, 4.11) in Chebyshev polynomials: one dense system for
/// all coefficients of all series together, solved with pivots. Rows of derivatives are scaled to the size of the
/// others. `None` where it has no solution in finite numbers.
pub(crate) fn polynomial(
    knots: &[f64],
    values: &[DVec3],
    ends: [&EndRows; 2],
    lanes: usize,
) -> Option<(Along, Vec<DVec3>)> {
    let count = knots.len() + ends[0].count() + ends[1].count();
    let mut conditions: Vec<(f64, usize, &[DVec3])> =
        knots.iter().zip(values.chunks_exact(lanes)).map(|(u, row)| (*u, 0, row)).collect();
    for (u, end) in [0.0, 1.0].into_iter().zip(ends) {
        conditions.extend(end.slope.iter().map(|row| (u, 1, row.as_slice())));
        conditions.extend(end.second.iter().map(|row| (u, 2, row.as_slice())));
    }
    let mut matrix = DMatrix::zeros(count, count);
    let mut right = DMatrix::zeros(count, 3 * lanes);
    for (i, (u, order, row)) in conditions.into_iter().enumerate() {
        let weights = &chebyshev(u, count)[order];
        let scale = 1.0 / weights.iter().fold(0.0_f64, |most, w| most.max(w.abs()));
        for (n, weight) in weights.iter().enumerate() {
            matrix[(i, n)] = scale * weight;
        }
        for (lane, value) in row.iter().enumerate() {
            for (axis, value) in value.to_array().into_iter().enumerate() {
                right[(i, 3 * lane + axis)] = scale * value;
            }
        }
    }
    let solved = matrix.full_piv_lu().solve(&right)?;
    let rows = (0..count).flat_map(|n| (0..lanes).map(move |lane| (n, lane)));
    let rows: Vec<DVec3> =
        rows.map(|(n, lane)| DVec3::from_array([0, 1, 2].map(|k| solved[(n, 3 * lane + k)]))).collect();
    rows.iter().all(|c| c.is_finite()).then_some((Along::Polynomial { rows: count }, rows))
}

/// The C2 spline through sections at `knots`. Where an end has no slope given and is not natural, it has that of the
/// cubic through the four sections next to it (of the parabola through three), which is right to third order, where a
/// natural end is wrong by the profile's own second derivative. `None` where numbers are not finite.
pub(crate) fn spline(
    knots: &[f64],
    values: &[DVec3],
    ends: [&EndRows; 2],
    lanes: usize,
) -> Option<(Along, Vec<DVec3>)> {
    let count = knots.len();
    let intervals: Vec<f64> = knots.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let free = |end: &EndRows| end.slope.is_none() && !end.natural && count > 2;
    let kind = |end: &EndRows| match (&end.slope, &end.second) {
        _ if free(end) => End::Slope,
        (None, _) => End::Natural,
        (Some(_), None) => End::Slope,
        (Some(_), Some(_)) => End::SlopeAndSecond,
    };
    let system = SlopeSystem::new(intervals.clone(), Ends::Open { start: kind(ends[0]), end: kind(ends[1]) });
    let mut slopes = vec![DVec3::ZERO; values.len()];
    let last = (count - 1) * lanes;
    for (end, place) in ends.into_iter().zip([0, last]) {
        if let Some(slope) = &end.slope {
            slopes[place..place + lanes].copy_from_slice(slope);
        } else if free(end) {
            let near: Vec<usize> =
                if place == 0 { (0..count.min(4)).collect() } else { (count.saturating_sub(4)..count).collect() };
            for (k, weight) in near.iter().zip(slope_weights(knots, &near, if place == 0 { 0 } else { count - 1 })) {
                for lane in 0..lanes {
                    slopes[place + lane] += weight * values[k * lanes + lane];
                }
            }
        }
    }
    let seconds = ends.map(|end| end.second.as_deref().unwrap_or_default());
    system.solve_with(values, &mut slopes, lanes, seconds);

    let mut rows = Vec::with_capacity(3 * values.len());
    for knot in 0..count {
        let own = knot * lanes..(knot + 1) * lanes;
        rows.extend_from_slice(&values[own.clone()]);
        rows.extend_from_slice(&slopes[own]);
        // A last knot looks back, which is looking forward in the mirror: slopes change their sign.
        let (gap, other, sign, near, far) = if knot + 1 < count {
            (knot, knot + 1, 1.0, seconds[0], seconds[1])
        } else {
            (knot - 1, knot - 1, -1.0, seconds[1], seconds[0])
        };
        if (knot == 0 || knot + 1 == count) && !near.is_empty() {
            rows.extend_from_slice(near);
            continue;
        }
        let far = if other == 0 || other + 1 == count { far } else { &[] };
        let h = intervals[gap];
        rows.extend((0..lanes).map(|lane| {
            let (at, to) = (knot * lanes + lane, other * lanes + lane);
            let chord = (values[to] - values[at]) / h;
            let (m, n) = (sign * slopes[at], sign * slopes[to]);
            match far.get(lane) {
                Some(second) => (12.0 * chord - 6.0 * (m + n)) / h + *second,
                None => (6.0 * chord - 4.0 * m - 2.0 * n) / h,
            }
        }));
    }
    rows.iter().all(|c| c.is_finite()).then_some((Along::Spline { knots: knots.to_vec() }, rows))
}

/// Weights of the values at `near` knots in the slope, at the knot `at` among them, of the polynomial through all.
fn slope_weights(knots: &[f64], near: &[usize], at: usize) -> Vec<f64> {
    let product = |k: usize, without: usize| -> f64 {
        near.iter()
            .filter(|i| **i != k && **i != without)
            .map(|i| (knots[at] - knots[*i]) / (knots[k] - knots[*i]))
            .product()
    };
    let weight = |k: &usize| -> f64 {
        if *k == at {
            return near.iter().filter(|i| **i != at).map(|i| 1.0 / (knots[at] - knots[*i])).sum();
        }
        product(*k, at) / (knots[*k] - knots[at])
    };
    near.iter().map(weight).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    type Solver = fn(&[f64], &[DVec3], [&EndRows; 2], usize) -> Option<(Along, Vec<DVec3>)>;

    fn scalar(solver: Solver, sections: &[f64], start: &[f64], end: &[f64]) -> (Along, Vec<DVec3>) {
        let spans = sections.len() - 1;
        let knots: Vec<f64> = (0..=spans).map(|k| k as f64 / spans as f64).collect();
        let values: Vec<DVec3> = sections.iter().map(|x| DVec3::splat(*x)).collect();
        let rows = |given: &[f64]| EndRows {
            slope: given.first().map(|x| vec![DVec3::splat(*x)]),
            second: given.get(1).map(|x| vec![DVec3::splat(*x)]),
            natural: true,
        };
        solver(&knots, &values, [&rows(start), &rows(end)], 1).unwrap()
    }

    fn at((along, rows): &(Along, Vec<DVec3>), u: f64) -> [f64; 3] {
        let weights = along.weights(u);
        weights.orders.map(|list| list.iter().zip(&rows[weights.first..]).map(|(w, row)| w * row.x).sum())
    }

    /// Reference values V13: the polynomials of 4.3, 4.7 and 4.11 by the coefficients of their powers of u.
    #[test]
    fn polynomials_are_those_of_the_reference() {
        let sections = [1.0, 2.0, 0.5];
        for (start, end, powers, value) in [
            (&[][..], &[][..], &[1.0, 4.5, -5.0][..], 1.9),
            (&[-1.0], &[], &[1.0, -1.0, 11.5, -11.0], 1.438),
            (&[-1.0], &[3.0], &[1.0, -1.0, 25.5, -53.0, 28.0], 1.7908),
        ] {
            let solved = scalar(polynomial, &sections, start, end);
            assert!((at(&solved, 0.3)[0] - value).abs() < 1e-12);
            for u in [0.0, 0.11, 0.5, 0.87, 1.0] {
                let exact = |order: i32| -> f64 {
                    let term = |(n, f): (usize, &f64)| {
                        let n = n as i32;
                        let factor: i32 = (0..order).map(|k| n - k).product();
                        f64::from(factor) * f * if n < order { 0.0 } else { f64::powi(u, n - order) }
                    };
                    powers.iter().enumerate().map(term).sum()
                };
                for (order, found) in at(&solved, u).into_iter().enumerate() {
                    assert!((found - exact(order as i32)).abs() < 1e-11, "{powers:?} {u} {order}: {found}");
                }
            }
        }
    }

    /// Reference values V14.
    #[test]
    fn splines_are_those_of_the_reference() {
        let sections = [0.0, 1.0, 0.5, 2.0];
        let natural = scalar(spline, &sections, &[], &[]);
        let clamped = scalar(spline, &sections, &[1.0], &[-1.0]);
        for (u, of_natural, of_clamped) in
            [(0.2, 0.8048, 0.6672), (0.5, 0.7125, 0.6597222222222), (0.9, 1.3771, 1.7761)]
        {
            assert!((at(&natural, u)[0] - of_natural).abs() < 1e-12);
            assert!((at(&clamped, u)[0] - of_clamped).abs() < 1e-12);
        }
    }

    #[test]
    fn free_ends_follow_the_cubic_through_the_sections_next_to_them() {
        let f = |u: f64| DVec3::new(2.0 * u * u * u - u, u * u, 1.0 - u);
        let knots = [0.0, 0.1, 0.45, 0.5, 0.8, 1.0];
        for count in [4, 5, 6] {
            let knots: Vec<f64> = knots[..count].iter().map(|u| u / knots[count - 1]).collect();
            let values: Vec<DVec3> = knots.iter().map(|u| f(*u)).collect();
            let free = EndRows::default();
            let (along, rows) = spline(&knots, &values, [&free, &free], 1).unwrap();
            for u in [0.0, 0.03, 0.3, 0.77, 1.0] {
                let weights = along.weights(u);
                let found: DVec3 = weights.orders[0].iter().zip(&rows[weights.first..]).map(|(w, row)| *w * *row).sum();
                assert!(found.distance(f(u)) < 1e-12, "{count} {u}");
            }
        }
        // Three: a parabola. Two: a straight line.
        let g = |u: f64| DVec3::splat(u * u);
        let free = EndRows::default();
        let (along, rows) = spline(&[0.0, 0.3, 1.0], &[0.0, 0.3, 1.0].map(g), [&free, &free], 1).unwrap();
        let weights = along.weights(0.7);
        let found: DVec3 = weights.orders[0].iter().zip(&rows[weights.first..]).map(|(w, row)| *w * *row).sum();
        assert!(found.distance(g(0.7)) < 1e-12);
        assert!(spline(&[0.0, 1.0], &[0.0, 1.0].map(g), [&free, &free], 1).is_some());
    }

    #[test]
    fn ends_have_what_is_given_and_all_is_twice_continuous() {
        for sections in [&[1.0, 2.0][..], &[1.0, 2.0, 0.5], &[0.0, 1.0, 0.5, 2.0], &[3.0, 0.0, 1.0, 1.0, 4.0, 2.0]] {
            for start in [&[][..], &[0.7], &[0.7, -3.0]] {
                for end in [&[][..], &[-0.4], &[-0.4, 5.0]] {
                    let (of_spline, of_polynomial) =
                        (scalar(spline, sections, start, end), scalar(polynomial, sections, start, end));
                    let spans = sections.len() - 1;
                    for (k, section) in sections.iter().enumerate() {
                        let u = k as f64 / spans as f64;
                        assert!((at(&of_spline, u)[0] - section).abs() < 1e-13);
                        assert!((at(&of_polynomial, u)[0] - section).abs() < 1e-12);
                    }
                    for solved in [&of_spline, &of_polynomial] {
                        for (u, given) in [(0.0, start), (1.0, end)] {
                            for (order, given) in given.iter().enumerate() {
                                assert!((at(solved, u)[order + 1] - given).abs() < 1e-9, "{solved:?} {u} {order}");
                            }
                        }
                    }
                    if start.is_empty() && end.is_empty() {
                        assert!(at(&of_spline, 0.0)[2].abs() < 1e-10 && at(&of_spline, 1.0)[2].abs() < 1e-10);
                    }
                    // C2 holds by construction; that the pieces have the degree they should is the fourth difference
                    // (of degree 4 at ends with a second derivative, else 3).
                    for span in 0..spans {
                        let ends = usize::from(span == 0 && start.len() == 2)
                            + usize::from(span + 1 == spans && end.len() == 2);
                        let h = 1.0 / spans as f64;
                        let f: Vec<f64> = (0..7)
                            .map(|i| at(&of_spline, (span as f64 + (f64::from(i) + 0.01) / 6.1) * h)[0])
                            .collect();
                        let mut differences = f;
                        for _ in 0..4 + ends {
                            differences = differences.windows(2).map(|pair| pair[1] - pair[0]).collect();
                        }
                        assert!(differences.iter().all(|d| d.abs() < 1e-11), "{sections:?} {span}: {differences:?}");
                    }
                }
            }
        }
    }
}
