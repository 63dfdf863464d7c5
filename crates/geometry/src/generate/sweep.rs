//! The sweeping surface itself: generators through rails, along the curves that these meet (thesis 6.3, paper 5.2.4).

use glam::DVec3;

use super::feet::{Feet, Which};
use super::neighbour::{Across, Edge, Neighbour, end_slopes};
use super::pace::Pace;
use super::patch::blend_generators;
use super::places::{apex, crossings};
use super::side::Side;
use super::turning::{Stand, Turning};
use super::walk::{Walk, share_out};
use super::{Frame, GenerateError, GenerateOptions, Generated, check_size, report};
use crate::beam::OpenCardinals;
use crate::curve::{ArcLength, Curve};
use crate::sections::Sections;

/// What a sweeping surface is drawn by.
#[derive(Clone, Debug)]
pub(super) struct Drawing<'a> {
    /// Open curves, each from the first profile to the last, or on to the apex.
    pub(super) rails: &'a [Curve],
    /// The curves that the rails meet, in this order: all closed, or all open.
    pub(super) profiles: Vec<&'a Curve>,
    /// Whether the profiles are closed.
    pub(super) closed: bool,
    /// Whether the rails run on from the last profile to a common point.
    pub(super) apex: bool,
    /// What lies beyond the first and the last profile.
    pub(super) neighbours: [Option<Neighbour<'a>>; 2],
    /// What lies beyond the first and the last rail, where the profiles are open.
    pub(super) sides: [Option<Neighbour<'a>>; 2],
}

/// Makes the surface: sections along the rails, between closed profiles loops, between open ones from the first rail to
/// the last.
pub(super) fn sweep(
    drawing: &Drawing<'_>,
    options: &GenerateOptions,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Generated, GenerateError> {
    check(drawing, options)?;
    let Drawing { rails, profiles, closed, .. } = drawing;
    let (mut notes, mut warnings) = (Vec::new(), Vec::new());
    let mut feet = find_feet(drawing, options)?;
    let tip = drawing.apex.then(|| apex(rails, options.snap)).transpose()?;

    let columns = if *closed { options.nodes } else { options.nodes.saturating_sub(1) };
    let offsets: Vec<&[f64]> = feet.iter().map(|feet| feet.offsets.as_slice()).collect();
    let mut intervals = share_out(columns, &offsets, &mut notes);
    let outermost = [0, intervals.len() - 1];
    for (side, patch) in drawing.sides.iter().zip(outermost) {
        if side.is_some() {
            // Enough for differences of third order.
            intervals[patch] = intervals[patch].max(3);
        }
    }
    let nodes = intervals.iter().sum::<usize>() + usize::from(!closed);
    if nodes > options.nodes {
        GenerateOptions { nodes, ..*options }.check(4)?;
    }

    let crossings = crossings(rails, profiles, drawing.apex)?;
    let held = sections_of(&crossings, options.sections)?;
    let inner = &held[1..held.len() - 1];
    let functions = if drawing.neighbours.iter().any(Option::is_some) {
        // A surface that is to continue another one must do so at any number of sections.
        OpenCardinals::exact(options.sections, inner, options.stiffness)?
    } else {
        OpenCardinals::differences(options.sections, inner, options.stiffness)?
    };
    let sampled: Vec<Vec<DVec3>> = rails.iter().zip(&crossings).map(|(rail, at)| sample(rail, at, &held)).collect();

    let mut stands: Vec<Stand<'_>> =
        profiles.iter().zip(&feet).map(|(curve, feet)| Stand::Ring { curve, origin: feet.origin }).collect();
    let mut curves: Vec<Option<&Curve>> = profiles.iter().map(|curve| Some(*curve)).collect();
    let mut all_gaps: Vec<Vec<f64>> = feet.iter().map(|feet| feet.gaps.clone()).collect();
    if let Some(tip) = &tip {
        all_gaps.push(tip.gaps.clone());
        let fan = if *closed { tip.fan(&sampled) } else { None };
        let offsets = match &fan {
            Some((_, angles)) => angles.clone(),
            None => feet[feet.len() - 1].offsets.clone(),
        };
        stands.push(fan.map_or(Stand::Point, |(normal, _)| Stand::Fan(normal)));
        curves.push(None);
        feet.push(Feet { points: vec![tip.point; rails.len()], offsets, origin: 0.0, gaps: tip.gaps.clone() });
    }
    let edges = edges(drawing, &feet, &sampled, &mut warnings)?;
    let walks = Walk::all(&curves, feet, *closed, options.weights);

    let turning = if *closed && options.frame == Frame::Turning {
        let offsets: Vec<&[f64]> = walks.iter().map(|walk| walk.feet.offsets.as_slice()).collect();
        let turning = Turning::new(&stands, &offsets, &sampled, &functions);
        turning
            .map_err(|why| {
                notes.push(format!("The frame stays fixed between the rails, and the shape may flatten there: {why}."));
            })
            .ok()
    } else {
        None
    };

    let mut rows = vec![Vec::with_capacity(nodes); options.sections];
    let mut rail_columns = Vec::with_capacity(rails.len());
    // An open surface ends with the last rail, which is a patch of one column.
    let last = (!closed).then_some(1);
    for (patch, count) in intervals.iter().copied().chain(last).enumerate() {
        rail_columns.push(rows[0].len());
        let next = if patch + 1 == rails.len() && !closed { patch } else { (patch + 1) % rails.len() };
        for node in 0..count {
            report(progress, rows[0].len(), nodes)?;
            let share = node as f64 / count as f64;
            let through: Vec<DVec3> = walks.iter().map(|walk| walk.point(patch, share)).collect();
            let offsets: Vec<f64> = walks.iter().map(|walk| walk.offset(patch, share)).collect();
            let weight = options.weights.at(share);
            let mut generator = match &turning {
                Some(turning) => turning.generator(patch, weight, &offsets, &through, &functions),
                None => blend_generators(&sampled[patch], &sampled[next], weight, &through, &functions),
            };
            let mut tangents = [None, None];
            for (end, edge) in edges.iter().enumerate() {
                if let Some(edge) = edge {
                    let at = if end == 0 { 0 } else { through.len() - 1 };
                    tangents[end] = Some(edge.tangent([patch, next], weight, offsets[at], &generator)?);
                }
            }
            steer(&mut generator, &functions, tangents);
            for (row, point) in rows.iter_mut().zip(generator) {
                row.push(point);
            }
        }
    }
    for (end, side) in drawing.sides.into_iter().enumerate() {
        let Some(neighbour) = side.filter(|_| !closed) else { continue };
        let rail = if end == 0 { 0 } else { rails.len() - 1 };
        let columns = if end == 0 { (0, intervals[0]) } else { (nodes - 1, intervals[intervals.len() - 1]) };
        let rail = Side { rail: &rails[rail], crossings: &crossings[rail], neighbour, end: end == 1 };
        rail.continue_neighbour(&mut rows, columns, &held, &functions, &mut warnings)?;
    }
    report(progress, 1, 1)?;
    let largest_gap = all_gaps.iter().flatten().copied().fold(0.0, f64::max);
    let gaps = all_gaps[0].iter().zip(&all_gaps[all_gaps.len() - 1]).map(|(start, end)| [*start, *end]).collect();
    let size = size(rails.iter().chain(profiles.iter().copied()));
    warnings.extend(gap_warning(size, largest_gap, options.snap));
    Ok(Generated { sections: Sections::new(rows, *closed, rail_columns)?, notes, warnings, largest_gap, gaps })
}

fn check(drawing: &Drawing<'_>, options: &GenerateOptions) -> Result<(), GenerateError> {
    let Drawing { rails, profiles, closed, apex, neighbours, sides } = drawing;
    options.check(4)?;
    let beyond = neighbours.iter().chain(sides).filter_map(|neighbour| match neighbour {
        Some(Neighbour::Curve(curve)) => Some(*curve),
        _ => None,
    });
    check_size(rails.iter().chain(profiles.iter().copied()).chain(beyond))?;
    if rails.len() < 2 {
        return Err(GenerateError::TooFewRails { found: rails.len() });
    }
    let needed = if *apex { 1 } else { 2 };
    if profiles.len() < needed {
        return Err(GenerateError::TooFewProfiles { found: profiles.len(), needed });
    }
    if let Some((rail, curve)) = rails.iter().enumerate().find(|(_, curve)| curve.is_closed()) {
        return Err(GenerateError::RailIsClosed { rail, name: curve.name().to_owned() });
    }
    for (k, curve) in profiles.iter().enumerate() {
        let (which, name) = (which(drawing, k).name(), || curve.name().to_owned());
        match (*closed, curve.is_closed()) {
            (true, false) => return Err(GenerateError::CurveIsOpen { which, name: name() }),
            (false, true) => return Err(GenerateError::CurveIsClosed { which, name: name() }),
            _ => {}
        }
    }
    Ok(())
}

fn which(drawing: &Drawing<'_>, profile: usize) -> Which {
    match profile {
        0 => Which::Start,
        k if k + 1 == drawing.profiles.len() && !drawing.apex => Which::End,
        _ => Which::Inner,
    }
}

/// Where the rails stand on each profile.
fn find_feet(drawing: &Drawing<'_>, options: &GenerateOptions) -> Result<Vec<Feet>, GenerateError> {
    let Drawing { rails, profiles, closed, .. } = drawing;
    let mut found = Vec::with_capacity(profiles.len() + 1);
    for (k, curve) in profiles.iter().enumerate() {
        let side = which(drawing, k);
        let other = match side {
            Which::Start if !drawing.apex => profiles.last(),
            Which::End => profiles.first(),
            _ => None,
        };
        let at: Vec<DVec3> = match side {
            Which::Start => rails.iter().map(Curve::start).collect(),
            Which::End => rails.iter().map(Curve::end).collect(),
            Which::Inner => rails.iter().map(|rail| super::places::nearest(rail, curve).1).collect(),
        };
        found.push(Feet::find(rails, &at, curve, other.copied(), side, options)?);
    }
    if let ([_, _], true, [start, .., end]) = (*rails, closed, profiles.as_slice())
        && opposed(rails, start, end)
    {
        return Err(GenerateError::CurveIsReversed { which: Which::End.name(), curve: end.name().to_owned() });
    }
    Ok(found)
}

/// The section at which each profile stands: at the mean share of the rails' lengths, the first one first and the last
/// one last. `crossings` are those of each rail as arc lengths, from its start to its end.
fn sections_of(crossings: &[Vec<f64>], sections: usize) -> Result<Vec<usize>, GenerateError> {
    let profiles = crossings[0].len();
    if sections < 2 * profiles {
        return Err(GenerateError::TooFewSections { found: sections, needed: 2 * profiles });
    }
    let last = sections - 1;
    let mut held = vec![0];
    for k in 1..profiles - 1 {
        let share = |at: &Vec<f64>| (at[k] - at[0]) / (at[profiles - 1] - at[0]);
        let mean = crossings.iter().map(share).sum::<f64>() / crossings.len() as f64;
        // Behind the one before, and with room for those to come.
        let section = (mean * last as f64).round() as usize;
        held.push(section.clamp(held[k - 1] + 1, last - (profiles - 1 - k)));
    }
    held.push(last);
    Ok(held)
}

/// Points of a rail, one a section: at equal arc length between its ends, or, past profiles between them, at a speed that
/// does not jump there. Both ends exactly.
fn sample(rail: &Curve, crossings: &[f64], held: &[usize]) -> Vec<DVec3> {
    let arc = ArcLength::of(rail);
    let last = held[held.len() - 1];
    if held.len() == 2 {
        return (0..=last).map(|i| arc.point_at_fraction(i as f64 / last as f64)).collect();
    }
    let pace = Pace::path(held.iter().map(|section| *section as f64).collect(), crossings.to_vec());
    let mut span = 0;
    let mut points: Vec<DVec3> = (0..=last)
        .map(|i| {
            while i > held[span + 1] {
                span += 1;
            }
            arc.point_at(pace.at(span, (i - held[span]) as f64 / (held[span + 1] - held[span]) as f64))
        })
        .collect();
    points[last] = rail.end();
    points
}

fn edges<'a>(
    drawing: &Drawing<'a>,
    feet: &[Feet],
    sampled: &[Vec<DVec3>],
    warnings: &mut Vec<String>,
) -> Result<[Option<Edge<'a>>; 2], GenerateError> {
    let last = drawing.profiles.len() - 1;
    let mut edge = |end: usize, profile: usize, side| -> Result<Option<Edge<'a>>, GenerateError> {
        let Some(neighbour) = drawing.neighbours[end] else { return Ok(None) };
        Edge::new(neighbour, drawing.profiles[profile], side, &feet[profile], (Across::Rail, sampled), warnings)
            .map(Some)
    };
    Ok([edge(0, 0, Which::Start)?, if drawing.apex { None } else { edge(1, last, Which::End)? }])
}

/// Gives a generator the end tangents of its edges, by the tangents' cardinal functions.
fn steer(generator: &mut [DVec3], functions: &OpenCardinals, wanted: [Option<DVec3>; 2]) {
    if wanted == [None, None] {
        return;
    }
    let slopes = end_slopes(generator);
    for ((wanted, slope), function) in wanted.into_iter().zip(slopes).zip(functions.tangents()) {
        if let Some(wanted) = wanted {
            for (point, weight) in generator.iter_mut().zip(function) {
                *point += (wanted - slope) * *weight;
            }
        }
    }
}

/// Share of the size of all curves above which a gap is worth a warning. Our own choice: on a vest
/// 60 cm high it is 1.4 cm, where the rail visibly leaves the shape that was drawn.
const LARGE_GAP: f64 = 0.02;

/// What to say of a gap that is large for a shape of this size.
pub(super) fn gap_warning(size: f64, gap: f64, snap: f64) -> Option<String> {
    (gap > LARGE_GAP * size).then(|| {
        format!(
            "A rail was bent by {gap:.4} m to reach its curve, within the snap of {snap} m but more than 2 % of the \
             shape's size of {size:.4} m: draw it up to the curve, or lower the snap."
        )
    })
}

/// Diagonal of the box around curves, metres.
fn size<'a>(curves: impl Iterator<Item = &'a Curve>) -> f64 {
    let bounds = curves.map(Curve::bounds).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
    bounds.map_or(0.0, |(low, high)| (high - low).length())
}

/// Whether two closed curves joined by two rails run opposite ways, which the order of two feet cannot tell.
fn opposed(rails: &[Curve], start: &Curve, end: &Curve) -> bool {
    let direction = |at_end: bool| {
        let along = |rail: &Curve| {
            let arc = ArcLength::of(rail);
            arc.tangent_at(if at_end { arc.length() } else { 0.0 })
        };
        rails.iter().map(along).sum::<DVec3>().normalize_or_zero()
    };
    let (bottom, top) = (start.area_vector().normalize_or_zero(), end.area_vector().normalize_or_zero());
    let (sink, rise) = (bottom.dot(direction(false)), top.dot(direction(true)));
    // Rings in one plane, like those of an eye socket, are compared with each other instead.
    if sink.abs() > 0.2 && rise.abs() > 0.2 { sink * rise < 0.0 } else { bottom.dot(top) < 0.0 }
}
