//! The evaluator: remembers results from one evaluation to the next.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::{Duration, Instant};

use crate::catalogue::Catalogue;
use crate::evaluate::evaluation::{Evaluation, Outcome, OutcomeState};
use crate::evaluate::examine::Examiner;
use crate::evaluate::file_cache::FileCache;
use crate::evaluate::flight::Flights;
use crate::evaluate::inputs::{Disk, Key};
use crate::evaluate::memo::{Entry, Memo};
use crate::evaluate::place::Place;
use crate::evaluate::plan::{Found, Plan, Planner};
use crate::evaluate::run::{Ended, Run, Runner};
use crate::evaluate::{CancelToken, EventKind, Events};
use crate::file::Project;
use crate::graph::{Graph, NodeId};
use crate::value::KeyHasherBuilder;

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
    project: Option<Project>,
    examined: Examined,
}

/// Of which nodes is measured what their kinds measure on request only.
#[derive(Clone, Debug)]
enum Examined {
    Nothing,
    Everything,
    Only(Vec<NodeId>),
}

impl<'a> Request<'a> {
    /// Asks for the results of these nodes and, through them, of what they depend on.
    pub fn nodes(targets: &[NodeId]) -> Self {
        Self {
            targets: targets.to_vec(),
            events: &(),
            cancel: CancelToken::new(),
            base: PathBuf::new(),
            project: None,
            examined: Examined::Nothing,
        }
    }

    /// The same for other nodes, of which nothing is examined.
    pub(super) fn of_others(&self, targets: &[NodeId]) -> Self {
        Self { targets: targets.to_vec(), examined: Examined::Nothing, ..self.clone() }
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

    /// Asks as well for what the kinds of these nodes, and of those they depend on, measure on request only
    /// ([`crate::NodeKind::examine`]). Nodes within bodies are not examined.
    #[must_use]
    pub fn examine(self) -> Self {
        Self { examined: Examined::Everything, ..self }
    }

    /// As [`Request::examine`], of these nodes alone. Those on which nothing asked for depends are left out.
    #[must_use]
    pub fn examine_only(self, nodes: &[NodeId]) -> Self {
        Self { examined: Examined::Only(nodes.to_vec()), ..self }
    }

    /// The nodes that are to be examined and can be, in the order of the graph.
    fn to_examine(&self, graph: &Graph) -> Vec<NodeId> {
        let wanted = |id: &NodeId| match &self.examined {
            Examined::Nothing => false,
            Examined::Everything => true,
            Examined::Only(nodes) => nodes.contains(id),
        };
        if matches!(self.examined, Examined::Nothing) {
            return Vec::new();
        }
        let can_be = |id: &NodeId| {
            graph.node(*id).and_then(|node| node.acting_kind()).is_some_and(|kind| kind.has_examination())
        };
        graph.upstream(&self.targets).into_iter().filter(|id| wanted(id) && can_be(id)).collect()
    }

    /// Relative paths in the graph start at this folder.
    #[must_use]
    pub fn base(self, base: impl AsRef<Path>) -> Self {
        Self { base: base.as_ref().to_owned(), ..self }
    }

    /// The nodes may read the files of this project. Without one they may read what lies below [`Request::base`], which
    /// is the current folder where none is given.
    #[must_use]
    pub fn project(self, project: &Project) -> Self {
        Self { project: Some(project.clone()), ..self }
    }
}

#[derive(Clone, Debug, Default)]
struct Slot {
    /// Key of the node's last result, while nothing before it has changed since. All nodes before it have theirs too.
    key: Option<Key>,
    /// The evaluation that computed the key from the node's inputs.
    computed_in: u64,
}

/// Evaluates graphs and remembers results by content: what was computed once for equal inputs is not computed again,
/// whether in this graph, after an undo, or in another graph.
pub struct Evaluator {
    memo: Memo,
    files: FileCache,
    evaluations: u64,
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
            files: FileCache::default(),
            evaluations: 0,
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

    /// How often a file was read for the nodes. Within an evaluation each file is read once at most; from one to the
    /// next only what changed, and what has to be computed again because the memo let it go.
    pub fn file_reads(&self) -> usize {
        self.files.reads()
    }

    /// Forgets all results and what is known of files.
    pub fn forget(&mut self) {
        self.files.clear();
        self.memo.clear();
        self.slots.clear();
    }

    /// Evaluates what is asked for. Never fails as a whole: each node has its own outcome.
    pub fn evaluate(&mut self, catalogue: &Catalogue, graph: &Graph, request: &Request<'_>) -> Evaluation {
        let begun = Instant::now();
        self.evaluations += 1;
        self.files.begin(request.project.clone().unwrap_or_else(|| Project::within(&request.base)));
        let examined = request.to_examine(graph);
        // Their values are needed to the end.
        let more: Vec<NodeId> = examined.iter().copied().filter(|id| !request.targets.contains(id)).collect();
        let widened;
        let request = if more.is_empty() {
            request
        } else {
            widened = Request { targets: [&*request.targets, &more].concat(), ..request.clone() };
            &widened
        };
        self.sync(graph, request);
        let mut evaluation = self.evaluate_at(catalogue, Place::of_root(graph), request);
        if !examined.is_empty() {
            let key_of = |id: NodeId| self.slots.get(id.index()).and_then(|slot| slot.key.clone());
            let examiner = Examiner { memo: &self.memo, cancel: &request.cancel, events: request.events };
            examiner.examine(&mut evaluation, &examined, key_of);
        }
        evaluation.duration = begun.elapsed();
        evaluation
    }

    /// As [`Evaluator::evaluate_at`], with nothing known of the place's nodes but what the memo holds, and nothing noted of
    /// them: what is known of the graph that was evaluated last stays.
    pub(super) fn evaluate_apart(
        &mut self,
        catalogue: &Catalogue,
        place: Place<'_>,
        request: &Request<'_>,
    ) -> Evaluation {
        let begun = Instant::now();
        let fresh = vec![Slot::default(); place.graph().id_bound()];
        let kept = std::mem::replace(&mut self.slots, fresh);
        let mut evaluation = self.evaluate_at(catalogue, place, request);
        self.slots = kept;
        evaluation.duration = begun.elapsed();
        evaluation
    }

    /// What plans are made with at a place.
    pub(super) fn planner<'p>(
        &'p self,
        catalogue: &'p Catalogue,
        place: &'p Place<'_>,
        request: &'p Request<'_>,
    ) -> Planner<'p> {
        let disk = Disk { base: &request.base, folder: &place.folder, cache: &self.files };
        Planner { catalogue, place, memo: &self.memo, disk }
    }

    fn evaluate_at(&mut self, catalogue: &Catalogue, place: Place<'_>, request: &Request<'_>) -> Evaluation {
        let planner = self.planner(catalogue, &place, request);
        let plan = planner.plan(&request.targets, |id| self.slots.get(id.index()).and_then(|slot| slot.key.clone()));
        announce(request.events, &place, &plan);
        if let Some(first) = request.targets.first() {
            place.emit(request.events, *first, EventKind::Planned(plan.steps.len()));
        }
        self.start_pool(&plan);
        let runner = Runner {
            catalogue,
            memo: &self.memo,
            base: &request.base,
            cancel: &request.cancel,
            events: request.events,
            files: &self.files,
            flights: Flights::default(),
            silence: Default::default(),
            planned: Mutex::new(plan.steps.len()),
            width: self.pool.as_ref().map_or(1, rayon::ThreadPool::current_num_threads),
        };
        let run = Run::new(place, plan, None);
        runner.run(&run, self.pool.as_ref());
        drop(runner);
        self.files.drop_bytes();
        self.conclude(request, &run)
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
        let mut read_files = false;
        for (id, node) in graph.nodes() {
            if let Some(key) = &self.slots[id.index()].key {
                if node.changed_at > self.revision {
                    stale.push(id);
                } else {
                    read_files |= key.files.is_some();
                }
            }
        }
        if read_files {
            // Only the files of nodes that are needed are looked at.
            let needed = graph.upstream(&request.targets).into_iter();
            stale.extend(needed.filter(|id| self.files_changed(*id)));
        }
        self.forget_keys(graph, stale, |_| true);
        self.revision = graph.revision();
    }

    /// Takes the keys of these nodes and of all behind them, as far as they may be taken.
    fn forget_keys(&mut self, graph: &Graph, mut stale: Vec<NodeId>, may: impl Fn(&Slot) -> bool) {
        while let Some(id) = stale.pop() {
            let slot = &mut self.slots[id.index()];
            // Behind a node without a key there is none: keys are given and taken from the sources downwards.
            if may(slot) && slot.key.take().is_some() {
                stale.extend(graph.dependents(id));
            }
        }
    }

    /// Whether the node read files that are no longer what they were.
    fn files_changed(&self, id: NodeId) -> bool {
        let files = self.slots[id.index()].key.as_ref().and_then(|key| key.files.as_deref()).unwrap_or_default();
        files.iter().any(|file| self.files.hash(&file.path) != Ok(file.hash))
    }

    fn start_pool(&mut self, plan: &Plan) {
        let has_work = plan.steps.len() > 1 || plan.steps.iter().any(|step| step.body.is_some());
        if self.threads != 1 && self.pool.is_none() && has_work {
            // Without threads to be had, the calling thread does the work alone; results are the same.
            self.pool = rayon::ThreadPoolBuilder::new().num_threads(self.threads.min(MOST_THREADS)).build().ok();
        }
    }

    fn conclude(&mut self, request: &Request<'_>, run: &Run<'_>) -> Evaluation {
        let (graph, plan) = (run.place.graph(), &run.plan);
        let mut evaluation = Evaluation::default();
        let targets: HashSet<NodeId, KeyHasherBuilder> = request.targets.iter().copied().collect();
        let mut outcomes = Vec::with_capacity(plan.order.len());
        let mut kinds = Vec::new();
        let mut changed = Vec::new();
        for &id in &plan.order {
            let (Some(node), Some(found)) = (graph.node(id), plan.found.get(&id).cloned()) else { continue };
            let wanted = targets.contains(&id);
            let (key, state, ran, duration) = match found {
                Found::Known(key, entry) => (Some(key), state_of(&entry, wanted), false, entry.duration),
                Found::Failed(failure) => (None, OutcomeState::Failed(failure), false, Duration::ZERO),
                Found::Waiting(on) => (None, OutcomeState::Waiting(run.place.names(&on)), false, Duration::ZERO),
                Found::Scheduled(step) => {
                    self.slots[id.index()].computed_in = self.evaluations;
                    match run.ended(step) {
                        Ended::Done { key, values, report, duration, ran } => {
                            (Some(key), OutcomeState::Done { values, report }, ran, duration)
                        }
                        Ended::Failed { key, failure, duration, ran } => {
                            (key, OutcomeState::Failed(failure), ran, duration)
                        }
                        Ended::Waiting(on) => {
                            (None, OutcomeState::Waiting(run.place.names(&on)), false, Duration::ZERO)
                        }
                        Ended::Cancelled => {
                            evaluation.cancelled = true;
                            (None, OutcomeState::Cancelled, false, Duration::ZERO)
                        }
                    }
                }
            };
            let before = std::mem::replace(&mut self.slots[id.index()].key, key);
            if before.is_some_and(|old| self.slots[id.index()].key.as_ref().is_none_or(|new| new.hash != old.hash)) {
                changed.push(id);
            }
            if wanted && let Some(kind) = node.acting_kind() {
                kinds.push((id, kind.clone()));
            }
            outcomes
                .push((id, Outcome { name: node.name.clone(), kind: node.kind_name.clone(), state, ran, duration }));
        }
        // A key that changed although nothing was stale: a file vanished, say, and what read it was forgotten. What is
        // behind it and was not computed from it just now has a key that stands for the past.
        let behind: Vec<_> = changed.into_iter().flat_map(|id| graph.dependents(id)).collect();
        let evaluation_number = self.evaluations;
        self.forget_keys(graph, behind, |slot| slot.computed_in != evaluation_number);
        evaluation.outcomes = outcomes.into_iter().collect();
        evaluation.kinds = kinds.into_iter().collect();
        evaluation
    }
}

/// Says what is settled without running.
pub(crate) fn announce(events: &dyn Events, place: &Place<'_>, plan: &Plan) {
    for id in &plan.order {
        let kind = match plan.found.get(id) {
            Some(Found::Known(_, entry)) => match &entry.result {
                Ok(_) => EventKind::Hit,
                Err(failure) => EventKind::Failed(failure),
            },
            Some(Found::Failed(failure)) => EventKind::Failed(failure),
            Some(Found::Waiting(on)) => {
                place.emit(events, *id, EventKind::Waiting(&place.names(on)));
                continue;
            }
            Some(Found::Scheduled(_)) | None => continue,
        };
        place.emit(events, *id, kind);
    }
}

fn state_of(entry: &Entry, wanted: bool) -> OutcomeState {
    match &entry.result {
        Ok(values) => OutcomeState::Done { values: wanted.then(|| values.clone()), report: entry.report.clone() },
        Err(failure) => OutcomeState::Failed(failure.clone()),
    }
}
