use maquette_graph::{Catalogue, Evaluator, Literal, NodeKind, Request};

use super::*;

/// A graph of two gauges, and its evaluation.
fn gauges() -> (Graph, Vec<NodeId>, Evaluation) {
    let mut node = NodeKind::declare("gauge", 1, "test", "Measures its input.");
    let number = node.number("number", 0.0, -1e9..=1e9, "What it measures.");
    let out = node.output::<f64>("number", "The same.");
    let gap = node.figure("gap", Unit::Length, "The number.");
    let nothing = node.figure("nothing", Unit::None, "Not a number.");
    node.figure("never", Unit::None, "Never measured.");
    let columns = [("section", Unit::None), ("error", Unit::Angle), ("side", Unit::None)];
    let fit = node.table("fit", &columns, "Multiples of the number.");
    node.evaluate(move |ports| {
        let value = ports.value(number);
        ports.figure(gap, value);
        ports.figure(nothing, f64::NAN);
        let row = |k: usize| vec![k.into(), (value * k as f64).into(), "left".into()];
        ports.table(fit, (0..20).map(row).collect());
        if value > 1.0 {
            ports.warn("it is wide: narrow it");
        }
        ports.write(out, value);
        Ok(())
    });
    let mut catalogue = Catalogue::new();
    catalogue.register(node).unwrap();
    let mut graph = Graph::new();
    let ids = [("left arm", 0.5), ("right arm", 2.0)].map(|(name, value)| {
        let id = graph.add(&catalogue, "gauge", name).unwrap();
        graph.set(id, "number", Literal::Number(value)).unwrap();
        id
    });
    let evaluation = Evaluator::default().evaluate(&catalogue, &graph, &Request::nodes(&ids));
    (graph, ids.into(), evaluation)
}

fn verdict(limit: &str) -> Verdict {
    judge(&[Limit::parse(limit).unwrap()], &gauges().2, &[])
}

fn refused(limit: &str) -> Vec<String> {
    let (graph, ids, _) = gauges();
    refuse_unknown(&[Limit::parse(limit).unwrap()], &graph, &ids)
}

#[test]
fn each_comparison_fails_where_it_holds_and_nowhere_else() {
    for (limit, count) in [
        ("gap > 2", 0),
        ("gap >= 2", 1),
        ("gap>0.4", 2),
        ("gap < 0.5", 0),
        ("gap <= 0.5", 1),
        ("left arm.gap > 0.4", 1),
        (" right arm . gap<=2e0 ", 1),
        ("left arm.gap > 1", 0),
        ("nothing > 0", 2),
        ("nothing < 0", 2),
        ("fit.error > 37", 1),
        ("left arm.fit.error > 9", 1),
        ("left arm.fit.section > 16", 3),
        ("max(fit.error) > 9", 2),
        ("max(fit.error) > 37", 1),
        ("min(fit.error) < 0", 0),
        ("mean(left arm.fit.error) > 4.7", 1),
        ("sum(fit.error) > 379", 1),
        ("count(fit.error) < 20", 0),
        ("count(fit.side) <= 20", 2),
        ("warnings", 1),
        ("warnings > 1", 0),
        ("left arm.warnings", 0),
        ("right arm.warnings > 0", 1),
    ] {
        let verdict = verdict(limit);
        assert_eq!((verdict.exceeded.len(), verdict.unknown.len()), (count, 0), "{limit}: {verdict:?}");
        assert_eq!(refused(limit), [""; 0]);
    }
}

#[test]
fn the_message_says_node_row_value_unit_and_limit() {
    let exceeded = verdict("right arm.gap > 1").exceeded;
    assert_eq!(exceeded, ["error: node \"right arm\": gap is 2 m; it fails 'right arm.gap > 1'"]);
    let exceeded = verdict("left arm.fit.error > 9").exceeded;
    let row = "error: node \"left arm\", section 19: error is 9.5 degrees; it fails 'left arm.fit.error > 9'";
    assert_eq!(exceeded, [row]);
    let exceeded = verdict("max(left arm.fit.error) > 9").exceeded;
    let most = "error: node \"left arm\": max of fit.error is 9.5 degrees; it fails 'max(left arm.fit.error) > 9'";
    assert_eq!(exceeded, [most]);
    let exceeded = verdict("left arm.fit.error >= 0").exceeded;
    assert_eq!(exceeded.len(), 9);
    assert_eq!(exceeded[8], "error: node \"left arm\": 12 more rows of fit fail 'left arm.fit.error >= 0'");
    let exceeded = verdict("warnings").exceeded;
    assert_eq!(exceeded, ["error: node \"right arm\": it is wide: narrow it; it fails 'warnings'"]);
}

#[test]
fn warnings_of_the_file_count_where_no_node_is_named() {
    let file = ["g.ron:3:1: warning: a field is not known".to_owned()];
    let judged = |limit: &str| judge(&[Limit::parse(limit).unwrap()], &gauges().2, &file).exceeded;
    assert_eq!(judged("warnings").len(), 2);
    assert!(judged("warnings")[0].contains("a field is not known; it fails 'warnings'"));
    assert_eq!(judged("right arm.warnings").len(), 1);
}

#[test]
fn unknown_figures_are_refused_before_the_run_with_what_was_meant() {
    for (limit, meant) in [
        ("gaps > 1", "gap"),
        ("middle arm.gap > 1", "left arm.gap"),
        ("right arm.fit.eror > 1", "right arm.fit.error"),
        ("fit.erorr > 1", "fit.error"),
    ] {
        let refused = refused(limit);
        assert_eq!(refused.len(), 1, "{limit}");
        assert!(refused[0].contains(&format!("did you mean \"{meant}\"?")), "{refused:?}");
        let first = if limit.starts_with("right arm") { "right arm" } else { "left arm" };
        assert!(refused[0].contains(&format!("known figures: {first}.gap, {first}.nothing")), "{refused:?}");
    }
    assert!(refused("max(gap) > 1")[0].contains("max takes a column of a table"));
    assert!(refused("lost arm.warnings")[0].contains("no node measures that"));
}

#[test]
fn what_was_not_measured_or_is_no_number_keeps_no_limit() {
    assert!(verdict("never > 1").unknown[0].contains("no node measured that in this run"));
    assert!(verdict("fit.side > 1").unknown[0].contains("fit.side holds words such as \"left\""));
}
