//! Making all rails run the same way.

use super::crossing::{crossing, cut, gap, move_end};
use super::explain::metres;
use super::order::mid_arc;
use super::{Decision, GoOn, MEETING, Rail, SortError};
use crate::curve::{Curve, closest};
use glam::DVec3;

/// Rails whose ends spread by less than this share of the spread of their middles may meet in a point.
const TAPER: f64 = 0.1;

/// Rails that run the same way.
pub(super) struct Run {
    pub(super) rails: Vec<Rail>,
    /// Where they all end.
    pub(super) apex: Option<DVec3>,
    /// Whether they are the halves of two curves.
    pub(super) halves: bool,
}

/// Makes open curves run from the first closed curve to the second, to an apex, or as the first of them was drawn.
pub(super) fn run(
    open: Vec<Rail>,
    rings: &[&Curve],
    size: f64,
    (decisions, warnings): (&mut Vec<Decision>, &mut Vec<String>),
    go_on: &GoOn<'_>,
) -> Result<Run, SortError> {
    let tolerance = MEETING * size;
    if let ([first, second], [] | [_]) = (&open[..], rings)
        && let Some(found) = crossing(&first.curve, &second.curve, tolerance, go_on)?
        && rings.iter().all(|ring| starts_around(ring, [&first.curve, &second.curve], found.point))
    {
        decisions.push(Decision::Cut {
            curves: [first.label.clone(), second.label.clone()],
            at: found.point,
            gap: if found.gap > 1e-9 * size { found.gap } else { 0.0 },
        });
        if let Some(at) = found.elsewhere {
            warnings.push(format!(
                "{} and {} also meet at {at:.3}, {} from where they were cut: the rails cross there",
                first.label,
                second.label,
                metres(at.distance(found.point))
            ));
        }
        let mut rails = Vec::with_capacity(4);
        for (rail, s) in open.iter().zip(found.arc_lengths) {
            let halves = cut(&rail.curve, s, found.point).ok_or_else(|| vanishes(rail))?;
            for (half, curve) in halves.into_iter().enumerate() {
                let number = 2 * rail.number + half;
                rails.push(Rail { curve, label: rail.label.clone(), number, flipped: half == 1 });
            }
        }
        return Ok(Run { rails, apex: Some(found.point), halves: true });
    }
    let mut rails = open;
    let apex = match rings {
        [first, second, ..] => {
            for rail in &mut rails {
                go_on()?;
                let (start, end) = (rail.curve.start(), rail.curve.end());
                let as_drawn = closest(first, start).distance + closest(second, end).distance;
                flip_if(rail, closest(first, end).distance + closest(second, start).distance < as_drawn);
            }
            return Ok(Run { rails, apex: None, halves: false });
        }
        [ring] => {
            for rail in &mut rails {
                go_on()?;
                let (start, end) = (rail.curve.start(), rail.curve.end());
                flip_if(rail, closest(ring, end).distance < closest(ring, start).distance);
            }
            meeting_point(&rails, tolerance)
        }
        [] => run_alone(&mut rails, tolerance, decisions, go_on)?,
    };
    if let Some(at) = apex {
        let moved = rails.iter().map(|rail| rail.curve.end().distance(at)).fold(0.0, f64::max);
        for rail in &mut rails {
            rail.curve = move_end(&rail.curve, at).ok_or_else(|| vanishes(rail))?;
        }
        decisions.push(Decision::Apex { at, moved: if moved > 1e-9 * size { moved } else { 0.0 } });
    }
    Ok(Run { rails, apex, halves: false })
}

/// Makes rails run to the end at which all coincide, or else as the first one was drawn.
fn run_alone(
    rails: &mut [Rail],
    tolerance: f64,
    decisions: &mut Vec<Decision>,
    go_on: &GoOn<'_>,
) -> Result<Option<DVec3>, SortError> {
    let (start, end) = (rails[0].curve.start(), rails[0].curve.end());
    let gathered = |at: DVec3| {
        let mut gathered = rails.to_vec();
        for rail in &mut gathered {
            go_on()?;
            flip_if(rail, rail.curve.start().distance(at) < rail.curve.end().distance(at));
        }
        go_on()?;
        Ok(meeting_point(&gathered, tolerance).map(|apex| (gathered, apex)))
    };
    let (at_start, at_end) = (gathered(start)?, gathered(end)?);
    if at_start.is_some() == at_end.is_some() {
        decisions.push(Decision::RunAsDrawn { curve: rails[0].label.clone() });
    }
    if let Some((gathered, apex)) = at_end.or(at_start) {
        rails.clone_from_slice(&gathered);
        return Ok(Some(apex));
    }
    if let [first, second] = rails {
        let names = (first.label.clone(), second.label.clone());
        let gap = gap(&first.curve, &second.curve, go_on)?;
        return Err(if gap > tolerance {
            SortError::Apart { first: names.0, second: names.1, gap, allowed: tolerance }
        } else {
            SortError::MeetNearEnd { first: names.0, second: names.1 }
        });
    }
    for rail in rails {
        let (from, to) = (rail.curve.start(), rail.curve.end());
        flip_if(rail, to.distance(start) + from.distance(end) < from.distance(start) + to.distance(end));
    }
    Ok(None)
}

/// The mean of the rails' ends where they all but coincide: within `tolerance` metres of it, and a tenth of the spread
/// of the rails' middles, so that a thin limb cut off at its end is not taken for a pointed one.
fn meeting_point(rails: &[Rail], tolerance: f64) -> Option<DVec3> {
    let (apex, spread) = mean_and_spread(rails.iter().map(|rail| rail.curve.end()));
    let (_, middles) = mean_and_spread(rails.iter().map(|rail| mid_arc(&rail.curve)));
    (spread <= tolerance.min(TAPER * middles)).then_some(apex)
}

fn mean_and_spread(points: impl ExactSizeIterator<Item = DVec3> + Clone) -> (DVec3, f64) {
    let mean = points.clone().sum::<DVec3>() / points.len() as f64;
    (mean, points.map(|p| p.distance(mean)).fold(0.0, f64::max))
}

/// Whether both ends of both curves are nearer to a closed curve than the point where they cross.
fn starts_around(ring: &Curve, curves: [&Curve; 2], crossing: DVec3) -> bool {
    let far = closest(ring, crossing).distance;
    curves.iter().all(|curve| [curve.start(), curve.end()].iter().all(|end| closest(ring, *end).distance < far))
}

fn flip_if(rail: &mut Rail, wrong_way: bool) {
    if wrong_way {
        rail.curve = rail.curve.clone().reversed();
        rail.flipped = !rail.flipped;
    }
}

fn vanishes(rail: &Rail) -> SortError {
    SortError::RailVanishes { curve: rail.label.clone() }
}

/// Names the halves of cut curves 1 and 2 in the order in which they stand, so that the names do not depend on the
/// direction in which a curve was drawn.
pub(super) fn name_halves(rails: &mut [Rail]) {
    let mut seen = [0, 0];
    for rail in rails {
        let whole = rail.number / 2;
        let half = seen[whole];
        seen[whole] += 1;
        rail.number = 2 * whole + half;
        rail.label = format!("{}, half {}", rail.label, half + 1);
        if !rail.curve.name().is_empty() {
            rail.curve = rail.curve.clone().renamed(format!("{} {}", rail.curve.name(), half + 1));
        }
    }
}
