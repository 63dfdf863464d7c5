//! Length, area and nearest point of a section.

use super::section::{EllipticSection, EllipticSegment};
use glam::DVec3;

/// A point of a section nearest to a given one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestPoint {
    /// Angle, radians, within the section's range.
    pub angle: f64,
    /// The point of the section, metres.
    pub point: DVec3,
    /// Its distance from the given point, metres.
    pub distance: f64,
}

/// Positive nodes and weights of Gauss and Legendre's rule with eight points on -1 to 1 (exact for degree 15).
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

/// Length to which a nearest point is refined, as a share of the step between first guesses.
const REFINED: f64 = 1e-14;

impl EllipticSection {
    /// Length of the whole curve, metres: see [`EllipticSection::length_between`].
    pub fn length(&self) -> f64 {
        let (from, to) = self.range();
        self.length_between(from, to)
    }

    /// Length between two angles within the range, metres; negative where the second is less.
    ///
    /// Gauss and Legendre's rule with eight points on `16 (J+1)` panels of each segment: relative error below 1e-10 for
    /// an ellipse of 4:1, larger only near points where the curve turns on the spot.
    pub fn length_between(&self, v0: f64, v1: f64) -> f64 {
        if v1 < v0 {
            return -self.length_between(v1, v0);
        }
        let pieces = self.segments().iter().map(|segment| (segment, segment.from.max(v0), segment.to.min(v1)));
        pieces
            .filter(|(_, from, to)| from < to)
            .map(|(segment, from, to)| integral(segment, from, to, |[_, speed]| DVec3::X * speed.length()).x)
            .sum()
    }

    /// Area vector of the loop, square metres: see [`super::Series::area_vector`]. An open section is closed by a straight
    /// line. Exact for one segment, else by the rule of [`EllipticSection::length_between`].
    pub fn area_vector(&self) -> DVec3 {
        if let [segment] = self.segments()
            && self.is_closed()
            && !segment.local
        {
            return segment.series.area_vector();
        }
        let origin = self.frame().origin;
        let swept = |[point, speed]: [DVec3; 2]| (point - origin).cross(speed) / 2.0;
        let sum: DVec3 = self.segments().iter().map(|segment| integral(segment, segment.from, segment.to, swept)).sum();
        let (from, to) = self.range();
        let [start, end] = [self.segments()[0].derivatives::<1>(from)[0], self.end(to)];
        sum + (end - origin).cross(start - origin) / 2.0
    }

    /// Enclosed area, square metres: of a simple loop run counter-clockwise about the frame's normal it is positive.
    pub fn area(&self) -> f64 {
        self.area_vector().dot(self.frame().normal)
    }

    fn end(&self, to: f64) -> DVec3 {
        self.segments()[self.segments().len() - 1].derivatives::<1>(to)[0]
    }

    /// The point of the section nearest to `point`.
    ///
    /// Each segment is sampled at `16 (J+1)` steps and every local minimum refined by Newton's method inside its two
    /// steps, with halving where it leaves them, to 1e-14 of a step. A dip between two samples that shows in neither
    /// may be missed. The first along the curve where several are equally near.
    pub fn nearest(&self, point: DVec3) -> NearestPoint {
        let mut best =
            NearestPoint { angle: self.range().0, point: self.point(self.range().0), distance: f64::INFINITY };
        for segment in self.segments() {
            let steps = 16 * (segment.series.harmonics() + 1);
            let angle = |i: usize| segment.from + (segment.to - segment.from) * i as f64 / steps as f64;
            let distances: Vec<f64> =
                (0..=steps).map(|i| segment.derivatives::<1>(angle(i))[0].distance_squared(point)).collect();
            for i in 0..=steps {
                let (low, high) = (i.saturating_sub(1), (i + 1).min(steps));
                if distances[i] > distances[low] || distances[i] > distances[high] {
                    continue;
                }
                let found = refined(segment, point, angle(low), angle(high));
                if found.distance < best.distance {
                    best = found;
                }
            }
        }
        best
    }
}

/// The nearest point between two angles, by the zero of the derivative of the squared distance.
fn refined(segment: &EllipticSegment, target: DVec3, mut low: f64, mut high: f64) -> NearestPoint {
    let at = |angle: f64| {
        let point = segment.derivatives::<1>(angle)[0];
        NearestPoint { angle, point, distance: point.distance(target) }
    };
    let mut best = if at(high).distance < at(low).distance { at(high) } else { at(low) };
    let width = high - low;
    let mut angle = 0.5 * (low + high);
    for _ in 0..100 {
        let [point, speed, acceleration] = segment.derivatives::<3>(angle);
        let slope = (point - target).dot(speed);
        if slope > 0.0 {
            high = angle;
        } else {
            low = angle;
        }
        let newton = angle - slope / (speed.length_squared() + (point - target).dot(acceleration));
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        let moved = (next - angle).abs();
        angle = next;
        if moved <= REFINED * width {
            break;
        }
    }
    let found = at(angle);
    if found.distance < best.distance {
        best = found;
    }
    best
}

fn integral(segment: &EllipticSegment, from: f64, to: f64, f: impl Fn([DVec3; 2]) -> DVec3) -> DVec3 {
    let panels = 16 * (segment.series.harmonics() + 1);
    let half = 0.5 * (to - from) / panels as f64;
    let panel = |i: usize| {
        let middle = from + (2 * i + 1) as f64 * half;
        let pair = |(node, weight): (f64, f64)| {
            let [left, right] = [-node, node].map(|node| f(segment.derivatives::<2>(middle + node * half)));
            (left + right) * weight
        };
        GAUSS.into_iter().map(pair).sum::<DVec3>()
    };
    (0..panels).map(panel).sum::<DVec3>() * half
}

#[cfg(test)]
mod tests {
    use super::super::{PlaneFrame, Series};
    use super::*;
    use std::f64::consts::{PI, TAU};

    fn section(coefficients: Vec<DVec3>, closed: bool) -> EllipticSection {
        let series = Series::new(coefficients).unwrap();
        let to = if closed { TAU } else { PI };
        let segment = EllipticSegment { from: 0.0, to, local: false, series };
        EllipticSection::new(PlaneFrame::new(DVec3::ZERO, DVec3::Z), closed, vec![segment]).unwrap()
    }

    #[test]
    fn length_of_ellipses() {
        let ellipse = section(vec![DVec3::ONE, DVec3::X * 4.0, DVec3::Y], true);
        // Complete elliptic integral: 4 a E(15/16).
        assert!((ellipse.length() - 17.156_843_550_313_66).abs() < 1e-9, "{:.15}", ellipse.length());
        let circle = section(vec![DVec3::ONE, DVec3::X * 2.0, DVec3::Y * 2.0], true);
        assert!((circle.length_between(0.5, 1.7) - 2.4).abs() < 1e-13);
        assert!((circle.length_between(1.7, 0.5) + 2.4).abs() < 1e-13);
        let arc = section(vec![DVec3::ZERO, DVec3::X, DVec3::Y], false);
        assert!((arc.length() - PI).abs() < 1e-13);
        assert!((arc.area() - PI / 2.0).abs() < 1e-13);
    }

    #[test]
    fn area_in_segments_is_that_of_the_whole() {
        let c = |i: f64| DVec3::new((3.0 * i).cos(), (5.0 * i).sin(), 0.0) / (1.0 + i * i);
        let whole = section((0..9).map(|i| c(f64::from(i))).collect(), true);
        let series = &whole.segments()[0].series;
        let part = |from, to| EllipticSegment { from, to, local: false, series: series.clone() };
        let parts = EllipticSection::new(*whole.frame(), true, vec![part(0.4, 2.0), part(2.0, 0.4 + TAU)]).unwrap();
        assert!((parts.area() - whole.area()).abs() < 1e-12);
        assert!((parts.length() - whole.length()).abs() < 1e-8);
    }

    #[test]
    fn nearest_points_beside_inside_and_beyond_the_end() {
        let ellipse = section(vec![DVec3::ZERO, DVec3::X * 3.0, DVec3::Y * 2.0], true);
        for v in [0.0, 0.3, 1.0, PI, 4.0, 6.2] {
            for offset in [-0.5, -1e-9, 0.7] {
                let there = ellipse.point(v) + ellipse.normal(v) * offset;
                let found = ellipse.nearest(there);
                assert!(found.point.distance(ellipse.point(v)) < 1e-7, "{v} {offset}: {found:?}");
                assert!((found.distance - offset.abs()).abs() < 1e-12);
            }
        }
        let arc = section(vec![DVec3::ZERO, DVec3::X, DVec3::Y], false);
        assert_eq!(arc.nearest(DVec3::new(2.0, -1.0, 0.0)).angle, 0.0);
        assert!(arc.nearest(DVec3::NAN).point.is_finite());
        // Brute force over a curve with many dips.
        let c = |i: f64| DVec3::new((3.0 * i).cos(), (5.0 * i).sin(), 0.0) / (1.0 + i);
        let wavy = section((0..15).map(|i| c(f64::from(i))).collect(), true);
        let dense = wavy.sampled(40_000);
        for i in 0..50 {
            let t = f64::from(i);
            let target = DVec3::new((1.3 * t).sin(), (2.1 * t).cos(), 0.2);
            let least = dense.iter().map(|p| p.distance(target)).fold(f64::INFINITY, f64::min);
            let found = wavy.nearest(target).distance;
            assert!(found <= least + 1e-12 && found > least - 1e-4, "{i}: {found} {least}");
        }
    }
}
