//! The borders of a mesh.

use glam::DVec3;

use super::{Border, BorderError};
use crate::curve::Curve;
use crate::mesh::Mesh;
use crate::mesh::measure::polygon_normal;

/// The boundary loops of a mesh, each run so that a face put into it would face as the mesh around it does.
///
/// The direction at a vertex is square to the loop there and to the normal of the mesh: the mean of the corner normals
/// of the polygons around the vertex where the mesh has normals, of the polygons' own otherwise. The loop's own
/// direction at a vertex is that of its two sides by their lengths. Loops of fewer than three vertices are left out.
///
/// # Errors
/// [`BorderError`] at a vertex without a direction: polygons without area around it.
pub fn boundaries(mesh: &Mesh) -> Result<Vec<Border>, BorderError> {
    let loops = mesh.boundary_loops();
    if loops.is_empty() {
        return Ok(Vec::new());
    }
    let normals = normals_at(mesh, loops.iter().flatten());
    let mut borders = Vec::with_capacity(loops.len());
    for (index, vertices) in loops.iter().filter(|vertices| vertices.len() > 2).enumerate() {
        borders.extend(along(mesh, vertices, &normals, format!("border {}", index + 1))?);
    }
    Ok(borders)
}

/// The border of a mesh along one of its [boundary loops](Mesh::boundary_loops), begun at its first vertex; as
/// [`boundaries`] gives it.
///
/// # Errors
/// [`BorderError`] at a vertex without a direction, and where these vertices make no curve.
pub fn boundary_along(mesh: &Mesh, vertices: &[u32], name: &str) -> Result<Border, BorderError> {
    let there = |vertex: &&u32| (**vertex as usize) < mesh.positions().len();
    let vertices: Vec<u32> = vertices.iter().filter(there).copied().collect();
    let found = along(mesh, &vertices, &normals_at(mesh, &vertices), name.to_owned())?;
    found.ok_or_else(|| BorderError::Count { border: name.to_owned(), points: vertices.len(), found: 0 })
}

/// The sum of the normals around each of these vertices, zero at all others.
fn normals_at<'a>(mesh: &Mesh, vertices: impl IntoIterator<Item = &'a u32>) -> Vec<DVec3> {
    let mut on_border = vec![false; mesh.positions().len()];
    vertices.into_iter().for_each(|vertex| on_border[*vertex as usize] = true);
    let mut normals = vec![DVec3::ZERO; mesh.positions().len()];
    for polygon in 0..mesh.polygon_count() {
        let range = mesh.corner_range(polygon);
        if !range.clone().any(|corner| on_border[mesh.corners()[corner] as usize]) {
            continue;
        }
        let flat = polygon_normal(mesh, polygon);
        for corner in range {
            let normal = mesh.normals().map_or(flat, |normals| normals[corner]);
            normals[mesh.corners()[corner] as usize] += normal;
        }
    }
    normals
}

/// None where the vertices are no curve.
fn along(mesh: &Mesh, vertices: &[u32], normals: &[DVec3], name: String) -> Result<Option<Border>, BorderError> {
    let at = |k: usize| mesh.positions()[vertices[k % vertices.len()] as usize];
    let points: Vec<DVec3> = (0..vertices.len()).map(at).collect();
    let directions = (0..vertices.len()).map(|k| {
        let along = at(k + 1) - at(k + vertices.len() - 1);
        // The loop runs as a face in the hole would: the mesh is to its right.
        normals[vertices[k] as usize].cross(along)
    });
    let directions = directions.collect();
    let Ok(curve) = Curve::new(name, points, true) else { return Ok(None) };
    Border::new(curve, directions).map(Some)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::cut::cut_with_plane;
    use crate::mesh::slice::Plane;
    use crate::surface::{SkinOptions, skin};
    use std::f64::consts::TAU;

    /// A cone frustum about z, open at both ends.
    fn frustum() -> Mesh {
        let ring = |k: u32| {
            let (radius, z) = (1.0 + 0.1 * f64::from(k), 0.5 * f64::from(k));
            (0..64)
                .map(|i| TAU * f64::from(i) / 64.0)
                .map(|a| DVec3::new(radius * a.cos(), radius * a.sin(), z))
                .collect()
        };
        let sections = crate::sections::Sections::new((0..8).map(ring).collect(), true, vec![]).unwrap();
        skin(&sections, &SkinOptions::default(), &|_| true).unwrap()
    }

    #[test]
    fn directions_lead_out_of_the_mesh_in_its_tangent_plane() {
        let borders = boundaries(&frustum()).unwrap();
        assert_eq!(borders.len(), 2);
        for border in &borders {
            let up = border.curve().points()[0].z > 1.0;
            for (point, direction) in border.curve().points().iter().zip(border.directions()) {
                let outward = DVec3::new(point.x, point.y, 0.0).normalize();
                let wanted = (outward * 0.1 + DVec3::Z * 0.5).normalize() * if up { 1.0 } else { -1.0 };
                assert!(direction.angle_between(wanted).to_degrees() < 0.1, "{direction} {wanted}");
            }
        }
    }

    #[test]
    fn a_cut_mesh_has_a_border_in_the_plane() {
        let plane = Plane::new(DVec3::new(0.0, 0.0, 1.7), DVec3::new(0.1, 0.0, 1.0)).unwrap();
        let part = cut_with_plane(&frustum(), &plane).unwrap();
        assert!(part.positions().iter().all(|p| plane.height(*p) > -1e-9));
        let check = crate::mesh::check(&part);
        assert_eq!((check.boundary_loops, check.shells, check.degenerate_polygons.len()), (2, 1, 0));
        let borders = boundaries(&part).unwrap();
        let cut = borders.iter().find(|b| b.curve().points().iter().all(|p| plane.height(*p).abs() < 1e-9)).unwrap();
        assert!(cut.curve().points().len() >= 64);
        for (point, direction) in cut.curve().points().iter().zip(cut.directions()) {
            assert!(direction.z < -0.9, "{point} {direction}");
        }
        let other = Plane::new(plane.origin(), -plane.normal()).unwrap();
        let rest = cut_with_plane(&frustum(), &other).unwrap();
        let area = crate::mesh::measure::area;
        // The border is on the cone, its facets up to 0.002 inside.
        let whole = area(&frustum());
        assert!((area(&part) + area(&rest) - whole).abs() < 1e-3 * whole);
        for p in cut.curve().points() {
            assert!((p.x.hypot(p.y) - 1.0 - 0.2 * p.z).abs() < 1e-5, "{p}");
        }
    }

    #[test]
    fn planes_through_vertices_leave_no_slivers() {
        let whole = frustum();
        for z in [0.5, 1.0, 0.0, 3.5, -1.0] {
            let plane = Plane::new(DVec3::Z * z, DVec3::Z).unwrap();
            let part = cut_with_plane(&whole, &plane).unwrap();
            let check = crate::mesh::check(&part);
            assert_eq!(check.degenerate_polygons.len(), 0, "{z}");
            assert_eq!(part.polygon_count() == whole.polygon_count(), z <= 0.0, "{z}");
            assert_eq!(check.boundary_loops, if z < 3.5 { 2 } else { 0 }, "{z}");
        }
    }
}
