//! Rails between open curves: a thin sheet, or a patch over a network of curves.

use super::neighbour::Neighbour;
use super::sweep::{Drawing, sweep};
use super::{GenerateError, GenerateOptions, Generated};
use crate::curve::Curve;

/// A sheet along two or more rails past two or more open curves (thesis 6.3 with open curves, Figure 6.10; with
/// neighbours the patch of paper 5.2.4).
///
/// `rails` run from the first of the `profiles` to the last, in the order in which they stand along these; more profiles
/// between them shape the sheet there. It spans from the first rail to the last one, as far as the profiles may run on
/// beyond them. A generator between two rails has their blended sculpting forces and is pinned where it passes each
/// profile. Rails and profiles are reproduced; section 0 lies on the first profile, the last one on the last. With smooth
/// weights the fields meet without a crease.
///
/// With `neighbours` the sheet leaves the first profile, or reaches the last one, in the direction of the surface beyond
/// it (the virtual border): its speed there goes over from rail to rail. A rail that does not lie in the neighbour's
/// tangent plane is bent there, with a warning.
///
/// # Errors
/// [`GenerateError`] for fewer than 4 sections or 2 for each profile, fewer than 2 rails or profiles, closed curves, an
/// end or a crossing farther from its curve than the snap, rails that cross or share a foot, profiles that a rail does
/// not meet in their order, a neighbour without directions, and where `progress` asked to stop.
pub fn sheet(
    rails: &[Curve],
    profiles: &[Curve],
    neighbours: [Option<Neighbour<'_>>; 2],
    options: &GenerateOptions,
    progress: &dyn Fn(f64) -> bool,
) -> Result<Generated, GenerateError> {
    let drawing = Drawing {
        rails,
        profiles: profiles.iter().collect(),
        closed: false,
        apex: false,
        neighbours,
        sides: [None, None],
    };
    sweep(&drawing, options, progress)
}
