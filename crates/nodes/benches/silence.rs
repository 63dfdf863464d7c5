//! How long a node may take to stop: the longest time in which it does not ask whether to go on, on large input. The
//! mark is 50 ms. Where the system tells it (Linux), this is time on the processor, so that other programs don't count.
//! Run with `cargo bench -p maquette-nodes --bench silence`.
#![allow(missing_docs, clippy::expect_used, reason = "a benchmark has no users, and stops where it is wrong")]

use std::fmt::Write as _;
use std::sync::Mutex;
use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use glam::{DVec2, DVec3};
use maquette_geometry::curve::Curve;
use maquette_geometry::file_format::gltf_write;
use maquette_geometry::mesh::Mesh;
use maquette_geometry::scene::{Material, MeshItem, Scene};
use maquette_geometry::sections::Sections;
use maquette_graph::harness::Harness;
use maquette_graph::{Catalogue, Literal, NodeKind, Value, Vector};
use maquette_nodes::wire;

/// As many points as a node gives at most.
const POINTS: usize = 65_536;

/// A turn about +Y that rises, or a closed one.
fn curve(name: &str, points: usize, closed: bool, radius: f64, height: f64) -> Curve {
    let at = |k: usize| {
        let angle = std::f64::consts::TAU * k as f64 / points as f64;
        let r = radius + 0.01 * (40.0 * angle).sin();
        DVec3::new(r * angle.cos(), height + 0.01 * (7.0 * angle).cos(), -r * angle.sin())
    };
    Curve::new(name, (0..points).map(at).collect(), closed).expect("a circle is a curve")
}

fn rail(name: &str, angle: f64, points: usize) -> Curve {
    let at = |k: usize| {
        let t = k as f64 / (points - 1) as f64;
        let r = 1.0 + t * (1.0 - t);
        DVec3::new(r * angle.cos(), 2.0 * t, -r * angle.sin())
    };
    Curve::new(name, (0..points).map(at).collect(), false).expect("a rail is a curve")
}

fn rails(count: usize, points: usize) -> wire::Curves {
    let angle = |k: usize| std::f64::consts::TAU * k as f64 / count as f64;
    wire::Curves((0..count).map(|k| rail(&format!("rail {k}"), angle(k), points)).collect())
}

fn sections(count: usize, nodes: usize) -> wire::Sections {
    let row = |k: usize| curve("", nodes, true, 1.0, 2.0 * k as f64 / count as f64).points().to_vec();
    wire::Sections(Sections::new((0..count).map(row).collect(), true, vec![]).expect("rings are sections"))
}

/// A net of quads with normals and UVs.
fn mesh(side: u32) -> Mesh {
    let (edge, scale) = (side + 1, 1.0 / f64::from(side));
    let at = |k: u32| {
        DVec3::new(f64::from(k % edge) * scale, 0.1 * (f64::from(k) * 0.01).sin(), f64::from(k / edge) * scale)
    };
    let quad = |k: u32| {
        let corner = (k / side) * edge + k % side;
        [corner, corner + edge, corner + edge + 1, corner + 1]
    };
    let corners = 4 * (side * side) as usize;
    Mesh::new((0..edge * edge).map(at).collect(), (0..side * side).map(quad))
        .and_then(|mesh| mesh.with_normals(vec![DVec3::Y; corners]))
        .and_then(|mesh| mesh.with_uvs(vec![DVec2::X; corners]))
        .expect("a net is a mesh")
}

fn obj(mesh: &Mesh) -> Vec<u8> {
    let mut text = String::from("o net\n");
    for p in mesh.positions() {
        let _ = writeln!(text, "v {} {} {}", p.x, p.y, p.z);
    }
    for polygon in mesh.polygons() {
        let _ = writeln!(text, "f {} {} {} {}", polygon[0] + 1, polygon[1] + 1, polygon[2] + 1, polygon[3] + 1);
    }
    text.into_bytes()
}

/// Time that this thread was on a processor.
fn on_processor() -> Option<Duration> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    text.split_whitespace().next()?.parse().ok().map(Duration::from_nanos)
}

fn longest_silence(harness: Harness<'_>) -> Duration {
    let Some(begun) = on_processor() else {
        return harness.run().expect("the node gives a result").longest_silence;
    };
    let told = Mutex::new((begun, Duration::ZERO));
    let ask = || {
        let (now, mut told) = (on_processor().unwrap_or_default(), told.lock().expect("nothing panics here"));
        *told = (now, told.1.max(now.saturating_sub(told.0)));
    };
    let watched = harness.while_progress(|_| {
        ask();
        true
    });
    let made = watched.run().expect("the node gives a result");
    ask();
    // Giving the memory back is not the node's work.
    drop(made);
    // The clock ticks every few milliseconds; nothing takes no time.
    told.into_inner().expect("nothing panics here").1.max(Duration::from_micros(1))
}

fn measure<'a>(c: &mut Criterion, what: &str, harness: impl Fn() -> Harness<'a>) {
    c.bench_function(what, |b| {
        b.iter_custom(|times| (0..times).map(|_| longest_silence(harness())).sum::<Duration>());
    });
}

fn kind<'a>(catalogue: &'a Catalogue, name: &str) -> &'a NodeKind {
    catalogue.kind(name).expect("the kind is registered")
}

fn curves(c: &mut Criterion) {
    let catalogue = maquette_nodes::catalogue().expect("the catalogue is sound");
    let drawn = Value::new(rails(20, POINTS));
    for name in ["join", "mirror", "smooth", "transform", "curves-out", "resample"] {
        let kind = kind(&catalogue, name);
        measure(c, &format!("{name}: 20 curves of 65,536 points"), || {
            let harness = Harness::new(kind).give_value(if name == "join" { "a" } else { "curves" }, drawn.clone());
            match name {
                "resample" => harness.set("count", Literal::Integer(65_536)),
                "transform" => harness.give("rotate", Vector([10.0, 20.0, 30.0])),
                _ => harness,
            }
        });
    }
    let sort = kind(&catalogue, "sort");
    measure(c, "sort: 20 rails of 65,536 points", || Harness::new(sort).give_value("curves", drawn.clone()));
    let mut tube = rails(20, POINTS).0;
    tube.extend([curve("a", POINTS, true, 1.0, 0.0), curve("b", POINTS, true, 1.0, 2.0)]);
    let tube = Value::new(wire::Curves(tube));
    measure(c, "sort: the same between closed curves of 65,536", || {
        Harness::new(sort).give_value("curves", tube.clone())
    });
    let wave = |k: usize, turn: bool| {
        let t = 2.0 * k as f64 / POINTS as f64 - 1.0;
        let p = DVec3::new(t, 1.0 - t * t + 0.001 * (900.0 * t).sin(), 0.0);
        if turn { DVec3::new(0.0, p.y, p.x) } else { p }
    };
    let crossing =
        [false, true].map(|turn| Curve::new("", (0..POINTS).map(|k| wave(k, turn)).collect(), false).expect("a wave"));
    let crossing = Value::new(wire::Curves(crossing.into()));
    measure(c, "sort: two crossing curves of 65,536 points", || {
        Harness::new(sort).give_value("curves", crossing.clone())
    });
    let import = kind(&catalogue, "import-curves");
    let json = maquette_geometry::file_format::curves_json::write(&rails(16, POINTS).0);
    let json: std::sync::Arc<[u8]> = json.into();
    measure(c, "import-curves: a million points of JSON", || Harness::new(import).file("file", "a.json", json.clone()));
}

fn shapes(c: &mut Criterion) {
    let catalogue = maquette_nodes::catalogue().expect("the catalogue is sound");
    let generator = kind(&catalogue, "detail-generator");
    let four = Value::new(rails(4, 1000));
    measure(c, "detail-generator: two views, 500 x 500", || {
        Harness::new(generator)
            .give_value("rails", four.clone())
            .set("sections", Literal::Integer(500))
            .set("nodes", Literal::Integer(500))
    });
    let rings = Value::new(wire::Curves(vec![curve("a", 1000, true, 1.0, 0.0), curve("b", 1000, true, 1.0, 2.0)]));
    measure(c, "detail-generator: between closed, 500 x 500", || {
        Harness::new(generator)
            .give_value("rails", four.clone())
            .give_value("profiles", rings.clone())
            .set("sections", Literal::Integer(500))
            .set("nodes", Literal::Integer(500))
            .set("snap", Literal::Number(1.0))
    });
    let stack = Value::new(sections(512, 512));
    let waist = Value::new(wire::Curves(vec![curve("waist", POINTS, true, 0.8, 1.0)]));
    let deform = kind(&catalogue, "deform-by-cross-section");
    measure(c, "deform-by-cross-section: 512 x 512, a contour of 65,536", || {
        Harness::new(deform)
            .give_value("sections", stack.clone())
            .give_value("contours", waist.clone())
            .set("before", Literal::Number(1.0))
            .set("after", Literal::Number(1.0))
    });
    let curves = kind(&catalogue, "curves-from-sections");
    measure(c, "curves-from-sections: 512 x 512", || Harness::new(curves).give_value("sections", stack.clone()));
    let surface = kind(&catalogue, "surface-from-cross-sections");
    let points = Value::new(wire::CrossSections::Points(sections(512, 512)));
    measure(c, "surface-from-cross-sections: 1024 x 1024 quads", || {
        Harness::new(surface)
            .give_value("sections", points.clone())
            .set("rows", Literal::Integer(2))
            .set("columns", Literal::Integer(2))
    });
}

fn meshes(c: &mut Criterion) {
    let catalogue = maquette_nodes::catalogue().expect("the catalogue is sound");
    let net = mesh(1024);
    let text: std::sync::Arc<[u8]> = obj(&net).into();
    let scene = Scene {
        meshes: vec![MeshItem { name: "net".to_owned(), mesh: mesh(724), material: Material::default() }],
        ..Scene::default()
    };
    let binary: std::sync::Arc<[u8]> = gltf_write::glb(&scene).expect("a net can be written").into();
    let import = kind(&catalogue, "import-mesh");
    measure(c, "import-mesh: a million faces of OBJ", || Harness::new(import).file("file", "a.obj", text.clone()));
    measure(c, "import-mesh: a million triangles of glTF", || {
        Harness::new(import).file("file", "a.glb", binary.clone())
    });
    let value = Value::new(wire::Mesh::new(net));
    for name in ["transform-mesh", "mirror-mesh", "join-meshes", "mesh-out"] {
        let kind = kind(&catalogue, name);
        measure(c, &format!("{name}: a million faces"), || match name {
            "join-meshes" => Harness::new(kind).give_value("a", value.clone()).give_value("b", value.clone()),
            "mesh-out" => Harness::new(kind).give_value("mesh", value.clone()).examine(),
            "mirror-mesh" => Harness::new(kind).give_value("mesh", value.clone()).set("keep", Literal::Boolean(true)),
            _ => Harness::new(kind).give_value("mesh", value.clone()),
        });
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10).warm_up_time(Duration::from_millis(1)).measurement_time(Duration::from_millis(1));
    targets = curves, shapes, meshes
}
criterion_main!(benches);
