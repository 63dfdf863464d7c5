//! Runs the steps of plans, on one thread or many.

use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use crate::catalogue::Catalogue;
use crate::evaluate::blame::Blame;
use crate::evaluate::call::call;
use crate::evaluate::composite::Composite;
use crate::evaluate::file_cache::FileCache;
use crate::evaluate::flight::{Boarding, Flights};
use crate::evaluate::inputs::{Disk, FileBytes, Key, Supply, failure, files, gather, key};
use crate::evaluate::memo::{Entry, Memo};
use crate::evaluate::place::Place;
use crate::evaluate::plan::{Plan, Step};
use crate::evaluate::{CancelToken, EventKind, Events, Failure};
use crate::graph::NodeId;
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
    pub(crate) fn of(key: Key, entry: &Entry, ran: bool) -> Self {
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
    /// Another step computes the same, and ends both; or its body is being evaluated, and ends it.
    Pending,
}

/// What the runs of an evaluation share.
pub(crate) struct Runner<'a> {
    pub(crate) catalogue: &'a Catalogue,
    pub(crate) memo: &'a Memo,
    pub(crate) base: &'a Path,
    pub(crate) cancel: &'a CancelToken,
    pub(crate) events: &'a dyn Events,
    pub(crate) files: &'a FileCache,
    pub(crate) flights: Flights<Task<'a>>,
    /// The report of nodes that have nothing to say.
    pub(crate) silence: Arc<Report>,
    /// How many nodes were planned so far, in all runs.
    pub(crate) planned: Mutex<usize>,
    /// Threads to work with.
    pub(crate) width: usize,
}

/// A plan that is carried out: that of the evaluated graph, or that of a body.
pub(crate) struct Run<'a> {
    pub(crate) place: Place<'a>,
    pub(crate) plan: Plan,
    states: Vec<State>,
    /// Steps that have not ended.
    left: AtomicUsize,
    /// The step whose body it evaluates, and for which time.
    pub(crate) within: Option<(Arc<Composite<'a>>, usize)>,
}

/// Working state of one step. Values are dropped as soon as the last step that takes them has run.
struct State {
    pending: AtomicUsize,
    takers: AtomicUsize,
    values: Mutex<Option<Arc<[Value]>>>,
    ended: Mutex<Option<Ended>>,
}

pub(crate) fn locked<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    // Each holds values that are replaced whole, so a poisoned lock still guards whole values.
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A step that is ready, or, without a step, a run of a body that is over.
pub(crate) struct Task<'a> {
    run: Arc<Run<'a>>,
    step: Option<usize>,
}

/// What came of a task.
#[derive(Default)]
pub(crate) struct Led<'a> {
    /// Steps that ended.
    ended: Vec<(Arc<Run<'a>>, usize)>,
    /// Runs that began.
    pub(crate) started: Vec<Arc<Run<'a>>>,
}

impl<'a> Run<'a> {
    pub(crate) fn new(place: Place<'a>, plan: Plan, within: Option<(Arc<Composite<'a>>, usize)>) -> Arc<Self> {
        let state = |step: &Step| State {
            pending: AtomicUsize::new(step.sources.len()),
            takers: AtomicUsize::new(step.dependents.len()),
            values: Mutex::new(None),
            ended: Mutex::new(None),
        };
        let states: Vec<State> = plan.steps.iter().map(state).collect();
        Arc::new(Self { place, plan, left: AtomicUsize::new(states.len()), states, within })
    }

    /// How a step ended.
    pub(crate) fn ended(&self, step: usize) -> Ended {
        self.states.get(step).and_then(|state| locked(&state.ended).clone()).unwrap_or(Ended::Cancelled)
    }

    /// Whether no two steps could ever run at the same time, so that a thread pool has nothing to offer.
    fn is_chain(&self) -> bool {
        let steps = &self.plan.steps;
        steps.iter().filter(|s| s.sources.is_empty()).count() <= 1
            && steps.iter().all(|s| s.dependents.len() <= 1 && s.body.is_none())
    }
}

impl<'a> Runner<'a> {
    /// Carries out the plan of the evaluated graph.
    pub(crate) fn run(&self, run: &Arc<Run<'a>>, pool: Option<&rayon::ThreadPool>) {
        match pool.filter(|_| !run.is_chain()) {
            None => self.run_alone(run),
            Some(pool) => pool.scope(|scope| {
                for task in sources(run) {
                    scope.spawn(move |scope| self.run_from(task, scope));
                }
            }),
        }
    }

    /// Carries out a plan on this thread: the steps in their order, and the run of a body when its step comes.
    fn run_alone(&self, run: &Arc<Run<'a>>) {
        let mut runs = vec![(run.clone(), 0)];
        let mut led = Led::default();
        while let Some((run, next)) = runs.last_mut() {
            let (run, step) = (run.clone(), *next);
            if step < run.states.len() {
                *next += 1;
                self.run_step(&run, step, &mut led);
            } else {
                runs.pop();
                self.run_is_over(&run, &mut led);
            }
            led.ended.clear();
            runs.extend(led.started.drain(..).rev().map(|run| (run, 0)));
        }
    }

    fn run_from<'s>(&'s self, task: Task<'a>, scope: &rayon::Scope<'s>)
    where
        'a: 's,
    {
        let mut next = Some(task);
        let mut led = Led::default();
        while let Some(Task { run, step }) = next.take() {
            match step {
                Some(step) => self.run_step(&run, step, &mut led),
                None => self.run_is_over(&run, &mut led),
            }
            // The first task that becomes ready runs here: a chain never changes threads.
            led.each_ready(|ready| {
                if next.is_none() {
                    next = Some(ready);
                } else {
                    scope.spawn(move |scope| self.run_from(ready, scope));
                }
            });
        }
    }

    fn emit(&self, run: &Run<'a>, step: &Step, kind: EventKind<'_>) {
        run.place.emit(self.events, step.node, kind);
    }

    pub(crate) fn disk<'d>(&'d self, place: &'d Place<'a>) -> Disk<'d> {
        Disk { base: self.base, folder: &place.folder, cache: self.files }
    }

    /// Runs a step, where nothing keeps it from running.
    fn run_step(&self, run: &Arc<Run<'a>>, index: usize, led: &mut Led<'a>) {
        match self.result(run, index, led) {
            Turn::Pending => {}
            Turn::Ended(ended, flight) => self.land(run, index, ended, flight, led),
        }
    }

    /// Ends a step, and those that were parked for its result.
    pub(crate) fn land(
        &self,
        run: &Arc<Run<'a>>,
        index: usize,
        ended: Ended,
        flight: Option<ContentHash>,
        led: &mut Led<'a>,
    ) {
        let parked = flight.map(|key| self.flights.land(key)).unwrap_or_default();
        let same = if parked.is_empty() { None } else { Some(ended.clone().taken()) };
        self.end(run, index, ended);
        led.ended.push((run.clone(), index));
        for (task, same) in parked.into_iter().zip(std::iter::repeat(same).flatten()) {
            if let Task { run, step: Some(step) } = task {
                self.end(&run, step, same);
                led.ended.push((run, step));
            }
        }
    }

    fn end(&self, run: &Run<'a>, index: usize, mut ended: Ended) {
        let (step, states) = (&run.plan.steps[index], &run.states);
        match &mut ended {
            Ended::Done { values, duration, ran, .. } => {
                self.emit(run, step, if *ran { EventKind::Finished(*duration) } else { EventKind::Hit });
                if !step.dependents.is_empty() {
                    locked(&states[index].values).clone_from(values);
                }
                if !step.is_target {
                    *values = None;
                }
            }
            Ended::Failed { failure, .. } => self.emit(run, step, EventKind::Failed(failure)),
            Ended::Waiting(on) => self.emit(run, step, EventKind::Waiting(&run.place.names(on))),
            Ended::Cancelled => self.emit(run, step, EventKind::Cancelled),
        }
        *locked(&states[index].ended) = Some(ended);
        for &source in &step.sources {
            if states[source].takers.fetch_sub(1, Ordering::AcqRel) == 1 {
                *locked(&states[source].values) = None;
            }
        }
    }

    fn result(&self, run: &Arc<Run<'a>>, index: usize, led: &mut Led<'a>) -> Turn {
        let (step, states) = (&run.plan.steps[index], &run.states);
        if let Some(stopped) = stopped_by_sources(run, step) {
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
        let disk = self.disk(&run.place);
        let mut key = match key(&step.kind, &inputs, disk) {
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
            match read.and_then(|read| Ok((read, self::key(&step.kind, &inputs, disk)?))) {
                Ok(read) => (contents, key) = read,
                Err(failure) => return failed(failure),
            }
        }
        let flight = key.hash;
        let task = Task { run: run.clone(), step: Some(index) };
        match self.flights.board(flight, task, || disk.remembered(self.memo, &mut key)) {
            Boarding::Remembered(entry) => Turn::Ended(Ended::of(key, &entry, false), None),
            Boarding::Parked => Turn::Pending,
            Boarding::Computes => match &step.body {
                None => Turn::Ended(self.compute(run, step, key, &inputs, &contents), Some(flight)),
                Some(body) => {
                    self.emit(run, step, EventKind::Started);
                    self.begin(Composite::new(run.clone(), index, body.clone(), key, inputs), led);
                    Turn::Pending
                }
            },
        }
    }

    fn compute(&self, run: &Run<'a>, step: &Step, key: Key, inputs: &[Option<Value>], files: &[FileBytes]) -> Ended {
        self.emit(run, step, EventKind::Started);
        let begun = Instant::now();
        let told_to_stop = AtomicBool::new(false);
        let result = self.call(run, step, inputs, files, &told_to_stop);
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
            Ok((values, report)) => (Ok(values.into()), self.shared(report)),
        };
        let entry = Arc::new(Entry { result, report, duration, files: None });
        self.memo.insert(key.hash, entry.clone());
        Ended::of(key, &entry, true)
    }

    /// Most nodes say nothing; they share one empty report.
    pub(crate) fn shared(&self, report: Report) -> Arc<Report> {
        if report.is_empty() { self.silence.clone() } else { Arc::new(report) }
    }

    fn call(
        &self,
        run: &Run<'a>,
        step: &Step,
        inputs: &[Option<Value>],
        files: &[FileBytes],
        told_to_stop: &AtomicBool,
    ) -> Result<(Vec<Value>, Report), NodeError> {
        let kind = &*step.kind;
        let progress = |fraction: f64| {
            let done = if fraction.is_nan() { 0.0 } else { fraction.clamp(0.0, 1.0) };
            self.emit(run, step, EventKind::Progress(done));
            let stop = self.cancel.is_cancelled();
            if stop {
                told_to_stop.store(true, Ordering::Relaxed);
            }
            !stop
        };
        call(kind, inputs, files, self.base, &progress)
    }
}

/// The steps of a run that can begin at once; for one without steps, that it is over.
fn sources<'a>(run: &Arc<Run<'a>>) -> impl Iterator<Item = Task<'a>> {
    let steps = run.plan.steps.iter().enumerate().filter(|(_, step)| step.sources.is_empty());
    let mut tasks: Vec<_> = steps.map(|(step, _)| Task { run: run.clone(), step: Some(step) }).collect();
    if run.states.is_empty() {
        tasks.push(Task { run: run.clone(), step: None });
    }
    tasks.into_iter()
}

impl<'a> Led<'a> {
    /// What can be done now; forgets what led to it.
    fn each_ready(&mut self, mut then: impl FnMut(Task<'a>)) {
        for (run, ended) in self.ended.drain(..) {
            for &dependent in &run.plan.steps[ended].dependents {
                if run.states[dependent].pending.fetch_sub(1, Ordering::AcqRel) == 1 {
                    then(Task { run: run.clone(), step: Some(dependent) });
                }
            }
            if run.left.fetch_sub(1, Ordering::AcqRel) == 1 {
                then(Task { run, step: None });
            }
        }
        self.started.drain(..).for_each(|run| sources(&run).for_each(&mut then));
    }
}

/// What keeps a step from running.
fn stopped_by_sources(run: &Run<'_>, step: &Step) -> Option<Ended> {
    let mut blame = Blame::default();
    let mut cancelled = false;
    for supply in &step.supplies {
        match supply {
            Supply::Missing(nodes) => blame.add(nodes),
            Supply::Scheduled { step: source, .. } => match &*locked(&run.states[*source].ended) {
                Some(Ended::Failed { .. }) => blame.add(&[run.plan.steps[*source].node]),
                Some(Ended::Waiting(on)) => blame.add(on),
                Some(Ended::Cancelled) => cancelled = true,
                Some(Ended::Done { .. }) | None => {}
            },
            Supply::Nothing | Supply::Value(_) | Supply::Given { .. } | Supply::Known { .. } => {}
        }
    }
    let waiting = blame.into_nodes().map(Ended::Waiting);
    waiting.or_else(|| cancelled.then_some(Ended::Cancelled))
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
