//! Segments in a plane, chained into loops.

use std::cmp::Ordering;
use std::f64::consts::TAU;

use glam::DVec3;

use super::Plane;
use super::cut::{Crossing, Segment};

/// A loop in which a plane cuts a mesh, or an open chain where the mesh has a hole.
#[derive(Clone, Debug, PartialEq)]
pub struct Loop {
    /// The points in order, metres; of a closed loop the first is not repeated. At least three where it is closed, two
    /// where it is open; no point equals the one before it.
    pub points: Vec<DVec3>,
    /// Whether the last point joins the first.
    pub closed: bool,
}

/// Where more segments than this meet in one point, they are joined in order, whatever their angles.
const MOST_BY_ANGLE: usize = 64;

/// A loop narrower than this, in units of its length, encloses nothing: the plane touches an edge there.
const FLAT: f64 = 1e-12;

/// Angle below which two segments from one point have one direction, radians.
const SAME_DIRECTION: f64 = 1e-9;

/// Chains segments into loops and open chains, in the order of their first segment.
pub(super) fn chained(segments: &[Segment], plane: &Plane) -> Vec<Loop> {
    let pairing = Pairing::new(segments, plane);
    let mut visited = vec![false; segments.len()];
    let mut found: Vec<(usize, Loop)> = Vec::new();
    let open = |side: usize| (0..segments.len()).map(move |k| 2 * k + side);
    // Open chains from where they begin; after that only loops are left.
    let begins = open(0).chain(open(1)).filter(|end| pairing.partner[*end].is_none()).chain(open(0));
    for begin in begins.collect::<Vec<_>>() {
        if !visited[begin / 2] {
            found.push(walk(begin, segments, &pairing.partner, &mut visited));
        }
    }
    found.retain(|(_, chain)| chain.points.len() >= if chain.closed { 3 } else { 2 });
    found.retain(|(_, chain)| !chain.closed || !is_flat(&chain.points));
    found.sort_by_key(|(first, _)| *first);
    found.into_iter().map(|(_, chain)| chain).collect()
}

/// The chain that is entered at the end `begin`, and its first segment.
fn walk(begin: usize, segments: &[Segment], partner: &[Option<usize>], visited: &mut [bool]) -> (usize, Loop) {
    let mut points = vec![point(segments, begin)];
    let mut enter = begin;
    let mut first = begin / 2;
    let closed = loop {
        visited[enter / 2] = true;
        first = first.min(enter / 2);
        let leave = enter ^ 1;
        points.push(point(segments, leave));
        match partner[leave] {
            None => break false,
            Some(next) if next == begin => break true,
            Some(next) => enter = next,
        }
    };
    points.dedup();
    if closed && points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    (first, Loop { points, closed })
}

fn point(segments: &[Segment], end: usize) -> DVec3 {
    segments[end / 2].ends[end % 2].point
}

/// Whether all points lie on one line, or are one.
fn is_flat(points: &[DVec3]) -> bool {
    let origin = points[0];
    let farthest = points
        .iter()
        .map(|p| *p - origin)
        .fold(DVec3::ZERO, |far, arm| if arm.length_squared() > far.length_squared() { arm } else { far });
    let direction = farthest.normalize_or_zero();
    let narrow = FLAT * farthest.length();
    points.iter().all(|p| (*p - origin).reject_from_normalized(direction).length() <= narrow)
}

/// Which end of a segment goes on into which other one. Ends are counted two a segment.
struct Pairing<'a> {
    segments: &'a [Segment],
    axes: (DVec3, DVec3),
    partner: Vec<Option<usize>>,
}

impl<'a> Pairing<'a> {
    fn new(segments: &'a [Segment], plane: &Plane) -> Self {
        let x = plane.normal().any_orthonormal_vector();
        let partner = vec![None; 2 * segments.len()];
        let mut pairing = Self { segments, axes: (x, plane.normal().cross(x)), partner };
        pairing.pair_equal(|a, b| a.edge.cmp(&b.edge));
        // What is left lies at the rims of holes, or at seams of vertices that are doubled. Equal vertices give equal
        // points, and a point says nearly always which vertices it lies between.
        pairing.pair_equal(|a, b| by_position(a.point, b.point));
        pairing
    }

    /// Joins the ends without a partner whose crossings are equal.
    fn pair_equal(&mut self, order: impl Fn(&Crossing, &Crossing) -> Ordering) {
        let segments = self.segments;
        let crossing = |end: usize| &segments[end / 2].ends[end % 2];
        let mut ends: Vec<usize> = (0..self.partner.len()).filter(|end| self.partner[*end].is_none()).collect();
        ends.sort_by(|a, b| order(crossing(*a), crossing(*b)));
        for group in ends.chunk_by(|a, b| order(crossing(*a), crossing(*b)).is_eq()) {
            self.pair(group);
        }
    }

    /// Joins ends that meet in one point.
    fn pair(&mut self, group: &[usize]) {
        match *group {
            [] | [_] => {}
            [a, b] => self.join(a, b),
            _ => {
                let (leaving, arriving): (Vec<usize>, Vec<usize>) = group.iter().partition(|end| *end % 2 == 0);
                if group.len() > MOST_BY_ANGLE {
                    arriving.iter().zip(&leaving).for_each(|(a, b)| self.join(*a, *b));
                } else if leaving.len() == arriving.len() {
                    self.join_around_matter(&arriving, leaving);
                } else {
                    self.join_straightest(group);
                }
            }
        }
    }

    /// Matter lies to the left of a segment: clockwise from one that arrives, up to the next one that leaves.
    fn join_around_matter(&mut self, arriving: &[usize], mut leaving: Vec<usize>) {
        for &end in arriving {
            let from = self.angle(end);
            let clockwise = |other: usize| {
                let turn = (from - self.angle(other)).rem_euclid(TAU);
                // Two sheets on each other have nothing between them.
                if turn < SAME_DIRECTION { turn + TAU } else { turn }
            };
            let next = (0..leaving.len()).min_by(|a, b| clockwise(leaving[*a]).total_cmp(&clockwise(leaving[*b])));
            if let Some(next) = next {
                let other = leaving.swap_remove(next);
                self.join(end, other);
            }
        }
    }

    /// Where inside and outside are not told, what goes on most straight belongs together; one may be left.
    fn join_straightest(&mut self, group: &[usize]) {
        let bend = |a: usize, b: usize| ((self.angle(a) - self.angle(b)).rem_euclid(TAU) - TAU / 2.0).abs();
        let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
        for (k, &a) in group.iter().enumerate() {
            pairs.extend(group[k + 1..].iter().map(|&b| (bend(a, b), a, b)));
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, a, b) in pairs {
            if self.partner[a].is_none() && self.partner[b].is_none() {
                self.join(a, b);
            }
        }
    }

    fn join(&mut self, a: usize, b: usize) {
        self.partner[a] = Some(b);
        self.partner[b] = Some(a);
    }

    /// Angle in the plane at which a segment leaves the point of its end, radians.
    fn angle(&self, end: usize) -> f64 {
        let along = point(self.segments, end ^ 1) - point(self.segments, end);
        along.dot(self.axes.1).atan2(along.dot(self.axes.0))
    }
}

fn by_position(a: DVec3, b: DVec3) -> Ordering {
    // Zero has two signs, which differ in their bits and are one place.
    let number = |x: f64| x + 0.0;
    number(a.x)
        .total_cmp(&number(b.x))
        .then(number(a.y).total_cmp(&number(b.y)))
        .then(number(a.z).total_cmp(&number(b.z)))
}
