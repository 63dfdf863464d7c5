//! The sections of a human body as generalized ellipses and composite generalized elliptic segments.

#![allow(clippy::unwrap_used, clippy::panic, clippy::disallowed_methods, reason = "a failing unwrap is a failing test")]

use maquette_geometry::curve::Curve;
use maquette_geometry::file_format::curves_json;
use maquette_geometry::trigonometric::{
    Angles, Continuity, FitOptions, FittedStack, Joint, LocalAngles, Solution, Split, Tolerances, fit_sections,
};
use std::f64::consts::PI;

const PARTS: [&str; 7] = ["left_leg", "left_upper_arm", "left_forearm", "hip", "torso", "neck", "head"];

fn part(name: &str) -> Vec<Curve> {
    let path = format!("{}/tests/data/human/sections/{name}.json", env!("CARGO_MANIFEST_DIR"));
    curves_json::read(&std::fs::read(path).unwrap()).unwrap()
}

fn harmonics(stack: &FittedStack) -> Vec<Vec<usize>> {
    stack.sections.iter().map(|fitted| fitted.report.harmonics.clone()).collect()
}

#[test]
fn every_section_of_the_body_meets_the_tolerances_of_the_thesis() {
    let tolerances = Tolerances::default();
    let (mut limbs, mut constants, mut sections) = (Vec::new(), 0, 0);
    for name in PARTS {
        let stack = fit_sections(&part(name), &FitOptions::default()).unwrap();
        for (i, fitted) in stack.sections.iter().enumerate() {
            let report = &fitted.report;
            assert!(report.met && tolerances.met_by(report.errors), "{name} {i}: {report:?}");
            assert!(report.harmonics[0] < 15, "{name} {i}: {report:?}");
            assert!(report.warnings.is_empty() && !report.reversed, "{name} {i}: {report:?}");
        }
        if matches!(name, "left_leg" | "left_upper_arm" | "left_forearm") {
            limbs.extend(harmonics(&stack).concat());
        }
        constants += stack.constants();
        sections += stack.sections.len();
    }
    let mean = limbs.iter().sum::<usize>() as f64 / limbs.len() as f64;
    assert!(mean <= 4.0, "{limbs:?}");
    assert_eq!(sections, 65);
    // The thesis needs 7530 for its body.
    assert!(constants < 2000, "{constants}");
}

/// Where the torso's arms are cut off, polar angles nearly stand still and would need 18 harmonics.
#[test]
fn the_torso_goes_by_arc_length_and_limbs_by_polar_angles() {
    let kind = |name| fit_sections(&part(name), &FitOptions::default()).unwrap().angles;
    assert_eq!([kind("torso"), kind("left_leg"), kind("hip")], [Angles::ArcLength, Angles::Polar, Angles::Polar]);
}

fn within_4_mm(split: Split) -> FitOptions {
    FitOptions { largest_distance: Some(0.004), split, ..FitOptions::default() }
}

#[test]
fn hips_and_torso_in_segments_are_within_4_mm() {
    for name in ["hip", "torso"] {
        let split = Split::Automatic { most: 8, corner_angle: PI / 3.0 };
        let stack = fit_sections(&part(name), &within_4_mm(split)).unwrap();
        assert!(stack.met() && stack.largest_distance() <= 0.004, "{name}: {:?}", stack.largest_distance());
        assert!(harmonics(&stack).concat().iter().all(|j| *j <= 8));
        let joints: Vec<f64> = stack.joints.iter().map(|joint| joint.angle).collect();
        for fitted in &stack.sections {
            assert_eq!(fitted.section.joints(), joints, "joints are common");
        }
    }
}

#[test]
fn the_notch_of_the_hip_keeps_its_corner() {
    let split = Split::Corners { angle: PI / 3.0 };
    let stack = fit_sections(&part("hip"), &within_4_mm(split)).unwrap();
    assert_eq!(stack.joints.len(), 2);
    let notch = stack.joints.iter().find(|joint| joint.continuity == Continuity::C0).unwrap();
    let opposite = stack.joints.iter().find(|joint| joint.continuity == Continuity::C1).unwrap();
    assert!(((notch.angle - opposite.angle).abs() - PI).abs() < 1e-9);
    let turn = |i: usize, angle: f64| {
        let section = &stack.sections[i].section;
        section.tangent(angle - 1e-6).angle_between(section.tangent(angle + 1e-6)).to_degrees()
    };
    assert!(turn(1, notch.angle) > 80.0, "{}", turn(1, notch.angle));
    assert!(turn(5, notch.angle) < 0.1, "the waist has no corner: {}", turn(5, notch.angle));
    assert!((0..6).all(|i| turn(i, opposite.angle) < 0.1));
    let behind = stack.sections[1].section.point(notch.angle);
    assert!(behind.x.abs() < 0.002 && behind.z < -0.05, "{behind}");
    assert!(stack.met() && stack.largest_distance() <= 0.004);
}

#[test]
fn segments_of_a_stack_are_alike() {
    let joints = [0.4, 1.0, 3.5].map(|angle| Joint { angle, continuity: Continuity::C1 }).to_vec();
    let options = FitOptions {
        split: Split::At(joints),
        tolerances: Tolerances { mean: 0.001, maximum: 0.004 },
        common_harmonics: true,
        ..FitOptions::default()
    };
    let stack = fit_sections(&part("torso"), &options).unwrap();
    let kind = |i: usize| -> Vec<(bool, f64, usize)> {
        let segments = stack.sections[i].section.segments().iter();
        segments.map(|segment| (segment.local, segment.from, segment.series.harmonics())).collect()
    };
    assert!((1..12).all(|i| kind(i) == kind(0)));
    let local: Vec<bool> = kind(0).iter().map(|(local, ..)| *local).collect();
    assert_eq!(local, [true, true, false], "the short one and the one with many harmonics: {:?}", kind(0));
    let bound = |stack: &FittedStack| {
        let segments = stack.sections.iter().map(|fitted| &fitted.section.segments()[1]);
        segments.map(|segment| segment.series.derivative_bound(0)).fold(0.0, f64::max)
    };
    let never = fit_sections(&part("torso"), &FitOptions { local_angles: LocalAngles::Never, ..options }).unwrap();
    assert!(bound(&never) > 2.0 * bound(&stack), "{} {}", bound(&never), bound(&stack));
}

#[test]
fn one_segment_after_the_other_is_worse() {
    let joints = [0.0, PI].map(|angle| Joint { angle, continuity: Continuity::C1 }).to_vec();
    let off = |solution| {
        let harmonics = maquette_geometry::trigonometric::Harmonics::Fixed(3);
        let options = FitOptions { split: Split::At(joints.clone()), solution, harmonics, ..FitOptions::default() };
        fit_sections(&part("torso"), &options).unwrap().largest_distance()
    };
    assert!(off(Solution::Together) < off(Solution::InTurn));
}

#[test]
fn equal_runs_give_equal_bits() {
    let options = within_4_mm(Split::Automatic { most: 8, corner_angle: PI / 3.0 });
    assert_eq!(fit_sections(&part("hip"), &options).unwrap(), fit_sections(&part("hip"), &options).unwrap());
}
