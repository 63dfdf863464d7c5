//! SVG drawings into flat curves.

use std::panic::AssertUnwindSafe;

use glam::DVec2;
use usvg::roxmltree;
use usvg::tiny_skia_path::PathSegment;

use super::ReadError;

const FORMAT: &str = "SVG";

mod extent;

use extent::check_extent;

/// Most points into which all curves of a file are flattened.
const MAX_POINTS: usize = 1_000_000;

/// A flat curve: one subpath of a drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Path2d {
    /// The path's `id`, else `path 0`, `path 1`, .. in the order of the drawing. The subpaths of a path that has
    /// several are numbered behind that: `sleeve 0`, `sleeve 1`.
    pub name: String,
    /// Points in pixels, at least two, +x to the right and +y *down*. No point repeats the one before it, and the last
    /// one of a closed curve does not repeat the first.
    pub points: Vec<DVec2>,
    /// Whether the last point joins the first: the subpath ends in `Z`, or where it began.
    pub closed: bool,
}

/// The paths and basic shapes of an SVG drawing, in its order, as polylines.
///
/// Coordinates are pixels (user units of the outermost `svg`, 96 to the inch, behind `viewBox` and all transforms);
/// y runs downward as in the file. Curved segments are cut evenly in their parameter, into as many parts as keep every
/// chord within `tolerance_px` of its segment: by `|B(t) - chord| <= h^2 / 8 max |B''|` (Wang's bound), so that this
/// holds for every drawing. Arcs, circles and ellipses become cubics first, within 3e-4 of their radius. Coordinates
/// carry 24 bits.
///
/// Text, images, markers, clipping and hidden elements are ignored.
///
/// # Errors
/// [`ReadError`] where the tolerance is not positive or asks for more than a million points, where the bytes are empty,
/// no UTF-8, no SVG, nested deeper than 256 elements, or showing the same elements too
/// often, and where there is no visible path.
pub fn read(bytes: &[u8], tolerance_px: f64) -> Result<Vec<Path2d>, ReadError> {
    let tolerance = |problem| ReadError::Tolerance { tolerance: tolerance_px, problem };
    if !(tolerance_px.is_finite() && tolerance_px > 0.0) {
        return Err(tolerance("give a positive number of pixels, such as 0.1"));
    }
    if bytes.is_empty() {
        return Err(ReadError::Empty { format: FORMAT });
    }
    let tree = parse(bytes)?;
    let mut paths = Vec::new();
    let mut points_left = MAX_POINTS;
    let mut unnamed = 0;
    let mut pending: Vec<&usvg::Node> = tree.root().children().iter().rev().collect();
    while let Some(node) = pending.pop() {
        match node {
            usvg::Node::Group(group) => pending.extend(group.children().iter().rev()),
            usvg::Node::Path(path) if path.is_visible() => {
                let name = if path.id().is_empty() {
                    unnamed += 1;
                    format!("path {}", unnamed - 1)
                } else {
                    path.id().to_owned()
                };
                let mut subpaths = flattened(path, tolerance_px, &mut points_left)
                    .ok_or_else(|| tolerance("the drawing would have more than a million points: give a larger one"))?;
                let count = subpaths.len();
                for (index, subpath) in subpaths.iter_mut().enumerate() {
                    subpath.name = if count == 1 { name.clone() } else { format!("{name} {index}") };
                }
                paths.append(&mut subpaths);
            }
            _ => {}
        }
    }
    if paths.is_empty() {
        return Err(ReadError::Nothing {
            format: FORMAT,
            what: "visible path",
            remedy: "paths need a fill or a stroke, and text has to be turned into paths",
        });
    }
    Ok(paths)
}

fn malformed(place: String, problem: String) -> ReadError {
    ReadError::Malformed { format: FORMAT, place, problem }
}

fn parse(bytes: &[u8]) -> Result<usvg::Tree, ReadError> {
    if bytes.starts_with(&[0x1f, 0x8b]) {
        return Err(ReadError::Unsupported {
            format: FORMAT,
            what: "compression".to_owned(),
            remedy: "unpack the .svgz, or save as plain .svg",
        });
    }
    let text = std::str::from_utf8(bytes).map_err(|error| {
        malformed(format!("byte {}", error.valid_up_to()), "not UTF-8: save it again as plain SVG".to_owned())
    })?;
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..roxmltree::ParsingOptions::default() };
    let document = roxmltree::Document::parse_with_options(text, options)
        .map_err(|error| malformed(format!("line {}", error.pos().row), error.to_string()))?;
    check_extent(&document, bytes.len())?;
    let options = usvg::Options {
        // Markers would come as curves of their own.
        style_sheet: Some(
            "* { marker-start: none !important; marker-mid: none !important; marker-end: none !important }".to_owned(),
        ),
        // Images are not read, and above all not from disk.
        image_href_resolver: usvg::ImageHrefResolver {
            resolve_data: Box::new(|_, _, _| None),
            resolve_string: Box::new(|_, _| None),
        },
        ..usvg::Options::default()
    };
    let refused = |problem: String| malformed("the drawing".to_owned(), problem);
    // tiny-skia-path 0.12 breaks down over the bounds of curves whose numbers are extreme; nothing of it is kept.
    std::panic::catch_unwind(AssertUnwindSafe(|| usvg::Tree::from_xmltree(&document, &options)))
        .map_err(|_| refused("the numbers of a path are too large or too small to be measured".to_owned()))?
        .map_err(|error| refused(error.to_string()))
}

/// The subpaths of a path, without names; `None` where no points are left.
fn flattened(path: &usvg::Path, tolerance: f64, points_left: &mut usize) -> Option<Vec<Path2d>> {
    let transform = path.abs_transform();
    let [sx, kx, tx, ky, sy, ty] =
        [transform.sx, transform.kx, transform.tx, transform.ky, transform.sy, transform.ty].map(f64::from);
    let place = |p: usvg::tiny_skia_path::Point| {
        let (x, y) = (f64::from(p.x), f64::from(p.y));
        DVec2::new(sx * x + kx * y + tx, ky * x + sy * y + ty)
    };
    let mut subpaths = Vec::new();
    let mut points: Vec<DVec2> = Vec::new();
    for segment in path.data().segments() {
        let from = points.last().copied().unwrap_or_default();
        let added = match segment {
            PathSegment::MoveTo(p) => {
                finish(&mut subpaths, &mut points, false);
                points.push(place(p));
                1
            }
            PathSegment::LineTo(p) => {
                points.push(place(p));
                1
            }
            PathSegment::QuadTo(a, b) => {
                let (a, b) = (place(a), place(b));
                // The same curve as a cubic.
                cubic([from, from.lerp(a, 2.0 / 3.0), b.lerp(a, 2.0 / 3.0), b], tolerance, *points_left, &mut points)?
            }
            PathSegment::CubicTo(a, b, c) => {
                cubic([from, place(a), place(b), place(c)], tolerance, *points_left, &mut points)?
            }
            PathSegment::Close => {
                let first = points.first().copied();
                finish(&mut subpaths, &mut points, true);
                // What follows without a move begins where the closed part did.
                points.extend(first);
                1
            }
        };
        *points_left = points_left.checked_sub(added)?;
    }
    finish(&mut subpaths, &mut points, false);
    Some(subpaths)
}

/// Adds the points of a Bezier cubic behind its first one, and tells their number; `None` where it is too large.
fn cubic(curve: [DVec2; 4], tolerance: f64, points_left: usize, points: &mut Vec<DVec2>) -> Option<usize> {
    let [a, b, c, d] = curve;
    let bend = (a - 2.0 * b + c).length().max((b - 2.0 * c + d).length());
    let parts = (6.0 * bend / (8.0 * tolerance)).sqrt().ceil().max(1.0);
    if parts.is_nan() || parts > points_left as f64 {
        return None;
    }
    let parts = parts as usize;
    for k in 1..parts {
        let t = k as f64 / parts as f64;
        let s = 1.0 - t;
        points.push(s * s * s * a + 3.0 * s * s * t * b + 3.0 * s * t * t * c + t * t * t * d);
    }
    points.push(d);
    Some(parts)
}

/// Moves the points gathered into a subpath, where they make one.
fn finish(subpaths: &mut Vec<Path2d>, points: &mut Vec<DVec2>, ends_in_z: bool) {
    let mut points = std::mem::take(points);
    points.dedup();
    let returns = points.len() > 3 && points.first() == points.last();
    if points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    // Two points there and back are a line, whatever the file says.
    let closed = (ends_in_z || returns) && points.len() > 2;
    if points.len() > 1 && points.iter().all(|p| p.is_finite()) {
        subpaths.push(Path2d { name: String::new(), points, closed });
    }
}

#[cfg(test)]
mod tests;
