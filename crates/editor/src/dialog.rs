//! Questions in front of everything else: unsaved work, a path, work that was left behind.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use egui::{RichText, Ui};
use maquette_geometry::file_format::FileFormat;

use crate::command::{FileCommand, FileTarget};
use crate::recovery::Left;

/// What a path is asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// A graph to open.
    Open,
    /// A file to save into.
    SaveAs,
    /// A file that the graph names.
    Name(FileTarget),
    /// A file to write results into.
    Export,
}

impl Purpose {
    /// Whether a file is written.
    fn writes(&self) -> bool {
        matches!(self, Self::SaveAs | Self::Export)
    }
}

/// A question that is open.
pub(crate) enum Asking {
    /// What is to happen with unsaved work before this.
    Unsaved(FileCommand),
    /// Whether to read the file again, which another program changed.
    ChangedOnDisk,
    /// A path.
    Path(PathQuestion),
}

/// A question for a path. It can be typed, or chosen in the dialog of the system.
pub(crate) struct PathQuestion {
    purpose: Purpose,
    text: String,
    extension: String,
    fresh: bool,
    /// The answer of the system's dialog, which has a thread of its own.
    browsing: Option<Receiver<Option<PathBuf>>>,
    /// Whether a file that is there may be replaced.
    sure: bool,
}

/// What was answered.
pub(crate) enum Answer {
    /// Save, then go on.
    SaveFirst(FileCommand),
    /// Go on, and give the work up.
    GiveUp(FileCommand),
    /// A path.
    Path(Purpose, PathBuf),
    /// Read the file again.
    Reload,
    /// Nothing is to happen.
    Nothing,
}

impl Asking {
    pub(crate) fn path(purpose: Purpose, place: PathBuf, extension: &str) -> Self {
        let text = match purpose {
            Purpose::SaveAs | Purpose::Export => place.display().to_string(),
            _ => format!("{}/", place.display()),
        };
        let extension = extension.to_owned();
        Self::Path(PathQuestion { purpose, text, extension, fresh: true, browsing: None, sure: false })
    }

    /// Shows the question; `None` as long as it is not answered.
    pub(crate) fn show(&mut self, context: &egui::Context, document: &str) -> Option<Answer> {
        let mut answer = None;
        let modal = egui::Modal::new(egui::Id::new("question")).show(context, |ui| {
            ui.set_width(430.0);
            answer = match self {
                Self::Unsaved(command) => unsaved(ui, document, command),
                Self::ChangedOnDisk => changed_on_disk(ui, document),
                Self::Path(question) => question.show(ui),
            };
        });
        if modal.should_close() && answer.is_none() { Some(Answer::Nothing) } else { answer }
    }
}

fn unsaved(ui: &mut Ui, document: &str, command: &FileCommand) -> Option<Answer> {
    ui.heading(format!("Save {document} first?"));
    ui.label("It has changes that no file has.");
    ui.add_space(8.0);
    ui.horizontal(|ui| {
        if ui.button("Save").clicked() {
            return Some(Answer::SaveFirst(command.clone()));
        }
        if ui.button("Don't save").clicked() {
            return Some(Answer::GiveUp(command.clone()));
        }
        ui.button("Cancel").clicked().then_some(Answer::Nothing)
    })
    .inner
}

fn changed_on_disk(ui: &mut Ui, document: &str) -> Option<Answer> {
    ui.heading(format!("{document} changed on disk"));
    ui.label("Another program wrote the file. Reading it again gives up what you changed here since you saved.");
    ui.add_space(8.0);
    ui.horizontal(|ui| {
        if ui.button("Read it again").clicked() {
            return Some(Answer::Reload);
        }
        ui.button("Keep what is here").clicked().then_some(Answer::Nothing)
    })
    .inner
}

impl PathQuestion {
    fn show(&mut self, ui: &mut Ui) -> Option<Answer> {
        ui.heading(match self.purpose {
            Purpose::Open => "Open a graph",
            Purpose::SaveAs => "Save as",
            Purpose::Name(_) => "Choose a file",
            Purpose::Export => "Export the results as .glb, .gltf, .obj, .ply or .json",
        });
        let field = ui.add(egui::TextEdit::singleline(&mut self.text).desired_width(f32::INFINITY));
        field.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::TextEdit, true, "path"));
        let entered = field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
        if field.changed() {
            self.sure = false;
        }
        if std::mem::take(&mut self.fresh) {
            field.request_focus();
        }
        let path = PathBuf::from(self.text.trim());
        let problem = self.problem(&path);
        if let Some(problem) = &problem {
            ui.label(RichText::new(problem).color(ui.visuals().warn_fg_color));
        }
        let replaces = self.purpose.writes() && path.is_file();
        if replaces {
            ui.checkbox(&mut self.sure, format!("replace {}", path.display()));
        }
        self.listen();
        ui.add_space(8.0);
        ui.horizontal(|ui| {
            let ready = problem.is_none() && (!replaces || self.sure);
            let word = if self.purpose.writes() { "Save" } else { "Open" };
            if ui.add_enabled(ready, egui::Button::new(word)).clicked() || (entered && ready) {
                return Some(Answer::Path(self.purpose.clone(), path));
            }
            let waiting = self.browsing.is_some();
            if ui
                .add_enabled(!waiting, egui::Button::new("Browse…"))
                .on_hover_text("The dialog of the system")
                .clicked()
            {
                self.browse(ui.ctx(), &path);
            }
            ui.button("Cancel").clicked().then_some(Answer::Nothing)
        })
        .inner
    }

    /// Why a path won't do, in words.
    fn problem(&self, path: &Path) -> Option<String> {
        let folder = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        match self.purpose {
            Purpose::SaveAs | Purpose::Export if path.is_dir() || path.file_name().is_none() => {
                Some("give it a name".to_owned())
            }
            Purpose::SaveAs | Purpose::Export if !folder.is_dir() => {
                Some(format!("there is no folder {}", folder.display()))
            }
            Purpose::Export => FileFormat::from_path(&path.to_string_lossy()).err().map(|error| error.to_string()),
            Purpose::SaveAs => None,
            _ if path.is_file() => None,
            _ if path.is_dir() => Some("choose a file in this folder".to_owned()),
            _ => Some("there is no such file".to_owned()),
        }
    }

    /// Opens the system's dialog on a thread of its own: the window goes on.
    fn browse(&mut self, context: &egui::Context, path: &Path) {
        let (sender, receiver) = channel();
        let mut dialog = rfd::FileDialog::new();
        let folder = if path.is_dir() { Some(path) } else { path.parent() };
        if let Some(folder) = folder.filter(|folder| folder.is_dir()) {
            dialog = dialog.set_directory(folder);
        }
        if !self.extension.is_empty() {
            dialog = dialog.add_filter(&self.extension, &[&self.extension]);
        }
        let saves = self.purpose.writes();
        let context = context.clone();
        let thread = std::thread::Builder::new().name("file dialog".to_owned()).spawn(move || {
            let chosen = if saves { dialog.save_file() } else { dialog.pick_file() };
            // Nobody may listen any more.
            drop(sender.send(chosen));
            context.request_repaint();
        });
        if thread.is_ok() {
            self.browsing = Some(receiver);
        }
    }

    fn listen(&mut self) {
        match self.browsing.as_ref().map(Receiver::try_recv) {
            Some(Ok(Some(path))) => {
                self.text = path.display().to_string();
                // The system's dialog asked already.
                self.sure = true;
                self.browsing = None;
            }
            Some(Ok(None) | Err(TryRecvError::Disconnected)) => self.browsing = None,
            Some(Err(TryRecvError::Empty)) | None => {}
        }
    }
}

/// Offers work that was left behind.
pub(crate) fn offer(ui: &mut Ui, left: &[Left]) -> Option<FileCommand> {
    let mut asked = None;
    for work in left {
        ui.horizontal(|ui| {
            let text = format!("The editor ended suddenly while {} had unsaved changes.", work.name);
            ui.label(RichText::new(text).color(ui.visuals().warn_fg_color));
            if ui.button(format!("Recover {}", work.name)).clicked() {
                asked = Some(FileCommand::Recover(work.file.clone()));
            }
            if ui.button(format!("Discard {}", work.name)).clicked() {
                asked = Some(FileCommand::Discard(work.file.clone()));
            }
        });
    }
    asked
}
