//! How smoothly surfaces meet: gaps, angles and jumps of curvature, measured on the exact surfaces.

use glam::DVec3;
use std::fmt;

use super::analytic::AnalyticSurface;

/// Places at which a joint of two surfaces is measured.
const AROUND: usize = 256;
/// Places at which a joint of two patches is measured, for each gap between sections.
const ALONG: usize = 16;

/// Where two pieces of surface meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointPlace {
    /// The end of one surface of a chain and the beginning of the next.
    Parts {
        /// Index of the first, counted from 0.
        first: usize,
    },
    /// Two patches of one surface at an angle at which its sections are split.
    Segments {
        /// Index of the surface, counted from 0.
        part: usize,
        /// The angle, radians.
        v: f64,
    },
}

impl fmt::Display for JointPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Parts { first } => write!(f, "parts {first} and {}", first + 1),
            Self::Segments { part, v } => {
                write!(f, "part {part} at {:.1} degrees", v.to_degrees().rem_euclid(360.0))
            }
        }
    }
}

/// The largest values found along a joint, each wherever it is largest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointContinuity {
    /// Where the pieces meet.
    pub place: JointPlace,
    /// Distance from the edge of one to the edge of the other, metres.
    pub gap: f64,
    /// Angle between the normals, radians; 180 degrees where one piece is inside out against the other.
    pub angle: f64,
    /// Difference of the normal curvatures across the joint, 1/m.
    pub curvature_jump: f64,
    /// Where the angle is largest, metres.
    pub at: DVec3,
}

/// Measures every joint of surfaces end to end: between patches of each surface, and from the end of each to the
/// beginning of the next.
///
/// - Joints of two surfaces are measured at 256 angles of the first and at the nearest points of the second: surfaces
///   need not count their angles from the same side.
/// - Joints of patches are measured at 16 places between neighbouring sections.
/// - Where a surface has no normal (at a pole), no angle is measured, and where a tangent is zero, no curvature.
///
/// `go_on` is asked at each joint; where it answers `false`, `None` comes back.
pub fn continuity(surfaces: &[AnalyticSurface], go_on: &dyn Fn(f64) -> bool) -> Option<Vec<JointContinuity>> {
    let mut found = Vec::new();
    for (part, surface) in surfaces.iter().enumerate() {
        let done = |share: f64| (part as f64 + share) / surfaces.len() as f64;
        if !go_on(done(0.0)) {
            return None;
        }
        for v in surface.joints() {
            if !go_on(done(0.3)) {
                return None;
            }
            found.extend(between_patches(surface, part, v));
        }
        if let Some(next) = surfaces.get(part + 1) {
            if !go_on(done(0.6)) {
                return None;
            }
            found.extend(between_parts(surface, next, part));
        }
    }
    Some(found)
}

/// Derivatives of order i in u and j in v.
type Derivatives = [[DVec3; 3]; 3];

/// The joint between the end of one surface and the beginning of the next. None where one of them swings beyond all
/// numbers.
fn between_parts(first: &AnalyticSurface, second: &AnalyticSurface, index: usize) -> Option<JointContinuity> {
    let edge = second.section_at(0.0)?;
    let own = first.section_at(1.0)?;
    let mut joint = JointContinuity::of(JointPlace::Parts { first: index });
    let (from, to) = first.angle_range();
    for k in 0..AROUND {
        // Off the places of joints, where two normals are at home.
        let v = from + (to - from) * (k as f64 + 0.5) / AROUND as f64;
        let here = at(first, 1.0, v);
        let nearest = edge.nearest(here[0][0]);
        joint.meet(&here, &at(second, 0.0, nearest.angle), here[0][1], nearest.distance);
        // What the second reaches beyond the first, where one of them is open or longer.
        let there = edge.range().0 + (edge.range().1 - edge.range().0) * (k as f64 + 0.5) / AROUND as f64;
        joint.gap = joint.gap.max(own.nearest(edge.point(there)).distance);
    }
    Some(joint)
}

/// The joint of two patches at the angle `v`.
fn between_patches(surface: &AnalyticSurface, part: usize, v: f64) -> Option<JointContinuity> {
    let pieces = &surface.angles().pieces;
    let index = pieces.iter().position(|piece| piece.from == v)?;
    let before = &pieces[(index + pieces.len() - 1) % pieces.len()];
    let mut joint = JointContinuity::of(JointPlace::Segments { part, v });
    for pair in surface.section_parameters().windows(2) {
        for k in 0..ALONG {
            let u = pair[0] + (pair[1] - pair[0]) * (k as f64 + 0.5) / ALONG as f64;
            let (one, other) = (surface.derivatives(u, before, before.to), surface.derivatives(u, &pieces[index], v));
            joint.meet(&one, &other, one[1][0], one[0][0].distance(other[0][0]));
        }
    }
    Some(joint)
}

fn at(surface: &AnalyticSurface, u: f64, v: f64) -> Derivatives {
    let (piece, v) = surface.angles().locate(v);
    surface.derivatives(u, piece, v)
}

impl JointContinuity {
    fn of(place: JointPlace) -> Self {
        Self { place, gap: 0.0, angle: 0.0, curvature_jump: 0.0, at: DVec3::ZERO }
    }

    /// Takes in one place of the joint, which runs in the direction `along`.
    fn meet(&mut self, one: &Derivatives, other: &Derivatives, along: DVec3, gap: f64) {
        self.gap = self.gap.max(gap);
        let (Some(n), Some(m)) = (normal(one), normal(other)) else { return };
        // From the cross product too: the arc cosine alone has no digits for small angles.
        let angle = n.cross(m).length().atan2(n.dot(m));
        if angle >= self.angle {
            (self.angle, self.at) = (angle, one[0][0]);
        }
        let across = |normal: DVec3, surface: &Derivatives| {
            let direction = normal.cross(along).try_normalize()?;
            normal_curvature(surface, normal, direction)
        };
        if let (Some(a), Some(b)) = (across(n, one), across(m, other)) {
            self.curvature_jump = self.curvature_jump.max((a - b).abs());
        }
    }
}

fn normal(s: &Derivatives) -> Option<DVec3> {
    let (across, along) = (s[0][1].try_normalize()?, s[1][0].try_normalize()?);
    // Tangents that are parallel but for rounding have no normal.
    Some(across.cross(along)).filter(|n| n.length() > 1e-9)?.try_normalize()
}

/// Curvature of the surface in a tangent direction, 1/m, positive where it is convex seen from the tip of the normal.
fn normal_curvature(s: &Derivatives, normal: DVec3, direction: DVec3) -> Option<f64> {
    let [[_, sv, svv], [su, suv, _], [suu, ..]] = *s;
    let (e, f, g) = (su.dot(su), su.dot(sv), sv.dot(sv));
    let area = e * g - f * f;
    // The direction as a su + b sv.
    let (p, q) = (direction.dot(su), direction.dot(sv));
    let (a, b) = ((g * p - f * q) / area, (e * q - f * p) / area);
    let bend = -(a * a * suu.dot(normal) + 2.0 * a * b * suv.dot(normal) + b * b * svv.dot(normal));
    bend.is_finite().then_some(bend)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::analytic::{Continuity, SurfaceOptions, chain};
    use crate::trigonometric::{EllipticSection, EllipticSegment, PlaneFrame, Series};
    use std::f64::consts::TAU;

    fn section(height: f64, radius: f64, start: f64) -> EllipticSection {
        let series = Series::new(vec![DVec3::Y * height, DVec3::Z * radius, DVec3::X * radius]).unwrap();
        let series = series.started_at(start);
        let segment = EllipticSegment { from: 0.0, to: TAU, local: false, series };
        EllipticSection::new(PlaneFrame::new(DVec3::Y * height, DVec3::Y), true, vec![segment]).unwrap()
    }

    fn through(sections: &[EllipticSection]) -> AnalyticSurface {
        AnalyticSurface::through(sections, &SurfaceOptions::default()).unwrap()
    }

    fn measured(surfaces: &[AnalyticSurface]) -> Vec<JointContinuity> {
        continuity(surfaces, &|_| true).unwrap()
    }

    #[test]
    fn a_cylinder_and_a_cone_meet_at_the_angle_of_the_cone() {
        let cylinder = through(&[section(0.0, 1.0, 0.0), section(1.0, 1.0, 0.0)]);
        // Its angles are counted from elsewhere.
        let cone = through(&[section(1.0, 1.0, 0.7), section(2.0, 0.5, 0.7)]);
        let [joint] = measured(&[cylinder.clone(), cone.clone()])[..] else { panic!() };
        assert_eq!(joint.place.to_string(), "parts 0 and 1");
        assert!(joint.gap < 1e-12 && (joint.angle - 0.5_f64.atan()).abs() < 1e-9, "{joint:?}");
        assert!(joint.curvature_jump < 1e-9, "both are straight along: {joint:?}");
        // Moved up by a centimetre.
        let moved = through(&[section(1.01, 1.0, 0.7), section(2.0, 0.5, 0.7)]);
        let [joint] = measured(&[cylinder.clone(), moved])[..] else { panic!() };
        assert!((joint.gap - 0.01).abs() < 1e-12);
        // Run the other way, one is inside out.
        let back = through(&[section(1.0, 1.0, 0.0), section(0.0, 1.0, 0.0)]);
        let [joint] = measured(&[cylinder, back])[..] else { panic!() };
        assert!((joint.angle - TAU / 2.0).abs() < 1e-6);
    }

    #[test]
    fn a_sphere_on_a_cylinder_has_its_curvature_as_the_jump() {
        let cylinder = through(&[section(-1.0, 1.0, 0.0), section(0.0, 1.0, 0.0)]);
        let ring = |k: i32| {
            let angle = f64::from(k) * 0.1;
            section(angle.sin(), angle.cos(), 0.0)
        };
        let sections: Vec<EllipticSection> = (0..8).map(ring).collect();
        let sphere = through(&sections);
        let [joint] = measured(&[cylinder, sphere])[..] else { panic!() };
        assert!(joint.gap < 1e-12 && joint.angle < 1e-4, "{joint:?}");
        assert!((joint.curvature_jump - 1.0).abs() < 1e-2, "{joint:?}");
    }

    #[test]
    fn chains_meet_as_smoothly_as_asked() {
        let bulge = |k: usize| section(0.3 * k as f64, 1.0 + 0.2 * (k as f64).sin(), 0.0);
        let all: Vec<EllipticSection> = (0..9).map(bulge).collect();
        let parts = [all[..5].to_vec(), all[4..].to_vec()];
        let of = |wanted| measured(&chain(&parts, &SurfaceOptions::default(), wanted).unwrap())[0];
        let (tangent, curvature) = (of(Continuity::Tangent), of(Continuity::Curvature));
        assert!(tangent.angle < 1e-9 && curvature.angle < 1e-9, "{tangent:?} {curvature:?}");
        assert!(tangent.curvature_jump > 1e-3 && curvature.curvature_jump < 1e-6, "{tangent:?} {curvature:?}");
    }

    #[test]
    fn joints_of_patches_are_measured_with_their_corners() {
        let half = |from: f64, radius: f64, height: f64| {
            let series = Series::new(vec![DVec3::Y * height, DVec3::Z * radius, DVec3::X]).unwrap();
            EllipticSegment { from, to: from + TAU / 2.0, local: false, series }
        };
        // Half circles of other height meet at the sides with one tangent and another curvature.
        let split = |height: f64| {
            let segments = vec![half(TAU / 4.0, 1.0, height), half(0.75 * TAU, 2.0, height)];
            EllipticSection::new(PlaneFrame::new(DVec3::ZERO, DVec3::Y), true, segments).unwrap()
        };
        let found = measured(&[through(&[split(0.0), split(1.0)])]);
        assert_eq!(found.len(), 2);
        assert_eq!(found[1].place.to_string(), "part 0 at 270.0 degrees");
        for joint in found {
            assert!(joint.gap < 1e-12 && joint.angle < 1e-9, "{joint:?}");
            // Of the ellipses x^2 + z^2/a^2 = 1 at their ends (1, 0): 1/a^2.
            assert!((joint.curvature_jump - 0.75).abs() < 1e-9, "{joint:?}");
        }
        assert_eq!(continuity(&[through(&[split(0.0), split(1.0)])], &|done| done < 0.1), None);
        assert_eq!(measured(&[]), []);
        assert_eq!(measured(&[through(&[section(0.0, 1.0, 0.0), section(1.0, 1.0, 0.0)])]), []);
    }
}
