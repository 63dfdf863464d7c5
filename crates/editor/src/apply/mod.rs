//! The one place that changes anything: commands are applied here, after all widgets were shown.

mod file;
mod graph;
mod selecting;
mod strokes;
mod view;

use crate::app::App;
use crate::command::{Command, Message};

impl App {
    /// Applies what was asked for in this frame, in its order.
    pub(crate) fn apply_all(&mut self, context: &egui::Context) {
        while !self.commands.is_empty() {
            for command in std::mem::take(&mut self.commands) {
                self.apply(context, command);
            }
        }
        let Self { document, view, .. } = self;
        view.prune(document.graph(), |path| document.graph_at(path).is_some());
    }

    fn apply(&mut self, context: &egui::Context, command: Command) {
        match command {
            Command::Graph(command) => self.apply_graph(context, command),
            Command::View(command) => self.apply_view(context, command),
            Command::File(command) => self.apply_file(context, command),
            Command::Say(message) => self.view.message = Some(message),
        }
    }

    /// Tells the artist what went wrong.
    pub(crate) fn complain(&mut self, error: impl std::fmt::Display) {
        self.view.message = Some(Message::error(error.to_string()));
    }

    pub(crate) fn tell(&mut self, text: impl Into<String>) {
        self.view.message = Some(Message::note(text));
    }
}
