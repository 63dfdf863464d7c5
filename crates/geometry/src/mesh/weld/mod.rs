//! Parts of a body welded into one mesh along their equal boundaries, and their seams checked.
//!
//! The order of work: open loops that are equal are matched whole (`matching`), then what is left vertex by vertex;
//! matched vertices become one, normals are averaged where the seam is smooth (`seam`), and what still does not meet
//! is looked for (`junction`).

mod boundary;
mod junction;
mod matching;
mod report;
mod seam;
#[cfg(test)]
mod tests;

pub use junction::TJunction;
pub use report::{WeldError, WeldWarning};
pub use seam::Seam;

use glam::DVec3;

use super::topology::Topology;
use super::{Mesh, TransformError, join_while};
use boundary::Boundary;

/// How parts are welded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeldOptions {
    /// Vertices of open edges of different parts that are no farther apart become one, metres; 0 to 1000.
    pub tolerance: f64,
    /// Largest angle between the normals of two parts at which a seam is smooth, degrees; 0 to 180.
    pub smooth_degrees: f64,
}

impl Default for WeldOptions {
    /// A tenth of a millimetre, and 30 degrees.
    fn default() -> Self {
        Self { tolerance: 1e-4, smooth_degrees: 30.0 }
    }
}

/// Parts as one mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Welded {
    /// The mesh. Vertices are those of the parts in order, welded ones at the place of the first of them; polygons those
    /// of the parts in order.
    pub mesh: Mesh,
    /// Where parts meet, in the order of the parts.
    pub seams: Vec<Seam>,
    /// Open loops that are left.
    pub open_loops: usize,
    /// Vertices that lie within an open edge of another part.
    pub t_junctions: Vec<TJunction>,
    /// What should be looked at.
    pub warnings: Vec<WeldWarning>,
}

/// Welds parts along equal boundaries.
///
/// Open loops of two parts with the same number of vertices are matched where, run against each other, all their vertices
/// are within the tolerance; of several ways the one with the least squares counts. What is left is welded vertex by
/// vertex, the nearest first, never two of one part. Welded vertices stand at their mean. Vertices that are no ends of
/// open edges are never touched, and parts are not welded with themselves.
///
/// Normals at a welded vertex become the mean over the parts, equally weighted, of those that are within the angle; a
/// harder edge stays. Parts without normals get those of their faces where another part has normals.
///
/// # Errors
/// [`WeldError`] where there is no part, an option is out of range or there are too many vertices.
pub fn weld(parts: &[&Mesh], options: &WeldOptions) -> Result<Welded, WeldError> {
    weld_while(parts, options, &|_| true)
}

/// The same, calling `progress` with the share that is done.
///
/// # Errors
/// As [`weld`], and [`WeldError::Stopped`] where `progress` answers `false`.
pub fn weld_while(parts: &[&Mesh], options: &WeldOptions, progress: &dyn Fn(f64) -> bool) -> Result<Welded, WeldError> {
    let told = |share: f64| if progress(share) { Ok(()) } else { Err(WeldError::Stopped) };
    told(0.0)?;
    if parts.is_empty() {
        return Err(WeldError::Nothing);
    }
    if !(0.0..=1000.0).contains(&options.tolerance) {
        return Err(WeldError::Tolerance { found: options.tolerance });
    }
    if !(0.0..=180.0).contains(&options.smooth_degrees) {
        return Err(WeldError::Smooth { found: options.smooth_degrees });
    }
    let joined = match join_while(parts.iter().copied(), &|done| progress(0.1 * done)) {
        Err(TransformError::Stopped) => return Err(WeldError::Stopped),
        Err(TransformError::Mesh(error)) => return Err(error.into()),
        // Of a transform, which there is none.
        Err(TransformError::NotFinite | TransformError::Singular) => return Err(WeldError::Nothing),
        Ok(joined) => joined,
    };
    let boundary = Boundary::of(parts, &|| told(0.1))?;
    let matched = matching::matched(&joined, &boundary, options.tolerance, &|| told(0.3))?;
    let mut warnings = matched.warnings;

    let old = joined.positions();
    let mut positions = Vec::with_capacity(old.len());
    let mut new = vec![0_u32; old.len()];
    let (mut first, mut sums) = (vec![u32::MAX; old.len()], Vec::<(DVec3, f64)>::new());
    for (vertex, &root) in matched.root.iter().enumerate() {
        let root = root as usize;
        if first[root] == u32::MAX {
            first[root] = positions.len() as u32;
            positions.push(old[vertex]);
            sums.push((DVec3::ZERO, 0.0));
        }
        new[vertex] = first[root];
        let sum = &mut sums[first[root] as usize];
        *sum = (sum.0 + old[vertex], sum.1 + 1.0);
    }
    for (position, (sum, count)) in positions.iter_mut().zip(sums) {
        if count > 1.0 {
            *position = sum / count;
        }
    }
    told(0.5)?;
    let corners = joined.corners().iter().map(|vertex| new[*vertex as usize]).collect();
    let mut mesh = Mesh::from_corners(positions, corners, joined.polygons().map(<[u32]>::len))?
        .named(joined.name())
        .named_like(&joined);
    told(0.6)?;
    let (seams, normals) = seam::seams(&joined, &mesh, &boundary, &matched.pairs, options, &|| told(0.6))?;
    if let Some(normals) = normals {
        mesh = mesh.with_normals(normals)?;
    }
    if let Some(uvs) = joined.uvs() {
        mesh = mesh.with_uvs(uvs.to_vec())?;
    }
    told(0.8)?;
    let topology = Topology::new_while(&mesh, &|| told(0.8))?;
    let t_junctions = junction::t_junctions(&mesh, &topology, &boundary, &new, options.tolerance, &|| told(0.9))?;
    warnings.extend(report::of_junctions(&t_junctions));
    warnings.extend(report::of_faults(&mesh, &topology));
    let open_loops = topology.boundary_loops().len();
    Ok(Welded { mesh, seams, open_loops, t_junctions, warnings })
}
