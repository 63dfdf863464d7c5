//! A strip of quads and triangles between two closed borders, the one around the other.

use glam::DVec3;

use super::ResampleBorderError;

/// Least cosine between a triangle and the normals at its corners, below which it counts as folded.
const LEAST_COSINE: f64 = 0.25;

/// A corner of a face: a place on the outer border, or on the inner one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Corner {
    Outer(usize),
    Inner(usize),
}

/// A face of the strip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Face {
    corners: [Corner; 4],
    count: usize,
}

impl Face {
    pub(super) fn corners(&self) -> impl Iterator<Item = Corner> + '_ {
        self.corners[..self.count].iter().copied()
    }
}

/// How a strip goes on.
#[derive(Clone, Copy, PartialEq)]
enum Step {
    Outer,
    Inner,
    Both,
}

impl Step {
    fn ahead(self) -> [usize; 2] {
        match self {
            Self::Outer => [1, 0],
            Self::Inner => [0, 1],
            Self::Both => [1, 1],
        }
    }
}

/// Faces between two borders, each of points with normals, both run the same way, the inner one on the left of the
/// outer one seen against the normals. Where every strip folds, the place at which the best one does.
pub(super) fn strip(
    outer: &[(DVec3, DVec3)],
    inner: &[(DVec3, DVec3)],
    go_on: &dyn Fn() -> Result<(), ResampleBorderError>,
) -> Result<Result<Vec<Face>, DVec3>, ResampleBorderError> {
    let (rows, columns) = (outer.len(), inner.len());
    // Both begin where they are nearest: that side is in any good strip.
    let mut first = (f64::INFINITY, 0, 0);
    for (i, (p, _)) in outer.iter().enumerate() {
        go_on()?;
        for (j, (q, _)) in inner.iter().enumerate() {
            if p.distance_squared(*q) < first.0 {
                first = (p.distance_squared(*q), i, j);
            }
        }
    }
    let (_, i0, j0) = first;
    let (o, n) = (|i: usize| outer[(i0 + i) % rows], |j: usize| inner[(j0 + j) % columns]);
    let size = inner.iter().map(|(q, _)| q.distance_squared(inner[0].0)).fold(0.0, f64::max);
    let folded = |corners: [(DVec3, DVec3); 3]| {
        let normal = (corners[1].0 - corners[0].0).cross(corners[2].0 - corners[0].0).normalize_or_zero();
        corners.iter().any(|(_, at)| normal.dot(*at) < LEAST_COSINE)
    };
    let corners = |i: usize, j: usize, step: Step| -> ([(DVec3, DVec3); 4], usize) {
        match step {
            Step::Outer => ([o(i), o(i + 1), n(j), n(j)], 3),
            Step::Inner => ([o(i), n(j + 1), n(j), n(j)], 3),
            Step::Both => ([o(i), o(i + 1), n(j + 1), n(j)], 4),
        }
    };
    // A fold costs more than any strip.
    let fold = 10.0 * size * (rows + columns) as f64;
    let price = |i: usize, j: usize, step: Step| -> Option<f64> {
        let [di, dj] = step.ahead();
        let side = o(i + di).0.distance_squared(n(j + dj).0);
        match corners(i, j, step) {
            ([a, b, c, d], 4) => {
                let bad = [[a, b, c], [a, c, d], [a, b, d], [b, c, d]].into_iter().any(folded);
                (!bad).then_some(side)
            }
            ([a, b, c, _], _) => Some(side + if folded([a, b, c]) { fold } else { 0.0 }),
        }
    };
    // What a strip costs that takes the cheapest step each time, by the points it passes: no better one begins dearer.
    let mut most = 0.0;
    let (mut i, mut j) = (0, 0);
    while (i, j) != (rows, columns) {
        let steps = [Step::Both, Step::Outer, Step::Inner].into_iter().filter_map(|step| {
            let [di, dj] = step.ahead();
            let fits = i + di <= rows && j + dj <= columns;
            Some((step, if fits { price(i, j, step) } else { None }?))
        });
        let worth = |(step, price): &(Step, f64)| price / if *step == Step::Both { 2.0 } else { 1.0 };
        let Some((step, price)) = steps.min_by(|a, b| worth(a).total_cmp(&worth(b))) else { break };
        most += price;
        (i, j) = (i + step.ahead()[0], j + step.ahead()[1]);
    }
    // It is summed in another order than others.
    most *= 1.0 + 1e-9;
    let width = columns + 1;
    let mut cost = vec![f64::INFINITY; (rows + 1) * width];
    let mut by = vec![Step::Both; cost.len()];
    cost[0] = 0.0;
    for i in 0..=rows {
        go_on()?;
        for j in 0..=columns {
            let here = cost[i * width + j];
            if here > most {
                continue;
            }
            for step in [Step::Both, Step::Outer, Step::Inner] {
                let [di, dj] = step.ahead();
                if i + di > rows || j + dj > columns {
                    continue;
                }
                let there = (i + di) * width + j + dj;
                if let Some(price) = price(i, j, step)
                    && here + price < cost[there]
                {
                    (cost[there], by[there]) = (here + price, step);
                }
            }
        }
    }
    let mut faces = Vec::with_capacity(rows + columns);
    let (mut i, mut j, mut worst) = (rows, columns, None);
    while (i, j) != (0, 0) {
        let step = by[i * width + j];
        let [di, dj] = step.ahead();
        (i, j) = (i - di, j - dj);
        let (places, count) = corners(i, j, step);
        if count == 3 && folded([places[0], places[1], places[2]]) {
            worst = Some(places[0].0);
        }
        let (outer, next) = (Corner::Outer((i0 + i) % rows), Corner::Outer((i0 + i + 1) % rows));
        let (inner, then) = (Corner::Inner((j0 + j) % columns), Corner::Inner((j0 + j + 1) % columns));
        faces.push(match step {
            Step::Outer => Face { corners: [outer, next, inner, inner], count: 3 },
            Step::Inner => Face { corners: [outer, then, inner, inner], count: 3 },
            Step::Both => Face { corners: [outer, next, then, inner], count: 4 },
        });
    }
    faces.reverse();
    Ok(match worst {
        None => Ok(faces),
        Some(at) => Err(at),
    })
}
