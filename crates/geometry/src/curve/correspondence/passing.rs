//! Where rails pass a closed curve that lies between their ends.

use super::closest_pair::{Segment, closest_pair};
use super::{GoOn, Rail, SortError};
use crate::curve::{ArcLength, Curve};
use glam::DVec3;

/// Where rails, in their order, pass one closed curve.
#[derive(Clone, Debug)]
pub(super) struct Passing {
    /// The point of rail 0 nearest to the curve.
    pub(super) first: DVec3,
    /// Whether the curve runs against the order of the rails.
    pub(super) backwards: bool,
}

impl Passing {
    /// Finds the places at which `rails` come nearest to `ring`. The order of their feet on it tells its direction; of two
    /// rails, which have none, it is that about the rails' own direction there, or about the `axis` where they point
    /// apart.
    pub(super) fn of(rails: &[Rail], ring: &Curve, axis: DVec3, go_on: &GoOn<'_>) -> Result<Self, SortError> {
        let around = segments(ring);
        let mut first = None;
        let mut direction = DVec3::ZERO;
        let mut feet = Vec::with_capacity(rails.len());
        for rail in rails {
            let arc = ArcLength::of(&rail.curve);
            let [at, foot] =
                closest_pair(&segments(&rail.curve), &around, go_on)?.map_or([0.0; 2], |pair| pair.arc_lengths);
            first.get_or_insert(arc.point_at(at));
            direction += arc.tangent_at(at).normalize_or_zero();
            feet.push(foot);
        }
        // Once around with the order of the rails is one length of the curve, against it one less than there are rails.
        let length = ArcLength::of(ring).length();
        let next = feet.iter().cycle().skip(1);
        let turns = feet.iter().zip(next).map(|(from, to)| (to - from).rem_euclid(length)).sum::<f64>() / length;
        let half = 0.5 * rails.len() as f64;
        let backwards = if (turns - half).abs() < 0.25 {
            let own = direction / rails.len().max(1) as f64;
            ring.area_vector().dot(if own.length() < 0.2 { axis } else { own }) < 0.0
        } else {
            turns > half
        };
        Ok(Self { first: first.unwrap_or(DVec3::ZERO), backwards })
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
