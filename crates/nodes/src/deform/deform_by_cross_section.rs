//! **Deform by cross-section**: a sketched cross-section pulls the sections around it.
//! Reference: end of thesis 5.5, Figure 5.7.

use maquette_geometry::deform::{
    Continuity, CrossSectionError, CrossSectionOptions, Matching, RangeBy, deform_by_cross_sections,
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

#[derive(Clone, Copy)]
struct RangeChoice(RangeBy);

impl Choices for RangeChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(RangeBy::Distance), "distance", "in metres along the sections: before, after"),
        (Self(RangeBy::Sections), "sections", "in sections: sections-before, sections-after"),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "deform-by-cross-section",
        1,
        "deform",
        "Pulls sections to one or several sketched cross-sections within a range; the rest keeps its shape.",
    );
    node.reference("thesis 5.5 (end), Figure 5.7");
    let sections = node.input::<wire::Sections>("sections", "Sections to deform.");
    let contours = node.input::<wire::Curves>(
        "contours",
        "Closed curves: what the section nearest to each becomes. Between contours whose ranges overlap sections follow \
         both.",
    );
    node.input_formerly(contours, "contour");
    let range = node.choice::<RangeChoice>("range", "How the influence range is measured.");
    let before = node.length("before", 0.1, 0.0..=1e3, "Influence range from the contour towards the first section.");
    node.soft_range(before, 0.0..=1.0);
    let after = node.length("after", 0.1, 0.0..=1e3, "Influence range from the contour towards the last section.");
    node.soft_range(after, 0.0..=1.0);
    let sections_before =
        node.integer("sections-before", 4, 2..=65_536, "Influence range towards the first section, in sections.");
    node.soft_range(sections_before, 2.0..=32.0);
    let sections_after =
        node.integer("sections-after", 4, 2..=65_536, "Influence range towards the last section, in sections.");
    node.soft_range(sections_after, 2.0..=32.0);
    let continuity = node.choice::<ContinuityChoice>("continuity", "What is kept at the ends of the range.");
    let matching = node.choice::<MatchingChoice>("matching", "How points of the contour and the section correspond.");
    let stiffness = StiffnessInputs::declare(&mut node);
    let deformed = node.output::<wire::Sections>("sections", "The deformed sections; the contours are among them.");
    let replaced = node.figure("section", Unit::None, "The section that the first contour replaces, counted from 0.");
    let moving = node.figure("sections-moved", Unit::None, "How many sections move, the replaced ones among them.");
    let farthest = node.figure("largest-move", Unit::Length, "How far the point moves that moves farthest.");
    let table = node.table(
        "contours",
        &[("contour", Unit::None), ("section", Unit::None), ("first", Unit::None), ("last", Unit::None)],
        "The section that each contour replaces, and the ends of its influence range, which stay in place.",
    );
    node.evaluate(move |ports| {
        let progress = ports.progress_callback();
        let measured = ports.choice(range).0;
        #[expect(clippy::cast_precision_loss, reason = "counts of sections")]
        let (reach_before, reach_after) = match measured {
            RangeBy::Distance => (ports.value(before), ports.value(after)),
            RangeBy::Sections => (ports.count(sections_before) as f64, ports.count(sections_after) as f64),
        };
        let options = CrossSectionOptions {
            stiffness: stiffness.read(ports)?,
            range: measured,
            before: reach_before,
            after: reach_after,
            continuity: ports.choice(continuity).0,
            matching: ports.choice(matching).0,
        };
        use CrossSectionError as E;
        let (stack, drawn) = (&ports.read(sections).0, &ports.read(contours).0);
        let result = match deform_by_cross_sections(stack, drawn, &options, &progress) {
            Err(E::Cancelled) => Err(NodeError::Cancelled),
            Err(error @ (E::Reach { which, .. } | E::RangeTooSmall { which, .. })) => {
                Err(error).at(if which == "before" { before } else { after })
            }
            Err(error @ E::TooFewInRange { which, .. }) => {
                Err(error).at(if which == "before" { sections_before } else { sections_after })
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
            result => result.at(contours),
        }?;
        let mut moves = vec![false; result.sections.len()];
        for (curve, found) in drawn.iter().zip(&result.replaced) {
            let name = if drawn.len() == 1 { String::new() } else { format!(" \"{}\"", curve.name()) };
            ports.note(format!(
                "the contour{name} replaces section {}; sections {} to {} move",
                found.section,
                found.first + 1,
                found.last.saturating_sub(1)
            ));
            moves[found.first + 1..found.last].fill(true);
        }
        result.notes.iter().for_each(|note| ports.note(note));
        #[expect(clippy::cast_precision_loss, reason = "counts of sections")]
        {
            ports.figure(replaced, result.replaced.first().map_or(0.0, |found| found.section as f64));
            ports.figure(moving, moves.iter().filter(|moves| **moves).count() as f64);
            let row = |(curve, found): (&maquette_geometry::curve::Curve, &maquette_geometry::deform::Replaced)| {
                let places = [found.section, found.first, found.last].map(|place| (place as f64).into());
                std::iter::once(curve.name().into()).chain(places).collect()
            };
            ports.table(table, drawn.iter().zip(&result.replaced).map(row).collect());
        }
        ports.figure(farthest, result.largest_move);
        ports.write(deformed, wire::Sections(result.sections));
        Ok(())
    });
    node
}
