//! Measures, on the values of the nodes asked for, what their kinds measure on request only.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use crate::evaluate::call;
use crate::evaluate::inputs::{Key, failure};
use crate::evaluate::memo::{Entry, Memo};
use crate::evaluate::{CancelToken, Evaluation, Event, EventKind, Events, OutcomeState};
use crate::graph::NodeId;
use crate::node_kind::NodeKind;
use crate::ports::NodeError;
use crate::report::Report;
use crate::value::{ContentHash, ContentHasher, Value};

pub(crate) struct Examiner<'a> {
    pub(crate) memo: &'a Memo,
    pub(crate) cancel: &'a CancelToken,
    pub(crate) events: &'a dyn Events,
}

/// Beside the key of a node's values, so that both go through one memo and one budget.
fn key_of_examination(key: ContentHash) -> ContentHash {
    let mut hasher = ContentHasher::new("examination");
    hasher.hash(key);
    hasher.finish()
}

impl Examiner<'_> {
    /// Adds to the reports of these nodes. A node whose examination fails has failed.
    pub(crate) fn examine(
        &self,
        evaluation: &mut Evaluation,
        nodes: &[NodeId],
        key_of: impl Fn(NodeId) -> Option<Key>,
    ) {
        for id in nodes {
            let Some(kind) = evaluation.kinds.get(id) else { continue };
            let (Some(outcome), Some(key)) = (evaluation.outcomes.get_mut(id), key_of(*id)) else { continue };
            let OutcomeState::Done { values: Some(values), report } = &mut outcome.state else { continue };
            let key = key_of_examination(key.hash);
            let entry = self.memo.get(key).or_else(|| self.measure(*id, &outcome.name, kind, values, key));
            match entry.as_deref() {
                None => evaluation.cancelled = true,
                Some(Entry { result: Ok(_), report: found, .. }) => *report = Arc::new(report.followed_by(found)),
                Some(Entry { result: Err(failure), .. }) => outcome.state = OutcomeState::Failed(failure.clone()),
            }
        }
    }

    /// None where it was cancelled.
    fn measure(
        &self,
        node: NodeId,
        name: &str,
        kind: &NodeKind,
        values: &[Value],
        key: ContentHash,
    ) -> Option<Arc<Entry>> {
        if self.cancel.is_cancelled() {
            return None;
        }
        let begun = Instant::now();
        let told_to_stop = AtomicBool::new(false);
        let progress = |_| {
            let stop = self.cancel.is_cancelled();
            told_to_stop.fetch_or(stop, Ordering::Relaxed);
            !stop
        };
        let found = call::examine(kind, values, &progress);
        let duration = begun.elapsed();
        if told_to_stop.into_inner() {
            return None;
        }
        let (result, report) = match found {
            Ok(report) => (Ok(Vec::new().into()), report),
            Err(NodeError::Cancelled) => return None,
            Err(NodeError::Failed { message, .. }) => (Err(failure(kind, None, message)), Report::default()),
        };
        self.events.event(&Event { node, name, kind: EventKind::Examined(duration) });
        let entry = Arc::new(Entry { result, report: Arc::new(report), duration, files: None });
        self.memo.insert(key, entry.clone());
        Some(entry)
    }
}
