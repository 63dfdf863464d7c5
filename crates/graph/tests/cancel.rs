//! Stopping an evaluation: nothing half done is remembered, and the next evaluation completes.

mod kinds;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use kinds::{Rig, kind, state};
use maquette_graph::{CancelToken, Event, EventKind, NodeKind, Request};

/// Works while `busy`, reporting progress.
fn long(busy: &Arc<AtomicBool>) -> NodeKind {
    let busy = busy.clone();
    kind("long", |node| {
        let number = node.number("number", 0.0, -1e9..=1e9, "Anything.");
        let out = node.output::<f64>("number", "The same.");
        node.evaluate(move |ports| {
            while busy.load(Ordering::SeqCst) {
                ports.progress(0.5)?;
                std::thread::sleep(Duration::from_millis(1));
            }
            ports.write(out, ports.value(number));
            Ok(())
        });
    })
}

fn long_chain(threads: usize) -> (Rig, Arc<AtomicBool>) {
    let busy = Arc::new(AtomicBool::new(true));
    let mut rig = Rig::with_threads(threads);
    rig.register(long(&busy));
    rig.add("add", "before");
    rig.set("before.a", 1.0);
    rig.add("long", "long");
    rig.add("add", "behind");
    rig.add("add", "last");
    rig.link("before.sum", "long.number");
    rig.link("long.number", "behind.a");
    rig.link("behind.sum", "last.a");
    // Each adds something else, or one would find what another computed.
    rig.set("behind.b", 10.0);
    rig.set("last.b", 100.0);
    (rig, busy)
}

#[test]
fn from_another_thread_in_the_middle_of_a_node() {
    for threads in [1, 2] {
        let (mut rig, busy) = long_chain(threads);
        rig.add("add", "aside");
        rig.set("aside.a", 1000.0);
        let (last, aside) = (rig.id("last"), rig.id("aside"));
        let cancel = CancelToken::new();
        let (sender, started) = std::sync::mpsc::channel();
        let sender = std::sync::Mutex::new(sender);
        let listen = |event: &Event<'_>| {
            if let (EventKind::Progress(_), Ok(sender)) = (&event.kind, sender.lock()) {
                let _ = sender.send(());
            }
        };
        let evaluation = std::thread::scope(|scope| {
            let token = cancel.clone();
            scope.spawn(move || {
                assert_eq!(started.recv(), Ok(()), "the long node began");
                token.cancel();
            });
            let request = Request::nodes(&[last]).cancel(&cancel).events(&listen);
            rig.evaluator.evaluate(&rig.catalogue, &rig.graph, &request)
        });
        assert!(evaluation.cancelled && !evaluation.is_complete());
        assert_eq!(evaluation.failures().count(), 0, "to be stopped is no failure");
        assert_eq!(state(&evaluation, rig.id("before")), "done");
        for name in ["long", "behind", "last"] {
            assert_eq!(state(&evaluation, rig.id(name)), "cancelled", "{name}");
        }

        busy.store(false, Ordering::SeqCst);
        let evaluation = rig.request(Request::nodes(&[last, aside]));
        assert_eq!(state(&evaluation, last), "done: 111");
        assert!(!evaluation.cancelled);
        assert_eq!(evaluation.run_count(), 4, "long, behind, last and aside; before is remembered");
    }
}

#[test]
fn events_say_what_was_cancelled() {
    let (mut rig, _busy) = long_chain(1);
    rig.evaluate(&["before"]);
    let last = rig.id("last");
    let cancel = CancelToken::new();
    cancel.cancel();
    assert!(cancel.clone().is_cancelled(), "clones share the flag");
    let evaluation = rig.request(Request::nodes(&[last]).cancel(&cancel));
    assert_eq!(rig.log, ["hit before", "planned 3", "cancelled long", "cancelled behind", "cancelled last"]);
    assert_eq!(evaluation.run_count(), 0);
}

#[test]
fn what_is_known_is_given_even_when_cancelled() {
    let mut rig = Rig::default();
    rig.chain(3);
    rig.evaluate(&["n2"]);
    let cancel = CancelToken::new();
    cancel.cancel();
    let n2 = rig.id("n2");
    let evaluation = rig.request(Request::nodes(&[n2]).cancel(&cancel));
    assert!(!evaluation.cancelled);
    assert_eq!(state(&evaluation, n2), "done: 3");
}

/// Cancels by itself and then behaves in one of the ways in which mathematics may take a stop.
fn stopping(cancel: &CancelToken, runs: &Arc<AtomicUsize>, ending: &'static str) -> NodeKind {
    let (cancel, runs) = (cancel.clone(), runs.clone());
    kind("stopping", |node| {
        let out = node.output::<f64>("number", "Half or whole.");
        node.evaluate(move |ports| {
            let go_on = ports.progress_callback();
            if runs.fetch_add(1, Ordering::SeqCst) == 0 {
                cancel.cancel();
            }
            ports.write(out, if go_on(0.5) { 1.0 } else { 0.5 });
            match ending {
                "half a result" => Ok(()),
                "an error of its own" if runs.load(Ordering::SeqCst) == 1 => {
                    Err(maquette_graph::NodeError::new("the solver was interrupted"))
                }
                "an error of its own" => Ok(()),
                _ => ports.progress(0.6),
            }
        });
    })
}

#[test]
fn neither_half_results_nor_errors_of_a_stopped_node_are_remembered() {
    for ending in ["half a result", "an error of its own", "cancelled"] {
        let cancel = CancelToken::new();
        let runs = Arc::new(AtomicUsize::new(0));
        let mut rig = Rig::default();
        rig.register(stopping(&cancel, &runs, ending));
        rig.add("stopping", "stopping");
        rig.add("add", "behind");
        rig.link("stopping.number", "behind.a");
        let behind = rig.id("behind");
        let evaluation = rig.request(Request::nodes(&[behind]).cancel(&cancel));
        assert_eq!(rig.log[1..3], ["started stopping", "progress stopping 50%"]);
        assert_eq!(rig.log[rig.log.len() - 2..], ["cancelled stopping", "cancelled behind"], "{ending}");
        assert_eq!(state(&evaluation, behind), "cancelled");
        let evaluation = rig.evaluate(&["behind"]);
        assert_eq!(state(&evaluation, behind), "done: 1", "{ending}");
        assert_eq!(runs.load(Ordering::SeqCst), 2);
    }
}

#[test]
fn a_result_that_was_never_told_to_stop_is_kept() {
    let cancel = CancelToken::new();
    let mut rig = Rig::default();
    let token = cancel.clone();
    rig.register(kind("deaf-and-failing", |node| {
        let token = token.clone();
        node.evaluate(move |_| {
            token.cancel();
            Err(maquette_graph::NodeError::new("nothing to do with the stop"))
        });
    }));
    rig.register(kind("deaf", |node| {
        let out = node.output::<f64>("number", "One.");
        node.evaluate(move |ports| {
            token.cancel();
            ports.write(out, 1.0);
            Ok(())
        });
    }));
    rig.add("deaf", "deaf");
    rig.add("add", "behind");
    rig.link("deaf.number", "behind.a");
    let behind = rig.id("behind");
    let evaluation = rig.request(Request::nodes(&[behind]).cancel(&cancel));
    assert_eq!(state(&evaluation, rig.id("deaf")), "done");
    assert_eq!(state(&evaluation, behind), "cancelled");
    assert_eq!(rig.ran(&["behind"]), ["behind"]);

    let cancel = CancelToken::new();
    let failing = rig.add("deaf-and-failing", "failing");
    for line in ["started failing", "planned 0"] {
        let evaluation = rig.request(Request::nodes(&[failing]).cancel(&cancel));
        assert_eq!(state(&evaluation, failing), "failed: nothing to do with the stop");
        assert!(rig.log.iter().any(|l| l == line), "{:?}", rig.log);
    }
}

#[test]
fn a_failure_known_before_the_stop_stays_a_failure() {
    let mut rig = Rig::default();
    rig.add("root", "root");
    rig.set("root.number", -1.0);
    rig.add("add", "behind");
    rig.link("root.root", "behind.a");
    rig.evaluate(&["behind"]);
    let cancel = CancelToken::new();
    cancel.cancel();
    let behind = rig.id("behind");
    let evaluation = rig.request(Request::nodes(&[behind]).cancel(&cancel));
    assert_eq!(state(&evaluation, behind), "waiting on root");
}

#[test]
fn a_wide_evaluation_stops_soon() {
    let mut rig = Rig::with_threads(2);
    rig.register(kind("sleep", |node| {
        let number = node.number("number", 0.0, -1e9..=1e9, "Anything.");
        let out = node.output::<f64>("number", "The same.");
        node.evaluate(move |ports| {
            std::thread::sleep(Duration::from_millis(5));
            ports.write(out, ports.value(number));
            Ok(())
        });
    }));
    let ids: Vec<_> = (0..400)
        .map(|i| {
            let id = rig.add("sleep", &format!("n{i}"));
            rig.set(&format!("n{i}.number"), f64::from(i));
            id
        })
        .collect();
    let cancel = CancelToken::new();
    let begun = Instant::now();
    let evaluation = std::thread::scope(|scope| {
        scope.spawn(|| {
            std::thread::sleep(Duration::from_millis(50));
            cancel.cancel();
        });
        rig.evaluator.evaluate(&rig.catalogue, &rig.graph, &Request::nodes(&ids).cancel(&cancel))
    });
    assert!(evaluation.cancelled);
    assert!(begun.elapsed() < Duration::from_millis(800), "400 nodes on 2 threads take a second");
    let ran = evaluation.run_count();
    assert!(ran < 400);
    assert_eq!(rig.request(Request::nodes(&ids)).run_count(), 400 - ran, "what was finished is remembered");
}
