//! The commands, one file each, and what they share.

pub mod check;
pub mod console;
mod evaluation;
mod graph_file;
pub mod nodes;
mod overrides;
mod progress_bar;
pub mod render;
mod results;
pub mod run;
mod write;

/// How a command ended; the number is the exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Ended {
    /// Everything was done.
    Done = 0,
    /// A node failed.
    NodeFailed = 1,
    /// The graph or the arguments are wrong.
    Wrong = 2,
    /// A result could not be written.
    NotWritten = 3,
}
