//! From text to a graph, with everything that is wrong said at once.

use std::collections::HashMap;

use ron::value::RawValue;

use crate::catalogue::{Catalogue, closest};
use crate::file::literal_text::{Spelled, byte_of, parse};
use crate::file::problem::line_and_column;
use crate::file::tree::{FileTree, NodeTree, trimmed};
use crate::file::{FORMAT_VERSION, FileError, Problem, Severity};
use crate::graph::{ConnectError, Graph, GraphError, Link, NodeId, Source};

/// A graph as it was read.
#[derive(Debug)]
pub struct Loaded {
    /// The graph; with placeholders for what was not understood.
    pub graph: Graph,
    /// Everything that is wrong, in the order of the file.
    pub problems: Vec<Problem>,
    places: HashMap<NodeId, Place>,
}

#[derive(Debug, Default)]
struct Place {
    at: (usize, usize),
    inputs: HashMap<String, (usize, usize)>,
}

impl Loaded {
    /// Whether something keeps the graph from being evaluated as it was meant.
    pub fn has_errors(&self) -> bool {
        self.problems.iter().any(|p| p.severity == Severity::Error)
    }

    /// Line and column of a node, or of one of its inputs where the file has it.
    pub fn place(&self, node: NodeId, input: Option<&str>) -> Option<(usize, usize)> {
        let place = self.places.get(&node)?;
        Some(input.and_then(|i| place.inputs.get(i)).copied().unwrap_or(place.at))
    }
}

/// Reads a graph from the bytes of a file.
///
/// # Errors
/// Only where nothing can be read: not UTF-8, not RON, not shaped like a graph. Everything else is in
/// [`Loaded::problems`].
pub fn from_bytes(catalogue: &Catalogue, bytes: &[u8]) -> Result<Loaded, FileError> {
    match std::str::from_utf8(bytes) {
        Ok(text) => from_text(catalogue, text),
        Err(error) => {
            let good = std::str::from_utf8(&bytes[..error.valid_up_to()]).unwrap_or_default();
            let (line, column) = line_and_column(good, good.len());
            Err(FileError::NotUtf8 { line, column })
        }
    }
}

/// Reads a graph from text.
///
/// # Errors
/// As [`from_bytes`].
pub fn from_text(catalogue: &Catalogue, text: &str) -> Result<Loaded, FileError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let tree: FileTree<'_> = ron::from_str(text).map_err(|error| syntax_error(text, &error))?;
    let mut reader = Reader {
        catalogue,
        text,
        lines: std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect(),
        graph: Graph::new(),
        problems: Vec::new(),
        places: HashMap::new(),
        links: Vec::new(),
    };
    reader.read(&tree);
    reader.problems.sort_by_key(|p| (p.line, p.column));
    Ok(Loaded { graph: reader.graph, problems: reader.problems, places: reader.places })
}

fn syntax_error(text: &str, error: &ron::error::SpannedError) -> FileError {
    let offset = byte_of(text, error.span.start.line, error.span.start.col);
    let (line, column) = line_and_column(text, offset);
    let rest_is_empty = text.get(offset..).is_none_or(|rest| rest.trim().is_empty());
    let remedy = if text.trim().is_empty() {
        "the file is empty: an empty graph is (version: 1, nodes: {})"
    } else if rest_is_empty {
        "the file ends too early: it may have been cut off, so compare it with a backup"
    } else {
        "a graph is written (version: 1, nodes: { \"name\": (kind: \"...\", inputs: { ... }) })"
    };
    FileError::Syntax { line, column, message: error.code.to_string(), remedy: remedy.to_owned() }
}

struct PendingLink<'a> {
    to: NodeId,
    input: String,
    address: String,
    raw: &'a str,
}

struct Reader<'a> {
    catalogue: &'a Catalogue,
    text: &'a str,
    /// Byte at which each line begins.
    lines: Vec<usize>,
    graph: Graph,
    problems: Vec<Problem>,
    places: HashMap<NodeId, Place>,
    links: Vec<PendingLink<'a>>,
}

impl<'a> Reader<'a> {
    fn place(&self, offset: usize) -> (usize, usize) {
        let line = self.lines.partition_point(|start| *start <= offset).max(1);
        let column = self.text.get(self.lines[line - 1]..offset).map_or(0, |before| before.chars().count());
        (line, 1 + column)
    }

    /// Byte of a piece of the text within the text.
    fn offset(&self, piece: &str) -> usize {
        (piece.as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize)
    }

    fn report(&mut self, severity: Severity, at: usize, node: Option<&str>, port: Option<&str>, what: [String; 2]) {
        let (line, column) = self.place(at);
        let [message, remedy] = what;
        self.problems.push(Problem {
            severity,
            line,
            column,
            node: node.map(str::to_owned),
            port: port.map(str::to_owned),
            message,
            remedy,
        });
    }

    fn error(&mut self, at: usize, node: Option<&str>, port: Option<&str>, message: String, remedy: &str) {
        self.report(Severity::Error, at, node, port, [message, remedy.to_owned()]);
    }

    fn string(&mut self, raw: &'a RawValue, what: &str) -> String {
        let piece = trimmed(raw);
        match ron::from_str(piece) {
            Ok(string) => string,
            Err(_) => {
                let at = self.offset(piece);
                self.error(at, None, None, format!("{what} is not a text"), "write it in double quotes");
                String::new()
            }
        }
    }

    fn read(&mut self, tree: &FileTree<'a>) {
        self.version(tree);
        if let Some(notes) = tree.notes {
            self.graph.notes = self.string(notes, "the field \"notes\"");
        }
        match &tree.nodes {
            None => self.error(0, None, None, "the field \"nodes\" is missing".to_owned(), "add nodes: {}"),
            Some(nodes) => {
                for (name, node) in &nodes.0 {
                    self.node(name, node);
                }
            }
        }
        for link in std::mem::take(&mut self.links) {
            self.link(&link);
        }
        self.layout(tree);
        for (name, raw) in &tree.unknown {
            let piece = trimmed(raw);
            self.graph.unknown_fields.push((name.clone(), piece.to_owned()));
            let message = format!("the field \"{name}\" is unknown to this version");
            let remedy = "it is kept; check its spelling, or update Maquette".to_owned();
            let at = self.offset(piece);
            self.report(Severity::Warning, at, None, None, [message, remedy]);
        }
    }

    fn version(&mut self, tree: &FileTree<'a>) {
        let Some(raw) = tree.version else {
            self.error(0, None, None, "the field \"version\" is missing".to_owned(), "add version: 1");
            return;
        };
        let piece = trimmed(raw);
        let at = self.offset(piece);
        match ron::from_str::<u32>(piece) {
            Err(_) | Ok(0) => {
                self.error(at, None, None, format!("the version {piece} is not a whole number from 1 on"), "write 1");
            }
            Ok(version) if version > FORMAT_VERSION => {
                let message = format!("the file has format version {version}, and this Maquette reads {FORMAT_VERSION}");
                self.error(at, None, None, message, "update Maquette");
            }
            Ok(_) => {}
        }
    }

    fn node(&mut self, name: &'a RawValue, tree: &NodeTree<'a>) {
        let name_at = self.offset(trimmed(name));
        let wanted = self.string(name, "a node's name");
        let kind = match tree.kind {
            Some(raw) => self.string(raw, "a node's kind"),
            None => {
                let message = "the field \"kind\" is missing".to_owned();
                self.error(name_at, Some(&wanted), None, message, "add kind: \"...\"; `maquette nodes` lists them");
                String::new()
            }
        };
        let id = match self.insert(&kind, &wanted) {
            Ok(id) => id,
            Err(error) => {
                // Kept under a free name, so that nothing is lost when the graph is saved.
                let stem: String =
                    wanted.chars().map(|c| if c.is_alphanumeric() || "-_".contains(c) { c } else { '-' }).collect();
                let kept = (2..).map(|n| format!("{stem:.100}-{n}")).find_map(|name| {
                    self.insert(&kind, &name).map(|id| (id, name)).ok()
                });
                let Some((id, kept)) = kept else { return };
                let remedy = format!("it is kept as \"{kept}\"");
                self.report(Severity::Error, name_at, Some(&wanted), None, [error.to_string(), remedy]);
                id
            }
        };
        self.places.insert(id, Place { at: self.place(name_at), inputs: HashMap::new() });
        if !kind.is_empty() && self.catalogue.kind(&kind).is_none() {
            let at = tree.kind.map_or(name_at, |raw| self.offset(trimmed(raw)));
            let remedy = match self.catalogue.suggest(&kind) {
                Some(suggestion) => format!("did you mean \"{suggestion}\"? `maquette nodes` lists all kinds"),
                None => "`maquette nodes` lists all kinds; a newer version may have it".to_owned(),
            };
            self.error(at, Some(&wanted), None, format!("the node kind \"{kind}\" is unknown"), &remedy);
        }
        if let Some(note) = tree.note {
            let note = self.string(note, "the field \"note\"");
            if let Some(node) = self.graph.nodes.get_mut(&id) {
                node.note = note;
            }
        }
        if let Some(inputs) = &tree.inputs {
            for (input, raw) in &inputs.0 {
                self.input(id, &wanted, input, raw);
            }
        }
        for (field, raw) in &tree.unknown {
            let piece = trimmed(raw);
            if let Some(node) = self.graph.nodes.get_mut(&id) {
                node.unknown_fields.push((field.clone(), piece.to_owned()));
            }
            let message = format!("the field \"{field}\" is unknown to this version");
            let remedy = "it is kept; check its spelling, or update Maquette".to_owned();
            let at = self.offset(piece);
            self.report(Severity::Warning, at, Some(&wanted), None, [message, remedy]);
        }
    }

    fn insert(&mut self, kind: &str, name: &str) -> Result<NodeId, GraphError> {
        if self.catalogue.kind(kind).is_some() {
            self.graph.add(self.catalogue, kind, name)
        } else {
            self.graph.add_placeholder(kind, name)
        }
    }

    fn input(&mut self, id: NodeId, node: &str, name: &'a RawValue, raw: &'a RawValue) {
        let name_at = self.offset(trimmed(name));
        let input = self.string(name, "an input's name");
        let piece = trimmed(raw);
        let at = self.offset(piece);
        let place = self.place(at);
        let known_place = self.places.get_mut(&id).map(|p| p.inputs.insert(input.clone(), place));
        if matches!(known_place, Some(Some(_))) {
            let message = "the input occurs twice".to_owned();
            self.error(name_at, Some(node), Some(&input), message, "keep one; the last one is used");
        }
        let kind = self.graph.node(id).and_then(|n| n.kind().cloned());
        let spec = kind.as_ref().and_then(|k| k.find_input(&input));
        if let (Some(kind), None) = (&kind, spec) {
            let names: Vec<_> = kind.inputs().iter().map(|i| i.name.as_str()).collect();
            let remedy = match closest(&input, names.iter().copied()) {
                Some(name) => format!("did you mean \"{name}\"? It is kept, but has no effect"),
                None => format!("{} has {}; it is kept, but has no effect", kind.name(), names.join(", ")),
            };
            self.error(name_at, Some(node), Some(&input), format!("{} has no such input", kind.name()), &remedy);
        }
        match parse(piece) {
            Err(error) => {
                let message = format!("the value can't be read: {}", error.message);
                self.error(at + error.offset, Some(node), Some(&input), message, "");
                self.graph.put(id, &input, Some(Source::Unread(piece.to_owned())));
            }
            Ok(Spelled::Link(address)) => self.links.push(PendingLink { to: id, input, address, raw: piece }),
            Ok(Spelled::Literal(literal)) => {
                let reason = match spec {
                    Some(spec) => spec.refuses(&literal),
                    None => literal.not_finite(),
                };
                match reason {
                    Some(reason) => {
                        self.error(at, Some(node), Some(&input), reason, "");
                        self.graph.put(id, &input, Some(Source::Unread(piece.to_owned())));
                    }
                    None if spec.is_some() => {
                        // It was checked above, so the graph can't refuse it.
                        let _ = self.graph.set(id, &input, literal);
                    }
                    None => self.graph.put(id, &input, Some(Source::literal(literal))),
                }
            }
        }
    }

    fn link(&mut self, link: &PendingLink<'a>) {
        let node = self.graph.node(link.to).map(|n| n.name().to_owned()).unwrap_or_default();
        let at = self.offset(link.raw);
        let known_input = self.graph.node(link.to).and_then(|n| n.kind()).map(|k| k.find_input(&link.input).is_some());
        let source = link.address.rsplit_once('.').map(|(name, output)| (self.graph.find(name), name, output));
        let (message, remedy) = match source {
            None => (format!("\"{}\" is not an address", link.address), "write Link(\"node.output\")".to_owned()),
            Some((None, name, _)) => {
                let remedy = match self.graph.suggest(name) {
                    Some(suggestion) => format!("did you mean \"{suggestion}\"?"),
                    None => "add the node, or remove the link".to_owned(),
                };
                (format!("it is linked to \"{name}\", and no node has that name"), remedy)
            }
            Some((Some(from), _, output)) => {
                match self.graph.check_link(self.catalogue, from, output, link.to, &link.input) {
                    Ok(()) => {
                        let source = Source::Link(Link { node: from, output: output.to_owned() });
                        self.graph.put(link.to, &link.input, Some(source));
                        return;
                    }
                    // Said already, at the input.
                    Err(ConnectError::NoSuchInput { .. }) if known_input == Some(false) => {
                        self.graph.put(link.to, &link.input, Some(Source::Unread(link.raw.to_owned())));
                        return;
                    }
                    Err(error @ ConnectError::Cycle(_)) => {
                        (error.to_string(), "remove one of its links".to_owned())
                    }
                    Err(error) => (error.to_string(), "link another output".to_owned()),
                }
            }
        };
        self.error(at, Some(&node), Some(&link.input), message, &remedy);
        self.graph.put(link.to, &link.input, Some(Source::Unread(link.raw.to_owned())));
    }

    fn layout(&mut self, tree: &FileTree<'a>) {
        for (name, raw) in tree.layout.iter().flat_map(|entries| &entries.0) {
            let piece = trimmed(raw);
            let name = self.string(name, "a node's name");
            let position = ron::from_str::<(f64, f64)>(piece).ok().filter(|p| p.0.is_finite() && p.1.is_finite());
            match (self.graph.find(&name), position) {
                (Some(id), Some((x, y))) => {
                    if let Some(node) = self.graph.nodes.get_mut(&id) {
                        node.position = Some([x, y]);
                    }
                }
                (found, _) => {
                    self.graph.unknown_layout.push((name.clone(), piece.to_owned()));
                    let message = match found {
                        None => format!("the layout places \"{name}\", and no node has that name"),
                        Some(_) => format!("the layout of \"{name}\" is not two numbers (x, y)"),
                    };
                    let at = self.offset(piece);
                    self.report(Severity::Warning, at, None, None, [message, "it is kept".to_owned()]);
                }
            }
        }
    }
}
