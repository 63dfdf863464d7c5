//! The difference schemes against their own exact solution, and against that of the differential equation.
//!
//! Between two pins the difference equations without forces are solved by `sinh(mu i)` with `2 sinh(mu/2) = lambda h`
//! and straight lines, so that their solution is a tension spline with other coefficients: two independent ways to the
//! same numbers, which must agree to round-off.

use super::tension_spline::{Span, open_moments, periodic_moments};
use super::*;
use EndCondition::{Clamped, Free, Natural};

fn stiffness(ratio: f64) -> Stiffness {
    Stiffness::new(1.0, ratio).unwrap()
}

/// `S(i/m)` on an interval of `m` steps of length `h`, for the difference scheme.
fn bow(ratio: f64, h: f64, m: usize, i: usize) -> f64 {
    let (t, steps) = (i as f64 / m as f64, m as f64);
    let x = ratio.sqrt() * h * steps;
    if ratio == 0.0 {
        return -t * (1.0 - t * t) / 6.0;
    }
    let mu = 2.0 * (0.5 * ratio.sqrt() * h).asinh();
    let share = (mu * (t - 1.0) * steps).exp() * (-2.0 * mu * t * steps).exp_m1() / (-2.0 * mu * steps).exp_m1();
    (share - t) / (x * x)
}

/// The exact solution of the difference scheme on `nodes`, through `values` at `held` nodes.
fn exact_differences(
    nodes: usize,
    held: &[usize],
    values: &[f64],
    ends: Option<[SplineEnd<f64>; 2]>,
    ratio: f64,
) -> Vec<f64> {
    let (mut held, mut values) = (held.to_vec(), values.to_vec());
    let h = if ends.is_some() { 1.0 / (nodes - 1) as f64 } else { 1.0 / nodes as f64 };
    if ends.is_none() {
        held.push(held[0] + nodes);
        values.push(values[0]);
    }
    let spans: Vec<Span> = held
        .windows(2)
        .map(|w| {
            let m = w[1] - w[0];
            let length = m as f64 * h;
            let square = length * length;
            Span {
                length,
                near: 0.5 * h - square * bow(ratio, h, m, m - 1) / h,
                far: -square * bow(ratio, h, m, 1) / h,
            }
        })
        .collect();
    let moments = match ends {
        Some(ends) => open_moments(&spans, &values, ends).unwrap(),
        None => periodic_moments(&spans, &values).unwrap(),
    };
    let mut curve = vec![0.0; nodes];
    for (k, w) in held.windows(2).enumerate() {
        let m = w[1] - w[0];
        for i in 0..=m {
            let t = i as f64 / m as f64;
            let length = m as f64 * h;
            let bend = moments[k] * bow(ratio, h, m, m - i) + moments[k + 1] * bow(ratio, h, m, i);
            curve[(w[0] + i) % nodes] = (1.0 - t) * values[k] + t * values[k + 1] + length * length * bend;
        }
    }
    curve
}

fn spline_end(condition: EndCondition, tangent: f64) -> SplineEnd<f64> {
    if condition == Clamped { SplineEnd::Clamped(tangent) } else { SplineEnd::Natural }
}

#[test]
fn solvers_agree_with_the_exact_solution_of_the_scheme_to_round_off() {
    let pins: &[&[usize]] = &[&[], &[1], &[5], &[3, 4], &[1, 2, 9, 10], &[1, 2, 3, 4, 5, 6, 7, 8, 9, 10]];
    for nodes in [12, 64, 500] {
        for ratio in [0.0, 2.8, 100.0, 1e4, 1e8] {
            for pins in pins {
                let values: Vec<f64> = pins.iter().map(|p| (1.7 * *p as f64).sin() - 0.2).collect();
                for (left, right) in [(Clamped, Clamped), (Clamped, Natural), (Natural, Clamped), (Natural, Natural)] {
                    let beam = OpenBeam::new(nodes, pins, left, right, stiffness(ratio)).unwrap();
                    let given = OpenValues {
                        left_tangent: 1.5,
                        right_tangent: -2.5,
                        pins: &values,
                        ..OpenValues::ends(0.4, -0.7)
                    };
                    let solved = beam.solve(&given).unwrap();
                    let held: Vec<usize> = [0].into_iter().chain(pins.iter().copied()).chain([nodes - 1]).collect();
                    let through: Vec<f64> = [0.4].into_iter().chain(values.iter().copied()).chain([-0.7]).collect();
                    let ends = [spline_end(left, 1.5), spline_end(right, -2.5)];
                    let exact = exact_differences(nodes, &held, &through, Some(ends), ratio);
                    let size = exact.iter().fold(1.0_f64, |m, d| m.max(d.abs()));
                    for (i, (a, b)) in solved.iter().zip(&exact).enumerate() {
                        let off = (a - b).abs() / size;
                        assert!(
                            off < 2e-12,
                            "{nodes} nodes, {pins:?}, {left:?} {right:?}, {ratio}: node {i} by {off:e}"
                        );
                    }
                }
                if !pins.is_empty() {
                    let solved = ClosedBeam::new(nodes, pins, stiffness(ratio)).unwrap().solve(&values).unwrap();
                    let exact = exact_differences(nodes, pins, &values, None, ratio);
                    let size = exact.iter().fold(1.0_f64, |m, d| m.max(d.abs()));
                    for (a, b) in solved.iter().zip(&exact) {
                        assert!((a - b).abs() / size < 2e-12, "closed, {nodes} nodes, {pins:?}, {ratio}: {a} {b}");
                    }
                }
            }
        }
    }
}

/// Exact values at `samples` of the curve with these ends, loads and pins; a free end is where its load balances.
fn exact_curve(
    ends: [EndCondition; 2],
    positions: [f64; 2],
    tangents: [f64; 2],
    loads: [f64; 2],
    pins: &[(f64, f64)],
    ratio: f64,
) -> TensionSpline<f64> {
    let at: Vec<f64> = [0.0].into_iter().chain(pins.iter().map(|p| p.0)).chain([1.0]).collect();
    let spline = |positions: [f64; 2]| {
        let values: Vec<f64> =
            [positions[0]].into_iter().chain(pins.iter().map(|p| p.1)).chain([positions[1]]).collect();
        let conditions = [spline_end(ends[0], tangents[0]), spline_end(ends[1], tangents[1])];
        (TensionSpline::open(&at, &values, conditions, stiffness(ratio)).unwrap(), values)
    };
    // k_b d''' - k_s d' is constant on an interval: from its ends' values and second derivatives.
    let load = |positions: [f64; 2]| {
        let (spline, values) = spline(positions);
        let n = at.len() - 1;
        let along = |k: usize| {
            let moments = spline.moments();
            ((moments[k + 1] - moments[k]) - ratio * (values[k + 1] - values[k])) / (at[k + 1] - at[k])
        };
        [along(0), -along(n - 1)]
    };
    // Loads depend linearly on the free positions.
    let base = [0, 1].map(|end| if ends[end] == Free { 0.0 } else { positions[end] });
    let zero = load(base);
    let free: Vec<usize> = (0..2).filter(|end| ends[*end] == Free).collect();
    let column = |end: usize| {
        let mut moved = base;
        moved[end] += 1.0;
        let moved = load(moved);
        [moved[0] - zero[0], moved[1] - zero[1]]
    };
    let mut found = base;
    match free.as_slice() {
        [] => {}
        [end] => found[*end] = (loads[*end] - zero[*end]) / column(*end)[*end],
        _ => {
            let (a, b, r) = (column(0), column(1), [loads[0] - zero[0], loads[1] - zero[1]]);
            let determinant = a[0] * b[1] - b[0] * a[1];
            found = [(r[0] * b[1] - b[0] * r[1]) / determinant, (a[0] * r[1] - r[0] * a[1]) / determinant];
        }
    }
    spline(found).0
}

#[test]
fn every_boundary_case_is_of_second_order() {
    let conditions = [Clamped, Natural, Free];
    let (positions, tangents, loads) = ([0.3, -0.4], [2.0, -1.0], [1.5, -0.5]);
    let mut cases = 0;
    for left in conditions {
        for right in conditions {
            for pins in [vec![], vec![(0.375, 0.9)], vec![(0.25, 0.9), (0.75, -0.6)]] {
                for ratio in [0.0, 2.8, 100.0] {
                    let error = |intervals: usize| {
                        let at: Vec<usize> = pins.iter().map(|p| (p.0 * intervals as f64) as usize).collect();
                        let beam = OpenBeam::new(intervals + 1, &at, left, right, stiffness(ratio)).ok()?;
                        let values: Vec<f64> = pins.iter().map(|p| p.1).collect();
                        let solved = beam
                            .solve(&OpenValues {
                                left: positions[0],
                                right: positions[1],
                                left_tangent: tangents[0],
                                right_tangent: tangents[1],
                                left_load: loads[0],
                                right_load: loads[1],
                                pins: &values,
                                forces: &[],
                            })
                            .unwrap();
                        let exact = exact_curve([left, right], positions, tangents, loads, &pins, ratio);
                        let off = |(i, d): (usize, &f64)| (d - exact.value(i as f64 / intervals as f64)).abs();
                        Some(solved.iter().enumerate().map(off).fold(0.0, f64::max))
                    };
                    let (Some(coarse), Some(fine)) = (error(128), error(256)) else { continue };
                    let exact_already = fine < 1e-12;
                    let order = (coarse / fine).log2();
                    assert!(
                        exact_already || (order - 2.0).abs() < 0.05,
                        "{left:?} {right:?}, {} pins, ratio {ratio}: order {order}, {fine:e}",
                        pins.len()
                    );
                    cases += 1;
                }
            }
        }
    }
    // 81 less two free ends without a pin (3), and what turns about one point without tension: a natural end alone
    // (2) and one pin alone (1).
    assert_eq!(cases, 75);
}

#[test]
fn a_tip_under_load() {
    // d(0) = d'(0) = 0 and a load of 1.5 on the free end.
    let ends = |n: usize| {
        let beam = OpenBeam::new(n + 1, &[], Clamped, Free, Stiffness::default()).unwrap();
        let values = OpenValues { right_load: 1.5, ..OpenValues::ends(0.0, 0.0) };
        let curve = beam.solve(&values).unwrap();
        let reactions = beam.end_reactions(&curve, [0.0; 2]).unwrap();
        assert!((reactions[1].load - 1.5).abs() < 1e-8 && (reactions[0].load + 1.5).abs() < 1e-8, "{reactions:?}");
        assert_eq!(reactions[1].moment, 0.0);
        [curve[n] - 0.4746748663574, curve[n / 2] - 0.1566110714044]
    };
    let (coarse, fine) = (ends(64), ends(128));
    for k in [0, 1] {
        assert!(fine[k].abs() < 1e-4, "{fine:?}");
        assert!(((coarse[k] / fine[k]).log2() - 2.0).abs() < 0.05, "{coarse:?} {fine:?}");
    }
}

#[test]
fn loads_of_any_beam_balance() {
    let n = 65;
    let h = 1.0 / 64.0;
    let forces: Vec<f64> = (0..n).map(|i| (0.3 * i as f64).sin()).collect();
    for (left, right) in [(Clamped, Natural), (Free, Clamped), (Natural, Free), (Free, Free)] {
        let pins = [10, 11, 40];
        let beam = OpenBeam::new(n, &pins, left, right, Stiffness::default()).unwrap();
        let values = OpenValues {
            left_tangent: 1.0,
            right_tangent: -2.0,
            left_load: 0.7,
            right_load: -0.3,
            pins: &[0.1, 0.2, -0.4],
            forces: &forces,
            ..OpenValues::ends(0.5, -0.5)
        };
        let curve = beam.solve(&values).unwrap();
        let tangents = [1.0, -2.0];
        let ends = beam.end_reactions(&curve, tangents).unwrap();
        let pinned: f64 = beam.reactions(&curve, tangents).unwrap().iter().map(|f| h * f).sum();
        let inner: f64 = (1..n - 1).filter(|i| !pins.contains(i)).map(|i| h * forces[i]).sum();
        // A free end reports its load and half an interval of force as what holds it.
        let sum = ends[0].load + ends[1].load + pinned + inner;
        let largest = ends.iter().fold(pinned.abs(), |m, e| m.max(e.load.abs()));
        assert!(sum.abs() < 1e-9 * largest, "{left:?} {right:?}: {sum}");
        assert!(left != Free || (ends[0].load - (0.7 + 0.5 * h * forces[0])).abs() < 1e-8);
    }
}

#[test]
fn forces_on_a_closed_beam_are_of_second_order() {
    // d = sin(2 pi u) + 0.3 cos(4 pi u) under its own forces, held at three nodes.
    let (a, b) = (std::f64::consts::TAU, 2.0 * std::f64::consts::TAU);
    let exact = |u: f64| (a * u).sin() + 0.3 * (b * u).cos();
    let force =
        |u: f64, r: f64| (a.powi(4) + r * a * a) * (a * u).sin() + 0.3 * (b.powi(4) + r * b * b) * (b * u).cos();
    for ratio in [0.0, 2.8, 1e3] {
        let error = |n: usize| {
            let pins = [0, n / 4, n / 2 + n / 8];
            let at = |i: usize| i as f64 / n as f64;
            let forces: Vec<f64> = (0..n).map(|i| force(at(i), ratio)).collect();
            let values = pins.map(|pin| exact(at(pin)));
            let beam = ClosedBeam::new(n, &pins, stiffness(ratio)).unwrap();
            let curve = beam.solve_with_forces(&values, &forces).unwrap();
            curve.iter().enumerate().map(|(i, d)| (d - exact(at(i))).abs()).fold(0.0, f64::max)
        };
        let order = (error(256) / error(512)).log2();
        assert!((order - 2.0).abs() < 0.05, "ratio {ratio}: order {order}");
    }
}

#[test]
fn what_nothing_holds_is_refused() {
    let new = |pins: &[usize], left, right, ratio| OpenBeam::new(16, pins, left, right, stiffness(ratio)).map(|_| ());
    assert_eq!(new(&[], Free, Free, 2.8), Err(BeamError::NotHeld));
    for (pins, left, right) in [(&[][..], Natural, Free), (&[], Free, Natural), (&[7], Free, Free)] {
        assert_eq!(new(pins, left, right, 0.0), Err(BeamError::Turns));
        assert_eq!(new(pins, left, right, 2.8), Ok(()));
    }
    assert_eq!(new(&[3, 4], Free, Free, 0.0), Ok(()));
    assert!(BeamError::Turns.to_string().contains("pin another node"));
    // Held by next to nothing: told, and not answered with noise.
    let beam = OpenBeam::new(500, &[], Natural, Free, stiffness(1e-18));
    let solved = beam.and_then(|beam| beam.solve(&OpenValues { right_load: 1.0, ..OpenValues::ends(0.0, 0.0) }));
    assert_eq!(solved, Err(BeamError::NotSolvable));
}

proptest::proptest! {
    #[test]
    fn turned_around_mirrored_and_added_up(
        nodes in 6_usize..120,
        at in proptest::collection::vec((0_usize..120, -10.0..10.0_f64), 1..9),
        ends in (0_usize..3, 0_usize..3),
        given in proptest::collection::vec(-10.0..10.0_f64, 6),
        ratio in 0.1..1e4_f64,
    ) {
        let mut pins: Vec<(usize, f64)> = at.iter().map(|(pin, value)| (1 + pin % (nodes - 2), *value)).collect();
        pins.sort_by_key(|pin| pin.0);
        pins.dedup_by_key(|pin| pin.0);
        let conditions = [Clamped, Natural, Free];
        let solve = |back: bool, scale: f64| {
            let (mut at, mut values): (Vec<usize>, Vec<f64>) = pins.iter().map(|(at, value)| (*at, value * scale)).unzip();
            let (mut left, mut right) = (conditions[ends.0], conditions[ends.1]);
            let mut g: Vec<f64> = given.iter().map(|value| value * scale).collect();
            let mut forces: Vec<f64> = (0..nodes).map(|i| scale * 100.0 * (i as f64).sin()).collect();
            if back {
                at.iter_mut().for_each(|node| *node = nodes - 1 - *node);
                values.reverse();
                at.reverse();
                (left, right) = (right, left);
                g = vec![g[1], g[0], -g[3], -g[2], g[5], g[4]];
                forces.reverse();
            }
            OpenBeam::new(nodes, &at, left, right, stiffness(ratio))
                .unwrap()
                .solve(&OpenValues {
                    left: g[0],
                    right: g[1],
                    left_tangent: g[2],
                    right_tangent: g[3],
                    left_load: g[4],
                    right_load: g[5],
                    pins: &values,
                    forces: &forces,
                })
                .unwrap()
        };
        let (curve, turned, doubled) = (solve(false, 1.0), solve(true, 1.0), solve(false, -2.0));
        let largest = curve.iter().fold(10.0_f64, |m, d| m.max(d.abs()));
        for i in 0..nodes {
            proptest::prop_assert!((curve[i] - turned[nodes - 1 - i]).abs() < 1e-11 * largest);
            proptest::prop_assert!((2.0 * curve[i] + doubled[i]).abs() < 1e-11 * largest);
        }
    }
}
