//! What is seen at the first start: the examples, what was opened last, and the way to the tour.

use std::path::{Path, PathBuf};

use egui::{RichText, Ui};
use maquette_graph::Catalogue;

use crate::app::is_graph;
use crate::command::{Command, FileCommand, ViewCommand};
use crate::document::{Document, ProjectChoice};

/// A graph that is offered.
struct Example {
    path: PathBuf,
    name: String,
    /// The first sentence of its notes; `None` before it was read.
    about: Option<String>,
}

/// The examples. What they are about is read one file a frame, so that the window is there at once.
#[derive(Default)]
pub(crate) struct Welcome {
    examples: Option<Vec<Example>>,
}

/// The graphs of a folder, or, where it has none, of the folder `graphs` in it: the examples, in a copy of the repository.
pub(crate) fn graphs_in(folder: &Path) -> Vec<PathBuf> {
    let graphs = |folder: &Path| {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let mut graphs: Vec<_> = entries.map(|entry| entry.path()).filter(|path| is_graph(path)).collect();
        graphs.sort();
        graphs
    };
    let here = graphs(folder);
    if here.is_empty() { graphs(&folder.join("graphs")) } else { here }
}

/// The examples: in the folder `graphs` of where the program runs, or beside the program.
fn examples() -> Vec<PathBuf> {
    let beside = std::env::current_exe().ok().and_then(|program| Some(program.parent()?.join("graphs")));
    let here = Some(PathBuf::from("graphs"));
    here.into_iter().chain(beside).map(|folder| graphs_in(&folder)).find(|found| !found.is_empty()).unwrap_or_default()
}

/// The first sentence of a text: up to a full stop at the end of a word, or all of it.
fn first_sentence(text: &str) -> String {
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    // "e.g. this" and "Fig. 3" go on.
    let begins = |at: &usize| text[at + 2..].starts_with(|next: char| !next.is_lowercase() && !next.is_numeric());
    let end = text.match_indices(". ").map(|(at, _)| at).find(begins);
    end.map_or(text.as_str(), |at| &text[..=at]).to_owned()
}

impl Welcome {
    /// Reads what the next example is about; says whether there are more.
    fn read_on(&mut self, catalogue: &Catalogue) -> bool {
        let examples = self.examples.get_or_insert_with(|| {
            let name =
                |path: &Path| path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
            examples().into_iter().map(|path| Example { name: name(&path), path, about: None }).collect()
        });
        let Some(next) = examples.iter_mut().find(|example| example.about.is_none()) else { return false };
        let read = Document::open(catalogue, &next.path, ProjectChoice::default());
        next.about = Some(match read {
            Ok(document) => first_sentence(&document.graph().notes),
            Err(error) => error.to_string(),
        });
        true
    }

    /// Shows it in the middle of the window; says whether it stays open.
    pub(crate) fn show(
        &mut self,
        context: &egui::Context,
        catalogue: &Catalogue,
        recent: &[PathBuf],
        commands: &mut Vec<Command>,
    ) -> bool {
        if self.read_on(catalogue) {
            context.request_repaint();
        }
        let mut open = true;
        let mut stays = true;
        let size = context.content_rect().size();
        let window = egui::Window::new("Welcome to Maquette").open(&mut open).collapsible(false).resizable(false);
        let window = window
            .anchor(egui::Align2::CENTER_CENTER, [0.0, 0.0])
            .fixed_size(egui::vec2(680.0, 440.0).min(size - egui::vec2(60.0, 120.0)));
        window.show(context, |ui| {
            ui.label(RichText::new("Sketched curves become 3D characters, through a graph of nodes.").weak());
            ui.add_space(8.0);
            let mut asked: Option<Command> = None;
            ui.horizontal_top(|ui| {
                ui.vertical(|ui| {
                    ui.set_width(190.0);
                    asked = start(ui, recent);
                });
                ui.separator();
                ui.vertical(|ui| {
                    let chosen = self.list(ui);
                    asked = chosen.map(|path| FileCommand::Open(path).into()).or(asked.take());
                });
            });
            if let Some(command) = asked {
                commands.push(command);
                stays = false;
            }
        });
        open && stays
    }

    fn list(&self, ui: &mut Ui) -> Option<PathBuf> {
        ui.label(RichText::new("Examples").strong());
        let examples = self.examples.as_deref().unwrap_or_default();
        if examples.is_empty() {
            ui.label(RichText::new("There is no folder \"graphs\" here or beside the program.").weak());
        }
        let mut chosen = None;
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            for example in examples {
                let about = example.about.as_deref().unwrap_or("…");
                let width = ui.available_width();
                let response = row(ui, &example.name, about, width);
                response.widget_info(|| {
                    let label = format!("example {}", example.name);
                    egui::WidgetInfo::labeled(egui::WidgetType::Button, true, label)
                });
                if response.on_hover_text(about).clicked() {
                    chosen = Some(example.path.clone());
                }
            }
        });
        chosen
    }
}

/// A name with what it is about below, to click on.
fn row(ui: &mut Ui, name: &str, about: &str, width: f32) -> egui::Response {
    let mut job = egui::text::LayoutJob::default();
    let visuals = ui.visuals();
    let format = |size, colour| egui::TextFormat::simple(egui::FontId::proportional(size), colour);
    job.append(name, 0.0, format(14.0, visuals.strong_text_color()));
    job.append("\n", 0.0, format(4.0, visuals.text_color()));
    job.append(about, 0.0, format(12.0, visuals.weak_text_color()));
    job.wrap.max_width = width - 16.0;
    job.wrap.max_rows = 4;
    ui.add(egui::Button::new(job).frame_when_inactive(false).min_size(egui::vec2(width, 0.0)))
}

/// New, open, the tour, and what was opened last.
fn start(ui: &mut Ui, recent: &[PathBuf]) -> Option<Command> {
    let mut asked = None;
    let wide = egui::vec2(ui.available_width(), 30.0);
    if ui.add(egui::Button::new(RichText::new("Take the tour").strong()).min_size(wide)).clicked() {
        asked = Some(FileCommand::Tour.into());
    }
    if ui.add(egui::Button::new("New graph").min_size(wide)).clicked() {
        asked = Some(FileCommand::New.into());
    }
    if ui.add(egui::Button::new("Open a graph…").min_size(wide)).clicked() {
        asked = Some(FileCommand::OpenDialog.into());
    }
    if ui.add(egui::Button::new("All keys").min_size(wide)).clicked() {
        asked = Some(ViewCommand::Keys.into());
    }
    if !recent.is_empty() {
        ui.add_space(10.0);
        ui.label(RichText::new("Opened last").strong());
        for path in recent {
            let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
            if ui.link(name).on_hover_text(path.display().to_string()).clicked() {
                asked = Some(FileCommand::Open(path.clone()).into());
            }
        }
    }
    asked
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_sentence_ends_at_a_full_stop() {
        assert_eq!(first_sentence("A leg (Figure 5.2). It bends."), "A leg (Figure 5.2).");
        assert_eq!(first_sentence("Half,\nas in Fig. 6 of it. More"), "Half, as in Fig. 6 of it.");
        assert_eq!(first_sentence("No. 3 e.g. this"), "No. 3 e.g. this");
        assert_eq!(first_sentence(""), "");
    }
}
