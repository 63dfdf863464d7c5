//! Where a stroke goes: an input that holds strokes, with the plane in which they lie.
//!
//! Any node has it that takes strokes, and beside them a choice named `plane` with the options `front`, `side` and `top`; a
//! length named `offset` says where the plane lies.

use glam::{DVec2, DVec3};
use maquette_graph::{Graph, Literal, LiteralKind, Node, NodeId, Source, Stroke, StrokePoint};

use crate::viewport::camera::Direction;

/// A plane to draw in. First and second coordinate: front X and Y, side Z and Y, top X and Z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Plane {
    /// The view that shows it flat.
    pub(crate) view: Direction,
    /// Where it lies along the axis across it, metres.
    pub(crate) offset: f64,
}

impl Plane {
    /// The plane of a view; `None` where one can't draw in it.
    pub(crate) fn of_view(view: Direction) -> Option<Self> {
        view.plane().map(|_| Self { view, offset: 0.0 })
    }

    /// The point in space of a drawn point.
    pub(crate) fn place(self, drawn: DVec2) -> DVec3 {
        match self.view {
            Direction::Front | Direction::Free => DVec3::new(drawn.x, drawn.y, self.offset),
            Direction::Side => DVec3::new(self.offset, drawn.y, drawn.x),
            Direction::Top => DVec3::new(drawn.x, self.offset, drawn.y),
        }
    }

    /// The drawn point of a point in space, along the plane's normal.
    pub(crate) fn drawn(self, place: DVec3) -> DVec2 {
        match self.view {
            Direction::Front | Direction::Free => DVec2::new(place.x, place.y),
            Direction::Side => DVec2::new(place.z, place.y),
            Direction::Top => DVec2::new(place.x, place.z),
        }
    }

    /// The axis across it.
    pub(crate) fn normal(self) -> DVec3 {
        match self.view {
            Direction::Front | Direction::Free => DVec3::Z,
            Direction::Side => DVec3::X,
            Direction::Top => DVec3::Y,
        }
    }

    /// Where a ray meets it; `None` where the plane is seen from its edge, or lies behind.
    pub(crate) fn meet(self, (origin, along): (DVec3, DVec3)) -> Option<DVec2> {
        let towards = along.dot(self.normal());
        if towards.abs() < 0.2 {
            return None;
        }
        let distance = (self.offset - origin.dot(self.normal())) / towards;
        (distance > 0.0).then(|| self.drawn(origin + along * distance))
    }

    /// Whether mirroring the first coordinate is mirroring left and right of the body.
    pub(crate) fn shows_both_sides(self) -> bool {
        self.view != Direction::Side
    }
}

/// An input that holds strokes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SketchTarget {
    pub(crate) node: NodeId,
    pub(crate) input: String,
    pub(crate) plane: Plane,
    pub(crate) strokes: Vec<Stroke>,
}

fn literal<'a>(graph: &'a Graph, node: &'a Node, input: &str) -> Option<&'a Literal> {
    match node.source(input) {
        None => node.kind()?.find_input(input)?.default.as_ref(),
        Some(Source::Literal { literal, .. }) => Some(literal),
        Some(Source::Parameter(name)) => graph.parameter(name)?.value(),
        Some(Source::Link(_) | Source::Unread(_)) => None,
    }
}

impl SketchTarget {
    /// The strokes of a node; `None` where it has none of its own, or no plane that is known.
    pub(crate) fn of(graph: &Graph, id: NodeId) -> Option<Self> {
        let node = graph.node(id)?;
        let kind = node.kind()?;
        let input =
            kind.inputs().iter().find(|input| LiteralKind::of_wire(input.wire) == Some(LiteralKind::Strokes))?;
        // Strokes that a parameter holds are shared: they are drawn where the parameter is declared.
        let own = matches!(node.source(&input.name), None | Some(Source::Literal { .. }));
        let Some(Literal::Strokes(strokes)) = literal(graph, node, &input.name).filter(|_| own) else { return None };
        let Some(Literal::Choice(plane)) = literal(graph, node, "plane") else { return None };
        let view = Direction::ALL.into_iter().find(|view| view.plane() == Some(plane.as_str()))?;
        let offset = match literal(graph, node, "offset") {
            Some(Literal::Number(offset)) => *offset,
            _ => 0.0,
        };
        Some(Self { node: id, input: input.name.clone(), plane: Plane { view, offset }, strokes: strokes.clone() })
    }

    /// All of a graph.
    pub(crate) fn all(graph: &Graph) -> impl Iterator<Item = Self> + '_ {
        graph.nodes().filter_map(|(id, _)| Self::of(graph, id))
    }
}

/// The points of a stroke in its plane.
pub(crate) fn points(stroke: &Stroke) -> Vec<DVec2> {
    stroke.points.iter().map(|p| DVec2::new(p.x, p.y)).collect()
}

/// A point as a stroke holds it: to a hundredth of a millimetre, which no pen can draw and every file can show.
pub(crate) fn stroke_point(point: DVec2) -> StrokePoint {
    let point = rounded(point);
    StrokePoint { x: point.x, y: point.y, pressure: None }
}

/// A point of a plane to a hundredth of a millimetre.
pub(crate) fn rounded(point: DVec2) -> DVec2 {
    // Minus zero would be written as such: in a sum with zero it is none.
    (point * 1e5).round() / 1e5 + DVec2::ZERO
}

#[cfg(test)]
mod tests {
    use super::*;
    use maquette_graph::Graph;

    #[test]
    fn every_kind_that_takes_strokes_in_a_plane_can_be_drawn_in() {
        let catalogue = maquette_nodes::catalogue().unwrap();
        let mut graph = Graph::new();
        let id = graph.add(&catalogue, "sketch", "rail").unwrap();
        graph.set(id, "plane", Literal::Choice("top".to_owned())).unwrap();
        graph.set(id, "offset", Literal::Number(0.5)).unwrap();
        let target = SketchTarget::of(&graph, id).unwrap();
        assert_eq!(target.plane, Plane { view: Direction::Top, offset: 0.5 });
        assert_eq!(target.plane.place(DVec2::new(1.0, 2.0)), DVec3::new(1.0, 0.5, 2.0));
        let other = graph.add(&catalogue, "resample", "even").unwrap();
        assert_eq!(SketchTarget::of(&graph, other), None);
    }

    #[test]
    fn a_ray_meets_a_plane_unless_it_is_seen_from_its_edge() {
        let plane = Plane { view: Direction::Front, offset: 0.1 };
        let origin = DVec3::new(0.3, 0.4, 5.0);
        assert_eq!(plane.meet((origin, DVec3::NEG_Z)), Some(DVec2::new(0.3, 0.4)));
        assert_eq!(plane.meet((origin, DVec3::X)), None);
        assert_eq!(plane.meet((origin, DVec3::Z)), None);
    }
}
