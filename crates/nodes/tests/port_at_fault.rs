//! A failure names the input at which the remedy lies.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that panics fails")]

use std::f64::consts::TAU;

use glam::DVec3;
use maquette_geometry::curve::Curve;
use maquette_geometry::deform::laplacian::{HandleTransform, Holds};
use maquette_geometry::mesh::{Mesh, Selection};
use maquette_geometry::sections::Sections;
use maquette_geometry::surface::analytic::{AnalyticSurface, SurfaceOptions};
use maquette_geometry::trigonometric::{EllipticSection, EllipticSegment, PlaneFrame, Series};
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

/// Series: circles at these heights.
fn series(heights: &[f64]) -> wire::EllipticSections {
    let circle = |height: &f64| {
        let series = Series::new(vec![DVec3::Y * *height, DVec3::X * (1.0 + height), DVec3::NEG_Z * (1.0 + height)]);
        let segment = EllipticSegment { from: 0.0, to: TAU, local: false, series: series.unwrap() };
        let frame = PlaneFrame::new(DVec3::Y * *height, DVec3::Y);
        let section = EllipticSection::new(frame, true, vec![segment]).unwrap();
        wire::NamedSection { name: format!("at {height}"), section, fit: None }
    };
    wire::EllipticSections::new(heights.iter().map(circle).collect())
}

/// A surface through circles at these heights.
fn cone(heights: &[f64]) -> wire::Surface {
    let sections = series(heights).sections();
    wire::Surface::Series(vec![AnalyticSurface::through(&sections, &SurfaceOptions::default()).unwrap()])
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
        links: vec![
            ("sections", constant("stack", stack)),
            ("contours", constant("drawn", wire::Curves(vec![contour]))),
        ],
        settings,
    };
    let number = Literal::Number;
    let contour = || ring("waist", 0.8, 0.5);
    run(sections(11, true), contour(), vec![("before", number(0.0))]).blames("before", "before section 5");
    run(sections(11, true), contour(), vec![("before", number(0.3)), ("after", number(0.0))])
        .blames("after", "after section 5");
    run(sections(11, false), contour(), vec![]).blames("sections", "sections are open");
    run(sections(4, true), contour(), vec![]).blames("sections", "at least 5");
    run(sections(11, true), ring("far", 1.0, 50.0), vec![]).blames("contours", "onto the surface");
}

#[test]
fn beam() {
    let run = |rest: Curve, settings: Vec<(&'static str, Literal)>| Wiring {
        kind: "beam",
        links: vec![("rest", constant("line", wire::Curve(rest)))],
        settings,
    };
    let line = || Curve::new("line", vec![DVec3::ZERO, DVec3::X], false).unwrap();
    let words = |words: &str| Literal::Text(words.to_owned());
    run(line(), vec![("pins", words("half"))]).blames("pins", "is no pin");
    run(line(), vec![("pins", words("0.5 1 2"))]).blames("pins", "such as 0.5 0 -0.01 0");
    run(line(), vec![("pins", words("0.5; 1.5"))]).blames("pins", "pin 1 stands at 1.5");
    run(line(), vec![("pins", words("0.5; 0.5001"))]).blames("pins", "pins 0 and 1 both fall on node 100");
    run(line(), vec![("loads", words("0.5"))]).blames("loads", "has no force");
    run(line(), vec![("loads", words("-1 0 0 1"))]).blames("loads", "load 0 stands at -1");
    run(line(), vec![("start", text("free")), ("end", text("free"))]).blames("start", "both ends are free");
    run(ring("ring", 1.0, 0.0), vec![]).blames("pins", "at least one pin");
    run(ring("ring", 1.0, 0.0), vec![("pins", words("0")), ("intervals", Literal::Integer(4))])
        .blames("intervals", "at least 5");
    run(line(), vec![("k_b", Literal::Number(1e-9)), ("k_s", Literal::Number(1e9))]).blames("k_s", "k_s / k_b is");
}

#[test]
fn beam_reference() {
    let run = |settings| Wiring { kind: "beam-reference", links: vec![], settings };
    let bent_far = || ("case", text("cantilever-elastica"));
    run(vec![bent_far(), ("displacement", Literal::Number(0.3))]).blames("displacement", "give less");
    let loaded = ("given", text("load"));
    run(vec![bent_far(), loaded, ("load", Literal::Number(1e9))]).blames("load", "give less");
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
    run(sections(4, true), vec![("cap-start", text("rounded"))]).blames("cap-start", "put a `fit-sections` node");
    run(sections(4, true), vec![("blend", text("polynomial"))]).blames("blend", "take the spline");
    run(sections(4, true), vec![("end", text("natural"))]).blames("end", "set it to free");
    let beside = Wiring {
        kind: "surface-from-cross-sections",
        links: vec![
            ("sections", constant("stack", sections(4, true))),
            ("after", constant("beside", cone(&[2.0, 3.0]))),
        ],
        settings: vec![],
    };
    beside.blames("after", "disconnect it");
    run(sections(4, false), vec![("cap-start", text("flat"))]).blames("cap-start", "section 0 is an open curve");
    run(sections(4, false), vec![("cap-end", text("flat"))]).blames("cap-end", "section 3 is an open curve");
    let most = vec![("rows", Literal::Integer(64)), ("columns", Literal::Integer(64))];
    run(sections(400, true), most).blames("rows", "lower rows");
    let row = ring("", 1.0, 0.0).points().to_vec();
    let twins = wire::Sections(Sections::new(vec![row.clone(), row], true, vec![]).unwrap());
    run(twins, vec![]).blames("sections", "identical");
}

#[test]
fn surface_through_series() {
    let run = |heights: &[f64], beside: Option<(&'static str, wire::Surface)>, settings| Wiring {
        kind: "surface-from-cross-sections",
        links: std::iter::once(("sections", constant("stack", series(heights))))
            .chain(beside.map(|(input, surface)| (input, constant("beside", surface))))
            .collect(),
        settings,
    };
    run(&[0.0], None, vec![]).blames("sections", "at least 2");
    run(&[0.0, 0.0], None, vec![]).blames("sections", "identical");
    let many: Vec<f64> = (0..21).map(f64::from).collect();
    run(&many, None, vec![("blend", text("polynomial"))]).blames("blend", "use the spline");
    run(&[0.0, 1.0], Some(("before", cone(&[-0.5, -0.1]))), vec![]).blames("before", "the start of the surface");
    run(&[0.0, 1.0], Some(("after", cone(&[1.5, 2.0]))), vec![]).blames("after", "the end of the surface");
    run(&[0.0, 1.0], Some(("after", wire::Surface::Series(vec![]))), vec![]).blames("after", "no part");
    let points = wire::Surface::Points(std::sync::Arc::new(sections(4, true).0));
    run(&[0.0, 1.0], Some(("before", points)), vec![]).blames("before", "put a `fit-sections` node before it");
    let report = run(&[0.0, 1.0, 1.5], Some(("before", cone(&[-0.5, 0.0]))), vec![]).run().unwrap();
    assert_eq!(report.notes, ["blended by the polynomial through 3 sections"]);
    assert_eq!(report.figure("constants").unwrap().value, 9.0 * 4.0, "three sections and the slope at the joint");
    assert!(report.warnings.is_empty());
    // The second circle lies in the first one's plane and crosses nothing; run back, the surface meets itself.
    let spoilt = run(&[0.0, 1.0], None, vec![("cap-end", text("rounded"))]).run().unwrap();
    assert!(spoilt.figure("faces").unwrap().value > 128.0);
}

#[test]
fn fit_sections() {
    let run = |curves: Vec<Curve>, settings: Vec<(&'static str, Literal)>| Wiring {
        kind: "fit-sections",
        links: vec![("curves", constant("drawn", wire::Curves(curves)))],
        settings,
    };
    let integer = Literal::Integer;
    let ringed = || vec![ring("low", 1.0, 0.0), ring("high", 1.2, 1.0)];
    run(vec![], vec![]).blames("curves", "at least one");
    run([ringed(), rails([0, 1, 2, 3]).0].concat(), vec![]).blames("curves", "is open");
    run(rails([0, 1, 2, 3]).0, vec![("angles", text("polar"))]).blames("angles", "take arc length");
    let as_given = ("sampling", text("as-given"));
    run(ringed(), vec![("harmonics", integer(40)), as_given.clone()]).blames("harmonics", "lower the harmonics to 23");
    let given = |joints: &str| vec![("split", text("given")), ("joints", Literal::Text(joints.to_owned()))];
    run(ringed(), given("10, 370")).blames("joints", "both at the angle");
    run(rails([0, 1, 2, 3]).0, given("200")).blames("joints", "an open section is split inside");
    run(ringed(), [given("0, 10"), vec![as_given]].concat()).blames("joints", "move the joints apart");
    run(ringed(), [given("0, 90"), vec![("harmonics", integer(1))]].concat())
        .blames("harmonics", "raise the harmonics");
    run(ringed(), [given("0, 90"), vec![("most-harmonics", integer(1))]].concat()).blames("most-harmonics", "raise");
    let eight = (0..96).map(|k| f64::from(k) * TAU / 96.0).map(|t| DVec3::new(t.sin(), 0.0, (2.0 * t).sin())).collect();
    let warned = run(vec![Curve::new("eight", eight, true).unwrap()], vec![("most-harmonics", integer(1))]).run();
    let warnings = warned.unwrap().warnings;
    assert!(
        warnings[0].contains("\"eight\" crosses itself") && warnings[1].contains("with 1 harmonics"),
        "{warnings:?}"
    );
}

#[test]
fn join_surfaces() {
    let run = |surfaces: Vec<(&'static str, wire::Surface)>, settings| Wiring {
        kind: "join-surfaces",
        links: surfaces
            .into_iter()
            .map(|(input, surface)| (input, constant(&format!("to {input}"), surface)))
            .collect(),
        settings,
    };
    let [low, middle, high] = [[0.0, 0.5, 1.0], [1.0, 1.5, 2.0], [2.0, 2.4, 3.0]].map(|heights| cone(&heights));
    run(vec![], vec![]).blames("a", "connect at least one");
    run(vec![("a", low.clone()), ("b", cone(&[3.0, 2.0, 1.0]))], vec![]).blames("b", "\"a\" and \"b\" both end");
    run(vec![("a", low.clone()), ("c", high.clone())], vec![]).blames("c", "nothing begins where \"a\" ends");
    run(vec![("a", middle.clone()), ("c", high.clone()), ("d", high.clone())], vec![])
        .blames("d", "\"c\" and \"d\" both follow \"a\"");
    let points = wire::Surface::Points(std::sync::Arc::new(sections(4, true).0));
    run(vec![("a", low.clone()), ("b", points)], vec![]).blames("b", "put a `fit-sections` node before it");
    let report = run(vec![("b", high), ("c", low), ("h", middle)], vec![]).run().unwrap();
    assert_eq!(report.notes[0], "the chain runs through \"c\", \"h\", \"b\"");
    assert_eq!(["parts", "sections"].map(|name| report.figure(name).unwrap().value), [3.0, 7.0]);
}

#[test]
fn tessellate() {
    let run = |surface: wire::Surface, settings: Vec<(&'static str, Literal)>| Wiring {
        kind: "tessellate",
        links: vec![("surface", constant("made", surface))],
        settings,
    };
    let surface = || cone(&[0.0, 1.0, 1.5]);
    let (integer, number) = (Literal::Integer, Literal::Number);
    run(wire::Surface::Series(vec![]), vec![]).blames("surface", "no surface given");
    let parts = |low: &[f64], high: &[f64]| {
        wire::Surface::Series([low, high].iter().flat_map(|h| cone(h).series().unwrap().to_vec()).collect())
    };
    run(parts(&[0.0, 1.0], &[1.1, 2.0]), vec![]).blames("surface", "surface 1 does not begin where surface 0 ends");
    let most = vec![("rows", integer(65_536)), ("columns", integer(65_536))];
    run(surface(), most).blames("rows", "more than 50000000");
    let fine = vec![("by", text("deviation")), ("deviation", number(1e-9))];
    run(surface(), fine).blames("deviation", "more than 50000000");
    run(surface(), vec![("sections", integer(1))]).blames("sections", "there can be 2 to 3");
    let coarse = vec![("by", text("deviation")), ("sections", integer(2)), ("deviation", number(1e-6))];
    assert!(
        run(surface(), coarse).run().is_ok_and(|report| report.figure("deviation").unwrap().value <= 1e-6),
        "a cone needs two"
    );
    let report = run(surface(), vec![("measure", Literal::Boolean(false))]).run().unwrap();
    assert!(report.figure("deviation").is_none() && report.figure("faces").unwrap().value == 2048.0);
    let report = run(parts(&[0.0, 1.0], &[1.0, 2.0]), vec![]).run().unwrap();
    assert!(report.figure("deviation").unwrap().value > 1e-4);
}

#[test]
fn silhouettes() {
    let strokes = |name: &str, half: f64, lean: f64| {
        let side = |s: f64| {
            let points = (0..=10).map(|k| DVec3::new(s * half + lean * f64::from(k), 0.1 * f64::from(k), 0.0));
            Curve::new(name, points.collect(), false).unwrap()
        };
        wire::Curves(vec![side(1.0), side(-1.0)])
    };
    let run = |kind: &'static str, view: &'static str, stack: wire::Sections, drawn: wire::Curves| Wiring {
        kind,
        links: vec![("sections", constant("stack", stack)), (view, constant("drawn", drawn))],
        settings: vec![],
    };
    for kind in ["align-primitive", "deform-to-silhouette"] {
        let links = vec![("sections", constant("stack", sections(11, true)))];
        let none = Wiring { kind, links, settings: vec![] }.run().unwrap_err();
        assert!(none.0.is_none() && none.1.contains("no strokes are connected"), "{none:?}");
        let crossing =
            wire::Curves(vec![strokes("one", 0.1, 0.03).0[1].clone(), strokes("other", 0.1, -0.005).0[0].clone()]);
        run(kind, "front", sections(11, true), crossing).blames("front", "cross at");
        run(kind, "side", sections(11, true), strokes("flat", 0.5, 0.0))
            .blames("side", "enclose no area in the side view");
    }
    let align =
        |settings| Wiring { settings, ..run("align-primitive", "front", sections(11, true), strokes("", 0.5, 0.0)) };
    align(vec![("scale", Literal::Vector([1.0, 0.0, 1.0]))]).blames("scale", "above 0");
    assert!(align(vec![("taper", Literal::Number(1.0)), ("axis", text("straight"))]).run().is_ok());
    let deform = |stack, drawn| run("deform-to-silhouette", "front", stack, drawn);
    deform(sections(11, false), strokes("", 0.5, 0.0)).blames("sections", "sections are open");
    let far = strokes("far", 0.5, 0.0).0.iter().map(|c| c.map(|p| p + DVec3::X * 9.0).unwrap()).collect();
    deform(sections(11, true), wire::Curves(far)).blames("front", "7.5000 m beside the sections");
    run("deform-to-silhouette", "top", sections(11, true), strokes("two", 0.5, 0.0)).blames("top", "one closed stroke");
    let curves = |drawn: Vec<Curve>| run("deform-to-curves", "curves", sections(11, true), wire::Curves(drawn));
    curves(vec![]).blames("curves", "no curves to follow");
    let far = strokes("far", 0.5, 0.0).0[0].map(|p| p + DVec3::X * 9.0).unwrap();
    curves(vec![far]).blames("curves", "draw it on the surface or close to it");
    let open = run("deform-to-curves", "curves", sections(11, false), strokes("", 0.5, 0.0));
    open.blames("sections", "the sections are open");
    let report = deform(sections(11, true), strokes("", 0.5, 0.0)).run().unwrap();
    assert!(report.figure("largest-move").unwrap().value > 0.49 && report.warnings.is_empty());
}

#[test]
fn clean_strokes() {
    let run = |settings| Wiring {
        kind: "clean-strokes",
        links: vec![("curves", constant("drawn", rails([0, 1, 2, 3])))],
        settings,
    };
    run(vec![("distance", Literal::Number(1e-5))]).blames("distance", "give a distance of at least");
    let report = run(vec![]).run().unwrap();
    assert!(report.figure("largest-spread").unwrap().value < 1e-6, "four rails far apart stay as they are");
}

#[test]
fn simplify() {
    let triangle = Curve::new("t", vec![DVec3::ZERO, DVec3::X, DVec3::ZERO, DVec3::Y], true).unwrap();
    let run = |curve: Curve, tolerance: f64| Wiring {
        kind: "simplify",
        links: vec![("curves", constant("drawn", wire::Curves(vec![curve])))],
        settings: vec![("tolerance", Literal::Number(tolerance))],
    };
    let report = run(ring("ring", 1.0, 0.0), 0.05).run().unwrap();
    let points = report.figure("points").unwrap().value;
    assert!((6.0..=16.0).contains(&points), "{points}");
    assert_eq!(run(triangle, 0.0).run().unwrap().figure("points").unwrap().value, 4.0);
}

/// A net of 5 x 5 vertices, 4 m wide, in the plane y = 0.
fn net() -> wire::Mesh {
    let points = (0..25).map(|i| DVec3::new(f64::from(i % 5), 0.0, f64::from(i / 5))).collect();
    let quads = (0..16_u32).map(|i| 5 * (i / 4) + i % 4).map(|a| [a, a + 5, a + 6, a + 1]);
    wire::Mesh::new(Mesh::new(points, quads).unwrap())
}

fn selection(vertices: &[usize]) -> wire::Selection {
    wire::Selection::new(Selection::by(25, |v| vertices.contains(&v)), net())
}

fn moved(selection: wire::Selection, transform: HandleTransform) -> wire::Handles {
    let held = wire::HeldSelection { selection, holds: Holds::Both };
    wire::Handles(vec![wire::Handle { held, transform }])
}

#[test]
fn selections() {
    let shape = |settings| Wiring { kind: "select-by-shape", links: vec![("mesh", constant("net", net()))], settings };
    let half = |normal| vec![("shape", text("half-space")), ("normal", Literal::Vector(normal))];
    shape(half([0.0; 3])).blames("normal", "direction has length 0");
    shape(vec![("shape", text("capsule"))]).blames("curve", "needs a curve");
    shape(vec![("size", Literal::Vector([1.0, -1.0, 1.0]))]).blames("size", "below 0");
    let far = shape(vec![("centre", Literal::Vector([9.0; 3]))]).run().unwrap();
    assert!(far.warnings[0].contains("whose 25 vertices lie between (0.0000, 0.0000, 0.0000)"), "{:?}", far.warnings);
    assert!(far.warnings[0].contains("move the shape") && far.figure("selected").unwrap().value == 0.0);
    let all = shape(half([1.0, 0.0, 0.0])).run().unwrap();
    assert_eq!((all.figure("selected").unwrap().value, all.warnings.len()), (25.0, 0));
    assert_eq!(all.table("bounds").unwrap().rows.len(), 3);

    let empty = || constant("empty", wire::Mesh::new(Mesh::default()));
    let of = |kind, link, settings| Wiring { kind, links: vec![("mesh", link)], settings };
    of("select-nearest", empty(), vec![]).blames("mesh", "no polygons");
    let closed = [[0_u32, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let closed = Mesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z], closed).unwrap();
    let closed = || constant("closed", wire::Mesh::new(closed.clone()));
    of("select-nearest", closed(), vec![("what", text("boundary-loop"))]).blames("what", "no boundary loop");
    of("select-by-distance", empty(), vec![]).blames("mesh", "no polygons");
    let nowhere = vec![("direction", Literal::Vector([0.0; 3]))];
    of("select-by-normal", closed(), nowhere).blames("direction", "length 0");
    let points = |points: &str| vec![("points", Literal::Text(points.to_owned()))];
    of("select-points", closed(), points("1 2")).blames("points", "\"1 2\" is no point");
    of("select-points", empty(), points("1 2 3")).blames("mesh", "no polygons");
    // Without a point nothing is selected, which is where painting begins.
    let none = of("select-points", closed(), points("")).run().unwrap();
    assert!(none.warnings[0].contains("nothing is selected"), "{:?}", none.warnings);
    let lost = of("select-points", closed(), points("1 0.001 0, 5 5 5")).run().unwrap();
    assert!(lost.warnings[0].contains("point 1 at (5, 5, 5) no longer finds its place"), "{:?}", lost.warnings);
    assert_eq!((lost.figure("lost").unwrap().value, lost.figure("selected").unwrap().value), (1.0, 1.0));
    let part = Wiring {
        kind: "select-by-mesh",
        links: vec![("mesh", constant("net", net())), ("other", empty())],
        settings: vec![],
    };
    part.blames("other", "no polygons to be near to");
    let stroke = Wiring {
        kind: "select-by-stroke",
        links: vec![("mesh", empty()), ("strokes", constant("drawn", rails([0, 1, 2, 3])))],
        settings: vec![],
    };
    stroke.blames("mesh", "no polygons");

    let other = wire::Selection::new(Selection::by(4, |_| true), net());
    let combine = |second: wire::Selection, by: &str| Wiring {
        kind: "combine-selections",
        links: vec![("first", constant("a", selection(&[1, 2]))), ("second", constant("b", second))],
        settings: vec![("by", text(by))],
    };
    combine(other.clone(), "or").blames("second", "25 weights and the other 4");
    let nothing = combine(selection(&[1, 2, 3]), "minus").run().unwrap();
    assert!(nothing.warnings[0].starts_with("nothing is selected of the mesh"), "{:?}", nothing.warnings);
    let change = |given| Wiring {
        kind: "change-selection",
        links: vec![("selection", constant("a", given))],
        settings: vec![("steps", Literal::Integer(2))],
    };
    change(other.clone()).blames("selection", "4 weights and the other 25");
    assert_eq!(change(selection(&[12])).run().unwrap().figure("selected").unwrap().value, 13.0);
    let split = |links| Wiring { kind: "split-by-selection", links, settings: vec![] };
    split(vec![("selection", constant("a", other))]).blames("selection", "25 weights and the other 4");
    split(vec![("selection", constant("a", selection(&[1]))), ("mesh", closed())]).blames("mesh", "4 weights");
}

#[test]
fn handles() {
    let handle =
        |given, settings| Wiring { kind: "handle", links: vec![("selection", constant("chosen", given))], settings };
    handle(selection(&[]), vec![]).blames("selection", "has no vertex");
    let no_axis = vec![("axis", Literal::Vector([0.0; 3])), ("angle", Literal::Number(10.0))];
    handle(selection(&[1]), no_axis).blames("axis", "no direction");
    handle(selection(&[1]), vec![("scale", Literal::Vector([1.0, 0.0, 1.0]))]).blames("scale", "above 0");
    // Turned about the middle of its vertices.
    let turn = vec![("axis", Literal::Vector([0.0, 0.0, 2.0])), ("angle", Literal::Number(180.0))];
    let report = handle(selection(&[0, 1, 2]), turn).run().unwrap();
    assert!((report.figure("largest-move").unwrap().value - 2.0).abs() < 1e-12);

    let bind = |held: wire::Held, region: Option<wire::Selection>| {
        let mut links = vec![("mesh", constant("net", net())), ("handles", constant("held", held))];
        links.extend(region.map(|region| ("region", constant("chosen", region))));
        Wiring { kind: "bind-deformation", links, settings: vec![] }
    };
    let still = |vertices: &[usize]| moved(selection(vertices), HandleTransform::default());
    bind(wire::Held::default(), None).blames("handles", "is held by nothing");
    bind(still(&[]).held(), None).blames("handles", "handle 0 has no vertex");
    let other = wire::Selection::new(Selection::by(4, |_| true), net());
    bind(moved(other.clone(), HandleTransform::default()).held(), None)
        .blames("handles", "selection of handle 0 has 4");
    bind(still(&[0, 1]).held(), Some(other)).blames("region", "the region has 4 weights");
    let report = bind(still(&[0, 1]).held(), Some(selection(&[]))).run().unwrap();
    assert!(report.warnings[0].contains("no vertex is free to move"), "{:?}", report.warnings);
    let dot = Mesh::new(vec![DVec3::ONE; 25], net().0.polygons()).unwrap();
    let flat = Wiring {
        kind: "bind-deformation",
        links: vec![("mesh", constant("dot", wire::Mesh::new(dot))), ("handles", constant("held", still(&[0]).held()))],
        settings: vec![],
    };
    flat.blames("mesh", "the mesh has no area");

    let bound = || {
        let hash = maquette_graph::Value::new(net()).hash();
        let held = still(&[0, 1, 5]).held();
        let bound = wire::Bound::new(&net(), hash, None, held, Default::default(), &|_| true).unwrap();
        constant("bound", bound)
    };
    let deform = |handles: wire::Handles| Wiring {
        kind: "deform",
        links: vec![("bound", bound()), ("handles", constant("moved", handles))],
        settings: vec![],
    };
    deform(still(&[0])).blames("handles", "not the handles that the mesh is bound to (1 here, 1 there)");
    let far = moved(selection(&[0, 1, 5]), HandleTransform::translation(DVec3::splat(1e308)));
    deform(far).blames("handles", "move the handles less far");
    let report = deform(moved(selection(&[0, 1, 5]), HandleTransform::translation(DVec3::X))).run().unwrap();
    assert!((report.figure("largest-move").unwrap().value - 1.0).abs() < 1e-9);
}

#[test]
fn whole_meshes() {
    let smooth = |links| Wiring { kind: "mesh-smooth", links, settings: vec![] };
    let fin = Mesh::new(
        (0..5).map(|i| DVec3::new(f64::from(i), f64::from(i * i), 0.0)).collect(),
        [[0_u32, 1, 2], [1, 0, 3], [0, 1, 4]],
    );
    let fin = constant("fin", wire::Mesh::new(fin.unwrap()));
    let free = |links: Vec<_>| Wiring { settings: vec![("hold-borders", Literal::Boolean(false))], ..smooth(links) };
    free(vec![("mesh", fin)]).blames("mesh", "more than two polygons meet");
    let other = wire::Selection::new(Selection::by(4, |_| true), net());
    smooth(vec![("mesh", constant("net", net())), ("selection", constant("other", other))])
        .blames("selection", "4 weights");
    let compare = |first, second| Wiring {
        kind: "compare-meshes",
        links: vec![("first", constant("a", first)), ("second", constant("b", second))],
        settings: vec![],
    };
    let empty = || wire::Mesh::new(Mesh::default());
    compare(empty(), net()).blames("first", "no polygons");
    compare(net(), empty()).blames("second", "no polygons");
    let same = compare(net(), net()).run().unwrap();
    assert_eq!(same.figure("rms-edge-error").unwrap().value, 0.0);
    let measured = Wiring { kind: "measure-mesh", links: vec![("mesh", constant("net", net()))], settings: vec![] };
    let report = measured.run().unwrap();
    let figure = |name: &str| report.figure(name).unwrap().value;
    assert_eq!((figure("edges"), figure("genus"), figure("boundary-loops")), (40.0, 0.0, 1.0));
    assert!((figure("area") - 16.0).abs() < 1e-12 && (figure("mean-edge") - 1.0).abs() < 1e-12);
}
