//! **Deform to silhouette**: the primitive deformer, which makes the outline of sections that of a sketch.
//! Reference: thesis 5.1-5.5 (Figures 5.2, 5.3, 5.5, 5.6a); paper 4.

use maquette_geometry::deform::{Contact, SectionSpacing, SilhouetteError, SilhouetteOptions, deform_to_silhouette};
use maquette_graph::{AtPort, Choices, NodeError, NodeKind, Unit};

use super::MatchingChoice;
use crate::silhouettes::SilhouetteInputs;
use crate::stiffness::StiffnessInputs;
use crate::wire;

#[derive(Clone, Copy)]
struct ContactChoice(Contact);

impl Choices for ContactChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(Contact::Tangent), "tangent", "the outline touches the strokes and stands out nowhere beside them"),
        (Self(Contact::Point), "point", "as printed in the thesis: tilted sections stand out beside their pins"),
    ];
}

#[derive(Clone, Copy)]
enum SpacingChoice {
    AsGiven,
    ByDetail,
}

impl Choices for SpacingChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::AsGiven, "as-given", "no other sections than those that are given"),
        (Self::ByDetail, "by-detail", "more between them where strokes have detail, as `tolerance` asks"),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "deform-to-silhouette",
        1,
        "deform",
        "Deforms sections until their outline passes through sketched strokes, in one view or in two at once.",
    );
    node.reference("thesis 5.1-5.5 (Figures 5.2, 5.3, 5.5, 5.6a), appendix A; paper 4");
    let sections = node.input::<wire::Sections>("sections", "Closed sections, placed where the strokes are.");
    let strokes = SilhouetteInputs::declare(
        &mut node,
        "two open ones, or one around the shape; one closed outline where the view looks along the sections.",
    );
    let matching = node.choice::<MatchingChoice>("matching", "How points of the strokes find theirs on the sections.");
    let contact = node.choice::<ContactChoice>("contact", "How sections touch the strokes.");
    let hold = node.boolean(
        "hold-rails",
        true,
        "With strokes of one view: the rails of the sections keep their place along them, so that the outline of an \
         earlier view stays exact.",
    );
    let spacing = node.choice::<SpacingChoice>(
        "spacing",
        "Where sections stand along the strokes. Nothing is added where the view looks along them.",
    );
    let tolerance = node.number(
        "tolerance",
        0.02,
        1e-4..=100.0,
        "How far strokes may pass the surface by between sections that are spaced by detail, in percent of the sketch's \
         diagonal.",
    );
    node.soft_range(tolerance, 0.005..=1.0);
    let stiffness = StiffnessInputs::declare(&mut node);
    let deformed = node.output::<wire::Sections>("sections", "The deformed sections; rails are where strokes touch.");
    let farthest = node.figure("largest-move", Unit::Length, "How far the point moves that moves farthest.");
    let overshoot = node.figure(
        "largest-overshoot",
        Unit::Length,
        "By how much a section stands out beyond its two pins in a view, at most.",
    );
    let gap = node.figure(
        "largest-gap",
        Unit::Length,
        "How far strokes pass the lines between the pins of neighbouring sections by, at most.",
    );
    let count = node.figure("sections", Unit::None, "How many sections there are.");
    node.evaluate(move |ports| {
        let silhouettes = strokes.read(ports)?;
        let options = SilhouetteOptions {
            stiffness: stiffness.read(ports)?,
            matching: ports.choice(matching).0,
            contact: ports.choice(contact).0,
            hold_rails: ports.value(hold),
            spacing: match ports.choice(spacing) {
                SpacingChoice::AsGiven => SectionSpacing::AsGiven,
                SpacingChoice::ByDetail => SectionSpacing::ByDetail(ports.value(tolerance) / 100.0),
            },
        };
        use SilhouetteError as E;
        let progress = ports.progress_callback();
        let made = match deform_to_silhouette(&ports.read(sections).0, &silhouettes, &options, &progress) {
            Err(E::Cancelled) => Err(NodeError::Cancelled),
            Err(E::Strokes(error)) => {
                let port = strokes.port(error.view(), &silhouettes);
                Err(error).at(port)
            }
            Err(error @ (E::Apart { view, .. } | E::OutlineNeeded { view })) => {
                Err(error).at(strokes.port(Some(view), &silhouettes))
            }
            Err(error @ (E::Level { .. } | E::NotStarShaped { .. })) => Err(error).at(matching),
            Err(error @ (E::Tolerance { .. } | E::TooMuchDetail { .. })) => Err(error).at(tolerance),
            made => made.at(sections),
        }?;
        made.notes.iter().for_each(|note| ports.note(note));
        made.warnings.iter().for_each(|warning| ports.warn(warning));
        ports.figure(farthest, made.largest_move);
        ports.figure(overshoot, made.views.iter().map(|view| view.overshoot).fold(0.0, f64::max));
        ports.figure(gap, made.views.iter().map(|view| view.gap).fold(0.0, f64::max));
        #[expect(clippy::cast_precision_loss, reason = "a count of sections")]
        ports.figure(count, made.sections.len() as f64);
        ports.write(deformed, wire::Sections(made.sections));
        Ok(())
    });
    node
}
