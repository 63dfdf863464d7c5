//! Simplification: the points that a tolerance needs.

use std::cmp::Ordering;

use glam::DVec3;

use super::{Curve, CurveError};

/// Segments tested between two questions whether to go on.
const STRIDE: usize = 4096;

/// Why a curve cannot be simplified.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SimplifyError {
    /// It was told to stop.
    #[error("stopped")]
    Stopped,
    /// A tolerance that is no length.
    #[error("the tolerance {tolerance} m is not a length: give a number of metres of at least 0")]
    Tolerance {
        /// The tolerance given.
        tolerance: f64,
    },
    /// The points that are left make no curve.
    #[error("the points that are left make no curve ({0}): give a smaller tolerance")]
    Curve(#[from] CurveError),
}

/// [`simplify_while`] that is never stopped.
///
/// # Errors
/// See there.
pub fn simplify(curve: &Curve, tolerance: f64) -> Result<Curve, SimplifyError> {
    simplify_while(curve, tolerance, &|_| true)
}

/// Takes points off a curve as long as each of them is within `tolerance` metres of the straight piece that replaces it;
/// those that stay are where they were, with their pressure. Both ends of an open curve stay, and three points of a
/// closed one at least; what stays does not depend on where a closed curve starts.
///
/// Method: D. H. Douglas and T. K. Peucker 1973, "Algorithms for the reduction of the number of points required to
/// represent a digitized line", Cartographica 10, by distances from segments rather than lines. A closed curve is cut at
/// the point farthest from the middle of its bounds and the one farthest from that. Time is n log n for ordinary curves
/// of n points, n^2 for spirals.
///
/// # Errors
/// [`SimplifyError`] where `tolerance` is negative or not finite, the points that are left fall together, or `progress`
/// (which is given the share that is done) answers false.
pub fn simplify_while(curve: &Curve, tolerance: f64, progress: &dyn Fn(f64) -> bool) -> Result<Curve, SimplifyError> {
    simplified(curve, tolerance, &[], progress)
}

/// The same, where the points at `fixed` (rising indices) stay.
pub(crate) fn simplified(
    curve: &Curve,
    tolerance: f64,
    fixed: &[usize],
    progress: &dyn Fn(f64) -> bool,
) -> Result<Curve, SimplifyError> {
    if !(tolerance.is_finite() && tolerance >= 0.0) {
        return Err(SimplifyError::Tolerance { tolerance });
    }
    let points = curve.points();
    let count = points.len();
    let mut cuts: Vec<usize> = fixed.iter().copied().filter(|index| *index < count).collect();
    if curve.is_closed() {
        add_cuts(points, &mut cuts);
    } else {
        cuts.extend([0, count - 1]);
    }
    cuts.sort_unstable();
    cuts.dedup();
    let mut kept = vec![false; count];
    cuts.iter().for_each(|cut| kept[*cut] = true);
    let mut pending: Vec<(usize, usize)> = cuts.windows(2).map(|pair| (pair[0], pair[1])).collect();
    if let (true, Some(first), Some(last)) = (curve.is_closed(), cuts.first(), cuts.last()) {
        pending.push((*last, first + count));
    }
    pending.reverse();
    let (mut tested, mut done) = (0, 0);
    while let Some((from, to)) = pending.pop() {
        tested += to - from;
        if tested > STRIDE {
            tested = 0;
            if !progress(done as f64 / count as f64) {
                return Err(SimplifyError::Stopped);
            }
        }
        match farthest(points, from, to) {
            Some((off, index)) if off > tolerance => {
                kept[index % count] = true;
                pending.extend([(index, to), (from, index)]);
            }
            _ => done += to - from,
        }
    }
    let left = |values: &[DVec3]| values.iter().zip(&kept).filter(|(_, kept)| **kept).map(|(p, _)| *p).collect();
    let pressure = curve.pressure().map(|p| p.iter().zip(&kept).filter(|(_, kept)| **kept).map(|(p, _)| *p).collect());
    Ok(Curve::with_pressure(curve.name(), left(points), curve.is_closed(), pressure)?)
}

/// The larger number, and of equal ones the point that comes first by its coordinates: the same wherever a closed curve
/// starts.
fn by_place(a: (f64, DVec3), b: (f64, DVec3)) -> Ordering {
    let place = |p: DVec3, q: DVec3| q.x.total_cmp(&p.x).then(q.y.total_cmp(&p.y)).then(q.z.total_cmp(&p.z));
    a.0.total_cmp(&b.0).then_with(|| place(a.1, b.1))
}

/// The point between two others that is farthest from the segment between them, with its distance; indices go around.
fn farthest(points: &[DVec3], from: usize, to: usize) -> Option<(f64, usize)> {
    let count = points.len();
    let (start, end) = (points[from % count], points[to % count]);
    // Always the same way, so that rounding is the same whichever of them comes first.
    let (start, end) = if by_place((0.0, start), (0.0, end)).is_ge() { (start, end) } else { (end, start) };
    let along = end - start;
    let square = along.length_squared();
    let off = |index: usize| {
        let point = points[index % count];
        let share = if square > 0.0 { ((point - start).dot(along) / square).clamp(0.0, 1.0) } else { 0.0 };
        (point.distance(start + along * share), point, index)
    };
    let found = (from + 1..to).map(off).max_by(|a, b| by_place((a.0, a.1), (b.0, b.1)));
    found.map(|(distance, _, index)| (distance, index))
}

/// Adds points at which a closed curve is cut, until there are three.
fn add_cuts(points: &[DVec3], cuts: &mut Vec<usize>) {
    let bounds = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = points.iter().fold(bounds, |(low, high), p| (low.min(*p), high.max(*p)));
    let from = |place: DVec3| {
        let farther = |a: &usize, b: &usize| {
            by_place((points[*a].distance(place), points[*a]), (points[*b].distance(place), points[*b]))
        };
        (0..points.len()).max_by(farther).unwrap_or(0)
    };
    if cuts.is_empty() {
        cuts.push(from(low / 2.0 + high / 2.0));
    }
    if let [only] = cuts[..] {
        cuts.push(from(points[only]));
    }
    if let [a, b] = cuts[..] {
        let (a, b) = (a.min(b), a.max(b));
        let sides = [farthest(points, a, b), farthest(points, b, a + points.len())];
        let third = sides
            .into_iter()
            .flatten()
            .max_by(|x, y| by_place((x.0, points[x.1 % points.len()]), (y.0, points[y.1 % points.len()])));
        cuts.extend(third.map(|(_, index)| index % points.len()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::farthest;
    use proptest::prelude::*;

    fn wave(count: u32, closed: bool) -> Curve {
        let point = |k: u32| {
            let angle = std::f64::consts::TAU * f64::from(k) / f64::from(count);
            let radius = 1.0 + 0.2 * (3.0 * angle).sin() + 0.07 * (5.0 * angle + 0.4).cos();
            DVec3::new(radius * angle.cos(), radius * angle.sin(), 0.1 * angle.sin())
        };
        let pressure = (0..count).map(f64::from).collect();
        Curve::with_pressure("wave", (0..count).map(point).collect(), closed, Some(pressure)).unwrap()
    }

    fn off(was: &Curve, is: &Curve) -> f64 {
        farthest(was.points(), is)
    }

    #[test]
    fn what_is_left_is_within_the_tolerance_and_keeps_its_pressure() {
        for closed in [false, true] {
            let curve = wave(600, closed);
            let mut before = usize::MAX;
            for tolerance in [0.0, 1e-4, 1e-3, 1e-2, 0.1] {
                let simple = simplify(&curve, tolerance).unwrap();
                assert!(off(&curve, &simple) <= tolerance, "{tolerance}");
                assert!(simple.points().len() <= before, "{tolerance}: {} {before}", simple.points().len());
                before = simple.points().len();
                for (point, pressure) in simple.points().iter().zip(simple.pressure().unwrap()) {
                    assert_eq!(curve.points()[*pressure as usize], *point);
                }
                if !closed {
                    assert_eq!((simple.start(), simple.end()), (curve.start(), curve.end()));
                }
            }
            assert!(before < 20, "{before}");
        }
    }

    #[test]
    fn straight_pieces_need_their_ends_only() {
        let line = (0..100).map(|k| DVec3::new(f64::from(k), 2.0 * f64::from(k), 1.0));
        let line = Curve::new("line", line.collect(), false).unwrap();
        assert_eq!(simplify(&line, 1e-9).unwrap().points(), [line.start(), line.end()]);
        let corner = [DVec3::ZERO, DVec3::X, DVec3::X * 2.0, DVec3::new(2.0, 1.0, 0.0), DVec3::new(2.0, 2.0, 0.0)];
        let corner = Curve::new("corner", corner.to_vec(), false).unwrap();
        assert_eq!(simplify(&corner, 1e-9).unwrap().points(), [corner.start(), corner.points()[2], corner.end()]);
        // A spike that goes back on itself keeps its tip: distances are those from the segment.
        let spike = Curve::new("spike", vec![DVec3::ZERO, DVec3::X * 3.0, DVec3::X], false).unwrap();
        assert_eq!(simplify(&spike, 0.5).unwrap(), spike);
    }

    #[test]
    fn a_closed_curve_keeps_three_points() {
        let ring = simplify(&wave(50, true), 100.0).unwrap();
        assert!(ring.is_closed() && ring.points().len() == 3);
        let flat = Curve::new("flat", vec![DVec3::ZERO, DVec3::X, DVec3::X * 2.0, DVec3::X], true).unwrap();
        assert!(simplify(&flat, 1.0).is_ok_and(|flat| flat.points().len() == 3));
    }

    #[test]
    fn a_tolerance_must_be_a_length_and_it_stops_when_told() {
        for tolerance in [-1.0, f64::NAN, f64::INFINITY] {
            let error = simplify(&wave(9, true), tolerance).unwrap_err();
            assert!(matches!(error, SimplifyError::Tolerance { .. }), "{error}");
        }
        assert_eq!(simplify_while(&wave(9_000, true), 1e-9, &|_| false), Err(SimplifyError::Stopped));
    }

    type Place = (i32, i32, i32);

    fn place() -> impl Strategy<Value = Place> {
        (-5_i32..5, -5_i32..5, -2_i32..2)
    }

    fn ring(places: impl IntoIterator<Item = Place>) -> Option<Curve> {
        let points = places.into_iter().map(|(x, y, z)| DVec3::new(f64::from(x), f64::from(y), f64::from(z))).collect();
        Curve::new("", points, true).ok()
    }

    proptest! {
        #[test]
        fn no_point_is_farther_off_than_the_tolerance(
            places in prop::collection::vec(place(), 3..40),
            tolerance in 0.0..3.0,
        ) {
            // One that never leaves a point or two is no closed curve.
            let Some(curve) = ring(places) else { return Ok(()) };
            if let Ok(simple) = simplify(&curve, tolerance) {
                prop_assert!(off(&curve, &simple) <= tolerance + 1e-12);
            }
        }

        /// Points that no other equals: else which of two at one place is kept is up to the start.
        #[test]
        fn it_does_not_matter_where_a_closed_curve_starts(
            places in prop::collection::btree_set(place(), 3..40)
                .prop_flat_map(|places| Just(places.into_iter().collect::<Vec<_>>()).prop_shuffle()),
            shift in 0_usize..40,
            tolerance in 0.0..3.0,
        ) {
            let mut turned = places.clone();
            turned.rotate_left(shift % places.len());
            let kept = |places: Vec<Place>| {
                let simple = simplify(&ring(places).unwrap(), tolerance).unwrap();
                let mut points: Vec<[i64; 3]> =
                    simple.points().iter().map(|p| [p.x as i64, p.y as i64, p.z as i64]).collect();
                points.sort_unstable();
                points
            };
            prop_assert_eq!(kept(places), kept(turned));
        }
    }
}
