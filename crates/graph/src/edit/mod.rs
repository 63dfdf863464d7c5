//! Edits as values: every change of a graph, each with its inverse.
//!
//! [`Graph::apply`] is where an edit changes a graph; it gives back the edit that undoes it, exactly: names, identities,
//! order, links, notes, and text that was not understood. [`Graph::apply_all`] applies several, all or none. [`History`]
//! groups edits into named steps and undoes and redoes them. [`compound`] plans what artists do with more than one edit:
//! insert a node into a link, replace, dissolve, duplicate, copy and paste.
//!
//! What to use when: a program that builds a graph once calls [`Graph::add`], [`Graph::connect`] and so on, which do
//! the same without the inverse. An editor sends every change through a [`History`].
//!
//! ```
//! use maquette_graph::edit::compound;
//! use maquette_graph::{Catalogue, Edit, Graph, History, Literal, NodeKind, NodeRecord, file};
//!
//! let mut node = NodeKind::declare("double", 1, "numbers", "Doubles a number.");
//! let number = node.number("number", 1.0, -1e9..=1e9, "The number to double.");
//! let doubled = node.output::<f64>("number", "Twice the number.");
//! node.evaluate(move |ports| {
//!     let twice = 2.0 * ports.value(number);
//!     ports.write(doubled, twice);
//!     Ok(())
//! });
//! let mut catalogue = Catalogue::new();
//! catalogue.register(node)?;
//!
//! let (mut graph, mut history) = (Graph::new(), History::new());
//! let empty = file::to_text(&graph);
//!
//! // A step is what the artist undoes at once.
//! history.begin("two in a row");
//! history.apply(&mut graph, &catalogue, &Edit::AddNode(NodeRecord::new("double", "first").into()))?;
//! history.apply(&mut graph, &catalogue, &Edit::AddNode(NodeRecord::new("double", "second").into()))?;
//! let ids: Vec<_> = graph.nodes().map(|(id, _)| id).collect();
//! history.apply(&mut graph, &catalogue, &Edit::connect(ids[0], "number", ids[1], "number"))?;
//! history.commit();
//!
//! // Frames of one drag of a slider are one step.
//! for value in [2.0, 3.0, 4.0] {
//!     history.begin_merging("drag number", "first.number");
//!     history.apply(&mut graph, &catalogue, &Edit::set(ids[0], "number", Literal::Number(value)))?;
//!     history.commit();
//! }
//!
//! // Compound edits are plans: look at what they will do, then make them a step.
//! let plan = compound::insert_into_link(&graph, &catalogue, ids[1], "number", "double")?;
//! history.step(&mut graph, &catalogue, "insert double", &plan.edits)?;
//! assert_eq!(history.names().collect::<Vec<_>>(), ["two in a row", "drag number", "insert double"]);
//!
//! let full = file::to_text(&graph);
//! history.jump(&mut graph, &catalogue, 0)?;
//! assert_eq!(file::to_text(&graph), empty);
//! history.jump(&mut graph, &catalogue, 3)?;
//! assert_eq!(file::to_text(&graph), full);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`Graph::apply`]: crate::Graph::apply
//! [`Graph::apply_all`]: crate::Graph::apply_all
//! [`Graph::add`]: crate::Graph::add
//! [`Graph::connect`]: crate::Graph::connect

mod apply;
mod body;
pub mod compound;
mod fresh_name;
mod history;
mod interface;
mod record;
mod slot;

pub use history::History;
pub use record::NodeRecord;

use std::fmt;
use std::sync::Arc;

use crate::body::{Body, BodyError};
use crate::graph::{ConnectError, GraphError, NodeId, Source};
use crate::interface::{GraphOutput, InterfaceError};
use crate::literal::Literal;
use crate::parameter::Parameter;
use crate::presentation::{Frame, PresentationError, ReferencePicture};

/// One change of a graph, as a value.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// Adds a node with what its inputs hold, or brings a removed one back.
    AddNode(Box<NodeRecord>),
    /// Removes a node and every link from and to it.
    RemoveNode(NodeId),
    /// Links an output to an input, in place of whatever was there.
    Connect {
        /// Where the link comes from.
        from: NodeId,
        /// The output of `from`.
        output: String,
        /// Where it goes.
        to: NodeId,
        /// The input of `to`.
        input: String,
    },
    /// Removes the link at an input, which goes back to its default.
    Disconnect {
        /// The node at which the link ends.
        to: NodeId,
        /// Its input.
        input: String,
    },
    /// Puts a literal at an input, in place of whatever was there.
    Set {
        /// The node.
        node: NodeId,
        /// Its input.
        input: String,
        /// The value.
        literal: Literal,
    },
    /// Puts an input back to its default, unlinked.
    Reset {
        /// The node.
        node: NodeId,
        /// Its input.
        input: String,
    },
    /// Puts text of a file back that was not understood. Only inverses of other edits hold such text.
    PutBack {
        /// The node.
        node: NodeId,
        /// Its input.
        input: String,
        /// The text.
        text: UnreadText,
    },
    /// Gives a node another name; links follow.
    Rename {
        /// The node.
        node: NodeId,
        /// The new name.
        name: String,
    },
    /// Places a node on the canvas; `None`, and coordinates that are not finite, leave it to the editor.
    Move {
        /// The node.
        node: NodeId,
        /// Where its upper left corner is.
        position: Option<[f64; 2]>,
    },
    /// Remarks on a node.
    Note {
        /// The node.
        node: NodeId,
        /// The remark; empty for none.
        note: String,
    },
    /// Remarks on the whole graph.
    GraphNotes(String),
    /// Puts these frames behind the nodes, in place of those that were there.
    Frames(Vec<Frame>),
    /// Puts these pictures behind the sketches, in place of those that were there.
    References(Vec<ReferencePicture>),
    /// Lets the editor draw only a node's title and sockets, or all of it again.
    Collapse {
        /// The node.
        node: NodeId,
        /// Whether it is collapsed.
        collapsed: bool,
    },
    /// Lets a node pass its inputs on in place of doing its work, or do its work again.
    Mute {
        /// The node.
        node: NodeId,
        /// Whether it is muted.
        muted: bool,
    },
    /// Lets a parameter of the graph drive an input, in place of whatever was there.
    UseParameter {
        /// The node.
        node: NodeId,
        /// Its input.
        input: String,
        /// The parameter.
        parameter: String,
    },
    /// Declares a parameter.
    AddParameter {
        /// How many stand before it; beyond the end means the end.
        index: usize,
        /// The parameter.
        parameter: Box<Parameter>,
    },
    /// Removes a parameter. Inputs that it drives get its value, where that fits.
    RemoveParameter(String),
    /// Declares a parameter otherwise, perhaps under another name; inputs that it drives follow, as far as they fit.
    ChangeParameter {
        /// The name that it has.
        name: String,
        /// What it becomes.
        parameter: Box<Parameter>,
    },
    /// Puts a value at a parameter, or takes its value away.
    SetParameter {
        /// The parameter.
        parameter: String,
        /// The value.
        literal: Option<Literal>,
    },
    /// Declares an output of the graph.
    AddOutput {
        /// How many stand before it; beyond the end means the end.
        index: usize,
        /// The output.
        output: Box<GraphOutput>,
    },
    /// Removes an output of the graph.
    RemoveOutput(String),
    /// Declares an output of the graph otherwise, perhaps under another name or from another node.
    ChangeOutput {
        /// The name that it has.
        name: String,
        /// What it becomes.
        output: Box<GraphOutput>,
    },
    /// Puts another graph into a node. Links and values that no longer fit its ports go.
    SetBody {
        /// The node, of kind `graph` or `repeat`.
        node: NodeId,
        /// What it evaluates.
        body: Arc<Body>,
    },
    /// Changes the graph that is embedded in a node. What is linked to its ports follows new names; links and values that
    /// no longer fit go.
    Within {
        /// The node.
        node: NodeId,
        /// What changes within.
        edit: Box<Edit>,
    },
    /// Several edits in their order, all or none.
    Several(Vec<Edit>),
}

/// Text of a file that was not understood. It can't be made, only moved, so that every file that is written can be
/// read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnreadText(pub(crate) String);

impl fmt::Display for UnreadText {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl Edit {
    /// Adds a node with every input at its default.
    pub fn add(kind: impl Into<String>, name: impl Into<String>) -> Self {
        Self::AddNode(Box::new(NodeRecord::new(kind, name)))
    }

    /// [`Edit::Connect`] from borrowed names.
    pub fn connect(from: NodeId, output: impl Into<String>, to: NodeId, input: impl Into<String>) -> Self {
        Self::Connect { from, output: output.into(), to, input: input.into() }
    }

    /// [`Edit::Set`] from a borrowed name.
    pub fn set(node: NodeId, input: impl Into<String>, literal: Literal) -> Self {
        Self::Set { node, input: input.into(), literal }
    }

    /// The edit that puts back at an input what was there.
    pub(crate) fn restoring(node: NodeId, input: &str, was: Option<Source>) -> Self {
        let input = input.to_owned();
        match was {
            None => Self::Reset { node, input },
            Some(Source::Literal { literal, .. }) => Self::Set { node, input, literal },
            Some(Source::Link(link)) => Self::Connect { from: link.node, output: link.output, to: node, input },
            Some(Source::Parameter(parameter)) => Self::UseParameter { node, input, parameter },
            Some(Source::Unread(text)) => Self::PutBack { node, input, text: UnreadText(text) },
        }
    }

    /// What it does, in few words, for a list of steps.
    pub fn label(&self) -> String {
        match self {
            Self::AddNode(record) => format!("add {}", record.name()),
            Self::RemoveNode(_) => "remove a node".to_owned(),
            Self::Connect { input, .. } => format!("connect {input}"),
            Self::Disconnect { input, .. } => format!("disconnect {input}"),
            Self::Set { input, .. } => format!("set {input}"),
            Self::Reset { input, .. } => format!("reset {input}"),
            Self::PutBack { input, .. } => format!("restore {input}"),
            Self::Rename { name, .. } => format!("rename to {name}"),
            Self::Move { .. } => "move a node".to_owned(),
            Self::Note { .. } => "edit a note".to_owned(),
            Self::GraphNotes(_) => "edit the notes".to_owned(),
            Self::Frames(_) => "change frames".to_owned(),
            Self::References(_) => "change reference pictures".to_owned(),
            Self::Collapse { collapsed: true, .. } => "collapse a node".to_owned(),
            Self::Collapse { .. } => "expand a node".to_owned(),
            Self::Mute { muted: true, .. } => "mute a node".to_owned(),
            Self::Mute { .. } => "unmute a node".to_owned(),
            Self::UseParameter { input, parameter, .. } => format!("drive {input} by {parameter}"),
            Self::AddParameter { parameter, .. } => format!("add parameter {}", parameter.name()),
            Self::RemoveParameter(name) => format!("remove parameter {name}"),
            Self::ChangeParameter { name, .. } => format!("change parameter {name}"),
            Self::SetParameter { parameter, .. } => format!("set {parameter}"),
            Self::AddOutput { output, .. } => format!("add output {}", output.name()),
            Self::RemoveOutput(name) => format!("remove output {name}"),
            Self::ChangeOutput { name, .. } => format!("change output {name}"),
            Self::SetBody { .. } => "change a body".to_owned(),
            Self::Within { edit, .. } => edit.label(),
            Self::Several(edits) => edits.first().map(Self::label).unwrap_or_default(),
        }
    }
}

/// Why an edit was refused. The graph is as it was.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EditError {
    /// A node, name or literal does not fit.
    #[error(transparent)]
    Graph(#[from] GraphError),
    /// A link does not fit.
    #[error(transparent)]
    Connect(#[from] ConnectError),
    /// A parameter or an output of the graph does not fit.
    #[error(transparent)]
    Interface(#[from] InterfaceError),
    /// A frame or a reference picture can't be as it is asked for.
    #[error(transparent)]
    Presentation(#[from] PresentationError),
    /// A body does not fit.
    #[error(transparent)]
    Body(#[from] BodyError),
    /// An edit within a body is refused.
    #[error("within \"{node}\": {error}")]
    Within {
        /// The node whose body it is.
        node: String,
        /// Why.
        error: Box<EditError>,
    },
    /// Nothing is linked.
    #[error("node \"{node}\", input \"{input}\": no link is there to remove")]
    NotLinked {
        /// The node.
        node: String,
        /// Its input.
        input: String,
    },
    /// The node was to get an identity that is not free.
    #[error("node \"{0}\" can't come into this graph as it was planned: the graph changed since; plan the edit again")]
    Outdated(String),
    /// A link of the node was to enter an input that something holds by now.
    #[error(
        "node \"{from}\" can't be linked to \"{to}\", input \"{input}\": something else is there; reset the input first"
    )]
    InputTaken {
        /// The node that was to be added.
        from: String,
        /// The node to which its link goes.
        to: String,
        /// The input of that node.
        input: String,
    },
}
