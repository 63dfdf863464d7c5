//! A mesh parted along the border of a selection.

use super::{Selection, SelectionError};
use crate::mesh::cut::{Line, cut};
use crate::mesh::{Mesh, MeshError, measure};

/// Why a mesh is not parted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SplitError {
    /// A selection of another mesh.
    #[error(transparent)]
    Selection(#[from] SelectionError),
    /// A part that is no mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// The selected part of a mesh and the rest, each open along the line on which the weight, linear along the sides of
/// polygons, is 0.5. Polygons through which it goes are cut; normals and UVs are carried along.
///
/// # Errors
/// [`SplitError`] for a selection of another mesh.
pub fn split(mesh: &Mesh, selection: &Selection) -> Result<[Mesh; 2], SplitError> {
    let weights = selection.weights();
    let (first, second) = (mesh.positions().len(), weights.len());
    if first != second {
        return Err(SelectionError::Sizes { first, second }.into());
    }
    // The cutter takes heights next to 0, measured by the size of the mesh, as 0; a weight of exactly 0.5 is selected.
    let size = measure::diagonal(mesh).max(f64::MIN_POSITIVE);
    let part = |sign: f64| {
        let heights: Vec<f64> = weights.iter().map(|weight| sign * (weight - 0.5) * size).collect();
        cut(mesh, &heights, Line::Level)
    };
    Ok([part(1.0)?, part(-1.0)?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn both_parts_make_the_whole() {
        let points = (0..10).map(|i| DVec3::new(f64::from(i % 5), 0.0, f64::from(i / 5))).collect();
        let net = Mesh::new(points, (0..4_u32).map(|a| [a, a + 5, a + 6, a + 1])).unwrap();
        let selection = Selection::weighted(10, |v| net.positions()[v].x / 4.0 - 0.1);
        let [selected, rest] = split(&net, &selection).unwrap();
        let border = |mesh: &Mesh| mesh.positions().iter().filter(|p| (p.x - 2.4).abs() < 1e-12).count();
        assert_eq!((border(&selected), border(&rest)), (2, 2));
        assert!((measure::area(&selected) - 1.6).abs() < 1e-12 && (measure::area(&rest) - 2.4).abs() < 1e-12);
        let [all, none] = split(&net, &Selection::by(10, |_| true)).unwrap();
        assert_eq!((all.polygon_count(), none.polygon_count()), (4, 0));
        let other = split(&net, &Selection::by(3, |_| true)).unwrap_err();
        assert_eq!(other, SplitError::Selection(SelectionError::Sizes { first: 10, second: 3 }));
    }
}
