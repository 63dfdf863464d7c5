//! What a node gets at its inputs, and the memo key that follows from it.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::catalogue::ConvertFn;
use crate::evaluate::Failure;
use crate::evaluate::file_cache::FileCache;
use crate::evaluate::memo::{Entry, Memo};
use crate::graph::NodeId;
use crate::literal::FilePath;
use crate::node_kind::NodeKind;
use crate::ports::NO_FILE_NAMED;
use crate::value::{ContentHash, Value};

/// Where an input's value comes from.
pub(crate) enum Supply {
    /// Nothing; the input is optional.
    Nothing,
    /// A literal or default.
    Value(Value),
    /// What a parameter holds.
    Given { value: Value, conversion: Option<Arc<ConvertFn>> },
    /// An output of a scheduled node.
    Scheduled { step: usize, output: usize, conversion: Option<Arc<ConvertFn>> },
    /// An output that is known already.
    Known { entry: Arc<Entry>, output: usize, conversion: Option<Arc<ConvertFn>> },
    /// An output that will never be there, because of these nodes.
    Missing(Vec<NodeId>),
}

impl Supply {
    /// The step that gives it.
    pub(crate) fn step(&self) -> Option<usize> {
        if let Self::Scheduled { step, .. } = self { Some(*step) } else { None }
    }
}

/// Under what a result is remembered.
#[derive(Clone, Debug)]
pub(crate) struct Key {
    pub(crate) hash: ContentHash,
    /// The files that the result depends on, where there are any.
    pub(crate) files: Option<Arc<[FileContent]>>,
}

/// A file and the content it had.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct FileContent {
    pub(crate) path: PathBuf,
    pub(crate) hash: ContentHash,
}

/// The content of a file with the index of the input that names it.
pub(crate) type FileBytes = (usize, Arc<[u8]>);

/// The values of all inputs, converted and checked. `scheduled` gives the values of steps.
pub(crate) fn gather(
    kind: &NodeKind,
    supplies: &[Supply],
    scheduled: impl Fn(usize, usize) -> Option<Value>,
) -> Result<Vec<Option<Value>>, Failure> {
    let mut inputs = Vec::with_capacity(supplies.len());
    for (spec, supply) in kind.inputs().iter().zip(supplies) {
        let fail = |message: String| Failure { port: Some(spec.name.clone()), message };
        let (value, conversion) = match supply {
            Supply::Nothing => {
                inputs.push(None);
                continue;
            }
            Supply::Value(value) => {
                inputs.push(Some(value.clone()));
                continue;
            }
            Supply::Given { value, conversion } => (Some(value.clone()), conversion),
            Supply::Scheduled { step, output, conversion } => (scheduled(*step, *output), conversion),
            Supply::Known { entry, output, conversion } => {
                (entry.result.as_ref().ok().and_then(|values| values.get(*output).cloned()), conversion)
            }
            Supply::Missing(_) => (None, &None),
        };
        let Some(mut value) = value else {
            return Err(fail("its value was not there in time; this is a mistake in the engine".to_owned()));
        };
        if let Some(conversion) = conversion {
            value = conversion(&value).map_err(fail)?;
        }
        if let Some(reason) = spec.refuses_value(&value) {
            return Err(fail(reason));
        }
        inputs.push(Some(value));
    }
    Ok(inputs)
}

/// The files that the node reads: each with the index of its input.
fn paths<'a>(
    kind: &'a NodeKind,
    inputs: &'a [Option<Value>],
    base: &'a Path,
) -> impl Iterator<Item = Result<(usize, PathBuf), Failure>> + 'a {
    kind.file_inputs().iter().map(move |&index| {
        let named = inputs.get(index).and_then(|value| value.as_ref()?.get::<FilePath>()).filter(|p| !p.0.is_empty());
        match named {
            Some(path) => Ok((index, base.join(&path.0))),
            None => Err(failure(kind, Some(index), NO_FILE_NAMED.to_owned())),
        }
    })
}

/// Where relative paths start, and what is known of files.
#[derive(Clone, Copy)]
pub(crate) struct Disk<'a> {
    /// The folder of the graph that is evaluated.
    pub(crate) base: &'a Path,
    /// The folder at which paths spelled in the graph of the run start, seen from `base`.
    pub(crate) folder: &'a str,
    pub(crate) cache: &'a FileCache,
}

impl Disk<'_> {
    /// What the memo has for a key, unless files that were read for it changed since. The key learns of the files.
    pub(crate) fn remembered(&self, memo: &Memo, key: &mut Key) -> Option<Arc<Entry>> {
        let entry = memo.get(key.hash)?;
        if let Some(files) = &entry.files {
            if files.iter().any(|file| self.cache.hash(&file.path) != Ok(file.hash)) {
                return None;
            }
            key.files = Some(files.clone());
        }
        Some(entry)
    }
}

/// What the result depends on: kind, version, every input's content, and the content of the files it reads. Which files
/// are read within a body is known afterwards only: the memo's entry has them.
pub(crate) fn key(kind: &NodeKind, inputs: &[Option<Value>], disk: Disk<'_>) -> Result<Key, Failure> {
    let Disk { base, folder, cache } = disk;
    let mut bytes = key_of_kind(kind, inputs.len());
    if kind.has_body() {
        // Paths within mean other files from another folder.
        for place in [base.as_os_str().as_encoded_bytes(), folder.as_bytes()] {
            bytes.extend_from_slice(&(place.len() as u64).to_le_bytes());
            bytes.extend_from_slice(place);
        }
    }
    for input in inputs {
        match input {
            Some(value) => {
                bytes.push(1);
                bytes.extend_from_slice(&value.hash().0.to_le_bytes());
            }
            None => bytes.push(0),
        }
    }
    let mut files = Vec::new();
    for path in paths(kind, inputs, base) {
        let (index, path) = path?;
        let hash = cache.hash(&path).map_err(|reason| failure(kind, Some(index), reason))?;
        bytes.extend_from_slice(&hash.0.to_le_bytes());
        files.push(FileContent { path, hash });
    }
    let files = if files.is_empty() { None } else { Some(files.into()) };
    Ok(Key { hash: crate::ContentHasher::of_bytes(&bytes), files })
}

/// How a key begins.
pub(crate) fn key_of_kind(kind: &NodeKind, inputs: usize) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(kind.name().len() + 32 + 17 * inputs);
    bytes.extend_from_slice(kind.name().as_bytes());
    bytes.push(0);
    bytes.extend_from_slice(&kind.version().to_le_bytes());
    if let Some(content) = kind.content {
        bytes.extend_from_slice(&content.0.to_le_bytes());
    }
    bytes
}

/// The content of the files that the node reads, with the indices of their inputs. A key computed afterwards, in the
/// same evaluation, is that of these very bytes.
pub(crate) fn files(
    kind: &NodeKind,
    inputs: &[Option<Value>],
    base: &Path,
    cache: &FileCache,
) -> Result<Vec<FileBytes>, Failure> {
    let read = |(index, path): (usize, PathBuf)| match cache.bytes(&path) {
        Ok(bytes) => Ok((index, bytes)),
        Err(reason) => Err(failure(kind, Some(index), reason)),
    };
    paths(kind, inputs, base).map(|path| path.and_then(read)).collect()
}

pub(crate) fn failure(kind: &NodeKind, input: Option<usize>, message: String) -> Failure {
    Failure { port: input.and_then(|i| kind.inputs().get(i)).map(|spec| spec.name.clone()), message }
}
