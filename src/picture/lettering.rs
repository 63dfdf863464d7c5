//! Words on a picture, in Noto Sans Mono, which comes ready rasterised with the program.
//!
//! Latin letters are there with their accents; what is not is shown as a replacement mark.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, RasterizedChar, get_raster, get_raster_width};

use super::Picture;

/// What stands in place of a letter that the font does not have.
const REPLACEMENT: char = '\u{fffd}';

/// Size and weight of letters; all have the same width.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lettering {
    /// A line of 16 pixels.
    Caption,
    /// A line of 16 pixels, bold.
    Strong,
    /// A line of 20 pixels, bold.
    Heading,
}

impl Lettering {
    fn font(self) -> (FontWeight, RasterHeight) {
        match self {
            Self::Caption => (FontWeight::Regular, RasterHeight::Size16),
            Self::Strong => (FontWeight::Bold, RasterHeight::Size16),
            Self::Heading => (FontWeight::Bold, RasterHeight::Size20),
        }
    }

    /// Height of a line, pixels.
    pub fn height(self) -> usize {
        self.font().1.val()
    }

    /// Width of a letter, pixels.
    pub fn advance(self) -> usize {
        let (weight, size) = self.font();
        get_raster_width(weight, size)
    }

    /// Width of a text, pixels.
    pub fn width(self, text: &str) -> usize {
        self.advance() * text.chars().count()
    }

    /// Writes a text with its upper left corner at a pixel, in sRGB. What lies outside the picture is left out.
    pub fn write(self, picture: &mut Picture, [left, top]: [usize; 2], text: &str, colour: [u8; 3]) {
        let (weight, size) = self.font();
        let (width, height) = (picture.width as usize, picture.height as usize);
        for (place, letter) in text.chars().enumerate() {
            let glyph: Option<RasterizedChar> =
                get_raster(letter, weight, size).or_else(|| get_raster(REPLACEMENT, weight, size));
            let first = left + place * self.advance();
            for (y, row) in glyph.iter().flat_map(|glyph| glyph.rows().enumerate()) {
                for (x, cover) in row.iter().enumerate() {
                    let (x, y) = (first + x, top + y);
                    let at = (y * width + x) * 3;
                    let Some(pixel) = picture.rgb.get_mut(at..at + 3).filter(|_| x < width && y < height) else {
                        continue;
                    };
                    for (below, above) in pixel.iter_mut().zip(colour) {
                        let mixed =
                            u32::from(*below) * (255 - u32::from(*cover)) + u32::from(above) * u32::from(*cover);
                        *below = ((mixed + 127) / 255) as u8;
                    }
                }
            }
        }
    }

    /// A text cut to a width in pixels, with dots where something is missing.
    pub fn fitted(self, text: &str, width: usize) -> String {
        let room = width / self.advance();
        if text.chars().count() <= room {
            return text.to_owned();
        }
        let kept: String = text.chars().take(room.saturating_sub(2)).collect();
        format!("{kept}..").chars().take(room).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(text: &str, at: [usize; 2]) -> Vec<usize> {
        let mut picture = Picture { width: 40, height: 20, rgb: vec![255; 40 * 20 * 3] };
        Lettering::Caption.write(&mut picture, at, text, [0, 0, 0]);
        let dark = |x: &usize| (0..20).any(|y| picture.rgb[(y * 40 + x) * 3] < 128);
        (0..40).filter(dark).collect()
    }

    #[test]
    fn letters_stand_where_they_are_put_and_none_is_lost() {
        let advance = Lettering::Caption.advance();
        let one = written("l", [8, 0]);
        assert!(!one.is_empty() && one.iter().all(|x| (8..8 + advance).contains(x)), "{one:?}");
        let accented = written("\u{e9}", [8, 0]);
        let unknown = written("\u{4e2d}", [8, 0]);
        assert!(!accented.is_empty() && !unknown.is_empty());
        assert_eq!(written("  ", [0, 0]), Vec::<usize>::new());
    }

    #[test]
    fn what_lies_outside_is_left_out() {
        assert!(written("lll", [36, 10]).iter().all(|x| *x >= 36));
        assert_eq!(written("l", [200, 0]), Vec::<usize>::new());
        assert_eq!(written("l", [0, 200]), Vec::<usize>::new());
    }

    #[test]
    fn a_long_text_ends_in_dots() {
        let advance = Lettering::Caption.advance();
        assert_eq!(Lettering::Caption.fitted("stiffness", 9 * advance), "stiffness");
        assert_eq!(Lettering::Caption.fitted("stiffness", 6 * advance), "stif..");
        assert_eq!(Lettering::Caption.fitted("stiffness", advance), ".");
    }
}
