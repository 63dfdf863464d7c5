//! Normals for drawing a mesh that brings none: smooth, with hard edges where polygons meet at an angle.

use glam::DVec3;

use super::Mesh;
use super::measure::vector_area;

/// Angle at which an edge is hard unless something else is asked for, degrees.
pub const CREASE_DEGREES: f64 = 45.0;

/// Normals at the corners: the mean, weighted by angle, of the polygons around the vertex that meet the corner's own
/// polygon at less than `crease` degrees. One for each of [`Mesh::corners`], in their order; zero where a polygon has no area.
pub fn creased_normals(mesh: &Mesh, crease: f64) -> Vec<DVec3> {
    let points: Vec<DVec3> = mesh.corners().iter().map(|v| mesh.positions()[*v as usize]).collect();
    let mut owner = vec![DVec3::ZERO; points.len()];
    let mut weighted = vec![DVec3::ZERO; points.len()];
    for polygon in 0..mesh.polygon_count() {
        let range = mesh.corner_range(polygon);
        let normal = vector_area(points[range.clone()].iter().copied()).normalize_or_zero();
        for corner in range.clone() {
            let next = if corner + 1 == range.end { range.start } else { corner + 1 };
            let previous = if corner == range.start { range.end - 1 } else { corner - 1 };
            let (a, b) = (points[next] - points[corner], points[previous] - points[corner]);
            owner[corner] = normal;
            weighted[corner] = normal * a.cross(b).length().atan2(a.dot(b));
        }
    }
    // Corners sorted by vertex: those of one vertex stand together.
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by_key(|corner| mesh.corners()[*corner]);
    let least = crease.to_radians().cos();
    let mut normals = owner.clone();
    for around in order.chunk_by(|a, b| mesh.corners()[*a] == mesh.corners()[*b]) {
        // At the centre of a great fan every pair would be compared; its normals are as good from all of them at once.
        let all: Option<DVec3> = (around.len() > 256).then(|| around.iter().map(|c| weighted[*c]).sum());
        for &corner in around {
            let sum = all.unwrap_or_else(|| {
                around.iter().filter(|c| owner[**c].dot(owner[corner]) >= least).map(|c| weighted[*c]).sum()
            });
            normals[corner] = sum.normalize_or(owner[corner]);
        }
    }
    normals
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cube_keeps_its_edges_and_a_gentle_fold_is_smooth() {
        let corner = |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2));
        let cube = Mesh::new(
            (0..8).map(corner).collect(),
            [[0u32, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]],
        )
        .unwrap();
        for (normal, expected) in creased_normals(&cube, CREASE_DEGREES).chunks(4).zip([
            DVec3::NEG_Z,
            DVec3::Z,
            DVec3::NEG_Y,
            DVec3::Y,
            DVec3::NEG_X,
            DVec3::X,
        ]) {
            assert!(normal.iter().all(|n| n.distance(expected) < 1e-12), "{normal:?}");
        }

        let fold = Mesh::new(
            vec![
                DVec3::new(-1.0, -0.2, 0.0),
                DVec3::new(0.0, 0.0, 0.0),
                DVec3::new(0.0, 0.0, -1.0),
                DVec3::new(-1.0, -0.2, -1.0),
                DVec3::new(1.0, -0.2, 0.0),
                DVec3::new(1.0, -0.2, -1.0),
            ],
            [[0u32, 1, 2, 3], [1, 4, 5, 2]],
        )
        .unwrap();
        let normals = creased_normals(&fold, CREASE_DEGREES);
        assert!(normals[1].distance(DVec3::Y) < 1e-12 && normals[4].distance(DVec3::Y) < 1e-12, "{normals:?}");
        assert!(normals[0].x < -0.1);
    }
}
