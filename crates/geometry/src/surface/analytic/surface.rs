//! The surface as a value: what it is made from, and what it is at any u and v.

use glam::DVec3;
use std::sync::Arc;

use super::angles::{Angles, Piece, combined};
use super::blend::Along;
use super::crossing;
use super::differential::SurfacePoint;
use super::ends::{self, EndCurves};
use super::error::{Side, SurfaceError, SurfaceWarning};
use super::options::SurfaceOptions;
use super::solve::{self, EndRows};
use super::{Blend, MOST_OF_POLYNOMIAL};
use crate::surface::{PoleShape, UParameter, knots};
use crate::trigonometric::{EllipticSection, EllipticSegment, PlaneFrame, Series};

/// A surface through cross-sections that are trigonometric series (thesis chapter 4):
/// `S(u, v) = sum over m of w_m(u) f_m(v)`, metres, with u from 0 at the first section to 1 at the last, v the angle of
/// the sections, `w` a polynomial or a C2 spline ([`Blend`]), and `f_m` series in the sections' own form.
///
/// It is exact at every u and v, and its normals face outwards where sections run counter-clockwise about the direction
/// of stacking. Sections of several segments make one patch a segment; the patches share their joints and are C1
/// across them (4.20), because every section is brought to the joints of all and one set of functions of u blends them.
///
/// A value that is cheap to clone.
#[derive(Clone, Debug, PartialEq)]
pub struct AnalyticSurface(Arc<Inner>);

#[derive(Debug, PartialEq)]
struct Inner {
    angles: Angles,
    along: Along,
    /// Rows of coefficients, as `along` has them.
    rows: Vec<DVec3>,
    /// u of each section.
    knots: Vec<f64>,
    /// The sections' own coefficients, row after row.
    sections: Vec<DVec3>,
    poles: Vec<bool>,
    ends: [EndRows; 2],
    warnings: Vec<SurfaceWarning>,
}

/// Sections brought to common joints, with what is needed to solve for a surface.
pub(crate) struct Plan {
    pub angles: Angles,
    pub sections: Vec<DVec3>,
    pub knots: Vec<f64>,
    pub ends: [EndRows; 2],
    pub polynomial: bool,
    pub warnings: Vec<SurfaceWarning>,
}

impl AnalyticSurface {
    /// The surface through sections in order.
    ///
    /// Sections with fewer harmonics than others are padded; joints of one section are brought to all ([`Self::joints`]).
    /// A section whose coefficients but the first are all zero is a pole.
    ///
    /// # Errors
    /// [`SurfaceError`] where there are fewer than two sections, neighbours are identical or both points, open ones are
    /// among closed ones, joints of local angles differ, a neighbour does not fit, or a polynomial has too many.
    pub fn through(sections: &[EllipticSection], options: &SurfaceOptions) -> Result<Self, SurfaceError> {
        let ends = [EndCurves::of(&options.start, Side::Start)?, EndCurves::of(&options.end, Side::End)?];
        Self::between(sections, &ends, options)
    }

    /// As [`Self::through`], with the derivatives at the ends already at hand.
    pub(crate) fn between(
        sections: &[EllipticSection],
        ends: &[EndCurves; 2],
        options: &SurfaceOptions,
    ) -> Result<Self, SurfaceError> {
        let sections = checked(sections)?;
        let plan = Self::planned(&sections, ends, options)?;
        Self::solved(Plan { warnings: crossing::find(&sections), ..plan })
    }

    /// As [`Self::through`], without warnings: looking for them costs more than the surface.
    pub(crate) fn unwarned(sections: &[EllipticSection], options: &SurfaceOptions) -> Result<Self, SurfaceError> {
        let ends = [EndCurves::of(&options.start, Side::Start)?, EndCurves::of(&options.end, Side::End)?];
        Self::solved(Self::planned(&checked(sections)?, &ends, options)?)
    }

    /// What a surface through checked sections is solved from, without warnings.
    fn planned(
        sections: &[EllipticSection],
        ends: &[EndCurves; 2],
        options: &SurfaceOptions,
    ) -> Result<Plan, SurfaceError> {
        let count = sections.len();
        let closed = sections[0].is_closed();
        let mut curves: Vec<&[EllipticSegment]> = sections.iter().map(EllipticSection::segments).collect();
        for (end, side) in ends.iter().zip([Side::Start, Side::End]) {
            if !end.curves.is_empty() && end.closed != closed {
                return Err(SurfaceError::OtherNeighbour { side });
            }
            curves.extend(end.curves.iter().map(Vec::as_slice));
        }
        let (angles, mut rows) = Angles::common(&curves, closed).map_err(|error| match error {
            SurfaceError::LocalAngles { section, .. } if section >= count => {
                let side = if section < count + ends[0].curves.len() { Side::Start } else { Side::End };
                SurfaceError::OtherNeighbour { side }
            }
            error => error,
        })?;
        let lanes = angles.lanes();
        let mut extra = rows.split_off(count * lanes);
        let of_end = extra.split_off(ends[0].curves.len() * lanes);
        let distances = distances(&angles, &rows)?;
        let knots = spread(&distances, options.parameter);
        let mut given = [EndRows::default(), EndRows::default()];
        for (k, (extra, side)) in [(extra, Side::Start), (of_end, Side::End)].into_iter().enumerate() {
            let (section, gap) = if k == 0 { (0, 0) } else { (count - 1, count - 2) };
            let speed = distances[gap] / (knots[gap + 1] - knots[gap]);
            given[k] = ends[k].rows(
                &angles,
                &rows[section * lanes..(section + 1) * lanes],
                extra,
                speed,
                distances[gap],
                side,
            )?;
            let is_pole = is_pole(&angles, &rows[section * lanes..(section + 1) * lanes]);
            if is_pole && given[k].slope.is_none() && options.pole == PoleShape::Pointed {
                given[k].natural = true;
            } else if is_pole && given[k].slope.is_none() {
                let ring = if k == 0 { 1 } else { count - 2 };
                let interval = knots[gap + 1] - knots[gap];
                let slope = ends::round_pole(
                    &angles,
                    rows[section * lanes],
                    &sections[ring],
                    &rows[ring * lanes..(ring + 1) * lanes],
                    if k == 0 { interval } else { -interval },
                );
                given[k] = EndRows { natural: slope.is_none(), slope, second: None };
            }
        }
        let polynomial = options.blend.is_polynomial(count);
        if polynomial && count > MOST_OF_POLYNOMIAL {
            return Err(SurfaceError::TooManyForPolynomial { sections: count });
        }
        Ok(Plan { angles, sections: rows, knots, ends: given, polynomial, warnings: Vec::new() })
    }

    /// The surface of a plan.
    pub(crate) fn solved(plan: Plan) -> Result<Self, SurfaceError> {
        let Plan { angles, sections, knots, ends, polynomial, warnings } = plan;
        let lanes = angles.lanes();
        let solver = if polynomial { solve::polynomial } else { solve::spline };
        let (along, rows) = solver(&knots, &sections, [&ends[0], &ends[1]], lanes).ok_or(SurfaceError::Unsolvable)?;
        let poles = sections.chunks_exact(lanes).map(|row| is_pole(&angles, row)).collect();
        Ok(Self(Arc::new(Inner { angles, along, rows, knots, sections, poles, ends, warnings })))
    }

    /// Position, tangents, normal and curvatures at `u` and `v`. `u` is clamped to 0..=1, `v` wrapped around a closed
    /// surface and clamped to an open one; at a joint the segment that begins there counts.
    pub fn evaluate(&self, u: f64, v: f64) -> SurfacePoint {
        let u = unit(u);
        let (piece, v) = self.0.angles.locate(v);
        SurfacePoint::new(u, self.derivatives(u, piece, v))
    }

    /// The derivatives by u and v at a place in a piece: `[i][j]` is of order i in u and j in v.
    pub(crate) fn derivatives(&self, u: f64, piece: &Piece, v: f64) -> [[DVec3; 3]; 3] {
        let lanes = piece.lanes();
        let rows = [0, 1, 2].map(|order| self.row_at(u, order, lanes.clone()));
        let bases = [0, 1, 2].map(|order| {
            let mut basis = vec![0.0; lanes.len()];
            piece.basis(v, order, &mut basis);
            basis
        });
        let mut found = [[DVec3::ZERO; 3]; 3];
        for (i, row) in rows.iter().enumerate() {
            for (j, basis) in bases.iter().enumerate() {
                found[i][j] = combined(row, basis);
            }
        }
        found
    }

    /// Coefficients of the series at `u`, or of their derivatives by u, of a range of lanes. At a section they are the
    /// section's own to the bit.
    pub(crate) fn row_at(&self, u: f64, order: usize, lanes: std::ops::Range<usize>) -> Vec<DVec3> {
        let width = self.0.angles.lanes();
        if order == 0
            && let Some(knot) = self.section_index(u)
        {
            return self.0.sections[knot * width + lanes.start..knot * width + lanes.end].to_vec();
        }
        let weights = self.0.along.weights(u);
        let mut row = vec![DVec3::ZERO; lanes.len()];
        for (k, weight) in weights.orders[order].iter().enumerate() {
            let from = (weights.first + k) * width;
            for (sum, c) in row.iter_mut().zip(&self.0.rows[from + lanes.start..from + lanes.end]) {
                *sum += *weight * *c;
            }
        }
        row
    }

    /// The section of the surface at `u`, as series; at the u of a section it is that section. The frame is that of the
    /// curve: its mean over v, and the normal about which it runs counter-clockwise. `None` only where the surface
    /// swings beyond all numbers.
    pub fn section_at(&self, u: f64) -> Option<EllipticSection> {
        let row = self.row_at(unit(u), 0, 0..self.0.angles.lanes());
        let segments = self.0.angles.segments(&row)?;
        let frame = PlaneFrame::new(row[0], DVec3::ZERO);
        let found = EllipticSection::new(frame, self.0.angles.closed, segments.clone()).ok()?;
        let frame = PlaneFrame::new(mean(&self.0.angles, &row), found.area_vector());
        EllipticSection::new(frame, self.0.angles.closed, segments).ok()
    }

    /// u of each section, from 0 to 1.
    pub fn section_parameters(&self) -> &[f64] {
        &self.0.knots
    }

    /// First and last angle: 2 pi apart for a closed surface, 0 and pi for an open one.
    pub fn angle_range(&self) -> (f64, f64) {
        self.0.angles.range()
    }

    /// Angles at which patches meet, ascending; for a closed surface of several patches the first is where the turn
    /// begins and ends.
    pub fn joints(&self) -> Vec<f64> {
        self.0.angles.joints()
    }

    /// Whether it closes around v.
    pub fn is_closed(&self) -> bool {
        self.0.angles.closed
    }

    /// Whether section `index` is a point.
    pub fn is_pole(&self, index: usize) -> bool {
        self.0.poles.get(index).copied().unwrap_or(false)
    }

    /// Most harmonics of any patch.
    pub fn harmonics(&self) -> usize {
        self.0.angles.pieces.iter().map(|piece| piece.harmonics).max().unwrap_or(0)
    }

    /// Which functions of u blend the sections: [`Blend::Polynomial`] or [`Blend::Spline`].
    pub fn blend(&self) -> Blend {
        match self.0.along {
            Along::Polynomial { .. } => Blend::Polynomial,
            Along::Spline { .. } => Blend::Spline,
        }
    }

    /// Numbers that determine the surface, counted as the thesis does (4.1): three coordinates of each coefficient of
    /// each section, and of each derivative given at an end.
    pub fn constants(&self) -> usize {
        3 * (self.0.sections.len() + self.0.angles.lanes() * (self.0.ends[0].count() + self.0.ends[1].count()))
    }

    /// Bytes in memory.
    pub fn bytes(&self) -> usize {
        let ends = self.0.ends.iter().map(EndRows::count).sum::<usize>() * self.0.angles.lanes();
        size_of::<DVec3>() * (self.0.rows.len() + self.0.sections.len() + ends)
            + size_of::<f64>() * 2 * self.0.knots.len()
            + size_of::<Inner>()
    }

    /// What is doubtful about the sections.
    pub fn warnings(&self) -> &[SurfaceWarning] {
        &self.0.warnings
    }

    pub(crate) fn angles(&self) -> &Angles {
        &self.0.angles
    }

    /// The section whose u is exactly this.
    pub(crate) fn section_index(&self, u: f64) -> Option<usize> {
        self.0.knots.iter().position(|knot| *knot == u)
    }

    pub(crate) fn along(&self) -> &Along {
        &self.0.along
    }

    /// What the surface was solved from.
    pub(crate) fn plan(&self) -> Plan {
        let inner = &*self.0;
        Plan {
            angles: inner.angles.clone(),
            sections: inner.sections.clone(),
            knots: inner.knots.clone(),
            ends: inner.ends.clone(),
            polynomial: matches!(inner.along, Along::Polynomial { .. }),
            warnings: inner.warnings.clone(),
        }
    }

    pub(crate) fn section_rows(&self) -> &[DVec3] {
        &self.0.sections
    }

    pub(crate) fn end_rows(&self) -> &[EndRows; 2] {
        &self.0.ends
    }
}

/// Clamped to 0..=1; 0 where it is not a number.
fn unit(u: f64) -> f64 {
    if u.is_nan() { 0.0 } else { u.clamp(0.0, 1.0) }
}

/// The sections, those that are a point but for rounding made one; refuses what can't be a stack.
fn checked(sections: &[EllipticSection]) -> Result<Vec<EllipticSection>, SurfaceError> {
    if sections.len() < 2 {
        return Err(SurfaceError::TooFewSections { found: sections.len() });
    }
    let mut largest = 0.0_f64;
    for (section, own) in sections.iter().enumerate() {
        if own.is_closed() != sections[0].is_closed() {
            return Err(SurfaceError::MixedClosure { section, closed: own.is_closed() });
        }
        let coefficients = own.segments().iter().flat_map(|segment| segment.series.coefficients());
        let coordinate = coefficients.fold(0.0, |most: f64, c| most.max(c.abs().max_element()));
        if coordinate > 1e100 {
            return Err(SurfaceError::TooLarge { section, coordinate });
        }
        let shape = own.segments().iter().flat_map(|segment| &segment.series.coefficients()[1..]);
        largest = shape.fold(largest, |most, c| most.max(c.length()));
    }
    let as_point = |section: &EllipticSection| {
        let series = Series::new(vec![ends::nearly_point(section, 1e-9 * largest)?]).ok()?;
        let (from, to) = section.range();
        let segment = EllipticSegment { from, to, local: false, series };
        EllipticSection::new(*section.frame(), section.is_closed(), vec![segment]).ok()
    };
    Ok(sections.iter().map(|section| as_point(section).unwrap_or_else(|| section.clone())).collect())
}

/// Distances of neighbouring sections, root mean squares over v.
pub(crate) fn distances(angles: &Angles, rows: &[DVec3]) -> Result<Vec<f64>, SurfaceError> {
    let lanes = angles.lanes();
    let sections: Vec<&[DVec3]> = rows.chunks_exact(lanes).collect();
    let size = rows.iter().fold(0.0, |most: f64, c| most.max(c.abs().max_element()));
    let mut distances = Vec::with_capacity(sections.len() - 1);
    for (first, pair) in sections.windows(2).enumerate() {
        let second = first + 1;
        let apart: Vec<DVec3> = pair[1].iter().zip(pair[0]).map(|(b, a)| *b - *a).collect();
        let distance = angles.root_mean_square(&apart);
        // Below this, squared lengths underflow or the sections differ by rounding only.
        if distance <= 1e-12 * size || distance < 1e-100 {
            return Err(SurfaceError::IdenticalSections { first, second });
        }
        if is_pole(angles, pair[0]) && is_pole(angles, pair[1]) {
            return Err(SurfaceError::NeighbouringPoles { first, second });
        }
        distances.push(distance);
    }
    Ok(distances)
}

/// u of each section.
pub(crate) fn spread(distances: &[f64], parameter: UParameter) -> Vec<f64> {
    let intervals = knots::lifted(distances.iter().map(|d| parameter.interval(*d)).collect());
    let total: f64 = intervals.iter().sum();
    let mut sum = 0.0;
    let mut spread: Vec<f64> = std::iter::once(0.0)
        .chain(intervals.iter().map(|interval| {
            sum += interval;
            sum / total
        }))
        .collect();
    if let Some(last) = spread.last_mut() {
        *last = 1.0;
    }
    spread
}

/// Whether all pieces of a row are one point.
pub(crate) fn is_pole(angles: &Angles, row: &[DVec3]) -> bool {
    angles.pieces.iter().all(|piece| {
        let own = &row[piece.lanes()];
        own[0] == row[0] && own[1..].iter().all(|c| *c == DVec3::ZERO)
    })
}

/// Mean of a row over v, by the midpoint rule.
pub(crate) fn mean(angles: &Angles, row: &[DVec3]) -> DVec3 {
    let most = angles.pieces.iter().map(|piece| piece.harmonics).max().unwrap_or(0);
    let mut weights = vec![0.0; 2 * most + 1];
    let sum = |(piece, v, share): (Piece, f64, f64)| {
        let lanes = piece.lanes();
        piece.basis(v, 0, &mut weights[..lanes.len()]);
        share * combined(&row[lanes], &weights)
    };
    angles.probes(4 * (most + 1)).into_iter().map(sum).sum()
}
