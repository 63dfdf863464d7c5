//! Nodes for selections that are made by hand.

use std::collections::BTreeSet;

use maquette_graph::{Edit, EditError, Literal, NodeId, NodeRecord, Stroke};

use crate::app::App;
use crate::naming::free_name;
use crate::viewport::selection_tool::{by_points, by_stroke};
use crate::viewport::sketch_tool::sketch_kind;

/// How far beside the mesh's node the new ones stand, points.
const BESIDE: f64 = 240.0;

impl App {
    /// Adds what selects of a mesh, and selects it, as one step.
    pub(super) fn select_by_hand(&mut self, (mesh, output): (NodeId, String), strokes: Option<(&'static str, Stroke)>) {
        let place = self.canvas_graph().node(mesh).and_then(|node| node.position());
        let at = |record: NodeRecord, dx: f64, dy: f64| match place {
            Some([x, y]) => record.at([x + dx, y + dy]),
            None => record,
        };
        self.document.begin("select by hand");
        let made = match strokes {
            None => by_points(&self.catalogue).map(|kind| {
                let name = free_name(self.canvas_graph(), "painted");
                let record = NodeRecord::new(kind.kind, name).link(kind.mesh, mesh, output);
                // Nothing is painted yet; the default would be a point.
                self.part(at(record.literal(kind.drawn, Literal::Text(String::new())), BESIDE, 60.0))
            }),
            Some((plane, stroke)) => {
                by_stroke(&self.catalogue).zip(sketch_kind(&self.catalogue)).map(|(kind, sketch)| {
                    let name = free_name(self.canvas_graph(), "loop");
                    let record = NodeRecord::new(sketch.0, name)
                        .literal(sketch.1, Literal::Strokes(vec![stroke]))
                        .literal("plane", Literal::Choice(plane.to_owned()));
                    let drawn = self.part(at(record, 0.0, 160.0))?;
                    let curves = self.canvas_graph().node(drawn).and_then(|node| node.kind());
                    let curves = curves.and_then(|kind| Some(kind.outputs().first()?.name.clone())).unwrap_or_default();
                    let name = free_name(self.canvas_graph(), "selected");
                    let record = NodeRecord::new(kind.kind, name)
                        .link(kind.mesh, mesh, output)
                        .link(kind.drawn, drawn, curves)
                        .literal("view", Literal::Choice(plane.to_owned()));
                    self.part(at(record, BESIDE, 60.0))
                })
            }
        };
        self.document.commit();
        match made {
            None => self.complain("this program has no node that selects by hand"),
            Some(Err(error)) => self.complain(error),
            Some(Ok(id)) => {
                self.view.selection = BTreeSet::from([id]);
                self.view.active = Some(id);
                self.tell("drag over the surface to select; with Ctrl to take away");
            }
        }
    }

    /// Adds a node as a part of the step that was begun, and gives its identity.
    fn part(&mut self, record: NodeRecord) -> Result<NodeId, EditError> {
        let before: BTreeSet<NodeId> = self.canvas_graph().nodes().map(|(id, _)| id).collect();
        let name = record.name().to_owned();
        let path = self.view.path.clone();
        self.document.part(&self.catalogue, &path, Edit::AddNode(Box::new(record)))?;
        let fresh = self.canvas_graph().nodes().map(|(id, _)| id).find(|id| !before.contains(id));
        fresh.ok_or(EditError::Outdated(name))
    }
}
