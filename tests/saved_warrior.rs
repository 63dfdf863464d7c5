//! The saved warrior: a whole character, sound in every part, and live while a stroke is drawn anew.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod graphs;

use glam::DVec3;
use graphs::Saved;
use maquette_geometry::mesh::{Mesh, MeshDistance, check, measure};
use maquette_graph::{Edit, Evaluator, EventLog, Literal, Source};

const GROUPS: [&str; 10] = ["head", "body", "hands", "boots", "kilt", "vest", "belt", "pauldrons", "helmet", "bracers"];

fn mirrored(mesh: &Mesh) -> f64 {
    let distance = MeshDistance::new(mesh).unwrap();
    let off = |p: &DVec3| distance.nearest(*p * DVec3::new(-1.0, 1.0, 1.0)).distance;
    mesh.positions().iter().map(off).fold(0.0, f64::max)
}

#[test]
fn the_warriors_body_is_one_smooth_shell_from_head_to_toe() {
    let saved = Saved::load("warrior");
    let mut evaluator = Evaluator::default();
    let evaluation = saved.evaluate(&mut evaluator, &["skin", "body", "head"]);
    let body = saved.mesh(&evaluation, "body", "mesh");
    let found = check(body);
    // Between the lids and the lips one looks at eyeballs and teeth; all else is welded.
    assert!(found.is_sound(), "{found}");
    assert_eq!((found.shells, found.boundary_loops), (1, 3), "{found}");
    assert!(measure::signed_volume(body) > 0.06 && measure::signed_volume(body) < 0.09);
    // Neck, shoulders and hips grow out of the trunk, nose, eyes and mouth out of the skull, without a gap or a crease.
    // What is seen of an angle is at the root of the nose, the end of which keeps the normals of its own surface.
    let welds = [("body", "joined", 10.0, 0.1), ("head", "face with nose", 2.0, 0.6), ("head", "joined", 6.0, 0.1)];
    for (group, weld, seams, degrees) in welds {
        let of = |name: &str| saved.figure(&evaluation, group, &format!("{weld}/{name}"));
        assert_eq!((of("seams"), of("largest-gap"), of("t-junctions")), (seams, 0.0, 0.0), "{group}/{weld}");
        assert!(of("largest-angle") < degrees, "{group}/{weld}: {} degrees", of("largest-angle"));
    }
    assert!(mirrored(body) < 5e-4, "left and right are {} m apart", mirrored(body));
}

#[test]
fn everything_the_warrior_wears_is_sound_and_mirrored() {
    let saved = Saved::load("warrior");
    let mut evaluator = Evaluator::default();
    let mut names = saved.results();
    let results = names.len();
    names.extend(GROUPS);
    let evaluation = saved.evaluate(&mut evaluator, &names);
    // Shells, open ends: two of each boot's shaft and each bracer, the edges of plates, skirts and lips.
    let parts = [
        ("hands", "mesh", 12, 0),
        ("boots", "mesh", 4, 4),
        ("kilt", "mesh", 1, 2),
        ("vest", "mesh", 1, 2),
        ("belt", "mesh", 1, 2),
        ("belt", "buckle", 1, 0),
        ("pauldrons", "mesh", 6, 6),
        ("helmet", "mesh", 1, 1),
        ("helmet", "plume", 1, 0),
        ("bracers", "mesh", 2, 4),
        ("head", "teeth", 1, 0),
        ("head", "eyeballs", 2, 0),
        ("head", "irises", 2, 2),
        ("head", "pupils", 2, 2),
        ("head", "lips", 1, 2),
    ];
    for (node, output, shells, loops) in parts {
        let part = saved.mesh(&evaluation, node, output);
        let found = check(part);
        assert!(found.is_sound(), "{node}.{output}: {found}");
        assert_eq!((found.shells, found.boundary_loops), (shells, loops), "{node}.{output}: {found}");
        assert!(mirrored(part) < 1e-3, "{node}.{output}: left and right are {} m apart", mirrored(part));
    }
    assert_eq!(parts.len() + 1, results);
    // The vest lies outside of the body where it is worn, but at the shoulders, which the arms leave through it.
    let body = MeshDistance::new(saved.mesh(&evaluation, "body", "mesh")).unwrap();
    for p in saved.mesh(&evaluation, "vest", "mesh").positions().iter().filter(|p| p.y < 1.3) {
        let nearest = body.nearest(*p);
        let flat = DVec3::new(1.0, 0.0, 1.0);
        assert!((*p * flat).length() > (nearest.point * flat).length(), "the vest is in the body at {p}");
        assert!(nearest.distance > 0.004 && nearest.distance < 0.05, "the vest is {} m off at {p}", nearest.distance);
    }
}

#[test]
fn a_stroke_drawn_anew_runs_only_what_follows_from_it() {
    let mut saved = Saved::load("warrior");
    let mut evaluator = Evaluator::default();
    let names: Vec<String> = saved.results().into_iter().map(str::to_owned).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).chain(GROUPS).collect();
    let before = saved.evaluate(&mut evaluator, &names);
    let vest = saved.node("vest");
    let inner = saved.graph.node(vest).unwrap().body().unwrap().graph().unwrap();
    let chest = inner.find("chest").unwrap();
    let Some(Source::Literal { literal: Literal::Strokes(strokes), .. }) = inner.node(chest).unwrap().source("strokes")
    else {
        panic!()
    };
    let mut strokes = strokes.clone();
    for point in &mut strokes[0].points {
        point.x *= 1.05;
    }
    let edit = Edit::Within { node: vest, edit: Edit::set(chest, "strokes", Literal::Strokes(strokes)).into() };
    saved.graph.apply(&saved.catalogue, &edit).unwrap();
    let log = EventLog::default();
    let targets: Vec<_> = names.iter().map(|name| saved.node(name)).collect();
    let after = evaluator.evaluate(&saved.catalogue, &saved.graph, &Saved::request(&targets).events(&log));
    let mut ran = log.take_ran();
    ran.sort();
    assert_eq!(ran, ["vest", "vest plate", "vest/chest", "vest/contours", "vest/shaped", "vest/surface"]);
    let widest = |evaluation| {
        let near = saved.mesh(evaluation, "vest", "mesh").positions().iter().filter(|p| (p.y - 1.335).abs() < 0.01);
        near.map(|p| p.x).fold(0.0, f64::max)
    };
    assert!((widest(&after) / widest(&before) - 1.05).abs() < 2e-3, "{} of {}", widest(&after), widest(&before));
}

#[test]
fn the_warriors_parameters_do_what_they_say() {
    let mut saved = Saved::load("warrior");
    let mut evaluator = Evaluator::default();
    let top = |saved: &Saved, evaluator: &mut Evaluator| {
        let evaluation = saved.evaluate(evaluator, &["helmet"]);
        saved.mesh(&evaluation, "helmet", "plume").positions().iter().map(|p| p.y).fold(0.0, f64::max)
    };
    let low = top(&saved, &mut evaluator);
    saved.graph.set_parameter("plume", Literal::Vector([1.0, 2.0, 1.0])).unwrap();
    let high = top(&saved, &mut evaluator);
    // Twice as high above the pivot of the drawing.
    assert!(((high - 1.86) / (low - 1.86) - 2.0).abs() < 1e-9, "{low} to {high}");
    let wide = |saved: &Saved, evaluator: &mut Evaluator| {
        let evaluation = saved.evaluate(evaluator, &["head"]);
        saved.mesh(&evaluation, "head", "lips").positions().iter().map(|p| p.x).fold(0.0, f64::max)
    };
    let narrow = wide(&saved, &mut evaluator);
    saved.graph.set_parameter("mouth", Literal::Vector([1.1, 1.0, 1.0])).unwrap();
    let wider = wide(&saved, &mut evaluator);
    assert!(wider > 1.05 * narrow, "{narrow} to {wider}");
}
