//! No bytes make the loader panic, hang, or take more than 100 MB.

#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

#[path = "../../../tests/fuzz/mod.rs"]
mod fuzz;
mod kinds;

use std::fmt::Write as _;
use std::path::Path;

use fuzz::Subject;
use maquette_graph::file::{self, FileError};
use peak_alloc::PeakAlloc;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// The promise, less the bytes of the file themselves.
fn memory(length: usize) -> usize {
    100_000_000 - length.min(100_000_000)
}

/// What is loaded is saved and loads again to the same text; what is said is one line and has a place.
fn read(input: &[u8]) {
    let catalogue = kinds::catalogue();
    match file::from_bytes(&catalogue, input) {
        Ok(loaded) => {
            let lines = 1 + input.iter().filter(|byte| **byte == b'\n').count();
            for problem in &loaded.problems {
                assert!((1..=lines).contains(&problem.line) && problem.column >= 1, "{problem}");
                assert!(!problem.to_string().contains('\n'), "{problem:?}");
            }
            // What is large is held to the limit of memory alone: saving and loading again is no part of loading.
            if input.len() < 200_000 {
                let saved = file::to_text(&loaded.graph);
                let again = file::from_text(&catalogue, &saved).unwrap_or_else(|error| panic!("{error}\n{saved}"));
                assert!(file::to_text(&again.graph) == saved, "{saved}");
            }
        }
        Err(error) => {
            let said = error.to_string();
            assert!(!said.contains('\n') && said.contains(": error: "), "{said}");
        }
    }
    if let Ok(text) = std::str::from_utf8(input)
        && let Err(error) = file::parse_literal(text)
    {
        assert!(error.offset <= text.len(), "{error:?}");
    }
}

const DICTIONARY: &[&str] = &[
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
    "r#\"",
    "\"#",
    "b'",
    "'",
    "\n",
    " ",
    "version: 1",
    "version: 2",
    "nodes: {",
    "layout: {",
    "notes: \"",
    "kind: \"",
    "note: \"",
    "inputs: {",
    "\"add\"",
    "\"everything\"",
    "\"count\"",
    "\"a\"",
    "\"b\"",
    "\"number\": ",
    "\"strokes\": ",
    "\"samples\": ",
    "Link(\"a.sum\")",
    "Link(\"b.sum\")",
    "Text(\"x\")",
    "Choice(\"up\")",
    "File(\"../x\")",
    "Vector(1, 2, 3)",
    "Colour(0, 0, 0, 1)",
    "Strokes([(points: [(0, 1)])])",
    "Strokes([",
    "name: \"s\"",
    "closed: true",
    "points: [",
    "(0.5, 0.25, 1.0)",
    "é",
    "\u{feff}",
    "\u{2028}",
    "\u{0}",
    "\u{1f600}",
    "\\u{d800}",
    "\\x00",
    "#![enable(unwrap_newtypes)]",
    "1_000",
    "0x7f",
    "Some(())",
    "parameters: {",
    "outputs: {",
    "kinds: {",
    "body: (",
    "body: File(\"a.ron\")",
    "each: \"x\"",
    "feed_back: {",
    "muted: true",
    "kind: \"graph\"",
    "kind: \"repeat\"",
    "Parameter(\"size\")",
    "(value: 1.0)",
    "(type: \"number\")",
    "(from: \"a.sum\")",
    "range: (0.0, 1.0)",
    "options: [(\"a\", \"b\")]",
    "extensions: [\"x\"]",
];

fn subject() -> Subject<'static> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut corpus: Vec<Vec<u8>> = Vec::new();
    for folder in [folder.join("../../graphs"), folder.join("tests/cases")] {
        let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        paths.sort();
        let graphs = paths.iter().filter(|path| path.extension().is_some_and(|e| e == "ron"));
        corpus.extend(graphs.map(|path| std::fs::read(path).unwrap()));
    }
    corpus.push(SMALL.into());
    corpus.push(SMALL.into());
    corpus.push(b"(version: 1, nodes: {})".to_vec());
    Subject { name: "graph", corpus, dictionary: DICTIONARY, memory, read, allocator: &ALLOCATOR }
}

/// Every field and every kind of value.
const SMALL: &str = r#"#![enable(implicit_some)]
(
    version: 1,
    notes: "two // \"lines\"",
    nodes: {
        "a": (kind: "add", note: "n", inputs: {"a": 1, "b": Link("b.sum")}),
        "b": (kind: "add", inputs: {"a": Link("c.count"), "b": -0.5e-3}),
        "c": (kind: "count", inputs: {"count": 5, "text": Text("a\nb")}, muted: true),
        "all": (
            kind: "everything", /* one */
            inputs: {
                "number": Link("a.sum"), "length": 0.1, "integer": -7, "boolean": true, "text": Text(r"raw"),
                "choice": Choice("up"), "vector": Vector(1.0, 2.0, 3.0), "colour": Colour(0.1, 0.2, 0.3, 1.0),
                "file": File("data/a.txt"),
                "strokes": Strokes([(name: "s", closed: true, points: [(0.0, 1.0), (0.0, 1.0, 0.5)])]),
            },
        ),
        "part": (kind: "graph", muted: true, inputs: {"size": 2.0}, body: (
            parameters: {"size": (value: 1.0, unit: "m", range: (0.0, 9.0), description: "d"), "x": (type: "samples")},
            nodes: {"in": (kind: "add", inputs: {"a": Parameter("size"), "b": Link("more.out")}),
                "more": (kind: "repeat", each: "x", body: (nodes: {}, outputs: {"out": (from: "n.m")}))},
            outputs: {"sum": (from: "in.sum")},
        )),
        "again": (kind: "repeat", feed_back: {"size": "sum"}, body: File("part.ron"), inputs: {"times": 3}),
        "later": (kind: "not-yet", inputs: {"x": Mesh([1, 2], {"k": ('y', ())})}),
    },
    layout: { "all": (1.0, 2.0), "gone": (0, 0) },
    parameters: {"x": (value: Choice("up"), options: [("up", "u"), ("down", "d")])}, kinds: {"add": 1},
    outputs: {"all": (from: "all.number")}, more: {"x": Some(1)}, // end
)
"#;

#[test]
fn fuzz_the_loader() {
    subject().fuzz();
}

#[test]
fn what_fuzzing_found_stays_mended() {
    subject().hold_cases(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases"));
}

/// Few bytes again and again: up to the largest file, and as often as is accepted.
#[test]
fn no_repetition_asks_for_too_much() {
    let subject = subject();
    let catalogue = kinds::catalogue();
    let [head, tail] = ["(version: 1, nodes: {", "})"];
    let [into, out] = ["(version: 1, nodes: {\"n\": (kind: \"everything\", inputs: {", "})})"];
    for (what, before, piece, after) in [
        ("newlines", "", "\n", "(version: 1, nodes: {})"),
        ("characters of two bytes", "\"", "é", "\""),
        ("nodes without anything", head, "1:(),", tail),
        ("nodes of a kind", head, "\"a\":(kind:\"add\"),", tail),
        ("nodes with an input", head, "1:(inputs:{1:1}),", tail),
        ("nodes with a known input", head, "\"a\":(kind:\"add\",inputs:{\"a\":1}),", tail),
        ("nodes with a link", head, "\"a\":(kind:\"add\",inputs:{\"a\":Link(\"a.b\")}),", tail),
        ("nodes with empty inputs", head, "1:(inputs:{}),", tail),
        ("nodes with an unknown field", head, "1:(a:1),", tail),
        ("nodes with strokes", head, "1:(kind:\"everything\",inputs:{\"strokes\":Strokes([(points:[])])}),", tail),
        ("bodies", head, "1:(kind:\"graph\",body:(nodes:{})),", tail),
        ("bodies with a node", head, "1:(kind:\"graph\",body:(nodes:{\"a\":(kind:\"add\")})),", tail),
        ("repeats", head, "1:(kind:\"repeat\",feed_back:{\"a\":\"b\"},body:(parameters:{\"a\":(value:1)})),", tail),
        ("bodies in bodies", "(version: 1, nodes: {", "1:(kind:\"graph\",body:(nodes:{", ""),
        ("parameters", "(version: 1, nodes: {}, parameters: {", "1:(value:1),", "})"),
        ("fields of a parameter", "(version: 1, nodes: {}, parameters: {1:(", "a:1,", ")})"),
        ("options of a parameter", "(version: 1, nodes: {}, parameters: {1:(options:[", "(\"\",\"\"),", "])})"),
        ("extensions of a parameter", "(version: 1, nodes: {}, parameters: {1:(extensions:[", "\"\",", "])})"),
        ("outputs", "(version: 1, nodes: {}, outputs: {", "1:(from:\"a.b\"),", "})"),
        ("pairs fed back", "(version: 1, nodes: {1:(kind:\"repeat\",feed_back:{", "\"\":\"\",", "},body:(nodes:{}))})"),
        ("unknown fields", "(version: 1, nodes: {}, ", "a:1,", ")"),
        ("unknown fields of a node", "(version: 1, nodes: {\"a\": (kind: \"add\", ", "a:1,", ")})"),
        ("one input again and again", into, "1:1,", out),
        ("one link again and again", into, "\"number\":Link(\"\"),", out),
        ("places of nothing", "(version: 1, nodes: {}, layout: {", "1:(0,0),", "})"),
        ("points", &format!("{into}\"strokes\": Strokes([(points: ["), "(0,0),", &format!("])]){out}")),
        ("strokes", &format!("{into}\"strokes\": Strokes(["), "(points:[]),", &format!("]){out}")),
        ("a long text", &format!("{into}\"text\": Text(\""), "x", &format!("\"){out}")),
        ("a long text of escapes", &format!("{into}\"text\": Text(\""), "\\n", &format!("\"){out}")),
        ("a text that is not read", &format!("{into}\"number\": Text(\""), "x", &format!("\"){out}")),
        ("a note", "(version: 1, notes: \"", "x", "\", nodes: {})"),
        ("brackets never closed", "", "(", ""),
        ("texts never closed", "", "\"\\\"", ""),
        ("comments", "(version: 1, nodes: {}", "/**/", ")"),
        ("open comments", "", "/*", ""),
        ("attributes in a comment", "/*", "#![", "*/(version: 1, nodes: {})"),
        ("attributes", "", "#![enable(implicit_some)]", "(version: 1, nodes: {})"),
        ("hashes of raw texts", "(version: 1, nodes: {}, x: r", "#", "\""),
    ] {
        let of_length = |bytes: usize| {
            let times = (bytes - before.len() - after.len()) / piece.len();
            [before, &piece.repeat(times), after].concat()
        };
        let mut bytes = file::MOST_BYTES;
        subject.hold(what, of_length(bytes).as_bytes());
        while matches!(file::from_text(&catalogue, &of_length(bytes)), Err(FileError::TooLarge { .. })) {
            bytes /= 3;
        }
        if bytes < file::MOST_BYTES {
            subject.hold(&format!("{what}, as many as are read"), of_length(bytes).as_bytes());
        }
    }
    let too_long = format!("(version: 1, nodes: {{}}){}", " ".repeat(file::MOST_BYTES));
    let error = file::from_text(&catalogue, &too_long).unwrap_err().to_string();
    assert!(error.starts_with("1:1: error: ") && error.contains("16777216 are the most that is read"), "{error}");
    let nodes = format!("{head}\n{}{tail}", "1:(),".repeat(1_000_000));
    let error = file::from_text(&catalogue, &nodes).unwrap_err().to_string();
    assert!(error.starts_with("2:") && error.contains("take more than 100 MB to read; divide it"), "{error}");
}

/// Names, numbers and links that are long, many or both.
#[test]
fn nothing_is_said_or_searched_too_often() {
    let subject = subject();
    let name = "x".repeat(1_000_000);
    let nodes = |count: usize, node: &dyn Fn(usize) -> String| {
        let nodes: String = (0..count).map(node).collect();
        format!("(version: 1, nodes: {{{nodes}}})")
    };
    let inputs = |count: usize, input: &dyn Fn(usize) -> String| {
        let inputs: String = (0..count).map(input).collect();
        format!("(version: 1, nodes: {{\"n\": (kind: \"everything\", inputs: {{{inputs}}})}})")
    };
    let mut chain_and_back = String::from("(version: 1, nodes: {");
    for i in 0..12_000_usize {
        let _ = write!(chain_and_back, "\"n{i}\":(kind:\"add\",inputs:{{");
        if i > 0 {
            let _ = write!(chain_and_back, "\"a\":Link(\"n{}.sum\"),", i - 1);
        }
        let _ = write!(chain_and_back, "\"b\":Link(\"n{}.sum\")}}),", 11_999 - i / 2);
    }
    chain_and_back.push_str("})");
    let mut knot = fuzz::Dice(3);
    let mut tangle = String::from("(version: 1, nodes: {");
    for i in 0..12_000_usize {
        let (a, b) = (knot.below(12_000), knot.below(12_000));
        let _ = write!(tangle, "\"n{i}\":(kind:\"add\",inputs:{{\"a\":Link(\"n{a}.sum\"),\"b\":Link(\"n{b}.sum\")}}),");
    }
    tangle.push_str("})");
    for (what, text) in [
        (
            "a long name that is wrong, and ten thousand mistakes in its node",
            inputs(20_000, &|i| format!("\"x{i}\":1,")).replace("\"n\"", &format!("\"{name}.\"")),
        ),
        ("a long kind", nodes(1, &|_| format!("\"a\":(kind:\"{name}\"),"))),
        ("a long input", inputs(1, &|_| format!("\"{name}\":1,"))),
        ("a long address", inputs(1, &|_| format!("\"number\":Link(\"{name}.sum\"),"))),
        ("a long option", inputs(1, &|_| format!("\"choice\":Choice(\"{name}\"),"))),
        ("long names that differ", nodes(15_000, &|i| format!("\"{}{i}\":(kind:\"add\"),", "y".repeat(190)))),
        (
            "misspelt names of long nodes",
            nodes(15_000, &|i| {
                format!("\"{0}{i}\":(kind:\"add\",inputs:{{\"a\":Link(\"{0}z{i}.sum\")}}),", "y".repeat(60))
            }),
        ),
        ("a number of a million digits", inputs(1, &|_| format!("\"number\":{},", "1".repeat(1_000_000)))),
        ("a fraction of a million digits", inputs(1, &|_| format!("\"number\":0.{},", "1".repeat(1_000_000)))),
        ("an exponent of a million digits", inputs(1, &|_| format!("\"number\":1e{},", "1".repeat(1_000_000)))),
        ("a number of a million underscores", inputs(1, &|_| format!("\"number\":1{},", "_".repeat(1_000_000)))),
        ("one input, a hundred thousand times", inputs(100_000, &|i| format!("\"number\":{i},"))),
        ("one link, a hundred thousand times", inputs(100_000, &|_| "\"number\":Link(\"n.number\"),".to_owned())),
        (
            "links at many inputs, and each again",
            inputs(60_000, &|i| format!("\"x{}\":Link(\"n.number\"),", i % 30_000)),
        ),
        (
            "links of all nodes to one",
            nodes(15_000, &|_| "\"a\":(kind:\"add\",inputs:{\"a\":Link(\"a.sum\")}),".to_owned()),
        ),
        ("a hundred thousand links from one node", inputs(100_000, &|i| format!("\"x{i}\":Link(\"n.number\"),"))),
        (
            "a long cycle",
            nodes(15_000, &|i| {
                format!("\"n{i}\":(kind:\"add\",inputs:{{\"a\":Link(\"n{}.sum\")}}),", (i + 1) % 15_000)
            }),
        ),
        ("a chain with links back from everywhere", chain_and_back),
        ("a tangle", tangle),
        (
            "one name ten thousand times, and its copies",
            nodes(15_000, &|i| format!("\"a{}\":(),", if i % 2 == 0 { String::new() } else { format!("-{i}") })),
        ),
    ] {
        subject.hold(what, text.as_bytes());
    }
}

#[test]
fn odd_bytes_are_read_or_refused() {
    let subject = subject();
    let text =
        |inside: &str| format!("(version: 1, nodes: {{\"n\": (kind: \"count\", inputs: {{\"text\": {inside}}})}})");
    for (what, bytes) in [
        ("nothing", Vec::new()),
        ("a NUL", vec![0]),
        ("a NUL in a text", text("Text(\"\0\")").into()),
        ("a NUL between", text("\0 Text(\"\")").into()),
        ("a lone surrogate, escaped", text("Text(\"\\u{d800}\")").into()),
        ("a lone surrogate, encoded", [b"(\"".as_slice(), &[0xed, 0xa0, 0x80], b"\")"].concat()),
        ("an overlong slash", vec![0xc0, 0xaf]),
        ("a byte order mark", "\u{feff}(version: 1, nodes: {})".into()),
        ("two of them", "\u{feff}\u{feff}(version: 1, nodes: {})".into()),
        ("one alone", "\u{feff}".into()),
        ("one at the end", "(version: 1, nodes: {})\u{feff}".into()),
        ("half of one", vec![0xef, 0xbb]),
        ("UTF-16", "(version: 1)".encode_utf16().flat_map(u16::to_le_bytes).collect()),
        ("old line ends", "(version: 1,\r nodes: {},\r x: @)".into()),
        ("a line separator", "(version: 1,\u{2028} nodes: {})".into()),
        ("a text that turns its direction", text("Text(\"\u{202e}\")").into()),
    ] {
        subject.hold(what, &bytes);
    }
}
