//! Whether four contours run around in order, as those of two views must.

use glam::DVec3;

use super::GenerateError;
use crate::curve::{ArcLength, Curve};

/// Stations at which the order is looked at, inside the rails.
const STATIONS: usize = 32;

/// Least sine of the angle between the chords of both pairs that tells on which side one lies of the other: 15 degrees.
const LEAST_SINE: f64 = 0.26;

/// Largest distance of a pair from its plane, in the mean distance of the two rails: what is drawn in one view lies in
/// its plane exactly, and two outlines of different views rarely do.
const FLATNESS: f64 = 0.02;

/// By how much another order must be better to refuse the one given.
const MARGIN: f64 = 0.3;

/// The ways around four rails that begin at the first one.
const ORDERS: [[usize; 4]; 6] = [[0, 1, 2, 3], [0, 3, 2, 1], [0, 2, 1, 3], [0, 3, 1, 2], [0, 1, 3, 2], [0, 2, 3, 1]];

/// Checks that four rails run the same way and stand once around counter-clockwise about it, opposite ones in one view.
///
/// At each station the chords between opposite rails tell the order: seen against the running direction the one turns
/// left to the other, wherever in depth both were drawn. An order counts where this holds at most stations, and more for
/// one whose pairs lie in two planes, as silhouettes do. Where no order counts, all rails were drawn in one view, say, the
/// answer is false: it is for the artist to judge.
pub(super) fn check_order(rails: &[Curve; 4], arcs: &[ArcLength<'_>; 4]) -> Result<bool, GenerateError> {
    check_direction(rails)?;
    let at = |t: f64| arcs.each_ref().map(|arc| arc.point_at_fraction(t));
    let points: Vec<[DVec3; 4]> = (0..=STATIONS + 1).map(|k| at(k as f64 / (STATIONS + 1) as f64)).collect();
    let found = ORDERS.map(|order| Sense::of(order, &points));
    let best = found.iter().fold(f64::NEG_INFINITY, |best, sense| best.max(sense.quality()));
    if found[0].counts && found[0].quality() >= best - MARGIN {
        Ok(true)
    } else if found.iter().any(|sense| sense.counts) {
        Err(GenerateError::RailsUnsorted { names: rails.each_ref().map(|rail| rail.name().to_owned()) })
    } else {
        Ok(false)
    }
}

/// What speaks for an order.
struct Sense {
    /// Whether opposite chords turn left at most stations.
    counts: bool,
    /// Mean sine of the angle between them, -1 to 1.
    sine: f64,
    /// Whether both pairs lie in a plane each.
    flat: bool,
}

impl Sense {
    fn of(order: [usize; 4], points: &[[DVec3; 4]]) -> Self {
        let sines = points.windows(3).map(|near| {
            let middle = |points: &[DVec3; 4]| points.iter().copied().sum::<DVec3>();
            let along = (middle(&near[2]) - middle(&near[0])).normalize_or_zero();
            let [a, b, c, d] = order.map(|rail| near[1][rail]);
            (c - a).normalize_or_zero().cross((d - b).normalize_or_zero()).dot(along)
        });
        let sines: Vec<f64> = sines.collect();
        let left = sines.iter().filter(|sine| **sine > LEAST_SINE).count();
        let flat = is_flat(points, order[0], order[2]) && is_flat(points, order[1], order[3]);
        Self { counts: 2 * left > sines.len(), sine: sines.iter().sum::<f64>() / sines.len() as f64, flat }
    }

    fn quality(&self) -> f64 {
        if self.counts { self.sine + f64::from(u8::from(self.flat)) } else { f64::NEG_INFINITY }
    }
}

/// Whether two rails lie in one plane to within [`FLATNESS`] of their distance.
fn is_flat(points: &[[DVec3; 4]], one: usize, other: usize) -> bool {
    let outline: Vec<DVec3> = points.iter().map(|p| p[one]).chain(points.iter().rev().map(|p| p[other])).collect();
    let centre = outline.iter().copied().sum::<DVec3>() / outline.len() as f64;
    let apart = points.iter().map(|p| p[one].distance(p[other])).sum::<f64>() / points.len() as f64;
    let normal = outline.windows(2).map(|w| (w[0] - centre).cross(w[1] - centre)).sum::<DVec3>().normalize_or_zero();
    normal != DVec3::ZERO && outline.iter().all(|p| (*p - centre).dot(normal).abs() <= FLATNESS * apart)
}

/// Checks that no rail runs against the others: like ends of two rails lie nearer together than unlike ones.
fn check_direction(rails: &[Curve; 4]) -> Result<(), GenerateError> {
    let against = |a: &Curve, b: &Curve| {
        let like = a.start().distance(b.start()) + a.end().distance(b.end());
        let unlike = a.start().distance(b.end()) + a.end().distance(b.start());
        like > 1.001 * unlike
    };
    let back: Vec<usize> = (1..4).filter(|rail| against(&rails[0], &rails[*rail])).collect();
    let rail = match back.as_slice() {
        [] => return Ok(()),
        [1, 2, 3] => 0,
        [first, ..] => *first,
    };
    Err(GenerateError::RailRunsBack { rail, name: rails[rail].name().to_owned() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    fn rail(name: &str, at: impl Fn(f64) -> DVec3) -> Curve {
        Curve::new(name, (0..=40).map(|i| at(f64::from(i) / 40.0)).collect(), false).unwrap()
    }

    fn check(rails: &[Curve; 4]) -> Result<bool, GenerateError> {
        check_order(rails, &rails.each_ref().map(ArcLength::of))
    }

    /// Straight up, the front view drawn at `z` and the side view at `x`.
    fn tube(x: f64, z: f64, taper: f64) -> [Curve; 4] {
        let half = move |t: f64| 0.05 * (1.0 - taper * t);
        [
            rail("left", move |t| DVec3::new(half(t), t, z)),
            rail("back", move |t| DVec3::new(x, t, -half(t))),
            rail("right", move |t| DVec3::new(-half(t), t, z)),
            rail("front", move |t| DVec3::new(x, t, half(t))),
        ]
    }

    /// An arm that bends by a right angle in the front view, drawn far off in depth.
    fn bent() -> [Curve; 4] {
        let middle = |t: f64| DVec3::new((FRAC_PI_2 * t).sin(), (FRAC_PI_2 * t).cos(), 0.0) * 0.3;
        let out = |t: f64| DVec3::new((FRAC_PI_2 * t).sin(), (FRAC_PI_2 * t).cos(), 0.0) * 0.04;
        [
            rail("upper", move |t| middle(t) + out(t)),
            rail("front", move |t| middle(t) + DVec3::Z * 0.04),
            rail("lower", move |t| middle(t) - out(t)),
            rail("back", move |t| middle(t) - DVec3::Z * 0.04),
        ]
    }

    fn every_order(rails: &[Curve; 4], turn: usize) -> [Result<bool, GenerateError>; 6] {
        ORDERS.map(|order| check(&order.map(|k| rails[(k + turn) % 4].clone())))
    }

    #[test]
    fn one_way_around_is_right_and_the_others_are_refused() {
        let [left, back, right, front] = bent();
        let bent = [left, front, right, back];
        let bent = if check(&bent).is_ok() { bent } else { bent.map(Curve::reversed) };
        let tilted =
            tube(0.03, 0.02, 0.3).map(|rail| rail.map(|p| DVec3::new(p.x, p.y + p.x + 0.5 * p.z, p.z)).unwrap());
        let shapes = [tube(0.0, 0.0, 0.0), tube(0.0, 0.0, 0.7), tube(0.02, -0.03, 0.4), tilted, bent];
        for (shape, rails) in shapes.iter().enumerate() {
            for turn in 0..4 {
                let found = every_order(rails, turn);
                assert_eq!(found[0], Ok(true), "shape {shape}");
                for refused in &found[1..] {
                    assert!(matches!(refused, Err(GenerateError::RailsUnsorted { .. })), "shape {shape}: {refused:?}");
                }
            }
        }
    }

    #[test]
    fn the_message_names_the_rails_and_the_remedy() {
        let [left, back, right, front] = tube(0.1, 0.2, 0.5);
        let message = check(&[left, right, front, back]).unwrap_err().to_string();
        assert!(message.contains("(\"left\", \"right\", \"front\", \"back\")"), "{message}");
        assert!(message.contains("pass them through `sort`"), "{message}");
    }

    #[test]
    fn a_rail_that_runs_back_is_named() {
        for k in 0..4 {
            let mut rails = tube(0.0, 0.0, 0.5);
            rails[k] = rails[k].clone().reversed();
            let name = rails[k].name().to_owned();
            assert_eq!(check(&rails), Err(GenerateError::RailRunsBack { rail: k, name }));
        }
        // All four the other way run around clockwise.
        assert!(matches!(check(&tube(0.0, 0.0, 0.5).map(Curve::reversed)), Err(GenerateError::RailsUnsorted { .. })));
    }

    #[test]
    fn rails_of_one_view_have_no_order() {
        let [left, _, right, _] = tube(0.0, 0.0, 0.5);
        let wide = |rail: &Curve| rail.map(|p| DVec3::new(1.3 * p.x, p.y, p.z)).unwrap();
        assert_eq!(check(&[left.clone(), wide(&left), right.clone(), wide(&right)]), Ok(false));
    }
}
