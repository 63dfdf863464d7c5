//! What is asked of an analytic surface.

use super::blend::Blend;
use super::surface::AnalyticSurface;
use crate::surface::{PoleShape, UParameter};

/// How far the derivatives of two surfaces agree where they meet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Continuity {
    /// The first derivative by u, scaled by the lengths of both: no crease.
    #[default]
    Tangent,
    /// The second derivative as well: no jump of curvature.
    Curvature,
}

/// What is wanted at the first or the last section of a surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum EndCondition {
    /// Nothing: the polynomial ends as it comes, the spline with the slope of the cubic through the four sections next
    /// to the end. At a pole the options' [`PoleShape`] holds.
    #[default]
    Free,
    /// The spline ends without second derivative, as a ruler would; the polynomial as it comes.
    Natural,
    /// It goes on where another surface ends (thesis 4.5 to 4.11): the first section is the last of the neighbour, or
    /// the last one the neighbour's first.
    ///
    /// The neighbour's derivatives are taken times `lambda`, the distance of sections per u here over that of the
    /// neighbour, each at the end where they meet (and `lambda` squared for the second).
    Neighbour {
        /// The surface that is there already.
        surface: AnalyticSurface,
        /// How far the derivatives agree.
        continuity: Continuity,
    },
}

/// How [`AnalyticSurface::through`] makes a surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceOptions {
    /// The functions of u.
    pub blend: Blend,
    /// How the sections are spread over u from 0 to 1. Distances are root mean squares over v, so that start points
    /// and the direction of v don't matter.
    pub parameter: UParameter,
    /// The shape at a first or last section that is a point.
    pub pole: PoleShape,
    /// What is wanted at u = 0.
    pub start: EndCondition,
    /// What is wanted at u = 1.
    pub end: EndCondition,
}
