//! The files that nodes read: each at most once in an evaluation, and not at all while it is unchanged.
//!
//! Nothing is read that lies outside of the project. In one evaluation a file has one content: what it was when it was
//! first looked at. The hash is always that of the very bytes that a node gets, so that a change while a file is read
//! can't make the memo remember a result under the content of another. Between evaluations only the hash is kept, with
//! what tells a changed file from an unchanged one without reading it: size, time of modification, and on Unix device,
//! inode and time of change.

use std::collections::BTreeMap;
use std::fs::{self, File, Metadata};
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, SystemTime};

use crate::file::Project;
use crate::one_line::one_line;
use crate::value::{ContentHash, ContentHasher};

/// What changes when a file is written.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Stamp {
    size: u64,
    modified: Option<SystemTime>,
    /// Device, inode, and time of change in seconds and nanoseconds; unlike the time of modification, programs can't
    /// set that one back.
    #[cfg(unix)]
    identity: (u64, u64, i64, i64),
}

impl Stamp {
    fn of(metadata: &Metadata) -> Self {
        Self {
            size: metadata.len(),
            modified: metadata.modified().ok(),
            #[cfg(unix)]
            identity: {
                use std::os::unix::fs::MetadataExt as _;
                (metadata.dev(), metadata.ino(), metadata.ctime(), metadata.ctime_nsec())
            },
        }
    }

    /// When the file changed last.
    fn changed(&self) -> Option<SystemTime> {
        #[cfg(unix)]
        {
            let (_, _, seconds, nanoseconds) = self.identity;
            let since_epoch =
                Duration::new(u64::try_from(seconds).unwrap_or(0), u32::try_from(nanoseconds).unwrap_or(0));
            SystemTime::UNIX_EPOCH.checked_add(since_epoch)
        }
        #[cfg(not(unix))]
        {
            self.modified
        }
    }

    /// Whether any later change must change the stamp. File systems note times in steps, so that a file which changed
    /// a moment ago may change again under the same stamp.
    fn is_settled(&self, now: SystemTime) -> bool {
        let Some(changed) = self.changed() else { return false };
        let whole_seconds = changed.duration_since(SystemTime::UNIX_EPOCH).is_ok_and(|since| since.subsec_nanos() == 0);
        // Steps of the clock are 10 ms at most; file systems that note whole seconds may note every other one.
        let step = if whole_seconds { Duration::from_secs(2) } else { Duration::from_millis(100) };
        now.duration_since(changed).is_ok_and(|age| age > step)
    }
}

/// A file that could be read.
#[derive(Debug)]
struct Content {
    /// `None` where the file was read so soon after a change that its stamp says nothing.
    stamp: Option<Stamp>,
    hash: ContentHash,
    /// Until the end of the evaluation.
    bytes: Option<Arc<[u8]>>,
}

#[derive(Debug, Default)]
struct Entry {
    /// The evaluation that looked at the file last.
    looked_at: u64,
    /// `None` before the first look; the error is a message for artists.
    content: Option<Result<Content, String>>,
}

/// What is known of files. Shared by the threads of an evaluation; two of them never read the same file.
#[derive(Debug, Default)]
pub(crate) struct FileCache {
    entries: Mutex<BTreeMap<PathBuf, Arc<Mutex<Entry>>>>,
    evaluation: u64,
    /// What may be read.
    project: Project,
    reads: AtomicUsize,
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    // What they guard is replaced whole.
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl FileCache {
    /// From here on every file is looked at again.
    pub(crate) fn begin(&mut self, project: Project) {
        self.drop_bytes();
        self.project = project;
        self.evaluation += 1;
    }

    /// Lets go of all bytes; hashes stay.
    pub(crate) fn drop_bytes(&mut self) {
        locked(&self.entries).retain(|_, entry| match &mut locked(entry).content {
            Some(Ok(content)) => {
                content.bytes = None;
                true
            }
            Some(Err(_)) | None => false,
        });
    }

    /// Forgets everything.
    pub(crate) fn clear(&mut self) {
        locked(&self.entries).clear();
    }

    /// How often a file was read.
    pub(crate) fn reads(&self) -> usize {
        self.reads.load(Ordering::Relaxed)
    }

    /// Hash of the file's content in this evaluation.
    ///
    /// # Errors
    /// The file can't be read, in words for artists.
    pub(crate) fn hash(&self, path: &Path) -> Result<ContentHash, String> {
        let entry = self.entry(path);
        let mut entry = locked(&entry);
        self.look(&mut entry, path);
        match &entry.content {
            Some(Ok(content)) => Ok(content.hash),
            Some(Err(reason)) => Err(reason.clone()),
            None => Err(String::new()),
        }
    }

    /// The file's content in this evaluation. Afterwards, [`FileCache::hash`] is the hash of these very bytes until
    /// the evaluation ends; before, it may have been one remembered for an unchanged file.
    ///
    /// # Errors
    /// As [`FileCache::hash`].
    pub(crate) fn bytes(&self, path: &Path) -> Result<Arc<[u8]>, String> {
        let entry = self.entry(path);
        let mut entry = locked(&entry);
        self.look(&mut entry, path);
        if let Some(Ok(Content { bytes: None, .. })) = entry.content {
            entry.content = Some(self.read(path));
        }
        match &entry.content {
            Some(Ok(content)) => Ok(content.bytes.clone().unwrap_or_default()),
            Some(Err(reason)) => Err(reason.clone()),
            None => Err(String::new()),
        }
    }

    fn entry(&self, path: &Path) -> Arc<Mutex<Entry>> {
        let mut entries = locked(&self.entries);
        if let Some(entry) = entries.get(path) {
            return entry.clone();
        }
        entries.entry(path.to_owned()).or_default().clone()
    }

    /// Brings the entry up to date, once in an evaluation.
    fn look(&self, entry: &mut Entry, path: &Path) {
        if entry.looked_at == self.evaluation && entry.content.is_some() {
            return;
        }
        entry.looked_at = self.evaluation;
        if let Err(outside) = self.project.check(path) {
            entry.content = Some(Err(outside.to_string()));
            return;
        }
        let unchanged = match (&entry.content, fs::metadata(path)) {
            (Some(Ok(content)), Ok(metadata)) => content.stamp.as_ref() == Some(&Stamp::of(&metadata)),
            _ => false,
        };
        if !unchanged {
            entry.content = Some(self.read(path));
        }
    }

    fn read(&self, path: &Path) -> Result<Content, String> {
        self.try_read(path).map_err(|error| reason(path, &error))
    }

    fn try_read(&self, path: &Path) -> io::Result<Content> {
        // Before it is opened, because to open a pipe may take forever.
        if !fs::metadata(path)?.is_file() {
            return Err(io::Error::other("it is not a file"));
        }
        self.reads.fetch_add(1, Ordering::Relaxed);
        // Time and stamp come first: what changes while the file is read must not count as read.
        let now = SystemTime::now();
        let mut file = File::open(path)?;
        let stamp = Stamp::of(&file.metadata()?);
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes)?;
        let hash = ContentHasher::of_bytes(&bytes);
        Ok(Content { stamp: stamp.is_settled(now).then_some(stamp), hash, bytes: Some(bytes.into()) })
    }
}

fn reason(path: &Path, error: &io::Error) -> String {
    let path = path.display().to_string();
    let path = one_line(&path);
    match error.kind() {
        io::ErrorKind::NotFound => {
            format!(
                "the file {path} does not exist: put it there, or correct the path (it starts at the graph's folder)"
            )
        }
        _ => format!("the file {path} can't be read: {error}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settle() {
        std::thread::sleep(Duration::from_millis(150));
    }

    #[test]
    #[allow(clippy::disallowed_methods, reason = "a test's files are its own")]
    fn an_unchanged_file_is_read_once_and_a_changed_one_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        std::fs::write(&path, "ab").unwrap();
        settle();
        let mut cache = FileCache::default();
        for _ in 0..3 {
            cache.begin(Project::anywhere());
            assert_eq!(cache.hash(&path), Ok(ContentHasher::of_bytes(b"ab")));
        }
        assert_eq!(cache.reads(), 1);
        assert_eq!(cache.bytes(&path).as_deref(), Ok(b"ab".as_slice()), "dropped, so it is read again");
        assert_eq!(cache.bytes(&path).as_deref(), Ok(b"ab".as_slice()));
        assert_eq!(cache.reads(), 2);
        std::fs::write(&path, "cd").unwrap();
        assert_eq!(cache.hash(&path), Ok(ContentHasher::of_bytes(b"ab")), "one content in one evaluation");
        cache.begin(Project::anywhere());
        assert_eq!(cache.hash(&path), Ok(ContentHasher::of_bytes(b"cd")));
        assert_eq!(cache.bytes(&path).as_deref(), Ok(b"cd".as_slice()));
        assert_eq!(cache.reads(), 3, "hash and bytes come from one read");
    }

    #[test]
    #[allow(clippy::disallowed_methods, reason = "a test's files are its own")]
    fn neither_a_change_at_once_nor_one_that_sets_the_time_back_is_missed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        let mut cache = FileCache::default();
        for turn in 0..200_u8 {
            std::fs::write(&path, [turn]).unwrap();
            cache.begin(Project::anywhere());
            assert_eq!(cache.hash(&path), Ok(ContentHasher::of_bytes(&[turn])), "turn {turn}");
        }
        let old = SystemTime::UNIX_EPOCH + Duration::new(1_000_000, 5);
        for content in ["one", "two"] {
            std::fs::write(&path, content).unwrap();
            File::options().write(true).open(&path).unwrap().set_modified(old).unwrap();
            if cfg!(unix) {
                settle();
                cache.begin(Project::anywhere());
                assert_eq!(cache.hash(&path), Ok(ContentHasher::of_bytes(content.as_bytes())));
            }
        }
    }

    #[test]
    #[allow(clippy::disallowed_methods, reason = "a test's files are its own")]
    fn bytes_and_hash_agree_where_the_file_changed_after_the_look() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        std::fs::write(&path, "old").unwrap();
        settle();
        let mut cache = FileCache::default();
        cache.begin(Project::anywhere());
        cache.hash(&path).unwrap();
        cache.begin(Project::anywhere());
        assert_eq!(cache.hash(&path), Ok(ContentHasher::of_bytes(b"old")), "remembered");
        std::fs::write(&path, "new").unwrap();
        assert_eq!(cache.bytes(&path).as_deref(), Ok(b"new".as_slice()));
        assert_eq!(cache.hash(&path), Ok(ContentHasher::of_bytes(b"new")), "of what was handed out");
    }

    #[test]
    fn what_is_no_file_says_so_in_one_line() {
        let folder = tempfile::tempdir().unwrap();
        let mut cache = FileCache::default();
        cache.begin(Project::anywhere());
        assert!(cache.hash(folder.path()).unwrap_err().ends_with("can't be read: it is not a file"));
        let missing = cache.hash(&folder.path().join("a\nb")).unwrap_err();
        assert!(missing.contains("a\\nb does not exist: put it there") && !missing.contains('\n'), "{missing}");
        assert_eq!(cache.reads(), 0);
    }

    #[test]
    fn a_young_stamp_is_not_trusted_and_coarse_clocks_take_longer() {
        let at = |seconds, nanoseconds| SystemTime::UNIX_EPOCH + Duration::new(seconds, nanoseconds);
        #[cfg(unix)]
        let stamp = |seconds, nanoseconds| Stamp { size: 1, modified: None, identity: (1, 1, seconds, nanoseconds) };
        #[cfg(not(unix))]
        let stamp = |seconds: i64, nanoseconds: i64| Stamp {
            size: 1,
            modified: Some(at(seconds.cast_unsigned(), u32::try_from(nanoseconds).unwrap())),
        };
        assert!(!stamp(100, 5).is_settled(at(100, 50_000_000)));
        assert!(stamp(100, 5).is_settled(at(100, 150_000_000)));
        assert!(!stamp(100, 0).is_settled(at(101, 150_000_000)));
        assert!(stamp(100, 0).is_settled(at(103, 0)));
        assert!(!stamp(100, 5).is_settled(at(99, 0)), "from the future");
    }
}
