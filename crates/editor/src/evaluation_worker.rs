//! The thread that evaluates, so that the window never waits.
//!
//! The newest graph wins: one that is handed over while another is evaluated takes its place, at the latest after
//! [`PATIENCE`]. Within that time the running one may end, so that a surface follows a drag instead of starting over and
//! over.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use maquette_graph::file::Project;
use maquette_graph::{CancelToken, Catalogue, Evaluation, Evaluator, Event, EventKind, Events, Graph, NodeId, Request};

use crate::drawable::{Depiction, Drawables, Evaluated, Shown};

/// How long an evaluation that is no longer wanted may go on.
const PATIENCE: Duration = Duration::from_millis(120);

/// What is to be evaluated.
pub(crate) struct Job {
    pub(crate) generation: u64,
    pub(crate) graph: Graph,
    /// The nodes whose values are wanted.
    pub(crate) targets: Vec<NodeId>,
    /// Those of them that are drawn.
    pub(crate) drawn: Vec<NodeId>,
    /// The nodes that were entered, and those within them whose values are wanted.
    pub(crate) path: Vec<NodeId>,
    pub(crate) within: Vec<NodeId>,
    pub(crate) folder: PathBuf,
    pub(crate) project: Project,
    /// What of values is made ready beside their shape.
    pub(crate) depiction: Depiction,
    /// The nodes of which is measured what costs too much for every evaluation.
    pub(crate) examined: Vec<NodeId>,
}

/// What came of it.
pub(crate) struct Finished {
    pub(crate) generation: u64,
    pub(crate) evaluation: Evaluation,
    /// That of the graph that was entered, with the nodes that lead there.
    pub(crate) within: Option<(Vec<NodeId>, Evaluation)>,
    pub(crate) shown: Vec<Shown>,
    pub(crate) timeline: Vec<Span>,
}

/// When a node ran, from the beginning of the evaluation.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Span {
    pub(crate) name: String,
    pub(crate) begin: Duration,
    pub(crate) end: Duration,
}

/// How it stands with a node, as far as is known.
#[derive(Clone, Debug, PartialEq)]
pub enum NodeStatus {
    /// It runs, and so much of it is done, 0 to 1.
    Running(f64),
    /// It ran, in this time.
    Done(Duration),
    /// The memo answered in its place.
    Hit,
    /// It failed, at this input where one is at fault.
    Failed {
        /// The input.
        port: Option<String>,
        /// What is wrong and what to do.
        message: String,
    },
    /// These nodes failed before it.
    Waiting(Vec<String>),
    /// It was stopped.
    Stopped,
}

/// Statuses by name; of a node within a body by its path, such as `hand/rails`.
pub type Statuses = BTreeMap<String, NodeStatus>;

#[derive(Default)]
struct State {
    pending: Option<Job>,
    running: Option<(Instant, CancelToken)>,
    finished: Option<Finished>,
    statuses: Arc<Statuses>,
    spans: BTreeMap<String, (Duration, Option<Duration>)>,
    planned: usize,
    ended: usize,
    quit: bool,
}

struct Shared {
    state: Mutex<State>,
    wake: Condvar,
    repaint: Box<dyn Fn() + Send + Sync>,
}

impl Shared {
    fn state(&self) -> MutexGuard<'_, State> {
        // Nothing is left half done where the lock is held.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The thread, and what it shares with the window.
pub(crate) struct EvaluationWorker {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

impl EvaluationWorker {
    /// Starts the thread; `repaint` is called from it whenever there is something new to show.
    pub(crate) fn start(
        catalogue: Arc<Catalogue>,
        repaint: impl Fn() + Send + Sync + 'static,
    ) -> std::io::Result<Self> {
        let shared = Arc::new(Shared { state: Mutex::default(), wake: Condvar::new(), repaint: Box::new(repaint) });
        let theirs = shared.clone();
        let thread =
            std::thread::Builder::new().name("evaluation".to_owned()).spawn(move || work(&theirs, &catalogue))?;
        Ok(Self { shared, thread: Some(thread) })
    }

    /// Hands a graph over, in place of one that still waits.
    pub(crate) fn submit(&self, job: Job) {
        let mut state = self.shared.state();
        if let Some((since, cancel)) = &state.running
            && since.elapsed() > PATIENCE
        {
            cancel.cancel();
        }
        state.pending = Some(job);
        self.shared.wake.notify_one();
    }

    /// Stops what runs and what waits.
    pub(crate) fn stop(&self) {
        let mut state = self.shared.state();
        state.pending = None;
        if let Some((_, cancel)) = &state.running {
            cancel.cancel();
        }
    }

    /// Stops everything and forgets what is known of nodes, for another document.
    pub(crate) fn clear(&self) {
        self.stop();
        let mut state = self.shared.state();
        state.finished = None;
        state.statuses = Arc::default();
    }

    /// What was finished since the last call. Stops what runs too long while something newer waits; says when to ask again
    /// for that.
    pub(crate) fn poll(&self) -> (Option<Finished>, Option<Duration>) {
        let mut state = self.shared.state();
        let mut again = None;
        if state.pending.is_some()
            && let Some((since, cancel)) = &state.running
        {
            match PATIENCE.checked_sub(since.elapsed()) {
                Some(left) => again = Some(left),
                None => cancel.cancel(),
            }
        }
        (state.finished.take(), again)
    }

    /// How it stands with the nodes.
    pub(crate) fn statuses(&self) -> Arc<Statuses> {
        self.shared.state().statuses.clone()
    }

    /// Whether something runs or waits, and how many of the scheduled nodes are done.
    pub(crate) fn progress(&self) -> Option<(usize, usize)> {
        let state = self.shared.state();
        (state.running.is_some() || state.pending.is_some()).then_some((state.ended, state.planned))
    }
}

impl Drop for EvaluationWorker {
    fn drop(&mut self) {
        {
            let mut state = self.shared.state();
            state.quit = true;
            if let Some((_, cancel)) = &state.running {
                cancel.cancel();
            }
        }
        self.shared.wake.notify_one();
        if let Some(thread) = self.thread.take() {
            // It catches what nodes do wrong; there is nothing to do about anything else.
            drop(thread.join());
        }
    }
}

fn work(shared: &Arc<Shared>, catalogue: &Catalogue) {
    let mut evaluator = Evaluator::default();
    let mut drawables = Drawables::default();
    loop {
        let (job, cancel) = {
            let mut state = shared.state();
            let job = loop {
                if state.quit {
                    return;
                }
                match state.pending.take() {
                    Some(job) => break job,
                    None => state = shared.wake.wait(state).unwrap_or_else(PoisonError::into_inner),
                }
            };
            let cancel = CancelToken::new();
            state.running = Some((Instant::now(), cancel.clone()));
            state.spans.clear();
            (state.planned, state.ended) = (0, 0);
            (job, cancel)
        };
        let finished = evaluate(shared, catalogue, &mut evaluator, &mut drawables, job, &cancel);
        {
            let mut state = shared.state();
            state.running = None;
            // What was cut short for something newer tells nothing that will not be told again.
            if !finished.evaluation.cancelled || state.pending.is_none() {
                state.finished = Some(finished);
            }
        }
        (shared.repaint)();
    }
}

fn evaluate(
    shared: &Arc<Shared>,
    catalogue: &Catalogue,
    evaluator: &mut Evaluator,
    drawables: &mut Drawables,
    job: Job,
    cancel: &CancelToken,
) -> Finished {
    let listener = Listener { shared, begun: Instant::now() };
    let request = Request::nodes(&job.targets).examine_only(&job.examined);
    let request = request.events(&listener).cancel(cancel).base(&job.folder).project(&job.project);
    let evaluation = evaluator.evaluate(catalogue, &job.graph, &request);
    let looks_within = !job.path.is_empty() && !job.within.is_empty() && !evaluation.cancelled;
    let inner = Request::nodes(&job.within).events(&listener).cancel(cancel).base(&job.folder).project(&job.project);
    let within = looks_within.then(|| evaluator.evaluate_within(catalogue, &job.graph, &job.path, &inner)).flatten();
    let mut evaluated = vec![Evaluated { path: &[], evaluation: &evaluation, nodes: &job.drawn }];
    evaluated.extend(within.iter().map(|within| Evaluated { path: &job.path, evaluation: within, nodes: &job.within }));
    let shown = drawables.of(&evaluated, job.depiction);
    let within = within.map(|within| (job.path, within));
    let spans = std::mem::take(&mut shared.state().spans);
    let mut timeline: Vec<Span> =
        spans.into_iter().filter_map(|(name, (begin, end))| Some(Span { name, begin, end: end? })).collect();
    timeline.sort_by(|a, b| a.begin.cmp(&b.begin).then_with(|| a.name.cmp(&b.name)));
    Finished { generation: job.generation, evaluation, within, shown, timeline }
}

struct Listener<'a> {
    shared: &'a Shared,
    begun: Instant,
}

impl Events for Listener<'_> {
    fn event(&self, event: &Event<'_>) {
        let now = self.begun.elapsed();
        let mut state = self.shared.state();
        let name = event.name.to_owned();
        let status = match &event.kind {
            EventKind::Planned(count) => {
                state.planned = *count;
                state.ended = 0;
                return;
            }
            EventKind::Started => {
                state.spans.insert(name.clone(), (now, None));
                NodeStatus::Running(0.0)
            }
            EventKind::Progress(fraction) => NodeStatus::Running(*fraction),
            EventKind::Hit => NodeStatus::Hit,
            EventKind::Finished(duration) => NodeStatus::Done(*duration),
            EventKind::Failed(failure) => {
                NodeStatus::Failed { port: failure.port.clone(), message: failure.message.clone() }
            }
            EventKind::Waiting(on) => NodeStatus::Waiting(on.to_vec()),
            EventKind::Cancelled => NodeStatus::Stopped,
            EventKind::Examined(_) => return,
        };
        if !matches!(status, NodeStatus::Running(_)) {
            state.ended += 1;
            if let Some(span) = state.spans.get_mut(&name) {
                span.1 = Some(now);
            }
        }
        Arc::make_mut(&mut state.statuses).insert(name, status);
        drop(state);
        // Only what takes long is worth a repaint before the end.
        if now > PATIENCE {
            (self.shared.repaint)();
        }
    }
}
