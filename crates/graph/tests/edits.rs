//! Each edit, its inverse, and what it refuses; undone edits run nothing.

#![allow(clippy::unwrap_used, reason = "in tests a failing unwrap is a failing test")]

mod kinds;

use kinds::Rig;
use maquette_graph::{
    Edit, EditError, Frame, Graph, GraphError, Literal, NodeId, NodeRecord, ReferencePicture, Source, Stroke, file,
};

/// A file with everything that a graph keeps without knowing it.
const STRANGE: &str = r#"(
    version: 1,
    notes: "all of it",
    nodes: {
        "first": (
            kind: "add",
            note: "the source",
            inputs: {
                "a": 1.5,
                "b": Link("missing.sum"),
                "unheard": Text("of"),
            },
            colour: "red",
        ),
        "strange": (
            kind: "from-the-future",
            inputs: {
                "in": Link("first.sum"),
                "power": 3,
            },
        ),
        "last": (
            kind: "add",
            inputs: {
                "a": Link("strange.out"),
                "b": Link("first.sum"),
            },
        ),
    },
    layout: {
        "first": (1.0, 2.0),
        "strange": (3.0, 4.0),
        "nobody": (5.0, 6.0),
    },
    future: (1, 2),
)
"#;

type State = (String, Vec<(NodeId, String)>);

fn state(graph: &Graph) -> State {
    (file::to_text(graph), graph.nodes().map(|(id, node)| (id, node.name().to_owned())).collect())
}

fn strange() -> Rig {
    let mut rig = Rig::default();
    rig.graph = file::from_text(&rig.catalogue, STRANGE).unwrap().graph;
    assert_eq!(file::to_text(&rig.graph), STRANGE);
    rig
}

/// Applies, undoes, redoes and undoes again; both sides stay what they were. Gives what is written after the edit.
fn there_and_back(rig: &mut Rig, edit: &Edit) -> String {
    let before = state(&rig.graph);
    let inverse = rig.graph.apply(&rig.catalogue, edit).unwrap();
    let after = state(&rig.graph);
    let again = rig.graph.apply(&rig.catalogue, &inverse).unwrap();
    assert_eq!(state(&rig.graph), before, "{edit:?} undone by {inverse:?}");
    let inverse = rig.graph.apply(&rig.catalogue, &again).unwrap();
    assert_eq!(state(&rig.graph), after, "{edit:?} redone by {again:?}");
    rig.graph.apply(&rig.catalogue, &inverse).unwrap();
    assert_eq!(state(&rig.graph), before);
    after.0
}

#[test]
fn a_removed_node_comes_back_with_everything() {
    for name in ["first", "strange", "last"] {
        let mut rig = strange();
        let id = rig.id(name);
        let without = there_and_back(&mut rig, &Edit::RemoveNode(id));
        assert!(!without.contains(&format!("\"{name}\"")), "{without}");
        assert_eq!(rig.graph.fed_by(rig.id("first")).len(), 2);
    }
}

#[test]
fn every_edit_has_an_inverse() {
    let stroke = Stroke { name: "ring".into(), closed: true, points: vec![] };
    let mut rig = strange();
    let (first, strange, last) = (rig.id("first"), rig.id("strange"), rig.id("last"));
    let record = NodeRecord::new("everything", "new")
        .literal("strokes", Literal::Strokes(vec![stroke]))
        .literal("length", Literal::Integer(2))
        .link("number", first, "sum")
        .at([7.0, 8.0])
        .note("made");
    let input = |node, input: &str| (node, input.to_owned());
    let edits = [
        (Edit::AddNode(Box::new(record)), "\"new\": (\n            kind: \"everything\",\n            note: \"made\""),
        (Edit::add("add", "plain"), "\"plain\": (\n            kind: \"add\",\n        ),"),
        (Edit::connect(first, "sum", last, "a"), "\"a\": Link(\"first.sum\")"),
        // What could not be read is overwritten, and comes back.
        (Edit::set(first, "b", Literal::Number(2.5)), "\"b\": 2.5"),
        (Edit::set(first, "a", Literal::Integer(2)), "\"a\": 2.0"),
        (Edit::set(last, "a", Literal::Number(9.0)), "\"a\": 9.0"),
        (Edit::set(strange, "power", Literal::Boolean(true)), "\"power\": true"),
        (Edit::Rename { node: strange, name: "renamed".into() }, "Link(\"renamed.out\")"),
        (Edit::Move { node: last, position: Some([9.0, 10.0]) }, "\"last\": (9.0, 10.0)"),
        (Edit::Note { node: first, note: "other".into() }, "note: \"other\""),
        (Edit::GraphNotes("nothing of it".into()), "notes: \"nothing of it\""),
        (Edit::Collapse { node: last, collapsed: true }, "collapsed: true"),
        (
            Edit::Frames(vec![frame("a \"frame\"", [4.0, 5.0])]),
            "(title: \"a \\\"frame\\\"\", colour: (0.1, 0.2, 0.3), at: (1.0, 2.0), size: (4.0, 5.0)),",
        ),
        (
            Edit::References(vec![picture("side", 0.25)]),
            "(view: \"side\", file: \"a.png\", centre: (0.0, 1.0), width: 0.8, opacity: 0.25, locked: true),",
        ),
    ];
    for (edit, expected) in edits {
        let text = there_and_back(&mut rig, &edit);
        assert!(text.contains(expected), "{edit:?} gives\n{text}");
    }
    for (edit, gone) in [
        (Edit::Disconnect { to: last, input: "a".into() }, "Link(\"strange.out\")"),
        (Edit::Reset { node: first, input: input(first, "unheard").1 }, "unheard"),
        (Edit::Reset { node: first, input: "b".into() }, "missing"),
        (Edit::Reset { node: last, input: "b".into() }, "\"b\": Link(\"first.sum\")"),
        (Edit::Move { node: strange, position: None }, "(3.0, 4.0)"),
        (Edit::Move { node: strange, position: Some([f64::NAN, 0.0]) }, "(3.0, 4.0)"),
        (Edit::GraphNotes(String::new()), "notes:"),
    ] {
        let text = there_and_back(&mut rig, &edit);
        assert!(!text.contains(gone), "{edit:?} gives\n{text}");
    }
}

fn frame(title: &str, size: [f64; 2]) -> Frame {
    Frame { title: title.to_owned(), colour: [0.1, 0.2, 0.3], at: [1.0, 2.0], size }
}

fn picture(view: &str, opacity: f64) -> ReferencePicture {
    let (view, file) = (view.to_owned(), "a.png".to_owned());
    ReferencePicture { view, file, centre: [0.0, 1.0], width: 0.8, opacity, locked: true, hidden: false }
}

#[test]
fn what_does_not_fit_is_refused_and_changes_nothing() {
    let mut rig = strange();
    let (first, last) = (rig.id("first"), rig.id("last"));
    let gone = rig.add("add", "gone");
    rig.graph.remove(gone).unwrap();
    let number = |n| Literal::Number(n);
    let refused = [
        (Edit::add("ad", "x"), "no node kind is named \"ad\"; did you mean \"add\"?"),
        (Edit::add("add", "last"), "a node named \"last\" is already there: choose another name"),
        (Edit::add("add", "a.b"), "\"a.b\" can't name a node"),
        (Edit::RemoveNode(gone), "the node is no longer in the graph"),
        (Edit::connect(gone, "sum", last, "a"), "the node is no longer in the graph"),
        (Edit::connect(last, "sum", first, "a"), "the link would close the cycle"),
        (Edit::connect(first, "total", last, "a"), "has no output \"total\"; it has sum"),
        (Edit::Disconnect { to: first, input: "b".into() }, "node \"first\", input \"b\": no link is there to remove"),
        (Edit::Disconnect { to: gone, input: "b".into() }, "the node is no longer in the graph"),
        (Edit::set(first, "c", number(1.0)), "has no input \"c\"; it has a, b"),
        (Edit::set(first, "a", number(1e10)), "10000000000 is out of range"),
        (Edit::set(first, "a", number(f64::NAN)), "not a finite number"),
        (Edit::Frames(vec![frame("", [1.0, 1.0]), frame("", [0.0, 1.0])]), "frame 1 needs finite numbers"),
        (Edit::References(vec![picture("front", 1.5)]), "reference picture 0 needs finite numbers"),
        (Edit::References(vec![picture("back", 0.5)]), "stands in \"back\", which is no plane to sketch in"),
        (Edit::Collapse { node: gone, collapsed: true }, "the node is no longer in the graph"),
        (Edit::Rename { node: first, name: "last".into() }, "already there"),
        (Edit::Rename { node: first, name: " ".into() }, "can't name a node"),
        (Edit::Move { node: gone, position: None }, "the node is no longer in the graph"),
        (Edit::Note { node: gone, note: String::new() }, "the node is no longer in the graph"),
        (Edit::Reset { node: gone, input: "a".into() }, "the node is no longer in the graph"),
        // A node is added as a whole or not at all.
        (
            Edit::AddNode(Box::new(NodeRecord::new("add", "x").link("a", first, "sum").link("b", gone, "sum"))),
            "no longer",
        ),
        (Edit::AddNode(Box::new(NodeRecord::new("add", "x").literal("a", number(f64::INFINITY)))), "finite"),
    ];
    let before = state(&rig.graph);
    for (edit, expected) in refused {
        let error = rig.graph.apply(&rig.catalogue, &edit).unwrap_err().to_string();
        assert!(error.contains(expected), "{edit:?}: {error}");
        assert_eq!(state(&rig.graph), before, "{edit:?}");
        // Among others, it takes those before it back.
        let good = Edit::add("add", "good");
        rig.graph.apply_all(&rig.catalogue, [&good, &Edit::RemoveNode(first), &edit]).unwrap_err();
        assert_eq!(state(&rig.graph), before, "{edit:?}");
    }
}

#[test]
fn a_node_does_not_come_back_where_its_place_is_taken() {
    let mut rig = strange();
    let (first, last) = (rig.id("first"), rig.id("last"));
    let inverse = rig.graph.apply(&rig.catalogue, &Edit::RemoveNode(first)).unwrap();
    rig.set("last.b", 1.0);
    let before = state(&rig.graph);
    let taken = EditError::InputTaken { from: "first".into(), to: "last".into(), input: "b".into() };
    assert_eq!(rig.graph.apply(&rig.catalogue, &inverse), Err(taken));
    assert_eq!(state(&rig.graph), before);
    rig.graph.reset(last, "b").unwrap();
    let Edit::RemoveNode(back) = rig.graph.apply(&rig.catalogue, &inverse).unwrap() else { unreachable!() };
    assert_eq!(back, first);
    assert_eq!(rig.graph.apply(&rig.catalogue, &inverse), Err(EditError::Outdated("first".into())));
    // An identity that this graph has not given yet is none of its own.
    let mut other = Rig::default();
    let ids = other.chain(3);
    let inverse = other.graph.apply(&other.catalogue, &Edit::RemoveNode(ids[2])).unwrap();
    let mut empty = Rig::default();
    let error = empty.graph.apply(&empty.catalogue, &inverse).unwrap_err();
    assert_eq!(error, EditError::Outdated("n2".into()));
    let dependents_gone = EditError::Graph(GraphError::NoSuchNode);
    let inverse = other.graph.apply(&other.catalogue, &Edit::RemoveNode(ids[0])).unwrap();
    other.graph.remove(ids[1]).unwrap();
    assert_eq!(other.graph.apply(&other.catalogue, &inverse), Err(dependents_gone));
    assert!(other.graph.find("n0").is_none());
}

#[test]
fn edits_and_the_methods_of_a_graph_do_the_same() {
    let (mut by_method, mut by_edit) = (Rig::default(), Rig::default());
    by_method.chain(2);
    let catalogue = &by_edit.catalogue;
    let ids: Vec<_> = ["n0", "n1"].map(|name| by_edit.graph.apply(catalogue, &Edit::add("add", name)).unwrap()).into();
    let ids: Vec<_> = ids.iter().map(|e| if let Edit::RemoveNode(id) = e { *id } else { unreachable!() }).collect();
    for edit in [
        Edit::set(ids[0], "b", Literal::Number(1.0)),
        Edit::set(ids[1], "b", Literal::Number(1.0)),
        Edit::connect(ids[0], "sum", ids[1], "a"),
    ] {
        by_edit.graph.apply(catalogue, &edit).unwrap();
    }
    assert_eq!(state(&by_edit.graph), state(&by_method.graph));
    assert!(matches!(by_edit.graph.node(ids[1]).unwrap().source("a"), Some(Source::Link(link)) if link.node == ids[0]));
}

#[test]
fn undone_edits_run_nothing() {
    let mut rig = Rig::default();
    let ids = rig.chain(4);
    // No two nodes compute the same, or one would be answered by the other.
    for (i, b) in [1.0, 10.0, 100.0, 1000.0].into_iter().enumerate() {
        rig.set(&format!("n{i}.b"), b);
    }
    let edits = [
        (Edit::set(ids[0], "a", Literal::Number(5.0)), vec!["n0", "n1", "n2", "n3"]),
        (Edit::Reset { node: ids[2], input: "b".into() }, vec!["n2", "n3"]),
        (Edit::connect(ids[1], "sum", ids[3], "b"), vec!["n3"]),
        (Edit::Disconnect { to: ids[3], input: "a".into() }, vec!["n3"]),
        (Edit::RemoveNode(ids[1]), vec!["n2", "n3"]),
        (Edit::Rename { node: ids[1], name: "middle".into() }, vec![]),
        (Edit::Move { node: ids[1], position: Some([1.0, 1.0]) }, vec![]),
        (Edit::Note { node: ids[1], note: "why".into() }, vec![]),
        (Edit::GraphNotes("why not".into()), vec![]),
        (Edit::Collapse { node: ids[1], collapsed: true }, vec![]),
        (Edit::Frames(vec![frame("all", [9.0, 9.0])]), vec![]),
        (Edit::References(vec![picture("top", 1.0)]), vec![]),
        (Edit::add("add", "aside"), vec![]),
    ];
    for (edit, ran) in edits {
        // Results of the edits before are remembered too: forget them, so that each edit stands alone.
        rig.evaluator.forget();
        rig.evaluate(&["n3"]);
        let inverse = rig.graph.apply(&rig.catalogue, &edit).unwrap();
        assert_eq!(rig.ran(&["n3"]), ran, "{edit:?}");
        let again = rig.graph.apply(&rig.catalogue, &inverse).unwrap();
        rig.evaluate(&["n3"]);
        let (planned, hits) = rig.log.split_last().unwrap();
        assert_eq!(planned, "planned 0", "{edit:?} undone");
        assert!(hits.iter().all(|line| line.starts_with("hit ")), "{edit:?} undone: {hits:?}");
        assert_eq!(rig.number("n3.sum"), Some(1111.0));
        rig.graph.apply(&rig.catalogue, &again).unwrap();
        assert_eq!(rig.ran(&["n3"]), Vec::<String>::new(), "{edit:?} redone");
        rig.graph.apply(&rig.catalogue, &inverse).unwrap();
    }
}
