//! Coarser and finer versions of analytic surfaces, each with its measured distance from the exact ones.

use glam::DVec3;
use rayon::prelude::*;

use super::analytic::{AnalyticSurface, SurfaceError};
use super::tessellate::{Demand, Density, Deviation, Tessellated, Tessellation, TessellationError};
use super::tessellate::{made, with_caps};
use crate::mesh::{MeshDistance, distance::NoPolygons};

/// One level of detail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// How many quads, or how far the mesh may be from the exact surface; whatever is left out besides counts in that.
    pub density: Density,
    /// Harmonics of the sections, where fewer are wanted: [`AnalyticSurface::with_harmonics`].
    pub harmonics: Option<usize>,
    /// Sections of each surface, where fewer are wanted: [`AnalyticSurface::with_sections`].
    pub sections: Option<usize>,
}

impl Level {
    /// The level of the whole surface with this density.
    pub fn of(density: Density) -> Self {
        Self { density, harmonics: None, sections: None }
    }
}

/// A level made.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelOfDetail {
    /// The mesh, with rows and columns.
    pub tessellated: Tessellated,
    /// The largest measured distance of the exact surfaces from the mesh.
    pub deviation: Deviation,
    /// Numbers that determine the surfaces of this level: [`AnalyticSurface::constants`].
    pub constants: usize,
}

/// Why a level can't be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LevelError {
    /// Too much left out for the wanted deviation.
    #[error(
        "level {level} is {reached:.2e} m from the exact surface with the harmonics or sections asked for, and {wanted:.2e} \
         m is wanted: leave out fewer, or allow more"
    )]
    TooFar {
        /// Index of the level, counted from 0.
        level: usize,
        /// The least deviation that was reached, metres.
        reached: f64,
        /// The deviation wanted, metres.
        wanted: f64,
    },
    /// Fewer harmonics or sections than the surfaces can have.
    #[error("level {level}: {error}")]
    Surface {
        /// Index of the level, counted from 0.
        level: usize,
        /// What is wrong with it.
        error: SurfaceError,
    },
    /// No mesh.
    #[error("level {level}: {error}")]
    Tessellation {
        /// Index of the level, counted from 0.
        level: usize,
        /// What is wrong with it.
        error: TessellationError,
    },
    /// A mesh without polygons has no distance.
    #[error(transparent)]
    Empty(#[from] NoPolygons),
}

/// Shares of a wanted deviation left to the mesh, tried in turn, where harmonics or sections are left out.
const SHARES: [f64; 4] = [0.7, 0.4, 0.2, 0.1];

/// Rows and columns of the net of points by which a level with fewer harmonics or sections is measured, at most.
const NET: usize = 256;

/// Makes each level of a chain of surfaces as one mesh ([`tessellate`](super::tessellate::tessellate())); spacing and caps are those of `options`.
///
/// The deviation of a level of the surfaces themselves is the tessellation's. With harmonics or sections left out it is
/// the largest distance from points of the exact surfaces to the nearest point of the level's mesh: a net of four times
/// its rows and columns, at most 256 by 256.
///
/// `progress` hears shares from 0 to 1; the work stops where it returns false.
///
/// # Errors
/// [`LevelError`], naming the level.
pub fn levels(
    surfaces: &[AnalyticSurface],
    options: &Tessellation,
    levels: &[Level],
    progress: &dyn Fn(f64) -> bool,
) -> Result<Vec<LevelOfDetail>, LevelError> {
    let level = |(index, level): (usize, &Level)| {
        let done = |share: f64| progress((index as f64 + share) / levels.len() as f64);
        make(surfaces, options, index, *level, &done)
    };
    levels.iter().enumerate().map(level).collect()
}

fn make(
    surfaces: &[AnalyticSurface],
    options: &Tessellation,
    level: usize,
    wanted: Level,
    progress: &dyn Fn(f64) -> bool,
) -> Result<LevelOfDetail, LevelError> {
    let reduced = |surface: &AnalyticSurface| {
        let surface = wanted.harmonics.map_or_else(|| Ok(surface.clone()), |count| surface.with_harmonics(count))?;
        wanted.sections.map_or_else(|| Ok(surface.clone()), |count| surface.with_sections(count))
    };
    let own: Vec<AnalyticSurface> =
        surfaces.iter().map(reduced).collect::<Result<_, _>>().map_err(|error| LevelError::Surface { level, error })?;
    let constants = own.iter().map(AnalyticSurface::constants).sum();
    let whole = own == surfaces;
    let meshed = |density: Density| {
        let density = &Tessellation { density, ..*options };
        let made = made(&own, density, whole, progress).map_err(|error| LevelError::Tessellation { level, error })?;
        let deviation = match made.deviation {
            Some(deviation) if whole => deviation,
            _ => from_exact(surfaces, options, &made).map_err(|error| match error {
                Failure::Tessellation(error) => LevelError::Tessellation { level, error },
                Failure::Empty(error) => error.into(),
            })?,
        };
        Ok::<_, LevelError>(LevelOfDetail { tessellated: made, deviation, constants })
    };
    let Density::Deviation(most) = wanted.density else { return meshed(wanted.density) };
    if whole {
        return meshed(wanted.density);
    }
    let mut reached = f64::INFINITY;
    for share in SHARES {
        let made = meshed(Density::Deviation(share * most))?;
        if made.deviation.largest <= most {
            return Ok(made);
        }
        reached = reached.min(made.deviation.largest);
    }
    Err(LevelError::TooFar { level, reached, wanted: most })
}

enum Failure {
    Tessellation(TessellationError),
    Empty(NoPolygons),
}

/// The largest distance from the exact surfaces to a mesh.
fn from_exact(surfaces: &[AnalyticSurface], options: &Tessellation, made: &Tessellated) -> Result<Deviation, Failure> {
    let patches = with_caps(surfaces, options).map_err(Failure::Tessellation)?;
    let lattice = Demand::new(&patches, options.spacing).lattice((4 * made.rows).min(NET), (4 * made.columns).min(NET));
    let distance = MeshDistance::new(&made.mesh).map_err(Failure::Empty)?;
    let places: Vec<(usize, f64)> = lattice.stations();
    let of_row = |(surface, u): &(usize, f64)| {
        let mut worst = Deviation { surface: *surface, u: *u, ..Deviation::default() };
        for v in &lattice.columns {
            let point: DVec3 = patches[*surface].evaluate(*u, *v).position;
            let away = distance.nearest(point).distance;
            if away > worst.largest {
                (worst.largest, worst.v) = (away, *v);
            }
        }
        worst
    };
    let found: Vec<Deviation> = places.par_iter().map(of_row).collect();
    Ok(found.into_iter().fold(Deviation::default(), |a, b| if b.largest > a.largest { b } else { a }))
}
