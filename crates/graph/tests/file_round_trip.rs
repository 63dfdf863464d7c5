//! What is saved is read back the same, to the last digit, and saved the same again.

#![allow(clippy::unwrap_used, reason = "in tests a failing unwrap is a failing test")]

mod kinds;

use kinds::Rig;
use maquette_graph::{Graph, Literal, Request, Source, Stroke, StrokePoint, file};
use proptest::prelude::*;

/// What a graph says, independent of identities: everything a file should hold.
fn content(graph: &Graph) -> Vec<String> {
    let mut lines = vec![format!("notes {:?}", graph.notes)];
    for (_, node) in graph.nodes() {
        lines.push(format!("{:?} {:?} {:?} {:?}", node.name(), node.kind_name(), node.position(), node.note()));
        for (input, source) in node.sources() {
            let source = match source {
                Source::Literal { literal, value } => format!("{literal:?} {}", value.hash()),
                Source::Link(link) => format!("{:?}.{}", graph.node(link.node).map(|n| n.name()), link.output),
                Source::Parameter(name) => format!("parameter {name:?}"),
                Source::Unread(text) => format!("unread {text}"),
            };
            lines.push(format!("  {input:?} {source}"));
        }
    }
    lines
}

fn assert_round_trip(rig: &Rig) {
    let text = file::to_text(&rig.graph);
    let loaded = file::from_text(&rig.catalogue, &text).unwrap();
    assert_eq!(loaded.problems, [], "{text}");
    assert_eq!(content(&loaded.graph), content(&rig.graph), "{text}");
    assert_eq!(file::to_text(&loaded.graph), text, "saving again changes nothing");
    // Line ends and a byte order mark are the business of editors.
    let windows = format!("\u{feff}{}", text.replace('\n', "\r\n"));
    let loaded = file::from_bytes(&rig.catalogue, windows.as_bytes()).unwrap();
    assert_eq!(loaded.problems, []);
    assert_eq!(content(&loaded.graph), content(&rig.graph));
}

/// Everything there is to write, once.
fn full() -> Rig {
    let mut rig = Rig::default();
    rig.graph.notes = "Two \"quoted\" lines,\n\\ and a tab\t // no comment".to_owned();
    rig.add("everything", "all");
    rig.add("add", "sum of two");
    rig.put("all.number", Literal::Number(0.1));
    rig.put("all.integer", Literal::Integer(i64::MIN));
    rig.put("all.boolean", Literal::Boolean(true));
    rig.put("all.text", Literal::Text("// \u{7f}\u{0}\u{1b} /* \u{2028} é \u{1f600}".to_owned()));
    rig.put("all.choice", Literal::Choice("up".to_owned()));
    rig.put("all.vector", Literal::Vector([1.0, -0.0, 1e-300]));
    rig.put("all.colour", Literal::Colour([0.1, 0.2, 0.3, 1.0]));
    rig.put("all.file", Literal::File("a folder/b\\c.txt".to_owned()));
    let point = |x, y, pressure| StrokePoint { x, y, pressure };
    let strokes = vec![
        Stroke {
            name: "ring // one".into(),
            closed: true,
            points: vec![point(0.1, 0.2, None), point(0.3, -0.4, None)],
        },
        Stroke {
            name: String::new(),
            closed: false,
            points: vec![point(1.0, 2.0, Some(0.5)), point(1e9, 2e-9, Some(0.0))],
        },
        Stroke { name: "empty".into(), closed: false, points: vec![] },
    ];
    rig.put("all.strokes", Literal::Strokes(strokes));
    rig.link("sum of two.sum", "all.length");
    rig.graph.set_position(rig.id("all"), Some([120.5, -80.0])).unwrap();
    rig.graph.set_note(rig.id("sum of two"), "why\nnot").unwrap();
    rig
}

#[test]
fn everything_is_read_back() {
    assert_round_trip(&full());
}

#[test]
fn the_text_is_readable_and_stable() {
    let expected = r#"(
    version: 1,
    notes: "Two \"quoted\" lines,\n\\ and a tab\t // no comment",
    nodes: {
        "all": (
            kind: "everything",
            inputs: {
                "number": 0.1,
                "length": Link("sum of two.sum"),
                "integer": -9223372036854775808,
                "boolean": true,
                "text": Text("// \u{7f}\u{0}\u{1b} /* "#
        .to_owned()
        + "\u{2028} é \u{1f600}"
        + r#""),
                "choice": Choice("up"),
                "vector": Vector(1.0, -0.0, 1e-300),
                "colour": Colour(0.1, 0.2, 0.3, 1.0),
                "file": File("a folder/b\\c.txt"),
                "strokes": Strokes([
                    (
                        name: "ring // one",
                        closed: true,
                        points: [
                            (0.1, 0.2),
                            (0.3, -0.4),
                        ],
                    ),
                    (
                        name: "",
                        closed: false,
                        points: [
                            (1.0, 2.0, 0.5),
                            (1000000000.0, 2e-9, 0.0),
                        ],
                    ),
                    (
                        name: "empty",
                        closed: false,
                        points: [
                        ],
                    ),
                ]),
            },
        ),
        "sum of two": (
            kind: "add",
            note: "why\nnot",
        ),
    },
    layout: {
        "all": (120.5, -80.0),
    },
)
"#;
    assert_eq!(file::to_text(&full().graph), expected);
}

#[test]
fn an_empty_graph_is_a_small_file() {
    let rig = Rig::default();
    assert_eq!(file::to_text(&rig.graph), "(\n    version: 1,\n    nodes: {\n    },\n)\n");
    assert_round_trip(&rig);
}

#[test]
fn one_number_is_one_line() {
    let mut rig = full();
    let before = file::to_text(&rig.graph);
    let differing = |rig: &Rig| {
        let after = file::to_text(&rig.graph);
        assert_eq!(after.lines().count(), before.lines().count());
        before.lines().zip(after.lines()).filter(|(a, b)| a != b).map(|(_, b)| b.trim().to_owned()).collect::<Vec<_>>()
    };
    rig.put("all.number", Literal::Number(0.2));
    assert_eq!(differing(&rig), ["\"number\": 0.2,"]);
    rig.put("all.number", Literal::Number(0.1));
    assert_eq!(differing(&rig), [""; 0]);
    let Some(Source::Literal { literal: Literal::Strokes(mut strokes), .. }) =
        rig.graph.node(rig.id("all")).unwrap().source("strokes").cloned()
    else {
        unreachable!("it was set");
    };
    strokes[1].points[1].y = 7.0;
    rig.put("all.strokes", Literal::Strokes(strokes));
    assert_eq!(differing(&rig), ["(1000000000.0, 7.0, 0.0),"]);
    rig.graph.set_position(rig.id("all"), Some([0.0, 0.0])).unwrap();
    assert_eq!(differing(&rig).len(), 2);
}

#[test]
fn a_new_node_is_added_behind_the_others() {
    let mut rig = full();
    let before = file::to_text(&rig.graph);
    rig.add("add", "a new one");
    let after = file::to_text(&rig.graph);
    let added = "        \"a new one\": (\n            kind: \"add\",\n        ),\n";
    assert_eq!(after.replace(added, ""), before);
    rig.graph.remove(rig.id("a new one")).unwrap();
    assert_eq!(file::to_text(&rig.graph), before);
}

#[test]
fn results_are_the_same_after_loading() {
    let mut rig = full();
    let before = rig.evaluate(&["all"]);
    let loaded = file::from_text(&rig.catalogue, &file::to_text(&rig.graph)).unwrap();
    let all = loaded.graph.find("all").unwrap();
    let after = rig.evaluator.evaluate(&rig.catalogue, &loaded.graph, &Request::nodes(&[all]));
    assert_eq!(before.values(rig.id("all")), after.values(all));
    assert_eq!(after.run_count(), 0, "the loaded graph hits what was computed before");
}

fn extreme() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<f64>().prop_filter("finite", |n| n.is_finite()),
        prop::sample::select(vec![
            0.0,
            -0.0,
            1.0,
            f64::MAX,
            f64::MIN,
            f64::MIN_POSITIVE,
            5e-324,
            f64::EPSILON,
            1e16,
            0.1,
            -1e300
        ]),
        (-1000_i32..1000).prop_map(f64::from),
    ]
}

fn text() -> impl Strategy<Value = String> {
    prop_oneof![any::<String>(), "[a-z \"\\\\/*#\n\r\t(){}\\[\\],:.]{0,20}", Just("r#\"x\"#".to_owned())]
}

fn stroke() -> impl Strategy<Value = Stroke> {
    let point =
        (extreme(), extreme(), prop::option::of(extreme())).prop_map(|(x, y, pressure)| StrokePoint { x, y, pressure });
    (text(), any::<bool>(), prop::collection::vec(point, 0..6)).prop_map(|(name, closed, points)| Stroke {
        name,
        closed,
        points,
    })
}

fn literal() -> impl Strategy<Value = (&'static str, Literal)> {
    prop_oneof![
        extreme().prop_map(|n| ("number", Literal::Number(n))),
        (0.001..=10.0).prop_map(|n| ("length", Literal::Number(n))),
        any::<i64>().prop_map(|n| ("integer", Literal::Integer(n))),
        any::<bool>().prop_map(|b| ("boolean", Literal::Boolean(b))),
        text().prop_map(|t| ("text", Literal::Text(t))),
        prop::sample::select(vec!["down", "up"]).prop_map(|c| ("choice", Literal::Choice(c.to_owned()))),
        prop::array::uniform3(extreme()).prop_map(|v| ("vector", Literal::Vector(v))),
        prop::array::uniform4(0.0..=1.0).prop_map(|c| ("colour", Literal::Colour(c))),
        text().prop_map(|t| ("file", Literal::File(t))),
        prop::collection::vec(stroke(), 0..4).prop_map(|s| ("strokes", Literal::Strokes(s))),
    ]
}

/// One step in the life of a graph.
#[derive(Clone, Debug)]
enum Edit {
    Add(usize, String),
    Remove(usize),
    Rename(usize, String),
    Set(usize, &'static str, Literal),
    Connect(usize, usize, usize, usize),
    Place(usize, Option<[f64; 2]>),
    Note(usize, String),
}

fn name() -> impl Strategy<Value = String> {
    prop_oneof!["[a-c]", "[a-zA-Z0-9_-]{1,8}", "[äöü衣服éα-ω][ a-z0-9]{0,5}[0-9]"]
}

fn edit() -> impl Strategy<Value = Edit> {
    let place = any::<usize>();
    prop_oneof![
        4 => (0..10_usize, name()).prop_map(|(kind, name)| Edit::Add(kind, name)),
        1 => place.prop_map(Edit::Remove),
        1 => (place, name()).prop_map(|(node, name)| Edit::Rename(node, name)),
        4 => (place, literal()).prop_map(|(node, (input, literal))| Edit::Set(node, input, literal)),
        6 => (place, place, place, place).prop_map(|(a, b, c, d)| Edit::Connect(a, b, c, d)),
        1 => (place, prop::option::of(prop::array::uniform2(extreme()))).prop_map(|(node, at)| Edit::Place(node, at)),
        1 => (place, text()).prop_map(|(node, note)| Edit::Note(node, note)),
    ]
}

fn apply(rig: &mut Rig, edit: Edit) {
    let ids: Vec<_> = rig.graph.nodes().map(|(id, _)| id).collect();
    let pick = |index: usize| ids[index % ids.len()];
    if let Edit::Add(kind, name) = edit {
        let kinds: Vec<_> = rig.catalogue.kinds().map(|kind| kind.name().to_owned()).collect();
        // A taken name is refused, which is fine here, as are links that do not fit.
        let _ = rig.graph.add(&rig.catalogue, &kinds[kind % kinds.len()], &name);
        return;
    }
    if ids.is_empty() {
        return;
    }
    match edit {
        Edit::Add(..) => {}
        Edit::Remove(node) => rig.graph.remove(pick(node)).unwrap(),
        Edit::Rename(node, name) => drop(rig.graph.rename(pick(node), &name)),
        Edit::Set(node, input, literal) => drop(rig.graph.set(pick(node), input, literal)),
        Edit::Connect(from, output, to, input) => {
            let (from, to) = (pick(from), pick(to));
            let outputs: Vec<_> = rig.graph.node(from).unwrap().kind().unwrap().outputs().to_vec();
            let inputs: Vec<_> = rig.graph.node(to).unwrap().kind().unwrap().inputs().to_vec();
            if !outputs.is_empty() && !inputs.is_empty() {
                let (output, input) = (&outputs[output % outputs.len()].name, &inputs[input % inputs.len()].name);
                let _ = rig.graph.connect(&rig.catalogue, from, output, to, input);
            }
        }
        Edit::Place(node, at) => rig.graph.set_position(pick(node), at).unwrap(),
        Edit::Note(node, note) => rig.graph.set_note(pick(node), note).unwrap(),
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(256) })]

    #[test]
    fn any_graph_is_read_back(edits in prop::collection::vec(edit(), 0..60), notes in text()) {
        let mut rig = Rig::default();
        rig.graph.notes = notes;
        for edit in edits {
            apply(&mut rig, edit);
        }
        assert_round_trip(&rig);
    }

    #[test]
    fn a_number_keeps_all_its_digits((input, literal) in literal()) {
        let mut rig = Rig::default();
        rig.add("everything", "all");
        rig.put(&format!("all.{input}"), literal);
        assert_round_trip(&rig);
    }
}
