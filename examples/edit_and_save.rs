//! A saved graph loaded, edited in named steps, undone, redone, and saved.
//!
//! `cargo run --example edit_and_save`

use std::error::Error;
use std::io::Write;
use std::path::Path;

use maquette_graph::{Edit, Evaluator, EventLog, History, Literal, Request, file};

fn tell(out: &mut impl Write) -> Result<(), Box<dyn Error>> {
    let catalogue = maquette_nodes::catalogue()?;
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("graphs");
    let text = std::fs::read_to_string(folder.join("vest.ron"))?;
    let loaded = file::from_text(&catalogue, &text)?;
    writeln!(out, "loaded: {} nodes, {} problems", loaded.graph.nodes().len(), loaded.problems.len())?;
    let mut graph = loaded.graph;
    let mut evaluator = Evaluator::default();
    let log = EventLog::default();
    let results = graph.results();
    let request = Request::nodes(&results).base(&folder).events(&log);
    evaluator.evaluate(&catalogue, &graph, &request);
    writeln!(out, "evaluated: {} nodes ran", log.take_ran().len())?;

    // Edits are plain values; a history applies them and knows how to take them back.
    let surface = graph.find("surface").ok_or("the vest has a surface")?;
    let mut history = History::default();
    history.step(&mut graph, &catalogue, "finer rows", &[Edit::set(surface, "rows", Literal::Integer(3))])?;
    evaluator.evaluate(&catalogue, &graph, &request);
    writeln!(out, "after an edit: {}", log.take_ran().join(", "))?;

    history.undo(&mut graph, &catalogue)?;
    evaluator.evaluate(&catalogue, &graph, &request);
    writeln!(out, "after undo: {} ran", log.take_ran().len())?;
    writeln!(out, "saved as it was: {}", file::to_text(&graph) == text)?;

    history.redo(&mut graph, &catalogue)?;
    let saved = file::to_text(&graph);
    let changed: Vec<&str> = saved.lines().filter(|line| !text.lines().any(|before| before == *line)).collect();
    writeln!(out, "changed lines: {changed:?}")?;
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
            "loaded: 22 nodes, 0 problems\n\
             evaluated: 22 nodes ran\n\
             after an edit: surface, vest\n\
             after undo: 0 ran\n\
             saved as it was: true\n\
             changed lines: [\"                \\\"rows\\\": 3,\"]\n"
        );
        Ok(())
    }
}
