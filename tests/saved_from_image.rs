//! The saved graph that begins with a picture: what is traced is what was drawn, and its surface is sound.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod graphs;

use graphs::Saved;
use maquette_geometry::curve::ArcLength;
use maquette_geometry::mesh::check;
use maquette_geometry::mesh::measure::bounds;
use maquette_graph::{Evaluator, Literal};
use maquette_nodes::wire;

/// What was drawn into the picture, before it became pixels of 0.3 mm: width, length, area and girth of the sole.
const DRAWN: [f64; 4] = [0.071_196, 0.241_586, 0.012_622_8, 0.553_151];

#[test]
fn the_sole_is_as_it_was_drawn_and_its_surface_is_sound() {
    let mut saved = Saved::load("from-image");
    let mut evaluator = Evaluator::default();
    let evaluation = saved.evaluate(&mut evaluator, &["sole", "outline", "skin"]);
    let outlines = &evaluation.value::<wire::Curves>(saved.node("outline"), "curves").unwrap().0;
    let [outline] = outlines.as_slice() else { panic!("{} outlines", outlines.len()) };
    assert!(outline.is_closed() && outline.points().iter().all(|p| p.y == 0.0));
    let (low, high) = outline.bounds();
    assert!((low + high).length() < 1e-12, "its middle is the origin: {low} {high}");
    let size = high - low;
    let area = outline.area_vector().length();
    // Half a pixel at the tolerance of half a pixel.
    assert!((size.x - DRAWN[0]).abs() < 3e-4 && (size.z - DRAWN[1]).abs() < 3e-4, "{size}");
    assert!((area - DRAWN[2]).abs() < 0.002 * DRAWN[2], "{area}");
    assert!((ArcLength::of(outline).length() - DRAWN[3]).abs() < 0.002 * DRAWN[3]);
    assert!(outline.points().len() < 120, "{} points of two thousand", outline.points().len());

    let skin = &evaluation.value::<wire::Mesh>(saved.node("skin"), "mesh").unwrap().0;
    let found = check(skin);
    assert!(found.is_sound() && found.closed && found.shells == 1, "{found}");
    let (low, high) = bounds(skin).unwrap();
    // The widest section is the outline itself, within what the fit allows: 2.5 % of its diagonal at most.
    assert!((high.x - low.x - DRAWN[0]).abs() < 0.005 && (high.z - low.z - DRAWN[1]).abs() < 0.008, "{low} {high}");
    assert!(low.y.abs() < 1e-4 && (high.y - 0.026).abs() < 1e-4, "{low} {high}");

    // A finer tolerance keeps more points, and only what depends on the outline runs again.
    let node = saved.node("outline");
    saved.graph.set(node, "tolerance", Literal::Number(0.00003)).unwrap();
    let finer = saved.evaluate(&mut evaluator, &["outline"]);
    let points = finer.value::<wire::Curves>(node, "curves").unwrap().0[0].points().len();
    assert!(points > outline.points().len(), "{points}");
}
