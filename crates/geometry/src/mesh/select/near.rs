//! Vertices near to other things: another mesh, or points picked by hand.

use glam::DVec3;

use super::shape::ramp;
use super::{SelectError, Selection, not_negative};
use crate::mesh::{Mesh, MeshDistance};

/// Vertices between two questions whether to go on.
const STEP: usize = 4096;

/// Weight 1 for the vertices within `distance` metres of another mesh, falling to 0 over `falloff` metres beyond: with
/// a distance near 0 the vertices of a part of the mesh that is known by itself.
///
/// `progress` is called with the fraction done; `Ok(None)` where it answers `false`.
///
/// # Errors
/// [`SelectError`] for lengths that are negative or not finite, and where the other mesh has no polygons.
pub fn near_mesh(
    mesh: &Mesh,
    other: &Mesh,
    distance: f64,
    falloff: f64,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Option<Selection>, SelectError> {
    not_negative("distance", distance)?;
    not_negative("falloff", falloff)?;
    let to = MeshDistance::new(other).map_err(|_| SelectError::NoOther)?;
    let count = mesh.positions().len();
    let mut weights = vec![0.0; count];
    for (vertex, weight) in weights.iter_mut().enumerate() {
        if vertex.is_multiple_of(STEP) && !progress(vertex as f64 / count as f64) {
            return Ok(None);
        }
        *weight = ramp(to.nearest(mesh.positions()[vertex]).distance - distance, falloff);
    }
    Ok(Some(Selection::weighted(count, |vertex| weights[vertex])))
}

/// What a point picked by hand found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picked {
    /// The nearest vertex.
    pub vertex: u32,
    /// How far it is from the point, metres.
    pub distance: f64,
    /// Whether that is within the tolerance, so that it is selected.
    pub found: bool,
}

/// Weight 1 for the vertex nearest to each of some points, where it is within `tolerance` metres of it, and what each
/// point found; of equally near vertices the first. Each point is compared with every vertex.
///
/// `progress` is called with the fraction done; `Ok(None)` where it answers `false`.
///
/// # Errors
/// [`SelectError`] for a tolerance that is negative or not finite, points that are not finite, no point, and a mesh
/// without vertices.
pub fn by_points(
    mesh: &Mesh,
    points: &[DVec3],
    tolerance: f64,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Option<(Selection, Vec<Picked>)>, SelectError> {
    not_negative("tolerance", tolerance)?;
    if points.iter().any(|p| !p.is_finite()) {
        return Err(SelectError::NotFinite { what: "point" });
    }
    if points.is_empty() {
        return Err(SelectError::NoPoint);
    }
    let mut picked = Vec::with_capacity(points.len());
    for point in points {
        if !progress(picked.len() as f64 / points.len() as f64) {
            return Ok(None);
        }
        let distances = mesh.positions().iter().map(|p| p.distance_squared(*point)).enumerate();
        let nearest = distances.min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        let (vertex, square) = nearest.ok_or(SelectError::NoPolygons)?;
        let distance = square.sqrt();
        picked.push(Picked { vertex: vertex as u32, distance, found: distance <= tolerance });
    }
    let mut chosen = vec![false; mesh.positions().len()];
    picked.iter().filter(|p| p.found).for_each(|p| chosen[p.vertex as usize] = true);
    Ok(Some((Selection::by(chosen.len(), |vertex| chosen[vertex]), picked)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::join;

    /// A net of 5 x 5 vertices in the plane y = 0, x and z from 0 to 4; vertex `5 z + x`.
    fn net() -> Mesh {
        let points = (0..25).map(|i| DVec3::new(f64::from(i % 5), 0.0, f64::from(i / 5))).collect();
        let quads = (0..16_u32).map(|i| 5 * (i / 4) + i % 4).map(|a| [a, a + 5, a + 6, a + 1]);
        Mesh::new(points, quads).unwrap()
    }

    #[test]
    fn a_part_is_found_in_the_whole() {
        let part = net().with_positions(net().positions().iter().map(|p| *p + 9.0 * DVec3::Y).collect(), None).unwrap();
        let whole = join([&net(), &part]).unwrap();
        let found = near_mesh(&whole, &part, 1e-6, 0.0, &|_| true).unwrap().unwrap();
        assert_eq!(found.vertices(), (25..50).collect::<Vec<_>>());
        let soft = near_mesh(&whole, &part, 8.0, 4.0, &|_| true).unwrap().unwrap();
        assert_eq!((soft.weights()[0], soft.weights()[30]), (0.75, 1.0));
        assert_eq!(near_mesh(&whole, &Mesh::default(), 1.0, 0.0, &|_| true), Err(SelectError::NoOther));
        let negative = SelectError::Negative { what: "falloff", value: -1.0 };
        assert_eq!(near_mesh(&whole, &part, 1.0, -1.0, &|_| true), Err(negative));
        assert_eq!(near_mesh(&whole, &part, 1.0, 0.0, &|_| false), Ok(None));
    }

    #[test]
    fn points_find_their_vertices_or_say_how_far_they_are() {
        let points = [DVec3::new(1.1, 0.0, 2.0), DVec3::new(4.0, 0.5, 4.0), DVec3::new(1.0, 0.05, 2.0)];
        let (found, picked) = by_points(&net(), &points, 0.2, &|_| true).unwrap().unwrap();
        assert_eq!(found.vertices(), [11]);
        assert_eq!((picked[0].vertex, picked[0].found), (11, true));
        assert!((picked[0].distance - 0.1).abs() < 1e-12);
        assert_eq!(picked[1], Picked { vertex: 24, distance: 0.5, found: false });
        assert_eq!(by_points(&net(), &[], 0.2, &|_| true).unwrap_err(), SelectError::NoPoint);
        assert_eq!(by_points(&Mesh::default(), &points, 0.2, &|_| true).unwrap_err(), SelectError::NoPolygons);
        assert_eq!(
            by_points(&net(), &[DVec3::NAN], 0.2, &|_| true).unwrap_err(),
            SelectError::NotFinite { what: "point" }
        );
        assert_eq!(by_points(&net(), &points, 0.2, &|done| done < 0.5), Ok(None));
    }
}
