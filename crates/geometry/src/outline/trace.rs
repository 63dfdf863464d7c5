//! Tracing: marching squares at a threshold.

use contour::ContourBuilder;
use glam::{DVec2, DVec3};

use super::{Mask, OutlineError};
use crate::curve::Curve;
use crate::polygon;

/// Most points of all outlines of a picture, so that a texture does not take the machine.
const MAX_POINTS: usize = 200_000;

/// How near the level may come to the value of a pixel. A level that is one would put points onto one another.
const CLEAR: f64 = 1.0 / 512.0;

/// Which outlines are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Keep {
    /// The one that encloses most.
    Largest,
    /// All.
    All,
}

/// How outlines are traced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tracing {
    /// Values of at least this share of 255 are inside; between 0 and 1.
    pub threshold: f64,
    /// Which outlines are kept.
    pub keep: Keep,
    /// Whether the holes of the kept ones are kept.
    pub holes: bool,
    /// Outlines and holes that enclose less are left out, square pixels.
    pub least_area: f64,
}

impl Default for Tracing {
    /// The largest outline with its holes at half way between outside and inside, and no speck.
    fn default() -> Self {
        Self { threshold: 0.5, keep: Keep::Largest, holes: true, least_area: 16.0 }
    }
}

/// A traced outline, or a hole in one.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// Closed, in pixels with y up and z 0, from its highest point (the leftmost of several): counter-clockwise around
    /// a shape, clockwise around a hole. Named `outline 0`, `outline 1`, .. and `outline 0 hole 0`, ..
    pub curve: Curve,
    /// What it encloses, square pixels; the holes of an outline are not taken off.
    pub area: f64,
    /// The outline it is a hole in, by its index; none for an outline.
    pub hole_in: Option<usize>,
    /// Whether it runs along an edge of the picture, so that the shape may go on beyond.
    pub cut_off: bool,
}

/// [`trace_while`] that is never stopped.
///
/// # Errors
/// See there.
pub fn trace(mask: &Mask, tracing: &Tracing) -> Result<Vec<Outline>, OutlineError> {
    trace_while(mask, tracing, &|_| true)
}

/// The outlines of what is inside, the larger ones first, each followed by its holes.
///
/// Method: marching squares over the centres of the pixels (W. E. Lorensen and H. E. Cline 1987, in the plane; crate
/// `contour`), each crossing placed by linear interpolation between the two values: on an edge that is softened over a
/// pixel, as paint programs do it, within 0.1 pixels for edges that are straight over three pixels; on a hard edge
/// within 0.5. Beyond the edges of the picture nothing is inside. Pixels that touch at a corner only are apart. Time
/// and memory grow with the pixels and with the points of the outlines, of which there may be 200 000.
///
/// # Errors
/// [`OutlineError`] where a number is out of range, nothing or everything is inside, everything is smaller than the least
/// area, the outlines would have too many points, or `progress` (which is given the share that is done) answers false.
pub fn trace_while(
    mask: &Mask,
    tracing: &Tracing,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Vec<Outline>, OutlineError> {
    let go_on = |share: f64| if progress(share) { Ok(()) } else { Err(OutlineError::Stopped) };
    let Tracing { threshold, keep, holes, least_area } = *tracing;
    if !(threshold > 0.0 && threshold < 1.0) {
        return Err(OutlineError::Threshold { threshold });
    }
    if !(least_area.is_finite() && least_area >= 0.0) {
        return Err(OutlineError::Amount { what: "least area", value: least_area });
    }
    go_on(0.0)?;
    let level = clear_level(threshold);
    let (low, high) = mask.range();
    let (low, high) = (f64::from(low) / 255.0, f64::from(high) / 255.0);
    let Some([left, right, top, bottom]) = mask.extent(level) else {
        return Err(OutlineError::Nothing { threshold, low, high });
    };
    if low * 255.0 >= level {
        return Err(OutlineError::Everything { threshold, low, high });
    }
    // Only where something is inside, and one pixel around it; beyond the picture that is nothing.
    let (width, height) = (right - left + 3, bottom - top + 3);
    let grid = Grid { mask, left: left as isize - 1, top: top as isize - 1, width, height };
    let points = grid.crossings(level);
    if points > MAX_POINTS {
        return Err(OutlineError::TooRough { points, most: MAX_POINTS });
    }
    go_on(0.1)?;
    let mut rings = grid.rings(level)?;
    go_on(0.6)?;
    // Ties by place: the order does not depend on that of tracing.
    rings.sort_by(|a, b| b.area.abs().total_cmp(&a.area.abs()).then_with(|| by_place(a.points[0], b.points[0])));
    let largest = rings.iter().find(|ring| ring.area > 0.0).map_or(0.0, |ring| ring.area);
    if largest < least_area || largest <= 0.0 {
        return Err(OutlineError::TooSmall { largest, wanted: least_area });
    }
    rings.retain(|ring| ring.area.abs() >= least_area);
    let (shapes, gaps): (Vec<Ring>, Vec<Ring>) = rings.into_iter().partition(|ring| ring.area > 0.0);
    let mut within: Vec<Vec<Ring>> = vec![Vec::new(); shapes.len()];
    let count = gaps.len();
    for (done, gap) in gaps.into_iter().enumerate().filter(|_| holes) {
        go_on(0.6 + 0.4 * done as f64 / count as f64)?;
        // Shapes are sorted by size: the last one that encloses it is the one it is a hole in.
        if let Some(owner) = shapes.iter().rposition(|shape| shape.area > -gap.area && shape.encloses(&gap)) {
            within[owner].push(gap);
        }
    }
    let kept = if keep == Keep::Largest { 1 } else { shapes.len() };
    let mut outlines = Vec::new();
    for (index, (shape, gaps)) in shapes.into_iter().zip(within).take(kept).enumerate() {
        let owner = outlines.len();
        outlines.push(shape.outline(format!("outline {index}"), None, mask)?);
        for (number, gap) in gaps.into_iter().enumerate() {
            outlines.push(gap.outline(format!("outline {index} hole {number}"), Some(owner), mask)?);
        }
    }
    go_on(1.0)?;
    Ok(outlines)
}

/// The level of a threshold, a little off every value a pixel may have, with the same pixels inside.
fn clear_level(threshold: f64) -> f64 {
    let level = 255.0 * threshold;
    let value = level.round();
    if (level - value).abs() >= CLEAR {
        return level;
    }
    if level <= value { value - CLEAR } else { value + CLEAR }
}

/// From the top down, from the left.
fn by_place(a: DVec2, b: DVec2) -> std::cmp::Ordering {
    b.y.total_cmp(&a.y).then(a.x.total_cmp(&b.x))
}

/// The part of a mask that is traced.
struct Grid<'a> {
    mask: &'a Mask,
    left: isize,
    top: isize,
    width: usize,
    height: usize,
}

impl Grid<'_> {
    fn at(&self, x: usize, y: usize) -> u8 {
        self.mask.at(self.left + x as isize, self.top + y as isize)
    }

    /// How often the value passes the level between neighbouring pixels: the points there will be.
    fn crossings(&self, level: f64) -> usize {
        let inside = |x, y| f64::from(self.at(x, y)) >= level;
        let pixel = |(x, y): (usize, usize)| {
            let here = inside(x, y);
            usize::from(x + 1 < self.width && inside(x + 1, y) != here)
                + usize::from(y + 1 < self.height && inside(x, y + 1) != here)
        };
        (0..self.height).flat_map(|y| (0..self.width).map(move |x| (x, y))).map(pixel).sum()
    }

    /// The closed lines at the level, counter-clockwise around what is inside.
    fn rings(&self, level: f64) -> Result<Vec<Ring>, OutlineError> {
        let values: Vec<f32> =
            (0..self.height).flat_map(|y| (0..self.width).map(move |x| f32::from(self.at(x, y)))).collect();
        let builder = ContourBuilder::new(self.width, self.height, true);
        let lines =
            builder.lines(&values, &[level as f32]).map_err(|error| OutlineError::Library(error.to_string()))?;
        let (left, bottom) = (self.left as f64, self.mask.height() as f64 - self.top as f64);
        let point = |x: f32, y: f32| DVec2::new(left + f64::from(x), bottom - f64::from(y));
        let rings = lines.into_iter().flat_map(|line| line.into_inner().0.0);
        Ok(rings.filter_map(|ring| Ring::new(ring.0.iter().map(|at| point(at.x, at.y)).collect())).collect())
    }
}

/// A closed line in pixels with y up.
#[derive(Clone)]
struct Ring {
    points: Vec<DVec2>,
    /// Positive where it runs counter-clockwise.
    area: f64,
    low: DVec2,
    high: DVec2,
}

impl Ring {
    /// From its highest point; none where less than three points differ.
    fn new(mut points: Vec<DVec2>) -> Option<Self> {
        if points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        points.dedup();
        if points.len() < 3 {
            return None;
        }
        let first = (0..points.len()).min_by(|a, b| by_place(points[*a], points[*b]))?;
        points.rotate_left(first);
        let area = polygon::signed_area(&points);
        let bounds = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (low, high) = points.iter().fold(bounds, |(low, high), p| (low.min(*p), high.max(*p)));
        Some(Self { points, area, low, high })
    }

    /// Whether another line, which does not cross this one, lies inside.
    fn encloses(&self, other: &Self) -> bool {
        if other.low.cmplt(self.low).any() || other.high.cmpgt(self.high).any() {
            return false;
        }
        polygon::encloses(&self.points, other.points[0])
    }

    fn outline(self, name: String, hole_in: Option<usize>, mask: &Mask) -> Result<Outline, OutlineError> {
        let size = DVec2::new(mask.width() as f64, mask.height() as f64);
        let edge = DVec2::splat(0.5);
        let cut_off = self.low.cmplt(edge).any() || self.high.cmpgt(size - edge).any();
        let points = self.points.iter().map(|p| DVec3::new(p.x, p.y, 0.0)).collect();
        Ok(Outline { curve: Curve::new(name, points, true)?, area: self.area.abs(), hole_in, cut_off })
    }
}

#[cfg(test)]
pub(super) mod tests;
