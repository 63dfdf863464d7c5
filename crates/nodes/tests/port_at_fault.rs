//! A failure names the input at which the remedy lies.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that panics fails")]

use glam::DVec3;
use maquette_geometry::curve::Curve;
use maquette_geometry::sections::Sections;
use maquette_graph::{Catalogue, Evaluator, Graph, Literal, NodeKind, OutcomeState, Report, Request, Wire};
use maquette_nodes::wire;

fn constant<T: Wire + Clone>(name: &str, value: T) -> NodeKind {
    let mut node = NodeKind::declare(name, 1, "test", "A fixed value.");
    let out = node.output::<T>("out", "The value.");
    node.evaluate(move |ports| {
        ports.write(out, value.clone());
        Ok(())
    });
    node
}

fn ring(name: &str, radius: f64, height: f64) -> Curve {
    let angles = (0..48).map(|k| f64::from(k) * std::f64::consts::TAU / 48.0);
    let points = angles.map(|a| DVec3::new(radius * a.cos(), height, -radius * a.sin()));
    Curve::new(name, points.collect(), true).unwrap()
}

fn rails(order: [usize; 4]) -> wire::Curves {
    let names = ["left", "back", "right", "front"];
    let rail = |k: usize| {
        let angle = k as f64 * std::f64::consts::FRAC_PI_2;
        let out = DVec3::new(angle.cos(), 0.0, -angle.sin());
        let points = (0..=20).map(|i| out + DVec3::Y * (0.1 * f64::from(i)));
        Curve::new(names[k], points.collect(), false).unwrap()
    };
    wire::Curves(order.map(rail).into())
}

fn sections(rows: i32, closed: bool) -> wire::Sections {
    let row = |k: i32| ring("", 1.0, f64::from(k) / 10.0).points().to_vec();
    wire::Sections(Sections::new((0..rows).map(row).collect(), closed, vec![]).unwrap())
}

/// Links and settings of one node.
struct Wiring {
    kind: &'static str,
    links: Vec<(&'static str, NodeKind)>,
    settings: Vec<(&'static str, Literal)>,
}

impl Wiring {
    fn run(self) -> Result<Report, (Option<String>, String)> {
        let mut catalogue: Catalogue = maquette_nodes::catalogue().unwrap();
        let mut graph = Graph::new();
        let node = graph.add(&catalogue, self.kind, "tested").unwrap();
        for (input, source) in self.links {
            let name = source.name().to_owned();
            catalogue.register(source).unwrap();
            let source = graph.add(&catalogue, &name, &name).unwrap();
            graph.connect(&catalogue, source, "out", node, input).unwrap();
        }
        for (input, literal) in self.settings {
            graph.set(node, input, literal).unwrap();
        }
        let evaluation = Evaluator::default().evaluate(&catalogue, &graph, &Request::nodes(&[node]));
        match &evaluation.outcome(node).unwrap().state {
            OutcomeState::Done { report, .. } => Ok((**report).clone()),
            OutcomeState::Failed(failure) => Err((failure.port.clone(), failure.message.clone())),
            other => panic!("{other:?}"),
        }
    }

    fn blames(self, port: &str, said: &str) {
        let (input, message) = self.run().unwrap_err();
        assert_eq!(input.as_deref(), Some(port), "{message}");
        assert!(message.contains(said), "{message}");
    }
}

fn text(value: &str) -> Literal {
    Literal::Choice(value.to_owned())
}

#[test]
fn deform_by_cross_section() {
    let run = |stack: wire::Sections, contour: Curve, settings: Vec<(&'static str, Literal)>| Wiring {
        kind: "deform-by-cross-section",
        links: vec![("sections", constant("stack", stack)), ("contour", constant("drawn", wire::Curve(contour)))],
        settings,
    };
    let number = Literal::Number;
    let contour = || ring("waist", 0.8, 0.5);
    run(sections(11, true), contour(), vec![("before", number(0.0))]).blames("before", "before section 5");
    run(sections(11, true), contour(), vec![("before", number(0.3)), ("after", number(0.0))])
        .blames("after", "after section 5");
    run(sections(11, false), contour(), vec![]).blames("sections", "sections are open");
    run(sections(4, true), contour(), vec![]).blames("sections", "at least 5");
    run(sections(11, true), ring("far", 1.0, 50.0), vec![]).blames("contour", "onto the surface");
}

#[test]
fn detail_generator() {
    let run = |rails: wire::Curves, closed: Option<Vec<Curve>>, settings: Vec<(&'static str, Literal)>| Wiring {
        kind: "detail-generator",
        links: std::iter::once(("rails", constant("drawn", rails)))
            .chain(closed.map(|closed| ("profiles", constant("loops", wire::Curves(closed)))))
            .collect(),
        settings,
    };
    let ordered = || rails([0, 1, 2, 3]);
    let rings = || vec![ring("bottom", 1.0, 0.0), ring("top", 1.0, 2.0)];
    run(rails([0, 2, 3, 1]), None, vec![]).blames("rails", "pass them through `sort`");
    run(ordered(), Some(rings()), vec![("sections", Literal::Integer(3))]).blames("sections", "at least 4");
    run(ordered(), Some(rings().into_iter().map(Curve::reversed).collect()), vec![]).blames("profiles", "reverse it");
    run(ordered(), Some(rings()[..1].to_vec()), vec![]).blames("rails", "the point where the rails meet");
    run(ordered(), Some(vec![ring("bottom", 1.0, 0.0), ordered().0[0].clone()]), vec![])
        .blames("profiles", "all open or all closed");
    let lone = wire::Curves(ordered().0[..1].to_vec());
    run(lone, Some(rings()), vec![]).blames("profiles", "draw at least 2 rails");
    run(ordered(), None, vec![("case", text("between-closed"))]).blames("profiles", "at least 2 needed");
    run(wire::Curves::default(), Some(rings()), vec![]).blames("rails", "`blend` node");
    let forced = vec![("case", text("between-closed"))];
    run(ordered(), Some(ordered().0[..2].to_vec()), forced).blames("profiles", "is open");
    let far = rings().into_iter().map(|ring| ring.map(|p| p * 1e101).unwrap()).collect();
    run(ordered(), Some(far), vec![]).blames("profiles", "scale it down");
    assert!(run(ordered(), Some(rings()), vec![]).run().unwrap().warnings.is_empty());
}

#[test]
fn detail_generator_warns_of_a_snap_larger_than_the_shape() {
    let wiring = Wiring {
        kind: "detail-generator",
        links: vec![("rails", constant("drawn", rails([0, 1, 2, 3])))],
        settings: vec![("snap", Literal::Number(10.0))],
    };
    let warnings = wiring.run().unwrap().warnings;
    assert!(warnings.len() == 2 && warnings[0].contains("Lower the snap"), "{warnings:?}");
}

#[test]
fn surface_from_cross_sections() {
    let run = |stack: wire::Sections, settings: Vec<(&'static str, Literal)>| Wiring {
        kind: "surface-from-cross-sections",
        links: vec![("sections", constant("stack", stack))],
        settings,
    };
    run(sections(4, false), vec![("cap-start", text("flat"))]).blames("cap-start", "section 0 is an open curve");
    run(sections(4, false), vec![("cap-end", text("flat"))]).blames("cap-end", "section 3 is an open curve");
    let most = vec![("rows", Literal::Integer(64)), ("columns", Literal::Integer(64))];
    run(sections(400, true), most).blames("rows", "lower rows");
    let row = ring("", 1.0, 0.0).points().to_vec();
    let twins = wire::Sections(Sections::new(vec![row.clone(), row], true, vec![]).unwrap());
    run(twins, vec![]).blames("sections", "identical");
}
