//! Lines of even width on the picture, hidden where surfaces lie before them.

use glam::{DVec2, DVec3, Vec3};

use super::camera::Camera;
use super::face::Face;
use super::rasterizer::{NOTHING, SAMPLES, TileSamples};
use super::tile::{Bins, TILE};

/// Pixels from dot to dot where a line is hidden.
const DOT_PERIOD: f64 = 6.0;
/// Radius of such a dot, as a share of the line's width.
const DOT_RADIUS: f64 = 0.42;

/// How a line looks.
#[derive(Clone, Debug)]
pub(super) struct Stroke {
    /// Linear colour.
    pub colour: Vec3,
    /// Pixels.
    pub width: f64,
    /// How far, in metres, the line may lie behind a surface and is still seen.
    pub bias: f64,
    /// How far besides, in steps of depth from pixel to pixel on that surface: a curve along an outline runs where a
    /// faceted surface turns away, and would be half hidden.
    pub slack: f64,
    /// Opacity of the dots that mark where the line is hidden; 0 for none.
    pub hidden: f32,
}

/// A straight piece of a line.
#[derive(Clone, Debug)]
struct Segment {
    ends: [DVec2; 2],
    depth: [f64; 2],
    /// Pixels from the beginning of the line to the first end.
    along: f64,
    opacity: f32,
    stroke: u32,
}

/// All lines of a picture, in the order they are drawn.
pub(super) struct Strokes {
    strokes: Vec<Stroke>,
    segments: Vec<Segment>,
    bins: Option<Bins>,
}

impl Strokes {
    /// No lines yet.
    pub fn new() -> Self {
        Self { strokes: Vec::new(), segments: Vec::new(), bins: None }
    }

    /// Begins a line; what is added belongs to it until the next one begins. Pieces of one line do not darken each
    /// other where they overlap.
    pub fn begin(&mut self, stroke: Stroke) {
        self.strokes.push(stroke);
    }

    /// Adds a piece between points of the world. Gives back the pixels from the beginning of the line to its end, if it
    /// began at `along`.
    pub fn add(&mut self, camera: &Camera, ends: [DVec3; 2], along: f64, opacity: f32) -> f64 {
        let mut view = ends.map(|p| camera.to_view(p));
        let clearance = view.map(|p| camera.clearance(p));
        if clearance[0] < 0.0 && clearance[1] < 0.0 {
            return along;
        }
        if clearance[0] < 0.0 || clearance[1] < 0.0 {
            let cut = view[0].lerp(view[1], clearance[0] / (clearance[0] - clearance[1]));
            view[usize::from(clearance[0] >= 0.0)] = cut;
        }
        let [a, b] = view.map(|p| camera.project(p));
        let stroke = self.strokes.len().saturating_sub(1) as u32;
        self.segments.push(Segment { ends: [a.pixel, b.pixel], depth: [a.depth, b.depth], along, opacity, stroke });
        along + a.pixel.distance(b.pixel)
    }

    /// Sorts the pieces into tiles. Nothing is drawn before.
    pub fn sort(&mut self, width: usize, height: usize) {
        let boxes = self.segments.iter().map(|segment| {
            let reach = self.strokes.get(segment.stroke as usize).map_or(0.0, |s| s.width * 0.5 + 0.5);
            let [a, b] = segment.ends;
            [a.min(b) - reach, a.max(b) + reach]
        });
        self.bins = Some(Bins::new(width, height, boxes));
    }

    /// Draws the lines that run through a tile over its pixels' linear colours.
    pub fn draw(&self, tile: &TileSamples, [row, column]: [usize; 2], faces: &[Face], camera: &Camera, ink: &mut Ink) {
        let Some(bins) = &self.bins else { return };
        let segment = |index: &u32| &self.segments[*index as usize];
        for line in bins.of(row, column).chunk_by(|a, b| segment(a).stroke == segment(b).stroke) {
            let Some(stroke) = line.first().and_then(|first| self.strokes.get(segment(first).stroke as usize)) else {
                continue;
            };
            for index in line {
                ink.trace(segment(index), stroke, tile, faces, camera);
            }
            ink.dry(stroke);
        }
    }
}

/// Coverage of a tile's pixels by one line, and the colours it goes onto.
pub(super) struct Ink {
    /// Linear colours of the tile's pixels.
    pub colours: Vec<Vec3>,
    seen: Vec<f32>,
    hidden: Vec<f32>,
    wet: Vec<usize>,
}

impl Ink {
    /// Room for a tile.
    pub fn new() -> Self {
        let pixels = TILE * TILE;
        Self {
            colours: vec![Vec3::ZERO; pixels],
            seen: vec![0.0; pixels],
            hidden: vec![0.0; pixels],
            wet: Vec::with_capacity(pixels),
        }
    }

    fn trace(&mut self, segment: &Segment, stroke: &Stroke, tile: &TileSamples, faces: &[Face], camera: &Camera) {
        let [a, b] = segment.ends;
        let half = stroke.width * 0.5;
        let reach = half + 0.5;
        let span = tile.rect.touched([a.min(b) - reach, a.max(b) + reach]);
        let along = b - a;
        let length2 = along.length_squared();
        for y in span.top..span.bottom {
            for x in span.left..span.right {
                let centre = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                let t = if length2 > 0.0 { ((centre - a).dot(along) / length2).clamp(0.0, 1.0) } else { 0.0 };
                let nearest = a + along * t;
                let distance = nearest.distance(centre);
                let coverage = (reach - distance).clamp(0.0, 1.0) as f32 * segment.opacity;
                if coverage <= 0.0 {
                    continue;
                }
                let depth = segment.depth[0] + (segment.depth[1] - segment.depth[0]) * t;
                let point =
                    Axis { at: nearest, depth, bias: camera.depth_step(depth, stroke.bias), slack: stroke.slack };
                let share = point.visible_share(tile, x, y, faces);
                let pixel = (y - tile.rect.top) * TILE + (x - tile.rect.left);
                if self.seen[pixel] == 0.0 && self.hidden[pixel] == 0.0 {
                    self.wet.push(pixel);
                }
                self.seen[pixel] = self.seen[pixel].max(coverage * share);
                if stroke.hidden > 0.0 && share < 1.0 {
                    let phase = (segment.along + length2.sqrt() * t).rem_euclid(DOT_PERIOD) - DOT_PERIOD * 0.5;
                    let dot =
                        (stroke.width * DOT_RADIUS + 0.5 - DVec2::new(phase, distance).length()).clamp(0.0, 1.0) as f32;
                    self.hidden[pixel] = self.hidden[pixel].max(dot * (1.0 - share));
                }
            }
        }
    }

    /// Puts the line onto the colours.
    fn dry(&mut self, stroke: &Stroke) {
        for pixel in self.wet.drain(..) {
            let cover = self.seen[pixel].max(self.hidden[pixel] * stroke.hidden);
            self.colours[pixel] = self.colours[pixel].lerp(stroke.colour, cover);
            self.seen[pixel] = 0.0;
            self.hidden[pixel] = 0.0;
        }
    }
}

/// The point of a line that is nearest to a pixel.
struct Axis {
    at: DVec2,
    depth: f64,
    /// In units of depth.
    bias: f64,
    slack: f64,
}

impl Axis {
    /// Share of a pixel's samples at which the line is not hidden.
    ///
    /// The surface is compared here rather than at the sample, along the plane of the triangle seen there: a line in a
    /// steep surface keeps its full width.
    fn visible_share(&self, tile: &TileSamples, x: usize, y: usize, faces: &[Face]) -> f32 {
        let mut visible = 0_u8;
        let mut last = (NOTHING, true);
        for (&index, &depth) in tile.seen(x, y).iter().zip(tile.depths(x, y)) {
            if index != last.0 {
                last = (index, faces.get(index as usize).is_none_or(|face| self.is_before(face, f64::from(depth))));
            }
            visible += u8::from(last.1);
        }
        f32::from(visible) / SAMPLES as f32
    }

    /// Whether this lies before a face that has `sample` as its depth nearby.
    fn is_before(&self, face: &Face, sample: f64) -> bool {
        let reach = 12.0 * self.bias;
        let surface = face.depth_at(self.at).clamp(sample - reach, sample + reach);
        self.depth + self.bias + self.slack * face.plane.truncate().length() >= surface
    }
}
