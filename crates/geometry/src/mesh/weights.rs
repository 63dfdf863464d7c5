//! Weights of edges and areas of vertices, for discrete operators on triangles.

use glam::DVec3;

/// Least excess of the sum of two sides over the third, as a fraction of the longest side, with which a triangle is
/// measured.
const LEAST_EXCESS: f64 = 1e-4;

/// Cotangents of the angles of a triangle, in the order of its corners, and its area in square metres.
///
/// A triangle that is nearly flat is measured as one whose sides are all longer by the same small length, so that the sum
/// of two sides exceeds the third by 1e-4 of the longest (Sharp and Crane, A Laplacian for Nonmanifold Triangle Meshes,
/// 2020, there with one length for the mesh): cotangents stay below some ten thousand. A triangle whose corners are one
/// point has cotangents and area 0.
pub fn cotangents(points: [DVec3; 3]) -> ([f64; 3], f64) {
    let [a, b, c] = points;
    let sides = [b.distance(c), c.distance(a), a.distance(b)];
    let longest = sides[0].max(sides[1]).max(sides[2]);
    let excess = sides[0] + sides[1] + sides[2] - 2.0 * longest;
    if longest == 0.0 {
        return ([0.0; 3], 0.0);
    }
    if excess > LEAST_EXCESS * longest {
        let double = (b - a).cross(c - a).length();
        let cotangent = |p: DVec3, q: DVec3, r: DVec3| (q - p).dot(r - p) / double;
        return ([cotangent(a, b, c), cotangent(b, c, a), cotangent(c, a, b)], 0.5 * double);
    }
    let longer = LEAST_EXCESS * longest - excess;
    let [p, q, r] = sides.map(|side| side + longer);
    // Heron's formula; the factors are positive and none suffers from cancellation worse than `LEAST_EXCESS`.
    let area = 0.25 * ((p + q + r) * (q + r - p) * (r + p - q) * (p + q - r)).max(0.0).sqrt();
    let cotangent = |own: f64, left: f64, right: f64| (left * left + right * right - own * own) / (4.0 * area);
    ([cotangent(p, q, r), cotangent(q, r, p), cotangent(r, p, q)], area)
}

/// The share of a triangle's area that each of its corners has, in square metres (Meyer, Desbrun, Schröder and Barr,
/// Discrete Differential-Geometry Operators, 2003): its Voronoi cell, and where an angle is obtuse, one half of the
/// triangle for that corner and a quarter for the others. Shares are positive and add up to the area.
pub fn mixed_areas(points: [DVec3; 3]) -> [f64; 3] {
    let (cotangents, area) = cotangents(points);
    if let Some(obtuse) = cotangents.iter().position(|cotangent| *cotangent < 0.0) {
        let mut shares = [0.25 * area; 3];
        shares[obtuse] = 0.5 * area;
        return shares;
    }
    // |side|^2 cot(opposite angle) / 8 for both sides at a corner, the squares by the cotangents themselves, so that
    // the shares fit a triangle that is not measured as it is.
    let [a, b, c] = cotangents;
    let cell = |own: f64, next: f64, last: f64| (own + next) * last + (own + last) * next;
    let cells = [cell(a, b, c), cell(b, c, a), cell(c, a, b)];
    let sum: f64 = cells.iter().sum();
    if sum > 0.0 { cells.map(|cell| area * cell / sum) } else { [area / 3.0; 3] }
}

/// Mean-value weight of the edge from the first corner of a triangle to the second, as far as this triangle makes it, in
/// 1/m: the tangent of half the angle at the first corner, over the edge's length (Floater, Mean value coordinates,
/// 2003). The triangle on the other side of the edge adds its own. 0 where an edge has no length; never negative, and
/// not symmetric.
pub fn mean_value(points: [DVec3; 3]) -> f64 {
    let [a, b, c] = points;
    let (edge, other) = (b - a, c - a);
    let lengths = edge.length() * other.length();
    if lengths == 0.0 {
        return 0.0;
    }
    // tan(x / 2) = sin x / (1 + cos x), held below where the angle is straight.
    let (sine, cosine) = (edge.cross(other).length() / lengths, edge.dot(other) / lengths);
    sine / (1.0 + cosine).max(1e-12) / edge.length()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(points: [[f64; 2]; 3]) -> [DVec3; 3] {
        points.map(|[x, y]| DVec3::new(x, y, 3.0))
    }

    fn near(found: [f64; 3], wanted: [f64; 3]) {
        assert!(found.iter().zip(wanted).all(|(f, w)| (f - w).abs() < 1e-12), "{found:?}, wanted {wanted:?}");
    }

    #[test]
    fn cotangents_of_known_angles() {
        let (right, area) = cotangents(triangle([[0.0, 0.0], [2.0, 0.0], [0.0, 1.0]]));
        near(right, [0.0, 2.0, 0.5]);
        assert!((area - 1.0).abs() < 1e-12);
        let (even, _) = cotangents(triangle([[0.0, 0.0], [1.0, 0.0], [0.5, 0.75_f64.sqrt()]]));
        near(even, [1.0 / 3.0_f64.sqrt(); 3]);
        let (obtuse, _) = cotangents(triangle([[0.0, 0.0], [1.0, 0.0], [-1.0, 1.0]]));
        near(obtuse, [-1.0, 2.0, 3.0]);
    }

    #[test]
    fn needles_and_caps_have_finite_cotangents_and_area() {
        for flat in [
            [[0.0, 0.0], [1.0, 0.0], [0.5, 0.0]],
            [[0.0, 0.0], [1.0, 0.0], [1.0, 1e-12]],
            [[0.0, 0.0], [1.0, 0.0], [1.0, 0.0]],
            [[0.0, 0.0], [1.0, 0.0], [0.3, 1e-9]],
        ] {
            let (found, area) = cotangents(triangle(flat));
            assert!(found.iter().all(|c| c.abs() < 3e4), "{found:?}");
            assert!(area > 0.0 && area < 0.01, "{area}");
            let shares = mixed_areas(triangle(flat));
            assert!(shares.iter().all(|s| *s > 0.0), "{shares:?}");
            // The identity of the angles of a triangle holds for what was measured.
            let [a, b, c] = found;
            assert!((a * b + b * c + c * a - 1.0).abs() < 1e-6, "{found:?}");
        }
        assert_eq!(cotangents([DVec3::ONE; 3]), ([0.0; 3], 0.0));
        assert_eq!(mixed_areas([DVec3::ONE; 3]), [0.0; 3]);
    }

    #[test]
    fn areas_are_voronoi_cells_or_halves() {
        near(mixed_areas(triangle([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])), [0.25, 0.125, 0.125]);
        near(mixed_areas(triangle([[0.0, 0.0], [1.0, 0.0], [-1.0, 1.0]])), [0.25, 0.125, 0.125]);
        // By hand: circumcentre (1, 3/4) of a triangle with base 2 and height 2.
        let shares = mixed_areas(triangle([[0.0, 0.0], [2.0, 0.0], [1.0, 2.0]]));
        near(shares, [0.5 * 0.75 + 0.3125, 0.5 * 0.75 + 0.3125, 0.625]);
    }

    #[test]
    fn mean_value_weights_make_a_vertex_the_mean_of_its_ring() {
        let ring = [[1.0, 0.1], [0.2, 1.3], [-0.9, 0.4], [-0.3, -0.8], [0.8, -0.6]].map(|[x, y]| DVec3::new(x, y, 0.0));
        let mut sum = DVec3::ZERO;
        for i in 0..5 {
            let (own, next, last) = (ring[i], ring[(i + 1) % 5], ring[(i + 4) % 5]);
            let weight = mean_value([DVec3::ZERO, own, next]) + mean_value([DVec3::ZERO, own, last]);
            assert!(weight > 0.0);
            sum += weight * own;
        }
        assert!(sum.length() < 1e-14);
        assert_eq!(mean_value([DVec3::ZERO, DVec3::ZERO, DVec3::X]), 0.0);
    }
}
