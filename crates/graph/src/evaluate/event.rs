//! What happens during an evaluation, as it happens.

use std::fmt;
use std::sync::Mutex;
use std::time::Duration;

use crate::evaluate::Failure;
use crate::graph::NodeId;

/// Something happened to a node.
#[derive(Clone, Debug)]
pub struct Event<'a> {
    /// The node of the evaluated graph: for a node within a body, the one whose body that is.
    pub node: NodeId,
    /// Its name; for a node within a body its path, such as `hand/rails`, and within a repeated one `hands/2/rails`.
    pub name: &'a str,
    /// What happened.
    pub kind: EventKind<'a>,
}

/// What happened.
///
/// First come the nodes that are settled without running: [`Hit`](Self::Hit), [`Failed`](Self::Failed) or
/// [`Waiting`](Self::Waiting), one for each. Then comes [`Planned`](Self::Planned), and after it the scheduled
/// nodes. Each of these ends with exactly one of `Hit`, `Finished`, `Failed`, `Waiting` and `Cancelled`: a progress bar
/// that takes its length from `Planned` and counts these five, from there on, fills exactly. `Started`, `Progress` and
/// `Examined` don't count; a node that starts is ended by `Finished`, `Failed` or `Cancelled`.
///
/// When a node with a body starts, the nodes within are planned. `Planned` then comes again with the larger number, and
/// after it one of the five for each node within, be it settled without running or not; the node itself ends last.
#[derive(Clone, Debug)]
pub enum EventKind<'a> {
    /// So many nodes are scheduled; some of them need not run, where an equal result turns up meanwhile. Comes with the
    /// first target, after the events of all nodes that are settled without running; not at all where no target is
    /// given. Comes again where a body is planned, with all that were planned so far.
    Planned(usize),
    /// It began to run.
    Started,
    /// So much of it is done, 0 to 1.
    Progress(f64),
    /// The memo, or an equal node of this evaluation, answered in its place.
    Hit,
    /// It ran.
    Finished(Duration),
    /// It failed, now or in an earlier run that is remembered.
    Failed(&'a Failure),
    /// It could not run, because these nodes failed.
    Waiting(&'a [String]),
    /// It was stopped.
    Cancelled,
    /// What [`crate::Request::examine`] asks for was measured on its values, in this time. Comes behind the end of
    /// the node, and does not count.
    Examined(Duration),
}

impl fmt::Display for Event<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = self.name;
        match &self.kind {
            EventKind::Planned(count) => write!(f, "planned {count}"),
            EventKind::Started => write!(f, "started {name}"),
            EventKind::Progress(fraction) => write!(f, "progress {name} {:.0}%", fraction * 100.0),
            EventKind::Hit => write!(f, "hit {name}"),
            EventKind::Finished(_) => write!(f, "finished {name}"),
            EventKind::Failed(failure) => write!(f, "failed {name}: {failure}"),
            EventKind::Waiting(on) => write!(f, "waiting {name} on {}", on.join(", ")),
            EventKind::Cancelled => write!(f, "cancelled {name}"),
            EventKind::Examined(_) => write!(f, "examined {name}"),
        }
    }
}

/// Listens to an evaluation; called from the threads that run the nodes, so it must be quick.
pub trait Events: Sync {
    /// Something happened.
    fn event(&self, event: &Event<'_>);
}

/// Listens to nothing.
impl Events for () {
    fn event(&self, _: &Event<'_>) {}
}

impl<F: Fn(&Event<'_>) + Sync> Events for F {
    fn event(&self, event: &Event<'_>) {
        self(event);
    }
}

/// Collects events as lines of text, for tests of what ran.
#[derive(Debug, Default)]
pub struct EventLog(Mutex<Vec<String>>);

impl EventLog {
    /// The names of the nodes that ran, in the order in which they finished; the log is empty afterwards.
    pub fn take_ran(&self) -> Vec<String> {
        self.take().iter().filter_map(|line| line.strip_prefix("finished ").map(str::to_owned)).collect()
    }

    /// The lines; the log is empty afterwards.
    pub fn take(&self) -> Vec<String> {
        self.0.lock().map(|mut lines| std::mem::take(&mut *lines)).unwrap_or_default()
    }
}

impl Events for EventLog {
    fn event(&self, event: &Event<'_>) {
        if let Ok(mut lines) = self.0.lock() {
            lines.push(event.to_string());
        }
    }
}
