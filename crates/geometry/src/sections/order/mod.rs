//! Cross-sections in any order put in the order along the limb, made to run the same way and to begin at the same side.
//!
//! The order of work: a section that repeats another is dropped (`doubles`), the shortest way through all of them is
//! found (`path`), each is run counter-clockwise about that way, and its start is moved (`turn`).

mod doubles;
mod path;
mod report;
mod station;
#[cfg(test)]
mod tests;
mod turn;

pub use report::{OrderError, OrderWarning, Placed};

use glam::DVec3;

use crate::curve::{Curve, closest};
use station::Station;

/// Most sections that are ordered in one go.
pub const MAX_SECTIONS: usize = 2048;

/// Sizes (metres) between which products of several lengths stay well inside the numbers.
const SIZES: std::ops::RangeInclusive<f64> = 1e-60..=1e60;

/// Where sections begin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SectionStart {
    /// At the front: where the ray from the centroid to the front leaves the section for good. The front is carried
    /// along the stack by parallel transport, so that equal points of neighbouring sections correspond.
    #[default]
    Front,
    /// The first one at the front, every other where it is nearest to the start of the one before, moved along with the
    /// centres.
    Nearest,
    /// Where they begin already.
    Kept,
}

/// How sections are put in order.
#[derive(Clone, Debug, PartialEq)]
pub struct OrderOptions {
    /// The stack ends farther in this direction than it begins; any length. Not used with an axis.
    pub towards: DVec3,
    /// Where the front is; any length.
    pub front: DVec3,
    /// Where sections begin.
    pub start: SectionStart,
    /// Largest distance of two sections that count as one, as a share of the diagonal of the larger one.
    pub double: f64,
    /// An axis along which the sections stand, if it is known: they are ordered by the points of it that are nearest to
    /// their middles, in its direction.
    pub axis: Option<Curve>,
}

impl Default for OrderOptions {
    /// Upwards, begun at the front (+Z), doubles within 0.1 % of the diagonal, the axis to be found.
    fn default() -> Self {
        Self { towards: DVec3::Y, front: DVec3::Z, start: SectionStart::Front, double: 1e-3, axis: None }
    }
}

/// Sections in order.
#[derive(Clone, Debug, PartialEq)]
pub struct OrderedSections {
    /// The sections, counter-clockwise about the direction of the stack.
    pub sections: Vec<Curve>,
    /// What was done with each of them, in the same order.
    pub placed: Vec<Placed>,
    /// What should be looked at.
    pub warnings: Vec<OrderWarning>,
}

/// Puts closed curves in the order in which they stand along a limb.
///
/// Without an axis that is the shortest open way through all sections, by the distance between their middles (means
/// over the length), in which a step counts up to twice where it does not go along their normals, and the difference of
/// their mean radii: so that branches of a bent limb that come near each other are not mixed, and rings in one plane go
/// from the widest to the narrowest or back. It is sought by joining the nearest ends first, then by turning stretches
/// around as long as that makes it shorter; for sections that stand closer to one another than their limb bends, that is
/// their order. At most [`MAX_SECTIONS`].
///
/// Each section runs counter-clockwise about the direction from the one before to the one behind it; where these are no
/// way off its plane, about the direction that its neighbour has.
///
/// # Errors
/// [`OrderError`] where there is nothing to order, a curve is open, or an option is out of range.
pub fn order(curves: &[Curve], options: &OrderOptions) -> Result<OrderedSections, OrderError> {
    order_while(curves, options, &|_| true)
}

/// The same, telling `progress` what share is done, 0 to 1.
///
/// # Errors
/// As [`order`], and [`OrderError::Stopped`] where `progress` answers `false`.
pub fn order_while(
    curves: &[Curve],
    options: &OrderOptions,
    progress: &dyn Fn(f64) -> bool,
) -> Result<OrderedSections, OrderError> {
    let told = |share: f64| if progress(share) { Ok(()) } else { Err(OrderError::Stopped) };
    told(0.0)?;
    check(curves, options)?;
    let mut stations = Vec::with_capacity(curves.len());
    for curve in curves {
        told(0.0)?;
        stations.push(Station::of(curve));
    }
    let mut warnings = Vec::new();
    let kept = doubles::kept(curves, &stations, options.double, &mut warnings, &|| told(0.1))?;
    let mut order = match &options.axis {
        Some(axis) => along(axis, &stations, kept, &|| told(0.3))?,
        None => path::shortest(&stations, kept, &|| told(0.3))?,
    };
    if options.axis.is_none() && runs_against(&order, &stations, options.towards) {
        order.reverse();
    }
    warnings.extend(path::jumps(&order, &stations));
    let (sections, placed) = turn::turned(curves, &stations, &order, options, &|| told(0.9))?;
    Ok(OrderedSections { sections, placed, warnings })
}

fn check(curves: &[Curve], options: &OrderOptions) -> Result<(), OrderError> {
    if !(1..=MAX_SECTIONS).contains(&curves.len()) {
        return Err(OrderError::SectionCount { found: curves.len() });
    }
    if let Some(open) = curves.iter().position(|curve| !curve.is_closed()) {
        return Err(OrderError::Open { section: open, name: curves[open].name().to_owned() });
    }
    for (what, direction) in [("direction", options.towards), ("front", options.front)] {
        if !direction.is_finite() || direction == DVec3::ZERO {
            return Err(OrderError::Direction { what, found: direction });
        }
    }
    if !(0.0..=0.5).contains(&options.double) {
        return Err(OrderError::Double { found: options.double });
    }
    let sizes = curves.iter().chain(&options.axis).map(|curve| {
        let (low, high) = curve.bounds();
        (high - low).length().max(low.abs().max(high.abs()).max_element())
    });
    // The smallest is that of a section, and the largest holds the places of all.
    let (least, most) = sizes.fold((f64::INFINITY, 0.0), |(l, m): (f64, f64), size| (l.min(size), m.max(size)));
    if SIZES.contains(&least) && SIZES.contains(&most) { Ok(()) } else { Err(OrderError::Size { least, most }) }
}

/// By the nearest points of an axis; as given where these are one.
fn along(
    axis: &Curve,
    stations: &[Station],
    mut kept: Vec<usize>,
    go_on: &dyn Fn() -> Result<(), OrderError>,
) -> Result<Vec<usize>, OrderError> {
    let mut places = vec![0.0; stations.len()];
    for &section in &kept {
        go_on()?;
        places[section] = beyond(axis, stations[section].centre);
    }
    kept.sort_by(|a, b| places[*a].total_cmp(&places[*b]));
    Ok(kept)
}

/// Place along an axis that goes on straight beyond its ends, metres.
fn beyond(axis: &Curve, point: DVec3) -> f64 {
    let nearest = closest(axis, point);
    let past = |segment: usize| {
        let (from, to) = axis.segment(segment);
        (point - nearest.point).dot((to - from).normalize_or_zero())
    };
    match nearest.fraction {
        0.0 => past(0).min(0.0),
        1.0 => nearest.arc_length + past(axis.segment_count() - 1).max(0.0),
        _ => nearest.arc_length,
    }
}

/// Whether the first section lies farther in a direction than the last one; of two equally far ones, whether it lies
/// farther in +X, then +Y, then +Z, so that the order in which they are given does not matter; of two at one place,
/// whether it was given later.
fn runs_against(order: &[usize], stations: &[Station], towards: DVec3) -> bool {
    let (Some(&first), Some(&last)) = (order.first(), order.last()) else { return false };
    let unit = (towards / towards.abs().max_element()).normalize_or_zero();
    let way = stations[last].centre - stations[first].centre;
    let size = stations[first].size.max(stations[last].size);
    let rises = [unit, DVec3::X, DVec3::Y, DVec3::Z].map(|axis| way.dot(axis));
    rises.into_iter().find(|rise| rise.abs() > 1e-9 * size).map_or(last < first, |rise| rise < 0.0)
}
