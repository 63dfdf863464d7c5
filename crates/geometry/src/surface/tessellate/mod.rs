//! Meshes of analytic surfaces.

mod deviation;
mod error;
mod evaluate_grid;
mod lattice;
mod rounded;
mod spacing;
mod table;
#[cfg(test)]
mod tests;

pub use deviation::Deviation;
pub use error::TessellationError;
pub use evaluate_grid::SurfaceGrid;
pub use spacing::Spacing;

use super::analytic::{AnalyticSurface, Side, largest_distance, size};
use super::parts::MeshParts;
use super::skin::{MOST_VERTICES, strip};
use super::{analytic, cap};
use crate::mesh::Mesh;
use deviation::measure;
use lattice::Lattice;
pub(crate) use spacing::Demand;

/// How many quads a tessellation has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Density {
    /// So many rows and columns of quads, at least one row for each surface and one column between joints. With rounded
    /// caps, they are among the rows.
    Grid {
        /// Rows of quads along u.
        rows: usize,
        /// Columns of quads along v; at least 3 where the surface is closed.
        columns: usize,
    },
    /// So many rows of quads from each section to the next, with rows of vertices at the sections, and columns as with
    /// [`Density::Grid`]. Rounded caps come besides, with a row for every eight columns.
    Sections {
        /// Rows of quads between neighbouring sections, at least 1.
        rows: usize,
        /// Columns of quads along v.
        columns: usize,
    },
    /// About so many quads in all, shared between rows and columns for the least deviation; flat caps not counted.
    Quads(usize),
    /// As few as keep the surface within this distance of the mesh, metres, as [`Deviation`] measures it.
    Deviation(f64),
}

/// What closes an end of a tessellation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Closing {
    /// Nothing: the end stays open.
    #[default]
    Open,
    /// A flat lid with a hard edge. A pole is closed already, and takes none.
    Flat,
    /// A dome that goes on in the surface's tangents and ends in a round pole. A pole takes none.
    Rounded,
}

/// How surfaces are made meshes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tessellation {
    /// How many quads.
    pub density: Density,
    /// How rows and columns are spread.
    pub spacing: Spacing,
    /// What closes u = 0 of the first surface.
    pub start: Closing,
    /// What closes u = 1 of the last surface.
    pub end: Closing,
}

impl Default for Tessellation {
    fn default() -> Self {
        Self {
            density: Density::Grid { rows: 32, columns: 64 },
            spacing: Spacing::default(),
            start: Closing::default(),
            end: Closing::default(),
        }
    }
}

/// A mesh of surfaces, and what is known about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Tessellated {
    /// The mesh.
    pub mesh: Mesh,
    /// Rows of quads along u, all surfaces and rounded caps together.
    pub rows: usize,
    /// Columns of quads along v.
    pub columns: usize,
    /// How far the surface is from it; `None` for [`Density::Grid`], for which nothing is measured.
    pub deviation: Option<Deviation>,
}

/// Rounds in which a wanted deviation is approached.
const ROUNDS: usize = 12;

impl AnalyticSurface {
    /// The surface as a mesh: [`tessellate`] of it alone.
    ///
    /// # Errors
    /// As [`tessellate`].
    pub fn tessellate(&self, options: &Tessellation) -> Result<Tessellated, TessellationError> {
        tessellate(std::slice::from_ref(self), options, &|_| true)
    }
}

/// One mesh of surfaces end to end, each beginning with the section in which the last one ends; without cracks.
///
/// - **Vertices** (metres) lie on the surfaces, in rows of common v; those of a section that two surfaces share are
///   shared. A pole is one vertex with a fan of triangles.
/// - **Normals** at the corners are exact, from the tangents of the surfaces; at a shared section those of the first.
///   At a joint where sections have a corner each side has its own: an edge that stays sharp.
/// - **UVs** are shares of arc length as those of [`skin`](super::skin()): u around the section from 0 to 1, v along
///   the stack.
///
/// Work is spread over the threads of the pool it is called in; the result is the same for any number.
///
/// `progress` hears shares from 0 to 1; the tessellation stops where it returns false.
///
/// # Errors
/// [`TessellationError`] where the density is out of range, surfaces don't meet, or a cap can't be made.
pub fn tessellate(
    surfaces: &[AnalyticSurface],
    options: &Tessellation,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Tessellated, TessellationError> {
    made(surfaces, options, false, progress)
}

/// As [`tessellate`], with the deviation measured whatever the density where `measured` is wanted.
pub(crate) fn made(
    surfaces: &[AnalyticSurface],
    options: &Tessellation,
    measured: bool,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Tessellated, TessellationError> {
    asked(progress, 0.0)?;
    let patches = &with_caps(surfaces, options)?;
    let demand = Demand::new(patches, options.spacing);
    let (lattice, mut deviation) = lattice(&demand, patches, options.density, &|share| progress(0.5 * share))?;
    if measured && deviation.is_none() {
        deviation = Some(measure(patches, &lattice));
    }
    let mesh = mesh(patches, &lattice, options, &|share| progress(0.5 + 0.5 * share))?;
    Ok(Tessellated { mesh, rows: lattice.strips(), columns: lattice.cells(), deviation })
}

/// A mesh for each surface of a chain, which fit together without cracks: all have the columns of [`tessellate`], so
/// that those of a shared section have the same bits. Caps close the first and the last; rounded ones are part of their
/// meshes.
///
/// # Errors
/// As [`tessellate`].
pub fn tessellate_parts(
    surfaces: &[AnalyticSurface],
    options: &Tessellation,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Vec<Tessellated>, TessellationError> {
    asked(progress, 0.0)?;
    let patches = with_caps(surfaces, options)?;
    let demand = Demand::new(&patches, options.spacing);
    let (all, deviation) = lattice(&demand, &patches, options.density, &|share| progress(0.5 * share))?;
    let domes = usize::from(patches.len() > surfaces.len() && is_domed(&surfaces[0], options.start, Side::Start));
    let mut next = 0;
    let mut parts = Vec::with_capacity(surfaces.len());
    for index in 0..surfaces.len() {
        let last = index + 1 == surfaces.len();
        let count = if last { patches.len() - next } else { 1 + if index == 0 { domes } else { 0 } };
        let own = &patches[next..next + count];
        let lattice = Lattice { rows: all.rows[next..next + count].to_vec(), ..all.clone() };
        let closing = |side, wanted| if side { wanted } else { Closing::Open };
        let options =
            Tessellation { start: closing(index == 0, options.start), end: closing(last, options.end), ..*options };
        let done = |share: f64| progress(0.5 + 0.5 * (index as f64 + share) / surfaces.len() as f64);
        let mesh = mesh(own, &lattice, &options, &done)?;
        let deviation = deviation.map(|_| measure(own, &lattice));
        parts.push(Tessellated { mesh, rows: lattice.strips(), columns: lattice.cells(), deviation });
        next += count;
    }
    Ok(parts)
}

fn is_domed(surface: &AnalyticSurface, closing: Closing, side: Side) -> bool {
    let pole = match side {
        Side::Start => surface.is_pole(0),
        Side::End => surface.is_pole(surface.section_parameters().len() - 1),
    };
    closing == Closing::Rounded && !pole
}

/// The surfaces with rounded caps before and behind them, where those are asked for; refuses what does not fit.
pub(crate) fn with_caps(
    surfaces: &[AnalyticSurface],
    options: &Tessellation,
) -> Result<Vec<AnalyticSurface>, TessellationError> {
    let (Some(first), Some(last)) = (surfaces.first(), surfaces.last()) else {
        return Err(TessellationError::NoSurfaces);
    };
    for (index, pair) in surfaces.windows(2).enumerate() {
        meet(index, &pair[0], &pair[1])?;
    }
    for (closing, side) in [(options.start, Side::Start), (options.end, Side::End)] {
        if closing != Closing::Open && !first.is_closed() {
            return Err(TessellationError::CapOnOpenSurface { side });
        }
    }
    let mut patches = Vec::with_capacity(surfaces.len() + 2);
    if is_domed(first, options.start, Side::Start) {
        patches.push(rounded::cap(first, Side::Start)?);
    }
    patches.extend_from_slice(surfaces);
    if is_domed(last, options.end, Side::End) {
        patches.push(rounded::cap(last, Side::End)?);
    }
    Ok(patches)
}

/// Refuses two surfaces of which the second does not begin in the section in which the first ends.
fn meet(first: usize, a: &AnalyticSurface, b: &AnalyticSurface) -> Result<(), TessellationError> {
    let (Some(end), Some(start)) = (a.section_at(1.0), b.section_at(0.0)) else {
        return Err(TessellationError::Apart { first, distance: f64::INFINITY });
    };
    let common = analytic::Angles::common(&[end.segments(), start.segments()], a.is_closed());
    let distance = match common {
        Ok((angles, rows)) if a.is_closed() == b.is_closed() => {
            let (end, start) = rows.split_at(angles.lanes());
            let allowed = 1e-6 * size(&angles, end).max(1e-3 * end[0].length());
            let distance = largest_distance(&angles, end, start);
            if distance <= allowed {
                return Ok(());
            }
            distance
        }
        _ => f64::INFINITY,
    };
    Err(TessellationError::Apart { first, distance })
}

/// The lattice that a density asks for, and its deviation where it was measured.
fn lattice(
    demand: &Demand,
    patches: &[AnalyticSurface],
    density: Density,
    progress: &dyn Fn(f64) -> bool,
) -> Result<(Lattice, Option<Deviation>), TessellationError> {
    let make = |rows: usize, columns: usize| {
        let vertices = rows.saturating_add(1).saturating_mul(columns.saturating_add(1));
        if vertices > MOST_VERTICES {
            return Err(TessellationError::TooManyVertices { vertices });
        }
        Ok(demand.lattice(rows, columns))
    };
    let ratio = (demand.row_total / demand.column_total).max(1e-9);
    match density {
        Density::Grid { rows, columns } => {
            if rows == 0 || columns == 0 {
                return Err(TessellationError::NoQuads);
            }
            Ok((make(rows, columns)?, None))
        }
        Density::Sections { rows, columns } => {
            if rows == 0 || columns == 0 {
                return Err(TessellationError::NoQuads);
            }
            let gaps: usize = patches.iter().map(|patch| patch.section_parameters().len() - 1).sum();
            let lattice = make(gaps.saturating_mul(rows).saturating_add(columns / 4), columns)?;
            let between = patches.iter().map(|patch| between_sections(patch, rows, columns)).collect();
            Ok((Lattice { rows: between, ..lattice }, None))
        }
        Density::Quads(quads) => {
            if quads == 0 {
                return Err(TessellationError::NoQuads);
            }
            let rows = ((quads as f64 * ratio).sqrt().round() as usize).clamp(1, quads);
            let lattice = make(rows, (quads as f64 / rows as f64).round() as usize)?;
            let deviation = measure(patches, &lattice);
            Ok((lattice, Some(deviation)))
        }
        Density::Deviation(wanted) => {
            if !(wanted > 0.0 && wanted.is_finite()) {
                return Err(TessellationError::NoDeviation { wanted });
            }
            // Each direction takes half of it.
            let scale = 0.5 / wanted.sqrt();
            let counts = |factor: f64| {
                let count = |total: f64| (total * scale * factor).ceil().clamp(1.0, 1e9) as usize;
                (count(demand.row_total), count(demand.column_total))
            };
            let mut factor = 1.0;
            let mut best: Option<(Lattice, Deviation)> = None;
            for round in 0..ROUNDS {
                asked(progress, round as f64 / ROUNDS as f64)?;
                let (rows, columns) = counts(factor);
                let lattice = make(rows, columns)?;
                let measured = measure(patches, &lattice);
                let share = (measured.largest / wanted).sqrt();
                if measured.largest <= wanted {
                    let fewer = best
                        .as_ref()
                        .is_none_or(|(best, _)| lattice.strips() * lattice.cells() < best.strips() * best.cells());
                    let tight = share > 0.95;
                    if fewer {
                        best = Some((lattice, measured));
                    }
                    if tight || !fewer {
                        break;
                    }
                    factor *= share.max(0.5) * 1.01;
                } else {
                    if best.is_some() {
                        break;
                    }
                    factor *= share.min(8.0) * 1.02;
                }
            }
            let (lattice, deviation) = best.ok_or(TessellationError::NotReached { wanted })?;
            Ok((lattice, Some(deviation)))
        }
    }
}

/// Places of rows with so many steps between neighbouring sections; those of a dome, from a section to a pole, finer.
fn between_sections(patch: &AnalyticSurface, rows: usize, columns: usize) -> Vec<f64> {
    let knots = patch.section_parameters();
    let dome = knots.len() == 2 && (patch.is_pole(0) || patch.is_pole(1));
    let rows = if dome { rows.max(columns / 8) } else { rows };
    let step = |pair: &[f64]| {
        let (from, to) = (pair[0], pair[1]);
        (0..rows).map(move |row| from + (to - from) * row as f64 / rows as f64).collect::<Vec<_>>()
    };
    knots.windows(2).flat_map(step).chain(knots.last().copied()).collect()
}

/// The mesh of a lattice, its flat caps with it.
fn mesh(
    patches: &[AnalyticSurface],
    lattice: &Lattice,
    options: &Tessellation,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Mesh, TessellationError> {
    asked(progress, 0.0)?;
    let mut grid = lattice.sample(patches);
    asked(progress, 0.4)?;
    let mut parts = MeshParts { positions: std::mem::take(&mut grid.positions), ..MeshParts::default() };
    parts.reserve((grid.rows() - 1) * grid.cells);
    for row in 0..grid.rows() - 1 {
        asked(progress, 0.4 + 0.4 * row as f64 / grid.rows() as f64)?;
        strip(&mut parts, &grid, row);
    }
    let last = grid.rows() - 1;
    for (side, row, closing) in [(Side::Start, 0, options.start), (Side::End, last, options.end)] {
        if closing == Closing::Flat && !grid.is_pole(row) {
            let mut rim: Vec<u32> = (0..grid.columns).map(|column| grid.vertex(row, column)).collect();
            if side == Side::Start {
                rim.reverse();
            }
            cap::flat(&mut parts, &rim).map_err(|cap::NoArea| TessellationError::CapWithoutArea { side })?;
        }
    }
    let mesh = parts.finish()?;
    asked(progress, 1.0)?;
    Ok(mesh)
}

fn asked(progress: &dyn Fn(f64) -> bool, done: f64) -> Result<(), TessellationError> {
    if progress(done) { Ok(()) } else { Err(TessellationError::Cancelled) }
}
