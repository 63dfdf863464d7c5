//! A wedge of 100 variants of the vest beside the work that differs between them. Run with `cargo bench --bench wedge`.
//!
//! *The work that differs* is the time that the nodes take which have to run: all of them for the first variant, then
//! for each variant those behind the value that changed. What the wedge adds is reading, planning, looking up, and the
//! table. Mark: under 1.2 times.
#![allow(missing_docs, clippy::expect_used, reason = "a benchmark has no users, and stops where it is wrong")]

use std::path::Path;
use std::time::{Duration, Instant};

use clap::Parser;
use criterion::{Criterion, criterion_group, criterion_main};
use maquette::commands::{Ended, wedge};
use maquette_graph::{CancelToken, Evaluator, EvaluatorOptions, Literal, Request, file};

#[derive(Parser)]
struct Command {
    #[command(flatten)]
    wedge: wedge::Arguments,
}

const STIFFNESS: [f64; 10] = [0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.4, 1.6, 1.8, 2.0];
const REACH: [f64; 10] = [0.1, 0.11, 0.12, 0.13, 0.14, 0.15, 0.16, 0.17, 0.18, 0.19];

/// The time of the nodes that run, one evaluator for all variants.
fn work_that_differs() -> Duration {
    let catalogue = maquette_nodes::catalogue().expect("the catalogue is sound");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("graphs");
    let bytes = std::fs::read(folder.join("vest.ron")).expect("the graph is there");
    let mut graph = file::from_bytes(&catalogue, &bytes).expect("the graph is readable").graph;
    let [body, shaped] = ["body", "shaped"].map(|name| graph.find(name).expect("the node is there"));
    let targets = graph.results();
    let mut evaluator = Evaluator::new(&EvaluatorOptions { threads: 1, ..Default::default() });
    let mut work = Duration::ZERO;
    for stiffness in STIFFNESS {
        graph.set(body, "k_s", Literal::Number(stiffness)).expect("in range");
        for reach in REACH {
            graph.set(shaped, "before", Literal::Number(reach)).expect("in range");
            let evaluation = evaluator.evaluate(&catalogue, &graph, &Request::nodes(&targets).base(&folder));
            assert!(evaluation.is_complete());
            work += evaluation.outcomes().filter(|(_, o)| o.ran).map(|(_, o)| o.duration).sum::<Duration>();
        }
    }
    work
}

fn vest(c: &mut Criterion) {
    let list = |values: [f64; 10]| values.map(|value| value.to_string()).join(",");
    let graph = concat!(env!("CARGO_MANIFEST_DIR"), "/graphs/vest.ron");
    let [stiffness, reach] = [format!("body.k_s={}", list(STIFFNESS)), format!("shaped.before={}", list(REACH))];
    // The one that costs less is given first, so that the order is for the wedge to find.
    let arguments = ["wedge", graph, "--vary", &reach, "--vary", &stiffness, "--threads", "1", "--quiet"];
    let command = Command::parse_from(arguments);
    let mut group = c.benchmark_group("vest, 100 variants");
    group.sample_size(20);
    group.bench_function("the work that differs", |b| {
        b.iter_custom(|times| (0..times).map(|_| work_that_differs()).sum());
    });
    group.bench_function("wedge (mark: under 1.2 times the work)", |b| {
        b.iter_custom(|times| {
            let begun = Instant::now();
            for _ in 0..times {
                assert_eq!(wedge::wedge_until(&command.wedge, &CancelToken::new()), Ended::Done);
            }
            begun.elapsed()
        });
    });
    group.finish();
}

criterion_group!(benches, vest);
criterion_main!(benches);
