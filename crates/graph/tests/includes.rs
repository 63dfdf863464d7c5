//! Bodies in files of their own: found, read once, refused where they include themselves, reported with their names.

#![allow(clippy::unwrap_used, clippy::panic, clippy::disallowed_methods, reason = "a test that panics fails")]

mod kinds;

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::Path;

use kinds::{Rig, state};
use maquette_graph::file::{self, Includes, Loaded};
use maquette_graph::{Catalogue, Literal, Request};

/// Reads "main.ron" among these files, and says which files were read.
fn load(catalogue: &Catalogue, files: &[(&str, &str)]) -> (Loaded, Vec<String>) {
    let files: BTreeMap<&str, &str> = files.iter().copied().collect();
    let asked = RefCell::new(Vec::new());
    let read = |path: &Path| {
        let name = path.to_str().unwrap();
        asked.borrow_mut().push(name.to_owned());
        files.get(name).map(|text| text.as_bytes().to_vec()).ok_or_else(|| "there is no such file".to_owned())
    };
    let loaded = file::from_text_with(catalogue, files["main.ron"], &Includes::new("main.ron", &read)).unwrap();
    let text = file::to_text(&loaded.graph);
    let again = file::from_text_with(catalogue, &text, &Includes::new("main.ron", &read)).unwrap();
    assert_eq!(file::to_text(&again.graph), text, "nothing is lost");
    let half = asked.borrow().len() / 2;
    asked.borrow_mut().truncate(half);
    (loaded, asked.into_inner())
}

fn problems(files: &[(&str, &str)]) -> Vec<String> {
    load(&kinds::catalogue(), files).0.problems.iter().map(ToString::to_string).collect()
}

const DOUBLE: &str = r#"(version: 1,
    notes: "Doubles.",
    parameters: { "x": (value: 1.0) },
    nodes: { "d": (kind: "add", inputs: { "a": Parameter("x"), "b": Parameter("x") }) },
    outputs: { "x": (from: "d.sum") },
)"#;

#[test]
fn a_file_is_read_once_and_evaluated_like_what_is_embedded() {
    let main = r#"(version: 1, nodes: {
    "a": (kind: "graph", inputs: { "x": 3.0 }, body: File("parts/double.ron")),
    "b": (kind: "graph", inputs: { "x": Link("a.x") }, body: File("./parts/../parts/double.ron")),
    "c": (kind: "graph", inputs: { "x": 3.0 }, body: File("parts/double.ron")),
})"#;
    for threads in [1, 8] {
        let mut rig = Rig::with_threads(threads);
        let (loaded, asked) = load(&rig.catalogue, &[("main.ron", main), ("parts/double.ron", DOUBLE)]);
        assert_eq!(loaded.problems, []);
        assert_eq!(asked, ["parts/double.ron"]);
        assert_eq!(loaded.included, ["parts/double.ron"]);
        rig.graph = loaded.graph;
        assert_eq!(rig.graph.node(rig.id("a")).unwrap().kind().unwrap().description(), "Doubles.");
        let mut ran = rig.ran(&["b", "c"]);
        ran.sort();
        assert!(ran == ["a", "a/d", "b", "b/d"] || ran == ["b", "b/d", "c", "c/d"], "{ran:?}");
        assert_eq!(rig.number("b.x"), Some(12.0));
    }
}

#[test]
fn paths_within_start_at_the_file_and_those_from_outside_where_they_came_from() {
    let part = r#"(version: 1,
    parameters: { "outer": (value: File("own.txt")) },
    nodes: {
        "own": (kind: "read-file", inputs: { "file": File("own.txt") }),
        "given": (kind: "read-file", inputs: { "file": Parameter("outer") }),
        "deeper": (kind: "graph", inputs: { "file": Parameter("outer") }, body: File("deep/part.ron")),
    },
    outputs: { "own": (from: "own.text"), "given": (from: "given.text"), "deep": (from: "deeper.own"), "deep given": (from: "deeper.given") },
)"#;
    let deep = r#"(version: 1,
    parameters: { "file": (value: File("own.txt")) },
    nodes: {
        "own": (kind: "read-file", inputs: { "file": File("own.txt") }),
        "given": (kind: "read-file", inputs: { "file": Parameter("file") }),
    },
    outputs: { "own": (from: "own.text"), "given": (from: "given.text") },
)"#;
    let main = r#"(version: 1, nodes: {
    "a": (kind: "graph", inputs: { "outer": File("own.txt") }, body: File("parts/part.ron")),
    "b": (kind: "graph", body: File("parts/part.ron")),
})"#;
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir_all(folder.path().join("parts/deep")).unwrap();
    for (name, text) in [("own.txt", "main"), ("parts/own.txt", "part"), ("parts/deep/own.txt", "deep")] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let mut rig = Rig::default();
    let files = [("main.ron", main), ("parts/part.ron", part), ("parts/deep/part.ron", deep)];
    let (loaded, _) = load(&rig.catalogue, &files);
    assert_eq!(loaded.problems, []);
    rig.graph = loaded.graph;
    let ids = [rig.id("a"), rig.id("b")];
    let evaluation = rig.request(Request::nodes(&ids).base(folder.path()));
    assert_eq!(state(&evaluation, ids[0]), r#"done: "part", "main", "deep", "main""#);
    assert_eq!(state(&evaluation, ids[1]), r#"done: "part", "part", "deep", "part""#);
    std::fs::write(folder.path().join("parts/deep/own.txt"), "new").unwrap();
    let evaluation = rig.request(Request::nodes(&ids).base(folder.path()));
    assert_eq!(state(&evaluation, ids[0]), r#"done: "part", "main", "new", "main""#);
    assert_eq!(rig.log.iter().filter(|line| line.starts_with("finished")).count(), 5, "{:?}", rig.log);
    // From another folder the same graph means other files.
    let other = tempfile::tempdir().unwrap();
    std::fs::create_dir_all(other.path().join("parts/deep")).unwrap();
    for name in ["own.txt", "parts/own.txt", "parts/deep/own.txt"] {
        std::fs::write(other.path().join(name), "other").unwrap();
    }
    let evaluation = rig.request(Request::nodes(&ids).base(other.path()));
    assert_eq!(state(&evaluation, ids[1]), r#"done: "other", "other", "other", "other""#);
}

#[test]
fn recursion_is_refused_with_the_files_around() {
    let include = |file: &str| format!(r#"(version: 1, nodes: {{ "n": (kind: "graph", body: File("{file}")) }})"#);
    assert_eq!(
        problems(&[("main.ron", &include("main.ron"))]),
        ["1:50: error: node \"n\": its body can't be had: the file main.ron includes itself: main.ron -> main.ron"]
    );
    assert_eq!(
        problems(&[
            ("main.ron", &include("a/b.ron")),
            ("a/b.ron", &include("../c.ron")),
            ("c.ron", &include("a/b.ron"))
        ]),
        [
            "c.ron:1:50: error: node \"n\": its body can't be had: the file a/b.ron includes itself: a/b.ron -> c.ron -> a/b.ron"
        ]
    );
}

#[test]
fn a_chain_that_is_too_long_is_refused() {
    let files: Vec<(String, String)> = (0..40)
        .map(|i| {
            (
                format!("{i}.ron"),
                format!(r#"(version: 1, nodes: {{ "n": (kind: "graph", body: File("{}.ron")) }})"#, i + 1),
            )
        })
        .chain([
            ("40.ron".to_owned(), DOUBLE.to_owned()),
            ("main.ron".to_owned(), r#"(version: 1, nodes: { "n": (kind: "graph", body: File("0.ron")) })"#.to_owned()),
        ])
        .collect();
    let files: Vec<(&str, &str)> = files.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
    let said = problems(&files);
    assert!(said[0].contains("bodies are nested more than 16 deep"), "{said:?}");
}

#[test]
fn what_is_wrong_in_a_file_is_said_with_its_name_and_once() {
    let main = r#"(version: 1, nodes: {
    "a": (kind: "graph", body: File("p.ron")),
    "b": (kind: "graph", body: File("p.ron")),
    "behind": (kind: "add", inputs: { "a": Link("a.nothing") }),
})"#;
    assert_eq!(
        problems(&[("main.ron", main), ("p.ron", "(version: 1, nodes: {\n \"x\": (kind: \"ad\") })")]),
        [
            "4:44: error: node \"behind\", input \"a\": node \"a\" (kind graph) has no output \"nothing\"; it has none; link another output",
            "p.ron:2:14: error: node \"x\": the node kind \"ad\" is unknown; did you mean \"add\"? `maquette nodes` lists all kinds",
        ]
    );
    assert_eq!(
        problems(&[("main.ron", main), ("p.ron", "(version: 1,\n nodes: ")]),
        [
            "2:32: error: node \"a\": its body can't be had: the file p.ron can't be read",
            "3:32: error: node \"b\": its body can't be had: the file p.ron can't be read",
            "p.ron:2:8: error: a '{' is expected here; the file may have been cut off: compare it with a backup",
        ]
    );
    let missing = problems(&[("main.ron", main)]);
    assert_eq!(missing[0], "2:32: error: node \"a\": its body can't be had: the file p.ron: there is no such file");
    assert_eq!(missing.len(), 2);
}

#[test]
fn a_body_that_is_missing_stops_only_what_needs_it() {
    let main = r#"(version: 1, nodes: {
    "a": (kind: "graph", inputs: { "x": 3.0 }, body: File("gone.ron")),
    "b": (kind: "add", inputs: { "a": Link("a.x") }),
    "c": (kind: "add"),
})"#;
    let mut rig = Rig::default();
    let (loaded, _) = load(&rig.catalogue, &[("main.ron", main)]);
    rig.graph = loaded.graph;
    let evaluation = rig.evaluate(&["b", "c"]);
    assert_eq!(
        state(&evaluation, rig.id("a")),
        "failed: its body, the file gone.ron, could not be read: see to the file and open the graph again"
    );
    assert_eq!(state(&evaluation, rig.id("b")), "waiting on a");
    assert_eq!(state(&evaluation, rig.id("c")), "done: 0");
    rig.put("c.a", Literal::Number(1.0));
    assert_eq!(rig.number("c.sum"), Some(1.0));
}

#[test]
fn problems_in_what_is_embedded_have_the_way_to_them() {
    let main = "(version: 1, nodes: {\n\"a\": (kind: \"graph\", body: (nodes: {\n  \"b\": (kind: \"graph\", body: (\n    nodes: { \"c\": (kind: \"add\", inputs: { \"a\": Parameter(\"stifness\"), \"z\": 1 }) },\n    parameters: { \"stiffness\": (value: 1.0), \"bad\": (value: 2.0, range: (3.0, 4.0)) },\n    outputs: { \"x\": (from: \"d.sum\"), \"y\": (from: \"c.sun\"), \"z\": 5 },\n  )),\n  })),\n})";
    assert_eq!(
        problems(&[("main.ron", main)]),
        [
            "4:48: error: node \"a/b/c\", input \"a\": the graph has no parameter \"stifness\"; did you mean \"stiffness\"?",
            "4:71: error: node \"a/b/c\", input \"z\": add has no such input; add has a, b; it is kept, but has no effect",
            "5:61: error: node \"a/b\": parameter \"bad\": 2 is out of range: give 3 to 4",
            "6:28: error: node \"a/b\": output \"x\": it is linked to \"d\", and no node has that name; add the node, or remove the link",
            "6:50: error: node \"a/b\": output \"y\": node \"c\" has no output \"sun\"; name another output",
            "6:65: error: node \"a/b\": output \"z\": a '(' is expected here; write (from: \"node.output\", description: \"...\")",
        ]
    );
}

#[test]
fn without_a_folder_no_file_is_found_and_nothing_is_lost() {
    let catalogue = kinds::catalogue();
    let text = r#"(version: 1, nodes: { "a": (kind: "graph", inputs: { "x": 3.0 }, body: File("p.ron")) })"#;
    let loaded = file::from_text(&catalogue, text).unwrap();
    assert!(loaded.problems[0].to_string().contains("this graph was read without a folder"));
    let saved = file::to_text(&loaded.graph);
    assert!(saved.contains("\"x\": 3.0,") && saved.contains("body: File(\"p.ron\"),"), "{saved}");
}
