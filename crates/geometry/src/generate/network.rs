//! A patch over a network of border curves.

use super::neighbour::Neighbour;
use super::sweep::{Drawing, sweep};
use super::{GenerateError, GenerateOptions, Generated};
use crate::curve::{Curve, closest};

/// A patch that fills three or four open border curves (paper 5.2.4), with any number of rails across.
///
/// The borders may come in any order and direction. The first one is where generators start: with four borders they run
/// to the opposite one, with three to the corner opposite. The borders at its ends are the outermost rails; `rails` run
/// between them, also in any order and direction, and shape the patch inside. All curves are reproduced. Sections run
/// along the first border, from its start to its end.
///
/// `neighbours` are the surfaces beyond the borders, in the order of `borders` (fewer mean none): the patch continues
/// each, at the corners as far as the borders themselves lie in the tangent planes. Corners apart by no more than the
/// snap are joined.
///
/// # Errors
/// [`GenerateError`] for other numbers of borders, a border that is closed or does not reach the next one within the
/// snap, and as [`sheet`](super::sheet()).
pub fn network(
    borders: &[Curve],
    rails: &[Curve],
    neighbours: &[Option<Neighbour<'_>>],
    options: &GenerateOptions,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Generated, GenerateError> {
    if !(3..=4).contains(&borders.len()) {
        return Err(GenerateError::BorderCount { found: borders.len() });
    }
    if let Some((rail, curve)) = borders.iter().chain(rails).enumerate().find(|(_, curve)| curve.is_closed()) {
        return Err(GenerateError::RailIsClosed { rail, name: curve.name().to_owned() });
    }
    super::check_size(borders.iter().chain(rails))?;
    let (chain, order) = loop_of(borders, options.snap)?;
    let neighbour = |place: usize| neighbours.get(order[place]).copied().flatten().map(|beyond| (beyond, order[place]));
    // A curve that is run backwards takes its neighbour's directions with it.
    let flipped: Vec<bool> = chain.iter().map(|border| border.1).collect();
    let apex = chain.len() == 3;
    let last = chain.len() - 1;
    let curves: Vec<&Curve> = chain.iter().map(|border| &border.0).collect();

    let (first, right, left) = (curves[0], curves[1].clone(), curves[last].clone().reversed());
    let far = (!apex).then(|| curves[2].clone().reversed());
    let mut inner: Vec<(f64, Curve)> = Vec::with_capacity(rails.len());
    for rail in rails {
        let (at_start, at_end) = (closest(first, rail.start()), closest(first, rail.end()));
        let turned = at_end.distance < at_start.distance;
        let rail = if turned { rail.clone().reversed() } else { rail.clone() };
        inner.push((if turned { at_end.arc_length } else { at_start.arc_length }, rail));
    }
    inner.sort_by(|a, b| a.0.total_cmp(&b.0));
    let across: Vec<Curve> = [left].into_iter().chain(inner.into_iter().map(|(_, rail)| rail)).chain([right]).collect();

    // Directions one a point are read along the curve as it runs here.
    let run_back = |place: usize, reversed: bool| -> Option<Vec<glam::DVec3>> {
        match neighbour(place) {
            Some((Neighbour::Directions(directions), _)) if flipped[place] != reversed => {
                Some(directions.iter().rev().copied().collect())
            }
            _ => None,
        }
    };
    let turned = [run_back(0, false), run_back(1, false), run_back(2, true), run_back(last, true)];
    let beyond = |place: usize, turned: &'_ Option<Vec<glam::DVec3>>| match (neighbour(place), turned) {
        (Some(_), Some(_)) | (None, _) => None,
        (Some((given, _)), None) => Some(given),
    };
    let pick = |place: usize, slot: usize| {
        turned[slot].as_ref().map(|directions| Neighbour::Directions(directions)).or(beyond(place, &turned[slot]))
    };
    let drawing = Drawing {
        rails: &across,
        profiles: [Some(first), far.as_ref()].into_iter().flatten().collect(),
        closed: false,
        apex,
        neighbours: [pick(0, 0), if apex { None } else { pick(2, 2) }],
        sides: [pick(last, 3), pick(1, 1)],
    };
    sweep(&drawing, options, progress)
}

/// The borders one behind the other around the loop, beginning with the first as it is drawn, each with whether it was
/// turned; and the index of each among those given.
fn loop_of(borders: &[Curve], snap: f64) -> Result<(Vec<(Curve, bool)>, Vec<usize>), GenerateError> {
    let mut chain = vec![(borders[0].clone(), false)];
    let mut order = vec![0];
    while chain.len() < borders.len() {
        let end = chain[chain.len() - 1].0.end();
        let mut best = (f64::INFINITY, 0, false);
        for (k, border) in borders.iter().enumerate().filter(|(k, _)| !order.contains(k)) {
            for (distance, turned) in [(border.start().distance(end), false), (border.end().distance(end), true)] {
                if distance < best.0 {
                    best = (distance, k, turned);
                }
            }
        }
        let (distance, k, turned) = best;
        if distance.is_nan() || distance > snap {
            return Err(apart(borders, order[order.len() - 1], distance, snap));
        }
        let border = borders[k].clone();
        chain.push((if turned { border.reversed() } else { border }, turned));
        order.push(k);
    }
    let distance = chain[chain.len() - 1].0.end().distance(chain[0].0.start());
    if distance.is_nan() || distance > snap {
        return Err(apart(borders, order[order.len() - 1], distance, snap));
    }
    Ok((chain, order))
}

fn apart(borders: &[Curve], border: usize, distance: f64, snap: f64) -> GenerateError {
    GenerateError::BordersApart { border, name: borders[border].name().to_owned(), distance, snap }
}

/// Whether open curves close a loop of a patch.
pub(super) fn is_loop(curves: &[Curve], snap: f64) -> bool {
    (3..=4).contains(&curves.len()) && curves.iter().all(|curve| !curve.is_closed()) && loop_of(curves, snap).is_ok()
}
