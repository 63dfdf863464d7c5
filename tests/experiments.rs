//! The experiments of the thesis and the paper: bent rulers and a pulled tyre, against beam theory, in numbers.
//!
//! The numbers wanted are from solutions in closed form, to the digits given; docs/experiments.md has them as a table.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod command;
mod graphs;

use command::maquette;
use graphs::Saved;
use maquette_graph::{Evaluation, Evaluator, Literal, OutcomeState};

/// A figure of a node, centimetres.
fn centimetres(saved: &Saved, evaluation: &Evaluation, node: &str, figure: &str) -> f64 {
    match &evaluation.outcome(saved.node(node)).unwrap().state {
        OutcomeState::Done { report, .. } => 100.0 * report.figure(figure).unwrap().value,
        other => panic!("{node}: {other:?}"),
    }
}

/// The figure, with the stretching stiffness of the thesis' beam set to this.
fn with_tension(name: &str, k_s: f64, node: &str) -> f64 {
    let mut saved = Saved::load(name);
    let beam = saved.node("thesis");
    saved.graph.set(beam, "k_s", Literal::Number(k_s)).unwrap();
    let evaluation = saved.evaluate(&mut Evaluator::default(), &[node]);
    centimetres(&saved, &evaluation, node, "largest-by-point")
}

fn assert_near(what: &str, found: f64, wanted: f64, tolerance: f64) {
    assert!((found - wanted).abs() <= tolerance, "{what}: {found} cm, not {wanted} +- {tolerance} cm");
}

#[test]
fn every_experiment_is_tested_here() {
    let mut saved: Vec<_> = std::fs::read_dir("graphs/experiments").unwrap().map(|e| e.unwrap().file_name()).collect();
    saved.sort();
    assert_eq!(saved, ["cantilever.ron", "supported.ron", "tyre.ron"]);
    for name in ["experiments/cantilever", "experiments/supported", "experiments/tyre"] {
        let saved = Saved::load(name);
        assert_eq!(saved.graph.upstream(&saved.graph.results()).len(), saved.graph.nodes().len(), "{name}");
        saved.evaluate(&mut Evaluator::default(), &saved.results());
    }
}

#[test]
fn the_cantilever() {
    let saved = Saved::load("experiments/cantilever");
    let evaluation = saved.evaluate(&mut Evaluator::default(), &saved.results());
    let figure = |node: &str, figure: &str| centimetres(&saved, &evaluation, node, figure);
    // As the thesis bends it: 1.77 % of the tip's way off beam theory; without tension it is beam theory.
    assert_near("thesis", figure("thesis from theory", "largest-by-point"), 0.1274, 1e-4);
    assert_near("k_s = 0", figure("without tension from theory", "largest-by-point"), 0.0, 2e-5);
    let moved = figure("thesis", "largest-displacement");
    assert_near("tip", moved, 7.2, 1e-12);
    // A ruler keeps its length: its tip draws back, which the equation does not know.
    let back = -figure("elastica", "across");
    assert!((1.0..1.1).contains(&back), "{back}");
    for node in ["thesis from elastica", "without tension from elastica"] {
        let off = figure(node, "largest-distance");
        assert!(off > 0.9 * back && off < 1.1 * back, "{node}: {off}, the tip draws back by {back}");
    }
}

#[test]
fn the_supported_ruler() {
    let saved = Saved::load("experiments/supported");
    let evaluation = saved.evaluate(&mut Evaluator::default(), &saved.results());
    let figure = |node: &str, figure: &str| centimetres(&saved, &evaluation, node, figure);
    assert_near("thesis", figure("thesis from theory", "largest-by-point"), 0.0051, 5e-5);
    assert_near("k_s = 0", figure("without tension from theory", "largest-by-point"), 0.0, 2e-5);
    assert_near("middle", figure("thesis", "largest-displacement"), 1.06, 1e-12);
}

#[test]
fn what_u_counts_decides_how_close_the_thesis_is() {
    // u over 0 to 2 pi, and over the arc length in centimetres of rulers of 15 and 30 cm, instead of 0 to 1: the same as
    // so many times squared the tension.
    let turn = std::f64::consts::TAU;
    for (unit, cantilever, supported) in [(turn, 0.977, 0.092), (15.0, 1.22, 0.154), (30.0, 1.30, 0.179)] {
        let k_s = 1.4 * unit * unit;
        let found = with_tension("experiments/cantilever", k_s, "thesis from theory");
        assert_near("cantilever", found, cantilever, 6e-3);
        let found = with_tension("experiments/supported", k_s, "thesis from theory");
        assert_near("supported", found, supported, 6e-4);
    }
}

#[test]
fn the_tyre() {
    let saved = Saved::load("experiments/tyre");
    let evaluation = saved.evaluate(&mut Evaluator::default(), &saved.results());
    let figure = |node: &str, figure: &str| centimetres(&saved, &evaluation, node, figure);
    assert_near("vertical half axis", 1.5 + figure("ring", "across"), 1.1577, 5e-5);
    assert_near("vertical half axis, small deflections", 1.5 + figure("small ring", "across"), 1.2245, 5e-5);
    for (node, wanted, tolerance) in [
        ("two pins from ring", 0.342, 5e-4),
        ("ellipse from ring", 0.342, 5e-4),
        ("four pins from ring", 0.0062, 1e-4),
        ("measured ellipse from ring", 0.0089, 1e-4),
        ("two pins from ellipse", 0.004, 5e-4),
    ] {
        assert_near(node, figure(node, "largest-distance"), wanted, tolerance);
    }
}

#[test]
fn a_build_stops_on_a_curve_that_is_too_far_off() {
    let limit = |limit: &str| {
        let condition = format!("four pins from ring.largest-distance > {limit}");
        maquette(&["run", "graphs/experiments/tyre.ron", "--quiet", "--fail-if", &condition]).0
    };
    assert_eq!((limit("0.0001"), limit("0.00005")), (0, 1));
    let (code, said, _) = maquette(&["run", "graphs/experiments/cantilever.ron", "--report"]);
    assert!(code == 0 && said.contains("largest-by-point"), "{said}");
}
