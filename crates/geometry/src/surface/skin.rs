//! A surface of quads through a stack of sections.

use glam::DVec2;

use super::beside::Beside;
use super::grid::{self, Extent, Grid};
use super::parts::{Corner, MeshParts};
use super::{PoleShape, UParameter, cap};
use crate::mesh::{Mesh, MeshError};
use crate::sections::Sections;

/// What closes an end of the stack.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cap {
    /// Nothing: the end stays open.
    #[default]
    None,
    /// A flat lid with a hard edge. A pole is closed already, and takes none.
    Flat,
}

/// How [`skin`] makes its surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SkinOptions {
    /// Quads between neighbouring sections, 1 to 64.
    pub rows: usize,
    /// Quads between neighbouring points of a section, 1 to 64.
    pub columns: usize,
    /// What closes the first section.
    pub cap_start: Cap,
    /// What closes the last section.
    pub cap_end: Cap,
    /// How the knots of the splines are spaced.
    pub parameter: UParameter,
    /// The shape of the surface at a first or last section that is a pole.
    pub pole: PoleShape,
}

impl Default for SkinOptions {
    fn default() -> Self {
        Self {
            rows: 4,
            columns: 2,
            cap_start: Cap::None,
            cap_end: Cap::None,
            parameter: UParameter::default(),
            pole: PoleShape::default(),
        }
    }
}

/// Vertices of the largest surface that [`skin`] makes.
pub const MOST_VERTICES: usize = 50_000_000;

/// Why sections do not make a surface.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SkinError {
    /// Another number of directions than of points.
    #[error("{found} directions given at the {border}, and it has {needed} points")]
    Directions {
        /// Which border of the skin.
        border: &'static str,
        /// Directions given.
        found: usize,
        /// Its points; none at the sides of closed sections.
        needed: usize,
    },
    /// Too few or too many quads between sections or points.
    #[error("{value} {what} asked for between neighbours: give 1 to 64")]
    OutOfRange {
        /// "rows" or "columns".
        what: &'static str,
        /// The number given.
        value: usize,
    },
    /// All points of all sections are one point.
    #[error("all points of all sections coincide: a surface needs sections of some size, at some distance")]
    CoincidentPoints,
    /// Coordinates beyond all use, at which the arithmetic would overflow.
    #[error("a coordinate of the sections is {coordinate:e} m, more than 1e100 m: scale them down")]
    TooLarge {
        /// The coordinate of the largest size, metres.
        coordinate: f64,
    },
    /// Two neighbouring sections without any distance between them.
    #[error("sections {first} and {second} are identical, and no surface lies between them: move or remove one")]
    IdenticalSections {
        /// Index of the first section, counted from 0.
        first: usize,
        /// Index of the second.
        second: usize,
    },
    /// Two neighbouring sections that are both poles.
    #[error("sections {first} and {second} are each a single point, and no surface lies between them: remove one")]
    NeighbouringPoles {
        /// Index of the first section, counted from 0.
        first: usize,
        /// Index of the second.
        second: usize,
    },
    /// A cap asked for where the sections are no loops.
    #[error("section {section} is an open curve and has no inside to cap: close the sections, or set its cap to none")]
    CapOnOpenSection {
        /// Index of the section, counted from 0.
        section: usize,
    },
    /// A cap asked for on a loop that encloses nothing.
    #[error("section {section} encloses no area and cannot be capped: widen it, make it a point, or set no cap")]
    CapWithoutArea {
        /// Index of the section, counted from 0.
        section: usize,
    },
    /// A surface beyond [`MOST_VERTICES`].
    #[error(
        "the surface would have {vertices} vertices, more than {MOST_VERTICES}: lower rows, columns or the number \
             of sections or of their points"
    )]
    TooManyVertices {
        /// Vertices it would have.
        vertices: usize,
    },
    /// The progress function said to stop.
    #[error("cancelled")]
    Cancelled,
    /// The vertices and polygons made no mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// Makes a mesh of quads through all points of all sections.
///
/// The surface is the bicubic spline through the net of points: C2, along the stack with natural ends, across it
/// periodic for closed sections and natural for open ones, with the knots of [`UParameter`]. It interpolates: the
/// points of the sections are vertices to the bit. Reference: skinning of thesis chapter 4, with a C2 cubic spline in u
/// instead of the polynomial of eq. 4.3, which swings for more than about 8 sections and is damped here 3.7 times a
/// section.
///
/// - **Vertices** (metres) come row after row, each row in the order of its section's points; closed sections share the
///   vertices of the seam. A section that is a pole is one vertex, with a fan of triangles to the next row.
/// - **Normals** at the corners are the cross product of the derivatives across and along. They face outwards where
///   sections run counter-clockwise about the direction of stacking, and so do the polygons. Where the derivatives
///   are parallel (a pinched section, a pointed pole) a corner has the normal of its polygon.
/// - **UVs** at the corners are shares of the arc length: u around the section from 0 to 1 (1 at the far side of the
///   seam), v along the stack. Caps have their outline in the unit square.
///
/// `progress` hears shares from 0 to 1; the skin stops where it returns false.
///
/// # Errors
/// [`SkinError`] where options are out of range, sections coincide, or a cap is asked for that cannot be made.
pub fn skin(sections: &Sections, options: &SkinOptions, progress: &dyn Fn(f64) -> bool) -> Result<Mesh, SkinError> {
    skin_beside(sections, options, &Beside::default(), progress)
}

/// The same between other surfaces, which it continues: at the borders for which directions are given, the slope of the
/// spline across them is turned into the neighbour's tangent plane (thesis 4.5 to 4.11), in the place of its natural end.
/// The normals there are the neighbour's. An end that is a round pole keeps its shape, and so does one of two sections.
///
/// # Errors
/// As [`skin`], and where there is another number of directions than of points.
pub fn skin_beside(
    sections: &Sections,
    options: &SkinOptions,
    beside: &Beside<'_>,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Mesh, SkinError> {
    let poles = check(sections, options)?;
    if let Some((border, found, needed)) = beside.misfit(sections) {
        return Err(SkinError::Directions { border, found, needed });
    }
    let mut grid = grid::sample(sections, &poles, options, beside, &|done| progress(0.6 * done))?;
    let mut parts = MeshParts { positions: std::mem::take(&mut grid.positions), ..MeshParts::default() };
    parts.reserve((grid.rows() - 1) * grid.cells);
    let asked = |done: f64| if progress(done) { Ok(()) } else { Err(SkinError::Cancelled) };
    for row in 0..grid.rows() - 1 {
        asked(0.6 + 0.3 * row as f64 / grid.rows() as f64)?;
        strip(&mut parts, &grid, row);
    }
    let last = sections.len() - 1;
    for (section, row, asked) in [(0, 0, options.cap_start), (last, grid.rows() - 1, options.cap_end)] {
        if asked == Cap::Flat && !poles[section] {
            let mut rim: Vec<u32> = (0..grid.columns).map(|column| grid.vertex(row, column)).collect();
            if section == 0 {
                rim.reverse();
            }
            cap::flat(&mut parts, &rim).map_err(|cap::NoArea| SkinError::CapWithoutArea { section })?;
        }
    }
    asked(0.9)?;
    let mesh = parts.finish()?;
    asked(1.0)?;
    Ok(mesh)
}

/// Refuses what makes no surface, and says which sections are poles.
fn check(sections: &Sections, options: &SkinOptions) -> Result<Vec<bool>, SkinError> {
    for (what, value) in [("rows", options.rows), ("columns", options.columns)] {
        if !(1..=64).contains(&value) {
            return Err(SkinError::OutOfRange { what, value });
        }
    }
    let coordinate = sections.points().iter().fold(0.0, |size: f64, p| size.max(p.abs().max_element()));
    if coordinate > 1e100 {
        return Err(SkinError::TooLarge { coordinate });
    }
    // Smaller than this, squared lengths underflow.
    let diagonal = sections.diagonal();
    if diagonal < 1e-100 {
        return Err(SkinError::CoincidentPoints);
    }
    // As Sections::is_pole, which would measure the diagonal again for each section.
    let poles: Vec<bool> =
        sections.iter().map(|row| row.iter().all(|p| p.distance(row[0]) <= 1e-9 * diagonal)).collect();
    let last = sections.len() - 1;
    for first in 0..last {
        let second = first + 1;
        let mut pairs = sections.section(first).iter().zip(sections.section(second));
        if pairs.all(|(a, b)| a.distance(*b) <= 1e-12 * diagonal) {
            return Err(SkinError::IdenticalSections { first, second });
        }
        if poles[first] && poles[second] {
            return Err(SkinError::NeighbouringPoles { first, second });
        }
    }
    for (section, asked) in [(0, options.cap_start), (last, options.cap_end)] {
        if asked == Cap::Flat && !sections.is_closed() {
            return Err(SkinError::CapOnOpenSection { section });
        }
    }
    let vertices = Extent::new(sections, options).vertices();
    if vertices > MOST_VERTICES { Err(SkinError::TooManyVertices { vertices }) } else { Ok(poles) }
}

/// The polygons between a row of vertices and the next one.
pub(crate) fn strip(parts: &mut MeshParts, grid: &Grid, row: usize) {
    let corner = |row: usize, column: usize, u: f64| -> Corner {
        let vertex = grid.vertex(row, column);
        (vertex, grid.normals[vertex as usize], DVec2::new(u, grid.along[row]))
    };
    let (low, high) = (row, row + 1);
    let (low_tip, high_tip) = (grid.is_pole(low), grid.is_pole(high));
    let (mut low_left, mut high_left) = (corner(low, 0, 0.0), corner(high, 0, 0.0));
    for k in 0..grid.cells {
        let (left, right) = (grid.across[k], grid.across[k + 1]);
        let next = if k + 1 == grid.columns { 0 } else { k + 1 };
        let (mut low_right, mut high_right) = (corner(low, next, right), corner(high, next, right));
        let after = (low_right, high_right);
        if let Some(crease) = grid.creases.iter().find(|crease| crease.column == next) {
            (low_right.1, high_right.1) = (crease.normals[low], crease.normals[high]);
        }
        let middle = 0.5 * (left + right);
        if low_tip {
            parts.polygon([corner(low, 0, middle), high_right, high_left]);
        } else if high_tip {
            parts.polygon([low_left, low_right, corner(high, 0, middle)]);
        } else {
            parts.polygon([low_left, low_right, high_right, high_left]);
        }
        (low_left, high_left) = after;
    }
}
