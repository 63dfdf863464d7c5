//! A failing node stops what depends on it, and nothing else.

mod kinds;

use kinds::{Rig, kind, state};
use maquette_graph::Literal;

#[test]
fn an_error_carries_its_port_and_dependents_wait_by_name() {
    let mut rig = Rig::default();
    rig.add("root", "root");
    rig.set("root.number", -4.0);
    rig.chain(3);
    rig.link("root.root", "n0.a");
    rig.add("add", "aside");
    rig.add("add", "joint");
    rig.link("aside.sum", "joint.a");
    rig.link("n2.sum", "joint.b");
    let evaluation = rig.evaluate(&["joint", "aside"]);
    assert_eq!(state(&evaluation, rig.id("root")), "failed: input \"number\": -4 has no real root: give 0 or more");
    for name in ["n0", "n1", "n2", "joint"] {
        assert_eq!(state(&evaluation, rig.id(name)), "waiting on root", "{name}");
    }
    assert_eq!(state(&evaluation, rig.id("aside")), "done: 0");
    assert!(!evaluation.is_complete());
    assert_eq!(
        rig.log,
        [
            "planned 6",
            "started aside",
            "finished aside",
            "started root",
            "failed root: input \"number\": -4 has no real root: give 0 or more",
            "waiting n0 on root",
            "waiting n1 on root",
            "waiting n2 on root",
            "waiting joint on root",
        ]
    );
    rig.set("root.number", 4.0);
    let evaluation = rig.evaluate(&["joint", "aside"]);
    assert_eq!(state(&evaluation, rig.id("joint")), "done: 5");
    assert_eq!(evaluation.run_count(), 5, "all but the one aside");
}

#[test]
fn a_failure_is_remembered() {
    let mut rig = Rig::default();
    rig.add("root", "root");
    rig.add("add", "sum");
    rig.link("root.root", "sum.a");
    rig.set("root.number", -4.0);
    rig.evaluate(&["sum"]);
    let failed = "failed root: input \"number\": -4 has no real root: give 0 or more";
    assert_eq!(rig.log, ["planned 2", "started root", failed, "waiting sum on root"]);
    let evaluation = rig.evaluate(&["sum"]);
    assert_eq!(rig.log, [failed, "waiting sum on root", "planned 0"]);
    assert_eq!((evaluation.run_count(), evaluation.hit_count()), (0, 0));
    rig.set("root.number", -5.0);
    rig.evaluate(&["sum"]);
    rig.set("root.number", -4.0);
    rig.evaluate(&["sum"]);
    assert_eq!(rig.log, [failed, "waiting sum on root", "planned 0"]);
}

#[test]
fn two_failures_are_both_named_once_each_in_the_order_of_the_inputs() {
    let mut rig = Rig::default();
    for name in ["zeta", "alpha"] {
        rig.add("root", name);
    }
    rig.set("zeta.number", -1.0);
    rig.set("alpha.number", -2.0);
    rig.add("add", "both");
    rig.link("zeta.root", "both.a");
    rig.link("alpha.root", "both.b");
    rig.add("add", "again");
    rig.link("both.sum", "again.a");
    rig.link("alpha.root", "again.b");
    for _ in 0..2 {
        let evaluation = rig.evaluate(&["again"]);
        assert_eq!(state(&evaluation, rig.id("both")), "waiting on zeta, alpha");
        assert_eq!(state(&evaluation, rig.id("again")), "waiting on zeta, alpha");
    }
}

#[test]
fn a_panicking_node_is_reported_and_stops_no_other() {
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {}));
    for threads in [1, 2] {
        let mut rig = Rig::with_threads(threads);
        rig.add("panics", "bad");
        rig.add("add", "behind");
        rig.link("bad.number", "behind.a");
        rig.add("add", "good");
        for _ in 0..2 {
            let evaluation = rig.evaluate(&["behind", "good"]);
            assert_eq!(
                state(&evaluation, rig.id("bad")),
                "failed: the node kind \"panics\" broke down (index 0 is wrong); \
                 this is a mistake in the kind, please report it"
            );
            assert_eq!(state(&evaluation, rig.id("behind")), "waiting on bad");
            assert_eq!(state(&evaluation, rig.id("good")), "done: 0");
        }
        rig.set("bad.number", 2.0);
        assert_eq!(rig.number("behind.sum"), Some(1.0));
    }
    std::panic::set_hook(hook);
}

#[test]
fn a_missing_input_says_what_to_link() {
    let mut rig = Rig::default();
    rig.add("measure", "measure");
    rig.add("add", "sum");
    rig.link("measure.total", "sum.a");
    let evaluation = rig.evaluate(&["sum"]);
    let message = "input \"samples\": nothing is connected: link an output that gives samples";
    assert_eq!(state(&evaluation, rig.id("measure")), format!("failed: {message}"));
    assert_eq!(state(&evaluation, rig.id("sum")), "waiting on measure");
    assert_eq!(rig.log, [format!("failed measure: {message}"), "waiting sum on measure".into(), "planned 0".into()]);
    assert_eq!(evaluation.run_count(), 0, "it never ran");
}

#[test]
fn a_value_out_of_range_is_refused_where_it_enters() {
    let mut rig = Rig::default();
    rig.add("add", "number");
    rig.add("everything", "all");
    rig.link("number.sum", "all.length");
    rig.set("number.a", 2.0);
    assert_eq!(state(&rig.evaluate(&["all"]), rig.id("all")), "done: 0.5, 0");
    rig.set("number.a", 12.0);
    for _ in 0..2 {
        let evaluation = rig.evaluate(&["all"]);
        assert_eq!(
            state(&evaluation, rig.id("all")),
            "failed: input \"length\": 12 m is out of range: give 0.001 to 10 m"
        );
    }
    rig.set("number.a", 3.0);
    assert_eq!(rig.number("all.number"), Some(0.5));
}

#[test]
fn nan_from_a_node_is_stopped_at_the_next_range() {
    let mut rig = Rig::default();
    rig.register(kind("broken", |node| {
        let out = node.output::<f64>("number", "Not a number.");
        node.evaluate(move |ports| {
            ports.write(out, f64::NAN);
            Ok(())
        });
    }));
    rig.add("broken", "broken");
    rig.add("add", "sum");
    rig.link("broken.number", "sum.a");
    assert_eq!(
        state(&rig.evaluate(&["sum"]), rig.id("sum")),
        "failed: input \"a\": NaN is out of range: give -1000000000 to 1000000000"
    );
}

#[test]
fn optional_inputs_may_stay_free_and_count_when_linked() {
    let mut rig = Rig::default();
    rig.add("samples", "list");
    rig.add("measure", "measure");
    rig.add("add", "zero");
    rig.link("list.samples", "measure.samples");
    assert_eq!(rig.number("measure.total"), Some(3.0));
    rig.link("zero.sum", "measure.offset");
    assert_eq!(rig.ran(&["measure"]), ["zero", "measure"], "an offset of 0 is not the same as none");
    rig.set("zero.a", 10.0);
    assert_eq!(rig.number("measure.total"), Some(13.0));
    rig.put("measure.offset", Literal::Number(1.0));
    assert_eq!(rig.number("measure.total"), Some(4.0));
}

#[test]
fn outputs_that_were_not_written_are_named() {
    let mut rig = Rig::default();
    rig.add("forgetful", "node");
    assert_eq!(
        state(&rig.evaluate(&["node"]), rig.id("node")),
        "failed: the node kind \"forgetful\" did not write its output second, third; this is a mistake in the kind"
    );
    rig.add("idle", "idle");
    assert_eq!(
        state(&rig.evaluate(&["idle"]), rig.id("idle")),
        "failed: the node kind \"idle\" does not say what it does"
    );
}

#[test]
fn a_result_of_another_type_than_declared_is_a_failure_not_a_crash() {
    let mut rig = Rig::default();
    rig.register(kind("liar", |node| {
        let out = node.output::<f64>("number", "A number, it says.");
        node.evaluate(move |ports| {
            ports.write_value(out, maquette_graph::Value::new(true));
            Ok(())
        });
    }));
    rig.add("liar", "liar");
    rig.add("add", "sum");
    rig.link("liar.number", "sum.a");
    let evaluation = rig.evaluate(&["sum"]);
    assert_eq!(
        state(&evaluation, rig.id("liar")),
        "failed: the node kind \"liar\" wrote boolean to its output \"number\", which is declared as number; \
         this is a mistake in the kind"
    );
    assert_eq!(state(&evaluation, rig.id("sum")), "waiting on liar");
}

#[test]
fn many_failures_before_one_node_are_listed_without_crawling() {
    let mut rig = Rig::default();
    rig.chain(1_000);
    for i in 0..1_000 {
        rig.add("root", &format!("root{i}"));
        rig.set(&format!("root{i}.number"), -1.0 - f64::from(i));
        rig.link(&format!("root{i}.root"), &format!("n{i}.b"));
    }
    let begun = std::time::Instant::now();
    let evaluation = rig.evaluate(&["n999"]);
    assert_eq!(evaluation.failures().count(), 1_000);
    assert!(state(&evaluation, rig.id("n999")).ends_with("root998, root999"));
    assert!(begun.elapsed().as_secs_f64() < 10.0, "{:?}", begun.elapsed());
}

#[test]
fn everyone_to_blame_is_named_whenever_it_fails_and_whatever_is_remembered() {
    for threads in [1, 2] {
        let mut rig = Rig::with_threads(threads);
        // Known before anything runs.
        rig.add("measure", "unconnected");
        // Fails when it runs, behind another node.
        rig.add("add", "minus");
        rig.set("minus.a", -4.0);
        rig.add("root", "root");
        rig.link("minus.sum", "root.number");
        // Refused where its value enters; and one that is fine.
        rig.add("everything", "refused");
        rig.link("minus.sum", "refused.length");
        rig.add("add", "fine");
        // The sources of each, in the order of its inputs.
        for (name, a, b) in [
            ("early", "unconnected.total", "root.root"),
            ("late", "refused.number", "early.sum"),
            ("last", "fine.sum", "late.sum"),
            ("other", "root.root", "unconnected.total"),
        ] {
            rig.add("add", name);
            rig.link(a, &format!("{name}.a"));
            rig.link(b, &format!("{name}.b"));
        }
        for turn in ["first", "second", "undone"] {
            let evaluation = rig.evaluate(&["last", "other"]);
            let waits = ["early", "late", "last", "other"].map(|name| state(&evaluation, rig.id(name)));
            assert_eq!(
                waits,
                [
                    "waiting on unconnected, root",
                    "waiting on refused, unconnected, root",
                    "waiting on refused, unconnected, root",
                    "waiting on root, unconnected"
                ],
                "{turn}, {threads} threads"
            );
            for name in ["early", "late", "last", "other"] {
                let lines = rig.log.iter().filter(|line| line.contains(&format!("waiting {name} "))).count();
                assert_eq!(lines, 1, "{name} {turn}");
            }
            if turn == "second" {
                rig.evaluator.forget();
            }
        }
        // Whoever recovers is no longer named.
        rig.set("minus.a", 4.0);
        assert_eq!(state(&rig.evaluate(&["other"]), rig.id("other")), "waiting on unconnected");
    }
}
