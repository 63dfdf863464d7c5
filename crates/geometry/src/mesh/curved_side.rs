//! A side of a polygon, bent as the normals at its ends tell.

use glam::DVec3;

use super::Mesh;

/// Cosine of the largest angle between the normals at the ends of a side that is bent: beyond it they are those of an
/// edge, not of a round shape.
const LEAST_COSINE: f64 = 0.5;

/// Largest distance of the normals of two corners at a vertex that count as one.
const ONE_NORMAL: f64 = 1e-6;

/// The one normal of each vertex, zero where its corners have several: at hard edges, and without normals.
pub(crate) fn vertex_normals(mesh: &Mesh) -> Vec<DVec3> {
    let mut found = vec![DVec3::ZERO; mesh.positions().len()];
    let Some(normals) = mesh.normals() else { return found };
    let mut several = vec![false; found.len()];
    for (vertex, normal) in mesh.corners().iter().zip(normals) {
        let vertex = *vertex as usize;
        if found[vertex] == DVec3::ZERO {
            found[vertex] = *normal;
        }
        several[vertex] |= found[vertex].distance(*normal) > ONE_NORMAL;
    }
    for (normal, _) in found.iter_mut().zip(several).filter(|(_, several)| *several) {
        *normal = DVec3::ZERO;
    }
    found
}

/// The cubic from one end of a side to the other that is square to the normals at both (the sides of Vlachos, Peters,
/// Boyd and Mitchell's curved PN triangles, 2001): off a round surface by the fourth power of the side's length, where
/// the straight side is by the second. Straight where an end has no normal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CurvedSide {
    points: [DVec3; 4],
    bent: bool,
}

impl CurvedSide {
    pub(crate) fn new([from, to]: [DVec3; 2], normals: [DVec3; 2]) -> Self {
        let third = (to - from) / 3.0;
        let bent = normals[0].dot(normals[1]) > LEAST_COSINE;
        let [a, b] = if bent { normals.map(|normal| third - normal * third.dot(normal)) } else { [third; 2] };
        Self { points: [from, from + a, to - b, to], bent }
    }

    /// The point at the share `t` of the way, 0 to 1.
    pub(crate) fn at(&self, t: f64) -> DVec3 {
        let s = 1.0 - t;
        let [a, b, c, d] = self.points;
        a * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + d * (t * t * t)
    }

    /// The unit direction there, or zero where the side is straight: then its normals are not those of a round shape.
    pub(crate) fn bent_along(&self, t: f64) -> DVec3 {
        let s = 1.0 - t;
        let [a, b, c, d] = self.points;
        if !self.bent {
            return DVec3::ZERO;
        }
        ((b - a) * (s * s) + (c - b) * (2.0 * s * t) + (d - c) * (t * t)).normalize_or_zero()
    }

    /// The share at which `inside` changes, between its ends of which the first is inside if `first`: by halving, so that
    /// it is the same whichever side of a cut is asked for.
    pub(crate) fn crossing(&self, first: bool, inside: impl Fn(DVec3) -> bool) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..52 {
            let middle = 0.5 * (low + high);
            if inside(self.at(middle)) == first { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_side_of_a_circle_is_bent_like_it() {
        for angle in [0.05_f64, 0.1, 0.2] {
            let ends = [DVec3::X, DVec3::new(angle.cos(), angle.sin(), 0.0)];
            let side = CurvedSide::new(ends, ends);
            let off = (0..=20).map(|k| (side.at(f64::from(k) / 20.0).length() - 1.0).abs()).fold(0.0, f64::max);
            let straight = 1.0 - (angle / 2.0).cos();
            let place = side.at(0.3);
            assert!(side.bent_along(0.3).dot(place).abs() < 0.1 * angle.powi(3));
            assert!(off < 0.1 * angle.powi(4) && off < 0.05 * straight, "{angle}: {off} of {straight}");
        }
        // An edge stays straight, and so does a side without normals.
        for normals in [[DVec3::Z, DVec3::X], [DVec3::ZERO; 2]] {
            let side = CurvedSide::new([DVec3::ZERO, DVec3::Y], normals);
            assert!(side.at(0.3).distance(DVec3::Y * 0.3) < 1e-15);
            assert!(side.bent_along(0.3).length() < 1e-15);
        }
    }

    #[test]
    fn the_crossing_is_the_same_from_both_sides() {
        let ends = [DVec3::X, DVec3::new(0.9_f64.cos(), 0.9_f64.sin(), 0.0)];
        let side = CurvedSide::new(ends, ends);
        let share = side.crossing(true, |p| p.y < 0.31);
        assert_eq!(share, side.crossing(false, |p| p.y >= 0.31));
        assert!((side.at(share).y - 0.31).abs() < 1e-14);
    }
}
