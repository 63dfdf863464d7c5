//! The inspector: the active node's name, note and inputs, each by its kind. It is made of what kinds declare about
//! themselves.

mod order;
mod references;
mod strokes;
mod value;

use egui::{Align, Layout, RichText, Ui};
use maquette_graph::{Edit, InputSpec, Literal, Node, NodeId, OutcomeState, Source};

use crate::command::{FileCommand, FileTarget, GraphCommand, ViewCommand};
use crate::panel::PanelContext;
use crate::signs;

use self::value::{Changed, edit_literal};

/// The inspector.
#[derive(Default)]
pub(crate) struct Inspector {
    /// The name while it is typed.
    name: Option<(NodeId, String)>,
    /// The note while it is typed.
    note: Option<(NodeId, String)>,
}

impl Inspector {
    pub(crate) fn show(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            ui.set_width(ui.available_width());
            match context.active() {
                Some((id, node)) => {
                    if context.view.selection.len() > 1 {
                        let hint = format!(
                            "{} nodes selected; a value set here is set in all that have it",
                            context.view.selection.len()
                        );
                        ui.label(RichText::new(hint).weak());
                    }
                    self.node(ui, context, id, node);
                }
                None => {
                    graph(ui, context);
                    references::show(ui, context);
                }
            }
        });
    }

    fn node(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>, id: NodeId, node: &Node) {
        self.heading(ui, context, id, node);
        match node.kind() {
            Some(kind) => {
                ui.label(RichText::new(kind.description()).weak());
                if !kind.reference_text().is_empty() {
                    ui.label(RichText::new(kind.reference_text()).weak().italics().size(11.0));
                }
                outcome(ui, context, id);
                ui.separator();
                for input in kind.inputs() {
                    row(ui, context, id, node, input);
                }
            }
            None => {
                let text = format!(
                    "This version does not know the kind \"{}\". It is kept as it is; replace it, or open the graph with a \
                     newer version.",
                    node.kind_name()
                );
                ui.label(RichText::new(text).color(ui.visuals().warn_fg_color));
                for (name, source) in node.sources() {
                    ui.label(format!("{name}: {}", held(context, source)));
                }
            }
        }
        ui.separator();
        self.note(ui, context, id, node);
    }

    fn heading(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>, id: NodeId, node: &Node) {
        let mut name = match &self.name {
            Some((of, name)) if *of == id => name.clone(),
            _ => node.name().to_owned(),
        };
        let field = egui::TextEdit::singleline(&mut name).font(egui::TextStyle::Heading).desired_width(f32::INFINITY);
        let field = ui.add(field);
        field.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::TextEdit, true, "name of the node"));
        // Asked before anything takes the focus away.
        let done = field.lost_focus();
        if field.has_focus() || field.changed() {
            self.name = Some((id, name.clone()));
        }
        if done {
            self.name = None;
            if name != node.name() && !ui.input(|i| i.key_pressed(egui::Key::Escape)) {
                context.ask(GraphCommand::edit(Edit::Rename { node: id, name }));
            }
        }
    }

    fn note(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>, id: NodeId, node: &Node) {
        let mut note = match &self.note {
            Some((of, note)) if *of == id => note.clone(),
            _ => node.note().to_owned(),
        };
        ui.label(RichText::new("Note").weak());
        let field = egui::TextEdit::multiline(&mut note)
            .desired_rows(2)
            .desired_width(f32::INFINITY)
            .hint_text("what others should know");
        let field = ui.add(field);
        field.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::TextEdit, true, "note"));
        let done = field.lost_focus();
        if field.has_focus() || field.changed() {
            self.note = Some((id, note.clone()));
        }
        if done {
            self.note = None;
            if note != node.note() {
                context.ask(GraphCommand::edit(Edit::Note { node: id, note }));
            }
        }
    }
}

/// What the last evaluation said of a node.
fn outcome(ui: &mut Ui, context: &PanelContext<'_>, id: NodeId) {
    let Some(outcome) = context.outcome(id) else { return };
    match &outcome.state {
        OutcomeState::Failed(failure) => {
            ui.label(RichText::new(failure.to_string()).color(ui.visuals().error_fg_color));
        }
        OutcomeState::Waiting(on) => {
            ui.label(RichText::new(format!("waits for {}", on.join(", "))).color(ui.visuals().warn_fg_color));
        }
        OutcomeState::Done { report, .. } => {
            for warning in &report.warnings {
                ui.label(RichText::new(format!("{} {warning}", signs::WARNING)).color(ui.visuals().warn_fg_color));
            }
            for note in &report.notes {
                ui.label(RichText::new(note).weak().size(11.5));
            }
        }
        OutcomeState::Cancelled => {}
    }
}

/// What an input holds, in words.
fn held(context: &PanelContext<'_>, source: &Source) -> String {
    match source {
        Source::Literal { literal, .. } => literal.to_value().summary(),
        Source::Link(link) => {
            let name = context.graph().node(link.node).map_or("?", |node| node.name());
            format!("{} {name}.{}", signs::FROM, link.output)
        }
        Source::Parameter(name) => format!("{} parameter {name}", signs::FROM),
        Source::Unread(text) => text.clone(),
    }
}

fn row(ui: &mut Ui, context: &mut PanelContext<'_>, id: NodeId, node: &Node, input: &InputSpec) {
    let source = node.source(&input.name);
    let range = input.range.map(|range| format!("\n{range} {}", input.unit)).unwrap_or_default();
    let hint = format!("{}{range}", input.description);
    ui.horizontal(|ui| {
        let name = RichText::new(&input.name);
        let name = if source.is_some() { name.strong() } else { name };
        ui.label(name).on_hover_text(&hint);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| buttons(ui, context, id, node, input));
    });
    match source {
        Some(Source::Link(link)) => {
            let from = held(context, &Source::Link(link.clone()));
            let response = ui.link(from).on_hover_text("Go to the node it comes from");
            if response.clicked() {
                context.ask(ViewCommand::Select(vec![link.node]));
            }
        }
        Some(Source::Parameter(name)) => {
            match context
                .graph()
                .parameter(name)
                .map(|parameter| (parameter.spec().clone(), parameter.value().cloned()))
            {
                Some((spec, Some(value))) => {
                    ui.label(RichText::new(format!("parameter {name}")).weak().size(11.0));
                    let changed = edit_literal(ui, context, &format!("parameter {name}"), &spec, &value);
                    set_parameter(context, name, changed);
                }
                _ => {
                    ui.label(RichText::new(format!("parameter {name}, which holds nothing here")).weak());
                }
            }
        }
        Some(Source::Unread(text)) => {
            let text = format!("not understood, and kept: {text}");
            ui.label(RichText::new(text).color(ui.visuals().warn_fg_color));
        }
        Some(Source::Literal { literal, .. }) => literal_row(ui, context, id, input, literal),
        None => match &input.default {
            Some(default) => literal_row(ui, context, id, input, default),
            None if input.optional => {
                ui.label(RichText::new(format!("nothing linked; takes {}", input.wire)).weak());
            }
            None => {
                let text = format!("link an output that gives {}", input.wire);
                ui.label(RichText::new(text).color(ui.visuals().warn_fg_color));
            }
        },
    }
    if order::is_order(input) {
        order::show(ui, context, id, input, source);
    }
    ui.add_space(4.0);
}

fn buttons(ui: &mut Ui, context: &mut PanelContext<'_>, id: NodeId, node: &Node, input: &InputSpec) {
    let source = node.source(&input.name);
    let small = |ui: &mut Ui, sign: &str, label: String, hint: &str| {
        let response = ui.add(egui::Button::new(RichText::new(sign).size(11.0)).small().frame(false));
        response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, &label));
        response.on_hover_text(hint).clicked()
    };
    if source.is_some() && small(ui, signs::RESET, format!("reset {}", input.name), "Back to the default, unlinked") {
        let edits = vec![Edit::Reset { node: id, input: input.name.clone() }];
        context.ask(GraphCommand::Edit { name: format!("reset {}", input.name), edits, gesture: None });
    }
    let promotable =
        input.default.is_some() && !matches!(source, Some(Source::Link(_) | Source::Parameter(_) | Source::Unread(_)));
    if promotable && small(ui, signs::PROMOTE, format!("promote {}", input.name), "Make it a parameter of the graph") {
        context.ask(GraphCommand::Promote { node: id, input: input.name.clone() });
    }
}

fn literal_row(ui: &mut Ui, context: &mut PanelContext<'_>, id: NodeId, input: &InputSpec, literal: &Literal) {
    if let Literal::Strokes(strokes) = literal {
        strokes::show(ui, context, id, input, strokes);
        return;
    }
    let changed = edit_literal(ui, context, &input.name, input, literal);
    if let Some(value) = changed.value {
        // With several nodes selected, all that have such an input get it.
        let mut nodes: Vec<NodeId> = vec![id];
        nodes.extend(context.view.selection.iter().copied().filter(|other| *other != id));
        let graph = context.graph();
        let fits = |node: &NodeId| {
            let spec = graph.node(*node).and_then(|node| node.kind()?.find_input(&input.name));
            spec.is_some_and(|spec| spec.wire == input.wire && spec.options == input.options)
        };
        let edits =
            nodes.iter().filter(|node| fits(node)).map(|node| Edit::set(*node, input.name.clone(), value.clone()));
        let command = GraphCommand::Edit {
            name: format!("set {}", input.name),
            edits: edits.collect(),
            gesture: changed.dragging.then(|| format!("set {id:?} {}", input.name)),
        };
        context.ask(command);
    }
    if changed.released {
        context.ask(GraphCommand::EndGesture);
    }
    if changed.browse {
        let target = FileTarget::Input { node: id, input: input.name.clone() };
        context.ask(FileCommand::Browse { target, extensions: input.extensions.clone() });
    }
}

fn set_parameter(context: &mut PanelContext<'_>, name: &str, changed: Changed) {
    if let Some(value) = changed.value {
        let edits = vec![Edit::SetParameter { parameter: name.to_owned(), literal: Some(value) }];
        let gesture = changed.dragging.then(|| format!("parameter {name}"));
        context.ask(GraphCommand::Edit { name: format!("set {name}"), edits, gesture });
    }
    if changed.released {
        context.ask(GraphCommand::EndGesture);
    }
    if changed.browse {
        let extensions = context.graph().parameter(name).map(|parameter| parameter.spec().extensions.clone());
        let target = FileTarget::Parameter(name.to_owned());
        context.ask(FileCommand::Browse { target, extensions: extensions.unwrap_or_default() });
    }
}

/// The graph itself, where no node is active: its notes and parameters.
fn graph(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let graph = context.graph();
    ui.heading(context.document.name());
    if !graph.notes.is_empty() {
        ui.label(RichText::new(&graph.notes).weak());
    }
    ui.separator();
    if graph.parameters().len() == 0 {
        ui.label(
            RichText::new("Select a node to see its inputs. ⏶ beside an input makes it a parameter of the graph.")
                .weak(),
        );
    }
    for parameter in graph.parameters() {
        ui.horizontal(|ui| {
            ui.label(RichText::new(parameter.name()).strong()).on_hover_text(parameter.description());
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let remove = ui.add(egui::Button::new(signs::REMOVE).small().frame(false));
                let label = format!("remove parameter {}", parameter.name());
                remove.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, &label));
                if remove.on_hover_text("Remove the parameter; inputs keep its value").clicked() {
                    context.ask(GraphCommand::edit(Edit::RemoveParameter(parameter.name().to_owned())));
                }
            });
        });
        match parameter.value() {
            Some(value) => {
                let label = format!("parameter {}", parameter.name());
                let changed = edit_literal(ui, context, &label, parameter.spec(), value);
                set_parameter(context, parameter.name(), changed);
            }
            None => {
                ui.label(RichText::new(format!("takes {} from who uses the graph", parameter.wire())).weak());
            }
        }
        ui.add_space(4.0);
    }
}
