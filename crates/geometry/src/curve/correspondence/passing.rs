//! Where rails pass a closed curve that lies between their ends.

use super::closest_pair::{Segment, closest_pair};
use super::{GoOn, Rail, SortError};
use crate::curve::{ArcLength, Curve};
use glam::DVec3;

/// Where rails pass one closed curve.
#[derive(Clone, Debug)]
pub(super) struct Passing {
    /// The point of each rail nearest to the curve.
    pub(super) points: Vec<DVec3>,
    /// Mean direction of the rails there; of no length where they point apart.
    pub(super) direction: DVec3,
}

impl Passing {
    /// Finds the places at which `rails` come nearest to `ring`.
    pub(super) fn of(rails: &[Rail], ring: &Curve, go_on: &GoOn<'_>) -> Result<Self, SortError> {
        let around = segments(ring);
        let mut points = Vec::with_capacity(rails.len());
        let mut direction = DVec3::ZERO;
        for rail in rails {
            let arc = ArcLength::of(&rail.curve);
            let at = closest_pair(&segments(&rail.curve), &around, go_on)?.map_or(0.0, |pair| pair.arc_lengths[0]);
            points.push(arc.point_at(at));
            direction += arc.tangent_at(at).normalize_or_zero();
        }
        let mean = direction / rails.len().max(1) as f64;
        Ok(Self { points, direction: if mean.length() < 0.2 { DVec3::ZERO } else { mean.normalize_or_zero() } })
    }
}

fn segments(curve: &Curve) -> Vec<Segment> {
    let mut start = 0.0;
    (0..curve.segment_count())
        .map(|index| {
            let (from, to) = curve.segment(index);
            let segment = Segment { from, to, start };
            start += from.distance(to);
            segment
        })
        .collect()
}
