//! Vertices inside of strokes drawn over a mesh in a view.

use glam::DVec3;

use super::{SelectError, Selection};
use crate::curve::Curve;
use crate::mesh::stroke::{Under, behind, is_seen};
use crate::mesh::{Mesh, MeshRays};

/// Vertices between two questions whether to go on.
const STEP: usize = 4096;

/// Weight 1 for the vertices that lie inside of one of the strokes, seen along `direction`; an open stroke is closed by
/// a straight line. With `through`, all that lie behind one another are selected; without, only those that are seen: no
/// polygon lies between them and the eye, which is far away.
///
/// `progress` is called with the fraction done; `Ok(None)` where it answers `false`.
///
/// # Errors
/// [`SelectError`] for a direction of length 0, one that is not finite, and a mesh without polygons.
pub fn by_lasso(
    mesh: &Mesh,
    strokes: &[Curve],
    direction: DVec3,
    through: bool,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Option<Selection>, SelectError> {
    if !direction.is_finite() {
        return Err(SelectError::NotFinite { what: "direction" });
    }
    let direction = direction.try_normalize().ok_or(SelectError::NoDirection)?;
    if mesh.polygon_count() == 0 {
        return Err(SelectError::NoPolygons);
    }
    let drawn: Vec<Under> = strokes.iter().map(|stroke| Under::new(stroke, direction)).collect();
    let under = |stroke: &Under| stroke.rays(mesh).map_err(|_| SelectError::NoPolygons);
    let rays: Vec<Option<MeshRays>> = drawn.iter().map(under).collect::<Result<_, _>>()?;
    let reach = strokes.iter().map(|stroke| behind(mesh, stroke)).fold(0.0, f64::max);
    let count = mesh.positions().len();
    let mut inside = vec![false; count];
    for (vertex, within) in inside.iter_mut().enumerate() {
        if vertex.is_multiple_of(STEP) && !progress(vertex as f64 / count as f64) {
            return Ok(None);
        }
        let at = mesh.positions()[vertex];
        *within = drawn.iter().zip(&rays).any(|(stroke, rays)| {
            let seen = || rays.as_ref().is_none_or(|rays| is_seen(rays, at, direction, reach));
            stroke.encloses(at) && (through || seen())
        });
    }
    Ok(Some(Selection::by(count, |vertex| inside[vertex])))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two nets of 5 x 5 vertices facing up, one a metre above the other, x and z from 0 to 4.
    fn floors() -> Mesh {
        let points = (0..50).map(|i| DVec3::new(f64::from(i % 5), f64::from(i / 25), f64::from(i % 25 / 5))).collect();
        let quads = (0..32_u32).map(|i| 25 * (i / 16) + 5 * (i % 16 / 4) + i % 4).map(|a| [a, a + 5, a + 6, a + 1]);
        Mesh::new(points, quads).unwrap()
    }

    fn stroke(corners: &[[f64; 2]]) -> Curve {
        let points = corners.iter().map(|[x, z]| DVec3::new(*x, 7.0, *z)).collect();
        Curve::new("lasso", points, false).unwrap()
    }

    fn chosen(strokes: &[Curve], through: bool) -> Vec<u32> {
        by_lasso(&floors(), strokes, DVec3::NEG_Y, through, &|_| true).unwrap().unwrap().vertices()
    }

    #[test]
    fn a_lasso_takes_what_is_seen_or_all_behind_it() {
        let around = stroke(&[[0.5, 0.5], [2.5, 0.5], [2.5, 1.5], [0.5, 1.5]]);
        assert_eq!(chosen(std::slice::from_ref(&around), false), [31, 32]);
        assert_eq!(chosen(&[around], true), [6, 7, 31, 32]);
        let both = [stroke(&[[-0.5, -0.5], [0.5, -0.5], [0.0, 0.5]]), stroke(&[[3.5, 3.5], [4.5, 3.5], [4.0, 4.5]])];
        assert_eq!(chosen(&both, false), [25, 49]);
        let from_below = by_lasso(&floors(), &both, DVec3::Y, false, &|_| true).unwrap().unwrap();
        assert_eq!(from_below.vertices(), [0, 24]);
        assert_eq!(chosen(&[], true), [] as [u32; 0]);
    }

    #[test]
    fn what_cannot_be_looked_at_is_refused() {
        let around = [stroke(&[[0.5, 0.5], [2.5, 0.5], [2.5, 1.5]])];
        let none = by_lasso(&floors(), &around, DVec3::ZERO, true, &|_| true);
        assert_eq!(none, Err(SelectError::NoDirection));
        let nan = by_lasso(&floors(), &around, DVec3::NAN, true, &|_| true);
        assert_eq!(nan, Err(SelectError::NotFinite { what: "direction" }));
        let empty = by_lasso(&Mesh::default(), &around, DVec3::Y, true, &|_| true);
        assert_eq!(empty, Err(SelectError::NoPolygons));
        assert_eq!(by_lasso(&floors(), &around, DVec3::Y, true, &|_| false), Ok(None));
    }
}
