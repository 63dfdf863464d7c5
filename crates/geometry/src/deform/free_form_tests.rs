//! Tests of the deformation to curves drawn on the sections.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};

use super::free_form::*;
use crate::beam::Stiffness;
use crate::curve::{CubicSpline, Curve};
use crate::sections::Sections;

/// A tube about +Y, 1 m high, of radius 0.2; rails at the four sides.
fn tube(rows: usize, nodes: usize) -> Sections {
    let ring = |k: usize| {
        let y = k as f64 / (rows - 1) as f64;
        (0..nodes).map(|j| on(j as f64 / nodes as f64, y, 0.2)).collect()
    };
    let rails = (0..4).map(|k| k * nodes / 4).collect();
    Sections::new((0..rows).map(ring).collect(), true, rails).unwrap()
}

/// A point at a share of the way around, a height and a radius.
fn on(u: f64, y: f64, radius: f64) -> DVec3 {
    DQuat::from_rotation_y(-TAU * u) * DVec3::X * radius + DVec3::Y * y
}

/// A curve from a function of 0 to 1.
fn curve(name: &str, at: impl Fn(f64) -> DVec3) -> Curve {
    Curve::new(name, (0..=200).map(|i| at(f64::from(i) / 200.0)).collect(), false).unwrap()
}

/// Up between the first two rails, out by up to 3 cm, from 0.2 m to 0.8 m.
fn bulge() -> Curve {
    curve("bulge", |t| on(0.137, 0.2 + 0.6 * t, 0.2 + 0.03 * (TAU * t / 2.0).sin()))
}

/// Around a quarter of the tube as it goes up, across the rail at 0.25.
fn oblique() -> Curve {
    curve("oblique", |t| on(0.11 + 0.28 * t, 0.1 + 0.8 * t, 0.2 + 0.03 * (TAU * t / 2.0).sin()))
}

fn go(sections: &Sections, curves: &[Curve], options: &FreeFormOptions) -> FreeFormDeformed {
    deform_to_curves(sections, curves, options, &|_| true).unwrap()
}

fn apart(one: &Sections, other: &Sections) -> f64 {
    one.points().iter().zip(other.points()).map(|(p, q)| p.distance(*q)).fold(0.0, f64::max)
}

/// The smooth curve through a section, by the number of its points.
fn smooth(section: &[DVec3]) -> CubicSpline {
    CubicSpline::periodic((0..=section.len()).map(|j| j as f64).collect(), section.to_vec()).unwrap()
}

/// Distance of a point from it: the best of samples, then ever closer ones around it.
fn distance(section: &[DVec3], point: DVec3) -> f64 {
    let (smooth, count) = (smooth(section), section.len() as f64);
    let (mut at, mut reach) = (0.0, count / 2.0);
    while reach > 1e-16 {
        let steps = (-32..=32).map(|i| (at + reach * f64::from(i) / 32.0).rem_euclid(count));
        at = steps
            .min_by(|a, b| smooth.position(*a).distance(point).total_cmp(&smooth.position(*b).distance(point)))
            .unwrap();
        reach /= 8.0;
    }
    smooth.position(at).distance(point)
}

#[test]
fn sections_pass_through_curves_between_their_points_and_rails_stay() {
    let start = tube(41, 64);
    let second = curve("hollow", |t| on(0.631, 0.5 + 0.4 * t, 0.2 - 0.02 * (TAU * t / 2.0).sin()));
    let drawn = [bulge(), second];
    let made = go(&start, &drawn, &FreeFormOptions { fade: 0.0, ..FreeFormOptions::default() });
    assert!(made.warnings.is_empty(), "{:?}", made.warnings);
    let found: Vec<_> = made.curves.iter().map(|curve| (curve.first, curve.last)).collect();
    assert_eq!(found, [(8, 32), (20, 36)]);
    assert!((made.curves[0].largest_move - 0.03).abs() < 1e-3, "{:?}", made.curves);
    for (k, section) in made.sections.iter().enumerate() {
        let y = start.centre(k).y;
        for (drawn, (first, last)) in drawn.iter().zip(&found) {
            if (first..=last).contains(&&k) {
                let passage = drawn.points().windows(2).find(|w| w[0].y <= y + 1e-12 && y <= w[1].y + 1e-12);
                let passage = passage.map(|w| w[0].lerp(w[1], (y - w[0].y) / (w[1].y - w[0].y))).unwrap();
                let off = distance(section, passage);
                assert!(off < 1e-12, "section {k}: {off}");
            }
        }
        for rail in start.rails() {
            assert!(section[*rail].distance(start.section(k)[*rail]) < 1e-15, "section {k}, rail {rail}");
        }
        if !(8..=36).contains(&k) {
            assert_eq!(section, start.section(k), "section {k}");
        }
    }
}

#[test]
fn a_curve_on_the_surface_changes_nothing() {
    let start = tube(41, 64);
    let ring = smooth(start.section(0));
    let on_side = curve("drawn", |t| ring.position(9.4) + DVec3::Y * (0.1 + 0.8 * t));
    let made = go(&start, &[on_side], &FreeFormOptions::default());
    assert!(apart(&made.sections, &start) < 1e-14 && made.largest_move < 1e-14);
}

#[test]
fn a_curve_crosses_rails_without_a_crease() {
    // The largest second difference from section to section falls as a smooth surface's does.
    let bend = |rows: usize| {
        let start = tube(rows, 64);
        let made = go(&start, &[oblique()], &FreeFormOptions { fade: 0.2, ..FreeFormOptions::default() });
        let moved: Vec<DVec3> = made.sections.points().iter().zip(start.points()).map(|(p, q)| *p - *q).collect();
        let second = |k: usize, j: usize| (moved[k - 64 + j] - 2.0 * moved[k + j] + moved[k + 64 + j]).length();
        let inner = (1..rows - 1).flat_map(|k| (0..64).map(move |j| second(64 * k, j)));
        inner.fold(0.0, f64::max)
    };
    let (coarse, fine) = (bend(41), bend(161));
    assert!(fine < 0.3 * coarse && coarse < 5e-3, "{coarse} {fine}");
}

#[test]
fn it_fades_beyond_the_ends_of_a_curve() {
    let start = tube(81, 64);
    let shelf = curve("shelf", |t| on(0.125, 0.4 + 0.2 * t, 0.22));
    let made = go(&start, &[shelf], &FreeFormOptions { fade: 0.2, ..FreeFormOptions::default() });
    let out = |k: usize| made.sections.section(k)[8].with_y(0.0).length() - 0.2;
    assert!((out(40) - 0.02).abs() < 1e-12);
    // Less and less, half at half the way, and nothing from 0.2 m on.
    assert!((17..32).all(|k| out(k) < out(k + 1)), "{:?}", (10..40).map(out).collect::<Vec<_>>());
    assert!((out(24) - 0.01).abs() < 1e-12, "{}", out(24));
    assert!((0..=16).chain(64..81).all(|k| made.sections.section(k) == start.section(k)));
}

#[test]
fn direction_order_place_and_size_do_not_matter() {
    let start = tube(41, 64);
    let other = curve("other", |t| on(0.8, 0.2 + 0.6 * t, 0.19 + 0.01 * t));
    let options = FreeFormOptions { fade: 0.1, ..FreeFormOptions::default() };
    let made = go(&start, &[oblique(), other.clone()], &options).sections;
    let turned = go(&start, &[other.clone().reversed(), oblique().reversed()], &options).sections;
    assert!(apart(&made, &turned) < 1e-14);
    let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.4, -1.1, 2.0);
    let map = |p: DVec3| turn * p * 3.0 + DVec3::new(0.3, -0.2, 0.7);
    let rows = start.iter().map(|row| row.iter().map(|p| map(*p)).collect()).collect();
    let there = Sections::new(rows, true, start.rails().to_vec()).unwrap();
    let curves = [oblique(), other].map(|c| c.map(map).unwrap());
    let found = go(&there, &curves, &FreeFormOptions { fade: 0.3, ..options }).sections;
    let off = found.points().iter().zip(made.points()).map(|(p, q)| p.distance(map(*q))).fold(0.0, f64::max);
    assert!(off < 1e-8, "{off}");
}

#[test]
fn symmetry_in_gives_symmetry_out() {
    let start = tube(41, 64);
    let mirror = |p: DVec3| p * DVec3::new(-1.0, 1.0, 1.0);
    let drawn = oblique();
    let made = go(&start, &[drawn.clone(), drawn.map(mirror).unwrap()], &FreeFormOptions::default()).sections;
    for section in made.iter() {
        for j in 0..64 {
            assert!(section[j].distance(mirror(section[(96 - j) % 64])) < 1e-13);
        }
    }
}

#[test]
fn without_held_rails_one_curve_moves_whole_sections_and_stiffness_counts_with_two() {
    let start = tube(11, 32);
    let shifted = curve("shifted", |t| on(0.3, t, 0.2) + DVec3::X * 0.05);
    let loose = FreeFormOptions { hold_rails: false, ..FreeFormOptions::default() };
    let made = go(&start, &[shifted], &loose).sections;
    for (section, from) in made.iter().zip(start.iter()) {
        let moved: Vec<DVec3> = section.iter().zip(from).map(|(p, q)| *p - *q).collect();
        assert!(moved.iter().all(|m| m.distance(moved[0]) < 1e-13) && moved[0].length() > 0.005);
    }
    let with = |ratio: f64| {
        let stiffness = Stiffness::new(1.0, ratio).unwrap();
        go(&start, &[bulge()], &FreeFormOptions { stiffness, ..FreeFormOptions::default() }).sections
    };
    assert!(apart(&with(0.0), &with(1e5)) > 1e-3);
}

#[test]
fn curves_that_meet_are_told_and_poles_stay() {
    let start = tube(11, 32);
    let made = go(&start, &[bulge(), bulge()], &FreeFormOptions { fade: 0.0, ..FreeFormOptions::default() });
    assert!(made.warnings.len() == 1 && made.warnings[0].contains("On 7 section(s)"), "{:?}", made.warnings);
    let mut rows: Vec<Vec<DVec3>> = start.iter().map(<[DVec3]>::to_vec).collect();
    rows[10] = vec![DVec3::Y; 32];
    let dome = Sections::new(rows, true, vec![]).unwrap();
    let along = curve("along", |t| on(0.1, 0.3 + 0.7 * t, 0.22));
    assert!(go(&dome, &[along], &FreeFormOptions::default()).sections.is_pole(10));
}

#[test]
fn errors_say_what_to_do() {
    let start = tube(11, 32);
    let options = FreeFormOptions::default();
    let error = |sections: &Sections, curves: &[Curve], options: &FreeFormOptions| {
        deform_to_curves(sections, curves, options, &|_| true).unwrap_err()
    };
    assert_eq!(error(&start, &[], &options), CurvesError::NoCurves);
    let far = bulge().map(|p| p + DVec3::X * 2.0).unwrap();
    let level = curve("level", |t| on(t, 0.55, 0.21));
    for (drawn, index) in [(vec![far.clone()], 0), (vec![bulge(), level], 1), (vec![bulge(), bulge(), far], 2)] {
        let found = error(&start, &drawn, &options);
        assert!(matches!(&found, CurvesError::Beside { index: at, .. } if *at == index), "{found}");
        assert!(found.to_string().contains("draw it on the surface or close to it"), "{found}");
    }
    for fade in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(error(&start, &[bulge()], &FreeFormOptions { fade, ..options }), CurvesError::Fade { .. }));
    }
    let huge = bulge().map(|p| p * 1e101).unwrap();
    assert!(matches!(error(&start, &[huge], &options), CurvesError::TooLarge { .. }));
    let sheet = Sections::new(start.iter().map(<[DVec3]>::to_vec).collect(), false, vec![]).unwrap();
    assert_eq!(error(&sheet, &[bulge()], &options), CurvesError::SectionsAreOpen);
    for allowed in [0.0, 0.3, 0.9] {
        let stopped = deform_to_curves(&start, &[bulge()], &options, &|done| done < allowed);
        assert_eq!(stopped, Err(CurvesError::Cancelled));
    }
}
