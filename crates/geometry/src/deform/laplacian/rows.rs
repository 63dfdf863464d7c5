//! Rows of a sparse matrix whose entries are numbers or vectors, and the lower triangle of what they make.

use rayon::prelude::*;
use sprs::CsMat;

/// Rows of a sparse matrix, their columns ascending.
///
/// `sprs` keeps matrices of numbers; here an entry may be the vector by which a vertex enters a 3 x 3 gradient.
#[derive(Clone, Debug)]
pub(super) struct Rows<T> {
    starts: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<T>,
}

impl<T: Copy + Send + Sync> Rows<T> {
    pub(super) fn new() -> Self {
        Self { starts: vec![0], columns: Vec::new(), values: Vec::new() }
    }

    /// Adds a row behind the last one; its columns must ascend.
    pub(super) fn push(&mut self, entries: impl IntoIterator<Item = (u32, T)>) {
        for (column, value) in entries {
            self.columns.push(column);
            self.values.push(value);
        }
        self.starts.push(self.columns.len());
    }

    /// As many rows as asked for, made on all threads: `make` adds one row behind those it gets, by [`Rows::push`], and has
    /// a state of its own thread for scratch. Rows come in order, whatever the number of threads.
    pub(super) fn build<S>(
        rows: usize,
        state: impl Fn() -> S + Sync,
        make: impl Fn(&mut S, usize, &mut Self) + Sync,
    ) -> Self {
        let chunks: Vec<usize> = (0..rows).step_by(CHUNK).collect();
        let made: Vec<Self> = chunks
            .into_par_iter()
            .map_init(&state, |state, first| {
                let mut chunk = Self::new();
                (first..rows.min(first + CHUNK)).for_each(|row| make(state, row, &mut chunk));
                chunk
            })
            .collect();
        let mut all = Self::new();
        let entries = made.iter().map(|chunk| chunk.columns.len()).sum();
        all.starts.reserve_exact(rows);
        all.columns.reserve_exact(entries);
        all.values.reserve_exact(entries);
        for chunk in made {
            let before = all.columns.len();
            all.starts.extend(chunk.starts[1..].iter().map(|start| before + start));
            all.columns.extend_from_slice(&chunk.columns);
            all.values.extend_from_slice(&chunk.values);
        }
        all
    }

    /// Rows computed apart and put one behind the other.
    pub(super) fn collect(rows: Vec<Vec<(u32, T)>>) -> Self {
        let mut all = Self::new();
        for row in rows {
            all.push(row);
        }
        all
    }

    pub(super) fn len(&self) -> usize {
        self.starts.len() - 1
    }

    pub(super) fn columns(&self, row: usize) -> &[u32] {
        &self.columns[self.starts[row]..self.starts[row + 1]]
    }

    /// Entries of a row.
    pub(super) fn row(&self, row: usize) -> impl Iterator<Item = (usize, T)> {
        let range = self.starts[row]..self.starts[row + 1];
        self.columns[range.clone()].iter().map(|c| *c as usize).zip(self.values[range].iter().copied())
    }

    /// Entries of a row at `column` and behind it.
    fn row_from(&self, row: usize, column: usize) -> impl Iterator<Item = (usize, T)> {
        let range = self.starts[row]..self.starts[row + 1];
        let skipped = self.columns[range.clone()].partition_point(|c| (*c as usize) < column);
        let range = range.start + skipped..range.end;
        self.columns[range.clone()].iter().map(|c| *c as usize).zip(self.values[range].iter().copied())
    }

    /// The first `columns` columns as rows.
    pub(super) fn transposed(&self, columns: usize) -> Self {
        let mut starts = vec![0_usize; columns + 1];
        for column in self.columns.iter().filter(|column| (**column as usize) < columns) {
            starts[*column as usize + 1] += 1;
        }
        for column in 0..columns {
            starts[column + 1] += starts[column];
        }
        let mut next = starts.clone();
        let mut rows = vec![0_u32; starts[columns]];
        // Filled with any value first: every place is written once below.
        let mut values: Vec<T> = self.values.first().map_or_else(Vec::new, |any| vec![*any; starts[columns]]);
        for row in 0..self.len() {
            for (column, value) in self.row(row).take_while(|(column, _)| *column < columns) {
                let place = &mut next[column];
                (rows[*place], values[*place]) = (row as u32, value);
                *place += 1;
            }
        }
        let columns = rows;
        Self { starts, columns, values }
    }
}

/// A column under construction.
pub(super) struct Column {
    values: Vec<f64>,
    /// The column that last used the place.
    used: Vec<u32>,
    rows: Vec<u32>,
    column: u32,
}

impl Column {
    fn add(&mut self, row: usize, value: f64) {
        if self.used[row] == self.column {
            self.values[row] += value;
        } else {
            self.used[row] = self.column;
            self.values[row] = value;
            self.rows.push(row as u32);
        }
    }

    /// Adds this column of `left^T right` at and below the diagonal, as far as there are unknowns, both entries multiplied
    /// by `multiply`; `transposed` holds `left`'s columns.
    pub(super) fn add_product<A: Copy + Send + Sync, B: Copy + Send + Sync>(
        &mut self,
        transposed: &Rows<A>,
        right: &Rows<B>,
        multiply: impl Fn(A, B) -> f64,
    ) {
        let (column, unknowns) = (self.column as usize, self.values.len());
        for (row, own) in transposed.row(column) {
            for (other, value) in right.row_from(row, column).take_while(|(other, _)| *other < unknowns) {
                self.add(other, multiply(own, value));
            }
        }
    }

    /// Adds entries of this column; those above the diagonal are left out.
    pub(super) fn add_entries(&mut self, entries: impl Iterator<Item = (usize, f64)>) {
        let range = self.column as usize..self.values.len();
        for (row, value) in entries.filter(|(row, _)| range.contains(row)) {
            self.add(row, value);
        }
    }
}

/// Columns that one task makes.
const CHUNK: usize = 4096;

/// The lower triangle of a symmetric matrix, made column by column on all threads. Each column is summed in one order, so
/// that the number of threads does not show.
///
/// `fill` adds what a column has; `go_on` is asked once before each group of columns.
pub(super) fn lower_triangle<Stop: Send>(
    unknowns: usize,
    fill: impl Fn(usize, &mut Column) + Sync,
    go_on: &dyn Fn() -> Result<(), Stop>,
) -> Result<CsMat<f64>, Stop> {
    let mut starts = vec![0_usize];
    let mut rows: Vec<usize> = Vec::new();
    let mut values: Vec<f64> = Vec::new();
    // As many at once as the threads take, so that stopping is possible in between.
    let group = CHUNK * rayon::current_num_threads().max(1);
    for first in (0..unknowns).step_by(group) {
        go_on()?;
        let chunks: Vec<usize> = (first..unknowns.min(first + group)).step_by(CHUNK).collect();
        let made: Vec<(Vec<usize>, Vec<usize>, Vec<f64>)> = chunks
            .into_par_iter()
            .map(|first| {
                let mut column =
                    Column { values: vec![0.0; unknowns], used: vec![u32::MAX; unknowns], rows: Vec::new(), column: 0 };
                let (mut counts, mut rows, mut values) = (Vec::new(), Vec::new(), Vec::new());
                for index in first..unknowns.min(first + CHUNK) {
                    column.column = index as u32;
                    column.rows.clear();
                    fill(index, &mut column);
                    column.rows.sort_unstable();
                    counts.push(column.rows.len());
                    rows.extend(column.rows.iter().map(|row| *row as usize));
                    values.extend(column.rows.iter().map(|row| column.values[*row as usize]));
                }
                (counts, rows, values)
            })
            .collect();
        for (counts, more_rows, more_values) in made {
            for count in counts {
                starts.push(starts[starts.len() - 1] + count);
            }
            rows.extend(more_rows);
            values.extend(more_values);
        }
    }
    Ok(CsMat::new_csc((unknowns, unknowns), starts, rows, values))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Rows<f64> {
        let mut rows = Rows::new();
        rows.push([(0, 1.0), (2, 2.0), (5, 9.0)]);
        rows.push([(1, -1.0), (2, 3.0)]);
        rows.push([]);
        rows
    }

    #[test]
    fn columns_as_rows() {
        let columns = sample().transposed(3);
        assert_eq!(columns.len(), 3);
        let row = |i: usize| columns.row(i).collect::<Vec<_>>();
        assert_eq!(row(0), [(0, 1.0)]);
        assert_eq!(row(2), [(0, 2.0), (1, 3.0)]);
        assert_eq!(sample().row_from(0, 1).collect::<Vec<_>>(), [(2, 2.0), (5, 9.0)]);
    }

    #[test]
    fn the_lower_triangle_of_a_square() {
        let rows = Rows::collect(vec![vec![(0, 1.0), (2, 2.0)], vec![(1, -1.0), (2, 3.0)]]);
        let columns = rows.transposed(3);
        let fill = |_: usize, column: &mut Column| {
            column.add_product(&columns, &rows, |a, b| a * b);
            column.add_entries([(0, 10.0)].into_iter());
        };
        let made = lower_triangle::<()>(3, fill, &|| Ok(())).unwrap();
        let dense = made.to_dense();
        let wanted = [[11.0, 0.0, 0.0], [0.0, 1.0, 0.0], [2.0, -3.0, 13.0]];
        for (i, row) in wanted.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                assert_eq!(dense[[i, j]], *value, "{i} {j}");
            }
        }
        assert_eq!(lower_triangle(3, fill, &|| Err("stop")).unwrap_err(), "stop");
    }
}
