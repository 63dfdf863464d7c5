//! The saved graphs of blends and patches: closed, welded to the bit, and smooth along the whole joint.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod graphs;

use std::path::Path;

use glam::DVec3;
use graphs::Saved;
use maquette_geometry::border::Border;
use maquette_geometry::curve::{Curve, closest};
use maquette_geometry::mesh::{Mesh, MeshCheck, MeshDistance, check, measure};
use maquette_geometry::sections::Sections;
use maquette_geometry::surface::ripple;
use maquette_graph::{Cell, Evaluation, Evaluator, file};
use maquette_nodes::wire;

/// One sound, closed shell that faces outwards.
fn sound(name: &str, mesh: &Mesh) -> MeshCheck {
    let found = check(mesh);
    assert!(found.is_sound() && found.closed && found.shells == 1, "{name}: {found}");
    assert!(measure::signed_volume(mesh) > 0.0 && found.folded_polygons.is_empty(), "{name}");
    assert!(mesh.normals().is_some() && mesh.uvs().is_some());
    found
}

/// The seams of a `join-parts` node, within `within` of the node: as many as wanted, whole, without a gap, their angles
/// (those of the meshes' normals) below `degrees`.
fn smooth_seams(saved: &Saved, evaluation: &Evaluation, [node, within]: [&str; 2], wanted: f64, degrees: f64) {
    let of = |name: &str| saved.figure(evaluation, node, &format!("{within}{name}"));
    assert_eq!((of("seams"), of("open-loops"), of("t-junctions")), (wanted, 0.0, 0.0), "{node}");
    assert_eq!(of("largest-gap"), 0.0, "{node}: welded to the bit");
    assert!(of("largest-angle") < degrees, "{node}: {} degrees", of("largest-angle"));
    let table = saved.report(evaluation, node).table(&format!("{within}welds")).unwrap();
    let whole = table.columns.iter().position(|column| column.name == "whole").unwrap();
    assert!(table.rows.iter().all(|row| row[whole] == Cell::from(true)), "{node}");
}

/// Largest angle, degrees, between the way in which columns of sections leave a border and the tangent plane of the
/// surface there: by differences of fourth order, so that facets do not count.
fn leaves(sections: &Sections, from_end: bool, border: &Border) -> f64 {
    let last = sections.len() - 1;
    let row = |k: usize| sections.section(if from_end { last - k } else { k });
    let count = border.curve().points().len();
    let angle = |j: usize| {
        let p = row(0)[j];
        let k = (0..count)
            .min_by(|a, b| {
                let away = |k: usize| border.curve().points()[k].distance_squared(p);
                away(*a).total_cmp(&away(*b))
            })
            .unwrap();
        assert_eq!(border.curve().points()[k], p, "the border keeps its points");
        let along = border.curve().points()[(k + 1) % count] - border.curve().points()[(k + count - 1) % count];
        let normal = along.cross(border.directions()[k]).normalize();
        let weights = [-25.0, 48.0, -36.0, 16.0, -3.0];
        let way: DVec3 = weights.into_iter().enumerate().map(|(k, weight)| row(k)[j] * weight).sum();
        way.normalize().dot(normal).asin().abs().to_degrees()
    };
    (0..sections.nodes()).map(angle).fold(0.0, f64::max)
}

/// Folds between neighbouring faces near a place, degrees: facets of what bends there.
fn steepest_fold(mesh: &Mesh, near: impl Fn(DVec3) -> bool) -> f64 {
    let topology = maquette_geometry::mesh::Topology::new(mesh);
    let normal = |polygon: u32| measure::polygon_normal(mesh, polygon as usize);
    let folds = topology.edges().filter(|uses| uses.len() == 2).filter_map(|uses| {
        let [a, b] = uses[0].edge.map(|vertex| mesh.positions()[vertex as usize]);
        let here = near(0.5 * (a + b));
        here.then(|| normal(uses[0].polygon).angle_between(normal(uses[1].polygon)).to_degrees())
    });
    folds.fold(0.0, f64::max)
}

#[test]
fn a_transition_joins_an_ellipsoid_and_a_cylinder() {
    let mut saved = Saved::load("blend");
    let mut evaluator = Evaluator::default();
    let targets = ["figure", "boundaries", "joined", "transition", "both borders"];
    let evaluation = saved.evaluate(&mut evaluator, &targets);
    let whole = saved.mesh(&evaluation, "joined", "mesh").clone();
    sound("blend", &whole);
    smooth_seams(&saved, &evaluation, ["joined", ""], 2.0, 0.1);
    let blend = saved.sections(&evaluation, "transition", "sections");
    let ends = saved.borders(&evaluation, "both borders", "borders");
    for (from_end, border) in [(false, &ends[0]), (true, &ends[1])] {
        assert!(leaves(blend, from_end, border) < 0.1, "{}", leaves(blend, from_end, border));
    }
    assert!(ripple(blend).sign_changes <= 2, "{:?}", ripple(blend));
    // Of the two primitives what the planes leave is as it was: the ellipsoid's top, the cylinder's round.
    let distance = MeshDistance::new(&whole).unwrap();
    assert!(distance.nearest(DVec3::new(0.0, 0.79, 0.0)).distance < 1e-9);
    // Folds are those of facets.
    let fold = |mesh: &Mesh| steepest_fold(mesh, |p| (0.28..0.56).contains(&p.y));
    let coarse = fold(&whole);
    assert!(coarse < 18.0, "{coarse}");
    for (name, many) in [("points", 128), ("rings", 32)] {
        saved.graph.set_parameter(name, maquette_graph::Literal::Integer(many)).unwrap();
    }
    for node in ["head", "trunk"] {
        let id = saved.node(node);
        for input in ["sections", "nodes"] {
            saved.graph.set(id, input, maquette_graph::Literal::Integer(128)).unwrap();
        }
    }
    let evaluation = saved.evaluate(&mut evaluator, &targets);
    let fine = saved.mesh(&evaluation, "joined", "mesh");
    sound("blend", fine);
    smooth_seams(&saved, &evaluation, ["joined", ""], 2.0, 0.1);
    // Slivers in the strip along a cut fold more than what is beside them; normals, which are seen, do not.
    assert!(fold(fine) < 40.0, "{}", fold(fine));
}

#[test]
fn both_arms_are_blended_into_the_trunk() {
    let saved = Saved::load("shoulder");
    let targets = ["figure", "sketch lines", "left shoulder", "both shoulders", "arm with its end"];
    let evaluation = saved.evaluate(&mut Evaluator::default(), &targets);
    let whole = saved.mesh(&evaluation, "both shoulders", "mesh");
    sound("shoulder", whole);
    for node in ["left shoulder", "both shoulders"] {
        smooth_seams(&saved, &evaluation, [node, "joined/"], 2.0, 0.1);
        let blend = saved.sections(&evaluation, node, "rings");
        assert!(ripple(blend).sign_changes <= 3, "{node}: {:?}", ripple(blend));
        assert_eq!((blend.nodes(), blend.len()), (64, 14));
    }
    // The limb is as it was, and its ring is the blend's last.
    let arm = saved.mesh(&evaluation, "arm with its end", "mesh");
    let distance = MeshDistance::new(whole).unwrap();
    assert!(arm.positions().iter().all(|p| distance.nearest(*p).distance < 1e-12));
    assert_eq!(saved.figure(&evaluation, "left shoulder", "grown/open limb/faces-replaced"), 0.0);
    // Left and right are mirror images.
    let off = whole.positions().iter().map(|p| distance.nearest(*p * DVec3::new(-1.0, 1.0, 1.0)).distance);
    assert!(off.fold(0.0, f64::max) < 5e-5);
    // At the shoulder the surface bends over some millimetres, nowhere at once.
    let shoulder = |p: DVec3| (0.09..0.24).contains(&p.x.abs()) && (1.28..1.45).contains(&p.y);
    let fold = steepest_fold(whole, shoulder);
    assert!(fold < 24.0, "{fold}");
}

#[test]
fn the_same_part_joins_legs_and_a_neck() {
    let catalogue = maquette_nodes::catalogue().unwrap();
    let bytes = std::fs::read("tests/graphs/mannequin.ron").unwrap();
    let read = |path: &Path| std::fs::read(Path::new("graphs").join(path)).map_err(|error| error.to_string());
    let loaded = file::from_bytes_with(&catalogue, &bytes, &file::Includes::new("mannequin.ron", &read)).unwrap();
    assert_eq!(loaded.problems, []);
    let saved = Saved { catalogue, graph: loaded.graph };
    let evaluation = saved.evaluate(&mut Evaluator::default(), &["out", "with left", "with legs", "whole"]);
    for node in ["with left", "with legs", "whole"] {
        sound(node, saved.mesh(&evaluation, node, "mesh"));
        smooth_seams(&saved, &evaluation, [node, "joined/"], 2.0, 0.1);
        let blend = saved.sections(&evaluation, node, "rings");
        assert!(ripple(blend).sign_changes <= 3, "{node}: {:?}", ripple(blend));
    }
}

#[test]
fn a_patch_closes_an_opening_and_continues_the_hull_on_all_sides() {
    let saved = Saved::load("patch");
    let targets = ["craft", "curve network", "joined", "patch", "sides", "even ridge", "hull surface"];
    let evaluation = saved.evaluate(&mut Evaluator::default(), &targets);
    let whole = saved.mesh(&evaluation, "joined", "mesh");
    sound("patch", whole);
    // Along all sides, the corners between them included.
    smooth_seams(&saved, &evaluation, ["joined", ""], 1.0, 0.1);
    // Drawn curves are reproduced: the ridge, the sides.
    let patch = saved.sections(&evaluation, "patch", "sections");
    let ridge = &evaluation.value::<wire::Curves>(saved.node("even ridge"), "curves").unwrap().0[0];
    let distance = MeshDistance::new(whole).unwrap();
    let off = ridge.points().iter().map(|p| distance.nearest(*p).distance).fold(0.0, f64::max);
    // The ridge leaves the hull by a few degrees and is bent to leave it smoothly: 2.4 mm where it is highest.
    assert!(off < 2.5e-3, "{off}");
    let sides = saved.borders(&evaluation, "sides", "sides");
    assert_eq!(sides.len(), 4);
    let last = patch.len() - 1;
    let edge = patch.section(0).iter().chain(patch.section(last));
    for p in edge {
        let near = sides.iter().map(|side| closest(side.curve(), *p).distance).fold(f64::MAX, f64::min);
        assert!(near < 1e-9, "{near}");
    }
    assert!(ripple(patch).sign_changes <= 4, "{:?}", ripple(patch));
    let fold = steepest_fold(whole, |p| p.y > 0.06);
    assert!(fold < 10.0, "{fold}");
    // Off the patch the hull is as it was.
    let hull = saved.mesh(&evaluation, "hull surface", "mesh");
    let low = hull.positions().iter().filter(|p| p.y < 0.07);
    assert!(low.map(|p| distance.nearest(*p).distance).fold(0.0, f64::max) < 1e-12);
}

#[test]
fn chest_and_waist_are_drawn() {
    let saved = Saved::load("chest");
    let targets = ["figure", "drawn contours", "surface", "shaped", "trunk", "even contours"];
    let evaluation = saved.evaluate(&mut Evaluator::default(), &targets);
    let whole = saved.mesh(&evaluation, "surface", "mesh");
    sound("chest", whole);
    let contours = &evaluation.value::<wire::Curves>(saved.node("even contours"), "curves").unwrap().0;
    let (round, shaped) =
        (saved.sections(&evaluation, "trunk", "sections"), saved.sections(&evaluation, "shaped", "sections"));
    let table = saved.report(&evaluation, "shaped").table("contours").unwrap();
    assert_eq!(table.rows.len(), 2);
    for (section, contour) in [(46, &contours[0]), (24, &contours[1])] {
        let on = |p: &DVec3, curve: &Curve| closest(curve, *p).distance;
        let off = shaped.section(section).iter().map(|p| on(p, contour)).fold(0.0, f64::max);
        assert!(off < 1e-12, "{}: {off}", contour.name());
        let before = round.section(section).iter().map(|p| on(&p.with_y(contour.start().y), contour));
        assert!(before.fold(0.0, f64::max) > 0.006, "{} tells something", contour.name());
    }
    // Outside of both ranges nothing moves, and no crease is at their ends.
    for (k, section) in shaped.iter().enumerate() {
        let moved = section.iter().zip(round.section(k)).map(|(p, q)| p.distance(*q)).fold(0.0, f64::max);
        assert_eq!(moved > 0.0, (7..=60).contains(&k), "section {k} moves {moved}");
        if [7, 60].contains(&k) {
            assert!(moved < 5e-4, "section {k}: {moved}");
        }
    }
    assert!(ripple(shaped).sign_changes <= ripple(round).sign_changes + 4, "{:?} {:?}", ripple(shaped), ripple(round));
    let fold = steepest_fold(whole, |p| (0.92..1.5).contains(&p.y));
    assert!(fold < 20.0, "{fold}");
    // Both sides alike.
    let (low, high) = measure::bounds(whole).unwrap();
    assert!((low.x + high.x).abs() < 1e-4);
}
