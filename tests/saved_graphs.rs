//! Every saved graph: what an artist would look for in its surfaces, asserted.

mod graphs;

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};
use graphs::Saved;
use maquette_geometry::curve::{Curve, closest};
use maquette_geometry::mesh::{Mesh, MeshDistance, check};
use maquette_geometry::sections::Sections;
use maquette_geometry::surface::ripple;
use maquette_graph::{Evaluation, Evaluator, WireType};
use maquette_nodes::wire;

fn mesh<'a>(saved: &Saved, evaluation: &'a Evaluation, node: &str) -> &'a Mesh {
    &evaluation.value::<wire::Mesh>(saved.node(node), "mesh").unwrap().0
}

fn sections<'a>(saved: &Saved, evaluation: &'a Evaluation, node: &str) -> &'a Sections {
    &evaluation.value::<wire::Sections>(saved.node(node), "sections").unwrap().0
}

fn curves<'a>(saved: &Saved, evaluation: &'a Evaluation, node: &str, output: &str) -> &'a [Curve] {
    &evaluation.value::<wire::Curves>(saved.node(node), output).unwrap().0
}

fn bounds(mesh: &Mesh) -> (DVec3, DVec3) {
    let first = mesh.positions()[0];
    mesh.positions().iter().fold((first, first), |(low, high), p| (low.min(*p), high.max(*p)))
}

/// Largest distance of a curve's points from a mesh, metres.
fn farthest(mesh: &Mesh, curve: &Curve) -> f64 {
    let distance = MeshDistance::new(mesh).unwrap();
    curve.points().iter().map(|p| distance.nearest(*p).distance).fold(0.0, f64::max)
}

/// Everything that must hold for any surface we would show. `fold` is the largest angle allowed between neighbouring
/// faces, degrees: what the finest bend of the shape needs at its resolution.
fn assert_fair(name: &str, mesh: &Mesh, closed: bool, fold: f64) {
    let found = check(mesh);
    assert!(found.is_sound(), "{name}: {found}");
    assert_eq!((found.closed, found.shells, found.normals_outward), (closed, 1, Some(true)), "{name}: {found}");
    if !closed {
        assert_eq!(found.boundary_loops, 2, "{name}: {found}");
    }
    assert!(mesh.normals().is_some() && mesh.uvs().is_some(), "{name} has normals and UVs");
    if fold > 0.0 {
        assert!(found.largest_fold_degrees < fold, "{name}: folds by {:.1} degrees", found.largest_fold_degrees);
    }
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

/// Largest distance between a drawn contour and the column of the surface that follows it, seen in the contour's view.
fn off_silhouette(sections: &Sections, rail: usize, contour: &Curve, flat: impl Fn(DVec3) -> DVec2) -> f64 {
    let contour = contour.map(|p| flat(p).extend(0.0)).unwrap();
    let node = sections.rails()[rail];
    sections.iter().map(|s| closest(&contour, flat(s[node]).extend(0.0)).distance).fold(0.0, f64::max)
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
    assert_eq!(saved, ["head", "leg", "neck", "vest"].map(str::to_owned).into(), "add a test for a new graph");
}

#[test]
fn no_saved_graph_has_a_node_without_use() {
    for name in ["vest", "head", "neck", "leg"] {
        let saved = Saved::load(name);
        let used = saved.graph.upstream(&saved.graph.results());
        assert_eq!(used.len(), saved.graph.nodes().len(), "{name}");
        let result = saved.graph.node(saved.graph.results()[0]).unwrap();
        assert_eq!(result.kind().unwrap().outputs()[0].wire, WireType::of::<wire::MeshResult>(), "{name}");
    }
}
