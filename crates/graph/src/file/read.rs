//! From text to a graph, with everything that is wrong said at once.

use std::collections::{BTreeMap, HashMap};

use ron::value::RawValue;

use crate::catalogue::{Catalogue, closest};
use crate::file::include::{Includes, Inclusion, Standing};
use crate::file::limit::{MOST_BYTES, TOO_LARGE, quoted_in_message};
use crate::file::link::{PendingLink, Suggestions};
use crate::file::literal_text::{Spelled, parse, plain_text};
use crate::file::migrate::{Rewrite, STEPS, to_present};
use crate::file::place::LineIndex;
use crate::file::syntax::{attributes, syntax_error};
use crate::file::tree::{FileTree, NodeTree, take_apart, trimmed};
use crate::file::{FORMAT_VERSION, FileError, Problem, Severity};
use crate::graph::{Graph, GraphError, NodeId, Source};
use crate::literal::Literal;
use crate::value::KeyHasherBuilder;

/// A graph as it was read.
#[derive(Debug)]
pub struct Loaded {
    /// The graph; with placeholders for what was not understood.
    pub graph: Graph,
    /// Everything that is wrong, in the order of the file; what is wrong in included files comes behind.
    pub problems: Vec<Problem>,
    /// The files that were included, or were to be, seen from the graph's folder; each once, by name.
    pub included: Vec<String>,
    places: HashMap<NodeId, Place, KeyHasherBuilder>,
    /// What would make the file one of today.
    pub(super) rewrites: Vec<Rewrite>,
}

#[derive(Debug, Default)]
struct Place {
    at: (usize, usize),
    /// In the order of the file.
    inputs: Vec<(String, (usize, usize))>,
}

impl Loaded {
    /// Whether something keeps the graph from being evaluated as it was meant.
    pub fn has_errors(&self) -> bool {
        self.problems.iter().any(|p| p.severity == Severity::Error)
    }

    /// Line and column of a node, or of one of its inputs where the file has it.
    pub fn place(&self, node: NodeId, input: Option<&str>) -> Option<(usize, usize)> {
        let place = self.places.get(&node)?;
        // Of an input that occurs twice, the last one counts.
        let input = input.and_then(|wanted| place.inputs.iter().rev().find(|(input, _)| input == wanted));
        Some(input.map_or(place.at, |(_, at)| *at))
    }
}

/// Reads a graph from the bytes of a file.
///
/// # Errors
/// Only where nothing can be read: not UTF-8, not RON, not shaped like a graph. Everything else is in
/// [`Loaded::problems`].
pub fn from_bytes(catalogue: &Catalogue, bytes: &[u8]) -> Result<Loaded, FileError> {
    from_bytes_with(catalogue, bytes, &Includes::none())
}

/// As [`from_bytes`], for a graph that may include other files.
///
/// # Errors
/// As [`from_bytes`].
pub fn from_bytes_with(catalogue: &Catalogue, bytes: &[u8], includes: &Includes<'_>) -> Result<Loaded, FileError> {
    from_text_with(catalogue, utf8(bytes)?, includes)
}

/// The bytes as text.
pub(super) fn utf8(bytes: &[u8]) -> Result<&str, FileError> {
    if bytes.len() > MOST_BYTES {
        return Err(too_long(bytes.len()));
    }
    std::str::from_utf8(bytes).map_err(|error| {
        let good = std::str::from_utf8(&bytes[..error.valid_up_to()]).unwrap_or_default();
        let good = good.strip_prefix(BYTE_ORDER_MARK).unwrap_or(good);
        let (line, column) = LineIndex::new(good).place(good.len());
        FileError::NotUtf8 { line, column }
    })
}

fn too_long(bytes: usize) -> FileError {
    let what = format!("it has {bytes} bytes or more, and {MOST_BYTES} are the most that is read");
    FileError::TooLarge { line: 1, column: 1, what }
}

pub(super) const BYTE_ORDER_MARK: char = '\u{feff}';

/// Reads a graph from text.
///
/// # Errors
/// As [`from_bytes`].
pub fn from_text(catalogue: &Catalogue, text: &str) -> Result<Loaded, FileError> {
    from_text_with(catalogue, text, &Includes::none())
}

/// As [`from_text`], for a graph that may include other files.
///
/// # Errors
/// As [`from_bytes`].
pub fn from_text_with(catalogue: &Catalogue, text: &str, includes: &Includes<'_>) -> Result<Loaded, FileError> {
    let inclusion = Inclusion::new(catalogue, includes);
    let Read { graph, mut problems, places, rewrites } = inclusion.read(text, &Standing::of_root(includes))?;
    problems.sort_by_key(|p| (p.line, p.column));
    let left_out = inclusion.left_out();
    let (mut elsewhere, included) = inclusion.finish();
    problems.append(&mut elsewhere);
    problems.extend(left_out);
    Ok(Loaded { graph, problems, included, places, rewrites })
}

/// What came of one graph of a file.
pub(super) struct Read {
    pub(super) graph: Graph,
    pub(super) problems: Vec<Problem>,
    places: HashMap<NodeId, Place, KeyHasherBuilder>,
    pub(super) rewrites: Vec<Rewrite>,
}

/// Reads the text of a whole file.
pub(super) fn read_file(inclusion: &Inclusion<'_>, text: &str, standing: &Standing) -> Result<Read, FileError> {
    let text = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text);
    if text.len() > MOST_BYTES {
        return Err(too_long(text.len()));
    }
    read_version(inclusion, text, standing, None)
}

/// Reads a text, first brought to the present where it is not; then `was` is the version that it had.
fn read_version(
    inclusion: &Inclusion<'_>,
    text: &str,
    standing: &Standing,
    was: Option<u32>,
) -> Result<Read, FileError> {
    let lines = LineIndex::new(text);
    let tree = take_apart(text, &inclusion.meter).map_err(|error| {
        if inclusion.meter.is_exceeded() {
            let (line, column) = lines.place(lines.byte(error.span.start.line, error.span.start.col));
            return FileError::TooLarge { line, column, what: TOO_LARGE.to_owned() };
        }
        syntax_error(text, &lines, &error)
    })?;
    if was.is_none()
        && let Some((present, was)) = to_present(text, tree.version.map(trimmed), &STEPS)
    {
        return read_version(inclusion, &present, standing, Some(was));
    }
    let mut reader = Reader::new(inclusion, text, &lines, standing);
    reader.was = was;
    reader.read_kind_versions(&tree);
    Ok(reader.read(&tree))
}

pub(super) struct Reader<'a> {
    pub(super) catalogue: &'a Catalogue,
    pub(super) inclusion: &'a Inclusion<'a>,
    pub(super) text: &'a str,
    pub(super) lines: &'a LineIndex<'a>,
    pub(super) standing: &'a Standing,
    pub(super) graph: Graph,
    pub(super) suggestions: Suggestions,
    pub(super) problems: Vec<Problem>,
    places: HashMap<NodeId, Place, KeyHasherBuilder>,
    /// In the order of the file; `None` where another value at the same input took its place.
    links: Vec<Option<PendingLink<'a>>>,
    /// The inputs of the node that is read: where each has its link, if it is one.
    pub(super) inputs: BTreeMap<String, Option<usize>>,
    /// Nodes whose names can't be names, by what the file calls them.
    kept_as: HashMap<String, NodeId>,
    /// The number to try next for nodes that are kept under another name.
    next_number: HashMap<String, usize>,
    /// The format version that the file had, where it was brought to the present.
    was: Option<u32>,
    /// Which version of a kind the file was written with, where it says so.
    pub(super) kind_versions: BTreeMap<String, u32>,
    pub(super) rewrites: Vec<Rewrite>,
}

impl<'a> Reader<'a> {
    pub(super) fn new(
        inclusion: &'a Inclusion<'a>,
        text: &'a str,
        lines: &'a LineIndex<'a>,
        standing: &'a Standing,
    ) -> Self {
        Self {
            catalogue: inclusion.catalogue,
            inclusion,
            text,
            lines,
            standing,
            graph: Graph::new(),
            suggestions: Suggestions::default(),
            problems: Vec::new(),
            places: HashMap::default(),
            links: Vec::new(),
            inputs: BTreeMap::new(),
            kept_as: HashMap::new(),
            next_number: HashMap::new(),
            was: None,
            kind_versions: BTreeMap::new(),
            rewrites: Vec::new(),
        }
    }

    /// Byte of a piece of the text within the text.
    pub(super) fn offset(&self, piece: &str) -> usize {
        (piece.as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize)
    }

    /// The node that the file calls so.
    pub(super) fn find(&self, name: &str) -> Option<NodeId> {
        self.graph.find(name).or_else(|| self.kept_as.get(name).copied())
    }

    pub(super) fn report(
        &mut self,
        severity: Severity,
        at: usize,
        node: Option<&str>,
        port: Option<&str>,
        what: [String; 2],
    ) {
        let (line, column) = self.lines.place(at);
        let [message, remedy] = what;
        let node = node.map(quoted_in_message);
        let problem = Problem {
            severity,
            file: self.standing.file.clone(),
            line,
            column,
            node: self.standing.path_of(node.as_deref()),
            port: port.map(quoted_in_message),
            message,
            remedy,
        };
        if self.inclusion.has_room_for(&problem) {
            self.problems.push(problem);
        }
    }

    pub(super) fn error(&mut self, at: usize, node: Option<&str>, port: Option<&str>, message: String, remedy: &str) {
        self.report(Severity::Error, at, node, port, [message, remedy.to_owned()]);
    }

    pub(super) fn warning(&mut self, at: usize, node: Option<&str>, message: String, remedy: &str) {
        self.report(Severity::Warning, at, node, None, [message, remedy.to_owned()]);
    }

    /// A name, before a colon. One that is not in quotes is taken as it is.
    pub(super) fn name(&mut self, raw: &'a RawValue, node: Option<&str>, what: &str) -> String {
        let piece = trimmed(raw);
        if let Some(name) = plain_text(piece) {
            return name.to_owned();
        }
        ron::from_str(piece).unwrap_or_else(|_| {
            let at = self.offset(piece);
            self.error(at, node, None, format!("{what} is not a text"), "write it in double quotes");
            piece.to_owned()
        })
    }

    /// The text of a known field; where it is none, the field goes to those that are kept as they are.
    pub(super) fn field(
        &mut self,
        raw: Option<&'a RawValue>,
        node: Option<&str>,
        field: &str,
        kept: &mut Vec<(String, String)>,
    ) -> Option<String> {
        let piece = trimmed(raw?);
        let text = plain_text(piece).map(str::to_owned).or_else(|| ron::from_str(piece).ok());
        if text.is_none() {
            let at = self.offset(piece);
            self.error(at, node, None, format!("the field \"{field}\" is not a text"), "write it in double quotes");
            kept.push((field.to_owned(), piece.to_owned()));
        }
        text
    }

    pub(super) fn read(mut self, tree: &FileTree<'a>) -> Read {
        if self.standing.is_embedded() {
            self.no_version(tree);
        } else {
            if let Some(at) = attributes(self.text) {
                let message = "the attribute #![...] has no meaning in a graph".to_owned();
                self.warning(at, None, message, "remove it; it is not kept");
            }
            self.version(tree);
        }
        let mut kept = Vec::new();
        if let Some(notes) = self.field(tree.notes, None, "notes", &mut kept) {
            self.graph.notes = notes;
        }
        self.graph.unknown_fields.append(&mut kept);
        self.parameters(tree);
        match &tree.nodes {
            None => self.error(0, None, None, "the field \"nodes\" is missing".to_owned(), "add nodes: {}"),
            Some(nodes) => {
                for (name, node) in &nodes.0 {
                    self.node(name, node);
                }
            }
        }
        let links: Vec<_> = std::mem::take(&mut self.links).into_iter().flatten().collect();
        self.connect_all(&links);
        self.kind_versions_now(tree);
        self.outputs(tree);
        self.layout(tree);
        self.presentation(tree);
        for (name, raw) in &tree.unknown {
            let piece = trimmed(raw);
            self.graph.unknown_fields.push((name.clone(), piece.to_owned()));
            self.unknown_field(None, name, piece);
        }
        Read { graph: self.graph, problems: self.problems, places: self.places, rewrites: self.rewrites }
    }

    /// An embedded graph has the version of its file.
    fn no_version(&mut self, tree: &FileTree<'a>) {
        if let Some(raw) = tree.version {
            let piece = trimmed(raw);
            self.graph.unknown_fields.push(("version".to_owned(), piece.to_owned()));
            let message = "an embedded graph has no version of its own".to_owned();
            self.warning(self.offset(piece), None, message, "remove it; it is kept");
        }
    }

    pub(super) fn unknown_field(&mut self, node: Option<&str>, field: &str, piece: &str) {
        let message = format!("the field \"{}\" is unknown to this version", quoted_in_message(field));
        let at = self.offset(piece);
        // RON gives the name without its place; it stands before the value, but for a comment between them.
        let before = self.text.get(..at).and_then(|text| text.trim_end().strip_suffix(':'));
        let before = before.and_then(|text| text.trim_end().strip_suffix(field));
        let at = before.map_or(at, |text| text.strip_suffix("r#").unwrap_or(text).len());
        self.warning(at, node, message, "it is kept; check its spelling, or update Maquette");
    }

    fn version(&mut self, tree: &FileTree<'a>) {
        let Some(raw) = tree.version else {
            self.error(0, None, None, "the field \"version\" is missing".to_owned(), "add version: 1");
            return;
        };
        let piece = trimmed(raw);
        let at = self.offset(piece);
        let (message, remedy) = match ron::from_str::<u32>(piece) {
            Err(_) | Ok(0) => {
                (format!("the version {} is not a whole number from 1 on", quoted_in_message(piece)), "write 1")
            }
            Ok(version) if version > FORMAT_VERSION => {
                let known = FORMAT_VERSION;
                (format!("the file has format version {version}, and this Maquette reads {known}"), "update Maquette")
            }
            Ok(_) => {
                if let Some(was) = self.was {
                    let message = format!("the file has format version {was}, and was read as {FORMAT_VERSION}");
                    self.note(at, None, None, message);
                }
                return;
            }
        };
        self.error(at, None, None, message, remedy);
        self.graph.unknown_fields.push(("version".to_owned(), piece.to_owned()));
    }

    fn node(&mut self, name: &'a RawValue, tree: &NodeTree<'a>) {
        let name_at = self.offset(trimmed(name));
        let wanted = self.name(name, None, "a node's name");
        let mut kept = Vec::new();
        if tree.kind.is_none() {
            let message = "the field \"kind\" is missing".to_owned();
            self.error(name_at, Some(&wanted), None, message, "add kind: \"...\"; `maquette nodes` lists them");
        }
        let spelled = self.field(tree.kind, Some(&wanted), "kind", &mut kept);
        let spelled = spelled.map(|kind| self.kind_now(kind, tree.kind, &wanted));
        let kind = spelled.clone().unwrap_or_default();
        let Some(id) = self.insert(&kind, &wanted, name_at) else { return };
        self.places.insert(id, Place { at: self.lines.place(name_at), inputs: Vec::new() });
        self.inputs.clear();
        if spelled.is_some() && self.catalogue.kind(&kind).is_none() {
            let at = tree.kind.map_or(name_at, |raw| self.offset(trimmed(raw)));
            let remedy = match self.catalogue.suggest(&kind) {
                Some(suggestion) => format!("did you mean \"{suggestion}\"? `maquette nodes` lists all kinds"),
                None => "`maquette nodes` lists all kinds; a newer version may have it".to_owned(),
            };
            let kind = quoted_in_message(&kind);
            self.error(at, Some(&wanted), None, format!("the node kind \"{kind}\" is unknown"), &remedy);
        }
        let note = self.field(tree.note, Some(&wanted), "note", &mut kept).unwrap_or_default();
        self.body(id, &wanted, tree, &mut kept);
        for (input, raw) in tree.inputs.iter().flat_map(|inputs| &inputs.0) {
            self.input(id, &wanted, input, raw);
        }
        self.former_defaults(id, &wanted, tree, name_at);
        for (field, raw) in &tree.unknown {
            let piece = trimmed(raw);
            kept.push((field.clone(), piece.to_owned()));
            self.unknown_field(Some(&wanted), field, piece);
        }
        let muted = self.flag(tree.muted, "muted", &wanted, &mut kept);
        let collapsed = self.flag(tree.collapsed, "collapsed", &wanted, &mut kept);
        if let Some(node) = self.graph.nodes.get_mut(&id) {
            node.note = note;
            node.unknown_fields = kept;
            node.set_muted(muted);
            node.collapsed = collapsed;
        }
    }

    /// Adds the node, under a free name where its own can't be used, so that nothing is lost when the graph is saved.
    fn insert(&mut self, kind: &str, wanted: &str, name_at: usize) -> Option<NodeId> {
        let error = match self.insert_as(kind, wanted) {
            Ok(id) => return Some(id),
            Err(error) => error,
        };
        let stem: String =
            wanted.chars().map(|c| if c.is_alphanumeric() || "-_ ".contains(c) { c } else { '-' }).take(100).collect();
        let stem = if stem.trim().is_empty() { "node" } else { stem.trim() };
        let mut number = self.next_number.get(stem).copied().unwrap_or(1);
        let (id, kept) = loop {
            let name = if number == 1 { stem.to_owned() } else { format!("{stem}-{number}") };
            number += 1;
            match self.insert_as(kind, &name) {
                Ok(id) => break (id, name),
                Err(GraphError::DuplicateName(_)) => {}
                Err(_) => return None,
            }
        };
        self.next_number.insert(stem.to_owned(), number);
        if matches!(error, GraphError::BadName(_)) {
            self.kept_as.entry(wanted.to_owned()).or_insert(id);
        }
        let error = match error {
            GraphError::BadName(name) => GraphError::BadName(quoted_in_message(&name)),
            other => other,
        };
        self.error(name_at, Some(wanted), None, error.to_string(), &format!("it is kept as \"{kept}\""));
        Some(id)
    }

    fn insert_as(&mut self, kind: &str, name: &str) -> Result<NodeId, GraphError> {
        if self.catalogue.kind(kind).is_some() {
            self.graph.add(self.catalogue, kind, name)
        } else {
            self.graph.add_placeholder(kind, name)
        }
    }

    fn input(&mut self, id: NodeId, node: &str, name: &'a RawValue, raw: &'a RawValue) {
        let name_at = self.offset(trimmed(name));
        let input = self.name(name, Some(node), "an input's name");
        let input = self.input_now(id, node, input, name);
        let piece = trimmed(raw);
        let at = self.offset(piece);
        let place = self.lines.place(at);
        if let Some(known) = self.places.get_mut(&id) {
            known.inputs.push((input.clone(), place));
        }
        if let Some(earlier) = self.inputs.insert(input.clone(), None) {
            let message = "the input occurs twice".to_owned();
            self.error(name_at, Some(node), Some(&input), message, "keep one; the last one is used");
            // Links come after all literals, so an earlier one would win.
            if let Some(earlier) = earlier.and_then(|index| self.links.get_mut(index)) {
                *earlier = None;
            }
        }
        let kind = self.graph.node(id).and_then(|n| n.kind().cloned());
        let spec = kind.as_ref().and_then(|k| k.find_input(&input));
        if let (Some(kind), None) = (&kind, spec) {
            let names: Vec<_> = kind.inputs().iter().map(|i| i.name.as_str()).collect();
            let remedy = match closest(&input, names.iter().copied()) {
                Some(name) => format!("did you mean \"{name}\"? It is kept, but has no effect"),
                None if names.is_empty() => format!("{} has none; it is kept, but has no effect", kind.name()),
                None => format!("{} has {}; it is kept, but has no effect", kind.name(), names.join(", ")),
            };
            self.error(name_at, Some(node), Some(&input), format!("{} has no such input", kind.name()), &remedy);
        }
        let mut unread = None;
        let value = parse(piece);
        let value = match (&kind, value) {
            (Some(kind), Ok(Spelled::Literal(Literal::Choice(option)))) => {
                Ok(Spelled::Literal(Literal::Choice(self.option_now(kind, node, &input, option, piece))))
            }
            (_, value) => value,
        };
        match (value, spec) {
            (Ok(Spelled::Link(address)), _) => {
                self.inputs.insert(input.clone(), Some(self.links.len()));
                self.links.push(Some(PendingLink { to: id, input, address, raw }));
            }
            (Ok(Spelled::Parameter(parameter)), _) => self.use_parameter(id, node, &input, &parameter, piece),
            // What an unknown input means is not known either: its text stays, digit for digit.
            (_, None) => drop(self.graph.put(id, &input, Some(Source::Unread(piece.to_owned())))),
            (Ok(Spelled::Literal(literal)), Some(spec)) => match spec.refuses(&literal) {
                Some(reason) => unread = Some((at, input, reason)),
                // It was checked, so the graph can't refuse it.
                None => drop(self.graph.set(id, &input, literal)),
            },
            (Err(error), Some(_)) => {
                unread = Some((at + error.offset, input, format!("the value can't be read: {}", error.message)));
            }
        }
        if let Some((at, input, message)) = unread {
            self.error(at, Some(node), Some(&input), message, "");
            self.graph.put(id, &input, Some(Source::Unread(piece.to_owned())));
        }
    }

    fn layout(&mut self, tree: &FileTree<'a>) {
        for (name, raw) in tree.layout.iter().flat_map(|entries| &entries.0) {
            let piece = trimmed(raw);
            let at = self.offset(piece);
            let name = self.name(name, None, "a node's name");
            let position = ron::from_str::<(f64, f64)>(piece).ok().filter(|p| p.0.is_finite() && p.1.is_finite());
            let message = match (self.find(&name), position) {
                (Some(id), Some((x, y))) => {
                    let place = self.graph.nodes.get_mut(&id).map(|node| &mut node.position);
                    if place.and_then(|place| place.replace([x, y])).is_some() {
                        let message = format!("the layout places \"{}\" twice", quoted_in_message(&name));
                        self.warning(at, None, message, "keep one; the last one is used");
                    }
                    continue;
                }
                (None, _) => format!("the layout places \"{}\", and no node has that name", quoted_in_message(&name)),
                (Some(_), None) => format!("the layout of \"{}\" is not two numbers (x, y)", quoted_in_message(&name)),
            };
            self.graph.unknown_layout.push((name, piece.to_owned()));
            self.warning(at, None, message, "it is kept");
        }
    }
}
