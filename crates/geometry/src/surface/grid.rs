//! The sampled surface of a skin: rows of vertices with normals, and the coordinates of the net.

use glam::DVec3;

use super::beside::{self, Beside};
use super::knots;
use super::pole::{self, PoleShape, RoundPole};
use super::skin::{SkinError, SkinOptions};
use super::spline::{End, Ends, Hermite, SlopeSystem};
use crate::sections::Sections;

/// Vertices row after row. A row at a pole has a single vertex.
pub(crate) struct Grid {
    pub positions: Vec<DVec3>,
    /// Unit normal of each vertex, or zero where the surface has none.
    pub normals: Vec<DVec3>,
    /// First vertex of each row, and behind the last one the number of vertices.
    pub starts: Vec<usize>,
    /// Vertices of a row that is not a pole.
    pub columns: usize,
    /// Quads of a row.
    pub cells: usize,
    /// Mean share of arc length in 0..=1 before each column, one more than there are cells.
    pub across: Vec<f64>,
    /// The same before each row.
    pub along: Vec<f64>,
    /// Columns in which the surface has an edge, ascending.
    pub creases: Vec<Crease>,
}

/// A column in which the surface has an edge: the normals on its nearer side, where those of the grid are the other
/// side's.
pub(crate) struct Crease {
    pub column: usize,
    /// A normal for each row.
    pub normals: Vec<DVec3>,
}

impl Grid {
    /// Vertex in a row at a column; a pole has all columns in one vertex.
    pub fn vertex(&self, row: usize, column: usize) -> u32 {
        // The number of vertices is limited far below 2^32.
        let place = if self.is_pole(row) { 0 } else { column };
        (self.starts[row] + place) as u32
    }

    pub fn is_pole(&self, row: usize) -> bool {
        self.starts[row + 1] - self.starts[row] == 1
    }

    pub fn rows(&self) -> usize {
        self.starts.len() - 1
    }
}

/// Rows and columns of a grid, and its number of vertices.
pub(crate) struct Extent {
    pub rows: usize,
    pub columns: usize,
    pub cells: usize,
}

impl Extent {
    pub fn new(sections: &Sections, options: &SkinOptions) -> Self {
        let spans = if sections.is_closed() { sections.nodes() } else { sections.nodes() - 1 };
        let cells = spans.saturating_mul(options.columns);
        let rows = (sections.len() - 1).saturating_mul(options.rows).saturating_add(1);
        Self { rows, cells, columns: if sections.is_closed() { cells } else { cells.saturating_add(1) } }
    }

    pub fn vertices(&self) -> usize {
        self.rows.saturating_mul(self.columns)
    }
}

/// A quantity given at each section, on all columns of the grid, with its derivative across.
struct Dense {
    value: Vec<DVec3>,
    derivative: Vec<DVec3>,
}

/// Samples the bicubic spline through all points.
pub(crate) fn sample(
    sections: &Sections,
    poles: &[bool],
    options: &SkinOptions,
    beside: &Beside<'_>,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Grid, SkinError> {
    let Extent { rows, columns, cells } = Extent::new(sections, options);
    let (count, nodes, closed) = (sections.len(), sections.nodes(), sections.is_closed());
    let points = sections.points();
    let intervals = knots::along(sections, options.parameter);
    let tips = round_poles(sections, poles, options, &intervals);

    let mut slopes = vec![DVec3::ZERO; points.len()];
    if let Some(tip) = &tips[0] {
        slopes[..nodes].copy_from_slice(&tip.slopes);
    }
    if let Some(tip) = &tips[1] {
        for (slope, outward) in slopes[(count - 1) * nodes..].iter_mut().zip(&tip.slopes) {
            *slope = -*outward;
        }
    }
    let given = |slope: bool| if slope { End::Slope } else { End::Natural };
    let open = |[start, end]: [bool; 2]| Ends::Open { start: given(start), end: given(end) };
    let tipped = [tips[0].is_some(), tips[1].is_some()];
    let mut system = SlopeSystem::new(intervals, open(tipped));
    system.solve(points, &mut slopes, nodes);

    let asked = |done: f64| if progress(done) { Ok(()) } else { Err(SkinError::Cancelled) };
    asked(0.0)?;
    let knots = knots::across(sections, options.parameter, poles);
    let across = SlopeSystem::new(knots.clone(), if closed { Ends::Periodic } else { open([false; 2]) });
    let end_normals = [0, 1].map(|end| {
        let directions = beside.ends[end].filter(|_| !tipped[end] && count > 2)?;
        Some(beside::normals(sections.section(end * (count - 1)), closed, directions))
    });
    if end_normals.iter().any(Option::is_some) {
        for (end, normals) in end_normals.iter().enumerate() {
            let row = |k: usize| if end == 0 { k } else { count - 1 - k };
            let gaps = [0, 1].map(|k| if count > 2 { system.intervals()[row(k).min(row(k + 1))] } else { 1.0 });
            for (j, normal) in normals.iter().flatten().enumerate() {
                let slope = beside::leaving([0, 1, 2].map(|k| points[row(k) * nodes + j]), gaps);
                let slope = if end == 0 { slope } else { -slope };
                slopes[row(0) * nodes + j] = beside::turned_into(slope, *normal);
            }
        }
        let fixed = [0, 1].map(|end| tipped[end] || end_normals[end].is_some());
        system = SlopeSystem::new(system.intervals().to_vec(), open(fixed));
        system.solve(points, &mut slopes, nodes);
    }
    let side_normals = [0, 1].map(|side| {
        let directions = beside.sides[side].filter(|_| !closed && nodes > 2)?;
        let edge: Vec<DVec3> = sections.iter().map(|section| section[side * (nodes - 1)]).collect();
        Some(beside::normals(&edge, false, directions))
    });
    let point = if side_normals.iter().all(Option::is_none) {
        spread(points, &across, nodes, options.columns, [&[], &[]])
    } else {
        let slopes_at = [0, 1].map(|side| -> Vec<DVec3> {
            let column = |k: usize| if side == 0 { k } else { nodes - 1 - k };
            let gaps = [0, 1].map(|k| knots[column(k).min(column(k + 1))]);
            let turned = |(row, normal): (usize, &DVec3)| {
                let slope = beside::leaving([0, 1, 2].map(|k| points[row * nodes + column(k)]), gaps);
                beside::turned_into(if side == 0 { slope } else { -slope }, *normal)
            };
            side_normals[side].iter().flatten().enumerate().map(turned).collect()
        });
        let leaving = SlopeSystem::new(knots, open([0, 1].map(|side| side_normals[side].is_some())));
        spread(points, &leaving, nodes, options.columns, [&slopes_at[0], &slopes_at[1]])
    };
    asked(0.05)?;
    let slope = spread(&slopes, &across, nodes, options.columns, [&[], &[]]);

    let tip_normals = [tips[0].as_ref().map(|t| -t.axis), tips[1].as_ref().map(|t| t.axis)];
    let mut positions = Vec::with_capacity(rows * columns);
    let mut normals = Vec::with_capacity(rows * columns);
    let mut starts = Vec::with_capacity(rows + 1);
    for row in 0..rows {
        let (section, step) = (row / options.rows, row % options.rows);
        if step == 0 {
            asked(0.1 + 0.9 * row as f64 / rows as f64)?;
        }
        starts.push(positions.len());
        if step == 0 && poles[section] {
            positions.push(sections.section(section)[0]);
            let tip = if section == 0 { tip_normals[0] } else { tip_normals[1] };
            let outer = section == 0 || section + 1 == count;
            normals.push(tip.filter(|_| outer).unwrap_or_default());
            continue;
        }
        // The last row is the end of the last interval.
        let (gap, t) =
            if section + 1 == count { (section - 1, 1.0) } else { (section, step as f64 / options.rows as f64) };
        let weights = Hermite::new(t, system.intervals()[gap]);
        let (a, b) = (gap * columns..(gap + 1) * columns, (gap + 1) * columns..(gap + 2) * columns);
        let (pa, pb, ma, mb) =
            (&point.value[a.clone()], &point.value[b.clone()], &slope.value[a.clone()], &slope.value[b.clone()]);
        let (da, db, na, nb) =
            (&point.derivative[a.clone()], &point.derivative[b.clone()], &slope.derivative[a], &slope.derivative[b]);
        if step == 0 {
            // Not computed, so that the surface meets the sections to the bit.
            positions.extend_from_slice(&point.value[section * columns..(section + 1) * columns]);
        } else {
            positions.extend((0..columns).map(|k| Hermite::sum(&weights.value, pa[k], ma[k], pb[k], mb[k])));
        }
        normals.extend((0..columns).map(|k| {
            let across = Hermite::sum(&weights.value, da[k], na[k], db[k], nb[k]);
            let along = Hermite::sum(&weights.derivative, pa[k], ma[k], pb[k], mb[k]);
            unit_normal(across, along)
        }));
    }
    starts.push(positions.len());
    // Shared knots leave the tangents along an edge a little off it, and with them the normals computed above.
    let mut given = |vertex: usize, normal: DVec3| {
        if normal != DVec3::ZERO && normals[vertex] != DVec3::ZERO {
            normals[vertex] = normal * normal.dot(normals[vertex]).signum();
        }
    };
    let section_starts = |section: usize| starts[section * options.rows];
    for (side, edge) in side_normals.iter().enumerate() {
        for (section, normal) in edge.iter().flatten().enumerate().filter(|(section, _)| !poles[*section]) {
            given(section_starts(section) + side * (columns - 1), *normal);
        }
    }
    for (end, edge) in end_normals.iter().enumerate().filter(|(end, _)| !poles[*end * (count - 1)]) {
        for (j, normal) in edge.iter().flatten().enumerate() {
            given(section_starts(end * (count - 1)) + j * options.columns, *normal);
        }
    }
    let across = shares_across(&point.value, columns, cells);
    let mut grid = Grid { positions, normals, starts, columns, cells, across, along: Vec::new(), creases: Vec::new() };
    grid.along = shares_along(&grid, options.columns);
    Ok(grid)
}

/// The tangent planes at the first and the last section, where they are round poles.
fn round_poles(
    sections: &Sections,
    poles: &[bool],
    options: &SkinOptions,
    intervals: &[f64],
) -> [Option<RoundPole>; 2] {
    let last = sections.len() - 1;
    [(0, 1, 0), (last, last - 1, last - 1)].map(|(tip, ring, gap)| {
        if !poles[tip] || options.pole == PoleShape::Pointed {
            return None;
        }
        pole::round(sections.section(tip)[0], sections.section(ring), sections.is_closed(), intervals[gap])
    })
}

/// Evaluates the splines across at `steps` places between neighbouring points. Slopes at the ends are those given, one a
/// section, where the system is made for that.
fn spread(values: &[DVec3], system: &SlopeSystem, nodes: usize, steps: usize, given: [&[DVec3]; 2]) -> Dense {
    let spans = system.intervals().len();
    let rows = values.len() / nodes;
    let mut slopes = vec![DVec3::ZERO; nodes];
    let capacity = rows * (spans * steps + 1);
    let mut dense = Dense { value: Vec::with_capacity(capacity), derivative: Vec::with_capacity(capacity) };
    let weights: Vec<Hermite> = system
        .intervals()
        .iter()
        .flat_map(|h| (1..steps).map(|step| Hermite::new(step as f64 / steps as f64, *h)))
        .collect();
    for (row, values) in values.chunks_exact(nodes).enumerate() {
        for (place, given) in [0, nodes - 1].into_iter().zip(given) {
            if let Some(slope) = given.get(row) {
                slopes[place] = *slope;
            }
        }
        system.solve(values, &mut slopes, 1);
        for j in 0..nodes {
            dense.value.push(values[j]);
            dense.derivative.push(slopes[j]);
            if j == spans {
                continue;
            }
            let next = if j + 1 == nodes { 0 } else { j + 1 };
            for weights in &weights[j * (steps - 1)..(j + 1) * (steps - 1)] {
                let sum = |weights| Hermite::sum(weights, values[j], slopes[j], values[next], slopes[next]);
                dense.value.push(sum(&weights.value));
                dense.derivative.push(sum(&weights.derivative));
            }
        }
    }
    dense
}

/// Unit normal of two tangents, or zero where they are parallel.
pub(crate) fn unit_normal(across: DVec3, along: DVec3) -> DVec3 {
    let normal = across.cross(along);
    let square = normal.length_squared();
    if square > 1e-24 * across.length_squared() * along.length_squared() { normal / square.sqrt() } else { DVec3::ZERO }
}

pub(crate) fn shares_across(points: &[DVec3], columns: usize, cells: usize) -> Vec<f64> {
    let mut lengths = vec![0.0; cells];
    for row in points.chunks_exact(columns) {
        for (k, length) in lengths.iter_mut().enumerate() {
            *length += row[k].distance(row[if k + 1 == columns { 0 } else { k + 1 }]);
        }
    }
    shares(&lengths)
}

/// Measured at the columns through the given points only.
pub(crate) fn shares_along(grid: &Grid, step: usize) -> Vec<f64> {
    let length = |row: usize| {
        let point = |row: usize, column: usize| grid.positions[grid.vertex(row, column) as usize];
        (0..grid.columns).step_by(step).map(|column| point(row, column).distance(point(row + 1, column))).sum()
    };
    shares(&(0..grid.rows() - 1).map(length).collect::<Vec<f64>>())
}

/// Running sums from 0 to exactly 1.
fn shares(lengths: &[f64]) -> Vec<f64> {
    let total: f64 = lengths.iter().sum();
    let mut sum = 0.0;
    let mut shares = Vec::with_capacity(lengths.len() + 1);
    shares.push(0.0);
    for length in lengths {
        sum += length;
        shares.push(f64::min(sum / total, 1.0));
    }
    if let Some(last) = shares.last_mut() {
        *last = 1.0;
    }
    shares
}
