//! What the evaluation gave, as the panels see it.

use std::sync::Arc;
use std::time::{Duration, Instant};

use maquette_graph::{Evaluation, NodeId, Outcome, OutcomeState, Report, Value};

use crate::drawable::Shown;
use crate::evaluation_worker::{Finished, NodeStatus, Span, Statuses};

/// The last evaluation, and how far the next one is.
#[derive(Default)]
pub struct Results {
    finished: Option<Finished>,
    statuses: Arc<Statuses>,
    /// The newest generation that was asked for.
    wanted: u64,
    progress: Option<(usize, usize)>,
    /// Since when what is shown is no longer that of the graph.
    old_since: Option<Instant>,
}

/// How long a result may be old before it is worth a word: what follows a drag should not flicker.
const WORTH_A_WORD: Duration = Duration::from_millis(250);

impl Results {
    pub(crate) fn accept(&mut self, finished: Finished) {
        // The last good picture stays where an evaluation was stopped.
        if finished.evaluation.cancelled && self.finished.is_some() {
            return;
        }
        self.finished = Some(finished);
        if self.is_current() {
            self.old_since = None;
        }
    }

    pub(crate) fn update(&mut self, statuses: Arc<Statuses>, progress: Option<(usize, usize)>) {
        self.statuses = statuses;
        self.progress = progress;
    }

    pub(crate) fn expect(&mut self, generation: u64) {
        self.wanted = generation;
        self.old_since.get_or_insert_with(Instant::now);
    }

    /// Whether what is shown has been old for so long that one should know.
    pub(crate) fn is_late(&self) -> bool {
        self.old_since.is_some_and(|since| since.elapsed() > WORTH_A_WORD)
    }

    /// Forgets everything, for another document.
    pub(crate) fn clear(&mut self) {
        self.finished = None;
    }

    /// Whether what is shown is that of the graph as it is now.
    pub fn is_current(&self) -> bool {
        self.finished.as_ref().is_some_and(|finished| finished.generation == self.wanted)
    }

    /// How many of the scheduled nodes are done, while something runs.
    pub fn progress(&self) -> Option<(usize, usize)> {
        self.progress
    }

    /// The last evaluation.
    pub fn evaluation(&self) -> Option<&Evaluation> {
        self.finished.as_ref().map(|finished| &finished.evaluation)
    }

    /// The last evaluation of the graph within these nodes; of the whole graph where there are none. `None` where nothing
    /// within was asked for.
    pub fn evaluation_within(&self, path: &[NodeId]) -> Option<&Evaluation> {
        if path.is_empty() {
            return self.evaluation();
        }
        let (evaluated, within) = self.finished.as_ref()?.within.as_ref()?;
        (evaluated == path).then_some(within)
    }

    /// When each node ran in it.
    pub(crate) fn timeline(&self) -> &[Span] {
        self.finished.as_ref().map_or(&[], |finished| &finished.timeline)
    }

    /// What the views show.
    pub(crate) fn shown(&self) -> &[Shown] {
        self.finished.as_ref().map_or(&[], |finished| &finished.shown)
    }

    /// How it stands with a node, by its name or path.
    pub fn status(&self, path: &str) -> Option<&NodeStatus> {
        self.statuses.get(path)
    }

    /// What became of a node of the whole graph.
    pub fn outcome(&self, node: NodeId) -> Option<&Outcome> {
        self.evaluation()?.outcome(node)
    }

    /// The outputs of a node of the whole graph that was asked for.
    pub fn values(&self, node: NodeId) -> Option<&[Value]> {
        self.evaluation()?.values(node)
    }

    /// What a node of the whole graph said beside its values.
    pub fn report(&self, node: NodeId) -> Option<&Report> {
        match &self.outcome(node)?.state {
            OutcomeState::Done { report, .. } => Some(report),
            _ => None,
        }
    }
}
