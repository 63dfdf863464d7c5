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
    /// Line, counted from 1.
    pub line: usize,
    /// Column, counted from 1 in characters.
    pub column: usize,
    /// The node, where one is concerned.
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
