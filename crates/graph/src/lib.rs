//! The engine of Maquette: typed nodes in a graph that evaluates incrementally and is saved as a readable file.
//!
//! It knows nothing of geometry. A library user declares wire types ([`Wire`]) and node kinds ([`NodeKind`]),
//! collects them in a [`Catalogue`], builds or loads a [`Graph`] and evaluates it with an [`Evaluator`]:
//!
//! ```
//! use maquette_graph::{Catalogue, Evaluator, Graph, Literal, NodeKind, Request};
//!
//! // One node kind: a plain function behind typed ports.
//! let mut node = NodeKind::declare("double", 1, "numbers", "Doubles a number.");
//! let number = node.number("number", 1.0, -1e9..=1e9, "The number to double.");
//! let doubled = node.output::<f64>("number", "Twice the number.");
//! node.evaluate(move |ports| {
//!     let twice = 2.0 * ports.value(number);
//!     ports.write(doubled, twice);
//!     Ok(())
//! });
//!
//! let mut catalogue = Catalogue::new();
//! catalogue.register(node)?;
//!
//! let mut graph = Graph::new();
//! let first = graph.add(&catalogue, "double", "first")?;
//! let second = graph.add(&catalogue, "double", "second")?;
//! graph.set(first, "number", Literal::Number(3.0))?;
//! graph.connect(&catalogue, first, "number", second, "number")?;
//!
//! let mut evaluator = Evaluator::default();
//! let evaluation = evaluator.evaluate(&catalogue, &graph, &Request::nodes(&[second]));
//! assert_eq!(evaluation.value::<f64>(second, "number"), Some(&12.0));
//!
//! // Nothing changed, nothing runs.
//! assert_eq!(evaluator.evaluate(&catalogue, &graph, &Request::nodes(&[second])).run_count(), 0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The chapters of the [`guide`] say what to use when, and what is promised. In short: results are the same on every run and for any number of threads, as long as node functions depend on
//! their inputs alone (and on the files they declare with [`NodeKind::reads_file`]); a failing or panicking node stops
//! only what depends on it; nothing that was loaded from a file is dropped when it is saved again, but for comments
//! and the layout of the text.

mod body;
mod catalogue;
pub mod edit;
mod evaluate;
mod examination;
pub mod file;
mod former_names;
pub mod freeze;
mod graph;
pub mod guide;
pub mod harness;
mod interface;
mod list;
mod literal;
mod mute;
mod node_kind;
mod one_line;
mod parameter;
mod port;
mod ports;
mod presentation;
mod report;
mod topology;
mod unknown_fields;
mod value;

pub use body::{Body, BodyError, BodySource, Repeat};
pub use catalogue::{Catalogue, CatalogueError, closest};
pub use edit::{Edit, EditError, History, NodeRecord};
pub use evaluate::{
    CancelToken, Evaluation, Evaluator, EvaluatorOptions, Event, EventKind, EventLog, Events, Failure, Outcome,
    OutcomeState, Request,
};
pub use examination::Examination;
pub use former_names::InputHandle;
pub use graph::{ConnectError, Graph, GraphError, Link, Node, NodeId, Source};
pub use interface::{GraphOutput, InterfaceError, OutputSource};
pub use literal::{Choice, Colour, FilePath, Literal, LiteralKind, Stroke, StrokePoint, Strokes, Vector};
pub use node_kind::{ChoiceInput, Choices, Input, NodeKind, OptionalInput, Output};
pub use parameter::Parameter;
pub use port::{InputSpec, OptionSpec, OutputSpec, Range, Unit};
pub use ports::{AtPort, NodeError, Ports};
pub use presentation::{Frame, PresentationError, ReferencePicture};
pub use report::{Cell, Column, Figure, FigureHandle, FigureSpec, Report, Table, TableHandle, TableSpec};
pub use value::{ContentHash, ContentHasher, Value, Wire, WireType};
