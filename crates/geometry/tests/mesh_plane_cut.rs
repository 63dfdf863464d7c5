//! Where a plane cuts a mesh: through vertices, sides and faces, with holes, seams, walls and faces without area.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a failing unwrap is a failing test")]

use glam::{DQuat, DVec3, EulerRot};
use maquette_geometry::mesh::slice::{Loop, Plane, plane};
use maquette_geometry::mesh::{Mesh, join, topology::Topology};
use proptest::prelude::*;

const CUBE: [[u32; 4]; 6] = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

fn corners(low: DVec3) -> Vec<DVec3> {
    let ring = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    [0.0, 1.0].iter().flat_map(|z| ring.map(|[x, y]| low + DVec3::new(x, y, *z))).collect()
}

/// A cube from 0 to 1.
fn cube() -> Mesh {
    Mesh::new(corners(DVec3::ZERO), CUBE).unwrap()
}

fn cut(mesh: &Mesh, origin: DVec3, normal: DVec3) -> Vec<Loop> {
    plane(mesh, &Plane::new(origin, normal).unwrap())
}

/// Twice the area along the normal, and the length around.
fn measures(found: &Loop, normal: DVec3) -> (f64, f64) {
    let count = found.points.len();
    let sides = (0..count).map(|k| (found.points[k], found.points[(k + 1) % count]));
    sides.fold((0.0, 0.0), |(area, length), (a, b)| {
        let origin = found.points[0];
        (area + 0.5 * (a - origin).cross(b - origin).dot(normal.normalize()), length + a.distance(b))
    })
}

fn assert_close(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-9, "{found}, expected {expected}");
}

/// The one loop of a cut, its area and its length.
fn one(mesh: &Mesh, origin: DVec3, normal: DVec3) -> (usize, f64, f64) {
    let loops = cut(mesh, origin, normal);
    assert_eq!(loops.len(), 1, "{loops:?}");
    assert!(loops[0].closed);
    let (area, length) = measures(&loops[0], normal);
    (loops[0].points.len(), area, length)
}

#[test]
fn a_cube_is_cut_counter_clockwise_about_the_normal() {
    for normal in [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Z] {
        let (points, area, length) = one(&cube(), DVec3::splat(0.3), normal);
        assert_eq!(points, 4);
        assert_close(area, 1.0);
        assert_close(length, 4.0);
    }
}

/// The cube, and the cube turned and moved, so that numbers are round in the first case only.
fn poses() -> [(Mesh, DQuat, DVec3); 3] {
    let posed = |turn: DQuat, shift: DVec3| {
        let points = corners(DVec3::ZERO).into_iter().map(|p| turn * p + shift).collect();
        (Mesh::new(points, CUBE).unwrap(), turn, shift)
    };
    [
        posed(DQuat::IDENTITY, DVec3::ZERO),
        posed(DQuat::from_euler(EulerRot::XYZ, 0.3, -1.1, 2.0), DVec3::ZERO),
        posed(DQuat::from_euler(EulerRot::XYZ, -2.3, 0.4, 0.7), DVec3::new(40.0, -30.0, 7.0)),
    ]
}

#[test]
fn planes_through_vertices_and_edges_cut_once() {
    for (mesh, turn, shift) in poses() {
        // Through four vertices and two edges.
        let (_, area, length) = one(&mesh, turn * DVec3::splat(0.5) + shift, turn * DVec3::new(1.0, -1.0, 0.0));
        assert_close(area, 2.0_f64.sqrt());
        assert_close(length, 2.0 + 8.0_f64.sqrt());
        // Through three vertices.
        for sign in [1.0, -1.0] {
            let (points, area, length) = one(&mesh, turn * DVec3::X + shift, turn * DVec3::ONE * sign);
            assert_eq!(points, 3);
            assert_close(area, 0.75_f64.sqrt());
            assert_close(length, 3.0 * 2.0_f64.sqrt());
        }
        // Through two vertices that no edge joins, and the middles of two edges.
        let (_, area, _) = one(&mesh, turn * DVec3::splat(0.5) + shift, turn * DVec3::new(1.0, 1.0, 2.0));
        assert_close(area, 1.5_f64.sqrt());
    }
}

#[test]
fn a_plane_in_a_face_cuts_where_the_body_is_below() {
    for (mesh, turn, shift) in poses() {
        for (origin, normal) in [(DVec3::ONE, DVec3::Z), (DVec3::ZERO, DVec3::NEG_Z), (DVec3::ONE, DVec3::X)] {
            let (points, area, _) = one(&mesh, turn * origin + shift, turn * normal);
            assert_eq!(points, 4);
            assert_close(area, 1.0);
            assert!(cut(&mesh, turn * origin + shift, turn * -normal).is_empty());
        }
    }
}

#[test]
fn what_only_touches_gives_nothing() {
    for (mesh, turn, shift) in poses() {
        // A vertex, an edge; then beside it.
        for normal in [DVec3::ONE, DVec3::new(1.0, 1.0, 0.0)] {
            for sign in [1.0, -1.0] {
                assert!(cut(&mesh, turn * DVec3::ONE + shift, turn * normal * sign).is_empty());
                assert!(cut(&mesh, turn * DVec3::splat(1.1) + shift, turn * normal * sign).is_empty());
            }
        }
    }
}

#[test]
fn faces_with_notches_are_cut_in_two() {
    // The outline of a U, drawn up.
    let outline = [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [2.0, 3.0], [2.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
    let points = [0.0, 1.0].iter().flat_map(|z| outline.map(|[x, y]| DVec3::new(x, y, *z))).collect();
    let mut polygons: Vec<Vec<u32>> = vec![(8..16).collect(), (0..8).rev().collect()];
    polygons.extend((0..8).map(|k| vec![k, (k + 1) % 8, 8 + (k + 1) % 8, 8 + k]));
    let mesh = Mesh::new(points, polygons).unwrap();
    assert!(Topology::new(&mesh).is_closed());
    let arms = cut(&mesh, DVec3::Y * 2.0, DVec3::Y);
    assert_eq!(arms.len(), 2);
    for arm in &arms {
        let (area, length) = measures(arm, DVec3::Y);
        assert_close(area, 1.0);
        assert_close(length, 4.0);
    }
    // In the floor of the notch, whose vertices then count as above: just below it.
    let (_, area, _) = one(&mesh, DVec3::Y, DVec3::Y);
    assert_close(area, 3.0);
    assert_eq!(cut(&mesh, DVec3::Y, DVec3::NEG_Y).len(), 2);
}

#[test]
fn holes_give_open_chains() {
    let without_side = Mesh::new(corners(DVec3::ZERO), &CUBE[..5]).unwrap();
    let loops = cut(&without_side, DVec3::splat(0.4), DVec3::Z);
    assert_eq!((loops.len(), loops[0].closed, loops[0].points.len()), (1, false, 4));
    assert_eq!(loops[0].points[0].x + loops[0].points[3].x, 0.0, "{loops:?}");
    let two_gone = Mesh::new(corners(DVec3::ZERO), [CUBE[0], CUBE[1], CUBE[3], CUBE[5]]).unwrap();
    let loops = cut(&two_gone, DVec3::splat(0.4), DVec3::Z);
    assert_eq!(loops.iter().map(|l| (l.closed, l.points.len())).collect::<Vec<_>>(), [(false, 2), (false, 2)]);
}

#[test]
fn seams_of_doubled_vertices_are_no_holes() {
    // Every face with vertices of its own.
    let all = corners(DVec3::ZERO);
    let points = CUBE.iter().flatten().map(|v| all[*v as usize]).collect();
    let soup = Mesh::new(points, (0..6).map(|k| [4 * k, 4 * k + 1, 4 * k + 2, 4 * k + 3])).unwrap();
    for (origin, normal, area) in [
        (DVec3::splat(0.3), DVec3::new(0.1, 0.2, 1.0), (1.05_f64).sqrt()),
        (DVec3::splat(0.5), DVec3::new(1.0, -1.0, 0.0), 2.0_f64.sqrt()),
        (DVec3::X, DVec3::ONE, 0.75_f64.sqrt()),
    ] {
        let (_, found, _) = one(&soup, origin, normal);
        assert_close(found, area);
    }
}

#[test]
fn bodies_that_touch_stay_apart() {
    // Two cubes with one edge in common, by the same vertices and by equal ones; then with a face in common.
    let mut points = corners(DVec3::ZERO);
    let second = corners(DVec3::new(1.0, 1.0, 0.0));
    let shared = |v: u32| match v {
        0 => 2,
        4 => 6,
        v => v + 8,
    };
    points.extend(second.iter().copied());
    let polygons = CUBE.iter().copied().chain(CUBE.map(|face| face.map(shared)));
    let common_edge = Mesh::new(points, polygons).unwrap();
    let equal_edge = join(&[cube(), Mesh::new(second, CUBE).unwrap()]).unwrap();
    let side_by_side = join(&[cube(), Mesh::new(corners(DVec3::X), CUBE).unwrap()]).unwrap();
    for mesh in [common_edge, equal_edge, side_by_side] {
        for normal in [DVec3::Z, DVec3::NEG_Z] {
            let loops = cut(&mesh, DVec3::Z * 0.4, normal);
            assert_eq!(loops.len(), 2);
            for found in loops {
                assert!(found.closed && found.points.len() == 4);
                assert_close(measures(&found, normal).0, 1.0);
            }
        }
    }
}

#[test]
fn a_wall_inside_leaves_the_outline_whole() {
    // A tube of 8 sides with a wall across.
    let ring = |z: f64| {
        (0..8).map(move |k| f64::from(k) * std::f64::consts::FRAC_PI_4).map(move |a| DVec3::new(a.cos(), a.sin(), z))
    };
    let points: Vec<DVec3> = ring(0.0).chain(ring(1.0)).collect();
    let sides = (0..8).map(|k| [k, (k + 1) % 8, 8 + (k + 1) % 8, 8 + k]);
    let mesh = Mesh::new(points, sides.chain([[0, 4, 12, 8]])).unwrap();
    let loops = cut(&mesh, DVec3::Z * 0.5, DVec3::Z);
    let kinds: Vec<(bool, usize)> = loops.iter().map(|found| (found.closed, found.points.len())).collect();
    assert_eq!(kinds, [(true, 8), (false, 2)]);
}

#[test]
fn faces_turned_inside_out_do_not_break_the_loop() {
    let mut polygons = CUBE;
    polygons[3].reverse();
    let mesh = Mesh::new(corners(DVec3::ZERO), polygons).unwrap();
    let (points, area, _) = one(&mesh, DVec3::splat(0.4), DVec3::Z);
    assert_eq!(points, 4);
    assert_close(area.abs(), 1.0);
}

#[test]
fn faces_without_area_change_nothing() {
    let mut points = corners(DVec3::ZERO);
    let middle = points.len() as u32;
    points.push(DVec3::new(0.0, 0.0, 0.5));
    // A flat triangle beside the edge 0-4, which so becomes two edges for one of its faces; and faces that run back.
    let mut polygons: Vec<Vec<u32>> = CUBE.iter().map(|face| face.to_vec()).collect();
    polygons[2] = vec![0, 1, 5, 4, middle];
    polygons.extend([vec![0, middle, 4], vec![1, 5, 1], vec![2, 2, 6], vec![7, 7, 7], vec![3, 7, 3, 7]]);
    let mesh = Mesh::new(points, polygons).unwrap();
    for z in [0.25, 0.5, 0.75] {
        let (_, area, length) = one(&mesh, DVec3::Z * z, DVec3::new(0.01, 0.02, 1.0));
        assert_close(area, 1.0005_f64.sqrt());
        assert!((length - 4.0).abs() < 1e-3);
    }
}

#[test]
fn meshes_without_anything_and_huge_ones_do_not_panic() {
    assert!(cut(&Mesh::default(), DVec3::ZERO, DVec3::Z).is_empty());
    for size in [1e-200, 1e200, 1.7e308] {
        let points = corners(DVec3::splat(-0.5)).into_iter().map(|p| p * size).collect();
        let mesh = Mesh::new(points, CUBE).unwrap();
        for found in cut(&mesh, DVec3::ZERO, DVec3::new(0.1, 0.2, 1.0)) {
            assert!(found.points.iter().all(|p| p.is_finite()));
        }
    }
}

proptest! {
    /// Coordinates on a coarse lattice put vertices, sides and faces in the plane time and again.
    #[test]
    fn a_closed_mesh_gives_closed_loops_only(
        heights in prop::collection::vec(0_u8..4, 25),
        origin in [0_u8..5, 0..5, 0..5],
        normal in [-2_i8..3, -2..3, -2..3],
    ) {
        prop_assume!(normal != [0; 3]);
        // A landscape of 5 by 5 posts over a floor, sewn shut all round.
        let at = |x: u32, z: u32| 5 * x + z;
        let top = (0..25).map(|k| DVec3::new(f64::from(k / 5), 1.0 + f64::from(heights[k as usize]), f64::from(k % 5)));
        let floor = (0..25).map(|k: u32| DVec3::new(f64::from(k / 5), 0.0, f64::from(k % 5)));
        let points = top.chain(floor).collect();
        let cells = || (0..4).flat_map(|x| (0..4).map(move |z| [at(x, z), at(x, z + 1), at(x + 1, z + 1), at(x + 1, z)]));
        let mut polygons: Vec<[u32; 4]> = cells().collect();
        polygons.extend(cells().map(|[a, b, c, d]| [d + 25, c + 25, b + 25, a + 25]));
        let rim: Vec<u32> = (0..4).map(|x| at(x, 0)).chain((0..4).map(|z| at(4, z)))
            .chain((1..5).rev().map(|x| at(x, 4))).chain((1..5).rev().map(|z| at(0, z))).collect();
        polygons.extend((0..16).map(|k| (rim[k], rim[(k + 1) % 16])).map(|(a, b)| [a, b, b + 25, a + 25]));
        let mesh = Mesh::new(points, polygons).unwrap();
        prop_assert!(Topology::new(&mesh).is_closed());
        let plane_of = |sign: f64| {
            let normal = DVec3::from(normal.map(f64::from)) * sign;
            Plane::new(DVec3::from(origin.map(f64::from)), normal).unwrap()
        };
        let loops = plane(&mesh, &plane_of(1.0));
        let area = |loops: &[Loop], sign: f64| -> f64 {
            loops.iter().map(|found| measures(found, plane_of(sign).normal()).0).sum()
        };
        prop_assert!(loops.iter().all(|found| found.closed));
        prop_assert!(area(&loops, 1.0) > -1e-9, "the mesh faces outwards");
        for point in loops.iter().flat_map(|found| &found.points) {
            prop_assert!(plane_of(1.0).height(*point).abs() < 1e-12);
        }
        // Seen from behind the same area is cut, but for faces in the plane: so just above it and just below.
        let nudged = |sign: f64, by: f64| {
            let moved = Plane::new(plane_of(1.0).origin() + plane_of(1.0).normal() * by, plane_of(sign).normal());
            area(&plane(&mesh, &moved.unwrap()), sign)
        };
        prop_assert!((area(&loops, 1.0) - nudged(1.0, -1e-7)).abs() < 1e-4);
        prop_assert!((area(&plane(&mesh, &plane_of(-1.0)), -1.0) - nudged(-1.0, 1e-7)).abs() < 1e-4);
    }
}
