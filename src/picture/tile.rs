//! The picture's tiles, and which primitives touch which.

use glam::DVec2;

/// Pixels a side. A tile's samples fit into the cache, and tiles can be drawn in any order.
pub(super) const TILE: usize = 32;

/// A rectangle of pixels: `left..right`, `top..bottom`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PixelRect {
    pub left: usize,
    pub top: usize,
    pub right: usize,
    pub bottom: usize,
}

impl PixelRect {
    /// The pixels of this rectangle that the box from `low` to `high` touches; may be empty.
    pub fn touched(&self, [low, high]: [DVec2; 2]) -> Self {
        // Casts saturate, so that what lies far off, or nowhere, is cut to the rectangle.
        Self {
            left: self.left.max(low.x.floor() as usize),
            top: self.top.max(low.y.floor() as usize),
            right: self.right.min((high.x.floor() + 1.0) as usize),
            bottom: self.bottom.min((high.y.floor() + 1.0) as usize),
        }
    }

    /// Whether there is no pixel in it.
    pub fn is_empty(&self) -> bool {
        self.left >= self.right || self.top >= self.bottom
    }
}

/// For each tile, row by row, the primitives whose boxes touch it, in their own order.
pub(super) struct Bins {
    columns: usize,
    starts: Vec<usize>,
    members: Vec<u32>,
}

impl Bins {
    /// Sorts boxes in pixels into the tiles of a picture of `width` by `height`.
    pub fn new(width: usize, height: usize, boxes: impl Iterator<Item = [DVec2; 2]> + Clone) -> Self {
        let columns = width.div_ceil(TILE);
        let rows = height.div_ceil(TILE);
        let picture = PixelRect { left: 0, top: 0, right: width, bottom: height };
        let tiles = |bounds: [DVec2; 2]| {
            let rect = picture.touched(bounds);
            let span = if rect.is_empty() {
                (0..0, 0..0)
            } else {
                (rect.top / TILE..(rect.bottom - 1) / TILE + 1, rect.left / TILE..(rect.right - 1) / TILE + 1)
            };
            span.0.flat_map(move |row| span.1.clone().map(move |column| row * columns + column))
        };
        let mut starts = vec![0; columns * rows + 1];
        for bounds in boxes.clone() {
            for tile in tiles(bounds) {
                starts[tile + 1] += 1;
            }
        }
        for tile in 1..starts.len() {
            starts[tile] += starts[tile - 1];
        }
        let mut next = starts.clone();
        let mut members = vec![0; starts[columns * rows]];
        for (index, bounds) in boxes.enumerate() {
            for tile in tiles(bounds) {
                members[next[tile]] = index as u32;
                next[tile] += 1;
            }
        }
        Self { columns, starts, members }
    }

    /// The primitives that touch a tile.
    pub fn of(&self, row: usize, column: usize) -> &[u32] {
        let tile = row * self.columns + column;
        &self.members[self.starts[tile]..self.starts[tile + 1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_come_into_the_tiles_they_touch_in_order() {
        let at = |x: f64, y: f64| DVec2::new(x, y);
        let boxes = [
            [at(1.0, 1.0), at(70.0, 2.0)],
            [at(31.9, 31.9), at(32.0, 32.0)],
            [at(-50.0, -50.0), at(-1.0, 500.0)],
            [at(-f64::INFINITY, 10.0), at(f64::INFINITY, 11.0)],
            [at(f64::NAN, f64::NAN), at(f64::NAN, f64::NAN)],
        ];
        let bins = Bins::new(80, 40, boxes.into_iter());
        assert_eq!(bins.of(0, 0)[..3], [0, 1, 3]);
        assert_eq!(bins.of(0, 1), [0, 1, 3]);
        assert_eq!(bins.of(0, 2), [0, 3]);
        assert_eq!(bins.of(1, 0), [1]);
        assert_eq!(bins.of(1, 1), [1]);
        assert_eq!(bins.of(1, 2), [0u32; 0]);
    }
}
