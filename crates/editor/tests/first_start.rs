//! The first start: examples, and a tour that goes on when the artist did what it speaks of.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod support;

use egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::Queryable as _;
use maquette_editor::{Direction, Options, Tour};
use support::*;

/// Opens the menu, which has the name of a panel.
fn help(window: &mut Window) {
    let found = window.get_all_by_label("Help").min_by(|a, b| a.rect().top().total_cmp(&b.rect().top()));
    found.unwrap().click();
    window.run_steps(3);
}

fn fresh() -> Window {
    window(Options { welcome: true, ..Options::default() })
}

#[test]
fn the_welcome_is_seen_once_and_found_again_in_the_menu() {
    let mut window = fresh();
    window.get_by_label("Take the tour");
    window.get_by_label("Open a graph…");
    press(&mut window, Modifiers::NONE, Key::Escape);
    assert!(window.query_by_label("Take the tour").is_none());
    assert!(window.state_mut().settings_mut().welcomed);
    help(&mut window);
    click(&mut window, "Welcome and examples…");
    window.get_by_label("Open a graph…");
    click(&mut window, "New graph");
    assert!(window.query_by_label("Open a graph…").is_none());
    let without = self::window(Options::default());
    assert!(without.query_by_label("Open a graph…").is_none(), "only where it is wanted");
    let opened = opened(&graph("vest.ron"));
    assert!(opened.query_by_label("Open a graph…").is_none(), "not where a graph is given");
}

#[test]
fn the_help_menu_leads_to_keys_page_and_version() {
    let mut window = opened(&graph("vest.ron"));
    help(&mut window);
    click(&mut window, "About Maquette");
    window.get_by_label_contains(env!("CARGO_PKG_VERSION"));
    press(&mut window, Modifiers::NONE, Key::Escape);
    let place = node_middle(&window, "sorted");
    click_at(&mut window, place);
    help(&mut window);
    click(&mut window, "Page of sort");
    window.get_by_label_contains("After thesis 6.4");
    help(&mut window);
    click(&mut window, "All keys F1");
    window.get_by_label("swap the first two inputs");
}

#[test]
fn the_tour_goes_on_when_the_artist_did_it() {
    let mut window = fresh();
    click(&mut window, "Take the tour");
    settle(&mut window);
    assert_eq!(window.state().view().tour, Some(Tour::Draw));
    window.get_by_label("1 of 3: draw a line");
    let at = |window: &Window, x, y| seen(window, Direction::Front, "Front view", [x, y, 0.0]);
    let outline = [[0.1, 0.0], [0.2, 0.12], [0.16, 0.25], [0.1, 0.4], [0.14, 0.5]];
    let corners: Vec<_> = outline.iter().map(|[x, y]| at(&window, *x, *y)).collect();
    let line: Vec<_> = corners.windows(2).flat_map(|pair| way(pair[0], pair[1], 6)).collect();
    drag(&mut window, &line);
    settle(&mut window);
    assert_eq!(window.state().view().tour, Some(Tour::Wire), "{}", message(&window));
    assert!(hash(&window, "vase").is_none());
    let link = way(output(&window, "line", "curves"), input(&window, "both sides", "curves"), 10);
    drag(&mut window, &link);
    settle(&mut window);
    assert_eq!(window.state().view().tour, Some(Tour::Pull), "{}", message(&window));
    let before = hash(&window, "vase");
    assert!(before.is_some(), "half an outline is a vase");
    let Some(maquette_graph::Literal::Strokes(strokes)) = literal(&window, "line", "strokes") else { panic!() };
    let point = strokes[0].points[strokes[0].points.len() / 2];
    let begin = at(&window, point.x, point.y);
    drag(&mut window, &way(begin, begin + vec2(12.0, 0.0), 8));
    settle(&mut window);
    assert_eq!(window.state().view().tour, Some(Tour::Done), "{:?}", window.state().document().history().undo_name());
    assert_ne!(hash(&window, "vase"), before, "the surface followed");
    click(&mut window, "Close the tour");
    assert_eq!(window.state().view().tour, None);
    assert!(window.state_mut().settings_mut().toured);
}

#[test]
fn the_tour_can_be_skipped_left_and_taken_again() {
    let mut window = fresh();
    click(&mut window, "Take the tour");
    click(&mut window, "Skip this step");
    assert_eq!(window.state().view().tour, Some(Tour::Wire));
    click(&mut window, "Leave the tour");
    assert_eq!(window.state().view().tour, None);
    help(&mut window);
    click(&mut window, "Take the tour");
    assert_eq!(window.state().view().tour, Some(Tour::Draw));
}
