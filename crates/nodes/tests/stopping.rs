//! Every node that can take long asks often enough whether to go on, and stops when told to: counted in calls, since
//! times depend on the machine (`cargo bench --bench silence` measures those).
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test that panics fails")]

use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec3;
use maquette_geometry::curve::Curve;
use maquette_geometry::file_format::curves_json;
use maquette_geometry::mesh::{FaceNames, Mesh, NamedBy, Selection};
use maquette_geometry::sections::Sections;
use maquette_graph::harness::{Harness, TrialError};
use maquette_graph::{Catalogue, Literal, Vector};
use maquette_nodes::wire;

fn ring(name: &str, points: usize, radius: f64, height: f64) -> Curve {
    let at = |k: usize| {
        let angle = std::f64::consts::TAU * k as f64 / points as f64;
        DVec3::new(radius * angle.cos(), height, -radius * angle.sin())
    };
    Curve::new(name, (0..points).map(at).collect(), true).unwrap()
}

fn rails(count: usize, points: usize) -> wire::Curves {
    let rail = |k: usize| {
        let angle = std::f64::consts::TAU * k as f64 / count as f64;
        let at = |i: usize| DVec3::new(angle.cos(), 2.0 * i as f64 / (points - 1) as f64, -angle.sin());
        Curve::new(format!("rail {k}"), (0..points).map(at).collect(), false).unwrap()
    };
    wire::Curves((0..count).map(rail).collect())
}

/// Two arches that cross, of so many points each.
fn arches(points: usize) -> wire::Curves {
    let arch = |turn: bool| {
        let at = |k: usize| {
            let t = 2.0 * k as f64 / (points - 1) as f64 - 1.0;
            if turn { DVec3::new(0.0, 1.0 - t * t, t) } else { DVec3::new(t, 1.0 - t * t, 0.0) }
        };
        Curve::new("", (0..points).map(at).collect(), false).unwrap()
    };
    wire::Curves(vec![arch(false), arch(true)])
}

fn net(side: u32) -> Mesh {
    let edge = side + 1;
    let points = (0..edge * edge).map(|k| DVec3::new(f64::from(k % edge), 0.0, f64::from(k / edge)));
    let quads = (0..side * side).map(|k| {
        let corner = (k / side) * edge + k % side;
        [corner, corner + edge, corner + edge + 1, corner + 1]
    });
    Mesh::new(points.collect(), quads).unwrap()
}

/// An open tube of three walls around (1, 0, 1), 2 m high.
fn pillar() -> Mesh {
    let row = |y: f64| [(0.0, 0.0), (1.0, 3.0), (3.0, 0.0)].map(|(x, z)| DVec3::new(x, y, z));
    let quads = (0..3_u32).map(|k| [k, (k + 1) % 3, 3 + (k + 1) % 3, 3 + k]);
    Mesh::new([row(-1.0), row(1.0)].concat(), quads).unwrap()
}

fn obj(mesh: &Mesh) -> Vec<u8> {
    let vertices = mesh.positions().iter().map(|p| format!("v {} {} {}\n", p.x, p.y, p.z));
    let faces = mesh.polygons().map(|p| format!("f {} {} {} {}\n", p[0] + 1, p[1] + 1, p[2] + 1, p[3] + 1));
    vertices.chain(faces).collect::<String>().into_bytes()
}

/// Runs the node whole, then again, told to stop at the first call, in the middle and at the last: it must not call
/// again after that.
fn stops(catalogue: &Catalogue, kind: &str, least_calls: usize, input: impl for<'a> Fn(Harness<'a>) -> Harness<'a>) {
    let kind = catalogue.kind(kind).unwrap();
    let whole = input(Harness::new(kind)).run().unwrap_or_else(|error| panic!("{kind:?}: {error}"));
    let calls = whole.progress.len();
    assert!(calls >= least_calls, "{kind:?} asks {calls} times, fewer than {least_calls}");
    assert!(whole.progress.iter().all(|done| (0.0..=1.0).contains(done)), "{kind:?}: {:?}", whole.progress);
    for stop_at in [0, calls / 2, calls - 1] {
        let asked = AtomicUsize::new(0);
        let go_on = |_: f64| asked.fetch_add(1, Ordering::Relaxed) < stop_at;
        let stopped = input(Harness::new(kind)).while_progress(go_on).run();
        match stopped {
            Err(TrialError::Cancelled(told)) => {
                assert!(
                    told.len() <= stop_at + 1,
                    "{kind:?} goes on {} calls after the stop",
                    told.len() - stop_at - 1
                );
            }
            other => panic!("{kind:?}, stopped at call {stop_at} of {calls}: {:?}", other.map(|trial| trial.values)),
        }
    }
}

#[test]
fn nodes_on_curves() {
    let catalogue = maquette_nodes::catalogue().unwrap();
    let many = rails(4, 20_000);
    stops(&catalogue, "resample", 4 * 40, |h| h.give("curves", many.clone()).set("count", Literal::Integer(20_000)));
    stops(&catalogue, "smooth", 4, |h| h.give("curves", many.clone()));
    stops(&catalogue, "mirror", 4, |h| h.give("curves", many.clone()));
    stops(&catalogue, "transform", 4, |h| h.give("curves", many.clone()).give("rotate", Vector([1.0, 2.0, 3.0])));
    let mut tube = rails(8, 2_000).0;
    tube.extend([ring("a", 20_000, 1.0, 0.0), ring("b", 20_000, 1.0, 2.0)]);
    stops(&catalogue, "sort", 8 * 3, |h| h.give("curves", wire::Curves(tube.clone())));
    // One question for each block of 16 segments.
    stops(&catalogue, "sort", 20_000 / 16, |h| h.give("curves", arches(20_000)));
    // One question for each place on both curves that is measured.
    let [one, other] = [0, 1].map(|k| wire::Curve(many.0[k].clone()));
    stops(&catalogue, "compare-curves", 100, |h| h.give("first", one.clone()).give("second", other.clone()));
    // Before each of its steps; tracing itself is one.
    let sole = include_bytes!("../../../graphs/data/pictures/sole.png");
    stops(&catalogue, "trace-image", 7, |h| h.file("file", "sole.png", sole.to_vec()));
    let json = curves_json::write(&many.0);
    stops(&catalogue, "import-curves", json.len() >> 17, |h| h.file("file", "a.json", json.clone()));
}

#[test]
fn nodes_on_shapes() {
    let catalogue = maquette_nodes::catalogue().unwrap();
    stops(&catalogue, "detail-generator", 100, |h| {
        h.give("rails", rails(4, 100)).set("sections", Literal::Integer(100)).set("nodes", Literal::Integer(100))
    });
    let row = |k: usize| ring("", 100, 1.0, 0.02 * k as f64).points().to_vec();
    let stack = wire::Sections(Sections::new((0..100).map(row).collect(), true, vec![]).unwrap());
    stops(&catalogue, "deform-by-cross-section", 40, |h| {
        h.give("sections", stack.clone())
            .give("contours", wire::Curves(vec![ring("waist", 100, 0.8, 1.0)]))
            .set("before", Literal::Number(0.5))
            .set("after", Literal::Number(0.5))
    });
    let strokes = |view: usize| {
        let at = |side: f64, k: usize| {
            let (out, y) = (side * 0.8, 1.98 * k as f64 / 99.0);
            if view == 0 { DVec3::new(out, y, 0.0) } else { DVec3::new(0.0, y, out) }
        };
        let sides = [1.0, -1.0].map(|side| Curve::new("", (0..100).map(|k| at(side, k)).collect(), false).unwrap());
        wire::Curves(sides.into())
    };
    for kind in ["align-primitive", "deform-to-silhouette"] {
        stops(&catalogue, kind, 100, |h| {
            h.give("sections", stack.clone()).give("front", strokes(0)).give("side", strokes(1))
        });
    }
    stops(&catalogue, "deform-to-silhouette", 100, |h| {
        h.give("sections", stack.clone()).give("front", strokes(0)).set("spacing", Literal::Choice("by-detail".into()))
    });
    stops(&catalogue, "deform-to-curves", 200, |h| h.give("sections", stack.clone()).give("curves", strokes(0)));
    let rings = wire::Curves((0..100).map(|k| ring("", 100, 1.0, 0.02 * (k * 37 % 100) as f64)).collect());
    stops(&catalogue, "order-sections", 300, |h| h.give("curves", rings.clone()));
    stops(&catalogue, "primitive-shape", 2, |h| h.set("sections", Literal::Integer(100)));
    stops(&catalogue, "superellipsoid", 1, |h| h.set("sections", Literal::Integer(100)));
    stops(&catalogue, "ellipse", 1, |h| h.set("points", Literal::Integer(1000)));
    let points = wire::CrossSections::Points(stack.clone());
    stops(&catalogue, "surface-from-cross-sections", 200, |h| h.give("sections", points.clone()));
    stops(&catalogue, "curves-from-sections", 100, |h| h.give("sections", stack.clone()));
}

#[test]
fn nodes_on_meshes() {
    let catalogue = maquette_nodes::catalogue().unwrap();
    let flat = wire::Mesh::new(net(200));
    stops(&catalogue, "silhouette-of", 6, |h| h.give("mesh", flat.clone()).set("view", Literal::Choice("top".into())));
    let border = wire::Curves(vec![ring("", 300, 90.0, 0.0)]);
    stops(&catalogue, "silhouette-report", 8, |h| h.give("mesh", flat.clone()).give("top", border.clone()));
    let mesh = net(400);
    let text = obj(&mesh);
    stops(&catalogue, "import-mesh", text.len() >> 19, |h| h.file("file", "a.obj", text.clone()));
    let mesh = wire::Mesh::new(mesh);
    stops(&catalogue, "transform-mesh", 4, |h| h.give("mesh", mesh.clone()));
    stops(&catalogue, "mirror-mesh", 8, |h| h.give("mesh", mesh.clone()).set("keep", Literal::Boolean(true)));
    stops(&catalogue, "join-meshes", 4, |h| h.give("a", mesh.clone()).give("b", mesh.clone()));
    stops(&catalogue, "caps", 5, |h| h.give("mesh", mesh.clone()));
    // The boundary loops of a mesh are found once, and kept: each run has one of which nobody has asked for them.
    stops(&catalogue, "join-parts", 8, |h| {
        let fresh = wire::Mesh::new(net(400));
        h.give("a", fresh.clone()).give("b", fresh)
    });
    let bone = Curve::new("bone", vec![DVec3::new(1.0, -0.9, 1.0), DVec3::new(1.0, 0.9, 1.0)], false).unwrap();
    let pillar = wire::Mesh::new(pillar());
    stops(&catalogue, "sections-from-mesh", 100, |h| {
        h.give("mesh", pillar.clone()).give("bone", wire::Curve(bone.clone())).set("count", Literal::Integer(100))
    });
    stops(&catalogue, "measure-mesh", 6, |h| h.give("mesh", mesh.clone()));
    stops(&catalogue, "compare-meshes", 2 * 400 * 400 / 4096, |h| {
        h.give("first", mesh.clone()).give("second", mesh.clone())
    });
    stops(&catalogue, "select-by-mesh", 400 * 400 / 4096, |h| h.give("mesh", mesh.clone()).give("other", flat.clone()));
    let points = Literal::Text("1 0 1, ".repeat(20));
    stops(&catalogue, "select-points", 20, |h| h.give("mesh", mesh.clone()).set("points", points.clone()));
    let lasso = wire::Curves(vec![ring("", 300, 150.0, 9.0)]);
    stops(&catalogue, "select-by-stroke", 400 * 400 / 4096, |h| {
        h.give("mesh", mesh.clone()).give("strokes", lasso.clone()).set("view", Literal::Choice("top".into()))
    });
    let steps = 400 * 400 / 4096;
    stops(&catalogue, "select-by-shape", steps, |h| h.give("mesh", mesh.clone()).set("radius", Literal::Number(9.0)));
    stops(&catalogue, "select-by-normal", 2 * steps, |h| h.give("mesh", mesh.clone()));
    stops(&catalogue, "select-by-distance", 2 * steps, |h| {
        h.give("mesh", mesh.clone()).set("distance", Literal::Number(900.0))
    });
    for (what, least) in [("component", steps), ("boundary-loop", 6)] {
        stops(&catalogue, "select-nearest", least, |h| {
            h.give("mesh", mesh.clone()).set("what", Literal::Choice(what.into()))
        });
    }
    let sides = FaceNames::new((0..mesh.0.polygon_count()).map(|face| if face < 80_000 { "left" } else { "right" }));
    let named = wire::Mesh::new(mesh.0.as_ref().clone().with_names(NamedBy::Group, sides).unwrap());
    stops(&catalogue, "select-by-name", 3, |h| {
        h.give("mesh", named.clone()).set("name", Literal::Text("right".into()))
    });
    stops(&catalogue, "mesh-out", 3 * 400 * 400 / 65_536 + 8, |h| h.give("mesh", mesh.clone()).examine());
}

#[test]
fn nodes_that_deform_by_handles() {
    let catalogue = maquette_nodes::catalogue().unwrap();
    let mesh = wire::Mesh::new(net(40));
    let near = |from: f64, to: f64| {
        let inside = |v: usize| (from..=to).contains(&mesh.0.positions()[v].x);
        wire::Selection::new(Selection::by(mesh.0.positions().len(), inside), mesh.clone())
    };
    stops(&catalogue, "change-selection", 12, |h| {
        h.give("selection", near(0.0, 4.0)).set("steps", Literal::Integer(12))
    });
    stops(&catalogue, "mesh-smooth", 5, |h| h.give("mesh", mesh.clone()).set("wave", Literal::Number(8.0)));
    let handle = Harness::new(catalogue.kind("handle").unwrap());
    let low = handle.give("selection", near(0.0, 4.0)).run().unwrap();
    let low = low.value::<wire::Handles>("handles").unwrap().clone();
    let high = Harness::new(catalogue.kind("handle").unwrap())
        .give("selection", near(36.0, 40.0))
        .give("others", low)
        .give("axis", Vector([0.0, 0.0, 1.0]))
        .set("angle", Literal::Number(60.0))
        .run()
        .unwrap();
    let handles = high.value::<wire::Handles>("handles").unwrap().clone();
    stops(&catalogue, "bind-deformation", 8, |h| h.give("mesh", mesh.clone()).give("handles", handles.held()));
    let bound = Harness::new(catalogue.kind("bind-deformation").unwrap())
        .give("mesh", mesh.clone())
        .give("handles", handles.held())
        .run()
        .unwrap();
    let bound = bound.value::<wire::Bound>("bound").unwrap().clone();
    stops(&catalogue, "deform", 10, |h| {
        h.give("bound", bound.clone())
            .give("handles", handles.clone())
            .set("quality", Literal::Choice("converged".into()))
            .set("tolerance", Literal::Number(0.0))
            .set("passes", Literal::Integer(10))
    });
}

fn fitted(count: usize) -> wire::EllipticSections {
    let catalogue = maquette_nodes::catalogue().unwrap();
    let stack = (0..count).map(|k| ring(&format!("ring {k}"), 64, 1.0 + 0.1 * (k as f64).sin(), 0.1 * k as f64));
    let fit = Harness::new(catalogue.kind("fit-sections").unwrap()).give("curves", wire::Curves(stack.collect()));
    fit.run().unwrap().value::<wire::EllipticSections>("sections").unwrap().clone()
}

#[test]
fn nodes_on_series() {
    let catalogue = maquette_nodes::catalogue().unwrap();
    let stack: Vec<Curve> = (0..40).map(|k| ring(&format!("ring {k}"), 64, 1.0, 0.1 * f64::from(k))).collect();
    stops(&catalogue, "fit-sections", 3 * 40, |h| h.give("curves", wire::Curves(stack.clone())));
    let choice = |name: &str| Literal::Choice(name.to_owned());
    // The search for joints asks before each section of each try.
    let square = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)].map(|(x, z)| DVec3::new(x, 0.0, z)).to_vec();
    let square = wire::Curves(vec![Curve::new("square", square, true).unwrap()]);
    stops(&catalogue, "fit-sections", 5, |h| {
        h.give("curves", square.clone())
            .set("split", choice("automatic"))
            .set("largest-distance", Literal::Number(0.01))
    });
    // One question for each half million comparisons of sides.
    let fine = wire::Curves(vec![ring("fine", 10_000, 1.0, 0.0)]);
    stops(&catalogue, "fit-sections", 50_000_000 >> 19, |h| {
        h.give("curves", fine.clone()).set("sampling", choice("as-given")).set("angles", choice("arc-length"))
    });
    let series = wire::CrossSections::Series(fitted(40));
    stops(&catalogue, "surface-from-cross-sections", 80, |h| h.give("sections", series.clone()));
    let surface = Harness::new(catalogue.kind("surface-from-cross-sections").unwrap()).give("sections", series.clone());
    let surface = surface.run().unwrap().value::<wire::Surface>("surface").unwrap().clone();
    stops(&catalogue, "tessellate", 40, |h| h.give("surface", surface.clone()).set("rows", Literal::Integer(200)));
    stops(&catalogue, "join-surfaces", 3, |h| h.give("a", surface.clone()));
}
