//! The border as it is, and even points on it.

use glam::DVec3;

use super::ResampleBorderError;
use crate::border::{Border, tangent_at};
use crate::curve::{ArcLength, CubicSpline, Curve, SplineError, SplineLength, chord_parameters, closest};
use crate::mesh::{Mesh, measure};

/// Vertices of a border nearer to the one before than this share of the mean distance carry no spline: what is uncertain
/// about their places would be a bend.
const TOO_NEAR: f64 = 0.25;

/// Least sine of the angle between the ways from a corner of a ring.
const CORNER: f64 = 0.35;

/// Largest distance from the border, in its mean sides, of a point at which its normals count.
const OFF: f64 = 0.02;

/// Places between two points of the border at which is looked for its farthest one.
const LOOKED_AT: usize = 4;

/// A border: its vertices, and the mesh's normals there.
pub(super) struct Rim {
    pub(super) vertices: Vec<u32>,
    pub(super) curve: Curve,
    normals: Vec<DVec3>,
}

/// Points at equal distances along a border.
pub(super) struct Even {
    pub(super) points: Vec<DVec3>,
    /// Unit normals of the mesh there.
    pub(super) normals: Vec<DVec3>,
    pub(super) spacing: f64,
}

impl Rim {
    /// None where these vertices are no closed curve.
    pub(super) fn of(mesh: &Mesh, vertices: &[u32]) -> Option<Self> {
        let points: Option<Vec<DVec3>> = vertices.iter().map(|v| mesh.positions().get(*v as usize).copied()).collect();
        let curve = Curve::new("border", points?, true).ok()?;
        if vertices.len() < 3 {
            return None;
        }
        let mut place = vec![usize::MAX; mesh.positions().len()];
        vertices.iter().enumerate().for_each(|(k, vertex)| place[*vertex as usize] = k);
        let mut normals = vec![DVec3::ZERO; vertices.len()];
        for polygon in 0..mesh.polygon_count() {
            for corner in mesh.corner_range(polygon) {
                if let Some(sum) = normals.get_mut(place[mesh.corners()[corner] as usize]) {
                    *sum += mesh.normals().map_or_else(|| measure::polygon_normal(mesh, polygon), |all| all[corner]);
                }
            }
        }
        let normals = normals.iter().map(|sum| sum.normalize_or_zero()).collect();
        Some(Self { vertices: vertices.to_vec(), curve, normals })
    }

    /// The longest side over the shortest.
    pub(super) fn unevenness(&self) -> f64 {
        let sides = (0..self.curve.segment_count()).map(|k| self.curve.segment(k)).map(|(a, b)| a.distance(b));
        let (low, high) = sides.fold((f64::INFINITY, 0.0_f64), |(low, high), side| (low.min(side), high.max(side)));
        high / low
    }

    /// The vertex that reaches farthest in a direction, the first of several.
    pub(super) fn farthest_vertex(&self, direction: DVec3) -> usize {
        let reach = |k: usize| self.curve.points()[k].dot(direction);
        (0..self.vertices.len()).fold(0, |best, k| if reach(k) > reach(best) { k } else { best })
    }

    pub(super) fn centre(&self) -> DVec3 {
        self.curve.points().iter().sum::<DVec3>() / self.curve.points().len() as f64
    }

    /// `count` points at equal distances, the first where the border reaches farthest in a direction.
    pub(super) fn even(&self, count: usize, start: DVec3, smooth: bool) -> Result<Even, ResampleBorderError> {
        let kept = if smooth { self.spread_out() } else { (0..self.vertices.len()).collect() };
        let (points, normals): (Vec<DVec3>, Vec<DVec3>) =
            kept.iter().map(|k| (self.curve.points()[*k], self.normals[*k])).unzip();
        let parameters = chord_parameters(&points, true);
        let normal_spline = CubicSpline::periodic(parameters.clone(), normals)?;
        let line = if smooth {
            Line::Smooth(SplineLength::of(CubicSpline::periodic(parameters, points)?))
        } else {
            Line::Straight(&self.curve)
        };
        let length = line.length();
        let first = farthest(&line, LOOKED_AT * self.vertices.len(), start);
        let spacing = length / count as f64;
        let stations = (0..count).map(|k| (first + spacing * k as f64).rem_euclid(length));
        let (mut points, mut normals) = (Vec::with_capacity(count), Vec::with_capacity(count));
        for s in stations {
            points.push(line.point_at(s));
            normals.push(normal_spline.position(line.parameter_at(s)).normalize_or_zero());
        }
        if smooth {
            square_to(&points, &mut normals)?;
        }
        Ok(Even { points, normals, spacing })
    }

    /// Points of another border along this one, run like it.
    pub(super) fn onto(&self, ring: &Border) -> Even {
        let (arc, count) = (ArcLength::of(&self.curve), ring.curve().points().len());
        let against = ring.curve().area_vector().dot(self.curve.area_vector()) < 0.0;
        let order = |k: usize| if against { count - 1 - k } else { k };
        let at = |k: usize| ring.curve().points()[k % count];
        let off = OFF * arc.length() / self.vertices.len() as f64;
        let normal = |k: usize| {
            let near = closest(&self.curve, at(k));
            let (segment, share) = arc.locate(near.arc_length);
            let own =
                self.normals[segment].lerp(self.normals[(segment + 1) % self.normals.len()], share).normalize_or_zero();
            // At a corner the curvatures of both sides count, each by itself.
            let (ahead, back) =
                (way([at(k), at(k + 1), at(k + 2)]), way([at(k), at(k + count - 1), at(k + count - 2)]));
            let corner = back.cross(ahead);
            let other = if corner.length() > CORNER {
                corner.normalize_or_zero()
            } else {
                let along = tangent_at([at(k + count - 1), at(k), at(k + 1)]);
                along.cross(ring.directions()[k]).normalize_or_zero()
            };
            // Where a cut took a corner off, the border does not tell what is there.
            if near.distance <= off || other == DVec3::ZERO { own } else { other * other.dot(own).signum() }
        };
        let points: Vec<DVec3> = (0..count).map(|k| at(order(k))).collect();
        let normals = (0..count).map(|k| normal(order(k))).collect();
        Even { spacing: arc.length() / count as f64, points, normals }
    }

    /// The vertices without those that are next to one another.
    fn spread_out(&self) -> Vec<usize> {
        let arc = ArcLength::of(&self.curve);
        let least = TOO_NEAR * arc.length() / self.vertices.len() as f64;
        let mut kept: Vec<usize> = Vec::with_capacity(self.vertices.len());
        for k in 0..self.vertices.len() {
            let away = kept.last().is_none_or(|before| arc.cumulative()[k] - arc.cumulative()[*before] >= least);
            if away {
                kept.push(k);
            }
        }
        while kept.len() > 3 && arc.length() - arc.cumulative()[kept[kept.len() - 1]] < least {
            kept.pop();
        }
        if kept.len() < 3 {
            kept = (0..self.vertices.len()).collect();
        }
        kept
    }
}

/// Turns normals square to the smooth closed curve through points. What is joined to a border goes through its points and
/// knows no others: in a bend that is tight for them, the curve is off the surface's tangent plane, and both sides of the
/// joint would differ by as much.
fn square_to(points: &[DVec3], normals: &mut [DVec3]) -> Result<(), SplineError> {
    let parameters = chord_parameters(points, true);
    let curve = CubicSpline::periodic(parameters.clone(), points.to_vec())?;
    for (normal, parameter) in normals.iter_mut().zip(parameters) {
        let along = curve.derivative(parameter).normalize_or_zero();
        *normal = (*normal - along * along.dot(*normal)).normalize_or_zero();
    }
    Ok(())
}

/// Unit direction in which the parabola through three points leaves the first.
fn way([at, next, after]: [DVec3; 3]) -> DVec3 {
    let (near, far) = (at.distance(next), next.distance(after));
    let (first, second) = ((next - at) / near, (after - next) / far);
    (first + (first - second) * (near / (near + far))).normalize_or_zero()
}

/// The curve on which even points are placed.
enum Line<'a> {
    Smooth(SplineLength),
    Straight(&'a Curve),
}

impl Line<'_> {
    fn length(&self) -> f64 {
        match self {
            Self::Smooth(spline) => spline.length(),
            Self::Straight(curve) => ArcLength::of(curve).length(),
        }
    }

    fn point_at(&self, s: f64) -> DVec3 {
        match self {
            Self::Smooth(spline) => spline.point_at(s),
            Self::Straight(curve) => ArcLength::of(curve).point_at(s),
        }
    }

    /// The parameter by chords.
    fn parameter_at(&self, s: f64) -> f64 {
        match self {
            Self::Smooth(spline) => spline.parameter_at(s),
            Self::Straight(_) => s,
        }
    }
}

/// Where a closed line reaches farthest in a direction: the best of many places, refined by golden section.
fn farthest(line: &Line<'_>, places: usize, direction: DVec3) -> f64 {
    let length = line.length();
    let step = length / places as f64;
    let reach = |s: f64| line.point_at(s.rem_euclid(length)).dot(direction);
    let best = (0..places).map(|k| step * k as f64).fold((f64::NEG_INFINITY, 0.0), |best, s| {
        let found = reach(s);
        if found > best.0 { (found, s) } else { best }
    });
    let (mut low, mut high) = (best.1 - step, best.1 + step);
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..60 {
        let (a, b) = (high - golden * (high - low), low + golden * (high - low));
        if reach(a) >= reach(b) { high = b } else { low = a }
    }
    0.5 * (low + high)
}
