//! Whether the memo can be trusted: each value is changed and put back, and what the memo answered on the way is
//! compared with what an evaluator gives that remembers nothing.

use std::path::Path;

use maquette_graph::file::Project;
use maquette_graph::{
    Catalogue, Evaluation, Evaluator, EvaluatorOptions, Graph, InputSpec, Literal, NodeId, OutcomeState, Request,
    Source,
};

/// How to evaluate.
pub(super) struct Options<'a> {
    /// The folder at which relative paths start.
    pub(super) base: &'a Path,
    /// The files that may be read.
    pub(super) project: &'a Project,
    /// Threads; 0 takes one per core.
    pub(super) threads: usize,
}

/// What was found.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Found {
    /// Values that were changed and put back.
    pub(super) perturbed: usize,
    /// Answers of the memo that were compared.
    pub(super) answers: usize,
    /// Where node and memo differ, one message each.
    pub(super) differences: Vec<String>,
}

/// Changes every value that the targets depend on, but for names of files, evaluates with one evaluator that remembers,
/// puts the value back, evaluates again, and compares both times. The graph ends as it began.
pub(super) fn check(catalogue: &Catalogue, graph: &mut Graph, targets: &[NodeId], options: &Options<'_>) -> Found {
    let nodes = graph.upstream(targets);
    let mut trial = Trial { catalogue, nodes: &nodes, options, found: Found::default() };
    let mut remembering = trial.evaluator();
    trial.evaluate(&mut remembering, graph);
    let plain = trial.evaluate_afresh(graph);
    for id in &nodes {
        for (input, others, before) in perturbations(graph, *id) {
            let name = graph.node(*id).map_or("", |n| n.name()).to_owned();
            if !others.into_iter().any(|other| graph.set(*id, &input, other).is_ok()) {
                continue;
            }
            trial.found.perturbed += 1;
            let (memo, fresh) = (trial.evaluate(&mut remembering, graph), trial.evaluate_afresh(graph));
            trial.compare(graph, &memo, &fresh, &format!("after \"{name}.{input}\" was changed"));
            let restored = match before {
                Some(literal) => graph.set(*id, &input, literal),
                None => graph.reset(*id, &input),
            };
            if let Err(error) = restored {
                trial.found.differences.push(format!("\"{name}.{input}\" can't be put back: {error}"));
                return trial.found;
            }
            let memo = trial.evaluate(&mut remembering, graph);
            trial.compare(graph, &memo, &plain, &format!("after \"{name}.{input}\" was changed and put back"));
        }
    }
    trial.found
}

struct Trial<'a> {
    catalogue: &'a Catalogue,
    nodes: &'a [NodeId],
    options: &'a Options<'a>,
    found: Found,
}

impl Trial<'_> {
    fn evaluator(&self) -> Evaluator {
        Evaluator::new(&EvaluatorOptions { threads: self.options.threads, ..Default::default() })
    }

    fn evaluate(&self, evaluator: &mut Evaluator, graph: &Graph) -> Evaluation {
        let request = Request::nodes(self.nodes).base(self.options.base).project(self.options.project);
        evaluator.evaluate(self.catalogue, graph, &request)
    }

    fn evaluate_afresh(&self, graph: &Graph) -> Evaluation {
        self.evaluate(&mut self.evaluator(), graph)
    }

    fn compare(&mut self, graph: &Graph, memo: &Evaluation, fresh: &Evaluation, when: &str) {
        for (id, outcome) in memo.outcomes().filter(|(_, outcome)| !outcome.ran) {
            self.found.answers += 1;
            if said(memo, id) != said(fresh, id) {
                let name = graph.node(id).map_or("", |n| n.name());
                let kind = &outcome.kind;
                self.found.differences.push(format!("{when}, it answers for \"{name}\" ({kind}) what is no longer so"));
            }
        }
    }
}

/// All that an evaluation says about a node, as text.
fn said(evaluation: &Evaluation, node: NodeId) -> String {
    match evaluation.outcome(node).map(|outcome| &outcome.state) {
        Some(OutcomeState::Done { values, report }) => {
            let hashes: Vec<_> = values.iter().flat_map(|values| values.iter()).map(|v| v.hash().to_string()).collect();
            format!("{} {report:?}", hashes.join(" "))
        }
        Some(OutcomeState::Failed(failure)) => format!("failed {failure}"),
        Some(OutcomeState::Waiting(on)) => format!("waits {on:?}"),
        Some(OutcomeState::Cancelled) => "cancelled".to_owned(),
        None => "nothing".to_owned(),
    }
}

/// For each input of a node that holds a value: its name, other values of which one may fit, what to put back.
fn perturbations(graph: &Graph, id: NodeId) -> Vec<(String, Vec<Literal>, Option<Literal>)> {
    let Some((node, kind)) = graph.node(id).and_then(|node| Some((node, node.kind()?))) else { return Vec::new() };
    kind.inputs()
        .iter()
        .filter_map(|spec| {
            let (now, before) = match node.source(&spec.name) {
                Some(Source::Literal { literal, .. }) => (literal, Some(literal.clone())),
                None => (spec.default.as_ref()?, None),
                Some(Source::Link(_) | Source::Parameter(_) | Source::Unread(_)) => return None,
            };
            let others = others(now, spec).into_iter().filter(|other| other != now).collect();
            Some((spec.name.clone(), others, before))
        })
        .collect()
}

/// Values near this one; not all may fit.
fn others(now: &Literal, spec: &InputSpec) -> Vec<Literal> {
    const STEP: f64 = 1.0 / 64.0;
    match now {
        Literal::Number(value) => {
            [value * (1.0 + STEP), value * (1.0 - STEP), value + STEP, value - STEP].map(Literal::Number).into()
        }
        Literal::Integer(value) => [value.saturating_add(1), value.saturating_sub(1)].map(Literal::Integer).into(),
        Literal::Boolean(value) => vec![Literal::Boolean(!value)],
        Literal::Text(text) => vec![Literal::Text(format!("{text}x"))],
        Literal::Choice(_) => spec.options.iter().map(|option| Literal::Choice(option.name.clone())).collect(),
        Literal::Vector([x, y, z]) => vec![Literal::Vector([x + STEP, *y, *z]), Literal::Vector([x - STEP, *y, *z])],
        Literal::Colour([r, g, b, a]) => [r + STEP, r - STEP].map(|red| Literal::Colour([red, *g, *b, *a])).into(),
        Literal::Strokes(strokes) => {
            let mut moved = strokes.clone();
            let points = moved.first_mut().map(|stroke| &mut stroke.points);
            if let Some(points) = points
                && !points.is_empty()
            {
                let middle = points.len() / 2;
                points[middle].x += STEP * STEP;
            }
            vec![Literal::Strokes(moved)]
        }
        Literal::File(_) => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU64, Ordering};

    use maquette_graph::NodeKind;

    use super::*;

    /// A kind that doubles, and one that counts its runs where it should be a function of its inputs.
    fn catalogue() -> Catalogue {
        let mut catalogue = Catalogue::new();
        for (name, honest) in [("double", true), ("forgetful", false)] {
            let mut node = NodeKind::declare(name, 1, "test", "Doubles a number.");
            let number = node.number("number", 1.0, -1e9..=1e9, "The number.");
            let twice = node.output::<f64>("number", "Twice the number.");
            #[expect(clippy::cast_precision_loss, reason = "a few runs")]
            let runs = move |counter: &AtomicU64| counter.fetch_add(1, Ordering::Relaxed) as f64;
            let counter = AtomicU64::new(0);
            node.evaluate(move |ports| {
                let extra = if honest { 0.0 } else { runs(&counter) };
                let value = 2.0 * ports.value(number) + extra;
                ports.write(twice, value);
                Ok(())
            });
            catalogue.register(node).unwrap();
        }
        catalogue
    }

    fn found(kind: &str) -> Found {
        let catalogue = catalogue();
        let mut graph = Graph::new();
        let first = graph.add(&catalogue, "double", "first").unwrap();
        let second = graph.add(&catalogue, kind, "second").unwrap();
        graph.set(first, "number", Literal::Number(3.0)).unwrap();
        graph.connect(&catalogue, first, "number", second, "number").unwrap();
        let free = graph.add(&catalogue, "double", "third").unwrap();
        let project = Project::default();
        let options = Options { base: Path::new(""), project: &project, threads: 1 };
        let before = maquette_graph::file::to_text(&graph);
        let found = check(&catalogue, &mut graph, &[second, free], &options);
        assert_eq!(maquette_graph::file::to_text(&graph), before, "values are put back");
        found
    }

    #[test]
    fn functions_of_their_inputs_pass() {
        let found = found("double");
        assert_eq!((found.perturbed, found.differences), (2, vec![]));
        // The first value changed: the third node is a hit; put back: all three are; and so on.
        assert_eq!(found.answers, 1 + 3 + 2 + 3);
    }

    #[test]
    fn a_node_that_depends_on_more_than_its_inputs_is_named() {
        let found = found("forgetful");
        assert!(found.differences[0].contains("answers for \"second\" (forgetful)"), "{found:?}");
        assert!(found.differences[0].starts_with("after \"first.number\" was changed"), "{found:?}");
    }

    #[test]
    fn every_catalogue_default_has_another_value() {
        let catalogue = maquette_nodes::catalogue().unwrap();
        for kind in catalogue.kinds() {
            let mut graph = Graph::new();
            let id = graph.add(&catalogue, kind.name(), "node").unwrap();
            let perturbed: Vec<_> = perturbations(&graph, id)
                .into_iter()
                .filter(|(input, others, _)| others.iter().any(|other| graph.set(id, input, other.clone()).is_ok()))
                .map(|(input, _, _)| input)
                .collect();
            for spec in kind.inputs() {
                let holds_nothing_yet = matches!(&spec.default, None | Some(Literal::File(_)))
                    || matches!(&spec.default, Some(Literal::Strokes(s)) if s.is_empty());
                assert_eq!(perturbed.contains(&spec.name), !holds_nothing_yet, "{}.{}", kind.name(), spec.name);
            }
        }
    }
}
