//! What is drawn on a node: its name, how it stands with it, its flags, its ports.

use egui::{Align, Color32, Layout, Pos2, RichText, Ui, vec2};
use maquette_graph::{Node, NodeId};

use crate::command::{Command, FileCommand, GraphCommand, ViewCommand};
use crate::evaluation_worker::NodeStatus;
use crate::panel::PanelContext;
use crate::shortcuts::keys_of;
use crate::signs;

use super::arrange::Alignment;
use super::card::{Card, GAP, KIND, MARGIN, ROW, TITLE, WIDTH};
use super::ports::Port;

/// A duration in words that fit a node.
pub(crate) fn time(duration: std::time::Duration) -> String {
    let milliseconds = duration.as_secs_f64() * 1000.0;
    match milliseconds {
        ms if ms >= 1000.0 => format!("{:.1} s", ms / 1000.0),
        ms if ms >= 10.0 => format!("{ms:.0} ms"),
        ms if ms >= 0.05 => format!("{ms:.1} ms"),
        _ => "0 ms".to_owned(),
    }
}

/// A colour for how it stands with a node.
fn status_colour(status: Option<&NodeStatus>, visuals: &egui::Visuals) -> Color32 {
    match status {
        None => visuals.weak_text_color(),
        Some(NodeStatus::Running(_)) => visuals.hyperlink_color,
        Some(NodeStatus::Done(_) | NodeStatus::Hit) if visuals.dark_mode => Color32::from_rgb(110, 200, 120),
        Some(NodeStatus::Done(_) | NodeStatus::Hit) => Color32::from_rgb(14, 102, 42),
        Some(NodeStatus::Failed { .. }) => visuals.error_fg_color,
        Some(NodeStatus::Waiting(_) | NodeStatus::Stopped) => visuals.warn_fg_color,
    }
}

/// The colours of all that there is to say about how it stands with a node.
#[cfg(test)]
pub(crate) fn status_colours(visuals: &egui::Visuals) -> [Color32; 5] {
    let failed = NodeStatus::Failed { port: None, message: String::new() };
    let all = [None, Some(NodeStatus::Running(0.5)), Some(NodeStatus::Hit), Some(failed), Some(NodeStatus::Stopped)];
    all.map(|status| status_colour(status.as_ref(), visuals))
}

/// Words for how it stands with a node.
fn status_words(status: Option<&NodeStatus>) -> String {
    match status {
        None => "not evaluated: nothing that is shown needs it".to_owned(),
        Some(NodeStatus::Running(share)) => format!("running, {:.0} %", share * 100.0),
        Some(NodeStatus::Done(duration)) => format!("done in {}", time(*duration)),
        Some(NodeStatus::Hit) => "known: nothing that it depends on changed".to_owned(),
        Some(NodeStatus::Failed { port, message }) => {
            let at = port.as_ref().map(|port| format!("input \"{port}\": ")).unwrap_or_default();
            format!("{at}{message}")
        }
        Some(NodeStatus::Waiting(on)) => format!("waits for {}", on.join(", ")),
        Some(NodeStatus::Stopped) => "stopped".to_owned(),
    }
}

/// A dot, filled where the node has a result, a ring where it has none yet, a cross where it failed.
fn status_sign(painter: &egui::Painter, status: Option<&NodeStatus>, colour: Color32, middle: Pos2, scale: f32) {
    let stroke = egui::Stroke::new(1.8 * scale, colour);
    match status {
        Some(NodeStatus::Done(_) | NodeStatus::Hit) => {
            painter.circle_filled(middle, 4.0 * scale, colour);
        }
        Some(NodeStatus::Failed { .. }) => {
            let arm = scale * vec2(3.5, 3.5);
            let other = scale * vec2(3.5, -3.5);
            painter.line_segment([middle - arm, middle + arm], stroke);
            painter.line_segment([middle - other, middle + other], stroke);
        }
        _ => {
            painter.circle_stroke(middle, 3.5 * scale, stroke);
        }
    }
}

/// Zoom below which only the title is worth reading.
const TITLE_ONLY: f32 = 0.62;

/// Whether only the titles of nodes are shown.
pub(super) fn is_afar(zoom: f32) -> bool {
    zoom < TITLE_ONLY
}

/// What is drawn: a node, how it stands with it, and how large it is seen.
#[derive(Clone, Copy)]
pub(super) struct Face<'a> {
    pub(super) card: &'a Card,
    pub(super) node: &'a Node,
    pub(super) status: Option<&'a NodeStatus>,
    pub(super) zoom: f32,
}

/// Draws the inside of a node and places its sockets.
pub(super) fn show(
    ui: &mut Ui,
    sockets: &mut egui_graph::SocketLayout,
    context: &mut PanelContext<'_>,
    face: Face<'_>,
) {
    let Face { card, node, status, zoom } = face;
    let corner = ui.max_rect().min - vec2(f32::from(MARGIN.left), f32::from(MARGIN.top)) - vec2(1.0, 1.0);
    ui.set_width(WIDTH);
    ui.spacing_mut().item_spacing = vec2(4.0, GAP);
    ui.style_mut().interaction.selectable_labels = false;
    for index in 0..card.inputs.len() {
        if let Some(place) = card.input(index) {
            sockets.input_at(index, corner.y + place.y);
        }
    }
    for index in 0..card.outputs.len() {
        if let Some(place) = card.output(index) {
            sockets.output_at(index, corner.y + place.y);
        }
    }
    if is_afar(zoom) {
        let (_, response) = ui.allocate_exact_size(vec2(WIDTH, card.size.y - 14.0), egui::Sense::hover());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Label, true, node.name()));
        response.on_hover_ui(|ui| {
            ui.label(format!("{}, {}: {}", node.name(), node.kind_name(), status_words(status)));
        });
        from_afar(ui.painter(), card.rect(corner), face, ui.visuals());
        return;
    }
    stripe(ui.painter(), card.rect(corner), card, ui.visuals());
    if card.is_collapsed {
        line(ui, TITLE, |ui| title(ui, context, face));
        return;
    }
    let colour = status_colour(status, ui.visuals());
    line(ui, TITLE, |ui| title(ui, context, face));
    line(ui, KIND, |ui| second_line(ui, context, face));
    if let Some(NodeStatus::Running(share)) = status {
        // Over the line below, so that no socket moves because something runs.
        #[expect(clippy::cast_possible_truncation, reason = "a share")]
        let share = share.clamp(0.0, 1.0) as f32;
        let top = corner.y + 7.0 + TITLE + GAP + KIND;
        let bar = egui::Rect::from_min_size(egui::pos2(corner.x + 10.0, top), vec2(WIDTH * share, GAP));
        ui.painter().rect_filled(bar, 1.0, colour);
    }
    for index in &card.rows {
        row(ui, &card.inputs[*index], false);
    }
    for port in &card.outputs {
        row(ui, port, true);
    }
}

/// How it stands with the node, and its name.
fn title(ui: &mut Ui, context: &PanelContext<'_>, face: Face<'_>) {
    let Face { card, node, status, .. } = face;
    let (rect, response) = ui.allocate_exact_size(vec2(11.0, 14.0), egui::Sense::hover());
    status_sign(ui.painter(), status, status_colour(status, ui.visuals()), rect.center(), 1.0);
    response.on_hover_ui(|ui| {
        ui.label(status_words(status));
    });
    let name = RichText::new(node.name()).strong().size(13.5);
    let name = if node.is_muted() { name.strikethrough().weak() } else { name };
    ui.add(egui::Label::new(name).truncate()).on_hover_ui(|ui| {
        let summary = summary(context, card.id).unwrap_or_default();
        let kind = node.kind().map_or("unknown kind", |kind| kind.description());
        ui.label(format!("{}: {kind}{summary}", node.kind_name()));
    });
}

/// The kind, or what is wrong; flags and the time of the last run at its end.
fn second_line(ui: &mut Ui, context: &mut PanelContext<'_>, face: Face<'_>) {
    let Face { card, node, status, .. } = face;
    ui.spacing_mut().button_padding = vec2(3.0, 0.0);
    let outcome = context.outcome(card.id);
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        if let Some(outcome) = outcome.filter(|outcome| !outcome.duration.is_zero()) {
            ui.label(RichText::new(time(outcome.duration)).size(10.0).weak());
        }
        flags(ui, context, card, node);
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| match status {
            Some(NodeStatus::Failed { .. }) => {
                let words = status_words(status);
                let badge = RichText::new(&words).size(10.5).color(ui.visuals().error_fg_color);
                ui.add(egui::Label::new(badge).truncate()).on_hover_text(&words);
            }
            _ => {
                let kind = RichText::new(node.kind_name()).size(10.5);
                let kind = if node.kind().is_none() { kind.color(ui.visuals().warn_fg_color) } else { kind.weak() };
                ui.add(egui::Label::new(kind).truncate());
            }
        });
    });
}

/// Size of a title on the canvas that is read at this zoom, in steps, so that the letters need not be drawn anew in every
/// frame of a zoom.
pub(super) fn title_size(zoom: f32) -> f32 {
    const SIZES: [f32; 6] = [20.0, 25.0, 31.0, 39.0, 48.0, 56.0];
    let wanted = 11.5 / zoom.max(1e-3);
    SIZES.into_iter().find(|size| *size >= wanted).unwrap_or(SIZES[SIZES.len() - 1])
}

/// A node of which only the title can be read: a few shapes, so that a large graph stays quick.
fn from_afar(painter: &egui::Painter, rect: egui::Rect, face: Face<'_>, visuals: &egui::Visuals) {
    let Face { card, node, status, zoom } = face;
    stripe(painter, rect, card, visuals);
    let scale = (0.62 / zoom.max(1e-3)).clamp(1.4, 3.0);
    let head = if card.is_collapsed { TITLE } else { TITLE + KIND + GAP };
    let middle = rect.min + vec2(10.0 + 4.0 * scale, 7.0 + 0.5 * head);
    status_sign(painter, status, status_colour(status, visuals), middle, scale);
    let text = if node.is_muted() { visuals.weak_text_color() } else { visuals.strong_text_color() };
    let size = title_size(zoom).min(if card.is_collapsed { 22.0 } else { f32::INFINITY });
    let left = middle.x + 7.0 * scale;
    let mut job = egui::text::LayoutJob::simple(node.name().to_owned(), egui::FontId::proportional(size), text, 0.0);
    // As much of it as the node has room for.
    job.wrap = egui::text::TextWrapping {
        max_width: rect.right() - 6.0 - left,
        max_rows: if size * 2.3 < card.size.y { 2 } else { 1 },
        break_anywhere: false,
        overflow_character: Some('…'),
    };
    let title = painter.layout_job(job);
    let beside_sign = middle.y - 0.5 * size * 1.2;
    let top = if title.rows.len() > 1 { rect.center().y - 0.5 * title.size().y } else { beside_sign };
    painter.galley(egui::pos2(left, top.max(rect.top() + 1.0)), title, text);
}

/// Draws a node of which only the title can be read without making a widget of it.
pub(super) fn paint(painter: &egui::Painter, place: Pos2, face: Face<'_>, selected: bool, visuals: &egui::Visuals) {
    let rect = face.card.rect(place);
    let stroke = if selected { visuals.selection.stroke } else { visuals.window_stroke };
    let stroke = egui::Stroke::new(visuals.selection.stroke.width, stroke.color);
    let radius = visuals.window_corner_radius;
    painter.rect(rect, radius, fill(face.node, visuals), stroke, egui::StrokeKind::Inside);
    from_afar(painter, rect, face, visuals);
}

/// A stripe along the upper edge in the colour of what the node gives, so that a large graph can be read by its colours.
fn stripe(painter: &egui::Painter, rect: egui::Rect, card: &Card, visuals: &egui::Visuals) {
    let Some(port) = card.outputs.first() else { return };
    let inner = rect.shrink(1.0);
    let stripe = egui::Rect::from_min_size(inner.min, vec2(inner.width(), 3.0));
    let mut radius = visuals.window_corner_radius;
    radius.sw = 0;
    radius.se = 0;
    painter.rect_filled(stripe, radius, port.colour(visuals.dark_mode).gamma_multiply(0.8));
}

/// The background of a node.
pub(super) fn fill(node: &Node, visuals: &egui::Visuals) -> Color32 {
    if node.is_muted() { visuals.window_fill.gamma_multiply(0.7) } else { visuals.window_fill }
}

/// A line of a node, as wide as all of them whatever it holds.
fn line(ui: &mut Ui, height: f32, content: impl FnOnce(&mut Ui)) {
    let (rect, _) = ui.allocate_exact_size(vec2(WIDTH, height), egui::Sense::hover());
    let layout = Layout::left_to_right(Align::Center);
    content(&mut ui.new_child(egui::UiBuilder::new().max_rect(rect).layout(layout)));
}

fn row(ui: &mut Ui, port: &Port, is_output: bool) {
    let text = RichText::new(&port.name).size(11.5);
    let text = if port.missing { text.color(ui.visuals().warn_fg_color) } else { text };
    let layout = if is_output { Layout::right_to_left(Align::Center) } else { Layout::left_to_right(Align::Center) };
    let (rect, _) = ui.allocate_exact_size(vec2(WIDTH, ROW), egui::Sense::hover());
    let label =
        ui.new_child(egui::UiBuilder::new().max_rect(rect).layout(layout)).add(egui::Label::new(text).truncate());
    label.on_hover_ui(|ui| {
        let wire = port.wire.map_or("unknown", |wire| wire.name());
        let needed = if port.missing { "\nnothing is linked here, and something must be" } else { "" };
        ui.label(format!("{} ({wire}): {}{needed}", port.name, port.description));
    });
}

/// What its outputs hold, in a few words.
fn summary(context: &PanelContext<'_>, id: NodeId) -> Option<String> {
    let values = context.values(id)?;
    let lines = values.iter().map(|value| format!("\n{}: {}", value.wire().name(), value.summary()));
    Some(lines.collect())
}

fn flags(ui: &mut Ui, context: &mut PanelContext<'_>, card: &Card, node: &Node) {
    let (id, name) = (card.id, node.name());
    let flag = |ui: &mut Ui, sign: &str, on: bool, what: &str, hint: &str| {
        let sign = RichText::new(sign).size(10.0);
        let response = ui.add(egui::Button::selectable(on, sign).small());
        response
            .widget_info(|| egui::WidgetInfo::selected(egui::WidgetType::Checkbox, true, on, format!("{what} {name}")));
        response.on_hover_text(hint).clicked()
    };
    let mut asked: Vec<Command> = Vec::new();
    if card.has_values
        && flag(ui, signs::EXPAND, context.view.expanded.contains(&id), "expand", "Show inputs that hold values")
    {
        asked.push(ViewCommand::Expand(id).into());
    }
    if node.body().is_some_and(|body| body.graph().is_some())
        && flag(ui, signs::ENTER, false, "enter", "Enter the graph within (Enter)")
    {
        asked.push(ViewCommand::Enter(id).into());
    }
    // Within a group only what is displayed, because what the whole graph shows stays behind it.
    let outermost = context.is_outermost();
    if outermost {
        let pinned = context.view.pinned.contains(&id);
        if flag(ui, signs::PIN, pinned, "pin", "Keep showing it behind what is displayed") {
            asked.push(ViewCommand::Pin(id).into());
        }
    }
    let displayed = if outermost { context.view.displayed } else { context.view.displayed_within } == Some(id);
    if flag(ui, signs::DISPLAY, displayed, "display", "Show only this node in the views (D)") {
        asked.push(ViewCommand::Display(id).into());
    }
    context.commands.extend(asked);
}

/// What can be done with the selected nodes, as a menu.
pub(crate) fn menu(ui: &mut Ui, context: &mut PanelContext<'_>, id: NodeId, node: &Node) {
    let mut item = |ui: &mut Ui, text: &str, keys: &str, command: Command| {
        if ui.add(egui::Button::new(text).shortcut_text(keys)).clicked() {
            context.commands.push(command);
            ui.close();
        }
    };
    if node.body().is_some_and(|body| body.graph().is_some()) {
        item(ui, "Enter", "Enter", ViewCommand::Enter(id).into());
        item(ui, "Ungroup", "Ctrl+Shift+G", GraphCommand::Ungroup.into());
        ui.separator();
    }
    item(ui, "Display", "D", ViewCommand::Display(id).into());
    item(ui, "Pin", "P", ViewCommand::Pin(id).into());
    item(ui, if node.is_muted() { "Unmute" } else { "Mute" }, "M", GraphCommand::Mute.into());
    ui.separator();
    item(ui, "Duplicate", "Ctrl+D", GraphCommand::Duplicate { keep_links: false }.into());
    item(ui, "Duplicate with links", "Ctrl+Shift+D", GraphCommand::Duplicate { keep_links: true }.into());
    item(ui, "Copy", "Ctrl+C", GraphCommand::Copy.into());
    item(ui, "Cut", "Ctrl+X", GraphCommand::Cut.into());
    item(ui, "Group", "Ctrl+G", GraphCommand::Group.into());
    ui.separator();
    item(ui, "Frame", "Ctrl+J", GraphCommand::Frame.into());
    item(ui, if node.is_collapsed() { "Open out" } else { "Collapse" }, "H", GraphCommand::Collapse.into());
    item(ui, "Swap inputs", "Alt+S", GraphCommand::Swap.into());
    item(ui, "Arrange selected", "Shift+L", GraphCommand::ArrangeSelected.into());
    ui.menu_button("Align", |ui| {
        for alignment in Alignment::ALL {
            let command: Command = GraphCommand::Align(alignment).into();
            let keys = keys_of(&command).unwrap_or_default();
            item(ui, alignment.name(), &keys, command);
        }
    });
    ui.separator();
    item(ui, "Dissolve", "Ctrl+Backspace", GraphCommand::Dissolve.into());
    item(ui, "Delete", "Delete", GraphCommand::Delete.into());
    ui.menu_button("Replace by", |ui| {
        let kinds: Vec<String> = context.catalogue.kinds().map(|kind| kind.name().to_owned()).collect();
        egui::ScrollArea::vertical().max_height(320.0).show(ui, |ui| {
            for kind in kinds.iter().filter(|kind| *kind != node.kind_name()) {
                if ui.button(kind).clicked() {
                    context.commands.push(GraphCommand::Replace(kind.clone()).into());
                    ui.close();
                }
            }
        });
    });
    if let Some(maquette_graph::BodySource::File(file)) = node.body().map(|body| body.source()) {
        let path = context.document.folder().join(file);
        if ui.button("Open its file").clicked() {
            context.commands.push(FileCommand::Open(path).into());
            ui.close();
        }
    }
}
