//! **Beam reference**: how a real beam or ring bends.
//! Reference: Euler-Bernoulli beams, the thin ring, the elastica; thesis 6.5 is measured against them.

use glam::DVec2;
use maquette_geometry::beam::theory::{Given, TheoryCase, TheoryError, bend};
use maquette_geometry::curve::Curve;
use maquette_graph::{AtPort, Choices, NodeKind, Unit};

use crate::view_plane::ViewPlane;
use crate::wire;

#[derive(Clone, Copy)]
struct Case(TheoryCase);

impl Choices for Case {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] = &[
        (
            Self(TheoryCase::Cantilever),
            "cantilever",
            "held fast at one end, a load on the other: d x^2 (3 L - x) / (2 L^3), d = F L^3 / (3 EI)",
        ),
        (
            Self(TheoryCase::Supported),
            "supported",
            "lying on both ends, a load in the middle: d x (3 L^2 - 4 x^2) / L^3, d = F L^3 / (48 EI)",
        ),
        (
            Self(TheoryCase::Ring),
            "ring",
            "a thin ring pulled apart by two loads: the half axis grows by 0.0744 F R^3 / EI, the other shrinks by 0.0683",
        ),
        (
            Self(TheoryCase::CantileverElastica),
            "cantilever-elastica",
            "the cantilever bent far, its length kept: EI k' = -F cos(angle)",
        ),
        (
            Self(TheoryCase::RingElastica),
            "ring-elastica",
            "the ring bent far, its length kept: EI k' = -F/2 sin(angle)",
        ),
    ];
}

#[derive(Clone, Copy)]
enum GivenChoice {
    Displacement,
    Load,
}

impl Choices for GivenChoice {
    const OPTIONS: &'static [(Self, &'static str, &'static str)] =
        &[(Self::Displacement, "displacement", "how far the loaded point moves"), (Self::Load, "load", "the load")];
}

pub(crate) fn kind() -> NodeKind {
    let mut node = NodeKind::declare(
        "beam-reference",
        1,
        "curve",
        "How a real beam or ring bends, by beam theory: what the curves of a beam are measured against.",
    );
    node.reference("Gere and Timoshenko, Mechanics of Materials; Timoshenko, Strength of Materials II; the elastica");
    let case = node.choice::<Case>("case", "What is loaded, and by which theory it bends.");
    let size = node.length("size", 0.3, 1e-6..=1e4, "Length of the beam L, or radius of the ring R.");
    node.soft_range(size, 0.01..=1.0);
    let given = node.choice::<GivenChoice>("given", "Which of the two below is known; the other one follows.");
    let displacement = node.length(
        "displacement",
        0.05,
        -1e4..=1e4,
        "How far the tip or the middle moves up, or how much a ring's half axis grows.",
    );
    node.soft_range(displacement, -0.1..=0.1);
    let load =
        node.number("load", 0.1, -1e12..=1e12, "The load F upwards in newtons; each of the two that pull a ring.");
    node.soft_range(load, -10.0..=10.0);
    let stiffness =
        node.number("stiffness", 0.03, 1e-12..=1e12, "Bending stiffness EI in N m^2; a plastic ruler has about 0.03.");
    node.soft_range(stiffness, 0.001..=10.0);
    let intervals = node.integer("intervals", 200, 4..=8191, "Equal intervals between the points.");
    node.soft_range(intervals, 32.0..=1024.0);
    let plane = node.choice::<ViewPlane>("plane", "The plane it lies in: from the origin along the first axis.");
    let rest = node.output::<wire::Curve>("rest", "The beam or ring without its load.");
    let bent = node.output::<wire::Curve>("curve", "The same points under the load.");
    let moved = node.figure("displacement", Unit::Length, "How far the loaded point moves.");
    let across = node.figure(
        "across",
        Unit::Length,
        "What moves across the load: growth of a ring's other half axis, or of a cantilever's reach.",
    );
    let loaded = node.figure("load", Unit::None, "The load, newtons.");
    node.evaluate(move |ports| {
        ports.progress(0.0)?;
        let (known, port) = match ports.choice(given) {
            GivenChoice::Displacement => (Given::Displacement(ports.value(displacement)), displacement),
            GivenChoice::Load => (Given::Load(ports.value(load)), load),
        };
        let chosen = ports.choice(case).0;
        let found = bend(chosen, ports.value(size), ports.value(stiffness), known, ports.count(intervals));
        let shape = match found {
            Err(error @ TheoryError::Intervals { .. }) => Err(error).at(intervals)?,
            found => found.at(port)?,
        };
        let closed = matches!(chosen, TheoryCase::Ring | TheoryCase::RingElastica);
        let plane = ports.choice(plane);
        let curve = |name: &str, points: &[DVec2]| {
            Curve::new(name, points.iter().map(|p| plane.place(*p, 0.0)).collect(), closed).map(wire::Curve)
        };
        let (at_rest, under_load) = (curve("rest", &shape.rest).at(size)?, curve("theory", &shape.bent).at(port)?);
        ports.figure(moved, shape.displacement);
        ports.figure(across, shape.across);
        ports.figure(loaded, shape.load);
        ports.write(rest, at_rest);
        ports.write(bent, under_load);
        Ok(())
    });
    node
}

#[cfg(test)]
mod tests {
    use super::*;
    use maquette_graph::Literal;
    use maquette_graph::harness::{Harness, TrialError};

    #[test]
    fn a_load_and_its_displacement_are_told() {
        let kind = kind();
        let choice = |name: &str| Literal::Choice(name.to_owned());
        // 0.1 N on 30 cm of EI = 0.03 N m^2: 3 cm.
        let trial = Harness::new(&kind).set("given", choice("load")).set("plane", choice("side")).run().unwrap();
        assert!((trial.report.figure("displacement").unwrap().value - 0.03).abs() < 1e-15);
        let tip = trial.value::<wire::Curve>("curve").unwrap().0.end();
        assert!(tip.distance(glam::DVec3::new(0.0, 0.03, 0.3)) < 1e-15, "{tip}");
        let ring = Harness::new(&kind).set("case", choice("ring-elastica")).set("size", Literal::Number(0.15)).run();
        let ring = ring.unwrap();
        assert!(ring.value::<wire::Curve>("curve").unwrap().0.is_closed());
        assert!(ring.report.figure("across").unwrap().value < -0.05, "it shrinks by more than it grows");
    }

    #[test]
    fn what_an_elastica_does_not_reach_is_refused() {
        let kind = kind();
        let far = Literal::Number(0.29);
        let case = Literal::Choice("cantilever-elastica".to_owned());
        let Err(TrialError::Failed(failure)) = Harness::new(&kind).set("case", case).set("displacement", far).run()
        else {
            panic!("it cannot reach there")
        };
        assert_eq!(failure.port.as_deref(), Some("displacement"));
        assert!(failure.message.contains("give less"), "{}", failure.message);
    }
}
