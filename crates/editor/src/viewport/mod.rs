//! The views: what the graph makes, seen from four sides, and where one sketches.

pub(crate) mod camera;
pub(crate) mod draw;
pub(crate) mod gizmo;
pub(crate) mod gpu;
pub(crate) mod grid;
pub(crate) mod move_gizmo;
pub(crate) mod outline;
pub(crate) mod pick;
mod picked_row;
pub(crate) mod picture;
pub(crate) mod reference;
pub(crate) mod selection_tool;
pub(crate) mod sketch_tool;
pub(crate) mod snap;
pub(crate) mod transform_tool;

use std::sync::Arc;

use egui::{PointerButton, Sense};
use glam::DVec3;
use maquette_geometry::mesh::measure::points_bounds;
use maquette_graph::NodeId;

use crate::command::ViewCommand;
use crate::drawable::{LineRole, Shown};
use crate::panel::PanelContext;
use crate::sketch::target::{Plane, SketchTarget, points};
use crate::view_state::Tool;

use self::camera::{Camera, Direction, ViewSize};
use self::draw::PictureOf;
use self::grid::Grid;
use self::move_gizmo::MoveGizmo;
use self::outline::OutlineError;
use self::picture::Shading;
use self::reference::PictureTool;
use self::selection_tool::SelectionTool;
use self::sketch_tool::{SketchTool, ToolView};
use self::transform_tool::TransformTool;

/// What a view is to frame when it is drawn next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Framing {
    /// Nothing: it stays where it is.
    #[default]
    Keep,
    /// All that is shown, as soon as something is.
    All,
    /// What the selected nodes show, or all where they show nothing.
    Selected,
}

/// Whether and how pictures can be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Graphics {
    /// There is no graphics card, nor a driver that stands in for one.
    None,
    /// Pictures with rough edges.
    Plain,
    /// Pictures with smooth edges, where they are wanted.
    Smooth,
}

/// One view.
#[derive(Clone, Debug)]
pub(crate) struct ViewPane {
    pub(crate) camera: Camera,
    pub(crate) framing: Framing,
    tool: SketchTool,
    transform: TransformTool,
    pictures: PictureTool,
    outline: OutlineError,
    moves: MoveGizmo,
    selecting: SelectionTool,
    /// How hard a pen presses; `None` while there is none.
    pen: Option<f64>,
    /// What of the screen it covered in the last frame.
    pub(crate) rect: Option<egui::Rect>,
}

impl ViewPane {
    pub(crate) fn new(direction: Direction) -> Self {
        Self {
            camera: Camera::new(direction),
            framing: Framing::All,
            tool: SketchTool::default(),
            transform: TransformTool::default(),
            pictures: PictureTool::default(),
            outline: OutlineError::default(),
            moves: MoveGizmo::default(),
            selecting: SelectionTool::default(),
            pen: None,
            rect: None,
        }
    }

    pub(crate) fn show(&mut self, ui: &mut egui::Ui, context: &mut PanelContext<'_>, graphics: Graphics) {
        let rect = ui.available_rect_before_wrap();
        self.rect = Some(rect);
        let direction = self.camera.direction;
        let response = ui.allocate_rect(rect, Sense::click_and_drag());
        let label = format!("{} view", direction.name());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Image, true, &label));
        if rect.width() < 2.0 || rect.height() < 2.0 {
            return;
        }
        let size = ViewSize::new(rect.size());
        self.frame(context, size);
        self.navigate(ui, &response, context, size);
        self.use_tool(ui, &response, context, size);
        let grid = Grid::new(&self.camera, size);
        if context.settings.shading == Shading::Silhouette {
            self.outline.update(context, direction);
        }
        self.paint(ui, rect, context, graphics, size, &grid);
        self.overlay(ui, rect, context, size, &grid);
    }

    fn frame(&mut self, context: &PanelContext<'_>, size: ViewSize) {
        // What is displayed alone is framed alone, without the strokes around it.
        let alone = context.view.displayed_within.is_some();
        let all = || {
            let is_drawn = context.drawn();
            bounds(context, |shown| is_drawn(shown) || !alone && context.is_here(shown), |_| !alone)
        };
        let framed = match self.framing {
            Framing::Keep => return,
            Framing::All => all(),
            Framing::Selected => {
                let selected = |node| context.view.selection.contains(&node);
                bounds(context, |shown| context.is_here(shown) && selected(shown.node), selected).or_else(all)
            }
        };
        if let Some(framed) = framed {
            self.camera.frame_box(size, framed);
            self.framing = Framing::Keep;
        } else if context.results.is_current() {
            // Nothing will come by itself, and a first stroke must not move the view.
            self.framing = Framing::Keep;
        }
    }

    fn navigate(&mut self, ui: &egui::Ui, response: &egui::Response, context: &PanelContext<'_>, size: ViewSize) {
        let corner = response.rect.min;
        let (modifiers, scroll, pinch) = ui.input(|i| (i.modifiers, i.smooth_scroll_delta().y, i.zoom_delta()));
        if let Some(pointer) = response.hover_pos().filter(|_| response.contains_pointer()) {
            let factor = f64::from(scroll * 0.0028).exp() * f64::from(pinch);
            if (factor - 1.0).abs() > 1e-6 {
                self.camera.zoom(size, pointer - corner, factor);
            }
        }
        let dragged = response.drag_delta();
        if dragged == egui::Vec2::ZERO {
            return;
        }
        let free = self.camera.direction == Direction::Free;
        let by = |button| response.dragged_by(button);
        let zoom = f64::from(dragged.x - dragged.y) * 0.01;
        let middle = response.rect.center() - corner;
        if by(PointerButton::Middle) {
            if modifiers.ctrl && !context.settings.maya_navigation {
                self.camera.zoom(size, middle, zoom.exp());
            } else if free && !modifiers.shift && !context.settings.maya_navigation {
                self.camera.orbit(dragged);
            } else {
                self.camera.pan(size, dragged);
            }
        } else if by(PointerButton::Primary) && modifiers.alt {
            if free && !modifiers.shift { self.camera.orbit(dragged) } else { self.camera.pan(size, dragged) }
        } else if by(PointerButton::Secondary) {
            if modifiers.alt { self.camera.zoom(size, middle, zoom.exp()) } else { self.camera.pan(size, dragged) }
        }
    }

    fn use_tool(&mut self, ui: &egui::Ui, response: &egui::Response, context: &mut PanelContext<'_>, size: ViewSize) {
        let corner = response.rect.min;
        let alt = ui.input(|i| i.modifiers.alt);
        let view = ToolView { camera: &self.camera, size };
        if context.view.tool == Tool::Select {
            let exact = ui.input(|i| i.modifiers.shift);
            if response.drag_started_by(PointerButton::Primary)
                && !alt
                && let Some(at) = ui.input(|i| i.pointer.press_origin())
            {
                self.moves.press(context, &view, at - corner);
            }
            if response.dragged_by(PointerButton::Primary)
                && self.moves.is_held()
                && let Some(at) = response.interact_pointer_pos()
            {
                self.moves.drag(context, &view, at - corner, exact);
            }
            if response.drag_stopped_by(PointerButton::Primary) {
                self.moves.release(context);
            }
            if response.clicked()
                && let Some(at) = response.interact_pointer_pos()
            {
                let at = at - corner;
                let here = context.results.shown().iter().filter(|shown| context.is_here(shown)).cloned();
                let here: Vec<Shown> = here.collect();
                let found = sketch_at(context, &view, at).or_else(|| pick::pick(&here, &self.camera, size, at));
                context.ask(ViewCommand::Select(found.into_iter().collect()));
            }
            return;
        }
        if alt {
            return;
        }
        let modifiers = ui.input(|i| i.modifiers);
        if matches!(context.view.tool, Tool::Transform | Tool::Pull) && ui.rect_contains_pointer(response.rect) {
            transform_tool::nudge(ui, context, &view);
        }
        let (press, at) = (ui.input(|i| i.pointer.press_origin()), response.interact_pointer_pos());
        self.pen = pressure(ui).or(self.pen);
        // A click does what a press and a release do.
        let begins = response.drag_started_by(PointerButton::Primary)
            || (response.clicked() && matches!(context.view.tool, Tool::Transform | Tool::Paint));
        if begins && let Some(at) = press.or(at) {
            let at = at - corner;
            match context.view.tool {
                Tool::Transform => self.transform.press(context, &view, at, modifiers),
                Tool::Picture => self.pictures.press(context, &view, at, modifiers.shift),
                Tool::Lasso | Tool::Paint => self.selecting.press(context, &view, at, modifiers.command),
                _ => self.tool.press(context, &view, at),
            }
        }
        if response.dragged_by(PointerButton::Primary)
            && let Some(at) = at
        {
            let at = at - corner;
            match context.view.tool {
                Tool::Transform => self.transform.drag(context, &view, at, modifiers),
                Tool::Picture => self.pictures.drag(context, &view, at),
                Tool::Lasso | Tool::Paint => self.selecting.drag(context, &view, at),
                _ => self.tool.drag(context, &view, at, self.pen),
            }
        }
        if response.drag_stopped_by(PointerButton::Primary) || response.clicked() {
            self.transform.release(context);
            self.pictures.release(context);
            self.selecting.release(context, &view);
            self.tool.release(context, &view);
            self.pen = None;
        }
    }

    /// Coordinates along the lower and the left edge, metres.
    fn rulers(&self, painter: &egui::Painter, rect: egui::Rect, size: ViewSize, grid: &Grid, colour: egui::Color32) {
        let font = egui::FontId::proportional(10.0);
        for (screen, metres, at) in grid.numbers(&self.camera, size) {
            let text = grid.number(metres);
            // Away from the corner, which says the distance of the lines, and from the name of the view.
            if screen == 0 && at > 80.0 && at < rect.width() - 8.0 {
                let place = rect.left_bottom() + egui::vec2(at, -2.0);
                painter.text(place, egui::Align2::CENTER_BOTTOM, text, font.clone(), colour);
            } else if screen == 1 && at > 60.0 && at < rect.height() - 26.0 {
                let place = rect.left_top() + egui::vec2(4.0, at);
                painter.text(place, egui::Align2::LEFT_CENTER, text, font.clone(), colour);
            }
        }
    }

    /// Where a stroke that begins or ends here is caught, and how far it may be from the pen.
    fn pen(&self, ui: &egui::Ui, rect: egui::Rect, context: &PanelContext<'_>, view: &ToolView<'_>) {
        let Some(pointer) = ui.input(|i| i.pointer.hover_pos()).filter(|at| rect.contains(*at)) else { return };
        if !ui.rect_contains_pointer(rect) {
            return;
        }
        let painter = ui.painter().with_clip_rect(rect);
        let accent = egui::Color32::from_rgb(255, 160, 45);
        if context.view.tool == Tool::Paint {
            #[expect(clippy::cast_possible_truncation, reason = "points of the screen")]
            let radius = (context.settings.brush / self.camera.metres_per_point(view.size)) as f32;
            painter.circle_stroke(pointer, radius.clamp(2.0, 2000.0), egui::Stroke::new(1.5, accent));
        }
        if context.view.tool != Tool::Sketch {
            return;
        }
        #[expect(clippy::cast_possible_truncation, reason = "points of the screen")]
        let tolerance = (sketch_tool::tolerance(context, view) / self.camera.metres_per_point(view.size)) as f32;
        if (2.0..400.0).contains(&tolerance) {
            painter.circle_stroke(pointer, tolerance, egui::Stroke::new(1.0, accent.gamma_multiply(0.5)));
        }
        let target = sketch_tool::active_target(context);
        let plane = target.as_ref().map(|target| target.plane).or_else(|| Plane::of_view(self.camera.direction));
        let caught = plane.and_then(|plane| {
            let at = view.meet(plane, pointer - rect.min)?;
            let place = snap::caught(context, view, plane, target.as_ref().map(|target| target.node), at)?;
            self.camera.project(view.size, plane.place(place))
        });
        if let Some(place) = caught {
            painter.circle_stroke(rect.min + place, 6.0, egui::Stroke::new(2.0, accent));
        }
    }

    /// A new reference picture in the middle of what the view shows; `None` in the free view.
    pub(crate) fn placed(&self, file: String) -> Option<maquette_graph::ReferencePicture> {
        let size = ViewSize::new(self.rect.map_or(egui::vec2(400.0, 400.0), |rect| rect.size()));
        reference::placed(&self.camera, size, file)
    }

    fn paint(
        &self,
        ui: &egui::Ui,
        rect: egui::Rect,
        context: &PanelContext<'_>,
        graphics: Graphics,
        size: ViewSize,
        grid: &Grid,
    ) {
        if graphics == Graphics::None {
            ui.painter().rect_filled(rect, 0.0, ui.visuals().extreme_bg_color);
            let text = "no graphics: install a Vulkan or OpenGL driver (mesa-vulkan-drivers) to see models here";
            ui.painter().text(
                rect.center(),
                egui::Align2::CENTER_CENTER,
                text,
                egui::FontId::proportional(13.0),
                ui.visuals().warn_fg_color,
            );
            return;
        }
        ui.painter().rect_filled(rect, 0.0, draw::background(ui.visuals().dark_mode));
        reference::show(ui, rect, context, &self.camera, size);
        let scale = ui.ctx().pixels_per_point();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "at least one pixel, no more than a window"
        )]
        let pixels = [rect.width(), rect.height()].map(|side| (side * scale).round().clamp(1.0, 8192.0) as u32);
        let of = PictureOf {
            view: self.camera.direction as u64,
            camera: &self.camera,
            size,
            pixels,
            dark: ui.visuals().dark_mode,
            samples: if graphics == Graphics::Smooth && context.settings.smooth_edges { 4 } else { 1 },
        };
        let mut picture = draw::picture(context, &of, grid);
        if context.settings.shading == Shading::Silhouette && Plane::of_view(self.camera.direction).is_some() {
            picture.lines.extend(self.outline.lines());
        }
        let picture = Arc::new(picture);
        ui.painter().add(egui_wgpu::Callback::new_paint_callback(rect, gpu::PaintPicture(picture)));
    }

    fn overlay(
        &mut self,
        ui: &mut egui::Ui,
        rect: egui::Rect,
        context: &mut PanelContext<'_>,
        size: ViewSize,
        grid: &Grid,
    ) {
        let painter = ui.painter().with_clip_rect(rect);
        let font = egui::FontId::proportional(12.0);
        let text = ui.visuals().text_color();
        let weak = ui.visuals().weak_text_color();
        let name = self.camera.direction.name();
        painter.text(rect.left_top() + egui::vec2(10.0, 8.0), egui::Align2::LEFT_TOP, name, font.clone(), text);
        let view = ToolView { camera: &self.camera, size };
        let hint = SketchTool::hint(context, &view);
        if ui.rect_contains_pointer(rect) && !hint.is_empty() {
            painter.text(rect.left_top() + egui::vec2(10.0, 25.0), egui::Align2::LEFT_TOP, hint, font.clone(), weak);
        }
        if context.settings.grid {
            self.rulers(&painter, rect, size, grid, weak);
            let label = format!("grid {}", grid.label());
            painter.text(
                rect.left_bottom() + egui::vec2(10.0, -8.0),
                egui::Align2::LEFT_BOTTOM,
                label,
                font.clone(),
                weak,
            );
        }
        if context.settings.shading == Shading::Silhouette && Plane::of_view(self.camera.direction).is_some() {
            let place = rect.left_top() + egui::vec2(10.0, 42.0);
            painter.text(place, egui::Align2::LEFT_TOP, &self.outline.words, font.clone(), text);
        }
        if context.results.is_late() && !context.results.shown().is_empty() {
            let place = rect.right_bottom() + egui::vec2(-10.0, -8.0);
            painter.text(place, egui::Align2::RIGHT_BOTTOM, "this is the result before the last change", font, weak);
        }
        let corner = rect.min;
        let screen = |place: DVec3| self.camera.project(size, place).map(|seen| corner + seen);
        for (plane, drawn) in self.tool.drawn().into_iter().chain(self.selecting.drawn()) {
            let line: Vec<egui::Pos2> = drawn.iter().filter_map(|p| screen(plane.place(*p))).collect();
            painter.add(egui::Shape::line(line, egui::Stroke::new(2.5, egui::Color32::from_rgb(255, 160, 45))));
        }
        self.pictures.show(&painter, context, screen);
        self.pen(ui, rect, context, &view);
        if context.view.tool == Tool::Transform {
            TransformTool::show(&painter, corner, context, &view);
        }
        if context.view.tool == Tool::Select {
            let hover = ui.input(|i| i.pointer.hover_pos()).filter(|at| rect.contains(*at)).map(|at| at - corner);
            self.moves.show(&painter, corner, context, &view, hover);
        }
        self.number_curves(ui, rect, context, size);
        let pulling = context.view.tool == Tool::Pull;
        if let Some(target) = context.view.active.and_then(|id| SketchTarget::of(context.graph(), id))
            && (pulling || context.view.tool == Tool::Sketch)
        {
            for stroke in &target.strokes {
                for place in points(stroke).into_iter().filter_map(|p| screen(target.plane.place(p))) {
                    let radius = if pulling { 3.5 } else { 2.0 };
                    painter.circle(
                        place,
                        radius,
                        ui.visuals().extreme_bg_color,
                        egui::Stroke::new(1.5, egui::Color32::from_rgb(255, 160, 45)),
                    );
                }
            }
        }
        gizmo::show(ui, rect, &mut self.camera);
    }
}

impl ViewPane {
    /// Numbers the curves of the active node and shows which way they run: what a `sort` decided, for one.
    fn number_curves(&self, ui: &egui::Ui, rect: egui::Rect, context: &PanelContext<'_>, size: ViewSize) {
        let Some(active) = context.view.active.filter(|_| context.settings.curves) else { return };
        let painter = ui.painter().with_clip_rect(rect);
        let screen = |place: &glam::Vec3| self.camera.project(size, place.as_dvec3()).map(|seen| rect.min + seen);
        let accent = egui::Color32::from_rgb(255, 176, 66);
        let of_active = |shown: &&Shown| shown.node == active && context.is_here(shown);
        for shown in context.results.shown().iter().filter(of_active) {
            for drawable in &shown.drawables {
                let curves = drawable.lines.iter().filter(|line| line.role == LineRole::Curve);
                // More numbers than that nobody can read.
                for (number, line) in curves.take(24).enumerate() {
                    let ahead = (line.points.len() / 8).max(1);
                    let begin = line.points.first().and_then(screen);
                    let next = line.points.get(ahead).and_then(screen);
                    let (Some(begin), Some(next)) = (begin, next) else { continue };
                    if (next - begin).length() > 6.0 {
                        let along = (next - begin).normalized() * 14.0;
                        painter.arrow(begin, along, egui::Stroke::new(2.0, accent));
                    }
                    let place = begin + egui::vec2(5.0, -5.0);
                    let font = egui::FontId::proportional(12.0);
                    painter.text(
                        place + egui::vec2(1.0, 1.0),
                        egui::Align2::LEFT_BOTTOM,
                        number,
                        font.clone(),
                        egui::Color32::BLACK,
                    );
                    painter.text(place, egui::Align2::LEFT_BOTTOM, number, font, accent);
                }
            }
        }
    }
}

/// How hard a pen was said to press in this frame, from 0 to 1; `None` where nothing was said, as by a mouse.
fn pressure(ui: &egui::Ui) -> Option<f64> {
    ui.input(|input| {
        let force = |event: &egui::Event| match event {
            egui::Event::Touch { force, phase, .. } => force.filter(|_| *phase != egui::TouchPhase::End),
            _ => None,
        };
        input
            .events
            .iter()
            .rev()
            .find_map(force)
            .map(f64::from)
            .map(|force| (force.clamp(0.0, 1.0) * 1e3).round() / 1e3)
    })
}

/// The sketch whose stroke is under the pointer.
fn sketch_at(context: &PanelContext<'_>, view: &ToolView<'_>, at: egui::Vec2) -> Option<NodeId> {
    let visible = pick::Visible::new(context.results.shown(), view.camera, view.size, at);
    let mut best: Option<(f32, NodeId)> = None;
    for target in SketchTarget::all(context.graph()) {
        // What was drawn in this view can be picked in it through everything.
        let flat = target.plane.view == view.camera.direction;
        for stroke in &target.strokes {
            let line = points(stroke);
            let joint = line.first().filter(|_| stroke.closed);
            let places = line.iter().chain(joint).map(|p| target.plane.place(*p));
            let near = pick::near_line(places, view.camera, view.size, at);
            if let Some((distance, place)) = near
                && distance <= pick::LINE_REACH
                && (flat || visible.shows(place) || context.view.selection.contains(&target.node))
                && best.is_none_or(|(least, _)| distance < least)
            {
                best = Some((distance, target.node));
            }
        }
    }
    best.map(|(_, node)| node)
}

/// The box around what nodes show, their strokes included.
fn bounds(
    context: &PanelContext<'_>,
    is_wanted: impl Fn(&Shown) -> bool,
    wanted: impl Fn(NodeId) -> bool,
) -> Option<[DVec3; 2]> {
    let shown = context.results.shown().iter().filter(|shown| is_wanted(shown));
    let boxes = shown.flat_map(|shown| shown.drawables.iter().filter_map(|drawable| drawable.bounds));
    let strokes = SketchTarget::all(context.graph()).filter(|target| wanted(target.node)).flat_map(|target| {
        let places: Vec<DVec3> = target.strokes.iter().flat_map(points).map(|p| target.plane.place(p)).collect();
        places
    });
    points_bounds(boxes.flatten().chain(strokes)).map(Into::into)
}
