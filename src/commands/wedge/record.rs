//! The record of a wedge: which variants are finished, so that a second call does only what is missing or changed.
//!
//! A line is a variant, in JSON, and is added when its files are written; the cost is the same for the first and the
//! last. A variant counts as finished where a line has its key and the files are still as they were written. The key
//! covers everything that makes the result: the program and the versions of the node kinds, the graph (without layout
//! and notes), the values, the content of the files that are read, and what is asked for. A line that was torn when the
//! program was killed is no JSON and says nothing.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write as _;
use std::path::{Path, PathBuf};

use maquette_graph::ContentHasher;
use serde::{Deserialize, Serialize};

use super::row::{FileRow, Row, State};
use crate::commands::write;

const VERSION: u32 = 1;

#[derive(Serialize, Deserialize, PartialEq)]
struct Head {
    /// Version of this format.
    wedge_record: u32,
}

#[derive(Serialize, Deserialize)]
struct Line {
    key: String,
    row: Row,
}

/// A record that is being continued.
pub(super) struct Record {
    path: PathBuf,
    file: Option<std::fs::File>,
    /// Finished variants by their keys.
    done: BTreeMap<String, Row>,
}

impl Record {
    /// Opens a record, or begins one. `fresh` forgets what is finished. Lines whose files are `mine` to write anew, and
    /// whose keys are not among `keys`, are of an earlier state of the graph and go; those of other wedges stay.
    pub(super) fn open(
        path: &Path,
        fresh: bool,
        keys: &BTreeSet<&str>,
        mine: &BTreeSet<String>,
    ) -> Result<Self, String> {
        let name = path.display();
        let before = match std::fs::read(path) {
            Ok(bytes) => Some(bytes),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => None,
            Err(error) => return Err(format!("{name}: the record can't be read: {error}")),
        };
        let mut lines: BTreeMap<String, Row> = BTreeMap::new();
        for line in before.as_deref().map(|bytes| read(path, bytes)).transpose()?.into_iter().flatten() {
            lines.insert(line.key, line.row);
        }
        lines.retain(|key, row| {
            let current = keys.contains(key.as_str());
            let overwritten = row.files.iter().any(|file| mine.contains(&file.path));
            if current { !fresh } else { !overwritten }
        });
        let mut bytes = json_line(&Head { wedge_record: VERSION })?;
        for (key, row) in &lines {
            bytes.extend(json_line(&Line { key: key.clone(), row: row.clone() })?);
        }
        if before.as_deref() != Some(&bytes) {
            write::whole(path, &bytes)?;
        }
        lines.retain(|key, _| keys.contains(key.as_str()));
        Ok(Self { path: path.to_owned(), file: None, done: lines })
    }

    /// What is known of a variant, where its files are still there as they were written.
    pub(super) fn finished(&self, key: &str) -> Option<Row> {
        let row = self.done.get(key)?;
        row.files.iter().all(is_there).then(|| Row { state: State::Kept, ..row.clone() })
    }

    /// Adds a finished variant.
    pub(super) fn add(&mut self, key: &str, row: &Row) -> Result<(), String> {
        let fail = |error: std::io::Error| format!("{}: the record can't be continued: {error}", self.path.display());
        if self.file.is_none() {
            self.file = Some(std::fs::OpenOptions::new().append(true).open(&self.path).map_err(fail)?);
        }
        let line = json_line(&Line { key: key.to_owned(), row: row.clone() })?;
        // One call, so that a program that is killed leaves all of it or next to nothing.
        self.file.as_mut().map_or(Ok(()), |file| file.write_all(&line)).map_err(fail)
    }
}

fn json_line<T: Serialize>(value: &T) -> Result<Vec<u8>, String> {
    let mut line = serde_json::to_vec(value).map_err(|error| format!("the record can't be written: {error}"))?;
    line.push(b'\n');
    Ok(line)
}

/// The lines that are whole. What is no record is not replaced.
fn read(path: &Path, bytes: &[u8]) -> Result<Vec<Line>, String> {
    let mut lines = bytes.split(|byte| *byte == b'\n');
    let head = lines.next().and_then(|line| serde_json::from_slice::<Head>(line).ok());
    match head {
        Some(head) if head.wedge_record == VERSION => {
            Ok(lines.filter_map(|l| serde_json::from_slice(l).ok()).collect())
        }
        Some(head) => Err(format!(
            "{}: its format has version {}, and this Maquette writes {VERSION}: give another name with --record",
            path.display(),
            head.wedge_record
        )),
        None => Err(format!(
            "{}: the file is there and is no record of a wedge; it is not replaced, give another name with --record",
            path.display()
        )),
    }
}

fn is_there(file: &FileRow) -> bool {
    let same_size = std::fs::metadata(&file.path).is_ok_and(|data| data.len() == file.bytes as u64);
    same_size && std::fs::read(&file.path).is_ok_and(|bytes| ContentHasher::of_bytes(&bytes).to_string() == file.hash)
}

/// The key of what these parts say; each part counts with its length.
pub(super) fn key(parts: &[&str]) -> String {
    let text: String = parts.iter().map(|part| format!("{}:{part}\n", part.len())).collect();
    ContentHasher::of_bytes(text.as_bytes()).to_string()
}

#[cfg(test)]
#[allow(clippy::disallowed_methods, reason = "the files of a test are its own")]
mod tests {
    use super::*;

    fn row(folder: &Path, name: &str) -> Row {
        let path = folder.join(name);
        std::fs::write(&path, name).unwrap();
        let hash = ContentHasher::of_bytes(name.as_bytes()).to_string();
        let mut row = Row::unreached(1, vec![name.to_owned()], State::Done);
        row.files = vec![FileRow { path: path.to_str().unwrap().to_owned(), bytes: name.len(), hash }];
        row
    }

    fn open(path: &Path, keys: &[&str], mine: &[&Row]) -> Record {
        let mine = mine.iter().flat_map(|row| &row.files).map(|file| file.path.clone()).collect();
        Record::open(path, false, &keys.iter().copied().collect(), &mine).unwrap()
    }

    #[test]
    fn a_variant_counts_while_its_files_are_as_they_were_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("wedge.jsonl");
        let (a, b) = (row(folder.path(), "a"), row(folder.path(), "b"));
        let mut record = open(&path, &["ka", "kb"], &[&a, &b]);
        assert_eq!(record.finished("ka"), None);
        record.add("ka", &a).unwrap();
        record.add("kb", &b).unwrap();
        let record = open(&path, &["ka", "kb"], &[&a, &b]);
        assert_eq!(record.finished("ka").unwrap(), Row { state: State::Kept, ..a.clone() });
        std::fs::write(&a.files[0].path, "x").unwrap();
        std::fs::remove_file(&b.files[0].path).unwrap();
        assert_eq!((record.finished("ka"), record.finished("kb"), record.finished("kc")), (None, None, None));
    }

    #[test]
    fn a_torn_line_says_nothing_and_goes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("wedge.jsonl");
        let (a, b) = (row(folder.path(), "a"), row(folder.path(), "b"));
        let mut record = open(&path, &["ka", "kb"], &[&a, &b]);
        record.add("ka", &a).unwrap();
        record.add("kb", &b).unwrap();
        let whole = std::fs::read(&path).unwrap();
        for end in 24..whole.len() {
            std::fs::write(&path, &whole[..end]).unwrap();
            let mut record = open(&path, &["ka", "kb"], &[&a, &b]);
            let known = [record.finished("ka").is_some(), record.finished("kb").is_some()];
            assert!(
                known == [false, false] || known == [true, false] || (known == [true, true] && end + 1 == whole.len()),
                "{end}"
            );
            record.add("kb", &b).unwrap();
            assert!(open(&path, &["ka", "kb"], &[&a, &b]).finished("kb").is_some(), "{end}");
        }
    }

    #[test]
    fn lines_of_other_wedges_stay_and_outdated_ones_go() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("wedge.jsonl");
        let (a, b) = (row(folder.path(), "a"), row(folder.path(), "b"));
        let mut record = open(&path, &["ka"], &[&a]);
        record.add("ka", &a).unwrap();
        // Another wedge into the same folder.
        let mut record = open(&path, &["kb"], &[&b]);
        record.add("kb", &b).unwrap();
        assert!(open(&path, &["ka"], &[&a]).finished("ka").is_some());
        // The same file from a changed graph.
        open(&path, &["ka2"], &[&a]);
        assert!(open(&path, &["ka"], &[]).finished("ka").is_none());
        assert!(open(&path, &["kb"], &[&b]).finished("kb").is_some());
    }

    #[test]
    fn what_is_no_record_is_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("graph.ron");
        std::fs::write(&path, "(version: 1)").unwrap();
        let error = Record::open(&path, true, &BTreeSet::new(), &BTreeSet::new()).err().unwrap();
        assert!(error.contains("is no record of a wedge; it is not replaced"), "{error}");
        assert_eq!(std::fs::read(&path).unwrap(), b"(version: 1)");
    }

    #[test]
    fn keys_tell_apart_what_differs() {
        assert_ne!(key(&["ab", "c"]), key(&["a", "bc"]));
        assert_ne!(key(&["a"]), key(&["a", ""]));
        assert_eq!(key(&["a", "b"]), key(&["a", "b"]));
    }
}
