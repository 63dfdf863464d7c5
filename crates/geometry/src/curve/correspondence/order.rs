//! The order of rails around their axis.

use super::axis::{Axis, Station};
use super::{Rail, SortError};
use crate::curve::{ArcLength, Curve};
use glam::DVec3;
use std::f64::consts::TAU;

/// Angles (radians) that count as equal where rail 0 is chosen.
const EQUAL: f64 = 1e-6;

/// The point of a curve at half its arc length.
pub(super) fn mid_arc(curve: &Curve) -> DVec3 {
    ArcLength::of(curve).point_at_fraction(0.5)
}

/// The station of the rails' middles.
pub(super) fn middle(rails: &[Rail], axis: &Axis) -> Station {
    let middles: Vec<DVec3> = rails.iter().map(|rail| mid_arc(&rail.curve)).collect();
    Station::new(&middles, axis.direction, axis)
}

/// Rails counter-clockwise, from the one nearest to the seam. Equal angles: the one nearer to the centre first.
pub(super) fn automatic(rails: Vec<Rail>, middle: &Station) -> Vec<Rail> {
    let places: Vec<(f64, f64)> = rails
        .iter()
        .map(|rail| mid_arc(&rail.curve))
        .map(|point| (middle.angle(point), point.distance(middle.centre)))
        .collect();
    let nearest = places.iter().map(|(angle, _)| angle.abs()).fold(f64::INFINITY, f64::min);
    // Of two rails at equal angles to both sides of the seam, the counter-clockwise one.
    let zero = places
        .iter()
        .map(|(angle, _)| *angle)
        .filter(|angle| angle.abs() <= nearest + EQUAL)
        .fold(f64::NEG_INFINITY, f64::max);
    let mut sorted: Vec<(f64, f64, Rail)> = rails
        .into_iter()
        .zip(places)
        // Rounding must not send a rail beside rail 0 once round.
        .map(|(rail, (angle, radius))| ((angle - zero + 1e-9).rem_euclid(TAU), radius, rail))
        .collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    sorted.into_iter().map(|(_, _, rail)| rail).collect()
}

/// Rails in the order named by hand.
pub(super) fn pinned(rails: Vec<Rail>, order: &[String]) -> Result<Vec<Rail>, SortError> {
    let listing = || {
        let mut listed: Vec<&Rail> = rails.iter().collect();
        listed.sort_by_key(|rail| rail.number);
        listed.into_iter().map(call).collect::<Vec<String>>()
    };
    let mut places: Vec<usize> = Vec::with_capacity(order.len());
    for (place, name) in order.iter().enumerate() {
        let named: Vec<usize> =
            (0..rails.len()).filter(|i| !name.is_empty() && rails[*i].curve.name() == name).collect();
        let found = match named[..] {
            [one] => one,
            [] => name
                .trim()
                .parse::<usize>()
                .ok()
                .and_then(|number| rails.iter().position(|rail| rail.number == number))
                .ok_or_else(|| SortError::UnknownRail { place, name: name.clone(), rails: listing() })?,
            _ => {
                let mut numbers: Vec<usize> = named.iter().map(|i| rails[*i].number).collect();
                numbers.sort_unstable();
                let rails = numbers.iter().map(usize::to_string).collect();
                return Err(SortError::AmbiguousRail { place, name: name.clone(), rails });
            }
        };
        if let Some(first) = places.iter().position(|i| *i == found) {
            return Err(SortError::DuplicateRail { place, name: name.clone(), first, rails: listing() });
        }
        places.push(found);
    }
    let mut missing: Vec<&Rail> = (0..rails.len()).filter(|i| !places.contains(i)).map(|i| &rails[i]).collect();
    if !missing.is_empty() {
        missing.sort_by_key(|rail| rail.number);
        return Err(SortError::MissingRails { missing: missing.into_iter().map(call).collect(), rails: listing() });
    }
    Ok(places.into_iter().map(|i| rails[i].clone()).collect())
}

/// What a rail can be pinned by.
fn call(rail: &Rail) -> String {
    match rail.curve.name() {
        "" => rail.number.to_string(),
        name => format!("{} \"{name}\"", rail.number),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn middle_does_not_depend_on_how_densely_a_stroke_was_drawn() {
        let dense = (0..100).map(|i| DVec3::X * (f64::from(i) / 100.0));
        let points = dense.chain([DVec3::X, DVec3::X * 3.0]).collect();
        let stroke = Curve::new("stroke", points, false).unwrap();
        assert!(mid_arc(&stroke).distance(DVec3::X * 1.5) < 1e-12);
    }
}
