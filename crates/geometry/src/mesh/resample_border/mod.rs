//! An open border of a mesh gets as many points as wanted, at equal distances, and its neighbourhood new faces.
//!
//! What a cut leaves has a vertex wherever a side was cut: at any distance from the next, beside slivers. Here the faces
//! along the border go (`collar`), the border's curve gets even points, and a strip of quads and triangles ties these to
//! what remains (`strip`).

mod collar;
mod rim;
mod strip;
#[cfg(test)]
mod tests;

use glam::{DVec2, DVec3};

use super::distance::{MeshDistance, NoPolygons, nearest_on_triangle};
use super::triangulate::polygon_triangles;
use super::vertex_polygons::VertexPolygons;
use super::{Mesh, MeshError};
use crate::border::Border;
use crate::curve::{SplineError, closest, place};
use collar::Collar;
use rim::Rim;

/// Fewest and most points of a border.
const POINTS: std::ops::RangeInclusive<usize> = 3..=65_536;

/// A border of the right number of points stays as it is where its longest side is at most this many times its shortest.
const EVEN: f64 = 3.0;

/// Distances from the border within which faces go, in sides of the new border: the first that allows a strip without
/// folds.
const REACHES: [f64; 5] = [0.6, 0.9, 1.35, 2.0, 3.0];

/// Largest distance from the border of a curve whose points it takes, as a share of the border's size.
const AWAY: f64 = 0.1;

/// How a border is resampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResampleBorderOptions {
    /// Points of the new border, 3 to 65 536.
    pub points: usize,
    /// Point 0 is where the border reaches farthest in this direction. Borders that face one another and begin alike
    /// are joined without a twist, and one that is symmetric gets symmetric points.
    pub start: DVec3,
    /// Whether the points lie on a C2 spline through the border, or on its straight sides.
    pub smooth: bool,
}

/// A mesh with a border of even points.
#[derive(Clone, Debug, PartialEq)]
pub struct ResampledBorder {
    /// The mesh: what remains of the old one first, then the strip along the border.
    pub mesh: Mesh,
    /// The vertices of the border from point 0, run so that a face put into it would face as the mesh does.
    pub border: Vec<u32>,
    /// Faces that went, and faces of the strip that came; none of either where the border had even points already.
    pub replaced: [usize; 2],
}

/// Why a border is not resampled.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ResampleBorderError {
    /// Told to stop.
    #[error("stopped")]
    Stopped,
    /// Too few points asked for, or too many.
    #[error("{found} points asked for: give a number from {} to {}", POINTS.start(), POINTS.end())]
    Points {
        /// The number.
        found: usize,
    },
    /// A start that is no direction.
    #[error("the start {found} is no direction: give one that is not zero")]
    Start {
        /// The direction as given.
        found: DVec3,
    },
    /// Vertices that are no border of the mesh.
    #[error("the vertices given are no border of the mesh")]
    NoBorder,
    /// Another border within reach.
    #[error(
        "the border at {} is so near to another one, at {}, that no faces remain between them: cut farther from it, take more \
         points, or make the mesh finer", place(*at), place(*other)
    )]
    NearAnother {
        /// Mean of the border's points.
        at: DVec3,
        /// Where the other one is.
        other: DVec3,
    },
    /// A strip that can only be folded.
    #[error(
        "the faces along the border at {} can't be replaced without folds, worst at {}: take more points, draw the border \
         rounder or without notches, or make the mesh finer", place(*at), place(*fold)
    )]
    Folds {
        /// Mean of the border's points.
        at: DVec3,
        /// Where the strip folds.
        fold: DVec3,
    },
    /// An open curve whose points are wanted.
    #[error("curve \"{ring}\" is open: a border takes the points of a closed one")]
    Open {
        /// Name of the curve.
        ring: String,
    },
    /// A curve that does not lie along the border.
    #[error("curve \"{ring}\" leaves the border at {}: give one that lies along it", place(*at))]
    Away {
        /// Name of the curve.
        ring: String,
        /// The first of its points that is too far off.
        at: DVec3,
    },
    /// Points of the border that carry no spline.
    #[error(transparent)]
    Spline(#[from] SplineError),
    /// A mesh without polygons.
    #[error(transparent)]
    Empty(#[from] NoPolygons),
    /// The mesh can't be made.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// Gives the border `vertices` (as [`Topology::boundary_loops`](super::Topology::boundary_loops) has it) even points.
///
/// The faces within 0.6 sides of the new border go, more where that is needed; the strip that takes their place is of
/// least summed square length of its sides between both borders, among strips that do not fold (dynamic programming,
/// Fuchs, Kedem and Uselton 1977), of quads where two triangles make a convex one. Normals of new corners are those of
/// the mesh at the old border, square to the smooth new one, and at what remains; UVs are those of the nearest place of
/// the old mesh.
///
/// A border that has that number of points already, its longest side at most 3 times its shortest, keeps them.
///
/// # Errors
/// [`ResampleBorderError`] where options are out of range, another border is too near, a strip can only fold, or
/// `progress`, called with the share that is done, answers `false`.
pub fn resample_border(
    mesh: &Mesh,
    vertices: &[u32],
    options: &ResampleBorderOptions,
    progress: &dyn Fn(f64) -> bool,
) -> Result<ResampledBorder, ResampleBorderError> {
    use ResampleBorderError as E;
    let told = |share: f64| if progress(share) { Ok(()) } else { Err(E::Stopped) };
    told(0.0)?;
    if !POINTS.contains(&options.points) {
        return Err(E::Points { found: options.points });
    }
    let start = options.start.try_normalize().ok_or(E::Start { found: options.start })?;
    let rim = Rim::of(mesh, vertices).ok_or(E::NoBorder)?;
    if vertices.len() == options.points && rim.unevenness() <= EVEN {
        let first = rim.farthest_vertex(start);
        let border = vertices[first..].iter().chain(&vertices[..first]).copied().collect();
        return Ok(ResampledBorder { mesh: mesh.clone(), border, replaced: [0; 2] });
    }
    let even = rim.even(options.points, start, options.smooth)?;
    told(0.2)?;
    replaced(mesh, &rim, &even, progress)
}

/// Gives the border `vertices` the points of another closed one that lies along it, in their order or, where that runs the
/// other way, against it: those of a surface that was made between its sides. Normals are those of the mesh; where a cut
/// took off a corner that the other border has, they are those of the other surface.
///
/// # Errors
/// As [`resample_border`]; also where the curve is open or leaves the border by more than a tenth of its size.
pub fn resample_border_onto(
    mesh: &Mesh,
    vertices: &[u32],
    ring: &Border,
    progress: &dyn Fn(f64) -> bool,
) -> Result<ResampledBorder, ResampleBorderError> {
    use ResampleBorderError as E;
    if !progress(0.0) {
        return Err(E::Stopped);
    }
    let rim = Rim::of(mesh, vertices).ok_or(E::NoBorder)?;
    let (ring, beside) = (ring.curve(), ring);
    let (low, high) = rim.curve.bounds();
    let far = |p: &&DVec3| closest(&rim.curve, **p).distance > AWAY * low.distance(high);
    if !ring.is_closed() {
        return Err(E::Open { ring: ring.name().to_owned() });
    }
    if let Some(at) = ring.points().iter().find(far) {
        return Err(E::Away { ring: ring.name().to_owned(), at: *at });
    }
    replaced(mesh, &rim, &rim.onto(beside), progress)
}

/// The mesh with other faces along a border.
fn replaced(
    mesh: &Mesh,
    rim: &Rim,
    even: &rim::Even,
    progress: &dyn Fn(f64) -> bool,
) -> Result<ResampledBorder, ResampleBorderError> {
    use ResampleBorderError as E;
    let told = |share: f64| if progress(share) { Ok(()) } else { Err(E::Stopped) };
    let at = rim.centre();
    let mut fold = at;
    let around = VertexPolygons::new(mesh);
    for (attempt, reach) in REACHES.into_iter().enumerate() {
        told(0.2 + 0.1 * attempt as f64)?;
        let collar = match Collar::of(mesh, &around, rim, reach * even.spacing) {
            Ok(collar) => collar,
            // Wider ones are no better.
            Err(other) if attempt == 0 => return Err(E::NearAnother { at, other }),
            Err(_) => break,
        };
        let outer: Vec<_> = collar.outline.iter().map(|v| (mesh.positions()[*v as usize], collar.normal(*v))).collect();
        let inner: Vec<_> = even.points.iter().copied().zip(even.normals.iter().copied()).collect();
        match strip::strip(&outer, &inner, &|| told(0.7))? {
            Ok(faces) => {
                told(0.8)?;
                return assembled(mesh, &collar, even, &faces);
            }
            Err(worst) => fold = worst,
        }
    }
    Err(E::Folds { at, fold })
}

/// What remains of the mesh, and the strip.
fn assembled(
    mesh: &Mesh,
    collar: &Collar,
    even: &rim::Even,
    faces: &[strip::Face],
) -> Result<ResampledBorder, ResampleBorderError> {
    let mut number = vec![u32::MAX; mesh.positions().len()];
    let (mut positions, mut corners, mut counts) = (Vec::new(), Vec::new(), Vec::new());
    let (mut normals, mut uvs) = (Vec::new(), Vec::new());
    for polygon in (0..mesh.polygon_count()).filter(|polygon| !collar.gone[*polygon]) {
        let range = mesh.corner_range(polygon);
        counts.push(range.len());
        for corner in range {
            let vertex = mesh.corners()[corner] as usize;
            if number[vertex] == u32::MAX {
                number[vertex] = positions.len() as u32;
                positions.push(mesh.positions()[vertex]);
            }
            corners.push(number[vertex]);
            normals.extend(mesh.normals().map(|normals| normals[corner]));
            uvs.extend(mesh.uvs().map(|uvs| uvs[corner]));
        }
    }
    let first = positions.len() as u32;
    positions.extend(&even.points);
    let replaced = [collar.gone.iter().filter(|gone| **gone).count(), faces.len()];
    let charts = match mesh.uvs() {
        Some(_) => Some(Charts { mesh, nearest: MeshDistance::among(mesh, |polygon| collar.gone[polygon])? }),
        None => None,
    };
    for face in faces {
        let ends: Vec<(u32, DVec3, DVec3)> = face
            .corners()
            .map(|corner| match corner {
                strip::Corner::Outer(k) => {
                    let vertex = collar.outline[k];
                    let place = mesh.positions()[vertex as usize];
                    (number[vertex as usize], place, collar.normal(vertex))
                }
                strip::Corner::Inner(k) => (first + k as u32, even.points[k], even.normals[k]),
            })
            .collect();
        counts.push(ends.len());
        corners.extend(ends.iter().map(|end| end.0));
        if mesh.normals().is_some() {
            normals.extend(ends.iter().map(|end| end.2));
        }
        if let Some(charts) = &charts {
            let middle = ends.iter().map(|end| end.1).sum::<DVec3>() / ends.len() as f64;
            let home = charts.at(middle);
            // Across the seam of a chart that goes around, the other end is a whole turn away.
            let near = |uv: DVec2| uv - (uv - home).round();
            uvs.extend(ends.iter().map(|end| near(charts.at(end.1))));
        }
    }
    let mut made = Mesh::from_corners(positions, corners, counts)?;
    if mesh.normals().is_some() {
        made = made.with_normals(normals)?;
    }
    if mesh.uvs().is_some() {
        made = made.with_uvs(uvs)?;
    }
    let border = (0..even.points.len() as u32).map(|k| first + k).collect();
    Ok(ResampledBorder { mesh: made.named(mesh.name()), border, replaced })
}

/// UVs of places on a mesh.
struct Charts<'a> {
    mesh: &'a Mesh,
    nearest: MeshDistance,
}

impl Charts<'_> {
    fn at(&self, point: DVec3) -> DVec2 {
        let polygon = self.nearest.nearest(point).polygon;
        let Some(uvs) = self.mesh.uvs() else { return DVec2::ZERO };
        let place = |corner: usize| self.mesh.positions()[self.mesh.corners()[corner] as usize];
        let mut best = (f64::INFINITY, DVec2::ZERO);
        for triangle in polygon_triangles(self.mesh, polygon) {
            let [a, b, c] = triangle.map(place);
            let on = nearest_on_triangle(point, [a, b, c]);
            let area = (b - a).cross(c - a);
            let share = |p: DVec3, q: DVec3| (p - on).cross(q - on).dot(area) / area.length_squared();
            let (wa, wb) = if area == DVec3::ZERO { (1.0, 0.0) } else { (share(b, c), share(c, a)) };
            let [ua, ub, uc] = triangle.map(|corner| uvs[corner]);
            let distance = on.distance(point);
            if distance < best.0 {
                best = (distance, ua * wa + ub * wb + uc * (1.0 - wa - wb));
            }
        }
        best.1
    }
}
