//! Changes of the graph.

use std::collections::BTreeSet;

use maquette_graph::edit::compound::{self, Incoming, Plan};
use maquette_graph::file::Includes;
use maquette_graph::{Edit, Graph, NodeId, NodeRecord, Source};

use crate::app::App;
use crate::canvas::{arrange, frames, swap};
use crate::command::{GraphCommand, NewLink};
use crate::naming::free_name;

/// How far copies stand from what they were copied from.
const OFFSET: [f64; 2] = [30.0, 30.0];

impl App {
    pub(super) fn apply_graph(&mut self, context: &egui::Context, command: GraphCommand) {
        match command {
            GraphCommand::Edit { name, edits, gesture } => self.make(&name, edits, gesture.as_deref()),
            GraphCommand::References { name, pictures, gesture } => {
                let edits = vec![Edit::References(pictures)];
                match self.document.step(&self.catalogue, &[], &name, edits, gesture.as_deref()) {
                    Ok(()) => self.view.message = None,
                    Err(error) => self.complain(error),
                }
            }
            GraphCommand::SelectByHand { mesh, strokes } => self.select_by_hand(mesh, strokes),
            GraphCommand::Strokes(deed) => self.apply_strokes(deed),
            GraphCommand::EndGesture => self.document.end_gesture(),
            GraphCommand::Undo => {
                let undone = self.document.undo(&self.catalogue);
                self.stepped("undid", undone);
            }
            GraphCommand::Redo => {
                let redone = self.document.redo(&self.catalogue);
                self.stepped("did again", redone);
            }
            GraphCommand::JumpTo(position) => {
                if let Err(error) = self.document.jump(&self.catalogue, position) {
                    self.complain(error);
                }
            }
            GraphCommand::Add { kind, at, link } => self.add(&kind, at, link),
            GraphCommand::DropOnLink { node, to, input, at } => self.drop_on_link(node, to, &input, at),
            GraphCommand::Delete => {
                let selected = &self.view.selection;
                let links = self.canvas.take_selected_links().into_iter().filter(|(to, _)| !selected.contains(to));
                let links = links.map(|(to, input)| Edit::Disconnect { to, input });
                let edits = links.chain(selected.iter().copied().map(Edit::RemoveNode)).collect();
                self.make("delete", edits, None);
            }
            GraphCommand::Dissolve => self.dissolve(),
            GraphCommand::Mute => {
                let selected = self.selected();
                let graph = self.canvas_graph();
                let muted = !selected.iter().all(|id| graph.node(*id).is_some_and(|node| node.is_muted()));
                let edits = selected.into_iter().map(|node| Edit::Mute { node, muted }).collect();
                self.make(if muted { "mute" } else { "unmute" }, edits, None);
            }
            GraphCommand::Duplicate { keep_links } => {
                let incoming = if keep_links { Incoming::Keep } else { Incoming::Drop };
                let plan = compound::duplicate(self.canvas_graph(), &self.selected(), incoming, OFFSET);
                self.carry_out("duplicate", plan);
            }
            GraphCommand::Copy => self.copy(context),
            GraphCommand::Cut => {
                self.copy(context);
                let edits = self.selected().into_iter().map(Edit::RemoveNode).collect();
                self.make("cut", edits, None);
            }
            GraphCommand::Paste { text } => self.paste(&text),
            GraphCommand::Group => {
                let name = free_name(self.canvas_graph(), "group");
                let plan = compound::group(self.canvas_graph(), &self.catalogue, &self.selected(), &name);
                self.carry_out("group", plan);
            }
            GraphCommand::Ungroup => {
                for id in self.selected() {
                    let plan = compound::ungroup(self.canvas_graph(), &self.catalogue, id);
                    self.carry_out("ungroup", plan);
                }
            }
            GraphCommand::Replace(kind) => {
                if let Some(id) = self.view.active {
                    let plan = compound::replace_kind(self.canvas_graph(), &self.catalogue, id, &kind);
                    self.carry_out(&format!("replace by {kind}"), plan);
                }
            }
            GraphCommand::Promote { node, input } => {
                let plan = compound::promote(self.canvas_graph(), node, &input);
                self.carry_out(&format!("promote {input}"), plan);
            }
            GraphCommand::Arrange => {
                let places = arrange::arrange(self.canvas_graph(), &self.view.expanded);
                self.place("arrange", places);
                self.canvas.frame_all = true;
            }
            GraphCommand::ArrangeSelected => {
                let rects = self.canvas.rects(&self.view.path, &self.view.selection);
                let corner = rects.iter().map(|(_, rect)| rect.min).reduce(|a, b| a.min(b)).unwrap_or_default();
                let (expanded, selected) = (&self.view.expanded, &self.view.selection);
                let places = arrange::arrange_selected(self.canvas_graph(), expanded, selected, corner);
                self.place("arrange selected", places);
            }
            GraphCommand::Align(alignment) => {
                let (ids, rects): (Vec<_>, Vec<_>) =
                    self.canvas.rects(&self.view.path, &self.view.selection).into_iter().unzip();
                let places = alignment.places(&rects);
                self.place(&alignment.name().to_lowercase(), ids.into_iter().zip(places));
            }
            GraphCommand::Frame => {
                let rects = self.canvas.rects(&self.view.path, &self.view.selection);
                match frames::around(rects.into_iter().map(|(_, rect)| rect)) {
                    Some(frame) => {
                        let mut all = self.canvas_graph().frames().to_vec();
                        all.push(frame);
                        self.make("frame nodes", vec![Edit::Frames(all)], None);
                    }
                    None => self.complain("select the nodes that the frame is to be put around"),
                }
            }
            GraphCommand::Collapse => {
                let selected = self.selected();
                let graph = self.canvas_graph();
                let collapsed = !selected.iter().all(|id| graph.node(*id).is_some_and(|node| node.is_collapsed()));
                let edits = selected.into_iter().map(|node| Edit::Collapse { node, collapsed }).collect();
                self.make(if collapsed { "collapse" } else { "open out" }, edits, None);
            }
            GraphCommand::Swap => self.swap(),
        }
    }

    /// Puts nodes there, as one step.
    fn place(&mut self, name: &str, places: impl IntoIterator<Item = (NodeId, egui::Pos2)>) {
        let edits = places
            .into_iter()
            .map(|(node, place)| Edit::Move { node, position: Some([f64::from(place.x), f64::from(place.y)]) });
        self.make(name, edits.collect(), None);
    }

    /// Lets what the first two inputs of the active node hold change places, or says why it can't.
    fn swap(&mut self) {
        let Some(node) = self.view.active else {
            self.complain("select the node whose first two inputs are to change places");
            return;
        };
        match swap::swap(self.canvas_graph(), &self.catalogue, node) {
            Ok(edits) => self.make("swap inputs", edits, None),
            Err(error) => self.complain(error),
        }
    }

    /// The graph on the canvas.
    pub(crate) fn canvas_graph(&self) -> &Graph {
        self.document.graph_at(&self.view.path).unwrap_or(self.document.graph())
    }

    fn selected(&self) -> Vec<NodeId> {
        self.view.selection.iter().copied().collect()
    }

    /// Makes edits of the graph on the canvas a step.
    pub(super) fn make(&mut self, name: &str, edits: Vec<Edit>, gesture: Option<&str>) {
        let made = self.document.step(&self.catalogue, &self.view.path, name, edits, gesture);
        match made {
            Ok(()) => self.view.message = None,
            Err(error) => self.complain(error),
        }
    }

    fn stepped<E: std::fmt::Display>(&mut self, what: &str, step: Result<Option<String>, E>) {
        match step {
            Ok(Some(name)) => self.tell(format!("{what}: {name}")),
            Ok(None) => self.tell("nothing more"),
            Err(error) => self.complain(error),
        }
    }

    /// Makes a plan a step, selects what came of it, and tells what could not be kept.
    fn carry_out<E: std::fmt::Display>(&mut self, name: &str, plan: Result<Plan, E>) {
        match plan {
            Err(error) => self.complain(error),
            Ok(plan) => {
                let remarks: Vec<String> = plan.remarks.iter().map(ToString::to_string).collect();
                let made = self.document.step(&self.catalogue, &self.view.path, name, plan.edits, None);
                if let Err(error) = made {
                    self.complain(error);
                    return;
                }
                if !plan.nodes.is_empty() {
                    self.view.active = plan.nodes.last().copied();
                    self.view.selection = plan.nodes.into_iter().collect();
                }
                self.view.message = None;
                if !remarks.is_empty() {
                    self.tell(remarks.join("; "));
                }
            }
        }
    }

    fn add(&mut self, kind: &str, at: [f64; 2], link: NewLink) {
        let graph = self.canvas_graph();
        let name = free_name(graph, kind);
        let Some(declared) = self.catalogue.kind(kind).cloned() else {
            self.complain(format!("no node kind is named \"{kind}\""));
            return;
        };
        let mut record = NodeRecord::new(kind, name.clone()).at(at);
        let mut feeds = None;
        match &link {
            NewLink::None => {}
            NewLink::From { node, output } => {
                let given = graph.node(*node).and_then(|node| Some(node.kind()?.find_output(output)?.1.wire));
                if let Some(input) = given.and_then(|given| {
                    best(
                        declared.inputs(),
                        |input| input.wire,
                        |wire| wire == given,
                        |wire| self.catalogue.fits(given, wire),
                    )
                }) {
                    record = record.link(input.name.clone(), *node, output.clone());
                }
            }
            NewLink::To { node, input } => {
                let taken = graph.node(*node).and_then(|node| Some(node.kind()?.find_input(input)?.wire));
                if let Some(output) = taken.and_then(|taken| {
                    best(
                        declared.outputs(),
                        |output| output.wire,
                        |wire| wire == taken,
                        |wire| self.catalogue.fits(wire, taken),
                    )
                }) {
                    feeds = Some((output.name.clone(), *node, input.clone()));
                }
            }
        }
        let before: BTreeSet<NodeId> = graph.nodes().map(|(id, _)| id).collect();
        self.document.begin(&format!("add {name}"));
        let path = self.view.path.clone();
        let mut made = self.document.part(&self.catalogue, &path, Edit::AddNode(Box::new(record)));
        let fresh = self.canvas_graph().nodes().map(|(id, _)| id).find(|id| !before.contains(id));
        if let (Ok(()), Some((output, to, input)), Some(id)) = (&made, feeds, fresh) {
            made = self.document.part(&self.catalogue, &path, Edit::connect(id, output, to, input));
        }
        self.document.commit();
        match made {
            Ok(()) => self.view.message = None,
            Err(error) => self.complain(error),
        }
        if let Some(id) = fresh {
            self.view.selection = BTreeSet::from([id]);
            self.view.active = Some(id);
        }
    }

    /// Leads a link through a node that was dropped on it.
    fn drop_on_link(&mut self, id: NodeId, to: NodeId, input: &str, at: [f64; 2]) {
        let moved = Edit::Move { node: id, position: Some(at) };
        let graph = self.canvas_graph();
        let ends = graph.node(to).and_then(|node| match node.source(input)? {
            Source::Link(link) => {
                let given = graph.node(link.node)?.kind()?.find_output(&link.output)?.1.wire;
                let taken = graph.node(to)?.kind()?.find_input(input)?.wire;
                let kind = graph.node(id)?.kind()?;
                let enters = best(
                    kind.inputs(),
                    |port| port.wire,
                    |wire| wire == given,
                    |wire| self.catalogue.fits(given, wire),
                )?;
                let leaves = best(
                    kind.outputs(),
                    |port| port.wire,
                    |wire| wire == taken,
                    |wire| self.catalogue.fits(wire, taken),
                )?;
                let enter = Edit::connect(link.node, link.output.clone(), id, enters.name.clone());
                Some([enter, Edit::connect(id, leaves.name.clone(), to, input)])
            }
            _ => None,
        });
        match ends {
            Some([enter, leave]) => self.make("insert into a link", vec![moved, enter, leave], None),
            None => self.make("move nodes", vec![moved], None),
        }
    }

    fn dissolve(&mut self) {
        let mut remarks = Vec::new();
        for id in self.selected() {
            match compound::dissolve(self.canvas_graph(), &self.catalogue, id) {
                Ok(plan) => {
                    remarks.extend(plan.remarks.iter().map(ToString::to_string));
                    self.make("dissolve", plan.edits, None);
                }
                Err(error) => self.complain(error),
            }
        }
        if !remarks.is_empty() {
            self.tell(remarks.join("; "));
        }
    }

    fn copy(&mut self, context: &egui::Context) {
        let selected = self.selected();
        if selected.is_empty() {
            return;
        }
        match compound::copy(self.canvas_graph(), &selected) {
            Ok(text) => {
                context.copy_text(text);
                self.tell(format!("copied {} node(s) as text", selected.len()));
            }
            Err(error) => self.complain(error),
        }
    }

    fn paste(&mut self, text: &str) {
        let folder = self.document.folder();
        let project = self.document.project();
        let read = |path: &std::path::Path| project.read(&folder.join(path));
        let includes = Includes::new("", &read);
        let plan = compound::paste_with(self.canvas_graph(), &self.catalogue, text, OFFSET, &includes);
        self.carry_out("paste", plan);
    }
}

/// The first port of the very type, or else the first that fits.
fn best<P>(
    ports: &[P],
    wire: impl Fn(&P) -> maquette_graph::WireType,
    same: impl Fn(maquette_graph::WireType) -> bool,
    fits: impl Fn(maquette_graph::WireType) -> bool,
) -> Option<&P> {
    ports.iter().find(|port| same(wire(port))).or_else(|| ports.iter().find(|port| fits(wire(port))))
}
