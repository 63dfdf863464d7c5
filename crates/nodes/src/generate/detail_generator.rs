//! **Detail generator**: a shape grown through sketched curves by the beam ODE.
//! Reference: thesis 6.1 and 6.3; paper 5.2.

use maquette_geometry::generate::{
    Case, Frame, GenerateError, GenerateOptions, Generated, LocalDetail, ViewPlacement, Weights, between_closed,
    two_views,
};
use maquette_graph::{AtPort, Choices, NodeError, NodeKind, Unit};

use crate::stiffness::StiffnessInputs;
use crate::wire;

#[derive(Clone, Copy, PartialEq)]
enum CaseChoice {
    Auto,
    TwoViews,
    BetweenClosed,
}

impl Choices for CaseChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Auto, "auto", "by what is connected"),
        (Self::TwoViews, "two-views", "four open contours from two views, joined in a point or not"),
        (Self::BetweenClosed, "between-closed", "rails between two closed curves"),
    ];
}

#[derive(Clone, Copy)]
struct WeightsChoice(Weights);

impl Choices for WeightsChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(Weights::Smooth), "smooth", "no crease along the rails"),
        (Self(Weights::Linear), "linear", "as printed in the thesis: creases along the rails"),
    ];
}

#[derive(Clone, Copy)]
struct FrameChoice(Frame);

impl Choices for FrameChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(Frame::Turning), "turning", "displacements turn with the closed curves: round stays round"),
        (Self(Frame::Fixed), "fixed", "as printed in the thesis"),
    ];
}

#[derive(Clone, Copy)]
struct PlacementChoice(ViewPlacement);

impl Choices for PlacementChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(ViewPlacement::Centred), "centred", "each contour moves in depth to the middle of the other view's"),
        (Self(ViewPlacement::AsDrawn), "as-drawn", "each contour stays in the plane it was drawn in"),
    ];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "detail-generator",
        1,
        "generate",
        "Grows sections through sketched curves: four contours of two views, or rails between two closed curves.",
    );
    node.reference("thesis 6.1 (Figures 6.1-6.3) and 6.3 (Figures 6.8, 6.9), appendices B-D; paper 5.2");
    let rails = node.input::<wire::Curves>("rails", "Open curves in order around, as `sort` gives them.");
    let closed = node.optional::<wire::Curves>("closed", "Two closed curves between which the rails run, if any.");
    let case = node.choice::<CaseChoice>("case", "Which method; a choice forces it.");
    let sections = node.integer(
        "sections",
        48,
        3..=4096,
        "Sections made: nodes on each generator between closed curves, stations along the contours of two views.",
    );
    node.soft_range(sections, 8.0..=128.0);
    let nodes = node.integer(
        "nodes",
        64,
        8..=4096,
        "Points of each section: nodes on each closed generator of two views. Rounded up so that every rail has one.",
    );
    node.soft_range(nodes, 16.0..=256.0);
    let stiffness = StiffnessInputs::declare(&mut node);
    let weights = node.choice::<WeightsChoice>("weights", "How one rail's shape turns into the next one's.");
    let frame = node.choice::<FrameChoice>("frame", "Between closed curves: how what two rails add is blended.");
    let placement =
        node.choice::<PlacementChoice>("placement", "Depth of the contours of two views; a contour does not tell it.");
    let detail_reach = node.number(
        "detail-reach",
        1.0,
        0.05..=1.0,
        "Two views: how far around fine bends of a contour reach, as a share of the way to the next; 1 as in the thesis.",
    );
    let detail_wave = node.length(
        "detail-wave",
        0.1,
        1e-4..=1e3,
        "Two views: bends of a contour shorter than this count as fine; matters where detail-reach is below 1.",
    );
    node.soft_range(detail_wave, 0.01..=0.5);
    let snap = node.length("snap", 0.02, 0.0..=10.0, "How far a rail's end may be from where it should be.");
    node.soft_range(snap, 0.0..=0.1);
    let generated = node.output::<wire::Sections>("sections", "The sections; the rails run along them.");
    let widest = node.figure(
        "largest-gap",
        Unit::Length,
        "Largest distance bridged between a rail's end and where it should be; at most the snap.",
    );
    let bridged = node.table(
        "rails",
        &[("rail", Unit::None), ("start-gap", Unit::Length), ("end-gap", Unit::Length)],
        "The distances bridged at both ends of each rail.",
    );
    node.evaluate(move |ports| {
        let drawn = &ports.read(rails).0;
        let loops = ports.read_optional(closed).map(|curves| curves.0.as_slice()).unwrap_or_default();
        let options = GenerateOptions {
            stiffness: stiffness.read(ports)?,
            sections: ports.count(sections),
            nodes: ports.count(nodes),
            weights: ports.choice(weights).0,
            frame: ports.choice(frame).0,
            placement: ports.choice(placement).0,
            detail: Some(LocalDetail { wave: ports.value(detail_wave), reach: ports.value(detail_reach) })
                .filter(|detail| detail.reach < 1.0),
            snap: ports.value(snap),
        };
        let progress = ports.progress_callback();
        let case = match ports.choice(case) {
            CaseChoice::Auto => match Case::of(drawn.len(), loops.len()) {
                Err(error) if !matches!(loops.len(), 0 | 2) => Err(error).at(closed)?,
                case => case.at(rails)?,
            },
            CaseChoice::TwoViews => Case::TwoViews,
            CaseChoice::BetweenClosed => Case::BetweenClosed,
        };
        let made = match case {
            Case::TwoViews => {
                let four: &[_; 4] = drawn
                    .as_slice()
                    .try_into()
                    .map_err(|_| {
                        format!(
                            "two views take four open contours, and {} arrive: pass them through `sort`",
                            drawn.len()
                        )
                    })
                    .at(rails)?;
                two_views(four, &options, &progress)
            }
            Case::BetweenClosed => {
                let [start, end] = loops else {
                    return Err(format!(
                        "rails run between two closed curves, and {} arrive: connect both to \"closed\"",
                        loops.len()
                    ))
                    .at(closed);
                };
                between_closed(drawn, start, end, &options, &progress)
            }
        };
        use GenerateError as E;
        let made = match made {
            Err(E::Cancelled) => Err(NodeError::Cancelled),
            Err(error @ E::TooFewSections { .. }) => Err(error).at(sections),
            Err(error @ E::TooLarge { sections: many, nodes: each }) => {
                Err(error).at(if many > each { sections } else { nodes })
            }
            Err(error @ E::Beam(_)) => Err(error).at(nodes),
            Err(error @ E::Snap { .. }) => Err(error).at(snap),
            Err(error @ (E::CurveIsOpen { .. } | E::CurveIsReversed { .. })) => Err(error).at(closed),
            Err(E::TooFarOut { name }) if drawn.iter().all(|rail| rail.name() != name) => {
                Err(E::TooFarOut { name }).at(closed)
            }
            made => made.at(rails),
        };
        let Generated { sections, notes, warnings, largest_gap, gaps } = made?;
        notes.iter().for_each(|note| ports.note(note));
        warnings.iter().for_each(|warning| ports.warn(warning));
        ports.figure(widest, largest_gap);
        let rows =
            drawn.iter().zip(gaps).map(|(rail, [start, end])| vec![rail.name().into(), start.into(), end.into()]);
        ports.table(bridged, rows.collect());
        ports.write(generated, wire::Sections(sections));
        Ok(())
    });
    node
}
