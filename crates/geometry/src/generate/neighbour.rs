//! Directions in which a surface continues a neighbouring one.

use glam::DVec3;

use super::GenerateError;
use super::feet::{Feet, Which};
use crate::border::unit_directions;
use crate::curve::{ArcLength, Curve, closest};

/// Share of a border's length over which its own direction is taken, so that the facets of its polyline do not show.
const REACH: f64 = 0.0025;

/// Least share of a rail's speed that leads into the surface; a rail that runs along the border is turned in so far.
const LEAST_INWARD: f64 = 0.2;

/// Largest angle, degrees, by which a rail may be bent into the neighbour's tangent plane without a warning.
const BENT: f64 = 5.0;

/// The surface beyond a border, as far as it tells the new one how to begin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Neighbour<'a> {
    /// A curve on it beside the border, the virtual border of paper 5.2.4: the direction at a point of the border is that
    /// from the closest point of the curve. On a curved surface it is off by half the angle over which that turns between
    /// both, so the curve should be near.
    Curve(&'a Curve),
    /// Directions out of it and into the new surface, one a point of the border, of any length; linear between them.
    Directions(&'a [DVec3]),
}

impl Neighbour<'_> {
    /// Checks that there is a direction for each point of `border`.
    pub(super) fn check(&self, border: &Curve) -> Result<(), GenerateError> {
        if let Self::Directions(directions) = self {
            unit_directions(border, directions)?;
        }
        Ok(())
    }

    /// Unit direction from the neighbour into the new surface at `point` of the border, `arc_length` along it.
    pub(super) fn direction(
        &self,
        border: &Curve,
        arc: &ArcLength<'_>,
        arc_length: f64,
        point: DVec3,
    ) -> Result<DVec3, GenerateError> {
        let found = match self {
            Self::Curve(curve) => {
                let from = point - closest(curve, point).point;
                // Nearer than this the direction is noise.
                if from.length() > 1e-9 * arc.length() { from.normalize_or_zero() } else { DVec3::ZERO }
            }
            Self::Directions(directions) => {
                let (segment, share) = arc.locate(arc_length);
                let (from, to) = (directions[segment], directions[(segment + 1) % directions.len()]);
                from.normalize_or_zero().lerp(to.normalize_or_zero(), share).normalize_or_zero()
            }
        };
        if found == DVec3::ZERO {
            return Err(GenerateError::NoDirection { border: border.name().to_owned(), point });
        }
        Ok(found)
    }
}

/// The tangents with which generators leave one border so that the surface continues its neighbour.
#[derive(Clone, Debug)]
pub(super) struct Edge<'a> {
    neighbour: Neighbour<'a>,
    border: &'a Curve,
    arc: ArcLength<'a>,
    side: Which,
    origin: f64,
    /// Speed of each rail along and across the border, in chords of the rail.
    rails: Vec<[f64; 2]>,
}

/// What stands on a border, for messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Across {
    Rail,
    Profile,
}

impl Across {
    fn name(self) -> &'static str {
        match self {
            Self::Rail => "Rail",
            Self::Profile => "Profile",
        }
    }
}

impl<'a> Edge<'a> {
    /// Prepares the border at `side`, at which rails (or profiles) of these sampled points stand. One of no length, at an
    /// apex, is taken for like the one before.
    pub(super) fn new(
        neighbour: Neighbour<'a>,
        border: &'a Curve,
        side: Which,
        feet: &Feet,
        (across_it, sampled): (Across, &[Vec<DVec3>]),
        warnings: &mut Vec<String>,
    ) -> Result<Self, GenerateError> {
        neighbour.check(border)?;
        let mut edge =
            Self { neighbour, border, arc: ArcLength::of(border), side, origin: feet.origin, rails: Vec::new() };
        let size = sampled.iter().map(|points| chord(points)).fold(0.0, f64::max);
        for (rail, (points, offset)) in sampled.iter().zip(&feet.offsets).enumerate() {
            let chord = chord(points);
            if chord <= 1e-9 * size {
                let like = edge.rails.last().copied().unwrap_or([0.0, 1.0]);
                edge.rails.push(like);
                continue;
            }
            let slope = end_slopes(points)[usize::from(side == Which::End)];
            let [along, across] = edge.axes(*offset, feet.points[rail])?;
            let [mut speed_along, mut speed_across] = in_plane(slope, [along, across]);
            let speed = slope.length();
            let bent = (slope - along * speed_along - across * speed_across).length().atan2(speed).to_degrees();
            let (what, name) = (across_it.name(), border.name());
            if speed_across < LEAST_INWARD * speed {
                (speed_along, speed_across) = (0.0, speed);
                warnings.push(format!(
                    "{what} {rail} runs along border \"{name}\" or back into the neighbour there, and is turned inwards: \
                     draw it away from the border."
                ));
            } else if bent > BENT {
                warnings.push(format!(
                    "{what} {rail} leaves the neighbour's surface at border \"{name}\" by {bent:.0} degrees, and is bent \
                     there so that the joint is smooth: draw it on in the direction of the neighbour."
                ));
            }
            edge.rails.push([speed_along / chord, speed_across / chord]);
        }
        Ok(edge)
    }

    /// `dP/du` of a generator of these points, which leaves the border `offset` behind the first foot, for the weight `w`
    /// of rail `next` against rail `patch`.
    pub(super) fn tangent(
        &self,
        [patch, next]: [usize; 2],
        w: f64,
        offset: f64,
        generator: &[DVec3],
    ) -> Result<DVec3, GenerateError> {
        let ends = [generator.first(), generator.last()].map(|end| end.copied().unwrap_or_default());
        let [along, across] = self.axes(offset, ends[usize::from(self.side == Which::End)])?;
        let speed = |k: usize| self.rails[patch][k] * (1.0 - w) + self.rails[next][k] * w;
        Ok((along * speed(0) + across * speed(1)) * ends[0].distance(ends[1]))
    }

    /// Unit directions along the border, and across it in the sense of the generators.
    pub(super) fn axes(&self, offset: f64, point: DVec3) -> Result<[DVec3; 2], GenerateError> {
        let s = self.origin + offset;
        let reach = REACH * self.arc.length();
        let along = (self.arc.point_at(s + reach) - self.arc.point_at(s - reach)).normalize_or_zero();
        let across = self.neighbour.direction(self.border, &self.arc, s, point)?;
        Ok([along, if self.side == Which::End { -across } else { across }])
    }
}

/// Shares of two unit directions in what is left of `v` in their plane (least squares); of the second alone where both
/// are one.
pub(super) fn in_plane(v: DVec3, [along, across]: [DVec3; 2]) -> [f64; 2] {
    let cosine = along.dot(across);
    let (a, b) = (v.dot(along), v.dot(across));
    let rest = 1.0 - cosine * cosine;
    if rest > 1e-6 { [(a - cosine * b) / rest, (b - cosine * a) / rest] } else { [0.0, b] }
}

fn chord(points: &[DVec3]) -> f64 {
    points.first().zip(points.last()).map_or(0.0, |(first, last)| first.distance(*last))
}

/// Derivatives by `u` (0 to 1 from end to end) at both ends of points at equal `u`, by one-sided differences of third
/// order; four points at least.
pub(super) fn end_slopes(points: &[DVec3]) -> [DVec3; 2] {
    let n = points.len() - 1;
    let at = |k: usize| (points[k], points[n - k]);
    let per_step = n as f64 / 6.0;
    let weights = [-11.0, 18.0, -9.0, 2.0];
    let sum = |end: bool| {
        let pick = |k: usize| if end { at(k).1 } else { at(k).0 };
        weights.iter().enumerate().map(|(k, weight)| pick(k) * *weight).sum::<DVec3>() * per_step
    };
    [sum(false), -sum(true)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::border::BorderError;

    #[test]
    fn slopes_of_a_cubic_are_exact() {
        let cubic = |u: f64| DVec3::new(u, u * u - u, u * u * u);
        for n in [4_u32, 9] {
            let points: Vec<DVec3> = (0..n).map(|i| cubic(f64::from(i) / f64::from(n - 1))).collect();
            let [start, end] = end_slopes(&points);
            assert!(start.distance(DVec3::new(1.0, -1.0, 0.0)) < 1e-12, "{start}");
            assert!(end.distance(DVec3::new(1.0, 1.0, 3.0)) < 1e-12, "{end}");
        }
    }

    #[test]
    fn directions_come_from_a_curve_or_one_a_point() {
        let border = Curve::new("rim", vec![DVec3::ZERO, DVec3::X, DVec3::X * 3.0], false).unwrap();
        let beside = border.map(|p| p + DVec3::new(0.0, -0.01, 0.01)).unwrap();
        let arc = ArcLength::of(&border);
        let found = Neighbour::Curve(&beside).direction(&border, &arc, 2.0, DVec3::X * 2.0).unwrap();
        assert!(found.distance(DVec3::new(0.0, 1.0, -1.0).normalize()) < 1e-12);
        let given = [DVec3::Y, DVec3::Y * 7.0, DVec3::Z];
        let found = Neighbour::Directions(&given).direction(&border, &arc, 2.0, DVec3::X * 2.0).unwrap();
        assert!(found.distance(DVec3::new(0.0, 1.0, 1.0).normalize()) < 1e-12);

        let short = Neighbour::Directions(&given[..2]).check(&border);
        assert!(matches!(short, Err(GenerateError::Border(BorderError::Count { found: 2, points: 3, .. }))));
        for zero in [DVec3::ZERO, DVec3::NAN] {
            let none = [DVec3::Y, zero, DVec3::Z];
            let found = Neighbour::Directions(&none).check(&border);
            assert!(matches!(found, Err(GenerateError::Border(BorderError::NoDirection { index: 1, .. }))));
        }
        let touching = Neighbour::Curve(&border).direction(&border, &arc, 2.0, DVec3::X * 2.0);
        assert!(matches!(touching, Err(GenerateError::NoDirection { .. })));
    }
}
