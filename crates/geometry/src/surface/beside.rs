//! Slopes with which a skin leaves the surfaces beside it.

use glam::DVec3;

use super::grid::unit_normal;
use super::spline::{End, Ends, SlopeSystem};
use crate::curve::chord_parameters;
use crate::sections::Sections;

/// What a skin continues smoothly: directions in the tangent planes of the surfaces beside it, across its borders, of
/// any length and sense but zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Beside<'a> {
    /// At the points of the first section and of the last.
    pub ends: [Option<&'a [DVec3]>; 2],
    /// Of open sections, at the first point of each and at the last.
    pub sides: [Option<&'a [DVec3]>; 2],
}

impl Beside<'_> {
    /// The name of a side and the numbers of directions it has and needs, where they are not the same.
    pub(super) fn misfit(&self, sections: &Sections) -> Option<(&'static str, usize, usize)> {
        let wanted =
            [("first section", self.ends[0], sections.nodes()), ("last section", self.ends[1], sections.nodes())];
        let side = if sections.is_closed() { 0 } else { sections.len() };
        let sides = [("first side", self.sides[0], side), ("last side", self.sides[1], side)];
        let all =
            wanted.into_iter().chain(sides).filter_map(|(name, given, needed)| Some((name, given?.len(), needed)));
        all.into_iter().find(|(_, found, needed)| found != needed)
    }
}

/// The slope at the first of three points `h` apart: that of the parabola through them.
pub(super) fn leaving(points: [DVec3; 3], h: [f64; 2]) -> DVec3 {
    let (first, second) = ((points[1] - points[0]) / h[0], (points[2] - points[1]) / h[1]);
    first + (first - second) * (h[0] / (h[0] + h[1]))
}

/// The slope turned into the plane across a normal.
pub(super) fn turned_into(slope: DVec3, normal: DVec3) -> DVec3 {
    slope - normal * normal.dot(slope)
}

/// Tangents of the spline through the points of one edge, its knots at the length of its own chords: those that a whole
/// skin shares are off it. None where points coincide.
fn tangents(points: &[DVec3], closed: bool) -> Option<Vec<DVec3>> {
    let lengths = chord_parameters(points, closed);
    let intervals: Vec<f64> = lengths.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if points.len() < 3 || intervals.iter().any(|interval| *interval <= 0.0) {
        return None;
    }
    let mut slopes = vec![DVec3::ZERO; points.len()];
    let ends = if closed {
        Ends::Periodic
    } else {
        let (last, behind) = (points.len() - 1, intervals.len() - 1);
        slopes[0] = leaving([points[0], points[1], points[2]], [intervals[0], intervals[1]]);
        let back =
            leaving([points[last], points[last - 1], points[last - 2]], [intervals[behind], intervals[behind - 1]]);
        slopes[last] = -back;
        Ends::Open { start: End::Slope, end: End::Slope }
    };
    SlopeSystem::new(intervals, ends).solve(points, &mut slopes, 1);
    Some(slopes)
}

/// Unit normals of the neighbour at the points of an edge, on either side; zero where it has none.
pub(super) fn normals(points: &[DVec3], closed: bool, directions: &[DVec3]) -> Vec<DVec3> {
    let tangents = tangents(points, closed).unwrap_or_else(|| vec![DVec3::ZERO; points.len()]);
    tangents.iter().zip(directions).map(|(tangent, direction)| unit_normal(*tangent, *direction)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{SkinOptions, skin, skin_beside};
    use std::f64::consts::TAU;

    /// Rings of a sphere of radius 1 about y, from one latitude to another.
    fn zone(from: f64, to: f64, rows: u32) -> Sections {
        let ring = |row: u32| {
            let latitude = from + (to - from) * f64::from(row) / f64::from(rows - 1);
            let at = |k: u32| TAU * f64::from(k) / 48.0;
            let point = |a: f64| DVec3::new(latitude.cos() * a.cos(), latitude.sin(), -latitude.cos() * a.sin());
            (0..48).map(at).map(point).collect()
        };
        Sections::new((0..rows).map(ring).collect(), true, vec![]).unwrap()
    }

    #[test]
    fn the_skin_leaves_its_neighbours_in_their_planes() {
        let sections = zone(-0.2, 0.9, 7);
        let options = SkinOptions { rows: 3, columns: 1, ..SkinOptions::default() };
        let along = |p: &DVec3| DVec3::Y - *p * p.y;
        let [low, high] = [0, 6].map(|k| sections.section(k).iter().map(along).collect::<Vec<_>>());
        let beside = Beside { ends: [Some(&low), Some(&high)], sides: [None; 2] };
        let made = skin_beside(&sections, &options, &beside, &|_| true).unwrap();
        let plain = skin(&sections, &options, &|_| true).unwrap();
        let worst = |mesh: &crate::mesh::Mesh| {
            let normals = mesh.corners().iter().zip(mesh.normals().unwrap());
            normals.map(|(vertex, n)| n.angle_between(mesh.positions()[*vertex as usize])).fold(0.0, f64::max)
        };
        assert!(
            worst(&made).to_degrees() < 0.2 && worst(&plain).to_degrees() > 2.0,
            "{} {}",
            worst(&made),
            worst(&plain)
        );
        let off =
            |mesh: &crate::mesh::Mesh| mesh.positions().iter().map(|p| (p.length() - 1.0).abs()).fold(0.0, f64::max);
        assert!(off(&made) < 0.3 * off(&plain), "{} {}", off(&made), off(&plain));
    }

    #[test]
    fn open_sections_have_sides() {
        // A part of a cylinder about z, its sections along the arc.
        let arc =
            |z: u32| (0..6).map(|k| 0.3 * f64::from(k)).map(|a| DVec3::new(a.cos(), a.sin(), f64::from(z))).collect();
        let sections = Sections::new((0..5).map(arc).collect(), false, vec![]).unwrap();
        let tangent = |a: f64| vec![DVec3::new(-a.sin(), a.cos(), 0.0); 5];
        let [first, last] = [tangent(0.0), tangent(1.5)];
        let beside = Beside { ends: [None; 2], sides: [Some(&first), Some(&last)] };
        let made = skin_beside(&sections, &SkinOptions::default(), &beside, &|_| true).unwrap();
        for (vertex, normal) in made.corners().iter().zip(made.normals().unwrap()) {
            let p = made.positions()[*vertex as usize];
            assert!(normal.angle_between(DVec3::new(p.x, p.y, 0.0)).to_degrees() < 0.2, "{p} {normal}");
        }
        let few = Beside { ends: [None; 2], sides: [Some(&first[1..]), None] };
        let refused = skin_beside(&sections, &SkinOptions::default(), &few, &|_| true).unwrap_err();
        assert_eq!(refused.to_string(), "4 directions given at the first side, and it has 5 points");
    }
}
