//! What runs again after an edit, and what does not: event logs compared as text.

#![allow(clippy::unwrap_used, reason = "in tests a failing unwrap is a failing test")]

mod kinds;

use kinds::{Rig, state};
use maquette_graph::{Evaluator, Literal, Request};

const NOTHING: [&str; 0] = [];

#[test]
fn the_log_tells_the_whole_story_in_order() {
    let mut rig = Rig::default();
    rig.chain(3);
    rig.evaluate(&["n2"]);
    assert_eq!(
        rig.log,
        ["planned 3", "started n0", "finished n0", "started n1", "finished n1", "started n2", "finished n2",]
    );
    rig.evaluate(&["n2"]);
    assert_eq!(rig.log, ["hit n2", "planned 0"]);
}

#[test]
fn only_what_is_needed_runs() {
    let mut rig = Rig::default();
    rig.chain(4);
    rig.add("add", "aside");
    rig.link("n0.sum", "aside.a");
    rig.add("panics", "alone");
    assert_eq!(rig.ran(&["n1"]), ["n0", "n1"]);
    assert_eq!(rig.ran(&["aside", "n2"]), ["aside", "n2"]);
    let evaluation = rig.evaluate(&["n3"]);
    assert_eq!(state(&evaluation, rig.id("alone")), "not looked at");
    assert_eq!(state(&evaluation, rig.id("n3")), "done: 4");
}

#[test]
fn a_change_runs_the_node_and_its_dependents_again() {
    let mut rig = Rig::default();
    rig.chain(4);
    rig.add("add", "aside");
    rig.link("n0.sum", "aside.a");
    rig.evaluate(&["n3", "aside"]);
    rig.set("n1.b", 10.0);
    assert_eq!(rig.ran(&["n3", "aside"]), ["n1", "n2", "n3"]);
    assert_eq!(rig.number("n3.sum"), Some(13.0));
    rig.set("n3.b", 0.0);
    assert_eq!(rig.ran(&["n3", "aside"]), ["n3"]);
}

#[test]
fn an_equal_result_ends_the_wave() {
    let mut rig = Rig::default();
    rig.add("add", "number");
    rig.add("sign", "sign");
    rig.add("spell", "spell");
    rig.link("number.sum", "sign.number");
    rig.link("sign.positive", "spell.flag");
    rig.set("number.a", 1.0);
    rig.evaluate(&["spell"]);
    rig.set("number.a", 2.0);
    rig.evaluate(&["spell"]);
    assert_eq!(
        rig.log,
        ["planned 3", "started number", "finished number", "started sign", "finished sign", "hit spell"]
    );
    rig.set("number.a", -2.0);
    assert_eq!(rig.ran(&["spell"]), ["number", "sign", "spell"]);
}

#[test]
fn undo_and_redo_are_hits() {
    let mut rig = Rig::default();
    rig.chain(3);
    rig.evaluate(&["n2"]);
    rig.set("n0.a", 5.0);
    rig.evaluate(&["n2"]);
    rig.set("n0.a", 0.0);
    rig.evaluate(&["n2"]);
    assert_eq!(rig.log, ["hit n0", "hit n1", "hit n2", "planned 0"]);
    rig.set("n0.a", 5.0);
    rig.evaluate(&["n2"]);
    assert_eq!(rig.log, ["hit n0", "hit n1", "hit n2", "planned 0"]);
    assert_eq!(rig.number("n2.sum"), Some(8.0));
    // The default written out is the default.
    rig.graph.reset(rig.id("n0"), "a").unwrap();
    assert_eq!(rig.ran(&["n2"]), NOTHING);
    assert_eq!(rig.number("n2.sum"), Some(3.0));
}

#[test]
fn relinking_and_linking_back_are_hits() {
    let mut rig = Rig::default();
    rig.chain(3);
    rig.evaluate(&["n2"]);
    rig.link("n0.sum", "n2.a");
    // It adds 1 to 1, which n1 did already.
    assert_eq!(rig.ran(&["n2"]), NOTHING);
    assert_eq!(rig.number("n2.sum"), Some(2.0));
    rig.link("n1.sum", "n2.a");
    assert_eq!(rig.ran(&["n2"]), NOTHING);
    assert_eq!(rig.number("n2.sum"), Some(3.0));
    rig.graph.remove(rig.id("n1")).unwrap();
    assert_eq!(rig.number("n2.sum"), Some(1.0));
}

#[test]
fn names_places_and_notes_run_nothing() {
    let mut rig = Rig::default();
    rig.chain(3);
    rig.evaluate(&["n2"]);
    rig.graph.rename(rig.id("n1"), "middle").unwrap();
    rig.graph.set_position(rig.id("n0"), Some([1.0, 2.0])).unwrap();
    rig.graph.set_note(rig.id("n2"), "the last").unwrap();
    rig.graph.notes = "a chain".to_owned();
    rig.evaluate(&["n2"]);
    assert_eq!(rig.log, ["hit n2", "planned 0"]);
}

#[test]
fn unrelated_edits_run_nothing() {
    let mut rig = Rig::default();
    rig.chain(3);
    rig.evaluate(&["n2"]);
    rig.add("samples", "list");
    rig.add("measure", "measure");
    rig.link("list.samples", "measure.samples");
    rig.put("list.count", Literal::Integer(5));
    rig.evaluate(&["n2"]);
    assert_eq!(rig.log, ["hit n2", "planned 0"]);
    rig.graph.remove(rig.id("list")).unwrap();
    rig.evaluate(&["n2"]);
    assert_eq!(rig.log, ["hit n2", "planned 0"]);
}

#[test]
fn equal_nodes_share_one_run() {
    let mut rig = Rig::default();
    for name in ["first", "second", "third"] {
        rig.add("add", name);
        rig.set(&format!("{name}.a"), 4.0);
    }
    rig.set("third.a", 5.0);
    let evaluation = rig.evaluate(&["first", "second", "third"]);
    assert_eq!(
        rig.log,
        ["planned 3", "started first", "finished first", "hit second", "started third", "finished third"]
    );
    assert_eq!((evaluation.run_count(), evaluation.hit_count()), (2, 1));
    assert!(evaluation.is_complete());
    assert_eq!(evaluation.value::<f64>(rig.id("second"), "sum"), Some(&4.0));
}

#[test]
fn kinds_versions_and_ports_are_not_confused() {
    let mut rig = Rig::default();
    // The same content at another port is something else.
    rig.add("add", "left");
    rig.add("add", "right");
    rig.set("left.a", 1.0);
    rig.set("right.b", 1.0);
    assert_eq!(rig.ran(&["left", "right"]), ["left", "right"]);

    let double = |version, factor: f64| {
        let mut node = maquette_graph::NodeKind::declare("scale", version, "test", "Scales.");
        let number = node.number("number", 1.0, 0.0..=10.0, "What to scale.");
        let out = node.output::<f64>("number", "Scaled.");
        node.evaluate(move |ports| {
            ports.write(out, factor * ports.value(number));
            Ok(())
        });
        node
    };
    let value_of = |evaluator: &mut Evaluator, kind| {
        let mut catalogue = kinds::catalogue();
        catalogue.register(kind).unwrap();
        let mut graph = maquette_graph::Graph::new();
        let id = graph.add(&catalogue, "scale", "scale").unwrap();
        *evaluator.evaluate(&catalogue, &graph, &Request::nodes(&[id])).value::<f64>(id, "number").unwrap()
    };
    let mut evaluator = Evaluator::default();
    assert_eq!(value_of(&mut evaluator, double(1, 2.0)), 2.0);
    assert_eq!(value_of(&mut evaluator, double(1, 3.0)), 2.0, "the same version promises the same result");
    assert_eq!(value_of(&mut evaluator, double(2, 3.0)), 3.0);
}

#[test]
fn a_clone_of_the_graph_hits_and_goes_its_own_way() {
    let mut rig = Rig::default();
    rig.chain(3);
    rig.evaluate(&["n2"]);
    let original = rig.graph.clone();
    let n2 = rig.id("n2");
    rig.set("n2.b", 7.0);
    assert_eq!(rig.ran(&["n2"]), ["n2"]);
    let evaluation = rig.evaluator.evaluate(&rig.catalogue, &original, &Request::nodes(&[n2]));
    assert_eq!((evaluation.run_count(), evaluation.value::<f64>(n2, "sum")), (0, Some(&3.0)));
    let evaluation = rig.evaluate(&["n2"]);
    assert_eq!((evaluation.run_count(), evaluation.value::<f64>(n2, "sum")), (0, Some(&9.0)));
}

#[test]
fn forgetting_runs_all_again() {
    let mut rig = Rig::default();
    rig.chain(2);
    rig.evaluate(&["n1"]);
    assert!(rig.evaluator.remembered_bytes() > 0);
    rig.evaluator.forget();
    assert_eq!(rig.evaluator.remembered_bytes(), 0);
    assert_eq!(rig.ran(&["n1"]), ["n0", "n1"]);
}

#[test]
fn diamonds_run_each_node_once() {
    let mut rig = Rig::default();
    // Every node takes the one before it twice: 2^29 paths, 30 nodes.
    rig.chain(30);
    for i in 1..30 {
        rig.link(&format!("n{}.sum", i - 1), &format!("n{i}.b"));
    }
    assert_eq!(rig.ran(&["n29"]).len(), 30);
    assert_eq!(rig.number("n29.sum"), Some(f64::from(1 << 29)));
}

#[test]
fn targets_may_repeat_be_none_or_be_gone() {
    let mut rig = Rig::default();
    rig.chain(2);
    let (n0, n1) = (rig.id("n0"), rig.id("n1"));
    let evaluation = rig.evaluate(&["n1", "n1"]);
    assert_eq!((evaluation.run_count(), evaluation.outcomes().len()), (2, 2));
    let evaluation = rig.request(Request::nodes(&[]));
    assert_eq!((evaluation.outcomes().len(), evaluation.is_complete()), (0, true));
    assert_eq!(rig.log, NOTHING);
    rig.graph.remove(n0).unwrap();
    let evaluation = rig.request(Request::nodes(&[n0, n1]));
    assert_eq!(state(&evaluation, n0), "not looked at");
    assert_eq!(state(&evaluation, n1), "done: 1");
}

#[test]
fn a_target_on_the_way_to_another_keeps_its_values() {
    let mut rig = Rig::default();
    rig.chain(3);
    for _ in 0..2 {
        let evaluation = rig.evaluate(&["n2", "n0"]);
        assert_eq!(state(&evaluation, rig.id("n0")), "done: 1");
        assert_eq!(state(&evaluation, rig.id("n2")), "done: 3");
        assert!(["done", "not looked at"].contains(&&*state(&evaluation, rig.id("n1"))), "not asked for");
    }
}

#[test]
fn progress_is_reported_between_0_and_1() {
    let mut rig = Rig::default();
    rig.register(kinds::kind("steps", |node| {
        let out = node.output::<f64>("number", "None.");
        node.evaluate(move |ports| {
            for fraction in [0.0, 0.254, 1.0, 7.0, -3.0, f64::NAN] {
                ports.progress(fraction)?;
            }
            ports.write(out, 1.0);
            Ok(())
        });
    }));
    rig.add("steps", "steps");
    rig.evaluate(&["steps"]);
    let percent = ["0%", "25%", "100%", "100%", "0%", "0%"].map(|p| format!("progress steps {p}"));
    assert_eq!(
        rig.log[1..],
        [vec!["started steps".to_owned()], percent.to_vec(), vec!["finished steps".to_owned()]].concat()
    );
}

#[test]
fn reports_are_remembered_with_the_values() {
    let mut rig = Rig::default();
    rig.add("samples", "list");
    rig.add("measure", "measure");
    rig.link("list.samples", "measure.samples");
    for run in 0..2 {
        let evaluation = rig.evaluate(&["measure"]);
        assert_eq!(evaluation.run_count(), if run == 0 { 2 } else { 0 });
        let Some(maquette_graph::OutcomeState::Done { report, .. }) =
            evaluation.outcome(rig.id("measure")).map(|o| &o.state)
        else {
            unreachable!("it has all it needs");
        };
        assert_eq!(report.notes, ["no offset"]);
        assert_eq!((&*report.figures[0].name, report.figures[0].value), ("samples", 3.0));
    }
}

#[test]
fn a_chain_of_20_000_nodes_neither_overflows_nor_crawls() {
    for threads in [1, 2] {
        let mut rig = Rig::with_threads(threads);
        rig.chain(20_000);
        let begun = std::time::Instant::now();
        let evaluation = rig.evaluate(&["n19999"]);
        assert_eq!((evaluation.run_count(), &*state(&evaluation, rig.id("n19999"))), (20_000, "done: 20000"));
        // Another fraction, or the nodes would find what their neighbours computed.
        rig.set("n0.b", 1.5);
        assert_eq!(rig.evaluate(&["n19999"]).run_count(), 20_000);
        rig.set("n19999.b", 2.0);
        assert_eq!(rig.evaluate(&["n19999"]).run_count(), 1);
        // A side branch makes it more than a chain, so that threads are used.
        rig.add("add", "aside");
        rig.link("n100.sum", "aside.a");
        rig.set("n0.b", 1.25);
        assert_eq!(rig.evaluate(&["n19999", "aside"]).run_count(), 20_001);
        // Everything waits on the one that fails.
        rig.add("root", "root");
        rig.set("root.number", -1.0);
        rig.link("root.root", "n0.a");
        let evaluation = rig.evaluate(&["n19999"]);
        assert_eq!(state(&evaluation, rig.id("n19999")), "waiting on root");
        assert!(begun.elapsed().as_secs_f64() < 20.0, "quadratic: {:?}", begun.elapsed());
    }
}
