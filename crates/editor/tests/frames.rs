//! Frames behind the nodes, and collapsed nodes: made, moved, sized, named, coloured, deleted, undone.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod support;

use egui::{Key, Modifiers, PointerButton, Pos2, Rect, vec2};
use egui_kittest::kittest::Queryable as _;
use maquette_editor::Options;
use maquette_editor::command::ViewCommand;
use maquette_graph::Frame;
use support::*;

/// Three nodes, of which the first two have a frame.
fn framed() -> Window {
    let mut window = window(Options::default());
    let canvas = canvas(&window);
    let at = |x: f32, y: f32| canvas.min + vec2(canvas.width() * x, canvas.height() * y);
    add(&mut window, "sketch", at(0.08, 0.3));
    add(&mut window, "resample", at(0.34, 0.3));
    add(&mut window, "smooth", at(0.75, 0.3));
    let ids = ["sketch", "resample"].map(|name| find(&window, name));
    window.state_mut().ask(ViewCommand::Select(ids.to_vec()));
    window.run_steps(2);
    press(&mut window, Modifiers::COMMAND, Key::J);
    window
}

fn frames(window: &Window) -> Vec<Frame> {
    window.state().document().graph().frames().to_vec()
}

fn position(window: &Window, name: &str) -> [f64; 2] {
    window.state().document().graph().node(find(window, name)).unwrap().position().unwrap()
}

/// A point of the canvas on the screen; these windows show it one to one.
fn on_screen(window: &Window, [x, y]: [f64; 2]) -> Pos2 {
    let rect = window.state().node_on_screen(find(window, "smooth")).unwrap();
    let at = position(window, "smooth");
    let scale = f64::from(rect.width()) / 192.0;
    rect.min + vec2(((x - at[0]) * scale) as f32, ((y - at[1]) * scale) as f32)
}

fn seen_frame(window: &Window) -> Rect {
    let frame = &frames(window)[0];
    let [x, y] = frame.at;
    Rect::from_two_pos(on_screen(window, [x, y]), on_screen(window, [x + frame.size[0], y + frame.size[1]]))
}

#[test]
fn a_frame_is_put_around_the_selection_and_moved_with_its_nodes() {
    let mut window = framed();
    assert_eq!(frames(&window).len(), 1, "{}", message(&window));
    let frame = frames(&window)[0].clone();
    for name in ["sketch", "resample"] {
        let [x, y] = position(&window, name);
        assert!(x > frame.at[0] && y > frame.at[1] + 28.0 && x + 192.0 < frame.at[0] + frame.size[0]);
    }
    let before = [position(&window, "sketch"), position(&window, "resample"), position(&window, "smooth")];
    let text_before = text(&window);
    let title = seen_frame(&window).left_top() + vec2(60.0, 12.0);
    drag(&mut window, &way(title, title + vec2(30.0, 22.0), 8));
    let by = |index: usize, name: &str| {
        let now = position(&window, name);
        [now[0] - before[index][0], now[1] - before[index][1]]
    };
    let moved = frames(&window)[0].at;
    let shift = [moved[0] - frame.at[0], moved[1] - frame.at[1]];
    assert!(shift[0] > 20.0 && shift[1] > 14.0, "{shift:?}");
    assert_eq!([by(0, "sketch"), by(1, "resample"), by(2, "smooth")], [shift, shift, [0.0, 0.0]]);
    assert_eq!(frames(&window)[0].size, frame.size);
    assert_eq!(window.state().document().history().undo_name(), Some("move a frame"));
    undo(&mut window);
    assert_eq!(text(&window), text_before, "one step");
    redo(&mut window);
    undo(&mut window);
    undo(&mut window);
    assert!(frames(&window).is_empty());
}

#[test]
fn the_corner_of_a_frame_changes_its_size_and_moves_no_node() {
    let mut window = framed();
    let (before, at) = (frames(&window)[0].clone(), position(&window, "sketch"));
    let corner = seen_frame(&window).right_bottom() - vec2(6.0, 6.0);
    drag(&mut window, &way(corner, corner + vec2(40.0, 30.0), 8));
    let after = frames(&window)[0].clone();
    assert_eq!(after.at, before.at);
    assert!(after.size[0] > before.size[0] + 30.0 && after.size[1] > before.size[1] + 20.0, "{after:?}");
    assert_eq!(position(&window, "sketch"), at);
    assert_eq!(window.state().document().history().undo_name(), Some("change a frame"));
    let corner = seen_frame(&window).right_bottom() - vec2(6.0, 6.0);
    drag(&mut window, &way(corner, corner - vec2(900.0, 900.0), 8));
    let least = frames(&window)[0].size;
    assert!(least[0] >= 80.0 && least[1] >= 60.0, "{least:?}");
}

#[test]
fn title_and_colour_are_edited_in_place_and_a_deleted_frame_leaves_its_nodes() {
    let mut window = framed();
    let title = seen_frame(&window).left_top() + vec2(60.0, 12.0);
    click_at(&mut window, title);
    assert_eq!(window.state().view().selection.len(), 2, "a click selects its nodes");
    for _ in 0..2 {
        click_at(&mut window, title);
    }
    window.run_steps(2);
    press(&mut window, Modifiers::COMMAND, Key::A);
    window.get_by_label("title of the frame").type_text("rails");
    window.run_steps(2);
    press(&mut window, Modifiers::NONE, Key::Enter);
    window.run_steps(2);
    assert_eq!(frames(&window)[0].title, "rails", "{}", message(&window));
    assert_eq!(window.state().document().history().undo_name(), Some("rename a frame"));
    let menu = |window: &mut Window| {
        drag_with(window, PointerButton::Secondary, &[title, title], Modifiers::NONE);
        window.run_steps(2);
    };
    menu(&mut window);
    window.get_by_label_contains("Colour").click();
    window.run_steps(4);
    click(&mut window, "purple");
    assert_eq!(frames(&window)[0].colour, [0.56, 0.36, 0.72]);
    menu(&mut window);
    click(&mut window, "Delete the frame");
    assert!(frames(&window).is_empty());
    assert_eq!(names(&window).len(), 3);
    for _ in 0..3 {
        undo(&mut window);
    }
    assert_eq!(frames(&window)[0].title, "frame");
}

#[test]
fn frames_go_through_the_file_and_nothing_is_evaluated_anew() {
    let mut window = opened(&graph("vest.ron"));
    let ids = ["sorted", "body"].map(|name| find(&window, name));
    window.state_mut().ask(ViewCommand::Select(ids.to_vec()));
    window.run_steps(2);
    press(&mut window, Modifiers::COMMAND, Key::J);
    press(&mut window, Modifiers::NONE, Key::H);
    settle(&mut window);
    assert_eq!(frames(&window).len(), 1);
    assert_eq!(window.state().results().evaluation().unwrap().run_count(), 0);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("framed.ron");
    window.state_mut().ask(maquette_editor::command::FileCommand::SaveAs(path.clone()));
    window.run_steps(2);
    let again = opened(&path);
    assert_eq!(frames(&again), frames(&window));
    assert!(again.state().document().graph().node(find(&again, "body")).unwrap().is_collapsed());
}

#[test]
fn without_a_selection_it_is_said_what_to_select() {
    let mut window = window(Options::default());
    press(&mut window, Modifiers::COMMAND, Key::J);
    assert!(message(&window).contains("select the nodes"), "{}", message(&window));
}

#[test]
fn a_collapsed_node_shows_its_title_and_is_linked_as_ever() {
    let mut window = framed();
    let before = window.state().node_on_screen(find(&window, "resample")).unwrap();
    press(&mut window, Modifiers::NONE, Key::H);
    let graph = window.state().document().graph();
    assert!(["sketch", "resample"].iter().all(|name| graph.node(find(&window, name)).unwrap().is_collapsed()));
    let after = window.state().node_on_screen(find(&window, "resample")).unwrap();
    assert!(after.height() < 0.5 * before.height());
    assert!(window.query_all_by_label("resample").count() > 0);
    let line = way(output(&window, "sketch", "curves"), input(&window, "resample", "curves"), 8);
    drag(&mut window, &line);
    assert_eq!(link(&window, "resample", "curves").as_deref(), Some("sketch.curves"), "{}", message(&window));
    let ids = ["sketch", "resample"].map(|name| find(&window, name));
    window.state_mut().ask(ViewCommand::Select(ids.to_vec()));
    window.run_steps(2);
    press(&mut window, Modifiers::NONE, Key::H);
    assert_eq!(window.state().node_on_screen(find(&window, "resample")).unwrap().height(), before.height());
    assert_eq!(window.state().document().history().undo_name(), Some("open out"));
}
