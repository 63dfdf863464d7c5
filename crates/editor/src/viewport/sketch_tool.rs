//! Drawing, pulling and erasing strokes with the pointer. Each gesture is one step.

use glam::DVec2;
use maquette_graph::{
    Catalogue, Choice, Edit, Graph, Literal, LiteralKind, NodeId, NodeRecord, Stroke, StrokePoint, WireType,
};

use crate::command::{Command, GraphCommand, Message, ViewCommand};
use crate::naming::free_name;
use crate::panel::PanelContext;
use crate::sketch::correct::{Outcome, cut, erase, meaning, mirrored, pull, with_pressure};
use crate::sketch::smooth::smoothed;
use crate::sketch::target::{Plane, SketchTarget, points, stroke_point};
use crate::view_state::Tool;

use super::camera::{Camera, ViewSize};
use super::snap;

/// How near the pointer must come to mean something, points.
pub(crate) const REACH: f32 = 11.0;

/// What the pointer does from press to release.
#[derive(Clone, Debug)]
enum Gesture {
    Draw { plane: Plane, target: Option<SketchTarget>, drawn: Vec<DVec2>, pressures: Vec<Option<f64>> },
    Pull { base: SketchTarget, stroke: usize, point: usize, begin: DVec2 },
    Erase { base: SketchTarget, path: Vec<DVec2> },
    Cut { base: SketchTarget, path: Vec<DVec2> },
}

/// The tool of one view.
#[derive(Clone, Debug, Default)]
pub(crate) struct SketchTool {
    gesture: Option<Gesture>,
}

/// A view as the tool sees it.
pub(crate) struct ToolView<'a> {
    pub(crate) camera: &'a Camera,
    pub(crate) size: ViewSize,
}

impl ToolView<'_> {
    /// The point of a plane under a point of the view.
    pub(crate) fn meet(&self, plane: Plane, at: egui::Vec2) -> Option<DVec2> {
        plane.meet(self.camera.ray(self.size, at))
    }

    /// What so many points of the screen measure, metres.
    pub(crate) fn metres(&self, points: f32) -> f64 {
        self.camera.metres_per_point(self.size) * f64::from(points)
    }
}

/// The strokes that the pointer works on: those of the active node.
pub(crate) fn active_target(context: &PanelContext<'_>) -> Option<SketchTarget> {
    SketchTarget::of(context.graph(), context.view.active?)
}

impl SketchTool {
    /// The line that is being drawn, in its plane.
    pub(crate) fn drawn(&self) -> Option<(Plane, &[DVec2])> {
        match &self.gesture {
            Some(Gesture::Draw { plane, drawn, .. }) => Some((*plane, drawn)),
            Some(Gesture::Cut { base, path }) => Some((base.plane, path)),
            _ => None,
        }
    }

    /// What a stroke that begins now would go into, in words.
    pub(crate) fn hint(context: &PanelContext<'_>, view: &ToolView<'_>) -> String {
        let middle = egui::vec2(0.0, 0.0);
        let target = active_target(context).filter(|target| view.meet(target.plane, middle).is_some());
        let name = target.as_ref().and_then(|target| context.graph().node(target.node)).map(|node| node.name());
        match (context.view.tool, name, Plane::of_view(view.camera.direction)) {
            (Tool::Sketch, Some(name), _) => format!("draws into \"{name}\""),
            (Tool::Sketch, None, Some(_)) => "draws a new sketch".to_owned(),
            (Tool::Sketch, None, None) => "select a sketch, or draw in another view".to_owned(),
            (Tool::Cut, Some(name), _) => format!("cuts in \"{name}\""),
            (Tool::Transform, Some(name), _) => format!("moves, turns and scales strokes of \"{name}\""),
            (Tool::Cut | Tool::Transform, None, _) => "click on a stroke to choose its sketch".to_owned(),
            (Tool::Erase, Some(name), _) => format!("erases in \"{name}\""),
            (Tool::Erase, None, _) => "select a sketch to erase in".to_owned(),
            _ => String::new(),
        }
    }

    /// The pointer was pressed.
    pub(crate) fn press(&mut self, context: &mut PanelContext<'_>, view: &ToolView<'_>, at: egui::Vec2) {
        self.gesture = match context.view.tool {
            Tool::Select | Tool::Transform | Tool::Lasso | Tool::Paint | Tool::Picture => None,
            Tool::Sketch => self.begin_drawing(context, view, at),
            Tool::Pull => {
                let found = nearest_point(context.graph(), context.view.active, view, at);
                if let Some(Gesture::Pull { base, .. }) = &found {
                    context.ask(ViewCommand::Select(vec![base.node]));
                }
                found
            }
            tool @ (Tool::Erase | Tool::Cut) => {
                let target = active_target(context);
                let begun = target.and_then(|base| {
                    let path = vec![view.meet(base.plane, at)?];
                    Some(if tool == Tool::Cut { Gesture::Cut { base, path } } else { Gesture::Erase { base, path } })
                });
                if begun.is_none() {
                    let what = if tool == Tool::Cut { "cut" } else { "erase in" };
                    let text = format!("nothing to {what}: select a sketch whose plane this view shows");
                    context.ask(Command::Say(Message::error(text)));
                }
                begun
            }
        };
    }

    fn begin_drawing(&self, context: &mut PanelContext<'_>, view: &ToolView<'_>, at: egui::Vec2) -> Option<Gesture> {
        if let Some(target) = active_target(context)
            && let Some(begin) = view.meet(target.plane, at)
        {
            let begin = snap::caught(context, view, target.plane, Some(target.node), begin).unwrap_or(begin);
            let plane = target.plane;
            return Some(Gesture::Draw { plane, target: Some(target), drawn: vec![begin], pressures: vec![None] });
        }
        let begun = Plane::of_view(view.camera.direction).and_then(|plane| Some((plane, view.meet(plane, at)?)));
        match begun {
            Some((plane, begin)) => {
                let begin = snap::caught(context, view, plane, None, begin).unwrap_or(begin);
                Some(Gesture::Draw { plane, target: None, drawn: vec![begin], pressures: vec![None] })
            }
            None => {
                context.ask(Command::Say(Message::error(
                    "there is no plane to draw in here: select a sketch, or draw in the front, side or top view",
                )));
                None
            }
        }
    }

    /// The pointer moved; `pressure`, from 0 to 1, is that of a pen.
    pub(crate) fn drag(
        &mut self,
        context: &mut PanelContext<'_>,
        view: &ToolView<'_>,
        at: egui::Vec2,
        pressure: Option<f64>,
    ) {
        match &mut self.gesture {
            None => {}
            Some(Gesture::Draw { plane, drawn, pressures, .. }) => {
                if let Some(point) = view.meet(*plane, at)
                    && drawn.last().is_none_or(|last| last.distance(point) > view.metres(1.5))
                {
                    drawn.push(point);
                    pressures.push(pressure);
                }
            }
            Some(Gesture::Cut { base, path }) => {
                path.extend(view.meet(base.plane, at));
            }
            Some(Gesture::Pull { base, stroke, point, begin }) => {
                let Some(now) = view.meet(base.plane, at) else { return };
                let mut strokes = base.strokes.clone();
                if let Some(held) = base.strokes.get(*stroke) {
                    strokes[*stroke] = pull(held, *point, now - *begin, context.settings.pull_radius);
                }
                let edit = Edit::set(base.node, base.input.clone(), Literal::Strokes(strokes));
                let gesture = Some(format!("pull {:?}", base.node));
                context.ask(GraphCommand::Edit { name: "pull a point".to_owned(), edits: vec![edit], gesture });
            }
            Some(Gesture::Erase { base, path }) => {
                let Some(now) = view.meet(base.plane, at) else { return };
                path.push(now);
                let left = erase(&base.strokes, path, view.metres(REACH * 0.7));
                let edit = Edit::set(base.node, base.input.clone(), Literal::Strokes(left));
                let gesture = Some(format!("erase {:?}", base.node));
                context.ask(GraphCommand::Edit { name: "erase".to_owned(), edits: vec![edit], gesture });
            }
        }
    }

    /// The pointer was released.
    pub(crate) fn release(&mut self, context: &mut PanelContext<'_>, view: &ToolView<'_>) {
        match self.gesture.take() {
            None => {}
            Some(Gesture::Draw { plane, target, drawn, pressures }) => {
                finish(context, view, plane, target, drawn, &pressures);
            }
            Some(Gesture::Cut { base, path }) => {
                let parts = cut(&base.strokes, &path);
                if parts == base.strokes {
                    context.ask(Command::Say(Message::note("no stroke was crossed: drag across one to cut it")));
                    return;
                }
                let edit = Edit::set(base.node, base.input, Literal::Strokes(parts));
                context.ask(GraphCommand::Edit { name: "cut a stroke".to_owned(), edits: vec![edit], gesture: None });
            }
            Some(Gesture::Pull { .. } | Gesture::Erase { .. }) => context.ask(GraphCommand::EndGesture),
        }
    }
}

/// The point of a stroke that is nearest to the pointer: of the active node where it has one in reach.
fn nearest_point(graph: &Graph, active: Option<NodeId>, view: &ToolView<'_>, at: egui::Vec2) -> Option<Gesture> {
    let mut best: Option<((bool, f32), Gesture)> = None;
    for target in SketchTarget::all(graph) {
        let Some(begin) = view.meet(target.plane, at) else { continue };
        for (stroke, held) in target.strokes.iter().enumerate() {
            for (point, place) in points(held).into_iter().enumerate() {
                let Some(seen) = view.camera.project(view.size, target.plane.place(place)) else { continue };
                let distance = (seen - at).length();
                let rank = (Some(target.node) != active, distance);
                if distance <= REACH && best.as_ref().is_none_or(|(least, _)| rank < *least) {
                    best = Some((rank, Gesture::Pull { base: target.clone(), stroke, point, begin }));
                }
            }
        }
    }
    best.map(|(_, gesture)| gesture)
}

/// How far a stroke may be from the pen, metres: as the artist set it, but no finer than the screen shows.
pub(crate) fn tolerance(context: &PanelContext<'_>, view: &ToolView<'_>) -> f64 {
    context.settings.tolerance.max(view.metres(1.0))
}

/// Makes a drawn line a part of the document.
fn finish(
    context: &mut PanelContext<'_>,
    view: &ToolView<'_>,
    plane: Plane,
    target: Option<SketchTarget>,
    mut drawn: Vec<DVec2>,
    pressures: &[Option<f64>],
) {
    let reach = view.metres(REACH);
    let length: f64 = drawn.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    if drawn.len() < 3 || length < reach {
        // A click, not a stroke.
        return;
    }
    let own = target.as_ref().map(|target| target.node);
    let last = drawn.len() - 1;
    if let Some(place) = snap::caught(context, view, plane, own, drawn[last]) {
        drawn[last] = place;
    }
    let pressed: Vec<StrokePoint> = drawn
        .iter()
        .zip(pressures)
        .map(|(point, pressure)| StrokePoint { pressure: *pressure, ..stroke_point(*point) })
        .collect();
    let closed = length > 4.0 * reach && drawn[0].distance(drawn[drawn.len() - 1]) < reach;
    let tolerance = tolerance(context, view);
    let strokes = target.as_ref().map(|target| target.strokes.clone()).unwrap_or_default();
    let (name, strokes) = match meaning(&strokes, &smoothed(&drawn, false, tolerance), reach) {
        Outcome::Instead(index, line, closed) => {
            let mut strokes = strokes;
            // What was there is smooth already; what is new must not break it.
            let from: Vec<StrokePoint> = strokes[index].points.iter().chain(&pressed).copied().collect();
            strokes[index].points = with_pressure(line, &from);
            strokes[index].closed = closed;
            ("correct a stroke", strokes)
        }
        Outcome::New => {
            if closed {
                drawn.pop();
            }
            let line = smoothed(&drawn, closed, tolerance);
            let mut strokes = strokes;
            let name = format!("stroke {}", strokes.len() + 1);
            let stroke = Stroke { name, closed, points: with_pressure(line, &pressed) };
            if context.settings.symmetric && plane.shows_both_sides() {
                strokes.extend([mirrored(&stroke)]);
                let last = strokes.len() - 1;
                strokes.insert(last, stroke);
            } else {
                strokes.push(stroke);
            }
            ("draw a stroke", strokes)
        }
    };
    match target {
        Some(target) => {
            let edit = Edit::set(target.node, target.input, Literal::Strokes(strokes));
            context.ask(GraphCommand::Edit { name: name.to_owned(), edits: vec![edit], gesture: None });
        }
        None => add_sketch(context, plane, strokes),
    }
}

/// The first kind that takes strokes in a plane.
pub(crate) fn sketch_kind(catalogue: &Catalogue) -> Option<(String, String)> {
    let strokes = |wire: WireType| LiteralKind::of_wire(wire) == Some(LiteralKind::Strokes);
    catalogue.kinds().find_map(|kind| {
        let input = kind.inputs().iter().find(|input| strokes(input.wire))?;
        let plane = kind.find_input("plane")?;
        (plane.wire == WireType::of::<Choice>()).then(|| (kind.name().to_owned(), input.name.clone()))
    })
}

fn add_sketch(context: &mut PanelContext<'_>, plane: Plane, strokes: Vec<Stroke>) {
    let (Some((kind, input)), Some(option)) = (sketch_kind(context.catalogue), plane.view.plane()) else { return };
    let name = free_name(context.graph(), &format!("{option} sketch"));
    let record = NodeRecord::new(kind, name.clone())
        .literal(input, Literal::Strokes(strokes))
        .literal("plane", Literal::Choice(option.to_owned()));
    let edits = vec![Edit::AddNode(Box::new(record))];
    context.ask(GraphCommand::Edit { name: "draw a stroke".to_owned(), edits, gesture: None });
    context.ask(ViewCommand::Find(context.path_of(&name)));
}
