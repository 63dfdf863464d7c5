//! How far the outline of a result is from the sketch it was made from.

use glam::DVec2;

use crate::curve::Curve;
use crate::view::View;

/// Samples stand no farther apart than this share of the sketch's diagonal.
const SPACING: f64 = 1.0 / 1024.0;

/// Segments whose box is tested at once.
const BLOCK: usize = 16;

/// How far an outline is from a sketch, as seen in one view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SilhouetteReport {
    /// Largest distance, metres: from the sketch to the outline and from the outline to the sketch.
    pub largest: f64,
    /// Where it is, in the picture, metres.
    pub at: DVec2,
    /// Mean distance from the sketch to the outline, by arc length, metres.
    pub mean: f64,
    /// Diagonal of the box around the sketch, metres: what percentages refer to.
    pub diagonal: f64,
    /// Length of the outline that no stroke stands for, as it lies beyond the ends of open strokes, metres.
    pub undrawn: f64,
}

impl SilhouetteReport {
    /// The largest distance in percent of the sketch's diagonal.
    pub fn largest_percent(&self) -> f64 {
        100.0 * self.largest / self.diagonal
    }

    /// The mean distance in percent of the sketch's diagonal.
    pub fn mean_percent(&self) -> f64 {
        100.0 * self.mean / self.diagonal
    }
}

/// Why an outline cannot be compared with a sketch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SilhouetteReportError {
    /// No strokes.
    #[error("there are no strokes to compare the outline with")]
    NoStrokes,
    /// No outline.
    #[error("there is no outline to compare the strokes with")]
    NoOutline,
    /// Strokes that are one point in this view.
    #[error("the strokes are a single point in the {view} view: choose the view in which they were drawn")]
    Point {
        /// The view.
        view: &'static str,
    },
    /// `progress` asked to stop.
    #[error("stopped")]
    Cancelled,
}

/// Distances between `outline` (see [`super::silhouette_of`]) and `strokes`, seen in `view`.
///
/// Both ways: each stroke is near the outline, and the outline near a stroke, but where the closest point of all strokes
/// is an end of an open one: there, as on the rim of a cut limb, nothing was drawn. Measured at the points of both and
/// between them every 1/1024 of the sketch's diagonal, to the exact distance from each.
///
/// # Errors
/// [`SilhouetteReportError`] for no strokes, no outline, strokes without size in this view, and where `progress`, called
/// with the fraction done, asked to stop.
pub fn silhouette_report(
    outline: &[Curve],
    strokes: &[Curve],
    view: View,
    progress: &dyn Fn(f64) -> bool,
) -> Result<SilhouetteReport, SilhouetteReportError> {
    if strokes.is_empty() {
        return Err(SilhouetteReportError::NoStrokes);
    }
    if outline.is_empty() {
        return Err(SilhouetteReportError::NoOutline);
    }
    let points = strokes.iter().flat_map(Curve::points).map(|p| view.flat(*p));
    let (low, high) = points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
    let diagonal = (high - low).length();
    if !(diagonal.is_finite() && diagonal > 0.0) {
        return Err(SilhouetteReportError::Point { view: view.name() });
    }
    let (sketch, seen) = (Lines::new(strokes, view), Lines::new(outline, view));
    let mut report = SilhouetteReport { largest: 0.0, at: low, mean: 0.0, diagonal, undrawn: 0.0 };
    let mut worse = |distance: f64, at: DVec2| {
        if distance > report.largest {
            (report.largest, report.at) = (distance, at);
        }
    };
    let (mut sum, mut length, mut undrawn) = (0.0, 0.0, 0.0);
    let count = (sketch.segments.len() + seen.segments.len()) as f64;
    let go_on = |done: usize| match done % 64 == 0 && !progress(done as f64 / count) {
        true => Err(SilhouetteReportError::Cancelled),
        false => Ok(()),
    };
    for (done, segment) in sketch.segments.iter().enumerate() {
        go_on(done)?;
        for (at, weight) in segment.samples(SPACING * diagonal) {
            let distance = seen.nearest(at).0;
            worse(distance, at);
            sum += distance * weight;
            length += weight;
        }
    }
    for (done, segment) in seen.segments.iter().enumerate() {
        go_on(sketch.segments.len() + done)?;
        for (at, weight) in segment.samples(SPACING * diagonal) {
            let (distance, end) = sketch.nearest(at);
            if end { undrawn += weight } else { worse(distance, at) }
        }
    }
    report.mean = if length > 0.0 { sum / length } else { 0.0 };
    report.undrawn = undrawn;
    Ok(report)
}

/// A straight piece of a line, and whether it begins or ends an open one.
#[derive(Clone, Copy)]
struct Segment {
    from: DVec2,
    to: DVec2,
    ends: [bool; 2],
}

impl Segment {
    /// Points from one end to the other, no farther apart than `spacing`, each with the length it stands for.
    fn samples(&self, spacing: f64) -> impl Iterator<Item = (DVec2, f64)> + use<> {
        let (from, to) = (self.from, self.to);
        let length = from.distance(to);
        let steps = (length / spacing).ceil().clamp(1.0, 4096.0);
        (0..=steps as usize).map(move |k| {
            let weight = if k == 0 || k as f64 == steps { 0.5 } else { 1.0 };
            (from.lerp(to, k as f64 / steps), weight * length / steps)
        })
    }
}

/// Lines as seen, in blocks of segments with boxes around them.
struct Lines {
    segments: Vec<Segment>,
    boxes: Vec<(DVec2, DVec2)>,
}

impl Lines {
    fn new(curves: &[Curve], view: View) -> Self {
        let mut segments = Vec::new();
        for curve in curves {
            let count = curve.segment_count();
            segments.extend((0..count).map(|k| {
                let (from, to) = curve.segment(k);
                let ends = [k == 0, k + 1 == count].map(|end| end && !curve.is_closed());
                Segment { from: view.flat(from), to: view.flat(to), ends }
            }));
        }
        let boxed = |block: &[Segment]| {
            block.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), s| {
                (l.min(s.from).min(s.to), h.max(s.from).max(s.to))
            })
        };
        let boxes = segments.chunks(BLOCK).map(boxed).collect();
        Self { segments, boxes }
    }

    /// Distance of a point, and whether what is closest is an end of an open line.
    fn nearest(&self, point: DVec2) -> (f64, bool) {
        let mut best = (f64::INFINITY, false);
        for (block, (low, high)) in self.segments.chunks(BLOCK).zip(&self.boxes) {
            let gap = (*low - point).max(point - *high).max(DVec2::ZERO);
            if gap.length_squared() >= best.0 {
                continue;
            }
            for segment in block {
                let along = segment.to - segment.from;
                let share = ((point - segment.from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
                let share = if share.is_nan() { 0.0 } else { share };
                let squared = point.distance_squared(segment.from.lerp(segment.to, share));
                if squared < best.0 {
                    let end = (share == 0.0 && segment.ends[0]) || (share == 1.0 && segment.ends[1]);
                    best = (squared, end);
                }
            }
        }
        (best.0.sqrt(), best.1)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn curve(points: &[(f64, f64)], closed: bool) -> Curve {
        Curve::new("", points.iter().map(|(x, y)| DVec3::new(*x, *y, 7.0)).collect(), closed).unwrap()
    }

    fn report(outline: &[Curve], strokes: &[Curve]) -> SilhouetteReport {
        silhouette_report(outline, strokes, View::FRONT, &|_| true).unwrap()
    }

    #[test]
    fn open_strokes_are_compared_with_what_lies_between_their_ends() {
        let outline = [curve(&[(-1.0, -1.0), (1.0, -1.0), (1.0, 5.0), (-1.0, 5.0)], true)];
        let strokes = [curve(&[(1.0, 0.0), (1.0, 4.0)], false), curve(&[(-1.0, 0.0), (-1.2, 4.0)], false)];
        let found = report(&outline, &strokes);
        assert!((found.largest - 0.2).abs() < 1e-12 && found.at.distance(DVec2::new(-1.2, 4.0)) < 1e-12, "{found:?}");
        assert!((found.mean - 0.05).abs() < 1e-4, "{found:?}");
        assert!((found.diagonal - 2.2_f64.hypot(4.0)).abs() < 1e-12);
        assert!((found.largest_percent() - 20.0 / found.diagonal).abs() < 1e-9);
        // Two rims of length 2 and what stands out of the strokes' ends: four sides, less or more by the slant.
        assert!((found.undrawn - 8.0).abs() < 0.06, "{found:?}");
    }

    #[test]
    fn both_ways_are_measured() {
        let square = curve(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)], true);
        let horn = curve(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.55, 1.0), (0.5, 1.3), (0.45, 1.0), (0.0, 1.0)], true);
        let strokes = [square];
        let found = report(&[horn], &strokes);
        assert!((found.largest - 0.3).abs() < 1e-12 && found.at == DVec2::new(0.5, 1.3) && found.undrawn == 0.0);
        assert!(found.mean < 0.02);
        assert_eq!(report(&strokes, &strokes).largest, 0.0);
    }

    #[test]
    fn what_cannot_be_compared_is_refused() {
        let square = [curve(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)], true)];
        let go = |outline: &[Curve], strokes: &[Curve], view| silhouette_report(outline, strokes, view, &|_| true);
        assert_eq!(go(&square, &[], View::FRONT), Err(SilhouetteReportError::NoStrokes));
        assert_eq!(go(&[], &square, View::FRONT), Err(SilhouetteReportError::NoOutline));
        let line = [Curve::new("", vec![DVec3::ZERO, DVec3::Z], false).unwrap()];
        assert_eq!(go(&square, &line, View::FRONT), Err(SilhouetteReportError::Point { view: "front" }));
        let stopped = silhouette_report(&square, &square, View::FRONT, &|_| false);
        assert_eq!(stopped, Err(SilhouetteReportError::Cancelled));
    }
}
