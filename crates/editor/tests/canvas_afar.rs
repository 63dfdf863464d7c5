//! A large graph, seen as a whole: its nodes are painted, and become widgets only where the pointer is. All that is done with
//! a node seen from near works from afar too.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod support;

use egui::{Key, Modifiers, PointerButton, vec2};
use egui_kittest::kittest::Queryable as _;
use maquette_editor::command::{GraphCommand, ViewCommand};
use maquette_graph::{Graph, file};
use support::*;

/// How many nodes there are: so many that those from afar are only painted.
const COUNT: usize = 144;

/// Ten columns of eight nodes, not linked, and others to their right.
fn many(folder: &std::path::Path) -> Window {
    let catalogue = maquette_nodes::catalogue().unwrap();
    let mut graph = Graph::new();
    for index in 0..80_u32 {
        let id = graph.add(&catalogue, "resample", &format!("node {index}")).unwrap();
        let place = [f64::from(index % 10) * 260.0, f64::from(index / 10) * 140.0];
        graph.set_position(id, Some(place)).unwrap();
    }
    for index in 80..COUNT {
        let id = graph.add(&catalogue, "resample", &format!("more {index}")).unwrap();
        let place = [(10 + (index - 80) % 8) as f64 * 260.0, ((index - 80) / 8) as f64 * 140.0];
        graph.set_position(id, Some(place)).unwrap();
    }
    let path = folder.join("many.ron");
    file::save(&graph, &path).unwrap();
    opened(&path)
}

fn selected(window: &Window) -> Vec<String> {
    let graph = window.state().document().graph();
    let mut names: Vec<String> =
        window.state().view().selection.iter().map(|id| graph.node(*id).unwrap().name().to_owned()).collect();
    names.sort();
    names
}

#[test]
fn nodes_are_found_by_their_names_and_selected_moved_and_boxed() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = many(folder.path());
    assert!(window.state().node_on_screen(find(&window, "node 0")).unwrap().width() < 100.0, "seen from afar");
    for index in 0..80 {
        window.get_by_label(&format!("node node {index}"));
    }
    let place = node_middle(&window, "node 33");
    click_at(&mut window, place);
    assert_eq!(selected(&window), ["node 33"]);
    let position = |window: &Window, name: &str| {
        window.state().document().graph().node(find(window, name)).unwrap().position().unwrap()
    };
    let before = position(&window, "node 33");
    drag(&mut window, &way(place, place + vec2(20.0, 13.0), 6));
    assert!(position(&window, "node 33")[0] - before[0] > 30.0);
    assert_eq!(window.state().document().history().undo_name(), Some("move nodes"));
    undo(&mut window);
    assert_eq!(position(&window, "node 33"), before);
    let rect = |name: &str| window.state().node_on_screen(find(&window, name)).unwrap();
    let (first, last) = (rect("node 44").left_top() - vec2(6.0, 6.0), rect("node 56").right_bottom() + vec2(4.0, 4.0));
    drag(&mut window, &way(first, last, 8));
    assert_eq!(selected(&window), ["node 44", "node 45", "node 46", "node 54", "node 55", "node 56"]);
    let beside = rect_of(&window, "node 0").left_top() - vec2(8.0, 8.0);
    click_at(&mut window, beside);
    assert!(selected(&window).is_empty(), "a click beside all takes the selection away");
}

fn rect_of(window: &Window, name: &str) -> egui::Rect {
    window.state().node_on_screen(find(window, name)).unwrap()
}

#[test]
fn a_selection_moves_as_a_whole_though_most_of_it_is_painted() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = many(folder.path());
    press(&mut window, Modifiers::COMMAND, Key::A);
    assert_eq!(selected(&window).len(), COUNT);
    let positions = |window: &Window| {
        window.state().document().graph().nodes().map(|(_, node)| node.position().unwrap()).collect::<Vec<_>>()
    };
    let before = positions(&window);
    let place = node_middle(&window, "node 12");
    drag(&mut window, &way(place, place + vec2(15.0, 10.0), 5));
    let moved = positions(&window);
    let by = |k: usize| [moved[k][0] - before[k][0], moved[k][1] - before[k][1]];
    assert!(by(0)[0] > 10.0 && (0..COUNT).all(|k| by(k) == by(0)), "{:?}", by(0));
    assert_eq!(selected(&window).len(), COUNT);
}

#[test]
fn links_are_drawn_cut_and_deleted_and_menus_stay_open() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = many(folder.path());
    let line = way(output(&window, "node 3", "curves"), input(&window, "node 14", "curves"), 12);
    drag(&mut window, &line);
    assert_eq!(link(&window, "node 14", "curves").as_deref(), Some("node 3.curves"), "{}", message(&window));
    let middle = output(&window, "node 3", "curves").lerp(input(&window, "node 14", "curves"), 0.5);
    drag_with(
        &mut window,
        PointerButton::Secondary,
        &way(middle - vec2(6.0, 0.0), middle + vec2(6.0, 0.0), 12),
        Modifiers::NONE,
    );
    assert_eq!(link(&window, "node 14", "curves"), None);
    undo(&mut window);
    let begin = output(&window, "node 3", "curves");
    let half = begin.lerp(input(&window, "node 14", "curves"), 0.5);
    click_at(&mut window, half);
    press(&mut window, Modifiers::NONE, Key::Delete);
    assert_eq!(link(&window, "node 14", "curves"), None, "a selected link goes with Delete");
    assert_eq!(names(&window).len(), COUNT);
    let place = node_middle(&window, "node 61");
    drag_with(&mut window, PointerButton::Secondary, &[place, place], Modifiers::NONE);
    let entry = rect(&window, "Dissolve Ctrl+Backspace").center();
    window.hover_at(entry);
    window.run_steps(4);
    click(&mut window, "Dissolve Ctrl+Backspace");
    assert_eq!(names(&window).len(), COUNT - 1);
}

/// What tests press is what the widget knows, from near and from afar.
#[test]
fn sockets_are_where_the_widget_has_them() {
    let mut window = opened(&graph("vest.ron"));
    let graph_id = egui_graph::id(("canvas", [].as_slice() as &[maquette_graph::NodeId]));
    let mut widths = Vec::new();
    for near in [false, true] {
        for name in ["sorted", "all curves", "body"] {
            let middle = node_middle(&window, name);
            window.hover_at(middle);
            window.run_steps(2);
            if near {
                let wheel = egui::Event::MouseWheel {
                    unit: egui::MouseWheelUnit::Point,
                    delta: vec2(0.0, 250.0),
                    modifiers: Modifiers::COMMAND,
                    phase: egui::TouchPhase::Move,
                };
                window.event(wheel);
                window.run_steps(20);
                let middle = node_middle(&window, name);
                window.hover_at(middle);
                window.run_steps(2);
            }
            let node = find(&window, name);
            let known = egui_graph::with_graph_memory(&window.ctx, graph_id, |memory| {
                memory.node_sockets().get(&egui_graph::NodeId::new(node)).cloned()
            });
            let known = known.unwrap();
            let shown = window.state().node_on_screen(node).unwrap();
            let kind = window.state().document().graph().node(node).unwrap().kind().unwrap().clone();
            let inputs = kind.inputs().iter().enumerate().map(|(index, port)| (known.input(index), &port.name, false));
            let outputs =
                kind.outputs().iter().enumerate().map(|(index, port)| (known.output(index), &port.name, true));
            let mut places = Vec::new();
            for (held, port, output) in inputs.chain(outputs) {
                let place = window.state().socket_on_screen(node, port, output);
                assert_eq!(held.is_some(), place.is_some(), "{name}.{port}");
                places.extend(held.map(|(held, _)| held).zip(place));
            }
            let scale = shown.width() / 192.0;
            assert!(places.len() > 1);
            for pair in places.windows(2) {
                let (on_canvas, on_screen) = (pair[1].0 - pair[0].0, pair[1].1 - pair[0].1);
                assert!((on_canvas * scale - on_screen).length() < 0.5, "{name}: {pair:?}");
            }
            widths.push(shown.width());
            if near {
                press(&mut window, Modifiers::NONE, Key::Home);
                window.run_steps(2);
            }
        }
    }
    assert!(widths[0] < 110.0 && widths[3] > 130.0, "{widths:?}");
}

#[test]
fn selected_nodes_are_lined_up_spread_and_arranged_by_keys_one_step_each() {
    let folder = tempfile::tempdir().unwrap();
    let mut window = many(folder.path());
    let ids = ["node 0", "node 11", "node 22"].map(|name| find(&window, name));
    window.state_mut().ask(ViewCommand::Select(ids.to_vec()));
    window.run_steps(2);
    let middle = canvas(&window).center();
    window.hover_at(middle);
    window.run_steps(2);
    let before = text(&window);
    let positions =
        |window: &Window| ids.map(|id| window.state().document().graph().node(id).unwrap().position().unwrap());
    type Holds = fn(&[[f64; 2]; 3]) -> bool;
    let cases: [(Key, Holds, &str); 6] = [
        (Key::ArrowLeft, |p| p.iter().all(|at| at[0] == 0.0), "align left"),
        (Key::ArrowRight, |p| p.iter().all(|at| at[0] == 520.0), "align right"),
        (Key::ArrowUp, |p| p.iter().all(|at| at[1] == 0.0), "align top"),
        (Key::ArrowDown, |p| p.iter().all(|at| at[1] == 280.0), "align bottom"),
        (Key::H, |p| p[1][0] - p[0][0] == p[2][0] - p[1][0], "distribute across"),
        (Key::V, |p| p[1][1] - p[0][1] == p[2][1] - p[1][1], "distribute down"),
    ];
    for (key, holds, name) in cases {
        press(&mut window, Modifiers::ALT, key);
        assert!(holds(&positions(&window)), "{name}: {:?}", positions(&window));
        assert_eq!(window.state().document().history().undo_name(), Some(name));
        undo(&mut window);
        assert_eq!(text(&window), before, "{name} is one step");
    }
    press(&mut window, Modifiers::SHIFT, Key::L);
    assert_eq!(window.state().document().history().undo_name(), Some("arrange selected"));
    let corner = positions(&window).iter().fold([f64::MAX; 2], |a, b| [a[0].min(b[0]), a[1].min(b[1])]);
    assert_eq!(corner, [0.0, 0.0], "they stay where they were");
    undo(&mut window);
    assert_eq!(text(&window), before);
}

#[test]
fn the_first_two_inputs_are_swapped_by_menu_and_key_or_it_is_said_why_not() {
    let mut window = opened(&graph("vest.ron"));
    let ends = |window: &Window| ["a", "b"].map(|input| link(window, "all curves", input));
    let before = ends(&window);
    let place = node_middle(&window, "all curves");
    drag_with(&mut window, PointerButton::Secondary, &[place, place], Modifiers::NONE);
    click(&mut window, "Swap inputs Alt+S");
    assert_eq!(ends(&window), [before[1].clone(), before[0].clone()]);
    assert_eq!(window.state().document().history().undo_name(), Some("swap inputs"));
    press(&mut window, Modifiers::ALT, Key::S);
    assert_eq!(ends(&window), before);
    window.state_mut().ask(ViewCommand::Find("vest".to_owned()));
    window.run_steps(2);
    let steps = window.state().document().history().position();
    window.state_mut().ask(GraphCommand::Swap);
    window.run_steps(2);
    assert!(message(&window).contains("\"vest\""), "{}", message(&window));
    assert_eq!(window.state().document().history().position(), steps);
}
