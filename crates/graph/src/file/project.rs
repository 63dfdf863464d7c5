//! The folder that a graph may read from: a graph from a stranger must not read what it has no business with.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::file::disk::{read_at_most, real, without_dots};
use crate::file::limit::MOST_BYTES;
use crate::one_line::one_line;

/// What the graphs of a project may read: the files below one folder, those that the user named, or everything.
///
/// A path is inside where both what it says and where it leads, when all links are followed, lie below the folder. Paths
/// of another system (`C:\..` where there are no drives) and `..` with either kind of slash are judged alike on every
/// machine. This guards against what a file says, not against somebody who moves files about meanwhile.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Project {
    /// `None` for everywhere.
    root: Option<PathBuf>,
    allowed: BTreeSet<PathBuf>,
}

/// Why a file must not be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the file {} lies outside of the project folder {}: move it there, or widen the project (--project FOLDER), or \
     allow everything (--allow-outside)", shown(.path), shown(.root)
)]
pub struct Outside {
    /// The path as it is written.
    pub path: PathBuf,
    /// The project's folder.
    pub root: PathBuf,
}

fn shown(path: &Path) -> String {
    one_line(&path.display().to_string()).into()
}

impl Project {
    /// Everything below this folder.
    pub fn within(root: impl Into<PathBuf>) -> Self {
        let root = root.into();
        let root = if root.as_os_str().is_empty() { PathBuf::from(".") } else { root };
        Self { root: Some(root), allowed: BTreeSet::new() }
    }

    /// Everything below the folder of a graph's file: what a graph may read unless the user says otherwise.
    pub fn of_graph(path: &Path) -> Self {
        Self::within(path.parent().unwrap_or(Path::new("")))
    }

    /// Every file there is; for graphs that are trusted.
    pub fn anywhere() -> Self {
        Self::default()
    }

    /// The folder; `None` where everything is allowed.
    pub fn root(&self) -> Option<&Path> {
        self.root.as_deref()
    }

    /// Allows one file more: one that the user named, not the graph. It is allowed in the very words in which it is
    /// given here.
    pub fn allow(&mut self, path: impl Into<PathBuf>) {
        self.allowed.insert(path.into());
    }

    /// Whether a file may be read. `path` is what the graph says, behind the folder at which relative paths start.
    ///
    /// # Errors
    /// It may not.
    pub fn check(&self, path: &Path) -> Result<(), Outside> {
        let Some(root) = &self.root else { return Ok(()) };
        if self.allowed.contains(path) || (is_within(root, path) && leads_within(root, path)) {
            return Ok(());
        }
        Err(Outside { path: path.to_owned(), root: without_dots(&std::path::absolute(root).unwrap_or(root.clone())) })
    }

    /// The bytes of a graph that another one includes; at most as many as a graph may have.
    ///
    /// # Errors
    /// It lies outside, or can't be read; in words for artists.
    pub fn read(&self, path: &Path) -> Result<Vec<u8>, String> {
        self.check(path).map_err(|outside| outside.to_string())?;
        let fail = |error: std::io::Error| match error.kind() {
            std::io::ErrorKind::NotFound => format!("the file {} does not exist: correct the path", shown(path)),
            _ => format!("the file {} can't be read: {error}", shown(path)),
        };
        read_at_most(path, MOST_BYTES as u64).map_err(fail)
    }
}

/// Whether the path says so.
fn is_within(root: &Path, path: &Path) -> bool {
    let Ok([root, absolute]) = both(root, path, |p| std::path::absolute(p).map(|p| without_dots(&p))) else {
        return false;
    };
    let Ok(rest) = absolute.strip_prefix(&root) else { return false };
    // What stays of the path below the project's folder must mean the same where '\' divides folders and 'C:' is a
    // drive.
    let rest = rest.to_string_lossy();
    let mut depth = 0_usize;
    for part in rest.split(['/', '\\']) {
        let bytes = part.as_bytes();
        let drive = bytes.len() >= 2 && bytes[1] == b':' && bytes[0].is_ascii_alphabetic();
        depth = match part {
            "" | "." => depth,
            ".." if depth == 0 => return false,
            ".." => depth - 1,
            _ if drive => return false,
            _ => depth + 1,
        };
    }
    !rest.starts_with('\\')
}

/// Whether it leads there.
fn leads_within(root: &Path, path: &Path) -> bool {
    both(root, path, real).is_ok_and(|[root, path]| path.starts_with(root))
}

fn both(root: &Path, path: &Path, ask: impl Fn(&Path) -> std::io::Result<PathBuf>) -> std::io::Result<[PathBuf; 2]> {
    Ok([ask(root)?, ask(path)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_judged_alike_on_every_system() {
        let root = std::env::temp_dir().join("project");
        for inside in ["a.obj", "data/a.obj", "./data/../a.obj", "a/b/../../c", "..a/b..", "...", "a b\\c.txt", "é:x"]
        {
            assert!(is_within(&root, &root.join(inside)), "{inside}");
        }
        for outside in [
            "../a.obj",
            "data/../../a.obj",
            "../project2/a.obj",
            "/etc/passwd",
            "..",
            "..\\a.obj",
            "data\\..\\..\\a.obj",
            "C:\\a.obj",
            "c:a.obj",
            "data/C:/a.obj",
            "\\\\server\\share\\a.obj",
            "\\\\?\\C:\\a.obj",
            "\\a.obj",
            "//server/share/a.obj",
        ] {
            assert!(!is_within(&root, &root.join(outside)), "{outside}");
        }
    }
}
