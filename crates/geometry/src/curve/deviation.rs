//! How far two curves are apart: where they come nearest, at equal arc length, and point by point.

use glam::DVec3;

use super::{ArcLength, Curve, closest, start_nearest};

/// Largest and mean distance between two curves, in one way of saying which places belong together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// The largest distance, metres.
    pub largest: f64,
    /// The mean distance, metres.
    pub mean: f64,
    /// Where on the first curve it is largest.
    pub at: DVec3,
    /// The same place as a share of the first curve: of its length, or of its points where points are compared.
    pub share: f64,
}

/// How far two curves are apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation {
    /// From each place to the nearest one of the other curve, both ways: the Hausdorff distance. The mean is that of
    /// both ways, each over arc length.
    pub nearest: Gap,
    /// Between places at equal shares of both lengths.
    pub arc_length: Gap,
    /// Between points of equal number, as they run; none where the numbers differ or only one curve is closed.
    pub points: Option<Gap>,
    /// Whether at equal arc length the second curve was run the other way, because that is nearer.
    pub reversed: bool,
}

/// Why two curves are not compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DeviationError {
    /// It was told to stop.
    #[error("stopped")]
    Stopped,
    /// Distances beyond the range of a double.
    #[error("the curves are too large or too far apart to measure: move and scale them to a few metres")]
    NotFinite,
}

/// Measures how far `first` and `second` are apart.
///
/// Nearest distances are taken at every point of both curves and at `samples` places of equal arc length on each; what
/// lies between these is missed by at most half their spacing. At equal arc length `samples` places are compared; a
/// closed curve begins where it is nearest to the first point of the other one, and the second is run the other way
/// where the mean is smaller so. `go_on` is asked with the share done at every place.
///
/// # Errors
/// [`DeviationError`] where `go_on` answers `false`, or a distance is not finite.
pub fn deviation(
    first: &Curve,
    second: &Curve,
    samples: usize,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Deviation, DeviationError> {
    let samples = samples.max(1);
    let there = one_way(first, second, samples, &|share| go_on(0.45 * share))?;
    let back = one_way(second, first, samples, &|share| go_on(0.45 + 0.45 * share))?;
    let (largest, at) =
        if there.largest >= back.largest { (there.largest, there.from) } else { (back.largest, back.to) };
    let share = closest(first, at).fraction;
    let nearest = Gap { largest, mean: (there.mean + back.mean) / 2.0, at, share };
    let (arc_length, reversed) = at_equal_arc_length(first, second, samples, go_on)?;
    let points = by_point(first, second);
    let finite = |gap: &Gap| gap.largest.is_finite() && gap.mean.is_finite() && gap.at.is_finite();
    if [Some(&nearest), Some(&arc_length), points.as_ref()].into_iter().flatten().all(finite) {
        Ok(Deviation { nearest, arc_length, points, reversed })
    } else {
        Err(DeviationError::NotFinite)
    }
}

/// Distances from one curve to another.
struct OneWay {
    largest: f64,
    mean: f64,
    from: DVec3,
    to: DVec3,
}

fn one_way(from: &Curve, to: &Curve, samples: usize, go_on: &dyn Fn(f64) -> bool) -> Result<OneWay, DeviationError> {
    let mut found = OneWay { largest: -1.0, mean: 0.0, from: from.start(), to: to.start() };
    let corners = from.points().len();
    let places = shares(from.is_closed(), samples);
    let total = (corners + places.len()) as f64;
    let mut measure = |index: usize, point: DVec3| {
        if !go_on(index as f64 / total) {
            return Err(DeviationError::Stopped);
        }
        let near = closest(to, point);
        if !near.distance.is_finite() {
            return Err(DeviationError::NotFinite);
        }
        if near.distance > found.largest {
            (found.largest, found.from, found.to) = (near.distance, point, near.point);
        }
        Ok(near.distance)
    };
    for (index, point) in from.points().iter().enumerate() {
        measure(index, *point)?;
    }
    let arc = ArcLength::of(from);
    let mut sum = 0.0;
    for (index, (share, weight)) in places.iter().enumerate() {
        sum += weight * measure(corners + index, arc.point_at_fraction(*share))?;
    }
    found.mean = sum;
    Ok(found)
}

/// Shares of the length and their weights in a mean (the trapezoidal rule): both ends of an open curve count half.
fn shares(closed: bool, samples: usize) -> Vec<(f64, f64)> {
    let weight = 1.0 / samples as f64;
    let share = |k: usize| k as f64 / samples as f64;
    if closed {
        return (0..samples).map(|k| (share(k), weight)).collect();
    }
    (0..=samples).map(|k| (share(k), if k == 0 || k == samples { weight / 2.0 } else { weight })).collect()
}

fn at_equal_arc_length(
    first: &Curve,
    second: &Curve,
    samples: usize,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<(Gap, bool), DeviationError> {
    let begun = match (first.is_closed(), second.is_closed()) {
        (true, false) => (start_nearest(first, second.start()).curve, second.clone()),
        (_, true) => (first.clone(), start_nearest(second, first.start()).curve),
        (false, false) => (first.clone(), second.clone()),
    };
    let (arc, other) = (ArcLength::of(&begun.0), ArcLength::of(&begun.1));
    let places = shares(first.is_closed() && second.is_closed(), samples);
    let gap = |backward: bool| {
        let mut gap = Gap { largest: -1.0, mean: 0.0, at: first.start(), share: 0.0 };
        for (share, weight) in &places {
            let point = arc.point_at_fraction(*share);
            let opposite = if backward { 1.0 - share } else { *share };
            let distance = point.distance(other.point_at_fraction(opposite));
            gap.mean += weight * distance;
            if distance > gap.largest {
                gap = Gap { largest: distance, at: point, share: *share, ..gap };
            }
        }
        gap
    };
    let ask = |share| if go_on(share) { Ok(()) } else { Err(DeviationError::Stopped) };
    ask(0.9)?;
    let forward = gap(false);
    ask(0.95)?;
    let backward = gap(true);
    ask(1.0)?;
    let reversed = backward.mean < forward.mean;
    Ok((if reversed { backward } else { forward }, reversed))
}

fn by_point(first: &Curve, second: &Curve) -> Option<Gap> {
    let (a, b) = (first.points(), second.points());
    if a.len() != b.len() || first.is_closed() != second.is_closed() {
        return None;
    }
    let mut gap = Gap { largest: -1.0, mean: 0.0, at: a[0], share: 0.0 };
    for (index, (p, q)) in a.iter().zip(b).enumerate() {
        let distance = p.distance(*q);
        gap.mean += distance / a.len() as f64;
        if distance > gap.largest {
            gap = Gap { largest: distance, at: *p, share: index as f64 / first.segment_count() as f64, ..gap };
        }
    }
    Some(gap)
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    fn line(from: DVec3, to: DVec3, points: usize) -> Curve {
        let at = |k: usize| from.lerp(to, k as f64 / (points - 1) as f64);
        Curve::new("line", (0..points).map(at).collect(), false).unwrap()
    }

    fn square(start: usize, reversed: bool) -> Curve {
        let mut points = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        points.rotate_left(start);
        let curve = Curve::new("square", points, true).unwrap();
        if reversed { curve.reversed() } else { curve }
    }

    #[test]
    fn a_line_beside_another() {
        let low = line(DVec3::ZERO, DVec3::X * 2.0, 3);
        let high = line(DVec3::Y * 0.25, DVec3::new(2.0, 0.25, 0.0), 9);
        let found = deviation(&low, &high, 64, &|_| true).unwrap();
        for gap in [found.nearest, found.arc_length] {
            assert!((gap.largest - 0.25).abs() < 1e-15 && (gap.mean - 0.25).abs() < 1e-12, "{gap:?}");
        }
        assert!(found.points.is_none() && !found.reversed);
        let back = deviation(&low, &high.reversed(), 64, &|_| true).unwrap();
        assert!(back.reversed && (back.arc_length.largest - 0.25).abs() < 1e-15);
    }

    #[test]
    fn what_sticks_out_of_either_is_found() {
        // A spike one metre high on the second curve: far from the first one, which is near everywhere.
        let flat = line(DVec3::ZERO, DVec3::X * 4.0, 5);
        let mut points = flat.points().to_vec();
        points.insert(3, DVec3::new(2.5, 1.0, 0.0));
        let spiked = Curve::new("spiked", points, false).unwrap();
        for (a, b) in [(&flat, &spiked), (&spiked, &flat)] {
            let found = deviation(a, b, 7, &|_| true).unwrap();
            assert_eq!(found.nearest.largest, 1.0);
            assert!((found.nearest.at.x - 2.5).abs() < 1e-12, "{found:?}");
        }
    }

    #[test]
    fn points_are_compared_by_number_and_places_by_length() {
        let even = line(DVec3::ZERO, DVec3::X, 3);
        let uneven = Curve::new("", vec![DVec3::ZERO, DVec3::X * 0.75, DVec3::X], false).unwrap();
        let found = deviation(&even, &uneven, 100, &|_| true).unwrap();
        assert!(found.nearest.largest < 1e-15 && found.arc_length.largest < 1e-15, "{found:?}");
        let points = found.points.unwrap();
        assert_eq!((points.largest, points.share, points.at), (0.25, 0.5, DVec3::X * 0.5));
        assert!((points.mean - 0.25 / 3.0).abs() < 1e-15);
    }

    #[test]
    fn closed_curves_are_the_same_however_they_begin_and_run() {
        for (start, reversed) in [(0, false), (2, false), (3, true)] {
            let found = deviation(&square(0, false), &square(start, reversed), 40, &|_| true).unwrap();
            assert!(found.nearest.largest < 1e-15 && found.arc_length.largest < 1e-14, "{start} {reversed} {found:?}");
            assert_eq!(found.reversed, reversed);
        }
        let open = Curve::new("open", square(1, false).points().to_vec(), false).unwrap();
        assert!(deviation(&square(0, false), &open, 40, &|_| true).unwrap().points.is_none());
    }

    #[test]
    fn it_stops_and_refuses_what_cannot_be_measured() {
        let near = line(DVec3::ZERO, DVec3::X, 5);
        let asked = Cell::new(0);
        let stopped = deviation(&near, &near, 8, &|_| {
            asked.set(asked.get() + 1);
            asked.get() < 6
        });
        assert_eq!((stopped, asked.get()), (Err(DeviationError::Stopped), 6));
        let far = line(DVec3::ZERO, DVec3::splat(1e300), 2);
        assert_eq!(deviation(&near, &far, 8, &|_| true), Err(DeviationError::NotFinite));
    }
}
