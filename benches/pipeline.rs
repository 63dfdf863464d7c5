//! The detail generator and the whole vest, beside the figures the thesis gives: 0.09 s a detail, 0.17 s a primitive
//! (Python in Houdini on a 3.2 GHz Xeon, section 6.5). Run with `cargo bench --bench pipeline`.
#![allow(missing_docs, clippy::expect_used, reason = "a benchmark has no users, and stops where it is wrong")]

use std::hint::black_box;
use std::path::Path;

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use maquette_graph::{Edit, Evaluator, EvaluatorOptions, Graph, Literal, NodeId, Request, Source, file};

struct Saved {
    catalogue: maquette_graph::Catalogue,
    graph: Graph,
}

fn load(name: &str) -> Saved {
    let catalogue = maquette_nodes::catalogue().expect("the catalogue is sound");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("graphs");
    let own = format!("{name}.ron");
    let bytes = std::fs::read(folder.join(&own)).expect("the graph is there");
    let read = |path: &Path| std::fs::read(folder.join(path)).map_err(|error| error.to_string());
    let includes = file::Includes::new(&own, &read);
    let graph = file::from_bytes_with(&catalogue, &bytes, &includes).expect("the graph is readable").graph;
    Saved { catalogue, graph }
}

impl Saved {
    fn node(&self, name: &str) -> NodeId {
        self.graph.find(name).expect("the node is there")
    }

    fn run(&self, evaluator: &mut Evaluator, targets: &[NodeId]) {
        let base = Path::new(env!("CARGO_MANIFEST_DIR")).join("graphs");
        let evaluation = evaluator.evaluate(&self.catalogue, &self.graph, &Request::nodes(targets).base(base));
        assert!(evaluation.is_complete());
        black_box(evaluation);
    }
}

fn evaluator() -> Evaluator {
    // One thread: the figures are for one core.
    Evaluator::new(&EvaluatorOptions { threads: 1, ..Default::default() })
}

fn graphs(c: &mut Criterion) {
    for name in ["vest", "head", "neck", "leg", "forearm", "hip", "human", "warrior"] {
        let saved = load(name);
        let results = saved.graph.results();
        c.bench_function(&format!("{name}, cold"), |b| {
            b.iter_batched_ref(evaluator, |evaluator| saved.run(evaluator, &results), BatchSize::SmallInput);
        });
    }
}

/// Alternates a parameter through values never seen before, so that the memo can't answer.
fn changing(c: &mut Criterion, what: &str, mut saved: Saved, target: &str, change: impl Fn(&mut Saved, f64)) {
    let targets = [saved.node(target)];
    let mut evaluator = evaluator();
    saved.run(&mut evaluator, &targets);
    let mut step = 0.0;
    c.bench_function(what, |b| {
        b.iter(|| {
            step += 1e-9;
            change(&mut saved, step);
            saved.run(&mut evaluator, &targets);
        });
    });
}

fn vest_changes(c: &mut Criterion) {
    let strokes = |saved: &Saved, node: &str| match saved.graph.node(saved.node(node)).and_then(|n| n.source("strokes"))
    {
        Some(Source::Literal { literal: Literal::Strokes(strokes), .. }) => strokes.clone(),
        _ => Vec::new(),
    };
    changing(c, "vest, one rail moved (published: 90 ms a detail)", load("vest"), "vest", |saved, step| {
        let node = saved.node("front rail");
        let mut moved = strokes(saved, "front rail");
        moved[0].points[4].x += step;
        saved.graph.set(node, "strokes", Literal::Strokes(moved)).expect("strokes fit");
    });
    changing(c, "vest, one parameter of the detail generator", load("vest"), "vest", |saved, step| {
        let node = saved.node("body");
        saved.graph.set(node, "k_s", Literal::Number(1.4 + step)).expect("in range");
    });
    changing(c, "detail generator alone (the vest's, published 90 ms)", load("vest"), "body", |saved, step| {
        let node = saved.node("body");
        saved.graph.set(node, "k_s", Literal::Number(1.4 + step)).expect("in range");
    });
    changing(c, "detail generator alone (the head's, published 90 ms)", load("head"), "sections", |saved, step| {
        let node = saved.node("sections");
        saved.graph.set(node, "k_s", Literal::Number(1.4 + step)).expect("in range");
    });
}

/// One section of the forearm pulled, and what depends on it: the fits of the others are not made again.
fn forearm_changes(c: &mut Criterion) {
    changing(
        c,
        "forearm, one section moved (mark: 5 ms)",
        edited("forearm", ["drawn", "fitted"], &["fit"], 4),
        "forearm",
        |saved, step| {
            let node = saved.node("pulled");
            saved.graph.set(node, "translate", Literal::Vector([0.002 + step, 0.0, 0.0])).expect("in range");
        },
    );
    changing(c, "forearm, all sections fitted to another tolerance", load("forearm"), "forearm", |saved, step| {
        let node = saved.node("fitted");
        saved.graph.set(node, "mean-error", Literal::Number(0.005 + step)).expect("in range");
    });
}

/// One section of the torso pulled, and the body that depends on it.
fn human_changes(c: &mut Criterion) {
    let saved = edited("human", ["torso drawn", "trunk"], &["fit", "hip", "torso", "neck", "head"], 12);
    changing(c, "human, one section of the torso moved (mark: 5 ms)", saved, "human", |saved, step| {
        let node = saved.node("pulled");
        saved.graph.set(node, "translate", Literal::Vector([0.002 + step, 0.0, 0.0])).expect("in range");
    });
}

/// Strokes of the warrior moved, each within its group: of what he wears, of his trunk and of his head.
fn warrior_changes(c: &mut Criterion) {
    for (group, sketch, result) in [
        ("vest", "chest", "vest plate"),
        ("kilt", "lower edge", "kilt cloth"),
        ("boots", "shaft from the side", "boot leather"),
        ("body", "trunk from the front", "skin"),
        ("head", "head from the side", "skin"),
    ] {
        let what = format!("warrior, a stroke of the {group} moved (mark: 16 ms)");
        changing(c, &what, load("warrior"), result, |saved, step| {
            let node = saved.node(group);
            let body = saved.graph.node(node).and_then(|node| node.body()).and_then(|body| body.graph());
            let inner = body.and_then(|body| body.find(sketch).map(|id| (body, id)));
            let (body, id) = inner.expect("the sketch is there");
            let Some(Source::Literal { literal: Literal::Strokes(strokes), .. }) =
                body.node(id).and_then(|node| node.source("strokes"))
            else {
                return;
            };
            let mut moved = strokes.clone();
            moved[0].points[20].x += 1e-6 + step;
            let edit = Edit::Within { node, edit: Edit::set(id, "strokes", Literal::Strokes(moved)).into() };
            saved.graph.apply(&saved.catalogue, &edit).expect("strokes fit");
        });
    }
}

/// A graph with a section drawn anew, a little aside: the fourth of the `drawn` curves at `index` of the `fitted`
/// sections, for those that `read` them.
fn edited(name: &str, [drawn, fitted]: [&str; 2], read: &[&str], index: i64) -> Saved {
    let mut saved = load(name);
    let Saved { catalogue, graph } = &mut saved;
    let [drawn, fitted] = [drawn, fitted].map(|name| graph.find(name).expect("the node is there"));
    let read: Vec<NodeId> = read.iter().map(|name| graph.find(name).expect("the node is there")).collect();
    let mut add = |kind: &str, name: &str| graph.add(catalogue, kind, name).expect("the kind is there");
    let [pick, pulled, edit] =
        [("pick", "picked"), ("transform", "pulled"), ("edit-section", "edited")].map(|(kind, name)| add(kind, name));
    graph.set(pick, "which", Literal::Text("4".to_owned())).expect("a text fits");
    graph.set(edit, "index", Literal::Integer(index)).expect("in range");
    graph.set(edit, "place", Literal::Choice("as-drawn".to_owned())).expect("an option");
    for (from, output, to, input) in [
        (drawn, "curves", pick, "curves"),
        (pick, "curve", pulled, "curves"),
        (pulled, "curves", edit, "contour"),
        (fitted, "sections", edit, "sections"),
    ] {
        graph.connect(catalogue, from, output, to, input).expect("the types fit");
    }
    for reader in read {
        graph.connect(catalogue, edit, "sections", reader, "sections").expect("the types fit");
    }
    saved
}

criterion_group!(benches, graphs, vest_changes, forearm_changes, human_changes, warrior_changes);
criterion_main!(benches);
