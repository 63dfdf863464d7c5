//! PNG and JPEG pictures into masks: what of a reference picture lies inside a shape.

use std::io::Cursor;

use image::{DynamicImage, GrayImage, ImageDecoder, ImageError, ImageFormat, ImageReader};

use crate::outline::Mask;

/// Most pixels of a picture that is read; 4K is less.
pub const MAX_PIXELS: u64 = 8 << 20;

/// Most pixels along an edge of a picture that is read.
pub const MAX_EDGE: u32 = 16_384;

/// Most bytes of the pixels as the file has them: eight a pixel.
const MAX_BYTES: u64 = 8 * MAX_PIXELS;

/// What makes a pixel belong to the shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Channel {
    /// It is dark: the complement of its luminance. What is transparent counts as white.
    Dark,
    /// It is light: its luminance. What is transparent counts as black.
    Light,
    /// It is opaque: its alpha.
    Alpha,
}

/// Why a picture cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PictureError {
    /// No bytes at all.
    #[error("the picture is empty: export it again")]
    Empty,
    /// Another format, or none.
    #[error("the file is no PNG and no JPEG picture: save it as one of these")]
    UnknownFormat,
    /// Bytes that break the rules of the format.
    #[error("not a valid {format} picture: {problem}: export it again")]
    Malformed {
        /// The format.
        format: &'static str,
        /// What is wrong.
        problem: String,
    },
    /// More pixels than are read.
    #[error(
        "the picture has {width} x {height} pixels, and at most {} million (16 384 along an edge) are read: make it \
         smaller", MAX_PIXELS / 1_000_000
    )]
    TooLarge {
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
    },
    /// [`Channel::Alpha`] of a picture without one.
    #[error("the picture has no alpha channel: choose by `dark` or `light` pixels, or save it with transparency")]
    NoAlpha,
}

/// The mask of a PNG or JPEG picture: of each pixel, how much of it the shape covers by `channel`, 0 to 255.
///
/// Luminance is that of the stored numbers by the weights of Rec. 709 (gamma is left as it is: edges that paint
/// programs soften lie where these numbers are half). 16-bit pictures are rounded to 8 bits. The size is known before
/// any pixel is decoded, and at most [`MAX_PIXELS`] are. A picture is turned and mirrored as its EXIF data say it was
/// held, as every viewer shows it.
///
/// # Errors
/// [`PictureError`] where the bytes are empty, neither PNG nor JPEG, damaged or cut off, too large, or without the alpha
/// channel asked for.
pub fn read(bytes: &[u8], channel: Channel) -> Result<Mask, PictureError> {
    let (picture, held, name) = decoded(bytes)?;
    let (width, height) = (picture.width(), picture.height());
    let values = match channel {
        Channel::Alpha if !picture.color().has_alpha() => return Err(PictureError::NoAlpha),
        Channel::Alpha => rows(&picture, |_, alpha| alpha),
        Channel::Dark => rows(&picture, |luma, alpha| covered(255 - luma, alpha)),
        Channel::Light => rows(&picture, covered),
    };
    let unusable = |problem: String| PictureError::Malformed { format: name, problem };
    let stored = GrayImage::from_raw(width, height, values).ok_or_else(|| unusable("too few pixels".to_owned()))?;
    let mut upright = DynamicImage::ImageLuma8(stored);
    upright.apply_orientation(held);
    let (width, height) = (upright.width() as usize, upright.height() as usize);
    Mask::new(width, height, upright.into_bytes()).map_err(|error| unusable(error.to_string()))
}

/// The pixels of a picture, upright.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pixels {
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// Red, green, blue and alpha (not multiplied into them), 8 bits each, row by row from the upper left corner.
    pub rgba: Vec<u8>,
}

/// The pixels of a PNG or JPEG picture to look at, upright as [`read`] has it. One with more than `most` pixels along an
/// edge is made smaller, with its proportions.
///
/// # Errors
/// As [`read`], but for the channel.
pub fn pixels(bytes: &[u8], most: u32) -> Result<Pixels, PictureError> {
    let (mut picture, held, _) = decoded(bytes)?;
    picture.apply_orientation(held);
    if picture.width().max(picture.height()) > most {
        picture = picture.thumbnail(most, most);
    }
    let picture = picture.into_rgba8();
    Ok(Pixels { width: picture.width() as usize, height: picture.height() as usize, rgba: picture.into_raw() })
}

/// A picture as it is stored, how it was held, and the name of its format.
fn decoded(bytes: &[u8]) -> Result<(DynamicImage, image::metadata::Orientation, &'static str), PictureError> {
    if bytes.is_empty() {
        return Err(PictureError::Empty);
    }
    let (format, name) = match image::guess_format(bytes) {
        Ok(ImageFormat::Png) => (ImageFormat::Png, "PNG"),
        Ok(ImageFormat::Jpeg) => (ImageFormat::Jpeg, "JPEG"),
        _ => return Err(PictureError::UnknownFormat),
    };
    let malformed = |error: ImageError| PictureError::Malformed { format: name, problem: plain(&error) };
    let mut decoder = ImageReader::with_format(Cursor::new(bytes), format).into_decoder().map_err(malformed)?;
    let (width, height) = decoder.dimensions();
    let pixels = u64::from(width) * u64::from(height);
    if pixels > MAX_PIXELS || width.max(height) > MAX_EDGE || decoder.total_bytes() > MAX_BYTES {
        return Err(PictureError::TooLarge { width, height });
    }
    let mut limits = image::Limits::no_limits();
    limits.max_alloc = Some(MAX_BYTES);
    decoder.set_limits(limits).map_err(malformed)?;
    // Cameras store pictures as the sensor lies and say how they were held.
    let held = decoder.orientation().map_err(malformed)?;
    Ok((DynamicImage::from_decoder(decoder).map_err(malformed)?, held, name))
}

/// A value of 0 to 255 over nothing.
fn covered(value: u8, alpha: u8) -> u8 {
    let product = u32::from(value) * u32::from(alpha);
    u8::try_from((product + 127) / 255).unwrap_or(u8::MAX)
}

/// A value of each pixel's luminance and alpha, without a second picture of all channels.
fn rows(picture: &DynamicImage, value: impl Fn(u8, u8) -> u8) -> Vec<u8> {
    let grey = |rgb: [u8; 3]| {
        let weighted = 2126 * u32::from(rgb[0]) + 7152 * u32::from(rgb[1]) + 722 * u32::from(rgb[2]);
        u8::try_from((weighted + 5_000) / 10_000).unwrap_or(u8::MAX)
    };
    match picture {
        DynamicImage::ImageLuma8(pixels) => pixels.pixels().map(|p| value(p[0], 255)).collect(),
        DynamicImage::ImageLumaA8(pixels) => pixels.pixels().map(|p| value(p[0], p[1])).collect(),
        DynamicImage::ImageRgb8(pixels) => pixels.pixels().map(|p| value(grey(p.0), 255)).collect(),
        DynamicImage::ImageRgba8(pixels) => pixels.pixels().map(|p| value(grey([p[0], p[1], p[2]]), p[3])).collect(),
        DynamicImage::ImageLuma16(pixels) => pixels.pixels().map(|p| value(eight(p[0]), 255)).collect(),
        DynamicImage::ImageLumaA16(pixels) => pixels.pixels().map(|p| value(eight(p[0]), eight(p[1]))).collect(),
        DynamicImage::ImageRgb16(pixels) => pixels.pixels().map(|p| value(grey(p.0.map(eight)), 255)).collect(),
        DynamicImage::ImageRgba16(pixels) => {
            pixels.pixels().map(|p| value(grey([p[0], p[1], p[2]].map(eight)), eight(p[3]))).collect()
        }
        other => other.to_luma_alpha8().pixels().map(|p| value(p[0], p[1])).collect(),
    }
}

/// A number of 16 bits in 8.
fn eight(value: u16) -> u8 {
    u8::try_from((u32::from(value) + 128) / 257).unwrap_or(u8::MAX)
}

/// What a decoder says, without its own introduction and end.
fn plain(error: &ImageError) -> String {
    let said = match error {
        ImageError::Decoding(error) => {
            std::error::Error::source(error).map_or_else(|| error.to_string(), ToString::to_string)
        }
        ImageError::IoError(error) => error.to_string(),
        other => other.to_string(),
    };
    said.lines().next().unwrap_or_default().trim_end_matches(['.', '!', ' ']).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{ImageBuffer, Luma, Rgb, RgbImage, Rgba, RgbaImage};

    fn encoded(picture: impl Into<DynamicImage>, format: ImageFormat) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        picture.into().write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    #[test]
    fn each_channel_says_what_is_inside() {
        let mut picture = RgbaImage::from_pixel(4, 1, Rgba([0, 0, 0, 0]));
        picture.put_pixel(1, 0, Rgba([0, 0, 0, 255]));
        picture.put_pixel(2, 0, Rgba([255, 255, 255, 255]));
        picture.put_pixel(3, 0, Rgba([0, 255, 0, 128]));
        let bytes = encoded(picture, ImageFormat::Png);
        let values = |channel| read(&bytes, channel).unwrap().values().to_vec();
        assert_eq!(values(Channel::Alpha), [0, 255, 255, 128]);
        // What is transparent is outside, whatever colour it hides.
        assert_eq!(values(Channel::Dark), [0, 255, 0, 37]);
        assert_eq!(values(Channel::Light), [0, 0, 255, 91]);
    }

    #[test]
    fn grey_colour_sixteen_bits_and_jpeg_agree() {
        let grey = |x: u32| u8::try_from(x * 17).unwrap();
        let eight_bits = GrayImage::from_fn(16, 16, |x, _| Luma([grey(x)]));
        let colour = RgbImage::from_fn(16, 16, |x, _| Rgb([grey(x); 3]));
        let wide: ImageBuffer<Luma<u16>, Vec<u16>> =
            ImageBuffer::from_fn(16, 16, |x, _| Luma([u16::from(grey(x)) * 257]));
        let values = |bytes: &[u8]| read(bytes, Channel::Light).unwrap().values().to_vec();
        let wanted = values(&encoded(eight_bits.clone(), ImageFormat::Png));
        assert_eq!(wanted[..3], [0, 17, 34]);
        assert_eq!(values(&encoded(colour.clone(), ImageFormat::Png)), wanted);
        assert_eq!(values(&encoded(wide, ImageFormat::Png)), wanted);
        for jpeg in [encoded(eight_bits, ImageFormat::Jpeg), encoded(colour, ImageFormat::Jpeg)] {
            let off = values(&jpeg).iter().zip(&wanted).map(|(a, b)| a.abs_diff(*b)).max();
            assert!(off < Some(12), "{off:?}");
        }
    }

    /// A JPEG with EXIF data that say how it was held.
    fn held(jpeg: &[u8], orientation: u8) -> Vec<u8> {
        let mut exif = b"Exif\0\0II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0".to_vec();
        exif.extend([orientation, 0, 0, 0, 0, 0, 0, 0]);
        let length = u16::try_from(exif.len() + 2).unwrap().to_be_bytes();
        [&jpeg[..2], &[0xff, 0xe1], &length, &exif, &jpeg[2..]].concat()
    }

    #[test]
    fn a_photograph_is_read_as_it_was_held() {
        // Brighter to the right and, more so, downwards: no turned or mirrored picture is like another.
        let (width, height) = (24_u32, 16_u32);
        let upright = |x: u32, y: u32| u8::try_from(2 * x + 9 * y).unwrap();
        // What the standard says of each number: the side seen where the first row and the first column are stored.
        let sides = [
            "top left",
            "top right",
            "bottom right",
            "bottom left",
            "left top",
            "right top",
            "right bottom",
            "left bottom",
        ];
        for (orientation, sides) in (1_u8..).zip(sides) {
            let (row, column) = sides.split_once(' ').unwrap();
            let lies = matches!(row, "left" | "right");
            let (across, down) = if lies { (height, width) } else { (width, height) };
            let stored = GrayImage::from_fn(across, down, |i, j| {
                let (x_side, y_side, x, y) = if lies { (row, column, j, i) } else { (column, row, i, j) };
                let x = if x_side == "left" { x } else { width - 1 - x };
                let y = if y_side == "top" { y } else { height - 1 - y };
                Luma([upright(x, y)])
            });
            let read = read(&held(&encoded(stored, ImageFormat::Jpeg), orientation), Channel::Light).unwrap();
            assert_eq!((read.width(), read.height()), (width as usize, height as usize), "{orientation}");
            let wanted = (0..height).flat_map(|y| (0..width).map(move |x| upright(x, y)));
            let off = read.values().iter().zip(wanted).map(|(a, b)| a.abs_diff(b)).max();
            assert!(off < Some(8), "orientation {orientation}: {off:?}");
        }
        // What is no orientation changes nothing.
        let plain = encoded(GrayImage::from_fn(24, 16, |x, y| Luma([upright(x, y)])), ImageFormat::Jpeg);
        assert_eq!(read(&held(&plain, 9), Channel::Light), read(&plain, Channel::Light));
    }

    #[test]
    fn what_is_no_picture_is_refused_with_a_reason() {
        let whole = encoded(GrayImage::from_fn(64, 64, |x, y| Luma([(x * y % 251) as u8])), ImageFormat::Png);
        assert_eq!(read(&[], Channel::Dark), Err(PictureError::Empty));
        assert_eq!(read(b"GIF89a\x01\0\x01\0\0\0\0", Channel::Dark), Err(PictureError::UnknownFormat));
        assert_eq!(read(&whole, Channel::Alpha), Err(PictureError::NoAlpha));
        let cut = read(&whole[..whole.len() / 2], Channel::Dark).unwrap_err();
        assert!(matches!(cut, PictureError::Malformed { format: "PNG", .. }), "{cut}");
        assert!(cut.to_string().ends_with("export it again"), "{cut}");
        let jpeg = read(b"\xff\xd8\xff\xe0 and no more", Channel::Dark).unwrap_err();
        assert!(matches!(jpeg, PictureError::Malformed { format: "JPEG", .. }), "{jpeg}");
    }

    /// A PNG whose head asks for this many pixels, with a checksum that fits.
    fn head(width: u32, height: u32) -> Vec<u8> {
        let mut bytes = encoded(GrayImage::new(1, 1), ImageFormat::Png);
        bytes[16..20].copy_from_slice(&width.to_be_bytes());
        bytes[20..24].copy_from_slice(&height.to_be_bytes());
        let sum = bytes[12..29].iter().fold(u32::MAX, |sum, byte| {
            (0..8).fold(sum ^ u32::from(*byte), |sum, _| (sum >> 1) ^ (0xedb8_8320 * (sum & 1)))
        });
        bytes[29..33].copy_from_slice(&(!sum).to_be_bytes());
        bytes
    }

    #[test]
    fn a_small_file_does_not_become_a_large_picture() {
        for (width, height) in [(100_000, 100_000), (4096, 4096), (2, 20_000)] {
            assert_eq!(read(&head(width, height), Channel::Dark), Err(PictureError::TooLarge { width, height }));
        }
        let message = read(&head(4096, 4096), Channel::Dark).unwrap_err().to_string();
        assert!(message.contains("4096 x 4096 pixels, and at most 8 million"), "{message}");
        // Small enough by its head, and cut off behind it.
        assert!(matches!(read(&head(2048, 2048), Channel::Dark), Err(PictureError::Malformed { .. })));
    }
}
