//! Selections made by hand: a loop drawn around a part of a mesh, and vertices painted with a brush.
//!
//! They become nodes that hold what was drawn, never numbers of vertices, so that they survive when the mesh upstream changes:
//! a sketch with the loop and a node that selects by strokes, or a node that selects the vertices nearest to points.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use maquette_geometry::mesh::{Mesh, MeshRays, triangles};
use maquette_graph::{Catalogue, Choice, Edit, Literal, LiteralKind, NodeId, NodeKind, Source, Stroke, WireType};
use maquette_nodes::wire;

use crate::command::{Command, GraphCommand, Message};
use crate::panel::PanelContext;
use crate::sketch::smooth::smoothed;
use crate::sketch::target::{Plane, stroke_point};
use crate::view_state::Tool;

use super::sketch_tool::ToolView;

/// A kind that makes selections by hand, and the names of its ports.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct SelectingKind {
    /// Its name.
    pub(crate) kind: String,
    /// The input that takes the mesh.
    pub(crate) mesh: String,
    /// The input that takes what was drawn.
    pub(crate) drawn: String,
}

fn selecting(catalogue: &Catalogue, drawn: impl Fn(&NodeKind) -> Option<String>) -> Option<SelectingKind> {
    catalogue.kinds().find_map(|kind| {
        kind.outputs().iter().find(|output| output.wire == WireType::of::<wire::Selection>())?;
        let mesh = kind.inputs().iter().find(|input| input.wire == WireType::of::<wire::Mesh>())?;
        Some(SelectingKind { kind: kind.name().to_owned(), mesh: mesh.name.clone(), drawn: drawn(kind)? })
    })
}

/// The kind that selects what lies in strokes drawn in a view.
pub(crate) fn by_stroke(catalogue: &Catalogue) -> Option<SelectingKind> {
    selecting(catalogue, |kind| {
        let view = kind.find_input("view").filter(|view| view.wire == WireType::of::<Choice>());
        let strokes = kind.inputs().iter().find(|input| input.wire == WireType::of::<wire::Curves>());
        view.and(strokes).map(|strokes| strokes.name.clone())
    })
}

/// The kind that selects the vertices nearest to points written as text.
pub(crate) fn by_points(catalogue: &Catalogue) -> Option<SelectingKind> {
    selecting(catalogue, |kind| {
        let points = kind.find_input("points")?;
        (LiteralKind::of_wire(points.wire) == Some(LiteralKind::Text)).then(|| points.name.clone())
    })
}

/// The output of the active node that gives a mesh; of one that selects, the mesh that it selects on.
pub(crate) fn active_mesh(context: &PanelContext<'_>) -> Option<(NodeId, String)> {
    let (id, node) = context.active()?;
    let kind = node.kind()?;
    let output = kind.outputs().iter().find(|output| output.wire == WireType::of::<wire::Mesh>());
    if let Some(output) = output {
        return Some((id, output.name.clone()));
    }
    let input = kind.inputs().iter().find(|input| input.wire == WireType::of::<wire::Mesh>())?;
    match node.source(&input.name)? {
        Source::Link(link) => Some((link.node, link.output.clone())),
        _ => None,
    }
}

/// What is drawn from press to release.
#[derive(Clone, Debug)]
enum Gesture {
    Loop { plane: Plane, drawn: Vec<DVec2> },
    Paint { node: NodeId, input: String, points: BTreeSet<[i64; 3]>, removes: bool, mesh: Arc<Mesh>, rays: MeshRays },
}

/// The tool of one view.
#[derive(Clone, Debug, Default)]
pub(crate) struct SelectionTool {
    gesture: Option<Gesture>,
}

/// Coordinates are kept to a hundredth of a millimetre.
const GRAIN: f64 = 1e-5;

fn key(place: DVec3) -> [i64; 3] {
    #[expect(clippy::cast_possible_truncation, reason = "models are far smaller than what a whole number reaches")]
    (place / GRAIN).round().to_array().map(|c| c as i64)
}

/// Points as the node's text has them.
fn text_of(points: &BTreeSet<[i64; 3]>) -> String {
    #[expect(clippy::cast_precision_loss, reason = "models are far smaller than what a number reaches exactly")]
    let written = |c: &i64| {
        let text = format!("{:.5}", *c as f64 * GRAIN);
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    };
    let rows = points.iter().map(|point| point.iter().map(written).collect::<Vec<_>>().join(" "));
    rows.collect::<Vec<_>>().join(", ")
}

/// The points of such a text, as far as they can be read.
fn points_of(text: &str) -> BTreeSet<[i64; 3]> {
    let entries = text.split([',', ';', '\n']).map(str::trim).filter(|entry| !entry.is_empty());
    let point = |entry: &str| {
        let numbers: Vec<f64> = entry.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        <[f64; 3]>::try_from(numbers).ok().map(|place| key(DVec3::from_array(place)))
    };
    entries.filter_map(point).collect()
}

impl SelectionTool {
    /// The line that is being drawn, in its plane.
    pub(crate) fn drawn(&self) -> Option<(Plane, &[DVec2])> {
        match &self.gesture {
            Some(Gesture::Loop { plane, drawn }) => Some((*plane, drawn)),
            _ => None,
        }
    }

    pub(crate) fn press(&mut self, context: &mut PanelContext<'_>, view: &ToolView<'_>, at: egui::Vec2, removes: bool) {
        self.gesture = None;
        if active_mesh(context).is_none() {
            let text = "select a node that gives a mesh, or one that selects of it, to select by hand";
            context.ask(Command::Say(Message::error(text)));
            return;
        }
        if context.view.tool == Tool::Lasso {
            let begun = Plane::of_view(view.camera.direction).and_then(|plane| Some((plane, view.meet(plane, at)?)));
            match begun {
                Some((plane, begin)) => self.gesture = Some(Gesture::Loop { plane, drawn: vec![begin] }),
                None => context.ask(Command::Say(Message::error("draw the loop in the front, side or top view"))),
            }
            return;
        }
        let Some(kind) = by_points(context.catalogue) else { return };
        match context.active().filter(|(_, node)| node.kind_name() == kind.kind) {
            Some((node, held)) => {
                // The default is one point, which nobody painted.
                let points = match held.source(&kind.drawn) {
                    Some(Source::Literal { literal: Literal::Text(text), .. }) => points_of(text),
                    None => BTreeSet::new(),
                    _ => {
                        let text = "its points come from elsewhere: reset the input to paint here";
                        context.ask(Command::Say(Message::error(text)));
                        return;
                    }
                };
                let values = context.values(node).unwrap_or_default();
                let selection = values.iter().find_map(|value| value.get::<wire::Selection>());
                let Some((mesh, rays)) = selection
                    .and_then(|selection| Some((selection.mesh.clone(), MeshRays::new(&selection.mesh).ok()?)))
                else {
                    context.ask(Command::Say(Message::error("there is no mesh yet: wait, or mend what failed")));
                    return;
                };
                self.gesture = Some(Gesture::Paint { node, input: kind.drawn, points, removes, mesh, rays });
                self.drag(context, view, at);
            }
            None => {
                if let Some(mesh) = active_mesh(context) {
                    context.ask(GraphCommand::SelectByHand { mesh, strokes: None });
                }
            }
        }
    }

    pub(crate) fn drag(&mut self, context: &mut PanelContext<'_>, view: &ToolView<'_>, at: egui::Vec2) {
        match &mut self.gesture {
            None => {}
            Some(Gesture::Loop { plane, drawn }) => {
                if let Some(point) = view.meet(*plane, at)
                    && drawn.last().is_none_or(|last| last.distance(point) > view.metres(2.0))
                {
                    drawn.push(point);
                }
            }
            Some(Gesture::Paint { node, input, points, removes, mesh, rays }) => {
                let before = points.len();
                let (origin, along) = view.camera.ray(view.size, at);
                if let Some(hit) = rays.first(origin, along) {
                    brush(mesh, hit.point, along, context.settings.brush, points, *removes);
                }
                if points.len() != before {
                    let literal = Literal::Text(text_of(points));
                    let edits = vec![Edit::set(*node, input.clone(), literal)];
                    let gesture = Some(format!("paint {node:?}"));
                    context.ask(GraphCommand::Edit { name: "paint a selection".to_owned(), edits, gesture });
                }
            }
        }
    }

    pub(crate) fn release(&mut self, context: &mut PanelContext<'_>, view: &ToolView<'_>) {
        match self.gesture.take() {
            None => {}
            Some(Gesture::Paint { .. }) => context.ask(GraphCommand::EndGesture),
            Some(Gesture::Loop { plane, drawn }) => {
                if drawn.len() < 4 {
                    return;
                }
                let line = smoothed(&drawn, true, view.metres(1.0));
                let points = line.into_iter().map(stroke_point).collect();
                let stroke = Stroke { name: "loop".to_owned(), closed: true, points };
                if let (Some(mesh), Some(view)) = (active_mesh(context), plane.view.plane()) {
                    context.ask(GraphCommand::SelectByHand { mesh, strokes: Some((view, stroke)) });
                }
            }
        }
    }
}

/// Adds the vertices within `radius` metres of a point of the surface that face the viewer, who looks `along`, or takes them
/// away.
fn brush(mesh: &Mesh, middle: DVec3, along: DVec3, radius: f64, points: &mut BTreeSet<[i64; 3]>, removes: bool) {
    let (positions, corners) = (mesh.positions(), mesh.corners());
    for triangle in triangles(mesh) {
        let [a, b, c] = triangle.map(|corner| positions[corners[corner] as usize]);
        if (b - a).cross(c - a).dot(along) >= 0.0 {
            continue;
        }
        for place in [a, b, c].into_iter().filter(|place| place.distance(middle) <= radius) {
            if removes {
                points.remove(&key(place));
            } else {
                points.insert(key(place));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_kinds_that_select_by_hand_are_found_by_their_ports() {
        let catalogue = maquette_nodes::catalogue().unwrap();
        let kind = by_stroke(&catalogue).unwrap();
        assert_eq!(
            (kind.kind.as_str(), kind.mesh.as_str(), kind.drawn.as_str()),
            ("select-by-stroke", "mesh", "strokes")
        );
        assert_eq!(by_points(&catalogue).unwrap().kind, "select-points");
    }

    #[test]
    fn points_go_through_their_text() {
        let points: BTreeSet<[i64; 3]> = [key(DVec3::new(0.1, -1.25, 0.0)), key(DVec3::new(3.0, 0.00001, 2.5))].into();
        assert_eq!(text_of(&points), "0.1 -1.25 0, 3 0.00001 2.5");
        assert_eq!(points_of(&text_of(&points)), points);
        assert!(points_of("").is_empty() && points_of("1 2, x").is_empty());
    }
}
