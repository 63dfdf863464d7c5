//! Which strokes were drawn over one another.

use std::collections::{BTreeMap, HashMap};

use glam::{DVec3, I64Vec3};

use super::CleanError;
use super::samples::Samples;

/// Share of the shorter of two strokes that must run beside the other one.
const SHARE: f64 = 0.5;

/// A sample: its stroke and its place in it.
type Place = (usize, usize);

/// Of samples of one stroke, the nearest sample of another that runs beside it, and whether both run the same way.
type Beside = BTreeMap<usize, (usize, bool)>;

/// The strokes of each group, rising, in the order of the first of each.
pub(super) fn groups(
    samples: &[Samples],
    distance: f64,
    alike: f64,
    go_on: &dyn Fn(f64) -> Result<(), CleanError>,
) -> Result<Vec<Vec<usize>>, CleanError> {
    let beside = beside(samples, distance, alike, go_on)?;
    let mut leader: Vec<usize> = (0..samples.len()).collect();
    let empty = Beside::new();
    for ((one, other), forth) in &beside {
        let back = beside.get(&(*other, *one)).unwrap_or(&empty);
        if one < other
            && (overlaps(samples, [*one, *other], [forth, back]) || goes_on(samples, [*one, *other], [forth, back]))
        {
            let (a, b) = (root(&leader, *one), root(&leader, *other));
            leader[a.max(b)] = a.min(b);
        }
    }
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for stroke in 0..samples.len() {
        groups.entry(root(&leader, stroke)).or_default().push(stroke);
    }
    Ok(groups.into_values().collect())
}

/// The first stroke of a stroke's group.
fn root(leader: &[usize], stroke: usize) -> usize {
    let mut at = stroke;
    while leader[at] != at {
        at = leader[at];
    }
    at
}

/// Whether half of the shorter stroke runs beside the other one.
fn overlaps(samples: &[Samples], strokes: [usize; 2], beside: [&Beside; 2]) -> bool {
    let shorter = usize::from(samples[strokes[1]].length < samples[strokes[0]].length);
    beside[shorter].len() as f64 >= SHARE * samples[strokes[shorter]].points.len() as f64
}

/// Whether one stroke goes on where the other ends: the end of each lies beside the other, and the rest of it leads away
/// from there in opposite directions.
fn goes_on(samples: &[Samples], strokes: [usize; 2], beside: [&Beside; 2]) -> bool {
    let [one, other] = strokes.map(|stroke| &samples[stroke]);
    if one.closed || other.closed {
        return false;
    }
    let ends = [(one.last(), 0, true), (0, other.last(), true), (one.last(), other.last(), false), (0, 0, false)];
    ends.into_iter().any(|(of_one, of_other, same_way)| {
        let met = |beside: &Beside, end: usize| beside.get(&end).is_some_and(|(_, way)| *way == same_way);
        met(beside[0], of_one) && met(beside[1], of_other)
    })
}

/// For each pair of strokes, both ways, the samples of the first that have one of the second within the distance and the
/// angle.
fn beside(
    samples: &[Samples],
    distance: f64,
    alike: f64,
    go_on: &dyn Fn(f64) -> Result<(), CleanError>,
) -> Result<BTreeMap<(usize, usize), Beside>, CleanError> {
    let cell = |p: DVec3| (p / distance).floor().as_i64vec3();
    let mut cells: HashMap<I64Vec3, Vec<Place>> = HashMap::new();
    for (stroke, own) in samples.iter().enumerate() {
        for (k, point) in own.points.iter().enumerate() {
            cells.entry(cell(*point)).or_default().push((stroke, k));
        }
    }
    let mut found: BTreeMap<(usize, usize), Beside> = BTreeMap::new();
    for (stroke, own) in samples.iter().enumerate() {
        go_on(stroke as f64 / samples.len() as f64)?;
        for (k, (point, direction)) in own.points.iter().zip(&own.directions).enumerate() {
            if k % 64 == 63 {
                go_on(stroke as f64 / samples.len() as f64)?;
            }
            // By stroke, the nearest sample.
            let mut nearest: BTreeMap<usize, (f64, usize, bool)> = BTreeMap::new();
            for neighbour in around(cell(*point)) {
                for (other, j) in cells.get(&neighbour).into_iter().flatten().filter(|place| place.0 != stroke) {
                    let away = samples[*other].points[*j].distance(*point);
                    let along = samples[*other].directions[*j].dot(*direction);
                    let closer = nearest.get(other).is_none_or(|best| (away, *j) < (best.0, best.1));
                    if away <= distance && along.abs() >= alike && closer {
                        nearest.insert(*other, (away, *j, along >= 0.0));
                    }
                }
            }
            for (other, (_, j, same_way)) in nearest {
                found.entry((stroke, other)).or_default().insert(k, (j, same_way));
            }
        }
    }
    Ok(found)
}

/// A cell and the 26 around it.
fn around(cell: I64Vec3) -> impl Iterator<Item = I64Vec3> {
    let steps = -1..=1_i64;
    let offsets = steps.clone().flat_map(move |x| {
        let steps = steps.clone();
        steps.clone().flat_map(move |y| steps.clone().map(move |z| I64Vec3::new(x, y, z)))
    });
    offsets.map(move |offset| cell.saturating_add(offset))
}
