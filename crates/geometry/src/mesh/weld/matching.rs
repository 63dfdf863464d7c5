//! Which vertices of open edges become one.

use std::collections::BTreeMap;

use glam::DVec3;

use super::boundary::Boundary;
use super::report::{WeldError, WeldWarning};
use crate::mesh::Mesh;

/// Loops this many times the tolerance apart, and this share of their own size, are told to be near each other.
const NEAR: f64 = 20.0;
const NEAR_SIZE: f64 = 0.1;

type GoOn<'a> = dyn Fn() -> Result<(), WeldError> + 'a;

/// Vertices that become one.
pub(super) struct Matched {
    /// Of each vertex the lowest one that it becomes.
    pub(super) root: Vec<u32>,
    /// Pairs that become one, by the loops they are of (the lower first).
    pub(super) pairs: BTreeMap<[usize; 2], Vec<[u32; 2]>>,
    pub(super) warnings: Vec<WeldWarning>,
}

/// How two loops with as many vertices lie on each other.
struct Fit {
    loops: [usize; 2],
    /// Vertex `k` of the first goes to `(shift - k)` of the second where they run against each other, else to
    /// `(shift + k)`.
    shift: usize,
    against: bool,
    gap: f64,
}

pub(super) fn matched(
    joined: &Mesh,
    boundary: &Boundary,
    tolerance: f64,
    go_on: &GoOn<'_>,
) -> Result<Matched, WeldError> {
    let mut found =
        Matched { root: (0..joined.positions().len() as u32).collect(), pairs: BTreeMap::new(), warnings: Vec::new() };
    let whole = whole_loops(joined, boundary, tolerance, &mut found, go_on)?;
    let rest: Vec<usize> = (0..boundary.loops.len()).filter(|k| !whole[*k]).collect();
    single_vertices(joined, boundary, &rest, tolerance, &mut found, go_on)?;
    Ok(found)
}

/// Matches loops with as many vertices; says which ones are matched, or lie on one that faces the other way.
fn whole_loops(
    joined: &Mesh,
    boundary: &Boundary,
    tolerance: f64,
    found: &mut Matched,
    go_on: &GoOn<'_>,
) -> Result<Vec<bool>, WeldError> {
    let mean = |rim: &[u32]| rim.iter().map(|v| joined.positions()[*v as usize]).sum::<DVec3>() / rim.len() as f64;
    let size = |rim: &[u32]| {
        let at = rim.iter().map(|v| joined.positions()[*v as usize]);
        let (low, high) = at.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
        (high - low).length()
    };
    let means: Vec<DVec3> = boundary.loops.iter().map(|one| mean(&one.vertices)).collect();
    let mut fits = Vec::new();
    for a in 0..boundary.loops.len() {
        for b in a + 1..boundary.loops.len() {
            let (one, other) = (&boundary.loops[a], &boundary.loops[b]);
            if one.part == other.part || one.vertices.len() != other.vertices.len() {
                continue;
            }
            let within = (NEAR * tolerance).min(NEAR_SIZE * size(&one.vertices)).max(tolerance);
            // The means of loops that fit are no farther apart than the farthest of their vertices.
            if means[a].distance(means[b]) <= within {
                go_on()?;
                fits.extend(fit(joined, [a, b], [&one.vertices, &other.vertices], within, go_on)?);
            }
        }
    }
    fits.sort_by(|a, b| a.gap.total_cmp(&b.gap).then(a.loops.cmp(&b.loops)));
    let mut taken = vec![false; boundary.loops.len()];
    for Fit { loops: [a, b], shift, against, gap } in fits {
        if taken[a] || taken[b] {
            continue;
        }
        let parts = [boundary.loops[a].part, boundary.loops[b].part];
        let at = 0.5 * (means[a] + means[b]);
        if gap > tolerance {
            found.warnings.push(WeldWarning::Apart { parts, gap, tolerance, at });
            continue;
        }
        (taken[a], taken[b]) = (true, true);
        if !against {
            found.warnings.push(WeldWarning::FacesOtherWay { parts, at });
            continue;
        }
        let (one, other) = (&boundary.loops[a].vertices, &boundary.loops[b].vertices);
        let count = one.len();
        let pairs = (0..count).map(|k| [one[k], other[(shift + count - k) % count]]);
        for [one, other] in pairs.clone() {
            let root = found.root[one as usize];
            found.root[other as usize] = root;
        }
        found.pairs.insert([a, b], pairs.collect());
    }
    Ok(taken)
}

/// The way in which two loops fit best within a distance, if there is one.
fn fit(
    joined: &Mesh,
    loops: [usize; 2],
    [one, other]: [&[u32]; 2],
    within: f64,
    go_on: &GoOn<'_>,
) -> Result<Option<Fit>, WeldError> {
    let count = one.len();
    let at = |vertex: u32| joined.positions()[vertex as usize];
    let mut best: Option<(f64, Fit)> = None;
    // Vertex 0 of the one lies on one of these of the other.
    for shift in (0..count).filter(|k| at(other[*k]).distance(at(one[0])) <= within) {
        go_on()?;
        for against in [true, false] {
            let (mut gap, mut squares) = (0.0_f64, 0.0);
            for (k, vertex) in one.iter().enumerate() {
                let partner = if against { (shift + count - k) % count } else { (shift + k) % count };
                let apart = at(*vertex).distance_squared(at(other[partner]));
                gap = gap.max(apart);
                squares += apart;
                if gap > within * within || best.as_ref().is_some_and(|(least, _)| squares >= *least) {
                    break;
                }
            }
            let better = best.as_ref().is_none_or(|(least, _)| squares < *least);
            if gap <= within * within && better {
                best = Some((squares, Fit { loops, shift, against, gap: gap.sqrt() }));
            }
        }
    }
    Ok(best.map(|(_, fit)| fit))
}

/// Matches what is left vertex by vertex, the nearest first.
fn single_vertices(
    joined: &Mesh,
    boundary: &Boundary,
    rest: &[usize],
    tolerance: f64,
    found: &mut Matched,
    go_on: &GoOn<'_>,
) -> Result<(), WeldError> {
    let at = |vertex: u32| joined.positions()[vertex as usize];
    let mut open: Vec<(u32, usize)> = Vec::new();
    for &one in rest {
        open.extend(boundary.loops[one].vertices.iter().map(|vertex| (*vertex, one)));
    }
    // A vertex at which loops touch is in several of them.
    open.sort_unstable();
    open.dedup_by_key(|(vertex, _)| *vertex);
    open.sort_by(|a, b| at(a.0).x.total_cmp(&at(b.0).x).then(a.0.cmp(&b.0)));
    let mut near = Vec::new();
    for (k, &(a, loop_a)) in open.iter().enumerate() {
        go_on()?;
        for &(b, loop_b) in open[k + 1..].iter().take_while(|(b, _)| at(*b).x - at(a).x <= tolerance) {
            let apart = at(a).distance(at(b));
            if apart <= tolerance && boundary.loops[loop_a].part != boundary.loops[loop_b].part {
                let ordered = if a < b { ([a, b], [loop_a, loop_b]) } else { ([b, a], [loop_b, loop_a]) };
                near.push((apart, ordered.0, ordered.1));
            }
        }
    }
    go_on()?;
    near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut members: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (_, [a, b], loops) in near {
        let (root_a, root_b) = (found.root[a as usize], found.root[b as usize]);
        if root_a == root_b {
            continue;
        }
        let of = |root: u32| members.get(&root).cloned().unwrap_or_else(|| vec![root]);
        let (one, other) = (of(root_a), of(root_b));
        let part = |vertex: &u32| boundary.part_of_vertex(*vertex);
        if one.iter().any(|v| other.iter().any(|w| part(v) == part(w))) {
            continue;
        }
        let (root, gone) = (root_a.min(root_b), root_a.max(root_b));
        members.remove(&gone);
        let all = [one, other].concat();
        all.iter().for_each(|vertex| found.root[*vertex as usize] = root);
        members.insert(root, all);
        let (pair, loops) = if loops[0] <= loops[1] { ([a, b], loops) } else { ([b, a], [loops[1], loops[0]]) };
        found.pairs.entry(loops).or_default().push(pair);
    }
    Ok(())
}
