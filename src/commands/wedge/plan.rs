//! What a wedge is to do, read from its arguments: all that can be wrong is said before anything runs.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::time::Instant;

use maquette_graph::{Catalogue, ContentHasher, Literal, NodeId};

use super::Arguments;
use super::pattern::{Pattern, check_distinct, written};
use super::row::{FileRow, Row, State};
use super::sheet::Layout;
use super::table::{Form, Table};
use super::values::Vary;
use super::variants::{Axis, Combining, Variants};
use crate::commands::evaluation::{Opened, open};
use crate::commands::evaluation_order::{evaluation_order, linked_from};
use crate::commands::fail_if::{self, Limit};
use crate::commands::graph_file::GraphFile;
use crate::commands::write;

/// A wedge that is ready to be run.
pub(super) struct Plan {
    pub(super) catalogue: Catalogue,
    pub(super) file: GraphFile,
    pub(super) targets: Vec<NodeId>,
    pub(super) variants: Variants,
    pub(super) patterns: Vec<Pattern>,
    pub(super) limits: Vec<Limit>,
    /// Whether to measure as well what is measured on request only.
    pub(super) examine: bool,
    pub(super) tables: Vec<(PathBuf, Form)>,
    /// Where the record is kept.
    pub(super) record: Option<PathBuf>,
    /// What deserves a look in the file.
    pub(super) file_warnings: Vec<String>,
    /// The same, and what deserves a look in the arguments.
    pub(super) warnings: Vec<String>,
}

impl Plan {
    pub(super) fn new(arguments: &Arguments) -> Result<Self, Vec<String>> {
        let catalogue = maquette_nodes::catalogue().map_err(|error| vec![format!("error: {error}")])?;
        let types = RefCell::new(Vec::new());
        let Opened { mut file, targets, mut warnings, .. } = open(&catalogue, &arguments.evaluation, |found| {
            types.borrow_mut().extend_from_slice(found);
            Ok(())
        })?;
        let file_warnings = warnings.clone();
        let variants = read_variants(arguments, &file)?;
        for value in variants.axes.iter().flat_map(|axis| &axis.values) {
            file.allow(&value.literal);
        }
        if variants.repeated > 0 {
            let (left, repeated) = (variants.len(), variants.repeated);
            warnings.push(format!("warning: {repeated} samples repeat others and are left out; {left} are left"));
        }
        let mut wrong = Vec::new();
        let mut keep = |error: String| wrong.push(error);
        let patterns: Vec<Pattern> = arguments
            .files
            .iter()
            .filter_map(|text| Pattern::parse(text, &variants.axes).map_err(&mut keep).ok())
            .collect();
        let limits: Vec<Limit> = arguments
            .fail_if
            .iter()
            .filter_map(|text| Limit::parse(text).map_err(|error| keep(format!("error: {error}"))).ok())
            .collect();
        let tables: Vec<(PathBuf, Form)> = arguments
            .table
            .iter()
            .filter_map(|path| Form::of(path).map_err(&mut keep).ok().map(|form| (path.clone(), form)))
            .collect();
        if let Some(path) = &arguments.sheet {
            if path.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("png")) {
                keep(format!("error: --sheet {}: pictures are written as .png", path.display()));
            }
            if let Err(error) = Layout::new(&variants, arguments.tile) {
                keep(error);
            }
        }
        wrong.extend(fail_if::refuse_unknown(&limits, &file.loaded.graph, &targets));
        if !wrong.is_empty() {
            return Err(wrong);
        }
        let examine = arguments.report || !limits.is_empty();
        let formats: Vec<_> = patterns.iter().map(|pattern| (Path::new(&pattern.text), pattern.format)).collect();
        write::suits(&formats, &types.borrow())?;
        let record = record_place(arguments, &patterns);
        let plan = Self {
            catalogue,
            file,
            targets,
            variants,
            patterns,
            limits,
            examine,
            tables,
            record,
            file_warnings,
            warnings,
        };
        plan.check_files(arguments).map_err(|error| vec![error])?;
        Ok(plan.with_warnings())
    }

    /// Says where files would be written over one another, or over what is read.
    fn check_files(&self, arguments: &Arguments) -> Result<(), String> {
        let mut taken = vec![(self.file.path.clone(), "the graph".to_owned())];
        taken.extend(self.file.files().into_iter().map(|path| (path, "a file that the graph reads".to_owned())));
        let others = [("--sheet", &arguments.sheet), ("--openjd", &arguments.openjd), ("the record", &self.record)];
        let others = others.into_iter().filter_map(|(what, path)| Some((path.clone()?, what)));
        let tables = self.tables.iter().map(|(path, _)| (path.clone(), "--table"));
        for (path, what) in others.chain(tables) {
            let real = |path: &Path| path.canonicalize().or_else(|_| std::path::absolute(path)).unwrap_or_default();
            if let Some((_, other)) = taken.iter().find(|(other, _)| real(other) == real(&path)) {
                return Err(format!("error: {what} {}: this is {other} already; give another name", path.display()));
            }
            taken.push((path, what.to_owned()));
        }
        check_distinct(&self.patterns, &self.variants, &taken)
    }

    fn with_warnings(mut self) -> Self {
        let costs = self.costs();
        for (axis, cost) in self.variants.axes.iter().zip(costs) {
            if cost == 0 {
                let address = &axis.address;
                self.warnings.push(format!("warning: --vary {address}: no result that is asked for depends on it"));
            }
        }
        self
    }

    /// How many nodes run again where the value of an axis changes.
    pub(super) fn costs(&self) -> Vec<usize> {
        let graph = &self.file.loaded.graph;
        let order = evaluation_order(graph, &self.targets);
        let cost = |axis: &Axis| {
            let mut changed: BTreeSet<NodeId> = axis.place.nodes().into_iter().collect();
            let behind = order.iter().filter(|id| {
                let stale = changed.contains(id) || linked_from(graph, **id).iter().any(|from| changed.contains(from));
                if stale {
                    changed.insert(**id);
                }
                stale
            });
            behind.count()
        };
        self.variants.axes.iter().map(cost).collect()
    }

    /// The files of a variant, by pattern.
    pub(super) fn files(&self, variant: usize) -> impl Iterator<Item = (PathBuf, &Pattern)> {
        self.patterns.iter().map(move |pattern| (pattern.file(&self.variants, variant), pattern))
    }

    /// All files that the wedge writes for its variants.
    pub(super) fn all_files(&self) -> BTreeSet<String> {
        let files = (0..self.variants.len()).flat_map(|variant| self.files(variant));
        let files = files.flat_map(|(path, pattern)| written(&path, pattern.format));
        files.map(|path| path.display().to_string()).collect()
    }

    /// The values of a variant as they are shown.
    pub(super) fn texts(&self, variant: usize) -> Vec<String> {
        self.variants.values(variant).map(|(_, value)| value.text.clone()).collect()
    }

    /// A variant that is only named.
    pub(super) fn listed(&self, variant: usize) -> Row {
        let files = self.files(variant).flat_map(|(path, pattern)| written(&path, pattern.format));
        let file = |path: PathBuf| FileRow { path: path.display().to_string(), bytes: 0, hash: String::new() };
        let files = files.map(file).collect();
        Row { files, ..Row::unreached(variant + 1, self.texts(variant), State::Listed) }
    }

    pub(super) fn table<'a>(&'a self, rows: &'a [Row], begun: Instant, errors: &'a [String]) -> Table<'a> {
        Table {
            graph: self.file.path.display().to_string(),
            addresses: self.variants.axes.iter().map(|axis| axis.address.as_str()).collect(),
            rows,
            seconds: begun.elapsed().as_secs_f64(),
            errors,
        }
    }

    /// A key of each variant: equal keys mean equal results.
    pub(super) fn keys(&self, arguments: &Arguments) -> Vec<String> {
        let mut contents = Contents::default();
        let whole = self.common_key(arguments, &mut contents);
        let key = |variant: usize| {
            let mut parts = vec![whole.clone()];
            for (axis, value) in self.variants.values(variant) {
                parts.push(format!("{}={:?}", axis.address, value.literal));
                if let Literal::File(path) = &value.literal {
                    parts.push(contents.hash(&self.file.base().join(path)));
                }
            }
            parts.extend(self.files(variant).map(|(path, _)| path.display().to_string()));
            super::record::key(&parts.iter().map(String::as_str).collect::<Vec<_>>())
        };
        (0..self.variants.len()).map(key).collect()
    }

    /// What all variants have in common.
    fn common_key(&self, arguments: &Arguments, contents: &mut Contents) -> String {
        let needed: BTreeSet<NodeId> = self.file.loaded.graph.upstream(&self.targets).into_iter().collect();
        let mut graph = self.file.loaded.graph.clone();
        graph.notes.clear();
        let all: Vec<NodeId> = graph.nodes().map(|(id, _)| id).collect();
        for id in all {
            // What does not change results: where nodes lie, what is noted, what is not evaluated. The node is there,
            // so none of this can fail.
            let _ = graph.set_position(id, None);
            let _ = graph.set_note(id, "");
            if !needed.contains(&id) {
                let _ = graph.remove(id);
            }
        }
        let mut parts = vec![concat!("maquette ", env!("CARGO_PKG_VERSION")).to_owned()];
        parts.push(maquette_graph::file::to_text(&graph));
        let kinds: BTreeMap<&str, u32> =
            graph.nodes().filter_map(|(_, node)| node.kind()).map(|kind| (kind.name(), kind.version())).collect();
        parts.extend(kinds.iter().map(|(kind, version)| format!("{kind} {version}")));
        let name = |id: &NodeId| graph.node(*id).map_or("", |node| node.name()).to_owned();
        parts.push(self.targets.iter().map(name).collect::<Vec<_>>().join("\n"));
        parts.push(format!("keep going: {}", arguments.evaluation.keep_going));
        parts.push(format!("examine: {}", self.examine));
        parts.extend(self.limits.iter().map(Limit::to_string));
        parts.extend(self.file.files().into_iter().map(|path| contents.hash(&path)));
        super::record::key(&parts.iter().map(String::as_str).collect::<Vec<_>>())
    }
}

/// Hashes of the files that are read, each read once.
#[derive(Default)]
struct Contents(BTreeMap<PathBuf, String>);

impl Contents {
    fn hash(&mut self, path: &Path) -> String {
        let hash = |path: &Path| match std::fs::read(path) {
            Ok(bytes) => ContentHasher::of_bytes(&bytes).to_string(),
            Err(_) => "not there".to_owned(),
        };
        self.0.entry(path.to_owned()).or_insert_with(|| hash(path)).clone()
    }
}

fn read_variants(arguments: &Arguments, file: &GraphFile) -> Result<Variants, Vec<String>> {
    let mut wrong = Vec::new();
    let mut varies = Vec::new();
    // The values are tried on a copy; the graph itself keeps what it holds.
    let mut trial = file.loaded.graph.clone();
    for text in &arguments.vary {
        match Vary::parse(&mut trial, text) {
            Ok(vary) => varies.push(vary),
            Err(error) => wrong.push(format!("{}: error: {error}", file.path.display())),
        }
    }
    for vary in &varies {
        let set = arguments.evaluation.set.iter().filter_map(|set| set.split_once('='));
        if set.into_iter().any(|(address, _)| address == vary.address) {
            wrong.push(format!("error: {} is both set and varied: leave one of them out", vary.address));
        }
    }
    if !wrong.is_empty() {
        return Err(wrong);
    }
    let samples = arguments.samples.map(|count| (count, arguments.seed));
    Variants::new(varies, &Combining { zip: &arguments.zip, samples, many: arguments.many })
}

/// Where the record is kept: beside the files, unless it is said.
fn record_place(arguments: &Arguments, patterns: &[Pattern]) -> Option<PathBuf> {
    if arguments.no_record || arguments.dry_run || arguments.openjd.is_some() {
        return None;
    }
    arguments.record.clone().or_else(|| patterns.first().map(|pattern| pattern.folder().join("wedge.jsonl")))
}
