//! The panels. Each is a projection of the document and the results, and knows nothing of the others.

pub(crate) mod data;
pub(crate) mod help;
pub(crate) mod history;
pub(crate) mod inspector;
pub(crate) mod palette;
pub(crate) mod performance;
pub(crate) mod problems;
pub mod tour;
pub(crate) mod welcome;

use maquette_graph::{Catalogue, Graph, Node, NodeId, Outcome, OutcomeState, Report, Value};

use crate::command::Command;
use crate::document::Document;
use crate::drawable::Shown;
use crate::reference_pictures::ReferencePictures;
use crate::results::Results;
use crate::view_state::{Settings, ViewState};

/// What every panel sees, and where it leaves what it asks for.
pub(crate) struct PanelContext<'a> {
    pub(crate) catalogue: &'a Catalogue,
    pub(crate) document: &'a Document,
    pub(crate) results: &'a Results,
    pub(crate) view: &'a ViewState,
    pub(crate) settings: &'a mut Settings,
    pub(crate) pictures: &'a ReferencePictures,
    pub(crate) commands: &'a mut Vec<Command>,
}

impl<'a> PanelContext<'a> {
    /// The graph on the canvas.
    pub(crate) fn graph(&self) -> &'a Graph {
        self.document.graph_at(&self.view.path).unwrap_or(self.document.graph())
    }

    /// The node that the inspector shows.
    pub(crate) fn active(&self) -> Option<(NodeId, &'a Node)> {
        let id = self.view.active?;
        Some((id, self.graph().node(id)?))
    }

    /// How the results call a node of the canvas.
    pub(crate) fn path_of(&self, name: &str) -> String {
        let mut path = String::new();
        let mut graph = self.document.graph();
        for id in &self.view.path {
            let Some(node) = graph.node(*id) else { break };
            path.push_str(node.name());
            path.push('/');
            let Some(within) = node.body().and_then(|body| body.graph()) else { break };
            graph = within;
        }
        path.push_str(name);
        path
    }

    /// What became of a node of the canvas.
    pub(crate) fn outcome(&self, id: NodeId) -> Option<&'a Outcome> {
        self.results.evaluation_within(&self.view.path)?.outcome(id)
    }

    /// The outputs of a node of the canvas that was asked for.
    pub(crate) fn values(&self, id: NodeId) -> Option<&'a [Value]> {
        self.results.evaluation_within(&self.view.path)?.values(id)
    }

    /// What a node of the canvas said beside its values.
    pub(crate) fn report(&self, id: NodeId) -> Option<&'a Report> {
        match &self.outcome(id)?.state {
            OutcomeState::Done { report, .. } => Some(report),
            _ => None,
        }
    }

    /// Whether something is of a node of the canvas.
    pub(crate) fn is_here(&self, shown: &Shown) -> bool {
        shown.path == self.view.path
    }

    /// Whether surfaces of something are drawn, and not only its lines: of what is displayed, or of the results. Asked of each
    /// thing that is shown; what the whole graph shows is found once.
    pub(crate) fn drawn(&self) -> impl Fn(&Shown) -> bool + use<'a> {
        let (view, whole) = (self.view, self.view.drawn(self.document.graph()));
        move |shown| match view.displayed_within {
            Some(node) => shown.path == view.path && shown.node == node,
            None => shown.path.is_empty() && whole.contains(&shown.node),
        }
    }

    /// Whether the whole graph is on the canvas.
    pub(crate) fn is_outermost(&self) -> bool {
        self.view.path.is_empty()
    }

    pub(crate) fn ask(&mut self, command: impl Into<Command>) {
        self.commands.push(command.into());
    }
}
