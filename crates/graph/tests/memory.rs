//! What is kept and what is dropped: the byte budget and intermediate values.

mod kinds;

use std::sync::Arc;
use std::sync::atomic::Ordering;

use kinds::{Block, Living, Rig, kind, state};
use maquette_graph::EvaluatorOptions;

/// A chain of nodes `b0 -> b1 -> ...` that hand on a big block.
fn blocks(length: usize, budget: usize, threads: usize) -> (Rig, Arc<Living>) {
    let living = Arc::new(Living::default());
    let mut rig = Rig::with_options(&EvaluatorOptions { threads, byte_budget: budget });
    for (name, has_input) in [("first-block", false), ("next-block", true)] {
        let living = living.clone();
        rig.register(kind(name, |node| {
            let block = has_input.then(|| node.input::<Block>("block", "The block before."));
            let tag = node.number("tag", 0.0, -1e9..=1e9, "What to tell blocks apart by.");
            let out = node.output::<Block>("block", "Another block.");
            node.evaluate(move |ports| {
                let before = block.map(|block| ports.read(block));
                let tag = ports.value(tag) + before.map_or(0.0, |_| 1.0);
                ports.write(out, Block::new(tag, &living));
                Ok(())
            });
        }));
    }
    for i in 0..length {
        rig.add(if i == 0 { "first-block" } else { "next-block" }, &format!("b{i}"));
        rig.set(&format!("b{i}.tag"), 10.0 * f64::from(u32::try_from(i).unwrap_or(0)));
        if i > 0 {
            rig.link(&format!("b{}.block", i - 1), &format!("b{i}.block"));
        }
    }
    (rig, living)
}

#[test]
fn intermediates_are_dropped_as_soon_as_nobody_needs_them() {
    for threads in [1, 2] {
        let (mut rig, living) = blocks(100, 1_000, threads);
        let evaluation = rig.evaluate(&["b99"]);
        assert_eq!(evaluation.run_count(), 100);
        assert!(living.most.load(Ordering::SeqCst) <= 3, "at most {} at once", living.most.load(Ordering::SeqCst));
        assert_eq!(living.now.load(Ordering::SeqCst), 1, "the one asked for");
        drop(evaluation);
        assert_eq!(living.now.load(Ordering::SeqCst), 0, "and that belongs to the evaluation");
    }
}

#[test]
fn a_value_lives_until_its_last_taker_has_run() {
    let (mut rig, living) = blocks(20, 1_000, 1);
    // b0 also feeds the last one, so it must live on.
    rig.link("b0.block", "b19.block");
    rig.add("next-block", "b20");
    rig.link("b18.block", "b20.block");
    let evaluation = rig.evaluate(&["b20", "b19"]);
    assert!(evaluation.is_complete());
    assert_eq!(living.now.load(Ordering::SeqCst), 2);
    assert!(living.most.load(Ordering::SeqCst) <= 5);
}

#[test]
fn failing_and_waiting_takers_release_values_too() {
    let (mut rig, living) = blocks(3, 1_000, 1);
    rig.register(kind("refuse", |node| {
        let block = node.input::<Block>("block", "Refused.");
        let other = node.optional::<f64>("other", "Not used.");
        let out = node.output::<f64>("number", "Never.");
        node.evaluate(move |ports| {
            let _ = (ports.read(block), ports.read_optional(other), out);
            Err(maquette_graph::NodeError::new("no"))
        });
    }));
    for name in ["refuse", "behind"] {
        rig.add("refuse", name);
        rig.link("b2.block", &format!("{name}.block"));
    }
    rig.link("refuse.number", "behind.other");
    let evaluation = rig.evaluate(&["behind"]);
    assert_eq!(state(&evaluation, rig.id("behind")), "waiting on refuse");
    assert_eq!(living.now.load(Ordering::SeqCst), 0);
}

#[test]
fn within_the_budget_blocks_are_remembered_and_beyond_it_the_oldest_go() {
    let (mut rig, living) = blocks(10, 5 * Block::BYTES, 1);
    rig.evaluate(&["b9"]);
    assert_eq!(living.now.load(Ordering::SeqCst), 4, "each costs a little more than its bytes");
    assert!(rig.evaluator.remembered_bytes() <= 5 * Block::BYTES);
    assert!(rig.evaluator.remembered_bytes() >= 4 * Block::BYTES);
    // b9 is remembered, so nothing runs; nor when its own tag changes, since b8 is remembered as well.
    assert_eq!(rig.evaluate(&["b9"]).run_count(), 0);
    rig.set("b9.tag", 5.0);
    assert_eq!(rig.ran(&["b9"]), ["b9"]);
    // b0 to b5 are gone. They run again on demand, with the same result.
    let evaluation = rig.evaluate(&["b2"]);
    assert_eq!((evaluation.run_count(), &*state(&evaluation, rig.id("b2"))), (3, "done: block 21"));
    let (mut fresh, _) = blocks(10, usize::MAX, 1);
    fresh.set("b9.tag", 5.0);
    let (first, again) = (fresh.evaluate(&["b9"]), rig.evaluate(&["b9"]));
    assert_eq!(state(&first, fresh.id("b9")), state(&again, rig.id("b9")));
    rig.evaluator.forget();
    drop((first, again, evaluation));
    fresh.evaluator.forget();
    assert_eq!(living.now.load(Ordering::SeqCst), 0);
}

#[test]
fn an_evicted_intermediate_is_not_needed_while_what_is_behind_it_is_known() {
    let (mut rig, _) = blocks(3, 2_100_000, 1);
    rig.evaluate(&["b2"]);
    // b0 was evicted; b2 and b1 are known.
    assert_eq!(rig.evaluate(&["b2"]).run_count(), 0);
    assert_eq!(rig.evaluate(&["b1"]).run_count(), 0);
    assert_eq!(rig.ran(&["b0"]), ["b0"]);
}

#[test]
fn a_budget_of_nothing_still_gives_right_results() {
    for threads in [1, 4] {
        let mut rig = Rig::with_options(&EvaluatorOptions { threads, byte_budget: 0 });
        rig.chain(50);
        rig.link("n10.sum", "n49.b");
        for _ in 0..3 {
            let evaluation = rig.evaluate(&["n49"]);
            assert_eq!((evaluation.run_count(), &*state(&evaluation, rig.id("n49"))), (50, "done: 60"));
        }
        assert_eq!(rig.evaluator.remembered_bytes(), 0);
    }
}

#[test]
fn a_block_handed_on_unchanged_is_not_copied() {
    let (mut rig, living) = blocks(1, usize::MAX, 1);
    rig.register(kind("pass", |node| {
        let block = node.input::<Block>("block", "Any block.");
        let out = node.output::<f64>("size", "Its size.");
        node.evaluate(move |ports| {
            let size = maquette_graph::Wire::byte_size(ports.read(block));
            ports.write(out, size as f64);
            Ok(())
        });
    }));
    for i in 0..10 {
        rig.add("pass", &format!("p{i}"));
        rig.link("b0.block", &format!("p{i}.block"));
    }
    let names: Vec<_> = (0..10).map(|i| format!("p{i}")).collect();
    let evaluation = rig.evaluate(&names.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!((evaluation.run_count(), evaluation.hit_count()), (2, 9));
    assert_eq!(living.most.load(Ordering::SeqCst), 1);
}

#[test]
fn a_cancelled_evaluation_gives_back_what_was_half_done() {
    for threads in [1, 2] {
        let (mut rig, living) = blocks(4, usize::MAX, threads);
        let cancel = maquette_graph::CancelToken::new();
        let (token, of_stopped) = (cancel.clone(), living.clone());
        rig.register(kind("stopped-block", |node| {
            let block = node.input::<Block>("block", "The block before.");
            let out = node.output::<Block>("block", "Another block, and one that is thrown away.");
            node.evaluate(move |ports| {
                let tag = Block::new(7.0, &of_stopped);
                let _ = ports.read(block);
                ports.write(out, tag);
                token.cancel();
                ports.progress(0.5)
            });
        }));
        rig.add("stopped-block", "stopped");
        rig.link("b3.block", "stopped.block");
        let stopped = rig.id("stopped");
        let evaluation = rig.request(maquette_graph::Request::nodes(&[stopped]).cancel(&cancel));
        assert!(evaluation.cancelled);
        drop(evaluation);
        assert_eq!(living.now.load(Ordering::SeqCst), 4, "what was finished is remembered, the half done is gone");
        rig.evaluator.forget();
        assert_eq!(living.now.load(Ordering::SeqCst), 0);
    }
}
