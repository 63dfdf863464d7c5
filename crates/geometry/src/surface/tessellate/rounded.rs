//! A rounded cap: one more surface, from the end of another to a point.

use glam::DVec3;

use super::TessellationError;
use crate::surface::analytic::{AnalyticSurface, EndCurves, Side, SurfaceOptions, mean};
use crate::trigonometric::{EllipticSection, EllipticSegment, PlaneFrame, Series};

/// The cap on an end: it continues the surface's tangents and ends in a round pole.
///
/// The pole lies above the mean of the end section, on the normal of its area, as far as a sphere would reach that has
/// the section's mean radius r (that of a circle of equal area) where it leaves with the surface's mean slope:
/// `h = r f/(1 - g)`, f and g the mean shares of the tangent along the normal and outward; between r/4 and 3r/2.
pub(super) fn cap(surface: &AnalyticSurface, side: Side) -> Result<AnalyticSurface, TessellationError> {
    let without_area = TessellationError::CapWithoutArea { side };
    let (u, sign) = match side {
        Side::Start => (0.0, -1.0),
        Side::End => (1.0, 1.0),
    };
    let section = surface.section_at(u).ok_or_else(|| without_area.clone())?;
    let angles = surface.angles();
    let (row, slope) = (surface.row_at(u, 0, 0..angles.lanes()), surface.row_at(u, 1, 0..angles.lanes()));
    let (area, length) = (section.area_vector(), section.length());
    if area.length() <= 1e-9 * length * length {
        return Err(without_area);
    }
    // Where sections run clockwise, their area looks back.
    let axis = area.normalize();
    let axis = if sign * mean(angles, &slope).dot(axis) < 0.0 { -axis } else { axis };
    let radius = (area.length() / std::f64::consts::PI).sqrt();
    let centre = mean(angles, &row);

    let (mut forward, mut outward, mut counted) = (0.0, 0.0, 0.0);
    for (piece, v, share) in angles.probes(8 * (surface.harmonics() + 1)) {
        let s = surface.derivatives(u, &piece, v);
        let (away, radial) = (sign * s[1][0].normalize_or_zero(), s[0][0] - centre);
        let radial = (radial - radial.dot(axis) * axis).normalize_or_zero();
        forward += share * away.dot(axis);
        outward += share * away.dot(radial);
        counted += share * away.length();
    }
    if counted <= 0.0 {
        return Err(without_area);
    }
    let height = radius * (forward / (counted - outward).max(1e-3)).clamp(0.25, 1.5);
    // A circle through rim and pole: its angle, and the speed with which a cubic follows its arc.
    let angle = 2.0 * (height / radius).atan();
    let speed = 4.0 * (angle / 4.0).tan() * radius / angle.sin().max(0.5);
    let scale = speed / angles.root_mean_square(&slope);
    let slope: Vec<DVec3> = slope.into_iter().map(|c| c * scale).collect();

    let pole = centre + height * axis;
    let series = Series::new(vec![pole]).map_err(|_| without_area.clone())?;
    let (from, to) = section.range();
    let point = EllipticSegment { from, to, local: false, series };
    let frame = PlaneFrame { origin: pole, ..*section.frame() };
    let point = EllipticSection::new(frame, true, vec![point]).map_err(|_| without_area.clone())?;
    let curves = vec![angles.segments(&slope).ok_or(without_area)?];
    let given = EndCurves { closed: true, curves, ..EndCurves::default() };
    let (sections, ends) = match side {
        Side::Start => ([point, section], [EndCurves::default(), given]),
        Side::End => ([section, point], [given, EndCurves::default()]),
    };
    Ok(AnalyticSurface::between(&sections, &ends, &SurfaceOptions::default())?)
}
