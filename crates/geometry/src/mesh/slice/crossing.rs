//! Sections that cross each other inside the body.

use glam::DVec3;

use super::plane::Plane;
use super::section::Section;
use super::warning::{Concern, SliceWarning};

/// Sections share less than this of their size where they only touch.
const TOUCH: f64 = 1e-9;

/// One warning for each run of sections in which each crosses another. O(n^2) in the sections, nearly all of them parted
/// by the balls around them.
///
/// `go_on` is asked once a section; its error is returned.
pub(super) fn crossings<E>(sections: &[Section], go_on: &dyn Fn() -> Result<(), E>) -> Result<Vec<SliceWarning>, E> {
    let balls: Vec<(DVec3, f64)> = sections.iter().map(ball).collect();
    // First and last section of each run, and where two of them meet.
    let mut runs: Vec<(usize, usize, DVec3)> = Vec::new();
    for i in 0..sections.len() {
        go_on()?;
        for j in i + 1..sections.len() {
            if balls[i].0.distance(balls[j].0) > balls[i].1 + balls[j].1 {
                continue;
            }
            let Some(at) = meet(&sections[i], &sections[j]) else { continue };
            match runs.last_mut() {
                Some(run) if i <= run.1 => run.1 = run.1.max(j),
                _ => runs.push((i, j, at)),
            }
        }
    }
    let warning = |(first, last, at): (usize, usize, DVec3)| SliceWarning {
        first: sections[first].index,
        last: sections[last].index,
        at,
        what: Concern::Cross,
    };
    Ok(runs.into_iter().map(warning).collect())
}

fn ball(section: &Section) -> (DVec3, f64) {
    let points = section.curve.points();
    let centre = points.iter().sum::<DVec3>() / points.len() as f64;
    (centre, points.iter().map(|p| p.distance(centre)).fold(0.0, f64::max))
}

/// A point inside of both sections, the middle of the longest line they share.
fn meet(a: &Section, b: &Section) -> Option<DVec3> {
    let along = a.plane.normal().cross(b.plane.normal()).try_normalize()?;
    let origin = a.curve.start();
    let (of_a, of_b) = (spans(a, &b.plane, origin, along), spans(b, &a.plane, origin, along));
    let mut longest: Option<(f64, f64)> = None;
    for (from, to) in of_a.iter().flat_map(|a| of_b.iter().map(|b| (a.0.max(b.0), a.1.min(b.1)))) {
        if to - from > longest.map_or(TOUCH * a.perimeter.max(b.perimeter), |(from, to)| to - from) {
            longest = Some((from, to));
        }
    }
    let (from, to) = longest?;
    let on_line = on_both(&a.plane, &b.plane, origin);
    Some(on_line + along * (0.5 * (from + to) - (on_line - origin).dot(along)))
}

/// The stretches of the line in which both planes meet that are inside of a section, as places along the line.
fn spans(section: &Section, other: &Plane, origin: DVec3, along: DVec3) -> Vec<(f64, f64)> {
    let curve = &section.curve;
    let mut places: Vec<f64> = (0..curve.segment_count())
        .filter_map(|k| {
            let (from, to) = curve.segment(k);
            let (below, above) = (other.height(from), other.height(to));
            let share = below / (below - above);
            ((below < 0.0) != (above < 0.0)).then(|| (from.lerp(to, share) - origin).dot(along))
        })
        .collect();
    places.sort_by(f64::total_cmp);
    places.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect()
}

/// A point in both planes, near `origin`, which is in the first one.
fn on_both(a: &Plane, b: &Plane, origin: DVec3) -> DVec3 {
    let towards = b.normal() - a.normal() * a.normal().dot(b.normal());
    origin - towards * (b.height(origin) / towards.dot(b.normal()))
}
