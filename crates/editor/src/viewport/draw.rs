//! From the state of the editor to the picture of a view.

use std::sync::Arc;

use maquette_graph::{NodeId, Stroke};

use crate::drawable::{LineRole, Segment, Shown};
use crate::panel::PanelContext;
use crate::sketch::target::{SketchTarget, points};

use super::camera::{Camera, Direction, ViewSize};
use super::grid::Grid;
use super::picture::{LineDraw, LineSource, Picture, Shading, SurfaceDraw, ViewUniform};

/// Colour of what nobody gave a colour.
const CLAY: [f32; 4] = [0.80, 0.72, 0.64, 1.0];
const ACCENT: [f32; 4] = [1.0, 0.62, 0.18, 1.0];

/// Colours that depend on light or dark.
struct Palette {
    fine: [f32; 4],
    coarse: [f32; 4],
    wire: [f32; 4],
    sketch: [f32; 4],
    curve: [f32; 4],
    section: [f32; 4],
    rail: [f32; 4],
}

const DARK: Palette = Palette {
    fine: [1.0, 1.0, 1.0, 0.045],
    coarse: [1.0, 1.0, 1.0, 0.12],
    wire: [0.02, 0.03, 0.05, 0.34],
    sketch: [0.55, 0.78, 1.0, 0.95],
    curve: [0.87, 0.89, 0.93, 0.9],
    section: [0.45, 0.86, 0.72, 0.8],
    rail: [0.98, 0.86, 0.42, 0.95],
};
const LIGHT: Palette = Palette {
    fine: [0.0, 0.0, 0.0, 0.05],
    coarse: [0.0, 0.0, 0.0, 0.13],
    wire: [0.02, 0.03, 0.05, 0.34],
    sketch: [0.06, 0.32, 0.72, 0.95],
    curve: [0.2, 0.22, 0.26, 0.9],
    section: [0.0, 0.45, 0.36, 0.8],
    rail: [0.65, 0.42, 0.0, 0.95],
};

/// What is behind everything in a view.
pub(crate) fn background(dark: bool) -> egui::Color32 {
    if dark { egui::Color32::from_rgb(34, 37, 42) } else { egui::Color32::from_rgb(227, 230, 235) }
}

/// Colours of the world's axes, X, Y, Z.
pub(crate) const AXES: [[f32; 4]; 3] = [[0.86, 0.30, 0.32, 0.8], [0.46, 0.74, 0.28, 0.8], [0.30, 0.52, 0.92, 0.8]];

/// What a picture is made for.
pub(crate) struct PictureOf<'a> {
    pub(crate) view: u64,
    pub(crate) camera: &'a Camera,
    pub(crate) size: ViewSize,
    pub(crate) pixels: [u32; 2],
    pub(crate) dark: bool,
    pub(crate) samples: u32,
}

/// The picture of a view.
pub(crate) fn picture(context: &PanelContext<'_>, of: &PictureOf<'_>, grid: &Grid) -> Picture {
    let palette = if of.dark { &DARK } else { &LIGHT };
    let settings = &*context.settings;
    let mut lines = Vec::new();
    if settings.grid {
        let own = |segments: &[Segment], colour, width| LineDraw {
            source: LineSource::Own(segments.to_vec()),
            colour,
            width,
            on_top: false,
        };
        lines.push(own(&grid.fine, palette.fine, 1.0));
        lines.push(own(&grid.coarse, palette.coarse, 1.0));
        lines.extend(grid.axes.iter().map(|(axis, line)| own(std::slice::from_ref(line), AXES[*axis], 1.5)));
    }
    let active = context.view.active;
    let is_drawn = context.drawn();
    let mut surfaces = Vec::new();
    for shown in context.results.shown() {
        let is_drawn = is_drawn(shown);
        let is_active = context.is_here(shown) && active == Some(shown.node);
        if context.view.displayed_within.is_some() && !is_drawn && !is_active {
            continue;
        }
        for drawable in &shown.drawables {
            let colour = drawable.colour.unwrap_or(CLAY);
            // A selection is shown over its mesh while its node is looked at.
            let over = drawable.is_selection && is_active;
            let colour = if over { ACCENT } else { colour };
            if let Some(surface) = drawable.surface.as_ref().filter(|_| is_drawn || over) {
                let wanted = match settings.shading {
                    Shading::Facets => true,
                    Shading::Zebra | Shading::Silhouette => false,
                    _ => settings.wire,
                };
                surfaces.push(SurfaceDraw {
                    drawable: drawable.clone(),
                    colour,
                    wire: faded(palette.wire, surface.edge_length / of.camera.metres_per_point(of.size))
                        .filter(|_| wanted),
                    mark: match (over, is_active) {
                        (true, _) => 0.55,
                        (_, true) => 0.08,
                        _ => 0.0,
                    },
                    forward: over,
                });
            }
            let roles = [
                (LineRole::Curve, settings.curves, drawable.colour.unwrap_or(palette.curve), 2.0),
                (LineRole::Section, settings.sections, palette.section, 1.0),
                (LineRole::Rail, settings.sections, palette.rail, 2.0),
            ];
            for (role, wanted, colour, width) in roles {
                if wanted && drawable.lines.iter().any(|line| line.role == role) {
                    let colour = if is_active && role == LineRole::Curve { ACCENT } else { colour };
                    let source = LineSource::Drawable(Arc::clone(drawable), role);
                    lines.push(LineDraw { source, colour, width, on_top: is_active && role == LineRole::Curve });
                }
            }
        }
    }
    if settings.curves {
        lines.extend(sketches(context, palette, of.camera.direction));
    }
    lines.extend(picked_row(context));
    Picture {
        view: of.view,
        size: of.pixels,
        uniform: ViewUniform::new(of.camera, of.size, of.pixels, settings.shading),
        samples: of.samples,
        surfaces,
        lines,
    }
}

/// What the picked row of the data panel speaks of, thick and in front.
fn picked_row(context: &PanelContext<'_>) -> Option<LineDraw> {
    let picked = context.view.picked_row.as_ref()?;
    let node = context.graph().node(picked.node)?;
    let table = context.report(picked.node)?.tables.iter().find(|table| table.name == picked.table)?;
    let is_of = |shown: &&Shown| context.is_here(shown) && shown.node == picked.node;
    let shown = context.results.shown().iter().find(is_of)?;
    let drawables: Vec<_> = shown.drawables.iter().map(|drawable| &**drawable).collect();
    let segments = super::picked_row::segments(&drawables, node, table, picked.row);
    let own = LineDraw { source: LineSource::Own(segments), colour: ACCENT, width: 4.5, on_top: true };
    Some(own).filter(|own| matches!(&own.source, LineSource::Own(segments) if !segments.is_empty()))
}

/// The colour of edges that are so many points long on the screen: where they would fill the surface, it is better without.
#[expect(clippy::cast_possible_truncation, reason = "a share")]
fn faded([r, g, b, a]: [f32; 4], points: f64) -> Option<[f32; 4]> {
    let share = ((points - 2.0) / 6.0).clamp(0.0, 1.0) as f32;
    (share > 0.02).then_some([r, g, b, a * share])
}

/// The strokes of the graph, straight from the document: they follow the pen without waiting for anything.
fn sketches(context: &PanelContext<'_>, palette: &Palette, direction: Direction) -> Vec<LineDraw> {
    let is_selected = |node: &NodeId| context.view.selection.contains(node);
    let draw = |target: SketchTarget| {
        let selected = is_selected(&target.node);
        let picked = &context.view.picked_strokes;
        let active = context.view.active == Some(target.node) && !picked.is_empty();
        // Of the active sketch, those strokes are thin that nothing would be done with.
        [true, false].map(|thick| {
            let within = |index: usize| !active || picked.contains(&index);
            let strokes = target.strokes.iter().enumerate().filter(|(index, _)| within(*index) == thick);
            let strokes = strokes.map(|(_, stroke)| stroke);
            let mut lines = strokes_of(&target, strokes, palette, selected, thick);
            // What was drawn in this view is seen through everything, as it can be picked.
            lines.on_top |= target.plane.view == direction;
            lines
        })
    };
    SketchTarget::all(context.graph()).flat_map(draw).collect()
}

fn strokes_of<'a>(
    target: &SketchTarget,
    strokes: impl Iterator<Item = &'a Stroke>,
    palette: &Palette,
    selected: bool,
    thick: bool,
) -> LineDraw {
    let mut segments = Vec::new();
    for stroke in strokes {
        let place = |p: &glam::DVec2| target.plane.place(*p).as_vec3().to_array();
        let places: Vec<[f32; 3]> = points(stroke).iter().map(place).collect();
        segments.extend(places.windows(2).map(|pair| Segment { from: pair[0], to: pair[1] }));
        if let (true, Some(first), Some(last)) = (stroke.closed, places.first(), places.last()) {
            segments.push(Segment { from: *last, to: *first });
        }
    }
    LineDraw {
        source: LineSource::Own(segments),
        colour: if selected { ACCENT } else { palette.sketch },
        width: if selected && thick { 3.0 } else { 1.6 },
        on_top: selected,
    }
}
