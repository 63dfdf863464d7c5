//! The saved graphs of chapter 6: what their surfaces are, and that they leave neither their curves nor their
//! neighbours.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

#[path = "graphs/fairness.rs"]
mod fairness;
mod graphs;

use fairness::{crease, crossings, leaving, off, off_rails};
use glam::DVec3;
use graphs::{Saved, extent};
use maquette_geometry::border::Border;
use maquette_geometry::curve::{ArcLength, Curve, closest};
use maquette_geometry::mesh::{Mesh, MeshDistance, check, measure};
use maquette_geometry::surface::ripple;
use maquette_graph::{Evaluation, Evaluator, EventLog, Literal};
use maquette_nodes::wire;

/// Everything that must hold for any of these surfaces: one sound sheet with so many borders, that does not cross
/// itself, bends by less than `fold` degrees from face to face, and faces the `front` as a whole.
fn assert_fair(name: &str, mesh: &Mesh, borders: usize, fold: f64, front: DVec3) {
    let found = check(mesh);
    assert!(found.is_sound() && found.shells == 1, "{name}: {found}");
    assert_eq!(found.boundary_loops, borders, "{name}: {found}");
    assert!(found.largest_fold_degrees < fold, "{name}: folds by {} degrees", found.largest_fold_degrees);
    assert_eq!(crossings(mesh), 0, "{name} crosses itself");
    assert!(mesh.normals().is_some() && mesh.uvs().is_some(), "{name}");
    let facing: DVec3 =
        (0..mesh.polygon_count()).map(|p| measure::polygon_normal(mesh, p) * measure::polygon_area(mesh, p)).sum();
    assert!(facing.dot(front) > 0.5 * facing.length(), "{name} faces {facing}");
}

/// Rails and the first and last profile are where they were drawn: beyond the gaps that were bridged, to round-off.
fn assert_as_drawn(saved: &Saved, evaluation: &Evaluation, rails: &[Curve], profiles: &[Curve], most: f64) {
    let made = saved.sections(evaluation, "sections", "sections");
    let size = made.diagonal();
    let gap = saved.figure(evaluation, "sections", "largest-gap");
    assert!(gap < most, "{gap} m bridged");
    let off_rails = off_rails(made, rails);
    // Pinned at profiles between the ends, what closes the gaps swings over by some percent.
    let swing = if profiles.len() > 2 { 1.1 } else { 1.0 };
    assert!(off_rails <= swing * gap + 1e-12 * size, "{off_rails} m off the rails, {gap} m bridged");
    let ends = [(&profiles[0], 0), (&profiles[profiles.len() - 1], made.len() - 1)];
    for (profile, row) in ends {
        assert!(off(made.section(row), profile) < 1e-12, "{}: {}", profile.name(), off(made.section(row), profile));
    }
}

#[test]
fn the_mouth_passes_five_profiles_at_once() {
    let saved = Saved::load("mouth");
    let mut targets = saved.results();
    targets.extend(["surface", "sections", "wanted rails", "wanted profiles", "skin alone", "lips alone"]);
    let evaluation = saved.evaluate(&mut Evaluator::default(), &targets);
    let whole = saved.mesh(&evaluation, "surface", "mesh");
    // Its corners are narrow folds.
    assert_fair("mouth", whole, 2, 65.0, DVec3::Z);
    let rails = saved.curves(&evaluation, "wanted rails", "curves");
    let profiles = saved.curves(&evaluation, "wanted profiles", "curves");
    let names: Vec<&str> = profiles.iter().map(Curve::name).collect();
    assert_eq!((rails.len(), names), (8, vec!["skin", "vermilion", "crest", "parting", "inside"]));
    assert_as_drawn(&saved, &evaluation, rails, profiles, 4e-5);
    // Each profile between them is a section.
    let made = saved.sections(&evaluation, "sections", "sections");
    for profile in &profiles[1..4] {
        let on = made.iter().map(|row| off(row, profile)).fold(f64::MAX, f64::min);
        assert!(on < 4e-5, "{}: {on}", profile.name());
    }
    // Skin to lips, lips to parting, parting to the inside: three bends, and the hollows of the skin.
    assert!(ripple(made).sign_changes <= 6, "{:?}", ripple(made));
    let size = extent(whole);
    assert!(size.distance(DVec3::new(0.074, 0.045, 0.0205)) < 1e-3, "{size}");
    let (low, high) = measure::bounds(whole).unwrap();
    assert!((low.x + high.x).abs() < 1e-5, "left and right are alike: {low} {high}");
    // Lips and skin are the whole, cut in two.
    let area = |node| measure::area(saved.mesh(&evaluation, node, "mesh"));
    let parts = area("skin alone") + area("lips alone");
    assert!((parts / measure::area(whole) - 1.0).abs() < 1e-3, "{parts}");
}

/// Where a generator leaves a border: angle out of the plane in which the border's surface would go on, degrees.
fn out_of_neighbour(border: &Border, start: DVec3, leaves: DVec3) -> f64 {
    let arc = ArcLength::of(border.curve());
    let (segment, share) = arc.locate(closest(border.curve(), start).arc_length);
    let count = border.directions().len();
    let [one, two] = [segment % count, (segment + 1) % count].map(|k| border.directions()[k].normalize());
    let reach = 0.0025 * arc.length();
    let at = closest(border.curve(), start).arc_length;
    let along =
        arc.point_at((at + reach).rem_euclid(arc.length())) - arc.point_at((at - reach).rem_euclid(arc.length()));
    let normal = along.cross(one.lerp(two, share)).normalize();
    leaves.normalize().dot(normal).asin().abs().to_degrees()
}

#[test]
fn the_shoulder_caps_leave_the_bust_without_gap_or_crease() {
    let saved = Saved::load("shoulder-cap");
    let mut targets = saved.results();
    targets.extend(["bust", "left armhole", "cap", "cap surface", "even contour", "both caps"]);
    let evaluation = saved.evaluate(&mut Evaluator::default(), &targets);
    let cap = saved.mesh(&evaluation, "cap surface", "mesh");
    assert_fair("cap", cap, 1, 8.0, DVec3::X);
    let bust = saved.mesh(&evaluation, "bust", "mesh");
    let found = check(bust);
    assert!(found.is_sound() && found.boundary_loops == 2 && measure::signed_volume(bust) > 0.0, "{found}");

    let border = &evaluation.value::<wire::Borders>(saved.node("left armhole"), "borders").unwrap().0[0];
    let made = saved.sections(&evaluation, "cap", "sections");
    let (last, middle) = (made.len() - 1, made.nodes() / 2);
    assert!(made.is_pole(0) && made.is_pole(last));
    let contour = &saved.curves(&evaluation, "even contour", "curves")[0];
    let ridge: Vec<DVec3> = made.iter().map(|row| row[middle]).collect();
    let gap = saved.figure(&evaluation, "cap", "largest-gap");
    assert!(gap < 5e-6 && off(&ridge, contour) <= gap + 1e-12, "{gap} {}", off(&ridge, contour));
    // C0 and C1 along the whole joint, at every row on both sides.
    for row in 1..last {
        let section = made.section(row);
        let ends = [leaving(|k| section[k]), leaving(|k| section[section.len() - 1 - k])];
        for (start, leaves) in [section[0], section[section.len() - 1]].into_iter().zip(ends) {
            assert!(closest(border.curve(), start).distance < 1e-12, "row {row}");
            let angle = out_of_neighbour(border, start, leaves);
            assert!(angle < 0.1, "row {row}: {angle} degrees");
        }
    }
    assert!(ripple(made).sign_changes <= 4, "{:?}", ripple(made));
    // The caps widen the bust, and are mirror images.
    let both = saved.mesh(&evaluation, "both caps", "mesh");
    let (low, high) = measure::bounds(both).unwrap();
    assert!((low.x + high.x).abs() < 1e-12 && (high.x - 0.181).abs() < 2e-3, "{low} {high}");
    assert!(high.x > measure::bounds(bust).unwrap().1.x + 0.02);
}

#[test]
fn the_eye_socket_closes_around_the_eyeball_and_stays_outside_it() {
    let saved = Saved::load("eye-socket");
    let mut targets = saved.results();
    targets.extend(["surface", "sections", "sorted", "ball surface"]);
    let evaluation = saved.evaluate(&mut Evaluator::default(), &targets);
    let socket = saved.mesh(&evaluation, "surface", "mesh");
    assert_fair("eye socket", socket, 2, 26.0, DVec3::Z);
    let rails = saved.curves(&evaluation, "sorted", "rails");
    let closed = saved.curves(&evaluation, "sorted", "closed");
    assert_eq!(rails.len(), 8);
    assert_as_drawn(&saved, &evaluation, rails, closed, 4e-6);
    let made = saved.sections(&evaluation, "sections", "sections");
    assert!(ripple(made).sign_changes <= 4, "{:?}", ripple(made));
    // The eyeball is a sphere of 12 mm about the origin; the lids are 2 mm from it at most, at their edge 0.4 mm.
    let nearest = places_on(socket).map(DVec3::length).fold(f64::MAX, f64::min);
    assert!(nearest > 0.0121, "{nearest} m from the middle of the eyeball");
    let edge = made.section(made.len() - 1).iter().map(|p| (p.length() - 0.0124).abs()).fold(0.0, f64::max);
    assert!(edge < 1e-5, "the edge of the lids is {edge} m off the sphere it was drawn on");
    let eyeball = saved.mesh(&evaluation, "ball surface", "mesh");
    let found = check(eyeball);
    assert!(found.is_sound() && found.closed && measure::signed_volume(eyeball) > 0.0, "{found}");
}

/// Middles of the faces, and the vertices.
fn places_on(mesh: &Mesh) -> impl Iterator<Item = DVec3> + '_ {
    let middle = |polygon: usize| {
        let corners = mesh.polygon(polygon);
        corners.iter().map(|v| mesh.positions()[*v as usize]).sum::<DVec3>() / corners.len() as f64
    };
    (0..mesh.polygon_count()).map(middle).chain(mesh.positions().iter().copied())
}

#[test]
fn the_eye_looks_aside_without_its_socket_being_made_again() {
    let mut saved = Saved::load("eye-socket");
    let mut evaluator = Evaluator::default();
    let mut ran = |saved: &Saved| {
        let log = EventLog::default();
        let request = Saved::request(&saved.graph.results()).events(&log);
        assert!(evaluator.evaluate(&saved.catalogue, &saved.graph, &request).is_complete());
        let mut names = log.take_ran();
        names.sort();
        names
    };
    assert_eq!(ran(&saved).len(), saved.graph.nodes().len());
    saved.graph.set_parameter("gaze", Literal::Vector([5.0, 20.0, 0.0])).unwrap();
    assert_eq!(ran(&saved), ["iris", "iris in place", "pupil", "pupil in place"]);
}

#[test]
fn the_bracer_is_a_thin_sheet_outside_the_arm() {
    let saved = Saved::load("forearm-sheet");
    let mut targets = saved.results();
    targets.extend(["surface", "sections", "skin", "rails on the sleeve", "ends on the sleeve"]);
    let evaluation = saved.evaluate(&mut Evaluator::default(), &targets);
    let bracer = saved.mesh(&evaluation, "surface", "mesh");
    assert_fair("bracer", bracer, 1, 4.0, DVec3::Z);
    let rails = saved.curves(&evaluation, "rails on the sleeve", "curves");
    let ends = saved.curves(&evaluation, "ends on the sleeve", "curves");
    assert_eq!((rails.len(), ends.len()), (5, 2));
    assert_as_drawn(&saved, &evaluation, rails, ends, 4e-6);
    let made = saved.sections(&evaluation, "sections", "sections");
    assert!(!made.is_closed() && ripple(made).sign_changes <= 3, "{:?}", ripple(made));

    let skin = saved.mesh(&evaluation, "skin", "mesh");
    let found = check(skin);
    assert!(found.is_sound() && found.closed && measure::signed_volume(skin) > 0.0, "{found}");
    let arm = MeshDistance::new(skin).unwrap();
    let mut clearance = (f64::MAX, 0.0_f64);
    for p in places_on(bracer) {
        let nearest = arm.nearest(p);
        let above = (p - nearest.point).dot(measure::polygon_normal(skin, nearest.polygon));
        assert!(above > 0.0, "{p} is inside the arm");
        clearance = (clearance.0.min(nearest.distance), clearance.1.max(nearest.distance));
    }
    assert!(clearance.0 > 1.5e-3 && clearance.1 < 6.5e-3, "{clearance:?} m from the skin");
}

#[test]
fn the_knee_guard_has_no_crease_between_its_four_patches() {
    let mut saved = Saved::load("knee-guard");
    let mut evaluator = Evaluator::default();
    let mut targets = saved.results();
    targets.extend(["surface", "sections", "sorted"]);
    let evaluation = saved.evaluate(&mut evaluator, &targets);
    let guard = saved.mesh(&evaluation, "surface", "mesh");
    assert_fair("knee guard", guard, 1, 6.0, DVec3::Z);
    let rails = saved.curves(&evaluation, "sorted", "rails");
    let rim = saved.curves(&evaluation, "sorted", "closed");
    let made = saved.sections(&evaluation, "sections", "sections");
    assert_eq!((made.rails(), made.nodes(), rails.len()), (&[0, 33, 66, 97][..], 128, 4));
    let gap = saved.figure(&evaluation, "sections", "largest-gap");
    assert!(gap < 2e-6 && off_rails(made, rails) <= gap + 1e-12 * made.diagonal(), "{gap}");
    assert!(off(made.section(0), &rim[0]) < 1e-12 && made.is_pole(made.len() - 1));
    assert!(ripple(made).sign_changes <= 3, "{:?}", ripple(made));

    // The rim is a polyline, of which the corners would count; so finely drawn they do not.
    saved.graph.set(saved.node("even rim"), "count", Literal::Integer(65_536)).unwrap();
    saved.graph.set(saved.node("leg"), "nodes", Literal::Integer(65_536)).unwrap();
    saved.graph.set_parameter("around", Literal::Integer(2048)).unwrap();
    saved.graph.set_parameter("rings", Literal::Integer(17)).unwrap();
    let mut creases = |weights: &str| {
        saved.graph.set(saved.node("sections"), "weights", Literal::Choice(weights.into())).unwrap();
        let evaluation = saved.evaluate(&mut evaluator, &["sections"]);
        let made = saved.sections(&evaluation, "sections", "sections").clone();
        made.rails().iter().map(|column| crease(&made, *column)).fold(0.0, f64::max)
    };
    let (smooth, linear) = (creases("smooth"), creases("linear"));
    assert!(smooth < 0.01 && linear > 1.0, "{smooth} {linear} degrees");
}
