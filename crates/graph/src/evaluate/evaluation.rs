//! What an evaluation gave.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;
use std::time::Duration;

use crate::graph::NodeId;
use crate::node_kind::NodeKind;
use crate::report::Report;
use crate::value::{Value, Wire};

/// Why a node has no result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// The input at fault, where one is.
    pub port: Option<String>,
    /// What is wrong and what to do.
    pub message: String,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.port {
            Some(port) => write!(f, "input \"{port}\": {}", self.message),
            None => f.write_str(&self.message),
        }
    }
}

/// How it stands with a node after an evaluation.
#[derive(Clone, Debug)]
pub enum OutcomeState {
    /// It has a result.
    Done {
        /// Its outputs in order; kept for the nodes that were asked for, dropped early for the others.
        values: Option<Arc<[Value]>>,
        /// What it said beside its values.
        report: Arc<Report>,
    },
    /// It failed.
    Failed(Failure),
    /// It did not run, because these nodes failed.
    Waiting(Vec<String>),
    /// It was stopped, or never reached, because the evaluation was cancelled.
    Cancelled,
}

/// What became of a node.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Its name.
    pub name: String,
    /// Its kind.
    pub kind: String,
    /// How it stands.
    pub state: OutcomeState,
    /// Whether it ran now; otherwise the memo answered, or nothing did.
    pub ran: bool,
    /// Time of the run that gave this result, now or earlier.
    pub duration: Duration,
}

/// What an evaluation gave: one outcome for each node that it had to look at.
#[derive(Clone, Debug, Default)]
pub struct Evaluation {
    pub(crate) outcomes: BTreeMap<NodeId, Outcome>,
    /// The kinds of the nodes that were asked for, or examined.
    pub(crate) kinds: BTreeMap<NodeId, Arc<NodeKind>>,
    /// Time of the whole evaluation.
    pub duration: Duration,
    /// Whether it was cancelled before every target had its result.
    pub cancelled: bool,
}

impl Evaluation {
    /// The nodes looked at, in the order of the graph.
    pub fn outcomes(&self) -> impl ExactSizeIterator<Item = (NodeId, &Outcome)> {
        self.outcomes.iter().map(|(id, outcome)| (*id, outcome))
    }

    /// What became of a node; `None` where the evaluation had no need to look at it.
    pub fn outcome(&self, node: NodeId) -> Option<&Outcome> {
        self.outcomes.get(&node)
    }

    /// The outputs of a node that was asked for and has a result.
    pub fn values(&self, node: NodeId) -> Option<&[Value]> {
        match &self.outcomes.get(&node)?.state {
            OutcomeState::Done { values, .. } => values.as_deref(),
            _ => None,
        }
    }

    /// One output of a node that was asked for, as `T`.
    pub fn value<T: Wire>(&self, node: NodeId, output: &str) -> Option<&T> {
        let (place, _) = self.kinds.get(&node)?.find_output(output)?;
        self.values(node)?.get(place)?.get()
    }

    /// The nodes that failed, with the reason.
    pub fn failures(&self) -> impl Iterator<Item = (&Outcome, &Failure)> {
        self.outcomes.values().filter_map(|outcome| match &outcome.state {
            OutcomeState::Failed(failure) => Some((outcome, failure)),
            _ => None,
        })
    }

    /// Number of nodes that ran.
    pub fn run_count(&self) -> usize {
        self.outcomes.values().filter(|o| o.ran).count()
    }

    /// Number of nodes in whose place the memo answered.
    pub fn hit_count(&self) -> usize {
        self.outcomes.values().filter(|o| !o.ran && matches!(o.state, OutcomeState::Done { .. })).count()
    }

    /// Whether every node looked at has a result.
    pub fn is_complete(&self) -> bool {
        !self.cancelled && self.outcomes.values().all(|o| matches!(o.state, OutcomeState::Done { .. }))
    }
}
