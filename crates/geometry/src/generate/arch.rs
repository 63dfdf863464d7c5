//! One open contour over a closed one.

use glam::DVec3;

use super::neighbour::Neighbour;
use super::sweep::gap_warning;
use super::{GenerateError, GenerateOptions, Generated, check_size, report};
use crate::beam::OpenCardinals;
use crate::curve::{ArcLength, Curve, closest};
use crate::sections::Sections;

/// Largest ratio of a border tangent to that of a straight generator: what leaves the border almost backwards would else
/// swing out without bounds.
const LARGEST_STRETCH: f64 = 4.0;

/// With which tangents the surface leaves the closed contour.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ArchBorder<'a> {
    /// Those of the parabola through the three points of each generator, as the thesis leaves open ("a curve passing
    /// through the three points"): for `k_s = 0` the generator is that parabola.
    #[default]
    Parabola,
    /// Those of the circle through the three points: half a sphere comes out round to within 2 %.
    Round,
    /// Those of the surface beyond the contour, so that both join smoothly. Their speed is that of an arc of a circle
    /// from the border to the open contour.
    Neighbour(Neighbour<'a>),
}

/// A cap over a closed contour that follows one open contour across it (thesis 6.2, Figures 6.4, 6.5).
///
/// `open` starts and ends on `closed`, and its ends cut that into two sides. A generator runs from a point of the one
/// side over the point of `open` to that of the other side, all at one share of their lengths: the beam curve pinned in
/// its middle at the open contour, and at its ends at the closed one. The first and the last section are the points where
/// both contours meet, exact poles; both halves of the thesis, one from each end of `open`, make one surface, since the
/// middles of all curves are at equal shares.
///
/// Sections are open; their rail columns are the first side, the open contour and the second side. They run so that
/// their direction times that from section to section points to the side to which `open` rises over the closed contour,
/// or else as `closed` runs. `options.nodes` is rounded up to an odd number, 5 at least. Where `open` ends beside the
/// closed contour it is bent there, at most by the snap.
///
/// # Errors
/// [`GenerateError`] for fewer than 4 sections, contours that are not one open and one closed, an end farther from the
/// closed contour than the snap, both ends at one point, a neighbour without directions, and where `progress` asked to
/// stop.
pub fn arch(
    open: &Curve,
    closed: &Curve,
    border: ArchBorder<'_>,
    options: &GenerateOptions,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Generated, GenerateError> {
    options.check(4)?;
    check_size([open, closed])?;
    if open.is_closed() {
        return Err(GenerateError::RailIsClosed { rail: 0, name: open.name().to_owned() });
    }
    if !closed.is_closed() {
        return Err(GenerateError::CurveIsOpen { which: "closed", name: closed.name().to_owned() });
    }
    if let ArchBorder::Neighbour(neighbour) = &border {
        if let Neighbour::Curve(curve) = neighbour {
            check_size([*curve])?;
        }
        neighbour.check(closed)?;
    }
    let contours = Contours::new(open, closed, options)?;
    let middle = (options.nodes.max(5) / 2).max(2);
    let nodes = 2 * middle + 1;
    if nodes > options.nodes {
        GenerateOptions { nodes, ..*options }.check(4)?;
    }
    // The equation itself and not its differences, so that the surface leaves its border as asked at any size.
    let functions = OpenCardinals::exact(nodes, &[middle], options.stiffness)?;
    let last = options.sections - 1;
    let mut rows = Vec::with_capacity(options.sections);
    for i in 0..=last {
        report(progress, i, options.sections)?;
        let t = i as f64 / last as f64;
        if i == 0 || i == last {
            rows.push(vec![contours.feet[usize::from(i == last)]; nodes]);
            continue;
        }
        let (points, arcs) = contours.at(t);
        let tangents = match &border {
            ArchBorder::Parabola => parabola(points),
            ArchBorder::Round => circle(points),
            ArchBorder::Neighbour(neighbour) => {
                let mut tangents = [DVec3::ZERO; 2];
                for (k, side) in [0, 2].into_iter().enumerate() {
                    let inwards = neighbour.direction(closed, &contours.arc, arcs[k], points[side])?;
                    let tangent = inwards * arc_speed(inwards, points[1] - points[side], 0.5);
                    tangents[k] = if k == 0 { tangent } else { -tangent };
                }
                tangents
            }
        };
        rows.push(functions.curve(&points, tangents)?);
    }
    report(progress, 1, 1)?;
    let sections = Sections::new(rows, false, vec![0, middle, nodes - 1])?;
    let bridged = contours.bridged();
    let largest_gap = bridged[0].max(bridged[1]);
    let warnings = gap_warning(contours.size, largest_gap, options.snap).into_iter().collect();
    Ok(Generated { sections, notes: Vec::new(), warnings, largest_gap, gaps: vec![bridged] })
}

/// `dP/du` in the unit direction `inwards`, of an arc of a circle that begins with it and ends `chord` further after
/// `share` of `u`: the chord's speed times `1/cos^2` of half the angle between both.
pub(super) fn arc_speed(inwards: DVec3, chord: DVec3, share: f64) -> f64 {
    let cosine = inwards.dot(chord.normalize_or_zero());
    chord.length() / share * (2.0 / (1.0 + cosine)).min(LARGEST_STRETCH)
}

/// End tangents `dP/du` of the parabola through three points at `u` = 0, 1/2 and 1.
fn parabola([a, b, c]: [DVec3; 3]) -> [DVec3; 2] {
    [a * -3.0 + b * 4.0 - c, a - b * 4.0 + c * 3.0]
}

/// End tangents `dP/du` of the circle through three points at `u` = 0, 1/2 and 1, at the speed of [`arc_speed`]; of the
/// straight line where they lie on one.
fn circle([a, b, c]: [DVec3; 3]) -> [DVec3; 2] {
    // The tangent at an end makes the angle with the chord to the middle point that this chord is seen under from the
    // third point.
    let end = |from: DVec3, to: DVec3, third: DVec3| {
        let (chord, p, q) = (to - from, from - third, to - third);
        let seen = p.angle_between(q);
        if seen.is_nan() || seen < 1e-9 {
            return chord * 2.0;
        }
        let normal = chord.cross(third - from).normalize_or_zero();
        let outwards = normal.cross(chord);
        // Turned by the angle away from the third point.
        let tangent = chord * seen.cos() - outwards * seen.sin();
        tangent * (2.0 * (2.0 / (1.0 + seen.cos())).min(LARGEST_STRETCH))
    };
    [end(a, b, c), -end(c, b, a)]
}

/// Both contours, walked from where they meet first to where they meet again.
#[derive(Clone, Debug)]
struct Contours<'a> {
    open: ArcLength<'a>,
    arc: ArcLength<'a>,
    /// Where they meet.
    feet: [DVec3; 2],
    /// From the open contour's ends to there.
    gaps: [DVec3; 2],
    /// Arc length of the first foot on the closed contour, and the way to the second one on the first and second side;
    /// one of them runs back.
    origin: f64,
    ways: [f64; 2],
    /// Diagonal of the box around both, metres.
    size: f64,
}

impl<'a> Contours<'a> {
    fn new(open: &'a Curve, closed: &'a Curve, options: &GenerateOptions) -> Result<Self, GenerateError> {
        let found =
            [("starts", open.start()), ("ends", open.end())].map(|(ends, point)| (ends, point, closest(closed, point)));
        for (ends, _, foot) in &found {
            if foot.distance.is_nan() || foot.distance > options.snap {
                return Err(GenerateError::Gap {
                    rail: 0,
                    name: open.name().to_owned(),
                    ends,
                    distance: foot.distance,
                    which: "closed",
                    curve: closed.name().to_owned(),
                    snap: options.snap,
                });
            }
        }
        let arc = ArcLength::of(closed);
        let [(_, start, first), (_, end, second)] = found;
        let forward = (second.arc_length - first.arc_length).rem_euclid(arc.length());
        if forward.min(arc.length() - forward) <= 1e-9 * arc.length() {
            return Err(GenerateError::BothEndsAtOnePoint {
                name: open.name().to_owned(),
                curve: closed.name().to_owned(),
            });
        }
        let (low, high) = open.bounds();
        let (l, h) = closed.bounds();
        let mut contours = Self {
            open: ArcLength::of(open),
            feet: [first.point, second.point],
            gaps: [first.point - start, second.point - end],
            origin: first.arc_length,
            ways: [forward, forward - arc.length()],
            arc,
            size: (high.max(h) - low.min(l)).length(),
        };
        if contours.rises_backwards() {
            contours.ways.reverse();
        }
        Ok(contours)
    }

    /// The three points of a generator at the share `t`, and the arc lengths of both outer ones on the closed contour.
    fn at(&self, t: f64) -> ([DVec3; 3], [f64; 2]) {
        let arcs = self.ways.map(|way| (self.origin + t * way).rem_euclid(self.arc.length()));
        // Full at the ends and fading quadratically, so that a small gap is no kink.
        let pull = self.gaps[0] * ((1.0 - t) * (1.0 - t)) + self.gaps[1] * (t * t);
        let middle = self.open.point_at_fraction(t) + pull;
        ([self.arc.point_at(arcs[0]), middle, self.arc.point_at(arcs[1])], arcs)
    }

    /// Whether the open contour rises against the direction of sections times that across them.
    fn rises_backwards(&self) -> bool {
        const STATIONS: usize = 32;
        let run = self.feet[1] - self.feet[0];
        let rise: f64 = (1..STATIONS)
            .map(|k| {
                let ([a, b, c], _) = self.at(k as f64 / STATIONS as f64);
                (c - a).cross(run).dot(b - (a + c) * 0.5)
            })
            .sum();
        rise < -1e-9 * run.length() * self.size * self.size
    }

    /// Distances bridged at both ends of the open contour, metres.
    fn bridged(&self) -> [f64; 2] {
        self.gaps.map(DVec3::length)
    }
}
