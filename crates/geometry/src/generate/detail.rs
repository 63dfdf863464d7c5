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
                    (0, 0, _) => "between several closed profiles draw rails",
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
