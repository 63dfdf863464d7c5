//! Sections that repeat another one.

use super::OrderError;
use super::report::OrderWarning;
use super::station::Station;
use crate::curve::{Curve, closest};

/// The sections that repeat none before them, each of the others told of.
pub(super) fn kept(
    curves: &[Curve],
    stations: &[Station],
    share: f64,
    warnings: &mut Vec<OrderWarning>,
    go_on: &dyn Fn() -> Result<(), OrderError>,
) -> Result<Vec<usize>, OrderError> {
    let mut kept: Vec<usize> = Vec::with_capacity(curves.len());
    for (section, here) in stations.iter().enumerate() {
        go_on()?;
        let mut found = None;
        for &other in &kept {
            let there = &stations[other];
            let tolerance = share * here.size.max(there.size);
            // Cheaper than points, and true of all that are within the tolerance: means do not differ by more, but that
            // of a corner that is cut may a little.
            let near = here.centre.distance(there.centre) <= 4.0 * tolerance
                && (here.size - there.size).abs() <= 4.0 * tolerance;
            if near && within(&curves[section], &curves[other], tolerance, go_on)? {
                found = Some(other);
                break;
            }
        }
        match found {
            Some(of) => warnings.push(OrderWarning::Double {
                section,
                of,
                name: curves[section].name().to_owned(),
                name_of: curves[of].name().to_owned(),
                at: here.centre,
            }),
            None => kept.push(section),
        }
    }
    Ok(kept)
}

/// Whether the points of each are within `tolerance` of the other.
fn within(
    a: &Curve,
    b: &Curve,
    tolerance: f64,
    go_on: &dyn Fn() -> Result<(), OrderError>,
) -> Result<bool, OrderError> {
    for (points, other) in [(a, b), (b, a)] {
        for (k, point) in points.points().iter().enumerate() {
            if k.is_multiple_of(64) {
                go_on()?;
            }
            if closest(other, *point).distance > tolerance {
                return Ok(false);
            }
        }
    }
    Ok(true)
}
