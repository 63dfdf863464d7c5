//! Finding what would twist or fold a surface before it does.

use super::axis::Station;
use super::explain::{listed, metres};
use super::order::mid_arc;
use super::{GoOn, MEETING, Rail, SAME, SortError};
use crate::curve::{Curve, closest};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Share of a turn by which neighbours may stand in the wrong order before it counts.
const ORDER: f64 = 1e-6;

/// Rails in order, and what they begin and end at.
pub(super) struct Scene<'a> {
    pub(super) rails: &'a [Rail],
    /// Closed curves at the starts and at the ends, with what they are called.
    pub(super) rings: [Option<&'a (String, Curve)>; 2],
    pub(super) stations: &'a [Station; 2],
    pub(super) middle: &'a Station,
    pub(super) size: f64,
    pub(super) pinned: bool,
}

impl Scene<'_> {
    pub(super) fn warnings(&self, go_on: &GoOn<'_>) -> Result<Vec<String>, SortError> {
        let mut warnings = vec![];
        for (side, verb) in ["start", "end"].into_iter().enumerate() {
            self.far_from_ring(side, verb, &mut warnings, go_on)?;
            go_on()?;
            self.out_of_order(side, verb, &mut warnings);
            go_on()?;
        }
        self.turning(&mut warnings);
        self.coincident(&mut warnings);
        go_on()?;
        if self.pinned {
            let middles = self.rails.iter().map(|rail| self.middle.angle(mid_arc(&rail.curve)) / TAU).collect();
            if !increases(&from_first(middles)) {
                warnings.push(
                    "the pinned order does not run counter-clockwise about the axis: the surface would fold or turn \
                     inside out; change the order"
                        .to_owned(),
                );
            }
        }
        Ok(warnings)
    }

    /// Start (side 0) or end (side 1) of a rail.
    fn end(rail: &Rail, side: usize) -> DVec3 {
        if side == 0 { rail.curve.start() } else { rail.curve.end() }
    }

    /// Whether all rails come together on a side, so that there is no order and no angle.
    fn is_pole(&self, side: usize) -> bool {
        let first = Self::end(&self.rails[0], side);
        self.rails.iter().all(|rail| Self::end(rail, side).distance(first) <= SAME * self.size)
    }

    fn far_from_ring(
        &self,
        side: usize,
        verb: &str,
        warnings: &mut Vec<String>,
        go_on: &GoOn<'_>,
    ) -> Result<(), SortError> {
        let Some((name, ring)) = self.rings[side] else { return Ok(()) };
        for (i, rail) in self.rails.iter().enumerate() {
            go_on()?;
            let distance = closest(ring, Self::end(rail, side)).distance;
            if distance > MEETING * self.size {
                warnings.push(format!(
                    "rail {i} ({}) {verb}s {} away from {name}: draw it up to the closed curve",
                    rail.label,
                    metres(distance)
                ));
            }
        }
        Ok(())
    }

    fn out_of_order(&self, side: usize, verb: &str, warnings: &mut Vec<String>) {
        if self.is_pole(side) {
            return;
        }
        let places = self
            .rails
            .iter()
            .map(|rail| match self.rings[side] {
                Some((_, ring)) => closest(ring, Self::end(rail, side)).fraction,
                None => self.stations[side].angle(Self::end(rail, side)) / TAU,
            })
            .collect();
        let places = from_first(places);
        if increases(&places) {
            return;
        }
        let mut found: Vec<usize> = (0..self.rails.len()).collect();
        found.sort_by(|a, b| places[*a].total_cmp(&places[*b]));
        let found: Vec<String> = found.into_iter().map(|i| self.rails[i].label.clone()).collect();
        let sorted: Vec<String> = self.rails.iter().map(|rail| rail.label.clone()).collect();
        let around = self.rings[side].map_or("the axis", |(name, _)| name);
        warnings.push(format!(
            "around {around} the rails {verb} in the order {}, but along the shape they stand in the order {}: the \
             surface would twist; untangle the curves, or pin the order",
            listed(&found),
            listed(&sorted)
        ));
    }

    fn turning(&self, warnings: &mut Vec<String>) {
        if self.is_pole(0) || self.is_pole(1) {
            return;
        }
        for (i, rail) in self.rails.iter().enumerate() {
            let angles = [
                self.stations[0].angle(rail.curve.start()),
                self.middle.angle(mid_arc(&rail.curve)),
                self.stations[1].angle(rail.curve.end()),
            ];
            let turn = wrapped(angles[1] - angles[0]) + wrapped(angles[2] - angles[1]);
            if turn.abs() > FRAC_PI_2 + 1e-9 {
                warnings.push(format!(
                    "rail {i} ({}) turns {:.0} degrees around the axis from its start to its end: the surface would \
                     twist; draw it straighter, or flip or reorder it",
                    rail.label,
                    turn.abs().to_degrees()
                ));
            }
        }
    }

    fn coincident(&self, warnings: &mut Vec<String>) {
        if self.is_pole(0) {
            return;
        }
        for (i, a) in self.rails.iter().enumerate() {
            for (j, b) in self.rails.iter().enumerate().skip(i + 1) {
                let distance = a.curve.start().distance(b.curve.start());
                if distance < SAME * self.size {
                    warnings.push(format!(
                        "rails {i} ({}) and {j} ({}) start {} apart, which is one place: delete one of them, or draw \
                         them apart",
                        a.label,
                        b.label,
                        metres(distance)
                    ));
                }
            }
        }
    }
}

/// Places around a circle (in turns) as turns from the first of them, 0 to 1.
fn from_first(mut places: Vec<f64>) -> Vec<f64> {
    let first = places.first().copied().unwrap_or(0.0);
    for place in &mut places {
        *place = (*place - first + ORDER).rem_euclid(1.0);
    }
    places
}

fn increases(places: &[f64]) -> bool {
    places.windows(2).all(|pair| pair[1] > pair[0] - ORDER)
}

fn wrapped(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}
