//! The frame around the panels: menus and tools above, messages below, the panels where the user put them.

use egui::{RichText, Ui};
use egui_tiles::{Behavior, SimplificationOptions, TileId, Tiles, UiResponse};

use crate::app::{App, is_graph};
use crate::canvas::Canvas;
use crate::canvas::arrange::Alignment;
use crate::command::{Command, FileCommand, FileTarget, GraphCommand, NewLink, StrokeDeed, ViewCommand};
use crate::dialog;
use crate::dock::{self, Pane};
use crate::drawable::Detail;
use crate::panel::data::Data;
use crate::panel::inspector::Inspector;
use crate::panel::palette::{DraggedKind, Palette};
use crate::panel::tour::{Asked, Place};
use crate::panel::welcome::graphs_in;
use crate::panel::{PanelContext, help, history, performance, problems};
use crate::shortcuts::keys_of;
use crate::view_state::Tool;
use crate::viewport::camera::Direction;
use crate::viewport::picture::Shading;
use crate::viewport::{Graphics, ViewPane};

/// What names of pictures end with.
const PICTURES: [&str; 3] = ["png", "jpg", "jpeg"];

impl App {
    pub(crate) fn show(&mut self, ui: &mut Ui) {
        egui::Panel::top("menus").show(ui, |ui| self.menus(ui));
        egui::Panel::top("tools").show(ui, |ui| self.tools(ui));
        if !self.recovery.left.is_empty() {
            egui::Panel::top("recovery").show(ui, |ui| {
                let asked = dialog::offer(ui, &self.recovery.left);
                self.commands.extend(asked.map(Command::from));
            });
        }
        egui::Panel::bottom("status").show(ui, |ui| self.status(ui));
        egui::CentralPanel::no_frame().show(ui, |ui| self.panels(ui));
        self.front(ui);
        self.drop_pictures(ui);
        let dropped = ui.input(|i| {
            let paths = i.raw.dropped_files.iter().map(|file| file.path());
            paths.into_iter().find(|path| is_graph(path)).map(std::path::Path::to_owned)
        });
        if let Some(path) = dropped {
            self.commands.push(FileCommand::Open(path).into());
        }
    }

    /// Pictures that were dropped on a view become its reference pictures.
    fn drop_pictures(&mut self, ui: &Ui) {
        let paths: Vec<_> = ui.input(|i| i.raw.dropped_files.iter().map(|file| file.path().to_owned()).collect());
        let pictures = paths.into_iter().filter(|path| {
            path.extension().is_some_and(|e| PICTURES.iter().any(|known| e.eq_ignore_ascii_case(known)))
        });
        for path in pictures {
            match self.hovered {
                Some(Pane::View(view)) => self.commands.push(FileCommand::AddReference { view, path }.into()),
                _ => self.complain("drop a picture on the front, side or top view to sketch over it"),
            }
        }
    }

    fn panels(&mut self, ui: &mut Ui) {
        let maximised = self.maximised;
        let mut tree = std::mem::replace(&mut self.tree, egui_tiles::Tree::empty("dock"));
        let mut panes = Panes {
            context: PanelContext {
                catalogue: &self.catalogue,
                document: &self.document,
                results: &self.results,
                view: &self.view,
                settings: &mut self.settings,
                pictures: &self.pictures,
                commands: &mut self.commands,
            },
            canvas: &mut self.canvas,
            views: &mut self.views,
            inspector: &mut self.inspector,
            palette: &mut self.palette,
            data: &mut self.data,
            graphics: self.graphics,
            hovered: None,
        };
        match maximised {
            Some(mut pane) => {
                panes.show(ui, &mut pane);
            }
            None => tree.ui(&mut panes, ui),
        }
        self.hovered = panes.hovered;
        self.tree = tree;
    }

    fn menus(&mut self, ui: &mut Ui) {
        egui::MenuBar::new().ui(ui, |ui| {
            ui.menu_button("File", |ui| self.file_menu(ui));
            ui.menu_button("Edit", |ui| self.edit_menu(ui));
            ui.menu_button("View", |ui| self.view_menu(ui));
            ui.menu_button("Window", |ui| {
                for pane in Pane::ALL {
                    if ui.button(pane.name()).clicked() {
                        self.maximised = None;
                        dock::reveal(&mut self.tree, pane);
                        ui.close();
                    }
                }
                ui.separator();
                if ui.button("Reset the layout").clicked() {
                    self.tree = dock::first_layout();
                    self.maximised = None;
                    ui.close();
                }
                ui.separator();
                egui::widgets::global_theme_preference_buttons(ui);
            });
            ui.menu_button("Help", |ui| self.help_menu(ui));
        });
    }

    fn help_menu(&mut self, ui: &mut Ui) {
        self.item(ui, "Welcome and examples…", "", true, ViewCommand::Welcome);
        self.item(ui, "Take the tour", "", true, FileCommand::Tour);
        ui.separator();
        self.item(ui, "All keys", "F1", true, ViewCommand::Keys);
        let node = self.view.active.and_then(|id| self.canvas_graph().node(id));
        let page = node.map_or("Page of the active node".to_owned(), |node| format!("Page of {}", node.kind_name()));
        if ui.add_enabled(node.is_some(), egui::Button::new(page)).clicked() {
            self.maximised = None;
            dock::reveal(&mut self.tree, Pane::Help);
            ui.close();
        }
        ui.separator();
        self.item(ui, "About Maquette", "", true, ViewCommand::About);
    }

    /// What stands before the panels: welcome, tour, keys, version.
    fn front(&mut self, ui: &mut Ui) {
        if self.view.keys && !help::keys(ui) {
            self.view.keys = false;
        }
        if self.view.about && !help::about(ui.ctx()) {
            self.view.about = false;
        }
        if self.view.welcome {
            let recent = &self.settings.recent;
            let stays = self.welcome.show(ui.ctx(), &self.catalogue, recent, &mut self.commands);
            self.view.welcome = stays;
            self.settings.welcomed |= !stays;
        }
        let Some(tour) = self.view.tour.filter(|_| self.asking.is_none()) else { return };
        let rects = tour.places().iter().filter_map(|place| match place {
            Place::FrontView => self.view_on_screen(Direction::Front),
            Place::Perspective => self.view_on_screen(Direction::Free),
            Place::Canvas => self.canvas_on_screen(),
        });
        let rects: Vec<_> = rects.collect();
        match tour.show(ui.ctx(), &rects) {
            Some(Asked::Next) => self.turn_to(tour.next()),
            Some(Asked::Leave) => {
                self.view.tour = None;
                self.settings.toured = true;
            }
            None => {}
        }
    }

    fn item(&mut self, ui: &mut Ui, text: &str, keys: &str, enabled: bool, command: impl Into<Command>) {
        let button = egui::Button::new(text);
        let button = if keys.is_empty() { button } else { button.shortcut_text(keys) };
        if ui.add_enabled(enabled, button).clicked() {
            self.commands.push(command.into());
            ui.close();
        }
    }

    fn file_menu(&mut self, ui: &mut Ui) {
        self.item(ui, "New", "Ctrl+N", true, FileCommand::New);
        self.item(ui, "Open…", "Ctrl+O", true, FileCommand::OpenDialog);
        let recent = self.settings.recent.clone();
        ui.add_enabled_ui(!recent.is_empty(), |ui| {
            ui.menu_button("Recent", |ui| {
                for path in recent {
                    self.item(ui, &path.display().to_string(), "", true, FileCommand::Open(path.clone()));
                }
            });
        });
        let examples = graphs_in(&self.document.folder());
        ui.add_enabled_ui(!examples.is_empty(), |ui| {
            ui.menu_button("Graphs beside it", |ui| {
                for path in examples {
                    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
                    self.item(ui, &name, "", true, FileCommand::Open(path.clone()));
                }
            });
        });
        ui.separator();
        self.item(ui, "Save", "Ctrl+S", true, FileCommand::Save);
        self.item(ui, "Save as…", "Ctrl+Shift+S", true, FileCommand::SaveAsDialog);
        self.item(ui, "Export results…", "Ctrl+E", true, FileCommand::ExportDialog);
        ui.separator();
        self.item(ui, "Quit", "Ctrl+Q", true, FileCommand::Quit);
    }

    fn edit_menu(&mut self, ui: &mut Ui) {
        let history = self.document.history();
        let undo = history.undo_name().map(|name| format!("Undo {name}"));
        let redo = history.redo_name().map(|name| format!("Redo {name}"));
        let some = !self.view.selection.is_empty();
        self.item(ui, undo.as_deref().unwrap_or("Undo"), "Ctrl+Z", undo.is_some(), GraphCommand::Undo);
        self.item(ui, redo.as_deref().unwrap_or("Redo"), "Ctrl+Shift+Z", redo.is_some(), GraphCommand::Redo);
        ui.separator();
        self.item(ui, "Add node…", "Tab", true, ViewCommand::Search);
        self.item(ui, "Duplicate", "Ctrl+D", some, GraphCommand::Duplicate { keep_links: false });
        self.item(ui, "Duplicate with links", "Ctrl+Shift+D", some, GraphCommand::Duplicate { keep_links: true });
        self.item(ui, "Copy", "Ctrl+C", some, GraphCommand::Copy);
        self.item(ui, "Cut", "Ctrl+X", some, GraphCommand::Cut);
        self.item(ui, "Delete", "Delete", some, GraphCommand::Delete);
        self.item(ui, "Dissolve", "Ctrl+Backspace", some, GraphCommand::Dissolve);
        ui.separator();
        self.item(ui, "Mute", "M", some, GraphCommand::Mute);
        self.item(ui, "Group", "Ctrl+G", some, GraphCommand::Group);
        self.item(ui, "Ungroup", "Ctrl+Shift+G", some, GraphCommand::Ungroup);
        ui.separator();
        self.item(ui, "Select all", "Ctrl+A", true, ViewCommand::SelectAll);
        self.item(ui, "Arrange all", "L", true, GraphCommand::Arrange);
        self.item(ui, "Arrange selected", "Shift+L", some, GraphCommand::ArrangeSelected);
        let several = self.view.selection.len() > 1;
        ui.add_enabled_ui(several, |ui| {
            ui.menu_button("Align", |ui| {
                for alignment in Alignment::ALL {
                    let command = GraphCommand::Align(alignment).into();
                    let keys = keys_of(&command).unwrap_or_default();
                    self.item(ui, alignment.name(), &keys, true, command);
                }
            });
        });
        self.item(ui, "Swap inputs", "Alt+S", self.view.active.is_some(), GraphCommand::Swap);
    }

    fn view_menu(&mut self, ui: &mut Ui) {
        for shading in Shading::ALL {
            let response = ui.radio_value(&mut self.settings.shading, shading, shading.name());
            response.on_hover_text(shading.description());
        }
        ui.separator();
        let settings = &mut self.settings;
        ui.menu_button("Detail of exact surfaces", |ui| {
            for detail in Detail::ALL {
                ui.radio_value(&mut settings.detail, detail, detail.name());
            }
        });
        ui.checkbox(&mut settings.wire, "Edges");
        ui.checkbox(&mut settings.curves, "Curves");
        ui.checkbox(&mut settings.sections, "Sections and rails");
        ui.checkbox(&mut settings.grid, "Grid");
        let smooth = egui::Checkbox::new(&mut settings.smooth_edges, "Smooth edges");
        ui.add_enabled(self.graphics == Graphics::Smooth, smooth).on_hover_text("Costs time without a graphics card");
        ui.separator();
        ui.checkbox(&mut settings.maya_navigation, "Navigate as in Maya")
            .on_hover_text("Alt with the left, middle and right button; otherwise as in Blender, with the middle one");
        ui.separator();
        ui.menu_button("Add reference picture", |ui| {
            for view in [Direction::Front, Direction::Side, Direction::Top] {
                let extensions = PICTURES.map(str::to_owned).to_vec();
                let command = FileCommand::Browse { target: FileTarget::Reference(view), extensions };
                self.item(ui, &format!("{} view…", view.name()), "", true, command);
            }
        });
        ui.separator();
        self.item(ui, "Frame all", "Home", true, ViewCommand::FrameAll);
        self.item(ui, "Frame selected", "F", true, ViewCommand::FrameSelected);
        self.item(ui, "With or without perspective", "5", true, ViewCommand::Parallel);
    }

    fn tools(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            for tool in Tool::ALL {
                let on = self.view.tool == tool;
                let button = ui.add(egui::Button::selectable(on, tool.name()));
                button.widget_info(|| {
                    egui::WidgetInfo::selected(egui::WidgetType::RadioButton, true, on, format!("{} tool", tool.name()))
                });
                if button.on_hover_text(tool.description()).clicked() {
                    self.commands.push(ViewCommand::Take(tool).into());
                }
            }
            ui.separator();
            let settings = &mut self.settings;
            match self.view.tool {
                Tool::Sketch => {
                    ui.label("tolerance");
                    let mut millimetres = settings.tolerance * 1000.0;
                    let field = egui::DragValue::new(&mut millimetres).range(0.1..=100.0).speed(0.1).suffix(" mm");
                    let field = ui.add(field);
                    field.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::DragValue, true, "tolerance"));
                    field.on_hover_text("How far a stroke may be from the pen: larger is smoother");
                    settings.tolerance = millimetres / 1000.0;
                    ui.checkbox(&mut settings.symmetric, "symmetric").on_hover_text("Draws the mirror image too");
                    ui.checkbox(&mut settings.snap, "snap").on_hover_text(
                        "Ends are caught by other curves, where they cross this plane, and by the middle",
                    );
                }
                Tool::Pull => {
                    ui.label("radius");
                    let mut centimetres = settings.pull_radius * 100.0;
                    let field = egui::DragValue::new(&mut centimetres).range(0.0..=1000.0).speed(0.2).suffix(" cm");
                    let field = ui.add(field);
                    field.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::DragValue, true, "pull radius"));
                    field.on_hover_text("How far along the stroke neighbours follow");
                    settings.pull_radius = centimetres / 100.0;
                }
                Tool::Transform => {
                    for deed in StrokeDeed::ALL {
                        if ui.button(deed.name()).clicked() {
                            self.commands.push(GraphCommand::Strokes(deed).into());
                        }
                    }
                }
                Tool::Picture => {
                    ui.label("length");
                    let field = egui::DragValue::new(&mut settings.known_length).range(1e-3..=1e4).speed(0.01);
                    let field = ui.add(field.max_decimals(4).suffix(" m"));
                    field.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::DragValue, true, "known length"));
                    field.on_hover_text("What Shift+dragging along something in the picture makes it measure");
                    ui.label(RichText::new(Tool::Picture.description()).weak());
                }
                Tool::Paint => {
                    ui.label("brush");
                    let mut centimetres = settings.brush * 100.0;
                    let field = egui::DragValue::new(&mut centimetres).range(0.01..=1000.0).speed(0.05).suffix(" cm");
                    let field = ui.add(field);
                    field.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::DragValue, true, "brush"));
                    field.on_hover_text("Radius of the brush");
                    settings.brush = centimetres / 100.0;
                }
                Tool::Select | Tool::Cut | Tool::Erase | Tool::Lasso => {
                    ui.label(RichText::new(self.view.tool.description()).weak());
                }
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                for shading in Shading::ALL.into_iter().rev() {
                    let on = self.settings.shading == shading;
                    let button = ui.add(egui::Button::selectable(on, shading.name()));
                    if button.on_hover_text(shading.description()).clicked() {
                        self.settings.shading = shading;
                    }
                }
            });
        });
    }

    fn status(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            match &self.view.message {
                Some(message) => {
                    let text = RichText::new(&message.text);
                    let text = if message.is_error { text.color(ui.visuals().error_fg_color) } else { text };
                    ui.add(egui::Label::new(text).truncate());
                }
                None => {
                    ui.label(RichText::new(self.view.tool.description()).weak());
                }
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| self.progress(ui));
        });
    }

    fn progress(&mut self, ui: &mut Ui) {
        if let Some((done, planned)) = self.results.progress() {
            if ui.button("Stop").on_hover_text("Stop evaluating (Esc)").clicked() {
                self.commands.push(ViewCommand::Stop.into());
            }
            #[expect(clippy::cast_precision_loss, reason = "a few nodes")]
            let share = done as f32 / planned.max(1) as f32;
            ui.add(egui::ProgressBar::new(share).desired_width(120.0).text(format!("{done} of {planned}")));
        } else if let Some(evaluation) = self.results.evaluation() {
            let failures = evaluation.failures().count();
            if failures > 0 {
                let text = format!("{failures} node(s) failed");
                if ui.link(RichText::new(text).color(ui.visuals().error_fg_color)).clicked() {
                    dock::reveal(&mut self.tree, Pane::Problems);
                }
            } else {
                let time = crate::canvas::face::time(evaluation.duration);
                ui.label(RichText::new(format!("{} nodes in {time}", evaluation.outcomes().len())).weak());
            }
        }
    }
}

/// The panels with what they show.
struct Panes<'a> {
    context: PanelContext<'a>,
    canvas: &'a mut Canvas,
    views: &'a mut [ViewPane; 4],
    inspector: &'a mut Inspector,
    palette: &'a mut Palette,
    data: &'a mut Data,
    graphics: Graphics,
    hovered: Option<Pane>,
}

impl Panes<'_> {
    fn show(&mut self, ui: &mut Ui, pane: &mut Pane) {
        let rect = ui.available_rect_before_wrap();
        if ui.rect_contains_pointer(rect) {
            self.hovered = Some(*pane);
        }
        let ui = &mut ui.new_child(egui::UiBuilder::new().max_rect(rect).id_salt(pane.name()));
        ui.set_clip_rect(rect.intersect(ui.clip_rect()));
        let context = &mut self.context;
        match pane {
            Pane::View(direction) => {
                if let Some(view) = self.views.iter_mut().find(|view| view.camera.direction == *direction) {
                    view.show(ui, context, self.graphics);
                }
            }
            Pane::Canvas => {
                self.canvas.show(ui, context);
                let dropped = ui.interact(rect, ui.id().with("drop"), egui::Sense::hover());
                if let Some(kind) = dropped.dnd_release_payload::<DraggedKind>()
                    && let Some(pointer) = ui.input(|i| i.pointer.latest_pos())
                {
                    let at = self.canvas.canvas_point(pointer);
                    context.ask(GraphCommand::Add { kind: kind.0.clone(), at, link: NewLink::None });
                }
            }
            _ => {
                ui.painter().rect_filled(rect, 0.0, ui.visuals().panel_fill);
                egui::Frame::new().inner_margin(egui::Margin::same(8)).show(ui, |ui| match pane {
                    Pane::Inspector => self.inspector.show(ui, context),
                    Pane::Palette => {
                        let middle =
                            self.canvas.rect.map_or([0.0, 0.0], |rect| self.canvas.canvas_point(rect.center()));
                        self.palette.show(ui, context, middle);
                    }
                    Pane::Problems => problems::show(ui, context),
                    Pane::History => history::show(ui, context),
                    Pane::Performance => performance::show(ui, context),
                    Pane::Data => self.data.show(ui, context),
                    Pane::Help | Pane::View(_) | Pane::Canvas => help::show(ui, context),
                });
            }
        }
    }
}

impl Behavior<Pane> for Panes<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _: TileId, pane: &mut Pane) -> UiResponse {
        self.show(ui, pane);
        UiResponse::None
    }

    fn tab_title_for_pane(&mut self, pane: &Pane) -> egui::WidgetText {
        match pane {
            Pane::Problems => {
                let count = problems::entries(&self.context).len();
                if count == 0 { "Problems".into() } else { format!("Problems ({count})").into() }
            }
            _ => pane.name().into(),
        }
    }

    fn is_tab_closable(&self, _: &Tiles<Pane>, _: TileId) -> bool {
        true
    }

    fn simplification_options(&self) -> SimplificationOptions {
        // A view without a tab says itself what it is.
        SimplificationOptions { all_panes_must_have_tabs: false, ..SimplificationOptions::default() }
    }
}
