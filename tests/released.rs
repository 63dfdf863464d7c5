//! Graphs of every released version, with what they gave: they load without a complaint, and give the same for ever.
//!
//! A folder `tests/released/vX.Y.Z` is never changed. Where a kind's version went up since, it and what lies behind it
//! may give something else, and must still give something. Everywhere else the content hash of each output is the same
//! or, because processors and mathematical libraries round differently, all that is measured of it agrees to a
//! nanometre. `MAQUETTE_RECORD=1 cargo test --test released` writes what is missing beside the graphs of a new folder.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use glam::DVec3;
use maquette_graph::file::{self, Project, Severity};
use maquette_graph::{Catalogue, Evaluator, Graph, NodeId, OutcomeState, Request, Source, Value};
use maquette_nodes::wire;
use serde_json::{Value as Json, json};

/// Largest difference of what is measured, in the unit of what is measured: metres, square metres.
const TOLERANCE: f64 = 1e-9;

fn graphs() -> Vec<PathBuf> {
    let mut graphs = Vec::new();
    for version in std::fs::read_dir("tests/released").unwrap() {
        let files = std::fs::read_dir(version.unwrap().path()).unwrap().map(|entry| entry.unwrap().path());
        graphs.extend(files.filter(|path| path.extension().is_some_and(|e| e == "ron")));
    }
    graphs.sort();
    graphs
}

/// The points of a value, in its order.
fn points(value: &Value) -> Option<Vec<DVec3>> {
    if let Some(mesh) = value.get::<wire::Mesh>() {
        return Some(mesh.0.positions().to_vec());
    }
    if let Some(sections) = value.get::<wire::Sections>() {
        return Some(sections.0.iter().flatten().copied().collect());
    }
    if let Some(curve) = value.get::<wire::Curve>() {
        return Some(curve.0.points().to_vec());
    }
    let curves = value.get::<wire::Curves>()?;
    Some(curves.0.iter().flat_map(|curve| curve.points().iter().copied()).collect())
}

/// Number, bounds, mean and mean square of the points, and their mean weighted by their place in the order.
fn measures(points: &[DVec3]) -> Vec<f64> {
    let count = points.len() as f64;
    let mean = |value: &dyn Fn(usize, DVec3) -> DVec3| {
        points.iter().enumerate().map(|(i, p)| value(i, *p)).sum::<DVec3>() / count.max(1.0)
    };
    let low = points.iter().copied().reduce(DVec3::min).unwrap_or_default();
    let high = points.iter().copied().reduce(DVec3::max).unwrap_or_default();
    let means = [mean(&|_, p| p), mean(&|_, p| p * p), mean(&|i, p| p * (i as f64 / count))];
    std::iter::once(count).chain([low, high].into_iter().chain(means).flat_map(|v| v.to_array())).collect()
}

/// What a graph gives: for each node that its results depend on, kind, version, and each output's hash and measures.
fn results(catalogue: &Catalogue, path: &Path) -> (Graph, BTreeMap<String, Json>) {
    let loaded = file::open(catalogue, path, &Project::of_graph(path)).unwrap();
    let complaints: Vec<_> = loaded.problems.iter().filter(|p| p.severity != Severity::Note).collect();
    assert!(complaints.is_empty(), "{}: {complaints:?}", path.display());
    let graph = loaded.graph;
    let wanted = graph.upstream(&graph.results());
    assert!(!wanted.is_empty(), "{}", path.display());
    let request = Request::nodes(&wanted).base(path.parent().unwrap());
    let evaluation = Evaluator::default().evaluate(catalogue, &graph, &request);
    let mut results = BTreeMap::new();
    for id in wanted {
        let outcome = evaluation.outcome(id).unwrap();
        assert!(matches!(outcome.state, OutcomeState::Done { .. }), "{}: {outcome:?}", path.display());
        let kind = graph.node(id).unwrap().kind().unwrap();
        let outputs = kind.outputs().iter().zip(evaluation.values(id).unwrap()).map(|(output, value)| {
            let measured = points(value).map(|points| measures(&points));
            (output.name.clone(), json!({ "hash": value.hash().to_string(), "measures": measured }))
        });
        let outputs: serde_json::Map<String, Json> = outputs.collect();
        results.insert(
            outcome.name.clone(),
            json!({ "kind": outcome.kind, "version": kind.version(), "outputs": outputs }),
        );
    }
    (graph, results)
}

/// The nodes that are, with all before them, of the versions that they were.
fn unchanged(graph: &Graph, now: &BTreeMap<String, Json>, then: &BTreeMap<String, Json>) -> BTreeSet<String> {
    let same = |id: &NodeId| {
        let name = graph.node(*id).unwrap().name();
        then.get(name).is_some_and(|then| then["version"] == now[name]["version"])
    };
    let nodes =
        graph.nodes().filter(|(id, node)| now.contains_key(node.name()) && graph.upstream(&[*id]).iter().all(same));
    nodes.map(|(_, node)| node.name().to_owned()).collect()
}

/// How an output differs from what it was; `None` where it does not, to the tolerance.
fn difference(now: &Json, then: &Json) -> Option<String> {
    if now["hash"] == then["hash"] {
        return None;
    }
    let numbers =
        |of: &Json| of["measures"].as_array().map(|all| all.iter().filter_map(Json::as_f64).collect::<Vec<_>>());
    let (Some(now), Some(then)) = (numbers(now), numbers(then)) else {
        // Nothing is measured of what only passes a mesh or curves on.
        return None;
    };
    let largest = now.iter().zip(&then).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    (now.len() != then.len() || largest.is_nan() || largest > TOLERANCE)
        .then(|| format!("it differs by {largest:e}: {now:?} now, {then:?} then"))
}

#[test]
fn graphs_of_released_versions_give_what_they_gave() {
    let catalogue = maquette_nodes::catalogue().unwrap();
    let graphs = graphs();
    assert!(graphs.len() >= 4, "{graphs:?}");
    for path in graphs {
        let (graph, now) = results(&catalogue, &path);
        let recorded = path.with_extension("results.json");
        if std::env::var_os("MAQUETTE_RECORD").is_some() && !recorded.exists() {
            std::fs::write(&recorded, serde_json::to_string_pretty(&now).unwrap() + "\n").unwrap();
        }
        let then: BTreeMap<String, Json> = serde_json::from_slice(&std::fs::read(&recorded).unwrap()).unwrap();
        assert_eq!(now.keys().collect::<Vec<_>>(), then.keys().collect::<Vec<_>>(), "{}", path.display());
        for name in unchanged(&graph, &now, &then) {
            let (now, then) = (&now[&name]["outputs"], &then[&name]["outputs"]);
            for (output, then) in then.as_object().unwrap() {
                let kind = graph.node(graph.find(&name).unwrap()).unwrap().kind().unwrap();
                let today = &kind.current_output(output).unwrap().name;
                if let Some(difference) = difference(&now[today], then) {
                    panic!("{}: {name}.{output}: {difference}; raise the kind's version", path.display());
                }
            }
        }
    }
}

#[test]
fn a_result_that_moved_is_noticed() {
    let catalogue = maquette_nodes::catalogue().unwrap();
    let path = Path::new("tests/released/v0.1.0/neck.ron");
    let (mut graph, now) = results(&catalogue, path);
    let all = unchanged(&graph, &now, &now);
    assert_eq!(all.len(), now.len());
    let mut moved = now.clone();
    let node = moved.get_mut("surface").unwrap();
    node["outputs"]["mesh"]["hash"] = json!("0");
    assert_eq!(difference(&now["surface"]["outputs"]["mesh"], &node["outputs"]["mesh"]), None, "round-off");
    let mean = node["outputs"]["mesh"]["measures"][7].as_f64().unwrap();
    node["outputs"]["mesh"]["measures"][7] = json!(mean + 1e-8);
    assert!(difference(&now["surface"]["outputs"]["mesh"], &node["outputs"]["mesh"]).is_some());
    // A kind of another version takes what lies behind it along, and nothing else.
    node["version"] = json!(99);
    let left = unchanged(&graph, &now, &moved);
    assert!(!left.contains("surface") && left.contains("sorted") && left.len() < all.len(), "{left:?}");
    // What was released can be edited: nothing in it is a placeholder.
    let surface = graph.find("surface").unwrap();
    assert!(graph.node(surface).unwrap().sources().all(|(_, source)| !matches!(source, Source::Unread(_))));
    graph.reset(surface, "cap-start").unwrap();
}
