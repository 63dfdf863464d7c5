//! Bodies that are evaluated many times.

#![allow(clippy::unwrap_used, clippy::panic, reason = "in tests a failing unwrap is a failing test")]

mod kinds;

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use kinds::{Rig, Samples, kind, state};
use maquette_graph::{CancelToken, Literal, NodeKind, Request, file};

fn rig(threads: usize) -> Rig {
    let mut rig = Rig::with_threads(threads);
    rig.catalogue
        .list::<Samples, f64>(|list| list.0.clone(), |items| Ok(Samples(items.iter().map(|n| **n).collect())))
        .unwrap();
    rig
}

fn load(rig: &mut Rig, nodes: &str) {
    let loaded = file::from_text(&rig.catalogue, &format!("(version: 1, nodes: {{ {nodes} }})")).unwrap();
    assert_eq!(loaded.problems, []);
    rig.graph = loaded.graph;
}

/// What is wrong with these nodes.
fn problems(nodes: &str) -> Vec<String> {
    let rig = rig(1);
    let text = format!("(version: 1, nodes: {{\n{nodes}\n}})");
    let loaded = file::from_text(&rig.catalogue, &text).unwrap();
    let again = file::from_text(&rig.catalogue, &file::to_text(&loaded.graph)).unwrap();
    assert_eq!(file::to_text(&again.graph), file::to_text(&loaded.graph), "the text is kept");
    assert_eq!(again.problems.len(), loaded.problems.len());
    loaded.problems.iter().map(ToString::to_string).collect()
}

fn samples(rig: &mut Rig, output: &str) -> Vec<f64> {
    let (node, output) = output.split_once('.').unwrap();
    let evaluation = rig.evaluate(&[node]);
    let found = evaluation.value::<Samples>(rig.id(node), output);
    found.unwrap_or_else(|| panic!("{}", state(&evaluation, rig.id(node)))).0.clone()
}

const ROOTS: &str = r#""list": (kind: "samples", inputs: { "count": 5 }),
"roots": (
    kind: "repeat",
    inputs: { "x": Link("list.samples"), "more": 1.0 },
    each: "x",
    body: (
        parameters: { "x": (type: "number"), "more": (value: 0.0), "index": (value: 0) },
        nodes: {
            "sum": (kind: "add", inputs: { "a": Parameter("x"), "b": Parameter("more") }),
            "root": (kind: "root", inputs: { "number": Link("sum.sum") }),
            "plus": (kind: "add", inputs: { "a": Link("root.root"), "b": Parameter("index") }),
        },
        outputs: { "roots": (from: "plus.sum") },
    ),
)"#;

#[test]
fn each_item_of_a_list_is_evaluated_and_the_results_are_collected() {
    for threads in [1, 8] {
        let mut rig = rig(threads);
        load(&mut rig, ROOTS);
        let expected: Vec<f64> = (0..5).map(|i| f64::from(i) + (f64::from(i) + 1.0).sqrt()).collect();
        assert_eq!(samples(&mut rig, "roots.roots"), expected, "{threads} threads");
        rig.put("list.count", Literal::Integer(6));
        let mut ran = rig.ran(&["roots"]);
        ran.sort();
        // Of the items only the new one is run.
        assert_eq!(ran, ["list", "roots", "roots/5/plus", "roots/5/root", "roots/5/sum"]);
        rig.put("list.count", Literal::Integer(0));
        assert_eq!(samples(&mut rig, "roots.roots"), [0.0; 0]);
    }
}

#[test]
fn a_failure_says_which_item() {
    for threads in [1, 8] {
        let mut rig = rig(threads);
        load(&mut rig, ROOTS);
        rig.set("roots.more", -2.5);
        let evaluation = rig.evaluate(&["roots"]);
        let said = "failed: at index 0, inside \"root\", input \"number\": -2.5 has no real root: give 0 or more";
        assert_eq!(state(&evaluation, rig.id("roots")), said, "{threads} threads");
    }
}

const POWERS: &str = r#""powers": (
    kind: "repeat",
    inputs: { "count": 5, "x": 1.0 },
    feed_back: { "x": "twice" },
    body: (
        parameters: { "x": (value: 3.0, range: (0.0, 100.0)) },
        nodes: { "double": (kind: "add", inputs: { "a": Parameter("x"), "b": Parameter("x") }) },
        outputs: { "twice": (from: "double.sum") },
    ),
)"#;

#[test]
fn a_result_is_fed_back() {
    for threads in [1, 8] {
        let mut rig = rig(threads);
        load(&mut rig, POWERS);
        assert_eq!(rig.number("powers.twice"), Some(32.0));
        // One more time runs one more time only.
        rig.put("powers.count", Literal::Integer(6));
        assert_eq!(rig.ran(&["powers"]), ["powers/5/double", "powers"]);
        rig.put("powers.count", Literal::Integer(0));
        assert_eq!(rig.number("powers.twice"), Some(1.0), "as it came");
        rig.put("powers.count", Literal::Integer(9));
        let evaluation = rig.evaluate(&["powers"]);
        let said = "failed: input \"x\": what is fed back: 128 is out of range: give 0 to 100";
        assert_eq!(state(&evaluation, rig.id("powers")), said);
    }
}

#[test]
fn without_a_list_or_feedback_count_times_are_collected() {
    for threads in [1, 8] {
        let mut rig = rig(threads);
        load(
            &mut rig,
            r#""squares": (
    kind: "repeat",
    inputs: { "count": 4 },
    body: (
        parameters: { "index": (value: 0) },
        nodes: {
            "n": (kind: "add", inputs: { "a": Parameter("index"), "b": 10.0 }),
            "same": (kind: "add", inputs: { "a": 1.0 }),
        },
        outputs: { "n": (from: "n.sum"), "same": (from: "same.sum") },
    ),
)"#,
        );
        assert_eq!(samples(&mut rig, "squares.n"), [10.0, 11.0, 12.0, 13.0]);
        assert_eq!(samples(&mut rig, "squares.same"), [1.0; 4]);
    }
}

#[test]
fn what_does_not_depend_on_the_index_runs_once() {
    for threads in [1, 8] {
        let mut rig = rig(threads);
        load(
            &mut rig,
            r#""all": (kind: "repeat", inputs: { "count": 8 }, body: (
    nodes: { "same": (kind: "add", inputs: { "a": 1.0 }) },
    outputs: { "same": (from: "same.sum") },
))"#,
        );
        let ran = rig.ran(&["all"]);
        assert_eq!(ran.iter().filter(|name| name.ends_with("/same")).count(), 1, "{ran:?}");
        assert_eq!(ran.last().map(String::as_str), Some("all"));
    }
}

#[test]
fn what_can_not_be_repeated_is_said_at_its_place() {
    let body = r#"(parameters: { "x": (value: 1.0), "text": (value: Text("")) }, nodes: {
    "c": (kind: "count", inputs: { "text": Parameter("text") }),
    "a": (kind: "add", inputs: { "a": Parameter("x") }),
}, outputs: { "text": (from: "c.text"), "sum": (from: "a.sum") })"#;
    let one = |fields: &str| problems(&format!("\"r\": (kind: \"repeat\", {fields}, body: {body})"));
    assert_eq!(
        one("note: \"\""),
        [
            "2:39: error: node \"r\": the output \"text\" gives text each time, which can't be collected: leave it out of the \
             body's outputs, or feed it back"
        ]
    );
    assert_eq!(
        one("each: \"y\""),
        ["2:40: error: node \"r\": \"each\" names the parameter \"y\", which the body does not have; it has x, text"]
    );
    assert!(one("each: \"text\"")[0].contains("\"each\" takes lists apart, and there is no list of text"));
    assert!(one("feed_back: { \"text\": \"sum\" }")[0].contains("gives number, and the parameter \"text\" takes text"));
    assert!(one("feed_back: { \"x\": \"no\" }")[0].contains("names the output \"no\", which the body does not have"));
    assert!(one("feed_back: 3")[0].contains("pairs no parameters with outputs"));
    assert_eq!(
        one("each: \"x\", feed_back: { \"x\": \"sum\" }")[0].split(": ").nth(3),
        Some("\"each\" and \"feed_back\" exclude each other; remove one of them")
    );
    assert_eq!(one("feed_back: { \"text\": \"text\" }"), [""; 0]);
    let once = problems(&format!("\"g\": (kind: \"graph\", each: \"x\", body: {body})"));
    assert!(once[0].contains("a node of kind graph has no \"each\""), "{once:?}");
    let taken = problems(r#""r": (kind: "repeat", body: (parameters: { "count": (value: 1.0) }, nodes: {}))"#);
    assert!(taken[0].contains("rename the parameter"), "{taken:?}");
}

/// Cancels when it ran so often.
fn stopper(token: &CancelToken, after: usize, runs: &Arc<AtomicUsize>) -> NodeKind {
    let (token, runs) = (token.clone(), runs.clone());
    kind("stopper", |node| {
        let number = node.number("number", 0.0, -1e9..=1e9, "Anything.");
        let out = node.output::<f64>("number", "The same.");
        node.evaluate(move |ports| {
            if runs.fetch_add(1, Ordering::SeqCst) + 1 == after {
                token.cancel();
            }
            ports.write(out, ports.value(number));
            Ok(())
        });
    })
}

#[test]
fn it_stops_between_two_times_and_what_was_done_is_kept() {
    for threads in [1, 8] {
        let (token, runs) = (CancelToken::new(), Arc::new(AtomicUsize::new(0)));
        let mut rig = rig(threads);
        rig.register(stopper(&token, 20, &runs));
        load(
            &mut rig,
            r#""many": (kind: "repeat", inputs: { "count": 1000 }, body: (
    parameters: { "index": (value: 0) },
    nodes: { "s": (kind: "stopper", inputs: { "number": Parameter("index") }) },
    outputs: { "n": (from: "s.number") },
))"#,
        );
        let id = rig.id("many");
        let evaluation = rig.request(Request::nodes(&[id]).cancel(&token));
        assert!(evaluation.cancelled);
        assert_eq!(state(&evaluation, id), "cancelled");
        let stopped = runs.load(Ordering::SeqCst);
        assert!((20..28).contains(&stopped), "{stopped} with {threads} threads");
        let progress = rig.log.iter().filter(|line| line.starts_with("progress many")).count();
        assert!((19..=stopped).contains(&progress), "{progress}");
        assert_eq!(samples(&mut rig, "many.n").len(), 1000);
        assert_eq!(runs.load(Ordering::SeqCst), 1000, "none ran twice");
    }
}

#[test]
fn repeats_within_repeats() {
    for threads in [1, 8] {
        let mut rig = rig(threads);
        load(
            &mut rig,
            r#""rows": (kind: "repeat", inputs: { "count": 3 }, feed_back: { "start": "last" }, body: (
    parameters: { "start": (value: 1.0), "index": (value: 0) },
    nodes: {
        "inner": (kind: "repeat", inputs: { "count": 2, "x": Parameter("start") }, feed_back: { "x": "x" }, body: (
            parameters: { "x": (value: 0.0) },
            nodes: { "twice": (kind: "add", inputs: { "a": Parameter("x"), "b": Parameter("x") }) },
            outputs: { "x": (from: "twice.sum") },
        )),
        "add": (kind: "add", inputs: { "a": Link("inner.x"), "b": Parameter("index") }),
    },
    outputs: { "last": (from: "add.sum") },
))"#,
        );
        // ((1 * 4 + 0) * 4 + 1) * 4 + 2
        assert_eq!(rig.number("rows.last"), Some(70.0));
        assert!(rig.log.contains(&"finished rows/2/inner/1/twice".to_owned()), "{:?}", rig.log);
    }
}

#[test]
fn within_a_repeated_body_one_looks_at_the_first_time() {
    let mut rig = rig(1);
    load(&mut rig, ROOTS);
    let roots = rig.id("roots");
    let body = rig.graph.node(roots).unwrap().body().unwrap().graph().unwrap();
    let (sum, plus) = (body.find("sum").unwrap(), body.find("plus").unwrap());
    let (catalogue, graph) = (&rig.catalogue, &rig.graph);
    let evaluation = rig.evaluator.evaluate_within(catalogue, graph, &[roots], &Request::nodes(&[sum, plus])).unwrap();
    let list = samples(&mut rig, "list.samples");
    assert_eq!(evaluation.value::<f64>(sum, "sum"), Some(&(list[0] + 1.0)));
    let first = samples(&mut rig, "roots.roots")[0];
    assert_eq!(evaluation.value::<f64>(plus, "sum"), Some(&first));
}
