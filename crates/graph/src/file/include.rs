//! Files within files: the graphs that nodes of a graph have as their bodies.

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use crate::body::{DEEPEST, folder_of};
use crate::catalogue::Catalogue;
use crate::file::limit::{MOST_PROBLEM_BYTES, MOST_PROBLEMS, Meter, quoted_in_message};
use crate::file::read::{Read, read_file, utf8};
use crate::file::{FileError, Problem, Severity};
use crate::graph::Graph;

/// How a loader gets the files that a graph includes. The engine reads no file of its own accord.
///
/// ```
/// use std::path::Path;
/// use maquette_graph::file::Includes;
/// let folder = Path::new("graphs");
/// let read = |path: &Path| std::fs::read(folder.join(path)).map_err(|error| error.to_string());
/// let includes = Includes::new("character.ron", &read);
/// # let _ = includes;
/// ```
pub struct Includes<'a> {
    own: &'a str,
    read: &'a (dyn Fn(&Path) -> Result<Vec<u8>, String> + 'a),
}

fn no_folder(_: &Path) -> Result<Vec<u8>, String> {
    Err("this graph was read without a folder, so that no other file can be found".to_owned())
}

impl<'a> Includes<'a> {
    /// Reads included files with `read`, which gets each path as seen from the folder of the graph, and says in words for
    /// artists why a file can't be read. `own` is the name of the graph's own file in that folder, so that it is noticed
    /// when it includes itself; it may be empty.
    pub fn new(own: &'a str, read: &'a (dyn Fn(&Path) -> Result<Vec<u8>, String> + 'a)) -> Self {
        Self { own, read }
    }

    /// Reads no other file.
    pub fn none() -> Self {
        Self { own: "", read: &no_folder }
    }
}

/// Where a graph stands that is being read.
pub(super) struct Standing {
    /// Its file, where that is an included one.
    pub(super) file: Option<String>,
    /// Folder of its file, seen from the outermost graph's.
    pub(super) folder: String,
    /// Names of the nodes within its file that lead to it, each with a slash behind.
    path: String,
    /// The files that lead to it, each including the next.
    chain: Vec<String>,
    depth: usize,
}

impl Standing {
    pub(super) fn of_root(includes: &Includes<'_>) -> Self {
        let chain = if includes.own.is_empty() { Vec::new() } else { vec![plain(includes.own)] };
        Self { file: None, folder: String::new(), path: String::new(), chain, depth: 0 }
    }

    /// That of the body embedded in a node.
    pub(super) fn within(&self, node: &str) -> Self {
        Self {
            file: self.file.clone(),
            folder: self.folder.clone(),
            path: format!("{}{}/", self.path, quoted_in_message(node)),
            chain: self.chain.clone(),
            depth: self.depth + 1,
        }
    }

    pub(super) fn is_embedded(&self) -> bool {
        !self.path.is_empty()
    }

    pub(super) fn is_deepest(&self) -> bool {
        self.depth >= DEEPEST
    }

    /// The path of a node; that of the graph itself where none is given.
    pub(super) fn path_of(&self, node: Option<&str>) -> Option<String> {
        match node {
            Some(node) => Some(format!("{}{node}", self.path)),
            None => self.path.strip_suffix('/').map(str::to_owned),
        }
    }
}

/// The files read so far. Each is read once, however many nodes have it as their body.
pub(super) struct Inclusion<'a> {
    pub(super) catalogue: &'a Catalogue,
    includes: &'a Includes<'a>,
    /// `None` for a file that can't be read.
    files: RefCell<BTreeMap<String, Option<Arc<Graph>>>>,
    problems: RefCell<Vec<Problem>>,
    /// What all files together ask for.
    pub(super) meter: Meter,
    /// How many problems there are, and the bytes that they take.
    said: Cell<[usize; 2]>,
    /// Errors and warnings that are not listed, because there are too many.
    left_out: Cell<[usize; 2]>,
}

impl<'a> Inclusion<'a> {
    pub(super) fn new(catalogue: &'a Catalogue, includes: &'a Includes<'a>) -> Self {
        Self {
            catalogue,
            includes,
            files: RefCell::default(),
            problems: RefCell::default(),
            meter: Meter::default(),
            said: Cell::default(),
            left_out: Cell::default(),
        }
    }

    /// Whether one more problem may be listed; what may not is counted.
    pub(super) fn has_room_for(&self, problem: &Problem) -> bool {
        let Problem { file, node, port, message, remedy, .. } = problem;
        let names = [file, node, port].map(|name| name.as_ref().map_or(0, String::len));
        let [count, bytes] = self.said.get();
        let bytes = bytes + size_of::<Problem>() + message.len() + remedy.len() + names.iter().sum::<usize>();
        if count >= MOST_PROBLEMS || bytes > MOST_PROBLEM_BYTES {
            let mut left_out = self.left_out.get();
            left_out[usize::from(problem.severity != Severity::Error)] += 1;
            self.left_out.set(left_out);
            return false;
        }
        self.said.set([count + 1, bytes]);
        true
    }

    /// Says how many problems are not listed.
    pub(super) fn left_out(&self) -> Vec<Problem> {
        let counts = [Severity::Error, Severity::Warning].into_iter().zip(self.left_out.get());
        let said = counts.filter(|(_, count)| *count > 0).map(|(severity, count)| Problem {
            severity,
            file: None,
            line: 1,
            column: 1,
            node: None,
            port: None,
            message: format!("{count} more of this kind are not listed"),
            remedy: "mend what is listed first".to_owned(),
        });
        said.collect()
    }

    pub(super) fn read(&self, text: &str, standing: &Standing) -> Result<Read, FileError> {
        read_file(self, text, standing)
    }

    /// The problems of included files, and the names of these.
    pub(super) fn finish(self) -> (Vec<Problem>, Vec<String>) {
        (self.problems.into_inner(), self.files.into_inner().into_keys().collect())
    }

    /// The graph of a file; `path` is seen from the outermost graph's folder.
    ///
    /// # Errors
    /// Why there is none. What is wrong within the file is among the problems.
    pub(super) fn include(&self, path: &str, from: &Standing) -> Result<Arc<Graph>, String> {
        let path = plain(path);
        if let Some(place) = from.chain.iter().position(|file| *file == path) {
            let around: Vec<_> = from.chain[place..].iter().chain([&path]).map(String::as_str).collect();
            return Err(format!("the file {path} includes itself: {}", around.join(" -> ")));
        }
        if from.is_deepest() {
            return Err(format!("bodies are nested more than {DEEPEST} deep"));
        }
        if let Some(known) = self.files.borrow().get(&path) {
            return known.clone().ok_or_else(|| format!("the file {path} can't be read"));
        }
        let graph = self.load(&path, from);
        self.files.borrow_mut().insert(path, graph.as_ref().ok().cloned());
        graph
    }

    fn load(&self, path: &str, from: &Standing) -> Result<Arc<Graph>, String> {
        let bytes = (self.includes.read)(Path::new(path)).map_err(|reason| format!("the file {path}: {reason}"))?;
        let mut chain = from.chain.clone();
        chain.push(path.to_owned());
        let standing = Standing {
            file: Some(path.to_owned()),
            folder: folder_of(path).to_owned(),
            path: String::new(),
            chain,
            depth: from.depth + 1,
        };
        match utf8(&bytes).and_then(|text| self.read(text, &standing)) {
            Ok(Read { graph, mut problems, .. }) => {
                problems.sort_by_key(|p| (p.line, p.column));
                self.problems.borrow_mut().append(&mut problems);
                Ok(Arc::new(graph))
            }
            Err(error) => {
                self.problems.borrow_mut().push(Problem::of_file(path, &error));
                Err(format!("the file {path} can't be read"))
            }
        }
    }
}

/// The path without `.`, and without `..` as far as it can be seen, so that a file has one name.
fn plain(path: &str) -> String {
    let mut parts: Vec<&str> = Vec::new();
    let path = path.replace('\\', "/");
    for part in path.split('/') {
        match part {
            "." => {}
            "" if !parts.is_empty() => {}
            ".." if parts.last().is_some_and(|last| !matches!(*last, ".." | "")) => drop(parts.pop()),
            _ => parts.push(part),
        }
    }
    parts.join("/")
}

#[cfg(test)]
mod tests {
    use super::plain;

    #[test]
    fn a_file_has_one_name() {
        for (spelled, name) in [
            ("a.ron", "a.ron"),
            ("./a.ron", "a.ron"),
            ("b/../a.ron", "a.ron"),
            ("b/./c//a.ron", "b/c/a.ron"),
            ("../a.ron", "../a.ron"),
            ("b/../../a.ron", "../a.ron"),
            ("b\\a.ron", "b/a.ron"),
            ("/b/../a.ron", "/a.ron"),
            ("/../a.ron", "/../a.ron"),
        ] {
            assert_eq!(plain(spelled), name);
        }
    }
}
