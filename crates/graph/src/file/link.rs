//! Links of a file: resolved when all nodes are there.

use std::collections::HashMap;

use ron::value::RawValue;

use crate::catalogue::closest;
use crate::file::read::Reader;
use crate::file::tree::trimmed;
use crate::graph::{ConnectError, Link, NodeId, Source};

/// A link as the file has it.
pub(super) struct PendingLink<'a> {
    pub(super) to: NodeId,
    pub(super) input: String,
    pub(super) address: String,
    pub(super) raw: &'a RawValue,
}

/// Similar names, found once for each misspelt name and not for too many of them: every search compares all names.
pub(super) struct Suggestions {
    known: HashMap<String, Option<String>>,
    left: usize,
}

impl Default for Suggestions {
    fn default() -> Self {
        Self { known: HashMap::new(), left: 100 }
    }
}

impl Suggestions {
    fn get(&mut self, name: &str, search: impl FnOnce() -> Option<String>) -> Option<String> {
        if let Some(known) = self.known.get(name) {
            return known.clone();
        }
        self.left = self.left.checked_sub(1)?;
        let found = search();
        self.known.insert(name.to_owned(), found.clone());
        found
    }
}

impl<'a> Reader<'a> {
    pub(super) fn connect_all(&mut self, links: &[PendingLink<'a>]) {
        let sound: Vec<_> = links.iter().filter_map(|link| Some((link, self.resolve(link)?))).collect();
        let harmless = self.graph.harmless(sound.iter().map(|(link, from)| (from.node, link.to)));
        // What can't close a cycle goes first, so that the others are asked in the order of the file.
        let (others, free): (Vec<_>, Vec<_>) = sound.into_iter().zip(harmless).partition(|(_, harmless)| !harmless);
        for ((link, from), _) in free {
            self.graph.put(link.to, &link.input, Some(Source::Link(from)));
        }
        for ((link, from), _) in others {
            match self.graph.check_acyclic(from.node, link.to) {
                Ok(()) => drop(self.graph.put(link.to, &link.input, Some(Source::Link(from)))),
                Err(error) => self.refuse(link, error.to_string(), "remove one of its links"),
            }
        }
    }

    /// The node and output that an address such as `node.output` means, or what is wrong with it, and what to do.
    pub(super) fn addressed<'b>(&mut self, address: &'b str) -> Result<(NodeId, &'b str, &'b str), (String, String)> {
        // A node's name holds no dot, unless it was misspelt so; then the output is what comes behind the last one.
        let by_name = address.split_once('.').and_then(|(name, output)| Some((self.find(name)?, name, output)));
        let by_last = || address.rsplit_once('.').and_then(|(name, output)| Some((self.find(name)?, name, output)));
        if let Some(found) = by_name.or_else(by_last) {
            return Ok(found);
        }
        let Some((name, _)) = address.rsplit_once('.') else {
            return Err((format!("\"{address}\" is not an address"), "write Link(\"node.output\")".to_owned()));
        };
        let graph = &self.graph;
        let remedy = match self.suggestions.get(name, || graph.suggest(name).map(str::to_owned)) {
            Some(suggestion) => format!("did you mean \"{suggestion}\"?"),
            None => "add the node, or remove the link".to_owned(),
        };
        Err((format!("it is linked to \"{name}\", and no node has that name"), remedy))
    }

    /// The output that a link comes from, where it exists and fits. Otherwise reports why not, and keeps the text.
    fn resolve(&mut self, link: &PendingLink<'a>) -> Option<Link> {
        let address = link.address.as_str();
        let (node, name, output) = match self.addressed(address) {
            Ok(found) => found,
            Err((message, remedy)) => {
                self.refuse(link, message, &remedy);
                return None;
            }
        };
        match self.graph.check_ports(self.catalogue, node, output, link.to, &link.input) {
            Ok(()) => return Some(Link { node, output: output.to_owned() }),
            // Said already, at the input.
            Err(ConnectError::NoSuchInput { .. }) => self.keep(link),
            Err(error) => {
                let suggestion = match &error {
                    ConnectError::NoSuchOutput { known, .. } => closest(output, known.iter().map(String::as_str)),
                    _ => None,
                };
                let remedy = match suggestion {
                    Some(output) => format!("did you mean \"{name}.{output}\"?"),
                    None => "link another output".to_owned(),
                };
                self.refuse(link, error.to_string(), &remedy);
            }
        }
        None
    }

    fn refuse(&mut self, link: &PendingLink<'a>, message: String, remedy: &str) {
        let node = self.graph.node(link.to).map(|n| n.name().to_owned());
        let at = self.offset(trimmed(link.raw));
        self.error(at, node.as_deref(), Some(&link.input), message, remedy);
        self.keep(link);
    }

    fn keep(&mut self, link: &PendingLink<'a>) {
        self.graph.put(link.to, &link.input, Some(Source::Unread(trimmed(link.raw).to_owned())));
    }
}
