//! A wire type and two node kinds of one's own, a graph built in Rust, evaluated, followed by events, and stopped.
//!
//! `cargo run -p maquette-graph --example declare_and_evaluate`

use std::error::Error;
use std::io::Write;
use std::time::Duration;

use maquette_graph::{
    CancelToken, Catalogue, ContentHasher, Evaluator, Event, EventKind, EventLog, Graph, Literal, NodeKind,
    OutcomeState, Request, Unit, Wire,
};

/// What travels along our wires: heights above the sea, metres.
#[derive(Clone, Debug, PartialEq)]
struct Heights(Vec<f64>);

impl Wire for Heights {
    const NAME: &'static str = "heights";
    const DESCRIPTION: &'static str = "Heights above the sea, metres.";

    // All that makes two values different: equal hashes are taken for equal values.
    fn hash_content(&self, hasher: &mut ContentHasher) {
        hasher.numbers(&self.0);
    }

    fn byte_size(&self) -> usize {
        size_of_val(self.0.as_slice())
    }

    fn summary(&self) -> String {
        format!("{} heights", self.0.len())
    }
}

/// Ports are declared through handles that know their type: reading a wrong one does not compile.
fn hills() -> NodeKind {
    let mut node = NodeKind::declare("hills", 1, "terrain", "A row of hills.");
    let count = node.integer("count", 8, 1..=1_000_000, "How many heights.");
    let steepness = node.number("steepness", 1.0, 0.0..=100.0, "How steep the hills are.");
    let heights = node.output::<Heights>("heights", "The hills.");
    node.evaluate(move |ports| {
        let (count, steepness) = (ports.count(count), ports.value(steepness));
        let mut row = Vec::with_capacity(count);
        for k in 0..count {
            // Work that may take long says how far it is, and asks whether to go on.
            if k % 1024 == 0 {
                ports.progress(k as f64 / count as f64)?;
            }
            row.push(steepness * (k as f64 * 0.7).sin().abs());
        }
        ports.write(heights, Heights(row));
        Ok(())
    });
    node
}

/// A result of the graph, with a figure that is documented and can gate a build.
fn summit() -> NodeKind {
    let mut node = NodeKind::declare("summit", 1, "terrain", "The highest of some heights.");
    node.is_result();
    let heights = node.input::<Heights>("heights", "Where to look.");
    let top = node.output::<f64>("height", "The highest, metres.");
    let mean = node.figure("mean", Unit::Length, "Mean of all heights.");
    node.evaluate(move |ports| {
        let row = &ports.read(heights).0;
        ports.figure(mean, row.iter().sum::<f64>() / row.len() as f64);
        ports.write(top, row.iter().copied().fold(f64::NEG_INFINITY, f64::max));
        Ok(())
    });
    node
}

fn tell(out: &mut impl Write) -> Result<(), Box<dyn Error>> {
    let mut catalogue = Catalogue::new();
    catalogue.register(hills())?;
    catalogue.register(summit())?;

    let mut graph = Graph::new();
    let hills = graph.add(&catalogue, "hills", "hills")?;
    let summit = graph.add(&catalogue, "summit", "summit")?;
    graph.connect(&catalogue, hills, "heights", summit, "heights")?;
    graph.set(hills, "steepness", Literal::Number(3.0))?;

    // An evaluator remembers results from one evaluation to the next.
    let mut evaluator = Evaluator::default();
    let log = EventLog::default();
    let evaluation = evaluator.evaluate(&catalogue, &graph, &Request::nodes(&[summit]).events(&log));
    writeln!(out, "height: {:.3?}", evaluation.value::<f64>(summit, "height"))?;
    if let Some(OutcomeState::Done { report, .. }) = evaluation.outcome(summit).map(|outcome| &outcome.state) {
        for figure in &report.figures {
            writeln!(out, "{}: {:.3} {}", figure.name, figure.value, figure.unit)?;
        }
    }
    writeln!(out, "events: {}", log.take().join(", "))?;

    // What changed runs again, and what depends on it; an undone change runs nothing.
    graph.set(hills, "steepness", Literal::Number(4.0))?;
    evaluator.evaluate(&catalogue, &graph, &Request::nodes(&[summit]).events(&log));
    writeln!(out, "after a change: {}", log.take_ran().join(", "))?;
    graph.set(hills, "steepness", Literal::Number(3.0))?;
    let undone = evaluator.evaluate(&catalogue, &graph, &Request::nodes(&[summit]));
    writeln!(out, "after undoing it: {} run", undone.run_count())?;

    // Events come as things happen, from the threads that run the nodes; here one stops the evaluation. From another
    // thread, a clone of the token does.
    graph.set(hills, "count", Literal::Integer(1_000_000))?;
    let cancel = CancelToken::new();
    let token = cancel.clone();
    let stop_halfway = move |event: &Event<'_>| {
        if matches!(event.kind, EventKind::Progress(done) if done > 0.5) {
            token.cancel();
        }
    };
    let request = Request::nodes(&[summit]).events(&stop_halfway).cancel(&cancel);
    let stopped = evaluator.evaluate(&catalogue, &graph, &request);
    writeln!(out, "cancelled: {}, failures: {}", stopped.cancelled, stopped.failures().count())?;
    // Nothing half done was kept: the same request completes.
    let whole = evaluator.evaluate(&catalogue, &graph, &Request::nodes(&[summit]));
    writeln!(
        out,
        "then: complete {}, in less than a minute {}",
        whole.is_complete(),
        whole.duration < Duration::from_secs(60)
    )?;
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    tell(&mut std::io::stdout())
}

#[cfg(test)]
mod tests {
    #[test]
    fn it_tells_what_it_promises() -> Result<(), Box<dyn std::error::Error>> {
        let mut said = Vec::new();
        super::tell(&mut said)?;
        assert_eq!(
            String::from_utf8(said)?,
            "height: Some(2.956)\n\
             mean: 1.887 m\n\
             events: planned 2, started hills, progress hills 0%, finished hills, started summit, finished summit\n\
             after a change: hills, summit\n\
             after undoing it: 0 run\n\
             cancelled: true, failures: 0\n\
             then: complete true, in less than a minute true\n"
        );
        Ok(())
    }
}
