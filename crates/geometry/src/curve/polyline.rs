//! A curve as a chain of points in space.

use glam::DVec3;

/// A named polyline in metres. Open, or closed with the first point *not* repeated at the end.
///
/// Invariants, kept by the constructor: at least two points, every coordinate finite, a length greater than zero,
/// and one pressure a point where there is pressure.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    name: String,
    points: Vec<DVec3>,
    closed: bool,
    pressure: Option<Vec<f64>>,
}

/// Why points do not make a curve.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CurveError {
    /// Fewer points than a curve needs.
    #[error("curve \"{name}\" has {found} distinct point(s), and a curve needs at least {needed}: draw it longer")]
    TooFewPoints {
        /// Name of the curve.
        name: String,
        /// Distinct points found.
        found: usize,
        /// Points needed.
        needed: usize,
    },
    /// A coordinate that is not a number or is infinite.
    #[error("curve \"{name}\", point {index}: a coordinate is not a finite number")]
    NotFinite {
        /// Name of the curve.
        name: String,
        /// Index of the point, counted from 0.
        index: usize,
    },
    /// A pressure list that does not match the points.
    #[error("curve \"{name}\" has {points} points but {pressures} pressures: give one a point, or none at all")]
    PressureCount {
        /// Name of the curve.
        name: String,
        /// Number of points.
        points: usize,
        /// Number of pressures.
        pressures: usize,
    },
}

impl Curve {
    /// Makes a curve from points, dropping a last point that repeats the first one of a closed curve and points that
    /// repeat their predecessor exactly.
    ///
    /// # Errors
    /// [`CurveError`] where a coordinate is not finite, fewer than two distinct points (three for a closed curve) are
    /// left.
    pub fn new(name: impl Into<String>, points: Vec<DVec3>, closed: bool) -> Result<Self, CurveError> {
        Self::with_pressure(name, points, closed, None)
    }

    /// Like [`Curve::new`], with the pen's pressure at each point.
    ///
    /// # Errors
    /// As [`Curve::new`], and where the number of pressures is not the number of points.
    pub fn with_pressure(
        name: impl Into<String>,
        mut points: Vec<DVec3>,
        closed: bool,
        mut pressure: Option<Vec<f64>>,
    ) -> Result<Self, CurveError> {
        let name = name.into();
        if let Some(pressure) = &pressure {
            if pressure.len() != points.len() {
                return Err(CurveError::PressureCount { name, points: points.len(), pressures: pressure.len() });
            }
            if let Some(index) = pressure.iter().position(|p| !p.is_finite()) {
                return Err(CurveError::NotFinite { name, index });
            }
        }
        if let Some(index) = points.iter().position(|p| !p.is_finite()) {
            return Err(CurveError::NotFinite { name, index });
        }
        if points.windows(2).any(|pair| pair[0] == pair[1]) {
            let keep: Vec<bool> = (0..points.len()).map(|i| i == 0 || points[i] != points[i - 1]).collect();
            let mut flags = keep.iter();
            points.retain(|_| flags.next().copied().unwrap_or(true));
            if let Some(pressure) = &mut pressure {
                let mut flags = keep.iter();
                pressure.retain(|_| flags.next().copied().unwrap_or(true));
            }
        }
        if closed && points.len() > 1 && points.first() == points.last() {
            points.pop();
            if let Some(pressure) = &mut pressure {
                pressure.pop();
            }
        }
        let needed = if closed { 3 } else { 2 };
        if points.len() < needed {
            return Err(CurveError::TooFewPoints { name, found: points.len(), needed });
        }
        Ok(Self { name, points, closed, pressure })
    }

    /// The name the artist gave it; may be empty.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The points in order, metres.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// Whether the last point joins the first.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Pen pressure at each point, where it was recorded.
    pub fn pressure(&self) -> Option<&[f64]> {
        self.pressure.as_deref()
    }

    /// Number of straight segments: one for each point of a closed curve, one less for an open one.
    pub fn segment_count(&self) -> usize {
        self.points.len() - usize::from(!self.closed)
    }

    /// Both ends of segment `index`, counted from 0; indices wrap around.
    pub fn segment(&self, index: usize) -> (DVec3, DVec3) {
        let count = self.points.len();
        (self.points[index % count], self.points[(index % count + 1) % count])
    }

    /// First point.
    pub fn start(&self) -> DVec3 {
        self.points[0]
    }

    /// Last point; of a closed curve the one before the first.
    pub fn end(&self) -> DVec3 {
        self.points[self.points.len() - 1]
    }

    /// Lowest and highest corner of the box around the points.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        self.points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), p| (l.min(*p), h.max(*p)))
    }

    /// Newell's area vector of the polygon through the points, square metres: its direction is the normal about which
    /// they run counter-clockwise, its length the area where they lie in a plane. It does not depend on the first point.
    pub fn area_vector(&self) -> DVec3 {
        let origin = self.points[0];
        self.points.windows(2).map(|pair| (pair[0] - origin).cross(pair[1] - origin)).sum::<DVec3>() / 2.0
    }

    /// The same curve under another name.
    #[must_use]
    pub fn renamed(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }

    /// The same curve run the other way. A closed curve keeps its first point.
    #[must_use]
    pub fn reversed(mut self) -> Self {
        let start = usize::from(self.closed);
        self.points[start..].reverse();
        if let Some(pressure) = &mut self.pressure {
            pressure[start..].reverse();
        }
        self
    }

    /// The curve with every point mapped by `f`.
    ///
    /// # Errors
    /// As [`Curve::new`]: the map may give points that are not finite, or that coincide.
    pub fn map(&self, f: impl Fn(DVec3) -> DVec3) -> Result<Self, CurveError> {
        Self::with_pressure(
            self.name.clone(),
            self.points.iter().map(|p| f(*p)).collect(),
            self.closed,
            self.pressure.clone(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Vec<DVec3> {
        vec![DVec3::ZERO, DVec3::X * 2.0, DVec3::new(2.0, 2.0, 0.0), DVec3::Y * 2.0]
    }

    #[test]
    fn repeated_points_are_dropped_with_their_pressure() {
        let mut points = square();
        points.insert(1, points[0]);
        points.push(points[0]);
        let curve = Curve::with_pressure("s", points, true, Some(vec![0.0, 9.0, 1.0, 2.0, 3.0, 9.0])).unwrap();
        assert_eq!(curve.points(), square());
        assert_eq!(curve.pressure(), Some(&[0.0, 1.0, 2.0, 3.0][..]));
    }

    #[test]
    fn malformed_curves_are_refused() {
        let refused =
            |points: Vec<DVec3>, closed, pressure| Curve::with_pressure("c", points, closed, pressure).unwrap_err();
        let name = || "c".to_owned();
        assert_eq!(
            refused(vec![DVec3::X; 3], false, None),
            CurveError::TooFewPoints { name: name(), found: 1, needed: 2 }
        );
        assert_eq!(
            refused(vec![DVec3::X, DVec3::Y, DVec3::X], true, None),
            CurveError::TooFewPoints { name: name(), found: 2, needed: 3 }
        );
        assert_eq!(refused(vec![DVec3::X, DVec3::NAN], false, None), CurveError::NotFinite { name: name(), index: 1 });
        let pressures = Some(vec![1.0, f64::INFINITY]);
        assert_eq!(
            refused(vec![DVec3::X, DVec3::Y], false, pressures),
            CurveError::NotFinite { name: name(), index: 1 }
        );
        assert_eq!(
            refused(vec![DVec3::X, DVec3::Y], false, Some(vec![1.0])),
            CurveError::PressureCount { name: name(), points: 2, pressures: 1 }
        );
        assert!(Curve::new("c", vec![], true).is_err());
    }

    #[test]
    fn segments_bounds_and_area() {
        let closed = Curve::new("s", square(), true).unwrap();
        let open = Curve::new("s", square(), false).unwrap();
        assert_eq!((closed.segment_count(), open.segment_count()), (4, 3));
        assert_eq!(closed.segment(3), (closed.end(), closed.start()));
        assert_eq!(closed.bounds(), (DVec3::ZERO, DVec3::new(2.0, 2.0, 0.0)));
        assert_eq!(closed.area_vector(), DVec3::Z * 4.0);
        assert_eq!(closed.reversed().area_vector(), DVec3::Z * -4.0);
    }
}
