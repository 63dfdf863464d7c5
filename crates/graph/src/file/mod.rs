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
//! Between `version` and `nodes` may stand `notes` and `parameters`, behind `nodes` the `outputs` of the graph. A node may
//! have a `note` and be `muted`; one of kind `graph` or `repeat` has a `body`, a `File("..")` or a graph in place, which is
//! written like the file without its version. Included files are read through [`Includes`].
//!
//! ```ron
//!     parameters: {
//!         "count": (value: 64, range: (2.0, 4096.0), description: "Points on each curve."),
//!         "drawn": (type: "curves"),
//!     },
//!     nodes: {
//!         "rails": (kind: "resample", inputs: { "curves": Parameter("drawn"), "count": Parameter("count") }),
//!         "calm": (kind: "repeat", inputs: { "curve": Link("rails.curves") }, each: "curve", body: File("calm.ron")),
//!     },
//!     outputs: {
//!         "curves": (from: "calm.curves"),
//!     },
//! ```
//!
//! Behind `layout` may stand what only the editor draws; a node that is `collapsed` shows its title and sockets only:
//!
//! ```ron
//!     frames: [
//!         (title: "rails", colour: (0.3, 0.4, 0.5), at: (100.0, 60.0), size: (400.0, 240.0)),
//!     ],
//!     references: [
//!         (view: "front", file: "front.png", centre: (0.0, 0.9), width: 1.2, opacity: 0.5, locked: true),
//!     ],
//! ```
//!
//! Nodes stand in the order in which they were added, inputs in the order of their kind; an input at its default is
//! not written. Numbers, integers and booleans are bare, everything else names its type: `Link("node.output")`,
//! `Parameter("..")`, `Text("..")`, `Choice("..")`, `Vector(x, y, z)`, `Colour(r, g, b, a)`, `File("..")`, `Strokes([..])`. What this
//! version does not know (kinds, inputs, fields) or can't read is reported with its place and written back as it was.
//! Older versions are read, and what kinds, ports and options were called before ([`migrate`]): with a note.
//! Not kept are comments (use `notes` for the graph and `note` for a node), attributes, and all but the last of several
//! values at one input or of several places of one node.

mod body;
mod disk;
mod include;
mod interface;
mod limit;
mod link;
mod literal_text;
mod migrate;
mod place;
mod presentation;
mod problem;
mod project;
mod read;
mod renamed;
mod syntax;
mod tree;
mod write;

pub use disk::{OpenError, SaveError, open, save, write_whole};
pub use include::Includes;
pub use limit::MOST_BYTES;
pub use literal_text::{LiteralError, parse_literal};
pub(crate) use literal_text::{Spelled, parse};
pub use migrate::{Migrated, migrate};
pub use problem::{FileError, Problem, Severity};
pub use project::{Outside, Project};
pub use read::{Loaded, from_bytes, from_bytes_with, from_text, from_text_with};
pub use write::to_text;
pub(crate) use write::{number, quoted, selection_to_text};

/// Version of the format that this library writes. Older versions are read.
pub const FORMAT_VERSION: u32 = 1;
