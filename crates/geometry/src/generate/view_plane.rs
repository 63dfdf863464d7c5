//! The plane a pair of silhouettes was drawn in.

use glam::DVec3;

use crate::curve::Curve;

/// Largest distance of a pair's points from its plane that still counts as drawn in one view, in the pair's size.
const FLATNESS: f64 = 0.01;

/// Unit normal of the plane of two rails that run the same way, or none where they lie in no plane to within 1 % of
/// their size or enclose no area.
///
/// The normal is Newell's for the outline that runs up the one and down the other rail.
pub(super) fn view_normal(one: &Curve, other: &Curve) -> Option<DVec3> {
    let outline = one.points().iter().chain(other.points().iter().rev()).copied().collect();
    let outline = Curve::new("", outline, true).ok()?;
    let centre = outline.points().iter().copied().sum::<DVec3>() / outline.points().len() as f64;
    let (low, high) = outline.bounds();
    let size = (high - low).length();
    let area = outline.area_vector();
    if area.length() <= 1e-6 * size * size {
        return None;
    }
    let normal = area.normalize();
    outline.points().iter().all(|p| (*p - centre).dot(normal).abs() <= FLATNESS * size).then_some(normal)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rail(points: &[(f64, f64, f64)]) -> Curve {
        Curve::new("rail", points.iter().map(|p| DVec3::from(*p)).collect(), false).unwrap()
    }

    #[test]
    fn a_flat_pair_has_its_normal() {
        let left = rail(&[(1.0, 0.0, 0.2), (1.2, 1.0, 0.2), (1.0, 2.0, 0.2)]);
        let right = rail(&[(-1.0, 0.1, 0.2), (-0.7, 2.0, 0.2)]);
        assert!(view_normal(&left, &right).unwrap().z.abs() > 1.0 - 1e-12);
    }

    #[test]
    fn a_bent_or_empty_pair_has_none() {
        let left = rail(&[(1.0, 0.0, 0.0), (1.0, 1.0, 0.3), (1.0, 2.0, 0.0)]);
        let right = rail(&[(-1.0, 0.0, 0.0), (-1.0, 2.0, 0.0)]);
        assert_eq!(view_normal(&left, &right), None);
        assert_eq!(view_normal(&right, &right), None);
    }
}
