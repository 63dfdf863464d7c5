//! The keys and what they do: one list, for the keys themselves and for the sheet that F1 shows.

use egui::{Key, KeyboardShortcut, Modifiers};

use crate::canvas::arrange::Alignment;
use crate::command::{Command, FileCommand, GraphCommand, StrokeDeed, ViewCommand};
use crate::view_state::{Tool, ViewState};

/// A key and what it does.
pub(crate) struct Shortcut {
    pub(crate) group: &'static str,
    modifiers: Modifiers,
    key: Key,
    pub(crate) what: &'static str,
    make: fn(&ViewState) -> Option<Command>,
}

/// The groups of the sheet.
pub(crate) const GROUPS: [&str; 3] = ["File", "Graph", "Views and tools"];

const fn shortcut(
    group: usize,
    modifiers: Modifiers,
    key: Key,
    what: &'static str,
    make: fn(&ViewState) -> Option<Command>,
) -> Shortcut {
    Shortcut { group: GROUPS[group], modifiers, key, what, make }
}

const NONE: Modifiers = Modifiers::NONE;
const COMMAND: Modifiers = Modifiers::COMMAND;
const BOTH: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);

fn align(alignment: Alignment) -> Option<Command> {
    Some(GraphCommand::Align(alignment).into())
}

/// All of them. Longer chords stand before shorter ones of the same key, which would answer first.
pub(crate) const SHORTCUTS: &[Shortcut] = &[
    shortcut(0, COMMAND, Key::N, "new graph", |_| Some(FileCommand::New.into())),
    shortcut(0, COMMAND, Key::O, "open", |_| Some(FileCommand::OpenDialog.into())),
    shortcut(0, BOTH, Key::S, "save as", |_| Some(FileCommand::SaveAsDialog.into())),
    shortcut(0, COMMAND, Key::S, "save", |_| Some(FileCommand::Save.into())),
    shortcut(0, COMMAND, Key::E, "export the results", |_| Some(FileCommand::ExportDialog.into())),
    shortcut(0, COMMAND, Key::Q, "quit", |_| Some(FileCommand::Quit.into())),
    shortcut(0, BOTH, Key::Z, "redo", |_| Some(GraphCommand::Redo.into())),
    shortcut(0, COMMAND, Key::Z, "undo", |_| Some(GraphCommand::Undo.into())),
    shortcut(0, COMMAND, Key::Y, "redo", |_| Some(GraphCommand::Redo.into())),
    shortcut(0, NONE, Key::F1, "this sheet", |_| Some(ViewCommand::Keys.into())),
    shortcut(1, NONE, Key::Tab, "add a node", |_| Some(ViewCommand::Search.into())),
    shortcut(1, Modifiers::SHIFT, Key::A, "add a node", |_| Some(ViewCommand::Search.into())),
    shortcut(1, COMMAND, Key::A, "select all", |_| Some(ViewCommand::SelectAll.into())),
    shortcut(1, BOTH, Key::D, "duplicate with links", |_| Some(GraphCommand::Duplicate { keep_links: true }.into())),
    shortcut(1, COMMAND, Key::D, "duplicate", |_| Some(GraphCommand::Duplicate { keep_links: false }.into())),
    shortcut(1, BOTH, Key::G, "ungroup", |_| Some(GraphCommand::Ungroup.into())),
    shortcut(1, COMMAND, Key::G, "group", |_| Some(GraphCommand::Group.into())),
    shortcut(1, COMMAND, Key::Backspace, "dissolve", |_| Some(GraphCommand::Dissolve.into())),
    shortcut(1, NONE, Key::Delete, "delete: picked strokes, or else the selected nodes", |view| {
        let strokes = view.tool == Tool::Transform && !view.picked_strokes.is_empty();
        Some(if strokes { GraphCommand::Strokes(StrokeDeed::Delete).into() } else { GraphCommand::Delete.into() })
    }),
    shortcut(1, NONE, Key::M, "mute", |_| Some(GraphCommand::Mute.into())),
    shortcut(1, NONE, Key::D, "display", |view| Some(ViewCommand::Display(view.active?).into())),
    shortcut(1, NONE, Key::P, "pin", |view| Some(ViewCommand::Pin(view.active?).into())),
    shortcut(1, Modifiers::SHIFT, Key::L, "arrange selected nodes", |_| Some(GraphCommand::ArrangeSelected.into())),
    shortcut(1, NONE, Key::L, "arrange all nodes", |_| Some(GraphCommand::Arrange.into())),
    shortcut(1, Modifiers::ALT, Key::ArrowLeft, "align left", |_| align(Alignment::Left)),
    shortcut(1, Modifiers::ALT, Key::ArrowRight, "align right", |_| align(Alignment::Right)),
    shortcut(1, Modifiers::ALT, Key::ArrowUp, "align top", |_| align(Alignment::Top)),
    shortcut(1, Modifiers::ALT, Key::ArrowDown, "align bottom", |_| align(Alignment::Bottom)),
    shortcut(1, COMMAND, Key::J, "frame the selected nodes", |_| Some(GraphCommand::Frame.into())),
    shortcut(1, Modifiers::ALT, Key::H, "distribute across", |_| align(Alignment::Across)),
    shortcut(1, NONE, Key::H, "collapse, open out", |_| Some(GraphCommand::Collapse.into())),
    shortcut(1, Modifiers::ALT, Key::V, "distribute down", |_| align(Alignment::Down)),
    shortcut(1, Modifiers::ALT, Key::S, "swap the first two inputs", |_| Some(GraphCommand::Swap.into())),
    shortcut(1, NONE, Key::Enter, "enter the graph within", |view| Some(ViewCommand::Enter(view.active?).into())),
    shortcut(1, NONE, Key::U, "leave it again", |view| {
        Some(ViewCommand::LeaveTo(view.path.len().checked_sub(1)?).into())
    }),
    shortcut(2, NONE, Key::Q, "select", |_| Some(ViewCommand::Take(Tool::Select).into())),
    shortcut(2, NONE, Key::S, "sketch", |_| Some(ViewCommand::Take(Tool::Sketch).into())),
    shortcut(2, NONE, Key::W, "pull", |_| Some(ViewCommand::Take(Tool::Pull).into())),
    shortcut(2, NONE, Key::T, "move, turn and scale strokes", |_| Some(ViewCommand::Take(Tool::Transform).into())),
    shortcut(2, NONE, Key::K, "cut strokes", |_| Some(ViewCommand::Take(Tool::Cut).into())),
    shortcut(2, NONE, Key::O, "select of a mesh by a loop", |_| Some(ViewCommand::Take(Tool::Lasso).into())),
    shortcut(2, NONE, Key::B, "select of a mesh with a brush", |_| Some(ViewCommand::Take(Tool::Paint).into())),
    shortcut(2, NONE, Key::I, "place reference pictures", |_| Some(ViewCommand::Take(Tool::Picture).into())),
    shortcut(2, NONE, Key::E, "erase", |_| Some(ViewCommand::Take(Tool::Erase).into())),
    shortcut(2, NONE, Key::F, "frame selected", |_| Some(ViewCommand::FrameSelected.into())),
    shortcut(2, NONE, Key::A, "frame all", |_| Some(ViewCommand::FrameAll.into())),
    shortcut(2, NONE, Key::Home, "frame all", |_| Some(ViewCommand::FrameAll.into())),
    shortcut(2, NONE, Key::Num5, "with or without perspective", |_| Some(ViewCommand::Parallel.into())),
    shortcut(2, NONE, Key::Space, "maximise what is under the pointer", |_| Some(ViewCommand::Maximise.into())),
    shortcut(2, NONE, Key::Escape, "stop evaluating", |_| Some(ViewCommand::Stop.into())),
];

impl Shortcut {
    /// The keys in words.
    pub(crate) fn keys(&self) -> String {
        let names = egui::ModifierNames::NAMES;
        let modifiers = names.format(&self.modifiers, false);
        if modifiers.is_empty() { self.key.name().to_owned() } else { format!("{modifiers}+{}", self.key.name()) }
    }
}

/// The keys of a command, in words; `None` where it has none.
pub(crate) fn keys_of(command: &Command) -> Option<String> {
    let view = ViewState::default();
    SHORTCUTS.iter().find(|shortcut| (shortcut.make)(&view).as_ref() == Some(command)).map(Shortcut::keys)
}

/// What the keys of this frame ask for. While text is typed, keys are text; away from the canvas, Tab goes from field to field.
/// While something is `searching`, keys are the search's.
pub(crate) fn pressed(context: &egui::Context, view: &ViewState, over_canvas: bool, searching: bool) -> Vec<Command> {
    let typing = searching || context.egui_wants_keyboard_input();
    let mut asked = Vec::new();
    context.input_mut(|input| {
        for shortcut in SHORTCUTS {
            let is_chord = shortcut.modifiers.command || matches!(shortcut.key, Key::F1);
            if typing && (!is_chord || matches!(shortcut.key, Key::A | Key::Z | Key::Y | Key::Backspace)) {
                continue;
            }
            if shortcut.key == Key::Tab && !over_canvas {
                continue;
            }
            if input.consume_shortcut(&KeyboardShortcut::new(shortcut.modifiers, shortcut.key)) {
                asked.extend((shortcut.make)(view));
            }
        }
        if typing {
            return;
        }
        for event in &input.events {
            match event {
                egui::Event::Copy => asked.push(GraphCommand::Copy.into()),
                egui::Event::Cut => asked.push(GraphCommand::Cut.into()),
                egui::Event::Paste(text) => asked.push(GraphCommand::Paste { text: text.clone() }.into()),
                _ => {}
            }
        }
    });
    asked
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_chord_means_one_thing_and_longer_ones_come_first() {
        for (index, shortcut) in SHORTCUTS.iter().enumerate() {
            assert!(GROUPS.contains(&shortcut.group) && !shortcut.what.is_empty());
            for later in &SHORTCUTS[index + 1..] {
                if later.key == shortcut.key {
                    assert_ne!(later.modifiers, shortcut.modifiers, "{}", later.keys());
                    // The earlier one would answer for it.
                    assert!(!later.modifiers.matches_logically(shortcut.modifiers), "{}", later.keys());
                }
            }
        }
    }
}
