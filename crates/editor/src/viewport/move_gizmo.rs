//! Arrows and a ring on what the active node moves: a handle, a mesh, the middle of a box. They write the node's own inputs, so
//! that what depends on them follows in the same frames.
//!
//! Any node has it with a vector in metres named `translate` or `offset` (what it makes is moved by it), or `centre`, `origin`,
//! `near`, `point` or `pivot` (a place by itself); with an `axis` and an `angle` beside it a ring turns, beyond whole turns too.

use egui::{Color32, Pos2, Stroke};
use glam::DVec3;
use maquette_geometry::mesh::measure::points_bounds;
use maquette_graph::{Cell, Edit, Literal, NodeId, Report, Source, Unit};

use crate::command::GraphCommand;
use crate::panel::PanelContext;

use super::draw::AXES;
use super::pick::near_segment;
use super::sketch_tool::ToolView;

/// Length of an arrow on the screen, points.
const ARROW: f32 = 58.0;
/// Radius of the ring, points.
const RING: f32 = 44.0;
/// How near the pointer must come, points.
const REACH: f32 = 7.0;
/// Points of the ring.
const POINTS: usize = 64;
/// Arrows shorter than this on the screen point at the viewer and can't be dragged, points.
const SHORT: f32 = 14.0;
const HOT: Color32 = Color32::from_rgb(255, 214, 120);

/// What the active node moves.
#[derive(Clone, Debug, PartialEq)]
struct Moved {
    node: NodeId,
    input: String,
    value: DVec3,
    /// Where the arrows stand, metres.
    anchor: DVec3,
    /// The axis of the ring and the angle that it changes, degrees.
    turn: Option<(DVec3, f64)>,
}

/// A part of the gizmo.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Part {
    Arrow(usize),
    Middle,
    Ring,
}

#[derive(Clone, Debug)]
struct Gesture {
    base: Moved,
    part: Part,
    begin: egui::Vec2,
    /// Where on the ring the pointer was last, and how far it went from the beginning, radians.
    last: f64,
    turned: f64,
}

/// The gizmo of one view.
#[derive(Clone, Debug, Default)]
pub(crate) struct MoveGizmo {
    gesture: Option<Gesture>,
}

/// A vector of a node that is its own, and whether it is an offset.
fn vector(context: &PanelContext<'_>, id: NodeId) -> Option<(String, DVec3, bool)> {
    let node = context.graph().node(id)?;
    let kind = node.kind()?;
    let held = |name: &str| {
        let spec = kind.find_input(name).filter(|spec| spec.unit == Unit::Length)?;
        match node.source(name) {
            None => spec.default.clone(),
            Some(Source::Literal { literal, .. }) => Some(literal.clone()),
            _ => None,
        }
    };
    let offsets = ["translate", "offset"].map(|name| (name, true));
    let places = ["centre", "origin", "near", "point", "pivot"].map(|name| (name, false));
    offsets.into_iter().chain(places).find_map(|(name, is_offset)| match held(name)? {
        Literal::Vector(vector) => Some((name.to_owned(), DVec3::from_array(vector), is_offset)),
        _ => None,
    })
}

fn turn_of(context: &PanelContext<'_>, id: NodeId) -> Option<(DVec3, f64)> {
    let node = context.graph().node(id)?;
    let kind = node.kind()?;
    let held = |name: &str| match node.source(name) {
        None => kind.find_input(name)?.default.clone(),
        Some(Source::Literal { literal, .. }) => Some(literal.clone()),
        _ => None,
    };
    let (Literal::Vector(axis), Literal::Number(angle)) = (held("axis")?, held("angle")?) else { return None };
    Some((DVec3::from_array(axis).try_normalize()?, angle))
}

/// Where a node says that it turns: the row of its table `pivot`.
fn pivot(report: &Report) -> Option<DVec3> {
    let table = report.tables.iter().find(|table| table.name == "pivot")?;
    let mut numbers = table.rows.first()?.iter().filter_map(|cell| match cell {
        Cell::Number(number) => Some(*number),
        Cell::Text(_) => None,
    });
    Some(DVec3::new(numbers.next()?, numbers.next()?, numbers.next()?))
}

/// What the active node moves, and where.
fn moved(context: &PanelContext<'_>) -> Option<Moved> {
    let node = context.view.active?;
    let (input, value, is_offset) = vector(context, node)?;
    let anchor = if is_offset {
        // Where the node says that it turns, or else the middle of what it gives.
        match context.report(node).and_then(pivot) {
            Some(pivot) => pivot + value,
            None => {
                let shown = context.results.shown().iter().filter(|shown| shown.node == node && context.is_here(shown));
                let boxes = shown.flat_map(|shown| shown.drawables.iter().filter_map(|drawable| drawable.bounds));
                points_bounds(boxes.flatten()).map_or(value, |(low, high)| 0.5 * (low + high))
            }
        }
    } else {
        value
    };
    Some(Moved { node, input, value, anchor, turn: turn_of(context, node) })
}

impl Moved {
    fn seen(&self, view: &ToolView<'_>, place: DVec3) -> Option<egui::Vec2> {
        view.camera.project(view.size, place)
    }

    /// The tip of an arrow.
    fn tip(&self, view: &ToolView<'_>, axis: usize) -> Option<egui::Vec2> {
        self.seen(view, self.anchor + DVec3::AXES[axis] * view.metres(ARROW))
    }

    /// The ring, closed.
    fn ring(&self, view: &ToolView<'_>) -> Vec<egui::Vec2> {
        let Some((axis, _)) = self.turn else { return Vec::new() };
        let (u, v) = axis.any_orthonormal_pair();
        let radius = view.metres(RING);
        #[expect(clippy::cast_precision_loss, reason = "a few points")]
        let angle = |k: usize| k as f64 / POINTS as f64 * std::f64::consts::TAU;
        let place = |k: usize| self.anchor + radius * (u * angle(k).cos() + v * angle(k).sin());
        (0..=POINTS).filter_map(|k| self.seen(view, place(k))).collect()
    }

    /// The part under a point of the view.
    fn under(&self, view: &ToolView<'_>, at: egui::Vec2) -> Option<Part> {
        let middle = self.seen(view, self.anchor)?;
        if (middle - at).length() <= REACH {
            return Some(Part::Middle);
        }
        let arrow = (0..3).find(|axis| {
            let tip = self.tip(view, *axis).filter(|tip| (*tip - middle).length() > SHORT);
            tip.is_some_and(|tip| near_segment(at, middle, tip).0 <= REACH)
        });
        let ring = self.ring(view);
        arrow
            .map(Part::Arrow)
            .or_else(|| ring.windows(2).any(|pair| near_segment(at, pair[0], pair[1]).0 <= REACH).then_some(Part::Ring))
    }

    /// Where on the ring's plane the pointer is, as an angle; `None` where the plane is seen from its edge.
    fn angle(&self, view: &ToolView<'_>, at: egui::Vec2) -> Option<f64> {
        let (axis, _) = self.turn?;
        let (origin, along) = view.camera.ray(view.size, at);
        let (u, v) = axis.any_orthonormal_pair();
        let towards = along.dot(axis);
        if towards.abs() < 0.1 {
            return None;
        }
        let on = origin + along * ((self.anchor - origin).dot(axis) / towards) - self.anchor;
        Some(on.dot(v).atan2(on.dot(u)))
    }

    /// How far along an axis of the world the pointer is, metres.
    fn along(&self, view: &ToolView<'_>, axis: usize, at: egui::Vec2) -> Option<f64> {
        let (origin, ray) = view.camera.ray(view.size, at);
        let direction = DVec3::AXES[axis];
        // The point of the axis that is nearest to the ray.
        let (across, apart) = (direction.dot(ray), self.anchor - origin);
        let sine = 1.0 - across * across;
        (sine > 1e-4).then(|| (across * apart.dot(ray) - apart.dot(direction)) / sine)
    }

    /// Where the pointer is in the plane of the view through the anchor.
    fn across(&self, view: &ToolView<'_>, at: egui::Vec2) -> Option<DVec3> {
        let (origin, ray) = view.camera.ray(view.size, at);
        let back = view.camera.frame()[2];
        let towards = ray.dot(back);
        (towards.abs() > 1e-6).then(|| origin + ray * ((self.anchor - origin).dot(back) / towards))
    }
}

fn rounded(value: f64, step: f64) -> f64 {
    let value = (value / step).round() * step;
    // What is left of the division would fill the file with digits.
    let value = (value * 1e6).round() / 1e6;
    if value == 0.0 { 0.0 } else { value }
}

impl MoveGizmo {
    /// Takes hold of what is under the pointer; says whether there is something.
    pub(crate) fn press(&mut self, context: &PanelContext<'_>, view: &ToolView<'_>, at: egui::Vec2) -> bool {
        self.gesture = moved(context).and_then(|base| {
            let part = base.under(view, at)?;
            let last = base.angle(view, at).unwrap_or(0.0);
            Some(Gesture { base, part, begin: at, last, turned: 0.0 })
        });
        self.gesture.is_some()
    }

    /// Whether something is held.
    pub(crate) fn is_held(&self) -> bool {
        self.gesture.is_some()
    }

    pub(crate) fn drag(&mut self, context: &mut PanelContext<'_>, view: &ToolView<'_>, at: egui::Vec2, exact: bool) {
        let Some(Gesture { base, part, begin, last, turned }) = &mut self.gesture else { return };
        let (name, edit) = match part {
            Part::Ring => {
                let Some((_, before)) = base.turn else { return };
                let Some(now) = base.angle(view, at) else { return };
                // Always the shorter way from where it was last, so that whole turns add up.
                let turn = std::f64::consts::TAU;
                let step = (now - *last + 1.5 * turn).rem_euclid(turn) - 0.5 * turn;
                *turned += step;
                *last = now;
                let angle = rounded(before + turned.to_degrees(), if exact { 15.0 } else { 0.1 });
                ("turn", Edit::set(base.node, "angle", Literal::Number(angle)))
            }
            Part::Arrow(axis) => {
                let (Some(from), Some(to)) = (base.along(view, *axis, *begin), base.along(view, *axis, at)) else {
                    return;
                };
                let mut value = base.value;
                value[*axis] += to - from;
                ("move", set(base, value, exact))
            }
            Part::Middle => {
                let (Some(from), Some(to)) = (base.across(view, *begin), base.across(view, at)) else { return };
                ("move", set(base, base.value + to - from, exact))
            }
        };
        let gesture = Some(format!("{name} {:?}", base.node));
        let held = context.graph().node(base.node).map_or("", |node| node.name());
        context.ask(GraphCommand::Edit { name: format!("{name} {held}"), edits: vec![edit], gesture });
    }

    pub(crate) fn release(&mut self, context: &mut PanelContext<'_>) {
        if self.gesture.take().is_some() {
            context.ask(GraphCommand::EndGesture);
        }
    }

    /// Draws the arrows and the ring.
    pub(crate) fn show(
        &self,
        painter: &egui::Painter,
        corner: Pos2,
        context: &PanelContext<'_>,
        view: &ToolView<'_>,
        hover: Option<egui::Vec2>,
    ) {
        let Some(moved) = moved(context) else { return };
        let Some(middle) = moved.seen(view, moved.anchor) else { return };
        let hot = match &self.gesture {
            Some(gesture) => Some(gesture.part),
            None => hover.and_then(|at| moved.under(view, at)),
        };
        for (axis, [r, g, b, _]) in AXES.into_iter().enumerate() {
            let Some(tip) = moved.tip(view, axis).filter(|tip| (*tip - middle).length() > SHORT) else { continue };
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
            let own = Color32::from_rgb((r * 255.0) as u8, (g * 255.0) as u8, (b * 255.0) as u8);
            let colour = if hot == Some(Part::Arrow(axis)) { HOT } else { own };
            painter.arrow(corner + middle, tip - middle, Stroke::new(3.0, colour));
        }
        let ring: Vec<Pos2> = moved.ring(view).into_iter().map(|at| corner + at).collect();
        let colour = if hot == Some(Part::Ring) { HOT } else { Color32::from_rgb(255, 160, 45) };
        painter.add(egui::Shape::line(ring, Stroke::new(2.5, colour)));
        let colour = if hot == Some(Part::Middle) { HOT } else { Color32::WHITE };
        painter.circle(corner + middle, 5.0, Color32::from_gray(40), Stroke::new(2.0, colour));
        if let (Some(Gesture { part: Part::Ring, .. }), Some((_, angle))) = (&self.gesture, moved.turn) {
            let font = egui::FontId::proportional(13.0);
            let place = corner + middle + egui::vec2(12.0, -12.0);
            painter.text(place, egui::Align2::LEFT_BOTTOM, format!("{angle:.1}°"), font, HOT);
        }
    }
}

/// Writes a vector, to a tenth of a millimetre, or with `exact` to a centimetre.
fn set(base: &Moved, value: DVec3, exact: bool) -> Edit {
    let step = if exact { 0.01 } else { 1e-4 };
    // What is not moved stays as it was typed.
    let moved = |k: usize| if value[k] == base.value[k] { value[k] } else { rounded(value[k], step) };
    Edit::set(base.node, base.input.clone(), Literal::Vector([moved(0), moved(1), moved(2)]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewport::camera::{Camera, Direction, ViewSize};
    use glam::DQuat;

    fn held(anchor: DVec3) -> Moved {
        let graph_node = {
            let catalogue = maquette_nodes::catalogue().unwrap();
            let mut graph = maquette_graph::Graph::new();
            graph.add(&catalogue, "handle", "handle").unwrap()
        };
        Moved {
            node: graph_node,
            input: "translate".to_owned(),
            value: DVec3::ZERO,
            anchor,
            turn: Some((DVec3::Y, 0.0)),
        }
    }

    #[test]
    fn dragging_along_an_arrow_moves_along_its_axis_in_every_view() {
        for direction in Direction::ALL {
            let camera = Camera::new(direction);
            let view = ToolView { camera: &camera, size: ViewSize::new(egui::vec2(500.0, 400.0)) };
            let moved = held(DVec3::new(0.1, 1.1, 0.2));
            for axis in 0..3 {
                let (Some(from), Some(tip)) = (moved.seen(&view, moved.anchor), moved.tip(&view, axis)) else {
                    continue;
                };
                if (tip - from).length() <= SHORT {
                    continue;
                }
                assert_eq!(
                    moved.under(&view, from + (tip - from) * 0.9),
                    Some(Part::Arrow(axis)),
                    "{direction:?} {axis}"
                );
                let [a, b] = [from, tip].map(|at| moved.along(&view, axis, at).unwrap());
                assert!((b - a - view.metres(ARROW)).abs() < 1e-4, "{direction:?} {axis}: {}", b - a);
            }
        }
    }

    #[test]
    fn the_ring_measures_angles_about_its_axis() {
        let camera = Camera::new(Direction::Top);
        let view = ToolView { camera: &camera, size: ViewSize::new(egui::vec2(500.0, 400.0)) };
        let moved = held(DVec3::new(0.0, 1.0, 0.0));
        let (u, _) = DVec3::Y.any_orthonormal_pair();
        let at = |degrees: f64| {
            let place = moved.anchor + DQuat::from_axis_angle(DVec3::Y, degrees.to_radians()) * u * 0.2;
            moved.angle(&view, moved.seen(&view, place).unwrap()).unwrap().to_degrees()
        };
        assert!((at(30.0) - 30.0).abs() < 1e-3 && (at(-100.0) + 100.0).abs() < 1e-3, "{} {}", at(30.0), at(-100.0));
        // From its edge nothing can be told.
        let side = Camera::new(Direction::Front);
        let edge = ToolView { camera: &side, size: view.size };
        assert_eq!(moved.angle(&edge, egui::vec2(10.0, 10.0)), None);
    }
}
