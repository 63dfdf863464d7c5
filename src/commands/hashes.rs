//! Content hashes of a graph's nodes as a file: equal hashes mean equal results, to the last bit, on every machine.

use std::collections::BTreeMap;
use std::path::Path;

use maquette_graph::{Evaluation, Graph, NodeId};
use serde::{Deserialize, Serialize};

use super::evaluation::Evaluated;
use super::evaluation_order::evaluation_order;

const VERSION: u32 = 1;

/// What `run --hashes` writes and `verify` reads.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Hashes {
    /// Version of this format.
    hashes_version: u32,
    /// The nodes in the order of evaluation.
    pub(super) nodes: Vec<NodeHashes>,
}

/// A node that has a result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct NodeHashes {
    pub(super) name: String,
    pub(super) kind: String,
    /// Version of the kind, which goes up when its results change.
    pub(super) version: u32,
    /// Hash of each output, 32 hexadecimal digits, by its name.
    pub(super) outputs: BTreeMap<String, String>,
}

impl NodeHashes {
    /// The hashes of a node; `None` where it has no result or its values were not kept.
    pub(super) fn of(graph: &Graph, evaluation: &Evaluation, node: NodeId) -> Option<Self> {
        let (found, values) = graph.node(node).zip(evaluation.values(node))?;
        let kind = found.kind()?;
        let outputs = kind.outputs().iter().zip(values).map(|(o, v)| (o.name.clone(), v.hash().to_string())).collect();
        Some(Self { name: found.name().to_owned(), kind: kind.name().to_owned(), version: kind.version(), outputs })
    }

    /// How this one, made here, differs from another, made elsewhere.
    pub(super) fn difference(&self, other: &Self) -> Option<String> {
        if self.kind != other.kind {
            return Some(format!("its kind is {} here and was {} there", self.kind, other.kind));
        }
        if self.version != other.version {
            let (kind, here, there) = (&self.kind, self.version, other.version);
            return Some(format!("{kind} has version {here} here and had {there} there"));
        }
        let names: std::collections::BTreeSet<_> = self.outputs.keys().chain(other.outputs.keys()).collect();
        let shown = |hash: Option<&String>| hash.map_or("nothing", String::as_str).to_owned();
        names.into_iter().find_map(|name| {
            let (here, there) = (self.outputs.get(name), other.outputs.get(name));
            (here != there).then(|| format!("output \"{name}\" is {} here and was {} there", shown(here), shown(there)))
        })
    }
}

impl Hashes {
    /// The hashes of all nodes that were evaluated and have a result.
    pub(super) fn of(evaluated: &Evaluated) -> Self {
        let graph = &evaluated.file.loaded.graph;
        let order = evaluation_order(graph, &evaluated.targets).into_iter();
        let nodes = order.filter_map(|id| NodeHashes::of(graph, &evaluated.evaluation, id)).collect();
        Self { hashes_version: VERSION, nodes }
    }

    /// As the text of a file, a node on four lines.
    pub(super) fn to_text(&self) -> String {
        let mut out = format!("(\n    hashes_version: {},\n    nodes: [\n", self.hashes_version);
        for NodeHashes { name, kind, version, outputs } in &self.nodes {
            out += &format!("        (name: {name:?}, kind: {kind:?}, version: {version}, outputs: {{\n");
            for (output, hash) in outputs {
                out += &format!("            {output:?}: {hash:?},\n");
            }
            out += "        }),\n";
        }
        out += "    ],\n)\n";
        out
    }

    /// Reads a file of hashes.
    pub(super) fn read(path: &Path) -> Result<Self, String> {
        let name = path.display();
        let bytes = std::fs::read(path).map_err(|error| match error.kind() {
            std::io::ErrorKind::NotFound => format!("{name}: error: there is no such file: check the path"),
            _ => format!("{name}: error: it can't be read: {error}"),
        })?;
        let hashes: Self = ron::de::from_bytes(&bytes).map_err(|error| {
            format!("{name}:{error}: error: this is no file of hashes; maquette run GRAPH --hashes {name} writes one")
        })?;
        if hashes.hashes_version != VERSION {
            let found = hashes.hashes_version;
            return Err(format!("{name}: error: its format has version {found}, and this Maquette reads {VERSION}"));
        }
        Ok(hashes)
    }
}

/// Refuses to replace a file that is no file of hashes: a graph, say, where `run --hashes GRAPH` was meant.
pub(super) fn check_place(path: &Path) -> Result<(), String> {
    if path == Path::new("-") || !path.exists() {
        return Ok(());
    }
    let name = path.display();
    Hashes::read(path).map(drop).map_err(|_| {
        format!("error: --hashes {name}: the file is there and holds no hashes; it is not replaced, give another name")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn node(name: &str, hash: &str) -> NodeHashes {
        let outputs = [("curves".to_owned(), hash.to_owned())].into();
        NodeHashes { name: name.to_owned(), kind: "sort".to_owned(), version: 2, outputs }
    }

    #[test]
    fn text_reads_back() {
        let hashes = Hashes { hashes_version: VERSION, nodes: vec![node("a b", "00ff"), node("é-_", "01")] };
        assert_eq!(ron::from_str::<Hashes>(&hashes.to_text()).unwrap(), hashes);
    }

    #[test]
    fn differences_name_kind_version_or_output() {
        let here = node("a", "00");
        assert_eq!(here.difference(&here), None);
        let said = here.difference(&node("a", "01")).unwrap();
        assert_eq!(said, "output \"curves\" is 00 here and was 01 there");
        let other = NodeHashes { kind: "join".to_owned(), ..here.clone() };
        assert_eq!(here.difference(&other).unwrap(), "its kind is sort here and was join there");
        let other = NodeHashes { version: 1, ..here.clone() };
        assert_eq!(here.difference(&other).unwrap(), "sort has version 2 here and had 1 there");
        let other = NodeHashes { outputs: BTreeMap::new(), ..here.clone() };
        assert_eq!(here.difference(&other).unwrap(), "output \"curves\" is 00 here and was nothing there");
    }
}
