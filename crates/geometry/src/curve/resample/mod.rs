//! Points at equal arc length along a curve (thesis 6.4, paper 4.2).

mod share;
mod stretch;

use super::{Curve, CurveError};
use share::{by_count, by_spacing};
use stretch::Stretches;

/// Most points a resampled curve may have.
pub const MAX_POINTS: usize = 65_536;

/// How many points to place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Amount {
    /// This many points; on an open curve both ends count.
    Count(usize),
    /// Points this far apart, metres. Each stretch between kept corners gets the nearest whole number of intervals, at
    /// least one (a closed curve at least three), so that the real spacing is between 3/4 and 3/2 of this one, and
    /// shorter only where a whole stretch is.
    Spacing(f64),
}

/// How a curve is resampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resampling {
    /// How many points.
    pub amount: Amount,
    /// Whether a C2 spline is laid through the points first, so that a stroke of a few points becomes a smooth curve;
    /// otherwise the new points lie on the straight segments.
    pub smooth: bool,
    /// Points at which the curve turns by more than this angle (radians, 0 to pi) stay exactly where they are, and
    /// the spline may bend sharply there. None keeps no corner.
    pub corner_angle: Option<f64>,
}

impl Resampling {
    /// `count` points along the straight segments, no corner kept.
    pub fn count(count: usize) -> Self {
        Self { amount: Amount::Count(count), smooth: false, corner_angle: None }
    }

    /// Points about `metres` apart along the straight segments, no corner kept.
    pub fn spacing(metres: f64) -> Self {
        Self { amount: Amount::Spacing(metres), smooth: false, corner_angle: None }
    }

    /// The same, along a smooth curve through the points.
    #[must_use]
    pub fn smooth(self) -> Self {
        Self { smooth: true, ..self }
    }

    /// The same, keeping corners that turn by more than `angle` radians.
    #[must_use]
    pub fn keeping_corners(self, angle: f64) -> Self {
        Self { corner_angle: Some(angle), ..self }
    }
}

/// Answers whether to go on.
type GoOn<'a> = dyn Fn() -> Result<(), ResampleError> + 'a;

/// Why a curve cannot be resampled.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ResampleError {
    /// It was told to stop.
    #[error("stopped")]
    Stopped,
    /// Fewer points asked for than a curve has.
    #[error("curve \"{curve}\": {count} point(s) asked for, and it needs at least {needed}: raise the count")]
    CountTooSmall {
        /// Name of the curve.
        curve: String,
        /// Points asked for.
        count: usize,
        /// Points needed.
        needed: usize,
    },
    /// More than [`MAX_POINTS`] points asked for.
    #[error("curve \"{curve}\": {count} points asked for, and 65 536 is the most: lower the count")]
    CountTooLarge {
        /// Name of the curve.
        curve: String,
        /// Points asked for.
        count: usize,
    },
    /// More ends and kept corners than points asked for.
    #[error(
        "curve \"{curve}\": {corners} ends and corners are kept, but only {count} points asked for: raise the count, \
         or the corner angle"
    )]
    TooManyCorners {
        /// Name of the curve.
        curve: String,
        /// Ends and corners that stay.
        corners: usize,
        /// Points asked for.
        count: usize,
    },
    /// A spacing that is not a positive number.
    #[error("curve \"{curve}\": a spacing of {spacing} m is not a positive length")]
    SpacingNotPositive {
        /// Name of the curve.
        curve: String,
        /// The spacing, metres.
        spacing: f64,
    },
    /// A spacing that would give more than [`MAX_POINTS`] points.
    #[error(
        "curve \"{curve}\": a spacing of {spacing} m gives more than 65 536 points on its {length} m: widen the spacing"
    )]
    SpacingTooSmall {
        /// Name of the curve.
        curve: String,
        /// The spacing, metres.
        spacing: f64,
        /// Length of the curve, metres.
        length: f64,
    },
    /// A corner angle that is negative or not finite.
    #[error("curve \"{curve}\": a corner angle of {angle} rad is not an angle from 0 to pi")]
    CornerAngle {
        /// Name of the curve.
        curve: String,
        /// The angle, radians.
        angle: f64,
    },
    /// A curve so small or so large that its length is not a usable number.
    #[error("curve \"{curve}\" is too small or too large to measure ({length} m long): scale it")]
    Unmeasurable {
        /// Name of the curve.
        curve: String,
        /// What its length came to, metres.
        length: f64,
    },
    /// A closed curve that runs back on itself so that neighbouring new points coincide.
    #[error("curve \"{curve}\": new points coincide, for it runs back on itself: ask for another number of points")]
    Coincident {
        /// Name of the curve.
        curve: String,
    },
}

/// Places points at equal arc length along a curve.
///
/// The first point, both ends of an open curve and all kept corners stay exactly. Between them the points are equally
/// spaced; each stretch gets at least one interval, and they are shared out so that the longest spacing is as short as
/// it can be, hence in proportion to length. Pen pressure is interpolated linearly. Points closer than 1e-12 of the
/// curve's length to the one before count as one.
///
/// With `smooth` the curve is a C2 cubic spline by chord length through the points of each stretch between corners
/// (natural at corners and ends, periodic for a closed curve without corners). The new points lie on it to rounding,
/// and their arc lengths are right to 1e-9 of its length.
///
/// # Errors
/// [`ResampleError`] where the amount or the angle is out of range, or the curve cannot be measured.
pub fn resample(curve: &Curve, resampling: &Resampling) -> Result<Curve, ResampleError> {
    resample_while(curve, resampling, &|| true)
}

/// The same, asking `go_on` every 1024 points.
///
/// # Errors
/// As [`resample`], and [`ResampleError::Stopped`] where `go_on` answers `false`.
pub fn resample_while(
    curve: &Curve,
    resampling: &Resampling,
    go_on: &dyn Fn() -> bool,
) -> Result<Curve, ResampleError> {
    let asked = || if go_on() { Ok(()) } else { Err(ResampleError::Stopped) };
    let name = || curve.name().to_owned();
    let closed = curve.is_closed();
    if let Some(angle) = resampling.corner_angle.filter(|angle| !angle.is_finite() || *angle < 0.0) {
        return Err(ResampleError::CornerAngle { curve: name(), angle });
    }
    match resampling.amount {
        Amount::Count(count) if count > MAX_POINTS => {
            return Err(ResampleError::CountTooLarge { curve: name(), count });
        }
        Amount::Count(count) if count < if closed { 3 } else { 2 } => {
            return Err(ResampleError::CountTooSmall { curve: name(), count, needed: if closed { 3 } else { 2 } });
        }
        Amount::Spacing(spacing) if !spacing.is_finite() || spacing <= 0.0 => {
            return Err(ResampleError::SpacingNotPositive { curve: name(), spacing });
        }
        _ => {}
    }
    let stretches = Stretches::of(curve, resampling, &asked)?
        .ok_or_else(|| ResampleError::Unmeasurable { curve: name(), length: super::ArcLength::of(curve).length() })?;
    let lengths = stretches.lengths();
    let ends = usize::from(!closed);
    let intervals = match resampling.amount {
        Amount::Count(count) => by_count(&lengths, count - ends).ok_or_else(|| ResampleError::TooManyCorners {
            curve: name(),
            corners: lengths.len() + ends,
            count,
        })?,
        Amount::Spacing(spacing) => by_spacing(&lengths, spacing, MAX_POINTS - ends, if closed { 3 } else { 1 })
            .ok_or_else(|| ResampleError::SpacingTooSmall { curve: name(), spacing, length: lengths.iter().sum() })?,
    };

    let total = intervals.iter().sum::<usize>() + ends;
    let mut points = Vec::with_capacity(total);
    let mut pressure = Vec::with_capacity(total);
    for (stretch, intervals) in intervals.into_iter().enumerate() {
        for i in 0..intervals {
            if points.len().is_multiple_of(1024) {
                asked()?;
            }
            let (point, force) = stretches.at(stretch, i as f64 / intervals as f64);
            points.push(point);
            pressure.push(force);
        }
    }
    if !closed {
        points.push(curve.end());
        pressure.push(curve.pressure().map_or(0.0, |p| p[p.len() - 1]));
    }
    let pressure = curve.pressure().map(|_| pressure);
    match Curve::with_pressure(curve.name(), points, closed, pressure) {
        Ok(resampled) if resampled.points().len() == total => Ok(resampled),
        Ok(_) | Err(CurveError::TooFewPoints { .. }) => Err(ResampleError::Coincident { curve: name() }),
        Err(_) => Err(ResampleError::Unmeasurable { curve: name(), length: lengths.iter().sum() }),
    }
}

#[cfg(test)]
mod tests;
