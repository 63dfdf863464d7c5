//! The document: a graph, how it came to be, and where it lies. The one part of the editor's state that is saved and undone.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use maquette_graph::file::{self, Includes, MOST_BYTES, Problem, Project, SaveError};
use maquette_graph::{Catalogue, Edit, EditError, Graph, History, NodeId};

/// Which files the graphs of this session may read, as the user said when starting the program.
#[derive(Clone, Debug, Default)]
pub struct ProjectChoice {
    /// The project's folder; `None` for the folder of each graph.
    pub root: Option<PathBuf>,
    /// Whether a graph may read any file.
    pub anywhere: bool,
}

impl ProjectChoice {
    fn of(&self, folder: &Path) -> Project {
        match &self.root {
            _ if self.anywhere => Project::anywhere(),
            Some(root) => Project::within(root),
            None => Project::within(folder),
        }
    }
}

/// Why a file could not be opened.
#[derive(Debug, thiserror::Error)]
pub enum OpenError {
    /// It is not there, or can't be read.
    #[error("{}: it can't be opened: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why, and what to do.
        reason: String,
    },
    /// It is no graph.
    #[error("{}:{reason}", path.display())]
    NoGraph {
        /// The file.
        path: PathBuf,
        /// Where and why.
        reason: file::FileError,
    },
}

/// Why a document was not saved.
#[derive(Debug, thiserror::Error)]
pub enum DocumentSaveError {
    /// It has no file yet.
    #[error("the graph has no file yet: choose one with Save as")]
    NoFile,
    /// The file was not written.
    #[error(transparent)]
    Save(#[from] SaveError),
}

/// A graph that is being edited.
#[derive(Debug)]
pub struct Document {
    graph: Graph,
    history: History,
    path: Option<PathBuf>,
    problems: Vec<Problem>,
    choice: ProjectChoice,
    /// Goes up with every change.
    revision: u64,
    /// When the file was last written, as this document knows it.
    written: Option<SystemTime>,
    /// Whether it holds work that no file has, apart from what its history says: it was recovered.
    recovered: bool,
}

impl Document {
    /// An empty document without a file.
    pub fn new(choice: ProjectChoice) -> Self {
        Self::of(Graph::new(), None, Vec::new(), choice)
    }

    fn of(graph: Graph, path: Option<PathBuf>, problems: Vec<Problem>, choice: ProjectChoice) -> Self {
        let written = path.as_deref().and_then(written_at);
        Self { graph, history: History::new(), path, problems, choice, revision: 0, written, recovered: false }
    }

    /// Opens a file. What is wrong with it is in [`Document::problems`]; what is not understood stays as it is.
    ///
    /// # Errors
    /// The file can't be read, or is no graph at all.
    pub fn open(catalogue: &Catalogue, path: &Path, choice: ProjectChoice) -> Result<Self, OpenError> {
        let unreadable = |reason: String| OpenError::Unreadable { path: path.to_owned(), reason };
        let bytes = read_at_most(path).map_err(|error| match error.kind() {
            std::io::ErrorKind::NotFound => unreadable("there is no such file; check the path".to_owned()),
            _ => unreadable(error.to_string()),
        })?;
        Self::read(catalogue, &bytes, path, choice)
    }

    fn read(catalogue: &Catalogue, bytes: &[u8], path: &Path, choice: ProjectChoice) -> Result<Self, OpenError> {
        let folder = folder_of(path);
        let project = choice.of(folder);
        let read = |included: &Path| project.read(&folder.join(included));
        let own = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let loaded = file::from_bytes_with(catalogue, bytes, &Includes::new(&own, &read))
            .map_err(|reason| OpenError::NoGraph { path: path.to_owned(), reason })?;
        Ok(Self::of(loaded.graph, Some(path.to_owned()), loaded.problems, choice))
    }

    /// A document without a file, from text of this program.
    ///
    /// # Errors
    /// The text is no graph.
    pub(crate) fn sample(catalogue: &Catalogue, text: &str, choice: ProjectChoice) -> Result<Self, OpenError> {
        let mut document = Self::read(catalogue, text.as_bytes(), Path::new("sample.ron"), choice)?;
        document.path = None;
        document.written = None;
        Ok(document)
    }

    /// A document from text that was saved for a recovery; it counts as changed until it is saved.
    ///
    /// # Errors
    /// The text is no graph.
    pub fn recover(
        catalogue: &Catalogue,
        text: &str,
        path: Option<&Path>,
        choice: ProjectChoice,
    ) -> Result<Self, OpenError> {
        let mut document = Self::read(catalogue, text.as_bytes(), path.unwrap_or(Path::new("recovered.ron")), choice)?;
        document.path = path.map(Path::to_owned);
        document.written = path.and_then(written_at);
        document.recovered = true;
        Ok(document)
    }

    /// The graph.
    pub fn graph(&self) -> &Graph {
        &self.graph
    }

    /// The steps that led to it.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Its file.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// What is wrong with the file it was read from.
    pub fn problems(&self) -> &[Problem] {
        &self.problems
    }

    /// A number that goes up with every change.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Where relative paths start.
    pub fn folder(&self) -> PathBuf {
        folder_of(self.path.as_deref().unwrap_or(Path::new(""))).to_owned()
    }

    /// Which files it may read.
    pub fn project(&self) -> Project {
        self.choice.of(&self.folder())
    }

    /// What the title says.
    pub fn name(&self) -> String {
        let name = self.path.as_deref().and_then(Path::file_name);
        name.map_or_else(|| "untitled".to_owned(), |name| name.to_string_lossy().into_owned())
    }

    /// Whether it holds work that its file does not have.
    pub fn is_changed(&self) -> bool {
        self.recovered || self.history.is_changed()
    }

    /// The graph within these nodes, each in the body of the one before; the whole graph for none. `None` where a node is
    /// gone, or has no graph within.
    pub fn graph_at(&self, path: &[NodeId]) -> Option<&Graph> {
        path.iter().try_fold(&self.graph, |graph, id| graph.node(*id)?.body()?.graph())
    }

    /// Makes edits of the graph within `path` one step, or, with `gesture`, a part of the step of the same gesture.
    ///
    /// # Errors
    /// An edit does not fit; nothing changed.
    pub(crate) fn step(
        &mut self,
        catalogue: &Catalogue,
        path: &[NodeId],
        name: &str,
        edits: Vec<Edit>,
        gesture: Option<&str>,
    ) -> Result<(), EditError> {
        if edits.is_empty() {
            return Ok(());
        }
        let edits: Vec<Edit> = edits.into_iter().map(|edit| within(path, edit)).collect();
        match gesture {
            Some(key) => {
                self.history.begin_merging(name, key);
                let made = self.history.apply_all(&mut self.graph, catalogue, &edits);
                self.history.commit();
                made?;
            }
            None => self.history.step(&mut self.graph, catalogue, name, &edits)?,
        }
        self.revision += 1;
        Ok(())
    }

    /// Begins a step of several parts, of which the later ones depend on what the earlier ones made.
    pub(crate) fn begin(&mut self, name: &str) {
        self.history.begin(name);
    }

    /// Makes an edit a part of the step that was begun.
    ///
    /// # Errors
    /// It does not fit; what was made before stays.
    pub(crate) fn part(&mut self, catalogue: &Catalogue, path: &[NodeId], edit: Edit) -> Result<(), EditError> {
        self.history.apply(&mut self.graph, catalogue, &within(path, edit))?;
        self.revision += 1;
        Ok(())
    }

    /// Ends the step that was begun.
    pub(crate) fn commit(&mut self) {
        self.history.commit();
    }

    pub(crate) fn end_gesture(&mut self) {
        self.history.end_gesture();
    }

    /// Undoes the last step and says its name.
    pub(crate) fn undo(&mut self, catalogue: &Catalogue) -> Result<Option<String>, EditError> {
        let undone = self.history.undo(&mut self.graph, catalogue)?.map(str::to_owned);
        self.revision += u64::from(undone.is_some());
        Ok(undone)
    }

    /// Redoes the step that was undone last and says its name.
    pub(crate) fn redo(&mut self, catalogue: &Catalogue) -> Result<Option<String>, EditError> {
        let redone = self.history.redo(&mut self.graph, catalogue)?.map(str::to_owned);
        self.revision += u64::from(redone.is_some());
        Ok(redone)
    }

    /// Undoes or redoes until so many steps are done.
    pub(crate) fn jump(&mut self, catalogue: &Catalogue, position: usize) -> Result<(), EditError> {
        self.revision += 1;
        self.history.jump(&mut self.graph, catalogue, position)
    }

    /// Saves into its file.
    pub(crate) fn save(&mut self) -> Result<(), DocumentSaveError> {
        let path = self.path.clone().ok_or(DocumentSaveError::NoFile)?;
        file::save(&self.graph, &path)?;
        self.history.mark_saved();
        self.recovered = false;
        self.written = written_at(&path);
        Ok(())
    }

    /// Saves into another file, which becomes its own. Relative paths in the graph start at the new folder.
    pub(crate) fn save_as(&mut self, path: &Path) -> Result<(), DocumentSaveError> {
        file::save(&self.graph, path)?;
        self.path = Some(path.to_owned());
        self.history.mark_saved();
        self.recovered = false;
        self.written = written_at(path);
        // Other files may lie where relative paths now lead.
        self.revision += 1;
        Ok(())
    }

    /// Whether another program wrote the file since it was opened or saved. Says so once for each time.
    pub(crate) fn changed_on_disk(&mut self) -> bool {
        let now = self.path.as_deref().and_then(written_at);
        let changed = now.is_some() && now != self.written;
        self.written = now.or(self.written);
        changed
    }
}

/// An edit of the graph within these nodes, as an edit of the whole.
fn within(path: &[NodeId], edit: Edit) -> Edit {
    path.iter().rev().fold(edit, |edit, node| Edit::Within { node: *node, edit: Box::new(edit) })
}

/// The folder at which relative paths of a graph's file start.
fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn written_at(path: &Path) -> Option<SystemTime> {
    std::fs::metadata(path).ok()?.modified().ok()
}

/// The bytes of a graph's file; of one that is too long, enough for the reader to refuse it.
fn read_at_most(path: &Path) -> std::io::Result<Vec<u8>> {
    use std::io::Read as _;
    // Asked first, because to open a pipe may take forever.
    if !std::fs::metadata(path)?.is_file() {
        return Err(std::io::Error::other("it is not a file"));
    }
    let mut bytes = Vec::new();
    std::fs::File::open(path)?.take(MOST_BYTES as u64 + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}
