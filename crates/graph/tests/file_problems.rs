//! Every problem a file can have is reported at its place, and what is not understood is kept.

#![allow(clippy::unwrap_used, clippy::panic, reason = "in tests a failing unwrap is a failing test")]

mod kinds;

use maquette_graph::file::{self, FileError, Loaded, Severity};
use maquette_graph::{Catalogue, Literal, Source};

fn load(text: &str) -> Loaded {
    file::from_text(&kinds::catalogue(), text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn problems(text: &str) -> Vec<String> {
    load(text).problems.iter().map(ToString::to_string).collect()
}

/// A file whose nodes begin at line 4, column 9.
fn nodes(nodes: &str) -> String {
    format!("(\n    version: 1,\n    nodes: {{\n        {nodes}\n    }},\n)\n")
}

/// A node "n" whose inputs begin at line 4, column 1.
fn inputs(kind: &str, inputs: &str) -> String {
    format!("(version: 1, nodes: {{\"n\": (\nkind: \"{kind}\",\ninputs: {{\n{inputs}\n}})}})")
}

/// Loads, saves, and loads again: the same problems but for their places, and nothing lost.
#[track_caller]
fn assert_kept(text: &str, pieces: &[&str]) {
    let catalogue = kinds::catalogue();
    let first = load(text);
    let saved = file::to_text(&first.graph);
    for piece in pieces {
        assert!(saved.contains(piece), "{piece} is lost in\n{saved}");
    }
    let again = file::from_text(&catalogue, &saved).unwrap_or_else(|error| panic!("{error}\n{saved}"));
    let messages = |loaded: &Loaded| {
        let mut messages: Vec<_> =
            loaded.problems.iter().map(|p| (p.severity, p.message.clone(), p.remedy.clone())).collect();
        messages.sort();
        messages
    };
    assert_eq!(messages(&again), messages(&first), "{saved}");
    assert_eq!(file::to_text(&again.graph), saved);
}

#[test]
fn an_unknown_kind_is_kept_digit_for_digit() {
    let text = nodes(
        "\"a\": (kind: \"newer\", inputs: { \"x\": 0.50, \"y\": Torus( 1, 0x1F ), \"z\": Link(\"b.sum\") }),\n        \
                      \"b\": (kind: \"add\", inputs: { \"a\": Link(\"a.anything\") }),",
    );
    assert_eq!(
        problems(&text),
        [
            "4:21: error: node \"a\": the node kind \"newer\" is unknown; `maquette nodes` lists all kinds; a newer version may have it",
            "5:43: error: node \"b\", input \"a\": the link would close the cycle b -> a -> b: a node can't depend on its own result; remove one of its links"
        ]
    );
    let text = text.replace("Link(\"a.anything\")", "3");
    assert_kept(&text, &["kind: \"newer\"", "\"x\": 0.50,", "\"y\": Torus( 1, 0x1F ),", "\"z\": Link(\"b.sum\"),"]);
    // The link is a real one: it follows when the node is renamed.
    let mut loaded = load(&text);
    let b = loaded.graph.find("b").unwrap();
    loaded.graph.rename(b, "c").unwrap();
    assert!(file::to_text(&loaded.graph).contains("\"z\": Link(\"c.sum\"),"));
}

#[test]
fn a_misspelt_kind_gets_a_suggestion() {
    assert_eq!(
        problems(&nodes("\"a\": (kind: \"mesure\"),")),
        [
            "4:21: error: node \"a\": the node kind \"mesure\" is unknown; did you mean \"measure\"? `maquette nodes` lists all kinds"
        ]
    );
}

#[test]
fn a_kind_that_is_missing_or_no_text() {
    assert_eq!(
        problems(&nodes("\"a\": (inputs: {}),")),
        ["4:9: error: node \"a\": the field \"kind\" is missing; add kind: \"...\"; `maquette nodes` lists them"]
    );
    assert_kept(&nodes("\"a\": (inputs: { \"x\": 1 }),"), &["\"x\": 1"]);
    assert_eq!(
        problems(&nodes("\"a\": (kind: add),")),
        ["4:21: error: node \"a\": the field \"kind\" is not a text; write it in double quotes"]
    );
    assert_kept(&nodes("\"a\": (kind: add),"), &["kind: add,"]);
    assert_eq!(
        problems(&nodes("\"a\": (kind: \"\"),")),
        [
            "4:21: error: node \"a\": the node kind \"\" is unknown; `maquette nodes` lists all kinds; a newer version may have it"
        ]
    );
}

#[test]
fn an_unknown_input_is_kept_with_a_suggestion() {
    let text = inputs(
        "count",
        "\"cuont\": 3,\n\"text\": Text(\"x\"),\n  \"zzz\": Unheard(of: 1),\n\"later\": Link(\"nowhere.x\"),",
    );
    assert_eq!(
        problems(&text),
        [
            "4:1: error: node \"n\", input \"cuont\": count has no such input; did you mean \"count\"? It is kept, but has no effect",
            "6:3: error: node \"n\", input \"zzz\": count has no such input; count has count, text; it is kept, but has no effect",
            "7:1: error: node \"n\", input \"later\": count has no such input; count has count, text; it is kept, but has no effect",
            "7:10: error: node \"n\", input \"later\": it is linked to \"nowhere\", and no node has that name; add the node, or remove the link",
        ]
    );
    assert_kept(&text, &["\"cuont\": 3,", "\"zzz\": Unheard(of: 1),", "\"later\": Link(\"nowhere.x\"),"]);
    assert_eq!(
        problems(&inputs("forgetful", "\"x\": 1"))[0],
        "4:1: error: node \"n\", input \"x\": forgetful has no such input; forgetful has none; it is kept, but has no effect"
    );
}

#[test]
fn a_link_into_an_unknown_input_is_said_once() {
    let text = nodes("\"a\": (kind: \"add\"),\n\"b\": (kind: \"add\", inputs: { \"c\": Link(\"a.sum\") }),");
    assert_eq!(
        problems(&text),
        ["5:30: error: node \"b\", input \"c\": add has no such input; add has a, b; it is kept, but has no effect"]
    );
    assert_kept(&text, &["\"c\": Link(\"a.sum\")"]);
}

#[test]
fn unknown_fields_are_warnings_at_their_names() {
    let text = "(\n  version: 1,\n  colour_space: (\n    // kept\n    \"x\",\n  ),\n  nodes: {\n    \"a\": (kind: \"add\", quiet: true, r#is-old /* odd */ : [1, 2]),\n  },\n  größe: 5,\n)";
    assert_eq!(
        problems(text),
        [
            "3:3: warning: the field \"colour_space\" is unknown to this version; it is kept; check its spelling, or update Maquette",
            "8:24: warning: node \"a\": the field \"quiet\" is unknown to this version; it is kept; check its spelling, or update Maquette",
            "8:58: warning: node \"a\": the field \"is-old\" is unknown to this version; it is kept; check its spelling, or update Maquette",
            "10:3: warning: the field \"größe\" is unknown to this version; it is kept; check its spelling, or update Maquette",
        ]
    );
    assert!(!load(text).has_errors());
    assert_kept(
        text,
        &["colour_space: (\n    // kept\n    \"x\",\n  ),", "quiet: true,", "r#is-old: [1, 2],", "größe: 5,"],
    );
}

#[test]
fn texts_that_are_none_are_kept() {
    let text = "(version: 1, notes: 5, nodes: {\"a\": (kind: \"add\", note: [1])})";
    assert_eq!(
        problems(text),
        [
            "1:21: error: the field \"notes\" is not a text; write it in double quotes",
            "1:57: error: node \"a\": the field \"note\" is not a text; write it in double quotes",
        ]
    );
    assert_kept(text, &["notes: 5,", "note: [1],"]);
    // Once there is a note, the unread one must give way, or the field would be there twice.
    let mut loaded = load(text);
    let a = loaded.graph.find("a").unwrap();
    loaded.graph.notes = "new".to_owned();
    loaded.graph.set_note(a, "new").unwrap();
    assert!(load(&file::to_text(&loaded.graph)).problems.is_empty());
}

#[test]
fn frames_and_pictures_that_are_none_are_kept() {
    let text = "(version: 1, nodes: {\"a\": (kind: \"add\", collapsed: 3)}, frames: [(title: \"x\")], references: 7)";
    assert_eq!(
        problems(text),
        [
            "1:52: error: node \"a\": the field \"collapsed\" is neither true nor false; write collapsed: true, or remove it",
            "1:65: warning: the field \"frames\" can't be understood: Unexpected missing field named `colour` in `Frame`; \
             it is kept as it is; mend it, or update Maquette",
            "1:93: warning: the field \"references\" can't be understood: Expected opening `[`; it is kept as it is; mend it, \
             or update Maquette",
        ]
    );
    assert_kept(text, &["collapsed: 3,", "frames: [(title: \"x\")],", "references: 7,"]);
    // What a newer version knows more of a frame is not lost either.
    let newer =
        "(version: 1, nodes: {}, frames: [(title: \"x\", colour: (1, 0, 0), at: (0, 0), size: (1, 1), round: true)])";
    assert_kept(newer, &["round: true"]);
    let flat = "(version: 1, nodes: {}, frames: [(colour: (1, 0, 0), at: (0, 0), size: (1, 0))])";
    assert!(problems(flat)[0].contains("frame 0 needs finite numbers, and a width and height above 0"));
    assert_kept(flat, &["size: (1, 0)"]);
}

#[test]
fn names_without_quotes_are_taken_as_they_are() {
    let text = nodes("rails: (kind: \"add\", inputs: { a: 3.5 }),");
    assert_eq!(
        problems(&text),
        [
            "4:9: error: a node's name is not a text; write it in double quotes",
            "4:40: error: node \"rails\": an input's name is not a text; write it in double quotes",
        ]
    );
    let loaded = load(&text);
    assert!(load(&file::to_text(&loaded.graph)).problems.is_empty(), "saving repairs them");
    assert!(file::to_text(&loaded.graph).contains("\"a\": 3.5,"));
}

#[test]
fn literals_that_can_not_be_read_are_kept() {
    let expected = "write a number, true, false, Link(\"node.output\"), Parameter(\"...\"), Text(\"...\"), Choice(\"...\"), Vector(x, y, z), \
                    Colour(r, g, b, a), File(\"...\") or Strokes([...])";
    let cases = [
        ("\"number\": \"n.sum\"", 11, "a bare text does not say what it is; write Link(\"node.output\"), Text(\"...\"), Choice(\"...\") or File(\"...\")".to_owned()),
        ("\"number\": 1..2", 12, format!("more text follows where the end is expected; {expected}")),
        ("\"vector\": Vector(1, 2)", 22, format!("Vector takes 3 numbers, and 2 are given; {expected}")),
        ("\"vector\": Vektor(1, 2, 3)", 11, format!("\"Vektor\" is not known; {expected}")),
        ("\"vector\": (1, 2, 3)", 11, format!("the name of a field is expected here, without quotes; {expected}")),
    ];
    for (input, column, message) in cases {
        let text = inputs("everything", input);
        let problems = problems(&text);
        let (_, piece) = input.split_once(": ").unwrap();
        let port = input.split('"').nth(1).unwrap();
        assert_eq!(
            problems,
            [format!("4:{column}: error: node \"n\", input \"{port}\": the value can't be read: {message}")]
        );
        assert_kept(&text, &[piece]);
    }
}

#[test]
fn literals_that_do_not_fit_are_kept_with_the_reason() {
    let cases = [
        ("\"integer\": 64.0", "it takes a whole number such as 64, not the number 64.0: leave out the decimal point"),
        (
            "\"integer\": 9223372036854775808",
            "it takes a whole number such as 64, not the number 9.223372036854776e18: it is too large for one",
        ),
        ("\"integer\": 1e3", "it takes a whole number such as 64, not the number 1000.0: leave out the decimal point"),
        ("\"number\": NaN", "it is not a finite number"),
        ("\"number\": inf", "it is not a finite number"),
        ("\"number\": -inf", "it is not a finite number"),
        ("\"number\": 1e999", "it is not a finite number"),
        ("\"length\": 0", "0 m is out of range: give 0.001 to 10 m"),
        ("\"vector\": Vector(0.0, inf, 0.0)", "component 1 is not a finite number"),
        (
            "\"colour\": Colour(0.0, 1.5, 0.0, 1.0)",
            "green is 1.5, which is out of range: give 0 to 1 for each component",
        ),
        (
            "\"colour\": Colour(0.0, 1.0, 0.0, -0.1)",
            "alpha is -0.1, which is out of range: give 0 to 1 for each component",
        ),
        ("\"number\": 9007199254740993", "9007199254740993 is too large to become a number without loss"),
        ("\"colour\": Vector(0.0, 0.0, 0.0)", "it takes a colour such as Colour(0.8, 0.7, 0.6, 1.0), not a vector"),
        ("\"choice\": Choice(\"upp\")", "\"upp\" is not an option: choose one of down, up"),
        ("\"choice\": Text(\"up\")", "it takes a choice such as Choice(\"...\"), not a text"),
        ("\"boolean\": 1", "it takes a yes or no such as true, not the whole number 1"),
        ("\"samples\": 1", "it takes samples from a link; a literal can't stand here"),
        (
            "\"strokes\": Strokes([(name: \"s\", points: [(0, 0), (0, NaN)])])",
            "stroke 0 \"s\", point 1 has a coordinate that is not a finite number",
        ),
    ];
    for (input, reason) in cases {
        let text = inputs("everything", &format!("  {input}"));
        let (port, piece) = input.split_once(": ").unwrap();
        assert_eq!(problems(&text), [format!("4:{}: error: node \"n\", input {port}: {reason}", port.len() + 5)]);
        assert_kept(&text, &[piece]);
    }
}

#[test]
fn a_problem_within_a_stroke_is_placed_within_it() {
    let text = inputs(
        "everything",
        "\"strokes\": Strokes([\n  (name: \"a\", points: [\n    (0.0, 0.0),\n    (0.0, \"x\"),\n  ]),\n])",
    );
    let loaded = load(&text);
    assert_eq!((loaded.problems[0].line, loaded.problems[0].column), (7, 11), "{}", loaded.problems[0]);
    assert_kept(&text, &["(0.0, \"x\"),"]);
    // Fields of a stroke that are not known must not get lost either.
    assert_kept(
        &inputs("everything", "\"strokes\": Strokes([(points: [], width: 3)])"),
        &["Strokes([(points: [], width: 3)])"],
    );
    assert_kept(&inputs("everything", "\"strokes\": Strokes([(points: [(1, 2, 3, 4)])])"), &["(1, 2, 3, 4)"]);
}

#[test]
fn numbers_may_be_written_in_many_ways() {
    let number = |text: &str| {
        let loaded = load(&inputs("everything", &format!("\"number\": {text}")));
        assert!(loaded.problems.is_empty(), "{text}: {}", loaded.problems[0]);
        match loaded.graph.node(loaded.graph.find("n").unwrap()).unwrap().source("number").cloned() {
            Some(Source::Literal { literal: Literal::Number(number), .. }) => number,
            other => panic!("{text} is {other:?}"),
        }
    };
    let cases = [
        ("3", 3.0),
        ("-3", -3.0),
        ("+3", 3.0),
        ("1_000", 1000.0),
        ("0x10", 16.0),
        (".5", 0.5),
        ("5.", 5.0),
        ("-.5e-3", -0.5e-3),
        ("1e3", 1000.0),
        ("1E3", 1000.0),
        ("-0.0", -0.0),
        ("12345678901234567890123456789", 1.234_567_890_123_456_8e28),
    ];
    for (text, expected) in cases {
        assert_eq!(number(text).to_bits(), f64::to_bits(expected), "{text}");
    }
}

#[test]
fn raw_strings_and_comments_are_understood() {
    let text = "// before\n(/* a /* nested */ one */version: 1, // version\n nodes: { // \"not\": (a node),\n r\"a\": (kind: r#\"everything\"#, inputs: {\n\
                \"text\" /* t */ : /* u */ Text(r\"C:\\no\\escape // no comment\") /* v */, // w\n\"number\": 2.5// x\n,\n}),\n},\n)// end";
    let loaded = load(text);
    assert_eq!(loaded.problems, []);
    let saved = file::to_text(&loaded.graph);
    assert!(saved.contains("\"text\": Text(\"C:\\\\no\\\\escape // no comment\"),"), "{saved}");
    assert!(saved.contains("\"number\": 2.5,"), "{saved}");
    assert_eq!(loaded.place(loaded.graph.find("a").unwrap(), Some("text")), Some((5, 26)));
    assert_eq!(
        loaded.place(loaded.graph.find("a").unwrap(), Some("boolean")),
        Some((4, 2)),
        "not in the file: the node"
    );
}

#[test]
fn double_names_are_kept_under_another() {
    let text = nodes(
        "\"a\": (kind: \"add\"),\n\"a\": (kind: \"sign\"),\n\"b.c\": (kind: \"add\"),\n\"\": (kind: \"add\"),\n\"d\": (kind: \"add\", inputs: { \"a\": Link(\"b.c.sum\"), \"b\": Link(\"a.sum\") }),",
    );
    assert_eq!(
        problems(&text),
        [
            "5:1: error: node \"a\": a node named \"a\" is already there: choose another name; it is kept as \"a-2\"",
            "6:1: error: node \"b.c\": \"b.c\" can't name a node: use letters, digits, spaces, '-' and '_', at most 200 characters; it is kept as \"b-c\"",
            "7:1: error: node \"\": \"\" can't name a node: use letters, digits, spaces, '-' and '_', at most 200 characters; it is kept as \"node\"",
        ]
    );
    let loaded = load(&text);
    let names: Vec<_> = loaded.graph.nodes().map(|(_, n)| (n.name().to_owned(), n.kind_name().to_owned())).collect();
    let expected = [("a", "add"), ("a-2", "sign"), ("b-c", "add"), ("node", "add"), ("d", "add")];
    assert_eq!(names, expected.map(|(name, kind)| (name.to_owned(), kind.to_owned())));
    assert!(load(&file::to_text(&loaded.graph)).problems.is_empty());
    assert!(
        file::to_text(&loaded.graph).contains("\"a\": Link(\"b-c.sum\"),"),
        "links follow to the name it is kept under"
    );
}

#[test]
fn of_an_input_that_occurs_twice_the_last_counts() {
    let node =
        |inputs: &str| nodes(&format!("\"z\": (kind: \"add\"),\n\"a\": (kind: \"add\", inputs: {{ {inputs} }}),"));
    for (inputs, kept) in [
        ("\"a\": 1, \"a\": 2", "\"a\": 2.0,"),
        ("\"a\": Link(\"z.sum\"), \"a\": 2", "\"a\": 2.0,"),
        ("\"a\": 1, \"a\": Link(\"z.sum\")", "\"a\": Link(\"z.sum\"),"),
    ] {
        let text = node(inputs);
        let second = 30 + inputs.rfind("\"a\"").unwrap();
        assert_eq!(
            problems(&text),
            [format!(
                "5:{second}: error: node \"a\", input \"a\": the input occurs twice; keep one; the last one is used"
            )]
        );
        let saved = file::to_text(&load(&text).graph);
        assert!(saved.contains(kept), "{saved}");
        assert_eq!(saved.matches("\"a\": ").count(), 2, "the node and one input: {saved}");
    }
}

#[test]
fn links_to_nowhere_get_suggestions_and_are_kept() {
    let text = nodes(
        "\"rails\": (kind: \"sign\"),\n\"a\": (kind: \"add\", inputs: { \"a\": Link(\"rials.sum\") }),\n\
         \"b\": (kind: \"spell\", inputs: { \"flag\": Link(\"rails.positve\") }),\n\"c\": (kind: \"spell\", inputs: { \"flag\": Link(\"rails\") }),\n\
         \"d\": (kind: \"add\", inputs: { \"a\": Link(\"rails.text\"), \"b\": Link(\"rails.qqq\") }),\n\"e\": (kind: \"add\", inputs: { \"a\": Link(\"e.sum\") }),",
    );
    assert_eq!(
        problems(&text),
        [
            "5:35: error: node \"a\", input \"a\": it is linked to \"rials\", and no node has that name; did you mean \"rails\"?",
            "6:40: error: node \"b\", input \"flag\": node \"rails\" (kind sign) has no output \"positve\"; it has positive, text; did you mean \"rails.positive\"?",
            "7:40: error: node \"c\", input \"flag\": \"rails\" is not an address; write Link(\"node.output\")",
            "8:35: error: node \"d\", input \"a\": \"rails.text\" gives text, but \"d.a\" takes number: no conversion between them keeps everything; link another output",
            "8:60: error: node \"d\", input \"b\": node \"rails\" (kind sign) has no output \"qqq\"; it has positive, text; link another output",
            "9:35: error: node \"e\", input \"a\": the link would close the cycle e -> e: a node can't depend on its own result; remove one of its links",
        ]
    );
    assert_kept(&text, &["Link(\"rials.sum\")", "Link(\"rails.positve\")", "Link(\"rails\")", "Link(\"e.sum\")"]);
}

#[test]
fn a_cycle_is_reported_once_and_the_rest_loads() {
    let node =
        |name: &str, from: &str| format!("\"{name}\": (kind: \"add\", inputs: {{ \"a\": Link(\"{from}.sum\") }}),\n");
    let text = nodes(&[node("a", "c"), node("b", "a"), node("c", "b"), node("d", "c"), node("e", "d")].concat());
    assert_eq!(
        problems(&text),
        [
            "6:35: error: node \"c\", input \"a\": the link would close the cycle c -> a -> b -> c: a node can't depend on its own result; remove one of its links"
        ]
    );
    let loaded = load(&text);
    let links = loaded.graph.nodes().filter(|(_, n)| matches!(n.source("a"), Some(Source::Link(_)))).count();
    assert_eq!(links, 4);
    assert_kept(&text, &["Link(\"b.sum\")"]);
    // Two rings, each cut once.
    let text = nodes(&[node("a", "b"), node("b", "a"), node("c", "d"), node("d", "c"), node("e", "a")].concat());
    let places: Vec<_> = load(&text).problems.iter().map(|p| p.line).collect();
    assert_eq!(places, [5, 7]);
}

#[test]
fn versions() {
    let version = |text: &str| format!("({text}nodes: {{}}, later: 3)");
    let unknown = "the field \"later\" is unknown to this version; it is kept; check its spelling, or update Maquette";
    assert_eq!(
        problems(&version("")),
        [
            "1:1: error: the field \"version\" is missing; add version: 1".to_owned(),
            format!("1:13: warning: {unknown}")
        ]
    );
    for bad in ["0", "-1", "1.5", "\"1\"", "99999999999"] {
        let text = version(&format!("version: {bad}, "));
        assert_eq!(
            problems(&text)[0],
            format!("1:11: error: the version {bad} is not a whole number from 1 on; write 1")
        );
        assert_kept(&text, &[&format!("version: {bad},")]);
    }
    let text = version("version: 2, ");
    assert_eq!(
        problems(&text)[0],
        "1:11: error: the file has format version 2, and this Maquette reads 1; update Maquette"
    );
    // Written back as version 1 it would lie about what it holds.
    assert_kept(&text, &["version: 2,", "later: 3,"]);
    assert_eq!(file::to_text(&load(&text).graph).matches("version").count(), 1);
}

#[test]
fn layout_entries_that_fit_no_node_are_kept() {
    let text = "(version: 1, nodes: {\"a\": (kind: \"add\"), \"b\": (kind: \"add\"), \"c\": (kind: \"add\")}, layout: {\n\"a\": (1, 2),\n\"gone\": (3.0, 4.0),\n\"b\": (1, NaN),\n\"c\": frame( 3 ),\n\"a\": (5, 6),\n})";
    assert_eq!(
        problems(text),
        [
            "3:9: warning: the layout places \"gone\", and no node has that name; it is kept",
            "4:6: warning: the layout of \"b\" is not two numbers (x, y); it is kept",
            "5:6: warning: the layout of \"c\" is not two numbers (x, y); it is kept",
            "6:6: warning: the layout places \"a\" twice; keep one; the last one is used",
        ]
    );
    let mut loaded = load(text);
    assert_eq!(loaded.graph.node(loaded.graph.find("a").unwrap()).unwrap().position(), Some([5.0, 6.0]));
    assert!(!loaded.has_errors());
    let saved = file::to_text(&loaded.graph);
    for piece in ["\"gone\": (3.0, 4.0),", "\"b\": (1, NaN),", "\"c\": frame( 3 ),"] {
        assert!(saved.contains(piece), "{saved}");
    }
    // What is placed anew gives up its old entry.
    let b = loaded.graph.find("b").unwrap();
    loaded.graph.set_position(b, Some([7.0, 8.0])).unwrap();
    assert_eq!(load(&file::to_text(&loaded.graph)).problems.len(), 2);
}

#[test]
fn nodes_missing() {
    assert_eq!(problems("(version: 1)"), ["1:1: error: the field \"nodes\" is missing; add nodes: {}"]);
    let both = [
        "1:1: error: the field \"version\" is missing; add version: 1",
        "1:1: error: the field \"nodes\" is missing; add nodes: {}",
    ];
    assert_eq!(problems("()"), both);
}

#[test]
fn attributes_are_pointed_out() {
    let text = "// see #![type]\n#![enable(implicit_some)]\n(version: 1, nodes: {})";
    assert_eq!(
        problems(text),
        ["2:1: warning: the attribute #![...] has no meaning in a graph; remove it; it is not kept"]
    );
    assert_eq!(problems("(version: 1, notes: \"#![enable(implicit_some)]\", nodes: {})"), [""; 0]);
    assert_eq!(problems("// #![enable(implicit_some)]\n(version: 1, nodes: {})"), [""; 0]);
}

#[test]
fn columns_count_characters() {
    let text = "(version: 1, notes: \"ääää€𝄞\", nodes: {\"é\": (kind: \"nope-q\")})";
    let loaded = load(text);
    let at =
        text.chars().collect::<Vec<_>>().windows(6).position(|w| w.iter().collect::<String>() == "\"nope-").unwrap();
    assert_eq!((loaded.problems[0].line, loaded.problems[0].column), (1, at + 1));
}

fn error(text: &str) -> String {
    match file::from_text(&Catalogue::new(), text) {
        Err(error) => error.to_string(),
        Ok(loaded) => panic!("{text} loads: {:?}", loaded.problems),
    }
}

#[test]
fn what_is_no_graph_is_an_error_at_its_place() {
    let shape = "a graph is written (version: 1, nodes: { \"name\": (kind: \"...\", inputs: { ... }) })";
    let cut = "the file may have been cut off: compare it with a backup";
    let empty = "the file is empty: an empty graph is (version: 1, nodes: {})";
    let cases = [
        ("", format!("1:1: error: a '(' is expected here; {empty}")),
        (" \n\n", format!("1:1: error: a '(' is expected here; {empty}")),
        ("[1]", format!("1:1: error: a '(' is expected here; {shape}")),
        ("Graph(version: 1)", format!("1:1: error: a '(' is expected here; {shape}")),
        ("{\"version\": 1}", format!("1:1: error: a '(' is expected here; {shape}")),
        ("(\n  version: 1,\n  nodes: 5)", format!("3:10: error: a '{{' is expected here; {shape}")),
        ("(version: 1,\nnodes: { \"a\": 5 })", format!("2:15: error: a '(' is expected here; {shape}")),
        ("(version: 1,\nnodes: { \"a\" (kind: \"x\") })", format!("2:14: error: a ':' is expected here; {shape}")),
        (
            "(version: 1,\nnodes: { \"a\": (kind: \"x\" inputs: {}) })",
            format!("2:26: error: a ',' or a closing bracket is expected here; {shape}"),
        ),
        ("(version: 1, version: 2)", format!("1:14: error: the field \"version\" occurs twice; {shape}")),
        (
            "(version: 1, nodes: {\"a\": (kind: \"x\",\nkind: \"y\")})",
            format!("2:1: error: the field \"kind\" occurs twice; {shape}"),
        ),
        ("(version: 1, nodes: {},) x", format!("1:26: error: more text follows where the end is expected; {shape}")),
        ("(\"version\": 1)", format!("1:2: error: the name of a field is expected here, without quotes; {shape}")),
        ("(version: 1,\n nodes: {", format!("2:10: error: the text ends where more is expected; {cut}")),
        ("(version: 1,\n notes: \"abc", format!("2:9: error: a text has no closing quote; {cut}")),
        ("(version: 1, /* abc", format!("1:14: error: a comment /* has no end */; {cut}")),
    ];
    for (text, expected) in cases {
        assert_eq!(error(text), expected, "{text}");
    }
}

#[test]
fn what_is_not_utf_8_is_an_error_at_its_place() {
    let catalogue = Catalogue::new();
    let at = |bytes: &[u8]| file::from_bytes(&catalogue, bytes).map(|_| ());
    assert_eq!(at(b"(version: 1,\n notes: \"\xff\")"), Err(FileError::NotUtf8 { line: 2, column: 10 }));
    assert_eq!(at("\u{feff}(ä\u{0}".as_bytes()[..5].as_ref()), Err(FileError::NotUtf8 { line: 1, column: 2 }));
    let utf_16: Vec<u8> = "(version: 1)".encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert!(at(&[&[0xff, 0xfe], utf_16.as_slice()].concat()).is_err());
    assert_eq!(
        at(b"\xff").map_err(|error| error.to_string()),
        Err("1:1: error: the file is not UTF-8 text; save it as UTF-8, or restore it from a backup".to_owned())
    );
}

#[test]
fn severities_and_parts_of_a_problem() {
    let loaded = load(&inputs("count", "\"count\": 1.5"));
    let problem = &loaded.problems[0];
    assert_eq!(problem.severity, Severity::Error);
    assert!(loaded.has_errors());
    assert_eq!((problem.node.as_deref(), problem.port.as_deref()), (Some("n"), Some("count")));
    assert_eq!(loaded.place(loaded.graph.find("n").unwrap(), Some("count")), Some((problem.line, problem.column)));
}

#[test]
fn a_literal_by_itself() {
    assert_eq!(file::parse_literal(" 0.5 "), Ok(Literal::Number(0.5)));
    assert_eq!(file::parse_literal("Vector(0, 1.5, -2)"), Ok(Literal::Vector([0.0, 1.5, -2.0])));
    assert_eq!(file::parse_literal("false"), Ok(Literal::Boolean(false)));
    assert_eq!(file::parse_literal("Link(\"a.b\")").unwrap_err().message, "a link can't stand here; write a value");
    assert!(file::parse_literal("").unwrap_err().message.starts_with("nothing is written; write a number"));
    assert!(file::parse_literal("Vektor(1, 2, 3)").unwrap_err().message.contains("Vektor"));
    for text in ["\u{0}", "(((", "Strokes(", "'", "r#", "-", "1e", "NaNf32", "Text(5)", "Text(\"a\", \"b\")", "é"] {
        assert!(file::parse_literal(text).is_err(), "{text}");
    }
}

#[test]
fn what_ron_says_is_put_in_plain_words() {
    let cases = [
        ("Strokes([(points: [], tilt: 3)])", "a stroke has no field \"tilt\"; it has name, closed, points"),
        ("Strokes([(name: \"a\")])", "a stroke lacks the field \"points\""),
        ("Strokes([(points: [], points: [])])", "a stroke has the field \"points\" twice"),
        (
            "Strokes([(points: [(1,)])])",
            "a point (x, y) or (x, y, pressure) is expected here, and of its numbers 1 is given",
        ),
        ("Strokes([(points: [(1, true)])])", "a number is expected here"),
        ("Strokes([(closed: 1, points: [])])", "true or false is expected here"),
        ("Strokes([Line(points: [])])", "the name \"Line\" can't stand before this '('"),
        ("Strokes(5)", "a '[' is expected here"),
        ("Vector()", "Vector takes 3 numbers, and none is given"),
        ("Vector(1, 2)", "Vector takes 3 numbers, and 2 are given"),
        ("Vector(1, 2, 3, 4)", "a ')' is expected here: nothing more belongs into these brackets"),
        ("Colour(1)", "Colour takes 4 numbers, and 1 is given"),
        ("Text(5)", "a text in double quotes is expected here"),
        ("Text(\"a\\q\")", "a text has a '\\' that means nothing: write \\\\ for a backslash, or a raw text r\"...\""),
    ];
    for (text, expected) in cases {
        let message = file::parse_literal(text).unwrap_err().message;
        assert_eq!(message.split("; write a number").next(), Some(expected), "{text}");
        for word in ["Tagged", "variant", "struct", "Expected", "Unexpected", "elements"] {
            assert!(!message.contains(word), "{message}");
        }
    }
}

#[test]
fn every_problem_is_one_line_whatever_names_hold() {
    let evil = "x\\n1:1: error: all is well\\u{2028}y\\u{1b}[2J";
    let text = format!(
        "(version: 1, notes: \"\", nodes: {{\"{evil}\": (kind: \"{evil}\", inputs: {{\"{evil}\": Link(\"{evil}.{evil}\"), \"a\": 3 }}),\n\
         \"n\": (kind: \"add\", inputs: {{ \"{evil}\": 1, \"a\": Link(\"{evil}\") }}) }}, layout: {{ \"{evil}\": (1, 2), \"{evil}z\": 3 }})"
    );
    let loaded = load(&text);
    assert!(loaded.problems.len() >= 6, "{:#?}", loaded.problems);
    for problem in &loaded.problems {
        let line = problem.to_string();
        assert!(!line.contains(|c: char| c.is_control() || c == '\u{2028}'), "{line:?}");
    }
    let double = "(version: 1, nodes: {}, r#a: 1, nodes: {})";
    assert_eq!(error(double).lines().count(), 1);
    // The names themselves are what the file has.
    assert!(loaded.problems.iter().any(|p| p.node.as_deref().is_some_and(|name| name.contains('\n'))));
}
