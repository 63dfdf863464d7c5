//! Correcting strokes: pulling, drawing a part anew, going on from an end, erasing, mirroring.

use glam::{DAffine2, DVec2};
use maquette_graph::{Stroke, StrokePoint};

use super::target::{points, stroke_point};

/// Nearest place on a stroke: the piece it lies on, how far along that piece from 0 to 1, and the distance in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Nearest {
    pub(crate) piece: usize,
    pub(crate) along: f64,
    pub(crate) distance: f64,
}

fn pieces(count: usize, closed: bool) -> usize {
    if closed { count } else { count.saturating_sub(1) }
}

/// The place of a line of points that is nearest to a point; `None` for no points.
pub(crate) fn nearest(line: &[DVec2], closed: bool, point: DVec2) -> Option<Nearest> {
    let first = *line.first()?;
    let alone = Nearest { piece: 0, along: 0.0, distance: first.distance(point) };
    let places = (0..pieces(line.len(), closed)).map(|piece| {
        let (a, b) = (line[piece], line[(piece + 1) % line.len()]);
        let length = (b - a).length_squared();
        let along = if length > 0.0 { ((point - a).dot(b - a) / length).clamp(0.0, 1.0) } else { 0.0 };
        Nearest { piece, along, distance: a.lerp(b, along).distance(point) }
    });
    Some(places.fold(alone, |best, place| if place.distance < best.distance { place } else { best }))
}

/// Moves a point of a stroke by an offset, and its neighbours with it: less and less until `radius` metres along the stroke,
/// by (1 - (s/r)^2)^2. With a radius of zero the point moves alone.
pub(crate) fn pull(stroke: &Stroke, point: usize, offset: DVec2, radius: f64) -> Stroke {
    let line = points(stroke);
    let count = line.len();
    let mut along = vec![f64::INFINITY; count];
    let mut walk = |forward: bool| {
        let mut s = 0.0;
        let mut at = point;
        along[at] = 0.0;
        for _ in 1..count {
            let next = match (forward, stroke.closed) {
                (true, true) => (at + 1) % count,
                (false, true) => (at + count - 1) % count,
                (true, false) if at + 1 < count => at + 1,
                (false, false) if at > 0 => at - 1,
                _ => break,
            };
            s += line[at].distance(line[next]);
            along[next] = along[next].min(s);
            at = next;
        }
    };
    if point < count {
        walk(true);
        walk(false);
    }
    let moved = stroke.points.iter().zip(&line).zip(&along).map(|((held, place), s)| {
        let weight = if *s == 0.0 {
            1.0
        } else if *s < radius {
            (1.0 - (s / radius).powi(2)).powi(2)
        } else {
            return *held;
        };
        StrokePoint { pressure: held.pressure, ..stroke_point(*place + offset * weight) }
    });
    Stroke { points: moved.collect(), ..stroke.clone() }
}

/// What becomes of a stroke that is drawn near others.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Outcome {
    /// It is a stroke of its own.
    New,
    /// It takes the place of this stroke.
    Instead(usize, Vec<DVec2>, bool),
}

/// Decides what a drawn line means to the strokes that are there: along one it draws that part anew, from the end of an open
/// one it goes on, anywhere else it is new. `reach` is the distance in metres within which one draws "on" a stroke.
pub(crate) fn meaning(strokes: &[Stroke], drawn: &[DVec2], reach: f64) -> Outcome {
    let (Some(&first), Some(&last)) = (drawn.first(), drawn.last()) else { return Outcome::New };
    let mut best: Option<(f64, Outcome)> = None;
    for (index, stroke) in strokes.iter().enumerate() {
        let line = points(stroke);
        let (Some(begin), Some(end)) = (nearest(&line, stroke.closed, first), nearest(&line, stroke.closed, last))
        else {
            continue;
        };
        let made = if begin.distance <= reach && end.distance <= reach && line.len() > 1 {
            over_sketch(&line, stroke.closed, drawn, begin, end)
        } else {
            (!stroke.closed).then(|| go_on(&line, drawn, reach)).flatten()
        };
        let distance = begin.distance.min(end.distance);
        if let Some((line, closed)) = made
            && best.as_ref().is_none_or(|(least, _)| distance < *least)
        {
            best = Some((distance, Outcome::Instead(index, line, closed)));
        }
    }
    best.map_or(Outcome::New, |(_, outcome)| outcome)
}

/// Goes on from an end of an open line.
fn go_on(line: &[DVec2], drawn: &[DVec2], reach: f64) -> Option<(Vec<DVec2>, bool)> {
    let (begin, end) = (*line.first()?, *line.last()?);
    let (first, last) = (*drawn.first()?, *drawn.last()?);
    let forward = drawn.iter().copied();
    let backward = drawn.iter().rev().copied();
    let longer: Vec<DVec2> = if first.distance(end) <= reach {
        line.iter().copied().chain(forward.skip(1)).collect()
    } else if last.distance(end) <= reach {
        line.iter().copied().chain(backward.skip(1)).collect()
    } else if first.distance(begin) <= reach {
        backward.take(drawn.len() - 1).chain(line.iter().copied()).collect()
    } else if last.distance(begin) <= reach {
        forward.take(drawn.len() - 1).chain(line.iter().copied()).collect()
    } else {
        return None;
    };
    Some((longer, false))
}

/// Puts the drawn line in place of the part it was drawn along.
fn over_sketch(
    line: &[DVec2],
    closed: bool,
    drawn: &[DVec2],
    begin: Nearest,
    end: Nearest,
) -> Option<(Vec<DVec2>, bool)> {
    let place = |nearest: Nearest| nearest.piece as f64 + nearest.along;
    let count = line.len();
    let turns = pieces(count, closed) as f64;
    let (from, to) = (place(begin), place(end));
    let forward: Vec<DVec2> = drawn.to_vec();
    let backward: Vec<DVec2> = drawn.iter().rev().copied().collect();
    if !closed {
        let (drawn, from, to) = if from <= to { (forward, from, to) } else { (backward, to, from) };
        let before = line.iter().enumerate().filter(|(k, _)| (*k as f64) < from).map(|(_, p)| *p);
        let after = line.iter().enumerate().filter(|(k, _)| (*k as f64) > to).map(|(_, p)| *p);
        return Some((before.chain(blended(line, drawn, begin, end)).chain(after).collect(), false));
    }
    // Around a closed line there are two ways; the one that is nearer to what was drawn is the one that was meant.
    let way = move |from: f64, to: f64| {
        let span = (to - from).rem_euclid(turns);
        (1..count).map(move |k| (from + k as f64).floor().rem_euclid(turns)).take_while(move |k| {
            let passed = (*k - from).rem_euclid(turns);
            passed < span
        })
    };
    let distance = |from: f64, to: f64| {
        let passed: Vec<f64> =
            way(from, to).filter_map(|k| Some(nearest(drawn, false, line[k as usize])?.distance)).collect();
        passed.iter().sum::<f64>() / passed.len().max(1) as f64
    };
    let span = |from: f64, to: f64| (to - from).rem_euclid(turns);
    let there = distance(from, to) + 1e-9 * span(from, to);
    let back = distance(to, from) + 1e-9 * span(to, from);
    let (drawn, from, to) = if there <= back { (forward, from, to) } else { (backward, to, from) };
    let kept: Vec<DVec2> = way(to, from).map(|k| line[k as usize]).collect();
    Some((blended(line, drawn, begin, end).into_iter().chain(kept).collect(), true))
}

/// The drawn line with its ends led into the line it meets, over a quarter of its points at either end.
fn blended(line: &[DVec2], mut drawn: Vec<DVec2>, begin: Nearest, end: Nearest) -> Vec<DVec2> {
    let at = |nearest: Nearest| line[nearest.piece].lerp(line[(nearest.piece + 1) % line.len()], nearest.along);
    let (a, b) = (at(begin), at(end));
    let count = drawn.len();
    let (Some(&first), Some(&last)) = (drawn.first(), drawn.last()) else { return drawn };
    let meets = |end: DVec2| if a.distance(end) <= b.distance(end) { a } else { b };
    let (lead_in, lead_out) = (meets(first) - first, meets(last) - last);
    let reach = (count / 4).max(1);
    for (k, point) in drawn.iter_mut().enumerate() {
        let weight = |k: usize| if k < reach { 1.0 - k as f64 / reach as f64 } else { 0.0 };
        *point += lead_in * weight(k) + lead_out * weight(count - 1 - k);
    }
    drawn
}

/// Takes away what lies within `reach` metres of a path; a stroke may fall into several. Pieces of a single point go.
pub(crate) fn erase(strokes: &[Stroke], path: &[DVec2], reach: f64) -> Vec<Stroke> {
    let hit = |point: &StrokePoint| {
        nearest(path, false, DVec2::new(point.x, point.y)).is_some_and(|nearest| nearest.distance <= reach)
    };
    let mut kept = Vec::new();
    for stroke in strokes {
        let hits: Vec<bool> = stroke.points.iter().map(hit).collect();
        let Some(first) = hits.iter().position(|hit| *hit) else {
            kept.push(stroke.clone());
            continue;
        };
        // A closed stroke is opened where it is hit first.
        let begin = if stroke.closed { first } else { 0 };
        let count = stroke.points.len();
        let order: Vec<usize> = (0..count).map(|k| (begin + k) % count).collect();
        let runs = order.split(|k| hits[*k]).filter(|run| run.len() > 1);
        for (number, run) in runs.enumerate() {
            let name = if number == 0 { stroke.name.clone() } else { format!("{} {}", stroke.name, number + 1) };
            let points = run.iter().map(|k| stroke.points[*k]).collect();
            kept.push(Stroke { name, closed: false, points });
        }
    }
    kept
}

/// A stroke moved, turned or scaled within its plane.
pub(crate) fn transformed(stroke: &Stroke, map: DAffine2) -> Stroke {
    let moved = |p: &StrokePoint| StrokePoint {
        pressure: p.pressure,
        ..stroke_point(map.transform_point2(DVec2::new(p.x, p.y)))
    };
    Stroke { points: stroke.points.iter().map(moved).collect(), ..stroke.clone() }
}

/// Points of a new line with the pressure of the nearest of the points it was made from; none where these have none.
pub(crate) fn with_pressure(line: Vec<DVec2>, from: &[StrokePoint]) -> Vec<StrokePoint> {
    let pressed: Vec<(DVec2, f64)> = from.iter().filter_map(|p| Some((DVec2::new(p.x, p.y), p.pressure?))).collect();
    let pressure = |at: DVec2| {
        let nearer =
            |a: &&(DVec2, f64), b: &&(DVec2, f64)| a.0.distance_squared(at).total_cmp(&b.0.distance_squared(at));
        pressed.iter().min_by(nearer).map(|(_, pressure)| *pressure)
    };
    line.into_iter().map(|point| StrokePoint { pressure: pressure(point), ..stroke_point(point) }).collect()
}

/// Cuts strokes where a path crosses them. An open stroke falls into pieces, a closed one is opened; nothing goes.
pub(crate) fn cut(strokes: &[Stroke], path: &[DVec2]) -> Vec<Stroke> {
    strokes.iter().flat_map(|stroke| cut_one(stroke, path)).collect()
}

fn cut_one(stroke: &Stroke, path: &[DVec2]) -> Vec<Stroke> {
    let line = points(stroke);
    let mut places: Vec<f64> = Vec::new();
    for piece in 0..pieces(line.len(), stroke.closed) {
        let (a, b) = (line[piece], line[(piece + 1) % line.len()]);
        for across in path.windows(2) {
            if let Some(along) = crossing([a, b], [across[0], across[1]]) {
                places.push(piece as f64 + along);
            }
        }
    }
    places.sort_by(f64::total_cmp);
    places.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    // At its very ends there is nothing to cut off.
    let last = line.len().saturating_sub(1) as f64;
    places.retain(|place| stroke.closed || (*place > 1e-9 && *place < last - 1e-9));
    if places.is_empty() {
        return vec![stroke.clone()];
    }
    let at = |place: f64| {
        let piece = place.floor();
        let index = piece as usize % line.len();
        line[index].lerp(line[(index + 1) % line.len()], place - piece)
    };
    let spans: Vec<[f64; 2]> = if stroke.closed {
        let turn = line.len() as f64;
        let next = places.iter().skip(1).copied().chain([places[0] + turn]);
        places.iter().copied().zip(next).map(|(from, to)| [from, to]).collect()
    } else {
        let ends = [0.0].into_iter().chain(places.iter().copied()).chain([last]).collect::<Vec<_>>();
        ends.windows(2).map(|pair| [pair[0], pair[1]]).collect()
    };
    let parts = spans.into_iter().enumerate().map(|(number, [from, to])| {
        let within =
            (from.floor() as usize + 1..).take_while(|k| (*k as f64) < to - 1e-9).map(|k| line[k % line.len()]);
        let part: Vec<DVec2> = [at(from)].into_iter().chain(within).chain([at(to)]).collect();
        let name = if number == 0 { stroke.name.clone() } else { format!("{} {}", stroke.name, number + 1) };
        Stroke { name, closed: false, points: with_pressure(part, &stroke.points) }
    });
    parts.collect()
}

/// How far along the first segment, from 0 to 1, it crosses the second; `None` where it does not.
fn crossing([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> Option<f64> {
    let (along, across) = (b - a, d - c);
    let volume = along.perp_dot(across);
    if volume == 0.0 {
        return None;
    }
    let (t, u) = ((c - a).perp_dot(across) / volume, (c - a).perp_dot(along) / volume);
    ((0.0..1.0).contains(&t) && (0.0..=1.0).contains(&u)).then_some(t)
}

/// Two open strokes as one, joined at the ends that are nearest to each other; `None` where one is closed or empty. Ends that
/// are at one place count once.
pub(crate) fn joined(first: &Stroke, second: &Stroke) -> Option<Stroke> {
    if first.closed || second.closed {
        return None;
    }
    let ends = |stroke: &Stroke| {
        let line = points(stroke);
        Some([*line.first()?, *line.last()?])
    };
    let ([a, b], [c, d]) = (ends(first)?, ends(second)?);
    let (first, second) = (first.clone(), second.clone());
    let ways = [
        (b.distance(c), false, false),
        (b.distance(d), false, true),
        (a.distance(c), true, false),
        (a.distance(d), true, true),
    ];
    let (gap, turn_first, turn_second) = ways.into_iter().min_by(|x, y| x.0.total_cmp(&y.0))?;
    let first = if turn_first { reversed(&first) } else { first };
    let second = if turn_second { reversed(&second) } else { second };
    let skipped = usize::from(gap < 1e-5);
    let points = first.points.iter().chain(second.points.iter().skip(skipped)).copied().collect();
    Some(Stroke { points, ..first })
}

/// The mirror image of a stroke across the middle of the body.
pub(crate) fn mirrored(stroke: &Stroke) -> Stroke {
    let name = if stroke.name.is_empty() { String::new() } else { format!("{} mirrored", stroke.name) };
    let points = stroke.points.iter().map(|p| StrokePoint { x: if p.x == 0.0 { 0.0 } else { -p.x }, ..*p });
    Stroke { name, closed: stroke.closed, points: points.collect() }
}

/// The stroke run the other way.
pub(crate) fn reversed(stroke: &Stroke) -> Stroke {
    Stroke { points: stroke.points.iter().rev().copied().collect(), ..stroke.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stroke(points: &[[f64; 2]], closed: bool) -> Stroke {
        let points = points.iter().map(|[x, y]| StrokePoint { x: *x, y: *y, pressure: None }).collect();
        Stroke { name: "s".to_owned(), closed, points }
    }

    fn row(n: usize) -> Stroke {
        stroke(&(0..n).map(|k| [k as f64, 0.0]).collect::<Vec<_>>(), false)
    }

    fn heights(stroke: &Stroke) -> Vec<f64> {
        stroke.points.iter().map(|p| p.y).collect()
    }

    #[test]
    fn pulling_fades_out_along_the_stroke() {
        let pulled = pull(&row(7), 3, DVec2::new(0.0, 1.0), 2.0);
        assert_eq!(heights(&pulled), [0.0, 0.0, 0.5625, 1.0, 0.5625, 0.0, 0.0]);
        assert_eq!(heights(&pull(&row(3), 0, DVec2::Y, 0.0)), [1.0, 0.0, 0.0]);
        // Around the joint of a closed stroke.
        let square = stroke(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], true);
        let pulled = pull(&square, 0, DVec2::new(-1.0, 0.0), 2.0);
        let xs: Vec<f64> = pulled.points.iter().map(|p| p.x).collect();
        assert_eq!(xs, [-1.0, 0.4375, 1.0, -0.5625]);
    }

    #[test]
    fn drawing_along_a_stroke_draws_that_part_anew() {
        let drawn: Vec<DVec2> = (4..=12).map(|k| DVec2::new(k as f64 * 0.5, 0.3)).collect();
        let Outcome::Instead(0, line, false) = meaning(&[row(10)], &drawn, 0.4) else { panic!("not redrawn") };
        assert_eq!(line.first(), Some(&DVec2::ZERO));
        assert_eq!(line.last(), Some(&DVec2::new(9.0, 0.0)));
        // In the middle it is what was drawn, at its ends what was there.
        assert!(line.contains(&DVec2::new(4.0, 0.3)));
        assert!(line.iter().all(|p| !(2.1..5.9).contains(&p.x) || p.y > 0.0));
        assert!(line.iter().any(|p| p.distance(DVec2::new(2.0, 0.0)) < 1e-12));
        // The other way round it means the same.
        let backward: Vec<DVec2> = drawn.iter().rev().copied().collect();
        let Outcome::Instead(0, same, false) = meaning(&[row(10)], &backward, 0.4) else { panic!("not redrawn") };
        assert_eq!(line, same);
    }

    #[test]
    fn around_a_closed_stroke_the_nearer_way_is_drawn_anew() {
        let circle: Vec<[f64; 2]> = (0..24).map(|k| (k as f64 * 15.0).to_radians().sin_cos().into()).collect();
        let circle = stroke(&circle, true);
        // Over the top, from left to right, a little higher.
        let drawn: Vec<DVec2> =
            (-6..=6).map(|k| (k as f64 * 10.0).to_radians().sin_cos()).map(|(x, y)| DVec2::new(x, 1.1 * y)).collect();
        let Outcome::Instead(0, line, true) = meaning(&[circle], &drawn, 0.12) else { panic!("not redrawn") };
        assert!(line.iter().any(|p| p.y > 1.05), "{line:?}");
        assert!(line.iter().any(|p| p.y < -0.95), "the lower half is gone: {line:?}");
        assert!(line.iter().all(|p| (0.9..1.15).contains(&p.length())), "{line:?}");
    }

    #[test]
    fn a_line_from_an_end_goes_on_and_one_apart_is_new() {
        let drawn = [DVec2::new(2.1, 0.0), DVec2::new(3.0, 1.0), DVec2::new(4.0, 2.0)];
        let Outcome::Instead(0, line, false) = meaning(&[row(3)], &drawn, 0.3) else { panic!("not longer") };
        assert_eq!((line.len(), line[0], line[4]), (5, DVec2::ZERO, DVec2::new(4.0, 2.0)));
        let apart = [DVec2::new(0.0, 5.0), DVec2::new(1.0, 5.0)];
        assert_eq!(meaning(&[row(3)], &apart, 0.3), Outcome::New);
    }

    #[test]
    fn erasing_cuts_and_opens() {
        let cut = erase(&[row(7)], &[DVec2::new(3.0, -1.0), DVec2::new(3.0, 1.0)], 0.1);
        let xs: Vec<Vec<f64>> = cut.iter().map(|s| s.points.iter().map(|p| p.x).collect()).collect();
        assert_eq!(xs, [[0.0, 1.0, 2.0], [4.0, 5.0, 6.0]]);
        let square = stroke(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], true);
        let opened = erase(&[square], &[DVec2::new(1.0, 0.0)], 0.1);
        assert_eq!(opened.len(), 1);
        assert!(!opened[0].closed && opened[0].points.len() == 3);
        assert_eq!(erase(&[row(3)], &[DVec2::new(9.0, 9.0)], 0.1), [row(3)]);
    }

    #[test]
    fn a_path_across_cuts_and_loses_nothing() {
        let across = [DVec2::new(2.5, -1.0), DVec2::new(2.5, 1.0)];
        let parts = cut(&[row(5)], &across);
        let xs: Vec<Vec<f64>> = parts.iter().map(|s| s.points.iter().map(|p| p.x).collect()).collect();
        assert_eq!(xs, [vec![0.0, 1.0, 2.0, 2.5], vec![2.5, 3.0, 4.0]]);
        assert_eq!(parts[1].name, "s 2");
        assert_eq!(cut(&[row(2)], &across), [row(2)]);
        let square = stroke(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], true);
        let opened = cut(std::slice::from_ref(&square), &[DVec2::new(0.5, -1.0), DVec2::new(0.5, 0.5)]);
        let corners: Vec<[f64; 2]> = opened[0].points.iter().map(|p| [p.x, p.y]).collect();
        assert!(opened.len() == 1 && !opened[0].closed);
        assert_eq!(corners, [[0.5, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0], [0.5, 0.0]]);
        let halves = cut(&[square], &[DVec2::new(0.5, -1.0), DVec2::new(0.5, 2.0)]);
        assert_eq!(halves.iter().map(|half| half.points.len()).collect::<Vec<_>>(), [4, 4]);
    }

    #[test]
    fn strokes_are_joined_at_their_nearest_ends() {
        let other = stroke(&[[5.0, 1.0], [2.0, 0.0]], false);
        let one = joined(&row(3), &other).unwrap();
        assert_eq!(one.points.iter().map(|p| p.x).collect::<Vec<_>>(), [0.0, 1.0, 2.0, 5.0]);
        let before = stroke(&[[-3.0, 0.0], [-1.0, 0.0]], false);
        let one = joined(&row(2), &before).unwrap();
        assert_eq!(one.points.iter().map(|p| p.x).collect::<Vec<_>>(), [1.0, 0.0, -1.0, -3.0]);
        assert_eq!(joined(&row(2), &stroke(&[[0.0, 0.0]], true)), None);
    }

    #[test]
    fn pressure_stays_with_its_place() {
        let mut pressed = row(3);
        pressed.points[2].pressure = Some(0.75);
        let line = with_pressure(vec![DVec2::ZERO, DVec2::new(1.9, 0.0)], &pressed.points);
        assert_eq!(line.iter().map(|p| p.pressure).collect::<Vec<_>>(), [Some(0.75), Some(0.75)]);
        assert_eq!(with_pressure(vec![DVec2::ZERO], &row(3).points)[0].pressure, None);
        let moved = transformed(&pressed, DAffine2::from_translation(DVec2::Y));
        assert_eq!((moved.points[2].pressure, moved.points[2].y), (Some(0.75), 1.0));
    }

    #[test]
    fn mirroring_and_reversing_are_their_own_contraries() {
        let drawn = stroke(&[[0.0, 1.0], [0.5, 2.0]], false);
        assert_eq!(heights(&reversed(&drawn)), [2.0, 1.0]);
        assert_eq!(mirrored(&mirrored(&drawn)).points, drawn.points);
        assert_eq!(mirrored(&drawn).points[1].x, -0.5);
    }
}
