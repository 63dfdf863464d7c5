//! **Deform by cross-section**: a sketched cross-section pulls the sections around it.
//! Reference: end of thesis 5.5, Figure 5.7.

use maquette_geometry::deform::{
    Continuity, CrossSectionError, CrossSectionOptions, Matching, deform_by_cross_section,
};
use maquette_graph::{AtPort, Choices, NodeError, NodeKind, Unit};

use crate::stiffness::StiffnessInputs;
use crate::wire;

#[derive(Clone, Copy)]
struct ContinuityChoice(Continuity);

impl Choices for ContinuityChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (
            Self(Continuity::PositionAndTangent),
            "position-and-tangent",
            "the surface leaves the ends of the range as it did before: no crease",
        ),
        (Self(Continuity::Position), "position", "the ends of the range stay in place, with a crease"),
    ];
}

#[derive(Clone, Copy)]
struct MatchingChoice(Matching);

impl Choices for MatchingChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(Matching::Auto), "auto", "by angle where both curves can be seen whole from their centre"),
        (Self(Matching::Angle), "angle", "points move straight out from the centre"),
        (Self(Matching::ArcLength), "arc-length", "points keep their share of the way around"),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "deform-by-cross-section",
        1,
        "deform",
        "Pulls sections to a sketched cross-section within a range; the rest keeps its shape.",
    );
    node.reference("thesis 5.5 (end), Figure 5.7");
    let sections = node.input::<wire::Sections>("sections", "Sections to deform.");
    let contour = node.input::<wire::Curve>("contour", "A closed curve: what the section nearest to it becomes.");
    let before = node.length("before", 0.1, 0.0..=1e3, "Influence range from the contour towards the first section.");
    node.soft_range(before, 0.0..=1.0);
    let after = node.length("after", 0.1, 0.0..=1e3, "Influence range from the contour towards the last section.");
    node.soft_range(after, 0.0..=1.0);
    let continuity = node.choice::<ContinuityChoice>("continuity", "What is kept at the ends of the range.");
    let matching = node.choice::<MatchingChoice>("matching", "How points of the contour and the section correspond.");
    let stiffness = StiffnessInputs::declare(&mut node);
    let deformed = node.output::<wire::Sections>("sections", "The deformed sections; the contour is one of them.");
    let replaced = node.figure("section", Unit::None, "The section that the contour replaces, counted from 0.");
    let moving = node.figure("sections-moved", Unit::None, "How many sections move, the replaced one among them.");
    let farthest = node.figure("largest-move", Unit::Length, "How far the point moves that moves farthest.");
    node.evaluate(move |ports| {
        let progress = ports.progress_callback();
        let options = CrossSectionOptions {
            stiffness: stiffness.read(ports)?,
            before: ports.value(before),
            after: ports.value(after),
            continuity: ports.choice(continuity).0,
            matching: ports.choice(matching).0,
        };
        use CrossSectionError as E;
        let (stack, drawn) = (&ports.read(sections).0, &ports.read(contour).0);
        let result = match deform_by_cross_section(stack, drawn, &options, &progress) {
            Err(E::Cancelled) => Err(NodeError::Cancelled),
            Err(error @ (E::Reach { which, .. } | E::RangeTooSmall { which, .. })) => {
                Err(error).at(if which == "before" { before } else { after })
            }
            Err(
                error @ (E::SectionsAreOpen
                | E::TooFewSections { .. }
                | E::SectionIsFlat { .. }
                | E::Beam(_)
                | E::Sections(_)),
            ) => Err(error).at(sections),
            // Only matching by angle, as chosen, asks for it.
            Err(error @ E::NotStarShaped { .. }) => Err(error).at(matching),
            result => result.at(contour),
        }?;
        ports.note(format!(
            "the contour replaces section {}; sections {} to {} move",
            result.section,
            result.first + 1,
            result.last.saturating_sub(1)
        ));
        result.notes.iter().for_each(|note| ports.note(note));
        #[expect(clippy::cast_precision_loss, reason = "counts of sections")]
        {
            ports.figure(replaced, result.section as f64);
            ports.figure(moving, (result.last - result.first).saturating_sub(1) as f64);
        }
        ports.figure(farthest, result.largest_move);
        ports.write(deformed, wire::Sections(result.sections));
        Ok(())
    });
    node
}
