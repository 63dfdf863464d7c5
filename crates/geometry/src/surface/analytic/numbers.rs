//! A surface as a list of numbers and back: for content hashes and for storing it.

use glam::DVec3;

use super::angles::{Angles, Piece};
use super::solve::EndRows;
use super::surface::{AnalyticSurface, Plan};

/// Numbers that are no surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the numbers do not make a surface")]
pub struct NoSurface;

/// Most of anything that is counted: what a list of numbers says must not ask for more memory than it has.
const MOST: f64 = 1e7;

impl AnalyticSurface {
    /// All numbers that determine the surface, in a fixed order: equal surfaces have equal numbers, and others differ in
    /// some.
    pub fn numbers(&self) -> Vec<f64> {
        let Plan { angles, sections, knots, ends, polynomial, .. } = self.plan();
        let flag = |on: bool| if on { 1.0 } else { 0.0 };
        let mut numbers = vec![flag(angles.closed), flag(polynomial), angles.pieces.len() as f64, knots.len() as f64];
        for piece in &angles.pieces {
            numbers.extend([piece.from, piece.to, flag(piece.local), piece.harmonics as f64]);
        }
        numbers.extend(&knots);
        let mut rows = vec![&sections];
        for end in &ends {
            numbers.extend([flag(end.slope.is_some()), flag(end.second.is_some()), flag(end.natural)]);
            rows.extend(end.slope.iter().chain(&end.second));
        }
        numbers.extend(rows.into_iter().flatten().flat_map(DVec3::to_array));
        numbers
    }

    /// The surface that has these numbers ([`Self::numbers`]). What was doubtful about its sections is not among them.
    ///
    /// # Errors
    /// [`NoSurface`] where there are too few or too many, or they make no surface.
    pub fn from_numbers(numbers: &[f64]) -> Result<Self, NoSurface> {
        let mut left = numbers.iter().copied();
        let mut next = || left.next().filter(|number| number.is_finite()).ok_or(NoSurface);
        let count = |number: f64| {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within 0 to MOST")]
            let whole = number as usize;
            if (0.0..=MOST).contains(&number) && number.fract() == 0.0 { Ok(whole) } else { Err(NoSurface) }
        };
        let (closed, polynomial) = (next()? == 1.0, next()? == 1.0);
        let (pieces, sections) = (count(next()?)?, count(next()?)?);
        let mut angles = Angles { pieces: Vec::new(), closed };
        for _ in 0..pieces {
            let (from, to, local) = (next()?, next()?, next()? == 1.0);
            let piece = Piece { from, to, local, lane: angles.lanes(), harmonics: count(next()?)? };
            let follows = angles.pieces.last().is_none_or(|last| (last.to - from).abs() <= 1e-9);
            if !(from < to && follows) {
                return Err(NoSurface);
            }
            angles.pieces.push(piece);
        }
        let knots = (0..sections).map(|_| next()).collect::<Result<Vec<_>, _>>()?;
        let rising = knots.windows(2).all(|pair| pair[0] < pair[1]);
        if pieces == 0 || sections < 2 || !rising || knots[0] != 0.0 || knots[sections - 1] != 1.0 {
            return Err(NoSurface);
        }
        let flags =
            [[next()?, next()?, next()?], [next()?, next()?, next()?]].map(|three| three.map(|flag| flag == 1.0));
        let lanes = angles.lanes();
        let rest: Vec<f64> = left.collect();
        let (points, []) = rest.as_chunks::<3>() else { return Err(NoSurface) };
        let points: Vec<DVec3> = points.iter().map(|point| DVec3::from_array(*point)).collect();
        let given: usize = flags.iter().map(|[slope, second, _]| usize::from(*slope) + usize::from(*second)).sum();
        let wanted = lanes.checked_mul(sections + given).ok_or(NoSurface)?;
        if points.len() != wanted || !points.iter().all(|point| point.is_finite()) {
            return Err(NoSurface);
        }
        let (of_sections, mut others) = points.split_at(lanes * sections);
        let mut row = |wanted: bool| {
            wanted.then(|| {
                let (row, rest) = others.split_at(lanes);
                others = rest;
                row.to_vec()
            })
        };
        let ends = flags.map(|[slope, second, natural]| EndRows { slope: row(slope), second: row(second), natural });
        let plan = Plan { angles, sections: of_sections.to_vec(), knots, ends, polynomial, warnings: Vec::new() };
        Self::solved(plan).map_err(|_| NoSurface)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::analytic::{Blend, EndCondition, SurfaceOptions};
    use crate::trigonometric::{EllipticSection, EllipticSegment, PlaneFrame, Series};
    use std::f64::consts::TAU;

    fn ellipses(count: usize, local: bool) -> Vec<EllipticSection> {
        let ellipse = |k: usize| {
            let height = DVec3::Z * k as f64;
            let size = 1.0 + 0.1 * (k * k) as f64;
            let series = Series::new(vec![height, DVec3::X * size, DVec3::Y]).unwrap();
            let segment = |from: f64, to: f64| EllipticSegment { from, to, local, series: series.clone() };
            let segments =
                if local { vec![segment(0.0, TAU / 2.0), segment(TAU / 2.0, TAU)] } else { vec![segment(0.0, TAU)] };
            EllipticSection::new(PlaneFrame::new(height, DVec3::Z), true, segments).unwrap()
        };
        (0..count).map(ellipse).collect()
    }

    #[test]
    fn a_surface_comes_back_from_its_numbers() {
        let first = AnalyticSurface::through(&ellipses(4, false), &SurfaceOptions::default()).unwrap();
        for blend in [Blend::Polynomial, Blend::Spline] {
            for (start, local) in [(EndCondition::Natural, true), (EndCondition::Free, false)] {
                let options = SurfaceOptions { blend, start, ..SurfaceOptions::default() };
                let surface = AnalyticSurface::through(&ellipses(5, local), &options).unwrap();
                assert_eq!(AnalyticSurface::from_numbers(&surface.numbers()), Ok(surface));
            }
        }
        let moved: Vec<EllipticSection> = ellipses(5, false)[3..].to_vec();
        let after =
            EndCondition::Neighbour { surface: first, continuity: crate::surface::analytic::Continuity::Curvature };
        let surface =
            AnalyticSurface::through(&moved, &SurfaceOptions { start: after, ..SurfaceOptions::default() }).unwrap();
        assert_eq!(AnalyticSurface::from_numbers(&surface.numbers()), Ok(surface));
    }

    #[test]
    fn other_numbers_are_refused() {
        let surface = AnalyticSurface::through(&ellipses(4, false), &SurfaceOptions::default()).unwrap();
        let numbers = surface.numbers();
        for length in 0..numbers.len() {
            assert_eq!(AnalyticSurface::from_numbers(&numbers[..length]), Err(NoSurface), "{length}");
        }
        for place in 0..numbers.len() {
            for bad in [f64::NAN, f64::INFINITY, -1.0, 0.5, 1e6, 1e300] {
                let mut numbers = numbers.clone();
                numbers[place] = bad;
                // Some are other surfaces; none may panic.
                drop(AnalyticSurface::from_numbers(&numbers));
            }
        }
    }
}
