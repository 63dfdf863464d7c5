//! A limb from the outlines of two views: the graph is built in Rust, evaluated, measured, and written as OBJ.
//!
//! `cargo run --example limb_in_rust`

use std::error::Error;
use std::io::Write;

use maquette_geometry::file_format::obj;
use maquette_geometry::scene::{MeshItem, Scene};
use maquette_graph::{Catalogue, Evaluator, Graph, Literal, NodeId, OutcomeState, Request, Stroke, StrokePoint};
use maquette_nodes::wire;

/// Both outlines of a limb that gets thinner upwards, as a stylus would draw them.
fn outlines(half_width: f64) -> Literal {
    let outline = |name: &str, side: f64| {
        let at = |k: u32| {
            let t = f64::from(k) / 12.0;
            StrokePoint { x: side * half_width * (1.0 - 0.4 * t + 0.2 * (3.0 * t).sin()), y: 0.5 * t, pressure: None }
        };
        Stroke { name: name.to_owned(), closed: false, points: (0..=12).map(at).collect() }
    };
    Literal::Strokes(vec![outline("one side", 1.0), outline("other side", -1.0)])
}

fn build(catalogue: &Catalogue) -> Result<(Graph, NodeId), Box<dyn Error>> {
    let mut graph = Graph::new();
    let front = graph.add(catalogue, "sketch", "front view")?;
    graph.set(front, "strokes", outlines(0.06))?;
    let side = graph.add(catalogue, "sketch", "side view")?;
    graph.set(side, "strokes", outlines(0.08))?;
    graph.set(side, "plane", Literal::Choice("side".to_owned()))?;
    let join = graph.add(catalogue, "join", "outlines")?;
    graph.connect(catalogue, front, "curves", join, "a")?;
    graph.connect(catalogue, side, "curves", join, "b")?;
    // From here on one node follows the other.
    let mut last = (join, "curves");
    for (kind, input, output) in [
        ("resample", "curves", "curves"),
        ("sort", "curves", "rails"),
        ("detail-generator", "rails", "sections"),
        ("surface-from-cross-sections", "sections", "mesh"),
        ("mesh-out", "mesh", "result"),
    ] {
        let node = graph.add(catalogue, kind, kind)?;
        graph.connect(catalogue, last.0, last.1, node, input)?;
        last = (node, output);
    }
    Ok((graph, last.0))
}

fn tell(out: &mut impl Write) -> Result<(), Box<dyn Error>> {
    let catalogue = maquette_nodes::catalogue()?;
    let (graph, limb) = build(&catalogue)?;
    // `examine` asks for what costs too much for every evaluation: here, whether the mesh is sound.
    let request = Request::nodes(&[limb]).examine();
    let evaluation = Evaluator::default().evaluate(&catalogue, &graph, &request);
    for (outcome, failure) in evaluation.failures() {
        writeln!(out, "{}: {failure}", outcome.name)?;
    }
    if let Some(OutcomeState::Done { report, .. }) = evaluation.outcome(limb).map(|outcome| &outcome.state) {
        for name in ["faces", "holes", "faults"] {
            writeln!(out, "{name}: {:?}", report.figure(name).map(|figure| figure.value))?;
        }
    }
    let result = evaluation.value::<wire::MeshResult>(limb, "result").ok_or("the limb has a mesh")?;
    let mesh = (*result.mesh).clone();
    let item = MeshItem { name: "limb".to_owned(), mesh, material: result.material.clone() };
    let bytes = obj::write(&Scene { meshes: vec![item], ..Scene::default() }, None)?;
    let text = String::from_utf8(bytes)?;
    writeln!(out, "lines of OBJ with a face: {}", text.lines().filter(|line| line.starts_with("f ")).count())?;
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
            "faces: Some(6016.0)\n\
             holes: Some(2.0)\n\
             faults: Some(0.0)\n\
             lines of OBJ with a face: 6016\n"
        );
        Ok(())
    }
}
