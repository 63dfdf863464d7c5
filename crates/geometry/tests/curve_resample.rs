//! Resampling any stroke: the count asked for, ends and corners that stay, even spacing along the way.

#![allow(clippy::unwrap_used, reason = "a failing unwrap is a failing test")]

use glam::DVec3;
use maquette_geometry::curve::{ArcLength, Curve, Resampling, closest, resample};
use proptest::prelude::*;

fn stroke() -> impl Strategy<Value = Curve> {
    let points = prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 3..40);
    (points, any::<bool>(), any::<bool>()).prop_filter_map("a curve", |(points, closed, pressed)| {
        let pressure = pressed.then(|| points.iter().map(|p| 0.5 + 0.5 * p[0]).collect());
        Curve::with_pressure("stroke", points.into_iter().map(DVec3::from).collect(), closed, pressure).ok()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn count_ends_corners_and_pressure_hold(curve in stroke(), count in 40_usize..300, smooth: bool, angle in 0.0..3.0_f64) {
        let resampling = Resampling { smooth, ..Resampling::count(count).keeping_corners(angle) };
        let even = resample(&curve, &resampling).unwrap();
        prop_assert_eq!(even.points().len(), count);
        prop_assert_eq!(even.start(), curve.start());
        prop_assert!(curve.is_closed() || even.end() == curve.end());
        prop_assert_eq!(even.pressure().is_some(), curve.pressure().is_some());
        prop_assert!(even.pressure().unwrap_or_default().iter().all(|p| (0.0..=1.0).contains(p)));
        let n = curve.points().len();
        for i in 0..n {
            let (before, at, after) = (curve.points()[(i + n - 1) % n], curve.points()[i], curve.points()[(i + 1) % n]);
            let inner = curve.is_closed() || (i > 0 && i + 1 < n);
            if inner && (at - before).angle_between(after - at) > angle + 1e-6 {
                prop_assert!(even.points().contains(&at), "corner {} is gone", i);
            }
        }
    }

    #[test]
    fn straight_resampling_without_corners_is_even_along_the_curve(curve in stroke(), count in 3_usize..300) {
        let even = resample(&curve, &Resampling::count(count)).unwrap();
        let arc = ArcLength::of(&curve);
        let intervals = count - usize::from(!curve.is_closed());
        for (i, point) in even.points().iter().enumerate() {
            let expected = arc.point_at(arc.length() * i as f64 / intervals as f64);
            prop_assert!(point.distance(expected) < 1e-9 * arc.length());
        }
    }

    #[test]
    fn smooth_curve_passes_through_every_point_and_is_even(curve in stroke()) {
        let fine = resample(&curve, &Resampling::count(20_001).smooth()).unwrap();
        let length = ArcLength::of(&fine).length();
        let spacing = length / 20_000.0;
        prop_assert!(curve.points().iter().all(|p| closest(&fine, *p).distance < spacing));
        // A chord is no longer than its arc, and shorter only where the curve bends within one spacing.
        let longest = ArcLength::of(&fine).cumulative().windows(2).map(|p| p[1] - p[0]).fold(0.0, f64::max);
        prop_assert!(longest < 1.01 * spacing, "{} {}", longest, spacing);
    }
}
