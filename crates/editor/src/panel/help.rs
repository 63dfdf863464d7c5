//! The page of a node kind, from its own strings; and the keyboard sheet.

use egui::{RichText, Ui};
use maquette_graph::NodeKind;

use crate::panel::PanelContext;
use crate::shortcuts::{GROUPS, SHORTCUTS};

/// The page of the active node's kind.
pub(crate) fn show(ui: &mut Ui, context: &PanelContext<'_>) {
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        match context.active().and_then(|(_, node)| node.kind()) {
            Some(kind) => page(ui, kind),
            None => {
                ui.label(RichText::new("Select a node to read what its kind does. F1 shows all keys.").weak());
            }
        }
    });
}

fn page(ui: &mut Ui, kind: &NodeKind) {
    ui.heading(kind.name());
    ui.label(RichText::new(format!("{} · version {}", kind.category(), kind.version())).weak());
    ui.label(kind.description());
    if !kind.reference_text().is_empty() {
        ui.label(RichText::new(format!("After {}.", kind.reference_text())).italics());
    }
    let part = |ui: &mut Ui, title: &str| {
        ui.add_space(6.0);
        ui.label(RichText::new(title).strong().size(15.0));
    };
    if !kind.inputs().is_empty() {
        part(ui, "Inputs");
    }
    for input in kind.inputs() {
        let default = input.default.as_ref().map(|default| format!(", default {}", default.to_value().summary()));
        let range = input.range.map(|range| format!(", {range}"));
        let unit = if input.unit == maquette_graph::Unit::None { String::new() } else { format!(" {}", input.unit) };
        let facts = format!("{}{}{}{unit}", input.wire, default.unwrap_or_default(), range.unwrap_or_default());
        entry(ui, &input.name, &facts, &input.description);
        for option in &input.options {
            ui.indent(("option", &option.name), |ui| {
                ui.label(RichText::new(format!("{}: {}", option.name, option.description)).weak())
            });
        }
    }
    if !kind.outputs().is_empty() {
        part(ui, "Outputs");
    }
    for output in kind.outputs() {
        entry(ui, &output.name, &output.wire.to_string(), &output.description);
    }
    if !kind.figures().is_empty() || !kind.tables().is_empty() {
        part(ui, "Measured");
    }
    for figure in kind.figures() {
        entry(ui, &figure.name, &figure.unit.to_string(), &figure.description);
    }
    for table in kind.tables() {
        entry(ui, &table.name, "table", &table.description);
    }
}

/// Which version this is; says whether it stays open.
pub(crate) fn about(context: &egui::Context) -> bool {
    let mut open = true;
    let window = egui::Window::new("About Maquette").open(&mut open).collapsible(false).resizable(false);
    window.anchor(egui::Align2::CENTER_CENTER, [0.0, 0.0]).show(context, |ui| {
        ui.set_width(320.0);
        ui.label(RichText::new(concat!("Maquette ", env!("CARGO_PKG_VERSION"))).strong().size(16.0));
        ui.label(env!("CARGO_PKG_DESCRIPTION"));
        ui.label(RichText::new(concat!("Licence: ", env!("CARGO_PKG_LICENSE"))).weak());
    });
    open
}

fn entry(ui: &mut Ui, name: &str, facts: &str, description: &str) {
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new(name).strong());
        ui.label(RichText::new(facts).weak().size(11.0));
    });
    ui.label(description);
    ui.add_space(3.0);
}

/// The keyboard sheet; says whether it stays open.
pub(crate) fn keys(ui: &mut Ui) -> bool {
    let mut open = true;
    let window = egui::Window::new("Keyboard").open(&mut open).collapsible(false).resizable(false);
    window.anchor(egui::Align2::CENTER_CENTER, [0.0, 0.0]).show(ui.ctx(), |ui| {
        ui.columns(GROUPS.len(), |columns| {
            for (group, ui) in GROUPS.iter().zip(columns) {
                ui.label(RichText::new(*group).strong());
                for shortcut in SHORTCUTS.iter().filter(|shortcut| shortcut.group == *group) {
                    ui.horizontal(|ui| {
                        ui.label(RichText::new(shortcut.keys()).monospace().size(11.5));
                        ui.label(RichText::new(shortcut.what).size(12.0));
                    });
                }
            }
        });
        ui.separator();
        ui.label("Views: middle drag turns, Shift+middle or right drag moves, wheel zooms; Alt+left drag turns too.");
        ui.label("Canvas: middle drag moves, wheel zooms, right drag cuts links; drag a link into the void to add what fits.");
    });
    open
}
