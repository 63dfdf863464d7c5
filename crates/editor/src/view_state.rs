//! How one looks at the document: neither saved with it nor undone.

use std::collections::BTreeSet;

use maquette_graph::{Graph, NodeId};
use serde::{Deserialize, Serialize};

use crate::drawable::Detail;
use crate::panel::tour::Tour;
use crate::viewport::picture::Shading;

/// What the pointer does in a view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// Picks what is shown.
    #[default]
    Select,
    /// Draws strokes; near an existing one it draws that part anew.
    Sketch,
    /// Pulls points of strokes, and their neighbours with them.
    Pull,
    /// Moves, turns and scales whole strokes.
    Transform,
    /// Cuts strokes where it is drawn across them.
    Cut,
    /// Takes away what it is drawn across.
    Erase,
    /// Selects of a mesh what lies in a drawn loop.
    Lasso,
    /// Selects vertices of a mesh with a brush.
    Paint,
    /// Moves and scales reference pictures.
    Picture,
}

impl Tool {
    /// All tools, in the order of the bar.
    pub const ALL: [Self; 9] = [
        Self::Select,
        Self::Sketch,
        Self::Pull,
        Self::Transform,
        Self::Cut,
        Self::Erase,
        Self::Lasso,
        Self::Paint,
        Self::Picture,
    ];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Select => "Select",
            Self::Sketch => "Sketch",
            Self::Pull => "Pull",
            Self::Transform => "Transform",
            Self::Cut => "Cut",
            Self::Erase => "Erase",
            Self::Lasso => "Lasso",
            Self::Paint => "Paint",
            Self::Picture => "Picture",
        }
    }

    /// One line on how it is used.
    pub fn description(self) -> &'static str {
        match self {
            Self::Select => "Click on what is shown to select the node that made it",
            Self::Sketch => {
                "Draw in the front, side or top view; along a stroke to draw that part anew, from its end to go on"
            }
            Self::Pull => "Drag a point of a stroke; its neighbours follow within the radius",
            Self::Transform => {
                "Drag strokes, or the handles of their box; Shift picks several and keeps to one axis; arrow keys nudge"
            }
            Self::Cut => "Drag across strokes to cut them in two",
            Self::Erase => "Drag across strokes to take parts of them away",
            Self::Lasso => "Draw a loop around a part of the active node's mesh to select it",
            Self::Paint => "Drag over the active node's mesh to select vertices; with Ctrl to take them away",
            Self::Picture => "Drag a reference picture; with Shift along something of known length to scale it",
        }
    }
}

/// What is remembered from one session to the next.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// How surfaces are looked at.
    pub shading: Shading,
    /// How finely exact surfaces are shown.
    pub detail: Detail,
    /// Whether edges are drawn over them.
    pub wire: bool,
    /// Whether the grid is drawn.
    pub grid: bool,
    /// Whether curves are drawn.
    pub curves: bool,
    /// Whether sections are drawn.
    pub sections: bool,
    /// Whether edges are smoothed; costs time without a graphics card.
    pub smooth_edges: bool,
    /// Whether the middle button turns (Blender) or Alt with the left one (Maya).
    pub maya_navigation: bool,
    /// How far a drawn stroke may be from the pen, metres.
    pub tolerance: f64,
    /// How far pulling reaches, metres.
    pub pull_radius: f64,
    /// Whether what is drawn across the middle of the body is mirrored.
    pub symmetric: bool,
    /// Radius of the brush that selects, metres.
    pub brush: f64,
    /// Whether ends of strokes are caught by other curves and the middle of the body.
    pub snap: bool,
    /// The length that one draws along in a reference picture to scale it, metres.
    pub known_length: f64,
    /// Files that were opened, the last one first.
    pub recent: Vec<std::path::PathBuf>,
    /// Whether the welcome was seen.
    pub welcomed: bool,
    /// Whether the tour was taken to its end.
    pub toured: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            shading: Shading::default(),
            detail: Detail::default(),
            wire: true,
            grid: true,
            curves: true,
            sections: true,
            smooth_edges: true,
            maya_navigation: false,
            tolerance: 0.002,
            pull_radius: 0.1,
            symmetric: false,
            brush: 0.03,
            snap: true,
            known_length: 1.0,
            recent: Vec::new(),
            welcomed: false,
            toured: false,
        }
    }
}

impl Settings {
    /// Puts a file at the head of those that were opened.
    pub(crate) fn remember(&mut self, path: &std::path::Path) {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        self.recent.retain(|known| *known != path);
        self.recent.insert(0, path);
        self.recent.truncate(10);
    }
}

/// A row of a table that a node of the whole graph reported.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PickedRow {
    /// The node.
    pub node: NodeId,
    /// The table's name.
    pub table: String,
    /// The row, as it was reported, counted from 0.
    pub row: usize,
}

/// How one looks at the document.
#[derive(Debug, Default)]
pub struct ViewState {
    /// The nodes that were entered, each in the graph within the one before.
    pub path: Vec<NodeId>,
    /// The selected nodes of the graph on the canvas.
    pub selection: BTreeSet<NodeId>,
    /// The one that the inspector shows.
    pub active: Option<NodeId>,
    /// The node of the whole graph that is shown alone; `None` for the results.
    pub displayed: Option<NodeId>,
    /// The node of the graph that was entered that is shown alone; `None` for what the whole graph shows.
    pub displayed_within: Option<NodeId>,
    /// Nodes of the whole graph that are shown as well.
    pub pinned: BTreeSet<NodeId>,
    /// Nodes of the canvas whose inputs with values are shown.
    pub expanded: BTreeSet<NodeId>,
    /// What the pointer does in a view.
    pub tool: Tool,
    /// Strokes of the active sketch that are picked, by their place; none stands for all.
    pub picked_strokes: BTreeSet<usize>,
    /// What was said last.
    pub message: Option<crate::command::Message>,
    /// Whether the keyboard sheet is open.
    pub keys: bool,
    /// Whether the examples and the tour are offered.
    pub welcome: bool,
    /// Whether it is said which version this is.
    pub about: bool,
    /// The row of a table that the views show.
    pub picked_row: Option<PickedRow>,
    /// Where the artist is in the tour; `None` outside of it.
    pub tour: Option<Tour>,
}

impl ViewState {
    /// Forgets what the graph has no longer.
    pub(crate) fn prune(&mut self, whole: &Graph, graph_at: impl Fn(&[NodeId]) -> bool) {
        while !graph_at(&self.path) {
            self.path.pop();
            self.selection.clear();
            self.active = None;
            self.displayed_within = None;
        }
        let graph = self.path.iter().try_fold(whole, |graph, id| graph.node(*id)?.body()?.graph());
        if let Some(graph) = graph {
            self.selection.retain(|id| graph.node(*id).is_some());
            self.active = self.active.filter(|id| graph.node(*id).is_some());
            self.displayed_within = self.displayed_within.filter(|id| graph.node(*id).is_some());
            if self.active.is_none() {
                self.picked_strokes.clear();
            }
            self.expanded.retain(|id| graph.node(*id).is_some());
        }
        // It is the active node's, and goes with it.
        let active = self.active;
        self.picked_row = self.picked_row.take().filter(|picked| active == Some(picked.node));
        self.displayed = self.displayed.filter(|id| whole.node(*id).is_some());
        self.pinned.retain(|id| whole.node(*id).is_some());
    }

    /// The nodes of the whole graph that the views show: what is displayed, then what is pinned.
    pub(crate) fn drawn(&self, whole: &Graph) -> Vec<NodeId> {
        let mut drawn = match self.displayed {
            Some(node) => vec![node],
            None => whole.results(),
        };
        drawn.extend(self.pinned.iter().filter(|id| !drawn.contains(id)).copied().collect::<Vec<_>>());
        drawn
    }
}
