//! Cleaning: several rough strokes over one another become one.

mod fit;
mod group;
mod line;
mod samples;
mod spine;

use super::{Curve, CurveError};
use line::Line;
use samples::Samples;

/// Most points at which strokes are looked at. They are a quarter of the distance apart.
const MAX_SAMPLES: usize = 16_384;

/// How strokes are cleaned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cleaning {
    /// Strokes within this distance of one another may be the same line, metres.
    pub distance: f64,
    /// .. where their directions differ by no more than this angle, radians, 0 to pi / 2; which way they were drawn
    /// does not matter.
    pub angle: f64,
    /// Bends shorter than this go, metres ([`smooth`](super::smooth)); the distance, where that is longer.
    pub wave: f64,
}

/// One line for the strokes of a group.
#[derive(Clone, Debug, PartialEq)]
pub struct Cleaned {
    /// The line; it has the name and the direction of the longest stroke (a closed one where there is one), and points a
    /// quarter of the distance apart. Pen pressure is not kept.
    pub curve: Curve,
    /// Indices of its strokes, rising.
    pub strokes: Vec<usize>,
    /// Root of the mean squared distance of its strokes from it, metres.
    pub spread: f64,
    /// Largest distance of a stroke from it, metres.
    pub largest: f64,
}

/// Why strokes cannot be cleaned.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CleanError {
    /// It was told to stop.
    #[error("stopped")]
    Stopped,
    /// A distance that is no length.
    #[error("the distance {distance} m is not a length: give a number of metres above 0")]
    Distance {
        /// The distance given.
        distance: f64,
    },
    /// An angle that is none.
    #[error("the angle {angle} is not between 0 and pi / 2")]
    Angle {
        /// The angle given, radians.
        angle: f64,
    },
    /// A wavelength that is no length.
    #[error("the wavelength {wave} m is not a length: give a number of metres of at least 0")]
    Wave {
        /// The wavelength given.
        wave: f64,
    },
    /// Far more stroke than distance.
    #[error(
        "the strokes are {length:.3} m long together, which is too much to tell apart what is {distance} m away: give \
         a distance of at least {least:.2e} m, or fewer strokes"
    )]
    TooFine {
        /// Length of all strokes, metres.
        length: f64,
        /// The distance given, metres.
        distance: f64,
        /// Least distance that would do, metres.
        least: f64,
    },
    /// A line that cannot be fitted.
    #[error(
        "the strokes with \"{name}\" give no line: they are too short for the distance, or beyond the range of a \
             double; give a smaller distance"
    )]
    NoLine {
        /// Name of the longest of them.
        name: String,
    },
    /// Points fall together.
    #[error("the cleaned points make no curve ({0}): give a smaller distance")]
    Curve(#[from] CurveError),
}

/// [`clean_while`] that is never stopped.
///
/// # Errors
/// See there.
pub fn clean(strokes: &[Curve], cleaning: &Cleaning) -> Result<Vec<Cleaned>, CleanError> {
    clean_while(strokes, cleaning, &|_| true)
}

/// One line for each group of strokes that were drawn over one another, in the order of the first stroke of each.
///
/// Strokes belong together where, within the distance and the angle, they run beside each other for half of the shorter
/// one, or where the end of one lies beside the other and that one's beginning beside the first, so that it goes on in
/// the same direction; and where both belong with a third. Strokes that cross, or part like the arms of a Y, stay apart.
/// A line is closed where one of its strokes is, and where its end, after all strokes that go on there, lies within the
/// distance of its beginning and runs the same way, or would if both went on bending as they do: arcs that only together
/// come around make a closed curve.
///
/// Method: the principal curve of the strokes (T. Hastie and W. Stuetzle 1989, "Principal curves", J. Amer. Statist.
/// Assoc. 84): from the longest stroke, prolonged by those that go on beyond its ends, points of all strokes, evenly
/// spaced, are projected onto the line, averaged in cells of a quarter of the distance, and smoothed by a cubic
/// smoothing spline, until the line stays within 0.1 % of the distance, or eight times. An end lies at the mean of the
/// strokes' ends around it. Of n strokes that each are off a line by chance, the result is off by their deviation over
/// the square root of n; bends of a radius r are tightened by about deviation^2 / 2r. Time grows with the square of the
/// points of a group.
///
/// # Errors
/// [`CleanError`] where a number is out of range, the strokes are longer than 4096 distances together, there is no line,
/// or `progress` (which is given the share that is done) answers false.
pub fn clean_while(
    strokes: &[Curve],
    cleaning: &Cleaning,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Vec<Cleaned>, CleanError> {
    let Cleaning { distance, angle, wave } = *cleaning;
    if !(distance.is_finite() && distance > 0.0) {
        return Err(CleanError::Distance { distance });
    }
    if !(0.0..=std::f64::consts::FRAC_PI_2).contains(&angle) {
        return Err(CleanError::Angle { angle });
    }
    if !(wave.is_finite() && wave >= 0.0) {
        return Err(CleanError::Wave { wave });
    }
    let go_on = |share: f64| if progress(share) { Ok(()) } else { Err(CleanError::Stopped) };
    let samples = samples::of(strokes, distance)?;
    let alike = angle.cos();
    let groups = group::groups(&samples, distance, alike, &|share| go_on(0.3 * share))?;
    let count = groups.len();
    let mut lines = Vec::with_capacity(count);
    for (done, group) in groups.into_iter().enumerate() {
        let go_on = |share: f64| go_on(0.3 + 0.7 * (done as f64 + share) / count as f64);
        let own: Vec<&Samples> = group.iter().map(|stroke| &samples[*stroke]).collect();
        let longest = spine::longest(&own);
        let no_line = || CleanError::NoLine { name: strokes[group[longest]].name().to_owned() };
        let first = spine::spine(&own, longest, distance, alike, &go_on)?;
        let fit = fit::fit(&own, first, distance, alike, wave.max(distance), &go_on)?.ok_or_else(no_line)?;
        let name = strokes[group[longest]].name();
        let curve = Curve::new(name, fit.line.points().to_vec(), fit.line.is_closed())?;
        lines.push(Cleaned { curve, strokes: group, spread: fit.spread, largest: fit.largest });
    }
    go_on(1.0)?;
    Ok(lines)
}

#[cfg(test)]
mod tests;
