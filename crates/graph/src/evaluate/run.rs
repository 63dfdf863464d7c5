//! Runs the steps of a plan, on one thread or many.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use crate::evaluate::memo::{Entry, Memo};
use crate::evaluate::plan::{Plan, Step, Supply, blame_name, failure, gather, key, panic_message};
use crate::evaluate::{CancelToken, Event, EventKind, Events, Failure};
use crate::graph::Graph;
use crate::ports::{NodeError, Ports};
use crate::report::Report;
use crate::value::{ContentHash, Value};

/// What became of a step.
pub(crate) enum Ended {
    /// It has a result. Its values are there only if it is a target: of the others the memo decides what stays.
    Done { key: ContentHash, values: Option<Arc<[Value]>>, report: Arc<Report>, duration: Duration, ran: bool },
    /// It failed; with a key where the failure is remembered.
    Failed { key: Option<ContentHash>, failure: Failure, duration: Duration, ran: bool },
    /// These nodes failed before it.
    Waiting(Vec<String>),
    /// It was stopped, or never began.
    Cancelled,
}

impl Ended {
    fn of(key: ContentHash, entry: &Entry, ran: bool) -> Self {
        let duration = entry.duration;
        match &entry.result {
            Ok(values) => Self::Done { key, values: Some(values.clone()), report: entry.report.clone(), duration, ran },
            Err(failure) => Self::Failed { key: Some(key), failure: failure.clone(), duration, ran },
        }
    }
}

pub(crate) struct Runner<'a> {
    pub(crate) graph: &'a Graph,
    pub(crate) plan: &'a Plan,
    pub(crate) memo: &'a Memo,
    pub(crate) base: &'a Path,
    pub(crate) cancel: &'a CancelToken,
    pub(crate) events: &'a dyn Events,
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
            None => (0..states.len()).for_each(|step| self.run_step(&states, step)),
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
            self.run_step(states, step);
            // The first dependent that becomes ready runs here: a chain never changes threads.
            let mut next = None;
            for &dependent in &self.plan.steps[step].dependents {
                if states[dependent].pending.fetch_sub(1, Ordering::AcqRel) == 1 {
                    if next.is_none() {
                        next = Some(dependent);
                    } else {
                        scope.spawn(move |scope| self.run_from(states, dependent, scope));
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

    fn run_step(&self, states: &[State], index: usize) {
        let step = &self.plan.steps[index];
        let mut ended = self.result(states, step);
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
            Ended::Waiting(on) => self.emit(step, EventKind::Waiting(on)),
            Ended::Cancelled => self.emit(step, EventKind::Cancelled),
        }
        *locked(&states[index].ended) = Some(ended);
        for &source in &step.sources {
            if states[source].takers.fetch_sub(1, Ordering::AcqRel) == 1 {
                *locked(&states[source].values) = None;
            }
        }
    }

    fn result(&self, states: &[State], step: &Step) -> Ended {
        if let Some(stopped) = self.stopped_by_sources(states, step) {
            return stopped;
        }
        if self.cancel.is_cancelled() {
            return Ended::Cancelled;
        }
        let values = |source: usize, output: usize| {
            locked(&states[source].values).as_ref().and_then(|values| values.get(output).cloned())
        };
        let failed = |failure| Ended::Failed { key: None, failure, duration: Duration::ZERO, ran: false };
        let inputs = match gather(&step.kind, &step.supplies, values) {
            Ok(inputs) => inputs,
            Err(failure) => return failed(failure),
        };
        let key = match key(&step.kind, &inputs, self.base, self.cancel) {
            Ok(Some(key)) => key,
            Ok(None) => return Ended::Cancelled,
            Err(failure) => return failed(failure),
        };
        if let Some(entry) = self.memo.get(key) {
            return Ended::of(key, &entry, false);
        }
        self.emit(step, EventKind::Started);
        let begun = Instant::now();
        let told_to_stop = AtomicBool::new(false);
        let result = self.call(step, &inputs, &told_to_stop);
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
        self.memo.insert(key, entry.clone());
        Ended::of(key, &entry, true)
    }

    fn stopped_by_sources(&self, states: &[State], step: &Step) -> Option<Ended> {
        let mut waiting = Vec::new();
        let mut cancelled = false;
        for source in step.supplies.iter().filter_map(scheduled_source) {
            match &*locked(&states[source].ended) {
                Some(Ended::Failed { .. }) => {
                    let name = self.graph.node(self.plan.steps[source].node).map_or("", |node| node.name());
                    blame_name(&mut waiting, name);
                }
                Some(Ended::Waiting(on)) => on.iter().for_each(|name| blame_name(&mut waiting, name)),
                Some(Ended::Cancelled) => cancelled = true,
                Some(Ended::Done { .. }) | None => {}
            }
        }
        if !waiting.is_empty() {
            Some(Ended::Waiting(waiting))
        } else if cancelled {
            Some(Ended::Cancelled)
        } else {
            None
        }
    }

    fn call(
        &self,
        step: &Step,
        inputs: &[Option<Value>],
        told_to_stop: &AtomicBool,
    ) -> Result<(Vec<Value>, Report), NodeError> {
        let kind = &*step.kind;
        let Some(run) = kind.evaluate_fn() else {
            return Err(NodeError::new(format!("the node kind \"{}\" does not say what it does", kind.name())));
        };
        let progress = |fraction: f64| {
            let done = if fraction.is_nan() { 0.0 } else { fraction.clamp(0.0, 1.0) };
            self.emit(step, EventKind::Progress(done));
            let stop = self.cancel.is_cancelled();
            if stop {
                told_to_stop.store(true, Ordering::Relaxed);
            }
            !stop
        };
        let mut ports = Ports::new(kind, inputs, self.base, &progress);
        match catch_unwind(AssertUnwindSafe(|| run(&mut ports))) {
            Ok(Ok(())) => ports.finish(),
            Ok(Err(error)) => Err(error),
            Err(panic) => Err(NodeError::new(panic_message(kind, panic.as_ref()))),
        }
    }
}

fn scheduled_source(supply: &Supply) -> Option<usize> {
    if let Supply::Scheduled { step, .. } = supply { Some(*step) } else { None }
}
