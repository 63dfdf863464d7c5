//! The application: state in three parts, panels that show it, and the loop that brings them together.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use egui_tiles::Tree;
use maquette_graph::{Catalogue, NodeId};

use crate::canvas::Canvas;
use crate::command::{Command, FileCommand};
use crate::dialog::{Answer, Asking};
use crate::dock::{self, Pane};
use crate::document::{Document, ProjectChoice};
use crate::drawable::Depiction;
use crate::evaluation_worker::{EvaluationWorker, Job};
use crate::panel::data::Data;
use crate::panel::inspector::Inspector;
use crate::panel::palette::Palette;
use crate::panel::tour;
use crate::panel::welcome::Welcome;
use crate::recovery::Recovery;
use crate::reference_pictures::ReferencePictures;
use crate::results::Results;
use crate::shortcuts;
use crate::view_state::{Settings, ViewState};
use crate::viewport::camera::Direction;
use crate::viewport::picture::Shading;
use crate::viewport::{Graphics, ViewPane, gpu};

/// How often the window looks whether another program wrote the file.
const LOOK_AT_DISK: Duration = Duration::from_secs(2);

/// How the editor is started.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The graph to open.
    pub path: Option<PathBuf>,
    /// Which files graphs may read.
    pub project: ProjectChoice,
    /// Where unsaved work is put aside; `None` for nowhere.
    pub recovery: Option<PathBuf>,
    /// Whether examples and a tour are offered where no graph is given and none was opened before.
    pub welcome: bool,
}

/// Why the editor could not be started.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// The node kinds of this program contradict each other.
    #[error("the node kinds of this program can't be used: {0}")]
    Catalogue(#[from] maquette_graph::CatalogueError),
    /// The system gives no thread.
    #[error("no thread can be started to evaluate graphs: {0}")]
    Thread(#[from] std::io::Error),
}

/// What an evaluation depends on; while it stays, nothing is evaluated.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Wanted {
    revision: u64,
    targets: Vec<NodeId>,
    path: Vec<NodeId>,
    within: Vec<NodeId>,
    depiction: Depiction,
    examined: Vec<NodeId>,
}

/// The editor.
pub struct App {
    pub(crate) catalogue: Arc<Catalogue>,
    pub(crate) choice: ProjectChoice,
    pub(crate) document: Document,
    pub(crate) view: ViewState,
    pub(crate) settings: Settings,
    pub(crate) results: Results,
    pub(crate) worker: EvaluationWorker,
    pub(crate) submitted: Option<Wanted>,
    generation: u64,
    pub(crate) canvas: Canvas,
    pub(crate) views: [ViewPane; 4],
    pub(crate) inspector: Inspector,
    pub(crate) palette: Palette,
    pub(crate) data: Data,
    pub(crate) welcome: Welcome,
    pub(crate) tree: Tree<Pane>,
    pub(crate) maximised: Option<Pane>,
    /// The panel under the pointer.
    pub(crate) hovered: Option<Pane>,
    pub(crate) graphics: Graphics,
    pub(crate) commands: Vec<Command>,
    pub(crate) asking: Option<Asking>,
    pub(crate) recovery: Recovery,
    pub(crate) pictures: ReferencePictures,
    /// Whether unsaved work was given up by an answer.
    pub(crate) is_sure: bool,
    pub(crate) after_saving: Option<FileCommand>,
    pub(crate) may_close: bool,
    looked_at_disk: f64,
}

impl App {
    /// Starts the editor in a window.
    ///
    /// # Errors
    /// No thread for the evaluation. A graph that can't be opened is said in the window, which then has an empty one.
    pub fn new(context: &eframe::CreationContext<'_>, options: Options) -> Result<Self, StartError> {
        let catalogue = Arc::new(maquette_nodes::catalogue()?);
        let repaint = context.egui_ctx.clone();
        let worker = EvaluationWorker::start(catalogue.clone(), move || repaint.request_repaint())?;
        let stored = |key| context.storage.and_then(|storage| storage.get_string(key));
        let settings: Settings = stored("settings").and_then(|text| ron::from_str(&text).ok()).unwrap_or_default();
        let tree = stored("dock").and_then(|text| ron::from_str(&text).ok()).unwrap_or_else(dock::first_layout);
        let graphics = match &context.wgpu_render_state {
            None => Graphics::None,
            Some(state) => {
                gpu::install(state);
                if gpu::can_multisample(state) { Graphics::Smooth } else { Graphics::Plain }
            }
        };
        crate::style::apply(&context.egui_ctx);
        let mut app = Self {
            catalogue,
            choice: options.project.clone(),
            document: Document::new(options.project),
            view: ViewState::default(),
            settings,
            results: Results::default(),
            worker,
            submitted: None,
            generation: 0,
            canvas: Canvas::default(),
            views: Direction::ALL.map(ViewPane::new),
            inspector: Inspector::default(),
            palette: Palette::default(),
            data: Data::default(),
            welcome: Welcome::default(),
            tree,
            maximised: None,
            hovered: None,
            graphics,
            commands: Vec::new(),
            asking: None,
            recovery: Recovery::begin(options.recovery.as_deref()),
            pictures: ReferencePictures::default(),
            is_sure: false,
            after_saving: None,
            may_close: false,
            looked_at_disk: 0.0,
        };
        app.view.welcome =
            options.welcome && options.path.is_none() && !app.settings.welcomed && app.settings.recent.is_empty();
        if let Some(path) = options.path {
            app.commands.push(FileCommand::Open(path).into());
            app.apply_all(&context.egui_ctx);
        }
        Ok(app)
    }

    /// The document.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// How one looks at it.
    pub fn view(&self) -> &ViewState {
        &self.view
    }

    /// What is remembered from one session to the next.
    pub fn settings_mut(&mut self) -> &mut Settings {
        &mut self.settings
    }

    /// What the evaluation gave.
    pub fn results(&self) -> &Results {
        &self.results
    }

    /// Whether reference pictures are still read.
    pub fn reads_pictures(&self) -> bool {
        self.pictures.is_busy()
    }

    /// Asks for something, as a widget does. It happens in the next frame.
    pub fn ask(&mut self, command: impl Into<Command>) {
        self.commands.push(command.into());
    }

    /// Where a point of the world is seen in a view, in points from its upper left corner; for tests that draw with the
    /// pointer.
    pub fn seen_at(&self, direction: Direction, size: egui::Vec2, point: [f64; 3]) -> Option<egui::Vec2> {
        let view = self.views.iter().find(|view| view.camera.direction == direction)?;
        view.camera.project(crate::viewport::camera::ViewSize::new(size), point.into())
    }

    /// Puts unsaved work aside now, as happens by itself after a few seconds. Says whether it is on the disk.
    pub fn put_aside(&mut self) -> bool {
        self.recovery.save(&self.document)
    }

    /// What a view covers on the screen; for tests and pictures.
    pub fn view_on_screen(&self, direction: Direction) -> Option<egui::Rect> {
        self.views.iter().find(|view| view.camera.direction == direction)?.rect
    }

    /// What the canvas covers on the screen; for tests and pictures.
    pub fn canvas_on_screen(&self) -> Option<egui::Rect> {
        self.canvas.rect
    }

    /// What a node of the canvas covers on the screen; for tests, because rectangles of the accessibility tree know nothing of
    /// the zoom.
    pub fn node_on_screen(&self, node: NodeId) -> Option<egui::Rect> {
        self.canvas.node_on_screen(&self.view.path, node)
    }

    /// Where the socket of an input of a node of the canvas is on the screen, or that of an output.
    pub fn socket_on_screen(&self, node: NodeId, port: &str, output: bool) -> Option<egui::Pos2> {
        self.canvas.socket_on_screen(&self.view.path, (node, port, output))
    }

    pub(crate) fn is_over_canvas(&self, context: &egui::Context) -> bool {
        let pointer = context.input(|i| i.pointer.latest_pos());
        self.canvas.rect.zip(pointer).is_some_and(|(rect, pointer)| rect.contains(pointer))
    }

    pub(crate) fn toggle_maximised(&mut self, _: &egui::Context) {
        self.maximised = match self.maximised {
            Some(_) => None,
            None => self.hovered,
        };
    }

    /// Takes over what the evaluation gave since the last frame.
    fn listen(&mut self, context: &egui::Context) {
        let (finished, again) = self.worker.poll();
        if let Some(finished) = finished {
            self.results.accept(finished);
        }
        self.results.update(self.worker.statuses(), self.worker.progress());
        if let Some(again) = again {
            context.request_repaint_after(again);
        }
    }

    /// Evaluates where what is shown depends on something that changed.
    fn evaluate(&mut self) {
        let graph = self.document.graph();
        let drawn = self.view.drawn(graph);
        let active = self.view.active.filter(|id| self.view.path.is_empty() && graph.node(*id).is_some());
        let mut targets = drawn.clone();
        targets.extend(active.filter(|id| !drawn.contains(id)));
        let depiction = Depiction {
            curvature: self.settings.shading == Shading::Curvature,
            outlines: self.settings.shading == Shading::Silhouette,
            detail: self.settings.detail,
        };
        // What costs much is measured of the node that is looked into, while it is.
        let is_looked_into = dock::is_shown(&self.tree, self.maximised, Pane::Data);
        let measures = |id: &NodeId| {
            graph.node(*id).and_then(|node| node.acting_kind()).is_some_and(|kind| kind.has_examination())
        };
        let examined = active.filter(|id| is_looked_into && measures(id)).into_iter().collect();
        // Of a graph that was entered, what is displayed and what the inspector shows.
        let path = self.view.path.clone();
        let there = self.canvas_graph();
        let looked_at = self.view.displayed_within.into_iter().chain(self.view.active).filter(|_| !path.is_empty());
        let mut within: Vec<NodeId> = looked_at.filter(|id| there.node(*id).is_some()).collect();
        within.dedup();
        let wanted = Wanted { revision: self.document.revision(), targets, path, within, depiction, examined };
        if self.submitted.as_ref() == Some(&wanted) {
            return;
        }
        self.generation += 1;
        self.results.expect(self.generation);
        self.worker.submit(Job {
            generation: self.generation,
            graph: graph.clone(),
            targets: wanted.targets.clone(),
            drawn: wanted.targets.clone(),
            path: wanted.path.clone(),
            within: wanted.within.clone(),
            folder: self.document.folder(),
            project: self.document.project(),
            depiction,
            examined: wanted.examined.clone(),
        });
        self.submitted = Some(wanted);
    }

    /// Lets the tour go on where its step was done.
    fn tour(&mut self) {
        let Some(tour) = self.view.tour else { return };
        let after = tour.after(&self.document, &self.results);
        if after != tour {
            self.turn_to(after);
        }
    }

    /// Goes to a step of the tour, with its tool and the line selected.
    pub(crate) fn turn_to(&mut self, step: tour::Tour) {
        self.view.tour = Some(step);
        self.view.tool = step.tool();
        self.settings.toured |= step == tour::Tour::Done;
        if let Some(line) = self.document.graph().find(tour::LINE).filter(|_| step != tour::Tour::Done) {
            self.view.path.clear();
            self.view.selection = [line].into();
            self.view.active = Some(line);
        }
    }

    fn questions(&mut self, context: &egui::Context) {
        let Some(asking) = &mut self.asking else { return };
        let Some(answer) = asking.show(context, &self.document.name()) else { return };
        self.asking = None;
        match answer {
            Answer::Nothing => self.after_saving = None,
            Answer::GiveUp(command) => {
                self.is_sure = true;
                self.commands.push(command.into());
            }
            Answer::SaveFirst(command) => {
                self.after_saving = Some(command);
                self.commands.push(FileCommand::Save.into());
            }
            Answer::Path(purpose, path) => self.chosen(purpose, path),
            Answer::Reload => self.commands.push(FileCommand::Reload.into()),
        }
    }

    fn watch_disk(&mut self, context: &egui::Context) {
        let now = context.input(|i| i.time);
        if now - self.looked_at_disk < LOOK_AT_DISK.as_secs_f64() {
            return;
        }
        self.looked_at_disk = now;
        if self.asking.is_none() && self.document.changed_on_disk() {
            self.asking = Some(Asking::ChangedOnDisk);
        }
    }

    fn closing(&mut self, context: &egui::Context) {
        if context.input(|i| i.viewport().close_requested()) && !self.may_close {
            if self.document.is_changed() {
                context.send_viewport_cmd(egui::ViewportCommand::CancelClose);
                self.commands.push(FileCommand::Quit.into());
            } else {
                self.may_close = true;
            }
        }
    }

    fn title(&self, context: &egui::Context) {
        let star = if self.document.is_changed() { "*" } else { "" };
        let title = format!("{star}{} - Maquette", self.document.name());
        let shown = context.data(|data| data.get_temp::<String>(egui::Id::new("title")));
        if shown.as_ref() != Some(&title) {
            context.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            context.data_mut(|data| data.insert_temp(egui::Id::new("title"), title));
        }
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        let context = ui.ctx().clone();
        self.listen(&context);
        self.pictures.update(&context, &self.document);
        self.closing(&context);
        if self.asking.is_none() {
            let over = self.is_over_canvas(&context);
            self.commands.extend(shortcuts::pressed(&context, &self.view, over, self.canvas.is_searching()));
        }
        self.show(ui);
        self.questions(&context);
        self.apply_all(&context);
        self.tour();
        self.evaluate();
        self.watch_disk(&context);
        if let Some(wait) = self.recovery.tick(&self.document) {
            context.request_repaint_after(wait);
        }
        self.title(&context);
    }

    fn raw_input_hook(&mut self, context: &egui::Context, input: &mut egui::RawInput) {
        // On the canvas the wheel zooms, as in the views, without another key.
        let over = self.is_over_canvas(context) && !egui::Popup::is_any_open(context);
        for event in input.events.iter_mut().filter(|_| over) {
            if let egui::Event::MouseWheel { modifiers, .. } = event {
                *modifiers |= egui::Modifiers::COMMAND;
            }
        }
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        if let Ok(settings) = ron::to_string(&self.settings) {
            storage.set_string("settings", settings);
        }
        if let Ok(tree) = ron::to_string(&self.tree) {
            storage.set_string("dock", tree);
        }
    }

    fn on_exit(&mut self) {
        self.recovery.end();
    }
}

/// Where the editor puts unsaved work aside, by the conventions of the system.
pub fn recovery_folder() -> Option<PathBuf> {
    eframe::storage_dir("maquette").map(|folder: PathBuf| folder.join("recovery"))
}

/// Whether a path names a graph.
pub(crate) fn is_graph(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("ron"))
}
