//! The saved graphs of the primitive deformer: how far outlines are from their sketches, and what the surfaces are.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod graphs;

use glam::DVec3;
use graphs::{Saved, extent};
use maquette_geometry::curve::closest;
use maquette_geometry::mesh::{Mesh, check, measure};
use maquette_graph::{Evaluation, Evaluator};
use maquette_nodes::wire;

/// The mesh of a node, which must be one sound, closed shell that faces outwards.
fn sound<'a>(saved: &Saved, evaluation: &'a Evaluation, node: &str) -> &'a Mesh {
    let mesh = &evaluation.value::<wire::Mesh>(saved.node(node), "mesh").unwrap().0;
    let found = check(mesh);
    assert!(found.is_sound() && found.closed && found.shells == 1, "{node}: {found}");
    assert!(measure::signed_volume(mesh) > 0.0);
    mesh
}

/// A part from a cylinder, in two views at once: its surface's extent, and the largest distance of its outline from the
/// strokes in percent of their diagonal.
fn assert_limb(name: &str, result: &str, wanted: DVec3, percent: f64) {
    let saved = Saved::load(name);
    let evaluation = saved.evaluate(
        &mut Evaluator::default(),
        &[result, "outlines", "stroke lines", "fit", "deformed", "front strokes", "side strokes"],
    );
    let mesh = sound(&saved, &evaluation, "fit");
    assert!(extent(mesh).distance(wanted) < 1e-3, "{name}: {}", extent(mesh));
    let off = saved.figure(&evaluation, "fit", "largest-percent");
    assert!(off < percent && saved.figure(&evaluation, "fit", "mean-percent") < 0.002, "{name}: {off} percent");
    assert!(saved.figure(&evaluation, "deformed", "largest-overshoot") < 1e-12);
    // Sections touch the strokes, and the deformation is a true one.
    assert!(saved.figure(&evaluation, "deformed", "largest-move") > 0.03);
    let sections = &evaluation.value::<wire::Sections>(saved.node("deformed"), "sections").unwrap().0;
    assert_eq!(sections.rails(), [0, 16, 32, 48]);
    for (view, columns) in [("front", [0, 32]), ("side", [16, 48])] {
        let strokes = &evaluation.value::<wire::Curves>(saved.node(&format!("{view} strokes")), "curves").unwrap().0;
        let depth = strokes[0].start();
        let seen = |p: DVec3| if view == "front" { p.with_z(depth.z) } else { p.with_x(depth.x) };
        for section in sections.iter() {
            for column in columns {
                let near = strokes.iter().map(|stroke| closest(stroke, seen(section[column])).distance);
                assert!(near.fold(f64::MAX, f64::min) < 1e-12, "{name}, {view}");
            }
        }
    }
    // Both outlines come out.
    let outlines = &evaluation.value::<wire::Curves>(saved.node("fit"), "outlines").unwrap().0;
    let names: Vec<_> = outlines.iter().map(maquette_geometry::curve::Curve::name).collect();
    assert_eq!(names, ["front outline", "side outline"]);
}

#[test]
fn the_torso_is_a_cylinder_in_the_silhouettes_of_a_body() {
    assert_limb("torso", "torso", DVec3::new(0.3454, 0.4699, 0.2258), 0.05);
}

#[test]
fn the_leg_is_deformed_in_both_views_at_once() {
    assert_limb("leg-deformed", "leg", DVec3::new(0.2098, 0.684, 0.1845), 0.02);
}

#[test]
fn the_torso_has_sections_where_its_strokes_have_detail() {
    let saved = Saved::load("torso");
    let evaluation = saved.evaluate(&mut Evaluator::default(), &["deformed", "front strokes"]);
    let count = saved.figure(&evaluation, "deformed", "sections");
    assert!((40.0..90.0).contains(&count), "{count} sections from 12");
    let strokes = &evaluation.value::<wire::Curves>(saved.node("front strokes"), "curves").unwrap().0;
    let (low, high) = strokes
        .iter()
        .map(maquette_geometry::curve::Curve::bounds)
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), (low, high)| (l.min(low), h.max(high)));
    let gap = saved.figure(&evaluation, "deformed", "largest-gap");
    // 0.015 % of the larger sketch, which the front's is.
    assert!(gap > 0.0 && gap <= 0.00015 * (high - low).length() * (1.0 + 1e-9), "{gap}");
}

#[test]
fn the_leg_is_deformed_again_to_free_form_curves() {
    let saved = Saved::load("leg-free-form");
    let names = ["leg", "outlines", "stroke lines", "muscle lines", "fit", "deformed", "shaped", "muscles"];
    let evaluation = saved.evaluate(&mut Evaluator::default(), &names);
    sound(&saved, &evaluation, "fit");
    let stack = |node: &str| &evaluation.value::<wire::Sections>(saved.node(node), "sections").unwrap().0;
    let (before, after) = (stack("deformed"), stack("shaped"));
    let mut passed = 0;
    let curves = &evaluation.value::<wire::Curves>(saved.node("muscles"), "curves").unwrap().0;
    for curve in curves {
        // Every point of the curve is on the surface, to what a mesh of it leaves; it was well off it.
        let mesh = &evaluation.value::<wire::Mesh>(saved.node("fit"), "mesh").unwrap().0;
        let surface = maquette_geometry::mesh::MeshDistance::new(mesh).unwrap();
        let off = curve.points().iter().map(|p| surface.nearest(*p).distance).fold(0.0, f64::max);
        assert!(off < 1e-3, "{}: {off}", curve.name());
        passed += 1;
    }
    assert_eq!(passed, 2);
    let bulge = saved.figure(&evaluation, "shaped", "largest-move");
    assert!((0.01..0.03).contains(&bulge), "{bulge}");
    // The rails, which are the silhouettes, are where they were, except where the curves come close to them.
    let still = |rail: usize| (0..before.len()).all(|k| before.section(k)[rail] == after.section(k)[rail]);
    assert_eq!(after.rails(), before.rails());
    assert!(after.rails().iter().filter(|rail| still(**rail)).count() >= 2);
    // The calf stands out of the outline that the strokes gave, by the centimetre that was drawn.
    let off = saved.figure(&evaluation, "fit", "largest");
    assert!((0.005..0.015).contains(&off), "{off}");
}

#[test]
fn the_sea_star_is_an_ellipsoid_in_one_outline() {
    let saved = Saved::load("sea-star");
    let evaluation =
        saved.evaluate(&mut Evaluator::default(), &["sea star", "stroke", "fit", "deformed", "calm outline"]);
    let mesh = sound(&saved, &evaluation, "fit");
    let size = extent(mesh);
    // As thick as the ellipsoid, and six times as wide.
    assert!((size.z - 0.052).abs() < 1e-3 && size.x > 0.27 && size.y > 0.26, "{size}");
    let off = saved.figure(&evaluation, "fit", "largest-percent");
    assert!(off < 0.05, "{off} percent");
    let sections = &evaluation.value::<wire::Sections>(saved.node("deformed"), "sections").unwrap().0;
    assert!(sections.is_pole(0) && sections.is_pole(24));
    let drawn = &evaluation.value::<wire::Curves>(saved.node("calm outline"), "curves").unwrap().0[0];
    assert!(sections.section(12).iter().all(|p| closest(drawn, p.with_z(0.0)).distance < 1e-12));
}
