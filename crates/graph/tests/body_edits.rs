//! Edits within bodies, and plans that make and unmake them.

#![allow(clippy::unwrap_used, clippy::panic, reason = "in tests a failing unwrap is a failing test")]

mod kinds;

use kinds::{Rig, Samples};
use maquette_graph::edit::compound;
use maquette_graph::{
    Body, BodyError, Edit, EditError, Graph, GraphOutput, History, Literal, NodeId, NodeRecord, Parameter, Repeat,
    WireType, file,
};

fn load(text: &str) -> Rig {
    let mut rig = Rig::default();
    rig.catalogue
        .list::<Samples, f64>(|list| list.0.clone(), |items| Ok(Samples(items.iter().map(|n| **n).collect())))
        .unwrap();
    let loaded = file::from_text(&rig.catalogue, text).unwrap();
    assert_eq!(loaded.problems, []);
    rig.graph = loaded.graph;
    rig
}

const GROUPED: &str = r#"(version: 1,
    parameters: { "p": (value: 2.0) },
    nodes: {
        "x": (kind: "add", inputs: { "a": 1.0, "b": 2.0 }),
        "g": (kind: "graph", inputs: { "x": Link("x.sum"), "y": Parameter("p"), "z": 5.0 }, body: (
            parameters: { "x": (value: 0.0), "y": (value: 0.0), "z": (value: 0.0, range: (0.0, 10.0)) },
            nodes: {
                "a": (kind: "add", inputs: { "a": Parameter("x"), "b": Parameter("y") }),
                "b": (kind: "add", inputs: { "a": Link("a.sum"), "b": Parameter("z") }),
            },
            outputs: { "all": (from: "b.sum"), "some": (from: "a.sum") },
        )),
        "end": (kind: "add", inputs: { "a": Link("g.all"), "b": Link("g.some") }),
    },
    outputs: { "out": (from: "g.all") },
)"#;

/// Applies the edit, gives the text, undoes it, and sees that all is as it was.
fn tried(rig: &mut Rig, edit: &Edit) -> String {
    let before = file::to_text(&rig.graph);
    rig.evaluate(&["end"]);
    let inverse = rig.graph.apply(&rig.catalogue, edit).unwrap();
    let after = file::to_text(&rig.graph);
    let again = file::from_text(&rig.catalogue, &after).unwrap();
    assert_eq!(
        again.problems.iter().map(ToString::to_string).filter(|p| p.contains("error")).collect::<Vec<_>>(),
        [""; 0]
    );
    let redo = rig.graph.apply(&rig.catalogue, &inverse).unwrap();
    assert_eq!(file::to_text(&rig.graph), before);
    assert_eq!(rig.ran(&["end"]), [""; 0], "undone runs nothing");
    let undo = rig.graph.apply(&rig.catalogue, &redo).unwrap();
    assert_eq!(file::to_text(&rig.graph), after);
    rig.graph.apply(&rig.catalogue, &undo).unwrap();
    assert_eq!(file::to_text(&rig.graph), before);
    after
}

fn within(rig: &Rig, edit: Edit) -> Edit {
    Edit::Within { node: rig.id("g"), edit: edit.into() }
}

fn inner(rig: &Rig) -> &Graph {
    rig.graph.node(rig.id("g")).unwrap().body().unwrap().graph().unwrap()
}

#[test]
fn what_is_linked_follows_new_names_of_ports() {
    let mut rig = load(GROUPED);
    let renamed = |name: &str| Parameter::new(name, Literal::Number(0.0));
    let swap = Edit::Several(vec![
        Edit::ChangeParameter { name: "x".to_owned(), parameter: renamed("t").into() },
        Edit::ChangeParameter { name: "y".to_owned(), parameter: renamed("x").into() },
        Edit::ChangeParameter { name: "t".to_owned(), parameter: renamed("y").into() },
    ]);
    let edit = within(&rig, swap);
    let text = tried(&mut rig, &edit);
    assert!(text.contains("\"y\": Link(\"x.sum\"),") && text.contains("\"x\": Parameter(\"p\"),"), "{text}");
    let b = inner(&rig).find("b").unwrap();
    let output = GraphOutput::new("total", b, "sum");
    let edit = within(&rig, Edit::ChangeOutput { name: "all".to_owned(), output: output.into() });
    let text = tried(&mut rig, &edit);
    assert!(text.contains("Link(\"g.total\")") && text.contains("from: \"g.total\""), "{text}");
}

#[test]
fn what_no_longer_fits_goes_and_comes_back() {
    let mut rig = load(GROUPED);
    let edit = within(&rig, Edit::RemoveParameter("x".to_owned()));
    let text = tried(&mut rig, &edit);
    assert!(!text.contains("Link(\"x.sum\")") && text.contains("\"a\": 0.0,"), "its value stays in its place: {text}");
    let edit = within(&rig, Edit::RemoveOutput("all".to_owned()));
    let text = tried(&mut rig, &edit);
    assert!(
        !text.contains("g.all") && text.contains("\"b\": Link(\"g.some\")") && text.contains("\"out\": (\n        ),"),
        "{text}"
    );
    // 5 is beyond the new range.
    let narrow = Parameter::new("z", Literal::Number(0.0)).range(0.0, 1.0);
    let edit = within(&rig, Edit::ChangeParameter { name: "z".to_owned(), parameter: narrow.into() });
    let text = tried(&mut rig, &edit);
    assert!(!text.contains("\"z\": 5.0"), "{text}");
    // Another type.
    let other = Parameter::required("y", WireType::of::<Samples>());
    let edit = within(&rig, Edit::ChangeParameter { name: "y".to_owned(), parameter: other.into() });
    let text = tried(&mut rig, &edit);
    assert!(!text.contains("Parameter(\"p\")") && !text.contains("\"b\": Parameter(\"y\")"), "{text}");
    // Renamed and removed at once.
    let a = inner(&rig).find("a").unwrap();
    let both = Edit::Several(vec![
        Edit::ChangeOutput { name: "all".to_owned(), output: GraphOutput::new("new", a, "sum").into() },
        Edit::RemoveOutput("some".to_owned()),
        Edit::ChangeOutput { name: "new".to_owned(), output: GraphOutput::new("some", a, "sum").into() },
        Edit::RemoveOutput("some".to_owned()),
    ]);
    let edit = within(&rig, both);
    let text = tried(&mut rig, &edit);
    assert!(!text.contains("Link(\"g."), "{text}");
    let body = Body::embedded(Graph::new()).unwrap();
    let edit = Edit::SetBody { node: rig.id("g"), body: body.into() };
    let text = tried(&mut rig, &edit);
    assert!(!text.contains("Link(\"g."), "{text}");
}

#[test]
fn what_does_not_fit_at_all_is_refused_and_changes_nothing() {
    let mut rig = load(GROUPED);
    let before = file::to_text(&rig.graph);
    let a = inner(&rig).find("a").unwrap();
    let (g, x) = (rig.id("g"), rig.id("x"));
    let repeated = |repeat| Edit::SetBody {
        node: g,
        body: std::sync::Arc::new((**rig.graph.node(g).unwrap().body().unwrap()).clone().repeated(repeat)),
    };
    let refused = [
        (
            within(&rig, Edit::set(a, "a", Literal::Text("no".to_owned()))),
            "within \"g\": node \"a\", input \"a\": it takes a number",
        ),
        (
            within(&rig, Edit::RemoveParameter("nothing".to_owned())),
            "within \"g\": the graph has no parameter \"nothing\"",
        ),
        (
            within(&rig, Edit::AddOutput { index: 0, output: GraphOutput::new("all", a, "sum").into() }),
            "an output named \"all\" is already there",
        ),
        (
            within(
                &rig,
                Edit::AddParameter { index: 0, parameter: Parameter::new("a.b", Literal::Boolean(true)).into() },
            ),
            "can't be its name",
        ),
        (Edit::Within { node: x, edit: Edit::GraphNotes(String::new()).into() }, "node \"x\" has no body"),
        (repeated(Repeat::Times), "use the kind repeat"),
        (Edit::UseParameter { node: x, input: "a".to_owned(), parameter: "q".to_owned() }, "no parameter \"q\""),
        (Edit::SetParameter { parameter: "p".to_owned(), literal: Some(Literal::Boolean(true)) }, "it takes a number"),
        (
            within(
                &rig,
                Edit::Several(vec![Edit::GraphNotes("x".to_owned()), Edit::RemoveNode(a), Edit::RemoveNode(a)]),
            ),
            "no longer in the graph",
        ),
    ];
    for (edit, expected) in refused {
        let error = rig.graph.apply(&rig.catalogue, &edit).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
        assert_eq!(file::to_text(&rig.graph), before);
    }
}

#[test]
fn bodies_are_nested_sixteen_deep_and_no_deeper() {
    for threads in [1, 8] {
        let mut rig = Rig::with_threads(threads);
        let mut graph = Graph::new();
        graph.add(&rig.catalogue, "add", "sum").unwrap();
        let mut from = (graph.find("sum").unwrap(), "sum");
        graph.add_parameter(Parameter::new("x", Literal::Number(1.0))).unwrap();
        graph.use_parameter(&rig.catalogue, from.0, "a", "x").unwrap();
        for _ in 0..15 {
            graph.add_output(GraphOutput::new("x", from.0, from.1)).unwrap();
            let mut outer = Graph::new();
            outer.add_parameter(Parameter::new("x", Literal::Number(1.0))).unwrap();
            let record = NodeRecord::new("graph", "inner").body(Body::embedded(graph).unwrap()).parameter("x", "x");
            outer.apply(&rig.catalogue, &Edit::AddNode(record.into())).unwrap();
            from = (outer.find("inner").unwrap(), "x");
            graph = outer;
        }
        graph.add_output(GraphOutput::new("x", from.0, from.1)).unwrap();
        let body = Body::embedded(graph.clone()).unwrap();
        let record = NodeRecord::new("graph", "inner").body(body.clone()).literal("x", Literal::Number(7.0));
        rig.graph.apply(&rig.catalogue, &Edit::AddNode(record.into())).unwrap();
        assert_eq!(rig.number("inner.x"), Some(7.0));
        assert_eq!(rig.log.iter().filter(|line| line.starts_with("finished")).count(), 17);
        let text = file::to_text(&rig.graph);
        let again = file::from_text(&rig.catalogue, &text).unwrap();
        assert_eq!(again.problems, []);
        assert_eq!(file::to_text(&again.graph), text);
        assert_eq!(Body::embedded(rig.graph.clone()).unwrap_err(), BodyError::TooDeep);
        // Nor by an edit from within.
        let empty = NodeRecord::new("graph", "one more");
        let mut edit = Edit::AddNode(empty.into());
        let mut path = vec![rig.id("inner")];
        let mut at: &Graph = &rig.graph;
        for _ in 0..15 {
            at = at.node(*path.last().unwrap()).unwrap().body().unwrap().graph().unwrap();
            path.push(at.find("inner").unwrap());
        }
        for node in path.into_iter().rev() {
            edit = Edit::Within { node, edit: edit.into() };
        }
        let error = rig.graph.apply(&rig.catalogue, &edit).unwrap_err().to_string();
        assert!(error.ends_with("bodies are nested more than 16 deep: use fewer levels"), "{error}");
    }
}

#[test]
fn a_group_gives_what_its_nodes_gave() {
    let mut rig = load(
        r#"(version: 1, parameters: { "p": (value: 2.0) }, nodes: {
        "x": (kind: "add", inputs: { "a": 1.0, "b": 2.0 }),
        "a": (kind: "add", inputs: { "a": Link("x.sum"), "b": Parameter("p") }),
        "b": (kind: "add", inputs: { "a": Link("a.sum"), "b": Link("x.sum") }),
        "end": (kind: "everything", inputs: { "number": Link("b.sum") }),
    }, layout: { "a": (10.0, 0.0), "b": (30.0, 4.0) })"#,
    );
    let before = rig.number("end.number");
    let text = file::to_text(&rig.graph);
    let (a, b, end) = (rig.id("a"), rig.id("b"), rig.id("end"));
    let mut history = History::new();
    let plan = compound::group(&rig.graph, &rig.catalogue, &[a, b, end], "sums").unwrap();
    assert_eq!(
        plan.remarks[0].to_string(),
        "node \"end\", input \"\": stays outside, because a result counts only in the graph itself"
    );
    history.step(&mut rig.graph, &rig.catalogue, "group", &plan.edits).unwrap();
    let grouped = file::to_text(&rig.graph);
    assert_eq!(rig.number("end.number"), before);
    assert!(grouped.contains("\"sums\": (20.0, 2.0),"), "{grouped}");
    // One thing from outside is one parameter.
    let kind = rig.graph.node(plan.nodes[0]).unwrap().kind().unwrap();
    assert_eq!(kind.inputs().iter().map(|i| i.name.as_str()).collect::<Vec<_>>(), ["a", "p"]);
    rig.graph.set_parameter("p", Literal::Number(4.0)).unwrap();
    assert_eq!(rig.number("end.number"), before.map(|n| n + 2.0));
    rig.graph.set_parameter("p", Literal::Number(2.0)).unwrap();
    let plan = compound::ungroup(&rig.graph, &rig.catalogue, plan.nodes[0]).unwrap();
    history.step(&mut rig.graph, &rig.catalogue, "ungroup", &plan.edits).unwrap();
    assert_eq!(rig.number("end.number"), before);
    assert_eq!(rig.graph.nodes().len(), 4);
    history.undo(&mut rig.graph, &rig.catalogue).unwrap();
    assert_eq!(file::to_text(&rig.graph), grouped);
    history.undo(&mut rig.graph, &rig.catalogue).unwrap();
    assert_eq!(file::to_text(&rig.graph), text);
    let around = compound::group(&rig.graph, &rig.catalogue, &[rig.id("x"), b], "no").unwrap_err().to_string();
    assert!(around.starts_with("\"a\" depends on the group, and the group on it"), "{around}");
    assert!(compound::group(&rig.graph, &rig.catalogue, &[end], "no").is_err());
}

#[test]
fn an_input_becomes_a_parameter_with_all_that_it_declares() {
    let mut rig = Rig::default();
    for name in ["one", "two"] {
        rig.add("count", name);
    }
    rig.put("one.count", Literal::Integer(7));
    rig.evaluate(&["one", "two"]);
    let promote = |rig: &mut Rig, node: &str, input: &str| {
        let plan = compound::promote(&rig.graph, rig.id(node), input).unwrap();
        rig.graph.apply_all(&rig.catalogue, &plan.edits).unwrap();
    };
    promote(&mut rig, "one", "count");
    promote(&mut rig, "two", "count");
    let names: Vec<_> = rig.graph.parameters().map(|p| (p.name(), p.value().cloned().unwrap())).collect();
    assert_eq!(names, [("count", Literal::Integer(7)), ("two count", Literal::Integer(1))]);
    let first = rig.graph.parameter("count").unwrap().spec();
    assert_eq!((first.range.unwrap().max, first.description.as_str()), (100.0, "A count."));
    assert_eq!(rig.ran(&["one", "two"]), [""; 0], "the values are the same");
    assert!(
        compound::promote(&rig.graph, rig.id("one"), "count")
            .unwrap_err()
            .to_string()
            .contains("a parameter drives it")
    );
    rig.link("one.text", "two.text");
    assert!(compound::promote(&rig.graph, rig.id("two"), "text").unwrap_err().to_string().contains("a link drives it"));
}

#[test]
fn copies_of_nodes_with_bodies_and_parameters() {
    let mut rig = load(GROUPED);
    let g = rig.id("g");
    let mute = Edit::Mute { node: g, muted: true };
    rig.graph.apply(&rig.catalogue, &mute).unwrap();
    let text = compound::copy(&rig.graph, &[g]).unwrap();
    assert!(text.contains("parameters: {\n        \"p\": (\n            value: 2.0,"), "{text}");
    let paste = |rig: &Rig, graph: &Graph| compound::paste(graph, &rig.catalogue, &text, [0.0; 2]).unwrap();
    // Here the parameter is there; elsewhere its value is taken.
    let plan = paste(&rig, &rig.graph);
    rig.graph.apply_all(&rig.catalogue, &plan.edits).unwrap();
    let copy = rig.graph.node(plan.nodes[0]).unwrap();
    assert_eq!((copy.name(), copy.is_muted(), copy.body().is_some()), ("g 2", true, true));
    assert_eq!(copy.source("y"), Some(&maquette_graph::Source::Parameter("p".to_owned())));
    let mut elsewhere = Graph::new();
    let plan = paste(&rig, &elsewhere);
    elsewhere.apply_all(&rig.catalogue, &plan.edits).unwrap();
    let saved = file::to_text(&elsewhere);
    assert!(saved.contains("\"y\": 2.0,") && saved.contains("muted: true,"), "{saved}");
    // A graph becomes a repeat with the same graph within, and back.
    rig.graph.apply(&rig.catalogue, &Edit::Mute { node: g, muted: false }).unwrap();
    let before = file::to_text(&rig.graph);
    let plan = compound::replace_kind(&rig.graph, &rig.catalogue, g, "repeat").unwrap();
    let inverses = rig.graph.apply_all(&rig.catalogue, &plan.edits).unwrap();
    let kind = rig.graph.node(g).unwrap().kind().unwrap();
    assert_eq!(kind.outputs()[0].wire.name(), "samples");
    assert_eq!(plan.remarks.len(), 2, "{:?}", plan.remarks);
    rig.graph.apply_all(&rig.catalogue, inverses.iter().rev()).unwrap();
    assert_eq!(file::to_text(&rig.graph), before);
}

#[test]
fn frames_of_a_drag_within_a_body_are_one_edit() {
    let mut rig = load(GROUPED);
    let before = file::to_text(&rig.graph);
    let (g, b): (NodeId, NodeId) = (rig.id("g"), inner(&rig).find("b").unwrap());
    let mut history = History::new();
    for step in 0..100 {
        history.begin_merging("drag", "g/b.b");
        let edit = Edit::set(b, "b", Literal::Number(f64::from(step)));
        history.apply(&mut rig.graph, &rig.catalogue, &Edit::Within { node: g, edit: edit.into() }).unwrap();
        history.commit();
    }
    assert_eq!(history.names().len(), 1);
    history.undo(&mut rig.graph, &rig.catalogue).unwrap();
    assert_eq!(file::to_text(&rig.graph), before);
    let error = rig.graph.apply(&rig.catalogue, &Edit::SetParameter { parameter: "q".to_owned(), literal: None });
    assert!(matches!(error, Err(EditError::Interface(_))));
}
