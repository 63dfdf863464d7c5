//! The reference values of the fits, and the special cases printed in the thesis.

use super::composite::{Layout, Problem};
use super::*;
use crate::curve::Curve;
use glam::DVec3;
use nalgebra::DMatrix;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

fn closed(points: &[(f64, f64)]) -> Curve {
    Curve::new("c", points.iter().map(|(x, y)| DVec3::new(*x, *y, 0.0)).collect(), true).unwrap()
}

fn given(harmonics: usize) -> FitOptions {
    FitOptions {
        harmonics: Harmonics::Fixed(harmonics),
        angles: Angles::Polar,
        sampling: Sampling::AsGiven,
        ..FitOptions::default()
    }
}

fn near(found: f64, wanted: f64) -> bool {
    (found - wanted).abs() < 1e-12
}

/// The constants of the thesis: about the centre, y in the order constant, sine, cosine.
fn thesis_constants(section: &EllipticSection) -> (Vec<f64>, Vec<f64>) {
    let mut c = section.segments()[0].series.coefficients().to_vec();
    c[0] -= section.frame().origin;
    let a = c.iter().map(|c| c.x).collect();
    let mut b: Vec<f64> = c.iter().map(|c| c.y).collect();
    b[1..].chunks_exact_mut(2).for_each(|pair| pair.swap(0, 1));
    (a, b)
}

#[test]
fn v02_octagon_with_one_harmonic() {
    let octagon =
        closed(&[(2.0, 0.0), (1.5, 1.0), (0.0, 1.5), (-1.5, 1.0), (-2.0, 0.0), (-1.5, -1.0), (0.0, -1.5), (1.5, -1.0)]);
    let Fitted { section, report } = fit(&octagon, &given(1)).unwrap();
    let (a, b) = thesis_constants(&section);
    let wanted = [[0.0, 1.885482628361, 0.0], [0.0, 1.615343100088, 0.0]];
    assert!(a.iter().zip(wanted[0]).chain(b.iter().zip(wanted[1])).all(|(c, w)| near(*c, w)), "{a:?} {b:?}");
    assert_eq!(report.diagonal, 5.0);
    assert!(near(report.errors.mean, 0.02396107017201) && near(report.errors.maximum, 0.02493609317124));
    assert!(!report.met && report.warnings.is_empty());
}

#[test]
fn v03_nine_points_with_two_harmonics() {
    let points = [
        (3.0, 0.0),
        (2.0, 1.5),
        (0.5, 2.0),
        (-1.0, 1.8),
        (-2.5, 0.5),
        (-2.0, -1.0),
        (-0.5, -1.5),
        (1.0, -1.2),
        (2.2, -0.8),
    ];
    let Fitted { section, report } = fit(&closed(&points), &given(2)).unwrap();
    let (a, b) = thesis_constants(&section);
    let wanted_a = [-0.07443473898407, 2.431659551867, 0.0470784536735, -0.04483676113538, 0.06978235468656];
    let wanted_b = [0.05058753641221, 1.902100516979, 0.02727660458685, -0.08656185153688, -0.09915876432785];
    assert!(a.iter().zip(wanted_a).chain(b.iter().zip(wanted_b)).all(|(c, w)| near(*c, w)), "{a:?} {b:?}");
    assert!(section.frame().origin.distance(DVec3::new(0.3, 0.1444444444444, 0.0)) < 1e-12);
    assert!((report.diagonal - 6.519202405203).abs() < 1e-11);
    assert!(near(report.errors.mean, 0.04290394181378) && near(report.errors.maximum, 0.06166532135846));
    // The worst point is one of those given, at its own distance.
    let off = section.point(report.worst.angle).distance(report.worst.point);
    assert!(near(off, report.worst.distance) && near(off / report.diagonal, report.errors.maximum));
}

#[test]
fn v04_harmonics_of_an_ellipse() {
    let points: Vec<_> = (0..80).map(|k| TAU * f64::from(k) / 80.0).map(|t| (2.0 * t.cos(), t.sin())).collect();
    let options = FitOptions { angles: Angles::Polar, sampling: Sampling::AsGiven, ..FitOptions::default() };
    let report = fit(&closed(&points), &options).unwrap().report;
    assert_eq!(report.harmonics, [5]);
    assert!(near(report.errors.mean, 0.004054324483631) && near(report.errors.maximum, 0.005195239625644));
    assert!(report.met);
    for (harmonics, mean, maximum) in
        [(3, 0.01440035468362, 0.01854573027637), (10, 0.0003588375123884, 0.0004728984414577)]
    {
        let errors = fit(&closed(&points), &given(harmonics)).unwrap().report.errors;
        assert!(near(errors.mean, mean) && near(errors.maximum, maximum), "{harmonics}: {errors:?}");
    }
}

/// One segment tied at the angles of `joints` to `[value, derivative]`, as in the reference values: x alone.
fn tied(v: &[f64], f: &[f64], harmonics: usize, joints: &[(f64, f64, f64)]) -> EllipticSegment {
    let line = |(angle, value, slope): (f64, f64, f64)| EllipticSegment {
        from: angle,
        to: angle,
        local: false,
        // A series with this value and slope at the angle.
        series: Series::new(vec![DVec3::X * value, DVec3::ZERO, DVec3::X * slope]).unwrap().started_at(-angle),
    };
    let from = joints[0].0;
    let to = joints.get(1).map_or(from + 6.0, |joint| joint.0);
    let join = Some(Continuity::C1);
    let layout = Layout { closed: joints.len() > 1, ends: vec![from - 1.0, from, to], joins: vec![join, join] };
    let samples = [vec![], v.iter().copied().enumerate().collect()];
    let right = DMatrix::from_fn(v.len(), 3, |i, c| if c == 0 { f[i] } else { 0.0 });
    let problem = Problem { layout: &layout, samples: &samples, right: &right };
    let before = line(joints[0]);
    let behind = joints.get(1).map(|joint| line(*joint));
    problem.tied(1, harmonics, false, Some(&before), behind.as_ref()).unwrap().unwrap().0
}

fn check_tied(segment: &EllipticSegment, kind: char, wanted: &[f64], values: &[(f64, f64)]) {
    let mut found: Vec<f64> = segment.series.coefficients().iter().map(|c| c.x).collect();
    if kind == 'y' {
        found[1..].chunks_exact_mut(2).for_each(|pair| pair.swap(0, 1));
    }
    assert!(found.iter().zip(wanted).all(|(f, w)| (f - w).abs() < 2e-9), "{found:?} {wanted:?}");
    for (v, value) in values {
        assert!((segment.derivatives::<1>(*v)[0].x - value).abs() < 1e-9, "at {v}");
    }
}

const F: [f64; 7] = [0.8, 0.5, 0.1, -0.4, -0.8, -1.1, -1.2];

#[test]
fn v07_one_joint() {
    let segment = tied(&[0.9, 1.3, 1.7, 2.1, 2.5, 2.9, 3.3], &F, 2, &[(0.7, 1.0, -0.6)]);
    let c = [0.05581327095747, 1.19555001936, 0.120457576914, -0.0465918375949, -0.04049134283554];
    check_tied(&segment, 'x', &c, &[(1.0, 0.7857036310468), (2.0, -0.271080916079), (3.0, -1.144195492622)]);
}

#[test]
fn v08_one_joint_where_cosine_vanishes() {
    let f = [0.7, 0.9, 1.1, 0.9, 0.6, 0.2, -0.3];
    let segment = tied(&[1.8, 2.1, 2.4, 2.7, 3.0, 3.3, 3.6], &f, 2, &[(FRAC_PI_2, 0.75, 0.3)]);
    let c = [0.3931407653053, 0.7751351761154, 0.3764557344242, -0.3382278672121, 0.4182759414207];
    check_tied(&segment, 'y', &c, &[(2.0, 0.9238766164269), (3.0, 0.6259617338187)]);
}

#[test]
fn v09_special_case_one() {
    let segment = tied(&[0.3, 0.6, 0.9, 1.2, 1.5, 1.8, 2.1], &F, 2, &[(0.0, 1.1, -0.2)]);
    let c = [-0.6230693397288, 1.329076745427, 0.1409401491104, 0.3939925943017, -0.1704700745552];
    check_tied(&segment, 'x', &c, &[(1.0, -0.1053358353134), (2.0, -1.176522476078)]);
}

#[test]
fn v10_special_case_two() {
    let segment = tied(&[3.4, 3.7, 4.0, 4.3, 4.6, 4.9, 5.2], &F, 2, &[(PI, 1.1, -0.2)]);
    let c = [-0.9088403185772, -1.549081530868, -0.4548212368234, 0.4597587877087, -0.3274106184117];
    check_tied(&segment, 'x', &c, &[(4.0, 0.0570954747065), (5.0, -1.119769267126)]);
}

#[test]
fn v11_last_segment_from_pi_to_two_pi() {
    let f = [-0.3, -0.6, -0.9, -1.1, -1.2, -1.2, -1.0, -0.8, -0.5, -0.2];
    let v = [3.4, 3.7, 4.0, 4.3, 4.6, 4.9, 5.2, 5.5, 5.8, 6.1];
    let segment = tied(&v, &f, 3, &[(PI, 0.05, -1.2), (TAU, 0.0, 1.1)]);
    let c = [
        0.04231301163079,
        1.238402031721,
        -0.01595918444873,
        -0.025,
        -0.01731301163079,
        -0.02946734390691,
        -0.00904081555127,
    ];
    check_tied(&segment, 'y', &c, &[(4.0, -0.898513778736), (5.0, -1.133914449731)]);
}

/// The elimination of the thesis for one joint (3.16 as corrected, 3.17), in x: the curve at `v` with free
/// constants `a2, a3, ..`.
fn eliminated(v: f64, joint: (f64, f64, f64), free: &[f64]) -> f64 {
    let (v1, value, slope) = joint;
    let mut x = value + slope * (v1.cos() - v.cos()) / v1.sin();
    for (i, a) in free.iter().enumerate() {
        let j = ((i + 2) as f64 / 2.0).ceil();
        x += if i % 2 == 0 {
            a * (j * (j * v1).cos() / v1.sin() * (v.cos() - v1.cos()) + (j * v).sin() - (j * v1).sin())
        } else {
            a * (j * (j * v1).sin() / v1.sin() * (v1.cos() - v.cos()) - (j * v1).cos() + (j * v).cos())
        };
    }
    x
}

#[test]
fn the_elimination_of_the_thesis_is_the_same_curve() {
    let v: Vec<f64> = (0..30).map(|i| 0.9 + 0.08 * f64::from(i)).collect();
    let f: Vec<f64> = v.iter().map(|v| (1.3 * v).cos() + 0.1 * (5.0 * v).sin()).collect();
    let joint = (0.7, 0.6, -0.9);
    let segment = tied(&v, &f, 3, &[joint]);
    // a2, a3, .. of the solution: put into 3.17 they must give the same curve, and be the best of their neighbours.
    let mut free: Vec<f64> = segment.series.coefficients()[2..].iter().map(|c| c.x).collect();
    let sum = |free: &[f64]| v.iter().zip(&f).map(|(v, f)| (eliminated(*v, joint, free) - f).powi(2)).sum::<f64>();
    for v in [0.7, 1.0, 2.0, 3.3] {
        assert!((eliminated(v, joint, &free) - segment.derivatives::<1>(v)[0].x).abs() < 1e-12);
    }
    let best = sum(&free);
    for i in 0..free.len() {
        for step in [1e-4, -1e-4] {
            free[i] += step;
            assert!(sum(&free) > best);
            free[i] -= step;
        }
    }
}

#[test]
fn v12_two_segments_in_turn_and_together() {
    let points = [
        (1.3, 0.0),
        (1.245, 0.516),
        (0.928, 0.928),
        (0.454, 1.095),
        (0.0, 1.0),
        (-0.312, 0.752),
        (-0.486, 0.486),
        (-0.602, 0.25),
        (-0.7, 0.0),
        (-0.733, -0.304),
        (-0.628, -0.628),
        (-0.366, -0.883),
        (0.0, -1.0),
        (0.4, -0.965),
        (0.786, -0.786),
        (1.115, -0.462),
    ];
    let curve = closed(&points);
    let frame = fit(&curve, &given(1)).unwrap().section.frame().to_owned();
    let at = |i: usize| Joint { angle: frame.angle(curve.points()[i]), continuity: Continuity::C1 };
    let wanted = [
        (Solution::InTurn, (0.7966334783862, 1.006560586737), (-0.5195649965576, -0.7676019442087)),
        (Solution::Together, (0.7987996917365, 1.006556463534), (-0.5164548067303, -0.7682939645776)),
    ];
    for (solution, at_one, at_four) in wanted {
        let options = FitOptions { split: Split::At(vec![at(0), at(7)]), solution, ..given(3) };
        let section = fit(&curve, &options).unwrap().section;
        let gap = |v: f64, (x, y)| section.point(v).distance(DVec3::new(x, y, 0.0));
        assert!(gap(1.0, at_one) < 1e-9 && gap(4.0, at_four) < 1e-9, "{solution:?}");
        assert_smooth(&section, Continuity::C1);
    }
}

fn assert_smooth(section: &EllipticSection, continuity: Continuity) {
    let segments = section.segments();
    let first = usize::from(!section.is_closed());
    let size = section.frame().diagonal(&section.sampled(100));
    // Coefficients may be far larger than the curve, where segments are fitted in turn or in angles not their own.
    let bound = segments.iter().map(|s| s.series.derivative_bound(0)).fold(0.0, f64::max);
    let rounding = 1e-14 * bound;
    for i in first..segments.len() {
        let before = &segments[(i + segments.len() - 1) % segments.len()];
        let there = before.derivatives::<3>(before.to);
        let here = segments[i].derivatives::<3>(segments[i].from);
        for order in 0..=continuity.order() {
            let gap = here[order].distance(there[order]);
            assert!(gap < 1e-8 * size.max(here[order].length()) + rounding, "joint {i}, order {order}: {gap}");
        }
    }
}

fn peanut() -> Curve {
    let points: Vec<_> = (0..160)
        .map(|i| TAU * f64::from(i) / 160.0)
        .map(|t| (1.0 + 0.45 * (2.0 * t).cos(), t))
        .map(|(r, t)| (r * t.cos(), r * t.sin()))
        .collect();
    closed(&points)
}

#[test]
fn joints_are_as_smooth_as_asked() {
    for continuity in [Continuity::C0, Continuity::C1, Continuity::C2] {
        for solution in [Solution::Together, Solution::InTurn] {
            for local_angles in [LocalAngles::Never, LocalAngles::Always, LocalAngles::Auto] {
                let joint = |angle| Joint { angle, continuity };
                let options = FitOptions {
                    split: Split::At(vec![joint(0.3), joint(1.8), joint(FRAC_PI_2 * 3.0)]),
                    solution,
                    local_angles,
                    ..FitOptions::default()
                };
                let fitted = fit(&peanut(), &options).unwrap();
                assert_smooth(&fitted.section, continuity);
                assert!(fitted.report.met, "{continuity:?} {solution:?} {local_angles:?}: {:?}", fitted.report);
                assert_eq!(fitted.section.joints().len(), 3);
                let shift = fitted.section.segments()[0].local;
                assert_eq!(shift, local_angles == LocalAngles::Always);
            }
        }
    }
}

#[test]
fn open_strokes_are_split_too() {
    let stroke: Vec<DVec3> = (0..100)
        .map(|i| 0.07 * f64::from(i))
        .map(|t| DVec3::new(t, t.sin() + 0.2 * (5.0 * t).sin(), 0.1 * t))
        .collect();
    let stroke = Curve::new("stroke", stroke, false).unwrap();
    let joints = |continuity| Split::At([1.0, 2.5].map(|angle| Joint { angle, continuity }).to_vec());
    for continuity in [Continuity::C0, Continuity::C1, Continuity::C2] {
        for solution in [Solution::Together, Solution::InTurn] {
            let options = FitOptions { split: joints(continuity), solution, ..FitOptions::default() };
            let fitted = fit(&stroke, &options).unwrap();
            assert_smooth(&fitted.section, continuity);
            // In turn, what the first segment's free end happens to curve like binds all that follows.
            let bound = solution == Solution::InTurn && continuity == Continuity::C2;
            assert_eq!(fitted.report.met, !bound, "{:?}", fitted.report);
        }
    }
    let split = Split::Automatic { most: 4, corner_angle: 1.0 };
    let fitted = fit(&stroke, &FitOptions { split, ..FitOptions::default() }).unwrap();
    assert!(fitted.report.met && fitted.section.segments().len() > 1 && fitted.section.harmonics() <= 4);
    assert_smooth(&fitted.section, Continuity::C1);
}

#[test]
fn together_is_never_worse_than_in_turn() {
    let joints: Vec<Joint> = [0.2, 1.4, 3.9].map(|angle| Joint { angle, continuity: Continuity::C1 }).to_vec();
    for harmonics in 2..=6 {
        let peanut = peanut();
        let errors = [Solution::Together, Solution::InTurn].map(|solution| {
            let split = Split::At(joints.clone());
            let options = FitOptions { solution, split, sampling: Sampling::Even, ..given(harmonics) };
            let fitted = fit(&peanut, &options).unwrap();
            let polar: Vec<f64> = peanut.points().iter().map(|p| fitted.section.frame().angle(*p)).collect();
            let squares =
                peanut.points().iter().zip(&polar).map(|(p, v)| fitted.section.point(*v).distance_squared(*p));
            squares.sum::<f64>()
        });
        assert!(errors[0] <= errors[1] * (1.0 + 1e-9), "{harmonics}: {errors:?}");
    }
}

#[test]
fn a_teardrop_is_one_segment_with_a_corner() {
    // From a tip of 60 degrees along tangents around a circle.
    let arc = (0..=80).map(|i| PI * (f64::from(i) / 60.0 - 1.0 / 6.0)).map(|t| (t.cos(), t.sin()));
    let points: Vec<_> = [(0.0, -2.0)].into_iter().chain(arc).collect();
    let drop = closed(&points);
    let frame = fit(&drop, &FitOptions::default()).unwrap().section.frame().to_owned();
    let corner = Joint { angle: frame.angle(drop.points()[0]), continuity: Continuity::C0 };
    let tight = Tolerances { mean: 0.0005, maximum: 0.002 };
    let smooth = FitOptions { tolerances: tight, angles: Angles::Polar, ..FitOptions::default() };
    let sharp = FitOptions { split: Split::At(vec![corner]), ..smooth.clone() };
    let [smooth, sharp] = [smooth, sharp].map(|options| fit(&drop, &options).unwrap());
    assert!(sharp.report.met && sharp.section.segments()[0].local);
    assert!(2 * sharp.section.harmonics() <= smooth.section.harmonics(), "{:?} {:?}", sharp.report, smooth.report);
    let [start, end] = [sharp.section.range().0, sharp.section.range().1 - 1e-9].map(|v| sharp.section.tangent(v));
    assert!(start.angle_between(end) > 0.5, "the corner stays");
}

#[test]
fn the_estimate_of_the_condition_is_near() {
    for range in [PI / 4.0, FRAC_PI_2, PI, 1.5 * PI, TAU] {
        for harmonics in [3, 5, 8] {
            let angles: Vec<f64> = (0..400).map(|i| range * f64::from(i) / 400.0).collect();
            let values = super::least_squares::design(&angles, harmonics).singular_values();
            let exact = values.max() / values.min();
            let estimate = super::composite::condition(range, harmonics);
            if exact < 1e13 {
                assert!(estimate / exact < 3.0 && exact / estimate < 3.0, "{range} {harmonics}: {estimate} {exact}");
            }
        }
    }
}
