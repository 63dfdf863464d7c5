//! Insert, replace, dissolve, duplicate, copy and paste: what they make, what they report, and what they refuse.

#![allow(clippy::unwrap_used, reason = "in tests a failing unwrap is a failing test")]

mod kinds;

use kinds::Rig;
use maquette_graph::edit::compound::{self, Incoming, InsertError, PasteError, Plan};
use maquette_graph::{GraphError, History, Literal, NodeId, file};

/// The links and literals of a node: `a = x.sum`.
fn inputs(rig: &Rig, name: &str) -> Vec<String> {
    let node = rig.graph.node(rig.id(name)).unwrap();
    let spelled = node.sources().map(|(input, source)| match source {
        maquette_graph::Source::Link(link) => {
            format!("{input} = {}.{}", rig.graph.node(link.node).unwrap().name(), link.output)
        }
        maquette_graph::Source::Literal { literal, .. } => format!("{input} = {literal:?}"),
        maquette_graph::Source::Parameter(name) => format!("{input} = {name}"),
        maquette_graph::Source::Unread(text) => format!("{input} ? {text}"),
    });
    spelled.collect()
}

fn names(rig: &Rig) -> Vec<&str> {
    rig.graph.nodes().map(|(_, node)| node.name()).collect()
}

fn remarks(plan: &Plan) -> Vec<String> {
    plan.remarks.iter().map(ToString::to_string).collect()
}

fn ids(rig: &Rig, names: &[&str]) -> Vec<NodeId> {
    names.iter().map(|name| rig.id(name)).collect()
}

/// Makes a plan a step, undoes and redoes it: neither leaves a trace, and evaluating what was there runs nothing.
fn carry_out(rig: &mut Rig, plan: &Plan) {
    let all: Vec<String> = names(rig).into_iter().map(str::to_owned).collect();
    let all: Vec<&str> = all.iter().map(String::as_str).collect();
    rig.evaluate(&all);
    let before = file::to_text(&rig.graph);
    let mut history = History::new();
    history.step(&mut rig.graph, &rig.catalogue, "plan", &plan.edits).unwrap();
    let after = file::to_text(&rig.graph);
    let loaded = file::from_text(&rig.catalogue, &after).unwrap();
    assert_eq!(file::to_text(&loaded.graph), after);
    history.undo(&mut rig.graph, &rig.catalogue).unwrap();
    assert_eq!(file::to_text(&rig.graph), before);
    assert_eq!(rig.ran(&all), Vec::<String>::new(), "undone");
    history.redo(&mut rig.graph, &rig.catalogue).unwrap();
    assert_eq!(file::to_text(&rig.graph), after);
}

#[test]
fn a_node_is_inserted_into_a_link() {
    let mut rig = Rig::default();
    let chain = rig.chain(2);
    rig.graph.set_position(chain[0], Some([0.0, 0.0])).unwrap();
    rig.graph.set_position(chain[1], Some([100.0, 50.0])).unwrap();
    let plan = compound::insert_into_link(&rig.graph, &rig.catalogue, chain[1], "a", "root").unwrap();
    carry_out(&mut rig, &plan);
    assert_eq!(names(&rig), ["n0", "n1", "root"]);
    assert_eq!(inputs(&rig, "root"), ["number = n0.sum"]);
    assert_eq!(inputs(&rig, "n1"), ["a = root.root", "b = Number(1.0)"]);
    assert_eq!(rig.graph.node(plan.nodes[0]).unwrap().position(), Some([50.0, 25.0]));
    let plan = compound::insert_into_link(&rig.graph, &rig.catalogue, chain[1], "a", "root").unwrap();
    carry_out(&mut rig, &plan);
    assert_eq!(names(&rig), ["n0", "n1", "root", "root 2"]);
    assert_eq!(inputs(&rig, "root 2"), ["number = root.root"]);
}

#[test]
fn insertion_prefers_the_very_type() {
    let mut rig = Rig::default();
    rig.add("whole", "whole");
    rig.add("count", "count");
    rig.link("whole.integer", "count.count");
    let count = rig.id("count");
    // "number" of everything takes a whole number by conversion, "integer" as it is.
    let plan = compound::insert_into_link(&rig.graph, &rig.catalogue, count, "count", "everything").unwrap();
    carry_out(&mut rig, &plan);
    assert_eq!(inputs(&rig, "everything"), ["integer = whole.integer"]);
    assert_eq!(inputs(&rig, "count"), ["count = everything.integer"]);
}

#[test]
fn what_can_not_be_inserted_is_refused() {
    let mut rig = Rig::default();
    let chain = rig.chain(2);
    rig.graph.remove(chain[0]).unwrap();
    let insert = |rig: &Rig, node, input, kind| {
        compound::insert_into_link(&rig.graph, &rig.catalogue, node, input, kind).unwrap_err()
    };
    assert_eq!(insert(&rig, chain[0], "a", "add"), InsertError::Graph(GraphError::NoSuchNode));
    let error = insert(&rig, chain[1], "a", "add");
    assert_eq!(error.to_string(), "node \"n1\", input \"a\": no link is there to insert a node into");
    rig.add("add", "n0");
    rig.link("n0.sum", "n1.a");
    assert!(insert(&rig, chain[1], "a", "ad").to_string().contains("did you mean \"add\"?"));
    assert_eq!(insert(&rig, chain[1], "a", "spell").to_string(), "no input of spell takes what \"n0.sum\" gives");
    let error = insert(&rig, chain[1], "a", "sign");
    assert_eq!(error.to_string(), "no output of sign fits input \"a\" of node \"n1\"");
}

#[test]
fn a_replaced_node_keeps_what_fits() {
    let mut rig = Rig::default();
    rig.chain(1);
    rig.add("sign", "middle");
    rig.add("spell", "spell");
    rig.add("count", "count");
    rig.link("n0.sum", "middle.number");
    rig.link("middle.positive", "spell.flag");
    rig.link("middle.text", "count.text");
    let middle = rig.id("middle");
    rig.graph.set_position(middle, Some([1.0, 2.0])).unwrap();
    rig.graph.set_note(middle, "kept").unwrap();
    let plan = compound::replace_kind(&rig.graph, &rig.catalogue, middle, "everything").unwrap();
    let dropped = |input: &str, port: &str| {
        format!(
            "node \"{input}\", input \"{port}\": the link from \"middle.{{}}\" is dropped: everything has none that fits"
        )
    };
    assert_eq!(
        remarks(&plan),
        [dropped("spell", "flag").replace("{}", "positive"), dropped("count", "text").replace("{}", "text")]
    );
    carry_out(&mut rig, &plan);
    assert_eq!(names(&rig), ["n0", "middle", "spell", "count"]);
    assert_eq!(inputs(&rig, "middle"), ["number = n0.sum"]);
    assert_eq!((rig.id("middle"), inputs(&rig, "spell"), inputs(&rig, "count")), (middle, vec![], vec![]));
    let node = rig.graph.node(middle).unwrap();
    assert_eq!((node.kind_name(), node.position(), node.note()), ("everything", Some([1.0, 2.0]), "kept"));
    // Literals stay where name, type and range allow.
    rig.graph.reset(middle, "number").unwrap();
    rig.put("middle.text", Literal::Text("five".to_owned()));
    rig.put("middle.boolean", Literal::Boolean(true));
    rig.put("middle.number", Literal::Number(2.0));
    let plan = compound::replace_kind(&rig.graph, &rig.catalogue, middle, "count").unwrap();
    let held = |input| format!("node \"middle\", input \"{input}\": what it holds is dropped: count has no such input");
    assert_eq!(remarks(&plan), [held("boolean"), held("number")]);
    carry_out(&mut rig, &plan);
    assert_eq!(inputs(&rig, "middle"), ["text = Text(\"five\")"]);
}

#[test]
fn links_move_to_ports_of_the_very_type() {
    let mut rig = Rig::default();
    rig.chain(3);
    rig.link("n0.sum", "n1.b");
    let n1 = rig.id("n1");
    let plan = compound::replace_kind(&rig.graph, &rig.catalogue, n1, "root").unwrap();
    assert_eq!(
        remarks(&plan),
        [
            "node \"n1\", input \"a\": its link moves to the input \"number\"",
            "node \"n1\", input \"b\": what it holds is dropped: root has no such input",
            "node \"n2\", input \"a\": its link comes from \"n1.root\" now",
        ]
    );
    carry_out(&mut rig, &plan);
    assert_eq!(inputs(&rig, "n1"), ["number = n0.sum"]);
    assert_eq!(inputs(&rig, "n2"), ["a = n1.root", "b = Number(1.0)"]);
}

#[test]
fn a_placeholder_becomes_what_it_was_meant_to_be() {
    let mut rig = Rig::default();
    let text = "(version: 1, nodes: { \"a\": (kind: \"add\"), \"c\": (kind: \"cuont\", hue: 3, inputs: { \
                \"count\": 5, \"text\": 3, \"extra\": 1, \"linked\": Link(\"a.sum\") }) })";
    rig.graph = file::from_text(&rig.catalogue, text).unwrap().graph;
    let c = rig.id("c");
    let plan = compound::replace_kind(&rig.graph, &rig.catalogue, c, "count").unwrap();
    assert_eq!(
        remarks(&plan),
        [
            "node \"c\", input \"extra\": what it holds is dropped: count has no such input",
            "node \"c\", input \"text\": what it holds is dropped: it takes a text such as Text(\"...\"), not the whole \
             number 3",
            "node \"c\", input \"linked\": what it holds is dropped: count has no such input",
        ]
    );
    carry_out(&mut rig, &plan);
    assert_eq!(inputs(&rig, "c"), ["count = Integer(5)"]);
    assert!(file::to_text(&rig.graph).contains("hue: 3"));
    let error = compound::replace_kind(&rig.graph, &rig.catalogue, c, "cuont").unwrap_err();
    assert!(error.to_string().contains("did you mean \"count\""), "{error}");
}

#[test]
fn a_dissolved_node_closes_its_links() {
    let mut rig = Rig::default();
    rig.chain(4);
    rig.add("sign", "sign");
    rig.add("spell", "spell");
    rig.link("n2.sum", "sign.number");
    rig.link("sign.positive", "spell.flag");
    let plan = compound::dissolve(&rig.graph, &rig.catalogue, rig.id("n2")).unwrap();
    assert_eq!(plan.remarks, []);
    carry_out(&mut rig, &plan);
    assert_eq!(inputs(&rig, "n3"), ["a = n1.sum", "b = Number(1.0)"]);
    assert_eq!(inputs(&rig, "sign"), ["number = n1.sum"]);
    let plan = compound::dissolve(&rig.graph, &rig.catalogue, rig.id("sign")).unwrap();
    assert_eq!(
        remarks(&plan),
        ["node \"spell\", input \"flag\": the link from \"sign.positive\" goes: nothing that fed \"sign\" fits here"]
    );
    carry_out(&mut rig, &plan);
    assert_eq!(inputs(&rig, "spell"), Vec::<String>::new());
    // Nothing feeds the first: what it fed stands alone.
    let n0 = rig.id("n0");
    let plan = compound::dissolve(&rig.graph, &rig.catalogue, n0).unwrap();
    assert_eq!(plan.remarks.len(), 1);
    carry_out(&mut rig, &plan);
    assert_eq!(compound::dissolve(&rig.graph, &rig.catalogue, n0), Err(GraphError::NoSuchNode));
}

#[test]
fn copies_keep_the_links_among_them() {
    let mut rig = Rig::default();
    rig.chain(3);
    // The first of them depends on the last: the order of a graph is not that of its links.
    rig.graph.reset(rig.id("n1"), "a").unwrap();
    rig.graph.reset(rig.id("n2"), "a").unwrap();
    rig.link("n2.sum", "n1.b");
    rig.link("n0.sum", "n2.b");
    rig.graph.set_position(rig.id("n1"), Some([1.0, 2.0])).unwrap();
    let selection = ids(&rig, &["n2", "n1", "n2"]);
    let plan = compound::duplicate(&rig.graph, &selection, Incoming::Keep, [10.0, 20.0]).unwrap();
    carry_out(&mut rig, &plan);
    assert_eq!(names(&rig), ["n0", "n1", "n2", "n1 2", "n2 2"]);
    assert_eq!(inputs(&rig, "n1 2"), ["b = n2 2.sum"]);
    assert_eq!(inputs(&rig, "n2 2"), ["b = n0.sum"]);
    assert_eq!(rig.graph.node(plan.nodes[0]).unwrap().position(), Some([11.0, 22.0]));
    let plan = compound::duplicate(&rig.graph, &selection, Incoming::Drop, [0.0; 2]).unwrap();
    carry_out(&mut rig, &plan);
    assert_eq!(inputs(&rig, "n2 3"), Vec::<String>::new());
    assert_eq!(inputs(&rig, "n1 3"), ["b = n2 3.sum"]);
    // A copy computes what its original computed.
    rig.evaluate(&["n1"]);
    assert_eq!(rig.ran(&["n1 2"]), Vec::<String>::new());
    rig.graph.remove(selection[0]).unwrap();
    let gone = compound::duplicate(&rig.graph, &selection, Incoming::Keep, [0.0; 2]);
    assert_eq!(gone, Err(GraphError::NoSuchNode));
    assert_eq!(compound::copy(&rig.graph, &selection), Err(GraphError::NoSuchNode));
}

const COPIED: &str = r#"(
    version: 1,
    nodes: {
        "n1": (
            kind: "add",
            inputs: {
                "a": Link("n0.sum"),
                "b": 1.0,
            },
        ),
        "n2": (
            kind: "add",
            inputs: {
                "a": Link("n1.sum"),
                "b": 1.0,
            },
        ),
    },
    layout: {
        "n2": (1.0, 2.0),
    },
)
"#;

#[test]
fn nodes_are_copied_as_text_and_pasted() {
    let mut rig = Rig::default();
    rig.chain(4);
    rig.graph.notes = "stay".to_owned();
    rig.graph.set_position(rig.id("n2"), Some([1.0, 2.0])).unwrap();
    let text = compound::copy(&rig.graph, &ids(&rig, &["n2", "n1"])).unwrap();
    assert_eq!(text, COPIED);
    let plan = compound::paste(&rig.graph, &rig.catalogue, &text, [5.0, 5.0]).unwrap();
    assert_eq!(plan.remarks, []);
    carry_out(&mut rig, &plan);
    assert_eq!(names(&rig), ["n0", "n1", "n2", "n3", "n1 2", "n2 2"]);
    assert_eq!(inputs(&rig, "n1 2"), ["a = n0.sum", "b = Number(1.0)"]);
    assert_eq!(inputs(&rig, "n2 2"), ["a = n1 2.sum", "b = Number(1.0)"]);
    assert_eq!(rig.graph.node(plan.nodes[1]).unwrap().position(), Some([6.0, 7.0]));
    // Into an empty graph, names are free and what was outside is missing.
    let mut other = Rig::default();
    let plan = compound::paste(&other.graph, &other.catalogue, &text, [0.0; 2]).unwrap();
    assert_eq!(
        remarks(&plan),
        ["node \"n1\", input \"a\": the link from \"n0.sum\" is dropped: no node is named \"n0\" here"]
    );
    carry_out(&mut other, &plan);
    assert_eq!(names(&other), ["n1", "n2"]);
    assert_eq!(inputs(&other, "n2"), ["a = n1.sum", "b = Number(1.0)"]);
    // A node of the name that does not fit is not linked.
    for (kind, reason) in
        [("spell", "spell has no such output here"), ("samples", "samples has no such output here"), ("add", "")]
    {
        let mut other = Rig::default();
        other.add(kind, "n0");
        let plan = compound::paste(&other.graph, &other.catalogue, &text, [0.0; 2]).unwrap();
        assert_eq!(plan.remarks.is_empty(), reason.is_empty());
        assert!(remarks(&plan).iter().all(|remark| remark.ends_with(reason)), "{:?}", plan.remarks);
        carry_out(&mut other, &plan);
    }
}

#[test]
fn a_link_of_another_type_is_not_pasted() {
    let mut rig = Rig::default();
    rig.add("sign", "n0");
    let text = COPIED.replace("n0.sum", "n0.text");
    let plan = compound::paste(&rig.graph, &rig.catalogue, &text, [0.0; 2]).unwrap();
    let expected = "node \"n1\", input \"a\": the link from \"n0.text\" is dropped: it gives text here, and number is \
                    needed";
    assert_eq!(remarks(&plan), [expected]);
    carry_out(&mut rig, &plan);
    // What does not fit within the text is no link to a node of that name here.
    rig.add("add", "outer");
    let text = "(version: 1, nodes: { \"outer\": (kind: \"sign\"), \"x\": (kind: \"add\", inputs: { \
                \"a\": Link(\"outer.sum\"), \"z\": Link(\"n0.text\"), \"b\": Link(\"nowhere\") }) })";
    let plan = compound::paste(&rig.graph, &rig.catalogue, text, [0.0; 2]).unwrap();
    assert_eq!(
        remarks(&plan),
        [
            "node \"x\", input \"a\": the link from \"outer.sum\" is dropped: it does not fit",
            "node \"x\", input \"b\": the link from \"nowhere\" is dropped: it is not an address",
            "node \"x\", input \"z\": the link from \"n0.text\" is dropped: add has no such input",
        ]
    );
    carry_out(&mut rig, &plan);
}

#[test]
fn what_is_unknown_survives_copy_and_paste() {
    let mut rig = Rig::default();
    let text = "(version: 1, nodes: { \"a\": (kind: \"add\"), \"u\": (kind: \"from-the-future\", hue: [1, 2], inputs: { \
                \"power\": Watts(3), \"in\": Link(\"a.sum\") }), \"v\": (kind: \"add\", inputs: { \"a\": Link(\"u.out\") }) })";
    rig.graph = file::from_text(&rig.catalogue, text).unwrap().graph;
    let copied = compound::copy(&rig.graph, &ids(&rig, &["u", "v"])).unwrap();
    let plan = compound::paste(&rig.graph, &rig.catalogue, &copied, [0.0; 2]).unwrap();
    assert_eq!(plan.remarks, []);
    carry_out(&mut rig, &plan);
    assert_eq!(inputs(&rig, "u 2"), ["in = a.sum", "power ? Watts(3)"]);
    assert_eq!(inputs(&rig, "v 2"), ["a = u 2.out"]);
    assert_eq!(file::to_text(&rig.graph).matches("hue: [1, 2]").count(), 2);
}

#[test]
fn what_is_no_graph_is_not_pasted() {
    let rig = Rig::default();
    let paste = |text| compound::paste(&rig.graph, &rig.catalogue, text, [0.0; 2]).unwrap_err();
    assert!(matches!(paste("Dear all,"), PasteError::File(_)));
    assert!(paste("").to_string().starts_with("the clipboard holds no nodes: 1:1: error:"));
    assert_eq!(paste("(version: 1, nodes: {})"), PasteError::Empty);
}

#[test]
fn an_outdated_plan_changes_nothing() {
    let mut rig = Rig::default();
    rig.chain(2);
    let plan = compound::duplicate(&rig.graph, &ids(&rig, &["n0", "n1"]), Incoming::Keep, [0.0; 2]).unwrap();
    rig.add("add", "since");
    let before = file::to_text(&rig.graph);
    let error = rig.graph.apply_all(&rig.catalogue, &plan.edits).unwrap_err();
    assert!(error.to_string().contains("plan the edit again"), "{error}");
    assert_eq!(file::to_text(&rig.graph), before);
}
