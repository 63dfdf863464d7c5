//! A patch over a network of border curves.

use glam::DVec3;

use super::neighbour::Neighbour;
use super::sweep::{Drawing, sweep};
use super::{GenerateError, GenerateOptions, Generated};
use crate::curve::{ArcLength, Curve, closest};

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
    let chain = loop_of(borders, options.snap)?;
    let apex = chain.len() == 3;
    let last = chain.len() - 1;
    let curves: Vec<&Curve> = chain.iter().map(|link| &link.curve).collect();

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

    // Directions one a point belong to the curve as it is given, and are read along it as it runs here.
    let given = |link: &Link| neighbours.get(link.index).copied().flatten();
    let turned = |link: &Link, reversed: bool| -> Option<Vec<DVec3>> {
        match given(link) {
            Some(Neighbour::Directions(directions)) if link.turned != reversed => {
                Some(directions.iter().rev().copied().collect())
            }
            _ => None,
        }
    };
    let far_link = &chain[last.min(2)];
    let places = [(&chain[0], false), (far_link, true), (&chain[last], true), (&chain[1], false)];
    let owned = places.map(|(link, reversed)| turned(link, reversed));
    let beyond = |k: usize| match &owned[k] {
        Some(directions) => Some(Neighbour::Directions(directions)),
        None => given(places[k].0),
    };
    let drawing = Drawing {
        rails: &across,
        profiles: [Some(first), far.as_ref()].into_iter().flatten().collect(),
        closed: false,
        apex,
        neighbours: [beyond(0), if apex { None } else { beyond(1) }],
        sides: [beyond(2), beyond(3)],
    };
    sweep(&drawing, options, progress)
}

/// A border in its loop.
#[derive(Clone, Debug)]
struct Link {
    /// The border as it runs in the loop.
    curve: Curve,
    /// Whether that is against its own direction.
    turned: bool,
    /// Its index among those given.
    index: usize,
}

/// The borders one behind the other around the loop, beginning with the first as it is drawn.
fn loop_of(borders: &[Curve], snap: f64) -> Result<Vec<Link>, GenerateError> {
    let mut chain = vec![Link { curve: borders[0].clone(), turned: false, index: 0 }];
    while chain.len() < borders.len() {
        let before = &chain[chain.len() - 1];
        let end = before.curve.end();
        let mut best = (f64::INFINITY, 0, false);
        for (k, border) in borders.iter().enumerate().filter(|(k, _)| chain.iter().all(|link| link.index != *k)) {
            for (distance, turned) in [(border.start().distance(end), false), (border.end().distance(end), true)] {
                if distance < best.0 {
                    best = (distance, k, turned);
                }
            }
        }
        let (distance, index, turned) = best;
        if distance.is_nan() || distance > snap {
            return Err(apart(borders, before.index, distance, snap));
        }
        let curve = borders[index].clone();
        chain.push(Link { curve: if turned { curve.reversed() } else { curve }, turned, index });
    }
    let before = &chain[chain.len() - 1];
    let distance = before.curve.end().distance(chain[0].curve.start());
    if distance.is_nan() || distance > snap {
        return Err(apart(borders, before.index, distance, snap));
    }
    Ok(chain)
}

fn apart(borders: &[Curve], border: usize, distance: f64, snap: f64) -> GenerateError {
    GenerateError::BordersApart { border, name: borders[border].name().to_owned(), distance, snap }
}

/// Largest share of the shortest border's length by which borders may miss one another and still be taken for a loop,
/// where nobody said that they are one: with a large snap any four curves would be.
const LARGEST: f64 = 0.05;

/// Whether open curves close a loop of a patch.
pub(super) fn is_loop(curves: &[Curve], snap: f64) -> bool {
    let shortest = curves.iter().map(|curve| ArcLength::of(curve).length()).fold(f64::INFINITY, f64::min);
    let open = curves.iter().all(|curve| !curve.is_closed());
    (3..=4).contains(&curves.len()) && open && loop_of(curves, snap.min(LARGEST * shortest)).is_ok()
}
