//! The basis in v at the columns of a tessellation: tabulated once, multiplied with the coefficients of each row.

use glam::DVec3;

use crate::surface::analytic::{Angles, Piece};

/// Columns that are computed side by side.
const WIDTH: usize = 2;

/// Values and derivatives by v of the basis functions at columns.
pub(super) struct Table {
    runs: Vec<Run>,
    columns: usize,
}

/// Consecutive columns in one piece of v.
struct Run {
    /// Coefficients of the piece in a row.
    lanes: std::ops::Range<usize>,
    first: usize,
    count: usize,
    /// For each block of columns, for each function, the values and then the derivatives at the block's columns.
    basis: Vec<[f64; 2 * WIDTH]>,
}

/// Sums of a block of columns: x, y and z of a vector.
type Block = [[f64; WIDTH]; 3];

impl Table {
    /// `columns` in ascending order. Series of v itself are taken at the very angles given, so that surfaces that share
    /// a section share its points to the bit, wherever their first joints are.
    pub fn new(angles: &Angles, columns: &[f64]) -> Self {
        let located: Vec<(&Piece, f64)> = columns
            .iter()
            .map(|v| {
                let (piece, wrapped) = angles.locate(*v);
                (piece, if piece.local { wrapped } else { *v })
            })
            .collect();
        let mut runs = Vec::new();
        let mut first = 0;
        while first < located.len() {
            let piece = located[first].0;
            let count = located[first..].iter().take_while(|(other, _)| other.lane == piece.lane).count();
            runs.push(Run::new(piece, first, &located[first..first + count]));
            first += count;
        }
        Self { runs, columns: columns.len() }
    }

    pub fn columns(&self) -> usize {
        self.columns
    }

    /// The points of a row from its coefficients.
    pub fn points(&self, row: &[DVec3], points: &mut [DVec3]) {
        for run in &self.runs {
            let coefficients = &row[run.lanes.clone()];
            for (block, basis) in run.basis.chunks_exact(coefficients.len()).enumerate() {
                let mut sums = Block::default();
                for (c, basis) in coefficients.iter().zip(basis) {
                    add(&mut sums, *c, [basis[0], basis[1]]);
                }
                store(&sums, run.block(block, points));
            }
        }
    }

    /// The points and unit normals of a row from its coefficients and those of the derivative by u, and the columns in
    /// which the tangents are parallel, whose normals are zero.
    pub fn points_and_normals(
        &self,
        row: &[DVec3],
        derivative: &[DVec3],
        points: &mut [DVec3],
        normals: &mut [DVec3],
    ) -> Vec<usize> {
        let mut parallel = Vec::new();
        for run in &self.runs {
            let (values, slopes) = (&row[run.lanes.clone()], &derivative[run.lanes.clone()]);
            for (block, basis) in run.basis.chunks_exact(values.len()).enumerate() {
                let (mut point, mut across, mut along) = (Block::default(), Block::default(), Block::default());
                for ((c, slope), basis) in values.iter().zip(slopes).zip(basis) {
                    let value = [basis[0], basis[1]];
                    add(&mut point, *c, value);
                    add(&mut along, *slope, value);
                    add(&mut across, *c, [basis[2], basis[3]]);
                }
                let (normal, sound) = unit_normals(&across, &along);
                store(&point, run.block(block, points));
                store(&normal, run.block(block, normals));
                if sound != [true; WIDTH] {
                    let from = run.first + block * WIDTH;
                    let count = (run.count - block * WIDTH).min(WIDTH);
                    parallel.extend((0..count).filter(|k| !sound[*k]).map(|k| from + k));
                }
            }
        }
        parallel
    }
}

impl Run {
    fn new(piece: &Piece, first: usize, columns: &[(&Piece, f64)]) -> Self {
        let functions = piece.lanes().len();
        let (mut value, mut slope) = (vec![0.0; functions], vec![0.0; functions]);
        let mut basis = vec![[0.0; 2 * WIDTH]; columns.len().div_ceil(WIDTH) * functions];
        for (column, (_, v)) in columns.iter().enumerate() {
            piece.basis(*v, 0, &mut value);
            piece.basis(*v, 1, &mut slope);
            let (block, place) = (column / WIDTH, column % WIDTH);
            for (entry, (value, slope)) in basis[block * functions..].iter_mut().zip(value.iter().zip(&slope)) {
                (entry[place], entry[WIDTH + place]) = (*value, *slope);
            }
        }
        Self { lanes: piece.lanes(), first, count: columns.len(), basis }
    }

    /// The places of a block in a row.
    fn block<'a>(&self, block: usize, row: &'a mut [DVec3]) -> &'a mut [DVec3] {
        let from = self.first + block * WIDTH;
        &mut row[from..(from + WIDTH).min(self.first + self.count)]
    }
}

#[inline(always)]
fn add(sums: &mut Block, c: DVec3, weights: [f64; WIDTH]) {
    for (sum, c) in sums.iter_mut().zip(c.to_array()) {
        for (sum, weight) in sum.iter_mut().zip(weights) {
            *sum += c * weight;
        }
    }
}

#[inline(always)]
fn store(sums: &Block, row: &mut [DVec3]) {
    for (k, place) in row.iter_mut().enumerate() {
        *place = DVec3::new(sums[0][k], sums[1][k], sums[2][k]);
    }
}

/// Unit normals across x along, and which of them there are: the rule of a single point, for a block of columns.
#[inline(always)]
fn unit_normals(across: &Block, along: &Block) -> (Block, [bool; WIDTH]) {
    let (mut normals, mut sound) = (Block::default(), [false; WIDTH]);
    for k in 0..WIDTH {
        let a = DVec3::new(across[0][k], across[1][k], across[2][k]);
        let b = DVec3::new(along[0][k], along[1][k], along[2][k]);
        let normal = a.cross(b);
        let square = normal.length_squared();
        sound[k] = square > 1e-24 * a.length_squared() * b.length_squared();
        let scale = if sound[k] { 1.0 / square.sqrt() } else { 0.0 };
        for axis in 0..3 {
            normals[axis][k] = normal[axis] * scale;
        }
    }
    (normals, sound)
}
