//! `maquette wedge`: evaluates a graph for many combinations of values in one process.

mod openjd;
mod pattern;
mod plan;
mod record;
mod row;
mod runner;
mod sheet;
mod table;
mod values;
mod variants;

use std::path::{Path, PathBuf};
use std::time::Instant;

use maquette_graph::CancelToken;
use serde_json::json;

use self::plan::Plan;
use self::row::{Row, State};
use self::runner::Runner;
use self::table::Table;
use super::evaluation::EvaluationArguments;
use super::render::{ViewName, size};
use super::{Ended, console, watch, write};

/// Evaluate a graph for all combinations of values: files, a table and a sheet of pictures of what comes out.
///
/// Only what differs between the variants is computed. A wedge that was stopped is continued by the same command.
#[derive(clap::Args)]
pub struct Arguments {
    #[command(flatten)]
    evaluation: EvaluationArguments,
    /// Vary a value: NODE.PORT=0.8,1,1.2 (a list), =0.1..10:7 (seven numbers in equal steps), =0.1..10:7:log (in equal
    /// ratios), =2..5 (whole numbers), =* (every option); brackets around vectors and colours, (0,1,0),(0,2,0). All
    /// combinations of several --vary are made; the last varies fastest.
    #[arg(long, value_name = "ADDRESS=VALUES", required = true)]
    vary: Vec<String>,
    /// Vary these addresses together, the first values with the first, in place of combining them; without a list, all.
    #[arg(
        long,
        value_name = "ADDRESS,ADDRESS",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "*",
        conflicts_with = "samples"
    )]
    zip: Vec<String>,
    /// Take this many samples, spread evenly over all values and ranges (=0.1..10, =0.1..10:log), in place of all
    /// combinations. More samples of the same seed only add to those that are there.
    #[arg(long, value_name = "N")]
    samples: Option<u32>,
    /// Another seed gives other samples.
    #[arg(long, value_name = "N", default_value_t = 0, requires = "samples")]
    seed: u32,
    /// Write the results of each variant to a file: 'out/{legs.height}-{index}.glb', with the addresses that are varied
    /// and the number of the variant; may be given several times. Folders are made.
    #[arg(short = 'o', long = "write", value_name = "PATTERN")]
    files: Vec<String>,
    /// Write the table of what came out to this file, .csv, .json or .txt; may be given several times.
    #[arg(long, value_name = "FILE")]
    table: Vec<PathBuf>,
    /// Draw a sheet with a small picture of each variant, a .png file.
    #[arg(long, value_name = "FILE")]
    sheet: Option<PathBuf>,
    /// Width and height of each picture of the sheet, pixels.
    #[arg(long, default_value = "280x320", value_name = "WxH", value_parser = size)]
    tile: (u32, u32),
    /// From where the pictures of the sheet are seen.
    #[arg(long, value_enum, default_value_t = ViewName::ThreeQuarter)]
    view: ViewName,
    /// A variant fails where what a node measured is beyond this limit, written as for maquette run: 'NODE.figure > 0.01',
    /// 'max(table.column) > 1', 'warnings'; may be given several times. The others go on; the exit code is 1.
    #[arg(long, value_name = "LIMIT")]
    fail_if: Vec<String>,
    /// Measure as well what is measured on request only: faults in the meshes of the results.
    #[arg(long)]
    report: bool,
    /// Keep the record of what is finished in this file. Without it, it is wedge.jsonl in the folder of the first
    /// --write, and none is kept where nothing is written.
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Keep no record.
    #[arg(long, conflicts_with_all = ["record", "fresh"])]
    no_record: bool,
    /// Do everything again, whatever the record says is finished.
    #[arg(long)]
    fresh: bool,
    /// Say what was done as JSON on stdout.
    #[arg(long)]
    json: bool,
    /// Only list the variants and their files.
    #[arg(long)]
    dry_run: bool,
    /// More than 100,000 variants are meant.
    #[arg(long)]
    many: bool,
    /// Evaluate nothing; write the wedge as an Open Job Description template for render farms, .json or .yaml, in which
    /// each variant is a task that runs maquette run.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["table", "sheet", "json", "dry_run", "record", "fresh"])]
    openjd: Option<PathBuf>,
}

/// Carries out the command; Ctrl-C ends it cleanly.
pub fn wedge(arguments: &Arguments) -> Ended {
    let cancel = CancelToken::new();
    if let Err(error) = watch::stop_on_signals(&cancel) {
        console::error(format!("Ctrl-C can't be listened for: {error}"));
        return Ended::Wrong;
    }
    wedge_until(arguments, &cancel)
}

/// Carries out the command until it is cancelled: what is finished by then is kept.
pub fn wedge_until(arguments: &Arguments, cancel: &CancelToken) -> Ended {
    let begun = Instant::now();
    let plan = match Plan::new(arguments) {
        Ok(plan) => plan,
        Err(messages) => return refuse(arguments, &messages),
    };
    let quiet = arguments.evaluation.quiet;
    if !quiet {
        plan.warnings.iter().for_each(console::remark);
    }
    if let Some(path) = &arguments.openjd {
        return match openjd::template(arguments, &plan, path) {
            Ok(bytes) => say_written(path, &bytes, quiet),
            Err(message) => refuse(arguments, &[message]),
        };
    }
    if arguments.dry_run {
        let rows: Vec<Row> = (0..plan.variants.len()).map(|variant| plan.listed(variant)).collect();
        say(arguments, &plan.table(&rows, begun, &[]));
        return Ended::Done;
    }
    let mut runner = Runner::new(arguments, plan, cancel);
    let rows = match runner.run() {
        Ok(rows) => rows,
        Err(messages) => return refuse(arguments, &messages),
    };
    let drawn = match &arguments.sheet {
        Some(path) if !cancel.is_cancelled() => match sheet::draw(arguments, &mut runner, &rows) {
            Ok(picture) => picture.map(|bytes| (path, bytes)),
            Err(message) => {
                runner.errors.push(message);
                None
            }
        },
        _ => None,
    };
    let undrawn = arguments.sheet.is_some() && drawn.is_none() && cancel.is_cancelled();
    if undrawn || rows.iter().any(|row| row.state == State::Stopped) {
        let finished = rows.iter().filter(|row| matches!(row.state, State::Done | State::Kept)).count();
        let more = if runner.has_record() { "; the same command continues" } else { "" };
        console::remark(format!("stopped: {finished} of {} variants are finished{more}", rows.len()));
    }
    let mut written = Vec::new();
    let (plan, mut errors) = runner.finish();
    let tables = plan.tables.iter().map(|(path, form)| (path, plan.table(&rows, begun, &[]).to_bytes(*form)));
    for (path, bytes) in drawn.into_iter().map(|(path, bytes)| (path, Ok(bytes))).chain(tables) {
        match bytes.and_then(|bytes| put(path, &bytes).map(|()| bytes.len())) {
            Ok(bytes) => written.push((path, bytes)),
            Err(error) => errors.push(error),
        }
    }
    errors.iter().for_each(console::error);
    say(arguments, &plan.table(&rows, begun, &errors));
    if !quiet && !arguments.json {
        console::say(summary(&plan, &rows, begun));
        for (path, bytes) in &written {
            console::say(format!("wrote {} ({bytes} bytes)", path.display()));
        }
    }
    if undrawn { Ended::Failed } else { ended(&rows, &errors) }
}

fn ended(rows: &[Row], errors: &[String]) -> Ended {
    let any = |states: &[State]| rows.iter().any(|row| states.contains(&row.state));
    if any(&[State::Failed, State::Exceeded, State::Stopped]) {
        Ended::Failed
    } else if any(&[State::NotWritten]) || !errors.is_empty() {
        Ended::NotWritten
    } else {
        Ended::Done
    }
}

/// Writes a file, with its folder.
fn put(path: &Path, bytes: &[u8]) -> Result<(), String> {
    write::make_folder_of(path)?;
    write::whole(path, bytes)
}

fn say_written(path: &Path, bytes: &[u8], quiet: bool) -> Ended {
    match put(path, bytes) {
        Ok(()) if quiet => Ended::Done,
        Ok(()) => {
            console::say(format!("wrote {} ({} bytes)", path.display(), bytes.len()));
            Ended::Done
        }
        Err(error) => {
            console::error(error);
            Ended::NotWritten
        }
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

fn say(arguments: &Arguments, table: &Table<'_>) {
    if arguments.json {
        console::say(table.to_json().to_string());
    } else if !arguments.evaluation.quiet {
        console::say(table.to_text().trim_end());
    }
}

fn summary(plan: &Plan, rows: &[Row], begun: Instant) -> String {
    let states = [State::Done, State::Kept, State::Failed, State::Exceeded, State::NotWritten, State::Stopped];
    let counts = states.into_iter().map(|state| (state, rows.iter().filter(|row| row.state == state).count()));
    let counts: Vec<_> = counts.filter(|(_, n)| *n > 0).map(|(state, n)| format!("{n} {}", state.name())).collect();
    let now = || rows.iter().filter(|row| row.state != State::Kept);
    let (ran, hits): (usize, usize) = (now().map(|row| row.ran).sum(), now().map(|row| row.hits).sum());
    let seconds = begun.elapsed().as_secs_f64();
    let (path, counts) = (plan.file.path.display(), counts.join(", "));
    format!("{path}: {} variants: {counts}; {ran} nodes run, {hits} hits, {seconds:.2} s", rows.len())
}
