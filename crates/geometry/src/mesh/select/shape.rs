//! Vertices inside shapes.

use glam::{DQuat, DVec3};

use super::{SelectError, Selection, not_negative};
use crate::curve::{Curve, closest};
use crate::mesh::Mesh;

/// A shape in space; all lengths in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape<'a> {
    /// A box around `centre`, turned.
    Cuboid {
        /// Its middle.
        centre: DVec3,
        /// Half its lengths along its own axes.
        half: DVec3,
        /// How it is turned.
        rotation: DQuat,
    },
    /// A ball.
    Sphere {
        /// Its middle.
        centre: DVec3,
        /// Its radius.
        radius: f64,
    },
    /// All on the side of a plane to which its normal points.
    HalfSpace {
        /// A point of the plane.
        point: DVec3,
        /// Its normal, of any length but 0.
        normal: DVec3,
    },
    /// All within `radius` of a curve.
    Capsule {
        /// The curve in its middle.
        curve: &'a Curve,
        /// Its radius.
        radius: f64,
    },
}

/// Weight 1 for the vertices in a shape, falling to 0 over `falloff` metres outside it; with a falloff of 0 the shape
/// ends sharply. As vertices count as selected from a weight of 0.5 on, the shape grows by half the falloff.
///
/// `progress` is called with the fraction done; `Ok(None)` where it answers `false`.
///
/// # Errors
/// [`SelectError`] for numbers that are not finite, negative lengths and a normal of length 0.
pub fn by_shape(
    mesh: &Mesh,
    shape: &Shape<'_>,
    falloff: f64,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Option<Selection>, SelectError> {
    let point = |what: &'static str, value: DVec3| {
        if value.is_finite() { Ok(()) } else { Err(SelectError::NotFinite { what }) }
    };
    not_negative("falloff", falloff)?;
    let distance: Box<dyn Fn(DVec3) -> f64> = match *shape {
        Shape::Cuboid { centre, half, rotation } => {
            point("centre", centre)?;
            for size in half.to_array() {
                not_negative("size of the box", size)?;
            }
            if !rotation.is_finite() || rotation.length_squared() == 0.0 {
                return Err(SelectError::NotFinite { what: "rotation" });
            }
            let inverse = rotation.normalize().inverse();
            Box::new(move |p| {
                let beyond = (inverse * (p - centre)).abs() - half;
                beyond.max(DVec3::ZERO).length() + beyond.max_element().min(0.0)
            })
        }
        Shape::Sphere { centre, radius } => {
            point("centre", centre)?;
            not_negative("radius", radius)?;
            Box::new(move |p| p.distance(centre) - radius)
        }
        Shape::HalfSpace { point: on, normal } => {
            point("point", on)?;
            point("normal", normal)?;
            let normal = normal.try_normalize().ok_or(SelectError::NoDirection)?;
            Box::new(move |p| (on - p).dot(normal))
        }
        Shape::Capsule { curve, radius } => {
            not_negative("radius", radius)?;
            Box::new(move |p| closest(curve, p).distance - radius)
        }
    };
    let weight = |vertex: usize| ramp(distance(mesh.positions()[vertex]), falloff);
    Ok(weighted_while(mesh.positions().len(), weight, progress))
}

/// Vertices between two questions whether to go on.
const STEP: usize = 4096;

/// A selection with a weight for each vertex, or `None` where `progress` answers `false`.
pub(super) fn weighted_while(
    vertices: usize,
    weight: impl Fn(usize) -> f64,
    progress: &dyn Fn(f64) -> bool,
) -> Option<Selection> {
    let mut weights = Vec::with_capacity(vertices);
    for vertex in 0..vertices {
        if vertex.is_multiple_of(STEP) && !progress(vertex as f64 / vertices as f64) {
            return None;
        }
        weights.push(weight(vertex));
    }
    Some(Selection::weighted(vertices, |vertex| weights[vertex]))
}

/// 1 up to a distance of 0, from there falling to 0 at `falloff`.
pub(super) fn ramp(distance: f64, falloff: f64) -> f64 {
    if distance <= 0.0 {
        1.0
    } else if distance < falloff {
        1.0 - distance / falloff
    } else {
        0.0
    }
}
