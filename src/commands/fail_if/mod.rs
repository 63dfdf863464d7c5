//! `--fail-if 'NODE.figure > 0.01'`: limits that a run must keep.

mod limit;

use maquette_graph::{Cell, Evaluation, Graph, NodeId, OutcomeState, Report, Table, Unit, closest};

pub(super) use limit::Limit;
use limit::WARNINGS;

/// How many rows of one table are named.
const ROWS: usize = 8;

/// How many names of figures fit a message.
const NAMES: usize = 12;

/// What the limits say about an evaluation.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Verdict {
    /// What fails the run, one message each.
    pub(super) exceeded: Vec<String>,
    /// Limits that can't be held against anything, one message each.
    pub(super) unknown: Vec<String>,
}

/// What may be limited at these nodes: the node's name, and a figure or `table.column`.
fn declared<'a>(graph: &'a Graph, nodes: &[NodeId]) -> Vec<(&'a str, String)> {
    let mut names = Vec::new();
    for (node, kind) in nodes.iter().filter_map(|id| graph.node(*id)).filter_map(|n| Some((n.name(), n.kind()?))) {
        names.extend(kind.figures().iter().map(|figure| (node, figure.name.clone())));
        for table in kind.tables() {
            names.extend(table.columns.iter().map(|column| (node, format!("{}.{}", table.name, column.name))));
        }
    }
    names
}

/// Says, before anything runs, which limits no node asked for can ever be held against.
pub(super) fn refuse_unknown(limits: &[Limit], graph: &Graph, targets: &[NodeId]) -> Vec<String> {
    let nodes = graph.upstream(targets);
    let known = declared(graph, &nodes);
    let node_names: Vec<&str> = nodes.iter().filter_map(|id| graph.node(*id)).map(|node| node.name()).collect();
    let mut refused = Vec::new();
    for limit in limits {
        let warnings = limit.path == WARNINGS || node_names.iter().any(|node| limit.is_about(node, WARNINGS));
        let mut meant = known.iter().filter(|(node, name)| limit.is_about(node, name)).peekable();
        if let Some(aggregate) = limit.aggregate
            && (warnings || meant.clone().any(|(_, name)| !name.contains('.')))
        {
            let message = "takes a column of a table, and this is a single number";
            refused.push(format!("error: --fail-if '{limit}': {} {message}: leave it out", aggregate.name()));
        } else if !warnings && meant.peek().is_none() {
            refused.push(format!("error: --fail-if '{limit}': no node measures that; {}", remedy(limit, &known)));
        }
    }
    refused
}

/// The name that was meant, and those that there are: of the node that is named, where there is one.
fn remedy(limit: &Limit, known: &[(&str, String)]) -> String {
    let whole = |(node, name): &(&str, String)| format!("{node}.{name}");
    // The right figure of a wrong node is more likely meant than another figure.
    let named: Vec<String> =
        known.iter().filter(|(_, name)| limit.path.ends_with(&format!(".{name}"))).map(whole).collect();
    let all: Vec<String> = known.iter().map(whole).collect();
    let shorter = known.iter().map(|(_, name)| name.as_str());
    let meant = closest(&limit.path, named.iter().map(String::as_str))
        .or_else(|| named.first().map(String::as_str))
        .or_else(|| closest(&limit.path, all.iter().map(String::as_str).chain(shorter)));
    let hint = meant.map(|name| format!("did you mean \"{name}\"? ")).unwrap_or_default();
    let own: Vec<String> =
        known.iter().filter(|(node, _)| limit.path.starts_with(&format!("{node}."))).map(whole).collect();
    let listed = if own.is_empty() { all } else { own };
    let more = listed.len().saturating_sub(NAMES);
    let more = if more > 0 { format!(" and {more} more (maquette nodes KIND)") } else { String::new() };
    let names = if listed.is_empty() { "none".to_owned() } else { listed[..listed.len().min(NAMES)].join(", ") };
    format!("{hint}known figures: {names}{more}")
}

/// Holds all limits against what an evaluation measured and warned of. `warnings` are those of the file.
pub(super) fn judge(limits: &[Limit], evaluation: &Evaluation, warnings: &[String]) -> Verdict {
    let reports: Vec<(&str, &Report)> = evaluation
        .outcomes()
        .filter_map(|(_, outcome)| match &outcome.state {
            OutcomeState::Done { report, .. } => Some((outcome.name.as_str(), &**report)),
            _ => None,
        })
        .collect();
    let mut verdict = Verdict::default();
    for limit in limits {
        let mut judge = Judge { limit, verdict: &mut verdict, measured: false };
        if limit.path == WARNINGS {
            judge.warnings(None, warnings);
        }
        for (node, report) in &reports {
            judge.report(node, report);
        }
        // A node that failed might have measured what is asked for.
        if !judge.measured && evaluation.is_complete() {
            let message = "no node measured that in this run; see what --report lists";
            verdict.unknown.push(format!("error: --fail-if '{limit}': {message}"));
        }
    }
    verdict
}

struct Judge<'a> {
    limit: &'a Limit,
    verdict: &'a mut Verdict,
    /// Whether there was anything to hold the limit against.
    measured: bool,
}

impl Judge<'_> {
    fn exceeded(&mut self, place: &str, name: &str, value: f64, unit: Unit) {
        let unit = if unit == Unit::None { String::new() } else { format!(" {unit}") };
        let limit = self.limit;
        self.verdict.exceeded.push(format!("error: {place}: {name} is {value}{unit}; it fails '{limit}'"));
    }

    fn report(&mut self, node: &str, report: &Report) {
        let place = format!("node {node:?}");
        if self.limit.is_about(node, WARNINGS) {
            self.warnings(Some(node), &report.warnings);
        }
        for figure in report.figures.iter().filter(|figure| self.limit.is_about(node, &figure.name)) {
            self.measured = true;
            if self.limit.fails(figure.value) {
                self.exceeded(&place, &figure.name, figure.value, figure.unit);
            }
        }
        for table in &report.tables {
            for (index, column) in table.columns.iter().enumerate() {
                if self.limit.is_about(node, &format!("{}.{}", table.name, column.name)) {
                    self.measured = true;
                    self.column(&place, table, index);
                }
            }
        }
    }

    fn warnings(&mut self, node: Option<&str>, warnings: &[String]) {
        self.measured = true;
        #[expect(clippy::cast_precision_loss, reason = "a count of warnings")]
        let count = warnings.len() as f64;
        if !self.limit.fails(count) {
            return;
        }
        let place = node.map(|node| format!("node {node:?}: ")).unwrap_or_default();
        let limit = self.limit;
        if warnings.is_empty() && node.is_some() {
            self.verdict.exceeded.push(format!("error: {place}warnings is 0; it fails '{limit}'"));
        }
        let failing = warnings.iter().map(|warning| format!("error: {place}{warning}; it fails '{limit}'"));
        self.verdict.exceeded.extend(failing);
    }

    fn column(&mut self, place: &str, table: &Table, column: usize) {
        let cells = || table.rows.iter().enumerate().filter_map(|(row, cells)| Some((row, cells.get(column)?)));
        let heading = &table.columns[column];
        if let Some(aggregate) = self.limit.aggregate {
            let number = |(_, cell): (usize, &Cell)| match cell {
                Cell::Number(number) => *number,
                // Words can be counted.
                Cell::Text(_) => f64::NAN,
            };
            let value = aggregate.of(&cells().map(number).collect::<Vec<_>>());
            if self.limit.fails(value) {
                let name = format!("{} of {}.{}", aggregate.name(), table.name, heading.name);
                self.exceeded(place, &name, value, heading.unit);
            }
            return;
        }
        let mut failing = 0;
        for (row, cell) in cells() {
            match cell {
                Cell::Number(number) if !self.limit.fails(*number) => {}
                Cell::Number(number) => {
                    failing += 1;
                    if failing <= ROWS {
                        let place = format!("{place}, {}", table.label(row));
                        self.exceeded(&place, &heading.name, *number, heading.unit);
                    }
                }
                Cell::Text(text) => {
                    let limit = self.limit;
                    let message = format!("{}.{} holds words such as {text:?}", table.name, heading.name);
                    self.verdict
                        .unknown
                        .push(format!("error: --fail-if '{limit}': {message}: limit a column of numbers"));
                    return;
                }
            }
        }
        if failing > ROWS {
            let (more, limit) = (failing - ROWS, self.limit);
            self.verdict.exceeded.push(format!("error: {place}: {more} more rows of {} fail '{limit}'", table.name));
        }
    }
}

#[cfg(test)]
mod tests;
