//! Equal nodes are computed once, whatever the number of threads.

#![allow(clippy::unwrap_used, reason = "in tests a failing unwrap is a failing test")]

mod kinds;

use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use kinds::{Rig, kind, state};
use maquette_graph::{CancelToken, EvaluatorOptions, NodeError, NodeKind, Request};

/// Takes its time, and says how often it ran. Negative numbers fail.
fn heavy(runs: &Arc<AtomicUsize>) -> NodeKind {
    let runs = runs.clone();
    kind("heavy", |node| {
        let number = node.number("number", 0.0, -1e9..=1e9, "Anything.");
        let out = node.output::<f64>("number", "The same.");
        node.evaluate(move |ports| {
            runs.fetch_add(1, Ordering::SeqCst);
            for _ in 0..20 {
                std::thread::sleep(Duration::from_millis(1));
                ports.progress_callback()(0.5);
            }
            let number = ports.value(number);
            if number < 0.0 {
                return Err(NodeError::new("too heavy"));
            }
            ports.write(out, number);
            Ok(())
        });
    })
}

/// Six equal heavy nodes, each behind an equal node and before one of its own, and a sum of them all.
fn twins(threads: usize, byte_budget: usize, number: f64) -> (Rig, Arc<AtomicUsize>) {
    let runs = Arc::new(AtomicUsize::new(0));
    let mut rig = Rig::with_options(&EvaluatorOptions { threads, byte_budget });
    rig.register(heavy(&runs));
    for i in 0..6 {
        rig.add("add", &format!("before{i}"));
        rig.set(&format!("before{i}.a"), number);
        rig.add("heavy", &format!("heavy{i}"));
        rig.link(&format!("before{i}.sum"), &format!("heavy{i}.number"));
        rig.add("add", &format!("behind{i}"));
        rig.link(&format!("heavy{i}.number"), &format!("behind{i}.a"));
        // Powers of ten, so that no two sums are of the same terms by coincidence.
        rig.set(&format!("behind{i}.b"), 10_f64.powi(i + 1));
        if i > 0 {
            rig.add("add", &format!("sum{i}"));
            let sum = if i == 1 { "behind0.sum".to_owned() } else { format!("sum{}.sum", i - 1) };
            rig.link(&sum, &format!("sum{i}.a"));
            rig.link(&format!("behind{i}.sum"), &format!("sum{i}.b"));
        }
    }
    (rig, runs)
}

fn log(rig: &Rig) -> BTreeSet<String> {
    rig.log.iter().filter(|line| !line.starts_with("progress")).cloned().collect()
}

#[test]
fn equal_nodes_run_once_and_the_log_is_the_same_for_any_number_of_threads() {
    for budget in [1 << 30, 0] {
        let reference = {
            let (mut rig, _) = twins(1, budget, 3.0);
            rig.evaluate(&["sum5"]);
            log(&rig)
        };
        assert!(reference.contains("started heavy0") && reference.contains("hit heavy5"), "{reference:?}");
        for threads in [1, 2, 8] {
            let (mut rig, runs) = twins(threads, budget, 3.0);
            let evaluation = rig.evaluate(&["sum5"]);
            assert_eq!(state(&evaluation, rig.id("sum5")), "done: 1111128");
            assert_eq!(runs.load(Ordering::SeqCst), 1, "{threads} threads");
            // before0, heavy0, behind0 to behind5, sum1 to sum5.
            assert_eq!((evaluation.run_count(), evaluation.hit_count()), (13, 10), "{threads} threads, {budget} bytes");
            assert_eq!(log(&rig), reference, "{threads} threads, {budget} bytes");
        }
    }
}

#[test]
fn all_equal_nodes_share_one_failure() {
    for threads in [1, 2, 8] {
        let (mut rig, runs) = twins(threads, 1 << 30, -3.0);
        let evaluation = rig.evaluate(&["sum5"]);
        assert_eq!(runs.load(Ordering::SeqCst), 1);
        for i in 0..6 {
            assert_eq!(state(&evaluation, rig.id(&format!("heavy{i}"))), "failed: too heavy");
        }
        let all = "waiting on heavy0, heavy1, heavy2, heavy3, heavy4, heavy5";
        assert_eq!(state(&evaluation, rig.id("sum5")), all, "each by its own name");
        assert_eq!(state(&rig.evaluate(&["sum5"]), rig.id("sum5")), all);
    }
}

/// Heavy nodes whose inputs turn out equal only when they are there: the signs of different numbers.
fn coincidences(threads: usize, token: Option<CancelToken>, fails: bool) -> (Rig, Arc<AtomicUsize>) {
    let runs = Arc::new(AtomicUsize::new(0));
    let mut rig = Rig::with_threads(threads);
    let counter = runs.clone();
    rig.register(kind("heavy-words", |node| {
        let text = node.text("text", "", "Anything.");
        let out = node.output::<String>("text", "The same.");
        node.evaluate(move |ports| {
            counter.fetch_add(1, Ordering::SeqCst);
            std::thread::sleep(Duration::from_millis(30));
            if let Some(token) = &token {
                token.cancel();
            }
            ports.progress(0.5)?;
            if fails {
                return Err(NodeError::new("too heavy"));
            }
            let text = ports.read(text).clone();
            ports.write(out, text);
            Ok(())
        });
    }));
    for i in 0..8 {
        rig.add("sign", &format!("sign{i}"));
        rig.set(&format!("sign{i}.number"), 1.0 + f64::from(i));
        rig.add("heavy-words", &format!("heavy{i}"));
        rig.link(&format!("sign{i}.text"), &format!("heavy{i}.text"));
        rig.add("count", &format!("behind{i}"));
        rig.put(&format!("behind{i}.count"), maquette_graph::Literal::Integer(i.into()));
        rig.link(&format!("heavy{i}.text"), &format!("behind{i}.text"));
    }
    (rig, runs)
}

const BEHIND: [&str; 8] = ["behind0", "behind1", "behind2", "behind3", "behind4", "behind5", "behind6", "behind7"];

#[test]
fn inputs_that_turn_out_equal_are_computed_once_too() {
    for threads in [1, 2, 8] {
        let (mut rig, runs) = coincidences(threads, None, false);
        let evaluation = rig.evaluate(&BEHIND);
        assert!(evaluation.is_complete());
        assert_eq!(runs.load(Ordering::SeqCst), 1, "{threads} threads");
        assert_eq!((evaluation.run_count(), evaluation.hit_count()), (17, 7), "{threads} threads");
        assert_eq!(state(&evaluation, rig.id("behind2")), "done: 2, \"positivepositive\"");
        let mut ended: Vec<_> = rig.log.iter().filter_map(|line| line.split_once(' ')).collect();
        ended.retain(|(what, _)| matches!(*what, "hit" | "finished"));
        let names: BTreeSet<_> = ended.iter().map(|(_, name)| *name).collect();
        assert_eq!((ended.len(), names.len()), (24, 24), "each ends once");
    }
}

#[test]
fn whoever_waits_for_a_failure_gets_it() {
    for threads in [1, 2, 8] {
        let (mut rig, runs) = coincidences(threads, None, true);
        let evaluation = rig.evaluate(&BEHIND);
        assert_eq!(runs.load(Ordering::SeqCst), 1, "{threads} threads");
        assert_eq!(evaluation.failures().count(), 8);
        assert_eq!(evaluation.run_count(), 9, "eight signs and the one that failed");
        assert_eq!(state(&evaluation, rig.id("behind7")), "waiting on heavy7");
    }
}

#[test]
fn whoever_waits_for_a_cancelled_node_is_cancelled() {
    for threads in [1, 2, 8] {
        let token = CancelToken::new();
        let (mut rig, runs) = coincidences(threads, Some(token.clone()), false);
        let ids = BEHIND.map(|name| rig.id(name));
        let evaluation = rig.request(Request::nodes(&ids).cancel(&token));
        assert!(evaluation.cancelled);
        assert_eq!(runs.load(Ordering::SeqCst), 1, "{threads} threads");
        assert_eq!(evaluation.failures().count(), 0);
        for id in ids {
            assert_eq!(state(&evaluation, id), "cancelled");
        }
        // The node cancels another token now, so it completes.
        let evaluation = rig.request(Request::nodes(&ids));
        assert!(evaluation.is_complete());
        assert_eq!(runs.load(Ordering::SeqCst), 2);
    }
}
