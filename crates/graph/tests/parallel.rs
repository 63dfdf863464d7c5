//! Threads: independent nodes overlap in time, and the number of threads changes no result.

mod kinds;

use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::Duration;

use kinds::{Rig, kind, state};
use maquette_graph::{EvaluatorOptions, NodeError, NodeKind, Request};

/// A meeting that ends when all are there, or too late.
#[derive(Default)]
struct Meeting {
    there: Mutex<usize>,
    arrived: Condvar,
}

impl Meeting {
    fn join(&self, wanted: usize) -> bool {
        let mut there = self.there.lock().unwrap_or_else(PoisonError::into_inner);
        *there += 1;
        self.arrived.notify_all();
        let wait = self.arrived.wait_timeout_while(there, Duration::from_secs(20), |there| *there < wanted);
        wait.is_ok_and(|(_, waited)| !waited.timed_out())
    }
}

fn meet(wanted: usize) -> NodeKind {
    let meeting = Arc::new(Meeting::default());
    kind("meet", |node| {
        let number = node.number("number", 0.0, -1e9..=1e9, "Anything.");
        let out = node.output::<f64>("number", "The same.");
        node.evaluate(move |ports| {
            if !meeting.join(wanted) {
                return Err(NodeError::new("nobody else came"));
            }
            ports.write(out, ports.value(number));
            Ok(())
        });
    })
}

#[test]
fn independent_nodes_run_at_the_same_time() {
    let mut rig = Rig::with_threads(2);
    rig.register(meet(2));
    for (name, number) in [("left", 1.0), ("right", 2.0)] {
        rig.add("meet", name);
        rig.set(&format!("{name}.number"), number);
    }
    rig.add("add", "both");
    rig.link("left.number", "both.a");
    rig.link("right.number", "both.b");
    let evaluation = rig.evaluate(&["both"]);
    assert_eq!(state(&evaluation, rig.id("both")), "done: 3");
}

#[test]
fn branches_behind_one_node_run_at_the_same_time() {
    let mut rig = Rig::with_threads(4);
    rig.register(meet(4));
    rig.add("add", "source");
    let names = ["a", "b", "c", "d"];
    for (name, number) in names.into_iter().zip([1.0, 2.0, 3.0, 4.0]) {
        rig.add("add", &format!("before-{name}"));
        rig.set(&format!("before-{name}.b"), number);
        rig.link("source.sum", &format!("before-{name}.a"));
        rig.add("meet", name);
        rig.link(&format!("before-{name}.sum"), &format!("{name}.number"));
    }
    let evaluation = rig.evaluate(&names);
    assert!(evaluation.is_complete(), "{:?}", evaluation.failures().next());
}

/// A graph of many layers whose nodes take two of the layer before, some of them failing.
fn layered(threads: usize, layers: usize, width: usize) -> Rig {
    let mut rig = Rig::with_threads(threads);
    let mut random = 12_345_u64;
    let mut next = move |bound: usize| {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(random >> 33).unwrap_or(0) % bound
    };
    for layer in 0..layers {
        for i in 0..width {
            let name = format!("n{layer}-{i}");
            if layer > 0 && next(25) == 0 {
                let root = format!("root{layer}-{i}");
                rig.add("root", &root);
                rig.link(&format!("n{}-{}.sum", layer - 1, next(width)), &format!("{root}.number"));
                rig.add("add", &name);
                rig.link(&format!("{root}.root"), &format!("{name}.a"));
                continue;
            }
            rig.add("add", &name);
            if layer == 0 {
                rig.set(&format!("{name}.a"), next(9) as f64 - 4.5);
            } else {
                rig.link(&format!("n{}-{}.sum", layer - 1, next(width)), &format!("{name}.a"));
                rig.link(&format!("n{}-{}.sum", layer - 1, next(width)), &format!("{name}.b"));
            }
        }
    }
    rig
}

#[test]
fn any_number_of_threads_gives_the_same_states_and_values() {
    let reference = {
        let mut rig = layered(1, 20, 20);
        states(&mut rig)
    };
    assert!(reference.iter().any(|line| line.contains("has no real root")), "some fail");
    assert!(reference.iter().any(|line| line.contains("waiting on")), "some wait");
    assert!(reference.iter().filter(|line| line.contains("done:")).count() > 100, "most are done");
    for threads in [2, 3, 8, 0] {
        for _ in 0..5 {
            assert_eq!(states(&mut layered(threads, 20, 20)), reference, "{threads} threads");
        }
    }
}

fn states(rig: &mut Rig) -> Vec<String> {
    let ids: Vec<_> = rig.graph.nodes().map(|(id, _)| id).collect();
    let evaluation = rig.request(Request::nodes(&ids));
    ids.iter().map(|id| format!("{:?} {}", rig.graph.node(*id).map(|n| n.name()), state(&evaluation, *id))).collect()
}

#[test]
fn each_node_runs_once_however_many_wait_for_it() {
    for threads in [2, 8] {
        let mut rig = layered(threads, 10, 30);
        let evaluation_states = states(&mut rig);
        let mut started: Vec<_> = rig.log.iter().filter(|line| line.starts_with("started")).cloned().collect();
        let all = started.len();
        started.sort();
        started.dedup();
        assert_eq!(started.len(), all);
        assert!(all > 0 && all <= evaluation_states.len());
    }
}

#[test]
fn a_mistyped_number_of_threads_does_no_harm() {
    let begun = std::time::Instant::now();
    let reference = states(&mut layered(1, 5, 5));
    assert_eq!(states(&mut layered(usize::MAX, 5, 5)), reference);
    assert!(begun.elapsed() < Duration::from_secs(20), "{:?}", begun.elapsed());
}

#[test]
fn nodes_may_use_threads_themselves() {
    let mut rig = Rig::with_options(&EvaluatorOptions { threads: 2, ..EvaluatorOptions::default() });
    rig.register(kind("sum-up", |node| {
        let number = node.number("number", 0.0, -1e9..=1e9, "Where to begin.");
        let out = node.output::<f64>("number", "The sum.");
        node.evaluate(move |ports| {
            use rayon::prelude::*;
            let from = ports.value(number);
            let squares: Vec<f64> = (0..10_000).into_par_iter().map(|i| from + f64::from(i)).collect();
            ports.write(out, squares.iter().sum());
            Ok(())
        });
    }));
    let names: Vec<_> = (0..50).map(|i| format!("n{i}")).collect();
    for (name, number) in names.iter().zip(0..) {
        rig.add("sum-up", name);
        rig.set(&format!("{name}.number"), f64::from(number));
    }
    let evaluation = rig.evaluate(&names.iter().map(String::as_str).collect::<Vec<_>>());
    assert!(evaluation.is_complete());
    assert_eq!(evaluation.value::<f64>(rig.id("n3"), "number"), Some(&(49_995_000.0 + 30_000.0)));
}
