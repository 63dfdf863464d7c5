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
    let mut inside = false;
    for (k, a) in corners.iter().enumerate() {
        let b = corners[(k + 1) % corners.len()];
        if (a.y > point.y) != (b.y > point.y) && point.x < a.x + (b.x - a.x) * (point.y - a.y) / (b.y - a.y) {
            inside = !inside;
        }
    }
    inside
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(corners: &[[f64; 2]]) -> Vec<DVec2> {
        corners.iter().map(|corner| DVec2::from(*corner)).collect()
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
