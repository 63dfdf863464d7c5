//! Depth of a subject seen from far away in one direction, to ask what light from there reaches.

use glam::{Vec2, Vec3};

/// Depth over which light fades behind an edge, in units of the subject's radius: hides the texels.
const SOFTNESS: f32 = 0.02;

/// Orthographic depth map in the subject's units (see [`super::subject::Subject`]).
#[derive(Clone, Debug)]
pub(super) struct ShadowMap {
    side: usize,
    towards: Vec3,
    right: Vec3,
    up: Vec3,
    low: Vec2,
    texels_per_unit: Vec2,
    /// Larger side of a texel.
    texel: f32,
    /// Nearest surface to the light, along `towards`; minus infinity where there is none.
    depth: Vec<f32>,
    /// The greatest depth of each texel and its eight neighbours: what lies above it is lit, without a closer look.
    highest: Vec<f32>,
}

impl ShadowMap {
    /// What light from `towards` (a unit vector) sees of triangles over `places`, all of which lie in the box
    /// `extents`, on `side` texels a side, at least 8.
    pub fn of(side: usize, towards: Vec3, extents: [Vec3; 2], places: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let (right, up) = towards.any_orthonormal_pair();
        let flat = |p: Vec3| Vec2::new(p.dot(right), p.dot(up));
        let [low, high] = extents;
        let reach = |axis: Vec3| (low * axis).min(high * axis).element_sum();
        let low = Vec2::new(reach(right), reach(up));
        let high = -Vec2::new(reach(-right), reach(-up));
        let extent = (high - low).max(Vec2::splat(1e-6));
        // Two texels stay free all around, so that filtering finds open sky behind the rim.
        let texels_per_unit = Vec2::splat((side - 4) as f32) / extent;
        let low = low - 2.0 / texels_per_unit;
        let texel = texels_per_unit.min_element().recip();
        let projected: Vec<Vec3> =
            places.iter().map(|p| ((flat(*p) - low) * texels_per_unit).extend(p.dot(towards))).collect();
        let depth = vec![f32::NEG_INFINITY; side * side];
        let mut map = Self { side, towards, right, up, low, texels_per_unit, texel, depth, highest: Vec::new() };
        for triangle in triangles {
            map.fill(triangle.map(|v| projected[v as usize]));
        }
        map.highest = highest_around(&map.depth, side);
        map
    }

    /// Writes one triangle, both sides alike. Texel centres are at halves.
    fn fill(&mut self, [a, b, c]: [Vec3; 3]) {
        // Coordinates are positive, so that casts round down; most triangles are small and meet no texel's centre.
        let low = a.min(b).min(c) + 0.5;
        let high = a.max(b).max(c) + 0.5;
        let (left, right) = (low.x as i32, high.x as i32);
        let (top, bottom) = (low.y as i32, high.y as i32);
        if left >= right || top >= bottom {
            return;
        }
        let (ab, ac) = (b - a, c - a);
        let area = ab.x * ac.y - ab.y * ac.x;
        if area == 0.0 {
            return;
        }
        let (to_b, to_c) = (Vec2::new(ac.y, -ac.x) / area, Vec2::new(-ab.y, ab.x) / area);
        let place = |x: i32| (x.max(0) as usize).min(self.side);
        for y in place(top)..place(bottom) {
            for x in place(left)..place(right) {
                let at = Vec2::new(x as f32 + 0.5 - a.x, y as f32 + 0.5 - a.y);
                let wb = at.dot(to_b);
                let wc = at.dot(to_c);
                // Slightly generous, so that rounding opens no gap between neighbours.
                if wb >= -1e-4 && wc >= -1e-4 && wb + wc <= 1.0001 {
                    let texel = &mut self.depth[y * self.side + x];
                    *texel = texel.max(a.z + wb * ab.z + wc * ac.z);
                }
            }
        }
    }

    /// Direction to the light.
    pub fn towards(&self) -> Vec3 {
        self.towards
    }

    /// Share of the light, 0 to 1, that reaches a surface at `place`; `cosine` is that between normal and light.
    ///
    /// Compares the nine texels around, weighted by a quadratic B-spline, with a bias that follows the slope.
    pub fn visibility(&self, place: Vec3, cosine: f32) -> f32 {
        let u = (place.dot(self.right) - self.low.x) * self.texels_per_unit.x;
        let v = (place.dot(self.up) - self.low.y) * self.texels_per_unit.y;
        let last = (self.side - 1) as f32;
        if !(u >= 1.0 && v >= 1.0 && u < last && v < last) {
            return 1.0;
        }
        let slope = ((1.0 - cosine * cosine).max(0.0).sqrt() / cosine.max(1e-3)).min(6.0);
        let level = place.dot(self.towards) + self.texel * (1.0 + 1.8 * slope);
        let (x, y) = (u as usize, v as usize);
        if self.highest[y * self.side + x] <= level {
            return 1.0;
        }
        let (across, down) = (spline(u - x as f32), spline(v - y as f32));
        let lit = |depth: f32| 1.0 - ((depth - level) * (1.0 / SOFTNESS)).clamp(0.0, 1.0);
        let mut sum = 0.0;
        for (row, weight) in down.iter().enumerate() {
            let first = (y + row - 1) * self.side + x - 1;
            let texels = &self.depth[first..first + 3];
            sum += weight * (across[0] * lit(texels[0]) + across[1] * lit(texels[1]) + across[2] * lit(texels[2]));
        }
        sum
    }
}

/// The maximum over 3 by 3 texels; at the border, where nothing is drawn, over those that are there.
fn highest_around(depth: &[f32], side: usize) -> Vec<f32> {
    let greater = |a: f32, b: f32| if a > b { a } else { b };
    let mut across = depth.to_vec();
    for (row, source) in across.chunks_mut(side).zip(depth.chunks(side)) {
        for (texel, around) in row.iter_mut().skip(1).zip(source.windows(3)) {
            *texel = greater(greater(around[0], around[1]), around[2]);
        }
    }
    let mut highest = across.clone();
    for row in 1..side - 1 {
        for texel in row * side..(row + 1) * side {
            highest[texel] = greater(greater(across[texel - side], across[texel]), across[texel + side]);
        }
    }
    highest
}

/// Weights of three texels in a row for a place between the sides of the middle one, 0 to 1.
fn spline(t: f32) -> [f32; 3] {
    let before = 0.5 * (1.0 - t) * (1.0 - t);
    let after = 0.5 * t * t;
    [before, 1.0 - before - after, after]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of side 1 at height 0.5 under a light from above, and a far corner to widen the map.
    fn roof() -> ShadowMap {
        let places = [
            Vec3::new(-0.5, 0.5, -0.5),
            Vec3::new(0.5, 0.5, -0.5),
            Vec3::new(0.5, 0.5, 0.5),
            Vec3::new(-0.5, 0.5, 0.5),
            Vec3::new(1.0, -1.0, 1.0),
        ];
        ShadowMap::of(256, Vec3::Y, [Vec3::NEG_ONE, Vec3::ONE], &places, &[[0, 1, 2], [0, 2, 3]])
    }

    #[test]
    fn dark_below_and_bright_beside_and_above() {
        let map = roof();
        assert!(map.visibility(Vec3::new(0.1, -0.5, 0.2), 1.0) < 1e-6);
        assert!(map.visibility(Vec3::new(0.7, -0.5, 0.2), 1.0) > 0.999_999);
        assert!(map.visibility(Vec3::new(0.1, 0.8, 0.2), 1.0) > 0.999_999);
        assert_eq!(map.visibility(Vec3::new(9.0, -0.5, 0.2), 1.0), 1.0);
    }

    #[test]
    fn a_surface_does_not_shade_itself() {
        let map = roof();
        for cosine in [1.0, 0.5, 0.2] {
            assert!(map.visibility(Vec3::new(0.123, 0.5, -0.2), cosine) > 0.999_999);
        }
    }

    #[test]
    fn nothing_drawn_shades_nothing() {
        let map = ShadowMap::of(256, Vec3::Z, [Vec3::ZERO; 2], &[], &[]);
        assert_eq!(map.visibility(Vec3::ZERO, 1.0), 1.0);
    }
}
