//! Every saved graph: what an artist would look for in its surfaces, asserted.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod graphs;

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};
use graphs::Saved;
use maquette_geometry::curve::{Curve, closest};
use maquette_geometry::mesh::{Mesh, MeshDistance, check, measure};
use maquette_geometry::sections::Sections;
use maquette_geometry::surface::ripple;
use maquette_graph::{Evaluator, WireType};
use maquette_nodes::wire;

/// Largest distance of a curve's points from a mesh, metres.
fn farthest(mesh: &Mesh, curve: &Curve) -> f64 {
    let distance = MeshDistance::new(mesh).unwrap();
    curve.points().iter().map(|p| distance.nearest(*p).distance).fold(0.0, f64::max)
}

/// Share of the faces that look away from the vertical axis through their height's middle.
fn outward_share(mesh: &Mesh) -> f64 {
    let middle = |y: f64| {
        let near: Vec<_> = mesh.positions().iter().filter(|p| (p.y - y).abs() < 0.02).collect();
        near.iter().copied().sum::<DVec3>() / near.len() as f64
    };
    let walls = (0..mesh.polygon_count()).filter(|p| measure::polygon_normal(mesh, *p).y.abs() < 0.7);
    let outward: Vec<bool> = walls
        .map(|polygon| {
            let corner = mesh.positions()[mesh.polygon(polygon)[0] as usize];
            measure::polygon_normal(mesh, polygon).dot(corner - middle(corner.y)) > 0.0
        })
        .collect();
    outward.iter().filter(|o| **o).count() as f64 / outward.len() as f64
}

/// Everything that must hold for any surface we would show. `fold` is the largest angle allowed between neighbouring
/// faces, degrees: what the finest bend of the shape needs at its resolution.
fn assert_fair(name: &str, mesh: &Mesh, closed: bool, fold: f64) {
    let found = check(mesh);
    assert!(found.is_sound(), "{name}: {found}");
    assert_eq!((found.closed, found.shells), (closed, 1), "{name}: {found}");
    // A short, wide tube counts as a sheet, of which volume can't tell the outside; its faces can.
    assert!(outward_share(mesh) > 0.995, "{name}: only {} of the faces look outwards", outward_share(mesh));
    if !closed {
        assert_eq!(found.boundary_loops, 2, "{name}: {found}");
    }
    assert!(mesh.normals().is_some() && mesh.uvs().is_some(), "{name} has normals and UVs");
    assert!(found.largest_fold_degrees < fold, "{name}: folds by {:.1} degrees", found.largest_fold_degrees);
}

/// How far the outline of the surface, seen along `depth`, stands out from the silhouette between two contours, metres.
fn overshoot(mesh: &Mesh, contours: [&Curve; 2], flat: impl Fn(DVec3) -> DVec2) -> f64 {
    let outline: Vec<DVec2> =
        contours[0].points().iter().chain(contours[1].points().iter().rev()).map(|p| flat(*p)).collect();
    let drawn: Vec<Curve> = contours.iter().map(|c| c.map(|p| flat(p).extend(0.0)).unwrap()).collect();
    let inside = |p: DVec2| {
        let crossings = (0..outline.len()).filter(|&i| {
            let (a, b) = (outline[i], outline[(i + 1) % outline.len()]);
            (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)
        });
        crossings.count() % 2 == 1
    };
    let lowest = drawn.iter().map(|c| c.points()[0].y).fold(f64::MIN, f64::max);
    let highest = drawn.iter().map(|c| c.points()[c.points().len() - 1].y).fold(f64::MAX, f64::min);
    mesh.positions()
        .iter()
        .map(|p| flat(*p))
        // At the tilted ends the outline is not given by the contours.
        .filter(|p| p.y > lowest && p.y < highest && !inside(*p))
        .map(|p| drawn.iter().map(|c| closest(c, p.extend(0.0)).distance).fold(f64::MAX, f64::min))
        .fold(0.0, f64::max)
}

fn front(p: DVec3) -> DVec2 {
    p.truncate()
}

fn side(p: DVec3) -> DVec2 {
    DVec2::new(p.z, p.y)
}

#[test]
fn every_saved_graph_is_tested_here() {
    let saved: BTreeSet<String> = std::fs::read_dir("graphs")
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "ron"))
        .map(|path| path.file_stem().unwrap().to_string_lossy().into_owned())
        .collect();
    assert_eq!(
        saved,
        [
            "bar-bent",
            "bar-twisted",
            "blend",
            "body-posed",
            "chest",
            "eye-socket",
            "fist",
            "forearm",
            "forearm-sheet",
            "from-image",
            "from-template",
            "hand",
            "head",
            "hip",
            "human",
            "knee-guard",
            "leg",
            "leg-deformed",
            "leg-free-form",
            "legs",
            "mouth",
            "neck",
            "open-strokes",
            "patch",
            "sea-star",
            "shoulder",
            "shoulder-cap",
            "teapot",
            "torso",
            "vest",
            "warrior",
        ]
        .map(str::to_owned)
        .into(),
        "add a test for a new graph"
    );
}

#[test]
fn no_saved_graph_has_a_node_without_use() {
    for name in [
        "vest",
        "warrior",
        "head",
        "neck",
        "leg",
        "legs",
        "forearm",
        "from-image",
        "from-template",
        "hip",
        "open-strokes",
        "leg-deformed",
        "leg-free-form",
        "sea-star",
        "torso",
        "mouth",
        "shoulder-cap",
        "eye-socket",
        "forearm-sheet",
        "knee-guard",
        "blend",
        "chest",
        "patch",
        "shoulder",
        "bar-bent",
        "bar-twisted",
        "hand",
        "body-posed",
    ] {
        let saved = Saved::load(name);
        let used = saved.graph.upstream(&saved.graph.results());
        assert_eq!(used.len(), saved.graph.nodes().len(), "{name}");
        let result = saved.graph.node(saved.graph.results()[0]).unwrap();
        assert_eq!(result.kind().unwrap().outputs()[0].wire, WireType::of::<wire::MeshResult>(), "{name}");
    }
}

#[test]
fn the_vest_passes_through_its_five_rails_its_hem_its_neckline_and_its_chest() {
    let mut saved = Saved::load("vest");
    let mut evaluator = Evaluator::default();
    let evaluation = saved.evaluate(&mut evaluator, &["surface", "shaped", "sorted", "even chest", "vest"]);
    let vest = saved.mesh(&evaluation, "surface", "mesh").clone();
    assert_eq!((vest.positions().len(), vest.polygon_count()), (3840, 3760));
    assert_fair("vest", &vest, false, 25.0);
    let (low, high) = measure::bounds(&vest).unwrap();
    assert!(low.distance(DVec3::new(-0.1678, 0.93, -0.0862)) < 1e-4, "{low}");
    assert!(high.distance(DVec3::new(0.1678, 1.4498, 0.1511)) < 5e-4, "{high}");
    // Left and right are mirror images.
    assert!((low.x + high.x).abs() < 1e-4, "{} {}", low.x, high.x);

    let rails = saved.curves(&evaluation, "sorted", "rails").to_vec();
    let closed = saved.curves(&evaluation, "sorted", "closed").to_vec();
    let names: Vec<_> = rails.iter().map(Curve::name).collect();
    assert_eq!(names, ["left back mirrored", "left side mirrored", "front", "left side", "left back"]);
    // The mesh's first and last ring lie on the drawn boundaries; between them edges 12 mm long cut the bends.
    let ring = |first: usize| &vest.positions()[first..first + 80];
    for (boundary, ring) in closed.iter().zip([ring(0), ring(3840 - 80)]) {
        let off = ring.iter().map(|p| closest(boundary, *p).distance).fold(0.0, f64::max);
        assert!(off < 1e-12, "{}: {off}", boundary.name());
        assert!(farthest(&vest, boundary) < 4e-4, "{}: {}", boundary.name(), farthest(&vest, boundary));
    }
    let chest = &saved.curves(&evaluation, "even chest", "curves")[0];
    assert!(farthest(&vest, chest) < 8e-4, "chest: {}", farthest(&vest, chest));
    let chest_section = saved.sections(&evaluation, "shaped", "sections").section(28);
    let off = chest_section.iter().map(|p| closest(chest, *p).distance).fold(0.0, f64::max);
    assert!(off < 1e-12, "the section is on the contour: {off}");

    // Without the chest the surface follows all five rails.
    let (body, surface) = (saved.node("body"), saved.node("surface"));
    saved.graph.connect(&saved.catalogue, body, "sections", surface, "sections").unwrap();
    let evaluation = saved.evaluate(&mut evaluator, &["surface", "body"]);
    let plain = saved.mesh(&evaluation, "surface", "mesh");
    assert_fair("vest without its chest", plain, false, 25.0);
    for rail in &rails {
        // They were drawn to within 0.2 mm of hem and neckline, and are bent to meet them.
        assert!(farthest(plain, rail) < 4e-4, "{}: {}", rail.name(), farthest(plain, rail));
    }
    let stack = saved.sections(&evaluation, "body", "sections");
    assert_eq!(stack.rails().len(), 5);
    assert!(ripple(stack).sign_changes <= 4, "{:?}", ripple(stack));
}

/// Largest distance, seen in one view, between a contour as it was drawn and the column of the surface that follows it:
/// from the drawn points to the column, and from the column's points to the drawing.
fn off_drawing(sections: &Sections, rail: usize, drawn: &Curve, flat: impl Fn(DVec3) -> DVec2) -> f64 {
    let flat = |p: DVec3| flat(p).extend(0.0);
    let node = sections.rails()[rail];
    let column = Curve::new("column", sections.iter().map(|s| flat(s[node])).collect(), false).unwrap();
    let drawn = drawn.map(flat).unwrap();
    let there = drawn.points().iter().map(|p| closest(&column, *p).distance).fold(0.0, f64::max);
    let back = column.points().iter().map(|p| closest(&drawn, *p).distance).fold(0.0, f64::max);
    there.max(back)
}

/// Figures of a shape from two views, and what is allowed.
struct TwoViews {
    name: &'static str,
    closed: bool,
    /// Metres from any contour as drawn to the surface, seen in its view.
    drawn: f64,
    /// Metres by which the outline may stand out from the silhouette.
    bulge: f64,
    /// Degrees between neighbouring faces, caps apart, and the same outside the mouth.
    folds: [f64; 2],
}

impl TwoViews {
    fn assert(&self) -> (Mesh, Sections) {
        let name = self.name;
        let mut saved = Saved::load(name);
        let mut targets = saved.results();
        targets.extend(["sections", "surface", "sorted", "front view", "side view"]);
        let mut evaluator = Evaluator::default();
        let evaluation = saved.evaluate(&mut evaluator, &targets);
        let whole = saved.mesh(&evaluation, "surface", "mesh").clone();
        let sections = saved.sections(&evaluation, "sections", "sections").clone();
        assert_fair(name, &whole, self.closed, 180.0);
        let rails = saved.curves(&evaluation, "sorted", "rails");
        let names: Vec<_> = rails.iter().map(Curve::name).collect();
        assert_eq!(names, ["back", "right", "front", "left"], "{name}: counter-clockwise from the seam at the back");

        let beyond =
            [overshoot(&whole, [&rails[3], &rails[1]], front), overshoot(&whole, [&rails[2], &rails[0]], side)];
        assert!(beyond.iter().all(|b| *b < self.bulge), "{name}: the outline stands out by {beyond:?} m");
        for (view, rail_of, flat) in [
            ("front view", [("left", 3), ("right", 1)], front as fn(DVec3) -> DVec2),
            ("side view", [("front", 2), ("back", 0)], side),
        ] {
            for (contour, rail) in rail_of {
                let drawn = saved.curves(&evaluation, view, "curves").iter().find(|c| c.name() == contour).unwrap();
                let off = off_drawing(&sections, rail, drawn, flat);
                assert!(off < self.drawn, "{name}, contour {contour}: {off} m from the drawing");
            }
        }

        // Without caps, whose edges are sharp on purpose, the surface is smooth.
        let surface = saved.node("surface");
        for cap in ["cap-start", "cap-end"] {
            saved.graph.reset(surface, cap).unwrap();
        }
        let evaluation = saved.evaluate(&mut evaluator, &["surface"]);
        let bare = saved.mesh(&evaluation, "surface", "mesh");
        let (anywhere, outside_mouth) = folds(bare, |p| (1.47..1.51).contains(&p.y) && p.z > 0.10);
        assert!(anywhere < self.folds[0], "{name}: folds by {anywhere} degrees");
        assert!(outside_mouth < self.folds[1], "{name}: folds by {outside_mouth} degrees outside the mouth");
        (whole, sections)
    }
}

/// Largest angle between neighbouring faces, degrees: anywhere, and where not `spared`.
fn folds(mesh: &Mesh, spared: impl Fn(DVec3) -> bool) -> (f64, f64) {
    let mut edges = std::collections::BTreeMap::new();
    let (mut anywhere, mut elsewhere) = (0.0_f64, 0.0_f64);
    for polygon in 0..mesh.polygon_count() {
        let corners = mesh.polygon(polygon);
        for (k, a) in corners.iter().enumerate() {
            let b = corners[(k + 1) % corners.len()];
            let Some(other) = edges.insert((*a.min(&b), *a.max(&b)), polygon) else { continue };
            let [one, two] = [polygon, other].map(|p| measure::polygon_normal(mesh, p));
            let angle = one.angle_between(two).to_degrees();
            anywhere = anywhere.max(angle);
            if !spared(mesh.positions()[*a as usize]) {
                elsewhere = elsewhere.max(angle);
            }
        }
    }
    (anywhere, elsewhere)
}

#[test]
fn the_head_is_closed_smooth_and_within_its_silhouettes() {
    let head = TwoViews { name: "head", closed: true, drawn: 5e-3, bulge: 1e-3, folds: [75.0, 25.0] };
    let (head, sections) = head.assert();
    assert_eq!(sections.len(), 96);
    assert!(sections.is_pole(95), "the crown is one point");
    let (low, high) = measure::bounds(&head).unwrap();
    assert!((high.y - 1.658252).abs() < 2e-4 && (low.y - 1.438459).abs() < 1e-3, "{low} {high}");
    assert!((low.x + high.x).abs() < 1e-3, "left and right are alike: {low} {high}");
}

#[test]
fn the_neck_is_open_smooth_and_within_its_silhouettes() {
    let neck = TwoViews { name: "neck", closed: false, drawn: 1e-3, bulge: 1.5e-3, folds: [12.0, 12.0] };
    let (neck, sections) = neck.assert();
    assert_eq!((sections.len(), neck.polygon_count()), (24, 23 * 2 * 64));
    assert!(ripple(&sections).sign_changes <= 3, "{:?}", ripple(&sections));
}

#[test]
fn the_leg_is_closed_smooth_and_within_its_silhouettes() {
    let leg = TwoViews { name: "leg", closed: true, drawn: 2e-3, bulge: 2e-3, folds: [15.0, 15.0] };
    let (leg, sections) = leg.assert();
    let (low, high) = measure::bounds(&leg).unwrap();
    assert!(low.y > 0.1 && high.y < 0.8 && high.y - low.y > 0.68, "{low} {high}");
    assert!(ripple(&sections).sign_changes <= 8, "{:?}", ripple(&sections));
}

#[test]
fn the_legs_are_the_leg_twice_as_mirror_images() {
    let saved = Saved::load("legs");
    let mut evaluator = Evaluator::default();
    let evaluation = saved.evaluate(&mut evaluator, &["left", "right", "contours"]);
    let (left, right) = (saved.mesh(&evaluation, "left", "mesh"), saved.mesh(&evaluation, "right", "mesh"));
    for (name, mesh) in [("left", left), ("right", right)] {
        assert_fair(name, mesh, true, 180.0);
    }
    let ((low, high), (mirrored_low, mirrored_high)) =
        (measure::bounds(left).unwrap(), measure::bounds(right).unwrap());
    let mirror = DVec3::new(-1.0, 1.0, 1.0);
    assert!(low.x > 0.0 && mirrored_high.x < 0.0, "{low} {mirrored_high}");
    // The rings of the two begin at the same seam and run the same way around, so that points differ a little.
    assert!((mirror * mirrored_low).distance(DVec3::new(high.x, low.y, low.z)) < 5e-3, "{mirrored_low} {low} {high}");
    assert!((mirror * mirrored_high).distance(DVec3::new(low.x, high.y, high.z)) < 5e-3);

    // What is done curve by curve is what is done to all at once: the graph of one leg does that.
    let one = Saved::load("leg");
    let evaluation_of_one = one.evaluate(&mut evaluator, &["even contours", "surface"]);
    let all = one.curves(&evaluation_of_one, "even contours", "curves");
    assert_eq!(saved.curves(&evaluation, "contours", "contours"), all);
    assert_eq!(one.mesh(&evaluation_of_one, "surface", "mesh"), left);
}
