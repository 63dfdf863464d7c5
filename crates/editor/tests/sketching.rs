//! Sketching with the pointer: strokes land in the document, and what depends on them follows.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod support;

use egui::{Key, Modifiers, Pos2};
use maquette_editor::command::ViewCommand;
use maquette_editor::{Direction, Options};
use maquette_graph::Literal;
use support::*;

/// A line through points of the world, as it is seen in a view, drawn in many small moves.
fn pen(window: &Window, direction: Direction, label: &str, points: &[[f64; 3]]) -> Vec<Pos2> {
    let seen: Vec<Pos2> = points.iter().map(|point| seen(window, direction, label, *point)).collect();
    let mut line = vec![seen[0]];
    for pair in seen.windows(2) {
        line.extend(way(pair[0], pair[1], 12).into_iter().skip(1));
    }
    line
}

fn select(window: &mut Window, node: &str) {
    window.state_mut().ask(ViewCommand::Find(node.to_owned()));
    window.run_steps(2);
}

#[test]
fn a_stroke_in_an_empty_graph_becomes_a_sketch_in_the_plane_of_the_view() {
    let mut window = window(Options::default());
    press(&mut window, Modifiers::NONE, Key::S);
    let arc: Vec<[f64; 3]> =
        (0..=10).map(|k| (f64::from(k) * 0.3).sin_cos()).map(|(s, c)| [0.3 * s, 1.0 + 0.3 * c, 0.0]).collect();
    let line = pen(&window, Direction::Front, "Front view", &arc);
    drag(&mut window, &line);
    settle(&mut window);
    assert_eq!(names(&window), ["front sketch"], "{}", message(&window));
    let drawn = strokes(&window, "front sketch");
    assert_eq!(drawn.len(), 1);
    let stroke = &drawn[0];
    assert!(!stroke.closed && stroke.points.len() > 4 && stroke.points.len() < 60, "{} points", stroke.points.len());
    // Within the tolerance of 2 mm and the grain of the screen of what was drawn.
    for point in &stroke.points {
        let off = (point.x.hypot(point.y - 1.0) - 0.3).abs();
        assert!(off < 0.012, "{point:?} is {off} m off");
    }
    // A second stroke goes into the same sketch, and one that ends where it began is closed.
    let ring: Vec<[f64; 3]> = (0..=24)
        .map(|k| (f64::from(k) * 15.0).to_radians().sin_cos())
        .map(|(s, c)| [0.1 * s, 0.4 + 0.1 * c, 0.0])
        .collect();
    let line = pen(&window, Direction::Front, "Front view", &ring);
    drag(&mut window, &line);
    let drawn = strokes(&window, "front sketch");
    assert_eq!((drawn.len(), drawn[1].closed), (2, true));
    undo(&mut window);
    undo(&mut window);
    assert!(names(&window).is_empty());
    // The top view draws in its own plane.
    let line = pen(&window, Direction::Top, "Top view", &[[-0.3, 0.0, 0.1], [0.0, 0.0, 0.2], [0.3, 0.0, 0.1]]);
    drag(&mut window, &line);
    assert_eq!(literal(&window, "top sketch", "plane"), Some(Literal::Choice("top".to_owned())));
    let drawn = strokes(&window, "top sketch");
    assert!((drawn[0].points[0].y - 0.1).abs() < 0.02, "{:?}", drawn[0].points[0]);
}

#[test]
fn in_the_perspective_one_is_told_where_to_draw() {
    let mut window = window(Options::default());
    press(&mut window, Modifiers::NONE, Key::S);
    let middle = rect(&window, "Perspective view").center();
    drag(&mut window, &way(middle, middle + egui::vec2(60.0, 30.0), 8));
    assert!(message(&window).contains("no plane to draw in here"), "{}", message(&window));
    assert!(names(&window).is_empty());
}

#[test]
fn pulling_a_rail_of_the_vest_takes_the_surface_along_in_one_step() {
    let mut window = opened(&graph("vest.ron"));
    let (before, text_before) = (hash(&window, "vest"), text(&window));
    select(&mut window, "side rail");
    settle(&mut window);
    press(&mut window, Modifiers::NONE, Key::W);
    // The fifth point of the left side; its sketch lies at z = 0.012.
    let begin = seen(&window, Direction::Front, "Front view", [0.138, 1.15, 0.012]);
    let path = way(begin, begin + egui::vec2(14.0, 0.0), 7);
    drag(&mut window, &path);
    settle(&mut window);
    let pulled = strokes(&window, "side rail");
    assert!(pulled[0].points[4].x > 0.15, "{:?}", pulled[0].points[4]);
    assert_eq!(pulled[0].points[0].x, 0.1657, "the end of the rail is out of reach");
    assert_ne!(hash(&window, "vest"), before, "the surface follows");
    assert_eq!(window.state().document().history().position(), 1, "a drag is one step");
    undo(&mut window);
    assert_eq!((hash(&window, "vest"), text(&window)), (before, text_before));
    assert_eq!(window.state().results().evaluation().unwrap().run_count(), 0, "undoing evaluates nothing");
}

#[test]
fn drawing_along_a_rail_draws_that_part_anew() {
    let mut window = opened(&graph("vest.ron"));
    select(&mut window, "side rail");
    settle(&mut window);
    let before = hash(&window, "vest");
    press(&mut window, Modifiers::NONE, Key::S);
    let z = 0.012;
    // Along the rail from 1.03 m to 1.27 m, bulging 2 cm outwards in the middle.
    let line: Vec<[f64; 3]> =
        [(0.146, 1.03), (0.150, 1.09), (0.158, 1.15), (0.160, 1.21), (0.161, 1.27)].map(|(x, y)| [x, y, z]).into();
    let line = pen(&window, Direction::Front, "Front view", &line);
    drag(&mut window, &line);
    settle(&mut window);
    let drawn = strokes(&window, "side rail");
    assert_eq!((drawn.len(), drawn[0].name.as_str()), (1, "left side"));
    let points = &drawn[0].points;
    assert_eq!((points[0].x, points[0].y), (0.1657, 0.93), "its beginning stays");
    assert_eq!(points.last().map(|p| (p.x, p.y)), Some((0.088, 1.43)), "its end stays");
    let waist = points.iter().filter(|p| (1.09..1.21).contains(&p.y)).map(|p| p.x).fold(0.0, f64::max);
    assert!((waist - 0.158).abs() < 0.006, "{waist}: {points:?}");
    assert_ne!(hash(&window, "vest"), before);
    assert_eq!(window.state().document().history().undo_name(), Some("correct a stroke"));
}

#[test]
fn erasing_shortens_a_stroke() {
    let mut window = opened(&graph("vest.ron"));
    select(&mut window, "side rail");
    press(&mut window, Modifiers::NONE, Key::E);
    let z = 0.012;
    let line = pen(&window, Direction::Front, "Front view", &[[0.05, 1.43, z], [0.088, 1.43, z], [0.122, 1.42, z]]);
    let before = strokes(&window, "side rail")[0].points.len();
    drag(&mut window, &line);
    let after = strokes(&window, "side rail");
    assert_eq!(after.len(), 1);
    assert!(after[0].points.len() < before, "{} of {before}", after[0].points.len());
    assert_eq!(window.state().document().history().position(), 1);
}

#[test]
fn a_click_on_a_surface_or_a_stroke_selects_what_made_it() {
    let mut window = opened(&graph("vest.ron"));
    // On the belly of the vest, away from curves.
    let place = seen(&window, Direction::Front, "Front view", [0.09, 1.0, 0.1]);
    click_at(&mut window, place);
    assert_eq!(window.state().view().active, Some(find(&window, "vest")));
    let place = seen(&window, Direction::Front, "Front view", [0.1615, 0.97, 0.012]);
    click_at(&mut window, place);
    assert_eq!(window.state().view().active, Some(find(&window, "side rail")));
    let rect = rect(&window, "Front view");
    click_at(&mut window, rect.left_top() + egui::vec2(8.0, 60.0));
    assert_eq!(window.state().view().active, None);
}

#[test]
fn strokes_within_a_group_are_drawn_and_what_holds_the_group_follows() {
    let mut window = opened(&graph("warrior.ron"));
    let (before, text_before) = (hash(&window, "helmet bowl"), text(&window));
    window.state_mut().ask(ViewCommand::Find("helmet/ridge".to_owned()));
    settle(&mut window);
    assert_eq!(window.state().view().path.len(), 1, "it is entered");
    press(&mut window, Modifiers::NONE, Key::T);
    let side = rect(&window, "Side view").center();
    window.hover_at(side);
    window.run_steps(2);
    press(&mut window, Modifiers::SHIFT, Key::ArrowUp);
    settle(&mut window);
    assert_eq!(window.state().document().history().undo_name(), Some("nudge strokes"), "{}", message(&window));
    assert!(before.is_some() && hash(&window, "helmet bowl") != before, "the helmet follows");
    undo(&mut window);
    assert_eq!((hash(&window, "helmet bowl"), text(&window)), (before, text_before));
}
