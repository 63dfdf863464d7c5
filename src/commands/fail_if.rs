//! `--fail-if 'NODE.figure > 0.01'`: limits that a run must keep.

use std::fmt;

use maquette_graph::{Evaluation, OutcomeState};

/// When a figure fails the run.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Limit {
    /// As it was given.
    text: String,
    /// The node; any node where none is named.
    node: Option<String>,
    figure: String,
    comparison: Comparison,
    bound: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Comparison {
    Above,
    AtLeast,
    Below,
    AtMost,
}

/// The longer signs first, because the shorter ones begin them.
const SIGNS: [(&str, Comparison); 4] =
    [(">=", Comparison::AtLeast), ("<=", Comparison::AtMost), (">", Comparison::Above), ("<", Comparison::Below)];

impl Comparison {
    /// Whether a figure that compares so fails. What is not a number keeps no limit.
    fn fails(self, value: f64, bound: f64) -> bool {
        value.is_nan()
            || match self {
                Self::Above => value > bound,
                Self::AtLeast => value >= bound,
                Self::Below => value < bound,
                Self::AtMost => value <= bound,
            }
    }
}

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// What the limits say about an evaluation.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Verdict {
    /// Figures that fail the run, one message each.
    pub(super) exceeded: Vec<String>,
    /// Limits on figures that no node measures, one message each.
    pub(super) unknown: Vec<String>,
}

impl Limit {
    /// Reads `NODE.figure > NUMBER` or `figure > NUMBER`, with `>`, `>=`, `<` or `<=`.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let fail = |reason: &str| format!("--fail-if '{text}': {reason}; write it as 'NODE.figure > 0.01'");
        let (at, sign, comparison) = SIGNS
            .iter()
            .filter_map(|(sign, comparison)| Some((text.find(sign)?, *sign, *comparison)))
            .min_by_key(|(at, sign, _)| (*at, std::cmp::Reverse(sign.len())))
            .ok_or_else(|| fail("there is no >, >=, < or <="))?;
        let (address, bound) = (text[..at].trim(), text[at + sign.len()..].trim());
        let bound: f64 = bound.parse().map_err(|_| fail(&format!("\"{bound}\" is not a number")))?;
        if bound.is_nan() {
            return Err(fail("NaN can't be a limit"));
        }
        let (node, figure) = match address.rsplit_once('.') {
            Some((node, figure)) => (Some(node.trim().to_owned()), figure.trim()),
            None => (None, address),
        };
        if figure.is_empty() || node.as_ref().is_some_and(String::is_empty) {
            return Err(fail("the name of a figure is missing"));
        }
        Ok(Self { text: text.to_owned(), node, figure: figure.to_owned(), comparison, bound })
    }

    /// As it was given.
    pub(super) fn text(&self) -> &str {
        &self.text
    }

    fn is_about(&self, node: &str, figure: &str) -> bool {
        self.figure == figure && self.node.as_ref().is_none_or(|n| n == node)
    }
}

/// Holds all limits against the figures of an evaluation.
pub(super) fn judge(limits: &[Limit], evaluation: &Evaluation) -> Verdict {
    let figures: Vec<_> = evaluation
        .outcomes()
        .filter_map(|(_, outcome)| match &outcome.state {
            OutcomeState::Done { report, .. } => Some((outcome, report)),
            _ => None,
        })
        .flat_map(|(outcome, report)| report.figures.iter().map(|figure| (outcome.name.as_str(), figure)))
        .collect();
    // A node that failed might have measured what is asked for.
    let complete = evaluation.is_complete();
    let mut verdict = Verdict::default();
    for limit in limits {
        let mut meant = figures.iter().filter(|(node, figure)| limit.is_about(node, &figure.name)).peekable();
        if meant.peek().is_none() && complete {
            let mut known: Vec<_> = figures.iter().map(|(node, figure)| format!("{node}.{}", figure.name)).collect();
            known.dedup();
            let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
            verdict.unknown.push(format!("error: --fail-if '{limit}': no node measures that; known figures: {known}"));
        }
        for (node, figure) in meant.filter(|(_, figure)| limit.comparison.fails(figure.value, limit.bound)) {
            let unit = if figure.unit.is_empty() { String::new() } else { format!(" {}", figure.unit) };
            let value = figure.value;
            verdict
                .exceeded
                .push(format!("error: node {node:?}: {} is {value}{unit}; it fails '{limit}'", figure.name));
        }
    }
    verdict
}

#[cfg(test)]
mod tests {
    use maquette_graph::{Catalogue, Evaluator, Graph, Literal, NodeKind, Request};

    use super::*;

    fn evaluation() -> Evaluation {
        let mut node = NodeKind::declare("gauge", 1, "test", "Measures its input.");
        let number = node.number("number", 0.0, -1e9..=1e9, "What it measures.");
        let out = node.output::<f64>("number", "The same.");
        node.evaluate(move |ports| {
            let value = ports.value(number);
            ports.figure("gap", value, "m");
            ports.figure("nothing", f64::NAN, "");
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
        Evaluator::default().evaluate(&catalogue, &graph, &Request::nodes(&ids))
    }

    fn verdict(limit: &str) -> Verdict {
        judge(&[Limit::parse(limit).unwrap()], &evaluation())
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
        ] {
            let verdict = verdict(limit);
            assert_eq!((verdict.exceeded.len(), verdict.unknown.len()), (count, 0), "{limit}: {verdict:?}");
        }
    }

    #[test]
    fn the_message_says_node_value_unit_and_limit() {
        let exceeded = verdict("right arm.gap > 1").exceeded;
        assert_eq!(exceeded, ["error: node \"right arm\": gap is 2 m; it fails 'right arm.gap > 1'"]);
    }

    #[test]
    fn unknown_figures_list_the_known_ones() {
        for limit in ["gaps > 1", "middle arm.gap > 1"] {
            let unknown = verdict(limit).unknown;
            assert_eq!(unknown.len(), 1);
            assert!(unknown[0].contains("known figures: left arm.gap, left arm.nothing, right arm.gap"), "{unknown:?}");
        }
    }

    #[test]
    fn what_is_no_limit_is_refused() {
        for text in ["gap", "gap > wide", "> 3", ".gap > 1", "node. > 1", "gap = 3", "gap > NaN", "", "gap >> 1"] {
            let error = Limit::parse(text).unwrap_err();
            assert!(error.contains("write it as 'NODE.figure > 0.01'"), "{text}: {error}");
        }
    }
}
