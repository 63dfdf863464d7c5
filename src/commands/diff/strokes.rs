//! How drawn strokes differ.

use std::collections::BTreeMap;

use glam::DVec3;
use maquette_geometry::curve::{Curve, closest};
use maquette_graph::Stroke;
use serde::Serialize;

/// One difference between two lists of strokes.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "what", rename_all = "kebab-case")]
pub(super) enum StrokeDifference {
    Removed {
        stroke: String,
        points: usize,
    },
    Added {
        stroke: String,
        points: usize,
    },
    Renamed {
        from: String,
        to: String,
    },
    /// Points of the same stroke lie elsewhere; `largest` is in metres.
    Moved {
        stroke: String,
        points: usize,
        of: usize,
        largest: f64,
    },
    /// Points were added or removed; `largest` is the largest distance between the two polylines in metres, where both
    /// are any.
    Redrawn {
        stroke: String,
        from: usize,
        to: usize,
        largest: Option<f64>,
    },
    Closed {
        stroke: String,
        closed: bool,
    },
    Pressure {
        stroke: String,
        points: usize,
    },
    /// The same strokes in another order, which nodes may depend on.
    Reordered,
}

/// What changed from one list to the other. Strokes are paired by name, those of one name in their order; of the rest,
/// equal ones are taken to be renamed.
pub(super) fn compare(from: &[Stroke], to: &[Stroke]) -> Vec<StrokeDifference> {
    let pairs = pairs(from, to);
    let mut found = Vec::new();
    for (index, stroke) in from.iter().enumerate() {
        if !pairs.iter().any(|(a, _)| *a == index) {
            found.push(StrokeDifference::Removed { stroke: shown(stroke, index), points: stroke.points.len() });
        }
    }
    for (index, stroke) in to.iter().enumerate() {
        match pairs.iter().find(|(_, b)| *b == index) {
            Some((a, _)) => found.extend(compare_one(&from[*a], stroke, shown(stroke, index))),
            None => found.push(StrokeDifference::Added { stroke: shown(stroke, index), points: stroke.points.len() }),
        }
    }
    let mut sorted = pairs.clone();
    sorted.sort_by_key(|(_, b)| *b);
    if !sorted.is_sorted_by_key(|(a, _)| *a) {
        found.push(StrokeDifference::Reordered);
    }
    found
}

fn shown(stroke: &Stroke, index: usize) -> String {
    if stroke.name.is_empty() { format!("number {}", index + 1) } else { format!("\"{}\"", stroke.name) }
}

fn pairs(from: &[Stroke], to: &[Stroke]) -> Vec<(usize, usize)> {
    let mut by_name: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (index, stroke) in to.iter().enumerate().rev() {
        by_name.entry(&stroke.name).or_default().push(index);
    }
    let mut pairs: Vec<(usize, usize)> = Vec::new();
    let mut left = Vec::new();
    for (index, stroke) in from.iter().enumerate() {
        match by_name.get_mut(stroke.name.as_str()).and_then(Vec::pop) {
            Some(other) => pairs.push((index, other)),
            None => left.push(index),
        }
    }
    let mut free: Vec<usize> = by_name.into_values().flatten().collect();
    free.sort_unstable();
    for index in left {
        if let Some(at) = free.iter().position(|other| to[*other].points == from[index].points) {
            pairs.push((index, free.remove(at)));
        }
    }
    pairs
}

fn compare_one(from: &Stroke, to: &Stroke, stroke: String) -> Vec<StrokeDifference> {
    let mut found = Vec::new();
    if from.name != to.name {
        found.push(StrokeDifference::Renamed { from: from.name.clone(), to: to.name.clone() });
    }
    if from.closed != to.closed {
        found.push(StrokeDifference::Closed { stroke: stroke.clone(), closed: to.closed });
    }
    if from.points.len() != to.points.len() {
        let (before, after) = (from.points.len(), to.points.len());
        found.push(StrokeDifference::Redrawn { stroke, from: before, to: after, largest: apart(from, to) });
        return found;
    }
    let both = || from.points.iter().zip(&to.points);
    // Bits, not numbers: what differs in the sign of zero gives another hash.
    let moved = both().filter(|(a, b)| (a.x.to_bits(), a.y.to_bits()) != (b.x.to_bits(), b.y.to_bits()));
    let distances: Vec<f64> = moved.map(|(a, b)| (a.x - b.x).hypot(a.y - b.y)).collect();
    if !distances.is_empty() {
        let largest = distances.iter().copied().fold(0.0, f64::max);
        let (points, of) = (distances.len(), to.points.len());
        found.push(StrokeDifference::Moved { stroke: stroke.clone(), points, of, largest });
    }
    let pressed = both().filter(|(a, b)| a.pressure.map(f64::to_bits) != b.pressure.map(f64::to_bits)).count();
    if pressed > 0 {
        found.push(StrokeDifference::Pressure { stroke, points: pressed });
    }
    found
}

/// Largest distance of a point of one polyline from the other, both ways; exact for the points.
fn apart(from: &Stroke, to: &Stroke) -> Option<f64> {
    let curve = |stroke: &Stroke| {
        let points = stroke.points.iter().map(|p| DVec3::new(p.x, p.y, 0.0)).collect();
        Curve::new("stroke", points, stroke.closed).ok()
    };
    let (from, to) = (curve(from)?, curve(to)?);
    let largest =
        |points: &Curve, other: &Curve| points.points().iter().map(|p| closest(other, *p).distance).fold(0.0, f64::max);
    Some(largest(&from, &to).max(largest(&to, &from)))
}

#[cfg(test)]
mod tests {
    use maquette_graph::StrokePoint;

    use super::*;

    fn stroke(name: &str, points: &[(f64, f64)]) -> Stroke {
        let points = points.iter().map(|(x, y)| StrokePoint { x: *x, y: *y, pressure: None }).collect();
        Stroke { name: name.to_owned(), closed: false, points }
    }

    const LINE: [(f64, f64); 3] = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)];

    #[test]
    fn moved_points_are_counted_and_measured() {
        let from = [stroke("a", &LINE), stroke("b", &LINE)];
        let to = [stroke("a", &LINE), stroke("b", &[(0.0, 0.0), (1.003, 0.004), (2.0, 0.001)])];
        let found = compare(&from, &to);
        let [StrokeDifference::Moved { stroke, points: 2, of: 3, largest }] = found.as_slice() else {
            panic!("{found:?}")
        };
        assert_eq!(stroke, "\"b\"");
        assert!((largest - 0.005).abs() < 1e-12);
        assert_eq!(compare(&from, &from), []);
    }

    #[test]
    fn strokes_with_more_points_are_measured_as_lines() {
        let to = [stroke("", &[(0.0, 0.0), (0.5, 0.0), (1.0, 0.25), (2.0, 0.0)])];
        let found = compare(&[stroke("", &LINE)], &to);
        let expected = StrokeDifference::Redrawn { stroke: "number 1".into(), from: 3, to: 4, largest: Some(0.25) };
        assert_eq!(found, [expected]);
        let point = compare(&[stroke("", &LINE[..1])], &to);
        assert!(matches!(point[..], [StrokeDifference::Redrawn { largest: None, .. }]), "{point:?}");
    }

    #[test]
    fn added_removed_renamed_closed_and_reordered() {
        let other = [(5.0, 0.0), (6.0, 0.0)];
        let from = [stroke("a", &LINE), stroke("b", &other), stroke("c", &LINE[..2])];
        let closed = Stroke { closed: true, ..stroke("a", &LINE) };
        let to = [stroke("d", &other), closed, stroke("e", &other)];
        let found = compare(&from, &to);
        assert_eq!(
            found,
            [
                StrokeDifference::Removed { stroke: "\"c\"".into(), points: 2 },
                StrokeDifference::Renamed { from: "b".into(), to: "d".into() },
                StrokeDifference::Closed { stroke: "\"a\"".into(), closed: true },
                StrokeDifference::Added { stroke: "\"e\"".into(), points: 2 },
                StrokeDifference::Reordered,
            ]
        );
    }

    #[test]
    fn pressure_counts() {
        let mut to = stroke("a", &LINE);
        to.points[1].pressure = Some(0.5);
        let found = compare(&[stroke("a", &LINE)], &[to]);
        assert_eq!(found, [StrokeDifference::Pressure { stroke: "\"a\"".into(), points: 1 }]);
    }
}
