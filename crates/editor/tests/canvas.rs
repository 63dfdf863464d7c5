//! The canvas, driven as an artist does: what counts is the document.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod support;

use egui::{Event, Key, Modifiers, PointerButton, pos2, vec2};
use egui_kittest::kittest::Queryable as _;
use maquette_editor::Options;
use maquette_editor::command::{FileCommand, GraphCommand, ViewCommand};
use support::*;

#[test]
fn a_graph_opens_and_is_evaluated_with_nothing_wrong() {
    let window = opened(&graph("vest.ron"));
    let evaluation = window.state().results().evaluation().unwrap();
    assert!(evaluation.is_complete() && evaluation.outcomes().len() > 15);
    assert!(hash(&window, "vest").is_some());
    for label in ["Perspective view", "Front view", "Side view", "Top view", "canvas"] {
        window.get_by_label(label);
    }
    window.get_by_label("Problems");
    assert!(!window.state().document().is_changed());
}

/// Four nodes, built from nothing by search and by drag.
fn built() -> Window {
    let mut window = window(Options::default());
    let canvas = canvas(&window);
    let at = |x: f32, y: f32| canvas.min + vec2(canvas.width() * x, canvas.height() * y);
    add(&mut window, "sketch", at(0.1, 0.2));
    add(&mut window, "resample", at(0.4, 0.2));
    add(&mut window, "curves-out", at(0.7, 0.2));
    window
}

#[test]
fn a_chain_is_built_by_search_and_drag_and_undone_to_nothing() {
    let mut window = window(Options::default());
    let empty = text(&window);
    drop(window);
    window = built();
    assert_eq!(names(&window), ["sketch", "resample", "curves-out"]);
    let way = way(output(&window, "sketch", "curves"), input(&window, "resample", "curves"), 8);
    drag(&mut window, &way);
    assert_eq!(link(&window, "resample", "curves").as_deref(), Some("sketch.curves"), "{}", message(&window));
    let full = text(&window);
    let steps = window.state().document().history().position();
    assert_eq!(steps, 4);
    for _ in 0..steps {
        undo(&mut window);
    }
    assert_eq!(text(&window), empty);
    for _ in 0..steps {
        redo(&mut window);
    }
    assert_eq!(text(&window), full);
}

#[test]
fn a_wrong_link_is_refused_at_the_pointer() {
    let mut window = built();
    let canvas = canvas(&window);
    add(&mut window, "mesh-out", canvas.min + vec2(canvas.width() * 0.4, canvas.height() * 0.6));
    let before = text(&window);
    let points = way(output(&window, "sketch", "curves"), input(&window, "mesh-out", "mesh"), 8);
    let press = |pressed, pos| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    window.event(Event::PointerMoved(points[0]));
    window.run_steps(2);
    window.event(press(true, points[0]));
    window.run_steps(1);
    for point in &points[1..] {
        window.event(Event::PointerMoved(*point));
        window.run_steps(1);
    }
    window.run_steps(2);
    window.get_by_label_contains("\"sketch.curves\" gives curves, but \"mesh-out.mesh\" takes mesh");
    window.event(press(false, points[8]));
    window.run_steps(2);
    assert!(message(&window).contains("no conversion between them keeps everything"), "{}", message(&window));
    assert_eq!(text(&window), before);
}

#[test]
fn a_link_into_the_void_offers_what_fits_and_links_it() {
    let mut window = built();
    let canvas = canvas(&window);
    let void = canvas.min + vec2(canvas.width() * 0.3, canvas.height() * 0.85);
    let way = way(output(&window, "sketch", "curves"), void, 8);
    drag(&mut window, &way);
    window.run_steps(3);
    window.get_by_label("search nodes").type_text("mesh-out");
    window.run_steps(3);
    // It takes no curves.
    window.get_by_label("nothing fits");
    press(&mut window, Modifiers::NONE, Key::Escape);
    drag(&mut window, &way);
    window.run_steps(3);
    window.get_by_label("search nodes").type_text("smooth");
    window.run_steps(3);
    press(&mut window, Modifiers::NONE, Key::Enter);
    assert_eq!(link(&window, "smooth", "curves").as_deref(), Some("sketch.curves"));
    undo(&mut window);
    assert_eq!(names(&window).len(), 3, "adding and linking is one step");
}

#[test]
fn a_node_dropped_on_a_link_is_led_through_it() {
    let mut window = built();
    let path = way(output(&window, "resample", "curves"), input(&window, "curves-out", "curves"), 8);
    drag(&mut window, &path);
    let canvas = canvas(&window);
    add(&mut window, "smooth", canvas.min + vec2(canvas.width() * 0.5, canvas.height() * 0.8));
    let ends = [output(&window, "resample", "curves"), input(&window, "curves-out", "curves")];
    let begin = node_middle(&window, "smooth");
    let middle = window.state().node_on_screen(find(&window, "smooth")).unwrap().center();
    let goal = ends[0].lerp(ends[1], 0.5) + (begin - middle);
    drag(&mut window, &way(begin, goal, 10));
    assert_eq!(link(&window, "smooth", "curves").as_deref(), Some("resample.curves"));
    assert_eq!(link(&window, "curves-out", "curves").as_deref(), Some("smooth.curves"));
}

#[test]
fn links_are_cut_by_a_line_across_them_and_pulled_off_their_inputs() {
    let mut window = built();
    for [from, to] in [["sketch", "resample"], ["resample", "curves-out"]] {
        let way = way(output(&window, from, "curves"), input(&window, to, "curves"), 8);
        drag(&mut window, &way);
    }
    let middle = output(&window, "sketch", "curves").lerp(input(&window, "resample", "curves"), 0.5);
    let cut = way(middle + vec2(4.0, -60.0), middle + vec2(-4.0, 60.0), 12);
    drag_with(&mut window, PointerButton::Secondary, &cut, Modifiers::NONE);
    assert_eq!(link(&window, "resample", "curves"), None);
    assert!(link(&window, "curves-out", "curves").is_some());
    let canvas = canvas(&window);
    let void = canvas.min + vec2(canvas.width() * 0.6, canvas.height() * 0.9);
    let pull = way(input(&window, "curves-out", "curves"), void, 8);
    drag(&mut window, &pull);
    assert_eq!(link(&window, "curves-out", "curves"), None);
}

#[test]
fn nodes_are_moved_selected_deleted_and_duplicated() {
    let mut window = built();
    let begin = node_middle(&window, "resample");
    let position =
        |window: &Window| window.state().document().graph().node(find(window, "resample")).unwrap().position().unwrap();
    let before = position(&window);
    drag(&mut window, &way(begin, begin + vec2(30.0, 40.0), 6));
    assert!((position(&window)[1] - before[1]).abs() > 20.0);
    assert_eq!(window.state().document().history().undo_name(), Some("move nodes"));
    let place = node_middle(&window, "resample");
    click_at(&mut window, place);
    assert_eq!(window.state().view().active, Some(find(&window, "resample")));
    press(&mut window, Modifiers::COMMAND, Key::D);
    assert!(names(&window).contains(&"resample 2".to_owned()), "{:?}", names(&window));
    press(&mut window, Modifiers::NONE, Key::Delete);
    assert!(!names(&window).contains(&"resample 2".to_owned()));
    press(&mut window, Modifiers::COMMAND, Key::A);
    assert_eq!(window.state().view().selection.len(), 3);
    press(&mut window, Modifiers::NONE, Key::M);
    assert!(window.state().document().graph().nodes().all(|(_, node)| node.is_muted()));
}

#[test]
fn nodes_go_through_text_from_one_graph_into_another() {
    let mut source = opened(&graph("vest.ron"));
    source.state_mut().ask(ViewCommand::Find("side rail".to_owned()));
    source.run_steps(2);
    source.event(Event::Copy);
    source.step();
    let copied = source.output().platform_output.commands.iter().find_map(|command| match command {
        egui::OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    });
    let copied = copied.unwrap();
    assert!(copied.contains("\"side rail\"") && copied.starts_with('('), "{copied}");
    let mut target = window(Options::default());
    target.event(Event::Paste(copied));
    target.run_steps(3);
    assert_eq!(names(&target), ["side rail"]);
    target.event(Event::Paste("no graph".to_owned()));
    target.run_steps(3);
    assert!(message(&target).contains("the clipboard holds no nodes"), "{}", message(&target));
}

#[test]
fn nodes_are_grouped_entered_edited_within_and_taken_out_again() {
    let mut window = opened(&graph("vest.ron"));
    let before = hash(&window, "vest");
    let ids = ["both sides", "all curves", "sorted"].map(|name| find(&window, name));
    window.state_mut().ask(ViewCommand::Select(ids.to_vec()));
    window.run_steps(2);
    press(&mut window, Modifiers::COMMAND, Key::G);
    settle(&mut window);
    assert!(names(&window).contains(&"group".to_owned()), "{}", message(&window));
    assert_eq!(hash(&window, "vest"), before, "grouping changes nothing");
    press(&mut window, Modifiers::NONE, Key::Enter);
    assert_eq!(window.state().view().path.len(), 1);
    let canvas = canvas(&window);
    add(&mut window, "resample", canvas.center());
    let inner = window.state().document().graph_at(&window.state().view().path).unwrap();
    assert!(inner.find("resample").is_some());
    click(&mut window, "vest.ron");
    assert!(window.state().view().path.is_empty());
    undo(&mut window);
    window.state_mut().ask(ViewCommand::Find("group".to_owned()));
    window.run_steps(2);
    press(&mut window, Modifiers::COMMAND | Modifiers::SHIFT, Key::G);
    settle(&mut window);
    assert!(!names(&window).contains(&"group".to_owned()), "{}", message(&window));
    assert_eq!(hash(&window, "vest"), before);
}

#[test]
fn a_broken_node_says_what_is_wrong_in_the_panel_that_leads_to_it() {
    let mut window = opened(&graph("vest.ron"));
    let id = find(&window, "side rail");
    let edit = maquette_graph::Edit::set(id, "strokes", maquette_graph::Literal::Strokes(Vec::new()));
    window.state_mut().ask(GraphCommand::edit(edit));
    window.run_steps(2);
    settle(&mut window);
    assert!(failure(&window, "side rail").unwrap().contains("there are no strokes"));
    window.get_by_label("Problems (1)");
    assert!(window.query_all_by_label_contains("there are no strokes: draw some").count() > 0);
    assert!(window.query_by_label("1 node(s) failed").is_some());
    undo(&mut window);
    assert!(window.query_by_label("Problems (1)").is_none());
}

#[test]
fn display_and_pin_decide_what_is_evaluated() {
    let mut window = opened(&graph("vest.ron"));
    let id = find(&window, "even front rail");
    window.state_mut().ask(ViewCommand::Display(id));
    window.run_steps(2);
    settle(&mut window);
    let evaluated = window.state().results().evaluation().unwrap().outcomes().len();
    assert_eq!(evaluated, 2, "the rail and the sketch before it");
    let vest = find(&window, "vest");
    window.state_mut().ask(ViewCommand::Pin(vest));
    window.run_steps(2);
    settle(&mut window);
    assert!(hash(&window, "vest").is_some() && hash(&window, "even front rail").is_some());
}

#[test]
fn a_kind_of_a_newer_version_stays_and_is_shown_as_unknown() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("newer.ron");
    let text_before = "(\n    version: 1,\n    nodes: {\n        \"hair\": (\n            kind: \"curl-hair\",\n            inputs: {\n                \"count\": 7,\n            },\n        ),\n    },\n)\n";
    std::fs::write(&path, text_before).unwrap();
    let mut window = opened(&path);
    window.get_by_label("curl-hair");
    window.get_by_label("Problems (1)");
    window.state_mut().ask(ViewCommand::Find("hair".to_owned()));
    window.run_steps(2);
    window.get_by_label_contains("does not know the kind \"curl-hair\"");
    window.state_mut().ask(FileCommand::Save);
    window.run_steps(2);
    assert_eq!(std::fs::read_to_string(&path).unwrap(), text_before);
    let _ = pos2(0.0, 0.0);
}

#[test]
fn every_kind_of_the_catalogue_is_in_the_palette_and_the_search() {
    let mut window = window(Options::default());
    let canvas = canvas(&window);
    click(&mut window, "Palette");
    let catalogue = maquette_nodes::catalogue().unwrap();
    for kind in catalogue.kinds() {
        window.get_by_label(&format!("palette {}", kind.name()));
    }
    window.hover_at(canvas.center());
    window.run_steps(2);
    press(&mut window, Modifiers::NONE, Key::Tab);
    window.get_by_label("search nodes").type_text("superellipsoid");
    window.run_steps(3);
    window.get_by_label("add superellipsoid");
    press(&mut window, Modifiers::NONE, Key::Escape);
    assert!(window.query_by_label("search nodes").is_none());
    assert!(names(&window).is_empty());
}

#[test]
fn the_panel_under_the_pointer_fills_the_window_and_goes_back() {
    let mut window = opened(&graph("vest.ron"));
    let front = window.state().view_on_screen(maquette_editor::Direction::Front).unwrap();
    window.hover_at(front.center());
    window.run_steps(2);
    press(&mut window, Modifiers::NONE, Key::Space);
    assert!(rect(&window, "Front view").width() > 1.9 * front.width());
    assert!(window.query_by_label("Side view").is_none());
    press(&mut window, Modifiers::NONE, Key::Space);
    assert_eq!(rect(&window, "Front view"), front);
}
