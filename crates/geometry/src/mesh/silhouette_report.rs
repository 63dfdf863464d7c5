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
    /// Length of the outline that no stroke stands for, metres.
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
/// Both ways. An open stroke stands for the part of the outline between the points closest to its two ends, that of both
/// parts which is closer to it on the mean; a closed one for the whole of the loop closest to it. What no stroke stands
/// for, such as the rim of a cut limb, counts as undrawn, and is not compared. Measured at the points of both and between
/// them every 1/1024 of the sketch's diagonal, to the exact distance from all segments of the other.
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
    let spacing = SPACING * diagonal;
    let loops: Vec<Vec<DVec2>> = outline.iter().map(|curve| run(curve, view)).collect();
    let whole = Lines::new(loops.iter().map(Vec::as_slice));
    let mut report = SilhouetteReport { largest: 0.0, at: low, mean: 0.0, diagonal, undrawn: 0.0 };
    let (mut sum, mut length, mut drawn) = (0.0, 0.0, 0.0);
    for (k, stroke) in strokes.iter().enumerate() {
        let go_on = |done: f64| match progress((k as f64 + done) / strokes.len() as f64) {
            true => Ok(()),
            false => Err(SilhouetteReportError::Cancelled),
        };
        go_on(0.0)?;
        let line = run(stroke, view);
        let own = Lines::new([line.as_slice()]);
        let nearest = (0..loops.len()).map(|i| (mean_distance(&line, &Lines::new([loops[i].as_slice()]), spacing), i));
        let Some((_, closest)) = nearest.min_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
        let part = match stroke.is_closed() {
            true => loops[closest].clone(),
            false => {
                let ends = [line[0], line[line.len() - 1]];
                let [one, other] = parts(&loops[closest], ends);
                let near = |part: &[DVec2]| mean_distance(part, &own, spacing);
                if near(&one) <= near(&other) { one } else { other }
            }
        };
        go_on(0.5)?;
        for (from, to, against) in [(&line, true, &whole), (&part, false, &own)] {
            for pair in from.windows(2) {
                for (at, weight) in samples(pair[0], pair[1], spacing) {
                    let distance = against.distance(at);
                    if distance > report.largest {
                        (report.largest, report.at) = (distance, at);
                    }
                    if to {
                        sum += distance * weight;
                        length += weight;
                    }
                }
            }
        }
        drawn += run_length(&part);
    }
    report.mean = if length > 0.0 { sum / length } else { 0.0 };
    report.undrawn = (loops.iter().map(|line| run_length(line)).sum::<f64>() - drawn).max(0.0);
    Ok(report)
}

/// A curve as seen, the first point of a closed one repeated at its end.
fn run(curve: &Curve, view: View) -> Vec<DVec2> {
    let back = curve.is_closed().then(|| curve.start());
    curve.points().iter().copied().chain(back).map(|p| view.flat(p)).collect()
}

fn run_length(line: &[DVec2]) -> f64 {
    line.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
}

/// Mean distance of a line from others, by its length.
fn mean_distance(line: &[DVec2], lines: &Lines, spacing: f64) -> f64 {
    let (mut sum, mut length) = (0.0, 0.0);
    for pair in line.windows(2) {
        // A few places of each segment are enough to choose.
        for (at, weight) in samples(pair[0], pair[1], 8.0 * spacing) {
            sum += lines.distance(at) * weight;
            length += weight;
        }
    }
    if length > 0.0 { sum / length } else { line.first().map_or(f64::INFINITY, |p| lines.distance(*p)) }
}

/// Both parts of a loop (its first point repeated at its end) between the points closest to two places.
fn parts(around: &[DVec2], ends: [DVec2; 2]) -> [Vec<DVec2>; 2] {
    let place = |at: DVec2| {
        let mut best = (f64::INFINITY, 0, 0.0);
        for (k, pair) in around.windows(2).enumerate() {
            let share = foot(pair[0], pair[1], at);
            let squared = at.distance_squared(pair[0].lerp(pair[1], share));
            if squared < best.0 {
                best = (squared, k, share);
            }
        }
        (best.1, best.2)
    };
    let count = around.len() - 1;
    let walk = |(from, from_share): (usize, f64), (to, to_share): (usize, f64)| {
        let at = |k: usize, share: f64| around[k].lerp(around[k + 1], share);
        let mut line = vec![at(from, from_share)];
        if from != to || to_share < from_share {
            let mut k = from;
            loop {
                k = (k + 1) % count;
                line.push(around[k]);
                if k == to {
                    break;
                }
            }
        }
        line.push(at(to, to_share));
        line
    };
    let (start, end) = (place(ends[0]), place(ends[1]));
    [walk(start, end), walk(end, start)]
}

/// Share of the way from `from` to `to` that is closest to a point.
fn foot(from: DVec2, to: DVec2, point: DVec2) -> f64 {
    let along = to - from;
    let share = ((point - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    if share.is_nan() { 0.0 } else { share }
}

/// Points from one end to the other, no farther apart than `spacing`, each with the length it stands for.
fn samples(from: DVec2, to: DVec2, spacing: f64) -> impl Iterator<Item = (DVec2, f64)> {
    let length = from.distance(to);
    let steps = (length / spacing).ceil().clamp(1.0, 4096.0);
    (0..=steps as usize).map(move |k| {
        let weight = if k == 0 || k as f64 == steps { 0.5 } else { 1.0 };
        (from.lerp(to, k as f64 / steps), weight * length / steps)
    })
}

/// Lines as seen, in blocks of segments with boxes around them.
struct Lines {
    segments: Vec<[DVec2; 2]>,
    boxes: Vec<(DVec2, DVec2)>,
}

impl Lines {
    fn new<'a>(lines: impl IntoIterator<Item = &'a [DVec2]>) -> Self {
        let segments: Vec<[DVec2; 2]> =
            lines.into_iter().flat_map(|line| line.windows(2).map(|pair| [pair[0], pair[1]])).collect();
        let boxed = |block: &[[DVec2; 2]]| {
            block.iter().flatten().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), p| (l.min(*p), h.max(*p)))
        };
        let boxes = segments.chunks(BLOCK).map(boxed).collect();
        Self { segments, boxes }
    }

    fn distance(&self, point: DVec2) -> f64 {
        let mut best = f64::INFINITY;
        for (block, (low, high)) in self.segments.chunks(BLOCK).zip(&self.boxes) {
            let gap = (*low - point).max(point - *high).max(DVec2::ZERO);
            if gap.length_squared() >= best {
                continue;
            }
            for [from, to] in block {
                best = best.min(point.distance_squared(from.lerp(*to, foot(*from, *to, point))));
            }
        }
        best.sqrt()
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
        // Two rims of length 2, and a metre of both sides at each end.
        assert!((found.undrawn - 8.0).abs() < 1e-9, "{found:?}");
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
