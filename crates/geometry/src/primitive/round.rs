//! Primitives whose sections are circles.

use std::f64::consts::{FRAC_PI_2, PI};

use super::PrimitiveError;
use super::error::size;
use super::stack::{Row, check, directions, stack};
use crate::sections::Sections;
use crate::trigonometric::{EllipticSection, PlaneFrame};

/// A body of revolution. Lengths are metres; the origin of the frame is the middle of its height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RoundPrimitive {
    /// A sphere; its ends are points.
    Sphere {
        /// Its radius.
        radius: f64,
    },
    /// A cylinder, open at both ends.
    Cylinder {
        /// Its radius.
        radius: f64,
        /// From end to end.
        height: f64,
    },
    /// A cone, or a part of one; open where it has a radius, a point where that is 0.
    Cone {
        /// Radius of the first section.
        radius: f64,
        /// Radius of the last section.
        top: f64,
        /// From end to end.
        height: f64,
    },
    /// A cylinder between two half spheres; its ends are points.
    Capsule {
        /// Radius of both.
        radius: f64,
        /// From pole to pole.
        height: f64,
    },
}

impl RoundPrimitive {
    /// The primitive as `sections` sections of `nodes` points, along the frame's normal, at equal lengths along the
    /// profile.
    ///
    /// # Errors
    /// [`PrimitiveError`] where a length is no size or a number is out of range (2 to 4096 sections, 3 where both ends
    /// are points; 3 to 65,536 nodes).
    pub fn sections(&self, frame: &PlaneFrame, sections: usize, nodes: usize) -> Result<Sections, PrimitiveError> {
        let rows = self.rows(sections, nodes)?;
        stack(frame, &rows, &directions(nodes).collect::<Vec<_>>())
    }

    /// The same sections as circles that are exact series of one harmonic.
    ///
    /// # Errors
    /// As [`RoundPrimitive::sections`].
    pub fn series(&self, frame: &PlaneFrame, sections: usize) -> Result<Vec<EllipticSection>, PrimitiveError> {
        let circle = |row: &Row| {
            let frame = PlaneFrame { origin: frame.origin + frame.normal * row.height, ..*frame };
            EllipticSection::ellipse(frame, [row.scale; 2])
                .map_err(|_| PrimitiveError::Size { what: "distance from the origin", found: row.height })
        };
        self.rows(sections, 4)?.iter().map(circle).collect()
    }

    fn rows(&self, sections: usize, nodes: usize) -> Result<Vec<Row>, PrimitiveError> {
        let poles = matches!(self, Self::Sphere { .. } | Self::Capsule { .. });
        check(sections, if poles { 3 } else { 2 }, nodes)?;
        let last = (sections - 1) as f64;
        // From both ends towards the middle, so that the two halves are mirror images to the last bit.
        let mirrored = |row: &dyn Fn(f64) -> Row| -> Vec<Row> {
            let lower = |k: usize| row(k as f64 / last);
            let upper = |k: usize| {
                let Row { height, scale } = lower(sections - 1 - k);
                Row { height: -height, scale }
            };
            let middle = Row { height: 0.0, ..row(0.5) };
            let of = |k: usize| match (2 * k + 1).cmp(&sections) {
                std::cmp::Ordering::Less => lower(k),
                std::cmp::Ordering::Equal => middle,
                std::cmp::Ordering::Greater => upper(k),
            };
            (0..sections).map(of).collect()
        };
        match *self {
            Self::Sphere { radius } => {
                let radius = size("radius", radius)?;
                Ok(mirrored(&|share| half_sphere(radius, -radius, share * PI)))
            }
            Self::Cylinder { radius, height } => {
                let (radius, height) = (size("radius", radius)?, size("height", height)?);
                Ok(mirrored(&|share| Row { height: (share - 0.5) * height, scale: radius }))
            }
            Self::Cone { radius, top, height } => {
                let height = size("height", height)?;
                let end = |what, radius: f64| if radius == 0.0 { Ok(0.0) } else { size(what, radius) };
                let (bottom, top) = (end("radius", radius)?, end("radius of the top", top)?);
                if bottom == 0.0 && top == 0.0 {
                    return Err(PrimitiveError::Line);
                }
                let row =
                    |share: f64| Row { height: (share - 0.5) * height, scale: bottom * (1.0 - share) + top * share };
                Ok((0..sections).map(|k| row(k as f64 / last)).collect())
            }
            Self::Capsule { radius, height } => {
                let (radius, height) = (size("radius", radius)?, size("height", height)?);
                // 2 r may have been rounded to what is the height of a sphere.
                let straight = height - 2.0 * radius;
                if straight < -1e-12 * height {
                    return Err(PrimitiveError::CapsuleTooLow { height, radius });
                }
                let length = PI * radius + straight.max(0.0);
                Ok(mirrored(&|share| {
                    let along = share * length;
                    let arc = along / radius;
                    match arc < FRAC_PI_2 {
                        true => half_sphere(radius, -0.5 * height, arc),
                        false => Row { height: along - FRAC_PI_2 * radius + radius - 0.5 * height, scale: radius },
                    }
                }))
            }
        }
    }
}

/// The row at an angle from the pole at height `pole` of a sphere.
fn half_sphere(radius: f64, pole: f64, angle: f64) -> Row {
    Row { height: pole + radius * (1.0 - angle.cos()), scale: radius * angle.sin() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn frame() -> PlaneFrame {
        PlaneFrame::new(DVec3::new(0.5, 1.0, 0.0), DVec3::Y)
    }

    /// Height along the frame's normal, and distance from the axis, of the first node of each section.
    fn profile(sections: &Sections) -> Vec<(f64, f64)> {
        let arm = |p: &[DVec3]| p[0] - frame().origin;
        sections.iter().map(|p| (arm(p).y, arm(p).with_y(0.0).length())).collect()
    }

    #[test]
    fn all_points_of_a_sphere_have_its_radius() {
        let sphere = RoundPrimitive::Sphere { radius: 0.3 }.sections(&frame(), 17, 24).unwrap();
        for point in sphere.points() {
            assert!((point.distance(frame().origin) - 0.3).abs() < 1e-15);
        }
        assert!(sphere.is_pole(0) && sphere.is_pole(16) && !sphere.is_pole(1));
        assert_eq!((sphere.rails(), sphere.section(8)[0]), (&[0, 6, 12, 18][..], DVec3::new(0.8, 1.0, 0.0)));
        for (low, high) in profile(&sphere).iter().zip(profile(&sphere).iter().rev()) {
            assert!((low.0 + high.0).abs() < 1e-15 && (low.1 - high.1).abs() < 1e-15);
        }
    }

    #[test]
    fn sections_run_counter_clockwise_about_the_stack() {
        let cylinder = RoundPrimitive::Cylinder { radius: 1.0, height: 2.0 }.sections(&frame(), 2, 4).unwrap();
        let arms: Vec<DVec3> = cylinder.section(0).iter().map(|p| *p - frame().origin).collect();
        assert_eq!(arms, [[1.0, -1.0, 0.0], [0.0, -1.0, -1.0], [-1.0, -1.0, 0.0], [0.0, -1.0, 1.0]].map(DVec3::from));
        assert_eq!(profile(&cylinder)[1], (1.0, 1.0));
    }

    #[test]
    fn a_cone_ends_in_a_point_where_its_radius_is_nothing() {
        let cone = RoundPrimitive::Cone { radius: 1.0, top: 0.0, height: 2.0 }.sections(&frame(), 5, 8).unwrap();
        assert_eq!(profile(&cone), [(-1.0, 1.0), (-0.5, 0.75), (0.0, 0.5), (0.5, 0.25), (1.0, 0.0)]);
        assert!(cone.is_pole(4));
    }

    #[test]
    fn a_capsule_has_its_height_and_even_steps_along_its_profile() {
        let capsule = RoundPrimitive::Capsule { radius: 0.5, height: 3.0 };
        let profile = profile(&capsule.sections(&frame(), 201, 8).unwrap());
        assert_eq!((profile[0], profile[200]), ((-1.5, 0.0), (1.5, 0.0)));
        let step = (PI * 0.5 + 2.0) / 200.0;
        for pair in profile.windows(2) {
            let found = f64::hypot(pair[1].0 - pair[0].0, pair[1].1 - pair[0].1);
            assert!((found / step - 1.0).abs() < 1e-3, "{pair:?}");
        }
        for (height, radius) in profile {
            let beyond = (height.abs() - 1.0).max(0.0);
            assert!((f64::hypot(beyond, radius) - 0.5).abs() < 1e-14, "{height} {radius}");
        }
        let sphere = RoundPrimitive::Capsule { radius: 0.1, height: 0.2 }.sections(&frame(), 9, 8).unwrap();
        let exact = RoundPrimitive::Sphere { radius: 0.1 }.sections(&frame(), 9, 8).unwrap();
        assert!(sphere.points().iter().zip(exact.points()).all(|(a, b)| a.distance(*b) < 1e-15));
    }

    #[test]
    fn the_series_are_the_same_circles() {
        let cone = RoundPrimitive::Cone { radius: 0.2, top: 0.4, height: 1.0 };
        let (points, series) = (cone.sections(&frame(), 6, 12).unwrap(), cone.series(&frame(), 6).unwrap());
        for (row, section) in points.iter().zip(&series) {
            for (node, point) in row.iter().enumerate() {
                let angle = 2.0 * PI * node as f64 / 12.0;
                assert!(section.point(angle).distance(*point) < 1e-15);
            }
        }
    }

    #[test]
    fn what_is_no_primitive_is_refused() {
        let refusal = |primitive: RoundPrimitive, sections, nodes| {
            primitive.sections(&frame(), sections, nodes).unwrap_err().to_string()
        };
        let sphere = RoundPrimitive::Sphere { radius: 1.0 };
        assert_eq!(refusal(sphere, 2, 8), "2 sections asked for: ask for 3 to 4096");
        assert_eq!(refusal(sphere, 3, 2), "2 nodes asked for: ask for 3 to 65536");
        assert!(refusal(sphere, 4096, 65_536).contains("ask for fewer"));
        let flat = RoundPrimitive::Cylinder { radius: 1.0, height: -1.0 };
        assert_eq!(refusal(flat, 2, 8), "the height is -1 m: give a length between 1e-9 and 1e9 m");
        let low = RoundPrimitive::Capsule { radius: 1.0, height: 1.5 };
        assert!(refusal(low, 9, 8).ends_with("make it at least 2 m high"));
        assert!(refusal(RoundPrimitive::Cone { radius: 0.0, top: 0.0, height: 1.0 }, 2, 8).contains("a line"));
        assert!(refusal(RoundPrimitive::Sphere { radius: f64::NAN }, 3, 8).contains("NaN"));
    }
}
