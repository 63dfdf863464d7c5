//! Inside a group one sees what its nodes give.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod support;

use egui::{Key, Modifiers};
use maquette_editor::command::ViewCommand;
use maquette_graph::{Literal, NodeId};
use support::*;

fn inner(window: &Window, group: &str, node: &str) -> (Vec<NodeId>, NodeId) {
    let id = find(window, group);
    let graph = window.state().document().graph().node(id).unwrap().body().unwrap().graph().unwrap();
    (vec![id], graph.find(node).unwrap())
}

/// The hash of the first output of a node of a group.
fn hash_within(window: &Window, group: &str, node: &str) -> Option<u128> {
    let (path, id) = inner(window, group, node);
    Some(window.state().results().evaluation_within(&path)?.values(id)?.first()?.hash().0)
}

#[test]
fn a_node_of_a_group_is_looked_at_displayed_and_picked() {
    let mut window = opened(&graph("warrior.ron"));
    assert_eq!(hash_within(&window, "helmet", "bowl"), None, "nobody asked");
    window.state_mut().ask(ViewCommand::Find("helmet/bowl".to_owned()));
    settle(&mut window);
    let looked = hash_within(&window, "helmet", "bowl");
    assert!(looked.is_some(), "the inspector shows it");
    // Nothing ran again for it: the group's run had made it.
    assert_eq!(window.state().results().evaluation().unwrap().run_count(), 0);
    // Alone in the views, until it is shown no longer.
    let (_, bowl) = inner(&window, "helmet", "bowl");
    window.hover_at(canvas(&window).center());
    window.run_steps(2);
    press(&mut window, Modifiers::NONE, Key::D);
    settle(&mut window);
    assert_eq!(window.state().view().displayed_within, Some(bowl));
    press(&mut window, Modifiers::NONE, Key::Q);
    window.state_mut().ask(ViewCommand::Select(Vec::new()));
    window.state_mut().ask(ViewCommand::FrameAll);
    window.hover_at(rect(&window, "Front view").center());
    window.run_steps(3);
    settle(&mut window);
    press(&mut window, Modifiers::NONE, Key::Home);
    window.run_steps(3);
    // The bowl fills the view now, and a click on it selects it.
    let centre = rect(&window, "Front view").center();
    click_at(&mut window, centre);
    settle(&mut window);
    assert_eq!(window.state().view().active, Some(bowl), "{}", message(&window));
    // What it depends on changes: it follows.
    let before = hash_within(&window, "helmet", "bowl");
    let (path, dome) = inner(&window, "helmet", "dome");
    assert_eq!(path, window.state().view().path);
    let edit = maquette_graph::Edit::set(dome, "k_s", Literal::Number(30.0));
    let command = maquette_editor::command::GraphCommand::edit(edit);
    window.state_mut().ask(command);
    window.run_steps(2);
    settle(&mut window);
    assert_ne!(hash_within(&window, "helmet", "bowl"), before, "{}", message(&window));
    // Outside again, the whole is shown.
    press(&mut window, Modifiers::NONE, Key::U);
    settle(&mut window);
    assert_eq!(window.state().view().displayed_within, None);
}
