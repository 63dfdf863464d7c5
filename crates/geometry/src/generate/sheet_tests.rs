//! Rails between open curves, and tubes past several closed ones.

use std::f64::consts::TAU;

use glam::DVec3;

use super::test_shapes::{apart, closed, crease, cuff, leaving, open, out_of_plane, place, placed};
use super::*;
use crate::curve::{ArcLength, Curve, closest};

fn options() -> GenerateOptions {
    GenerateOptions { sections: 33, nodes: 41, ..GenerateOptions::default() }
}

fn run(rails: &[Curve], profiles: &[Curve]) -> Generated {
    sheet(rails, profiles, [None, None], &options(), &|_| true).unwrap()
}

#[test]
fn a_cuff_passes_all_its_curves() {
    let (rails, arcs) = cuff(400);
    for profiles in [vec![arcs[0].clone(), arcs[2].clone()], arcs.clone()] {
        let made = run(&rails, &profiles);
        assert_eq!((made.sections.len(), made.sections.nodes(), made.sections.is_closed()), (33, 41, false));
        assert_eq!((made.sections.rails(), made.warnings.len(), made.notes.len()), (&[0, 20, 40][..], 0, 0));
        for (k, profile) in profiles.iter().enumerate() {
            let section = made.sections.section(32 * k / (profiles.len() - 1));
            assert!(section.iter().all(|p| closest(profile, *p).distance < 1e-12), "{}", profile.name());
        }
        for (rail, column) in rails.iter().zip(made.sections.rails()) {
            assert!(made.sections.iter().all(|section| closest(rail, section[*column]).distance < 1e-7));
            assert!(made.sections.section(32)[*column].distance(rail.end()) < 1e-12);
        }
    }
}

#[test]
fn fields_meet_without_a_crease_and_profiles_without_a_kink() {
    let (rails, arcs) = cuff(8000);
    let fine = GenerateOptions { sections: 17, nodes: 401, ..options() };
    let made = sheet(&rails, &arcs, [None, None], &fine, &|_| true).unwrap().sections;
    assert!(crease(&made, made.rails()[1]) < 0.01, "{}", crease(&made, made.rails()[1]));
    let long = GenerateOptions { sections: 1001, nodes: 17, ..options() };
    let made = sheet(&rails, &arcs, [None, None], &long, &|_| true).unwrap().sections;
    for column in 0..17 {
        let before = leaving(|k| made.section(500 - k)[column]);
        let after = leaving(|k| made.section(500 + k)[column]);
        let kink = after.angle_between(-before).to_degrees();
        assert!(kink < 0.05, "column {column}: {kink}");
    }
}

#[test]
fn it_continues_neighbours_at_both_ends() {
    let (rails, arcs) = cuff(400);
    let ends = [arcs[0].clone(), arcs[2].clone()];
    // Skin beyond wrist and elbow, tilted out by other angles than the rails.
    let into = |p: DVec3, tilt: f64| DVec3::Y + DVec3::new(p.x, 0.0, p.z).normalize() * tilt;
    let directions = |curve: &Curve, tilt: f64, sign: f64| -> Vec<DVec3> {
        curve.points().iter().map(|p| into(*p, tilt) * sign).collect()
    };
    let (low, high) = (directions(&ends[0], 0.1, 1.0), directions(&ends[1], 0.02, -1.0));
    let beside = ends[0].map(|p| p - into(p, 0.1) * 1e-4).unwrap();
    for start in [Neighbour::Directions(&low), Neighbour::Curve(&beside)] {
        for sections in [16, 33] {
            let options = GenerateOptions { sections, ..options() };
            let made = sheet(&rails, &ends, [Some(start), Some(Neighbour::Directions(&high))], &options, &|_| true);
            let made = made.unwrap().sections;
            for column in 0..41 {
                for (end, tilt) in [(false, 0.1), (true, 0.02)] {
                    let at = |k: usize| made.section(if end { sections - 1 - k } else { k })[column];
                    let normal = into(at(0), tilt).cross(at(0).cross(DVec3::Y));
                    let off = out_of_plane(leaving(at), normal);
                    assert!(off < 0.1, "{sections} sections, column {column}, end {end}: {off}");
                }
            }
            assert!(made.section(0).iter().all(|p| closest(&ends[0], *p).distance < 1e-12));
        }
    }
}

#[test]
fn a_rail_in_the_neighbours_plane_is_reproduced() {
    let (rails, arcs) = cuff(2000);
    let ends = [arcs[0].clone(), arcs[2].clone()];
    let slope = 0.05;
    let low: Vec<DVec3> =
        ends[0].points().iter().map(|p| DVec3::Y + DVec3::new(p.x, 0.0, p.z).normalize() * slope).collect();
    let made = sheet(&rails, &ends, [Some(Neighbour::Directions(&low)), None], &options(), &|_| true).unwrap();
    assert!(made.warnings.is_empty(), "{:?}", made.warnings);
    for (rail, column) in rails.iter().zip(made.sections.rails()) {
        let off = made.sections.iter().map(|section| closest(rail, section[*column]).distance).fold(0.0, f64::max);
        assert!(off < 2e-5, "{off}");
    }
}

#[test]
fn symmetry_place_and_sense() {
    let (rails, arcs) = cuff(200);
    let made = run(&rails, &arcs).sections;
    for section in made.iter() {
        for j in 0..41 {
            assert!(section[j].distance(section[40 - j] * DVec3::new(-1.0, 1.0, 1.0)) < 1e-12);
        }
    }
    let there: (Vec<Curve>, Vec<Curve>) = (rails.iter().map(placed).collect(), arcs.iter().map(placed).collect());
    assert!(apart(&made, &run(&there.0, &there.1).sections, place) < 1e-11);
    // All the other way along: the same surface from the other end.
    let back = |curves: &[Curve]| -> Vec<Curve> { curves.iter().cloned().map(Curve::reversed).collect() };
    let mut upside: Vec<Curve> = arcs.clone();
    upside.reverse();
    let turned = run(&back(&rails), &upside).sections;
    for row in 0..33 {
        for (p, q) in made.section(row).iter().zip(turned.section(32 - row)) {
            assert!(p.distance(*q) < 1e-9, "row {row}");
        }
    }
    // Affine maps that keep shares of lengths: everything stretched from straight rails and profiles.
    let grid = |stretch: DVec3| {
        let line = |a: DVec3, b: DVec3| open("line", 1, |t| a.lerp(b, t) * stretch);
        let rails: Vec<Curve> =
            [0.0, 0.1, 0.2].map(|x| line(DVec3::new(x, 0.0, x * x), DVec3::new(x, 0.3, 0.1 - x * x))).to_vec();
        let edge = |y: f64| {
            Curve::new("edge", rails.iter().map(|r| if y == 0.0 { r.start() } else { r.end() }).collect(), false)
        };
        let profiles = [edge(0.0).unwrap(), edge(1.0).unwrap()];
        let linear = GenerateOptions { weights: Weights::Linear, ..options() };
        sheet(&rails, &profiles, [None, None], &linear, &|_| true).unwrap().sections
    };
    let stretch = DVec3::new(1.0, 4.0, 1.0);
    assert!(apart(&grid(DVec3::ONE), &grid(stretch), |p| p * stretch) < 1e-12);
}

#[test]
fn a_tube_passes_several_closed_profiles() {
    let size = |y: f64| 0.05 + 0.02 * (20.0 * y).sin();
    let ring = |name: &str, y: f64| {
        closed(name, 2400, |a| DVec3::new(size(y) * a.cos(), y, -size(y) * (1.0 + 2.0 * y) * a.sin()))
    };
    let profiles = [("ankle", 0.0), ("calf", 0.12), ("knee", 0.2), ("thigh", 0.4)].map(|(n, y)| ring(n, y));
    let rail = |k: usize| {
        let a = TAU * k as f64 / 4.0;
        open("rail", 600, |t| {
            let y = 0.4 * t;
            DVec3::new(size(y) * a.cos(), y, -size(y) * (1.0 + 2.0 * y) * a.sin())
        })
    };
    let rails: Vec<Curve> = (0..4).map(rail).collect();
    let options = GenerateOptions { sections: 41, nodes: 64, ..GenerateOptions::default() };
    let made = through_closed(&rails, &profiles, [None, None], &options, &|_| true).unwrap();
    assert!(made.warnings.is_empty() && made.notes.is_empty(), "{:?} {:?}", made.warnings, made.notes);
    for profile in &profiles {
        let on = |section: &[DVec3]| section.iter().all(|p| closest(profile, *p).distance < 1e-9);
        assert_eq!(made.sections.iter().filter(|section| on(section)).count(), 1, "{}", profile.name());
    }
    // Two profiles given in this way are the tube between them.
    let ends = [profiles[0].clone(), profiles[3].clone()];
    let two = through_closed(&rails, &ends, [None, None], &options, &|_| true).unwrap();
    assert_eq!(two, between_closed(&rails, &ends[0], &ends[1], &options, &|_| true).unwrap());
    let arc = ArcLength::of(&rails[0]);
    assert!(two.sections.section(20)[0].distance(arc.point_at_fraction(0.5)) < 1e-12);
}

#[test]
fn errors() {
    let (rails, arcs) = cuff(50);
    let refused =
        |rails: &[Curve], profiles: &[Curve]| sheet(rails, profiles, [None, None], &options(), &|_| true).unwrap_err();
    assert_eq!(refused(&rails, &arcs[..1]), GenerateError::TooFewProfiles { found: 1, needed: 2 });
    assert_eq!(refused(&rails[..1], &arcs), GenerateError::TooFewRails { found: 1 });
    let ring = closed("ring", 100, |a| DVec3::new(a.cos(), 0.0, a.sin()) * 0.03);
    let message = refused(&rails, &[ring, arcs[2].clone()]).to_string();
    assert!(message.contains("start curve (\"ring\") is closed"), "{message}");
    let mixed = [arcs[0].clone(), arcs[2].clone(), arcs[1].clone()];
    assert!(matches!(refused(&rails, &mixed), GenerateError::Gap { which: "end", .. }));
    let swapped = [1, 0, 2].map(|k| rails[k].clone());
    assert!(matches!(refused(&swapped, &arcs), GenerateError::Crossing { first: 0, second: 1, .. }));
    let turned = [2, 1, 0].map(|k| rails[k].clone());
    let message = refused(&turned, &arcs).to_string();
    assert!(message.contains("against the order of the rails: reverse it"), "{message}");
    let twice = [rails[0].clone(), rails[0].clone()];
    assert!(matches!(refused(&twice, &arcs), GenerateError::SameFoot { first: 0, second: 1, .. }));
    let back = [rails[0].clone(), rails[1].clone().reversed(), rails[2].clone()];
    assert!(matches!(refused(&back, &arcs), GenerateError::RailIsReversed { rail: 1, .. }));
    let aside = arcs[1].map(|p| p + DVec3::Z * 0.1).unwrap();
    let off = refused(&rails, &[arcs[0].clone(), aside, arcs[2].clone()]);
    assert!(off.to_string().contains("passes") && off.to_string().contains("inner curve"), "{off}");
    let few = GenerateOptions { sections: 5, ..options() };
    let few = sheet(&rails, &arcs, [None, None], &few, &|_| true);
    assert_eq!(few, Err(GenerateError::TooFewSections { found: 5, needed: 6 }));
}
