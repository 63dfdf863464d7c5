//! What is behind and below the subject: a plain studio backdrop, a grid in metres, and the subject's shadow.

use glam::{DVec2, DVec3, Vec2, Vec3};
use rayon::prelude::*;

use super::camera::Camera;
use super::light::Studio;
use super::shading::to_linear;
use super::subject::Subject;

/// sRGB at the top and at the bottom of the picture.
const GRADIENT: [Vec3; 2] = [Vec3::new(0.925, 0.930, 0.937), Vec3::new(0.800, 0.806, 0.815)];
/// Lines of the grid, linear.
const GRID_COLOUR: Vec3 = Vec3::new(0.16, 0.18, 0.22);
/// Opacity of fine lines, of every tenth one, and of those through the origin.
const GRID_OPACITY: [f32; 3] = [0.075, 0.20, 0.42];
/// Pixels that the fine lines of the grid are apart at least.
const GRID_SPACING: f64 = 8.0;
/// Texels of the shadow on the floor a side.
const FLOOR_SIDE: usize = 128;
/// Half the side of the floor, in radii of the subject.
const FLOOR_REACH: f64 = 2.1;

/// Everything behind the subject.
pub(super) struct Backdrop<'a> {
    camera: &'a Camera,
    /// Linear colour of each row of pixels without grid and shadow.
    rows: Vec<Vec3>,
    /// Metres between fine lines.
    spacing: f64,
    grid: Grid,
}

enum Grid {
    /// On a plane through the origin parallel to the picture: axes to the right and down.
    Upright([DVec3; 2]),
    /// On the floor below the subject.
    Floor(Floor),
}

/// A horizontal plane that takes the subject's shadow and fades around it.
struct Floor {
    centre: DVec3,
    radius: f64,
    /// Light that arrives, 0 to 1, row by row along +Z.
    light: Vec<f32>,
}

impl<'a> Backdrop<'a> {
    /// The backdrop of a picture `height` pixels high.
    pub fn new(subject: &Subject, studio: &Studio, camera: &'a Camera, height: usize) -> Self {
        let grid = if camera.is_parallel() {
            Grid::Upright([camera.right, -camera.up])
        } else {
            Grid::Floor(Floor::new(subject, studio))
        };
        let pixels = camera.pixels_per_metre(subject.bounds.centre);
        let [top, bottom] = GRADIENT;
        let row = |y: usize| {
            let t = (y as f32 + 0.5) / height as f32;
            to_linear(top.lerp(bottom, t * t * (3.0 - 2.0 * t)))
        };
        Self { camera, rows: (0..height).map(row).collect(), spacing: fine_spacing(pixels), grid }
    }

    /// Linear colour of a pixel, at its centre.
    pub fn colour(&self, x: usize, y: usize) -> Vec3 {
        let plain = self.rows[y];
        let pixel = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        match &self.grid {
            Grid::Upright(axes) => {
                let (point, _) = self.camera.ray(pixel);
                let metres_per_pixel = 1.0 / self.camera.pixels_per_metre(point);
                let line = |axis: DVec3| self.line_opacity(point.dot(axis), metres_per_pixel, 1.0);
                plain.lerp(GRID_COLOUR, line(axes[0]).max(line(axes[1])))
            }
            Grid::Floor(floor) => {
                let Some(at) = floor.hit(self.camera, pixel) else { return plain };
                let fade = floor.fade(at);
                if fade <= 0.0 {
                    return plain;
                }
                let lit = plain * (1.0 - fade * 0.8 * (1.0 - floor.light_at(at)));
                let right = floor.hit(self.camera, pixel + DVec2::X);
                let below = floor.hit(self.camera, pixel + DVec2::Y);
                let (Some(right), Some(below)) = (right, below) else { return lit };
                let line = |coordinate: f64, right: f64, below: f64| {
                    let footprint = DVec2::new(right - coordinate, below - coordinate).length();
                    let room = (self.spacing / footprint / GRID_SPACING).clamp(0.0, 1.0);
                    self.line_opacity(coordinate, footprint, room as f32)
                };
                let line = line(at.x, right.x, below.x).max(line(at.z, right.z, below.z));
                lit.lerp(GRID_COLOUR, line * fade)
            }
        }
    }

    /// Opacity of the grid lines across one axis, at a coordinate in metres, one pixel wide; `fine` weakens the fine
    /// ones.
    fn line_opacity(&self, coordinate: f64, metres_per_pixel: f64, fine: f32) -> f32 {
        let cover =
            |distance: f64, width: f64| (width * 0.5 + 0.5 - distance.abs() / metres_per_pixel).clamp(0.0, 1.0) as f32;
        let to_multiple = |step: f64| coordinate - (coordinate / step).round() * step;
        let [thin, strong, origin] = GRID_OPACITY;
        (cover(to_multiple(self.spacing), 1.0) * thin * fine)
            .max(cover(to_multiple(self.spacing * 10.0), 1.0) * strong)
            .max(cover(coordinate, 1.5) * origin)
    }
}

/// Metres between fine grid lines: a power of ten that leaves [`GRID_SPACING`].
fn fine_spacing(pixels_per_metre: f64) -> f64 {
    10_f64.powf((GRID_SPACING / pixels_per_metre).log10().ceil())
}

impl Floor {
    fn new(subject: &Subject, studio: &Studio) -> Self {
        let bounds = &subject.bounds;
        let mut centre = bounds.centre;
        centre.y = bounds.low.y;
        let radius = bounds.radius * FLOOR_REACH;
        let texel = |index: usize| {
            let (row, column) = (index / FLOOR_SIDE, index % FLOOR_SIDE);
            let offset = DVec2::new(column as f64, row as f64) / (FLOOR_SIDE - 1) as f64 * 2.0 - 1.0;
            if offset.length_squared() > 1.0 {
                return 1.0;
            }
            let place = subject.place(centre + DVec3::new(offset.x, 0.0, offset.y) * radius);
            let (sky, key) = (studio.sky_visibility(place, Vec3::Y), studio.key_visibility(place, Vec3::Y));
            0.55 * sky + 0.45 * key
        };
        let light = (0..FLOOR_SIDE * FLOOR_SIDE).into_par_iter().map(texel).collect();
        Self { centre, radius, light }
    }

    /// Where the ray through a pixel meets the floor, in the world; `None` at and above the horizon.
    fn hit(&self, camera: &Camera, pixel: DVec2) -> Option<DVec3> {
        let (start, direction) = camera.ray(pixel);
        let t = (self.centre.y - start.y) / direction.y;
        (direction.y < 0.0 && t > 0.0).then(|| start + direction * t)
    }

    fn fade(&self, at: DVec3) -> f32 {
        let t = (1.0 - (at - self.centre).length() / self.radius).clamp(0.0, 1.0) as f32;
        t * t * (3.0 - 2.0 * t)
    }

    fn light_at(&self, at: DVec3) -> f32 {
        let offset = (at - self.centre) / self.radius;
        let last = (FLOOR_SIDE - 1) as f32;
        let texel =
            ((Vec2::new(offset.x as f32, offset.z as f32) + 1.0) * 0.5 * last).clamp(Vec2::ZERO, Vec2::splat(last));
        let low = texel.floor().min(Vec2::splat(last - 1.0));
        let part = texel - low;
        let first = low.y as usize * FLOOR_SIDE + low.x as usize;
        let row = |first: usize| self.light[first] * (1.0 - part.x) + self.light[first + 1] * part.x;
        row(first) * (1.0 - part.y) + row(first + FLOOR_SIDE) * part.y
    }
}
