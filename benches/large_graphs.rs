//! `maquette diff` of two graphs of 10 000 nodes, from start to end: the mark is 200 ms.
//! `cargo bench --bench large_graphs`
#![allow(
    missing_docs,
    clippy::expect_used,
    clippy::disallowed_methods,
    reason = "a benchmark has no users, stops where it is wrong, and its files are its own"
)]

use std::fmt::Write as _;
use std::process::Command;
use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};

/// Chains of ten nodes that turn and join sketched lines.
fn graph(nodes: usize, turned: usize) -> String {
    let mut text = String::from("(\n    version: 1,\n    nodes: {\n");
    for i in 0..nodes {
        let angle = if i == turned { 30.0 } else { i as f64 / 100.0 };
        let inputs = if i % 10 == 0 {
            format!("\"strokes\": Strokes([(points: [(0, {i}), (1, 0.5)])])")
        } else {
            format!("\"curves\": Link(\"node {}.curves\"), \"rotate\": Vector({angle:?}, 0.0, 0.0)", i - 1)
        };
        let kind = if i % 10 == 0 { "sketch" } else { "transform" };
        let _ = writeln!(text, "        \"node {i}\": (kind: \"{kind}\", inputs: {{{inputs}}}),");
    }
    text.push_str("    },\n)\n");
    text
}

fn diff(criterion: &mut Criterion) {
    let folder = tempfile::tempdir().expect("there is a folder for temporary files");
    let [first, second] = ["a.ron", "b.ron"].map(|name| folder.path().join(name));
    std::fs::write(&first, graph(10_000, usize::MAX)).expect("it can be written");
    std::fs::write(&second, graph(10_000, 5_555)).expect("it can be written");
    let mut group = criterion.benchmark_group("10000-nodes");
    group.sample_size(20);
    group.bench_function("diff", |bencher| {
        bencher.iter(|| {
            let maquette = env!("CARGO_BIN_EXE_maquette");
            let output = Command::new(maquette).arg("diff").args([&first, &second]).output().expect("it starts");
            let said = String::from_utf8_lossy(&output.stdout);
            assert!(output.status.code() == Some(1) && said.contains("node 5555.rotate"), "{said}");
        });
    });
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(5));
    targets = diff
}
criterion_main!(benches);
