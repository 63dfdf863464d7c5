//! Triangles of a flat polygon by clipping its best ear again and again.

use glam::DVec2;
use robust::{Coord, orient2d};

/// Cuts a counter-clockwise polygon into `points.len() - 2` triangles of point indices (none for fewer than three).
///
/// Every point stays a corner, also those in the middle of a straight side: the usual ear-cutting libraries drop these,
/// which would open a closed mesh along such a side. Orientation tests are exact, so that a simple polygon always gives
/// triangles that face its way and tile it. For a polygon that crosses itself the count holds, not the tiling.
/// Takes time proportional to the square of the number of points.
pub(crate) fn ear_clip(points: &[DVec2]) -> Vec<[usize; 3]> {
    let count = points.len();
    if count < 3 {
        return Vec::new();
    }
    let mut ring = Ring {
        points,
        previous: (0..count).map(|i| (i + count - 1) % count).collect(),
        next: (0..count).map(|i| (i + 1) % count).collect(),
        blunt: vec![false; count],
    };
    for i in 0..count {
        ring.blunt[i] = ring.turn(i) <= 0.0;
    }
    let mut ears: Vec<Option<f64>> = (0..count).map(|i| ring.ear(i)).collect();
    let mut alive: Vec<usize> = (0..count).collect();
    let mut triangles = Vec::with_capacity(count - 2);
    while alive.len() > 3 {
        let mut best = best(&alive, &ears);
        if best.is_none() {
            // A point stops blocking others when it turns convex, and they are not told.
            for &i in &alive {
                ears[i] = ring.ear(i);
            }
            best = self::best(&alive, &ears);
        }
        let at = best.unwrap_or_else(|| ring.least_bad(&alive));
        let i = alive[at];
        let (before, after) = (ring.previous[i], ring.next[i]);
        triangles.push([before, i, after]);
        alive.remove(at);
        ring.next[before] = after;
        ring.previous[after] = before;
        ring.blunt[i] = false;
        for neighbour in [before, after] {
            ring.blunt[neighbour] = ring.turn(neighbour) <= 0.0;
        }
        for neighbour in [before, after] {
            ears[neighbour] = ring.ear(neighbour);
        }
    }
    triangles.push([alive[0], alive[1], alive[2]]);
    triangles
}

/// Place in `alive` of the ear with the best shape.
fn best(alive: &[usize], ears: &[Option<f64>]) -> Option<usize> {
    let mut best: Option<(usize, f64)> = None;
    for (at, &i) in alive.iter().enumerate() {
        if let Some(shape) = ears[i]
            && best.is_none_or(|(_, other)| shape > other)
        {
            best = Some((at, shape));
        }
    }
    best.map(|(at, _)| at)
}

struct Ring<'a> {
    points: &'a [DVec2],
    previous: Vec<usize>,
    next: Vec<usize>,
    /// Points with an inner angle of 180 degrees or more: the only ones that can block an ear.
    blunt: Vec<bool>,
}

impl Ring<'_> {
    fn turn(&self, i: usize) -> f64 {
        side(self.points[self.previous[i]], self.points[i], self.points[self.next[i]])
    }

    /// The shape of the triangle at `i` (1.15 for an equilateral one, 0 for a flat one), if it is an ear.
    fn ear(&self, i: usize) -> Option<f64> {
        let [a, b, c] = self.triangle(i);
        let turn = self.turn(i);
        if turn.is_nan() || turn <= 0.0 {
            return None;
        }
        let blocked = (0..self.points.len()).filter(|k| self.blunt[*k]).any(|k| {
            let p = self.points[k];
            p != a && p != b && p != c && side(a, b, p) >= 0.0 && side(b, c, p) >= 0.0 && side(c, a, p) >= 0.0
        });
        (!blocked).then(|| self.shape(i))
    }

    fn triangle(&self, i: usize) -> [DVec2; 3] {
        [self.points[self.previous[i]], self.points[i], self.points[self.next[i]]]
    }

    fn shape(&self, i: usize) -> f64 {
        let [a, b, c] = self.triangle(i);
        let longest = a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a));
        2.0 * (b - a).perp_dot(c - a) / longest.max(f64::MIN_POSITIVE)
    }

    /// The point to clip where the polygon has no ear because it crosses itself: the one with the largest turn.
    fn least_bad(&self, alive: &[usize]) -> usize {
        let mut best = (0, f64::NEG_INFINITY);
        for (at, &i) in alive.iter().enumerate() {
            let shape = self.shape(i);
            if shape > best.1 {
                best = (at, shape);
            }
        }
        best.0
    }
}

/// Positive where `c` lies left of the line from `a` to `b`; the sign is exact.
fn side(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let coord = |p: DVec2| Coord { x: p.x, y: p.y };
    orient2d(coord(a), coord(b), coord(c))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(points: &[(f64, f64)]) -> Vec<DVec2> {
        points.iter().map(|(x, y)| DVec2::new(*x, *y)).collect()
    }

    fn double_area(points: &[DVec2]) -> f64 {
        (0..points.len()).map(|i| points[i].perp_dot(points[(i + 1) % points.len()])).sum()
    }

    /// All triangles counter-clockwise, together as large as the polygon, and each side of the polygon on one of them.
    fn assert_tiles(points: &[DVec2]) {
        let triangles = ear_clip(points);
        assert_eq!(triangles.len(), points.len() - 2);
        let areas: Vec<f64> = triangles.iter().map(|t| side(points[t[0]], points[t[1]], points[t[2]])).collect();
        assert!(areas.iter().all(|a| *a > 0.0), "{areas:?}");
        let total: f64 = areas.iter().sum();
        assert!((total - double_area(points)).abs() < 1e-12 * total, "{total} for {}", double_area(points));
        for i in 0..points.len() {
            let next = (i + 1) % points.len();
            let uses = triangles.iter().filter(|t| (0..3).any(|k| t[k] == i && t[(k + 1) % 3] == next)).count();
            assert_eq!(uses, 1, "side {i}");
        }
    }

    #[test]
    fn concave_polygons_are_tiled() {
        assert_tiles(&polygon(&[(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (2.0, 0.5), (0.0, 3.0)]));
        let star: Vec<DVec2> = (0..40)
            .map(|i| DVec2::from_angle(i as f64 * std::f64::consts::TAU / 40.0) * if i % 2 == 0 { 1.0 } else { 0.3 })
            .collect();
        assert_tiles(&star);
    }

    #[test]
    fn a_spiral_is_tiled() {
        let arm = |offset: f64, i: usize| DVec2::from_angle(i as f64 * 0.15) * (1.0 + offset + 0.1 * i as f64 * 0.15);
        let mut points: Vec<DVec2> = (0..120).map(|i| arm(0.3, i)).collect();
        points.extend((0..120).rev().map(|i| arm(0.0, i)));
        assert_tiles(&points);
    }

    #[test]
    fn points_on_straight_sides_stay_corners() {
        let mut points = Vec::new();
        for (from, to) in [((0.0, 0.0), (1.0, 0.0)), ((1.0, 0.0), (1.0, 1.0)), ((1.0, 1.0), (0.0, 0.0))] {
            points.extend((0..8).map(|k| DVec2::from(from).lerp(DVec2::from(to), k as f64 / 8.0)));
        }
        assert_tiles(&points);
    }

    #[test]
    fn a_polygon_that_crosses_itself_still_gives_its_count() {
        assert_eq!(ear_clip(&polygon(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)])).len(), 2);
        assert_eq!(ear_clip(&polygon(&[(0.0, 0.0); 7])).len(), 5);
        assert!(ear_clip(&polygon(&[(0.0, 0.0), (1.0, 0.0)])).is_empty());
    }
}
