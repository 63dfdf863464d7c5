//! Sections that cross each other.

use glam::DVec3;

use super::error::SurfaceWarning;
use crate::trigonometric::EllipticSection;

/// Pairs of closed sections that cross each other inside both, taken as flat: each in the plane through its mean along
/// which it encloses most area.
///
/// Every pair is compared whose boxes meet. The line in which two planes meet is cut by both outlines (polygons of
/// `8 (J+1)` points, 64 at least); where an inside of one overlaps an inside of the other, they cross. Stretches below
/// 1e-6 of the sections' size don't count: neighbours may touch.
pub(crate) fn find(sections: &[EllipticSection]) -> Vec<SurfaceWarning> {
    let outlines: Vec<Option<Outline>> = sections.iter().map(Outline::new).collect();
    let mut found = Vec::new();
    for (first, a) in outlines.iter().enumerate() {
        for (second, b) in outlines.iter().enumerate().skip(first + 1) {
            if let (Some(a), Some(b)) = (a, b)
                && a.low.cmple(b.high).all()
                && b.low.cmple(a.high).all()
                && let Some((at, length)) = crossing(a, b)
            {
                found.push(SurfaceWarning::CrossingSections { first, second, at, length });
            }
        }
    }
    found
}

struct Outline {
    points: Vec<DVec3>,
    mean: DVec3,
    normal: DVec3,
    low: DVec3,
    high: DVec3,
}

impl Outline {
    /// `None` where the section is open or encloses nothing.
    fn new(section: &EllipticSection) -> Option<Self> {
        if !section.is_closed() {
            return None;
        }
        let points = section.sampled((8 * (section.harmonics() + 1) * section.segments().len()).max(64));
        let (low, high) =
            points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)));
        let area = section.area_vector();
        let normal = area.try_normalize().filter(|_| area.length() > 1e-9 * (high - low).length_squared())?;
        let mean = points.iter().sum::<DVec3>() / points.len() as f64;
        Some(Self { points, mean, normal, low, high })
    }

    /// Places along a line, as distances from `origin`, at which the outline (laid along the line) passes through the
    /// plane of another, ascending; every second stretch between them is inside.
    fn cuts(&self, other: &Self, origin: DVec3, direction: DVec3) -> Vec<f64> {
        let height = |p: DVec3| (p - other.mean).dot(other.normal);
        let count = self.points.len();
        let mut cuts: Vec<f64> = (0..count)
            .filter_map(|i| {
                let (p, q) = (self.points[i], self.points[(i + 1) % count]);
                let (a, b) = (height(p), height(q));
                // A point in the plane counts as above it, so that touching makes no odd number of cuts.
                ((a >= 0.0) != (b >= 0.0)).then(|| (p.lerp(q, a / (a - b)) - origin).dot(direction))
            })
            .collect();
        cuts.sort_by(f64::total_cmp);
        cuts
    }
}

/// The middle and length of the longest stretch that is inside both outlines.
fn crossing(a: &Outline, b: &Outline) -> Option<(DVec3, f64)> {
    let direction = a.normal.cross(b.normal);
    let square = direction.length_squared();
    if square < 1e-16 {
        return None;
    }
    // The point of both planes nearest to the middle between the means.
    let middle = 0.5 * (a.mean + b.mean);
    let (ha, hb) = ((a.mean - middle).dot(a.normal), (b.mean - middle).dot(b.normal));
    let origin = middle + (ha * b.normal.cross(direction) + hb * direction.cross(a.normal)) / square;
    let direction = direction / square.sqrt();
    let (of_a, of_b) = (a.cuts(b, origin, direction), b.cuts(a, origin, direction));
    let least = 1e-6 * (a.high - a.low).length().max((b.high - b.low).length());
    let mut longest: Option<(f64, f64)> = None;
    for p in of_a.chunks_exact(2) {
        for q in of_b.chunks_exact(2) {
            let (from, to) = (p[0].max(q[0]), p[1].min(q[1]));
            if to - from > least && longest.is_none_or(|(x, y)| to - from > y - x) {
                longest = Some((from, to));
            }
        }
    }
    longest.map(|(from, to)| (origin + 0.5 * (from + to) * direction, to - from))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trigonometric::{EllipticSegment, PlaneFrame, Series};
    use std::f64::consts::TAU;

    fn circle(centre: DVec3, tilt: f64, radius: f64) -> EllipticSection {
        let (s, c) = tilt.sin_cos();
        let series = Series::new(vec![centre, DVec3::new(c, s, 0.0) * radius, DVec3::NEG_Z * radius]).unwrap();
        let segment = EllipticSegment { from: 0.0, to: TAU, local: false, series };
        EllipticSection::new(PlaneFrame::new(centre, DVec3::Y), true, vec![segment]).unwrap()
    }

    #[test]
    fn tilted_sections_cross_where_their_planes_meet_inside() {
        // The plane of the second goes through height 0 at x = -0.5, inside of both.
        let tilt = 0.4_f64;
        let (first, second) = (circle(DVec3::ZERO, 0.0, 1.0), circle(DVec3::Y * 0.5 * tilt.tan(), tilt, 1.0));
        let found = find(&[first.clone(), second]);
        let [SurfaceWarning::CrossingSections { first: 0, second: 1, at, length }] = found[..] else {
            panic!("{found:?}")
        };
        assert!(at.distance(DVec3::X * -0.5) < 2e-3, "{at}");
        assert!((length - 2.0 * (1.0 - (0.5 / tilt.cos()).powi(2)).sqrt()).abs() < 5e-3, "{length}");
        let text = found[0].to_string();
        assert!(text.starts_with("sections 0 and 1 cross each other over 1.6"), "{text}");
        // Higher up the planes meet outside.
        assert_eq!(find(&[first, circle(DVec3::Y * 1.2 * tilt.tan(), tilt, 1.0)]), []);
    }

    #[test]
    fn stacks_and_sections_apart_do_not_cross() {
        let stack: Vec<EllipticSection> = (0..30).map(|i| circle(DVec3::Y * 0.1 * f64::from(i), 0.0, 1.0)).collect();
        assert_eq!(find(&stack), []);
        // Planes meet inside the first only: the second is far to the side.
        assert_eq!(find(&[circle(DVec3::ZERO, 0.0, 1.0), circle(DVec3::X * 1.9, 1.5, 0.5)]), []);
        // A bow that comes back and runs through itself.
        let bow = |angle: f64, radius: f64| circle(DVec3::new(angle.cos(), angle.sin(), 0.0), angle, radius);
        let crossed: Vec<EllipticSection> = (0..12).map(|i| bow(f64::from(i) * 0.3, 1.2)).collect();
        assert!(find(&crossed).len() > 50);
        let free: Vec<EllipticSection> = (0..12).map(|i| bow(f64::from(i) * 0.3, 0.8)).collect();
        assert_eq!(find(&free), []);
    }
}
