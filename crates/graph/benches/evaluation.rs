//! What the engine itself costs: nodes that do next to nothing, evaluated cold, after an edit, and unchanged.
//! `cargo bench -p maquette-graph --bench evaluation`

#![allow(clippy::unwrap_used, reason = "in benchmarks a failing unwrap is a failing benchmark")]

use std::time::Duration;

use criterion::measurement::WallTime;
use criterion::{BatchSize, BenchmarkGroup, Criterion, criterion_group, criterion_main};
use maquette_graph::{
    Catalogue, ContentHasher, Evaluator, EvaluatorOptions, Graph, Literal, NodeId, NodeKind, Request, Wire,
};

/// Points as a flat list of coordinates.
struct Points(Vec<f64>);

impl Wire for Points {
    const NAME: &'static str = "points";
    const DESCRIPTION: &'static str = "Points, three numbers each.";

    fn hash_content(&self, hasher: &mut ContentHasher) {
        hasher.numbers(&self.0);
    }

    fn byte_size(&self) -> usize {
        size_of_val(self.0.as_slice())
    }

    fn summary(&self) -> String {
        format!("{} points", self.0.len() / 3)
    }
}

fn catalogue() -> Catalogue {
    let mut add = NodeKind::declare("add", 1, "bench", "Adds two numbers.");
    let a = add.number("a", 0.0, -1e15..=1e15, "One term.");
    let b = add.number("b", 1.0, -1e15..=1e15, "The other.");
    let sum = add.output::<f64>("sum", "Both.");
    add.evaluate(move |ports| {
        let total = ports.value(a) + ports.value(b);
        ports.write(sum, total);
        Ok(())
    });
    let mut cloud = NodeKind::declare("cloud", 1, "bench", "Makes points.");
    let seed = cloud.number("seed", 0.0, -1e15..=1e15, "Where to begin.");
    let points = cloud.output::<Points>("points", "A million points.");
    cloud.evaluate(move |ports| {
        let seed = ports.value(seed);
        ports.write(points, Points((0..3_000_000).map(|i| seed + f64::from(i)).collect()));
        Ok(())
    });
    let mut pick = NodeKind::declare("pick", 1, "bench", "Takes one coordinate.");
    let from = pick.input::<Points>("points", "Points.");
    let index = pick.integer("index", 0, 0..=1_000_000_000, "Which coordinate, round and round.");
    let number = pick.output::<f64>("number", "The coordinate.");
    pick.evaluate(move |ports| {
        let list = &ports.read(from).0;
        let one = list.get(ports.count(index) % list.len().max(1)).copied().unwrap_or(0.0);
        ports.write(number, one);
        Ok(())
    });
    let mut catalogue = Catalogue::new();
    for kind in [add, cloud, pick] {
        catalogue.register(kind).unwrap();
    }
    catalogue
}

/// `n0 -> n1 -> ...`, each adding a number of its own, so that no two nodes compute the same.
fn chain(catalogue: &Catalogue, length: u32) -> (Graph, Vec<NodeId>) {
    let mut graph = Graph::new();
    let ids: Vec<_> = (0..length).map(|i| graph.add(catalogue, "add", &format!("n{i}")).unwrap()).collect();
    for (i, id) in (0..length).zip(&ids) {
        graph.set(*id, "b", Literal::Number(1.0 + f64::from(i))).unwrap();
    }
    for pair in ids.windows(2) {
        graph.connect(catalogue, pair[0], "sum", pair[1], "a").unwrap();
    }
    (graph, ids)
}

fn wide(catalogue: &Catalogue, width: u32) -> (Graph, Vec<NodeId>) {
    let mut graph = Graph::new();
    let ids: Vec<_> = (0..width).map(|i| graph.add(catalogue, "add", &format!("n{i}")).unwrap()).collect();
    for (i, id) in (0..width).zip(&ids) {
        graph.set(*id, "b", Literal::Number(f64::from(i))).unwrap();
    }
    (graph, ids)
}

fn evaluator(threads: usize) -> Evaluator {
    Evaluator::new(&EvaluatorOptions { threads, ..EvaluatorOptions::default() })
}

fn evaluate(evaluator: &mut Evaluator, catalogue: &Catalogue, graph: &Graph, targets: &[NodeId]) -> usize {
    let evaluation = evaluator.evaluate(catalogue, graph, &Request::nodes(targets));
    assert!(evaluation.is_complete());
    evaluation.run_count()
}

/// Evaluates after setting a number that was never there before.
fn edited(
    group: &mut BenchmarkGroup<'_, WallTime>,
    name: &str,
    (graph, ids): (&Graph, &[NodeId]),
    edit: (NodeId, &'static str),
    runs: usize,
) {
    let catalogue = catalogue();
    let (mut graph, mut evaluator) = (graph.clone(), evaluator(1));
    evaluate(&mut evaluator, &catalogue, &graph, &ids[ids.len() - 1..]);
    let mut number = 0.5;
    group.bench_function(name, |bencher| {
        bencher.iter(|| {
            number += 1.0;
            graph.set(edit.0, edit.1, Literal::Number(number)).unwrap();
            assert_eq!(evaluate(&mut evaluator, &catalogue, &graph, &ids[ids.len() - 1..]), runs);
        });
    });
}

fn chains(criterion: &mut Criterion) {
    let catalogue = catalogue();
    for length in [10, 100, 1000] {
        let mut group = criterion.benchmark_group(format!("chain-{length}"));
        let (graph, ids) = chain(&catalogue, length);
        let last = &ids[ids.len() - 1..];
        group.bench_function("cold", |bencher| {
            bencher.iter_batched_ref(
                || evaluator(1),
                |evaluator| assert_eq!(evaluate(evaluator, &catalogue, &graph, last), ids.len()),
                BatchSize::SmallInput,
            );
        });
        edited(&mut group, "after-changing-the-first", (&graph, &ids), (ids[0], "a"), ids.len());
        edited(&mut group, "after-changing-the-last", (&graph, &ids), (last[0], "b"), 1);
        let mut warm = evaluator(1);
        evaluate(&mut warm, &catalogue, &graph, last);
        group.bench_function("unchanged", |bencher| {
            bencher.iter(|| assert_eq!(evaluate(&mut warm, &catalogue, &graph, last), 0));
        });
        // Undo: every node's key is computed anew, and the memo knows them all.
        let (mut undone, mut warm) = (graph.clone(), evaluator(1));
        let numbers = [7.25, 9.25].map(Literal::Number);
        for number in &numbers {
            undone.set(ids[0], "a", number.clone()).unwrap();
            evaluate(&mut warm, &catalogue, &undone, last);
        }
        let mut turn = 0;
        group.bench_function("undo-of-the-first", |bencher| {
            bencher.iter(|| {
                undone.set(ids[0], "a", numbers[turn % 2].clone()).unwrap();
                turn += 1;
                assert_eq!(evaluate(&mut warm, &catalogue, &undone, last), 0);
            });
        });
        group.finish();
    }
}

fn heavy(criterion: &mut Criterion) {
    let catalogue = catalogue();
    let mut graph = Graph::new();
    let cloud = graph.add(&catalogue, "cloud", "cloud").unwrap();
    let pick = graph.add(&catalogue, "pick", "pick").unwrap();
    graph.connect(&catalogue, cloud, "points", pick, "points").unwrap();
    let mut group = criterion.benchmark_group("million-points");
    let (mut warm, mut index) = (evaluator(0), 0);
    group.bench_function("after-changing-the-cheap-node-behind", |bencher| {
        evaluate(&mut warm, &catalogue, &graph, &[pick]);
        bencher.iter(|| {
            index += 1;
            graph.set(pick, "index", Literal::Integer(index)).unwrap();
            assert_eq!(evaluate(&mut warm, &catalogue, &graph, &[pick]), 1);
        });
    });
    group.sample_size(10);
    group.bench_function("cold", |bencher| {
        bencher.iter_batched_ref(
            || evaluator(0),
            |evaluator| assert_eq!(evaluate(evaluator, &catalogue, &graph, &[pick]), 2),
            BatchSize::PerIteration,
        );
    });
    group.finish();
}

fn wide_graphs(criterion: &mut Criterion) {
    let catalogue = catalogue();
    let (graph, ids) = wide(&catalogue, 1000);
    let mut group = criterion.benchmark_group("wide-1000");
    for threads in [1, 2] {
        group.bench_function(format!("cold-{threads}-threads"), |bencher| {
            let mut evaluator = evaluator(threads);
            evaluate(&mut evaluator, &catalogue, &graph, &ids);
            bencher.iter(|| {
                // The threads stay, the results go.
                evaluator.forget();
                assert_eq!(evaluate(&mut evaluator, &catalogue, &graph, &ids), ids.len());
            });
        });
    }
    let mut warm = evaluator(1);
    evaluate(&mut warm, &catalogue, &graph, &ids);
    group.bench_function("unchanged", |bencher| {
        bencher.iter(|| assert_eq!(evaluate(&mut warm, &catalogue, &graph, &ids), 0));
    });
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(600))
        .sample_size(30);
    targets = chains, heavy, wide_graphs
}
criterion_main!(benches);
