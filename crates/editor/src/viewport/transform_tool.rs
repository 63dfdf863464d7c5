//! Moving, turning and scaling whole strokes by a box around them. Each gesture is one step.

use std::collections::BTreeSet;

use egui::{Color32, Key, Pos2, Stroke};
use glam::{DAffine2, DVec2};
use maquette_graph::{Edit, Literal};

use crate::command::{GraphCommand, ViewCommand};
use crate::panel::PanelContext;
use crate::sketch::correct::{nearest, transformed};
use crate::sketch::target::{SketchTarget, points};

use super::sketch_tool::{REACH, ToolView, active_target};

/// How near a handle the pointer must come, points.
const HANDLE: f32 = 9.0;
/// How far from the box the handle stands that turns it, points.
const TURN_OFFSET: f32 = 24.0;
/// What a press of an arrow key moves, metres; with Shift ten times that, with Ctrl a tenth.
const NUDGE: f64 = 1e-3;
const ACCENT: Color32 = Color32::from_rgb(255, 160, 45);

/// What the pointer took hold of.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Hold {
    Move,
    Turn {
        centre: DVec2,
    },
    /// A corner, or with one axis locked the middle of a side; the opposite one stays.
    Scale {
        anchor: DVec2,
        handle: DVec2,
        axes: [bool; 2],
    },
}

#[derive(Clone, Debug)]
struct Gesture {
    base: SketchTarget,
    chosen: BTreeSet<usize>,
    hold: Hold,
    begin: DVec2,
}

/// The tool of one view.
#[derive(Clone, Debug, Default)]
pub(crate) struct TransformTool {
    gesture: Option<Gesture>,
}

/// The strokes of the active sketch that are picked, or all of them where none is.
pub(crate) fn chosen(context: &PanelContext<'_>, target: &SketchTarget) -> BTreeSet<usize> {
    let picked = &context.view.picked_strokes;
    let there: BTreeSet<usize> = picked.iter().copied().filter(|index| *index < target.strokes.len()).collect();
    if there.is_empty() { (0..target.strokes.len()).collect() } else { there }
}

/// Lowest and highest coordinates of strokes.
fn bounds(target: &SketchTarget, chosen: &BTreeSet<usize>) -> Option<[DVec2; 2]> {
    let places = chosen.iter().filter_map(|index| target.strokes.get(*index)).flat_map(points);
    let around =
        |found: Option<[DVec2; 2]>, p: DVec2| Some(found.map_or([p, p], |[low, high]| [low.min(p), high.max(p)]));
    places.fold(None, around)
}

/// The corners and the middles of the sides of a box, each with the axes along which it scales.
fn handles([low, high]: [DVec2; 2]) -> Vec<(DVec2, DVec2, [bool; 2])> {
    let middle = 0.5 * (low + high);
    let mut handles = Vec::new();
    for i in [-1, 0, 1] {
        for k in [-1, 0, 1] {
            let pick = |side: i32, axis: usize| match side {
                -1 => low[axis],
                0 => middle[axis],
                _ => high[axis],
            };
            if (i, k) != (0, 0) {
                let at = DVec2::new(pick(i, 0), pick(k, 1));
                handles.push((at, DVec2::new(pick(-i, 0), pick(-k, 1)), [i != 0, k != 0]));
            }
        }
    }
    handles
}

/// Where the handle stands that turns, on the view.
fn turn_handle(view: &ToolView<'_>, target: &SketchTarget, [low, high]: [DVec2; 2]) -> Option<egui::Vec2> {
    let seen = |p: DVec2| view.camera.project(view.size, target.plane.place(p));
    let corners = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)].map(seen);
    let (mut top, mut bottom) = (f32::INFINITY, f32::NEG_INFINITY);
    for corner in corners {
        let y = corner?.y;
        (top, bottom) = (top.min(y), bottom.max(y));
    }
    // Where there is no room above, it stands below, or else within.
    let height = view.size.height();
    let y = if top - TURN_OFFSET > HANDLE {
        top - TURN_OFFSET
    } else if bottom + TURN_OFFSET < height - HANDLE {
        bottom + TURN_OFFSET
    } else {
        top.max(0.0) + TURN_OFFSET
    };
    Some(egui::vec2(seen(0.5 * (low + high))?.x, y))
}

impl TransformTool {
    pub(crate) fn press(
        &mut self,
        context: &mut PanelContext<'_>,
        view: &ToolView<'_>,
        at: egui::Vec2,
        modifiers: egui::Modifiers,
    ) {
        self.gesture = None;
        let Some(target) = active_target(context) else {
            pick_sketch(context, view, at);
            return;
        };
        let Some(begin) = view.meet(target.plane, at) else { return };
        let seen = |p: DVec2| view.camera.project(view.size, target.plane.place(p));
        let mut chosen = chosen(context, &target);
        if let Some(framed) = bounds(&target, &chosen) {
            let centre = 0.5 * (framed[0] + framed[1]);
            let on = |place: Option<egui::Vec2>| place.is_some_and(|place| (place - at).length() <= HANDLE);
            let size = framed[1] - framed[0];
            let handle = handles(framed)
                .into_iter()
                .find(|(place, _, axes)| on(seen(*place)) && (0..2).all(|axis| !axes[axis] || size[axis] > 0.0));
            let hold = if on(turn_handle(view, &target, framed)) {
                Some(Hold::Turn { centre })
            } else {
                handle.map(|(handle, anchor, axes)| Hold::Scale { anchor, handle, axes })
            };
            if let Some(hold) = hold {
                self.gesture = Some(Gesture { base: target, chosen, hold, begin });
                return;
            }
        }
        let reach = view.metres(REACH);
        let hit = target.strokes.iter().enumerate().filter_map(|(index, stroke)| {
            let near = nearest(&points(stroke), stroke.closed, begin)?;
            (near.distance <= reach).then_some((near.distance, index))
        });
        let hit = hit.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, index)| index);
        let inside =
            bounds(&target, &chosen).is_some_and(|[low, high]| begin.cmpge(low).all() && begin.cmple(high).all());
        match hit {
            Some(index) if modifiers.shift => {
                let mut picked = context.view.picked_strokes.clone();
                if !picked.remove(&index) {
                    picked.insert(index);
                }
                context.ask(ViewCommand::PickStrokes(picked));
                return;
            }
            Some(index) if !context.view.picked_strokes.contains(&index) => {
                chosen = BTreeSet::from([index]);
                context.ask(ViewCommand::PickStrokes(chosen.clone()));
            }
            Some(_) => {}
            None if inside => {}
            None => {
                context.ask(ViewCommand::PickStrokes(BTreeSet::new()));
                pick_sketch(context, view, at);
                return;
            }
        }
        self.gesture = Some(Gesture { base: target, chosen, hold: Hold::Move, begin });
    }

    pub(crate) fn drag(
        &mut self,
        context: &mut PanelContext<'_>,
        view: &ToolView<'_>,
        at: egui::Vec2,
        modifiers: egui::Modifiers,
    ) {
        let Some(Gesture { base, chosen, hold, begin }) = &self.gesture else { return };
        let Some(now) = view.meet(base.plane, at) else { return };
        let map = map_of(*hold, *begin, now, modifiers.shift);
        let name = match hold {
            Hold::Move => "move strokes",
            Hold::Turn { .. } => "turn strokes",
            Hold::Scale { .. } => "scale strokes",
        };
        set(context, base, chosen, map, name, Some(format!("{name} {:?}", base.node)));
    }

    pub(crate) fn release(&mut self, context: &mut PanelContext<'_>) {
        if self.gesture.take().is_some() {
            context.ask(GraphCommand::EndGesture);
        }
    }

    /// The box with its handles.
    pub(crate) fn show(painter: &egui::Painter, corner: Pos2, context: &PanelContext<'_>, view: &ToolView<'_>) {
        let Some(target) = active_target(context) else { return };
        let Some(framed) = bounds(&target, &chosen(context, &target)) else { return };
        let seen = |p: DVec2| Some(corner + view.camera.project(view.size, target.plane.place(p))?);
        let [low, high] = framed;
        let around = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y), low];
        let line: Vec<Pos2> = around.into_iter().filter_map(seen).collect();
        painter.add(egui::Shape::line(line, Stroke::new(1.0, ACCENT.gamma_multiply(0.7))));
        let size = high - low;
        for (place, _, axes) in handles(framed) {
            if (0..2).all(|axis| !axes[axis] || size[axis] > 0.0)
                && let Some(place) = seen(place)
            {
                let square = egui::Rect::from_center_size(place, egui::vec2(7.0, 7.0));
                painter.rect(square, 1.0, Color32::from_gray(30), Stroke::new(1.5, ACCENT), egui::StrokeKind::Middle);
            }
        }
        if let Some(place) = turn_handle(view, &target, framed) {
            painter.circle(corner + place, 4.5, Color32::from_gray(30), Stroke::new(1.5, ACCENT));
        }
    }
}

/// Makes the sketch whose stroke is under the pointer the active one.
fn pick_sketch(context: &mut PanelContext<'_>, view: &ToolView<'_>, at: egui::Vec2) {
    let reach = view.metres(REACH);
    let found = SketchTarget::all(context.graph()).find_map(|target| {
        let point = view.meet(target.plane, at)?;
        let near = target.strokes.iter().position(|stroke| {
            nearest(&points(stroke), stroke.closed, point).is_some_and(|near| near.distance <= reach)
        })?;
        Some((target.node, near))
    });
    if let Some((node, stroke)) = found {
        context.ask(ViewCommand::Select(vec![node]));
        context.ask(ViewCommand::PickStrokes(BTreeSet::from([stroke])));
    }
}

/// The map of a gesture. `exact` keeps a move to one axis, a turn to steps of 15 degrees, and lets a corner scale both axes by
/// themselves.
fn map_of(hold: Hold, begin: DVec2, now: DVec2, exact: bool) -> DAffine2 {
    match hold {
        Hold::Move => {
            let mut by = now - begin;
            if exact {
                if by.x.abs() >= by.y.abs() { by.y = 0.0 } else { by.x = 0.0 }
            }
            DAffine2::from_translation(by)
        }
        Hold::Turn { centre } => {
            let (from, to) = (begin - centre, now - centre);
            let angle = if from.length() > 0.0 && to.length() > 0.0 { from.angle_to(to) } else { 0.0 };
            let step = 15_f64.to_radians();
            about(centre, DAffine2::from_angle(if exact { (angle / step).round() * step } else { angle }))
        }
        Hold::Scale { anchor, handle, axes } => {
            let span = handle - anchor;
            let target = handle + now - begin - anchor;
            let factor = if axes == [true, true] && !exact {
                DVec2::splat(target.dot(span) / span.length_squared())
            } else {
                let along = |axis: usize| if axes[axis] { target[axis] / span[axis] } else { 1.0 };
                DVec2::new(along(0), along(1))
            };
            // Nothing is pressed flat: it could not be drawn apart again.
            let safe = |f: f64| if f.is_finite() && f.abs() >= 1e-3 { f } else { 1e-3 };
            about(anchor, DAffine2::from_scale(DVec2::new(safe(factor.x), safe(factor.y))))
        }
    }
}

fn about(centre: DVec2, map: DAffine2) -> DAffine2 {
    DAffine2::from_translation(centre) * map * DAffine2::from_translation(-centre)
}

fn set(
    context: &mut PanelContext<'_>,
    base: &SketchTarget,
    chosen: &BTreeSet<usize>,
    map: DAffine2,
    name: &str,
    gesture: Option<String>,
) {
    let strokes = base.strokes.iter().enumerate();
    let moved = strokes.map(|(k, stroke)| if chosen.contains(&k) { transformed(stroke, map) } else { stroke.clone() });
    let edit = Edit::set(base.node, base.input.clone(), Literal::Strokes(moved.collect()));
    context.ask(GraphCommand::Edit { name: name.to_owned(), edits: vec![edit], gesture });
}

/// Moves the chosen strokes of the active sketch by the arrow keys, as the view shows right and up.
pub(crate) fn nudge(ui: &egui::Ui, context: &mut PanelContext<'_>, view: &ToolView<'_>) {
    let Some(target) = active_target(context) else { return };
    let keys = [
        (Key::ArrowRight, 1.0, 0.0),
        (Key::ArrowLeft, -1.0, 0.0),
        (Key::ArrowUp, 0.0, 1.0),
        (Key::ArrowDown, 0.0, -1.0),
    ];
    let mut by = [0.0; 2];
    ui.input_mut(|input| {
        let step = match (input.modifiers.shift, input.modifiers.command) {
            (true, _) => 10.0 * NUDGE,
            (_, true) => 0.1 * NUDGE,
            _ => NUDGE,
        };
        for (key, right, up) in keys {
            let pressed = input.num_presses(key);
            if pressed > 0 {
                #[expect(clippy::cast_precision_loss, reason = "a few presses")]
                let times = pressed as f64 * step;
                by = [by[0] + right * times, by[1] + up * times];
                // Otherwise the focus would move.
                input.events.retain(|event| !matches!(event, egui::Event::Key { key: held, .. } if *held == key));
            }
        }
    });
    if by == [0.0; 2] {
        return;
    }
    let [right, up, _] = view.camera.frame();
    let moved = target.plane.drawn(right * by[0] + up * by[1]);
    let map = DAffine2::from_translation(moved);
    let chosen = chosen(context, &target);
    set(context, &target, &chosen, map, "nudge strokes", Some(format!("nudge {:?} {chosen:?}", target.node)));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(map: DAffine2, x: f64, y: f64) -> [f64; 2] {
        map.transform_point2(DVec2::new(x, y)).to_array().map(|c| (c * 1e9).round() / 1e9)
    }

    #[test]
    fn a_corner_scales_towards_the_opposite_one_and_keeps_the_proportions() {
        let hold = Hold::Scale { anchor: DVec2::ZERO, handle: DVec2::new(2.0, 1.0), axes: [true, true] };
        let map = map_of(hold, DVec2::new(2.0, 1.0), DVec2::new(4.0, 2.0), false);
        assert_eq!((at(map, 2.0, 1.0), at(map, 0.0, 0.0), at(map, 1.0, 1.0)), ([4.0, 2.0], [0.0, 0.0], [2.0, 2.0]));
        let map = map_of(hold, DVec2::new(2.0, 1.0), DVec2::new(4.0, 1.0), true);
        assert_eq!(at(map, 1.0, 1.0), [2.0, 1.0], "each axis by itself");
        let side = Hold::Scale { anchor: DVec2::ZERO, handle: DVec2::new(2.0, 0.0), axes: [true, false] };
        assert_eq!(at(map_of(side, DVec2::X, DVec2::new(3.0, 5.0), false), 1.0, 1.0), [2.0, 1.0]);
        // Through the anchor it is mirrored, and never flat.
        let flat = map_of(hold, DVec2::new(2.0, 1.0), DVec2::ZERO, false);
        assert!(flat.matrix2.determinant().abs() > 0.0);
    }

    #[test]
    fn turns_and_moves_keep_to_steps_where_they_should() {
        let hold = Hold::Turn { centre: DVec2::ONE };
        let to = DVec2::ONE + DVec2::from_angle(50_f64.to_radians());
        assert_eq!(at(map_of(hold, DVec2::new(2.0, 1.0), to, true), 2.0, 1.0), [1.707_106_781, 1.707_106_781]);
        assert_eq!(at(map_of(Hold::Move, DVec2::ZERO, DVec2::new(0.3, 0.1), true), 0.0, 0.0), [0.3, 0.0]);
    }
}
