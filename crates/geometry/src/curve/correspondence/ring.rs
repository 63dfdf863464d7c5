//! Turning closed curves to fit the rails.

use crate::curve::{ArcLength, Closest, Curve, closest};
use glam::DVec3;

/// Share of the curve's length within which a foot counts as one of its points.
const ON_POINT: f64 = 1e-9;

/// The closed curve run counter-clockwise about a direction, and whether it had to be reversed for that.
fn counter_clockwise(curve: Curve, direction: DVec3) -> (Curve, bool) {
    let reversed = curve.area_vector().dot(direction) < 0.0;
    (if reversed { curve.reversed() } else { curve }, reversed)
}

/// The closed curve run so that it meets these places of the rails in their order, and whether it had to be reversed for
/// that; counter-clockwise about a direction where both ways are as good (two rails). The rails say it better than their
/// direction: where they leave a flat ring outwards and come back in, that points the other way.
pub(super) fn along_rails(curve: Curve, meets: &[DVec3], direction: DVec3) -> (Curve, bool) {
    let feet: Vec<f64> = meets.iter().map(|place| closest(&curve, *place).fraction).collect();
    // Once around with the order of the rails is one turn, against it one less than there are rails.
    let next = feet.iter().cycle().skip(1);
    let turns: f64 = feet.iter().zip(next).map(|(from, to)| (to - from).rem_euclid(1.0)).sum();
    let half = 0.5 * feet.len() as f64;
    if (turns - half).abs() < 0.25 {
        counter_clockwise(curve, direction)
    } else if turns > half {
        (curve.reversed(), true)
    } else {
        (curve, false)
    }
}

/// A closed curve with a new first point.
pub(crate) struct Started {
    pub(crate) curve: Curve,
    /// How far the first point moved along the curve, the shorter way, metres.
    pub(crate) moved: f64,
}

/// Starts a closed curve at its point closest to `target`, which becomes one of its points.
pub(crate) fn start_nearest(curve: &Curve, target: DVec3) -> Started {
    let length = ArcLength::of(curve).length();
    let Closest { point, arc_length, segment, .. } = closest(curve, target);
    let moved = arc_length.min(length - arc_length).max(0.0);
    let count = curve.points().len();
    let (from, to) = curve.segment(segment);
    let mut points = curve.points().to_vec();
    let mut pressure = curve.pressure().map(<[f64]>::to_vec);
    let first = if point.distance(from) <= ON_POINT * length {
        segment
    } else if point.distance(to) <= ON_POINT * length {
        (segment + 1) % count
    } else {
        points.insert(segment + 1, point);
        if let (Some(pressure), Some(there)) = (&mut pressure, ArcLength::of(curve).pressure_at(arc_length)) {
            pressure.insert(segment + 1, there);
        }
        segment + 1
    };
    points.rotate_left(first);
    if let Some(pressure) = &mut pressure {
        pressure.rotate_left(first);
    }
    // The points were valid, and the one inserted is none of them: a failure would leave the start where it was.
    let moved = if moved <= ON_POINT * length { 0.0 } else { moved };
    match Curve::with_pressure(curve.name(), points, true, pressure) {
        Ok(curve) => Started { curve, moved },
        Err(_) => Started { curve: curve.clone(), moved: 0.0 },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Curve {
        let points = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
        Curve::with_pressure("square", points.into(), true, Some(vec![0.0, 1.0, 2.0, 3.0])).unwrap()
    }

    #[test]
    fn start_is_inserted_where_there_is_no_point() {
        let started = start_nearest(&square(), DVec3::new(3.0, 0.5, 1.0));
        assert_eq!(started.moved, 2.5);
        assert_eq!(started.curve.points().len(), 5);
        assert_eq!(started.curve.start(), DVec3::new(2.0, 0.5, 0.0));
        assert_eq!(started.curve.end(), DVec3::new(2.0, 0.0, 0.0));
        assert_eq!(started.curve.pressure().unwrap(), [1.25, 2.0, 3.0, 0.0, 1.0]);
        assert_eq!(started.curve.area_vector(), square().area_vector());
    }

    #[test]
    fn start_at_a_point_only_turns_the_curve() {
        let started = start_nearest(&square(), DVec3::new(-1.0, 3.0, 0.0));
        assert_eq!((started.curve.points().len(), started.moved), (4, 2.0));
        assert_eq!(started.curve.start(), DVec3::Y * 2.0);
        let started = start_nearest(&square(), DVec3::new(-1.0, -1.0, 0.0));
        assert_eq!((started.curve, started.moved), (square(), 0.0));
    }

    #[test]
    fn clockwise_curves_are_reversed() {
        assert_eq!(counter_clockwise(square(), DVec3::Z), (square(), false));
        let (turned, reversed) = counter_clockwise(square(), -DVec3::Z);
        assert!(reversed && turned.area_vector().z < 0.0);
        assert_eq!(turned.start(), square().start());
    }
}
