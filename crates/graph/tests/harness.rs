//! A node alone: inputs, outputs, report, progress, cancellation and failures as in a graph.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that panics fails")]

mod kinds;

use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use kinds::{Samples, catalogue, kind};
use maquette_graph::harness::{Harness, TrialError};
use maquette_graph::{CancelToken, Literal, NodeKind, Unit};

fn said(error: &TrialError) -> String {
    error.to_string()
}

#[test]
fn inputs_by_name_outputs_by_name_and_what_was_reported() {
    let catalogue = catalogue();
    let measure = catalogue.kind("measure").unwrap();
    let trial = Harness::new(measure).give("samples", Samples(vec![1.0, 2.5])).run().unwrap();
    assert_eq!((trial.value::<f64>("total"), trial.value::<i64>("total")), (Some(&3.5), None));
    assert_eq!(trial.value::<f64>("nothing"), None);
    let figure = trial.report.figure("samples").unwrap();
    assert_eq!((figure.value, figure.unit, trial.report.notes.len()), (3.5, Unit::Length, 1));
    let trial = Harness::new(measure).give("samples", Samples(vec![1.0])).give("offset", 2.0).run().unwrap();
    assert_eq!((trial.value("total"), trial.report.notes.len()), (Some(&3.0), 0));
}

#[test]
fn what_does_not_fit_is_refused_with_the_input() {
    let catalogue = catalogue();
    let everything = catalogue.kind("everything").unwrap();
    let run = |input: &str, literal| said(&Harness::new(everything).set(input, literal).run().unwrap_err());
    assert_eq!(run("length", Literal::Number(20.0)), "input \"length\": 20 m is out of range: give 0.001 to 10 m");
    assert!(run("choice", Literal::Choice("sideways".into())).contains("is not an option"));
    assert!(run("number", Literal::Boolean(true)).contains("it takes a number"));
    assert!(run("width", Literal::Number(1.0)).contains("\"everything\" has no such input; it has number, length"));
    assert!(Harness::new(everything).set("number", Literal::Integer(2)).run().unwrap().value("number") == Some(&2.0));
    let measure = catalogue.kind("measure").unwrap();
    assert_eq!(said(&Harness::new(measure).run().unwrap_err()), "input \"samples\": nothing is given: give a samples");
    let wrong = Harness::new(measure).give("samples", 1.0).run().unwrap_err();
    assert_eq!(said(&wrong), "input \"samples\": it takes samples, and number is given");
}

#[test]
fn files_come_from_the_test() {
    let catalogue = catalogue();
    let read = catalogue.kind("read-file").unwrap();
    let trial = Harness::new(read).file("file", "a.txt", *b"inside").run().unwrap();
    assert_eq!(trial.value::<String>("text").unwrap(), "inside");
    assert!(said(&Harness::new(read).run().unwrap_err()).contains("no file is named"));
}

#[test]
fn failures_and_panics_are_told_as_in_a_graph() {
    let catalogue = catalogue();
    let root = Harness::new(catalogue.kind("root").unwrap()).set("number", Literal::Number(-1.0)).run().unwrap_err();
    assert!(said(&root).starts_with("input \"number\": ") && !root.is_cancelled(), "{root}");
    let panics = Harness::new(catalogue.kind("panics").unwrap()).run().unwrap_err();
    assert!(said(&panics).contains("broke down"), "{panics}");
}

fn patient(steps: u32, millis: u64) -> NodeKind {
    kind("patient", |node| {
        node.evaluate(move |ports| {
            for step in 0..steps {
                ports.progress(f64::from(step) / f64::from(steps))?;
                std::thread::sleep(Duration::from_millis(millis));
            }
            Ok(())
        });
    })
}

#[test]
fn progress_is_kept_and_its_answer_stops_the_node() {
    let patient = patient(4, 20);
    let trial = Harness::new(&patient).run().unwrap();
    assert_eq!(trial.progress, [0.0, 0.25, 0.5, 0.75]);
    assert!(trial.longest_silence >= Duration::from_millis(20) && trial.longest_silence <= trial.duration);
    let asked = AtomicUsize::new(0);
    let stopped = Harness::new(&patient).while_progress(|_| asked.fetch_add(1, Ordering::Relaxed) < 2).run();
    assert_eq!(stopped.unwrap_err(), TrialError::Cancelled(vec![0.0, 0.25, 0.5]));
    let token = CancelToken::new();
    token.cancel();
    let stopped = Harness::new(&patient).while_progress(|_| !token.is_cancelled()).run().unwrap_err();
    assert!(stopped.is_cancelled() && said(&stopped) == "it was stopped after 1 progress reports");
}
