//! All that is wrong: with the file, and with what the nodes said. A click goes there.

use egui::{RichText, Ui};
use maquette_graph::OutcomeState;
use maquette_graph::file::Severity;

use crate::command::ViewCommand;
use crate::panel::PanelContext;
use crate::signs;

/// One line of the list.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Entry {
    pub(crate) is_error: bool,
    /// The node, by its name or path.
    pub(crate) node: Option<String>,
    pub(crate) text: String,
}

/// Everything that is wrong, errors first.
pub(crate) fn entries(context: &PanelContext<'_>) -> Vec<Entry> {
    let file = context.document.problems().iter().filter(|problem| problem.severity != Severity::Note);
    let mut entries: Vec<Entry> = file
        .map(|problem| Entry {
            is_error: problem.severity == Severity::Error,
            node: problem.node.clone(),
            text: format!("in the file as it was opened, {problem}"),
        })
        .collect();
    for (_, outcome) in context.results.evaluation().into_iter().flat_map(|evaluation| evaluation.outcomes()) {
        let entry = |is_error, text| Entry { is_error, node: Some(outcome.name.clone()), text };
        match &outcome.state {
            OutcomeState::Failed(failure) => entries.push(entry(true, failure.to_string())),
            OutcomeState::Done { report, .. } => {
                entries.extend(report.warnings.iter().map(|warning| entry(false, warning.clone())));
            }
            OutcomeState::Waiting(_) | OutcomeState::Cancelled => {}
        }
    }
    entries.sort_by_key(|entry| !entry.is_error);
    entries
}

pub(crate) fn show(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let entries = entries(context);
    if entries.is_empty() {
        ui.label(RichText::new("Nothing is wrong.").weak());
    }
    egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        for entry in entries {
            let (sign, colour) = if entry.is_error {
                (signs::ERROR, ui.visuals().error_fg_color)
            } else {
                (signs::WARNING, ui.visuals().warn_fg_color)
            };
            ui.horizontal_wrapped(|ui| {
                ui.label(RichText::new(sign).color(colour));
                if let Some(node) = &entry.node
                    && ui.link(node).on_hover_text("Go to the node").clicked()
                {
                    context.ask(ViewCommand::Find(node.clone()));
                }
                ui.label(&entry.text);
            });
        }
    });
}
