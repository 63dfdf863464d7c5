//! Going along a line in a view: by arc length, or by height.

use glam::DVec2;

/// How the points of both silhouettes of a view find each other, and theirs on the stack.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StrokeMatching {
    /// At the same share of the arc length (thesis 5.5). Sections tilt where one stroke is longer than the other, and
    /// follow a stroke that folds back.
    #[default]
    ArcLength,
    /// At the same share of the height, along the axis that both views have in common. Sections stay level; along a
    /// stretch in which the stroke folds back it is followed evenly by arc length between both its ends' heights. What
    /// reaches beyond the height of an end is passed over, and so is a level stretch.
    Height,
}

/// A line in a view with a share of the way, 0 to 1 and never falling, at each of its points.
#[derive(Clone, Debug)]
pub(crate) struct Track {
    points: Vec<DVec2>,
    shares: Vec<f64>,
    /// Which of the points are those the track was made from.
    given: Vec<usize>,
}

impl Track {
    /// The track of a line, or none where it makes no way: no length, or no height from its start to its end.
    pub(crate) fn new(points: &[DVec2], matching: StrokeMatching, along: DVec2) -> Option<Self> {
        match matching {
            StrokeMatching::ArcLength => Self::by_arc_length(points),
            StrokeMatching::Height => Self::by_height(points, along),
        }
    }

    fn by_arc_length(points: &[DVec2]) -> Option<Self> {
        let arcs = arc_lengths(points);
        let length = *arcs.last()?;
        let shares: Vec<f64> = arcs.iter().map(|arc| arc / length).collect();
        (length > 0.0 && shares.iter().all(|share| share.is_finite())).then(|| Self {
            points: points.to_vec(),
            shares,
            given: (0..points.len()).collect(),
        })
    }

    /// Heights rise where the line does. Between the two places at which it passes, for the last and for the first time,
    /// the valley's and the peak's height of a fold, the height is taken to rise evenly with arc length.
    fn by_height(points: &[DVec2], along: DVec2) -> Option<Self> {
        let (first, last) = (*points.first()?, *points.last()?);
        let sense = (last - first).dot(along).signum();
        let height = |p: DVec2| (p - first).dot(along) * sense;
        let total = height(last);
        let size = arc_lengths(points).last().copied()?;
        if !(total.is_finite() && total > 1e-9 * size) {
            return None;
        }
        let heights: Vec<f64> = points.iter().map(|p| height(*p).clamp(0.0, total)).collect();
        let mut highest = heights.clone();
        for k in 1..highest.len() {
            highest[k] = highest[k].max(highest[k - 1]);
        }
        let mut lowest = heights.clone();
        for k in (0..lowest.len() - 1).rev() {
            lowest[k] = lowest[k].min(lowest[k + 1]);
        }
        let folded = |k: usize| highest[k] > lowest[k];
        let mut track = Self { points: Vec::new(), shares: Vec::new(), given: Vec::new() };
        // The fold that has begun: the number of its first point among the track's.
        let mut fold: Option<usize> = None;
        for k in 0..points.len() {
            let crossed = |level: f64, from: usize| {
                let (low, high) = (heights[from], heights[from + 1]);
                let share = ((level - low) / (high - low)).clamp(0.0, 1.0);
                points[from].lerp(points[from + 1], if share.is_nan() { 0.0 } else { share })
            };
            match (fold, folded(k)) {
                (None, true) => {
                    let valley = lowest[k];
                    let start = k.saturating_sub(1);
                    fold = Some(track.points.len());
                    track.push(crossed(valley, start), valley / total);
                }
                (Some(start), false) => {
                    let peak = highest[k - 1];
                    track.push(crossed(peak, k - 1), peak / total);
                    track.rise_evenly(start);
                    fold = None;
                }
                _ => {}
            }
            track.given.push(track.points.len());
            track.push(points[k], heights[k] / total);
        }
        if let Some(start) = fold {
            track.rise_evenly(start);
        }
        Some(track)
    }

    fn push(&mut self, point: DVec2, share: f64) {
        self.points.push(point);
        self.shares.push(share);
    }

    /// Lets the shares from point `start` to the last point rise evenly with arc length.
    fn rise_evenly(&mut self, start: usize) {
        let arcs = arc_lengths(&self.points[start..]);
        let length = arcs.last().copied().unwrap_or(0.0);
        let last = self.shares.len() - 1;
        let (low, high) = (self.shares[start], self.shares[last]);
        for (share, arc) in self.shares[start..].iter_mut().zip(arcs) {
            *share = if length > 0.0 { low + (high - low) * (arc / length).min(1.0) } else { low };
        }
    }

    /// The shares of the points that the track was made from, in their order.
    pub(crate) fn given(&self) -> impl Iterator<Item = f64> {
        self.given.iter().map(|k| self.shares[*k])
    }

    /// The points strictly between two shares, and their shares.
    pub(crate) fn between(&self, from: f64, to: f64) -> (&[DVec2], &[f64]) {
        let first = self.shares.partition_point(|s| *s <= from);
        let inside = first..self.shares.partition_point(|s| *s < to).max(first);
        (&self.points[inside.clone()], &self.shares[inside])
    }

    /// The point at a share of the way: the first and the last one at 0 and 1 and beyond, and the last of several at the
    /// same share between.
    pub(crate) fn at(&self, share: f64) -> DVec2 {
        let last = self.points.len() - 1;
        let next = self.shares.partition_point(|s| *s <= share);
        if next == 0 || share <= self.shares[0] {
            return self.points[0];
        }
        if next > last || share >= self.shares[last] {
            return self.points[last];
        }
        let (low, high) = (self.shares[next - 1], self.shares[next]);
        self.points[next - 1].lerp(self.points[next], (share - low) / (high - low))
    }
}

fn arc_lengths(points: &[DVec2]) -> Vec<f64> {
    let mut sum = 0.0;
    let steps = points.windows(2).map(|pair| pair[0].distance(pair[1]));
    std::iter::once(0.0)
        .chain(steps.map(|step| {
            sum += step;
            sum
        }))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(points: &[(f64, f64)]) -> Vec<DVec2> {
        points.iter().map(|p| DVec2::from(*p)).collect()
    }

    #[test]
    fn shares_of_the_length_and_of_the_height() {
        let bent = line(&[(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (3.0, 4.0)]);
        let arc = Track::new(&bent, StrokeMatching::ArcLength, DVec2::Y).unwrap();
        assert!(arc.at(0.5).distance(DVec2::new(3.0, 0.5)) < 1e-15);
        assert_eq!((arc.at(-1.0), arc.at(2.0)), (bent[0], bent[3]));
        let height = Track::new(&bent, StrokeMatching::Height, DVec2::Y).unwrap();
        assert_eq!(height.at(0.5), DVec2::new(3.0, 2.0));
        assert_eq!(height.given().collect::<Vec<_>>(), [0.0, 0.0, 0.25, 1.0]);
        // The same the other way up.
        let down: Vec<DVec2> = bent.iter().rev().copied().collect();
        assert_eq!(Track::new(&down, StrokeMatching::Height, DVec2::Y).unwrap().at(0.5), DVec2::new(3.0, 2.0));
    }

    #[test]
    fn a_fold_is_followed_whole_between_its_heights() {
        // Up to 3, back to 1, up to 4: from height 1 on the way up to height 3 on the way on, a length of 6.
        let folded = line(&[(0.0, 0.0), (0.0, 3.0), (1.0, 3.0), (1.0, 1.0), (2.0, 1.0), (2.0, 4.0)]);
        let track = Track::new(&folded, StrokeMatching::Height, DVec2::Y).unwrap();
        assert_eq!(track.at(0.125), DVec2::new(0.0, 0.5));
        assert_eq!((track.at(0.25), track.at(0.75)), (DVec2::new(0.0, 1.0), DVec2::new(2.0, 3.0)));
        assert!(track.at(0.25 + 0.5 * 3.0 / 8.0).distance(DVec2::new(1.0, 3.0)) < 1e-12);
        assert!(track.at(0.5).distance(DVec2::new(1.0, 2.0)) < 1e-12);
        let shares: Vec<f64> = (0..=1000).map(|k| f64::from(k) / 1000.0).collect();
        let steps = shares.windows(2).map(|w| track.at(w[0]).distance(track.at(w[1])));
        assert!(steps.fold(0.0, f64::max) < 0.02, "no leap");
    }

    #[test]
    fn a_line_that_makes_no_way_has_no_track() {
        let level = line(&[(0.0, 0.0), (3.0, 0.0)]);
        assert!(Track::new(&level, StrokeMatching::Height, DVec2::Y).is_none());
        assert!(Track::new(&line(&[(1.0, 1.0), (1.0, 1.0)]), StrokeMatching::ArcLength, DVec2::Y).is_none());
    }
}
