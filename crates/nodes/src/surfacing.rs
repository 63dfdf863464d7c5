//! Choices that nodes on surfaces share.

use maquette_geometry::surface::analytic::{Blend, Continuity, EndCondition};
use maquette_geometry::surface::tessellate::Closing;
use maquette_geometry::surface::{PoleShape, UParameter};
use maquette_graph::Choices;

#[derive(Clone, Copy)]
pub(crate) struct ClosingChoice(pub Closing);

impl Choices for ClosingChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(Closing::Open), "none", "the end stays open"),
        (Self(Closing::Flat), "flat", "a flat lid with a hard edge"),
        (Self(Closing::Rounded), "rounded", "a dome that goes on smoothly; for sections that are series"),
    ];
}

#[derive(Clone, Copy)]
pub(crate) struct ParameterChoice(pub UParameter);

impl Choices for ParameterChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(UParameter::Centripetal), "centripetal", "by the square root of distances: swings least"),
        (Self(UParameter::ChordLength), "chord-length", "by distances"),
        (Self(UParameter::Uniform), "uniform", "equal steps, as the thesis has it (eq. 4.3)"),
    ];
}

#[derive(Clone, Copy)]
pub(crate) struct PoleChoice(pub PoleShape);

impl Choices for PoleChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(PoleShape::Round), "round", "smooth, like the crown of a head"),
        (Self(PoleShape::Pointed), "pointed", "sharp, like a horn"),
    ];
}

#[derive(Clone, Copy)]
pub(crate) struct BlendChoice(pub Blend);

impl Choices for BlendChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(Blend::Automatic), "automatic", "the polynomial for up to 8 sections that are series, else the spline"),
        (Self(Blend::Polynomial), "polynomial", "as the thesis has it (4.1): swings from about 8 sections on"),
        (Self(Blend::Spline), "spline", "a C2 spline: for any number of sections"),
    ];
}

#[derive(Clone, Copy)]
pub(crate) struct JoinChoice(pub Continuity);

impl Choices for JoinChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(Continuity::Tangent), "tangent", "without a crease"),
        (Self(Continuity::Curvature), "curvature", "without a jump of curvature"),
    ];
}

#[derive(Clone, Copy, PartialEq)]
pub(crate) enum EndChoice {
    Free,
    Natural,
}

impl Choices for EndChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Free, "free", "as the sections next to it tell"),
        (Self::Natural, "natural", "a spline ends without curvature, as a ruler would"),
    ];
}

impl EndChoice {
    /// What is asked of the surface.
    pub(crate) fn condition(self) -> EndCondition {
        match self {
            Self::Free => EndCondition::Free,
            Self::Natural => EndCondition::Natural,
        }
    }
}

/// The blend that was taken, in words.
pub(crate) fn blend_name(blend: Blend) -> &'static str {
    match blend {
        Blend::Polynomial => "the polynomial",
        Blend::Spline | Blend::Automatic => "the spline",
    }
}
