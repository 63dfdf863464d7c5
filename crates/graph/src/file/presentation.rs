//! Reads frames and reference pictures. What can't be understood is kept as it is.

use ron::value::RawValue;
use serde::de::DeserializeOwned;

use crate::file::read::Reader;
use crate::file::tree::{FileTree, trimmed};
use crate::presentation::{PresentationError, check_frames, check_references};

/// Longest text of all frames or pictures of a graph, bytes: some thousands of them.
const MOST_BYTES: usize = 1 << 20;

impl<'a> Reader<'a> {
    pub(super) fn presentation(&mut self, tree: &FileTree<'a>) {
        let frames = self.list(tree.frames, "frames", check_frames);
        self.graph.frames = frames;
        let references = self.list(tree.references, "references", check_references);
        self.graph.references = references;
    }

    fn list<T: DeserializeOwned>(
        &mut self,
        raw: Option<&'a RawValue>,
        field: &str,
        check: fn(&[T]) -> Result<(), PresentationError>,
    ) -> Vec<T> {
        let Some(raw) = raw else { return Vec::new() };
        let piece = trimmed(raw);
        let wrong = if piece.len() > MOST_BYTES {
            format!("it is longer than {MOST_BYTES} bytes")
        } else {
            match ron::from_str::<Vec<T>>(piece) {
                Ok(list) => match check(&list) {
                    Ok(()) => return list,
                    Err(error) => error.to_string(),
                },
                Err(error) => error.code.to_string(),
            }
        };
        let message = format!("the field \"{field}\" can't be understood: {wrong}");
        // A picture that is not shown keeps nobody from evaluating the graph.
        self.warning(self.offset(piece), None, message, "it is kept as it is; mend it, or update Maquette");
        self.graph.unknown_fields.push((field.to_owned(), piece.to_owned()));
        Vec::new()
    }
}
