//! What is wrong with a file, where, and what to do about it.

use std::fmt;

use crate::one_line::one_line;

/// Whether a problem keeps the graph from being evaluated as it was meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The graph can't be evaluated as it was meant.
    Error,
    /// It can, but something deserves a look.
    Warning,
    /// It can; the file is an old one, and was read as what it means today. `maquette migrate` rewrites it.
    Note,
}

impl fmt::Display for Severity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Error => "error",
            Self::Warning => "warning",
            Self::Note => "note",
        })
    }
}

/// One thing that is wrong. Written out it is one line, whatever the file's names hold.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// How bad it is.
    pub severity: Severity,
    /// The file that has it, where that is not the graph's own but one that is included; seen from the graph's folder.
    pub file: Option<String>,
    /// Line, counted from 1.
    pub line: usize,
    /// Column, counted from 1 in characters.
    pub column: usize,
    /// The node, where one is concerned; one in an embedded body by its path, such as `hand/rails`.
    pub node: Option<String>,
    /// The input, where one is concerned.
    pub port: Option<String>,
    /// What is wrong.
    pub message: String,
    /// What to do.
    pub remedy: String,
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.file {
            write!(f, "{}:", one_line(file))?;
        }
        write!(f, "{}:{}: {}: ", self.line, self.column, self.severity)?;
        match (&self.node, &self.port) {
            (Some(node), Some(port)) => write!(f, "node {node:?}, input {port:?}: ")?,
            (Some(node), None) => write!(f, "node {node:?}: ")?,
            _ => {}
        }
        write!(f, "{}", one_line(&self.message))?;
        if self.remedy.is_empty() { Ok(()) } else { write!(f, "; {}", one_line(&self.remedy)) }
    }
}

impl Problem {
    /// What keeps an included file from being read at all, as a problem.
    pub(super) fn of_file(file: &str, error: &FileError) -> Self {
        let (line, column, message, remedy) = match error {
            FileError::NotUtf8 { line, column } => {
                (*line, *column, "the file is not UTF-8 text".to_owned(), "save it as UTF-8".to_owned())
            }
            FileError::TooLarge { line, column, what } => {
                let remedy = "divide it into several, or keep long curves and meshes in files of their own";
                (*line, *column, format!("the graph is too large: {what}"), remedy.to_owned())
            }
            FileError::Syntax { line, column, message, remedy } => (*line, *column, message.clone(), remedy.clone()),
        };
        let (file, severity) = (Some(file.to_owned()), Severity::Error);
        Self { severity, file, line, column, node: None, port: None, message, remedy }
    }
}

/// Why a file could not be read at all.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FileError {
    /// Not text.
    #[error("{line}:{column}: error: the file is not UTF-8 text; save it as UTF-8, or restore it from a backup")]
    NotUtf8 {
        /// Line of the first bad byte, counted from 1.
        line: usize,
        /// Column of the first bad byte, counted from 1.
        column: usize,
    },
    /// It would take more memory than a graph may.
    #[error(
        "{line}:{column}: error: the graph is too large: {what}; divide it into several, or keep long curves and meshes \
         in files of their own"
    )]
    TooLarge {
        /// Line at which it becomes too large, counted from 1.
        line: usize,
        /// Column, counted from 1.
        column: usize,
        /// What is too much.
        what: String,
    },
    /// Not a graph in RON.
    #[error("{line}:{column}: error: {}; {remedy}", one_line(.message))]
    Syntax {
        /// Line, counted from 1.
        line: usize,
        /// Column, counted from 1.
        column: usize,
        /// What is wrong.
        message: String,
        /// What to do.
        remedy: String,
    },
}
