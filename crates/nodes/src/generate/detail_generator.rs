//! **Detail generator**: a shape grown through sketched curves by the beam ODE.
//! Reference: thesis 6.1 to 6.3; paper 5.2.

use maquette_geometry::generate::{
    ArchBorder, Detail, Frame, GenerateError, GenerateOptions, Generated, LocalDetail, Method, Neighbour,
    ViewPlacement, Weights, arch,
};
use maquette_graph::{AtPort, Choices, NodeError, NodeKind, Unit};

use crate::neighbours::beside;
use crate::stiffness::StiffnessInputs;
use crate::wire;

/// The method; none is by what is connected.
#[derive(Clone, Copy, PartialEq)]
struct CaseChoice(Option<Method>);

impl Choices for CaseChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self(None), "auto", "by what is connected"),
        (Self(Some(Method::TwoViews)), "two-views", "four open contours from two views, joined in a point or not"),
        (Self(Some(Method::ThroughClosed)), "between-closed", "rails between two closed profiles, or past several"),
        (
            Self(Some(Method::ToApex)),
            "to-point",
            "rails from a closed profile to a point, or two contours that cross there",
        ),
        (Self(Some(Method::Arch)), "cap", "one open contour over a closed profile"),
        (Self(Some(Method::Sheet)), "sheet", "rails past two or more open profiles: a thin sheet"),
        (Self(Some(Method::Network)), "patch", "a patch in a loop of three or four borders, with curves inside it"),
    ];
}

/// How a cap leaves its profile where it continues nothing.
#[derive(Clone, Copy)]
enum CapChoice {
    Parabola,
    Round,
}

impl Choices for CapChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Parabola, "parabola", "as in the thesis"),
        (Self::Round, "round", "along circles: half a sphere comes out round"),
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
        2,
        "generate",
        "Grows sections through sketched curves: contours of two views, rails along or to a point past closed or open \
         profiles, a contour over a closed one, a patch in a loop of borders. Continues its neighbours smoothly.",
    );
    node.reference("thesis 6.1 (Figures 6.1-6.3), 6.2 (6.4, 6.5), 6.3 (6.6-6.10), appendices B-D; paper 5.2");
    let rails = node.input::<wire::Curves>(
        "rails",
        "Open curves along the shape, in order around, as `sort` gives them; of a patch its borders, in any order.",
    );
    let profiles = node.optional::<wire::Curves>(
        "profiles",
        "Curves across the rails, all closed or all open, in the order in which the rails meet them; if any.",
    );
    node.input_formerly(profiles, "closed");
    let inner = node.optional::<wire::Curves>("inner", "Patch: curves inside it, from one border to the opposite one.");
    let neighbours = node.optional::<wire::Borders>(
        "neighbours",
        "Borders of surfaces to continue, as `boundary-of` gives them; each lies along a profile, or a border of the patch.",
    );
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
    let cap =
        node.choice::<CapChoice>("cap", "One contour over a closed profile: how it rises where it continues nothing.");
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
        let list =
            |input| ports.read_optional(input).map(|curves: &wire::Curves| curves.0.as_slice()).unwrap_or_default();
        let across = list(profiles);
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
        let alone = Detail { rails: drawn, profiles: across, inner: list(inner), neighbours: &[] };
        let method = match ports.choice(case).0 {
            Some(method) => method,
            // Two closed curves alone would be a blend, which has a node of its own.
            None => match alone.method(options.snap) {
                Ok(Method::Blend) => {
                    return Err("two closed profiles without rails: draw rails, or use a `blend` node").at(rails);
                }
                Err(error) if !across.is_empty() => Err(error).at(profiles)?,
                method => method.at(rails)?,
            },
        };
        let borders = ports.read_optional(neighbours).map(|borders| borders.0.as_slice()).unwrap_or_default();
        let edges: Vec<_> = match method {
            Method::Network => drawn.iter().collect(),
            Method::TwoViews => Vec::new(),
            Method::ToApex | Method::Arch => across.first().into_iter().collect(),
            Method::ThroughClosed | Method::Sheet | Method::Blend => {
                across.first().into_iter().chain(across.last()).collect()
            }
        };
        let directions = beside(borders, &edges, options.snap).at(neighbours)?;
        let beyond: Vec<Option<Neighbour<'_>>> =
            directions.iter().map(|found| found.as_deref().map(Neighbour::Directions)).collect();
        let detail = Detail { neighbours: &beyond, ..alone };
        let made = match (method, drawn.as_slice(), across, ports.choice(cap)) {
            (Method::Arch, [open], [closed], CapChoice::Round) if borders.is_empty() => {
                arch(open, closed, ArchBorder::Round, &options, &progress)
            }
            _ => detail.generate(method, &options, &progress),
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
            Err(
                error @ (E::CurveIsOpen { .. }
                | E::CurveIsClosed { .. }
                | E::CurveIsReversed { .. }
                | E::TooFewProfiles { .. }
                | E::EnclosesNothing { .. }),
            ) => Err(error).at(profiles),
            Err(error @ (E::NoDirection { .. } | E::Border(_))) => Err(error).at(neighbours),
            Err(error @ E::TooFewNodes { .. }) => Err(error).at(nodes),
            Err(E::TooFarOut { name }) if drawn.iter().all(|rail| rail.name() != name) => {
                Err(E::TooFarOut { name }).at(profiles)
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
