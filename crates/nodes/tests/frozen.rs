//! Every golden file in `tests/frozen`: the node alone, on the inputs it was frozen with, gives what it gave.
//!
//! `maquette freeze GRAPH NODE -o crates/nodes/tests/frozen/NAME.ron` adds one, `maquette freeze --update FILE...`
//! freezes what the nodes give today.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::disallowed_methods,
    reason = "a test that panics fails, and its files are its own"
)]

use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3};
use maquette_geometry::curve::Curve;
use maquette_geometry::deform::laplacian::{HandleTransform, Holds, Reconstruction};
use maquette_geometry::mesh::{Mesh, Selection};
use maquette_geometry::scene::Material;
use maquette_geometry::sections::Sections;
use maquette_geometry::surface::analytic::{AnalyticSurface, SurfaceOptions};
use maquette_geometry::trigonometric::{EllipticSection, EllipticSegment, PlaneFrame, Series};
use maquette_graph::Value;
use maquette_graph::freeze::{Freeze, Golden};
use maquette_nodes::wire;

fn files() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/frozen");
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

fn read(path: &Path) -> Golden {
    Golden::from_text(&std::fs::read_to_string(path).unwrap()).unwrap_or_else(|e| panic!("{}:{e}", path.display()))
}

#[test]
fn every_frozen_node_gives_what_it_gave() {
    let catalogue = maquette_nodes::catalogue().unwrap();
    let mut wrong = Vec::new();
    for path in files() {
        let golden = read(&path);
        let place = format!("{} ({}, {})", path.display(), golden.kind, golden.from);
        match golden.differences(&catalogue) {
            Ok(differences) => wrong.extend(differences.iter().map(|difference| format!("{place}: {difference}"))),
            Err(error) => wrong.push(format!("{place}: {error}")),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_kind_is_frozen_and_the_files_are_as_they_are_written() {
    let catalogue = maquette_nodes::catalogue().unwrap();
    let mut kinds = BTreeSet::new();
    for path in files() {
        let golden = read(&path);
        assert_eq!(golden.to_text(), std::fs::read_to_string(&path).unwrap(), "{}", path.display());
        kinds.insert(golden.kind);
    }
    let alone = catalogue.kinds().filter(|kind| !kind.has_body());
    let all: BTreeSet<String> = alone.map(|kind| kind.name().to_owned()).collect();
    assert_eq!(kinds, all, "freeze a node of each kind");
    let unfrozen: Vec<_> = catalogue.wires().filter(|wire| !catalogue.is_freezable(*wire)).collect();
    assert!(unfrozen.is_empty(), "{unfrozen:?} can't be frozen");
}

#[test]
fn a_golden_file_with_another_number_fails_and_says_where() {
    let catalogue = maquette_nodes::catalogue().unwrap();
    let path = files().into_iter().find(|path| path.ends_with("transform.ron")).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    let (head, outputs) = text.split_once("outputs:").unwrap();
    let (before, after) = outputs.split_once("(\"points\", Points([").unwrap();
    let (first, rest) = after.split_once("),").unwrap();
    let spoilt = format!("{head}outputs:{before}(\"points\", Points([(9.0, 9.0, 9.0),{rest}");
    let found = Golden::from_text(&spoilt).unwrap().differences(&catalogue).unwrap();
    assert_eq!(found.len(), 1, "{first}: {found:?}");
    assert!(found[0].place.starts_with("curves[0].points[0]") && found[0].what.contains(" m apart"), "{}", found[0]);
}

fn comes_back<T: Freeze>(value: T) {
    let frozen = value.freeze();
    let back = Value::new(T::thaw(&frozen).unwrap());
    assert_eq!(back.hash(), Value::new(value).hash(), "{frozen:?}");
}

#[test]
fn every_wire_type_comes_back_from_what_was_frozen() {
    let points = vec![DVec3::new(0.1, 1e-300, -3.0), DVec3::X, DVec3::new(1.0 / 3.0, 2.0, 5e10)];
    let plain = Curve::new("left \"arm\"", points.clone(), true).unwrap();
    let pressed = Curve::with_pressure("", points.clone(), false, Some(vec![0.0, 0.5, 1.0])).unwrap();
    comes_back(wire::Curve(pressed.clone()));
    comes_back(wire::Curves(vec![plain.clone(), pressed.clone()]));
    comes_back(wire::Curves(vec![]));
    comes_back(wire::CurvesResult { curves: vec![plain], colour: [0.1, 0.2, 0.3, 1.0] });
    comes_back(wire::Sections(Sections::new(vec![points.clone(); 2], true, vec![0, 2]).unwrap()));
    let stack = Sections::new(vec![points.clone(); 2], true, vec![1]).unwrap();
    comes_back(wire::CrossSections::Points(wire::Sections(stack.clone())));
    comes_back(wire::Surface::Points(std::sync::Arc::new(stack)));
    let segment =
        |from: f64, to: f64| EllipticSegment { from, to, local: true, series: Series::new(points.clone()).unwrap() };
    let segments = vec![segment(0.5, 2.0), segment(2.0, 0.5 + TAU)];
    let section = EllipticSection::new(PlaneFrame::new(DVec3::X, DVec3::ONE), true, segments).unwrap();
    let fit = wire::SectionFit {
        mean: 0.1,
        maximum: 0.2,
        diagonal: 3.0,
        met: true,
        worst: DVec3::Y,
        worst_angle: -0.5,
        worst_distance: 1.0 / 3.0,
    };
    let named = wire::NamedSection { name: "ä".to_owned(), section: section.clone(), fit: Some(fit) };
    let series = wire::EllipticSections::new(vec![named.clone(), wire::NamedSection { fit: None, ..named }]);
    comes_back(series.clone());
    comes_back(wire::CrossSections::Series(series));
    let moved = section.transformed(&glam::DAffine3::from_translation(DVec3::Y)).unwrap();
    let surface = AnalyticSurface::through(&[section, moved], &SurfaceOptions::default()).unwrap();
    comes_back(wire::Surface::Series(vec![surface.clone(), surface]));
    comes_back(wire::Surface::Series(vec![]));
    let bare = Mesh::new(points.clone(), [[0_u32, 1, 2]]).unwrap();
    let full = bare.clone().with_normals(vec![DVec3::Y; 3]).unwrap().with_uvs(vec![DVec2::X; 3]).unwrap().named("a");
    for mesh in [bare, full, Mesh::default()] {
        let mesh = wire::Mesh::new(mesh);
        comes_back(mesh.clone());
        let material = Material { metallic: 0.25, double_sided: true, ..Material::default() };
        let (mesh_hash, shared) = (Value::new(mesh.clone()).hash(), mesh.0);
        comes_back(wire::MeshResult { mesh: shared, mesh_hash, material });
    }
}

#[test]
fn selections_handles_and_bound_meshes_come_back() {
    let points = (0..6).map(|i| DVec3::new(f64::from(i % 2), f64::from(i / 2), 0.1 * f64::from(i * i))).collect();
    let mesh = wire::Mesh::new(Mesh::new(points, [[0_u32, 1, 3, 2], [2, 3, 5, 4]]).unwrap());
    let soft = Selection::new(vec![1.0, 1.0, 1.0 / 3.0, 0.0, 0.25, 0.0]).unwrap();
    let selection = wire::Selection::new(soft, mesh.clone());
    comes_back(selection.clone());
    let turned = HandleTransform::rotation(DVec3::X, DVec3::new(1.0, 2.0, 0.5), 7.0).scaled(1.5).shifted(DVec3::Y);
    let handle = |holds: Holds| wire::Handle {
        held: wire::HeldSelection { selection: selection.clone(), holds },
        transform: turned,
    };
    let all = wire::Handles([Holds::Both, Holds::Position, Holds::Gradient].map(handle).to_vec());
    comes_back(all.held());
    comes_back(all);
    comes_back(wire::Handles::default());
    let region = selection.with_weights(selection.weights.inverted());
    let hash = Value::new(mesh.clone()).hash();
    for (region, reconstruction) in [(None, Reconstruction::Coordinates), (Some(region), Reconstruction::Edges)] {
        let held = wire::Handles(vec![handle(Holds::Both)]).held();
        comes_back(wire::Bound::new(&mesh, hash, region, held, reconstruction, &|_| true).unwrap());
    }
}
