//! Graphs on disk: saved whole or not at all, and read as far as they may be.
//!
//! A file is never written in place. Its new content goes into a file beside it, is brought to the disk, and takes the
//! old one's place in one step, which file systems either do or do not: whatever ends the program, and when, the old or
//! the new file is there, whole. What a killed program leaves beside it, `.maquette-*.tmp`, is taken away by the next
//! save in that folder: it holds a lock on its file as long as it lives, and what nobody holds is nobody's.
//!
//! Links are followed, and permissions kept; owner, extended attributes and other hard links to the old file are not.

use std::fs::{self, File};
use std::io::{self, Read as _, Write as _};
use std::path::{Component, Path, PathBuf};

use tempfile::NamedTempFile;

use crate::catalogue::Catalogue;
use crate::file::limit::MOST_BYTES;
use crate::file::{FileError, Loaded, Outside, Project, from_bytes, to_text};
use crate::graph::Graph;

/// How the names of unfinished files begin and end.
const UNFINISHED: [&str; 2] = [".maquette-", ".tmp"];

/// Why a file was not written. What was there before is there still.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SaveError {
    /// There is nowhere to put it.
    #[error("{}: it can't be written: the folder does not exist; create it first", .0.display())]
    NoFolder(PathBuf),
    /// The file that is there must not be changed.
    #[error("{}: it can't be written: it is protected against writing", .0.display())]
    Protected(PathBuf),
    /// The system refused.
    #[error("{}: it can't be written: {reason}", path.display())]
    Refused {
        /// The file.
        path: PathBuf,
        /// What the system said.
        reason: io::Error,
    },
}

/// Why a graph could not be opened.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OpenError {
    /// It lies where this project must not look.
    #[error("{}: error: {outside}", path.display())]
    Outside {
        /// The file.
        path: PathBuf,
        /// Where it lies.
        outside: Outside,
    },
    /// It is not there.
    #[error("{}: error: there is no such file: check the path", .0.display())]
    Missing(PathBuf),
    /// The system refused.
    #[error("{}: error: it can't be read: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        reason: io::Error,
    },
    /// It is no graph.
    #[error("{}:{reason}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        reason: FileError,
    },
}

/// Saves a graph in the stable form of [`to_text`], whole or not at all: killed at any moment, the old or the new file
/// is there. When it returns, the new one is on the disk.
///
/// # Errors
/// The folder is missing, the file is protected, or the system refuses; what was there is there still.
pub fn save(graph: &Graph, path: &Path) -> Result<(), SaveError> {
    if fs::metadata(path).is_ok_and(|there| there.permissions().readonly()) {
        return Err(SaveError::Protected(path.to_owned()));
    }
    write_whole(path, to_text(graph).as_bytes())
}

/// Writes a file as [`save`] does; one that is there is replaced, even where it is protected against writing.
///
/// # Errors
/// The folder is missing, or the system refuses; what was there is there still.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), SaveError> {
    let target = followed(path);
    let folder = target.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    put(&target, folder, bytes).map_err(|error| {
        if !folder.is_dir() {
            return SaveError::NoFolder(path.to_owned());
        }
        // Without the name of the unfinished file, which means nothing to anybody.
        SaveError::Refused { path: path.to_owned(), reason: error.kind().into() }
    })
}

fn put(target: &Path, folder: &Path, bytes: &[u8]) -> io::Result<()> {
    remove_unfinished(folder);
    let mut file = begun(folder)?;
    file.write_all(bytes)?;
    if let Ok(there) = fs::metadata(target) {
        file.as_file().set_permissions(there.permissions())?;
    }
    file.as_file().sync_all()?;
    file.persist(target)?;
    sync_folder(folder)
}

/// An empty file that is locked, so that no other save takes it for left over.
fn begun(folder: &Path) -> io::Result<NamedTempFile> {
    loop {
        let mut builder = tempfile::Builder::new();
        builder.prefix(UNFINISHED[0]).suffix(UNFINISHED[1]);
        ordinary(&mut builder);
        let file = builder.tempfile_in(folder)?;
        // Where the file system knows no locks, nobody gets one, and nothing is taken for left over.
        let locked = file.as_file().lock().is_ok();
        // Before the lock another save may have taken it away.
        if !locked || file.path().try_exists()? {
            return Ok(file);
        }
    }
}

/// A temporary file is private by default; a result is an ordinary file, as private as the umask says.
#[cfg(unix)]
fn ordinary(builder: &mut tempfile::Builder<'_, '_>) {
    use std::os::unix::fs::PermissionsExt as _;
    builder.permissions(fs::Permissions::from_mode(0o666));
}

#[cfg(not(unix))]
fn ordinary(_: &mut tempfile::Builder<'_, '_>) {}

/// Takes away what killed programs left. Nothing depends on it, so that what can't be taken away stays.
fn remove_unfinished(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let is_ours = name.starts_with(UNFINISHED[0]) && name.ends_with(UNFINISHED[1]);
        if is_ours
            && entry.file_type().is_ok_and(|kind| kind.is_file())
            && let Ok(file) = File::options().write(true).open(entry.path())
            && file.try_lock().is_ok()
        {
            drop(fs::remove_file(entry.path()));
        }
    }
}

/// Brings the folder's new entry to the disk, where the system does that: without it, a power cut may bring the old
/// file back, whole.
#[cfg(unix)]
fn sync_folder(folder: &Path) -> io::Result<()> {
    // A folder may allow writing and not reading, and file systems need not know this.
    let Ok(folder) = File::open(folder) else { return Ok(()) };
    match folder.sync_all() {
        Err(error) if matches!(error.kind(), io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported) => Ok(()),
        other => other,
    }
}

#[cfg(not(unix))]
fn sync_folder(_: &Path) -> io::Result<()> {
    Ok(())
}

/// Where the content goes: the end of a chain of links, even where nothing is there yet.
fn followed(path: &Path) -> PathBuf {
    let mut target = path.to_owned();
    for _ in 0..MOST_LINKS {
        if let Ok(real) = fs::canonicalize(&target) {
            return real;
        }
        match fs::read_link(&target) {
            Ok(link) => target = target.parent().unwrap_or(Path::new("")).join(link),
            Err(_) => return target,
        }
    }
    path.to_owned()
}

/// Opens a graph: reads the file and all that stands in it. What is wrong with it is in [`Loaded::problems`].
///
/// # Errors
/// It lies outside of the project, it can't be read, or nothing in it can be understood.
pub fn open(catalogue: &Catalogue, path: &Path, project: &Project) -> Result<Loaded, OpenError> {
    project.check(path).map_err(|outside| OpenError::Outside { path: path.to_owned(), outside })?;
    let bytes = read_at_most(path, MOST_BYTES as u64).map_err(|reason| match reason.kind() {
        io::ErrorKind::NotFound => OpenError::Missing(path.to_owned()),
        _ => OpenError::Unreadable { path: path.to_owned(), reason },
    })?;
    from_bytes(catalogue, &bytes).map_err(|reason| OpenError::File { path: path.to_owned(), reason })
}

/// The bytes of a file; of one that is longer than `most`, a few more than that and not all of them.
pub(super) fn read_at_most(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    // Before it is opened, because to open a pipe may take forever.
    if !fs::metadata(path)?.is_file() {
        return Err(io::Error::other("it is not a file"));
    }
    let mut bytes = Vec::new();
    File::open(path)?.take(most + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// As many links as Linux follows.
const MOST_LINKS: usize = 40;

/// Where a path leads when all links are followed. What does not exist lies in the folder that would hold it.
pub(super) fn real(path: &Path) -> io::Result<PathBuf> {
    let mut there = std::path::absolute(path)?;
    let mut rest = Vec::new();
    let mut links = 0;
    loop {
        match fs::canonicalize(&there) {
            Ok(real) => return Ok(rest.iter().rev().fold(real, |path, name| path.join(name))),
            Err(error) if error.kind() == io::ErrorKind::NotFound && links < MOST_LINKS => {
                match fs::read_link(&there) {
                    // A link to nowhere leads where it points to, and not where it stands.
                    Ok(link) => {
                        there = there.parent().unwrap_or(Path::new("")).join(link);
                        links += 1;
                    }
                    Err(_) => {
                        let Some(name) = there.file_name().map(ToOwned::to_owned) else { return Err(error) };
                        rest.push(name);
                        there.pop();
                    }
                }
            }
            Err(error) => return Err(error),
        }
    }
}

/// The path without `.` and `..`, as it reads; no link is followed.
pub(super) fn without_dots(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir => drop(plain.pop()),
            other => plain.push(other),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    #[test]
    #[allow(clippy::disallowed_methods, reason = "a test's files are its own")]
    fn what_a_killed_save_left_goes_and_what_one_at_work_holds_stays() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at(".maquette-left.tmp"), "half").unwrap();
        fs::write(at(".maquette-notes"), "not ours").unwrap();
        let at_work = begun(folder.path()).unwrap();
        write_whole(&at("a.ron"), b"new").unwrap();
        assert!(at_work.path().exists());
        drop(at_work);
        assert_eq!(names(folder.path()), [".maquette-notes", "a.ron"]);
    }

    #[test]
    fn the_folder_must_be_there_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.ron");
        save(&Graph::new(), &path).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), to_text(&Graph::new()));
        let nowhere = folder.path().join("no/a.ron");
        let error = save(&Graph::new(), &nowhere).unwrap_err();
        assert!(matches!(error, SaveError::NoFolder(_)), "{error}");
        let mut protected = fs::metadata(&path).unwrap().permissions();
        protected.set_readonly(true);
        fs::set_permissions(&path, protected).unwrap();
        assert!(matches!(save(&Graph::new(), &path), Err(SaveError::Protected(_))));
        assert_eq!(names(folder.path()), ["a.ron"]);
    }

    #[test]
    #[cfg(unix)]
    #[allow(clippy::disallowed_methods, reason = "a test's files are its own")]
    fn links_stay_links_even_to_what_is_not_there_yet() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        symlink("later.ron", at("link")).unwrap();
        symlink("link", at("link to link")).unwrap();
        write_whole(&at("link to link"), b"one").unwrap();
        write_whole(&at("link"), b"two").unwrap();
        assert_eq!(fs::read(at("later.ron")).unwrap(), b"two");
        assert_eq!(names(folder.path()), ["later.ron", "link", "link to link"]);
        assert!(at("link").is_symlink() && at("link to link").is_symlink());
        symlink("round", at("round")).unwrap();
        write_whole(&at("round"), b"three").unwrap();
        assert_eq!(fs::read(at("round")).unwrap(), b"three");
    }
}
