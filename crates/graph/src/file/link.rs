//! Links of a file: resolved when all nodes are there.

use std::collections::HashMap;

use ron::value::RawValue;

use crate::catalogue::closest;
use crate::file::limit::quoted_in_message;
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
    /// How many names may still be compared.
    left: usize,
}

impl Default for Suggestions {
    fn default() -> Self {
        Self { known: HashMap::new(), left: 150_000 }
    }
}

impl Suggestions {
    fn get(&mut self, name: &str, names: usize, search: impl FnOnce() -> Option<String>) -> Option<String> {
        if let Some(known) = self.known.get(name) {
            return known.clone();
        }
        self.left = self.left.checked_sub(names)?;
        let found = search();
        self.known.insert(name.to_owned(), found.clone());
        found
    }
}

/// How many links are looked at to find the cycles of a file. Sound files need none of it.
const PATIENCE: usize = 5_000_000;

impl<'a> Reader<'a> {
    pub(super) fn connect_all(&mut self, links: &[PendingLink<'a>]) {
        let sound: Vec<_> = links.iter().filter_map(|link| Some((link, self.resolve(link)?))).collect();
        let harmless = self.graph.harmless(sound.iter().map(|(link, from)| (from.node, link.to)));
        // What can't close a cycle goes first, so that the others are asked in the order of the file.
        let (others, free): (Vec<_>, Vec<_>) = sound.into_iter().zip(harmless).partition(|(_, harmless)| !harmless);
        let free = free.into_iter().map(|((link, from), _)| (link.to, link.input.clone(), from)).collect();
        self.graph.put_links(free);
        let mut patience = PATIENCE;
        for ((link, from), _) in others {
            match self.graph.cycle_closed_by(from.node, link.to, &mut patience) {
                Some(Ok(())) => drop(self.graph.put(link.to, &link.input, Some(Source::Link(from)))),
                Some(Err(error)) => self.refuse(link, error.to_string(), "remove one of its links"),
                None => {
                    patience = 0;
                    let message = "the link may close a cycle; so many links lie on cycles that not all were followed";
                    self.refuse(link, message.to_owned(), "mend the cycles before it, and load the graph again");
                }
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
            let address = quoted_in_message(address);
            return Err((format!("\"{address}\" is not an address"), "write Link(\"node.output\")".to_owned()));
        };
        let graph = &self.graph;
        let remedy = match self.suggestions.get(name, graph.nodes().len(), || graph.suggest(name).map(str::to_owned)) {
            Some(suggestion) => format!("did you mean \"{suggestion}\"?"),
            None => "add the node, or remove the link".to_owned(),
        };
        let name = quoted_in_message(name);
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
        let output = self.output_now(link, node, name, output);
        let output = output.as_str();
        match self.graph.check_ports(self.catalogue, node, output, link.to, &link.input) {
            Ok(()) => return Some(Link { node, output: output.to_owned() }),
            // Said already, at the input.
            Err(ConnectError::NoSuchInput { .. }) => self.keep(link),
            Err(error) => {
                let suggestion = match &error {
                    ConnectError::NoSuchOutput { known, .. } => closest(output, known.iter().map(String::as_str)),
                    _ => None,
                };
                let body = self.graph.node(node).and_then(|node| node.body()?.graph());
                let is_declared = body.is_some_and(|graph| graph.output(output).is_some());
                if is_declared && matches!(error, ConnectError::NoSuchOutput { .. }) {
                    let message =
                        format!("\"{name}\" gives nothing at \"{output}\": what that comes from is not understood");
                    self.refuse(link, message, "see to the graph within");
                    return None;
                }
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
