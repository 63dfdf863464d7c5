//! A cross-section as one or several series end to end.

use super::plane_frame::PlaneFrame;
use super::series::{Series, SeriesError};
use glam::{DAffine3, DVec3};
use std::f64::consts::{PI, TAU};

/// A generalized elliptic segment: a series over a range of the section's angle.
#[derive(Clone, Debug, PartialEq)]
pub struct EllipticSegment {
    /// Angle where it begins, radians.
    pub from: f64,
    /// Angle where it ends, radians; more than `from`.
    pub to: f64,
    /// Whether the series counts its own angle `w = pi (v - from) / (to - from)` instead of the section's angle v.
    ///
    /// Over a small part of the turn the functions cos jv, sin jv are nearly dependent; over half a turn of their own
    /// angle they are less so.
    pub local: bool,
    /// The series, of v or of w.
    pub series: Series,
}

impl EllipticSegment {
    /// The angle of the series at the section's angle `v`.
    pub fn series_angle(&self, v: f64) -> f64 {
        if self.local { (v - self.from) * self.rate() } else { v }
    }

    /// Change of the angle of the series with the section's angle.
    pub fn rate(&self) -> f64 {
        if self.local { PI / (self.to - self.from) } else { 1.0 }
    }

    /// The value and the first `N - 1` derivatives with respect to the section's angle, at `v`; beyond its range it is
    /// continued.
    pub fn derivatives<const N: usize>(&self, v: f64) -> [DVec3; N] {
        let mut found = self.series.derivatives::<N>(self.series_angle(v));
        let mut scale = 1.0;
        for derivative in &mut found {
            *derivative *= scale;
            scale *= self.rate();
        }
        found
    }
}

/// A cross-section as a curve: a generalized ellipse (one segment), or composite generalized elliptic segments
/// (thesis 3.1, 3.2).
///
/// A closed section is parametrised by `v` modulo 2 pi, an open one by `v` from 0 to pi. Invariants, kept by the
/// constructor: at least one segment, each with `from < to`, one beginning where the last ended; together they make a
/// whole turn, or 0 to pi.
#[derive(Clone, Debug, PartialEq)]
pub struct EllipticSection {
    frame: PlaneFrame,
    closed: bool,
    segments: Vec<EllipticSegment>,
}

/// Why segments do not make a section.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SectionError {
    /// No segment at all.
    #[error("a section needs at least one segment")]
    Empty,
    /// A segment without extent, or one that does not begin where the one before ends.
    #[error("segment {segment} reaches from {from} to {to}: it must begin where the last one ends and have an extent")]
    Range {
        /// Index of the segment, counted from 0.
        segment: usize,
        /// Its first angle, radians.
        from: f64,
        /// Its last angle, radians.
        to: f64,
    },
    /// Segments that do not make a whole turn, or the range 0 to pi.
    #[error(
        "the segments reach from {from} to {to}: a closed section makes a turn of 2 pi, an open one goes from 0 to pi"
    )]
    Extent {
        /// First angle, radians.
        from: f64,
        /// Last angle, radians.
        to: f64,
    },
}

/// How far the ends of segments may be from one another and from the ends of the range, radians.
const SAME_ANGLE: f64 = 1e-9;

impl EllipticSection {
    /// Makes a section from segments in order of angle.
    ///
    /// # Errors
    /// [`SectionError`] where their ranges do not fit together.
    pub fn new(frame: PlaneFrame, closed: bool, segments: Vec<EllipticSegment>) -> Result<Self, SectionError> {
        let (Some(first), Some(last)) = (segments.first(), segments.last()) else { return Err(SectionError::Empty) };
        let (from, to) = (first.from, last.to);
        let mut before = from;
        for (segment, EllipticSegment { from, to, .. }) in segments.iter().enumerate() {
            let ordered = from.is_finite() && to.is_finite() && from < to;
            if !ordered || (from - before).abs() > SAME_ANGLE {
                return Err(SectionError::Range { segment, from: *from, to: *to });
            }
            before = *to;
        }
        let fits = if closed { (to - from - TAU).abs() } else { from.abs().max((to - PI).abs()) };
        if fits > SAME_ANGLE {
            return Err(SectionError::Extent { from, to });
        }
        Ok(Self { frame, closed, segments })
    }

    /// The ellipse about the frame's origin with these half axes along `e1` and `e2`, metres: exact with one harmonic,
    /// `origin + e1 a cos v + e2 b sin v`. Two zeros give a point.
    ///
    /// # Errors
    /// [`SeriesError::NotFinite`] where a number is not finite.
    pub fn ellipse(frame: PlaneFrame, [a, b]: [f64; 2]) -> Result<Self, SeriesError> {
        let series = Series::new(vec![frame.origin, frame.e1 * a, frame.e2 * b])?;
        Ok(Self { frame, closed: true, segments: vec![EllipticSegment { from: 0.0, to: TAU, local: false, series }] })
    }

    /// The plane it was fitted in: origin at the mean of the samples, `e1` at angle 0 of polar angles.
    pub fn frame(&self) -> &PlaneFrame {
        &self.frame
    }

    /// Whether it is a loop.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Its segments in order of angle; one for a generalized ellipse.
    pub fn segments(&self) -> &[EllipticSegment] {
        &self.segments
    }

    /// First and last angle, radians: 0 and pi for an open section, 2 pi apart for a closed one.
    pub fn range(&self) -> (f64, f64) {
        (self.segments[0].from, self.segments[self.segments.len() - 1].to)
    }

    /// Angles at which segments meet, ascending; for a composite closed section the first is where the turn begins and
    /// ends.
    pub fn joints(&self) -> Vec<f64> {
        let skipped = usize::from(!self.closed || self.segments.len() == 1);
        self.segments.iter().skip(skipped).map(|segment| segment.from).collect()
    }

    /// Most harmonics of any segment.
    pub fn harmonics(&self) -> usize {
        self.segments.iter().map(|segment| segment.series.harmonics()).max().unwrap_or(0)
    }

    /// Stored constants, counted as the thesis does for a surface (4.1): `3 (2J+1)` a segment. A planar section has a
    /// third less in a frame of its own.
    pub fn constants(&self) -> usize {
        self.segments.iter().map(|segment| 3 * segment.series.coefficients().len()).sum()
    }

    /// The segment at angle `v` and the angle within its range: wrapped around a closed section, clamped to an open
    /// one. At a joint it is the segment that begins there.
    pub fn locate(&self, v: f64) -> (&EllipticSegment, f64) {
        let (from, to) = self.range();
        let v =
            if self.closed && !(from..to).contains(&v) { from + (v - from).rem_euclid(TAU) } else { v.clamp(from, to) };
        let v = if v.is_nan() { from } else { v };
        let index = self.segments.partition_point(|segment| segment.from <= v).saturating_sub(1);
        (&self.segments[index], v)
    }

    /// The value and the first `N - 1` derivatives with respect to `v`.
    pub fn derivatives<const N: usize>(&self, v: f64) -> [DVec3; N] {
        let (segment, v) = self.locate(v);
        segment.derivatives(v)
    }

    /// The point at angle `v`, metres.
    pub fn point(&self, v: f64) -> DVec3 {
        self.derivatives::<1>(v)[0]
    }

    /// Unit tangent at angle `v`, in the direction of growing `v`; zero where the curve stands still.
    pub fn tangent(&self, v: f64) -> DVec3 {
        self.derivatives::<2>(v)[1].normalize_or_zero()
    }

    /// Unit normal in the plane of the frame at angle `v`, to the right of the tangent: outward where a closed section
    /// runs counter-clockwise. Zero where the curve stands still or runs along the frame's normal.
    pub fn normal(&self, v: f64) -> DVec3 {
        self.derivatives::<2>(v)[1].cross(self.frame.normal).normalize_or_zero()
    }

    /// Curvature at angle `v`, 1/m: positive where the curve turns left about the frame's normal. Not finite where the
    /// curve stands still.
    pub fn curvature(&self, v: f64) -> f64 {
        let [_, speed, acceleration] = self.derivatives::<3>(v);
        let turn = speed.cross(acceleration);
        turn.length().copysign(turn.dot(self.frame.normal)) / speed.length().powi(3)
    }

    /// The section mapped by an affine map; the frame is the one the map gives, made orthonormal again.
    ///
    /// # Errors
    /// [`SeriesError::NotFinite`] where the map takes a coefficient out of the numbers.
    pub fn transformed(&self, map: &DAffine3) -> Result<Self, SeriesError> {
        let (e1, e2) = (map.transform_vector3(self.frame.e1), map.transform_vector3(self.frame.e2));
        let normal = e1.cross(e2).try_normalize().unwrap_or(self.frame.normal);
        let e1 = e1.try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector());
        let frame = PlaneFrame { origin: map.transform_point3(self.frame.origin), e1, e2: normal.cross(e1), normal };
        let segments = self
            .segments
            .iter()
            .map(|segment| Ok(EllipticSegment { series: segment.series.transformed(map)?, ..segment.clone() }))
            .collect::<Result<_, SeriesError>>()?;
        Ok(Self { frame, closed: self.closed, segments })
    }

    /// The same frame and ranges with other series, one a segment.
    pub(super) fn with_series(&self, series: impl Iterator<Item = super::Series>) -> Self {
        let segments =
            self.segments.iter().zip(series).map(|(segment, series)| EllipticSegment { series, ..segment.clone() });
        Self { frame: self.frame, closed: self.closed, segments: segments.collect() }
    }

    /// The same curve with at least `harmonics[i]` harmonics in segment `i`; segments beyond the list stay as they are.
    #[must_use]
    pub fn padded(mut self, harmonics: &[usize]) -> Self {
        for (segment, harmonics) in self.segments.iter_mut().zip(harmonics) {
            segment.series = segment.series.clone().padded(*harmonics);
        }
        self
    }

    /// `count` points at equal steps of `v` from the first angle: up to the last for an open section, one step short of
    /// it for a closed one.
    pub fn sampled(&self, count: usize) -> Vec<DVec3> {
        let (from, to) = self.range();
        let steps = if self.closed { count } else { count.saturating_sub(1) }.max(1);
        (0..count).map(|i| self.point(from + (to - from) * i as f64 / steps as f64)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    pub(super) fn ellipse(a: f64, b: f64) -> EllipticSection {
        EllipticSection::ellipse(PlaneFrame::new(DVec3::ZERO, DVec3::Z), [a, b]).unwrap()
    }

    #[test]
    fn tangent_normal_and_curvature_of_an_ellipse() {
        let section = ellipse(3.0, 2.0);
        assert_eq!((section.tangent(0.0), section.normal(0.0)), (DVec3::Y, DVec3::X));
        assert!((section.curvature(0.0) - 3.0 / 4.0).abs() < 1e-14);
        assert!((section.curvature(PI / 2.0) - 2.0 / 9.0).abs() < 1e-14);
        assert!((section.curvature(7.0 * PI / 2.0) - 2.0 / 9.0).abs() < 1e-13);
        assert_eq!(section.point(-0.3), section.point(TAU - 0.3));
        assert_eq!((section.constants(), section.harmonics(), section.joints()), (9, 1, vec![]));
    }

    #[test]
    fn a_local_angle_gives_the_same_derivatives() {
        // Half a circle as cos w, sin w over any range.
        let series = Series::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y]).unwrap();
        let segment = EllipticSegment { from: 1.0, to: 1.5, local: true, series };
        let h = 1e-5;
        let [point, speed, acceleration] = segment.derivatives::<3>(1.2);
        let [after, before] = [1.2 + h, 1.2 - h].map(|v| segment.derivatives::<2>(v));
        assert!(((after[0] - before[0]) / (2.0 * h)).distance(speed) < 1e-7);
        assert!(((after[1] - before[1]) / (2.0 * h)).distance(acceleration) < 1e-6);
        assert!(segment.derivatives::<1>(1.25)[0].distance(DVec3::Y) < 1e-15);
        assert!((point.length() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn open_sections_are_clamped_and_segments_found() {
        let line = |from: f64, to: f64, x: f64| EllipticSegment {
            from,
            to,
            local: true,
            series: Series::new(vec![DVec3::X * x, DVec3::X * -0.5, DVec3::ZERO]).unwrap(),
        };
        let frame = PlaneFrame::new(DVec3::ZERO, DVec3::Z);
        let section = EllipticSection::new(frame, false, vec![line(0.0, 1.0, 0.5), line(1.0, PI, 1.5)]).unwrap();
        assert_eq!(section.joints(), vec![1.0]);
        assert_eq!(section.locate(1.0).0.from, 1.0);
        assert_eq!((section.point(-5.0), section.point(f64::NAN)), (DVec3::ZERO, DVec3::ZERO));
        assert!(section.point(f64::INFINITY).distance(DVec3::X * 2.0) < 1e-15);
        let sampled = section.sampled(5);
        assert_eq!((sampled.len(), sampled[0]), (5, DVec3::ZERO));
        assert!(sampled[4].distance(DVec3::X * 2.0) < 1e-15);
        assert!(ellipse(1.0, 1.0).point(f64::INFINITY).is_finite());
    }

    #[test]
    fn segments_that_do_not_fit_are_refused() {
        let frame = PlaneFrame::new(DVec3::ZERO, DVec3::Z);
        let point = Series::new(vec![DVec3::ZERO]).unwrap();
        let new = |ranges: &[(f64, f64)], closed| {
            let segments = ranges.iter().map(|(from, to)| EllipticSegment {
                from: *from,
                to: *to,
                local: false,
                series: point.clone(),
            });
            EllipticSection::new(frame, closed, segments.collect())
        };
        assert_eq!(new(&[], true), Err(SectionError::Empty));
        assert!(matches!(new(&[(0.0, PI), (PI, PI)], true), Err(SectionError::Range { segment: 1, .. })));
        assert!(matches!(new(&[(0.0, 1.0), (2.0, TAU)], true), Err(SectionError::Range { segment: 1, .. })));
        assert!(matches!(new(&[(0.0, f64::NAN)], true), Err(SectionError::Range { .. })));
        assert!(matches!(new(&[(0.0, PI)], true), Err(SectionError::Extent { .. })));
        assert!(matches!(new(&[(0.5, PI)], false), Err(SectionError::Extent { .. })));
        assert!(new(&[(-1.0, 2.0), (2.0, TAU - 1.0)], true).is_ok());
    }

    #[test]
    fn maps_keep_a_frame_of_the_plane() {
        let map = DAffine3::from_scale_rotation_translation(
            DVec3::new(2.0, 3.0, 0.5),
            DQuat::from_rotation_x(1.0),
            DVec3::ONE,
        );
        let moved = ellipse(3.0, 2.0).transformed(&map).unwrap();
        let frame = moved.frame();
        assert!(frame.flatness(&moved.sampled(20)) < 1e-14);
        assert!(frame.e1.cross(frame.e2).distance(frame.normal) < 1e-15);
        assert!(moved.point(0.7).distance(map.transform_point3(ellipse(3.0, 2.0).point(0.7))) < 1e-14);
        assert_eq!(moved.clone().padded(&[4]).harmonics(), 4);
    }
}
