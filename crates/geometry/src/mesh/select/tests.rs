//! What is selected, on a small net and two boxes.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DAffine3, DQuat, DVec3};

use super::*;
use crate::curve::Curve;
use crate::mesh::caps::{CapOptions, cap};
use crate::mesh::weld::{WeldOptions, weld};
use crate::mesh::{Adjacency, FaceNames, Mesh, NamedBy, flipped, join, transform};

/// A net of 5 x 5 vertices in the plane y = 0, facing up, x and z from 0 to 4; vertex `5 z + x`.
fn net() -> Mesh {
    let points = (0..25).map(|i| DVec3::new(f64::from(i % 5), 0.0, f64::from(i / 5))).collect();
    let quads = (0..16_u32).map(|i| 5 * (i / 4) + i % 4).map(|a| [a, a + 5, a + 6, a + 1]);
    Mesh::new(points, quads).unwrap()
}

fn chosen(selection: Result<Selection, SelectError>) -> Vec<u32> {
    selection.unwrap().vertices()
}

fn by_shape(mesh: &Mesh, shape: &Shape<'_>, falloff: f64) -> Result<Selection, SelectError> {
    super::by_shape(mesh, shape, falloff, &|_| true).map(Option::unwrap)
}

fn component_nearest(mesh: &Mesh, point: DVec3) -> Result<Selection, SelectError> {
    super::component_nearest(mesh, point, &|_| true).map(Option::unwrap)
}

fn boundary_loop_nearest(mesh: &Mesh, point: DVec3) -> Result<Selection, SelectError> {
    super::boundary_loop_nearest(mesh, point, &|_| true).map(Option::unwrap)
}

fn geodesic(mesh: &Mesh, points: &[DVec3], distance: f64, falloff: f64) -> Result<Selection, SelectError> {
    super::geodesic(mesh, points, distance, falloff, &|_| true).map(Option::unwrap)
}

fn by_normal(mesh: &Mesh, direction: DVec3, angle: f64, falloff: f64) -> Result<Selection, SelectError> {
    super::by_normal(mesh, direction, angle, falloff, &|_| true).map(Option::unwrap)
}

#[test]
fn shapes_take_what_is_inside() {
    let net = net();
    let centre = DVec3::new(2.0, 0.0, 2.0);
    assert_eq!(chosen(by_shape(&net, &Shape::Sphere { centre, radius: 1.0 }, 0.0)), [7, 11, 12, 13, 17]);
    let half = DVec3::new(1.0, 0.1, 1.0);
    let cuboid = |rotation| Shape::Cuboid { centre, half, rotation };
    assert_eq!(chosen(by_shape(&net, &cuboid(DQuat::IDENTITY), 0.0)), [6, 7, 8, 11, 12, 13, 16, 17, 18]);
    let turned = DQuat::from_rotation_y(PI / 4.0);
    assert_eq!(chosen(by_shape(&net, &cuboid(turned), 0.0)), [7, 11, 12, 13, 17]);
    let plane = Shape::HalfSpace { point: DVec3::new(3.0, 5.0, 0.0), normal: 7.0 * DVec3::X };
    assert_eq!(chosen(by_shape(&net, &plane, 0.0)), [3, 4, 8, 9, 13, 14, 18, 19, 23, 24]);
    let line = Curve::new("line", vec![DVec3::new(0.0, 0.5, 1.0), DVec3::new(2.0, 0.5, 1.0)], false).unwrap();
    assert_eq!(chosen(by_shape(&net, &Shape::Capsule { curve: &line, radius: 0.6 }, 0.0)), [5, 6, 7]);
}

#[test]
fn weights_fall_off_outside() {
    let plane = Shape::HalfSpace { point: DVec3::X, normal: DVec3::NEG_X };
    let found = by_shape(&net(), &plane, 4.0).unwrap();
    assert_eq!(found.weights()[..5], [1.0, 1.0, 0.75, 0.5, 0.25]);
    // Inside a box the distance is negative, at its corner that to the corner.
    let cuboid = Shape::Cuboid { centre: DVec3::ZERO, half: DVec3::splat(1.0), rotation: DQuat::IDENTITY };
    let found = by_shape(&net(), &cuboid, 2.0).unwrap();
    assert_eq!(found.weights()[0], 1.0);
    assert!((found.weights()[12] - (1.0 - 0.5 * 2.0_f64.sqrt())).abs() < 1e-12);
}

#[test]
fn shapes_without_sense_are_refused() {
    let net = net();
    let sphere = |radius| Shape::Sphere { centre: DVec3::ZERO, radius };
    assert_eq!(by_shape(&net, &sphere(-1.0), 0.0), Err(SelectError::Negative { what: "radius", value: -1.0 }));
    assert_eq!(by_shape(&net, &sphere(f64::NAN), 0.0), Err(SelectError::NotFinite { what: "radius" }));
    assert_eq!(by_shape(&net, &sphere(1.0), -0.5), Err(SelectError::Negative { what: "falloff", value: -0.5 }));
    let plane = Shape::HalfSpace { point: DVec3::ZERO, normal: DVec3::ZERO };
    assert_eq!(by_shape(&net, &plane, 0.0), Err(SelectError::NoDirection));
}

#[test]
fn parts_and_borders_are_those_nearest_to_a_point() {
    // Two nets, one above the other, and a loose vertex nearer than both.
    let mut points = net().positions().to_vec();
    points.extend(net().positions().iter().map(|p| *p + 3.0 * DVec3::Y));
    points.push(DVec3::new(2.0, 2.0, 2.0));
    let polygons: Vec<Vec<u32>> =
        net().polygons().flat_map(|q| [q.to_vec(), q.iter().map(|v| v + 25).collect()]).collect();
    let two = Mesh::new(points, polygons).unwrap();
    let near = DVec3::new(2.0, 2.0, 2.0);
    assert_eq!(chosen(component_nearest(&two, near)), (25..50).collect::<Vec<_>>());
    let border = chosen(boundary_loop_nearest(&two, DVec3::ZERO));
    assert_eq!(border, [0, 1, 2, 3, 4, 5, 9, 10, 14, 15, 19, 20, 21, 22, 23, 24]);
    assert_eq!(component_nearest(&Mesh::default(), near), Err(SelectError::NoPolygons));
    assert_eq!(component_nearest(&two, DVec3::NAN), Err(SelectError::NotFinite { what: "point" }));
    let closed =
        Mesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]);
    assert_eq!(boundary_loop_nearest(&closed.unwrap(), near), Err(SelectError::NoBoundary));
}

#[test]
fn distance_is_measured_along_the_surface() {
    // The net folded over in the middle: near in space, far along it.
    let fold = |p: &DVec3| if p.x > 2.0 { DVec3::new(4.0 - p.x, 0.1, p.z) } else { *p };
    let folded = net().with_positions(net().positions().iter().map(fold).collect(), None).unwrap();
    let found = chosen(geodesic(&folded, &[DVec3::new(0.0, -0.3, 0.0)], 1.5, 0.0));
    assert_eq!(found, [0, 1, 5, 6]);
    assert_eq!(geodesic(&folded, &[], 1.0, 0.0), Err(SelectError::NoPoint));
    assert_eq!(geodesic(&Mesh::default(), &[DVec3::ZERO], 1.0, 0.0), Err(SelectError::NoPolygons));
}

#[test]
fn normals_are_compared_by_angle() {
    let bent = |p: &DVec3| if p.x > 2.0 { DVec3::new(2.0, 2.0 - p.x, p.z) } else { *p };
    let bent = net().with_positions(net().positions().iter().map(bent).collect(), None).unwrap();
    let up = by_normal(&bent, 3.0 * DVec3::Y, 0.1, 0.0).unwrap();
    assert_eq!(up.vertices()[..5], [0, 1, 5, 6, 10]);
    // The edge between has a normal halfway.
    let soft = by_normal(&bent, DVec3::Y, 0.0, FRAC_PI_2).unwrap();
    assert!((soft.weights()[2] - 0.5).abs() < 1e-12 && soft.weights()[4] < 1e-12);
    assert_eq!(by_normal(&bent, DVec3::ZERO, 0.0, 0.0), Err(SelectError::NoDirection));
}

#[test]
fn selections_combine() {
    let a = Selection::new(vec![0.0, 0.2, 0.8, 1.0]).unwrap();
    let b = Selection::new(vec![1.0, 0.5, 0.5, 0.25]).unwrap();
    assert_eq!(a.and(&b).unwrap().weights(), [0.0, 0.2, 0.5, 0.25]);
    assert_eq!(a.or(&b).unwrap().weights(), [1.0, 0.5, 0.8, 1.0]);
    assert_eq!(a.minus(&b).unwrap().weights(), [0.0, 0.2, 0.5, 0.75]);
    assert_eq!(b.inverted().weights(), [0.0, 0.5, 0.5, 0.75]);
    assert_eq!((a.vertices(), b.vertices()), (vec![2, 3], vec![0, 1, 2]));
    assert!(!a.contains(4));
    let other = Selection::new(vec![0.0]).unwrap();
    assert_eq!(a.and(&other), Err(SelectionError::Sizes { first: 4, second: 1 }));
    assert_eq!(Selection::new(vec![0.5, 1.5]), Err(SelectionError::Weight { vertex: 1, weight: 1.5 }));
    assert!(Selection::new(vec![f64::NAN]).is_err());
    assert_eq!(Selection::weighted(3, |v| [f64::NAN, 2.0, -1.0][v]).weights(), [0.0, 1.0, 0.0]);
}

#[test]
fn selections_grow_shrink_and_smooth_by_edges() {
    let adjacency = Adjacency::along_sides(&net());
    let middle = Selection::by(25, |v| v == 12);
    let grown = middle.grown(&adjacency, 2).unwrap();
    assert_eq!(grown.vertices(), [2, 6, 7, 8, 10, 11, 12, 13, 14, 16, 17, 18, 22]);
    assert_eq!(grown.shrunk(&adjacency, 1).unwrap().vertices(), [7, 11, 12, 13, 17]);
    let smooth = middle.smoothed(&adjacency, 1).unwrap();
    assert_eq!((smooth.weights()[12], smooth.weights()[11], smooth.weights()[10]), (0.5, 0.125, 0.0));
    assert_eq!(middle.grown(&adjacency, usize::MAX).unwrap().vertices().len(), 25);
    let other = Selection::by(3, |_| true);
    assert_eq!(other.smoothed(&adjacency, 1), Err(SelectionError::Sizes { first: 3, second: 25 }));
}

/// The net with two rows of faces of one group and two of another, and the last face without a material.
fn named() -> Mesh {
    let groups = FaceNames::new((0..16).map(|face| if face < 8 { "near" } else { "far" }));
    let materials = FaceNames::new((0..16).map(|face| if face < 15 { "cloth" } else { "" }));
    let net = net().with_names(NamedBy::Group, groups).unwrap();
    net.with_names(NamedBy::Material, materials).unwrap()
}

fn counts(names: Option<&FaceNames>) -> Vec<(String, usize)> {
    let Some(names) = names else { return Vec::new() };
    let count = |name: &String| (name.clone(), names.iter().filter(|other| other == name).count());
    names.names().iter().map(count).collect()
}

#[test]
fn names_of_faces_go_where_the_faces_go() {
    let mesh = named();
    let owned = |list: &[(&str, usize)]| list.iter().map(|(name, n)| ((*name).to_owned(), *n)).collect::<Vec<_>>();
    // Cut in the middle of the third row.
    let selection = Selection::weighted(25, |v| 1.0 - mesh.positions()[v].z / 5.0);
    let [near, far] = split(&mesh, &selection).unwrap();
    assert_eq!(counts(near.groups()), owned(&[("near", 8), ("far", 4)]));
    assert_eq!(counts(far.groups()), owned(&[("far", 8)]));
    assert_eq!(counts(far.materials()), owned(&[("cloth", 7), ("", 1)]));
    // Moved, mirrored and turned inside out, polygon by polygon.
    let mirrored = transform(&mesh, &DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0))).unwrap();
    assert_eq!((mirrored.groups(), mirrored.materials()), (mesh.groups(), mesh.materials()));
    assert_eq!(flipped(&mesh).unwrap().groups(), mesh.groups());
    // Joined to one that has none.
    let joined = join([&net(), &mesh]).unwrap();
    assert_eq!(counts(joined.groups()), owned(&[("", 16), ("near", 8), ("far", 8)]));
    assert_eq!(counts(join([&net(), &net()]).unwrap().groups()), []);
    // Closed by a cap, whose faces have no name.
    let capped = cap(&mesh, &CapOptions::default()).unwrap().mesh;
    let found = counts(capped.groups());
    assert_eq!(found[..2], owned(&[("near", 8), ("far", 8)]));
    assert!(found[2].0.is_empty() && found[2].1 == capped.polygon_count() - 16 && found[2].1 > 0);
    // Welded.
    let beside = transform(&mesh, &DAffine3::from_translation(DVec3::new(4.0, 0.0, 0.0))).unwrap();
    let welded = weld(&[&mesh, &beside], &WeldOptions::default()).unwrap().mesh;
    assert_eq!(counts(welded.groups()), owned(&[("near", 16), ("far", 16)]));
}
