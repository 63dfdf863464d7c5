//! The data panel: a click on a row shows in the views what it speaks of.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod support;

use egui_kittest::kittest::Queryable as _;
use maquette_editor::command::ViewCommand;
use support::*;

#[test]
fn a_row_is_picked_sorted_or_not_and_let_go_by_a_second_click_or_another_node() {
    let mut window = opened(&graph("vest.ron"));
    window.state_mut().ask(ViewCommand::Find("sorted".to_owned()));
    window.run_steps(3);
    click(&mut window, "Data");
    settle(&mut window);
    let picked = |window: &Window| window.state().view().picked_row.clone().map(|picked| (picked.table, picked.row));
    click(&mut window, "row 1 of rails");
    assert_eq!(picked(&window), Some(("rails".to_owned(), 1)));
    // By the angle, largest first: the row keeps its number.
    for _ in 0..2 {
        window.get_by_label_contains("angle (").click();
        window.run_steps(3);
    }
    click(&mut window, "row 0 of rails");
    assert_eq!(picked(&window), Some(("rails".to_owned(), 0)));
    click(&mut window, "row 0 of rails");
    assert_eq!(picked(&window), None);
    click(&mut window, "row 2 of rails");
    assert!(picked(&window).is_some());
    window.state_mut().ask(ViewCommand::Find("body".to_owned()));
    window.run_steps(3);
    assert_eq!(picked(&window), None);
}
