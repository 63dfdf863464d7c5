//! The outline of what is shown against what was sketched in a view, coloured by the distance between them.

use glam::{DVec2, DVec3};

use crate::drawable::{Line, LineRole, Segment};
use crate::panel::PanelContext;
use crate::sketch::correct::nearest;
use crate::sketch::target::{Plane, SketchTarget, points};

use super::camera::Direction;
use super::picture::{LineDraw, LineSource};

/// Colours from no distance to the largest that is told apart.
const SHADES: usize = 12;
/// Distance that gets the strongest colour, as a share of the sketch's diagonal.
const WORST: f64 = 0.02;
/// Farther than this share nothing was sketched: a rim of a cut limb, for one.
const UNDRAWN: f64 = 0.05;
/// Depth of a curve that counts as flat, metres: the grain of single precision.
const FLAT: f64 = 1e-5;

/// How the outline of a view stands to its sketches.
#[derive(Clone, Debug, Default)]
pub(crate) struct OutlineError {
    /// What it was made from: drawables, revision of the document, active node.
    key: Option<(Vec<u64>, u64, Option<maquette_graph::NodeId>)>,
    shades: Vec<Vec<Segment>>,
    undrawn: Vec<Segment>,
    /// In words.
    pub(crate) words: String,
}

impl OutlineError {
    /// Measures again where something changed.
    pub(crate) fn update(&mut self, context: &PanelContext<'_>, direction: Direction) {
        let Some(plane) = Plane::of_view(direction) else { return };
        let is_drawn = context.drawn();
        let shown = context.results.shown().iter().filter(|shown| is_drawn(shown));
        let drawables: Vec<_> = shown.flat_map(|shown| &shown.drawables).collect();
        let ids = drawables.iter().map(|drawable| drawable.id).collect();
        let key = Some((ids, context.document.revision(), context.view.active));
        if self.key == key {
            return;
        }
        let index = match direction {
            Direction::Front | Direction::Free => 0,
            Direction::Side => 1,
            Direction::Top => 2,
        };
        let surfaces = drawables.iter().filter_map(|drawable| drawable.surface.as_ref());
        let outlines: Vec<&Vec<DVec3>> = surfaces.flat_map(|surface| &surface.outlines[index]).collect();
        // Of the active sketch alone where it is of this view; else of all that are.
        let all: Vec<SketchTarget> = SketchTarget::all(context.graph()).filter(|t| t.plane.view == direction).collect();
        let active: Vec<SketchTarget> = all.iter().filter(|t| Some(t.node) == context.view.active).cloned().collect();
        let targets = if active.is_empty() { all } else { active };
        let strokes = targets.iter().flat_map(|target| &target.strokes);
        let mut sketched: Vec<(Vec<DVec2>, bool)> = strokes.map(|stroke| (points(stroke), stroke.closed)).collect();
        if sketched.is_empty() {
            // Strokes may come from files too: shown curves that lie flat in this view count as drawn in it.
            let curves = drawables.iter().flat_map(|drawable| &drawable.lines);
            sketched.extend(curves.filter(|line| line.role == LineRole::Curve).filter_map(|line| flat(line, plane)));
        }
        *self = measured(&outlines, &sketched, plane);
        self.key = key;
    }

    /// The lines to draw.
    pub(crate) fn lines(&self) -> Vec<LineDraw> {
        let draw = |segments: &[Segment], colour: [f32; 4], width| LineDraw {
            source: LineSource::Own(segments.to_vec()),
            colour,
            width,
            on_top: true,
        };
        let mut lines = vec![draw(&self.undrawn, [0.6, 0.62, 0.66, 0.8], 2.0)];
        lines.extend(self.shades.iter().enumerate().map(|(shade, segments)| draw(segments, colour(shade), 4.0)));
        lines
    }
}

/// A line in the coordinates of a plane, where it lies in one that is parallel to it.
fn flat(line: &Line, plane: Plane) -> Option<(Vec<DVec2>, bool)> {
    let places: Vec<DVec3> = line.points.iter().map(|p| p.as_dvec3()).collect();
    let depths = places.iter().map(|place| place.dot(plane.normal()));
    let [low, high] = depths.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], d| [low.min(d), high.max(d)]);
    (high - low < FLAT).then(|| (places.iter().map(|place| plane.drawn(*place)).collect(), line.closed))
}

/// Green over yellow to red.
#[expect(clippy::cast_precision_loss, reason = "a few shades")]
fn colour(shade: usize) -> [f32; 4] {
    let t = shade as f32 / (SHADES - 1) as f32;
    let [low, middle, high] = [[0.20, 0.74, 0.38], [0.96, 0.80, 0.25], [0.90, 0.18, 0.16]];
    let mix = |a: [f32; 3], b: [f32; 3], t: f32| [0, 1, 2].map(|k| a[k] + (b[k] - a[k]) * t);
    let [r, g, b] = if t < 0.5 { mix(low, middle, 2.0 * t) } else { mix(middle, high, 2.0 * t - 1.0) };
    [r, g, b, 1.0]
}

fn measured(outlines: &[&Vec<DVec3>], sketched: &[(Vec<DVec2>, bool)], plane: Plane) -> OutlineError {
    let mut error = OutlineError { shades: vec![Vec::new(); SHADES], ..OutlineError::default() };
    let places = sketched.iter().flat_map(|(line, _)| line);
    let around = places.fold(None, |found: Option<[DVec2; 2]>, p| {
        Some(found.map_or([*p, *p], |[low, high]| [low.min(*p), high.max(*p)]))
    });
    let diagonal = around.map_or(0.0, |[low, high]| low.distance(high));
    if outlines.is_empty() || diagonal <= 0.0 {
        error.words = if outlines.is_empty() { "no outline here" } else { "nothing sketched in this view" }.to_owned();
    }
    let distance = |point: DVec2| {
        let near = sketched.iter().filter_map(|(line, closed)| Some(nearest(line, *closed, point)?.distance));
        near.fold(f64::INFINITY, f64::min)
    };
    let flat: Vec<Vec<DVec2>> =
        outlines.iter().map(|outline| outline.iter().map(|place| plane.drawn(*place)).collect()).collect();
    for (outline, line) in outlines.iter().zip(&flat) {
        let offs: Vec<f64> = line.iter().map(|point| distance(*point)).collect();
        for k in 0..outline.len() {
            let next = (k + 1) % outline.len();
            let piece = Segment { from: outline[k].as_vec3().to_array(), to: outline[next].as_vec3().to_array() };
            let off = offs[k].max(offs[next]) / diagonal.max(f64::MIN_POSITIVE);
            if off > UNDRAWN {
                error.undrawn.push(piece);
                continue;
            }
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of a few shades")]
            let shade = ((off / WORST).min(1.0) * (SHADES - 1) as f64).round() as usize;
            error.shades[shade].push(piece);
        }
    }
    // From what was sketched to the outline, which is what an artist asks for.
    let offs: Vec<f64> = sketched
        .iter()
        .flat_map(|(line, _)| line)
        .map(|point| {
            let near = flat.iter().filter_map(|line| Some(nearest(line, true, *point)?.distance));
            near.fold(f64::INFINITY, f64::min)
        })
        .filter(|off| off.is_finite())
        .collect();
    if !offs.is_empty() && error.words.is_empty() {
        let largest = offs.iter().copied().fold(0.0, f64::max);
        let mean = offs.iter().sum::<f64>() / offs.len() as f64;
        error.words = format!(
            "sketch to outline: largest {:.2} mm ({:.3} %), mean {:.2} mm",
            1e3 * largest,
            100.0 * largest / diagonal,
            1e3 * mean
        );
    }
    error
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_fits_is_green_what_does_not_is_red_and_what_was_not_drawn_is_grey() {
        let plane = Plane::of_view(Direction::Front).unwrap();
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.3)).to_vec();
        // The lower side as it is, the right one 1 % of the diagonal off.
        let off = 1.0 + 0.01 * 2.0_f64.sqrt();
        let sketched =
            [(vec![DVec2::ZERO, DVec2::X], false), (vec![DVec2::new(off, 0.0), DVec2::new(off, 1.0)], false)];
        let error = measured(&[&square], &sketched, plane);
        let counts: Vec<usize> = error.shades.iter().map(Vec::len).collect();
        assert_eq!(counts.iter().sum::<usize>() + error.undrawn.len(), 4);
        assert_eq!((counts[0], error.undrawn.len()), (1, 2), "{counts:?}");
        assert!(counts[5] + counts[6] == 1, "half way to the strongest colour: {counts:?}");
        assert!(error.words.contains("largest 14.14 mm"), "{}", error.words);
    }
}
