//! The shortest open way through all sections.

use super::OrderError;
use super::report::OrderWarning;
use super::station::Station;

/// Rounds of turning stretches around; a way joined from its nearest ends needs a few.
const ROUNDS: usize = 64;

/// A step this many times the one in the middle of all steps is a jump.
const JUMP: f64 = 6.0;

type GoOn<'a> = dyn Fn() -> Result<(), OrderError> + 'a;

/// The sections of `kept` along a way that is about the shortest one; which of its ends comes first is open.
pub(super) fn shortest(stations: &[Station], kept: Vec<usize>, go_on: &GoOn<'_>) -> Result<Vec<usize>, OrderError> {
    let mut way = joined(stations, &kept, go_on)?;
    untangle(stations, &mut way, go_on)?;
    Ok(way)
}

/// Joins the two nearest sections, then the next nearest, as long as each has at most two neighbours and no ring closes.
fn joined(stations: &[Station], kept: &[usize], go_on: &GoOn<'_>) -> Result<Vec<usize>, OrderError> {
    let count = kept.len();
    let mut pairs: Vec<(f64, u32, u32)> = Vec::with_capacity(count * count.saturating_sub(1) / 2);
    for a in 0..count {
        go_on()?;
        let from = &stations[kept[a]];
        // At most 2048 sections.
        pairs.extend((a + 1..count).map(|b| (from.distance(&stations[kept[b]]), a as u32, b as u32)));
    }
    go_on()?;
    pairs.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    go_on()?;
    let mut neighbours: Vec<Vec<usize>> = vec![Vec::new(); count];
    // The other end of the piece that each end is on.
    let mut far: Vec<usize> = (0..count).collect();
    let mut joints = 0;
    for (_, a, b) in pairs {
        let (a, b) = (a as usize, b as usize);
        if joints + 1 == count {
            break;
        }
        if neighbours[a].len() == 2 || neighbours[b].len() == 2 || far[a] == b {
            continue;
        }
        neighbours[a].push(b);
        neighbours[b].push(a);
        let (end_a, end_b) = (far[a], far[b]);
        (far[end_a], far[end_b]) = (end_b, end_a);
        joints += 1;
    }
    let mut way = Vec::with_capacity(count);
    let mut before = None;
    let mut at = neighbours.iter().position(|near| near.len() < 2);
    while let Some(here) = at {
        way.push(kept[here]);
        at = neighbours[here].iter().copied().find(|next| Some(*next) != before);
        before = Some(here);
    }
    Ok(way)
}

/// Turns stretches around as long as the way becomes shorter by that (2-opt, on an open way).
fn untangle(stations: &[Station], way: &mut [usize], go_on: &GoOn<'_>) -> Result<(), OrderError> {
    let count = way.len();
    let distance = |a: usize, b: usize| stations[a].distance(&stations[b]);
    for _ in 0..ROUNDS {
        let mut better = false;
        for first in 0..count {
            go_on()?;
            for last in first + 1..count {
                // The steps into and out of the stretch; at an end of the way there is none.
                let before = first.checked_sub(1).map(|k| way[k]);
                let behind = way.get(last + 1).copied();
                let step = |from: Option<usize>, to: Option<usize>| match (from, to) {
                    (Some(from), Some(to)) => distance(from, to),
                    _ => 0.0,
                };
                let now = step(before, Some(way[first])) + step(Some(way[last]), behind);
                let turned = step(before, Some(way[last])) + step(Some(way[first]), behind);
                if turned < now * (1.0 - 1e-12) {
                    way[first..=last].reverse();
                    better = true;
                }
            }
        }
        if !better {
            break;
        }
    }
    Ok(())
}

/// Steps that are much longer than the others.
pub(super) fn jumps(order: &[usize], stations: &[Station]) -> Vec<OrderWarning> {
    let step = |pair: &[usize]| stations[pair[0]].centre.distance(stations[pair[1]].centre);
    let mut steps: Vec<f64> = order.windows(2).map(step).collect();
    steps.sort_unstable_by(f64::total_cmp);
    let usual = steps.get(steps.len() / 2).copied().unwrap_or(0.0);
    // Of two steps none is unusual, and a step within a section's own size is none to wonder about.
    let wide = |pair: &&[usize]| step(pair) > JUMP * usual && step(pair) > stations[pair[0]].size;
    let found = order.windows(2).enumerate().filter(|(_, pair)| steps.len() > 2 && wide(pair));
    found
        .map(|(before, pair)| OrderWarning::Jump {
            before,
            gap: step(pair),
            usual,
            at: 0.5 * (stations[pair[0]].centre + stations[pair[1]].centre),
        })
        .collect()
}
