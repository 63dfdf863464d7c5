//! Parts of a mesh are selected by hand, and handles are moved and turned in the views.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod support;

use egui::{Key, Modifiers, PointerButton, Pos2, vec2};
use maquette_editor::Direction;
use maquette_editor::command::ViewCommand;
use maquette_graph::Literal;
use support::*;

fn select(window: &mut Window, node: &str) {
    window.state_mut().ask(ViewCommand::Find(node.to_owned()));
    settle(window);
}

/// A figure of the report of a node.
fn figure(window: &Window, node: &str, name: &str) -> f64 {
    let report = window.state().results().report(find(window, node)).unwrap();
    report.figures.iter().find(|figure| figure.name == name).unwrap_or_else(|| panic!("{report:?}")).value
}

/// A ball of radius 0.5 m around (0, 1, 0).
fn ball() -> (tempfile::TempDir, Window) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("ball.ron");
    let text = r#"(version: 1, nodes: {
        "ball": (kind: "primitive-shape", inputs: {"shape": Choice("sphere"), "centre": Vector(0, 1, 0), "radius": 0.5}),
        "mesh": (kind: "surface-from-cross-sections", inputs: {"sections": Link("ball.sections")}),
    }, layout: {"ball": (0, 0), "mesh": (240, 0)})"#;
    std::fs::write(&path, text).unwrap();
    let mut window = opened(&path);
    select(&mut window, "mesh");
    (folder, window)
}

fn front(window: &Window, x: f64, y: f64, z: f64) -> Pos2 {
    seen(window, Direction::Front, "Front view", [x, y, z])
}

#[test]
fn a_loop_around_a_part_of_a_mesh_selects_it_by_what_was_drawn() {
    let (_folder, mut window) = ball();
    assert_eq!(failure(&window, "mesh"), None);
    press(&mut window, Modifiers::NONE, Key::O);
    let line: Vec<Pos2> = (0..=24)
        .map(|k| (f64::from(k) * 15.0).to_radians().sin_cos())
        .map(|(s, c)| front(&window, 0.2 * c, 1.3 + 0.1 * s, 0.0))
        .collect();
    drag(&mut window, &line);
    settle(&mut window);
    assert_eq!(names(&window), ["ball", "mesh", "loop", "selected"], "{}", message(&window));
    assert_eq!(link(&window, "selected", "mesh").as_deref(), Some("mesh.mesh"));
    assert_eq!(link(&window, "selected", "strokes").as_deref(), Some("loop.curves"));
    let selected = figure(&window, "selected", "selected");
    assert!(selected > 5.0, "{selected}");
    // Only what is seen: through all, there is more.
    let graph = window.state().document().graph();
    assert_eq!(graph.node(find(&window, "selected")).unwrap().source("through"), None);
    assert_eq!(window.state().document().history().position(), 1, "one step");
    undo(&mut window);
    assert_eq!(names(&window), ["ball", "mesh"]);
}

#[test]
fn vertices_are_painted_and_taken_away_again() {
    let (_folder, mut window) = ball();
    press(&mut window, Modifiers::NONE, Key::B);
    let place = front(&window, 0.0, 1.0, 0.5);
    // The first touch makes the node, the next ones paint.
    click_at(&mut window, place);
    settle(&mut window);
    assert_eq!(names(&window), ["ball", "mesh", "painted"], "{}", message(&window));
    assert_eq!(literal(&window, "painted", "points"), Some(Literal::Text(String::new())));
    window.state_mut().settings_mut().brush = 0.1;
    drag(&mut window, &way(place, place + vec2(20.0, 0.0), 4));
    settle(&mut window);
    assert_eq!(failure(&window, "painted"), None);
    let painted = figure(&window, "painted", "selected");
    assert!(painted > 3.0 && figure(&window, "painted", "lost") == 0.0, "{painted}");
    assert_eq!(window.state().document().history().undo_name(), Some("paint a selection"));
    // What is behind was not touched.
    let Some(Literal::Text(points)) = literal(&window, "painted", "points") else { panic!() };
    for point in points.split(", ") {
        let z: f64 = point.split(' ').nth(2).unwrap().parse().unwrap();
        assert!(z > 0.3, "{point}");
    }
    drag_with(&mut window, PointerButton::Primary, &[place, place], Modifiers::COMMAND);
    settle(&mut window);
    assert!(figure(&window, "painted", "selected") < painted);
}

#[test]
fn an_arrow_moves_a_handle_and_the_mesh_follows_and_a_ring_turns_it() {
    let mut window = opened(&graph("bar-bent.ron"));
    select(&mut window, "top");
    press(&mut window, Modifiers::NONE, Key::Q);
    let vector = |window: &Window, input: &str| match literal(window, "top", input) {
        Some(Literal::Vector(vector)) => vector,
        other => panic!("{other:?}"),
    };
    let pivot = {
        let report = window.state().results().report(find(&window, "top")).unwrap();
        let table = report.tables.iter().find(|table| table.name == "pivot").unwrap();
        let row: Vec<f64> = table.rows[0].iter().map(|cell| cell.to_string().parse().unwrap()).collect();
        [row[0], row[1], row[2]]
    };
    let (before, mesh) = (vector(&window, "translate"), hash(&window, "bar bent"));
    let anchor = front(&window, pivot[0] + before[0], pivot[1] + before[1], pivot[2] + before[2]);
    drag(&mut window, &way(anchor - vec2(0.0, 30.0), anchor - vec2(0.0, 50.0), 6));
    settle(&mut window);
    let after = vector(&window, "translate");
    assert!(after[1] > before[1] + 1e-3 && after[0] == before[0] && after[2] == before[2], "{before:?} {after:?}");
    assert!(mesh.is_some() && hash(&window, "bar bent") != mesh, "the mesh follows");
    assert_eq!(window.state().document().history().undo_name(), Some("move top"));
    undo(&mut window);
    assert_eq!((vector(&window, "translate"), hash(&window, "bar bent")), (before, mesh));
    // The ring, from the view that sees it as a circle, by a turn and a half.
    let angle = |window: &Window| match literal(window, "top", "angle") {
        Some(Literal::Number(angle)) => angle,
        None => 0.0,
        other => panic!("{other:?}"),
    };
    let was = angle(&window);
    let around: Vec<Pos2> = (0..=90)
        .map(|k| (f32::from(u8::try_from(k).unwrap()) * 6.0).to_radians().sin_cos())
        .map(|(s, c)| anchor + 44.0 * vec2(0.8 * c - 0.6 * s, -(0.6 * c + 0.8 * s)))
        .collect();
    drag(&mut window, &around);
    settle(&mut window);
    assert!(((angle(&window) - was).abs() - 540.0).abs() < 3.0, "{was} became {}", angle(&window));
}
