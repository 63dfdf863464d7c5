//! What editing costs: 100 000 random edits of a graph, each with its inverse, undone again. The mark is one second.
//! `cargo bench -p maquette-graph --bench edits`

#![allow(clippy::unwrap_used, reason = "in benchmarks a failing unwrap is a failing benchmark")]

use std::time::Duration;

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use maquette_graph::{Catalogue, Edit, Graph, History, Literal, NodeId, NodeKind, file};

const EDITS: usize = 100_000;

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

/// A generator of numbers that are the same on every run (Knuth's MMIX constants).
struct Dice(u64);

impl Dice {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(self.0 >> 33).unwrap() % bound
    }
}

/// Nodes of which each takes two others at random from those before it.
fn graph(catalogue: &Catalogue, count: usize, dice: &mut Dice) -> (Graph, Vec<NodeId>) {
    let mut graph = Graph::new();
    let ids: Vec<_> = (0..count).map(|i| graph.add(catalogue, "mix", &format!("n{i}")).unwrap()).collect();
    for i in 1..count {
        for input in ["a", "b"] {
            graph.connect(catalogue, ids[dice.below(i)], "sum", ids[i], input).unwrap();
        }
    }
    (graph, ids)
}

/// One random edit; some are refused, as an artist's are.
fn edit(dice: &mut Dice, ids: &[NodeId], number: usize) -> Edit {
    let node = ids[dice.below(ids.len())];
    let input = ["a", "b", "c"][dice.below(3)];
    match dice.below(20) {
        0 => Edit::RemoveNode(node),
        1..=2 => Edit::add("mix", format!("new {number}")),
        3..=7 => Edit::connect(ids[dice.below(ids.len())], "sum", node, input),
        8 => Edit::Disconnect { to: node, input: input.to_owned() },
        9 => Edit::Reset { node, input: input.to_owned() },
        10 => Edit::Rename { node, name: format!("renamed {number}") },
        11..=13 => Edit::Move { node, position: Some([1.0, 2.0]) },
        14 => Edit::Note { node, note: "a note".to_owned() },
        _ => Edit::set(node, input, Literal::Number(1.0)),
    }
}

/// Makes `EDITS` edits that fit, each a step, and undoes all of them. Gives how many were tried.
fn edit_and_undo(catalogue: &Catalogue, graph: &mut Graph, ids: &mut Vec<NodeId>, dice: &mut Dice) -> usize {
    let mut history = History::new();
    let mut tried = 0;
    while history.position() < EDITS {
        tried += 1;
        let edit = edit(dice, ids, tried);
        if history.apply(graph, catalogue, &edit).is_ok() {
            match &edit {
                Edit::RemoveNode(id) => ids.retain(|other| other != id),
                Edit::AddNode(record) => ids.extend(graph.find(record.name())),
                _ => {}
            }
        }
    }
    while history.undo(graph, catalogue).unwrap().is_some() {}
    tried
}

fn random_edits(criterion: &mut Criterion) {
    let catalogue = catalogue();
    let mut group = criterion.benchmark_group("100000-edits-with-undo");
    group.sample_size(10);
    for count in [100, 1_000, 10_000] {
        let mut dice = Dice(1);
        let (graph, ids) = graph(&catalogue, count, &mut dice);
        let before = file::to_text(&graph);
        group.bench_function(format!("{count}-nodes"), |bencher| {
            bencher.iter_batched_ref(
                || (graph.clone(), ids.clone(), Dice(7)),
                |(graph, ids, dice)| edit_and_undo(&catalogue, graph, ids, dice),
                BatchSize::PerIteration,
            );
        });
        let (mut edited, mut ids) = (graph, ids);
        edit_and_undo(&catalogue, &mut edited, &mut ids, &mut dice);
        assert!(file::to_text(&edited) == before, "undoing everything gives the graph as it was");
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_secs(2));
    targets = random_edits
}
criterion_main!(benches);
