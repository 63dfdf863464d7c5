//! Files that nodes read.

use std::path::Path;

use maquette_graph::{AtPort, ContentHash, ContentHasher, FilePath, Input, NodeError, Ports};

/// The bytes of the file at an input.
pub(crate) fn read(ports: &Ports<'_>, input: Input<FilePath>) -> Result<Vec<u8>, NodeError> {
    let path = ports.path(input)?;
    std::fs::read(&path).map_err(|error| reason(&path, &error)).at(input)
}

/// Hash of the file's content: what a node that reads it depends on.
pub(crate) fn fingerprint(ports: &Ports<'_>, input: Input<FilePath>) -> Result<ContentHash, NodeError> {
    read(ports, input).map(|bytes| ContentHasher::of_bytes(&bytes))
}

fn reason(path: &Path, error: &std::io::Error) -> String {
    let path = path.display();
    match error.kind() {
        std::io::ErrorKind::NotFound => {
            format!(
                "the file {path} does not exist: put it there, or correct the path (it starts at the graph's folder)"
            )
        }
        _ => format!("the file {path} can't be read: {error}"),
    }
}
