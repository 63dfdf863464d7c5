//! Runs the steps of a plan, on one thread or many.

use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use crate::evaluate::blame::{Blame, names};
use crate::evaluate::call::call;
use crate::evaluate::file_cache::FileCache;
use crate::evaluate::flight::{Boarding, Flights};
use crate::evaluate::inputs::{FileBytes, Key, Supply, failure, files, gather, key};
use crate::evaluate::memo::{Entry, Memo};
use crate::evaluate::plan::{Plan, Step};
use crate::evaluate::{CancelToken, Event, EventKind, Events, Failure};
use crate::graph::{Graph, NodeId};
use crate::ports::NodeError;
use crate::report::Report;
use crate::value::{ContentHash, Value};

/// What became of a step.
#[derive(Clone)]
pub(crate) enum Ended {
    /// It has a result. Its values are there only if it is a target: of the others the memo decides what stays.
    Done { key: Key, values: Option<Arc<[Value]>>, report: Arc<Report>, duration: Duration, ran: bool },
    /// It failed; with a key where the failure is remembered.
    Failed { key: Option<Key>, failure: Failure, duration: Duration, ran: bool },
    /// These nodes failed before it.
    Waiting(Vec<NodeId>),
    /// It was stopped, or never began.
    Cancelled,
}

impl Ended {
    fn of(key: Key, entry: &Entry, ran: bool) -> Self {
        let duration = entry.duration;
        match &entry.result {
            Ok(values) => Self::Done { key, values: Some(values.clone()), report: entry.report.clone(), duration, ran },
            Err(failure) => Self::Failed { key: Some(key), failure: failure.clone(), duration, ran },
        }
    }

    /// The same for a step that took this one's result instead of running.
    fn taken(mut self) -> Self {
        if let Self::Done { ran, .. } | Self::Failed { ran, .. } = &mut self {
            *ran = false;
        }
        self
    }
}

/// How a step's turn went.
enum Turn {
    /// It ended; with the key that others may have been parked for.
    Ended(Ended, Option<ContentHash>),
    /// Another step computes the same; that one ends both.
    Parked,
}

pub(crate) struct Runner<'a> {
    pub(crate) graph: &'a Graph,
    pub(crate) plan: &'a Plan,
    pub(crate) memo: &'a Memo,
    pub(crate) base: &'a Path,
    pub(crate) cancel: &'a CancelToken,
    pub(crate) events: &'a dyn Events,
    pub(crate) files: &'a FileCache,
    pub(crate) flights: Flights,
    /// The report of nodes that have nothing to say.
    pub(crate) silence: Arc<Report>,
}

/// Working state of one step. Values are dropped as soon as the last step that takes them has run.
struct State {
    pending: AtomicUsize,
    takers: AtomicUsize,
    values: Mutex<Option<Arc<[Value]>>>,
    ended: Mutex<Option<Ended>>,
}

fn locked<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    // Each holds one value that is replaced whole, so a poisoned lock still guards a whole value.
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Runner<'_> {
    /// Runs all steps; one entry per step.
    pub(crate) fn run(&self, pool: Option<&rayon::ThreadPool>) -> Vec<Ended> {
        let states: Vec<State> = self
            .plan
            .steps
            .iter()
            .map(|step| State {
                pending: AtomicUsize::new(step.sources.len()),
                takers: AtomicUsize::new(step.dependents.len()),
                values: Mutex::new(None),
                ended: Mutex::new(None),
            })
            .collect();
        match pool.filter(|_| !self.is_chain()) {
            None => (0..states.len()).for_each(|step| drop(self.run_step(&states, step))),
            Some(pool) => pool.scope(|scope| {
                for (step, _) in self.plan.steps.iter().enumerate().filter(|(_, s)| s.sources.is_empty()) {
                    let states = &states;
                    scope.spawn(move |scope| self.run_from(states, step, scope));
                }
            }),
        }
        states.into_iter().map(|s| locked(&s.ended).take().unwrap_or(Ended::Cancelled)).collect()
    }

    /// Whether no two steps could ever run at the same time, so that a thread pool has nothing to offer.
    fn is_chain(&self) -> bool {
        let steps = &self.plan.steps;
        steps.iter().filter(|s| s.sources.is_empty()).count() <= 1 && steps.iter().all(|s| s.dependents.len() <= 1)
    }

    fn run_from<'s>(&'s self, states: &'s [State], mut step: usize, scope: &rayon::Scope<'s>) {
        loop {
            // The first dependent that becomes ready runs here: a chain never changes threads.
            let mut next = None;
            for ended in self.run_step(states, step) {
                for &dependent in &self.plan.steps[ended].dependents {
                    if states[dependent].pending.fetch_sub(1, Ordering::AcqRel) == 1 {
                        if next.is_none() {
                            next = Some(dependent);
                        } else {
                            scope.spawn(move |scope| self.run_from(states, dependent, scope));
                        }
                    }
                }
            }
            match next {
                Some(ready) => step = ready,
                None => return,
            }
        }
    }

    fn emit(&self, step: &Step, kind: EventKind<'_>) {
        let name = self.graph.node(step.node).map_or("", |node| node.name());
        self.events.event(&Event { node: step.node, name, kind });
    }

    /// Runs a step, where nothing keeps it from running. Returns the steps that ended: none where it was parked, and
    /// those that were parked for its result too.
    fn run_step(&self, states: &[State], index: usize) -> impl Iterator<Item = usize> + use<> {
        let (this, parked) = match self.result(states, index) {
            Turn::Parked => (None, Vec::new()),
            Turn::Ended(ended, flight) => {
                let parked = flight.map(|key| self.flights.land(key)).unwrap_or_default();
                if parked.is_empty() {
                    self.end(states, index, ended);
                } else {
                    self.end(states, index, ended.clone());
                    parked.iter().for_each(|waiting| self.end(states, *waiting, ended.clone().taken()));
                }
                (Some(index), parked)
            }
        };
        this.into_iter().chain(parked)
    }

    fn end(&self, states: &[State], index: usize, mut ended: Ended) {
        let step = &self.plan.steps[index];
        match &mut ended {
            Ended::Done { values, duration, ran, .. } => {
                self.emit(step, if *ran { EventKind::Finished(*duration) } else { EventKind::Hit });
                if !step.dependents.is_empty() {
                    locked(&states[index].values).clone_from(values);
                }
                if !step.is_target {
                    *values = None;
                }
            }
            Ended::Failed { failure, .. } => self.emit(step, EventKind::Failed(failure)),
            Ended::Waiting(on) => self.emit(step, EventKind::Waiting(&names(self.graph, on))),
            Ended::Cancelled => self.emit(step, EventKind::Cancelled),
        }
        *locked(&states[index].ended) = Some(ended);
        for &source in &step.sources {
            if states[source].takers.fetch_sub(1, Ordering::AcqRel) == 1 {
                *locked(&states[source].values) = None;
            }
        }
    }

    fn result(&self, states: &[State], index: usize) -> Turn {
        let step = &self.plan.steps[index];
        if let Some(stopped) = self.stopped_by_sources(states, step) {
            return Turn::Ended(stopped, None);
        }
        if self.cancel.is_cancelled() {
            return Turn::Ended(Ended::Cancelled, None);
        }
        if let Some(first) = step.twin_of {
            return Turn::Ended(taken_from(&states[first]), None);
        }
        let failed =
            |failure| Turn::Ended(Ended::Failed { key: None, failure, duration: Duration::ZERO, ran: false }, None);
        let values = |source: usize, output: usize| {
            locked(&states[source].values).as_ref().and_then(|values| values.get(output).cloned())
        };
        let inputs = match gather(&step.kind, &step.supplies, values) {
            Ok(inputs) => inputs,
            Err(failure) => return failed(failure),
        };
        let mut key = match key(&step.kind, &inputs, self.base, self.files) {
            Ok(key) => key,
            Err(failure) => return failed(failure),
        };
        let mut contents = Vec::new();
        if key.files.is_some() {
            if let Some(entry) = self.memo.get(key.hash) {
                return Turn::Ended(Ended::of(key, &entry, false), None);
            }
            // The key again, because it must be that of the very bytes that the node gets.
            let read = files(&step.kind, &inputs, self.base, self.files);
            match read.and_then(|read| Ok((read, self::key(&step.kind, &inputs, self.base, self.files)?))) {
                Ok(read) => (contents, key) = read,
                Err(failure) => return failed(failure),
            }
        }
        let flight = key.hash;
        match self.flights.board(flight, index, self.memo) {
            Boarding::Remembered(entry) => Turn::Ended(Ended::of(key, &entry, false), None),
            Boarding::Parked => Turn::Parked,
            Boarding::Computes => Turn::Ended(self.compute(step, key, &inputs, &contents), Some(flight)),
        }
    }

    fn compute(&self, step: &Step, key: Key, inputs: &[Option<Value>], files: &[FileBytes]) -> Ended {
        self.emit(step, EventKind::Started);
        let begun = Instant::now();
        let told_to_stop = AtomicBool::new(false);
        let result = self.call(step, inputs, files, &told_to_stop);
        let duration = begun.elapsed();
        if told_to_stop.into_inner() {
            // Even a good result may be one that stopped halfway, and an error may say no more than that.
            return Ended::Cancelled;
        }
        let (result, report) = match result {
            Err(NodeError::Cancelled) => return Ended::Cancelled,
            Err(NodeError::Failed { input, message }) => {
                (Err(failure(&step.kind, input, message)), self.silence.clone())
            }
            // Most nodes say nothing; they share one empty report.
            Ok((values, report)) if report.is_empty() => (Ok(values.into()), self.silence.clone()),
            Ok((values, report)) => (Ok(values.into()), Arc::new(report)),
        };
        let entry = Arc::new(Entry { result, report, duration });
        self.memo.insert(key.hash, entry.clone());
        Ended::of(key, &entry, true)
    }

    fn stopped_by_sources(&self, states: &[State], step: &Step) -> Option<Ended> {
        let mut blame = Blame::default();
        let mut cancelled = false;
        for supply in &step.supplies {
            match supply {
                Supply::Missing(nodes) => blame.add(nodes),
                Supply::Scheduled { step: source, .. } => match &*locked(&states[*source].ended) {
                    Some(Ended::Failed { .. }) => blame.add(&[self.plan.steps[*source].node]),
                    Some(Ended::Waiting(on)) => blame.add(on),
                    Some(Ended::Cancelled) => cancelled = true,
                    Some(Ended::Done { .. }) | None => {}
                },
                Supply::Nothing | Supply::Value(_) | Supply::Known { .. } => {}
            }
        }
        let waiting = blame.into_nodes().map(Ended::Waiting);
        waiting.or_else(|| cancelled.then_some(Ended::Cancelled))
    }

    fn call(
        &self,
        step: &Step,
        inputs: &[Option<Value>],
        files: &[FileBytes],
        told_to_stop: &AtomicBool,
    ) -> Result<(Vec<Value>, Report), NodeError> {
        let kind = &*step.kind;
        let progress = |fraction: f64| {
            let done = if fraction.is_nan() { 0.0 } else { fraction.clamp(0.0, 1.0) };
            self.emit(step, EventKind::Progress(done));
            let stop = self.cancel.is_cancelled();
            if stop {
                told_to_stop.store(true, Ordering::Relaxed);
            }
            !stop
        };
        call(kind, inputs, files, self.base, &progress)
    }
}

/// What a step gave, for its twin.
fn taken_from(first: &State) -> Ended {
    match locked(&first.ended).clone() {
        Some(Ended::Done { key, report, duration, .. }) => {
            Ended::Done { key, values: locked(&first.values).clone(), report, duration, ran: false }
        }
        Some(other) => other.taken(),
        None => Ended::Cancelled,
    }
}
