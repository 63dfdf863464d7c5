//! What resampling keeps, how evenly it spaces, and what it refuses.

use super::*;
use crate::curve::{ArcLength, closest};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_4, TAU};

fn circle(count: usize, closed: bool) -> Curve {
    let points = (0..count).map(|i| TAU * i as f64 / count as f64).map(|a| DVec3::new(a.cos(), a.sin(), 0.0));
    Curve::new("circle", points.collect(), closed).unwrap()
}

fn rectangle(start: usize) -> Curve {
    // Corners and the middles of the sides; the first point is corner 0 or, for start 1, a middle.
    let mut points: Vec<DVec3> = [(0, 0), (1, 0), (2, 0), (2, 1), (2, 2), (1, 2), (0, 2), (0, 1)]
        .map(|(x, y)| DVec3::new(x.into(), y.into(), 0.0))
        .into();
    points.rotate_left(start);
    Curve::new("rectangle", points, true).unwrap()
}

/// Lengths between neighbouring points of a curve.
fn spacings(curve: &Curve) -> Vec<f64> {
    ArcLength::of(curve).cumulative().windows(2).map(|pair| pair[1] - pair[0]).collect()
}

fn spread(values: &[f64]) -> f64 {
    let (low, high) = values.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), v| (l.min(*v), h.max(*v)));
    (high - low) / high
}

#[test]
fn straight_stroke_is_spaced_evenly_with_its_pressure() {
    let points = vec![DVec3::ZERO, DVec3::X, DVec3::X * 4.0];
    let curve = Curve::with_pressure("line", points, false, Some(vec![0.0, 1.0, 0.4])).unwrap();
    let even = resample(&curve, &Resampling::count(5)).unwrap();
    assert_eq!(even.name(), "line");
    assert!((0..5).all(|i| even.points()[i].distance(DVec3::X * i as f64) < 1e-14));
    let expected = [0.0, 1.0, 0.8, 0.6, 0.4];
    assert!(even.pressure().unwrap().iter().zip(expected).all(|(p, e)| (p - e).abs() < 1e-14));
    let smooth = resample(&curve, &Resampling::count(5).smooth()).unwrap();
    assert!((0..5).all(|i| smooth.points()[i].distance(DVec3::X * i as f64) < 1e-9), "{smooth:?}");
    assert!(smooth.pressure().unwrap().iter().zip(expected).all(|(p, e)| (p - e).abs() < 1e-9));
}

#[test]
fn ends_and_first_point_stay_exactly() {
    for (curve, smooth) in [(circle(9, false), false), (circle(9, false), true), (circle(9, true), true)] {
        for count in [4, 7, 200] {
            let resampling = Resampling { smooth, ..Resampling::count(count) };
            let even = resample(&curve, &resampling).unwrap();
            assert_eq!(even.points().len(), count);
            assert_eq!(even.start(), curve.start());
            assert!(curve.is_closed() || even.end() == curve.end());
        }
    }
}

#[test]
fn smooth_circle_of_eight_points_is_round_and_even() {
    let even = resample(&circle(8, true), &Resampling::count(64).smooth()).unwrap();
    // A C2 spline through 8 points of the unit circle is off it by 0.0013.
    assert!(even.points().iter().all(|p| (p.length() - 1.0).abs() < 2e-3));
    assert!(spread(&spacings(&even)) < 1e-4, "{}", spread(&spacings(&even)));
    let straight = resample(&circle(8, true), &Resampling::count(64)).unwrap();
    let inside = straight.points().iter().map(|p| 1.0 - p.length()).fold(0.0, f64::max);
    assert!((inside - (1.0 - (TAU / 16.0).cos())).abs() < 1e-12, "the straight one stays on the segments: {inside}");
}

#[test]
fn smooth_stroke_passes_through_its_points() {
    let points: Vec<DVec3> =
        (0..8).map(f64::from).map(|i| DVec3::new(0.1 * i, 0.2 * (0.9 * i).sin(), 0.1 * (0.5 * i).cos())).collect();
    let stroke = Curve::new("stroke", points.clone(), false).unwrap();
    let fine = resample(&stroke, &Resampling::count(4001).smooth()).unwrap();
    assert!(points.iter().all(|p| closest(&fine, *p).distance < 1e-6));
    assert!(spread(&spacings(&fine)) < 1e-5);
    // The largest turn between neighbouring segments shrinks with the spacing only where the tangent is continuous.
    let turn = fine.points().windows(3).map(|p| (p[1] - p[0]).angle_between(p[2] - p[1])).fold(0.0, f64::max);
    assert!(turn < 0.02, "{turn}");
}

#[test]
fn kept_corners_stay_exactly_wherever_the_curve_starts() {
    for smooth in [false, true] {
        for start in 0..8 {
            let curve = rectangle(start);
            let resampling = Resampling { smooth, ..Resampling::count(26).keeping_corners(FRAC_PI_4) };
            let even = resample(&curve, &resampling).unwrap();
            assert_eq!(even.points().len(), 26);
            assert_eq!(even.start(), curve.start());
            for corner in rectangle(0).points().iter().step_by(2) {
                assert!(even.points().contains(corner), "start {start}: {corner} is gone");
            }
            // Two of the four sides (or of the five stretches) may have one interval more than the others.
            assert!(spread(&spacings(&even)) < 0.34, "{:?}", spacings(&even));
            // Straight sides stay straight: the spline ends at the corners.
            assert!(even.points().iter().all(|p| closest(&curve, *p).distance < 1e-9));
            assert!((ArcLength::of(&even).length() - 8.0).abs() < 1e-9);
        }
    }
}

#[test]
fn one_corner_makes_a_teardrop() {
    let mut points = circle(12, true).points().to_vec();
    points[0] = DVec3::X * 3.0;
    let drop = Curve::new("drop", points.clone(), true).unwrap();
    for start in [0, 5] {
        points.rotate_left(start);
        let drop_from = Curve::new("drop", points.clone(), true).unwrap();
        let even = resample(&drop_from, &Resampling::count(40).smooth().keeping_corners(1.0)).unwrap();
        assert_eq!(even.points().len(), 40);
        assert_eq!(even.start(), drop_from.start());
        assert!(even.points().contains(&drop.start()));
    }
}

#[test]
fn spacing_gives_the_nearest_number_of_intervals() {
    let line = Curve::new("line", vec![DVec3::ZERO, DVec3::X], false).unwrap();
    let count = |spacing: f64| resample(&line, &Resampling::spacing(spacing)).unwrap().points().len();
    assert_eq!((count(0.1), count(0.3), count(0.7), count(40.0)), (11, 4, 2, 2));
    assert_eq!(resample(&circle(50, true), &Resampling::spacing(100.0)).unwrap().points().len(), 3);
    let even = resample(&rectangle(0), &Resampling::spacing(0.3).keeping_corners(1.0)).unwrap();
    assert_eq!(even.points().len(), 28);
    assert!(spacings(&even).iter().all(|s| (s - 2.0 / 7.0).abs() < 1e-12));
}

#[test]
fn resampling_twice_changes_nothing_on_a_straight_side() {
    let once = resample(&rectangle(0), &Resampling::count(32).keeping_corners(1.0)).unwrap();
    let twice = resample(&once, &Resampling::count(32).keeping_corners(1.0)).unwrap();
    assert!(once.points().iter().zip(twice.points()).all(|(a, b)| a.distance(*b) < 1e-12));
}

#[test]
fn all_but_repeated_points_do_not_disturb_the_spline() {
    let mut points = circle(8, false).points().to_vec();
    points.insert(3, points[2] + DVec3::splat(1e-15));
    points.push(points[8] + DVec3::splat(1e-16));
    let doubled = Curve::new("c", points, false).unwrap();
    let plain = resample(&circle(8, false), &Resampling::count(30).smooth()).unwrap();
    let even = resample(&doubled, &Resampling::count(30).smooth()).unwrap();
    assert!(even.points().iter().zip(plain.points()).all(|(a, b)| a.distance(*b) < 1e-9));
    assert_eq!(even.end(), doubled.end());
}

#[test]
fn amounts_and_angles_out_of_range_are_refused() {
    let (open, closed) = (circle(8, false), circle(8, true));
    let refused = |curve: &Curve, resampling: Resampling| resample(curve, &resampling).unwrap_err();
    let curve = || "circle".to_owned();
    let error = |count, needed| ResampleError::CountTooSmall { curve: curve(), count, needed };
    assert_eq!(refused(&open, Resampling::count(1)), error(1, 2));
    assert_eq!(refused(&closed, Resampling::count(2)), error(2, 3));
    let error = ResampleError::CountTooLarge { curve: curve(), count: 65_537 };
    assert_eq!(refused(&open, Resampling::count(65_537)), error);
    assert!(resample(&open, &Resampling::count(65_536)).is_ok());
    let error = ResampleError::TooManyCorners { curve: curve(), corners: 8, count: 7 };
    assert_eq!(refused(&open, Resampling::count(7).keeping_corners(0.1)), error);
    assert_eq!(refused(&closed, Resampling::count(7).keeping_corners(0.1)), error);
    for spacing in [0.0, -1.0, f64::INFINITY] {
        let error = ResampleError::SpacingNotPositive { curve: curve(), spacing };
        assert_eq!(refused(&open, Resampling::spacing(spacing)), error);
    }
    assert!(matches!(refused(&open, Resampling::spacing(f64::NAN)), ResampleError::SpacingNotPositive { .. }));
    assert!(matches!(refused(&open, Resampling::spacing(1e-5)), ResampleError::SpacingTooSmall { .. }));
    assert!(matches!(refused(&open, Resampling::spacing(1e-320)), ResampleError::SpacingTooSmall { .. }));
    for angle in [-0.1, f64::NAN] {
        let found = refused(&open, Resampling::count(9).keeping_corners(angle));
        assert!(matches!(found, ResampleError::CornerAngle { .. }));
    }
}

#[test]
fn curves_that_cannot_be_measured_are_refused() {
    for size in [1e200, 1e-200] {
        for closed in [false, true] {
            let huge = circle(5, closed).map(|p| (p + DVec3::X * 2.0) * size).unwrap();
            for resampling in [Resampling::count(9), Resampling::count(9).smooth().keeping_corners(0.5)] {
                assert!(matches!(resample(&huge, &resampling), Err(ResampleError::Unmeasurable { .. })));
            }
        }
    }
}

#[test]
fn curve_that_runs_back_on_itself_may_lose_points() {
    let points = [0.0, 2.0, 3.0, 2.0].map(|x| DVec3::X * x).into();
    let there_and_back = Curve::new("slit", points, true).unwrap();
    let error = ResampleError::Coincident { curve: "slit".to_owned() };
    assert_eq!(resample(&there_and_back, &Resampling::count(3)), Err(error));
    assert!(resample(&there_and_back, &Resampling::count(4)).is_ok());
}
