//! Work that is not saved is put aside every few seconds, so that it survives a program that ends suddenly.
//!
//! Each running editor has two files in the recovery folder: one that it holds locked as long as it lives, and one with the
//! document. What has a document and a lock that nobody holds was left behind.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use maquette_graph::file::{to_text, write_whole};
use serde::{Deserialize, Serialize};

use crate::document::Document;

/// How long after a change it is put aside, at most.
const INTERVAL: Duration = Duration::from_secs(5);

/// A document as it was put aside.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Aside {
    /// Its file, where it has one.
    pub(crate) path: Option<PathBuf>,
    /// The graph.
    pub(crate) text: String,
}

/// Work that was left behind.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Left {
    pub(crate) file: PathBuf,
    pub(crate) name: String,
}

/// What one editor puts aside.
pub(crate) struct Recovery {
    /// `None` where there is no folder to write into.
    own: Option<Own>,
    /// What others left behind.
    pub(crate) left: Vec<Left>,
}

struct Own {
    file: PathBuf,
    lock_path: PathBuf,
    /// Held as long as the program lives.
    _lock: File,
    revision: u64,
    at: Instant,
    exists: bool,
}

impl Recovery {
    /// Looks for what was left behind in a folder, and begins to put aside there.
    pub(crate) fn begin(folder: Option<&Path>) -> Self {
        let Some(folder) = folder.filter(|folder| std::fs::create_dir_all(folder).is_ok()) else {
            return Self { own: None, left: Vec::new() };
        };
        let left = left_behind(folder);
        Self { own: Own::new(folder), left }
    }

    /// Puts the document aside where it changed and enough time has passed. Says when to ask again.
    pub(crate) fn tick(&mut self, document: &Document) -> Option<Duration> {
        let own = self.own.as_ref()?;
        if !document.is_changed() || own.revision == document.revision() && own.exists {
            return None;
        }
        let waited = own.at.elapsed();
        if waited < INTERVAL {
            return Some(INTERVAL - waited);
        }
        self.save(document);
        None
    }

    /// Puts the document aside now; says whether it is on the disk.
    pub(crate) fn save(&mut self, document: &Document) -> bool {
        let Some(own) = &mut self.own else { return false };
        let aside = Aside { path: document.path().map(Path::to_owned), text: to_text(document.graph()) };
        let Ok(text) = ron::to_string(&aside) else { return false };
        own.at = Instant::now();
        own.revision = document.revision();
        own.exists = write_whole(&own.file, text.as_bytes()).is_ok();
        own.exists
    }

    /// Takes away what was put aside: it is saved, or given up.
    pub(crate) fn forget(&mut self) {
        if let Some(own) = &mut self.own
            && own.exists
        {
            drop(std::fs::remove_file(&own.file));
            own.exists = false;
        }
    }

    /// Takes everything away: the program ends as it should.
    pub(crate) fn end(&mut self) {
        self.forget();
        if let Some(own) = self.own.take() {
            drop(std::fs::remove_file(&own.lock_path));
        }
    }

    /// Reads what was left behind.
    ///
    /// # Errors
    /// In words: it can't be read.
    pub(crate) fn read(&self, file: &Path) -> Result<Aside, String> {
        read(file).map_err(|reason| format!("{}: it can't be recovered: {reason}", file.display()))
    }

    /// Throws away what was left behind.
    pub(crate) fn discard(&mut self, file: &Path) {
        self.left.retain(|left| left.file != file);
        drop(std::fs::remove_file(file));
        drop(std::fs::remove_file(file.with_extension("lock")));
    }
}

impl Own {
    fn new(folder: &Path) -> Option<Self> {
        // Of several editors in one process each has its own time.
        let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_nanos());
        let stem = format!("{}-{now}", std::process::id());
        let lock_path = folder.join(format!("{stem}.lock"));
        let lock = File::options().write(true).create_new(true).open(&lock_path).ok()?;
        lock.try_lock().ok()?;
        let file = folder.join(format!("{stem}.aside"));
        Some(Self { file, lock_path, _lock: lock, revision: 0, at: Instant::now(), exists: false })
    }
}

fn read(file: &Path) -> Result<Aside, String> {
    let text = std::fs::read_to_string(file).map_err(|error| error.to_string())?;
    ron::from_str(&text).map_err(|error| error.to_string())
}

/// What programs left that live no more; locks without a document are taken away.
fn left_behind(folder: &Path) -> Vec<Left> {
    let mut left = Vec::new();
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let lock_path = entry.path();
        if lock_path.extension().is_none_or(|extension| extension != "lock") {
            continue;
        }
        let held = !File::options().write(true).open(&lock_path).is_ok_and(|lock| lock.try_lock().is_ok());
        if held {
            continue;
        }
        let file = lock_path.with_extension("aside");
        match read(&file) {
            Ok(aside) => {
                let name = aside.path.as_deref().and_then(Path::file_name);
                let name = name.map_or_else(|| "untitled".to_owned(), |name| name.to_string_lossy().into_owned());
                left.push(Left { file, name });
            }
            Err(_) if !file.exists() => drop(std::fs::remove_file(&lock_path)),
            // Perhaps another version can read it.
            Err(_) => {}
        }
    }
    left.sort_by(|a, b| a.file.cmp(&b.file));
    left
}
