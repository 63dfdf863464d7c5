//! All generators at one door.

use super::network::is_loop;
use super::{
    ArchBorder, BlendBorder, GenerateError, GenerateOptions, Generated, Neighbour, arch, blend, network, sheet,
    through_closed, to_apex, two_views,
};
use crate::curve::Curve;

/// The ways to make a detail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Four rails, a pair from each of two views: [`two_views`].
    TwoViews,
    /// Rails past two or more closed profiles: [`through_closed`].
    ThroughClosed,
    /// Rails from one closed profile to a point: [`to_apex`].
    ToApex,
    /// One rail across one closed profile: [`arch`].
    Arch,
    /// Rails past two or more open profiles: [`sheet`].
    Sheet,
    /// Rails that close a loop of three or four borders: [`network`].
    Network,
    /// Two closed profiles, each with a neighbour: [`blend`].
    Blend,
}

/// The curves of a detail by their parts in it, as a node has them on its ports.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Detail<'a> {
    /// Open curves along the shape. Those of two views, of a tube and of a cap in order around, as
    /// [`sort`](crate::curve::sort) gives them; those of a patch its borders.
    pub rails: &'a [Curve],
    /// Curves across the rails, in the order in which these meet them.
    pub profiles: &'a [Curve],
    /// Rails inside a patch.
    pub inner: &'a [Curve],
    /// The surfaces beyond: of profiles the first and the last one, of a patch its borders, in order; fewer mean none.
    pub neighbours: &'a [Option<Neighbour<'a>>],
}

impl Detail<'_> {
    /// The method for these curves: by how many there are, whether profiles are closed, and whether rails alone close a
    /// loop within `snap` metres.
    ///
    /// # Errors
    /// [`GenerateError::NoMethod`] where there is none, with what is missing.
    pub fn method(&self, snap: f64) -> Result<Method, GenerateError> {
        let closed = self.profiles.iter().filter(|profile| profile.is_closed()).count();
        match (self.rails.len(), self.profiles.len() - closed, closed) {
            (3 | 4, 0, 0) if is_loop(self.rails, snap) => Ok(Method::Network),
            (4, 0, 0) => Ok(Method::TwoViews),
            (1, 0, 1) => Ok(Method::Arch),
            (2.., 0, 1) => Ok(Method::ToApex),
            (2.., 0, 2..) => Ok(Method::ThroughClosed),
            (2.., 2.., 0) => Ok(Method::Sheet),
            (0, 0, 2) => Ok(Method::Blend),
            (rails, open, closed) => {
                let remedy = match (rails, open, closed) {
                    (_, 1.., 1..) => "profiles are all open or all closed",
                    (0 | 1, 2.., 0) | (1, 0, 2..) => "draw at least 2 rails",
                    (_, 1, 0) => "a sheet needs at least 2 profiles",
                    (0, 0, 1) => "draw one rail across the closed profile, or several to a point",
                    (0, 0, 3..) => "between several closed profiles draw rails",
                    _ => "without profiles give the 4 outlines of two views, or 3 or 4 borders that meet at their ends",
                };
                let what =
                    format!("no generator for {rails} rail(s), {open} open and {closed} closed profile(s): {remedy}");
                Err(GenerateError::NoMethod { what })
            }
        }
    }

    /// Makes the detail by `method`.
    ///
    /// # Errors
    /// [`GenerateError`] of the method, and [`GenerateError::NoMethod`] where the curves are not those it takes.
    pub fn generate(
        &self,
        method: Method,
        options: &GenerateOptions,
        progress: &dyn Fn(f64) -> bool,
    ) -> Result<Generated, GenerateError> {
        let (rails, profiles) = (self.rails, self.profiles);
        let neighbour = |k: usize| self.neighbours.get(k).copied().flatten();
        let not = |what: &str| Err(GenerateError::NoMethod { what: what.to_owned() });
        match (method, rails, profiles) {
            (Method::TwoViews, rails, _) => match rails.try_into() {
                Ok(four) => two_views(four, options, progress),
                Err(_) => not("two views take four open contours: pass them through `sort`"),
            },
            (Method::ThroughClosed, ..) => {
                through_closed(rails, profiles, [neighbour(0), neighbour(1)], options, progress)
            }
            (Method::ToApex, _, [start]) => to_apex(rails, start, neighbour(0), options, progress),
            (Method::Arch, [open], [closed]) => {
                let border = neighbour(0).map_or(ArchBorder::Parabola, ArchBorder::Neighbour);
                arch(open, closed, border, options, progress)
            }
            (Method::Sheet, ..) => sheet(rails, profiles, [neighbour(0), neighbour(1)], options, progress),
            (Method::Network, ..) => network(rails, self.inner, self.neighbours, options, progress),
            (Method::Blend, _, [start, end]) => match (neighbour(0), neighbour(1)) {
                (Some(one), Some(other)) => {
                    let [start, end] = [(start, one), (end, other)].map(|(curve, neighbour)| BlendBorder {
                        curve,
                        neighbour,
                        strength: 1.0,
                    });
                    blend(&start, &end, 0.0, options, progress)
                }
                _ => not("a blend continues two surfaces: give a neighbour at both closed profiles"),
            },
            (Method::ToApex, ..) => not("rails to a point start from one closed profile"),
            (Method::Arch, ..) => not("a cap under one contour takes one rail and one closed profile"),
            (Method::Blend, ..) => not("a blend lies between two closed profiles"),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use glam::DVec3;

    use super::super::test_shapes::{closed, cuff, dome, mouth, open, sphere_patch};
    use super::*;
    use crate::curve::{SortOptions, sort};

    fn ring(height: f64) -> Curve {
        closed("ring", 100, |a| DVec3::new(0.1 * a.cos(), height, -0.1 * a.sin()))
    }

    fn line(x: f64) -> Curve {
        open("line", 4, |t| DVec3::new(x, t, x * x))
    }

    #[test]
    fn curves_decide_and_the_message_tells_what_is_missing() {
        let rings = [0.0, 0.1, 0.2, 0.3].map(ring);
        let lines = [0.0, 0.1, 0.2, 0.3, 0.4].map(line);
        let method = |rails: &[Curve], profiles: &[Curve]| Detail { rails, profiles, ..Detail::default() }.method(0.02);
        assert_eq!(method(&lines[..4], &[]), Ok(Method::TwoViews));
        assert_eq!(method(&sphere_patch(4, 9), &[]), Ok(Method::Network));
        assert_eq!(method(&sphere_patch(3, 9), &[]), Ok(Method::Network));
        assert_eq!(method(&lines[..1], &rings[..1]), Ok(Method::Arch));
        assert_eq!(method(&lines, &rings[..1]), Ok(Method::ToApex));
        assert_eq!(method(&lines[..2], &rings[..2]), Ok(Method::ThroughClosed));
        assert_eq!(method(&lines, &rings), Ok(Method::ThroughClosed));
        assert_eq!(method(&lines[..3], &lines[3..]), Ok(Method::Sheet));
        assert_eq!(method(&[], &rings[..2]), Ok(Method::Blend));
        for (rails, profiles, part) in [
            (&[][..], &[][..], "4 outlines"),
            (&lines[..2], &[], "3 or 4 borders"),
            (&lines[..1], &rings[..2], "at least 2 rails"),
            (&lines[..2], &lines[..1], "at least 2 profiles"),
            (&[], &rings[..3], "draw rails"),
            (&[], &rings[..1], "draw one rail"),
        ] {
            let message = method(rails, profiles).unwrap_err().to_string();
            assert!(message.contains(part), "{message}");
        }
        let mixed = method(&lines[..2], &[ring(0.0), line(0.5)]).unwrap_err().to_string();
        assert!(mixed.contains("all open or all closed"), "{mixed}");
    }

    #[test]
    fn every_method_makes_its_detail() {
        let options = GenerateOptions { sections: 12, nodes: 24, ..GenerateOptions::default() };
        let made = |detail: &Detail<'_>| {
            let method = detail.method(options.snap).unwrap();
            (method, detail.generate(method, &options, &|_| true).unwrap().sections.len())
        };
        let sorted = sort(&mouth(40), &SortOptions::default()).unwrap();
        let (rails, rim) = dome(4);
        let (along, across) = cuff(40);
        let tube: Vec<Curve> = (0..4).map(|k| open("rail", 4, |t| ring(0.2 * t).points()[25 * k])).collect();
        let rings = [ring(0.0), ring(0.2)];
        let (up, down) = (vec![DVec3::Y; 100], vec![-DVec3::Y; 100]);
        let beyond = [Some(Neighbour::Directions(&up)), Some(Neighbour::Directions(&down))];
        let arc = open("arc", 40, |t| DVec3::new(0.1 * (PI * t).cos(), 0.1 * (PI * t).sin(), 0.0));
        let none = Detail::default();
        for (detail, method) in [
            (Detail { rails: &tube, ..none }, Method::TwoViews),
            (Detail { rails: &tube, profiles: &rings, ..none }, Method::ThroughClosed),
            (Detail { rails: &sorted.rails, profiles: &sorted.closed, ..none }, Method::ToApex),
            (Detail { rails: &rails, profiles: std::slice::from_ref(&rim), ..none }, Method::ToApex),
            (Detail { rails: std::slice::from_ref(&arc), profiles: &rings[..1], ..none }, Method::Arch),
            (Detail { rails: &along, profiles: &across, ..none }, Method::Sheet),
            (Detail { rails: &sphere_patch(4, 40), ..none }, Method::Network),
            (Detail { profiles: &rings, neighbours: &beyond, ..none }, Method::Blend),
        ] {
            assert_eq!(made(&detail), (method, 12));
        }
        let refused =
            |detail: Detail<'_>, method| detail.generate(method, &options, &|_| true).unwrap_err().to_string();
        assert!(refused(Detail { profiles: &rings, ..none }, Method::Blend).contains("give a neighbour"));
        assert!(refused(none, Method::TwoViews).contains("four open contours"));
        assert!(refused(none, Method::ToApex).contains("one closed profile"));
        assert!(refused(none, Method::Arch).contains("one rail"));
    }
}
