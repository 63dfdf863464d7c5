//! What turning frames promise, on whole surfaces.

use std::f64::consts::{PI, TAU};

use glam::{DQuat, DVec3};

use super::{Frame, GenerateOptions, Generated, Weights, between_closed};
use crate::curve::{ArcLength, Curve, closest};

/// Half width of a vase at the share `t` of its height, in shares of half its foot: belly 2 near 0.33, neck 0.7.
fn profile(t: f64) -> f64 {
    1.0 + 1.6 * (PI * t).sin().powi(2) * (1.0 - t) - 0.9 * (PI * t).sin().powi(2) * t
}

/// A vase around +Y: foot, lip and rails at `angles`, `half` wide; `bend` moves and `bulge` widens rail by rail.
fn vase(
    angles: &[f64],
    half: (f64, f64),
    bend: impl Fn(f64) -> DVec3,
    bulge: impl Fn(usize, f64) -> f64,
) -> (Vec<Curve>, Curve, Curve) {
    let at = |a: f64, t: f64, swell: f64| {
        let r = profile(t) * swell;
        DVec3::new(r * half.0 * a.cos(), 0.4 * t, -r * half.1 * a.sin()) + bend(t)
    };
    let ring = |name: &str, t: f64| {
        Curve::new(name, (0..2400).map(|k| at(TAU * f64::from(k) / 2400.0, t, 1.0)).collect(), true).unwrap()
    };
    let rail = |(k, a): (usize, &f64)| {
        let points = (0..=600).map(|i| f64::from(i) / 600.0).map(|t| at(*a, t, bulge(k, t)));
        Curve::new(format!("rail {k}"), points.collect(), false).unwrap()
    };
    (angles.iter().enumerate().map(rail).collect(), ring("foot", 0.0), ring("lip", 1.0))
}

fn straight(_: f64) -> DVec3 {
    DVec3::ZERO
}

fn same(_: usize, _: f64) -> f64 {
    1.0
}

fn make((rails, start, end): &(Vec<Curve>, Curve, Curve), frame: Frame, weights: Weights) -> Generated {
    let options = GenerateOptions { sections: 41, nodes: 72, weights, frame, ..GenerateOptions::default() };
    between_closed(rails, start, end, &options, &|_| true).unwrap()
}

/// Largest share by which a point's distance from the axis through `centre` differs from that of the section's first
/// point (a rail's), over all sections.
fn out_of_round(made: &Generated, centre: impl Fn(f64) -> DVec3) -> f64 {
    let off = |section: &[DVec3]| {
        let radius = |p: &DVec3| ((*p - centre(p.y / 0.4)) * DVec3::new(1.0, 0.0, 1.0)).length();
        let wanted = radius(&section[0]);
        section.iter().map(|p| (radius(p) / wanted - 1.0).abs()).fold(0.0, f64::max)
    };
    made.sections.iter().map(off).fold(0.0, f64::max)
}

fn evenly(count: usize) -> Vec<f64> {
    (0..count).map(|k| TAU * k as f64 / count as f64).collect()
}

#[test]
fn surfaces_of_revolution_are_round_from_any_rails() {
    let uneven = [0.1, 0.9, 2.0, 4.1, 5.0].to_vec();
    for angles in [evenly(2), evenly(3), evenly(4), evenly(6), uneven, vec![0.3, 1.0]] {
        let drawn = vase(&angles, (0.05, 0.05), straight, same);
        for weights in [Weights::Smooth, Weights::Linear] {
            let made = make(&drawn, Frame::Turning, weights);
            assert!(made.notes.is_empty(), "{:?}", made.notes);
            let off = out_of_round(&made, straight);
            assert!(off < 1e-5, "{} rails: {off}", angles.len());
        }
    }
}

#[test]
fn fixed_frames_shrink_a_swelling_as_printed() {
    let drawn = vase(&evenly(4), (0.05, 0.05), straight, same);
    for weights in [Weights::Smooth, Weights::Linear] {
        let made = make(&drawn, Frame::Fixed, weights);
        for section in made.sections.iter() {
            // Half-way between two rails a quarter of a turn apart.
            let (at_rail, between) = (section[0].x.hypot(section[0].z), section[9].x.hypot(section[9].z));
            assert!((between - (0.05 + (at_rail - 0.05) * 0.5_f64.sqrt())).abs() < 1e-7, "{at_rail} {between}");
        }
        assert!(out_of_round(&made, straight) > 0.1);
    }
}

#[test]
fn a_tube_bent_sideways_stays_round() {
    let bend = |t: f64| DVec3::new(0.08, 0.0, -0.05) * (PI * t).sin().powi(2);
    for angles in [evenly(2), evenly(3), evenly(4), evenly(5)] {
        // Rails of one parametrisation: they differ only by their places around.
        let (_, start, end) = vase(&angles, (0.05, 0.05), bend, same);
        let rails: Vec<Curve> = angles
            .iter()
            .enumerate()
            .map(|(k, a)| {
                let side = DVec3::new(0.05 * a.cos(), 0.0, -0.05 * a.sin());
                let points = (0..=600).map(|i| f64::from(i) / 600.0).map(|t| side + bend(t) + DVec3::Y * 0.4 * t);
                Curve::new(format!("rail {k}"), points.collect(), false).unwrap()
            })
            .collect();
        let made = make(&(rails, start, end), Frame::Turning, Weights::Smooth);
        let worst = made
            .sections
            .iter()
            .flat_map(|section| section.iter())
            .map(|p| (p.distance(bend(p.y / 0.4) + DVec3::Y * p.y) / 0.05 - 1.0).abs())
            .fold(0.0, f64::max);
        assert!(worst < 1e-4, "{} rails: {worst}", angles.len());
    }
}

#[test]
fn an_oval_vase_is_symmetric_and_full() {
    let made = make(&vase(&evenly(4), (0.08, 0.05), straight, same), Frame::Turning, Weights::Smooth);
    for (row, section) in made.sections.iter().enumerate() {
        // Each point and its images beyond both planes of symmetry, and an ellipse to within a few percent.
        for (j, p) in section.iter().enumerate() {
            let mirrored = section[(72 - j) % 72] * DVec3::new(1.0, 1.0, -1.0);
            let across = section[(108 - j) % 72] * DVec3::new(-1.0, 1.0, 1.0);
            assert!(p.distance(mirrored) < 1e-7 && p.distance(across) < 1e-7, "section {row}, point {j}");
            let swell = (p.x / section[0].x).hypot(p.z / section[18].z);
            assert!((swell - 1.0).abs() < 0.05, "section {row}, point {j}: {swell}");
        }
    }
}

#[test]
fn rails_and_closed_curves_are_reproduced_where_rails_differ() {
    let bulge = |k: usize, t: f64| if k == 1 { 1.0 + 0.5 * (TAU * t).sin().powi(2) } else { 1.0 };
    // At corners of the closed polygons, so that the rails' ends lie on them.
    let angles = [0, 460, 1150, 1680].map(|k| TAU * f64::from(k) / 2400.0);
    let drawn = vase(&angles, (0.06, 0.05), straight, bulge);
    for weights in [Weights::Smooth, Weights::Linear] {
        let made = make(&drawn, Frame::Turning, weights);
        for (rail, column) in drawn.0.iter().zip(made.sections.rails()) {
            let arc = ArcLength::of(rail);
            for (row, section) in made.sections.iter().enumerate() {
                assert!(section[*column].distance(arc.point_at_fraction(row as f64 / 40.0)) < 1e-14);
            }
        }
        assert!(made.sections.section(0).iter().all(|p| closest(&drawn.1, *p).distance < 1e-14));
        assert!(made.sections.section(40).iter().all(|p| closest(&drawn.2, *p).distance < 1e-14));
    }
}

#[test]
fn a_bulge_of_one_rail_is_smooth_and_stays_on_its_side() {
    let bulge = |k: usize, t: f64| if k == 1 { 1.0 + 0.5 * (PI * t).sin().powi(2) } else { 1.0 };
    let plain = make(&vase(&evenly(6), (0.05, 0.05), straight, same), Frame::Turning, Weights::Smooth);
    let made = make(&vase(&evenly(6), (0.05, 0.05), straight, bulge), Frame::Turning, Weights::Smooth);
    let columns = made.sections.rails().to_vec();
    for (row, section) in made.sections.iter().enumerate().skip(1).take(39) {
        let n = section.len() as isize;
        let at = |j: usize, step: isize| section[(j as isize + step).rem_euclid(n) as usize];
        for column in &columns {
            let side = |d: isize| {
                at(*column, 0) * -11.0 + at(*column, d) * 18.0 - at(*column, 2 * d) * 9.0 + at(*column, 3 * d) * 2.0
            };
            let crease = side(1).angle_between(-side(-1)).to_degrees();
            assert!(crease < 1.0, "section {row}, column {column}: {crease} degrees");
        }
        // The rail beyond is as drawn; between the far rails little of the bulge arrives.
        let moved = |j: usize| section[j].distance(plain.sections.section(row)[j]);
        let far = (columns[3]..=columns[5]).map(moved).fold(0.0, f64::max);
        assert!(far <= 0.05 * moved(columns[1]).max(1e-4), "section {row}: {far}");
    }
}

#[test]
fn everything_turned_gives_the_result_turned() {
    let bulge = |k: usize, t: f64| if k == 2 { 1.0 + 0.3 * (PI * t).sin().powi(2) } else { 1.0 };
    let drawn = vase(&[0.2, 1.5, 3.3, 4.9], (0.06, 0.05), |t| DVec3::X * 0.05 * t * t, bulge);
    let (turn, shift) = (DQuat::from_euler(glam::EulerRot::XYZ, 0.7, -1.9, 2.6), DVec3::new(1.0, -3.0, 2.0));
    let place = |curve: &Curve| curve.map(|p| turn * p + shift).unwrap();
    let turned = (drawn.0.iter().map(place).collect(), place(&drawn.1), place(&drawn.2));
    let (one, other) = (make(&drawn, Frame::Turning, Weights::Smooth), make(&turned, Frame::Turning, Weights::Smooth));
    let apart = one.sections.points().iter().zip(other.sections.points()).map(|(p, q)| q.distance(turn * *p + shift));
    assert!(apart.fold(0.0, f64::max) < 1e-11);
}

#[test]
fn closed_curves_may_be_tilted_tiny_or_flat() {
    let (rails, foot, lip) = vase(&evenly(4), (0.05, 0.05), straight, same);
    let belly = |start: &Curve, end: &Curve, snap: f64| {
        let options = GenerateOptions { sections: 41, nodes: 72, snap, ..GenerateOptions::default() };
        let made = between_closed(&rails, start, end, &options, &|_| true).unwrap();
        assert!(made.notes.is_empty(), "{:?}", made.notes);
        let section = made.sections.section(14);
        let radii = section.iter().map(|p| p.x.hypot(p.z));
        radii.fold((f64::INFINITY, 0.0_f64), |(low, high), r| (low.min(r), high.max(r)))
    };
    let (low, high) = belly(&foot, &lip, 0.02);
    assert!(high / low - 1.0 < 1e-5);
    let tilted = lip.map(|p| DVec3::new(p.x, p.y + 0.3 * p.x, p.z)).unwrap();
    let (low, high) = belly(&foot, &tilted, 0.02);
    assert!(high / low - 1.0 < 0.05, "{low} {high}");
    let tiny = lip.map(|p| DVec3::new(p.x * 1e-3, p.y, p.z * 1e-3)).unwrap();
    let (low, high) = belly(&foot, &tiny, 0.06);
    assert!(high / low - 1.0 < 1e-3, "{low} {high}");
    let slit = lip.map(|p| DVec3::new(p.x, p.y, p.z * 1e-3)).unwrap();
    let (low, high) = belly(&foot, &slit, 0.06);
    assert!(high / low - 1.0 < 0.3, "{low} {high}");
}

#[test]
fn without_a_way_to_turn_the_frame_is_fixed_with_a_note() {
    // A lip with a deep fold between two rails; the feet stay where they are.
    let (rails, foot, lip) = vase(&evenly(4), (0.05, 0.05), straight, same);
    let hook = |p: DVec3| {
        let behind = (-p.z).atan2(p.x) - 0.8;
        DQuat::from_rotation_y(-2.0 * behind * (1.0 - (behind / 0.3).powi(2)).max(0.0)) * p
    };
    let folded = lip.map(hook).unwrap();
    let drawn = (rails, foot, folded);
    let (turning, fixed) = (make(&drawn, Frame::Turning, Weights::Smooth), make(&drawn, Frame::Fixed, Weights::Smooth));
    assert_eq!(turning.sections, fixed.sections);
    assert!(fixed.notes.is_empty());
    assert!(turning.notes[0].contains("\"lip\" turns back"), "{:?}", turning.notes);
}

#[test]
fn flat_openings_turn_about_their_normal_and_opposite_ones_do_not() {
    let ring = |name: &str, r: f64, y: f64, turn: DQuat, shift: DVec3| {
        let at = |k: i32| f64::from(k) * TAU / 400.0;
        let points = (0..400).map(|k| turn * DVec3::new(r * at(k).cos(), y, -r * at(k).sin()) + shift);
        Curve::new(name, points.collect(), true).unwrap()
    };
    // A rim that bulges out of the plane of both rings is one of revolution again.
    let (outer, inner) = (
        ring("outer", 0.03, 0.0, DQuat::IDENTITY, DVec3::ZERO),
        ring("inner", 0.01, 0.0, DQuat::IDENTITY, DVec3::ZERO),
    );
    let rim = |k: usize| {
        let points = (0..=100).map(|i| f64::from(i) / 100.0).map(|t| {
            (outer.points()[k] * (1.0 - t) + inner.points()[k] * t) * (1.0 + 0.5 * (PI * t).sin())
                + DVec3::Y * 0.01 * (PI * t).sin()
        });
        Curve::new("rim", points.collect(), false).unwrap()
    };
    let rails: Vec<Curve> = [0, 100, 200, 300].map(rim).into();
    let made = make(&(rails, outer, inner), Frame::Turning, Weights::Smooth);
    assert!(made.notes.is_empty() && out_of_round(&made, straight) < 1e-3, "{}", out_of_round(&made, straight));

    // A tube bent into a U: its rings face opposite ways.
    let back = DQuat::from_rotation_z(PI);
    let (start, end) =
        (ring("start", 0.02, 0.0, DQuat::IDENTITY, DVec3::ZERO), ring("end", 0.02, 0.0, back, DVec3::X * -0.2));
    let bow = |k: usize| {
        let offset = start.points()[k];
        let points = (0..=100).map(|i| PI * f64::from(i) / 100.0).map(|a| {
            let turn = DQuat::from_rotation_z(a);
            turn * (offset + DVec3::X * 0.1) - DVec3::X * 0.1
        });
        Curve::new("bow", points.collect(), false).unwrap()
    };
    let rails: Vec<Curve> = [0, 100, 200, 300].map(bow).into();
    let made = make(&(rails, start, end), Frame::Turning, Weights::Smooth);
    assert!(made.notes[0].contains("face opposite ways"), "{:?}", made.notes);
}
