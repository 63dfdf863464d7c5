//! A progress bar that follows the documentation of `EventKind` fills exactly.

#![allow(clippy::unwrap_used, reason = "in tests a failing unwrap is a failing test")]

mod kinds;

use std::sync::Mutex;

use kinds::{Rig, kind};
use maquette_graph::{CancelToken, Event, EventKind, NodeId, Request};

/// Follows events as a progress bar does.
#[derive(Default)]
struct Bar {
    length: Option<usize>,
    done: usize,
    started: Vec<NodeId>,
    settled: usize,
    mistakes: Vec<String>,
}

impl Bar {
    fn follow(&mut self, event: &Event<'_>) {
        let ends = match event.kind {
            EventKind::Planned(length) => {
                if self.length.replace(length).is_some() {
                    self.mistakes.push("planned twice".to_owned());
                }
                return;
            }
            EventKind::Started => {
                self.started.push(event.node);
                false
            }
            EventKind::Progress(_) => false,
            _ => true,
        };
        match self.length {
            None if ends && !matches!(event.kind, EventKind::Finished(_) | EventKind::Cancelled) => self.settled += 1,
            Some(_) if ends => {
                self.done += 1;
                self.started.retain(|node| *node != event.node);
            }
            Some(_) => {}
            None => self.mistakes.push(format!("{event} before planned")),
        }
        if self.length.is_some_and(|length| self.done + self.started.len() > length) {
            self.mistakes.push(format!("{event} overshoots"));
        }
    }
}

fn follow(rig: &mut Rig, targets: &[NodeId], cancel: &CancelToken) -> Bar {
    let bar = Mutex::new(Bar::default());
    let listen = |event: &Event<'_>| bar.lock().unwrap().follow(event);
    let request = Request::nodes(targets).cancel(cancel).events(&listen);
    let evaluation = rig.evaluator.evaluate(&rig.catalogue, &rig.graph, &request);
    let bar = bar.into_inner().unwrap();
    assert_eq!(bar.mistakes, [""; 0]);
    assert_eq!(Some(bar.done), bar.length, "it fills exactly");
    assert_eq!(bar.started, [], "what starts also ends");
    assert_eq!(bar.settled + bar.done, evaluation.outcomes().len(), "one end for each node");
    bar
}

/// Chains with failing, refused, equal, unconnected and good nodes, and a sum of all of them.
fn mixture(threads: usize) -> (Rig, Vec<NodeId>) {
    let mut rig = Rig::with_threads(threads);
    rig.add("measure", "unconnected");
    for i in 0..40_i32 {
        let name = |what: &str| format!("{what}{i}");
        rig.add("add", &name("first"));
        rig.set(&format!("first{i}.a"), f64::from(i % 7) - 2.0);
        rig.add("root", &name("root"));
        rig.link(&format!("first{i}.sum"), &format!("root{i}.number"));
        rig.add("add", &name("last"));
        rig.link(&format!("root{i}.root"), &format!("last{i}.a"));
        if i % 5 == 0 {
            rig.link("unconnected.total", &format!("last{i}.b"));
        }
    }
    let ids = rig.graph.nodes().map(|(id, _)| id).collect();
    (rig, ids)
}

#[test]
fn planned_counts_what_ends_behind_it() {
    for threads in [1, 2, 8] {
        let (mut rig, ids) = mixture(threads);
        let bar = follow(&mut rig, &ids, &CancelToken::new());
        assert!(bar.done > 80 && bar.settled > 0, "{} {}", bar.done, bar.settled);
        let bar = follow(&mut rig, &ids, &CancelToken::new());
        assert_eq!((bar.done, bar.settled), (0, ids.len()), "all is known");
        rig.set("first3.a", 100.0);
        let bar = follow(&mut rig, &ids, &CancelToken::new());
        assert_eq!(bar.done, 3);
    }
}

#[test]
fn it_fills_when_cancelled_too() {
    for threads in [1, 2] {
        let (mut rig, _) = mixture(threads);
        let cancel = CancelToken::new();
        let token = cancel.clone();
        rig.register(kind("stop", |node| {
            node.evaluate(move |_| {
                token.cancel();
                Ok(())
            });
        }));
        rig.add("stop", "stop");
        let mut ids: Vec<_> = rig.graph.nodes().map(|(id, _)| id).collect();
        ids.reverse();
        follow(&mut rig, &ids, &cancel);
        follow(&mut rig, &ids, &cancel);
    }
}
