//! Fits do not depend on where a curve stands or how it was drawn, and nothing drawn makes them panic.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a failing unwrap is a failing test")]

use glam::{DQuat, DVec3};
use maquette_geometry::curve::{Curve, Resampling, resample};
use maquette_geometry::trigonometric::{
    Angles, Continuity, EllipticSegment, FitError, FitOptions, FitReport, FitWarning, Fitted, Harmonics, Joint,
    LocalAngles, Sampling, Solution, Split, Start, Tolerances, fit, fit_sections,
};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

fn drawn(closed: bool, count: u32, turn: f64, f: impl Fn(f64) -> (f64, f64)) -> Curve {
    let intervals = f64::from(count - u32::from(!closed));
    let points = (0..count).map(|i| f(turn * f64::from(i) / intervals)).map(|(x, y)| DVec3::new(x, y, 0.0));
    Curve::new("drawn", points.collect(), closed).unwrap()
}

fn given(angles: Angles) -> FitOptions {
    FitOptions { angles, sampling: Sampling::AsGiven, ..FitOptions::default() }
}

#[test]
fn harmonics_of_known_shapes() {
    let kinds = [Angles::Polar, Angles::ArcLength];
    let found = |curve: &Curve| kinds.map(|kind| fit(curve, &given(kind)).unwrap().report.harmonics[0]);
    let ellipse = |a: f64| drawn(true, 80, TAU, move |t| (a * t.cos(), t.sin()));
    let wanted = [(1.0, [1, 1]), (1.2, [3, 1]), (1.5, [3, 3]), (2.0, [5, 3]), (3.0, [7, 5]), (4.0, [9, 5])];
    for (a, wanted) in wanted {
        assert_eq!(found(&ellipse(a)), wanted, "{a}:1");
    }
    let strokes = [
        ("line", 2, drawn(false, 80, 1.0, |t| (t, 0.5 * t))),
        ("quarter arc", 2, drawn(false, 80, FRAC_PI_2, |t| (t.cos(), t.sin()))),
        ("half arc", 1, drawn(false, 80, PI, |t| (t.cos(), t.sin()))),
        ("300 degrees", 2, drawn(false, 80, PI / 0.6, |t| (t.cos(), t.sin()))),
    ];
    for (name, wanted, stroke) in strokes {
        let Fitted { section, report } = fit(&stroke, &given(Angles::Auto)).unwrap();
        assert_eq!((report.harmonics[0], section.range()), (wanted, (0.0, PI)), "{name}");
    }
}

/// A banana around its own centre: two points share a polar angle.
fn kidney() -> Curve {
    drawn(true, 120, TAU, |t| {
        let (angle, radius) = (1.3 * t.cos(), 2.0 + 0.6 * t.sin());
        (radius * angle.sin(), radius * angle.cos())
    })
}

#[test]
fn kidneys_go_by_arc_length() {
    let fitted = fit(&kidney(), &FitOptions::default()).unwrap();
    assert!(fitted.report.met && fitted.report.harmonics[0] <= 8, "{:?}", fitted.report);
    assert!(fitted.report.warnings.is_empty());
    let stack = fit_sections(&[drawn(true, 80, TAU, |t| (t.cos(), t.sin())), kidney()], &FitOptions::default());
    assert_eq!(stack.unwrap().angles, Angles::ArcLength, "one kind for all");
    let refused = fit(&kidney(), &given(Angles::Polar)).unwrap_err();
    assert!(matches!(refused, FitError::NotStarShaped { .. }), "{refused}");
}

#[test]
fn angles_of_a_stack_mean_the_same_place() {
    // A bent tube of ellipses, each drawn from another point, one the other way.
    let ring = |k: u32| {
        let bend = DQuat::from_rotation_x(0.3 * f64::from(k));
        let centre = DVec3::new(0.0, 2.0 * (0.3 * f64::from(k)).sin(), 2.0 * (1.0 - (0.3 * f64::from(k)).cos()));
        let shift = 0.7 * f64::from(k);
        let sign = if k == 2 { -1.0 } else { 1.0 };
        let angles = (0..80).map(|i| sign * TAU * f64::from(i) / 80.0 + shift);
        let points = angles.map(|t| centre + bend * DVec3::new(0.5 * t.cos(), 0.0, -0.4 * t.sin())).collect();
        Curve::new(format!("ring {k}"), points, true).unwrap()
    };
    let rings: Vec<Curve> = (0..5).map(ring).collect();
    let stack = fit_sections(&rings, &FitOptions::default()).unwrap();
    for (k, fitted) in stack.sections.iter().enumerate() {
        let frame = fitted.section.frame();
        assert!(frame.e1.distance(DVec3::X) < 1e-9, "{k}: {frame:?}");
        let side = fitted.section.point(0.0) - frame.origin;
        assert!(side.distance(DVec3::X * 0.5) < 0.01, "{k}: {side}");
        assert_eq!(fitted.report.reversed, k == 2);
    }
    let lengths = FitOptions { angles: Angles::ArcLength, start: Start::FirstPoint, ..FitOptions::default() };
    let stack = fit_sections(&rings, &lengths).unwrap();
    let first = stack.sections[0].section.nearest(rings[0].start()).angle;
    for (curve, fitted) in rings.iter().zip(&stack.sections) {
        assert!(fitted.section.point(first).distance(curve.start()) < 0.03, "first points correspond");
    }
}

#[test]
fn refusals_name_the_place_and_the_remedy() {
    let circle = || drawn(true, 80, TAU, |t| (t.cos(), t.sin()));
    let stroke = drawn(false, 40, 1.0, |t| (t, t * t));
    let joint = |angle, continuity| Joint { angle, continuity };
    let at = |joints: &[Joint]| Split::At(joints.to_vec());
    let smooth = |angles: &[f64]| at(&angles.iter().map(|angle| joint(*angle, Continuity::C1)).collect::<Vec<_>>());
    let defaults = FitOptions::default;
    let fixed = |harmonics| FitOptions { harmonics: Harmonics::Fixed(harmonics), ..given(Angles::Auto) };
    let cases: Vec<(&[Curve], FitOptions, &str)> = vec![
        (&[], defaults(), "no curve given: give at least one cross-section"),
        (
            &[],
            FitOptions { harmonics: Harmonics::Fixed(0), ..defaults() },
            "0 harmonics asked for: a series needs 1 to 100",
        ),
        (
            &[],
            FitOptions { tolerances: Tolerances { mean: f64::NAN, maximum: 1.0 }, ..defaults() },
            "a tolerance of the mean error of NaN given: it must be a positive number",
        ),
        (
            &[],
            FitOptions { largest_distance: Some(0.0), ..defaults() },
            "a largest distance of 0 given: it must be a positive number",
        ),
        (
            &[],
            FitOptions { split: Split::Corners { angle: -1.0 }, ..defaults() },
            "a corner angle of -1 given: it must be a positive number",
        ),
    ];
    for (curves, options, message) in cases {
        assert_eq!(fit_sections(curves, &options).unwrap_err().to_string(), message);
    }
    let mixed = fit_sections(&[circle(), stroke.clone()], &defaults()).unwrap_err().to_string();
    assert_eq!(mixed, "curve \"drawn\" is open, and the first one is not: close them all, or none");
    let of = |curve: &Curve, options: FitOptions| fit(curve, &options).unwrap_err().to_string();
    assert_eq!(of(&stroke, given(Angles::Polar)), "curve \"drawn\" is open and has no polar angles: take arc length");
    assert!(of(&kidney(), given(Angles::Polar)).ends_with("so that two points share a polar angle: take arc length"));
    assert_eq!(
        of(&circle(), fixed(40)),
        "curve \"drawn\": 40 harmonics have 81 constants, and there are 80 points for them: lower the harmonics to 39, \
         or sample evenly"
    );
    let two = Curve::new("two", vec![DVec3::ZERO, DVec3::X], false).unwrap();
    assert!(matches!(fit(&two, &given(Angles::Auto)), Err(FitError::SegmentTooShort { points: 2, needed: 3, .. })));
    assert!(fit(&two, &defaults()).is_ok(), "resampled");
    assert_eq!(
        of(&circle(), FitOptions { split: smooth(&[0.0, PI]), ..fixed(1) }),
        "segment 0 has 1 harmonic(s), and the joints at its ends need 2: raise the harmonics, or lower the continuity"
    );
    assert_eq!(
        of(&circle(), FitOptions { split: smooth(&[1.0, 2.0, 1.0 + TAU]), ..defaults() }),
        "joints 0 and 2 are both at the angle 1: remove one, or move it"
    );
    assert_eq!(
        of(&stroke, FitOptions { split: smooth(&[4.0]), ..defaults() }),
        "joint 0 is at the angle 4: an open section is split inside 0 to pi, a closed one at any number"
    );
    let near = of(&circle(), FitOptions { split: smooth(&[1.0, 1.1]), ..given(Angles::Auto) });
    assert!(near.contains("between the angles 1 and 1.1, and 5 are needed: move the joints apart"), "{near}");
    let huge = Curve::new("huge", vec![DVec3::ZERO, DVec3::X * 1e200, DVec3::Y * 1e200], true).unwrap();
    assert!(of(&huge, defaults()).starts_with("curve \"huge\" is too small or too large to fit"));
}

#[test]
fn warnings_say_what_is_odd() {
    let eight = drawn(true, 100, TAU, |t| (t.sin(), (2.0 * t).sin()));
    let FitReport { warnings, .. } = fit(&eight, &FitOptions::default()).unwrap().report;
    assert!(matches!(&warnings[..], [FitWarning::Crossing { at, .. }] if at.length() < 0.1), "{warnings:?}");
    let tight = FitOptions {
        harmonics: Harmonics::Smallest { most: 2 },
        tolerances: Tolerances { mean: 1e-6, maximum: 1e-6 },
        ..FitOptions::default()
    };
    let report = fit(&kidney(), &tight).unwrap().report;
    assert!(!report.met && matches!(report.warnings[..], [FitWarning::NotMet { harmonics: 2, .. }]));
    let few = fit(
        &drawn(true, 12, TAU, |t| (t.cos(), t.sin())),
        &FitOptions { harmonics: Harmonics::Fixed(5), ..given(Angles::Polar) },
    );
    assert!(matches!(few.unwrap().report.warnings[..], [FitWarning::FewPoints { most: 2, .. }]));
}

/// That the report tells the truth of its worst point, to a rounding of the angle, times the pace at which the curve may
/// pass.
fn worst_point_is_told(Fitted { section, report }: &Fitted) -> Result<(), String> {
    let off = section.point(report.worst.angle).distance(report.worst.point);
    let pace = section.segments().iter().map(|s| s.series.derivative_bound(1)).fold(0.0, f64::max);
    let allowed = 1e-9 * report.diagonal + 1e-14 * pace;
    let told = (off - report.worst.distance).abs() <= allowed;
    if told { Ok(()) } else { Err(format!("{off} {allowed} {report:?}")) }
}

#[test]
fn a_worst_point_beside_a_joint_is_told() {
    // A sample lies beside a joint, and beyond the end of the segment before, which runs far away there.
    let needle = [[-0.74, 0.0, 0.0], [0.0, 0.0, 9.2e8], [-0.27, 0.0, 0.0]].map(DVec3::from).to_vec();
    let options = FitOptions {
        harmonics: Harmonics::Fixed(2),
        split: Split::Corners { angle: 0.2 },
        continuity: Continuity::C0,
        ..FitOptions::default()
    };
    for solution in [Solution::Together, Solution::InTurn] {
        for start in [Start::Ray, Start::FirstPoint] {
            let options = FitOptions { solution, start, ..options.clone() };
            let needle = Curve::new("needle", needle.clone(), true).unwrap();
            fit(&needle, &options).map(|found| worst_point_is_told(&found).unwrap()).unwrap();
        }
    }
}

/// A random smooth loop: polar radius with a few waves, stretched.
fn shape() -> impl Strategy<Value = Curve> {
    (prop::collection::vec((-0.08..0.08_f64, 0.0..TAU), 1..6), 0.5..2.0_f64).prop_map(|(waves, stretch)| {
        let radius = move |t: f64| {
            1.0 + (2..).zip(&waves).map(|(j, (size, phase))| size * (f64::from(j) * t + phase).cos()).sum::<f64>()
        };
        let dense = drawn(true, 400, TAU, move |t| (stretch * radius(t) * t.cos(), radius(t) * t.sin()));
        resample(&dense, &Resampling::count(100)).unwrap()
    })
}

fn options() -> impl Strategy<Value = FitOptions> {
    let harmonics = prop_oneof![
        (1..12_usize).prop_map(Harmonics::Fixed),
        (1..31_usize).prop_map(|most| Harmonics::Smallest { most })
    ];
    let continuity = prop_oneof![Just(Continuity::C0), Just(Continuity::C1), Just(Continuity::C2)];
    let joint = (-7.0..7.0_f64, continuity.clone()).prop_map(|(angle, continuity)| Joint { angle, continuity });
    let split = prop_oneof![
        Just(Split::None),
        prop::collection::vec(joint, 0..4).prop_map(Split::At),
        (0.2..2.0_f64).prop_map(|angle| Split::Corners { angle }),
        (1..10_usize).prop_map(|most| Split::Automatic { most, corner_angle: 1.0 }),
    ];
    let kinds = (
        prop_oneof![Just(Angles::Auto), Just(Angles::Polar), Just(Angles::ArcLength)],
        prop_oneof![Just(Start::Ray), Just(Start::FirstPoint)],
        prop_oneof![Just(Sampling::Even), Just(Sampling::AsGiven)],
        prop_oneof![Just(Solution::Together), Just(Solution::InTurn)],
        prop_oneof![Just(LocalAngles::Auto), Just(LocalAngles::Never), Just(LocalAngles::Always)],
        any::<bool>(),
    );
    (harmonics, split, continuity, kinds).prop_map(|(harmonics, split, continuity, kinds)| {
        let (angles, start, sampling, solution, local_angles, common_harmonics) = kinds;
        FitOptions {
            harmonics,
            angles,
            start,
            sampling,
            split,
            continuity,
            solution,
            local_angles,
            common_harmonics,
            ..FitOptions::default()
        }
    })
}

/// A coordinate as people and broken files write it.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -1.0..1.0_f64, 2 => Just(0.0), 2 => (-3..4_i32).prop_map(f64::from), 1 => -1e9..1e9, 1 => Just(1e160)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn moving_turning_and_scaling_moves_the_fit(
        curve in shape(),
        (axis, angle) in ([-1.0..1.0_f64, -1.0..1.0, -1.0..1.0], 0.0..TAU),
        (shift, scale) in ([-5.0..5.0_f64, -5.0..5.0, -5.0..5.0], 1e-3..1e3_f64),
        harmonics in 1..9_usize,
        polar in any::<bool>(),
    ) {
        let turn = DQuat::from_axis_angle(DVec3::from(axis).try_normalize().unwrap_or(DVec3::Z), angle);
        let map = |p: DVec3| turn * p * scale + DVec3::from(shift);
        let moved = curve.map(map).unwrap();
        let kind = if polar { Angles::Polar } else { Angles::ArcLength };
        let options = FitOptions {
            harmonics: Harmonics::Fixed(harmonics), start: Start::FirstPoint, about: None, ..given(kind)
        };
        let [one, other] = [&curve, &moved].map(|curve| fit(curve, &options).unwrap());
        let size = one.report.diagonal;
        let gap = one.report.worst.distance - other.report.worst.distance / scale;
        prop_assert!(gap.abs() < 1e-9 * size, "{gap}");
        for point in curve.points().iter().step_by(7) {
            let foot = map(one.section.nearest(*point).point);
            let distance = other.section.nearest(foot).distance / scale;
            prop_assert!(distance < 1e-8 * size, "{distance}");
        }
        prop_assert!((one.section.area() - other.section.area() / scale / scale).abs() < 1e-8);
        prop_assert!((one.section.length() - other.section.length() / scale).abs() < 1e-6);
    }

    #[test]
    fn the_start_and_direction_of_drawing_do_not_matter(curve in shape(), start in 0..100_usize, back in any::<bool>()) {
        let mut points = curve.points().to_vec();
        points.rotate_left(start);
        let other = Curve::new("drawn", points, true).unwrap();
        let other = if back { other.reversed() } else { other };
        for kind in [Angles::Polar, Angles::ArcLength] {
            let [one, other] = [&curve, &other].map(|curve| fit(curve, &given(kind)).unwrap());
            prop_assert_eq!(&one.report.harmonics, &other.report.harmonics);
            prop_assert!((one.report.worst.distance - other.report.worst.distance).abs() < 1e-10);
            let sign = if back { -1.0 } else { 1.0 };
            for i in 0..20 {
                let v = TAU * f64::from(i) / 20.0;
                let gap = one.section.point(v).distance(other.section.point(sign * v));
                prop_assert!(gap < 1e-9, "{:?} at {}: {}", kind, v, gap);
            }
        }
    }

    #[test]
    fn noise_is_averaged_out(noise in prop::collection::vec(-1.0..1.0_f64, 200), size in 0.0..0.03_f64) {
        let circle = |i: usize| DVec3::new((TAU * i as f64 / 200.0).cos(), (TAU * i as f64 / 200.0).sin(), 0.0);
        let points = noise.iter().enumerate().map(|(i, noise)| circle(i) * (1.0 + size * noise)).collect();
        let curve = Curve::new("noisy", points, true).unwrap();
        let fitted = fit(&curve, &FitOptions { harmonics: Harmonics::Fixed(3), ..given(Angles::Polar) }).unwrap();
        let off = fitted.section.sampled(200).into_iter().map(|p| (p.length() - 1.0).abs()).fold(0.0, f64::max);
        // Seven constants of 200 samples: a fifth of the noise, unless it conspires.
        prop_assert!(off <= 0.6 * size + 1e-12, "{off} {size}");
    }

    #[test]
    fn doubled_points_change_nothing(curve in shape(), doubled in 0..100_usize) {
        let mut points = curve.points().to_vec();
        points.insert(doubled, points[doubled]);
        let other = Curve::new("drawn", points, true).unwrap();
        prop_assert_eq!(fit(&other, &FitOptions::default()).unwrap(), fit(&curve, &FitOptions::default()).unwrap());
    }

    #[test]
    fn straight_strokes_need_two_harmonics(end in [-9.0..9.0_f64, -9.0..9.0, -9.0..9.0], middle in 0.1..0.9_f64) {
        let end = DVec3::from(end) + DVec3::Z * 10.0;
        let line = Curve::new("line", vec![DVec3::ZERO, end * middle, end], false).unwrap();
        let Fitted { section, report } = fit(&line, &FitOptions::default()).unwrap();
        prop_assert!(report.met && report.harmonics[0] <= 2);
        let off = section.sampled(50).into_iter().map(|p| p.cross(end).length() / end.length());
        prop_assert!(off.fold(0.0, f64::max) < 1e-12);
    }

    #[test]
    fn whatever_is_drawn_fits_or_is_refused(
        points in prop::collection::vec([coordinate(), coordinate(), coordinate()], 2..40),
        closed in any::<bool>(),
        options in options(),
    ) {
        let points = points.into_iter().map(DVec3::from).collect();
        let Ok(curve) = Curve::new("drawn", points, closed) else { return Ok(()) };
        let found = fit(&curve, &options);
        prop_assert_eq!(&found, &fit(&curve, &options));
        match found {
            Ok(found) => {
                let Fitted { section, report } = &found;
                prop_assert!(section.sampled(50).into_iter().all(DVec3::is_finite));
                prop_assert!(section.length().is_finite() && section.area().is_finite());
                prop_assert_eq!(section.segments().len(), report.harmonics.len());
                prop_assert_eq!(worst_point_is_told(&found), Ok(()));
            }
            Err(error) => prop_assert!(error.to_string().contains(':'), "{}", error),
        }
    }

    #[test]
    fn stacks_share_their_joints(
        curves in prop::collection::vec(shape(), 1..4),
        options in options(),
    ) {
        let curves: Vec<Curve> = (0..)
            .zip(&curves)
            .map(|(k, curve)| curve.map(|p| p + DVec3::Z * f64::from(k)).unwrap())
            .collect();
        if let Ok(stack) = fit_sections(&curves, &options) {
            let alike = |i: usize| -> Vec<(f64, f64, bool)> {
                let segments = stack.sections[i].section.segments();
                segments.iter().map(|s| (s.from, s.to, s.local)).collect()
            };
            prop_assert!((0..curves.len()).all(|i| alike(i) == alike(0)));
            for fitted in &stack.sections {
                let segments = fitted.section.segments();
                if stack.joints.is_empty() {
                    continue;
                }
                // Round-off grows with the coefficients of all, which may be huge in angles that are not local.
                let bound = |s: &EllipticSegment| s.series.derivative_bound(2) * s.rate().powi(2).max(1.0);
                let size = segments.iter().map(bound).fold(1.0, f64::max);
                for (k, joint) in stack.joints.iter().enumerate() {
                    let before = &segments[(k + segments.len() - 1) % segments.len()];
                    let there = before.derivatives::<3>(before.to);
                    let here = segments[k].derivatives::<3>(segments[k].from);
                    for order in 0..=joint.continuity.order() {
                        let gap = here[order].distance(there[order]);
                        prop_assert!(gap <= 1e-9 + 1e-12 * size, "{} {}: {} of {}, {:?}", k, order, gap, size, options);
                    }
                }
            }
        }
    }
}
