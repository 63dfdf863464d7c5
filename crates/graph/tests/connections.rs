//! What may be linked to what, and what edits do to links.

#![allow(clippy::unwrap_used, reason = "in tests a failing unwrap is a failing test")]

mod kinds;

use kinds::Rig;
use maquette_graph::{ConnectError, GraphError, Literal, Source, file};

fn text(rig: &Rig) -> String {
    file::to_text(&rig.graph)
}

fn refused(rig: &mut Rig, from: &str, to: &str) -> String {
    let before = text(rig);
    let error = rig.try_link(from, to).unwrap_err().to_string();
    assert_eq!(text(rig), before, "a refused link must leave the graph as it was");
    error
}

#[test]
fn equal_types_connect_and_different_ones_are_refused_by_name() {
    let mut rig = Rig::default();
    for (kind, name) in [("add", "sum"), ("sign", "sign"), ("spell", "spell"), ("samples", "list"), ("count", "count")]
    {
        rig.add(kind, name);
    }
    rig.link("sum.sum", "sign.number");
    rig.link("sign.positive", "spell.flag");
    assert_eq!(
        refused(&mut rig, "sign.text", "spell.flag"),
        "\"sign.text\" gives text, but \"spell.flag\" takes boolean: no conversion between them keeps everything"
    );
    assert_eq!(
        refused(&mut rig, "list.samples", "sum.a"),
        "\"list.samples\" gives samples, but \"sum.a\" takes number: no conversion between them keeps everything"
    );
    assert_eq!(
        refused(&mut rig, "sum.sum", "count.count"),
        "\"sum.sum\" gives number, but \"count.count\" takes integer: no conversion between them keeps everything"
    );
}

#[test]
fn an_integer_enters_a_number_and_what_would_lose_digits_fails_by_value() {
    let mut rig = Rig::default();
    rig.add("whole", "whole");
    rig.add("add", "sum");
    rig.link("whole.integer", "sum.a");
    rig.put("whole.base", Literal::Integer(7));
    assert_eq!(rig.number("sum.sum"), Some(7.0));

    let large = (1_i64 << 53) + 1;
    rig.put("whole.base", Literal::Integer(large));
    let evaluation = rig.evaluate(&["sum"]);
    assert_eq!(
        kinds::state(&evaluation, rig.id("sum")),
        "failed: input \"a\": 9007199254740993 is too large to become a number without loss"
    );
}

#[test]
fn a_second_link_replaces_the_first() {
    let mut rig = Rig::default();
    for name in ["one", "two", "sum"] {
        rig.add("add", name);
    }
    rig.set("one.a", 1.0);
    rig.set("two.a", 2.0);
    rig.link("one.sum", "sum.a");
    rig.link("two.sum", "sum.a");
    assert_eq!(rig.number("sum.sum"), Some(2.0));
    assert!(rig.graph.fed_by(rig.id("one")).is_empty());
    assert_eq!(rig.graph.fed_by(rig.id("two")), [(rig.id("sum"), "a".to_owned())]);

    rig.set("sum.a", 5.0);
    assert!(rig.graph.fed_by(rig.id("two")).is_empty(), "a literal replaces a link");
    rig.link("two.sum", "sum.a");
    rig.graph.reset(rig.id("sum"), "a").unwrap();
    assert!(rig.graph.fed_by(rig.id("two")).is_empty(), "so does the default");
    assert_eq!(rig.number("sum.sum"), Some(0.0));
}

#[test]
fn one_output_may_feed_both_inputs_of_a_node() {
    let mut rig = Rig::default();
    rig.add("add", "one");
    rig.add("add", "twice");
    rig.set("one.a", 3.0);
    rig.link("one.sum", "twice.a");
    rig.link("one.sum", "twice.b");
    assert_eq!(rig.number("twice.sum"), Some(6.0));
    let twice = rig.id("twice");
    assert_eq!(rig.graph.fed_by(rig.id("one")), [(twice, "a".to_owned()), (twice, "b".to_owned())]);
}

#[test]
fn a_cycle_is_refused_and_named_all_around() {
    let mut rig = Rig::default();
    rig.chain(4);
    assert_eq!(
        refused(&mut rig, "n3.sum", "n1.b"),
        "the link would close the cycle n1 -> n2 -> n3 -> n1: a node can't depend on its own result"
    );
    assert_eq!(
        refused(&mut rig, "n2.sum", "n2.b"),
        "the link would close the cycle n2 -> n2: a node can't depend on its own result"
    );
    rig.link("n0.sum", "n3.b");
    assert_eq!(rig.number("n3.sum"), Some(4.0));
}

#[test]
fn a_link_that_replaces_the_only_way_back_is_no_cycle() {
    let mut rig = Rig::default();
    rig.chain(2);
    rig.graph.reset(rig.id("n1"), "a").unwrap();
    rig.link("n1.sum", "n0.a");
    assert_eq!(rig.number("n0.sum"), Some(2.0));
}

#[test]
fn unknown_ports_are_refused_with_those_that_exist() {
    let mut rig = Rig::default();
    rig.add("sign", "sign");
    rig.add("add", "sum");
    assert_eq!(
        refused(&mut rig, "sign.negative", "sum.a"),
        "node \"sign\" (kind sign) has no output \"negative\"; it has positive, text"
    );
    assert_eq!(
        refused(&mut rig, "sum.sum", "sign.numbr"),
        "node \"sign\" (kind sign) has no input \"numbr\"; it has number"
    );
    let error = rig.graph.set(rig.id("sum"), "c", Literal::Number(1.0)).unwrap_err();
    assert_eq!(error.to_string(), "node \"sum\" (kind add) has no input \"c\"; it has a, b");
}

#[test]
fn gone_nodes_are_refused() {
    let mut rig = Rig::default();
    let gone = rig.add("add", "gone");
    let here = rig.add("add", "here");
    rig.graph.remove(gone).unwrap();
    assert_eq!(rig.graph.connect(&rig.catalogue, gone, "sum", here, "a"), Err(ConnectError::NoSuchNode));
    assert_eq!(rig.graph.connect(&rig.catalogue, here, "sum", gone, "a"), Err(ConnectError::NoSuchNode));
    assert_eq!(rig.graph.set(gone, "a", Literal::Number(1.0)), Err(GraphError::NoSuchNode));
    assert_eq!(rig.graph.reset(gone, "a"), Err(GraphError::NoSuchNode));
    assert_eq!(rig.graph.remove(gone), Err(GraphError::NoSuchNode));
    assert_eq!(rig.graph.rename(gone, "back"), Err(GraphError::NoSuchNode));
    assert_eq!(rig.graph.set_position(gone, None), Err(GraphError::NoSuchNode));
    assert_eq!(rig.graph.set_note(gone, "note"), Err(GraphError::NoSuchNode));
    let again = rig.add("add", "gone");
    assert_ne!(again, gone, "an identity is never used again");
}

#[test]
fn a_rename_keeps_links_and_frees_the_old_name() {
    let mut rig = Rig::default();
    rig.chain(3);
    rig.graph.rename(rig.id("n1"), "middle").unwrap();
    assert!(text(&rig).contains("Link(\"middle.sum\")"));
    assert_eq!(rig.number("n2.sum"), Some(3.0));
    assert_eq!(rig.graph.find("n1"), None);
    rig.add("add", "n1");
    let middle = rig.id("middle");
    assert_eq!(rig.graph.rename(middle, "n0"), Err(GraphError::DuplicateName("n0".to_owned())));
    assert_eq!(rig.graph.rename(middle, "middle"), Ok(()));
    assert_eq!(rig.graph.find("middle"), Some(middle));
}

#[test]
fn removing_a_node_drops_the_links_to_and_from_it() {
    let mut rig = Rig::default();
    rig.chain(3);
    rig.graph.remove(rig.id("n1")).unwrap();
    assert_eq!(rig.graph.node(rig.id("n2")).unwrap().source("a"), None);
    assert!(rig.graph.fed_by(rig.id("n0")).is_empty());
    assert_eq!(rig.number("n2.sum"), Some(1.0));
    // What was behind n1 is free to stand before n0 now.
    rig.link("n2.sum", "n0.a");
    assert_eq!(rig.number("n0.sum"), Some(2.0));
}

#[test]
fn names_that_can_not_be_written_are_refused() {
    let mut rig = Rig::default();
    for name in ["", " a", "a ", "a.b", "a\"b", "a\nb", "a/b", &"x".repeat(201)] {
        let error = rig.graph.add(&rig.catalogue, "add", name).unwrap_err();
        assert_eq!(error, GraphError::BadName(name.to_owned()));
        assert!(error.to_string().ends_with("use letters, digits, spaces, '-' and '_', at most 200 characters"));
    }
    for name in ["a b", "Größe", "衣服-2", "x_1", &"x".repeat(200)] {
        rig.add("add", name);
    }
    assert_eq!(rig.graph.nodes().len(), 5);
}

#[test]
fn an_unknown_kind_is_refused_with_a_suggestion() {
    let mut rig = Rig::default();
    let error = rig.graph.add(&rig.catalogue, "mesure", "m").unwrap_err();
    assert_eq!(error.to_string(), "no node kind is named \"mesure\"; did you mean \"measure\"?");
    let error = rig.graph.add(&rig.catalogue, "zzz", "m").unwrap_err();
    assert_eq!(error.to_string(), "no node kind is named \"zzz\"");
    assert_eq!(rig.graph.nodes().len(), 0);
}

#[test]
fn literals_that_do_not_fit_are_refused_and_change_nothing() {
    let mut rig = Rig::default();
    let all = rig.add("everything", "all");
    let list = rig.add("measure", "measure");
    let before = text(&rig);
    let mut refused = |node, input: &str, literal| rig.graph.set(node, input, literal).unwrap_err().to_string();
    let cases = [
        (all, "number", Literal::Number(f64::NAN), "it is not a finite number"),
        (all, "number", Literal::Number(f64::INFINITY), "it is not a finite number"),
        (all, "length", Literal::Number(11.0), "11 m is out of range: give 0.001 to 10 m"),
        (
            all,
            "integer",
            Literal::Number(2.0),
            "it takes a whole number such as 64, not the number 2.0: leave out the decimal point",
        ),
        (all, "integer", Literal::Number(2.5), "it takes a whole number such as 64, not the number 2.5"),
        (all, "number", Literal::Boolean(true), "it takes a number such as 0.5, not true"),
        (all, "text", Literal::Choice("down".into()), "it takes a text such as Text(\"...\"), not a choice"),
        (all, "choice", Literal::Choice("sideways".into()), "\"sideways\" is not an option: choose one of down, up"),
        (all, "vector", Literal::Vector([0.0, f64::NAN, 0.0]), "component 1 is not a finite number"),
        (list, "samples", Literal::Number(1.0), "it takes samples from a link; a literal can't stand here"),
    ];
    for (node, input, literal, reason) in cases {
        let name = if node == all { "all" } else { "measure" };
        assert_eq!(refused(node, input, literal), format!("node \"{name}\", input \"{input}\": {reason}"));
    }
    assert_eq!(text(&rig), before);
}

#[test]
fn an_integer_at_a_numbers_input_becomes_that_number() {
    let mut rig = Rig::default();
    let sum = rig.add("add", "sum");
    rig.put("sum.a", Literal::Integer(3));
    assert!(matches!(
        rig.graph.node(sum).unwrap().source("a"),
        Some(Source::Literal { literal: Literal::Number(3.0), .. })
    ));
}

#[test]
fn a_placeholder_refuses_numbers_that_no_file_can_hold() {
    let rig = Rig::default();
    let mut loaded = file::from_text(&rig.catalogue, "(version: 1, nodes: {\"p\": (kind: \"newer\")})").unwrap();
    let placeholder = loaded.graph.find("p").unwrap();
    let error = loaded.graph.set(placeholder, "x", Literal::Number(f64::NAN)).unwrap_err();
    assert_eq!(error.to_string(), "node \"p\", input \"x\": it is not a finite number");
    loaded.graph.set(placeholder, "x", Literal::Number(1.5)).unwrap();
    assert!(file::to_text(&loaded.graph).contains("\"x\": 1.5,"));
}

#[test]
fn whole_numbers_that_would_be_rounded_are_refused_as_literals_and_on_links() {
    let mut rig = Rig::default();
    let everything = rig.add("everything", "all");
    rig.add("whole", "whole");
    let exact = 1_i64 << 53;
    let words = "9007199254740993 is too large to become a number without loss";
    rig.put("all.number", Literal::Integer(exact));
    rig.put("all.number", Literal::Integer(-exact));
    let refused = rig.graph.set(everything, "number", Literal::Integer(exact + 1)).unwrap_err();
    assert_eq!(refused.to_string(), format!("node \"all\", input \"number\": {words}"));
    rig.link("whole.integer", "all.number");
    rig.put("whole.base", Literal::Integer(exact + 1));
    let evaluation = rig.evaluate(&["all"]);
    assert_eq!(kinds::state(&evaluation, everything), format!("failed: input \"number\": {words}"));
    rig.put("whole.base", Literal::Integer(exact));
    assert!(rig.evaluate(&["all"]).is_complete());
}
