//! Nodes that deform what others made.

use maquette_geometry::deform::StrokeMatching;
use maquette_graph::Choices;

pub(crate) mod align_primitive;
pub(crate) mod beam;
pub(crate) mod bind_deformation;
#[expect(clippy::module_inception, reason = "the kind is called `deform`")]
pub(crate) mod deform;
pub(crate) mod deform_by_cross_section;
pub(crate) mod deform_to_curves;
pub(crate) mod deform_to_silhouette;
pub(crate) mod handle;

/// How points of two strokes find each other.
#[derive(Clone, Copy)]
pub(crate) struct MatchingChoice(pub(crate) StrokeMatching);

impl Choices for MatchingChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (
            Self(StrokeMatching::ArcLength),
            "arc-length",
            "at the same share of the way; follows strokes that fold back, sections tilt where one side is longer",
        ),
        (Self(StrokeMatching::Height), "height", "at the same share of the height: sections stay level"),
    ];
}
