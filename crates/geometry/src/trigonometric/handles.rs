//! Sections pulled by handles.

use super::section::{EllipticSection, EllipticSegment};
use super::series::{Series, SeriesError, harmonics};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Most handles of a section.
pub const MOST_HANDLES: usize = 200;

/// Why handles do not pull a section.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HandlesError {
    /// Too few or too many.
    #[error("{found} handles given: a section takes {least} to {MOST_HANDLES}")]
    Count {
        /// Handles found.
        found: usize,
        /// Fewest.
        least: usize,
    },
    /// Segments that count angles of their own.
    #[error(
        "segment {segment} of the section counts an angle of its own, in which handles have no series: fit it without \
         local angles, or draw the section anew"
    )]
    LocalAngle {
        /// Index of the segment, counted from 0.
        segment: usize,
    },
    /// Handles beyond all numbers.
    #[error("the handles give no finite section: {0}")]
    NotFinite(#[from] SeriesError),
}

impl EllipticSection {
    /// The section pulled so that it passes through `handles`: those of [`EllipticSection::sampled`] with their number,
    /// at equal steps of the angle, moved. Exact: the offsets of the handles are interpolated by the series with the
    /// fewest harmonics (about half their number; of cosines alone in an open section), which is added to every segment,
    /// so that joints stay as smooth as they are.
    ///
    /// # Errors
    /// [`HandlesError`] where there are fewer than 3 handles (2 of an open section) or more than [`MOST_HANDLES`], or a
    /// segment has a local angle.
    pub fn with_handles(&self, handles: &[DVec3]) -> Result<Self, HandlesError> {
        let (count, least) = (handles.len(), if self.is_closed() { 3 } else { 2 });
        if !(least..=MOST_HANDLES).contains(&count) {
            return Err(HandlesError::Count { found: count, least });
        }
        if let Some(segment) = self.segments().iter().position(|segment| segment.local) {
            return Err(HandlesError::LocalAngle { segment });
        }
        let offsets: Vec<DVec3> = handles.iter().zip(self.sampled(count)).map(|(to, from)| *to - from).collect();
        let offset = if self.is_closed() {
            // Counted from the first handle; `started_at` brings it to the section's angle.
            Series::new(around(&offsets))?.started_at(-self.range().0)
        } else {
            Series::new(along(&offsets))?
        };
        let pulled = |segment: &EllipticSegment| {
            let own = segment.series.clone().padded(offset.harmonics());
            let added = offset.clone().padded(own.harmonics());
            let sum = own.coefficients().iter().zip(added.coefficients()).map(|(a, b)| *a + *b).collect();
            Ok(EllipticSegment { series: Series::new(sum)?, ..segment.clone() })
        };
        let segments = self.segments().iter().map(pulled).collect::<Result<Vec<_>, HandlesError>>()?;
        Ok(self.with_series(segments.into_iter().map(|segment| segment.series)))
    }
}

/// Coefficients of the series through values at equal steps of a turn.
fn around(values: &[DVec3]) -> Vec<DVec3> {
    let count = values.len();
    let most = count / 2;
    let mut coefficients = vec![DVec3::ZERO; 2 * most + 1];
    for (k, value) in values.iter().enumerate() {
        coefficients[0] += *value / count as f64;
        let angle = TAU * k as f64 / count as f64;
        for (j, (cos, sin)) in (1..=most).zip(harmonics(angle)) {
            // At half the number of values cosines alternate and sines vanish.
            let share = if 2 * j == count { 1.0 } else { 2.0 } / count as f64;
            coefficients[2 * j - 1] += share * cos * *value;
            if 2 * j != count {
                coefficients[2 * j] += share * sin * *value;
            }
        }
    }
    coefficients
}

/// Coefficients of the cosines through values at equal steps from 0 to pi.
fn along(values: &[DVec3]) -> Vec<DVec3> {
    let last = values.len() - 1;
    let mut coefficients = vec![DVec3::ZERO; 2 * last + 1];
    for (k, value) in values.iter().enumerate() {
        let weight = if k == 0 || k == last { 0.5 } else { 1.0 } / last as f64;
        coefficients[0] += weight * *value;
        for (j, (cos, _)) in (1..=last).zip(harmonics(PI * k as f64 / last as f64)) {
            let share = if j == last { 1.0 } else { 2.0 };
            coefficients[2 * j - 1] += share * weight * cos * *value;
        }
    }
    coefficients
}

#[cfg(test)]
mod tests {
    use super::super::{Continuity, FitOptions, Harmonics, Joint, LocalAngles, PlaneFrame, Split, fit};
    use super::*;
    use crate::curve::Curve;

    fn section(closed: bool, from: f64) -> EllipticSection {
        let series = Series::new(vec![DVec3::ONE, DVec3::X * 2.0, DVec3::Y, DVec3::Z * 0.2, DVec3::X * 0.1]).unwrap();
        let segment = EllipticSegment { from, to: from + if closed { TAU } else { PI }, local: false, series };
        EllipticSection::new(PlaneFrame::new(DVec3::ONE, DVec3::Z), closed, vec![segment]).unwrap()
    }

    #[test]
    fn the_section_goes_through_its_handles() {
        for (closed, from) in [(true, 0.0), (true, 1.3), (false, 0.0)] {
            let section = section(closed, from);
            for count in 3..12 {
                let bent = |(k, p): (usize, DVec3)| p + DVec3::new((k as f64).sin(), 0.3 * (k * k) as f64, 0.1);
                let handles: Vec<DVec3> = section.sampled(count).into_iter().enumerate().map(bent).collect();
                let pulled = section.with_handles(&handles).unwrap();
                for (wanted, found) in handles.iter().zip(pulled.sampled(count)) {
                    assert!(wanted.distance(found) < 1e-11, "{closed} {from} {count}");
                }
                assert!(pulled.harmonics() <= 2.max(if closed { count / 2 } else { count - 1 }));
            }
            // Handles that stay where they are change nothing.
            let same = section.with_handles(&section.sampled(9)).unwrap();
            assert!((0..50).all(|k| same.point(f64::from(k)).distance(section.point(f64::from(k))) < 1e-13));
        }
    }

    #[test]
    fn joints_stay_as_they_are() {
        let square = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
        let square = Curve::new("square", square.to_vec(), true).unwrap();
        let joints = [0.25 * PI, 0.75 * PI].map(|angle| Joint { angle, continuity: Continuity::C0 }).to_vec();
        let options = FitOptions {
            split: Split::At(joints),
            harmonics: Harmonics::Fixed(3),
            local_angles: LocalAngles::Never,
            ..FitOptions::default()
        };
        let section = fit(&square, &options).unwrap().section;
        let mut handles = section.sampled(8);
        handles[2] += DVec3::X * 0.3;
        let pulled = section.with_handles(&handles).unwrap();
        assert_eq!(pulled.joints(), section.joints());
        let before = |s: &EllipticSection| s.segments()[1].derivatives::<1>(s.joints()[0] + TAU)[0];
        assert!(before(&pulled).distance(pulled.point(section.joints()[0])) < 1e-9);
        let local = fit(&square, &FitOptions { local_angles: LocalAngles::Always, ..options }).unwrap().section;
        assert_eq!(local.with_handles(&handles), Err(HandlesError::LocalAngle { segment: 0 }));
        for count in [0, 2, 201] {
            let error = section.with_handles(&vec![DVec3::ZERO; count]).unwrap_err();
            assert_eq!(error, HandlesError::Count { found: count, least: 3 });
        }
    }
}
