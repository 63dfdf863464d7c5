//! Bodies of nodes, and what parameters and muting add to a node, from text.

use std::collections::BTreeMap;

use ron::value::RawValue;
use serde::Deserialize;

use crate::body::{Body, BodySource, Repeat, within};
use crate::file::limit::{BODY_PORT, TOO_LARGE};
use crate::file::read::{Read, Reader};
use crate::file::syntax::in_words;
use crate::file::tree::{FileTree, NodeTree, take_apart, trimmed};
use crate::graph::{NodeId, Source};
use crate::interface::InterfaceError;

#[derive(Deserialize)]
enum Tagged {
    File(String),
}

type Kept = Vec<(String, String)>;

impl<'a> Reader<'a> {
    /// Gives a node of a kind with a body its body, and the ports that follow from it.
    pub(super) fn body(&mut self, id: NodeId, node: &str, tree: &NodeTree<'a>, kept: &mut Kept) {
        let kind_name = self.graph.node(id).map_or("", |n| n.kind_name()).to_owned();
        let has_body = self.catalogue.kind(&kind_name).is_some_and(|kind| kind.has_body());
        if !has_body {
            for (field, raw) in [("each", tree.each), ("feed_back", tree.feed_back), ("body", tree.body)] {
                if let Some(raw) = raw {
                    let piece = trimmed(raw);
                    kept.push((field.to_owned(), piece.to_owned()));
                    let message = format!("the field \"{field}\" has no meaning for the kind {kind_name}");
                    self.warning(self.offset(piece), Some(node), message, "it is kept; use the kind graph or repeat");
                }
            }
            return;
        }
        let Some(raw) = tree.body else {
            let at = self.place_of(tree.kind);
            let remedy = "add body: File(\"...\") or body: (nodes: { ... })";
            self.error(at, Some(node), None, "the field \"body\" is missing".to_owned(), remedy);
            return;
        };
        let at = self.place_of(Some(raw));
        let repeat = self.repeat(node, &kind_name, tree, kept);
        let body = self.body_of(node, raw, repeat);
        let mut kind = None;
        let mut said = None;
        match &body {
            // What kept the file from being read is said already.
            Some(body) if body.graph().is_none() => {}
            Some(body) => match body.kind(self.catalogue, &kind_name) {
                // A file that many nodes include costs little, but the ports of each.
                Ok(made) if !self.inclusion.meter.take(BODY_PORT * (made.inputs().len() + made.outputs().len())) => {
                    said = Some(TOO_LARGE.to_owned());
                }
                Ok(made) => kind = Some(made),
                Err(error) => said = Some(error.to_string()),
            },
            None => kept.push(("body".to_owned(), trimmed(raw).to_owned())),
        }
        if let Some(message) = said {
            self.error(at, Some(node), None, message, "");
        }
        if let Some(found) = self.graph.nodes.get_mut(&id) {
            found.body = body.map(std::sync::Arc::new);
            found.set_kind(kind);
        }
    }

    fn place_of(&self, raw: Option<&'a RawValue>) -> usize {
        raw.map_or(0, |raw| self.offset(trimmed(raw)))
    }

    /// The body that a piece of text spells; `None` where it spells none, which is said.
    fn body_of(&mut self, node: &str, raw: &'a RawValue, repeat: Repeat) -> Option<Body> {
        let piece = trimmed(raw);
        let at = self.offset(piece);
        if piece.starts_with("File") {
            let path = match ron::from_str(piece) {
                Ok(Tagged::File(path)) => path,
                Err(error) => {
                    let message = format!("the body can't be read: {}", in_words(&error.code));
                    self.error(at, Some(node), None, message, "write body: File(\"folder/file.ron\")");
                    return None;
                }
            };
            let graph = match self.inclusion.include(&within(&self.standing.folder, &path), self.standing) {
                Ok(graph) => Some(graph),
                Err(reason) => {
                    let message = format!("its body can't be had: {reason}");
                    self.error(at, Some(node), None, message, "");
                    None
                }
            };
            return self.made(at, node, Body::new(BodySource::File(path), graph, repeat));
        }
        let tree: FileTree<'a> = match take_apart(piece, &self.inclusion.meter) {
            Ok(tree) => tree,
            Err(error) => {
                let lines = crate::file::place::LineIndex::new(piece);
                let within = lines.byte(error.span.start.line, error.span.start.col);
                let why = if self.inclusion.meter.is_exceeded() { TOO_LARGE.to_owned() } else { in_words(&error.code) };
                let message = format!("the body can't be read: {why}");
                let remedy = "write body: File(\"...\") or body: (nodes: { ... })";
                self.error(at + within, Some(node), None, message, remedy);
                return None;
            }
        };
        let standing = self.standing.within(node);
        if self.standing.is_deepest() {
            let message = crate::BodyError::TooDeep.to_string();
            self.error(at, Some(node), None, message, "");
            return None;
        }
        let mut reader = Reader::new(self.inclusion, self.text, self.lines, &standing);
        // The body is of the same file, and so of the same time.
        reader.kind_versions.clone_from(&self.kind_versions);
        let Read { graph, mut problems, mut rewrites, .. } = reader.read(&tree);
        self.problems.append(&mut problems);
        self.rewrites.append(&mut rewrites);
        self.made(at, node, Body::new(BodySource::Embedded, Some(std::sync::Arc::new(graph)), repeat))
    }

    fn made(&mut self, at: usize, node: &str, body: Result<Body, crate::BodyError>) -> Option<Body> {
        body.map_err(|error| self.error(at, Some(node), None, error.to_string(), "")).ok()
    }

    /// How often a body is evaluated.
    fn repeat(&mut self, node: &str, kind: &str, tree: &NodeTree<'a>, kept: &mut Kept) -> Repeat {
        let feed_back = tree.feed_back.and_then(|raw| {
            let piece = trimmed(raw);
            let pairs = ron::from_str::<BTreeMap<String, String>>(piece).ok().filter(|_| tree.each.is_none());
            if pairs.is_none() {
                let (message, remedy) = match tree.each {
                    Some(_) => ("\"each\" and \"feed_back\" exclude each other", "remove one of them"),
                    None => {
                        ("the field \"feed_back\" pairs no parameters with outputs", "write { \"curves\": \"curves\" }")
                    }
                };
                self.error(self.offset(piece), Some(node), None, message.to_owned(), remedy);
                kept.push(("feed_back".to_owned(), piece.to_owned()));
            }
            pairs
        });
        match (self.field(tree.each, Some(node), "each", kept), feed_back) {
            (Some(parameter), _) => Repeat::Each(parameter),
            (None, Some(pairs)) => Repeat::FeedBack(pairs),
            (None, None) if kind == crate::body::REPEAT => Repeat::Times,
            (None, None) => Repeat::Once,
        }
    }

    /// A field of a node that is true or false; where it is neither, it goes to those that are kept as they are.
    pub(super) fn flag(&mut self, raw: Option<&'a RawValue>, field: &str, node: &str, kept: &mut Kept) -> bool {
        let Some(raw) = raw else { return false };
        let piece = trimmed(raw);
        ron::from_str(piece).unwrap_or_else(|_| {
            let message = format!("the field \"{field}\" is neither true nor false");
            self.error(self.offset(piece), Some(node), None, message, &format!("write {field}: true, or remove it"));
            kept.push((field.to_owned(), piece.to_owned()));
            false
        })
    }

    /// Lets a parameter drive an input, or says why it can't, and keeps the text.
    pub(super) fn use_parameter(&mut self, id: NodeId, node: &str, input: &str, parameter: &str, piece: &str) {
        let Err(error) = self.graph.use_parameter(self.catalogue, id, input, parameter) else { return };
        self.graph.put(id, input, Some(Source::Unread(piece.to_owned())));
        let remedy = match &error {
            // Said already, at the input.
            InterfaceError::Graph(_) => return,
            InterfaceError::NoSuchParameter { suggestion: None, .. } if self.graph.parameters().len() == 0 => {
                "declare it: parameters: { \"...\": (value: ...) }".to_owned()
            }
            InterfaceError::NoSuchParameter { suggestion: None, .. } => {
                let names: Vec<_> = self.graph.parameters().map(|p| p.name().to_owned()).collect();
                format!("it has {}", names.join(", "))
            }
            InterfaceError::WrongType { .. } => "use another parameter".to_owned(),
            _ => String::new(),
        };
        self.error(self.offset(piece), Some(node), Some(input), error.to_string(), &remedy);
    }
}
