//! The `.ron` file of a graph: readable, stable, and kept whole even where it is not understood.
//!
//! ```ron
//! (
//!     version: 1,
//!     nodes: {
//!         "rails": (
//!             kind: "resample",
//!             inputs: {
//!                 "curves": Link("sketch.curves"),
//!                 "count": 64,
//!             },
//!         ),
//!     },
//!     layout: {
//!         "rails": (120.0, 80.0),
//!     },
//! )
//! ```
//!
//! Nodes stand in the order in which they were added, inputs in the order of their kind; an input at its default is
//! not written. Numbers, integers and booleans are bare, everything else names its type: `Link("node.output")`,
//! `Text("..")`, `Choice("..")`, `Vector(x, y, z)`, `Colour(r, g, b, a)`, `File("..")`, `Strokes([..])`. What this
//! version does not know (kinds, inputs, fields) or can't read is reported with its place and written back as it was.
//! Not kept are comments (use `notes` for the graph and `note` for a node), attributes, and all but the last of several
//! values at one input or of several places of one node.

mod link;
mod literal_text;
mod place;
mod problem;
mod read;
mod syntax;
mod tree;
mod write;

pub use literal_text::{LiteralError, parse_literal};
pub(crate) use literal_text::{Spelled, parse};
pub use problem::{FileError, Problem, Severity};
pub use read::{Loaded, from_bytes, from_text};
pub use write::to_text;
pub(crate) use write::{number, quoted, selection_to_text};

/// Version of the format that this library writes. Older versions are read.
pub const FORMAT_VERSION: u32 = 1;
