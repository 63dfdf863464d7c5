//! Normal and curvatures from derivatives.

use glam::DVec3;

use crate::surface::grid::unit_normal;

/// What a surface is at one u and v.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point, metres.
    pub position: DVec3,
    /// Derivative by u, metres.
    pub tangent_u: DVec3,
    /// Derivative by v, metres a radian; zero at a pole.
    pub tangent_v: DVec3,
    /// Unit normal, `tangent_v x tangent_u`: outward where sections run counter-clockwise about the direction of
    /// stacking. At a pole the limit along this v; zero where there is none.
    pub normal: DVec3,
    /// Largest and smallest normal curvature, 1/m, positive where the surface is convex seen from the tip of the
    /// normal: both are 1/r on a sphere seen from outside. `None` where the tangents are parallel, as at poles.
    pub curvatures: Option<[f64; 2]>,
}

impl SurfacePoint {
    /// From the derivatives of order i in u and j in v at `u`.
    pub(crate) fn new(u: f64, s: [[DVec3; 3]; 3]) -> Self {
        let [[position, sv, svv], [su, suv, _], [suu, ..]] = s;
        let normal = unit_normal(sv, su);
        let mut found = Self { position, tangent_u: su, tangent_v: sv, normal, curvatures: None };
        if normal == DVec3::ZERO {
            // Near a pole at u0, S_v is (u - u0) S_uv; the surface lies behind the pole only where it is the last u.
            found.normal = if u < 1.0 { unit_normal(suv, su) } else { unit_normal(-suv, su) };
            return found;
        }
        // First and second fundamental forms; Gauss and mean curvature.
        let (e, f, g) = (su.dot(su), su.dot(sv), sv.dot(sv));
        let (l, m, n) = (-suu.dot(normal), -suv.dot(normal), -svv.dot(normal));
        let area = e * g - f * f;
        let gauss = (l * n - m * m) / area;
        let mean = (e * n - 2.0 * f * m + g * l) / (2.0 * area);
        let root = (mean * mean - gauss).max(0.0).sqrt();
        found.curvatures = Some([mean + root, mean - root]).filter(|k| k.iter().all(|k| k.is_finite()));
        found
    }
}
