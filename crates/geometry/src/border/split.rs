//! A closed border taken apart at its corners.

use glam::DVec3;

use super::{Border, BorderError};
use crate::curve::{CubicSpline, Curve, SplineError, SplineLength, closest, place};

/// Points of a side nearer to the one before than this share of their mean distance carry no spline.
const TOO_NEAR: f64 = 0.25;

/// Why a border is not split.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SplitBorderError {
    /// An open border.
    #[error("border \"{border}\" is open: only a closed one is split")]
    Open {
        /// Its name.
        border: String,
    },
    /// Fewer than two corners.
    #[error("{found} corner(s) given: give two or more, in any order")]
    Corners {
        /// Corners given.
        found: usize,
    },
    /// Corners at one place of the border.
    #[error("two corners are nearest to one point of border \"{border}\", {}: draw them farther apart", place(*at))]
    OnePlace {
        /// Name of the border.
        border: String,
        /// The point.
        at: DVec3,
    },
    /// A side that carries no spline.
    #[error(transparent)]
    Spline(#[from] SplineError),
    /// A side that is no border.
    #[error(transparent)]
    Border(#[from] BorderError),
}

/// The sides of a closed border between its points nearest to `corners`, in its order from the first corner: each `count`
/// (2 or more) points at equal distances on a natural C2 spline through the border's, with directions square to it and to
/// the surface's normals, which another spline goes through.
///
/// # Errors
/// [`SplitBorderError`] where the border is open, or corners are too few or too near to one another.
pub fn split(border: &Border, corners: &[DVec3], count: usize) -> Result<Vec<Border>, SplitBorderError> {
    use SplitBorderError as E;
    let curve = border.curve();
    if !curve.is_closed() {
        return Err(E::Open { border: curve.name().to_owned() });
    }
    if corners.len() < 2 {
        return Err(E::Corners { found: corners.len() });
    }
    let nearest = |corner: &DVec3| {
        let at = |k: usize| curve.points()[k].distance_squared(*corner);
        (0..curve.points().len()).fold(0, |best, k| if at(k) < at(best) { k } else { best })
    };
    let mut cuts: Vec<usize> = corners.iter().map(nearest).collect();
    let first = cuts[0];
    cuts.sort_unstable();
    if let Some(pair) = cuts.windows(2).find(|pair| pair[0] == pair[1]) {
        return Err(E::OnePlace { border: curve.name().to_owned(), at: curve.points()[pair[0]] });
    }
    let turn = cuts.iter().position(|cut| *cut == first).unwrap_or(0);
    cuts.rotate_left(turn);
    let total = curve.points().len();
    let sides = (0..cuts.len()).map(|side| {
        let (from, to) = (cuts[side], cuts[(side + 1) % cuts.len()]);
        let steps = (to + total - from - 1) % total + 1;
        let places: Vec<usize> = (0..=steps).map(|k| (from + k) % total).collect();
        one_side(border, &places, count.max(2), side)
    });
    sides.collect()
}

fn one_side(border: &Border, places: &[usize], count: usize, side: usize) -> Result<Border, SplitBorderError> {
    let at = |k: &usize| border.curve().points()[*k];
    let lengths: Vec<f64> = places.windows(2).map(|pair| at(&pair[0]).distance(at(&pair[1]))).collect();
    let total: f64 = lengths.iter().sum();
    let least = TOO_NEAR * total / lengths.len() as f64;
    let (mut kept, mut parameters, mut s) = (vec![places[0]], vec![0.0], 0.0);
    for (place, length) in places[1..].iter().zip(&lengths) {
        s += length;
        if s - parameters[parameters.len() - 1] >= least && total - s >= least {
            kept.push(*place);
            parameters.push(s);
        }
    }
    kept.push(places[places.len() - 1]);
    parameters.push(total);
    let line = SplineLength::of(CubicSpline::natural(parameters.clone(), kept.iter().map(at).collect())?);
    // At a corner the border's direction halves the angle between its sides; the normal is that of both.
    let count_all = border.curve().points().len();
    let normal = |k: &usize| {
        let along = at(&((k + 1) % count_all)) - at(&((k + count_all - 1) % count_all));
        along.cross(border.directions()[*k]).normalize_or_zero()
    };
    let normals = CubicSpline::natural(parameters, kept.iter().map(normal).collect())?;
    let stations: Vec<f64> = (0..count).map(|k| line.length() * k as f64 / (count - 1) as f64).collect();
    let mut points: Vec<DVec3> = stations.iter().map(|s| line.point_at(*s)).collect();
    // The sides meet to the bit.
    (points[0], points[count - 1]) = (at(&places[0]), at(&places[places.len() - 1]));
    let leading = stations.iter().map(|s| {
        let t = line.parameter_at(*s);
        normals.position(t).cross(line.spline().derivative(t))
    });
    let leading = leading.collect();
    let name = format!("{} side {}", border.curve().name(), side + 1);
    let none = |_| BorderError::Count { border: name.clone(), points: points.len(), found: 0 };
    let curve = Curve::new(name.clone(), points.clone(), false).map_err(none)?;
    Ok(Border::new(curve, leading)?)
}

/// How far the corners are from the border at most, metres.
pub fn farthest_corner(border: &Border, corners: &[DVec3]) -> f64 {
    corners.iter().map(|corner| closest(border.curve(), *corner).distance).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::ArcLength;

    /// A square hole of side 2 about the origin in XZ, ten points a side; at corners the directions are diagonal.
    fn square() -> Border {
        let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].map(|(x, z)| DVec3::new(x, 0.0, z));
        let at = |k: usize| corners[k / 10 % 4].lerp(corners[(k / 10 + 1) % 4], (k % 10) as f64 / 10.0);
        let inwards = |k: usize| (at(k + 1) - at((k + 39) % 40)).cross(DVec3::Y);
        Border::new(Curve::new("hole", (0..40).map(at).collect(), true).unwrap(), (0..40).map(inwards).collect())
            .unwrap()
    }

    #[test]
    fn a_square_has_four_sides_from_the_first_corner_on() {
        let corners = [(-1.1, 0.9), (1.0, 1.2), (1.0, -1.0), (-0.9, -1.0)].map(|(x, z)| DVec3::new(x, 0.1, z));
        let sides = split(&square(), &corners, 33).unwrap();
        assert_eq!(sides.len(), 4);
        assert_eq!(sides[0].curve().points()[0], DVec3::new(-1.0, 0.0, 1.0));
        for (k, side) in sides.iter().enumerate() {
            assert_eq!(side.curve().end(), sides[(k + 1) % 4].curve().start());
            assert!((ArcLength::of(side.curve()).length() - 2.0).abs() < 1e-12 && side.curve().points().len() == 33);
            let along = (side.curve().end() - side.curve().start()) / 2.0;
            assert!(
                side.directions().iter().all(|d| d.distance(along.cross(DVec3::Y)) < 1e-9),
                "{:?}",
                side.directions()
            );
        }
        assert!((0.1..0.25).contains(&farthest_corner(&square(), &corners)));
    }

    #[test]
    fn errors() {
        let corner = DVec3::new(1.0, 0.0, 1.0);
        assert_eq!(split(&square(), &[corner], 9), Err(SplitBorderError::Corners { found: 1 }));
        let one = split(&square(), &[corner, corner * 1.01], 9).unwrap_err();
        assert!(matches!(one, SplitBorderError::OnePlace { .. }), "{one}");
        let open =
            Border::new(Curve::new("c", vec![DVec3::ZERO, DVec3::X], false).unwrap(), vec![DVec3::Y; 2]).unwrap();
        assert_eq!(split(&open, &[corner; 2], 9), Err(SplitBorderError::Open { border: "c".into() }));
    }
}
