//! Names for copies: "rail", "rail 2", "rail 3".

use std::collections::{BTreeMap, BTreeSet};

use crate::graph::Graph;

/// Longest name of a node in characters, less room for a number.
const LONGEST_STEM: usize = 180;

/// Gives names that are free in a graph, and differ from each other.
pub(super) struct FreshNames<'a> {
    graph: &'a Graph,
    given: BTreeSet<String>,
    /// The number to try next for each stem, so that many copies do not search from the beginning.
    next: BTreeMap<String, u64>,
}

impl<'a> FreshNames<'a> {
    pub(super) fn new(graph: &'a Graph) -> Self {
        Self { graph, given: BTreeSet::new(), next: BTreeMap::new() }
    }

    fn is_free(&self, name: &str) -> bool {
        self.graph.find(name).is_none() && !self.given.contains(name)
    }

    /// The name itself where it is free, or else with a number.
    pub(super) fn give(&mut self, wanted: &str) -> String {
        let name = if self.is_free(wanted) { wanted.to_owned() } else { self.numbered(wanted) };
        self.given.insert(name.clone());
        name
    }

    fn numbered(&mut self, wanted: &str) -> String {
        let numbered = wanted.rsplit_once(' ').and_then(|(stem, number)| {
            // "leg 007" is no copy of ours.
            let plain = !number.starts_with('0') && number.bytes().all(|b| b.is_ascii_digit());
            plain.then(|| Some((stem, number.parse::<u32>().ok()?)))?
        });
        let (stem, number) = numbered.map_or((wanted, 1), |(stem, number)| (stem, u64::from(number)));
        let stem: String = stem.chars().take(LONGEST_STEM).collect();
        let stem = stem.trim_end().to_owned();
        let mut number = self.next.get(&stem).copied().unwrap_or(0).max(number + 1);
        let name = loop {
            let name = format!("{stem} {number}");
            number += 1;
            if self.is_free(&name) {
                break name;
            }
        };
        self.next.insert(stem, number);
        name
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Catalogue, NodeKind};

    #[test]
    fn copies_are_counted() {
        let mut catalogue = Catalogue::new();
        catalogue.register(NodeKind::declare("nothing", 1, "test", "Does nothing.")).unwrap();
        let mut graph = Graph::new();
        let long = "x".repeat(200);
        for name in ["rail", "rail 3", "leg 007", &long, "a 4294967295"] {
            graph.add(&catalogue, "nothing", name).unwrap();
        }
        let mut names = FreshNames::new(&graph);
        let given: Vec<_> = ["rail", "rail", "rail 3", "rail 2", "leg 007", "new", "new", "a 4294967295"]
            .iter()
            .map(|wanted| names.give(wanted))
            .collect();
        let expected = ["rail 2", "rail 4", "rail 5", "rail 6", "leg 007 2", "new", "new 2", "a 4294967296"];
        assert_eq!(given, expected);
        let copy = names.give(&long);
        assert_eq!(copy, format!("{} 2", "x".repeat(LONGEST_STEM)));
        graph.add(&catalogue, "nothing", &copy).unwrap();
    }
}
