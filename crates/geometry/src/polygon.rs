//! Flat polygons: lists of corners whose last is joined to the first.

use glam::DVec2;

/// The area of a polygon, positive where it runs counter-clockwise; that of one that crosses itself counts each region
/// as often as it is run around. Zero for less than three corners.
///
/// Cross products are taken from the first corner, so that a small polygon far from the origin keeps its digits.
pub(crate) fn signed_area(corners: &[DVec2]) -> f64 {
    let Some(&origin) = corners.first() else { return 0.0 };
    corners.windows(2).map(|side| (side[0] - origin).perp_dot(side[1] - origin)).sum::<f64>() / 2.0
}

/// Whether a point lies inside a polygon, by the even-odd rule: of one that crosses itself, a region that is run around
/// twice is outside. A point on a side lies on either side of it.
pub(crate) fn encloses(corners: &[DVec2], point: DVec2) -> bool {
    let met = |k: &usize| leaves_on_the_right([corners[*k], corners[(*k + 1) % corners.len()]], point);
    (0..corners.len()).filter(met).count() % 2 == 1
}

/// Whether a side is met by what leads from a point to the right.
fn leaves_on_the_right([a, b]: [DVec2; 2], point: DVec2) -> bool {
    (a.y > point.y) != (b.y > point.y) && point.x < a.x + (b.x - a.x) * (point.y - a.y) / (b.y - a.y)
}

/// Most slabs into which a polygon is parted: of one that goes up and down, every side is in all of them.
const SLABS: usize = 64;

/// A polygon that is asked often what it encloses: its sides by height.
pub(crate) struct Inside {
    low: DVec2,
    high: DVec2,
    sides: Vec<[DVec2; 2]>,
    /// Of slabs of equal height, one over the other, the sides that reach into each.
    slabs: Vec<Vec<u32>>,
}

impl Inside {
    pub(crate) fn new(corners: &[DVec2]) -> Self {
        let (low, high) =
            corners.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)));
        let sides: Vec<_> = (0..corners.len()).map(|k| [corners[k], corners[(k + 1) % corners.len()]]).collect();
        let mut inside = Self { low, high, slabs: vec![Vec::new(); SLABS.min(sides.len())], sides };
        for (side, [a, b]) in inside.sides.iter().enumerate() {
            for slab in inside.slab(a.y.min(b.y))..=inside.slab(a.y.max(b.y)) {
                inside.slabs[slab].push(side as u32);
            }
        }
        inside
    }

    /// The corners of the box around it.
    pub(crate) fn bounds(&self) -> (DVec2, DVec2) {
        (self.low, self.high)
    }

    /// The slab at a height: of two heights, the higher one is never in the lower slab.
    fn slab(&self, y: f64) -> usize {
        let share = (y - self.low.y) / (self.high.y - self.low.y);
        // Nothing that is not a number comes out of it: it becomes 0.
        ((share * self.slabs.len() as f64) as usize).min(self.slabs.len() - 1)
    }

    /// As [`encloses`].
    pub(crate) fn encloses(&self, point: DVec2) -> bool {
        if !(point.cmpge(self.low).all() && point.cmple(self.high).all()) {
            return false;
        }
        let near = self.slabs[self.slab(point.y)].iter();
        near.filter(|side| leaves_on_the_right(self.sides[**side as usize], point)).count() % 2 == 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(corners: &[[f64; 2]]) -> Vec<DVec2> {
        corners.iter().map(|corner| DVec2::from(*corner)).collect()
    }

    #[test]
    fn sides_by_height_enclose_the_same_points() {
        // A star that crosses itself, a flat polygon, none.
        let star: Vec<DVec2> =
            (0..41).map(|k| DVec2::from_angle(2.4 * f64::from(k)) * (1.0 + 0.01 * f64::from(k % 7))).collect();
        let flat = polygon(&[[0.0, 0.5], [1.0, 0.5], [0.5, 0.5]]);
        for corners in [star, flat, polygon(&[])] {
            let inside = Inside::new(&corners);
            let mut within = 0;
            for i in 0..=120 {
                for j in 0..=120 {
                    let at = DVec2::new(f64::from(i) / 40.0 - 1.5, f64::from(j) / 40.0 - 1.5);
                    assert_eq!(inside.encloses(at), encloses(&corners, at), "{at}");
                    within += usize::from(inside.encloses(at));
                }
            }
            assert_eq!(within > 1000, corners.len() == 41, "{within}");
            for corner in &corners {
                assert_eq!(inside.encloses(*corner), encloses(&corners, *corner), "{corner}");
            }
        }
    }

    #[test]
    fn the_area_has_the_sign_of_the_way_around() {
        let mut square = polygon(&[[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]);
        assert_eq!(signed_area(&square), 4.0);
        let twice = [square.clone(), square.clone()].concat();
        assert_eq!(signed_area(&twice), 8.0);
        square.reverse();
        assert_eq!(signed_area(&square), -4.0);
        assert_eq!(signed_area(&polygon(&[[0.0, 0.0], [1.0, 0.0], [0.0, 3.0]])), 1.5);
        for few in 0..3 {
            assert_eq!(signed_area(&square[..few]), 0.0);
        }
    }

    #[test]
    fn the_area_keeps_its_digits_far_away() {
        let far = DVec2::new(1e6, -1e6);
        let small: Vec<DVec2> =
            polygon(&[[0.0, 0.0], [1e-3, 0.0], [1e-3, 1e-3], [0.0, 1e-3]]).into_iter().map(|p| p + far).collect();
        assert!((signed_area(&small) - 1e-6).abs() < 1e-12, "{}", signed_area(&small));
    }

    #[test]
    fn a_bracket_encloses_its_arms_and_not_its_mouth() {
        let mut bracket = polygon(&[
            [-1.0, -2.0],
            [3.0, -2.0],
            [3.0, -1.0],
            [0.0, -1.0],
            [0.0, 1.0],
            [3.0, 1.0],
            [3.0, 2.0],
            [-1.0, 2.0],
        ]);
        for _ in 0..2 {
            for inside in [[-0.5, 0.0], [2.0, -1.5], [2.0, 1.5]] {
                assert!(encloses(&bracket, DVec2::from(inside)), "{inside:?}");
            }
            for outside in [[1.0, 0.0], [-2.0, 0.0], [4.0, 1.5], [0.0, 3.0], [0.0, -3.0]] {
                assert!(!encloses(&bracket, DVec2::from(outside)), "{outside:?}");
            }
            bracket.reverse();
        }
        assert!(!encloses(&[], DVec2::ZERO));
    }

    #[test]
    fn what_is_run_around_twice_is_outside() {
        // A pentagram: its points are inside, its middle is not.
        let star: Vec<DVec2> =
            (0..5).map(|k| DVec2::from_angle(std::f64::consts::TAU * f64::from(2 * k) / 5.0)).collect();
        assert!(!encloses(&star, DVec2::ZERO));
        assert!(encloses(&star, DVec2::new(0.8, 0.0)));
    }
}
