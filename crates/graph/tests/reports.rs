//! Figures and tables: declared, cached with the values, counted in the budget; and what is measured on request only.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that panics fails")]

mod kinds;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use kinds::{Rig, kind, state};
use maquette_graph::{
    CancelToken, Catalogue, CatalogueError, Cell, EvaluatorOptions, OutcomeState, Report, Request, Unit,
};

/// Numbers from 0, as a table, and their sum on request.
fn rows() -> maquette_graph::NodeKind {
    kind("rows", |node| {
        let count = node.integer("count", 3, 0..=100_000, "Rows of the table.");
        let out = node.output::<f64>("number", "How many.");
        let squares = node.table("squares", &[("row", Unit::None), ("square", Unit::Length)], "The squares.");
        let sum = node.figure("sum", Unit::Length, "The sum of what came out; measured on request.");
        node.evaluate(move |ports| {
            let count = ports.count(count);
            ports.table(squares, (0..count).map(|i| vec![i.into(), (i * i).into()]).collect());
            ports.write(out, count as f64);
            Ok(())
        });
        node.examine(move |seen| {
            let number = *seen.read(out);
            if number > 50.0 {
                return Err(maquette_graph::NodeError::new("too many to add up"));
            }
            seen.figure(sum, number * 2.0);
            seen.warn("added up");
            Ok(())
        });
    })
}

fn rig(byte_budget: usize) -> Rig {
    let mut rig = Rig::with_options(&EvaluatorOptions { threads: 1, byte_budget });
    rig.register(rows());
    rig.add("rows", "rows");
    rig
}

fn report(evaluation: &maquette_graph::Evaluation, rig: &Rig) -> Report {
    match &evaluation.outcome(rig.id("rows")).unwrap().state {
        OutcomeState::Done { report, .. } => (**report).clone(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_table_comes_with_its_declared_columns_and_again_from_the_memo() {
    let mut rig = rig(usize::MAX);
    for ran in [1, 0] {
        let evaluation = rig.evaluate(&["rows"]);
        assert_eq!(evaluation.run_count(), ran);
        let report = report(&evaluation, &rig);
        let table = report.table("squares").unwrap();
        assert_eq!((&*table.columns[1].name, table.columns[1].unit), ("square", Unit::Length));
        assert_eq!(table.rows[2], [Cell::Number(2.0), Cell::Number(4.0)]);
        assert_eq!(table.label(2), "row 2");
        assert!(report.figures.is_empty() && report.warnings.is_empty(), "only on request");
    }
}

#[test]
fn reports_count_in_the_budget() {
    let mut rig = rig(usize::MAX);
    rig.evaluate(&["rows"]);
    let few = rig.evaluator.remembered_bytes();
    rig.put("rows.count", maquette_graph::Literal::Integer(10_000));
    rig.evaluate(&["rows"]);
    let many = rig.evaluator.remembered_bytes() - few;
    assert!(many > 10_000 * 2 * size_of::<Cell>(), "{many}");

    let mut small = self::rig(100_000);
    small.put("rows.count", maquette_graph::Literal::Integer(10_000));
    small.evaluate(&["rows"]);
    assert_eq!(small.evaluator.remembered_bytes(), 0, "a report larger than the budget is not kept");
}

#[test]
fn an_examination_runs_on_request_once_and_without_the_node() {
    let mut rig = rig(usize::MAX);
    let id = rig.id("rows");
    rig.evaluate(&["rows"]);
    let evaluation = rig.request(Request::nodes(&[id]).examine());
    assert_eq!(rig.log, ["hit rows", "planned 0", "examined rows"]);
    let found = report(&evaluation, &rig);
    assert_eq!((found.figure("sum").unwrap().value, found.figure("sum").unwrap().unit), (6.0, Unit::Length));
    assert_eq!((found.warnings.len(), found.tables.len()), (1, 1), "what it said before stays");
    let again = rig.request(Request::nodes(&[id]).examine());
    assert_eq!(rig.log, ["hit rows", "planned 0"]);
    assert_eq!(report(&again, &rig), found);
    assert!(report(&rig.request(Request::nodes(&[id])), &rig).figures.is_empty());
    // Undone and redone: the examination is remembered with the value.
    rig.put("rows.count", maquette_graph::Literal::Integer(4));
    rig.request(Request::nodes(&[id]).examine());
    assert_eq!(rig.log, ["planned 1", "started rows", "finished rows", "examined rows"]);
    rig.put("rows.count", maquette_graph::Literal::Integer(3));
    rig.request(Request::nodes(&[id]).examine());
    assert_eq!(rig.log, ["hit rows", "planned 0"]);
}

/// A node that takes the number of `rows` and measures nothing, and what comes behind it.
fn behind() -> maquette_graph::NodeKind {
    kind("behind", |node| {
        let number = node.number("number", 0.0, -1e9..=1e9, "A number.");
        let out = node.output::<f64>("number", "One more.");
        node.evaluate(move |ports| {
            ports.write(out, ports.value(number) + 1.0);
            Ok(())
        });
    })
}

#[test]
fn what_is_asked_for_depends_on_is_examined_too_and_only_what_is_named_where_names_are_given() {
    let mut rig = rig(usize::MAX);
    rig.register(behind());
    rig.add("behind", "behind");
    rig.add("rows", "aside");
    rig.link("rows.number", "behind.number");
    let [rows, aside, behind] = ["rows", "aside", "behind"].map(|name| rig.id(name));
    rig.request(Request::nodes(&[behind]));
    assert_eq!(rig.log, ["planned 2", "started rows", "finished rows", "started behind", "finished behind"]);
    let found = rig.request(Request::nodes(&[behind]).examine());
    // Which hit is found first is no promise.
    rig.log[..2].sort_unstable();
    assert_eq!(rig.log, ["hit behind", "hit rows", "planned 0", "examined rows"]);
    assert_eq!(report(&found, &rig).figure("sum").map(|sum| sum.value), Some(6.0));

    rig.put("rows.count", maquette_graph::Literal::Integer(4));
    rig.put("aside.count", maquette_graph::Literal::Integer(5));
    let without = rig.request(Request::nodes(&[behind, aside]).examine_only(&[aside]));
    assert!(rig.log.contains(&"examined aside".to_owned()) && !rig.log.contains(&"examined rows".to_owned()));
    assert!(report(&without, &rig).figures.is_empty());
    // What nothing asked for depends on is neither run nor examined.
    rig.put("aside.count", maquette_graph::Literal::Integer(7));
    rig.request(Request::nodes(&[behind]).examine_only(&[aside, behind]));
    assert!(!rig.log.iter().any(|line| line.contains("aside") || line.contains("examined")), "{:?}", rig.log);
    let found = rig.request(Request::nodes(&[behind]).examine_only(&[rows]));
    assert_eq!(report(&found, &rig).figure("sum").map(|sum| sum.value), Some(8.0));
}

#[test]
fn a_failing_examination_is_a_failure_and_a_cancelled_one_is_not() {
    let mut rig = rig(usize::MAX);
    let id = rig.id("rows");
    rig.put("rows.count", maquette_graph::Literal::Integer(60));
    let evaluation = rig.request(Request::nodes(&[id]).examine());
    assert_eq!(state(&evaluation, id), "failed: too many to add up");
    assert!(rig.evaluate(&["rows"]).is_complete(), "without it all is well");

    rig.put("rows.count", maquette_graph::Literal::Integer(5));
    rig.evaluate(&["rows"]);
    let cancel = CancelToken::new();
    cancel.cancel();
    let evaluation = rig.request(Request::nodes(&[id]).examine().cancel(&cancel));
    assert!(evaluation.cancelled && evaluation.failures().count() == 0);
    assert!(report(&rig.request(Request::nodes(&[id]).examine()), &rig).figure("sum").is_some());
}

#[test]
fn an_examination_told_to_stop_is_not_remembered() {
    let mut rig = Rig::default();
    let cancel = CancelToken::new();
    let (token, heard) = (cancel.clone(), Arc::new(AtomicBool::new(false)));
    let told = heard.clone();
    rig.register(kind("slow", |node| {
        let out = node.output::<f64>("number", "One.");
        let seen_all = node.figure("all", Unit::None, "One where it was not stopped.");
        node.evaluate(move |ports| {
            ports.write(out, 1.0);
            Ok(())
        });
        node.examine(move |seen| {
            let go_on = seen.progress_callback();
            token.cancel();
            told.store(!go_on(0.5), Ordering::SeqCst);
            seen.figure(seen_all, 1.0);
            Ok(())
        });
    }));
    let id = rig.add("slow", "rows");
    let evaluation = rig.request(Request::nodes(&[id]).examine().cancel(&cancel));
    assert!(heard.load(Ordering::SeqCst) && evaluation.cancelled);
    assert!(report(&evaluation, &rig).is_empty());
    let evaluation = rig.request(Request::nodes(&[id]).examine());
    assert!(report(&evaluation, &rig).figure("all").is_some() && rig.log.contains(&"examined rows".to_owned()));
}

#[test]
fn a_table_with_too_few_cells_and_a_foreign_figure_are_mistakes_of_the_kind() {
    let mut other = maquette_graph::NodeKind::declare("other", 1, "test", "Owns a figure.");
    let foreign = other.figure("gap", Unit::Length, "A gap.");
    let mut rig = Rig::default();
    rig.register(kind("foreign", |node| {
        node.evaluate(move |ports| {
            ports.figure(foreign, 1.0);
            Ok(())
        });
    }));
    rig.register(kind("narrow", |node| {
        let table = node.table("fit", &[("row", Unit::None), ("gap", Unit::Length)], "A table.");
        node.evaluate(move |ports| {
            ports.table(table, vec![vec![0_usize.into(), 0.1.into()], vec![1_usize.into()]]);
            Ok(())
        });
    }));
    let ids = [rig.add("foreign", "foreign"), rig.add("narrow", "narrow")];
    let evaluation = rig.request(Request::nodes(&ids));
    let said = ids.map(|id| state(&evaluation, id));
    assert!(said[0].contains("reports figure 0, which is not its own; this is a mistake in the kind"), "{said:?}");
    assert!(said[1].contains("gave row 1 of its table \"fit\" 1 cells for 2 columns"), "{said:?}");
}

#[test]
fn figures_and_tables_of_one_name_are_refused() {
    let twice = kind("twice", |node| {
        node.figure("gap", Unit::Length, "A gap.");
        node.table("gap", &[("rail", Unit::None)], "Gaps.");
    });
    let error = Catalogue::new().register(twice).unwrap_err();
    assert!(matches!(&error, CatalogueError::DuplicatePort { what: "figures or tables", .. }), "{error}");
}
