//! Sections cut from meshes, put in order, and parts welded: what the nodes say, and at which input.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that panics fails")]

use glam::DVec3;
use maquette_geometry::curve::Curve;
use maquette_geometry::mesh::Mesh;
use maquette_graph::harness::{Harness, Trial, TrialError};
use maquette_graph::{Cell, Literal, NodeKind};
use maquette_nodes::wire;

fn kind(name: &str) -> NodeKind {
    (**maquette_nodes::catalogue().unwrap().kind(name).unwrap()).clone()
}

fn blamed(result: Result<Trial, TrialError>, port: &str, said: &str) {
    match result {
        Err(TrialError::Failed(failure)) => {
            assert_eq!(failure.port.as_deref(), Some(port), "{failure}");
            assert!(failure.message.contains(said), "{failure}");
        }
        other => panic!("{:?}", other.map(|trial| trial.values)),
    }
}

fn figure(trial: &Trial, name: &str) -> f64 {
    trial.report.figure(name).unwrap().value
}

fn number(value: f64) -> Literal {
    Literal::Number(value)
}

/// An open tube of walls about +Y, from one height to another.
fn tube(low: f64, high: f64, walls: u32) -> wire::Mesh {
    let row = |y: f64| {
        (0..walls).map(move |k| {
            let angle = std::f64::consts::TAU * f64::from(k) / f64::from(walls);
            DVec3::new(angle.cos(), y, -angle.sin())
        })
    };
    let quads = (0..walls).map(|k| [k, (k + 1) % walls, walls + (k + 1) % walls, walls + k]);
    wire::Mesh::new(Mesh::new(row(low).chain(row(high)).collect(), quads).unwrap())
}

fn bone(points: &[[f64; 3]]) -> wire::Curve {
    wire::Curve(Curve::new("bone", points.iter().map(|p| DVec3::from(*p)).collect(), false).unwrap())
}

#[test]
fn sections_stand_where_they_are_asked_for() {
    let kind = kind("sections-from-mesh");
    let run = || Harness::new(&kind).give("mesh", tube(0.0, 2.0, 24)).give("bone", bone(&[[0.0; 3], [0.0, 2.0, 0.0]]));
    let trial = run().set("at", Literal::Text("0.25, 0.5".to_owned())).run().unwrap();
    let cut = &trial.value::<wire::Curves>("curves").unwrap().0;
    assert_eq!(cut.iter().map(|curve| curve.start().y).collect::<Vec<_>>(), [0.5, 1.0]);
    assert!(cut.iter().all(|curve| curve.points().len() == 64 && curve.start().z > 0.99));
    assert_eq!((figure(&trial, "found"), figure(&trial, "missed")), (2.0, 0.0));
    let rows = &trial.report.table("sections").unwrap().rows;
    assert_eq!(rows[1][..2], [Cell::Number(1.0), Cell::Number(0.5)]);
    // From 2 m below the tube to 2 m above it.
    let long = run().set("from", number(-1.0)).set("to", number(2.0)).set("count", Literal::Integer(6)).run().unwrap();
    assert_eq!((figure(&long, "missed"), long.report.warnings.len()), (4.0, 2));

    blamed(run().set("at", Literal::Text("0.5, 0.4".to_owned())).run(), "at", "give growing numbers");
    blamed(run().set("at", Literal::Text("half".to_owned())).run(), "at", "\"half\" is no number");
    blamed(run().set("from", number(1.5)).run(), "to", "run backwards");
    blamed(run().set("front", Literal::Vector([0.0; 3])).run(), "front", "is no direction");
    blamed(run().give("mesh", wire::Mesh::new(Mesh::default())).run(), "mesh", "no polygons");
    blamed(run().give("bone", bone(&[[9.0, 5.0, 0.0], [9.0, 7.0, 0.0]])).run(), "bone", "mind the units");
}

#[test]
fn bones_come_by_their_joints_names() {
    let kind = kind("import-skeleton");
    let node = |name: &str, y: f64, children: &str| {
        format!(r#"{{"name":"{name}","translation":[0,{y},0],"children":[{children}]}}"#)
    };
    let nodes = [node("hip", 1.0, "1, 3"), node("thigh", -0.1, "2"), node("calf", -0.5, "4"), node("spine", 0.2, "5")];
    let ends = [r#"{"name":"foot","translation":[0,-0.4,0]}"#, r#"{"name":"chest","translation":[0,0.3,0]}"#];
    let document = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{},{}],"skins":[{{"joints":[0,1,2,3,4,5]}}]}}"#,
        nodes.join(","),
        ends.join(",")
    );
    let run = |chains: &str| {
        let chains = Literal::Text(chains.to_owned());
        Harness::new(&kind).file("file", "rig.gltf", document.clone().into_bytes()).set("chains", chains)
    };
    let names = |trial: &Trial| -> Vec<(String, usize)> {
        let bones = trial.value::<wire::Curves>("curves").unwrap();
        bones.0.iter().map(|bone| (bone.name().to_owned(), bone.points().len())).collect()
    };
    let all = run("").run().unwrap();
    assert_eq!(names(&all), [("thigh - foot".to_owned(), 3), ("spine - chest".to_owned(), 2)]);
    assert_eq!(all.report.table("joints").unwrap().rows.len(), 6);
    let named = run("hip, foot; spine").set("scale", number(0.01)).run().unwrap();
    assert_eq!(names(&named), [("hip - foot".to_owned(), 4), ("spine - chest".to_owned(), 2)]);
    let curves = &named.value::<wire::Curves>("curves").unwrap().0;
    assert!(curves[0].end().distance(DVec3::ZERO) < 1e-8 && curves[0].start().distance(DVec3::Y * 0.01) < 1e-8);
    blamed(run("hips").run(), "chains", "there is no joint \"hips\"");
}

#[test]
fn the_order_of_sections_tells_what_it_did() {
    let kind = kind("order-sections");
    let ring = |y: f64| {
        let at = |k: u32| {
            let angle = std::f64::consts::TAU * f64::from(k) / 20.0;
            DVec3::new(angle.sin(), y, angle.cos())
        };
        Curve::new(format!("{y}"), (0..20).map(at).collect(), true).unwrap()
    };
    let mixed = vec![ring(1.0), ring(0.0).reversed(), ring(2.0), ring(1.0), ring(0.5)];
    let run = || Harness::new(&kind).give("curves", wire::Curves(mixed.clone()));
    let trial = run().run().unwrap();
    let names: Vec<&str> = trial.value::<wire::Curves>("curves").unwrap().0.iter().map(Curve::name).collect();
    assert_eq!(names, ["0", "0.5", "1", "2"]);
    assert_eq!((figure(&trial, "dropped"), figure(&trial, "reversed")), (1.0, 1.0));
    assert!(
        trial.report.warnings[0].starts_with("curve 3 (\"1\") repeats curve 0 (\"1\")"),
        "{:?}",
        trial.report.warnings
    );
    let back = run().give("axis", bone(&[[0.0, 2.0, 0.0], [0.0; 3]])).run().unwrap();
    assert_eq!(back.value::<wire::Curves>("curves").unwrap().0[0].name(), "2");
    blamed(run().set("front", Literal::Vector([0.0; 3])).run(), "front", "is no direction");
    blamed(run().set("towards", Literal::Vector([0.0; 3])).run(), "towards", "is no direction");
    let open = Harness::new(&kind).give("curves", wire::Curves(vec![bone(&[[0.0; 3], [1.0; 3]]).0]));
    blamed(open.run(), "curves", "is open, and a section is closed");
}

#[test]
fn parts_and_caps_tell_their_seams() {
    let join = kind("join-parts");
    let run = |other: wire::Mesh| Harness::new(&join).give("a", tube(0.0, 1.0, 24)).give("c", other).run().unwrap();
    let welded = run(tube(1.0, 2.0, 24));
    assert_eq!(["seams", "open-loops", "t-junctions"].map(|name| figure(&welded, name)), [1.0, 2.0, 0.0]);
    assert!(figure(&welded, "largest-gap") < 1e-12 && figure(&welded, "largest-angle") < 1e-6);
    let row = &welded.report.table("welds").unwrap().rows[0];
    assert_eq!(row[..4], [Cell::from("a"), Cell::from("c"), Cell::Number(24.0), Cell::from(true)]);
    let apart = run(tube(1.0005, 2.0, 24));
    assert_eq!(figure(&apart, "open-loops"), 4.0);
    assert!(apart.report.warnings[0].contains("raise the tolerance"), "{:?}", apart.report.warnings);
    assert_eq!(apart.report.notes, ["part 0 is `a`, part 1 is `c`"]);

    let caps = kind("caps");
    let whole = welded.value::<wire::Mesh>("mesh").unwrap().clone();
    let run = || Harness::new(&caps).give("mesh", whole.clone());
    let closed = run().run().unwrap();
    assert_eq!((figure(&closed, "closed"), figure(&closed, "open")), (2.0, 0.0));
    let one = run().set("which", Literal::Choice("nearest".to_owned())).run().unwrap();
    assert_eq!((figure(&one, "closed"), figure(&one, "open")), (1.0, 1.0));
    let again = Harness::new(&caps).give("mesh", closed.value::<wire::Mesh>("mesh").unwrap().clone());
    blamed(again.run(), "mesh", "there is nothing to close");
}

#[test]
fn primitives_lay_their_errors_where_the_remedy_is() {
    let shape = kind("primitive-shape");
    let run = |name: &str| Harness::new(&shape).set("shape", Literal::Choice(name.to_owned()));
    blamed(run("capsule").set("height", number(0.1)).run(), "height", "make it at least 0.2 m high");
    blamed(run("sphere").set("sections", Literal::Integer(2)).run(), "sections", "ask for 3 to 4096");
    let sections = run("cone").run().unwrap();
    assert!(sections.value::<wire::Sections>("sections").unwrap().0.is_pole(15));
    let body = kind("superellipsoid");
    let flat = Harness::new(&body).set("radii", Literal::Vector([1.0, 0.0, 1.0])).run();
    blamed(flat, "radii", "the second radius is 0 m");
    let nowhere = Harness::new(&body)
        .set("axis", Literal::Choice("direction".to_owned()))
        .set("direction", Literal::Vector([0.0; 3]))
        .run();
    blamed(nowhere, "direction", "the direction is zero");
}
