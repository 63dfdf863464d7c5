//! Golden files: what a node made of its inputs once, to be compared with what it makes of them today.
//!
//! A [`Golden`] holds everything that the node needs, so that it runs without the graph it was taken from:
//!
//! ```
//! use maquette_graph::freeze::{Golden, Tolerance};
//! use maquette_graph::{Catalogue, Graph, Literal, NodeKind};
//!
//! let mut node = NodeKind::declare("double", 1, "numbers", "Doubles a number.");
//! let number = node.number("number", 1.0, -1e9..=1e9, "The number to double.");
//! let doubled = node.output::<f64>("number", "Twice the number.");
//! node.evaluate(move |ports| {
//!     ports.write(doubled, 2.0 * ports.value(number));
//!     Ok(())
//! });
//! let mut catalogue = Catalogue::new();
//! catalogue.register(node)?;
//! let mut graph = Graph::new();
//! let twice = graph.add(&catalogue, "double", "twice")?;
//! graph.set(twice, "number", Literal::Number(3.0))?;
//!
//! let golden = Golden::of(&catalogue, &graph, twice, std::path::Path::new(""), Tolerance::default())?;
//! let file = golden.to_text();
//! // Some other day:
//! let golden = Golden::from_text(&file)?;
//! assert_eq!(golden.differences(&catalogue)?, []);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Wire types take part by [`Freeze`]: they say how to become plain data ([`Frozen`]) and how to come back, and are
//! registered with [`crate::Catalogue::freezable`]. The built-in types are.

mod builtin;
mod compare;
mod frozen;
mod golden;
mod text;

pub use compare::{Difference, Tolerance};
pub(crate) use frozen::Freezer;
pub use frozen::{Freeze, Frozen, ThawError};
pub use golden::{FreezeError, Golden};
