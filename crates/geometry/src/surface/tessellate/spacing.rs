//! How rows and columns are spread: evenly, or closer where the surface bends more.

use glam::DVec3;

use super::lattice::Lattice;
use crate::surface::analytic::{AnalyticSurface, Piece};
use crate::surface::grid::unit_normal;

/// How rows and columns are spread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Spacing {
    /// In proportion to the square root of the largest curvature across each row and column, which makes the deviation
    /// the same everywhere.
    #[default]
    Curvature,
    /// At equal steps of u within each surface, and of v.
    Even,
}

/// Share of the mean curvature that straight places count as having, so that quads stay within about 5:1 of square.
const FLOOR: f64 = 0.04;

/// A stretch of u or v whose ends carry a row or column, with a density over its steps.
#[derive(Clone, Debug)]
struct Stretch {
    from: f64,
    to: f64,
    /// Mean density on equal steps of the stretch, per unit of the parameter.
    density: Vec<f64>,
}

impl Stretch {
    fn total(&self) -> f64 {
        self.density.iter().sum::<f64>() * (self.to - self.from) / self.density.len() as f64
    }

    /// `count + 1` places from end to end with equal shares of the density between them.
    fn places(&self, count: usize) -> Vec<f64> {
        let sum: f64 = self.density.iter().sum();
        let width = (self.to - self.from) / self.density.len() as f64;
        let mut places = vec![self.from];
        let (mut step, mut passed) = (0, 0.0);
        for k in 1..count {
            let wanted = sum * k as f64 / count as f64;
            while step + 1 < self.density.len() && passed + self.density[step] < wanted {
                passed += self.density[step];
                step += 1;
            }
            let inside = if self.density[step] > 0.0 { (wanted - passed) / self.density[step] } else { 0.5 };
            places.push(self.from + width * (step as f64 + inside.clamp(0.0, 1.0)));
        }
        places.push(self.to);
        places
    }
}

/// What rows and columns a set of patches wants.
pub(crate) struct Demand {
    /// Of each patch.
    rows: Vec<Vec<Stretch>>,
    columns: Vec<Stretch>,
    closed: bool,
    /// Sums of the densities: for n rows and m columns the deviation is about `(rows/n)^2/8 + (columns/m)^2/8`.
    pub row_total: f64,
    pub column_total: f64,
}

impl Demand {
    pub fn new(patches: &[AnalyticSurface], spacing: Spacing) -> Self {
        let (from, to) = patches[0].angle_range();
        let closed = patches[0].is_closed();
        // Columns at the joints of all patches, counted from the first one's first angle.
        let mut breaks: Vec<f64> = patches.iter().flat_map(AnalyticSurface::joints).collect();
        if closed {
            breaks.iter_mut().for_each(|v| *v = from + (*v - from).rem_euclid(to - from));
        }
        breaks.retain(|v| *v - from > 1e-9 && to - *v > 1e-9);
        breaks.extend([from, to]);
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|b, a| *b - *a <= 1e-9);
        let most = patches.iter().map(AnalyticSurface::harmonics).max().unwrap_or(0);
        let steps = 6 * (most + 1).max(2);
        let stretches = breaks.windows(2).map(|pair| (pair[0], pair[1]));
        let mut columns: Vec<Stretch> = stretches
            .map(|(a, b)| {
                let steps = ((b - a) / (to - from) * steps as f64).ceil().max(4.0) as usize;
                Stretch { from: a, to: b, density: vec![0.0; steps] }
            })
            .collect();
        let mut rows: Vec<Vec<Stretch>> = patches.iter().map(row_stretches).collect();
        match spacing {
            Spacing::Even => even(patches, &mut rows, &mut columns),
            Spacing::Curvature => curved(patches, &mut rows, &mut columns),
        }
        let row_total = rows.iter().flatten().map(Stretch::total).sum();
        let column_total = columns.iter().map(Stretch::total).sum();
        Self { rows, columns, closed, row_total, column_total }
    }

    /// A lattice with about so many rows and columns of quads: exactly so many, where that is enough for one in every
    /// stretch.
    pub fn lattice(&self, rows: usize, columns: usize) -> Lattice {
        let weights: Vec<f64> = self.rows.iter().flatten().map(Stretch::total).collect();
        let mut counts = allocate(&weights, rows).into_iter();
        let mut place = |stretches: &Vec<Stretch>| joined(stretches, &mut counts);
        let rows = self.rows.iter().map(&mut place).collect();
        let weights: Vec<f64> = self.columns.iter().map(Stretch::total).collect();
        // A ring of less than three columns encloses nothing.
        let columns = if self.closed { columns.max(3) } else { columns };
        let mut columns = joined(&self.columns, &mut allocate(&weights, columns).into_iter());
        let end = columns[columns.len() - 1];
        if self.closed {
            columns.pop();
        }
        Lattice { rows, columns, closed: self.closed, end }
    }
}

/// Places of all stretches end to end.
fn joined(stretches: &[Stretch], counts: &mut impl Iterator<Item = usize>) -> Vec<f64> {
    let mut places = vec![stretches[0].from];
    for (stretch, count) in stretches.iter().zip(counts) {
        places.extend(&stretch.places(count)[1..]);
    }
    places
}

/// Shares `count` among stretches, one at least for each: each one more goes where the density between two is largest.
fn allocate(weights: &[f64], count: usize) -> Vec<usize> {
    let total: f64 = weights.iter().sum();
    let spare = count.saturating_sub(weights.len());
    // Rounded down, so that only a few are left to be given out one by one.
    let mut counts: Vec<usize> = weights
        .iter()
        .map(|w| 1 + if total > 0.0 { (w / total * count as f64 - 1.0).max(0.0).floor() as usize } else { 0 })
        .collect();
    while counts.iter().sum::<usize>() > weights.len() + spare {
        let largest = (0..counts.len()).filter(|k| counts[*k] > 1).max_by(|a, b| {
            let load = |k: usize| weights[k] / (counts[k] - 1) as f64;
            load(*b).total_cmp(&load(*a)).then(b.cmp(a))
        });
        let Some(largest) = largest else { break };
        counts[largest] -= 1;
    }
    while counts.iter().sum::<usize>() < weights.len() + spare {
        let load = |k: usize| weights[k] / counts[k] as f64;
        let most = (1..counts.len()).fold(0, |most, k| if load(k) > load(most) { k } else { most });
        counts[most] += 1;
    }
    counts
}

/// Stretches of u between the ends and the poles of a patch, with steps between sections.
fn row_stretches(patch: &AnalyticSurface) -> Vec<Stretch> {
    let knots = patch.section_parameters();
    let gaps = knots.len() - 1;
    let steps = (80 / gaps).clamp(2, 16);
    let mut stretches = Vec::new();
    let mut first = 0;
    for k in 1..=gaps {
        if k == gaps || patch.is_pole(k) {
            stretches.push(Stretch { from: knots[first], to: knots[k], density: vec![0.0; steps * (k - first)] });
            first = k;
        }
    }
    stretches
}

fn even(patches: &[AnalyticSurface], rows: &mut [Vec<Stretch>], columns: &mut [Stretch]) {
    if patches.len() == 1 {
        rows.iter_mut().flatten().for_each(|stretch| stretch.density.fill(1.0));
    }
    for (patch, stretches) in patches.iter().zip(rows).filter(|_| patches.len() > 1) {
        // A patch gets rows by its length.
        let knots = patch.section_parameters();
        let (from, to) = patch.angle_range();
        let length: f64 = (0..8)
            .map(|k| from + (to - from) * f64::from(k) / 8.0)
            .map(|v| {
                let points: Vec<DVec3> = knots.iter().map(|u| patch.evaluate(*u, v).position).collect();
                points.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f64>()
            })
            .sum();
        stretches.iter_mut().for_each(|stretch| stretch.density.fill(length));
    }
    columns.iter_mut().for_each(|stretch| stretch.density.fill(1.0));
}

fn curved(patches: &[AnalyticSurface], rows: &mut [Vec<Stretch>], columns: &mut [Stretch]) {
    // For each step of each stretch of u and of v: the largest bend, and the largest speed.
    let mut of_rows: Vec<Vec<Vec<[f64; 2]>>> =
        rows.iter().map(|r| r.iter().map(|s| vec![[0.0; 2]; s.density.len()]).collect()).collect();
    let mut of_columns: Vec<Vec<[f64; 2]>> = columns.iter().map(|s| vec![[0.0; 2]; s.density.len()]).collect();
    let (mut bends, mut areas) = (0.0, 0.0);
    let raise = |entry: &mut [f64; 2], bend: f64, speed: f64| *entry = [entry[0].max(bend), entry[1].max(speed)];
    for (p, patch) in patches.iter().enumerate() {
        let angles = patch.angles();
        let probes: Vec<(usize, usize, Piece, Vec<[f64; 3]>)> = columns
            .iter()
            .enumerate()
            .flat_map(|(stretch, s)| (0..s.density.len()).map(move |step| (stretch, step, middle(s, step))))
            .map(|(stretch, step, v)| {
                let (piece, v) = angles.locate(v);
                (stretch, step, *piece, basis_at(piece, v))
            })
            .collect();
        for (stretch, s) in rows[p].iter().enumerate() {
            for (step, of_row) in of_rows[p][stretch].iter_mut().enumerate() {
                let u = middle(s, step);
                let row = [0, 1, 2].map(|order| patch.row_at(u, order, 0..angles.lanes()));
                for (column, place, piece, basis) in &probes {
                    let [su, sv, suu, svv] = derivatives([0, 1, 2].map(|order| &row[order][piece.lanes()]), basis);
                    let normal = unit_normal(sv, su);
                    let (along, across) = (suu.dot(normal).abs(), svv.dot(normal).abs());
                    raise(of_row, along, su.length());
                    raise(&mut of_columns[*column][*place], across, sv.length());
                    // Mean curvature of the surface, weighted by area.
                    let area = sv.cross(su).length();
                    if area > 0.0 {
                        bends += area * (along / su.length_squared()).max(across / sv.length_squared());
                        areas += area;
                    }
                }
            }
        }
    }
    let floor = if areas > 0.0 { FLOOR * bends / areas } else { 0.0 };
    let density = |[bend, speed]: [f64; 2]| bend.max(floor * speed * speed).sqrt().max(1e-9 * speed);
    for (stretch, measured) in rows.iter_mut().flatten().zip(of_rows.iter().flatten()) {
        stretch.density = measured.iter().map(|m| density(*m)).collect();
    }
    for (stretch, measured) in columns.iter_mut().zip(&of_columns) {
        stretch.density = measured.iter().map(|m| density(*m)).collect();
    }
}

/// The basis functions of a piece at `v`, each with its first two derivatives.
fn basis_at(piece: &Piece, v: f64) -> Vec<[f64; 3]> {
    let mut functions = vec![[0.0; 3]; piece.lanes().len()];
    let mut row = vec![0.0; functions.len()];
    for order in 0..3 {
        piece.basis(v, order, &mut row);
        functions.iter_mut().zip(&row).for_each(|(function, value)| function[order] = *value);
    }
    functions
}

/// The first and second derivatives by u and by v, `[S_u, S_v, S_uu, S_vv]`, of a row of coefficients with its derivatives
/// by u, and the basis. In one pass: four sums side by side take little longer than one.
fn derivatives([row, by_u, by_uu]: [&[DVec3]; 3], basis: &[[f64; 3]]) -> [DVec3; 4] {
    let mut sums = [DVec3::ZERO; 4];
    for (((c, cu), cuu), [value, slope, bend]) in row.iter().zip(by_u).zip(by_uu).zip(basis) {
        sums[0] += *cu * *value;
        sums[1] += *c * *slope;
        sums[2] += *cuu * *value;
        sums[3] += *c * *bend;
    }
    sums
}

fn middle(stretch: &Stretch, step: usize) -> f64 {
    stretch.from + (stretch.to - stretch.from) * (step as f64 + 0.5) / stretch.density.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_share_the_density() {
        let stretch = Stretch { from: 1.0, to: 3.0, density: vec![1.0, 3.0] };
        assert_eq!(stretch.total(), 4.0);
        let places = stretch.places(4);
        for (place, expected) in places.iter().zip([1.0, 2.0, 2.0 + 1.0 / 3.0, 2.0 + 2.0 / 3.0, 3.0]) {
            assert!((place - expected).abs() < 1e-12, "{places:?}");
        }
        assert_eq!(Stretch { density: vec![0.0; 3], ..stretch }.places(1), [1.0, 3.0]);
    }

    #[test]
    fn counts_add_up_and_follow_the_weights() {
        assert_eq!(allocate(&[1.0, 3.0], 8), [2, 6]);
        assert_eq!(allocate(&[1.0, 3.0], 1), [1, 1]);
        assert_eq!(allocate(&[0.0, 0.0, 5.0], 6), [1, 1, 4]);
        assert_eq!(allocate(&[0.0, 0.0], 5).iter().sum::<usize>(), 5);
        assert_eq!(allocate(&[1e-9, 1.0, 1.0, 1.0, 1.0], 9), [1, 2, 2, 2, 2]);
        assert_eq!(allocate(&[1.0; 7], 1000).iter().sum::<usize>(), 1000);
    }
}
