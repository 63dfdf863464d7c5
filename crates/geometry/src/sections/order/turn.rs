//! Sections made to run the same way and to begin at the same side.

use glam::{DVec2, DVec3};

use super::report::Placed;
use super::station::Station;
use super::{OrderError, OrderOptions, SectionStart};
use crate::curve::{Curve, Started, closest, start_nearest};
use crate::mesh::slice::{Plane, centroid, front_of, with_fronts};

/// Cosine to the way along the stack below which a normal says nothing about which side it is on.
const ALONG: f64 = 0.05;

type GoOn<'a> = dyn Fn() -> Result<(), OrderError> + 'a;

pub(super) fn turned(
    curves: &[Curve],
    stations: &[Station],
    order: &[usize],
    options: &OrderOptions,
    go_on: &GoOn<'_>,
) -> Result<(Vec<Curve>, Vec<Placed>), OrderError> {
    let ordered: Vec<&Station> = order.iter().map(|section| &stations[*section]).collect();
    let normals = normals(&ordered, options.towards);
    let planes: Vec<Plane> =
        ordered.iter().zip(&normals).filter_map(|(station, normal)| Plane::new(station.centre, *normal).ok()).collect();
    let frames = with_fronts(&planes, options.front, |_, _| Vec::new());
    let (mut sections, mut placed) = (Vec::with_capacity(order.len()), Vec::with_capacity(order.len()));
    let mut before: Option<DVec3> = None;
    for (place, (&section, frame)) in order.iter().zip(&frames).enumerate() {
        go_on()?;
        let reversed = stations[section].normal.dot(normals[place]) < 0.0;
        let curve = curves[section].clone();
        let curve = if reversed { curve.reversed() } else { curve };
        let front = |curve: &Curve| {
            let flat: Vec<DVec2> = curve.points().iter().map(|p| frame.flat(*p)).collect();
            let (segment, share) = front_of(&flat, centroid(&flat));
            let (from, to) = curve.segment(segment);
            from.lerp(to, share)
        };
        let target = match (options.start, before) {
            (SectionStart::Kept, _) => None,
            (SectionStart::Nearest, Some(arm)) => Some(closest(&curve, stations[section].centre + arm).point),
            _ => Some(front(&curve)),
        };
        let Started { curve, moved } = match target {
            Some(target) => start_nearest(&curve, target),
            None => Started { curve, moved: 0.0 },
        };
        before = Some(curve.start() - stations[section].centre);
        placed.push(Placed { section, name: curve.name().to_owned(), reversed, start_moved: moved });
        sections.push(curve);
    }
    Ok((sections, placed))
}

/// Unit normals on the side to which the stack goes.
fn normals(ordered: &[&Station], towards: DVec3) -> Vec<DVec3> {
    let count = ordered.len();
    let way = |k: usize| {
        let (from, to) = (ordered[k.saturating_sub(1)], ordered[(k + 1).min(count - 1)]);
        let way = to.centre - from.centre;
        if way.length() > 1e-9 * from.size.max(to.size) { way.normalize_or_zero() } else { DVec3::ZERO }
    };
    let ways: Vec<DVec3> = (0..count).map(way).collect();
    // 1 or -1 where the way tells the side.
    let told = |k: usize| {
        let along = ordered[k].normal.dot(ways[k]);
        (along.abs() > ALONG).then(|| along.signum())
    };
    let anchor = (0..count).find(|k| told(*k).is_some());
    let mut normals: Vec<DVec3> = ordered.iter().map(|station| station.normal).collect();
    let mut oriented = |k: usize, sign: Option<f64>, neighbour: DVec3| {
        // A section that encloses nothing has no side; the way, or the neighbour, then says where it stands.
        let own = ordered[k].normal;
        normals[k] = match sign {
            Some(sign) => own * sign,
            None if own == DVec3::ZERO && ways[k] != DVec3::ZERO => ways[k],
            None if own == DVec3::ZERO => neighbour,
            None if own.dot(neighbour) < 0.0 => -own,
            None => own,
        };
        normals[k]
    };
    let first = anchor.unwrap_or(0);
    let start = towards.normalize_or(DVec3::Y);
    let at_anchor = oriented(first, told(first), start);
    let mut neighbour = at_anchor;
    for k in first + 1..count {
        neighbour = oriented(k, told(k), neighbour);
    }
    neighbour = at_anchor;
    for k in (0..first).rev() {
        neighbour = oriented(k, told(k), neighbour);
    }
    normals
}
