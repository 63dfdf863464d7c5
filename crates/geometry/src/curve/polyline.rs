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
