//! Evaluates the variants one after the other, with one memory of results.

use std::collections::BTreeSet;
use std::path::PathBuf;

use maquette_geometry::scene::Scene;
use maquette_graph::{CancelToken, ContentHasher, Evaluation, Evaluator, Request};

use super::Arguments;
use super::plan::Plan;
use super::record::Record;
use super::row::{FileRow, Row, State};
use crate::commands::evaluation::{evaluator, messages};
use crate::commands::fail_if::{self, Verdict};
use crate::commands::progress_bar::Variants as Bar;
use crate::commands::{console, write};
use maquette_nodes::results;

/// A wedge at work.
pub(super) struct Runner<'a> {
    arguments: &'a Arguments,
    pub(super) plan: Plan,
    evaluator: Evaluator,
    /// Which value of each axis is in the graph now.
    current: Vec<Option<usize>>,
    cancel: &'a CancelToken,
    record: Option<Record>,
    /// What went wrong beside the variants.
    pub(super) errors: Vec<String>,
    /// Warnings that were said; the same ones in other variants are not.
    warned: BTreeSet<String>,
}

impl<'a> Runner<'a> {
    pub(super) fn new(arguments: &'a Arguments, plan: Plan, cancel: &'a CancelToken) -> Self {
        Self {
            arguments,
            current: vec![None; plan.variants.axes.len()],
            plan,
            evaluator: evaluator(&arguments.evaluation),
            cancel,
            record: None,
            errors: Vec::new(),
            warned: BTreeSet::new(),
        }
    }

    /// Evaluates and writes all variants that are not finished; what is wrong with the arguments is an error.
    pub(super) fn run(&mut self) -> Result<Vec<Row>, Vec<String>> {
        let count = self.plan.variants.len();
        let keys = match self.plan.record.clone() {
            Some(path) => self.open_record(path)?,
            None => Vec::new(),
        };
        let mut rows: Vec<Row> =
            (0..count).map(|variant| Row::unreached(variant + 1, self.plan.texts(variant), State::Stopped)).collect();
        let bar = Bar::new(!self.arguments.evaluation.quiet, count);
        for variant in self.plan.variants.cheapest_order(&self.plan.costs()) {
            if self.cancel.is_cancelled() {
                break;
            }
            let key = keys.get(variant);
            if let Some((record, key)) = self.record.as_ref().zip(key)
                && let Some(row) = record.finished(key)
            {
                rows[variant] = Row { index: variant + 1, values: self.plan.texts(variant), ..row };
                bar.advance();
                continue;
            }
            bar.begin(|| self.plan.variants.describe(variant));
            let evaluation = self.evaluate(variant)?;
            if evaluation.cancelled {
                break;
            }
            let row = &mut rows[variant];
            self.judge(&evaluation, row);
            if row.state == State::Done || self.arguments.evaluation.keep_going {
                self.write(&evaluation, variant, row);
            }
            bar.aside(|| self.say(variant, row));
            if let Some((record, key)) = self.record.as_mut().zip(key)
                && row.state == State::Done
                && let Err(error) = record.add(key, row)
            {
                // Said once: the wedge goes on without a record.
                self.errors.push(error);
                self.record = None;
            }
            bar.advance();
        }
        bar.finish();
        Ok(rows)
    }

    fn open_record(&mut self, path: PathBuf) -> Result<Vec<String>, Vec<String>> {
        let keys = self.plan.keys(self.arguments);
        let known: BTreeSet<&str> = keys.iter().map(String::as_str).collect();
        let opened = write::make_folder_of(&path)
            .and_then(|()| Record::open(&path, self.arguments.fresh, &known, &self.plan.all_files()));
        self.record = Some(opened.map_err(|error| vec![format!("error: {error}")])?);
        Ok(keys)
    }

    /// Whether what is finished is remembered for the next call.
    pub(super) fn has_record(&self) -> bool {
        self.record.is_some()
    }

    /// The plan and what went wrong, when all is done.
    pub(super) fn finish(self) -> (Plan, Vec<String>) {
        (self.plan, self.errors)
    }

    /// Puts the values of a variant into the graph, as far as they are not there, and evaluates.
    fn evaluate(&mut self, variant: usize) -> Result<Evaluation, Vec<String>> {
        let Plan { variants, file, catalogue, targets, examine, .. } = &mut self.plan;
        for (axis, (choice, current)) in variants.choice(variant).zip(&mut self.current).enumerate() {
            if *current != Some(choice) {
                let axis = &variants.axes[axis];
                // Each value was tried when it was read.
                axis.place
                    .set(&mut file.loaded.graph, axis.values[choice].literal.clone())
                    .map_err(|error| vec![format!("error: --vary {}: {error}", axis.address)])?;
                *current = Some(choice);
            }
        }
        // All that results depend on is asked for: what is remembered from the variant before has figures too.
        let asked = file.loaded.graph.upstream(targets);
        let request = Request::nodes(&asked).base(file.base()).project(&file.project).cancel(self.cancel);
        let request = if *examine { request.examine() } else { request };
        Ok(self.evaluator.evaluate(catalogue, &file.loaded.graph, &request))
    }

    /// The results of a variant, from what is remembered or computed again; `None` where the wedge was stopped.
    pub(super) fn scene(&mut self, variant: usize) -> Result<Option<Scene>, String> {
        let evaluation = self.evaluate(variant).map_err(|messages| messages.join("\n"))?;
        Ok((!evaluation.cancelled).then(|| results::scene(&evaluation, &self.plan.targets)))
    }

    /// Measures an evaluation and says how it ended. A limit that there is nothing to hold against is not kept.
    fn judge(&self, evaluation: &Evaluation, row: &mut Row) {
        let Plan { file, targets, limits, file_warnings, .. } = &self.plan;
        row.measure(evaluation, targets);
        let (failures, warnings) = messages(file, targets, evaluation);
        let Verdict { exceeded, unknown } = fail_if::judge(limits, evaluation, file_warnings);
        let exceeded: Vec<String> = exceeded.into_iter().chain(unknown).collect();
        row.state = match (failures.is_empty(), exceeded.is_empty()) {
            (false, _) => State::Failed,
            (true, false) => State::Exceeded,
            (true, true) => State::Done,
        };
        row.warnings = warnings;
        row.errors = failures;
        let path = file.path.display();
        row.errors.extend(exceeded.iter().map(|message| format!("{path}: {message}")));
    }

    fn write(&self, evaluation: &Evaluation, variant: usize, row: &mut Row) {
        if self.plan.patterns.is_empty() {
            return;
        }
        let scene = results::scene(evaluation, &self.plan.targets);
        for (path, pattern) in self.plan.files(variant) {
            let written = write::make_folder_of(&path).and_then(|()| {
                let files = write::encoded(&path, pattern.format, &scene)?;
                files.into_iter().try_for_each(|(path, bytes)| {
                    write::whole(&path, &bytes)?;
                    let hash = ContentHasher::of_bytes(&bytes).to_string();
                    row.files.push(FileRow { path: path.display().to_string(), bytes: bytes.len(), hash });
                    Ok(())
                })
            });
            if let Err(error) = written {
                row.errors.push(format!("error: {error}"));
                if row.state == State::Done {
                    row.state = State::NotWritten;
                }
            }
        }
    }

    /// Says what is wrong with a variant, and what deserves a look.
    fn say(&mut self, variant: usize, row: &Row) {
        let which = || format!("{}: {}", variant + 1, self.plan.variants.describe(variant));
        row.errors.iter().for_each(|error| console::remark(format!("{error} (variant {})", which())));
        if self.arguments.evaluation.quiet {
            return;
        }
        for warning in &row.warnings {
            if !self.warned.contains(warning) {
                console::remark(format!("{warning} (first in variant {})", which()));
                self.warned.insert(warning.clone());
            }
        }
    }
}
