//! What widgets ask for. They change nothing themselves: the application applies commands in one place.

use std::collections::BTreeSet;
use std::path::PathBuf;

use maquette_graph::{Edit, NodeId, ReferencePicture, Stroke};

use crate::canvas::arrange::Alignment;
use crate::view_state::{PickedRow, Tool};
use crate::viewport::camera::Direction;

/// Something that was asked for.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// To change the graph.
    Graph(GraphCommand),
    /// To look at it otherwise.
    View(ViewCommand),
    /// To open, save, close.
    File(FileCommand),
    /// To tell the artist something.
    Say(Message),
}

/// Something to tell the artist.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// What.
    pub text: String,
    /// Whether something went wrong.
    pub is_error: bool,
}

impl Message {
    /// Something that is good to know.
    pub fn note(text: impl Into<String>) -> Self {
        Self { text: text.into(), is_error: false }
    }

    /// Something that went wrong.
    pub fn error(text: impl Into<String>) -> Self {
        Self { text: text.into(), is_error: true }
    }
}

/// A change of the graph on the canvas.
#[derive(Clone, Debug, PartialEq)]
pub enum GraphCommand {
    /// Makes edits one step, or a part of a gesture's.
    Edit {
        /// What the step is called.
        name: String,
        /// The edits, all or none.
        edits: Vec<Edit>,
        /// The same for all edits of one gesture, such as a drag.
        gesture: Option<String>,
    },
    /// Puts these pictures behind the sketches of the whole graph.
    References {
        /// What the step is called.
        name: String,
        /// All of them.
        pictures: Vec<ReferencePicture>,
        /// The same for all edits of one gesture.
        gesture: Option<String>,
    },
    /// Adds a node that selects of the active mesh by hand: by a loop drawn in the plane of that name, or by painting.
    SelectByHand {
        /// The node that gives the mesh, and its output.
        mesh: (NodeId, String),
        /// The plane and the loop; `None` to paint.
        strokes: Option<(&'static str, Stroke)>,
    },
    /// Changes the picked strokes of the active sketch, or all of them where none is picked.
    Strokes(StrokeDeed),
    /// Ends a gesture.
    EndGesture,
    /// Undoes the last step.
    Undo,
    /// Redoes the step that was undone last.
    Redo,
    /// Undoes or redoes until so many steps are done.
    JumpTo(usize),
    /// Adds a node.
    Add {
        /// Its kind.
        kind: String,
        /// Where it stands.
        at: [f64; 2],
        /// What it is linked to.
        link: NewLink,
    },
    /// Moves a node into a link.
    DropOnLink {
        /// The node.
        node: NodeId,
        /// Where the link ends.
        to: NodeId,
        /// The input.
        input: String,
        /// Where it was dropped.
        at: [f64; 2],
    },
    /// Removes the selected nodes.
    Delete,
    /// Removes the selected nodes and closes their links.
    Dissolve,
    /// Mutes the selected nodes, or the contrary where all are.
    Mute,
    /// Copies the selected nodes on the canvas.
    Duplicate {
        /// Whether the copies keep the links from nodes that are not copied.
        keep_links: bool,
    },
    /// Puts the selected nodes into the clipboard as text.
    Copy,
    /// The same, and removes them.
    Cut,
    /// Adds the nodes of a text.
    Paste {
        /// The text of a graph.
        text: String,
    },
    /// Puts the selected nodes into one of kind `graph`.
    Group,
    /// Takes the nodes out of the selected ones of kind `graph`.
    Ungroup,
    /// Gives the active node another kind.
    Replace(String),
    /// Makes an input a parameter of the graph.
    Promote {
        /// The node.
        node: NodeId,
        /// Its input.
        input: String,
    },
    /// Places all nodes by what they depend on.
    Arrange,
    /// Places the selected nodes by what they depend on, where they are.
    ArrangeSelected,
    /// Lines the selected nodes up, or spreads them.
    Align(Alignment),
    /// Puts a frame around the selected nodes.
    Frame,
    /// Collapses the selected nodes, or the contrary where all are.
    Collapse,
    /// Lets the first two inputs of the active node change places.
    Swap,
}

/// What is done with whole strokes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StrokeDeed {
    /// A copy of each, beside it.
    Duplicate,
    /// A mirror image of each, across the middle of the body.
    Mirror,
    /// They run the other way.
    Reverse,
    /// Open ones are closed; where all are closed, they are opened.
    Close,
    /// Two open ones become one, at the ends that are nearest to each other.
    Join,
    /// They go.
    Delete,
}

impl StrokeDeed {
    /// All of them, in the order of the bar.
    pub const ALL: [Self; 6] = [Self::Duplicate, Self::Mirror, Self::Reverse, Self::Close, Self::Join, Self::Delete];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Duplicate => "Duplicate",
            Self::Mirror => "Mirror",
            Self::Reverse => "Reverse",
            Self::Close => "Close",
            Self::Join => "Join",
            Self::Delete => "Delete",
        }
    }
}

/// What a new node is linked to.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum NewLink {
    /// To nothing.
    #[default]
    None,
    /// It takes this output.
    From {
        /// The node.
        node: NodeId,
        /// Its output.
        output: String,
    },
    /// It feeds this input.
    To {
        /// The node.
        node: NodeId,
        /// Its input.
        input: String,
    },
}

/// Another look at the graph.
#[derive(Clone, Debug, PartialEq)]
pub enum ViewCommand {
    /// Selects nodes; the last one becomes the active one.
    Select(Vec<NodeId>),
    /// Picks strokes of the active sketch, by their place.
    PickStrokes(BTreeSet<usize>),
    /// Selects all nodes of the canvas.
    SelectAll,
    /// Selects a node of the whole graph, named as messages name it.
    Find(String),
    /// Goes into the graph within a node.
    Enter(NodeId),
    /// Goes out until so many nodes are entered.
    LeaveTo(usize),
    /// Shows a node alone in the views, or the results again where it is shown already.
    Display(NodeId),
    /// Shows a node behind all others, or no longer.
    Pin(NodeId),
    /// Shows the inputs of a node that hold values, or hides them again.
    Expand(NodeId),
    /// Takes a tool.
    Take(Tool),
    /// Frames what is shown in all views.
    FrameAll,
    /// Frames what the selected nodes show.
    FrameSelected,
    /// Lets the perspective view see without perspective, or with it again.
    Parallel,
    /// Lets the panel under the pointer fill the window, or puts all back.
    Maximise,
    /// Stops the evaluation.
    Stop,
    /// Opens or closes the search for a node to add.
    Search,
    /// Shows or hides the keyboard sheet.
    Keys,
    /// Shows the examples and the way to the tour.
    Welcome,
    /// Says which version this is.
    About,
    /// Shows what a row of a table speaks of in the views, or nothing.
    PickRow(Option<PickedRow>),
}

/// Opening, saving, closing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileCommand {
    /// An empty graph.
    New,
    /// A small graph, and a tour through its making.
    Tour,
    /// Asks for a file to open.
    OpenDialog,
    /// Opens a file.
    Open(PathBuf),
    /// Saves, and asks where if nobody said.
    Save,
    /// Asks where to save.
    SaveAsDialog,
    /// Saves there.
    SaveAs(PathBuf),
    /// Opens work that a program which ended suddenly left behind.
    Recover(PathBuf),
    /// Throws such work away.
    Discard(PathBuf),
    /// Reads the file again.
    Reload,
    /// Asks for a file that the graph is to name.
    Browse {
        /// What names it.
        target: FileTarget,
        /// Extensions that are offered, without the dot.
        extensions: Vec<String>,
    },
    /// Puts a picture behind the strokes of a view.
    AddReference {
        /// The view.
        view: Direction,
        /// The picture's file.
        path: PathBuf,
    },
    /// Asks where to write the results.
    ExportDialog,
    /// Writes the results in the format of the file's ending.
    ExportTo(PathBuf),
    /// Writes a text, such as a table as CSV.
    Export {
        /// The file.
        path: PathBuf,
        /// What is written.
        text: String,
    },
    /// Closes the window.
    Quit,
}

/// What in a graph names a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileTarget {
    /// An input of a node of the canvas.
    Input {
        /// The node.
        node: NodeId,
        /// Its input.
        input: String,
    },
    /// A parameter of the graph on the canvas.
    Parameter(String),
    /// A new reference picture in this view.
    Reference(Direction),
}

impl From<GraphCommand> for Command {
    fn from(command: GraphCommand) -> Self {
        Self::Graph(command)
    }
}

impl From<ViewCommand> for Command {
    fn from(command: ViewCommand) -> Self {
        Self::View(command)
    }
}

impl From<FileCommand> for Command {
    fn from(command: FileCommand) -> Self {
        Self::File(command)
    }
}

impl GraphCommand {
    /// One edit as a step of its own.
    pub fn edit(edit: Edit) -> Self {
        Self::Edit { name: edit.label(), edits: vec![edit], gesture: None }
    }
}
