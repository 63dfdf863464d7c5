//! Damaged, hostile and huge files: never a panic, never silence, never a crawl.

#![allow(clippy::unwrap_used, clippy::panic, reason = "in tests a failing unwrap is a failing test")]

mod kinds;

use std::fmt::Write as _;
use std::time::{Duration, Instant};

use maquette_graph::file;
use proptest::prelude::*;

const SAMPLE: &str = r#"(
    version: 1,
    notes: "ä // \"b\"",
    parameters: {
        "p": (value: 2, range: (0.0, 9.0), soft_range: (1.0, 2.0), unit: "m", description: "d"),
        "c": (value: Choice("up"), options: [("up", "u"), ("down", "d")]),
        "s": (type: "samples", optional: true),
    },
    nodes: {
        "größe": (kind: "count", note: "n", inputs: { "count": 5, "text": Text("a\nb") }),
        "all": (
            kind: "everything",
            inputs: {
                "number": -0.5e-3,
                "length": Link("c.sum"),
                "vector": Vector(1.0, 2.0, 3.0),
                "strokes": Strokes([(name: "s", closed: true, points: [(0.0, 1.0), (0.0, 1.0, 0.5)])]),
            },
        ),
        "c": (kind: "add", muted: [1, /* two */ 2]),
        "g": (kind: "graph", muted: true, inputs: { "x": Parameter("p") }, body: (
            parameters: { "x": (value: 1.0) },
            nodes: { "r": (kind: "repeat", feed_back: { "y": "z" }, inputs: { "y": Parameter("x") }, body: (
                parameters: { "y": (value: 0.5), "index": (value: 0) },
                nodes: { "a": (kind: "add", inputs: { "a": Parameter("y"), "b": Parameter("index") }) },
                outputs: { "z": (from: "a.sum") },
            )) },
            outputs: { "x": (from: "r.z", description: "o") },
        )),
        "f": (kind: "graph", inputs: { "x": 1.5 }, body: (nodes: {}, parameters: { "x": (value: 1.0) })),
    },
    outputs: { "o": (from: "g.x"), "n": (description: "from nothing") },
    layout: { "all": (1.0, 2.0) },
    later: {"x": Some(('y', ()))}, // end
)
"#;

#[test]
fn a_file_cut_anywhere_is_noticed() {
    let catalogue = kinds::catalogue();
    assert_eq!(file::from_text(&catalogue, SAMPLE).unwrap().problems.len(), 3);
    let complete = SAMPLE.trim_end().len();
    for end in 0..complete {
        let cut = &SAMPLE.as_bytes()[..end];
        match file::from_bytes(&catalogue, cut) {
            Err(error) => {
                let text = error.to_string();
                let (line, column) = place(&text);
                assert!(line >= 1 && column >= 1 && line <= 1 + SAMPLE.matches('\n').count(), "{text}");
            }
            Ok(_) => panic!("cut at byte {end}, it loads in silence"),
        }
    }
}

fn place(message: &str) -> (usize, usize) {
    let mut numbers = message.splitn(3, ':').map(|part| part.parse().unwrap_or(0));
    (numbers.next().unwrap_or(0), numbers.next().unwrap_or(0))
}

#[test]
fn a_byte_lost_doubled_or_changed_anywhere_never_panics() {
    let bytes = SAMPLE.as_bytes();
    for at in 0..bytes.len() {
        let mut without = bytes.to_vec();
        without.remove(at);
        let mut doubled = bytes.to_vec();
        doubled.insert(at, bytes[at]);
        let mut variants = vec![without, doubled];
        for replacement in [b'"', b'(', b')', b'/', b'#', b'r', b'\\', b'0', 0, 0xff] {
            let mut changed = bytes.to_vec();
            changed[at] = replacement;
            variants.push(changed);
        }
        for variant in variants {
            assert_settles(&variant);
        }
    }
}

/// What loads is saved and loads again, to the same text.
fn assert_settles(bytes: &[u8]) {
    let catalogue = kinds::catalogue();
    if let Ok(loaded) = file::from_bytes(&catalogue, bytes) {
        let saved = file::to_text(&loaded.graph);
        let shown = || format!("{}\n->\n{saved}", String::from_utf8_lossy(bytes));
        match file::from_text(&catalogue, &saved) {
            Ok(again) => assert_eq!(file::to_text(&again.graph), saved, "{}", shown()),
            Err(error) => panic!("{error}\n{}", shown()),
        }
    }
}

#[test]
fn deep_nesting_is_refused_without_overflowing_the_stack() {
    let catalogue = kinds::catalogue();
    for depth in [200, 1_000, 100_000] {
        for (open, close) in [("(", ")"), ("[", "]"), ("{1:", "}"), ("Some(", ")"), ("a(b:", ")")] {
            let nested = format!("{}1{}", open.repeat(depth), close.repeat(depth));
            for text in [
                format!("(version: 1, nodes: {{}}, x: {nested})"),
                format!("(version: 1, nodes: {{\"a\": (kind: \"everything\", inputs: {{\"number\": {nested}}})}})"),
                format!("(version: 1, nodes: {{\"a\": (kind: {nested})}})"),
                nested.clone(),
            ] {
                let error = file::from_text(&catalogue, &text).map(|_| ()).unwrap_err().to_string();
                if text != nested {
                    assert!(
                        error.contains("brackets are nested too deeply to be read"),
                        "{depth} {open}: {error:.200}"
                    );
                }
            }
            assert!(file::parse_literal(&nested).is_err());
        }
    }
    let comments = format!("(version: 1, nodes: {{}}, {}{})", "/*".repeat(100_000), "*/".repeat(100_000));
    assert!(file::from_text(&catalogue, &comments).unwrap().problems.is_empty());
}

#[test]
fn moderate_nesting_is_kept() {
    let catalogue = kinds::catalogue();
    for depth in 40..140 {
        let nested = format!("{}1{}", "[".repeat(depth), "]".repeat(depth));
        assert_settles(format!("(version: 1, nodes: {{}}, x: {nested})").as_bytes());
        assert_settles(
            format!("(version: 1, nodes: {{\"a\": (kind: {nested}, x: {nested}, inputs: {{\"y\": {nested}}})}})")
                .as_bytes(),
        );
    }
    let nested = format!("{}1{}", "[".repeat(50), "]".repeat(50));
    let loaded = file::from_text(&catalogue, &format!("(version: 1, nodes: {{}}, x: {nested})")).unwrap();
    assert!(file::to_text(&loaded.graph).contains(&nested));
}

#[track_caller]
fn quickly<T>(limit: Duration, work: impl FnOnce() -> T) -> T {
    let begun = Instant::now();
    let result = work();
    let took = begun.elapsed();
    assert!(took < limit, "{took:?}");
    result
}

/// Far more than a linear reader needs, far less than a quadratic one takes.
const LIMIT: Duration = Duration::from_secs(5);

#[test]
fn ten_thousand_nodes_load_in_any_order_and_on_one_line() {
    let catalogue = kinds::catalogue();
    let count = 10_000;
    let node = |i: usize| {
        let mut text = format!("\"n{i}\": (kind: \"add\", inputs: {{ \"b\": 1.0, ");
        if i > 0 {
            let _ = write!(text, "\"a\": Link(\"n{}.sum\"), ", i - 1);
        }
        text + "}),"
    };
    let forward: Vec<String> = (0..count).map(node).collect();
    let backward: Vec<String> = forward.iter().rev().cloned().collect();
    // 7 919 is a prime, so this visits every node once.
    let mixed: Vec<String> = (0..count).map(|i| forward[i * 7_919 % count].clone()).collect();
    for nodes in [forward, backward, mixed] {
        for (separator, shift) in [("\n", ""), ("", ""), ("", "/* é */")] {
            let text = format!("(version: 1, nodes: {{{shift}{}}})", nodes.join(separator));
            let loaded = quickly(LIMIT, || file::from_text(&catalogue, &text)).unwrap();
            assert_eq!(loaded.problems, []);
            let links = file::to_text(&loaded.graph).matches("Link").count();
            assert_eq!(links, count - 1);
        }
    }
}

#[test]
fn dense_links_against_the_order_of_the_file_do_not_crawl() {
    let catalogue = kinds::catalogue();
    let count = 10_000_usize;
    let mut text = "(version: 1, nodes: {".to_owned();
    for i in (0..count).map(|i| i * 7_919 % count) {
        let _ = write!(text, "\"n{i}\": (kind: \"add\", inputs: {{");
        if i > 0 {
            let _ = write!(text, "\"a\": Link(\"n{}.sum\"), \"b\": Link(\"n{}.sum\")", i / 2, i - 1);
        }
        text.push_str("}),\n");
    }
    text.push_str("})");
    let loaded = quickly(LIMIT, || file::from_text(&catalogue, &text)).unwrap();
    assert_eq!(loaded.problems, []);
}

#[test]
fn ten_thousand_mistakes_of_each_kind_do_not_crawl() {
    let catalogue = kinds::catalogue();
    let file_of = |node: &dyn Fn(usize) -> String| {
        let nodes: String = (0..10_000).map(node).collect();
        format!("(version: 1, nodes: {{{nodes}}})")
    };
    let files = [
        ("broken links", file_of(&|i| format!("\"n{i}\": (kind: \"add\", inputs: {{\"a\": Link(\"m{i}.sum\")}}),"))),
        ("one broken link", file_of(&|i| format!("\"n{i}\": (kind: \"add\", inputs: {{\"a\": Link(\"gone.sum\")}}),"))),
        ("equal names", file_of(&|_| "\"n\": (kind: \"add\"),".to_owned())),
        ("bad names", file_of(&|_| "\"a.b\": (kind: \"add\"),".to_owned())),
        ("unknown kinds", file_of(&|i| format!("\"n{i}\": (kind: \"k{i}\"),"))),
        ("unknown inputs", file_of(&|i| format!("\"n{i}\": (kind: \"everything\", inputs: {{\"x{i}\": 1}}),"))),
        ("self-links", file_of(&|i| format!("\"n{i}\": (kind: \"add\", inputs: {{\"a\": Link(\"n{i}.sum\")}}),"))),
        ("unknown fields", file_of(&|i| format!("\"n{i}\": (kind: \"add\", later: {i}),"))),
    ];
    for (what, text) in files {
        let loaded = quickly(LIMIT, || file::from_text(&catalogue, &text)).unwrap();
        assert_eq!(loaded.problems.len(), if matches!(what, "equal names") { 9_999 } else { 10_000 }, "{what}");
        assert_eq!(loaded.graph.nodes().len(), 10_000, "{what}");
        quickly(LIMIT, || file::to_text(&loaded.graph));
    }
}

#[test]
fn a_long_stroke_with_slashes_in_its_name_does_not_crawl() {
    let catalogue = kinds::catalogue();
    let points = "(0.125, 0.25, 0.5),\n".repeat(100_000);
    let text = format!(
        "(version: 1, nodes: {{\"a\": (kind: \"everything\", inputs: {{\"strokes\": Strokes([(name: \"a // b\", points: [{points}])])}})}})"
    );
    let loaded = quickly(LIMIT, || file::from_text(&catalogue, &text)).unwrap();
    assert_eq!(loaded.problems, []);
}

fn fragment() -> impl Strategy<Value = String> {
    let words = [
        "(",
        ")",
        "{",
        "}",
        "[",
        "]",
        ",",
        ":",
        "\"",
        "\\",
        "/",
        "//",
        "/*",
        "*/",
        "#",
        "r",
        "r#",
        "b'",
        "'",
        "\n",
        " ",
        "version",
        "nodes",
        "layout",
        "notes",
        "kind",
        "note",
        "inputs",
        "1",
        "0.5",
        "1e9",
        "-",
        "\"a\"",
        "\"add\"",
        "\"b\"",
        "Link(\"a.sum\")",
        "Text(\"x\")",
        "Strokes([(points: [(0, 1)])])",
        "Vector(1, 2, 3)",
        "é",
        "\u{feff}",
        "\u{2028}",
        "version: 1,",
        "nodes: {",
        "\"a\": (kind: \"add\"",
        "inputs: {",
        "\"a\": 1",
        "})",
        "#![enable(",
    ];
    prop_oneof![9 => prop::sample::select(words.to_vec()).prop_map(str::to_owned), 1 => any::<String>()]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(3_000) })]

    #[test]
    fn any_text_is_read_or_refused(fragments in prop::collection::vec(fragment(), 0..40)) {
        assert_settles(fragments.concat().as_bytes());
    }

    #[test]
    fn any_value_is_read_or_refused(fragments in prop::collection::vec(fragment(), 0..6), place in 0..6) {
        let value = fragments.concat();
        let _ = file::parse_literal(&value);
        let text = match place {
            0 => format!("(version: {value}, nodes: {{}})"),
            1 => format!("(version: 1, nodes: {{}}, {value})"),
            2 => format!("(version: 1, nodes: {{\"a\": (kind: \"add\", {value})}})"),
            3 => format!("(version: 1, nodes: {{\"a\": (kind: \"add\", inputs: {{\"a\": {value}, \"b\": Link(\"a.sum\")}})}})"),
            4 => format!("(version: 1, nodes: {{{value}: (kind: {value}, note: {value}, x: {value})}}, layout: {{{value}: {value}}})"),
            _ => format!("{value}(version: 1, nodes: {{}})"),
        };
        assert_settles(text.as_bytes());
    }

    #[test]
    fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..60)) {
        assert_settles(&bytes);
    }
}
