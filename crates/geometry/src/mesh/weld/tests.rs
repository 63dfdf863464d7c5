use super::*;
use crate::mesh::{check, flipped};
use crate::sections::Sections;
use crate::surface::{SkinOptions, skin};
use glam::DVec2;
use std::f64::consts::{FRAC_PI_2, TAU};

/// A tube about +Y over a range of heights, its rings of some radius begun at some angle.
fn tube(range: [f64; 2], count: u32, begun: f64, radius: impl Fn(f64) -> f64) -> Mesh {
    let row = |y: f64| -> Vec<DVec3> {
        let at = |k: u32| {
            let out = DVec2::from_angle(begun + TAU * f64::from(k) / f64::from(count)) * radius(y);
            DVec3::new(out.x, y, -out.y)
        };
        (0..count).map(at).collect()
    };
    let rows = (0..=4).map(|k| row(range[0] + (range[1] - range[0]) * f64::from(k) / 4.0)).collect();
    let options = SkinOptions { columns: 1, ..SkinOptions::default() };
    skin(&Sections::new(rows, true, vec![]).unwrap(), &options, &|_| true).unwrap()
}

fn straight(range: [f64; 2]) -> Mesh {
    tube(range, 24, 0.0, |_| 1.0)
}

#[test]
fn equal_ends_of_three_tubes_become_one() {
    // Each begins elsewhere around.
    let quarter = FRAC_PI_2;
    let parts = [straight([0.0, 1.0]), tube([2.0, 3.0], 24, quarter, |_| 1.0), tube([1.0, 2.0], 24, -quarter, |_| 1.0)];
    let welded = weld(&parts.each_ref(), &WeldOptions::default()).unwrap();
    let found = check(&welded.mesh);
    assert!(found.is_sound() && found.shells == 1, "{found}");
    assert_eq!((welded.open_loops, welded.seams.len(), &welded.warnings), (2, 2, &vec![]));
    let before: usize = parts.iter().map(|part| part.positions().len()).sum();
    assert_eq!(welded.mesh.positions().len(), before - 48);
    for seam in &welded.seams {
        assert!(seam.whole && seam.vertices == 24 && seam.parts[1] == 2, "{seam:?}");
        assert!(seam.largest_gap < 1e-14 && seam.largest_angle_degrees < 1e-6, "{seam:?}");
    }
    assert_eq!(welded.mesh.uvs().unwrap().len(), welded.mesh.corners().len());
}

#[test]
fn a_tolerance_wider_than_an_edge_still_matches_vertex_by_vertex() {
    let parts = [straight([0.0, 1.0]), tube([1.3, 2.0], 24, 0.02, |_| 1.0)];
    let options = WeldOptions { tolerance: 0.4, ..WeldOptions::default() };
    let welded = weld(&parts.each_ref(), &options).unwrap();
    let found = check(&welded.mesh);
    assert!(found.is_sound() && found.shells == 1, "{found}");
    assert!((welded.seams[0].largest_gap - 0.3).abs() < 1e-3, "{:?}", welded.seams);
    let on_seam = welded.mesh.positions().iter().filter(|p| (p.y - 1.15).abs() < 1e-12).count();
    assert_eq!(on_seam, 24, "welded vertices stand in the middle");
}

#[test]
fn normals_are_averaged_where_the_seam_is_smooth_and_kept_where_it_is_hard() {
    // A cone of 45 degrees on a cylinder.
    let parts = [straight([0.0, 1.0]), tube([1.0, 1.5], 24, 0.0, |y| 2.0 - y)];
    let normals_at_seam = |welded: &Welded| -> Vec<DVec3> {
        let on_seam =
            |vertex: &u32| (welded.mesh.positions()[*vertex as usize] - DVec3::new(1.0, 1.0, 0.0)).length() < 1e-9;
        let corners = welded.mesh.corners().iter().zip(welded.mesh.normals().unwrap());
        corners.filter(|(vertex, _)| on_seam(vertex)).map(|(_, normal)| *normal).collect()
    };
    let hard = weld(&parts.each_ref(), &WeldOptions::default()).unwrap();
    assert!((hard.seams[0].largest_angle_degrees - 45.0).abs() < 2.0, "{:?}", hard.seams);
    let normals = normals_at_seam(&hard);
    assert_eq!(normals.len(), 4);
    assert!(normals.iter().any(|n| n.distance(DVec3::X) < 0.05) && normals.iter().any(|n| n.y > 0.6));
    let smooth = weld(&parts.each_ref(), &WeldOptions { smooth_degrees: 60.0, ..WeldOptions::default() }).unwrap();
    let normals = normals_at_seam(&smooth);
    assert!(normals.iter().all(|n| n.distance(normals[0]) < 1e-12), "one normal for all: {normals:?}");
    assert!((normals[0].y - 0.38).abs() < 0.05, "between the two: {}", normals[0]);
    assert_eq!(hard.mesh.positions(), smooth.mesh.positions());
}

#[test]
fn boundaries_of_other_counts_are_told_with_their_place() {
    let parts = [straight([0.0, 1.0]), tube([1.0, 2.0], 48, 0.0, |_| 1.0)];
    // Half of the 48 lie on vertices, the others near the middles of the sides of the 24.
    let options = WeldOptions { tolerance: 0.01, ..WeldOptions::default() };
    let welded = weld(&parts.each_ref(), &options).unwrap();
    assert_eq!(welded.t_junctions.len(), 24);
    assert!(
        welded.t_junctions.iter().all(|t| (t.part, t.of) == (1, 0) && t.gap < 0.01 && (t.at.y - 1.0).abs() < 1e-12)
    );
    let message = welded.warnings[0].to_string();
    assert!(message.starts_with("24 vertices lie within open edges of other parts without being welded"), "{message}");
    assert!(message.ends_with("give both boundaries the same number of points"), "{message}");
    assert_eq!((welded.seams[0].vertices, welded.seams[0].whole), (24, false));
}

#[test]
fn parts_that_nearly_meet_or_are_inside_out_are_told() {
    let parts = [straight([0.0, 1.0]), straight([1.001, 2.0])];
    let welded = weld(&parts.each_ref(), &WeldOptions::default()).unwrap();
    assert_eq!((welded.seams.len(), welded.open_loops), (0, 4));
    let message = welded.warnings[0].to_string();
    assert!(
        message.contains("are up to 0.00100")
            && message.contains("m apart and were not welded: raise the tolerance of"),
        "{message}"
    );

    let inside_out = flipped(&straight([1.0, 2.0])).unwrap();
    let welded = weld(&[&parts[0], &inside_out], &WeldOptions::default()).unwrap();
    assert_eq!(welded.seams.len(), 0);
    let message = welded.warnings[0].to_string();
    assert!(
        message.starts_with("parts 0 and 1 meet at (0.000, 1.000, 0.000), but one of them is inside out"),
        "{message}"
    );
}

#[test]
fn sheets_are_welded_along_the_part_of_their_edges_that_they_share() {
    let sheet = |x: f64, rows: u32| {
        let at = |k: u32| DVec3::new(x + f64::from(k % 2), f64::from(k / 2), 0.0);
        let quads = (0..rows).map(|row| [2 * row, 2 * row + 1, 2 * row + 3, 2 * row + 2]);
        Mesh::new((0..2 * rows + 2).map(at).collect(), quads).unwrap()
    };
    let (low, high) = (sheet(0.0, 2), sheet(1.0, 5));
    let welded = weld(&[&low, &high], &WeldOptions::default()).unwrap();
    assert_eq!((welded.seams[0].vertices, welded.seams[0].whole, welded.open_loops), (3, false, 1));
    assert!(check(&welded.mesh).is_sound() && welded.t_junctions.is_empty());
    assert!(welded.mesh.normals().is_none());
    // Four squares that meet in a point.
    let square = |x: f64, y: f64| {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        Mesh::new(corners.map(|(u, v)| DVec3::new(x + u, y + v, 0.0)).to_vec(), [[0_u32, 1, 2, 3]]).unwrap()
    };
    let four = [square(0.0, 0.0), square(1.0, 0.0), square(0.0, 1.0), square(1.0, 1.0)];
    let welded = weld(&four.each_ref(), &WeldOptions::default()).unwrap();
    assert_eq!((welded.mesh.positions().len(), welded.open_loops), (9, 1));
}

#[test]
fn what_can_not_be_welded_is_refused() {
    let part = straight([0.0, 1.0]);
    let refusal = |parts: &[&Mesh], tolerance, smooth_degrees| {
        weld(parts, &WeldOptions { tolerance, smooth_degrees }).unwrap_err().to_string()
    };
    assert_eq!(refusal(&[], 0.1, 30.0), "there is nothing to weld: give at least one mesh");
    assert_eq!(refusal(&[&part], f64::NAN, 30.0), "a tolerance of NaN m: give a length from 0 to 1000 m");
    assert!(refusal(&[&part], 0.1, 200.0).starts_with("seams smooth up to 200 degrees"));
    let stopped = weld_while(&[&part, &part], &WeldOptions::default(), &|done| done < 0.25);
    assert_eq!(stopped, Err(WeldError::Stopped));
    let alone = weld(&[&part], &WeldOptions::default()).unwrap();
    assert_eq!(alone.mesh, part);
}
