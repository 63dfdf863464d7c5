//! One node tested alone: inputs by name, outputs by name, report, progress, stop, failures.
//!
//! `cargo run -p maquette-graph --example test_a_node`

use std::error::Error;
use std::io::Write;

use maquette_graph::harness::Harness;
use maquette_graph::{AtPort, Literal, NodeKind, Unit};

fn divide() -> NodeKind {
    let mut node = NodeKind::declare("divide", 1, "numbers", "Divides a number, step by step.");
    let number = node.number("number", 1.0, -1e9..=1e9, "What is divided.");
    let by = node.number("by", 2.0, -1e9..=1e9, "By what.");
    let steps = node.integer("steps", 4, 1..=64, "How often.");
    let quotient = node.output::<f64>("quotient", "What is left.");
    let halving = node.table("steps", &[("step", Unit::None), ("left", Unit::None)], "What is left after each step.");
    node.evaluate(move |ports| {
        if ports.value(by) == 0.0 {
            return Err("nothing can be divided by zero: give another number").at(by);
        }
        let mut left = ports.value(number);
        let mut rows = Vec::new();
        for step in 0..ports.count(steps) {
            ports.progress(step as f64 / ports.count(steps) as f64)?;
            left /= ports.value(by);
            rows.push(vec![step.into(), left.into()]);
        }
        if left.abs() < 0.1 {
            ports.warn("little is left: divide less often");
        }
        ports.table(halving, rows);
        ports.write(quotient, left);
        Ok(())
    });
    node
}

fn tell(out: &mut impl Write) -> Result<(), Box<dyn Error>> {
    let kind = divide();
    let trial = Harness::new(&kind).set("number", Literal::Number(40.0)).run()?;
    writeln!(out, "quotient: {:?}", trial.value::<f64>("quotient"))?;
    writeln!(out, "progress: {:?}", trial.progress)?;
    writeln!(out, "rows: {:?}", trial.report.table("steps").map(|table| table.rows.len()))?;

    let small = Harness::new(&kind).run()?;
    writeln!(out, "warnings: {}", small.report.warnings.join("; "))?;

    for (input, literal) in [("by", Literal::Number(0.0)), ("steps", Literal::Integer(100))] {
        let refused = Harness::new(&kind).set(input, literal).run();
        writeln!(out, "refused: {}", refused.err().map(|error| error.to_string()).unwrap_or_default())?;
    }

    // The callback that a cancelled evaluation answers.
    let stopped = Harness::new(&kind).while_progress(|done| done < 0.5).run();
    writeln!(out, "stopped: {}", stopped.is_err_and(|error| error.is_cancelled()))?;
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
            "quotient: Some(2.5)\n\
             progress: [0.0, 0.25, 0.5, 0.75]\n\
             rows: Some(4)\n\
             warnings: little is left: divide less often\n\
             refused: input \"by\": nothing can be divided by zero: give another number\n\
             refused: input \"steps\": 100 is out of range: give 1 to 64\n\
             stopped: true\n"
        );
        Ok(())
    }
}
