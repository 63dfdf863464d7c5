//! Muted nodes pass on what arrives.

#![allow(clippy::unwrap_used, clippy::panic, reason = "in tests a failing unwrap is a failing test")]

mod kinds;

use kinds::{Rig, kind, state};
use maquette_graph::{Edit, file};

fn rig(nodes: &str) -> Rig {
    let mut rig = Rig::default();
    rig.register(kind("swap", |node| {
        let a = node.number("a", 1.0, -1e9..=1e9, "One.");
        let b = node.number("b", 2.0, -1e9..=1e9, "Two.");
        let (first, second) = (node.output::<f64>("first", "b."), node.output::<f64>("second", "a."));
        // Muted, it swaps nothing.
        node.passes(second, b);
        node.evaluate(move |ports| {
            ports.write(first, ports.value(b));
            ports.write(second, ports.value(a));
            Ok(())
        });
    }));
    let loaded = file::from_text(&rig.catalogue, &format!("(version: 1, nodes: {{ {nodes} }})")).unwrap();
    assert_eq!(loaded.problems, []);
    rig.graph = loaded.graph;
    assert_eq!(
        file::to_text(&file::from_text(&rig.catalogue, &file::to_text(&rig.graph)).unwrap().graph),
        file::to_text(&rig.graph)
    );
    rig
}

#[test]
fn only_what_is_passed_on_is_evaluated() {
    let mut rig = rig(r#""x": (kind: "add", inputs: { "a": 1.0, "b": 2.0 }),
    "y": (kind: "panics"),
    "sum": (kind: "add", muted: true, inputs: { "a": Link("x.sum"), "b": Link("y.number") }),
    "root": (kind: "root", inputs: { "number": Link("sum.sum") })"#);
    assert_eq!(rig.number("root.root"), Some(3_f64.sqrt()));
    assert!(!rig.log.iter().any(|line| line.contains(" y")), "{:?}", rig.log);
    assert_eq!(rig.graph.upstream(&[rig.id("sum")]), [rig.id("x"), rig.id("sum")]);
    assert_eq!(rig.number("sum.sum"), Some(3.0), "asked for itself, it gives what it passes on");
}

#[test]
fn muting_re_runs_what_is_behind_and_unmuting_nothing() {
    let mut rig = rig(r#""s": (kind: "swap", inputs: { "a": 4.0, "b": 9.0 }),
    "first": (kind: "root", inputs: { "number": Link("s.first") }),
    "second": (kind: "root", inputs: { "number": Link("s.second") })"#);
    let values = |rig: &mut Rig| (rig.number("first.root"), rig.number("second.root"));
    assert_eq!(values(&mut rig), (Some(3.0), Some(2.0)));
    let before = file::to_text(&rig.graph);
    let back = rig.graph.apply(&rig.catalogue, &Edit::Mute { node: rig.id("s"), muted: true }).unwrap();
    assert_eq!(
        file::to_text(&rig.graph),
        before.replace("kind: \"swap\",", "kind: \"swap\",\n            muted: true,")
    );
    assert_eq!(values(&mut rig), (Some(2.0), Some(3.0)));
    rig.graph.apply(&rig.catalogue, &back).unwrap();
    assert_eq!(file::to_text(&rig.graph), before);
    assert_eq!(rig.ran(&["first", "second"]), [""; 0]);
}

#[test]
fn an_output_with_nothing_to_pass_on_says_so_where_it_is_used() {
    let mut rig = rig(r#""sign": (kind: "sign", muted: true, inputs: { "number": 3.0 }),
    "count": (kind: "count", inputs: { "text": Link("sign.text") }),
    "free": (kind: "measure", muted: true),
    "add": (kind: "add", inputs: { "a": Link("free.total") })"#);
    let evaluation = rig.evaluate(&["count", "add"]);
    let said =
        "failed: input \"text\": \"sign\" is muted and has nothing to pass on at \"text\": unmute it, or link another";
    assert_eq!(state(&evaluation, rig.id("count")), said);
    // Its optional input would be passed on, and holds nothing.
    assert_eq!(
        state(&evaluation, rig.id("free")),
        "failed: input \"offset\": nothing is connected: link an output that gives number"
    );
    assert_eq!(state(&evaluation, rig.id("add")), "waiting on free");
}

#[test]
fn a_muted_result_is_no_result() {
    let rig = rig(r#""a": (kind: "everything", muted: true), "b": (kind: "everything")"#);
    assert_eq!(rig.graph.results(), [rig.id("b")]);
}

#[test]
fn bodies_are_muted_like_other_nodes() {
    let body = r#"(
        parameters: { "x": (value: 2.0) },
        nodes: { "a": (kind: "add", muted: true, inputs: { "a": Parameter("x"), "b": Parameter("x") }) },
        outputs: { "x": (from: "a.sum") },
    )"#;
    let mut rig = rig(&format!(
        r#""inner": (kind: "graph", body: {body}),
    "outer": (kind: "graph", muted: true, inputs: {{ "x": Link("inner.x") }}, body: {body})"#
    ));
    assert_eq!(rig.number("outer.x"), Some(2.0));
    rig.graph.apply(&rig.catalogue, &Edit::Mute { node: rig.id("outer"), muted: false }).unwrap();
    let inner = rig.graph.node(rig.id("outer")).unwrap().body().unwrap().graph().unwrap().find("a").unwrap();
    let unmute = Edit::Within { node: rig.id("outer"), edit: Edit::Mute { node: inner, muted: false }.into() };
    rig.graph.apply(&rig.catalogue, &unmute).unwrap();
    assert_eq!(rig.number("outer.x"), Some(4.0));
}
