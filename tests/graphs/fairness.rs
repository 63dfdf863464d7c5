//! What an artist sees in a surface: whether it crosses itself, creases, leaves its curves.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec3, I64Vec3};
use maquette_geometry::curve::{Curve, closest};
use maquette_geometry::mesh::{Mesh, triangles};
use maquette_geometry::sections::Sections;

/// Largest distance of any point of a section from a curve, metres.
pub fn off(points: &[DVec3], curve: &Curve) -> f64 {
    points.iter().map(|p| closest(curve, *p).distance).fold(0.0, f64::max)
}

/// Largest distance of the columns of the rails from the rails, metres.
pub fn off_rails(sections: &Sections, rails: &[Curve]) -> f64 {
    assert_eq!(sections.rails().len(), rails.len());
    let columns = sections.rails().iter().zip(rails);
    columns
        .map(|(column, rail)| off(&sections.iter().map(|row| row[*column]).collect::<Vec<_>>(), rail))
        .fold(0.0, f64::max)
}

/// Derivative at the first of points at equal steps, by one-sided differences of third order; of any length.
pub fn leaving(at: impl Fn(usize) -> DVec3) -> DVec3 {
    at(0) * -11.0 + at(1) * 18.0 - at(2) * 9.0 + at(3) * 2.0
}

/// Largest angle between the tangent planes at both sides of a column, degrees, rows at a pole left out.
pub fn crease(sections: &Sections, column: usize) -> f64 {
    let n = sections.nodes();
    let rows = (1..sections.len() - 1).map(|row| {
        let beside = |step: usize| sections.section(row)[(column + step) % n];
        let up = sections.section(row + 1)[column] - sections.section(row - 1)[column];
        let (one, other) = (leaving(beside), leaving(|k| beside(n - k)));
        one.cross(up).angle_between(up.cross(other)).to_degrees()
    });
    rows.fold(0.0, f64::max)
}

/// Pairs of an edge and a triangle of a mesh that pass through each other without a common vertex.
pub fn crossings(mesh: &Mesh) -> usize {
    let all: Vec<[u32; 3]> = triangles(mesh).map(|corners| corners.map(|c| mesh.corners()[c])).collect();
    let at = |vertex: u32| mesh.positions()[vertex as usize];
    let edges: BTreeSet<[u32; 2]> = all
        .iter()
        .flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]])
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect();
    let cell = edges.iter().map(|[a, b]| at(*a).distance(at(*b))).fold(0.0, f64::max);
    let cells = |points: &[DVec3]| {
        let low = points.iter().copied().reduce(DVec3::min).unwrap_or_default() / cell;
        let high = points.iter().copied().reduce(DVec3::max).unwrap_or_default() / cell;
        let (low, high): (I64Vec3, I64Vec3) = (low.floor().as_i64vec3(), high.floor().as_i64vec3());
        let ways = (low.x..=high.x).flat_map(move |x| (low.y..=high.y).map(move |y| (x, y)));
        ways.flat_map(move |(x, y)| (low.z..=high.z).map(move |z| (x, y, z)))
    };
    let mut grid: BTreeMap<(i64, i64, i64), Vec<usize>> = BTreeMap::new();
    for (index, triangle) in all.iter().enumerate() {
        cells(&triangle.map(at)).for_each(|place| grid.entry(place).or_default().push(index));
    }
    let mut found = BTreeSet::new();
    for edge in &edges {
        let [from, to] = edge.map(at);
        for index in cells(&[from, to]).filter_map(|place| grid.get(&place)).flatten() {
            let triangle = all[*index];
            if !triangle.iter().any(|vertex| edge.contains(vertex)) && passes(from, to, triangle.map(at)) {
                found.insert((*edge, *index));
            }
        }
    }
    found.len()
}

/// Whether a segment goes through a triangle's inside (Moeller and Trumbore).
fn passes(from: DVec3, to: DVec3, [a, b, c]: [DVec3; 3]) -> bool {
    let (way, first, second) = (to - from, b - a, c - a);
    let across = way.cross(second);
    let volume = first.dot(across);
    let out = from - a;
    let other = out.cross(first);
    let (u, v, t) = (out.dot(across) / volume, way.dot(other) / volume, second.dot(other) / volume);
    const WITHIN: f64 = 1e-9;
    // Beside each other, none of them is a number.
    u > WITHIN && v > WITHIN && u + v < 1.0 - WITHIN && t > WITHIN && t < 1.0 - WITHIN
}
