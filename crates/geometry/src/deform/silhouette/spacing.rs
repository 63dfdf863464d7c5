//! Sections placed where strokes have detail.

use glam::{DVec2, DVec3};

use super::error::SilhouetteError;
use super::pair::Silhouette;
use super::track::Track;
use super::{Drawn, SilhouetteDeformer};
use crate::curve::CubicSpline;
use crate::sections::Sections;

/// Where sections stand along the stack.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum SectionSpacing {
    /// Where they are given, and nowhere else.
    #[default]
    AsGiven,
    /// Where they are given, and between them as many more as the strokes ask for: neither the straight lines from pin to
    /// pin nor the spline through the pins is farther from its stroke than this share of the sketch's diagonal, 1e-6
    /// to 1.
    ByDetail(f64),
}

/// Distance of places below which they are one, in intervals of the given sections.
const LEAST_STEP: f64 = 1e-6;

/// Points of the largest stack that is made.
const MOST_POINTS: usize = 10_000_000;

/// Rounds in which what strokes are off is spread evenly over an interval.
const SPREADING: usize = 12;

/// Rounds in which intervals are halved where the spline swings: corners are closed in on to 1/256 of an interval.
const HALVING: usize = 8;

/// Pieces of the spline between two sections that are looked at.
const PIECES: usize = 8;

/// A stroke as met by the given sections.
#[derive(Clone, Copy)]
struct Side<'a> {
    track: &'a Track,
    /// Share of the way of each section.
    shares: &'a [f64],
}

impl Side<'_> {
    /// Share of the way at a place: its whole part counts sections.
    fn share(&self, place: f64) -> f64 {
        let from = (place as usize).min(self.shares.len() - 1);
        let to = (from + 1).min(self.shares.len() - 1);
        self.shares[from] + (self.shares[to] - self.shares[from]) * (place - from as f64)
    }

    fn at(&self, place: f64) -> DVec2 {
        self.track.at(self.share(place))
    }

    /// Largest distance of the stroke between two places from the straight line between them.
    fn off_chord(&self, [low, high]: [f64; 2]) -> f64 {
        self.off(&[self.at(low), self.at(high)], [low, high])
    }

    /// Largest distance of the stroke between two places from a line.
    fn off(&self, line: &[DVec2], [low, high]: [f64; 2]) -> f64 {
        self.track.between(self.share(low), self.share(high)).0.iter().map(|p| distance(*p, line)).fold(0.0, f64::max)
    }

    /// Places between section `k` and the next at which the stroke has a point.
    fn places(&self, k: usize) -> impl Iterator<Item = f64> {
        let (from, to) = (self.shares[k], self.shares[k + 1]);
        let way = to - from;
        let shares = if way > 0.0 { self.track.between(from, to).1 } else { &[] };
        shares.iter().map(move |share| (share - from) / way)
    }
}

impl SilhouetteDeformer<'_> {
    /// Largest distance in each view of the strokes from the straight lines between the pins of neighbouring sections,
    /// and the first of the two sections.
    pub(super) fn off_chords(&self, drawn: &Drawn) -> Vec<(f64, usize)> {
        let largest = |sides: &[Side<'_>]| {
            let off =
                |k: usize| sides.iter().map(|side| side.off_chord([k as f64, (k + 1) as f64])).fold(0.0, f64::max);
            let all = (0..self.sections.len() - 1).map(|k| (off(k), k));
            all.fold((0.0, 0), |most, at| if at.0 > most.0 { at } else { most })
        };
        self.sides(drawn).chunks_exact(2).map(largest).collect()
    }

    /// Both strokes of each view.
    fn sides<'a>(&'a self, drawn: &'a Drawn) -> Vec<Side<'a>> {
        let views = self.views.iter().zip(&drawn.tracks);
        views
            .flat_map(|(view, tracks)| [0, 1].map(|side| Side { track: &tracks[side], shares: &view.shares[side] }))
            .collect()
    }

    /// The stack with further sections where the strokes of these silhouettes have detail, as
    /// [`SectionSpacing::ByDetail`]. They lie on the straight lines between the given ones, which stay among them to the
    /// bit.
    ///
    /// Between two given sections stand as few more as keep the lines from pin to pin within the tolerance, at points of
    /// the strokes, and placed so that what the strokes are off at most is as little as that many allow. Then intervals
    /// are halved, up to eight times, where the spline through the pins (as [`crate::surface::skin()`] makes it) swings
    /// beside a corner by more than the tolerance.
    ///
    /// # Errors
    /// [`SilhouetteError`] as [`super::deform_to_silhouette`], and for strokes whose detail takes more than 10 million
    /// points of sections.
    pub fn by_detail(
        &self,
        silhouettes: &[Silhouette<'_>],
        tolerance: f64,
        progress: &dyn Fn(f64) -> bool,
    ) -> Result<Sections, SilhouetteError> {
        if !(1e-6..=1.0).contains(&tolerance) {
            return Err(SilhouetteError::Tolerance { value: tolerance });
        }
        let drawn = self.drawn(silhouettes)?;
        let sides = self.sides(&drawn);
        let stack = self.sections;
        let allowed = tolerance * drawn.diagonal;
        let go_on = |done: f64| if progress(done) { Ok(()) } else { Err(SilhouetteError::Cancelled) };
        let room = |count: usize| match count > MOST_POINTS / stack.nodes() {
            true => Err(SilhouetteError::TooMuchDetail { at_least: count }),
            false => Ok(()),
        };
        let last = stack.len() - 1;
        let mut places = Vec::with_capacity(stack.len());
        for k in 0..last {
            go_on(0.5 * k as f64 / last as f64)?;
            places.push(k as f64);
            places.extend(between(&sides, k, allowed));
            room(places.len() + last - k)?;
        }
        places.push(last as f64);
        for round in 0..HALVING {
            go_on(0.5 + 0.5 * round as f64 / HALVING as f64)?;
            let halves = swinging(&sides, &places, allowed);
            if halves.is_empty() {
                break;
            }
            places.extend(halves);
            places.sort_unstable_by(f64::total_cmp);
            room(places.len())?;
        }
        let row = |place: &f64| -> Vec<DVec3> {
            let from = (*place as usize).min(last);
            let share = place - from as f64;
            if share == 0.0 {
                return stack.section(from).to_vec();
            }
            stack.section(from).iter().zip(stack.section(from + 1)).map(|(a, b)| a.lerp(*b, share)).collect()
        };
        Ok(Sections::new(places.iter().map(row).collect(), true, stack.rails().to_vec())?)
    }
}

/// Places strictly between section `k` and the next at which sections must stand.
fn between(sides: &[Side<'_>], k: usize, tolerance: f64) -> Vec<f64> {
    let mut places: Vec<f64> = sides.iter().flat_map(|side| side.places(k)).collect();
    places.sort_unstable_by(f64::total_cmp);
    places.retain(|p| (LEAST_STEP..=1.0 - LEAST_STEP).contains(p));
    places.dedup_by(|next, before| *next - *before < LEAST_STEP);
    places.insert(0, 0.0);
    places.push(1.0);
    places.iter_mut().for_each(|place| *place += k as f64);
    let mut best = fewest(sides, &places, tolerance);
    // The last of the fewest stands anywhere: the least tolerance that as many meet spreads them.
    let (mut low, mut high) = (0.0, tolerance);
    for _ in 0..SPREADING {
        let middle = (low + high) / 2.0;
        let found = fewest(sides, &places, middle);
        if found.len() == best.len() {
            (best, high) = (found, middle);
        } else {
            low = middle;
        }
    }
    best
}

/// The inner ones of as few places as meet a tolerance, each as far on as it does.
fn fewest(sides: &[Side<'_>], places: &[f64], tolerance: f64) -> Vec<f64> {
    let last = places.len() - 1;
    let mut found = Vec::new();
    let mut at = 0;
    loop {
        let meets = |to: usize| sides.iter().all(|side| side.off_chord([places[at], places[to]]) <= tolerance);
        // Twice as far as long as that meets it, then half way between what does and what does not.
        let (mut reach, mut beyond, mut step) = (at + 1, last + 1, 1);
        while reach < last {
            let next = (reach + step).min(last);
            if !meets(next) {
                beyond = next;
                break;
            }
            (reach, step) = (next, 2 * step);
        }
        while reach + 1 < beyond && reach < last {
            let middle = reach.midpoint(beyond);
            if meets(middle) {
                reach = middle;
            } else {
                beyond = middle;
            }
        }
        if reach >= last {
            return found;
        }
        found.push(places[reach]);
        at = reach;
    }
}

/// Half way between those neighbouring places between which a spline through the pins swings by more than the tolerance.
fn swinging(sides: &[Side<'_>], places: &[f64], tolerance: f64) -> Vec<f64> {
    let pins: Vec<Vec<DVec2>> = sides.iter().map(|side| places.iter().map(|place| side.at(*place)).collect()).collect();
    // Knots as those of the surface, of the pins instead of all points: by the root of the mean distance.
    let mut knots = vec![0.0];
    for k in 1..places.len() {
        let step: f64 = pins.iter().map(|line| line[k - 1].distance(line[k]).sqrt()).sum();
        knots.push(knots[k - 1] + step / pins.len() as f64);
    }
    let mut swings = vec![false; places.len() - 1];
    for (side, line) in sides.iter().zip(&pins) {
        let points = line.iter().map(|p| p.extend(0.0)).collect();
        // No spline goes through pins that all coincide twice; nor does a surface.
        let Ok(spline) = CubicSpline::natural(knots.clone(), points) else { continue };
        for (k, swing) in swings.iter_mut().enumerate() {
            if *swing || line[k].distance(line[k + 1]) <= tolerance {
                continue;
            }
            let at = |i: usize| knots[k] + (knots[k + 1] - knots[k]) * i as f64 / PIECES as f64;
            let drawn: Vec<DVec2> = (0..=PIECES).map(|i| spline.position(at(i)).truncate()).collect();
            let ends = [places[k], places[k + 1]];
            let inside = side.track.between(side.share(ends[0]), side.share(ends[1])).0;
            let stroke: Vec<DVec2> = [&line[k..=k], inside, &line[k + 1..=k + 1]].concat();
            *swing = side.off(&drawn, ends) > tolerance || drawn.iter().any(|p| distance(*p, &stroke) > tolerance);
        }
    }
    (0..swings.len()).filter(|k| swings[*k]).map(|k| f64::midpoint(places[k], places[k + 1])).collect()
}

/// Distance of a point from a line of two points or more.
fn distance(point: DVec2, line: &[DVec2]) -> f64 {
    let to_segment = |pair: &[DVec2]| {
        let (from, way) = (pair[0], pair[1] - pair[0]);
        let square = way.length_squared();
        let along = if square > 0.0 { ((point - from).dot(way) / square).clamp(0.0, 1.0) } else { 0.0 };
        point.distance_squared(from + way * along)
    };
    line.windows(2).map(to_segment).fold(f64::INFINITY, f64::min).sqrt()
}
