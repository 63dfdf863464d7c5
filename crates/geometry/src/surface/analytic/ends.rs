//! Derivatives at the ends of a surface: from a neighbour, or of a round pole.

use glam::DVec3;

use super::angles::{Angles, is_point};
use super::error::{Side, SurfaceError};
use super::options::{Continuity, EndCondition};
use super::solve::EndRows;
use super::surface::mean;
use crate::trigonometric::{EllipticSection, EllipticSegment};

/// Coefficients that differ by less than this share of a section's size are those of one section.
const SAME_SECTION: f64 = 1e-6;

/// What is given at an end, as chains of segments that still have to be brought to the joints of the surface.
#[derive(Clone, Debug, Default)]
pub(crate) struct EndCurves {
    pub closed: bool,
    /// The section of the neighbour where there is one, then the slope, then the second derivative where it is given.
    pub curves: Vec<Vec<EllipticSegment>>,
    /// Distance of sections per u of the neighbour. Where there is none, derivatives are in the u of the surface.
    pub neighbour_speed: Option<f64>,
    pub natural: bool,
}

impl EndCurves {
    /// What a condition asks for at a side.
    pub fn of(condition: &EndCondition, side: Side) -> Result<Self, SurfaceError> {
        let (surface, continuity) = match condition {
            EndCondition::Free => return Ok(Self::default()),
            EndCondition::Natural => return Ok(Self { natural: true, ..Self::default() }),
            EndCondition::Neighbour { surface, continuity } => (surface, continuity),
        };
        let angles = surface.angles();
        let knots = surface.section_parameters();
        let last = knots.len() - 1;
        let (u, near, far, gap) = match side {
            Side::Start => (1.0, last, last - 1, last - 1),
            Side::End => (0.0, 0, 1, 0),
        };
        let lanes = angles.lanes();
        let row = |k: usize| &surface.section_rows()[k * lanes..(k + 1) * lanes];
        let apart: Vec<DVec3> = row(near).iter().zip(row(far)).map(|(a, b)| *a - *b).collect();
        let speed = angles.root_mean_square(&apart) / (knots[gap + 1] - knots[gap]);
        let orders = match continuity {
            Continuity::Tangent => 2,
            Continuity::Curvature => 3,
        };
        let curves = (0..orders)
            .map(|order| angles.segments(&surface.row_at(u, order, 0..lanes)))
            .collect::<Option<_>>()
            .ok_or(SurfaceError::Unsolvable)?;
        Ok(Self { closed: surface.is_closed(), curves, neighbour_speed: Some(speed), natural: false })
    }

    /// The rows of the surface's end from `given`, which has the curves' coefficients row after row; `own` is the
    /// section at the end, `speed` the surface's distance of sections per u there, `gap` that to the next section.
    pub fn rows(
        &self,
        angles: &Angles,
        own: &[DVec3],
        mut given: Vec<DVec3>,
        speed: f64,
        gap: f64,
        side: Side,
    ) -> Result<EndRows, SurfaceError> {
        let lanes = angles.lanes();
        let mut lambda = 1.0;
        if let Some(neighbour) = self.neighbour_speed {
            let derivatives = given.split_off(lanes);
            let distance = largest_distance(angles, own, &given);
            if distance > SAME_SECTION * (gap + size(angles, own)) {
                return Err(SurfaceError::NotShared { side, distance });
            }
            lambda = speed / neighbour;
            given = derivatives;
        }
        let second = if given.len() > lanes { Some(given.split_off(lanes)) } else { None };
        let scaled = |row: Vec<DVec3>, by: f64| row.into_iter().map(|c| c * by).collect();
        Ok(EndRows {
            slope: (!given.is_empty()).then(|| scaled(given, lambda)),
            second: second.map(|row| scaled(row, lambda * lambda)),
            natural: self.natural,
        })
    }
}

/// Bound on the distance of two rows of coefficients at equal v.
pub(crate) fn largest_distance(angles: &Angles, a: &[DVec3], b: &[DVec3]) -> f64 {
    let of_piece =
        |lanes: std::ops::Range<usize>| a[lanes.clone()].iter().zip(&b[lanes]).map(|(a, b)| a.distance(*b)).sum();
    angles.pieces.iter().map(|piece| of_piece(piece.lanes())).fold(0.0, f64::max)
}

/// Sum of the lengths of the coefficients but the constant ones, the most of any piece.
pub(crate) fn size(angles: &Angles, row: &[DVec3]) -> f64 {
    let of_piece = |lanes: std::ops::Range<usize>| row[lanes][1..].iter().map(|c| c.length()).sum();
    angles.pieces.iter().map(|piece| of_piece(piece.lanes())).fold(0.0, f64::max)
}

/// The slope at a round pole, or `None` where the fan between pole and ring has no area.
///
/// All columns leave in one plane, square to the vector area of the fan: the ring's coefficients laid into it, times
/// one factor, so that a ring at the mean height and reach of this one is met by the arc of a circle that is tangent to
/// the plane (`psi / sin(psi)` times the chord, `psi` the angle between plane and chord), but at most twice the reach.
/// `interval` is the distance in u from pole to ring, negative where the pole is at the end.
pub(crate) fn round_pole(
    angles: &Angles,
    pole: DVec3,
    ring: &EllipticSection,
    row: &[DVec3],
    interval: f64,
) -> Option<Vec<DVec3>> {
    let mut area = ring.area_vector();
    if !ring.is_closed() {
        let (from, to) = ring.range();
        area -= 0.5 * (ring.point(to) - pole).cross(ring.point(from) - pole);
    }
    let mut arms = row.to_vec();
    for piece in &angles.pieces {
        arms[piece.lane] -= pole;
    }
    let reach = angles.root_mean_square(&arms);
    if area.length() <= 1e-9 * reach * reach {
        return None;
    }
    let axis = area.normalize();
    let flat: Vec<DVec3> = arms.iter().map(|c| *c - c.dot(axis) * axis).collect();
    let (height, radius) = (mean(angles, &arms).dot(axis).abs(), angles.root_mean_square(&flat));
    let psi = height.atan2(radius);
    let stretch = if psi < 1e-6 { 1.0 } else { psi / psi.sin() };
    let factor = (height.hypot(radius) * stretch / radius).min(2.0);
    Some(flat.into_iter().map(|c| c * (factor / interval)).collect())
}

/// Whether all segments of a section are one point to within `tolerance`, metres; where so, that point.
pub(crate) fn nearly_point(section: &EllipticSection, tolerance: f64) -> Option<DVec3> {
    let segments = section.segments();
    let point = segments[0].series.coefficients()[0];
    let near = |segment: &EllipticSegment| {
        let coefficients = segment.series.coefficients();
        coefficients[0].distance(point) <= tolerance
            && (is_point(segment) || coefficients[1..].iter().all(|c| c.length() <= tolerance))
    };
    segments.iter().all(near).then_some(point)
}
