//! Pictures of a scene, drawn without a graphics card or a window.
//!
//! [`draw`] rasterises the scene's meshes as studio clay with 16 samples a pixel, and its curves as lines of even
//! width. The bytes are the same on every run and for any number of threads.

mod backdrop;
mod camera;
mod face;
pub mod lettering;
mod light;
mod rasterizer;
mod resolve;
mod shading;
mod shadow_map;
mod stroke;
mod subject;
#[cfg(test)]
mod tests;
mod tile;
mod wireframe;

use glam::{DVec2, DVec3, Vec3};
use image::ImageEncoder;
use image::codecs::png::PngEncoder;
use maquette_geometry::scene::Scene;

pub use camera::View;
use camera::{Bounds, Camera};
use shading::to_linear;
use stroke::{Stroke, Strokes};
use subject::Subject;

/// Largest width and height of a picture, pixels.
pub const MAX_SIDE: u32 = 16_384;
/// Farthest from the origin that points are drawn, metres.
pub const REACH: f64 = 1e12;

/// Width of curves, pixels.
const CURVE_WIDTH: f64 = 2.5;
/// Share of the subject's radius that curves may lie behind a surface and still count as lying on it.
const CURVE_BIAS: f64 = 0.004;
/// Pixels of slope that they may lie behind besides.
const CURVE_SLACK: f64 = 1.0;
/// Opacity of the dots that mark where a curve is hidden.
const CURVE_HIDDEN: f32 = 0.55;

/// What a picture is to show.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureOptions {
    /// Where from.
    pub view: View,
    /// Pixels from left to right, 1 to [`MAX_SIDE`].
    pub width: u32,
    /// Pixels from top to bottom, 1 to [`MAX_SIDE`].
    pub height: u32,
    /// Whether the polygons' edges are drawn over the surfaces; hidden ones are not.
    pub wireframe: bool,
    /// Whether the scene's curves are drawn; dotted where a surface hides them.
    pub curves: bool,
}

impl Default for PictureOptions {
    fn default() -> Self {
        Self { view: View::default(), width: 1280, height: 960, wireframe: false, curves: true }
    }
}

/// A picture in sRGB.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels from left to right.
    pub width: u32,
    /// Pixels from top to bottom.
    pub height: u32,
    /// Red, green and blue of each pixel, row by row from the top left.
    pub rgb: Vec<u8>,
}

/// Why there is no picture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PictureError {
    /// A scene without polygons, and without curves that were asked for.
    #[error("nothing to draw: the scene has {polygons} polygons and {curves} curves, and curves are switched {}; \
             check that an output is connected", if *.curves_drawn { "on" } else { "off" })]
    NothingToDraw {
        /// Polygons of all meshes.
        polygons: usize,
        /// Curves of all outputs.
        curves: usize,
        /// Whether curves were asked for.
        curves_drawn: bool,
    },
    /// A side without pixels, or with more than [`MAX_SIDE`].
    #[error("a picture of {width} x {height} pixels cannot be drawn: give each side 1 to {MAX_SIDE}")]
    Size {
        /// Pixels from left to right.
        width: u32,
        /// Pixels from top to bottom.
        height: u32,
    },
    /// A point farther from the origin than [`REACH`].
    #[error(
        "a point lies {distance:e} m from the origin, and pictures reach {REACH:e} m: check the scale of the input"
    )]
    OutOfReach {
        /// Its largest coordinate, metres.
        distance: f64,
    },
}

/// Why a picture cannot be written as PNG.
#[derive(Debug, thiserror::Error)]
pub enum PngError {
    /// Bytes that do not fit the size.
    #[error("a picture of {width} x {height} pixels needs 3 bytes for each, and has {found} in all")]
    Length {
        /// Pixels from left to right.
        width: u32,
        /// Pixels from top to bottom.
        height: u32,
        /// Bytes there are.
        found: usize,
    },
    /// The encoder failed.
    #[error("the picture could not be written as PNG: {0}")]
    Encode(#[from] image::ImageError),
}

/// Draws a scene, framed with a margin of 8 %.
///
/// Single-sided surfaces seen from behind are red, so that flipped polygons show; the inside of double-sided ones is
/// darker and cooler. A grid marks every 0.1 m and, stronger, every metre, or other powers of ten where the scene is
/// much larger or smaller. Transparent materials are dissolved into the 16 samples of a pixel.
///
/// # Errors
/// [`PictureError`] where there is nothing to draw, the size is out of range, or a point lies absurdly far away.
pub fn draw(scene: &Scene, options: &PictureOptions) -> Result<Picture, PictureError> {
    draw_framed(scene, options, &[])
}

/// Draws a scene as [`draw`] does, framed so that a box is inside as well: scenes drawn with one box that holds them all
/// are seen by one camera, over one floor, and can be compared. `low` and `high` are its corners, metres.
///
/// # Errors
/// As [`draw`].
pub fn draw_within(scene: &Scene, options: &PictureOptions, [low, high]: [DVec3; 2]) -> Result<Picture, PictureError> {
    let side = |bit: usize, low: f64, high: f64| if bit == 0 { low } else { high };
    let corners: Vec<DVec3> = (0..8)
        .map(|i| DVec3::new(side(i & 1, low.x, high.x), side(i & 2, low.y, high.y), side(i & 4, low.z, high.z)))
        .collect();
    draw_framed(scene, options, &corners)
}

fn draw_framed(scene: &Scene, options: &PictureOptions, corners: &[DVec3]) -> Result<Picture, PictureError> {
    let PictureOptions { view, width, height, wireframe, curves } = *options;
    if !(1..=MAX_SIDE).contains(&width) || !(1..=MAX_SIDE).contains(&height) {
        return Err(PictureError::Size { width, height });
    }
    let framed = || subject::points(scene, curves).chain(corners.iter().copied());
    let distance = framed().fold(0.0, |most: f64, p| most.max(p.abs().max_element()));
    if distance > REACH {
        return Err(PictureError::OutOfReach { distance });
    }
    let something = subject::points(scene, curves).next().is_some();
    let bounds = if something { Bounds::of(framed()) } else { None };
    let bounds = bounds.ok_or_else(|| PictureError::NothingToDraw {
        polygons: scene.meshes.iter().map(|item| item.mesh.polygon_count()).sum(),
        curves: scene.curves.iter().map(|item| item.curves.len()).sum(),
        curves_drawn: curves,
    })?;
    let subject = Subject::within(scene, bounds);
    let size = DVec2::new(f64::from(width), f64::from(height));
    let camera = Camera::framing(view, framed(), &subject.bounds, size);
    let mut strokes = Strokes::new();
    if wireframe {
        wireframe::add_edges(&mut strokes, &subject, &camera);
    }
    if curves {
        add_curves(&mut strokes, scene, &subject, &camera);
    }
    let rgb = resolve::pixels(&subject, &camera, &mut strokes, width as usize, height as usize);
    Ok(Picture { width, height, rgb })
}

fn add_curves(strokes: &mut Strokes, scene: &Scene, subject: &Subject, camera: &Camera) {
    for item in &scene.curves {
        let unit = |x: f64| if x.is_finite() { x.clamp(0.0, 1.0) as f32 } else { 1.0 };
        let [r, g, b, opacity] = item.colour.map(unit);
        let colour = to_linear(Vec3::new(r, g, b));
        for curve in &item.curves {
            let bias = subject.bounds.radius * CURVE_BIAS;
            strokes.begin(Stroke {
                colour,
                width: CURVE_WIDTH,
                bias,
                slack: CURVE_SLACK,
                hidden: CURVE_HIDDEN * opacity,
            });
            let closing = if curve.is_closed() { curve.points().first() } else { None };
            let mut along = 0.0;
            let mut points = curve.points().iter().chain(closing);
            let Some(mut previous) = points.next() else { continue };
            for point in points {
                along = strokes.add(camera, [*previous, *point], along, opacity);
                previous = point;
            }
        }
    }
}

impl Picture {
    /// The picture as a PNG file.
    ///
    /// # Errors
    /// [`PngError`] where the bytes do not fit the size, or the encoder fails.
    pub fn to_png(&self) -> Result<Vec<u8>, PngError> {
        let &Self { width, height, ref rgb } = self;
        if rgb.len() as u64 != u64::from(width) * u64::from(height) * 3 {
            return Err(PngError::Length { width, height, found: rgb.len() });
        }
        let mut bytes = Vec::new();
        PngEncoder::new(&mut bytes).write_image(rgb, width, height, image::ExtendedColorType::Rgb8)?;
        Ok(bytes)
    }
}
