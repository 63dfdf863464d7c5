//! Everything that can be clicked, dragged or typed into has a name for those who do not see it, in every panel, and the
//! keyboard gets there.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod support;

use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use maquette_editor::Options;
use maquette_editor::command::ViewCommand;
use support::*;

/// What has no name among all that answers to a click, a drag or typing.
fn nameless(window: &Window, panel: &str) -> Vec<String> {
    let speaks = |role: Role| {
        matches!(
            role,
            Role::Button
                | Role::CheckBox
                | Role::ComboBox
                | Role::ColorWell
                | Role::Link
                | Role::MultilineTextInput
                | Role::RadioButton
                | Role::Slider
                | Role::SpinButton
                | Role::TextInput
        )
    };
    let mut found = Vec::new();
    let mut asked = 0;
    for node in window.root().children_recursive() {
        let known = node.accesskit_node();
        if !speaks(known.role()) {
            continue;
        }
        asked += 1;
        let label = known.label().unwrap_or_default();
        if label.trim().is_empty() {
            found.push(format!("{panel}: {:?} at {:?}", known.role(), node.rect()));
        }
    }
    assert!(asked > 10, "{panel}: {asked}");
    found
}

#[test]
fn every_button_slider_and_field_of_every_panel_has_a_name() {
    let mut found = Vec::new();
    let mut window = opened(&graph("vest.ron"));
    found.extend(nameless(&window, "whole graph"));
    for tab in ["Palette", "History", "Performance", "Data", "Problems"] {
        click(&mut window, tab);
        found.extend(nameless(&window, tab));
    }
    click(&mut window, "Inspector");
    for node in ["side rail", "sorted", "body", "surface", "vest", "tilted neckline"] {
        window.state_mut().ask(ViewCommand::Find(node.to_owned()));
        window.run_steps(3);
        found.extend(nameless(&window, node));
        click(&mut window, "Data");
        settle(&mut window);
        found.extend(nameless(&window, &format!("data of {node}")));
    }
    for menu in ["File", "Edit", "View", "Window"] {
        window.get_by_label(menu).click();
        window.run_steps(3);
        found.extend(nameless(&window, menu));
        press(&mut window, Modifiers::NONE, Key::Escape);
    }
    for tool in ["Sketch", "Pull", "Transform", "Picture"] {
        click(&mut window, &format!("{tool} tool"));
        found.extend(nameless(&window, tool));
    }
    press(&mut window, Modifiers::NONE, Key::F1);
    found.extend(nameless(&window, "keys"));
    let mut fresh = self::window(Options { welcome: true, ..Options::default() });
    found.extend(nameless(&fresh, "welcome"));
    click(&mut fresh, "Open a graph…");
    found.extend(nameless(&fresh, "question"));
    found.sort();
    found.dedup();
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn the_keyboard_goes_through_all_of_the_window_and_acts_on_what_it_is_at() {
    let mut window = opened(&graph("vest.ron"));
    window.run_steps(2);
    let mut seen = std::collections::BTreeSet::new();
    for _ in 0..160 {
        window.key_press_modifiers(Modifiers::NONE, Key::Tab);
        window.run_steps(1);
        let focused = window.root().children_recursive().find(|node| node.accesskit_node().is_focused());
        let label = focused.and_then(|node| node.accesskit_node().label());
        if label.as_deref() == Some("node surface") {
            press(&mut window, Modifiers::NONE, Key::Enter);
            assert_eq!(window.state().view().active, Some(find(&window, "surface")), "Enter selects it");
        }
        seen.extend(label);
    }
    assert!(window.state().view().active.is_some());
    for label in
        ["File", "Help", "Sketch tool", "Shaded", "Inspector", "History", "node side rail", "node vest", "canvas"]
    {
        assert!(seen.contains(label), "{label} is not reached: {seen:#?}");
    }
}
