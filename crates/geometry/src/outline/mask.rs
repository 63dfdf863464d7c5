//! A picture of one channel: how much of each pixel a shape covers.

/// A grid of numbers from 0 (outside) to 255 (inside), row by row from the top, at least one pixel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mask {
    width: usize,
    height: usize,
    values: Vec<u8>,
}

/// Values that are no rectangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{found} values are no picture of {width} x {height} pixels")]
pub struct MaskError {
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// Values given.
    pub found: usize,
}

impl Mask {
    /// A mask of `width` by `height` values, row by row from the top.
    ///
    /// # Errors
    /// [`MaskError`] where the number of values is another, or nothing.
    pub fn new(width: usize, height: usize, values: Vec<u8>) -> Result<Self, MaskError> {
        if values.is_empty() || width.checked_mul(height) != Some(values.len()) {
            return Err(MaskError { width, height, found: values.len() });
        }
        Ok(Self { width, height, values })
    }

    /// Pixels across.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Pixels down.
    pub fn height(&self) -> usize {
        self.height
    }

    /// The values row by row from the top.
    pub fn values(&self) -> &[u8] {
        &self.values
    }

    /// The value at a pixel, counted from the upper left; nothing lies beyond the edges.
    pub fn at(&self, x: isize, y: isize) -> u8 {
        match (usize::try_from(x), usize::try_from(y)) {
            (Ok(x), Ok(y)) if x < self.width && y < self.height => self.values[y * self.width + x],
            _ => 0,
        }
    }

    /// Smallest and largest value.
    pub fn range(&self) -> (u8, u8) {
        self.values.iter().fold((u8::MAX, 0), |(low, high), value| (low.min(*value), high.max(*value)))
    }

    /// First and last column and row that hold a value of at least `level`; none where no value does.
    pub(super) fn extent(&self, level: f64) -> Option<[usize; 4]> {
        let mut extent: Option<[usize; 4]> = None;
        for (y, row) in self.values.chunks_exact(self.width).enumerate() {
            let inside = |value: &u8| f64::from(*value) >= level;
            let (Some(first), Some(last)) = (row.iter().position(inside), row.iter().rposition(inside)) else {
                continue;
            };
            let [left, right, top, _] = extent.unwrap_or([first, last, y, y]);
            extent = Some([left.min(first), right.max(last), top, y]);
        }
        extent
    }
}
