//! The order of rails, as `sort` found it, dragged into another one.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod support;

use egui::vec2;
use egui_kittest::kittest::Queryable as _;
use maquette_editor::command::ViewCommand;
use maquette_graph::{Cell, Literal};
use support::*;

fn rails(window: &Window) -> Vec<String> {
    let report = window.state().results().report(find(window, "sorted"));
    let report = report.unwrap_or_else(|| panic!("{:?} of {:?}", failure(window, "sorted"), order(window)));
    let table = report.tables.iter().find(|table| table.name == "rails").unwrap();
    let column = table.columns.iter().position(|column| column.name == "curve").unwrap();
    table
        .rows
        .iter()
        .map(|row| match &row[column] {
            Cell::Text(text) => text.trim_start_matches("curve \"").trim_end_matches('"').to_owned(),
            other => panic!("{other:?}"),
        })
        .collect()
}

fn order(window: &Window) -> Option<String> {
    match literal(window, "sorted", "order")? {
        Literal::Text(text) => Some(text),
        other => panic!("{other:?}"),
    }
}

#[test]
fn an_entry_that_is_dragged_or_moved_by_its_button_pins_the_order_and_as_found_takes_it_back() {
    let mut window = opened(&graph("vest.ron"));
    window.state_mut().ask(ViewCommand::Find("sorted".to_owned()));
    window.run_steps(3);
    // The inspector alone, so that all of the list is seen.
    let name = rect(&window, "name of the node").center_bottom() + vec2(0.0, 8.0);
    window.hover_at(name);
    window.run_steps(2);
    press(&mut window, egui::Modifiers::NONE, egui::Key::Space);
    let found = rails(&window);
    assert!(found.len() > 2 && order(&window).is_none());
    click(&mut window, &format!("move {} down", found[0]));
    settle(&mut window);
    let mut expected = found.clone();
    expected.swap(0, 1);
    assert_eq!(order(&window).unwrap(), expected.join(", "));
    assert_eq!(rails(&window), expected, "{}", message(&window));
    assert_eq!(window.state().document().history().undo_name(), Some("order by hand"));
    click(&mut window, "As found");
    settle(&mut window);
    assert_eq!((rails(&window), order(&window)), (found.clone(), None));
    let place = |window: &Window, index: usize| {
        window.get_by_label(&format!("move {} down", found[index])).rect().right_center()
    };
    let (from, to) = (place(&window, 2) + vec2(30.0, 0.0), place(&window, 0) + vec2(34.0, -6.0));
    drag(&mut window, &way(from, to, 10));
    settle(&mut window);
    let mut expected = found.clone();
    let taken = expected.remove(2);
    expected.insert(0, taken);
    assert_eq!(order(&window).as_deref(), Some(expected.join(", ").as_str()), "{}", message(&window));
}
