//! What is drawn on a node: its name, how it stands with it, its flags, its ports.

use egui::{Align, Color32, Layout, RichText, Ui};
use maquette_graph::{Node, NodeId};

use crate::command::{Command, FileCommand, GraphCommand, ViewCommand};
use crate::evaluation_worker::NodeStatus;
use crate::panel::PanelContext;
use crate::signs;

use super::arrange::WIDTH;
use super::ports::{self, Port};

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

/// A colour and words for how it stands with a node.
fn status_of(status: Option<&NodeStatus>, ui: &Ui) -> (Color32, String) {
    let visuals = ui.visuals();
    let good = if visuals.dark_mode { Color32::from_rgb(110, 200, 120) } else { Color32::from_rgb(20, 120, 50) };
    match status {
        None => (visuals.weak_text_color(), "not evaluated: nothing that is shown needs it".to_owned()),
        Some(NodeStatus::Running(share)) => (visuals.hyperlink_color, format!("running, {:.0} %", share * 100.0)),
        Some(NodeStatus::Done(duration)) => (good, format!("done in {}", time(*duration))),
        Some(NodeStatus::Hit) => (good, "known: nothing that it depends on changed".to_owned()),
        Some(NodeStatus::Failed { port, message }) => {
            let at = port.as_ref().map(|port| format!("input \"{port}\": ")).unwrap_or_default();
            (visuals.error_fg_color, format!("{at}{message}"))
        }
        Some(NodeStatus::Waiting(on)) => (visuals.warn_fg_color, format!("waits for {}", on.join(", "))),
        Some(NodeStatus::Stopped) => (visuals.warn_fg_color, "stopped".to_owned()),
    }
}

/// A dot, filled where the node has a result, a ring where it has none yet, a cross where it failed.
fn status_dot(ui: &mut Ui, status: Option<&NodeStatus>, colour: Color32, words: &str) {
    let (rect, response) = ui.allocate_exact_size(egui::vec2(11.0, 14.0), egui::Sense::hover());
    let middle = rect.center();
    let stroke = egui::Stroke::new(1.8, colour);
    match status {
        Some(NodeStatus::Done(_) | NodeStatus::Hit) => {
            ui.painter().circle_filled(middle, 4.0, colour);
        }
        Some(NodeStatus::Failed { .. }) => {
            let arm = egui::vec2(3.5, 3.5);
            let other = egui::vec2(3.5, -3.5);
            ui.painter().line_segment([middle - arm, middle + arm], stroke);
            ui.painter().line_segment([middle - other, middle + other], stroke);
        }
        _ => {
            ui.painter().circle_stroke(middle, 3.5, stroke);
        }
    }
    response.on_hover_text(words);
}

/// Zoom below which only the title is worth reading.
const TITLE_ONLY: f32 = 0.62;
/// Heights of the lines of a node and of what is between them, points.
const TITLE: f32 = 18.0;
const KIND: f32 = 16.0;
const ROW: f32 = 16.0;
const GAP: f32 = 2.0;

/// Draws the inside of a node and places its sockets.
pub(crate) fn show(
    ui: &mut Ui,
    sockets: &mut egui_graph::SocketLayout,
    context: &mut PanelContext<'_>,
    id: NodeId,
    node: &Node,
    zoom: f32,
) {
    ui.set_width(WIDTH);
    ui.spacing_mut().item_spacing = egui::vec2(4.0, GAP);
    ui.style_mut().interaction.selectable_labels = false;
    let status = context.results.status(&context.path_of(node.name()));
    let (colour, words) = status_of(status, ui);
    let outcome = context.results.outcome(id).filter(|_| context.is_outermost());
    let expanded = context.view.expanded.contains(&id);
    let inputs: Vec<(usize, Port)> =
        ports::inputs(node).into_iter().enumerate().filter(|(_, port)| ports::is_shown(port, expanded)).collect();
    let outputs = ports::outputs(context.graph(), id, node);
    if zoom < TITLE_ONLY {
        let rows = inputs.iter().map(|(socket, _)| (Some(*socket), None));
        let rows = rows.chain((0..outputs.len()).map(|socket| (None, Some(socket))));
        from_afar(ui, sockets, node, zoom, (status, colour, &words), rows.collect());
        return;
    }
    line(ui, TITLE, |ui| {
        status_dot(ui, status, colour, &words);
        let name = RichText::new(node.name()).strong().size(13.5);
        let name = if node.is_muted() { name.strikethrough().weak() } else { name };
        let summary = context.is_outermost().then(|| summary(context, id)).flatten().unwrap_or_default();
        let kind = node.kind().map_or("unknown kind".to_owned(), |kind| kind.description().to_owned());
        ui.add(egui::Label::new(name).truncate()).on_hover_text(format!("{}: {kind}{summary}", node.kind_name()));
    });
    line(ui, KIND, |ui| {
        ui.spacing_mut().button_padding = egui::vec2(3.0, 0.0);
        let unknown = node.kind().is_none();
        let kind = RichText::new(node.kind_name()).size(10.5);
        let kind = if unknown { kind.color(ui.visuals().warn_fg_color) } else { kind.weak() };
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if let Some(outcome) = outcome.filter(|outcome| !outcome.duration.is_zero()) {
                ui.label(RichText::new(time(outcome.duration)).size(10.0).weak());
            }
            flags(ui, context, id, node);
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| ui.add(egui::Label::new(kind).truncate()));
        });
    });
    if let Some(NodeStatus::Running(share)) = status {
        #[expect(clippy::cast_possible_truncation, reason = "a share")]
        ui.add(egui::ProgressBar::new(*share as f32).desired_height(3.0));
    }
    if matches!(status, Some(NodeStatus::Failed { .. })) {
        let badge = RichText::new(&words).size(10.5).color(ui.visuals().error_fg_color);
        ui.add(egui::Label::new(badge).truncate()).on_hover_text(&words);
    }
    for (socket, port) in &inputs {
        sockets.row(ui, Some(*socket), None, |ui| row(ui, port, false));
    }
    for (socket, port) in outputs.iter().enumerate() {
        sockets.row(ui, None, Some(socket), |ui| row(ui, port, true));
    }
}

/// A node of which only the title can be read: one widget, so that a large graph stays quick.
fn from_afar(
    ui: &mut Ui,
    sockets: &mut egui_graph::SocketLayout,
    node: &Node,
    zoom: f32,
    (status, colour, words): (Option<&NodeStatus>, Color32, &str),
    rows: Vec<(Option<usize>, Option<usize>)>,
) {
    #[expect(clippy::cast_precision_loss, reason = "a few ports")]
    let count = rows.len() as f32;
    let head = TITLE + KIND + 2.0 * GAP;
    let (rect, response) =
        ui.allocate_exact_size(egui::vec2(WIDTH, head + count * (ROW + GAP) - GAP), egui::Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Label, true, node.name()));
    response.on_hover_text(format!("{}: {words}", node.kind_name()));
    let middle = rect.left_top() + egui::vec2(8.0, 0.5 * head);
    match status {
        Some(NodeStatus::Done(_) | NodeStatus::Hit) => ui.painter().circle_filled(middle, 6.0, colour),
        _ => ui.painter().circle_stroke(middle, 6.0, egui::Stroke::new(3.0, colour)),
    };
    let size = (12.0 / zoom.max(1e-3)).min(27.0);
    let text = if node.is_muted() { ui.visuals().weak_text_color() } else { ui.visuals().strong_text_color() };
    let place = egui::pos2(rect.left() + 19.0, middle.y);
    let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
    painter.text(place, egui::Align2::LEFT_CENTER, node.name(), egui::FontId::proportional(size), text);
    let mut cross = rect.top() + head + 0.5 * ROW;
    for (input, output) in rows {
        if let Some(socket) = input {
            sockets.input_at(socket, cross);
        }
        if let Some(socket) = output {
            sockets.output_at(socket, cross);
        }
        cross += ROW + GAP;
    }
}

/// A line of a node, as wide as all of them whatever it holds.
fn line(ui: &mut Ui, height: f32, content: impl FnOnce(&mut Ui)) {
    let (rect, _) = ui.allocate_exact_size(egui::vec2(WIDTH, height), egui::Sense::hover());
    let layout = Layout::left_to_right(Align::Center);
    content(&mut ui.new_child(egui::UiBuilder::new().max_rect(rect).layout(layout)));
}

fn row(ui: &mut Ui, port: &Port, is_output: bool) {
    let text = RichText::new(&port.name).size(11.5);
    let text = if port.missing { text.color(ui.visuals().warn_fg_color) } else { text };
    let layout = if is_output { Layout::right_to_left(Align::Center) } else { Layout::left_to_right(Align::Center) };
    ui.allocate_ui_with_layout(egui::vec2(WIDTH, ROW), layout, |ui| {
        let label = ui.label(text);
        if label.hovered() {
            let wire = port.wire.map_or("unknown", |wire| wire.name());
            let needed = if port.missing { "\nnothing is linked here, and something must be" } else { "" };
            label.on_hover_text(format!("{} ({wire}): {}{needed}", port.name, port.description));
        }
    });
}

/// What its outputs hold, in a few words.
fn summary(context: &PanelContext<'_>, id: NodeId) -> Option<String> {
    let values = context.results.values(id)?;
    let lines = values.iter().map(|value| format!("\n{}: {}", value.wire().name(), value.summary()));
    Some(lines.collect())
}

fn flags(ui: &mut Ui, context: &mut PanelContext<'_>, id: NodeId, node: &Node) {
    let name = node.name();
    let flag = |ui: &mut Ui, sign: &str, on: bool, what: &str, hint: &str| {
        let sign = RichText::new(sign).size(10.0);
        let response = ui.add(egui::Button::selectable(on, sign).small());
        let label = format!("{what} {name}");
        response.widget_info(|| egui::WidgetInfo::selected(egui::WidgetType::Checkbox, true, on, &label));
        response.on_hover_text(hint).clicked()
    };
    let mut asked: Vec<Command> = Vec::new();
    if ports::inputs(node).iter().any(|port| port.typed && !port.linked)
        && flag(ui, signs::EXPAND, context.view.expanded.contains(&id), "expand", "Show inputs that hold values")
    {
        asked.push(ViewCommand::Expand(id).into());
    }
    if node.body().is_some_and(|body| body.graph().is_some())
        && flag(ui, signs::ENTER, false, "enter", "Enter the graph within (Enter)")
    {
        asked.push(ViewCommand::Enter(id).into());
    }
    if context.is_outermost() {
        let pinned = context.view.pinned.contains(&id);
        if flag(ui, signs::PIN, pinned, "pin", "Keep showing it behind what is displayed") {
            asked.push(ViewCommand::Pin(id).into());
        }
        let displayed = context.view.displayed == Some(id);
        if flag(ui, signs::DISPLAY, displayed, "display", "Show only this node in the views (D)") {
            asked.push(ViewCommand::Display(id).into());
        }
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
