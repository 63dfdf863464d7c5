//! The evaluator: remembers results from one evaluation to the next.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::catalogue::Catalogue;
use crate::evaluate::evaluation::{Evaluation, Outcome, OutcomeState};
use crate::evaluate::memo::{Entry, Memo};
use crate::evaluate::plan::{Found, Plan, Planner, gather, key};
use crate::evaluate::run::{Ended, Runner};
use crate::evaluate::{CancelToken, Event, EventKind, Events};
use crate::graph::{Graph, Node, NodeId, Source};
use crate::value::{ContentHash, KeyHasherBuilder};

/// How to evaluate.
#[derive(Clone, Debug)]
pub struct EvaluatorOptions {
    /// Threads, at most 256; 0 takes one per core. The number changes no result.
    pub threads: usize,
    /// Bytes of results to remember between evaluations; the least recently used go first.
    pub byte_budget: usize,
}

/// A mistyped number of threads must not bring the machine down.
const MOST_THREADS: usize = 256;

impl Default for EvaluatorOptions {
    fn default() -> Self {
        Self { threads: 0, byte_budget: 1 << 30 }
    }
}

/// What to evaluate, who listens, and how to stop it.
#[derive(Clone)]
pub struct Request<'a> {
    targets: Vec<NodeId>,
    events: &'a dyn Events,
    cancel: CancelToken,
    base: PathBuf,
}

impl<'a> Request<'a> {
    /// Asks for the results of these nodes and, through them, of what they depend on.
    pub fn nodes(targets: &[NodeId]) -> Self {
        Self { targets: targets.to_vec(), events: &(), cancel: CancelToken::new(), base: PathBuf::new() }
    }

    /// Listens to what happens.
    #[must_use]
    pub fn events(self, events: &'a dyn Events) -> Self {
        Self { events, ..self }
    }

    /// Can be stopped by this token.
    #[must_use]
    pub fn cancel(self, cancel: &CancelToken) -> Self {
        Self { cancel: cancel.clone(), ..self }
    }

    /// Relative paths in the graph start at this folder.
    #[must_use]
    pub fn base(self, base: impl AsRef<Path>) -> Self {
        Self { base: base.as_ref().to_owned(), ..self }
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Slot {
    /// Key of the node's last result, while nothing before it has changed since.
    key: Option<ContentHash>,
}

/// Evaluates graphs and remembers results by content: what was computed once for equal inputs is not computed again,
/// whether in this graph, after an undo, or in another graph.
pub struct Evaluator {
    memo: Memo,
    threads: usize,
    pool: Option<rayon::ThreadPool>,
    slots: Vec<Slot>,
    identity: Option<u64>,
    revision: u64,
    base: PathBuf,
}

impl Default for Evaluator {
    fn default() -> Self {
        Self::new(&EvaluatorOptions::default())
    }
}

impl Evaluator {
    /// An evaluator that remembers nothing yet.
    pub fn new(options: &EvaluatorOptions) -> Self {
        Self {
            memo: Memo::new(options.byte_budget),
            threads: options.threads,
            pool: None,
            slots: Vec::new(),
            identity: None,
            revision: 0,
            base: PathBuf::new(),
        }
    }

    /// Bytes of results remembered.
    pub fn remembered_bytes(&self) -> usize {
        self.memo.byte_size()
    }

    /// Forgets all results.
    pub fn forget(&mut self) {
        self.memo.clear();
        self.slots.clear();
    }

    /// Evaluates what is asked for. Never fails as a whole: each node has its own outcome.
    pub fn evaluate(&mut self, catalogue: &Catalogue, graph: &Graph, request: &Request<'_>) -> Evaluation {
        let begun = Instant::now();
        self.sync(graph, request);
        let planner = Planner { catalogue, graph, memo: &self.memo, base: &request.base, cancel: &request.cancel };
        let plan = planner.plan(&request.targets, |id| self.slots.get(id.index()).and_then(|slot| slot.key));
        self.announce(graph, request, &plan);
        self.start_pool(&plan);
        let runner = Runner {
            graph,
            plan: &plan,
            memo: &self.memo,
            base: &request.base,
            cancel: &request.cancel,
            events: request.events,
            silence: Default::default(),
        };
        let ended = runner.run(self.pool.as_ref());
        self.conclude(graph, request, plan, ended, begun)
    }

    /// Marks what changed since the last evaluation, and everything behind it, as stale.
    fn sync(&mut self, graph: &Graph, request: &Request<'_>) {
        if self.identity != Some(graph.identity()) || self.base != request.base {
            self.slots.clear();
            self.identity = Some(graph.identity());
            self.base.clone_from(&request.base);
            self.revision = 0;
        }
        self.slots.resize(graph.id_bound(), Slot::default());
        let mut stale: Vec<NodeId> = Vec::new();
        let mut fingerprinted = false;
        for (id, node) in graph.nodes() {
            if self.slots[id.index()].key.is_some() {
                if node.changed_at > self.revision {
                    stale.push(id);
                } else {
                    fingerprinted |= node.kind.as_ref().is_some_and(|kind| kind.has_fingerprint());
                }
            }
        }
        if fingerprinted {
            // Fingerprints read files, so only those of nodes that are needed are taken.
            let needed = graph.upstream(&request.targets).into_iter();
            let needed = needed.filter(|id| self.slots[id.index()].key.is_some());
            stale.extend(
                needed.filter(|id| graph.node(*id).is_some_and(|node| self.fingerprint_changed(*id, node, request))),
            );
        }
        while let Some(id) = stale.pop() {
            // A stale node's dependents are stale already: keys are given and taken from the sources downwards.
            if self.slots[id.index()].key.take().is_some() {
                stale.extend(graph.dependents(id));
            }
        }
        self.revision = graph.revision();
    }

    /// Whether what the node depends on beside its inputs (a file) is no longer what it was.
    fn fingerprint_changed(&self, id: NodeId, node: &Node, request: &Request<'_>) -> bool {
        let Some(kind) = node.kind.as_ref().filter(|k| k.has_fingerprint()) else { return false };
        if node.inputs.values().any(|source| !matches!(source, Source::Literal { .. })) {
            // Its inputs are not known yet; the plan will compute the key anew.
            return true;
        }
        let supplies: Vec<_> = kind
            .inputs()
            .iter()
            .map(|spec| {
                let literal = node.inputs.get(&spec.name).and_then(|source| match source {
                    Source::Literal { value, .. } => Some(value.clone()),
                    _ => None,
                });
                literal
                    .or_else(|| spec.default_value.clone())
                    .map_or(crate::evaluate::plan::Supply::Nothing, crate::evaluate::plan::Supply::Value)
            })
            .collect();
        let now =
            gather(kind, &supplies, |_, _| None).and_then(|inputs| key(kind, &inputs, &request.base, &request.cancel));
        now.ok().flatten() != self.slots[id.index()].key
    }

    fn announce(&self, graph: &Graph, request: &Request<'_>, plan: &Plan) {
        let name = |id: NodeId| graph.node(id).map_or("", Node::name);
        if let Some(first) = request.targets.first() {
            let kind = EventKind::Planned(plan.steps.len());
            request.events.event(&Event { node: *first, name: name(*first), kind });
        }
        for id in &plan.order {
            let kind = match plan.found.get(id) {
                Some(Found::Known(_, entry)) => match &entry.result {
                    Ok(_) => EventKind::Hit,
                    Err(failure) => EventKind::Failed(failure),
                },
                Some(Found::Failed(failure)) => EventKind::Failed(failure),
                Some(Found::Waiting(on)) => EventKind::Waiting(on),
                Some(Found::Scheduled(_)) | None => continue,
            };
            request.events.event(&Event { node: *id, name: name(*id), kind });
        }
    }

    fn start_pool(&mut self, plan: &Plan) {
        if self.threads != 1 && self.pool.is_none() && plan.steps.len() > 1 {
            // Without threads to be had, the calling thread does the work alone; results are the same.
            self.pool = rayon::ThreadPoolBuilder::new().num_threads(self.threads.min(MOST_THREADS)).build().ok();
        }
    }

    fn conclude(
        &mut self,
        graph: &Graph,
        request: &Request<'_>,
        mut plan: Plan,
        mut ended: Vec<Ended>,
        begun: Instant,
    ) -> Evaluation {
        let mut evaluation = Evaluation::default();
        let targets: HashSet<NodeId, KeyHasherBuilder> = request.targets.iter().copied().collect();
        let mut outcomes = Vec::with_capacity(plan.order.len());
        let mut kinds = Vec::new();
        for id in plan.order {
            let (Some(node), Some(found)) = (graph.node(id), plan.found.remove(&id)) else { continue };
            let wanted = targets.contains(&id);
            let (state, ran, duration) = match found {
                Found::Known(key, entry) => {
                    self.slots[id.index()].key = Some(key);
                    (state_of(&entry, wanted), false, entry.duration)
                }
                Found::Failed(failure) => (OutcomeState::Failed(failure), false, Duration::ZERO),
                Found::Waiting(on) => (OutcomeState::Waiting(on), false, Duration::ZERO),
                Found::Scheduled(step) => match std::mem::replace(&mut ended[step], Ended::Cancelled) {
                    Ended::Done { key, values, report, duration, ran } => {
                        self.slots[id.index()].key = Some(key);
                        (OutcomeState::Done { values, report }, ran, duration)
                    }
                    Ended::Failed { key, failure, duration, ran } => {
                        self.slots[id.index()].key = key;
                        (OutcomeState::Failed(failure), ran, duration)
                    }
                    Ended::Waiting(on) => (OutcomeState::Waiting(on), false, Duration::ZERO),
                    Ended::Cancelled => {
                        evaluation.cancelled = true;
                        (OutcomeState::Cancelled, false, Duration::ZERO)
                    }
                },
            };
            if wanted && let Some(kind) = &node.kind {
                kinds.push((id, kind.clone()));
            }
            outcomes
                .push((id, Outcome { name: node.name.clone(), kind: node.kind_name.clone(), state, ran, duration }));
        }
        evaluation.outcomes = outcomes.into_iter().collect();
        evaluation.kinds = kinds.into_iter().collect();
        evaluation.duration = begun.elapsed();
        evaluation
    }
}

fn state_of(entry: &Entry, wanted: bool) -> OutcomeState {
    match &entry.result {
        Ok(values) => OutcomeState::Done { values: wanted.then(|| values.clone()), report: entry.report.clone() },
        Err(failure) => OutcomeState::Failed(failure.clone()),
    }
}
