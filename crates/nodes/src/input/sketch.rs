//! **Sketch**: strokes drawn in a view plane become curves in space.
//! Reference: thesis 5.1 and Figure 6.11.

use glam::DVec2;
use maquette_geometry::curve::{Curve, CurveError};
use maquette_graph::{AtPort, NodeKind, Stroke};

use crate::view_plane::ViewPlane;
use crate::wire;

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare("sketch", 1, "input", "Strokes drawn in a view plane, as curves in space.");
    node.reference("thesis 5.1, Figure 6.11");
    let strokes = node.strokes("strokes", "The strokes: points in the plane's two coordinates, open or closed, named.");
    let plane = node.choice::<ViewPlane>("plane", "The plane they are drawn in.");
    let offset = node.length("offset", 0.0, -1e4..=1e4, "Place of the plane along the axis across it: z, x or y.");
    node.soft_range(offset, -1.0..=1.0);
    let curves = node.output::<wire::Curves>("curves", "One curve a stroke, in order.");
    node.evaluate(move |ports| {
        let (plane, offset) = (ports.choice(plane), ports.value(offset));
        let drawn = &ports.read(strokes).0;
        if drawn.is_empty() {
            return Err("there are no strokes: draw some, or remove the node").at(strokes);
        }
        let placed = drawn.iter().enumerate().map(|(index, stroke)| place(index, stroke, plane, offset));
        let placed = placed.collect::<Result<Vec<_>, _>>().at(strokes)?;
        ports.write(curves, wire::Curves(placed));
        Ok(())
    });
    node
}

/// A stroke in space. One without a name is called after its number, so that messages can name it.
fn place(index: usize, stroke: &Stroke, plane: ViewPlane, offset: f64) -> Result<Curve, CurveError> {
    let name = if stroke.name.is_empty() { format!("stroke {index}") } else { stroke.name.clone() };
    let points = stroke.points.iter().map(|p| plane.place(DVec2::new(p.x, p.y), offset)).collect();
    let pressure = stroke.points.iter().map(|p| p.pressure).collect::<Option<Vec<_>>>().filter(|p| !p.is_empty());
    Curve::with_pressure(name, points, stroke.closed, pressure)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use maquette_graph::StrokePoint;

    #[test]
    fn each_plane_puts_the_two_coordinates_where_its_view_shows_them() {
        let drawn = DVec2::new(1.0, 2.0);
        assert_eq!(ViewPlane::Front.place(drawn, 3.0), DVec3::new(1.0, 2.0, 3.0));
        assert_eq!(ViewPlane::Side.place(drawn, 3.0), DVec3::new(3.0, 2.0, 1.0));
        assert_eq!(ViewPlane::Top.place(drawn, 3.0), DVec3::new(1.0, 3.0, 2.0));
    }

    #[test]
    fn pressure_is_kept_only_where_every_point_has_it() {
        let point = |x, pressure| StrokePoint { x, y: 0.0, pressure };
        let stroke = |points| Stroke { name: String::new(), closed: false, points };
        let full = place(0, &stroke(vec![point(0.0, Some(0.5)), point(1.0, Some(1.0))]), ViewPlane::Front, 0.0);
        assert_eq!(full.unwrap().pressure(), Some([0.5, 1.0].as_slice()));
        let partial = place(4, &stroke(vec![point(0.0, Some(0.5)), point(1.0, None)]), ViewPlane::Front, 0.0).unwrap();
        assert_eq!((partial.pressure(), partial.name()), (None, "stroke 4"));
    }
}
