//! Whatever is done to a graph, undoing all of it gives the graph as it was, and redoing all of it the one it became;
//! on the way it never has a cycle, a dangling link or a literal that is out of range.

#![allow(clippy::unwrap_used, reason = "in tests a failing unwrap is a failing test")]

mod kinds;

use std::collections::BTreeMap;
use std::sync::Arc;

use kinds::{Rig, Samples};
use maquette_graph::edit::compound::{self, Incoming};
use maquette_graph::{
    Catalogue, Edit, Evaluator, Frame, Graph, GraphOutput, History, Literal, NodeId, NodeRecord, OutcomeState,
    OutputSource, Parameter, ReferencePicture, Repeat, Request, Source, WireType, file,
};
use proptest::prelude::*;

/// A graph with text that is not understood, so that edits meet it.
const STRANGE: &str = r#"(version: 1, notes: "begun", nodes: {
    "a": (kind: "add", inputs: { "a": 1.5, "b": Link("missing.sum"), "unheard": Text("of") }, colour: "red"),
    "strange": (kind: "from-the-future", inputs: { "in": Link("a.sum"), "power": Watts(3) }),
    "b": (kind: "add", note: "n", inputs: { "a": Link("strange.out"), "b": Link("a.sum") }),
    "count": (kind: "count", inputs: { "count": 1000, "text": Text("x") }),
}, layout: { "a": (1.0, 2.0), "nobody": (5.0, 6.0) }, future: (1, 2))"#;

/// What an artist does next; numbers choose among what is there.
#[derive(Clone, Debug)]
enum Deed {
    Add(usize, String),
    Fill(usize, String, usize, usize),
    Remove(usize),
    Rename(usize, String),
    Set(usize, usize, Literal),
    Reset(usize, usize),
    Connect(usize, usize, usize, usize),
    Disconnect(usize, usize),
    Move(usize, Option<[f64; 2]>),
    Note(usize, String),
    GraphNotes(String),
    Collapse(usize, bool),
    Frame(String, [f64; 2]),
    Reference(String, f64),
    Insert(usize, usize, usize),
    Replace(usize, usize),
    Dissolve(usize),
    Duplicate(Vec<usize>, bool),
    CopyPaste(Vec<usize>),
    CutPaste(Vec<usize>),
    Mute(usize, bool),
    AddParameter(usize, String, Option<Literal>, bool),
    RemoveParameter(usize),
    ChangeParameter(usize, String, Option<Literal>),
    SetParameter(usize, Option<Literal>),
    Use(usize, usize, usize),
    AddOutput(usize, String, usize, usize),
    RemoveOutput(usize),
    ChangeOutput(usize, String, usize, usize),
    Promote(usize, usize),
    Group(Vec<usize>, String),
    Ungroup(usize),
    /// Another node's graph, repeated in some way.
    SetBody(usize, usize, usize),
    Within(usize, Vec<Deed>),
    Undo,
    Redo,
    Jump(usize),
}

fn text() -> impl Strategy<Value = String> {
    prop_oneof![Just(String::new()), "[a-c ]{1,3}", "\\PC{0,6}"]
}

fn name() -> impl Strategy<Value = String> {
    prop_oneof!["[a-c]", "[a-c] [0-9]", "[a-zA-Z0-9_-]{1,8}", "\\PC{1,4}"]
}

fn literal() -> impl Strategy<Value = Literal> {
    prop_oneof![
        prop_oneof![any::<f64>(), -10.0..10.0].prop_map(Literal::Number),
        prop_oneof![any::<i64>(), 0_i64..120].prop_map(Literal::Integer),
        any::<bool>().prop_map(Literal::Boolean),
        text().prop_map(Literal::Text),
        prop::sample::select(vec!["down", "up", "left"]).prop_map(|c| Literal::Choice(c.to_owned())),
        prop::array::uniform3(-10.0..10.0).prop_map(Literal::Vector),
    ]
}

fn deed() -> impl Strategy<Value = Deed> {
    let n = any::<usize>;
    let deeds = prop::collection::vec(plain_deed(), 1..4);
    let more = prop::collection::vec(prop_oneof![2 => plain_deed(), 1 => plain_deed_within()], 1..4);
    prop_oneof![
        12 => plain_deed(),
        2 => (n(), deeds).prop_map(|(node, deeds)| Deed::Within(node, deeds)),
        1 => (n(), more).prop_map(|(node, deeds)| Deed::Within(node, deeds)),
    ]
}

fn plain_deed_within() -> impl Strategy<Value = Deed> {
    (any::<usize>(), prop::collection::vec(plain_deed(), 1..3)).prop_map(|(node, deeds)| Deed::Within(node, deeds))
}

fn plain_deed() -> impl Strategy<Value = Deed> {
    let n = any::<usize>;
    let some = || prop::collection::vec(any::<usize>(), 1..4);
    let place = || prop::option::of(prop::array::uniform2(-1e3..1e3));
    prop_oneof![
        5 => (n(), name()).prop_map(|(kind, name)| Deed::Add(kind, name)),
        2 => (n(), name(), n(), n()).prop_map(|(kind, name, from, input)| Deed::Fill(kind, name, from, input)),
        2 => n().prop_map(Deed::Remove),
        2 => (n(), name()).prop_map(|(node, name)| Deed::Rename(node, name)),
        4 => (n(), n(), literal()).prop_map(|(node, input, literal)| Deed::Set(node, input, literal)),
        2 => (n(), n()).prop_map(|(node, input)| Deed::Reset(node, input)),
        8 => (n(), n(), n(), n()).prop_map(|(a, b, c, d)| Deed::Connect(a, b, c, d)),
        1 => (n(), n()).prop_map(|(node, input)| Deed::Disconnect(node, input)),
        1 => (n(), place()).prop_map(|(node, at)| Deed::Move(node, at)),
        1 => (n(), text()).prop_map(|(node, note)| Deed::Note(node, note)),
        1 => text().prop_map(Deed::GraphNotes),
        1 => (n(), any::<bool>()).prop_map(|(node, collapsed)| Deed::Collapse(node, collapsed)),
        1 => (text(), prop::array::uniform2(-9.0..90.0)).prop_map(|(title, size)| Deed::Frame(title, size)),
        1 => (text(), -0.5..1.5).prop_map(|(file, opacity)| Deed::Reference(file, opacity)),
        2 => (n(), n(), n()).prop_map(|(node, input, kind)| Deed::Insert(node, input, kind)),
        2 => (n(), n()).prop_map(|(node, kind)| Deed::Replace(node, kind)),
        1 => n().prop_map(Deed::Dissolve),
        1 => (some(), any::<bool>()).prop_map(|(nodes, keep)| Deed::Duplicate(nodes, keep)),
        1 => some().prop_map(Deed::CopyPaste),
        1 => some().prop_map(Deed::CutPaste),
        2 => interface_deed(),
        2 => body_deed(),
        2 => Just(Deed::Undo),
        1 => Just(Deed::Redo),
        1 => n().prop_map(Deed::Jump),
    ]
}

fn interface_deed() -> impl Strategy<Value = Deed> {
    let n = any::<usize>;
    let value = || prop::option::of(literal());
    prop_oneof![
        3 => (n(), name(), value(), any::<bool>()).prop_map(|(at, name, value, o)| Deed::AddParameter(at, name, value, o)),
        1 => n().prop_map(Deed::RemoveParameter),
        2 => (n(), name(), value()).prop_map(|(which, name, value)| Deed::ChangeParameter(which, name, value)),
        2 => (n(), value()).prop_map(|(which, value)| Deed::SetParameter(which, value)),
        6 => (n(), n(), n()).prop_map(|(node, input, which)| Deed::Use(node, input, which)),
        3 => (n(), name(), n(), n()).prop_map(|(at, name, node, output)| Deed::AddOutput(at, name, node, output)),
        1 => n().prop_map(Deed::RemoveOutput),
        2 => (n(), name(), n(), n()).prop_map(|(which, name, node, out)| Deed::ChangeOutput(which, name, node, out)),
    ]
}

fn body_deed() -> impl Strategy<Value = Deed> {
    let n = any::<usize>;
    prop_oneof![
        1 => (n(), any::<bool>()).prop_map(|(node, muted)| Deed::Mute(node, muted)),
        2 => (n(), n()).prop_map(|(node, input)| Deed::Promote(node, input)),
        4 => (prop::collection::vec(n(), 1..5), name()).prop_map(|(nodes, name)| Deed::Group(nodes, name)),
        1 => n().prop_map(Deed::Ungroup),
        3 => (n(), n(), n()).prop_map(|(node, from, repeat)| Deed::SetBody(node, from, repeat)),
    ]
}

fn pick<T: Clone>(from: &[T], index: usize) -> Option<T> {
    if from.is_empty() { None } else { Some(from[index % from.len()].clone()) }
}

/// The inputs that a node has: those of its kind, and those that hold something.
fn inputs(graph: &Graph, node: NodeId) -> Vec<String> {
    let node = graph.node(node).unwrap();
    let declared = node.kind().map(|kind| kind.inputs()).unwrap_or_default().iter().map(|spec| spec.name.clone());
    let mut names: Vec<_> = declared.chain(node.sources().map(|(name, _)| name.to_owned())).collect();
    names.sort();
    names.dedup();
    names
}

fn outputs(graph: &Graph, node: NodeId) -> Vec<String> {
    let kind = graph.node(node).unwrap().kind();
    kind.map_or(vec!["out".to_owned()], |kind| kind.outputs().iter().map(|spec| spec.name.clone()).collect())
}

/// The edits of a deed; `None` where there is nothing to do it to, or it is refused.
fn edits(graph: &Graph, catalogue: &Catalogue, deed: &Deed) -> Option<Vec<Edit>> {
    let ids: Vec<_> = graph.nodes().map(|(id, _)| id).collect();
    let node = |index: &usize| pick(&ids, *index);
    let nodes = |indices: &[usize]| -> Vec<NodeId> { indices.iter().filter_map(node).collect() };
    let kinds: Vec<_> = catalogue.kinds().map(|kind| kind.name().to_owned()).collect();
    let kind = |index: &usize| pick(&kinds, *index);
    let edit = match deed {
        Deed::Add(k, name) => Edit::add(kind(k)?, name),
        Deed::Fill(k, name, from, input) => {
            let (kind, from) = (kind(k)?, node(from)?);
            let inputs = catalogue.kind(&kind)?.inputs().iter().map(|spec| spec.name.clone()).collect::<Vec<_>>();
            let record =
                NodeRecord::new(&kind, name).link(pick(&inputs, *input)?, from, pick(&outputs(graph, from), *k)?);
            Edit::AddNode(Box::new(record.at([1.0, 2.0]).note("filled")))
        }
        Deed::Remove(n) => Edit::RemoveNode(node(n)?),
        Deed::Rename(n, name) => Edit::Rename { node: node(n)?, name: name.clone() },
        Deed::Set(n, input, literal) => {
            let node = node(n)?;
            Edit::set(node, pick(&inputs(graph, node), *input)?, literal.clone())
        }
        Deed::Reset(n, input) => {
            let node = node(n)?;
            Edit::Reset { node, input: pick(&inputs(graph, node), *input)? }
        }
        Deed::Connect(a, output, b, input) => {
            let (from, to) = (node(a)?, node(b)?);
            Edit::connect(from, pick(&outputs(graph, from), *output)?, to, pick(&inputs(graph, to), *input)?)
        }
        Deed::Disconnect(n, input) => {
            let to = node(n)?;
            Edit::Disconnect { to, input: pick(&inputs(graph, to), *input)? }
        }
        Deed::Move(n, position) => Edit::Move { node: node(n)?, position: *position },
        Deed::Note(n, note) => Edit::Note { node: node(n)?, note: note.clone() },
        Deed::GraphNotes(notes) => Edit::GraphNotes(notes.clone()),
        Deed::Collapse(n, collapsed) => Edit::Collapse { node: node(n)?, collapsed: *collapsed },
        Deed::Frame(title, size) => {
            let frame = Frame { title: title.clone(), colour: [0.5; 3], at: *size, size: *size };
            Edit::Frames(graph.frames().iter().cloned().chain([frame]).collect())
        }
        Deed::Reference(file, opacity) => {
            let [view, file] = ["side".to_owned(), file.clone()];
            let (centre, width, opacity) = ([0.0; 2], 1.0, *opacity);
            Edit::References(vec![ReferencePicture { view, file, centre, width, opacity, locked: false, hidden: true }])
        }
        Deed::Insert(n, input, k) => {
            let to = node(n)?;
            let input = pick(&inputs(graph, to), *input)?;
            return compound::insert_into_link(graph, catalogue, to, &input, &kind(k)?).ok().map(|plan| plan.edits);
        }
        Deed::Replace(n, k) => {
            return Some(compound::replace_kind(graph, catalogue, node(n)?, &kind(k)?).unwrap().edits);
        }
        Deed::Dissolve(n) => return Some(compound::dissolve(graph, catalogue, node(n)?).unwrap().edits),
        Deed::Duplicate(list, keep) => {
            let incoming = if *keep { Incoming::Keep } else { Incoming::Drop };
            return Some(compound::duplicate(graph, &nodes(list), incoming, [9.0, 9.0]).unwrap().edits);
        }
        Deed::CopyPaste(list) => {
            node(list.first()?)?;
            let text = compound::copy(graph, &nodes(list)).unwrap();
            return Some(compound::paste(graph, catalogue, &text, [1.0, 1.0]).unwrap().edits);
        }
        Deed::CutPaste(list) => {
            node(list.first()?)?;
            let mut selected = nodes(list);
            selected.sort();
            selected.dedup();
            let text = compound::copy(graph, &selected).unwrap();
            let cut: Vec<_> = selected.into_iter().map(Edit::RemoveNode).collect();
            let mut without = graph.clone();
            without.apply_all(catalogue, &cut).unwrap();
            let plan = compound::paste(&without, catalogue, &text, [0.0; 2]).unwrap();
            return Some(cut.into_iter().chain(plan.edits).collect());
        }
        Deed::Mute(n, muted) => Edit::Mute { node: node(n)?, muted: *muted },
        Deed::AddParameter(at, name, value, optional) => {
            let parameter = match value {
                Some(value) => Parameter::new(name, value.clone()).describe("Something."),
                None if *optional => Parameter::optional(name, WireType::of::<Samples>()),
                None => Parameter::required(name, WireType::of::<f64>()).soft_range(0.0, 1.0),
            };
            Edit::AddParameter { index: at % (1 + graph.parameters().len()), parameter: parameter.into() }
        }
        Deed::RemoveParameter(which) => Edit::RemoveParameter(parameter(graph, *which)?.name().to_owned()),
        Deed::ChangeParameter(which, name, value) => {
            let old = parameter(graph, *which)?.name().to_owned();
            let parameter = match value {
                Some(value) => Parameter::new(name, value.clone()),
                None => Parameter::required(name, WireType::of::<f64>()),
            };
            Edit::ChangeParameter { name: old, parameter: parameter.into() }
        }
        Deed::SetParameter(which, literal) => {
            Edit::SetParameter { parameter: parameter(graph, *which)?.name().to_owned(), literal: literal.clone() }
        }
        Deed::Use(n, input, which) => {
            let (node, parameter) = (node(n)?, parameter(graph, *which)?.name().to_owned());
            Edit::UseParameter { node, input: pick(&inputs(graph, node), *input)?, parameter }
        }
        Deed::AddOutput(at, name, n, output) => {
            let from = node(n)?;
            let output = GraphOutput::new(name, from, pick(&outputs(graph, from), *output)?);
            Edit::AddOutput { index: at % (1 + graph.outputs().len()), output: output.into() }
        }
        Deed::RemoveOutput(which) => Edit::RemoveOutput(output(graph, *which)?.name().to_owned()),
        Deed::ChangeOutput(which, name, n, from) => {
            let (old, node) = (output(graph, *which)?.name().to_owned(), node(n)?);
            let output = GraphOutput::new(name, node, pick(&outputs(graph, node), *from)?).describe("Out.");
            Edit::ChangeOutput { name: old, output: output.into() }
        }
        Deed::Promote(n, input) => {
            let node = node(n)?;
            let input = pick(&inputs(graph, node), *input)?;
            return compound::promote(graph, node, &input).ok().map(|plan| plan.edits);
        }
        Deed::Group(list, name) => {
            return compound::group(graph, catalogue, &nodes(list), name).ok().map(|plan| plan.edits);
        }
        Deed::Ungroup(n) => {
            let bodies: Vec<_> = ids.iter().copied().filter(|id| graph.node(*id).unwrap().body().is_some()).collect();
            return compound::ungroup(graph, catalogue, pick(&bodies, *n)?).ok().map(|plan| plan.edits);
        }
        Deed::SetBody(n, from, repeat) => {
            let bodies: Vec<_> = ids.iter().copied().filter(|id| graph.node(*id).unwrap().body().is_some()).collect();
            let body = graph.node(pick(&bodies, *from)?).unwrap().body().unwrap();
            let inner = body.graph()?;
            let repeat = match repeat % 4 {
                0 => Repeat::Once,
                1 => Repeat::Times,
                2 => Repeat::Each(parameter(inner, *from)?.name().to_owned()),
                _ => Repeat::FeedBack(
                    [(parameter(inner, *from)?.name().to_owned(), output(inner, *n)?.name().to_owned())].into(),
                ),
            };
            Edit::SetBody { node: pick(&bodies, *n)?, body: Arc::new((**body).clone().repeated(repeat)) }
        }
        Deed::Within(n, deeds) => {
            let bodies: Vec<_> = ids.iter().copied().filter(|id| graph.node(*id).unwrap().body().is_some()).collect();
            let node = pick(&bodies, *n)?;
            let mut inner = graph.node(node)?.body()?.graph()?.clone();
            let mut all = Vec::new();
            for deed in deeds {
                let planned = edits(&inner, catalogue, deed).unwrap_or_default();
                if inner.apply_all(catalogue, &planned).is_ok() {
                    all.extend(planned);
                }
            }
            Edit::Within { node, edit: Edit::Several(all).into() }
        }
        Deed::Undo | Deed::Redo | Deed::Jump(_) => return None,
    };
    Some(vec![edit])
}

fn parameter(graph: &Graph, which: usize) -> Option<&Parameter> {
    graph.parameters().nth(which % graph.parameters().len().max(1))
}

fn output(graph: &Graph, which: usize) -> Option<&GraphOutput> {
    graph.outputs().nth(which % graph.outputs().len().max(1))
}

fn state(graph: &Graph) -> (String, Vec<(NodeId, String)>) {
    (file::to_text(graph), graph.nodes().map(|(id, node)| (id, node.name().to_owned())).collect())
}

fn assert_sound(graph: &Graph, catalogue: &Catalogue) {
    for output in graph.outputs() {
        if let OutputSource::Link(link) = output.source() {
            let kind = graph.node(link.node).unwrap().kind();
            assert!(kind.is_none_or(|kind| kind.find_output(&link.output).is_some()));
        }
    }
    for (_, node) in graph.nodes() {
        assert_eq!(node.acting_kind().is_some(), node.kind().is_some());
        if let Some(body) = node.body() {
            let made = body.kind(catalogue, node.kind_name());
            if let Some(kind) = node.kind() {
                let made = made.unwrap();
                assert_eq!((made.inputs(), made.outputs()), (kind.inputs(), kind.outputs()));
            }
            body.graph().into_iter().for_each(|graph| assert_sound(graph, catalogue));
        }
    }
    let mut feeds: BTreeMap<NodeId, Vec<(NodeId, String)>> = BTreeMap::new();
    for (id, node) in graph.nodes() {
        assert_eq!(graph.find(node.name()), Some(id));
        for (input, source) in node.sources() {
            let spec = node.kind().and_then(|kind| kind.find_input(input));
            match source {
                Source::Link(link) => {
                    let from = graph.node(link.node).unwrap();
                    feeds.entry(link.node).or_default().push((id, input.to_owned()));
                    let given = from.kind().map(|kind| kind.find_output(&link.output).unwrap().1.wire);
                    if let (Some(given), Some(spec)) = (given, spec) {
                        assert!(catalogue.fits(given, spec.wire));
                    }
                    assert!(node.kind().is_none() || spec.is_some());
                }
                Source::Literal { literal, value } => {
                    assert_eq!(literal.to_value().hash(), value.hash());
                    assert_eq!(literal.not_finite(), None);
                    let number = match literal {
                        Literal::Number(number) => Some(*number),
                        Literal::Integer(integer) => Some(*integer as f64),
                        _ => None,
                    };
                    if let (Some(range), Some(number)) = (spec.and_then(|spec| spec.range), number) {
                        assert!(range.contains(number), "{number} at {input} of {}", node.name());
                    }
                }
                Source::Parameter(name) => {
                    let given = graph.parameter(name).unwrap().wire();
                    assert!(node.kind().is_none() || catalogue.fits(given, spec.unwrap().wire));
                }
                Source::Unread(_) => {}
            }
        }
    }
    // What the graph believes to feed is what the inputs say; and taking away what depends on nothing leaves nothing.
    let mut left: BTreeMap<NodeId, usize> = BTreeMap::new();
    for (id, node) in graph.nodes() {
        let mut expected = feeds.remove(&id).unwrap_or_default();
        expected.sort();
        assert_eq!(graph.fed_by(id), expected);
        left.insert(id, node.sources().filter(|(_, source)| matches!(source, Source::Link(_))).count());
    }
    while let Some(id) = left.iter().find(|(_, links)| **links == 0).map(|(id, _)| *id) {
        left.remove(&id);
        for (to, _) in graph.fed_by(id) {
            *left.get_mut(&to).unwrap() -= 1;
        }
    }
    assert!(left.is_empty(), "a cycle among {left:?}");
}

/// A rig whose numbers can be listed and collected.
fn rig() -> Rig {
    let mut rig = Rig::default();
    rig.catalogue
        .list::<Samples, f64>(|list| list.0.clone(), |items| Ok(Samples(items.iter().map(|n| **n).collect())))
        .unwrap();
    rig
}

/// What these nodes give, as text; for those that are there.
fn given(rig: &Rig, names: &[String], threads: usize) -> Vec<String> {
    let ids: Vec<_> = names.iter().filter_map(|name| rig.graph.find(name)).collect();
    let options = maquette_graph::EvaluatorOptions { threads, ..Default::default() };
    let evaluation = Evaluator::new(&options).evaluate(&rig.catalogue, &rig.graph, &Request::nodes(&ids));
    let said = ids.iter().map(|id| match evaluation.outcome(*id).map(|outcome| &outcome.state) {
        Some(OutcomeState::Done { values, .. }) => {
            values.iter().flat_map(|values| values.iter()).map(|v| v.hash().to_string()).collect::<Vec<_>>().join(" ")
        }
        // A failure within a group is laid at the group.
        Some(OutcomeState::Failed(_) | OutcomeState::Waiting(_)) => "nothing".to_owned(),
        other => format!("{other:?}"),
    });
    said.collect()
}

fn live(rig: &mut Rig, deeds: &[Deed], together: usize) {
    let mut history = History::new();
    // The states before each step and after the last one, for the steps that are there at present.
    let mut states = vec![state(&rig.graph)];
    for (number, deed) in deeds.iter().enumerate() {
        match deed {
            Deed::Undo => drop(history.undo(&mut rig.graph, &rig.catalogue).unwrap()),
            Deed::Redo => drop(history.redo(&mut rig.graph, &rig.catalogue).unwrap()),
            Deed::Jump(to) => history.jump(&mut rig.graph, &rig.catalogue, to % (states.len() + 1)).unwrap(),
            _ => {
                let before = state(&rig.graph);
                // Copying nothing does nothing.
                let Some(edits) = edits(&rig.graph, &rig.catalogue, deed).filter(|edits| !edits.is_empty()) else {
                    continue;
                };
                let merges = together > 1;
                if merges {
                    history.begin_merging("some", format!("{}", number / together));
                } else {
                    history.begin("one");
                }
                let position = history.position();
                let result = history.apply_all(&mut rig.graph, &rig.catalogue, &edits);
                history.commit();
                if let Err(error) = result {
                    assert!(edits.len() == 1, "{deed:?} was planned and fails: {error}");
                    assert_eq!(state(&rig.graph), before, "{deed:?}: {error}");
                    continue;
                }
                states.truncate(position + 1);
                // A step that was merged replaces what the one before led to.
                states.truncate(history.position());
                states.push(state(&rig.graph));
                assert_sound(&rig.graph, &rig.catalogue);
                let text = file::to_text(&rig.graph);
                let again = file::from_text(&rig.catalogue, &text).unwrap();
                assert_eq!(file::to_text(&again.graph), text);
                assert_sound(&again.graph, &rig.catalogue);
            }
        }
        assert_eq!(state(&rig.graph), states[history.position()], "{deed:?}");
    }
    assert_eq!(history.names().len() + 1, states.len());
    history.jump(&mut rig.graph, &rig.catalogue, usize::MAX).unwrap();
    for expected in states.iter().rev() {
        assert_eq!(&state(&rig.graph), expected);
        assert_sound(&rig.graph, &rig.catalogue);
        history.undo(&mut rig.graph, &rig.catalogue).unwrap();
    }
    for expected in &states {
        assert_eq!(&state(&rig.graph), expected);
        history.redo(&mut rig.graph, &rig.catalogue).unwrap();
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(256) })]

    #[test]
    fn what_is_done_is_undone_and_redone(deeds in prop::collection::vec(deed(), 0..80)) {
        live(&mut rig(), &deeds, 1);
    }

    #[test]
    fn so_it_is_with_what_is_not_understood(deeds in prop::collection::vec(deed(), 0..40), together in 1..6_usize) {
        let mut rig = rig();
        rig.graph = file::from_text(&rig.catalogue, STRANGE).unwrap().graph;
        live(&mut rig, &deeds, together);
    }

    #[test]
    fn undone_runs_nothing(deeds in prop::collection::vec(deed(), 0..30)) {
        let mut rig = rig();
        rig.chain(4);
        rig.evaluate(&["n0", "n1", "n2", "n3"]);
        let mut history = History::new();
        for deed in &deeds {
            if let Some(edits) = edits(&rig.graph, &rig.catalogue, deed) {
                let _ = history.step(&mut rig.graph, &rig.catalogue, "step", &edits);
            }
        }
        let _ = rig.graph.find("n3").map(|_| rig.evaluate(&["n3"]));
        history.jump(&mut rig.graph, &rig.catalogue, 0).unwrap();
        prop_assert_eq!(rig.ran(&["n0", "n1", "n2", "n3"]), Vec::<String>::new());
    }

    #[test]
    fn grouped_and_ungrouped_it_gives_the_same(
        deeds in prop::collection::vec(deed(), 0..40),
        selected in prop::collection::vec(any::<usize>(), 1..6),
    ) {
        let mut rig = rig();
        rig.chain(5);
        for deed in &deeds {
            if let Some(edits) = edits(&rig.graph, &rig.catalogue, deed) {
                let _ = rig.graph.apply_all(&rig.catalogue, &edits);
            }
        }
        let ids: Vec<_> = rig.graph.nodes().map(|(id, _)| id).collect();
        let selected: Vec<_> = selected.iter().filter_map(|index| pick(&ids, *index)).collect();
        let Ok(plan) = compound::group(&rig.graph, &rig.catalogue, &selected, "a group") else { return Ok(()) };
        let names = |graph: &Graph| graph.nodes().map(|(_, node)| node.name().to_owned()).collect::<Vec<_>>();
        let all = names(&rig.graph);
        let before_all = given(&rig, &all, 1);
        prop_assert_eq!(&given(&rig, &all, 8), &before_all);
        let inverses = rig.graph.apply_all(&rig.catalogue, &plan.edits).unwrap();
        let outside: Vec<_> = names(&rig.graph).into_iter().filter(|name| all.contains(name)).collect();
        let is_outside = |name: &&String| outside.contains(name);
        let before: Vec<_> = all.iter().zip(&before_all).filter(|(name, _)| is_outside(name)).map(|(_, g)| g.clone()).collect();
        // Where one of several nodes in the group fails, the whole group does, and others may wait for it.
        let same = |before: &[String], after: &[String]| before.iter().zip(after).all(|(b, a)| a == b || a == "nothing");
        let grouped = given(&rig, &outside, 1);
        let some_fail = before_all.iter().any(|said| said == "nothing");
        prop_assert!(if some_fail { same(&before, &grouped) } else { before == grouped }, "{before:?} {grouped:?}");
        prop_assert_eq!(&given(&rig, &outside, 8), &grouped);
        let group = plan.nodes[0];
        if let Ok(back) = compound::ungroup(&rig.graph, &rig.catalogue, group) {
            prop_assert_eq!(&back.remarks, &[]);
            rig.graph.apply_all(&rig.catalogue, &back.edits).unwrap();
            prop_assert_eq!(&given(&rig, &outside, 1), &before);
        }
        drop(inverses);
    }
}
