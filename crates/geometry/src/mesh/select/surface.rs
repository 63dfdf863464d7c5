//! Vertices by where they are on the surface: parts, borders, distances along it, directions.

use glam::DVec3;

use super::shape::{ramp, weighted_while};
use super::{SelectError, Selection, not_negative};
use crate::mesh::geodesic::{Geodesics, starts_at};
use crate::mesh::measure::vector_area;
use crate::mesh::{Adjacency, Mesh, Topology};

/// Polygons between two questions whether to go on.
const STEP: usize = 4096;

/// The connected component with the vertex nearest to a point. Loose vertices are left out.
///
/// `progress` is called with the fraction done; `Ok(None)` where it answers `false`.
///
/// # Errors
/// [`SelectError`] where the point is not finite or the mesh has no polygons.
pub fn component_nearest(
    mesh: &Mesh,
    point: DVec3,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Option<Selection>, SelectError> {
    if !progress(0.0) {
        return Ok(None);
    }
    let adjacency = Adjacency::along_sides(mesh);
    let used = (0..adjacency.vertices()).filter(|v| !adjacency.ring(*v as u32).is_empty());
    let nearest = nearest_of(mesh, point, used)?.ok_or(SelectError::NoPolygons)?;
    if !progress(0.4) {
        return Ok(None);
    }
    let (component, _) = adjacency.components();
    let weight = |v: usize| f64::from(component[v] == component[nearest]);
    Ok(weighted_while(adjacency.vertices(), weight, &|done| progress(0.7 + 0.3 * done)))
}

/// The boundary loop with the vertex nearest to a point.
///
/// `progress` is called with the fraction done; `Ok(None)` where it answers `false`.
///
/// # Errors
/// [`SelectError`] where the point is not finite or the mesh has no boundary.
pub fn boundary_loop_nearest(
    mesh: &Mesh,
    point: DVec3,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Option<Selection>, SelectError> {
    let Ok(topology) = Topology::new_while(mesh, &|| if progress(0.1) { Ok(()) } else { Err(()) }) else {
        return Ok(None);
    };
    let loops = topology.boundary_loops();
    if !progress(0.8) {
        return Ok(None);
    }
    let vertices = loops.iter().flatten().map(|v| *v as usize);
    let nearest = nearest_of(mesh, point, vertices)?.ok_or(SelectError::NoBoundary)?;
    let mut on = vec![false; mesh.positions().len()];
    if let Some(found) = loops.iter().find(|l| l.contains(&(nearest as u32))) {
        found.iter().for_each(|v| on[*v as usize] = true);
    }
    Ok(Some(Selection::by(on.len(), |v| on[v])))
}

/// Weight 1 within `distance` metres along the surface from the points of it nearest to `points`, falling to 0 over
/// `falloff` metres beyond; see [`Geodesics::distances`].
///
/// `progress` is called with the fraction done; `Ok(None)` where it answers `false`.
///
/// # Errors
/// [`SelectError`] for numbers that are not finite or negative, no point, and a mesh without polygons.
pub fn geodesic(
    mesh: &Mesh,
    points: &[DVec3],
    distance: f64,
    falloff: f64,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Option<Selection>, SelectError> {
    not_negative("distance", distance)?;
    not_negative("falloff", falloff)?;
    if points.iter().any(|p| !p.is_finite()) {
        return Err(SelectError::NotFinite { what: "point" });
    }
    if points.is_empty() {
        return Err(SelectError::NoPoint);
    }
    if !progress(0.0) {
        return Ok(None);
    }
    let starts = starts_at(mesh, points).map_err(|_| SelectError::NoPolygons)?;
    if !progress(0.2) {
        return Ok(None);
    }
    let spreading = |done: f64| progress(0.4 + 0.5 * done);
    let found = Geodesics::new(mesh).distances_while(&starts, distance + falloff, &spreading);
    let Some(found) = found else { return Ok(None) };
    let weight = |v: usize| ramp(found[v] - distance, falloff);
    Ok(weighted_while(found.len(), weight, &|done| progress(0.9 + 0.1 * done)))
}

/// Weight 1 where the normal of a vertex, weighted by the areas around it, is within `angle` radians of a direction,
/// falling to 0 over `falloff` radians beyond. Vertices without a normal have weight 0.
///
/// `progress` is called with the fraction done; `Ok(None)` where it answers `false`.
///
/// # Errors
/// [`SelectError`] for numbers that are not finite or negative and a direction of length 0.
pub fn by_normal(
    mesh: &Mesh,
    direction: DVec3,
    angle: f64,
    falloff: f64,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Option<Selection>, SelectError> {
    not_negative("angle", angle)?;
    not_negative("falloff", falloff)?;
    if !direction.is_finite() {
        return Err(SelectError::NotFinite { what: "direction" });
    }
    let direction = direction.try_normalize().ok_or(SelectError::NoDirection)?;
    let mut normals = vec![DVec3::ZERO; mesh.positions().len()];
    for (polygon, corners) in mesh.polygons().enumerate() {
        if polygon.is_multiple_of(STEP) && !progress(0.5 * polygon as f64 / mesh.polygon_count() as f64) {
            return Ok(None);
        }
        let area = vector_area(corners.iter().map(|v| mesh.positions()[*v as usize]));
        corners.iter().for_each(|v| normals[*v as usize] += area);
    }
    let weight = |vertex: usize| {
        let normal = normals[vertex];
        if normal == DVec3::ZERO {
            return 0.0;
        }
        ramp(normal.cross(direction).length().atan2(normal.dot(direction)) - angle, falloff)
    };
    Ok(weighted_while(normals.len(), weight, &|done| progress(0.5 + 0.5 * done)))
}

/// Of some vertices the one nearest to a point, of equal ones the first.
fn nearest_of(mesh: &Mesh, point: DVec3, vertices: impl Iterator<Item = usize>) -> Result<Option<usize>, SelectError> {
    if !point.is_finite() {
        return Err(SelectError::NotFinite { what: "point" });
    }
    let distance = |v: &usize| mesh.positions()[*v].distance_squared(point);
    Ok(vertices.min_by(|a, b| distance(a).total_cmp(&distance(b)).then(a.cmp(b))))
}
