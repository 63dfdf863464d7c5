//! Opening, saving, closing. What is not saved is never lost without a question.

use std::path::{Path, PathBuf};

use maquette_geometry::file_format::{FileFormat, encode};
use maquette_graph::file::write_whole;
use maquette_graph::{Edit, Literal};
use maquette_nodes::results::scene;

use crate::app::App;
use crate::command::{FileCommand, FileTarget, GraphCommand};
use crate::dialog::{Asking, Purpose};
use crate::document::Document;
use crate::panel::tour::{self, Tour};
use crate::view_state::{Tool, ViewState};
use crate::viewport::Framing;
use crate::viewport::camera::Direction;

impl App {
    pub(super) fn apply_file(&mut self, context: &egui::Context, command: FileCommand) {
        let replaces = matches!(
            command,
            FileCommand::New | FileCommand::Tour | FileCommand::Open(_) | FileCommand::Recover(_) | FileCommand::Quit
        );
        if replaces && self.document.is_changed() && !self.is_sure {
            self.asking = Some(Asking::Unsaved(command));
            return;
        }
        self.is_sure = false;
        match command {
            FileCommand::New => self.take_document(Document::new(self.choice.clone())),
            FileCommand::Tour => match Document::sample(&self.catalogue, tour::GRAPH, self.choice.clone()) {
                Ok(document) => {
                    self.take_document(document);
                    self.turn_to(Tour::Draw);
                }
                Err(error) => self.complain(error),
            },
            FileCommand::OpenDialog => self.choose(Purpose::Open, self.document.folder(), "ron"),
            FileCommand::Open(path) => match Document::open(&self.catalogue, &path, self.choice.clone()) {
                Ok(document) => {
                    self.settings.remember(&path);
                    self.take_document(document);
                }
                Err(error) => self.complain(error),
            },
            FileCommand::Save => {
                if self.document.path().is_none() {
                    self.choose(Purpose::SaveAs, self.document.folder().join("untitled.ron"), "ron");
                } else {
                    let saved = self.document.save();
                    self.saved(saved);
                }
            }
            FileCommand::SaveAsDialog => {
                let place = self.document.path().map(Path::to_owned);
                let place = place.unwrap_or_else(|| self.document.folder().join("untitled.ron"));
                self.choose(Purpose::SaveAs, place, "ron");
            }
            FileCommand::SaveAs(path) => {
                let saved = self.document.save_as(&path);
                if saved.is_ok() {
                    self.settings.remember(&path);
                }
                self.saved(saved);
            }
            FileCommand::Recover(file) => self.recover(&file),
            FileCommand::Discard(file) => self.recovery.discard(&file),
            FileCommand::Reload => {
                if let Some(path) = self.document.path().map(Path::to_owned) {
                    match Document::open(&self.catalogue, &path, self.choice.clone()) {
                        Ok(document) => self.take_document(document),
                        Err(error) => self.complain(error),
                    }
                }
            }
            FileCommand::Browse { target, extensions } => {
                let folder = self.document.folder();
                let extension = extensions.first().cloned().unwrap_or_default();
                self.choose(Purpose::Name(target), folder, &extension);
            }
            FileCommand::AddReference { view, path } => self.add_reference(view, &path),
            FileCommand::ExportDialog => {
                let name =
                    self.document.path().and_then(Path::file_stem).map(|name| name.to_string_lossy().into_owned());
                let name = format!("{}.glb", name.as_deref().unwrap_or("untitled"));
                self.choose(Purpose::Export, self.document.folder().join(name), "glb");
            }
            FileCommand::ExportTo(path) => match self.export(&path) {
                Ok(written) => self.tell(format!("wrote {written}")),
                Err(error) => self.complain(format!("{}: {error}", path.display())),
            },
            FileCommand::Export { path, text } => match write_whole(&path, text.as_bytes()) {
                Ok(()) => self.tell(format!("wrote {}", path.display())),
                Err(error) => self.complain(error),
            },
            FileCommand::Quit => {
                self.may_close = true;
                context.send_viewport_cmd(egui::ViewportCommand::Close);
            }
        }
    }

    fn choose(&mut self, purpose: Purpose, place: PathBuf, extension: &str) {
        self.asking = Some(Asking::path(purpose, place, extension));
    }

    /// What is to happen with a path that was chosen.
    pub(crate) fn chosen(&mut self, purpose: Purpose, path: PathBuf) {
        match purpose {
            Purpose::Open => self.commands.push(FileCommand::Open(path).into()),
            Purpose::SaveAs => self.commands.push(FileCommand::SaveAs(path).into()),
            Purpose::Export => self.commands.push(FileCommand::ExportTo(path).into()),
            Purpose::Name(FileTarget::Reference(view)) => {
                self.commands.push(FileCommand::AddReference { view, path }.into());
            }
            Purpose::Name(target) => {
                let file = Literal::File(relative(&path, &self.document.folder()));
                let edit = match target {
                    FileTarget::Input { node, input } => Edit::set(node, input, file),
                    FileTarget::Parameter(parameter) => Edit::SetParameter { parameter, literal: Some(file) },
                    FileTarget::Reference(_) => return,
                };
                self.commands.push(GraphCommand::edit(edit).into());
            }
        }
    }

    /// Puts a picture behind the strokes of a view, in the middle of what it shows.
    fn add_reference(&mut self, view: Direction, path: &Path) {
        let folder = self.document.folder();
        let file = relative(path, &folder);
        // Said now, and not only when the graph is opened the next time.
        if let Err(outside) = self.document.project().check(&folder.join(&file)) {
            self.complain(outside);
            return;
        }
        let placed = self.views.iter().find(|pane| pane.camera.direction == view).and_then(|pane| pane.placed(file));
        let Some(picture) = placed else {
            self.complain("a reference picture stands in the front, side or top view: choose one of these");
            return;
        };
        let mut pictures = self.document.graph().references().to_vec();
        pictures.push(picture);
        let name = "add a reference picture".to_owned();
        self.commands.push(GraphCommand::References { name, pictures, gesture: None }.into());
        self.view.tool = Tool::Picture;
    }

    /// Writes the results as they were evaluated last, and says which files.
    fn export(&self, path: &Path) -> Result<String, String> {
        let targets = self.document.graph().results();
        let evaluation = self.results.evaluation().filter(|_| self.results.is_current());
        let evaluation = evaluation.ok_or("the graph is still evaluated: wait until it is done")?;
        if let Some(missing) = targets.iter().find(|id| evaluation.values(**id).is_none()) {
            let name = self.document.graph().node(*missing).map_or("", |node| node.name());
            return Err(format!("the result \"{name}\" is not there: mend what failed, or show the results again"));
        }
        let format = FileFormat::from_path(&path.to_string_lossy()).map_err(|error| error.to_string())?;
        let files = encode(path, format, &scene(evaluation, &targets)).map_err(|error| error.to_string())?;
        let mut written = Vec::new();
        for (path, bytes) in files {
            write_whole(&path, &bytes).map_err(|error| error.to_string())?;
            written.push(path.display().to_string());
        }
        Ok(written.join(", "))
    }

    fn saved(&mut self, saved: Result<(), crate::document::DocumentSaveError>) {
        match saved {
            Ok(()) => {
                self.recovery.forget();
                let name = self.document.name();
                self.tell(format!("saved {name}"));
                if let Some(after) = self.after_saving.take() {
                    self.commands.push(after.into());
                }
            }
            Err(error) => {
                self.after_saving = None;
                self.complain(error);
            }
        }
    }

    fn recover(&mut self, file: &Path) {
        let left = self.recovery.read(file);
        let document = left.and_then(|left| {
            let path = left.path.as_deref();
            Document::recover(&self.catalogue, &left.text, path, self.choice.clone()).map_err(|error| error.to_string())
        });
        match document {
            Ok(document) => {
                self.take_document(document);
                // Only when the work lies in a file of this session is the other one no longer needed.
                if self.recovery.save(&self.document) {
                    self.recovery.discard(file);
                }
                self.tell("recovered: save it to keep it");
            }
            Err(error) => self.complain(error),
        }
    }

    /// Takes another document, with nothing left of the one before.
    pub(crate) fn take_document(&mut self, document: Document) {
        self.recovery.forget();
        self.document = document;
        let tool = self.view.tool;
        self.view = ViewState { tool, ..ViewState::default() };
        self.canvas.clear();
        self.results.clear();
        self.worker.clear();
        self.submitted = None;
        self.views.iter_mut().for_each(|view| view.framing = Framing::All);
    }
}

/// A path as the graph writes it: seen from its folder where it lies below, with forward slashes.
fn relative(path: &Path, folder: &Path) -> String {
    let whole = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let (path, folder) = (whole(path), whole(folder));
    path.strip_prefix(&folder).unwrap_or(&path).to_string_lossy().replace('\\', "/")
}
