//! Graphs within nodes: what they give, what re-runs, what is shared.

#![allow(clippy::unwrap_used, clippy::panic, clippy::disallowed_methods, reason = "a test that panics fails")]

mod kinds;

use kinds::{Rig, Samples, state};
use maquette_graph::{Edit, EventLog, Literal, NodeId, OutcomeState, Request, file};

/// (a + twice) + b, in two nodes.
const SUM: &str = r#"(
    parameters: {
        "a": (value: 0.0, range: (-100.0, 100.0), description: "One term."),
        "b": (value: 1.0),
    },
    nodes: {
        "first": (kind: "add", inputs: { "a": Parameter("a"), "b": Parameter("a") }),
        "second": (kind: "add", inputs: { "a": Link("first.sum"), "b": Parameter("b") }),
    },
    outputs: { "sum": (from: "second.sum", description: "2 a + b.") },
)"#;

fn load(threads: usize, text: &str) -> Rig {
    let mut rig = Rig::with_threads(threads);
    rig.catalogue
        .list::<Samples, f64>(|list| list.0.clone(), |items| Ok(Samples(items.iter().map(|n| **n).collect())))
        .unwrap();
    let loaded = file::from_text(&rig.catalogue, text).unwrap();
    assert_eq!(loaded.problems, []);
    rig.graph = loaded.graph;
    rig
}

fn two(threads: usize) -> Rig {
    load(
        threads,
        &format!(
            r#"(version: 1, nodes: {{
    "left": (kind: "graph", inputs: {{ "a": 2.0 }}, body: {SUM}),
    "right": (kind: "graph", inputs: {{ "a": 2.0 }}, body: {SUM}),
    "both": (kind: "add", inputs: {{ "a": Link("left.sum"), "b": Link("right.sum") }}),
}})"#
        ),
    )
}

/// The log without progress, sorted, for any number of threads.
fn ran(rig: &mut Rig, targets: &[&str]) -> Vec<String> {
    let mut ran = rig.ran(targets);
    ran.sort();
    ran
}

#[test]
fn a_graph_within_a_node_gives_its_outputs() {
    for threads in [1, 8] {
        let mut rig = two(threads);
        assert_eq!(rig.number("both.sum"), Some(10.0));
    }
}

#[test]
fn instances_that_are_alike_run_once_and_a_change_in_one_re_runs_only_that() {
    for threads in [1, 8] {
        let mut rig = two(threads);
        // Which of the two runs is settled: the second waits for the first.
        assert_eq!(ran(&mut rig, &["both"]), ["both", "left", "left/first", "left/second"], "{threads} threads");
        assert_eq!(ran(&mut rig, &["both"]), [""; 0]);
        rig.set("right.b", 5.0);
        // Its first node has the result of the other instance's.
        assert_eq!(ran(&mut rig, &["both"]), ["both", "right", "right/second"]);
        assert!(rig.log.contains(&"hit right/first".to_owned()), "{:?}", rig.log);
        // A change within, too.
        let (right, first) = (rig.id("right"), 0);
        let inner = rig.graph.node(right).unwrap().body().unwrap().graph().unwrap();
        let first = inner.nodes().nth(first).unwrap().0;
        let edit = Edit::Within { node: right, edit: Edit::set(first, "b", Literal::Number(7.0)).into() };
        let back = rig.graph.apply(&rig.catalogue, &edit).unwrap();
        assert_eq!(ran(&mut rig, &["both"]), ["both", "right", "right/first", "right/second"]);
        assert_eq!(rig.number("right.sum"), Some(2.0 + 7.0 + 5.0));
        rig.graph.apply(&rig.catalogue, &back).unwrap();
        assert_eq!(ran(&mut rig, &["both"]), [""; 0]);
        assert_eq!(rig.number("right.sum"), Some(9.0));
    }
}

#[test]
fn a_note_or_a_place_within_re_runs_nothing() {
    let mut rig = two(1);
    rig.evaluate(&["both"]);
    let left = rig.id("left");
    let inner = rig.graph.node(left).unwrap().body().unwrap().graph().unwrap().nodes().next().unwrap().0;
    for edit in [
        Edit::Move { node: inner, position: Some([1.0, 2.0]) },
        Edit::Note { node: inner, note: "why".to_owned() },
        Edit::GraphNotes("what".to_owned()),
        Edit::add("root", "no output depends on it"),
    ] {
        rig.graph.apply(&rig.catalogue, &Edit::Within { node: left, edit: edit.into() }).unwrap();
        assert_eq!(rig.ran(&["both"]), [""; 0]);
    }
    // A name is part of what is said of a node, so it counts; the nodes within are the same.
    let edit = Edit::Rename { node: inner, name: "other".to_owned() };
    rig.graph.apply(&rig.catalogue, &Edit::Within { node: left, edit: edit.into() }).unwrap();
    assert_eq!(rig.ran(&["both"]), ["left"]);
}

#[test]
fn events_count_what_is_planned() {
    let mut rig = two(1);
    rig.evaluate(&["both"]);
    assert_eq!(
        rig.log,
        [
            "planned 3",
            "started left",
            "planned 5",
            "started left/first",
            "finished left/first",
            "started left/second",
            "finished left/second",
            "finished left",
            "hit right",
            "started both",
            "finished both",
        ]
    );
}

#[test]
fn what_fails_within_is_named() {
    for threads in [1, 8] {
        let text = r#"(version: 1, nodes: {
    "outer": (kind: "graph", inputs: { "n": -1.0 }, body: (
        parameters: { "n": (value: 4.0) },
        nodes: { "middle": (kind: "graph", inputs: { "n": Parameter("n") }, body: (
            parameters: { "n": (value: 4.0) },
            nodes: { "r": (kind: "root", inputs: { "number": Parameter("n") }) },
            outputs: { "root": (from: "r.root") },
        )) },
        outputs: { "root": (from: "middle.root") },
    )),
    "behind": (kind: "add", inputs: { "a": Link("outer.root") }),
})"#;
        let mut rig = load(threads, text);
        let evaluation = rig.evaluate(&["behind"]);
        let said = r#"failed: input "n": inside "middle", input "n", inside "r", input "number": -1 has no real root: give 0 or more"#;
        assert_eq!(state(&evaluation, rig.id("outer")), said);
        assert_eq!(state(&evaluation, rig.id("behind")), "waiting on outer");
        let message = rig.log.iter().find(|line| line.starts_with("failed outer/middle/r")).unwrap();
        assert!(message.ends_with("-1 has no real root: give 0 or more"), "{message}");
        rig.set("outer.n", 9.0);
        assert_eq!(rig.number("behind.sum"), Some(3.0));
    }
}

#[test]
fn what_is_said_within_is_said_by_the_node() {
    let text = r#"(version: 1, nodes: {
    "outer": (kind: "graph", body: (
        nodes: {
            "s": (kind: "samples", inputs: { "count": 4 }),
            "m": (kind: "measure", inputs: { "samples": Link("s.samples") }),
        },
        outputs: { "total": (from: "m.total") },
    )),
})"#;
    let mut rig = load(1, text);
    for _ in 0..2 {
        let evaluation = rig.evaluate(&["outer"]);
        let Some(OutcomeState::Done { report, .. }) = evaluation.outcome(rig.id("outer")).map(|o| &o.state) else {
            panic!("it did not run");
        };
        assert_eq!(report.notes, ["m: no offset"]);
        assert_eq!((report.figures[0].name.as_str(), report.figures[0].value), ("m/samples", 6.0));
    }
}

#[test]
fn the_value_of_a_parameter_touches_what_uses_it() {
    let text = r#"(version: 1,
    parameters: { "x": (value: 2, description: "A whole number that drives numbers too."), "free": (type: "number", optional: true) },
    nodes: {
        "a": (kind: "add", inputs: { "a": Parameter("x"), "b": 1.0 }),
        "b": (kind: "add", inputs: { "a": Link("a.sum"), "b": Parameter("x") }),
        "c": (kind: "add", inputs: { "b": 3.0, "a": Parameter("free") }),
        "d": (kind: "add", inputs: { "a": Link("b.sum"), "b": Link("c.sum") }),
    })"#;
    let mut rig = load(1, text);
    assert_eq!(rig.number("d.sum"), Some(8.0));
    rig.graph.set_parameter("x", Literal::Integer(5)).unwrap();
    assert_eq!(rig.ran(&["d"]), ["a", "b", "d"]);
    assert_eq!(rig.number("d.sum"), Some(14.0));
    rig.graph.set_parameter("x", Literal::Integer(2)).unwrap();
    assert_eq!(rig.ran(&["d"]), [""; 0]);
    // A range of the parameter, and one of the input.
    assert!(rig.graph.set_parameter("x", Literal::Number(0.5)).is_err());
    let error = rig.graph.set_parameter("y", Literal::Integer(2)).unwrap_err().to_string();
    assert_eq!(error, "the graph has no parameter \"y\"");
    rig.graph.set_parameter("x", Literal::Integer(2_000_000_000)).unwrap();
    let evaluation = rig.evaluate(&["d"]);
    assert_eq!(
        state(&evaluation, rig.id("a")),
        "failed: input \"a\": 2000000000 is out of range: give -1000000000 to 1000000000"
    );
}

#[test]
fn a_file_read_within_is_read_again_when_it_changes() {
    for threads in [1, 8] {
        let folder = tempfile::tempdir().unwrap();
        let put = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
        put("a.txt", "one");
        let text = r#"(version: 1, nodes: {
    "outer": (kind: "graph", body: (
        nodes: { "f": (kind: "read-file", inputs: { "file": File("a.txt") }) },
        outputs: { "text": (from: "f.text") },
    )),
    "same": (kind: "graph", body: (
        nodes: { "f": (kind: "read-file", inputs: { "file": File("a.txt") }) },
        outputs: { "text": (from: "f.text") },
    )),
    "count": (kind: "count", inputs: { "text": Link("outer.text") }),
})"#;
        let mut rig = load(threads, text);
        let ids = [rig.id("count"), rig.id("same")];
        let read = |rig: &mut Rig| {
            let evaluation = rig.request(Request::nodes(&ids).base(folder.path()));
            let mut ran: Vec<_> = rig.log.iter().filter_map(|line| line.strip_prefix("finished ")).collect();
            ran.sort();
            let text = evaluation.value::<String>(ids[0], "text").cloned();
            (text.unwrap_or_default(), ran.join(" "))
        };
        assert_eq!(read(&mut rig), ("one".to_owned(), "count outer outer/f".to_owned()));
        assert_eq!(read(&mut rig), ("one".to_owned(), String::new()));
        put("a.txt", "two");
        assert_eq!(read(&mut rig), ("two".to_owned(), "count outer outer/f".to_owned()));
        put("a.txt", "one");
        // The file is as it was; what was read in it is remembered, but which files a body reads only for the last time.
        assert_eq!(read(&mut rig), ("one".to_owned(), "outer".to_owned()));
        std::fs::remove_file(folder.path().join("a.txt")).unwrap();
        let evaluation = rig.request(Request::nodes(&ids).base(folder.path()));
        assert!(state(&evaluation, rig.id("outer")).contains("inside \"f\", input \"file\": the file"));
        put("a.txt", "one");
        assert_eq!(read(&mut rig).0, "one");
    }
}

#[test]
fn nodes_within_are_evaluated_with_what_they_are_given_there() {
    for threads in [1, 8] {
        let mut rig = load(
            threads,
            &format!(
                r#"(version: 1, nodes: {{
    "one": (kind: "add", inputs: {{ "a": 0.5, "b": 0.5 }}),
    "outer": (kind: "graph", inputs: {{ "x": Link("one.sum") }}, body: (
        parameters: {{ "x": (value: 0.0) }},
        nodes: {{
            "more": (kind: "add", inputs: {{ "a": Parameter("x"), "b": 10.0 }}),
            "inner": (kind: "graph", inputs: {{ "a": Link("more.sum"), "b": 3.0 }}, body: {SUM}),
        }},
        outputs: {{ "sum": (from: "inner.sum") }},
    )),
}})"#
            ),
        );
        let outer = rig.id("outer");
        let middle = rig.graph.node(outer).unwrap().body().unwrap().graph().unwrap();
        let inner = middle.find("inner").unwrap();
        let innermost = middle.node(inner).unwrap().body().unwrap().graph().unwrap();
        let [more, first, second] =
            [middle.find("more"), innermost.find("first"), innermost.find("second")].map(|id| id.unwrap());
        let (catalogue, graph) = (&rig.catalogue, &rig.graph);
        let mut within = |path: &[NodeId], node| {
            let log = EventLog::default();
            let request = Request::nodes(&[node]).events(&log);
            let evaluation = rig.evaluator.evaluate_within(catalogue, graph, path, &request)?;
            let mut ran: Vec<String> =
                log.take().into_iter().filter_map(|line| line.strip_prefix("finished ").map(str::to_owned)).collect();
            ran.sort();
            Some((evaluation.value::<f64>(node, "sum").copied().unwrap(), ran))
        };
        assert_eq!(within(&[outer], more), Some((11.0, vec!["one".to_owned(), "outer/more".to_owned()])));
        assert_eq!(within(&[outer, inner], first).unwrap(), (22.0, vec!["outer/inner/first".to_owned()]));
        // What was evaluated there is remembered, for those within and for the whole.
        assert_eq!(within(&[outer, inner], second).unwrap(), (25.0, vec!["outer/inner/second".to_owned()]));
        assert_eq!(within(&[outer, inner], second).unwrap().1, [""; 0]);
        assert_eq!(within(&[more], first), None, "it has no body");
        assert_eq!(within(&[outer, more], first), None, "nor has this one");
        assert_eq!(rig.number("outer.sum"), Some(25.0));
        assert_eq!(ran(&mut rig, &["outer"]), [""; 0], "looking within disturbs nothing");
    }
}

#[test]
fn what_fails_before_a_node_keeps_one_from_looking_within() {
    let mut rig = load(
        1,
        &format!(
            r#"(version: 1, nodes: {{
    "bad": (kind: "root", inputs: {{ "number": -1.0 }}),
    "sum": (kind: "graph", inputs: {{ "a": Link("bad.root") }}, body: {SUM}),
}})"#
        ),
    );
    let sum = rig.id("sum");
    let first = rig.graph.node(sum).unwrap().body().unwrap().graph().unwrap().find("first").unwrap();
    let (catalogue, graph) = (&rig.catalogue, &rig.graph);
    let evaluation = rig.evaluator.evaluate_within(catalogue, graph, &[sum], &Request::nodes(&[first]));
    assert!(evaluation.is_none());
}
