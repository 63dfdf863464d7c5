//! The borders of surfaces through sections.

use glam::DVec3;

use super::{Border, BorderError};
use crate::curve::Curve;
use crate::sections::Sections;
use crate::surface::analytic::{AnalyticSurface, Side};

/// The border of an analytic surface at its first or last section, with exact tangents (4.16): `count` points at equal
/// steps of v. The direction is that of u out of the surface.
///
/// # Errors
/// [`BorderError`] where the surface ends in a point, or stands still in u.
pub fn of_surface(surface: &AnalyticSurface, side: Side, name: &str, count: usize) -> Result<Border, BorderError> {
    let (u, outward) = match side {
        Side::Start => (0.0, -1.0),
        Side::End => (1.0, 1.0),
    };
    let (from, to) = surface.angle_range();
    let closed = surface.is_closed();
    let count = count.max(3);
    let steps = if closed { count } else { count - 1 };
    let at = |k: usize| surface.evaluate(u, from + (to - from) * k as f64 / steps as f64);
    let places: Vec<_> = (0..count).map(at).collect();
    let points: Vec<DVec3> = places.iter().map(|place| place.position).collect();
    let pole = || BorderError::NoDirection { border: name.to_owned(), index: 0, at: points[0] };
    let curve = Curve::new(name, points.clone(), closed).map_err(|_| pole())?;
    Border::new(curve, places.iter().map(|place| outward * place.tangent_u).collect())
}

/// The border of sections of points at the first or the last: the direction is the derivative of the parabola through
/// the three sections next to it, of two where there are no more.
///
/// # Errors
/// [`BorderError`] where the section is a point, or the next one lies on it.
pub fn of_sections(sections: &Sections, side: Side, name: &str) -> Result<Border, BorderError> {
    let last = sections.len() - 1;
    let row = |k: usize| match side {
        Side::Start => sections.section(k),
        Side::End => sections.section(last - k),
    };
    let (here, next, after) = (row(0), row(1.min(last)), row(2.min(last)));
    let directions = (0..sections.nodes()).map(|i| {
        let (p, q, r) = (here[i], next[i], after[i]);
        let (near, far) = (p.distance(q), q.distance(r));
        // Newton's form with chord lengths as the parameter: uneven sections do not tilt it.
        if near > 0.0 && far > 0.0 && last > 1 {
            let first = (p - q) / near;
            first + (first - (q - r) / far) / (near + far) * near
        } else {
            p - q
        }
    });
    let directions = directions.collect();
    let pole = || BorderError::NoDirection { border: name.to_owned(), index: 0, at: here[0] };
    let curve = Curve::new(name, here.to_vec(), sections.is_closed()).map_err(|_| pole())?;
    Border::new(curve, directions)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::analytic::SurfaceOptions;
    use crate::trigonometric::{EllipticSection, EllipticSegment, PlaneFrame, Series};
    use std::f64::consts::TAU;

    /// A paraboloid-like vase: radius 1 + z^2 at 17 heights from 0 to 1.
    fn radius(z: f64) -> f64 {
        1.0 + z * z
    }

    #[test]
    fn both_kinds_of_surface_have_the_same_borders() {
        let section = |k: u32| {
            let z = f64::from(k) / 16.0;
            let series = Series::new(vec![DVec3::Z * z, DVec3::X * radius(z), DVec3::Y * radius(z)]).unwrap();
            let segment = EllipticSegment { from: 0.0, to: TAU, local: false, series };
            EllipticSection::new(PlaneFrame::new(DVec3::Z * z, DVec3::Z), true, vec![segment]).unwrap()
        };
        let surface =
            AnalyticSurface::through(&(0..17).map(section).collect::<Vec<_>>(), &SurfaceOptions::default()).unwrap();
        let rows = (0..17).map(|k| section(k).sampled(48)).collect();
        let sections = Sections::new(rows, true, vec![]).unwrap();
        for (side, slope, sign) in [(Side::Start, 0.0, -1.0), (Side::End, 2.0, 1.0)] {
            let exact = of_surface(&surface, side, "rim", 48).unwrap();
            let points = of_sections(&sections, side, "rim").unwrap();
            assert!(exact.curve().points().iter().zip(points.curve().points()).all(|(a, b)| a.distance(*b) < 1e-12));
            for ((point, exact), near) in exact.curve().points().iter().zip(exact.directions()).zip(points.directions())
            {
                let outward = DVec3::new(point.x, point.y, 0.0).normalize();
                let wanted = sign * (slope * outward + DVec3::Z).normalize();

                assert!(exact.angle_between(wanted).to_degrees() < 2.0, "{exact} {wanted}");
                assert!(near.angle_between(wanted).to_degrees() < 3.0, "{near} {wanted}");
            }
        }
    }
}
