//! Where the end of a stroke is caught: the ends and lines of other strokes in its plane, the places where curves cross it,
//! and the middle of the body.

use glam::{DVec2, DVec3};
use maquette_graph::NodeId;

use crate::drawable::LineRole;
use crate::panel::PanelContext;
use crate::sketch::correct::nearest;
use crate::sketch::target::{Plane, SketchTarget, points};

use super::sketch_tool::ToolView;

/// How near something must be to catch an end, points.
const REACH: f32 = 8.0;
/// Distance of two planes that count as one, metres.
const SAME: f64 = 1e-6;

/// The place that catches an end drawn at a point of a plane; `None` where nothing is near. Strokes of `own` don't: drawing
/// near them corrects them. Ends come before crossings, crossings before lines, lines before the middle.
pub(crate) fn caught(
    context: &PanelContext<'_>,
    view: &ToolView<'_>,
    plane: Plane,
    own: Option<NodeId>,
    at: DVec2,
) -> Option<DVec2> {
    if !context.settings.snap {
        return None;
    }
    let reach = view.metres(REACH);
    let mut ends = Vec::new();
    let mut crossings = Vec::new();
    let mut lines = Vec::new();
    for target in SketchTarget::all(context.graph()).filter(|target| Some(target.node) != own) {
        let flat = target.plane.view == plane.view && (target.plane.offset - plane.offset).abs() < SAME;
        for stroke in &target.strokes {
            let line = points(stroke);
            if flat {
                if !stroke.closed {
                    ends.extend(line.first().into_iter().chain(line.last()).copied());
                }
                lines.extend(
                    nearest(&line, stroke.closed, at)
                        .map(|near| line[near.piece].lerp(line[(near.piece + 1) % line.len()], near.along)),
                );
            } else {
                let joint = line.first().filter(|_| stroke.closed);
                let places = line.iter().chain(joint).map(|p| target.plane.place(*p));
                crossings.extend(cross(plane, places));
            }
        }
    }
    for shown in context.results.shown().iter().filter(|shown| context.is_here(shown)) {
        for line in
            shown.drawables.iter().flat_map(|drawable| &drawable.lines).filter(|line| line.role == LineRole::Curve)
        {
            let joint = line.points.first().filter(|_| line.closed);
            crossings.extend(cross(plane, line.points.iter().chain(joint).map(|p| p.as_dvec3())));
        }
    }
    let middle = if plane.shows_both_sides() { vec![DVec2::new(0.0, at.y)] } else { Vec::new() };
    [ends, crossings, lines, middle].into_iter().find_map(|places| {
        let near = places.into_iter().filter(|place| place.distance(at) <= reach);
        near.min_by(|a, b| a.distance(at).total_cmp(&b.distance(at)))
    })
}

/// Where a line in space crosses a plane.
fn cross(plane: Plane, line: impl Iterator<Item = DVec3>) -> Vec<DVec2> {
    let mut found = Vec::new();
    let mut before: Option<(DVec3, f64)> = None;
    for place in line {
        let side = place.dot(plane.normal()) - plane.offset;
        if let Some((from, was)) = before
            && was * side <= 0.0
            && was != side
        {
            found.push(plane.drawn(from.lerp(place, was / (was - side))));
        }
        before = Some((place, side));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewport::camera::Direction;

    #[test]
    fn a_line_crosses_a_plane_where_it_changes_sides() {
        let plane = Plane { view: Direction::Front, offset: 0.5 };
        let line = [DVec3::ZERO, DVec3::new(1.0, 2.0, 1.0), DVec3::new(3.0, 2.0, 0.0)];
        assert_eq!(cross(plane, line.into_iter()), [DVec2::new(0.5, 1.0), DVec2::new(2.0, 2.0)]);
        assert!(cross(plane, [DVec3::ZERO, DVec3::X].into_iter()).is_empty());
        // One that lies within touches it all along, which is no crossing.
        let within = [DVec3::new(0.0, 0.0, 0.5), DVec3::new(1.0, 0.0, 0.5)];
        assert!(cross(plane, within.into_iter()).is_empty());
    }
}
