//! `maquette run`: evaluates a graph and writes its results.

use std::path::PathBuf;
use std::time::Duration;

use glam::DVec3;
use maquette_geometry::file_format::FileFormat;
use maquette_geometry::mesh::{Mesh, check};
use maquette_geometry::scene::Scene;
use maquette_graph::{Outcome, OutcomeState};
use serde_json::{Value as Json, json};

use super::evaluation::{Evaluated, EvaluationArguments, evaluate};
use super::{Ended, console, results, write};

/// Evaluate a graph and write its results.
#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    evaluation: EvaluationArguments,
    /// Write the results to this file: .glb, .gltf, .obj, .ply (meshes), .json (curves); may be given several times.
    #[arg(short = 'o', long = "write", value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Say what was done as JSON on stdout.
    #[arg(long)]
    json: bool,
    /// Say what the nodes noted and measured.
    #[arg(long)]
    report: bool,
}

/// Carries out the command.
pub fn run(arguments: &Arguments) -> Ended {
    let refuse = |messages: Vec<String>| {
        messages.iter().for_each(console::remark);
        if arguments.json {
            let graph = arguments.evaluation.graph.display().to_string();
            console::say(json!({ "graph": graph, "ok": false, "errors": messages }).to_string());
        }
        Ended::Wrong
    };
    let catalogue = match maquette_nodes::catalogue() {
        Ok(catalogue) => catalogue,
        Err(error) => return refuse(vec![format!("error: {error}")]),
    };
    let formats: Result<Vec<FileFormat>, Vec<String>> = arguments
        .files
        .iter()
        .map(|path| write::format(path).map_err(|error| vec![format!("error: {error}")]))
        .collect();
    let evaluated = formats.and_then(|formats| {
        let files: Vec<_> = arguments.files.iter().map(PathBuf::as_path).zip(formats.iter().copied()).collect();
        let evaluated = evaluate(&catalogue, &arguments.evaluation, |types| write::suits(&files, types))?;
        Ok((formats, evaluated))
    });
    let (formats, evaluated) = match evaluated {
        Ok(evaluated) => evaluated,
        Err(messages) => return refuse(messages),
    };
    evaluated.failures.iter().for_each(console::remark);
    let scene = results::scene(&evaluated.evaluation, &evaluated.targets);
    let mut written = Vec::new();
    let mut errors = evaluated.failures.clone();
    let mut ended = if evaluated.failures.is_empty() { Ended::Done } else { Ended::NodeFailed };
    if ended == Ended::Done || arguments.evaluation.keep_going {
        for (path, format) in arguments.files.iter().zip(formats) {
            match write::scene(path, format, &scene) {
                Ok(files) => written.extend(files),
                Err(error) => {
                    console::error(&error);
                    errors.push(format!("error: {error}"));
                    ended = if ended == Ended::Done { Ended::NotWritten } else { ended };
                }
            }
        }
    } else if !arguments.files.is_empty() {
        console::remark("nothing was written, because a node failed; --keep-going writes what succeeded");
    }
    if arguments.json {
        console::say(as_json(arguments, &evaluated, &scene, &written, &errors).to_string());
    } else if !arguments.evaluation.quiet {
        as_text(arguments, &evaluated, &scene, &written);
    }
    ended
}

fn milliseconds(duration: Duration) -> String {
    format!("{:.2} ms", duration.as_secs_f64() * 1e3)
}

fn as_text(arguments: &Arguments, evaluated: &Evaluated, scene: &Scene, written: &[(PathBuf, usize)]) {
    let Evaluated { file, evaluation, .. } = evaluated;
    console::say(format!(
        "{}: {} nodes run, {} hits, {}",
        file.path.display(),
        evaluation.run_count(),
        evaluation.hit_count(),
        milliseconds(evaluation.duration)
    ));
    let widths = evaluation
        .outcomes()
        .fold((4, 4), |(name, kind), (_, o)| (name.max(o.name.chars().count()), kind.max(o.kind.chars().count())));
    for (_, outcome) in evaluation.outcomes() {
        console::say(format!(
            "  {:name$}  {:kind$}  {}",
            outcome.name,
            outcome.kind,
            state(outcome),
            name = widths.0,
            kind = widths.1
        ));
        if let OutcomeState::Done { report, .. } = &outcome.state
            && arguments.report
        {
            report.notes.iter().for_each(|note| console::say(format!("      {note}")));
            for figure in &report.figures {
                console::say(format!("      {}: {} {}", figure.name, digits(figure.value), figure.unit));
            }
        }
    }
    for item in &scene.meshes {
        let (vertices, faces) = (item.mesh.positions().len(), item.mesh.polygon_count());
        console::say(format!("result {}: {vertices} vertices, {faces} faces", item.name));
        if arguments.report {
            let found = check(&item.mesh);
            console::say(format!("      {found}; largest fold {:.1} degrees", found.largest_fold_degrees));
        }
    }
    for item in &scene.curves {
        let points: usize = item.curves.iter().map(|c| c.points().len()).sum();
        console::say(format!("result {}: {} curves, {points} points", item.name, item.curves.len()));
    }
    for (path, bytes) in written {
        console::say(format!("wrote {} ({bytes} bytes)", path.display()));
    }
}

/// Four digits are enough to read; `--json` has them all.
fn digits(value: f64) -> String {
    if value.abs() < 1e-12 {
        return "0".to_owned();
    }
    if (1e-3..1e6).contains(&value.abs()) {
        let decimals = (3.0 - value.abs().log10().floor()).max(0.0) as usize;
        return format!("{value:.decimals$}");
    }
    format!("{value:.3e}")
}

fn state(outcome: &Outcome) -> String {
    match (&outcome.state, outcome.ran) {
        (OutcomeState::Done { .. }, true) => milliseconds(outcome.duration),
        (OutcomeState::Done { .. }, false) => "hit".to_owned(),
        (OutcomeState::Failed(_), _) => "failed".to_owned(),
        (OutcomeState::Waiting(on), _) => format!("waits on {}", on.join(", ")),
        (OutcomeState::Cancelled, _) => "cancelled".to_owned(),
    }
}

fn as_json(
    arguments: &Arguments,
    evaluated: &Evaluated,
    scene: &Scene,
    written: &[(PathBuf, usize)],
    errors: &[String],
) -> Json {
    let Evaluated { file, evaluation, warnings, .. } = evaluated;
    let threads = match arguments.evaluation.threads {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        asked => usize::from(asked),
    };
    let nodes: Vec<Json> = evaluation.outcomes().map(|(_, outcome)| node_json(outcome)).collect();
    let meshes = scene.meshes.iter().map(|item| {
        json!({
            "name": item.name,
            "type": "mesh",
            "vertices": item.mesh.positions().len(),
            "faces": item.mesh.polygon_count(),
            "bounds": bounds(item.mesh.positions()),
            "check": arguments.report.then(|| check_json(&item.mesh)),
        })
    });
    let curves = scene.curves.iter().map(|item| {
        let points: Vec<DVec3> = item.curves.iter().flat_map(|c| c.points().iter().copied()).collect();
        json!({
            "name": item.name,
            "type": "curves",
            "curves": item.curves.len(),
            "points": points.len(),
            "bounds": bounds(&points),
        })
    });
    let files: Vec<Json> =
        written.iter().map(|(path, bytes)| json!({ "path": path.display().to_string(), "bytes": bytes })).collect();
    json!({
        "graph": file.path.display().to_string(),
        "ok": errors.is_empty(),
        "seconds": evaluation.duration.as_secs_f64(),
        "threads": threads,
        "ran": evaluation.run_count(),
        "hits": evaluation.hit_count(),
        "nodes": nodes,
        "results": meshes.chain(curves).collect::<Vec<_>>(),
        "files": files,
        "warnings": warnings,
        "errors": errors,
    })
}

/// What `--report` says of a mesh, as data.
fn check_json(mesh: &Mesh) -> Json {
    let found = check(mesh);
    json!({
        "sound": found.is_sound(),
        "closed": found.closed,
        "shells": found.shells,
        "boundary_loops": found.boundary_loops,
        "normals_outward": found.normals_outward,
        "largest_fold_degrees": found.largest_fold_degrees,
    })
}

fn node_json(outcome: &Outcome) -> Json {
    let mut node = json!({
        "name": outcome.name,
        "kind": outcome.kind,
        "ran": outcome.ran,
        "seconds": outcome.duration.as_secs_f64(),
    });
    let details = match &outcome.state {
        OutcomeState::Done { report, .. } => {
            let figures: Vec<Json> =
                report.figures.iter().map(|f| json!({ "name": f.name, "value": f.value, "unit": f.unit })).collect();
            json!({ "state": "done", "notes": report.notes, "warnings": report.warnings, "figures": figures })
        }
        OutcomeState::Failed(failure) => {
            json!({ "state": "failed", "error": { "port": failure.port, "message": failure.message } })
        }
        OutcomeState::Waiting(on) => json!({ "state": "waiting", "on": on }),
        OutcomeState::Cancelled => json!({ "state": "cancelled" }),
    };
    if let (Json::Object(node), Json::Object(details)) = (&mut node, details) {
        node.extend(details);
    }
    node
}

fn bounds(points: &[DVec3]) -> Json {
    match points.iter().fold(None, |bounds: Option<(DVec3, DVec3)>, p| {
        let (low, high) = bounds.unwrap_or((*p, *p));
        Some((low.min(*p), high.max(*p)))
    }) {
        Some((low, high)) => json!({ "min": low.to_array(), "max": high.to_array() }),
        None => Json::Null,
    }
}
