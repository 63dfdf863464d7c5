//! Files of 10 000 nodes, each linked to two others and placed on the canvas: read, written, and both on disk. The marks
//! are 100 ms each. `cargo bench -p maquette-graph --bench files`

#![allow(clippy::unwrap_used, reason = "in benchmarks a failing unwrap is a failing benchmark")]

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use maquette_graph::file::{self, Project};
use maquette_graph::{Catalogue, Graph, Literal, NodeKind};

fn catalogue() -> Catalogue {
    let mut mix = NodeKind::declare("mix", 1, "bench", "Adds three numbers.");
    let terms = ["a", "b", "c"].map(|name| mix.number(name, 0.0, -1e15..=1e15, "A term."));
    let sum = mix.output::<f64>("sum", "All of them.");
    mix.evaluate(move |ports| {
        let total = terms.iter().map(|term| ports.value(*term)).sum();
        ports.write(sum, total);
        Ok(())
    });
    let mut catalogue = Catalogue::new();
    catalogue.register(mix).unwrap();
    catalogue
}

/// Each node takes two of those before it, and a number.
fn graph(catalogue: &Catalogue, count: u32) -> Graph {
    let mut graph = Graph::new();
    let ids: Vec<_> = (0..count).map(|i| graph.add(catalogue, "mix", &format!("node {i}")).unwrap()).collect();
    for (i, id) in (0..count).zip(&ids) {
        graph.set(*id, "c", Literal::Number(0.125 + f64::from(i))).unwrap();
        graph.set_position(*id, Some([f64::from(i % 100) * 180.0, f64::from(i / 100) * 90.0])).unwrap();
        if i > 0 {
            graph.connect(catalogue, ids[i as usize - 1], "sum", *id, "a").unwrap();
            graph.connect(catalogue, ids[i as usize / 2], "sum", *id, "b").unwrap();
        }
    }
    graph
}

fn files(criterion: &mut Criterion) {
    let catalogue = catalogue();
    let mut group = criterion.benchmark_group("10000-nodes");
    group.sample_size(20);
    let graph = graph(&catalogue, 10_000);
    let text = file::to_text(&graph);
    assert!(file::from_text(&catalogue, &text).unwrap().problems.is_empty());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.ron");
    group.bench_function("read", |bencher| bencher.iter(|| file::from_text(&catalogue, black_box(&text)).unwrap()));
    group.bench_function("write", |bencher| bencher.iter(|| file::to_text(black_box(&graph))));
    group.bench_function("save-to-disk", |bencher| bencher.iter(|| file::save(&graph, &path).unwrap()));
    let project = Project::of_graph(&path);
    group.bench_function("open-from-disk", |bencher| {
        bencher.iter(|| file::open(&catalogue, &path, &project).unwrap());
    });
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(3));
    targets = files
}
criterion_main!(benches);
