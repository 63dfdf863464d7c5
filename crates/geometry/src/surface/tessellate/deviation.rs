//! How far a tessellation is from the surface.

use glam::DVec3;
use rayon::prelude::*;

use super::lattice::Lattice;
use super::table::Table;
use crate::mesh::distance::nearest_on_triangle;
use crate::surface::analytic::AnalyticSurface;

/// The largest distance found from a surface to its tessellation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deviation {
    /// The distance, metres.
    pub largest: f64,
    /// Which surface, counted from 0 (with a rounded cap at the start counted as the first).
    pub surface: usize,
    /// u of the place on it.
    pub u: f64,
    /// v of the place, radians.
    pub v: f64,
}

/// Steps of a quad in each direction between the points that are measured.
const STEPS: usize = 4;

/// Of so many strips, one is measured ahead of the others.
const AHEAD: usize = 8;

/// A point is passed over where a bound of its squared distance is below this share of one that was found: less than 1,
/// so that rounding does not decide.
const BELOW: f64 = 0.999;

/// Nor is a point passed over where distances are below this share of the coordinates, which is some 10^5 times what
/// rounding makes of them.
const NOISE: f64 = 1e-11;

/// Measures the distance from points of the exact surface to the quad they belong to: every quad has a net of 5 by 5,
/// its corners among them. It is an upper bound of their distance to the mesh. Each point counts with the worse of both
/// ways to split the quad into triangles, since programs differ in that. The first of equally far places is given.
///
/// Most points are known to be nearer than the farthest by a simple bound, and are passed over: the result is that of
/// measuring all.
pub(super) fn measure(patches: &[AnalyticSurface], lattice: &Lattice) -> Deviation {
    let columns = refined(&lattice.columns, lattice.closed.then_some(lattice.end));
    let tables: Vec<Table> = patches.iter().map(|patch| Table::new(patch.angles(), &columns)).collect();
    let strips: Vec<(usize, f64, f64)> = lattice
        .rows
        .iter()
        .enumerate()
        .flat_map(|(patch, rows)| rows.windows(2).map(move |pair| (patch, pair[0], pair[1])))
        .collect();
    let of_strip = |(patch, from, to): &(usize, f64, f64), floor: f64| {
        strip(&patches[*patch], &tables[*patch], *patch, [*from, *to], &columns, floor)
    };
    let farthest = |found: &[Deviation]| found.iter().fold(0.0, |most: f64, one| most.max(one.largest));
    // A few strips tell what is not worth a closer look in the others.
    let few: Vec<Deviation> = strips.par_iter().step_by(AHEAD).map(|s| of_strip(s, 0.0)).collect();
    let floor = farthest(&few);
    let found = strips.par_iter().enumerate().map(|(k, s)| match few.get(k / AHEAD) {
        Some(done) if k % AHEAD == 0 => *done,
        _ => of_strip(s, floor),
    });
    let found: Vec<Deviation> = found.collect();
    found.into_iter().fold(Deviation::default(), |a, b| if b.largest > a.largest { b } else { a })
}

/// Places between neighbours, from the first to the last, or around to `end`.
fn refined(places: &[f64], end: Option<f64>) -> Vec<f64> {
    let all: Vec<f64> = places.iter().copied().chain(end).collect();
    let between = |pair: &[f64]| {
        let (a, b) = (pair[0], pair[1]);
        (0..STEPS).map(move |k| a + (b - a) * k as f64 / STEPS as f64).collect::<Vec<_>>()
    };
    let mut refined: Vec<f64> = all.windows(2).flat_map(between).collect();
    refined.extend(all.last());
    refined
}

/// The largest distance in a strip. Points nearer than `floor` metres may be passed over.
fn strip(
    patch: &AnalyticSurface,
    table: &Table,
    surface: usize,
    ends: [f64; 2],
    columns: &[f64],
    floor: f64,
) -> Deviation {
    let count = table.columns();
    let us = refined(&ends, None);
    let mut points = vec![DVec3::ZERO; us.len() * count];
    for (u, row) in us.iter().zip(points.chunks_exact_mut(count)) {
        table.points(&patch.row_at(*u, 0, 0..patch.angles().lanes()), row);
    }
    let quad = |cell: usize| {
        let at = |row: usize, column: usize| points[row * count + column];
        Quad::new([at(0, cell), at(0, cell + STEPS), at(STEPS, cell + STEPS), at(STEPS, cell)])
    };
    // The square of the largest distance known; in the middles of quads it is large.
    let mut least = floor * floor;
    for cell in (0..count - 1).step_by(STEPS) {
        let middle = points[STEPS / 2 * count + cell + STEPS / 2];
        if let Some(distance) = quad(cell).distance_squared_above(least, middle, [STEPS / 2; 2]) {
            least = least.max(distance);
        }
    }
    let mut found = Deviation { surface, ..Deviation::default() };
    for cell in (0..count - 1).step_by(STEPS) {
        let quad = quad(cell);
        let near = quad.near(least);
        for (i, u) in us.iter().enumerate() {
            let row = &points[i * count + cell..][..=STEPS];
            for (k, point) in row.iter().enumerate() {
                if quad.aside(*point, [i, k]).length_squared() < near {
                    continue;
                }
                if let Some(distance) = quad.distance_squared_above(least, *point, [i, k])
                    && distance > found.largest
                {
                    (found.largest, found.u, found.v) = (distance, *u, columns[cell + k]);
                    least = least.max(distance);
                }
            }
        }
    }
    found.largest = found.largest.sqrt();
    found
}

/// A quad, and what bounds the distance of points from it.
struct Quad {
    /// Two along v, then back.
    corners: [DVec3; 4],
    /// `a - b + c - d`: how far the quad is from a parallelogram. The bilinear patch is off either split by at most a
    /// quarter of it.
    twist: DVec3,
    /// Squared distances below which nothing is passed over.
    noise: f64,
}

impl Quad {
    fn new(corners: [DVec3; 4]) -> Self {
        let [a, b, c, d] = corners;
        let size = corners.iter().fold(0.0, |size: f64, corner| size.max(corner.abs().max_element()));
        Self { corners, twist: a - b + c - d, noise: (NOISE * size).powi(2) }
    }

    /// Square of the distance of a point, by the worse of both ways to split the quad.
    fn distance_squared(&self, point: DVec3) -> f64 {
        let [a, b, c, d] = self.corners;
        let to = |corners: [DVec3; 3]| nearest_on_triangle(point, corners).distance_squared(point);
        let split = to([a, b, c]).min(to([a, c, d]));
        let other = to([a, b, d]).min(to([b, c, d]));
        split.max(other)
    }

    /// That, or none where it is known to be smaller than `least`. `steps` are the point's own along u and v.
    fn distance_squared_above(&self, least: f64, point: DVec3, steps: [usize; 2]) -> Option<f64> {
        // The places on both splits that have the point's steps.
        let [t, s] = steps.map(|step| step as f64 / STEPS as f64);
        let aside = self.aside(point, steps);
        let split = (aside - self.twist * (s.min(t) * (1.0 - s.max(t)))).length_squared();
        let other = (aside + self.twist * (s * t).min((1.0 - s) * (1.0 - t))).length_squared();
        let is_near = least > self.noise && split.max(other) < BELOW * least;
        (!is_near).then(|| self.distance_squared(point))
    }

    /// From the place of the bilinear patch with a point's steps to the point.
    fn aside(&self, point: DVec3, steps: [usize; 2]) -> DVec3 {
        let [a, b, c, d] = self.corners;
        let [t, s] = steps.map(|step| step as f64 / STEPS as f64);
        let (left, right) = (a + (d - a) * t, b + (c - b) * t);
        point - (left + (right - left) * s)
    }

    /// Points whose squared distance from the bilinear patch is below this are nearer than `least` whatever the split.
    fn near(&self, least: f64) -> f64 {
        let left = (BELOW * least).sqrt() - 0.25 * self.twist.length();
        if left > 0.0 && least > self.noise { left * left } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::analytic::{SurfaceOptions, SurfacePoint};
    use crate::surface::tessellate::{Demand, Spacing};
    use crate::trigonometric::{EllipticSection, EllipticSegment, PlaneFrame, Series};
    use std::f64::consts::TAU;

    /// A bent limb of sections that turn and change shape.
    fn limb(count: u32) -> AnalyticSurface {
        let section = |k: u32| {
            let y = f64::from(k) / f64::from(count - 1);
            let (sine, cosine) = (2.0 * y).sin_cos();
            let coefficients = vec![
                DVec3::new(0.1 * (3.0 * y).sin(), y, 0.05 * y * y),
                DVec3::new(0.02 * sine, 0.01 * y, 0.09 * cosine),
                DVec3::new(0.07 * cosine, 0.0, -0.03 * sine),
                DVec3::new(0.004, 0.002, 0.01 * y),
                DVec3::new(0.0, 0.006 * sine, 0.008),
            ];
            let series = Series::new(coefficients).unwrap();
            let segment = EllipticSegment { from: 0.0, to: TAU, local: false, series };
            EllipticSection::new(PlaneFrame::new(DVec3::Y * y, DVec3::Y), true, vec![segment]).unwrap()
        };
        let sections: Vec<EllipticSection> = (0..count).map(section).collect();
        AnalyticSurface::through(&sections, &SurfaceOptions::default()).unwrap()
    }

    /// The distance of every point, none passed over.
    fn of_all(patches: &[AnalyticSurface], lattice: &Lattice) -> Deviation {
        let columns = refined(&lattice.columns, lattice.closed.then_some(lattice.end));
        let mut found = Deviation::default();
        for (surface, patch) in patches.iter().enumerate() {
            let table = Table::new(patch.angles(), &columns);
            for pair in lattice.rows[surface].windows(2) {
                let us = refined(pair, None);
                let rows: Vec<Vec<DVec3>> = us
                    .iter()
                    .map(|u| {
                        let mut row = vec![DVec3::ZERO; columns.len()];
                        table.points(&patch.row_at(*u, 0, 0..patch.angles().lanes()), &mut row);
                        row
                    })
                    .collect();
                let mut of_strip = Deviation { surface, ..Deviation::default() };
                for cell in (0..columns.len() - 1).step_by(STEPS) {
                    let end = cell + STEPS;
                    let quad = Quad::new([rows[0][cell], rows[0][end], rows[STEPS][end], rows[STEPS][cell]]);
                    for (u, row) in us.iter().zip(&rows) {
                        for k in cell..=end {
                            let distance = quad.distance_squared(row[k]);
                            if distance > of_strip.largest {
                                of_strip = Deviation { largest: distance, surface, u: *u, v: columns[k] };
                            }
                        }
                    }
                }
                of_strip.largest = of_strip.largest.sqrt();
                if of_strip.largest > found.largest {
                    found = of_strip;
                }
            }
        }
        found
    }

    #[test]
    fn passing_over_near_points_changes_no_bit() {
        let patches = [limb(7), limb(4)];
        for spacing in [Spacing::Even, Spacing::Curvature] {
            let demand = Demand::new(&patches, spacing);
            for (rows, columns) in [(2, 3), (9, 8), (20, 24), (61, 16), (50, 70)] {
                let lattice = demand.lattice(rows, columns);
                let (found, all) = (measure(&patches, &lattice), of_all(&patches, &lattice));
                assert_eq!(found, all, "{spacing:?} {rows} {columns}");
                let SurfacePoint { position, .. } = patches[found.surface].evaluate(found.u, found.v);
                assert!(found.largest > 0.0 && position.is_finite());
            }
        }
    }

    #[test]
    fn bounds_are_no_smaller_than_distances() {
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.1, 0.3], [1.2, 0.9, -0.4], [-0.1, 1.1, 0.2]].map(DVec3::from_array);
        let quad = Quad::new(corners);
        for i in 0..=STEPS {
            for k in 0..=STEPS {
                for off in [DVec3::ZERO, DVec3::new(0.02, -0.01, 0.3), DVec3::new(-0.2, 0.1, -0.05)] {
                    let place = -quad.aside(DVec3::ZERO, [i, k]);
                    // At the corners, zero but for rounding.
                    let (point, distance) = (place + off, quad.distance_squared(place + off));
                    // What may be passed over at some least distance is nearer than that.
                    for least in [0.25, 0.5, 0.9, 1.0].map(|share| share * distance) {
                        assert!(quad.distance_squared_above(least, point, [i, k]) == Some(distance));
                        assert!(quad.aside(point, [i, k]).length_squared() >= quad.near(least));
                    }
                }
            }
        }
        // And what is far below is passed over.
        let middle = -quad.aside(DVec3::ZERO, [2, 2]);
        assert_eq!(quad.distance_squared_above(4.0, middle, [2, 2]), None);
        assert!(quad.near(4.0) > 0.0 && quad.near(1e-9) == 0.0);
    }
}
