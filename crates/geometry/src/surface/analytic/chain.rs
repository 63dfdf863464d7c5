//! Several parts end to end, their joints solved together.

use glam::DVec3;

use super::Blend;
use super::angles::{Angles, is_point};
use super::ends::{EndCurves, largest_distance, size};
use super::error::{Side, SurfaceError};
use super::options::{Continuity, EndCondition, SurfaceOptions};
use super::surface::AnalyticSurface;
use crate::trigonometric::EllipticSection;

/// Surfaces through parts that meet end to end: the last section of each part is the first of the next.
///
/// One C2 spline through all sections of all parts gives the derivatives at the joints; each part is then made with
/// these at its ends (thesis 4.11). Made one after the other with one-sided tangents (4.7) the parts would hand a
/// section out of line on to all that follow, undamped; the spline damps it 3.7 times a section. With [`Blend::Spline`]
/// in all parts the parts are that spline and meet C2; parts that are polynomials meet C1, or C2 with
/// [`Continuity::Curvature`]. `options` holds for all parts, its conditions for the ends of the chain.
///
/// # Errors
/// [`SurfaceError`] as [`AnalyticSurface::through`], naming the part, and where two parts do not share a section.
pub fn chain(
    parts: &[Vec<EllipticSection>],
    options: &SurfaceOptions,
    continuity: Continuity,
) -> Result<Vec<AnalyticSurface>, SurfaceError> {
    if let [only] = parts {
        return Ok(vec![AnalyticSurface::through(only, options)?]);
    }
    let mut all: Vec<EllipticSection> = Vec::new();
    let mut joints = Vec::with_capacity(parts.len() + 1);
    for (part, sections) in parts.iter().enumerate() {
        if sections.len() < 2 {
            let error = Box::new(SurfaceError::TooFewSections { found: sections.len() });
            return Err(SurfaceError::Part { part, error });
        }
        if let Some(last) = all.last() {
            shared(part - 1, last, &sections[0])?;
        }
        joints.push(all.len().saturating_sub(1));
        all.extend(sections.iter().skip(usize::from(part > 0)).cloned());
    }
    joints.push(all.len().saturating_sub(1));
    let whole = AnalyticSurface::through(&all, &SurfaceOptions { blend: Blend::Spline, ..options.clone() })
        .map_err(|error| in_its_part(&joints, error))?;
    let knots = whole.section_parameters();
    let mut surfaces = Vec::with_capacity(parts.len());
    for (part, sections) in parts.iter().enumerate() {
        let (from, to) = (knots[joints[part]], knots[joints[part + 1]]);
        // The free end of a spline is that of the whole chain, which the part alone may have too few sections to see.
        let of_whole =
            |condition: &EndCondition| *condition == EndCondition::Free && !options.blend.is_polynomial(sections.len());
        let at_joint = |u: f64, condition: &EndCondition, side: Side, outer: bool| {
            if !outer {
                return joint(&whole, u, to - from, continuity);
            }
            if of_whole(condition) {
                joint(&whole, u, to - from, Continuity::Tangent)
            } else {
                EndCurves::of(condition, side)
            }
        };
        let ends = [
            at_joint(from, &options.start, Side::Start, part == 0)?,
            at_joint(to, &options.end, Side::End, part + 1 == parts.len())?,
        ];
        let surface = AnalyticSurface::between(sections, &ends, options)
            .map_err(|error| SurfaceError::Part { part, error: Box::new(error) })?;
        surfaces.push(surface);
    }
    Ok(surfaces)
}

/// The derivatives of the whole chain at u, for a part that takes `share` of its u.
fn joint(whole: &AnalyticSurface, u: f64, share: f64, continuity: Continuity) -> Result<EndCurves, SurfaceError> {
    let angles = whole.angles();
    let derivative = |order: usize, scale: f64| {
        let row: Vec<DVec3> = whole.row_at(u, order, 0..angles.lanes()).into_iter().map(|c| scale * c).collect();
        angles.segments(&row).ok_or(SurfaceError::Unsolvable)
    };
    let mut curves = vec![derivative(1, share)?];
    if continuity == Continuity::Curvature {
        curves.push(derivative(2, share * share)?);
    }
    Ok(EndCurves { closed: whole.is_closed(), curves, ..EndCurves::default() })
}

/// Refuses two sections that should be one and are not.
fn shared(part: usize, last: &EllipticSection, first: &EllipticSection) -> Result<(), SurfaceError> {
    let wrong = |error| SurfaceError::Part { part, error: Box::new(error) };
    if last.is_closed() != first.is_closed() {
        return Err(wrong(SurfaceError::OtherNeighbour { side: Side::End }));
    }
    let (angles, rows) = Angles::common(&[last.segments(), first.segments()], last.is_closed())
        .map_err(|_| wrong(SurfaceError::OtherNeighbour { side: Side::End }))?;
    let (a, b) = rows.split_at(angles.lanes());
    let distance = largest_distance(&angles, a, b);
    let points = last.segments().iter().all(is_point);
    // A point has no size: there a metre counts.
    let scale = if points { 1.0 } else { size(&angles, a) };
    if distance > 1e-6 * scale { Err(SurfaceError::BrokenChain { part, distance }) } else { Ok(()) }
}

/// The same error with sections counted within the part that has them.
fn in_its_part(joints: &[usize], error: SurfaceError) -> SurfaceError {
    let place = |section: usize| {
        let part = joints[1..].iter().position(|end| section < *end).unwrap_or(joints.len() - 2);
        (part, section - joints[part])
    };
    let (part, error) = match error {
        SurfaceError::MixedClosure { section, closed } => {
            let (part, section) = place(section);
            (part, SurfaceError::MixedClosure { section, closed })
        }
        SurfaceError::TooLarge { section, coordinate } => {
            let (part, section) = place(section);
            (part, SurfaceError::TooLarge { section, coordinate })
        }
        SurfaceError::LocalAngles { section, from, to } => {
            let (part, section) = place(section);
            (part, SurfaceError::LocalAngles { section, from, to })
        }
        SurfaceError::IdenticalSections { first, .. } => {
            let (part, first) = place(first);
            (part, SurfaceError::IdenticalSections { first, second: first + 1 })
        }
        SurfaceError::NeighbouringPoles { first, .. } => {
            let (part, first) = place(first);
            (part, SurfaceError::NeighbouringPoles { first, second: first + 1 })
        }
        other => return other,
    };
    SurfaceError::Part { part, error: Box::new(error) }
}
