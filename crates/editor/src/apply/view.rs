//! Other looks at the graph.

use std::collections::BTreeSet;

use crate::app::App;
use crate::command::ViewCommand;
use crate::viewport::Framing;
use crate::viewport::camera::Direction;

impl App {
    pub(super) fn apply_view(&mut self, context: &egui::Context, command: ViewCommand) {
        match command {
            ViewCommand::Select(nodes) => {
                if self.view.active != nodes.last().copied() {
                    self.view.picked_strokes.clear();
                }
                self.view.active = nodes.last().copied();
                self.view.selection = nodes.into_iter().collect();
            }
            ViewCommand::PickStrokes(strokes) => self.view.picked_strokes = strokes,
            ViewCommand::SelectAll => {
                self.view.selection = self.canvas_graph().nodes().map(|(id, _)| id).collect();
                self.view.active = self.view.active.or(self.view.selection.last().copied());
            }
            ViewCommand::Find(path) => self.find(&path),
            ViewCommand::Enter(id) => {
                let mut path = self.view.path.clone();
                path.push(id);
                if self.document.graph_at(&path).is_some() {
                    self.view.path = path;
                    self.leave_selection();
                }
            }
            ViewCommand::LeaveTo(depth) => {
                let left = self.view.path.get(depth).copied();
                self.view.path.truncate(depth);
                self.leave_selection();
                self.view.selection.extend(left);
                self.view.active = left;
            }
            ViewCommand::Display(id) => {
                if self.view.path.is_empty() {
                    self.view.displayed = if self.view.displayed == Some(id) { None } else { Some(id) };
                } else {
                    let shown = self.view.displayed_within == Some(id);
                    self.view.displayed_within = if shown { None } else { Some(id) };
                }
            }
            ViewCommand::Pin(id) => {
                if self.view.path.is_empty() && !self.view.pinned.remove(&id) {
                    self.view.pinned.insert(id);
                }
            }
            ViewCommand::Expand(id) => {
                if !self.view.expanded.remove(&id) {
                    self.view.expanded.insert(id);
                }
            }
            ViewCommand::Take(tool) => self.view.tool = tool,
            ViewCommand::FrameAll => {
                if self.is_over_canvas(context) {
                    self.canvas.frame_all = true;
                } else {
                    self.views.iter_mut().for_each(|view| view.framing = Framing::All);
                }
            }
            ViewCommand::FrameSelected => self.views.iter_mut().for_each(|view| view.framing = Framing::Selected),
            ViewCommand::Parallel => {
                let free = self.views.iter_mut().find(|view| view.camera.direction == Direction::Free);
                if let Some(view) = free {
                    view.camera.parallel = !view.camera.parallel;
                }
            }
            ViewCommand::Maximise => self.toggle_maximised(context),
            ViewCommand::Stop => {
                if !self.close_front() && self.results.progress().is_some() {
                    self.worker.stop();
                    self.tell("stopped: the next change evaluates again");
                }
            }
            ViewCommand::Search => {
                let over = context.input(|i| i.pointer.latest_pos()).filter(|_| self.is_over_canvas(context));
                let place = over.or(self.canvas.rect.map(|rect| rect.center()));
                if let Some(place) = place {
                    self.canvas.toggle_search(place);
                }
            }
            ViewCommand::Keys => self.view.keys = !self.view.keys,
            ViewCommand::PickRow(row) => self.view.picked_row = row,
            ViewCommand::Welcome => self.view.welcome = true,
            ViewCommand::About => self.view.about = !self.view.about,
        }
    }

    /// Closes what stands before the panels; says whether something did.
    fn close_front(&mut self) -> bool {
        let view = &mut self.view;
        self.settings.welcomed |= view.welcome;
        let open = [&mut view.keys, &mut view.about, &mut view.welcome].into_iter().find(|open| **open);
        open.map(|open| *open = false).is_some()
    }

    fn leave_selection(&mut self) {
        self.view.selection = BTreeSet::new();
        self.view.active = None;
        self.view.displayed_within = None;
        self.view.picked_strokes.clear();
    }

    /// Selects the node that messages name so, in the graph where it is.
    fn find(&mut self, path: &str) {
        let mut graph = self.document.graph();
        let mut entered = Vec::new();
        let mut parts = path.split('/').peekable();
        while let Some(part) = parts.next() {
            // Of a repeated body the number of the run stands in the path too.
            let Some(id) = graph.find(part) else { continue };
            let within = graph.node(id).and_then(|node| node.body()).and_then(|body| body.graph());
            match within.filter(|_| parts.peek().is_some()) {
                Some(within) => {
                    entered.push(id);
                    graph = within;
                }
                None => {
                    self.view.path = entered;
                    self.view.selection = BTreeSet::from([id]);
                    self.view.active = Some(id);
                    return;
                }
            }
        }
        self.complain(format!("there is no node \"{path}\" any more"));
    }
}
