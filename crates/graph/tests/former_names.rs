//! Files of earlier versions: read as what they meant, with a note for each old name, and rewritten without losing a word.

#![allow(clippy::unwrap_used, clippy::panic, reason = "in tests a failing unwrap is a failing test")]

mod kinds;

use kinds::{Rounding, kind};
use maquette_graph::file::{self, Severity};
use maquette_graph::{Catalogue, CatalogueError, Evaluator, Literal, NodeKind, Request};

/// What was once `sum` with `x`, `y` and `mode`, whose second term was 5 by default, is `plus` with `a`, `b`, `rounding`.
fn plus(version: u32) -> NodeKind {
    let mut node = NodeKind::declare("plus", version, "test", "Adds.");
    let a = node.number("a", 0.0, -1e9..=1e9, "One term.");
    let b = node.number("b", 1.0, -1e9..=1e9, "The other.");
    let rounding = node.choice::<Rounding>("rounding", "How to round.");
    let total = node.output::<f64>("total", "Both.");
    node.formerly("sum");
    node.formerly("addition");
    node.input_formerly(a, "x");
    node.input_formerly(b, "y");
    node.input_formerly(rounding, "mode");
    node.option_formerly(rounding, "up", "ceiling");
    node.output_formerly(total, "result");
    node.default_until(1, b, Literal::Number(5.0));
    node.evaluate(move |ports| {
        let sum = ports.value(a) + ports.value(b);
        let sum = if ports.choice(rounding) == Rounding::Up { sum.ceil() } else { sum.floor() };
        ports.write(total, sum);
        Ok(())
    });
    node
}

fn catalogue() -> Catalogue {
    let mut catalogue = Catalogue::new();
    catalogue.register(plus(2)).unwrap();
    catalogue.register(kind("plain", |_| {})).unwrap();
    catalogue
}

const OLD: &str = r#"// from long ago
(
    version: 1, // the first
    nodes: {
        "first": (kind: /* a */ "sum" /* b */, inputs: {"x": 1.25 /* x */, "mode": Choice("ceiling")}),
        "second": (
            kind: "plus",
            inputs: {
                "a": Link("first.result"), // linked
            },
        ),
        "third": (kind: "addition"), "fourth": (kind: "plus", inputs: {}, note: "inputs: {"),
        "alone": (kind: "plain"),
    },
)
"#;

const NEW: &str = r#"// from long ago
(
    version: 1, kinds: {"plus": 2}, // the first
    nodes: {
        "first": (kind: /* a */ "plus" /* b */, inputs: {"b": 5.0, "a": 1.25 /* x */, "rounding": Choice("up")}),
        "second": (
            kind: "plus",
            inputs: {
                "b": 5.0, "a": Link("first.total"), // linked
            },
        ),
        "third": (kind: "plus", inputs: {"b": 5.0}),
        "alone": (kind: "plain"),
    },
)
"#;

fn totals(catalogue: &Catalogue, text: &str) -> Vec<Option<f64>> {
    let loaded = file::from_text(catalogue, text).unwrap();
    assert!(!loaded.has_errors(), "{:?}", loaded.problems);
    let all: Vec<_> = loaded.graph.nodes().map(|(id, _)| id).collect();
    let evaluation = Evaluator::default().evaluate(catalogue, &loaded.graph, &Request::nodes(&all));
    all.iter().map(|id| evaluation.value::<f64>(*id, "total").copied()).collect()
}

#[test]
fn old_names_and_defaults_are_read_with_notes() {
    let catalogue = catalogue();
    let loaded = file::from_text(&catalogue, OLD).unwrap();
    let said: Vec<String> = loaded.problems.iter().map(ToString::to_string).collect();
    let remedy = "; maquette migrate rewrites the file";
    let expected = [
        "5:9: note: node \"first\", input \"b\": nothing stands here, which meant 5.0 in version 1 of plus",
        "5:33: note: node \"first\": the kind \"sum\" is called \"plus\" today",
        "5:57: note: node \"first\", input \"x\": the input is called \"a\" today",
        "5:76: note: node \"first\", input \"mode\": the input is called \"rounding\" today",
        "5:84: note: node \"first\", input \"rounding\": the option \"ceiling\" is called \"up\" today",
        "6:9: note: node \"second\", input \"b\": nothing stands here, which meant 5.0 in version 1 of plus",
        "9:22: note: node \"second\", input \"a\": the output \"result\" of \"first\" is called \"total\" today",
        "12:9: note: node \"third\", input \"b\": nothing stands here, which meant 5.0 in version 1 of plus",
        "12:25: note: node \"third\": the kind \"addition\" is called \"plus\" today",
        "12:38: note: node \"fourth\", input \"b\": nothing stands here, which meant 5.0 in version 1 of plus",
    ]
    .map(|line| format!("{line}{remedy}"));
    assert_eq!(said, expected);
    assert_eq!(totals(&catalogue, OLD), [Some(7.0), Some(12.0), Some(5.0), Some(5.0), None]);
    // Saved, it is a file of today.
    let saved = file::to_text(&loaded.graph);
    let again = file::from_text(&catalogue, &saved).unwrap();
    assert_eq!(again.problems, []);
    assert_eq!(file::to_text(&again.graph), saved);
    assert!(
        saved.starts_with("(\n    version: 1,\n    kinds: {\n        \"plus\": 2,\n    },\n    nodes: {\n"),
        "{saved}"
    );
    assert_eq!(totals(&catalogue, &saved), totals(&catalogue, OLD));
}

#[test]
fn migrating_changes_what_is_old_and_nothing_else() {
    let catalogue = catalogue();
    let without_fourth = OLD.replace(" \"fourth\": (kind: \"plus\", inputs: {}, note: \"inputs: {\"),", "");
    let migrated = file::migrate(&catalogue, &without_fourth).unwrap();
    assert_eq!(migrated.text, NEW);
    assert_eq!(migrated.notes.len(), 9);
    assert!(migrated.notes.iter().all(|note| note.severity == Severity::Note));
    let again = file::migrate(&catalogue, &migrated.text).unwrap();
    assert_eq!((again.text.as_str(), again.notes.len()), (NEW, 0));
    assert_eq!(totals(&catalogue, &migrated.text), totals(&catalogue, &without_fourth));
    // A mark of byte order stays; what is wrong otherwise stays wrong.
    let marked = file::migrate(&catalogue, &format!("\u{feff}{without_fourth}")).unwrap();
    assert_eq!(marked.text, format!("\u{feff}{NEW}"));
    let broken = without_fourth.replace("1.25", "oops").replace("\"plain\"", "\"plane\"");
    let migrated = file::migrate(&catalogue, &broken).unwrap();
    assert_eq!(migrated.text, NEW.replace("1.25", "oops").replace("\"plain\"", "\"plane\""));
}

#[test]
fn where_a_place_is_hard_to_find_the_stable_form_is_written() {
    let catalogue = catalogue();
    let migrated = file::migrate(&catalogue, OLD).unwrap();
    assert_eq!(migrated.text, file::to_text(&file::from_text(&catalogue, OLD).unwrap().graph));
    assert_eq!(totals(&catalogue, &migrated.text), totals(&catalogue, OLD));
}

#[test]
fn a_default_counts_up_to_its_version_and_what_is_written_always() {
    let mut catalogue = Catalogue::new();
    let mut third = plus(3);
    let [a, b] = ["a", "b"].map(|name| third.inputs().iter().position(|i| i.name == name).unwrap());
    assert_eq!((a, b), (0, 1));
    let extra = third.number("c", 0.0, -1e9..=1e9, "Nothing.");
    third.default_until(2, extra, Literal::Number(9.0));
    catalogue.register(third).unwrap();
    let inputs = |kinds: &str, inputs: &str| {
        let text = format!("(version: 1, {kinds} nodes: {{\"n\": (kind: \"plus\", inputs: {{{inputs}}})}})");
        let loaded = file::from_text(&catalogue, &text).unwrap();
        let node = loaded.graph.node(loaded.graph.find("n").unwrap()).unwrap();
        let held: Vec<_> = node.sources().map(|(name, _)| name.to_owned()).collect();
        (held.join(" "), loaded.problems.len())
    };
    assert_eq!(inputs("", ""), ("b c".to_owned(), 2));
    assert_eq!(inputs("kinds: {\"plus\": 1},", ""), ("b c".to_owned(), 2));
    assert_eq!(inputs("kinds: {\"plus\": 2},", ""), ("c".to_owned(), 1));
    assert_eq!(inputs("kinds: {\"plus\": 3},", ""), (String::new(), 0));
    // From the future: a warning.
    assert_eq!(inputs("kinds: {\"plus\": 4},", ""), (String::new(), 1));
    // A kind goes by its name of today, and one that is unknown is kept.
    assert_eq!(inputs("kinds: {\"sum\": 3},", ""), (String::new(), 0));
    let text = "(version: 1, kinds: {\"later\": 7}, nodes: {\"n\": (kind: \"later\")})";
    let saved = file::to_text(&file::from_text(&catalogue, text).unwrap().graph);
    assert!(saved.contains("    kinds: {\n        \"later\": 7,\n    },\n"), "{saved}");
    assert_eq!(inputs("", "\"b\": 1, \"c\": 2"), ("b c".to_owned(), 0));
    // An entry that is none is an error, and counts for nothing.
    assert_eq!(inputs("kinds: {\"plus\": x},", ""), ("b c".to_owned(), 3));
}

#[test]
fn an_old_name_beside_the_new_one_is_no_name() {
    let catalogue = catalogue();
    let text = "(version: 1, nodes: {\"n\": (kind: \"plus\", inputs: {\"b\": 1, \"a\": 1, \"x\": 2})})";
    let loaded = file::from_text(&catalogue, text).unwrap();
    assert_eq!(loaded.problems.len(), 1);
    assert!(loaded.problems[0].message.contains("has no such input"), "{}", loaded.problems[0]);
    let text = "(version: 1, nodes: {\"n\": (kind: \"plus\", inputs: {\"b\": 1, \"x\": 2, \"a\": 1})})";
    let loaded = file::from_text(&catalogue, text).unwrap();
    assert!(loaded.problems.iter().any(|p| p.message.contains("occurs twice")), "{:?}", loaded.problems);
}

#[test]
fn names_that_are_in_use_are_no_former_ones() {
    let refused = |declare: &dyn Fn(&mut NodeKind)| {
        let mut catalogue = catalogue();
        let mut node = kind("new", |_| {});
        declare(&mut node);
        catalogue.register(node).map_err(|error| error.to_string()).unwrap_err()
    };
    for name in ["plus", "sum", "new"] {
        assert_eq!(refused(&|node| node.formerly(name)), format!("node kind \"{name}\" is registered twice"));
    }
    let former = |name: &str, reason: &str| {
        format!("node kind \"new\" states something of \"{name}\" in former times: {reason}")
    };
    let said = refused(&|node| {
        let a = node.boolean("a", false, "A.");
        node.boolean("b", false, "B.");
        node.input_formerly(a, "b");
    });
    assert_eq!(said, former("b", "something has that name now"));
    let said = refused(&|node| {
        let a = node.number("a", 0.0, 0.0..=1.0, "A.");
        node.default_until(0, a, Literal::Number(2.0));
    });
    assert_eq!(said, former("a", "its former default does not fit: 2 is out of range: give 0 to 1"));
    let said = refused(&|node| {
        let a = node.boolean("a", false, "A.");
        node.default_until(1, a, Literal::Boolean(true));
    });
    assert_eq!(said, former("a", "a former default ends before version 1 of the kind"));
    let said = refused(&|node| {
        let choice = node.choice::<Rounding>("a", "A.");
        node.option_formerly(choice, "sideways", "left");
    });
    assert_eq!(said, former("sideways", "there is no such option"));
    let mut catalogue = catalogue();
    let again = NodeKind::declare("sum", 1, "test", "Has the former name of another.");
    assert_eq!(catalogue.register(again), Err(CatalogueError::DuplicateKind("sum".to_owned())));
}
