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
    let whole = AnalyticSurface::unwarned(&all, &SurfaceOptions { blend: Blend::Spline, ..options.clone() })
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

/// Why parts have no order in which they make a chain.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ChainOrderError {
    /// No part at all.
    #[error("no part given")]
    NoParts,
    /// A part without a surface.
    #[error("part {part} has {found} section(s), and a surface needs at least 2")]
    TooFewSections {
        /// Index of the part, counted from 0.
        part: usize,
        /// Its sections.
        found: usize,
    },
    /// Two parts that run towards each other or away from each other.
    #[error(
        "parts {first} and {second} both {} in the same section: run the sections of one of them the other way", side.verb()
    )]
    Opposed {
        /// Index of a part, counted from 0.
        first: usize,
        /// Index of the other.
        second: usize,
        /// Where both are the same.
        side: Side,
    },
    /// A section in which several parts begin, or several end.
    #[error("parts {first} and {second} both follow part {part}: a chain goes on in one of them, leave the other out")]
    Forked {
        /// Index of the part that both follow, counted from 0.
        part: usize,
        /// Index of one that follows.
        first: usize,
        /// Index of the other.
        second: usize,
    },
    /// Parts that go round in a ring.
    #[error("the parts follow one another in a ring: a chain has a first and a last part, leave one out")]
    Ring,
    /// Parts that do not meet.
    #[error(
        "part {first} ends and part {second} begins without sharing a section with another: give them one section in \
         common, fitted with the same options"
    )]
    Apart {
        /// Index of a part that nothing follows, counted from 0.
        first: usize,
        /// Index of a part that follows nothing.
        second: usize,
    },
}

impl Side {
    fn verb(self) -> &'static str {
        match self {
            Self::Start => "begin",
            Self::End => "end",
        }
    }
}

/// The order in which parts make a chain: each begins with the section in which the one before ends, as [`chain`] wants
/// them.
///
/// # Errors
/// [`ChainOrderError`] where there is none.
pub fn chain_order(parts: &[Vec<EllipticSection>]) -> Result<Vec<usize>, ChainOrderError> {
    let mut ends = Vec::with_capacity(parts.len());
    for (part, sections) in parts.iter().enumerate() {
        match sections.as_slice() {
            [first, .., last] => ends.push((first, last)),
            few => return Err(ChainOrderError::TooFewSections { part, found: few.len() }),
        }
    }
    let same = |a: &EllipticSection, b: &EllipticSection| shared(0, a, b).is_ok();
    let count = ends.len();
    let (mut next, mut before) = (vec![None; count], vec![None; count]);
    for first in 0..count {
        for second in (0..count).filter(|second| *second != first) {
            if !same(ends[first].1, ends[second].0) {
                continue;
            }
            if let Some(other) = next[first].replace(second) {
                return Err(ChainOrderError::Forked { part: first, first: other, second });
            }
            if before[second].replace(first).is_some_and(|other| other != first) {
                let other = (0..first).find(|other| next[*other] == Some(second)).unwrap_or(first);
                return Err(ChainOrderError::Opposed { first: other, second: first, side: Side::End });
            }
        }
    }
    let starts: Vec<usize> = (0..count).filter(|part| before[*part].is_none()).collect();
    let Some(mut part) = starts.first().copied() else {
        return Err(if count == 0 { ChainOrderError::NoParts } else { ChainOrderError::Ring });
    };
    let mut order = vec![part];
    while let Some(follower) = next[part] {
        order.push(follower);
        part = follower;
    }
    if order.len() == count {
        return Ok(order);
    }
    for first in 0..count {
        for second in first + 1..count {
            for (side, a, b) in
                [(Side::Start, ends[first].0, ends[second].0), (Side::End, ends[first].1, ends[second].1)]
            {
                if same(a, b) {
                    return Err(ChainOrderError::Opposed { first, second, side });
                }
            }
        }
    }
    match starts.get(1) {
        Some(second) => Err(ChainOrderError::Apart { first: part, second: *second }),
        None => Err(ChainOrderError::Ring),
    }
}
