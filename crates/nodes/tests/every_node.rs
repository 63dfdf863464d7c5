//! What must hold for every node kind, without a line of test code per node.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};
use std::path::Path;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use maquette_geometry::border::Border;
use maquette_geometry::curve::Curve;
use maquette_geometry::deform::laplacian::{HandleTransform, Holds, Reconstruction};
use maquette_geometry::mesh::{Mesh, Selection};
use maquette_geometry::sections::Sections;
use maquette_geometry::surface::analytic::{AnalyticSurface, SurfaceOptions};
use maquette_geometry::trigonometric::{EllipticSection, EllipticSegment, PlaneFrame, Series};
use maquette_graph::{
    Catalogue, Evaluation, Evaluator, Graph, Literal, LiteralKind, NodeId, NodeKind, OutcomeState, Request, Stroke,
    StrokePoint, Value, Wire, WireType,
};
use maquette_nodes::wire;

fn circle(name: &str, radius: f64, height: f64) -> Curve {
    let point = |k: u32| {
        let angle = f64::from(k) * std::f64::consts::TAU / 48.0;
        DVec3::new(radius * angle.cos(), height, -radius * angle.sin())
    };
    Curve::new(name, (0..48).map(point).collect(), true).unwrap()
}

fn rail(name: &str, angle: f64) -> Curve {
    let point = |k: u32| {
        let t = f64::from(k) / 20.0;
        let radius = 1.0 + t * (1.0 - t);
        DVec3::new(radius * angle.cos(), 2.0 * t, -radius * angle.sin())
    };
    Curve::new(name, (0..=20).map(point).collect(), false).unwrap()
}

fn four_rails() -> Vec<Curve> {
    ["left", "back", "right", "front"]
        .iter()
        .zip([0.0, 90.0, 180.0, 270.0])
        .map(|(n, a)| rail(n, f64::to_radians(a)))
        .collect()
}

fn tube() -> Sections {
    let rows = (0..60).map(|k| circle("", 1.0, f64::from(k) / 24.0).points().to_vec()).collect();
    Sections::new(rows, true, vec![0, 12, 24, 36]).unwrap()
}

fn square() -> Mesh {
    let corners = [DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y].to_vec();
    let uvs = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y].to_vec();
    Mesh::new(corners, [[0_u32, 1, 2, 3]]).unwrap().with_uvs(uvs).unwrap()
}

/// An open tube of four walls, 2 m high.
fn wall() -> Mesh {
    let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
    let row = |y: f64| corners.map(|(x, z)| DVec3::new(x, y, -z));
    let quads = (0..4_u32).map(|k| [k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k]);
    Mesh::new([row(0.0), row(2.0)].concat(), quads).unwrap()
}

/// A tube of four walls in eight rows, whose lower end is selected.
fn tower() -> (wire::Mesh, wire::Selection) {
    let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
    let rows = (0..9).flat_map(|y| corners.map(|(x, z)| DVec3::new(x, 0.5 * f64::from(y), -z)));
    let at = |row: u32, k: u32| 4 * row + k % 4;
    let quads =
        (0..8).flat_map(|row| (0..4).map(move |k| [at(row, k), at(row, k + 1), at(row + 1, k + 1), at(row + 1, k)]));
    let mesh = wire::Mesh::new(Mesh::new(rows.collect(), quads).unwrap());
    let low = Selection::by(36, |v| v < 8);
    (mesh.clone(), wire::Selection::new(low, mesh))
}

/// Handles that hold selections and move so.
fn handles(held: &[(&wire::Selection, HandleTransform)]) -> wire::Handles {
    let handle = |(selection, transform): &(&wire::Selection, HandleTransform)| wire::Handle {
        held: wire::HeldSelection { selection: (*selection).clone(), holds: Holds::Both },
        transform: *transform,
    };
    wire::Handles(held.iter().map(handle).collect())
}

fn register_handles(catalogue: &mut Catalogue) {
    let (mesh, low) = tower();
    let turned = handles(&[(&low, HandleTransform::rotation(DVec3::ZERO, DVec3::Y, 7.0))]);
    let bind = |held: wire::Held, region: Option<wire::Selection>| {
        let hash = Value::new(mesh.clone()).hash();
        wire::Bound::new(&mesh, hash, region, held, Reconstruction::Coordinates, &|_| true).unwrap()
    };
    let square = wire::Mesh::new(square());
    catalogue.register(constant("good-selection", wire::Selection::new(Selection::by(4, |_| true), square))).unwrap();
    catalogue.register(constant("for-bind-deformation-mesh", mesh.clone())).unwrap();
    catalogue.register(constant("for-resample-border-mesh", mesh.clone())).unwrap();
    catalogue.register(constant("good-held", turned.held())).unwrap();
    catalogue.register(constant("good-handles", turned.clone())).unwrap();
    catalogue.register(constant("good-bound", bind(turned.held(), None))).unwrap();
    let of =
        |weights: Vec<f64>, mesh: &wire::Mesh| wire::Selection::new(Selection::new(weights).unwrap(), mesh.clone());
    let nasty_selections = [
        of(vec![], &wire::Mesh::new(Mesh::default())),
        // Weights of another mesh than the one they are said to be of.
        of(vec![1.0; 3], &mesh),
        of(vec![0.0; 36], &mesh),
        of(vec![1.0; 5000], &wire::Mesh::new(Mesh::default())),
    ];
    let huge = HandleTransform::translation(DVec3::splat(1e308));
    let flat = HandleTransform::scale(DVec3::ZERO, 0.0);
    for (index, selection) in nasty_selections.iter().enumerate() {
        catalogue.register(constant(&format!("nasty-selection-{index}"), selection.clone())).unwrap();
        let alone = handles(&[(selection, HandleTransform::default())]);
        catalogue.register(constant(&format!("nasty-held-{index}"), alone.held())).unwrap();
        catalogue.register(constant(&format!("nasty-handles-{index}"), alone)).unwrap();
    }
    let nasty_handles = [wire::Handles::default(), handles(&[(&low, huge)]), handles(&[(&low, flat), (&low, huge)])];
    for (index, nasty) in nasty_handles.into_iter().enumerate() {
        catalogue.register(constant(&format!("nasty-held-of-{index}"), nasty.held())).unwrap();
        catalogue.register(constant(&format!("nasty-handles-of-{index}"), nasty)).unwrap();
    }
    let none = low.with_weights(Selection::by(36, |_| false));
    catalogue.register(constant("nasty-bound-0", bind(wire::Held::default(), Some(none)))).unwrap();
}

/// A kind that gives a fixed value, for linking to inputs that take no literal.
fn constant<T: Wire + Clone>(name: &str, value: T) -> NodeKind {
    let mut node = NodeKind::declare(name, 1, "test", "A fixed value.");
    let out = node.output::<T>("out", "The value.");
    node.evaluate(move |ports| {
        ports.write(out, value.clone());
        Ok(())
    });
    node
}

fn test_catalogue() -> Catalogue {
    let mut catalogue = maquette_nodes::catalogue().unwrap();
    let tiny = Curve::new("tiny", vec![DVec3::ZERO, DVec3::splat(1e-300)], false).unwrap();
    let huge = Curve::new("huge", vec![DVec3::ZERO, DVec3::splat(1e300), DVec3::X], true).unwrap();
    let flat = Sections::new(vec![vec![DVec3::ZERO; 8]; 3], true, vec![]).unwrap();
    let nasty_curves: Vec<Vec<Curve>> = vec![
        vec![],
        vec![tiny.clone()],
        vec![huge.clone()],
        vec![tiny.clone(), huge.clone(), tiny.clone(), huge.clone()],
        vec![rail("same", 0.0); 4],
        vec![circle("same", 1.0, 0.0); 3],
        [four_rails(), vec![circle("a", 1.0, 0.0), circle("b", 1e-12, 2.0)]].concat(),
    ];
    for (index, curves) in nasty_curves.into_iter().enumerate() {
        catalogue.register(constant(&format!("nasty-curves-{index}"), wire::Curves(curves))).unwrap();
    }
    for (index, curve) in [tiny, huge, rail("open", 1.0), circle("far", 1.0, 1e9)].into_iter().enumerate() {
        catalogue.register(constant(&format!("nasty-curve-{index}"), wire::Curve(curve))).unwrap();
    }
    let open = Sections::new(vec![vec![DVec3::ZERO, DVec3::X]; 2], false, vec![]).unwrap();
    let huge = Sections::new(vec![vec![DVec3::splat(1e200), DVec3::X, DVec3::Y]; 2], true, vec![]).unwrap();
    for (index, sections) in [flat, open, huge].into_iter().enumerate() {
        catalogue.register(constant(&format!("nasty-sections-{index}"), wire::Sections(sections))).unwrap();
    }
    let series = |coefficients: Vec<DVec3>, closed: bool| {
        let to = if closed { TAU } else { PI };
        let segment = EllipticSegment { from: 0.0, to, local: false, series: Series::new(coefficients).unwrap() };
        let section = EllipticSection::new(PlaneFrame::new(DVec3::ZERO, DVec3::Y), closed, vec![segment]).unwrap();
        wire::NamedSection { name: "made".to_owned(), section, fit: None }
    };
    let ellipse = |height: f64, size: f64| series(vec![DVec3::Y * height, DVec3::X * size, DVec3::NEG_Z * size], true);
    let fit = wire::SectionFit {
        mean: f64::NAN,
        maximum: f64::INFINITY,
        diagonal: 0.0,
        met: false,
        worst: DVec3::NAN,
        worst_angle: -1e300,
        worst_distance: f64::INFINITY,
    };
    let nasty_series: Vec<Vec<wire::NamedSection>> = vec![
        vec![],
        vec![ellipse(0.0, 1.0)],
        vec![ellipse(0.0, 0.0), ellipse(1.0, 0.0)],
        vec![ellipse(0.0, 1.0); 3],
        vec![ellipse(0.0, 1e200), ellipse(1.0, 1e-200)],
        vec![series(vec![DVec3::ZERO, DVec3::X, DVec3::Y], false), ellipse(1.0, 1.0)],
        vec![series(vec![DVec3::ZERO], true), ellipse(1.0, 1.0), ellipse(0.5, 1.0)],
        vec![series(vec![DVec3::X; 401], false), series(vec![DVec3::Y; 3], false)],
        vec![wire::NamedSection { fit: Some(fit), ..ellipse(0.0, 1.0) }, ellipse(2.0, 1e-12)],
    ];
    for (index, sections) in nasty_series.into_iter().enumerate() {
        let sections = wire::EllipticSections::new(sections);
        let name = format!("nasty-elliptic-sections-{index}");
        catalogue.register(constant(&name, sections.clone())).unwrap();
        let name = format!("nasty-cross-sections-{index}");
        catalogue.register(constant(&name, wire::CrossSections::Series(sections))).unwrap();
    }
    let tube_of = |sections: Vec<wire::NamedSection>| {
        let sections = wire::EllipticSections::new(sections).sections();
        AnalyticSurface::through(&sections, &SurfaceOptions::default()).unwrap()
    };
    let tall = tube_of(vec![ellipse(0.0, 1.0), ellipse(1.0, 1.2), ellipse(2.0, 1.0)]);
    let spindle = tube_of(vec![ellipse(0.0, 0.0), ellipse(1.0, 1e9), ellipse(2.0, 0.0)]);
    let sheet = tube_of([0.0, 1.0].map(|z| series(vec![DVec3::Z * z, DVec3::X, DVec3::Y], false)).to_vec());
    let nasty_surfaces = [
        wire::Surface::Series(vec![]),
        wire::Surface::Points(Arc::new(tube())),
        wire::Surface::Series(vec![spindle.clone()]),
        wire::Surface::Series(vec![spindle, tall.clone(), sheet.clone()]),
        wire::Surface::Series(vec![sheet]),
    ];
    for (index, surface) in nasty_surfaces.into_iter().enumerate() {
        catalogue.register(constant(&format!("nasty-surface-{index}"), surface)).unwrap();
    }
    let met = wire::SectionFit {
        mean: 0.001,
        maximum: 0.002,
        diagonal: 2.8,
        met: true,
        worst: DVec3::X,
        worst_angle: 0.0,
        worst_distance: 0.005,
    };
    let fitted = |height: f64, size: f64| wire::NamedSection { fit: Some(met.clone()), ..ellipse(height, size) };
    let good = wire::EllipticSections::new(vec![fitted(0.0, 1.0), fitted(1.0, 1.2), fitted(2.0, 1.0)]);
    catalogue.register(constant("good-cross-sections", wire::CrossSections::Series(good.clone()))).unwrap();
    catalogue.register(constant("good-elliptic-sections", good)).unwrap();
    catalogue.register(constant("good-surface", wire::Surface::Series(vec![tall]))).unwrap();
    let border = |curve: Curve, direction: DVec3| {
        let directions = vec![direction; curve.points().len()];
        wire::Borders(vec![Border::new(curve, directions).unwrap()])
    };
    let nasty_borders = [
        wire::Borders::default(),
        border(rail("open", 0.0), DVec3::X),
        border(circle("far", 1e200, 1e200), DVec3::Y),
        border(circle("flat", 1e-200, 0.0), DVec3::Y),
        wire::Borders([border(circle("a", 1.0, 0.0), DVec3::Y).0, border(circle("b", 2.0, 0.0), DVec3::Y).0].concat()),
    ];
    for (index, borders) in nasty_borders.into_iter().enumerate() {
        catalogue.register(constant(&format!("nasty-borders-{index}"), borders)).unwrap();
    }
    let corners = Curve::new("corners", vec![DVec3::X, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Z], true).unwrap();
    catalogue.register(constant("for-split-border-corners", wire::Curves(vec![corners]))).unwrap();
    catalogue.register(constant("good-borders", border(circle("ring", 1.0, 0.0), DVec3::Y))).unwrap();
    catalogue.register(constant("good-shape", wire::Shape::Mesh(wire::Mesh::new(square())))).unwrap();
    catalogue.register(constant("nasty-shape-0", wire::Shape::Mesh(wire::Mesh::new(Mesh::default())))).unwrap();
    catalogue.register(constant("nasty-mesh-0", wire::Mesh::new(Mesh::default()))).unwrap();
    let rings = (0..5).map(|k| circle("", 1.0, f64::from(k))).collect();
    catalogue.register(constant("for-order-sections-curves", wire::Curves(rings))).unwrap();
    catalogue.register(constant("for-sections-from-mesh-mesh", wire::Mesh::new(wall()))).unwrap();
    let bone = Curve::new("bone", vec![DVec3::Y * 0.1, DVec3::Y * 1.9], false).unwrap();
    catalogue.register(constant("for-sections-from-mesh-bone", wire::Curve(bone))).unwrap();
    catalogue.register(constant("good-curves", wire::Curves(four_rails()))).unwrap();
    let upright = circle("around", 0.5, 0.0).map(|p| DVec3::new(p.x, -p.z, 0.0)).unwrap();
    let over = Curve::new("over", vec![DVec3::splat(0.25), DVec3::splat(0.75)], false).unwrap();
    catalogue.register(constant("for-beam-rest", wire::Curve(over.clone()))).unwrap();
    catalogue.register(constant("for-draw-on-surface-strokes", wire::Curves(vec![over]))).unwrap();
    catalogue.register(constant("for-cut-with-curve-stroke", wire::Curve(upright))).unwrap();
    let sides = [0.9, -0.9].map(|x| Curve::new("", vec![DVec3::X * x, DVec3::new(x, 2.0, 0.0)], false).unwrap());
    for kind in ["align-primitive", "deform-to-silhouette", "silhouette-report"] {
        catalogue.register(constant(&format!("for-{kind}-front"), wire::Curves(sides.to_vec()))).unwrap();
    }
    let ring = wire::Curves(vec![circle("ring", 1.2, 1.25)]);
    catalogue.register(constant("for-deform-by-cross-section-contours", ring)).unwrap();
    catalogue.register(constant("good-curve", wire::Curve(circle("ring", 1.2, 1.25)))).unwrap();
    catalogue.register(constant("good-sections", wire::Sections(tube()))).unwrap();
    catalogue.register(constant("good-mesh", wire::Mesh::new(square()))).unwrap();
    register_handles(&mut catalogue);
    catalogue
}

/// Two joints.
const SKELETON: &[u8] = br#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"skins":[{"joints":[0,1]}],
"nodes":[{"name":"hip","children":[1]},{"name":"knee","translation":[0,-1,0]}]}"#;

/// The constants that give this type, good or nasty.
fn constants(catalogue: &Catalogue, wire: WireType, prefix: &str) -> Vec<String> {
    let start = format!("{prefix}-{wire}");
    let name = |kind: &NodeKind| kind.name().to_owned();
    catalogue
        .kinds()
        .filter(|kind| kind.name().starts_with(&start) && kind.outputs()[0].wire == wire)
        .map(|kind| name(kind))
        .collect()
}

fn shipped() -> Vec<String> {
    // Those with a body are the engine's.
    let catalogue = maquette_nodes::catalogue().unwrap();
    catalogue.kinds().filter(|kind| !kind.has_body()).map(|kind| kind.name().to_owned()).collect()
}

/// Whether an input that may stay unconnected is linked all the same: the node makes nothing of nothing.
fn wanted(kind: &str, input: &str) -> bool {
    match kind {
        // One surface twice makes no chain.
        "join-surfaces" => input == "a",
        "edit-section" => input == "contour",
        "align-primitive" | "deform-to-silhouette" | "silhouette-report" => input == "front",
        kind => kind.starts_with("join"),
    }
}

/// A graph with one node of the kind under test, everything it needs linked or set.
fn sample(catalogue: &Catalogue, kind: &str, folder: &Path) -> (Graph, NodeId) {
    let mut graph = Graph::new();
    let node = graph.add(catalogue, kind, "tested").unwrap();
    let declared = catalogue.kind(kind).unwrap().clone();
    for input in declared.inputs() {
        match LiteralKind::of_wire(input.wire) {
            None if !input.optional || wanted(kind, &input.name) => {
                let own = format!("for-{kind}-{}", input.name);
                let name = match catalogue.kind(&own) {
                    Some(_) => own,
                    None => constants(catalogue, input.wire, "good").first().unwrap().clone(),
                };
                let source = graph.find(&name).unwrap_or_else(|| graph.add(catalogue, &name, &name).unwrap());
                graph.connect(catalogue, source, "out", node, &input.name).unwrap();
            }
            Some(LiteralKind::Strokes) => graph.set(node, &input.name, strokes()).unwrap(),
            Some(LiteralKind::File) => {
                let reads = |extension: &str| input.extensions.iter().any(|e| e == extension);
                let picture = picture();
                let file: (&str, &[u8]) = match (reads("json"), reads("obj")) {
                    _ if reads("png") => ("picture.png", &picture),
                    (true, _) => ("curves.json", br#"{"contours":[{"name":"a","points":[[0,0,0],[0,1,0]]}]}"#),
                    (false, true) => ("mesh.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
                    (false, false) => ("skeleton.gltf", SKELETON),
                };
                std::fs::write(folder.join(file.0), file.1).unwrap();
                graph.set(node, &input.name, Literal::File(file.0.to_owned())).unwrap();
            }
            _ => {}
        }
    }
    (graph, node)
}

/// A PNG of 16 by 16 grey pixels, black in the middle on white: stored without compression.
fn picture() -> Vec<u8> {
    let sum = |bytes: &[u8]| {
        !bytes.iter().fold(u32::MAX, |sum, byte| {
            (0..8).fold(sum ^ u32::from(*byte), |sum, _| (sum >> 1) ^ (0xedb8_8320 * (sum & 1)))
        })
    };
    let chunk = |name: &[u8], data: &[u8]| {
        let body = [name, data].concat();
        [&u32::try_from(data.len()).unwrap().to_be_bytes()[..], &body, &sum(&body).to_be_bytes()].concat()
    };
    let middle = |k: usize| (4..12).contains(&k);
    let rows: Vec<u8> = (0..16)
        .flat_map(|y| std::iter::once(0).chain((0..16).map(move |x| if middle(x) && middle(y) { 0 } else { 255 })))
        .collect();
    let (a, b) = rows.iter().fold((1_u32, 0_u32), |(a, b), byte| {
        let a = (a + u32::from(*byte)) % 65_521;
        (a, (b + a) % 65_521)
    });
    let length = u16::try_from(rows.len()).unwrap();
    let stored =
        [&[0x78_u8, 1, 1][..], &length.to_le_bytes(), &(!length).to_le_bytes(), &rows, &((b << 16) | a).to_be_bytes()];
    let head = [0, 0, 0, 16, 0, 0, 0, 16, 8, 0, 0, 0, 0];
    [&b"\x89PNG\r\n\x1a\n"[..], &chunk(b"IHDR", &head), &chunk(b"IDAT", &stored.concat()), &chunk(b"IEND", b"")]
        .concat()
}

fn strokes() -> Literal {
    let points = (0..5).map(|i| StrokePoint { x: f64::from(i), y: f64::from(i * i), pressure: None }).collect();
    Literal::Strokes(vec![Stroke { name: "drawn".to_owned(), closed: false, points }])
}

fn evaluate(catalogue: &Catalogue, graph: &Graph, node: NodeId, folder: &Path) -> Evaluation {
    Evaluator::default().evaluate(catalogue, graph, &Request::nodes(&[node]).base(folder))
}

#[test]
fn every_file_is_a_registered_kind_of_its_name() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = BTreeSet::new();
    let holds_kinds = |path: &Path| path.is_dir() && !path.ends_with("wire") && !path.ends_with("frozen");
    for folder in std::fs::read_dir(source).unwrap().map(|entry| entry.unwrap().path()).filter(|path| holds_kinds(path))
    {
        for file in std::fs::read_dir(folder).unwrap() {
            let stem = file.unwrap().path().file_stem().unwrap().to_string_lossy().replace('_', "-");
            if stem != "mod" {
                files.insert(stem);
            }
        }
    }
    assert_eq!(files, shipped().into_iter().collect(), "files in the folders of src/, and kinds registered in lib.rs");
}

#[test]
fn every_kind_and_port_is_described_and_named_in_kebab_case() {
    let kebab = |name: &str| {
        let allowed = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        // The two stiffnesses are called as in every publication on the subject.
        ["k_b", "k_s"].contains(&name) || (!name.is_empty() && name.chars().all(allowed))
    };
    let sentence = |text: &str| text.len() > 5 && text.ends_with(['.', '"']) && !text.starts_with(' ');
    for kind in maquette_nodes::catalogue().unwrap().kinds() {
        assert!(kebab(kind.name()) && sentence(kind.description()), "{}", kind.name());
        let gives = kind.has_body() || !kind.outputs().is_empty();
        assert!(!kind.category().is_empty() && gives, "{}", kind.name());
        for input in kind.inputs() {
            assert!(kebab(&input.name) && sentence(&input.description), "{}.{}", kind.name(), input.name);
            let number = [WireType::of::<f64>(), WireType::of::<i64>()].contains(&input.wire);
            assert_eq!(number, input.range.is_some(), "{}.{}: numbers have a range", kind.name(), input.name);
            for option in &input.options {
                assert!(kebab(&option.name) && !option.description.is_empty(), "{}.{}", kind.name(), input.name);
            }
        }
        for figure in kind.figures() {
            assert!(kebab(&figure.name) && sentence(&figure.description), "{}.{}", kind.name(), figure.name);
        }
        for table in kind.tables() {
            assert!(kebab(&table.name) && sentence(&table.description), "{}.{}", kind.name(), table.name);
            assert!(table.columns.iter().all(|column| kebab(&column.name)), "{}.{}", kind.name(), table.name);
        }
        for output in kind.outputs() {
            assert!(kebab(&output.name) && sentence(&output.description), "{}.{}", kind.name(), output.name);
        }
    }
}

#[test]
fn every_kind_evaluates_with_its_defaults_and_gives_the_same_hashes_twice() {
    let catalogue = test_catalogue();
    for kind in shipped() {
        let folder = tempfile::tempdir().unwrap();
        let (graph, node) = sample(&catalogue, &kind, folder.path());
        let hashes = || {
            let evaluation = evaluate(&catalogue, &graph, node, folder.path());
            let failures: Vec<_> = evaluation.failures().map(|(o, f)| format!("{}: {f}", o.name)).collect();
            assert!(failures.is_empty(), "{kind}: {failures:?}");
            evaluation.values(node).unwrap().iter().map(|value| value.hash()).collect::<Vec<_>>()
        };
        assert_eq!(hashes(), hashes(), "{kind}");
    }
}

#[test]
fn no_kind_breaks_down_on_malformed_input() {
    let catalogue = test_catalogue();
    for kind in shipped() {
        let folder = tempfile::tempdir().unwrap();
        let declared = catalogue.kind(&kind).unwrap().clone();
        for input in declared.inputs() {
            for (what, spoil) in spoilers(&catalogue, input) {
                let (mut graph, node) = sample(&catalogue, &kind, folder.path());
                spoil(&catalogue, &mut graph, node, folder.path());
                let evaluation = evaluate(&catalogue, &graph, node, folder.path());
                let outcome = evaluation.outcome(node).unwrap();
                if let OutcomeState::Failed(failure) = &outcome.state {
                    let place = format!("{kind}.{} with {what}", input.name);
                    assert!(!failure.message.contains("broke down"), "{place}: {failure}");
                    assert!(failure.message.len() > 10, "{place}: {failure}");
                }
            }
        }
    }
}

type Spoil = Box<dyn Fn(&Catalogue, &mut Graph, NodeId, &Path)>;

/// Ways to put something malformed at an input, each with a name.
fn spoilers(catalogue: &Catalogue, input: &maquette_graph::InputSpec) -> Vec<(String, Spoil)> {
    let name = input.name.clone();
    let literal = |literal: Literal| -> (String, Spoil) {
        let name = name.clone();
        let what = format!("{literal:?}").chars().take(80).collect();
        // What the graph itself refuses can't reach the node.
        (what, Box::new(move |_, graph, node, _| drop(graph.set(node, &name, literal.clone()))))
    };
    let range = input.range.map(|r| [r.min, r.max]).unwrap_or_default();
    match LiteralKind::of_wire(input.wire) {
        Some(LiteralKind::Number) => range.map(Literal::Number).map(literal).into(),
        #[expect(clippy::cast_possible_truncation, reason = "the ranges of integers are integers")]
        Some(LiteralKind::Integer) => range.map(|r| literal(Literal::Integer(r as i64))).into(),
        Some(LiteralKind::Boolean) => [true, false].map(|b| literal(Literal::Boolean(b))).into(),
        Some(LiteralKind::Text) => {
            let long = "x,".repeat(10_000);
            ["", " ", "-1", "99999999999999999999", "0", ",,,", "left,left", "\u{0}", "é", &long]
                .map(|text| literal(Literal::Text(text.to_owned())))
                .into()
        }
        Some(LiteralKind::Choice) => input.options.iter().map(|o| literal(Literal::Choice(o.name.clone()))).collect(),
        Some(LiteralKind::Vector) => {
            [[0.0; 3], [1e300; 3], [-1.0, 1e-300, 1.0]].map(|v| literal(Literal::Vector(v))).into()
        }
        Some(LiteralKind::Colour) => [[-1.0; 4], [1e300; 4]].map(|c| literal(Literal::Colour(c))).into(),
        Some(LiteralKind::Strokes) => {
            let point = |x| StrokePoint { x, y: x, pressure: Some(0.5) };
            let stroke = |closed, points| Stroke { name: String::new(), closed, points };
            [
                vec![],
                vec![stroke(false, vec![])],
                vec![stroke(true, vec![point(0.0), point(1.0)])],
                vec![stroke(false, vec![point(1.0); 5])],
                vec![stroke(false, vec![point(1e300), point(-1e300)])],
            ]
            .map(|strokes| literal(Literal::Strokes(strokes)))
            .into()
        }
        Some(LiteralKind::File) => {
            let contents: [(&str, &[u8]); 10] = [
                ("empty.json", b""),
                ("cut.json", b"{\"contours\":[{\"points\":[[0,0"),
                ("none.json", b"{\"contours\":[]}"),
                ("bad.svg", b"<svg"),
                ("bad.glb", b"glTF\x02\0\0\0\xff\xff\xff\xff"),
                ("bad.gltf", b"{\"asset\":{\"version\":\"2.0\"},\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":7}}]}]}"),
                ("bad.obj", b"v 0 0 0\nf 1 2 9\n"),
                ("bad.png", b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0"),
                ("bad.jpg", b"\xff\xd8\xff\xe0\0\x10JFIF"),
                ("wrong.txt", b"hello"),
            ];
            let mut ways = vec![literal(Literal::File(String::new())), literal(Literal::File("gone.json".to_owned()))];
            for (file, bytes) in contents {
                let name = name.clone();
                ways.push((
                    file.to_owned(),
                    Box::new(move |_, graph, node, folder| {
                        std::fs::write(folder.join(file), bytes).unwrap();
                        graph.set(node, &name, Literal::File(file.to_owned())).unwrap();
                    }),
                ));
            }
            ways
        }
        None => constants(catalogue, input.wire, "nasty")
            .into_iter()
            .map(|constant| -> (String, Spoil) {
                let name = name.clone();
                let what = constant.clone();
                (
                    what,
                    Box::new(move |catalogue, graph, node, _| {
                        let source = graph.add(catalogue, &constant, "nasty").unwrap();
                        graph.connect(catalogue, source, "out", node, &name).unwrap();
                    }),
                )
            })
            .collect(),
    }
}
