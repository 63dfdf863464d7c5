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
use maquette_graph::{Evaluation, Evaluator};
use maquette_nodes::wire;

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
    let of = |name: &str| saved.figure(&evaluation, "fitted", name);
    assert_eq!(sections(&saved, &evaluation, "fitted").len(), 8);
    // The tolerances of the thesis (3.13), and fewer harmonics than it says limbs need.
    assert!(of("mean") <= 0.01 && of("max") <= 0.025 && of("mean-harmonics") <= 4.0);
    assert!(of("largest-distance") < 2e-3 && of("constants") < 200.0);
    // By nearest points, both ways, no section is farther than at equal angles.
    let nearest = |name: &str| saved.figure(&evaluation, "fit", name);
    assert!(nearest("max") <= of("max") && nearest("met") == 1.0 && nearest("largest-distance") > 5e-4);
    assert_eq!(nearest("harmonics"), of("most-harmonics"));
    let skin = sound(&saved, &evaluation, "skin", true);
    assert!(saved.figure(&evaluation, "skin", "deviation") <= 2e-4);
    // A mesh of the same accuracy has ten times as many numbers.
    let numbers = saved.figure(&evaluation, "surface", "constants");
    assert!(3.0 * skin.positions().len() as f64 > 10.0 * numbers, "{numbers}");
}

#[test]
fn the_leg_is_cut_from_its_template_along_the_bones() {
    let saved = Saved::load("from-template");
    let evaluation =
        saved.evaluate(&mut Evaluator::default(), &["leg", "skin", "section lines", "template", "cut", "fitted"]);
    let template = &evaluation.value::<wire::Mesh>(saved.node("template"), "mesh").unwrap().0;
    let distance = MeshDistance::new(template).unwrap();
    let cut = &evaluation.value::<wire::Curves>(saved.node("cut"), "curves").unwrap().0;
    assert_eq!((cut.len(), saved.figure(&evaluation, "cut", "missed")), (12, 0.0));
    assert!(saved.figure(&evaluation, "cut", "largest-offset") < 0.03);
    for curve in cut {
        assert!(curve.points().iter().all(|p| distance.nearest(*p).distance < 1e-6), "{}", curve.name());
    }
    let of = |name: &str| saved.figure(&evaluation, "fitted", name);
    // Within 1 mm, as the graph asks for, which needs more harmonics than 1 % of the size.
    assert!(of("largest-distance") <= 1e-3 && of("mean-harmonics") <= 6.0 && of("most-harmonics") <= 10.0);
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
    assert!(off.len() > 1000 && off[off.len() * 95 / 100] < 1.2e-3, "{} m", off[off.len() * 95 / 100]);
}

#[test]
fn the_hip_in_segments_is_within_4_mm_and_keeps_its_corner() {
    let saved = Saved::load("hip");
    let evaluation = saved.evaluate(&mut Evaluator::default(), &["hip", "skin", "fitted"]);
    let of = |name: &str| saved.figure(&evaluation, "fitted", name);
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
    assert!(saved.figure(&evaluation, "fitted", "max") <= 0.01);
    // The strokes with features need more harmonics than those beside them.
    let harmonics: Vec<usize> = stack.iter().map(|named| named.section.harmonics()).collect();
    assert!(harmonics[2] > harmonics[0] && harmonics[2] > harmonics[4], "{harmonics:?}");
    assert_eq!(saved.report(&evaluation, "fitted").notes, ["angles by arc length"]);
    sound(&saved, &evaluation, "skin", false);
    let surface = evaluation.value::<wire::Surface>(saved.node("surface"), "surface").unwrap();
    let [part] = surface.series().unwrap() else { panic!("{surface:?}") };
    for (named, u) in stack.iter().zip(part.section_parameters()) {
        for v in [0.0, 0.7, 2.0, 3.0] {
            assert!(part.evaluate(*u, v).position.distance(named.section.point(v)) < 1e-12);
        }
    }
}

#[test]
fn the_human_stands_on_65_sections() {
    let saved = Saved::load("human");
    let mut evaluator = Evaluator::default();
    let evaluation = saved.evaluate(&mut evaluator, &["human", "trunk", "joints", "body", "both sides"]);
    let of = |node: &str, name: &str| saved.figure(&evaluation, node, name);
    // The tolerances of the thesis, and its bound of 15 harmonics; hips and torso within 4 mm at the worst point.
    for (node, mean, most) in
        [("trunk", "mean", "max"), ("left arm", "fitted/mean", "fitted/max"), ("left leg", "fitted/mean", "fitted/max")]
    {
        assert!(of(node, mean) <= 0.01 && of(node, most) <= 0.025, "{node}");
    }
    assert!(of("trunk", "largest-distance") <= 4e-3 && of("trunk", "most-harmonics") < 15.0);
    assert!(of("left arm", "fitted/mean-harmonics") <= 4.0 && of("left leg", "fitted/mean-harmonics") <= 4.0);
    assert_eq!(sections(&saved, &evaluation, "trunk").len(), 34);
    // Parts that share a section meet without a crease, and the patches of the hips keep only the corner at the back.
    assert!(saved.report(&evaluation, "joints").figures.is_empty(), "measured on request only");
    let [human, joints] = ["human", "joints"].map(|name| saved.node(name));
    let request = Saved::request(&[human]).examine_only(&[joints]);
    let examined = evaluator.evaluate(&saved.catalogue, &saved.graph, &request);
    let of_joints = |name: &str| saved.figure(&examined, "joints", name);
    assert!(of_joints("largest-gap") < 1e-9 && of_joints("largest-part-angle") < 0.01);
    // Three seams between four parts, and the patches of each.
    let rows = &saved.report(&examined, "joints").table("joints").unwrap().rows;
    assert!(rows.len() > 3 && saved.report(&examined, "human").figures.is_empty(), "{rows:?}");
    // Per vertex of the mesh it replaces the body has far fewer constants than the thesis's 7,530 for 12,426.
    let constants =
        of("trunk", "constants") + 2.0 * (of("left arm", "fitted/constants") + of("left leg", "fitted/constants"));
    assert!(constants < 7530.0 / 12_426.0 * 13_380.0 / 2.0, "{constants}");
    let body = &evaluation.value::<wire::Mesh>(saved.node("body"), "mesh").unwrap().0;
    let found = check(body);
    assert!(found.closed && found.shells == 5 && found.is_sound(), "{found}");
    let height = body.positions().iter().map(|p| p.y).fold(0.0, f64::max);
    assert!((height - 1.66).abs() < 0.02, "{height}");
    let mirrored = |p: &DVec3| DVec3::new(-p.x, p.y, p.z);
    let sides = &evaluation.value::<wire::Mesh>(saved.node("both sides"), "mesh").unwrap().0;
    let distance = MeshDistance::new(sides).unwrap();
    assert!(sides.positions().iter().all(|p| distance.nearest(mirrored(p)).distance < 1e-9));
}
