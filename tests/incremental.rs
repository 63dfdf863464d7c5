//! What re-runs when something changes in the vest, and that results do not depend on runs or threads.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

mod graphs;

use graphs::Saved;
use maquette_graph::{Evaluator, EvaluatorOptions, Literal, Source};

fn moved_first_point(saved: &Saved, node: &str) -> Literal {
    let source = saved.graph.node(saved.node(node)).unwrap().source("strokes").cloned();
    let Some(Source::Literal { literal: Literal::Strokes(mut strokes), .. }) = source else { panic!("no strokes") };
    // A middle point: the ends must stay on the hem and the neckline.
    strokes[0].points[4].x += 0.004;
    Literal::Strokes(strokes)
}

#[test]
fn a_changed_parameter_reruns_its_node_and_what_depends_on_it() {
    let mut saved = Saved::load("vest");
    let mut evaluator = Evaluator::default();
    let everything = saved.ran(&mut evaluator).len();
    assert_eq!(everything, saved.graph.nodes().len());
    assert_eq!(saved.ran(&mut evaluator), Vec::<String>::new(), "nothing changed");

    let surface = saved.node("surface");
    saved.graph.set(surface, "rows", Literal::Integer(3)).unwrap();
    assert_eq!(saved.ran(&mut evaluator), ["surface", "vest"]);

    let reach = saved.node("shaped");
    saved.graph.set(reach, "before", Literal::Number(0.12)).unwrap();
    assert_eq!(saved.ran(&mut evaluator), ["shaped", "surface", "vest"]);

    let strokes = moved_first_point(&saved, "front rail");
    let rail = saved.node("front rail");
    saved.graph.set(rail, "strokes", strokes).unwrap();
    let behind = [
        "all curves",
        "body",
        "drawn curves",
        "even front rail",
        "front rail",
        "shaped",
        "sketch lines",
        "sorted",
        "surface",
        "vest",
    ];
    assert_eq!(saved.ran(&mut evaluator), behind);
}

#[test]
fn a_looser_tolerance_that_gives_the_same_sections_makes_no_new_surface() {
    let mut saved = Saved::load("forearm");
    let mut evaluator = Evaluator::default();
    assert_eq!(saved.ran(&mut evaluator).len(), saved.graph.nodes().len());
    let fitted = saved.node("fitted");
    // The mean errors decide: all sections are within 2 % anyway.
    saved.graph.set(fitted, "max-error", Literal::Number(0.0249)).unwrap();
    assert_eq!(saved.ran(&mut evaluator), ["fitted"]);
    saved.graph.set(fitted, "mean-error", Literal::Number(0.002)).unwrap();
    assert_eq!(saved.ran(&mut evaluator), ["fit", "fitted", "forearm", "skin", "surface"]);
}

#[test]
fn an_equal_result_stops_the_wave_and_undo_runs_nothing() {
    let mut saved = Saved::load("vest");
    let mut evaluator = Evaluator::default();
    saved.ran(&mut evaluator);

    // 400 and 500 are both beyond the vest, so the range is clipped to it and the sections come out equal.
    let shaped = saved.node("shaped");
    saved.graph.set(shaped, "before", Literal::Number(400.0)).unwrap();
    saved.ran(&mut evaluator);
    saved.graph.set(shaped, "before", Literal::Number(500.0)).unwrap();
    assert_eq!(saved.ran(&mut evaluator), ["shaped"], "its sections are equal, so the surface is a hit");

    saved.graph.set(shaped, "before", Literal::Number(400.0)).unwrap();
    assert_eq!(saved.ran(&mut evaluator), Vec::<String>::new(), "undo");
}

#[test]
fn renaming_moving_and_remarking_rerun_nothing() {
    let mut saved = Saved::load("vest");
    let mut evaluator = Evaluator::default();
    saved.ran(&mut evaluator);
    let body = saved.node("body");
    saved.graph.rename(body, "torso").unwrap();
    saved.graph.set_position(body, Some([10.0, 20.0])).unwrap();
    saved.graph.set_note(body, "the heart of it").unwrap();
    assert_eq!(saved.ran(&mut evaluator), Vec::<String>::new());
}

#[test]
fn results_are_the_same_for_every_run_and_any_number_of_threads() {
    for name in ["vest", "head", "neck", "leg", "legs"] {
        let saved = Saved::load(name);
        let hashes = |threads| {
            let mut evaluator = Evaluator::new(&EvaluatorOptions { threads, ..Default::default() });
            let evaluation = saved.evaluate(&mut evaluator, &saved.results());
            let results = saved.graph.results();
            results.iter().flat_map(|id| evaluation.values(*id).unwrap()).map(|v| v.hash()).collect::<Vec<_>>()
        };
        let once = hashes(1);
        for threads in [1, 2, 8] {
            assert_eq!(hashes(threads), once, "{name} with {threads} threads");
        }
    }
}

#[test]
fn in_the_legs_only_what_a_change_reaches_runs_again() {
    let mut saved = Saved::load("legs");
    let mut evaluator = Evaluator::default();
    let first = saved.ran(&mut evaluator);
    for name in ["contours/0/calm", "contours/3/even", "left/grown", "right/surface"] {
        assert!(first.contains(&name.to_owned()), "{first:?}");
    }
    assert_eq!(saved.ran(&mut evaluator), [""; 0]);
    saved.graph.set_parameter("sections", maquette_graph::Literal::Integer(32)).unwrap();
    let parts = ["grown", "rails", "surface"].map(|node| ["left", "right"].map(|leg| format!("{leg}/{node}")));
    let whole = ["left", "right", "left leg", "right leg", "rails", "rail lines"].map(str::to_owned);
    let mut expected: Vec<_> = parts.into_iter().flatten().chain(whole).collect();
    expected.sort();
    assert_eq!(saved.ran(&mut evaluator), expected);
    // The sorted rails are the same, and each contour is smoothed by itself.
    saved.graph.set_parameter("sections", maquette_graph::Literal::Integer(64)).unwrap();
    assert_eq!(saved.ran(&mut evaluator), [""; 0]);
}
