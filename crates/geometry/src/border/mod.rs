//! Borders of surfaces and meshes: closed or open curves with the directions in which the surface would go on.
//!
//! A [`Border`] is what a detail generator or a blend continues smoothly ([`crate::generate::Neighbour`]).

mod of_mesh;
mod of_surface;
mod split;

pub use of_mesh::{boundaries, boundary_along};
pub use of_surface::{of_sections, of_surface};
pub use split::{SplitBorderError, farthest_corner, split};

use glam::DVec3;

use crate::curve::{ArcLength, Curve, closest};

/// Direction of the parabola through three points at the middle one, of any length: on a round surface square to its normal
/// there, however far apart the points are, and where they turn a corner too.
pub(crate) fn tangent_at([before, at, after]: [DVec3; 3]) -> DVec3 {
    let (back, ahead) = (at - before, after - at);
    back * ahead.length_squared() + ahead * back.length_squared()
}

/// A curve at which a surface ends, with the unit direction at each of its points in which the surface would go on: in
/// its tangent plane, away from it.
#[derive(Clone, Debug, PartialEq)]
pub struct Border {
    curve: Curve,
    directions: Vec<DVec3>,
}

/// Why a curve and directions make no border.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BorderError {
    /// Another number of directions than of points.
    #[error("border \"{border}\" has {points} point(s) and {found} direction(s): give one a point")]
    Count {
        /// Name of the curve.
        border: String,
        /// Its points.
        points: usize,
        /// Directions given.
        found: usize,
    },
    /// A direction of no length, or one that is no number.
    #[error("border \"{border}\" has no direction at its point {index}, {at}")]
    NoDirection {
        /// Name of the curve.
        border: String,
        /// Index of the point, counted from 0.
        index: usize,
        /// The point, metres.
        at: DVec3,
    },
}

impl Border {
    /// A border of a curve and directions of any length, one a point.
    ///
    /// # Errors
    /// [`BorderError`] where there are too few or too many, or one has no length.
    pub fn new(curve: Curve, directions: Vec<DVec3>) -> Result<Self, BorderError> {
        let directions = unit_directions(&curve, &directions)?;
        Ok(Self { curve, directions })
    }

    /// The curve.
    pub fn curve(&self) -> &Curve {
        &self.curve
    }

    /// The directions, one a point of the curve, of length 1.
    pub fn directions(&self) -> &[DVec3] {
        &self.directions
    }

    /// The directions at the points of another curve, where all of these lie within `snap` metres of this border;
    /// linear between its points.
    pub fn directions_at(&self, curve: &Curve, snap: f64) -> Option<Vec<DVec3>> {
        if curve == &self.curve {
            return Some(self.directions.clone());
        }
        let arc = ArcLength::of(&self.curve);
        let at = |point: &DVec3| {
            let near = closest(&self.curve, *point);
            if near.distance > snap {
                return None;
            }
            let (segment, share) = arc.locate(near.arc_length);
            let next = (segment + 1) % self.directions.len();
            self.directions[segment].lerp(self.directions[next], share).try_normalize()
        };
        curve.points().iter().map(at).collect()
    }

    /// How far the points of a curve are from this border on average, metres.
    pub fn mean_distance(&self, curve: &Curve) -> f64 {
        let sum: f64 = curve.points().iter().map(|p| closest(&self.curve, *p).distance).sum();
        sum / curve.points().len() as f64
    }
}

/// Directions of length 1 from those of any length at the points of a curve.
///
/// # Errors
/// [`BorderError`] where there are too few or too many, or one has no length.
pub(crate) fn unit_directions(curve: &Curve, directions: &[DVec3]) -> Result<Vec<DVec3>, BorderError> {
    let (points, border) = (curve.points(), || curve.name().to_owned());
    if directions.len() != points.len() {
        return Err(BorderError::Count { border: border(), points: points.len(), found: directions.len() });
    }
    // What is not finite comes out as zero, too.
    let units: Vec<DVec3> = directions.iter().map(|d| d.normalize_or_zero()).collect();
    match units.iter().position(|d| *d == DVec3::ZERO) {
        Some(index) => Err(BorderError::NoDirection { border: border(), index, at: points[index] }),
        None => Ok(units),
    }
}

/// The directions at the points of a curve from the border that lies along it, all its points within `snap` metres:
/// the nearest where several do.
pub fn directions_beside(borders: &[Border], curve: &Curve, snap: f64) -> Option<Vec<DVec3>> {
    let fitting = borders.iter().filter_map(|border| Some((border, border.directions_at(curve, snap)?)));
    fitting.min_by(|(a, _), (b, _)| a.mean_distance(curve).total_cmp(&b.mean_distance(curve))).map(|(_, found)| found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn ring(radius: f64, count: u32) -> Border {
        let at = |k: u32| TAU * f64::from(k) / f64::from(count);
        let points = (0..count).map(|k| radius * DVec3::new(at(k).cos(), at(k).sin(), 0.0)).collect();
        Border::new(Curve::new("ring", points, true).unwrap(), vec![DVec3::Z * 3.0; count as usize]).unwrap()
    }

    #[test]
    fn directions_come_from_the_nearest_border_within_the_snap() {
        let borders = [ring(1.0, 40), ring(1.05, 40)];
        let beside = ring(1.01, 37);
        assert_eq!(directions_beside(&borders, beside.curve(), 0.1), Some(vec![DVec3::Z; 37]));
        assert_eq!(directions_beside(&borders, beside.curve(), 0.001), None);
        assert_eq!(borders[0].directions_at(borders[0].curve(), 0.0), Some(vec![DVec3::Z; 40]));
    }

    #[test]
    fn what_has_no_direction_is_refused() {
        let curve = Curve::new("c", vec![DVec3::ZERO, DVec3::X], false).unwrap();
        assert!(matches!(Border::new(curve.clone(), vec![DVec3::X]), Err(BorderError::Count { found: 1, .. })));
        let zero = Border::new(curve, vec![DVec3::X, DVec3::ZERO]).unwrap_err();
        assert!(matches!(zero, BorderError::NoDirection { index: 1, .. }));
    }
}
