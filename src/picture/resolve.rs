//! From samples to pixels: shading, lines, and bytes, tile by tile.

use glam::{DVec2, Vec3};
use rayon::prelude::*;

use super::backdrop::Backdrop;
use super::camera::Camera;
use super::face::{Face, blend, faces};
use super::light::Studio;
use super::rasterizer::{NOTHING, PATTERN, SAMPLES, TileSamples, opacity_mask};
use super::shading::{Fragment, ToneCurve};
use super::stroke::{Ink, Strokes};
use super::subject::Subject;
use super::tile::{Bins, PixelRect, TILE};

/// Samples of one surface in a pixel are shaded together where their normals' cosine is at least this, and they lie no
/// farther apart than [`SAME_PLACE`].
const SAME_NORMAL: f32 = 0.9;
/// In subject units.
const SAME_PLACE: f32 = 0.03;
/// Pixels a side of a block in which shadows are asked for only once, where normals and places are as good as the same.
const BLOCK: usize = 2;
/// Least cosine between normals for that.
const SAME_SHADOW_NORMAL: f32 = 0.99;
/// Greatest distance for that, in subject units: a fifth of a texel of the shadow maps.
const SAME_SHADOW_PLACE: f32 = 0.002;

/// The bytes of a picture, row by row.
pub(super) fn pixels(
    subject: &Subject,
    camera: &Camera,
    strokes: &mut Strokes,
    width: usize,
    height: usize,
) -> Vec<u8> {
    let studio = Studio::new(subject, camera);
    let backdrop = Backdrop::new(subject, &studio, camera, height);
    let faces = faces(subject, camera);
    let bins = Bins::new(width, height, faces.iter().map(Face::bounds));
    strokes.sort(width, height);
    let painter = Painter {
        subject,
        camera,
        studio: &studio,
        backdrop: &backdrop,
        faces: &faces,
        masks: subject.models.iter().map(|model| opacity_mask(model.opacity)).collect(),
    };
    let strokes = &*strokes;
    let tone = ToneCurve::new();
    let mut rgb = vec![0; width * height * 3];
    let tools = || (TileSamples::new(), Ink::new(), Shadows::new());
    rgb.par_chunks_mut(width * TILE * 3).enumerate().for_each_init(tools, |(samples, ink, shadows), (row, band)| {
        let (top, rows) = (row * TILE, band.len() / (width * 3));
        for column in 0..width.div_ceil(TILE) {
            let left = column * TILE;
            shadows.0.fill(None);
            samples.begin(PixelRect { left, top, right: width.min(left + TILE), bottom: top + rows });
            for &index in bins.of(row, column) {
                let face = &faces[index as usize];
                samples.fill(face, index, painter.masks[face.model as usize]);
            }
            let rect = samples.rect;
            for y in rect.top..rect.bottom {
                for x in rect.left..rect.right {
                    ink.colours[(y - top) * TILE + x - left] = painter.colour(samples, shadows, x, y);
                }
            }
            strokes.draw(samples, [row, column], &faces, camera, ink);
            for y in 0..rows {
                for x in 0..rect.right - left {
                    let at = (y * width + left + x) * 3;
                    band[at..at + 3].copy_from_slice(&tone.bytes(ink.colours[y * TILE + x]));
                }
            }
        }
    });
    rgb
}

struct Painter<'a> {
    subject: &'a Subject<'a>,
    camera: &'a Camera,
    studio: &'a Studio,
    backdrop: &'a Backdrop<'a>,
    faces: &'a [Face],
    masks: Vec<u16>,
}

/// Samples of a pixel that are shaded together.
struct Group {
    model: u32,
    back: bool,
    count: f32,
    /// Sums over the samples.
    place: Vec3,
    normal: Vec3,
}

impl Painter<'_> {
    /// Linear colour of a pixel before lines.
    fn colour(&self, samples: &TileSamples, shadows: &mut Shadows, x: usize, y: usize) -> Vec3 {
        let seen = samples.seen(x, y);
        let corner = DVec2::new(x as f64, y as f64);
        let mut groups: Vec<Group> = Vec::new();
        let mut empty = 0.0;
        let mut done = 0_u16;
        for first in 0..SAMPLES {
            if done >> first & 1 == 1 {
                continue;
            }
            let mut count = 0.0;
            let mut at = DVec2::ZERO;
            for k in first..SAMPLES {
                if seen[k] == seen[first] {
                    done |= 1 << k;
                    count += 1.0;
                    at += PATTERN[k];
                }
            }
            if seen[first] == NOTHING {
                empty = count as f32;
            } else {
                let face = &self.faces[seen[first] as usize];
                join(&mut groups, self.sample(face, corner + at / count, count as f32));
            }
        }
        let block = shadows.block(x - samples.rect.left, y - samples.rect.top);
        let mut sum = Vec3::ZERO;
        for group in &groups {
            // Each surface is tone-mapped only after mixing; bright rims would eat thin dark parts otherwise.
            sum += self.shade(group, block).min(Vec3::splat(1.5)) * group.count;
        }
        if empty > 0.0 {
            sum += self.backdrop.colour(x, y) * empty;
        }
        sum / SAMPLES as f32
    }

    fn sample(&self, face: &Face, at: DVec2, count: f32) -> Group {
        let weights = self.camera.in_space(face.weights(at), face.depth);
        let normal = blend(&face.normal, weights).normalize_or(face.normal[0]);
        Group {
            model: face.model,
            back: face.back,
            count,
            place: blend(&face.place, weights) * count,
            normal: normal * count,
        }
    }

    fn shade(&self, group: &Group, block: &mut Option<Shadow>) -> Vec3 {
        let place = group.place / group.count;
        let outside = group.normal.normalize_or(Vec3::Y);
        let normal = if group.back { -outside } else { outside };
        let known = block.as_ref().filter(|shadow| shadow.holds_for(group.model, place, normal));
        let reached = known.map(|shadow| shadow.reached).unwrap_or_else(|| {
            let reached = [self.studio.sky_visibility(place, normal), self.studio.key_visibility(place, normal)];
            *block = Some(Shadow { model: group.model, place, normal, reached });
            reached
        });
        let bounds = &self.subject.bounds;
        let world = bounds.centre + place.as_dvec3() * bounds.radius;
        let towards_eye = self.camera.towards_eye(world).as_vec3();
        let fragment = Fragment { normal, towards_eye, back: group.back, reached };
        self.subject.models[group.model as usize].surface.shade(self.studio, &fragment)
    }
}

/// What light reaches a point, kept for its neighbours.
#[derive(Clone)]
struct Shadow {
    model: u32,
    place: Vec3,
    normal: Vec3,
    /// See [`Fragment::reached`].
    reached: [f32; 2],
}

impl Shadow {
    fn holds_for(&self, model: u32, place: Vec3, normal: Vec3) -> bool {
        self.model == model
            && self.normal.dot(normal) >= SAME_SHADOW_NORMAL
            && self.place.distance_squared(place) < SAME_SHADOW_PLACE * SAME_SHADOW_PLACE
    }
}

/// The last answer in each block of a tile.
struct Shadows(Vec<Option<Shadow>>);

impl Shadows {
    fn new() -> Self {
        Self(vec![None; TILE.div_ceil(BLOCK).pow(2)])
    }

    fn block(&mut self, x: usize, y: usize) -> &mut Option<Shadow> {
        &mut self.0[y / BLOCK * TILE.div_ceil(BLOCK) + x / BLOCK]
    }
}

/// Adds samples to the group of their surface, or as a group of their own.
fn join(groups: &mut Vec<Group>, new: Group) {
    let alike = |group: &&mut Group| {
        let apart = group.place / group.count - new.place / new.count;
        group.model == new.model
            && group.back == new.back
            && group.normal.dot(new.normal) >= SAME_NORMAL * group.normal.length() * new.normal.length()
            && apart.length_squared() < SAME_PLACE * SAME_PLACE
    };
    match groups.iter_mut().find(alike) {
        Some(group) => {
            group.count += new.count;
            group.place += new.place;
            group.normal += new.normal;
        }
        None => groups.push(new),
    }
}
