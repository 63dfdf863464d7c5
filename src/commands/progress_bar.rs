//! A bar with the running nodes, on a terminal only.

use std::collections::BTreeMap;
use std::io::IsTerminal as _;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use indicatif::{ProgressBar, ProgressStyle};
use maquette_graph::{Event, EventKind, Events};

/// Follows an evaluation on stderr; silent where that is no terminal.
pub(super) struct Progress {
    bar: ProgressBar,
    /// By name: nodes within a body share the identity of the node that has it.
    running: Mutex<BTreeMap<String, String>>,
    planned: AtomicBool,
}

impl Progress {
    pub(super) fn new(wanted: bool) -> Self {
        let shown = wanted && std::io::stderr().is_terminal();
        let bar = if shown { ProgressBar::new(0) } else { ProgressBar::hidden() };
        if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} nodes  {wide_msg}") {
            bar.set_style(style);
        }
        Self { bar, running: Mutex::default(), planned: AtomicBool::new(false) }
    }

    pub(super) fn finish(&self) {
        self.bar.finish_and_clear();
    }

    fn change(&self, change: impl FnOnce(&mut BTreeMap<String, String>)) {
        let mut running = self.running.lock().unwrap_or_else(PoisonError::into_inner);
        change(&mut running);
        self.bar.set_message(running.values().cloned().collect::<Vec<_>>().join(", "));
    }
}

impl Events for Progress {
    fn event(&self, event: &Event<'_>) {
        if self.bar.is_hidden() {
            return;
        }
        // What the plan settles by itself comes before `Planned`, and is not among the nodes that it counts.
        if !self.planned.load(Ordering::Relaxed) && !matches!(event.kind, EventKind::Planned(_)) {
            return;
        }
        match &event.kind {
            EventKind::Planned(count) => {
                self.planned.store(true, Ordering::Relaxed);
                self.bar.set_length(*count as u64);
            }
            EventKind::Started => self.change(|running| {
                running.insert(event.name.to_owned(), event.name.to_owned());
            }),
            EventKind::Progress(fraction) => self.change(|running| {
                running.insert(event.name.to_owned(), format!("{} {:.0} %", event.name, fraction * 100.0));
            }),
            EventKind::Examined(_) => {}
            EventKind::Hit
            | EventKind::Finished(_)
            | EventKind::Failed(_)
            | EventKind::Waiting(_)
            | EventKind::Cancelled => {
                self.change(|running| {
                    running.remove(event.name);
                });
                self.bar.inc(1);
            }
        }
    }
}

/// Counts the variants of a wedge on stderr; silent where that is no terminal.
pub(super) struct Variants(ProgressBar);

impl Variants {
    pub(super) fn new(wanted: bool, count: usize) -> Self {
        let shown = wanted && std::io::stderr().is_terminal();
        let bar = if shown { ProgressBar::new(count as u64) } else { ProgressBar::hidden() };
        if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} variants, {eta} left  {wide_msg}") {
            bar.set_style(style);
        }
        Self(bar)
    }

    /// Shows what is in work.
    pub(super) fn begin(&self, what: impl FnOnce() -> String) {
        if !self.0.is_hidden() {
            self.0.set_message(what());
        }
    }

    pub(super) fn advance(&self) {
        self.0.inc(1);
    }

    /// Says something while the bar is there.
    pub(super) fn aside(&self, say: impl FnOnce()) {
        self.0.suspend(say);
    }

    pub(super) fn finish(&self) {
        self.0.finish_and_clear();
    }
}
