//! Meshes of every kind.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::super::*;
use super::{apart, bar, bind, both, deform, edge_error, ring, select, sheet};
use crate::mesh::select::Selection;
use crate::mesh::{Mesh, Topology, join};

/// Whether handles at both ends along x, turned and shifted, give a finite mesh, and a rigid motion of both that motion.
fn holds_up(mesh: &Mesh, low: f64, high: f64) -> BindReport {
    let (left, right) = (select(mesh, |p| p.x <= low), select(mesh, |p| p.x >= high));
    let mut report = BindReport::default();
    for reconstruction in [Reconstruction::Coordinates, Reconstruction::Edges] {
        let bound = bind(mesh, &both([&left, &right]), reconstruction).unwrap();
        let turn = HandleTransform::rotation(DVec3::X, DVec3::new(1.0, 1.0, 0.3), 1.0).shifted(0.2 * DVec3::Y);
        let made = deform(&bound, &[HandleTransform::default(), turn], Passes::Converged { tolerance: 1e-4, most: 5 });
        assert!(made.mesh.positions().iter().all(|p| p.is_finite() && p.length() < 20.0));
        let rigid = deform(&bound, &[turn; 2], Passes::Once);
        let wanted = mesh.with_positions(mesh.positions().iter().map(|p| turn.apply(*p)).collect(), None).unwrap();
        let off = apart(&wanted, rigid.mesh.positions());
        assert!(off < 1e-8, "{off:.1e}");
        report = bound.report();
    }
    report
}

#[test]
fn open_closed_and_pierced_meshes_hold_up() {
    // A tube, open at both ends.
    let closed = bar(4, 16, false);
    let tube: Vec<&[u32]> = closed
        .polygons()
        .filter(|q| q.iter().map(|v| closed.positions()[*v as usize].y).any(|y| y > 1e-9 && y < 3.999))
        .collect();
    let tube = Mesh::new(closed.positions().iter().map(|p| DVec3::new(p.y, p.x, p.z)).collect(), tube).unwrap();
    assert_eq!(Topology::new(&tube).boundary_loops().len(), 2);
    holds_up(&tube, 0.3, 3.7);
    let torus = ring(30, 12, true);
    assert_eq!(Topology::new(&torus).euler_characteristic(), 0);
    let report = holds_up(&torus, -1.1, 1.1);
    assert_eq!((report.degenerate, report.widened), (0, 0));
}

#[test]
fn a_flat_sheet_is_degenerate_in_part_and_bends() {
    let sheet = sheet(16, 6);
    let report = holds_up(&sheet, 0.15, 0.85);
    assert!(report.degenerate > 10 && report.degenerate < report.free, "{report:?}");
    let (left, right) = (select(&sheet, |p| p.x < 0.15), select(&sheet, |p| p.x > 0.85));
    let bound = bind(&sheet, &both([&left, &right]), Reconstruction::Coordinates).unwrap();
    let turn = HandleTransform::rotation(DVec3::new(0.5, 0.3, 0.0), DVec3::Z, 1.0);
    let made = deform(&bound, &[HandleTransform::default(), turn], Passes::Once);
    let lifted = made.mesh.positions().iter().map(|p| p.y).fold(0.0, f64::max);
    assert!(lifted > 0.05 && edge_error(&sheet, &made.mesh) < 0.25, "{}", edge_error(&sheet, &made.mesh));
}

#[test]
fn needles_slivers_and_vertices_on_each_other_hold_up() {
    let torus = ring(30, 12, true);
    // Each fifth vertex nearly on its neighbour, some quite.
    let pulled = torus.positions().iter().enumerate().map(|(v, p)| match v {
        v if v % 35 == 7 => torus.positions()[v + 1],
        v if v % 5 == 2 => p.lerp(torus.positions()[v + 1], 0.999),
        _ => *p,
    });
    let pulled = torus.with_positions(pulled.collect(), None).unwrap();
    holds_up(&pulled, -1.1, 1.1);
    // A vertex whose whole ring is one point has nothing that could turn.
    let mut points = torus.positions().to_vec();
    let adjacency = crate::mesh::Adjacency::along_triangles(&torus);
    for vertex in adjacency.within(100, 5) {
        points[vertex as usize] = points[100];
    }
    let dot = torus.with_positions(points, None).unwrap();
    let ends = [select(&dot, |p| p.x < -1.2), select(&dot, |p| p.x > 1.2)];
    let refused = bind(&dot, &both([&ends[0], &ends[1]]), Reconstruction::Coordinates).unwrap_err();
    assert!(matches!(refused, BindError::NoExtent { .. }), "{refused}");
    assert!(refused.to_string().contains("merge vertices"), "{refused}");
}

#[test]
fn vertices_with_two_neighbours_take_in_more_rings() {
    // Corners cut so that two vertices of the sheet have one triangle each.
    let at = |x: u32, z: u32| z * 9 + x;
    let triangles = (0..4_u32).flat_map(|z| {
        (0..8_u32)
            .flat_map(move |x| [[at(x, z), at(x, z + 1), at(x + 1, z)], [at(x + 1, z), at(x, z + 1), at(x + 1, z + 1)]])
    });
    let points =
        (0..5).flat_map(|z| (0..9).map(move |x| DVec3::new(f64::from(x), 0.02 * f64::from(x * x), f64::from(z))));
    let mesh = Mesh::new(points.collect(), triangles).unwrap();
    let handle = select(&mesh, |p| (p.x - 4.0).abs() < 1.1);
    let bound = bind(&mesh, &both([&handle]), Reconstruction::Coordinates).unwrap();
    assert!(bound.report().widened >= 2, "{:?}", bound.report());
    let turn = HandleTransform::rotation(DVec3::ZERO, DVec3::ONE, 1.0);
    let wanted = mesh.with_positions(mesh.positions().iter().map(|p| turn.apply(*p)).collect(), None).unwrap();
    assert!(apart(&wanted, deform(&bound, &[turn], Passes::Once).mesh.positions()) < 1e-9);
}

#[test]
fn edges_of_three_polygons_are_refused_by_name_where_they_are_in_the_way() {
    let bar = bar(4, 16, true);
    let mut points = bar.positions().to_vec();
    points.push(DVec3::new(0.9, 3.0, 0.9));
    let corner = |y: f64| points.iter().position(|p| p.distance(DVec3::new(0.5, y, 0.5)) < 1e-9).unwrap() as u32;
    let (a, b) = (corner(3.0), corner(3.25));
    let fin = [a, b, points.len() as u32 - 1];
    let polygons: Vec<[u32; 3]> = bar.polygons().map(|t| [t[0], t[1], t[2]]).chain([fin]).collect();
    let mesh = Mesh::new(points.clone(), polygons).unwrap();
    let (low, high) = (select(&mesh, |p| p.y < 0.6), select(&mesh, |p| p.y > 3.6));
    let refused = bind(&mesh, &both([&low, &high]), Reconstruction::Coordinates).unwrap_err();
    let BindError::NotManifold { edges, vertices, message } = &refused else { panic!("{refused}") };
    assert_eq!((edges.as_slice(), vertices.as_slice()), (&[[a.min(b), a.max(b)]][..], &[][..]));
    assert!(message.contains(&format!("{} at (0.5000, 3.", a.min(b))), "{message}");
    // Out of the region's reach it is of no concern.
    let held = select(&mesh, |p| p.y > 2.0);
    bind(&mesh, &both([&low, &held]), Reconstruction::Coordinates).unwrap();
}

#[test]
fn what_lies_far_from_the_region_costs_no_more_than_its_copy() {
    let torus = ring(30, 12, true);
    let other = ring(90, 60, true);
    let far = other.with_positions(other.positions().iter().map(|p| *p + 9.0 * DVec3::X).collect(), None).unwrap();
    let joined = join([&torus, &far]).unwrap();
    let region = |mesh: &Mesh| select(mesh, |p| p.x < 0.0);
    let handle = |mesh: &Mesh| select(mesh, |p| p.x < -1.2);
    let bound = |mesh: &Mesh| {
        let (region, handle) = (region(mesh), handle(mesh));
        let options = BindOptions::default();
        Binding::new(Arc::new(mesh.clone()), Some(&region), &both([&handle]), &options, &|_| true).unwrap()
    };
    let (alone, among) = (bound(&torus), bound(&joined));
    assert_eq!(alone.report(), among.report());
    let shift = [HandleTransform::translation(DVec3::new(-0.3, 0.2, 0.0))];
    let (one, two) = (deform(&alone, &shift, Passes::Once).mesh, deform(&among, &shift, Passes::Once).mesh);
    assert_eq!(one.positions(), &two.positions()[..torus.positions().len()]);
    assert_eq!(far.positions(), &two.positions()[torus.positions().len()..]);
}

#[test]
fn polygons_names_uvs_and_order_stay_and_normals_turn() {
    let mesh = bar(4, 16, false).named("post");
    let normals: Vec<DVec3> = (0..mesh.polygon_count())
        .flat_map(|p| vec![crate::mesh::measure::polygon_normal(&mesh, p); mesh.polygon(p).len()])
        .collect();
    let uvs = vec![DVec2::new(0.25, 0.5); mesh.corners().len()];
    let mesh = mesh.with_normals(normals).unwrap().with_uvs(uvs).unwrap();
    let (low, high) = (select(&mesh, |p| p.y < 0.6), select(&mesh, |p| p.y > 3.4));
    let bound = bind(&mesh, &both([&low, &high]), Reconstruction::Coordinates).unwrap();
    let turn = HandleTransform::rotation(DVec3::new(-2.0, 2.0, 0.0), DVec3::Z, 1.0);
    let made = deform(&bound, &[HandleTransform::default(), turn], Passes::Once).mesh;
    assert_eq!((made.name(), made.corners(), made.uvs()), ("post", mesh.corners(), mesh.uvs()));
    assert!(made.polygons().all(|q| q.len() == 4));
    for polygon in 0..made.polygon_count() {
        let flat = crate::mesh::measure::polygon_normal(&made, polygon);
        for normal in &made.normals().unwrap()[made.corner_range(polygon)] {
            assert!(normal.dot(flat) > 0.8, "{polygon}: {normal} against {flat}");
        }
    }
    let untouched = Selection::by(mesh.positions().len(), |_| true);
    let whole = bind(&mesh, &both([&untouched]), Reconstruction::Coordinates).unwrap();
    assert_eq!(deform(&whole, &[HandleTransform::default()], Passes::Once).mesh, mesh);
}
