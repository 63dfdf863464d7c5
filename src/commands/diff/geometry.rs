//! How far the results of two graphs are apart.

use glam::DVec3;
use maquette_geometry::curve::{Curve, closest};
use maquette_geometry::mesh::{Mesh, MeshDistance};
use maquette_graph::Value;
use maquette_nodes::wire;
use serde::Serialize;

/// How one result differs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct OutputDifference {
    /// The node, by its name in the second graph where it is in both.
    pub(super) output: String,
    /// Whether both results are the same to the last bit.
    pub(super) identical: bool,
    /// Of what the first consists; none where it is not there.
    pub(super) from: Option<Content>,
    /// Of what the second consists; none where it is not there.
    pub(super) to: Option<Content>,
    /// Distance of the first's points from the second.
    pub(super) there: Option<Distance>,
    /// Distance of the second's points from the first.
    pub(super) back: Option<Distance>,
}

/// What a result consists of.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "type", rename_all = "kebab-case")]
pub(super) enum Content {
    Mesh { vertices: usize, faces: usize },
    Curves { curves: usize, points: usize },
}

/// Distances of all points of one result from the nearest point of the other, metres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct Distance {
    pub(super) largest: f64,
    pub(super) mean: f64,
}

/// A result's geometry.
enum Shape<'a> {
    Mesh(&'a Mesh),
    Curves(&'a [Curve]),
}

impl<'a> Shape<'a> {
    fn of(value: &'a Value) -> Option<Self> {
        if let Some(result) = value.get::<wire::MeshResult>() {
            return Some(Self::Mesh(&result.mesh));
        }
        value.get::<wire::CurvesResult>().map(|result| Self::Curves(&result.curves))
    }

    fn points(&self) -> Box<dyn Iterator<Item = DVec3> + 'a> {
        match self {
            Self::Mesh(mesh) => Box::new(mesh.positions().iter().copied()),
            Self::Curves(curves) => Box::new(curves.iter().flat_map(|curve| curve.points().iter().copied())),
        }
    }

    fn content(&self) -> Content {
        match self {
            Self::Mesh(mesh) => Content::Mesh { vertices: mesh.positions().len(), faces: mesh.polygon_count() },
            Self::Curves(curves) => Content::Curves { curves: curves.len(), points: self.points().count() },
        }
    }

    /// Distances of these points from this shape; none where either is empty.
    fn distances(&self, points: impl Iterator<Item = DVec3>) -> Option<Distance> {
        match self {
            Self::Mesh(mesh) => {
                let hierarchy = MeshDistance::new(mesh).ok()?;
                summary(points.map(|point| hierarchy.nearest(point).distance))
            }
            Self::Curves([]) => None,
            Self::Curves(curves) => summary(
                points.map(|p| curves.iter().map(|curve| closest(curve, p).distance).fold(f64::INFINITY, f64::min)),
            ),
        }
    }
}

fn summary(distances: impl Iterator<Item = f64>) -> Option<Distance> {
    let (mut count, mut sum, mut largest) = (0.0, 0.0, 0.0_f64);
    for distance in distances {
        count += 1.0;
        sum += distance;
        largest = largest.max(distance);
    }
    (count > 0.0).then(|| Distance { largest, mean: sum / count })
}

/// Compares the values of a result: vertices of meshes with the other's surface, points of curves with the other's
/// lines; exact but for rounding.
pub(super) fn compare(output: &str, from: Option<&Value>, to: Option<&Value>) -> OutputDifference {
    let (first, second) = (from.and_then(Shape::of), to.and_then(Shape::of));
    let identical = from.zip(to).is_some_and(|(a, b)| a == b);
    let comparable = match (&first, &second) {
        (Some(Shape::Mesh(_)), Some(Shape::Mesh(_))) | (Some(Shape::Curves(_)), Some(Shape::Curves(_))) => {
            first.as_ref().zip(second.as_ref())
        }
        _ => None,
    };
    OutputDifference {
        output: output.to_owned(),
        identical,
        from: first.as_ref().map(Shape::content),
        to: second.as_ref().map(Shape::content),
        there: comparable.and_then(|(a, b)| b.distances(a.points())),
        back: comparable.and_then(|(a, b)| a.distances(b.points())),
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use maquette_geometry::scene::Material;
    use maquette_graph::ContentHash;

    use super::*;

    /// A square of the given side at a height.
    fn square(side: f64, height: f64) -> Value {
        let corners = [(0.0, 0.0), (0.0, side), (side, side), (side, 0.0)];
        let points = corners.iter().map(|(x, z)| DVec3::new(*x, height, *z)).collect();
        let mesh = Mesh::new(points, [[0_u32, 1, 2, 3]]).unwrap();
        let mesh_hash = ContentHash(u128::from(side.to_bits()) << 64 | u128::from(height.to_bits()));
        Value::new(wire::MeshResult { mesh: Arc::new(mesh), mesh_hash, material: Material::default() })
    }

    #[test]
    fn meshes_are_measured_both_ways() {
        let found = compare("square", Some(&square(1.0, 0.0)), Some(&square(5.0, 3.0)));
        assert_eq!(found.from, Some(Content::Mesh { vertices: 4, faces: 1 }));
        assert_eq!(found.there, Some(Distance { largest: 3.0, mean: 3.0 }));
        // From the corners: 3, twice the hypotenuse of 3 and 4, and one over both sides.
        let far = (9.0_f64 + 16.0 + 16.0).sqrt();
        let back = found.back.unwrap();
        assert!((back.largest - far).abs() < 1e-12 && (back.mean - (3.0 + 10.0 + far) / 4.0).abs() < 1e-12, "{back:?}");
        assert!(!found.identical);
    }

    #[test]
    fn equal_results_are_identical_and_missing_ones_have_no_distance() {
        let found = compare("square", Some(&square(1.0, 0.0)), Some(&square(1.0, 0.0)));
        assert!(found.identical && found.there == Some(Distance { largest: 0.0, mean: 0.0 }));
        let found = compare("square", None, Some(&square(1.0, 0.0)));
        assert_eq!((found.identical, found.from, found.there), (false, None, None));
    }

    #[test]
    fn curves_are_measured_to_the_nearest_line() {
        let curves = |height: f64| {
            let line = Curve::new("line", vec![DVec3::Y * height, DVec3::new(1.0, height, 0.0)], false).unwrap();
            Value::new(wire::CurvesResult { curves: vec![line], colour: [1.0; 4] })
        };
        let found = compare("lines", Some(&curves(0.0)), Some(&curves(0.5)));
        assert_eq!(found.to, Some(Content::Curves { curves: 1, points: 2 }));
        assert_eq!(found.back, Some(Distance { largest: 0.5, mean: 0.5 }));
        let none = Value::new(wire::CurvesResult { curves: vec![], colour: [1.0; 4] });
        assert_eq!(compare("lines", Some(&none), Some(&curves(0.5))).back, None);
        assert_eq!(compare("lines", Some(&square(1.0, 0.0)), Some(&curves(0.5))).there, None);
    }
}
