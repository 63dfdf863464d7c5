//! What the tests of the window share: they drive the application by labels and pointer, and look at the document.
#![allow(dead_code, reason = "not every test uses everything")]

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use egui::{Event, Key, Modifiers, PointerButton, Pos2, Vec2, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use maquette_editor::{App, Direction, Options};
use maquette_graph::{Literal, NodeId, OutcomeState, Source, Stroke, file};

pub type Window = Harness<'static, App>;

/// A graph of the repository.
pub fn graph(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../graphs").join(name)
}

/// A window without a graphics card.
pub fn window(options: Options) -> Window {
    let mut window = Harness::builder()
        .with_size(vec2(1400.0, 900.0))
        .with_step_dt(1.0 / 60.0)
        .build_eframe(move |context| App::new(context, options).unwrap());
    settle(&mut window);
    window
}

/// A window with a graph.
pub fn opened(path: &Path) -> Window {
    window(Options { path: Some(path.to_owned()), ..Options::default() })
}

/// Lets the window go on until everything is evaluated.
pub fn settle(window: &mut Window) {
    let begun = Instant::now();
    loop {
        window.run_steps(2);
        let results = window.state().results();
        if results.is_current() && results.progress().is_none() {
            break;
        }
        assert!(begun.elapsed() < Duration::from_secs(60), "the evaluation does not end");
        std::thread::sleep(Duration::from_millis(5));
    }
    window.run_steps(2);
}

pub fn text(window: &Window) -> String {
    file::to_text(window.state().document().graph())
}

pub fn find(window: &Window, name: &str) -> NodeId {
    window.state().document().graph().find(name).unwrap_or_else(|| panic!("no node {name}:\n{}", text(window)))
}

pub fn names(window: &Window) -> Vec<String> {
    window.state().document().graph().nodes().map(|(_, node)| node.name().to_owned()).collect()
}

/// `node.output` that an input is linked to.
pub fn link(window: &Window, node: &str, input: &str) -> Option<String> {
    let graph = window.state().document().graph();
    match graph.node(find(window, node))?.source(input)? {
        Source::Link(link) => Some(format!("{}.{}", graph.node(link.node)?.name(), link.output)),
        _ => None,
    }
}

pub fn literal(window: &Window, node: &str, input: &str) -> Option<Literal> {
    match window.state().document().graph().node(find(window, node))?.source(input)? {
        Source::Literal { literal, .. } => Some(literal.clone()),
        _ => None,
    }
}

/// The strokes that a node holds.
pub fn strokes(window: &Window, node: &str) -> Vec<Stroke> {
    match literal(window, node, "strokes") {
        Some(Literal::Strokes(strokes)) => strokes,
        other => panic!("{node} holds {other:?}"),
    }
}

/// The hash of the first output of a node that is shown.
pub fn hash(window: &Window, node: &str) -> Option<u128> {
    Some(window.state().results().values(find(window, node))?.first()?.hash().0)
}

pub fn failure(window: &Window, node: &str) -> Option<String> {
    match &window.state().results().outcome(find(window, node))?.state {
        OutcomeState::Failed(failure) => Some(failure.to_string()),
        _ => None,
    }
}

pub fn message(window: &Window) -> String {
    window.state().view().message.as_ref().map(|message| message.text.clone()).unwrap_or_default()
}

/// Drags from point to point with a button.
pub fn drag_with(window: &mut Window, button: PointerButton, points: &[Pos2], modifiers: Modifiers) {
    let press = |pressed, pos| Event::PointerButton { pos, button, pressed, modifiers };
    window.event_modifiers(Event::PointerMoved(points[0]), modifiers);
    window.run_steps(2);
    window.event_modifiers(press(true, points[0]), modifiers);
    window.run_steps(1);
    for point in &points[1..] {
        window.event_modifiers(Event::PointerMoved(*point), modifiers);
        window.run_steps(1);
    }
    let last = points[points.len() - 1];
    window.event_modifiers(press(false, last), modifiers);
    window.run_steps(2);
}

pub fn drag(window: &mut Window, points: &[Pos2]) {
    drag_with(window, PointerButton::Primary, points, Modifiers::NONE);
}

/// Points from one to another.
pub fn way(from: Pos2, to: Pos2, count: usize) -> Vec<Pos2> {
    (0..=count).map(|k| from.lerp(to, k as f32 / count as f32)).collect()
}

pub fn click_at(window: &mut Window, place: Pos2) {
    drag(window, &[place, place]);
}

/// Moves the pointer away from everything that reacts to it.
pub fn press(window: &mut Window, modifiers: Modifiers, key: Key) {
    window.key_press_modifiers(modifiers, key);
    window.run_steps(2);
}

pub fn click(window: &mut Window, label: &str) {
    window.get_by_label(label).click();
    window.run_steps(3);
}

/// The rectangle of something with a label.
pub fn rect(window: &Window, label: &str) -> egui::Rect {
    window.get_by_label(label).rect()
}

/// The canvas, on the screen.
pub fn canvas(window: &Window) -> egui::Rect {
    window.state().canvas_on_screen().unwrap()
}

/// Where a point of the world is seen in a view.
pub fn seen(window: &Window, direction: Direction, label: &str, point: [f64; 3]) -> Pos2 {
    let rect = rect(window, label);
    rect.min + window.state().seen_at(direction, rect.size(), point).unwrap()
}

pub fn node_middle(window: &Window, name: &str) -> Pos2 {
    let rect = window.state().node_on_screen(find(window, name)).unwrap();
    // The title, away from sockets and flags.
    pos2(rect.center().x, rect.top() + 0.2 * rect.height().min(60.0))
}

/// The socket of an input, a little outside of its node, where it can be grabbed.
pub fn input(window: &Window, node: &str, port: &str) -> Pos2 {
    socket(window, node, port, false)
}

/// The same of an output.
pub fn output(window: &Window, node: &str, port: &str) -> Pos2 {
    socket(window, node, port, true)
}

fn socket(window: &Window, node: &str, port: &str, output: bool) -> Pos2 {
    let id = find(window, node);
    let place = window.state().socket_on_screen(id, port, output);
    let place = place.unwrap_or_else(|| panic!("{node} shows no socket {port}"));
    let middle = window.state().node_on_screen(id).unwrap().center();
    place + vec2((place.x - middle.x).signum() * 3.0, 0.0)
}

/// Adds a node by the search, at a point of the canvas.
pub fn add(window: &mut Window, kind: &str, place: Pos2) {
    window.hover_at(place);
    window.run_steps(2);
    press(window, Modifiers::SHIFT, Key::A);
    window.get_by_label("search nodes").type_text(kind);
    window.run_steps(3);
    press(window, Modifiers::NONE, Key::Enter);
    settle(window);
}

pub fn undo(window: &mut Window) {
    press(window, Modifiers::COMMAND, Key::Z);
    settle(window);
}

pub fn redo(window: &mut Window) {
    press(window, Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    settle(window);
}

pub fn offset(place: Pos2, by: Vec2) -> Pos2 {
    place + by
}
