//! The commands, one file each, and what they share.

pub mod check;
mod comments;
mod consistency;
pub mod console;
pub mod diff;
mod evaluation;
mod evaluation_order;
mod fail_if;
pub mod fmt;
pub mod freeze;
mod graph_file;
mod hashes;
pub mod migrate;
pub mod nodes;
mod overrides;
mod progress_bar;
mod project;
pub mod render;
mod report_text;
pub mod run;
pub mod verify;
mod watch;
pub mod wedge;
mod write;

/// How a command ended; the number is the exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Ended {
    /// Everything was done.
    Done = 0,
    /// A node failed, a limit was exceeded, what was compared differs, or a wedge was stopped.
    Failed = 1,
    /// The graph or the arguments are wrong.
    Wrong = 2,
    /// A result could not be written.
    NotWritten = 3,
}
