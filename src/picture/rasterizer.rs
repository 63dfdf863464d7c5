//! Which triangle each sample of a tile sees: half-plane tests and a depth buffer, 16 samples a pixel.

use glam::DVec2;

use super::face::Face;
use super::tile::{PixelRect, TILE};

/// Samples a pixel.
pub(super) const SAMPLES: usize = 16;
/// Mark of a sample that sees no triangle.
pub(super) const NOTHING: u32 = u32::MAX;

/// Places of the samples in their pixel. No two share a row or column, so that edges near to upright or level ones
/// come out in 16 steps too; all are multiples of 1/32, as exact tests want.
pub(super) const PATTERN: [DVec2; SAMPLES] = {
    let mut pattern = [DVec2::ZERO; SAMPLES];
    let mut k = 0;
    while k < SAMPLES {
        pattern[k] = DVec2::new((2 * k + 1) as f64 / 32.0, (2 * ((5 * k + 2) % SAMPLES) + 1) as f64 / 32.0);
        k += 1;
    }
    pattern
};

/// The samples of one tile.
pub(super) struct TileSamples {
    /// The tile's pixels.
    pub rect: PixelRect,
    depth: Vec<f32>,
    face: Vec<u32>,
}

impl TileSamples {
    /// Room for a tile.
    pub fn new() -> Self {
        Self {
            rect: PixelRect { left: 0, top: 0, right: 0, bottom: 0 },
            depth: vec![f32::NEG_INFINITY; TILE * TILE * SAMPLES],
            face: vec![NOTHING; TILE * TILE * SAMPLES],
        }
    }

    /// Empties the samples, and moves to other pixels; not more than a tile of them.
    pub fn begin(&mut self, rect: PixelRect) {
        self.rect = rect;
        self.depth.fill(f32::NEG_INFINITY);
        self.face.fill(NOTHING);
    }

    fn first(&self, x: usize, y: usize) -> usize {
        ((y - self.rect.top) * TILE + (x - self.rect.left)) * SAMPLES
    }

    /// The faces that the samples of a pixel see, or [`NOTHING`].
    pub fn seen(&self, x: usize, y: usize) -> &[u32] {
        let first = self.first(x, y);
        &self.face[first..first + SAMPLES]
    }

    /// The samples' depths, where they see something.
    pub fn depths(&self, x: usize, y: usize) -> &[f32] {
        let first = self.first(x, y);
        &self.depth[first..first + SAMPLES]
    }

    /// Draws a face under its index into the samples of `mask`. Where depths are equal, the face drawn first stays.
    ///
    /// A sample on an edge belongs to the triangle below or to the right of it (top-left rule): neighbours leave no gap
    /// and do not overlap.
    pub fn fill(&mut self, face: &Face, index: u32, mask: u16) {
        let span = self.rect.touched(face.bounds());
        if span.is_empty() || mask == 0 {
            return;
        }
        let [a, b, c] = face.pixel;
        let edges = [Edge::new(a, b), Edge::new(b, c), Edge::new(c, a)];
        let steps = edges.each_ref().map(|edge| PATTERN.map(|p| edge.direction.perp_dot(p)));
        let least = steps.map(|s| s.into_iter().fold(f64::INFINITY, f64::min));
        let most = steps.map(|s| s.into_iter().fold(f64::NEG_INFINITY, f64::max));
        let depth_steps = PATTERN.map(|p| face.plane.x * p.x + face.plane.y * p.y);
        for y in span.top..span.bottom {
            for x in span.left..span.right {
                let corner = DVec2::new(x as f64, y as f64);
                let value = edges.each_ref().map(|edge| edge.at(corner));
                if (0..3).any(|i| value[i] + most[i] < 0.0) {
                    continue;
                }
                let mut covered = mask;
                if (0..3).any(|i| value[i] + least[i] < 0.0) {
                    let mut inside = 0_u16;
                    for (k, ((s0, s1), s2)) in steps[0].iter().zip(&steps[1]).zip(&steps[2]).enumerate() {
                        let hit = value[0] + s0 >= 0.0 && value[1] + s1 >= 0.0 && value[2] + s2 >= 0.0;
                        inside |= u16::from(hit) << k;
                    }
                    covered &= inside;
                }
                if covered == 0 {
                    continue;
                }
                let depth = face.depth_at(corner);
                let first = self.first(x, y);
                let depths = &mut self.depth[first..first + SAMPLES];
                let faces = &mut self.face[first..first + SAMPLES];
                for k in 0..SAMPLES {
                    let here = (depth + depth_steps[k]) as f32;
                    if covered >> k & 1 == 1 && here > depths[k] {
                        depths[k] = here;
                        faces[k] = index;
                    }
                }
            }
        }
    }
}

/// A directed line; points on its right, seen with y downwards, are inside.
struct Edge {
    from: DVec2,
    direction: DVec2,
    /// Takes points on the line itself out again where the neighbour has them.
    bias: f64,
}

impl Edge {
    fn new(from: DVec2, to: DVec2) -> Self {
        let direction = to - from;
        let owns = direction.y < 0.0 || (direction.y == 0.0 && direction.x > 0.0);
        // Half of the least distance between two values: coordinates are multiples of 2^-10.
        Self { from, direction, bias: if owns { 0.0 } else { 0.5 / (1024.0 * 1024.0) } }
    }

    fn at(&self, point: DVec2) -> f64 {
        self.direction.perp_dot(point - self.from) - self.bias
    }
}

/// The samples that a surface of this opacity (0 to 1) covers; the others see through it.
pub(super) fn opacity_mask(opacity: f64) -> u16 {
    let covered = (opacity * SAMPLES as f64).round() as usize;
    // Strides over the pattern, so that the samples taken are spread over the pixel.
    (0..covered.min(SAMPLES)).fold(0, |mask, i| mask | 1 << ((i * 7 + 3) % SAMPLES))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Vec3};

    fn face(pixel: [[f64; 2]; 3], depth: f64) -> Face {
        let pixel = pixel.map(DVec2::from);
        Face {
            pixel,
            depth: [depth; 3],
            plane: DVec3::new(0.0, 0.0, depth),
            area: (pixel[1] - pixel[0]).perp_dot(pixel[2] - pixel[0]),
            place: [Vec3::ZERO; 3],
            normal: [Vec3::Z; 3],
            model: 0,
            back: false,
        }
    }

    fn tile() -> TileSamples {
        let mut tile = TileSamples::new();
        tile.begin(PixelRect { left: 0, top: 0, right: TILE, bottom: TILE });
        tile
    }

    #[test]
    fn the_pattern_is_balanced_and_shares_no_row() {
        let mean = PATTERN.iter().sum::<DVec2>() / SAMPLES as f64;
        assert!(mean.distance(DVec2::splat(0.5)) < 1e-12);
        for (i, p) in PATTERN.iter().enumerate() {
            assert!(PATTERN[..i].iter().all(|q| q.x != p.x && q.y != p.y));
        }
    }

    #[test]
    fn a_fan_covers_every_sample_exactly_once() {
        // A wheel whose hub and spokes run through samples, and whose rim runs along pixel borders.
        let hub = [16.0 + PATTERN[3].x, 16.0 + PATTERN[3].y];
        let rim = [[2.0, 2.0], [hub[0], 2.0], [30.0, 2.0], [30.0, hub[1]], [30.0, 30.0], [7.0, 30.0], [2.0, 30.0]];
        let mut counts = vec![0; TILE * TILE * SAMPLES];
        for k in 0..rim.len() {
            let mut tile = tile();
            tile.fill(&face([hub, rim[k], rim[(k + 1) % rim.len()]], 1.0), 0, u16::MAX);
            for (count, face) in counts.iter_mut().zip(&tile.face) {
                *count += usize::from(*face == 0);
            }
        }
        for (index, count) in counts.iter().enumerate() {
            let (x, y) = (index / SAMPLES % TILE, index / SAMPLES / TILE);
            let inside = (2..30).contains(&x) && (2..30).contains(&y);
            assert_eq!(*count, usize::from(inside), "sample {} of pixel {x}, {y}", index % SAMPLES);
        }
    }

    #[test]
    fn the_nearer_face_wins_in_any_order() {
        let near = face([[0.0, 0.0], [32.0, 0.0], [0.0, 32.0]], 2.0);
        let far = face([[0.0, 0.0], [32.0, 0.0], [0.0, 32.0]], 1.0);
        for order in [[(&near, 7), (&far, 9)], [(&far, 9), (&near, 7)]] {
            let mut tile = tile();
            for (face, index) in order {
                tile.fill(face, index, u16::MAX);
            }
            assert!(tile.seen(3, 3).iter().all(|f| *f == 7));
            assert!(tile.depths(3, 3).iter().all(|d| *d == 2.0));
            assert!(tile.seen(31, 31).iter().all(|f| *f == NOTHING));
        }
    }

    #[test]
    fn opacity_takes_its_share_of_the_samples() {
        assert_eq!(opacity_mask(0.0), 0);
        assert_eq!(opacity_mask(0.25).count_ones(), 4);
        assert_eq!(opacity_mask(1.0), u16::MAX);
    }
}
