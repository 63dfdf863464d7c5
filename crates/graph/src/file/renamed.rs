//! Old names and defaults, replaced while a file is read. Each replacement leaves a note, and the place in the text.

use std::sync::Arc;

use ron::value::RawValue;

use crate::file::Severity;
use crate::file::limit::quoted_in_message;
use crate::file::link::PendingLink;
use crate::file::migrate::Rewrite;
use crate::file::read::Reader;
use crate::file::tree::{FileTree, NodeTree, trimmed};
use crate::file::write::{quoted, spelled_literal};
use crate::graph::NodeId;
use crate::node_kind::NodeKind;

impl<'a> Reader<'a> {
    pub(super) fn note(&mut self, at: usize, node: Option<&str>, port: Option<&str>, message: String) {
        self.report(Severity::Note, at, node, port, [message, "maquette migrate rewrites the file".to_owned()]);
    }

    fn rewrite(&mut self, piece: &str, text: String) {
        let start = self.offset(piece);
        self.rewrites.push(Rewrite { start, end: start + piece.len(), text });
    }

    /// The name that the kind has today.
    pub(super) fn kind_now(&mut self, kind: String, raw: Option<&'a RawValue>, node: &str) -> String {
        let Some((now, raw)) = self.catalogue.kind_now(&kind).zip(raw) else { return kind };
        let now = now.to_owned();
        let piece = trimmed(raw);
        self.note(self.offset(piece), Some(node), None, format!("the kind \"{kind}\" is called \"{now}\" today"));
        self.rewrite(piece, quoted(&now));
        now
    }

    /// The name that the input has today, unless the file has that one too.
    pub(super) fn input_now(&mut self, id: NodeId, node: &str, input: String, raw: &'a RawValue) -> String {
        let kind = self.graph.node(id).and_then(|n| n.kind().cloned());
        let now = kind.as_ref().and_then(|kind| kind.current_input(&input)).map(|spec| spec.name.clone());
        let Some(now) = now.filter(|now| *now != input && !self.inputs.contains_key(now)) else { return input };
        let piece = trimmed(raw);
        let message = format!("the input is called \"{now}\" today");
        self.note(self.offset(piece), Some(node), Some(&input), message);
        self.rewrite(piece, quoted(&now));
        now
    }

    /// The name that an option has today.
    pub(super) fn option_now(
        &mut self,
        kind: &Arc<NodeKind>,
        node: &str,
        input: &str,
        option: String,
        piece: &str,
    ) -> String {
        let Some(now) = kind.option_now(input, &option) else { return option };
        let message = format!("the option \"{option}\" is called \"{now}\" today");
        self.note(self.offset(piece), Some(node), Some(input), message);
        self.rewrite(piece, format!("Choice({})", quoted(now)));
        now.to_owned()
    }

    /// The name that the output has today from which a link comes.
    pub(super) fn output_now(&mut self, link: &PendingLink<'a>, from: NodeId, name: &str, output: &str) -> String {
        let kind = self.graph.node(from).and_then(|n| n.kind().cloned());
        let kind = kind.filter(|kind| kind.find_output(output).is_none());
        let now = kind.as_ref().and_then(|kind| kind.current_output(output));
        let Some(now) = now.map(|spec| spec.name.clone()) else { return output.to_owned() };
        let node = self.graph.node(link.to).map(|n| n.name().to_owned());
        let piece = trimmed(link.raw);
        let message = format!("the output \"{output}\" of \"{name}\" is called \"{now}\" today");
        self.note(self.offset(piece), node.as_deref(), Some(&link.input), message);
        self.rewrite(piece, format!("Link({})", quoted(&format!("{name}.{now}"))));
        now
    }

    /// Which versions of kinds the file was written with.
    pub(super) fn read_kind_versions(&mut self, tree: &FileTree<'a>) {
        for (name, raw) in tree.kinds.iter().flat_map(|kinds| &kinds.0) {
            let piece = trimmed(raw);
            let kind = ron::from_str::<String>(trimmed(name)).ok();
            match kind.zip(ron::from_str::<u32>(piece).ok()) {
                Some((kind, version)) => {
                    match self.catalogue.kind(self.catalogue.kind_now(&kind).unwrap_or(&kind)) {
                        None => drop(self.graph.unknown_kinds.insert(kind.clone(), version)),
                        Some(known) if version > known.version() => {
                            let (here, kind) = (known.version(), quoted_in_message(&kind));
                            let message = format!(
                                "the file was written with version {version} of {kind}, and this \
                                                   Maquette has {here}: what is not written may mean something else"
                            );
                            self.warning(self.offset(piece), None, message, "update Maquette");
                        }
                        Some(_) => {}
                    }
                    // A kind that was renamed since goes by its name of today.
                    let kind = self.catalogue.kind_now(&kind).map_or(kind.clone(), str::to_owned);
                    self.kind_versions.insert(kind, version);
                }
                None => {
                    let at = self.offset(piece);
                    let message = "this is no version of a kind, such as \"resample\": 2".to_owned();
                    self.error(at, None, None, message, "write one, or remove the entry; it is not kept");
                }
            }
        }
    }

    /// Inputs that hold their default today, and held another one when the file was written.
    pub(super) fn former_defaults(&mut self, id: NodeId, node: &str, tree: &NodeTree<'a>, name_at: usize) {
        let Some(kind) = self.graph.node(id).and_then(|n| n.kind().cloned()) else { return };
        let written_with = self.kind_versions.get(kind.name()).copied().unwrap_or(1);
        for former in kind.former_defaults() {
            let Some(spec) = kind.inputs().get(former.input) else { continue };
            if written_with > former.until || self.inputs.contains_key(&spec.name) {
                continue;
            }
            let spelled = spelled_literal(&former.literal);
            let message =
                format!("nothing stands here, which meant {spelled} in version {} of {}", former.until, kind.name());
            self.note(name_at, Some(node), Some(&spec.name), message);
            // The catalogue has made sure that it fits.
            if self.graph.set(id, &spec.name, former.literal.clone()).is_err() {
                continue;
            }
            self.inputs.insert(spec.name.clone(), None);
            let entry = format!("{}: {spelled}", quoted(&spec.name));
            let first = tree.inputs.as_ref().and_then(|inputs| inputs.0.first());
            let behind_kind = tree.kind.map(|raw| self.offset(trimmed(raw)) + trimmed(raw).len());
            if let Some((first, _)) = first {
                let start = self.offset(trimmed(first));
                self.rewrites.push(Rewrite { start, end: start, text: format!("{entry}, ") });
            } else if let (None, Some(start)) = (&tree.inputs, behind_kind) {
                // Several go into one field.
                match self.rewrites.iter_mut().find(|r| r.start == start && r.text.starts_with(", inputs: {")) {
                    Some(field) => field.text.insert_str(", inputs: {".len(), &format!("{entry}, ")),
                    None => {
                        let text = format!(", inputs: {{{entry}}}");
                        self.rewrites.push(Rewrite { start, end: start, text });
                    }
                }
            }
        }
    }

    /// The file is to say with which versions it was written, where that matters and it says something else.
    pub(super) fn kind_versions_now(&mut self, tree: &FileTree<'a>) {
        // An embedded body is written with its file.
        if self.standing.is_embedded() {
            return;
        }
        let now = self.graph.kind_versions();
        if self.rewrites.is_empty() || now == self.kind_versions {
            return;
        }
        let entries: Vec<_> = now.iter().map(|(kind, version)| format!("{}: {version}", quoted(kind))).collect();
        let field = format!(", kinds: {{{}}}", entries.join(", "));
        // Beside one that is there already it would be one too many: then the file is written in the stable form.
        if let (None, Some(version)) = (&tree.kinds, tree.version) {
            let start = self.offset(trimmed(version)) + trimmed(version).len();
            self.rewrites.push(Rewrite { start, end: start, text: field });
        }
    }
}
