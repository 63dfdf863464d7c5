//! The saved graphs whose sections are series: how well they fit, and what their surfaces are.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod graphs;

use glam::DVec3;
use graphs::Saved;
use maquette_geometry::mesh::{Mesh, MeshDistance, check};
use maquette_graph::{Evaluation, Evaluator, Literal, OutcomeState, Report};
use maquette_nodes::wire;

fn report<'a>(saved: &Saved, evaluation: &'a Evaluation, node: &str) -> &'a Report {
    match &evaluation.outcome(saved.node(node)).unwrap().state {
        OutcomeState::Done { report, .. } => report,
        other => panic!("{node}: {other:?}"),
    }
}

fn figure(saved: &Saved, evaluation: &Evaluation, node: &str, name: &str) -> f64 {
    report(saved, evaluation, node).figure(name).unwrap_or_else(|| panic!("{node}.{name}")).value
}

fn sections<'a>(saved: &Saved, evaluation: &'a Evaluation, node: &str) -> &'a [wire::NamedSection] {
    &evaluation.value::<wire::EllipticSections>(saved.node(node), "sections").unwrap().0
}

/// The mesh of a node, which must be sound.
fn sound<'a>(saved: &Saved, evaluation: &'a Evaluation, node: &str, closed: bool) -> &'a Mesh {
    let mesh = &evaluation.value::<wire::Mesh>(saved.node(node), "mesh").unwrap().0;
    let found = check(mesh);
    assert!(found.is_sound() && found.closed == closed && found.shells == 1, "{node}: {found}");
    mesh
}

#[test]
fn the_forearm_is_eight_generalized_ellipses() {
    let saved = Saved::load("forearm");
    let evaluation = saved.evaluate(&mut Evaluator::default(), &["forearm", "skin", "fit", "fitted", "surface"]);
    let of = |name: &str| figure(&saved, &evaluation, "fitted", name);
    assert_eq!(sections(&saved, &evaluation, "fitted").len(), 8);
    // The tolerances of the thesis (3.13), and fewer harmonics than it says limbs need.
    assert!(of("mean") <= 0.01 && of("max") <= 0.025 && of("mean-harmonics") <= 4.0);
    assert!(of("largest-distance") < 2e-3 && of("constants") < 200.0);
    // By nearest points, both ways, no section is farther than at equal angles.
    let nearest = |name: &str| figure(&saved, &evaluation, "fit", name);
    assert!(nearest("max") <= of("max") && nearest("met") == 1.0 && nearest("largest-distance") > 5e-4);
    assert_eq!(nearest("harmonics"), of("most-harmonics"));
    let skin = sound(&saved, &evaluation, "skin", true);
    assert!(figure(&saved, &evaluation, "skin", "deviation") <= 2e-4);
    // A mesh of the same accuracy has ten times as many numbers.
    let numbers = figure(&saved, &evaluation, "surface", "constants");
    assert!(3.0 * skin.positions().len() as f64 > 10.0 * numbers, "{numbers}");
}

#[test]
fn the_leg_is_cut_from_its_template_along_the_bones() {
    let saved = Saved::load("from-template");
    let evaluation = saved.evaluate(&mut Evaluator::default(), &["leg", "skin", "section lines"]);
    let template = &evaluation.value::<wire::Mesh>(saved.node("template"), "mesh").unwrap().0;
    let distance = MeshDistance::new(template).unwrap();
    let cut = &evaluation.value::<wire::Curves>(saved.node("cut"), "curves").unwrap().0;
    assert_eq!((cut.len(), figure(&saved, &evaluation, "cut", "missed")), (12, 0.0));
    assert!(figure(&saved, &evaluation, "cut", "largest-offset") < 0.03);
    for curve in cut {
        assert!(curve.points().iter().all(|p| distance.nearest(*p).distance < 1e-6), "{}", curve.name());
    }
    let of = |name: &str| figure(&saved, &evaluation, "fitted", name);
    assert!(of("mean") <= 0.01 && of("max") <= 0.025 && of("mean-harmonics") <= 4.0);
    // The lids apart, the surface is that of the template: a loft by straight lines is within 2 mm at 95 %.
    let skin = sound(&saved, &evaluation, "skin", true);
    let lids = [cut.first().unwrap(), cut.last().unwrap()].map(|curve| {
        let centre = curve.points().iter().sum::<DVec3>() / curve.points().len() as f64;
        (centre, curve.area_vector().normalize())
    });
    let on_lid = |p: &&DVec3| lids.iter().any(|(centre, normal)| (**p - *centre).dot(*normal).abs() < 2e-3);
    let mut off: Vec<f64> =
        skin.positions().iter().filter(|p| !on_lid(p)).map(|p| distance.nearest(*p).distance).collect();
    off.sort_by(f64::total_cmp);
    assert!(off.len() > 1000 && off[off.len() * 95 / 100] < 1e-3, "{} m", off[off.len() * 95 / 100]);
}

#[test]
fn the_hip_in_segments_is_within_4_mm_and_keeps_its_corner() {
    let saved = Saved::load("hip");
    let evaluation = saved.evaluate(&mut Evaluator::default(), &["hip", "skin", "fitted"]);
    let of = |name: &str| figure(&saved, &evaluation, "fitted", name);
    assert!(of("largest-distance") <= 4e-3 && of("most-harmonics") <= 8.0);
    let stack = sections(&saved, &evaluation, "fitted");
    assert!(stack.iter().all(|named| named.section.segments().len() == 2));
    let notch = stack[1].section.joints()[0];
    let section = &stack[1].section;
    let turn = section.tangent(notch - 1e-6).angle_between(section.tangent(notch + 1e-6));
    assert!(turn.to_degrees() > 80.0, "{}", turn.to_degrees());
    sound(&saved, &evaluation, "skin", false);
}

#[test]
fn open_strokes_are_fitted_and_a_surface_goes_through_them() {
    let saved = Saved::load("open-strokes");
    assert_eq!(saved.results(), ["relief", "drawn lines", "fitted lines"]);
    let evaluation =
        saved.evaluate(&mut Evaluator::default(), &["relief", "skin", "fitted lines", "fitted", "surface"]);
    let stack = sections(&saved, &evaluation, "fitted");
    assert_eq!(stack.iter().map(|named| named.section.is_closed()).collect::<Vec<_>>(), [false; 5]);
    assert!(figure(&saved, &evaluation, "fitted", "max") <= 0.01);
    // The strokes with features need more harmonics than those beside them.
    let harmonics: Vec<usize> = stack.iter().map(|named| named.section.harmonics()).collect();
    assert!(harmonics[2] > harmonics[0] && harmonics[2] > harmonics[4], "{harmonics:?}");
    assert_eq!(report(&saved, &evaluation, "fitted").notes, ["angles by arc length"]);
    sound(&saved, &evaluation, "skin", false);
    let surface = evaluation.value::<wire::Surface>(saved.node("surface"), "surface").unwrap();
    let [part] = surface.series().unwrap() else { panic!("{surface:?}") };
    for (named, u) in stack.iter().zip(part.section_parameters()) {
        for v in [0.0, 0.7, 2.0, 3.0] {
            assert!(part.evaluate(*u, v).position.distance(named.section.point(v)) < 1e-12);
        }
    }
}
