//! Which border lies along which curve.

use glam::DVec3;
use maquette_geometry::border::{Border, directions_beside};
use maquette_geometry::curve::Curve;

/// The directions at the points of each curve from the border that lies along it, within `snap` metres.
///
/// # Errors
/// A border that lies along none of the curves, with how far it is off.
pub(crate) fn beside(borders: &[Border], curves: &[&Curve], snap: f64) -> Result<Vec<Option<Vec<DVec3>>>, String> {
    for border in borders {
        if !curves.iter().any(|curve| border.directions_at(curve, snap).is_some()) {
            let nearest = curves.iter().map(|curve| (border.mean_distance(curve), curve.name()));
            let nearest = nearest.min_by(|a, b| a.0.total_cmp(&b.0));
            return Err(match nearest {
                Some((distance, curve)) => format!(
                    "border \"{}\" lies along none of the curves: \"{curve}\" is nearest, {distance:.4} m off on average. Use \
                     the border itself as the curve, or raise the snap of {snap} m",
                    border.curve().name()
                ),
                None => "contours of two views continue nothing: disconnect the neighbours".to_owned(),
            });
        }
    }
    Ok(curves.iter().map(|curve| directions_beside(borders, curve, snap)).collect())
}
