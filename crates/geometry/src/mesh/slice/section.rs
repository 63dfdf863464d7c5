//! One section: a loop given direction, start and points.

use glam::{DVec2, DVec3};

use super::chain::Loop;
use super::plane::{Frame, Plane};
use super::warning::SliceWarning;
use crate::curve::{Curve, CurveError, ResampleError, Resampling, resample};
use crate::polygon::signed_area;

/// Which surface a ray is to find.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Hit {
    /// The farthest from the bone: the outermost of several layers, but also another limb behind this one.
    #[default]
    Last,
    /// The nearest to the bone.
    First,
}

/// How a section is found in its plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Method {
    /// The loop around the bone, its points at equal arc length. Finds folds that no ray from the bone sees.
    #[default]
    Loop,
    /// Rays from the bone, one a point, at equal angles from the front, counter-clockwise (thesis 4.1). Sees no folds,
    /// and needs no loop that closes: only a surface in every direction.
    Rays(Hit),
}

/// How sections are made, wherever their planes stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SectionOptions {
    /// Points of each section, 3 to [`MAX_POINTS`](crate::curve::MAX_POINTS).
    pub points: usize,
    /// Direction that tells where sections begin; any length. Where all planes have it as their normal to within 26
    /// degrees, +Y takes its place, then +X.
    pub front: DVec3,
    /// How they are found.
    pub method: Method,
}

impl Default for SectionOptions {
    /// 64 points by loops, beginning at the model's front (+Z).
    fn default() -> Self {
        Self { points: 64, front: DVec3::Z, method: Method::Loop }
    }
}

/// Loops and chains in a plane beside the one that was taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Others {
    /// Closed loops that are around the bone too: cavities, or clothes.
    pub around: usize,
    /// Closed loops elsewhere: the other leg.
    pub beside: usize,
    /// Chains that do not close.
    pub open: usize,
}

/// A cross-section of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// Which of the planes asked for, counted from 0.
    pub index: usize,
    /// The section: closed, counter-clockwise seen against the plane's normal, beginning at the front. By loops that is
    /// where the ray from the centroid to the front leaves for good (the point farthest to the front where it meets
    /// nothing); by rays where the first ray hits.
    pub curve: Curve,
    /// Its plane. The origin is the bone's point, the normal its direction.
    pub plane: Plane,
    /// Unit vector in the plane: where its front is.
    pub front: DVec3,
    /// Length around, metres; by loops as cut, before the points were spaced.
    pub perimeter: f64,
    /// Area enclosed, square metres, likewise.
    pub area: f64,
    /// Distance of the enclosed area's centroid from the bone, metres.
    pub offset: f64,
    /// What else was in the plane. None by rays, which do not see it.
    pub others: Option<Others>,
}

/// Sections in the order of their planes.
#[derive(Clone, Debug, PartialEq)]
pub struct Sliced {
    /// The sections; at least one. A plane that does not meet the mesh has none, and a warning.
    pub sections: Vec<Section>,
    /// What should be looked at, in the order of the first section concerned; sections that cross come last.
    pub warnings: Vec<SliceWarning>,
}

/// Why points make no section.
pub(super) enum NoSection {
    Curve(CurveError),
    Resample(ResampleError),
}

/// The section a loop makes.
pub(super) fn from_loop(
    index: usize,
    frame: &Frame,
    contour: &Loop,
    points: usize,
    others: Others,
) -> Result<Section, NoSection> {
    let mut points_in_space = contour.points.clone();
    let mut flat: Vec<DVec2> = points_in_space.iter().map(|p| frame.flat(*p)).collect();
    if signed_area(&flat) < 0.0 {
        points_in_space.reverse();
        flat.reverse();
    }
    let (segment, share) = front_of(&flat, centroid(&flat));
    let next = (segment + 1) % points_in_space.len();
    let start = points_in_space[segment].lerp(points_in_space[next], share);
    let mut ordered = vec![start];
    ordered.extend_from_slice(&points_in_space[segment + 1..]);
    ordered.extend_from_slice(&points_in_space[..=segment]);
    let whole = Curve::new(format!("section {index}"), ordered, true).map_err(NoSection::Curve)?;
    let curve = resample(&whole, &Resampling::count(points)).map_err(NoSection::Resample)?;
    Ok(measured(index, frame, curve, &flat, Some(others)))
}

/// The section that points in order make.
pub(super) fn from_points(index: usize, frame: &Frame, points: Vec<DVec3>) -> Result<Section, CurveError> {
    let flat: Vec<DVec2> = points.iter().map(|p| frame.flat(*p)).collect();
    let curve = Curve::new(format!("section {index}"), points, true)?;
    Ok(measured(index, frame, curve, &flat, None))
}

fn measured(index: usize, frame: &Frame, curve: Curve, flat: &[DVec2], others: Option<Others>) -> Section {
    let sides = flat.iter().zip(flat.iter().cycle().skip(1));
    Section {
        index,
        curve,
        plane: frame.plane,
        front: frame.front,
        perimeter: sides.map(|(a, b)| a.distance(*b)).sum(),
        area: signed_area(flat).abs(),
        offset: centroid(flat).length(),
        others,
    }
}

/// Centroid of the area that a polygon encloses, or of its corners where there is next to none.
pub(crate) fn centroid(flat: &[DVec2]) -> DVec2 {
    let mean = flat.iter().sum::<DVec2>() / flat.len() as f64;
    let sides = || flat.iter().zip(flat.iter().cycle().skip(1)).map(|(a, b)| (*a - mean, *b - mean));
    let (doubled, spread) = sides().fold((0.0, 0.0), |(doubled, spread): (f64, f64), (a, b)| {
        (doubled + a.perp_dot(b), spread + a.length_squared())
    });
    let centre = mean + sides().map(|(a, b)| (a + b) * a.perp_dot(b)).sum::<DVec2>() / (3.0 * doubled);
    if doubled.abs() > 1e-9 * spread && centre.is_finite() { centre } else { mean }
}

/// The side of a polygon on which the front lies, and the share of it that is before: the outermost crossing of the ray
/// from the centre along the first axis.
pub(crate) fn front_of(flat: &[DVec2], centre: DVec2) -> (usize, f64) {
    let mut outermost: Option<(f64, usize, f64)> = None;
    let mut foremost = 0;
    for (k, from) in flat.iter().enumerate() {
        let (from, to) = (*from - centre, flat[(k + 1) % flat.len()] - centre);
        if flat[k].x > flat[foremost].x {
            foremost = k;
        }
        if (from.y < 0.0) == (to.y < 0.0) {
            continue;
        }
        let share = (from.y / (from.y - to.y)).clamp(0.0, 1.0);
        let reach = from.x + (to.x - from.x) * share;
        if reach > 0.0 && outermost.is_none_or(|(most, _, _)| reach > most) {
            outermost = Some((reach, k, share));
        }
    }
    outermost.map_or((foremost, 0.0), |(_, k, share)| (k, share))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(points: &[[f64; 2]]) -> Vec<DVec2> {
        points.iter().map(|p| DVec2::from(*p)).collect()
    }

    #[test]
    fn the_front_is_where_the_ray_leaves_for_good() {
        // A bracket, open to the front, whose arms the ray from the centroid passes between; then one it crosses twice.
        let bracket = flat(&[
            [-1.0, -2.0],
            [3.0, -2.0],
            [3.0, -1.0],
            [0.0, -1.0],
            [0.0, 1.0],
            [3.0, 1.0],
            [3.0, 2.0],
            [-1.0, 2.0],
        ]);
        assert_eq!(front_of(&bracket, DVec2::new(-0.5, 0.0)), (3, 0.5));
        assert_eq!(front_of(&bracket, DVec2::new(-0.5, 1.5)), (5, 0.5));
        assert_eq!(
            front_of(&bracket, DVec2::new(0.5, 0.0)),
            (1, 0.0),
            "outside of it: the point farthest to the front"
        );
        let comb =
            flat(&[[0.0, -1.0], [4.0, -1.0], [4.0, 2.0], [3.0, 2.0], [3.0, 0.5], [2.0, 0.5], [2.0, 2.0], [0.0, 2.0]]);
        assert_eq!(front_of(&comb, DVec2::new(1.0, 1.0)).0, 1);
    }

    #[test]
    fn the_centroid_is_that_of_the_area() {
        let uneven = flat(&[[0.0, 0.0], [0.1, 0.0], [0.2, 0.0], [0.3, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]);
        assert!(centroid(&uneven).distance(DVec2::ONE) < 1e-12);
        let line = flat(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]);
        assert_eq!(centroid(&line), DVec2::new(1.0, 0.0));
    }
}
