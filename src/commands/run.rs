//! `maquette run`: evaluates a graph and writes its results.

use std::path::{Path, PathBuf};
use std::time::Duration;

use glam::DVec3;
use maquette_geometry::file_format::FileFormat;
use maquette_geometry::mesh::measure::points_bounds;
use maquette_geometry::scene::Scene;
use maquette_graph::{CancelToken, Catalogue, Evaluator, Outcome, OutcomeState};
use serde_json::{Value as Json, json};

use super::evaluation::{Evaluated, EvaluationArguments, Keep, Opened, evaluator, open};
use super::fail_if::{self, Limit};
use super::graph_file::GraphFile;
use super::hashes::{self, Hashes};
use super::{Ended, console, report_text, watch, write};
use maquette_nodes::results;

/// Evaluate a graph and write its results.
#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    evaluation: EvaluationArguments,
    /// Write the results to this file: .glb, .gltf, .obj, .ply (meshes), .json (curves); may be given several times.
    #[arg(short = 'o', long = "write", value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Make the folders of the files that are written where they are not there.
    #[arg(long)]
    create_folders: bool,
    /// Say what was done as JSON on stdout.
    #[arg(long)]
    json: bool,
    /// Say what the nodes noted and measured, and look for faults in the meshes of the results.
    #[arg(long)]
    report: bool,
    /// Fail where what a node measured is beyond this limit: 'NODE.figure > 0.01', 'NODE.table.column > 0.01' for each
    /// row, 'max(table.column) > 1' (or min, mean, sum, count); without NODE, any node's. 'warnings' fails on any warning.
    /// May be given several times. --report and maquette nodes KIND list what is measured.
    #[arg(long, value_name = "LIMIT")]
    fail_if: Vec<String>,
    /// Write the content hash of each node's outputs to this file (.ron), or to stdout; see maquette verify.
    #[arg(long, value_name = "FILE", num_args = 0..=1, default_missing_value = "-")]
    hashes: Option<PathBuf>,
    /// Evaluate again whenever the graph or a file it names changes, until Ctrl-C, SIGTERM, or the end of stdin where
    /// that is a terminal or a pipe. Only what changed runs again; a graph that is wrong for the moment is waited for.
    #[arg(long)]
    pub(super) watch: bool,
}

/// How many names of nodes fit a line.
const NAMES: usize = 8;

/// Carries out the command.
pub fn run(arguments: &Arguments) -> Ended {
    let mut runner = match Runner::new(arguments) {
        Ok(runner) => runner,
        Err(messages) => return refuse(arguments, &messages),
    };
    if arguments.watch {
        return watch::watch(&mut runner, &arguments.evaluation.graph);
    }
    match runner.open() {
        Ok(opened) => runner.pass(opened),
        Err(messages) => refuse(arguments, &messages),
    }
}

/// Says what is wrong with graph or arguments.
fn refuse(arguments: &Arguments, messages: &[String]) -> Ended {
    messages.iter().for_each(console::remark);
    if arguments.json {
        let graph = arguments.evaluation.graph.display().to_string();
        console::say(json!({ "graph": graph, "ok": false, "errors": messages }).to_string());
    }
    Ended::Wrong
}

/// What one evaluation leaves for the next.
pub(super) struct Runner<'a> {
    pub(super) arguments: &'a Arguments,
    catalogue: Catalogue,
    formats: Vec<FileFormat>,
    limits: Vec<Limit>,
    evaluator: Evaluator,
    pub(super) cancel: CancelToken,
}

impl<'a> Runner<'a> {
    /// Reads the arguments; all that is wrong with them is an error.
    fn new(arguments: &'a Arguments) -> Result<Self, Vec<String>> {
        let catalogue = maquette_nodes::catalogue().map_err(|error| vec![format!("error: {error}")])?;
        let mut wrong = Vec::new();
        let formats = arguments.files.iter().map(|path| write::format(path));
        let formats = formats.filter_map(|format| format.map_err(|e| wrong.push(format!("error: {e}"))).ok()).collect();
        let limits = arguments.fail_if.iter().map(|text| Limit::parse(text));
        let limits = limits.filter_map(|limit| limit.map_err(|e| wrong.push(format!("error: {e}"))).ok()).collect();
        if arguments.json && arguments.hashes.as_deref() == Some(Path::new("-")) {
            wrong.push("error: --json and --hashes both write to stdout: give --hashes a file".to_owned());
        }
        wrong.extend(arguments.hashes.as_deref().and_then(|path| hashes::check_place(path).err()));
        if !wrong.is_empty() {
            return Err(wrong);
        }
        let evaluator = evaluator(&arguments.evaluation);
        Ok(Self { arguments, catalogue, formats, limits, evaluator, cancel: CancelToken::new() })
    }

    /// Reads the graph.
    pub(super) fn open(&self) -> Result<Opened, Vec<String>> {
        let files = self.arguments.files.iter().map(PathBuf::as_path);
        let files: Vec<_> = files.zip(self.formats.iter().copied()).collect();
        let mut opened = open(&self.catalogue, &self.arguments.evaluation, |types| write::suits(&files, types))?;
        let unknown = fail_if::refuse_unknown(&self.limits, &opened.file.loaded.graph, &opened.targets);
        opened.examine = self.arguments.report || !self.limits.is_empty();
        if unknown.is_empty() { Ok(opened) } else { Err(unknown) }
    }

    /// The files that the graph is made of and names, whatever is wrong with it.
    pub(super) fn files(&self) -> Vec<PathBuf> {
        let file =
            GraphFile::open(&self.catalogue, &self.arguments.evaluation.graph, &self.arguments.evaluation.project);
        file.map(|file| file.files()).unwrap_or_default()
    }

    /// Says what is wrong with the graph.
    pub(super) fn refuse(&self, messages: &[String]) -> Ended {
        refuse(self.arguments, messages)
    }

    /// The files that are written.
    pub(super) fn written_files(&self) -> impl Iterator<Item = &Path> {
        self.arguments.files.iter().chain(&self.arguments.hashes).map(PathBuf::as_path)
    }

    /// Evaluates once, writes what is to be written, and says so.
    pub(super) fn pass(&mut self, opened: Opened) -> Ended {
        let arguments = self.arguments;
        let keep = if arguments.hashes.is_some() { Keep::Everything } else { Keep::Results };
        let quiet = arguments.evaluation.quiet;
        let mut evaluated = opened.evaluate(&self.catalogue, &mut self.evaluator, quiet, keep, &self.cancel);
        if self.cancel.is_cancelled() {
            return Ended::Done;
        }
        let verdict = fail_if::judge(&self.limits, &evaluated.evaluation, &evaluated.file_warnings);
        if !verdict.unknown.is_empty() {
            return self.refuse(&verdict.unknown);
        }
        let path = evaluated.file.path.display();
        let exceeded: Vec<String> = verdict.exceeded.iter().map(|message| format!("{path}: {message}")).collect();
        evaluated.failures.extend(exceeded);
        evaluated.failures.iter().for_each(console::remark);
        let scene = results::scene(&evaluated.evaluation, &evaluated.targets);
        let mut written = Vec::new();
        let mut errors = evaluated.failures.clone();
        let mut ended = if evaluated.failures.is_empty() { Ended::Done } else { Ended::Failed };
        if ended == Ended::Done || arguments.evaluation.keep_going {
            let mut keep = |result: Result<Vec<(PathBuf, usize)>, String>| match result {
                Ok(files) => written.extend(files),
                Err(error) => {
                    console::error(&error);
                    errors.push(format!("error: {error}"));
                    ended = if ended == Ended::Done { Ended::NotWritten } else { ended };
                }
            };
            for (path, format) in arguments.files.iter().zip(&self.formats) {
                let folder = if arguments.create_folders { write::make_folder_of(path) } else { Ok(()) };
                keep(folder.and_then(|()| write::scene(path, *format, &scene)));
            }
            if let Some(path) = arguments.hashes.as_deref().filter(|path| *path != Path::new("-")) {
                let text = Hashes::of(&evaluated).to_text();
                keep(write::whole(path, text.as_bytes()).map(|()| vec![(path.to_owned(), text.len())]));
            }
        } else if self.written_files().next().is_some() {
            console::remark(
                "nothing was written, because a node failed or a limit was exceeded; --keep-going writes what succeeded",
            );
        }
        if arguments.json {
            console::say(as_json(arguments, &evaluated, &scene, &written, &errors).to_string());
        } else if arguments.hashes.as_deref() == Some(Path::new("-")) {
            if ended == Ended::Done || arguments.evaluation.keep_going {
                console::say(Hashes::of(&evaluated).to_text().trim_end());
            }
        } else if arguments.watch && !arguments.report && !quiet {
            console::say(as_line(&evaluated, &written, ended));
        } else if !quiet {
            as_text(arguments, &evaluated, &scene, &written);
        }
        ended
    }
}

/// What was done, on one line.
fn as_line(evaluated: &Evaluated, written: &[(PathBuf, usize)], ended: Ended) -> String {
    let evaluation = &evaluated.evaluation;
    let ran: Vec<&str> = evaluation.outcomes().filter(|(_, o)| o.ran).map(|(_, o)| o.name.as_str()).collect();
    let more = if ran.len() > NAMES { format!(", {} more", ran.len() - NAMES) } else { String::new() };
    let names = ran.iter().take(NAMES).copied().collect::<Vec<_>>().join(", ");
    let names = if ran.is_empty() { String::new() } else { format!(" ({names}{more})") };
    let files: String = written.iter().map(|(path, _)| format!(", wrote {}", path.display())).collect();
    let path = evaluated.file.path.display();
    let (hits, time) = (evaluation.hit_count(), milliseconds(evaluation.duration));
    let failed = if ended == Ended::Done { "" } else { ", failed" };
    format!("{path}: ran {}{names}, {hits} hits, {time}{files}{failed}", ran.len())
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
            report_text::lines(report).iter().for_each(|line| console::say(format!("      {line}")));
        }
    }
    for item in &scene.meshes {
        let (vertices, faces) = (item.mesh.positions().len(), item.mesh.polygon_count());
        console::say(format!("result {}: {vertices} vertices, {faces} faces", item.name));
    }
    for item in &scene.curves {
        let points: usize = item.curves.iter().map(|c| c.points().len()).sum();
        console::say(format!("result {}: {} curves, {points} points", item.name, item.curves.len()));
    }
    for (path, bytes) in written {
        console::say(format!("wrote {} ({bytes} bytes)", path.display()));
    }
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

fn node_json(outcome: &Outcome) -> Json {
    let mut node = json!({
        "name": outcome.name,
        "kind": outcome.kind,
        "ran": outcome.ran,
        "seconds": outcome.duration.as_secs_f64(),
    });
    let details = match &outcome.state {
        OutcomeState::Done { report, .. } => {
            let mut details = report_text::as_json(report);
            details["state"] = json!("done");
            details
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
    match points_bounds(points.iter().copied()) {
        Some((low, high)) => json!({ "min": low.to_array(), "max": high.to_array() }),
        None => Json::Null,
    }
}
